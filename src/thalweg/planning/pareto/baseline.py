"""Baseline: the weather-blind route evaluated in the same weather."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.planning.plan_front import BaselineComparison
from thalweg.route import RefinementConditions, Route, Track, better_route, evaluate
from thalweg.sea import Sea

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thalweg.planning.planning_context import PlanningContext
    from thalweg.planning.request.voyage_objective import PricedObjective


_MAX_SPEEDS = 6


def weather_blind_tracks(
    context: PlanningContext, lat: FloatArray, lon: FloatArray, settings: NDArray[np.int64]
) -> list[Track]:
    """Return the shortest route over the chart, refined from a rough one, at up to six settings.

    Where only the sea provides depth, the route keeps to that depth.
    """
    depth_from_sea = context.needs.limits.depth_checked and not context.chart.has_depth
    sea = context.sea if depth_from_sea else _calm_sea(context)
    depart = context.voyage.earliest_departure
    top = len(context.ship.speeds) - 1
    rough = Track(lat, lon, depart, None, np.full(len(lat) - 1, top))  # type: ignore[arg-type]
    ship, chart, min_ukc = context.ship, context.chart, context.min_ukc
    scored = evaluate(rough, ship=ship, sea=sea, chart=chart, min_ukc=min_ukc, strict=False)
    conditions = RefinementConditions(
        ship, sea, chart, context.table, context.needs.limits, min_ukc
    )
    short = better_route(scored, conditions, objective="distance", wait=False).track
    legs = len(short.lat) - 1
    chosen = settings[np.unique(np.linspace(0, len(settings) - 1, _MAX_SPEEDS).round().astype(int))]
    return [short.replaced(setting=np.full(legs, s)) for s in chosen]


def _calm_sea(context: PlanningContext) -> Sea:
    """Return the sea without weather, with all variables that the ship reads."""
    return Sea.layered(Sea.calm(), context.sea)


def evaluate_weather_blind(
    context: PlanningContext, objective: PricedObjective, tracks: Sequence[Track]
) -> list[Route]:
    """Return weather-blind tracks evaluated in the weather of the plan, by ascending time."""
    sailed = [context.evaluate(track, objective.terms) for track in tracks]
    known = [route for route in sailed if math.isfinite(objective.value(route))]
    return sorted(known, key=lambda route: route.time_h)


def compare_with_baseline(
    context: PlanningContext,
    objective: PricedObjective,
    front: Sequence[Route],
    values: FloatArray,
    blind: Sequence[Route],
) -> BaselineComparison | None:
    """Return the savings of a front over weather-blind routes.

    Between two points of the front it is interpolated linearly: sailing part of the voyage as one
    route and the rest as the other comes close to that.
    """
    if not blind:
        return None
    order = np.argsort([route.time_h for route in front])
    time = np.array([front[i].time_h for i in order])
    value = np.minimum.accumulate(np.asarray(values)[order])
    counts = np.array([objective.value(route) for route in blind])
    speeds = np.asarray(context.ship.speeds) / KNOT
    rows = tuple(
        {"speed_kn": float(speeds[int(route.track.setting[0])])}
        | _savings_row(route, count, time, value)
        for route, count in zip(blind, counts)
    )
    return BaselineComparison(tuple(blind), counts, rows)


def _savings_row(blind: Route, count: float, time: FloatArray, value: FloatArray) -> dict[str, Any]:
    """Return the savings of a front over one route; None outside the range of the front."""
    no_earlier = blind.time_h >= time[0] * (1.0 - 1e-6)
    no_cheaper = count >= value[-1] * (1.0 - 1e-6)
    saved = float(count - np.interp(blind.time_h, time, value)) if no_earlier else None
    saved_h = float(blind.time_h - np.interp(-count, -value, time)) if no_cheaper else None
    return {
        "time_h": blind.time_h,
        "value": float(count),
        "distance_nm": blind.distance_nm,
        "feasible": blind.feasible,
        "saved_h": saved_h,
        "saved": saved,
        "saved_percent": None if saved is None or count <= 0 else 100.0 * saved / float(count),
    }
