"""Assembly of a plan from the evaluated candidates of a trade-off."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import MEAN_RADIUS, unit_vectors
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.network import EdgeWeights, shortest_path
from thalweg.planning.pareto.baseline import (
    compare_with_baseline,
    constant_speed_tracks,
    evaluate_weather_blind,
    no_reference_note,
    undercut_note,
    weather_blind_tracks,
)
from thalweg.planning.pareto.front_bound.certified_front import WITH_DUES, certified_front
from thalweg.planning.pareto.front_bound.least_ways import (
    derive_proof,
)
from thalweg.planning.pareto.route_names import route_labels
from thalweg.planning.pareto.search_horizon import shortest_path_length
from thalweg.planning.pareto.speeds_between import note_on_speeds_between
from thalweg.planning.pareto.trade_off_context import (
    ExploredAlternative,
    RefereedCandidate,
    TrackCandidate,
    TradeOffContext,
    non_dominated_candidates,
    scored_candidate,
)
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import PlotContext, Proof
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.lane_report import lane_detour_notes
from thalweg.planning.report.note_order import LIMIT_EXCEEDED
from thalweg.planning.report.provenance import (
    network_summary,
    provenance,
    route_warnings,
)
from thalweg.planning.report.route_summary import canals_passed
from thalweg.planning.report.zone_report import control_area_notes
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.single.weather_gaps import check_times_known
from thalweg.route import Route

#: Routes that end within this time of the end of the data are taken as limited by it [s].
_SAME_PLACE = 5  # decimals of positions [deg] at which tracks are the same
_DATA_END_MARGIN = 3.0 * HOUR
_SAME_WATER = 1.5  # spacings of a network within which it has a node in the same water


def assemble_trade_off_plan(
    trade_off: TradeOffContext,
    ends: list[Endpoint],
    explored: list[ExploredAlternative],
    scored: list[RefereedCandidate],
) -> Plan:
    """Assemble the plan of a trade-off: order, bound, baseline, notes and provenance.

    Raises
    ------
    NoRouteError : If no candidate reaches the goal.
    """
    context = trade_off.context
    blind = _weather_blind_routes(trade_off, explored)
    constant = _constant_speed_candidates(trade_off, scored, blind)
    ordered = _in_order(trade_off, _including_constant_speeds(scored, constant))
    if not ordered:
        for one in explored:
            check_times_known(one.fastest, ends[0], ends[-1])
        raise _no_feasible_route_error(trade_off, explored)
    sailed = [item.route for item in constant if item.route not in blind]
    certain = certified_front(trade_off, explored, ordered)
    front = _pareto_front(trade_off, explored, ordered, certain.points, (blind, sailed))
    stopped = trade_off.interrupt_guard.stopped()
    notes = [
        *(_interruption_notes(explored, front) if stopped else ()),
        *_notes(trade_off, ends, explored, ordered),
        *trade_off.notes,
    ]
    if front.comparison is not None:
        routes, compared = [item.route for item in ordered], front.comparison
        note = undercut_note(
            routes, front.values, compared.routes, compared.values, context.latest_arrival
        )
        notes += [note] if note else []
    proof = derive_proof(trade_off, explored, certain.points, certain.kind, until=certain.until)
    notes += _dues_notes(trade_off, ordered[0], proof)
    notes += filter(None, [note_on_speeds_between(trade_off)])
    return Plan(
        voyage=context.voyage,
        routes=tuple(item.route for item in ordered),
        proof=proof,
        rejections=_rejections(explored),
        notes=tuple(dict.fromkeys(notes)),
        provenance=provenance(context, ends, _network_summaries(explored), _speeds_kn(trade_off)),
        plot_context=_plot_context(context, explored),
        front=front,
        cancelled=stopped,
    )


def _in_order(
    trade_off: TradeOffContext, scored: list[RefereedCandidate]
) -> list[RefereedCandidate]:
    """Return candidates in order of time; unless the whole front is required, the best first."""
    ordered = sorted(scored, key=lambda item: item.route.time_h)
    if trade_off.context.voyage.objective == "front" or not ordered:
        return ordered
    best = min(ordered, key=lambda item: item.value * (1.0 + item.penalty))
    return [best, *(item for item in ordered if item is not best)]


def _pareto_front(
    trade_off: TradeOffContext,
    explored: list[ExploredAlternative],
    ordered: list[RefereedCandidate],
    certain: FloatArray,
    references: tuple[list[Route], list[Route]],
) -> ParetoFront:
    """Return the front of the candidates in their order."""
    context, objective = trade_off.context, trade_off.objective
    routes = tuple(item.route for item in ordered)
    values = np.array([item.value for item in ordered])
    networks = {one.alternative.name: one.alternative.network for one in explored}
    shortest = min(networks, key=lambda name: shortest_path_length(networks[name]))
    return ParetoFront(
        criterion=objective.name,
        unit=objective.unit,
        values=values,
        stages=tuple(item.candidate.stage for item in ordered),
        ways=route_labels(
            routes,
            [item.candidate.alternative or shortest for item in ordered],
            networks,
            context.chart,
        ),
        comparison=compare_with_baseline(context, objective, routes, values, *references),
        certain=certain,
        objective=objective.objective,
    )


def _interruption_notes(explored: list[ExploredAlternative], front: ParetoFront) -> list[str]:
    """Return a note about the contents of a plan that Ctrl-C ended."""
    if all(one.exact is None for one in explored):
        content = "before there was a front: the plan holds the fastest route"
    elif set(front.stages) <= {"exact", "fastest"}:
        content = "before refinement: the plan holds the exact front of the network"
    else:
        content = "before refinement was complete: the plan holds the best front so far"
    return [f"Stopped {content}; a longer run may improve it."]


def _weather_blind_routes(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> list[Route]:
    """Return the weather-blind routes of the shortest alternative, in the weather of the plan."""
    if trade_off.interrupt_guard.stopped():
        return []
    network = min((one.alternative.network for one in explored), key=shortest_path_length)
    weight = EdgeWeights.penalised(network, trade_off.context.chart).weight
    ends = network.meta.start, network.meta.goal
    _, path = shortest_path(network, *ends, weight=weight, per_metre=1.0)
    trade_off.context.report_progress("evaluating the weather-blind route")
    tracks = weather_blind_tracks(
        trade_off.context, network.lat[path], network.lon[path], trade_off.settings
    )
    sailed = evaluate_weather_blind(trade_off.context, trade_off.objective, tracks)
    if not sailed:
        trade_off.notes.append(
            "The weather-blind route cannot be sailed to its end in these data: it is not compared."
        )
    trade_off.notes.extend(filter(None, [no_reference_note(sailed)]))
    return sailed


def _constant_speed_candidates(
    trade_off: TradeOffContext, scored: list[RefereedCandidate], blind: list[Route]
) -> list[RefereedCandidate]:
    """Return the shortest route, and routes of the front, at constant speeds within the limits."""
    context, objective = trade_off.context, trade_off.objective
    ordered = sorted(scored, key=lambda item: item.route.time_h)
    places = {
        tuple(np.round([item.route.track.lat, item.route.track.lon], _SAME_PLACE).ravel()): item
        for item in ordered
        if item.route.feasible
    }
    feasible = list(places.values())
    found = [(route, "") for route in blind]
    if feasible and len(trade_off.settings) > 1 and not trade_off.interrupt_guard.stopped():
        context.report_progress("evaluating constant speeds")
        from thalweg.planning.pareto.evolutionary_refinement import evaluator_around_routes

        routes = [item.route for item in feasible]
        evaluator = evaluator_around_routes(trade_off, routes)
        tracks = constant_speed_tracks([r.track for r in routes], trade_off.settings, evaluator)
        found += [
            (context.evaluate(track), feasible[way].candidate.alternative) for way, track in tracks
        ]
    priced = [(route, name, objective.value(route)) for route, name in found]
    return [
        scored_candidate(
            trade_off,
            TrackCandidate(r.track, "constant speed", name, r.time_h * HOUR, value),
            r,
            value,
        )
        for r, name, value in priced
        if r.feasible and math.isfinite(value) and r.arrive <= context.latest_arrival + 1.0
    ]


def _including_constant_speeds(
    scored: list[RefereedCandidate], constant: list[RefereedCandidate]
) -> list[RefereedCandidate]:
    """Return the non-dominated routes, with those at constant speeds included."""
    if not any(item.route.feasible for item in scored):
        return constant or scored
    return non_dominated_candidates([*scored, *constant])


def _rejections(explored: list[ExploredAlternative]) -> dict[str, int]:
    refused: Counter[str] = Counter()
    for one in explored:
        refused.update(one.alternative.network.meta.rejected)
        refused.update(one.first.refused)
        refused.update(one.exact.refused if one.exact else {})
    return {reason: count for reason, count in refused.items() if count}


def _network_summaries(explored: list[ExploredAlternative]) -> list[dict[str, Any]]:
    return [
        network_summary(
            one.alternative.network,
            settled=int(one.first.settled),
            depart=one.fastest.depart,
            way=one.alternative.name,
        )
        for one in explored
    ]


def _speeds_kn(trade_off: TradeOffContext) -> list[float | None]:
    return [
        finite_or_none(float(trade_off.context.ship.speeds[s]) / KNOT) for s in trade_off.settings
    ]


def _plot_context(context: PlanningContext, explored: list[ExploredAlternative]) -> PlotContext:
    """Return the data of the plots, with the earliest arrivals by the fastest alternative.

    Others add their nodes in other water alone: times by two canals side by side are no surface.
    """
    first = min(explored, key=lambda one: one.fastest.arrive)
    shown = [(one, _nodes_apart(one, first)) for one in explored]
    return PlotContext(
        lat=np.concatenate([one.alternative.network.lat[nodes] for one, nodes in shown]),
        lon=np.concatenate([one.alternative.network.lon[nodes] for one, nodes in shown]),
        arrival=np.concatenate([one.isochrones[nodes] for one, nodes in shown]),
        chart=context.chart,
        sea=context.sea,
        ship=context.ship,
    )


def _nodes_apart(one: ExploredAlternative, first: ExploredAlternative) -> NDArray[np.int64]:
    """Return the nodes of an alternative that are not in water where another one has some."""
    if one is first:
        return np.arange(one.alternative.network.n_nodes)
    places, others = (
        unit_vectors(alternative.network.lat, alternative.network.lon)
        for alternative in (one.alternative, first.alternative)
    )
    reach = _SAME_WATER * first.alternative.network.meta.spacing_m / MEAN_RADIUS
    return np.flatnonzero(cKDTree(others).query(places, distance_upper_bound=reach)[0] > reach)


def _notes(
    trade_off: TradeOffContext,
    ends: list[Endpoint],
    explored: list[ExploredAlternative],
    ordered: list[RefereedCandidate],
) -> list[str]:
    context, best = trade_off.context, ordered[0].route
    notes = [end.note for end in ends if end.note] + list(context.needs.notes)
    notes += [f"{LIMIT_EXCEEDED}: {v}." for v in best.violations[:5]]
    if trade_off.objective.name == "comfort" and not any(item.value for item in ordered):
        notes.append(
            "Nobody gets sick on any route: the sea has no waves here, so that the objective does "
            "not choose. Least time or fuel does."
        )
    notes += route_warnings(context, best)
    notes += control_area_notes(context.chart, [item.route for item in ordered])
    notes += lane_detour_notes(context.chart, [explored[0].alternative.network], best)
    slowest = max(item.route.arrive for item in ordered)
    bounded = context.voyage.arrive_by is None and math.isfinite(context.data_end)
    if bounded and slowest > context.data_end - _DATA_END_MARGIN:
        notes.append(
            f"The data end at {format_time(context.data_end)}: slower routes were not considered."
        )
    return notes


def _dues_notes(trade_off: TradeOffContext, best: RefereedCandidate, proof: Proof) -> list[str]:
    """Return a note where canal dues, which the bound leaves out, are part of the cost."""
    canals = canals_passed(best.route, trade_off.context.chart)
    unit = trade_off.objective.terms.currency or "USD"
    dues = trade_off.objective.prices.dues * sum(canal.fee for canal in canals)
    rest = best.value - dues
    if not dues > 0.0 or not 0.0 < proof.certain <= rest or WITH_DUES in proof.kind:
        return []
    if trade_off.context.voyage.objective == "front":
        return [f"The bound of the cost leaves the canal dues out ({dues:,.0f} {unit})."]
    share = math.ceil(1000.0 * (1.0 - proof.certain / rest)) / 10.0
    return [
        f"The bound of the cost leaves the canal dues out ({dues:,.0f} {unit}): of the cost "
        f"without them, at most {share:.1f} % less is possible."
    ]


def _no_feasible_route_error(
    trade_off: TradeOffContext, explored: list[ExploredAlternative]
) -> NoRouteError:
    latest = trade_off.context.latest_arrival
    by = f" by {format_time(latest)}" if math.isfinite(latest) else ""
    earliest = min(one.first.arrive for one in explored)
    return NoRouteError(
        f"No route arrives{by} when the referee evaluates it in small steps.",
        f"The earliest arrival on the network is {format_time(earliest)}.",
        "Allow more time, or relax the limits.",
        reasons=_rejections(explored),
    )
