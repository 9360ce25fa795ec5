"""Mean second-order forces in a wave spectrum by a fixed quadrature.

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

    Notes
    -----
    .. math::
        q = (\omega_p / \omega)^4, \quad r = \exp\left(-\frac{(\omega - \omega_p)^2}{2
            \sigma^2 \omega_p^2}\right), \quad \sigma = 0.07\ (\omega \le \omega_p),\ 0.09\
            (\omega > \omega_p)

    References
    ----------
    DNV-RP-C205; the factor in brackets belongs to JONSWAP only.
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
    low, high : Ends of the range, above 0.
    step : Step of the natural logarithm [-].

    Returns
    -------
    ndarray : Ascending values from ``low`` to ``high``.
    """
    first, last = np.floor(np.log(low) / step), np.ceil(np.log(high) / step)
    return np.asarray(np.exp(step * np.arange(first, last + 1.0)))


def in_blocks(
    function: Callable[..., FloatArray], *arguments: ArrayLike, block: int = _BLOCK_SIZE
) -> FloatArray:
    """Apply a function of flat arrays block by block, so that memory stays small.

    Parameters
    ----------
    function : Takes as many 1-d arrays as there are arguments and returns one of their length; an
        argument of one element comes as one element.
    *arguments : Broadcast against each other.
    block : Elements at a time.

    Returns
    -------
    ndarray : Result in the broadcast shape.
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
