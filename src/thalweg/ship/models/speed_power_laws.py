"""Known calm-water speeds, and the laws of power and fuel over them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, KNOT, TONNE
from thalweg.ship.models.known_speed_model import KnownSpeedModel, cubic_law
from thalweg.ship.schema.ship_schema import ShipFile
from thalweg.ship.schema.table_section import TableSection


def speed_power_law_name(file: ShipFile) -> str:
    """Return the name of the law that ties fuel and power to speed."""
    name = file.models.calm_water
    if name is None:
        return "table" if file.table is not None else "cubic" if _has_reference(file) else "none"
    if name not in SPEED_POWER_LAWS:
        raise unknown_name_error("calm-water model", name, SPEED_POWER_LAWS)
    return name


def _has_reference(file: ShipFile) -> bool:
    return file.engine.reference_power_kw is not None or file.fuel.reference_t_per_day is not None


def calm_speeds(file: ShipFile, law: str) -> tuple[FloatArray, FloatArray]:
    """Calm-water speeds full and empty [m/s], ascending, from the only key that gives them.

    With the law ``table`` they are the speeds of the table, and ``speeds_kn`` are settings on it;
    with other laws ``speeds_kn`` are used and the speeds of a table are not.

    Parameters
    ----------
    law : Law of power over speed: ``"table"``, ``"cubic"`` or another.

    Raises
    ------
    InputError : If there is none, or more than one.
    """
    places = {
        "speeds_kn": file.speeds_kn,
        "table.speed_kn": None if file.table is None else file.table.speed_kn,
        "loading.speeds_full_kn": file.loading.speeds_full_kn,
    }
    given = {name: values for name, values in places.items() if values is not None}
    if {"speeds_kn", "table.speed_kn"} <= given.keys():
        del given["speeds_kn" if law == "table" else "table.speed_kn"]
    if not given and law == "cubic" and file.powers_kw is not None:
        given["engine.reference_speed_kn"] = (_reference_speed(file),)
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
    light = file.loading.speeds_empty_kn
    empty = full if light is None else np.array(light, float)
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


def _without_law(file: ShipFile, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    unknown = np.full(len(speeds), math.nan)
    return unknown, unknown


def _from_cubic_law(file: ShipFile, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fuel rates [kg/s] and powers [W] through the reference point.

    The fuel of the hotel load, which the reference contains, is the same at every speed.
    """
    speed_kn, power_kw, fuel_t_per_day = reference_point(file)
    reference = (speeds.max() / KNOT if speed_kn is None else speed_kn) * KNOT
    if power_kw is None and fuel_t_per_day is None:
        raise InputError(
            "The cubic law has no reference point.",
            "It goes through engine.reference_power_kw or fuel.reference_t_per_day at "
            "engine.reference_speed_kn (the highest speed when not given).",
            "Add one, or choose calm_water: none.",
            missing=["engine.reference_power_kw", "fuel.reference_t_per_day"],
        )
    engines = math.nan if fuel_t_per_day is None else fuel_of_engines(file, fuel_t_per_day)
    power = math.nan if power_kw is None else power_kw * 1000.0
    return (
        cubic_law(speeds, reference_speed=reference, reference_value=engines)
        + file.engine.hotel_fuel_rate,
        cubic_law(speeds, reference_speed=reference, reference_value=power),
    )


def fuel_of_engines(file: ShipFile, fuel_t_per_day: float) -> float:
    """Return the fuel rate of propulsion [kg/s] in a fuel rate of the whole ship [t/day].

    Raises
    ------
    InputError : If the hotel load takes all of it.
    """
    hotel = file.engine.hotel_fuel_rate
    engines = fuel_t_per_day * TONNE / DAY - hotel
    if engines > 0.0 or hotel == 0.0:
        return engines
    raise InputError(
        f"The ship's fuel is {fuel_t_per_day:g} t a day, and its hotel load takes "
        f"{hotel * DAY / TONNE:.3g} t of it.",
        "The fuel of a day at sea is that of the whole ship: propulsion and hotel load.",
        "Correct fuel.reference_t_per_day or engine.hotel_load_kw.",
        key="engine.hotel_load_kw",
    )


