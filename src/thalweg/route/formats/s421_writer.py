"""Routes as S-421 (IEC 63173-1:2021, edition 1.0), the route plan of the S-100 family, as GML.

Experimental: the files follow the structure of published test files of edition 1.0; they were not
validated by an official schema, which is not public. A leg belongs to the waypoint at its end. Its
geometry is 1 (loxodrome) or 2 (orthodrome), its cross-track limits are in metres. Times are UTC.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.parsed_track import GEOMETRY, GREAT_CIRCLE, SPEEDS, WAITS
from thalweg.route.formats.route_file_options import RouteFileOptions, voyage_name
from thalweg.route.formats.rtz_writer import MANUFACTURER, ORDER, waypoint_times
from thalweg.route.formats.xml_elements import add_text, decimal, write_xml
from thalweg.route.route import Route

S421_NAMESPACE = "http://www.iho.int/S421/gml/cs0/1.0"
_S100 = "http://www.iho.int/s100gml/1.0"
_GML = "http://www.opengis.net/gml/3.2"
_XLINK = "http://www.w3.org/1999/xlink"
_ROLES = "http://www.iho.int/S-421/gml/1.0/roles/"
_CRS = "EPSG:4326"


def write_s421(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route as S-421: waypoints, legs with cross-track limits, and the schedule.

    Parameters
    ----------
    route : Route
    path : str or Path
        The name of the file without its ending becomes the identifier of the route.
    options : RouteFileOptions, optional
        Names and waypoints.
    """
    options = options or RouteFileOptions()
    written = file_route(route, options)
    rows = written.rows
    for prefix, namespace in (
        ("S421", S421_NAMESPACE), ("S100", _S100), ("gml", _GML), ("xlink", _XLINK)
    ):  # fmt: skip
        ElementTree.register_namespace(prefix, namespace)
    name = Path(path).stem
    root = ElementTree.Element(f"{{{S421_NAMESPACE}}}Dataset", {f"{{{_GML}}}id": f"S421.{name}"})
    _add_envelope(root, rows)
    scheduled = all(row["time"] is not None for row in rows)
    whole = _member(root, "Route", "RTE")
    for tag, text in (("routeFormatVersion", "1.0"), ("routeID", name), ("routeEditionNo", "1")):
        add_text(whole, tag, text)
    _link(whole, "routeInfo", "RTE.INFO")
    _link(whole, "routeWaypoints", "RTE.WPTS")
    if scheduled:
        _link(whole, "routeSchedules", "RTE.SCHEDS")
    info = _member(root, "RouteInfo", "RTE.INFO", "imember")
    add_text(info, "routeInfoName", voyage_name(options) or name)
    add_text(info, "routeInfoAuthor", "Thalweg")
    side = max(options.cross_track_nm * NAUTICAL_MILE, written.cross_track_m)
    _add_waypoints(root, rows, decimal(side, 1))
    if scheduled:
        _add_schedules(root, rows)
    write_xml(root, path)


def _add_envelope(root: ElementTree.Element, rows: Sequence[Mapping[str, Any]]) -> None:
    bounded = ElementTree.SubElement(root, f"{{{_GML}}}boundedBy")
    envelope = ElementTree.SubElement(bounded, f"{{{_GML}}}Envelope", {"srsName": _CRS})
    lat, lon = ([row[axis] for row in rows] for axis in ("lat", "lon"))
    add_text(envelope, f"{{{_GML}}}lowerCorner", f"{decimal(min(lat), 9)} {decimal(min(lon), 9)}")
    add_text(envelope, f"{{{_GML}}}upperCorner", f"{decimal(max(lat), 9)} {decimal(max(lon), 9)}")


