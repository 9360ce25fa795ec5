"""Which way a voyage takes between each berth and the sea: the one of the least total distance."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np

from thalweg.chart.approaches import line_between, line_length
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

_LEAST_GAIN: Final = 0.5 * NAUTICAL_MILE  # of another way than the approach of the table
#: A way within a bay leaves the charted channels: it has to be shorter by this share of them.
_LEAST_GAIN_IN_BAY: Final = 0.1
_USUAL_DRAUGHT: Final = 8.0  # where none is given, for shoals in a bay [m]
_MOST_SHOAL: Final = 1.0  # excess of a mile across a bay by shoals (`thalweg.chart.depth.shoals`)


def with_chosen_ways(
    ends: Sequence[Endpoint], seas: Callable[[], Seaways], *, draught: float = 0.0
) -> list[Endpoint]:
    """Return the ends of a voyage with the ways from their berths that make it shortest.

    Parameters
    ----------
    ends : With via points between them.
    seas : Called only where there is a choice: the seaways that the voyage may use.
    draught : Of the ship [m]: ways that are too shallow are left out.

    Returns
    -------
    list of Endpoint : A way to a canal is chosen only where the voyage passes that canal, and one
        within a bay only for both ends together, by water without shoals.
    """
    found = [_without_shallow_ways(end, draught) for end in ends]
    if len(found) > 2 or not _share_a_bay(found[0], found[-1]):
        found = [_without_ways_in_bays(end) for end in found]
    if not (found[0].other_ways or found[-1].other_ways):
        return found
    if len(found) == 2:
        return _best_pair(found[0], found[1], seas(), draught)
    if found[0].other_ways:
        found[0] = _best_pair(found[0], found[1], seas(), draught)[0]
    if found[-1].other_ways:
        found[-1] = _best_pair(found[-2], found[-1], seas(), draught)[1]
    return found


def _best_pair(start: Endpoint, goal: Endpoint, seas: Seaways, draught: float) -> list[Endpoint]:
    """Return two ends by the ways that make the distance between them least."""
    open_canals = {c.name for c in seas.chart.canals} - set(seas.canals)
    ways = [[way for way in _by_way(end) if _is_open(way, open_canals)] for end in (start, goal)]
    outward, inward = ([way for way in of_end if not _left_out(way)] for of_end in ways)
    in_bay = [[way for way in of_end if _left_out(way)] or of_end[:1] for of_end in ways]
    both = [*product(outward, inward), *product(*in_bay)]
    pairs = [_Pair.of(a, b, seas) for a, b in both]
    best, least = pairs[0], math.inf
    for number, pair in sorted(enumerate(pairs), key=lambda item: item[1].bound):
        if pair.bound >= least:
            break
        length = pair.length(seas, draught) + (_LEAST_GAIN if number else 0.0)
        length /= 1.0 - (_LEAST_GAIN_IN_BAY if pair.in_bay else 0.0)
        if length < least:
            best, least = pair, length
    return [best.start, best.goal]


def _left_out(end: Endpoint) -> float:
    """Return how much of its approach a way within a bay leaves out [m]; 0 for other ways."""
    return 0.0 if end.approach is None else end.approach.left_out


def _share_a_bay(start: Endpoint, goal: Endpoint) -> bool:
    """Return whether two ends may lie on one bay: the ways out of it are longer than between.

    The approach of one of them may end within the bay, as that of Campana on the River Plate.
    """
    if start.approach is None or goal.approach is None:
        return False
    inside = [
        next((way for way in end.other_ways if way.left_out), end.approach)
        for end in (start, goal)
        if end.approach is not None
    ]
    apart = float(distance(*inside[0].sea_end, *inside[1].sea_end))
    return apart < inside[0].left_out + inside[1].left_out


def _without_ways_in_bays(end: Endpoint) -> Endpoint:
    return replace(end, other_ways=tuple(way for way in end.other_ways if not way.left_out))


def _without_shallow_ways(end: Endpoint, draught: float) -> Endpoint:
    deep = tuple(way for way in end.other_ways if way.way_draught >= draught)
    return replace(end, other_ways=deep) if deep != end.other_ways else end


def _by_way(end: Endpoint) -> list[Endpoint]:
    return [end, *(end.by(way) for way in end.other_ways)]


def _is_open(end: Endpoint, canals: Collection[str]) -> bool:
    """Return whether the canal that a way leads through, if any, is open."""
    return end.approach is None or not end.approach.through or end.approach.through in canals


@dataclass(frozen=True)
class _Pair:
    """Two ends by one way each, and a bound of the distance between them [m].

    ``shared`` is the length along their lines where these meet, else NaN.
    """

    start: Endpoint
    goal: Endpoint
    bound: float
    shared: float

    @classmethod
    def of(cls, start: Endpoint, goal: Endpoint, seas: Seaways) -> _Pair:
        a, b = start.approach, goal.approach
        if a is not None and b is not None:
            line = line_between(a, b, legs_blocked=seas.chart.legs_blocked)
            if line is not None:
                return cls(start, goal, line_length(line), line_length(line))
        apart = float(distance(start.lat, start.lon, goal.lat, goal.lon))
        return cls(start, goal, _of_lines(start, goal) + apart, math.nan)

    @property
    def in_bay(self) -> bool:
        """Whether one of the ways ends within a bay."""
        return _left_out(self.start) > 0.0 or _left_out(self.goal) > 0.0

    def length(self, seas: Seaways, draught: float) -> float:
        """Return the distance [m]; inf where there is no way through the canals of the lines."""
        if not math.isnan(self.shared):
            return self.shared
        with contextlib.suppress(NoRouteError):
            if self.in_bay:
                return self._length_in_bay(seas, draught)
            path = seas.graph_path(self.start, self.goal)
            at_sea, passed = path_length_and_canals(seas.chart, path)
            wanted = {
                canal.title
                for canal in seas.chart.canals
                for end in (self.start, self.goal)
                if end.approach is not None and end.approach.canal == canal.name
            }
            if wanted <= set(passed):
                return _of_lines(self.start, self.goal) + at_sea
        return math.inf

    def _length_in_bay(self, seas: Seaways, draught: float) -> float:
        """Return the distance [m] straight across a bay, or round its land; inf over shoals."""
        path = [(self.start.lat, self.start.lon), (self.goal.lat, self.goal.lon)]
        if np.any(seas.chart.legs_blocked(*_legs(path))):
            path = seas.graph_path(self.start, self.goal)
        length, canals = path_length_and_canals(seas.chart, path)
        if canals or self._has_shoals(path, seas, draught):
            return math.inf
        return _of_lines(self.start, self.goal) + length

    def _has_shoals(self, path: Sequence[Position], seas: Seaways, draught: float) -> bool:
        """Return whether a leg of a way between the ends is over shoals."""
        from thalweg.planning.request.shoal_choice import shoals_of_draught

        depth = draught or _USUAL_DRAUGHT
        shoals = shoals_of_draught(seas.chart, depth, depth, (self.start, self.goal))
        return bool(shoals.excess(*_legs(path)).max() > _MOST_SHOAL)


def _legs(path: Sequence[Position]) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    lat, lon = np.array(path, float).T
    return lat[:-1], lon[:-1], lat[1:], lon[1:]


def _of_lines(*ends: Endpoint) -> float:
    return sum(end.approach.length for end in ends if end.approach is not None)
