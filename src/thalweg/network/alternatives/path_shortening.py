"""String pulling over a chart: the shortest or cheapest line near a path, by tested legs."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.cheapest_chain import cheapest_chain
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.alternatives.leg_rules import (
    LegCost,
    LegRules,
    LegTests,
    PassingSides,
    PolylineCoordinates,
    leg_lengths,
    select_points,
    total_cost,
)
from thalweg.network.alternatives.waypoint_moves import MIN_GAIN, move_waypoints

_MAX_SKIPPED_WAYPOINTS: Final = 48  # waypoints a leg may skip at once
_BISECTIONS: Final = 7


def string_pull_path(
    chart: LegTests,
    lat: FloatArray,
    lon: FloatArray,
    *,
    leg_cost: LegCost | None = None,
    sides: PassingSides | None = None,
    rounds: int = 12,
    least_gain: float = 0.0,
    least_cost: LegCost | None = None,
) -> PolylineCoordinates:
    """Return a path after string pulling: waypoints removed and corners cut by allowed legs.

    Parameters
    ----------
    chart : Tests the legs; legs through canals are not changed.
    lat, lon : Path of allowed legs [deg].
    leg_cost : Cost of legs; by default their length [m]. With a cost, waypoints are also moved
        sideways, because the cost differs from place to place.
    sides : Meridian crossings of legs, so that islands stay on the same side (see
        `thalweg.network.alternatives.homotopy`).
    rounds : Largest number of passes that cut corners; with 0, waypoints are only removed.
    least_gain : Share of the whole cost that each waypoint must save, or it is removed (0 to 1).
        Round a curved outline, the cheapest path has a waypoint at each of its points.
    least_cost : What legs cost at least: quicker to compute, it spares those that cost too much.

    Returns
    -------
    lat, lon : The path [deg]; it costs no more than the given one.

    Notes
    -----
    The search is local. Without ``sides`` a leg between two waypoints may pass a small island on
    the other side if that is cheaper.
    """
    rules = LegRules(chart, leg_cost or leg_lengths, sides, least_cost)
    move = leg_cost is not None
    line = np.asarray(lat, float), geodesy.wrap_longitude(lon)
    if chart.canals:
        canal = chart.canal_of_legs(line[0][:-1], line[1][:-1], line[0][1:], line[1][1:])
        k = np.flatnonzero(canal >= 0)
        if len(k):
            parts = np.split(np.arange(len(line[0])), k + 1)
            drawn = [
                _string_pulled(rules, (line[0][p], line[1][p]), move, rounds, least_gain)
                for p in parts
            ]
            return np.concatenate([d[0] for d in drawn]), np.concatenate([d[1] for d in drawn])
    return _string_pulled(rules, line, move, rounds, least_gain)


def _string_pulled(
    rules: LegRules, line: PolylineCoordinates, move: bool, rounds: int, least_gain: float
) -> PolylineCoordinates:
    given = total_cost(line, rules.cost)
    gain = least_gain * given if np.isfinite(given) else 0.0
    drawn = _drop_waypoints(rules, line, gain)
    before = total_cost(drawn, rules.cost)
    for _ in range(rounds):
        drawn = _drop_waypoints(rules, _cut_corners(rules, drawn), gain)
        now = total_cost(drawn, rules.cost)
        if before - now <= MIN_GAIN * before:
            break
        before = now
    if move and rounds:
        drawn = _drop_waypoints(rules, move_waypoints(rules, drawn), gain)
        drawn = _drop_waypoints(rules, _cut_corners(rules, drawn), gain)
    if gain and total_cost(drawn, rules.cost) > given:
        return _string_pulled(rules, line, move, rounds, 0.0)
    return drawn


def _drop_waypoints(
    rules: LegRules, line: PolylineCoordinates, least_gain: float = 0.0
) -> PolylineCoordinates:
    """Return the cheapest path through a subset of the waypoints, in their order.

    Each waypoint that stays saves at least ``least_gain``, in units of cost.
    """
    while True:
        keep = _cheapest_subset(rules, line, least_gain)
        count = len(line[0])
        line = line[0][keep], line[1][keep]
        if len(keep) == count or count <= _MAX_SKIPPED_WAYPOINTS:
            return line


def _cheapest_subset(rules: LegRules, line: PolylineCoordinates, least_gain: float) -> IntArray:
    lat, lon = line
    count = len(lat)
    first, second = np.triu_indices(count, 1)
    near = second - first <= _MAX_SKIPPED_WAYPOINTS
    first, second = first[near], second[near]
    shortcut = np.flatnonzero(second - first > 1)  # neighbours are known to be joined
    a, b = first[shortcut], second[shortcut]
    free = rules.allowed((lat[a], lon[a]), (lat[b], lon[b]))
    if rules.sides is not None and count > 1:
        passed = rules.sides(lat[:-1], lon[:-1], lat[1:], lon[1:]).astype(np.int16)
        past = np.concatenate([np.zeros((1, passed.shape[1]), np.int16), passed.cumsum(axis=0)])
        own = rules.sides(lat[a], lon[a], lat[b], lon[b])
        free &= (own == past[b] - past[a]).all(axis=1)
    used = np.ones(len(first), bool)
    used[shortcut[~free]] = False
    price = np.full(len(first), np.inf)
    legs = first[used], second[used]
    price[used] = rules.cost(lat[legs[0]], lon[legs[0]], lat[legs[1]], lon[legs[1]])
    rows = np.searchsorted(first, np.arange(count + 1))
    price *= 1.0 + 1e-12  # of equal paths, prefer fewer waypoints
    price += least_gain

    def steps(here: int, _: int) -> tuple[IntArray, FloatArray]:
        row = slice(rows[here], rows[here + 1])
        return second[row], price[row]

    chain = cheapest_chain(count, steps)
    return np.arange(count) if chain is None else chain


def _cut_corners(rules: LegRules, line: PolylineCoordinates) -> PolylineCoordinates:
    """Replace every corner by two waypoints, as far as legs allow and the cost falls."""
    count = len(line[0])
    if count < 3:
        return line
    corner = np.arange(1, count - 1)
    low, high = np.zeros(len(corner)), np.full(len(corner), 0.5)
    share = high.copy()
    for _ in range(_BISECTIONS):
        fine = _cut_is_better(rules, line, corner, share)
        low, high = np.where(fine, share, low), np.where(fine, high, share)
        if low.min() >= 0.5:
            break
        share = np.where(low >= 0.5, 0.5, 0.5 * (low + high))
    before, after = _cut_points(line, corner, low)
    cut = low > 0.0
    order = np.concatenate([corner[cut] - 0.25, corner[cut] + 0.25, corner[~cut], [0, count - 1]])
    remaining = np.concatenate([corner[~cut], [0, count - 1]])
    mixed = [
        np.concatenate([before[k][cut], after[k][cut], line[k][remaining]])[np.argsort(order)]
        for k in (0, 1)
    ]
    return mixed[0], mixed[1]


def _cut_points(
    line: PolylineCoordinates, corner: IntArray, share: FloatArray
) -> tuple[PolylineCoordinates, PolylineCoordinates]:
    """Return positions on the legs before and after corners, at a share of the leg from it."""
    lat, lon = line
    points = []
    for other in (corner - 1, corner + 1):
        length, course, _ = geodesy.inverse(lat[corner], lon[corner], lat[other], lon[other])
        points.append(geodesy.direct(lat[corner], lon[corner], course, 0.999 * share * length))
    return points[0], points[1]


def _cut_is_better(
    rules: LegRules, line: PolylineCoordinates, corner: IntArray, share: FloatArray
) -> BoolArray:
    lat, lon = line
    before, after = _cut_points(line, corner, share)
    here = lat[corner], lon[corner]
    ends = (lat[corner - 1], lon[corner - 1]), (lat[corner + 1], lon[corner + 1])
    fine = rules.cost(*before, *after) < rules.cost_by(before, here, after)
    fine &= rules.same_side(before, here, after)
    which = np.flatnonzero(fine)  # tests of land cost more
    before, after, first, last = (select_points(points, which) for points in (before, after, *ends))
    fine[which] = rules.both_allowed(first, before, after) & rules.allowed(after, last)
    return fine
