"""Sills of the depth layer that would close the way that ships take: reopened, with a note.

The layer is coarse: a sill may not be there. Closed water is reopened where every way round it is
clearly longer than the way across, though a mile there counts up to twenty.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import compress, pairwise
from typing import Any, Final, NamedTuple

import numpy as np
import shapely

from thalweg.chart import Chart
from thalweg.chart.depth.closed_shoals import OpenDisc
from thalweg.chart.depth.global_depth import NAME
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.arrays.leg_ends import leg_ends
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, densify, distance, format_position
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.depth_report import CHECK_DEPTH
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

_LONGER: Final = 1.1  # a way round closed water that is longer by this and ...
_DETOUR: Final = 30.0 * NAUTICAL_MILE  # ... this is no way that ships take
_RADIUS: Final = 15.0 * NAUTICAL_MILE  # of the open water along the way across a sill
_SPACING: Final = 10.0 * NAUTICAL_MILE
_TURNS: Final = (-360.0, 0.0, 360.0)


class OpenedSills(NamedTuple):
    """A chart with its sills open.

    Attributes
    ----------
    chart : The chart.
    note : What was opened; empty for nothing.
    length : Of the way that ships take, over the graph of all seas [m]; 0 where there is none.
    """

    chart: Chart
    note: str
    length: float


def open_sills(chart: Chart, ends: Sequence[Endpoint]) -> OpenedSills:
    """Return the chart with the sills open that ships cross.

    Parameters
    ----------
    chart : With the passages and canals that the ship may use, and with closed shoals.
    """
    zones = chart.zones
    closed = zones.closed_shoals
    if closed is None:
        return OpenedSills(chart, "", 0.0)
    seas = replace(Seaways.of_ship_chart(chart), shoals=zones.shoals)
    shapes = shapely.STRtree(closed.shapes)
    discs: list[OpenDisc] = []
    deepest, lengths = 0.0, []
    for start, goal in pairwise(ends):
        try:
            path = seas.graph_path(start, goal)
        except NoRouteError:
            continue
        length, _ = path_length_and_canals(seas.chart, path)
        lengths.append(length)
        cut = _crossed(shapes, *leg_ends(*np.array(path, float).T))
        crossing = list(compress(pairwise(path), cut))
        if not crossing or _in_named_area(crossing, closed.depth_of_areas):
            continue
        try:
            round_it, _ = path_length_and_canals(
                seas.chart,
                seas.graph_path(start, goal, blocked=lambda *legs: _crossed(shapes, *legs)),
            )
        except NoRouteError:
            round_it = np.inf
        if round_it > max(_LONGER * length, length + _DETOUR):
            discs += [(lat, lon, _RADIUS) for leg in crossing for lat, lon in _along(leg)]
            deepest = max(deepest, round_it - length)
    whole = sum(lengths) if len(lengths) == len(ends) - 1 else 0.0
    if not discs:
        return OpenedSills(chart, "", whole)
    more = f"{deepest / NAUTICAL_MILE:,.0f} nm longer" if np.isfinite(deepest) else "not there"
    place = format_position(*_middle(discs, ends))
    note = (
        f"{CHECK_DEPTH}: water within {_RADIUS / NAUTICAL_MILE:.0f} nm of {place} was opened to "
        f"the search. It has less than {closed.depth:.1f} m by the {NAME}, which is coarse, and a "
        f"way round it is {more}."
    )
    closed = replace(closed, discs=(*closed.discs, *discs))
    return OpenedSills(replace(chart, zones=replace(zones, closed_shoals=closed)), note, whole)


def _middle(discs: Sequence[OpenDisc], ends: Sequence[Endpoint]) -> Position:
    """Return the centre of the disc that is farthest from all ends [deg]."""
    centres = [(lat, lon) for lat, lon, _ in discs]

    def least(at: Position) -> float:
        return min(float(distance(at[0], at[1], end.lat, end.lon)) for end in ends)

    return max(centres, key=least)


def _crossed(
    shapes: Any, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> BoolArray:
    """Return which legs, straight in degrees, cross shapes of longitude and latitude."""
    crossed = np.zeros(len(lat1), bool)
    over = lon1 + (lon2 - lon1 + 180.0) % 360.0 - 180.0
    for turn in _TURNS:
        ends = np.stack([lon1 + turn, lat1, over + turn, lat2], axis=-1).reshape(-1, 2, 2)
        crossed[shapes.query(shapely.linestrings(ends), predicate="intersects")[0]] = True
    return crossed


def _in_named_area(legs: Sequence[tuple[Position, Position]], depth: float) -> bool:
    areas = [area.polygon for area in SHOAL_AREAS if area.depth < depth]
    lat, lon = np.moveaxis(np.array(legs, float), 2, 0)
    ends = lat[:, 0], lon[:, 0], lat[:, 1], lon[:, 1]
    return bool(areas) and bool(_crossed(shapely.STRtree(areas), *ends).any())


def _along(leg: tuple[Position, Position]) -> list[Position]:
    """Return positions along a leg."""
    if float(distance(*leg[0], *leg[1])) <= 0.0:
        return [leg[0]]
    ends = np.array(leg)
    lat, lon, _ = densify(ends[:, 0], ends[:, 1], _SPACING)
    return list(zip(lat.tolist(), lon.tolist()))
