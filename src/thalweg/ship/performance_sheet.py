"""The performance sheet of a ship: resistance, power, fuel and emissions at several speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.carbon_intensity import (
    SHIP_TYPES,
    attained_cii,
    cii_rating,
    cii_ship_type,
    rating_boundaries,
    required_cii,
)
from thalweg.ship.models.known_speed_model import SpeedLossModel
from thalweg.ship.models.kwon_resistance_model import KwonResistanceModel
from thalweg.ship.models.kwon_speed_loss import LEAST_SPEED_SHARE, predicted_share
from thalweg.ship.models.propulsion_model import unused_efficiencies
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.models.speed_power_laws import speed_power_law_name
from thalweg.ship.performance_sheet_seaway import ShipInSeaway
from thalweg.ship.performance_sheet_weather import (
    sheet_conditions,
    weather_assumptions,
    weather_beyond_limits,
    weather_without_model,
)
from thalweg.ship.schema.hull_types import plain_hull_type
from thalweg.ship.schema.unusual_numbers import unusual_numbers
from thalweg.ship.ship import Ship
from thalweg.ship.ship_assumptions import load_factor_without_effect

SHEET_COMPONENTS = (
    *("total", "friction", "form_factor", "appendage", "wave_making", "bulb", "transom"),
    *("correlation", "waves", "wind", "shallow", "rudder"),
)


def performance_sheet(
    ship: Ship, weather: Mapping[str, float] | None = None, *, speeds_kn: Sequence[float] = ()
) -> dict[str, Any]:
    """Return resistance, power, fuel and CO2 of a ship at speeds through water.

    Parameters
    ----------
    weather : Conditions by name, SI; calm and deep where not given.
    speeds_kn : Speeds through water [kn]; the ship's settings when not given.

    Returns
    -------
    dict : Plain data: ``name``, ``conditions[]`` (``speed_kn``, ``resistance_n`` by component,
        which add up to its ``total``; the remainder of Hollenbach's method, all of it pressure, is
        part of ``wave_making``; with Kwon's speed loss the resistance is that of calm water at the
        speed, the power that of the unreduced calm-water speed; ``effective_power_kw``,
        ``brake_power_kw``, ``fuel_kg_per_h``, ``co2_kg_per_h``, ``fuel_kg_per_nm``, ``cii``,
        ``squat``, ``motions``, ``warnings``), ``assumed[]`` (period and directions of weather that
        were not given), ``warnings[]`` (speeds left out, weather without a model of the ship),
        ``missing[]`` (unknown results and the keys that would give them), ``settings[]`` (the speed
        of each setting in this weather), ``estimated[]`` and ``sources``. Unknown numbers are None.

    Raises
    ------
    InputError : If the ship can sail none of the speeds, or its speed is a field.
    """
    if ship.speed_field is not None:
        raise InputError(
            f"The speed of {ship.name!r} is a field of place and time.",
            "A sheet is for ships whose speed depends on wind, waves, depth and setting only.",
            "Give a ship with settings, or evaluate a route with this one.",
            ship=ship.name,
        )
    conditions = sheet_conditions(ship, weather or {})
    model = ship.model
    speeds = np.array(speeds_kn, float) * KNOT if len(speeds_kn) else _default_speeds(ship)
    if speeds.size == 0 or not (np.isfinite(speeds) & (speeds > 0)).all():
        raise InputError(
            "The requested speeds are not all positive numbers.",
            "Speeds are in knots, such as 8:16 or 10,12,14.",
            "Correct them.",
        )
    left_out: list[str] = []
    if isinstance(model, ResistanceBased):
        rows = _resistance_model_rows(ship, model, conditions, speeds)
    else:
        speeds, left_out = _admissible_speeds(ship, speeds)
        rows = _known_speed_rows(ship, conditions, speeds)
    seaway = ShipInSeaway.of(ship, conditions)
    for row in rows:
        _add_seaway(row, seaway)
    return {
        "name": ship.name,
        "draught_m": ship.draught,
        "load_factor": ship.loading.load_factor,
        "weather": {name: finite_or_none(value) for name, value in (weather or {}).items()},
        "assumed": [
            *weather_assumptions(ship, weather or {}),
            *_unused_entries(ship),
            *load_factor_without_effect(ship),
        ],
        "conditions": rows,
        "warnings": [
            *unusual_numbers(ship.file),
            *left_out,
            *weather_without_model(ship, weather or {}),
            *weather_beyond_limits(ship, weather or {}),
        ],
        "missing": _missing_results(ship, rows),
        "settings": _settings(ship, conditions),
        "estimated": [{"key": e.key, "value": e.value, "method": e.method} for e in ship.estimated],
        "sources": list(ship.file.sources),
        "description": ship.file.description,
        "fingerprint": ship.fingerprint(),
    }


def _admissible_speeds(ship: Ship, speeds: FloatArray) -> tuple[FloatArray, list[str]]:
    """Return the speeds that a ship with known speeds can hold, and warnings of the others.

    Raises
    ------
    InputError : If there is none.
    """
    if np.array_equal(speeds, ship.speeds):
        return speeds, []
    good, bad, reason = [], [], None
    for speed in speeds:
        try:
            ship.with_speeds(speed)
            good.append(float(speed))
        except InputError as refusal:
            bad.append(float(speed))
            reason = reason or refusal
    if reason is not None and not good:
        ship.with_speeds(speeds)
        raise reason
    listed = ", ".join(f"{speed / KNOT:.4g}" for speed in bad)
    why = "" if reason is None else f" {reason.possible}"
    return np.array(good), [f"{listed} kn left out.{why}"] if bad else []


def _add_seaway(row: dict[str, Any], seaway: ShipInSeaway) -> None:
    """Add squat and motions to a row, with their warnings."""
    speed = row["speed_kn"]
    if speed is None:
        row |= {"squat": None, "motions": None}
        return
    squat, touching = seaway.squat(speed * KNOT)
    motions, dangers = seaway.motions(speed * KNOT)
    row |= {"squat": squat, "motions": motions}
    row["warnings"] += [*touching, *dangers]


def _default_speeds(ship: Ship) -> FloatArray:
    own = ship.speeds
    if not ship.is_resistance_based or len(own) > 4:
        return own
    return np.linspace(0.6, 1.1, 6) * own.max()


def _resistance_model_rows(
    ship: Ship, model: ResistanceBased, conditions: Conditions, speeds: FloatArray
) -> list[dict[str, Any]]:
    parts = ship.resistance(conditions, speeds)
    parts["wave_making"] = parts["wave_making"] + parts.pop("residuary")
    power = ship.power_at_speed(conditions, speeds)
    plant, loaded = model.plant, ship.loading.load_factor
    loss = model.loss if isinstance(model, KwonResistanceModel) else None
    balance = model.balance(loaded)
    weather = conditions.with_values(load_factor=loaded)
    fuel = np.where(power <= plant.largest_power, plant.fuel(power), np.nan)
    rows = []
    for k, speed in enumerate(speeds):
        at = {n: np.array([float(np.asarray(conditions[n]))]) for n in _CONDITION_NAMES}
        notes = [str(n) for n in balance.notes(at, speeds[k : k + 1])]
        notes += [str(n) for n in plant.notes(power[k : k + 1])]
        notes += (
            [str(n) for n in loss.notes(weather, speeds[k : k + 1])] if loss is not None else []
        )
        if power[k] > plant.largest_power:
            notes.append(f"the engines give {plant.largest_power / 1e3:.0f} kW: not reached")
        rows.append(
            {
                **_row(ship, speed, fuel[k]),
                "resistance_n": {name: finite_or_none(parts[name][k]) for name in SHEET_COMPONENTS},
                "effective_power_kw": finite_or_none(parts["total"][k] * speed / 1e3),
                "brake_power_kw": finite_or_none(power[k] / 1e3),
                "warnings": notes,
            }
        )
    return rows


_CONDITION_NAMES = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")


def _known_speed_rows(
    ship: Ship, conditions: Conditions, speeds: FloatArray
) -> list[dict[str, Any]]:
    ordered = ship if np.array_equal(speeds, ship.speeds) else ship.with_speeds(speeds)
    greatest, rows = ship.greatest_order(), []
    for k, speed in enumerate(np.unique(speeds)):
        attained = float(ordered.speed_through_water(conditions, k))
        notes = [str(n) for n in ordered.notes(conditions, k)]
        share = _predicted_share(ordered, conditions, k, attained)
        if share < LEAST_SPEED_SHARE:
            notes.append(
                f"the method leaves {share:.0%} of the speed there, which is no "
                "prediction: no speed is given"
            )
            attained = np.nan
        if speed > greatest * (1.0 + 1e-9):
            notes.append(f"above the greatest speed of the ship, {greatest / KNOT:.4g} kn")
        fuel = float(ordered.fuel_rate(conditions, k))
        power = float(ordered.power(conditions, k))
        rows.append(
            {
                **_row(ship, attained, fuel),
                "ordered_speed_kn": finite_or_none(speed / KNOT),
                "resistance_n": dict.fromkeys(SHEET_COMPONENTS),
                "effective_power_kw": None,
                "brake_power_kw": finite_or_none(power / 1e3),
                "warnings": notes,
            }
        )
    return rows


def _predicted_share(ship: Ship, conditions: Conditions, setting: int, speed: float) -> float:
    """Return the share of the speed that a speed loss outside its range leaves; 1 for others."""
    if not isinstance(ship.model, SpeedLossModel):
        return 1.0
    loaded = conditions.with_default(load_factor=ship.loading.load_factor)
    return float(predicted_share(ship.model, loaded, setting, np.asarray(speed)))


def _row(ship: Ship, speed: float, fuel: float) -> dict[str, Any]:
    co2 = fuel * ship.fuel_terms.per_kg("co2", inside=False)
    return {
        "speed_kn": finite_or_none(round(speed / KNOT, 9)),
        "fuel_kg_per_h": finite_or_none(fuel * HOUR),
        "fuel_kg_per_nm": finite_or_none(fuel * NAUTICAL_MILE / speed if speed > 0 else np.nan),
        "co2_kg_per_h": finite_or_none(co2 * HOUR),
        "cii": _cii_of_row(ship, co2 * NAUTICAL_MILE / speed) if speed > 0 else None,
    }


def _cii_of_row(ship: Ship, co2: float) -> dict[str, Any] | None:
    """Carbon intensity of sailing at this speed all the time, and its rating in 2026."""
    found = carbon_intensity_of(ship, co2, year=2026)
    return found and {
        "attained_g_per_t_nm": found["attained"],
        "required_2026": found["required"],
        "rating_2026": found["rating"],
        "boundaries_2026": found["boundaries"],
    }


def carbon_intensity_of(ship: Ship, co2: float, *, year: int) -> dict[str, Any] | None:
    """Return the carbon intensity indicator (CII) of a ship and its rating.

    Parameters
    ----------
    co2 : Emission per distance [kg/nm].
    year : Of the rating, 2019 to 2030.

    Returns
    -------
    dict or None : ``attained`` [g/(t nm)], or [g/(GT nm)] where the type of ship is rated by gross
        tonnage; ``required``, ``boundaries`` and ``rating``, None for types that the regulation
        does not know. None without a capacity in the ship file.
    """
    hull = ship.file.hull
    kind = plain_hull_type(hull.type)
    try:
        by_tonnage = cii_ship_type(kind).capacity == "gt"
        known = True
    except InputError:
        by_tonnage = known = False
    capacity = hull.gross_tonnage if by_tonnage else hull.deadweight_t
    if capacity is None or not np.isfinite(co2):
        return None
    attained = float(attained_cii(co2, capacity=capacity, distance_nm=1.0))
    found: dict[str, Any] = {
        "attained": attained, "required": None, "rating": None, "boundaries": None
    }  # fmt: skip
    if known:
        here: dict[str, Any] = {"ship_type": kind, "capacity": capacity, "year": year}
        found["required"] = float(required_cii(**here))
        found["boundaries"] = [float(limit) for limit in rating_boundaries(**here)]
        found["rating"] = str(cii_rating(attained, **here))
    return found


def _unused_entries(ship: Ship) -> list[str]:
    """Return the entries of a ship file that its calm-water method does not use."""
    file = ship.file
    method = file.models.calm_water or speed_power_law_name(file)
    if not ship.is_resistance_based:
        table = method in ("none", "cubic") and {"table", "speeds_kn"} <= file.model_fields_set
        return [f"calm_water: {method} does not use the table"] if table else []
    given = {
        "table": file.table is not None,
        "speeds under loading": file.loading.speeds_full_kn is not None,
        "reference point": method != "cubic"
        and (file.engine.reference_power_kw, file.fuel.reference_t_per_day) != (None, None),
    }
    found = [f"calm_water: {method} does not use the {w}" for w, there in given.items() if there]
    idle = unused_efficiencies(file.propulsion, file.models.propulsion)
    return [*found, *(f"propulsion.{key} is not used" for key in idle)]


def _missing_results(ship: Ship, rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the results that are unknown, with the keys of the ship file that would give them."""

    def known(name: str) -> bool:
        return any(row[name] is not None for row in rows)

    if ship.file.is_empty:
        return []
    missing: list[str] = []
    if ship.is_resistance_based and not known("brake_power_kw"):
        return missing  # it is the water or the weather that leaves no number
    if not known("brake_power_kw"):
        missing.append(
            "power: add engine.reference_power_kw with engine.reference_speed_kn, a column "
            "power_kw to table, or a resistance method as models.calm_water"
        )
    overloaded = known("brake_power_kw") and all(
        row["fuel_kg_per_h"] is not None for row in _settings(ship, sheet_conditions(ship, {}))
    )
    if not known("fuel_kg_per_h") and overloaded:
        return missing  # it is known at less power
    if not known("fuel_kg_per_h"):
        keys = "add engine.type with fuel.type, engine.sfoc_g_per_kwh, or table.fuel_t_per_day"
        table = "add what power needs, or table.fuel_t_per_day"
        missing.append(f"fuel: {keys if known('brake_power_kw') else table}")
    elif not known("co2_kg_per_h"):
        missing.append("CO2: add fuel.type or fuel.carbon_factor")
    elif not known("cii") and known("speed_kn"):
        missing.append("CII: add hull.deadweight_t, or hull.gross_tonnage for some types of ship")
    elif known("cii") and all((row["cii"] or {}).get("rating_2026") is None for row in rows):
        missing.append(f"rating of the CII: add hull.type, one of {', '.join(SHIP_TYPES)}")
    return missing


def _settings(ship: Ship, conditions: Conditions) -> list[dict[str, Any]]:
    rows = []
    for k, calm in enumerate(ship.speeds):
        rows.append(
            {
                "calm_speed_kn": finite_or_none(calm / KNOT),
                "speed_kn": finite_or_none(float(ship.speed_through_water(conditions, k)) / KNOT),
                "brake_power_kw": finite_or_none(float(ship.power(conditions, k)) / 1e3),
                "fuel_kg_per_h": finite_or_none(float(ship.fuel_rate(conditions, k)) * HOUR),
            }
        )
    return rows
