"""Junctions of history networks: clusters of turning points, ends of canals, corridors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS, Position, geocentric_positions
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.voyage_tracks import VoyageTracks, sphere_vectors

if TYPE_CHECKING:
    from thalweg.chart import Chart

_CELLS_PER_RADIUS: Final = 4.0
_KEY_BITS: Final = 21


@dataclass(frozen=True)
class CorridorLine:
    """A line across the way of ships: a strait, a canal or a place of dense traffic.

    Parameters
    ----------
    name : str
        Its name.
    first, second : (lat, lon)
        Its ends [deg].
    """

    name: str
    first: Position
    second: Position


@dataclass(frozen=True, eq=False)
class CorridorCrossings:
    """Where tracks cross corridors, c times in all.

    Parameters
    ----------
    along : Where the track crosses, as `VoyageTracks.along` [m], (c,).
    node : Junction at that part of the corridor, (c,).
    """

    along: FloatArray
    node: IntArray


@dataclass(frozen=True, eq=False)
class Junctions:
    """Nodes of a history network other than ports, J in total.

    Parameters
    ----------
    lat, lon : Positions [deg], (J,).
    names : Name of the corridor or canal of each junction; empty for clusters of turning points.
    crossings : Where tracks cross the corridors.
    canal_ends : How many of the first junctions are ends of canals; junctions 2k and 2k + 1 are
        those of one canal.
    """

    lat: FloatArray
    lon: FloatArray
    names: tuple[str, ...]
    crossings: CorridorCrossings
    canal_ends: int = 0

    def __len__(self) -> int:
        return len(self.lat)


def find_junctions(
    chart: Chart,
    tracks: VoyageTracks,
    turning: BoolArray,
    *,
    radius: float,
    least: int,
    corridors: Sequence[CorridorLine] = (),
) -> Junctions:
    """Return the junctions of tracks.

    Parameters
    ----------
    chart : Its canals have a junction at either end; other junctions are in its navigable water.
    turning : Turning points, by `turning_points`, (n,).
    radius : Radius of a cluster [m]; corridors are divided into parts of twice this length.
    least : Turning points of at least this number of voyages make a cluster.
    corridors : Lines that are junctions.

    Returns
    -------
    Junctions : Ends of canals first, two each; then corridors; then clusters.
    """
    ends = [end for canal in chart.canals for end in canal.ends]
    names = [canal.name for canal in chart.canals for _ in range(2)]
    lat, lon = ([float(end[k]) for end in ends] for k in (0, 1))
    found = [
        _corridor_nodes(chart, tracks, corridor, radius) for corridor in corridors if len(tracks)
    ]
    along, node = [np.empty(0)], [np.empty(0, np.int64)]
    for corridor, (crossed, part, places) in zip(corridors, found):
        along.append(crossed)
        node.append(part + len(lat))
        lat += [place[0] for place in places]
        lon += [place[1] for place in places]
        names += [corridor.name] * len(places)
    fixed = sphere_vectors(np.array(lat), np.array(lon)).reshape(-1, 3)
    inner = turning.copy()
    inner[tracks.ptr[:-1]] = False
    inner[tracks.ptr[1:] - 1] = False
    at = np.flatnonzero(inner)
    vectors = sphere_vectors(tracks.lat[at], tracks.lon[at])
    cluster_lat, cluster_lon = _clusters(
        chart, vectors, tracks.voyage[at], fixed, radius=radius, least=least
    )
    names += [""] * len(cluster_lat)
    crossings = CorridorCrossings(np.concatenate(along), np.concatenate(node))
    return Junctions(
        np.append(np.array(lat), cluster_lat),
        np.append(np.array(lon), cluster_lon),
        tuple(names),
        crossings,
        len(ends),
    )


def _clusters(
    chart: Chart,
    vectors: FloatArray,
    voyage: IntArray,
    fixed: FloatArray,
    *,
    radius: float,
    least: int,
) -> tuple[FloatArray, FloatArray]:
    """Return the centres [deg] of clusters of turning points (m, 3).

    The place with the most voyages within the radius is the first cluster and takes all turning
    points within the radius; then the next, and so on. Unlike clusters that grow from neighbour to
    neighbour, these do not grow along a lane.
    """
    from scipy.spatial import cKDTree

    if not len(vectors):
        return np.empty(0), np.empty(0)
    cell, centre = _cells(vectors, radius / _CELLS_PER_RADIUS)
    pair = np.unique(np.stack([cell, voyage], axis=1), axis=0)
    count = np.bincount(pair[:, 0], minlength=len(centre))
    tree = cKDTree(centre)
    free = np.ones(len(centre), bool)
    if len(fixed):
        near, _ = cKDTree(fixed).query(centre, distance_upper_bound=radius)
        free = ~np.isfinite(near)
    peaks = _peaks(tree, count, free, radius, least)
    if not len(peaks):
        return np.empty(0), np.empty(0)
    near, member = cKDTree(centre[peaks]).query(vectors, distance_upper_bound=radius)
    inside = np.flatnonzero(np.isfinite(near) & free[cell])
    member = member[inside]
    pair = np.unique(np.stack([member, voyage[inside]], axis=1), axis=0)
    voyages = np.bincount(pair[:, 0], minlength=len(peaks))
    size = np.maximum(np.bincount(member, minlength=len(peaks)), 1)
    mean = np.stack(
        [np.bincount(member, vectors[inside, k], minlength=len(peaks)) / size for k in range(3)],
        axis=1,
    )
    strong = voyages >= least
    lat, lon = geocentric_positions(mean)
    return _moved_to_water(chart, lat, lon, (vectors[inside], member), mean, strong)


def _peaks(tree: object, count: IntArray, free: BoolArray, radius: float, least: int) -> IntArray:
    """Return the cells of most voyages within the radius, none within the radius of another."""
    from scipy.sparse import coo_array

    n = len(count)
    pairs = tree.query_pairs(radius, output_type="ndarray")  # type: ignore[attr-defined]
    a, b = np.concatenate([pairs, pairs[:, ::-1]]).T
    near = coo_array((np.ones(len(a), np.int32), (a, b)), shape=(n, n)).tocsr()
    density = count + near @ count
    taken = ~free | (density < least)
    found = []
    for cell in np.lexsort((np.arange(n), -density)).tolist():
        if not taken[cell]:
            found.append(cell)
            taken[near.indices[near.indptr[cell] : near.indptr[cell + 1]]] = True
            taken[cell] = True
    return np.array(found, np.int64)


def _cells(vectors: FloatArray, side: float) -> tuple[IntArray, FloatArray]:
    """Return the cell of every position in a grid of cubes, and the mean position of each cell."""
    index = np.floor(vectors / side).astype(np.int64) + (1 << (_KEY_BITS - 1))
    key = (index[:, 0] << (2 * _KEY_BITS)) | (index[:, 1] << _KEY_BITS) | index[:, 2]
    _, cell = np.unique(key, return_inverse=True)
    count = np.bincount(cell)
    mean = np.stack([np.bincount(cell, vectors[:, k]) / count for k in range(3)], axis=1)
    return cell.astype(np.int64), mean


def _moved_to_water(
    chart: Chart,
    lat: FloatArray,
    lon: FloatArray,
    members: tuple[FloatArray, IntArray],
    mean: FloatArray,
    strong: BoolArray,
) -> tuple[FloatArray, FloatArray]:
    """Return strong clusters, those on land moved to their nearest turning point on water."""
    keep = strong.copy()
    dry = strong & ~np.asarray(chart.is_navigable(lat, lon))
    for cluster in np.flatnonzero(dry).tolist():
        own = members[0][members[1] == cluster]
        own_lat, own_lon = geocentric_positions(own)
        wet = np.flatnonzero(np.asarray(chart.is_navigable(own_lat, own_lon)))
        if not len(wet):
            keep[cluster] = False
            continue
        best = wet[np.argmin(np.sum((own[wet] - mean[cluster]) ** 2, axis=1))]
        lat[cluster], lon[cluster] = own_lat[best], own_lon[best]
    return lat[keep], lon[keep]


def _corridor_nodes(
    chart: Chart, tracks: VoyageTracks, corridor: CorridorLine, radius: float
) -> tuple[FloatArray, IntArray, list[Position]]:
    """Return where tracks cross a corridor [m], at which of its parts, and these parts' places."""
    along, share = _crossings(tracks, corridor)
    a, b = sphere_vectors(*np.array([corridor.first, corridor.second]).T)
    width = MEAN_RADIUS * _angle(a, b)
    parts = max(1, int(np.ceil(width / (2.0 * radius))))
    part = np.minimum((share * parts).astype(np.int64), parts - 1)
    crossed, inner = np.unique(part, return_inverse=True)
    places: list[Position] = []
    for k in range(len(crossed)):
        own = share[inner == k]
        middle = np.array([np.median(own), *own[np.argsort(np.abs(own - np.median(own)))]])
        lat, lon = geocentric_positions(a + middle[:, None] * (b - a))
        wet = np.flatnonzero(np.asarray(chart.is_navigable(lat, lon)))
        best = int(wet[0]) if len(wet) else 0
        places.append((float(lat[best]), float(lon[best])))
    return along, inner.astype(np.int64), places


def _crossings(tracks: VoyageTracks, corridor: CorridorLine) -> tuple[FloatArray, FloatArray]:
    """Return where tracks cross a line: `VoyageTracks.along` [m], and the share of the line."""
    a, b = sphere_vectors(*np.array([corridor.first, corridor.second]).T)
    normal = np.cross(a, b)
    normal /= np.linalg.norm(normal)
    side = tracks.vectors @ normal
    at = np.flatnonzero((side[:-1] < 0.0) != (side[1:] < 0.0))
    at = at[tracks.voyage[at] == tracks.voyage[at + 1]]
    weight = side[at] / (side[at] - side[at + 1])
    place = tracks.vectors[at] + weight[:, None] * (tracks.vectors[at + 1] - tracks.vectors[at])
    place *= MEAN_RADIUS / np.linalg.norm(place, axis=1, keepdims=True)
    share = (place - a) @ (b - a) / np.sum((b - a) ** 2)
    inside = (share >= 0.0) & (share <= 1.0) & (place @ (a + b) > 0.0)
    at, weight = at[inside], weight[inside]
    step = np.append(np.diff(tracks.along), 0.0)
    return tracks.along[at] + weight * step[at], share[inside]


def _angle(a: FloatArray, b: FloatArray) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
