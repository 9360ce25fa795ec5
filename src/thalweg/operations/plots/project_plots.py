"""Plots of a dredging project: production over time, tides and waits, loads, and routes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import format_time
from thalweg.core.units import DAY, HOUR
from thalweg.operations.dredging.project_timeline import activity_periods, site_water_level

if TYPE_CHECKING:
    from thalweg.operations.dredging.project_result import ProjectResult, ProjectRun

_COLOURS = {"optimised": "#0b6e99", "base case": "#b5651d"}
_ACTIVITIES = {
    "loading": "#7a9e3f",
    "sailing full": "#0b6e99",
    "waiting": "#d1495b",
    "unloading": "#c9a227",
    "sailing empty": "#8fc1d4",
}
_UNKNOWN = "#d9d4c8"  # land, and where no depth is known
_FIRST_DAYS = 4.0  # shown hour by hour
_SMALLEST_LABELLED = 2.0  # share of the time that has its number beside it [%]
_MAX_LINES = 600  # cycles drawn of each run


def draw_project(result: ProjectResult, path: str | Path | None = None) -> Any:
    """Draw volume over time, the first days with the tide, the loads and the shares of time.

    Parameters
    ----------
    result : ProjectResult
    path : path, optional
        File to save the plot to (PNG).

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(11, 8.5, dpi=120)
    grid = figure.add_gridspec(3, 2, height_ratios=(1.1, 1.0, 0.9))
    _draw_volume(result, figure.add_subplot(grid[0, :]))
    _draw_first_days(result, figure.add_subplot(grid[1, :]))
    _draw_load_factors(result, figure.add_subplot(grid[2, 0]))
    _draw_time_shares(result, figure.add_subplot(grid[2, 1]))
    figure.suptitle(result.project.name, fontsize=11, parse_math=False)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_volume(result: ProjectResult, axes: Any) -> None:
    start = result.project.start
    for run in result.runs:
        moment = [0.0] + [(c.back.depart - start) / DAY for c in run.cycles]
        moved = np.cumsum([0.0] + [c.volume for c in run.cycles]) / 1000.0
        days = run.totals["duration_days"]
        axes.step(
            moment, moved, where="post", color=_COLOURS.get(run.name), lw=1.5,
            label=f"{run.name}: {days:.1f} days",
        )  # fmt: skip
    axes.axhline(result.project.work.volume / 1000.0, color="0.6", lw=0.7, ls=":")
    axes.set(xlabel="days since the start", ylabel="volume moved [1000 m3]", xlim=(0, None))
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    axes.grid(alpha=0.3, lw=0.4)


def _draw_first_days(result: ProjectResult, axes: Any) -> None:
    """Draw the activities of the first days, with the water level."""
    start = result.project.start
    end = min(start + _FIRST_DAYS * DAY, max(run.cycles[-1].end for run in result.runs))
    for row, run in enumerate(result.runs):
        for activity, spans in activity_periods(run).items():
            bars = [((a - start) / HOUR, (b - a) / HOUR) for a, b in spans if a < end]
            axes.broken_barh(bars, (row - 0.35, 0.7), color=_ACTIVITIES[activity], lw=0)
    hours = np.arange(0.0, (end - start) / HOUR, 1.0 / 6.0)
    level = site_water_level(result, start + hours * HOUR)
    axes.set_yticks(range(len(result.runs)), [run.name for run in result.runs])
    axes.set(xlim=(0.0, (end - start) / HOUR), ylim=(-0.6, len(result.runs) - 0.4))
    axes.set_xlabel(f"hours since {format_time(start)}")
    if np.isfinite(level).any():
        above = axes.twinx()
        above.plot(hours, level, color="#22303c", lw=1.0, alpha=0.8)
        above.set_ylabel("level at the unloading site [m]", fontsize=8)
    handles = [_legend_patch(colour, name) for name, colour in _ACTIVITIES.items()]
    axes.legend(handles=handles, fontsize=7, ncols=5, frameon=False, loc="lower left",
                bbox_to_anchor=(0.0, 1.0))  # fmt: skip


def _legend_patch(colour: str, label: str) -> Any:
    from matplotlib.patches import Patch

    return Patch(color=colour, label=label)


def _draw_load_factors(result: ProjectResult, axes: Any) -> None:
    """Draw the cycles of each load factor as bars centred on it, those of later runs narrower."""
    factors = np.array(result.project.work.load_factors)
    width = min(0.08, 0.4 * float(np.diff(factors).min())) if len(factors) > 1 else 0.04
    for number, run in enumerate(result.runs):
        values, counts = np.unique([c.load_factor for c in run.cycles], return_counts=True)
        wide = width * (1.0 - number / len(result.runs))
        axes.bar(values, counts, width=wide, color=_COLOURS.get(run.name), label=run.name)
    axes.set(xlabel="load factor", ylabel="cycles", xlim=(-0.1, 1.1))
    axes.legend(fontsize=8, frameon=False)