def _add_waypoints(root: ElementTree.Element, rows: Sequence[Mapping[str, Any]], side: str) -> None:
    group = _member(root, "RouteWaypoints", "RTE.WPTS")
    for number in range(1, len(rows) + 1):
        _link(group, "routeWaypoint", f"RTE.WPT.{number}", "consistsOfRouteWaypoint")
    for number, row in enumerate(rows, start=1):
        here = f"RTE.WPT.{number}"
        waypoint = _member(root, "RouteWaypoint", here)
        geometry = ElementTree.SubElement(waypoint, "geometry")
        held = ElementTree.SubElement(geometry, f"{{{_S100}}}pointProperty")
        about = {f"{{{_GML}}}id": f"{here}.PT", "srsName": _CRS}
        point = ElementTree.SubElement(held, f"{{{_S100}}}Point", about)
        add_text(point, f"{{{_GML}}}pos", f"{decimal(row['lat'], 9)} {decimal(row['lon'], 9)}")
        add_text(waypoint, "routeWaypointID", str(number))
        add_text(waypoint, "routeWaypointName", str(row["name"]))
        add_text(waypoint, "routeWaypointFixed", "true" if number in (1, len(rows)) else "false")
        _link(waypoint, "routeWaypointCollection", "RTE.WPTS")
        if number > 1:
            _link(waypoint, "routeWaypointLeg", f"RTE.WPT.LEG.{number - 1}")
        _add_orders(waypoint, row, f"{here}.EXT.1")
    for number in range(1, len(rows)):
        leg = _member(root, "RouteWaypointLeg", f"RTE.WPT.LEG.{number}")
        add_text(leg, "routeWaypointLegStarboardXTDL", side)
        add_text(leg, "routeWaypointLegPortXTDL", side)
        great_circle = rows[number - 1].get(GEOMETRY) == GREAT_CIRCLE
        add_text(leg, "routeWaypointLegGeometryType", "2" if great_circle else "1")
        _link(leg, "routeWaypointLegCollection", f"RTE.WPT.{number + 1}")


def _add_orders(waypoint: ElementTree.Element, row: Mapping[str, Any], name: str) -> None:
    """Add the wait and the ordered speed, which S-421 has no elements for, as an extension."""
    orders = [f"{key}={decimal(row[key], 6)}" for key in (*WAITS, *SPEEDS) if row.get(key)]
    if orders:
        about = {
            f"{{{_GML}}}id": name,
            "routeExtensionsManufacturerId": MANUFACTURER,
            "routeExtensionsName": ORDER,
            "routeExtensionsVersion": "1",
        }
        extension = ElementTree.SubElement(waypoint, "routeWaypointExtensions", about)
        add_text(extension, "routeExtensionsNote", " ".join(orders))


def _add_schedules(root: ElementTree.Element, rows: Sequence[Mapping[str, Any]]) -> None:
    group = _member(root, "RouteSchedules", "RTE.SCHEDS", "imember")
    _link(group, "routeSchedule", "RTE.SCHED.1")
    schedule = _member(root, "RouteSchedule", "RTE.SCHED.1", "imember")
    add_text(schedule, "routeScheduleID", "1")
    add_text(schedule, "routeScheduleName", "Thalweg plan")
    _link(schedule, "routeScheduleCollection", "RTE.SCHEDS")
    _link(schedule, "routeScheduleCalculated", "RTE.SCHED.1.CAL")
    calculated = _member(root, "RouteScheduleCalculated", "RTE.SCHED.1.CAL", "imember")
    _link(calculated, "routeScheduleCollection", "RTE.SCHED.1")
    name = "RTE.SCHED.1.CAL.ELEMENT.{}".format
    for number in range(1, len(rows) + 1):
        _link(calculated, "routeScheduleElement", name(number))
    for number, row in enumerate(rows, start=1):
        element = _member(root, "RouteScheduleElement", name(number), "imember")
        add_text(element, "routeWaypointId", str(number))
        speed = rows[number - 2].get("speed_over_ground_kn") if number > 1 else None
        if speed is not None:
            add_text(element, "routeScheduleElementPlanSOG", decimal(speed, 2))
        times = waypoint_times(row, number == 1, number == len(rows), "1.2")
        for key in ("etd", "eta"):
            if key in times:
                add_text(element, f"routeScheduleElement{key.upper()}", times[key])
        link = "routeScheduleElementCalculatedCollection"
        _link(element, link, "RTE.SCHED.1.CAL")


def _member(
    root: ElementTree.Element, tag: str, name: str, kind: str = "member"
) -> ElementTree.Element:
    """Add a feature, or as ``imember`` an information type, and return it."""
    member = ElementTree.SubElement(root, kind)
    return ElementTree.SubElement(member, f"{{{S421_NAMESPACE}}}{tag}", {f"{{{_GML}}}id": name})


def _link(parent: ElementTree.Element, tag: str, target: str, role: str = "") -> None:
    about = {f"{{{_XLINK}}}href": f"#{target}", f"{{{_XLINK}}}arcrole": _ROLES + (role or tag)}
    ElementTree.SubElement(parent, tag, about)
