"""The cache of compiled kernels: a folder in the user's cache for each version of their source.

numba detects changes of the file of a function only, not of the functions that it calls.
"""

import contextlib
import hashlib
import os
import shutil
from pathlib import Path

from thalweg.core import ellipsoid
from thalweg.core.cache_folder import cache_folder, is_usable, private_temporary_folder

#: The folder of the package `kernels`.
PACKAGE = Path(__file__).resolve().parents[1]
_CONSTANTS = Path(ellipsoid.__file__).resolve()  # compiled into the kernels
_MAX_FOLDERS = 4  # largest number of folders of compiled code, the newest ones


def _source_hash() -> str:
    """Return a hash that changes with the text of any module that is compiled.

    It depends neither on the place of the package nor on file times, so that all installations
    and checkouts of one version share their compiled code.
    """
    total = hashlib.sha256()
    total.update(_CONSTANTS.read_bytes())
    for file in sorted(PACKAGE.rglob("*.py")):
        text = file.read_bytes()
        total.update(f"{file.relative_to(PACKAGE).as_posix()} {len(text)}\n".encode() + text)
    return total.hexdigest()[:16]


def _make_folder() -> Path:
    override = os.environ.get("NUMBA_CACHE_DIR")
    given = Path(override) / "kernels" if override else None
    own = (cache_folder("kernels"), private_temporary_folder() / "kernels")
    source_hash = _source_hash()
    for place in (*([given] if given else []), *own):
        folder = place / source_hash
        new = not folder.is_dir()
        if is_usable(folder):
            if new and place != given:  # the user looks after a folder of his own
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
