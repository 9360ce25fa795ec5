"""What a plan states about land: the nearest land, and the passages the route uses."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.offing import closing_line
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import densify, distance, format_position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route
from thalweg.route.referee.land_clearance import least_land_clearance

_NEAR: Final = 30.0 * NAUTICAL_MILE  # passages farther from the route are not looked at
_STEP: Final = 10.0 * NAUTICAL_MILE


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
    lat, lon, _leg = densify(route.track.lat, route.track.lon, _STEP)
    found: list[tuple[float, Passage]] = []
    for passage in chart.passages:
        y, x = passage.positions
        middle = len(y) // 2
        reach = _NEAR + passage.length
        box = np.abs(lat - y[middle]) < reach / 111e3
        if not box.any():
            continue
        near = distance(lat[box], lon[box], y[middle], x[middle]).min() < reach
        if near:
            at = _crossing(lat, lon, *closing_line(chart.coastline, passage))
            if at is not None:
                found.append((at, passage))
    return [passage for _, passage in sorted(found, key=lambda pair: pair[0])]


def _crossing(lat: np.ndarray, lon: np.ndarray, a: Any, b: Any) -> float | None:
    """Return where a line crosses that from a to b [piece], or None; all pieces are short."""
    shift = np.cos(np.radians(a[0]))
    px, py = ((lon - a[1] + 180.0) % 360.0 - 180.0) * shift, lat - a[0]
    qx, qy = ((b[1] - a[1] + 180.0) % 360.0 - 180.0) * shift, b[0] - a[0]
    side = qx * py - qy * px  # on which side of a-b each position is
    ex, ey = np.diff(px), np.diff(py)
    start = ex * (0.0 - py[:-1]) - ey * (0.0 - px[:-1])
    end = ex * (qy - py[:-1]) - ey * (qx - px[:-1])
    near = np.hypot(px[:-1], py[:-1]) < 20.0
    hit = np.flatnonzero((side[:-1] * side[1:] <= 0.0) & (start * end <= 0.0) & near)
    return float(hit[0]) if len(hit) else None
