"""Published parametric models of cyclone wind and waves; each formula is one function.

All are NumPy functions in SI units (m, s, Pa, rad unless the name says otherwise) and broadcast.
They describe an idealised vortex: what they give is modelled, not observed.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY

AIR_DENSITY: Final = 1.15  #: [kg/m3], as in Holland (1980)
AMBIENT_PRESSURE: Final = 101300.0  #: [Pa]
EARTH_ROTATION: Final = 7.2921150e-5  #: [rad/s]
SURFACE_FACTOR: Final = 0.9  #: 10 m wind over gradient wind, Powell et al. (2003): about 0.9
TEN_MINUTE_FACTOR: Final = (
    0.93  #: 10-min over 1-min mean wind at sea, Harper et al. (2010) tab. 1.1
)
TRANSLATION_FACTOR: Final = 0.55  #: Lin and Chavas (2012)
TRANSLATION_TURN_DEG: Final = 20.0  #: counter-clockwise in the north, Lin and Chavas (2012)
B_RANGE: Final = (1.0, 2.5)  #: Holland (1980), page 1215
FETCH_WIND_RANGE: Final = (15.0, 60.0)  #: [m/s] range of maximum wind we use the fetch relation for
FETCH_SPEED_RANGE: Final = (
    0.0,
    10.0,
)  #: [m/s] range of forward speed we use the fetch relation for


def coriolis_parameter(lat_deg: ArrayLike) -> FloatArray:
    """Return the Coriolis parameter [1/s], ``2 omega sin(lat)``; negative in the south."""
    return np.asarray(2.0 * EARTH_ROTATION * np.sin(np.radians(lat_deg)))


def holland_b(maximum_gradient_wind: ArrayLike, pressure_deficit: ArrayLike) -> FloatArray:
    """Return Holland's shape parameter B [-], kept within 1 and 2.5.

    Holland (1980), Mon. Wea. Rev. 108, 1212-1218, eq. 7 solved for B:
    ``B = rho e Vm^2 / (pn - pc)`` (wind [m/s], deficit [Pa]).
    """
    deficit = np.maximum(np.asarray(pressure_deficit, float), 100.0)
    b = AIR_DENSITY * np.e * np.square(maximum_gradient_wind) / deficit
    return np.clip(b, *B_RANGE)


def holland_gradient_wind(
    radius: ArrayLike,
    *,
    radius_of_maximum: ArrayLike,
    pressure_deficit: ArrayLike,
    b: ArrayLike,
    coriolis: ArrayLike,
) -> FloatArray:
    """Return the gradient wind speed [m/s] at a radius [m].

    Holland (1980), eq. 4: ``V = sqrt(B dp/rho (Rm/r)^B exp(-(Rm/r)^B) + (r f/2)^2) - r |f|/2``.
    Valid for r > 0 (at the centre it is 0), B from 1 to 2.5.
    """
    r = np.maximum(np.asarray(radius, float), 1.0)
    x = (np.asarray(radius_of_maximum, float) / r) ** b
    half = 0.5 * r * np.abs(coriolis)
    cyclostrophic = np.asarray(b) * pressure_deficit / AIR_DENSITY * x * np.exp(-x)
    return np.asarray(np.sqrt(cyclostrophic + half * half) - half)


def radius_of_maximum_wind_willoughby2006(
    maximum_wind: ArrayLike, lat_deg: ArrayLike
) -> FloatArray:
    """Return the radius of maximum wind [m] where the track does not tell it.

    Willoughby, Darling and Rahn (2006), Mon. Wea. Rev. 134, 1102-1120, eq. 7a:
    ``Rm = 46.4 exp(-0.0155 Vm + 0.0169 |lat|)`` km, from Atlantic and Pacific hurricanes.
    """
    exponent = -0.0155 * np.asarray(maximum_wind, float) + 0.0169 * np.abs(lat_deg)
    return np.asarray(46.4e3 * np.exp(exponent))


def inflow_angle(radius: ArrayLike, radius_of_maximum: ArrayLike) -> FloatArray:
    """Return how far the surface wind is turned towards the centre [rad].

    Bretschneider (1972) as used by Phadke et al. (2003), Ocean Eng. 30, 553-578:
    10 deg at the centre rising to 20 deg at Rm, to 25 deg at 1.2 Rm, 25 deg beyond.
    """
    x = np.asarray(np.divide(radius, radius_of_maximum), np.float64)
    degrees = 10.0 + 10.0 * np.minimum(x, 1.0) + 25.0 * np.clip(x - 1.0, 0.0, 0.2)
    return np.radians(degrees)


def translation_wind(
    east: ArrayLike, north: ArrayLike, lat_deg: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return the surface wind (east, north) [m/s] a moving vortex adds at its radius of maximum.

    Lin and Chavas (2012), J. Geophys. Res. 117, D09120: 0.55 of the forward velocity, turned
    20 deg to the left in the northern and to the right in the southern hemisphere.
    """
    turn = np.radians(TRANSLATION_TURN_DEG) * np.where(np.asarray(lat_deg) >= 0.0, 1.0, -1.0)
    u, v = np.asarray(east, float), np.asarray(north, float)
    return (
        TRANSLATION_FACTOR * (u * np.cos(turn) - v * np.sin(turn)),
        TRANSLATION_FACTOR * (u * np.sin(turn) + v * np.cos(turn)),
    )


