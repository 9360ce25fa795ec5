"""Reading small text files that a user names, with errors that state the cause, and own tables."""

from __future__ import annotations

import csv
import gzip
import os
from importlib import resources
from os import PathLike
from pathlib import Path

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import shortened_repr


def read_text_file(path: str | PathLike[str], kind: str, largest: int = 1_000_000) -> str:
    """Return the text of a file.

    Parameters
    ----------
    kind : Kind of the file in errors, such as ``voyage``.
    largest : Largest size [bytes].

    Raises
    ------
    InputError : If the path is not a path, or the file is missing, too large or not text in UTF-8.
    """
    if not isinstance(path, (str, PathLike)):
        raise InputError(
            f"The {kind} file is {shortened_repr(path)}, which is not a path.",
            "A path is text, such as 'north_sea.yaml', or a pathlib.Path.",
            "Give the path of a file.",
        )
    name = shortened_repr(os.fspath(path), 200)
    try:
        with Path(path).open("rb") as file:
            raw = file.read(largest + 1)
    except FileNotFoundError:
        raise InputError(
            f"The {kind} file {name} does not exist.", "It is a text file.", "Check the path."
        ) from None
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        raise InputError(
            f"The {kind} file {name} cannot be read: {cause_of(error)}.",
            "It is a text file that you may read.",
            "Check the path and the permissions.",
        ) from None
    if len(raw) > largest:
        raise InputError(*too_large(f"{kind} file {name}", largest), "Check the path.")
    try:
        return raw.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise InputError(
            f"The {kind} file {name} is not text in UTF-8.",
            "Only text in UTF-8 is read.",
            "Save it as UTF-8.",
        ) from None


def table_rows(package: str, name: str) -> list[dict[str, str]]:
    """Return the rows of a table of this program.

    Parameters
    ----------
    package : Package in whose folder ``data`` the table is, such as ``thalweg.chart``.
    name : Name of the file, ``.csv`` or ``.csv.gz``, in UTF-8.

    Returns
    -------
    list of dict : The text of each row by the names of the columns.
    """
    content = resources.files(package).joinpath("data", name).read_bytes()
    text = (gzip.decompress(content) if name.endswith(".gz") else content).decode("utf-8")
    return list(csv.DictReader(text.splitlines()))


def cause_of(error: Exception) -> str:
    """Return why a file cannot be read, without the number and the path of the system's error."""
    return str(getattr(error, "strerror", None) or error)


def too_large(what: str, largest: float, size: float | None = None) -> tuple[str, str]:
    """Return what is wrong with something that is too large, and what is possible.

    Parameters
    ----------
    largest, size : Bytes; the size if it is known.
    """
    has = "" if size is None else f": it has {size / 1e6:.1f} MB"
    return f"The {what} is too large{has}.", f"At most {largest / 1e6:,g} MB are taken."
