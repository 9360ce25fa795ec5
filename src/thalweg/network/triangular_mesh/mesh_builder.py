"""The mesh builder: a network on the nodes of a hydrodynamic model itself.

After van Halem (2019), "Route optimization in dynamic currents": nodes thinned by the flow's
length scale, joined to all nodes within a few rings of their Delaunay triangulation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.errors import InputError
from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import BoolArray, FloatArray, Int32Array, IntArray
from thalweg.network.assembly import (
    Pairs,
    add_counts,
    allowed_legs,
    assemble,
    evenly_spaced_samples,
)
from thalweg.network.assembly import measured_pairs as measure_pairs
from thalweg.network.conformal_projection import mercator_projection
from thalweg.network.network import Network, NetworkMeta, Stations
from thalweg.network.triangular_mesh.thinning import spacing_fraction, thin_by_spacing

if TYPE_CHECKING:
    from thalweg.chart import Chart

_DIRECTIONS = {1: 6, 2: 12, 3: 24}
#: largest angle between directions on a regular triangular mesh [deg], by rings
_LARGEST_ANGLE_GAP_DEG = {1: 60.0, 2: 30.0, 3: math.degrees(math.atan(math.sqrt(3.0) / 5.0))}
_COLLINEARITY_TOLERANCE = 1e-7


@dataclass(frozen=True)
class _MercatorPlane:
    """The model's mesh in a conformal plane [m at its middle latitude]."""

    x: FloatArray
    y: FloatArray
    metres: FloatArray


def mesh(
    chart: Chart,
    lat: ArrayLike,
    lon: ArrayLike,
    triangles: ArrayLike | None = None,
    *,
    speed: ArrayLike | None = None,
    curl: ArrayLike | None = None,
    largest_spacing: float | None = None,
    alpha: float = 0.8,
    curl_power: float = 0.6,
    speed_power: float = 3.5,
    rings: int = 3,
    sampling: float = 0.5,
) -> Network:
    """Build a network on a model's own nodes; add start and goal by `with_endpoints`.

    Parameters
    ----------
    chart : Chart
        Land, zones and depth; nodes and legs it refuses are left out.
    lat, lon : array_like (N,)
        Nodes of the model [deg].
    triangles : array_like of int (M, 3), optional
        Triangles of the model. Legs that leave them (over holes, islands or the outside) are left
        out. Without them only the chart bounds the network.
    speed, curl : array_like (N,), optional
        Largest current [m/s] and largest dimensionless curl over time, 0 when not given.
    largest_spacing : float, optional
        Nodes are thinned to at most this spacing [m], and less in strong or turning flow (see
        `spacing_fraction`); by default all nodes are used.
    alpha, curl_power, speed_power : float, optional
        See `spacing_fraction`.
    rings : int, optional
        Nodes are joined to all nodes within 1, 2 or 3 rings: the path over a regular mesh is then
        at most 15.5, 3.5 or 1.4 % too long in open water.
    sampling : float, optional
        Distance between samples of a leg as a fraction of the spacing of the nodes it passes
        (its length by the rings between its ends).

    Returns
    -------
    Network
        Without start and goal. ``meta.gap_rad`` is that of a regular triangular mesh.

    Raises
    ------
    InputError
        For broken meshes, rings other than 1 to 3, or when fewer than three nodes remain.
    """
    lat, lon, faces = _checked(lat, lon, triangles, rings, sampling)
    plane = _mercator_plane(lat, lon)
    keep = np.asarray(chart.is_navigable(lat, lon))
    if largest_spacing is not None:
        fraction = spacing_fraction(
            0.0 if speed is None else speed, 0.0 if curl is None else curl,
            alpha=alpha, curl_power=curl_power, speed_power=speed_power,
        )  # fmt: skip
        gap = np.broadcast_to(fraction * largest_spacing, lat.shape) / plane.metres
        water = np.flatnonzero(keep)
        keep[water] = thin_by_spacing(plane.x[water], plane.y[water], gap[water])
    nodes = np.flatnonzero(keep)
    if len(nodes) < 3:
        raise InputError(
            f"A network cannot be made of {len(nodes)} node(s) on navigable water.",
            f"The model has {len(lat)} nodes.",
            "Give a smaller spacing, or a chart that leaves the model's area open.",
        )
    return _joined(chart, lat, lon, plane, nodes, faces, rings, sampling)


