"""`plan`: from a voyage, a ship, a sea and a chart to a plan."""

from __future__ import annotations

import itertools
import time as clock
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.coast.gshhg import usual_resolution
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.units import KNOT
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.planning.approach_sailing import (
    ApproachSailing,
    plan_along_approaches,
    shared_line,
)
from thalweg.planning.offing_attempts import plan_off_land, shortest_length
from thalweg.planning.plan import Plan
from thalweg.planning.plan_data import PlotContext, Proof, in_objective_unit
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.lane_report import lane_detour_notes
from thalweg.planning.report.provenance import (
    network_summary,
    provenance,
    route_warnings,
)
from thalweg.planning.report.squat_report import with_squat_violation
from thalweg.planning.request.coverage_check import (
    check_argument_types,
)
from thalweg.planning.request.early_checks import check_request
from thalweg.planning.request.network_choice import (
    NetworkBuilder,
    NetworkChoice,
    history_corridor,
)
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.voyage_endpoints import (
    Endpoint,
)
from thalweg.planning.request.voyage_objective import with_voyage_prices
from thalweg.planning.single.certified_bound import certified_total, usual_proof_time
from thalweg.planning.single.stretch import plan_stretch
from thalweg.planning.single.stretch_result import StretchResult
from thalweg.planning.single.waits_by_via_points import by_later_departure
from thalweg.planning.voyage import Voyage
from thalweg.planning.voyage_context import ends_by_ways, voyage_context
from thalweg.route import Route, with_wind_speed
from thalweg.route import join as join_routes
from thalweg.sea import Sea
from thalweg.search import LowerBound
from thalweg.ship import Ship

#: `plan` with the network, resolution, proof and progress of a request.
_Replan: TypeAlias = Callable[..., Plan]

_LONGEST_PROOF = 3600.0  # [s]


