"""Profile plot of a route: speeds, weather and under-keel clearance against the time in UTC."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import utc_text
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.plots.map_labels import marked_times, time_label
from thalweg.route import Route
from thalweg.ship.ship_limits import ShipLimits

_INK = "#22303c"
_NEAR_LIMIT = 0.5  # share of a limit from which on it is drawn
LIMIT_COLOUR = "#b71c1c"  #: of limits, and of water with less than is required


def draw_profile(
    route: Route,
    path: str | Path | None = None,
    *,
    min_ukc: float | None = None,
    limits: ShipLimits | None = None,
) -> Any:
    """Draw speeds, weather and clearance along a route and in its waits against the time in UTC.

    Parameters
    ----------
    route : A route scored by the referee.
    path : Where to save it (PNG).
    min_ukc : Required under-keel clearance [m], which is drawn; by default zero.
    limits : Of the ship; those of wind and waves are drawn where half of them is reached.

    Returns
    -------
    matplotlib.figure.Figure : One panel each for speeds, weather and depth, as far as they are
        known; the clearance panel states if no depth is known.
    """
    route = replace(route, samples=route.samples_with_waits())
    limits = limits or ShipLimits()
    depths = partial(_depths, min_ukc=min_ukc or 0.0)
    weather = partial(_weather, limit=limits.wind_speed / KNOT)
    waves = partial(_waves, limit=limits.wave_height)
    panels = [panel for panel in (_speeds, weather, waves, depths) if panel(route, None)]
    known = bool(np.isfinite(route.samples["under_keel_clearance"]).any())
    heights = [0.25 if panel is depths and not known else 1.0 for panel in panels]
    figure = new_figure(10, 1.2 + 1.9 * sum(heights), layout=None)
    ratios = {"height_ratios": heights}
    rows = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True, gridspec_kw=ratios))
    for axes, panel in zip(rows, panels):
        panel(route, axes)
        axes.grid(alpha=0.3, lw=0.4)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(
                fontsize=7, loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=3, frameon=False
            )
        axes.tick_params(labelsize=7)
        axes.yaxis.label.set_size(8)
    _draw_time_axis(rows[-1], route)
    figure.tight_layout()
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_time_axis(axes: Any, route: Route) -> None:
    """Label the axis of hours with times in UTC."""
    hours = _hours(route)
    last = float(np.nanmax(hours, initial=0.0))
    times, step = marked_times(route.depart, route.depart + last * HOUR, 10)
    axes.set_xlim(0.0, max(last, 1e-6))
    axes.set_xticks((times - route.depart) / HOUR)
    axes.set_xticklabels([time_label(float(time), step) for time in times])
    departs = utc_text(route.depart)
    axes.set_xlabel(f"UTC, departure {departs.removesuffix(' UTC')}", fontsize=8)


def _hours(route: Route) -> np.ndarray:
    return (route.samples["time"] - route.depart) / HOUR


def _plot(
    axes: Any, route: Route, values: np.ndarray, label: str, colour: str, line: str = "-"
) -> None:
    axes.plot(_hours(route), values, label=label, color=colour, lw=1.4, ls=line)


def _speeds(route: Route, axes: Any | None) -> bool:
    if axes is None:
        return True
    _plot(axes, route, route.samples["speed_through_water"] / KNOT, "through water", "#1565c0")
    _plot(axes, route, route.samples["speed_over_ground"] / KNOT, "over ground", "#c2185b", "--")
    axes.set_ylabel("speed [kn]")
    low, high = axes.get_ylim()
    if high - low < 1.0:  # differences of hundredths of a knot are not drawn as jumps
        axes.set_ylim(0.5 * (low + high) - 0.5, 0.5 * (low + high) + 0.5)
    return True


def _set_headroom(axes: Any) -> None:
    """Let the axis begin at zero and end above the highest value."""
    top = max((float(np.nanmax(line.get_ydata(), initial=0.0)) for line in axes.lines), default=1.0)
    axes.set_ylim(0.0, 1.1 * top)


def _draw_limit(axes: Any, values: np.ndarray, limit: float, unit: str) -> None:
    """Draw a limit where values come near it."""
    if np.nanmax(values, initial=0.0) >= _NEAR_LIMIT * limit:
        axes.axhline(limit, color=LIMIT_COLOUR, lw=0.8, label=f"limit: {limit:.3g} {unit}")


def _magnitude(route: Route, east: str, north: str) -> np.ndarray | None:
    if east not in route.samples or north not in route.samples:
        return None
    speed = np.hypot(route.samples[east], route.samples[north]) / KNOT
    return speed if np.nanmax(speed, initial=0.0) > 0 else None


def _weather(route: Route, axes: Any | None, limit: float) -> bool:
    wind = _magnitude(route, "eastward_wind", "northward_wind")
    current = _magnitude(route, "eastward_sea_water_velocity", "northward_sea_water_velocity")
    if axes is not None:
        if wind is not None:
            _plot(axes, route, wind, "wind", "#6a1b9a")
            _draw_limit(axes, wind, limit, "kn")
        if current is not None:
            _plot(axes, route, current, "current", "#00838f")
        known = ((wind, "wind"), (current, "current"))
        axes.set_ylabel(" and ".join(word for value, word in known if value is not None) + " [kn]")
        _set_headroom(axes)
    return wind is not None or current is not None


def _waves(route: Route, axes: Any | None, limit: float) -> bool:
    height = route.samples.get("sea_surface_wave_significant_height")
    if height is None or not np.nanmax(height, initial=0.0) > 0:
        return False
    if axes is not None:
        _plot(axes, route, height, "significant wave height", "#2e7d32")
        _draw_limit(axes, height, limit, "m")
        axes.set_ylabel("waves [m]")
        _set_headroom(axes)
    return True


def _depths(route: Route, axes: Any | None, min_ukc: float) -> bool:
    clearance = route.samples["under_keel_clearance"]
    known = clearance[np.isfinite(clearance)]
    if axes is not None and not known.size:
        axes.text(
            0.5, 0.5, "under-keel clearance not known: no depth in the data", ha="center",
            va="center", transform=axes.transAxes, fontsize=8, color=LIMIT_COLOUR,
        )  # fmt: skip
        axes.set_yticks([])
        axes.set_ylabel("clearance")
    elif axes is not None:
        _plot(axes, route, clearance, "under-keel clearance", _INK)
        label = f"required: {min_ukc:g} m" if min_ukc else None
        axes.axhline(min_ukc, color=LIMIT_COLOUR, lw=0.8, label=label)
        if known.max() > 60:
            axes.set_yscale("symlog", linthresh=10)
        axes.set_ylabel("clearance [m]")
    return True
