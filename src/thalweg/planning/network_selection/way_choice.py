"""Which way a voyage takes between each berth and the sea: the one of the least total distance."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np

from thalweg.chart.approach_choices import line_between
from thalweg.chart.approaches import PortApproach
from thalweg.chart.canals import CANALS
from thalweg.chart.port_limits.bridges import bridges_over
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import distance, line_length
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.network_selection.approach_parts import ends_left_early
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

_LEAST_GAIN: Final = 0.5 * NAUTICAL_MILE  # of another way than the approach of the table
_LONGEST_ON_LAND: Final = 6.0 * NAUTICAL_MILE  # of a leg in a river that no coastline shows


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
    list of Endpoint : A way to a canal is chosen only where the voyage passes that canal. An
        approach is left before its sea end where that saves clearly, by water without shoals.
    """
    found = [_without_shallow_ways(end, draught) for end in ends]
    if not any(_has_choice(end) for end in (found[0], found[-1])):
        return found
    if len(found) == 2:
        return _best_pair(found[0], found[1], seas(), draught)
    if _has_choice(found[0]):
        found[0] = _best_pair(found[0], found[1], seas(), draught)[0]
    if _has_choice(found[-1]):
        found[-1] = _best_pair(found[-2], found[-1], seas(), draught)[1]
    return found


def without_small_ways(
    ends: Sequence[Endpoint], sizes: Mapping[str, float | None]
) -> list[Endpoint]:
    """Return ends without the other ways from their berths that are too short or low for a ship.

    Parameters
    ----------
    sizes : Length and air draught [m], by name; those that are unknown are not checked.
    """
    length, height = sizes.get("length") or 0.0, sizes.get("air_draught") or 0.0

    def fits(way: PortApproach) -> bool:
        low = height > 0.0 and any(one.clearance < height for one in bridges_over(way.line))
        return not low and way.way_length >= length

    return [replace(end, other_ways=tuple(filter(fits, end.other_ways))) for end in ends]


def _has_choice(end: Endpoint) -> bool:
    return bool(end.other_ways) or end.may_leave_early


def _best_pair(start: Endpoint, goal: Endpoint, seas: Seaways, draught: float) -> list[Endpoint]:
    """Return two ends by the ways that make the distance between them least."""
    open_canals = {c.name for c in seas.chart.canals} - set(seas.canals)
    ways = [_open_ways(end, seas, open_canals) for end in (start, goal)]
    pairs = [_Pair.of(a, b, seas) for a, b in product(*ways)]
    best, least = pairs[0], math.inf
    for number, pair in sorted(enumerate(pairs), key=lambda item: item[1].bound):
        if pair.bound >= least:
            break
        length = pair.length(seas) + (_LEAST_GAIN if number else 0.0)
        if length < least:
            best, least = pair, length
    tried = [best] if best is pairs[0] else [best, pairs[0]]
    anywhere = replace(seas, shoals=None)
    longest = min(pair.length(anywhere) for pair in tried)
    early = [
        ends_left_early(pair.start, pair.goal, anywhere, draught=draught, longest=longest)
        for pair in tried
    ]
    shortest = min((one for one in early if one is not None), key=lambda one: one[0], default=None)
    return [best.start, best.goal] if shortest is None else list(shortest[1])


def _without_shallow_ways(end: Endpoint, draught: float) -> Endpoint:
    deep = tuple(way for way in end.other_ways if way.way_draught >= draught)
    return replace(end, other_ways=deep) if deep != end.other_ways else end


def _by_way(end: Endpoint) -> list[Endpoint]:
    return [end, *(end.by(way) for way in end.other_ways)]


def _open_ways(end: Endpoint, seas: Seaways, canals: Collection[str]) -> list[Endpoint]:
    """Return an end by its ways that are open.

    Raises
    ------
    NoRouteError : For a berth inside a canal whose line by land alone is left: the canal is closed.
    """
    found = [way for way in _by_way(end) if _is_open(way, canals)]
    through = [way.through for way in end.other_ways if way.through]
    if not through or not _is_overland(end, seas):
        return found
    if found[1:]:
        return found[1:]
    titles = [canal.title for canal in CANALS if canal.name in through]
    raise NoRouteError(
        f"{end.name} lies inside the {' and the '.join(titles)}, which is closed here.",
        "The canal is its only way to the sea: it is avoided, or too small for the ship.",
        "Do not avoid it, or choose another port.",
        reasons={},
    )


def _is_overland(end: Endpoint, seas: Seaways) -> bool:
    """Return whether the line of an approach leads over land for miles: it is no way."""
    if end.approach is None:
        return False
    lat, lon = np.array(end.approach.line, float).T
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    blocked = np.asarray(seas.chart.legs_blocked(*legs))
    return bool(np.any(blocked & (np.asarray(distance(*legs)) > _LONGEST_ON_LAND)))


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

    def length(self, seas: Seaways) -> float:
        """Return the distance [m]; inf where there is no way through the canals of the lines."""
        if not math.isnan(self.shared):
            return self.shared
        with contextlib.suppress(NoRouteError):
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


def _of_lines(*ends: Endpoint) -> float:
    return sum(end.approach.length for end in ends if end.approach is not None)
