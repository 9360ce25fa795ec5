"""When a ship may work at a site: loading and unloading pause in waves or wind over her limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray
from thalweg.core.units import MINUTE
from thalweg.sea import Sea
from thalweg.ship import Ship

_STEP: Final = 5.0 * MINUTE  # of the samples of the weather at a site


@dataclass(frozen=True, eq=False)
class WorkWindows:
    """The periods in which work at a site is allowed.

    Attributes
    ----------
    times : [s since 1970-01-01T00:00Z], (n,); empty where no limit is checked.
    worked : Time that could be worked from the first of `times` on [s], (n,).
    """

    times: FloatArray
    worked: FloatArray

    @classmethod
    def at_site(
        cls, place: Position, period: tuple[float, float], *, ship: Ship, sea: Sea
    ) -> WorkWindows:
        """Return the periods in which waves and wind at a site keep the limits of a ship.

        Work pauses in waves or wind over the limit or unknown, sampled every five minutes. Waves
        and wind are those of the sea; limits of the ship file are those at sea.

        Parameters
        ----------
        place : (lat, lon)
            The site [deg].
        period : (float, float)
            Start and end [s since 1970-01-01T00:00Z].
        """
        checked = ship.limits.limited_weather
        if not checked:
            return cls(np.empty(0), np.empty(0))
        times = np.arange(period[0], period[1] + _STEP, _STEP)
        where = np.full(times.shape, place[0]), np.full(times.shape, place[1])
        allowed = ship.limits.keeps_weather_limits(sea.sample(checked, times, *where))
        step = np.where(allowed[:-1] & allowed[1:], np.diff(times), 0.0)
        return cls(times, cumulative_sums(step))

    def end(self, start: float, duration: float) -> float:
        """Return when work of a duration [s] that starts at a time ends [s since 1970].

        Parameters
        ----------
        start : [s since 1970-01-01T00:00Z].
        duration : Time of work without pauses [s].

        Returns
        -------
        float : Infinite where the work is not done by the end of the period.
        """
        if not len(self.times) or duration <= 0.0:
            return start + duration
        if start >= self.times[-1]:
            return math.inf
        target = float(np.interp(start, self.times, self.worked)) + duration
        if target > self.worked[-1] + 1e-6:
            return math.inf
        at = int(np.searchsorted(self.worked, target - 1e-6))  # the first time it is reached
        before = self.worked[at - 1]
        return max(start + duration, float(self.times[at - 1] + target - before))
