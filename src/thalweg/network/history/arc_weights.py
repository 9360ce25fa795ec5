"""By how much arcs of few voyages, and arcs that were not sailed, count as longer."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.arc_statistics import ArcEvidence

#: Arcs sailed in the other direction only, and ways over the globe, count this many times their
#: length in the choice of the way.
REVERSED_FACTOR, GLOBE_FACTOR = 1.5, 2.0
_FEW: Final = 1.25  # and arcs of few voyages
_STRAY: Final = 2.0  # and strays beside a well-used way
_QUARTER: Final = 4  # an arc with less than this part of the voyages of one beside it has few
_FIFTH: Final = 5  # and with less than this part of those of two arcs in turn it is a stray


def doubt_factors(
    ends: tuple[IntArray, IntArray],
    count: IntArray,
    length: FloatArray,
    following: tuple[IntArray, IntArray],
    *,
    few: BoolArray,
    slack: float,
) -> FloatArray:
    """Return how many times its length each sailed arc counts, (A,).

    An arc has few voyages if that is given, or if they are less than a quarter of those of another
    arc between the same two nodes. It is a stray if it has less than a fifth of the voyages of two
    arcs in turn that join the same two nodes and are hardly longer: both are the same way, on which
    most ships pass another junction.

    Parameters
    ----------
    ends : Nodes of the arcs, (tail, head).
    count : Voyages on each arc, (A,).
    length : Of the arcs [m], (A,).
    following : Pairs of arcs that follow each other at a junction.
    few : Arcs of few voyages in all, (A,).
    slack : Two arcs are hardly longer within this length [m].
    """
    tail, head = ends
    nodes = int(max(tail.max(initial=0), head.max(initial=0))) + 1
    key = tail * nodes + head
    pairs, number = np.unique(key, return_inverse=True)
    busiest = np.zeros(len(pairs), np.int64)
    np.maximum.at(busiest, number, count)
    factor = np.where(few | (_QUARTER * count < busiest[number]), _FEW, 1.0)
    before, after = following
    over = tail[before] * nodes + head[after]
    found = np.minimum(np.searchsorted(pairs, over), max(len(pairs) - 1, 0))
    beside = np.flatnonzero(pairs[found] == over) if len(pairs) else np.empty(0, np.int64)
    before, after, found = before[beside], after[beside], found[beside]
    shortest = np.full(len(pairs), np.inf)
    np.minimum.at(shortest, number, length)
    near = length[before] + length[after] <= shortest[found] + slack
    through = np.zeros(len(pairs), np.int64)
    np.maximum.at(through, found[near], np.minimum(count[before], count[after])[near])
    return np.where(_FIFTH * count < through[number], _STRAY, factor)


def longer_if_repaired(evidence: ArcEvidence, line: FloatArray, repaired: FloatArray) -> FloatArray:
    """Return the median lengths of the voyages on arcs, (A,) [m]; of the line where none is known.

    Parameters
    ----------
    line : Lengths of the lines [m], (A,); of lines that were repaired the longer of both counts.
    repaired : Share of every line that is no track, (A,).
    """
    median = np.where(np.isfinite(evidence.length[:, 1]), evidence.length[:, 1], line)
    return np.where(repaired > 0.0, np.maximum(median, line), median)
