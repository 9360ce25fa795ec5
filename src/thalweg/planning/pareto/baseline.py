"""Baseline: the weather-blind route evaluated in the same weather."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.pareto_fronts import non_dominated_indices
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.planning.pareto.trade_off_context import spread_settings
from thalweg.planning.plan_front import BaselineComparison
from thalweg.route import RefinementConditions, Route, Track, better_route, evaluate
from thalweg.route.evaluators.population import Genome
from thalweg.sea import Sea

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thalweg.evolution import Evaluator
    from thalweg.planning.planning_context import PlanningContext
    from thalweg.planning.request.voyage_objective import PricedObjective


_MAX_SPEEDS = 6
_LEAST_UNDERCUT = 5e-4  # share of the value that is noted


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
    return [
        short.replaced(setting=np.full(legs, s)) for s in spread_settings(settings, _MAX_SPEEDS)
    ]


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


def constant_speed_tracks(
    tracks: Sequence[Track], settings: NDArray[np.int64], evaluator: Evaluator
) -> list[tuple[int, Track]]:
    """Return tracks chosen with the weather at constant settings without waits.

    They are up to six settings, evenly spread, and that of the cheapest track.

    Parameters
    ----------
    settings : Speed settings to choose from, ascending.
    evaluator : Of time and cost on tables, by which the tracks of each setting are chosen.

    Returns
    -------
    list of (int, Track) : The cheapest and the fastest feasible track at each setting, with the
        number of the track given.
    """
    spread = set(spread_settings(settings, _MAX_SPEEDS).tolist())
    found: dict[int, list[tuple[int, Track]]] = {}
    least: dict[int, float] = {}
    for setting in settings.tolist():
        constant = [
            track.replaced(wait=None, setting=np.full(len(track) - 1, setting), speed=None)
            for track in tracks
        ]
        genomes = [Genome.from_track(track, settings=evaluator.settings) for track in constant]
        time, cost, violation = evaluator(genomes)
        feasible = np.flatnonzero(violation == 0.0)
        if len(feasible):
            front = feasible[non_dominated_indices(time[feasible], cost[feasible])]
            found[setting] = [(int(k), constant[k]) for k in np.unique(front[[0, -1]])]
            least[setting] = float(cost[feasible].min())
    cheapest = min(least, key=least.__getitem__, default=None)
    kept = [setting for setting in found if setting in spread or setting == cheapest]
    return [one for setting in kept for one in found[setting]]


def no_reference_note(blind: Sequence[Route]) -> str | None:
    """Return a note where every weather-blind route breaks a limit, otherwise None."""
    if not blind or any(route.feasible for route in blind):
        return None
    reasons = Counter(route.violations[0].reason for route in blind if route.violations)
    reason = reasons.most_common(1)[0][0] if reasons else "a limit"
    return f"No weather-blind route is feasible: {reason}. Savings over it are not stated."


def undercut_note(
    front: Sequence[Route],
    values: FloatArray,
    blind: Sequence[Route],
    counts: FloatArray,
    latest: float,
) -> str | None:
    """Return a note where a feasible route for comparison has a lower value than a front.

    Parameters
    ----------
    values, counts : Of the routes of the front, and of the weather-blind ones.
    latest : Routes that arrive later are not compared [s since 1970]; inf for none.
    """
    order = np.argsort([route.time_h for route in front])
    time = np.array([front[i].time_h for i in order])
    least = np.minimum.accumulate(np.asarray(values)[order])
    most = 0.0
    for route, count in zip(blind, counts):
        planned = float(np.interp(route.time_h, time, least))
        in_time = route.time_h >= time[0] and route.arrive <= latest
        if route.feasible and in_time and count > 0.0 and planned > 0.0:
            most = max(most, 1.0 - count / planned)
    if most < _LEAST_UNDERCUT:
        return None
    return (
        f"The shortest route, for comparison, is up to {100.0 * most:.2g} % better than the "
        "routes of the plan: it keeps less clear of traffic lanes, shoals or penalty areas, where "
        "a mile counts more."
    )


def compare_with_baseline(
    context: PlanningContext,
    objective: PricedObjective,
    front: Sequence[Route],
    values: FloatArray,
    blind: Sequence[Route],
    constant: Sequence[Route] = (),
) -> BaselineComparison | None:
    """Return the savings of a front over the weather-blind routes that keep every limit.

    Between two points of the front it is interpolated linearly: sailing part of the voyage as one
    route and the rest as the other comes close to that.

    Parameters
    ----------
    values : Of the front [unit of the objective].
    blind, constant : sequence of Route
        The shortest route, and routes chosen with the weather, each at constant settings.
    """
    if not blind:
        return None
    order = np.argsort([route.time_h for route in front])
    time = np.array([front[i].time_h for i in order])
    value = np.minimum.accumulate(np.asarray(values)[order])
    counts = np.array([objective.value(route) for route in blind])
    speeds = np.asarray(context.ship.speeds) / KNOT
    at_constant = _front_of(objective, [r for r in (*constant, *blind) if r.feasible])
    rows = tuple(
        {"speed_kn": float(speeds[int(route.track.setting[0])])}
        | _savings_row(route, float(count), (time, value), at_constant)
        for route, count in zip(blind, counts)
    )
    return BaselineComparison(tuple(blind), counts, rows)


def _front_of(objective: PricedObjective, routes: list[Route]) -> tuple[FloatArray, FloatArray]:
    """Return times [h] and values of the routes that are not dominated, by ascending time."""
    time = np.array([route.time_h for route in routes])
    value = np.array([objective.value(route) for route in routes])
    order = non_dominated_indices(time, value)
    return time[order], value[order]


def _savings_row(
    blind: Route,
    count: float,
    front: tuple[FloatArray, FloatArray],
    constant: tuple[FloatArray, FloatArray],
) -> dict[str, Any]:
    """Return the savings of a front over one route; None outside the range of the front.

    ``saved`` is ``saved_by_route``, what routes at constant speeds save that know the weather
    (interpolated between speeds as the front is), and ``saved_by_speed``, what the front saves
    beyond that.
    """
    time, value = front
    no_earlier = blind.feasible and blind.time_h >= time[0] * (1.0 - 1e-6)
    no_cheaper = blind.feasible and count >= value[-1] * (1.0 - 1e-6)
    saved_h = float(blind.time_h - np.interp(-count, -value, time)) if no_cheaper else None
    parts: dict[str, float | None] = {
        name: None for name in ("saved", "saved_percent", "saved_by_route", "saved_by_speed")
    }
    if no_earlier:
        least = min(count, float(np.interp(blind.time_h, time, value)))
        best = min(max(least, float(np.interp(blind.time_h, *constant))), count)
        saved = count - least
        parts = {
            "saved": saved,
            "saved_percent": 100.0 * saved / count if count > 0 else None,
            "saved_by_route": count - best,
            "saved_by_speed": best - least,
        }
    return {
        "time_h": blind.time_h,
        "value": float(count),
        "distance_nm": blind.distance_nm,
        "feasible": blind.feasible,
        "saved_h": saved_h,
        **parts,
    }
