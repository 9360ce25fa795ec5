"""A frozen raster of the sea, interpolated linearly in time and place."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import NO_DATA, OK, OUTSIDE_PERIOD
from thalweg.kernels.compilation.decorators import inlined


class RasterArrays(NamedTuple):
    """A frozen raster of the sea as kernels see it.

    Attributes
    ----------
    times : float64[T]
        Strictly increasing [s].
    corner : float64[4]
        ``lat0, dlat, lon0, dlon`` [deg].
    values : float32[T, Y, X, K]
        NaN is unknown.
    channel_index : int64[CHANNELS]
        Place in the last axis of each channel, -1 if absent.
    channels : int64[K]
        Channel of each place in the last axis.
    """

    times: np.ndarray
    corner: np.ndarray
    values: np.ndarray
    channel_index: np.ndarray
    channels: np.ndarray


@inlined
def interpolate_raster(raster, t, lat, lon, step, sample):
    """Fill ``sample`` by channel, linear in time and place; return (status, time step found).

    ``step`` is the time step found last, where the search begins. Entries of channels that the
    raster does not have stay as they are.
    """
    times = raster.times
    last = times.shape[0] - 2
    if not (t >= times[0] and t <= times[last + 1]):
        return OUTSIDE_PERIOD, step
    while step < last and t >= times[step + 1]:
        step += 1
    while step > 0 and t < times[step]:
        step -= 1
    ft = (t - times[step]) / (times[step + 1] - times[step])
    corner, values, channels = raster.corner, raster.values, raster.channels
    y = (lat - corner[0]) / corner[1]
    east = lon - corner[2] + 1e-9
    x = (east - 360.0 * math.floor(east / 360.0) - 1e-9) / corner[3]
    top, right = values.shape[1] - 2, values.shape[2] - 2
    if not (y >= -1e-6 and x >= -1e-6 and y <= top + 1 + 1e-6 and x <= right + 1 + 1e-6):
        return NO_DATA, step
    row, column = min(max(int(y), 0), top), min(max(int(x), 0), right)
    fy, fx = min(max(y - row, 0.0), 1.0), min(max(x - column, 0.0), 1.0)
    count = channels.shape[0]
    for k in range(count):
        sample[channels[k]] = 0.0
    for later in range(2):
        for up in range(2):
            part = (ft if later else 1.0 - ft) * (fy if up else 1.0 - fy)
            if part == 0.0:
                continue
            for side in range(2):
                weight = part * (fx if side else 1.0 - fx)
                if weight != 0.0:
                    for k in range(count):
                        value = values[step + later, row + up, column + side, k]
                        sample[channels[k]] += weight * value
    return OK, step
