"""The tasks of the worker process: frames, coast cells, inspections, imports, sheets, places."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.service.jobs.sea_facts import FRAME_VARIABLES, forecast_run, sea_facts

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea

TaskResult = tuple[dict[str, Any], bytes]
FRAME_HEADER: Final = struct.Struct("<4sHHHHf4f")  #: magic, nx, ny, fields, 0, scale, box
_QUICK_COASTS: Final = ("c", "l", "i")  # loaded in a fraction of a second
UNKNOWN: Final = -32768  #: an unknown value in a frame


def frame(task: Mapping[str, Any]) -> TaskResult:
    """Return a field on a raster whose rows are equally spaced on a Mercator map.

    Parameters
    ----------
    task : mapping
        ``seas``, ``files`` and ``variables`` as of a job, ``variable`` (of `FRAME_VARIABLES`),
        ``time`` [s since 1970], ``box`` (south, north, west, east) [deg], ``nx`` and ``ny``.

    Returns
    -------
    dict
        Empty.
    bytes
        A header (`FRAME_HEADER`) of 32 bytes; then for each field rows from north to south of
        16-bit integers, little-endian, in units of the scale; `UNKNOWN` where unknown.
    """
    names, scale = FRAME_VARIABLES[task["variable"]]
    at = _raster(task)
    sea = _sea(*_names_of_sea(task))
    if sea.members:
        sea = sea.member(0)
    known = [name for name in names if name in sea.variables]
    values = sea.sample(known, task["time"], *at) if known else {}
    fields = [values.get(name, np.full(at[0].shape, np.nan)) for name in names]
    return {}, _packed(task, fields, scale)


def chart_depth(task: Mapping[str, Any]) -> TaskResult:
    """Return the depth of the global layer on a raster, as `frame` returns that of a sea.

    Parameters
    ----------
    task : mapping
        ``box``, ``nx`` and ``ny``.
    """
    from thalweg.chart.depth.global_depth import coarse_depth

    _, scale = FRAME_VARIABLES["depth"]
    return {}, _packed(task, [coarse_depth(*_raster(task))], scale)


def _raster(task: Mapping[str, Any]) -> tuple[FloatArray, FloatArray]:
    """Return the latitudes and longitudes of a raster of Mercator rows [deg]."""
    south, north, west, east = task["box"]
    y = np.linspace(_mercator(north), _mercator(south), task["ny"])
    lat = np.degrees(2.0 * np.arctan(np.exp(y)) - np.pi / 2)
    lon = np.linspace(west, east, task["nx"])
    at_lat, at_lon = np.meshgrid(lat, (lon + 180.0) % 360.0 - 180.0, indexing="ij")
    return at_lat, at_lon


def _packed(task: Mapping[str, Any], fields: Sequence[Any], scale: float) -> bytes:
    shape = (task["ny"], task["nx"])
    data = np.stack([_as_integers(np.broadcast_to(field, shape), scale) for field in fields])
    size = task["nx"], task["ny"], len(fields)
    return FRAME_HEADER.pack(b"TWF1", *size, 0, scale, *task["box"]) + data.astype("<i2").tobytes()


def _mercator(lat: float) -> float:
    return float(np.log(np.tan(np.pi / 4 + np.radians(lat) / 2)))


def _as_integers(values: Any, scale: float) -> Any:
    rounded = np.round(np.asarray(values, float) / scale)
    return np.where(np.isfinite(rounded), np.clip(rounded, -32767, 32767), UNKNOWN)


_Pairs = tuple[tuple[str, str], ...]


def _names_of_sea(task: Mapping[str, Any]) -> tuple[tuple[str, ...], _Pairs, _Pairs]:
    files, variables = (tuple(sorted(task.get(k, {}).items())) for k in ("files", "variables"))
    return tuple(task["seas"]), files, variables


@lru_cache(maxsize=4)
def _sea(seas: tuple[str, ...], files: _Pairs, variables: _Pairs) -> Sea:
    from thalweg.service.jobs.request_objects import open_seas

    return open_seas(list(seas), dict(files), variables=dict(variables) or None)


def inspect(task: Mapping[str, Any]) -> TaskResult:
    """Return what a sea holds: variables, box, period, times, forecast run, ignored variables.

    Parameters
    ----------
    task : mapping
        ``seas``, ``files`` and ``variables``.
    """
    sea = _sea(*_names_of_sea(task))
    facts = sea_facts(sea, in_detail=bool(task.get("in_detail")))
    runs = [*filter(None, map(forecast_run, task["files"].values()))]
    if runs:
        facts["run"] = min(runs)
    return facts, b""


def import_route(task: Mapping[str, Any]) -> TaskResult:
    """Return the waypoints of a route file, and what it has otherwise than its format.

    Parameters
    ----------
    task : mapping
        ``path``, and ``name`` of the file at the client.
    """
    from thalweg.route.formats import route_file_contents
    from thalweg.route.formats.parsed_track import track_of

    contents = route_file_contents(Path(task["path"]))
    name = task.get("name") or Path(task["path"]).name
    times = contents.first_time is not None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ThalwegWarning)  # these are the notes
        track = track_of(contents, None if times else 0.0, name)
    return {
        "waypoints": [
            [round(float(a), 6), round(float(b), 6)] for a, b in zip(track.lat, track.lon)
        ],
        "depart": format_time(track.depart) if times else None,
        "notes": contents.all_notes(name),
    }, b""


def inspect_traffic(task: Mapping[str, Any]) -> TaskResult:
    """Return what a file of ship traffic holds: zones by name, and the number of rasters.

    Parameters
    ----------
    task : mapping
        ``path``.

    Raises
    ------
    InputError : If it holds no rate of encounters at all.
    """
    from thalweg.chart.zones.traffic_files import read_ship_traffic

    traffic = read_ship_traffic(task["path"])
    if not (traffic.zones or traffic.grids or traffic.elsewhere):
        raise InputError(
            "The file holds no traffic.",
            "It holds zones with encounters_per_h, encounters_per_nm or ships_per_km2, or a raster "
            "of density.",
            "Choose another file.",
            field="file",
        )
    return {
        "zones": [zone.name for zone in traffic.zones],
        "grids": len(traffic.grids),
    }, b""


def inspect_history(task: Mapping[str, Any]) -> TaskResult:
    """Return what a history network holds: numbers of ports, junctions and arcs.

    Parameters
    ----------
    task : mapping
        ``path``.
    """
    from thalweg.network.history.history_file import read_history

    network = read_history(task["path"])
    ports = len(network.nodes.lat) - network.nodes.first_port
    return {
        "ports": ports,
        "junctions": int(network.nodes.first_port),
        "arcs": len(network.arcs.kind),
    }, b""


def ship_sheet(task: Mapping[str, Any]) -> TaskResult:
    """Return the performance sheet of a ship, with its limits.

    Parameters
    ----------
    task : mapping
        ``ship`` (name or path).
    """
    from thalweg.ship import Ship
    from thalweg.ship.performance_sheet import performance_sheet

    ship = Ship.load(task["ship"])
    facts: dict[str, Any] = {"name": ship.name}
    if ship.speed_field is None:
        facts = performance_sheet(ship)
    limits = ship.limits
    facts["limits"] = {
        "wave_height_m": limits.wave_height if np.isfinite(limits.wave_height) else None,
        "wind_speed_m_s": limits.wind_speed if np.isfinite(limits.wind_speed) else None,
    }
    return facts, b""


def coast_cells(task: Mapping[str, Any]) -> TaskResult:
    """Cut the coastline of a resolution into cells on the disk; return where they are."""
    from thalweg.service.coast_map import build_cells

    return {"folder": str(build_cells(task["level"]))}, b""


def forecast_size(task: Mapping[str, Any]) -> TaskResult:
    """Return what a forecast would download, as its server states it now.

    Parameters
    ----------
    task : mapping
        ``request``, a `FetchOrder` as plain data.
    """
    from thalweg.forecasts.fetching import estimate_forecast, source_named
    from thalweg.service.jobs.batch_requests import FetchOrder

    request = FetchOrder.model_validate(task["request"])
    source = source_named(request.source)
    plan = estimate_forecast(request.forecast_request(), source)
    return {
        "source": source.name,
        "title": source.title,
        "licence": source.licence,
        "run": None if plan.run is None else format_time(plan.run),
        "times": len(plan.times),
        "bytes": plan.bytes,
        "notes": list(plan.notes),
    }, b""


def check_places(task: Mapping[str, Any]) -> TaskResult:
    """Check that the places of a voyage are at sea or near it, as the plan does.

    Fine coastlines, and kernels that are not compiled yet, take long: the job checks these.

    Parameters
    ----------
    task : mapping
        ``voyage``, ``coast`` and ``areas`` as of a request; without them only the coast is loaded.
    """
    from thalweg.planning.compile_kernels import search_is_compiled
    from thalweg.planning.request.voyage_endpoints import resolve_places
    from thalweg.planning.voyage import Voyage

    if not search_is_compiled():
        return {}, b""
    if "voyage" not in task:
        resolve_places("Rotterdam", (), (47.3, -19.5), _coast("i"))
        return {}, b""
    if task["coast"] in _QUICK_COASTS:
        voyage, chart = Voyage.from_dict(task["voyage"]), _coast(task["coast"])
        chart = chart.with_zones(task["areas"]) if task["areas"] else chart
        resolve_places(voyage.start, voyage.via, voyage.goal, chart)
    return {}, b""


@lru_cache(maxsize=3)
def _coast(name: str) -> Chart:
    from thalweg.planning.request.voyage_surroundings import chart_of_entries

    return chart_of_entries(name)


TASKS: Final[Mapping[str, Callable[[Mapping[str, Any]], TaskResult]]] = {
    "frame": frame,
    "chart_depth": chart_depth,
    "inspect": inspect,
    "import_route": import_route,
    "inspect_traffic": inspect_traffic,
    "inspect_history": inspect_history,
    "ship_sheet": ship_sheet,
    "coast_cells": coast_cells,
    "forecast_size": forecast_size,
    "check_places": check_places,
}
