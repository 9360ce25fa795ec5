"""Removal of turns: sharp alterations of course that save almost nothing are left out."""

from __future__ import annotations

import math

import numpy as np

from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.refinement.track_geometry import course_changes

_SHARP_TURN = math.radians(30.0)
_WORTH_A_TURN = 900.0  # each 30 degrees of sharp turns must save the mean cost of this time [s]
_LEAST_SAVING = 1e-6  # share of the cost that leaving out a point without a turn must save
_LONGEST_SPAN = 32  # legs that are replaced by one


def without_needless_turns(line: Polyline, evaluator: PolylineEvaluator) -> Polyline:
    """Return the line without sharp turns that save little.

    The cheapest path of a network may turn to and fro, as for the heading of least motions, where
    no master would. A turn of more than 30 degrees stays where it saves the mean cost of 15 minutes
    for each 30 degrees of it. Points that cost something without any turn go too.

    Parameters
    ----------
    line : One that can be sailed; any other is returned unchanged.
    evaluator : Its cost is what turns are weighed against.

    Returns
    -------
    Polyline : The given one, or one through some of its points that arrives no later. Points where
        the ship waits and ends of canals stay; a leg that replaces others has the setting of the
        first of them.
    """
    arrive, cost = _sailed(line, evaluator)
    if not math.isfinite(cost):
        return line
    latest = arrive + 1e-6
    least_gain = _WORTH_A_TURN * abs(cost) / max(arrive - line.depart, _WORTH_A_TURN)
    turns, span = _sharp_turns(line), _LONGEST_SPAN
    while span >= 2:
        first = 0
        while first + span < len(line):
            inside = np.arange(first + 1, first + span)
            fixed = evaluator.fixed_points(line.lat, line.lon) | np.isfinite(line.leave)
            shorter = line.kept(np.delete(np.arange(len(line)), inside))
            fewer = turns - _sharp_turns(shorter)
            if fewer >= 0.0 and not fixed[inside].any():
                arrive, other = _sailed(shorter, evaluator)
                most = cost + fewer * least_gain if fewer else cost * (1.0 - _LEAST_SAVING)
                if arrive <= latest and other <= most:
                    line, cost, turns = shorter, other, turns - fewer
                    continue
            first += 1
        span //= 2
    return line


def _sailed(line: Polyline, evaluator: PolylineEvaluator) -> tuple[float, float]:
    """Return when a line arrives [s after the origin] and its cost; inf where not sailed."""
    arrive, cost = evaluator.sail(line.batch())
    return float(arrive[0, -1]), float(cost[0])


def _sharp_turns(line: Polyline) -> float:
    """Return the sum of the alterations of course of more than 30 degrees, in units of these."""
    turns = np.abs(course_changes(line.lat, line.lon))
    return float(turns[turns > _SHARP_TURN].sum()) / _SHARP_TURN
