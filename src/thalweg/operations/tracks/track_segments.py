"""Segments of sailed legs: measured velocity, and the current of the sea."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import inverse, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.operations.tracks.activities import SAILING_EMPTY, SAILING_FULL, Activity
from thalweg.operations.tracks.track_cleaning import TrackLog
from thalweg.ship.condition_variables import EASTWARD_CURRENT, NORTHWARD_CURRENT

if TYPE_CHECKING:
    from thalweg.sea import Sea

SEGMENT_DURATION = 300.0  #: [s]; averages out noise and is short compared with the tide
STEADY_SPEED_SHARE = 0.8  #: least share of a leg's median speed that counts as free sailing
SAILING_KINDS = (SAILING_FULL, SAILING_EMPTY)


@dataclass(frozen=True, eq=False)
class MeasuredSegments:
    """Segments of legs, p in total.

    Attributes
    ----------
    leg : Number of the trip of each segment, (p,).
    kind : Index into ``SAILING_KINDS`` (sailing full, sailing empty), (p,).
    time, duration : Middle [s since 1970-01-01T00:00Z] and length [s], (p,).
    lat, lon : Middle [deg], (p,).
    ground : Velocity over ground, east + i north [m/s], (p,).
    current : Current, east + i north [m/s], (p,); NaN where the sea has none.
    """

    leg: NDArray[np.int64]
    kind: NDArray[np.int64]
    time: FloatArray
    duration: FloatArray
    lat: FloatArray
    lon: FloatArray
    ground: NDArray[np.complex128]
    current: NDArray[np.complex128]

    def __len__(self) -> int:
        return len(self.leg)

    @property
    def speed(self) -> FloatArray:
        """Speed over ground [m/s]."""
        return np.abs(self.ground)

    @property
    def course(self) -> FloatArray:
        """Course over ground, clockwise from north [rad]."""
        return np.asarray(np.angle(1j * np.conj(self.ground)) % (2.0 * np.pi))

    def part(self, keep: NDArray[np.bool_]) -> MeasuredSegments:
        """Return some of the segments."""
        return MeasuredSegments(*(values[keep] for values in vars(self).values()))

    def sum_by_leg(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Return (legs, sums of values over each leg)."""
        legs, index = np.unique(self.leg, return_inverse=True)
        return legs, np.bincount(index, values, minlength=len(legs)).astype(np.float64)


def cut_segments(
    log: TrackLog,
    activities: Sequence[Activity],
    *,
    sea: Sea | None = None,
    length: float = SEGMENT_DURATION,
) -> MeasuredSegments:
    """Divide all sailing of a track into segments.

    The ends of every leg, where the ship accelerates or slows down, are left out: everything before
    the first and after the last position with at least 80 % of the leg's median speed (the "free
    sailing" of Schless 2023, section 4.2, by its speed alone).

    Parameters
    ----------
    sea : For the currents.
    length : Least length of a segment [s]; the last of a leg takes the rest.

    Returns
    -------
    MeasuredSegments : With the mean velocities. Legs with fewer than two positions have no
        segments, and segments that end where they began (without a course) are left out.
    """
    speeds = log.speeds()
    rows = [
        (activity.trip, SAILING_KINDS.index(activity.kind), *pair)
        for activity in activities
        if activity.kind in SAILING_KINDS
        for pair in _segment_ends(log, activity, speeds, length)
    ]
    table = np.array(rows, dtype=np.int64).reshape(-1, 4)
    leg, kind, first, last = table.T
    distance, course, _ = inverse(log.lat[first], log.lon[first], log.lat[last], log.lon[last])
    moved = distance > 0.0
    leg, kind, first, last = table[moved].T
    distance, course = distance[moved], course[moved]
    duration = log.time[last] - log.time[first]
    middle = 0.5 * (log.time[first] + log.time[last])
    lat, lon = _midpoints(log, first, last)
    ground = distance / duration * (np.sin(course) + 1j * np.cos(course))
    current = np.full(len(leg), complex(np.nan, np.nan))
    if sea is not None and len(leg):
        sampled = sea.sample([EASTWARD_CURRENT, NORTHWARD_CURRENT], middle, lat, lon)
        current = sampled[EASTWARD_CURRENT] + 1j * sampled[NORTHWARD_CURRENT]
    return MeasuredSegments(leg, kind, middle, duration, lat, lon, ground, current)


def _segment_ends(
    log: TrackLog, activity: Activity, speeds: FloatArray, length: float
) -> list[tuple[int, int]]:
    """Return (first, last) positions of the segments of a leg."""
    first, last = activity.first, activity.last
    if last > first:
        seen = speeds[first : last + 1]
        fast = np.flatnonzero(seen >= STEADY_SPEED_SHARE * np.median(seen))
        first, last = first + int(fast[0]), first + int(fast[-1])
    ends = [first]
    for i in range(first + 1, last + 1):
        if log.time[i] - log.time[ends[-1]] >= length:
            ends.append(i)
    if len(ends) > 1 and ends[-1] < last:
        ends[-1] = last
    elif len(ends) == 1 and last > first:
        ends.append(last)
    return list(itertools.pairwise(ends))


def _midpoints(
    log: TrackLog, first: NDArray[np.int64], last: NDArray[np.int64]
) -> tuple[FloatArray, FloatArray]:
    """Return the positions half-distance in time, interpolated between measured positions."""
    middle = 0.5 * (log.time[first] + log.time[last])
    right = np.clip(np.searchsorted(log.time, middle), 1, len(log) - 1)
    share = (middle - log.time[right - 1]) / (log.time[right] - log.time[right - 1])
    east = longitude_difference(log.lon[right], log.lon[right - 1])
    lat = log.lat[right - 1] + share * (log.lat[right] - log.lat[right - 1])
    return lat, np.asarray(log.lon[right - 1] + share * east)
