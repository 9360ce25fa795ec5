"""Reading of S-421 (IEC 63173-1), the route plan of the S-100 family; experimental.

Elements are found by name: edition 1.0, its drafts and the drafts of edition 2.0, whose names begin
in lower case and whose values are attributes, are read alike.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.route.formats.parsed_track import (
    ParsedTrack,
    WaypointOrder,
    position_of,
    stated_moments,
    waypoint_order,
)
from thalweg.route.formats.rtz_writer import MANUFACTURER
from thalweg.route.formats.xml_elements import children, local_name, parse_xml

_LINES = {"1": True, "loxodrome": True, "2": False, "orthodrome": False}


def parse_s421(data: bytes) -> ParsedTrack:
    """Read the route of an S-421 file.

    Returns
    -------
    ParsedTrack : Legs are rhumb lines unless they are orthodromes. The departure is that of the
        first schedule element of the first waypoint that has one.

    Raises
    ------
    InputError : If it is too large, not XML, declares entities, or holds no route or several.
    """
    root = parse_xml(data, "S-421 file")
    features = _features_of(root)
    by_name = {name: e for e in root.iter() if (name := _attribute(e, "id"))}
    waypoints = _in_order(features, by_name)
    if len(waypoints) < 2 or len(features.get("route", [])) > 1:
        raise InputError(
            f"The GML holds {len(features.get('route', []))} S-421 routes and {len(waypoints)} "
            "waypoints.",
            "One route of S-421 with two or more waypoints is read.",
            "Export one route as S-421, or as RTZ.",
        )
    notes: list[str] = []
    positions = [_position(waypoint, i) for i, waypoint in enumerate(waypoints, start=1)]
    stays, times = _schedule(features, waypoints)
    first_time = None if math.isnan(times[0]) else times[0]
    orders = [_order(w, i, stay) for i, (w, stay) in enumerate(zip(waypoints, stays), start=1)]
    if first_time is not None:
        first_time -= orders[0].wait  # the departure of the schedule comes after the wait
        times[0] = first_time
    rhumb = [_is_rhumb(waypoint, by_name, notes) for waypoint in waypoints[1:]]
    notes = list(dict.fromkeys(notes))
    return ParsedTrack(positions, first_time, orders, rhumb, notes, times=times)


def _features_of(root: ElementTree.Element) -> dict[str, list[ElementTree.Element]]:
    """Return the features and information types by name in lower case; references are none."""
    features: dict[str, list[ElementTree.Element]] = {}
    for element in root.iter():
        if _attribute(element, "href") is None:
            features.setdefault(local_name(element).casefold(), []).append(element)
    return features


def _in_order(
    features: Mapping[str, list[ElementTree.Element]], by_name: Mapping[str, ElementTree.Element]
) -> list[ElementTree.Element]:
    """Return the waypoints as the route lists them, or as they stand in the file."""
    waypoints = features.get("routewaypoint", [])
    groups = features.get("routewaypoints", [])
    listed = [e for group in groups for e in children(group, "routeWaypoint")]
    names = [(_attribute(e, "href") or "").lstrip("#") for e in listed]
    if names and all(name in by_name for name in names) and len(set(names)) == len(waypoints):
        return [by_name[name] for name in names]
    return waypoints


def _position(waypoint: ElementTree.Element, number: int) -> tuple[float, float]:
    text = next((e.text or "" for e in waypoint.iter() if local_name(e) == "pos"), "")
    lat, _, lon = text.strip().partition(" ")
    return position_of(lat, lon.strip(), number)


def _is_rhumb(
    waypoint: ElementTree.Element, by_name: Mapping[str, ElementTree.Element], notes: list[str]
) -> bool:
    """Return whether the leg that ends at a waypoint is a rhumb line."""
    leg = next(children(waypoint, "routeWaypointLeg"), None)
    if leg is not None and (target := _attribute(leg, "href")):
        leg = by_name.get(target.lstrip("#"))
    if leg is None:
        notes.append("a waypoint has no leg: a rhumb line is used")
        return True
    kind = _value(leg, "routeWaypointLegGeometryType") or "1"
    if kind.casefold() not in _LINES:
        notes.append(f"a leg has the geometry {kind!r}: a rhumb line is used")
    return _LINES.get(kind.casefold(), True)


def _schedule(
    features: Mapping[str, list[ElementTree.Element]], waypoints: list[ElementTree.Element]
) -> tuple[list[float], list[float]]:
    """Return the stays at the waypoints [s], and the departure and the arrivals there.

    Of each the first stated one [s since 1970-01-01T00:00Z]; NaN where it is not known.
    """
    number_of = {
        _value(waypoint, "routeWaypointID"): n
        for n, waypoint in reversed(list(enumerate(waypoints)))
    }
    inside = {id(e): n for n, w in enumerate(waypoints) for e in w.iter()}
    stays, times = [0.0] * len(waypoints), [math.nan] * len(waypoints)
    for element in features.get("routescheduleelement", []):
        key = _value(element, "routeWaypointId") or _value(element, "routeWaypointID")
        number = inside.get(id(element), number_of.get(key))
        eta, etd = (_value(element, f"routeScheduleElement{end}") for end in ("ETA", "ETD"))
        if number == 0 and etd and math.isnan(times[0]):
            times[0] = parse_time(etd)
        elif number and math.isnan(times[number]):
            times[number] = stated_moments([eta])[0]
        if number is not None and 0 < number < len(waypoints) - 1 and eta and etd:
            stays[number] = stays[number] or max(0.0, parse_time(etd) - parse_time(eta))
    return stays, times


def _order(waypoint: ElementTree.Element, number: int, stay: float) -> WaypointOrder:
    """Return the wait and the ordered speed: those of our own extension, else the stay."""
    own: dict[str, object] = {}
    for extension in children(waypoint, "routeWaypointExtensions"):
        if _attribute(extension, "routeExtensionsManufacturerId") == MANUFACTURER:
            note = _value(extension, "routeExtensionsNote") or ""
            own |= dict(part.split("=", 1) for part in note.split() if "=" in part)
    return waypoint_order({"waiting_s": stay or None} | own, number)


def _value(element: ElementTree.Element, name: str) -> str | None:
    """Return a value that is a child in edition 1.0 and an attribute in the drafts of 2.0."""
    child = next(children(element, name), None)
    text = element.get(name) if child is None else child.text
    return text.strip() if text else None


def _attribute(element: ElementTree.Element, name: str) -> str | None:
    """Return an attribute by its name without namespace."""
    if not element.attrib:
        return None
    return next((v for k, v in element.attrib.items() if k.rpartition("}")[2] == name), None)