def _draw_time_shares(result: ProjectResult, axes: Any) -> None:
    """Draw the share of each activity as one bar for each run, waits apart from sailing."""
    rows = np.arange(len(result.runs))
    left = np.zeros(len(rows))
    shares = [time_shares(run) for run in result.runs]
    for name, colour in _ACTIVITIES.items():
        share = np.array([100.0 * one[name] for one in shares])
        axes.barh(rows, share, left=left, color=colour, label=name)
        for row, (a, b) in enumerate(zip(left, share)):
            if b >= _SMALLEST_LABELLED:
                axes.text(a + 0.5 * b, row, f"{b:.0f}", ha="center", va="center", fontsize=8)
        left = left + share
    axes.set_yticks(rows, [run.name for run in result.runs])
    axes.set(xlabel="share of the time [%]", xlim=(0, 100))


def time_shares(run: ProjectRun) -> dict[str, float]:
    """Return the share of the time (0 to 1) of each activity; sailing is without its waits."""
    totals = run.totals
    duration = run.cycles[-1].end - run.cycles[0].start
    waits = {
        "sailing full": sum(cycle.out.waiting for cycle in run.cycles) / duration,
        "sailing empty": sum(cycle.back.waiting for cycle in run.cycles) / duration,
    }
    shares = {name: float(totals[f"{name.replace(' ', '_')}_share"] or 0.0) for name in _ACTIVITIES}
    return {name: share - waits.get(name, 0.0) for name, share in shares.items()}


def draw_routes(
    result: ProjectResult, path: str | Path | None = None, *, colour: str = "time"
) -> Any:
    """Draw all routes over the depth of the water, coloured by time or by load.

    Parameters
    ----------
    result : ProjectResult
    path : path, optional
        File to save the plot to (PNG).
    colour : {"time", "load"}
        Days since the start, or the load factor.

    Returns
    -------
    matplotlib.figure.Figure
    """
    count = len(result.runs)
    figure = new_figure(1.0 + 6.5 * count, 6.0, dpi=120)
    frames = np.atleast_1d(figure.subplots(1, count, sharex=True, sharey=True))
    last = max(run.totals["duration_days"] or 0.0 for run in result.runs)
    bundle = None
    for axes, run in zip(frames, result.runs):
        bundle = _draw_route_bundle(run, axes, colour, float(last))
        axes.set_title(run.name, fontsize=10)
        axes.set_aspect(1.0 / np.cos(np.radians(result.project.sites.load[0])))
    for axes in frames:
        depth = _draw_depth(result, axes)
        for what, place in (("load", result.project.sites.load),
                            ("unload", result.project.sites.unload)):  # fmt: skip
            axes.plot(place[1], place[0], "o", ms=6, mfc="w", mec="k", zorder=5)
            axes.annotate(what, (place[1], place[0]), xytext=(5, 5), textcoords="offset points",
                          fontsize=8, zorder=5)  # fmt: skip
        axes.set(xlabel="longitude [deg]", ylabel="latitude [deg]")
    if depth is not None:
        figure.colorbar(depth, ax=list(frames), label="depth below datum [m]", shrink=0.7, pad=0.01)
    if bundle is not None:
        label = "days since the start" if colour == "time" else "load factor"
        figure.colorbar(bundle, ax=list(frames), label=label, shrink=0.7)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_route_bundle(run: ProjectRun, axes: Any, colour: str, last: float) -> Any:
    from matplotlib.collections import LineCollection

    lines, values = [], []
    start = run.cycles[0].start
    for cycle in run.cycles[:_MAX_LINES]:
        for leg, load in ((cycle.out, cycle.load_factor), (cycle.back, 0.0)):
            track = leg.route.track
            lines.append(np.column_stack([track.lon, track.lat]))
            values.append((leg.depart - start) / DAY if colour == "time" else load)
    limit = last if colour == "time" else 1.0
    bundle = LineCollection(lines, array=np.array(values), cmap="rainbow", lw=0.9, alpha=0.75)
    bundle.set_clim(0.0, limit)
    axes.add_collection(bundle)
    axes.autoscale_view()
    axes.margins(0.12)
    return bundle


def _draw_depth(result: ProjectResult, axes: Any) -> Any:
    """Draw the depth of chart or sea behind the routes; blank where ships may not sail."""
    from thalweg.sea import standard_names as nm

    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    lon, lat = np.meshgrid(np.linspace(west, east, 160), np.linspace(south, north, 160))
    chart, sea = result.environment.chart, result.environment.sea
    depth = np.full(lat.shape, np.nan)
    if chart.has_depth:
        depth = np.asarray(chart.depths.at(lat, lon), float)
    if nm.BED_DEPTH in sea.variables:
        time = np.full(lat.shape, result.project.start)
        depth = np.fmin(depth, sea.sample([nm.BED_DEPTH], time, lat, lon)[nm.BED_DEPTH])
    depth = np.where(chart.is_navigable(lat, lon), depth, np.nan)
    if not np.isfinite(depth).any():
        return None
    axes.set_facecolor(_UNKNOWN)
    shown = np.where(np.isfinite(depth), np.clip(depth, -2.0, 20.0), np.nan)
    filled = axes.contourf(lon, lat, shown, levels=np.arange(-2.0, 20.5, 1.0), cmap="Blues",
                           alpha=0.75, zorder=0)  # fmt: skip
    axes.contour(lon, lat, shown, levels=[0.0], colors="#8f8672", linewidths=0.8, zorder=1)
    axes.set_xlim(west, east)
    axes.set_ylim(south, north)
    return filled
