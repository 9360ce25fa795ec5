"""The lower bound of a Pareto front by mixtures of speeds over the least length."""

from __future__ import annotations

import itertools
import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thalweg.chart.canal_parts import part_number_of_legs
from thalweg.chart.zones.area_exits import MARGIN_OF_EXITS, area_exits
from thalweg.core.geodesy import distance
from thalweg.core.pareto_fronts import falling_hull, lower_hull
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.planning.pareto.exploration import strongest_current
from thalweg.planning.pareto.trade_off_context import ExploredAlternative, TradeOffContext
from thalweg.planning.plan_data import Proof
from thalweg.planning.plan_front import certain_at
from thalweg.planning.report.route_summary import canals_passed
from thalweg.planning.single.certified_bound import (
    CurrentsInReach,
    certified_distance,
    priced_length,
)
from thalweg.route import Route

if TYPE_CHECKING:
    from thalweg.chart.canals import Canal

_KIND = (
    "certificate: the least length of a route round land at mixtures of the speeds, with the "
    "strongest current in the data and the least rates and prices"
)
_CURRENT_UNKNOWN = (
    "no bound: the strongest current of the water that the ship can reach was not found"
)
_NOTHING_LEAST = "no bound: the least that the data allow is zero"
_SECONDS = 10.0  # for each bound of lengths, by default
_RATIOS = 2  # of the prices inside and outside control areas, for which lengths are bounded
_LARGEST_RATIO = 10.0
_NO_PRICE = 1e-9


def derive_proof(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    certain: FloatArray,
    kind: str,
    *,
    until: float,
) -> Proof:
    """Return the bound of a plan: of the least time for a whole front, else of the objective.

    Parameters
    ----------
    certain : A front that no route is below: hours and values, (2, m).
    kind : How it was found.
    until : Longest time of the routes that the bound is for [h].
    """
    if trade_off.context.voyage.objective == "front":
        fastest = min(one.first.duration for one in explored) / HOUR
        return _proof(float(certain[0].min()), kind, fastest)
    points = [point for one in explored if one.exact for point in one.exact.points]
    solver = min((point.cost for point in points), default=math.nan)
    earlier = certain[1, certain[0] <= until]  # a front may rise where slower routes pay for time
    return _proof(float(np.min(earlier, initial=certain_at(certain, until))), kind, solver)


def _proof(value: float, kind: str, solver: float) -> Proof:
    """Return a bound; none where it is zero, as of comfort: a ship may be without motions."""
    if value > 0.0:
        return Proof(value, kind, solver)
    return Proof(math.nan, kind if kind.startswith("no bound") else _NOTHING_LEAST, solver)


def strongest_current_of_plan(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    reached: CurrentsInReach | None,
) -> tuple[float, str]:
    """Return the strongest current [m/s] for the bound of a front, and the kind of the bound.

    Parameters
    ----------
    reached : Currents in reach of the routes of the front; None where they were not searched.
    """
    if not {codes.CURRENT_EAST, codes.CURRENT_NORTH} <= set(trade_off.context.needs.channels):
        return 0.0, _KIND
    if reached is None:
        return math.inf, _CURRENT_UNKNOWN
    strongest, sampling = reached.strongest()
    at_stations = max(strongest_current(one.frozen.stations) for one in explored)
    return max(strongest, at_stations), _KIND + (f", in {sampling}" if sampling else "")


@dataclass(frozen=True)
class LeastWay:
    """What some routes have at least; every route of a voyage is among those of one `LeastWay`.

    Attributes
    ----------
    lengths : A route costs no less than a mixture of these pairs of lengths [m], inside the control
        areas and in all, at any speeds, without those of its canals.
    hours, value : Time [h] of the canals on the way, and their value beyond what all time costs.
    """

    lengths: tuple[tuple[float, float], ...]
    hours: float = 0.0
    value: float = 0.0


