"""What the voyages of a study come to in a year: fuel, emissions, carbon intensity, cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import parse_position
from thalweg.core.given_numbers import finite_or_none, is_number
from thalweg.ship import Ship
from thalweg.ship.methods.carbon_intensity import REDUCTION_PERCENT
from thalweg.ship.methods.engine.european_charges import (
    LEAST_GROSS_TONNAGE,
    WELL_TO_WAKE,
    ets_phase_in,
    fueleu_penalty,
    other_greenhouse_gases,
    voyage_share_between,
)
from thalweg.ship.performance_sheet import carbon_intensity_of

if TYPE_CHECKING:
    import pandas as pd

#: Entries of ``annual`` and their ranges.
ANNUAL_ENTRIES: Final = {
    "port_h": (0.0, 8760.0),
    "year": (min(REDUCTION_PERCENT), max(REDUCTION_PERCENT)),
    "allowance_price": (0.0, 1e4),
    "euro_price": (0.0, 1e3),
    "eu_share": (0.0, 100.0),
}
_HOURS: Final = 8760.0


def checked_annual(given: Any) -> dict[str, float]:
    """Return the entry ``annual`` of a study, checked.

    Parameters
    ----------
    given : mapping
        ``port_h``: time in port after each voyage [h]; ``year`` of the carbon intensity rating and
        of the charges; ``allowance_price`` of a tonne of CO2 and ``euro_price`` in the currency of
        the costs; ``eu_share``, 0, 50 or 100 % of each voyage, by default that of its ports.

    Raises
    ------
    InputError
        For other entries, or values out of range.
    """
    if not isinstance(given, Mapping) or set(given) - set(ANNUAL_ENTRIES):
        raise InputError(
            f"annual is {given!r}.",
            f"It may have {', '.join(ANNUAL_ENTRIES)}.",
            "Correct it, for example {port_h: 48, year: 2026}.",
            field="annual",
        )
    for name, value in given.items():
        low, high = ANNUAL_ENTRIES[name]
        if not is_number(value) or not low <= value <= high:
            raise InputError(
                f"{name} of annual is {value!r}.",
                f"It is a number from {low:g} to {high:g}.",
                "Correct it.",
                field="annual",
            )
    if given.get("eu_share", 0) not in (0, 50, 100):
        raise InputError(
            f"eu_share of annual is {given['eu_share']!r}.",
            "It is 100 between ports of the European Union, 50 to or from one, else 0.",
            "Correct it, or leave it out where both ends of the voyages are ports.",
            field="annual",
        )
    return {"port_h": 0.0, "year": 2026, **given}


def annual_figures(
    rows: pd.DataFrame, by: list[str], ships: Mapping[Any, Ship], annual: Mapping[str, float]
) -> pd.DataFrame:
    """Return the figures of a year of the same voyage, for each group of a study.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `study_rows`, those with a usable route.
    by : list of str
        Axes that tell groups apart.
    ships : mapping of str to Ship
        By the value of the axis ``ship``; under None if all voyages have the same.
    annual : mapping
        Of `checked_annual`.

    Returns
    -------
    pandas.DataFrame
        The axes; ``voyages_per_year`` (8760 h over the mean passage and the time in port);
        ``distance_nm``, ``fuel_t``, ``co2_t`` and ``cost_...`` of the year; ``cii`` (attained
        [g/(t nm)] or [g/(GT nm)]), ``cii_required`` and ``cii_rating``, None where the ship file
        has no capacity or another type; ``eu_ets_cost`` and ``fueleu_penalty`` by
        `european_charges_of_year`, None where a price, the share or the fuel is not known. All
        are None for ships below `LEAST_GROSS_TONNAGE`. ``charges_in_cost`` is true where the
        prices of the voyages include these charges (entry ``charges``). Time and emissions in port
        are not counted.
    """
    found = []
    for key, group in rows.groupby(by, dropna=False) if by else [((), rows)]:
        mean = group.select_dtypes("number").mean()
        if not mean.get("time_h", 0.0) > 0.0:
            continue
        keys = dict(zip(by, key if isinstance(key, tuple) else (key,)))
        trips = _HOURS / (mean["time_h"] + annual["port_h"])
        costs = [name for name in mean.index if str(name).startswith("cost_")]
        row: dict[str, Any] = {**keys, "voyages_per_year": trips}
        for name in ("distance_nm", "fuel_t", "co2_t", *costs):
            row[name] = trips * mean[name] if name in mean and np.isfinite(mean[name]) else None
        ship = ships.get(keys.get("ship"), ships.get(None))
        rating = None
        rated = ship is not None and not is_below_tonnage(ship)
        if ship is not None and rated and row["co2_t"] is not None and row["distance_nm"]:
            grams = row["co2_t"] * 1000.0 / row["distance_nm"]  # kg of CO2 per nm
            rating = carbon_intensity_of(ship, grams, year=int(annual["year"]))
        row |= {
            "cii": rating and rating["attained"],
            "cii_required": rating and rating["required"],
            "cii_rating": rating and rating["rating"],
        }
        if "charged" in group and group["charged"].any():
            row["charges_in_cost"] = True
        found.append(row | european_charges_of_year(group, trips, ship, annual))
    import pandas as pd

    return pd.DataFrame(found)


def is_below_tonnage(ship: Ship | None) -> bool:
    """Return whether the gross tonnage of a ship is known and below `LEAST_GROSS_TONNAGE`."""
    tonnage = None if ship is None else ship.file.hull.gross_tonnage
    return tonnage is not None and tonnage < LEAST_GROSS_TONNAGE


def european_charges_of_year(
    group: pd.DataFrame, trips: float, ship: Ship | None, annual: Mapping[str, float]
) -> dict[str, float | None]:
    """Return the cost of emission allowances and the FuelEU penalty of a year.

    Directive 2003/87/EC, articles 3ga and 3gb: CO2, from 2026 with methane and nitrous oxide, times
    the share of the voyage in scope, the phase-in of the year and the price of an allowance.
    Regulation (EU) 2023/1805, annex IV, part B: the penalty of the fuels inside and outside
    emission control areas. Fuel in port is not counted.

    Parameters
    ----------
    group : pandas.DataFrame
        Rows of a study, with ``eu_share`` [fraction], NaN where it is not known.
    trips : float
        Voyages per year.
    ship : Ship, optional
        Her fuels are those burnt.
    annual : mapping
        Of `checked_annual`.

    Returns
    -------
    dict
        ``eu_ets_cost`` and ``fueleu_penalty`` [currency of the prices], None where not known.
    """
    none: dict[str, float | None] = {"eu_ets_cost": None, "fueleu_penalty": None}
    year, share = int(annual["year"]), group.get("eu_share")
    if share is None or share.isna().any() or is_below_tonnage(ship):
        return none
    if "allowance_price" in annual and "co2_t" in group:
        phase = ets_phase_in(year) * annual["allowance_price"]
        gases = group["co2_t"] + _other_gases(group, ship, year)
        none["eu_ets_cost"] = finite_or_none(trips * phase * float((share * gases).mean()))
    if "euro_price" in annual and ship is not None and "fuel_eca_t" in group:
        terms = ship.fuel_terms
        outside = (share * (group["fuel_t"] - group["fuel_eca_t"])).mean()
        burnt = (terms.outside, outside), (terms.inside, (share * group["fuel_eca_t"]).mean())
        parts = [
            _penalty(fuel.name if fuel else "", float(tonnes), year)
            for fuel, tonnes in burnt
            if tonnes != 0.0
        ]
        none["fueleu_penalty"] = finite_or_none(trips * annual["euro_price"] * sum(parts))
    return none


def _other_gases(group: pd.DataFrame, ship: Ship | None, year: int) -> Any:
    """Return the methane and nitrous oxide of rows that need allowances [t of CO2 equivalent]."""
    if ship is None or "fuel_t" not in group:
        return 0.0
    terms = ship.fuel_terms
    inside = group["fuel_eca_t"].fillna(0.0) if "fuel_eca_t" in group else 0.0 * group["fuel_t"]
    outside, in_areas = (
        other_greenhouse_gases(fuel.name if fuel else "", year)
        for fuel in (terms.outside, terms.inside)
    )
    return (group["fuel_t"] - inside) * outside + inside * in_areas


def share_of_voyage(voyage: Mapping[str, Any], annual: Mapping[str, float]) -> float:
    """Return the share of a voyage in scope of the charges: given, or by its ports.

    Parameters
    ----------
    voyage : mapping
        With ``start`` and ``goal``.
    annual : mapping
        Of `checked_annual`.

    Returns
    -------
    float
        0, 0.5 or 1; NaN where it is not given and an end is not a port by name.
    """
    if "eu_share" in annual:
        return annual["eu_share"] / 100.0
    codes = []
    for end in (voyage.get("start"), voyage.get("goal")):
        if not isinstance(end, str) or parse_position(end) is not None:
            return math.nan
        try:
            codes.append(PORTS.lookup(end).country_code)
        except InputError:
            return math.nan
    return voyage_share_between(*codes)


def _penalty(fuel: str, tonnes: float, year: int) -> float:
    """Return the FuelEU penalty of a fuel [EUR]; NaN where its intensity is not known."""
    known = WELL_TO_WAKE.get(fuel)
    if known is None:
        return math.nan
    energy = 1000.0 * tonnes * known.heat
    return float(fueleu_penalty(energy, intensity=known.intensity, year=year))
