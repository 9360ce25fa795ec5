"""Ships that give their calm-water speeds: which, and the law of power and fuel over them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, KNOT, TONNE
from thalweg.ship.models.known_speed_model import KnownSpeedModel, cubic_law

ShipData = Mapping[str, Any]


def speed_power_law_name(data: ShipData) -> str:
    """Which law ties fuel and power to speed."""
    name = data.get("models", {}).get("calm_water")
    if name is None:
        return "table" if "table" in data else "cubic" if _has_reference(data) else "none"
    if name not in SPEED_POWER_LAWS:
        raise unknown_name_error("calm-water model", name, SPEED_POWER_LAWS)
    return str(name)


def _has_reference(data: ShipData) -> bool:
    return "reference_power_kw" in data.get("engine", {}) or "reference_t_per_day" in data.get(
        "fuel", {}
    )


def calm_speeds(data: ShipData, law: str) -> tuple[FloatArray, FloatArray]:
    """Calm-water speeds full and empty [m/s], ascending, from the one place that gives them.

    The law of a table has those of the table, and ``speeds_kn`` are settings on it; for other laws
    it is the other way round.

    Raises
    ------
    InputError
        If there is none, or more than one.
    """
    loading = data.get("loading", {})
    places = {
        "speeds_kn": data.get("speeds_kn"),
        "table.speed_kn": data.get("table", {}).get("speed_kn"),
        "loading.speeds_full_kn": loading.get("speeds_full_kn"),
    }
    given = {name: values for name, values in places.items() if values is not None}
    if {"speeds_kn", "table.speed_kn"} <= given.keys():
        del given["speeds_kn" if law == "table" else "table.speed_kn"]
    if not given and law == "cubic" and "powers_kw" in data:
        given["engine.reference_speed_kn"] = [_reference_speed(data)]
    if len(given) != 1:
        found = f"gives speeds under {' and '.join(given)}" if given else "gives no speeds"
        raise InputError(
            f"The ship file {found}.",
            "Speeds come from speeds_kn, from a table, or from loading.speeds_full_kn; a hull with "
            "models.calm_water such as holtrop_1984 finds its own.",
            "Keep one of them." if given else "Add 'speeds_kn: [...]'.",
            missing=[] if given else ["speeds_kn"],
        )
    full = np.array(next(iter(given.values())), float)
    empty = np.array(loading.get("speeds_empty_kn", full), float)
    if empty.shape != full.shape:
        raise InputError(
            f"There are {len(full)} speeds full and {len(empty)} speeds empty.",
            "Each setting has one of both.",
            "Give loading.speeds_empty_kn as many numbers.",
            key="loading.speeds_empty_kn",
        )
    order = np.argsort(full, kind="stable")
    if (np.diff(full[order]) <= 0).any() or (np.diff(empty[order]) <= 0).any():
        raise InputError(
            "A speed is given twice.",
            "Each setting has its own speed, full and empty in the same order.",
            "Remove one of them.",
            key=next(iter(given)),
        )
    return full[order] * KNOT, empty[order] * KNOT


def _without_law(data: ShipData, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    unknown = np.full(len(speeds), math.nan)
    return unknown, unknown


def _from_cubic_law(data: ShipData, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fuel rates [kg/s] and powers [W] through the reference point."""
    engine, fuel = _reference_sections(data)
    reference = engine.get("reference_speed_kn", speeds.max() / KNOT) * KNOT
    if not {"reference_power_kw", "reference_t_per_day"} & {*engine, *fuel}:
        raise InputError(
            "The cubic law has no reference point.",
            "It goes through engine.reference_power_kw or fuel.reference_t_per_day at "
            "engine.reference_speed_kn (the highest speed when not given).",
            "Add one, or choose calm_water: none.",
            missing=["engine.reference_power_kw", "fuel.reference_t_per_day"],
        )
    power_kw = engine.get("reference_power_kw", math.nan)
    burnt = fuel.get("reference_t_per_day", math.nan) * TONNE / DAY
    return (
        cubic_law(speeds, reference_speed=reference, reference_value=burnt),
        cubic_law(speeds, reference_speed=reference, reference_value=power_kw * 1000.0),
    )


