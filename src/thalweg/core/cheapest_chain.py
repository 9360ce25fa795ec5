"""The cheapest chain of ascending indices: string pulling over legs that skip waypoints."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from thalweg.core.types import FloatArray, IntArray

#: Given an index and the one before it in the chain (-1: none), the later indices that can be
#: reached and the prices of the steps; +inf where there is no step.
Steps: TypeAlias = Callable[[int, int], tuple[IntArray, FloatArray]]


def cheapest_chain(count: int, steps: Steps, *, tolerance: float = 0.0) -> IntArray | None:
    """Return the cheapest chain of ascending indices from 0 to ``count - 1``; None if none exists.

    Parameters
    ----------
    count : Number of indices.
    steps : Called once for every index that can be reached, in ascending order.
    tolerance : Relative gain below which a chain that was found earlier stays.

    Returns
    -------
    int64 array or None

    Notes
    -----
    Bellman's recursion on a graph without cycles. Where prices depend on the chain so far, such as
    by a time of departure, the result is exact if to be cheaper earlier is never worse later.
    """
    label, predecessor = np.full(count, np.inf), np.full(count, -1, dtype=np.int64)
    label[0] = 0.0
    for here in np.arange(count - 1).tolist():
        if not np.isfinite(label[here]):
            continue
        there, price = steps(here, int(predecessor[here]))
        total = label[here] + price
        slack = tolerance * np.where(np.isfinite(total), np.abs(total), 0.0)
        better = total + slack < label[there]
        label[there[better]] = total[better]
        predecessor[there[better]] = here
    if not np.isfinite(label[-1]):
        return None
    chain = [count - 1]
    while chain[-1] > 0:
        chain.append(int(predecessor[chain[-1]]))
    return np.array(chain[::-1], dtype=np.int64)
