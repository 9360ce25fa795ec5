"""Edges on which the referee finds a limit exceeded between the stations of the network.

The search checks depth, waves and wind at stations, so that a bank or a squall that is narrower
than their distance is seen by the referee alone. Stricter limits do not help there: the edges that
cross it are left out, and the stretch is searched again. A bank of the sea data becomes the charted
depth of the edges over it, since a rising tide may open them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.kernels import codes
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.single.weather_gaps import (
    SAMPLES_PER_CELL,
    SHORTEST_STEP,
    data_spacing,
    edges_where_all,
    least_along_edges,
    near_edges,
)
from thalweg.route import Route
from thalweg.route.route import SPEED_NOT_PREDICTED, Violation
from thalweg.sea import standard_names
from thalweg.ship.condition_variables import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT

MAX_ROUNDS: Final = 8  #: of leaving out edges
_MOST_PLACES: Final = 6  # of one route
_MOST_PATHS: Final = 24  # whose edges are left out before a path is refined
_SAME_WIND: Final = 1e-3  # by which winds that leave too little speed may differ
_DEPTH, _WAVES, _WIND = (
    codes.REASONS[code] for code in (codes.DEPTH, codes.WAVE_HEIGHT, codes.WIND_SPEED)
)
_WITH_PLACES = (_DEPTH, _WAVES, _WIND, SPEED_NOT_PREDICTED)


def exceeded_limits_on_routes(*routes: Route) -> tuple[Violation, ...]:
    """Return where routes exceed a limit of depth, wave height, wind speed or speed loss.

    Parameters
    ----------
    *routes : Scored by the referee.
    """
    found = []
    for route in routes:
        found += [v for v in route.violations if v.reason in _WITH_PLACES][:_MOST_PLACES]
    return tuple(dict.fromkeys(found))


def stricter_limits_help(route: Route) -> bool:
    """Return whether a search with stricter limits may avoid what a route exceeds.

    Where the speed is predicted is no limit that is made stricter.
    """
    return {v.reason for v in route.violations} != {SPEED_NOT_PREDICTED}


def without_exceeding_paths(
    context: PlanningContext,
    network: Network,
    places: Sequence[Violation],
    path_on: Callable[[Network], Route],
) -> Network:
    """Return a network whose path exceeds no limit, without the edges of the paths that do.

    To search and evaluate a path takes a tenth of the computing of its refinement, and the
    refinement of a path that exceeds no limit exceeds none either.

    Parameters
    ----------
    places : Where the first path and its refinement exceed a limit.
    path_on : Returns the path of a network as evaluated.

    Returns
    -------
    Network : The same one where no edge is left out. Its path may exceed a limit where no edge can
        be named, and it may have none.
    """
    for _ in range(_MOST_PATHS):
        left = without_exceeding_edges(context, network, places)
        if left is network:
            return network
        network = left
        try:
            places = exceeded_limits_on_routes(path_on(network))
        except NoRouteError:  # the search for the route states it
            return network
        if not places:
            return network
    return network


def without_exceeding_edges(
    context: PlanningContext, network: Network, places: Sequence[Violation]
) -> Network:
    """Return a network without the edges that exceed a limit at the time of a violation.

    Of edges over a bank of the sea data all get the least depth along them, and where they have it
    already, those at the violation are left out. Of edges in waves or wind, the ones that may pass
    through its place are left out.

    Parameters
    ----------
    context : Request and data of the plan.
    network : The network that was searched.
    places : As `exceeded_limits_on_routes` returns them.

    Returns
    -------
    Network : The same one where no edge is changed or left out.
    """
    keep = np.ones(network.n_edges, bool)
    sailed = np.isnan(network.edges.fixed_time)
    for place in places:
        if place.reason == _DEPTH and standard_names.BED_DEPTH in context.sea.variables:
            shallower = _with_least_depths(context, network, place.time)
            if shallower is not network:
                return shallower

        def kept(lat: np.ndarray, lon: np.ndarray, place: Violation = place) -> np.ndarray:
            return _keeps_limit(context, place, lat, lon)

        rows = np.flatnonzero(keep & sailed & near_edges(network, place))
        keep[rows] = edges_where_all(network, rows, kept, SHORTEST_STEP)
    return network if keep.all() else network.with_some_edges(keep)


def _with_least_depths(context: PlanningContext, network: Network, time: float) -> Network:
    """Return a network whose edges are as deep as the bed along them; the same one if they are."""
    name = standard_names.BED_DEPTH
    rows = np.flatnonzero(np.isnan(network.edges.fixed_time))
    step = max(data_spacing(context.sea, name) / SAMPLES_PER_CELL, SHORTEST_STEP)

    def bed(lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
        return np.asarray(context.sea.sample([name], time, lat, lon)[name], float)

    depth = network.edges.depth.copy()
    depth[rows] = np.minimum(depth[rows], least_along_edges(network, rows, bed, step))
    if np.array_equal(depth, network.edges.depth, equal_nan=True):
        return network
    return network.with_edges(depth=depth)


def _keeps_limit(
    context: PlanningContext, place: Violation, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray:
    """Return where the limit of a violation is not known to be exceeded at its time.

    Edges in unknown weather or over unknown depth stay: search and referee refuse them.
    """
    sea, limits = context.sea, context.needs.limits
    if place.reason == _DEPTH:
        depth = np.full(lat.shape, np.inf)
        if context.chart.has_depth:
            depth = np.asarray(context.chart.depths.at(lat, lon), float)
        names = [standard_names.BED_DEPTH, standard_names.WATER_LEVEL]
        values = sea.sample([n for n in names if n in sea.variables], place.time, lat, lon)
        depth = np.fmin(depth, values.get(standard_names.BED_DEPTH, np.inf))
        depth = depth + values.get(standard_names.WATER_LEVEL, 0.0)
        return np.asarray(~(depth < limits.required_depth))
    if place.reason == _WAVES:
        height = sea.sample([WAVE_HEIGHT], place.time, lat, lon)[WAVE_HEIGHT]
        return np.asarray(~(height > limits.wave_height))
    wind = sea.sample([EASTWARD_WIND, NORTHWARD_WIND], place.time, lat, lon)
    speed = np.hypot(wind[EASTWARD_WIND], wind[NORTHWARD_WIND])
    if place.reason == SPEED_NOT_PREDICTED:
        there = sea.sample([EASTWARD_WIND, NORTHWARD_WIND], place.time, [place.lat], [place.lon])
        met = np.hypot(there[EASTWARD_WIND], there[NORTHWARD_WIND])[0]
        return np.asarray(~(speed >= (1.0 - _SAME_WIND) * met))
    return np.asarray(~(speed > limits.wind_speed))
