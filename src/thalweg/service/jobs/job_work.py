"""The work of one job in its child process, with all files of its result.

Files are written into a draft folder; the server gives the complete folder its final name.
"""

from __future__ import annotations

import json
import math
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.errors import ThalwegError
from thalweg.core.file_writing import make_folder, write_text
from thalweg.core.interrupt import held_interrupt
from thalweg.service.jobs.child_messages import MessageWriter
from thalweg.service.jobs.closure_facts import PLACES, TIMES, closure_facts
from thalweg.service.jobs.isochrone_lines import isochrone_lines
from thalweg.service.jobs.job_order import FIRST_SUMMARY, JobOrder, StageMessages
from thalweg.service.jobs.limits_met import limits_met
from thalweg.service.jobs.plan_request import EvaluationRequest, PlanRequest, RequestedRouteFiles
from thalweg.service.jobs.request_objects import WorldOfJob, network_of, open_world, with_orders_of
from thalweg.service.jobs.route_profiles import first_look, route_profile
from thalweg.service.jobs.route_results import route_totals, write_json_file, write_route_result

if TYPE_CHECKING:
    from thalweg.planning import Plan, Voyage
    from thalweg.route import Route


def run_order(order: JobOrder, messages: MessageWriter) -> tuple[str, dict[str, Any]]:
    """Do the work of a job and write its files.

    Returns
    -------
    state : str
        ``done`` or ``cancelled``.
    summary : dict
        Key figures of the result.
    """
    stages = StageMessages(messages)
    if order.kind == "evaluation":
        return "done", _evaluate(order, stages)
    if order.kind == "alternatives":
        from thalweg.service.jobs.alternatives_work import plan_alternatives

        return plan_alternatives(order, stages)
    if order.kind == "project":
        from thalweg.service.jobs.project_work import simulate_project

        return "done", simulate_project(order, messages, stages)
    if order.kind == "study":
        from thalweg.service.jobs.study_work import plan_study

        return plan_study(order, messages, stages)
    if order.kind == "forecast":
        from thalweg.service.jobs.fetch_work import fetch_sea

        return "done", fetch_sea(order, stages)
    return _plan(order, messages, stages)


def _plan(
    order: JobOrder, messages: MessageWriter, stages: StageMessages
) -> tuple[str, dict[str, Any]]:
    request = PlanRequest.model_validate(order.request)
    voyage = request.checked_voyage()
    try:
        return _plan_whole(voyage, request, order, messages, stages)
    except KeyboardInterrupt:
        kept = (order.first_path / FIRST_SUMMARY).exists()
        if kept or stages.route is None or voyage.via:
            raise
        return "cancelled", _keep_shown(stages.route, voyage, request, order, stages)


def _keep_shown(
    route: Route, voyage: Voyage, request: PlanRequest, order: JobOrder, stages: StageMessages
) -> dict[str, Any]:
    """Write the route that was shown last as the result of a job that is stopped."""
    from thalweg.planning import Plan
    from thalweg.planning.plan_data import Proof

    found = Plan(
        voyage=replace(voyage, objective="time", method="default"),
        routes=(route,),
        proof=Proof(math.nan, "no bound: the job was stopped before", route.time_h),
        rejections={},
        notes=(
            "The job was stopped: this is the best route found until then.",
            "Depth, approaches, speed loss and traffic were not reported on before it was stopped: "
            "plan again for the notes of this voyage.",
        ),
        provenance={"from": str(voyage.start), "to": str(voyage.goal)},
        cancelled=True,
    )
    with held_interrupt():
        parts = write_plan_result(found, order.path, None, request.route_files, stem=order.stem)
    return {**job_summary(found, stages.seconds()), "parts": parts}


