"""Shoal water of a voyage: where it is closed, and from which contour on a mile counts more."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.coast.snapping import joined_positions
from thalweg.chart.depth.closed_shoals import (
    WORLD_BOX,
    ClosedShoals,
    DegreeBox,
    OpenDisc,
    closing_depth,
    closing_depth_of_areas,
)
from thalweg.chart.depth.global_depth import NAME
from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.core.geodesy import METRES_PER_DEGREE, Position, distance, wrap_longitude
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea, standard_names
from thalweg.ship import Ship

#: A note that shoal water was opened again begins so.
SHOALS_OPENED: Final = "The route crosses shoal water"
_IGNORED: Final = (
    "Shoals were not avoided, as asked, but for named areas that dry (reefs, sands, wind farms, "
    "oil fields). Check the depths on the chart."
)
#: Radii [m] of the open water round ends, where dredged channels lead through shoals.
_RADII: Final = tuple(miles * NAUTICAL_MILE for miles in (8.0, 20.0, 45.0, 90.0))
_WIDEST: Final = 250.0 * NAUTICAL_MILE  # of it where shoals reach farther out than that
_LOOK_BEYOND: Final = 15.0 * NAUTICAL_MILE
_RIM: Final = 0.96  # of half the side of a box: water that reaches it leads on
#: Shoals farther round the ends than this [m], or this share of the distance, are left out.
_REGION, _REGION_SHARE = 600.0 * NAUTICAL_MILE, 0.6
_POLAR: Final = 85.0  # [deg]


def add_shoals(
    chart: Chart, voyage: Voyage, ship: Ship, sea: Sea, ends: Sequence[Endpoint]
) -> tuple[Chart, list[str]]:
    """Return the chart with the shoal water of a ship, and a note.

    Charts of the world's coasts get it, where neither they nor the sea provide depth, for voyages
    that keep an offing. Narrow passages that the ship may use count as deep along their lines.

    Parameters
    ----------
    chart : With the passages that the ship may use.
    ends : Round them the layer does not count.

    Returns
    -------
    chart : Chart
    notes : list of str
    """
    draught = float(ship.draught)
    depth_known = chart.has_depth or standard_names.BED_DEPTH in sea.variables
    near_land = chosen_offing(voyage, ship) <= 0.0
    if depth_known or chart.approaches is None or near_land:
        return chart, []
    if not draught > 0.0:
        return chart, ["Shoals were not avoided: the draught of the ship is not known."]
    least = draught + required_under_keel_clearance(voyage, ship)
    shoals = shoals_of_draught(chart, draught, least, [(float(e.lat), float(e.lon)) for e in ends])
    if voyage.ignore_shoals:
        shoals = replace(shoals, drying_only=True)
        return replace(chart, zones=replace(chart.zones, shoals=shoals)), [_IGNORED]
    note = (
        f"The route avoids water shallower than {shoals.contour:g} m where possible: the search "
        f"counts a mile there as up to 20 miles by the {NAME} and the named shoal areas; not near "
        "the ends and in narrow passages."
    )
    return replace(chart, zones=replace(chart.zones, shoals=shoals)), [note]


def close_shoals(
    chart: Chart,
    ends: Sequence[Endpoint],
    *,
    round_ends: Mapping[int, float] = MappingProxyType({}),
) -> tuple[Chart, str, tuple[int, ...]]:
    """Return the chart with the water closed that has much less depth than required, and a note.

    Where a chart has shoal water (`add_shoals`). Round the ends as much stays open as joins them
    to the sea.

    Parameters
    ----------
    chart : With its offing.
    round_ends : Least radius [m] of the open water round some ends, by their numbers from 0.

    Returns
    -------
    chart : The chart itself where nothing is closed.
    note : Empty then.
    enclosed : Numbers of the ends that the distance from land does not leave joined to the sea,
        whatever the shoals: nothing is closed where there is one.
    """
    shoals = chart.zones.shoals
    if shoals is None or shoals.least <= 0.0:
        return chart, "", ()
    depth, area_depth = closing_depth(shoals.least), closing_depth_of_areas(shoals.least)
    depth = 0.0 if shoals.drying_only else depth
    closed = ClosedShoals(
        depth, shoals.channels, box=_region(ends), area_depth=area_depth,
        drying_areas=shoals.drying_only,
    )  # fmt: skip
    found = [_open_water(chart, closed, (end.lat, end.lon)) for end in ends]
    enclosed = tuple(number for number, one in enumerate(found) if one is None)
    if enclosed:
        return chart, "", enclosed
    opened = [
        _OpenWater(place, max(radius, more), areas or more > 0.0)
        for number, (place, radius, areas) in enumerate(filter(None, found))
        for more in (round_ends.get(number, 0.0),)
    ]
    for place in (place for canal in chart.canals for place in canal.ends):
        if _in_box(place, closed.box):
            water = _open_water(chart, closed, place)
            if water is None or water.radius > _RADII[-1]:
                water = _OpenWater(place, _RADII[1], True)
            opened.append(water)
    closed = replace(
        closed,
        discs=tuple(water.disc for water in opened),
        area_discs=tuple(water.disc for water in opened if water.areas),
    )
    if not closed.shapes:
        return chart, "", ()
    less = f"with less than {area_depth:.1f} m"
    note = (
        f"Closed: named shoal areas, and water with less than {depth:.1f} m by the {NAME}, which "
        "is too coarse to close water by the draught itself; that water is open within 8 nm of the "
        "ends and in narrow passages."
        if depth > 0.0
        else f"Closed: named shoal areas {'that dry' if shoals.drying_only else less}."
    )
    wide = [
        f"{water.radius / NAUTICAL_MILE:.0f} nm of {end.name}{' (areas, too)' * water.areas}"
        for end, water in zip(ends, opened)
        if water.radius > _RADII[0] or water.areas
    ]
    note += f" It is open within {' and '.join(wide)}." if wide and depth > 0.0 else ""
    return replace(chart, zones=replace(chart.zones, closed_shoals=closed)), note, ()


def close_exact_areas(chart: Chart, ends: Sequence[Endpoint]) -> Chart:
    """Return the chart with the named areas of exact outline closed, and no other shoal water.

    Areas with an end inside are open.

    Parameters
    ----------
    chart : With its shoal water.

    Returns
    -------
    Chart : The chart itself where there are none.
    """
    shoals = chart.zones.shoals
    if shoals is None or shoals.least <= 0.0:
        return chart
    closed = ClosedShoals(
        0.0,
        discs=tuple((float(end.lat), float(end.lon), 0.0) for end in ends),
        box=_region(ends),
        area_depth=closing_depth_of_areas(shoals.least),
    )
    if not closed.shapes:
        return chart
    return replace(chart, zones=replace(chart.zones, closed_shoals=closed))


def _region(ends: Sequence[Endpoint]) -> DegreeBox:
    """Return a box [deg] with all shoals that a voyage may meet."""
    lat = np.array([end.lat for end in ends], float)
    lon = np.degrees(np.unwrap(np.radians([end.lon for end in ends])))
    far = max(float(distance(a.lat, a.lon, b.lat, b.lon)) for a, b in pairwise(ends))
    return _box_round(lat, lon, max(_REGION, _REGION_SHARE * far))


def _box_round(lat: FloatArray, lon: FloatArray, margin: float) -> DegreeBox:
    """Return the box [deg] round positions with a margin [m]; the whole world near a pole."""
    north = margin / METRES_PER_DEGREE
    south, top = float(lat.min()) - north, float(lat.max()) + north
    if max(-south, top) > _POLAR:
        return WORLD_BOX
    # a circle of this radius reaches farthest east where a meridian touches it
    reach = np.degrees(np.arcsin(math.sin(math.radians(north)) / np.cos(np.radians(lat))))
    west, east = float((lon - reach).min()), float((lon + reach).max())
    return (south, top, west, east) if east - west < 360.0 else WORLD_BOX


def _in_box(place: Position, box: DegreeBox) -> bool:
    south, north, west, east = box
    return south <= place[0] <= north and (place[1] - west) % 360.0 <= east - west


class _OpenWater(NamedTuple):
    """Open water round a place that joins it to the sea."""

    place: Position
    radius: float  # [m]
    areas: bool  # whether named areas without an exact outline are open, too

    @property
    def disc(self) -> OpenDisc:
        return float(self.place[0]), float(self.place[1]), self.radius


def _open_water(chart: Chart, closed: ClosedShoals, place: Position) -> _OpenWater | None:
    """Return the least open water that joins a place to the sea; named areas open last.

    None where nothing does: the distance from land cuts it off.
    """
    for areas in (False, True):
        for radius in _RADII:
            water = _OpenWater(place, radius, areas)
            half = radius + _LOOK_BEYOND
            box = _box_round(np.array([place[0]]), np.array([place[1]]), half)
            open_areas = (water.disc,) if areas else ()
            local = replace(closed, discs=(water.disc,), area_discs=open_areas, box=box)
            if areas and not local.has_rough_areas:
                continue
            if not local.shapes or _leads_on(chart, place, half, local):
                return water
    leads_on = _leads_on(chart, place, _RADII[-1] + _LOOK_BEYOND, None)
    return _OpenWater(place, _WIDEST, True) if leads_on else None


def _leads_on(chart: Chart, place: Position, half: float, closed: ClosedShoals | None) -> bool:
    """Return whether water leads from a place to the rim of a box of half a side [m] round it."""

    def is_open(lat: FloatArray, lon: FloatArray) -> BoolArray:
        water = np.asarray(chart.is_navigable(lat, lon))
        return water if closed is None else water & ~closed.contains(lat, lon)

    lat, lon = joined_positions(*place, half, is_navigable=is_open, legs_blocked=chart.legs_blocked)
    away = np.maximum(
        np.abs(lat - place[0]),
        np.abs(wrap_longitude(lon - place[1])) * math.cos(math.radians(place[0])),
    )
    return bool((away * METRES_PER_DEGREE > _RIM * half).any())
