"""Reading of fuels and prices from a ship file."""

from __future__ import annotations

import math
from typing import Final

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, TONNE
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.methods.engine.fuel_properties import fuel_named
from thalweg.ship.schema.ship_schema import CostsSection, ShipFile

_GRAMS: Final = 1000.0  #: in a kilogram


def fuel_terms(file: ShipFile) -> FuelTerms:
    """Read fuels and prices from a ship file.

    Without ``eca_type`` the ship burns the same fuel inside; the price inside is
    ``eca_price_per_t``, or ``price_per_t`` times ``eca_price_factor``. The price of time is
    ``costs.hire_per_day`` or ``costs.per_week``; ``costs.per_second_per_cubed_speed`` replaces
    the price of fuel where there is none.

    Raises
    ------
    InputError : For unknown fuels, two prices for the same thing, and two currencies.
    """
    given, costs = file.fuel, file.costs
    outside = None if given.type is None else fuel_named(given.type)
    inside = outside if given.eca_type is None else fuel_named(given.eca_type)
    if given.eca_price_per_t is not None and given.gives("eca_price_factor"):
        raise InputError(
            "The price inside control areas is given twice.",
            "It is fuel.eca_price_per_t, or fuel.price_per_t times fuel.eca_price_factor.",
            "Keep one of them.",
            key="fuel.eca_price_factor",
        )
    price = math.nan if given.price_per_t is None else given.price_per_t
    own = given.eca_price_per_t
    factor = given.eca_price_factor if own is None else math.nan
    cubed = costs.per_second_per_cubed_speed
    emitted = costs.co2_g_per_second_per_cubed_speed
    return FuelTerms(
        outside=outside,
        inside=outside if inside == outside else inside,
        price_outside=price / TONNE,
        price_inside=(price * factor if own is None else own) / TONNE,
        eca_price_factor=factor,
        own_carbon_factor=given.carbon_factor,
        currency=_currency(file),
        usd_rate=math.nan if given.usd_rate is None else given.usd_rate,
        time_price=_time_price(costs),
        cubed_speed_price=math.nan if cubed is None else cubed,
        cubed_speed_co2=math.nan if emitted is None else emitted / _GRAMS,
    )


def _time_price(costs: CostsSection) -> float:
    """Return the price of time [currency/s]; 0 when the file gives none."""
    if costs.hire_per_day is not None and costs.per_week is not None:
        raise InputError(
            "The price of time is given twice.",
            "It is costs.hire_per_day or costs.per_week.",
            "Keep one of them.",
            key="costs.hire_per_day",
        )
    per_day = (costs.per_week or 0.0) / 7.0 if costs.hire_per_day is None else costs.hire_per_day
    return per_day / DAY


def _currency(file: ShipFile) -> str:
    named = {file.fuel.currency, file.costs.currency} - {None}
    if len(named) > 1:
        raise InputError(
            f"The ship file gives prices in {' and '.join(sorted(str(one) for one in named))}.",
            "All prices of a ship are in one currency.",
            "Give fuel and costs in the same one.",
            key="costs.currency",
        )
    return named.pop() or "" if named else ""
