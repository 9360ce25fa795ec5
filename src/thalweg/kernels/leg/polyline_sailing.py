"""Sailing many polylines through a frozen raster of the sea: times of passage."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import CURRENT, DEPTH, OK, WAVE_HEIGHT, WIND_SPEED
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.great_circle import great_circle, great_circle_point
from thalweg.kernels.leg.point_speed import point_speed_with_axes
from thalweg.kernels.leg.raster_sampling import interpolate_raster
from thalweg.kernels.leg.table_lookup import axes_needed


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
        Departure of each polyline [s].
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
    """Results of sailing `PolylineArrays`.

    Attributes
    ----------
    arrive : float64[P]
        Arrival at every point [s]; +inf from the first leg that cannot be sailed.
    leave : float64[P]
        Departure from every point [s]; not set at last points and from a leg that cannot be sailed.
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
def _sail_leg(lines, point, stop, t, raster, table, limits, needs, sample, state):
    """Sail at most ``stop`` pieces of the leg that starts at a point; return (arrival, status).

    ``state`` carries (time step of the raster, slowness found last, length sailed).
    """
    start, tangent, arc = great_circle(
        lines.lat[point], lines.lon[point], lines.lat[point + 1], lines.lon[point + 1]
    )
    if arc == 0.0:
        return t, OK
    count = lines.pieces[point]
    step = arc / count
    turn_sine, turn_cosine = math.sin(step), math.cos(step)
    s, c = math.sin(0.5 * step), math.cos(0.5 * step)
    for _ in range(min(count, stop)):
        lat, lon, east, north, scale = great_circle_point(start, tangent, s, c)
        s, c = s * turn_cosine + c * turn_sine, c * turn_cosine - s * turn_sine
        length = scale * step
        at = t + 0.5 * length * state[1]
        status, found = interpolate_raster(raster, at, lat, lon, int(state[0]), sample)
        state[0] = found
        if status != OK:
            return math.inf, status
        speed, status = point_speed_with_axes(
            sample,
            raster.channel_index,
            east,
            north,
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
    lines : PolylineArrays
    raster : RasterArrays
    table : TableArrays
        Speed through water.
    limits : float64[LIMITS]
        See `thalweg.kernels.leg.point_speed.point_speed`.
    waiting_parameters : float64[3]
        Longest wait at a point for the next leg to open, time between two trials, and tolerance of
        the time of opening [s]. Zeros: the ship does not wait unless ``lines.leave`` says so.
    out : PolylineResults
        Filled.
    sample : float64[CHANNELS]
    state : float64[3]
        Work space, zeros.

    Notes
    -----
    Legs are great circles, see `thalweg.kernels.leg.great_circle`. Time is integrated by the
    midpoint rule; the middle of a piece is reached with the slowness of the piece before (order 2).
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
