"""One row of a study: its inputs, opened once per process, and its result as plain data."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

import thalweg
from thalweg.chart import Chart
from thalweg.core.errors import CoverageError, InputError, NoRouteError, ThalwegError
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning import Plan, Voyage, plan
from thalweg.planning.report.filled_weather import has_fills, wave_shares
from thalweg.planning.report.unread_weather import unread_weather_notes
from thalweg.planning.report.waiting_report import hours_above_limits
from thalweg.planning.request.filled_sea import filled_in_turns
from thalweg.planning.request.voyage_endpoints import NOT_REACHED
from thalweg.planning.request.voyage_surroundings import (
    chart_of_entries,
    ship_of_entries,
    with_year_of_rules,
)
from thalweg.route import Route, Track, evaluate, read_track
from thalweg.route.indicator_columns import INDICATORS, indicator_value
from thalweg.sea import Sea
from thalweg.sea.fill_policies import FETCH_LIMITED
from thalweg.ship import Ship
from thalweg.studies.series_rows import SeriesInputs, series_figures, series_key
from thalweg.studies.study import StudyRow
from thalweg.studies.study_axes import fill_policies
from thalweg.studies.study_checks import canonical_json

#: Column with the weather on a route that the ship does not read.
UNREAD = "unread_weather"
_WAVE_HEIGHT = "sea_surface_wave_significant_height"
#: Largest values over a route: column and sampled variables.
_EXTREMES = {
    "max_significant_wave_height_m": (_WAVE_HEIGHT,),
    "max_wind_speed_ms": ("eastward_wind", "northward_wind"),
    "max_current_ms": ("eastward_sea_water_velocity", "northward_sea_water_velocity"),
}
#: Indicators whose totals have names of their own.
_NAMED_OTHERWISE = ("time", "distance", "fuel", "energy", "co2", "cost", "min_ukc")
#: Entries of a voyage that do not change the route planned in calm weather.
_OF_WEATHER = ("depart", "depart_window", "arrive", "arrive_by", "ensemble")
_ANY_DATE = "2000-01-01T00:00Z"
#: Errors of a row that are faults of Thalweg: the row says so, and the study goes on.
_OWN_FAULTS = (ArithmeticError, LookupError, TypeError, ValueError, AssertionError)


def run_rows(rows: Sequence[StudyRow], folder: str) -> list[dict[str, Any]]:
    """Return the results of rows.

    Parameters
    ----------
    rows : Best those that share ship, sea and places: these are opened once.
    folder : Files are relative to it.

    Returns
    -------
    list of dict
        One per row, as plain data: ``id``, the labels, the key figures of the route (None where
        unknown), ``refusal`` (the kind of error, None for a route) with ``reason``, ``seconds`` and
        ``version``.
    """
    together: dict[str, list[StudyRow]] = {}
    for row in rows:
        key = series_key(row.request) if row.request.get("detail") == "network" else row.id
        together.setdefault(key, []).append(row)
    results = [result for group in together.values() for result in _run_group(group, folder)]
    order = {row.id: place for place, row in enumerate(rows)}
    return sorted(results, key=lambda result: order[result["id"]])


def _run_group(rows: Sequence[StudyRow], folder: str) -> list[dict[str, Any]]:
    """Return the results of one row, or of rows that differ in their departure only."""
    begin = time.perf_counter()
    found: list[dict[str, Any] | Exception]
    try:
        if rows[0].request.get("detail") == "network":
            found = series_figures([row.request for row in rows], _inputs(rows[0].request, folder))
        else:
            found = [_figures(rows[0].request, Path(folder))]
    except (ThalwegError, *_OWN_FAULTS) as error:
        found = [error] * len(rows)
    taken = (time.perf_counter() - begin) / len(rows)
    more = {"seconds": round(taken, 4), "version": thalweg.__version__}
    none = {"refusal": None, "reason": None}
    return [
        {"id": row.id, **row.labels, **none, **_plain(one), **more} for row, one in zip(rows, found)
    ]


def _plain(found: dict[str, Any] | Exception) -> dict[str, Any]:
    """Return figures as they are, and an error as a refusal."""
    if isinstance(found, ThalwegError):
        refused = found.reasons_text if isinstance(found, NoRouteError) else ""
        reason = f"{found} Legs refused: {refused}." if refused else str(found)
        return {"refusal": type(found).__name__, "reason": reason}
    if isinstance(found, Exception):
        return {"refusal": "InternalError", "reason": f"{type(found).__name__}: {found}"}
    return found


def _inputs(request: Mapping[str, Any], folder: str) -> SeriesInputs:
    return SeriesInputs(
        ship_of_request(request, folder),
        _sea(request, Path(folder)),
        _chart_of(request, folder),
        folder,
    )


def _figures(request: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the key figures of the route of a request."""
    ship = ship_of_request(request, str(folder))
    sea = _sea(request, folder)
    chart = _chart_of(request, str(folder))
    voyage = request["voyage"]
    if "track" in request:
        path = folder / str(request["track"])
        track = read_track(path, depart=voyage.get("depart"))
        route = _evaluated(track, ship, sea, chart, voyage)
        return _route_figures(route, ship, sea)
    answer = _planned(voyage, ship, sea, chart, request)
    if answer.cancelled:  # Ctrl-C: the best plan so far is no result of this row
        raise KeyboardInterrupt
    short = next((note for note in answer.notes if note.startswith(NOT_REACHED)), None)
    if short is not None:
        raise CoverageError(short, "A row of a study is a whole voyage.", "Add data, or a fill.")
    figures = _route_figures(answer.best, ship, sea)
    objective = answer.voyage.objective
    networks = answer.provenance.get("networks", [])
    figures |= {
        "objective": objective,
        "certified_gap": _certified_gap(answer),
        "nodes": sum(one["nodes"] for one in networks) or None,
        "segments": sum(one["edges"] for one in networks) or None,
    }
    if answer.front is not None:
        figures |= _savings(answer)
        front = [(route.time_h, route.fuel_t) for route in answer.routes]
        figures["front"] = canonical_json([[finite_or_none(x) for x in pair] for pair in front])
    if "weather_blind" in request.get("compare", ()):
        figures |= _weather_blind(request, ship, sea, chart, folder)
    return figures


