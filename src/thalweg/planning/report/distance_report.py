"""Notes on distances by sea: water too shallow, miles that shoals add, ways far round."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.chart.approaches import PortApproach
from thalweg.chart.depth.global_depth import NAME
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.depth.shoals import EXCESS
from thalweg.chart.passage_crossings import names_passed
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, densify, distance, format_position_minutes
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

#: Ways without a draught have a note where they do not keep off water shallower than this [m].
LEAST_DEPTH: Final = 2.5
SHOAL_DETOUR: Final = "Keeps off shoal water"  #: a note on a way that is longer so begins so
OFFING_DETOUR: Final = "Keeps off land"  #: a note on a way that is longer so begins so
_CLEARLY_LONGER: Final = 0.03  # share of the way that it is longer ...
_MANY_MILES: Final = 50.0 * NAUTICAL_MILE  # ... or so much
#: ... for the offing; the graph is some percent too long itself
_LONGER_OFF_LAND, _MILES_OFF_LAND = 0.03, 5.0 * NAUTICAL_MILE
_PARTS_OF_OFFING: Final = (0.75, 0.5, 0.25)  # that are tried
_STEP: Final = 0.25 * NAUTICAL_MILE  # along a way whose place nearest to land is sought
_IN_PASSAGE: Final = 2.0 * NAUTICAL_MILE  # places so near the line of a passage are in it
#: Ways so much longer than the straight line, up to so long [m], may miss a channel.
_ROUNDABOUT: Final = 2.5
_LONGEST_STRAIGHT: Final = 100.0 * NAUTICAL_MILE


def shoal_notes(seas: Seaways, path: Sequence[Position], draught: float | None) -> tuple[str, ...]:
    """Return how many miles of a way have less water than the draught, as a note.

    Parameters
    ----------
    seas : With the shoals of the draught; without shoals there is no note.
    path : Positions (lat, lon) [deg].
    draught : [m]; None: not known.
    """
    miles = shoal_miles(seas, path)
    if miles < 1.0:
        return ()
    depth = "the draught" if draught is not None else f"{LEAST_DEPTH:g} m"
    return (
        f"{miles:.0f} nm of the way have less water than {depth}, by the {NAME}: this graph of "
        "all seas is coarse near shoals, and a plan may find a longer way round.",
    )


def shoal_detour_notes(
    seas: Seaways, ends: Sequence[Endpoint], *, offing: float, length: float | None = None
) -> tuple[str, ...]:
    """Return how much longer shoals make a way, as a note.

    Parameters
    ----------
    seas : With the shoals; without shoals there is no note.
    ends : Of the way, with via points between them.
    offing : Distance from land that ways keep [m].
    length : Of the way without approaches [m]; by default of the shortest one round the shoals.

    Raises
    ------
    InputError : If an end is on land on the chart of all seas.
    """
    if seas.shoals is None:
        return ()
    over = replace(seas, shoals=None)
    legs = list(pairwise(ends))

    def length_of(ways: Iterable[list[Position]]) -> float:
        return sum(_length_of(seas, way) for way in ways)

    try:
        on_graph = length_of(over.graph_path(*leg) for leg in legs)
        known = length
        if known is None:  # ways to the offing take longer to find than those over the graph
            known = length_of(seas.graph_path(*leg) for leg in legs)
        if known - on_graph <= _clear_difference(known):
            return ()
        if length is None:
            length = length_of(seas.path(*leg, offing=offing) for leg in legs)
        ways = [over.path(*leg, offing=offing) for leg in legs]
    except NoRouteError:
        return ()
    longer = length - length_of(ways)
    if longer <= _clear_difference(length) or longer < NAUTICAL_MILE:
        return ()
    lat, lon = np.array([place for way in ways for place in way], float).T
    names = names_passed(seas.chart.coastline, seas.chart.passages, lat, lon)
    by = f", by {', '.join(dict.fromkeys(names))}" if names else ""
    reefs = _reefs_crossed(ways, seas.shoals.least)
    if reefs:
        return (
            f"{SHOAL_DETOUR}: the shortest way for this draught is {longer / NAUTICAL_MILE:.0f} nm "
            f"shorter, but crosses {', '.join(reefs)}. See the chart.",
        )
    return (
        f"{SHOAL_DETOUR} by the {NAME}, which is coarse: the shortest way for this draught is "
        f"{longer / NAUTICAL_MILE:.0f} nm shorter, over that water{by}. See the chart; to compare, "
        "plan with --ignore-shoals.",
    )


def _reefs_crossed(ways: Iterable[Sequence[Position]], depth: float) -> list[str]:
    """Return the names of areas on some ways that dry or are exact with less water [m]."""
    import shapely

    lines = [np.unwrap(np.array(way, float)[:, ::-1], period=360.0, axis=0) for way in ways]
    found = shapely.MultiLineString([line for line in lines if len(line) > 1])
    areas = (area for area in SHOAL_AREAS if area.dries or (area.is_exact and area.depth < depth))
    return [area.name for area in areas if area.polygon.intersects(found)]


def offing_detour_notes(
    seas: Seaways, ends: tuple[Endpoint, Endpoint], length: float, offing: float
) -> list[str]:
    """Return how much longer the offing makes a way, and where it closes the shorter one.

    Parameters
    ----------
    seas : Of the ship, with the shoals that she avoids.
    ends : Of the way, without approaches.
    length : Of the way [m].
    offing : That it keeps [m].

    Returns
    -------
    list of str : A note, or none where ways that keep a part of the offing are not clearly shorter.

    Raises
    ------
    InputError : If an end is on land on the chart of all seas.
    NoRouteError : If there is no way.
    """
    worth = max(_LONGER_OFF_LAND * length, _MILES_OFF_LAND)
    if offing <= 0.0 or length - _length_of(seas, seas.graph_path(*ends)) < worth:
        return []
    for share in _PARTS_OF_OFFING:
        way = seas.path(*ends, offing=share * offing)
        shorter = length - _length_of(seas, way)
        if shorter >= worth:
            break
    else:
        return []
    off, place = _nearest_to_land(seas, way, ends, (0.9 * share * offing, offing))
    if not math.isfinite(off):
        return []
    return [
        f"{OFFING_DETOUR}: a way about {shorter / NAUTICAL_MILE:.0f} nm shorter leads through "
        f"water {off / NAUTICAL_MILE:.1f} nm off land at {format_position_minutes(*place)}, nearer "
        f"than the {offing / NAUTICAL_MILE:g} nm of the offing. If the chart shows that ships use "
        f"it, plan with --offing {share * offing / NAUTICAL_MILE:.2g}."
    ]


def _nearest_to_land(
    seas: Seaways, way: Sequence[Position], ends: Sequence[Endpoint], between: tuple[float, float]
) -> tuple[float, Position]:
    """Return where a way is nearest to land outside canals, passages and the ends, and how near.

    Of places whose distance from land is between two values [m]; nearer ones are in narrow water
    that is open whatever the offing. Infinite where there is none.
    """
    least, offing = between
    line = np.array(way, float).T
    lat, lon, leg = densify(line[0], line[1], _STEP)
    off = np.asarray(seas.chart.coastline.shore_distance(lat, lon, cap=offing), float)
    canal = np.asarray(seas.chart.canal_of_legs(*line[:, :-1], *line[:, 1:]))
    off[:-1][canal[leg] >= 0] = np.inf
    for passage in seas.chart.passages:
        y, x, _part = densify(*passage.positions, NAUTICAL_MILE)
        near = np.flatnonzero(off < offing)
        if len(near):
            beside = np.asarray(distance(lat[near, None], lon[near, None], y, x)).min(axis=1)
            off[near[beside < _IN_PASSAGE]] = np.inf
    for end in ends:
        off[np.asarray(distance(lat, lon, end.lat, end.lon)) < 2.0 * offing] = np.inf
    off[(off < least) | (off >= offing)] = np.inf
    k = int(np.argmin(off))
    return float(off[k]), (float(lat[k]), float(lon[k]))


def _length_of(seas: Seaways, way: Sequence[Position]) -> float:
    return path_length_and_canals(seas.chart, way)[0]


def _clear_difference(length: float) -> float:
    """Return how much shorter than a way [m] another one is that a note is on [m]."""
    return min(_CLEARLY_LONGER * length, _MANY_MILES)


def roundabout_notes(line: Sequence[Position], length: float) -> tuple[str, ...]:
    """Return a note on a way [m] much longer than the straight line between its ends."""
    straight = float(distance(*line[0], *line[-1]))
    if straight > _LONGEST_STRAIGHT or length < _ROUNDABOUT * straight:
        return ()
    return (
        f"{length / NAUTICAL_MILE:.0f} nm by sea for {straight / NAUTICAL_MILE:.0f} nm in a "
        "straight line: narrow channels that are not in the table of passages are closed. See on "
        "the chart whether there is one.",
    )


def shoal_miles(seas: Seaways, path: Sequence[Position]) -> float:
    """Return how many miles of a way have less water than required.

    Parameters
    ----------
    seas : With shoals; 0 without.
    path : Positions (lat, lon) [deg].
    """
    if seas.shoals is None or len(path) < 2:
        return 0.0
    way = np.array(path, float)
    lat, lon, leg = densify(way[:, 0], way[:, 1], NAUTICAL_MILE)
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    counted = np.asarray(seas.chart.canal_of_legs(*way[:-1].T, *way[1:].T))[leg] < 0
    shallow = (seas.shoals.excess(*legs) > EXCESS[0]) & counted
    return float(np.sum(distance(*legs)[shallow])) / NAUTICAL_MILE


def avoided_on_approach_notes(
    seas: Seaways, straits: Sequence[str], approaches: Sequence[PortApproach]
) -> tuple[str, ...]:
    """Return a note on passages to avoid that the approach of a port leads through.

    Parameters
    ----------
    seas : With what the request avoids.
    straits : Names of the passages of the way.
    approaches : Of the way.
    """
    names = [name for name in straits if name in seas.passages]
    if not names or not approaches:
        return ()
    return (
        f"Not avoided: {', '.join(names)}: the approach of a port leads through it. Approaches are "
        "lines of a table; what is to avoid closes only the way between them.",
    )