def plan(
    voyage: Voyage,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    network: str | NetworkBuilder | HistoryCorridor = "auto",
    resolution: float | None = None,
    proof: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> Plan:
    """Plan a voyage: exact search on a network, refinement in open water, check by the referee.

    Parameters
    ----------
    voyage : Voyage
        The request.
    ship : Ship
        The ship, with its limits.
    sea : Sea
        Currents, levels, wind and waves. There is no default; use `Sea.calm` for still water.
    chart : Chart, optional
        Land, depth and zones; by default the GSHHG coastline at resolution "i".
    network : {"auto", "lattice", "mesh", "globe", "layered"}, "history:FILE" or callable
        How the network is built; see `thalweg.planning.NetworkChoice`. With a file made by
        ``thalweg history build``, or a
        `thalweg.network.history.history_corridor.HistoryCorridor`, the plan stays in the water
        that ships usually use. The search uses the edges of a builder's network; the refined route
        may leave them.
    resolution : float, optional
        Spacing of the network [m]; by default it depends on the distance.
    proof : float, optional
        Time for the proof of the lower bound [s], 0 for the bound of the geodesic alone; by
        default as long as the search, 1 s or more, and 15 s or more where a passage of trade
        within reach is closed to the ship. It ends earlier where the gap is below 0.5 %.
    progress : callable, optional
        Called with a short text at each stage. If it also has methods ``show_route`` and
        ``show_front``, these receive each better route, and the times [s] and values of each
        better front with the unit of the values, while planning goes on.

    Returns
    -------
    Plan
        The best route, its proof and its provenance. Where speeds are chosen leg by leg and a
        route has been found, Ctrl-C ends planning with the best plan so far (`Plan.cancelled`).
        Pressed before that, or a second time, it interrupts.

    Raises
    ------
    InputError
        For places on land, unknown ports, and speeds that the ship does not have.
    CoverageError
        If the data lack a variable, the area or the period.
    NoRouteError
        If no route exists within the limits (with the reasons counted).
    """
    chart = Chart.gshhg(usual_resolution()) if chart is None else chart
    options: dict[str, Any] = {"network": network, "resolution": resolution, "progress": progress}
    found = _plan_voyage(voyage, ship=ship, sea=sea, chart=chart, proof=proof, **options)
    if found.plot_context is None:
        return found
    sailing = found.plot_context.ship
    routes = tuple(with_squat_violation(route, sailing) for route in found.routes)
    return replace(found, routes=routes)


def _plan_voyage(
    voyage: Voyage,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    proof: float | None,
    **options: Any,
) -> Plan:
    """Return the plan of a voyage, for those that need it for others, too; arguments of `plan`."""
    check_argument_types(voyage, ship, sea, chart)
    ship = with_voyage_prices(ship, voyage)
    if voyage.min_ukc_m is not None:
        ship = ship.with_clearance(voyage.min_ukc_m)
    network = options["network"]
    replan: _Replan = partial(_plan_voyage, proof=proof, **options)
    if voyage.has_indicator_limits:
        from thalweg.planning.indicators.limited_voyage import plan_limited_voyage

        return plan_limited_voyage(voyage, ship, sea, chart, replan, **options)
    if voyage.arrive is not None:
        return _plan_arrival(voyage, ship, sea, chart, replan, options)
    ship = with_order(ship, voyage)
    if sea.members:
        return _plan_members(voyage, ship, sea, chart, replan)
    _check_options(voyage, proof)
    corridor = history_corridor(network)
    if corridor is not None:
        return _plan_in_usual_water(voyage, ship, sea, chart, corridor, replan)
    assert not isinstance(network, HistoryCorridor)  # planned above
    return _plan_alone(voyage, ship, sea, chart, options, proof_seconds=proof)


def _plan_alone(
    voyage: Voyage, ship: Ship, sea: Sea, chart: Chart, options: dict[str, Any], **settings: Any
) -> Plan:
    """Return the plan of a voyage that needs no other plans, with settings of its context."""
    choice = NetworkChoice(options["network"], options["resolution"], voyage.layered)
    context, ends = voyage_context(voyage, ship, with_wind_speed(ship, sea), chart, choice)
    report = options["progress"] or context.report_progress
    context = replace(context, report_progress=report, **settings)
    return _plan_with_approaches(context, ends)


def _plan_arrival(
    voyage: Voyage,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    replan: _Replan,
    options: dict[str, Any],
) -> Plan:
    """Return the plan of a voyage that arrives at a given time."""
    from thalweg.planning.arrival_planner import ArrivalRequest, plan_arrival

    corridor = history_corridor(options["network"]) is not None

    def plan_one(request: Voyage, with_speed: Ship, whole: bool) -> Plan:
        if whole or corridor:
            return replan(request, ship=with_speed, sea=sea, chart=chart)
        settings: dict[str, Any] = {"proof_seconds": 0.0, "leaves_later": False}
        ordered = with_order(with_speed, request)
        return _plan_alone(request, ordered, sea, chart, options, **settings)

    check_request(voyage, ship, with_wind_speed(ship, sea))
    report = options["progress"] or (lambda text: None)
    return plan_arrival(ArrivalRequest(voyage, ship, sea, chart, plan_one, report))


def _plan_members(voyage: Voyage, ship: Ship, sea: Sea, chart: Chart, replan: _Replan) -> Plan:
    """Return the plan of a voyage in an ensemble forecast."""
    from thalweg.planning.ensemble_plan import plan_ensemble

    if voyage.objective == "weighted":
        raise InputError(
            "A weighted sum of key figures is minimised, in an ensemble forecast.",
            "Weights count over the ranges of one network in one forecast.",
            "Choose another objective, or give one member.",
            field="objective",
        )

    def plan_member(request: Voyage, member: Sea) -> Plan:
        return replan(replace(request, ensemble=None), ship=ship, sea=member, chart=chart)

    return plan_ensemble(voyage, ship=ship, sea=sea, plan_one=plan_member)


def _plan_in_usual_water(
    voyage: Voyage,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    corridor: HistoryCorridor,
    replan: _Replan,
) -> Plan:
    """Return the plan in the water that ships usually use."""
    from thalweg.planning.history_plans import CorridorRequest, plan_in_corridor

    def plan_one(open_water: Chart, builder: Any) -> Plan:
        return replan(voyage, ship=ship, sea=sea, chart=open_water, network=builder)

    ends = ends_by_ways(voyage, ship, chart)[0]
    request = CorridorRequest(voyage, corridor, chart, ends, plan_one)
    return plan_in_corridor(request, ship.draught)


def _check_options(voyage: Voyage, proof: float | None) -> None:
    """Refuse a risk measure without an ensemble, and a time for the proof out of range."""
    if voyage.ensemble is not None:
        raise InputError(
            f"The voyage sets the risk measure {voyage.ensemble!r} for an ensemble forecast.",
            "This sea is one forecast; it does not have members.",
            "Open files with an ensemble dimension, or leave out the risk measure.",
            field="ensemble",
        )
    if proof is not None and not 0.0 <= proof <= _LONGEST_PROOF:
        raise InputError(
            f"The time for the proof is {proof:g} s.",
            f"It is between 0 and {_LONGEST_PROOF:g} s.",
            "Correct it, or leave it out.",
            field="proof",
        )


def _plan_with_approaches(context: PlanningContext, ends: list[Endpoint]) -> Plan:
    """Return the plan at sea with the approaches of the ports at its ends."""
    line = shared_line(context, ends)
    if line is not None:
        return plan_along_approaches(context, ends, line)
    sailing = ApproachSailing.of_voyage(context, ends)
    at_sea = sailing.context_at_sea(context)
    offing = chosen_offing(context.voyage, context.ship)
    found = plan_off_land(
        at_sea, ends, offing, lambda c: _plan_at_sea(c, ends),
        length_of=lambda plan: 0.0 if plan.cancelled else shortest_length(plan.routes),
    )  # fmt: skip
    return sailing.with_approaches(found, context.voyage, context)


def _plan_at_sea(context: PlanningContext, ends: list[Endpoint]) -> Plan:
    """Return the plan between end points at sea, with one offing."""
    if context.voyage.chooses_speeds:
        from thalweg.planning.pareto.trade_off_planner import plan_trade_off

        return plan_trade_off(context, ends)
    began = clock.perf_counter()
    stretches = _plan_stretches(context, ends)
    if context.voyage.depart_window is None:
        planned = partial(_plan_stretches, context, ends)
        stretches = by_later_departure(context, stretches, planned)
    routes = [stretch.route for stretch in stretches]
    seconds = context.proof_seconds
    if seconds is None:
        seconds = usual_proof_time(context.chart, routes, clock.perf_counter() - began)
    window = context.voyage.earliest_departure, context.voyage.latest_departure
    bound = certified_total(context, routes, window, seconds=seconds)
    return _assemble_plan(context, ends, stretches, bound)


def _plan_stretches(
    context: PlanningContext, ends: list[Endpoint], depart: float | None = None
) -> list[StretchResult]:
    """Return the stretches between end points, from a departure [s since 1970] or the voyage's."""
    window = (context.voyage.earliest_departure, context.voyage.latest_departure)
    window = window if depart is None else (depart, depart)
    stretches: list[StretchResult] = []
    places = [(end.lat, end.lon) for end in ends]
    for number, (start, goal) in enumerate(itertools.pairwise(ends)):
        one = replace(
            context,
            choice=context.choice.of_section(places, number),
            with_approaches=_shown_after(context, [stretch.route for stretch in stretches]),
        )
        stretch = plan_stretch(one, start, goal, window)
        stretches.append(stretch)
        window = (stretch.route.arrive, stretch.route.arrive)
    return stretches


def _shown_after(context: PlanningContext, before: list[Route]) -> Callable[[Route], Route]:
    """Return what joins a route to those before it, with the approaches of ports, to be shown."""
    if not before:
        return context.with_approaches
    return lambda route: context.with_approaches(join_routes([*before, route]))


def _assemble_plan(
    context: PlanningContext,
    ends: list[Endpoint],
    stretches: list[StretchResult],
    bound: LowerBound,
) -> Plan:
    voyage = context.voyage
    routes = [stretch.route for stretch in stretches]
    route = routes[0] if len(routes) == 1 else join_routes(routes)
    refused: Counter[str] = Counter()
    for stretch in stretches:
        refused.update(stretch.network.meta.rejected)
        refused.update(stretch.result.refused)
    total = sum(stretch.result.cost for stretch in stretches)
    proof = Proof(
        certain=in_objective_unit(bound.value, voyage.objective),
        kind=bound.kind,
        solver_total=in_objective_unit(total, voyage.objective),
    )
    notes = [end.note for end in ends if end.note] + list(context.needs.notes)
    notes += [note for stretch in stretches for note in stretch.notes]
    notes += route_warnings(context, route)
    notes += lane_detour_notes(context.chart, [stretch.network for stretch in stretches], route)
    return Plan(
        voyage=voyage,
        routes=(route,),
        proof=proof,
        rejections={reason: count for reason, count in refused.items() if count},
        notes=tuple(dict.fromkeys(notes)),
        provenance=provenance(context, ends, _network_summaries(stretches), [_speed_kn(context)]),
        plot_context=_plot_context(context, stretches),
    )


def _network_summaries(stretches: list[StretchResult]) -> list[dict[str, Any]]:
    return [
        network_summary(p.network, settled=int(p.result.settled), depart=p.route.depart)
        for p in stretches
    ]


def _speed_kn(context: PlanningContext) -> float | None:
    return finite_or_none(float(context.ship.speeds[context.setting]) / KNOT)


def _plot_context(context: PlanningContext, stretches: list[StretchResult]) -> PlotContext:
    nodes = [stretch.network.n_nodes for stretch in stretches]
    ends = tuple((n, p.route.arrive) for p, n in zip(stretches, nodes))
    return PlotContext(
        lat=np.concatenate([p.network.stations.lat[:n] for p, n in zip(stretches, nodes)]),
        lon=np.concatenate([p.network.stations.lon[:n] for p, n in zip(stretches, nodes)]),
        arrival=np.concatenate([p.isochrones[:n] for p, n in zip(stretches, nodes)]),
        chart=context.chart,
        sea=context.sea,
        ship=context.ship,
        stages=ends if len(ends) > 1 else (),
    )
