"""Ships with known speeds whose engine holds a speed through water by its power."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import setting_index
from thalweg.ship.models.known_speed_model import (
    KnownSpeedModel,
    known_speed_axes,
)
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss, tabulate_predicted_speed
from thalweg.ship.models.prestegardshus_speed_loss import PrestegardshusSpeedLoss
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import RateFunction, tabulate_settings

_STEPS = 201  #: settings between the lowest ordered speed and the highest of the ship


@dataclass(frozen=True, eq=False)
class HeldSpeedModel:
    """A ship that holds a speed through water as long as its highest power allows.

    In weather the engine runs at the setting whose reduced speed is the ordered one; power and fuel
    are those of that setting, between settings by the law of the ship.

    Attributes
    ----------
    base : With its own settings; the highest is the limit.
    ordered : Ordered speeds [m/s], ascending, at the load factor, (settings,).
    ladder : The base at close settings from the lowest ordered speed to its highest.
    """

    base: KnownSpeedModel
    ordered: FloatArray
    ladder: KnownSpeedModel

    @classmethod
    def of(cls, base: KnownSpeedModel, ordered: FloatArray, load_factor: float) -> HeldSpeedModel:
        """Return the model that holds speeds [m/s]; refuses those that the ship cannot make."""
        base.with_speeds(ordered, load_factor)
        top = float(base.speeds(load_factor)[-1])
        steps = np.linspace(float(ordered[0]), max(top, float(ordered[-1])), _STEPS)
        return cls(base, ordered, base.with_speeds(np.unique(steps), load_factor))

    @property
    def reads(self) -> frozenset[str]:
        """Conditions read."""
        return self.base.reads

    @property
    def holds_speed(self) -> bool:
        """True: the settings are speeds."""
        return True

    @property
    def loss(self) -> KwonSpeedLoss | PrestegardshusSpeedLoss | None:
        """Involuntary speed loss."""
        return self.base.loss

    @property
    def identity(self) -> Mapping[str, object]:
        """Data that distinguish this model from others."""
        return {**self.base.identity, "kind": "held speed", "ordered": self.ordered.tolist()}

    def speeds(self, load_factor: float) -> FloatArray:
        """Ordered speeds [m/s]."""
        return self.ordered

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]: the ordered one, or what the highest power leaves."""
        wanted, attained = self._attained(conditions, setting)
        return np.where(np.isnan(attained[..., -1]), np.nan, np.minimum(wanted, attained[..., -1]))

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Brake power [W] that holds the speed."""
        return self._at_setting(conditions, setting, self.ladder.powers)

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Fuel rate [kg/s] that holds the speed."""
        return self._at_setting(conditions, setting, self.ladder.fuel_rates)

    def _attained(
        self, conditions: Conditions, setting: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Return the ordered speeds, and those of every step of the ladder in the weather."""
        index = setting_index(setting, len(self.ordered))
        shape = np.broadcast_shapes(conditions.shape, index.shape)
        count = len(self.ladder.speeds_full)
        columns = {
            name: np.broadcast_to(np.asarray(values, float), shape)[..., None]
            for name, values in conditions.items()
        }
        attained = self.ladder.speed_through_water(Conditions(columns), np.arange(count))
        wanted = np.broadcast_to(self.ordered[index], shape)
        return wanted, np.broadcast_to(attained, (*shape, count))

    def _at_setting(
        self, conditions: Conditions, setting: ArrayLike, values: FloatArray
    ) -> FloatArray:
        """Return values of the ladder where its reduced speed is the ordered one."""
        wanted, attained = self._attained(conditions, setting)
        step = np.clip((attained < wanted[..., None]).sum(axis=-1), 1, attained.shape[-1] - 1)
        low = np.take_along_axis(attained, (step - 1)[..., None], axis=-1)[..., 0]
        high = np.take_along_axis(attained, step[..., None], axis=-1)[..., 0]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(high > low, (wanted - low) / (high - low), 0.0)
        share = np.clip(share, 0.0, 1.0)
        found = values[step - 1] + share * (values[step] - values[step - 1])
        return np.where(np.isnan(attained[..., -1]), np.nan, found)

    def top_speed(self, setting: int, load_factor: float) -> float:
        """Ordered speed [m/s]: weather does not raise it."""
        return float(self.ordered[setting])

    def tabulate(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One part over wind and depth, as far as they are read."""
        axes, count = known_speed_axes(self.base, load_factor), len(self.ordered)
        return tabulate_predicted_speed(self, axes, count, load_factor, tolerance=tolerance)

    def tabulate_fuel(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """Fuel rate over wind and depth."""
        return self._tabulated(load_factor, tolerance, self.fuel_rate)

    def tabulate_power(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """Brake power over wind and depth."""
        return self._tabulated(load_factor, tolerance, self.power)

    def _tabulated(
        self, load_factor: float, tolerance: float, rate: RateFunction
    ) -> tuple[tuple[TablePart, ...], TableError]:
        axes, count = known_speed_axes(self.base, load_factor), len(self.ordered)
        return tabulate_settings(rate, axes, count, load_factor, tolerance=tolerance)

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Where the speed loss is used outside its range."""
        return self.base.notes(conditions, setting)

    def greatest_speed(self, load_factor: float) -> float:
        """Greatest calm-water speed [m/s] of its settings."""
        return self.base.greatest_speed(load_factor)

    def with_speeds(self, speeds: FloatArray, load_factor: float) -> HeldSpeedModel:
        """Return the model with other ordered speeds [m/s]."""
        return HeldSpeedModel.of(self.base, speeds, load_factor)
