"""Fuel of a ship with known speeds that gives its power and how much its engines burn for it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.schema.ship_schema import EngineSection, ShipFile


def fuel_rate_of_power(file: ShipFile) -> Callable[[FloatArray], FloatArray] | None:
    """Return the fuel rate [kg/s] of a brake power [W], hotel load included.

    Returns
    -------
    callable or None : None when the file gives fuel itself, which is the whole ship's, or nothing
        to burn by. A single ``engine.sfoc_g_per_kwh`` holds at every power; by ``engine.type`` or a
        curve consumption follows the load.
    """
    engine = file.engine
    in_table = file.table is not None and file.table.fuel_t_per_day is not None
    if in_table or file.fuel.reference_t_per_day is not None:
        return None
    if engine.sfoc_g_per_kwh is not None:
        sfoc, hotel = engine.sfoc_g_per_kwh, engine.hotel_fuel_rate
        return lambda power: np.asarray(power * sfoc / 3.6e9 + hotel)
    if _consumption_follows_load(engine):
        from thalweg.ship.models.engine_plant import (
            build_engine_plant,  # reads the methods of engines
        )

        return build_engine_plant(file).fuel
    return None


def fuel_estimates(file: ShipFile) -> tuple[Estimate, ...]:
    """Return what `fuel_rate_of_power` estimated."""
    if fuel_rate_of_power(file) is None or file.engine.sfoc_g_per_kwh is not None:
        return ()
    from thalweg.ship.models.engine_plant import build_engine_plant

    return build_engine_plant(file).estimated


def _consumption_follows_load(engine: EngineSection) -> bool:
    return engine.gives("type", "sfoc_curve_g_per_kwh")
