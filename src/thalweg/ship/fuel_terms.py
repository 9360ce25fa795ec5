"""What a ship burns, inside and outside emission control areas, and what it pays."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thalweg.core.errors import InputError
from thalweg.core.units import TONNE
from thalweg.ship.methods.fuel import Fuel, fuel_named


@dataclass(frozen=True)
class FuelTerms:
    """Fuels and prices of a ship.

    Attributes
    ----------
    outside, inside : Fuel or None
        Burnt outside and inside emission control areas; None when the ship file names none.
    price_outside, price_inside : float
        Per kilogram, in ``currency``; NaN when unknown.
    carbon_outside, carbon_inside : float
        CO2 per fuel [kg/kg]; NaN when unknown.
    currency : str
    """

    outside: Fuel | None
    inside: Fuel | None
    price_outside: float
    price_inside: float
    carbon_outside: float
    carbon_inside: float
    currency: str


def fuel_terms(data: Mapping[str, Any]) -> FuelTerms:
    """Read fuels and prices from a ship file.

    Without ``eca_type`` the ship burns the same fuel inside; the price inside is
    ``eca_price_per_t``, or ``price_per_t`` times ``eca_price_factor``.

    Raises
    ------
    InputError
        For unknown fuels, and two prices for the same thing.
    """
    given = data.get("fuel", {})
    outside = fuel_named(given["type"]) if "type" in given else None
    inside = fuel_named(given["eca_type"]) if "eca_type" in given else outside
    if "eca_price_per_t" in given and "eca_price_factor" in given:
        raise InputError(
            "The price inside control areas is given twice.",
            "It is fuel.eca_price_per_t, or fuel.price_per_t times fuel.eca_price_factor.",
            "Keep one of them.",
            key="fuel.eca_price_factor",
        )
    price = given.get("price_per_t", math.nan)
    price_inside = given.get("eca_price_per_t", price * given.get("eca_price_factor", 1.0))
    own = given.get("carbon_factor")
    return FuelTerms(
        outside=outside,
        inside=inside,
        price_outside=price / TONNE,
        price_inside=price_inside / TONNE,
        carbon_outside=_carbon(outside, own),
        carbon_inside=_carbon(inside, own if inside is outside else None),
        currency=given.get("currency", ""),
    )


def _carbon(fuel: Fuel | None, own: float | None) -> float:
    if own is not None:
        return float(own)
    return math.nan if fuel is None else fuel.carbon_factor
