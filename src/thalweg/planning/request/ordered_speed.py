"""The ordered speed of a voyage: a setting of the ship, or a speed between its settings."""

from __future__ import annotations

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.planning.voyage import Voyage
from thalweg.ship import Ship
from thalweg.ship.held_speed import with_held_power, with_held_speed

_MOST_SPEEDS = 40
_SAME_SPEED_KN = 1e-6  #: an ordered speed this near to a setting is that setting


def with_ordered_speed(ship: Ship, speed_kn: float | None) -> Ship:
    """Return a ship that has a setting for an ordered speed.

    Parameters
    ----------
    speed_kn : Ordered speed through calm water [kn].

    Returns
    -------
    Ship : The ship itself where it has the setting or no speed is ordered; otherwise with this
        speed alone, by its own law of power and fuel.

    Raises
    ------
    InputError : If the ship does not reach the speed, or no speed can be ordered.
    """
    if speed_kn is None or _misses(ship, speed_kn).min() <= _SAME_SPEED_KN:
        return ship
    top = ship.greatest_order() / KNOT
    if not ship.is_resistance_based and speed_kn > top:
        listed = ", ".join(f"{speed / KNOT:.1f}" for speed in ship.speeds)
        raise InputError(
            f"The ship {ship.name!r} has no setting for {speed_kn:g} kn.",
            f"Its speeds are {listed} kn, and its power is not known above the highest.",
            f"Order at most {top:.1f} kn.",
            field="speed_kn",
        )
    return ship.with_speeds([speed_kn * KNOT])


def with_exact_speed(ship: Ship, speed_kn: float, hold: str | None) -> Ship:
    """Return a ship with one setting: a speed, and what the engine holds at it.

    Parameters
    ----------
    speed_kn : Speed through calm water [kn].
    hold : {"speed", "power", "ground"} or None
        None: as the ship file orders. ``"ground"`` orders as that, too.

    Returns
    -------
    Ship : With this speed as its only setting.

    Raises
    ------
    InputError : If the ship does not reach the speed, or cannot hold it.
    """
    if hold == "speed":
        return with_held_speed(ship, speed_kn)
    if hold == "power":
        return with_held_power(ship, speed_kn)
    return ship.with_speeds([speed_kn * KNOT])


def with_order(ship: Ship, voyage: Voyage) -> Ship:
    """Return a ship that can sail at the ordered speeds of a voyage, held as it asks.

    Parameters
    ----------
    voyage : Its `speed_kn` and `hold` count, and `speed_step_kn` where speeds are chosen.

    Raises
    ------
    InputError : If the ship does not reach the speed, or cannot hold it.
    """
    if voyage.speed_step_kn is not None:
        if voyage.speed_kn is not None:
            raise InputError(
                f"One speed is ordered ({voyage.speed_kn:g} kn), and a step of speeds is given.",
                "A step makes speeds for plans that choose among several.",
                "Give one of them.",
                field="speed_step_kn",
            )
        return with_speeds_between(ship, voyage.speed_step_kn)
    if voyage.hold is None or voyage.speed_kn is None:
        return with_ordered_speed(ship, voyage.speed_kn)
    return with_exact_speed(ship, voyage.speed_kn, voyage.hold)


def with_speeds_between(ship: Ship, step_kn: float) -> Ship:
    """Return a ship that may also order speeds between its settings.

    Parameters
    ----------
    step_kn : No speed is farther from the next than this [kn].

    Raises
    ------
    InputError : If no speed can be ordered, or more than 40 speeds are asked for.
    """
    speeds = np.asarray(ship.speeds, float)
    parts = np.maximum(np.ceil(np.diff(speeds) / (step_kn * KNOT) - 1e-6), 1.0).astype(int)
    if parts.sum() + 1 > _MOST_SPEEDS:
        raise InputError(
            f"A step of {step_kn:g} kn makes {parts.sum() + 1} speeds of those of {ship.name!r}.",
            f"Plans choose among at most {_MOST_SPEEDS} speeds.",
            "Give a larger step.",
            field="speed_step_kn",
        )
    if (parts == 1).all():
        return ship
    between = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(speeds, speeds[1:], parts)]
    return ship.with_speeds(np.concatenate([*between, speeds[-1:]]))


def ordered_setting(ship: Ship, speed_kn: float | None) -> int:
    """Return the index of the setting for an ordered speed [kn]; the highest where none is."""
    if speed_kn is None:
        return len(ship.speeds) - 1
    return int(np.argmin(_misses(ship, speed_kn)))


def _misses(ship: Ship, speed_kn: float) -> np.ndarray:
    """Return how far the settings are from a speed [kn]."""
    return np.asarray(np.abs(np.asarray(ship.speeds) / KNOT - speed_kn))
