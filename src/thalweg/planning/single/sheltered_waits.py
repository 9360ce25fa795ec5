"""Waits moved to earlier places, where the weather is within the limits of the ship."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_warnings
from thalweg.route import Route, Track

_MOST_PLACES: Final = 16  # at which the wait is tried
_MORE: Final = 20.0  # of a wait that breaks one limit [s]


def with_sheltered_waits(context: PlanningContext, route: Route, latest: float) -> Route:
    """Return a route that waits where its limits of weather are kept, if it arrives as early.

    The search counts weather under way only, and waits as late as it can. So the ship may lie at
    sea in a storm that she could have waited for at her berth. All waits are put together, at the
    first waypoint where that is possible.

    Parameters
    ----------
    route : As evaluated.
    latest : Latest arrival with the waits elsewhere [s since 1970-01-01T00:00Z].
    """
    ship = context.ship
    if not (route.feasible and route.waiting_h > 0.0):
        return route
    if not waiting_weather_warnings(route, ship):
        return route
    for tried in routes_with_one_wait(context, route):
        early = tried.feasible and tried.arrive <= latest
        if early and not waiting_weather_warnings(tried, ship):
            return tried
    return route


def routes_with_one_wait(
    context: PlanningContext,
    route: Route,
    score: Callable[[Track], Route] | None = None,
    screen: Callable[[Track, FloatArray], BoolArray] | None = None,
) -> Iterator[Route]:
    """Yield a route with all its waits at one waypoint, from the first to the last where it waits.

    Parameters
    ----------
    route : With one wait or more.
    score : Evaluates a track; that of the context by default.
    screen : Waits at the waypoints [s] (rows) that it refuses are not evaluated.
    """
    score = score or context.evaluate
    waits = np.array(list(_rows_with_one_wait(context, route.track)))
    for row in waits if screen is None else waits[screen(route.track, waits)]:
        tried = score(route.track.replaced(wait=row))
        yield tried
        if len(tried.violations) == 1:  # a limit may open between two points of the referee
            longer = np.where(row > 0.0, row + _MORE, 0.0)
            yield score(route.track.replaced(wait=longer))


def _rows_with_one_wait(context: PlanningContext, track: Track) -> Iterator[FloatArray]:
    """Yield the waits at the waypoints of a track with all of them at one [s]."""
    wait = np.asarray(track.wait, float)
    last = int(np.flatnonzero(wait)[-1])
    for place in np.unique(np.linspace(0, last, min(last + 1, _MOST_PLACES)).astype(int)):
        position = track.lat[place], track.lon[place]
        if place and not context.chart.zones.may_wait(*position):
            continue
        moved = np.zeros(wait.size)
        moved[place] = wait.sum()
        yield moved
