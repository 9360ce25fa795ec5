r"""Published parametric formulas for the wind and waves of cyclones.

All are NumPy functions in SI units (m, s, Pa, rad unless the name says otherwise) and broadcast.
They describe an idealised vortex: their results are modelled, not observed.
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
SURFACE_FACTOR: Final = 0.9  #: wind at 10 m over gradient wind, Powell et al. (2003): about 0.9
#: 10-min over 1-min mean wind at sea, Harper et al. (2010) tab. 1.1.
TEN_MINUTE_FACTOR: Final = 0.93
TRANSLATION_FACTOR: Final = 0.55  #: Lin and Chavas (2012)
TRANSLATION_TURN_DEG: Final = 20.0  #: counter-clockwise in the north, Lin and Chavas (2012)
B_RANGE: Final = (1.0, 2.5)  #: Holland (1980), page 1215
FETCH_WIND_RANGE: Final = (15.0, 60.0)  #: [m/s] maximum wind for which the fetch relation is used
FETCH_SPEED_RANGE: Final = (0.0, 10.0)  #: [m/s] forward speed for which the fetch relation is used


def coriolis_parameter(lat_deg: ArrayLike) -> FloatArray:
    r"""Return the Coriolis parameter, :math:`f = 2 \Omega \sin\varphi`.

    Parameters
    ----------
    lat_deg : Latitude [deg].

    Returns
    -------
    float64 array : f [rad/s]; negative in the southern hemisphere.
    """
    return np.asarray(2.0 * EARTH_ROTATION * np.sin(np.radians(lat_deg)))


def holland_b(maximum_gradient_wind: ArrayLike, pressure_deficit: ArrayLike) -> FloatArray:
    r"""Return Holland's shape parameter B, limited to 1 to 2.5.

    .. math:: B = \rho e V_m^2 / (p_n - p_c)

    which is eq. 7 of [1]_ solved for B.

    Parameters
    ----------
    maximum_gradient_wind : Maximum gradient wind :math:`V_m` [m/s].
    pressure_deficit : array_like
        Ambient minus central pressure :math:`p_n - p_c` [Pa]; at least 100 Pa is used.

    Returns
    -------
    float64 array : B [-].

    References
    ----------
    .. [1] Holland, G.J. (1980). An analytic model of the wind and pressure profiles in hurricanes.
       *Monthly Weather Review* 108, 1212-1218.
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
    r"""Return the gradient wind speed at a radius.

    .. math::

        V = \sqrt{\frac{B \Delta p}{\rho} \left(\frac{R_m}{r}\right)^B e^{-(R_m/r)^B}
            + \left(\frac{r f}{2}\right)^2} - \frac{r |f|}{2}

    which is eq. 4 of [1]_; valid for r > 0 (at the centre the wind is 0) and B from 1 to 2.5.

    Parameters
    ----------
    radius : Distance r from the centre [m].
    radius_of_maximum : Radius of maximum wind :math:`R_m` [m].
    pressure_deficit : Ambient minus central pressure :math:`\Delta p` [Pa].
    b : Shape parameter B [-].
    coriolis : Coriolis parameter f [rad/s].

    Returns
    -------
    float64 array : Gradient wind speed [m/s].

    References
    ----------
    .. [1] Holland, G.J. (1980). An analytic model of the wind and pressure profiles in hurricanes.
       *Monthly Weather Review* 108, 1212-1218.
    """
    r = np.maximum(np.asarray(radius, float), 1.0)
    x = (np.asarray(radius_of_maximum, float) / r) ** b
    half = 0.5 * r * np.abs(coriolis)
    cyclostrophic = np.asarray(b) * pressure_deficit / AIR_DENSITY * x * np.exp(-x)
    return np.asarray(np.sqrt(cyclostrophic + half * half) - half)


def radius_of_maximum_wind_willoughby2006(
    maximum_wind: ArrayLike, lat_deg: ArrayLike
) -> FloatArray:
    r"""Return the radius of maximum wind, for tracks that do not give it.

    .. math:: R_m = 46.4 \exp(-0.0155\, V_m + 0.0169\, |\varphi|) \text{ km}

    which is eq. 7a of [1]_, from Atlantic and Pacific hurricanes.

    Parameters
    ----------
    maximum_wind : Maximum wind :math:`V_m` [m/s].
    lat_deg : Latitude [deg].

    Returns
    -------
    float64 array : Radius [m].

    References
    ----------
    .. [1] Willoughby, H.E., Darling, R.W.R., Rahn, M.E. (2006). Parametric representation of the
       primary hurricane vortex. Part II. *Monthly Weather Review* 134, 1102-1120.
    """
    exponent = -0.0155 * np.asarray(maximum_wind, float) + 0.0169 * np.abs(lat_deg)
    return np.asarray(46.4e3 * np.exp(exponent))


def inflow_angle(radius: ArrayLike, radius_of_maximum: ArrayLike) -> FloatArray:
    r"""Return the angle by which the surface wind turns towards the centre.

    .. math::
        \theta = 10^\circ (1 + r/R_m)\ (r \le R_m), \quad 20^\circ + 25^\circ (r/R_m - 1)\
            (r \le 1.2 R_m), \quad 25^\circ

    10 deg at the centre, rising linearly to 20 deg at the radius of maximum wind Rm and to 25 deg
    at 1.2 Rm; 25 deg beyond (Bretschneider, 1972, as used in [1]_).

    Parameters
    ----------
    radius : array_like
        Distance from the centre [m].
    radius_of_maximum : array_like
        Radius of maximum wind [m].

    Returns
    -------
    float64 array
        Inflow angle [rad].

    References
    ----------
    .. [1] Phadke, A.C. et al. (2003). Modeling of tropical cyclone winds and waves for emergency
       management. *Ocean Engineering* 30, 553-578.
    """
    x = np.asarray(np.divide(radius, radius_of_maximum), np.float64)
    degrees = 10.0 + 10.0 * np.minimum(x, 1.0) + 25.0 * np.clip(x - 1.0, 0.0, 0.2)
    return np.radians(degrees)


