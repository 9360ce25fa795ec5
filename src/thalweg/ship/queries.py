"""Queries of a ship in given conditions: speed, power, fuel, resistance, validity."""

from __future__ import annotations

from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import JointPowerAndFuelModel, ShipModel
from thalweg.ship.models.resistance_protocol import ResistanceBased


class ShipQueries:
    """The part of `thalweg.ship.Ship` that evaluates conditions."""

    name: str
    model: ShipModel
    loading: Loading

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

    def _loaded(self, conditions: Conditions) -> Conditions:
        return conditions.with_default(load_factor=self.loading.load_factor)