def equivalent_fetch_young2013(
    maximum_wind: ArrayLike, forward_speed: ArrayLike, radius_of_maximum: ArrayLike
) -> FloatArray:
    """Return the equivalent fetch [m] of a moving cyclone.

    Young (1988), J. Waterway Port Coastal Ocean Eng. 114, 637-652, with the
    coefficients of Young and Vinoth (2013), Ocean Eng. 70, 14-24; both reviewed in Young (2017),
    Atmosphere 8, 194. Wind and speed [m/s] are kept within 15-60 and 0-10: beyond, the quadratic
    turns over and would give no waves at all under a fast, wide storm.
    """
    v = np.clip(maximum_wind, *FETCH_WIND_RANGE)
    s = np.clip(forward_speed, *FETCH_SPEED_RANGE)
    shape = -2.175e-3 * v**2 + 1.506e-2 * v * s - 1.223e-1 * s**2 + 8.76e-2 * v + 1.516 * s + 1.756
    spatial = 22.5e3 * np.log10(np.maximum(radius_of_maximum, 1.5e4)) - 70.8e3
    return np.asarray(np.maximum(shape, 0.0) * spatial)


def wave_height_jonswap(wind_speed: ArrayLike, fetch: ArrayLike) -> FloatArray:
    """Return significant wave height [m] for a 10 m wind [m/s] over a fetch [m].

    Hasselmann et al. (1973), as in Young (1988): ``g H/U^2 = 0.0016 (g x/U^2)^0.5``, deep
    water. At one fetch the height is proportional to the wind.
    """
    return np.asarray(0.0016 * np.asarray(wind_speed) * np.sqrt(np.asarray(fetch) / GRAVITY))


def peak_period_young2006(wave_height: ArrayLike, wind_speed: ArrayLike) -> FloatArray:
    """Return the peak period [s] of cyclone waves of a height [m] under a 10 m wind [m/s].

    Young (2006), J. Geophys. Res. 111, C08020: ``g^2 m0/U^4 = 6.365e-6 (fp U/g)^-3.3``
    with ``m0 = (H/4)^2``.
    """
    u = np.maximum(np.asarray(wind_speed, float), 0.1)
    energy = np.maximum((GRAVITY * np.asarray(wave_height) / 4.0) ** 2 / u**4, 1e-12)
    return np.asarray(u / GRAVITY * (energy / 6.365e-6) ** (1.0 / 3.3))
