"""Values of the samples of a route at places between them, many at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class SamplePlaces:
    """Places on legs of a route, by the samples of the leg on both sides.

    Attributes
    ----------
    first, last : First and last sample of the leg, (n,).
    lower, upper : Samples before and after the place, (n,).
    nearest : The nearer of the two, (n,).
    share : Of the way from the lower to the upper sample, 0 to 1, (n,).
    """

    first: IntArray
    last: IntArray
    lower: IntArray
    upper: IntArray
    nearest: IntArray
    share: FloatArray

    @classmethod
    def on_legs(
        cls, samples: Mapping[str, FloatArray], leg: IntArray, at: FloatArray
    ) -> SamplePlaces:
        """Return places on legs, at distances from the start of the route [m].

        Parameters
        ----------
        samples : Of the route, in order, two or more on every leg.
        leg, at : Leg and distance of each place, (n,).
        """
        distance = np.maximum.accumulate(samples["distance"])
        first = np.searchsorted(samples["leg"], leg, side="left")
        last = np.searchsorted(samples["leg"], leg, side="right") - 1
        lower = np.searchsorted(distance, at, side="right") - 1
        lower = np.clip(lower, first, last)
        upper = np.minimum(lower + 1, last)
        step = distance[upper] - distance[lower]
        beyond = at - distance[lower]
        share = np.divide(beyond, step, out=np.zeros(len(at)), where=step > 0.0)
        equal = np.searchsorted(distance, distance[lower], side="left")  # the first of equals
        near = np.where(share <= 0.5, np.maximum(equal, first), upper)
        return cls(first, last, lower, upper, near, np.clip(share, 0.0, 1.0))

    def interpolated(self, values: FloatArray) -> FloatArray:
        """Return values of samples at the places, linear between them."""
        low = values[self.lower]
        return np.asarray(low + self.share * (values[self.upper] - low))

    def values(
        self, samples: Mapping[str, FloatArray], nearest: Sequence[str]
    ) -> dict[str, FloatArray]:
        """Return the samples at the places: linear between them, or those nearest.

        Parameters
        ----------
        samples : Of the route.
        nearest : Names of those that are not interpolated. Others are not where one is unknown in
            the leg.
        """
        found = {}
        for name, values in samples.items():
            near = values[self.nearest]
            if name not in nearest:
                unknown = cumulative_sums(~np.isfinite(values))
                whole = unknown[self.last + 1] == unknown[self.first]
                near = np.where(whole, self.interpolated(values), near)
            found[name] = near
        return found


def time_integral(samples: Mapping[str, FloatArray], rate: FloatArray) -> FloatArray:
    """Return the integral of a rate over time, from the start of the leg to each sample.

    Parameters
    ----------
    rate : At the samples; the time itself is taken on legs where one is unknown or all are zero.
    """
    leg = samples["leg"].astype(np.int64)
    first = np.flatnonzero(np.diff(leg, prepend=-1))
    number = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(leg))))
    usable = np.logical_and.reduceat(np.isfinite(rate), first)
    usable &= np.logical_or.reduceat(rate != 0.0, first)
    rate = np.where(usable[number], rate, 1.0)
    step = 0.5 * (rate[1:] + rate[:-1]) * np.diff(samples["time"])
    total = cumulative_sums(np.where(leg[1:] == leg[:-1], step, 0.0))
    return np.asarray(total - total[first][number])
