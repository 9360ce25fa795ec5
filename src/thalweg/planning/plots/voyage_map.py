"""The map of a plan: coast, sea state as the ship passes, isochrones, routes and times."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.arrays.shown_arrows import shown_arrows
from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.geodesy import geocentric_unit_vectors, wrap_longitude
from thalweg.core.time import duration_text, utc_text
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.plots.map_extent import MapExtent
from thalweg.planning.plots.map_labels import (
    LabelPlacer,
    at_other_places,
    drawn_texts,
    marked_times,
    time_label,
)
from thalweg.planning.plots.map_overlays import (
    draw_enclosed_water,
    draw_land,
    draw_storm,
    draw_zones,
    place_labels,
    storm_track,
)
from thalweg.planning.plots.routes_on_map import (
    BAR_HEIGHT,
    ROUTE_COLOUR,
    draw_routes_of_plan,
    longitudes_on_line,
)
from thalweg.planning.plots.stage_passages import stage_arrival_times
from thalweg.route.number_texts import amount_text, miles_text

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData, PlotContext
    from thalweg.route import Route

_WAVES = "sea_surface_wave_significant_height"
_WIND = ("eastward_wind", "northward_wind")
_CURRENT = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
_DEPTH = "sea_floor_depth_below_geoid"
_LEVEL = "sea_surface_height_above_geopotential_datum"

_MOST_PLACES = 2000  # of a route, to which places of a raster are compared
_PAD = 0.08  # round the picture [inch]
_MARKER_POINTS = 20  # of a line that count as much as the mark of a time
_SEA, _INK = "#eaf3fa", "#22303c"
_WAVE_COLOURS = (_SEA, "#b9d8ec", "#6aaed6", "#2c74b3", "#3b2f8f", "#7a1f7a")


def draw_map(plan: PlanData, path: str | Path | None = None, *, beside: Route | None = None) -> Any:
    """Draw the map of a plan: the route with its times in UTC, land, weather and areas.

    Up to 75 degrees of latitude in Mercator's projection.

    Parameters
    ----------
    plan : A plan with its plot context (as `thalweg.plan` returns it).
    path : Where to save it (PNG).
    beside : A route to draw beside that of the plan, such as one that ignores the weather; by
        default that of the comparison of a front.
    """
    beside = beside or _weather_blind(plan)
    box = MapExtent.of_routes([*plan.routes, *([] if beside is None else [beside])])
    width, height = box.figure_size()
    figure = new_figure(width, height + (0.0 if plan.front is None else BAR_HEIGHT))
    axes = figure.add_subplot()
    axes.set_facecolor(_SEA)
    box.set_up(axes)
    labels: list[tuple[str, float, float]] = []
    if plan.plot_context is not None:
        _draw_sea(figure, axes, plan, plan.plot_context, box)
        draw_land(axes, plan.plot_context.chart, box)
        labels = draw_zones(axes, plan.plot_context.chart, box)
        track = storm_track(plan.plot_context)
        if track is not None and math.isfinite(plan.best.arrive):
            labels = [*draw_storm(axes, track, box, plan.best.depart, plan.best.arrive), *labels]
    draw_routes_of_plan(figure, axes, plan, box, beside)
    _decorate_axes(axes, plan, box)
    _label(figure, axes, plan, box, labels)
    if path is not None:  # the layout does not count the bars of colours below the map
        save_figure(figure, path, bbox_inches="tight", pad_inches=_PAD)
    return figure


def _weather_blind(plan: PlanData) -> Route | None:
    """Return the fastest route that ignores the weather, of the comparison of a front."""
    comparison = plan.front.comparison if plan.front is not None else None
    return comparison.routes[0] if comparison is not None and comparison.routes else None


def _draw_sea(figure: Any, axes: Any, plan: PlanData, context: PlotContext, box: MapExtent) -> None:
    lat, lon = box.grid(240, 180)
    stages = stage_arrival_times(context, lat, lon, box.unwrapped)
    moment = time_when_nearest(plan.best, lat, lon)
    on_water = _water_mask(context, moment, lat, wrap_longitude(lon))
    shown = _shading_field(context, moment, lat, lon)
    if shown is not None:
        values, label, colours = shown
        values = np.round(values, 5)  # what is above the last level by a rounding stays white
        filled = axes.contourf(lon, lat, values, levels=14, cmap=_colours(colours), zorder=1)
        bar = figure.colorbar(filled, ax=axes, shrink=0.9, pad=0.01, aspect=30)
        bar.set_label(label, fontsize=8)
        bar.ax.tick_params(labelsize=7)
    enclosed = draw_enclosed_water(axes, context, box, on_water, (lat, lon))
    on_water &= ~enclosed
    _draw_arrows(axes, context, moment, lat, lon)
    for times in stages:
        _draw_isochrones(axes, plan, times, (lat, lon), on_water)


def time_when_nearest(route: Route, lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
    """Return when a ship on a route is nearest to each place of a raster [s since 1970].

    Parameters
    ----------
    lat, lon : Raster [deg], of one shape.

    Returns
    -------
    float64 array
        Where the ship waits, when she leaves; the departure for a route without times.
    """
    from scipy.spatial import cKDTree

    samples = route.samples
    known = np.isfinite(samples["time"])
    if not known.any():
        return np.full(lat.shape, route.depart)
    line = geocentric_unit_vectors(samples["lat"][known], samples["lon"][known])
    places = geocentric_unit_vectors(lat.ravel(), wrap_longitude(lon.ravel()))
    waits = np.append(np.all(line[1:] == line[:-1], axis=1), False)
    leaves = np.append(False, waits[:-1]) & ~waits
    every = np.arange(len(line)) % max(len(line) // _MOST_PLACES, 1) == 0
    shown = np.flatnonzero(leaves | every & ~waits)
    _, nearest = cKDTree(line[shown]).query(places)
    return np.asarray(samples["time"][known][shown][nearest].reshape(lat.shape))


def _water_mask(
    context: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray:
    """Return where there is water: not land of the chart, not dry, not a hole of a mesh."""
    wet = np.asarray(context.chart.is_navigable(lat, lon), bool)
    depth = _depth(context, moment, lat, lon)
    if depth is None:
        return wet
    hole = np.isnan(depth) if context.sea.mesh() is not None else False
    return np.asarray(wet & ~hole & ~(depth <= 0.0))


def _shading_field(
    context: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> tuple[np.ndarray, str, str] | None:
    """Return the field of the sea to shade (waves, current, wind or depth), label and colours."""
    at = (moment, lat, wrap_longitude(lon))
    names = context.sea.variables
    if _WAVES in names:
        waves = context.sea.sample([_WAVES], *at)[_WAVES]
        if _varies(waves):
            return waves, "significant wave height when the ship is nearest [m]", "waves"
    for pair, word, colours in ((_CURRENT, "current", "PuBu"), (_WIND, "wind", "BuPu")):
        if all(name in names for name in pair):
            samples = context.sea.sample(list(pair), *at)
            speed = np.hypot(samples[pair[0]], samples[pair[1]]) / KNOT
            if _varies(speed):
                return speed, f"{word} speed when the ship is nearest [kn]", colours
    depth = _depth(context, *at)
    if depth is not None and _varies(depth):
        return np.maximum(depth, 0.0), "water depth when the ship is nearest [m]", "Blues"
    return None


def _depth(
    context: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray | None:
    """Return the water depth [m] of chart and sea; None if neither provides it."""
    names, depths = context.sea.variables, []
    if context.chart.has_depth:
        depths.append(np.asarray(context.chart.depths.at(lat, lon), float))
    if _DEPTH in names:
        depths.append(context.sea.sample([_DEPTH], moment, lat, lon)[_DEPTH])
    if not depths:
        return None
    depth = np.fmin.reduce(depths)
    if _LEVEL in names:
        depth = depth + context.sea.sample([_LEVEL], moment, lat, lon)[_LEVEL]
    return np.asarray(depth)


def _varies(values: np.ndarray) -> bool:
    known = values[np.isfinite(values)]
    return known.size > 10 and float(np.ptp(known)) > 1e-9


def _draw_arrows(
    axes: Any, context: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> None:
    pick = (slice(6, None, 12), slice(6, None, 12))
    lat, lon, moment = lat[pick], lon[pick], moment[pick]
    for pair in (_CURRENT, _WIND):
        if not all(name in context.sea.variables for name in pair):
            continue
        samples = context.sea.sample(list(pair), moment, lat, wrap_longitude(lon))
        east, north = samples[pair[0]], samples[pair[1]]
        shown, strongest = shown_arrows(east, north)
        if shown.any() and _varies(np.hypot(east, north)):
            # the strongest reaches to the next arrow
            axes.quiver(
                lon[shown], lat[shown], east[shown], north[shown], scale=strongest * lat.shape[1],
                color=_INK, alpha=0.45, width=0.0013,
            )  # fmt: skip
            return


def _draw_isochrones(
    axes: Any,
    plan: PlanData,
    reached: np.ndarray,
    grid: tuple[np.ndarray, np.ndarray],
    on_water: np.ndarray,
) -> None:
    lat, lon = grid
    hours = np.where(_dilated(on_water), (reached - plan.best.depart) / HOUR, np.nan)
    if np.count_nonzero(np.isfinite(hours)) < 10 or not np.isfinite(plan.best.time_h):
        return
    steps = np.array([0.05, 0.1, 0.25, 0.5, 1, 2, 3, 6, 12, 24, 48, 96])
    step = float(steps[np.argmin(np.abs(steps - plan.best.time_h / 9))])
    top = float(np.nanmax(hours))
    levels = np.arange(step, min(top, 1.6 * plan.best.time_h), step)
    levels = levels[levels > float(np.nanmin(hours))]
    if len(levels) < 2:
        return
    lines = axes.contour(lon, lat, hours, levels=levels, colors=_INK, linewidths=0.5, alpha=0.6)
    axes.clabel(lines, levels[1::2], fontsize=6, fmt=lambda value: f"{value:g} h")


def _dilated(mask: np.ndarray) -> np.ndarray:
    """Return a mask grown by one cell on all sides, so that lines end at the drawn coast."""
    from scipy.ndimage import binary_dilation

    return np.asarray(binary_dilation(mask, np.ones((3, 3), bool)))


def _label(
    figure: Any,
    axes: Any,
    plan: PlanData,
    box: MapExtent,
    labels: list[tuple[str, float, float]],
) -> None:
    """Label the ends, the times along the route, and what else there is room for."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    best, samples = plan.best, plan.best.samples
    x = box.line(samples["lon"])
    lines = [line.get_xydata() for line in axes.lines if len(line.get_xydata()) > 2]
    lines.append(np.column_stack([x, samples["lat"]]))
    times, step = _times_on_route(best)
    lon, lat = (np.interp(times, samples["time"], line) for line in (x, samples["lat"]))
    times, lon, lat = (part[at_other_places(lon, lat)] for part in (times, lon, lat))
    if len(times):
        axes.plot(lon, lat, "o", mfc="white", mec=ROUTE_COLOUR, mew=1.0, ms=3.5, zorder=6)
        lines.append(np.repeat(np.column_stack([lon, lat]), _MARKER_POINTS, axis=0))
    placer = LabelPlacer(axes, axes.transData.transform(np.concatenate(lines)))
    legend = axes.get_legend()
    placer.taken += drawn_texts(axes)
    if legend is not None:
        placer.taken.append(legend.get_window_extent())
    track_lon = longitudes_on_line(best, box)
    for index, key in ((0, "from"), (-1, "to")):
        name = str(plan.provenance.get(key) or "")
        here = float(track_lon[index]), float(best.track.lat[index])
        if name:
            placer.place(name, *here, needed=True, fontsize=8, fontweight="bold")
    for time, *place in zip(times, lon, lat):
        placer.place(time_label(float(time), step), *map(float, place), fontsize=7)
    place_labels(placer, labels)


