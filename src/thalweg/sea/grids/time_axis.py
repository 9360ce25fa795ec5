"""The time axis of a layer, with gaps across which values are not interpolated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray

GAP_FACTOR = 2.5  #: a step longer than this many times both its neighbours is a gap in the data


class TimeLocation(NamedTuple):
    """Positions of times on an axis: index before (-1 if unknown) and fraction to the next."""

    level: IntArray
    fraction: FloatArray


@dataclass(frozen=True, eq=False)
class TimeAxis:
    """Native times of a layer; values are linear between them, except across gaps.

    Attributes
    ----------
    times : Strictly increasing [s since epoch], (T,); empty for fields that hold at all times.
    """

    times: FloatArray

    @property
    def is_static(self) -> bool:
        """Whether the fields hold at all times."""
        return self.times.size == 0

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time [s since epoch]; None if the fields hold at all times."""
        return None if self.is_static else (float(self.times[0]), float(self.times[-1]))

    @property
    def step(self) -> float | None:
        """Median step [s]."""
        return float(np.median(np.diff(self.times))) if self.times.size > 1 else None

    @cached_property
    def gaps(self) -> BoolArray:
        """Whether each step (T - 1,) is a gap: longer than 2.5 times both its neighbours."""
        step = np.diff(self.times)
        if step.size < 2:
            return np.zeros(step.size, bool)
        neighbour = np.maximum(np.append(0.0, step[:-1]), np.append(step[1:], 0.0))
        return np.asarray(step > GAP_FACTOR * neighbour)

    def locate(self, time: FloatArray) -> TimeLocation:
        """Return index and fraction of each time."""
        if self.is_static:
            level = np.where(np.isnan(time), -1, 0)
            return TimeLocation(level, np.zeros(time.shape))
        last = self.times.size - 1
        level = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, max(last - 1, 0))
        if last == 0:
            return TimeLocation(np.where(time == self.times[0], 0, -1), np.zeros(time.shape))
        fraction = (time - self.times[level]) / (self.times[level + 1] - self.times[level])
        known = (fraction >= 0.0) & (fraction <= 1.0)
        known &= ~(self.gaps[level] & (fraction > 0.0) & (fraction < 1.0))
        whole = fraction == 1.0  # the time itself, so that the next one need not be known
        level = np.where(whole, level + 1, level)
        return TimeLocation(np.where(known, level, -1), np.where(known & ~whole, fraction, 0.0))

    def within(self, start: float, end: float) -> FloatArray:
        """Return times in [start, end], one beyond each side, and times just inside gaps."""
        if self.is_static:
            return np.array([start, end]) if end > start else np.array([start])
        if end < self.times[0] or start > self.times[-1]:
            return np.empty(0)
        first = max(0, int(np.searchsorted(self.times, start, side="right")) - 1)
        last = min(self.times.size, int(np.searchsorted(self.times, end, side="left")) + 1)
        gap = np.flatnonzero(self.gaps[first : last - 1]) + first
        edges = [self.times[gap] + 1.0, self.times[gap + 1] - 1.0]
        return np.sort(np.concatenate([self.times[first:last], *edges]))
