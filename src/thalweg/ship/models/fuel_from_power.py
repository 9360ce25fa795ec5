"""Fuel of a ship with known speeds that gives its power and how much its engines burn for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.ship.model_protocol import Estimate

ShipData = Mapping[str, Any]
HOTEL_SFOC: Final = 195.0  #: of auxiliary engines, when the ship file does not tell [g/kWh]


def hotel_power(data: ShipData) -> float:
    """The hotel load [W]; 0 when the ship file states none."""
    return 1000.0 * float(data.get("engine", {}).get("hotel_load_kw", 0.0))


def hotel_load_fuel_rate(data: ShipData) -> float:
    """Fuel rate of the hotel load [kg/s]; 0 when the ship file states none."""
    engine = data.get("engine", {})
    return hotel_power(data) * float(engine.get("hotel_sfoc_g_per_kwh", HOTEL_SFOC)) / 3.6e9


def fuel_rate_of_power(data: ShipData) -> Callable[[FloatArray], FloatArray] | None:
    """Return the fuel rate [kg/s] of a brake power [W], hotel load included.

    Parameters
    ----------
    data : mapping
        Checked data of a ship file.

    Returns
    -------
    callable or None
        None when the file gives fuel itself, which is the whole ship's, or nothing to burn by.
        A single ``engine.sfoc_g_per_kwh`` holds at every power; by ``engine.type`` or a curve
        consumption follows the load.
    """
    engine = data.get("engine", {})
    if "fuel_t_per_day" in data.get("table", {}) or "reference_t_per_day" in data.get("fuel", {}):
        return None
    if "sfoc_g_per_kwh" in engine:
        sfoc, hotel = float(engine["sfoc_g_per_kwh"]), hotel_load_fuel_rate(data)
        return lambda power: np.asarray(power * sfoc / 3.6e9 + hotel)
    if _consumption_follows_load(engine):
        from thalweg.ship.models.engine_plant import (
            build_engine_plant,  # reads the methods of engines
        )

        return build_engine_plant(data).fuel
    return None


def fuel_estimates(data: ShipData) -> tuple[Estimate, ...]:
    """What `fuel_rate_of_power` estimated."""
    if fuel_rate_of_power(data) is None or "sfoc_g_per_kwh" in data["engine"]:
        return ()
    from thalweg.ship.models.engine_plant import build_engine_plant

    return build_engine_plant(data).estimated


def _consumption_follows_load(engine: ShipData) -> bool:
    return "type" in engine or "sfoc_curve_g_per_kwh" in engine
