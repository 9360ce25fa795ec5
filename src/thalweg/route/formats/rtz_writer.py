"""Routes as RTZ, the route exchange format of IEC 61174 (versions 1.0, 1.1 and 1.2).

A leg of RTZ belongs to the waypoint at its end. Legs are rhumb lines (``Loxodrome``) unless great
circles are requested.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import write_bytes
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.route.carried_extensions import (
    LEG_NUMBERS,
    LEG_TEXTS,
    CarriedExtensions,
    Visit,
    visits_of,
)
from thalweg.route.formats.file_route import FileRoute, file_route
from thalweg.route.formats.parsed_track import GEOMETRY, GREAT_CIRCLE, SPEEDS, WAITS
from thalweg.route.formats.route_file_options import RouteFileOptions, voyage_name
from thalweg.route.formats.xml_elements import decimal, xml_file, xml_text
from thalweg.route.route import Route

#: Beginning of the namespaces of RTZ; the minor version follows.
RTZ_NAMESPACE = "http://www.cirm.org/RTZ/1/"
_HISTORY = "routeChangesHistory"  # a text since 1.1
MANUFACTURER, ORDER = "Thalweg", "order"  #: of the extension that holds waits and ordered speeds
_LARGEST_XTD = 9.99  # [nm]
_LARGEST_RADIUS = 5.0, 9.999  # [nm], since 1.1 and in 1.0
#: An extension as the schemas of 1.1 and 1.2 want it: a maker and a name with a letter or digit.
_NAMED = re.compile(
    r'<extension(?=[ ])(?=[^>]*\smanufacturer="[^"]*[0-9a-zA-Z])(?=[^>]*\sname="[^"]*[0-9a-zA-Z])'
    r'(?![^>]*\sversion="[^"0-9a-zA-Z]*")(?![^>]*\sxmlns=)'
)
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
    written, version = file_route(route, options), options.rtz_version
    carried = route.track.extensions
    info = {"routeName": name, "routeAuthor": "Thalweg"}
    if voyage := voyage_name(options):
        info["vesselVoyage"] = voyage
    info |= {k: v for k, v in carried.info.items() if version != "1.0" or k != _HISTORY}
    side = max(options.cross_track_nm, written.cross_track_m / NAUTICAL_MILE)
    side = min(side + 0.0005, _LARGEST_XTD) if side > options.cross_track_nm else side
    legs = _leg_attributes(route, written, decimal(side, 3))
    waypoints = [
        *_default_waypoint(carried, version),
        *(
            _waypoint(number, row | _radius(carried, visit, version), leg, held, version)
            for number, (row, leg, visit, held) in enumerate(
                zip(
                    written.rows,
                    legs,
                    written.visits,
                    [_extensions_there(carried, visit, version) for visit in written.visits],
                ),
                start=1,
            )
        ),
        *_extensions(carried.of("waypoints"), version, 2),
    ]
    inside = [
        xml_text("routeInfo", info, _extensions(carried.of("routeInfo"), version, 2), 1),
        xml_text("waypoints", {}, waypoints, 1),
        *_schedules(written, carried, version),
        *_extensions(carried.of("route"), version, 1),
    ]
    minor = version.rpartition(".")[2]
    about = {"version": version, "xmlns": RTZ_NAMESPACE + minor}
    return xml_file(xml_text("route", about, inside))


def _leg_attributes(route: Route, written: FileRoute, xtd: str) -> list[dict[str, str]]:
    """Return the attributes of the leg to each waypoint: its line, its limits, texts of a file.

    A leg that stands for legs of a file that was read has the least of their cross-track limits,
    and the other limits in which they agree. Texts stand where the leg of that file ends.
    """
    rows, limits = written.rows, route.track.extensions.corridors
    lines = ["", *("Orthodrome" if r.get(GEOMETRY) == GREAT_CIRCLE else "Loxodrome" for r in rows)]
    sides = {"starboardXTD": xtd, "portsideXTD": xtd}
    legs = [{**sides, "geometryType": line} for line in lines[: len(rows)]]
    details = route.track.extensions.details
    if not limits and not details:
        return legs
    order = {visit: n for n, visit in enumerate(visits_of(route.track.positions))}
    known = sorted((order[visit], *pair) for visit, pair in limits.items() if visit in order)
    ends = [end for end, _, _ in known]
    places = [None if visit is None else order[visit] for visit in written.visits]
    following, first = _next_places(places), 0
    for number, before in enumerate(places[:-1], start=1):
        first = first if before is None else bisect_right(ends, before)
        within = known[first : bisect_left(ends, following[number]) + 1]
        for side, name in ((1, "portsideXTD"), (2, "starboardXTD")):
            stated = [leg[side] for leg in within if not math.isnan(leg[side])]
            if stated:
                legs[number][name] = decimal(min(stated) / NAUTICAL_MILE, 3)
    return _with_details(legs, details, order, places) if details else legs


def _with_details(
    legs: list[dict[str, str]],
    details: Mapping[Visit, Mapping[str, str]],
    order: Mapping[Visit, int],
    places: Sequence[int | None],
) -> list[dict[str, str]]:
    """Return the attributes of legs with the limits and texts of the legs of a file.

    Parameters
    ----------
    order : Places of the visits of the track.
    places : Of the waypoints that are written; None for those between.
    """
    known = sorted((order[visit], found) for visit, found in details.items() if visit in order)
    ends = [end for end, _ in known]
    following, before = _next_places(places), 0
    for number, leg in enumerate(legs[1:], start=1):
        before = before if places[number - 1] is None else places[number - 1] or 0
        last = bisect_left(ends, following[number]) + 1
        within = [found for _, found in known[bisect_right(ends, before) : last]]
        for name in LEG_NUMBERS if within else ():
            values = {found.get(name) for found in within}
            if len(values) == 1 and None not in values:
                leg[name] = values.pop()  # type: ignore[assignment]
        if within and places[number] is not None and places[number] == known[last - 1][0]:
            leg |= {name: within[-1][name] for name in LEG_TEXTS if name in within[-1]}
    return legs


def _radius(carried: CarriedExtensions, visit: Visit | None, version: str) -> dict[str, str]:
    """Return the turn radius of a waypoint [nm], as the schema of a version allows it."""
    text = "" if visit is None else carried.details.get(visit, {}).get("radius", "")
    largest = _LARGEST_RADIUS[version == "1.0"]
    return {"radius": text} if text and float(text) <= largest else {}


def _next_places(places: Sequence[int | None]) -> list[int]:
    """Return the first place that is known at or after each."""
    found, place = [], 0
    for known in reversed(places):
        place = place if known is None else known
        found.append(place)
    return found[::-1]


def _extensions(texts: Sequence[str], version: str, depth: int) -> list[str]:
    """Return the element that holds extensions, as the schema of a version has them; or nothing.

    The schema of 1.0 allows any element there; those of 1.1 and 1.2 want a maker and a name, and
    what has none gets them.
    """
    if not texts:
        return []
    held = [text if version == "1.0" or _NAMED.match(text) else _named(text) for text in texts]
    return [xml_text("extensions", {}, [f"{'  ' * depth}  {text}" for text in held], depth)]


def _named(text: str) -> str:
    return f'<extension manufacturer="unknown" name="unnamed">{text}</extension>'


def _extensions_there(
    carried: CarriedExtensions, visit: Visit | None, version: str
) -> tuple[list[str], list[str]]:
    """Return the extensions of other makers of a leg and of the waypoint at its end.

    Only the schema of 1.2 has those of legs: in others they belong to the waypoint.
    """
    if visit not in carried.at:
        return [], []
    leg, waypoint = (list(carried.there(visit, name)) for name in ("leg", "waypoint"))
    return (leg, waypoint) if version == "1.2" else ([], leg + waypoint)


def _default_waypoint(carried: CarriedExtensions, version: str) -> list[str]:
    """Return the default waypoint; none where it would have nothing."""
    leg, own = list(carried.of("defaultLeg")), list(carried.of("defaultWaypoint"))
    if version != "1.2":
        leg, own = [], leg + own
    inside = _extensions(own, version, 3)
    if leg:
        inside = [xml_text("leg", {}, _extensions(leg, version, 4), 3), *inside]
    return [xml_text("defaultWaypoint", {}, inside, 2)] if inside else []


def _waypoint(
    number: int,
    row: Mapping[str, Any],
    leg: Mapping[str, str],
    carried: tuple[list[str], list[str]],
    version: str,
) -> str:
    names = {"id": str(number), "revision": "0", "name": str(row["name"])}
    if "radius" in row:
        names["radius"] = str(row["radius"])
    place = {name: decimal(row[name], 6) for name in ("lat", "lon")}
    inside = [xml_text("position", place, (), 3)]
    of_leg, own = carried
    if number > 1:
        inside.append(xml_text("leg", leg, _extensions(of_leg, version, 4), 3))
    else:
        own = of_leg + own
    orders = {name: decimal(row[name], 6) for name in (*WAITS, *SPEEDS) if row.get(name)}
    if orders:
        about = {"manufacturer": MANUFACTURER, "name": ORDER, "version": "1"}
        own = [xml_text("extension", about | orders), *own]
    return xml_text("waypoint", names, [*inside, *_extensions(own, version, 3)], 2)


def _schedules(written: FileRoute, carried: CarriedExtensions, version: str) -> list[str]:
    """Return the planned times, and the speeds, weather and fuel they were calculated with."""
    rows = written.rows
    shared = _extensions(carried.of("schedules"), version, 2)
    if any(row["time"] is None for row in rows):
        return [xml_text("schedules", {}, shared, 1)] if shared else []
    tag = "sheduleElement" if version == "1.0" else "scheduleElement"  # as the schema of 1.0 has it
    parts: dict[str, list[str]] = {"manual": [], "calculated": []}
    for number, (row, before, visit) in enumerate(
        zip(rows, [None, *rows], written.visits), start=1
    ):
        times = waypoint_times(row, number == 1, number == len(rows), version)
        values = {"manual": times, "calculated": times | _calculated(row, before)}
        for kind, found in values.items():
            held = _extensions(carried.there(visit, f"{kind}Element"), version, 5)
            parts[kind].append(xml_text(tag, {"waypointId": str(number)} | found, held, 4))
    inside = [
        xml_text(kind, {}, [*elements, *_extensions(carried.of(kind), version, 4)], 3)
        for kind, elements in parts.items()
    ]
    inside += _extensions(carried.of("schedule"), version, 3)
    schedule = xml_text("schedule", {"id": "1", "name": "Thalweg plan"}, inside, 2)
    return [xml_text("schedules", {}, [schedule, *shared], 1)]


def waypoint_times(row: Mapping[str, Any], first: bool, last: bool, version: str) -> dict[str, str]:
    """Return the arrival, the stay and the departure at a waypoint."""
    wait = round(HOUR * (row.get("waiting_h") or 0.0))
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
