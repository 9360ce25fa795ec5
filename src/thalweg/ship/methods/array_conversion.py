"""One small conversion that every formula begins with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def as_float_array(values: ArrayLike) -> Floats:
    """Return values as an array of floats, without copying where they are one already.

    Parameters
    ----------
    values : array_like
        Numbers of any shape.

    Returns
    -------
    ndarray
        The same numbers.
    """
    return np.asarray(values, dtype=float)
