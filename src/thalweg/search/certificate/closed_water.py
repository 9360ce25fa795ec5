"""Which cells of a mesh no ship may enter at any time: land, offing, zones and the chart's area."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from thalweg.chart.coast.coast_index_builder import shared_meridian_edges
from thalweg.chart.offing import required_offing
from thalweg.chart.zones.leg_fractions import points_inside
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import METRES_PER_DEGREE, densify, longitude_difference
from thalweg.core.types import BoolArray, FloatArray

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.rings import Rings
    from thalweg.chart.zones.zone_set import Zones

_OFFING_SHARE: Final = 0.98  # routes may be nearer to land than required by a small share
_OUTLINE_PARTS: Final = 0.5  # of a cell: outlines of zones are great circles, split into these


class LinePieces(NamedTuple):
    """Straight pieces of lines: first and last latitudes and longitudes [deg], (2, pieces)."""

    lat: FloatArray
    lon: FloatArray


def closed_cells(
    chart: Chart | None, lat: FloatArray, lon: FloatArray, kept_out: Sequence[Any] = ()
) -> BoolArray:
    """Return which cells of a mesh are closed all over, whatever the time.

    A cell is closed if it is land, no-go zone or closed shoal at its centre and no shore or outline
    passes through it, if all of it is nearer to land than the chart requires, or if it is outside
    the chart's area.

    Parameters
    ----------
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg].
    kept_out : Shapely polygons (x longitude, y latitude [deg]) that count as no-go zones too.

    Returns
    -------
    bool array (Y - 1, X - 1)
    """
    shape = lat.size - 1, lon.size - 1
    if chart is None:
        return np.zeros(shape, bool)
    centres = _centres(lat, lon)
    kept = chart.offing_arrays.distance
    shore = np.asarray(chart.coastline.shore_distance(*centres, cap=max(1.0, kept)))
    shores = _shore_pieces(chart.coastline.rings, lat, lon)
    closed = (shore.reshape(shape) <= 0.0) & ~_touched(shores, lat, lon)
    closed |= _outside_area(chart, lat, lon)
    if kept > 0.0:
        near = np.flatnonzero(shore < kept)
        half = 0.5 * np.hypot(lat[1] - lat[0], lon[1] - lon[0]) * METRES_PER_DEGREE * 1.01
        required = np.zeros(shore.size)
        required[near] = required_offing(chart.offing_arrays, centres[0][near], centres[1][near])
        # neither distance changes by more than a metre a metre
        too_near = shore + half < _OFFING_SHARE * (required - half)
        closed |= too_near.reshape(shape)
    if chart.zones.closed_shapes:
        inside = points_inside(chart.zones.closed_index, *centres).reshape(shape)
        closed |= inside & ~_touched(_zone_pieces(chart.zones.closed_shapes, lat, lon), lat, lon)
    if kept_out:
        inside = _inside_one_of(kept_out, *centres).reshape(shape)
        closed |= inside & ~_touched(_zone_pieces(kept_out, lat, lon), lat, lon)
    result: BoolArray = closed
    return result


def cells_inside(areas: Zones, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return which cells of a mesh are all over in emission control areas.

    Parameters
    ----------
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg].

    Returns
    -------
    bool array (Y - 1, X - 1)
    """
    inside = areas.in_eca(*_centres(lat, lon)).reshape(lat.size - 1, lon.size - 1)
    rings = [area.rings for area in areas.eca]
    lines = [(one.lat[a:b], one.lon[a:b]) for one in rings for a, b in pairwise(one.start)]
    result: BoolArray = np.asarray(inside & ~_touched(_pieces_of(lines), lat, lon))
    return result


