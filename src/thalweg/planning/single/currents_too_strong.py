"""Later departures where the earliest route meets a current that the ship cannot hold against.

The search samples the sea at stations: its fastest path may pass a strait as the stream begins to
run, a minute before the ship could not hold her course there any more. The referee refuses that
path by a hair. A ship that leaves later waits for the stream to ease.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final

from thalweg.core.errors import NoRouteError
from thalweg.core.time import duration_text
from thalweg.core.units import HOUR
from thalweg.kernels.codes import CURRENT, REASONS
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.single.late_paths import after_wait_at_berth
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.route import Route
from thalweg.route.route import Violation

LEAVES_LATER: Final = "Leaves "  #: a note on such a departure begins so
_DELAYS: Final = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0)  # half a tide [h]


def current_that_stops(route: Route) -> Violation | None:
    """Return where and when a current stops a ship that never arrives; None otherwise."""
    if math.isfinite(route.time_h):
        return None
    return next((v for v in route.violations if v.reason == REASONS[CURRENT]), None)


def leaving_after_current(
    context: PlanningContext,
    stretch: StretchResult,
    window: tuple[float, float],
    search: Callable[[tuple[float, float]], StretchResult],
) -> StretchResult:
    """Return the stretch of a departure up to half a tide later where a current stops the ship.

    Parameters
    ----------
    stretch : Of the earliest departure, as the referee scored it.
    window : First and last departure [s since 1970-01-01T00:00Z].
    search : Returns the stretch of a window of departures.

    Returns
    -------
    StretchResult : With the wait before departure. The given one where no current stops the ship,
        where she may not wait, and where no later departure arrives either.
    """
    stop = current_that_stops(stretch.route)
    if stop is None or window[1] > window[0] or not context.voyage.wait:
        return stretch
    for delay in _DELAYS:
        depart = window[0] + delay * HOUR
        context.report_progress(f"leaving {duration_text(delay * HOUR)} later")
        try:
            later = search((depart, depart))
        except NoRouteError:
            continue
        if not later.route.feasible:
            continue
        route = after_wait_at_berth(context, later.route, stretch.route, window[0])
        if route.feasible:
            note = (
                f"{LEAVES_LATER}{duration_text(delay * HOUR)} later: departing at once, the ship "
                f"meets a {stop}. Departures between were tried every 15 to 60 minutes."
            )
            return replace(later, route=route, result=stretch.result, notes=(*later.notes, note))
    return stretch
