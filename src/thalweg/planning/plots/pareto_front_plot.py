"""Plot of a Pareto front, with the bound of all routes and the shortest route."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import parse_time
from thalweg.planning.plan_front import certain_at, words_of_points
from thalweg.planning.plots.map_labels import LabelPlacer, drawn_texts
from thalweg.route.number_texts import amount_column, amount_text, hours_texts

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
_INK, _BOUND = "#22303c", "#607d8b"
_MARGIN: Final = 0.08  # of the axes beside the routes, as a share of their range
_BELOW: Final = 0.3  # ... and below them, where the bound may show
_ROOM: Final = 12.0  # between the legend and marks [display units]
_LEAST_RANGE: Final = 0.02  # of a value: smaller differences are not drawn as large ones


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
    blind = _draw_weather_blind(axes, plan)
    _draw_points(axes, plan)
    _set_limits(axes, plan, blind)
    _draw_bound(axes, plan)
    for axis in (axes.xaxis, axes.yaxis):  # whole numbers, without a factor beside the axis
        axis.set_major_formatter(lambda value, _: f"{value:,.12g}")
    axes.set_xlabel("time from departure to arrival [h]")
    unit = f" [{front.unit}]" if front.unit else ""
    axes.set_ylabel(_CRITERION_LABELS.get(front.criterion, front.criterion) + unit)
    axes.set_title(
        f"{plan.provenance['from']} to {plan.provenance['to']}: Pareto front",
        fontsize=10,
        loc="left",
    )
    axes.grid(alpha=0.3, lw=0.5)
    legend = axes.legend(fontsize=8, framealpha=0.9, loc="upper right")
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    _clear_legend(axes, legend)
    _label(axes, plan, legend)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_points(axes: Any, plan: PlanData) -> None:
    """Draw the routes, one colour per alternative."""
    front = plan.front
    assert front is not None  # checked by the caller
    time = np.array([route.time_h for route in plan.routes])
    order = np.argsort(time)
    axes.step(time[order], front.values[order], where="post", color=_INK, lw=0.8, alpha=0.5)
    for number, way in enumerate(dict.fromkeys(front.ways)):
        here = np.array([name == way for name in front.ways])
        colour = _COLOURS[number % len(_COLOURS)]
        axes.plot(time[here], front.values[here], "o", ms=5, color=colour, label=f"routes: {way}")


def _set_limits(axes: Any, plan: PlanData, blind: list[tuple[float, float]]) -> None:
    """Let the axes show the routes; a bound far below them is cut off."""
    front = plan.front
    assert front is not None
    points = [(route.time_h, value) for route, value in zip(plan.routes, front.values)] + blind
    known = [point for point in points if np.isfinite(point).all()]
    if not known:
        return
    time, value = np.array(known).T
    wide, high = (
        max(float(np.ptp(x)), _LEAST_RANGE * float(np.abs(x).max())) or 1.0 for x in (time, value)
    )
    bounds = [certain_at(front.certain, float(t)) for t in time]
    least = min([float(value.min()), *(bound for bound in bounds if math.isfinite(bound))])
    low = max(least - _MARGIN * high, float(value.min()) - _BELOW * high)
    axes.set_xlim(float(time.min()) - _MARGIN * wide, float(time.max()) + _MARGIN * wide)
    axes.set_ylim(low, float(value.max()) + 1.5 * _MARGIN * high)


def _clear_legend(axes: Any, legend: Any) -> None:
    """Raise the upper end of the axes until no mark lies under the legend."""
    box = legend.get_window_extent().padded(_ROOM)
    marks = [line.get_xydata() for line in axes.lines if line.get_marker() not in ("", "None")]
    x, y = axes.transData.transform(np.concatenate(marks)).T
    covered = y[(x > box.x0) & (x < box.x1) & (y > box.y0)]
    if covered.size:
        bottom, (low, high) = axes.get_window_extent().y0, axes.get_ylim()
        axes.set_ylim(low, low + (high - low) * (covered.max() - bottom) / (box.y0 - bottom))


def _label(axes: Any, plan: PlanData, legend: Any) -> None:
    """Label the ends and the knee, where they cover neither routes nor each other."""
    front = plan.front
    assert front is not None  # checked by the caller
    time = np.array([route.time_h for route in plan.routes])
    lines = [line.get_xydata() for line in axes.lines]
    placer = LabelPlacer(axes, axes.transData.transform(_close_points(axes, lines)))
    placer.taken += [legend.get_window_extent(), *drawn_texts(axes)]
    chosen = words_of_points(front, time)
    hours = hours_texts([time[index] for index in chosen])
    amounts, unit = amount_column([front.values[index] for index in chosen], front.unit)
    for (index, word), hour, amount in zip(chosen.items(), hours, amounts):
        text = f"{word}: {hour} h, {amount} {unit}"
        place = float(time[index]), float(front.values[index])
        placer.place(text, *place, needed=True, fontsize=7.5)


def _close_points(axes: Any, lines: list[Any]) -> np.ndarray:
    """Return points along lines, as close together as labels need them."""
    found = []
    size = np.array([np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())])
    for line in lines:
        steps = np.hypot(*(np.diff(line, axis=0) / size).T)
        number = np.concatenate([[0.0], np.cumsum(np.ceil(100.0 * steps) + 1.0)])
        close = np.arange(number[-1] + 1.0)
        found.append(np.column_stack([np.interp(close, number, line[:, k]) for k in (0, 1)]))
    return np.concatenate(found)


def _draw_bound(axes: Any, plan: PlanData) -> None:
    """Draw the bound of all routes; where it is cut off, an arrow with its value."""
    front = plan.front
    assert front is not None
    if front.certain.shape[1] < 2 or not any(math.isfinite(one.time_h) for one in plan.routes):
        return
    (west, east), (low, high) = axes.get_xlim(), axes.get_ylim()
    first = float(front.certain[0, 0])
    times = np.linspace(max(first, west), east, 200)
    bound = np.interp(times, *front.certain)
    axes.plot(
        times, bound, color=_BOUND, lw=1.2, label="no route at these speeds can be below this line"
    )
    axes.fill_between(times, bound, min(low, float(bound.min())), color=_BOUND, alpha=0.12)
    axes.set_ylim(low, high)
    axes.set_xlim(west, east)
    if first < west:
        fastest = min(route.time_h for route in plan.routes if math.isfinite(route.time_h))
        text = (
            f"no route can be faster than {first:.1f} h:\n"
            f"at most {_percent(first, fastest)} less than the fastest found"
        )
        _point_outside(axes, text, (west, low + 0.25 * (high - low)))
    known = [(one.time_h, float(value)) for one, value in zip(plan.routes, front.values)]
    hidden = [(t, v) for t, v in known if certain_at(front.certain, t) < low]
    if hidden:
        time, value = max(hidden)
        least = certain_at(front.certain, time)
        text = (
            f"no route of {time:.1f} h can be below {amount_text(least, front.unit)}:\n"
            f"at most {_percent(least, value)} less than the one found"
        )
        _point_outside(axes, text, (time, low))


def _percent(bound: float, value: float) -> str:
    """Return by what share a bound is below a value."""
    return f"{100.0 * (value - bound) / value:.1f} %"


def _point_outside(axes: Any, text: str, place: tuple[float, float]) -> None:
    """Draw words with an arrow to the edge of the axes, where a bound is cut off."""
    west, east = axes.get_xlim()
    right, left = place[0] > 0.5 * (west + east), place[0] == west
    axes.annotate(
        text, place, xytext=(22, 0) if left else (0, 22), textcoords="offset points",
        fontsize=7.5, color=_BOUND, ha="right" if right else "left",
        va="center" if left else "bottom",
        arrowprops={
            "arrowstyle": "->", "color": _BOUND, "lw": 1.2, "shrinkA": 1, "shrinkB": 0,
            "relpos": (0.0, 0.5) if left else (float(right), 0.0),
        },
    )  # fmt: skip


def _draw_weather_blind(axes: Any, plan: PlanData) -> list[tuple[float, float]]:
    """Draw the shortest route at constant speeds; return its times [h] and values."""
    comparison = plan.front.comparison if plan.front is not None else None
    if comparison is None:
        return []
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
    return pairs
