"""Wave spectra of a wind sea, with the quadrature and the moments every response uses."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.array_conversion import as_float_array

#: Panels of the quadrature in units of the peak frequency, and points in each.
PANEL_EDGES: Final = (0.35, 0.75, 1.0, 1.3, 2.0, 4.0, 8.0)
POINTS_PER_PANEL: Final = 8
#: 2 pi Hs / (g Tp^2) above which no sea is; steep ones have 0.07.
STEEPEST: Final = 0.1


def wave_steepness(height: ArrayLike, period: ArrayLike) -> FloatArray:
    """Return the steepness 2 pi H_s / (g T_p^2) of waves in deep water.

    Parameters
    ----------
    height : Significant height [m].
    period : Peak period, above 0 [s].
    """
    return as_float_array(height) * 2.0 * np.pi / (GRAVITY * as_float_array(period) ** 2)


def _panel_rule() -> tuple[FloatArray, FloatArray]:
    nodes, weights = np.polynomial.legendre.leggauss(POINTS_PER_PANEL)
    low, high = np.array(PANEL_EDGES[:-1]), np.array(PANEL_EDGES[1:])
    half = (high - low)[:, None] / 2.0
    return ((low + high)[:, None] / 2.0 + half * nodes).ravel(), (half * weights).ravel()


_NODES, _WEIGHTS = _panel_rule()


def quadrature(period: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return wave frequencies and weights for integrals over a sea state.

    Parameters
    ----------
    period : Peak period [s], any shape.

    Returns
    -------
    tuple of ndarray : Frequencies [rad/s] and weights [rad/s], 48 on a new last axis, from 0.35 to
        8 times the peak frequency. Gauss-Legendre panels that end at the peak, where the spectrum
        has a kink. NaN where the period is not positive.
    """
    t = as_float_array(period)
    peak = 2.0 * np.pi / np.where(t > 0.0, t, np.nan)
    return peak[..., None] * _NODES, peak[..., None] * _WEIGHTS


