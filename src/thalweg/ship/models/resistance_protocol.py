"""The protocol of models that know the resistance of the ship."""

from __future__ import annotations

from typing import Final, Protocol, runtime_checkable

from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.models.engine_plant import EngineOrders, EnginePlant
from thalweg.ship.models.force_balance import FlatConditions, ForceBalance
from thalweg.ship.ship_limits import ShipLimits

#: Weather does not raise the speed beyond this multiple of the calm-water speed.
LARGEST_SPEED_FACTOR: Final = 1.25


@runtime_checkable
class ResistanceBased(Protocol):
    """Capability of a ship model: resistance and power at given speeds through water."""

    @property
    def plant(self) -> EnginePlant:
        """The engines."""
        ...

    def balance(self, load_factor: float) -> ForceBalance:
        """Return forces and power at a load factor."""
        ...

    def resistance(self, conditions: Conditions, speed: ArrayLike) -> dict[str, FloatArray]:
        """Return the resistance by component [N] at speeds through water [m/s]."""
        ...

    def power_at_speed(self, conditions: Conditions, speed: ArrayLike) -> FloatArray:
        """Return the brake power [W] that holds speeds through water [m/s]."""
        ...


class TabulatedResistance(ResistanceBased, Protocol):
    """What the tables of a resistance-based ship need from its model."""

    @property
    def orders(self) -> EngineOrders:
        """The powers or speeds that can be ordered."""
        ...

    @property
    def limits(self) -> ShipLimits:
        """The limits of weather, at which tables end."""
        ...

    def speeds(self, load_factor: float) -> FloatArray:
        """Return the calm-water speed of every setting [m/s], ascending."""
        ...

    def speed_of(
        self, balance: ForceBalance, at: FlatConditions, setting: FloatArray, load_factor: float
    ) -> FloatArray:
        """Return the speed through water [m/s] of settings in flat conditions."""
        ...

    def power_of(
        self, balance: ForceBalance, at: FlatConditions, setting: FloatArray, load_factor: float
    ) -> FloatArray:
        """Return the brake power [W] of settings in flat conditions."""
        ...
