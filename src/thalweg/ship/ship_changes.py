"""Ships with another load, other settings, limits or prices."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import float_array, is_number, shortened_repr
from thalweg.ship.methods.engine.european_charges import EuropeanCharges
from thalweg.ship.model_protocol import AdjustableModel
from thalweg.ship.schema.ship_schema import GREATEST_APPROACH_KN, LEAST_APPROACH_KN
from thalweg.ship.ship_limits import ShipLimits


def ship_with_prices(
    ship: Any,
    usd_per_t: float | None = None,
    eca_price_factor: float | None = None,
    *,
    time_usd_per_day: float | None = None,
) -> Any:
    """Return the ship with other prices of fuel and time.

    Parameters
    ----------
    usd_per_t : float, optional
        Price of fuel outside emission control areas [USD/t], 0 or more.
    eca_price_factor : float, optional
        Price of fuel inside them over the price outside [-], above 0.
    time_usd_per_day : float, optional
        Price of time [USD/day], 0 or more.

    Returns
    -------
    Ship
        Prices that are not given stay as they are.

    Raises
    ------
    InputError
        For prices that are not possible, or in two currencies.
    """
    given = {"usd_per_t": usd_per_t, "eca_price_factor": eca_price_factor}
    terms = ship.fuel_terms.with_prices(**given, time_usd_per_day=time_usd_per_day)
    return replace(ship, terms=terms)


def ship_with_charges(ship: Any, charges: EuropeanCharges | None) -> Any:
    """Return the ship with charges of the European Union on its fuel, or without.

    Parameters
    ----------
    charges : EuropeanCharges or None
        Charges by mass of CO2 and greenhouse gases; None removes them.

    Returns
    -------
    Ship
        Its ``fuel_terms`` hold the charges: none for a ship below 5,000 GT.

    Raises
    ------
    InputError
        If its fuel has no price, or allowances are given and its CO2 is not known.
    """
    if charges is not None:
        charges = charges.for_tonnage(ship.file.hull.gross_tonnage)
    terms = ship.fuel_terms.with_charges(charges)
    pays = charges is not None and charges.voyage_share * charges.allowance_price > 0.0
    if pays and math.isnan(terms.carbon_outside):
        raise InputError(
            "Allowances of the European Union were given, but the CO2 of the fuel is unknown.",
            "They are paid per tonne of CO2, which follows from the type of the fuel.",
            "Name the fuel in the ship file, such as fuel.type: vlsfo.",
            field="fuel.type",
        )
    return replace(ship, terms=terms)


def ship_with_load_factor(ship: Any, load_factor: float) -> Any:
    """Return the ship at another load factor.

    Parameters
    ----------
    load_factor : float
        0 empty to 1 full.

    Returns
    -------
    Ship
        With the draught and displacement of that load.

    Raises
    ------
    InputError
        If the load factor is not a number from 0 to 1.
    """
    return replace(ship, loading=ship.loading.at(load_factor))


def ship_with_clearance(ship: Any, clearance: float) -> Any:
    """Return the ship with another water under the keel that she leaves when she squats.

    Parameters
    ----------
    clearance : float
        [m]

    Returns
    -------
    Ship
        The same where squat does not limit her speed (``models.squat`` of the ship file).
    """
    squat = getattr(ship.model, "squat", None)
    if squat is None:
        return ship
    return replace(ship, model=replace(ship.model, squat=replace(squat, clearance=clearance)))


def ship_with_approach_speed(ship: Any, speed_kn: float) -> Any:
    """Return the ship with another speed in the approaches of ports.

    Parameters
    ----------
    speed_kn : float
        Greatest speed over ground there [kn], 2 to 25.

    Returns
    -------
    Ship
        Otherwise unchanged.

    Raises
    ------
    InputError
        For another speed.
    """
    if not (is_number(speed_kn) and LEAST_APPROACH_KN <= speed_kn <= GREATEST_APPROACH_KN):
        raise InputError(
            f"The speed in approaches is {shortened_repr(speed_kn)} kn.",
            f"It is {LEAST_APPROACH_KN:g} to {GREATEST_APPROACH_KN:g} kn.",
            "Give the speed over ground in the fairways of the ports.",
            field="approach_speed_kn",
        )
    limits = ship.file.limits.model_copy(update={"approach_speed_kn": float(speed_kn)})
    return replace(ship, file=ship.file.model_copy(update={"limits": limits}))


def ship_with_limits(ship: Any, limits: ShipLimits) -> Any:
    """Return the ship with other limits of weather.

    Parameters
    ----------
    limits : ShipLimits
        These replace all limits that the ship has.

    Returns
    -------
    Ship
        Otherwise unchanged.
    """
    return replace(ship, limits=limits)


def ship_with_speeds(ship: Any, speeds: ArrayLike) -> Any:
    """Return the ship with other settings, given by their calm-water speeds.

    Parameters
    ----------
    speeds : array_like
        Calm-water speeds [m/s] at the load factor, above 0; sorted, each once.

    Returns
    -------
    Ship
        With these `speeds`.

    Raises
    ------
    InputError
        If a speed is not positive, is outside the ship's range, or the model has one speed.
    """
    wanted = np.unique(np.atleast_1d(float_array(speeds, "speeds")))
    if not isinstance(ship.model, AdjustableModel):
        raise InputError(
            f"The speed of {ship.name!r} follows from its model; no speed can be ordered.",
            "Only ships with an adjustable speed accept an ordered speed.",
            "Leave the ordered speed out.",
        )
    return replace(ship, model=ship.model.with_speeds(wanted, ship.loading.load_factor))
