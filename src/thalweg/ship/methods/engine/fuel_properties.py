"""Marine fuels: carbon factor, heat, price, and switching at the border of a control area."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from numpy.typing import ArrayLike

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array


@dataclass(frozen=True)
class Fuel:
    """A marine fuel.

    Parameters
    ----------
    name : Short name.
    label : Name and grade as the resolution writes them.
    carbon_factor : CO2 per fuel [t/t].
    heating_value : Lower heating value [J/kg].
    kind : str
        ``residual``, ``distillate``, ``lng``, ``methanol`` or ``other``, as the engine tables use.
    verified : True where the carbon factor was compared with ``source``.
    source : What it was checked against.
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
    "MEPC.364(79) 2.2.1 as transcribed by at least four open projects, and the carbon of the "
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
    name : A key of `FUELS` or `FUEL_ALIASES`.

    Raises
    ------
    InputError : For an unknown name, with near matches.
    """
    key = name.casefold().replace(" ", "_").replace("-", "_")
    key = FUEL_ALIASES.get(key, key)
    if key not in FUELS:
        raise unknown_name_error("fuel", name, [*FUELS, *FUEL_ALIASES])
    return FUELS[key]


def co2_mass(fuel_mass: ArrayLike, *, carbon_factor: ArrayLike) -> FloatArray:
    """Return the CO2 of a fuel mass: mass times carbon factor, in the unit of the mass.

    .. math:: m_{CO_2} = C_F m_{fuel}

    Parameters
    ----------
    fuel_mass : Fuel, or fuel per time.
    carbon_factor : t CO2 per t fuel.

    Returns
    -------
    ndarray : CO2.

    References
    ----------
    MEPC.364(79), section 2.2.1.
    """
    return as_float_array(fuel_mass) * as_float_array(carbon_factor)


def equal_energy_mass(fuel_mass: ArrayLike, *, of: Fuel, to: Fuel) -> FloatArray:
    """Return the mass of another fuel with the same lower heating value.

    Parameters
    ----------
    fuel_mass : Mass of ``of``.

    Returns
    -------
    ndarray : Mass of ``to``, in the unit of ``fuel_mass``.
    """
    return as_float_array(fuel_mass) * of.heating_value / to.heating_value


def halem_cost(
    time: ArrayLike,
    speed: ArrayLike,
    *,
    per_second: float = 700_000.0 / 604_800.0,
    per_cube: float = 0.008,
) -> FloatArray:
    """Return van Halem's cost of sailing: C = lambda_t t + lambda_f t V^3 [currency].

    Parameters
    ----------
    time : array_like [s]
    speed : Speed the ship would make through deep water [m/s].
    per_second : Cost of time lambda_t [currency/s]; 700 000 a week.
    per_cube : Cost of fuel lambda_f [currency s2/m3].

    Returns
    -------
    ndarray : Cost [currency].

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), eq. 3.4 (the text
    points to 3.5).
    """
    t = as_float_array(time)
    return per_second * t + per_cube * t * as_float_array(speed) ** 3
