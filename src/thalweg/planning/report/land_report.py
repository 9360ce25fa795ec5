"""What a plan states about land: the nearest land, and the passages the route uses."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import format_position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route
from thalweg.route.referee.land_clearance import least_land_clearance

_NEAR: Final = 30.0 * NAUTICAL_MILE  # land farther from the route is not mentioned


def land_notes(context: PlanningContext, route: Route) -> list[str]:
    """Return the nearest land to a route and the passages it uses, a sentence each.

    Empty for a voyage that keeps no offing.
    """
    if context.needs.limits.offing <= 0.0 and context.voyage.offing_nm == 0.0:
        return []
    notes = []
    nearest = least_land_clearance(context.chart, route.track)
    if nearest is not None and nearest.distance < _NEAR:
        place = format_position(nearest.lat, nearest.lon)
        notes.append(
            f"Nearest land: {nearest.distance / NAUTICAL_MILE:.1f} nm off, from {place} "
            f"(leg {nearest.leg + 1})."
        )
    for passage in passages_used(context.chart, route):
        facts = [
            f"half width {passage.half_width / NAUTICAL_MILE:.2g} nm",
            *([f"limits: {passage.limits}"] if passage.limits else []),
            *([f"pilotage {passage.pilotage}"] if passage.pilotage else []),
            *([passage.note] if passage.note else []),
            *(["unchecked"] if "unchecked" in passage.source else []),
        ]
        notes.append(f"Passes {passage.name} ({'; '.join(facts)}).")
    return notes


def passages_used(chart: Chart, route: Route) -> list[Passage]:
    """Return the passages of a chart that a route leads through, in their order on the route."""
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    return [p for _, p in passages_crossed(chart.coastline, chart.passages, lat, lon)]
