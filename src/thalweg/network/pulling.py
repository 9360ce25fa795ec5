"""String pulling over a chart: the taut, or the cheapest, line near a way, by tested legs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from thalweg.core import geodesy
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.network import BoolArray, FloatArray, IntArray
from thalweg.network.pairs import measure

if TYPE_CHECKING:
    from thalweg.chart import Chart

#: Cost of legs (lat1, lon1, lat2, lon2) [deg]; by default their length [m].
LegCost: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
Line: TypeAlias = tuple[FloatArray, FloatArray]

_WINDOW: Final = 48  # waypoints a leg may skip at once
_BISECTIONS: Final = 7
_LONGEST: Final = 60.0 * NAUTICAL_MILE  # legs are cut to this while waypoints are moved
_STEPS: Final = tuple(NAUTICAL_MILE * s for s in (24.0, 12.0, 6.0, 3.0, 1.5, 0.75, 0.3))
_SWEEPS: Final = 6
_COURSES: Final = np.radians(np.arange(0.0, 360.0, 45.0))
_GAIN: Final = 1e-5  # a round that gains a smaller share is the last


def pulled(
    chart: Chart,
    lat: FloatArray,
    lon: FloatArray,
    *,
    leg_cost: LegCost | None = None,
    rounds: int = 12,
) -> Line:
    """Return a way pulled taut: waypoints left out and corners cut while all legs stay allowed.

    Parameters
    ----------
    chart : Chart
        Tests the legs; those through canals stay.
    lat, lon : ndarray
        Way [deg] of allowed legs.
    leg_cost : callable, optional
        What legs cost; by default their length. With a cost waypoints are moved sideways as well,
        in the ways that cost changes from place to place.
    rounds : int
        How often corners are cut at most; 0 only leaves waypoints out.

    Returns
    -------
    lat, lon : ndarray
        The way [deg]; it costs no more than the one given.

    Notes
    -----
    Local: islands stay on the side they are on, unless a leg between two waypoints passes them
    the other way round and is cheaper.
    """
    cost = leg_cost or _lengths
    line = np.asarray(lat, float), geodesy.wrap_longitude(lon)
    if chart.canals:
        canal = chart.canal_of_legs(line[0][:-1], line[1][:-1], line[0][1:], line[1][1:])
        k = np.flatnonzero(canal >= 0)
        if len(k):
            parts = np.split(np.arange(len(line[0])), k + 1)
            drawn = [_taut(chart, (line[0][p], line[1][p]), cost, leg_cost, rounds) for p in parts]
            return np.concatenate([d[0] for d in drawn]), np.concatenate([d[1] for d in drawn])
    return _taut(chart, line, cost, leg_cost, rounds)


def total_cost(line: Line, leg_cost: LegCost | None = None) -> float:
    """Return what a way costs; by default its length [m]."""
    lat, lon = line
    return float(np.sum((leg_cost or _lengths)(lat[:-1], lon[:-1], lat[1:], lon[1:])))


def _taut(chart: Chart, line: Line, cost: LegCost, given: LegCost | None, rounds: int) -> Line:
    line = _fewest(chart, line, cost)
    before = total_cost(line, cost)
    for _ in range(rounds):
        line = _fewest(chart, _cut(chart, line, cost), cost)
        now = total_cost(line, cost)
        if before - now <= _GAIN * before:
            break
        before = now
    if given is not None and rounds:
        line = _moved(chart, line, cost)
        line = _fewest(chart, _cut(chart, _fewest(chart, line, cost), cost), cost)
    return line


def _lengths(lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray) -> FloatArray:
    count = len(lat1)
    ends = np.arange(2 * count, dtype=np.int32)
    lat, lon = np.concatenate([lat1, lat2]), np.concatenate([lon1, lon2])
    return measure(lat, lon, ends[:count], ends[count:]).length


def _allowed(chart: Chart, start: Line, end: Line) -> BoolArray:
    return ~np.asarray(chart.legs_blocked(*start, *end))


def _fewest(chart: Chart, line: Line, cost: LegCost) -> Line:
    """Return the cheapest way over some of the waypoints, in their order."""
    while True:
        keep = _subset(chart, line, cost)
        count = len(line[0])
        line = line[0][keep], line[1][keep]
        if len(keep) == count or count <= _WINDOW:
            return line


def _subset(chart: Chart, line: Line, cost: LegCost) -> IntArray:
    lat, lon = line
    count = len(lat)
    first, second = np.triu_indices(count, 1)
    near = second - first <= _WINDOW
    first, second = first[near], second[near]
    price = cost(lat[first], lon[first], lat[second], lon[second])
    hop = second - first > 1  # neighbours are known to be joined
    blocked = ~_allowed(
        chart, (lat[first[hop]], lon[first[hop]]), (lat[second[hop]], lon[second[hop]])
    )
    price[np.flatnonzero(hop)[blocked]] = np.inf
    best, came = np.full(count, np.inf), np.zeros(count, np.int64)
    best[0] = 0.0
    rows = np.searchsorted(first, np.arange(count + 1))
    for here in range(count - 1):
        row = slice(rows[here], rows[here + 1])
        reach = best[here] + price[row] * (1.0 + 1e-12)  # fewer waypoints of equal ways
        better = reach < best[second[row]]
        best[second[row][better]] = reach[better]
        came[second[row][better]] = here
    chain = [count - 1]
    while chain[-1] > 0:
        chain.append(int(came[chain[-1]]))
    return np.array(chain[::-1], np.int64)


def _cut(chart: Chart, line: Line, cost: LegCost) -> Line:
    """Cut every corner as far as legs allow and cost falls: two waypoints in the place of one."""
    lat, lon = line
    if len(lat) < 3:
        return line
    corner = np.arange(1, len(lat) - 1)
    low, high = np.zeros(len(corner)), np.full(len(corner), 0.5)
    share = high.copy()
    for _ in range(_BISECTIONS):
        fine = _cut_is_better(chart, line, corner, share, cost)
        low, high = np.where(fine, share, low), np.where(fine, high, share)
        if low.min() >= 0.5:
            break
        share = np.where(low >= 0.5, 0.5, 0.5 * (low + high))
    before, after = _cut_points(line, corner, low)
    new_lat, new_lon = [lat[:1]], [lon[:1]]
    for k in range(len(corner)):
        if low[k] == 0.0:
            new_lat.append(lat[corner[k], None])
            new_lon.append(lon[corner[k], None])
        else:
            new_lat.append(np.array([before[0][k], after[0][k]]))
            new_lon.append(np.array([before[1][k], after[1][k]]))
    return np.concatenate([*new_lat, lat[-1:]]), np.concatenate([*new_lon, lon[-1:]])


def _cut_points(line: Line, corner: IntArray, share: FloatArray) -> tuple[Line, Line]:
    """Return positions on the legs before and after corners, at a share of the leg from it."""
    lat, lon = line
    points = []
    for other in (corner - 1, corner + 1):
        length, course, _ = geodesy.inverse(lat[corner], lon[corner], lat[other], lon[other])
        points.append(geodesy.direct(lat[corner], lon[corner], course, 0.999 * share * length))
    return points[0], points[1]


def _cut_is_better(
    chart: Chart, line: Line, corner: IntArray, share: FloatArray, cost: LegCost
) -> BoolArray:
    lat, lon = line
    before, after = _cut_points(line, corner, share)
    here = lat[corner], lon[corner]
    ends = (lat[corner - 1], lon[corner - 1]), (lat[corner + 1], lon[corner + 1])
    fine = cost(*before, *after) < cost(*before, *here) + cost(*here, *after)
    fine &= _allowed(chart, before, after)
    return fine & _allowed(chart, ends[0], before) & _allowed(chart, after, ends[1])


def _moved(chart: Chart, line: Line, cost: LegCost) -> Line:
    """Move the waypoints of a line cut into short legs to where it costs less."""
    lat, lon, _ = geodesy.densify(*line, _LONGEST)
    for step in _STEPS:
        for _ in range(_SWEEPS):
            gained = sum(_move_some(chart, lat, lon, cost, step, odd) for odd in (1, 2))
            if gained <= _GAIN * total_cost((lat, lon), cost):
                break
    return lat, lon


def _move_some(
    chart: Chart, lat: FloatArray, lon: FloatArray, cost: LegCost, step: float, first: int
) -> float:
    """Move every other waypoint one step in its best direction, in place; return the gain."""
    k = np.arange(first, len(lat) - 1, 2)
    if not len(k):
        return 0.0
    old = cost(lat[k - 1], lon[k - 1], lat[k], lon[k]) + cost(
        lat[k], lon[k], lat[k + 1], lon[k + 1]
    )
    many = np.repeat(k, len(_COURSES))
    new = geodesy.direct(lat[many], lon[many], np.tile(_COURSES, len(k)), step)
    back, on = (lat[many - 1], lon[many - 1]), (lat[many + 1], lon[many + 1])
    price = cost(*back, *new) + cost(*new, *on)
    better = np.flatnonzero(price < np.repeat(old, len(_COURSES)) * (1.0 - 1e-9))
    free = _allowed(chart, _take(back, better), _take(new, better))
    free &= _allowed(chart, _take(new, better), _take(on, better))
    price = np.where(np.isin(np.arange(len(many)), better[free]), price, np.inf)
    price = price.reshape(len(k), -1)
    best = price.argmin(axis=1)
    moved = np.flatnonzero(np.isfinite(price[np.arange(len(k)), best]))
    take = moved * len(_COURSES) + best[moved]
    lat[k[moved]], lon[k[moved]] = new[0][take], new[1][take]
    return float(np.sum(old[moved] - price[moved, best[moved]]))


def _take(line: Line, index: IntArray) -> Line:
    return line[0][index], line[1][index]
