"""Mean second-order forces in a wave spectrum by a fixed quadrature, and the Bessel functions used.

The mean of a transfer function R(w) / a^2 over a spectrum E(w) is 2 * integral R/a^2 E dw. The
spectra are written with q = (w_p / w)^4, so that E w = 5/16 Hs^2 q exp(-1.25 q) times the
peak enhancement; equal steps in ln w then need few exponentials for each node and condition.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray

Spectrum = Literal["bretschneider", "jonswap"]

#: Step in ln w; trapezoids converge faster than any power for these smooth integrands.
LOG_FREQUENCY_STEP: Final = {"bretschneider": 0.05, "jonswap": 0.025}
#: The same for the smoother reflection terms.
REFLECTION_STEP: Final = {"bretschneider": 0.1, "jonswap": 0.04}
_BLOCK_SIZE: Final = 2048
_MEAN_TO_PEAK: Final = (0.8 * 691.0) ** 0.25 / (2.0 * np.pi)


def peak_period(mean_period: ArrayLike) -> FloatArray:
    r"""Peak period T_p [s] of an ITTC two-parameter spectrum from its mean period T_1 [s].

    .. math:: T_p = 2 \pi\, T_1 / (0.8 \cdot 691)^{1/4} = 1.296\, T_1

    Its form is E = A w^-5 exp(-B w^-4), B = 691 / T_1^4, so that T_p = 1.296 T_1 (ITTC 1978).

    References
    ----------
    ITTC (1978), two-parameter spectrum.
    """
    return np.asarray(np.asarray(mean_period, dtype=float) / _MEAN_TO_PEAK)


def spectral_density(
    frequency: ArrayLike,
    *,
    wave_height: ArrayLike,
    wave_period: ArrayLike,
    spectrum: Spectrum = "bretschneider",
    gamma: float = 3.3,
) -> FloatArray:
    r"""Wave spectrum E(w) [m2 s].

    .. math::
        E(\omega) = \frac{5}{16} H_s^2 \frac{q}{\omega} e^{-1.25 q} \, [(1 - 0.287
            \ln\gamma) \gamma^r], \quad q = (\omega_p / \omega)^4, \\
        r = \exp\left(-\frac{(\omega - \omega_p)^2}{2 \sigma^2 \omega_p^2}\right), \quad
            \sigma = 0.07\ (\omega \le \omega_p),\ 0.09\ (\omega > \omega_p)

    Parameters
    ----------
    frequency : array_like
        w [rad/s], above zero.
    wave_height : array_like
        Significant wave height Hs [m].
    wave_period : array_like
        Peak period T_p [s].
    spectrum : {"bretschneider", "jonswap"}
        JONSWAP with the normalisation 1 - 0.287 ln(gamma) of DNV-RP-C205.
    gamma : float
        Peak enhancement of JONSWAP.

    Returns
    -------
    ndarray
        E with integral Hs^2 / 16.

    References
    ----------
    DNV-RP-C205; the factor in brackets belongs to JONSWAP only.
    """
    omega = np.asarray(frequency, dtype=float)
    peak = 2.0 * np.pi / np.asarray(wave_period, dtype=float)
    shape = spectral_shape(omega / peak, spectrum=spectrum, gamma=gamma)
    return np.asarray(np.asarray(wave_height, dtype=float) ** 2 * shape / omega)


def spectral_shape(ratio: FloatArray, *, spectrum: Spectrum, gamma: float) -> FloatArray:
    r"""Return E w / Hs^2 as a function of w / w_p.

    .. math::
        \frac{E \omega}{H_s^2} = \frac{5}{16} q e^{-1.25 q} \, [(1 - 0.287 \ln\gamma)
            \gamma^r]

    Parameters
    ----------
    ratio : ndarray
        Frequency over peak frequency w / w_p [-].
    spectrum : str
        Name of the spectrum.
    gamma : float
        Peak enhancement of JONSWAP [-].

    Returns
    -------
    ndarray
        E w / Hs^2 [-].

    References
    ----------
    See `spectral_density`.
    """
    inverse = 1.0 / (ratio * ratio)
    q = inverse * inverse
    shape = 0.3125 * q * np.exp(-1.25 * q)
    if spectrum == "jonswap":
        reduced = (ratio - 1.0) * np.where(ratio <= 1.0, 1.0 / 0.07, 1.0 / 0.09)
        enhanced = np.exp(-0.5 * reduced * reduced)
        shape = shape * (1.0 - 0.287 * np.log(gamma)) * np.exp(np.log(gamma) * enhanced)
    return np.asarray(shape)


def log_spaced_nodes(low: float, high: float, *, step: float) -> FloatArray:
    """Return equal steps in the logarithm that pass through one, from `low` to `high`.

    Parameters
    ----------
    low, high : float
        Ends of the range, above 0.
    step : float
        Step of the natural logarithm [-].

    Returns
    -------
    ndarray
        Ascending values from ``low`` to ``high``.
    """
    first, last = np.floor(np.log(low) / step), np.ceil(np.log(high) / step)
    return np.asarray(np.exp(step * np.arange(first, last + 1.0)))


def in_blocks(
    function: Callable[..., FloatArray], *arguments: ArrayLike, block: int = _BLOCK_SIZE
) -> FloatArray:
    """Apply a function of flat arrays block by block, so that memory stays small.

    Parameters
    ----------
    function : callable
        Takes as many 1-d arrays as there are arguments and returns one of their length; an
        argument of one element comes as one element.
    *arguments : array_like
        Broadcast against each other.
    block : int
        Elements at a time.

    Returns
    -------
    ndarray
        Result in the broadcast shape.
    """
    arrays = [np.asarray(value, dtype=float) for value in arguments]
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    flat = [
        array.ravel() if array.size == 1 else np.broadcast_to(array, shape).ravel()
        for array in arrays
    ]
    result = np.empty(int(np.prod(shape)))
    for start in range(0, result.size, block):
        part = slice(start, start + block)
        result[part] = function(*(array if array.size == 1 else array[part] for array in flat))
    return result.reshape(shape)


def _polynomial(x: FloatArray, coefficients: tuple[float, ...]) -> FloatArray:
    return np.asarray(np.polynomial.polynomial.polyval(x, coefficients))


def bessel_i1_scaled(x: ArrayLike) -> FloatArray:
    """exp(-x) I_1(x) for x >= 0, relative error below 1e-6.

    Source: Abramowitz and Stegun (1964), 9.8.3 and 9.8.4.
    """
    values = np.asarray(x, dtype=float)
    small, large = np.minimum(values, 3.75), np.maximum(values, 3.75)
    near = (0.5, 0.87890594, 0.51498869, 0.15084934, 0.02658733, 0.00301532, 0.00032411)
    far = (
        *(0.39894228, -0.03988024, -0.00362018, 0.00163801, -0.01031555),
        *(0.02282967, -0.02895312, 0.01787654, -0.00420059),
    )
    below = small * np.exp(-small) * _polynomial((small / 3.75) ** 2, near)
    above = _polynomial(3.75 / large, far) / np.sqrt(large)
    return np.asarray(np.where(values <= 3.75, below, above))


def bessel_k1_scaled(x: ArrayLike) -> FloatArray:
    """exp(x) K_1(x) for x > 0, relative error below 1e-6.

    Source: Abramowitz and Stegun (1964), 9.8.7 and 9.8.8.
    """
    values = np.asarray(x, dtype=float)
    small, large = np.minimum(values, 2.0), np.maximum(values, 2.0)
    near = (
        *(1.0, 0.15443144, -0.67278579, -0.18156897),
        *(-0.01919402, -0.00110404, -0.00004686),
    )
    far = (
        *(1.25331414, 0.23498619, -0.03655620, 0.01504268),
        *(-0.00780353, 0.00325614, -0.00068245),
    )
    first = bessel_i1_scaled(small) * np.exp(small)
    half = 0.5 * small
    below = (np.log(half) * first + _polynomial(half**2, near) / small) * np.exp(small)
    above = _polynomial(2.0 / large, far) / np.sqrt(large)
    return np.asarray(np.where(values <= 2.0, below, above))
