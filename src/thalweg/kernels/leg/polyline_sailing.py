"""Sailing polylines quickly through a frozen raster of the sea: many at once, arrays only."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    CHANNEL_COUNT,
    CURRENT,
    DEPTH,
    NO_DATA,
    OK,
    OUTSIDE_PERIOD,
    WAVE_HEIGHT,
    WIND_SPEED,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.point_speed import point_speed_with_axes
from thalweg.kernels.leg.table_lookup import axes_needed

_MAJOR = 6378137.0  # WGS 84
_ECCENTRICITY2 = 6.69437999014e-3
_RADIANS = math.pi / 180.0


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
        Channel to place in the last axis, -1 if absent.
    """

    times: np.ndarray
    corner: np.ndarray
    values: np.ndarray
    channel_index: np.ndarray


class PolylineArrays(NamedTuple):
    """Polylines to sail, one after another in flat arrays.

    Attributes
    ----------
    first : int64[L + 1]
        Where each polyline starts among the points.
    lat, lon : float64[P]
        Points [deg].
    leave : float64[P]
        The ship leaves a point no earlier than this [s]; -inf where it does not wait.
    setting, pieces : int64[P]
        Of the leg that starts at a point: speed setting, number of pieces (at least 1); those of
        the last points are not read.
    charted : float64[P]
        Of the leg that starts at a point: least charted depth [m below datum], +inf if not checked.
    depart : float64[L]
        When each polyline is begun [s].
    """

    first: np.ndarray
    lat: np.ndarray
    lon: np.ndarray
    leave: np.ndarray
    setting: np.ndarray
    pieces: np.ndarray
    charted: np.ndarray
    depart: np.ndarray


class PolylineResults(NamedTuple):
    """What comes of sailing `PolylineArrays`.

    Attributes
    ----------
    arrive : float64[P]
        Arrival at every point [s]; +inf from the first leg that cannot be sailed.
    leave : float64[P]
        When every point is left [s]; not set at last points and from a leg that cannot be sailed.
    length : float64[L]
        Length sailed [m].
    status : int64[L]
        `OK`, or why a polyline cannot be sailed.
    """

    arrive: np.ndarray
    leave: np.ndarray
    length: np.ndarray
    status: np.ndarray


@inlined
def _interpolate_raster(raster, t, lat, lon, step, sample):
    """Fill ``sample`` by channel, linear in time and place; return (status, time step found)."""
    times = raster.times
    last = times.shape[0] - 2
    if not (t >= times[0] and t <= times[last + 1]):
        return OUTSIDE_PERIOD, step
    while step < last and t >= times[step + 1]:
        step += 1
    while step > 0 and t < times[step]:
        step -= 1
    ft = (t - times[step]) / (times[step + 1] - times[step])
    corner, values = raster.corner, raster.values
    y = (lat - corner[0]) / corner[1]
    x = ((lon - corner[2] + 1e-9) % 360.0 - 1e-9) / corner[3]
    top, right = values.shape[1] - 2, values.shape[2] - 2
    if not (y >= -1e-6 and x >= -1e-6 and y <= top + 1 + 1e-6 and x <= right + 1 + 1e-6):
        return NO_DATA, step
    row, column = min(max(int(y), 0), top), min(max(int(x), 0), right)
    fy, fx = min(max(y - row, 0.0), 1.0), min(max(x - column, 0.0), 1.0)
    sample[:] = 0.0
    for corner_id in range(8):
        up, right_side, later = corner_id & 1, (corner_id >> 1) & 1, corner_id >> 2
        weight = (fy if up else 1.0 - fy) * (fx if right_side else 1.0 - fx)
        weight *= ft if later else 1.0 - ft
        if weight == 0.0:
            continue
        for channel in range(CHANNEL_COUNT):
            k = raster.channel_index[channel]
            if k >= 0:
                value = values[step + later, row + up, column + right_side, k]
                sample[channel] += weight * value
    return OK, step


