"""Where compiled kernels are kept: a folder in the user's cache for each state of the kernels.

numba itself notices only changes of the file a function stands in, not of what it calls.
"""

import hashlib
import os
import shutil
import tempfile
from pathlib import Path

#: The folder of the package `kernels`.
PACKAGE = Path(__file__).resolve().parents[1]
_MAX_FOLDERS = 4  # folders of compiled code that are kept, the newest ones


def _source_hash() -> str:
    """Return a hash that changes with any file of the package, its sub-packages included."""
    files = sorted(PACKAGE.rglob("*.py"))
    facts = [(str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in files]
    return hashlib.sha256(repr(facts).encode()).hexdigest()[:16]


def _cache_root() -> Path:
    override = os.environ.get("NUMBA_CACHE_DIR") or os.environ.get("THALWEG_CACHE")
    if override:
        return Path(override)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "thalweg"


def _make_folder() -> Path:
    base = _cache_root() / "kernels"
    folder = base / _source_hash()
    try:
        if not folder.is_dir():
            folder.mkdir(parents=True, exist_ok=True)
            _remove_old_folders(base)
        if os.access(folder, os.W_OK):
            return folder
    except OSError:
        pass
    return Path(tempfile.mkdtemp(prefix="thalweg-kernels-"))


def _remove_old_folders(base: Path) -> None:
    folders = sorted(base.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
    for folder in folders[_MAX_FOLDERS:]:
        shutil.rmtree(folder, ignore_errors=True)


#: Where the compiled code of these kernels is kept.
COMPILED_FOLDER = _make_folder()
