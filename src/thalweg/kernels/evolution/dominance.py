"""Ranks of a population by two objectives: fronts, crowding, strength and density."""

import math

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free
from thalweg.kernels.compilation.jit import jit


@allocation_free
def assign_fronts(order, second, tails, rank):
    """Assign every point to its non-dominated front.

    Parameters
    ----------
    order : int64[n]
        Points in ascending order of the first objective, equal ones by the second.
    second : float64[N]
        The second objective.
    tails : float64[n]
        Work space.
    rank : int64[N]
        Filled for the points in ``order``: 0 for the first front. Of equal points one is taken to
        dominate the next.

    Returns
    -------
    int : Number of fronts.

    Notes
    -----
    In that order a point is dominated by a front if and only if the front's last point is not
    worse in the second objective, and the fronts' last values ascend: a binary search for each
    point, O(n log n) (Jensen 2003, "Reducing the run-time complexity of multiobjective EAs").
    """
    fronts = 0
    for place in range(order.shape[0]):
        i = order[place]
        value = second[i]
        low, high = 0, fronts
        while low < high:
            middle = (low + high) >> 1
            if tails[middle] > value:
                high = middle
            else:
                low = middle + 1
        tails[low] = value
        rank[i] = low
        fronts = max(fronts, low + 1)
    return fronts


@allocation_free
def assign_crowding(order, first, second, rank, ends, crowding):
    """Fill the crowding distance of every point within its front.

    ``order`` as for `assign_fronts`; ``ends`` int64[fronts, 4], filled with -1, is work space.
    """
    for place in range(order.shape[0]):
        front = rank[order[place]]
        if ends[front, 0] < 0:
            ends[front, 0] = order[place]
        ends[front, 1] = order[place]
    for place in range(order.shape[0]):
        i = order[place]
        front = rank[i]
        before, last = ends[front, 2], ends[front, 3]
        crowding[i] = math.inf
        if last >= 0 and before >= 0:
            wide = first[ends[front, 1]] - first[ends[front, 0]]
            high = second[ends[front, 0]] - second[ends[front, 1]]
            crowding[last] = 0.0
            if wide > 0.0:
                crowding[last] += (first[i] - first[before]) / wide
            if high > 0.0:
                crowding[last] += (second[before] - second[i]) / high
        ends[front, 2], ends[front, 3] = last, i


@jit
def strengths(first, second, violation, strength, raw):
    """Fill how many points each dominates, and the summed strength of those that dominate it.

    A feasible point dominates every other that is not, of two infeasible
    ones the one with the smaller violation.
    """
    n = first.shape[0]
    dominates = np.zeros((n, n), dtype=np.bool_)
    for i in range(n):
        for j in range(n):
            if violation[i] != violation[j]:
                dominates[i, j] = violation[i] < violation[j]
            elif first[i] <= first[j] and second[i] <= second[j]:
                dominates[i, j] = first[i] < first[j] or second[i] < second[j]
        strength[i] = 0.0
        for j in range(n):
            strength[i] += dominates[i, j]
    for i in range(n):
        raw[i] = 0.0
        for j in range(n):
            if dominates[j, i]:
                raw[i] += strength[j]


@jit
def neighbour_distances(first, second):
    """Return the sorted distances of every point to all others, (n, n - 1)."""
    n = first.shape[0]
    out = np.empty((n, max(n - 1, 0)))
    for i in range(n):
        k = 0
        for j in range(n):
            if j != i:
                dx, dy = first[i] - first[j], second[i] - second[j]
                out[i, k] = math.sqrt(dx * dx + dy * dy)
                k += 1
        out[i] = np.sort(out[i])
    return out


@jit
def truncate(first, second, keep):
    """Return the points that remain when the most crowded one is removed repeatedly.

    The next to go is the point whose sorted distances to the others left are lexicographically
    smallest (Zitzler, Laumanns & Thiele 2001, "SPEA2").
    """
    n = first.shape[0]
    left = np.ones(n, dtype=np.bool_)
    near = neighbour_distances(first, second)
    size = n - 1
    for _ in range(n - keep):
        worst = -1
        for i in range(n):
            if not left[i]:
                continue
            if worst < 0:
                worst = i
                continue
            for k in range(size):
                if near[i, k] != near[worst, k]:
                    if near[i, k] < near[worst, k]:
                        worst = i
                    break
        left[worst] = False
        for i in range(n):
            if left[i]:
                dx, dy = first[i] - first[worst], second[i] - second[worst]
                separation = math.sqrt(dx * dx + dy * dy)
                k = np.searchsorted(near[i, :size], separation)
                for q in range(k, size - 1):
                    near[i, q] = near[i, q + 1]
        size -= 1
    return left
