"""The engines of a ship: available power and fuel consumption."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.methods.engine.fuel_properties import fuel_named
from thalweg.ship.methods.engine.specific_consumption import (
    GRAM_PER_KILOWATT_HOUR,
    base_sfoc,
    fuel_rate,
    hotel_fuel_rate,
    plant_fuel_rate,
)
from thalweg.ship.methods.validity import RangeNote, range_notes
from thalweg.ship.schema.ship_schema import ShipFile


@dataclass(frozen=True)
class EngineOrders:
    """The settings that the bridge can order.

    Attributes
    ----------
    kind : {"power", "speed"}
        Constant brake power, or a speed that is held up to the largest power of the engines.
    values : Powers [W] or speeds [m/s], ascending.
    """

    kind: Literal["power", "speed"]
    values: tuple[float, ...]


@dataclass(frozen=True)
class EnginePlant:
    """Engines: available power and fuel consumption.

    Attributes
    ----------
    rating : Maximum continuous rating of one engine [W]; infinite when not given.
    sfoc : Least specific consumption [g/kWh]; NaN when unknown.
    curve : Loads and specific consumptions [g/kWh] of the engine's own curve; empty for the shape
        of the Fourth IMO GHG Study.
    hotel_power, hotel_sfoc : Other power [W] and its consumption [g/kWh].
    loads : Least and largest load of an engine, as shares of its rating.
    """

    rating: float
    count: int = 1
    sfoc: float = float("nan")
    curve: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())
    hotel_power: float = 0.0
    hotel_sfoc: float = 195.0
    estimated: tuple[Estimate, ...] = ()
    loads: tuple[float, float] = (0.0, 1.0)

    @property
    def largest_power(self) -> float:
        """All engines at their largest load [W]; infinite when not given."""
        return self.rating * self.count * self.loads[1]

    def fuel(self, power: FloatArray) -> FloatArray:
        """Fuel rate [kg/s] of a brake power [W], hotel load included; NaN when unknown."""
        hotel = hotel_fuel_rate(self.hotel_power, sfoc_g_kwh=self.hotel_sfoc)
        return self._engines(np.asarray(power, float)) + hotel

    def _engines(self, power: FloatArray) -> FloatArray:
        if self.curve[0]:
            load = power / (self.rating * self.count)
            return power * np.interp(load, *self.curve) * GRAM_PER_KILOWATT_HOUR
        if np.isinf(self.rating):
            return power * self.sfoc * GRAM_PER_KILOWATT_HOUR
        if self.count == 1:
            return fuel_rate(power, self.rating, sfoc_g_kwh=self.sfoc)
        reachable = np.minimum(power, self.largest_power)
        return plant_fuel_rate(
            reachable,
            self.rating,
            count=self.count,
            sfoc_g_kwh=self.sfoc,
            largest_load=self.loads[1],
        )[0]

    def notes(self, power: FloatArray) -> list[RangeNote]:
        """Return loads above the largest, below the least, or without known consumption."""
        if np.isinf(self.rating):
            return []
        least, largest = self.loads
        one = power / self.rating
        known = {"load of one engine": (one, 0.2, np.inf)}
        if self.curve[0]:
            load = np.minimum(one / self.count, largest)  # beyond, nothing is burnt
            known = {"load": (load, self.curve[0][0], self.curve[0][-1] + 1e-6)}
        return [
            *range_notes("engine", {"load": (one / self.count, 0.0, largest + 1e-6)}),
            *range_notes("engine", {"load of one engine": (one, least, np.inf)}),
            *range_notes("sfoc", known),
        ]


def build_engine_plant(file: ShipFile) -> EnginePlant:
    """Return the engines of a ship file.

    Raises
    ------
    InputError : For unknown engine types or fuels, and curves that do not fit.
    """
    given = file.engine
    loads, curve = given.sfoc_load, given.sfoc_curve_g_per_kwh
    if len(loads) != len(curve) or (len(loads) and (np.diff(loads) <= 0).any()):
        raise InputError(
            f"The engine's curve has {len(loads)} loads and {len(curve)} consumptions.",
            "sfoc_load rises, and sfoc_curve_g_per_kwh has as many numbers.",
            "Correct them.",
            key="engine.sfoc_load",
        )
    if len(loads) and given.power_kw is None:
        raise InputError(
            "The engine has a curve over load, but no power_kw.",
            "Load is power over engine.power_kw times engine.count.",
            "Add engine.power_kw.",
            missing=["engine.power_kw"],
        )
    least, largest = given.least_load, given.largest_load
    if least >= largest:
        raise InputError(
            f"The least load of an engine is {least:g}, the largest {largest:g}.",
            "Loads are shares of engine.power_kw; the largest is 1 when not given.",
            "Correct engine.least_load or engine.largest_load.",
            key="engine.least_load",
        )
    sfoc, guessed = _specific_consumption(file)
    if not curve and "turbine" in (given.type or "").casefold():
        loads, curve = (0.0, 1.0), (sfoc, sfoc)  # the study lets theirs vary with nothing
    return EnginePlant(
        rating=float("inf") if given.power_kw is None else given.power_kw * 1000.0,
        count=given.count,
        sfoc=sfoc,
        curve=(tuple(loads), tuple(curve)),
        hotel_power=given.hotel_power,
        hotel_sfoc=given.hotel_sfoc_g_per_kwh,
        estimated=guessed,
        loads=(least, largest),
    )


def _specific_consumption(file: ShipFile) -> tuple[float, tuple[Estimate, ...]]:
    given = file.engine
    if given.sfoc_g_per_kwh is not None:
        return given.sfoc_g_per_kwh, ()
    if given.type is None or given.sfoc_curve_g_per_kwh:
        return float("nan"), ()
    kind = fuel_named(file.fuel.type or "hfo").kind
    value, record = base_sfoc(given.type, kind, built=int(given.year))
    return value, (Estimate("engine.sfoc_g_per_kwh", value, record.source),)
