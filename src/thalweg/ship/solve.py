"""Find where rising functions reach a target, for whole arrays at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
#: given values and the indices they belong to, returns the function's values
Indexed = Callable[[FloatArray, NDArray[np.intp]], FloatArray]


def bracketed_root(
    function: Indexed, low: FloatArray, high: FloatArray, *, tolerance: float = 1e-7
) -> FloatArray:
    """Return where functions cross zero from below, by the Illinois method.

    Parameters
    ----------
    function : callable
        ``f(x, index)``: values of the functions ``index`` at ``x``, both 1-D of one length.
    low, high : ndarray
        1-D; the brackets.
    tolerance : float
        Absolute, in x.

    Returns
    -------
    ndarray
        The root; ``low`` where the function is positive there already, ``high`` where it is still
        negative there, NaN where it is unknown.

    Notes
    -----
    Regula falsi that halves the value of an end that stays twice (Dowell and Jarratt 1971): it
    never leaves the bracket, so jumps and kinks cost steps but no roots.
    """
    everywhere = np.arange(low.size)
    a, b = low.astype(float).copy(), high.astype(float).copy()
    fa, fb = function(a, everywhere), function(b, everywhere)
    root = np.where(np.isnan(fa) | np.isnan(fb), np.nan, np.where(fa >= 0.0, a, b))
    active = np.flatnonzero((fa < 0.0) & (fb > 0.0))
    a, b, fa, fb = a[active], b[active], fa[active], fb[active]
    for _ in range(100):
        if active.size == 0:
            break
        x = np.clip(b - fb * (b - a) / (fb - fa), np.minimum(a, b), np.maximum(a, b))
        fx = function(x, active)
        crossed = np.sign(fx) != np.sign(fb)
        a, fa = np.where(crossed, b, a), np.where(crossed, fb, 0.5 * fa)
        step = np.abs(x - b)
        b, fb = x, fx
        root[active] = np.where(np.isnan(fx), np.nan, x)
        going = (fx != 0.0) & ~np.isnan(fx) & (step > tolerance) & (np.abs(b - a) > tolerance)
        active, a, b, fa, fb = active[going], a[going], b[going], fa[going], fb[going]
    return root