def _planned(
    voyage: Mapping[str, Any], ship: Ship, sea: Sea, chart: Chart, request: Mapping[str, Any]
) -> Plan:
    resolution = request.get("resolution_nm")
    return plan(
        Voyage.from_dict(voyage),
        ship=ship,
        sea=sea,
        chart=chart,
        network=request.get("network", "auto"),
        proof=0.0,  # the certificate depends on the time that it is given
        resolution=None if resolution is None else float(resolution) * NAUTICAL_MILE,
    )


def _certified_gap(answer: Plan) -> float | None:
    """Return the excess over the lower bound that is certain, as a fraction."""
    certain, value = answer.proof.certain, answer.objective_value
    return finite_or_none((value - certain) / value) if value > 0.0 else None


def _savings(answer: Plan) -> dict[str, Any]:
    """Return what weather and varied speeds save over the weather-blind route of nearly that time.

    In the unit of the objective, at the same time; None where it is not known.
    """
    names = ("saved", "saved_by_route", "saved_by_speed")
    comparison = None if answer.front is None else answer.front.comparison
    known = [row for row in comparison.rows if row["saved"] is not None] if comparison else []
    if not known:
        return dict.fromkeys(names)
    nearest = min(known, key=lambda row: abs(row["time_h"] - answer.best.time_h))
    return {name: nearest[name] for name in names}


def _route_figures(route: Route, ship: Ship, sea: Sea) -> dict[str, Any]:
    """Return the totals of a route, the worst weather on it, and where its waves are filled."""
    figures = {
        key: value
        for key, value in route.as_dict().items()
        if isinstance(value, (int, float, str, bool)) or value is None
    }
    for name in INDICATORS:
        if name not in _NAMED_OTHERWISE:
            figures[name] = finite_or_none(indicator_value(route, name))
    figures["first_violation"] = str(route.violations[0]) if route.violations else None
    figures["waiting_above_limits_h"] = hours_above_limits(route, ship)
    unread = unread_weather_notes(route, sea, ship) if math.isfinite(route.arrive) else []
    figures[UNREAD] = " ".join(unread) or None
    figures |= worst_weather(route.samples)
    height = route.samples.get(_WAVE_HEIGHT)
    if height is not None and has_fills(sea):
        figures["waves_filled_percent"] = wave_shares(route, sea, np.asarray(height)).filled
    return figures


def worst_weather(samples: Mapping[str, Any]) -> dict[str, float | None]:
    """Return the greatest values of samples of a route; those that are not known do not count.

    On the approaches of ports no weather is known.
    """
    found: dict[str, float | None] = {}
    for column, variables in _EXTREMES.items():
        parts = [samples[name] for name in variables if name in samples]
        size = np.hypot(*parts) if len(parts) == 2 else parts[0] if parts else np.array([])
        found[column] = None if np.isnan(size).all() else float(np.nanmax(size))
    return found


def _weather_blind(
    request: Mapping[str, Any], ship: Ship, sea: Sea, chart: Chart, folder: Path
) -> dict[str, Any]:
    """Return time and fuel of the route planned in calm weather, sailed in the real weather."""
    voyage = {key: value for key, value in request["voyage"].items() if key not in _OF_WEATHER}
    key = canonical_json([voyage, {k: v for k, v in request.items() if k != "voyage"}])
    track = _calm_track(key, str(folder))
    blind = _evaluated(track, ship, sea, chart, request["voyage"])
    return {
        "blind_time_h": finite_or_none(blind.time_h),
        "blind_fuel_t": finite_or_none(blind.fuel_t),
        "blind_distance_nm": finite_or_none(blind.distance_nm),
        "blind_feasible": blind.feasible,
    }


