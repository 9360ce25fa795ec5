"""Routes as KML 2.2 (OGC 07-147r2): a line and one placemark per waypoint, for maps and globes.

KML is written, not read: it holds pictures of routes, without waits and orders.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.geojson_format import line_parts
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.formats.xml_elements import write_xml
from thalweg.route.route import Route

_NAMESPACE = "http://www.opengis.net/kml/2.2"


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
    ends = f"{options.start} to {options.goal}" if options.start and options.goal else ""
    _add(document, "name", ends or "Thalweg route")
    style = ElementTree.SubElement(document, "Style", {"id": "route"})
    line = ElementTree.SubElement(style, "LineStyle")
    _add(line, "color", "ffb25d1f")  # aabbggrr
    _add(line, "width", "3")
    whole = ElementTree.SubElement(document, "Placemark")
    _add(whole, "name", ends or "Route")
    _add(whole, "styleUrl", "#route")
    lines = ElementTree.SubElement(whole, "MultiGeometry")
    for part in line_parts(route, options.decimals):
        drawn = ElementTree.SubElement(lines, "LineString")
        _add(drawn, "tessellate", "1")
        _add(drawn, "coordinates", " ".join(f"{lon!r},{lat!r}" for lon, lat in part))
    for row in file_route(route, options).rows:
        place = ElementTree.SubElement(document, "Placemark")
        _add(place, "name", row["name"])
        facts = [f"{row[name]:g} {unit}" for name, unit in _FACTS.items() if row.get(name)]
        _add(place, "description", ", ".join(facts))
        if row["time"] is not None:
            _add(ElementTree.SubElement(place, "TimeStamp"), "when", row["time"])
        point = ElementTree.SubElement(place, "Point")
        _add(point, "coordinates", f"{row['lon']!r},{row['lat']!r}")
    write_xml(root, path)


#: Values of waypoints in their descriptions, with their units.
_FACTS = {
    "course_deg": "degrees course",
    "speed_over_ground_kn": "kn over ground",
    "waiting_h": "h of waiting",
}


def _add(parent: ElementTree.Element, name: str, text: str) -> None:
    ElementTree.SubElement(parent, name).text = text
