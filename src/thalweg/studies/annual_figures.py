"""What the voyages of a study come to in a year: fuel, emissions, carbon intensity, cost."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pandas as pd

from thalweg.core.errors import InputError
from thalweg.ship import Ship
from thalweg.ship.methods.carbon_intensity import REDUCTION_PERCENT
from thalweg.ship.performance_sheet import carbon_intensity_of

_ENTRIES: Final = {
    "port_h": (0.0, 8760.0),
    "year": (min(REDUCTION_PERCENT), max(REDUCTION_PERCENT)),
}
_HOURS: Final = 8760.0


def checked_annual(given: Any) -> dict[str, float]:
    """Return the entry ``annual`` of a study, checked.

    Parameters
    ----------
    given : mapping
        ``port_h``: time in port after each voyage [h]; ``year`` of the carbon intensity rating.

    Raises
    ------
    InputError
        For other entries, or values out of range.
    """
    if not isinstance(given, Mapping) or set(given) - set(_ENTRIES):
        raise InputError(
            f"annual is {given!r}.",
            "It has port_h (hours in port after each voyage) and year (of the rating).",
            "Correct it, for example {port_h: 48, year: 2026}.",
            field="annual",
        )
    for name, value in given.items():
        low, high = _ENTRIES[name]
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not number or not low <= value <= high:
            raise InputError(
                f"{name} of annual is {value!r}.",
                f"It is a number from {low:g} to {high:g}.",
                "Correct it.",
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
        has no capacity or another type. Time and emissions in port are not counted.
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
        if ship is not None and row["co2_t"] is not None and row["distance_nm"]:
            grams = row["co2_t"] * 1000.0 / row["distance_nm"]  # kg of CO2 per nm
            rating = carbon_intensity_of(ship, grams, year=int(annual["year"]))
        row |= {
            "cii": rating and rating["attained"],
            "cii_required": rating and rating["required"],
            "cii_rating": rating and rating["rating"],
        }
        found.append(row)
    return pd.DataFrame(found)
