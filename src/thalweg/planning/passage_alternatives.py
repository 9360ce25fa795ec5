"""Other ways for a planned voyage: round each canal and passage that it uses."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from thalweg.chart.canals import canals_with_dues
from thalweg.chart.passage_crossings import CAPES, names_passed
from thalweg.core.errors import NoRouteError
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.planning.network_selection.way_choice import with_chosen_ways, without_small_ways
from thalweg.planning.plan_data import PlanData
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.planning.request.voyage_endpoints import Endpoint, resolve_places
from thalweg.planning.seaways import Seaways, path_length_and_canals

#: Ways round passages longer than this multiple of the shortest are left out; those hardly longer
#: are as well.
MAX_DETOUR: Final = 2.2
_LEAST_DETOUR: Final = 3.0 * NAUTICAL_MILE
_MOST_SEARCHES: Final = 12
_MOST_SECOND: Final = 3  # alternatives whose own new passages are closed in turn as well


@dataclass(frozen=True)
class PassageAlternative:
    """A way of a voyage with some canals and passages closed.

    Attributes
    ----------
    without : Canals and passages that are closed; none for the shortest way.
    passes : Canals, named passages and capes of the way, in order; canals first.
    distance : Length of the way with approaches [m].
    time : At the mean speed at sea of the plan, with approaches and transits of canals [s].
    canal_dues_usd : Dues of its canals [USD].
    """

    without: tuple[str, ...]
    passes: tuple[str, ...]
    distance: float
    time: float
    canal_dues_usd: float

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON, distance in nautical miles and time in hours."""
        return {
            "without": list(self.without),
            "passes": list(self.passes),
            "distance_nm": self.distance / NAUTICAL_MILE,
            "time_h": self.time / HOUR,
            "canal_dues_usd": self.canal_dues_usd,
        }


@dataclass(frozen=True)
class _Question:
    """What all ways of a voyage have in common."""

    seas: Seaways
    ends: tuple[Endpoint, ...]
    offing: float
    speed: float
    approach_speed: float
    draught: float
    dues: Mapping[str, float]

    def alternative(self, closed: tuple[str, ...]) -> PassageAlternative:
        """Return the shortest way with more canals and passages closed."""
        seas = self.seas
        for name in closed:
            seas = seas.without(name)
        ends = with_chosen_ways(self.ends, lambda: seas, draught=self.draught)
        parts = [seas.path(a, b, offing=self.offing) for a, b in itertools.pairwise(ends)]
        path = [parts[0][0], *(place for part in parts for place in part[1:])]
        at_sea, titles = path_length_and_canals(seas.chart, path)
        canals = [canal for canal in seas.chart.canals if canal.title in titles]
        in_canals = sum(canal.length for canal in canals)
        lines = [end.approach for end in (ends[0], ends[-1]) if end.approach is not None]
        near = sum(line.length for line in lines)
        time = (at_sea - in_canals) / self.speed + sum(canal.transit_time for canal in canals)
        time += sum(line.duration(min(self.speed, self.approach_speed)) for line in lines)
        entered = {line.through for line in lines}
        canals += [canal for canal in seas.chart.canals if canal.name in entered]
        names = names_passed(seas.chart.coastline, seas.chart.passages, *np.array(path).T)
        return PassageAlternative(
            closed,
            (*(canal.name for canal in canals), *names),
            at_sea + near,
            time,
            sum(self.dues.get(canal.name, canal.fee) for canal in canals),
        )


def passage_alternatives(plan: PlanData) -> tuple[PassageAlternative, ...]:
    """Return the ways of a planned voyage by and round the canals and passages it uses.

    Parameters
    ----------
    plan : On a chart of the world's coasts.

    Returns
    -------
    tuple of PassageAlternative : The shortest first; empty where the plan passes no canal and no
        named passage, or the chart is of the user's own.

    Notes
    -----
    Each way is the shortest by distance, as of `thalweg.distance`, for the ship's open canals and
    passages and with one more of those closed that the shortest one uses (for some ways two).
    Weather, depth and zones are not considered: plan with ``avoid`` for that.
    """
    question = _question(plan)
    if question is None:
        return ()
    shortest = question.alternative(())
    found = {frozenset(shortest.passes): shortest}
    canals = {canal.name for canal in question.seas.chart.canals}
    for closed in _to_close(shortest, found):
        try:
            other = question.alternative(closed)
        except NoRouteError:
            continue
        longer = other.distance - shortest.distance
        most = math.inf if closed[0] in canals else (MAX_DETOUR - 1.0) * shortest.distance
        if _LEAST_DETOUR <= longer <= most:
            found.setdefault(frozenset(other.passes), other)
    return tuple(sorted(found.values(), key=lambda way: way.distance))


def _to_close(
    shortest: PassageAlternative, found: dict[frozenset[str], PassageAlternative]
) -> Iterator[tuple[str, ...]]:
    """Yield what to close: each passage of the shortest way, then also those of the others."""
    first = [(name,) for name in shortest.passes if name not in CAPES]
    yield from itertools.islice(first, _MOST_SEARCHES)
    left = _MOST_SEARCHES - len(first)
    others = [way for way in found.values() if way.without][:_MOST_SECOND]
    second = (
        (*way.without, name)
        for way in others
        for name in way.passes
        if name not in shortest.passes and name not in CAPES
    )
    yield from itertools.islice(second, max(left, 0))


def _question(plan: PlanData) -> _Question | None:
    """Return what to ask for a plan, or None where it passes nothing that could be closed."""
    context = plan.plot_context
    if context is None or context.chart.approaches is None:
        return None
    chart, track = context.chart, plan.best.track
    lat, lon = np.asarray(track.lat), np.asarray(track.lon)
    in_canals = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])) >= 0
    kind = np.asarray(plan.best.legs["leg_kind"])
    at_sea = kind == 0
    if not (in_canals.any() or names_passed(chart.coastline, chart.passages, lat, lon)):
        return None
    legs = plan.best.legs
    duration = np.asarray(legs["arrive"]) - np.asarray(legs["depart"])
    sailed = float(np.sum(np.asarray(legs["length"])[at_sea]))
    time = float(np.sum(duration[at_sea]))  # without waits: a leg departs after its wait
    speed = sailed / time if sailed > 0.0 and time > 0.0 else context.ship.approach_speed
    canals = canals_with_dues(chart.canals, context.ship.file.hull)
    voyage = plan.voyage
    joins = voyage.offing_nm != 0.0
    ends = resolve_places(voyage.start, voyage.via, voyage.goal, chart, joins=joins)
    return _Question(
        replace(Seaways.of_ship_chart(chart), known_parts={}),
        tuple(without_small_ways(ends, ship_dimensions(context.ship))),
        chart.offing.distance,
        max(speed, 0.1 * KNOT),
        context.ship.approach_speed,
        float(context.ship.draught),
        {canal.name: canal.fee for canal in canals},
    )
