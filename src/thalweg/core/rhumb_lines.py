r"""Rhumb lines (loxodromes) on the WGS 84 ellipsoid: lines of constant course.

Formulas of Bennett (1996), "Practical rhumb line calculations on the spheroid", J. Navigation
49(1), 112-119, and Karney (2024), "The area of rhumb polygons": with the isometric latitude
:math:`\psi(\phi)` and the meridian distance :math:`M(\phi)`,

.. math::

    \tan\alpha = \Delta\lambda / \Delta\psi, \qquad s = \Delta M / \cos\alpha

Meridian distances are geodesics of `pyproj.Geod`. The quotient :math:`\Delta M / \Delta\psi`,
the mean radius of the parallels, is found by quadrature where the latitudes are close.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.ellipsoid import ECCENTRICITY_SQUARED, EQUATORIAL_RADIUS
from thalweg.core.geodesy import (
    MEAN_RADIUS,
    WGS84,
    direct,
    distance,
    in_equal_pieces,
    inverse,
    wrap_longitude,
)
from thalweg.core.types import BoolArray, FloatArray, IntArray

_CLOSE: Final = 0.1  # radians of latitude within which quadrature is used
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)
_FRACTIONS: Final = np.linspace(0.1, 0.9, 9)  # of a leg, where its deviation is measured
_MAX_LATITUDE: Final = 89.999999  # the course at a pole is not defined [deg]
_SHORT_LEG: Final = 100_000.0  # [m]
_HIGH_LATITUDE: Final = 80.0  # [deg]
_MOST_PIECES: Final = 5_000  # of a leg


def inverse_rhumb(
    lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Solve the inverse problem of the rhumb line, along the shorter difference of longitude.

    Parameters
    ----------
    lat1, lon1, lat2, lon2 : Positions [deg]; broadcast together.

    Returns
    -------
    distance : Length of the rhumb line [m].
    course : Its course, clockwise from north [rad], in [0, 2 pi).
    """
    a, b, c, d = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
    turn = np.radians(wrap_longitude(d - b))
    psi, parallel = _isometric_step(a, c)
    course = np.arctan2(turn, psi) % (2.0 * math.pi)
    return np.asarray(np.hypot(turn, psi) * parallel), np.asarray(course)


