"""Latitude and longitude in the wrong order, or a decimal comma: refusals and notes that say so."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, distance, format_position, parse_position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.voyage_parts import Place
from thalweg.route.carried_extensions import Visit

#: A position on land within this distance of a port is taken as that port [m].
NEAR_PORT: Final = 10.0 * NAUTICAL_MILE
CHECK_POSITION: Final = "Check the position"  #: a note on swapped degrees begins so
_NEAR_WATER: Final = 60_000.0  # [m]
_FAR_FROM_PORTS: Final = 60.0 * NAUTICAL_MILE
_SHORT_NAME: Final = 3  # letters of a waypoint that are no name of a port
_FAR_SHORTER: Final = 5.0  # times, where one end is swapped and the other is not
_ONE_COMMA: Final = re.compile(r"([+-]?\d+),(\d+)")
_SWAPPED: Final = "latitude and longitude swapped?"


@contextmanager
def errors_on_swapped_degrees(
    place: Place, others: Sequence[Place], chart: Chart
) -> Iterator[None]:
    """Add a hint to the refusal of a position that is near another place with its degrees swapped.

    Parameters
    ----------
    place : Degrees with letters (5.0N 61.6E) are taken as they are.
    others : The other places of the voyage.
    """
    try:
        yield
    except InputError as error:
        hint = "" if _SWAPPED in error.remedy else _hint_by_others(place, others, chart)
        hint = hint or _decimal_comma_hint(place)
        if not hint:
            raise
        raise InputError(error.asked, error.possible, hint, **error.details) from None


def _decimal_comma_hint(place: Place) -> str:
    """Return a question where two whole numbers may be one number with a decimal comma."""
    pair = _ONE_COMMA.fullmatch(place.strip()) if isinstance(place, str) else None
    if pair is None:
        return ""
    return (
        f"It is read as latitude {pair[1]}, longitude {pair[2]}. Was a decimal comma meant? Write "
        f"latitude and longitude with points, such as {pair[1]}.{pair[2]},3.6."
    )


def _hint_by_others(place: Place, others: Sequence[Place], chart: Chart) -> str:
    """Return a hint where the swapped position is at sea and far nearer to another place."""
    position, bare = _degrees_of(place)
    if position is None or not bare or abs(position[1]) > 90.0:
        return ""
    lat, lon = position
    known = [_position_of(other) for other in others]
    apart = [
        (float(distance(lat, lon, *other)), float(distance(lon, lat, *other)))
        for other in known
        if other is not None
    ]
    nearer = any(_FAR_SHORTER * swapped < given for given, swapped in apart)
    if not nearer or chart.nearest_navigable(lon, lat, largest=_NEAR_WATER) is None:
        return ""
    return (
        f"Latitude comes first: {lon:g}, {lat:g} is {format_position(lon, lat)}, near the other "
        f"places. Are {_SWAPPED}"
    )


def _position_of(place: Place) -> Position | None:
    """Return the position of a place; None for a name that is not known."""
    position, _ = _degrees_of(place)
    if position is not None:
        return position
    try:
        port = PORTS.lookup(str(place))
    except InputError:
        return None
    return port.lat, port.lon


def swap_hint(lat: float, lon: float, chart: Chart) -> str:
    """Return a hint where the swapped position is at sea or near a port; else empty."""
    if abs(lon) > 90.0:
        return ""
    if bool(chart.is_navigable(lon, lat)):
        return f"Latitude comes first: {lon:g}, {lat:g} is at sea. Are {_SWAPPED}"
    near = chart.approaches and chart.approaches.nearest(lon, lat, within=NEAR_PORT)
    if not near:
        return ""
    return f"Latitude comes first: {lon:g}, {lat:g} is near {near[0].label}. Are {_SWAPPED}"


def swap_notice(lat: float, lon: float, chart: Chart) -> str:
    """Return a note where a position is far from ports, but the swapped one is near a port."""
    ports = chart.approaches
    if ports is None or abs(lon) > 90.0 or ports.nearest(lat, lon, within=_FAR_FROM_PORTS):
        return ""
    swapped = ports.nearest(lon, lat, within=NEAR_PORT)
    if swapped is None:
        return ""
    return (
        f"{CHECK_POSITION}: {lat:g},{lon:g} is read as {format_position(lat, lon)}, more than "
        f"{_FAR_FROM_PORTS / NAUTICAL_MILE:.0f} nm from any port. {format_position(lon, lat)} is "
        f"{swapped[1] / NAUTICAL_MILE:.0f} nm from {swapped[0].label}: latitude comes first."
    )


def check_order_of_degrees(start: Place, goal: Place, chart: Chart) -> None:
    """Raise `InputError` if both ends are ports after swapping degrees, but not before.

    Degrees with letters (5.0N 61.6E) are taken as they are.
    """
    if chart.approaches is None:
        return
    given = [_degrees_of(place) for place in (start, goal)]
    swapped = [
        position is not None and bare and bool(swap_notice(*position, chart))
        for position, bare in given
    ]
    others = [p for (p, _), is_swapped in zip(given, swapped) if not is_swapped]
    at_ports = (p is None or chart.approaches.nearest(*p, within=NEAR_PORT) for p in others)
    if not any(swapped) or not all(at_ports):
        return
    as_given = [(PORTS.lookup(str(q)).lat, PORTS.lookup(str(q)).lon) if p is None else p
                for (p, _), q in zip(given, (start, goal))]  # fmt: skip
    turned = [p[::-1] if is_swapped else p for p, is_swapped in zip(as_given, swapped)]
    if not all(swapped) and not (
        _FAR_SHORTER * float(distance(*turned[0], *turned[1]))
        < float(distance(*as_given[0], *as_given[1]))
    ):
        return
    wrong = [p for p, is_swapped in zip(as_given, swapped) if is_swapped]
    read = " and ".join(format_position(*p) for p in wrong)
    meant = " and ".join(format_position(*p[::-1]) for p in wrong)
    raise InputError(
        f"Latitude and longitude seem to be swapped: no port is near {read}.",
        f"Latitude comes first, and a port is at {meant}.",
        f"Give {meant}; or, if they are meant as they stand, write them with letters: {read}.",
        field="start" if swapped[0] else "goal",
    )


def _degrees_of(place: Place) -> tuple[Position | None, bool]:
    """Return the position that a place states, None for names, and whether it has no letters."""
    if not isinstance(place, str):
        return (float(place[0]), float(place[1])), True
    return parse_position(place), not any(letter.isalpha() for letter in place)


def misplaced_name_notes(names: Mapping[Visit, str]) -> list[str]:
    """Return notes on waypoints that would be at the port of their name with another sign or order.

    Parameters
    ----------
    names : Of waypoints, by visit.
    """
    notes = []
    for (lat, lon, _), name in names.items():
        port = PORTS.find(name) if len(name) > _SHORT_NAME else None
        if port is None or float(distance(lat, lon, port.lat, port.lon)) < _FAR_FROM_PORTS:
            continue
        turned = {
            "with the other sign of the longitude": (lat, -lon),
            "with the other sign of the latitude": (-lat, lon),
            "with both other signs": (-lat, -lon),
            "with latitude and longitude swapped": (lon, lat),
        }
        for words, place in turned.items():
            if abs(place[0]) > 90.0:
                continue
            if float(distance(*place, port.lat, port.lon)) < _FAR_FROM_PORTS:
                notes.append(
                    f"{CHECK_POSITION} of the waypoint {name!r}, {format_position(lat, lon)}: "
                    f"{words} it would be at {port.label}."
                )
                break
    return notes
