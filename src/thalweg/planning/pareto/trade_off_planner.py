"""Plans that trade time for fuel, energy, cost or CO2: from fronts of alternatives to a plan."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thalweg.core.errors import NoRouteError
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT
from thalweg.kernels import codes
from thalweg.network import shortest_path
from thalweg.planning.interrupt_guard import InterruptGuard
from thalweg.planning.network_selection.route_alternatives import (
    RouteAlternative,
    find_route_alternatives,
)
from thalweg.planning.pareto.baseline import (
    compare_with_baseline,
    evaluate_weather_blind,
    weather_blind_tracks,
)
from thalweg.planning.pareto.bounds import (
    absolute_lower_bound,
    correction_factors,
    correction_notes,
    derive_proof,
    open_water_lower_front,
)
from thalweg.planning.pareto.exploration import explore_alternative
from thalweg.planning.pareto.front_points import (
    evenly_spaced_subset,
    non_dominated_indices,
    track_from_front_point,
)
from thalweg.planning.pareto.plan_front import ParetoFront
from thalweg.planning.pareto.route_names import route_labels
from thalweg.planning.pareto.search_horizon import shortest_path_length
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    TrackCandidate,
    TradeOffContext,
)
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import PlotContext
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.provenance import (
    finite_or_none,
    network_summary,
    provenance,
    route_warnings,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import priced_objective
from thalweg.route import Route
from thalweg.ship.consumption import consumption_table

#: Margins on the depth [m] and on wave height and wind [fraction], tried in turn while the referee
#: finds no route within the limits.
_TIGHTENING_SCHEDULE = ((0.0, 0.0), (0.1, 0.02), (0.3, 0.05), (1.0, 0.1))
#: Routes that end within this time of the end of the data are taken as limited by it [s].
_DATA_END_MARGIN = 3.0 * HOUR
#: Least and greatest number of routes of a front, and of the steps of their evaluation.
_MIN_ROUTES, _MAX_ROUTES, _MAX_STEPS = 40, 100, 150_000
_MAX_ROUTES_INTERRUPTED = 20  # after Ctrl-C


@dataclass(frozen=True)
class RefereedCandidate:
    """A candidate with its route and value as scored by the referee."""

    candidate: TrackCandidate
    route: Route
    value: float


def plan_trade_off(context: PlanningContext, ends: list[Endpoint]) -> Plan:
    """Plan a voyage whose objective trades time for fuel, energy, cost or CO2.

    Raises
    ------
    InputError
        If the ship's fuel, its price or its power is not known.
    NoRouteError
        If no route exists within the limits and in time.
    """
    objective = priced_objective(context.voyage, context.ship)
    consumption = consumption_table(context.ship, objective.prices.consumption)
    single = context.voyage.speed_kn is not None
    settings = np.array([context.setting]) if single else np.arange(len(context.ship.speeds))
    with InterruptGuard() as interrupt_guard:
        trade_off = TradeOffContext(
            context,
            objective,
            consumption,
            tuple(ends),
            settings,
            context.needs.limits,
            interrupt_guard,
        )
        alternatives = find_route_alternatives(context, ends)
        for depth, fraction in _TIGHTENING_SCHEDULE:
            limits = context.needs.limits * (1.0 - fraction)
            limits[codes.LIMIT_REQUIRED_DEPTH] = (
                context.needs.limits[codes.LIMIT_REQUIRED_DEPTH] + depth
            )
            explored = _explore_all(replace(trade_off, limits=limits), alternatives)
            scored = _refereed(trade_off, _candidates(replace(trade_off, limits=limits), explored))
            if interrupt_guard.stopped() or any(item.route.feasible for item in scored):
                break
        return _assemble_plan(trade_off, ends, explored, scored)


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
            one.fastest.track, "fastest", one.way.name, one.fastest.time_h * HOUR, math.nan
        )
        for one in explored
    ]
    found = [candidate for one in explored for candidate in _exact_candidates(one)]
    if not found:  # interrupted before there was a front
        return fastest
    found += _refined_candidates(trade_off, explored, found)
    kept = non_dominated_indices(*_times_and_values(found))
    time, value = _times_and_values([found[index] for index in kept])
    steps = max(len(one.fastest.samples["time"]) for one in explored)
    most = min(max(_MAX_STEPS // max(steps, 1), _MIN_ROUTES), _MAX_ROUTES)
    if trade_off.interrupt_guard.stopped():
        most = min(most, _MAX_ROUTES_INTERRUPTED)
    return [*fastest, *(found[kept[index]] for index in evenly_spaced_subset(time, value, most))]


def _exact_candidates(one: ExploredAlternative) -> list[TrackCandidate]:
    """Return the exact front of one route alternative."""
    network, name = one.way.network, one.way.name
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
    if method == "exact" or stopped():
        return []
    from thalweg.planning.pareto.evolutionary_refinement import evolutionary_candidates
    from thalweg.planning.pareto.fixed_route_fronts import fixed_route_candidates

    found = fixed_route_candidates(trade_off) if method == "default" else []
    for one in explored:
        if stopped():
            break
        trade_off.context.report_progress(f"refining the front: {one.way.name}")
        of_way = [c for c in (*exact, *found) if c.way == one.way.name]
        found += evolutionary_candidates(trade_off, one, of_way)
    return found


def _times_and_values(found: list[TrackCandidate]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([item.time for item in found]), np.array([item.value for item in found])


def _refereed(
    trade_off: TradeOffContext, candidates: list[TrackCandidate]
) -> list[RefereedCandidate]:
    """Evaluate candidates; without those that exceed limits or are dominated."""
    context = trade_off.context
    context.report_progress(f"evaluating {len(candidates)} routes")
    scored = []
    for candidate in candidates:
        route = context.evaluate(candidate.track, trade_off.objective.terms)
        scored.append(RefereedCandidate(candidate, route, trade_off.objective.value(route)))
    latest = context.latest_arrival
    usable = [
        item
        for item in scored
        if item.route.feasible and math.isfinite(item.value) and item.route.arrive <= latest + 1.0
    ]
    if not usable:
        return [item for item in scored if math.isfinite(item.route.arrive)]
    time = np.array([item.route.time_h for item in usable])
    value = np.array([item.value for item in usable])
    return [usable[index] for index in non_dominated_indices(time, value)]


def _assemble_plan(
    trade_off: TradeOffContext,
    ends: list[Endpoint],
    explored: list[ExploredAlternative],
    scored: list[RefereedCandidate],
) -> Plan:
    """Assemble the plan."""
    context, objective = trade_off.context, trade_off.objective
    whole = context.voyage.objective == "front"
    blind = _weather_blind_routes(trade_off, explored)
    scored = _including_constant_speeds(trade_off, scored, blind)
    if not scored:
        raise _no_feasible_route_error(trade_off, explored)
    ordered = sorted(scored, key=lambda item: item.route.time_h)
    if not whole:
        best = min(ordered, key=lambda item: item.value)
        ordered = [best, *(item for item in ordered if item is not best)]
    routes = tuple(item.route for item in ordered)
    values = np.array([item.value for item in ordered])
    lower = open_water_lower_front(explored, absolute_lower_bound(trade_off, explored)[1])
    share = correction_factors(lower, np.array([route.time_h for route in routes]), values)
    lower *= share[:, None]
    shortest = min(explored, key=lambda one: shortest_path_length(one.way.network)).way.name
    front = ParetoFront(
        criterion=objective.name,
        unit=objective.unit,
        values=values,
        stages=tuple(item.candidate.stage for item in ordered),
        ways=route_labels(
            routes,
            [item.candidate.way or shortest for item in ordered],
            {one.way.name: one.way.network for one in explored},
            context.chart,
        ),
        lower=lower,
        comparison=compare_with_baseline(context, objective, routes, values, blind),
    )
    stopped = trade_off.interrupt_guard.stopped()
    return Plan(
        voyage=context.voyage,
        routes=routes,
        proof=derive_proof(trade_off, explored, front, whole=whole),
        rejections=_rejections(explored),
        notes=tuple(
            dict.fromkeys(
                [
                    *(_interruption_notes(explored, front) if stopped else ()),
                    *_notes(trade_off, ends, explored, ordered),
                    *trade_off.notes,
                    *correction_notes(share),
                ]
            )
        ),
        provenance=provenance(context, ends, _network_summaries(explored), _speeds_kn(trade_off)),
        plot_context=_plot_context(context, explored),
        front=front,
        cancelled=stopped,
    )


def _interruption_notes(explored: list[ExploredAlternative], front: ParetoFront) -> list[str]:
    """Return a note about the contents of a plan that Ctrl-C ended."""
    if all(one.exact is None for one in explored):
        content = "before there was a front: the plan holds the fastest route"
    elif set(front.stages) <= {"exact", "fastest"}:
        content = "before refinement: the plan holds the exact front of the network"
    else:
        content = "before refinement was complete: the plan holds the best front so far"
    return [f"Stopped by Ctrl-C {content}; a longer run may improve it."]


def _weather_blind_routes(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> list[Route]:
    """Return the weather-blind routes of the shortest alternative, in the weather of the plan."""
    if trade_off.interrupt_guard.stopped():
        return []
    network = min((one.way.network for one in explored), key=shortest_path_length)
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    trade_off.context.report_progress("evaluating the weather-blind route")
    tracks = weather_blind_tracks(
        trade_off.context, network.lat[path], network.lon[path], trade_off.settings
    )
    sailed = evaluate_weather_blind(trade_off.context, trade_off.objective, tracks)
    if not sailed:
        trade_off.notes.append(
            "The weather-blind route cannot be sailed to its end in these data: it is not compared."
        )
    return sailed


def _including_constant_speeds(
    trade_off: TradeOffContext, scored: list[RefereedCandidate], blind: list[Route]
) -> list[RefereedCandidate]:
    """Return the non-dominated routes, with constant speeds on the shortest route included."""
    latest = trade_off.context.latest_arrival
    constant = [
        RefereedCandidate(
            TrackCandidate(r.track, "constant speed", "", r.time_h * HOUR, value), r, value
        )
        for r, value in ((route, trade_off.objective.value(route)) for route in blind)
        if r.feasible and r.arrive <= latest + 1.0
    ]
    if not any(item.route.feasible for item in scored):
        return constant or scored
    pool = [*scored, *constant]
    time = np.array([item.route.time_h for item in pool])
    value = np.array([item.value for item in pool])
    return [pool[index] for index in non_dominated_indices(time, value)]


def _rejections(explored: list[ExploredAlternative]) -> dict[str, int]:
    refused: Counter[str] = Counter()
    for one in explored:
        refused.update(one.way.network.meta.rejected)
        refused.update(one.first.refused)
        refused.update(one.exact.refused if one.exact else {})
    return {reason: count for reason, count in refused.items() if count}


def _network_summaries(explored: list[ExploredAlternative]) -> list[dict[str, Any]]:
    return [
        network_summary(
            one.way.network,
            settled=int(one.first.settled),
            depart=one.fastest.depart,
            way=one.way.name,
        )
        for one in explored
    ]


def _speeds_kn(trade_off: TradeOffContext) -> list[float | None]:
    return [
        finite_or_none(float(trade_off.context.ship.speeds[s]) / KNOT) for s in trade_off.settings
    ]


def _plot_context(context: PlanningContext, explored: list[ExploredAlternative]) -> PlotContext:
    """Return the data of the plots, with the earliest arrivals of all alternatives."""
    networks = [one.way.network for one in explored]
    return PlotContext(
        lat=np.concatenate([network.lat for network in networks]),
        lon=np.concatenate([network.lon for network in networks]),
        arrival=np.concatenate([one.isochrones for one in explored]),
        chart=context.chart,
        sea=context.sea,
        ship=context.ship,
    )


def _notes(
    trade_off: TradeOffContext,
    ends: list[Endpoint],
    explored: list[ExploredAlternative],
    ordered: list[RefereedCandidate],
) -> list[str]:
    context, best = trade_off.context, ordered[0].route
    notes = [end.note for end in ends if end.note] + list(context.needs.notes)
    notes += [f"The referee finds a limit exceeded: {v}." for v in best.violations[:5]]
    notes += route_warnings(context, best)
    slowest = max(item.route.arrive for item in ordered)
    bounded = context.voyage.arrive_by is None and math.isfinite(context.data_end)
    if bounded and slowest > context.data_end - _DATA_END_MARGIN:
        notes.append(
            f"The data end at {format_time(context.data_end)}: slower routes were not considered."
        )
    return notes


def _no_feasible_route_error(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> NoRouteError:
    latest = trade_off.context.latest_arrival
    by = f" by {format_time(latest)}" if math.isfinite(latest) else ""
    soonest = min(one.first.arrive for one in explored)
    return NoRouteError(
        f"No route arrives{by} when the referee evaluates it in small steps.",
        f"The earliest arrival on the network is {format_time(soonest)}.",
        "Allow more time, or relax the limits.",
        reasons=_rejections(explored),
    )