def direct_rhumb(
    lat: ArrayLike, lon: ArrayLike, course: ArrayLike, distance: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return the positions [deg] reached after a distance [m] on a constant course [rad].

    Parameters
    ----------
    lat, lon : Positions [deg].
    course : Course, clockwise from north [rad].
    distance : Length of the rhumb line [m].

    Returns
    -------
    lat, lon : Positions [deg]; NaN where the line would pass a pole.
    """
    a, b, c, d = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat, lon, course, distance)))
    zero = np.zeros(a.shape)
    _, _, north = WGS84.inv(zero, zero, zero, np.abs(a))
    goal = np.copysign(north, a) + d * np.cos(c)
    quarter = float(WGS84.inv(0.0, 0.0, 0.0, 90.0)[2])
    inside = np.abs(goal) < quarter
    _, end, _ = WGS84.fwd(zero, zero, zero, np.where(inside, np.abs(goal), 0.0))
    end = np.where(np.cos(c) == 0.0, a, np.copysign(end, goal))
    _, parallel = _isometric_step(a, end)
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = wrap_longitude(b + np.degrees(d * np.sin(c) / parallel))
    return np.where(inside, end, math.nan), np.where(inside, turned, math.nan)


def rhumb_deviates(lat: ArrayLike, lon: ArrayLike, deviation: ArrayLike) -> BoolArray:
    r"""Return whether the rhumb line and the geodesic of each leg are further apart than a limit.

    The rhumb line has the geodesic curvature :math:`\tan\phi \sin\alpha / R`, so in a leg of
    length :math:`s` the two are at most about :math:`s^2 \tan\phi / 8R` apart. Where twice this is
    within the limit, nothing is measured.

    Parameters
    ----------
    lat, lon : Vertices of a polyline [deg], (n,).
    deviation : Limit [m], of all legs or (n - 1,).

    Returns
    -------
    bool array (n - 1,) : Also true where the deviation is unknown.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    limit = np.broadcast_to(np.asarray(deviation, float), len(lat) - 1)
    length = distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    highest = np.maximum(np.abs(lat[:-1]), np.abs(lat[1:]))
    most = length**2 * np.tan(np.radians(np.minimum(highest, 89.0))) / (4.0 * MEAN_RADIUS)
    near = (length < _SHORT_LEG) & (highest < _HIGH_LATITUDE) & (most <= limit)
    found = np.zeros(len(length), bool)
    k = np.flatnonzero(~near)
    if k.size:
        apart = _deviation(lat[k], lon[k], lat[k + 1], lon[k + 1])
        found[k] = ~(apart <= limit[k]) & (limit[k] < math.inf)
    return found


def _deviation(
    lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> FloatArray:
    """Return how far the rhumb line and the geodesic of each leg (n,) are apart [m].

    Measured between positions at the same fractions of both, which is at least the cross-track
    distance and in short legs equal to it.
    """
    start, end = (lat1[:, None], lon1[:, None]), (lat2[:, None], lon2[:, None])
    length, course, _ = inverse(*start, *end)
    straight = direct(*start, course, _FRACTIONS * length)
    rhumb_length, rhumb_course = inverse_rhumb(*start, *end)
    constant = direct_rhumb(*start, rhumb_course, _FRACTIONS * rhumb_length)
    return np.asarray(distance(*straight, *constant).max(axis=1))


def rhumb_cross_track(
    start: tuple[ArrayLike, ArrayLike],
    end: tuple[ArrayLike, ArrayLike],
    lat: ArrayLike,
    lon: ArrayLike,
) -> FloatArray:
    """Return the distances [m] of positions from rhumb lines; those abreast of them, and close.

    Rhumb lines are straight in Mercator's projection, whose scale at the position gives metres.

    Parameters
    ----------
    start, end : (lat, lon)
        Ends of the rhumb line [deg], or of one for each position, (n,).
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    ndarray (n,) : Distances [m], positive.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    psi0, psi1, psi = (_isometric_latitude(x) for x in (start[0], end[0], lat))
    east, north = np.radians(wrap_longitude(np.subtract(end[1], start[1]))), psi1 - psi0
    x, y = np.radians(wrap_longitude(np.subtract(lon, start[1]))), psi - psi0
    length = np.hypot(east, north)
    phi = np.radians(lat)
    scale = EQUATORIAL_RADIUS * np.cos(phi) / np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.where(length == 0.0, np.hypot(x, y), (x * north - y * east) / length)
    return np.asarray(np.abs(apart) * scale)


def densify_for_rhumb(
    lat: ArrayLike, lon: ArrayLike, deviation: ArrayLike, spacing: ArrayLike = math.inf
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Break the geodesics of a polyline so that rhumb lines between the points stay close to them.

    Parameters
    ----------
    lat, lon : Vertices of the polyline [deg], (n,).
    deviation : Greatest distance between rhumb line and geodesic of a piece [m], above 0; of all
        legs or (n - 1,).
    spacing : Greatest length of a piece [m], of all legs or (n - 1,).

    Returns
    -------
    lat, lon : Positions [deg], original vertices included.
    leg : For each position but the last, the index of its leg.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    limit, longest = (np.broadcast_to(x, len(lat) - 1) for x in (deviation, spacing))
    length, course, _ = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    bends = rhumb_deviates(lat, lon, limit)
    count = np.maximum(1, np.ceil(length / longest - 1e-9)).astype(np.int64)

    def place(leg: IntArray, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        return direct(lat[leg], lon[leg], course[leg], fraction * length[leg])

    count = _raised_counts(lat, lon, count, bends, limit, place)
    return in_equal_pieces(lat, lon, count)


def rhumb_pieces(
    lat: ArrayLike, lon: ArrayLike, deviation: ArrayLike
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Break the rhumb lines of a polyline so that geodesics between the points stay close to them.

    Parameters
    ----------
    lat, lon : Vertices of the polyline [deg], (n,).
    deviation : Greatest distance between rhumb line and geodesic of a piece [m], above 0; of all
        legs or (n - 1,), infinite for legs that are not broken.

    Returns
    -------
    lat, lon : Positions [deg], original vertices included.
    leg : For each position but the last, the index of its leg.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    length, course = inverse_rhumb(lat[:-1], lon[:-1], lat[1:], lon[1:])
    limit = np.broadcast_to(np.asarray(deviation, float), len(length))
    bends = rhumb_deviates(lat, lon, limit)

    def place(leg: IntArray, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        return direct_rhumb(lat[leg], lon[leg], course[leg], fraction * length[leg])

    count = np.ones(len(length), np.int64)
    count = _raised_counts(lat, lon, count, bends, limit, place)
    leg, number = numbered_parts(count)
    out_lat, out_lon = lat[leg], wrap_longitude(lon[leg])
    inner = number > 0
    out_lat[inner], out_lon[inner] = place(leg[inner], (number / count[leg])[inner])
    return np.append(out_lat, lat[-1]), np.append(out_lon, wrap_longitude(lon[-1])), leg


def _raised_counts(
    lat: FloatArray,
    lon: FloatArray,
    count: IntArray,
    bends: BoolArray,
    limit: FloatArray,
    place: Callable[[IntArray, FloatArray], tuple[FloatArray, FloatArray]],
) -> IntArray:
    """Return the numbers of equal pieces of legs in which no piece deviates by more than a limit.

    Parameters
    ----------
    count : The least numbers.
    bends : Which legs deviate as a whole.
    place : Returns the positions at fractions of legs.
    """
    count, pending = count.copy(), np.flatnonzero(bends)
    if pending.size:
        apart = _deviation(lat[pending], lon[pending], lat[pending + 1], lon[pending + 1])
        least = np.ceil(np.sqrt(apart / limit[pending]))
        least = np.where(np.isnan(least), 1.0, np.minimum(least, _MOST_PIECES))
        count[pending] = np.maximum(count[pending], least.astype(np.int64))
    while pending.size:
        pieces = count[pending]
        first = np.cumsum(pieces + 1) - pieces - 1
        leg = np.repeat(pending, pieces + 1)
        number = np.arange(len(leg)) - np.repeat(first, pieces + 1)
        out_lat, out_lon = place(leg, number / count[leg])
        k = np.flatnonzero(number[1:])
        apart = _deviation(out_lat[k], out_lon[k], out_lat[k + 1], out_lon[k + 1])
        worst = np.maximum.reduceat(apart, np.cumsum(pieces) - pieces)
        pending = pending[~(worst <= limit[pending]) & (pieces <= _MOST_PIECES)]
        count[pending] += np.maximum(1, count[pending] // 8)
    return count


def _isometric_step(start: FloatArray, end: FloatArray) -> tuple[FloatArray, FloatArray]:
    r"""Return the difference of isometric latitude and :math:`\Delta M / \Delta\psi` [m/rad]."""
    start, end = (np.clip(x, -_MAX_LATITUDE, _MAX_LATITUDE) for x in (start, end))
    phi1, phi2 = np.radians(start), np.radians(end)
    half = 0.5 * (phi2 - phi1)
    nodes = (0.5 * (phi1 + phi2))[..., None] + half[..., None] * _NODES
    square = 1.0 - ECCENTRICITY_SQUARED * np.sin(nodes) ** 2
    meridian = EQUATORIAL_RADIUS * (1.0 - ECCENTRICITY_SQUARED) / square**1.5
    radius = EQUATORIAL_RADIUS * np.cos(nodes) / np.sqrt(square)
    near_psi = half * np.sum(_WEIGHTS * meridian / radius, axis=-1)
    mean = np.sum(_WEIGHTS * meridian, axis=-1) / np.sum(_WEIGHTS * meridian / radius, axis=-1)
    psi = _isometric(phi2) - _isometric(phi1)
    close = (np.abs(2.0 * half) < _CLOSE) & (np.abs(phi1) < 1.4) & (np.abs(phi2) < 1.4)
    to_pole = 0.5 * math.pi - np.maximum(np.abs(phi1), np.abs(phi2))
    close |= np.abs(2.0 * half) < 0.05 * to_pole
    zero = np.zeros(start.shape)
    _, _, apart = WGS84.inv(zero, start.copy(), zero, end.copy())
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.asarray(apart) / np.abs(psi)
    flat = start == end
    return np.where(close, near_psi, psi), np.where(close | flat, mean, far)


def _isometric_latitude(lat: ArrayLike) -> FloatArray:
    """Return isometric latitudes [rad] of latitudes [deg], finite at the poles."""
    return _isometric(np.radians(np.clip(np.asarray(lat, float), -_MAX_LATITUDE, _MAX_LATITUDE)))


def _isometric(phi: FloatArray) -> FloatArray:
    e = math.sqrt(ECCENTRICITY_SQUARED)
    return np.asarray(np.arctanh(np.sin(phi)) - e * np.arctanh(e * np.sin(phi)))
