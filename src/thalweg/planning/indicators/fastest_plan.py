"""The route of a plan of least time in place of one that waits on the network of all figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from thalweg.core.errors import NoRouteError
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.stretch import plan_stretch
from thalweg.route import Route

_LONG_WAIT: Final = 0.5  # [h] from which on a plan of least time is made


def fastest_of_plan(context: PlanningContext, ends: Sequence[Endpoint], route: Route) -> Route:
    """Return the route of a plan of least time where it is faster than one with a long wait.

    A limit of motions may close the network of all figures where a finer one keeps it.

    Parameters
    ----------
    ends : Of the route; with via points between them the route is not changed.
    route : The fastest of the network, as evaluated.
    """
    if len(ends) != 2 or route.waiting_h <= _LONG_WAIT:
        return route
    voyage = replace(context.voyage, objective="time", weights={})
    window = route.depart, route.depart
    try:
        other = plan_stretch(replace(context, voyage=voyage), ends[0], ends[1], window).route
    except NoRouteError:
        return route
    return other if other.feasible and other.arrive < route.arrive - 1.0 else route
