"""What an RTZ file has otherwise than the standard, beyond what makes it unreadable.

The rules are those of the schemas and of IEC 61174 annex S: identifiers, revisions, extensions, the
period of validity, and schedules that fit the waypoints and the order of time.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from xml.etree import ElementTree

from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.route.formats.rtz_writer import RTZ_NAMESPACE
from thalweg.route.formats.xml_elements import children, local_name

_DURATION = re.compile(r"^P(?:(\d+)D)?(?:T(?:(\d+)H)?(?:(\d+)M)?(?:(\d+(?:\.\d*)?)S)?)?$")
_CLOCK = re.compile(r"^(\d{1,2}):(\d{2}):(\d{2})")
_SCHEDULE_ELEMENTS = ("scheduleElement", "sheduleElement")  # the schema of 1.0 has the second
_SAME_STAY = 60.0  # difference of stated and scheduled stays that counts [s]


def rtz_notes(root: ElementTree.Element, waypoints: list[ElementTree.Element]) -> list[str]:
    """Return what a file has otherwise than the standard, in words.

    Parameters
    ----------
    root, waypoints : The route, and its waypoints in order.
    """
    return [
        *_version_notes(root),
        *_waypoint_notes(root, waypoints),
        *_validity_notes(root),
        *_extension_notes(root),
        *_schedule_notes(root, waypoints),
    ]


def schedule_elements(schedule: ElementTree.Element, kind: str) -> list[ElementTree.Element]:
    """Return the elements of a schedule, ``manual`` or ``calculated``."""
    parts = [element for group in children(schedule, kind) for element in group]
    return [element for element in parts if local_name(element) in _SCHEDULE_ELEMENTS]


def stated_stay(element: ElementTree.Element) -> float | None:
    """Return the stay that an element of a schedule states [s]; None if it states none."""
    text = str(element.get("stay", "")).strip()
    if (match := _DURATION.match(text)) is not None:
        days, hours, minutes, seconds = (float(part or 0.0) for part in match.groups())
        return 86_400.0 * days + 3_600.0 * hours + 60.0 * minutes + seconds
    if (match := _CLOCK.match(text)) is not None:
        hours, minutes, seconds = (float(part) for part in match.groups())
        return 3_600.0 * hours + 60.0 * minutes + seconds
    return None


def stated_time(element: ElementTree.Element, name: str) -> float:
    """Return a time [s since 1970-01-01T00:00Z]; NaN where there is none, or none that exists."""
    text = element.get(name)
    if not text:
        return math.nan
    try:
        return parse_time(text)
    except InputError:
        return math.nan


def _version_notes(root: ElementTree.Element) -> list[str]:
    version = str(root.get("version", "none"))
    namespace = str(root.tag).partition("}")[0].lstrip("{") if "}" in str(root.tag) else "none"
    if namespace == RTZ_NAMESPACE + version.rpartition(".")[2] and version.startswith("1."):
        return []
    return [f"the version is {version} and the namespace {namespace}, which do not belong together"]


def _waypoint_notes(root: ElementTree.Element, waypoints: list[ElementTree.Element]) -> list[str]:
    notes = []
    names = [waypoint.get("id") for waypoint in waypoints]
    if len(set(names)) < len(names) or None in names:
        notes.append("waypoints have no id, or the id of another one: their order is used")
    revisions = [waypoint.get("revision") for waypoint in waypoints]
    if root.get("version") == "1.2" and None in revisions:
        notes.append("waypoints have no revision, which version 1.2 requires")
    wrong = [text for text in revisions if text is not None and not text.strip().isdecimal()]
    if wrong:
        notes.append(f"a waypoint has the revision {wrong[0]!r}; revisions are 0 or more")
    return notes


def _validity_notes(root: ElementTree.Element) -> list[str]:
    notes = []
    for info in children(root, "routeInfo"):
        start, stop = (stated_time(info, f"validityPeriod{end}") for end in ("Start", "Stop"))
        if start > stop:
            notes.append("its period of validity ends before it begins")
    return notes


def _extension_notes(root: ElementTree.Element) -> list[str]:
    outside = any(
        next(children(element, "extension"), None) is not None
        for element in root.iter()
        if len(element) and local_name(element) != "extensions"
    )
    return ["an extension is not inside an element extensions: it is not used"] if outside else []


def _schedule_notes(root: ElementTree.Element, waypoints: list[ElementTree.Element]) -> list[str]:
    number_of = {waypoint.get("id"): n for n, waypoint in reversed(list(enumerate(waypoints)))}
    notes = []
    for group in children(root, "schedules"):
        for schedule in children(group, "schedule"):
            for kind in ("manual", "calculated"):
                parts = schedule_elements(schedule, kind)
                notes += [
                    f"the {kind} schedule {schedule.get('id', '')!r} {text}"
                    for text in _faults_of_schedule(parts, number_of, kind == "calculated")
                ]
    return notes


def _faults_of_schedule(
    parts: list[ElementTree.Element], number_of: Mapping[str | None, int], whole: bool
) -> list[str]:
    """Return what is wrong with the elements of one schedule.

    Parameters
    ----------
    number_of : Numbers of the waypoints by their ids.
    whole : Whether it must name every waypoint.
    """
    if not parts:
        return []
    faults = []
    unknown = [name for e in parts if (name := e.get("waypointId")) not in number_of]
    if unknown:
        faults.append(f"names the waypoint {unknown[0]!r}, which the route does not have")
    rows = [(number_of[e.get("waypointId")], e) for e in parts if e.get("waypointId") in number_of]
    numbers = [number for number, _ in rows]
    if numbers != sorted(numbers):
        faults.append("is not in the order of the waypoints")
    if whole and not unknown and len(set(numbers)) < len(number_of):
        faults.append("does not name every waypoint")
    rows.sort(key=lambda row: row[0])
    times = [(stated_time(e, "eta"), stated_time(e, "etd")) for _, e in rows]
    for (_, element), pair in zip(rows, times):
        for name, time in zip(("eta", "etd"), pair):
            if element.get(name) and math.isnan(time):
                faults.append(f"has the time {element.get(name)!r}, which does not exist")
    known = [time for pair in times for time in pair if not math.isnan(time)]
    if known != sorted(known):
        faults.append("has a time before that of an earlier waypoint")
    for (_, element), (eta, etd) in zip(rows, times):
        stay, scheduled = stated_stay(element), etd - eta
        if element.get("stay") and stay is None:
            faults.append(f"has the stay {element.get('stay')!r}, which is not understood")
        elif stay is not None and abs(scheduled - stay) > _SAME_STAY:
            faults.append(
                f"states a stay of {stay / 60.0:g} min where {scheduled / 60.0:g} min are "
                "scheduled: the stay is used"
            )
    return list(dict.fromkeys(faults))
