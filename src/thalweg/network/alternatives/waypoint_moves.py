"""Waypoints moved sideways to where a path costs less."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.leg_rules import (
    LegRules,
    PolylineCoordinates,
    select_points,
    total_cost,
)

_LONGEST_LEG: Final = 60.0 * NAUTICAL_MILE  # legs are split to this while waypoints are moved
#: How far waypoints are moved at once. Small steps come first: the long ones lead to the other side
#: of islands, which pays only where the way beside them is as good as it gets.
_STEP_LENGTHS: Final = tuple(NAUTICAL_MILE * s for s in (6.0, 3.0, 24.0, 12.0, 3.0, 1.5, 0.75, 0.3))
_MAX_SWEEPS: Final = 6
_MOVE_DIRECTIONS: Final = np.radians(np.arange(0.0, 360.0, 45.0))
MIN_GAIN: Final = 1e-5  #: the iteration stops at a smaller relative gain


def move_waypoints(
    rules: LegRules, line: PolylineCoordinates, *, longest_leg: float = _LONGEST_LEG
) -> PolylineCoordinates:
    """Return a path whose waypoints, and new ones between them, are moved to where it costs less.

    Parameters
    ----------
    rules : Tests and costs of legs; there are no canals on the path.
    line : Path of allowed legs [deg].
    longest_leg : Legs are split to this [m], and waypoints are moved by no more at once.

    Returns
    -------
    lat, lon : The path [deg].
    """
    lat, lon, _ = geodesy.densify(line[0], geodesy.wrap_longitude(line[1]), longest_leg)
    for step in (one for one in _STEP_LENGTHS if one <= longest_leg):
        untested = np.ones(len(lat), bool)
        for _ in range(_MAX_SWEEPS):
            gained = sum(_move_some(rules, lat, lon, step, odd, untested) for odd in (1, 2))
            if gained <= MIN_GAIN * total_cost((lat, lon), rules.cost):
                break
    return lat, lon


def _move_some(
    rules: LegRules,
    lat: FloatArray,
    lon: FloatArray,
    step: float,
    first: int,
    untested: BoolArray,
) -> float:
    """Move every other waypoint one step in its best direction, in place; return the gain.

    Waypoints that stayed, and whose neighbours stayed since, are not tested again: ``untested``.
    """
    k = np.arange(first, len(lat) - 1, 2)
    k = k[untested[k]]
    if not len(k):
        return 0.0
    untested[k] = False
    size = len(_MOVE_DIRECTIONS)
    back, here, on = ((lat[k + i], lon[k + i]) for i in (-1, 0, 1))
    old = rules.cost_by(back, here, on)
    many = np.repeat(np.arange(len(k)), size)
    new = geodesy.direct(here[0][many], here[1][many], np.tile(_MOVE_DIRECTIONS, len(k)), step)
    better, cost = rules.cost_below(
        old[many] * (1.0 - 1e-9), select_points(back, many), new, select_points(on, many)
    )
    ends = (
        select_points(back, many[better]),
        select_points(new, better),
        select_points(on, many[better]),
    )
    free = rules.both_allowed(*ends)
    current = select_points(here, many[better])
    free &= rules.same_side(ends[0], current, ends[1]) & rules.same_side(ends[1], current, ends[2])
    price = np.full(len(many), np.inf)
    price[better[free]] = cost[free]
    price = np.reshape(price, (len(k), size))
    best = price.argmin(axis=1)
    moved = np.flatnonzero(np.isfinite(price[np.arange(len(k)), best]))
    take = moved * size + best[moved]
    lat[k[moved]], lon[k[moved]] = new[0][take], new[1][take]
    for neighbour in (-1, 0, 1):
        untested[k[moved] + neighbour] = True
    return float(np.sum(old[moved] - price[moved, best[moved]]))
