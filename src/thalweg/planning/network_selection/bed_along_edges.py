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

_WATER_LEVELS: Final = 15.0  # deeper than required by this, the bed does not matter [m]
_LONGEST_EDGE: Final = 20e3  # that is straight in degrees to 10 m [m]
_MOST_POINTS: Final = 4_000_000  # of the data that are read


def with_bed_along_edges(network: Network, sea: Sea, required_depth: float) -> Network:
    """Return a network whose edges are no deeper than the bed along them.

    For a bed that does not change, on a grid of latitude and longitude in one file. Edges longer
    than 20 km and those over deep water stay as they are.

    Parameters
    ----------
    required_depth : Greatest depth that ships require [m]; -inf if none, +inf if any.

    Returns
    -------
    Network : The same one where no edge changes.
    """
    layers: list[Any] = [layer for layer in sea.layers if BED_DEPTH in layer.variables]
    if required_depth == -np.inf or len(layers) != 1 or layers[0].period is not None:
        return network
    if not (isinstance(layers[0], GridLayer) and isinstance(layers[0].grid, RectilinearGrid)):
        return network
    bed = _BedGrid.around(network, layers[0])
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
    depth, edges = network.edges.depth.copy(), edges[over]
    least = bed.least_along(_Lines(*(values[over] for values in lines)))
    depth[edges] = np.where(least < depth[edges], least, depth[edges])
    if np.array_equal(depth, network.edges.depth, equal_nan=True):
        return network
    return network.with_edges(depth=depth)


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

    def on_rows(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return lines and places where they cross rows of the grid."""
        line, row = _crossed_lines(self.y1, self.y2)
        share = (row - self.y1[line]) / (self.y2 - self.y1)[line]
        return line, row, self.x1[line] + share * (self.x2 - self.x1)[line]

    def on_columns(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """Return lines and places where they cross columns of the grid."""
        line, y, x = _Lines(self.x1, self.y1, self.x2, self.y2).on_rows()
        return line, x, y


class _BedGrid(NamedTuple):
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
    def around(cls, network: Network, layer: GridLayer) -> _BedGrid | None:
        """Return the part of a layer round a network; None if it is too large or too small."""
        grid: Any = layer.grid
        lat, lon = np.sort(np.asarray(grid.lat, float)), np.asarray(grid.lon, float)
        y = network.stations.lat
        x = _turned(network.stations.lon, lon)
        rows, columns = _between(lat, y), _between(lon, x)
        lat, lon = lat[rows], lon[columns]
        if min(lat.size, lon.size) < 2 or lat.size * lon.size > _MOST_POINTS:
            return None
        at_lat, at_lon = (axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij"))
        found = layer.sample([BED_DEPTH], np.zeros(at_lat.size), at_lat, at_lon)[BED_DEPTH]
        return cls(lat, lon, found.reshape(lat.size, lon.size))

    def places(self, lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return rows and columns of positions, with fractions; NaN outside."""
        y = np.interp(lat, self.lat, np.arange(self.lat.size), np.nan, np.nan)
        x = _turned(lon, self.lon)
        return y, np.interp(x, self.lon, np.arange(self.lon.size), np.nan, np.nan)

    def cells_below(self, depth: float) -> BoolArray:
        """Return which cells have a corner of less than a depth."""
        low = self.depth < depth
        return np.asarray(low[:-1, :-1] | low[1:, :-1] | low[:-1, 1:] | low[1:, 1:])

    def least_along(self, lines: _Lines) -> FloatArray:
        """Return the least known depth along lines, at their ends and where they cross rows and
        columns; +inf where none is known.
        """
        least = np.fmin(np.inf, self._bilinear(lines.y1, lines.x1))
        least = np.fmin(least, self._bilinear(lines.y2, lines.x2))
        for line, y, x in (lines.on_rows(), lines.on_columns()):
            np.fmin.at(least, line, self._bilinear(y, x))
        return np.asarray(least)

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


def _turned(lon: FloatArray, axis: FloatArray) -> FloatArray:
    """Return longitudes by whole turns from the first of an axis on [deg]."""
    return np.asarray((lon - axis[0] + 1e-6) % 360.0 + axis[0] - 1e-6)


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
