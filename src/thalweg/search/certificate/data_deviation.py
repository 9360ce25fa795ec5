"""By how much data differ from a raster on which the lines of their grids are not.

A grid of axes is bilinear between its lines, and so is the raster between its own: in a cell of the
raster the difference is greatest where lines of both, or of one with those of the other, cross. In
a triangle of a mesh a value is a mean of those at its three corners. All is linear between times.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias

import numpy as np

from thalweg.core.arrays.raster_lines import (
    ON_LINE,
    cells_of_boxes,
    combined_in_cells,
    lines_with_raster,
    places_of_raster,
    values_on_lines,
)
from thalweg.core.types import BoolArray, Float32Array, FloatArray, IntArray
from thalweg.kernels.codes import CHANNEL_COUNT, CURRENT_EAST
from thalweg.sea.frozen_fields import GridFields
from thalweg.sea.grids.grid_protocol import GridLocation
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.rectilinear_grid import RectilinearGrid
from thalweg.sea.grids.triangle_grid import TriangleGrid
from thalweg.sea.layer import Layer
from thalweg.sea.models.function_layer import FormulaLayer
from thalweg.sea.standard_names import CHANNEL_VARIABLES, VECTORS

_MOST_VALUES: Final = 150_000_000  # of all layers, places and times that are compared
_VALUES_AT_A_TIME: Final = 4_000_000
_ROUNDING: Final = 1e-9
_POLAR: Final = 85.0  # [deg]: beyond it triangles are not plane in latitude and longitude


class DataMargins(NamedTuple):
    """By how much data may differ from a raster.

    Attributes
    ----------
    margins : float64[Y - 1, X - 1, CHANNELS]
        In each cell; of vectors the length of the difference, for both components.
    strongest_current : Of the data [m/s]; inf where they were not compared.
    """

    margins: FloatArray
    strongest_current: float


def margins_of_data(layers: Sequence[Layer], fields: GridFields) -> DataMargins | None:
    """Return by how much data may differ from a raster, in each of its cells.

    Nodes that the raster does not know are filled in cells in which the data are known somewhere.

    Parameters
    ----------
    layers : Of the sea, in order of priority.
    fields : The raster, (T, Y, X, K).

    Returns
    -------
    DataMargins or None
        None where a layer is no grid in files, or there are too many places and times to compare.
    """
    groups = _groups(fields)
    work = 0
    parts: list[tuple[tuple[int, ...], list[_OnRaster]]] = []
    for group in groups:
        names = [CHANNEL_VARIABLES[channel] for channel in group]
        having = [layer for layer in layers if not set(names).isdisjoint(layer.variables)]
        here = [one for layer in having if (one := _placed(layer, fields)) is not None]
        if len(here) < len(having):
            return None
        grids = [one for one in here if not isinstance(one, _UniformOnRaster)]
        # a value that fills the gaps of a grid on the lines is among the corners of its cell
        if not grids or (len(grids) == 1 and grids[0].is_on_lines):
            continue
        parts.append((group, here))
        work += sum(one.size for one in here) * fields.times.size * len(group)
    if work > _MOST_VALUES:
        return None
    _, rows, columns, _ = fields.values.shape
    margins = np.zeros((rows - 1, columns - 1, CHANNEL_COUNT))
    strongest = math.inf
    for group, here in parts:
        apart, size = _of_group(group, here, fields)
        margins[..., list(group)] = apart[..., None]
        if CURRENT_EAST in group:
            strongest = size * (1.0 + _ROUNDING)
    return DataMargins(margins, strongest)


def _groups(fields: GridFields) -> list[tuple[int, ...]]:
    """Return the channels of a raster, the components of a vector together."""
    present = [channel for channel in CHANNEL_VARIABLES if fields.channel_index[channel] >= 0]
    pairs = [vector.pair for vector in VECTORS]
    groups: list[tuple[int, ...]] = []
    for channel in present:
        name = CHANNEL_VARIABLES[channel]
        pair = next((pair for pair in pairs if name in pair), (name,))
        group = tuple(one for one in present if CHANNEL_VARIABLES[one] in pair)
        if group not in groups:
            groups.append(group)
    return groups


@dataclass(frozen=True, eq=False)
class _AxesOnRaster:
    """A layer on a grid of axes beside a raster.

    Attributes
    ----------
    lines : Rows and columns of both, in steps of the raster.
    located : Their crossings in the grid of the layer, row by row.
    whole : Cells of the raster all over in the box of the layer, (Y - 1, X - 1).
    """

    layer: GridLayer
    lines: tuple[FloatArray, FloatArray]
    located: GridLocation
    whole: BoolArray

    @classmethod
    def of(cls, layer: GridLayer, grid: RectilinearGrid, fields: GridFields) -> _AxesOnRaster:
        _, rows, columns, _ = fields.values.shape
        turned = np.asarray(grid.lon, float)[:, None] + 360.0 * np.arange(-2.0, 3.0)
        lat_lines = (np.asarray(grid.lat, float) - fields.lat0) / fields.dlat
        lon_lines = (turned.ravel() - fields.lon0) / fields.dlon
        row, lat_places = lines_with_raster(lat_lines, rows)
        column, lon_places = lines_with_raster(lon_lines, columns)
        lat_at, lon_at = (
            fields.lat0 + fields.dlat * lat_places,
            fields.lon0 + fields.dlon * lon_places,
        )
        lat, lon = np.meshgrid(lat_at, lon_at, indexing="ij")
        found = grid.locate(lat.ravel(), lon.ravel())
        weight = np.where(found.weight < 2.0 * ON_LINE, 0.0, found.weight)
        weight /= weight.sum(axis=1, keepdims=True)
        area = layer.area
        lat_nodes = fields.lat0 + fields.dlat * np.arange(rows)
        lon_nodes = fields.lon0 + fields.dlon * np.arange(columns)
        inside_lat = (lat_nodes >= area.south - 1e-9) & (lat_nodes <= area.north + 1e-9)
        inside_lon = grid.wraps | ((lon_nodes - area.west) % 360.0 <= area.width + 1e-9)
        whole = np.outer(inside_lat[1:] & inside_lat[:-1], inside_lon[1:] & inside_lon[:-1])
        return cls(layer, (row, column), GridLocation(found.corner, weight), whole)

    @property
    def size(self) -> int:
        """Number of places that are compared."""
        return len(self.located.corner)

    @property
    def is_on_lines(self) -> bool:
        """Whether all lines of the layer are among those of the raster."""
        return all(bool((line == np.round(line)).all()) for line in self.lines)

    def compare(
        self, names: Sequence[str], raster: Sequence[Float32Array], times: FloatArray
    ) -> _Comparison:
        """Compare the values of variables with the channels of the raster, (T, Y, X) each."""
        found = self.layer.series_at(list(names), times, self.located)
        shape = times.size, *(line.size for line in self.lines)
        known, apart, size = np.ones(shape, bool), np.zeros(shape), np.zeros(shape)
        for name, channel in zip(names, raster):
            own = np.asarray(found[name]).T.reshape(shape)
            known &= np.isfinite(own)
            apart = np.hypot(apart, own - values_on_lines(channel, self.lines))
            size = np.hypot(size, own)
        # where the raster is unknown in spite of known data nothing can be said
        apart = np.where(known, np.where(np.isfinite(apart), apart, np.inf), 0.0)
        parts = [places_of_raster(line) for line in self.lines]
        return _Comparison(
            combined_in_cells(known, parts, np.logical_or),
            combined_in_cells(known, parts, np.logical_and),
            combined_in_cells(apart, parts, np.maximum),
            combined_in_cells(np.where(known, size, 0.0), parts, np.maximum),
        )


class _Comparison(NamedTuple):
    """What holds in the cells of a raster at some times, (T, Y - 1, X - 1).

    Attributes
    ----------
    somewhere, everywhere : Whether the data are known somewhere, and everywhere.
    apart : How far they are from the raster at most.
    size : Their greatest length, of several variables as of a vector.
    """

    somewhere: BoolArray
    everywhere: BoolArray
    apart: FloatArray
    size: FloatArray


@dataclass(frozen=True, eq=False)
class _TrianglesOnRaster:
    """A layer on triangles beside a raster.

    Attributes
    ----------
    used : Grid points at corners of triangles.
    corners : Their places in ``used``, (M, 3).
    order, starts, cells : Triangles by cell: the boxes of ``order[starts[k]:starts[k + 1]]`` meet
        the cell with the flat number ``cells[k]``.
    shape : Rows and columns of cells.
    """

    layer: GridLayer
    used: IntArray
    corners: IntArray
    order: IntArray
    starts: IntArray
    cells: IntArray
    shape: tuple[int, int]
    is_on_lines = False

    @classmethod
    def of(
        cls, layer: GridLayer, grid: TriangleGrid, fields: GridFields
    ) -> _TrianglesOnRaster | None:
        _, rows, columns, _ = fields.values.shape
        lat, lon = np.asarray(grid.lat, float), np.asarray(grid.lon, float)
        if np.nanmax(np.abs(lat)) > _POLAR:
            return None
        corners = np.asarray(grid.triangles)
        corners = corners[np.isfinite(lat[corners]).all(axis=1)]
        row = (lat[corners] - fields.lat0) / fields.dlat
        first = (lon[corners[:, :1]] - fields.lon0 + 180.0) % 360.0 - 180.0
        column = (
            first + (lon[corners] - lon[corners[:, :1]] + 180.0) % 360.0 - 180.0
        ) / fields.dlon
        pairs: list[tuple[IntArray, IntArray]] = []
        for turn in (-360.0, 0.0, 360.0):
            ends = np.stack([row, column + turn / fields.dlon])
            low = np.maximum(np.floor(ends.min(axis=2)).astype(int), 0)
            high = np.floor(ends.max(axis=2)).astype(int)
            high = np.minimum(high, [[rows - 2], [columns - 2]])
            one = np.flatnonzero((low <= high).all(axis=0))
            number, cell = cells_of_boxes(low[:, one], high[:, one], columns - 1)
            pairs.append((one[number], cell))
        triangle, cell = (np.concatenate(part) for part in zip(*pairs))
        order = np.argsort(cell, kind="stable")
        cells, starts = np.unique(cell[order], return_index=True)
        used, places = np.unique(corners, return_inverse=True)
        return cls(
            layer, used, places.reshape(corners.shape), triangle[order], starts, cells,
            (rows - 1, columns - 1),
        )  # fmt: skip

    @property
    def size(self) -> int:
        """Number of places that are compared."""
        return max(self.used.size, self.order.size)

    @property
    def whole(self) -> BoolArray:
        """A mesh may have holes: no cell is all over in it, as far as is known."""
        return np.zeros(self.shape, bool)

    def compare(
        self, names: Sequence[str], raster: Sequence[Float32Array], times: FloatArray
    ) -> _Comparison:
        """Compare the values of variables with the channels of the raster, (T, Y, X) each."""
        located = GridLocation(self.used[:, None], np.ones((self.used.size, 1)))
        found = self.layer.series_at(list(names), times, located)
        known: BoolArray = np.ones((times.size, self.order.size), bool)
        apart, size = np.zeros((2, times.size, self.order.size))
        cell = np.repeat(self.cells, np.diff(np.append(self.starts, self.order.size)))
        j, i = np.divmod(cell, self.shape[1])
        for name, channel in zip(names, raster):
            corner = np.asarray(found[name]).T[:, self.corners]
            known &= np.all(np.isfinite(corner), axis=2)[:, self.order]
            low, high = corner.min(axis=2)[:, self.order], corner.max(axis=2)[:, self.order]
            around = np.stack([channel[:, j + up, i + side] for up in (0, 1) for side in (0, 1)])
            farthest = np.maximum(high - around.min(axis=0), around.max(axis=0) - low)
            apart = np.hypot(apart, farthest)
            size = np.hypot(size, np.maximum(np.abs(low), np.abs(high)))
        apart = np.where(known, np.where(np.isfinite(apart), apart, np.inf), 0.0)
        cells = times.size, self.shape[0] * self.shape[1]
        somewhere, most, greatest = (np.zeros(cells, kind) for kind in (bool, float, float))
        if self.cells.size:
            somewhere[:, self.cells] = np.maximum.reduceat(known, self.starts, axis=1)
            most[:, self.cells] = np.maximum.reduceat(apart, self.starts, axis=1)
            size = np.where(known, size, 0.0)
            greatest[:, self.cells] = np.maximum.reduceat(size, self.starts, axis=1)
        wide = times.size, *self.shape
        nowhere = np.zeros(wide, bool)
        return _Comparison(
            somewhere.reshape(wide), nowhere, most.reshape(wide), greatest.reshape(wide)
        )


@dataclass(frozen=True, eq=False)
class _UniformOnRaster:
    """A layer that is the same everywhere, where no layer before it is known."""

    layer: FormulaLayer
    shape: tuple[int, int]
    is_on_lines = True
    size = 0

    @property
    def whole(self) -> BoolArray:
        """All cells."""
        return np.ones(self.shape, bool)

    def compare(
        self, names: Sequence[str], raster: Sequence[Float32Array], times: FloatArray
    ) -> _Comparison:
        """Compare the values of variables with the channels of the raster, (T, Y, X) each."""
        everywhere = np.ones((times.size, *self.shape), bool)
        own = self.layer.series(names, times[:1], np.zeros(1), np.zeros(1))
        apart, size = np.zeros(raster[0].shape), 0.0
        for name, channel in zip(names, raster):
            apart = np.hypot(apart, float(own[name][0, 0]) - channel)
            size = math.hypot(size, float(own[name][0, 0]))
        # at the corners of each cell
        sides = slice(None, -1), slice(1, None)
        most = np.maximum.reduce([apart[:, up, right] for up in sides for right in sides])
        most = np.where(np.isfinite(most), most, np.inf)
        return _Comparison(everywhere, everywhere, most, np.full(most.shape, size))


_OnRaster: TypeAlias = _AxesOnRaster | _TrianglesOnRaster | _UniformOnRaster


def _placed(layer: Layer, fields: GridFields) -> _OnRaster | None:
    if isinstance(layer, FormulaLayer) and "values" in layer.facts:
        return _UniformOnRaster(layer, (fields.values.shape[1] - 1, fields.values.shape[2] - 1))
    if isinstance(layer, GridLayer) and isinstance(layer.grid, RectilinearGrid):
        return _AxesOnRaster.of(layer, layer.grid, fields)
    if isinstance(layer, GridLayer) and isinstance(layer.grid, TriangleGrid):
        return _TrianglesOnRaster.of(layer, layer.grid, fields)
    return None


def _of_group(
    group: tuple[int, ...],
    layers: Sequence[_OnRaster],
    fields: GridFields,
) -> tuple[FloatArray, float]:
    """Return how far the channels of a group are off in each cell at most, and their size."""
    names = [CHANNEL_VARIABLES[channel] for channel in group]
    channels = [fields.values[..., fields.channel_index[channel]] for channel in group]  # views
    unknown = np.isnan(np.sum(channels, axis=0))
    for channel in channels:
        _fill_unknown(channel, unknown)
    count, rows, columns, _ = fields.values.shape
    most, reached = (np.zeros((rows - 1, columns - 1), kind) for kind in (float, bool))
    left = np.ones((count, rows - 1, columns - 1), bool)  # cells that no layer before covers
    size = 0.0
    for one in layers:
        covered = np.zeros(left.shape, bool)
        step = max(1, _VALUES_AT_A_TIME // max(1, one.size))
        for begin in range(0, count, step):
            part = slice(begin, min(begin + step, count))
            found = one.compare(names, [values[part] for values in channels], fields.times[part])
            counts = left[part] & found.somewhere
            np.maximum(most, np.where(counts, found.apart, 0.0).max(axis=0), out=most)
            reached |= counts.any(axis=0)
            size = max(size, float(np.max(found.size, where=counts, initial=0.0)))
            covered[part] = np.logical_and(found.everywhere, one.whole)
        if isinstance(one, _AxesOnRaster) and not np.any(one.layer.axis.gaps):
            # another layer holds between a time that is known and one that is not
            before, after = covered[:-1].copy(), covered[1:].copy()
            covered[1:] &= before
            covered[:-1] &= after
            left &= ~covered
    needed = np.zeros((rows, columns), bool)
    for up in (0, 1):
        for side in (0, 1):
            needed[up : up + rows - 1, side : side + columns - 1] |= reached
    for channel in channels:
        channel[unknown & ~needed] = np.nan
    return most, size


def _fill_unknown(values: Float32Array, unknown: BoolArray) -> None:
    """Fill a channel (T, Y, X) from the nearest known node, where one is known at that time."""
    from scipy.ndimage import distance_transform_edt

    for step, gaps in enumerate(unknown):
        if not gaps.any() or gaps.all():
            continue
        if step == 0 or not np.array_equal(gaps, unknown[step - 1]):
            nearest = distance_transform_edt(gaps, return_distances=False, return_indices=True)
        values[step] = values[step][tuple(nearest)]
