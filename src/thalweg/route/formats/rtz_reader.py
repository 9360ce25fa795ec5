"""Reading of RTZ, the route exchange format of IEC 61174; also inside a ZIP (``.rtzp``).

The elements are found by name, whatever their namespace and version; what a file has otherwise than
the standard is noted. A leg is a rhumb line unless it is marked ``Orthodrome``.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.file_reading import too_large
from thalweg.core.geodesy import Position
from thalweg.core.given_numbers import to_number
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.carried_extensions import LEG_NUMBERS, LEG_TEXTS, Visit, visits_of
from thalweg.route.formats.parsed_track import (
    ParsedTrack,
    WaypointOrder,
    given_names,
    position_of,
    waypoint_order,
)
from thalweg.route.formats.route_file_options import LARGEST_FILE
from thalweg.route.formats.rtz_checks import rtz_notes, schedule_elements, stated_stay, stated_time
from thalweg.route.formats.rtz_extensions import rtz_extensions
from thalweg.route.formats.rtz_writer import MANUFACTURER, ORDER
from thalweg.route.formats.xml_elements import (
    NamespaceTreeBuilder,
    children,
    local_name,
    parse_xml,
)

_TEXT = re.compile(r".+", re.DOTALL)
_TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)?")
_WHOLE, _NUMBER = re.compile(r"\d+"), re.compile(r"\d+(\.\d*)?")
#: Attributes of ``routeInfo`` in all schemas, and the form of their values.
_FACTS: Final = {
    **dict.fromkeys(("routeAuthor", "routeStatus", "vesselName", "vesselVoyage"), _TEXT),
    **dict.fromkeys(("optimizationMethod", "routeChangesHistory"), _TEXT),
    **dict.fromkeys(("validityPeriodStart", "validityPeriodStop"), _TIME),
    **dict.fromkeys(("vesselMMSI", "vesselIMO", "vesselDisplacement", "vesselCargo"), _WHOLE),
    **dict.fromkeys(("vesselMaxRoll",), _WHOLE),
    **dict.fromkeys(("vesselGM", "vesselMaxWave", "vesselMaxWind", "vesselSpeedMax"), _NUMBER),
    **dict.fromkeys(("vesselServiceMin", "vesselServiceMax"), _NUMBER),
}


def parse_rtz(data: bytes) -> ParsedTrack:
    """Read the route of an RTZ file.

    Raises
    ------
    InputError : If it is not XML, declares entities, or is no route.
    """
    builder = NamespaceTreeBuilder()
    root = parse_xml(data, "RTZ", builder)
    notes: list[str] = []
    waypoints = [e for group in children(root, "waypoints") for e in children(group, "waypoint")]
    if local_name(root) != "route" or len(waypoints) < 2:
        count = "one waypoint" if len(waypoints) == 1 else "no waypoint"
        raise InputError(
            f"The RTZ has {count}." if local_name(root) == "route" else "The RTZ holds no route.",
            "A route is an element route with two or more waypoints.",
            "Export the whole route as RTZ.",
        )
    positions = [_position(waypoint, i, notes) for i, waypoint in enumerate(waypoints, start=1)]
    notes = [*rtz_notes(root, waypoints), *notes]
    first_time, stays, times = _schedule(root, waypoints, notes)
    orders = [_order(w, i, stay) for i, (w, stay) in enumerate(zip(waypoints, stays), start=1)]
    if first_time is not None:
        first_time -= orders[0].wait  # the departure of the schedule comes after the wait
        times[0] = first_time
    usual = [
        leg
        for group in children(root, "waypoints")
        for default in children(group, "defaultWaypoint")
        for leg in children(default, "leg")
    ]
    legs = [[*children(waypoint, "leg"), *usual] for waypoint in waypoints[1:]]
    rhumb = [_is_rhumb(leg, notes) for leg in legs]
    corridors = [_corridor(leg) for leg in legs]
    info = next(children(root, "routeInfo"), None)
    visits = visits_of(positions)
    return ParsedTrack(
        positions,
        first_time,
        orders,
        rhumb,
        list(dict.fromkeys(notes)),
        corridors,
        None if info is None else info.get("routeName"),
        replace(
            rtz_extensions(root, waypoints, visits, builder),
            info={} if info is None else _facts(info),
            names=given_names((w.get("name") for w in waypoints), visits),
            corridors={
                visit: sides
                for visit, sides in zip(visits[1:], corridors)
                if not (math.isnan(sides[0]) and math.isnan(sides[1]))
            },
            details=_details(root, waypoints, visits, legs),
        ),
        times=times,
    )


def parse_rtzp(data: bytes) -> ParsedTrack:
    """Read the RTZ file inside a ZIP.

    Raises
    ------
    InputError : If it is not a ZIP with one RTZ file in it, or that is too large.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = [i for i in archive.infolist() if i.filename.casefold().endswith(".rtz")]
            if len(members) == 1:
                with archive.open(members[0]) as file:
                    found = file.read(LARGEST_FILE + 1)
    except (zipfile.BadZipFile, zlib.error, RuntimeError, EOFError, OSError) as error:
        raise InputError(
            f"The RTZP cannot be read: {error}.",
            "It is a ZIP file with one RTZ file in it.",
            "Give the RTZ file itself.",
        ) from None
    if len(members) != 1:
        raise InputError(
            f"The RTZP holds {len(members)} RTZ files.",
            "It holds one.",
            "Give the RTZ file itself.",
        )
    if len(found) > LARGEST_FILE:
        raise InputError(*too_large("RTZ in the RTZP", LARGEST_FILE), "Reduce it to the route.")
    return parse_rtz(found)


