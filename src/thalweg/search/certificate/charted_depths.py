"""The greatest charted depth in each cell of a mesh: what no ship passes for want of water."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from thalweg.chart.depth.depth_grids import DepthGrid
from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, Float32Array, FloatArray, IntArray

if TYPE_CHECKING:
    from thalweg.chart.depth.depth_layers import DepthLayers

_EDGE = 1e-6  # of the spacing of soundings


def greatest_depths(depths: DepthLayers, lat: FloatArray, lon: FloatArray) -> Float32Array:
    """Return the greatest charted depth in each cell of a mesh [m].

    Depth is bilinear between soundings, so it is nowhere greater than at one of those round a cell.
    A layer counts where it is known, else the next one. Ships of which depth is checked keep out of
    water whose depth no layer knows.

    Parameters
    ----------
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg], ascending; longitudes without jumps.

    Returns
    -------
    float32 array (Y - 1, X - 1) : -inf where no depth is known, +inf where a function gives it.
    """
    shape = lat.size - 1, lon.size - 1
    greatest, left = np.full(shape, -np.inf, np.float32), np.ones(shape, bool)
    box = float(lat[0]), float(lat[-1]), float(lon[0]), float(lon[-1])
    for number, layer in enumerate(depths.layers):
        if not left.any():
            break
        if not isinstance(layer, DepthGrid):
            return np.where(left, np.float32(np.inf), greatest)
        try:
            grid = depths.arrays(box, number)
        except InputError:  # too many soundings to hold
            return np.where(left, np.float32(np.inf), greatest)
        rows, columns = grid.shape[0].tolist()
        if rows < 2 or columns < 2:
            continue
        values = grid.values[: rows * columns].reshape(rows, columns)
        first_lat, lat_step, first_lon, lon_step = grid.grid[0].tolist()
        y = (lat - first_lat) / lat_step
        east = (lon[0] - first_lon) % 360.0
        if east > (columns - 1) * lon_step:
            east -= 360.0
        x = (east + lon - lon[0]) / lon_step
        most, known = _greatest_round_cells(values, y, x)
        greatest = np.where(left, np.fmax(greatest, most), greatest)
        left &= ~known
    return greatest


def _greatest_round_cells(
    values: Float32Array, y: FloatArray, x: FloatArray
) -> tuple[Float32Array, BoolArray]:
    """Return the greatest known sounding round each cell (-inf: none), and if all are known.

    Parameters
    ----------
    values : Soundings (rows, columns), NaN where unknown.
    y, x : Rows and columns of the nodes of the mesh.
    """
    rows, columns = values.shape
    top, side = _windows(y, rows), _windows(x, columns)
    filled = np.where(np.isnan(values), np.float32(-np.inf), values)
    most = _over_windows(np.maximum, filled, top.ends, side.ends)
    gaps = _over_windows(np.logical_or, np.isnan(values), top.ends, side.ends)
    inside = top.inside[:, None] & side.inside[None, :]
    touched = top.touched[:, None] & side.touched[None, :]
    return np.where(touched, most, np.float32(-np.inf)), inside & ~gaps


class _Windows(NamedTuple):
    """The soundings round each cell of a mesh along one axis of a grid.

    Attributes
    ----------
    ends : First sounding and one after the last in turn, as `numpy.ufunc.reduceat` takes them.
    inside, touched : Whether the grid has all of them, or some.
    """

    ends: IntArray
    inside: BoolArray
    touched: BoolArray


def _windows(place: FloatArray, count: int) -> _Windows:
    """Return the windows of the cells between places of nodes, in steps of the grid."""
    first, last = np.floor(place[:-1] + _EDGE), np.ceil(place[1:] - _EDGE)
    begin = np.clip(first, 0, count - 1).astype(np.int64)
    end = np.maximum(np.clip(last, 0, count - 1).astype(np.int64), begin) + 1
    return _Windows(
        np.stack([begin, end], axis=1).ravel(),
        (first >= 0) & (last <= count - 1),
        (place[1:] >= -_EDGE) & (place[:-1] <= count - 1 + _EDGE),
    )


def _over_windows(
    of: np.ufunc, values: np.ndarray, rows: IntArray, columns: IntArray
) -> np.ndarray:
    """Return a ufunc over all windows of rows and columns (`_Windows.ends`)."""
    padded = np.pad(values, ((0, 1), (0, 1)), mode="edge")  # ends may be one after the last
    by_rows = of.reduceat(padded, rows, axis=0)[::2]
    return np.asarray(of.reduceat(by_rows, columns, axis=1)[:, ::2])
