"""Marine fuels: carbon factor, heat, price, and switching at the border of a control area."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.units import TONNE
from thalweg.ship.methods.array_conversion import Floats, as_float_array


@dataclass(frozen=True)
class Fuel:
    """A marine fuel.

    Parameters
    ----------
    name : str
        Short name.
    label : str
        Name and grade as the resolution writes them.
    carbon_factor : float
        CO2 per fuel [t/t].
    heating_value : float
        Lower heating value [J/kg].
    kind : str
        ``residual``, ``distillate``, ``lng``, ``methanol`` or ``other``, as the engine tables use.
    verified : bool
        True where the carbon factor was checked beyond memory.
    source : str
        What it was checked against.
    """

    name: str
    label: str
    carbon_factor: float
    heating_value: float
    kind: str
    verified: bool
    source: str


_684 = (
    "MEPC.1/Circ.684 appendix, read as published text (3.206000, 3.151040, 3.114400, 3.000000, "
    "3.030000, 2.750000); MEPC.364(79) 2.2.1 as transcribed by two independent open calculators"
)
_364 = (
    "MEPC.364(79) 2.2.1 as transcribed alike by at least four open projects, and the carbon of the "
    "molecule within 0.2 %; the resolution itself was not seen"
)

#: Short name -> fuel.
FUELS: Final[Mapping[str, Fuel]] = MappingProxyType(
    {
        fuel.name: fuel
        for fuel in (
            Fuel(
                "mgo",
                "Diesel/gas oil, ISO 8217 DMX to DMB",
                3.206,
                42.7e6,
                "distillate",
                True,
                _684,
            ),
            Fuel(
                "lfo", "Light fuel oil, ISO 8217 RMA to RMD", 3.151, 41.2e6, "residual", True, _684
            ),
            Fuel(
                "hfo", "Heavy fuel oil, ISO 8217 RME to RMK", 3.114, 40.2e6, "residual", True, _684
            ),
            Fuel("lpg_propane", "LPG (propane)", 3.000, 46.3e6, "other", True, _684),
            Fuel("lpg_butane", "LPG (butane)", 3.030, 45.7e6, "other", True, _684),
            Fuel("ethane", "Ethane", 2.927, 46.4e6, "other", True, _364),
            Fuel("lng", "Liquefied natural gas", 2.750, 48.0e6, "lng", True, _684),
            Fuel("methanol", "Methanol", 1.375, 19.9e6, "methanol", True, _364),
            Fuel("ethanol", "Ethanol", 1.913, 26.8e6, "other", True, _364),
        )
    }
)

#: Other names -> short name. VLSFO is sold in residual grades; by its grade it may be ``lfo``.
FUEL_ALIASES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "mdo": "mgo",
        "diesel": "mgo",
        "vlsfo": "hfo",
        "ulsfo": "lfo",
        "ifo380": "hfo",
        "lpg": "lpg_propane",
    }
)


def fuel_named(name: str) -> Fuel:
    """Return a fuel by its name, ignoring case.

    Parameters
    ----------
    name : str
        A key of `FUELS` or `FUEL_ALIASES`.

    Returns
    -------
    Fuel
        The fuel.

    Raises
    ------
    InputError
        For an unknown name, with near matches.
    """
    key = name.casefold().replace(" ", "_").replace("-", "_")
    key = FUEL_ALIASES.get(key, key)
    if key not in FUELS:
        raise unknown_name_error("fuel", name, [*FUELS, *FUEL_ALIASES])
    return FUELS[key]


def co2_mass(fuel_mass: ArrayLike, *, carbon_factor: ArrayLike) -> Floats:
    """Return the CO2 of a fuel mass: mass times carbon factor, in the unit of the mass.

    Parameters
    ----------
    fuel_mass : array_like
        Fuel, or fuel per time.
    carbon_factor : array_like
        t CO2 per t fuel.

    Returns
    -------
    ndarray
        CO2.

    References
    ----------
    MEPC.364(79), section 2.2.1.
    """
    return as_float_array(fuel_mass) * as_float_array(carbon_factor)


def equal_energy_mass(fuel_mass: ArrayLike, *, of: Fuel, to: Fuel) -> Floats:
    """Return the mass of another fuel with the same lower heating value.

    Parameters
    ----------
    fuel_mass : array_like
        Mass of ``of``.
    of, to : Fuel
        The fuels.

    Returns
    -------
    ndarray
        Mass of ``to``, in the unit of ``fuel_mass``.
    """
    return as_float_array(fuel_mass) * of.heating_value / to.heating_value


def fuel_cost(fuel_mass: ArrayLike, *, price_t: ArrayLike) -> Floats:
    """Return what a fuel mass [kg] costs at a price per tonne, in the currency of the price.

    Parameters
    ----------
    fuel_mass : array_like
        Fuel [kg].
    price_t : array_like
        Price [currency/t].

    Returns
    -------
    ndarray
        Cost.
    """
    return as_float_array(fuel_mass) / TONNE * as_float_array(price_t)


@dataclass(frozen=True)
class SwitchedFuel:
    """What a ship burns along a route that enters emission control areas.

    Parameters
    ----------
    mass : ndarray
        Fuel burnt [kg], after the change of heating value.
    co2 : ndarray
        CO2 [kg].
    cost : ndarray
        Cost [currency]; NaN where no price was given.
    """

    mass: Floats
    co2: Floats
    cost: Floats


def switch_in_control_area(
    fuel_mass: ArrayLike,
    share_inside: ArrayLike,
    *,
    outside: Fuel,
    inside: Fuel,
    price_outside_t: float = float("nan"),
    price_inside_t: float = float("nan"),
) -> SwitchedFuel:
    """Return mass, CO2 and cost when another fuel is burnt inside emission control areas.

    Parameters
    ----------
    fuel_mass : array_like
        Fuel per leg [kg], as if ``outside`` were burnt everywhere.
    share_inside : array_like
        Share of the leg inside the area, 0 to 1 (or booleans).
    outside, inside : Fuel
        The fuels. Inside, the mass is changed so that the heat stays the same.
    price_outside_t, price_inside_t : float
        Prices [currency/t].

    Returns
    -------
    SwitchedFuel
        Per leg.

    Raises
    ------
    InputError
        When a share lies outside 0 to 1.

    Notes
    -----
    Seuren (2020) gives one factor for fuel cost inside control areas, 1.5593 (Table 5.2); that is
    ``price_inside_t / price_outside_t`` here with one fuel and no change of heating value.
    """
    share = as_float_array(share_inside)
    if np.any((share < 0.0) | (share > 1.0)):
        raise InputError(
            "The share of a leg inside a control area lies outside 0 to 1.",
            f"It runs from {np.nanmin(share):g} to {np.nanmax(share):g}.",
            "Give lengths inside the area divided by leg lengths.",
        )
    mass_out = as_float_array(fuel_mass) * (1.0 - share)
    mass_in = np.asarray(equal_energy_mass(np.asarray(fuel_mass) * share, of=outside, to=inside))
    cost = np.where(mass_out > 0, mass_out * price_outside_t, 0.0 * mass_out)
    cost = (cost + np.where(mass_in > 0, mass_in * price_inside_t, 0.0 * mass_in)) / TONNE
    return SwitchedFuel(
        mass=mass_out + mass_in,
        co2=mass_out * outside.carbon_factor + mass_in * inside.carbon_factor,
        cost=cost,
    )


def halem_cost(
    time: ArrayLike,
    speed: ArrayLike,
    *,
    per_second: float = 700_000.0 / 604_800.0,
    per_cube: float = 0.008,
) -> Floats:
    """Return van Halem's cost of sailing: time cost plus fuel with the cube of speed.

    Parameters
    ----------
    time : array_like
        [s].
    speed : array_like
        Speed the ship would make through deep water [m/s].
    per_second : float
        Cost of time [currency/s]; 700 000 a week.
    per_cube : float
        Cost of fuel [currency s2/m3].

    Returns
    -------
    ndarray
        per_second t + per_cube t V^3 [currency].

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), eq. 3.4 (the text
    points to 3.5).
    """
    t = as_float_array(time)
    return per_second * t + per_cube * t * as_float_array(speed) ** 3


def halem_cheapest_speed(
    *, per_second: float = 700_000.0 / 604_800.0, per_cube: float = 0.008
) -> float:
    """Return the cheapest speed per distance in still water for `halem_cost` [m/s].

    Parameters
    ----------
    per_second, per_cube : float
        As in `halem_cost`.

    Returns
    -------
    float
        (per_second / (2 per_cube))^(1/3), where d/dV of cost per distance is zero.
    """
    return float((per_second / (2.0 * per_cube)) ** (1.0 / 3.0))
