"""Find where rising functions reach a target, for whole arrays at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray

#: given values and the indices they belong to, returns the function's values
IndexedFunction = Callable[[FloatArray, NDArray[np.intp]], FloatArray]


def bracketed_root(
    function: IndexedFunction,
    low: FloatArray,
    high: FloatArray,
    *,
    at_low: FloatArray | None = None,
    tolerance: float = 1e-7,
) -> FloatArray:
    """Return where functions cross zero from below, by the method of Anderson and Bjorck.

    Parameters
    ----------
    function : ``f(x, index)``: values of the functions ``index`` at ``x``, both 1-D of one length.
    low, high : 1-D; the brackets.
    at_low : Values at ``low`` where they are known, or as good as known.
    tolerance : Absolute, in x.

    Returns
    -------
    ndarray : The root; ``low`` where the function is positive there already, ``high`` where it is
        still negative there, NaN where it is unknown.

    Notes
    -----
    Regula falsi that lessens the value of an end that stays twice (Anderson and Bjorck 1973): it
    never leaves the bracket, so jumps and kinks cost steps but no roots. The last step along the
    secant, shorter than the tolerance, is taken without asking the function again.
    """
    everywhere = np.arange(low.size)
    a, b = low.astype(float).copy(), high.astype(float).copy()
    fa = function(a, everywhere) if at_low is None else at_low
    fb = function(b, everywhere)
    root = np.where(np.isnan(fa) | np.isnan(fb), np.nan, np.where(fa >= 0.0, a, b))
    active = np.flatnonzero((fa < 0.0) & (fb > 0.0))
    a, b, fa, fb = a[active], b[active], fa[active], fb[active]
    for _ in range(100):
        if active.size == 0:
            break
        x = np.clip(b - fb * (b - a) / (fb - fa), np.minimum(a, b), np.maximum(a, b))
        fx = function(x, active)
        crossed = np.sign(fx) != np.sign(fb)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = 1.0 - fx / fb
            secant_step = fx * (b - x) / (fx - fb)  # the next step along the secant
        share = np.where((share > 0.0) & (share < 1.0), share, 0.5)
        a, fa = np.where(crossed, b, a), np.where(crossed, fb, share * fa)
        b, fb = x, fx
        near = np.abs(secant_step) < tolerance
        root[active] = np.where(np.isnan(fx), np.nan, x + np.where(near, secant_step, 0.0))
        going = (fx != 0.0) & ~np.isnan(fx) & ~near & (np.abs(b - a) > tolerance)
        active, a, b, fa, fb = active[going], a[going], b[going], fa[going], fb[going]
    return root
