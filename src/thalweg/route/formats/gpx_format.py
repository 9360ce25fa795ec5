"""Routes as GPX 1.1; XML is read by defusedxml, so that no file can expand or fetch anything."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.parsed_track import (
    GEOMETRY,
    SPEEDS,
    WAITS,
    ParsedTrack,
    carried_names,
    position_of,
    waypoint_track,
)  # fmt: skip
from thalweg.route.formats.route_file_options import RouteFileOptions, voyage_name
from thalweg.route.formats.xml_elements import (
    add_text,
    decimal,
    local_name,
    parse_xml,
    write_xml,
)  # fmt: skip
from thalweg.route.route import Route

_NAMESPACE = "http://www.topografix.com/GPX/1/1"
_OWN_NAMESPACE = "urn:thalweg:route:1"


def parse_gpx(text: str) -> ParsedTrack:
    """Read the first route (``rtept``) of a GPX text, or else its first track (``trkpt``).

    Raises
    ------
    InputError : If it is not XML, declares entities, or holds neither.
    """
    root = parse_xml(text, "GPX")
    routes = _points(root, "rte", "rtept") or _points(root, "trk", "trkpt")
    if not routes:
        raise InputError(
            "The GPX holds no route and no track.",
            "A route has rtept elements, a track trkpt elements.",
            "Export the route itself, not only waypoints.",
        )
    points, more = routes[0], len(routes) - 1
    notes = [f"of its {more + 1} routes or tracks the first is used"] if more else []
    positions = [position_of(p.get("lat"), p.get("lon"), i) for i, p in enumerate(points, start=1)]
    times = [next((e.text for e in p if local_name(e) == "time" and e.text), None) for p in points]
    parsed = waypoint_track(positions, times, [_extensions(point) for point in points])
    names = carried_names(map(_name, points), positions)
    return replace(parsed, notes=notes, extensions=names)


def write_gpx(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route as a GPX 1.1 route with the time of arrival at every waypoint.

    Parameters
    ----------
    route : Route
    path : str or Path
    options : RouteFileOptions, optional
        Names and waypoints.
    """
    options = options or RouteFileOptions()
    root = ElementTree.Element("gpx", {"version": "1.1", "creator": "Thalweg", "xmlns": _NAMESPACE})
    line = ElementTree.SubElement(root, "rte")
    add_text(line, "name", voyage_name(options) or "Thalweg route")
    for row in file_route(route, options).rows:
        place = {name: decimal(row[name], 9) for name in ("lat", "lon")}
        point = ElementTree.SubElement(line, "rtept", place)
        if row["time"] is not None:
            add_text(point, "time", row["time"])
        add_text(point, "name", row["name"])
        _extend(point, row)
    ElementTree.register_namespace("thalweg", _OWN_NAMESPACE)
    write_xml(root, path)


def _name(point: ElementTree.Element) -> str | None:
    return next((e.text for e in point if local_name(e) == "name" and e.text), None)


def _extend(point: ElementTree.Element, row: Mapping[str, Any]) -> None:
    """Add the wait, the ordered speed and the line, which GPX has no elements for."""
    given = {name: row[name] for name in (*WAITS, *SPEEDS, GEOMETRY) if row.get(name)}
    if given:
        extensions = ElementTree.SubElement(point, "extensions")
        for name, value in given.items():
            add_text(extensions, f"{{{_OWN_NAMESPACE}}}{name}", str(value))


def _extensions(point: ElementTree.Element) -> dict[str, str]:
    """Return what a point has of our own elements, by name."""
    own = [e for e in point.iter() if str(e.tag).startswith(f"{{{_OWN_NAMESPACE}}}")]
    return {local_name(element): (element.text or "").strip() for element in own}


def _points(root: ElementTree.Element, parent: str, name: str) -> list[list[ElementTree.Element]]:
    """Return the points of each parent element that has any, of whatever GPX version."""
    parents = [element for element in root.iter() if local_name(element) == parent]
    found = ([e for e in element.iter() if local_name(e) == name] for element in parents)
    return [points for points in found if points]
