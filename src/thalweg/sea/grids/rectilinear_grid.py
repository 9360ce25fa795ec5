"""Grids with one axis of latitude and one of longitude."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from thalweg.core.bounding_box import EDGE_TOLERANCE, BoundingBox
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.sea.grids.grid_protocol import GridLocation
from thalweg.sea.triangle_mesh import Mesh


@dataclass(frozen=True, eq=False)
class RectilinearGrid:
    """A grid of latitude and longitude axes; bilinear in each cell.

    Attributes
    ----------
    lat : Strictly increasing or decreasing [deg], (Y,).
    lon : Strictly increasing [deg], unwrapped (may pass 180 or 360), (X,).
    """

    lat: FloatArray
    lon: FloatArray

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.lat.size, self.lon.size

    @cached_property
    def wraps(self) -> bool:
        """Whether the longitude axis covers the whole circle."""
        if self.lon.size < 3:
            return False
        step = float(np.median(np.diff(self.lon)))
        return bool(abs(self.lon[-1] + step - self.lon[0] - 360.0) < 0.5 * step)

    @cached_property
    def area(self) -> BoundingBox:
        """The box from the first to the last row and column; all longitudes if it wraps."""
        south, north = float(self.lat.min()), float(self.lat.max())
        if self.wraps:
            return BoundingBox(south, north, -180.0, 180.0)
        return BoundingBox(south, north, float(self.lon[0]), float(self.lon[-1]))

    @property
    def spacing(self) -> float:
        """Median spacing of latitudes [deg]."""
        return float(np.median(np.abs(np.diff(self.lat)))) if self.lat.size > 1 else 0.0

    def mesh(self) -> Mesh | None:
        """Return None: a grid of axes is not a mesh."""
        return None

    def locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        """Return the four corners of each point's cell and the bilinear weights."""
        row, fy, inside_y = _locate_on_axis(self._rows, lat)
        if self.lat.size > 1 and self.lat[1] < self.lat[0]:
            row, step = self.lat.size - 1 - row, -1
        else:
            step = 1
        column, fx, inside_x = _locate_on_axis(
            self._columns, (lon - self._west) % 360.0 + self._west
        )
        below = np.clip(row + step, 0, self.lat.size - 1)
        right = (
            (column + 1) % self.lon.size
            if self.wraps
            else np.minimum(column + 1, self.lon.size - 1)
        )
        columns = self.lon.size
        index = np.empty((lat.size, 4), np.int64)
        index[:, 0] = row * columns + column
        index[:, 1] = row * columns + right
        index[:, 2] = below * columns + column
        index[:, 3] = below * columns + right
        weight = np.empty((lat.size, 4))
        weight[:, 0] = (1.0 - fy) * (1.0 - fx)
        weight[:, 1] = (1.0 - fy) * fx
        weight[:, 2] = fy * (1.0 - fx)
        weight[:, 3] = fy * fx
        index[~(inside_y & inside_x), 0] = -1
        return GridLocation(index, weight)

    @cached_property
    def _rows(self) -> FloatArray:
        return np.sort(self.lat)

    @cached_property
    def _columns(self) -> FloatArray:
        return np.append(self.lon, self.lon[0] + 360.0) if self.wraps else self.lon

    @property
    def _west(self) -> float:
        return float(self.lon[0]) - EDGE_TOLERANCE


def _locate_on_axis(axis: FloatArray, value: FloatArray) -> tuple[IntArray, FloatArray, BoolArray]:
    """Return for each value the index before it on an increasing axis, the fraction of the step to
    the next index, and whether it is inside.
    """
    inside = (value >= axis[0] - EDGE_TOLERANCE) & (value <= axis[-1] + EDGE_TOLERANCE)
    if axis.size == 1:
        return np.zeros(value.shape, np.int64), np.zeros(value.shape), inside
    place = np.clip(np.searchsorted(axis, value, side="right") - 1, 0, axis.size - 2)
    fraction = (value - axis[place]) / (axis[place + 1] - axis[place])
    return place, np.where(inside, np.clip(fraction, 0.0, 1.0), 0.0), inside
