"""String pulling: the best line through a subset of the waypoints."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.time_evaluator import TrackBatch

_MAX_HOP = 48  # waypoints a single hop may skip
_PASSES = 4


def string_pull(line: Polyline, evaluator: PolylineEvaluator, *, penalty: float = 0.0) -> Polyline:
    """Return the best line through a subset of the waypoints, in their order.

    Parameters
    ----------
    line : Polyline
    evaluator : TimeEvaluator or CostEvaluator
    penalty : float
        Cost of a waypoint [unit of the cost]: a line with fewer waypoints may be worse by this much
        for each that is removed.

    Returns
    -------
    Polyline
        Through the points where the setting changes, unless the evaluator chooses settings.
        Not worse than the line, except for the penalty; the line itself if it cannot be sailed.

    Notes
    -----
    An exact search for the earliest arrival (or least length) on the directed graph of all hops
    from a waypoint to a later one. For time this is exact because a ship that may slow down never
    loses by an earlier arrival. Unlike the removal of one waypoint after the other it finds
    shortcuts past many.
    """
    for _ in range(_PASSES):
        index = _best_subset(line, evaluator, penalty)
        if index is None or len(index) == len(line):
            return line
        before, line = len(line), line.kept(index)
        if before <= _MAX_HOP:
            return line
    return line


def _best_subset(
    line: Polyline, evaluator: PolylineEvaluator, penalty: float
) -> NDArray[np.int64] | None:
    count = len(line)
    arrive, label = np.full(count, math.inf), np.full(count, math.inf)
    came_from = np.full(count, -1, dtype=np.int64)
    arrive[0], label[0] = line.depart, 0.0
    held = np.flatnonzero(line.required_points(evaluator))
    for here in range(count - 1):
        if not math.isfinite(label[here]):
            continue
        there = np.arange(here + 1, min(count, here + 1 + _MAX_HOP))
        leave = max(arrive[here], line.leave[here])
        there = there[: int(np.searchsorted(there, held[held > here][0], side="right"))]
        ends, cost = evaluator.sail(_shortcut_batch(line, here, there, leave))
        spent = cost if evaluator.by_length else cost - arrive[here]
        total = label[here] + spent + penalty
        slack = 1e-9 * np.where(np.isfinite(total), np.abs(total), 0.0)
        better = total + slack < label[there]
        label[there[better]] = total[better]
        arrive[there[better]] = ends[better, -1]
        came_from[there[better]] = here
    if not math.isfinite(label[-1]):
        return None
    chain = [count - 1]
    while chain[-1] > 0:
        chain.append(int(came_from[chain[-1]]))
    return np.array(chain[::-1], dtype=np.int64)


def _shortcut_batch(
    line: Polyline, here: int, there: NDArray[np.int64], leave: float
) -> TrackBatch:
    shape = (len(there), 2)
    lat, lon = np.empty(shape), np.empty(shape)
    lat[:, 0], lon[:, 0] = line.lat[here], line.lon[here]
    lat[:, 1], lon[:, 1] = line.lat[there], line.lon[there]
    setting = np.full((len(there), 1), line.setting[here])
    return TrackBatch(lat, lon, np.full(shape, -math.inf), setting, np.full(len(there), leave))
