"""Plans that trade time for fuel, energy, cost or CO2: from fronts of alternatives to a plan."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from time import monotonic
from typing import TypeVar

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.interrupt import InterruptGuard
from thalweg.core.limits import NETWORK_STEPS, TIGHTENING
from thalweg.core.pareto_fronts import (
    ROUNDING_TOLERANCE,
    evenly_spaced_subset,
    non_dominated_indices,
)
from thalweg.core.units import HOUR
from thalweg.planning.network_selection.route_alternatives import (
    MAX_LENGTH_RATIO,
    RouteAlternative,
    find_route_alternatives,
)
from thalweg.planning.pareto.evolutionary_refinement import (
    evaluator_around_candidates,
    evaluator_around_routes,
)
from thalweg.planning.pareto.exploration import explore_alternative, without_unknown_water
from thalweg.planning.pareto.front_points import track_from_front_point
from thalweg.planning.pareto.plan_assembly import assemble_trade_off_plan
from thalweg.planning.pareto.single_speed import has_single_speed, refined_cheapest
from thalweg.planning.pareto.speed_blocks import in_speed_blocks
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    RefereedCandidate,
    TrackCandidate,
    TradeOffContext,
    non_dominated_candidates,
    scored_candidate,
)
from thalweg.planning.pareto.turn_reduction import may_leave_nodes, scored_with_fewer_turns
from thalweg.planning.pareto.waiting.one_wait_candidates import one_wait_candidates
from thalweg.planning.pareto.waiting.two_speeds_after_wait import two_speeds_after_wait
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.pareto.waiting.waits_of_fronts import (
    with_fewer_waits_of_front,
    with_waits_long_enough,
)
from thalweg.planning.pareto.weighted_sums import normalised_trade_off
from thalweg.planning.plan import Plan
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.waiting_report import waiting_weather_texts
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import priced_objective
from thalweg.planning.single.lane_keeping import in_lanes_of_traffic
from thalweg.planning.single.weather_gaps import MAX_GAPS, data_gaps_on_route
from thalweg.route.route import Violation
from thalweg.ship.consumption import consumption_table

Result = TypeVar("Result")

_MAX_STEPS = 150_000  # of the evaluation of the routes of a front
_NETWORK_ONLY = (
    "Length, land and encounters were counted on the network only, encounters at the highest "
    "speed; the routes were not refined in open water."
)
_WORTH_A_NOTE = 0.01  # share of the value
_MAX_ROUTES_INTERRUPTED = 20  # after Ctrl-C
_SECONDS_INTERRUPTED = 3.0  # for the referee after Ctrl-C, once one route is scored


def plan_trade_off(context: PlanningContext, ends: list[Endpoint]) -> Plan:
    """Plan a voyage whose objective trades time for fuel, energy, cost or CO2.

    Raises
    ------
    InputError : If the ship's fuel, its price or its power is not known.
    NoRouteError : If no route exists within the limits and in time.
    """
    with InterruptGuard() as interrupt_guard:
        trade_off = _trade_off_context(context, ends, interrupt_guard)
        alternatives = _alternatives(trade_off)
        if alternatives[0].network.meta.kind == "layered":
            trade_off.notes.extend(alternatives[0].network.meta.notes)
        if context.voyage.weights:
            trade_off = normalised_trade_off(trade_off, alternatives[0].network)
        if trade_off.objective.prices.counts_water:
            trade_off.notes.append(_NETWORK_ONLY)
        steps, seen = deque(NETWORK_STEPS), 0
        while steps:  # while the referee finds no route within the limits and known water
            step = steps.popleft()
            limits = context.needs.limits.tightened(TIGHTENING[step])
            explored = _explore_all(replace(trade_off, limits=limits), alternatives)
            scored, gaps = _refereed(
                trade_off, _candidates(replace(trade_off, limits=limits), explored)
            )
            if interrupt_guard.stopped() or any(item.route.feasible for item in scored):
                break
            seen += len(gaps)
            if gaps and seen <= MAX_GAPS:
                alternatives = [
                    without_unknown_water(context, one.alternative, gaps) for one in explored
                ]
                steps.appendleft(step)
        if any(item.route.feasible for item in scored):
            stopped = interrupt_guard.stopped()
            scored = non_dominated_candidates(scored) if stopped else _ordered(trade_off, scored)
        return assemble_trade_off_plan(trade_off, ends, explored, scored)


def with_trade_off(
    context: PlanningContext,
    ends: list[Endpoint],
    search: Callable[[TradeOffContext, list[RouteAlternative]], Result],
) -> Result:
    """Return what a search finds on the networks of the route alternatives, the shortest first.

    These avoid each canal of the shortest one, however long they are.
    """
    with InterruptGuard() as interrupt_guard:
        trade_off = _trade_off_context(context, ends, interrupt_guard)
        return search(trade_off, _alternatives(trade_off, longest_ratio=math.inf))


def _alternatives(
    trade_off: TradeOffContext, longest_ratio: float = MAX_LENGTH_RATIO
) -> list[RouteAlternative]:
    worth = trade_off.worth_of_canals()
    return find_route_alternatives(trade_off.context, trade_off.ends, worth, longest_ratio)


def _trade_off_context(
    context: PlanningContext, ends: list[Endpoint], interrupt_guard: InterruptGuard
) -> TradeOffContext:
    objective = priced_objective(context.voyage, context.ship)
    prices = objective.prices
    consumption = consumption_table(context.ship, prices.consumption, prices.mix)
    single = context.voyage.speed_kn is not None
    settings = np.array([context.setting]) if single else np.arange(len(context.ship.speeds))
    limits = context.needs.limits
    return TradeOffContext(
        context, objective, consumption, tuple(ends), settings, limits, interrupt_guard
    )


def _explore_all(
    trade_off: TradeOffContext, alternatives: list[RouteAlternative]
) -> list[ExploredAlternative]:
    """Explore all route alternatives; those without a route are left out if another has one."""
    found: list[ExploredAlternative] = []
    refusal: NoRouteError | None = None
    for alternative in alternatives:
        if found and trade_off.interrupt_guard.stopped():
            trade_off.notes.append(
                f"Stopped before the alternative {alternative.name!r} was explored."
            )
            break
        try:
            found.append(explore_alternative(trade_off, alternative))
            _show(trade_off, [each for one in found for each in _exact_candidates(one)])
        except NoRouteError as error:
            refusal = refusal or error
    if not found:
        assert refusal is not None  # there is at least one alternative
        raise refusal
    return found


def _candidates(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> list[TrackCandidate]:
    """Return the candidates for the referee: the fastest of each alternative, and a front."""
    fastest = [
        TrackCandidate(
            one.fastest.track, "fastest", one.alternative.name, one.fastest.time_h * HOUR, math.nan
        )
        for one in explored
    ]
    candidates = [candidate for one in explored for candidate in _exact_candidates(one)]
    if not candidates:  # interrupted before there was a front
        return fastest
    fastest += one_wait_candidates(trade_off, explored)
    candidates += _refined_candidates(trade_off, explored, candidates)
    non_dominated = non_dominated_indices(
        *_times_and_values(candidates), tolerance=ROUNDING_TOLERANCE
    )
    time, value = _times_and_values([candidates[index] for index in non_dominated])
    steps = max(len(one.fastest.samples["time"]) for one in explored)
    detail = trade_off.detail
    most = min(max(_MAX_STEPS // max(steps, 1), detail.least), detail.most)
    if trade_off.interrupt_guard.stopped():
        most = min(most, _MAX_ROUTES_INTERRUPTED)
    return [
        *fastest,
        *(candidates[non_dominated[index]] for index in evenly_spaced_subset(time, value, most)),
    ]


def _exact_candidates(one: ExploredAlternative) -> list[TrackCandidate]:
    """Return the exact front of one route alternative."""
    network, name = one.alternative.network, one.alternative.name
    return [
        TrackCandidate(
            track_from_front_point(network, point), "exact", name, point.time, point.cost
        )
        for point in (one.exact.points if one.exact else ())
    ]


def _refined_candidates(
    trade_off: TradeOffContext, explored: list[ExploredAlternative], exact: list[TrackCandidate]
) -> list[TrackCandidate]:
    """Return candidates from fixed-route fronts and from refinement, as the method requires."""
    method, stopped = trade_off.context.voyage.method, trade_off.interrupt_guard.stopped
    if stopped() or not trade_off.is_refined:
        return []
    from thalweg.planning.pareto.evolutionary_refinement import evolutionary_candidates
    from thalweg.planning.pareto.fixed_route_fronts import fixed_route_candidates

    found = fixed_route_candidates(trade_off, explored) if method == "default" else []
    for one in explored:
        if stopped():
            break
        trade_off.context.report_progress(f"refining the front: {one.alternative.name}")
        of_alternative = [c for c in (*exact, *found) if c.alternative == one.alternative.name]
        if method == "default" and has_single_speed(trade_off):
            found += refined_cheapest(trade_off, one, of_alternative)
            continue
        found += evolutionary_candidates(trade_off, one, of_alternative)
        _show(trade_off, [*exact, *found])
    return found


def _show(trade_off: TradeOffContext, candidates: list[TrackCandidate]) -> None:
    """Pass the front of candidates to ``show_front`` of the caller's progress."""
    if candidates:
        kept = non_dominated_indices(*_times_and_values(candidates), tolerance=ROUNDING_TOLERANCE)
        points = [(candidates[index].time, candidates[index].value) for index in kept]
        trade_off.context.show_front(points, trade_off.objective.unit)


