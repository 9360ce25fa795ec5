"""The work of a job that compares routes of a voyage that differ."""

from __future__ import annotations

from typing import Any

from thalweg.service.jobs.job_order import JobOrder, StageMessages
from thalweg.service.jobs.limits_met import limits_met
from thalweg.service.jobs.plan_request import AlternativesRequest
from thalweg.service.jobs.request_objects import network_of, open_world
from thalweg.service.jobs.route_results import route_totals, write_route_result


def plan_alternatives(order: JobOrder, stages: StageMessages) -> tuple[str, dict[str, Any]]:
    """Plan routes that differ, and write their files.

    Returns
    -------
    state : str
        ``done``, or ``cancelled`` with the routes found until then.
    summary : dict
        Key figures of the fastest one.
    """
    from thalweg.planning import alternative_plans
    from thalweg.planning.request.requirements import required_under_keel_clearance

    request = AlternativesRequest.model_validate(order.request)
    voyage = request.checked_voyage()
    stages("reading the ship, the sea and the coastline")
    world = open_world(request, order.files)
    found = alternative_plans(
        voyage,
        ship=world.ship,
        sea=world.sea,
        chart=world.chart,
        network=network_of(request, order.files),
        resolution=request.resolution_m,
        progress=stages,
        most=request.most,
    )
    stages("writing the files")
    ends = found.ends
    options = request.route_files.options(start=ends[0], goal=ends[1])
    for number, choice in enumerate(found.choices, start=1):
        write_route_result(choice.route, order.path, number, options, stem=order.stem)
    min_ukc = required_under_keel_clearance(voyage, world.ship)
    met = [
        limits_met(choice.route, ship=world.ship, chart=None, min_ukc=min_ukc)
        for choice in found.choices
    ]
    order.write_json("limits.json", {"routes": met})
    provenance = {"from": ends[0], "to": ends[1]}
    result = {**found.to_dict(), "cancelled": found.cancelled, "provenance": provenance}
    order.write_json("alternatives.json", result)
    best = found.choices[0].route
    summary = {
        **provenance,
        "parts": ["limits"],
        "routes": len(found.choices),
        "feasible": best.feasible,
        "cancelled": found.cancelled,
        "seconds": stages.seconds(),
        **route_totals(best),
    }
    return "cancelled" if found.cancelled else "done", summary
