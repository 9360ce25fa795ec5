"""Positions in harbours and rivers: a ship there leaves along the approach that passes her."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.approaches import PortApproach, line_part
from thalweg.core.geodesy import Position, distance
from thalweg.core.units import NAUTICAL_MILE

#: Positions so near to charted land are in a harbour, a river or a fjord [m].
_NEAR_LAND: Final = 1.0 * NAUTICAL_MILE
_WITHIN: Final = 1.0 * NAUTICAL_MILE  # of the line, over water
_LEAST_LEFT: Final = 2.0 * NAUTICAL_MILE  # of the line, or the ship is at sea at once
_IN_PORT: Final = 2.0 * NAUTICAL_MILE  # from the port whose largest draught holds


def joined_approach(lat: float, lon: float, chart: Chart) -> PortApproach | None:
    """Return the approach that a ship joins at a position near land; None where she needs none.

    Of several ports, that of the largest is taken, then that with the shortest way to the sea.

    Parameters
    ----------
    lat, lon : Position on water [deg].
    chart : With approaches of ports, or without: then the answer is None.

    Returns
    -------
    PortApproach, or None : Its line begins at the position.
    """
    if chart.approaches is None or chart.coastline.is_empty:
        return None
    if float(chart.coastline.shore_distance(lat, lon, cap=_NEAR_LAND)) >= _NEAR_LAND:
        return None
    found = [
        (approach, along, apart)
        for approach, along, apart in chart.approaches.lines_near(lat, lon, within=_WITHIN)
        if approach.length - along >= _LEAST_LEFT
    ]
    found.sort(key=lambda one: (-one[0].port.importance, one[2] + one[0].length - one[1]))
    for approach, along, _apart in found:
        line = _line_from((lat, lon), approach, along)
        if not bool(chart.legs_blocked(*line[0], *line[1])):
            return _from_position(approach, line)
    return None


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
