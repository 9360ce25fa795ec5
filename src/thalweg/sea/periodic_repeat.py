"""Repeat a short model run after a period at which the tide is nearly in phase again.

The spring-neap cycle has a period of 354.367 h, in which M2 and S2 differ by one cycle. After it
neither constituent is in phase: both are off by 169 degrees, and high water has become low water.
After 360 h (30 S2) M2 is in phase within six degrees, and after 707.974 h (57 M2) S2 is within one
degree. Prediction from constituents (`Sea.from_tides`) needs no repetition.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.sea.coverage import Coverage
from thalweg.sea.layer import Layer, RetimedLayer
from thalweg.sea.sea import Sea
from thalweg.sea.tides import schureman

FORTNIGHT_H: Final = 360.0  #: 30 S2; M2 is 5.7 degrees early
MONTH_H: Final = 707.974  #: 57 M2; S2 is 0.8 degrees early
MAX_DRIFT: Final = 10.0  #: [deg] largest phase difference of M2 and S2 after one period


def drift_deg(period_h: float, name: str) -> float:
    """Return the phase difference of a constituent after a period.

    Parameters
    ----------
    period_h : Period [h].

    Returns
    -------
    float : Phase difference [deg], -180 to 180.

    Examples
    --------
    >>> round(drift_deg(354.367, "M2")), round(drift_deg(354.367, "S2"))
    (-169, -169)
    >>> round(drift_deg(707.974, "S2"), 1)
    -0.8
    """
    turns = period_h * schureman.frequency(name)
    return float(((turns + 0.5) % 1.0 - 0.5) * 360.0)


@dataclass(frozen=True, eq=False)
class RepeatedLayer(RetimedLayer):
    """A layer whose values between ``start`` and ``start + length`` are repeated at all times.

    Attributes
    ----------
    start, length : First time [s since epoch] and period [s].
    """

    start: float
    length: float

    @property
    def period(self) -> tuple[float, float] | None:
        """None: the values are known at all times."""
        return None

    def _read_at(self, times: FloatArray) -> FloatArray:
        return self.start + (times - self.start) % self.length

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times of every repetition in the window, one beyond each side."""
        native = self.layer.times(self.start, self.start + self.length)
        native = native[(native >= self.start) & (native < self.start + self.length)]
        first = int(np.floor((start - self.start) / self.length)) - 1
        last = int(np.floor((end - self.start) / self.length)) + 1
        shifts = np.arange(first, last + 1) * self.length
        seam = np.append(native, self.start + self.length - 1.0)
        every = np.unique((seam[None, :] + shifts[:, None]).ravel())
        low = max(0, int(np.searchsorted(every, start, side="right")) - 1)
        high = int(np.searchsorted(every, end, side="left")) + 1
        return np.asarray(every[low:high], np.float64)

    def coverage(self) -> list[Coverage]:
        """Return the layer's coverage, without an end."""
        return [
            Coverage(r.variable, r.south, r.north, r.west, r.east, None, None, r.step_s,
                     r.spacing_deg, f"{r.source}, repeated")
            for r in self.layer.coverage()
        ]  # fmt: skip

    def provenance(self) -> Mapping[str, Any]:
        """Return the layer's facts and the period."""
        return {
            "kind": "repeated",
            "start": self.start,
            "length": self.length,
            "of": dict(self.layer.provenance()),
        }


def repeat_in_time(sea: Sea, start: TimeLike, *, period_h: float = MONTH_H) -> Sea:
    """Return a sea whose fields over one period are repeated at all times.

    Parameters
    ----------
    sea : Sea
        Its layers that change in time must cover ``start`` to ``start + period_h``.
    start : time
        Start of the repeated period.
    period_h : float
        360 h or 707.974 h; any other after which M2 and S2 are both within 10 degrees.

    Returns
    -------
    Sea
        Fields without a time are kept as they are.

    Raises
    ------
    InputError
        If M2 or S2 is out of phase after the period, or the data do not cover it.
    """
    sea.check_single()
    off = {n: drift_deg(period_h, n) for n in ("M2", "S2")}
    worst = max(abs(x) for x in off.values())
    if not (np.isfinite(period_h) and period_h > 24.0 and worst <= MAX_DRIFT):
        raise InputError(
            f"After {period_h:g} h the tide is not in phase: M2 is off by {off['M2']:.0f} and S2 "
            f"by {off['S2']:.0f} degrees.",
            f"After {FORTNIGHT_H:g} h and {MONTH_H:g} h both are in phase; after 354.4 h only the "
            "spring-neap envelope is.",
            "Choose one of these periods, or predict from constituents with Sea.from_tides.",
            value=period_h,
        )
    begin, length = parse_time(start), period_h * HOUR
    layers: list[Layer] = []
    for layer in sea.layers:
        span = layer.period
        if span is None:
            layers.append(layer)
            continue
        if span[0] > begin or span[1] < begin + length:
            raise InputError(
                f"The data run from {format_time(span[0])} to {format_time(span[1])}.",
                f"Repeating needs {period_h:g} h from {format_time(begin)}.",
                "Choose an earlier start, a shorter period, or Sea.from_tides.",
            )
        layers.append(RepeatedLayer(layer, begin, length))
    assumption = f"fields of {period_h:g} h from {format_time(begin)} repeated at all times"
    return Sea(tuple(layers), (*sea.assumptions, assumption))
