"""What a ship file may hold: every key with its kind and range, and the check of a file."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from types import MappingProxyType
from typing import Any, Final

from thalweg.core.errors import InputError, close_matches, unknown_name_error


@dataclass(frozen=True)
class KeyRule:
    """One key of a ship file.

    Attributes
    ----------
    kind : {"number", "numbers", "text", "texts", "flag", "word", "word_or_number", "count"}
        What its value is; ``numbers`` is one number or a list of them.
    low, high : float
        Range of a number, both ends allowed.
    above : float
        A number must be greater than this.
    words : tuple of str
        What a ``word`` may be.
    """

    kind: str = "number"
    low: float = -math.inf
    high: float = math.inf
    above: float = -math.inf
    words: tuple[str, ...] = ()


def _positive(high: float = math.inf) -> KeyRule:
    return KeyRule(above=0.0, high=high)


def _non_negative(high: float = math.inf) -> KeyRule:
    return KeyRule(low=0.0, high=high)


STERN_SHAPE_NAMES: Final = ("pram", "v", "v_shaped", "normal", "u", "u_shaped")
_HULL: Final = {
    "length_overall_m": _positive(500.0),
    "length_waterline_m": _positive(500.0),
    "length_between_perpendiculars_m": _positive(500.0),
    "length_over_surface_m": _positive(500.0),
    "length_bow_m": _positive(500.0),
    "breadth_m": _positive(100.0),
    "depth_m": _positive(60.0),
    "draught_m": _non_negative(40.0),
    "draught_fore_m": _non_negative(40.0),
    "draught_aft_m": _non_negative(40.0),
    "displacement_m3": _positive(1e6),
    "displacement_t": _positive(1e6),
    "deadweight_t": _positive(1e6),
    "gross_tonnage": _positive(1e6),
    "block_coefficient": _positive(1.0),
    "midship_coefficient": _positive(1.0),
    "prismatic_coefficient": _positive(1.0),
    "waterplane_coefficient": _positive(1.0),
    "lcb_percent": KeyRule(low=-10.0, high=10.0),
    "wetted_surface_m2": _positive(1e5),
    "bulb_area_m2": _non_negative(500.0),
    "bulb_centre_height_m": _non_negative(40.0),
    "transom_area_m2": _non_negative(2000.0),
    "appendage_area_m2": _non_negative(5000.0),
    "appendage_factor": KeyRule(low=1.0, high=10.0),
    "stern_shape": KeyRule("word_or_number", -25.0, 10.0, words=STERN_SHAPE_NAMES),
    "half_entrance_angle_deg": _positive(90.0),
    "length_entrance_m": _positive(500.0),
    "length_run_m": _positive(500.0),
    "frontal_area_m2": _positive(1e4),
    "lateral_area_m2": _positive(2e4),
    "superstructure_lateral_area_m2": _non_negative(2e4),
    "superstructure_height_m": _positive(100.0),
    "lateral_centre_height_m": _positive(100.0),
    "lateral_centre_offset_m": KeyRule(low=-250.0, high=250.0),
    "rudder_area_m2": _non_negative(500.0),
    "pitch_gyration": _positive(0.5),
    "metacentric_height_m": _positive(20.0),
    "roll_period_s": _positive(100.0),
    "rudders": KeyRule("count", low=0, high=4),
    "brackets": KeyRule("count", low=0, high=8),
    "bosses": KeyRule("count", low=0, high=8),
    "thrusters": KeyRule("count", low=0, high=8),
    "type": KeyRule("text"),
}
_PROPULSION: Final = {
    "propellers": KeyRule("count", low=1, high=4),
    "propeller_diameter_m": _positive(15.0),
    "propeller_pitch_ratio": KeyRule(low=0.3, high=2.0),
    "propeller_blades": KeyRule("count", low=2, high=7),
    "propeller_area_ratio": KeyRule(low=0.2, high=1.5),
    "propeller_rpm": _positive(2000.0),
    "wake_fraction": KeyRule(low=-0.5, high=0.9),
    "thrust_deduction": KeyRule(low=-0.5, high=0.9),
    "open_water_efficiency": _positive(1.0),
    "relative_rotative_efficiency": _positive(1.3),
    "hull_efficiency": _positive(2.0),
    "shaft_efficiency": _positive(1.0),
    "gear_efficiency": _positive(1.0),
    "propulsive_efficiency": _positive(1.5),
}
_ENGINE: Final = {
    "count": KeyRule("count", low=1, high=12),
    "type": KeyRule("text"),
    "power_kw": _positive(2e5),
    "rpm": _positive(3000.0),
    "sfoc_g_per_kwh": _positive(1000.0),
    "sfoc_load": KeyRule("numbers", above=0.0, high=1.5),
    "sfoc_curve_g_per_kwh": KeyRule("numbers", above=0.0, high=1000.0),
    "least_load": _non_negative(1.0),
    "largest_load": _positive(1.1),
    "hotel_load_kw": _non_negative(1e5),
    "hotel_sfoc_g_per_kwh": _positive(1000.0),
    "reference_speed_kn": _positive(80.0),
    "reference_power_kw": _positive(2e5),
    "sea_margin_percent": _non_negative(100.0),
    "year": KeyRule(low=1900, high=2100),
}
_FUEL: Final = {
    "type": KeyRule("text"),
    "eca_type": KeyRule("text"),
    "reference_t_per_day": _positive(1000.0),
    "carbon_factor": _non_negative(5.0),
    "price_per_t": _non_negative(1e5),
    "eca_price_per_t": _non_negative(1e5),
    "eca_price_factor": _positive(100.0),
    "currency": KeyRule("text"),
}
_LOADING: Final = {
    "draught_full_m": _non_negative(40.0),
    "draught_empty_m": _non_negative(40.0),
    "load_factor": KeyRule(low=0.0, high=1.0),
    "condition": KeyRule("word", words=("loaded", "normal", "ballast")),
    "speeds_full_kn": KeyRule("numbers", above=0.0, high=80.0),
    "speeds_empty_kn": KeyRule("numbers", above=0.0, high=80.0),
    "weight_full_t": _positive(1e6),
    "weight_empty_t": _positive(1e6),
    "displacement_full_m3": _positive(1e6),
    "displacement_empty_m3": _positive(1e6),
    "capacity_m3": _positive(1e6),
}
_LIMITS: Final = {
    "max_significant_wave_height_m": _positive(40.0),
    "max_wind_speed_kn": _positive(300.0),
    "max_wind_speed_m_s": _positive(150.0),
    "min_under_keel_clearance_m": _non_negative(50.0),
    "msc_circ_1228": KeyRule("texts"),
    "danger_from_wave_height_m": _non_negative(40.0),
    "roll_period_tolerance": KeyRule(above=0.0, high=0.5),
    "max_vertical_acceleration_m_s2": _positive(20.0),
    "acceleration_at_m": KeyRule(low=-300.0, high=300.0),
    "max_motion_sickness_percent": _positive(100.0),
    "motion_sickness_hours": _positive(24.0),
    "motion_sickness_at_m": KeyRule(low=-300.0, high=300.0),
}
_WATER: Final = {
    "density_kg_m3": KeyRule(low=990.0, high=1040.0),
    "kinematic_viscosity_m2_s": KeyRule(low=6e-7, high=2.2e-6),
}
_COSTS: Final = {
    "hire_per_day": _non_negative(1e9),
    "per_week": _non_negative(1e9),
    "per_second_per_cubed_speed": _non_negative(1e6),
    "currency": KeyRule("text"),
}
_TABLE: Final = {
    "speed_kn": KeyRule("numbers", above=0.0, high=80.0),
    "fuel_t_per_day": KeyRule("numbers", above=0.0, high=1000.0),
    "power_kw": KeyRule("numbers", above=0.0, high=2e5),
    "power_percent": KeyRule("numbers", above=0.0, high=120.0),
    "engines": KeyRule("numbers", low=1.0, high=12.0),
}
_MODELS: Final = (
    {
        name: KeyRule("text")
        for name in ("calm_water", "waves", "wind", "shallow_water", "speed_loss", "propulsion")
    }
    | {name: KeyRule("text") for name in ("friction", "squat", "rudder", "wind_type")}
    | {
        "kwon_sign": KeyRule("word", words=("plus", "printed", "minus")),
        "kwon_classes": KeyRule("flag"),
        "wave_push": KeyRule("flag"),
        "correlation_area": KeyRule("word", words=("hull_and_appendages", "hull")),
        "kwon_ship_type": KeyRule("word", words=("other", "container")),
    }
)

SECTIONS: Final[Mapping[str, Mapping[str, KeyRule]]] = MappingProxyType(
    {
        "hull": _HULL,
        "propulsion": _PROPULSION,
        "engine": _ENGINE,
        "fuel": _FUEL,
        "loading": _LOADING,
        "limits": _LIMITS,
        "costs": _COSTS,
        "water": _WATER,
        "table": _TABLE,
        "models": _MODELS,
    }
)
TOP_LEVEL_KEYS: Final[Mapping[str, KeyRule]] = MappingProxyType(
    {
        "name": KeyRule("text"),
        "description": KeyRule("text"),
        "sources": KeyRule("texts"),
        "speeds_kn": KeyRule("numbers", above=0.0, high=80.0),
        "powers_kw": KeyRule("numbers", above=0.0, high=2e5),
    }
)


def check_ship_data(data: Any, source: str = "ship") -> dict[str, Any]:
    """Check plain data against the keys a ship file may hold.

    Parameters
    ----------
    data : mapping
        As read from YAML.
    source : str
        What to call it in errors.

    Returns
    -------
    dict
        The same data with numbers as floats, lists as tuples and the table as columns.

    Raises
    ------
    InputError
        For unknown keys (with near matches), wrong kinds, numbers that are NaN or out of range.
    """
    if not isinstance(data, Mapping):
        raise InputError(
            f"The {source} holds {_abbreviated(data)}, not keys with values.",
            f"Its keys are among: {', '.join([*TOP_LEVEL_KEYS, *SECTIONS])}.",
            "Write 'name: ...', 'hull: ...' and so on.",
        )
    checked: dict[str, Any] = {}
    for name, value in data.items():
        if name in TOP_LEVEL_KEYS:
            checked[name] = _check_value(str(name), value, TOP_LEVEL_KEYS[name])
        elif name in SECTIONS:
            rows = _columns(value) if name == "table" else value
            checked[name] = _check_section(str(name), rows, SECTIONS[name])
        else:
            raise _unknown_key_error(name, [*TOP_LEVEL_KEYS, *SECTIONS], "a ship file")
    if "name" not in checked:
        raise InputError(
            f"The {source} has no name.", "Every ship has one.", "Add 'name: ...'.", key="name"
        )
    return checked


def _check_section(section: str, values: Any, keys: Mapping[str, KeyRule]) -> dict[str, Any]:
    if not isinstance(values, Mapping):
        raise InputError(
            f"'{section}' holds {_abbreviated(values)}, not keys with values.",
            f"Its keys are among: {', '.join(keys)}.",
            "Indent the keys under it.",
            key=section,
        )
    for name in values:
        if name not in keys:
            raise _unknown_key_error(name, keys, f"'{section}'")
    return {
        name: _check_value(f"{section}.{name}", value, keys[name]) for name, value in values.items()
    }


def _columns(rows: Any) -> Any:
    """Turn a table given as a list of rows into columns."""
    if not isinstance(rows, Sequence) or isinstance(rows, str):
        return rows
    if not rows or not all(
        isinstance(row, Mapping) and row.keys() == rows[0].keys() for row in rows
    ):
        raise InputError(
            "The rows of 'table' do not all have the same keys.",
            f"A row holds keys among: {', '.join(_TABLE)}.",
            "Give every row the same keys, or give columns.",
            key="table",
        )
    return {name: [row[name] for row in rows] for name in rows[0]}


def _check_value(where: str, value: Any, key: KeyRule) -> Any:
    if key.kind in ("number", "count") or (
        key.kind == "word_or_number" and not isinstance(value, str)
    ):
        return _number(where, value, key)
    if key.kind == "numbers":
        many = value if isinstance(value, (list, tuple)) else [value]
        if not many:
            raise _invalid_value_error(where, value, "at least one number")
        return tuple(_number(where, one, key) for one in many)
    if key.kind == "flag":
        if not isinstance(value, bool):
            raise _invalid_value_error(where, value, "true or false")
        return value
    if key.kind == "texts":
        many = value if isinstance(value, (list, tuple)) else [value]
        if not all(isinstance(one, str) for one in many):
            raise _invalid_value_error(where, value, "text, or a list of texts")
        return tuple(many)
    if not isinstance(value, str) or not value.strip():
        raise _invalid_value_error(where, value, "text")
    if not key.words:
        return value
    word = value.strip().casefold().replace("-", "_").replace(" ", "_")
    if word not in key.words:
        raise unknown_name_error(f"{where}", value, key.words)
    return word


def _number(where: str, value: Any, key: KeyRule) -> float:
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        raise _invalid_value_error(where, value, "a number")
    try:
        number = float(value)
    except (ValueError, OverflowError):
        raise _invalid_value_error(where, value, "a number") from None
    if not math.isfinite(number):
        raise _invalid_value_error(where, value, "a finite number")
    if key.kind == "count" and number != round(number):
        raise _invalid_value_error(where, value, "a whole number")
    if not (key.low <= number <= key.high and number > key.above):
        raise _invalid_value_error(where, value, _range_words(key))
    return number


def _range_words(key: KeyRule) -> str:
    above = f"greater than {key.above:g}" if math.isfinite(key.above) else ""
    low = f"at least {key.low:g}" if math.isfinite(key.low) else ""
    high = f"at most {key.high:g}" if math.isfinite(key.high) else ""
    return " and ".join(part for part in (above, low, high) if part)


def _invalid_value_error(where: str, value: Any, wanted: str) -> InputError:
    return InputError(
        f"'{where}' is {_abbreviated(value)}.",
        f"It must be {wanted}.",
        "Correct it in the ship file.",
        key=where,
    )


def _unknown_key_error(name: Any, known: Any, place: str) -> InputError:
    near = close_matches(str(name)[:80], [str(k) for k in known])
    remedy = f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "Leave it out."
    return InputError(
        f"{_abbreviated(name)} is not a key of {place}.",
        f"Keys are: {', '.join(str(k) for k in known)}.",
        remedy,
        key=str(name)[:80],
        near=near,
    )


def _abbreviated(value: Any) -> str:
    if isinstance(value, (Mapping, list, tuple)):
        return f"a {type(value).__name__} of {len(value)}"
    return reprlib.repr(value)
