"""Plot of a Pareto front, with the bound of all routes and the shortest route."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import parse_time
from thalweg.planning.plan_front import knee
from thalweg.route.number_texts import amount_column, hours_texts

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData

_CRITERION_LABELS = {
    "fuel": "fuel",
    "energy": "energy",
    "cost": "cost",
    "co2": "CO2",
    "comfort": "squared motion sickness dose",
}
_COLOURS = ("#c2185b", "#1565c0", "#2e7d32", "#ef6c00", "#6a1b9a", "#00838f")
_INK = "#22303c"


def draw_pareto_front(plan: PlanData, path: str | Path | None = None) -> Any:
    """Draw the front of a plan that trades time for fuel, energy, cost or CO2.

    Parameters
    ----------
    plan : With a front (its objective is neither ``"time"`` nor ``"distance"``).
    path : Where to save it (PNG).

    Raises
    ------
    ValueError : If the plan has no front.
    """
    front = plan.front
    if front is None:
        raise ValueError(f"a plan with the objective {plan.voyage.objective!r} has no front")
    figure = new_figure(8.4, 5.4)
    axes = figure.add_subplot()
    _draw_bound(axes, plan)
    _draw_weather_blind(axes, plan)
    _draw_points(axes, plan)
    axes.set_xlabel("time from departure to arrival [h]")
    axes.set_ylabel(f"{_CRITERION_LABELS[front.criterion]} [{front.unit}]")
    axes.set_title(
        f"{plan.provenance['from']} to {plan.provenance['to']}: Pareto front",
        fontsize=10,
        loc="left",
    )
    axes.grid(alpha=0.3, lw=0.5)
    axes.legend(fontsize=8, framealpha=0.9)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_points(axes: Any, plan: PlanData) -> None:
    """Draw the routes, one colour per alternative, and label the ends and the knee."""
    front = plan.front
    assert front is not None  # checked by the caller
    time = np.array([route.time_h for route in plan.routes])
    order = np.argsort(time)
    axes.step(time[order], front.values[order], where="post", color=_INK, lw=0.8, alpha=0.5)
    for number, way in enumerate(dict.fromkeys(front.ways)):
        here = np.array([name == way for name in front.ways])
        colour = _COLOURS[number % len(_COLOURS)]
        axes.plot(time[here], front.values[here], "o", ms=5, color=colour, label=f"routes: {way}")
    chosen = {int(order[0]): "fastest", int(order[-1]): "least"}
    chosen.setdefault(int(order[knee(time[order], front.values[order])]), "knee")
    hours = hours_texts([time[index] for index in chosen])
    amounts, unit = amount_column([front.values[index] for index in chosen], front.unit)
    for (index, word), hour, amount in zip(chosen.items(), hours, amounts):
        text = f"{word}: {hour} h, {amount} {unit}"
        axes.annotate(
            text,
            (time[index], front.values[index]),
            xytext=(-7, -14) if time[index] > time.mean() else (7, 7),
            textcoords="offset points",
            ha="right" if time[index] > time.mean() else "left",
            fontsize=7.5,
            color=_INK,
        )


def _draw_bound(axes: Any, plan: PlanData) -> None:
    front = plan.front
    assert front is not None
    if front.certain.shape[1] < 2:
        return
    hours = [route.time_h for route in plan.routes if route.feasible] or [front.certain[0, 0]]
    first, last = max(float(front.certain[0, 0]), 0.98 * min(hours)), 1.02 * max(hours)
    times = np.linspace(min(first, last), last, 200)
    bound = np.interp(times, *front.certain)
    axes.plot(times, bound, color="#607d8b", lw=1.2, label="no route is below this line")
    axes.fill_between(times, bound, bound.min() * 0.98, color="#607d8b", alpha=0.12)


def _draw_weather_blind(axes: Any, plan: PlanData) -> None:
    comparison = plan.front.comparison if plan.front is not None else None
    if comparison is None:
        return
    last = 1.15 * max(route.time_h for route in plan.routes)
    latest = parse_time(plan.voyage.arrive_by) if plan.voyage.arrive_by is not None else math.inf
    pairs = [
        (route.time_h, value)
        for route, value in zip(comparison.routes, comparison.values)
        if route.time_h < last and route.feasible and route.arrive <= latest + 1.0
    ]
    label = "shortest route at constant speeds"
    if pairs:
        axes.plot(*np.array(pairs).T, "x--", color=_INK, ms=6, lw=0.8, label=label)
