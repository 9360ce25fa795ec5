"""Notes on canals, passages and branches of approaches that a draught closes on a shorter way."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from thalweg.chart.approaches import PortApproach
from thalweg.chart.canals import Canal, sizes_over_limits
from thalweg.chart.depth.shoals import Shoals
from thalweg.chart.depth.shoals_of_draught import deep_channels
from thalweg.chart.passages import Passage
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import METRES_PER_DEGREE, Position, densify, distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.network_selection.way_over_seas import WayOverSeas, way_over_seas
from thalweg.planning.report.closed_way_report import (
    NarrowWay,
    notes_by_reason,
    title_of_way,
    ways_of_names,
    ways_on_line,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways

LEAST_SHARE: Final = 0.02  #: closed ways have a note that save so much of the distance ...
LEAST_SAVED: Final = 5.0 * NAUTICAL_MILE  #: ... and at least so much [m]
_PIECE: Final = 10.0 * NAUTICAL_MILE  # of the line of a closed way, to see how far off it is
_BULGE: Final = 0.2  # of great circles between the vertices of such lines beyond these [deg]
_BESIDE: Final = 2.0 * NAUTICAL_MILE  # a branch so near to a closed passage leads to it
_AS_SHORT: Final = 1.0 * NAUTICAL_MILE  # a way so little longer needs one closed way less


@dataclass(frozen=True)
class _ClosedToDraught:
    """What a draught [m] closes: canals and passages, and branches of the approaches of the ends.

    ``seas`` are without those canals and passages, ``ends`` with all ways from their berths.
    """

    seas: Seaways
    ends: Sequence[Endpoint]
    draught: float
    ways: Sequence[NarrowWay]
    branches: Sequence[PortApproach]

    def reasons_on(self, way: WayOverSeas) -> dict[str, str]:
        """Return the titles of what a way uses of it, with the reason why each is closed."""
        entered = {approach.through for approach in way.approaches}
        used = [one for one in self.ways if one.name in entered]
        used += ways_on_line(self.seas, self.ways, way.line)
        limits = {title_of_way(one): one.max_draught for one in used}
        depths = {branch.way: branch.way_draught for branch in self.branches}
        limits |= {
            self._title_of(approach): depths[approach.way]
            for approach in way.approaches
            if approach.way in depths
        }
        others = (None, None, None)
        return {
            title: f"the {what} of {over}"
            for title, limit in limits.items()
            for what, over in sizes_over_limits((self.draught, *others), (limit, *[math.inf] * 3))
        }

    def _title_of(self, branch: PortApproach) -> str:
        """Return the name of a branch: that of the passage it leads to, or its own."""
        for one in self.ways:
            if isinstance(one, Passage) and _is_beside(branch.line, one.line):
                return one.name
        return branch.way.removeprefix("by ").partition(" to ")[0]

    def way_through(self, titles: Collection[str] | None, offing: float | None) -> WayOverSeas:
        """Return the shortest way with some of it open, by title; None: all of it.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        opened = {one.name for one in self.ways if titles is None or title_of_way(one) in titles}
        seas = replace(
            self.seas,
            canals=tuple(name for name in self.seas.canals if name not in opened),
            passages=tuple(name for name in self.seas.passages if name not in opened),
            shoals=self._shoals_with(opened),
        )
        ends = [
            replace(end, other_ways=tuple(self._opened(way, titles) for way in end.other_ways))
            for end in self.ends
        ]
        return way_over_seas(seas, ends, draught=self.draught, offing=offing)

    def _shoals_with(self, opened: Collection[str]) -> Shoals | None:
        """Return the shoals without the deep channels that lead to what is opened, by name."""
        lines = [one.line for one in self.ways if isinstance(one, Passage) and one.name in opened]
        return shoals_open_beside(self.seas.shoals, lines, self.draught)

    def _opened(self, way: PortApproach, titles: Collection[str] | None) -> PortApproach:
        """Return a way from a berth without its limit, if it is one to open."""
        if way.way_draught < self.draught and (titles is None or self._title_of(way) in titles):
            return replace(way, way_draught=math.inf)
        return way

    def least_through(self) -> float:
        """Return the least length [m] of straight lines from berth to berth by a part of it."""
        berths = [end.approach.berth if end.approach else (end.lat, end.lon) for end in self.ends]
        lines = [way.path if isinstance(way, Canal) else way.line for way in self.ways]
        lines += [branch.line for branch in self.branches]
        lat, lon = np.hstack([_dense(line, _PIECE) for line in lines])
        straight, longer = 0.0, np.inf
        for a, b in pairwise(berths):
            direct = float(distance(*a, *b))
            by_one = float(np.min(distance(*a, lat, lon) + distance(lat, lon, *b)))
            straight, longer = straight + direct, min(longer, by_one - direct)
        return straight + longer


