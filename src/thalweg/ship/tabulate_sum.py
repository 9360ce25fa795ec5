"""Tables of resistance-based ships: what wind, waves and depth cost, alone and together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import ModelRangeError
from thalweg.kernels import codes
from thalweg.ship.ladder import Ladder
from thalweg.ship.limits import ShipLimits
from thalweg.ship.powering import Balance, ResistanceModel
from thalweg.ship.table import TableError, TablePart
from thalweg.ship.table_store import Kept
from thalweg.ship.tabulate import (
    Axis,
    Tabulated,
    constant_part,
    random_conditions,
    table_error,
    tabulate_dense,
)
from thalweg.ship.variables import CONDITION_OF

FloatArray = NDArray[np.float64]
_GROUPS: Final = (
    ("wind_speed", "wind_angle"),
    ("wave_height", "wave_angle", "wave_period"),
    ("depth",),
)
#: first grids of the parts of one group, and of the part they share
_ALONE: Final = {
    "wind_speed": Axis(codes.AXIS_WIND_SPEED, 0.0, 40.0, 26),
    "wind_angle": Axis(codes.AXIS_WIND_ANGLE, 0.0, np.pi, 19),
    "wave_height": Axis(codes.AXIS_WAVE_HEIGHT, 0.0, 12.0, 17),
    "wave_angle": Axis(codes.AXIS_WAVE_ANGLE, 0.0, np.pi, 33),
    "wave_period": Axis(codes.AXIS_WAVE_PERIOD, 0.0, 30.0, 31),
}
_SHARED: Final = {
    "wind_speed": (9, 9),
    "wind_angle": (13, 7),
    "wave_height": (13, 7),
    "wave_angle": (13, 7),
    "wave_period": (17, 9),
    "depth": (13, 13),
}  # without and with depth
CHECKS: Final = 1500  #: random conditions that errors are measured at
_MARGIN: Final = 1.005
_LARGEST_ALONE: Final = 8_000_000  #: bytes
_LARGEST_SHARED: Final = 16_000_000  #: bytes


def tabulate_balance(model: ResistanceModel, load_factor: float, tolerance: float) -> Kept:
    """Tabulate the speed through water of every setting as a sum of parts.

    First a constant (calm, deep), one part for wind, one for waves, one for depth, each refined on
    its own; where their sum misses the tolerance, one part more for wind and waves together, and
    one for all three.

    Parameters
    ----------
    model : ResistanceModel
    load_factor : float
    tolerance : float
        See `thalweg.ship.tabulate.table_error`.

    Returns
    -------
    parts : tuple of TablePart
    error : TableError
        Against the methods themselves.
    top : ndarray
        Greatest speed of every setting [m/s]; see `greatest_speed`.

    Raises
    ------
    ModelRangeError
        If power does not rise with speed somewhere.
    """
    balance = model.balance(load_factor)
    check_power_rises(model, load_factor)
    ladder = Ladder.of(model, load_factor)
    groups = grouped(axes_of(balance, model.limits))
    calm = model.speeds(load_factor)
    if not groups:
        return (constant_part(calm),), TableError(0.0, 0.0, 0.0, 0), calm
    shift = calm - ladder({"depth": np.asarray(np.inf)})

    def truth(points: Mapping[str, FloatArray]) -> FloatArray:
        at, which, shape = flattened(points, len(model.orders.values))
        return model.speed_of(balance, at, which, load_factor).reshape(shape)

    parts, error, points, true = add_up(
        lambda where: ladder(where) + shift, calm, groups, truth, tolerance
    )
    return tuple(parts), error, greatest_speed(parts, true, _total(parts, points))


def add_up(
    values: Tabulated,
    calm: FloatArray,
    groups: list[list[Axis]],
    truth: Tabulated,
    tolerance: float,
) -> tuple[list[TablePart], TableError, Mapping[str, FloatArray], FloatArray]:
    """Tabulate a function as a constant, a part for each group of axes, and parts for several.

    Parameters
    ----------
    values : callable
        The function as it is tabulated, cheap on grids; shape ``(*shape, settings)``.
    calm : ndarray
        Its values where weather and depth cost nothing, per setting.
    groups : list of list of Axis
        At least one.
    truth : callable
        The function itself, which the error is measured against.
    tolerance : float

    Returns
    -------
    parts : list of TablePart
    error : TableError
    points, true : mapping, ndarray
        Where the error was measured, and the true values there.
    """
    parts = [constant_part(calm)]
    for group in groups:
        part, _ = tabulate_dense(
            lambda where: values(where) - calm,
            group,
            tolerance=tolerance / 5,
            largest=_LARGEST_ALONE,
            base=calm,
        )
        parts.append(part)
    points = random_conditions([axis for group in groups for axis in group], CHECKS, 7)
    true = truth(points)
    error = table_error(_total(parts, points), true)
    alone = parts
    for strictness in (0.85, 0.35):
        if error.p99 <= tolerance or len(groups) < 2:
            break
        parts = list(alone)
        for together in _growing(groups):
            parts.append(_together(values, together, parts, strictness * tolerance))
        error = table_error(_total(parts, points), true)
        if sum(part.values.nbytes for part in parts) > _LARGEST_SHARED / 4:
            break
    return parts, error, points, true


def grouped(axes: Mapping[str, Axis]) -> list[list[Axis]]:
    """Return the axes of wind, of waves and of depth, as far as there are any."""
    groups = [[axes[name] for name in names if name in axes] for names in _GROUPS]
    return [group for group in groups if group]


def axes_of(balance: Balance, limits: ShipLimits) -> dict[str, Axis]:
    """Return the axes a balance has, by condition: up to the limits, from just below the keel."""
    found = {name: axis for name, axis in _ALONE.items() if name in balance.reads}
    for name, limit in (("wind_speed", limits.wind_speed), ("wave_height", limits.wave_height)):
        if name in found:
            found[name] = replace(found[name], stop=min(found[name].stop, 1.0001 * limit))
    if "depth" in balance.reads:
        draught = float(balance.calm.hull.values["draught_m"])
        length = float(balance.calm.hull.values["length_waterline_m"])
        stop = draught + 1.1 * length
        found["depth"] = Axis(codes.AXIS_DEPTH, 1.05 * draught, stop, 129)
    return found


def check_power_rises(model: ResistanceModel, load_factor: float) -> None:
    """Refuse a ship whose power falls while its speed rises, calm or in weather.

    Raises
    ------
    ModelRangeError
    """
    balance = model.balance(load_factor)
    ranges = axes_of(balance, model.limits)
    top = float(model.speeds(load_factor).max())
    ladder = np.linspace(0.3, 1.0, 36) * top
    draws = random_conditions(list(ranges.values()), 24, 3)
    at = {name: np.repeat(values, ladder.size) for name, values in draws.items()}
    count = 24 * ladder.size
    for name in ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth"):
        at.setdefault(name, np.full(count, _rest(name)))
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


def greatest_speed(parts: list[TablePart], truth: FloatArray, found: FloatArray) -> FloatArray:
    """Greatest speed of every setting [m/s].

    Over the nodes of the parts for wind, waves and depth alone, and over random conditions, of the
    table (``found``) and of the methods themselves (``truth``); a half per cent is added for what
    lies between.
    """
    calm = parts[0].values.astype(float)
    alone = [part for part in parts if 0 < len(part.axes) <= 3]
    gains = sum(np.maximum(np.nanmax(_flat(part), axis=0), 0.0) for part in alone)
    highest = [calm + gains, np.nanmax(truth, axis=0), np.nanmax(found, axis=0)]
    return _MARGIN * np.max(highest, axis=0)


def _flat(part: TablePart) -> NDArray[np.float32]:
    return part.values.reshape(-1, part.values.shape[-1])


def _rest(name: str) -> float:
    """The condition that costs nothing."""
    return {"wave_period": 10.0, "depth": np.inf}.get(name, 0.0)


def flattened(
    where: Mapping[str, FloatArray], count: int
) -> tuple[dict[str, FloatArray], FloatArray, tuple[int, ...]]:
    """Return flat conditions for every setting, the settings, and the shape of the answer."""
    shape = np.broadcast_shapes(*(np.shape(values) for values in where.values()))
    names = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")
    at = {
        name: np.repeat(np.broadcast_to(where.get(name, _rest(name)), shape).ravel(), count)
        for name in names
    }
    which = np.tile(np.arange(float(count)), int(np.prod(shape)))
    return at, which, (*shape, count)


def _total(parts: list[TablePart], points: Mapping[str, FloatArray]) -> FloatArray:
    return reduce(np.add, (part.lookup_all(points) for part in parts))


def _together(
    speeds: Tabulated, axes: list[Axis], parts: list[TablePart], tolerance: float
) -> TablePart:
    """The part over two groups of axes: what they cost together beyond what each costs alone."""
    deep = any(axis.name == "depth" for axis in axes)
    coarse = [_coarse(axis, deep) for axis in axes]
    points = random_conditions(coarse, 2 * CHECKS, 5)
    truth = speeds(points)
    with_rest = {**_at_rest(parts, points), **points}

    def left(where: Mapping[str, FloatArray]) -> FloatArray:
        return speeds(where) - _total(parts, {**_at_rest(parts, where), **where})

    part, _ = tabulate_dense(
        left,
        coarse,
        tolerance=tolerance,
        largest=_LARGEST_SHARED,
        check=lambda part: table_error(_total([*parts, part], with_rest), truth),
    )
    return part


def _growing(groups: list[list[Axis]]) -> list[list[Axis]]:
    """The axes of the first two groups, of the first three, ..."""
    return [[axis for group in groups[:n] for axis in group] for n in range(2, len(groups) + 1)]


def _at_rest(parts: list[TablePart], where: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Conditions of other axes, at values that cost nothing."""
    names = {CONDITION_OF[axis] for part in parts for axis in part.axes}
    return {name: np.asarray(_rest(name)) for name in names if name not in where}


def _coarse(axis: Axis, deep: bool) -> Axis:
    """First grid of the shared part; depth only where it matters in weather, four draughts deep."""
    stop = min(axis.stop, 4.0 * axis.start) if axis.name == "depth" else axis.stop
    return replace(axis, size=_SHARED[axis.name][deep], stop=stop)
