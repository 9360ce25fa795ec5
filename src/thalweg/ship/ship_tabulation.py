"""Tables of a ship's speed, fuel rate and power, and the fingerprint that they carry."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace

from thalweg.ship.model_protocol import Tabulation
from thalweg.ship.queries import ModelledShip
from thalweg.ship.tables.performance_table import PerformanceTable


def ship_speed_table(ship: ModelledShip, *, tolerance: float = 0.01) -> PerformanceTable:
    """Tabulate the speed through water at the ship's load factor.

    Parameters
    ----------
    tolerance : float
        Relative error that 99 % of random conditions should meet, above 0.

    Returns
    -------
    PerformanceTable
        Speed [m/s]; its ``error`` is what was measured.
    """
    load_factor = ship.loading.load_factor
    found = Tabulation(*ship.model.tabulate(load_factor, tolerance))
    return PerformanceTable(
        found.parts,
        ship.model.speeds(load_factor),
        ship_fingerprint(ship),
        found.error,
        found.curve,
        ship.limits.safety,
    )


def ship_fuel_table(ship: ModelledShip, *, tolerance: float = 0.01) -> PerformanceTable:
    """Tabulate the fuel rate at the ship's load factor, hotel load included.

    Parameters
    ----------
    tolerance : float
        Relative error that 99 % of random conditions should meet, above 0.

    Returns
    -------
    PerformanceTable
        Fuel rate [kg/s]: a constant per setting where a setting burns the same in all weather.

    Raises
    ------
    InputError
        If the ship's fuel is unknown, or its speed is a field, which has no settings.
    """
    from thalweg.ship.models.tabulate_fuel import fuel_table

    found = fuel_table(ship.model, ship.loading.load_factor, tolerance, ship=ship.name)
    return replace(found, fingerprint=ship_fingerprint(ship))


def ship_power_table(ship: ModelledShip, *, tolerance: float = 0.01) -> PerformanceTable:
    """Tabulate the brake power and the hotel load together, at the ship's load factor.

    Parameters
    ----------
    tolerance : float
        Relative error that 99 % of random conditions should meet, above 0.

    Returns
    -------
    PerformanceTable
        Power [W].

    Raises
    ------
    InputError
        If the ship's brake power is unknown, or its speed is a field.
    """
    from thalweg.ship.models.tabulate_fuel import power_table

    found = power_table(
        ship.model,
        ship.loading.load_factor,
        tolerance,
        hotel_power=ship.hotel_power,
        ship=ship.name,
    )
    return replace(found, fingerprint=ship_fingerprint(ship))


def ship_fingerprint(ship: ModelledShip) -> str:
    """Return a text that is equal for two ships only if they have the same performance.

    Returns
    -------
    str
        16 hexadecimal digits: a hash of the model, the loading and the limits.
    """
    facts = {
        "model": ship.model.identity,
        "loading": repr(ship.loading),
        "limits": repr(ship.limits),
    }
    text = json.dumps(facts, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]
