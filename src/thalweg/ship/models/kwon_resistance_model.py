"""Ships with a resistance in calm water that lose speed in weather by Kwon (2008)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.delegation import delegated
from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.conditions import Conditions
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.models.engine_plant import EnginePlant
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss, tabulate_predicted_speed
from thalweg.ship.models.resistance_model import ResistanceModel
from thalweg.ship.models.resistance_terms import condition_axes
from thalweg.ship.tables.table_parts import TableError, TablePart

_LARGEST_FROUDE_NUMBER: Final = 0.4  #: Froude number of the fastest calm-water speed considered
_WIND_CONDITIONS: Final = ("wind_speed", "wind_angle")


@dataclass(frozen=True, eq=False)
class KwonResistanceModel:
    """Speed and power from the resistance in calm water; weather reduces the speed by a share.

    The power of a setting is constant: that of its calm-water speed at the given depth.

    Attributes
    ----------
    base : Without waves and wind.
    """

    base: ResistanceModel
    loss: KwonSpeedLoss

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read."""
        return self.base.reads | set(_WIND_CONDITIONS)

    @property
    def identity(self) -> Mapping[str, object]:
        """Data that distinguish this model from others."""
        return {**self.base.identity, "kind": "kwon on resistance", "loss": repr(self.loss)}

    @property
    def estimated(self) -> tuple[Estimate, ...]:
        """Particulars that were estimated."""
        return self.base.estimated

    @property
    def depends_on_crab_angle(self) -> bool:
        """Whether the rudder drags where the heading is not the course."""
        return self.base.depends_on_crab_angle

    @property
    def holds_speed(self) -> bool:
        """Whether the settings are speeds."""
        return self.base.holds_speed

    @property
    def plant(self) -> EnginePlant:
        """The engines."""
        return self.base.plant

    balance = delegated(ResistanceModel.balance, "base")
    speeds = delegated(ResistanceModel.speeds, "base")
    #: Those of the setting in calm water; at full power fuel and power depend on the depth only.
    power = delegated(ResistanceModel.power, "base")
    fuel_rate = delegated(ResistanceModel.fuel_rate, "base")
    power_and_fuel = delegated(ResistanceModel.power_and_fuel, "base")
    tabulate_fuel = delegated(ResistanceModel.tabulate_fuel, "base")
    tabulate_power = delegated(ResistanceModel.tabulate_power, "base")
    #: Calm-water speed [m/s]: weather does not raise it.
    top_speed = delegated(ResistanceModel.top_speed, "base")
    greatest_speed = delegated(ResistanceModel.greatest_speed, "base")
    resistance = delegated(ResistanceModel.resistance, "base")

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]."""
        calm = self.base.speed_through_water(conditions, setting)
        return np.asarray(calm * (1.0 - self.loss.share(conditions, calm)))

    def power_at_speed(self, conditions: Conditions, speed: ArrayLike) -> FloatArray:
        """Brake power [W] of the calm-water speeds that weather reduces to given speeds [m/s].

        NaN where no calm speed up to a Froude number of 0.4 leaves as much.
        """
        return self.base.power_at_speed(conditions, self._calm_speed(conditions, speed))

    def _calm_speed(self, conditions: Conditions, attained: ArrayLike) -> FloatArray:
        """Calm-water speed [m/s] that weather reduces to an attained speed, by bisection."""
        shape = np.broadcast_shapes(conditions.shape, np.shape(attained))
        wanted = np.broadcast_to(np.asarray(attained, float), shape)
        low = np.array(wanted)
        high = np.maximum(low, _LARGEST_FROUDE_NUMBER * np.sqrt(GRAVITY * self.loss.length))
        reached = high * (1.0 - self.loss.share(conditions, high)) >= wanted
        for _ in range(50):
            middle = 0.5 * (low + high)
            over = middle * (1.0 - self.loss.share(conditions, middle)) >= wanted
            low, high = np.where(over, low, middle), np.where(over, middle, high)
        return np.where(reached, high, np.nan)

    def tabulate(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One part over wind speed and angle, and depth where it matters."""
        deep = "depth" in self.base.reads
        axes = self.loss.axes(129 if deep else 257)
        if deep:
            depth = condition_axes(self.base.balance(load_factor), self.base.limits)["depth"]
            axes.append(replace(depth, size=65))
        count = len(self.speeds(load_factor))
        return tabulate_predicted_speed(self, axes, count, load_factor, tolerance=tolerance)

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Where methods are used outside their ranges."""
        calm = self.base.speed_through_water(conditions, setting)
        return [*self.base.notes(conditions, setting), *self.loss.notes(conditions, calm)]

    def with_speeds(self, speeds: FloatArray, load_factor: float) -> KwonResistanceModel:
        """Return the model with other settings, given by calm-water speeds [m/s]."""
        return replace(self, base=self.base.with_speeds(speeds, load_factor))
