"""Consumption that an objective prices: the prices on legs, the table, the rates in calm water."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.objective import Consumption, LegPrices, Objective
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, MEGAWATT_HOUR, TONNE
from thalweg.ship.conditions import Conditions
from thalweg.ship.model_protocol import SpeedHoldingModel
from thalweg.ship.tables.tabulate import tabulate_cubed_speed

if TYPE_CHECKING:
    from thalweg.ship.fuel_prices import FuelTerms
    from thalweg.ship.ship import Ship
    from thalweg.ship.tables.performance_table import PerformanceTable

#: Conditions in calm, deep water; without waves the wave period has no effect.
_CALM_CONDITIONS = {
    "wind_speed": 0.0,
    "wind_angle": 0.0,
    "wave_height": 0.0,
    "wave_angle": 0.0,
    "wave_period": 8.0,
    "depth": 1e4,
    "heading": 0.0,
    "current_east": 0.0,
    "current_north": 0.0,
}
_PRICED_CONSUMPTIONS = ("fuel", "energy", "cost", "co2", "comfort")


def leg_prices(objective: Objective, ship: Ship, terms: FuelTerms | None = None) -> LegPrices:
    """Return an objective as prices on legs, in SI, for the kernels.

    Parameters
    ----------
    objective : Objective
        With a price for one of fuel, energy, cost, CO2 and comfort, and perhaps one for time.
    terms : Fuels and prices; by default those of the ship file.

    Returns
    -------
    LegPrices : Prices [`Objective.unit`] of fuel [kg], energy [J] or, where fuel has no price, of
        the cube of the ordered speed times time [m3/s2] (van Halem 2019).

    Raises
    ------
    InputError : If the objective prices none or several of these, or if a price of fuel or a carbon
        factor that it needs is not known.
    """
    terms = ship.fuel_terms if terms is None else terms
    prices = objective.prices
    priced = [name for name in _PRICED_CONSUMPTIONS if name in prices]
    if len(priced) != 1 or "distance" in prices:
        raise InputError(
            f"The objective prices {', '.join(prices)}.",
            f"Speeds are chosen for one of {', '.join(_PRICED_CONSUMPTIONS)}, and for time.",
            "Price one of these.",
            field="objective",
        )
    name, hourly = priced[0], objective.time / HOUR
    price = prices[name]
    if name == "energy":
        joule = price / MEGAWATT_HOUR
        waiting = ship.hotel_power * joule
        return LegPrices(joule, joule, hourly, waiting, consumption="energy")
    if name == "comfort":
        return LegPrices(price, price, hourly, consumption="squared_dose")
    if name == "cost" and terms.by_speed:
        cubed = price * terms.cubed_speed_price
        second = price * terms.time_price + hourly
        return LegPrices(cubed, cubed, second, 0.0, price, "cubed_speed")
    if name == "co2" and terms.emits_by_speed:
        cubed = price * terms.cubed_speed_co2 / TONNE
        return LegPrices(cubed, cubed, hourly, consumption="cubed_speed")
    inside, outside = (price * terms.per_kg(name, inside=within) for within in (True, False))
    if not (math.isfinite(inside) and math.isfinite(outside)):
        raise _unknown_price_error(name, ship)
    if name == "cost":
        second = price * terms.time_price + hourly
        return LegPrices(inside, outside, second, ship.waiting_fuel_rate * outside, price)
    inside, outside = inside / TONNE, outside / TONNE
    return LegPrices(inside, outside, hourly, ship.waiting_fuel_rate * outside)


def engine_order(ship: Ship) -> str:
    """Return what the engine of a ship holds on a leg, for results.

    Returns
    -------
    str
        ``"constant power"`` (weather changes the speed), ``"constant speed"`` (through water, up to
        the largest power of the engines), or ``"speed of the model"`` for ships without settings.
    """
    if ship.speed_field is not None:
        return "speed of the model"
    holds_speed = isinstance(ship.model, SpeedHoldingModel) and ship.model.holds_speed
    return "constant speed" if holds_speed else "constant power"


def consumption_table(ship: Ship, consumption: Consumption) -> PerformanceTable:
    """Return the table of what a ship consumes in a second.

    Parameters
    ----------
    consumption : {"fuel", "energy", "cubed_speed", "squared_dose"}

    Returns
    -------
    PerformanceTable : Fuel rate [kg/s], power of brake and hotel load [W], cubed ordered speed
        [m3/s3], or squared weighted acceleration [m2/s4].

    Raises
    ------
    InputError : If the ship's fuel, or its power, is not known.
    """
    if consumption == "cubed_speed":
        return tabulate_cubed_speed(ship.speeds)
    if consumption == "squared_dose":
        from thalweg.ship.comfort.dose_table import squared_dose_table  # reads motions

        return squared_dose_table(ship)
    return ship.tabulate_power() if consumption == "energy" else ship.tabulate_fuel()


def calm_water_consumption(ship: Ship, consumption: Consumption) -> FloatArray:
    """Return what a ship consumes in a second in calm, deep water, at every setting.

    Parameters
    ----------
    consumption : {"fuel", "energy", "cubed_speed", "squared_dose"}

    Returns
    -------
    float64 array (settings,) : In the units of `consumption_table`.
    """
    if consumption == "cubed_speed":
        return np.asarray(ship.speeds, float) ** 3
    if consumption == "squared_dose":
        return np.zeros(len(ship.speeds))
    conditions = Conditions({name: v for name, v in _CALM_CONDITIONS.items() if name in ship.reads})
    settings = np.arange(len(ship.speeds))
    found = ship.power_and_fuel(conditions, settings)
    power, fuel = (_of_settings(ship, values, settings.shape) for values in found)
    return power + ship.hotel_power if consumption == "energy" else fuel


def _of_settings(ship: Ship, values: object, shape: tuple[int, ...]) -> FloatArray:
    """Return values of a model by setting; a single one holds for all settings.

    Raises
    ------
    InputError : If a model of a plug-in returns another shape.
    """
    array = np.asarray(values, float)
    if array.shape not in ((), shape):
        raise InputError(
            f"The model of {ship.name!r} returns power or fuel of shape {array.shape} for "
            f"{shape[0]} settings.",
            "It returns one value per setting and condition.",
            "Correct the model; thalweg.ship.check_ship_model finds such faults.",
        )
    return np.array(np.broadcast_to(array, shape))


def _unknown_price_error(name: str, ship: Ship) -> InputError:
    if name == "cost":
        return InputError(
            f"The objective is the cost of a voyage of {ship.name!r}, but no price of fuel is "
            "known.",
            "Prices come from --fuel-price USD, from fuel.price_per_t in the ship file, from "
            "costs.per_second_per_cubed_speed instead of it, or from FuelTerms.with_prices.",
            "Give one of them.",
            field="fuel_price_usd",
        )
    return InputError(
        f"The objective is the CO2 of {ship.name!r}, but the carbon factor of its fuel is not "
        "known.",
        "It comes from fuel.type, fuel.carbon_factor or "
        "costs.co2_g_per_second_per_cubed_speed in the ship file.",
        "Name the fuel there, or choose the objective 'fuel'.",
        field="objective",
    )
