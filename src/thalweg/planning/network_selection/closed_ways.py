"""Which closed passages and canals are the reason that there is no way, or none that is short."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.chart.approaches import line_between
from thalweg.chart.canals import Canal
from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.core.geodesy import Position, densify, distance, line_length
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.network_selection.way_choice import with_chosen_ways
from thalweg.planning.report.closed_way_report import (
    NarrowWay,
    notes_by_reason,
    title_of_way,
    ways_of_names,
    ways_on_line,
)
from thalweg.planning.report.distance_report import shoal_miles
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals, world_chart

#: Closed ways have a note that save so much of the distance, and at least so much [m].
_LEAST_SHARE: Final = 0.02
_LEAST_SAVED: Final = 5.0 * NAUTICAL_MILE
_PIECE: Final = 10.0 * NAUTICAL_MILE  # of the line of a closed way, to see how far off it is

_MORE_SHOALS: Final = 5.0  # on a way round a passage [nm]


def closed_way_error(
    seas: Seaways,
    ends: Sequence[Endpoint],
    *,
    draught: float | None = None,
    beam: float | None = None,
    length: float | None = None,
    air_draught: float | None = None,
) -> NoPathError | None:
    """Return an error that names what is closed on the only way, or None if that is not the reason.

    Parameters
    ----------
    seas : The seaways that the voyage may use.
    ends : With via points between them.
    draught, beam, length, air_draught : Of the ship [m]; None where unknown.
    """
    restriction = partial(
        _restriction, draught=draught, beam=beam, length=length, air_draught=air_draught
    )
    for start, goal in pairwise(ends):
        if _has_way(seas, start, goal):
            continue
        closed = _closed_on_the_way(seas, start, goal, draught)
        if closed:
            return NoPathError(
                f"There is no way by water from {start.name} to {goal.name}.",
                "The way leads through " + "; ".join(_sentence(one, restriction(one))
                                                     for one in closed) + ".",
                "Load less, send a smaller ship or choose another port; or open it by its name "
                "(--open), and do not avoid it.",
                closed=[one.name for one in closed],
            )  # fmt: skip
    return None


def ways_closed_to_draught_notes(
    seas: Seaways, closed: Sequence[str], ends: Sequence[Endpoint], draught: float, length: float
) -> tuple[str, ...]:
    """Return notes on canals and passages closed to a draught that would make a way shorter.

    Both ways are over the graph and without shoals: miles that keep off these have a note of their
    own.

    Parameters
    ----------
    seas : With what is closed at any draught.
    closed : Names of the canals and passages that the draught closes as well.
    ends : With all ways from their berths, and with via points between them.
    draught : [m].
    length : Of the shortest way without them, with the approaches [m].
    """
    ways = ways_of_names(seas, closed)
    least_saved = max(_LEAST_SAVED, _LEAST_SHARE * length)
    if not ways or length - _straight_by_one(ways, ends) < least_saved:
        return ()
    through, line, entered = _shortest_way(replace(seas, shoals=None), ends, draught)
    saved = length - through
    if saved < least_saved:
        return ()
    used = [way for way in ways if way.name in entered] + ways_on_line(seas, ways, line)
    # without a length, passages for small ships would be closed for another reason
    reasons = {
        title_of_way(way): _restriction(way, draught=draught, length=0.0)
        for way in dict.fromkeys(used)
    }
    shorter = f"The way through is about {saved / NAUTICAL_MILE:,.0f} nm shorter."
    return tuple(f"{note}. {shorter}" for _, note in notes_by_reason(reasons))


def _has_way(seas: Seaways, start: Endpoint, goal: Endpoint) -> bool:
    try:
        seas.graph_path(start, goal)
    except NoRouteError:
        return False
    return True


def _closed_on_the_way(
    seas: Seaways, start: Endpoint, goal: Endpoint, draught: float | None
) -> list[NarrowWay]:
    """Return what is closed on the shortest way with all of it open, and has no way round it."""
    world = world_chart()
    try:
        line = Seaways(world).graph_path(start, goal)
    except NoRouteError:
        return []
    lat, lon = np.array(line).T
    open_passages = {passage.name for passage in seas.chart.passages} - set(seas.passages)
    crossed = passages_crossed(world.coastline, world.passages, lat, lon)
    found: list[NarrowWay] = [one for _, one in crossed if one.name not in open_passages]
    canal = np.asarray(world.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    open_canals = {one.name for one in seas.chart.canals} - set(seas.canals)
    used = [world.canals[k] for k in canal[canal >= 0].tolist()]
    found += [one for one in used if one.name not in open_canals]
    closed = Seaways(
        world,
        tuple(one.name for one in world.canals if one.name not in open_canals),
        tuple(one.name for one in world.passages if one.name not in open_passages),
    )
    if draught:
        ends = [(end.lat, end.lon) for end in (start, goal)]
        closed = replace(closed, shoals=shoals_of_draught(world, draught, draught, ends))
    return _without_ways_round(closed, found, start, goal)


def _without_ways_round(
    seas: Seaways, found: list[NarrowWay], start: Endpoint, goal: Endpoint
) -> list[NarrowWay]:
    """Return those of some closed passages and canals that all have to be open for a way.

    A way round one of them counts if it leads over no more shoal water.

    Parameters
    ----------
    seas : All of the world, with what is closed and with shoals.
    found : What is closed on one way.
    """

    def shoal_water(opened: list[NarrowWay]) -> float:
        names = {one.name for one in opened}
        part = replace(
            seas,
            canals=tuple(name for name in seas.canals if name not in names),
            passages=tuple(name for name in seas.passages if name not in names),
        )
        try:
            return shoal_miles(part, part.graph_path(start, goal))
        except NoRouteError:
            return math.inf

    needed, most = found, shoal_water(found) + _MORE_SHOALS
    for one in reversed(found):  # the first ones on a way stay where another could stand for them
        others = [other for other in needed if other is not one]
        if shoal_water(others) <= most:
            needed = others
    return needed or found


def _restriction(closed: NarrowWay, **dimensions: float | None) -> str:
    """Return why a passage or canal is closed to a ship, as text; empty if it fits."""
    if isinstance(closed, Passage):
        return closed.ship_restriction(**dimensions)
    return closed.transit_restriction(**dimensions)


def _sentence(closed: NarrowWay, why: str) -> str:
    return why or f"{closed.name}, which is closed here"


def _straight_by_one(ways: Sequence[NarrowWay], ends: Sequence[Endpoint]) -> float:
    """Return the least length [m] of straight lines from berth to berth by one of some ways."""
    places = [end.approach.berth if end.approach else (end.lat, end.lon) for end in ends]
    lines = [way.path if isinstance(way, Canal) else way.line for way in ways]
    dense = []
    for line in lines:
        y, x = np.array(line, float).T
        dense.append(densify(y, x, _PIECE)[:2])
    lat, lon = np.hstack(dense)
    straight, longer = 0.0, np.inf
    for a, b in pairwise(places):
        direct = float(distance(*a, *b))
        by_one = float(np.min(distance(*a, lat, lon) + distance(lat, lon, *b)))
        straight, longer = straight + direct, min(longer, by_one - direct)
    return straight + longer


def _shortest_way(
    seas: Seaways, ends: Sequence[Endpoint], draught: float
) -> tuple[float, list[Position], set[str]]:
    """Return the length [m] from berth to berth, the line at sea, and canals of the approaches."""
    chosen = with_chosen_ways(ends, lambda: seas, draught=draught)
    first, last = chosen[0].approach, chosen[-1].approach
    approaches = [approach for approach in (first, last) if approach is not None]
    entered = {approach.through for approach in approaches}
    if len(chosen) == 2 and first is not None and last is not None:
        along = line_between(first, last, legs_blocked=seas.chart.legs_blocked)
        if along is not None:
            return line_length(along), list(along), entered
    paths = [seas.graph_path(a, b) for a, b in pairwise(chosen)]
    line = [paths[0][0], *(place for path in paths for place in path[1:])]
    at_sea, _ = path_length_and_canals(seas.chart, line)
    return at_sea + sum(approach.length for approach in approaches), line, entered
