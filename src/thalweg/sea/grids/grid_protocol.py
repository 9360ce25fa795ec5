"""The protocol of a grid: it locates points between its own points, with weights.

A grid has ``shape`` (rows, columns) of points that hold values (a mesh has one row). ``locate``
returns the flat indices of the grid points around each given point, and their weights.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import FloatArray, IntArray
from thalweg.sea.triangle_mesh import Mesh


class GridLocation(NamedTuple):
    """Corners around points: flat indices (N, C), -1 first where outside; weights (N, C)."""

    corner: IntArray
    weight: FloatArray


class Grid(Protocol):
    """A grid of points that hold values."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of grid points."""
        ...

    @property
    def wraps(self) -> bool:
        """Whether the first column follows the last one, around the globe."""
        ...

    @property
    def area(self) -> BoundingBox:
        """The box around the grid."""
        ...

    @property
    def spacing(self) -> float:
        """Typical spacing [deg]."""
        ...

    def locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        """Return corners and weights for points [deg]."""
        ...

    def mesh(self) -> Mesh | None:
        """Return nodes and triangles, if the grid is a mesh."""
        ...


def grid_positions(grid: Any) -> tuple[FloatArray, FloatArray]:
    """Return latitude and longitude [deg] of all points of a grid, in the order of its values.

    Parameters
    ----------
    grid : A rectilinear grid or a grid of triangles.

    Returns
    -------
    lat, lon : float64 array (rows * columns,)
    """
    rows, columns = grid.shape
    lat, lon = np.asarray(grid.lat, float), np.asarray(grid.lon, float)
    if lat.size == rows and lon.size == columns:
        lat, lon = np.broadcast_arrays(lat[:, None], lon[None, :])
    return np.ascontiguousarray(lat).ravel(), np.ascontiguousarray(lon).ravel()
