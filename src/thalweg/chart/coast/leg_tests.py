"""Legs and positions against a coast, in arrays, exact along the geodesic at any length."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.geodesy import direct, inverse
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import OK
from thalweg.kernels.geometry.coast_index import CoastArrays, leg_codes, point_codes

EXACT_LEG_LENGTH: Final = 100_000.0  # legs this short are exact to 3 mm in the kernel [m]


def leg_status(
    coast: CoastArrays, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int8]:
    """Return the status code of each geodesic leg [deg]; arguments broadcast together.

    Parameters
    ----------
    coast : CoastArrays
        Index of a coast.
    lat1, lon1, lat2, lon2 : array_like
        Ends of the legs [deg].

    Returns
    -------
    int8 array
        Status codes (`thalweg.kernels.codes`) in the broadcast shape.
    """
    ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
    # writeable arrays all, so that the kernel is compiled for one kind only
    a, b, c, d = (np.require(x, float, ("C", "W")).ravel() for x in ends)
    code = np.empty(len(a), np.int8)
    unsure = np.empty(len(a), np.bool_)
    leg_codes(coast, a, b, c, d, code, unsure)
    for k in np.flatnonzero(unsure):
        code[k] = _status_in_parts(coast, a[k], b[k], c[k], d[k])
    return code.reshape(ends[0].shape)


def _status_in_parts(coast: CoastArrays, lat1: float, lon1: float, lat2: float, lon2: float) -> int:
    """Return the status of a leg split at points of the exact geodesic."""
    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    count = int(np.ceil(length / EXACT_LEG_LENGTH)) + 1
    lat, lon = direct(lat1, lon1, course, np.linspace(0.0, float(length), count + 1))
    lat[0], lon[0], lat[-1], lon[-1] = lat1, lon1, lat2, lon2
    code, unsure = np.empty(count, np.int8), np.empty(count, np.bool_)
    leg_codes(coast, lat[:-1], lon[:-1], lat[1:], lon[1:], code, unsure)
    blocked = code[code != OK]
    return int(blocked.min()) if len(blocked) else OK


def point_status(coast: CoastArrays, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.int8]:
    """Return the status code of each position [deg]."""
    a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
    code = np.empty(a.size, np.int8)
    flat: list[FloatArray] = [np.require(x, float, ("C", "W")).ravel() for x in (a, b)]
    point_codes(coast, flat[0], flat[1], code)
    return code.reshape(a.shape)