def _times_on_route(route: Route) -> tuple[np.ndarray, float]:
    """Return the times to mark on a route, and their step [s]; none where it has no end."""
    if not math.isfinite(route.arrive):
        return np.zeros(0), HOUR
    return marked_times(route.depart, route.arrive)


def _decorate_axes(axes: Any, plan: PlanData, box: MapExtent) -> None:
    best = plan.best
    fuel = "" if best.fuel_t is None else f", {amount_text(best.fuel_t, 't')} fuel"
    departs, arrives = (utc_text(time) for time in (best.depart, best.arrive))
    axes.set_title(
        f"{plan.provenance.get('from')} to {plan.provenance.get('to')}: "
        f"{duration_text(best.arrive - best.depart)}, {miles_text(best.distance_nm)} nm{fuel}\n"
        f"depart {departs}, arrive {arrives}",
        fontsize=9,
        loc="left",
    )
    box.draw_scale(axes)
    if axes.get_legend_handles_labels()[0]:
        legend = axes.legend(loc=_corner_off_route(axes, plan, box), fontsize=7, framealpha=0.9)
        legend.set_zorder(11)


def _corner_off_route(axes: Any, plan: PlanData, box: MapExtent) -> str:
    """Return the corner of the map that is farthest from the route; the scale is at the fourth."""
    samples = plan.best.samples
    line = np.column_stack([box.line(samples["lon"]), samples["lat"]])
    places = axes.transAxes.inverted().transform(axes.transData.transform(line))
    corners = {"upper left": (0, 1), "upper right": (1, 1), "lower right": (1, 0)}
    distances = {name: np.hypot(*(places - corner).T).min() for name, corner in corners.items()}
    return max(distances, key=lambda name: float(distances[name]))


def _colours(name: str) -> Any:
    """Return a colour map, that of waves from the pale blue of a calm sea to violet."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list(name, _WAVE_COLOURS) if name == "waves" else name
