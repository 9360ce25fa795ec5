"""The contents of a route file of any format, and the track made of them."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from thalweg.chart.canals import CANALS
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.geodesy import Position, check_position, parse_position
from thalweg.core.given_numbers import finite_number, shortened_repr, to_number
from thalweg.core.rhumb_lines import rhumb_pieces
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.units import DAY, HOUR, KNOT
from thalweg.route.carried_extensions import NO_EXTENSIONS, CarriedExtensions, Visit, visits_of
from thalweg.route.track import Track


@dataclass(frozen=True)
class ParsedTrack:
    """The contents of a route file.

    Attributes
    ----------
    positions : list of (lat, lon)
        In order [deg].
    first_time : [s since 1970-01-01T00:00Z]; None: not given.
    orders : By position; empty where the file has none.
    rhumb : By leg, whether it is a rhumb line; empty: all legs are geodesics.
    notes : What the file has otherwise than its format, and how it was read.
    corridors : By leg, the cross-track limits to port and starboard [m]; NaN: none. Empty: none.
    route_name : Where the format requires that the file has this name.
    extensions : Of other makers.
    leg_numbers : By leg, its number in the file, from 1; empty: legs are those of the file.
    times : By position, the stated arrival [s since 1970-01-01T00:00Z]; NaN: none. Empty: none.
    """

    positions: list[Position]
    first_time: float | None = None
    orders: list[WaypointOrder] = field(default_factory=list)
    rhumb: list[bool] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    corridors: list[tuple[float, float]] = field(default_factory=list)
    route_name: str | None = None
    extensions: CarriedExtensions = NO_EXTENSIONS
    leg_numbers: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)

    def all_notes(self, name: str) -> list[str]:
        """Return the notes of a file of a name."""
        if (self.route_name or "").casefold() in ("", PurePath(name).stem.casefold()):
            return self.notes
        return [*self.notes, f"its route is named {self.route_name!r}, not as the file"]


class WaypointOrder(NamedTuple):
    """How long to wait at a waypoint [s], and the calm-water speed ordered after it [m/s]."""

    wait: float = 0.0
    speed: float = math.nan


#: What files call the wait at a waypoint and the speed ordered from there on, with units in SI.
WAITS = {"waiting_h": HOUR, "wait_h": HOUR, "waiting_s": 1.0, "wait_s": 1.0}
SPEEDS = {"ordered_speed_kn": KNOT}
_WAIT_WORDS = {"wait", "waits", "waiting", "stay", "stop", "dwell"}
_SPEED_WORDS = {"speed", "speeds", "sog", "stw", "knots", "kn", "kts"}
_RESULTS = ("speed_through_water_kn", "speed_over_ground_kn")
GEOMETRY = "geometry"  #: what files call the kind of line of the leg after a waypoint
RHUMB_LINE, GREAT_CIRCLE = "RL", "GC"  #: kinds of lines in files of this package
_RHUMB_WORDS = ("rl", "rhumb", "rhumb line", "rhumbline", "loxodrome")
_GREAT_CIRCLE_WORDS = ("gc", "great circle", "greatcircle", "orthodrome", "geodesic", "")
RHUMB_DEVIATION = 20.0  #: rhumb lines are sailed as geodesics this close to them [m]
_LETTER = re.compile(r"\d.*[NSEWnsew]|[NSEWnsew].*\d")  # of a hemisphere, with digits
_NUMBERED = re.compile(r"WP \d+")  # names of this package
_SAME_BEND = 2e-5  # of a canal, as written in a file [deg]
LONGEST_WAIT = 366.0 * DAY  #: [s]


def waypoint_order(values: Mapping[str, object], number: int) -> WaypointOrder:
    """Return what a file orders at the numbered waypoint (from 1), by name; blanks are none.

    Parameters
    ----------
    number : Number of the waypoint, for messages.

    Returns
    -------
    WaypointOrder : Wait, setting and speed.

    Raises
    ------
    InputError : If a value is not a number, a wait negative or longer than a year, or a speed not
        above zero.
    """
    wait = _first_value(values, WAITS, f"wait at waypoint {number}")
    speed = _first_value(values, SPEEDS, f"ordered speed at waypoint {number}")
    if not (wait is None or 0.0 <= wait <= LONGEST_WAIT) or not (speed is None or speed > 0.0):
        raise InputError(
            f"Waypoint {number} waits {(wait or 0.0) / HOUR:g} h"
            + ("." if speed is None else f", with an ordered speed of {speed / KNOT:g} kn."),
            "Waits are zero or more and a year at most, speeds above zero.",
            "Correct them, or leave them empty.",
            waypoint=number,
        )
    return WaypointOrder(wait or 0.0, math.nan if speed is None else speed)


def waypoint_track(
    positions: list[Position],
    times: Sequence[TimeLike | None],
    given: Sequence[Mapping[str, object]],
) -> ParsedTrack:
    """Return the contents of a file with what it gives at each waypoint, by name.

    Parameters
    ----------
    times : Of the waypoints, of which the first is sailed; None or no text where the file has none.

    Raises
    ------
    InputError : If a time is before that of an earlier waypoint, or no time.
    """
    time = times[0] if times else None
    moments = stated_moments(times)
    for number, (value, moment) in enumerate(zip(times, moments), start=1):
        if math.isnan(moment) and value not in (None, ""):
            raise InputError(
                f"Waypoint {number} has {shortened_repr(value)}, which is not a time.",
                "Times are ISO 8601 in UTC, such as 2026-03-01T06:00Z.",
                "Correct it, or leave it empty.",
                waypoint=number,
            )
    _check_times_rise(moments)
    orders = [waypoint_order(values, i) for i, values in enumerate(given, start=1)]
    rhumb = [is_rhumb_line(values.get(GEOMETRY), i) for i, values in enumerate(given[:-1], start=1)]
    first = parse_time(time) if time not in (None, "") else None
    return ParsedTrack(positions, first, orders, rhumb, times=moments)


def stated_moments(times: Sequence[TimeLike | None]) -> list[float]:
    """Return times [s since 1970-01-01T00:00Z]; NaN where there is none, or what is no time.

    Parameters
    ----------
    times : Texts or times of a file.
    """
    found = []
    for value in times:
        try:
            found.append(math.nan if value is None or value == "" else parse_time(value))
        except InputError:
            found.append(math.nan)
    return found


def given_names(names: Iterable[str | None], visits: Sequence[Visit]) -> dict[Visit, str]:
    """Return the names of waypoints that are not mere numbers of this package, by visit."""
    named = ((visit, (name or "").strip()) for visit, name in zip(visits, names))
    return {visit: name for visit, name in named if name and not _NUMBERED.fullmatch(name)}


def carried_names(names: Iterable[str | None], positions: Sequence[Position]) -> CarriedExtensions:
    """Return the names of the waypoints of a file that are more than numbers, to be carried."""
    found = given_names(names, visits_of(positions))
    return CarriedExtensions(names={at: name for at, name in found.items() if not name.isdigit()})


def _check_times_rise(moments: Sequence[float]) -> None:
    """Refuse a time before that of an earlier waypoint.

    Parameters
    ----------
    moments : Of the waypoints [s since 1970-01-01T00:00Z]; NaN where there is none.

    Raises
    ------
    InputError : Names both waypoints.
    """
    latest, of = -math.inf, 0
    for number, moment in enumerate(moments, start=1):
        if math.isnan(moment):
            continue
        if moment < latest:
            raise InputError(
                f"Waypoint {number} of the route is at {format_time(moment)}, before waypoint {of} "
                f"at {format_time(latest)}.",
                "The times of a route rise from waypoint to waypoint.",
                "Correct the times, or the order of the waypoints.",
                waypoint=number,
            )
        latest, of = moment, number


def unused_column_notes(names: Iterable[str]) -> list[str]:
    """Return notes on speeds and waits of a file that are not used.

    Parameters
    ----------
    names : Of the columns; the speeds through water and over ground of files of this package are
        results, on which there is no note.

    Returns
    -------
    list of str : Empty where no speed and no wait is left out.
    """
    found = dict.fromkeys(names)
    speeds = [] if found.keys() & SPEEDS else [n for n in found if _is_speed(n)]
    waits = [] if found.keys() & WAITS else [n for n in found if _WAIT_WORDS & _words(n)]
    return [
        f"{' and '.join(unused)} {'is' if len(unused) == 1 else 'are'} not used: {rule}"
        for unused, rule in (
            (speeds, "the ship sails at its own speed, or at those of ordered_speed_kn "
                     "(through calm water)"),
            (waits, "the ship waits for the hours of waiting_h"),
        )
        if unused
    ]  # fmt: skip


def _is_speed(name: str) -> bool:
    words = _words(name)
    return name not in _RESULTS and bool(_SPEED_WORDS & words) and "wind" not in words


def _words(name: str) -> set[str]:
    return set(re.split(r"[^a-z]+", name.casefold()))


def is_rhumb_line(text: object, number: int) -> bool:
    """Return whether the leg that begins at the numbered waypoint (from 1) is a rhumb line.

    Parameters
    ----------
    text : What the file has: RL, rhumb or loxodrome; GC, great circle or orthodrome; blank is that.
    number : Number of the waypoint, for messages.

    Raises
    ------
    InputError : For another text.
    """
    word = str(text if text is not None else "").strip().casefold().replace("_", " ")
    if word in _RHUMB_WORDS or word in _GREAT_CIRCLE_WORDS:
        return word in _RHUMB_WORDS
    raise InputError(
        f"The geometry of the leg after waypoint {number} is {shortened_repr(text)}.",
        "It is RL (rhumb line) or GC (great circle).",
        "Correct it, or leave it empty.",
        waypoint=number,
    )


def _first_value(
    values: Mapping[str, object], names: Mapping[str, float], what: str
) -> float | None:
    """Return the value under the first of some names, in SI; None if there is none."""
    for name, unit in names.items():
        if values.get(name) not in (None, ""):
            return unit * finite_number(values[name], what, "Correct it, or leave it empty.")
    return None


def position_of(lat: object, lon: object, number: int) -> Position:
    """Return a checked position of the numbered waypoint (from 1).

    Parameters
    ----------
    lat, lon : Numbers or text in degrees, or texts with the letters of hemispheres, such as
        ``37 53.5N`` and ``23 35.0E``.
    number : Number of the waypoint, for messages.

    Returns
    -------
    (lat, lon) : Position [deg].
    """
    what = f"waypoint {number}"
    texts = [t for t in (lat, lon) if isinstance(t, str) and not math.isfinite(to_number(t))]
    lettered = [one for one in (lat, lon) if _LETTER.search(str(one))]
    if len(texts) == len(lettered) == 2 and (place := parse_position(" ".join(texts))):
        return check_position(*place, what)
    remedy = "Give degrees, such as 52.5, or both with letters, such as 37 53.5N and 023 35.0E."
    given = {"latitude": lat, "longitude": lon}
    without = sorted(given, key=lambda name: given[name] in lettered)  # is named first
    found = {name: finite_number(given[name], f"{name} of {what}", remedy) for name in without}
    return check_position(found["latitude"], found["longitude"], what)


def track_of(parsed: ParsedTrack, depart: TimeLike | None, name: str) -> Track:
    """Make a track from what a file held.

    Parameters
    ----------
    depart : Departure; None: that of the file.
    name : Name of the file, for messages.

    Raises
    ------
    InputError : For fewer than two different positions, or without any departure.
    """
    count = len(parsed.positions)
    if len(set(parsed.positions)) < 2:
        raise InputError(
            f"The route file {name!r} holds {count} waypoint{'s' * (count != 1)}.",
            "A route has at least two different ones.",
            "Give a file with the whole route.",
            file=name,
        )
    if depart is None and parsed.first_time is None:
        unused = [f" In the file, {one}." for one in parsed.notes if " time" in one]
        raise InputError(
            f"The route file {name!r} has no departure that can be used.{''.join(unused)}",
            "The departure is the time of its first waypoint, or an argument.",
            "Give a departure (depart, or --depart), such as 2026-01-01T06:00Z.",
            file=name,
            field="depart",
        )
    for note in [*parsed.all_notes(name), *_repeated(parsed)]:
        warnings.warn(ThalwegWarning(f"{name}: {note}."), stacklevel=3)
    start = parsed.first_time if depart is None else parse_time(depart)
    return _track(_with_geodesics(parsed), start)  # type: ignore[arg-type]


def _repeated(parsed: ParsedTrack) -> list[str]:
    rows = list(zip(parsed.positions, parsed.orders))  # none of a bare line
    at = [k for k in range(1, len(rows)) if rows[k][0] == rows[k - 1][0] and not rows[k][1].wait]
    text = "{} of its positions repeat the one before, first waypoint {}: they count once"
    return [text.format(len(at), at[0] + 1)] if at else []


def _with_geodesics(parsed: ParsedTrack) -> ParsedTrack:
    """Return the contents with rhumb lines broken into geodesics that keep close to them."""
    if not any(parsed.rhumb):
        return parsed
    orders = parsed.orders or [WaypointOrder()] * len(parsed.positions)
    limit = np.where(parsed.rhumb, RHUMB_DEVIATION, math.inf)
    lat, lon = np.array(parsed.positions).T
    lat, lon, leg = rhumb_pieces(lat, lon, limit)
    at_vertex = np.append(np.diff(leg, prepend=-1) > 0, True)
    given = [
        orders[k] if whole else WaypointOrder(0.0, orders[k].speed)
        for k, whole in zip([*leg.tolist(), len(orders) - 1], at_vertex.tolist())
    ]
    places = list(zip(lat.tolist(), lon.tolist()))
    number = (leg + 1).tolist()
    return replace(parsed, positions=places, orders=given, rhumb=[], leg_numbers=number)


def _track(parsed: ParsedTrack, depart: float) -> Track:
    """Merge repeated positions: their waits add up, the last of their speeds holds."""
    orders = parsed.orders or [WaypointOrder()] * len(parsed.positions)
    own = parsed.leg_numbers or range(1, len(orders))
    merged: list[tuple[Position, WaypointOrder]] = []
    number: list[int] = []  # of the leg that begins at each waypoint
    for place, order, leg in zip(parsed.positions, orders, [*own, 0]):
        if merged and merged[-1][0] == place:
            order = WaypointOrder(merged.pop()[1].wait + order.wait, order.speed)
            number.pop()
        merged.append((place, order))
        number.append(leg)
    merged, number = _with_whole_canals(merged, number)
    lat, lon = np.array([place for place, _ in merged]).T
    wait = np.array([order.wait for _, order in merged])
    speed = np.array([order.speed for _, order in merged[:-1]])
    legs = np.array(number[:-1])
    return Track(lat, lon, depart, wait, speed=speed, extensions=parsed.extensions, given_leg=legs)


def _with_whole_canals(
    merged: list[tuple[Position, WaypointOrder]], number: list[int]
) -> tuple[list[tuple[Position, WaypointOrder]], list[int]]:
    """Return waypoints without the bends of canals that are passed from end to end.

    Such a canal is one leg, as in the route of a plan. It has the number of its last part.
    """
    kept, numbers, at = [], [], 0
    while at < len(merged):
        bends = _bends_after(merged, at)
        kept.append(merged[at])
        numbers.append(number[at + bends])
        at += bends + 1
    return kept, numbers


def _bends_after(merged: list[tuple[Position, WaypointOrder]], at: int) -> int:
    """Return how many waypoints after one are bends of a canal of which that is an end."""
    for canal in CANALS:
        for path in (canal.path, canal.path[::-1]):
            places = merged[at : at + len(path)]
            if len(places) < len(path) or any(order.wait > 0.0 for _, order in places[1:-1]):
                continue
            if np.allclose([place for place, _ in places], path, rtol=0.0, atol=_SAME_BEND):
                return len(path) - 2
    return 0
