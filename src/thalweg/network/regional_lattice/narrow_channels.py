"""Nodes in the middle of channels that are too narrow for the points of a lattice."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import MEAN_RADIUS
from thalweg.core.types import FloatArray, IntArray
from thalweg.network.alternatives.homotopy import ring_areas
from thalweg.network.assembly import Pairs, allowed_legs, measured_pairs
from thalweg.network.conformal_projection import (
    conformal_positions,
    conformal_unit_vectors,
)
from thalweg.network.endpoints import concatenate_pairs
from thalweg.network.network import Stations

ShoreEdges: TypeAlias = tuple[FloatArray, FloatArray]

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.network.regional_lattice.refinement_levels import LatticeSpecification

_MAX_WIDTH: Final = 2.0  # spacings: wider channels hold points of the lattice itself
_MIN_WIDTH: Final = 50.0  # [m] narrower channels are not distinguished by width
_MIN_LAND_SIZE: Final = 0.5  # open-sea spacings: smaller land is passed on its other side
_MAX_NODES: Final = 2000
_SHORE_SPACING: Final = 0.25  # widths: between places along a shore
_THINNING_CELL: Final = 0.5  # in widths: one position per cell is used
_NEAREST_SHORE_PLACES: Final = 16  # places searched around each for one on another shore
_NEIGHBOURS: Final = 24
_REACH: Final = 3.0  # spacings
_MAX_PARTS: Final = 2000  # of one edge of a coastline


def channel_nodes(ground: LatticeSpecification) -> tuple[FloatArray, FloatArray]:
    """Return positions [deg] midway between different pieces of land that lie close together.

    Parameters
    ----------
    ground : Only land larger than half its open-sea spacing counts, or larger land if there would
        be too many nodes, in channels narrower than twice its spacing at coasts.

    Returns
    -------
    lat, lon : On navigable water in the region, about as far apart as the channel is wide.
    """
    widest = _MAX_WIDTH * ground.frame.largest_unit * ground.step(ground.coast_levels)
    island = _MIN_LAND_SIZE * ground.frame.largest_unit * ground.step(0)
    if 2.0 * ground.chart.offing.distance > widest:  # channels so narrow are named passages
        return np.empty(0), np.empty(0)
    while True:
        middles = _channel_midpoints(*_shores(ground, island, _SHORE_SPACING * widest), widest)
        lat, lon = conformal_positions(middles)
        keep = ground.region.contains(middles) & ground.region.in_box(lat, lon)
        keep &= np.asarray(ground.chart.is_navigable(lat, lon), bool)
        if keep.sum() <= _MAX_NODES:
            return lat[keep], lon[keep]
        island *= 1.4 if keep.sum() < 2 * _MAX_NODES else 2.0


def channel_pairs(chart: Chart, stations: Stations, first: int, last: int, near: float) -> Pairs:
    """Return allowed pairs of the nodes from ``first`` to before ``last`` with those around them.

    Parameters
    ----------
    chart : Tests them.
    stations : The nodes before ``first`` are those of the grid.
    near : Spacing of the grid at coasts [m].
    """
    from scipy.spatial import cKDTree

    own = np.arange(first, last)
    lat, lon = stations.lat[:last], stations.lon[:last]
    vectors = conformal_unit_vectors(lat, lon)
    reach = _REACH * near / MEAN_RADIUS
    parts = []
    for others in (np.arange(first), own):
        if not len(others) or not len(own):
            continue
        count = min(_NEIGHBOURS, len(others))
        separation, found = cKDTree(vectors[others]).query(
            vectors[own], k=np.arange(1, count + 1), distance_upper_bound=reach
        )
        row, column = np.nonzero(np.isfinite(separation))
        a, b = own[row], others[found[row, column]]
        once = (b < first) | (a < b)
        parts.append(measured_pairs(lat, lon, a[once].astype(np.int32), b[once].astype(np.int32)))
    pairs = (
        concatenate_pairs(parts) if parts else measured_pairs(lat, lon, *np.empty((2, 0), np.int32))
    )
    pairs = pairs.where(pairs.length > 1.0)
    return pairs.where(allowed_legs(chart, lat, lon, pairs.first, pairs.second)[0])


def _shores(
    ground: LatticeSpecification, island: float, apart: float
) -> tuple[ShoreEdges, IntArray]:
    """Return the shores of large land in the region, in short edges, and of which land."""
    none = np.empty((0, 3))
    rings = ground.chart.coastline.rings
    if not len(rings):
        return (none, none), np.empty(0, np.int64)
    vectors = conformal_unit_vectors(rings.lat, rings.lon)
    land = np.repeat(np.arange(len(rings)), np.diff(rings.start))
    inside = ground.region.contains(vectors) & (ring_areas(rings) >= island**2)[land]
    first = np.flatnonzero((inside[:-1] | inside[1:]) & (land[:-1] == land[1:]))
    edges, edge = _split_edges((vectors[first], vectors[first + 1]), apart)
    return edges, land[first][edge]


def _split_edges(edges: ShoreEdges, apart: float) -> tuple[ShoreEdges, IntArray]:
    """Split edges into parts at most ``apart`` [m] long; return also the edge of each part."""
    a, b = edges
    parts = np.ceil(np.linalg.norm(b - a, axis=1) * MEAN_RADIUS / apart).astype(np.int64)
    parts = np.clip(parts, 1, _MAX_PARTS)
    edge, number = numbered_parts(parts)
    along = (b - a)[edge] / parts[edge, None]
    return (a[edge] + number[:, None] * along, a[edge] + (number[:, None] + 1) * along), edge


def _channel_midpoints(shores: ShoreEdges, land: IntArray, widest: float) -> FloatArray:
    """Return the middles between facing shores, from wide channels to narrow ones.

    Shores are divided further where others are near, so that places along them are closer together
    than the channel is wide.
    """
    midpoints, width = [np.empty((0, 3))], widest
    while len(land):
        places = _normalised(shores[0])
        separation, middle = _facing_shore(places, land, width)
        last = width <= _MIN_WIDTH
        here = (separation <= width) & (last | (separation > 0.5 * width))
        midpoints.append(_one_per_cell(middle[here], _THINNING_CELL * width))
        if last:
            break
        width *= 0.5
        near = separation <= (1.0 + 2.0 * _SHORE_SPACING) * width
        shores, edge = _split_edges((shores[0][near], shores[1][near]), _SHORE_SPACING * width)
        land = land[near][edge]
    return np.concatenate(midpoints)


def _facing_shore(
    places: FloatArray, land: IntArray, within: float
) -> tuple[FloatArray, FloatArray]:
    """Return how far other land is from places [m], inf if not near, and the middles."""
    from scipy.spatial import cKDTree

    count = min(_NEAREST_SHORE_PLACES, len(places))
    separation, found = cKDTree(places).query(
        places, k=np.arange(1, count + 1), distance_upper_bound=within / MEAN_RADIUS
    )
    other = np.isfinite(separation) & (land[np.minimum(found, len(land) - 1)] != land[:, None])
    first = other.argmax(axis=1)
    row = np.arange(len(places))
    nearest = np.where(other[row, first], found[row, first], row)
    apart = np.where(nearest != row, separation[row, first] * MEAN_RADIUS, np.inf)
    return apart, _normalised(places + places[nearest])


def _one_per_cell(places: FloatArray, apart: float) -> FloatArray:
    """Return one of all places in each cell of a size [m]."""
    cells = np.floor(places * (MEAN_RADIUS / apart)).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return np.asarray(places[np.sort(first)])


def _normalised(places: FloatArray) -> FloatArray:
    """Return vectors (n, 3) scaled to unit length."""
    return np.asarray(places / np.linalg.norm(places, axis=1, keepdims=True))
