"""String pulling over a chart: the shortest or cheapest line near a path, by tested legs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core import geodesy
from thalweg.core.cheapest_chain import cheapest_chain
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.assembly import measured_pairs

if TYPE_CHECKING:
    from thalweg.chart.canals import Canal

#: Cost of legs (lat1, lon1, lat2, lon2) [deg]; by default their length [m].
LegCost: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
#: Meridian crossings (n, K) of legs [deg]; paths with equal sums pass islands on the same sides.
PassingSides: TypeAlias = Callable[
    [FloatArray, FloatArray, FloatArray, FloatArray], NDArray[np.int8]
]
PolylineCoordinates: TypeAlias = tuple[FloatArray, FloatArray]

_MAX_SKIPPED_WAYPOINTS: Final = 48  # waypoints a leg may skip at once
_BISECTIONS: Final = 7
_LONGEST_LEG: Final = 60.0 * NAUTICAL_MILE  # legs are split to this while waypoints are moved
#: How far waypoints are moved at once. Small steps come first: the long ones lead to the other side
#: of islands, which pays only where the way beside them is as good as it gets.
_STEP_LENGTHS: Final = tuple(NAUTICAL_MILE * s for s in (6.0, 3.0, 24.0, 12.0, 3.0, 1.5, 0.75, 0.3))
_MAX_SWEEPS: Final = 6
_MOVE_DIRECTIONS: Final = np.radians(np.arange(0.0, 360.0, 45.0))
_MIN_GAIN: Final = 1e-5  # the iteration stops at a smaller relative gain


class LegTests(Protocol):
    """What string pulling asks of a chart."""

    @property
    def canals(self) -> Sequence[Canal]:
        """The canals, whose legs are not changed."""

    def canal_of_legs(self, *ends: Any) -> Any:
        """Return the number of the canal that each leg leads through, -1 at sea."""

    def legs_blocked(self, *ends: Any) -> Any:
        """Return which legs may not be sailed."""


@dataclass(frozen=True)
class _LegRules:
    """Tests and costs of legs."""

    chart: LegTests
    cost: LegCost
    sides: PassingSides | None
    least_cost: LegCost | None = None  # that legs have at least, quick to compute

    def allowed(self, start: PolylineCoordinates, end: PolylineCoordinates) -> BoolArray:
        """Return which legs touch neither land nor no-go zones."""
        return ~np.asarray(self.chart.legs_blocked(*start, *end))

    def both_allowed(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> BoolArray:
        """Return where both legs, to a position and on from it, are allowed."""
        first, second = self.allowed(*_two_legs(start, by, end)).reshape(2, -1)
        return np.asarray(first & second)

    def cost_by(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> FloatArray:
        """Return the cost of both legs, to a position and on from it."""
        return _cost_by(self.cost, start, by, end)

    def cost_below(
        self,
        most: FloatArray,
        start: PolylineCoordinates,
        by: PolylineCoordinates,
        end: PolylineCoordinates,
    ) -> tuple[IntArray, FloatArray]:
        """Return where both legs cost less than ``most``, and what they cost there."""
        which = np.arange(len(most))
        if self.least_cost is not None:
            which = np.flatnonzero(_cost_by(self.least_cost, start, by, end) < most)
        price = self.cost_by(*(_select_points(points, which) for points in (start, by, end)))
        less = price < most[which]
        return which[less], price[less]

    def same_side(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> BoolArray:
        """Return which legs pass islands on the same side as the path through a third position."""
        if self.sides is None:
            return np.ones(len(start[0]), bool)
        round_it = self.sides(*start, *by) + self.sides(*by, *end)
        return np.asarray((self.sides(*start, *end) == round_it).all(axis=1))


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
    rules = _LegRules(chart, leg_cost or leg_lengths, sides, least_cost)
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


def total_cost(line: PolylineCoordinates, leg_cost: LegCost | None = None) -> float:
    """Return the cost of a path; by default its length [m].

    Parameters
    ----------
    line : Latitudes and longitudes of the waypoints [deg].
    leg_cost : Cost of legs (lat1, lon1, lat2, lon2) [deg].

    Returns
    -------
    float : Sum over all legs.
    """
    lat, lon = line
    return float(np.sum((leg_cost or leg_lengths)(lat[:-1], lon[:-1], lat[1:], lon[1:])))


def _string_pulled(
    rules: _LegRules, line: PolylineCoordinates, move: bool, rounds: int, least_gain: float
) -> PolylineCoordinates:
    given = total_cost(line, rules.cost)
    gain = least_gain * given if np.isfinite(given) else 0.0
    drawn = _drop_waypoints(rules, line, gain)
    before = total_cost(drawn, rules.cost)
    for _ in range(rounds):
        drawn = _drop_waypoints(rules, _cut_corners(rules, drawn), gain)
        now = total_cost(drawn, rules.cost)
        if before - now <= _MIN_GAIN * before:
            break
        before = now
    if move and rounds:
        drawn = _drop_waypoints(rules, _move_waypoints(rules, drawn), gain)
        drawn = _drop_waypoints(rules, _cut_corners(rules, drawn), gain)
    if gain and total_cost(drawn, rules.cost) > given:
        return _string_pulled(rules, line, move, rounds, 0.0)
    return drawn


def leg_lengths(
    lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> FloatArray:
    """Return the lengths [m] of legs [deg]."""
    count = len(lat1)
    ends = np.arange(2 * count, dtype=np.int32)
    lat, lon = np.concatenate([lat1, lat2]), np.concatenate([lon1, lon2])
    return measured_pairs(lat, lon, ends[:count], ends[count:]).length


def _drop_waypoints(
    rules: _LegRules, line: PolylineCoordinates, least_gain: float = 0.0
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


def _cheapest_subset(rules: _LegRules, line: PolylineCoordinates, least_gain: float) -> IntArray:
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


def _cut_corners(rules: _LegRules, line: PolylineCoordinates) -> PolylineCoordinates:
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
    rules: _LegRules, line: PolylineCoordinates, corner: IntArray, share: FloatArray
) -> BoolArray:
    lat, lon = line
    before, after = _cut_points(line, corner, share)
    here = lat[corner], lon[corner]
    ends = (lat[corner - 1], lon[corner - 1]), (lat[corner + 1], lon[corner + 1])
    fine = rules.cost(*before, *after) < rules.cost_by(before, here, after)
    fine &= rules.same_side(before, here, after)
    which = np.flatnonzero(fine)  # tests of land cost more
    before, after, first, last = (
        _select_points(points, which) for points in (before, after, *ends)
    )
    fine[which] = rules.both_allowed(first, before, after) & rules.allowed(after, last)
    return fine


def move_waypoints(
    chart: LegTests,
    lat: FloatArray,
    lon: FloatArray,
    *,
    leg_cost: LegCost,
    longest_leg: float,
    least_cost: LegCost | None = None,
) -> PolylineCoordinates:
    """Return a path whose waypoints, and new ones between them, are moved to where it costs less.

    Parameters
    ----------
    chart : Tests the legs; there are no canals on the path.
    lat, lon : Path of allowed legs [deg].
    leg_cost : Cost of legs.
    longest_leg : Legs are split to this [m], and waypoints are moved by no more at once.
    least_cost : What legs cost at least, as in `string_pull_path`.

    Returns
    -------
    lat, lon : The path [deg].
    """
    rules = _LegRules(chart, leg_cost, None, least_cost)
    return _move_waypoints(rules, (lat, geodesy.wrap_longitude(lon)), longest_leg)


def _move_waypoints(
    rules: _LegRules, line: PolylineCoordinates, longest_leg: float = _LONGEST_LEG
) -> PolylineCoordinates:
    """Split a line into short legs and move its waypoints to where it costs less."""
    lat, lon, _ = geodesy.densify(*line, longest_leg)
    for step in (one for one in _STEP_LENGTHS if one <= longest_leg):
        untested = np.ones(len(lat), bool)
        for _ in range(_MAX_SWEEPS):
            gained = sum(_move_some(rules, lat, lon, step, odd, untested) for odd in (1, 2))
            if gained <= _MIN_GAIN * total_cost((lat, lon), rules.cost):
                break
    return lat, lon


def _move_some(
    rules: _LegRules,
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
        old[many] * (1.0 - 1e-9), _select_points(back, many), new, _select_points(on, many)
    )
    ends = (
        _select_points(back, many[better]),
        _select_points(new, better),
        _select_points(on, many[better]),
    )
    free = rules.both_allowed(*ends)
    current = _select_points(here, many[better])
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


def _cost_by(
    cost: LegCost, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
) -> FloatArray:
    """Return the cost of both legs, to a position and on from it."""
    first, second = _two_legs(start, by, end)
    return np.asarray(cost(*first, *second).reshape(2, -1).sum(axis=0))


def _two_legs(
    start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
) -> tuple[PolylineCoordinates, PolylineCoordinates]:
    """Return starts and ends of the legs to positions, followed by those of the legs from them."""
    lat, lon = (np.concatenate([start[k], by[k], end[k]]) for k in (0, 1))
    count = len(start[0])
    return (lat[: 2 * count], lon[: 2 * count]), (lat[count:], lon[count:])


def _select_points(line: PolylineCoordinates, index: IntArray) -> PolylineCoordinates:
    return line[0][index], line[1][index]