@lru_cache(maxsize=32)
def _calm_track(key: str, folder: str) -> Track:
    """Return the track planned in calm weather."""
    import json

    voyage, request = json.loads(key)
    ship = ship_of_request(request, folder)
    chart = _chart_of(request, folder)
    answer = _planned({**voyage, "depart": _ANY_DATE}, ship, Sea.calm(), chart, request)
    return answer.best.track


def _evaluated(
    track: Track, ship: Ship, sea: Sea, chart: Chart, voyage: Mapping[str, Any]
) -> Route:
    return evaluate(
        track,
        ship=ship,
        sea=sea,
        chart=chart,
        depart=voyage.get("depart"),
        min_ukc=voyage.get("min_ukc_m"),
        speed_kn=voyage.get("speed_kn"),
        strict=False,
    )


def ship_of_request(request: Mapping[str, Any], folder: str) -> Ship:
    """Return the ship of a request.

    Parameters
    ----------
    request : mapping
        Of a `StudyRow`.
    folder : Files are relative to it.
    """
    voyage = request.get("voyage") or {}
    own_share = (request.get("charges") or {}).get("share_percent") is not None
    ends = None if own_share else [voyage.get(name) for name in ("start", "goal")]
    entries = [request.get(name) for name in ("ship", "load_factor", "limits")]
    charges = request.get("charges")
    if charges is not None:
        charges = with_year_of_rules(charges, voyage)
    return _ship(canonical_json([*entries, charges, ends if charges else None]), folder)


@lru_cache(maxsize=8)
def _ship(key: str, folder: str) -> Ship:
    import json

    given, load_factor, limits, charges, ends = json.loads(key)
    if given is None:
        raise InputError(
            "The study names no ship.", "ship: is a name, a file or a mapping.", "Add it."
        )
    if not isinstance(given, Mapping):
        path = Path(folder) / str(given)
        given = path if path.is_file() else str(given)
    return ship_of_entries(
        given,
        load_factor=load_factor,
        limits=limits,
        charges=charges,
        ends=tuple(ends or (None, None)),
    )


def _sea(request: Mapping[str, Any], folder: Path) -> Sea:
    policies = fill_policies(request.get("fill"))
    by_fetch = ("waves", FETCH_LIMITED) in policies
    coast = str(request.get("coast", "i")) if by_fetch else None
    parts = [request.get("sea"), request.get("map"), policies, coast]
    sea = _opened_sea(canonical_json(parts), str(folder))
    member = request.get("member")
    sea = sea if member is None else sea.member(int(member))
    if sea.members:
        raise InputError(
            f"The sea is a forecast of {sea.members} members, and the study names none.",
            "A row of a study has the figures of one route in one forecast.",
            "Add the axis member, such as axes: {member: [0, 1, 2]}, or one member; thalweg plan "
            "shows the mean of an ensemble.",
            field="member",
        )
    return sea.sampled(str(request.get("sampling", "linear")))


@lru_cache(maxsize=4)
def _opened_sea(key: str, folder: str) -> Sea:
    """Return a sea; each process opens its files once."""
    import json

    given, mapping, policies, coast = json.loads(key)
    names = given if isinstance(given, list) else [given]
    if not names or not all(isinstance(name, str) for name in names):
        raise InputError(
            "The study names no sea.",
            "sea: is calm, storm, a file or a list of files.",
            "Add it: Thalweg never assumes calm weather.",
        )
    if names == ["calm"]:
        return Sea.calm()
    chart = None if coast is None else _chart_of({"coast": coast}, folder)
    layers = [Sea.storm()] if "storm" in names else []
    files = [Path(folder) / name for name in names if name != "storm"]
    if files:
        layers.insert(0, Sea.open(*files, mapping=mapping))
    sea = layers[0] if len(layers) == 1 else Sea.layered(*layers)
    return filled_in_turns(sea, policies, chart)


def _chart_of(request: Mapping[str, Any], folder: str) -> Chart:
    names = ("coast", "depths", "areas", "traffic", "eca")
    return _chart(
        canonical_json({name: request[name] for name in names if name in request}), folder
    )


@lru_cache(maxsize=4)
def _chart(key: str, folder: str) -> Chart:
    """Return a chart; each process opens its files once."""
    import json

    given = json.loads(key)
    files = {
        name: [Path(folder) / one if isinstance(one, str) else one for one in _listed(given, name)]
        for name in ("depths", "areas", "traffic")
    }
    return chart_of_entries(str(given.get("coast", "i")), eca=given.get("eca", True), **files)


def _listed(given: Mapping[str, Any], name: str) -> list[Any]:
    value = given.get(name)
    return value if isinstance(value, list) else [] if value is None else [value]
