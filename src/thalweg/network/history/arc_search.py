"""Shortest ways over the arcs of a history network, with the gaps between lines of voyages."""

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
