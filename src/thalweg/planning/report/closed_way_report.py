"""Notes on canals and passages that are closed to a ship, where a way through them is shorter."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final, TypeAlias

import numpy as np

from thalweg.chart.canals import Canal
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.core.errors import names_in_words
from thalweg.core.geodesy import Position
from thalweg.planning.seaways import Seaways

NarrowWay: TypeAlias = Passage | Canal
PASSAGE_CLOSED: Final = "Passage closed"  #: a note on a passage that is closed begins so
#: ... and so, where the route itself leads through it
CLOSED_ON_ROUTE: Final = f"{PASSAGE_CLOSED}: the route leads through"
PASSAGES_CLOSED: Final = "Passages closed"  #: ... or so, where it is on several


def ways_of_names(seas: Seaways, names: Sequence[str]) -> list[NarrowWay]:
    """Return the canals and passages of seas that have these names."""
    every: tuple[NarrowWay, ...] = (*seas.chart.canals, *seas.chart.passages)
    return [way for way in every if way.name in names]


def ways_on_line(
    seas: Seaways, ways: Sequence[NarrowWay], line: Sequence[Position]
) -> list[NarrowWay]:
    """Return those of some canals and passages that a line leads through; canals first."""
    lat, lon = np.array(line, float).T
    number = np.asarray(seas.chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    canals: list[NarrowWay] = [seas.chart.canals[k] for k in number[number >= 0].tolist()]
    passages = [way for way in ways if isinstance(way, Passage)]
    crossed = passages_crossed(seas.chart.coastline, passages, lat, lon)
    return [canal for canal in canals if canal in ways] + [passage for _, passage in crossed]


def notes_by_reason(reasons: Mapping[str, str]) -> list[tuple[list[str], str]]:
    """Return the names of canals and passages closed for one reason and a note, for each reason.

    Parameters
    ----------
    reasons : By name; with the name before them, or not.

    Returns
    -------
    list of (list of str, str) : The note has no full stop.
    """
    alike: dict[str, list[str]] = {}
    for name, reason in reasons.items():
        alike.setdefault(reason.removeprefix(f"{name}: "), []).append(name)
    return [(names, _note_on_alike(names, reason)) for reason, names in alike.items()]


def _note_on_alike(names: Sequence[str], reason: str) -> str:
    if len(names) == 1:
        why = reason if reason.startswith(names[0]) else f"{names[0]}: {reason}"
        return f"{PASSAGE_CLOSED}: {why}"
    reason = re.sub(r"^it is\b", "they are", reason)
    return f"{PASSAGES_CLOSED}: {names_in_words(names)}: {reason}"


def title_of_way(way: NarrowWay) -> str:
    """Return the title of a canal, the name of a passage."""
    return way.title if isinstance(way, Canal) else way.name
