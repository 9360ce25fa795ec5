"""Compass search: points try steps in eight directions, where derivatives do not help.

Direct search by patterns (Kolda, Lewis & Torczon 2003, "Optimization by direct search", SIAM Review
45, 385-482). It needs no derivatives, so coasts, closed cells and depth contours may bind.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray

_DIRECTIONS = 8


@dataclass(frozen=True)
class CompassSchedule:
    """The steps of a compass search.

    Attributes
    ----------
    shares : First step of each round as a share of `CompassProblem.point_spacing`; one number:
        steps grow and shrink with the success of each point instead.
    rounds : Rounds over all points at most.
    growth, shrinkage : Factors of the step of a point after a gain and without one.
    turn : By which the directions turn every round [rad].
    smallest : The search ends when all steps are shorter than this [m].
    least_gain : Gain that does not count yet, as a share of the value of the legs beside a point.
    groups : With 2 every second point moves at a time, with 1 all of them.
    """

    shares: tuple[float, ...]
    rounds: int
    growth: float = 1.0
    shrinkage: float = 1.0
    turn: float = 0.0
    smallest: float = 0.0
    least_gain: float = 0.0
    groups: int = 1


class CompassProblem(Protocol):
    """A batch of R tracks of at most M points whose legs can be valued alone."""

    @property
    def free(self) -> BoolArray:
        """Which points (R, M) may move."""

    def point_spacing(self) -> FloatArray:
        """Return the length (R, M) [m] that steps of points are shares of."""

    def displaced(
        self, row: IntArray, place: IntArray, east: FloatArray, north: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the positions (P, D) [deg] of points (P,) displaced east and north [m]."""

    def values_beside(
        self, row: IntArray, place: IntArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the value of the two legs beside points (P,) at trial positions (P, D), and now.

        With the effects of a delay until the goal; +inf where a leg cannot be sailed.
        """

    def with_points_moved(
        self, gain: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[Self, BoolArray]:
        """Return the tracks with points (R, M) at other positions [deg], and which of them moved.

        Points without a gain stay. The tracks are not worse than before.
        """


AnyCompassProblem = TypeVar("AnyCompassProblem", bound=CompassProblem)


def compass_search(tracks: AnyCompassProblem, schedule: CompassSchedule) -> AnyCompassProblem:
    """Return tracks with points moved where that lowers the value.

    Parameters
    ----------
    tracks : A batch of tracks, such as `ScoredTracks` or `SailedPolyline`.

    Returns
    -------
    CompassProblem : With costs that are not higher than before.

    Notes
    -----
    Each point is compared on its two adjacent legs alone, at eight positions around it; the best
    with a gain is taken.
    """
    step = np.empty((0, 0))
    for number in range(schedule.rounds):
        if number < len(schedule.shares):
            step = np.where(tracks.free, schedule.shares[number] * tracks.point_spacing(), 0.0)
        angle = number * schedule.turn + 2.0 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        for group in range(schedule.groups):
            moving = (step > 0.0) & (step >= schedule.smallest)
            moving &= np.arange(step.shape[1]) % schedule.groups == (group + 1) % schedule.groups
            if moving.any():
                tracks, moved = _best_steps(tracks, moving, step, angle, schedule.least_gain)
                step[moving] *= np.where(moved[moving], schedule.growth, schedule.shrinkage)
        if step.max(initial=0.0) < schedule.smallest:
            break
    return tracks


def _best_steps(
    tracks: AnyCompassProblem, moving: BoolArray, step: FloatArray, angle: FloatArray, least: float
) -> tuple[AnyCompassProblem, BoolArray]:
    """Move points (R, M) to the best of their trial positions; return also which moved."""
    row, place = np.nonzero(moving)
    size = step[row, place][:, None]
    trials = tracks.displaced(row, place, size * np.sin(angle), size * np.cos(angle))
    value, now = tracks.values_beside(row, place, *trials)
    best = np.argmin(value, axis=1)
    every = np.arange(len(row))
    with np.errstate(invalid="ignore"):
        better = now - value[every, best]
        better[~(np.isfinite(better) & (better > least * np.abs(now)))] = 0.0
    gain, lat, lon = (np.zeros(step.shape) for _ in range(3))
    gain[row, place] = better
    lat[row, place], lon[row, place] = (trial[every, best] for trial in trials)
    return tracks.with_points_moved(gain, lat, lon)