def _plan_whole(
    voyage: Voyage,
    request: PlanRequest,
    order: JobOrder,
    messages: MessageWriter,
    stages: StageMessages,
) -> tuple[str, dict[str, Any]]:
    from thalweg.planning import plan

    stages("reading the ship, the sea and the coastline")
    world = open_world(request, order.files)
    first = None
    if voyage.chooses_speeds:
        first = _plan_first(voyage, request, world, order, messages, stages)
    found = plan(
        voyage,
        ship=world.ship,
        sea=world.sea,
        chart=world.chart,
        network=network_of(request, order.files),
        resolution=request.resolution_m,
        proof=request.proof_s,
        progress=stages,
    )
    if found.cancelled and first is not None:
        found = with_faster_route(found, first)
    beside = None
    with suppress(KeyboardInterrupt):  # the plan is kept in any case
        messages.send("route", {"route": first_look(found.best), "final": True})
        beside = None if found.cancelled else _beside(found, world, request, stages)
    with held_interrupt():
        stages("writing the files")
        parts = write_plan_result(found, order.path, beside, request.route_files, stem=order.stem)
        summary = {**job_summary(found, stages.seconds()), "parts": parts}
    return "cancelled" if found.cancelled else "done", summary


def _plan_first(
    voyage: Voyage,
    request: PlanRequest,
    world: WorldOfJob,
    order: JobOrder,
    messages: MessageWriter,
    stages: StageMessages,
) -> Route | None:
    """Plan the fastest route first, show it, and keep it as the result if the job is stopped."""
    from thalweg.planning import plan

    fastest = replace(voyage, objective="time", method="default", ensemble=None)
    if world.sea.members:
        return None
    stages("planning the fastest route first")
    with suppress(ThalwegError):  # the plan itself states what is wrong
        found = plan(
            fastest,
            ship=world.ship,
            sea=world.sea,
            chart=world.chart,
            network=network_of(request, order.files),
            resolution=request.resolution_m,
            proof=0.0,
            progress=stages,
        )
        cancelled = found.cancelled
        note = "The job was stopped: this is the fastest route, the objective was not reached."
        found = replace(found, notes=(note, *found.notes), cancelled=True)
        with held_interrupt() as stopped:  # the server keeps it if it has both files and summary
            folder = make_folder(order.first_path)
            parts = write_plan_result(found, folder, None, request.route_files, stem=order.stem)
            summary = {**job_summary(found, stages.seconds()), "parts": parts}
            write_text(folder / FIRST_SUMMARY, json.dumps(summary, allow_nan=False))
            messages.send(
                "route", {"route": first_look(found.best), "final": False, "summary": summary}
            )
        if cancelled or stopped.is_set():
            raise KeyboardInterrupt
        return found.best
    return None


def with_faster_route(found: Plan, first: Route) -> Plan:
    """Return a front that was stopped with a route found before it, if that is faster than all.

    Routes that take longer and are not better in the other figure are left out.
    """
    front = found.front
    if front is None or front.objective is None or not first.feasible:
        return found
    value = front.objective.value(first)
    fastest = min(route.time_h for route in found.routes)
    if not (math.isfinite(value) and first.time_h < fastest):
        return found
    kept = [k for k, other in enumerate(front.values.tolist()) if other < value]
    rows = [(found.routes[k], front.values[k], front.stages[k], front.ways[k]) for k in kept]
    first_row = (first, value, "fastest", "fastest route, found first")
    is_best = found.voyage.objective == "front" or not rows
    rows.insert(0 if is_best else 1, first_row)
    routes, values, front_stages, ways = zip(*rows)
    front = replace(front, values=np.array(values), stages=front_stages, ways=ways)
    return replace(found, routes=routes, front=front)


def _beside(
    found: Plan, world: WorldOfJob, request: PlanRequest, stages: StageMessages
) -> Route | None:
    """Return the route that ignores the weather, sailed in it; None where there is none.

    Of a front it is the fastest that keeps every limit, or else the fastest.
    """
    if request.seas == ["calm"] or world.sea.members:
        return None
    if found.front is not None:
        compared = found.front.comparison
        blind = compared.routes if compared is not None else ()
        return next((route for route in blind if route.feasible), blind[0] if blind else None)
    if found.voyage.depart is None or found.voyage.arrive is not None:
        return None
    from thalweg.planning.demo_voyage import weather_blind

    stages("sailing the route that ignores the weather")
    with suppress(ThalwegError):
        return weather_blind(found, ship=world.ship, sea=world.sea, chart=world.chart)
    return None


