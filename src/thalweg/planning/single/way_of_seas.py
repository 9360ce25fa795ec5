"""The way over the graph of all seas as a route to choose from, where the one found is longer.

A network of a long voyage is too coarse for straits: their lanes and shoals are narrower than its
edges, so that it may prefer a strait hundreds of miles off. The graph of all seas knows them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, line_length
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.network import Network, lattice
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals
from thalweg.planning.single.route_candidates import refine_track
from thalweg.route import Route, Track
from thalweg.route.refinement.better_route import comparison_key
from thalweg.route.route import SPEED_NOT_PREDICTED

_OVER_GRAPH: Final = 1.015  # ways over the graph are longer than after string pulling
#: Share of the length of a route from which on a way is tried: a way does not count traffic lanes.
_SHORTER: Final = 0.98
#: Reasons why weather closes a way.
_LIMITS_OF_WEATHER: Final = {
    SPEED_NOT_PREDICTED,
    *(
        codes.REASONS[code]
        for code in (codes.WAVE_HEIGHT, codes.WIND_SPEED, codes.SHIP_RANGE, codes.SAFETY)
    ),
}


def along_way_of_seas(
    context: PlanningContext,
    ends: tuple[Endpoint, Endpoint],
    route: Route,
    searched: Callable[[Network], Route],
    limits: Limits,
) -> Route:
    """Return the better of a route and the one found along the shortest way over the seas.

    Where the network along the way is too coarse for it as well, the way itself is refined.

    Parameters
    ----------
    ends : Of the route.
    route : As evaluated; of a ship that sails the coasts of the world.
    searched : Returns the refined route of a network; raises `NoRouteError`.
    limits : Of the refinement.
    """
    way = _shorter_way(context, ends, float(route.legs["length"].sum()))
    if way is None:
        return route
    lat, lon = np.array(way, float).T
    settings = np.full(len(lat) - 1, context.setting)
    track = Track(lat, lon, route.depart, np.zeros(len(lat)), settings)
    along = context.evaluate(track)
    if context.voyage.objective != "distance" and _weather_is_against(along, route):
        return route
    key = partial(comparison_key, objective=context.voyage.objective, chart=context.chart)
    places = ((end.lat, end.lon) for end in ends)
    with contextlib.suppress(NoRouteError):
        route = min((route, searched(lattice(context.chart, *places, along=way))), key=key)
    if along.feasible and line_length(way) < _SHORTER * float(route.legs["length"].sum()):
        route = min((route, refine_track(context, track, limits)), key=key)
    return route


def _weather_is_against(along: Route, route: Route) -> bool:
    """Return whether weather makes a shorter way slower than a route, or closes it."""
    if along.feasible:
        return along.time_h >= route.time_h
    reasons = {violation.reason.split(":")[0] for violation in along.violations}
    return route.feasible and bool(reasons & _LIMITS_OF_WEATHER)


def _shorter_way(
    context: PlanningContext, ends: tuple[Endpoint, Endpoint], length: float
) -> list[Position] | None:
    """Return the waypoints of the way over the seas; None where it is not clearly shorter [m]."""
    chart = context.chart
    if context.choice.network != "auto" or not chart.passages or chart.area.width < 360.0:
        return None
    seas = replace(Seaways.of_ship_chart(chart), shoals=chart.zones.shoals)
    try:
        path = seas.graph_path(*ends)
        if path_length_and_canals(seas.chart, path)[0] > _OVER_GRAPH * length:
            return None
        path = seas.path(*ends, offing=context.needs.limits.offing)
    except NoRouteError:
        return None
    shorter = path_length_and_canals(seas.chart, path)[0] < _SHORTER * length
    return path if shorter else None
