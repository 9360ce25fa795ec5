"""Charted depth on grids of soundings, by priority; compiled.

A leg is sampled no farther apart than half a grid step, and each sample takes the least of the
four soundings round it: bilinear depth is never below them, so the answer errs to the shallow
side. Where a step passes into the cell across a corner, both adjacent cells are considered too.
"""

from math import ceil, cos, floor, pi, sqrt
from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.cube_sphere import latitude_longitude, unit_vector


class DepthArrays(NamedTuple):
    """Regular grids, first the one that counts most; empty when the chart has no depth.

    Attributes
    ----------
    grid : float64[L, 4]
        First latitude, step, first longitude, step [deg] of each layer.
    shape : int64[L, 2]
        Rows and columns.
    offset : int64[L]
        Where each layer begins in ``values``.
    values : float32[:]
        Depth [m below datum, positive down], rows from the south; NaN unknown.
    """

    grid: np.ndarray
    shape: np.ndarray
    offset: np.ndarray
    values: np.ndarray


@kernel_only
def _layer_depth(depths, layer, lat, lon, least):
    """Return one layer's depth at a position: bilinear, or the least of the soundings round it."""
    rows, columns = depths.shape[layer, 0], depths.shape[layer, 1]
    y = (lat - depths.grid[layer, 0]) / depths.grid[layer, 1]
    step = depths.grid[layer, 3]
    x = (lon - depths.grid[layer, 2]) % 360.0 / step
    if x > columns - 1 and x * step > 360.0 - 1e-7:
        x = 0.0
    if y < 0.0 and y > -1e-6:
        y = 0.0
    if not (0.0 <= y <= rows - 1 + 1e-6 and x <= columns - 1 + 1e-6):
        return np.nan
    j, i = min(floor(y), rows - 2), min(floor(x), columns - 2)
    k = depths.offset[layer] + j * columns + i
    a, b = depths.values[k], depths.values[k + 1]
    c, d = depths.values[k + columns], depths.values[k + columns + 1]
    if least:
        total = a + b + c + d
        return min(min(a, b), min(c, d)) if total == total else np.nan
    s, t = x - i, y - j
    value = 0.0  # soundings without weight may be unknown
    if t < 1.0:
        value += (1.0 - t) * ((1.0 - s) * a if s == 0.0 else (1.0 - s) * a + s * b)
    if t > 0.0:
        value += t * ((1.0 - s) * c if s == 0.0 else (1.0 - s) * c + s * d)
    return value


@kernel_only
def depth_at_point(depths, lat, lon, least):
    """Return the depth [m] at a position [deg] from the first layer that knows it, else NaN."""
    for layer in range(len(depths.offset)):
        value = _layer_depth(depths, layer, lat, lon, least)
        if value == value:
            return value
    return np.nan


@kernel_only
def _finest_step(depths, lat):
    """Return the shortest grid step [rad] of all layers near a latitude."""
    finest = 1.0
    narrow = max(cos(lat * pi / 180.0), 0.05)
    for layer in range(len(depths.offset)):
        finest = min(finest, depths.grid[layer, 1], depths.grid[layer, 3] * narrow)
    return finest * pi / 180.0


@kernel_only
def _across_a_corner(depths, lat1, lon1, lat2, lon2):
    """Return whether a step shorter than a cell changes row and column of any layer."""
    for layer in range(len(depths.offset)):
        lat0, dlat = depths.grid[layer, 0], depths.grid[layer, 1]
        lon0, dlon = depths.grid[layer, 2], depths.grid[layer, 3]
        if floor((lat1 - lat0) / dlat) != floor((lat2 - lat0) / dlat) and floor(
            ((lon1 - lon0) % 360.0) / dlon
        ) != floor(((lon2 - lon0) % 360.0) / dlon):
            return True
    return False


@allocation_free
def least_depth(depths, lat1, lon1, lat2, lon2):
    """Return the least charted depth [m] on a leg [deg] below 1,000 km.

    Infinite when there are no layers; NaN when it is unknown anywhere on the leg.
    """
    if len(depths.offset) == 0:
        return np.inf
    ax, ay, az = unit_vector(lat1, lon1)
    bx, by, bz = unit_vector(lat2, lon2)
    length = sqrt((bx - ax) ** 2 + (by - ay) ** 2 + (bz - az) ** 2)
    steps = ceil(length / (0.5 * _finest_step(depths, max(abs(lat1), abs(lat2))))) + 1
    least = depth_at_point(depths, lat1, lon1, True)
    if least != least:
        return np.nan
    lat_before, lon_before = lat1, lon1
    for k in range(1, steps + 1):
        share = k / steps
        lat, lon = latitude_longitude(
            ax + share * (bx - ax), ay + share * (by - ay), az + share * (bz - az)
        )
        if k == steps:
            lat, lon = lat2, lon2
        value = depth_at_point(depths, lat, lon, True)
        if value != value:
            return np.nan
        least = min(least, value)
        if _across_a_corner(depths, lat_before, lon_before, lat, lon):
            one = depth_at_point(depths, lat_before, lon, True)
            other = depth_at_point(depths, lat, lon_before, True)
            if one != one or other != other:
                return np.nan
            least = min(least, min(one, other))
        lat_before, lon_before = lat, lon
    return least


@allocation_free
def least_depths(depths, lat1, lon1, lat2, lon2, depth):
    """Fill ``depth`` (float32) with the least charted depth of many legs [deg]."""
    for k in range(len(depth)):
        depth[k] = least_depth(depths, lat1[k], lon1[k], lat2[k], lon2[k])


@allocation_free
def depths_at_points(depths, lat, lon, least, depth):
    """Fill ``depth`` with the depth at many positions [deg]; see `depth_at_point`."""
    for k in range(len(depth)):
        depth[k] = depth_at_point(depths, lat[k], lon[k], least)