def certain_front(
    trade_off: TradeOffContext, ways: Sequence[LeastWay], current: float
) -> FloatArray:
    """Return a lower front that holds for every route: hours and values (2, m), to join by lines.

    The values are those beyond the price of time and the least price of consumption: for these a
    route pays all of its time, waits included.

    Parameters
    ----------
    ways : See `least_ways`.
    current : No current is stronger [m/s]; inf where none is known to be the strongest.
    """
    fronts = [_front_of_lengths(trade_off, way.lengths, current) for way in ways]
    hours = np.concatenate([front[0] + way.hours for front, way in zip(fronts, ways, strict=True)])
    values = np.concatenate([front[1] + way.value for front, way in zip(fronts, ways, strict=True)])
    hull = falling_hull(hours, values)
    return np.array([hours[hull], values[hull]])


def _front_of_lengths(
    trade_off: TradeOffContext, lengths: Sequence[tuple[float, float]], current: float
) -> FloatArray:
    """Return a lower front of the routes of no less than a mixture of pairs of lengths.

    Notes
    -----
    At a setting a route covers a metre in no less than ``1 / v`` seconds, with the ship's top speed
    and the strongest current, for no less than ``rate / v``, with the least rate of consumption
    and the least price. A route that mixes settings has time and value above a mean of these
    points: not below their lower convex hull. At the ends the price is that of control areas, as
    far as it takes to leave them, and a way out that is near is paid for by a longer route.
    """
    prices = trade_off.objective.prices
    zone_factor = trade_off.least_zone_factor
    slow, rates = trade_off.slowness_and_rates(current)
    everywhere = trade_off.least_price_of_consumption
    seconds, values = np.empty(0), np.empty(0)
    for inside, whole in lengths:
        parts = [(inside, prices.inside), (whole - inside, min(prices.inside, prices.outside))]
        (time, value), (more_time, more_value) = (
            (part * slow, part * slow * (zone_factor * price * rates - everywhere))
            for part, price in parts
        )
        seconds = np.append(seconds, np.add.outer(time, more_time))
        values = np.append(values, np.add.outer(value, more_value))
        hull = lower_hull(seconds, values)
        seconds, values = seconds[hull], values[hull]
    last = int(np.argmin(values)) + 1
    return np.array([seconds[:last] / HOUR, values[:last]])


def least_ways(
    trade_off: TradeOffContext, routes: Sequence[Route], current: float
) -> tuple[LeastWay, ...]:
    """Return the least lengths and dues of all routes of a voyage.

    Parameters
    ----------
    routes : Known routes.
    current : No current is stronger [m/s].

    Notes
    -----
    With D metres inside the areas and C outside, every route has ``D + C >= L`` for the least
    length of its way, ``D >= N`` for the least way out of areas at the ends, or ``D >= L`` if it
    does not leave them, and ``q D + C >= W`` for the
    least length ``W`` when a metre inside counts ``q``. The pairs of lengths are the corners of
    what these leave of the plane of D and C, for some q. So that ``W`` need not be found on a mesh
    alone, it is bounded by the geodesics to the exits of the areas and on from there, too.

    Canals: where ``W`` is the least length with canals that count as longer by ``F``, a route
    through some of them has ``q D + C >= W`` at sea, less their lengths and ``F``. It takes their
    time, and pays their dues and fuel. A route through a canal is also no shorter than the
    geodesics to an end of it and on, less twice its length. Canals that the approach of a port is a
    part of belong to the approach. A route that passes a canal twice is not better than without
    what is between.
    """
    feasible, began = [route for route in routes if route.feasible], clock.perf_counter()
    whole = certified_length(trade_off, feasible, seconds_of_bound(trade_off, began, 1))
    inside, lines = 0.0, [(1.0, whole)]
    context, prices = trade_off.context, trade_off.objective.prices
    by_area = prices.inside > prices.outside and bool(context.chart.zones.eca)
    if by_area:
        inside, by_exits = _lines_by_exits(trade_off)
        lines = [*lines, *by_exits]
    simple = len(trade_off.ends) == 2 and bool(feasible)
    canals = _counted_canals(trade_off) if simple else []
    longer = _longer_canals(trade_off, feasible, canals, current)
    ratios = [1.0] if any(longer.values()) else []
    if by_area and inside < whole and simple:
        most = min(prices.inside / max(prices.outside, _NO_PRICE), _LARGEST_RATIO)
        ratios += [float(one) for one in most ** (np.arange(1, _RATIOS + 1) / _RATIOS)]
    priced = []
    for ratio in ratios:
        if trade_off.interrupt_guard.stopped():
            break
        seconds = seconds_of_bound(trade_off, began, 1 + len(ratios))
        found = certified_distance(context, feasible, price=ratio, longer=longer, seconds=seconds)
        priced.append((ratio, found.value))
    ways = []
    for number in range(len(canals) + 1):
        for passed in itertools.combinations(canals, number):
            part = sum(canal.length for canal in passed)
            counted = part + sum(longer[canal.name] for canal in passed)
            of_way = [
                *((ratio, least - ratio * part) for ratio, least in lines),
                *((ratio, least - counted) for ratio, least in priced),
                *((1.0, _least_by_canal(trade_off, canal) - part) for canal in passed),
            ]
            shortest = max(least for ratio, least in of_way if ratio == 1.0)
            corners = corners_of_lengths(min(max(inside - part, 0.0), shortest), of_way)
            value = sum(_value_of_canal(trade_off, canal) for canal in passed)
            hours = sum(canal.transit_time for canal in passed) / HOUR
            ways.append(LeastWay(tuple(corners), hours, value))
    return tuple(ways)


