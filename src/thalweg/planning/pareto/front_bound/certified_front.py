"""Certified lower bounds of a front: least cost at prices of time, as lines below the front."""

from __future__ import annotations

import itertools
import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.pareto_fronts import higher_of_two_fronts, lower_hull
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.kernels.certificate.cost_conditions import PricedShip
from thalweg.planning.pareto.front_bound.fair_current_lines import (
    WITH_FAIR_CURRENTS,
    fair_current_lines,
)
from thalweg.planning.pareto.front_bound.least_ways import (
    certain_front,
    least_ways,
    passes_counted_canal,
    seconds_of_bound,
    strongest_current_of_plan,
)
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    RefereedCandidate,
    TradeOffContext,
)
from thalweg.planning.plan_front import certain_at
from thalweg.planning.planning_context import greatest_speed_of
from thalweg.planning.single.certified_bound import (
    KEEPING_OUT,
    CurrentsInReach,
    certified_bound,
    currents_in_reach,
    kept_out,
)
from thalweg.route import Route
from thalweg.search import table_bounds
from thalweg.search.certificate.barrier_domain import StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.cost_certificate import CostToBound, certify_costs

_KIND = (
    "certificate: checked in every cell of a mesh that no course and speed costs less than the "
    "bound counts there, for routes of at most {until:.1f} h between the sea ends of approaches"
)
WITH_LEAST_TIME = "with the least time by a map of earliest arrivals"
_LONGER, _HOURS_MORE = (
    2.0,
    24.0,
)  # than the slowest route: later arrivals that lines of currents hold for
_PARTS = 2  # of the time for the proof: one is for the least time in currents
_CONTRADICTION = 2e-3  # by which a front may be above a route, for the errors of tables
_ABOVE_A_ROUTE = "no bound: the line of the proof is above a route of the plan"
_LONGEST_FOR_TIME = 4.0  # by default [s]
_NEAR_ENOUGH = 0.995  # of the time of the fastest route
WITH_DUES = "with the time, dues and fuel of canals, or the way round them"
_MOST_PRICES = 8
_LEAST_GAIN = 1e-5  # share of the greatest value, below which the lines add nothing
AT_SPEEDS = "for routes at the {count} speeds of the plan"  #: part of the kind of a bound
UNTIL_DATA_END = "for arrivals until the data end"  #: part of the kind of a bound
_AFTER = 1e-9  # share of a time, to its next point


@dataclass(frozen=True, eq=False)
class CertifiedFront:
    """A front below all routes of a voyage.

    Attributes
    ----------
    points : Times [h] and values, to be joined by lines, (2, n).
    kind : How it was found and what it holds for.
    until : Times up to here are those that the bound of the whole plan is for [h].
    """

    points: FloatArray
    kind: str
    until: float


def certified_front(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    ordered: Sequence[RefereedCandidate],
) -> CertifiedFront:
    """Return the front that no route is below, by the least length and by barriers of cost.

    Barriers of cost take some seconds to pay: they are searched where a time for the proof is
    given. A front above one of the routes is not published: the sea of the proof is not theirs.

    Parameters
    ----------
    ordered : The front, with routes within the limits or not.
    """
    found = _certified_fronts(trade_off, explored, ordered)
    if (count := len(trade_off.settings)) > 1:
        at_speeds = AT_SPEEDS.format(count=count)
        found = [replace(one, kind=f"{one.kind}; {at_speeds}") for one in found]
    for front in reversed(found):
        if not any(_is_above(front.points, item) for item in ordered):
            return front
    return CertifiedFront(np.zeros((2, 1)), _ABOVE_A_ROUTE, found[0].until)


def _is_above(points: FloatArray, item: RefereedCandidate) -> bool:
    """Return whether a certain front is clearly above a feasible route."""
    route, value = item.route, item.value
    if not (route.feasible and math.isfinite(value)):
        return False
    hours = route.time_h * (1.0 + _CONTRADICTION) + route.tolerance_s / HOUR
    too_late = points[0, 0] > hours
    return bool(too_late or certain_at(points, hours) > value * (1.0 + _CONTRADICTION))


