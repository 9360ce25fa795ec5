"""Writing files completely or not at all.

The content goes to a temporary file in the same folder, which then takes the place of the old
file. A full disk or a stopped process leaves the old file as it was. A temporary file that a killed
process left is removed when a file is written beside it a minute later or more.
"""

from __future__ import annotations

import contextlib
import csv
import io
import os
import re
import secrets
import stat
import time
from collections.abc import Iterable, Iterator
from os import PathLike
from pathlib import Path
from typing import IO, Any

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, MINUTE

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None  # type: ignore[assignment]

_LEAST_AGE = MINUTE  # of a temporary file that is removed [s]
_PART = re.compile(r"\.[0-9a-f]{16}\.part")  # names of the temporary files


@contextlib.contextmanager
def replacing_file(path: str | PathLike[str]) -> Iterator[IO[bytes]]:
    """Open a temporary file that replaces ``path`` when the block ends without an error.

    Parameters
    ----------
    path : File to write. A link is followed; the permissions of an existing file are kept. A device
        or a pipe is written directly.

    Yields
    ------
    file : Binary file to write to.

    Raises
    ------
    OSError : If the file cannot be written. An existing file is then unchanged.
    """
    target = Path(os.path.realpath(path))
    mode = _existing_mode(target)
    if mode is not None and not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        with target.open("wb") as stream:
            yield stream
        return
    if target.is_dir():
        raise IsADirectoryError(21, "it is a folder", str(target))
    if mode is not None and not os.access(target, os.W_OK):
        raise PermissionError(13, "Permission denied", str(target))
    _remove_stale_parts(target.parent)
    draft = target.with_name(f".{secrets.token_hex(8)}.part")
    try:
        with draft.open("xb") as file, _locked(draft):
            yield file
            file.flush()
            os.fsync(file.fileno())
            if mode is not None:
                draft.chmod(stat.S_IMODE(mode))
            file.close()
            os.replace(draft, target)
    except BaseException:
        with contextlib.suppress(OSError):
            draft.unlink(missing_ok=True)
        raise


@contextlib.contextmanager
def _locked(draft: Path) -> Iterator[None]:
    """Hold a lock on a temporary file, which ends with its process."""
    if fcntl is None:
        yield
        return
    descriptor = os.open(draft, os.O_RDWR)
    try:
        with contextlib.suppress(OSError):  # file systems without locks
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    finally:
        os.close(descriptor)


def _remove_stale_parts(folder: Path) -> None:
    """Remove the temporary files of processes that were stopped while they wrote in a folder."""
    with contextlib.suppress(OSError):
        for entry in os.scandir(folder):
            if _PART.fullmatch(entry.name):
                with contextlib.suppress(OSError):
                    age = time.time() - entry.stat().st_mtime
                    if age > _LEAST_AGE and _is_abandoned(entry.path, age):
                        Path(entry.path).unlink()


def _is_abandoned(path: str, age: float) -> bool:
    """Return whether no process holds the lock of a temporary file of an age [s]."""
    if fcntl is None:
        return age > DAY
    descriptor = os.open(path, os.O_RDWR)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    finally:
        os.close(descriptor)
    return True


def taken_lock(path: Path) -> int | None:
    """Take a lock file for this process; the system frees it when the process ends.

    Returns
    -------
    int or None : Descriptor, which `os.close` frees; None on a system or in a folder without locks.

    Raises
    ------
    BlockingIOError : If another process holds it.
    """
    if fcntl is None:
        return None
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise
    except OSError:
        os.close(descriptor)
        return None
    return descriptor


def _existing_mode(path: Path) -> int | None:
    """Return the kind and the permissions of a file; None if it does not exist."""
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def write_bytes(path: str | PathLike[str], data: bytes) -> None:
    """Write a file completely or not at all.

    Raises
    ------
    InputError : If it cannot be written. An existing file is then unchanged.
    """
    try:
        with replacing_file(path) as file:
            file.write(data)
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        raise unwritable_error("file", path, error) from error


def write_text(path: str | PathLike[str], text: str) -> None:
    """Write text in UTF-8, completely or not at all; parameters and errors as `write_bytes`."""
    write_bytes(path, text.encode("utf-8", "backslashreplace"))


def write_csv_rows(path: str | PathLike[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write rows as CSV, completely or not at all; None becomes an empty cell.

    Raises
    ------
    InputError : If it cannot be written. An existing file is then unchanged.
    """
    text = io.StringIO(newline="")
    csv.writer(text).writerows(rows)
    write_text(path, text.getvalue())


def new_figure(width: float, height: float, **options: Any) -> Any:
    """Return an empty matplotlib figure that is drawn without a window.

    Parameters
    ----------
    width, height : [inch].
    **options : For ``Figure``; by default 130 dots per inch and the constrained layout.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    options = {"dpi": 130, "layout": "constrained", **options}
    figure = Figure(figsize=(width, height), **options)
    FigureCanvasAgg(figure)
    return figure


def style_panels(axes: Iterable[Any]) -> None:
    """Give the panels of a figure a thin grid and small text."""
    for panel in axes:
        panel.grid(alpha=0.3, lw=0.4)
        panel.tick_params(labelsize=7)
        panel.title.set_size(9)
        panel.xaxis.label.set_size(8)
        panel.yaxis.label.set_size(8)


def save_figure(figure: Any, path: str | PathLike[str] | IO[bytes], **options: Any) -> None:
    """Write a matplotlib figure, completely or not at all.

    Parameters
    ----------
    path : The suffix gives the format; without one, ``.png`` is added.
    **options : For ``savefig``.

    Raises
    ------
    InputError
        If it cannot be written, or the format is unknown. An existing file is then unchanged.
    """
    if not isinstance(path, (str, PathLike)):
        figure.savefig(path, **options)
        return
    path = Path(path)
    if not path.suffix and "format" not in options:
        path = path.with_name(path.name + ".png")
    options = {"format": path.suffix[1:].lower(), **options}
    known = figure.canvas.get_supported_filetypes()
    if options["format"] not in known:
        raise InputError(
            f"A picture of the format {options['format']!r} was requested.",
            f"Formats: {', '.join(sorted(known))}.",
            "Give the file one of these endings.",
            file=str(path),
        )
    picture = io.BytesIO()
    figure.savefig(picture, **options)
    write_bytes(path, picture.getvalue())


def make_folder(folder: str | PathLike[str]) -> Path:
    """Create a folder if it does not exist, and return it.

    Raises
    ------
    InputError : If it cannot be created or written.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not os.access(folder, os.W_OK):
            raise PermissionError(13, "Permission denied")
    except FileExistsError:
        raise unwritable_error("folder", folder, "a file has this name") from None
    except (OSError, ValueError) as error:
        raise unwritable_error("folder", folder, error) from error
    return folder


def unwritable_error(kind: str, path: str | PathLike[str], why: Exception | str) -> InputError:
    """Return the error for a ``file`` or ``folder`` that cannot be written.

    Parameters
    ----------
    kind : {'file', 'folder'}
    why : An `OSError`, or the reason in words.
    """
    reason = why if isinstance(why, str) else getattr(why, "strerror", None) or str(why)
    possible = {
        "file": "A file needs an existing folder, permission to write and free space; "
        "an earlier file of this name is unchanged.",
        "folder": "A folder that exists and can be written, or a path where one can be created.",
    }
    return InputError(
        f"The {kind} {str(path)!r} cannot be written: {reason}.",
        possible[kind],
        "Choose another path, or correct the cause.",
        file=str(path),
    )
