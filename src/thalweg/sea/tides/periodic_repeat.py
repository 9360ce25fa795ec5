"""Repeating a short model run, with the periods that bring the tide back and not its envelope.

Spring and neap come round after 354.367 h, where M2 and S2 have drifted apart by one turn; but
neither is then where it was: both have gone through some half cycles more, and high water has
become low water (169 degrees). After 360 h and after 707.974 h (57 M2) both are back to within six
degrees and one. Predicting from constituents (`Sea.from_tides`) needs no repetition at all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.triangle_mesh import Mesh
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.sea import Sea
from thalweg.sea.tides import schureman
from thalweg.sea.tides.astronomy import HOUR

FORTNIGHT_H: Final = 360.0  #: 30 S2; M2 is 5.7 degrees early
MONTH_H: Final = 707.974  #: 57 M2; S2 is 0.8 degrees early
MAX_DRIFT: Final = 10.0  #: [deg] phase by which M2 or S2 may be off after one period


def drift_deg(period_h: float, name: str) -> float:
    """Return by how much [deg, -180 to 180] a constituent is off after a period [h].

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
class RepeatedLayer:
    """A layer whose values between ``start`` and ``start + length`` come again and again.

    Attributes
    ----------
    layer : Layer
        What is repeated.
    start, length : float
        First time and period [s].
    """

    layer: Layer
    start: float
    length: float

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of what the layer holds."""
        return self.layer.variables

    @property
    def area(self) -> BoundingBox:
        """The area of the layer."""
        return self.layer.area

    @property
    def period(self) -> tuple[float, float] | None:
        """It holds always."""
        return None

    def _within(self, time: FloatArray) -> FloatArray:
        return self.start + (time - self.start) % self.length

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points."""
        return self.layer.sample(names, self._within(time), lat, lon)

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations."""
        moments, place = np.unique(self._within(times), return_inverse=True)
        found = self.layer.series(names, moments, lat, lon)
        return {name: value[:, place.ravel()] for name, value in found.items()}

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times of every round that touches the window, one beyond each side."""
        native = self.layer.times(self.start, self.start + self.length)
        native = native[(native >= self.start) & (native < self.start + self.length)]
        first = int(np.floor((start - self.start) / self.length)) - 1
        last = int(np.floor((end - self.start) / self.length)) + 1
        rounds = np.arange(first, last + 1) * self.length
        seam = np.append(native, self.start + self.length - 1.0)
        every = np.unique((seam[None, :] + rounds[:, None]).ravel())
        low = max(0, int(np.searchsorted(every, start, side="right")) - 1)
        high = int(np.searchsorted(every, end, side="left")) + 1
        return np.asarray(every[low:high], np.float64)

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions lie where the layer may know values."""
        return self.layer.inside(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return the layer's coverage, without an end."""
        return [
            Coverage(r.variable, r.south, r.north, r.west, r.east, None, None, r.step_s,
                     r.spacing_deg, f"{r.source}, repeated")
            for r in self.layer.coverage()
        ]  # fmt: skip

    def mesh(self) -> Mesh | None:
        """Return the layer's mesh."""
        return self.layer.mesh()

    def provenance(self) -> Mapping[str, Any]:
        """Return the layer's facts and the period."""
        return {
            "kind": "repeated",
            "start": self.start,
            "length": self.length,
            "of": dict(self.layer.provenance()),
        }


def repeat_in_time(sea: Sea, start: TimeLike, *, period_h: float = MONTH_H) -> Sea:
    """Return a sea whose fields over one period come again for ever.

    Parameters
    ----------
    sea : Sea
        Its layers that change in time must cover ``start`` to ``start + period_h``.
    start : time
        Where the repeated period begins.
    period_h : float
        360 h or 707.974 h; any other after which M2 and S2 are both within 10 degrees.

    Raises
    ------
    InputError
        If the period does not bring the tide back, or the data do not cover it.
    """
    sea.check_single()
    off = {n: drift_deg(period_h, n) for n in ("M2", "S2")}
    worst = max(abs(x) for x in off.values())
    if not (np.isfinite(period_h) and period_h > 24.0 and worst <= MAX_DRIFT):
        raise InputError(
            f"After {period_h:g} h the tide is not back: M2 is {off['M2']:.0f} and S2 "
            f"{off['S2']:.0f} degrees off.",
            f"{FORTNIGHT_H:g} h and {MONTH_H:g} h bring both back; 354.4 h only the spring-neap "
            "envelope.",
            "Choose one of them, or predict from constituents with Sea.from_tides.",
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
    told = f"fields of {period_h:g} h from {format_time(begin)} repeated for ever"
    return Sea(tuple(layers), (*sea.assumptions, told))
