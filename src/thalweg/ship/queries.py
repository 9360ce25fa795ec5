"""Queries of a ship: speed, power, fuel and resistance in given conditions, and their tables."""

from __future__ import annotations

import math
from typing import Final, Protocol

from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import needed_variables
from thalweg.ship.conditions import Conditions
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import (
    AdjustableModel,
    GreatestSpeedModel,
    JointPowerAndFuelModel,
    ShipModel,
)
from thalweg.ship.models.function_model import FunctionModel
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.ship_limits import ShipLimits

_SINGLE_PRECISION: Final = 2.0**-23  #: relative rounding of the values of a table


class ModelledShip(Protocol):
    """What the queries need of a ship."""

    @property
    def name(self) -> str:
        """Name, for messages."""
        ...

    @property
    def model(self) -> ShipModel:
        """Speed, power and fuel."""
        ...

    @property
    def loading(self) -> Loading:
        """Draught and load factor."""
        ...

    @property
    def limits(self) -> ShipLimits:
        """Greatest waves and wind."""
        ...

    @property
    def hotel_power(self) -> float:
        """Hotel load [W]."""
        ...


def ship_speed_through_water(
    ship: ModelledShip, conditions: Conditions, setting: ArrayLike = 0
) -> FloatArray:
    """Return the speed through water [m/s].

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    setting : array_like of int
        Index into `speeds`.

    Returns
    -------
    float64 array
        At least 0; NaN where a condition is unknown or out of the model's range.

    Raises
    ------
    InputError
        If a condition is missing or there is no such setting.
    """
    return ship.model.speed_through_water(_at_loading(ship, conditions), setting)


def ship_power(ship: ModelledShip, conditions: Conditions, setting: ArrayLike = 0) -> FloatArray:
    """Return the brake power [W], without the hotel load.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    setting : array_like of int
        Index into `speeds`.

    Returns
    -------
    float64 array
        NaN where a condition is unknown, or the model knows no power.

    Raises
    ------
    InputError
        If a condition is missing or there is no such setting.
    """
    return ship.model.power(_at_loading(ship, conditions), setting)


def ship_fuel_rate(
    ship: ModelledShip, conditions: Conditions, setting: ArrayLike = 0
) -> FloatArray:
    """Return the fuel rate [kg/s], the hotel load included.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    setting : array_like of int
        Index into `speeds`.

    Returns
    -------
    float64 array
        NaN where a condition is unknown, or the model knows no fuel rate.

    Raises
    ------
    InputError
        If a condition is missing or there is no such setting.
    """
    return ship.model.fuel_rate(_at_loading(ship, conditions), setting)


def ship_power_and_fuel(
    ship: ModelledShip, conditions: Conditions, setting: ArrayLike = 0
) -> tuple[FloatArray, FloatArray]:
    """Return the brake power and the fuel rate, in one computation where the model can.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    setting : array_like of int
        Index into `speeds`.

    Returns
    -------
    power, fuel : float64 array
        As `power` [W] and `fuel_rate` [kg/s] give them.

    Raises
    ------
    InputError
        If a condition is missing or there is no such setting.
    """
    if isinstance(ship.model, JointPowerAndFuelModel):
        return ship.model.power_and_fuel(_at_loading(ship, conditions), setting)
    return ship_power(ship, conditions, setting), ship_fuel_rate(ship, conditions, setting)


def ship_power_at_speed(ship: ModelledShip, conditions: Conditions, speed: ArrayLike) -> FloatArray:
    """Return the brake power [W] that holds a speed, also above the power of the engines.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    speed : array_like
        Speed through water [m/s]; broadcast with the conditions.

    Returns
    -------
    float64 array
        NaN where a condition is unknown or out of range.

    Raises
    ------
    InputError
        If the ship is not made from its resistance.
    """
    return _resistance_model(ship, "power").power_at_speed(_at_loading(ship, conditions), speed)


def ship_resistance(
    ship: ModelledShip, conditions: Conditions, speed: ArrayLike
) -> dict[str, FloatArray]:
    """Return the resistance by component [N] at speeds through water.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    speed : array_like
        Speed through water [m/s]; broadcast with the conditions.

    Returns
    -------
    dict of str to float64 array
        ``total`` and its terms: ``friction, form_factor, appendage, wave_making, bulb, transom,
        correlation, residuary`` in deep water, ``shallow`` (what the depth adds), ``waves``,
        ``wind``, ``rudder``; zero where a method has no such term.

    Raises
    ------
    InputError
        If the ship is not made from its resistance.
    """
    return _resistance_model(ship, "resistance").resistance(_at_loading(ship, conditions), speed)


def ship_range_notes(
    ship: ModelledShip, conditions: Conditions, setting: ArrayLike = 0, *, strict: bool = False
) -> list[RangeNote]:
    """Return which methods are used outside their range in these conditions.

    Parameters
    ----------
    conditions : Conditions
        Conditions at the ship, arrays that broadcast; see `reads`.
    setting : array_like of int
        Index into `speeds`.
    strict : bool
        Whether to raise an error if there is any.

    Returns
    -------
    list of RangeNote
        Empty if all methods are within their range.

    Raises
    ------
    ModelRangeError
        If ``strict`` and there is any.
    """
    found = ship.model.notes(_at_loading(ship, conditions), setting)
    if strict and found:
        raise ModelRangeError(
            "; ".join(str(note) for note in found) + ".",
            "Each method holds in the range it was fitted for.",
            "Choose other methods, or call without strict=True.",
            notes=[str(note) for note in found],
        )
    return found


def ship_top_speed(ship: ModelledShip, setting: int = 0) -> float | None:
    """Return an upper bound of the speed through water in any conditions.

    It holds for the model and for its table, which is rounded to single precision.

    Parameters
    ----------
    setting : int
        Index into `speeds`.

    Returns
    -------
    float or None
        [m/s]; None for a field without a known bound.
    """
    top = ship.model.top_speed(setting, ship.loading.load_factor)
    return None if top is None else top * (1.0 + _SINGLE_PRECISION)


def ship_greatest_order(ship: ModelledShip) -> float:
    """Return the greatest calm-water speed that can be ordered.

    Returns
    -------
    float
        [m/s] at the load factor: that of the largest power, or the highest of the ship file where
        the power above it is not known; inf where nothing limits it.
    """
    if isinstance(ship.model, GreatestSpeedModel):
        return ship.model.greatest_speed(ship.loading.load_factor)
    if isinstance(ship.model, AdjustableModel):
        return float(ship.model.speeds(ship.loading.load_factor)[-1])
    return math.inf


def model_needs(model: ShipModel) -> frozenset[str]:
    """Return the sea variables that a model needs.

    Parameters
    ----------
    model : Speed, power and fuel.

    Returns
    -------
    frozenset of str : CF standard names.
    """
    return model.needs if isinstance(model, FunctionModel) else needed_variables(model.reads)


def _at_loading(ship: ModelledShip, conditions: Conditions) -> Conditions:
    return conditions.with_default(load_factor=ship.loading.load_factor)


def _resistance_model(ship: ModelledShip, what: str) -> ResistanceBased:
    if not isinstance(ship.model, ResistanceBased):
        raise InputError(
            f"The {what} of {ship.name!r} at a speed is not known.",
            "Ships with models.calm_water such as holtrop_1984 know it.",
            "Choose such a ship or model.",
        )
    return ship.model
