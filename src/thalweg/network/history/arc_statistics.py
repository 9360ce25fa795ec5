"""Arcs of a history network from stretches of tracks: variants, medoids and what was seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, Float32Array, FloatArray, IntArray
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.season_masks import MONTHS, open_months, voyages_of_regions
from thalweg.network.history.voyage_tracks import VoyageTracks

#: Where along an arc tracks are compared, as shares of its length.
SHARES: Final = (np.arange(9) + 0.5) / 9.0
PERCENTILES: Final = (10.0, 50.0, 90.0)
CANDIDATES: Final = 4  #: tracks of an arc that may become its line, the medoid first
_TUBE: Final = (5.0, 95.0)
_VARIANTS: Final = 4  # ways between two nodes that are distinguished
_SPREAD: Final = 0.05  # tracks of one way are this near to its medoid, as a share of the length
_SPREAD_OF_WHOLE: Final = 0.03  # the same of whole voyages
_ROUNDS: Final = 2


@dataclass(frozen=True, eq=False)
class ArcEvidence:
    """What was seen on A arcs.

    Parameters
    ----------
    count : Voyages, (A,).
    length, duration : p10, p50 and p90 of the length [m] and of the time under way [s], (A, 3).
    months : Voyages by month, January first, (A, 12).
    open_in : Months in which the arc is open (`open_months`), (A, 12).
    draught, ship_length : p10, p90 and greatest of the ships [m], (A, 3); NaN where unknown.
    draughts_known : Voyages whose draught is known, (A,).
    """

    count: IntArray
    length: FloatArray
    duration: FloatArray
    months: IntArray
    open_in: BoolArray
    draught: FloatArray
    ship_length: FloatArray
    draughts_known: IntArray


@dataclass(frozen=True, eq=False)
class FoundArcs:
    """Arcs before their lines are tested, A in total.

    Parameters
    ----------
    tail, head : Nodes, (A,).
    evidence : What was seen on them.
    candidates : int64 ndarray (A, 4)
        Stretches of tracks by their distance from the mean, the medoid first; -1 for none.
    tube : float64 ndarray (A, 9, 2)
        p5 and p95 of the distance of tracks to starboard of the medoid [m], at `SHARES`.
    outliers : Stretches of tracks that belong to no arc.
    """

    tail: IntArray
    head: IntArray
    evidence: ArcEvidence
    candidates: IntArray
    tube: FloatArray
    outliers: int


def arcs_of_occurrences(
    tracks: VoyageTracks, occurrences: ArcOccurrences, *, radius: float, least: int, first_port: int
) -> FoundArcs:
    """Return the arcs of stretches of tracks.

    Stretches between the same two nodes, in the same direction, are divided into ways: tracks
    within a quarter of the length of the middle of a way belong to it (at least half the radius,
    at most twice the radius or 5 % of the length). Those from port to port are whole voyages: half
    of the radius or 3 % of the length, so that lanes side by side are ways of their own. Ways of
    fewer than ``least`` voyages are outliers where there is another between the two nodes.

    Parameters
    ----------
    occurrences : Stretches, m in total.
    radius : Radius of a junction [m].
    least : Least number of voyages for a route to be accepted.
    first_port : Node of the first port; junctions come before.

    Returns
    -------
    FoundArcs : In order of tail and head, the way of most voyages first.
    """
    begin, step = occurrences.begin, occurrences.end - occurrences.begin
    shape = np.stack([tracks.vectors_at(begin + share * step) for share in SHARES], axis=1).astype(
        np.float32
    )
    whole = (occurrences.tail >= first_port) & (occurrences.head >= first_port)
    way = _ways(occurrences, shape, step, _Reach(radius, whole))
    arc, tail, head = _arcs(occurrences, way, least)
    inside = np.flatnonzero(arc >= 0)
    inside = inside[np.argsort(arc[inside], kind="stable")]
    ptr = np.searchsorted(arc[inside], np.arange(len(tail) + 1))
    candidates = _candidates(tracks, occurrences.take(inside), shape[inside], ptr, whole[inside])
    candidates = np.where(candidates >= 0, inside[candidates], -1)
    evidence = _evidence(tracks, occurrences, inside, ptr, tail)
    tube = _tubes(shape, inside, ptr, candidates[:, 0])
    return FoundArcs(tail, head, evidence, candidates, tube, int((arc[~whole] < 0).sum()))


def _ways(
    occurrences: ArcOccurrences, shape: Float32Array, length: FloatArray, reach_of: _Reach
) -> IntArray:
    """Return the way of every stretch among those of its two nodes: 0, 1, ...; -1 for none."""
    way = np.full(len(occurrences), -1, np.int64)
    n = int(max(occurrences.tail.max(initial=0), occurrences.head.max(initial=0))) + 1
    pair = occurrences.tail * n + occurrences.head
    left = np.arange(len(occurrences))
    for number in range(_VARIANTS):
        if not len(left):
            break
        left = left[np.lexsort((length[left], pair[left]))]
        _, first, group, count = np.unique(
            pair[left], return_index=True, return_inverse=True, return_counts=True
        )
        middle = left[first + count // 2]
        centre, reach = shape[middle], reach_of(middle, length)
        for _ in range(_ROUNDS):
            near = _largest_distance(shape[left], centre, group) <= reach[group]
            size = np.maximum(np.bincount(group, near, minlength=len(first)), 1.0)
            mean = np.zeros(centre.shape)
            inside = np.flatnonzero(near)
            np.add.at(mean, group[inside], shape[left[inside]])
            centre = np.where((size > 1.0)[:, None, None], mean / size[:, None, None], centre)
        near = _largest_distance(shape[left], centre, group) <= reach[group]
        way[left[near]] = number
        left = left[~near]
    return way


@dataclass(frozen=True, eq=False)
class _Reach:
    """How far tracks of one way may be from its middle.

    Of stretches between junctions a quarter of the length, from half the radius to twice the
    radius, or 5 % of a great length: they pass junctions far from each other. Of whole voyages half
    the radius, or 3 % of a great length.
    """

    radius: float
    whole: BoolArray

    def __call__(self, some: IntArray, length: FloatArray) -> FloatArray:
        """Return it for some stretches [m]; the lengths are of all."""
        of, radius = length[some], self.radius
        parts = np.maximum(_SPREAD * of, np.clip(0.25 * of, 0.5 * radius, 2.0 * radius))
        whole = np.maximum(_SPREAD_OF_WHOLE * of, np.clip(0.25 * of, 0.25 * radius, 0.5 * radius))
        return np.where(self.whole[some], whole, parts)


def _largest_distance(shape: Float32Array, centre: FloatArray, group: IntArray) -> FloatArray:
    """Return the greatest distance of stretches (m, 9, 3) from the centres of their groups [m]."""
    most = np.zeros(len(shape))
    for k in range(shape.shape[1]):
        apart = np.sum((shape[:, k] - centre[group, k]) ** 2, axis=1)
        np.maximum(most, apart, out=most)
    return np.sqrt(most)


def _arcs(
    occurrences: ArcOccurrences, way: IntArray, least: int
) -> tuple[IntArray, IntArray, IntArray]:
    """Return the arc of every stretch (-1: outlier), and tails and heads of the arcs."""
    known = np.flatnonzero(way >= 0)
    keys = np.stack([occurrences.tail[known], occurrences.head[known], way[known]], axis=1)
    table, number, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    number = number.reshape(-1)
    pair = np.unique(table[:, :2], axis=0, return_inverse=True)[1].reshape(-1)
    most = np.zeros(pair.max(initial=-1) + 1, np.int64)
    np.maximum.at(most, pair, count)
    strongest = np.unique(pair[np.lexsort((-count, pair))], return_index=True)[1]
    strongest = np.lexsort((-count, pair))[strongest]
    keep = count >= least
    keep[strongest] = True  # the only way, or the one of most voyages
    order = np.flatnonzero(keep)
    order = order[np.lexsort((-count[order], pair[order]))]
    new = np.full(len(table), -1, np.int64)
    new[order] = np.arange(len(order))
    arc = np.full(len(occurrences), -1, np.int64)
    arc[known] = new[number]
    return arc, table[order, 0], table[order, 1]


def _candidates(
    tracks: VoyageTracks,
    occurrences: ArcOccurrences,
    shape: Float32Array,
    ptr: IntArray,
    whole: BoolArray,
) -> IntArray:
    """Return the stretches of every arc nearest to its mean, in order; -1 where there are fewer.

    Stretches with gaps count as farther away: by how much of them is not observed; whole voyages by
    how much their length differs from the median.
    """
    count = np.diff(ptr)
    arc = np.repeat(np.arange(len(count)), count)
    mean = np.add.reduceat(shape.astype(float), ptr[:-1], axis=0) / count[:, None, None]
    score = np.zeros(len(occurrences))
    for k in range(shape.shape[1]):
        score += np.sum((shape[:, k] - mean[arc, k]) ** 2, axis=1)
    score = np.sqrt(score / shape.shape[1])
    length = occurrences.end - occurrences.begin
    median = group_percentiles(length, ptr, (50.0,))[arc, 0]
    score += np.where(whole, np.abs(length - median), 0.0)
    unseen = tracks.values_at(tracks.unobserved, occurrences.end)
    unseen -= tracks.values_at(tracks.unobserved, occurrences.begin)
    order = np.lexsort((score + unseen, arc))
    candidates = np.full((len(count), CANDIDATES), -1, np.int64)
    for k in range(CANDIDATES):
        there = count > k
        candidates[there, k] = order[ptr[:-1][there] + k]
    return candidates


def _evidence(
    tracks: VoyageTracks,
    occurrences: ArcOccurrences,
    inside: IntArray,
    ptr: IntArray,
    tail: IntArray,
) -> ArcEvidence:
    """Return what was seen on arcs; ``inside[ptr[a]:ptr[a + 1]]`` are the stretches of arc a."""
    one = occurrences.take(inside)
    time = tracks.values_at(tracks.under_way, one.end)
    time -= tracks.values_at(tracks.under_way, one.begin)
    month = voyage_months(tracks, occurrences.begin, occurrences.end)
    count = np.diff(ptr)
    arc = np.repeat(np.arange(len(count)), count)
    seen = np.zeros((len(count), MONTHS), np.int64)
    np.add.at(seen, (arc, month[inside]), 1)
    draught, size = (column[one.voyage] for column in (tracks.ships.draught, tracks.ships.length))
    ends = (10.0, 90.0, 100.0)
    return ArcEvidence(
        count,
        group_percentiles(one.end - one.begin, ptr, PERCENTILES),
        group_percentiles(time, ptr, PERCENTILES),
        seen,
        open_months(seen, _voyages_by_month(tracks, occurrences)[tail]),
        group_percentiles(draught, ptr, ends),
        group_percentiles(size, ptr, ends),
        np.bincount(arc[np.isfinite(draught)], minlength=len(count)),
    )


def _voyages_by_month(tracks: VoyageTracks, occurrences: ArcOccurrences) -> IntArray:
    """Return the voyages by month in the region of every node (N, 12), by their middles."""
    begin, end = tracks.along[tracks.ptr[:-1]], tracks.along[tracks.ptr[1:] - 1]
    ends = occurrences.tail, occurrences.head
    return voyages_of_regions(ends, occurrences.voyage, voyage_months(tracks, begin, end))


def voyage_months(tracks: VoyageTracks, begin: FloatArray, end: FloatArray) -> IntArray:
    """Return the month of the middle of every stretch, 0 for January.

    Parameters
    ----------
    begin, end : As `VoyageTracks.along` [m], (m,).
    """
    time = tracks.values_at(tracks.time, 0.5 * (begin + end))
    moments = time.astype("datetime64[s]").astype("datetime64[M]")
    return np.asarray(moments.astype(np.int64) % MONTHS)


def group_percentiles(values: FloatArray, ptr: IntArray, percent: tuple[float, ...]) -> FloatArray:
    """Return percentiles of groups of values, linear between ranks.

    Parameters
    ----------
    values : Group g is ``values[ptr[g]:ptr[g + 1]]``, (m,); NaN are left out.
    ptr : Where groups begin, (G + 1,).
    percent : 0 to 100.

    Returns
    -------
    float64 ndarray (G, len(percent)) : NaN for groups without a value.
    """
    group = np.repeat(np.arange(len(ptr) - 1), np.diff(ptr))
    known = np.isfinite(values)
    size = np.bincount(group[known], minlength=len(ptr) - 1)
    ordered = values[known][np.lexsort((values[known], group[known]))]
    first = np.cumsum(size) - size
    found = np.full((len(size), len(percent)), np.nan)
    there = np.flatnonzero(size)
    for k, share in enumerate(percent):
        rank = share / 100.0 * (size[there] - 1)
        low = np.floor(rank).astype(np.int64)
        high = np.minimum(low + 1, size[there] - 1)
        a, b = ordered[first[there] + low], ordered[first[there] + high]
        found[there, k] = a + (rank - low) * (b - a)
    return found


def _tubes(shape: Float32Array, inside: IntArray, ptr: IntArray, medoid: IntArray) -> FloatArray:
    """Return p5 and p95 of the distances of tracks to starboard of the medoids (A, 9, 2) [m]."""
    arc = np.repeat(np.arange(len(medoid)), np.diff(ptr))
    tube = np.empty((len(medoid), len(SHARES), 2))
    line = shape[medoid].astype(float)
    for k in range(len(SHARES)):
        ahead = line[:, min(k + 1, len(SHARES) - 1)] - line[:, max(k - 1, 0)]
        starboard = np.cross(ahead, line[:, k])
        size = np.sqrt(np.sum(starboard**2, axis=1))
        starboard /= np.where(size > 0.0, size, 1.0)[:, None]
        apart = np.einsum("ij,ij->i", shape[inside, k] - line[arc, k], starboard[arc])
        tube[:, k] = group_percentiles(apart, ptr, _TUBE)
    return tube
