"""Consumption that an objective prices: the prices on legs, the table, the rates in calm water."""

from __future__ import annotations

import math
from dataclasses import astuple, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.objective import Consumption, LegPrices, Objective
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, MEGAWATT_HOUR, NAUTICAL_MILE, TONNE
from thalweg.ship.conditions import Conditions
from thalweg.ship.model_protocol import does_hold_speed
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import tabulate_cubed_speed

if TYPE_CHECKING:
    from thalweg.ship.fuel_prices import FuelTerms
    from thalweg.ship.ship import Ship

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
#: Consumptions and their weights.
Mix: TypeAlias = tuple[tuple[Consumption, float], ...]

_PRICED_CONSUMPTIONS = ("fuel", "energy", "cost", "co2", "comfort")


def leg_prices(objective: Objective, ship: Ship, terms: FuelTerms | None = None) -> LegPrices:
    """Return an objective as prices on legs, in SI, for the kernels.

    Parameters
    ----------
    objective : Objective
        The prices of its key figures add up.
    terms : Fuels and prices; by default those of the ship file.

    Returns
    -------
    LegPrices : Prices [`Objective.unit`] of fuel [kg], energy [J] or, where fuel has no price, of
        the cube of the ordered speed times time [m3/s2] (van Halem 2019); of their mixture where
        several key figures consume different ones.

    Raises
    ------
    InputError : If a price of fuel or a carbon factor that it needs is not known, or fuel that
        costs more in control areas is mixed with another consumption.
    """
    terms = ship.fuel_terms if terms is None else terms
    prices = objective.prices
    parts = [_consumption_prices(name, prices[name], ship, terms)
             for name in _PRICED_CONSUMPTIONS if name in prices]  # fmt: skip
    if not parts:
        found = LegPrices(0.0, 0.0, consumption="cubed_speed")
    elif len(parts) == 1:
        found = parts[0]
    elif len({part.consumption for part in parts}) == 1:
        found = _added_prices(parts)
    else:
        found = _mixed_prices(parts, tuple(prices))
    return replace(
        found,
        time=found.time + objective.time / HOUR,
        length=objective.distance / NAUTICAL_MILE,
        inshore=objective.inshore / NAUTICAL_MILE,
        encounters=objective.encounters,
    )


def _added_prices(parts: list[LegPrices]) -> LegPrices:
    """Return the sum of prices of one consumption, such as those of fuel and of its cost."""
    return replace(
        parts[0],
        inside=sum(part.inside for part in parts),
        outside=sum(part.outside for part in parts),
        time=sum(part.time for part in parts),
        waiting=sum(part.waiting for part in parts),
        dues=max(part.dues for part in parts),
    )


def _mixed_prices(parts: list[LegPrices], names: tuple[str, ...]) -> LegPrices:
    if any(part.differs_in_control_areas for part in parts):
        raise InputError(
            f"The weighted sum counts {', '.join(names)}, and fuel has another price or carbon "
            "factor inside emission control areas.",
            "Such a price is counted for one consumption alone.",
            "Weigh fuel in place of cost or CO2, or leave the areas out (--no-eca).",
            field="weights",
        )
    return LegPrices(
        1.0,
        1.0,
        sum(part.time for part in parts),
        sum(part.waiting for part in parts),
        max(part.dues for part in parts),
        "mixed",
        tuple((part.consumption, part.outside) for part in parts),
    )


def _consumption_prices(name: str, price: float, ship: Ship, terms: FuelTerms) -> LegPrices:
    """Return the prices of one key figure that is consumed along legs."""
    if name == "energy":
        joule = price / MEGAWATT_HOUR
        return LegPrices(joule, joule, 0.0, ship.hotel_power * joule, consumption="energy")
    if name == "comfort":
        return LegPrices(price, price, consumption="squared_dose")
    # without a rate of the dollar no canal with dues is open to the search
    dues = price * (terms.dollar_rate if math.isfinite(terms.dollar_rate) else 1.0)
    if name == "cost" and terms.by_speed:
        cubed = price * terms.cubed_speed_price
        return LegPrices(cubed, cubed, price * terms.time_price, 0.0, dues, "cubed_speed")
    if name == "co2" and terms.emits_by_speed:
        cubed = price * terms.cubed_speed_co2 / TONNE
        return LegPrices(cubed, cubed, consumption="cubed_speed")
    inside, outside = (price * terms.per_kg(name, inside=within) for within in (True, False))
    if not (math.isfinite(inside) and math.isfinite(outside)):
        raise _unknown_price_error(name, ship)
    if name == "cost":
        second = price * terms.time_price
        return LegPrices(inside, outside, second, ship.waiting_fuel_rate * outside, dues)
    inside, outside = inside / TONNE, outside / TONNE
    return LegPrices(inside, outside, 0.0, ship.waiting_fuel_rate * outside)


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
    return "constant speed" if does_hold_speed(ship.model) else "constant power"


def consumption_table(ship: Ship, consumption: Consumption, mix: Mix = ()) -> PerformanceTable:
    """Return the table of what a ship consumes in a second.

    Parameters
    ----------
    consumption : {"fuel", "energy", "cubed_speed", "squared_dose", "mixed"}
    mix : tuple of (Consumption, float)
        For a mixed one.

    Returns
    -------
    PerformanceTable : Fuel rate [kg/s], power of brake and hotel load [W], cubed ordered speed
        [m3/s3], squared weighted acceleration [m2/s4], or their weighted sum.

    Raises
    ------
    InputError : If the ship's fuel, or its power, is not known, or it is no sum of parts where a
        sum is needed.
    """
    if consumption == "mixed":
        return _mixed_table(ship, mix)
    if consumption == "cubed_speed":
        return tabulate_cubed_speed(ship.speeds)
    if consumption == "squared_dose":
        from thalweg.ship.comfort.dose_table import squared_dose_table  # reads motions

        return squared_dose_table(ship)
    return ship.tabulate_power() if consumption == "energy" else ship.tabulate_fuel()


def _mixed_table(ship: Ship, mix: Mix) -> PerformanceTable:
    """Return the weighted sum of tables: the parts of all."""
    parts: list[TablePart] = []
    error = TableError(0.0, 0.0, 0.0)
    for name, weight in mix:
        table = consumption_table(ship, name)
        if table.finish is not None:
            raise InputError(
                f"The {name} of {ship.name!r} is weighed against other figures, and the ship holds "
                "a constant speed.",
                "Its fuel is a curve of its resistance, and cannot be added to other tables.",
                "Weigh time in place of fuel, or let the ship hold its power: leave out --hold, or "
                "give powers_kw in place of speeds_kn in the ship file.",
                field="weights",
            )
        parts += [replace(part, values=weight * part.values) for part in table.parts]
        own = table.error
        error = TableError(*(max(a, b) for a, b in zip(astuple(error), astuple(own))))
    return PerformanceTable(tuple(parts), ship.speeds, ship.fingerprint(), error)


def calm_water_consumption(ship: Ship, consumption: Consumption, mix: Mix = ()) -> FloatArray:
    """Return what a ship consumes in a second in calm, deep water, at every setting.

    Parameters
    ----------
    consumption : {"fuel", "energy", "cubed_speed", "squared_dose", "mixed"}
    mix : tuple of (Consumption, float)
        For a mixed one.

    Returns
    -------
    float64 array (settings,) : In the units of `consumption_table`.
    """
    if consumption == "mixed":
        rates = [weight * calm_water_consumption(ship, name) for name, weight in mix]
        return np.sum(rates, axis=0, dtype=np.float64)
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
