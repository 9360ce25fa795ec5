"""Files of a plan or a route in a folder."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.file_writing import make_folder, write_csv_rows, write_text
from thalweg.core.time import TimeLike
from thalweg.planning.plots.route_profile import draw_profile
from thalweg.planning.plots.space_time_diagram import write_space_time_diagram
from thalweg.planning.plots.voyage_map import draw_map
from thalweg.planning.report.squat_report import keeps_limits_at_rest
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.route import (
    Route,
    RouteFileOptions,
    Track,
    evaluate,
    write_route_files,
)
from thalweg.route.formats.file_route import file_track
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.sea_maps import draw_maps, map_area
from thalweg.sea.standard_names import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT

#: Share of the thinning and decimals of positions, tried in turn while a file breaks a limit.
_FINER_FILES = ((1.0, 6), (1.0, 8), (0.1, 8), (0.0, 8))
#: By how much a wait of whole seconds is longer, tried in turn while a file breaks a limit [s].
_LATER = (0.0, 1.0, 5.0)
_NEAR_LIMIT = 0.98  # of a limit of waves or wind, from where rounded numbers may exceed it
_WIND = (EASTWARD_WIND, NORTHWARD_WIND)

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData
    from thalweg.sea import Sea
    from thalweg.sea.layer import Layer
    from thalweg.ship import Ship
    from thalweg.ship.ship_limits import ShipLimits


def write_plan(
    plan: PlanData,
    folder: str | Path,
    options: RouteFileOptions | None = None,
    *,
    beside: Route | None = None,
) -> list[Path]:
    """Write plan.json, the best route in all formats, the plots, and the files of a front.

    Parameters
    ----------
    options : How the route files are written; places and chart are those of the plan.
    beside : A route to draw on the map beside that of the plan.

    Returns
    -------
    list of Path : The files written.
    """
    folder = make_folder(folder)
    options = _of_plan(plan, options or RouteFileOptions())
    plan.to_json(folder / "plan.json")
    route, own = keeping_limits(plan, plan.best, options)
    files = [folder / "plan.json", *write_route_files(route, folder, options=own)]
    draw_map(plan, folder / "map.png", beside=beside)
    limits = None if plan.plot_context is None else plan.plot_context.ship.limits
    profile = folder / "profile.png"
    draw_profile(plan.best, profile, min_ukc=_required_clearance(plan), limits=limits)
    files += [folder / "map.png", profile, *write_space_time_diagram(plan, folder)]
    return files if plan.front is None else files + _write_front(plan, folder, options)


def _required_clearance(plan: PlanData) -> float | None:
    """Return the required under-keel clearance of a plan [m]: of the voyage, else of the ship."""
    if plan.plot_context is None:
        return plan.voyage.min_ukc_m
    return required_under_keel_clearance(plan.voyage, plan.plot_context.ship)


def _of_plan(plan: PlanData, options: RouteFileOptions) -> RouteFileOptions:
    """Return the options with the places and the chart of a plan."""
    start, goal = (str(plan.provenance.get(key) or "") for key in ("from", "to"))
    chart = plan.plot_context.chart if plan.plot_context is not None else None
    return replace(options, chart=chart, start=start, goal=goal)


def keeping_limits(
    plan: PlanData, route: Route, options: RouteFileOptions
) -> tuple[Route, RouteFileOptions]:
    """Return what to write so that route files keep the limits of depth and weather of a plan.

    Few waypoints of six decimals may leave a narrow gully by metres, and a rounded wait may end
    before a limit allows it. The track of the file is therefore scored by the referee; while it
    breaks a limit, the ship leaves up to some seconds later after a wait, fewer waypoints are left
    out and more decimals written.

    Returns
    -------
    (Route, RouteFileOptions)
        Those given where no others help, where rounding cannot break a limit (`_is_limited`), and
        where a number of waypoints was given.
    """
    context, voyage = plan.plot_context, plan.voyage
    if context is None or options.max_waypoints is not None or not keeps_limits_at_rest(route):
        return route, options
    if not _is_limited(route, context.ship):
        return route, options
    min_ukc = required_under_keel_clearance(voyage, context.ship)

    def scored(track: Track) -> Route:
        world = {"ship": context.ship, "sea": context.sea, "chart": context.chart}
        return evaluate(track, **world, min_ukc=min_ukc, strict=False)

    @cache
    def leaving(seconds: float | None) -> Route:
        return route if seconds is None else scored(_later_track(route.track, seconds))

    delays = (None, *_LATER) if route.track.wait.any() else (None,)
    for share, decimals in _FINER_FILES:
        tried = replace(
            options,
            thinning=share * options.thinning,
            decimals=max(decimals, options.decimals),
        )
        for seconds in delays:
            if scored(file_track(leaving(seconds), tried)).feasible:
                return leaving(seconds), tried
    return route, options


def _is_limited(route: Route, ship: Ship) -> bool:
    """Return whether rounded numbers in the files of a route may break a limit.

    They may where a clearance is known and no leg is in a canal or a port approach, where waves or
    wind are near their limits, and where the ship waits.
    """
    own = np.any(route.legs.get("leg_kind", 0))
    depth = np.isfinite(route.legs["under_keel_clearance"]).any() and not own
    waves = np.asarray(route.samples.get(WAVE_HEIGHT, ()), float)
    wind = np.hypot(*(route.samples.get(name, np.zeros(0)) for name in _WIND))
    near = np.any(waves > _NEAR_LIMIT * ship.limits.wave_height)
    near |= np.any(wind > _NEAR_LIMIT * ship.limits.wind_speed)
    return bool(depth or near or route.track.wait.any())


def _later_track(track: Track, seconds: float) -> Track:
    """Return a track whose waits have whole seconds, and so many more."""
    return replace(track, wait=np.where(track.wait > 0.0, np.ceil(track.wait) + seconds, 0.0))


def _write_front(plan: PlanData, folder: Path, options: RouteFileOptions) -> list[Path]:
    """Write front.csv, front.png, comparison.csv and, in ``routes``, each route."""
    from thalweg.planning.plots.pareto_front_plot import draw_pareto_front

    front = plan.front
    assert front is not None  # checked by the caller
    files = [_write_table(front.rows(plan.routes), folder / "front.csv")]
    draw_pareto_front(plan, folder / "front.png")
    files.append(folder / "front.png")
    if front.comparison is not None:
        files.append(_write_table(front.comparison.rows, folder / "comparison.csv"))
    each = make_folder(folder / "routes")
    for number, route in enumerate(plan.routes, start=1):
        kept, own = keeping_limits(plan, route, options)
        files += write_route_files(kept, each, f"route_{number:02d}", own)
    return files


def _write_table(rows: Sequence[Mapping[str, Any]], path: Path) -> Path:
    """Write plain rows as CSV; unknown values are empty."""
    names = list(rows[0])
    write_csv_rows(path, [names, *([row.get(name) for name in names] for row in rows)])
    return path


def write_route(
    route: Route,
    folder: str | Path,
    options: RouteFileOptions | None = None,
    *,
    min_ukc: float | None = None,
    limits: ShipLimits | None = None,
) -> list[Path]:
    """Write a route as route.json, in all formats, and its profile; return the files.

    Parameters
    ----------
    min_ukc, limits : Required under-keel clearance [m] and limits of the ship, for the profile.
    """
    folder = make_folder(folder)
    text = json.dumps(route.as_dict(), indent=2, allow_nan=False)
    write_text(folder / "route.json", text + "\n")
    files = [folder / "route.json", *write_route_files(route, folder, options=options)]
    draw_profile(route, folder / "profile.png", min_ukc=min_ukc, limits=limits)
    return [*files, folder / "profile.png"]


def draw_sea(sea: Sea, folder: str | Path, *, time: TimeLike | None = None) -> list[Path]:
    """Draw maps of the main quantities of a sea over the coastline; return their paths.

    Parameters
    ----------
    time : By default the time when the waves (otherwise the wind, the current) are largest.

    Returns
    -------
    list of Path
        ``sea.png``, or ``sea_1.png`` and so on if the sea has several files with another grid.
    """
    layers = [layer for layer in sea.layers if isinstance(layer, GridLayer)]
    if len(layers) < 2:
        path = Path(folder) / "sea.png"
        draw_maps(sea.layers, path, time=time, coastline=_coastlines(sea.layers))
        return [path]
    paths = [Path(folder) / f"sea_{number}.png" for number in range(1, len(layers) + 1)]
    for layer, path in zip(layers, paths):
        draw_maps([layer], path, time=time, coastline=_coastlines([layer]))
    return paths


def _coastlines(layers: Sequence[Layer]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the outlines (lat, lon) of the land on a map of layers, as fine as it shows."""
    from thalweg.chart import Chart

    box = map_area(layers)
    size = max(box.north - box.south, box.east - box.west)
    chart = Chart.gshhg("i" if size < 25.0 else "l" if size < 90.0 else "c")
    outlines = []
    for polygon in chart.coastline.polygons(box.south, box.north, box.west, box.east):
        lon, lat = np.asarray(polygon.exterior.coords).T
        outlines.append((lat, lon))
    return outlines