def _certified_fronts(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    ordered: Sequence[RefereedCandidate],
) -> list[CertifiedFront]:
    """Return fronts that no route is below, from the simplest to the best."""
    context, routes = trade_off.context, [item.route for item in ordered]
    latest = min(context.latest_arrival, context.data_end)  # later routes meet unknown sea
    allowed = (latest - context.voyage.earliest_departure) / HOUR
    reached = _currents_in_reach(trade_off, routes, allowed)
    current, kind = strongest_current_of_plan(trade_off, explored, reached)
    ways = least_ways(trade_off, [*routes, *(one.fastest for one in explored)], current)
    longest = max((item.route.time_h for item in ordered if item.route.feasible), default=0.0)
    price = trade_off.objective.prices.time + trade_off.least_price_of_consumption
    unpriced = certain_front(trade_off, ways, current)
    points = with_priced_time(unpriced, price, longest)
    if len(ways) > 1 and passes_counted_canal(trade_off, routes):
        kind = f"{kind}; {WITH_DUES}"
    if context.data_end < context.latest_arrival:
        kind = f"{kind}; {UNTIL_DATA_END}"
    if kept_out(context.chart, routes):
        kind = f"{kind}; for routes {KEEPING_OUT}"
    fronts = [CertifiedFront(points, kind, allowed)]
    if trade_off.interrupt_guard.stopped():
        return fronts
    fair, until_fair, least = fair_current_lines(trade_off, routes, reached)
    unpriced = _not_before(raised_by_lines(unpriced, fair, until_fair), least)
    by_currents = with_priced_time(unpriced, price, longest)
    if _gains(by_currents, points):
        kind = f"{kind}; {WITH_FAIR_CURRENTS}"
    waits = any(route.waiting_h > 0.0 for route in routes)  # for limits that open
    if (waits and price > 0.0) or (
        (current > 0.0 or waits) and context.voyage.objective == "front"
    ):
        certified = _certified_least_time(trade_off, routes, float(by_currents[0, 0]))
        if certified > max(least, float(by_currents[0, 0])):
            kind = f"{kind}; {WITH_LEAST_TIME}"
            by_currents = with_priced_time(_not_before(unpriced, certified), price, longest)
    fronts.append(CertifiedFront(by_currents, kind, allowed))
    if not context.proof_seconds:
        return fronts
    lines, until, sampling = certified_lines(trade_off, ordered, seconds=context.proof_seconds)
    raised = higher_of_two_fronts(raised_by_lines(points, lines, until), by_currents)
    if _gains(raised, by_currents):
        kind = _KIND.format(until=until) + (f", in {sampling}" if sampling else "") + f"; {kind}"
        fronts.append(CertifiedFront(raised, kind, min(allowed, until)))
    return fronts


def _currents_in_reach(
    trade_off: TradeOffContext, routes: Sequence[Route], allowed: float
) -> CurrentsInReach | None:
    """Return the currents that routes no slower than the slowest can meet; None if not searched.

    All routes that arrive within the ``allowed`` time [h], where that is little longer.
    """
    feasible = [route for route in routes if route.feasible]
    if not feasible or trade_off.interrupt_guard.stopped():
        return None
    slowest = max(feasible, key=lambda route: route.time_h)
    most = min(_LONGER * slowest.time_h, slowest.time_h + _HOURS_MORE)
    longest = allowed if slowest.time_h < allowed <= most else slowest.time_h
    return currents_in_reach(trade_off.context, slowest, longest=longest * HOUR)


def _certified_least_time(
    trade_off: TradeOffContext, routes: Sequence[Route], least: float
) -> float:
    """Return a time [h] that no route takes less than, by a certificate.

    0 where there is none, and where the least time that is known already is near enough.
    """
    context, known = trade_off.context, [route for route in routes if route.feasible]
    if len(trade_off.ends) > 2 or not known or not _is_fastest_setting(trade_off):
        return 0.0
    fastest = min(known, key=lambda route: route.time_h)
    apart = len(kept_out(context.chart, [fastest])) != len(kept_out(context.chart, routes))
    if apart or least > _NEAR_ENOUGH * fastest.time_h:
        return 0.0
    seconds = seconds_of_bound(trade_off, clock.perf_counter(), _PARTS)
    seconds = min(seconds, _LONGEST_FOR_TIME) if context.proof_seconds is None else seconds
    departures = fastest.depart, max(route.depart for route in known)
    found = certified_bound(context, fastest, departures=departures, seconds=seconds)
    return found.value / HOUR if found.value > 0.0 else 0.0


