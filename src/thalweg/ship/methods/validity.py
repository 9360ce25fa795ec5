"""Notes on methods that are used outside the range of their data."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


@dataclass(frozen=True)
class RangeNote:
    """One quantity outside the range of a method.

    Attributes
    ----------
    method : Name of the method.
    quantity : What is outside, for example ``"Froude number"``.
    value : The value farthest outside.
    low, high : The range of the method; infinite where it has no bound.
    """

    method: str
    quantity: str
    value: float
    low: float
    high: float

    def __str__(self) -> str:
        bounds = f"outside {self.low:.4g} to {self.high:.4g}"
        if math.isinf(self.high):
            bounds = f"outside {self.low:.4g} and more"
        elif math.isinf(self.low):
            bounds = f"outside {self.high:.4g} and less"
        return f"{self.method}: {self.quantity} is {self.value:.4g}, {bounds}"


def range_notes(
    method: str, ranges: Mapping[str, tuple[ArrayLike, float, float]]
) -> list[RangeNote]:
    """Compare quantities with their ranges.

    Parameters
    ----------
    method : Name of the method.
    ranges : mapping of str to (values, low, high)
        Values are scalars or arrays; NaN values are left out.

    Returns
    -------
    list of RangeNote : At most two notes for each quantity: the lowest value below its range and
        the highest value above it.
    """
    notes = []
    for quantity, (values, low, high) in ranges.items():
        known = np.asarray(values, dtype=float).ravel()
        known = known[~np.isnan(known)]
        if known.size == 0:
            continue
        least, most = float(known.min()), float(known.max())
        if least < low:
            notes.append(RangeNote(method, quantity, least, low, high))
        if most > high:
            notes.append(RangeNote(method, quantity, most, low, high))
    return notes
