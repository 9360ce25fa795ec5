"""The chart and the ship of a voyage, from the entries that requests and studies have for them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from thalweg.chart import Chart
from thalweg.chart.geojson_polygons import GeoJsonSource
from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import KNOT
from thalweg.planning.request.european_scope import share_between_places
from thalweg.ship import Ship, plugin_names
from thalweg.ship.file.ship_file import read_ship
from thalweg.ship.methods.engine.european_charges import EuropeanCharges

#: Limits that replace those of a ship file, with their largest values.
LARGEST_LIMITS: Final[Mapping[str, float]] = {
    "wave_height_m": 40.0,
    "wind_speed_kn": 200.0,
    "motion_sickness_percent": 100.0,
}
LARGEST_CHARGE: Final = 1e5  #: of an allowance or a euro
CHARGE_YEARS: Final = (2024, 2060)
SHARES_PERCENT: Final = (0, 50, 100)
_USUAL_YEAR: Final = 2026  # whose rules hold where no time is given
_CHARGES: Final = ("share_percent", "ets_price", "eur_rate", "year")


def chart_of_entries(
    coast: str,
    *,
    depths: Iterable[str | Path] = (),
    areas: Iterable[GeoJsonSource] = (),
    traffic: Iterable[str | Path] = (),
    eca: bool = True,
) -> Chart:
    """Return the chart of a voyage.

    Parameters
    ----------
    coast : Resolution of GSHHG; ``none``: a world without land.
    depths, traffic : Files.
    areas : GeoJSON, as files or plain data.
    eca : Whether emission control areas count.
    """
    no_land = coast == "none"
    chart = Chart.open_water(-90.0, 90.0, -180.0, 180.0) if no_land else Chart.gshhg(coast)
    for path in depths:
        chart = chart.with_depth(path)
    for area in areas:
        chart = chart.with_zones(area)
    for path in traffic:
        chart = chart.with_traffic(path)
    return chart if eca else chart.without_eca()


def ship_of_entries(
    given: str | Path | Mapping[str, Any],
    *,
    load_factor: float | None = None,
    limits: Mapping[str, Any] | None = None,
    charges: Mapping[str, Any] | None = None,
    ends: tuple[object, object] = (None, None),
) -> Ship:
    """Return the ship of a voyage, with its load, limits and charges.

    Parameters
    ----------
    given : Name of a ship, a ship file, or the content of one.
    load_factor : 0 empty to 1 full.
    limits : Of `LARGEST_LIMITS`, in place of those of the ship file.
    charges : ``share_percent``, ``ets_price``, ``eur_rate`` and ``year``.
    ends : Start and goal, by which the share of the charges is found where it is not given.

    Raises
    ------
    InputError
        For entries that are not possible.
    """
    check_limits(limits or {})
    known = {name: value for name, value in (limits or {}).items() if value is not None}
    sick = known.get("motion_sickness_percent")
    if sick is not None:
        ship = _with_comfort_limit(given, float(sick))
    elif isinstance(given, Mapping):
        ship = Ship.from_dict(given, source="ship of the request")
    else:
        ship = Ship.load(given)
    if load_factor is not None:
        ship = ship.with_load_factor(load_factor)
    if charges is not None:
        ship = ship.with_charges(_charges_of_entries(charges, ends))
    changes: dict[str, Any] = {}
    if "wave_height_m" in known:
        changes["wave_height"] = float(known["wave_height_m"])
    if "wind_speed_kn" in known:
        changes["wind_speed"] = float(known["wind_speed_kn"]) * KNOT
    return ship.with_limits(replace(ship.limits, **changes)) if changes else ship


def check_limits(given: Any) -> None:
    """Check limits of a ship: their names and values.

    Raises
    ------
    InputError
        With the entry in ``details["field"]``.
    """
    for name, value in _entries(given, "limit", LARGEST_LIMITS).items():
        largest = LARGEST_LIMITS[name]
        if value is not None and not 0.0 < to_number(value) <= largest:
            raise _wrong_entry(f"limits.{name}", value, f"a number above 0, at most {largest:g}")


def check_charges(given: Any) -> None:
    """Check charges of the European Union: their names and values.

    Raises
    ------
    InputError
        With the entry in ``details["field"]``.
    """
    for name, value in _entries(given, "charge", _CHARGES).items():
        field = f"charges.{name}"
        if name == "share_percent":
            if value is not None and value not in SHARES_PERCENT:
                raise _wrong_entry(field, value, "0, 50 or 100")
        elif name == "year":
            first, last = CHARGE_YEARS
            if value not in range(first, last + 1):
                raise _wrong_entry(field, value, f"a year from {first} to {last}")
        elif not 0.0 <= to_number(value) <= LARGEST_CHARGE:
            raise _wrong_entry(field, value, f"a number from 0 to {LARGEST_CHARGE:,.0f}")


def year_of_rules(voyage: Mapping[str, Any]) -> int:
    """Return the year whose European rules hold for a voyage.

    Parameters
    ----------
    voyage : Its entries ``depart``, ``depart_window``, ``arrive`` and ``arrive_by``: the first
        time of them counts.

    Returns
    -------
    int : That of the departure. Departures before the first rules stand for weather of the past:
        the rules of 2026 hold, as they do without a time.
    """
    window = voyage.get("depart_window") or [None]
    times = [voyage.get("depart"), window[0], voyage.get("arrive"), voyage.get("arrive_by")]
    given = next((time for time in times if time is not None), None)
    year = _USUAL_YEAR if given is None else int(format_time(parse_time(given))[:4])
    first, last = CHARGE_YEARS
    return min(year, last) if year >= first else _USUAL_YEAR


def with_year_of_rules(charges: Mapping[str, Any], voyage: Mapping[str, Any]) -> dict[str, Any]:
    """Return charges with a year: their own, or that of a voyage.

    Parameters
    ----------
    charges : As of `ship_of_entries`.
    voyage : As of `year_of_rules`.
    """
    own = charges.get("year")
    return {**charges, "year": year_of_rules(voyage) if own is None else own}


def _entries(given: Any, what: str, known: Iterable[str]) -> Mapping[str, Any]:
    """Return entries of known names."""
    if not isinstance(given, Mapping):
        raise _wrong_entry(f"{what}s", given, "a mapping of names to numbers")
    for name in given:
        if str(name) not in known:
            raise unknown_name_error(what, str(name), known, field=f"{what}s")
    return {str(name): value for name, value in given.items()}


def _wrong_entry(field: str, value: Any, possible: str) -> InputError:
    return InputError(
        f"{field} is {shortened_repr(value)}.",
        f"It is {possible}.",
        "Correct it, or leave it out.",
        field=field,
    )


def _charges_of_entries(given: Mapping[str, Any], ends: tuple[object, object]) -> EuropeanCharges:
    check_charges(given)
    prices = float(given.get("ets_price", 0.0)), float(given.get("eur_rate", 0.0))
    year, share = int(given.get("year", _USUAL_YEAR)), given.get("share_percent")
    if share is not None:
        return EuropeanCharges(float(share) / 100.0, *prices, year)
    found, source = share_between_places(*ends)
    return EuropeanCharges(found, *prices, year, source)


def _with_comfort_limit(given: str | Path | Mapping[str, Any], percent: float) -> Ship:
    """Return a ship whose file has another limit of motion sickness."""
    if isinstance(given, str) and given in plugin_names():
        raise InputError(
            f"A limit of motion sickness was given for the ship {given!r}.",
            "It can be given for ships of the library and of files; this one is of a plug-in.",
            "Leave the limit out, or choose another ship.",
            field="limits.motion_sickness_percent",
        )
    data, source = (
        (given, "ship of the request") if isinstance(given, Mapping) else read_ship(given)
    )
    limits = {**(data.get("limits") or {}), "max_motion_sickness_percent": percent}
    return Ship.from_dict({**data, "limits": limits}, source=source)
