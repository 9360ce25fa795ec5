"""Routes that arrive as early with fewer waits: the ship leaves as late as she can and sails on."""

from __future__ import annotations

import math
from itertools import islice

import numpy as np

from thalweg.core.geodesy import distance
from thalweg.core.time import duration_text, format_time
from thalweg.core.units import HOUR, MINUTE
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import (
    LEAST_WAIT_H,
    PASSES_TIME,
    stemming_warnings,
    waiting_weather_warnings,
)
from thalweg.planning.single.late_paths import LatePaths, after_wait_at_berth
from thalweg.planning.single.sheltered_waits import routes_with_one_wait, with_sheltered_waits
from thalweg.planning.single.waits_above_limits import (
    ARRIVES_LATER,
    without_waits_above_limits,
)
from thalweg.route import Route
from thalweg.route.refinement.better_route import comparison_key, shorten_waits

#: By how much a route with fewer waits may arrive later: a minute [s], or this share of the voyage.
_LATER, _LATER_SHARE = 60.0, 1e-3
#: ... where she would stem a current otherwise.
_LATER_THAN_STEMMING, _SHARE_OF_STEMMING = 600.0, 0.01
_ROUNDING = 0.5  # of arrivals that are equal [s]
_WORTH = 1e-3  # share of the time under way that is worth another route with as many waits
_MOST_REFINED = 3  # departures whose paths are refined
_MOST_JOINED = 64  # waits that are joined with others one by one
_MUCH_LONGER = 1.2  # times as long under way: a ship that may not wait passes the time


def with_best_waits(
    context: PlanningContext, route: Route, paths: LatePaths, *, last_departure: float
) -> tuple[Route, list[str]]:
    """Return a route with as few waits as possible, in weather within the limits if there is some.

    Parameters
    ----------
    route : As evaluated.
    paths : Of late departures.
    last_departure : The ship waits at her berth from then on [s since 1970-01-01T00:00Z].

    Returns
    -------
    route : It arrives at most a minute later, or up to 30 % of the voyage where the ship would
        wait at sea in weather above her limits.
    notes : What such a wait takes.
    """
    latest = latest_allowed(context, route, share=math.inf)
    best = with_sheltered_waits(context, route, latest)
    notes: list[str] = []
    if context.leaves_later:
        sheltered, notes = without_waits_above_limits(
            context, best, paths, last_departure=last_departure
        )
        if sheltered is not best:
            return sheltered, notes
    fewer = with_fewer_waits(context, best, paths, last_departure=last_departure)
    later, stems = fewer.arrive - best.arrive, stemming_warnings(best)
    if later > _LATER and stems and not stemming_warnings(fewer):
        text = stems[0].partition(":")[2].partition(". ")[0].strip()
        notes = [
            f"{ARRIVES_LATER}{duration_text(later)} later than is possible: to arrive earlier the "
            f"ship would stem the current, {text}."
        ]
    return with_sheltered_waits(context, fewer, latest), notes


def latest_allowed(context: PlanningContext, route: Route, *, share: float = _LATER_SHARE) -> float:
    """Return until when a route with fewer or better waits may arrive [s since 1970].

    Parameters
    ----------
    route : With the waits that were found first.
    share : Of its time, by which the other one is not later either.
    """
    later = min(_LATER, share * route.time_h * HOUR)
    if share < math.inf and stemming_warnings(route) and context.voyage.wait:
        later = max(later, min(_LATER_THAN_STEMMING, _SHARE_OF_STEMMING * route.time_h * HOUR))
    return max(min(route.arrive + later, context.latest_arrival), route.arrive)


def with_fewer_waits(
    context: PlanningContext, route: Route, paths: LatePaths, *, last_departure: float
) -> Route:
    """Return a route that arrives as early with fewer waits, or as many and less time under way.

    Parameters are those of `with_best_waits`.

    Returns
    -------
    Route
        The given one where no other is better. It arrives at most a minute later, or a thousandth
        of the voyage where that is less, and obeys all limits as the referee judges them.

    Notes
    -----
    The waits of the route are put together first. The other route is that of the latest departure
    that arrives by the same time: she has no time to spare for waits and detours. It replaces one
    without waits, too, that stems a current with hardly any way over ground.
    """
    stems = bool(stemming_warnings(route)) and context.voyage.wait
    if not route.feasible or (route.waiting_h <= LEAST_WAIT_H and not stems):
        return route
    latest = latest_allowed(context, route)
    best = _with_joined_waits(context, _with_wait_at_start(context, route, latest), latest)
    if context.voyage.objective == "distance":
        return best
    if _count(best) == 1 and _times_direct(best) < 1.0 + _WORTH:
        return best
    # refinement shortens both paths: the arrival is compared on the network first
    later, no_later = latest - route.arrive, math.inf
    for _ in range(_MOST_REFINED):
        found = paths.search(max(route.arrive, paths.arrive) + later, no_later)
        if found is None:
            break
        under_way = found.duration - found.waiting
        if _count(best) == 1 and under_way > (1.0 - _WORTH) * _under_way(best):
            break
        tried = after_wait_at_berth(context, paths.refine(found), route, last_departure)
        if tried.feasible:
            tried = _with_joined_waits(context, tried, latest)
        if tried.feasible and tried.arrive > route.arrive + _ROUNDING:
            shorter = shorten_waits(tried, context.evaluate)
            tried = tried if stems and stemming_warnings(shorter) else shorter
        if _is_allowed(context, tried, route, latest):
            best = min(best, tried, key=_waits_and_stems)
            break
        later, no_later = _ROUNDING, found.depart - max(tried.arrive - latest, _LATER)
    return best


