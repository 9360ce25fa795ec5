"""The folder on disk where things that are dear to make are kept between runs."""

from __future__ import annotations

import os
import sys
import tempfile
from functools import cache
from pathlib import Path


def cache_folder(name: str = "") -> Path:
    """Return a writable folder for cached data (``THALWEG_CACHE`` overrides its place)."""
    for base in _candidate_folders():
        folder = base / name if name else base
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(folder, os.W_OK):
            return folder
    folder = _temporary_folder() / name
    folder.mkdir(exist_ok=True)
    return folder


@cache
def _temporary_folder() -> Path:
    """A folder for this process alone, when none lasts."""
    return Path(tempfile.mkdtemp(prefix="thalweg-"))


def _candidate_folders() -> list[Path]:
    override = os.environ.get("THALWEG_CACHE")
    if override:
        return [Path(override)]
    user = os.getuid() if hasattr(os, "getuid") else 0
    temporary = Path(tempfile.gettempdir()) / f"thalweg-{user}"
    try:
        return [_home_cache() / "thalweg", temporary]
    except RuntimeError:  # a user without a home, as in some containers
        return [temporary]


def _home_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
