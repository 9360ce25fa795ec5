"""Cumulative sums that begin with zero: distances along lines, and where groups of rows begin."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def cumulative_sums(values: ArrayLike) -> NDArray[Any]:
    """Return the sums of the first 0, 1, 2 ... n values, (n + 1,).

    Parameters
    ----------
    values : Numbers (n,); True counts 1.

    Returns
    -------
    ndarray : int64 for whole numbers, else float64.
    """
    given = np.asarray(values)
    sums = np.zeros(len(given) + 1, np.int64 if given.dtype.kind in "biu" else np.float64)
    sums[1:] = np.cumsum(given)
    return sums