def translation_wind(
    east: ArrayLike, north: ArrayLike, lat_deg: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    r"""Return the surface wind that the motion of a vortex adds at its radius of maximum wind.

    .. math:: \mathbf{w} = 0.55\, \mathbf{R}(\pm 20^\circ)\, \mathbf{v}_{forward}

    0.55 times the forward velocity, rotated by 20 deg, to the left in the northern and to the
    right in the southern hemisphere [1]_.

    Parameters
    ----------
    east, north : Forward velocity of the vortex [m/s].
    lat_deg : Latitude [deg].

    Returns
    -------
    east, north : Wind added [m/s].

    References
    ----------
    .. [1] Lin, N., Chavas, D. (2012). On hurricane parametric wind and applications in storm surge
       modeling. *Journal of Geophysical Research* 117, D09120.
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
    r"""Return the equivalent fetch of a moving cyclone.

    .. math::

        x &= \psi R' \\
        \psi &= -2.175\cdot10^{-3} V^2 + 1.506\cdot10^{-2} V s - 0.1223\, s^2
                + 8.76\cdot10^{-2} V + 1.516\, s + 1.756 \\
        R' &= 22.5\cdot10^3 \log_{10} R_m - 70.8\cdot10^3

    with the form of [1]_ and the coefficients of [2]_. V is limited to 15 to 60 m/s and s to 0 to
    10 m/s: beyond, the quadratic decreases and gives no waves under a fast, wide storm.

    Parameters
    ----------
    maximum_wind : array_like
        Maximum wind V [m/s].
    forward_speed : array_like
        Forward speed s of the cyclone [m/s].
    radius_of_maximum : array_like
        Radius of maximum wind :math:`R_m` [m]; at least 15 km is used.

    Returns
    -------
    float64 array
        Fetch x [m], at least 0.

    References
    ----------
    .. [1] Young, I.R. (1988). Parametric hurricane wave prediction model. *Journal of Waterway,
       Port, Coastal, and Ocean Engineering* 114, 637-652.
    .. [2] Young, I.R., Vinoth, J. (2013). An "extended fetch" model for the spatial distribution of
       tropical cyclone wind-waves as observed by altimeter. *Ocean Engineering* 70, 14-24.
       Reviewed in Young, I.R. (2017), *Atmosphere* 8, 194.
    """
    v = np.clip(maximum_wind, *FETCH_WIND_RANGE)
    s = np.clip(forward_speed, *FETCH_SPEED_RANGE)
    shape = -2.175e-3 * v**2 + 1.506e-2 * v * s - 1.223e-1 * s**2 + 8.76e-2 * v + 1.516 * s + 1.756
    spatial = 22.5e3 * np.log10(np.maximum(radius_of_maximum, 1.5e4)) - 70.8e3
    return np.asarray(np.maximum(shape, 0.0) * spatial)


def wave_height_jonswap(wind_speed: ArrayLike, fetch: ArrayLike) -> FloatArray:
    r"""Return the significant wave height for a wind over a fetch, in deep water.

    .. math:: g H_s / U^2 = 0.0016\, (g x / U^2)^{1/2}

    from [1]_, as in Young (1988). At one fetch the height is proportional to the wind.

    Parameters
    ----------
    wind_speed : Wind speed U at 10 m [m/s].
    fetch : Fetch x [m].

    Returns
    -------
    float64 array : Significant wave height [m].

    References
    ----------
    .. [1] Hasselmann, K. et al. (1973). Measurements of wind-wave growth and swell decay during the
       Joint North Sea Wave Project (JONSWAP). *Deutsche Hydrographische Zeitschrift*, A8(12).
    """
    return np.asarray(0.0016 * np.asarray(wind_speed) * np.sqrt(np.asarray(fetch) / GRAVITY))


def peak_period_young2006(wave_height: ArrayLike, wind_speed: ArrayLike) -> FloatArray:
    r"""Return the peak period of cyclone waves.

    .. math:: g^2 m_0 / U^4 = 6.365\cdot10^{-6} (f_p U / g)^{-3.3}, \quad m_0 = (H_s / 4)^2

    from [1]_, solved for :math:`T_p = 1 / f_p`.

    Parameters
    ----------
    wave_height : Significant wave height [m].
    wind_speed : Wind speed U at 10 m [m/s]; at least 0.1 m/s is used.

    Returns
    -------
    float64 array : Peak period [s].

    References
    ----------
    .. [1] Young, I.R. (2006). Directional spectra of hurricane wind waves. *Journal of Geophysical
       Research* 111, C08020.
    """
    u = np.maximum(np.asarray(wind_speed, float), 0.1)
    energy = np.maximum((GRAVITY * np.asarray(wave_height) / 4.0) ** 2 / u**4, 1e-12)
    return np.asarray(u / GRAVITY * (energy / 6.365e-6) ** (1.0 / 3.3))