def _is_fastest_setting(trade_off: TradeOffContext) -> bool:
    """Return whether the setting of the plan is the fastest in all weather."""
    context = trade_off.context
    tops = [greatest_speed_of(context.ship, context.table, int(s)) for s in trade_off.settings]
    top = greatest_speed_of(context.ship, context.table, context.setting)
    if max(tops) > top:
        return False
    if not context.table.axes or context.sea_is_calm:
        return True
    table = context.table.before_closing()
    parts = [part.values[..., trade_off.settings] for part in table.parts]
    highest = [part.values[..., context.setting, None] for part in table.parts]
    rising = all(np.all((a <= b) | np.isnan(a)) for a, b in zip(parts, highest, strict=True))
    return context.table.finish is None and rising


def with_priced_time(certain: FloatArray, price: float, longest: float) -> FloatArray:
    """Return a certain front where every route pays for all of its time, waits included.

    Parameters
    ----------
    certain : Times [h] and values beyond the price of time, to be joined by lines, (2, n).
    price : Of time [1/s], with the least consumption in a second.
    longest : Time of the slowest route that counts [h].
    """
    if not (price > 0.0 and certain.size):
        return certain
    if longest > certain[0, -1]:
        certain = np.append(certain, [[longest], [certain[1, -1]]], axis=1)
    return np.array([certain[0], certain[1] + price * HOUR * certain[0]])


def _gains(raised: FloatArray, points: FloatArray) -> bool:
    """Return whether a certain front is clearly above an earlier one."""
    gain = raised[1] - np.interp(raised[0], points[0], points[1])
    enough = _LEAST_GAIN * raised[1].max(initial=0.0)
    later = raised.size and raised[0, 0] > points[0, 0] * (1.0 + _LEAST_GAIN)
    return bool(later or gain.max(initial=0.0) > enough)


def _not_before(certain: FloatArray, least: float) -> FloatArray:
    """Return a certain front without the times before the least one that is possible [h]."""
    if not certain.size or not certain[0, 0] < least:
        return certain
    value = certain_at(certain, least)
    after = certain[:, certain[0] > least]
    if not after.size:  # level from the least time on
        after = np.array([[2.0 * least], [value]])
    return np.append(np.array([[least], [value]]), after, axis=1)


def certified_lines(
    trade_off: TradeOffContext, ordered: Sequence[RefereedCandidate], *, seconds: float
) -> tuple[FloatArray, float, str]:
    """Return lines that no point of a front is below, until the slowest of its routes.

    Parameters
    ----------
    ordered : The front, with routes within the limits or not.
    seconds : Time that the search for the bounds may take [s].

    Returns
    -------
    lines : float64 array (2, n)
        Prices of time [1/h], and the least values plus priced time; none where a canal may shorten
        the way, with via points, and for ships whose speed is a field of the sea.
    until : float
        Longest time that they hold for [h].
    sampling : str
        How the sea of the proof differs from the data; "" where it does not.
    """
    none = np.empty((2, 0)), 0.0, ""
    feasible = [item for item in ordered if item.route.feasible and math.isfinite(item.value)]
    context = trade_off.context
    if len(trade_off.ends) > 2 or not feasible or context.ship.speed_field is not None:
        return none
    hours = np.array([item.route.time_h for item in feasible])
    values = np.array([item.value for item in feasible])
    cost = _cost_to_bound(trade_off, feasible)
    prices = _prices_of_time(hours, values)
    known = np.array([float((values + price * hours).min()) for price in prices])
    found = certify_costs(cost, prices / HOUR, known, seconds=seconds)
    if not found.cells:
        return none
    values = trade_off.table_margin * found.values
    return np.array([prices, values]), float(hours.max()), found.sampling


