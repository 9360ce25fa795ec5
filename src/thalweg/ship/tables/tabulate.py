"""Turn a function of conditions into a table: evaluate, measure the error, refine, repeat."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.ship.condition_variables import CONDITION_OF_AXIS
from thalweg.ship.conditions import Conditions
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TableError, TablePart

#: given conditions by name (arrays that broadcast), returns values of shape (*shape, settings)
ConditionsFunction = Callable[[Mapping[str, FloatArray]], FloatArray]
#: values of settings in conditions that broadcast with them
RateFunction = Callable[[Conditions, NDArray[np.intp]], FloatArray]

#: Relative errors are not taken to less than this share of the greatest value.
RELATIVE_ERROR_FLOOR: Final = 0.25
LARGEST_TABLE: Final = 32_000_000  #: bytes of one part
_CHUNK_SIZE = 40_000
_SAMPLES = 4000
_LARGEST_AXIS = 1025


@dataclass(frozen=True)
class AxisRange:
    """The range of one axis and the initial number of grid points.

    Attributes
    ----------
    axis : Axis id.
    start, stop : SI.
    fixed : The grid is exact already and is never refined.
    """

    axis: int
    start: float
    stop: float
    size: int
    fixed: bool = False

    @property
    def name(self) -> str:
        """The condition on this axis."""
        return CONDITION_OF_AXIS[self.axis]

    @property
    def grid(self) -> FloatArray:
        """The grid points."""
        return np.linspace(self.start, self.stop, self.size)

    def refined(self) -> AxisRange:
        """Return the axis with steps of half the length."""
        return replace(self, size=2 * self.size - 1)


#: what a ship may meet: beyond these a table refuses (but depth reaches on downwards)
DEFAULT_AXES: Final = {
    "wind_speed": AxisRange(codes.AXIS_WIND_SPEED, 0.0, 80.0, 33),
    "wind_angle": AxisRange(codes.AXIS_WIND_ANGLE, 0.0, math.pi, 13),
    "wave_height": AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 24.0, 25),
    "wave_angle": AxisRange(codes.AXIS_WAVE_ANGLE, 0.0, math.pi, 13),
    "wave_period": AxisRange(codes.AXIS_WAVE_PERIOD, 0.0, 30.0, 16),
    "depth": AxisRange(codes.AXIS_DEPTH, 0.0, 400.0, 81),
}


def tabulate_dense(
    function: ConditionsFunction,
    axes: Sequence[AxisRange],
    *,
    tolerance: float,
    largest: int = LARGEST_TABLE,
) -> tuple[TablePart, TableError]:
    """Tabulate a function on a full grid, refined until the error meets the tolerance.

    Parameters
    ----------
    function : callable
        Takes conditions by name, arrays that broadcast; returns shape ``(*shape, settings)``.
    axes : sequence of AxisRange
        Where to begin, at least one; the ranges that ships meet are in ``DEFAULT_AXES`` of this
        module, by the name of the condition.
    tolerance : float
        Relative error that 99 % of random conditions must meet; see `TableError`.
    largest : int, optional
        Bytes the table may take. Refinement stops there; the error states what was reached.

    Returns
    -------
    part : TablePart
        The table.
    error : TableError
        Its error against the function, at random conditions.
    """
    points = random_conditions(axes, _SAMPLES, 0)
    truth = function(points)
    axes = _coarsened(axes, largest // (4 * truth.shape[-1]))
    while True:
        values = _on_grid(function, axes)
        part = TablePart(tuple(a.axis for a in axes), tuple(a.grid for a in axes), values)
        error = table_error(part.lookup_all(points), truth)
        if error.p99 <= tolerance:
            return part, error
        worst = _worst_axis(values, axes)
        if worst is None or 2 * values.nbytes > largest:
            return part, error
        axes[worst] = axes[worst].refined()


def tabulate_settings(
    rate: RateFunction,
    axes: Sequence[AxisRange],
    settings: int,
    load_factor: float,
    *,
    tolerance: float,
) -> tuple[tuple[TablePart, ...], TableError]:
    """Tabulate what a model gives at each of its settings, in one part.

    Parameters
    ----------
    axes : As in `tabulate_dense`; none for what no condition changes.
    """

    def rates(where: Mapping[str, FloatArray]) -> FloatArray:
        columns = {name: np.asarray(values)[..., None] for name, values in where.items()}
        found = rate(Conditions(columns, load_factor=load_factor), np.arange(settings))
        return np.asarray(found)

    if not axes:
        return (constant_part(rates({})),), TableError(0.0, 0.0, 0.0, 0)
    part, error = tabulate_dense(rates, axes, tolerance=tolerance)
    return (part,), error


def constant_part(values: FloatArray) -> TablePart:
    """Return the part that adds one number per setting, in all conditions."""
    return TablePart((), (), np.asarray(values, np.float32))


def tabulate_cubed_speed(speeds: Sequence[float] | FloatArray) -> PerformanceTable:
    """Return the cube of the ordered speed of every setting [m3/s3], in all conditions.

    It replaces the fuel rate where the costs of a ship depend on it (van Halem 2019).
    """
    ordered = np.asarray(speeds, float)
    exact = TableError(0.0, 0.0, 0.0, 0)
    return PerformanceTable((constant_part(ordered**3),), ordered, "", exact)


def random_conditions(axes: Sequence[AxisRange], count: int, seed: int) -> dict[str, FloatArray]:
    """Return conditions drawn evenly over the axes, by name.

    Parameters
    ----------
    count : Number of conditions.
    seed : Seed of the random numbers.

    Returns
    -------
    dict of str to ndarray (count,) : Values in SI units, by condition.
    """
    draw = np.random.default_rng(seed)
    return {a.name: draw.uniform(a.start, a.stop, count) for a in axes}


def table_error(tabulated: FloatArray, truth: FloatArray) -> TableError:
    """Measure how far looked-up values are from the model's.

    Where one of the two is unknown, the error is the whole value; where both are, it is ignored.

    Parameters
    ----------
    tabulated : ndarray (..., settings)
        Values from the table.
    truth : ndarray (..., settings)
        Values of the model.

    Returns
    -------
    TableError : Errors relative to the greatest value of each setting.
    """
    sound, known = np.isfinite(truth), np.isfinite(truth) | np.isfinite(tabulated)
    if not known.any():
        return TableError(0.0, 0.0, 0.0, 0)
    top = np.where(sound, np.abs(truth), 0.0).reshape(-1, truth.shape[-1]).max(axis=0)
    scale = np.maximum(np.maximum(np.abs(truth), RELATIVE_ERROR_FLOOR * top), 1e-12)
    # a value that only the model or only the table knows counts as wholly wrong
    relative = np.nan_to_num(np.abs(tabulated - truth) / scale, nan=1.0)[known]
    return TableError(
        mean=float(relative.mean()),
        p99=float(np.quantile(relative, 0.99)),
        max=float(relative.max()),
        samples=int(known.sum()),
    )


def _coarsened(axes: Sequence[AxisRange], largest: int) -> list[AxisRange]:
    """Coarsen the longest axes until the grid has no more than ``largest`` points."""
    fitting = list(axes)
    while math.prod(a.size for a in fitting) > largest:
        longest = max(range(len(fitting)), key=lambda k: fitting[k].size)
        if fitting[longest].size <= 3:
            break
        fitting[longest] = replace(fitting[longest], size=fitting[longest].size // 2 + 1)
    return fitting


def _on_grid(function: ConditionsFunction, axes: Sequence[AxisRange]) -> NDArray[np.float32]:
    """Evaluate on the whole grid, a slab of the first axis at a time."""
    points_per_row = math.prod(a.size for a in axes[1:])
    rows = max(1, _CHUNK_SIZE // points_per_row)
    grids = [a.grid for a in axes]
    slabs = []
    for first in range(0, axes[0].size, rows):
        first_grid = grids[0][first : first + rows]
        mesh = np.meshgrid(first_grid, *grids[1:], indexing="ij", sparse=True)
        values = np.asarray(function({a.name: m for a, m in zip(axes, mesh)}), np.float32)
        shape = (len(first_grid), *(a.size for a in axes[1:]), values.shape[-1])
        slabs.append(np.broadcast_to(values, shape))
    return np.concatenate(slabs)


def _worst_axis(values: NDArray[np.float32], axes: Sequence[AxisRange]) -> int | None:
    """Return the axis along which linear interpolation errs most, by second differences."""
    whole = np.abs(values)
    scale = np.maximum(whole, RELATIVE_ERROR_FLOOR * np.nanmax(whole, initial=0.0)) + 1e-12
    bends = []
    for k, axis in enumerate(axes):
        if axis.fixed or 2 * axis.size - 1 > _LARGEST_AXIS or axis.size < 3:
            bends.append(-1.0)
            continue
        bend = np.abs(np.diff(values, 2, axis=k))
        inner = np.take(scale, np.arange(1, axis.size - 1), axis=k)
        bends.append(float(np.nanquantile(bend / inner, 0.99)))
    worst = int(np.argmax(bends)) if bends else 0
    return worst if bends and bends[worst] > 0.0 else None
