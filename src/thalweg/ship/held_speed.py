"""A ship that holds a speed through water, instead of the power of a setting."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.ship.models.engine_plant import EngineOrders
from thalweg.ship.models.held_speed_model import HeldSpeedModel
from thalweg.ship.models.known_speed_model import KnownSpeedModel
from thalweg.ship.models.resistance_model import ResistanceModel
from thalweg.ship.ship import Ship


def with_held_speed(ship: Ship, speed_kn: float) -> Ship:
    """Return a ship that holds a speed through water as long as its power allows.

    Parameters
    ----------
    ship : With a resistance, or with known speeds and a law of power or fuel over speed.
    speed_kn : [kn].

    Returns
    -------
    Ship : With this speed as its only setting.

    Raises
    ------
    InputError : If the ship does not reach the speed, or its power at other speeds is not known.
    """
    model, load_factor = ship.model, ship.loading.load_factor
    speed = np.array([speed_kn * KNOT])
    if isinstance(model, ResistanceModel):
        model.with_speeds(speed, load_factor)  # refuses speeds beyond the engines
        orders = EngineOrders("speed", (float(speed[0]),))
        return replace(ship, model=replace(model, orders=orders, _kept={}))
    if isinstance(model, HeldSpeedModel):
        return replace(ship, model=model.with_speeds(speed, load_factor))
    if isinstance(model, KnownSpeedModel) and model.law.name != "none":
        top = float(model.speeds(load_factor)[-1])
        if speed[0] <= top * (1.0 + 1e-9):
            return replace(ship, model=HeldSpeedModel.of(model, speed, load_factor))
        raise InputError(
            f"The ship {ship.name!r} cannot hold {speed_kn:g} kn.",
            f"Its highest calm-water speed is {top / KNOT:.1f} kn.",
            "Order a lower speed.",
            field="speed_kn",
        )
    raise InputError(
        f"The ship {ship.name!r} cannot hold a speed.",
        "Its power at other speeds in weather is not known: that takes a resistance, or a table or "
        "cubic law over known speeds.",
        "Order its settings (--hold power), or add one of these to the ship file.",
        field="hold",
    )


def with_held_power(ship: Ship, speed_kn: float) -> Ship:
    """Return a ship that holds the power that makes a speed in calm water.

    Parameters
    ----------
    speed_kn : Calm-water speed [kn].

    Returns
    -------
    Ship : With this as its only setting.

    Raises
    ------
    InputError : If the ship does not reach the speed.
    """
    model, load_factor = ship.model, ship.loading.load_factor
    if not isinstance(model, ResistanceModel):
        return ship.with_speeds([speed_kn * KNOT])  # its settings are powers
    ordered = replace(model, orders=replace(model.orders, kind="power"), _kept={})
    speed = np.array([speed_kn * KNOT])
    return replace(ship, model=ordered.with_speeds(speed, load_factor))
