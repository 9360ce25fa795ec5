"""Positions in harbours and rivers: a ship there leaves along the approach that passes her."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.approach_choices import approach_choices
from thalweg.chart.approaches import JOINED_WITHIN, PortApproach, line_part, place_along_line
from thalweg.core.geodesy import Position, distance, line_length
from thalweg.core.units import NAUTICAL_MILE

#: Positions so near to charted land are in a harbour, a river or a fjord [m].
_NEAR_LAND: Final = 1.0 * NAUTICAL_MILE
_LEAST_LEFT: Final = 2.0 * NAUTICAL_MILE  # of the line, or the ship is at sea at once
_IN_PORT: Final = 2.0 * NAUTICAL_MILE  # from the port whose largest draught holds
_UPSTREAM: Final = 60.0 * NAUTICAL_MILE  # along the line to where another way leaves it


def joined_ways(lat: float, lon: float, chart: Chart) -> list[PortApproach]:
    """Return the ways of a ship that joins an approach at a position near land; none otherwise.

    Of several ports, that of the largest is taken, then that with the shortest way to the sea.

    Parameters
    ----------
    lat, lon : Position on water [deg].
    chart : With approaches of ports, or without: then there are none.

    Returns
    -------
    list of PortApproach : Each begins at the position: the approach, those by branches and to
        canals on the way to the sea, and those that leave the line towards the port.
    """
    found = _joined(lat, lon, chart)
    if found is None:
        return []
    whole, along = found
    place = lat, lon
    approach = _from_position(whole, _line_from(place, whole, along))
    ways = [  # a canal beside a port is reached straight from its berth, but not from everywhere
        way
        for way in approach_choices(approach, chart.canals, chart.passages)
        if not way.through or not bool(chart.legs_blocked(*way.line[0], *way.line[1]))
    ]
    known = {way.way for way in ways}
    for way in approach_choices(whole, chart.canals, chart.passages):
        left = _shared_length(whole.line, way.line)
        if way.way not in known and not way.through and 0.0 <= along - left <= _UPSTREAM:
            back = line_part(whole.line[::-1], whole.length - left)
            back = line_part(tuple(back[::-1]), along - left)[::-1]
            beyond = line_part(way.line[::-1], way.length - left)[::-1]
            ways.append(_from_position(way, (place, *back, *beyond[1:])))
    return ways


def _joined(lat: float, lon: float, chart: Chart) -> tuple[PortApproach, float] | None:
    """Return the approach that a position joins, and how far from its berth [m]."""
    if chart.approaches is None or chart.coastline.is_empty:
        return None
    if float(chart.coastline.shore_distance(lat, lon, cap=_NEAR_LAND)) >= _NEAR_LAND:
        return None
    found = [
        (approach, along, apart)
        for approach, along, apart in chart.approaches.lines_near(lat, lon, within=JOINED_WITHIN)
        if approach.length - along >= _LEAST_LEFT
    ]
    found.sort(key=lambda one: (-one[0].port.importance, one[2] + one[0].length - one[1]))
    for approach, along, _apart in found:
        line = _line_from((lat, lon), approach, along)
        if not bool(chart.legs_blocked(*line[0], *line[1])):
            return approach, along
    return None


def _shared_length(main: Sequence[Position], way: Sequence[Position]) -> float:
    """Return how far a way follows the main line from the berth [m]."""
    shared = 0
    while shared < min(len(main), len(way)) and main[shared] == way[shared]:
        shared += 1
    left = place_along_line(tuple(main), way[shared]) if shared < len(way) else None
    return line_length(main[:shared]) if left is None else left


def _line_from(position: Position, approach: PortApproach, along: float) -> tuple[Position, ...]:
    """Return the line from a position to the nearest place of an approach and on to the sea."""
    left = line_part(approach.line[::-1], approach.length - along)[::-1]
    on_line = float(distance(*position, *left[0])) < 1.0
    return (position, *(left[1:] if on_line else left))


def _from_position(approach: PortApproach, line: tuple[Position, ...]) -> PortApproach:
    """Return an approach with another line; the port's limits hold where that begins in port."""
    port = approach.port
    if float(distance(*line[0], port.lat, port.lon)) <= _IN_PORT:
        return replace(approach, line=line)
    unknown = float("nan")
    return replace(approach, line=line, max_draught=unknown, max_length=unknown, draught_source="")
