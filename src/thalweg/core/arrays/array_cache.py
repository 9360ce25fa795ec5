"""Arrays of long computations in files of the cache; a damaged file is made again."""

from __future__ import annotations

import contextlib
import zipfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from thalweg.core.file_writing import replacing_file

Made = TypeVar("Made")

#: What a missing or damaged file raises as it is read, and arrays that do not fit together.
_UNREADABLE: Final = (
    OSError,
    EOFError,
    ValueError,
    TypeError,
    LookupError,
    RuntimeError,
    zipfile.BadZipFile,
)


def load_or_make(
    path: Path,
    make: Callable[[], Made],
    *,
    pack: Callable[[Made], Mapping[str, NDArray[Any]]],
    unpack: Callable[[Mapping[str, NDArray[Any]]], Made],
    clean: Callable[[Path], None] | None = None,
) -> Made:
    """Return what a file of the cache holds, or make it and write the file.

    Where the file cannot be written, as on a full disk, the next run makes it again.

    Parameters
    ----------
    path : Path
        File of named arrays (``npz``).
    make : callable
        Makes it where the file is missing or damaged.
    pack : callable
        Returns the arrays to write.
    unpack : callable
        Makes the same of the arrays; raises ValueError or KeyError if they do not fit together.
    clean : callable, optional
        Removes old files from the folder, after a file was written.
    """
    with contextlib.suppress(*_UNREADABLE):
        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        return unpack(arrays)
    made = make()
    with contextlib.suppress(OSError):
        with replacing_file(path) as file:
            np.savez(file, allow_pickle=False, **pack(made))
        if clean is not None:
            clean(path.parent)
    return made


def remove_oldest(paths: Iterable[Path], kept: int) -> None:
    """Remove files, except for those that were written last.

    Parameters
    ----------
    kept : Number of files that stay.
    """
    oldest_first = sorted(paths, key=lambda path: path.stat().st_mtime)
    for path in oldest_first[:-kept]:
        path.unlink(missing_ok=True)
