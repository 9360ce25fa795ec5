"""The cache of compiled kernels: a folder in the user's cache for each version of their source.

numba detects changes of the file of a function only, not of the functions that it calls.
"""

import contextlib
import hashlib
import os
import shutil
from pathlib import Path

from thalweg.core.cache_folder import cache_folder, is_usable, private_temporary_folder

#: The folder of the package `kernels`.
PACKAGE = Path(__file__).resolve().parents[1]
_MAX_FOLDERS = 4  # largest number of folders of compiled code, the newest ones


def _source_hash() -> str:
    """Return a hash that changes with any file of the package, its sub-packages included."""
    files = sorted(PACKAGE.rglob("*.py"))
    facts = [(str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    return hashlib.sha256(repr(facts).encode()).hexdigest()[:16]


def _make_folder() -> Path:
    override = os.environ.get("NUMBA_CACHE_DIR")
    places = [Path(override) / "kernels"] if override else []
    for place in (*places, cache_folder("kernels"), private_temporary_folder() / "kernels"):
        folder = place / _source_hash()
        new = not folder.is_dir()
        if is_usable(folder):
            if new:
                _remove_old_folders(place)
            return folder
    return folder  # nothing can be written: kernels are compiled in every process


def _remove_old_folders(base: Path) -> None:
    with contextlib.suppress(OSError):  # another process may remove the same folders
        folders = [path for path in base.iterdir() if path.is_dir()]
        folders.sort(key=lambda path: path.stat().st_mtime, reverse=True)
        for folder in folders[_MAX_FOLDERS:]:
            shutil.rmtree(folder, ignore_errors=True)


#: Folder of the compiled code of these kernels.
COMPILED_FOLDER = _make_folder()
