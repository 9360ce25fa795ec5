"""The speed rule of Prestegardshus (2020) as the speed loss of a ship with known speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.speed_loss import prestegardshus_speed_factor
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.tables.tabulate import AxisRange


@dataclass(frozen=True)
class PrestegardshusSpeedLoss:
    """The factors of waves and wind (see `prestegardshus_speed_factor` for their fault).

    Attributes
    ----------
    largest_wave_height, largest_wind_speed : Of the data, in which k is 1 [m, m/s].
    consistent : Whether a calm takes nothing.
    """

    largest_wave_height: float
    largest_wind_speed: float
    consistent: bool = False

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read."""
        return frozenset({"wave_height", "wave_angle", "wind_speed", "wind_angle"})

    def axes(self, size: int) -> list[AxisRange]:
        """Axes of tables: the product is linear in each condition, so that two values suffice."""
        ends = (
            (codes.AXIS_WAVE_HEIGHT, self.largest_wave_height),
            (codes.AXIS_WAVE_ANGLE, np.pi),
            (codes.AXIS_WIND_SPEED, self.largest_wind_speed),
            (codes.AXIS_WIND_ANGLE, np.pi),
        )
        return [AxisRange(axis, 0.0, end, 2, fixed=True) for axis, end in ends]

    def share(self, conditions: Conditions, speed: FloatArray) -> FloatArray:
        """Share of the calm-water speed that is lost; NaN above the largest weather."""
        factor = np.ones(())
        for angle, size, largest in (
            (conditions.wave_angle, conditions.wave_height, self.largest_wave_height),
            (conditions.wind_angle, conditions.wind_speed, self.largest_wind_speed),
        ):
            goes = np.pi - np.asarray(angle)  # angles of conditions are 0 from ahead
            factor = factor * prestegardshus_speed_factor(
                goes, np.asarray(size) / largest, consistent=self.consistent
            )
        return np.asarray(1.0 - factor)

    def notes(self, conditions: Conditions, speed: ArrayLike) -> list[RangeNote]:
        """Nothing: the rule has no range beyond its largest weather."""
        return []
