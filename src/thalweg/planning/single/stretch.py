"""One stretch between two places: network, frozen sea, exact search, refinement, referee."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.limits import TIGHTENING, Limits
from thalweg.core.time import TimeLike, format_time
from thalweg.core.units import HOUR
from thalweg.kernels import codes
from thalweg.kernels.compilation import warm_up
from thalweg.network import Network
from thalweg.planning.frozen_sea import FrozenSea, LastFrozenSea
from thalweg.planning.network_selection.bed_network import network_on_bed
from thalweg.planning.network_selection.stretch_networks import (
    lattice_may_replace,
    mesh_is_thinned,
    network_of_attempt,
)
from thalweg.planning.planning_context import PlanningContext, expected_speed
from thalweg.planning.report.waiting_report import window_notes
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.currents_too_strong import leaving_after_current
from thalweg.planning.single.exceeded_limits import (
    MAX_ROUNDS,
    exceeded_limits_on_routes,
    stricter_limits_help,
    without_exceeding_paths,
)
from thalweg.planning.single.fewer_waits import passing_time_notes, with_best_waits
from thalweg.planning.single.isochrones import isochrones, ship_for_search
from thalweg.planning.single.lane_keeping import by_lanes_of_traffic
from thalweg.planning.single.late_paths import late_paths_of
from thalweg.planning.single.no_route_diagnosis import late_arrival_error, no_route_error
from thalweg.planning.single.route_candidates import (
    departing_later,
    refine_track,
    refined_bound_path,
    route_value,
    through_narrow_features,
    track_from_result,
)
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.planning.single.way_of_seas import along_way_of_seas
from thalweg.planning.single.weather_gaps import (
    MAX_GAPS,
    check_times_known,
    data_gaps_on_route,
    without_unknown_edges,
)
from thalweg.planning.single.weather_stall import SearchedWater
from thalweg.route import Route
from thalweg.route.refinement.better_route import comparison_key, penalty_excess
from thalweg.route.route import Violation
from thalweg.search import (
    DepartureWindow,
    LowerBound,
    SearchResult,
    best_departure,
    earliest_arrival,
    lower_bound,
)
from thalweg.search.lower_bounds import Penalties

#: Periods for which the sea is frozen, in multiples of the time along the geodesic.
_REFINED_SHARE = 0.05  # of the time of a path, more than refinement saves
_HORIZONS = (2.5, 8.0, 30.0)
#: Reasons of refused edges that a wait may remove; isochrones without waits take a hundredth of the
#: time, and against currents they show as much.
_OPENED_BY_WAITS: Final = frozenset(
    codes.REASONS[code]
    for code in (
        codes.NO_DATA,
        codes.DEPTH,
        codes.WAVE_HEIGHT,
        codes.WIND_SPEED,
        codes.SHIP_RANGE,
        codes.SAFETY,
    )
)
#: Isochrones are drawn until this multiple of the stretch's time.
_ISOCHRONE_TIME_RATIO = 1.5
_TWO_TIDES = 25 * HOUR
_NO_DETOUR = 1.02  # times the geodesic
_CLEARLY = 2e-3  # share of the value by which a route of another network must be better
#: Attempts while the referee finds a limit exceeded between the stations: how many times finer the
#: network is, and the step of `TIGHTENING`.
_ATTEMPTS = ((1, 0), (1, 2), (2, 0), (2, 3), (4, 0), (4, 4))


def plan_stretch(
    context: PlanningContext, start: Endpoint, goal: Endpoint, window: tuple[float, float]
) -> StretchResult:
    """Find the best route between two places, departing in a window of times.

    Raises
    ------
    NoRouteError : If no route exists within the limits, the data and the latest arrival.
    """
    networks: dict[int, Network] = {}
    stretch: StretchResult | None = None
    refusal: NoRouteError | None = None
    gaps: tuple[Violation, ...] = ()
    rounds = 0
    attempts = deque(_ATTEMPTS)
    bed_is_tried = False
    seas = LastFrozenSea()
    while attempts:
        finer, step = attempts.popleft()
        if finer not in networks:
            try:
                network = network_of_attempt(context, (start, goal), finer, networks)
            except InputError:  # a finer network than asked for does not fit in memory
                if finer == 1:
                    raise
                continue
            networks[finer] = without_unknown_edges(context, network, gaps)
        limits = context.needs.limits.tightened(TIGHTENING[step])
        stricter = context.with_stricter_motions(TIGHTENING[step].share)
        try:
            tried = _search_and_refine(
                stricter, networks[finer], (start, goal), window, limits, seas
            )
        except NoRouteError as error:
            refusal = refusal or error
            denser = lattice_may_replace(context, networks[finer]) or mesh_is_thinned(
                context, networks[finer]
            )
            if stretch is None and (finer, step) == (1, 0):
                stretch = _on_points_of_bed(context, (start, goal), window)
                if stretch is not None:
                    break
            if stretch is None and not denser:
                raise refusal from None
            if gaps:  # no way through known water: one finer network may find one
                attempts = deque([(2, 0)] if finer == 1 else [])
            continue
        if stretch is None or tried.route.feasible:
            stretch = tried
        if not stretch.route.feasible and (finer, step) == (1, 0):
            search = partial(
                _search_and_refine, stricter, networks[1], (start, goal), limits=limits, seas=seas
            )
            stretch = leaving_after_current(stricter, stretch, window, search)
        if not (bed_is_tried or _goes_straight((start, goal), stretch.route)):
            on_bed = _on_points_of_bed(context, (start, goal), window)
            if on_bed is not None and _is_clearly_better(context, on_bed.route, stretch.route):
                stretch = on_bed
        bed_is_tried = True
        if stretch.route.feasible:
            break
        seen, gaps = gaps, (*gaps, *data_gaps_on_route(tried.route))
        if len(seen) < len(gaps) <= MAX_GAPS:
            context.report_progress("planning round water without data")
            networks[finer] = without_unknown_edges(context, networks[finer], gaps[len(seen) :])
            attempts.appendleft((finer, step))
        elif (step or not stricter_limits_help(tried.route)) and rounds < MAX_ROUNDS:
            path = partial(_path_on_network, context, limits, window, (start, goal), seas)
            places = exceeded_limits_on_routes(tried.route, path(networks[finer], tried.result))
            left = without_exceeding_paths(context, networks[finer], places, path)
            if left is not networks[finer]:
                rounds, networks[finer] = rounds + 1, left
                attempts.appendleft((finer, step))
                if step:
                    attempts.appendleft((finer, 0))  # the limits themselves first
    assert stretch is not None  # raised above otherwise
    if not stretch.route.feasible:
        check_times_known(stretch.route, start, goal)
    arrive, latest = stretch.route.arrive, context.latest_arrival
    if latest + 1.0 < arrive < math.inf:
        raise late_arrival_error(
            latest, arrive, window=window[1] > window[0], approach=context.approach_times[1]
        )
    return stretch


def _on_points_of_bed(
    context: PlanningContext, ends: tuple[Endpoint, Endpoint], window: tuple[float, float]
) -> StretchResult | None:
    """Return the stretch on the points of a gridded bed; None without such a bed or a route.

    A gully of one row of the data lies between the nodes of other networks.
    """
    limits = context.needs.limits
    if context.choice.network != "auto" or limits.required_depth == -math.inf:
        return None
    network = network_on_bed(context.chart, context.sea, ends, limits.required_depth)
    if network is None:
        return None
    context.report_progress("searching along the points of the bed")
    try:
        found = _search_and_refine(context, network, ends, window, limits, LastFrozenSea())
    except NoRouteError:
        return None
    return found if found.route.feasible else None


def _is_clearly_better(context: PlanningContext, route: Route, known: Route) -> bool:
    """Return whether a route breaks fewer limits than a known one, or saves more than it counts."""
    chart, objective = context.chart, context.voyage.objective
    broken, value, _ = comparison_key(route, objective, chart)
    known_broken, known_value, _ = comparison_key(known, objective, chart)
    return (broken, value) < (known_broken, (1.0 - _CLEARLY) * known_value)


def _goes_straight(ends: tuple[Endpoint, Endpoint], route: Route) -> bool:
    """Return whether a feasible route neither waits nor goes round anything."""
    if not route.feasible or np.any(route.track.wait):
        return False
    straight = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon))
    return float(route.legs["length"].sum()) <= _NO_DETOUR * straight


def _search_and_refine(
    context: PlanningContext,
    network: Network,
    ends: tuple[Endpoint, Endpoint],
    window: tuple[float, float],
    limits: Limits,
    seas: LastFrozenSea,
) -> StretchResult:
    """Search, refine and bound the stretch on one network with one set of limits."""
    frozen, result = _search(context, network, limits, window, ends, seas)
    track = track_from_result(network, result, context.setting)
    route = refine_track(context, track, limits)
    if window[1] > window[0]:
        route = departing_later(context, (track, route.track), route, limits, window[1])
    if context.voyage.depart_window is None:
        context.report_progress("searching as in open water")
        hint = _bound(context, network, frozen, result, route)
        route = refined_bound_path(context, network, hint, result, route, limits)
        if network.meta.kind != "layered":  # those routes keep to their layers
            route = through_narrow_features(context, route, limits)
            found = partial(_route_on_network, context, limits, window, ends)
            route = along_way_of_seas(context, ends, route, found, limits)
    route = by_lanes_of_traffic(context, network, route)
    paths = late_paths_of(context, network, limits, (result, route), seas)
    fixed = window[1] == window[0]
    passing = passing_time_notes(context, route, paths, ends[0].name) if fixed else []
    passing += window_notes(result.departures, context.approach_times)
    route, later = with_best_waits(context, route, paths, last_departure=window[1])
    notes = network.meta.notes if network.meta.kind == "layered" else ()
    exceeded = (f"The referee finds a limit exceeded: {v}." for v in route.violations[:5])
    notes = (*notes, *exceeded, *passing, *later)
    until = route.depart + _ISOCHRONE_TIME_RATIO * route.time_h * HOUR if route.feasible else None
    waits = bool(np.any(route.track.wait)) or not _OPENED_BY_WAITS.isdisjoint(result.refused)
    arrival = isochrones(context, network, frozen, route.depart, until, wait=waits)
    return StretchResult(route, result, network, arrival, notes)


def _route_on_network(
    context: PlanningContext, limits: Limits, window: tuple[float, float],
    ends: tuple[Endpoint, Endpoint], network: Network,
) -> Route:  # fmt: skip
    """Return the refined route of a network."""
    _, result = _search(context, network, limits, window, ends, LastFrozenSea())
    return refine_track(context, track_from_result(network, result, context.setting), limits)


def _path_on_network(
    context: PlanningContext, limits: Limits, window: tuple[float, float],
    ends: tuple[Endpoint, Endpoint], seas: LastFrozenSea, network: Network,
    result: SearchResult | None = None,
) -> Route:  # fmt: skip
    """Return the path of a network as evaluated, without refinement."""
    if result is None:
        _, result = _search(context, network, limits, window, ends, seas)
    return context.evaluate(track_from_result(network, result, context.setting))


def _search(
    context: PlanningContext,
    network: Network,
    limits: Limits,
    window: tuple[float, float],
    ends: tuple[Endpoint, Endpoint],
    seas: LastFrozenSea,
) -> tuple[FrozenSea, SearchResult]:
    straight = float(distance(ends[0].lat, ends[0].lon, ends[1].lat, ends[1].lon))
    usual = straight / expected_speed(context, ends, window[0])
    arrive_by = _deadline_of_search(context, window)
    latest = min(context.data_end, math.inf if arrive_by is None else float(arrive_by))  # type: ignore[arg-type]
    for number in range(seas.first_horizon(network), len(_HORIZONS)):
        end = window[1] + _HORIZONS[number] * usual + (_TWO_TIDES if number else 0.0)
        end = min(end, latest)
        context.report_progress(f"freezing the sea until {format_time(end)}")
        frozen = seas.freeze(context, network, window[0], end)
        warm_up.wait_until_compiled()
        context.report_progress("searching")
        result = _run_search(context, network, frozen, limits, window)
        if result.found or end >= latest:
            break
    if result.found:
        seas.horizon = number
        saved = _REFINED_SHARE * result.duration + (_TWO_TIDES if result.waiting else 0.0)
        if result.arrive > context.latest_arrival + saved:
            raise late_arrival_error(
                context.latest_arrival, result.arrive, about=True,
                approach=context.approach_times[1],
            )  # fmt: skip
    else:
        if arrive_by is not None:
            raise _late_arrival_error(context, network, limits, window, ends, seas)
        raise no_route_error(
            network, result, ends,
            depart=context.voyage.earliest_departure - context.approach_times[0],
            last=context.data_end if end >= context.data_end else math.inf,
            latest=context.voyage.latest_departure - context.approach_times[0],
            water=SearchedWater(
                frozen.stations, limits.required_depth, context.table, context.setting
            ),
        )  # fmt: skip
    return frozen, result


def _deadline_of_search(context: PlanningContext, window: tuple[float, float]) -> TimeLike | None:
    """Return the latest arrival of paths; None where the fastest is searched and then refined."""
    fastest = context.voyage.objective == "time" and window[0] == window[1]
    return None if fastest else context.voyage.arrive_by


def _late_arrival_error(
    context: PlanningContext, network: Network, limits: Limits, window: tuple[float, float],
    ends: tuple[Endpoint, Endpoint], seas: LastFrozenSea,
) -> NoRouteError:  # fmt: skip
    """Return the error for a missed latest arrival; raises where there is no route at all."""
    unrestricted = replace(
        context, voyage=replace(context.voyage, arrive_by=None, objective="time", weights={})
    )
    _, result = _search(unrestricted, network, limits, window, ends, seas)
    return late_arrival_error(
        context.latest_arrival, result.arrive, window=window[1] > window[0],
        approach=context.approach_times[1],
    )  # fmt: skip


def _run_search(
    context: PlanningContext,
    network: Network,
    frozen: FrozenSea,
    limits: Limits,
    window: tuple[float, float],
) -> SearchResult:
    ship = ship_for_search(context, network, frozen, limits)
    options = {
        "start": network.meta.start,
        "goal": network.meta.goal,
        "objective": context.voyage.objective,
        "wait": context.voyage.wait,
        "arrive_by": _deadline_of_search(context, window),
    }
    if window[1] > window[0]:
        return best_departure(ship, window=DepartureWindow(*window), **options)  # type: ignore[arg-type]
    return earliest_arrival(ship, depart=window[0], **options)  # type: ignore[arg-type]


def _bound(
    context: PlanningContext,
    network: Network,
    frozen: FrozenSea,
    result: SearchResult,
    route: Route,
) -> LowerBound:
    """Return the bound of the network, for its path: it is evidence and not proof."""
    known, penalties = None, None
    if route.feasible:
        known = route_value(context, route)
        zones = context.chart.zones
        if zones.has_penalty:
            added = penalty_excess(route, context.voyage.objective, context.chart)
            factors = tuple(factor for _, factor in zones.penalty)
            penalties = Penalties(
                added, factors, graded=bool(zones.lanes) or zones.shoals is not None
            )
    return lower_bound(
        ship_for_search(context, network, frozen, context.needs.limits),
        start=network.meta.start,
        goal=network.meta.goal,
        depart=float(result.path_arrive[0]),
        objective="distance" if context.voyage.objective == "distance" else "time",
        known=known,
        penalties=penalties,
    )
