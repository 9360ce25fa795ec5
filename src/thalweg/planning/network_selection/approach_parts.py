"""Where a way leaves the approach of a port before its sea end, because it leads elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import shapely

from thalweg.chart.approach_choices import LEAST_OFF_LAND
from thalweg.chart.approaches import dense_line, line_part
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.depth.shoals import EXCESS, Shoals
from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.leg_ends import leg_ends
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, distance, format_position_minutes
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.endpoint_attachment import LinePlaces
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals

#: What leaving the charted channels has to save: of the whole way this share; or as much as is left
#: out of the lines, which would be sailed back; or half of that, and some miles.
_LEAST_SHARE: Final = 0.1
_LEAST_SHARE_NEARER: Final = 0.05  # over another way that leaves the lines farther off land
_LEAST_OF_LONG_WAYS: Final = 0.02  # a ship on a long voyage takes the charted channel
_LEAST_SHARE_OF_LINE: Final = 0.5
_LEAST_GAIN: Final = 5.0 * NAUTICAL_MILE  # in the last case
_SHORTEST_LEFT_OUT: Final = 1.0 * NAUTICAL_MILE
_USUAL_OFF_LAND: Final = 1.0 * NAUTICAL_MILE  # where a line is left, if that does
_SPACING: Final = 0.5 * NAUTICAL_MILE  # of the places at which a line may be left
_USUAL_DRAUGHT: Final = (
    8.0  # ships of less, and of none that is known, keep to channels as well [m]
)
_MOST_SHOAL: Final = EXCESS[0]  # of a mile where the depth is the draught


def ends_left_early(
    start: Endpoint, goal: Endpoint, seas: Seaways, *, draught: float, longest: float
) -> tuple[float, list[Endpoint]] | None:
    """Return two ends with their approaches cut where the way between them leaves these.

    What that saves is counted over the shortest ways, whatever their depth. If shoals counted, deep
    ships would leave channels that others keep to, and would have shorter ways.

    Parameters
    ----------
    start, goal : By the ways that make the distance least, as far as their sea ends.
    seas : The seaways that the voyage may use, without shoals.
    draught : Of the ship [m], 0 where it is not known.
    longest : Distance from berth to berth by those ways [m].

    Returns
    -------
    (float, list of Endpoint), or None : Distance from berth to berth [m] and the ends; None where
        that does not save clearly, or leads over shoals.
    """
    if not (start.may_leave_early or goal.may_leave_early):
        return None
    ends = start, goal
    best = _left_off_land(ends, seas, draught, longest=longest, off_land=_USUAL_OFF_LAND)
    if best is None:
        return _left_off_land(ends, seas, draught, longest=longest, off_land=LEAST_OFF_LAND)
    nearer = _left_off_land(
        ends, seas, draught, longest=best[0], off_land=LEAST_OFF_LAND, share=_LEAST_SHARE_NEARER
    )
    return nearer or best


def _left_off_land(
    ends: tuple[Endpoint, Endpoint],
    seas: Seaways,
    draught: float,
    *,
    longest: float,
    off_land: float,
    share: float = _LEAST_SHARE,
) -> tuple[float, list[Endpoint]] | None:
    """Return the distance and the ends by a way that leaves the lines off land; None if no better.

    Parameters
    ----------
    longest, share : Distance [m] that has to be shortened, and by what share.
    off_land : Distance from land of the places where a line is left [m].
    """
    lines = [_places_of(end, seas, off_land) for end in ends]
    both = _cut_that_saves(ends, lines, seas, draught, (longest, share))
    if both is None or both[1]:
        return both
    if not all(line.may_leave.sum() > 1 for line in lines):
        return None
    whole = [_left_at_its_end(line) for line in lines]
    found = [
        _cut_that_saves(ends, choice, seas, draught, (longest, share))
        for choice in ([lines[0], whole[1]], [whole[0], lines[1]])
    ]
    clear = [one for one in found if one is not None and one[1]]
    return min(clear, key=lambda one: one[0], default=None)


def _left_at_its_end(line: LinePlaces) -> LinePlaces:
    """Return the places of a line that is left at its sea end only."""
    may_leave = np.zeros(len(line.lat), bool)
    may_leave[-1] = True
    return replace(line, may_leave=may_leave)


def _cut_that_saves(
    ends: tuple[Endpoint, Endpoint],
    lines: Sequence[LinePlaces],
    seas: Seaways,
    draught: float,
    wanted: tuple[float, float],
) -> tuple[float, list[Endpoint]] | None:
    """Return the distance and the cut ends, none of them if over shoals; None if little is saved.

    Parameters
    ----------
    wanted : Distance [m] that has to be shortened, and by what share.
    """
    longest, share = wanted
    try:
        length, path, cut = _cut_ends(ends, lines, seas)
    except NoRouteError:
        return None
    left_out = [_length(a) - _length(b) for a, b in zip(ends, cut)]
    turned_back = min(sum(left_out), max(_LEAST_GAIN, _LEAST_SHARE_OF_LINE * sum(left_out)))
    least_gain = max(
        min(share * longest, turned_back), _LEAST_OF_LONG_WAYS * longest, _SHORTEST_LEFT_OUT
    )
    if longest - length < least_gain:
        return None
    harbours = _harbours(ends, cut)
    depth = max(draught, _USUAL_DRAUGHT)
    shoals = _shoals(seas, harbours, depth)
    return length, [] if _has_shoals(path, left_out, shoals, depth) else cut


def _places_of(end: Endpoint, seas: Seaways, off_land: float) -> LinePlaces:
    """Return the places of the line of an approach, from the berth; or the end, which has none.

    Parameters
    ----------
    off_land : It is left at least so far from land [m], or at its sea end.
    """
    approach = end.approach
    if approach is None:
        lat, lon = np.array([end.lat]), np.array([end.lon])
        return LinePlaces(lat, lon, np.zeros(1), np.ones(1, bool))
    dense = dense_line(approach.line)
    count = max(int(dense[-1, 2] / _SPACING), 1)
    wanted = np.linspace(0.0, dense[-1, 2], count + 1)
    rows = dense[np.unique(np.searchsorted(dense[:, 2], wanted).clip(0, len(dense) - 1))]
    may_leave = np.zeros(len(rows), bool)
    if end.may_leave_early and not approach.canal and not approach.through:
        coast = seas.chart.coastline
        off = coast.shore_distance(rows[:, 0], rows[:, 1], cap=off_land)
        may_leave = np.asarray(off) >= off_land
    may_leave[0], may_leave[-1] = False, True  # a berth is left along its line
    return LinePlaces(rows[:, 0], rows[:, 1], rows[:, 2], may_leave)


def _cut_ends(
    ends: tuple[Endpoint, Endpoint], lines: Sequence[LinePlaces], seas: Seaways
) -> tuple[float, list[Position], list[Endpoint]]:
    """Return the shortest way from berth to berth: its length [m], the part at sea, and its ends.

    Raises
    ------
    NoRouteError : If there is no way.
    """
    path, numbers = seas.path_between_lines(*lines)
    cut = [_cut(end, float(line.along[k])) for end, line, k in zip(ends, lines, numbers)]
    length, _ = path_length_and_canals(seas.chart, path)
    return length + sum(map(_length, cut)), path, cut


def _cut(end: Endpoint, along: float) -> Endpoint:
    """Return an end whose approach is left at a length from the berth [m]."""
    approach = end.approach
    if approach is None or approach.length - along < _SHORTEST_LEFT_OUT:
        return end
    line = tuple(line_part(approach.line, along))
    way = f"{approach.way} as far as {format_position_minutes(*line[-1])}".strip()
    return end.by(replace(approach, line=line, way=way))


def _has_shoals(
    path: Sequence[Position], left_out: Sequence[float], shoals: Shoals, draught: float
) -> bool:
    """Return whether a way is over shoals as long as the parts of the lines [m] that it leaves.

    A named shoal area counts beside a channel as well, unless a harbour is in it.
    """
    legs = leg_ends(*np.array(path, float).T)
    sailed = cumulative_sums(distance(*legs))
    beside = (sailed[:-1] < left_out[0]) | (sailed[-1] - sailed[1:] < left_out[1])
    if np.any(np.asarray(shoals.excess(*legs))[beside] > _MOST_SHOAL):
        return True
    if not beside.any():
        return False
    harbours = np.array(shoals.harbours).reshape(-1, 2).T
    parts = np.stack(legs, axis=1)[beside].reshape(-1, 2, 2)[:, :, ::-1]
    lines = shapely.multilinestrings(list(shapely.linestrings(parts)))
    return any(
        area.depth < draught
        and not area.contains(*harbours).any()
        and area.polygon.intersects(lines)
        for area in SHOAL_AREAS
    )


def _shoals(seas: Seaways, harbours: Sequence[Position], draught: float) -> Shoals:
    return shoals_of_draught(seas.chart, draught, draught, harbours)


def _harbours(ends: Sequence[Endpoint], cut: Sequence[Endpoint]) -> list[Position]:
    """Return the berths, and the sea ends of approaches that are not left early."""
    berths = [end.approach.berth if end.approach else (end.lat, end.lon) for end in ends]
    return berths + [(a.lat, a.lon) for a, b in zip(ends, cut) if a is b]


def _length(end: Endpoint) -> float:
    return 0.0 if end.approach is None else end.approach.length
