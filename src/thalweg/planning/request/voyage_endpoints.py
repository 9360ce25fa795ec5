"""End points of a voyage: from text or degrees to navigable water."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.approach_choices import approach_choices, may_leave_early
from thalweg.chart.approaches import PortApproach
from thalweg.chart.ports import PORTS, Port
from thalweg.core.errors import InputError, errors_about
from thalweg.core.geodesy import (
    distance,
    format_position,
    format_position_minutes,
    parse_position,
)
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.joined_approach import joined_ways
from thalweg.planning.request.swapped_degrees import (
    NEAR_PORT,
    check_order_of_degrees,
    errors_on_swapped_degrees,
    swap_hint,
    swap_notice,
)
from thalweg.planning.voyage_parts import Place, checked_place

#: Greatest distance that a position is moved [m]; coastlines are generalised.
MAX_SNAP_POSITION = 2_000.0
#: The same for ports without an approach [m]; harbours are on land at every resolution.
MAX_SNAP_PORT = 60_000.0
NOT_REACHED: Final = "Does not reach"  #: a note on a port far from the end of the route begins so
OTHER_NAME: Final = "A former or local name of"  #: a note on the name of a port begins so
#: A port moved farther than this [m] is not reached: the end of the route has no port's name.
_REACHED: Final = 2.0 * NAUTICAL_MILE
#: Voyages shorter than this [m], or than the way to the sea or a canal, do not follow one.
_SHORT_VOYAGE: Final = 20.0 * NAUTICAL_MILE
_OWN_CHART: Final = (
    "Lakes and inland seas (the Great Lakes, the Caspian Sea) are land on the world's coastline: "
    "voyages there need a chart of your own, in Python (Chart.from_geojson)."
)


@dataclass(frozen=True)
class Endpoint:
    """An end point of a voyage on navigable water.

    Attributes
    ----------
    name : Name and country of the port ("Sydney, AU"), or the position as text.
    lat, lon : Position used [deg]; of a port with an approach its sea end.
    moved_distance_m : Distance moved to navigable water [m].
    given_position : (lat, lon), optional
        Requested position [deg], where it was moved.
    is_port : Whether the end point is a port.
    why : Reason for moving it.
    remedy : What the user can do to have it reached, a sentence, or empty.
    way_left_m : Least length of the way between this position and the berth [m]; 0 if unknown.
    approach : The approach from the berth to this position.
    other_ways : Other ways from the berth, by branches of the approach and to canals.
    may_leave_early : Whether the approach comes off land well before its sea end.
    notice : A further note for the user, or empty.
    """

    name: str
    lat: float
    lon: float
    moved_distance_m: float
    given_position: tuple[float, float] | None = None
    is_port: bool = False
    why: str = "on charted land"
    remedy: str = ""
    way_left_m: float = 0.0
    approach: PortApproach | None = None
    notice: str = ""
    other_ways: tuple[PortApproach, ...] = ()
    may_leave_early: bool = False

    @property
    def ways(self) -> tuple[PortApproach, ...]:
        """The approach and the other ways; none where the port has no approach."""
        return (self.approach, *self.other_ways) if self.approach is not None else ()

    def by(self, way: PortApproach) -> Endpoint:
        """Return the end point by another way from its berth."""
        lat, lon = way.sea_end
        others = tuple(other for other in self.ways if other is not way)
        return replace(self, lat=lat, lon=lon, approach=way, other_ways=others)

    @property
    def origin(self) -> tuple[float, float]:
        """Requested position (lat, lon) [deg]."""
        return self.given_position or (self.lat, self.lon)

    @property
    def note(self) -> str:
        """A note for the user where the position was moved, else empty."""
        moved, miles = "", self.moved_distance_m / NAUTICAL_MILE
        if not self.is_reached:
            left = max(self.way_left_m, self.moved_distance_m) / NAUTICAL_MILE
            moved = (
                f"{NOT_REACHED} {self.name}, which is {self.why}: the plan has "
                f"{format_position_minutes(self.lat, self.lon)} instead, {miles:.0f} nm away. At "
                f"least {left:.0f} nm by sea are missing in all totals. {self.remedy}"
            ).strip()
            return " ".join(text for text in (moved, self.notice) if text)
        if self.moved_distance_m >= 1.0:
            moved = (
                f"{self.name} is {self.why}: moved {miles:.1f} nm "
                f"to open water at {format_position(self.lat, self.lon)}; the totals begin and end "
                "there."
            )
        return " ".join(text for text in (self.notice, moved) if text)

    @property
    def is_reached(self) -> bool:
        """Whether the position is the place itself or near it."""
        return self.moved_distance_m <= _REACHED

    @property
    def true_name(self) -> str:
        """Name of the position: that of the place if it is reached, else degrees and a distance."""
        if self.is_reached:
            return self.name
        place = format_position_minutes(self.lat, self.lon)
        return f"{place}, {self.moved_distance_m / NAUTICAL_MILE:.0f} nm from {self.name}"


def resolve_endpoint(place: Place, chart: Chart, what: str) -> Endpoint:
    """Resolve a place to navigable water of a chart.

    A port is moved to the sea end of its approach, where the chart has approaches. A position on
    land or in enclosed water is moved to water joined to the sea within `MAX_SNAP_POSITION`, or
    taken as the nearest port within `NEAR_PORT`.

    Raises
    ------
    InputError : If the port is unknown (with near matches) or cannot be reached, or the place is on
        land or in enclosed water and too far from the sea.
    """
    if isinstance(place, str):
        position = parse_position(place)
        if position is None:
            return _resolve_name(place, chart, what)
    else:
        position = place
    return _resolve_position(*position, chart, what)


def _resolve_name(name: str, chart: Chart, what: str) -> Endpoint:
    """Return the sea end of the port of a name, with a note where its own name is unlike that."""
    port = PORTS.lookup(name)
    end = resolve_port(port, chart, what)
    if not PORTS.is_unlike(name, port):
        return end
    return replace(end, notice=f"{OTHER_NAME} {port}: {name.strip()}. See that it is meant.")


def resolve_port(port: Port, chart: Chart, what: str) -> Endpoint:
    """Return the sea end of a port, or the nearest water on a chart without its approach.

    Parameters
    ----------
    what : What the port is, for messages.

    Raises
    ------
    InputError : If the port cannot be reached on the chart.
    """
    ways = _usable_ways(port, chart)
    if ways:
        first, others = ways[0], tuple(ways[1:])
        return Endpoint(
            port.label,
            *first.sea_end,
            0.0,
            is_port=True,
            approach=first,
            other_ways=others,
            may_leave_early=may_leave_early(first, chart.coastline),
        )
    reason = "" if chart.approaches is None else chart.approaches.reason(port)
    if reason:
        raise InputError(
            f"The {what} {port.label} cannot be reached from the sea on this chart.",
            f"Reason: {reason}.",
            "Choose another port, or a position at sea. " + _OWN_CHART,
        )
    found = _snap_to_water(port.label, port.lat, port.lon, chart, what, MAX_SNAP_PORT)
    return replace(found, is_port=True)


def _usable_ways(port: Port, chart: Chart) -> list[PortApproach]:
    """Return the ways from a port whose sea ends are water of the chart and that no zone closes."""
    approach = None if chart.approaches is None else chart.approaches.of(port)
    if approach is None:
        return []
    ways = approach_choices(approach, chart.canals, chart.passages)
    return [way for way in ways if _is_usable(way, chart)]


def _is_usable(way: PortApproach, chart: Chart) -> bool:
    if not bool(chart.is_navigable(*way.sea_end)):
        return False
    (lat, lon) = zip(*way.line)
    return not chart.crosses_no_go_zone(lat[:-1], lon[:-1], lat[1:], lon[1:]).any()


def _resolve_position(lat: float, lon: float, chart: Chart, what: str) -> Endpoint:
    """Return a position on water as it is; one on land or in enclosed water is moved."""
    name = format_position(lat, lon)
    on_water = bool(chart.is_navigable(lat, lon))
    if on_water and chart.is_joined_to_sea(lat, lon):
        return Endpoint(name, lat, lon, 0.0, notice=swap_notice(lat, lon, chart))
    near = (
        None if chart.approaches is None else chart.approaches.nearest(lat, lon, within=NEAR_PORT)
    )
    water = chart.nearest_navigable(lat, lon, largest=MAX_SNAP_POSITION)
    if near is not None and (water is None or near[1] <= water[2]):
        port = resolve_port(near[0], chart, what)
        kind = "in enclosed water" if on_water else "on charted land"
        miles = near[1] / NAUTICAL_MILE
        return replace(
            port, notice=f"{name} is {kind}, {miles:.1f} nm from {port.name}: that port is used."
        )
    return _snap_to_water(name, lat, lon, chart, what, MAX_SNAP_POSITION)


def _snap_to_water(
    name: str, lat: float, lon: float, chart: Chart, what: str, limit: float
) -> Endpoint:
    if bool(chart.is_navigable(lat, lon)) and chart.is_joined_to_sea(lat, lon):
        return Endpoint(name, lat, lon, 0.0)
    found = chart.nearest_navigable(lat, lon, largest=MAX_SNAP_PORT)
    if found is not None and found[2] <= limit:
        return Endpoint(
            name, float(found[0]), float(found[1]), float(found[2]), given_position=(lat, lon)
        )
    port = _nearest_port_text(lat, lon, chart)
    if found is None:
        raise InputError(
            f"The {what} {name} is not on navigable water.",
            f"There is none within {MAX_SNAP_PORT / NAUTICAL_MILE:.0f} nm on this chart." + port,
            "Give that port by name, or a position at sea."
            if port
            else swap_hint(lat, lon, chart)
            or "Choose another position, or a chart that covers it."
            + ("" if chart.approaches is None else f" {_OWN_CHART}"),
        )
    near_lat, near_lon, moved = found
    raise InputError(
        f"The {what} {name} is on land or in enclosed water.",
        f"The nearest navigable water is {moved / NAUTICAL_MILE:.1f} nm away, at "
        f"{format_position(near_lat, near_lon)}." + port,
        "Give that position, or " + ("that port by name." if port else "a port by name."),
    )


def _nearest_port_text(lat: float, lon: float, chart: Chart) -> str:
    """Return a sentence on the nearest port, to follow another; empty where none is near."""
    if chart.approaches is None:
        return ""
    near = chart.approaches.nearest(lat, lon, within=MAX_SNAP_PORT)
    approach = near and chart.approaches.of(near[0])
    if not (near and approach):
        return ""
    return (
        f" The nearest port is {near[0].label}, {near[1] / NAUTICAL_MILE:.1f} nm away; its "
        f"approach meets the open sea at {format_position(*approach.sea_end)}."
    )


def resolve_places(
    start: Place, via: Sequence[Place], goal: Place, chart: Chart, *, joins: bool = True
) -> list[Endpoint]:
    """Resolve the places of a voyage in order to navigable water of a chart.

    Parameters
    ----------
    joins : Whether a start and a goal in a harbour follow the approach that passes them; not so in
        voyages that keep no offing, which take the water of the chart as it is.

    Raises
    ------
    InputError
        As of `resolve_endpoint`, if two places in succession are the same, or if latitude and
        longitude of the ends are swapped.
    """
    start, goal = checked_place(start, "start", "start"), checked_place(goal, "goal", "goal")
    check_order_of_degrees(start, goal, chart)
    places = [("start", "start", start)]
    places += [(f"via.{k}", f"via point {k + 1}", place) for k, place in enumerate(via)]
    ends = []
    for entry, what, place in [*places, ("goal", "goal", goal)]:
        others = [start, *via, goal]
        others.remove(place)
        with errors_about(entry), errors_on_swapped_degrees(place, others, chart):
            ends.append(resolve_endpoint(place, chart, what))
    if joins:
        apart = float(distance(*ends[0].origin, *ends[-1].origin))
        ends[0], ends[-1] = (along_approach(end, chart, apart) for end in (ends[0], ends[-1]))
    ends = [ends[0], *map(without_approach, ends[1:-1]), ends[-1]]
    for first, second in itertools.pairwise(ends):
        check_distinct(first, second)
    return ends


def along_approach(end: Endpoint, chart: Chart, apart: float) -> Endpoint:
    """Return the end of a voyage at a position in a harbour by the approach that passes it.

    Parameters
    ----------
    apart : Distance between the ends [m]; where it is short the ship may not go to sea at all.
    """
    if end.is_port:
        return end
    ways = joined_ways(end.lat, end.lon, chart)
    if not ways or apart < max(_SHORT_VOYAGE, min(way.length for way in ways)):
        return end
    approach = ways[0]
    ways = [way for way in ways if _is_usable(way, chart)]
    if not ways:
        return end
    place = "beside"
    if end.given_position is not None:
        miles = end.moved_distance_m / NAUTICAL_MILE
        moved = f"moved {miles:.1f} nm to {format_position(end.lat, end.lon)}"
        place = f"{end.why}: {moved}, beside"
    notice = f"{end.name} is {place} the approach of {approach.port.label}, which the ship follows."
    return replace(
        end,
        lat=ways[0].sea_end[0],
        lon=ways[0].sea_end[1],
        moved_distance_m=0.0,
        given_position=None,
        approach=ways[0],
        other_ways=tuple(ways[1:]),
        may_leave_early=may_leave_early(ways[0], chart.coastline),
        notice=" ".join(text for text in (end.notice, notice) if text),
    )


def without_approach(end: Endpoint) -> Endpoint:
    """Return a via point: a port that is passed off its sea end, not entered."""
    if end.approach is None:
        return end
    notice = (
        f"The ship passes {end.name} at {format_position(end.lat, end.lon)} and does not enter it: "
        "give each leg of a voyage with calls as a voyage of its own."
    )
    return replace(
        end,
        approach=None,
        other_ways=(),
        may_leave_early=False,
        notice=" ".join(t for t in (end.notice, notice) if t),
    )


def check_distinct(start: Endpoint, goal: Endpoint) -> None:
    """Raise `InputError` if two end points are the same place."""
    ways = start.approach, goal.approach
    same_port = ways[0] is not None and ways[1] is not None and ways[0].port == ways[1].port
    same_port &= start.is_port and goal.is_port  # positions beside the approach of one port differ
    apart = float(distance(start.lat, start.lon, goal.lat, goal.lon))
    if same_port or (apart < 1.0 and not (start.approach and goal.approach)):
        raise InputError(
            f"{start.name} and {goal.name} are the same place.",
            "Two places in succession are at least 1 m apart.",
            "Choose two different places.",
        )