class ReferencePoint(NamedTuple):
    """The point through which the cubic law goes; None for what the file does not give."""

    speed_kn: float | None
    power_kw: float | None
    fuel_t_per_day: float | None


def reference_point(file: ShipFile) -> ReferencePoint:
    """Return the reference point of the sections engine and fuel, or else the table's last row."""
    engine, table = file.engine, file.table
    if _has_reference(file) or table is None or table.speed_kn is None:
        return ReferencePoint(
            engine.reference_speed_kn, engine.reference_power_kw, file.fuel.reference_t_per_day
        )
    check_table(table)
    last = int(np.argmax(table.speed_kn))
    power, fuel = table.power_kw, table.daily_fuel
    return ReferencePoint(
        table.speed_kn[last],
        None if power is None else power[last],
        None if fuel is None else fuel[last],
    )


def _reference_speed(file: ShipFile) -> float:
    """Speed of the reference point [kn], for settings that are powers.

    Raises
    ------
    InputError
    """
    speed = reference_point(file).speed_kn
    if speed is None:
        raise InputError(
            "The cubic law has no reference speed.",
            "It turns powers_kw into speeds through engine.reference_power_kw at "
            "engine.reference_speed_kn.",
            "Add both, or give speeds_kn.",
            missing=["engine.reference_speed_kn"],
        )
    return speed


def with_settings(model: KnownSpeedModel, file: ShipFile) -> KnownSpeedModel:
    """Return the model with the ordered settings of a ship file, on its table or cubic law.

    Parameters
    ----------
    model : The model without settings of the file.
    file : With ``powers_kw`` or ``speeds_kn``.

    Returns
    -------
    KnownSpeedModel : With one setting for each value.

    Raises
    ------
    InputError : If powers and speeds are given, or no law ties the powers to speeds in its range.
    """
    speeds, powers = file.speeds_kn, file.powers_kw
    if powers is None:
        if speeds is None or model.law.name != "table":
            return model
        return model.with_speeds(np.unique(speeds) * KNOT, 1.0)
    file.check_one_kind_of_order()
    watts = np.unique(powers) * 1000.0
    known = np.isfinite(model.powers).all() and (np.diff(model.powers) > 0.0).all()
    if model.law.name == "none" or not known:
        raise InputError(
            "powers_kw is given, but the ship file does not relate power to speed.",
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
            f"powers_kw requests {watts[0] / 1e3:g} to {watts[-1] / 1e3:g} kW.",
            f"The table runs from {model.powers[0] / 1e3:g} to {model.powers[-1] / 1e3:g} kW.",
            "Give powers in that range.",
            key="powers_kw",
        )
    return model.with_speeds(np.interp(watts, model.powers, model.speeds_full), 1.0)


def check_table(table: TableSection | None) -> dict[str, tuple[float, ...]]:
    """Return the columns of a table.

    Raises
    ------
    InputError : If there is no table, it has no speeds, or its columns differ in length.
    """
    if table is None or table.speed_kn is None:
        raise InputError(
            "calm_water: table is chosen, but the ship file has no table with speed_kn.",
            "A table has columns speed_kn and fuel_t_per_day (or fuel_kg_per_h), power_kw or both.",
            "Add 'table:', or choose another calm_water model.",
            missing=["table.speed_kn"],
        )
    given = table.plain()
    ragged = {name for name, column in given.items() if len(column) != len(table.speed_kn)}
    if ragged:
        raise InputError(
            f"In the ship's table {', '.join(sorted(ragged))} has another length than speed_kn.",
            "Every row has every column.",
            "Fill the missing numbers.",
            key="table",
        )
    return table.columns


def _from_table(file: ShipFile, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Fuel rates [kg/s] and powers [W] of the table's rows, in the order of speed."""
    table = check_table(file.table)
    order = np.argsort(table["speed_kn"], kind="stable")
    blank = [math.nan] * len(order)
    power = np.array(table.get("power_kw", blank), float)[order] * 1000.0
    fuel = np.array(table.get("fuel_t_per_day", blank), float)[order] * TONNE / DAY
    return fuel, power


SPEED_POWER_LAWS: Final[
    dict[str, Callable[[ShipFile, FloatArray], tuple[FloatArray, FloatArray]]]
] = {
    "none": _without_law,
    "cubic": _from_cubic_law,
    "table": _from_table,
}
