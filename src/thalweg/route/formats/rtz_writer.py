"""Routes as RTZ, the route exchange format of IEC 61174 (versions 1.0, 1.1 and 1.2).

A leg of RTZ belongs to the waypoint at its end. Legs are rhumb lines (``Loxodrome``) unless great
circles are requested.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from thalweg.core.file_writing import write_bytes
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.parsed_track import GEOMETRY, GREAT_CIRCLE, SPEEDS, WAITS
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.formats.xml_elements import decimal, xml_bytes
from thalweg.route.route import Route

#: Beginning of the namespaces of RTZ; the minor version follows.
RTZ_NAMESPACE = "http://www.cirm.org/RTZ/1/"
MANUFACTURER, ORDER = "Thalweg", "order"  #: of the extension that holds waits and ordered speeds
_LARGEST_XTD = 9.99  # [nm]
_ZIP_TIME = (1980, 1, 1, 0, 0, 0)  # the same route gives the same bytes


def write_rtz(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route as RTZ: waypoints, cross-track limits, and the schedule.

    Parameters
    ----------
    route : Route
    path : str or Path
        The name of the file without its ending becomes the name of the route, as RTZ requires.
    options : RouteFileOptions, optional
        Version, names and waypoints.
    """
    write_bytes(path, _rtz_bytes(route, Path(path).stem, options or RouteFileOptions()))


def write_rtzp(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route as RTZP: a ZIP file with one RTZ file of the same name in it.

    Parameters
    ----------
    route : Route
    path : str or Path
    options : RouteFileOptions, optional
        Version, names and waypoints.
    """
    name = Path(path).stem
    found = _rtz_bytes(route, name, options or RouteFileOptions())
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(zipfile.ZipInfo(f"{name}.rtz", _ZIP_TIME), found, zipfile.ZIP_DEFLATED)
    write_bytes(path, archive.getvalue())


def _rtz_bytes(route: Route, name: str, options: RouteFileOptions) -> bytes:
    written = file_route(route, options)
    minor = options.rtz_version.rpartition(".")[2]
    root = ElementTree.Element(
        "route", {"version": options.rtz_version, "xmlns": RTZ_NAMESPACE + minor}
    )
    info = {"routeName": name, "routeAuthor": "Thalweg"}
    if options.start and options.goal:
        info["vesselVoyage"] = f"{options.start} to {options.goal}"
    ElementTree.SubElement(root, "routeInfo", info)
    waypoints = ElementTree.SubElement(root, "waypoints")
    side = max(options.cross_track_nm, written.cross_track_m / NAUTICAL_MILE)
    xtd = decimal(min(side + 0.0005, _LARGEST_XTD) if side > options.cross_track_nm else side, 3)
    rows = written.rows
    for number, (before, row) in enumerate(zip([{}, *rows], rows), start=1):
        _add_waypoint(waypoints, number, row, before, xtd)
    if all(row["time"] is not None for row in written.rows):
        _add_schedule(root, written.rows, options.rtz_version)
    return xml_bytes(root)


def _add_waypoint(
    waypoints: ElementTree.Element,
    number: int,
    row: Mapping[str, Any],
    before: Mapping[str, Any],
    xtd: str,
) -> None:
    names = {"id": str(number), "revision": "0", "name": str(row["name"])}
    waypoint = ElementTree.SubElement(waypoints, "waypoint", names)
    place = {name: decimal(row[name], 6) for name in ("lat", "lon")}
    ElementTree.SubElement(waypoint, "position", place)
    if number > 1:
        line = "Orthodrome" if before.get(GEOMETRY) == GREAT_CIRCLE else "Loxodrome"
        leg = {"starboardXTD": xtd, "portsideXTD": xtd, "geometryType": line}
        ElementTree.SubElement(waypoint, "leg", leg)
    orders = {name: decimal(row[name], 6) for name in (*WAITS, *SPEEDS) if row.get(name)}
    if orders:
        extensions = ElementTree.SubElement(waypoint, "extensions")
        about = {"manufacturer": MANUFACTURER, "name": ORDER, "version": "1"}
        ElementTree.SubElement(extensions, "extension", about | orders)


def _add_schedule(
    root: ElementTree.Element, rows: Sequence[Mapping[str, Any]], version: str
) -> None:
    """Add the planned times, and the speeds, weather and fuel they were calculated with."""
    schedules = ElementTree.SubElement(root, "schedules")
    schedule = ElementTree.SubElement(schedules, "schedule", {"id": "1", "name": "Thalweg plan"})
    manual = ElementTree.SubElement(schedule, "manual")
    calculated = ElementTree.SubElement(schedule, "calculated")
    tag = "sheduleElement" if version == "1.0" else "scheduleElement"  # as the schema of 1.0 has it
    for number, row in enumerate(rows, start=1):
        times = waypoint_times(row, number == 1, number == len(rows), version)
        ElementTree.SubElement(manual, tag, {"waypointId": str(number)} | times)
        before = rows[number - 2] if number > 1 else None
        found = times | _calculated(row, before)
        ElementTree.SubElement(calculated, tag, {"waypointId": str(number)} | found)


def waypoint_times(row: Mapping[str, Any], first: bool, last: bool, version: str) -> dict[str, str]:
    """Return the arrival, the stay and the departure at a waypoint."""
    wait = round(3600.0 * (row.get("waiting_h") or 0.0))
    arrival = np.datetime64(str(row["time"]).removesuffix("Z"))
    times = {} if first else {"eta": str(row["time"])}
    if first or (wait and not last):
        times["etd"] = f"{arrival + np.timedelta64(wait, 's')}Z"
    if wait and not first:
        hours, minutes, seconds = wait // 3600, wait // 60 % 60, wait % 60
        if version != "1.0":
            times["stay"] = f"PT{hours}H{minutes}M{seconds}S"
        elif hours < 24:
            times["stay"] = f"{hours:02d}:{minutes:02d}:{seconds:02d}"
    return times


def _calculated(row: Mapping[str, Any], before: Mapping[str, Any] | None) -> dict[str, str]:
    """Return the mean speed and the fuel of the leg to a waypoint, and the weather there."""
    values = {
        "windSpeed": row.get("wind_speed_kn"),
        "windDirection": row.get("wind_from_deg"),
        "currentSpeed": row.get("current_speed_kn"),
        "currentDirection": row.get("current_towards_deg"),
    }
    if before is not None:
        values["speed"] = before.get("speed_over_ground_kn")
        if row.get("fuel_t") is not None and before.get("fuel_t") is not None:
            values["fuel"] = row["fuel_t"] - before["fuel_t"]
    directions = ("windDirection", "currentDirection")
    return {
        name: decimal(value % 360.0 if name in directions else value, 2)
        for name, value in values.items()
        if value is not None and (name not in directions or round(value % 360.0, 2) < 360.0)
    }
