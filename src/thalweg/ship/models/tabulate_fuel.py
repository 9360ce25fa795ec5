"""Tables of the fuel rate [kg/s] and the power [W] of a setting in the weather the ship meets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import AXIS_OF_CONDITION
from thalweg.ship.model_protocol import (
    FuelTableModel,
    ModelTables,
    PowerTableModel,
    ShipModel,
    Tabulation,
)
from thalweg.ship.models.force_balance import ForceBalance
from thalweg.ship.models.function_model import FunctionModel
from thalweg.ship.models.resistance_protocol import TabulatedResistance
from thalweg.ship.models.resistance_terms import (
    conditions_per_setting,
    random_term_conditions,
    resistance_terms,
)
from thalweg.ship.models.tabulate_resistance import (
    ERROR_SAMPLES,
    calm_resistance,
    refined_table,
    resistance_at_power,
)
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_cache import TableWithMaxima
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import (
    DEFAULT_AXES,
    RateFunction,
    constant_part,
    table_error,
    tabulate_settings,
)  # fmt: skip

_CURVE_POINTS: Final = 1025  #: of the curves of fuel and power
RateOfPower = Callable[[FloatArray], FloatArray]


def fuel_table(
    model: ShipModel, load_factor: float, tolerance: float, *, ship: str
) -> PerformanceTable:
    """Tabulate the fuel rate of a ship.

    Parameters
    ----------
    load_factor : 0 empty to 1 full.
    tolerance : Relative error that 99 % of random conditions should meet.
    ship : Name of the ship, for errors.

    Returns
    -------
    PerformanceTable : Fuel rate [kg/s], hotel load included; without a fingerprint.

    Raises
    ------
    InputError : If the fuel is unknown, or the speed is a field.
    """
    own = model.tabulate_fuel if isinstance(model, FuelTableModel) else None
    found = _table_of_rate(model, (load_factor, tolerance), own, model.fuel_rate)
    if isinstance(found, str):
        raise _unknown_fuel_error(ship, found.format("fuel rate"))
    return found


def power_table(
    model: ShipModel, load_factor: float, tolerance: float, *, hotel_power: float, ship: str
) -> PerformanceTable:
    """Tabulate the brake power of a ship, with its hotel load.

    Parameters as in `fuel_table`, and ``hotel_power`` [W].

    Returns
    -------
    PerformanceTable : Power [W]; without a fingerprint.

    Raises
    ------
    InputError : If the power is unknown, or the speed is a field.
    """
    own = model.tabulate_power if isinstance(model, PowerTableModel) else None
    table = _table_of_rate(model, (load_factor, tolerance), own, model.power)
    if isinstance(table, str):
        raise _unknown_power_error(ship, table.format("brake power"))
    if table.finish is not None:
        points = table.finish.points + hotel_power
        return replace(table, finish=replace(table.finish, points=points))
    hotel = constant_part(np.full(table.settings.size, hotel_power))
    return replace(table, parts=(*table.parts, hotel))


def _table_of_rate(
    model: ShipModel,
    accuracy: tuple[float, float],
    own: Callable[[float, float], ModelTables] | None,
    rate: RateFunction,
) -> PerformanceTable | str:
    """Return the table of a rate at a load factor and tolerance, or why there is none.

    The model makes it by its own method, where it has one.
    """
    load_factor, tolerance = accuracy
    if own is not None:
        found = Tabulation(*own(load_factor, tolerance))
    elif isinstance(model, FunctionModel) and model.is_speed_field:
        return "its speed is a field of place and time"
    else:
        found = tabulate_rate(model, rate, load_factor, tolerance)
    speeds = model.speeds(load_factor)
    table = PerformanceTable(found.parts, speeds, "", found.error, found.curve)
    known = all(math.isfinite(table.largest(k)) for k in range(speeds.size))
    return table if known else "its {} is unknown"


def _unknown_fuel_error(ship: str, why: str) -> InputError:
    return InputError(
        f"The fuel of {ship!r} cannot be tabulated: {why}.",
        "A fuel model is a table with fuel_t_per_day, fuel.reference_t_per_day, or a resistance "
        "with engine.type, engine.sfoc_g_per_kwh or a curve of it.",
        "Add one to the ship file, or choose the objective 'time'.",
        ship=ship,
    )


def _unknown_power_error(ship: str, why: str) -> InputError:
    return InputError(
        f"The power of {ship!r} cannot be tabulated: {why}.",
        "Power comes from a resistance (models.calm_water such as holtrop_1984), a table with "
        "power_kw, or the cubic law with engine.reference_power_kw.",
        "Add one to the ship file, or choose the objective 'fuel' or 'time'.",
        ship=ship,
    )


def tabulate_rate_of_power(
    model: TabulatedResistance, load_factor: float, tolerance: float, of_power: RateOfPower
) -> TableWithMaxima:
    """Tabulate what follows from the power of every setting of a resistance-based ship.

    A setting of power has the same power in all weather: one constant. A setting of speed has the
    power required to maintain that speed, up to the available power: the resistances of wind, waves
    and depth at that speed add up, and a curve over the sum gives the power or the fuel.

    Parameters
    ----------
    tolerance : See `thalweg.ship.tables.tabulate.table_error`.
    of_power : The rate of a brake power [W].

    Returns
    -------
    table : Its error is against the methods themselves, at random conditions.
    top : Greatest rate of every setting.
    """
    balance, speeds = model.balance(load_factor), model.speeds(load_factor)
    terms = resistance_terms(balance, model.limits)

    def rates(where: Mapping[str, FloatArray]) -> FloatArray:
        at, which, shape = conditions_per_setting(where, len(speeds))
        power = model.power_of(balance, at, which, load_factor)
        return of_power(power).reshape(shape)

    if model.orders.kind == "power" or not terms:
        steady = rates({"depth": np.asarray(np.inf)})
        if model.orders.kind == "power":
            steady = of_power(np.array(model.orders.values))
        error = TableError(0.0, 0.0, 0.0, 0)
        if terms:
            true = rates(random_term_conditions(terms, ERROR_SAMPLES, 7))
            error = table_error(np.where(np.isnan(true), np.nan, steady), true)
        return PerformanceTable((constant_part(steady),), speeds, "", error), steady
    parts = [term.part(speeds) for term in terms]
    finish = _rate_curve(model, balance, speeds, parts=parts, of_power=of_power)
    scale = calm_resistance(balance, speeds)[:, 0]
    table = refined_table(
        terms, speeds, finish, speeds, truth=rates, tolerance=tolerance, scale=scale
    )
    return table, np.array([table.largest(k) for k in range(len(speeds))])


def _rate_curve(
    model: TabulatedResistance,
    balance: ForceBalance,
    speeds: FloatArray,
    *,
    parts: list[TablePart],
    of_power: RateOfPower,
) -> OutputCurve:
    """The rate over the resistance [N] that conditions add, at each held speed."""
    still = calm_resistance(balance, speeds)[:, 0]
    limit = np.array([model.plant.largest_power])
    most = np.sum([part.greatest() for part in parts], axis=0)
    spare = np.minimum(
        resistance_at_power(balance, speeds, limit)[:, 0] - still, np.maximum(most, 0.01 * still)
    )
    extra = -still[:, None] + (still + spare)[:, None] * np.linspace(0.0, 1.0, _CURVE_POINTS)
    v, resistance = np.repeat(speeds, _CURVE_POINTS), (still[:, None] + extra).ravel()
    power = np.minimum(balance.propulsion.brake_power(v, resistance), limit)
    start, step = extra[:, 0], extra[:, 1] - extra[:, 0]
    points = of_power(power).reshape(extra.shape)
    nothing = np.zeros(len(speeds))
    return OutputCurve("curve", start, step, points, nothing, nothing.astype(np.int64))


def tabulate_rate(
    model: ShipModel, rate: RateFunction, load_factor: float, tolerance: float
) -> Tabulation:
    """Tabulate a rate of any model over all conditions it reads, in one part."""
    names = sorted(model.reads & AXIS_OF_CONDITION.keys(), key=AXIS_OF_CONDITION.__getitem__)
    axes, count = [DEFAULT_AXES[name] for name in names], len(model.speeds(load_factor))
    return Tabulation(*tabulate_settings(rate, axes, count, load_factor, tolerance=tolerance))
