"""The routes of a plan as lines on a map: the best on top, others by what they cost."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT
from thalweg.planning.plots.map_extent import MapExtent
from thalweg.planning.plots.route_profile import LIMIT_COLOUR
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.route.doubtful_depth import water_to_check

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData
    from thalweg.route import Route

ROUTE_COLOUR: Final = "#c2185b"
_INK: Final = "#22303c"
_WEATHER: Final = (
    "sea_surface_wave_significant_height",
    "eastward_wind",
    "northward_wind",
    "eastward_sea_water_velocity",
    "northward_sea_water_velocity",
)
_OTHER_COLOURS: Final = ("#9ccc9c", "#0b3d0b")  # from the least to the most, on blue and beige
_OTHERS, _BEST, _CHECK = 4.8, 5.2, 5.6  # order of drawing
_WAITS = 7.5  # above the marks of the ends: a ship often waits in port
BAR_HEIGHT: Final = 0.6  #: that bars of colours of a front take below a map [inch]
_ROUND_MAP: Final = 0.9 + BAR_HEIGHT  # what the figure is higher than the map, about [inch]
_BELOW_MAP, _BAR = 0.45, 0.13  # from the map to the lower edge of the bars, and their height [inch]
TO_CHECK: Final = "depth to check: less than required"  #: in the legend


def draw_routes_of_plan(
    figure: Any, axes: Any, plan: PlanData, box: MapExtent, beside: Route | None
) -> None:
    """Draw the routes of a plan, where its best one has too little water, waits and ends.

    Parameters
    ----------
    beside : A route to compare with, drawn dashed.
    """
    best = plan.best
    if beside is not None:
        line = box.line(beside.samples["lon"]), beside.samples["lat"]
        axes.plot(*line, "--", color=_INK, lw=1.3, zorder=4.5, label=_label_of_reference(plan))
    _draw_others(figure, axes, plan, box)
    if plan.front is None:
        axes.plot(
            box.line(best.samples["lon"]), best.samples["lat"], color=ROUTE_COLOUR, lw=2.2,
            zorder=_BEST, label="route, times in UTC",
        )  # fmt: skip
    else:
        _draw_speed(figure, axes, best, box, other=len(plan.routes) > 1)
    _draw_water_to_check(axes, plan, box)
    track, track_lon = best.track, longitudes_on_line(best, box)
    waits = track.wait > 0
    if waits.any():
        axes.plot(
            track_lon[waits], track.lat[waits], "s", color="#ff8f00", ms=5, zorder=_WAITS,
            label="waits",
        )  # fmt: skip
    for index in (0, -1):
        axes.plot(
            track_lon[index], track.lat[index], "o", mfc="white", mec=ROUTE_COLOUR, mew=1.6, ms=7,
            zorder=7,
        )  # fmt: skip


def _label_of_reference(plan: PlanData) -> str:
    samples = plan.best.samples
    met = [samples[name] for name in _WEATHER if name in samples]
    weather = any(np.nanmax(np.abs(values), initial=0.0) > 0.0 for values in met)
    return "route that ignores the weather" if weather else "shortest route"


def _draw_others(figure: Any, axes: Any, plan: PlanData, box: MapExtent) -> None:
    """Draw the routes that are not the best one: on a front coloured by its key figure."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    others = plan.routes[1:]
    lines = [np.column_stack([box.line(one.samples["lon"]), one.samples["lat"]]) for one in others]
    front = plan.front
    if front is None or not others:
        drawn = LineCollection(lines, colors=ROUTE_COLOUR, lw=0.8, alpha=0.5, zorder=_OTHERS)
        axes.add_collection(drawn)
        return
    colours = LinearSegmentedColormap.from_list("others", _OTHER_COLOURS)
    order = np.argsort(-front.values[1:])  # the least on top
    drawn = LineCollection([lines[k] for k in order], cmap=colours, lw=1.1, zorder=_OTHERS)
    drawn.set_array(front.values[1:][order])
    axes.add_collection(drawn)
    unit = f" [{front.unit}]" if front.unit else ""
    count = f"{len(others)} other routes" if len(others) > 1 else "the other route"
    _add_bar(figure, axes, drawn, f"{front.criterion} of {count}{unit}", (0.52, 0.42))


