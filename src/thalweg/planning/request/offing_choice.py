"""The offing of a voyage: how far a ship stays from land, and which passages it may use."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.coast.snapping import joined_positions
from thalweg.chart.offing import OffingDisc, disc_at
from thalweg.chart.passages import EVERY_SMALL, Passage, find_passages, split_avoided
from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.ship import Ship

#: Offings [nm] by size: the length and the draught [m] below which they hold.
_DEFAULT_OFFINGS: Final = ((0.5, 50.0, 4.0), (1.0, 120.0, 7.0))
_LARGE_SHIP_OFFING: Final = 2.0  # [nm]
_DISC_RADII: Final = tuple(miles * NAUTICAL_MILE for miles in (3.0, 5.0, 10.0, 40.0))
_RIVER_RADII: Final = _DISC_RADII[-2:]
#: Distances from land that are tried inside a disc with a radius, the widest first [m].
_LEAST_OF_DISCS: Final = tuple(share * NAUTICAL_MILE for share in (0.5, 0.25, 0.1, 0.05))
_LEAST_IN_SOUND: Final = 0.25 * NAUTICAL_MILE
_LOOK_BEYOND: Final = 12.0 * NAUTICAL_MILE
_ENOUGH_POSITIONS: Final = 30  # positions of a grid as far from land as the offing: open water
_RIVER_OFFING: Final = 300.0  # off the banks before a canal [m]
NO_OFFING_ROUTE: Final = "No route exists"  #: a note on less distance from land begins so
_NEAR_ENOUGH: Final = 0.9  # an end at this share of the offing leaves it without a test


def default_offing(ship: Ship) -> float:
    """Return the offing of a ship by her size [m].

    0.5 nautical miles below 50 m of length or 4 m of draught, 1 below 120 m and 7 m, else 2. Where
    the length is not known the draught alone counts.
    """
    length, draught = ship.length, float(ship.draught)
    (small, length_small, draught_small), (medium, length_medium, draught_medium) = _DEFAULT_OFFINGS
    if draught < draught_small or (length is not None and length < length_small):
        return small * NAUTICAL_MILE
    if draught < draught_medium and (length is None or length < length_medium):
        return medium * NAUTICAL_MILE
    return _LARGE_SHIP_OFFING * NAUTICAL_MILE


def chosen_offing(voyage: Voyage, ship: Ship) -> float:
    """Return the offing of a voyage [m]: the one it gives, else that of the ship's size."""
    if voyage.offing_nm is not None:
        return voyage.offing_nm * NAUTICAL_MILE
    return default_offing(ship)


def restrict_passages(chart: Chart, voyage: Voyage, ship: Ship, offing: float) -> Chart:
    """Return the chart without the passages that are avoided or closed to the ship.

    A voyage that keeps no offing closes only those it avoids.

    Raises
    ------
    InputError : If a passage or canal is unknown (with near matches), or both opened and avoided.
    """
    canals, avoided = split_avoided(voyage.avoid)
    named = [name for name in voyage.open if str(name).strip().casefold() != EVERY_SMALL]
    opened = find_passages(named)
    for passage in opened:
        if passage in avoided or passage.use == "never":
            raise InputError(
                f"The passage {passage.name!r} cannot be opened.",
                "It is avoided as well." if passage in avoided else "It is closed to ships.",
                "Leave it out.",
                field="open",
            )
    if len(named) < len(voyage.open):  # all of them whose water and bridges allow the ship
        every = (one for one in find_passages([EVERY_SMALL]) if one not in avoided)
        opened += [one for one in every if not size_restriction(replace(one, use="trade"), ship)]
    if canals:
        chart = chart.without_canals(*canals)
    closed = list(avoided)
    for passage in chart.passages if offing > 0.0 else ():
        if passage not in opened and passage not in closed and size_restriction(passage, ship):
            closed.append(passage)
    if closed:
        chart = chart.without_passages(*(passage.name for passage in closed))
    return chart


def size_restriction(passage: Passage, ship: Ship) -> str:
    """Return why a passage is closed to a ship of this size, as text; empty if it is open."""
    return passage.ship_restriction(**ship_dimensions(ship))


def ship_dimensions(ship: Ship) -> dict[str, float | None]:
    """Return the draught, beam, length and air draught of a ship [m], None where unknown."""
    return {
        "draught": float(ship.draught) or None,
        "beam": ship.breadth,
        "length": ship.length,
        "air_draught": ship.air_draught,
    }


