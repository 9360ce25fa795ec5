"""Comparing scored tracks: feasibility first, then fronts, crowding, strength and density."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.evolution import dominance
from thalweg.kernels.leg.population_sailing import COST, TIME, VIOLATION
from thalweg.route.refinement.scored_tracks import feasible_front


def ranks_and_crowding(scores: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return (rank, crowding distance) of scores (N, 3).

    Feasible tracks are sorted into non-dominated fronts, 0 the first; those with violations
    come after them, the smallest violation first. Of equal ones the first is the better.
    """
    n = len(scores)
    rank, crowding = np.zeros(n, dtype=np.int64), np.full(n, math.inf)
    first, second = (np.ascontiguousarray(scores[:, c]) for c in (TIME, COST))
    feasible = scores[:, VIOLATION] == 0.0
    order = np.lexsort((second, first))
    order = order[feasible[order]]
    fronts = dominance.assign_fronts(order, second, np.empty(len(order)), rank)
    ends = np.full((max(fronts, 1), 4), -1, dtype=np.int64)
    dominance.assign_crowding(order, first, second, rank, ends, crowding)
    broken = np.flatnonzero(~feasible)
    worst = broken[np.argsort(scores[broken, VIOLATION], kind="stable")]
    rank[worst] = fronts + np.arange(len(worst))
    return rank, crowding


def select_survivors(scores: FloatArray, size: int) -> tuple[IntArray, IntArray, FloatArray]:
    """Return (indices of the ``size`` best, rank, crowding): NSGA-II's choice of survivors.

    Parameters
    ----------
    scores : float64 array (N, 3)

    Returns
    -------
    chosen : int64 array (size,)
    rank : int64 array (N,)
    crowding : float64 array (N,)
    """
    rank, crowding = ranks_and_crowding(scores)
    return np.lexsort((-crowding, rank))[:size], rank, crowding


def strength_fitness(scores: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return SPEA2's (strength S, raw fitness R, fitness F) of scores (N, 3).

    F is R plus the density 1 / (distance to the k-th neighbour + 2), k = floor(sqrt(N)); values
    below 1 are not dominated (Zitzler, Laumanns & Thiele 2001). Distances are between objectives
    as given.
    """
    first, second, violation = (np.ascontiguousarray(scores[:, c]) for c in range(3))
    strength, raw = np.empty(len(scores)), np.empty(len(scores))
    dominance.strengths(first, second, violation, strength, raw)
    near = dominance.neighbour_distances(first, second)
    k = min(math.isqrt(len(scores)), near.shape[1])
    density = 1.0 / (near[:, k - 1] + 2.0) if k else np.full(len(scores), 0.5)
    return strength, raw, raw + density


def least_crowded_front(scores: FloatArray, size: int) -> IntArray:
    """Return at most ``size`` tracks of the front, by ascending time.

    Tracks whose removal loses the least dominated area are removed first; both ends are kept.

    Parameters
    ----------
    scores : float64 array (N, 3)
    size : Largest number of tracks, at least 2.

    Returns
    -------
    int64 array
    """
    front = feasible_front(scores)
    time, cost = scores[front, TIME], scores[front, COST]
    selected = np.arange(len(front))
    while len(selected) > max(size, 2):
        t, c = time[selected], cost[selected]
        lost = (t[2:] - t[1:-1]) * (c[:-2] - c[1:-1])
        selected = np.delete(selected, 1 + int(np.argmin(lost)))
    return front[selected]


def normalised(scores: FloatArray) -> FloatArray:
    """Return scores with time and cost as shares of their ranges among the feasible."""
    out = scores.copy()
    among = scores[scores[:, VIOLATION] == 0.0] if (scores[:, VIOLATION] == 0.0).any() else scores
    for c in (TIME, COST):
        low, high = among[:, c].min(), among[:, c].max()
        out[:, c] = (scores[:, c] - low) / (high - low if high > low else 1.0)
    return out


def dominates(a: FloatArray, b: FloatArray) -> BoolArray:
    """Return where scores dominate others, feasibility first; the last axis holds the scores.

    Parameters
    ----------
    a, b : ndarray (..., 3)
        Scores; they broadcast together.

    Returns
    -------
    bool array (...) : Where ``a`` dominates ``b``.
    """
    less = a[..., VIOLATION] < b[..., VIOLATION]
    same = a[..., VIOLATION] == b[..., VIOLATION]
    no_worse = (a[..., TIME] <= b[..., TIME]) & (a[..., COST] <= b[..., COST])
    better = (a[..., TIME] < b[..., TIME]) | (a[..., COST] < b[..., COST])
    return np.asarray(less | (same & no_worse & better))