def passing_time_notes(
    context: PlanningContext, route: Route, paths: LatePaths, start: str
) -> list[str]:
    """Return a note where a ship that may not wait sails on to and fro to pass the time.

    Parameters
    ----------
    route : As evaluated, of a voyage without waits.
    paths : Of late departures.
    start : Name of the place that the route leaves.
    """
    if context.voyage.wait or not route.feasible or context.voyage.objective == "distance":
        return []
    if _times_direct(route) < _MUCH_LONGER:
        return []
    latest = latest_allowed(context, route)
    found = paths.search(max(latest, paths.arrive))
    if found is None or not route.time_h * HOUR > _MUCH_LONGER * found.duration:
        return []
    late = paths.refine(found)
    sails = (
        f"{PASSES_TIME}: the ship sails {route.distance_nm:.0f} nm to pass the time, "
        f"{route.distance_nm / late.distance_nm:.1f} times what she needs."
    )
    if not late.feasible or late.arrive > latest:
        return [f"{sails} Depart later, or permit waits."]
    first = route.depart == context.voyage.earliest_departure
    leave = late.track.depart - (context.approach_times[0] if first else 0.0)
    return [
        f"{sails} Leaving {start} at {format_time(leave)} she arrives {_how_early(route, late)} "
        f"after {late.distance_nm:.0f} nm: depart then, or permit waits."
    ]


def _how_early(route: Route, other: Route) -> str:
    """Return how much earlier another route arrives: "as early", or "2 h earlier"."""
    earlier = route.arrive - other.arrive
    return "as early" if earlier < 5.0 * MINUTE else f"{duration_text(earlier)} earlier"


def _waits_and_stems(route: Route) -> tuple[bool, int, float]:
    """Return what is less for the better of routes that arrive as early."""
    return bool(stemming_warnings(route)), _count(route), _under_way(route)


def _count(route: Route) -> int:
    return int(np.count_nonzero(np.asarray(route.track.wait)))


def _under_way(route: Route) -> float:
    """Return the time under way [s]: at one setting the fuel grows with it."""
    return float(route.time_h - route.waiting_h) * HOUR


def _times_direct(route: Route) -> float:
    """Return the length of a route over that of the geodesic between its ends."""
    lat, lon = route.track.lat[[0, -1]], route.track.lon[[0, -1]]
    direct = float(distance(lat[0], lon[0], lat[1], lon[1]))
    return float(route.legs["length"].sum()) / max(direct, 1.0)


def _is_allowed(context: PlanningContext, tried: Route, route: Route, latest: float) -> bool:
    """Return whether a route may replace another one, as far as arrival and limits go."""
    if not tried.feasible or tried.arrive > latest:
        return False
    objective, chart = context.voyage.objective, context.chart
    value, most = (comparison_key(one, objective, chart)[1] for one in (tried, route))
    if value > most + max(latest - route.arrive, 0.0):  # with the additions of penalty zones
        return False
    met = [len(waiting_weather_warnings(one, context.ship)) for one in (tried, route)]
    return met[0] <= met[1]


def _with_wait_at_start(context: PlanningContext, route: Route, latest: float) -> Route:
    """Return a route with its only wait at its start, if arrival and limits allow that."""
    if _count(route) != 1 or route.track.wait[0]:
        return route
    for tried in islice(routes_with_one_wait(context, route), 2):  # of the first waypoint
        if _is_allowed(context, tried, route, latest):
            return tried
    return route


def _with_joined_waits(context: PlanningContext, route: Route, latest: float) -> Route:
    """Return a route whose waits are put together as far as arrival and limits allow."""
    if _count(route) < 2:
        return route
    for tried in routes_with_one_wait(context, route):
        if _is_allowed(context, tried, route, latest):
            return tried
    for place in np.flatnonzero(route.track.wait)[:0:-1][:_MOST_JOINED]:
        earlier = np.flatnonzero(route.track.wait[:place])
        if not (route.track.wait[place] and earlier.size):  # joined with a later one
            continue
        for source, target in ((place, earlier[-1]), (earlier[-1], place)):
            wait = np.array(route.track.wait, float)
            wait[target] += wait[source]
            wait[source] = 0.0
            tried = context.evaluate(route.track.replaced(wait=wait))
            if _is_allowed(context, tried, route, latest):
                route = tried
                break
    return route
