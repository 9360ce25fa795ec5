"""The folder on disk that caches results of long computations between runs."""

from __future__ import annotations

import atexit
import contextlib
import os
import shutil
import stat
import sys
import tempfile
from functools import cache
from pathlib import Path

_PROBE = b"x" * 4096  # one block of a disk: an empty file can be made on a full disk


def cache_folder(name: str = "") -> Path:
    """Return a writable folder for cached data.

    Parameters
    ----------
    name : Folder inside the cache; empty: the cache itself.

    Returns
    -------
    Path : In the folder that ``THALWEG_CACHE`` names, or else the user's cache folder. If that
        cannot be written or the disk is full, in a private folder for temporary files.
    """
    base = _cache_root()
    if base is not None:
        folder = base / name if name else base
        if is_usable(folder):
            return folder
    folder = private_temporary_folder() / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def is_usable(folder: Path) -> bool:
    """Return whether a folder exists or can be made, and files can be written into it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return _takes_files(folder)


@cache
def _takes_files(folder: Path) -> bool:
    """Try to write one block into a folder, once per folder and process."""
    try:
        with tempfile.NamedTemporaryFile(dir=folder, prefix=".probe-") as file:
            file.write(_PROBE)
            file.flush()
        return True
    except OSError:
        return False


def private_temporary_folder() -> Path:
    """Return a folder for temporary files that only this user can read and write.

    All processes of the user share it. If its name is taken by a link or by another user, a new
    folder is made, and removed when the process ends.
    """
    return _private_folder_in(Path(tempfile.gettempdir()))


@cache
def _private_folder_in(parent: Path) -> Path:
    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = parent / f"thalweg-{user}"
    with contextlib.suppress(OSError):
        with contextlib.suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        if _is_private(folder):
            return folder
    folder = Path(tempfile.mkdtemp(prefix="thalweg-", dir=parent))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def _is_private(folder: Path) -> bool:
    """Return whether a path is a folder, not a link, that belongs to this user alone."""
    facts = folder.lstat()
    if not stat.S_ISDIR(facts.st_mode):
        return False
    if not hasattr(os, "getuid"):
        return True  # temporary folders are private on such systems
    if facts.st_uid != os.getuid() or facts.st_mode & 0o077:
        return False
    return _takes_files(folder)


def _cache_root() -> Path | None:
    """Return the folder for all cached data; None for a user without a home."""
    override = os.environ.get("THALWEG_CACHE")
    if override:
        return Path(override)
    try:
        return _home_cache() / "thalweg"
    except RuntimeError:  # as in some containers
        return None


def _home_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
