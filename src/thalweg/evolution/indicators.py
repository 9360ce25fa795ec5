"""Quality indicators of fronts: hypervolume, coverage, distances, crowding.

A front is an array (n, 2) of two objectives that are both minimised.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.pareto_fronts import non_dominated_indices
from thalweg.core.types import FloatArray


def non_dominated(points: ArrayLike) -> NDArray[np.bool_]:
    """Return which points no other point dominates.

    Parameters
    ----------
    points : Objectives, (n, 2); rows with NaN or infinity are dominated.

    Returns
    -------
    ndarray of bool, shape (n,) : Of equal points only the first counts.
    """
    points = _checked(points)
    mask = np.zeros(len(points), dtype=bool)
    mask[non_dominated_indices(points[:, 0], points[:, 1])] = True
    return mask


def hypervolume(points: ArrayLike, reference: ArrayLike) -> float:
    """Return the area that a front dominates up to a reference point.

    Parameters
    ----------
    points : Objectives, (n, 2); points that are not below the reference in both add nothing.
    reference : The largest values that count, (2,).

    Notes
    -----
    A sweep over the first objective, O(n log n) (Zitzler & Thiele 1999, "Multiobjective
    evolutionary algorithms: a comparative case study and the strength Pareto approach").
    """
    points, corner = _checked(points), _checked(np.reshape(reference, (1, -1)))[0]
    if not np.isfinite(corner).all():
        raise InputError(
            f"The reference point {tuple(corner.tolist())} of a hypervolume is not finite.",
            "It holds the largest value of each objective that still counts.",
            "Give two finite numbers.",
        )
    front = points[non_dominated_indices(points[:, 0], points[:, 1])]
    front = front[(front < corner).all(axis=1)]
    ends = np.append(front[1:, 0], corner[0])
    return float(((ends - front[:, 0]) * (corner[1] - front[:, 1])).sum())


def c_metric(first: ArrayLike, second: ArrayLike) -> float:
    """Return the share of the second front that the first covers.

    A point is covered by one that is not worse in any objective (Zitzler & Thiele 1999); the share
    is of the second front's points.

    Parameters
    ----------
    first, second : array_like, shape (n, 2)

    Returns
    -------
    float : 0 to 1.

    Raises
    ------
    InputError : If the second front is empty.
    """
    a, b = _checked(first), _checked(second)
    if not len(b):
        raise InputError(
            "The second front is empty.", "Coverage is a share of its points.", "Give points."
        )
    covered = (a[:, None, :] <= b[None, :, :]).all(axis=2).any(axis=0)
    return float(covered.mean())


def generational_distance(
    front: ArrayLike, target: ArrayLike, *, scale: ArrayLike | None = None
) -> float:
    """Return the mean distance of a front's points to the nearest point of another.

    Parameters
    ----------
    front, target : array_like, shape (n, 2) and (m, 2)
    scale : What each objective is divided by first, (2,); by default its range over the target (1
        where that is zero).

    Notes
    -----
    Distances are not squared (Van Veldhuizen 1999 with p = 1).
    """
    a, b = _checked(front), _checked(target)
    if not len(a) or not len(b):
        raise InputError(
            "One of the fronts is empty.", "Distances are between points.", "Give two fronts."
        )
    unit = np.ptp(b, axis=0) if scale is None else np.asarray(scale, float)
    unit = np.where(unit > 0.0, unit, 1.0)
    apart = (a[:, None, :] - b[None, :, :]) / unit
    return float(np.sqrt((apart * apart).sum(axis=2)).min(axis=1).mean())


def crowding_distance(points: ArrayLike) -> FloatArray:
    """Return the crowding distance of each point of a front.

    The sum over the objectives of the gap between the neighbours on both sides, as a share of
    the objective's range; infinite at the ends (Deb et al. 2002, "A fast and elitist
    multiobjective genetic algorithm: NSGA-II", section III.B).
    """
    points = _checked(points)
    distance = np.zeros(len(points))
    for values in points.T:
        order = np.argsort(values, kind="stable")
        width = values[order[-1]] - values[order[0]] if len(order) else 0.0
        distance[order[[0, -1]] if len(order) else []] = np.inf
        if width > 0.0:
            distance[order[1:-1]] += (values[order[2:]] - values[order[:-2]]) / width
    return distance


def _checked(points: ArrayLike) -> FloatArray:
    array = np.asarray(points, dtype=float)
    if array.size == 0:
        return np.empty((0, 2))
    if array.ndim != 2 or array.shape[1] != 2:
        raise InputError(
            f"Points of a front have the shape {array.shape}.",
            "They are rows of two objectives, shape (n, 2).",
            "Give one row for each point.",
        )
    return array
