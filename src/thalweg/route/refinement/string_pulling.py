"""String pulling: the best line through a subset of the waypoints."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.cheapest_chain import cheapest_chain
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.time_evaluator import TrackBatch

_MAX_SKIPPED = 48  # waypoints that a leg may skip
_PASSES = 4


def string_pull(
    line: Polyline,
    evaluator: PolylineEvaluator,
    *,
    penalty: float = 0.0,
    skip: int = _MAX_SKIPPED,
) -> Polyline:
    """Return the best line through a subset of the waypoints, in their order.

    Parameters
    ----------
    penalty : Cost of a waypoint [unit of the cost]: a line with fewer waypoints may be worse by
        this much for each that is removed.
    skip : Waypoints that a leg may skip.

    Returns
    -------
    Polyline : Through the points where the setting changes, unless the evaluator chooses settings.
        Not worse than the line, except for the penalty; the line itself if it cannot be sailed.

    Notes
    -----
    An exact search for the earliest arrival (or least length) on the directed graph of all legs
    from a waypoint to a later one. For time this is exact because a ship that may slow down never
    loses by an earlier arrival. Unlike the removal of one waypoint after the other it finds
    shortcuts past many.
    """
    for _ in range(_PASSES):
        index = _best_subset(line, evaluator, penalty, skip)
        if index is None or len(index) == len(line):
            return line
        before, line = len(line), line.kept(index)
        if before <= skip:
            return line
    return line


def _best_subset(
    line: Polyline, evaluator: PolylineEvaluator, penalty: float, skip: int
) -> IntArray | None:
    count = len(line)
    fixed = np.flatnonzero(line.required_points(evaluator))
    arrive: dict[int, FloatArray] = {}  # at the points after each one

    def steps(here: int, previous: int) -> tuple[IntArray, FloatArray]:
        reached = float(arrive[previous][here - previous - 1]) if here else line.depart
        there = np.arange(here + 1, min(count, here + 1 + skip))
        there = there[: int(np.searchsorted(there, fixed[fixed > here][0], side="right"))]
        batch = _shortcut_batch(line, here, there, max(reached, line.leave[here]))
        ends, cost = evaluator.sail(batch)
        arrive[here] = ends[:, -1]
        return there, (cost if evaluator.by_length else cost - reached) + penalty

    return cheapest_chain(count, steps, tolerance=1e-9)


def _shortcut_batch(line: Polyline, here: int, there: IntArray, leave: float) -> TrackBatch:
    shape = (len(there), 2)
    lat, lon = np.empty(shape), np.empty(shape)
    lat[:, 0], lon[:, 0] = line.lat[here], line.lon[here]
    lat[:, 1], lon[:, 1] = line.lat[there], line.lon[there]
    setting = np.full((len(there), 1), line.setting[here])
    return TrackBatch(lat, lon, np.full(shape, -math.inf), setting, np.full(len(there), leave))
