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
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.ellipsoid import ECCENTRICITY_SQUARED, EQUATORIAL_RADIUS
from thalweg.core.geodesy import (
    WGS84,
    densify,
    direct,
    distance,
    inverse,
    wrap_longitude,
)
from thalweg.core.types import FloatArray

_CLOSE: Final = 0.1  # radians of latitude within which quadrature is used
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)
_FRACTIONS: Final = np.linspace(0.1, 0.9, 9)  # of a leg, where its deviation is measured
_MAX_LATITUDE: Final = 89.999999  # the course at a pole is not defined [deg]


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


def positions_along_rhumb(
    lat1: float, lon1: float, lat2: float, lon2: float, fractions: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return positions [deg] at fractions of the rhumb line from the first to the second.

    Parameters
    ----------
    lat1, lon1, lat2, lon2 : Ends of the rhumb line [deg].
    fractions : Fractions of its length from the first end, 0 to 1.

    Returns
    -------
    lat, lon : Positions [deg], in the shape of the fractions.
    """
    length, course = inverse_rhumb(lat1, lon1, lat2, lon2)
    return direct_rhumb(lat1, lon1, course, np.asarray(fractions, float) * length)


def rhumb_deviation(lat: ArrayLike, lon: ArrayLike) -> FloatArray:
    """Return how far the rhumb line and the geodesic of each leg are apart.

    Measured between positions at the same fractions of both, which is at least the cross-track
    distance and in short legs equal to it.

    Parameters
    ----------
    lat, lon : Vertices of a polyline [deg], (n,).

    Returns
    -------
    ndarray (n - 1,) : Greatest distance in each leg [m].
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    start, end = (lat[:-1, None], lon[:-1, None]), (lat[1:, None], lon[1:, None])
    length, course, _ = inverse(*start, *end)
    straight = direct(*start, course, _FRACTIONS * length)
    rhumb_length, rhumb_course = inverse_rhumb(*start, *end)
    constant = direct_rhumb(*start, rhumb_course, _FRACTIONS * rhumb_length)
    return np.asarray(distance(*straight, *constant).max(axis=1))


def rhumb_cross_track(
    start: tuple[float, float], end: tuple[float, float], lat: ArrayLike, lon: ArrayLike
) -> FloatArray:
    """Return the distances [m] of positions from a rhumb line; those abreast of it, and close.

    Rhumb lines are straight in Mercator's projection, whose scale at the position gives metres.

    Parameters
    ----------
    start, end : (lat, lon)
        Ends of the rhumb line [deg].
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    ndarray (n,) : Distances [m], positive.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    psi, _ = _isometric_step(np.array([start[0]]), np.array([end[0]]))
    turn = np.radians(wrap_longitude(end[1] - start[1]))
    rise, _ = _isometric_step(np.full(lat.shape, start[0]), lat)
    lon_change = np.radians(wrap_longitude(lon - start[1]))
    length = math.hypot(float(turn), float(psi[0]))
    phi = np.radians(lat)
    scale = EQUATORIAL_RADIUS * np.cos(phi) / np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    apart = (
        np.hypot(lon_change, rise)
        if length == 0.0
        else (lon_change * psi[0] - rise * turn) / length
    )
    return np.asarray(np.abs(apart) * scale)


def densify_for_rhumb(
    lat: ArrayLike, lon: ArrayLike, deviation: float, spacing: float = math.inf
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Break the geodesics of a polyline so that rhumb lines between the points stay close to them.

    Parameters
    ----------
    lat, lon : Vertices of the polyline [deg], (n,).
    deviation : Greatest distance between rhumb line and geodesic of a piece [m], above 0.
    spacing : Greatest length of a piece [m].

    Returns
    -------
    lat, lon : Positions [deg], original vertices included.
    leg : For each position but the last, the index of its leg.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    pieces = []
    long = distance(lat[:-1], lon[:-1], lat[1:], lon[1:]) > spacing
    broken = long | ~(rhumb_deviation(lat, lon) <= deviation)
    wrapped = wrap_longitude(lon)
    for index in range(len(lat) - 1):
        ends = slice(index, index + 2)
        pieces.append(
            _leg_pieces(lat[ends], lon[ends], deviation, spacing)
            if broken[index]
            else (lat[ends], wrapped[ends])
        )
    out_lat = np.concatenate([*(piece[0][:-1] for piece in pieces), lat[-1:]])
    out_lon = np.concatenate([*(piece[1][:-1] for piece in pieces), wrap_longitude(lon[-1:])])
    leg = np.repeat(np.arange(len(pieces)), [len(piece[0]) - 1 for piece in pieces])
    return out_lat, out_lon, leg


def rhumb_pieces(
    lat: ArrayLike, lon: ArrayLike, deviation: float
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Break the rhumb lines of a polyline so that geodesics between the points stay close to them.

    Parameters
    ----------
    lat, lon : Vertices of the polyline [deg], (n,).
    deviation : Greatest distance between rhumb line and geodesic of a piece [m], above 0.

    Returns
    -------
    lat, lon : Positions [deg], original vertices included.
    leg : For each position but the last, the index of its leg.
    """
    lat, lon = np.asarray(lat, float), np.asarray(lon, float)
    parts_lat, parts_lon, counts = [], [], []
    whole = rhumb_deviation(lat, lon)
    for index in range(len(lat) - 1):
        count = max(1, math.ceil(math.sqrt(whole[index] / deviation)))
        while True:
            fractions = np.arange(count + 1) / count
            ends = (lat[index], lon[index], lat[index + 1], lon[index + 1])
            found = positions_along_rhumb(*ends, fractions)
            if rhumb_deviation(*found).max() <= deviation or count > 5_000:
                break
            count += max(1, count // 8)
        found[0][0], found[1][0] = lat[index], wrap_longitude(lon[index])
        parts_lat.append(found[0][:-1])
        parts_lon.append(found[1][:-1])
        counts.append(count)
    out_lat = np.concatenate([*parts_lat, lat[-1:]])
    out_lon = np.concatenate([*parts_lon, wrap_longitude(lon[-1:])])
    return out_lat, out_lon, np.repeat(np.arange(len(counts)), counts)


def _leg_pieces(
    lat: FloatArray, lon: FloatArray, deviation: float, spacing: float
) -> tuple[FloatArray, FloatArray]:
    """Return one geodesic in equal pieces that keep to both limits."""
    length = float(distance(lat[0], lon[0], lat[1], lon[1]))
    whole = float(rhumb_deviation(lat, lon)[0])
    count = max(1, math.ceil(length / spacing - 1e-9), math.ceil(math.sqrt(whole / deviation)))
    while True:
        found = densify(lat, lon, length / count) if count > 1 else (lat, wrap_longitude(lon))
        if rhumb_deviation(found[0], found[1]).max() <= deviation or count > 5_000:
            return found[0], found[1]
        count += max(1, count // 8)


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


def _isometric(phi: FloatArray) -> FloatArray:
    e = math.sqrt(ECCENTRICITY_SQUARED)
    return np.asarray(np.arctanh(np.sin(phi)) - e * np.arctanh(e * np.sin(phi)))
