"""What a plan that trades time for something makes least: fuel, energy, cost or CO2."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, HOUR, MEGAWATT_HOUR, TONNE
from thalweg.network import Network, eca_fractions
from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.ship import Conditions, PerformanceTable, Ship
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.tables.tabulate import tabulate_cubed_speed

#: What a ship meets in still water; the period of no waves is any.
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


@dataclass(frozen=True)
class ConsumptionRate:
    """What a ship spends in a second, by which a criterion counts.

    Attributes
    ----------
    table : PerformanceTable
        Fuel [kg/s], power of brake and hotel load [W], or the cubed ordered speed [m3/s3].
    waiting : float
        The same while lying still.
    still : ndarray
        Of every setting in still, deep water.
    """

    table: PerformanceTable
    waiting: float
    still: FloatArray


@dataclass(frozen=True)
class Criterion:
    """What is weighed against time.

    Attributes
    ----------
    name : {"fuel", "energy", "cost", "co2"}
    unit : str
        Unit it is told in: t, MWh, or the currency of the prices.
    inside, outside : float
        What a kilogram of fuel (a joule, a cubed speed for a second; see `consumption_rate`)
        counts inside and outside emission control areas [unit].
    time_price : float
        What a second counts besides [unit].
    terms : FuelTerms
        Prices and carbon factors, for the referee.
    """

    name: str
    unit: str
    inside: float
    outside: float
    time_price: float
    terms: FuelTerms

    def of(self, route: Route) -> float:
        """Return what a refereed route counts [unit]; infinite where it is not known."""
        value = {
            "fuel": route.fuel_t,
            "energy": route.energy_mwh,
            "cost": route.cost,
            "co2": route.co2_t,
        }[self.name]
        return math.inf if value is None or not math.isfinite(value) else float(value)

    def consumption_rate(self, ship: Ship) -> ConsumptionRate:
        """Return what the ship spends in a second, as far as this counts it.

        Raises
        ------
        InputError
            If the ship's fuel, or its power, is not known.
        """
        if self.name == "cost" and self.terms.by_speed:
            cubed = np.asarray(ship.speeds, float) ** 3
            return ConsumptionRate(tabulate_cubed_speed(ship.speeds), 0.0, cubed)
        energy = self.name == "energy"
        table = ship.tabulate_power() if energy else ship.tabulate_fuel()
        conditions = Conditions(
            {name: v for name, v in _CALM_CONDITIONS.items() if name in ship.reads}
        )
        power, fuel = ship.power_and_fuel(conditions, np.arange(len(ship.speeds)))
        if energy:
            return ConsumptionRate(
                table, ship.hotel_power, np.asarray(power, float) + ship.hotel_power
            )
        return ConsumptionRate(table, ship.waiting_fuel_rate, np.asarray(fuel, float))

    def weights(self, network: Network, chart: Chart) -> FloatArray:
        """Return what `inside` and `outside` tell, on every edge of a network [unit]."""
        price = np.asarray(network.price, float) if self.name == "cost" else 1.0
        weight = np.full(network.n_edges, self.outside)
        if self.inside != self.outside:
            weight += eca_fractions(network, chart) * (self.inside - self.outside)
        return np.asarray(weight * price)


def find_criterion(voyage: Voyage, ship: Ship) -> Criterion:
    """Return what the voyage weighs against time, with prices where they are needed.

    Raises
    ------
    InputError
        If a price or a carbon factor is needed and nothing tells it.
    """
    hourly = voyage.time_price_usd_per_h
    terms = ship.fuel_terms.with_prices(
        usd_per_t=voyage.fuel_price_usd,
        eca_price_factor=voyage.eca_price_factor,
        time_usd_per_day=None if hourly is None else hourly * DAY / HOUR,
    )
    name = voyage.objective
    if name == "front":
        asked = (voyage.fuel_price_usd, voyage.eca_price_factor, voyage.time_price_usd_per_h)
        name = "fuel" if all(value is None for value in asked) else "cost"
    if name == "energy":
        joule = 1.0 / MEGAWATT_HOUR
        return Criterion(name, "MWh", joule, joule, 0.0, terms)
    if name == "cost" and terms.by_speed:
        price, currency = terms.cubed_speed_price, terms.currency or "USD"
        return Criterion(name, currency, price, price, terms.time_price, terms)
    inside, outside = (terms.per_kg(name, inside=inside) for inside in (True, False))
    if not (math.isfinite(inside) and math.isfinite(outside)):
        raise _unknown_consumption_error(name, ship)
    if name == "cost":
        return Criterion(name, terms.currency or "USD", inside, outside, terms.time_price, terms)
    return Criterion(name, "t", inside / TONNE, outside / TONNE, 0.0, terms)


def _unknown_consumption_error(name: str, ship: Ship) -> InputError:
    if name == "cost":
        return InputError(
            f"The cost of a voyage of {ship.name!r} is asked, but no price of fuel is known.",
            "Prices come from --fuel-price USD, or fuel.price_per_t in the ship file, or "
            "costs.per_second_per_cubed_speed stands for them.",
            "Give one.",
            field="fuel_price_usd",
        )
    return InputError(
        f"The CO2 of {ship.name!r} is asked, but its fuel is not known.",
        "Carbon comes from fuel.type or fuel.carbon_factor in the ship file.",
        "Name the fuel, or ask for the objective 'fuel'.",
        field="objective",
    )
