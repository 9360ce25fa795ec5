"""Tables of resistance-based ships: the resistance of wind, waves and depth at each of many speeds.

At one speed the resistances of wind, waves and depth add up. So the table has each on its own
axes, for a column of speeds, and finds the speed at which they leave the engines nothing to spare
(see `thalweg.ship.tables.output_curve`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import ModelRangeError
from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import CURVE_REFINEMENT
from thalweg.ship.models.added_resistance_model import AddedWaveResistance
from thalweg.ship.models.force_balance import ForceBalance
from thalweg.ship.models.resistance_protocol import LARGEST_SPEED_FACTOR, TabulatedResistance
from thalweg.ship.models.root_finding import bracketed_root
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_cache import TableWithMaxima
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import AxisRange, constant_part, random_conditions, table_error

#: first grids
_INITIAL_AXES: Final = {
    "wind_speed": AxisRange(codes.AXIS_WIND_SPEED, 0.0, 40.0, 26),
    "wind_angle": AxisRange(codes.AXIS_WIND_ANGLE, 0.0, np.pi, 37),
    "wave_height": AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 12.0, 2),
    "wave_angle": AxisRange(codes.AXIS_WAVE_ANGLE, 0.0, np.pi, 97),
    "wave_period": AxisRange(codes.AXIS_WAVE_PERIOD, 0.0, 30.0, 61),
}
_SECTOR_ANGLES: Final = 1537  #: angles of methods that end at the edge of a sector
_DEPTH_POINTS: Final = 129
_SPEED_COLUMNS: Final = 25
ERROR_SAMPLES: Final = 3000  #: random conditions at which errors are measured
_REFINEMENT_SAMPLES: Final = 1500  #: others, by which grids are refined
_REFINEMENT_ROUNDS: Final = 6
_BOUND_MARGIN: Final = 1.005
_LARGEST_TABLE_BYTES: Final = 48_000_000  #: bytes
_CONDITION_NAMES: Final = (
    "wind_speed",
    "wind_angle",
    "wave_height",
    "wave_angle",
    "wave_period",
    "depth",
)


@dataclass(frozen=True, eq=False)
class ResistanceTerm:
    """One part of the resistance that depends on conditions.

    Attributes
    ----------
    axes : tuple of Axis
    force : callable
        ``f(speed, *axis values)`` [N], arrays that broadcast; over the square of the wave height
        for waves.
    squared_height_limit : float
        See `TablePart`.
    """

    axes: tuple[AxisRange, ...]
    force: Callable[..., FloatArray]
    squared_height_limit: float = np.nan

    def part(self, speeds: FloatArray) -> TablePart:
        """Tabulate the force [N] at speeds [m/s], per squared wave height if proportional."""
        mesh = np.meshgrid(*(axis.grid for axis in self.axes), indexing="ij", sparse=True)
        at = [values[..., None] for values in mesh]
        shape = (*(axis.size for axis in self.axes), len(speeds))
        force = np.array(np.broadcast_to(self.force(speeds, *at), shape), np.float32)
        force[np.isnan(force).any(axis=-1)] = np.nan
        axes = tuple(axis.axis for axis in self.axes)
        return TablePart(
            axes, tuple(axis.grid for axis in self.axes), force, self.squared_height_limit
        )

    def refined(self, part: TablePart, scale: FloatArray) -> ResistanceTerm:
        """Return the term with steps of half the length on the axis with the largest curvature."""
        weight = (
            1.0 if np.isnan(self.squared_height_limit) else (0.5 * self.squared_height_limit) ** 2
        )
        bends = [
            float(np.nanquantile(np.abs(np.diff(part.values, 2, axis=k)) * weight / scale, 0.995))
            for k in range(len(self.axes))
        ]
        worst = int(np.argmax(bends))
        axes = tuple(a.refined() if k == worst else a for k, a in enumerate(self.axes))
        return replace(self, axes=axes)


def tabulate_balance(
    model: TabulatedResistance, load_factor: float, tolerance: float
) -> TableWithMaxima:
    """Tabulate the speed through water of every setting.

    Parameters
    ----------
    model : TabulatedResistance
    load_factor : float
    tolerance : float
        See `thalweg.ship.tables.tabulate.table_error`.

    Returns
    -------
    table : PerformanceTable
        Its error is against the methods themselves, at random conditions.
    top : ndarray
        Greatest speed of every setting [m/s]: no condition in the table's ranges gives more.

    Raises
    ------
    ModelRangeError
        If power does not rise with speed somewhere.
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
    terms : list of Term
    speeds : ndarray
        Of the columns [m/s].
    finish : Finish
    calm : ndarray
        Settings of the table [m/s].
    truth : callable
        The true values of all settings in conditions by name.
    tolerance : float
        It stops at 0.8 of this at the conditions of the refinement; the error is that at others.
    scale : ndarray
        What counts as a large change of each column [N].
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
    balance : ForceBalance
        Forces of the ship at one draught.
    speeds : ndarray (n,)
        Speeds through water [m/s].

    Returns
    -------
    ndarray (n, 1)
        Resistance [N].
    """
    return balance.resistance(_calm_conditions(speeds), speeds)[:, None]


def resistance_at_power(
    balance: ForceBalance, speeds: FloatArray, powers: FloatArray
) -> FloatArray:
    """Resistance [N] that takes exactly the powers [W], at every speed; shape (speeds, powers).

    Parameters
    ----------
    balance : ForceBalance
        Forces of the ship at one draught.
    speeds : ndarray (n,)
        Speeds through water [m/s].
    powers : ndarray (m,)
        Brake powers [W].

    Returns
    -------
    ndarray (n, m)
        Resistance [N].
    """
    top = 200.0 * float(np.max(balance.calm.total(speeds[-1:], np.array([np.inf]))))
    v, p = (grid.ravel() for grid in np.meshgrid(speeds, powers, indexing="ij"))
    if np.isinf(p).any():
        return np.full((len(speeds), len(powers)), np.inf)

    def excess(resistance: FloatArray, index: NDArray[np.intp]) -> FloatArray:
        return balance.propulsion.brake_power(v[index], resistance) - p[index]

    root = bracketed_root(excess, np.zeros(v.size), np.full(v.size, top), tolerance=1e-6 * top)
    return root.reshape(len(speeds), len(powers))


def resistance_terms(balance: ForceBalance, limits: ShipLimits) -> list[ResistanceTerm]:
    """Return what wind, waves and depth add to the resistance, up to the limits.

    Parameters
    ----------
    balance : ForceBalance
        Forces of the ship at one draught.
    limits : ShipLimits
        Greatest wave height and wind speed.

    Returns
    -------
    list of ResistanceTerm
        Terms of wind, waves and depth.
    """
    axes, found = condition_axes(balance, limits), []
    wind, waves, calm = balance.wind, balance.waves, balance.calm
    if wind is not None:

        def blown(v: FloatArray, speed: FloatArray, angle: FloatArray) -> FloatArray:
            still = wind.force(v, np.zeros(()), np.zeros(()))
            return wind.force(v, speed, angle) - still

        found.append(ResistanceTerm((axes["wind_speed"], axes["wind_angle"]), blown))
    if waves is not None:
        found.append(_wave_term(waves, axes))
    if "depth" in axes:

        def shallow(v: FloatArray, depth: FloatArray) -> FloatArray:
            return calm.total(v, depth) - calm.total(v, np.asarray(np.inf))

        found.append(ResistanceTerm((axes["depth"],), shallow))
    return found


def _wave_term(waves: AddedWaveResistance, axes: Mapping[str, AxisRange]) -> ResistanceTerm:
    stop = axes["wave_height"].stop
    if waves.method in ("stawave_1", "stawave_2"):
        axes = {**axes, "wave_angle": replace(axes["wave_angle"], size=_SECTOR_ANGLES)}
    if "wave_period" in waves.reads:

        def rough(v: FloatArray, angle: FloatArray, period: FloatArray) -> FloatArray:
            return waves.force(v, np.ones(()), period, angle)

        return ResistanceTerm((axes["wave_angle"], axes["wave_period"]), rough, stop)

    def choppy(v: FloatArray, angle: FloatArray) -> FloatArray:
        return waves.force(v, np.ones(()), np.asarray(10.0), angle)

    return ResistanceTerm((axes["wave_angle"],), choppy, stop)


def condition_axes(balance: ForceBalance, limits: ShipLimits) -> dict[str, AxisRange]:
    """Return the axes a balance has, by condition: up to the limits, from just below the keel.

    Parameters
    ----------
    balance : ForceBalance
        Forces of the ship at one draught.
    limits : ShipLimits
        Greatest wave height and wind speed.

    Returns
    -------
    dict of str to AxisRange
        Axes by condition.
    """
    found = {name: axis for name, axis in _INITIAL_AXES.items() if name in balance.reads}
    for name, limit in (("wind_speed", limits.wind_speed), ("wave_height", limits.wave_height)):
        if name in found:
            found[name] = replace(found[name], stop=min(found[name].stop, 1.0001 * limit))
    if "depth" in balance.reads:
        draught = float(balance.calm.hull.values["draught_m"])
        length = float(balance.calm.hull.values["length_waterline_m"])
        stop = draught + 1.1 * length
        found["depth"] = AxisRange(codes.AXIS_DEPTH, 1.05 * draught, stop, _DEPTH_POINTS)
    return found


def random_term_conditions(
    terms: list[ResistanceTerm], count: int, seed: int
) -> dict[str, FloatArray]:
    """Return random conditions over the ranges of terms, by name."""
    axes = [axis for term in terms for axis in term.axes]
    axes += [
        replace(_INITIAL_AXES["wave_height"], stop=term.squared_height_limit)
        for term in terms
        if not np.isnan(term.squared_height_limit)
    ]
    return random_conditions(axes, count, seed)


def conditions_per_setting(
    where: Mapping[str, FloatArray], count: int
) -> tuple[dict[str, FloatArray], FloatArray, tuple[int, ...]]:
    """Return flat conditions for every setting, the settings, and the shape of the answer."""
    shape = np.broadcast_shapes(*(np.shape(values) for values in where.values()))
    at = {
        name: np.repeat(np.broadcast_to(where.get(name, _calm_value(name)), shape).ravel(), count)
        for name in _CONDITION_NAMES
    }
    which = np.tile(np.arange(float(count)), int(np.prod(shape)))
    return at, which, (*shape, count)


def check_power_rises(model: TabulatedResistance, load_factor: float) -> None:
    """Refuse a ship whose power falls while its speed rises, calm or in weather.

    Raises
    ------
    ModelRangeError
    """
    balance = model.balance(load_factor)
    ranges = condition_axes(balance, model.limits)
    top = float(model.speeds(load_factor).max())
    ladder = np.linspace(0.3, 1.0, 36) * top
    draws = random_conditions(list(ranges.values()), 24, 3)
    at = {name: np.repeat(values, ladder.size) for name, values in draws.items()}
    at = {**_calm_conditions(np.tile(ladder, 24)), **at}
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


def _calm_conditions(speeds: FloatArray) -> dict[str, FloatArray]:
    """Calm, deep conditions as many as there are speeds."""
    return {name: np.full(speeds.shape, _calm_value(name)) for name in _CONDITION_NAMES}


def _calm_value(name: str) -> float:
    """The condition without resistance."""
    return {"wave_period": 10.0, "depth": np.inf}.get(name, 0.0)
