"""The folder on disk where things that are dear to make are kept between runs."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path


def cache_folder(name: str = "") -> Path:
    """Return a writable folder for cached data (``THALWEG_CACHE`` overrides its place)."""
    for base in _candidates():
        folder = base / name if name else base
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(folder, os.W_OK):
            return folder
    return Path(tempfile.mkdtemp(prefix="thalweg-"))


def _candidates() -> list[Path]:
    override = os.environ.get("THALWEG_CACHE")
    if override:
        return [Path(override)]
    if sys.platform == "win32":
        home = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        home = Path.home() / "Library" / "Caches"
    else:
        home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    user = os.getuid() if hasattr(os, "getuid") else 0
    return [home / "thalweg", Path(tempfile.gettempdir()) / f"thalweg-{user}"]
