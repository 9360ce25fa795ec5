"""Sailing many polylines through a frozen raster of the sea: times of passage."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import CURRENT, DEPTH, OK, SHIP_RANGE, WAVE_HEIGHT, WIND_SPEED
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.great_circle_sailing import (
    LENGTH,
    SLOWNESS,
    GreatCircleLeg,
    sail_great_circle_leg,
)
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
def _waiting_may_help(status):
    """Return whether waiting could help."""
    return status in (DEPTH, WAVE_HEIGHT, WIND_SPEED, CURRENT, SHIP_RANGE)


@allocation_free
def sail_polylines(lines, world, waiting_parameters, out, scratch):
    """Sail many polylines through a frozen sea.

    Parameters
    ----------
    lines : PolylineArrays
    world : ShipOnRaster
    waiting_parameters : float64[3]
        Longest wait at a point for the next leg to open, time between two trials, and tolerance of
        the time of opening [s]. Zeros: the ship does not wait unless ``lines.leave`` says so.
    out : PolylineResults
        Filled.
    scratch : float64[SCRATCH_SIZE]
        Work space, zeros.

    Notes
    -----
    Legs are sailed by `sail_great_circle_leg`.
    """
    needs = (axes_needed(world.table), 0)
    for line in range(lines.first.shape[0] - 1):
        start, end = lines.first[line], lines.first[line + 1]
        t = lines.depart[line]
        scratch[SLOWNESS], sailed = 0.0, 0.0
        out.status[line] = OK
        out.arrive[start] = t
        for point in range(start, end - 1):
            t = max(t, lines.leave[point])
            leg = GreatCircleLeg(
                (lines.lat[point], lines.lon[point]),
                (lines.lat[point + 1], lines.lon[point + 1]),
                lines.setting[point],
                lines.pieces[point],
                math.inf,
                lines.charted[point],
                False,
            )
            low, high, tried = t, -math.inf, t
            after, length, status = math.inf, sailed, OK
            while True:  # sail; if the leg is closed wait for it to open, then find the moment
                scratch[LENGTH] = sailed
                reached, status = sail_great_circle_leg(
                    world, None, needs, leg, None, tried, scratch
                )
                if status == OK:
                    high, after, length = tried, reached, scratch[LENGTH]
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