def _prices_of_time(hours: FloatArray, values: FloatArray) -> FloatArray:
    """Return prices of time [1/h] at which a front is supported, no more than a few."""
    hull = lower_hull(hours, values)
    pairs = itertools.pairwise(hull)
    slopes = [(values[a] - values[b]) / (hours[b] - hours[a]) for a, b in pairs]
    known = np.unique([0.0, *(slope for slope in slopes if slope > 0.0)])
    if known.size > _MOST_PRICES - 1:
        known = np.quantile(known, np.linspace(0.0, 1.0, _MOST_PRICES - 1))
    steeper = 4.0 * known[-1] if known[-1] > 0.0 else values.min() / hours.min()
    return np.append(known, steeper)


def _cost_to_bound(trade_off: TradeOffContext, feasible: list[RefereedCandidate]) -> CostToBound:
    context, prices = trade_off.context, trade_off.objective.prices
    table = trade_off.consumption.kernel_arrays()
    settings = np.asarray(trade_off.settings, np.int64)
    least = np.maximum(table_bounds(table, np.fmin), 0.0)[settings]
    top = np.array([greatest_speed_of(context.ship, context.table, int(s)) for s in settings])
    priced = PricedShip(settings, table, least, top)
    ship = ShipInBarrier(
        context.table.before_closing().kernel_arrays(),
        int(settings[np.argmax(top)]),
        context.needs.limits.array,
        float(top.max()),
    )
    routes = [item.route for item in feasible]
    lat, lon = routes[0].track.lat, routes[0].track.lon
    departures = [route.depart for route in routes]
    stretch = StretchToBound(
        context.sea, context.chart, ship, context.needs.channels,
        (float(lat[0]), float(lon[0])), (float(lat[-1]), float(lon[-1])),
        depart=min(departures), known=max(route.time_h for route in routes) * HOUR,
        latest=max(departures), kept_out=kept_out(context.chart, routes),
    )  # fmt: skip
    factor = 1.0
    if prices.dues > 0.0:  # a route off the network may sail in the cheapest zone throughout
        factor = min([1.0, *(float(one) for _, one in context.chart.zones.price)])
    return CostToBound(
        stretch, priced, factor * prices.inside, factor * prices.outside, prices.time
    )


def raised_by_lines(certain: FloatArray, lines: FloatArray, until: float) -> FloatArray:
    """Return a certain front raised to lines that hold until a time.

    Parameters
    ----------
    certain : Times [h] and values, to be joined by lines that bend upwards, (2, m).
    lines : Prices of time [1/h] and least values plus priced time, (2, n).
    until : [h]

    Returns
    -------
    float64 array (2, k)
        Times from the first of ``certain`` on; after ``until`` that front itself.
    """
    if not lines.size or not certain.size or until <= certain[0, 0]:
        return certain
    slopes, offsets = [-lines[0], [0.0]], [lines[1], [certain[1].min()]]
    with np.errstate(divide="ignore"):
        slope = np.diff(certain[1]) / np.diff(certain[0])
    slopes.append(slope)
    offsets.append(certain[1, :-1] - slope * certain[0, :-1])
    a, b = np.concatenate(slopes), np.concatenate(offsets)
    first, second = np.triu_indices(a.size, 1)
    crossing = a[first] != a[second]
    first, second = first[crossing], second[crossing]
    times = (b[second] - b[first]) / (a[first] - a[second])
    times = times[(times > certain[0, 0]) & (times < until)]
    times = np.unique([certain[0, 0], *times, until])
    values = (a[:, None] * times + b[:, None]).max(axis=0)
    later = certain[0] > until
    after = until * (1.0 + _AFTER)
    if not later.any() and values[-1] <= certain[1, -1]:
        return np.array([times, values])
    times = np.concatenate([times, [after], certain[0, later]])
    values = np.concatenate([values, [np.interp(after, *certain)], certain[1, later]])
    return np.array([times, values])
