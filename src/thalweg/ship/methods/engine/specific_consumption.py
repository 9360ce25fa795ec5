"""Engines: fuel by load, several engines on one load, hotel load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array

#: kg/(W s) in one g/kWh.
GRAM_PER_KILOWATT_HOUR: Final = 1e-3 / 3.6e6

_GHG4 = "Fourth IMO GHG Study 2020"


@dataclass(frozen=True)
class BaseSfoc:
    """Lowest specific fuel consumption of an engine by year of build [g/kWh].

    Parameters
    ----------
    before_1984, from_1984, from_2001 : g/kWh; NaN where the study gives none.
    pilot : Pilot fuel on top [g/kWh], independent of load.
    varies_with_load : False for turbines.
    verified : bool
        True where a second source repeats the numbers; else they were not compared with the source.
    source : Where they come from.
    """

    before_1984: float
    from_1984: float
    from_2001: float
    pilot: float = 0.0
    varies_with_load: bool = True
    verified: bool = False
    source: str = f"{_GHG4}, not compared with the source"


_NAEI = f"{_GHG4}; repeated in the UK inventory's ship tables (NAEI, table 11)"
_NAN = float("nan")

#: (engine, fuel kind) -> base consumption.
BASE_SFOC: Final[Mapping[tuple[str, str], BaseSfoc]] = MappingProxyType(
    {
        ("slow_speed_diesel", "residual"): BaseSfoc(205, 185, 175, verified=True, source=_NAEI),
        ("medium_speed_diesel", "residual"): BaseSfoc(215, 195, 185, verified=True, source=_NAEI),
        ("high_speed_diesel", "residual"): BaseSfoc(225, 205, 195, verified=True, source=_NAEI),
        ("slow_speed_diesel", "distillate"): BaseSfoc(190, 175, 165),
        ("medium_speed_diesel", "distillate"): BaseSfoc(200, 185, 175),
        ("high_speed_diesel", "distillate"): BaseSfoc(210, 190, 185),
        ("slow_speed_diesel", "methanol"): BaseSfoc(_NAN, _NAN, 350),
        ("medium_speed_diesel", "methanol"): BaseSfoc(_NAN, _NAN, 370),
        ("lng_otto_slow_speed", "lng"): BaseSfoc(_NAN, _NAN, 148, pilot=0.8),
        ("lng_otto_medium_speed", "lng"): BaseSfoc(_NAN, 173, 156),
        ("lng_diesel", "lng"): BaseSfoc(_NAN, _NAN, 135, pilot=6.0),
        ("gas_turbine", "residual"): BaseSfoc(305, 305, 305, varies_with_load=False),
        ("gas_turbine", "distillate"): BaseSfoc(300, 300, 300, varies_with_load=False),
        ("steam_turbine", "residual"): BaseSfoc(340, 340, 340, varies_with_load=False),
        ("steam_turbine", "distillate"): BaseSfoc(320, 320, 320, varies_with_load=False),
        ("steam_turbine", "lng"): BaseSfoc(285, 285, 285, varies_with_load=False),
        ("auxiliary", "residual"): BaseSfoc(225, 205, 195),
        ("auxiliary", "distillate"): BaseSfoc(210, 190, 185),
        ("auxiliary", "lng"): BaseSfoc(_NAN, 173, 156),
    }
)


def base_sfoc(engine: str, fuel_kind: str, *, built: int = 2010) -> tuple[float, BaseSfoc]:
    """Return the lowest specific fuel consumption of an engine and the record it comes from.

    Parameters
    ----------
    engine : ``slow_speed_diesel``, ``medium_speed_diesel``, ``high_speed_diesel``, ``lng_diesel``,
        ``lng_otto_slow_speed``, ``lng_otto_medium_speed``, ``gas_turbine``, ``steam_turbine``,
        ``auxiliary``.
    fuel_kind : ``residual``, ``distillate``, ``lng`` or ``methanol``.
    built : Year of build.

    Returns
    -------
    tuple of float and BaseSfoc
        g/kWh, and the whole record with its source and whether it was checked.

    Raises
    ------
    InputError : For an unknown engine, or a pair or year the study has no number for.
    """
    engines = {pair[0] for pair in BASE_SFOC}
    named, engine = engine, engine.casefold().replace(" ", "_").replace("-", "_")
    if engine not in engines:
        raise unknown_name_error("engine type", named, engines)
    kinds = {pair[1] for pair in BASE_SFOC if pair[0] == engine}
    if fuel_kind not in kinds:
        raise InputError(
            f"No fuel consumption is known for a {engine} on fuel of the kind {fuel_kind!r}.",
            f"The study has one for {', '.join(sorted(kinds))} fuel.",
            "Give the engine's own sfoc_g_per_kwh, or another type of engine or fuel.",
            engine=engine,
            kind=fuel_kind,
        )
    record = BASE_SFOC[engine, fuel_kind]
    value = record.from_2001
    if built < 2001:
        value = record.from_1984 if built >= 1984 else record.before_1984
    if np.isnan(value):
        raise InputError(
            f"No fuel consumption is known for a {engine} on {fuel_kind} built in {built}.",
            "The study gives one for younger engines.",
            "Give the engine's own sfoc_g_per_kwh.",
            engine=engine,
            built=built,
        )
    return float(value), record


def sfoc_load_factor(load: ArrayLike) -> FloatArray:
    """Return specific consumption over its base: 0.455 x^2 - 0.710 x + 1.280, x = P / MCR.

    Parameters
    ----------
    load : Power over maximum continuous rating [-], 0.2 to 1; also evaluated outside this range.

    Returns
    -------
    ndarray : Factor [-]; least 1.003 at a load of 0.78.

    References
    ----------
    Fourth IMO GHG Study 2020, annex B.2, eq. 10 (checked against a quotation of the text);
    only for piston engines.
    """
    x = as_float_array(load)
    return 1.280 + x * (-0.710 + 0.455 * x)


def fuel_rate(
    power: ArrayLike,
    mcr: ArrayLike,
    *,
    sfoc_g_kwh: ArrayLike,
    pilot_g_kwh: ArrayLike = 0.0,
    varies_with_load: bool = True,
) -> FloatArray:
    r"""Return the fuel one engine burns.

    .. math::
        \dot{m} = P \left[SFOC \cdot (0.455 x^2 - 0.710 x + 1.280) + SFOC_{pilot}\right],
            \quad x = P / MCR

    Parameters
    ----------
    power, mcr : Brake power and maximum continuous rating [W].
    sfoc_g_kwh : Lowest specific consumption of the engine [g/kWh].
    pilot_g_kwh : Pilot fuel on top [g/kWh].
    varies_with_load : False for turbines.

    Returns
    -------
    ndarray : Fuel [kg/s]; 0 at zero power; NaN for negative power. Overload is not limited.

    References
    ----------
    Fourth IMO GHG Study 2020, annex B.2, eq. 10.
    """
    p = as_float_array(power)
    p = np.where(p >= 0.0, p, np.nan)
    factor = sfoc_load_factor(p / as_float_array(mcr)) if varies_with_load else 1.0
    return (
        p
        * (as_float_array(sfoc_g_kwh) * factor + as_float_array(pilot_g_kwh))
        * GRAM_PER_KILOWATT_HOUR
    )


def engines_needed(
    power: ArrayLike, engine_mcr: ArrayLike, *, count: int, largest_load: float = 1.0
) -> FloatArray:
    """Return the fewest equal engines that carry a power.

    Parameters
    ----------
    power : Required power [W].
    engine_mcr : Maximum continuous rating of one engine [W].
    count : Engines installed.
    largest_load : Largest load of one engine [-].

    Returns
    -------
    ndarray : Number of engines, 0 at zero power; NaN where all of them do not suffice.
    """
    p = as_float_array(power)
    with np.errstate(invalid="ignore"):
        need = np.ceil(p / (as_float_array(engine_mcr) * largest_load) - 1e-12)
        return np.where((p >= 0.0) & (need <= count), need, np.nan)


def plant_fuel_rate(
    power: ArrayLike,
    engine_mcr: ArrayLike,
    *,
    count: int,
    sfoc_g_kwh: ArrayLike,
    largest_load: float = 1.0,
    choice: str = "least_fuel",
) -> tuple[FloatArray, FloatArray]:
    """Return the fuel of several equal engines that share a power, and how many of them run.

    Parameters
    ----------
    power : Required power [W].
    engine_mcr : Maximum continuous rating of one engine [W].
    count : Engines installed, at least 1.
    sfoc_g_kwh : Lowest specific consumption [g/kWh].
    largest_load : Largest load of one engine [-].
    choice : ``least_fuel`` or ``fewest`` engines.

    Returns
    -------
    tuple of ndarray
        Fuel [kg/s] and number of engines running; NaN where the plant cannot give the power.
    """
    if choice not in ("least_fuel", "fewest"):
        raise unknown_name_error("choice of engines", choice, ("least_fuel", "fewest"))
    fewest = engines_needed(power, engine_mcr, count=count, largest_load=largest_load)
    p, least = as_float_array(power), np.asarray(fewest)
    best = np.where(least == 0.0, 0.0, np.full(np.broadcast(p, least).shape, np.inf))
    running = np.where(least == 0.0, 0.0, np.nan)
    for n in range(1, count + 1):
        burnt = n * np.asarray(fuel_rate(p / n, engine_mcr, sfoc_g_kwh=sfoc_g_kwh))
        usable = (least == n) if choice == "fewest" else (least <= n) & (least > 0.0)
        better = usable & (burnt < best)
        best, running = np.where(better, burnt, best), np.where(better, float(n), running)
    return np.where(np.isnan(running), np.nan, best), running


def hotel_fuel_rate(power: ArrayLike, *, sfoc_g_kwh: ArrayLike) -> FloatArray:
    r"""Return the fuel of auxiliary engines at constant specific consumption.

    .. math:: \dot{m} = P \cdot SFOC

    Parameters
    ----------
    power : Electric and other power that is not propulsion [W].
    sfoc_g_kwh : Specific consumption [g/kWh].

    Returns
    -------
    ndarray : Fuel [kg/s].

    References
    ----------
    Fourth IMO GHG Study 2020, annex B.2, eq. 11: auxiliary power times base consumption.
    """
    return as_float_array(power) * as_float_array(sfoc_g_kwh) * GRAM_PER_KILOWATT_HOUR
