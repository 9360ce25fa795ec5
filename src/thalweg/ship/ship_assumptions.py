"""Assumptions about a ship that every result must state."""

from __future__ import annotations

from thalweg.ship.hull.estimate import method_assumptions
from thalweg.ship.schema.unusual_numbers import unusual_numbers
from thalweg.ship.ship import Ship

_KEYS_OF_THE_EMPTY_SHIP = (
    "draught_empty_m",
    "speeds_empty_kn",
    "displacement_empty_m3",
    "weight_empty_t",
)


def stated_assumptions(ship: Ship) -> list[str]:
    """Return what results of a ship must state: unusual numbers, assumed methods and others.

    Returns
    -------
    list of str : Sentences; empty for most ships.
    """
    idle = [f"{text[0].upper()}{text[1:]}." for text in load_factor_without_effect(ship)]
    charges = ship.fuel_terms.charges
    found = charges is not None and charges.share_source != "given"
    european = [f"Charges of the European Union: {charges.share_source}."] if found else []  # type: ignore[union-attr]
    unusual = unusual_numbers(ship.file)
    return [*unusual, *method_assumptions(ship.estimated), *idle, *european]


def load_factor_without_effect(ship: Ship) -> list[str]:
    """Report a load factor below 1 that has no effect, since the ship has one loading.

    Returns
    -------
    list of str : One text, or none.
    """
    own = ship.loading
    described = ship.file.loading.gives(*_KEYS_OF_THE_EMPTY_SHIP)
    if own.load_factor == 1.0 or described or "load_factor" in ship.reads:
        return []
    if ship.file.is_empty and not own.same_full_and_empty:
        return []
    return [
        f"load factor {own.load_factor:g} has no effect: "
        "the ship file does not describe the empty ship"
    ]