def write_plan_result(
    found: Plan,
    folder: Path,
    beside: Route | None,
    files_as: RequestedRouteFiles | None = None,
    *,
    stem: str = "route",
) -> list[str]:
    """Write all files of a plan: plan.json, route files, profiles, isochrones.

    Parameters
    ----------
    folder : It exists.
    beside : The route that ignores the weather.
    files_as : How the route files are written; by default with rhumb lines within 0.1 nm.
    stem : Beginning of their names.

    Returns
    -------
    list of str
        ``isochrones``, ``beside``, ``space_time`` and ``limits``, where there are such files.
    """
    found.to_json(folder / "plan.json")
    chart = None if found.plot_context is None else found.plot_context.chart
    start, goal = (str(found.provenance.get(key) or "") for key in ("from", "to"))
    options = (files_as or RequestedRouteFiles()).options(chart=chart, start=start, goal=goal)
    for number, route in enumerate(found.routes, start=1):
        write_route_result(route, folder, number, options, plan=found, stem=stem)
    lines = isochrone_lines(found)
    other = None if beside is None else {**beside.as_dict(), "profile": route_profile(beside)}
    parts = {
        "isochrones": lines,
        "beside": other,
        "space_time": _space_time(found),
        "limits": _limits_of_plan(found),
    }
    for name, data in parts.items():
        write_json_file(folder / f"{name}.json", data)
    return [name for name, data in parts.items() if data is not None]


def _space_time(found: Plan) -> dict[str, Any] | None:
    """Return the diagram of place and time of the best route, if the tide matters to it."""
    from thalweg.planning.plots.space_time_diagram import closures_of_plan

    closures = closures_of_plan(found, PLACES, TIMES)
    return None if closures is None else closure_facts(closures, [found.best])


def _limits_of_plan(found: Plan) -> dict[str, Any] | None:
    from thalweg.planning.request.requirements import required_under_keel_clearance

    known = found.plot_context
    if known is None:
        return None
    min_ukc = required_under_keel_clearance(found.voyage, known.ship)
    given = {"ship": known.ship, "chart": known.chart, "min_ukc": min_ukc}
    return {"routes": [limits_met(route, **given) for route in found.routes]}


def job_summary(found: Plan, seconds: float) -> dict[str, Any]:
    """Return the key figures of a plan for lists of jobs."""
    from thalweg.planning.report.plan_summary import quality_text

    best = found.best
    return {
        "from": found.provenance.get("from"),
        "to": found.provenance.get("to"),
        "objective": found.voyage.objective,
        "routes": len(found.routes),
        "feasible": best.feasible,
        "cancelled": found.cancelled,
        "seconds": seconds,
        **route_totals(best),
        "quality": quality_text(found),
    }


def _evaluate(order: JobOrder, stages: StageMessages) -> dict[str, Any]:
    from thalweg.planning.report.provenance import given_route_warnings
    from thalweg.planning.report.squat_report import with_squat_violation
    from thalweg.route import evaluate

    request = EvaluationRequest.model_validate(order.request)
    request.check()
    stages("reading the ship, the sea and the coastline")
    world = open_world(request, order.files)
    sea = world.sea if request.member is None else world.sea.member(request.member)
    stages("sailing the route")
    route = evaluate(
        order.files[request.route],
        ship=with_orders_of(world.ship, request),
        sea=sea,
        chart=world.chart,
        depart=request.depart,
        speed_kn=request.speed_kn,
        min_ukc=request.min_ukc_m,
        strict=False,
    )
    ship, clearance = world.ship, request.min_ukc_m
    min_ukc = ship.min_under_keel_clearance if clearance is None else clearance
    warnings = given_route_warnings(route, chart=world.chart, sea=sea, ship=ship, min_ukc=min_ukc)
    route = replace(route, assumptions=tuple(dict.fromkeys((*warnings, *route.assumptions))))
    route = with_squat_violation(route, ship)
    folder = Path(order.folder)
    write_json_file(folder / "route.json", route.as_dict())
    write_route_result(route, folder, 1, request.route_files.options(), stem=order.stem)
    met = limits_met(route, ship=ship, chart=world.chart, min_ukc=min_ukc)
    write_json_file(folder / "limits.json", {"routes": [met]})
    return {
        "parts": ["limits"],
        "feasible": route.feasible,
        "seconds": stages.seconds(),
        "routes": 1,
        **route_totals(route),
    }
