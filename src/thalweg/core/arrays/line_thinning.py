"""Lines with fewer points: many lines at once, after Douglas and Peucker (1973)."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray


class InnerPoints(NamedTuple):
    """The points between pairs of others, pair after pair.

    Attributes
    ----------
    point : The points, (k,).
    pair : The pair of each of them, (k,).
    begins : Where the points of each pair begin in these, (m,).
    """

    point: IntArray
    pair: IntArray
    begins: IntArray


def inner_points(first: IntArray, last: IntArray) -> InnerPoints:
    """Return the points between pairs of others.

    Parameters
    ----------
    first, last : Points, with one or more between the two of each pair, (m,).
    """
    count = last - first - 1
    begins = np.cumsum(count) - count
    pair = np.repeat(np.arange(len(first)), count)
    point = np.arange(len(pair)) - begins[pair] + first[pair] + 1
    return InnerPoints(point, pair, begins)


def mark_needed_points(
    keep: BoolArray,
    first: IntArray,
    last: IntArray,
    *,
    tolerance: float,
    distances: Callable[[IntArray, IntArray, InnerPoints], FloatArray],
    must_split: Callable[[IntArray, IntArray], BoolArray] | None = None,
) -> None:
    """Mark the points without which lines would leave a tolerance.

    All parts of all lines are divided together, level by level, at their farthest points.

    Parameters
    ----------
    keep : (n,)
        Set to True at the points that are needed.
    first, last : (m,)
        The first and the last point of each line.
    tolerance : Greatest distance of a point that is left out from the line [m].
    distances : callable
        Distances [m] of points (k,) from the lines between their pairs of first and last points.
    must_split : callable, optional
        Which pairs of first and last points cannot be joined, however near the points between are.

    References
    ----------
    D. H. Douglas, T. K. Peucker, Cartographica 10 (2) (1973).
    """
    while (wide := last - first > 1).any():
        first, last = first[wide], last[wide]
        between = inner_points(first, last)
        away = distances(first, last, between)
        most = np.maximum.reduceat(away, between.begins)
        reached = np.flatnonzero(away == most[between.pair])
        _, where = np.unique(between.pair[reached], return_index=True)
        split = most > tolerance
        if must_split is not None:
            split |= must_split(first, last)
        at = between.point[reached[where]][split]
        keep[at] = True
        first, last = np.append(first[split], at), np.append(at, last[split])


def distances_from_arcs(
    vectors: FloatArray, first: IntArray, last: IntArray, between: InnerPoints
) -> FloatArray:
    """Return the distances of points from the arcs of great circles between others.

    Parameters
    ----------
    vectors : (n, 3)
        Positions, from the middle of the earth [m].
    first, last : (m,)
        Ends of the arcs.
    between : The points, k in number.

    Returns
    -------
    ndarray (k,) : Distances [m], positive; beyond the ends of an arc those to the nearer end.
    """
    a, b, pair = vectors[first], vectors[last], between.pair
    normal = np.cross(a, b)
    size = np.sqrt(np.sum(normal**2, axis=1))
    normal /= np.where(size > 0.0, size, 1.0)[:, None]
    chord = b - a
    squared = np.sum(chord**2, axis=1)
    p = vectors[between.point]
    away = np.einsum("ij,ij->i", p, normal[pair])
    np.abs(away, out=away)
    p -= a[pair]
    along = np.einsum("ij,ij->i", p, chord[pair])
    along /= np.where(squared > 0.0, squared, 1.0)[pair]
    beyond = np.flatnonzero((along < 0.0) | (along > 1.0) | (squared[pair] <= 0.0))
    if len(beyond):
        at, to = between.point[beyond], pair[beyond]
        near = [np.sqrt(np.sum((vectors[at] - end[to]) ** 2, axis=1)) for end in (a, b)]
        away[beyond] = np.minimum(*near)
    return np.asarray(away)
