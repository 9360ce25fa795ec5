"""What every format yields, and how it becomes a track."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, check_position
from thalweg.core.time import TimeLike, parse_time
from thalweg.route.track import Track


@dataclass(frozen=True)
class ParsedTrack:
    """Positions (lat, lon) [deg] of a file in order, and its first time [s] (None: not told)."""

    positions: list[Position]
    first_time: float | None = None


def number_of(text: object, what: str) -> float:
    """Return a finite number, or raise `InputError` naming what it should have been."""
    try:
        value = float(text)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise InputError(
            f"The {what} is {text!r}, not a number.", "", "Give degrees, such as 52.5.", value=text
        )
    return value


def position_of(lat: object, lon: object, number: int) -> Position:
    """Return a checked position of the numbered waypoint (from 1)."""
    what = f"waypoint {number}"
    return check_position(
        number_of(lat, f"latitude of {what}"), number_of(lon, f"longitude of {what}"), what
    )


def track_of(parsed: ParsedTrack, depart: TimeLike | None, name: str) -> Track:
    """Make a track from what a file held.

    Raises
    ------
    InputError
        For fewer than two different positions, or without any departure.
    """
    if len(set(parsed.positions)) < 2:
        raise InputError(
            f"The route file {name!r} holds {len(parsed.positions)} waypoint"
            f"{'' if len(parsed.positions) == 1 else 's'}.",
            "A route has at least two different ones.",
            "Give a file with the whole route.",
            file=name,
        )
    if depart is None and parsed.first_time is None:
        raise InputError(
            f"The route file {name!r} tells no departure.",
            "Its first waypoint may have a time.",
            "Give depart, such as 2026-01-01T06:00Z.",
            file=name,
            field="depart",
        )
    start = parsed.first_time if depart is None else parse_time(depart)
    return Track.from_positions(parsed.positions, depart=start)  # type: ignore[arg-type]
