"""Routes of a stretch to choose from: by the network, by its bound and by the data themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from thalweg.core.limits import Limits
from thalweg.core.units import HOUR
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.single.certified_bound import path_through_data
from thalweg.route import RefinementConditions, Route, Track, better_route
from thalweg.route.refinement.better_route import comparison_key
from thalweg.search import LowerBound, SearchResult

#: Gap to the bound [fraction] above which the path of the bound is refined as well.
_WIDE_GAP = 0.01
#: Searches through the data for what is narrower than the network, and the gain for another one.
_MOST_RASTERS, _WORTH_ANOTHER = 4, 2e-3
_WORTH_REFINING = 1e-4  # gain of a later departure for which the route is refined again
#: Later departures that are tried where a window leaves the choice [min].
_LATER = (1, 2, 3, 5, 8, 13, 21, 34, 55)


def refined_bound_path(
    context: PlanningContext,
    network: Network,
    bound: LowerBound,
    result: SearchResult,
    route: Route,
    limits: Limits,
) -> Route:
    """Where the gap is wide, refine the path of the bound as well and return the better route.

    In weather that passes quickly the best path depends on delays along the network; the path of
    the bound has the times of a ship in open water. A path through nodes of the path that has been
    refined, or through all of them, is pulled to the same line.
    """
    value = route_value(context, route)
    if len(bound.path) < 2 or not value - bound.value > _WIDE_GAP * value:
        return route
    common = len(np.intersect1d(bound.path, result.path))
    if common == min(len(bound.path), len(result.path)) and not _waits(result):
        return route
    lat, lon = network.stations.lat[bound.path], network.stations.lon[bound.path]
    settings = np.full(len(lat) - 1, context.setting)
    other = refine_track(context, Track(lat, lon, route.depart, None, settings), limits)  # type: ignore[arg-type]
    routes = (route, other)  # with penalty zones, as in the search
    return min(
        routes, key=lambda item: comparison_key(item, context.voyage.objective, context.chart)
    )


def _waits(result: SearchResult) -> bool:
    """Return whether a ship waits on the path of a search before its end."""
    return bool(np.any(result.path_depart[:-1] - result.path_arrive[:-1] >= 1.0))


def through_narrow_features(context: PlanningContext, route: Route, limits: Limits) -> Route:
    """Return the better of a route and one along a fast way through the data, refined.

    The stations of a network may lie on both sides of a narrow jet that the data have.
    """
    for _ in range(_MOST_RASTERS):  # a better route leaves a smaller region, and a finer raster
        found = path_through_data(context, route)
        if found is None:
            break
        settings = np.full(len(found[0]) - 1, context.setting)
        other = refine_track(context, Track(*found, route.depart, None, settings), limits)  # type: ignore[arg-type]
        before, key = (
            route,
            partial(comparison_key, objective=context.voyage.objective, chart=context.chart),
        )
        route = min((route, other), key=key)
        if route is before or route.time_h > (1.0 - _WORTH_ANOTHER) * before.time_h:
            break
    return route


def departing_later(
    context: PlanningContext, tracks: Sequence[Track], route: Route, limits: Limits, last: float
) -> Route:
    """Return the better of a route and tracks that depart a little later, refined.

    The first of many equal departures is that at which a limit opens, and the referee, which looks
    between the stations, may find it exceeded still.

    Parameters
    ----------
    tracks : Departing no later than the route.
    last : Latest departure [s since 1970-01-01T00:00Z].
    """
    key = partial(comparison_key, objective=context.voyage.objective, chart=context.chart)
    departures = [route.depart + 60.0 * minutes for minutes in _LATER]
    later = [
        context.evaluate(replace(track, depart=depart, wait=np.zeros(len(track.lat))))
        for depart in departures
        if depart <= last
        for track in tracks
    ]
    later = [one for one in later if one.arrive <= context.latest_arrival]
    best = min([route, *later], key=key)
    if best is route or route_value(context, best) > (1.0 - _WORTH_REFINING) * route_value(
        context, route
    ):
        return route
    return min((route, refine_track(context, best.track, limits)), key=key)


def route_value(context: PlanningContext, route: Route) -> float:
    """Return the value by which routes are compared: length [m] or time [s]."""
    if context.voyage.objective == "distance":
        return float(route.legs["length"].sum())
    return route.time_h * HOUR


def refine_track(context: PlanningContext, track: Track, limits: Limits) -> Route:
    """Evaluate a track, refine it, and return the better route."""
    context.report_progress("refining the route")
    scored = context.evaluate(track)
    context.show_route(scored)
    conditions = RefinementConditions(
        context.ship, context.sea, context.chart, context.table, limits, context.min_ukc
    )
    refined = better_route(
        scored,
        conditions,
        objective="distance" if context.voyage.objective == "distance" else "time",
        wait=context.voyage.wait,
    )
    context.show_route(refined)
    return refined


def track_from_result(network: Network, result: SearchResult, setting: int) -> Track:
    """Return a path on the network as a track with its waits."""
    places = network.stations.lat[result.path], network.stations.lon[result.path]
    arrive, depart = result.path_arrive, result.path_depart
    return Track.along_path(*places, arrive=arrive, depart=depart, setting=setting)