def _draw_speed(figure: Any, axes: Any, route: Route, box: MapExtent, *, other: bool) -> None:
    """Draw a route coloured by its speed over ground, with a white edge over other routes."""
    from matplotlib.collections import LineCollection

    points = np.column_stack([box.line(route.samples["lon"]), route.samples["lat"]])
    speed = route.samples["speed_over_ground"] / KNOT
    axes.plot(*points.T, color="white", lw=3.8, zorder=_BEST - 0.1)
    lines = LineCollection(
        list(np.stack([points[:-1], points[1:]], axis=1)), cmap="plasma", lw=2.6, zorder=_BEST
    )
    lines.set_array(0.5 * (speed[:-1] + speed[1:]))
    axes.add_collection(lines)
    place = (0.06, 0.42) if other else (0.25, 0.5)
    _add_bar(figure, axes, lines, "speed over ground of the best route [kn]", place)


def _add_bar(figure: Any, axes: Any, drawn: Any, label: str, place: tuple[float, float]) -> None:
    """Add a bar of colours below the map.

    Parameters
    ----------
    place : Left end and width, as shares of the width of the map.
    """
    height = figure.get_figheight() - _ROUND_MAP  # of the map [inch]
    below = axes.inset_axes((place[0], -_BELOW_MAP / height, place[1], _BAR / height))
    bar = figure.colorbar(drawn, cax=below, orientation="horizontal")
    bar.set_label(label, fontsize=8)
    bar.ax.tick_params(labelsize=7)


def _draw_water_to_check(axes: Any, plan: PlanData, box: MapExtent) -> None:
    """Draw where the best route has too little water, in the colour of limits in the profile."""
    from matplotlib.patheffects import withStroke

    lat, lon, check = _too_little_water(plan)
    x = box.line(lon)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], check.astype(int), [0]]))).reshape(-1, 2)
    halo = [withStroke(linewidth=4.4, foreground="white")]
    for number, (first, last) in enumerate(edges.tolist()):
        style = {"color": LIMIT_COLOUR, "label": None if number else TO_CHECK}
        axes.plot(x[first:last], lat[first:last], lw=2.6, zorder=_CHECK, path_effects=halo, **style)
        middle = (first + last - 1) // 2  # on a map of oceans the line is a point
        axes.plot(x[middle], lat[middle], "X", c=LIMIT_COLOUR, ms=6.0, mec="white", zorder=6.5)


def _too_little_water(plan: PlanData) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return positions along the best route [deg], and where it has less water than required."""
    samples, context = plan.best.samples, plan.plot_context
    lat, lon = np.asarray(samples["lat"]), np.asarray(samples["lon"])
    if context is None:
        return lat, lon, np.zeros(len(lat), bool)
    required = required_under_keel_clearance(plan.voyage, context.ship)
    clearance = np.asarray(samples["under_keel_clearance"])
    if np.isfinite(clearance).any():
        return lat, lon, clearance < required
    return water_to_check(context.chart, plan.best, context.ship, required)


def longitudes_on_line(route: Route, box: MapExtent) -> np.ndarray:
    """Return the longitudes of the waypoints on the drawn line of the route."""
    lat, lon, drawn = route.samples["lat"], route.samples["lon"], box.line(route.samples["lon"])
    places = zip(route.track.lat, route.track.lon)
    near = [int(np.argmin(np.abs(lat - y) + np.abs(wrap_longitude(lon - x)))) for y, x in places]
    return np.asarray(drawn[near] + wrap_longitude(route.track.lon - lon[near]))
