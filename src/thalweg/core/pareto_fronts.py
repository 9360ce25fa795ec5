"""Fronts of two objectives that are both minimised: filter, lower hull, evenly spaced points."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray, IntArray

ROUNDING_TOLERANCE = 1e-9  #: relative improvement that may be rounding of two equal values


def non_dominated_indices(
    first: ArrayLike, second: ArrayLike, *, tolerance: float = 0.0
) -> IntArray:
    """Return the indices of the points that no other point dominates, by ascending first objective.

    Parameters
    ----------
    first, second : The two objectives, (n,). A point with NaN or infinity is dominated.
    tolerance : float
        Relative improvement of the second objective below which a point counts as dominated.

    Returns
    -------
    int64 array : Of equal points only the first.

    Notes
    -----
    A sweep in the order of the first objective, O(n log n) (Kung, Luccio & Preparata 1975, "On
    finding the maxima of a set of vectors").
    """
    x, y = np.asarray(first, float), np.asarray(second, float)
    finite = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    order = finite[np.lexsort((y[finite], x[finite]))]
    ranked = y[order]
    if tolerance <= 0.0:
        least = np.concatenate([[np.inf], np.minimum.accumulate(ranked)[:-1]])[: len(ranked)]
        return np.asarray(order[ranked < least], dtype=np.int64)
    indices: list[int] = []
    lowest = np.inf
    for index, value in zip(order, ranked):
        if value * (1.0 + tolerance) < lowest:
            indices.append(int(index))
            lowest = value
    return np.array(indices, dtype=np.int64)


def lower_hull(first: ArrayLike, second: ArrayLike) -> IntArray:
    """Return the indices of the points on the lower convex hull, by ascending first objective.

    Parameters
    ----------
    first, second : Finite coordinates, (n,).

    Notes
    -----
    The lower half of Andrew's monotone chain (1979, "Another efficient algorithm for convex hulls
    in two dimensions").
    """
    x, y = np.asarray(first, float), np.asarray(second, float)
    hull: list[int] = []
    for i in np.lexsort((y, x)).tolist():
        if hull and x[hull[-1]] == x[i]:
            continue
        while len(hull) > 1:
            a, b = hull[-2], hull[-1]
            if (x[b] - x[a]) * (y[i] - y[a]) > (y[b] - y[a]) * (x[i] - x[a]):
                break
            hull.pop()
        hull.append(i)
    return np.array(hull, dtype=np.int64)


def falling_hull(first: ArrayLike, second: ArrayLike) -> IntArray:
    """Return the indices of the points on the lower convex hull up to the least second objective.

    Parameters
    ----------
    first, second : Finite coordinates, (n,).
    """
    hull, y = lower_hull(first, second), np.asarray(second, float)
    return hull[: int(np.argmin(y[hull])) + 1] if len(hull) else hull


def higher_of_two_fronts(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the pointwise maximum of two lower bounds of a front, which is one as well.

    Parameters
    ----------
    first, second : float64 array (2, n)
        Points to be joined by lines, by ascending first objective; nothing is possible before the
        first of them, and the bound is level after the last.

    Returns
    -------
    float64 array (2, k)
        From the later of the two first points on.
    """
    if not (first.size and second.size):
        return second if second.size else first
    x = np.union1d(first[0], second[0])
    x = np.append(max(first[0, 0], second[0, 0]), x[x > max(first[0, 0], second[0, 0])])
    lead = np.interp(x, *first) - np.interp(x, *second)
    k = np.flatnonzero(lead[:-1] * lead[1:] < 0.0)  # the lines cross between k and k + 1
    crossings = x[k] + (x[k + 1] - x[k]) * lead[k] / (lead[k] - lead[k + 1])
    x = np.union1d(x, crossings)
    return np.array([x, np.maximum(np.interp(x, *first), np.interp(x, *second))])


def length_along_front(first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Return how far along a front each of its points is, both objectives scaled to their ranges.

    Parameters
    ----------
    first, second : A front in the order of its first objective, (n,).

    Returns
    -------
    float64 array (n,)
        0 at the first point; the length of the broken line through the points before it elsewhere.
    """
    x, y = (np.asarray(values, float) for values in (first, second))
    dx, dy = (np.diff(values) / max(float(np.ptp(values)), 1e-12) for values in (x, y))
    return cumulative_sums(np.hypot(dx, dy))


def evenly_spaced_subset(first: ArrayLike, second: ArrayLike, count: int) -> IntArray:
    """Return the indices of at most ``count`` points of a front: its ends, and evenly between.

    Parameters
    ----------
    first, second : The two objectives of a front, in any order, (n,).
    count : Number of points, at least 2.

    Returns
    -------
    int64 array : By ascending first objective; all points where there are no more than ``count``.
    """
    x, y = np.asarray(first, float), np.asarray(second, float)
    order = np.argsort(x, kind="stable")
    if len(order) <= count:
        return order
    along = length_along_front(x[order], y[order])
    wanted = np.linspace(0.0, along[-1], count)
    return np.asarray(order[np.unique(np.abs(along - wanted[:, None]).argmin(axis=1))])