@inlined
def _sail_leg(lines, point, stop, t, raster, table, limits, needs, sample, state):
    """Sail at most ``stop`` pieces of the leg that starts at a point; return (arrival, status).

    ``state`` carries (time step of the raster, slowness met last, length sailed).
    """
    lat1, lat2 = lines.lat[point] * _RADIANS, lines.lat[point + 1] * _RADIANS
    lon1, lon2 = lines.lon[point] * _RADIANS, lines.lon[point + 1] * _RADIANS
    ax, ay, az = math.cos(lat1) * math.cos(lon1), math.cos(lat1) * math.sin(lon1), math.sin(lat1)
    bx, by, bz = math.cos(lat2) * math.cos(lon2), math.cos(lat2) * math.sin(lon2), math.sin(lat2)
    cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    sine = math.sqrt(cx * cx + cy * cy + cz * cz)
    if sine < 1e-12:
        return t, OK
    arc = math.atan2(sine, ax * bx + ay * by + az * bz)
    # (fx, fy, fz): unit tangent at the start, so that a point is cos(w) a + sin(w) f
    fx, fy, fz = (cy * az - cz * ay) / sine, (cz * ax - cx * az) / sine, (cx * ay - cy * ax) / sine
    count = lines.pieces[point]
    step = arc / count
    turn_sine, turn_cosine = math.sin(step), math.cos(step)
    s, c = math.sin(0.5 * step), math.cos(0.5 * step)
    for _ in range(min(count, stop)):
        px, py, pz = c * ax + s * fx, c * ay + s * fy, c * az + s * fz
        dx, dy, dz = c * fx - s * ax, c * fy - s * ay, c * fz - s * az
        s, c = s * turn_cosine + c * turn_sine, c * turn_cosine - s * turn_sine
        level = math.sqrt(px * px + py * py)
        east = (px * dy - py * dx) / level
        north = dz * level - pz * (px * dx + py * dy) / level
        w2 = 1.0 / (1.0 - _ECCENTRICITY2 * pz * pz)
        prime = _MAJOR * math.sqrt(w2)  # radius of curvature in the prime vertical
        east, north = east * prime, north * prime * (1.0 - _ECCENTRICITY2) * w2
        scale = math.sqrt(east * east + north * north)
        length = scale * step
        at = t + 0.5 * length * state[1]
        lat, lon = math.atan2(pz, level) / _RADIANS, math.atan2(py, px) / _RADIANS
        status, found = _interpolate_raster(raster, at, lat, lon, int(state[0]), sample)
        state[0] = found
        if status != OK:
            return math.inf, status
        speed, status = point_speed_with_axes(
            sample,
            raster.channel_index,
            east / scale,
            north / scale,
            table,
            lines.setting[point],
            lines.charted[point],
            limits,
            needs,
        )
        if status != OK:
            return math.inf, status
        state[1] = 1.0 / speed
        state[2] += length
        t += length / speed
    return t, OK


@inlined
def _waiting_may_help(status):
    """Return whether waiting could help."""
    return status in (DEPTH, WAVE_HEIGHT, WIND_SPEED, CURRENT)


@allocation_free
def sail_polylines(lines, raster, table, limits, waiting_parameters, out, sample, state):
    """Sail many polylines through a frozen sea.

    Parameters
    ----------
    lines : Lines
    raster : RasterArrays
    table : TableArrays
        Speed through water.
    limits : float64[LIMITS]
        See `thalweg.kernels.leg.point_speed.point_speed`.
    waiting_parameters : float64[3]
        How long the ship waits at most at a point for the next leg to open, how long between two
        looks, and how exactly the opening is found [s]; zero: it does not wait of itself.
    out : Passages
        Filled.
    sample : float64[CHANNELS]
    state : float64[3]
        Room to work in, zeros.

    Notes
    -----
    Legs are great circles of the sphere of geographic latitudes, measured on WGS 84 with the local
    radii of curvature; they differ in length from geodesics by less than 1e-6. Time goes by the
    midpoint rule, the middle of a piece reached with the slowness met before (order 2).
    """
    needs = axes_needed(table)
    for line in range(lines.first.shape[0] - 1):
        start, end = lines.first[line], lines.first[line + 1]
        t = lines.depart[line]
        state[1], sailed = 0.0, 0.0
        out.status[line] = OK
        out.arrive[start] = t
        for point in range(start, end - 1):
            t = max(t, lines.leave[point])
            pieces = lines.pieces[point]
            low, high, tried = t, -math.inf, t
            after, length, status = math.inf, sailed, OK
            while True:  # sail; if the leg is closed wait for it to open, then find the moment
                reached = math.inf
                for stop in (1, pieces):  # a first piece is tried, for a first slowness
                    if stop == pieces or state[1] == 0.0:
                        state[2] = sailed
                        reached, status = _sail_leg(
                            lines, point, stop, tried, raster, table, limits, needs, sample, state
                        )
                if status == OK:
                    high, after, length = tried, reached, state[2]
                else:
                    low = tried
                if high - low <= waiting_parameters[2] and high >= t:
                    break
                if high >= t:
                    tried = 0.5 * (low + high)
                    continue
                tried = low + waiting_parameters[1]
                if (
                    tried - t > waiting_parameters[0]
                    or not _waiting_may_help(status)
                    or waiting_parameters[0] == 0.0
                ):
                    break
            t, sailed = after, length
            out.leave[point], out.arrive[point + 1] = high, after
            if after == math.inf:
                out.status[line] = status
                out.arrive[point + 1 : end] = math.inf
                break
        out.length[line] = sailed