def _reference_sections(data: ShipData) -> tuple[ShipData, ShipData]:
    """The sections engine and fuel with the reference point; the table's last row without one."""
    engine, fuel, table = (data.get(name, {}) for name in ("engine", "fuel", "table"))
    if _has_reference(data) or "speed_kn" not in table:
        return engine, fuel
    check_table(data)
    last = int(np.argmax(table["speed_kn"]))
    engine = {**engine, "reference_speed_kn": table["speed_kn"][last]}
    if "power_kw" in table:
        engine["reference_power_kw"] = table["power_kw"][last]
    if "fuel_t_per_day" in table:
        fuel = {**fuel, "reference_t_per_day": table["fuel_t_per_day"][last]}
    return engine, fuel


def _reference_speed(data: ShipData) -> float:
    """Speed of the reference point [kn], for settings that are powers.

    Raises
    ------
    InputError
    """
    speed = _reference_sections(data)[0].get("reference_speed_kn")
    if speed is None:
        raise InputError(
            "The cubic law has no reference speed.",
            "It turns powers_kw into speeds through engine.reference_power_kw at "
            "engine.reference_speed_kn.",
            "Add both, or give speeds_kn.",
            missing=["engine.reference_speed_kn"],
        )
    return float(speed)


def with_settings(model: KnownSpeedModel, data: ShipData) -> KnownSpeedModel:
    """Return the model with the settings a ship file asks for on its table or cubic law.

    Raises
    ------
    InputError
        If powers and speeds are given, or no law ties the powers to speeds in its range.
    """
    speeds, powers = data.get("speeds_kn"), data.get("powers_kw")
    if powers is None:
        if speeds is None or model.law.name != "table":
            return model
        return model.with_speeds(np.unique(speeds) * KNOT, 1.0)
    if speeds is not None:
        raise InputError(
            "The ship file gives both powers_kw and speeds_kn.",
            "A ship keeps either a power or a speed.",
            "Keep one of them.",
            key="powers_kw",
        )
    watts = np.unique(powers) * 1000.0
    known = np.isfinite(model.powers).all() and (np.diff(model.powers) > 0.0).all()
    if model.law.name == "none" or not known:
        raise InputError(
            "powers_kw is given, but the ship file does not tie power to speed.",
            "A table with rising power_kw does, the cubic law with engine.reference_power_kw, or "
            "a calm_water method with a hull.",
            "Give speeds_kn, or one of those.",
            key="powers_kw",
        )
    if model.law.name == "cubic":
        top = model.speeds_full[-1] * np.cbrt(watts / model.powers[-1])
        return model.with_speeds(top, 1.0)
    if watts[0] < model.powers[0] * (1 - 1e-9) or watts[-1] > model.powers[-1] * (1 + 1e-9):
        raise InputError(
            f"powers_kw asks for {watts[0] / 1e3:g} to {watts[-1] / 1e3:g} kW.",
            f"The table runs from {model.powers[0] / 1e3:g} to {model.powers[-1] / 1e3:g} kW.",
            "Ask for powers inside.",
            key="powers_kw",
        )
    return model.with_speeds(np.interp(watts, model.powers, model.speeds_full), 1.0)


def check_table(data: ShipData) -> None:
    """Refuse a table that is not there, or whose columns differ in length.

    Raises
    ------
    InputError
    """
    table = data.get("table")
    if table is None or "speed_kn" not in table:
        raise InputError(
            "calm_water: table is chosen, but the ship file has no table with speed_kn.",
            "A table has columns speed_kn and fuel_t_per_day, power_kw or both.",
            "Add 'table:', or choose another calm_water model.",
            missing=["table.speed_kn"],
        )
    ragged = {name for name, column in table.items() if len(column) != len(table["speed_kn"])}
    if ragged:
        raise InputError(
            f"In the ship's table {', '.join(sorted(ragged))} has another length than speed_kn.",
            "Every row has every column.",
            "Fill the missing numbers.",
            key="table",
        )


def _from_table(data: ShipData, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fuel rates [kg/s] and powers [W] of the table's rows, in the order of speed."""
    table = data["table"]
    order = np.argsort(table["speed_kn"], kind="stable")
    blank = [math.nan] * len(order)
    power = np.array(table.get("power_kw", blank), float)[order] * 1000.0
    fuel = np.array(table.get("fuel_t_per_day", blank), float)[order] * TONNE / DAY
    return fuel, power


SPEED_POWER_LAWS: Final[
    dict[str, Callable[[ShipData, FloatArray], tuple[FloatArray, FloatArray]]]
] = {
    "none": _without_law,
    "cubic": _from_cubic_law,
    "table": _from_table,
}
