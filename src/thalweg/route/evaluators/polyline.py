"""Polylines: tracks as plain arrays that refinement works on, times counted from an origin."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import positions_along, rough_lengths, unwrap_longitude, wrap_longitude
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.time_evaluator import (
    TimeEvaluator,
    TrackBatch,
)
from thalweg.route.track import Track

PolylineEvaluator: TypeAlias = TimeEvaluator | CostEvaluator


@dataclass(frozen=True)
class Polyline:
    """Waypoints with earliest departures.

    Attributes
    ----------
    lat, lon : [deg], (n,); longitudes unwrapped, without jumps.
    leave : float64 array (n,)
        The ship leaves a point no earlier [s after the origin]; -inf where it does not wait.
    setting : int64 array (n - 1,)
    depart : [s after the origin].
    """

    lat: FloatArray
    lon: FloatArray
    leave: FloatArray
    setting: IntArray
    depart: float

    def __len__(self) -> int:
        return len(self.lat)

    def batch(self, lat: FloatArray | None = None, lon: FloatArray | None = None) -> TrackBatch:
        """Return this line, or variants of it at other positions (L, n), ready to sail."""
        lat = self.lat[None] if lat is None else lat
        lon = self.lon[None] if lon is None else lon
        count = len(lat)
        return TrackBatch(
            lat,
            lon,
            np.broadcast_to(self.leave, lat.shape),
            np.broadcast_to(self.setting, (count, len(self) - 1)),
            np.full(count, self.depart),
        )

    def moved(self, lat: FloatArray, lon: FloatArray) -> Polyline:
        """Return the line with its points at other positions."""
        return replace(self, lat=lat, lon=lon)

    def kept(self, index: IntArray) -> Polyline:
        """Return the line through some of its points; joined legs get the first setting."""
        return Polyline(
            self.lat[index],
            self.lon[index],
            self.leave[index],
            self.setting[index[:-1]],
            self.depart,
        )

    def required_points(self, evaluator: PolylineEvaluator) -> NDArray[np.bool_]:
        """Return which points must stay: the ends and where the setting changes.

        Cost evaluators choose settings; for them only the ends and canals are fixed.
        """
        fixed = evaluator.fixed_points(self.lat, self.lon)
        if not evaluator.chooses_settings:
            fixed[1:-1] |= np.diff(self.setting) != 0
        return fixed

    def split(self, longest: float, which: NDArray[np.bool_] | None = None) -> Polyline:
        """Return the line with a point in the middle of every leg longer than ``longest`` [m].

        Of the legs in ``which`` only, if that is given.
        """
        lat, lon, leave, setting = [self.lat[0]], [self.lon[0]], [self.leave[0]], []
        longer = rough_lengths(self.lat, self.lon) > longest
        for k, long in enumerate(longer if which is None else longer & which):
            if long:
                middle = positions_along(
                    self.lat[k], self.lon[k], self.lat[k + 1], self.lon[k + 1], 0.5
                )
                lat.append(float(middle[0]))
                lon.append(float(middle[1]))
                leave.append(-math.inf)
                setting.append(self.setting[k])
            lat.append(self.lat[k + 1])
            lon.append(self.lon[k + 1])
            leave.append(self.leave[k + 1])
            setting.append(self.setting[k])
        return Polyline(
            np.array(lat),
            unwrap_longitude(np.array(lon)),
            np.array(leave),
            np.array(setting),
            self.depart,
        )

    def cut(self, leg: int, share: float, setting: tuple[int, int]) -> Polyline:
        """Return the line with a point on one leg, and other settings of its two parts."""
        ends = (self.lat[leg], self.lon[leg], self.lat[leg + 1], self.lon[leg + 1])
        lat, lon = positions_along(*ends, share)
        after = leg + 1
        own = self.setting.copy()
        own[leg] = setting[0]
        return Polyline(
            np.insert(self.lat, after, float(lat)),
            unwrap_longitude(np.insert(self.lon, after, float(lon))),
            np.insert(self.leave, after, -math.inf),
            np.insert(own, after, setting[1]),
            self.depart,
        )


def polyline_of_track(track: Track, evaluator: PolylineEvaluator) -> Polyline:
    """Return a track as a polyline; its waits become earliest departures.

    Parameters
    ----------
    evaluator : Its origin is that of the times.
    """
    line = Polyline(
        np.array(track.lat),
        unwrap_longitude(track.lon),
        np.full(len(track), -math.inf),
        np.array(track.setting),
        track.depart - evaluator.origin,
    )
    for index in np.flatnonzero(track.wait):
        arrive, _ = evaluator.sail(line.batch(), check=False)
        leave = line.leave.copy()
        leave[index] = arrive[0, index] + track.wait[index]
        line = replace(line, leave=leave)
    return line


def track_of_polyline(line: Polyline, evaluator: PolylineEvaluator) -> Track:
    """Return a polyline as a track; its earliest departures become waits."""
    arrive, leave, _ = evaluator.sail_and_wait(line.batch())
    known = np.isfinite(leave[0]) & np.isfinite(arrive[0])
    known[-1] = False
    wait = np.zeros(len(line))  # none from the first leg that cannot be sailed
    wait[known] = np.maximum(0.0, leave[0, known] - arrive[0, known])
    return Track(
        line.lat, wrap_longitude(line.lon), line.depart + evaluator.origin, wait, line.setting
    )
