"""The lower bound of a Pareto front by mixtures of speeds over the least length."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.chart.canal_parts import part_number_of_legs
from thalweg.chart.zones.area_exits import MARGIN_OF_EXITS, area_exits
from thalweg.core.geodesy import distance
from thalweg.core.pareto_fronts import lower_hull
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.planning.pareto.exploration import strongest_current
from thalweg.planning.pareto.trade_off_context import ExploredAlternative, TradeOffContext
from thalweg.planning.plan_data import Proof
from thalweg.planning.plan_front import certain_at
from thalweg.planning.report.route_summary import canals_passed
from thalweg.planning.single.certified_bound import (
    certified_distance,
    certified_priced_length,
    strongest_current_in_data,
)
from thalweg.route import Route
from thalweg.search import table_bounds

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal

_KIND = (
    "certificate: the least length of a route round land at mixtures of the speeds, with the "
    "strongest current in the data and the least rates and prices"
)
_CURRENT_UNKNOWN = (
    "no bound: the strongest current of the water that the ship can reach was not found"
)
_NOTHING_LEAST = "no bound: the least that the data allow is zero"
_SECONDS = 2.0  # for the bound of the length, by default
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
    return _proof(certain_at(certain, until), kind, solver)


def _proof(value: float, kind: str, solver: float) -> Proof:
    """Return a bound; none where it is zero, as of comfort: a ship may be without motions."""
    if value > 0.0:
        return Proof(value, kind, solver)
    return Proof(math.nan, kind if kind.startswith("no bound") else _NOTHING_LEAST, solver)


def strongest_current_of_plan(
    trade_off: TradeOffContext, explored: list[ExploredAlternative], routes: Sequence[Route]
) -> tuple[float, str]:
    """Return the strongest current [m/s] for the bound of a front, and the kind of the bound.

    Parameters
    ----------
    routes : Of the front.
    """
    context = trade_off.context
    if not {codes.CURRENT_EAST, codes.CURRENT_NORTH} <= set(context.needs.channels):
        return 0.0, _KIND
    feasible = [route for route in routes if route.feasible]
    if not feasible or trade_off.interrupt_guard.stopped():
        return math.inf, _CURRENT_UNKNOWN
    found = strongest_current_in_data(context, max(feasible, key=lambda route: route.time_h))
    at_stations = max(strongest_current(one.frozen.stations) for one in explored)
    return max(found[0], at_stations), _KIND + (f", in {found[1]}" if found[1] else "")


def certain_front(
    trade_off: TradeOffContext, lengths: Sequence[tuple[float, float]], current: float
) -> FloatArray:
    """Return a lower front that holds for every route: hours and values (2, m), to join by lines.

    Parameters
    ----------
    lengths : Each route is no shorter than one of these pairs, inside the control areas and in all
        (see `certified_lengths`) [m].
    current : No current is stronger [m/s]; inf where none is known to be the strongest.

    Notes
    -----
    At a setting a route covers a metre in no less than ``1 / v`` seconds, with the ship's top speed
    and the strongest current, for no less than ``rate / v``, with the least rate of consumption
    and the least price. A route that mixes settings has time and value above a mean of these
    points: not below their lower convex hull. At the ends the price is that of control areas, as
    far as it takes to leave them, and a way out that is near is paid for by a longer route.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    rates = np.maximum(table_bounds(trade_off.consumption.kernel_arrays(), np.fmin), 0.0)
    rates = rates[trade_off.settings]
    top = np.array([float(context.ship.top_speed(int(s)) or math.inf) for s in trade_off.settings])
    zone_factor = 1.0
    if prices.dues > 0.0:  # a route off the network may sail in the cheapest zone throughout
        zone_factor = min([1.0, *(float(factor) for _, factor in context.chart.zones.price)])
    slow = 1.0 / (top + current)
    seconds, values = np.empty(0), np.empty(0)
    for inside, whole in lengths:
        parts = [(inside, prices.inside), (whole - inside, min(prices.inside, prices.outside))]
        (time, value), (more_time, more_value) = (
            (part * slow, part * slow * (zone_factor * price * rates + prices.time))
            for part, price in parts
        )
        seconds = np.append(seconds, np.add.outer(time, more_time))
        values = np.append(values, np.add.outer(value, more_value))
        hull = lower_hull(seconds, values)
        seconds, values = seconds[hull], values[hull]
    last = int(np.argmin(values)) + 1
    return np.array([seconds[:last] / HOUR, values[:last]])


