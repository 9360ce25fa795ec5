"""Points of a sailed track at which limits are checked, closer where a limit is nearly reached."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.limit_checks import limit_excesses
from thalweg.route.referee.sailing import SailedTrack, data_spacings
from thalweg.route.referee.sailing_physics import sample_sea_and_depth

MAX_CHECK_POINTS = 10_000  #: points at which limits are checked first (fewer on coarse data)
CHECK_POINTS_PER_CELL = 8  #: of gridded data
_LONGEST_INTERVAL: Final = 1800.0  # between two points, or half the time step of data [s]
_PARTS: Final = 8  # of an interval in which a limit may be exceeded between two points
_ROUNDS: Final = 3
_MOST_DIVIDED: Final = 500  # intervals in a round
_CLEAR: Final = 0.01  # of the least depth of a leg [m]


@dataclass(frozen=True)
class CheckedPoints:
    """The sea at points of a track, in the order of sailing.

    Attributes
    ----------
    points, moments : The points and their times of passage [s]; NaN where the ship does not get.
    sampled : The sea there.
    depth : Water depth there [m].
    """

    points: TrackPoints
    moments: FloatArray
    sampled: Mapping[str, FloatArray]
    depth: FloatArray

    def longest_interval(self) -> float:
        """Return the longest time between two neighbours on a leg [s]."""
        on_leg = np.diff(self.points.leg) == 0
        return float(np.max(np.diff(self.moments), initial=0.0, where=on_leg))

    def joined(self, other: CheckedPoints) -> CheckedPoints:
        """Return these points and others in the order of sailing."""
        leg = np.append(self.points.leg, other.points.leg)
        order = np.lexsort((np.append(self.points.along, other.points.along), leg))
        both = zip(vars(self.points).values(), vars(other.points).values(), strict=True)
        return CheckedPoints(
            TrackPoints(*(np.append(one, two)[order] for one, two in both)),
            np.append(self.moments, other.moments)[order],
            {k: np.append(v, other.sampled[k])[order] for k, v in self.sampled.items()},
            np.append(self.depth, other.depth)[order],
        )


def checked_points(
    sailed: SailedTrack, points: TrackPoints, time: FloatArray, min_ukc: float
) -> CheckedPoints:
    """Return closely spaced points where limits are checked.

    Between two points at which all limits are kept, and beside which the sea changes so fast that
    one may be exceeded between them, further points are looked at. Likewise where the depth may be
    less than the least of the leg: a sill of one row of the data is narrower than their spacing.

    Parameters
    ----------
    points, time : Where and when the track was sailed, in order [s].
    min_ukc : Least under-keel clearance [m].
    """
    world, pieces = sailed.world, sailed.pieces
    spacing = float(pieces.length.sum()) / MAX_CHECK_POINTS
    spacing = max(spacing, min(data_spacings(world, 1.0 / CHECK_POINTS_PER_CELL), default=0.0))
    count = np.maximum(np.ceil(pieces.length / max(spacing, 1e-3)).astype(np.int64), 1) + 1
    leg, number = numbered_parts(count)
    passed = pieces.order_key(points.leg, points.along), time

    def looked_at(leg: IntArray, along: FloatArray) -> CheckedPoints:
        near = pieces.points(leg, along)
        near = replace(near, charted=sailed.charted[pieces.containing(leg, near.along)])
        moments = np.interp(pieces.order_key(leg, near.along), *passed)
        at = np.where(np.isfinite(moments), moments, pieces.track.depart)
        return CheckedPoints(near, moments, *sample_sea_and_depth(world, near, at))

    at_sea = pieces.canals.number[leg] < 0
    share = (number / (count[leg] - 1))[at_sea]
    found = looked_at(leg[at_sea], share * pieces.length[leg[at_sea]])
    if world.charted:  # a coarse sea has few points, and the bed may have a bar between two
        found = found.joined(looked_at(*_in_other_pieces(sailed, found.points)))
    for _ in range(_ROUNDS):  # a slow ship meets much weather between two near points
        longer = _between_points(found, _longest_interval(sailed, found))
        if not len(longer[0]):
            break
        found = found.joined(looked_at(*longer))

    def near_limits(checked: CheckedPoints) -> list[FloatArray]:
        return limit_excesses(world, checked.sampled, checked.depth, min_ukc)

    def near_least_depth(checked: CheckedPoints) -> list[FloatArray]:
        return [_below_least_depth(checked)] if world.has_depth else []

    for excesses_of, clear in ((near_limits, 0.0), (near_least_depth, _CLEAR)):
        for _ in range(_ROUNDS):
            first = _doubtful_intervals(found, excesses_of(found), clear)
            if not len(first):
                break
            begin, end = found.points.along[first], found.points.along[first + 1]
            shares = np.arange(1, _PARTS) / _PARTS
            along = (begin[:, None] + (end - begin)[:, None] * shares).ravel()
            found = found.joined(looked_at(np.repeat(found.points.leg[first], _PARTS - 1), along))
    return found


def _in_other_pieces(sailed: SailedTrack, points: TrackPoints) -> tuple[IntArray, FloatArray]:
    """Return leg and distance along it [m] of a place in each piece at sea without a point."""
    pieces, gauss = sailed.pieces, sailed.gauss
    empty = np.ones(len(sailed.charted), bool)
    empty[pieces.containing(points.leg, points.along)] = False
    empty &= pieces.canals.number[gauss.leg[::2]] < 0
    return gauss.leg[::2][empty], gauss.along[::2][empty]


def _longest_interval(sailed: SailedTrack, checked: CheckedPoints) -> float:
    """Return how long two points of a leg may be apart [s]."""
    world = sailed.world
    steps = [row.step_s for row in world.sea.coverage() if row.variable in world.names]
    half = 0.5 * min((step for step in steps if step), default=2.0 * _LONGEST_INTERVAL)
    passed = checked.moments[np.isfinite(checked.moments)]
    whole = float(np.ptp(passed)) if len(passed) else 0.0
    return max(min(half, _LONGEST_INTERVAL), whole / MAX_CHECK_POINTS)


def _between_points(checked: CheckedPoints, longest: float) -> tuple[IntArray, FloatArray]:
    """Return leg and distance along it [m] of places between points that are longer apart [s]."""
    leg, along = checked.points.leg, checked.points.along
    apart = np.diff(checked.moments)
    apart = np.where((np.diff(leg) == 0) & np.isfinite(apart), apart, 0.0)  # both reached
    parts = np.ceil(apart / longest - 1e-9).astype(np.int64)
    first = np.flatnonzero(parts > 1)
    which, number = numbered_parts(parts[first] - 1)
    at = first[which]
    share = (number + 1) / parts[at]
    return leg[at], along[at] + share * (along[at + 1] - along[at])


def _below_least_depth(checked: CheckedPoints) -> FloatArray:
    """Return the least depth found on the leg of each point, less the depth there [m]."""
    leg, passed = checked.points.leg, np.isfinite(checked.moments)
    depth = np.where(np.isfinite(checked.depth) & passed, checked.depth, np.nan)
    least = np.full(int(leg.max(initial=-1)) + 1, np.nan)
    np.fmin.at(least, leg, depth)
    return np.asarray(least[leg] - depth)


def _doubtful_intervals(
    checked: CheckedPoints, excesses: Sequence[FloatArray], clear: float
) -> IntArray:
    """Return the intervals, by their first points, in which a limit may be exceeded.

    Both ends keep it, and the sea would exceed it by more than ``clear`` if it changed once more as
    in this interval or in the one before or after.
    """
    points = checked.points
    between = (np.diff(points.leg) == 0) & np.isfinite(np.diff(checked.moments))
    smooth = between & (points.charted[1:] == points.charted[:-1])  # each is the least of a piece
    doubt = np.full(len(between), -np.inf)
    for excess in excesses:
        with np.errstate(invalid="ignore"):  # without a bound of the depth
            change = np.where(smooth, np.abs(np.diff(excess)), 0.0)
        beside = np.fmax(np.append(0.0, change[:-1]), np.append(change[1:], 0.0))
        change, high = np.fmax(change, beside), np.maximum(excess[:-1], excess[1:])
        known = between & (high <= 0.0) & (change > 0.0)
        doubt[known] = np.maximum(doubt[known], high[known] + change[known])
    order = np.argsort(-doubt, kind="stable")[:_MOST_DIVIDED]
    return np.sort(order[doubt[order] > clear])
