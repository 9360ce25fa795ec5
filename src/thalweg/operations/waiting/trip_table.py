"""`TripTable`: duration and energy of a trip for departures at equal steps of time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray


@dataclass(frozen=True, eq=False)
class TripTable:
    """Duration and energy of one trip for departures at equal steps of time.

    Attributes
    ----------
    name : str
    start, step : float
        First departure [s since 1970-01-01T00:00Z] and time between departures [s].
    duration : float64 array (n,)
        Time under way [s]; +inf where the trip cannot be made.
    energy : float64 array (n,)
        Brake energy of the engine under way, without hotel load [J]; +inf as above.
    current : float64 array (n,)
        Current at the place of departure along the first course [m/s], positive when it helps.
    periodic : bool
        Whether the table repeats: the departure after the last is the first again.
    """

    name: str
    start: float
    step: float
    duration: FloatArray
    energy: FloatArray
    current: FloatArray
    periodic: bool = False

    def __len__(self) -> int:
        return len(self.duration)

    @property
    def times(self) -> FloatArray:
        """The departures [s since 1970-01-01T00:00Z]."""
        return self.start + self.step * np.arange(len(self), dtype=np.float64)

    @property
    def steps(self) -> NDArray[np.int64]:
        """Steps of the table until the ship is ready again; -1 where the trip cannot be made."""
        known = np.isfinite(self.duration)
        steps = np.ceil(np.where(known, self.duration, 0.0) / self.step - 1e-9)
        return np.where(known, steps, -1).astype(np.int64)

    def refined(self, factor: int) -> TripTable:
        """Return the table with departures ``factor`` times as close together.

        Values between departures are interpolated with a cubic spline; linearly if the table has
        impossible departures. Between a possible and an impossible departure none is possible.

        Parameters
        ----------
        factor : int
            1 or more.

        Returns
        -------
        TripTable
            With a ``step`` shorter by the factor.

        Raises
        ------
        InputError
            If the factor is less than 1.
        """
        if factor < 1:
            raise InputError(f"The factor is {factor}.", "It is 1 or more.", "Correct it.")
        count = len(self) * factor if self.periodic else (len(self) - 1) * factor + 1
        at = np.arange(count, dtype=np.float64) / factor
        return replace(
            self,
            step=self.step / factor,
            duration=_interpolate(self.duration, at, self.periodic),
            energy=_interpolate(self.energy, at, self.periodic),
            current=_interpolate(self.current, at, self.periodic),
        )


def _interpolate(values: FloatArray, at: FloatArray, periodic: bool) -> FloatArray:
    """Interpolate between values at 0, 1, 2 ..."""
    from scipy.interpolate import CubicSpline

    known = np.append(values, values[0]) if periodic else values
    nodes = np.arange(len(known), dtype=np.float64)
    if np.isfinite(known).all() and len(known) > 3:
        return np.asarray(
            CubicSpline(nodes, known, bc_type="periodic" if periodic else "not-a-knot")(at)
        )
    low = np.minimum(at.astype(np.int64), len(known) - 1)
    high, share = np.minimum(low + 1, len(known) - 1), at - low
    with np.errstate(invalid="ignore"):
        straight = known[low] + np.where(share > 0.0, share * (known[high] - known[low]), 0.0)
    return np.where(np.isfinite(straight), straight, math.inf)
