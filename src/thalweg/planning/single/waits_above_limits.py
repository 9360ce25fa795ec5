"""Routes that arrive later and do not wait at sea in weather above the limits of the ship."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from thalweg.core.time import duration_text
from thalweg.core.units import HOUR, MINUTE
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_texts
from thalweg.planning.single.late_paths import LatePaths, after_wait_at_berth
from thalweg.planning.single.sheltered_waits import routes_with_one_wait, with_sheltered_waits
from thalweg.route import Route
from thalweg.route.refinement.better_route import shorten_waits
from thalweg.search import SearchResult

ARRIVES_LATER: Final = "Arrives "  #: a note on the price of such a route begins so
MOST_LATER: Final = 0.3  #: share of the time of the voyage by which such a route may arrive later
_LATER: Final = (0.01, 0.025, 0.05, 0.1, 0.2, MOST_LATER)  # shares that are tried
_LEAST_LATER: Final = 0.5 * HOUR  # ... and at least [s]
_MOST_WITHOUT_WAITS: Final = 3  # paths without waits that are tried


def without_waits_above_limits(
    context: PlanningContext, route: Route, paths: LatePaths, *, last_departure: float
) -> tuple[Route, list[str]]:
    """Return a route that waits in weather within the limits, and a note on what that takes.

    Parameters
    ----------
    route : As evaluated, with the waits of the earliest arrival.
    paths : Of late departures.
    last_departure : The ship waits at her berth from then on [s since 1970-01-01T00:00Z].

    Returns
    -------
    route : Of the departure that arrives first so. The given one where it waits in no such
        weather, or no other one that arrives at most 30 % of the voyage later was found.
    notes : One where the route is another one.
    """
    above = waiting_weather_texts(route, context.ship) if route.feasible else []
    if not above or context.voyage.objective == "distance":
        return route, []
    latest = route.arrive + max(MOST_LATER * route.time_h * HOUR, _LEAST_LATER)
    latest = min(latest, context.latest_arrival)
    paths = paths.lasting(latest + max(0.0, paths.arrive - route.arrive))
    for found in _late_paths(route, paths, latest):
        if waiting_weather_texts(paths.sail(found), context.ship):
            continue
        tried = after_wait_at_berth(context, paths.refine(found), route, last_departure)
        tried = with_sheltered_waits(context, tried, latest)
        if not tried.feasible or waiting_weather_texts(tried, context.ship):
            continue
        tried = _from_berth(context, tried, latest)
        if tried.arrive <= latest:
            later = tried.arrive - route.arrive
            return tried, [] if later < MINUTE else [arrives_later_note(later, above[0])]
    return route, []


def arrives_later_note(later: float, avoided: str) -> str:
    """Return a note on a route that arrives later [s] than one with a wait in bad weather."""
    return (
        f"{ARRIVES_LATER}{duration_text(later)} later than is possible: to arrive earlier the ship "
        f"would have to wait at sea {avoided}."
    )


def _from_berth(context: PlanningContext, route: Route, latest: float) -> Route:
    """Return a route with its waits at the berth, as short as the limits allow, where that is so.

    A path of a late departure leaves as late as it can.
    """
    if route.track.wait[1:].any():
        at_berth = next(routes_with_one_wait(context, route))
        if not at_berth.feasible or at_berth.arrive > latest:
            return route
        route = at_berth
    return shorten_waits(route, context.evaluate)


def _late_paths(route: Route, paths: LatePaths, latest: float) -> Iterator[SearchResult]:
    """Yield paths that arrive later than a route, but by a time [s since 1970].

    Those without waits come first, then those of the latest departures.
    """
    on_network = paths.arrive - route.arrive  # refinement makes routes faster
    yield from paths.search_without_waits(latest + on_network)[:_MOST_WITHOUT_WAITS]
    for share in _LATER:
        by = min(route.arrive + max(share * route.time_h * HOUR, _LEAST_LATER), latest)
        found = paths.search(by + on_network)
        if found is not None:
            yield found
