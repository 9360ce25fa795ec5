"""The bed of gridded data along the edges of a network.

The search reads the bed at the stations of a network. A sill or bar of one row of the data lies
between them and would be passed at a water level that is too low, which the referee refuses: the
edges get the least depth along them, at the very rows and columns of the data.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network import Network
from thalweg.sea import Sea
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.rectilinear_grid import RectilinearGrid
from thalweg.sea.standard_names import BED_DEPTH

_WATER_LEVELS: Final = 8.0  # deeper than required by this, the bed does not matter [m]
_LONGEST_EDGE: Final = 20e3  # that is straight in degrees to 10 m [m]
_ROUNDING: Final = 1e-9  # of places in rows and columns
_MOST_POINTS, _POINTS_AT_ONCE = 4_000_000, 200_000  # of the data that are read
_EDGES_AT_ONCE: Final = 20_000


def with_bed_along_edges(network: Network, sea: Sea, required_depth: float) -> Network:
    """Return a network whose edges are no deeper than the bed along them, and unknown where it is.

    For a bed that does not change, on a grid of latitude and longitude in one file. Edges longer
    than 20 km and those over deep water stay as they are.

    Parameters
    ----------
    required_depth : Greatest depth that ships require [m]; -inf if none, +inf if any.

    Returns
    -------
    Network : The same one where no edge changes.
    """
    if required_depth == -np.inf:
        return network
    bed = BedGrid.around(network.stations.lat, network.stations.lon, sea)
    if bed is None:
        return network
    shoal = bed.cells_below(required_depth + _WATER_LEVELS)
    if not shoal.any():
        return network
    short = np.isnan(network.edges.fixed_time) & (network.edges.length <= _LONGEST_EDGE)
    edges = np.flatnonzero(short)
    y, x = bed.places(network.stations.lat, network.stations.lon)
    tails, heads = network.tails()[edges], network.graph.target[edges]
    lines = _Lines(y[tails], x[tails], y[heads], x[heads])
    over = lines.over_cells(shoal)
    depth = network.edges.depth.copy()
    for part in np.array_split(np.flatnonzero(over), 1 + over.sum() // _EDGES_AT_ONCE):
        least = bed.least_along(_Lines(*(values[part] for values in lines)))
        depth[edges[part]] = np.minimum(depth[edges[part]], least)  # unknown where either is
    if np.array_equal(depth, network.edges.depth, equal_nan=True):
        return network
    return network.with_edges(depth=depth)


def bed_layer(sea: Sea) -> GridLayer | None:
    """Return the layer of a bed that does not change, on a grid of axes; None for other beds."""
    layers = [layer for layer in sea.layers if BED_DEPTH in layer.variables]
    if len(layers) != 1 or layers[0].period is not None or not isinstance(layers[0], GridLayer):
        return None
    return layers[0] if isinstance(layers[0].grid, RectilinearGrid) else None


class _Lines(NamedTuple):
    """Straight lines between places in rows and columns, with fractions; NaN outside the grid."""

    y1: FloatArray
    x1: FloatArray
    y2: FloatArray
    x2: FloatArray

    def over_cells(self, cells: BoolArray) -> BoolArray:
        """Return which lines have a marked cell in the box of their ends, and both ends inside."""
        total = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), np.int64)
        total[1:, 1:] = cells.cumsum(0).cumsum(1)
        inside = np.isfinite(self.y1 + self.x1 + self.y2 + self.x2)
        corners = []
        for a, b, count in ((self.y1, self.y2, len(cells)), (self.x1, self.x2, cells.shape[1])):
            low = np.where(inside, np.minimum(a, b), 0.0).astype(np.int64)
            high = np.where(inside, np.maximum(a, b), 0.0).astype(np.int64) + 1
            corners += [np.minimum(low, count - 1), np.minimum(high, count)]
        south, north, west, east = corners
        found = total[north, east] - total[south, east] - total[north, west] + total[south, west]
        return np.asarray(inside & (found > 0))

    def crossings(self) -> tuple[IntArray, FloatArray]:
        """Return lines, in order, and shares of them: ends, and crossings of rows and columns."""
        rows, row = _crossed_lines(self.y1, self.y2)
        columns, column = _crossed_lines(self.x1, self.x2)
        every = np.arange(len(self.y1))
        line = np.concatenate([every, every, rows, columns])
        share = np.concatenate(
            [
                np.zeros(len(every)),
                np.ones(len(every)),
                (row - self.y1[rows]) / (self.y2 - self.y1)[rows],
                (column - self.x1[columns]) / (self.x2 - self.x1)[columns],
            ]
        )
        order = np.lexsort((share, line))
        return line[order], share[order]

    def at(self, line: IntArray, share: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return places at shares of lines; on a row or column to rounding, they are on it."""
        y = self.y1[line] + share * (self.y2 - self.y1)[line]
        x = self.x1[line] + share * (self.x2 - self.x1)[line]
        on_row, on_column = np.rint(y), np.rint(x)
        y = np.where(np.abs(y - on_row) < _ROUNDING, on_row, y)
        return y, np.where(np.abs(x - on_column) < _ROUNDING, on_column, x)


