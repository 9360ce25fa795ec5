"""Plots of a waiting study: savings, energy, position against time, and the trips."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure, style_panels
from thalweg.core.time import format_time
from thalweg.core.units import HOUR
from thalweg.operations.waiting.waiting_optimisation import WaitingPlan
from thalweg.operations.waiting.waiting_study import KWH, WaitingStudy

_COLOURS = ("#1b6ca8", "#c2185b", "#e08e0b", "#2e7d32", "#6a4c93", "#455a64")
_STYLES = {"current": "--", "next trip": ":", "optimum": "-"}


def draw_waiting(study: WaitingStudy, path: str | Path | None = None, *, title: str = "") -> Any:
    """Draw a waiting study.

    Parameters
    ----------
    study : WaitingStudy
    path : path, optional
        File to save the plot to (PNG).
    title : str

    Returns
    -------
    matplotlib.figure.Figure
        Four panels: change of energy against the allowed wait for each start (rule of Schless
        dashed, best for the next trip dotted, optimum solid); energy by start; position against
        time for each rule at the longest wait; and energy of one trip against its departure.
    """
    figure = new_figure(11, 7.6)
    axes = figure.subplots(2, 2)
    _draw_savings(study, axes[0, 0])
    _draw_energy(study, axes[0, 1])
    _draw_space_time_lines(study, axes[1, 0])
    _draw_trips(study, axes[1, 1])
    style_panels(axes.flat)
    hotel = f"hotel power {study.hotel_power / 1000.0:g} kW, {len(study.trips)} trips"
    figure.suptitle(f"{title} ({hotel})" if title else hotel.capitalize(), fontsize=10)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_savings(study: WaitingStudy, axes: Any) -> None:
    hours = study.max_waits / HOUR
    for i, start in enumerate(study.starts):
        colour = _COLOURS[i % len(_COLOURS)]
        for rule, style in _STYLES.items():
            label = format_time(float(start))[:16] if rule == "optimum" else None
            change = -100.0 * study.saving(rule)[i]
            axes.plot(hours, change, style, color=colour, lw=1.2, label=label)
    axes.axhline(0.0, color="0.3", lw=0.6)
    axes.set_xlabel("allowed wait before each trip [h]")
    axes.set_ylabel("change of energy [%]")
    axes.set_title("dashed: best current at departure; dotted: next trip; solid: optimum")
    axes.legend(fontsize=7, frameon=False, title="ready for the first trip", title_fontsize=7)


def _draw_energy(study: WaitingStudy, axes: Any) -> None:
    rules = tuple(study.plans)
    places = np.arange(len(study.starts), dtype=float)
    for k, rule in enumerate(rules):
        energy = study.energy(rule)[:, -1] / KWH
        at = places + (k - 0.5 * (len(rules) - 1)) * 0.2
        axes.bar(at, energy, 0.18, label=rule, color=_COLOURS[k])
    low = min(float(study.energy(rule)[:, -1].min()) for rule in rules) / KWH
    high = max(float(study.energy(rule)[:, -1].max()) for rule in rules) / KWH
    axes.set_ylim(low - 0.4 * (high - low) - 1e-3 * low, high + 0.3 * (high - low) + 1e-3 * low)
    axes.set_xticks(places, [format_time(float(s))[11:16] for s in study.starts])
    axes.set_xlabel("ready for the first trip")
    axes.set_ylabel("energy [kWh]")
    axes.set_title(f"allowed wait {study.max_waits[-1] / HOUR:.1f} h (axis does not start at 0)")
    axes.legend(fontsize=7, frameon=False, ncols=len(rules))


def _draw_space_time_lines(study: WaitingStudy, axes: Any) -> None:
    names = list(dict.fromkeys(trip.name for trip in study.trips))
    for k, rule in enumerate(study.plans):
        hours, place = _draw_space_time_line(study, study.plans[rule][0][-1], names)
        axes.plot(hours, place, color=_COLOURS[k], lw=1.1, label=rule)
    axes.set_xlabel(f"hours since {format_time(float(study.starts[0]))[:16]}")
    axes.set_ylabel("share of the route")
    axes.set_title(f"position of the ship ({' and '.join(names)}), longest wait allowed")
    axes.set_ylim(-0.05, 1.2)
    axes.legend(fontsize=7, frameon=False, ncols=4, loc="upper center")


def _draw_space_time_line(
    study: WaitingStudy, plan: WaitingPlan, names: list[str]
) -> tuple[Any, Any]:
    hours, place = [0.0], [float(_end_of_departure(study, 0, names))]
    for k, (leave, reach) in enumerate(zip(plan.departs, plan.arrives)):
        begin = _end_of_departure(study, k, names)
        hours += [(leave - plan.start) / HOUR, (reach - plan.start) / HOUR]
        place += [float(begin), float(1 - begin)]
    return np.array(hours), np.array(place)


def _end_of_departure(study: WaitingStudy, trip: int, names: list[str]) -> int:
    return names.index(study.trips[trip].name) % 2


def _draw_trips(study: WaitingStudy, axes: Any) -> None:
    shown = {trip.name: trip for trip in study.trips}
    other = axes.twinx()
    for k, (name, trip) in enumerate(shown.items()):
        hours = (trip.times - study.starts[0]) / HOUR
        taken = np.where(np.isfinite(trip.energy), trip.energy / KWH, np.nan)
        axes.plot(hours, taken, color=_COLOURS[k], lw=1.3, label=name)
        other.plot(hours, trip.current, "--", color=_COLOURS[k], lw=0.9)
    axes.set_xlabel(f"departure [hours since {format_time(float(study.starts[0]))[:16]}]")
    axes.set_ylabel("energy under way [kWh]")
    other.set_ylabel("current at departure along the course [m/s], dashed", fontsize=8)
    other.tick_params(labelsize=7)
    axes.set_title("one trip against its departure")
    axes.legend(fontsize=7, frameon=False)
