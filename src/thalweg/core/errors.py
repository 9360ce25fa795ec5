"""Errors for users: each states what was requested, what is possible and what to do."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final

import numpy as np


class ThalwegWarning(UserWarning):
    """A message for the user that does not stop the computation."""


class ThalwegError(Exception):
    """Base class of the errors for users.

    Parameters
    ----------
    asked : str
        What was requested and why it is not possible.
    possible : str, optional
        What is possible instead.
    remedy : str, optional
        What the user can do.
    **details
        Machine-readable facts (field, value, file, ...), stored in ``details``.
    """

    def __init__(self, asked: str, possible: str = "", remedy: str = "", **details: Any) -> None:
        self.asked, self.possible, self.remedy = asked, possible, remedy
        self.details = details
        super().__init__(" ".join(part for part in (asked, possible, remedy) if part))

    def as_dict(self) -> dict[str, Any]:
        """Return the error as plain data for a JSON answer; NaN and infinity become None.

        Returns
        -------
        dict
            ``error`` (the class), ``asked``, ``possible``, ``remedy`` and ``details``.
        """
        return {
            "error": type(self).__name__,
            "asked": self.asked,
            "possible": self.possible,
            "remedy": self.remedy,
            "details": {key: _json_value(value) for key, value in self.details.items()},
        }


@contextmanager
def errors_about(field: str) -> Iterator[None]:
    """Name the field of a request in errors that do not name one."""
    try:
        yield
    except ThalwegError as error:
        error.details.setdefault("field", field)
        raise


class InputError(ThalwegError, ValueError):
    """A request, a file or a value given by the user cannot be used."""


class CoverageError(ThalwegError):
    """The data do not cover the request."""


class OutsideAreaError(CoverageError):
    """A position is outside the area of the data."""


class OutsidePeriodError(CoverageError):
    """A time is outside the period of the data."""


class MissingVariableError(CoverageError):
    """A variable that is needed is in none of the data."""


class DatasetError(ThalwegError):
    """A data file is broken, ambiguous or in units that make no sense."""


class ModelRangeError(ThalwegError):
    """A model was evaluated outside its range of validity."""


#: Reasons whose names say less than they count.
_IN_WORDS: Final = {"no-go zone": "no-go zone or closed shoal area"}


def reasons_text(reasons: Mapping[str, int]) -> str:
    """Return reasons for which legs were refused and their counts: ``land: 12, depth: 3``."""
    return ", ".join(f"{_IN_WORDS.get(name, name)}: {n:,}" for name, n in reasons.items() if n)


class NoRouteError(ThalwegError):
    """No route exists on the network within the limits.

    Parameters
    ----------
    asked, possible, remedy : str
        As in `ThalwegError`.
    reasons : mapping of str to int
        How many legs were refused for each reason.
    nearest : tuple of float, optional
        Latitude and longitude [deg] of the reached point nearest to the goal.
    """

    def __init__(
        self,
        asked: str,
        possible: str = "",
        remedy: str = "",
        *,
        reasons: Mapping[str, int] | None = None,
        nearest: tuple[float, float] | None = None,
        **details: Any,
    ) -> None:
        self.reasons = dict(reasons or {})
        self.nearest = nearest
        super().__init__(asked, possible, remedy, reasons=self.reasons, nearest=nearest, **details)

    @property
    def reasons_text(self) -> str:
        """The reasons and their counts, such as ``land: 12, depth: 3``."""
        return reasons_text(self.reasons)


class NoPathError(NoRouteError):
    """The water that a ship may use does not join two places, whatever the weather."""


def close_matches(word: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Return the known words that look most like ``word``, best first, ignoring case.

    Names that go on with an underscore, such as that of a unit, come first; names that have a rare
    word in common with it come before those that are only spelled alike.

    Parameters
    ----------
    word : The unknown word.
    known : Words to compare with.
    count : Largest number of results.

    Returns
    -------
    list of str : Best match first.
    """
    by_lower = {name.casefold(): name for name in known}
    shared = [name for name in by_lower if name.startswith(f"{word.casefold()}_")]  # without unit
    shared += _sharing_a_word(word, by_lower)
    alike = difflib.get_close_matches(word.casefold(), list(by_lower), n=count, cutoff=0.55)
    return [by_lower[name] for name in list(dict.fromkeys([*shared, *alike]))[:count]]


