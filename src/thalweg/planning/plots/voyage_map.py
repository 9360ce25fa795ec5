"""The map of a plan: coast, sea state at the moment of passage, isochrones and routes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.file_writing import save_figure
from thalweg.core.geodesy import positions_along, wrap_longitude
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData, PlotContext
    from thalweg.route import Route

_WAVES = "sea_surface_wave_significant_height"
_WIND = ("eastward_wind", "northward_wind")
_CURRENT = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
_DEPTH = "sea_floor_depth_below_geoid"
_LEVEL = "sea_surface_height_above_geopotential_datum"

_LAND, _SHORE, _ROUTE, _INK = "#e9e3d5", "#8f8672", "#c2185b", "#22303c"


@dataclass(frozen=True)
class MapExtent:
    """The area of a map [deg]; longitudes continue beyond 180 where needed."""

    south: float
    north: float
    west: float
    east: float

    @property
    def aspect(self) -> float:
        """Length of a degree of latitude over that of a degree of longitude."""
        return 1.0 / max(0.05, math.cos(math.radians(0.5 * (self.south + self.north))))

    def unwrapped(self, lon: np.ndarray) -> np.ndarray:
        """Return longitudes shifted by multiples of 360 degrees into the area."""
        middle = 0.5 * (self.west + self.east)
        return middle + wrap_longitude(np.asarray(lon) - middle)

    def line(self, lon: np.ndarray) -> np.ndarray:
        """Return the longitudes of a line without jumps, shifted by 360 degrees into the area."""
        lon = _unwrapped(lon)
        away = 0.5 * (self.west + self.east) - 0.5 * (float(lon.min()) + float(lon.max()))
        return np.asarray(lon + 360.0 * round(away / 360.0))


def draw_map(plan: PlanData, path: str | Path | None = None) -> Any:
    """Draw the map of a plan.

    Parameters
    ----------
    plan : Plan
        A plan with its plot context (as `thalweg.plan` returns it).
    path : path, optional
        Where to save it (PNG).

    Returns
    -------
    matplotlib.figure.Figure
        The figure.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    box = _map_extent(plan)
    shape = (box.north - box.south) * box.aspect / (box.east - box.west)
    width = min(10.0, 9.0 / shape + 1.6)
    height = max(3.6, (width - 1.6) * shape + 0.8)
    figure = Figure(figsize=(width, height), dpi=130, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_facecolor("#f4f8fb")
    if plan.plot_context is not None:
        _draw_sea(figure, axes, plan, plan.plot_context, box)
        _draw_land(axes, plan.plot_context.chart, box)
    _draw_routes(figure, axes, plan, box)
    _decorate_axes(axes, plan, box)
    if path is not None:
        save_figure(figure, path)
    return figure


def _unwrapped(lon: np.ndarray) -> np.ndarray:
    return np.degrees(np.unwrap(np.radians(np.asarray(lon, float))))


def _map_extent(plan: PlanData) -> MapExtent:
    lat = np.concatenate([route.samples["lat"] for route in plan.routes])
    lon = np.concatenate([_unwrapped(route.samples["lon"]) for route in plan.routes])
    high, wide = np.ptp(lat), np.ptp(lon) * math.cos(math.radians(float(np.mean(lat))))
    margin = 0.12 * max(high, wide, 1e-3)
    stretch = math.cos(math.radians(min(80.0, float(np.max(np.abs(lat))))))
    grow = max(0.0, 0.42 * max(wide, high) - high) / 2
    widen = max(0.0, 0.6 * high - wide) / 2
    aside = min((margin + widen) / stretch, max(0.0, 0.5 * (359.0 - float(np.ptp(lon)))))
    return MapExtent(
        max(-89.9, float(lat.min()) - margin - grow),
        min(89.9, float(lat.max()) + margin + grow),
        float(lon.min()) - aside,
        float(lon.max()) + aside,
    )


def _draw_sea(figure: Any, axes: Any, plan: PlanData, world: PlotContext, box: MapExtent) -> None:
    lon, lat = np.meshgrid(
        np.linspace(box.west, box.east, 240), np.linspace(box.south, box.north, 180)
    )
    reached = _passage_times(plan, world, box, lat, lon)
    moment = np.where(np.isfinite(reached), reached, plan.best.depart)
    on_water = _water_mask(world, moment, lat, wrap_longitude(lon))
    shown = _shading_field(world, moment, lat, lon)
    if shown is not None:
        values, label, colours = shown
        filled = axes.contourf(lon, lat, values, levels=14, cmap=colours, alpha=0.85)
        bar = figure.colorbar(filled, ax=axes, shrink=0.9, pad=0.01, aspect=30)
        bar.set_label(label, fontsize=8)
        bar.ax.tick_params(labelsize=7)
    _draw_arrows(axes, world, moment, lat, lon)
    _draw_isochrones(axes, plan, reached, (lat, lon), on_water)


def _water_mask(
    world: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray:
    """Return where there is water: not land of the chart, not dry, not a hole of a mesh."""
    wet = np.asarray(world.chart.is_navigable(lat, lon), bool)
    depth = _depth(world, moment, lat, lon)
    if depth is None:
        return wet
    hole = np.isnan(depth) if world.sea.mesh() is not None else False
    return np.asarray(wet & ~hole & ~(depth <= 0.0))


def _passage_times(
    plan: PlanData, world: PlotContext, box: MapExtent, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray:
    """Return the earliest arrival at each point; NaN where not reached."""
    from scipy.interpolate import LinearNDInterpolator

    node_lon = box.unwrapped(world.lon)
    use = np.isfinite(world.arrival)
    use &= (world.lat > box.south - 2) & (world.lat < box.north + 2)
    use &= (node_lon > box.west - 4) & (node_lon < box.east + 4)
    index = np.flatnonzero(use)
    if len(index) < 4 or np.ptp(world.lat[index]) == 0 or np.ptp(node_lon[index]) == 0:
        return np.full(lat.shape, np.nan)
    index = index[:: max(1, len(index) // 30_000)]
    points = np.column_stack([node_lon[index], world.lat[index]])
    return np.asarray(LinearNDInterpolator(points, world.arrival[index])(lon, lat))


def _shading_field(
    world: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> tuple[np.ndarray, str, str] | None:
    """Return the field of the sea to shade (waves, current, wind or depth), label and colours."""
    at = (moment, lat, wrap_longitude(lon))
    names = world.sea.variables
    if _WAVES in names:
        waves = world.sea.sample([_WAVES], *at)[_WAVES]
        if _varies(waves):
            return waves, "significant wave height at passage [m]", "YlGnBu"
    for pair, word, colours in ((_CURRENT, "current", "PuBu"), (_WIND, "wind", "BuPu")):
        if all(name in names for name in pair):
            samples = world.sea.sample(list(pair), *at)
            speed = np.hypot(samples[pair[0]], samples[pair[1]]) / KNOT
            if _varies(speed):
                return speed, f"{word} speed at passage [kn]", colours
    depth = _depth(world, *at)
    if depth is not None and _varies(depth):
        return np.maximum(depth, 0.0), "water depth at passage [m]", "Blues"
    return None


def _depth(
    world: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> np.ndarray | None:
    """Return the water depth [m] of chart and sea; None if neither provides it."""
    names, depths = world.sea.variables, []
    if world.chart.has_depth:
        depths.append(np.asarray(world.chart.depths.at(lat, lon), float))
    if _DEPTH in names:
        depths.append(world.sea.sample([_DEPTH], moment, lat, lon)[_DEPTH])
    if not depths:
        return None
    depth = np.fmin.reduce(depths)
    if _LEVEL in names:
        depth = depth + world.sea.sample([_LEVEL], moment, lat, lon)[_LEVEL]
    return np.asarray(depth)


def _varies(values: np.ndarray) -> bool:
    known = values[np.isfinite(values)]
    return known.size > 10 and float(np.ptp(known)) > 1e-9


def _draw_arrows(
    axes: Any, world: PlotContext, moment: np.ndarray, lat: np.ndarray, lon: np.ndarray
) -> None:
    pick = (slice(6, None, 12), slice(6, None, 12))
    lat, lon, moment = lat[pick], lon[pick], moment[pick]
    for pair in (_CURRENT, _WIND):
        if not all(name in world.sea.variables for name in pair):
            continue
        samples = world.sea.sample(list(pair), moment, lat, wrap_longitude(lon))
        east, north = samples[pair[0]], samples[pair[1]]
        if _varies(np.hypot(east, north)):
            axes.quiver(lon, lat, east, north, color=_INK, alpha=0.45, width=0.0013)
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
    if np.count_nonzero(np.isfinite(hours)) < 10:
        return
    steps = np.array([0.05, 0.1, 0.25, 0.5, 1, 2, 3, 6, 12, 24, 48, 96])
    step = float(steps[np.argmin(np.abs(steps - plan.best.time_h / 9))])
    top = float(np.nanmax(hours))
    levels = np.arange(step, min(top, 1.6 * plan.best.time_h), step)
    if len(levels) < 2:
        return
    lines = axes.contour(lon, lat, hours, levels=levels, colors=_INK, linewidths=0.5, alpha=0.6)
    axes.clabel(lines, levels[1::2], fontsize=6, fmt=lambda value: f"{value:g} h")


def _dilated(mask: np.ndarray) -> np.ndarray:
    """Return a mask grown by one cell on all sides, so that lines end at the drawn coast."""
    from scipy.ndimage import binary_dilation

    return np.asarray(binary_dilation(mask, np.ones((3, 3), bool)))


def _draw_land(axes: Any, chart: Any, box: MapExtent) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    for polygon in chart.coastline.polygons(box.south, box.north, box.west, box.east):
        rings = [np.asarray(ring.coords) for ring in (polygon.exterior, *polygon.interiors)]
        outline = Outline.make_compound_path(*(Outline(ring, closed=True) for ring in rings))
        axes.add_patch(PathPatch(outline, fc=_LAND, ec=_SHORE, lw=0.4, zorder=3))


def _draw_speed(figure: Any, axes: Any, route: Route, box: MapExtent) -> None:
    """Draw a route coloured by its speed over ground."""
    from matplotlib.collections import LineCollection

    points = np.column_stack([box.line(route.samples["lon"]), route.samples["lat"]])
    speed = route.samples["speed_over_ground"] / KNOT
    lines = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)), cmap="plasma", lw=3.0, zorder=5
    )
    lines.set_array(0.5 * (speed[:-1] + speed[1:]))
    axes.add_collection(lines)
    bar = figure.colorbar(lines, ax=axes, shrink=0.5, pad=0.01, aspect=25, location="bottom")
    bar.set_label("speed over ground [kn]", fontsize=8)
    bar.ax.tick_params(labelsize=7)


def _draw_routes(figure: Any, axes: Any, plan: PlanData, box: MapExtent) -> None:
    from matplotlib.patheffects import withStroke

    best = plan.best
    fractions = np.linspace(0, 1, 101)
    direct_lat, direct_lon = positions_along(
        best.track.lat[0], best.track.lon[0], best.track.lat[-1], best.track.lon[-1], fractions
    )
    axes.plot(
        box.line(direct_lon), direct_lat, "--", color=_INK, lw=0.9, zorder=4, label="geodesic"
    )
    for route in plan.routes[1:]:
        axes.plot(
            box.line(route.samples["lon"]), route.samples["lat"], color=_ROUTE, lw=0.8, alpha=0.5,
            zorder=5,
        )  # fmt: skip
    if plan.front is None:
        axes.plot(
            box.line(best.samples["lon"]), best.samples["lat"], color=_ROUTE, lw=2.2, zorder=5,
            label="route",
        )  # fmt: skip
    else:
        _draw_speed(figure, axes, best, box)
    track, track_lon = best.track, _longitudes_on_line(best, box)
    axes.plot(track_lon, track.lat, ".", color=_ROUTE, ms=4, zorder=6)
    waits = track.wait > 0
    if waits.any():
        axes.plot(
            track_lon[waits],
            track.lat[waits],
            "s",
            color="#ff8f00",
            ms=6,
            zorder=7,
            label="waits",
        )
    for index, name in ((0, plan.provenance.get("from")), (-1, plan.provenance.get("to"))):
        x, y = track_lon[index], track.lat[index]
        axes.plot(x, y, "o", mfc="white", mec=_ROUTE, mew=1.6, ms=7, zorder=7)
        axes.annotate(
            str(name or ""),
            (x, y),
            xytext=(0, 9),
            textcoords="offset points",
            fontsize=8,
            ha="center",
            zorder=8,
            color=_INK,
            fontweight="bold",
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )


def _longitudes_on_line(route: Route, box: MapExtent) -> np.ndarray:
    """Return the longitudes of the waypoints on the drawn line of the route."""
    lat, lon, drawn = route.samples["lat"], route.samples["lon"], box.line(route.samples["lon"])
    places = zip(route.track.lat, route.track.lon)
    near = [int(np.argmin(np.abs(lat - y) + np.abs(wrap_longitude(lon - x)))) for y, x in places]
    return np.asarray(drawn[near] + wrap_longitude(route.track.lon - lon[near]))


def _decorate_axes(axes: Any, plan: PlanData, box: MapExtent) -> None:
    best = plan.best
    fuel = "" if best.fuel_t is None else f", {best.fuel_t:.1f} t fuel"
    certain = 100 * (1 - plan.proof.certain / plan.objective_value) if plan.objective_value else 0.0
    axes.set_title(
        f"{best.time_h:.1f} h, {best.distance_nm:.0f} nm{fuel}; depart "
        f"{format_time(best.depart)}; gap to the bound {100 * plan.gap:.1f} % (certain: "
        f"{certain:.1f} %)",
        fontsize=9,
        loc="left",
    )
    axes.set_xlim(box.west, box.east)
    axes.set_ylim(box.south, box.north)
    axes.set_aspect(box.aspect)
    axes.xaxis.set_major_formatter(lambda x, _: _degree_label(float(wrap_longitude(x)), "EW"))
    axes.yaxis.set_major_formatter(lambda y, _: _degree_label(y, "NS"))
    axes.tick_params(labelsize=7)
    axes.grid(alpha=0.25, lw=0.4)
    axes.legend(loc="lower right", fontsize=7, framealpha=0.9)


def _degree_label(value: float, letters: str) -> str:
    if not 1e-9 < abs(value) < 180.0 - 1e-9:
        return f"{abs(round(value)):d}°"
    return f"{abs(value):g}°{letters[0] if value >= 0 else letters[1]}"
