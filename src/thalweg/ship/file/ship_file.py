"""Read ship files (YAML) safely, from a path or from the library."""

from __future__ import annotations

from importlib import resources
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import InputError, close_matches
from thalweg.ship.plugins import plugin_names

LARGEST_FILE: Final = 256 * 1024  #: bytes; a ship file has a few thousand
_SUFFIXES = (".yaml", ".yml")


def library_names() -> list[str]:
    """Return the names of the ships in the library.

    Returns
    -------
    list of str
        In alphabetical order.
    """
    folder = resources.files("thalweg.ship").joinpath("library")
    return sorted(
        f.name.removesuffix(".yaml") for f in folder.iterdir() if f.name.endswith(".yaml")
    )


def read_ship(name_or_path: str | Path) -> tuple[Any, str]:
    """Return the plain data of a ship of the library or of a file, and what to call it.

    Raises
    ------
    InputError : If there is no such ship or file, or the file is not readable YAML.
    """
    text = str(name_or_path)
    path = Path(text)
    if isinstance(name_or_path, Path) or path.suffix.lower() in _SUFFIXES or "/" in text:
        return _read_file(path)
    if text in library_names():
        found = resources.files("thalweg.ship").joinpath("library", f"{text}.yaml")
        return parse_ship(found.read_text(encoding="utf-8"), text), f"library ship {text!r}"
    if _is_file(path):
        return _read_file(path)
    names = [*library_names(), *plugin_names()]
    near = close_matches(text, names)
    raise InputError(
        f"There is no ship named {text!r}, and no file of that name.",
        f"Ships with a name: {', '.join(names)}.",
        f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "Give a name or a file.",
        value=text,
        near=near,
    )


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long, or no name of a file
        return False


def _read_file(path: Path) -> tuple[Any, str]:
    try:
        with path.open("rb") as stream:
            raw = stream.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as problem:
        why = problem.strerror if isinstance(problem, OSError) else problem
        raise InputError(
            f"The ship file {path} cannot be read: {why}.",
            f"Library: {', '.join(library_names())}.",
            "Give the path of a YAML file, or a name of the library.",
            file=str(path),
        ) from None
    if len(raw) > LARGEST_FILE:
        raise InputError(
            f"The ship file {path} is larger than {LARGEST_FILE // 1024} kB.",
            "A ship file has a few thousand bytes.",
            "Check that it is a ship file.",
            file=str(path),
        )
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(
            f"The ship file {path} is not text in UTF-8.",
            "Ship files are YAML text in UTF-8.",
            "Save it as UTF-8.",
            file=str(path),
        ) from None
    return parse_ship(text, path.name), f"ship file {path.name}"


def parse_ship(text: str, source: str) -> Any:
    """Return plain data from YAML text; keys given twice and references are refused.

    Raises
    ------
    InputError : With the line of the fault.
    """
    from thalweg.core.strict_yaml import parse_yaml  # reads a library that few calls need

    return parse_yaml(text, "ship", source)