def names_in_words(names: Sequence[str]) -> str:
    """Return names, one or more, as a list in words: ``A, B and C``."""
    return " and ".join([*filter(None, [", ".join(names[:-1])]), names[-1]])


_MOST_NAMES = 20  # that an error lists, the nearest in spelling first if there are more


def _likeness(word: str, name: str) -> float:
    return difflib.SequenceMatcher(None, word.casefold(), name.casefold()).ratio()


_RARE = 3  # a word that more known names have, such as "strait", does not tell names apart
_LEAST_LETTERS = 4  # of a word that two names may share
_SAME_WORD = 0.85  # likeness of two spellings of one word


def _words(name: str) -> set[str]:
    return {word for word in re.findall(r"[^\W_]+", name.casefold()) if len(word) >= _LEAST_LETTERS}


def _sharing_a_word(word: str, known: Iterable[str]) -> list[str]:
    """Return the known names that have a rare word in common with a name, most alike first.

    A word that is spelled almost the same counts as well.
    """
    having: dict[str, set[str]] = {}
    for name in known:
        for part in _words(name):
            having.setdefault(part, set()).add(name)
    found: set[str] = set()
    for wanted in _words(word):
        parts = difflib.get_close_matches(wanted, having, n=_RARE, cutoff=_SAME_WORD)
        names = {name for part in parts for name in having[part]}
        found |= names if len(names) <= _RARE else set()
    return sorted(found, key=lambda name: (-_likeness(word, name), name))


def nearest_names(word: str, known: Iterable[str]) -> str:
    """Return known names as a text: all of them, or the nearest in spelling if there are more.

    Parameters
    ----------
    word : The unknown name.
    """
    names = sorted(known)
    if len(names) <= _MOST_NAMES:
        return ", ".join(names)
    shared = _sharing_a_word(word, names)
    others = sorted(set(names) - set(shared), key=lambda name: (-_likeness(word, name), name))
    nearest = [*shared, *others][:_MOST_NAMES]
    return f"{', '.join(nearest)} and {len(names) - _MOST_NAMES} more"


def unknown_name_error(
    kind: str, word: str, known: Iterable[str], *, field: str | None = None
) -> InputError:
    """Build the error for a name that is not among the known ones, with near matches.

    Parameters
    ----------
    kind : Kind of the name, for the message, such as ``"method"``.
    field : Entry of a request that holds the name.

    Returns
    -------
    InputError : With the known names that are nearest in spelling.
    """
    names = sorted(known)
    near = close_matches(word, names)
    listed = nearest_names(word, names)
    remedy = f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "Check the name."
    place = {} if field is None else {"field": field}
    return InputError(
        f"There is no {kind} named {word!r}.",
        f"Known: {listed}.",
        remedy,
        value=word,
        near=near,
        **place,
    )


#: Entries that files of each kind have, and what takes such a file.
_FILE_SIGNS: Final = {
    "a dredging project": ({"load", "unload", "volume_m3"}, "thalweg project FILE plans it"),
    "a study": ({"voyage"}, "thalweg study run FILE runs it"),
    "a ship": ({"hull"}, "Give it as --ship FILE, or as the ship of a voyage or a study"),
}


def refuse_other_file(data: Mapping[str, Any], wanted: str) -> None:
    """Raise `InputError` where the entries of a file are those of another kind of file.

    Parameters
    ----------
    data : Entries of the file.
    wanted : "a ship", "a study" or "a dredging project".
    """
    if not isinstance(data, Mapping):
        return  # refused by its reader
    for kind, (entries, remedy) in _FILE_SIGNS.items():
        if kind != wanted and entries <= set(data):
            raise InputError(
                f"The file describes {kind}, and {wanted} is needed.",
                f"It has {' and '.join(sorted(entries))}.",
                f"{remedy}.",
            )


def _json_value(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(k): _json_value(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, set, frozenset)):
        return [_json_value(v) for v in value]
    if isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind in "biuf":
        return _json_value(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, int) and value.bit_length() > 64:
        return None  # JSON readers cannot take it, and Python may refuse to write it
    if isinstance(value, (str, int, bool)) or value is None:
        return value
    return str(value)
