"""Which closed passages and canals are the reason that there is no way between two places."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np

from thalweg.chart.canals import Canal
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, world_chart


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
        closed = _closed_on_the_way(seas, start, goal)
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


def _has_way(seas: Seaways, start: Endpoint, goal: Endpoint) -> bool:
    try:
        seas.graph_path(start, goal)
    except NoRouteError:
        return False
    return True


def _closed_on_the_way(seas: Seaways, start: Endpoint, goal: Endpoint) -> list[Passage | Canal]:
    """Return the closed passages and canals of the shortest way with all of them open."""
    world = world_chart()
    try:
        line = Seaways(world).graph_path(start, goal)
    except NoRouteError:
        return []
    lat, lon = np.array(line).T
    open_here = {passage.name for passage in seas.chart.passages} - set(seas.passages)
    crossed = passages_crossed(world.coastline, world.passages, lat, lon)
    found: list[Passage | Canal] = [one for _, one in crossed if one.name not in open_here]
    canal = np.asarray(world.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    canals = {one.name for one in seas.chart.canals} - set(seas.canals)
    used = [world.canals[k] for k in canal[canal >= 0].tolist()]
    return found + [one for one in used if one.name not in canals]


def _restriction(closed: Passage | Canal, **dimensions: float | None) -> str:
    """Return why a passage or canal is closed to a ship, as text; empty if it fits."""
    if isinstance(closed, Passage):
        return closed.ship_restriction(**dimensions)
    return closed.transit_restriction(**dimensions)


def _sentence(closed: Passage | Canal, why: str) -> str:
    return why or f"{closed.name}, which is closed here"
