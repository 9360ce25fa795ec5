"""What arcs of a history network count, and shortest ways over them with the gaps between lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.route_lines import following_arcs

#: Arcs sailed in the other direction only, and ways over the globe, count this many times their
#: length in the choice of the way.
REVERSED_FACTOR, GLOBE_FACTOR = 1.5, 2.0
_FEW: Final = 1.25  # and arcs of few voyages
_STRAY: Final = 2.0  # and strays beside a well-used way
_QUARTER: Final = 4  # an arc with less than this part of the voyages of one beside it has few
_FIFTH: Final = 5  # and with less than this part of those of two arcs in turn it is a stray
_FAR_ROUND: Final = 1.5  #: times a way: sailed ways that are longer are no usual ones


@dataclass(frozen=True, eq=False)
class ArcGraph:
    """A graph whose vertices are arcs: two voyages may pass one junction far from each other.

    Vertices are the A arcs, then the N nodes where ways begin, then those where ways end.

    Parameters
    ----------
    indptr, target : Edges by their first vertex.
    arc : Arc that an edge leads to; A for an end of a way.
    gap : Distance between the line of the arc before and that of this arc [m].
    nodes : N.
    """

    indptr: IntArray
    target: NDArray[np.int32]
    arc: IntArray
    gap: FloatArray
    nodes: int

    @classmethod
    def of_arcs(cls, tail: IntArray, head: IntArray, lines: ArcLines, at_port: BoolArray
                ) -> ArcGraph:  # fmt: skip
        """Return the graph of some arcs.

        Parameters
        ----------
        tail, head : Nodes of the arcs, (A,).
        lines : Of the arcs.
        at_port : Nodes at which no distance between lines counts, (N,).
        """
        arcs, nodes = len(tail), len(at_port)
        before, after = following_arcs(tail, head, np.zeros(nodes, bool))
        last, first = lines.ptr[1:][before] - 1, lines.ptr[:-1][after]
        gap = distance(lines.lat[last], lines.lon[last], lines.lat[first], lines.lon[first])
        gap = np.where(at_port[head[before]], 0.0, gap)
        every, none = np.arange(arcs), np.zeros(arcs)
        source = np.concatenate([before, arcs + tail, every])
        target = np.concatenate([after, every, arcs + nodes + head])
        order = np.argsort(source, kind="stable")
        indptr = np.searchsorted(source[order], np.arange(arcs + 2 * nodes + 1))
        return cls(
            indptr.astype(np.int64),
            target[order].astype(np.int32),
            np.minimum(target[order], arcs),
            np.concatenate([gap, none, none])[order],
            nodes,
        )

    def path(self, start: int, goal: int, weight: FloatArray) -> list[int]:
        """Return the arcs of the way of least weight between two nodes; empty if there is none.

        Parameters
        ----------
        start, goal : Nodes.
        weight : Of every arc, (A,); inf for those that are closed.
        """
        arcs, count = len(weight), len(self.indptr) - 1
        cost = np.append(weight, 0.0)[self.arc] + self.gap
        known, parent = np.empty(count), np.empty(count, np.int64)
        first, last = arcs + start, arcs + self.nodes + goal
        static_astar(self.indptr, self.target, cost, np.zeros(count), first, last, known, parent)
        if not np.isfinite(known[last]):
            return []
        found, vertex = [], int(parent[last])
        while vertex != first:
            found.append(vertex)
            vertex = int(parent[vertex])
        return found[::-1]

    def path_by_sailed_arcs(
        self, ends: tuple[int, int], weight: FloatArray, sailed: BoolArray, length: FloatArray,
        slack: float,
    ) -> list[int]:  # fmt: skip
        """Return the way of least weight, of sailed arcs alone unless that is far round.

        Far round is more than one and a half times the way over other arcs, and longer by more than
        the slack [m].

        Parameters
        ----------
        ends : Nodes of start and goal.
        sailed : Arcs that were sailed in their direction, (A,).
        length : Of the arcs [m], (A,).
        """
        found = self.path(*ends, weight)
        if not found or sailed[found].all():
            return found
        other = self.path(*ends, np.where(sailed, weight, np.inf))
        least = float(length[found].sum())
        near = max(_FAR_ROUND * least, least + slack)
        return other if other and float(length[other].sum()) <= near else found


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
