"""Waits of routes that trade time for cost: long enough for the referee, and few."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.pareto.waiting.waits_in_shelter import with_waits_in_shelter
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_warnings
from thalweg.planning.single.sheltered_waits import routes_with_one_wait
from thalweg.route import Route, Track
from thalweg.route.route import SPEED_NOT_PREDICTED

#: Limits that open with time.
_OPENING: Final = {
    SPEED_NOT_PREDICTED,
    *(codes.REASONS[code] for code in (codes.DEPTH, codes.WAVE_HEIGHT, codes.WIND_SPEED)),
}
#: By how much waits are lengthened, or else shortened where a limit closes, in turn [s].
_CHANGES: Final = (
    *(0.0, 20.0, 60.0, 180.0, 420.0, 900.0, 1800.0, 3600.0, 7200.0),
    *(-60.0, -180.0, -420.0, -900.0, -1800.0),
)
_ACCURACY: Final = 30.0  # of a wait that is lengthened [s]
_MANY: Final = 4  # waits of a route in place of which one wait is worth ...
_WORTH: Final = 0.02  # ... this share of the time and of the value
#: By how much a route with fewer waits may arrive later [s], and cost more.
_LATER, _DEARER = 60.0, 1e-3


def with_waits_long_enough(
    context: PlanningContext,
    route: Route,
    score: Callable[[Track], Route],
    screen: WaitScreen | None = None,
) -> Route:
    """Return a route that breaks a limit too early with a wait that is long enough, if one is.

    The network knows when a limit opens at its stations only; the referee looks between them.

    Parameters
    ----------
    route : As evaluated.
    score : Evaluates a track.
    screen : Waits that it refuses are not evaluated.

    Returns
    -------
    Route
        At the same speeds, with all waits at the start, or else with the last one before the
        breach changed. The given one where it is feasible, breaks a limit that does not open, may
        not wait, or where no wait up to two hours longer or half an hour shorter keeps the limits.
    """
    if route.feasible or not context.voyage.wait or not math.isfinite(route.arrive):
        return route
    if not {violation.reason.split(":")[0] for violation in route.violations} <= _OPENING:
        return route
    for wait, place in _places_of_waits(route):
        found = _with_least_wait(context, route.track, wait, place, score, screen)
        if found is not None:
            return found
    return route


def with_fewer_waits_of_front(
    route: Route,
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
    context: PlanningContext,
    screen: WaitScreen | None = None,
) -> Route:
    """Return a route with its waits put together, where it arrives as early and costs no more.

    Where the ship would wait in weather above her limits she waits elsewhere, if that is worth it
    (`with_waits_in_shelter`).

    Parameters
    ----------
    route : As evaluated.
    score : Evaluates a track.
    value : Of a route, to be small.
    screen : Waits that it refuses are not evaluated.
    """
    wait = np.asarray(route.track.wait)
    if not route.feasible or np.count_nonzero(wait[1:]) == 0:
        return route
    ship, most = context.ship, value(route) * (1.0 + _DEARER)
    if np.count_nonzero(wait) >= _MANY:
        route = _with_one_wait(route, score, value, context, screen)
    else:
        latest = max(min(route.arrive + _LATER, context.latest_arrival), route.arrive)
        met = len(waiting_weather_warnings(route, ship))
        for tried in routes_with_one_wait(
            context, route, score, screen.may_keep if screen else None
        ):
            if not tried.feasible or tried.arrive > latest or value(tried) > most:
                continue
            if len(waiting_weather_warnings(tried, ship)) <= met:
                route = tried
                break
    if screen is not None and waiting_weather_warnings(route, ship):
        return with_waits_in_shelter(route, score, value, context, screen)
    return route


def _with_one_wait(
    route: Route,
    score: Callable[[Track], Route],
    value: Callable[[Route], float],
    context: PlanningContext,
    screen: WaitScreen | None,
) -> Route:
    """Return a route with many waits with the least one at its start, if that is worth it."""
    together = np.zeros(len(route.track.wait))
    together[0] = total = float(np.sum(route.track.wait))
    found = _with_least_wait(context, route.track, together, 0, score, screen)
    too_short = 0.0
    while found is not None and total - too_short > _LATER:
        together[0] = 0.5 * (too_short + total)
        shorter = score(route.track.replaced(wait=together))
        if shorter.feasible and shorter.arrive <= found.arrive:
            found, total = shorter, float(together[0])
        else:
            too_short = float(together[0])
    if found is None or found.time_h > (1.0 + _WORTH) * route.time_h:
        return route
    return found if value(found) <= (1.0 + _WORTH) * value(route) else route


def _places_of_waits(route: Route) -> Iterator[tuple[np.ndarray, int]]:
    """Yield waits of a track, and at which waypoint they are lengthened."""
    wait = np.asarray(route.track.wait, float)
    together = np.zeros(wait.size)
    together[0] = wait.sum()
    yield together, 0
    first = min(violation.time for violation in route.violations)
    departs = np.concatenate([[route.depart], route.legs["depart"][1:]])
    before = np.flatnonzero((wait[:-1] > 0.0) & (departs <= first))
    if before.size and before[-1] > 0:
        yield wait, int(before[-1])


def _with_least_wait(
    context: PlanningContext,
    track: Track,
    wait: np.ndarray,
    place: int,
    score: Callable[[Track], Route],
    screen: WaitScreen | None,
) -> Route | None:
    """Return the track with the wait at a waypoint changed least so that it keeps all limits."""

    def changed(more: float) -> FloatArray:
        longer = np.array(wait)
        longer[place] += more
        return longer

    def tried(more: float) -> Route | None:
        route = score(track.replaced(wait=changed(more)))
        kept = route.feasible and route.arrive <= context.latest_arrival + 1.0
        return route if kept else None

    changes = [more for more in _CHANGES if wait[place] + more >= 0.0]
    may_keep = np.ones(len(changes), bool)
    if screen is not None:
        may_keep = screen.may_keep(track, np.array([changed(more) for more in changes]))
    too_short, kept = -math.inf, None
    for more, may in zip(changes, may_keep, strict=True):
        kept = tried(more) if may else None
        if kept is not None:
            break
        too_short = max(too_short, more)
    if kept is None or more <= 0.0:
        return kept
    while more - too_short > _ACCURACY:
        middle = 0.5 * (too_short + more)
        shorter = tried(middle)
        if shorter is None:
            too_short = middle
        else:
            more, kept = middle, shorter
    return kept
