"""Whole voyages from port to port: usual ways between two ports that ships sail without a call."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Final

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.arc_statistics import (
    PERCENTILES,
    ArcEvidence,
    FoundArcs,
    group_percentiles,
    voyage_months,
)
from thalweg.network.history.history_arcs import SAILED, HistoryArcs, HistoryNodes
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.season_masks import LEAST_SAMPLES, MONTHS
from thalweg.network.history.voyage_tracks import VoyageTracks

_BESIDE: Final = 20.0 * NAUTICAL_MILE  # ports so near to each other may be one harbour
_WIDE_GAP: Final = 0.15  # of the length of a voyage


@dataclass(frozen=True, eq=False)
class VoyagePairs:
    """Pairs of ports between which ships sailed through a canal, P in total.

    Parameters
    ----------
    tail, head : Nodes of the ports, (P,), each pair once.
    count : Voyages, (P,).
    duration : p10, p50 and p90 of the time under way from sea end to sea end [s], (P, 3).
    months : Voyages by month, January first, (P, 12).
    """

    tail: IntArray
    head: IntArray
    count: IntArray
    duration: FloatArray
    months: IntArray

    @classmethod
    def none(cls) -> VoyagePairs:
        """Return no pairs, as of files that do not have them."""
        nothing = np.empty(0, np.int64)
        return cls(nothing, nothing, nothing, np.empty((0, 3)), np.empty((0, MONTHS), np.int64))

    def with_arcs(self, found: FoundArcs, arcs: IntArray) -> VoyagePairs:
        """Return pairs with those of some arcs that have no line: most of it is in a canal.

        Parameters
        ----------
        found : All arcs.
        arcs : Which of them; of pairs that are known already none is added.
        """
        known = set(zip(self.tail.tolist(), self.head.tolist()))
        ends = list(zip(found.tail[arcs].tolist(), found.head[arcs].tolist()))
        first = {pair: k for k, pair in reversed(list(enumerate(ends))) if pair not in known}
        new, evidence = arcs[sorted(first.values())], found.evidence
        return VoyagePairs(
            np.concatenate([self.tail, found.tail[new]]),
            np.concatenate([self.head, found.head[new]]),
            np.concatenate([self.count, evidence.count[new]]),
            np.concatenate([self.duration, evidence.duration[new]]),
            np.concatenate([self.months, evidence.months[new]]),
        )

    def of(self, start: int, goal: int) -> tuple[int, FloatArray]:
        """Return how many voyages sailed between two ports, and their durations [s], (3,).

        Parameters
        ----------
        start, goal : Nodes.
        """
        row = self._row(start, goal)
        return (
            (0, np.full(3, np.nan)) if row is None else (int(self.count[row]), self.duration[row])
        )

    def voyages(self, start: int, goal: int, month: int | None) -> tuple[int, int]:
        """Return how many voyages sailed between two ports in a month, and in all.

        Parameters
        ----------
        start, goal : Nodes.
        month : 1 to 12; None: the first number is 0.
        """
        row = self._row(start, goal)
        if row is None:
            return 0, 0
        in_month = 0 if month is None else int(self.months[row, month - 1])
        return in_month, int(self.count[row])

    def _row(self, start: int, goal: int) -> int | None:
        found = np.flatnonzero((self.tail == start) & (self.head == goal))
        return int(found[0]) if len(found) else None


def with_whole_voyages(
    tracks: VoyageTracks,
    stretches: ArcOccurrences,
    first_port: int,
    by_canal: BoolArray,
    *,
    least: int,
) -> tuple[ArcOccurrences, VoyagePairs]:
    """Return stretches of tracks with whole voyages among them, and the pairs of ports.

    A voyage through a canal is not added as a whole: lines lead through canals by arcs of their
    own. Nor are round trips, and voyages of which a great part is not known where enough others
    are.

    Parameters
    ----------
    stretches : From node to node, in order of voyages and along them.
    first_port : Node of the first port; junctions come before.
    by_canal : Which voyages pass a canal, (V,).
    least : Least number of voyages for a route to be accepted.

    Returns
    -------
    stretches : Those with a junction at one end at least, then the whole voyages.
    pairs : Of the voyages through canals.
    """
    voyage, first = np.unique(stretches.voyage, return_index=True)
    if not len(voyage):
        return stretches, VoyagePairs.none()
    last = np.append(first[1:], len(stretches)) - 1
    whole = ArcOccurrences(
        voyage, stretches.tail[first], stretches.head[last], stretches.begin[first],
        stretches.end[last],
    )  # fmt: skip
    there, canal = whole.tail != whole.head, by_canal[voyage]
    pairs = _pairs(tracks, whole.take(there & canal))
    whole = _well_known(tracks, whole.take(there & ~canal), least)
    parts = stretches.take((stretches.tail < first_port) | (stretches.head < first_port))
    columns = [
        np.concatenate([getattr(parts, column.name), getattr(whole, column.name)])
        for column in fields(ArcOccurrences)
    ]
    return ArcOccurrences(*columns), pairs


def _well_known(tracks: VoyageTracks, whole: ArcOccurrences, least: int) -> ArcOccurrences:
    """Return voyages without those with a wide gap, where enough without one sailed that way."""
    if not len(whole):
        return whole
    longest = np.maximum.reduceat(tracks.steps, tracks.ptr[:-1])[whole.voyage]
    known = longest <= _WIDE_GAP * (whole.end - whole.begin)
    ends = np.stack([whole.tail, whole.head], axis=1)
    pair = np.unique(ends, axis=0, return_inverse=True)[1].reshape(-1)
    enough = np.bincount(pair, known) >= least
    return whole.take(known | ~enough[pair])


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
    months = np.zeros((len(pairs), MONTHS), np.int64)
    middle = voyage_months(tracks, whole.begin, whole.end)[order]
    np.add.at(months, (np.repeat(np.arange(len(pairs)), count), middle), 1)
    return VoyagePairs(
        pairs[:, 0], pairs[:, 1], count.astype(np.int64),
        group_percentiles(time[order], ptr, PERCENTILES), months,
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
        return sorted(found, key=lambda arc: self.voyages(arc, month), reverse=True)

    def check_draught(
        self, nodes: HistoryNodes, ends: tuple[int, int], draught: float | None, weight: FloatArray
    ) -> None:
        """Raise `NoRouteError` if all ships between two ports drew clearly less than a draught.

        Parameters
        ----------
        ends : Nodes of the ports.
        draught : [m].
        weight : Of every arc, (A,); inf for those that are closed.
        """
        arcs = [arc for arc in self.between.get(ends, []) if self.kind[arc] == SAILED]
        if draught is None or not arcs or np.isfinite(weight[arcs]).any():
            return
        known = self.evidence.draughts_known[arcs] >= LEAST_SAMPLES
        deepest = float(np.nanmax(self.evidence.draught[arcs, 2], initial=0.0))
        if not known.all() or deepest >= draught:
            return
        names = [nodes.ports[k - nodes.first_port].name for k in ends]
        raise NoRouteError(
            f"The history network has no route from {names[0]} to {names[1]} for a draught of "
            f"{draught:g} m.",
            f"The ships of its {int(self.evidence.count[arcs].sum())} voyages drew at most "
            f"{deepest:g} m.",
            "Leave out the draught, or plan on another network.",
        )

    def note_beside(self, nodes: HistoryNodes, ends: tuple[int, int], least: int) -> str:
        """Return which ports beside two others ships sailed between, as a note; empty if none.

        Parameters
        ----------
        ends : Nodes of two ports between which no ship sailed.
        least : Fewest voyages.
        """
        near = [
            np.flatnonzero(distance(nodes.lat[k], nodes.lon[k], nodes.lat, nodes.lon) <= _BESIDE)
            for k in ends
        ]
        sailed = [
            (int(self.evidence.count[arc]), pair)
            for pair, arcs in self.between.items()
            if pair[0] in near[0] and pair[1] in near[1]
            for arc in arcs
            if self.kind[arc] == SAILED and self.evidence.count[arc] >= least
        ]
        if not sailed:
            return ""
        count, pair = max(sailed)
        names = [nodes.ports[k - nodes.first_port].name for k in pair]
        return (
            f"{count} voyages sailed from {names[0]} to {names[1]}, which are within "
            f"{_BESIDE / NAUTICAL_MILE:.0f} nm: look up that pair."
        )

    def count_between(self, start: int, goal: int) -> int:
        """Return how many whole voyages there are from one port to another."""
        arcs = self.between.get((start, goal), [])
        return int(sum(self.evidence.count[arc] for arc in arcs if self.kind[arc] == SAILED))

    def voyages(self, arc: int, month: int | None) -> tuple[int, int]:
        """Return how many voyages an arc has in a month (0 without one), and in all."""
        in_month = 0 if month is None else int(self.evidence.months[arc, month - 1])
        return in_month, int(self.evidence.count[arc])


@dataclass(frozen=True, eq=False)
class CanalWays:
    """Ways between ports through canals.

    Parameters
    ----------
    arcs : All arcs.
    canal : Those from one end of a canal to the other on which enough voyages were seen.
    path : Returns the arcs of the shortest way between two nodes with weights (A,).
    """

    arcs: HistoryArcs
    canal: IntArray
    path: Callable[[int, int, FloatArray], list[int]]

    def shortest(self, ends: tuple[int, int], weight: FloatArray) -> list[int]:
        """Return the arcs of the shortest way between two ports through a canal; empty for none.

        Parameters
        ----------
        ends : Nodes of the ports.
        weight : Of every arc, (A,); inf for those that are closed.
        """
        least, found = np.inf, list[int]()
        for canal in self.canal[np.isfinite(weight[self.canal])].tolist():
            before = self.path(ends[0], int(self.arcs.tail[canal]), weight)
            after = self.path(int(self.arcs.head[canal]), ends[1], weight)
            way = [*before, canal, *after]
            if before and after and weight[way].sum() < least:
                least, found = float(weight[way].sum()), way
        return found
