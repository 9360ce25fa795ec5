"""Feeling one's way along obstacles: waypoints try steps in all directions, ever smaller."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, rough_lengths
from thalweg.core.types import FloatArray
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.polyline import Polyline
from thalweg.route.evaluators.time_evaluator import (
    TimeEvaluator,
    TrackBatch,
)

_DIRECTIONS = 8
_INITIAL_STEP_SHARE = 0.3  # first step as a share of the shorter leg beside a waypoint
_GOLDEN_ANGLE = math.pi * (3.0 - math.sqrt(5.0))  # turns the compass differently every round


def compass_search(
    line: Polyline,
    evaluator: TimeEvaluator | CostEvaluator,
    *,
    rounds: int = 30,
    smallest: float = 1.0,
) -> Polyline:
    """Return a line with waypoints moved, one by one, wherever that lowers the cost.

    Parameters
    ----------
    line : Line
        One that can be sailed.
    evaluator : Sailor
    rounds : int
        Rounds over all waypoints at most.
    smallest : float
        The work ends when all steps are below this [m].

    Notes
    -----
    A compass search for each waypoint on its two legs, every other waypoint at a time. To be
    earlier at the next waypoint is never worse at the goal, so two legs are enough to judge. It
    needs no derivatives, so coasts, closed cells and depth contours may bind.
    """
    if len(line) < 3 or not math.isfinite(evaluator.sail(line.batch())[1][0]):
        return line
    lengths = rough_lengths(line.lat, line.lon)
    step = np.zeros(len(line))
    step[1:-1] = _INITIAL_STEP_SHARE * np.minimum(lengths[:-1], lengths[1:])
    step[line.required_points(evaluator)] = 0.0
    for number in range(rounds):
        for colour in (1, 2):
            moving = np.arange(colour, len(line) - 1, 2)
            moving = moving[step[moving] >= max(smallest, 1e-9)]
            if moving.size:
                line, moved = _try_steps(line, evaluator, moving, step, number)
                step[moving] *= np.where(moved, 1.3, 0.5)
        if step.max() < smallest:
            break
    return line


def _try_steps(
    line: Polyline,
    evaluator: TimeEvaluator | CostEvaluator,
    moving: np.ndarray,
    step: FloatArray,
    number: int,
) -> tuple[Polyline, np.ndarray]:
    """Move each of some waypoints to the best of its trial places; tell which moved."""
    angle = number * _GOLDEN_ANGLE + np.arange(_DIRECTIONS) * (2.0 * math.pi / _DIRECTIONS)
    east = np.concatenate([[0.0], np.sin(angle)])
    north = np.concatenate([[0.0], np.cos(angle)])
    trials = len(east)
    arrive, _ = evaluator.sail(line.batch())
    lat = np.repeat(_adjacent_triples(line.lat, moving), trials, axis=0)
    lon = np.repeat(_adjacent_triples(line.lon, moving), trials, axis=0)
    size = np.repeat(step[moving], trials)
    lat[:, 1] += size * np.tile(north, len(moving)) / METRES_PER_DEGREE
    scale = METRES_PER_DEGREE * np.cos(np.radians(lat[:, 0]))
    lon[:, 1] += size * np.tile(east, len(moving)) / scale
    batch = TrackBatch(
        lat,
        lon,
        np.repeat(_adjacent_triples(line.leave, moving), trials, axis=0),
        np.repeat(np.stack([line.setting[moving - 1], line.setting[moving]], 1), trials, axis=0),
        np.repeat(arrive[0, moving - 1], trials),
    )
    _, cost = evaluator.sail(batch)
    cost = cost.reshape(len(moving), trials)
    pick = np.argmin(cost, axis=1)
    row = np.arange(len(moving))
    with np.errstate(invalid="ignore"):  # a line that cannot be sailed never arrives
        spent = cost[:, 0] - (0.0 if evaluator.by_length else arrive[0, moving - 1])
    slack = 1e-10 * np.where(np.isfinite(spent), np.abs(spent), 0.0)
    moved = cost[row, pick] + slack < cost[:, 0]
    chosen = (row * trials + pick)[moved]
    new_lat, new_lon = line.lat.copy(), line.lon.copy()
    new_lat[moving[moved]], new_lon[moving[moved]] = lat[chosen, 1], lon[chosen, 1]
    return line.moved(new_lat, new_lon), moved


def _adjacent_triples(values: FloatArray, moving: np.ndarray) -> FloatArray:
    return np.stack([values[moving - 1], values[moving], values[moving + 1]], axis=1)
