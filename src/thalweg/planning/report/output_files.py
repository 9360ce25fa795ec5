"""Files of a plan or a route in a folder."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.file_writing import make_folder, write_csv_rows, write_text
from thalweg.core.time import TimeLike
from thalweg.planning.plots.route_profile import draw_profile
from thalweg.planning.plots.space_time_diagram import write_space_time_diagram
from thalweg.planning.plots.voyage_map import draw_map
from thalweg.route import Route, write_csv, write_geojson, write_gpx

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.planning.plan_data import PlanData
    from thalweg.sea import Sea


def write_plan(plan: PlanData, folder: str | Path) -> list[Path]:
    """Write plan.json, the best route in three formats, the plots, and the files of a front.

    Parameters
    ----------
    plan : PlanData
    folder : path

    Returns
    -------
    list of Path
        The files written.
    """
    folder = make_folder(folder)
    plan.to_json(folder / "plan.json")
    files = [folder / "plan.json", *_write_formats(plan.best, folder)]
    draw_map(plan, folder / "map.png")
    draw_profile(plan.best, folder / "profile.png")
    files += [folder / "map.png", folder / "profile.png", *write_space_time_diagram(plan, folder)]
    return files if plan.front is None else files + _write_front(plan, folder)


def _write_front(plan: PlanData, folder: Path) -> list[Path]:
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
        files += _write_formats(route, each, f"route_{number:02d}")
    return files


def _write_table(rows: Sequence[Mapping[str, Any]], path: Path) -> Path:
    """Write plain rows as CSV; unknown values are empty."""
    names = list(rows[0])
    write_csv_rows(path, [names, *([row.get(name) for name in names] for row in rows)])
    return path


def write_route(route: Route, folder: str | Path) -> list[Path]:
    """Write a route as route.json, in three formats, and its profile; return the files."""
    folder = make_folder(folder)
    text = json.dumps(route.as_dict(), indent=2, allow_nan=False)
    write_text(folder / "route.json", text + "\n")
    files = [folder / "route.json", *_write_formats(route, folder)]
    draw_profile(route, folder / "profile.png")
    return [*files, folder / "profile.png"]


def draw_sea(sea: Sea, path: str | Path, *, time: TimeLike | None = None) -> Path:
    """Draw a map of each main quantity of a sea over the coastline; return its path."""
    from thalweg.chart import Chart

    path = Path(path)
    sea.draw(path, time=time, coastline=_coastlines(sea, Chart.gshhg("i")))
    return path


def _coastlines(sea: Sea, chart: Chart) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the outlines (lat, lon) of the land inside the coverage of a sea."""
    rows = sea.coverage()
    south, north = min(row.south for row in rows), max(row.north for row in rows)
    west, east = min(row.west for row in rows), max(row.east for row in rows)
    outlines = []
    for polygon in chart.coastline.polygons(south, north, west, east):
        lon, lat = np.asarray(polygon.exterior.coords).T
        outlines.append((lat, lon))
    return outlines


def _write_formats(route: Route, folder: Path, name: str = "route") -> list[Path]:
    writers = {"geojson": write_geojson, "gpx": write_gpx, "csv": write_csv}
    for suffix, write in writers.items():
        write(route, folder / f"{name}.{suffix}")
    return [folder / f"{name}.{suffix}" for suffix in writers]
