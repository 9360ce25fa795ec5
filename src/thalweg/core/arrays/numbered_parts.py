"""Parts of legs or of other things, numbered."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import IntArray


def numbered_parts(count: ArrayLike) -> tuple[IntArray, IntArray]:
    """Return of every part of legs in given counts (n,) its leg, and its number in it from 0."""
    parts = np.asarray(count, np.int64)
    leg = np.repeat(np.arange(len(parts)), parts)
    return leg, np.arange(len(leg)) - np.repeat(np.cumsum(parts) - parts, parts)
