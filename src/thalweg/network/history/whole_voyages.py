"""Whole voyages from port to port: usual ways between two ports that ships sail without a call."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.arc_statistics import PERCENTILES, ArcEvidence, group_percentiles
from thalweg.network.history.history_arcs import HistoryArcs
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.voyage_tracks import VoyageTracks


@dataclass(frozen=True, eq=False)
class VoyagePairs:
    """Pairs of ports between which ships sailed, P in total.

    Parameters
    ----------
    tail, head : Nodes of the ports, (P,), each pair once.
    count : Voyages, (P,).
    duration : p10, p50 and p90 of the time under way from sea end to sea end [s], (P, 3).
    """

    tail: IntArray
    head: IntArray
    count: IntArray
    duration: FloatArray

    @classmethod
    def none(cls) -> VoyagePairs:
        """Return no pairs, as of files that do not have them."""
        nothing = np.empty(0, np.int64)
        return cls(nothing, nothing, nothing, np.empty((0, 3)))

    def of(self, start: int, goal: int) -> tuple[int, FloatArray]:
        """Return how many voyages sailed between two ports, and their durations [s], (3,).

        Parameters
        ----------
        start, goal : Nodes.
        """
        found = np.flatnonzero((self.tail == start) & (self.head == goal))
        if not len(found):
            return 0, np.full(3, np.nan)
        return int(self.count[found[0]]), self.duration[found[0]]


def with_whole_voyages(
    tracks: VoyageTracks, stretches: ArcOccurrences, first_port: int, at_canal: BoolArray
) -> tuple[ArcOccurrences, VoyagePairs]:
    """Return stretches of tracks with whole voyages among them, and the pairs of ports.

    A voyage through a canal is not added as a whole: lines lead through canals by arcs of their
    own. Nor are round trips.

    Parameters
    ----------
    stretches : From node to node, in order of voyages and along them.
    first_port : Node of the first port; junctions come before.
    at_canal : Which junctions are ends of canals, (first_port,).

    Returns
    -------
    stretches : Those with a junction at one end at least, then the whole voyages.
    pairs : Of all voyages.
    """
    voyage, first = np.unique(stretches.voyage, return_index=True)
    if not len(voyage):
        return stretches, VoyagePairs.none()
    last = np.append(first[1:], len(stretches)) - 1
    whole = ArcOccurrences(
        voyage, stretches.tail[first], stretches.head[last], stretches.begin[first],
        stretches.end[last],
    )  # fmt: skip
    canal = np.append(at_canal, False)
    by_canal = canal[np.minimum(stretches.tail, first_port)]
    by_canal |= canal[np.minimum(stretches.head, first_port)]
    there = whole.tail != whole.head
    pairs = _pairs(tracks, whole.take(there))
    whole = whole.take(there & ~np.bitwise_or.reduceat(by_canal, first))
    parts = stretches.take((stretches.tail < first_port) | (stretches.head < first_port))
    columns = [
        np.concatenate([getattr(parts, column.name), getattr(whole, column.name)])
        for column in fields(ArcOccurrences)
    ]
    return ArcOccurrences(*columns), pairs


def _pairs(tracks: VoyageTracks, whole: ArcOccurrences) -> VoyagePairs:
    """Return the pairs of ports of whole voyages."""
    if not len(whole):
        return VoyagePairs.none()
    order = np.lexsort((whole.head, whole.tail))
    ends = np.stack([whole.tail, whole.head], axis=1)[order]
    pairs, first, count = np.unique(ends, axis=0, return_index=True, return_counts=True)
    time = tracks.values_at(tracks.under_way, whole.end)
    time -= tracks.values_at(tracks.under_way, whole.begin)
    ptr = np.append(first, len(whole)).astype(np.int64)
    return VoyagePairs(
        pairs[:, 0], pairs[:, 1], count.astype(np.int64),
        group_percentiles(time[order], ptr, PERCENTILES),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class WholeWays:
    """The arcs from port to port.

    Parameters
    ----------
    between : Arcs by the nodes of both ports.
    kind, evidence : Of all arcs.
    """

    between: dict[tuple[int, int], list[int]]
    kind: IntArray
    evidence: ArcEvidence

    @classmethod
    def of_arcs(cls, arcs: HistoryArcs, first_port: int) -> WholeWays:
        """Return those of some arcs; ports are the nodes from the first one on."""
        between: dict[tuple[int, int], list[int]] = {}
        for arc in np.flatnonzero((arcs.tail >= first_port) & (arcs.head >= first_port)).tolist():
            between.setdefault((int(arcs.tail[arc]), int(arcs.head[arc])), []).append(arc)
        return cls(between, arcs.kind, arcs.evidence)

    def open_ways(
        self, ends: tuple[int, int], weight: FloatArray, kind: int, month: int | None = None
    ) -> list[int]:
        """Return the arcs of a kind between two ports, that of most voyages first.

        Parameters
        ----------
        weight : Of every arc, (A,); inf for those that are closed.
        kind : Index in `ARC_KINDS`.
        month : 1 to 12: voyages in this month count before others.
        """
        found = [
            arc
            for arc in self.between.get(ends, [])
            if self.kind[arc] == kind and np.isfinite(weight[arc])
        ]
        seen, count = self.evidence.months, self.evidence.count
        return sorted(
            found,
            key=lambda arc: (0 if month is None else seen[arc, month - 1], count[arc]),
            reverse=True,
        )