def chart_off_land(
    chart: Chart,
    ends: Sequence[Endpoint],
    offing: float,
    *,
    near_ends: float = 0.0,
    near_least: float = 0.0,
    which: Sequence[int] = (0, -1),
) -> Chart:
    """Return the chart with an offing [m], smaller round ends and canals nearer to land.

    Parameters
    ----------
    near_ends, near_least : Within the first distance [m] of some ends the second is enough [m].
    which : Numbers of these ends.
    """
    if offing <= 0.0:
        return chart
    canals = [Endpoint(canal.title, *end, 0.0) for canal in chart.canals for end in canal.ends]
    discs = [disc for end in ends for disc in _discs_of_end(chart, end, offing)]
    discs += [disc for end in canals for disc in _discs_of_end(chart, end, offing, in_river=True)]
    if near_ends > 0.0:
        near = [ends[number] for number in which]
        discs += [OffingDisc(end.lat, end.lon, near_least, near_ends) for end in near]
    return chart.with_offing(offing, discs=discs)


def _discs_of_end(
    chart: Chart, end: Endpoint, offing: float, *, in_river: bool = False
) -> list[OffingDisc]:
    """Return the smallest discs that join an end to water as far from land as the offing.

    Inside the larger one as much distance from land is required as leaves them joined, if need be
    with none in a smaller one. For some miles before the end of a canal in a river a small distance
    is enough.
    """
    place = end.lat, end.lon
    shore = float(chart.coastline.shore_distance(*place, cap=offing))
    if shore >= offing:
        return []
    at_end = disc_at(chart.coastline, place)
    if not in_river and (shore >= _NEAR_ENOUGH * offing or _joins(chart, [at_end], offing)):
        return [at_end]
    if in_river:
        least = min(0.9 * shore, _RIVER_OFFING)
        river = [OffingDisc(*place, least, radius) for radius in _RIVER_RADII]
        return [next((disc for disc in river if _joins(chart, [disc], offing)), river[-1])]
    joins = (r for r in _DISC_RADII if _joins(chart, [OffingDisc(*place, 0.0, r)], offing))
    radius = next(joins, None)
    if radius is None:  # a sound without open water: others are tried with less offing
        return [
            OffingDisc(*place, 0.0, _DISC_RADII[0]),
            OffingDisc(*place, _LEAST_IN_SOUND, _DISC_RADII[-1]),
        ]
    inner = [at_end, *(OffingDisc(*place, 0.0, r) for r in _DISC_RADII if r < radius)]
    kept = ([one, OffingDisc(*place, least, radius)] for one in inner for least in _LEAST_OF_DISCS)
    possible = (discs for discs in kept if _joins(chart, discs, offing))
    return next(possible, [OffingDisc(*place, 0.0, radius)])


def _joins(chart: Chart, discs: Sequence[OffingDisc], offing: float) -> bool:
    """Return whether discs round a place join it to water as far from land as the offing [m]."""
    largest = discs[-1]
    local = chart.with_offing(offing, discs=discs)
    lat, lon = joined_positions(
        largest.lat,
        largest.lon,
        largest.radius + _LOOK_BEYOND,
        is_navigable=local.is_navigable,
        legs_blocked=local.legs_blocked,
    )
    off = chart.coastline.shore_distance(lat, lon, cap=offing) >= 0.999 * offing
    return int(np.sum(off)) >= _ENOUGH_POSITIONS


def offing_note(chart: Chart, ends: Sequence[Endpoint], wanted: float) -> str:
    """Return a note for the user: how far off land a plan on a chart keeps, and wanted to [m]."""
    kept = chart.offing.distance
    text = f"Keeps {wanted / NAUTICAL_MILE:.2g} nm off land"
    if kept < wanted:
        text = f"{NO_OFFING_ROUTE} {wanted / NAUTICAL_MILE:.2g} nm off land: "
        text += f"keeps {kept / NAUTICAL_MILE:.2g} nm" if kept else "keeps no distance from land"
    near: dict[str, str] = {}  # the discs asked for a voyage come last, and are the widest
    for disc in chart.offing.discs:
        end = min(ends, key=lambda e: math.hypot(e.lat - disc.lat, e.lon - disc.lon))
        if math.hypot(end.lat - disc.lat, end.lon - disc.lon) > 1e-6:
            continue  # at the end of a canal
        within = f" within {disc.radius / NAUTICAL_MILE:.0f} nm of it" if disc.radius else ""
        if disc.radius and disc.least:
            within += f" ({disc.least / NAUTICAL_MILE:.2g} nm)"
        near[end.name] = f"{end.name}{within}"
    if near:
        text += f"; less near {' and '.join(near.values())}"
    return f"{text}; not in approaches of ports and narrow passages."
