"""Activities of a track: loading, sailing full, unloading, sailing empty, waiting.

After van Halem (2019, section 4.1.2): inside an area the activity is that of the area; between
areas the ship sails full after loading and empty after unloading. Further activities are waits
between areas, trips that return to the same area, and gaps.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.operations.tracks.track_cleaning import TrackLog
from thalweg.operations.tracks.work_areas import AREA_KINDS, LOADING, UNLOADING, WAITING, WorkAreas

SAILING_FULL, SAILING_EMPTY = "sailing full", "sailing empty"
AWAY, UNSEEN = "away", "not seen"
ACTIVITIES: Final = (LOADING, SAILING_FULL, UNLOADING, SAILING_EMPTY, WAITING, AWAY, UNSEEN)
_SAILING: Final = {(LOADING, UNLOADING): SAILING_FULL, (UNLOADING, LOADING): SAILING_EMPTY}


@dataclass(frozen=True)
class SegmentationRules:
    """Rules for dividing a track into activities.

    Attributes
    ----------
    slow : float
        Outside the areas, a lower speed over ground than this [m/s] is waiting or manoeuvring if it
        lasts at least ``min_wait``.
    min_wait : float
        Shortest wait outside the areas [s].
    short_trip : float
        An absence from an area that ends in an area of the same kind within this time [s] counts as
        work in the area.
    """

    slow: float = 2.0 * KNOT
    min_wait: float = 600.0
    short_trip: float = 1800.0

    def __post_init__(self) -> None:
        values = (self.slow, self.min_wait, self.short_trip)
        if not all(np.isfinite(v) and v >= 0.0 for v in values):
            raise InputError(
                f"The rules are {self}.", "The numbers are not negative.", "Correct them."
            )


@dataclass(frozen=True)
class Activity:
    """A part of a track with one activity.

    Attributes
    ----------
    kind : str
        One of ``ACTIVITIES``.
    start, end : float
        [s since 1970-01-01T00:00Z]; half-way between the neighbouring positions.
    first, last : int
        Index of its first and last position in the track.
    trip : int
        Number of the trip between areas it belongs to (its sailing and its waits); -1 for none.
    whole : bool
        Whether it is complete: not cut off by the ends of the track or by a gap, and without a gap
        in which the ship may have left and returned.
    """

    kind: str
    start: float
    end: float
    first: int
    last: int
    trip: int
    whole: bool

    @property
    def duration(self) -> float:
        """Duration [s]."""
        return self.end - self.start


def find_activities(
    log: TrackLog, areas: WorkAreas, *, rules: SegmentationRules | None = None
) -> tuple[Activity, ...]:
    """Divide a track into activities.

    Parameters
    ----------
    log : TrackLog
    areas : WorkAreas
    rules : SegmentationRules, optional

    Returns
    -------
    tuple of Activity
        In order of time, covering the whole track.

    Raises
    ------
    InputError
        If the ship is never in an area for loading or unloading.
    """
    rules = rules or SegmentationRules()
    where = areas.at(log.lat, log.lon)
    if (
        not (where == AREA_KINDS.index(LOADING)).any()
        and not (where == AREA_KINDS.index(UNLOADING)).any()
    ):
        raise InputError(
            "The ship is never in an area for loading or unloading.",
            f"The track extends from {log.lat.min():.3f} to {log.lat.max():.3f} N and from "
            f"{log.lon.min():.3f} to {log.lon.max():.3f} E.",
            "Check the areas (longitude first in GeoJSON) and the ship.",
        )
    kinds, trips, whole = _classify_positions(log, where, rules)
    away = log.broken & (np.diff(log.time) > rules.short_trip)
    return tuple(_activities(log, kinds, trips, whole, away))


def _constant_runs(keys: list[tuple[object, ...]]) -> list[tuple[int, int]]:
    """Return (first, last) of runs of equal keys."""
    found, at = [], 0
    for _, group in itertools.groupby(keys):
        count = len(list(group))
        found.append((at, at + count - 1))
        at += count
    return found


def _classify_positions(
    log: TrackLog, where: NDArray[np.int8], rules: SegmentationRules
) -> tuple[list[str], list[int], list[bool]]:
    """Return the activity, the trip and the completeness of every position."""
    count = len(log)
    kinds = [AREA_KINDS[w] if w in (0, 1) else "" for w in where.tolist()]
    trips, whole = [-1] * count, [True] * count
    slow = _waiting_positions(log, where, rules)
    number = 0
    for first, last in _constant_runs([(k,) for k in kinds]):
        if kinds[first]:
            continue
        before = kinds[first - 1] if first > 0 else ""
        after = kinds[last + 1] if last + 1 < count else ""
        span = float(log.time[min(last + 1, count - 1)] - log.time[max(first - 1, 0)])
        cut_off = bool(log.broken[max(first - 1, 0) : last + 1].any())
        if before and before == after and span <= rules.short_trip and not cut_off:
            kinds[first : last + 1] = [before] * (last + 1 - first)
            continue
        kind = _activity_between(before, after)
        ends = not before or not after
        for i in range(first, last + 1):
            waits = slow[i] and kind != AWAY
            kinds[i], trips[i] = (WAITING if waits else kind), number
            whole[i] = not (cut_off or ends)
        number += 1
    return kinds, trips, whole


def _activity_between(before: str, after: str) -> str:
    """Return the activity between areas of two kinds; at the ends of a track one is unknown."""
    if before and after:
        return _SAILING.get((before, after), AWAY)
    if before or after:
        loaded = before == LOADING or after == UNLOADING
        return SAILING_FULL if loaded else SAILING_EMPTY
    return AWAY


def _waiting_positions(
    log: TrackLog, where: NDArray[np.int8], rules: SegmentationRules
) -> NDArray[np.bool_]:
    """Return whether the ship waits outside the areas for loading and unloading."""
    waiting = where == AREA_KINDS.index(WAITING)
    slow = (log.speeds() < rules.slow) & (where < 0)
    edges = _interval_boundaries(log)
    for first, last in _constant_runs([(bool(s),) for s in slow]):
        if slow[first] and edges[last + 1] - edges[first] < rules.min_wait:
            slow[first : last + 1] = False
    return np.asarray(slow | waiting)


def _interval_boundaries(log: TrackLog) -> FloatArray:
    """Return the times half-way between positions, with both ends."""
    middles = 0.5 * (log.time[1:] + log.time[:-1])
    return np.concatenate([log.time[:1], middles, log.time[-1:]])


def _activities(
    log: TrackLog,
    kinds: list[str],
    trips: list[int],
    whole: list[bool],
    away: NDArray[np.bool_],
) -> list[Activity]:
    """Return the activities; intervals without observation are activities of their own.

    An activity with an interval of ``away``, a gap long enough for a trip, is not complete.
    """
    segment = cumulative_sums(_unobserved_intervals(log, kinds)).tolist()
    edges = _interval_boundaries(log)
    activities: list[Activity] = []
    for first, last in _constant_runs(list(zip(kinds, trips, segment))):
        start, end = float(edges[first]), float(edges[last + 1])
        if first > 0 and segment[first] != segment[first - 1]:
            start = float(log.time[first])
            ended = activities[-1].end
            activities.append(Activity(UNSEEN, ended, start, first - 1, first, -1, False))
        if last + 1 < len(kinds) and segment[last + 1] != segment[last]:
            end = float(log.time[last])
        inside = first > 0 and last + 1 < len(kinds)
        observed = (
            inside and segment[first] == segment[first - 1] and segment[last] == segment[last + 1]
        )
        complete = observed and all(whole[first : last + 1]) and not away[first:last].any()
        activities.append(Activity(kinds[first], start, end, first, last, trips[first], complete))
    return activities


def _unobserved_intervals(log: TrackLog, kinds: list[str]) -> NDArray[np.bool_]:
    """Return the intervals of a broken track in which the activity is unknown.

    A gap with the same work area at both ends belongs to that work.
    """
    work = np.array([k in (LOADING, UNLOADING) for k in kinds])
    same = np.array([a == b for a, b in itertools.pairwise(kinds)], dtype=bool)
    return np.asarray(log.broken & ~(same & work[:-1]))
