"""Quasi-static seas: values hold around each update in place of being linear in time.

Prestegardshus (2020), Table 3.6, plans in weather of this kind: a value at time t is that of the
nearest update. `Sea.quasi_static` repeats it, to study what coarse updates do to plans.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final, TypeVar

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.sea.ensemble_layer import EnsembleLayer
from thalweg.sea.layer import Layer, RetimedLayer

LEAST_STEP: Final = 60.0  #: between updates [s]
LARGEST_STEP: Final = 31 * 24 * HOUR
_RAMP: Final = 1.0  # [s] in which kernels, linear in time, go from one update to the next

SeaOfLayers = TypeVar("SeaOfLayers", bound=Any)


@dataclass(frozen=True, eq=False)
class QuasiStaticLayer(RetimedLayer):
    """The values of a layer at the nearest of regular updates.

    Attributes
    ----------
    step : Between updates [s].
    first : One of the updates [s since 1970-01-01T00:00Z].
    """

    step: float
    first: float

    @property
    def period(self) -> tuple[float, float] | None:
        """Around the updates that the layer covers; None if it holds at all times."""
        if self.layer.period is None:
            return None
        first, last = self.layer.period
        low = np.ceil((first - self.first) / self.step - 1e-9) - 0.5
        high = np.floor((last - self.first) / self.step + 1e-9) + 0.5
        return self.first + low * self.step, self.first + high * self.step - _RAMP

    def _read_at(self, times: FloatArray) -> FloatArray:
        """Return the nearest updates; the earlier one has the moment in the middle."""
        number = np.ceil((times - self.first) / self.step - 0.5)
        return np.asarray(self.first + number * self.step)

    def times(self, start: float, end: float) -> FloatArray:
        """Return the moments at which one update follows another, each with the one after it."""
        low, high = self.period or (-np.inf, np.inf)
        numbers = np.arange(
            np.floor((start - self.first) / self.step - 1.5),
            np.ceil((end - self.first) / self.step + 1.5) + 1.0,
        )
        change = self.first + (numbers + 0.5) * self.step
        moments = np.sort(np.concatenate([change, change + _RAMP]))
        kept = moments[(moments >= low) & (moments <= high)]
        return kept if self.layer.times(start, end).size else np.empty(0)

    def provenance(self) -> Mapping[str, Any]:
        """Return the updates and the facts of the layer."""
        return {
            "kind": "quasi-static",
            "step_s": self.step,
            "first": self.first,
            "of": dict(self.layer.provenance()),
        }


def quasi_static_sea(
    sea: SeaOfLayers, step_h: float, *, start: TimeLike | None = None
) -> SeaOfLayers:
    """Return a sea whose values hold around regular updates in place of being linear in time.

    Parameters
    ----------
    step_h : float
        Between updates [h].
    start : time, optional
        Time of one update; by default updates are multiples of the step after midnight (UTC) of
        1 January 1970.

    Returns
    -------
    Sea
        The value at any time is that of the nearest update. Unknown beyond half a step from the
        updates in the data. ``assumptions`` states it.

    Raises
    ------
    InputError
        If the step is shorter than a minute or longer than 31 days.

    References
    ----------
    Prestegardshus (2020), section 3.3, Table 3.6: steps of 2, 4, 8 and 12 h.
    """
    step = float(step_h) * HOUR
    if not LEAST_STEP <= step <= LARGEST_STEP:
        raise InputError(
            f"Updates of the weather every {step_h:g} h were requested.",
            f"Updates are {LEAST_STEP / HOUR:.3g} h to {LARGEST_STEP / HOUR:g} h apart.",
            "Correct the step, for example 8.",
            field="sampling",
        )
    first = 0.0 if start is None else parse_time(start)

    def held(layer: Layer) -> Layer:
        if isinstance(layer, EnsembleLayer):
            return EnsembleLayer(tuple(map(held, layer.member_layers)))
        varies = layer.period is not None or layer.times(first, first + step).size > 0
        return QuasiStaticLayer(layer, step, first) if varies else layer

    layers = tuple(map(held, sea.layers))
    text = f"weather holds at its value of the nearest update, every {step_h:g} h"
    if start is not None:
        text += f" from {format_time(first)}"
    return replace(sea, layers=layers, assumptions=(*sea.assumptions, text))  # type: ignore[no-any-return]


def sea_sampled(sea: SeaOfLayers, sampling: str) -> SeaOfLayers:
    """Return a sea with the sampling in time that an option or a file names.

    Parameters
    ----------
    sampling : str
        ``"linear"``, or ``"nearest:HOURS"`` for `Sea.quasi_static`.

    Returns
    -------
    Sea

    Raises
    ------
    InputError
        For another text.
    """
    kind, _, step = str(sampling).partition(":")
    if kind == "linear" and not step:
        return sea
    try:
        if kind == "nearest":
            return quasi_static_sea(sea, float(step))
    except ValueError:
        pass
    raise InputError(
        f"The sampling {sampling!r} is not understood.",
        "It is linear (in time), or nearest:HOURS (the nearest of updates so many hours apart).",
        "For example nearest:8.",
        field="sampling",
    )
