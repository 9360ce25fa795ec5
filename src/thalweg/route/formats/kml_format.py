"""Routes as KML 2.2 (OGC 07-147r2): a line and one placemark per waypoint, for maps and globes.

Waits, ordered speeds and the kind of line of each leg are in the extended data of the placemarks,
as KML has no elements for them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.geojson_format import line_parts
from thalweg.route.formats.parsed_track import (
    GEOMETRY,
    SPEEDS,
    WAITS,
    ParsedTrack,
    position_of,
    waypoint_track,
)  # fmt: skip
from thalweg.route.formats.route_file_options import RouteFileOptions, voyage_name
from thalweg.route.formats.xml_elements import add_text, local_name, parse_xml, write_xml
from thalweg.route.route import Route

_NAMESPACE = "http://www.opengis.net/kml/2.2"


def parse_kml(text: str) -> ParsedTrack:
    """Read a route from a KML text: placemarks with a time, or else a line, a track or points.

    Parameters
    ----------
    text : Of these it has, in this order: two or more placemarks with a point and a time stamp; a
        placemark with lines, which are joined; a track of Google's extension; points.

    Raises
    ------
    InputError : If it is not XML, declares entities, holds none of these, or a position is wrong.
    """
    root = parse_xml(text, "KML")
    places = _named(root, "Placemark")
    points = [place for place in places if _named(place, "Point")]
    timed = [place for place in points if _time(place)]
    if len(timed) >= 2:
        return _of_points(timed)
    for place in places:
        found = _of_lines(place) or _of_track(place)
        if found is not None:
            return found
    if len(points) >= 2:
        return _of_points(points)
    raise InputError(
        "The KML holds no route.",
        "A route is a placemark with a LineString or a gx:Track, or two or more points in order.",
        "Export the path itself, not a single place or a picture.",
    )


def write_kml(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route as KML: its line as sailed, and its waypoints with their times.

    Parameters
    ----------
    route : Route
    path : str or Path
    options : RouteFileOptions, optional
        Names and waypoints.
    """
    options = options or RouteFileOptions()
    root = ElementTree.Element("kml", {"xmlns": _NAMESPACE})
    document = ElementTree.SubElement(root, "Document")
    ends = voyage_name(options)
    add_text(document, "name", ends or "Thalweg route")
    style = ElementTree.SubElement(document, "Style", {"id": "route"})
    line = ElementTree.SubElement(style, "LineStyle")
    add_text(line, "color", "ffb25d1f")  # aabbggrr
    add_text(line, "width", "3")
    whole = ElementTree.SubElement(document, "Placemark")
    add_text(whole, "name", ends or "Route")
    add_text(whole, "styleUrl", "#route")
    lines = ElementTree.SubElement(whole, "MultiGeometry")
    for part in line_parts(route, options.decimals):
        drawn = ElementTree.SubElement(lines, "LineString")
        add_text(drawn, "tessellate", "1")
        add_text(drawn, "coordinates", " ".join(f"{lon!r},{lat!r}" for lon, lat in part))
    for row in file_route(route, options).rows:
        place = ElementTree.SubElement(document, "Placemark")
        add_text(place, "name", row["name"])
        facts = [f"{row[name]:g} {unit}" for name, unit in _FACTS.items() if row.get(name)]
        add_text(place, "description", ", ".join(facts))
        if row["time"] is not None:
            add_text(ElementTree.SubElement(place, "TimeStamp"), "when", row["time"])
        given = {name: row[name] for name in (*WAITS, *SPEEDS, GEOMETRY) if row.get(name)}
        if given:
            extended = ElementTree.SubElement(place, "ExtendedData")
            for name, value in given.items():
                data = ElementTree.SubElement(extended, "Data", {"name": name})
                add_text(data, "value", str(value))
        point = ElementTree.SubElement(place, "Point")
        add_text(point, "coordinates", f"{row['lon']!r},{row['lat']!r}")
    write_xml(root, path)


#: Values of waypoints in their descriptions, with their units.
_FACTS = {
    "course_deg": "degrees course",
    "speed_over_ground_kn": "kn over ground",
    "waiting_h": "h of waiting",
}


def _of_points(places: list[ElementTree.Element]) -> ParsedTrack:
    """Return the route through placemarks with a point, in their order."""
    positions = [
        position for place in places for position in _positions(_named(place, "coordinates")[:1])
    ]
    given = [_extended_data(place) for place in places]
    return waypoint_track(positions, [_time(place) for place in places], given)


def _of_lines(place: ElementTree.Element) -> ParsedTrack | None:
    """Return the route along the lines of a placemark; None where it has none."""
    lines = _named(place, "LineString")
    if not lines:
        return None
    parts = [element for line in lines for element in _named(line, "coordinates")[:1]]
    notes = ["its lines are joined to one route"] if len(parts) > 1 else []
    return replace(waypoint_track(_positions(parts), [_time(place)], ()), notes=notes)


def _of_track(place: ElementTree.Element) -> ParsedTrack | None:
    """Return the route along a track of Google's extension; None where there is none."""
    coords = _named(place, "coord")
    if not coords:
        return None
    texts = [(element.text or "").split() for element in coords]
    positions = [position_of(*_pair(values, i)[::-1], i) for i, values in enumerate(texts, start=1)]
    times = [element.text for element in _named(place, "when") if element.text]
    return waypoint_track(positions, times, ())


def _positions(elements: Iterable[ElementTree.Element]) -> list[Position]:
    """Return the positions in elements of coordinates, without those at once repeated."""
    found: list[Position] = []
    for element in elements:
        for text in (element.text or "").split():
            number = len(found) + 1
            lon, lat = _pair(text.split(","), number)
            position = position_of(lat, lon, number)
            if not found or position != found[-1]:
                found.append(position)
    return found


def _pair(values: list[str], number: int) -> tuple[str, str]:
    """Return longitude and latitude of the numbered waypoint (from 1) as texts."""
    if len(values) in (2, 3):
        return values[0], values[1]
    raise InputError(
        f"Waypoint {number} of the KML has {len(values)} value{'' if len(values) == 1 else 's'}.",
        "A position is longitude, latitude and perhaps an altitude, with commas between them.",
        "Check that the file is complete.",
        waypoint=number,
    )


def _extended_data(place: ElementTree.Element) -> dict[str, str]:
    """Return the extended data of a placemark, by name."""
    return {
        str(data.get("name")): (value.text or "").strip()
        for data in _named(place, "Data")
        for value in _named(data, "value")[:1]
    }


def _time(place: ElementTree.Element) -> str | None:
    """Return the time stamp of a placemark."""
    stamps = _named(place, "TimeStamp")
    return next((e.text for stamp in stamps for e in _named(stamp, "when") if e.text), None)


def _named(element: ElementTree.Element, name: str) -> list[ElementTree.Element]:
    """Return the elements of a name in an element, in any namespace."""
    return [one for one in element.iter() if local_name(one) == name]
