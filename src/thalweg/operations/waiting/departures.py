"""Departures at equal steps of time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray

MAX_DEPARTURES: Final = 200_000  #: of a table


@dataclass(frozen=True)
class Departures:
    """Departures at equal steps of time, over a window or over a period that repeats.

    Attributes
    ----------
    start : time
        First departure.
    end : time, optional
        Last departure.
    period : float, optional
        Instead of ``end``: the sea repeats itself after this time [s] (a single tide), and so does
        the table. The step is adjusted so that the period is a whole number of steps.
    step : float
        Time between departures [s], above 0.

    Raises
    ------
    InputError
        If neither or both of ``end`` and ``period`` are given, the step is not positive or longer
        than the window, or there are more than 200,000 departures.
    """

    start: TimeLike
    end: TimeLike | None = None
    period: float | None = None
    step: float = 60.0

    def __post_init__(self) -> None:
        if (self.end is None) == (self.period is None):
            raise InputError(
                "The departures of a trip need an end or a period.",
                "end is the last departure; period is for a sea that repeats itself.",
                "Give one of them.",
            )
        length = self._length
        if not (math.isfinite(length) and 0.0 < self.step <= length):
            raise InputError(
                f"Departures every {self.step:g} s over {length:g} s were requested.",
                "The step is positive and no longer than the window or period.",
                "Correct them.",
            )
        if len(self) > MAX_DEPARTURES:
            raise InputError(
                f"{len(self)} departures were requested.",
                f"A table holds at most {MAX_DEPARTURES}.",
                "Use a longer step or a shorter window.",
            )

    @property
    def first(self) -> float:
        """First departure [s since 1970-01-01T00:00Z]."""
        return parse_time(self.start)

    @property
    def _length(self) -> float:
        """The window or the period [s]."""
        return float(self.period or 0.0) if self.end is None else parse_time(self.end) - self.first

    def __len__(self) -> int:
        steps = self._length / self.step
        return round(steps) if self.period is not None else int(steps + 1e-9) + 1

    @property
    def fitted_step(self) -> float:
        """Time between departures [s], a whole fraction of the period if there is one."""
        return self._length / len(self) if self.period is not None else self.step

    @property
    def times(self) -> FloatArray:
        """All departures [s since 1970-01-01T00:00Z]."""
        return self.first + self.fitted_step * np.arange(len(self), dtype=np.float64)
