"""Tables of resistance-based ships: the resistance of wind, waves and depth at each of many speeds.

At one speed the resistances of wind, waves and depth add up. So the table has each on its own
axes, for a column of speeds, and finds the speed at which they leave the engines nothing to spare
(see `thalweg.ship.tables.output_curve`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import ModelRangeError
from thalweg.core.types import FloatArray
from thalweg.kernels.leg.table_lookup import CURVE_REFINEMENT
from thalweg.ship.models.force_balance import ForceBalance, calm_conditions
from thalweg.ship.models.resistance_protocol import LARGEST_SPEED_FACTOR, TabulatedResistance
from thalweg.ship.models.resistance_terms import (
    ResistanceTerm,
    condition_axes,
    conditions_per_setting,
    random_term_conditions,
    resistance_terms,
)
from thalweg.ship.models.root_finding import bracketed_root
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_cache import TableWithMaxima
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import constant_part, random_conditions, table_error

_SPEED_COLUMNS: Final = 25
ERROR_SAMPLES: Final = 3000  #: random conditions at which errors are measured
_REFINEMENT_SAMPLES: Final = 1500  #: others, by which grids are refined
_REFINEMENT_ROUNDS: Final = 6
_BOUND_MARGIN: Final = 1.005
_LARGEST_TABLE_BYTES: Final = 48_000_000  #: bytes


def tabulate_balance(
    model: TabulatedResistance, load_factor: float, tolerance: float
) -> TableWithMaxima:
    """Tabulate the speed through water of every setting.

    Parameters
    ----------
    tolerance : See `thalweg.ship.tables.tabulate.table_error`.

    Returns
    -------
    table : Its error is against the methods themselves, at random conditions.
    top : Greatest speed of every setting [m/s]: no condition in the table's ranges gives more.

    Raises
    ------
    ModelRangeError : If power does not rise with speed somewhere.
    """
    balance, calm = model.balance(load_factor), model.speeds(load_factor)
    check_power_rises(model, load_factor)
    terms = resistance_terms(balance, model.limits)
    if not terms:
        part = constant_part(calm)
        return PerformanceTable((part,), calm, "", TableError(0.0, 0.0, 0.0, 0)), calm
    fastest = LARGEST_SPEED_FACTOR * float(calm.max())
    speeds = np.linspace(0.0, fastest, _SPEED_COLUMNS)
    finish = _resistance_reserve_curve(model, load_factor, speeds)

    def truth(points: Mapping[str, FloatArray]) -> FloatArray:
        at, which, shape = conditions_per_setting(points, len(calm))
        return model.speed_of(balance, at, which, load_factor).reshape(shape)

    table = refined_table(
        terms,
        speeds,
        finish,
        calm,
        truth=truth,
        tolerance=tolerance,
        scale=_force_scale(finish, speeds),
    )
    bound = np.array([table.largest(k) for k in range(len(calm))])
    return table, _BOUND_MARGIN * np.maximum(bound, calm)


def refined_table(
    terms: list[ResistanceTerm],
    speeds: FloatArray,
    finish: OutputCurve,
    calm: FloatArray,
    *,
    truth: Callable[[Mapping[str, FloatArray]], FloatArray],
    tolerance: float,
    scale: FloatArray,
) -> PerformanceTable:
    """Tabulate terms, and refine the worst of them until the error meets the tolerance.

    Parameters
    ----------
    speeds : Of the columns [m/s].
    calm : Settings of the table [m/s].
    truth : The true values of all settings in conditions by name.
    tolerance : float
        It stops at 0.8 of this at the conditions of the refinement; the error is that at others.
    scale : What counts as a large change of each column [N].
    """
    parts = [term.part(speeds) for term in terms]
    points = random_term_conditions(terms, _REFINEMENT_SAMPLES, 5)
    true = truth(points)
    for _ in range(_REFINEMENT_ROUNDS):
        table = PerformanceTable(tuple(parts), calm, "", TableError(0, 0, 0), finish)
        if (
            _error(table, points, true).p99 <= 0.8 * tolerance
            or 2 * table.nbytes > _LARGEST_TABLE_BYTES
        ):
            break
        worst = _worst_term(terms, parts, speeds, points, scale)
        terms = [*terms]
        terms[worst] = terms[worst].refined(parts[worst], scale)
        parts[worst] = terms[worst].part(speeds)
    fresh = random_term_conditions(terms, ERROR_SAMPLES, 7)
    return replace(table, error=_error(table, fresh, truth(fresh)))


def _error(
    table: PerformanceTable, points: Mapping[str, FloatArray], true: FloatArray
) -> TableError:
    """Measure a table at conditions where the true values are known."""
    where = {name: values[:, None] for name, values in points.items()}
    return table_error(table.lookup(where, np.arange(len(table.settings))), true)


def _worst_term(
    terms: list[ResistanceTerm],
    parts: list[TablePart],
    speeds: FloatArray,
    points: Mapping[str, FloatArray],
    scale: FloatArray,
) -> int:
    """Return the index of the term with the largest table error."""
    errors = []
    for term, part in zip(terms, parts):
        at = [points[axis.name][:, None] for axis in term.axes]
        true = term.force(speeds, *at)
        if not np.isnan(term.squared_height_limit):
            true = true * points["wave_height"][:, None] ** 2
        missed = np.abs(part.lookup_all(points) - true) / scale
        errors.append(float(np.nanquantile(missed, 0.99)))
    return int(np.argmax(errors))


def _force_scale(finish: OutputCurve, speeds: FloatArray) -> FloatArray:
    """Force scale [N] of each column: speed times the slope of the resistance."""
    curve = finish.points[:, ::CURVE_REFINEMENT]
    curve = np.where(np.isfinite(curve), curve, np.nan)
    slope = np.fmax.reduce(np.abs(np.gradient(curve[:, 1:], speeds[1:], axis=1)), axis=0, initial=0)
    slope = np.concatenate([slope[:1], slope])
    return np.maximum(speeds, 0.25 * speeds[-1]) * np.maximum(slope, 1e-3 * slope.max() + 1e-9)


def _resistance_reserve_curve(
    model: TabulatedResistance, load_factor: float, speeds: FloatArray
) -> OutputCurve:
    """Resistance reserve [N] of settings in calm, deep water at and between the columns' speeds."""
    balance, calm = model.balance(load_factor), model.speeds(load_factor)
    held = model.orders.kind == "speed"
    powers = np.array([model.plant.largest_power] if held else model.orders.values)
    fine = np.linspace(speeds[0], speeds[-1], CURVE_REFINEMENT * (len(speeds) - 1) + 1)
    spare = (resistance_at_power(balance, fine, powers) - calm_resistance(balance, fine)).T
    count, step = len(calm), float(speeds[1] - speeds[0])
    return OutputCurve(
        kind="crossing",
        start=np.zeros(count),
        step=np.full(count, step / CURVE_REFINEMENT),
        points=np.array(np.broadcast_to(spare, (count, fine.size))),
        top=calm if held else LARGEST_SPEED_FACTOR * calm,
        guess=np.clip((calm / step).astype(np.int64), 0, len(speeds) - 1),
    )