def _times_and_values(candidates: list[TrackCandidate]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([item.time for item in candidates]), np.array(
        [item.value for item in candidates]
    )


def _refereed(
    trade_off: TradeOffContext, candidates: list[TrackCandidate]
) -> tuple[list[RefereedCandidate], tuple[Violation, ...]]:
    """Evaluate candidates; without those that exceed limits.

    Where none is left, the gaps in the data that they meet are returned as well.
    """
    context = trade_off.context
    context.report_progress(f"evaluating {len(candidates)} routes")
    by_index: dict[int, RefereedCandidate] = {}
    until, screen = math.inf, None
    for k in _from_coarse_to_fine(len(candidates)):
        if trade_off.interrupt_guard.stopped():
            until = min(until, monotonic() + _SECONDS_INTERRUPTED)
            if monotonic() > until and any(item.route.feasible for item in by_index.values()):
                break
        candidate = candidates[k]
        track = candidate.track
        if may_leave_nodes(trade_off):
            track = in_lanes_of_traffic(track, context.chart)
        route = scored_with_fewer_turns(trade_off, track, candidate.time)
        if not route.feasible and context.voyage.wait:
            screen = screen or WaitScreen(evaluator_around_candidates(trade_off, candidates))
            route = with_waits_long_enough(
                context,
                route,
                lambda track: context.evaluate(track, trade_off.objective.terms),
                screen,
            )
        by_index[k] = scored_candidate(
            trade_off, candidate, route, trade_off.objective.value(route)
        )
    scored = [by_index[k] for k in sorted(by_index)]
    latest = context.latest_arrival
    usable = [
        item
        for item in scored
        if item.route.feasible and math.isfinite(item.value) and item.route.arrive <= latest + 1.0
    ]
    if usable:
        return usable, ()
    gaps = [gap for item in scored for gap in data_gaps_on_route(item.route)]
    different = {(gap.reason, gap.lat, gap.lon, gap.time): gap for gap in gaps}
    sailed = [item for item in scored if math.isfinite(item.route.arrive)]
    return sailed, tuple(different.values())[:MAX_GAPS]


def _ordered(
    trade_off: TradeOffContext, scored: list[RefereedCandidate]
) -> list[RefereedCandidate]:
    """Return a front of routes that a bridge can order: with blocks of speed and few waits.

    Routes at one speed need no blocks.
    """
    steady = [one for one in scored if one.candidate.stage == "one wait"]
    steady += two_speeds_after_wait(trade_off, steady)
    others = [one for one in scored if one.candidate.stage != "one wait"]
    blocked = in_speed_blocks(trade_off, non_dominated_candidates(others), steady) if others else []
    kept = non_dominated_candidates([*blocked, *steady])
    if any(np.any(one.route.track.wait[1:]) for one in kept):
        screen = WaitScreen(evaluator_around_routes(trade_off, [one.route for one in kept]))
        kept = non_dominated_candidates([_with_fewer_waits(trade_off, one, screen) for one in kept])
    _note_waits_left_out(trade_off, scored, kept)
    return kept


def _note_waits_left_out(
    trade_off: TradeOffContext, scored: list[RefereedCandidate], kept: list[RefereedCandidate]
) -> None:
    """Note what waits at sea above the limits would save, where no such route is left."""
    ship, objective = trade_off.context.ship, trade_off.objective
    values = [one.value for one in scored if waiting_weather_texts(one.route, ship)]
    if not values or any(waiting_weather_texts(one.route, ship) for one in kept):
        return
    least = min(one.value for one in kept)
    if min(values) < (1.0 - _WORTH_A_NOTE) * least:
        trade_off.notes.append(
            "Routes on which the ship would wait at sea in waves or wind above her limits are left "
            f"out; the best of them has {min(values):.3g} {objective.unit}, in place of "
            f"{least:.3g} {objective.unit}."
        )


def _with_fewer_waits(
    trade_off: TradeOffContext, item: RefereedCandidate, screen: WaitScreen
) -> RefereedCandidate:
    context, objective = trade_off.context, trade_off.objective
    route = with_fewer_waits_of_front(
        item.route,
        lambda track: context.evaluate(track, objective.terms),
        objective.value,
        context,
        screen,
    )
    return scored_candidate(trade_off, item.candidate, route, objective.value(route))


def _from_coarse_to_fine(count: int) -> list[int]:
    """Return all indices below a count: every 16th first, then every 8th, and so on."""
    return list(dict.fromkeys(k for step in (16, 8, 4, 2, 1) for k in range(0, count, step)))