def shoals_open_beside(
    shoals: Shoals | None, lines: Sequence[Sequence[Position]], draught: float
) -> Shoals | None:
    """Return shoals without the deep channels beside lines that are too shallow for a draught.

    Parameters
    ----------
    lines : Of passages that are opened in spite of the draught, positions [deg].
    draught : [m].
    """
    channels = [
        channel.line
        for channel in deep_channels()
        if channel.max_draught < draught and any(_is_beside(channel.line, line) for line in lines)
    ]
    if shoals is None or not channels:
        return shoals
    return replace(shoals, channels=(*shoals.channels, *channels))


def closed_to_draught_notes(
    seas: Seaways, closed: Collection[str], ends: Sequence[Endpoint], way: WayOverSeas,
    *, draught: float, offing: float,
) -> tuple[str, ...]:  # fmt: skip
    """Return a note on what is closed to a draught that would make a way shorter.

    It names what has to be open for that, and states by how much the ship's way with it is shorter.

    Parameters
    ----------
    seas : The seaways that the ship may use, with the shoals of the draught.
    closed : Names of the canals and passages that the draught closes.
    ends : With all ways from their berths, and with via points between them.
    way : The shortest way that is open.
    draught : [m].
    offing : Distance from land that ways keep [m].

    Returns
    -------
    tuple of str : One or none.
    """
    branches = [one for end in ends for one in end.other_ways if one.way_draught < draught]
    every = _ClosedToDraught(seas, ends, draught, ways_of_names(seas, sorted(closed)), branches)
    least_saved = max(LEAST_SAVED, LEAST_SHARE * way.length)
    if not (every.ways or branches) or way.length - every.least_through() < least_saved:
        return ()
    reasons = _needed(every)
    if not reasons:
        return ()
    through = every.way_through(reasons, offing)
    saved = way.length - through.length
    if saved < least_saved:
        return ()
    about = ". ".join(note for _, note in notes_by_reason(reasons))
    return (f"{about}. The way through is about {saved / NAUTICAL_MILE:,.0f} nm shorter.",)


def _needed(every: _ClosedToDraught) -> dict[str, str]:
    """Return what the shortest way over the graph uses and cannot do without, with the reasons."""
    try:
        shortest = every.way_through(None, None)
    except NoRouteError:
        return {}
    needed = every.reasons_on(shortest)
    if len(set(needed.values())) < 2:  # no other limit matters more than that of all of them
        return needed
    for title in reversed(list(needed)):
        others = [other for other in needed if other != title]
        try:
            without = every.way_through(others, None)
        except NoRouteError:
            continue
        if others and without.length <= shortest.length + _AS_SHORT:
            needed = {name: needed[name] for name in others}
    return needed


def _is_beside(line: Sequence[Position], other: Sequence[Position]) -> bool:
    """Return whether two lines come within `_BESIDE` of each other."""
    (south, north), (low, high) = ((min(p)[0], max(p)[0]) for p in (line, other))
    apart = _BESIDE / METRES_PER_DEGREE + _BULGE
    if south > high + apart or low > north + apart:
        return False
    lat, lon = _dense(line, _BESIDE)
    y, x = _dense(other, _BESIDE)
    return bool(np.min(distance(lat[:, None], lon[:, None], y, x)) < _BESIDE)


def _dense(line: Sequence[Position], step: float) -> tuple[FloatArray, FloatArray]:
    """Return latitudes and longitudes [deg] along a line, at most a step [m] apart."""
    vertices = np.array(line, float)
    lat, lon, _ = densify(vertices[:, 0], vertices[:, 1], step)
    return lat, lon