def calm_resistance(balance: ForceBalance, speeds: FloatArray) -> FloatArray:
    """Resistance in calm, deep water without wind [N], as a column.

    Parameters
    ----------
    balance : Forces of the ship at one draught.
    speeds : Speeds through water [m/s], (n,).

    Returns
    -------
    ndarray (n, 1) : Resistance [N].
    """
    return balance.resistance(calm_conditions(len(speeds)), speeds)[:, None]


def resistance_at_power(
    balance: ForceBalance, speeds: FloatArray, powers: FloatArray
) -> FloatArray:
    """Resistance [N] that takes exactly the powers [W], at every speed; shape (speeds, powers).

    Parameters
    ----------
    balance : Forces of the ship at one draught.
    speeds : Speeds through water [m/s], (n,).
    powers : Brake powers [W], (m,).

    Returns
    -------
    ndarray (n, m) : Resistance [N].
    """
    top = 200.0 * float(np.max(balance.calm.total(speeds[-1:], np.array([np.inf]))))
    v, p = (grid.ravel() for grid in np.meshgrid(speeds, powers, indexing="ij"))
    if np.isinf(p).any():
        return np.full((len(speeds), len(powers)), np.inf)

    def excess(resistance: FloatArray, index: NDArray[np.intp]) -> FloatArray:
        return balance.propulsion.brake_power(v[index], resistance) - p[index]

    root = bracketed_root(excess, np.zeros(v.size), np.full(v.size, top), tolerance=1e-6 * top)
    return root.reshape(len(speeds), len(powers))


def check_power_rises(model: TabulatedResistance, load_factor: float) -> None:
    """Refuse a ship whose power falls while its speed rises, calm or in weather."""
    balance = model.balance(load_factor)
    ranges = condition_axes(balance, model.limits)
    top = float(model.speeds(load_factor).max())
    ladder = np.linspace(0.3, 1.0, 36) * top
    draws = random_conditions(list(ranges.values()), 24, 3)
    at = {name: np.repeat(values, ladder.size) for name, values in draws.items()}
    at = {**calm_conditions(24 * ladder.size), **at}
    at["wave_height"] = 0.4 * at["wave_height"]
    power = balance.brake_power(at, np.tile(ladder, 24)).reshape(24, -1)
    falls = np.argwhere(np.diff(power, axis=1) < -1e-6 * np.nanmax(power))
    if falls.size:
        case, step = falls[0]
        raise ModelRangeError(
            f"The ship's power falls from {power[case, step] / 1e3:.0f} to "
            f"{power[case, step + 1] / 1e3:.0f} kW while its speed rises from {ladder[step]:.2f} "
            f"to {ladder[step + 1]:.2f} m/s.",
            "A speed at a power can be found only where power rises with speed.",
            "Choose other methods for calm or shallow water, or a lower range of speeds.",
        )