def with_flat_seas(
    height: FloatArray, *, period: FloatArray, wave_angle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return period and wave angle with some value where a flat sea has none."""
    flat = height == 0.0
    angle = np.where(flat & np.isnan(wave_angle), 0.0, wave_angle)
    return np.where(flat & ~(period > 0.0), 10.0, period), angle


def dnv_peak_factor(height: ArrayLike, period: ArrayLike) -> FloatArray:
    """Return the peak factor gamma of a JONSWAP spectrum by DNV-RP-C205.

    5 for Tp / sqrt(Hs) <= 3.6; exp(5.75 - 1.15 Tp / sqrt(Hs)); 1 from 5 on.

    Parameters
    ----------
    height : Significant height [m].
    period : Peak period [s].

    Returns
    -------
    ndarray : gamma [-].

    References
    ----------
    DNV-RP-C205 (2010), 3.5.5, as used by Prestegårdshus (2020), eq. 3.16.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = as_float_array(period) / np.sqrt(as_float_array(height))
    return np.where(ratio <= 3.6, 5.0, np.where(ratio >= 5.0, 1.0, np.exp(5.75 - 1.15 * ratio)))


def jonswap(
    frequency: ArrayLike,
    *,
    height: ArrayLike,
    period: ArrayLike,
    peak_factor: ArrayLike | None = None,
) -> FloatArray:
    """Return the JONSWAP spectrum, scaled so that 4 sqrt(m0) is the significant height.

    S = (5/16) Hs^2 wp^4 w^-5 exp(-1.25 (wp/w)^4) (1 - 0.287 ln gamma) gamma^r with
    r = exp(-(w - wp)^2 / (2 s^2 wp^2)) and s = 0.07 up to the peak, 0.09 above it.

    Parameters
    ----------
    frequency : Wave frequency [rad/s]; the last axis runs over frequency.
    height, period : Significant height [m] and peak period [s]; broadcast against the leading axes
        of ``frequency`` (a scalar sea state takes a vector of frequencies). The spectrum is meant
        for 3.6 < Tp / sqrt(Hs) < 5.
    peak_factor : gamma [-]; without it `dnv_peak_factor`.

    Returns
    -------
    ndarray : S(w) [m2 s/rad]; 0 at zero frequency and for zero height, NaN where data are unknown
        or the height is negative.

    Notes
    -----
    Prestegårdshus (2020) prints 5.058 for (5/16)(2 pi)^4/g^2 = 5.061 and gives both widths for
    frequencies at and below the peak; the second belongs above it. With the factor
    1 - 0.287 ln gamma the height comes out within 0.2 % for gamma up to 5.

    References
    ----------
    K. Hasselmann et al., Dt. Hydrogr. Z. A8(12) (1973); DNV-RP-C205 (2010), 3.5.5.
    """
    w = as_float_array(frequency)
    hs, tp = (as_float_array(x)[..., None] for x in (height, period))
    if peak_factor is None:
        gamma = dnv_peak_factor(hs, tp)
    else:
        gamma = as_float_array(peak_factor)[..., None]
    hs, tp = np.where(hs >= 0.0, hs, np.nan), np.where(tp > 0.0, tp, np.nan)
    peak = 2.0 * np.pi / tp
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x = w / peak
        width = np.where(x <= 1.0, 0.07, 0.09)
        enhance = np.exp(np.log(gamma) * np.exp(-((x - 1.0) ** 2) / (2.0 * width**2)))
        fourth = 1.0 / np.square(x * x)
        shape = np.where(x > 0.0, fourth / x * np.exp(-1.25 * fourth), 0.0 * x)
    return 0.3125 * hs**2 / peak * (1.0 - 0.287 * np.log(gamma)) * shape * enhance


def bretschneider(frequency: ArrayLike, *, height: ArrayLike, period: ArrayLike) -> FloatArray:
    r"""Return the two-parameter Bretschneider (Pierson-Moskowitz type) spectrum.

    .. math::
        S(\omega) = \frac{5}{16} H_s^2 \frac{\omega_p^4}{\omega^5} \exp\left[-\frac{5}{4}
            \left(\frac{\omega_p}{\omega}\right)^4\right]

    Parameters
    ----------
    frequency, height, period : As in `jonswap`.

    Returns
    -------
    ndarray : S(w) [m2 s/rad].

    References
    ----------
    C. L. Bretschneider (1959); the JONSWAP spectrum with gamma = 1.
    """
    return jonswap(frequency, height=height, period=period, peak_factor=1.0)


def pierson_moskowitz_period(height: ArrayLike) -> FloatArray:
    """Return the peak period of a fully developed sea of given height [s].

    From m0 = 0.0081 g^2 / (5 wp^4): wp = 0.02592^(1/4) sqrt(g / Hs), 0.02592 = 16 0.0081 / 5.

    Parameters
    ----------
    height : Significant height [m].

    Returns
    -------
    ndarray : Peak period [s], for `bretschneider`.

    References
    ----------
    W. J. Pierson, L. Moskowitz, J. Geophys. Res. 69 (1964).
    """
    period: FloatArray = 2.0 * np.pi / 0.02592**0.25 * np.sqrt(as_float_array(height) / GRAVITY)
    return period


def pierson_moskowitz_wind(height: ArrayLike) -> FloatArray:
    """Return the wind at 10 m that raises a fully developed sea of given height [m/s].

    From Hs = 2 U^2 sqrt(0.0081 / 0.74) / g with the wind U at 19.5 m, which is 1.026 times that at
    10 m.

    Parameters
    ----------
    height : Significant height [m].

    Returns
    -------
    ndarray : Wind speed [m/s].

    References
    ----------
    W. J. Pierson, L. Moskowitz, J. Geophys. Res. 69 (1964); R. H. Stewart, Introduction to Physical
    Oceanography (2008), section 16.4, for the factor 1.026.
    """
    steepness = 2.0 * np.sqrt(0.0081 / 0.74)
    wind: FloatArray = np.sqrt(as_float_array(height) * GRAVITY / steepness) / 1.026
    return wind


def spectral_moment(
    density: ArrayLike, weights: ArrayLike, *, frequency: ArrayLike, order: float
) -> FloatArray:
    r"""Return a spectral moment: the sum of |w|^n S over the last axis with weights.

    .. math:: m_n = \int_0^\infty |\omega|^n S(\omega) \, d\omega

    Parameters
    ----------
    density : Spectral density over *wave* frequency; squared response times wave spectrum for a
        response.
    weights : Weights of the quadrature [rad/s].
    frequency : Frequency whose power is taken [rad/s]: the wave's, or the encounter frequency for a
        ship under way. Integrating over wave frequency avoids the poles of the encounter spectrum.
    order : n.

    Returns
    -------
    ndarray : m_n.

    References
    ----------
    Definition; DNV-RP-C205 (2010), 3.5.
    """
    power = np.abs(as_float_array(frequency)) ** order if order else 1.0
    total: FloatArray = np.sum(as_float_array(density) * as_float_array(weights) * power, axis=-1)
    return total


def most_probable_maximum(m0: ArrayLike, m2: ArrayLike, *, duration: ArrayLike) -> FloatArray:
    """Return the most probable largest amplitude in a time: sqrt(2 m0 ln N).

    N = duration / Tz with Tz = 2 pi sqrt(m0 / m2), the number of cycles, at least one.

    Parameters
    ----------
    m0, m2 : Moments of the response over encounter frequency.
    duration : array_like [s]

    Returns
    -------
    ndarray : Amplitude in the unit of the response; 0 without response.

    References
    ----------
    M. K. Ochi, "On prediction of extreme values", J. Ship Research 17 (1973), narrow band.
    """
    variance = as_float_array(m0)
    with np.errstate(divide="ignore", invalid="ignore"):
        cycles = as_float_array(duration) / (2.0 * np.pi) * np.sqrt(as_float_array(m2) / variance)
        largest = np.sqrt(2.0 * variance * np.log(np.maximum(cycles, 1.0)))
    return np.where(variance == 0.0, 0.0 * as_float_array(m2), largest)
