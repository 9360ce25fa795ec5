"""Tables of the fuel rate [kg/s] and the power [W] of a setting in the weather the ship meets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import AXIS_OF_CONDITION
from thalweg.ship.conditions import Conditions
from thalweg.ship.model_protocol import ShipModel
from thalweg.ship.models.force_balance import ForceBalance
from thalweg.ship.models.fuel_from_power import hotel_power
from thalweg.ship.models.resistance_model import ResistanceModel
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.performance_table import PerformanceTable, TableError, TablePart
from thalweg.ship.tables.table_cache import TableWithMaxima
from thalweg.ship.tables.tabulate import DEFAULT_AXES, constant_part, table_error, tabulate_dense
from thalweg.ship.tables.tabulate_resistance import (
    ERROR_SAMPLES,
    calm_resistance,
    conditions_per_setting,
    random_term_conditions,
    refined_table,
    resistance_at_power,
    resistance_terms,
)

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

_CURVE_POINTS: Final = 1025  #: of the curves of fuel and power
#: Rates that models may tabulate themselves: by which method, and what they are called.
_RATE_METHODS: Final = {
    "fuel_rate": ("tabulate_fuel", "fuel rate"),
    "power": ("tabulate_power", "brake power"),
}
RateOfPower = Callable[[FloatArray], FloatArray]
RateFunction = Callable[[Conditions, NDArray[np.intp]], FloatArray]


def fuel_table(ship: Ship, tolerance: float) -> PerformanceTable:
    """Tabulate a ship's fuel rate; see `Ship.tabulate_fuel`.

    Raises
    ------
    InputError
        If the fuel is unknown, or the speed is a field.
    """
    return _rate_table(ship, tolerance, "fuel_rate", _unknown_fuel_error)


def power_table(ship: Ship, tolerance: float) -> PerformanceTable:
    """Tabulate a ship's brake power and hotel load; see `Ship.tabulate_power`.

    Raises
    ------
    InputError
        If the power is unknown, or the speed is a field.
    """
    table = _rate_table(ship, tolerance, "power", _unknown_power_error)
    hotel = hotel_power(ship.data)
    if table.finish is not None:
        return replace(table, finish=replace(table.finish, points=table.finish.points + hotel))
    return replace(table, parts=(*table.parts, constant_part(np.full(len(ship.speeds), hotel))))


def _rate_table(
    ship: Ship, tolerance: float, name: str, refused: Callable[[Ship, str], InputError]
) -> PerformanceTable:
    """Tabulate a rate by the model's own way, or over all that the model reads."""
    if ship.speed_field is not None:
        raise refused(ship, "its speed is a field of place and time")
    own, words = _RATE_METHODS[name]
    rate = getattr(ship.model, name)
    make = getattr(ship.model, own, None) or partial(tabulate_rate, ship.model, rate)
    parts, error, *more = make(ship.loading.load_factor, tolerance)
    finish = more[0] if more else None
    table = PerformanceTable(parts, ship.speeds, ship.fingerprint(), error, finish)
    if not all(math.isfinite(table.largest(k)) for k in range(len(ship.speeds))):
        raise refused(ship, f"its {words} is unknown")
    return table


def _unknown_fuel_error(ship: Ship, why: str) -> InputError:
    return InputError(
        f"The fuel of {ship.name!r} cannot be tabulated: {why}.",
        "A fuel model is a table with fuel_t_per_day, fuel.reference_t_per_day, or a resistance "
        "with engine.type, engine.sfoc_g_per_kwh or a curve of it.",
        "Add one to the ship file, or ask for the least time.",
        ship=ship.name,
    )


def _unknown_power_error(ship: Ship, why: str) -> InputError:
    return InputError(
        f"The power of {ship.name!r} cannot be tabulated: {why}.",
        "Power comes from a resistance (models.calm_water such as holtrop_1984), a table with "
        "power_kw, or the cubic law with engine.reference_power_kw.",
        "Add one to the ship file, or ask for the least fuel or time.",
        ship=ship.name,
    )


def tabulate_fuel_of_balance(
    model: ResistanceModel, load_factor: float, tolerance: float
) -> TableWithMaxima:
    """Tabulate the fuel rate [kg/s] of a resistance-based ship; see `_tabulate_rate_of_power`."""
    return _tabulate_rate_of_power(model, load_factor, tolerance, model.plant.fuel)


def tabulate_power_of_balance(
    model: ResistanceModel, load_factor: float, tolerance: float
) -> TableWithMaxima:
    """Tabulate the brake power [W] of a resistance-based ship; see `_tabulate_rate_of_power`."""
    return _tabulate_rate_of_power(model, load_factor, tolerance, np.asarray)


def _tabulate_rate_of_power(
    model: ResistanceModel, load_factor: float, tolerance: float, of_power: RateOfPower
) -> TableWithMaxima:
    """Tabulate what follows from the power of every setting of a resistance-based ship.

    A setting of power takes the same in all weather: one constant. A setting of speed takes what
    holding it asks for, up to all that the engines give: what wind, waves and depth ask for at that
    speed adds up, and a curve over the sum is the power, or the fuel.

    Parameters
    ----------
    model : ResistanceModel
    load_factor : float
    tolerance : float
        See `thalweg.ship.tables.tabulate.table_error`.
    of_power : callable
        The rate of a brake power [W].

    Returns
    -------
    table : PerformanceTable
        Its error is against the methods themselves, at random conditions.
    top : ndarray
        Greatest rate of every setting.
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
    model: ResistanceModel,
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
) -> tuple[tuple[TablePart, ...], TableError]:
    """Tabulate a rate of any model over all conditions it reads, in one part."""
    names = sorted(model.reads & AXIS_OF_CONDITION.keys(), key=AXIS_OF_CONDITION.__getitem__)
    settings = np.arange(len(model.speeds(load_factor)))

    def rates(where: Mapping[str, FloatArray]) -> FloatArray:
        columns = {name: np.asarray(values)[..., None] for name, values in where.items()}
        return rate(Conditions(columns, load_factor=load_factor), settings)

    if not names:
        return (constant_part(rates({})),), TableError(0.0, 0.0, 0.0, 0)
    part, error = tabulate_dense(rates, [DEFAULT_AXES[n] for n in names], tolerance=tolerance)
    return (part,), error
