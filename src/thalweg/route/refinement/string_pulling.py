"""String pulling: the best line through a subset of the waypoints."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.cheapest_chain import cheapest_chain
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.time_evaluator import LookedUpLegs, TimeEvaluator, TrackBatch

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
    fixed = np.flatnonzero(line.required_points(evaluator))
    shortcuts = _shortcuts(len(line), fixed, skip)
    looked_up = _looked_up(line, evaluator, shortcuts)
    arrive: dict[int, FloatArray] = {}  # at the points after each one

    def steps(here: int, previous: int) -> tuple[IntArray, FloatArray]:
        reached = float(arrive[previous][here - previous - 1]) if here else line.depart
        there = shortcuts[here]
        batch = _shortcut_batch(line, here, there, max(reached, line.leave[here]))
        if looked_up is not None and isinstance(evaluator, TimeEvaluator):
            ends, cost = evaluator.sail(batch, looked_up=looked_up[here])
        else:
            ends, cost = evaluator.sail(batch)
        arrive[here] = ends[:, -1]
        return there, (cost if evaluator.by_length else cost - reached) + penalty

    return cheapest_chain(len(line), steps, tolerance=1e-9)


def _shortcuts(count: int, fixed: IntArray, skip: int) -> list[IntArray]:
    """Return the points to which a leg may lead from each point but the last."""
    next_fixed = fixed[np.searchsorted(fixed, np.arange(count - 1), side="right")]
    return [np.arange(here + 1, min(here + skip, last) + 1) for here, last in enumerate(next_fixed)]


def _looked_up(
    line: Polyline, evaluator: PolylineEvaluator, shortcuts: list[IntArray]
) -> list[LookedUpLegs] | None:
    """Look up all shortcuts at once: land and depth are the same at any time.

    None where the evaluator looks legs up itself.
    """
    if not isinstance(evaluator, TimeEvaluator):
        return None
    size = [len(there) for there in shortcuts]
    ends = np.stack([np.repeat(np.arange(len(size)), size), np.concatenate(shortcuts)], axis=1)
    blocked, charted = evaluator.look_up_legs(line.lat[ends], line.lon[ends])
    parts = np.cumsum(size)[:-1]
    none = [None] * len(size)
    return list(
        zip(
            none if blocked is None else np.split(blocked, parts),
            none if charted is None else np.split(charted, parts),
        )
    )


def _shortcut_batch(line: Polyline, here: int, there: IntArray, leave: float) -> TrackBatch:
    shape = (len(there), 2)
    lat, lon = np.empty(shape), np.empty(shape)
    lat[:, 0], lon[:, 0] = line.lat[here], line.lon[here]
    lat[:, 1], lon[:, 1] = line.lat[there], line.lon[there]
    setting = np.full((len(there), 1), line.setting[here])
    return TrackBatch(lat, lon, np.full(shape, -math.inf), setting, np.full(len(there), leave))