class BedGrid(NamedTuple):
    """Bed depths on rows and columns.

    Attributes
    ----------
    lat, lon : Of rows and columns, increasing [deg], (Y,) and (X,).
    depth : NaN where unknown [m], (Y, X).
    """

    lat: FloatArray
    lon: FloatArray
    depth: FloatArray

    @classmethod
    def around(cls, lat: FloatArray, lon: FloatArray, sea: Sea) -> BedGrid | None:
        """Return the bed of a sea round positions [deg], as it is filled.

        None where the sea has no such bed (`bed_layer`), or too many or too few points of it.
        """
        layer = bed_layer(sea)
        if layer is None:
            return None
        grid: Any = layer.grid
        rows, columns = np.sort(np.asarray(grid.lat, float)), np.asarray(grid.lon, float)
        lat = rows[_between(rows, lat)]
        lon = columns[_between(columns, _turned(lon, columns))]
        if min(lat.size, lon.size) < 2 or lat.size * lon.size > _MOST_POINTS:
            return None
        rows_at_once = max(1, _POINTS_AT_ONCE // lon.size)
        parts = [lat[k : k + rows_at_once] for k in range(0, lat.size, rows_at_once)]
        return cls(lat, lon, np.concatenate([_sampled(sea, part, lon) for part in parts]))

    def places(self, lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return rows and columns of positions, with fractions; NaN outside."""
        y = np.interp(lat, self.lat, np.arange(self.lat.size), np.nan, np.nan)
        x = _turned(lon, self.lon)
        return y, np.interp(x, self.lon, np.arange(self.lon.size), np.nan, np.nan)

    def cells_below(self, depth: float) -> BoolArray:
        """Return which cells have a corner of less than a depth, or of unknown depth."""
        low = ~(self.depth >= depth)
        return np.asarray(low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:])

    def known_all_round(self) -> BoolArray:
        """Return which points have a known depth, with all eight round them in the grid."""
        known = np.pad(np.isfinite(self.depth), 1, constant_values=True)
        parts = np.lib.stride_tricks.sliding_window_view(known, (3, 3))
        return np.asarray(parts.all(axis=(2, 3)))

    def least_along(self, lines: _Lines) -> FloatArray:
        """Return the least depth along lines; NaN where it is unknown.

        Between crossings of rows and columns the depth is a parabola, by its ends and middle.
        """
        line, share = lines.crossings()
        depth = self._bilinear(*lines.at(line, share))
        first = np.flatnonzero((line[1:] == line[:-1]) & (np.diff(share) > _ROUNDING))
        middle = 0.5 * (share[first] + share[first + 1])
        begin, end = depth[first], depth[first + 1]
        between = self._bilinear(*lines.at(line[first], middle))
        bend = 2.0 * (begin + end - 2.0 * between)
        slope = 4.0 * between - end - 3.0 * begin
        turns = (bend > 0.0) & (slope < 0.0) & (slope > -2.0 * bend)
        least = np.minimum(begin, np.minimum(between, end))
        least = np.where(turns, begin - slope**2 / (4.0 * np.where(turns, bend, 1.0)), least)
        found = np.full(len(lines.y1), np.inf)
        with np.errstate(invalid="ignore"):  # unknown there
            np.minimum.at(found, line, depth)
            np.minimum.at(found, line[first], least)
        return found

    def _bilinear(self, y: FloatArray, x: FloatArray) -> FloatArray:
        j = np.clip(y.astype(np.int64), 0, self.lat.size - 2)
        i = np.clip(x.astype(np.int64), 0, self.lon.size - 2)
        t, s = y - j, x - i
        total = np.zeros(len(y))
        for rows, across in ((0, 1.0 - t), (1, t)):
            for columns, along in ((0, 1.0 - s), (1, s)):
                weight = across * along  # values without weight may be unknown
                total += np.where(weight > 0.0, weight * self.depth[j + rows, i + columns], 0.0)
        return total


def _sampled(sea: Sea, lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the bed on rows and columns [m]."""
    at_lat, at_lon = (axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij"))
    found = sea.sample([BED_DEPTH], np.zeros(at_lat.size), at_lat, at_lon)[BED_DEPTH]
    return np.asarray(found).reshape(lat.size, lon.size)


def _turned(lon: FloatArray, axis: FloatArray) -> FloatArray:
    """Return longitudes by whole turns near the middle of an axis [deg]."""
    middle = 0.5 * (axis[0] + axis[-1])
    return np.asarray((lon - middle + 180.0) % 360.0 + middle - 180.0)


def _between(axis: FloatArray, values: FloatArray) -> slice:
    """Return the part of an increasing axis that contains values."""
    first = int(np.searchsorted(axis, values.min(), "right")) - 1
    last = int(np.searchsorted(axis, values.max(), "left"))
    return slice(max(first, 0), last + 1)


def _crossed_lines(first: FloatArray, last: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return of every whole number between two values its pair of values, and the number."""
    low, high = np.ceil(np.minimum(first, last)), np.floor(np.maximum(first, last))
    moved = first != last
    count = np.where(moved, np.maximum(high - low + 1, 0), 0).astype(np.int64)
    line, number = numbered_parts(count)
    return line, low[line] + number