def _checked(
    lat: ArrayLike, lon: ArrayLike, triangles: ArrayLike | None, rings: int, sampling: float
) -> tuple[FloatArray, FloatArray, IntArray | None]:
    lat, lon = np.asarray(lat, float), wrap_longitude(lon)
    if rings not in _DIRECTIONS:
        raise InputError(f"A mesh cannot have {rings!r} rings.", "1, 2 or 3.", "Choose one.")
    if not 0.0 < sampling <= 2.0:
        raise InputError(
            f"A sampling of {sampling!r} is not possible.",
            "It is 0 to 2.",
            "Give 0.5, for example.",
        )
    if lat.ndim != 1 or lat.shape != lon.shape or not np.all(np.isfinite(lat) & np.isfinite(lon)):
        raise InputError(
            "The nodes of the mesh are not two equal lists of finite positions.",
            "One latitude and one longitude [deg] per node.",
            "Check the mesh.",
        )
    if triangles is None:
        return lat, lon, None
    faces = np.asarray(triangles, np.int64)
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.min() < 0 or faces.max() >= len(lat):
        raise InputError(
            f"The triangles (shape {faces.shape}) do not refer to the {len(lat)} nodes.",
            "Three node numbers from 0 per triangle.",
            "Check the connectivity and its start index.",
        )
    return lat, lon, faces


def _mercator_plane(lat: FloatArray, lon: FloatArray) -> _MercatorPlane:
    """Project the mesh to a Mercator plane whose seam is opposite its middle."""
    radians = np.radians(lon)
    middle = float(np.degrees(np.arctan2(np.sin(radians).mean(), np.cos(radians).mean())))
    latitude = float(lat.mean())
    frame = mercator_projection((latitude, middle), 1.0, latitude=latitude)
    x, y = frame.from_positions(lat, lon)
    return _MercatorPlane(x, y, frame.metres(y))


def _joined(
    chart: Chart, lat: FloatArray, lon: FloatArray, plane: _MercatorPlane, nodes: IntArray,
    faces: IntArray | None, rings: int, sampling: float,
) -> Network:  # fmt: skip
    from scipy.spatial import Delaunay

    n = len(nodes)
    x, y = plane.x[nodes], plane.y[nodes]
    by_ring = pairs_by_ring(Delaunay(np.column_stack([x, y])).simplices, n, rings)
    first = np.concatenate([a for a, _ in by_ring])
    second = np.concatenate([b for _, b in by_ring])
    stations = Stations(lat[nodes], lon[nodes], n)
    free, rejected = allowed_legs(chart, stations.lat, stations.lon, first, second)
    if faces is not None:
        inside = np.ones(len(first), bool)
        inside[free] = _inside_mesh(plane, faces, nodes[first[free]], nodes[second[free]])
        outside = int((~inside).sum())
        add_counts(rejected, {"outside the mesh": outside} if outside else {})
        free &= inside
    pairs = measure_pairs(stations.lat, stations.lon, first[free], second[free])
    ring = np.repeat(np.arange(1, rings + 1), [len(a) for a, _ in by_ring])[free]
    straight = ~_pass_through_nodes(pairs, n)
    pairs, ring = pairs.where(straight), ring[straight]
    near = pairs.length[ring == 1]
    stations, samples = evenly_spaced_samples(stations, pairs, sampling * pairs.length / ring)
    meta = NetworkMeta(
        kind="mesh",
        spacing_m=float(np.percentile(near, 95)) if len(near) else 1.0,
        directions=_DIRECTIONS[rings],
        gap_rad=math.radians(_LARGEST_ANGLE_GAP_DEG[rings]),
        rejected=rejected,
    )
    return assemble(chart, stations, pairs, samples, meta=meta)


def _inside_mesh(plane: _MercatorPlane, faces: IntArray, a: IntArray, b: IntArray) -> BoolArray:
    """Return which straight lines between nodes stay inside the triangles."""
    shapely: Any = import_module("shapely")
    xy = np.column_stack([plane.x, plane.y])
    border = shapely.linestrings(xy[_boundary_sides(faces)])
    lines = shapely.linestrings(np.stack([xy[a], xy[b]], axis=1))
    inside = np.ones(len(lines), bool)
    tree = shapely.STRtree(border)
    inside[tree.query(lines, predicate="crosses")[0]] = False
    # Lines that meet the border at nodes may run outside between them: test each stretch.
    line, piece = tree.query(lines, predicate="touches")
    ends = _boundary_sides(faces)[piece].ravel()
    line = np.repeat(line, 2)
    direction = xy[b[line]] - xy[a[line]]
    along = ((xy[ends] - xy[a[line]]) * direction).sum(1) / (direction**2).sum(1)
    offset = np.abs(np.cross(_with_zero_z(direction), _with_zero_z(xy[ends] - xy[a[line]]))[:, 2])
    on_line = (offset <= 1e-9 * (direction**2).sum(1)) & (along > 0.0) & (along < 1.0)
    every = np.arange(len(lines))
    of = np.concatenate([every, every, line[on_line]])
    share = np.concatenate([np.zeros(len(lines)), np.ones(len(lines)), along[on_line]])
    order = np.lexsort((share, of))
    of, share = of[order], share[order]
    middle = 0.5 * (share[1:] + share[:-1])
    stretch = (of[1:] == of[:-1]) & (share[1:] > share[:-1])
    who, at = of[1:][stretch], middle[stretch, None]
    points = shapely.points(xy[a[who]] * (1.0 - at) + xy[b[who]] * at)
    inside[who[~_covered_by_triangles(shapely, xy, faces, points)]] = False
    return inside


