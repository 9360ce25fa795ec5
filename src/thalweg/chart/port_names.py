"""Comparison of names of ports: without case, accents, punctuation and words for "port"."""

from __future__ import annotations

import difflib
import functools
import re
import unicodedata
from collections.abc import Iterable
from typing import Final, Protocol

from thalweg.core.errors import InputError
from thalweg.core.file_reading import table_rows

#: Letters that are not a base letter with an accent.
_LETTER_SUBSTITUTES: Final = str.maketrans(
    {"ø": "o", "æ": "ae", "œ": "oe", "ł": "l", "đ": "d", "ð": "d", "ı": "i"}
)
#: Words for "port" before and after the name of a place; the longer forms come first.
_PORT_WORDS_BEFORE: Final = (
    "port of ",
    "port de ",
    "porto di ",
    "porto de ",
    "puerto de ",
    "puerto del ",
    "bahia de ",
    "rade de ",
    "port ",
    "porto ",
    "puerto ",
    "mina ",
    "rada ",
)
_PORT_WORDS_AFTER: Final = (
    " harbours",
    " harbors",
    " harbour",
    " harbor",
    " port",
    " gang",
    " hang",
    " ko",
    " luka",
    " hamn",
    " havn",
)
#: Least share of letters in common of names that are slips of another (`difflib`), and by how much
#: less than the best one has it.
_ALIKE: Final = 0.7
_AS_ALIKE: Final = 0.12
#: A place name of fewer letters is not shortened further.
_SHORTEST_PLACE: Final = 4
#: A name of fewer letters is compared letter by letter.
_SHORTEST_LOOSE: Final = 6
_SAME_LETTERS: Final = str.maketrans("yj", "ii")
#: A space for every ASCII character that is neither letter nor digit.
_SPACES: Final = {code: " " for code in range(128) if not chr(code).isalnum()}


def normalised_port_name(text: str) -> str:
    """Return text without case, accents, punctuation and double spaces; "St." is "saint"."""
    plain = text.casefold()
    if plain.isascii():
        words = plain.translate(_SPACES).split()
    else:
        plain = unicodedata.normalize("NFKD", plain.translate(_LETTER_SUBSTITUTES))
        kept = (c if c.isalnum() else " " for c in plain if not unicodedata.combining(c))
        words = "".join(kept).split()
    return " ".join("saint" if word == "st" else word for word in words)


def place_name(normalised: str) -> str:
    """Return a normalised name without the word for "port" ("puerto colon" is "colon")."""
    if not (normalised.startswith(_PORT_WORDS_BEFORE) or normalised.endswith(_PORT_WORDS_AFTER)):
        return normalised
    for word in _PORT_WORDS_BEFORE:
        if normalised.startswith(word) and len(normalised) - len(word) >= _SHORTEST_PLACE:
            return normalised.removeprefix(word)
    for word in _PORT_WORDS_AFTER:
        if normalised.endswith(word) and len(normalised) - len(word) >= _SHORTEST_PLACE:
            return normalised.removesuffix(word)
    return normalised


def written_names(name: str) -> tuple[str, ...]:
    """Return the names in one field: the whole, the part before brackets, the part in brackets.

    "Mumbai (Bombay)" is also Mumbai and Bombay.
    """
    outside, bracket, inside = name.partition("(")
    if not bracket:
        return (name,)
    return tuple(n for n in (name, outside.strip(" -"), inside.strip(" )")) if n)


def loose_port_names(normalised: str) -> tuple[str, ...]:
    """Return forms of a normalised name that other spellings of it share; empty for short names.

    Spaces do not count, nor whether a transliteration has y, j or i and one or two of them
    ("kamchatskiy", "kamchatskii", "kamchatsky"). A name of several words is also that without an
    adjective of a region behind it ("petropavlovsk kamchatskiy" is "petropavlovsk").
    """
    words = [_same_spelling(word) for word in normalised.split()]
    forms = ["".join(words)]
    if len(words) > 1 and words[-1].endswith("ski"):
        forms.append("".join(words[:-1]))
    return tuple(form for form in forms if len(form) >= _SHORTEST_LOOSE)


def _same_spelling(word: str) -> str:
    """Return a word with one spelling for letters that transliterations spell differently."""
    plain = word.translate(_SAME_LETTERS)
    while "ii" in plain:
        plain = plain.replace("ii", "i")
    return plain


def decimal_commas_error(text: str) -> InputError | None:
    """Return the error of a position with decimal commas, such as ``51,45 3,20``; else None."""
    if not re.fullmatch(r"\s*-?\d{1,2},\d+[ ;]\s*-?\d{1,3},\d+\s*", text):
        return None
    return InputError(
        f"{text!r} is not a position.",
        "Degrees have decimal points; a comma stands between latitude and longitude.",
        f"Give {text.strip().replace(',', '.').replace(';', ' ')!r}.",
        value=text,
    )


def names_spelt_alike(wanted: str, names: Iterable[str]) -> list[str]:
    """Return the names that a word may be a slip of, best first; none if all differ much."""
    alike = difflib.get_close_matches(wanted, list(names), n=4, cutoff=_ALIKE)
    shares = [difflib.SequenceMatcher(None, name, wanted).ratio() for name in alike]
    return [name for name, share in zip(alike, shares) if share >= shares[0] - _AS_ALIKE]


@functools.cache
def _states() -> tuple[dict[str, str], ...]:
    """The rows of ``data/states.csv``: states and provinces, each with a box round its ports."""
    return tuple(table_rows("thalweg.chart", "states.csv"))


class _Located(Protocol):
    @property
    def country_code(self) -> str: ...
    @property
    def lat(self) -> float: ...
    @property
    def lon(self) -> float: ...


def is_in_state(place: str, port: _Located) -> bool:
    """Return whether a port is in a state or province, by its code ("TX") or name.

    Those of Australia, Canada and the United States are known, by boxes round their ports.
    """
    name = normalised_port_name(place)
    return any(
        row["country_code"] == port.country_code
        and name in (row["code"].lower(), normalised_port_name(row["name"]))
        and float(row["south"]) <= port.lat <= float(row["north"])
        and float(row["west"]) <= port.lon <= float(row["east"])
        for row in _states()
    )
