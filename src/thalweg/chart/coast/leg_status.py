"""Legs and positions against a coast, in arrays, exact along the geodesic at any length."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.geodesy import direct, inverse
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import OK
from thalweg.kernels.geometry.coast_index import CoastArrays, leg_codes, point_codes
from thalweg.kernels.kernel_threads import run_in_threads

EXACT_LEG_LENGTH: Final = 100_000.0  # legs this short are exact to 3 mm in the kernel [m]

_NOTHING: Final = np.int8(127)  # above every status code
_LEGS_AT_ONCE: Final = 20_000


def leg_status(
    coast: CoastArrays, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int8]:
    """Return the status code of each geodesic leg [deg]; arguments broadcast together.

    Parameters
    ----------
    coast : Index of a coast.
    lat1, lon1, lat2, lon2 : Ends of the legs [deg].

    Returns
    -------
    int8 array : Status codes (`thalweg.kernels.codes`) in the broadcast shape.
    """
    ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
    # writeable arrays all, so that the kernel is compiled for one kind only
    a, b, c, d = (np.require(x, float, ("C", "W")).ravel() for x in ends)
    code = np.empty(len(a), np.int8)
    unsure = np.empty(len(a), np.bool_)

    def test(part: slice) -> None:
        leg_codes(coast, *(x[part] for x in (a, b, c, d, code, unsure)))

    run_in_threads(test, len(a), least=_LEGS_AT_ONCE)
    k = np.flatnonzero(unsure)
    for part in np.array_split(k, len(k) // _LEGS_AT_ONCE + 1) if len(k) else ():
        code[part] = _status_in_parts(coast, a[part], b[part], c[part], d[part])
    return code.reshape(ends[0].shape)


def _status_in_parts(
    coast: CoastArrays, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> NDArray[np.int8]:
    """Return the status of legs split at points of the exact geodesics."""
    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    count = np.ceil(length / EXACT_LEG_LENGTH).astype(np.int64) + 1
    points = count + 1
    first = np.cumsum(points) - points
    leg = np.repeat(np.arange(len(count)), points)
    share = (np.arange(len(leg)) - first[leg]) / count[leg]
    lat, lon = direct(lat1[leg], lon1[leg], course[leg], share * length[leg])
    last = first + count
    lat[first], lon[first], lat[last], lon[last] = lat1, lon1, lat2, lon2
    begin = np.delete(np.arange(len(leg)), last)
    code, unsure = np.empty(len(begin), np.int8), np.empty(len(begin), np.bool_)
    leg_codes(coast, lat[begin], lon[begin], lat[begin + 1], lon[begin + 1], code, unsure)
    code[code == OK] = _NOTHING
    least = np.minimum.reduceat(code, np.cumsum(count) - count)
    return np.where(least == _NOTHING, OK, least).astype(np.int8)


def point_status(coast: CoastArrays, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.int8]:
    """Return the status code of each position [deg]."""
    a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
    code = np.empty(a.size, np.int8)
    flat: list[FloatArray] = [np.require(x, float, ("C", "W")).ravel() for x in (a, b)]
    point_codes(coast, flat[0], flat[1], code)
    return code.reshape(a.shape)
