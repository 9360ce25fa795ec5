"""Exploration of one route alternative: its fastest route and the exact front of its network."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.interrupt import SearchInterrupted
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.network import Network, eca_fractions
from thalweg.planning.frozen_sea import FrozenSea
from thalweg.planning.network_selection.bed_along_edges import bed_layer
from thalweg.planning.network_selection.bed_network import near_line
from thalweg.planning.network_selection.route_alternatives import (
    MAX_FRONT_NODES,
    OPEN_SEA,
    RouteAlternative,
    canals_used,
)
from thalweg.planning.pareto.edge_costs import edge_costs
from thalweg.planning.pareto.search_horizon import SearchHorizon, extend_horizon, searched_water
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TradeOffContext,
    spread_settings,
)
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.single.isochrones import isochrones
from thalweg.planning.single.no_route_diagnosis import (
    late_arrival_error,
    no_route_error,
    unreached_goal_error,
)
from thalweg.planning.single.route_candidates import refine_track, track_from_result
from thalweg.planning.single.stretch import plan_stretch
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.planning.single.weather_gaps import (
    MAX_GAPS,
    check_times_known,
    data_gaps_on_route,
    without_unknown_edges,
)
from thalweg.route import Route
from thalweg.route.route import Violation
from thalweg.sea import StationFields
from thalweg.search import (
    FrontQuery,
    MultiSettingShipOnNetwork,
    NetworkFront,
    pareto_front,
)
from thalweg.search.pareto.discretisation import TABLE_TOLERANCE

#: Number of time bins of a front; refinement corrects what they miss.
_TIME_BINS = 300
#: Wait of a fastest route [h] from which on it is held against a plan of least time, and gain [s]
#: from which on that one is taken.
_LONG_WAIT, _EARLIER = 0.5, 60.0
_SOONER = 0.02  # of its time that another network must save to take the place of one
#: Settings, and tolerance of the tables of edges, where paths are refined.
_REFINED_SETTINGS, _REFINED_TABLE_TOLERANCE = 8, 3e-3


def explore_alternative(
    trade_off: TradeOffContext, alternative: RouteAlternative
) -> ExploredAlternative:
    """Search the fastest route and the exact front of one route alternative.

    Raises
    ------
    NoRouteError : If no route arrives in time; with the earliest arrival if there is a route.
    """
    context = trade_off.context
    alternative, horizon, fastest = fastest_in_known_water(trade_off, alternative)
    frozen, first, latest = horizon.frozen, horizon.first, horizon.latest
    trade_off.interrupt_guard.begin()
    context.report_progress(f"searching the front: {alternative.name}")
    try:
        exact = network_pareto_front(
            trade_off, alternative.network, frozen, latest, refined=trade_off.is_refined
        )
    except SearchInterrupted:
        exact = None
    until = first.arrive + 0.5 * first.duration
    depart = context.voyage.earliest_departure
    arrival = isochrones(context, alternative.network, frozen, depart, until)
    return ExploredAlternative(
        alternative,
        frozen,
        fastest,
        first,
        exact,
        arrival,
    )


def fastest_in_known_water(
    trade_off: TradeOffContext, alternative: RouteAlternative
) -> tuple[RouteAlternative, SearchHorizon, Route]:
    """Return the fastest route of an alternative, refined, and the alternative it is found on.

    Where the referee meets water without data on it, the edges that cross this water are left out.

    Raises
    ------
    NoRouteError : If no route arrives in time; with the earliest arrival if there is a route.
    """
    context = trade_off.context
    try:
        horizon, fastest = _fastest_route(trade_off, alternative)
    except NoRouteError as error:
        other = _along_plan_of_least_time(trade_off, alternative, math.inf)
        if other is None and _is_late(error):
            other = _on_network_of_least_time(trade_off, alternative)
        if other is None:
            raise
        alternative = other
        horizon, fastest = _fastest_route(trade_off, alternative)
    else:
        sooner = fastest.arrive - _SOONER * fastest.time_h * HOUR
        waits = fastest.waiting_h > 0.0
        other = _along_plan_of_least_time(trade_off, alternative, sooner) if waits else None
        if other is not None:
            alternative = other
            horizon, fastest = _fastest_route(trade_off, alternative)
    new = gaps = data_gaps_on_route(fastest)
    while new and len(gaps) <= MAX_GAPS:
        alternative = without_unknown_water(context, alternative, new)
        try:
            horizon, fastest = _fastest_route(trade_off, alternative)
        except NoRouteError:
            check_times_known(fastest, trade_off.ends[0], trade_off.ends[-1])
            raise
        new = data_gaps_on_route(fastest)
        gaps += new
    return alternative, horizon, fastest


def without_unknown_water(
    context: PlanningContext, alternative: RouteAlternative, gaps: Sequence[Violation]
) -> RouteAlternative:
    """Return a route alternative without the edges that cross water without data.

    Parameters
    ----------
    gaps : Where and when the referee found data missing.
    """
    context.report_progress(f"planning round water without data: {alternative.name}")
    network = without_unknown_edges(context, alternative.network, gaps)
    return replace(alternative, network=network)


def _fastest_route(
    trade_off: TradeOffContext, alternative: RouteAlternative
) -> tuple[SearchHorizon, Route]:
    """Return the period of the front and the fastest route, refined and scored."""
    context = trade_off.context
    context.report_progress(f"freezing the sea: {alternative.name}")
    horizon = extend_horizon(trade_off, alternative.network)
    first = horizon.first
    context.report_progress(f"searching: {alternative.name}")
    if not first.found:
        raise no_route_error(
            alternative.network,
            first,
            (trade_off.ends[0], trade_off.ends[-1]),
            depart=context.voyage.earliest_departure - context.approach_times[0],
            last=context.data_end,
            water=searched_water(trade_off, horizon),
        )
    track = track_from_result(alternative.network, first, horizon.setting)
    route, latest = refine_track(context, track, trade_off.limits), context.latest_arrival
    if first.arrive <= latest:
        return horizon, _fastest_by_plan(trade_off, alternative, route)
    if not (route.feasible and route.arrive <= latest + 1.0):
        stretch = _least_time_stretch(trade_off)
        alone = None if stretch is None else stretch.route
        earliest = min([first.arrive, *(r.arrive for r in (route, alone) if r and r.feasible)])
        if alone is None or earliest > latest + 1.0:
            raise late_arrival_error(latest, earliest, approach=context.approach_times[1])
        route = alone
    # in time as refined: paths of the network are longer, and those of its front may be later
    return replace(horizon, latest=first.arrive + 1.0), route


def _fastest_by_plan(
    trade_off: TradeOffContext, alternative: RouteAlternative, route: Route
) -> Route:
    """Return the route of a plan of least time where it is faster than one with a long wait.

    Such a plan looks at later paths and finer networks, by which a ship that waits arrives earlier.
    """
    if not route.waiting_h > _LONG_WAIT:
        return route
    try:
        stretch = _least_time_stretch(trade_off)
    except NoRouteError:
        return route
    if stretch is None or not _is_of_canals(stretch, trade_off, alternative):
        return route
    other = stretch.route
    return other if other.feasible and other.arrive < route.arrive - _EARLIER else route


def _least_time_stretch(trade_off: TradeOffContext) -> StretchResult | None:
    """Return the plan by least time, which is refined further; None with via points.

    A latest arrival is refused only if that plan does not keep it either.
    """
    context = trade_off.context
    if len(trade_off.ends) > 2:
        return None
    by_time = replace(context.voyage, objective="time", weights={}, arrive_by=None)
    depart = context.voyage.earliest_departure
    free = replace(context, voyage=by_time)
    start, goal = trade_off.ends
    return plan_stretch(free, start, goal, (depart, depart))


def _is_late(error: NoRouteError) -> bool:
    """Return whether there is no route because the data end."""
    return "data_end" in error.details


def _on_network_of_least_time(
    trade_off: TradeOffContext, alternative: RouteAlternative
) -> RouteAlternative | None:
    """Return an alternative on the network of the plan by least time.

    Its paths may arrive before the data end where those of the network of a front do not. None
    where that plan does not arrive either, or uses other canals.
    """
    stretch = _feasible_least_time(trade_off, alternative)
    if stretch is None:
        return None
    return replace(alternative, network=stretch.network, lattices=None)


def _along_plan_of_least_time(
    trade_off: TradeOffContext, alternative: RouteAlternative, latest: float
) -> RouteAlternative | None:
    """Return an alternative along the plan by least time, on the network of that plan.

    A gully of one row of the data lies between the nodes of the network of a front.

    Parameters
    ----------
    latest : Arrival of that plan [s since 1970-01-01T00:00Z], which is on the points of the bed;
        infinite where the front has no route of its own, and any network will do.
    """
    context = trade_off.context
    if context.choice.network != "auto" or bed_layer(context.sea) is None:
        return None
    stretch = _feasible_least_time(trade_off, alternative)
    if stretch is None or stretch.route.arrive > latest:
        return None
    if stretch.network.meta.kind != "mesh" and math.isfinite(latest):
        return None
    track = stretch.route.track
    network = near_line(stretch.network, track.lat, track.lon, most_nodes=MAX_FRONT_NODES)
    return replace(alternative, network=network, lattices=None)


def _feasible_least_time(
    trade_off: TradeOffContext, alternative: RouteAlternative
) -> StretchResult | None:
    """Return the plan by least time; None where it is not feasible or uses other canals."""
    try:
        stretch = _least_time_stretch(trade_off)
    except NoRouteError:
        return None
    if stretch is None or not stretch.route.feasible:
        return None
    return stretch if _is_of_canals(stretch, trade_off, alternative) else None


def _is_of_canals(
    stretch: StretchResult, trade_off: TradeOffContext, alternative: RouteAlternative
) -> bool:
    """Return whether the network of a stretch has the canals of an alternative."""
    canals = " and ".join(canals_used(stretch.network, trade_off.context.chart))
    return (canals or OPEN_SEA) == alternative.name


def network_pareto_front(
    trade_off: TradeOffContext,
    network: Network,
    frozen: FrozenSea,
    latest: float,
    *,
    refined: bool = False,
) -> NetworkFront:
    """Search the exact front of a network.

    Parameters
    ----------
    refined : Whether its paths are refined: then eight settings and coarser tables of edges do.

    Raises
    ------
    SearchInterrupted : If Ctrl-C is pressed before there is a front.
    NoRouteError : If no path keeps the limits, also with waits where the voyage allows them.
    """

    def progress(share: float) -> None:
        if share < 1.0 and trade_off.interrupt_guard.stopped():
            raise SearchInterrupted

    ship, query = front_search(trade_off, network, frozen, latest)
    tolerance = TABLE_TOLERANCE
    if refined:
        query = replace(query, settings=spread_settings(trade_off.settings, _REFINED_SETTINGS))
        tolerance = _REFINED_TABLE_TOLERANCE
    bin_s = (latest - query.depart) / _TIME_BINS
    may_wait = trade_off.context.voyage.wait

    def search(wait: bool) -> NetworkFront:
        return pareto_front(
            ship,
            replace(query, wait=wait),
            bin_s=bin_s,
            table_tolerance=tolerance,
            lower=False,
            progress=progress,
        )

    try:
        try:
            return search(query.wait)
        except NoRouteError:
            if query.wait or not may_wait:
                raise
            return search(True)  # at a bar that is closed until the tide rises
    except NoRouteError as error:
        raise unreached_goal_error(error, trade_off.ends, query.depart, wait=may_wait) from error


def front_search(
    trade_off: TradeOffContext, network: Network, frozen: FrozenSea, latest: float
) -> tuple[MultiSettingShipOnNetwork, FrontQuery]:
    """Return the ship on a network and the query of a trade-off, for `thalweg.search`."""
    context = trade_off.context
    depart = context.voyage.earliest_departure
    prices = trade_off.objective.prices
    differs = prices.differs_in_control_areas
    ship = MultiSettingShipOnNetwork(
        network,
        frozen.stations,
        context.table,
        trade_off.consumption,
        limits=trade_off.limits,
        top_speed=frozen.top_speed,
    )
    query = FrontQuery(
        start=network.meta.start,
        goal=network.meta.goal,
        depart=depart,
        latest=latest,
        settings=trade_off.settings,
        prices=prices,
        eca_fraction=eca_fractions(network, context.chart) if differs else None,
        edge_cost=edge_costs(
            network,
            context.chart,
            prices,
            depart=depart,
            speed=float(context.ship.speeds[trade_off.settings[-1]]),
        ),
        penalty_factor=network.edges.penalty_factor,
        wait=context.voyage.wait and not (prices.counts_dose or prices.counts_water),
    )
    return ship, query


def strongest_current(stations: StationFields) -> float:
    """Return the strongest current [m/s] in frozen fields; 0 without currents."""
    east, north = (stations.channel_index[c] for c in (codes.CURRENT_EAST, codes.CURRENT_NORTH))
    if east < 0 or north < 0:
        return 0.0
    squared = stations.values[:, :, east] ** 2 + stations.values[:, :, north] ** 2
    return math.sqrt(float(np.nanmax(squared, initial=0.0)))
