"""Conversion of arguments to arrays of floats."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray


def as_float_array(values: ArrayLike) -> FloatArray:
    """Return values as an array of floats; an array of floats is returned without a copy.

    Parameters
    ----------
    values : Numbers of any shape.

    Returns
    -------
    ndarray : The same numbers.
    """
    return np.asarray(values, dtype=float)