def _covered_by_triangles(shapely: Any, xy: FloatArray, faces: IntArray, points: Any) -> BoolArray:
    """Return which points lie in or on a triangle, rounding aside."""
    triangles = shapely.polygons(np.concatenate([xy[faces], xy[faces[:, :1]]], axis=1))
    covered: BoolArray = np.zeros(len(points), np.bool_)
    size = float(np.median(np.sqrt(shapely.area(triangles))))
    covered[
        shapely.STRtree(triangles).query(points, predicate="dwithin", distance=1e-6 * size)[0]
    ] = True
    return covered


def _with_zero_z(vectors: FloatArray) -> FloatArray:
    return np.column_stack([vectors, np.zeros(len(vectors))])


def _boundary_sides(faces: IntArray) -> IntArray:
    """Return the sides (K, 2) that belong to one triangle only."""
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, count = np.unique(sides, axis=0, return_counts=True)
    return np.asarray(unique[count == 1])


def _pass_through_nodes(pairs: Pairs, n: int) -> BoolArray:
    """Return which pairs run straight through a node that is joined to both ends."""
    from scipy.sparse import coo_array

    count = len(pairs.first)
    both = np.concatenate([pairs.first, pairs.second]), np.concatenate([pairs.second, pairs.first])
    number = np.tile(np.arange(1, count + 1), 2)
    table = coo_array((number, both), shape=(n, n)).tocsr()
    degree = np.diff(table.indptr)[pairs.first]
    pair, slot = numbered_parts(degree)
    entry = np.repeat(table.indptr[pairs.first], degree) + slot
    middle, to_middle = table.indices[entry], table.data[entry] - 1
    shorter = pairs.length[to_middle] < pairs.length[pair]
    pair, middle, to_middle = pair[shorter], middle[shorter], to_middle[shorter]
    keys = pairs.first.astype(np.int64) * n + pairs.second
    order = np.argsort(keys)
    low = np.minimum(middle, pairs.second[pair]).astype(np.int64)
    high = np.maximum(middle, pairs.second[pair]).astype(np.int64)
    place = np.minimum(np.searchsorted(keys[order], low * n + high), count - 1)
    found = order[place]
    joined = keys[found] == low * n + high
    detour = pairs.length[to_middle] + pairs.length[found] - pairs.length[pair]
    straight = joined & (detour <= _COLLINEARITY_TOLERANCE * pairs.length[pair])
    through = np.zeros(count, bool)
    through[pair[straight]] = True
    return through


def adjacency(triangles: IntArray, n: int) -> Any:
    """Return the symmetric adjacency of a triangulation as a sparse boolean matrix."""
    from scipy.sparse import coo_array

    a, b, c = np.asarray(triangles).T
    rows, columns = np.concatenate([a, b, c, b, c, a]), np.concatenate([b, c, a, a, b, c])
    return coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(n, n)).tocsr()


def pairs_by_ring(triangles: IntArray, n: int, rings: int) -> list[tuple[Int32Array, Int32Array]]:
    """Return for ring 1, 2, ... the pairs (a < b) of nodes that many edges apart."""
    near = adjacency(triangles, n).astype(np.int8)
    reached, known = near, np.empty(0, np.int64)
    result = []
    for _ in range(rings):
        entries = reached.tocoo()
        upper = entries.row < entries.col
        keys = entries.row[upper].astype(np.int64) * n + entries.col[upper]
        new = np.setdiff1d(keys, known)
        result.append(((new // n).astype(np.int32), (new % n).astype(np.int32)))
        known = np.union1d(known, keys)
        reached = ((reached @ near) > 0).astype(np.int8)
    return result
