"""Which closed passages and canals are the reason that there is no way."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.planning.report.closed_way_report import NarrowWay
from thalweg.planning.report.distance_report import shoal_miles
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, world_chart

_MORE_SHOALS: Final = 5.0  # on a way round a passage [nm]


def closed_way_error(
    seas: Seaways,
    ends: Sequence[Endpoint],
    dimensions: Mapping[str, float | None],
    *,
    opens: bool = True,
) -> NoPathError | None:
    """Return an error that names what is closed on the only way, or None if that is not the reason.

    Parameters
    ----------
    seas : The seaways that the voyage may use.
    ends : With via points between them.
    dimensions : Draught, beam, length and air draught of the ship [m], by name; None where unknown.
    opens : Whether the request can open a passage to a ship that is too large for it.
    """
    for start, goal in pairwise(ends):
        if _has_way(seas, start, goal):
            continue
        closed = _closed_on_the_way(seas, start, goal, dimensions.get("draught"))
        if closed:
            reasons = {one.name: _restriction(one, **dimensions) for one in closed}
            why = "; ".join(_sentence(one, reasons[one.name]) for one in closed)
            return NoPathError(
                f"There is no way by water from {start.name} to {goal.name}.",
                f"The way leads through {why}.",
                _remedy(closed, reasons, opens),
                closed=list(reasons),
            )
    return None


def _remedy(closed: Sequence[NarrowWay], reasons: Mapping[str, str], opens: bool) -> str:
    """Return what the user can do about closed passages and canals, by the reasons [by name]."""
    too_large = any(reasons.values())
    texts = []
    if too_large:
        texts.append("Load less, send a smaller ship or choose another port")
        if opens and any(reasons[one.name] for one in closed if isinstance(one, Passage)):
            texts.append("or open the passage by its name (--open)")
    unused = [one for one in closed if not reasons[one.name]]
    if any(isinstance(one, Passage) and one.use == "small_or_local" for one in unused):
        texts.append("open the passage by its name (--open)")
    elif unused:
        texts.append("do not avoid it")
    text = "; ".join(texts)
    return f"{text[0].upper()}{text[1:]}."


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
        line = _with_least_change(start, goal, draught).graph_path(start, goal)
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


def _with_least_change(start: Endpoint, goal: Endpoint, draught: float | None) -> Seaways:
    """Return all of the world, without what asks for more change of the draught [m] than it must.

    Of the ways that are open at a smaller draught, those of the largest one are left.
    """
    world = Seaways(world_chart())
    every: list[NarrowWay] = [*world.chart.canals, *world.chart.passages]
    shallow = [one for one in every if draught and one.max_draught < draught]
    limits = sorted({one.max_draught for one in shallow}, reverse=True)

    def of_limit(number: int) -> Seaways:
        found = world
        for one in shallow:
            if one.max_draught < limits[number]:
                found = found.without(one.name)
        return found

    if not limits:
        return world
    number = bisect_left(range(len(limits)), True, key=lambda n: _has_way(of_limit(n), start, goal))
    return of_limit(min(number, len(limits) - 1))


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
