"""Mean longitudes of moon and sun, from which tidal arguments are computed.

Polynomials of the Explanatory Supplement to the Astronomical Ephemeris (1961, pp. 98 and 107), as
used by Foreman (1977), T_TIDE and UTide.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.core.units import DAY

EPOCH: Final = -2209032000.0  #: [s since 1970] 1899-12-31T12:00Z, origin of the polynomials

# degrees; per day, per (10^4 day)^2, per (10^4 day)^3 from the epoch
_LONGITUDE_POLYNOMIALS: Final = np.array(
    [
        [270.434164, 13.1763965268, -0.0000850, 0.000000039],  # s, the moon
        [279.696678, 0.9856473354, 0.00002267, 0.0],  # h, the sun
        [334.329556, 0.1114040803, -0.0007739, -0.00000026],  # p, the lunar perigee
        [-259.183275, 0.0529539222, -0.0001557, -0.000000050],  # N', minus the node
        [281.220844, 0.0000470684, 0.0000339, 0.000000070],  # p1, the perihelion
    ]
)


def mean_longitudes(times: FloatArray) -> FloatArray:
    r"""Return the hour angle of the mean sun and the mean longitudes.

    Each longitude is a polynomial in the days d since 1899-12-31T12:00Z,

    .. math:: c_0 + c_1 d + c_2 (d / 10^4)^2 + c_3 (d / 10^4)^3

    with the coefficients of the Explanatory Supplement (1961) [1]_.

    Parameters
    ----------
    times : Seconds since 1970-01-01T00:00Z, (T,).

    Returns
    -------
    float64 array (6, T) : In cycles: T (solar time, 0 at midnight), s (moon), h (sun), p (lunar
        perigee), N' (minus the longitude of the moon's ascending node) and p1 (perihelion).

    References
    ----------
    .. [1] H.M. Nautical Almanac Office (1961). *Explanatory Supplement to the Astronomical
       Ephemeris and the American Ephemeris and Nautical Almanac*, pp. 98 and 107.
    """
    day = (times - EPOCH) / DAY
    scaled = day / 1e4
    powers = np.stack([np.ones_like(day), day, scaled**2, scaled**3])
    longitude = (_LONGITUDE_POLYNOMIALS @ powers / 360.0) % 1.0
    return np.vstack([(times / DAY) % 1.0, longitude])


def argument_rates() -> FloatArray:
    r"""Return the rates (6,) of the arguments of `mean_longitudes` [cycles per hour], in 2000.

    .. math::
        24 \dot{\theta} = c_1 + 2 \cdot 10^{-4} c_2 (d / 10^4) + 3 \cdot 10^{-4} c_3 (d /
            10^4)^2

    References
    ----------
    As in `mean_longitudes`.
    """
    day = (946684800.0 - EPOCH) / DAY
    c = _LONGITUDE_POLYNOMIALS
    daily = c[:, 1] + 2e-4 * c[:, 2] * day / 1e4 + 3e-4 * c[:, 3] * (day / 1e4) ** 2
    return np.append(1.0, daily / 360.0) / 24.0