def _position(waypoint: ElementTree.Element, number: int, notes: list[str]) -> Position:
    place = next(children(waypoint, "position"), None)
    found = {} if place is None else place.attrib
    texts = [str(found.get(name, "")).strip() for name in ("lat", "lon")]
    if any("," in text for text in texts):
        notes.append("positions have a decimal comma")
        texts = [text.replace(",", ".") for text in texts]
    return position_of(texts[0], texts[1], number)


def _is_rhumb(legs: list[ElementTree.Element], notes: list[str]) -> bool:
    """Return whether the leg that ends at a waypoint is a rhumb line."""
    kind = _leg_attribute(legs, "geometryType") or "Loxodrome"
    if str(kind) not in ("Loxodrome", "Orthodrome"):
        notes.append(f"a leg has the geometry {kind!r}: a rhumb line is used")
    return str(kind) != "Orthodrome"


def _facts(info: ElementTree.Element) -> dict[str, str]:
    """Return the attributes of a route but its name, as far as the schemas allow their values."""
    return {
        name: text
        for name, form in _FACTS.items()
        if (text := info.get(name, "").strip()) and form.fullmatch(text)
    }


def _details(
    root: ElementTree.Element,
    waypoints: list[ElementTree.Element],
    visits: list[Visit],
    legs: list[list[ElementTree.Element]],
) -> dict[Visit, dict[str, str]]:
    """Return the turn radius of each waypoint, and limits and texts of the leg that ends there.

    Parameters
    ----------
    legs : Of all waypoints but the first, the own legs and the default ones.
    """
    usual = [
        default
        for group in children(root, "waypoints")
        for default in children(group, "defaultWaypoint")
    ]
    found: dict[Visit, dict[str, str]] = {}
    for visit, waypoint, own in zip(visits, waypoints, [[], *legs]):
        values = {"radius": _leg_attribute([waypoint, *usual], "radius").strip()}
        values |= {name: _leg_attribute(own, name).strip() for name in (*LEG_NUMBERS, *LEG_TEXTS)}
        found[visit] = {
            name: text
            for name, text in values.items()
            if text and (name in LEG_TEXTS or _NUMBER.fullmatch(text))
        }
    return found if any(found.values()) else {}


def _leg_attribute(legs: list[ElementTree.Element], name: str) -> str:
    """Return an attribute of the first leg that has it: the own ones, then the default; or ''."""
    for leg in legs:
        if text := leg.get(name):
            return text
    return ""


def _corridor(legs: list[ElementTree.Element]) -> tuple[float, float]:
    """Return the cross-track limits (port, starboard) of the leg that ends at a waypoint [m]."""
    return _limit(legs, "portsideXTD"), _limit(legs, "starboardXTD")


def _limit(legs: list[ElementTree.Element], name: str) -> float:
    """Return a cross-track limit [m]; NaN where there is none, or none that the format allows."""
    miles = to_number(_leg_attribute(legs, name))
    return miles * NAUTICAL_MILE if 0.0 < miles < 10.0 else math.nan


def _schedule(
    root: ElementTree.Element, waypoints: list[ElementTree.Element], notes: list[str]
) -> tuple[float | None, list[float], list[float]]:
    """Return the departure, the stays at the waypoints [s] and the arrivals there [s since 1970].

    They are those of the first schedule with a departure; an unknown arrival is NaN.
    """
    stays = [0.0] * len(waypoints)
    number_of = {waypoint.get("id"): n for n, waypoint in reversed(list(enumerate(waypoints)))}
    schedules = [s for group in children(root, "schedules") for s in children(group, "schedule")]
    if len(schedules) > 1:
        notes.append(f"it has {len(schedules)} schedules: the first with a departure is used")
    for kind in ("manual", "calculated"):
        for schedule in schedules:
            parts = schedule_elements(schedule, kind)
            rows = {number_of[n]: e for e in parts if (n := e.get("waypointId")) in number_of}
            first = rows.get(0)
            if first is None or math.isnan(stated_time(first, "etd")):
                continue
            if any(row.get("speed") for row in rows.values()):
                notes.append(
                    "the speeds of its schedule are over ground and are not used; ordered speeds "
                    "through calm water are"
                )
            for number, row in rows.items():
                if 0 < number < len(waypoints) - 1:
                    stays[number] = _stay(row)
            depart = stated_time(first, "etd")
            known = {number: stated_time(row, "eta") for number, row in rows.items()} | {0: depart}
            return depart, stays, [known.get(k, math.nan) for k in range(len(waypoints))]
    return None, stays, []


def _stay(row: ElementTree.Element) -> float:
    """Return how long the ship stays at a waypoint of a schedule [s]."""
    stay = stated_stay(row)
    if stay is not None:
        return stay
    if row.get("eta") and row.get("etd"):
        scheduled = stated_time(row, "etd") - stated_time(row, "eta")
        return max(0.0, scheduled) if math.isfinite(scheduled) else 0.0
    return 0.0


def _order(waypoint: ElementTree.Element, number: int, stay: float) -> WaypointOrder:
    """Return the wait and the ordered speed: those of our own extension, else the stay."""
    own: Mapping[str, Any] = {}
    for group in children(waypoint, "extensions"):
        for extension in children(group, "extension"):
            if (extension.get("manufacturer"), extension.get("name")) == (MANUFACTURER, ORDER):
                own = extension.attrib
    return waypoint_order({"waiting_s": stay or None} | dict(own), number)
