"""Assumptions about a ship that every result must state."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.units import KNOT
from thalweg.ship.conditions import Conditions
from thalweg.ship.hull.estimate import method_assumptions
from thalweg.ship.methods.speed_loss import ShipType
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss
from thalweg.ship.schema.unusual_numbers import unusual_numbers
from thalweg.ship.ship import Ship

KWON_FORM: Final = "Kwon's form"  #: a note on the form of his speed loss begins so
NO_DEPTH: Final = "No depth in the data"  #: a note on clearance that is not checked begins so
BELOW_LOWEST: Final = "Below the lowest speed of the ship file"  #: a note on such speeds begins so
_FINE_SHIPS: Final = (
    *("ro-ro", "roro", "ropax", "ferry", "passenger", "cruise", "vehicle", "car carrier"),
    *("refrigerated", "reefer"),
)
_FULL_SHIPS: Final = ("bulk", "tanker")
_SAME_SPEED: Final = 1e-3  # relative
_BEAUFORT_5: Final = 9.35  # [m/s]
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
    european = _notes_on_charges(ship)
    unusual = [*unusual_numbers(ship.file), *kwon_form_notes(ship)]
    return [*unusual, *method_assumptions(ship.estimated), *idle, *european]


def _notes_on_charges(ship: Ship) -> list[str]:
    """Return where the share of charges of the European Union comes from, and a missing tonnage."""
    charges = ship.fuel_terms.charges
    if charges is None:
        return []
    notes = []
    if charges.share_source != "given":
        notes.append(f"Charges of the European Union: {charges.share_source}.")
    if charges.voyage_share > 0.0 and ship.file.hull.gross_tonnage is None:
        notes.append(
            "Charges of the European Union are counted as for a ship of 5,000 GT or more: smaller "
            "ships pay none. Give hull.gross_tonnage."
        )
    return notes


def unchecked_depth_note(ship: Ship) -> str:
    """Return what a result without any depth in the data states about the under-keel clearance."""
    required = ship.min_under_keel_clearance
    wanted = f" The ship file requires {required:g} m: give a depth file (--depth)."
    return f"{NO_DEPTH}: under-keel clearance was not checked.{wanted if required else ''}"


def kwon_form_notes(ship: Ship) -> list[str]:
    """Return a note where the form of Kwon's speed loss does not fit the type of the ship.

    Returns
    -------
    list of str : One text with the loss of both forms, or none.
    """
    loss, kind = getattr(ship.model, "loss", None), (ship.file.hull.type or "").casefold()
    if not isinstance(loss, KwonSpeedLoss):
        return []
    fine = any(word in kind for word in _FINE_SHIPS)
    full = any(word in kind for word in _FULL_SHIPS)
    fits = not full if loss.ship_type == "container" else not fine
    if fits or (fine and ship.file.models.gives("kwon_ship_type")):
        return []
    forms: tuple[ShipType, ...] = ("other", "container")
    shares = {}
    for form in forms:
        own = replace(loss, ship_type=form)
        ahead = Conditions(
            wind_speed=_BEAUFORT_5, wind_angle=0.0, load_factor=ship.loading.load_factor
        )
        shares[form] = float(own.share(ahead, np.asarray(np.max(ship.speeds))))
    other, container = (100.0 * shares[form] for form in forms)
    return [
        f"{KWON_FORM} {loss.ship_type!r} is used for a {kind}: in Beaufort 5 from ahead her "
        f"highest speed falls by {other:.0f} % by the form 'other' (full ships) and "
        f"{container:.0f} % by 'container' (fine ships). Give the one that suits her as "
        "models.kwon_ship_type."
    ]


def low_speed_notes(ship: Ship, ordered: float) -> list[str]:
    """Return a note where an ordered speed is below all speeds of the ship file.

    Parameters
    ----------
    ship : Also with settings other than those of its file.
    ordered : The lowest ordered speed [m/s].

    Returns
    -------
    list of str : One text that says what power and fuel follow there, or none.
    """
    file, load_factor = ship.file, ship.loading.load_factor
    table = None if file.table is None else file.table.speed_kn
    loaded, empty = file.loading.speeds_full_kn, file.loading.speeds_empty_kn
    known = [min(speeds) for speeds in (file.speeds_kn, table, loaded) if speeds]
    if not known:
        return []
    lowest = min(known)
    if loaded and empty:
        lowest = load_factor * min(loaded) + (1.0 - load_factor) * min(empty)
    if not ordered < lowest * KNOT * (1.0 - _SAME_SPEED):
        return []
    return [
        f"{BELOW_LOWEST}, {lowest:g} kn: {ordered / KNOT:.2f} kn is ordered." + _slow_power(ship)
    ]


def _slow_power(ship: Ship) -> str:
    """Return a sentence on what power and fuel follow below the speeds of a ship file."""
    engine, model = ship.file.engine, getattr(ship.model, "base", ship.model)  # of a held speed
    law, plant = getattr(model, "law", None), getattr(model, "plant", None)
    if getattr(law, "name", None) == "none":
        return ""
    by_load = engine.sfoc_g_per_kwh is None and engine.gives("type", "sfoc_curve_g_per_kwh")
    if plant is not None:
        by_load = bool(plant.curve[0]) or bool(np.isfinite(plant.rating))
    by_law = law is not None or ship.file.models.calm_water == "cubic"
    power = "is extrapolated by the cubic law" if by_law else "follows from the resistance"
    fuel = (
        "the consumption follows the engine load"
        if by_load
        else "the higher consumption of engines at low load is not counted"
    )
    return f" Power there {power}; {fuel}."


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