def _counted_canals(trade_off: TradeOffContext) -> list[Canal]:
    """Return the canals of the chart that are not part of an approach."""
    elsewhere = _paid_in_approaches(trade_off)
    return [one for one in trade_off.context.chart.canals if one.name not in elsewhere]


def passes_counted_canal(trade_off: TradeOffContext, routes: Sequence[Route]) -> bool:
    """Return whether one of some routes passes a canal that is not part of an approach."""
    counted = {canal.name for canal in _counted_canals(trade_off)}
    chart = trade_off.context.chart
    return any(one.name in counted for route in routes for one in canals_passed(route, chart))


def _value_of_canal(trade_off: TradeOffContext, canal: Canal) -> float:
    """Return the least value of the passage of a canal beyond what all time costs."""
    prices, zones = trade_off.objective.prices, trade_off.context.chart.zones
    value = prices.dues * canal.fee - trade_off.least_price_of_consumption * canal.transit_time
    if prices.consumption != "fuel":
        return value
    inside = float(zones.eca_fraction(*canal.ends[0], *canal.ends[1]))
    price = inside * prices.inside + (1.0 - inside) * prices.outside
    rate = trade_off.least_rate_in_canals
    return value + trade_off.least_zone_factor * price * rate * canal.transit_time


def _longer_canals(
    trade_off: TradeOffContext, routes: Sequence[Route], canals: Sequence[Canal], current: float
) -> dict[str, float]:
    """Return by how much canals count as longer [m], by name: what their dues and time are worth.

    No more than what they save on the known routes: so the ways through them and round them are
    bounded at once.
    """
    chart = trade_off.context.chart
    worth = trade_off.worth_of_canals(current)
    lengths = [(canals_passed(route, chart), priced_length(route, chart)) for route in routes]
    names = {canal.name for canal in canals}
    free = [length for passed, length in lengths if names.isdisjoint(one.name for one in passed)]
    longer = {}
    for canal in canals:
        through = [
            length for passed, length in lengths if canal.name in {one.name for one in passed}
        ]
        saved = min(free, default=math.inf) - min(through, default=math.inf)
        longer[canal.name] = max(min(worth[canal.name], saved), 0.0) if through else 0.0
    return longer


def _least_by_canal(trade_off: TradeOffContext, canal: Canal) -> float:
    """Return a length [m] that no route is shorter than that touches a canal."""
    start, goal = trade_off.ends
    way = min(
        float(distance(start.lat, start.lon, *end) + distance(*end, goal.lat, goal.lon))
        for end in canal.ends
    )
    return way - 2.0 * canal.length