def _centres(lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the latitudes and longitudes [deg] of the centres of all cells, row by row."""
    rows, columns = 0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1])
    grid = np.meshgrid(rows, columns, indexing="ij")
    return grid[0].ravel(), grid[1].ravel()


def _outside_area(chart: Chart, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return which cells are wholly north or south of the area of a chart."""
    area = chart.area
    rows = (lat[:-1] > area.north) | (lat[1:] < area.south)
    return np.broadcast_to(rows[:, None], (rows.size, lon.size - 1))


def _inside_one_of(shapes: Sequence[Any], lat: FloatArray, lon: FloatArray) -> BoolArray:
    import shapely

    inside = np.zeros(lat.size, bool)
    for shape in shapes:
        middle = 0.5 * (shape.bounds[0] + shape.bounds[2])
        inside |= shapely.contains_xy(shape, longitude_difference(lon, middle) + middle, lat)
    return inside


def _shore_pieces(rings: Rings, lat: FloatArray, lon: FloatArray) -> LinePieces:
    """Return the edges of land near a mesh, but for those at which the data split land."""
    edges = LinePieces(
        np.stack([rings.lat[:-1], rings.lat[1:]]), np.stack([rings.lon[:-1], rings.lon[1:]])
    )
    kept = _are_near(edges, lat, lon)
    kept[rings.start[1:-1] - 1] = False  # from one ring to the next
    kept[shared_meridian_edges(edges.lat[0], edges.lat[1], edges.lon[0], edges.lon[1], kept)] = (
        False
    )
    return LinePieces(edges.lat[:, kept], edges.lon[:, kept])


def _are_near(boxes: LinePieces, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return which boxes, by two corners each, are within a degree of a mesh."""
    near = (boxes.lat.min(axis=0) <= lat[-1] + 1.0) & (boxes.lat.max(axis=0) >= lat[0] - 1.0)
    west, east = boxes.lon.min(axis=0), boxes.lon.max(axis=0)
    turns = np.array([-360.0, 0.0, 360.0])[:, None]
    near &= ((west + turns <= lon[-1] + 1.0) & (east + turns >= lon[0] - 1.0)).any(axis=0)
    result: BoolArray = near
    return result


def _zone_pieces(shapes: Sequence[Any], lat: FloatArray, lon: FloatArray) -> LinePieces:
    """Return short pieces of the outlines, on great circles, of the polygons near a mesh."""
    import shapely

    every = np.asarray(shapes, object)
    west, south, east, north = shapely.bounds(every).reshape(-1, 4).T
    bulge = 0.25 * (east - west)  # great circles leave the box of their ends
    boxes = LinePieces(np.stack([south - bulge, north + bulge]), np.stack([west, east]))
    near = _are_near(boxes, lat, lon)
    step = max(_OUTLINE_PARTS * (lat[1] - lat[0]) * METRES_PER_DEGREE, 100.0)
    lines = []
    for shape in every[near]:
        for ring in (shape.exterior, *shape.interiors):
            ring_lon, ring_lat = np.asarray(ring.coords, float)[:, :2].T
            close_lat, close_lon, _ = densify(ring_lat, ring_lon, step)
            lines.append((close_lat, np.degrees(np.unwrap(np.radians(close_lon)))))
    return _pieces_of(lines)


def _pieces_of(lines: Sequence[tuple[FloatArray, FloatArray]]) -> LinePieces:
    """Return the pieces of lines (lat, lon) [deg]."""
    if not lines:
        return LinePieces(np.empty((2, 0)), np.empty((2, 0)))
    lat, lon = (np.concatenate([line[side] for line in lines]) for side in (0, 1))
    begins = np.ones(lat.size, bool)  # at all points but the last of each line
    begins[np.cumsum([line[0].size for line in lines]) - 1] = False
    first = np.flatnonzero(begins)
    return LinePieces(
        np.stack([lat[first], lat[first + 1]]), np.stack([lon[first], lon[first + 1]])
    )


def _touched(pieces: LinePieces, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return the cells that pieces of lines pass through."""
    cells = np.zeros((lat.size - 1, lon.size - 1), bool)
    y = (pieces.lat - lat[0]) / (lat[1] - lat[0])
    for turn in (-360.0, 0.0, 360.0):
        x = (pieces.lon + turn - lon[0]) / (lon[1] - lon[0])
        near = np.ones(x.shape[1], bool)
        for places, count in ((y, cells.shape[0]), (x, cells.shape[1])):
            near &= (places.max(axis=0) >= -1.0) & (places.min(axis=0) <= count + 1.0)
        if near.any():
            _mark_pieces(cells, y[:, near], x[:, near])
    return cells


def _mark_pieces(cells: BoolArray, y: FloatArray, x: FloatArray) -> None:
    """Mark the cells that the boxes round short parts of straight pieces touch.

    Parameters
    ----------
    y, x : Rows and columns of the first and last points of the pieces, (2, pieces).
    """
    length = np.maximum(np.abs(y[1] - y[0]), np.abs(x[1] - x[0]))
    parts = np.maximum(np.ceil(2.0 * np.minimum(length, 1e5)).astype(np.int64), 1)
    piece = np.repeat(np.arange(length.size), parts)
    first = cumulative_sums(parts)[:-1]
    share = (np.arange(piece.size) - first[piece]) / parts[piece]
    step_y, step_x = (y[1] - y[0]) / parts, (x[1] - x[0]) / parts
    y0 = y[0, piece] + share * (y[1] - y[0])[piece]
    x0 = x[0, piece] + share * (x[1] - x[0])[piece]
    y1, x1 = y0 + step_y[piece], x0 + step_x[piece]
    margin = 0.02  # the outlines are great circles, drawn here as straight lines
    for row in (np.minimum(y0, y1) - margin, np.maximum(y0, y1) + margin):
        for column in (np.minimum(x0, x1) - margin, np.maximum(x0, x1) + margin):
            j, i = np.floor(row).astype(np.int64), np.floor(column).astype(np.int64)
            inside = (j >= 0) & (i >= 0) & (j < cells.shape[0]) & (i < cells.shape[1])
            cells[j[inside], i[inside]] = True
