"""Plots of a track analysis: map of the activities, durations, speeds, modelled speeds."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure, style_panels
from thalweg.core.units import DAY, HOUR, KNOT
from thalweg.operations.tracks.activities import (
    AWAY,
    SAILING_EMPTY,
    SAILING_FULL,
    UNSEEN,
)
from thalweg.operations.tracks.track_analysis import TrackAnalysis
from thalweg.operations.tracks.track_calibration import agreement_statistics, leg_speeds
from thalweg.operations.tracks.work_areas import LOADING, UNLOADING, WAITING

ACTIVITY_COLOURS: Final = {
    LOADING: "#b8860b",
    SAILING_FULL: "#c2185b",
    UNLOADING: "#2e7d32",
    SAILING_EMPTY: "#1b6ca8",
    WAITING: "#6a4c93",
    AWAY: "#455a64",
    UNSEEN: "#bbbbbb",
}


def draw_tracks(analysis: TrackAnalysis, path: str | Path | None = None) -> Any:
    """Draw a track analysis.

    Parameters
    ----------
    analysis : TrackAnalysis
    path : path, optional
        File to save the plot to (PNG).

    Returns
    -------
    matplotlib.figure.Figure
        Map of the track by activity with the areas; hours of each activity; speeds of the legs in
        the order they were sailed; and modelled against measured speeds of the legs for the best
        model.
    """
    figure = new_figure(11, 8.2)
    axes = figure.subplots(2, 2)
    _draw_map(analysis, axes[0, 0])
    _draw_durations(analysis, axes[0, 1])
    _draw_speeds(analysis, axes[1, 0])
    _draw_agreement(analysis, axes[1, 1])
    style_panels(axes.flat)
    if path is not None:
        save_figure(figure, path)
    return figure


def _draw_map(analysis: TrackAnalysis, axes: Any) -> None:
    log = analysis.log
    lon = np.degrees(np.unwrap(np.radians(log.lon)))
    seen = set()
    for activity in analysis.activities:
        part = slice(activity.first, min(activity.last + 2, len(log)))
        if activity.kind == UNSEEN:
            part = slice(activity.first, activity.last + 1)
        label = None if activity.kind in seen else activity.kind
        seen.add(activity.kind)
        style = ":" if activity.kind == UNSEEN else "-"
        colour = ACTIVITY_COLOURS[activity.kind]
        axes.plot(lon[part], log.lat[part], style, color=colour, lw=0.7, label=label)
    import shapely

    for kind, shape in analysis.areas.shapes.items():
        for polygon in shapely.get_parts(shape):
            x, y = np.asarray(polygon.exterior.coords).T
            axes.plot(x, y, "--", color=ACTIVITY_COLOURS[kind], lw=1.2)
    middle = 0.5 * float(log.lat.min() + log.lat.max())
    axes.set_aspect(1.0 / max(0.05, np.cos(np.radians(middle))), adjustable="datalim")
    axes.ticklabel_format(useOffset=False)
    axes.set(xlabel="longitude [deg]", ylabel="latitude [deg]")
    name = f"ship {analysis.log.vessel}" if analysis.log.vessel else "track"
    axes.set_title(f"{name}, areas dashed")
    axes.legend(fontsize=7, frameon=False)


def _draw_durations(analysis: TrackAnalysis, axes: Any) -> None:
    start = analysis.log.time[0]
    for kind, colour in ACTIVITY_COLOURS.items():
        found = [a for a in analysis.activities if a.kind == kind and (a.whole or kind == UNSEEN)]
        if found:
            days = [(a.start - start) / DAY for a in found]
            hours = [a.duration / HOUR for a in found]
            axes.plot(days, hours, "o", ms=3, color=colour, label=f"{kind} ({len(found)})")
    axes.set(xlabel="day of the track", ylabel="duration of the activity [h]")
    axes.set_ylim(0.0, 1.3 * max(axes.get_ylim()[1], 0.1))
    axes.set_title("complete activities")
    axes.legend(fontsize=7, frameon=False, ncols=2, loc="upper left")


def _draw_speeds(analysis: TrackAnalysis, axes: Any) -> None:
    legs = analysis.leg_frame()
    start = analysis.log.time[0]
    for kind in (SAILING_FULL, SAILING_EMPTY):
        part = legs[legs.activity == kind] if len(legs) else legs
        if not len(part):
            continue
        at = part.start.to_numpy().astype("datetime64[ns]").astype(np.int64) / 1e9
        label = f"{kind}: {part.speed_kn.mean():.2f} ± {part.speed_kn.std():.2f} kn"
        days = (at - start) / DAY
        axes.plot(
            days, part.speed_kn, "o-", ms=3, lw=0.6, color=ACTIVITY_COLOURS[kind], label=label
        )
    axes.set(xlabel="day of the track", ylabel="measured speed over ground [kn]")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.2 * (high - low))
    axes.set_title("legs (free sailing)")
    axes.legend(fontsize=7, frameon=False, loc="upper left")


def _draw_agreement(analysis: TrackAnalysis, axes: Any) -> None:
    segments, models = analysis.segments, analysis.models
    order = ("calibrated", "currents", "still water")
    best = next((n for n in ("ship, calibrated", "ship", *order) if n in models), None)
    if best is None or not len(segments):
        axes.set_title("no sailing to compare")
        return
    measured = leg_speeds(segments, segments.speed) / KNOT
    modelled = leg_speeds(segments, models[best]) / KNOT
    _, kind = segments.sum_by_leg(segments.kind.astype(np.float64))
    for index, name in enumerate((SAILING_FULL, SAILING_EMPTY)):
        here = (kind > 0.0) == bool(index)
        axes.plot(
            measured[here], modelled[here], "o", ms=3.5, color=ACTIVITY_COLOURS[name], label=name
        )
    known = np.isfinite(measured + modelled)
    if known.any():
        both = np.concatenate([measured[known], modelled[known]])
        ends = np.array([both.min() - 0.2, both.max() + 0.2])
        fit = agreement_statistics(measured, modelled)
        axes.plot(ends, ends, color="0.5", lw=0.8, label="perfect")
        axes.plot(ends, fit.slope * ends + fit.intercept, "--", color="k", lw=0.9, label="fitted")
        axes.set_title(
            f"{best}: slope {fit.slope:.2f}, r2 {fit.r2:.2f}, intercept {fit.intercept:.2f} kn, "
            f"RMSE {fit.rmse_rel:.1f} %"
        )
    axes.set(xlabel="measured speed of a leg [kn]", ylabel="modelled [kn]")
    axes.legend(fontsize=7, frameon=False)
