"""Output function applied to the sum of a table's parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.kernels.leg.table_lookup import (
    CURVE_INTERSECTION,
    CURVE_REFINEMENT,
    MAX_PLANES,
    OUTPUT_CURVE,
)
from thalweg.ship.tables.table_parts import TablePart

OUTPUT_CURVE_FIELDS: Final = (
    "start",
    "step",
    "points",
    "top",
    "guess",
)  #: arrays, a row for each setting


@dataclass(frozen=True, eq=False)
class OutputCurve:
    """Turns the sum over the parts of a table into its value.

    ``curve``: the value is a curve of the sum, one for each setting, such as fuel over resistance.

    ``crossing``: the parts have a column for each of several speeds, and their sum is the
    resistance [N] that weather and depth add at that speed; the curve is the resistance reserve of
    a setting at those speeds. The value is the highest speed at which the reserve suffices. No
    table of wind and waves together is needed, since their resistances at one speed add up.

    Attributes
    ----------
    kind : {"curve", "crossing"}
    start, step : For each setting the first point of its curve and the step, in units of the sum;
        for a crossing in speed [m/s], `CURVE_REFINEMENT` steps to a column.
    points : The curves, shape ``(settings, points)``.
    top : The greatest speed of each setting [m/s]; for a crossing.
    guess : Columns next to the calm-water speeds, where a search begins; for a crossing.
    """

    kind: Literal["curve", "crossing"]
    start: FloatArray
    step: FloatArray
    points: FloatArray
    top: FloatArray
    guess: NDArray[np.int64]

    @property
    def falls(self) -> bool:
        """Whether the value falls while the sum rises."""
        return self.kind == "crossing"

    @property
    def columns(self) -> int:
        """Length of the last axis of the parts."""
        return (
            (self.points.shape[1] - 1) // CURVE_REFINEMENT + 1
            if self.falls
            else self.points.shape[0]
        )

    def at(self, chosen: slice) -> OutputCurve:
        """Return that of some of the settings."""
        return replace(self, **{name: getattr(self, name)[chosen] for name in OUTPUT_CURVE_FIELDS})

    def check(self, parts: Sequence[TablePart]) -> None:
        """Refuse parts that kernels cannot follow with a crossing."""
        if self.falls and (len(parts) > MAX_PLANES or any(len(part.axes) > 2 for part in parts)):
            raise InputError(
                "A table with a crossing has too many parts or axes.",
                f"It has at most {MAX_PLANES} parts of at most two axes.",
                "Check how the table was made.",
            )

    def value(self, total: FloatArray, setting: NDArray[np.intp]) -> FloatArray:
        """Return the value of sums of shape ``(*shape, columns)`` at settings; NaN for NaN."""
        shape = np.broadcast_shapes(total.shape[:-1], setting.shape)
        chosen = np.broadcast_to(setting, shape)
        sums = np.broadcast_to(total, (*shape, total.shape[-1]))
        if self.falls:
            return self._crossing(sums, chosen)
        own = np.take_along_axis(sums, chosen[..., None], axis=-1)[..., 0]
        last = self.points.shape[1] - 1
        x = np.clip((own - self.start[chosen]) / self.step[chosen], 0.0, last)
        # only the index of an unknown place is made up: its value stays NaN through ``x`` below
        cell = np.minimum(np.nan_to_num(x).astype(np.intp), last - 1)
        low, high = self.points[chosen, cell], self.points[chosen, cell + 1]
        return np.asarray(low + (x - cell) * (high - low))

    def _crossing(self, sums: FloatArray, chosen: NDArray[np.intp]) -> FloatArray:
        last = self.columns - 1
        over = sums >= self.points[chosen][..., ::CURVE_REFINEMENT]
        high = np.where(over.any(axis=-1), np.argmax(over, axis=-1), last + 1)
        low = np.clip(high - 1, 0, last - 1)
        ends = [np.take_along_axis(sums, (low + k)[..., None], axis=-1) for k in (0, 1)]
        share = np.arange(CURVE_REFINEMENT + 1) / CURVE_REFINEMENT
        index = low[..., None] * CURVE_REFINEMENT + np.arange(CURVE_REFINEMENT + 1)
        lack = ends[0] + share * (ends[1] - ends[0]) - self.points[chosen[..., None], index]
        after = np.clip(np.argmax(lack >= 0.0, axis=-1), 1, CURVE_REFINEMENT)[..., None]
        second = np.take_along_axis(lack, after, axis=-1)[..., 0]
        first = np.take_along_axis(lack, after - 1, axis=-1)[..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            place = low * CURVE_REFINEMENT + after[..., 0] - 1 + first / (first - second)
        top = self.top[chosen]
        found = np.minimum(self.start[chosen] + place * self.step[chosen], top)
        found = np.where(high == 0, 0.0, np.where(high > last, top, found))
        return np.where(np.isnan(sums).any(axis=-1), np.nan, found)

    def kernel_arrays(self) -> dict[str, Any]:
        """Return the fields of `thalweg.kernels.leg.table_lookup.TableArrays` that belong to it."""
        return {
            "n_columns": self.columns,
            "finish": CURVE_INTERSECTION if self.falls else OUTPUT_CURVE,
            "curve_start": np.ascontiguousarray(self.start),
            "curve_inv_step": 1.0 / self.step,
            "curve_top": np.ascontiguousarray(self.top),
            "curve": np.ascontiguousarray(self.points),
            "curve_guess": np.ascontiguousarray(self.guess, np.int64),
        }
