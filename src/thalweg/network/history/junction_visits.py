"""Which junctions every track passes in turn, and the stretches of track between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.approaches import dense_line
from thalweg.core.geodesy import distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.junctions import Junctions
from thalweg.network.history.voyage_tracks import (
    HistoryPort,
    VoyageTracks,
    port_vectors,
    sphere_vectors,
)

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

OFF_LINE: Final = 2.0 * NAUTICAL_MILE  #: tracks so near to an approach are on it
_SAMPLES_PER_RADIUS: Final = 5.0
#: A voyage leaves or reaches the sea end of a port within one and a half times the length of the
#: approach and this distance [m].
_HARBOUR: Final = 20.0 * NAUTICAL_MILE
_WINDING: Final = 1.6  # a canal is at most so many times as long as the line between its ends
_BESIDE: Final = 1.0  # [m]
_FINE, _FINE_SAMPLES = 5.0 * NAUTICAL_MILE, 101  # ports are passed where tracks are nearest to them


@dataclass(frozen=True, eq=False)
class ArcOccurrences:
    """Stretches of tracks from one node to the next, m in all.

    Parameters
    ----------
    voyage : Voyage, (m,).
    tail, head : Nodes: the junctions, then the ports, (m,).
    begin, end : Where the track passes them, as `VoyageTracks.along` [m], (m,).
    """

    voyage: IntArray
    tail: IntArray
    head: IntArray
    begin: FloatArray
    end: FloatArray

    def __len__(self) -> int:
        return len(self.voyage)

    def take(self, index: NDArray[np.int64] | NDArray[np.bool_]) -> ArcOccurrences:
        """Return some of the stretches.

        Parameters
        ----------
        index : Which of them.

        Returns
        -------
        ArcOccurrences : In the order of the index.
        """
        return ArcOccurrences(*(getattr(self, column.name)[index] for column in fields(self)))


@dataclass(frozen=True, eq=False)
class _Visits:
    """Visits of nodes: voyage, place along the tracks, node, distance from the node [m]."""

    voyage: IntArray
    along: FloatArray
    node: IntArray
    away: FloatArray


def arc_occurrences(
    tracks: VoyageTracks, junctions: Junctions, ports: Sequence[HistoryPort], *, radius: float
) -> tuple[ArcOccurrences, BoolArray]:
    """Return the stretches of all tracks between the nodes that they pass.

    A track passes a junction where it is nearest to it within the radius, or where it crosses its
    corridor; a port where it is nearest to its position at sea, at the begin and the end.

    Parameters
    ----------
    ports : Those that ``tracks.start`` and ``tracks.goal`` count; their nodes follow the junctions.
    radius : Radius of a junction [m].

    Returns
    -------
    stretches : In order of voyages and along them; without stretches from a node to itself.
    by_canal : Which voyages pass a canal, (V,).
    """
    along, voyage = _samples(tracks, radius / _SAMPLES_PER_RADIUS)
    vectors = tracks.vectors_at(along)
    start, goal = _port_passages(tracks, ports, along, voyage, vectors)
    visits = _junction_visits(junctions, along, voyage, vectors, radius)
    transits = _transits(junctions, visits)
    of, entered, left = transits
    np.minimum.at(start, of, entered - _BESIDE)  # ports beside a canal are left before it
    np.maximum.at(goal, of, left + _BESIDE)
    visits = _outside_canals(visits, transits)
    crossings = junctions.crossings
    crossed_by = np.searchsorted(tracks.along[tracks.ptr[:-1]], crossings.along, side="right") - 1
    count, every = len(tracks), np.arange(len(tracks))
    merged = _Visits(
        np.concatenate([every, visits.voyage, crossed_by, every]),
        np.concatenate([start, visits.along, crossings.along, goal]),
        np.concatenate([
            len(junctions) + tracks.start, visits.node, crossings.node,
            len(junctions) + tracks.goal,
        ]),
        np.concatenate([np.zeros(count), visits.away, np.zeros(len(crossings.along)),
                        np.zeros(count)]),
    )  # fmt: skip
    rank = np.repeat([0, 1, 1, 2], [count, len(visits.node), len(crossings.node), count])
    inside = (rank != 1) | (
        (merged.along > start[merged.voyage]) & (merged.along < goal[merged.voyage])
    )
    order = np.lexsort((merged.along, rank, merged.voyage))
    order = order[inside[order]]
    by_canal = np.zeros(count, bool)
    by_canal[of] = True
    return _between_visits(merged, order), by_canal


def _transits(junctions: Junctions, visits: _Visits) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return the passages of canals: voyages, and where they pass the one and the other end."""
    at = np.flatnonzero(visits.node < junctions.canal_ends)
    at = at[np.lexsort((visits.along[at], visits.voyage[at]))]
    before, after = at[:-1], at[1:]
    one, other = visits.node[before], visits.node[after]
    whole = np.asarray(distance(junctions.lat[one], junctions.lon[one], junctions.lat[other],
                                junctions.lon[other]))  # fmt: skip
    sailed = visits.along[after] - visits.along[before]
    through = (visits.voyage[before] == visits.voyage[after]) & (one != other)
    through &= (one // 2 == other // 2) & (sailed <= _WINDING * whole)
    return (
        visits.voyage[before][through],
        visits.along[before][through],
        visits.along[after][through],
    )


def _outside_canals(visits: _Visits, transits: tuple[IntArray, FloatArray, FloatArray]) -> _Visits:
    """Return the visits without those of junctions between both ends of a canal."""
    _, entered, left = transits  # ascending, as distances sailed are over all voyages
    if not len(entered):
        return visits
    last = np.maximum(np.searchsorted(entered, visits.along, side="left") - 1, 0)
    keep = ~((visits.along > entered[last]) & (visits.along < left[last]))
    return _Visits(*(getattr(visits, column.name)[keep] for column in fields(_Visits)))


def _samples(tracks: VoyageTracks, spacing: float) -> tuple[FloatArray, IntArray]:
    """Return evenly spaced places on all tracks, and their voyages."""
    begin, end = tracks.along[tracks.ptr[:-1]], tracks.along[tracks.ptr[1:] - 1]
    pieces = np.maximum(1, np.ceil((end - begin) / spacing)).astype(np.int64)
    voyage = np.repeat(np.arange(len(tracks)), pieces + 1)
    first = np.cumsum(pieces + 1) - (pieces + 1)
    share = (np.arange(len(voyage)) - first[voyage]) / pieces[voyage]
    return begin[voyage] + share * (end - begin)[voyage], voyage


def _port_passages(
    tracks: VoyageTracks,
    ports: Sequence[HistoryPort],
    along: FloatArray,
    voyage: IntArray,
    vectors: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return where every voyage is nearest to its start and to its goal at sea.

    Where a ship leaves the approach before its sea end, and comes nearer to that end later, the
    place is the last on the line of the approach.
    """
    where = port_vectors(ports)
    reach = 1.5 * np.array([port.approach_m for port in ports]) + _HARBOUR
    begin, end = tracks.along[tracks.ptr[:-1]], tracks.along[tracks.ptr[1:] - 1]
    middle = 0.5 * (begin + end)
    visits = []
    for port, outer, inner, is_start in (
        (tracks.start, begin, np.minimum(begin + reach[tracks.start], middle), True),
        (tracks.goal, np.maximum(end - reach[tracks.goal], middle), end, False),
    ):
        near = np.flatnonzero((along >= outer[voyage]) & (along <= inner[voyage]))
        away = np.sum((vectors[near] - where[port[voyage[near]]]) ** 2, axis=1)
        order = near[np.lexsort((away, voyage[near]))]
        first = np.unique(voyage[order], return_index=True)[1]
        found = _nearest_between(tracks, along[order[first]], outer, inner, where[port])
        apart = np.linalg.norm(tracks.vectors_at(found) - where[port], axis=1)
        for number in np.unique(port[apart > OFF_LINE]).tolist():
            on_line = _ApproachLine.of_port(ports[number])
            if on_line is None:
                continue
            for row in np.flatnonzero((apart > OFF_LINE) & (port == number)).tolist():
                samples = near[voyage[near] == row]
                places = along[samples[on_line.has(vectors[samples])]]
                if len(places) and not on_line.has(tracks.vectors_at(found[row : row + 1]))[0]:
                    found[row] = places.max() if is_start else places.min()
        visits.append(found)
    return visits[0], visits[1]


@dataclass(frozen=True, eq=False)
class _ApproachLine:
    """Positions along the approach of a port, as a tree of vectors."""

    tree: cKDTree

    @classmethod
    def of_port(cls, port: HistoryPort) -> _ApproachLine | None:
        """Return the line of a port; None where it has none."""
        from scipy.spatial import cKDTree

        if len(port.places) < 3:  # a berth and its position at sea
            return None
        line = dense_line(port.places[1:])
        return cls(cKDTree(sphere_vectors(line[:, 0], line[:, 1])))

    def has(self, vectors: FloatArray) -> BoolArray:
        """Return which of some vectors (n, 3) are on the line."""
        away, _ = self.tree.query(vectors, distance_upper_bound=OFF_LINE)
        return np.isfinite(away)


def _nearest_between(
    tracks: VoyageTracks, along: FloatArray, outer: FloatArray, inner: FloatArray, port: FloatArray
) -> FloatArray:
    """Return the places nearest to ports (V, 3) among finer samples around those given."""
    step = _FINE * np.linspace(-1.0, 1.0, _FINE_SAMPLES)
    tried = np.clip(along[:, None] + step, outer[:, None], inner[:, None])
    away = np.sum((tracks.vectors_at(tried) - port[:, None]) ** 2, axis=-1)
    return tried[np.arange(len(tried)), np.argmin(away, axis=1)]


def _junction_visits(
    junctions: Junctions, along: FloatArray, voyage: IntArray, vectors: FloatArray, radius: float
) -> _Visits:
    """Return the visits of junctions: one for every stretch of samples nearest to one of them."""
    from scipy.spatial import cKDTree

    if not len(junctions):
        none = np.empty(0, np.int64)
        return _Visits(none, np.empty(0), none, np.empty(0))
    tree = cKDTree(sphere_vectors(junctions.lat, junctions.lon))
    away, node = tree.query(vectors, distance_upper_bound=radius)
    near = np.flatnonzero(np.isfinite(away))
    if not len(near):
        return _Visits(near, np.empty(0), near, np.empty(0))
    follows = np.append(False, np.diff(near) == 1)
    same = np.append(False, np.diff(node[near]) == 0) & np.append(False, np.diff(voyage[near]) == 0)
    run = np.cumsum(~(follows & same)) - 1
    order = near[np.lexsort((away[near], run))]
    best = order[np.unique(run, return_index=True)[1]]
    places = sphere_vectors(junctions.lat, junctions.lon)[node[best]]
    passed = _nearest_around(along, voyage, vectors, best, places)
    return _Visits(voyage[best], passed, node[best].astype(np.int64), away[best])


def _nearest_around(
    along: FloatArray, voyage: IntArray, vectors: FloatArray, best: IntArray, places: FloatArray
) -> FloatArray:
    """Return where tracks are nearest to places (m, 3), from their nearest samples.

    The square of the distance from a place is a parabola along a straight track. Its least is at
    most half the spacing from the nearest sample; so neighbouring visits keep their order.
    """
    sides = []
    for step in (-1, 1):
        beside = np.clip(best + step, 0, len(along) - 1)
        sides.append(np.where(voyage[beside] == voyage[best], beside, best))
    before, after = sides
    low, middle, high = (np.sum((vectors[k] - places) ** 2, axis=1) for k in (before, best, after))
    spacing = 0.5 * (along[after] - along[before])
    bend = low - 2.0 * middle + high
    inner = (before != best) & (after != best) & (bend > 0.0)
    shift = np.where(inner, 0.5 * (low - high) / np.where(bend > 0.0, bend, 1.0), 0.0)
    return np.asarray(along[best] + np.clip(shift, -0.5, 0.5) * spacing)


def _between_visits(visits: _Visits, order: IntArray) -> ArcOccurrences:
    """Return the stretches between visits in their order.

    Of repeated visits of one node without another between them the nearest counts; at ports the
    one of the port itself.
    """
    voyage, node, along = visits.voyage[order], visits.node[order], visits.along[order]
    again = np.append(False, (np.diff(voyage) == 0) & (np.diff(node) == 0))
    group = np.cumsum(~again) - 1
    nearest = np.lexsort((visits.away[order], group))
    chosen = nearest[np.unique(group, return_index=True)[1]]
    voyage, node, along = voyage[chosen], node[chosen], along[chosen]
    joined = np.flatnonzero(np.diff(voyage) == 0)
    return ArcOccurrences(
        voyage[joined], node[joined], node[joined + 1], along[joined], along[joined + 1]
    )
