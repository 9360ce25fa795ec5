"""The grid of coast edges for the kernels of `thalweg.kernels.geometry.cube_sphere`."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.rings import Rings
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.arrays.sphere_vectors import arc_of_chord
from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.core.geodesy import geocentric_positions, geocentric_unit_vectors
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.geometry.cube_sphere import (
    FIRST_ROW,
    IndexArrays,
    cell_middle,
)
from thalweg.kernels.geometry.winding_numbers import carry_windings

MAX_SEGMENT_LENGTH: Final = (
    10_000.0 / MEAN_RADIUS
)  # edges are split into pieces no longer than this [rad]
MAX_BULGE: Final = 1.0 / MEAN_RADIUS  # and bulging no more than this [rad]
CELL_MARGIN: Final = 8.0e-5  # edges are listed in cells this near on the face (about 500 m)
MAX_CLEARANCE: Final = 0.5  # largest distance that is stored [rad]


class CoastSegments(NamedTuple):
    """Short pieces of edges: unit vectors of both ends, and whether each continues the last."""

    start: FloatArray
    end: FloatArray
    continues_previous: NDArray[np.bool_]


def build_index(rings: Rings, side: int) -> IndexArrays:
    """Return the index of polygons given as rings (outer counter-clockwise, holes clockwise).

    Parameters
    ----------
    rings : Polygons; where they overlap, the union counts (non-zero winding).
    side : Cells along a side of each of the six faces.
    """
    if not len(rings):
        return empty_index()
    pieces = _cut_edges(rings)
    cell_ids, edge_ids = _segments_by_cell(pieces, side)
    index = _assemble_index(pieces, cell_ids, edge_ids, side)
    carry_windings(index, _seed_windings(rings, side))
    _set_clearance(index, pieces)
    return index


def empty_index() -> IndexArrays:
    """Return an index without any polygon."""
    return IndexArrays(
        1,
        np.full(6, MAX_CLEARANCE, np.float32),
        np.zeros(1, np.int64),
        np.zeros(0, np.int32),
        np.zeros((0, 3)),
        np.zeros(0, np.uint8),
    )


def shared_meridian_edges(
    lat0: FloatArray,
    lat1: FloatArray,
    lon0: FloatArray,
    lon1: FloatArray,
    is_edge: NDArray[np.bool_],
) -> IntArray:
    """Return the edges along meridians that two polygons share, where one land was split in two.

    Parameters
    ----------
    lat0, lat1, lon0, lon1 : First and last positions of edges [deg], (n,).
    is_edge : Which of them are edges of polygons, (n,).
    """
    k = np.flatnonzero((lon0 == lon1) & (lat0 != lat1) & is_edge)
    low, high = np.minimum(lat0[k], lat1[k]), np.maximum(lat0[k], lat1[k])
    places = np.stack([low, high, lon0[k] % 360.0], -1)
    _, which = np.unique(places, axis=0, return_inverse=True)
    turns = np.bincount(which.ravel(), np.sign(lat1[k] - lat0[k]))
    often = np.bincount(which.ravel())
    return k[((turns == 0.0) & (often > 1))[which.ravel()]]


def _cut_edges(rings: Rings) -> CoastSegments:
    """Split edges so that arcs stay near the straight line in longitude and latitude."""
    lat0, lat1 = rings.lat[:-1], rings.lat[1:]
    lon0, lon1 = rings.lon[:-1], rings.lon[1:]
    keep = (lat0 != lat1) | (lon0 != lon1)
    keep &= ~((np.abs(lat0) >= 90.0) & (np.abs(lat1) >= 90.0))
    keep[rings.start[1:-1] - 1] = False
    keep[shared_meridian_edges(lat0, lat1, lon0, lon1, keep)] = False
    edge = np.flatnonzero(keep)
    lat0, lat1, lon0, lon1 = lat0[edge], lat1[edge], lon0[edge], lon1[edge]
    north, east = np.radians(lat1 - lat0), np.radians(lon1 - lon0)
    middle = np.radians((lat0 + lat1) / 2.0)
    bulge = np.abs(np.sin(2.0 * middle)) / 16.0 * east**2 + np.abs(north * east) / 8.0
    length = np.hypot(north, east * np.cos(middle) + np.abs(north * east) / 2.0)
    parts = np.ceil(np.maximum(np.sqrt(bulge / MAX_BULGE), length / MAX_SEGMENT_LENGTH))
    parts = np.maximum(parts, 1.0).astype(np.int64)
    first = np.cumsum(parts) - parts
    which = np.repeat(np.arange(len(edge)), parts)
    number = np.arange(len(which)) - first[which]
    start = _positions_on_edges(lat0, lat1, lon0, lon1, which, number / parts[which])
    end = _positions_on_edges(lat0, lat1, lon0, lon1, which, (number + 1) / parts[which])
    joins = np.append(False, np.diff(edge) == 1)
    continues_previous = (number > 0) | joins[which]
    return CoastSegments(start, end, continues_previous)


def _positions_on_edges(
    lat0: FloatArray,
    lat1: FloatArray,
    lon0: FloatArray,
    lon1: FloatArray,
    which: IntArray,
    share: FloatArray,
) -> FloatArray:
    """Return unit vectors at shares of edges; the ends exactly."""
    lat = lat0[which] + share * (lat1 - lat0)[which]
    lon = lon0[which] + share * (lon1 - lon0)[which]
    last = share == 1.0
    lat[last], lon[last] = lat1[which[last]], lon1[which[last]]
    return geocentric_unit_vectors(lat, lon)


def _face_components(xyz: FloatArray, face: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    axis = face // 2
    outward = xyz[:, axis] if face % 2 == 0 else -xyz[:, axis]
    return xyz[:, (axis + 1) % 3], xyz[:, (axis + 2) % 3], outward


def _segments_by_cell(pieces: CoastSegments, side: int) -> tuple[IntArray, IntArray]:
    """Return (cell, piece) pairs, sorted: which pieces may lie in or near which cells."""
    count = len(pieces.start)
    keys: list[IntArray] = []
    for face in range(6):
        w0, w1 = (_face_components(x, face)[2] for x in (pieces.start, pieces.end))
        near = np.flatnonzero((w0 > 0.5) & (w1 > 0.5))
        u0, v0, w0 = _face_components(pieces.start[near], face)
        u1, v1, w1 = _face_components(pieces.end[near], face)
        box = []
        for a, b in ((u0 / w0, u1 / w1), (v0 / w0, v1 / w1)):
            low, high = np.minimum(a, b) - CELL_MARGIN, np.maximum(a, b) + CELL_MARGIN
            box += [np.floor((low + 1.0) * 0.5 * side), np.floor((high + 1.0) * 0.5 * side)]
        i0, i1, j0, j1 = (x.astype(np.int64) for x in box)
        on = (i1 >= 0) & (i0 < side) & (j1 >= 0) & (j0 < side)
        near, i0, i1, j0, j1 = near[on], i0[on], i1[on], j0[on], j1[on]
        i0, j0 = np.maximum(i0, 0), np.maximum(j0, 0)
        wide, high_ = np.minimum(i1, side - 1) - i0 + 1, np.minimum(j1, side - 1) - j0 + 1
        copies = wide * high_
        which, number = numbered_parts(copies)
        cell = (face * side + j0[which] + number // wide[which]) * side
        cell += i0[which] + number % wide[which]
        keys.append(cell * count + near[which])
    key = np.sort(np.concatenate(keys))
    return key // count, key % count


def _assemble_index(
    pieces: CoastSegments, cells: IntArray, edges: IntArray, side: int
) -> IndexArrays:
    """Return the index with its rows of edges, cells outside them still zero."""
    new_cell = np.append(True, np.diff(cells) != 0)
    chained = np.append(False, np.diff(edges) == 1) & ~new_cell & pieces.continues_previous[edges]
    vertices = np.cumsum(2 - chained)
    xyz = np.empty((vertices[-1], 3))
    first = np.zeros(vertices[-1], np.uint8)
    xyz[vertices - 1] = pieces.end[edges]
    xyz[vertices[~chained] - 2] = pieces.start[edges[~chained]]
    first[vertices[~chained] - 2] = 1
    row_start = np.append(vertices[new_cell] - 2, vertices[-1])
    cell = np.zeros(6 * side * side, np.float32)
    cell[cells[new_cell]] = FIRST_ROW - np.arange(new_cell.sum())
    winding = np.zeros(len(row_start) - 1, np.int32)
    return IndexArrays(side, cell, row_start.astype(np.int64), winding, xyz, first)


def _seed_windings(rings: Rings, side: int) -> IntArray:
    """Return the winding number at the middle of the first cell of each face."""
    keep = np.ones(len(rings.lat) - 1, bool)
    keep[rings.start[1:-1] - 1] = False
    lat0, lat1 = rings.lat[:-1][keep], rings.lat[1:][keep]
    lon0, lon1 = rings.lon[:-1][keep], rings.lon[1:][keep]
    seeds = np.zeros(6, np.int64)
    for face in range(6):
        lat, middle = geocentric_positions(np.array(cell_middle(face, 0, 0, side)))
        for lon in middle + np.array([-360.0, 0.0, 360.0]):
            k = np.flatnonzero((lon0 <= lon) != (lon1 <= lon))
            at = lat0[k] + (lon - lon0[k]) / (lon1[k] - lon0[k]) * (lat1[k] - lat0[k])
            seeds[face] += np.sum(np.where(lon1[k] > lon0[k], -1, 1)[at > lat])
    return seeds


def _set_clearance(index: IndexArrays, pieces: CoastSegments) -> None:
    """Write a lower bound of the distance [rad] to the edges into each cell outside."""
    from scipy.spatial import cKDTree

    side = index.side
    blocks = min(side, 128)
    size = side // blocks
    border = np.arange(blocks + 1) * 2.0 * size / side - 1.0
    u, v = np.meshgrid(border, border)
    middle = (np.arange(blocks) + 0.5) * 2.0 * size / side - 1.0
    um, vm = np.meshgrid(middle, middle)
    tree = cKDTree(pieces.start, compact_nodes=False, balanced_tree=False)  # queries from afar
    lengths = np.linalg.norm(pieces.end - pieces.start, axis=1)
    corners, centres = _directions(u, v), _directions(um, vm)
    reach = np.zeros_like(um)
    for dj, di in ((0, 0), (0, 1), (1, 0), (1, 1)):
        corner = corners[dj : dj + blocks, di : di + blocks]
        reach = np.maximum(reach, np.arccos(np.sum(corner * centres, -1)))
    far = MAX_CLEARANCE + float(reach.max() + lengths.max()) + 1e-3  # more makes no difference
    largest_chord = 2.0 * np.sin(0.5 * min(far, np.pi))
    cells = index.cell.reshape(6, side, side)
    for face in range(6):
        turned = np.roll(centres, face // 2 + 1, -1)
        if face % 2:
            turned[..., face // 2] *= -1.0
        chord, _ = tree.query(turned.reshape(-1, 3), workers=2, distance_upper_bound=largest_chord)
        separation = arc_of_chord(chord).reshape(blocks, blocks)
        bound = np.clip(separation - reach - lengths.max() - 1e-4, 0.0, MAX_CLEARANCE)
        fine = np.repeat(np.repeat(bound, size, 0), size, 1).astype(np.float32)
        sea = cells[face] > 0.0
        cells[face][sea] = np.maximum(cells[face][sea], fine[sea])


def _directions(u: FloatArray, v: FloatArray) -> FloatArray:
    xyz = np.stack([u, v, np.ones_like(u)], -1)
    return np.asarray(xyz / np.linalg.norm(xyz, axis=-1, keepdims=True))
