"""Queries of a ship: speed, power, fuel and resistance in given conditions, and their tables."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace

from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import JointPowerAndFuelModel, ShipModel, Tabulation
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.tables.performance_table import PerformanceTable


class ShipQueries:
    """The part of `thalweg.ship.Ship` that evaluates conditions and makes tables."""

    name: str
    model: ShipModel
    loading: Loading
    limits: ShipLimits

    @abstractmethod
    def fingerprint(self) -> str:
        """Return a text that is equal for two ships only if they have the same performance."""

    @property
    @abstractmethod
    def hotel_power(self) -> float:
        """Hotel load [W]."""

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike = 0) -> FloatArray:
        """Speed through water [m/s].

        Parameters
        ----------
        conditions : Conditions
            Conditions at the ship, arrays that broadcast; see `reads`.
        setting : array_like of int
            Index into `speeds`.

        Returns
        -------
        ndarray
            At least 0; NaN where a condition is unknown or out of the model's range.

        Raises
        ------
        InputError
            If a condition is missing or there is no such setting.
        """
        return self.model.speed_through_water(self._loaded(conditions), setting)

    def power(self, conditions: Conditions, setting: ArrayLike = 0) -> FloatArray:
        """Brake power [W]; NaN where unknown. Parameters as in `speed_through_water`."""
        return self.model.power(self._loaded(conditions), setting)

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike = 0) -> FloatArray:
        """Fuel rate [kg/s]; NaN where unknown. Parameters as in `speed_through_water`."""
        return self.model.fuel_rate(self._loaded(conditions), setting)

    def power_and_fuel(
        self, conditions: Conditions, setting: ArrayLike = 0
    ) -> tuple[FloatArray, FloatArray]:
        """Brake power [W] and fuel rate [kg/s] at once, in one computation where the model can."""
        if isinstance(self.model, JointPowerAndFuelModel):
            return self.model.power_and_fuel(self._loaded(conditions), setting)
        return self.power(conditions, setting), self.fuel_rate(conditions, setting)

    def power_at_speed(self, conditions: Conditions, speed: ArrayLike) -> FloatArray:
        """Brake power [W] that holds speeds through water [m/s], also above that of the engines.

        Raises
        ------
        InputError
            If the ship is not made from its resistance.
        """
        return self._resistance_model("power").power_at_speed(self._loaded(conditions), speed)

    def resistance(self, conditions: Conditions, speed: ArrayLike) -> dict[str, FloatArray]:
        """Resistance by component [N] at speeds through water [m/s].

        Parameters
        ----------
        conditions : Conditions
        speed : array_like

        Returns
        -------
        dict
            ``total`` and its terms: ``friction, form_factor, appendage, wave_making, bulb, transom,
            correlation, residuary`` in deep water, ``shallow`` (what the depth adds), ``waves``,
            ``wind``, ``rudder``; zero where a method has no such term.

        Raises
        ------
        InputError
            If the ship is not made from its resistance.
        """
        return self._resistance_model("resistance").resistance(self._loaded(conditions), speed)

    @property
    def is_resistance_based(self) -> bool:
        """Whether the model knows the resistance, so that `power_at_speed` is available."""
        return isinstance(self.model, ResistanceBased)

    def _resistance_model(self, what: str) -> ResistanceBased:
        if not isinstance(self.model, ResistanceBased):
            raise InputError(
                f"The {what} of {self.name!r} at a speed is not known.",
                "Ships with models.calm_water such as holtrop_1984 know it.",
                "Choose such a ship or model.",
            )
        return self.model

    def notes(
        self, conditions: Conditions, setting: ArrayLike = 0, *, strict: bool = False
    ) -> list[RangeNote]:
        """Return which methods are used outside their range in these conditions.

        Raises
        ------
        ModelRangeError
            If ``strict`` and there is any.
        """
        found = self.model.notes(self._loaded(conditions), setting)
        if strict and found:
            raise ModelRangeError(
                "; ".join(str(note) for note in found) + ".",
                "Each method holds in the range it was fitted for.",
                "Choose other methods, or do without strictness.",
                notes=[str(note) for note in found],
            )
        return found

    def tabulate(self, *, tolerance: float = 0.01) -> PerformanceTable:
        """Tabulate the speed through water at the ship's load factor.

        Parameters
        ----------
        tolerance : float
            Relative error that 99 % of random conditions shall meet; the table says what it met.

        Returns
        -------
        PerformanceTable
        """
        found = Tabulation(*self.model.tabulate(self.loading.load_factor, tolerance))
        return PerformanceTable(
            found.parts,
            self.model.speeds(self.loading.load_factor),
            self.fingerprint(),
            found.error,
            found.curve,
            self.limits.safety,
        )

    def tabulate_fuel(self, *, tolerance: float = 0.01) -> PerformanceTable:
        """Tabulate the fuel rate [kg/s] at the ship's load factor, hotel load included.

        Parameters
        ----------
        tolerance : float
            Relative error that 99 % of random conditions shall meet; the table says what it met.

        Returns
        -------
        PerformanceTable
            A constant per setting where a setting burns the same in all weather.

        Raises
        ------
        InputError
            If the ship's fuel is unknown, or its speed is a field, which has no settings.
        """
        from thalweg.ship.models.tabulate_fuel import fuel_table

        found = fuel_table(self.model, self.loading.load_factor, tolerance, ship=self.name)
        return replace(found, fingerprint=self.fingerprint())

    def tabulate_power(self, *, tolerance: float = 0.01) -> PerformanceTable:
        """Tabulate the brake power with the hotel load [W]; parameters as in `tabulate_fuel`.

        Raises
        ------
        InputError
            If the ship's brake power is unknown, or its speed is a field.
        """
        from thalweg.ship.models.tabulate_fuel import power_table

        found = power_table(
            self.model,
            self.loading.load_factor,
            tolerance,
            hotel_power=self.hotel_power,
            ship=self.name,
        )
        return replace(found, fingerprint=self.fingerprint())

    def _loaded(self, conditions: Conditions) -> Conditions:
        return conditions.with_default(load_factor=self.loading.load_factor)