def _paid_in_approaches(trade_off: TradeOffContext) -> set[str]:
    """Return the names of the canals of which the approach of a port is a part."""
    canals = trade_off.context.chart.canals
    lines = [end.approach.line for end in trade_off.ends if end.approach is not None]
    numbers = [part_number_of_legs(canals, *np.array(line, float).T) for line in lines]
    return {canals[k].name for number in numbers for k in number[number >= 0].tolist()}


def _lines_by_exits(trade_off: TradeOffContext) -> tuple[float, list[tuple[float, float]]]:
    """Return the least length inside [m], and lines for `corners_of_lengths`, by geodesics.

    A route from a control area to water outside all of them leaves it for good or for a while at
    an exit: it sails as far as there inside, and as far as from there to the goal besides.
    """
    chart, ends = trade_off.context.chart, (trade_off.ends[0], trade_off.ends[-1])
    inside = [bool(chart.zones.in_eca(end.lat, end.lon)) for end in ends]
    if not any(inside):
        return 0.0, []
    exits = area_exits(chart.zones, chart.coastline, chart.canals)
    far = [np.asarray(distance(end.lat, end.lon, *exits)) - MARGIN_OF_EXITS for end in ends]
    far = [np.maximum(one, 0.0) for one in far]
    lengths_inside = [
        float(np.min(one, initial=math.inf)) if counts else 0.0
        for one, counts in zip(far, inside, strict=True)
    ]
    if all(inside) or not far[0].size:
        return sum(lengths_inside), []
    least, whole = (far[0] if inside[0] else far[1]), far[0] + far[1]
    lines = []
    for a, b in itertools.pairwise(falling_hull(least, whole)):
        slope = float((whole[a] - whole[b]) / (least[b] - least[a]))
        lines.append((1.0 + slope, float(whole[a] + slope * least[a])))
    return sum(lengths_inside), lines


def corners_of_lengths(
    inside: float, lines: Sequence[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return the corners of the lengths that are possible: inside the control areas and in all.

    Parameters
    ----------
    inside : No route has less inside [m].
    lines : Ratios q, the first 1, and what ``q`` times the length inside plus the length outside is
        no less than [m]; those that are not finite are left out.

    Returns
    -------
    list of tuple : With growing length inside [m].
    """
    kept = [(ratio, least) for ratio, least in lines if math.isfinite(least)]
    crossings = [(b - a) / (q - p) for (p, a), (q, b) in itertools.combinations(kept, 2) if q != p]
    places = {inside, *(place for place in crossings if place > inside)}
    places |= {max(inside, least / ratio) for ratio, least in kept}
    x = np.array(sorted(places))
    y = np.max([least - ratio * x for ratio, least in kept], axis=0, initial=0.0)
    return [(float(x[k]), float(x[k] + y[k])) for k in falling_hull(x, y)]


def seconds_of_bound(trade_off: TradeOffContext, now: float, count: int) -> float:
    """Return the time for one of some bounds of lengths [s].

    By default all of them take no longer than the plan has taken until now.
    """
    seconds = trade_off.context.proof_seconds
    if seconds is not None:
        return seconds / count
    return min((now - trade_off.began) / count, _SECONDS)


def certified_length(trade_off: TradeOffContext, routes: Sequence[Route], seconds: float) -> float:
    """Return a length [m] that no route is shorter than, after a search of some time [s].

    Round land, with the offing and no-go zones, where there are neither via points nor canals on
    the way; otherwise that of the geodesics.
    """
    context, ends = trade_off.context, trade_off.ends
    geodesic = sum(float(distance(a.lat, a.lon, b.lat, b.lon)) for a, b in itertools.pairwise(ends))
    feasible = [route for route in routes if route.feasible]
    if len(ends) > 2 or not feasible or trade_off.interrupt_guard.stopped():
        return geodesic
    found = certified_distance(context, feasible, seconds=seconds)
    return max(geodesic, found.value) if math.isfinite(found.value) else geodesic
