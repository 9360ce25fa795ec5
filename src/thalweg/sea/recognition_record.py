"""The variables that were recognised in files, and those that were ignored with the reason."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RecognisedVariable:
    """A canonical variable and the file variables it is made from.

    Attributes
    ----------
    variable : Canonical name.
    file_variables : Names in the file.
    units : As spelled in the file.
    how : How it was recognised and converted.
    source : File names.
    """

    variable: str
    file_variables: tuple[str, ...]
    units: str
    how: str
    source: str


@dataclass(frozen=True)
class RecognitionRecord:
    """The recognised and the ignored variables in the files of one layer.

    Attributes
    ----------
    recognised : Variables that are used.
    ignored : tuple of (file, variable, reason)
        Variables that are not used.
    """

    recognised: tuple[RecognisedVariable, ...] = ()
    ignored: tuple[tuple[str, str, str], ...] = ()