def front_with_dues(
    trade_off: TradeOffContext,
    routes: Sequence[Route],
    lengths: Sequence[tuple[float, float]],
    current: float,
) -> FloatArray | None:
    """Return a lower front that counts canal dues, or the length of the way round the canals.

    Parameters
    ----------
    routes : Known routes; the bound needs one without dues.
    lengths, current : As of `certain_front`.

    Returns
    -------
    float64 array (2, m), or None
        As of `certain_front`; None where no dues count, with via points, and without a route.

    Notes
    -----
    Every route keeps clear of all canals with dues, and is no shorter than the way round land
    without them, or it touches one of them, pays its dues, and is no shorter than the geodesics to
    an end of it and on, less twice its length. A canal that the approach of a port is a part of is
    taken as free: its dues belong to the approach.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    paying = [canal for canal in context.chart.canals if canal.fee > 0.0]
    if not prices.dues > 0.0 or not paying or len(trade_off.ends) > 2 or not lengths:
        return None
    elsewhere = _paid_in_approaches(trade_off)
    fees = [0.0 if canal.name in elsewhere else canal.fee for canal in paying]
    free = [route for route in routes if not _passes_one_of(route, paying, context.chart)]
    shortest = _shortest(free)
    if shortest is None or trade_off.interrupt_guard.stopped():
        return None
    start, goal = trade_off.ends
    inside, whole = (min(pair[k] for pair in lengths) for k in (0, 1))
    closed = context.chart.without_canals(*(canal.name for canal in paying))
    found = certified_distance(
        replace(context, chart=closed), shortest, seconds=_seconds(trade_off)
    )
    if not found.value > whole:
        return None
    fronts = [certain_front(trade_off, [(inside, found.value)], current)]
    for canal, fee in zip(paying, fees, strict=True):
        way = min(
            float(distance(start.lat, start.lon, *end) + distance(*end, goal.lat, goal.lon))
            for end in canal.ends
        )
        least = max(whole, way - 2.0 * canal.length)
        front = certain_front(trade_off, [(inside, least)], current)
        fronts.append(front + np.array([[0.0], [prices.dues * fee]]))
    hours, values = np.concatenate(fronts, axis=1)
    hull = lower_hull(hours, values)
    hull = hull[: int(np.argmin(values[hull])) + 1]
    return np.array([hours[hull], values[hull]])


def _paid_in_approaches(trade_off: TradeOffContext) -> set[str]:
    """Return the names of the canals of which the approach of a port is a part."""
    canals = trade_off.context.chart.canals
    lines = [end.approach.line for end in trade_off.ends if end.approach is not None]
    numbers = [part_number_of_legs(canals, *np.array(line, float).T) for line in lines]
    return {canals[k].name for number in numbers for k in number[number >= 0].tolist()}


def _passes_one_of(route: Route, canals: Sequence[Canal], chart: Chart) -> bool:
    passed = {canal.name for canal in canals_passed(route, chart)}
    return not passed.isdisjoint(canal.name for canal in canals)


def certified_lengths(
    trade_off: TradeOffContext, routes: Sequence[Route]
) -> list[tuple[float, float]]:
    """Return pairs of lengths [m], inside the control areas and in all, for `certain_front`.

    Each route costs no less than a mixture of the pairs, at any speeds.

    Parameters
    ----------
    routes : Of the front.

    Notes
    -----
    With D metres inside the areas and C outside, every route has ``D + C >= L`` for the least
    length, ``D >= N`` for the least way out of areas at the ends, and ``q D + C >= W`` for the
    least length ``W`` when a metre inside counts ``q``. The pairs are the corners of what these
    leave of the plane of D and C, for some q. So that ``W`` need not be found on a mesh alone, it
    is bounded by the geodesics to the exits of the areas and on from there, too.
    """
    context, prices = trade_off.context, trade_off.objective.prices
    length, shortest = certified_length(trade_off, routes), _shortest(routes)
    if not prices.inside > prices.outside or not context.chart.zones.eca:
        return [(0.0, length)]
    inside, lines = _lines_by_exits(trade_off)
    inside = min(length, inside)
    lines.append((1.0, length))
    if inside < length and len(trade_off.ends) == 2 and shortest is not None:
        most = min(prices.inside / max(prices.outside, _NO_PRICE), _LARGEST_RATIO)
        for ratio in most ** (np.arange(1, _RATIOS + 1) / _RATIOS):
            if trade_off.interrupt_guard.stopped():
                break
            found = certified_priced_length(
                context, shortest, price=float(ratio), seconds=_seconds(trade_off)
            )
            lines.append((ratio, found.value))
    return corners_of_lengths(inside, lines)


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
    dear = [
        float(np.min(one, initial=math.inf)) if counts else 0.0
        for one, counts in zip(far, inside, strict=True)
    ]
    if all(inside) or not far[0].size:
        return sum(dear), []
    least, whole = (far[0] if inside[0] else far[1]), far[0] + far[1]
    hull = lower_hull(least, whole)
    hull = hull[: int(np.argmin(whole[hull])) + 1]
    lines = []
    for a, b in itertools.pairwise(hull):
        slope = float((whole[a] - whole[b]) / (least[b] - least[a]))
        lines.append((1.0 + slope, float(whole[a] + slope * least[a])))
    return sum(dear), lines


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
    hull = lower_hull(x, y)
    hull = hull[: int(np.argmin(y[hull])) + 1]
    return [(float(x[k]), float(x[k] + y[k])) for k in hull]


def _shortest(routes: Sequence[Route]) -> Route | None:
    """Return the shortest feasible route; None where there is none."""
    feasible = [route for route in routes if route.feasible]
    return min(feasible, key=lambda route: float(route.legs["length"].sum()), default=None)


def _seconds(trade_off: TradeOffContext) -> float:
    """Return the time for a bound of lengths [s]."""
    seconds = trade_off.context.proof_seconds
    return _SECONDS if seconds is None else seconds


def certified_length(trade_off: TradeOffContext, routes: Sequence[Route]) -> float:
    """Return a length [m] that no route is shorter than.

    Round land, with the offing and no-go zones, where there are neither via points nor canals on
    the way; otherwise that of the geodesics.
    """
    context, ends = trade_off.context, trade_off.ends
    geodesic = sum(float(distance(a.lat, a.lon, b.lat, b.lon)) for a, b in itertools.pairwise(ends))
    shortest = _shortest(routes)
    if len(ends) > 2 or shortest is None or trade_off.interrupt_guard.stopped():
        return geodesic
    found = certified_distance(context, shortest, seconds=_seconds(trade_off))
    return max(geodesic, found.value) if math.isfinite(found.value) else geodesic
