"""`PerformanceTable`: a ship on uniform axes, as a sum of parts, with its measured error."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import AXIS_COUNT, AXIS_DEPTH
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.ship.condition_variables import CONDITION_OF_AXIS
from thalweg.ship.tables.output_curve import OutputCurve

if TYPE_CHECKING:
    from thalweg.ship.models.seaway_limits import SafetyLimits

_EDGE_TOLERANCE = 1e-6  # how far outside an axis counts as on it [steps]


@dataclass(frozen=True)
class TableError:
    """How far a table is from the model itself, measured at random conditions between its nodes.

    Attributes
    ----------
    mean, p99, max : float
        Absolute difference over the model's value, the latter not taken below a quarter of
        the greatest value of its setting; 1 where only one of both knows a value.
    samples : int
        Number of random conditions measured.
    """

    mean: float
    p99: float
    max: float
    samples: int = 0


@dataclass(frozen=True, eq=False)
class TablePart:
    """One term of a table: values on uniform axes, the setting innermost.

    Attributes
    ----------
    axes : tuple of int
        Axis ids (``AXIS_*`` of `thalweg.kernels.codes`); empty for a constant per setting.
    grids : tuple of ndarray
        Uniform, ascending grid points of each axis, SI.
    values : float32 ndarray
        Shape ``(len(grid) for each axis..., settings)``; NaN where the model has no value.
        Before a crossing the last axis runs over its columns instead.
    squared_height_limit : float, optional
        The part is multiplied by the square of the wave height, up to this height [m].

    Raises
    ------
    InputError
        If a grid is not uniform and ascending, or the shapes do not fit.
    """

    axes: tuple[int, ...]
    grids: tuple[FloatArray, ...]
    values: NDArray[np.float32]
    squared_height_limit: float = math.nan

    def __post_init__(self) -> None:
        grids = tuple(np.ascontiguousarray(grid, float) for grid in self.grids)
        values = np.ascontiguousarray(self.values, np.float32)
        object.__setattr__(self, "grids", grids)
        object.__setattr__(self, "values", values)
        self._check()

    def _check(self) -> None:
        if len(self.axes) != len(self.grids) or len(set(self.axes)) != len(self.axes):
            raise _invalid_part_error("needs one grid for each of its axes, and each axis once")
        if any(axis not in CONDITION_OF_AXIS for axis in self.axes):
            raise _invalid_part_error(f"has an unknown axis among {self.axes}")
        if self.values.shape[:-1] != tuple(len(grid) for grid in self.grids):
            raise _invalid_part_error(
                f"has values of shape {self.values.shape}, which does not fit its grids"
            )
        for axis, grid in zip(self.axes, self.grids):
            if len(grid) < 2 or not np.isfinite(grid).all() or grid[-1] <= grid[0]:
                raise _invalid_part_error(f"has no ascending grid for {CONDITION_OF_AXIS[axis]}")
            even = np.linspace(grid[0], grid[-1], len(grid))
            if np.abs(grid - even).max() > 1e-6 * (grid[1] - grid[0]):
                raise _invalid_part_error(f"has an uneven grid for {CONDITION_OF_AXIS[axis]}")

    def lookup(self, where: Mapping[str, ArrayLike], setting: ArrayLike = 0) -> FloatArray:
        """Return the multilinear look-up; NaN outside an axis (only depth reaches on downwards)."""
        chosen = np.asarray(setting).astype(np.intp)
        total: FloatArray = np.zeros(())
        for weight, index in self._corners(where):
            value = self.values[(*np.broadcast_arrays(*index, chosen),)]
            total = total + np.where(weight == 0.0, 0.0, weight * value)
        return self._factor(where) * total

    def lookup_all(self, where: Mapping[str, ArrayLike]) -> FloatArray:
        """Return the look-up of every setting, in a last axis."""
        total: FloatArray = np.zeros(())
        for weight, index in self._corners(where):
            value = self.values[(*index,)] if index else self.values
            column = np.asarray(weight)[..., None]
            total = total + np.where(column == 0.0, 0.0, column * value)
        return np.asarray(self._factor(where))[..., None] * total

    def least(self) -> FloatArray:
        """Return the least value of every setting, anywhere."""
        flat = self.values.reshape(-1, self.values.shape[-1])
        low = np.fmin.reduce(flat, axis=0).astype(float)
        if math.isnan(self.squared_height_limit):
            return np.asarray(low)
        return np.minimum(low * self.squared_height_limit**2, 0.0)

    def greatest(self) -> FloatArray:
        """Return the greatest value of every setting, anywhere."""
        return -replace(self, values=-self.values).least()

    def _factor(self, where: Mapping[str, ArrayLike]) -> FloatArray | float:
        """What the look-up is multiplied by."""
        if math.isnan(self.squared_height_limit):
            return 1.0
        height = np.asarray(where["wave_height"], float)
        inside = (height >= 0.0) & (height <= self.squared_height_limit * (1.0 + _EDGE_TOLERANCE))
        return np.where(inside, height * height, np.nan)

    def _corners(
        self, where: Mapping[str, ArrayLike]
    ) -> Iterator[tuple[FloatArray, list[NDArray[np.intp]]]]:
        """Weight and index of every corner of the cells that hold the conditions."""
        names = [CONDITION_OF_AXIS[axis] for axis in self.axes]
        located = [
            _locate(axis, grid, np.asarray(where[name], float))
            for axis, grid, name in zip(self.axes, self.grids, names)
        ]
        for corner in range(1 << len(self.axes)):
            weight: FloatArray = np.ones(())
            index: list[NDArray[np.intp]] = []
            for bit, (cell, fraction) in enumerate(located):
                up = corner >> bit & 1
                index.append(cell + up)
                weight = weight * (fraction if up else 1.0 - fraction)
            yield weight, index


@dataclass(frozen=True, eq=False)
class PerformanceTable:
    """A ship tabulated: a sum over parts of multilinear look-ups, and what follows from the sum.

    Attributes
    ----------
    parts : tuple of TablePart
        The terms of the sum.
    settings : ndarray
        The settings: calm-water speeds [m/s], ascending.
    fingerprint : str
        Of the ship the table was made from.
    error : TableError
        Measured against the ship itself.
    finish : Finish, optional
        What turns the sum into the value; without it the sum is the value.
    safety : SafetyLimits, optional
        What the ship must not do in waves; kernels refuse it.
    """

    parts: tuple[TablePart, ...]
    settings: FloatArray
    fingerprint: str
    error: TableError
    finish: OutputCurve | None = None
    safety: SafetyLimits | None = None

    def __post_init__(self) -> None:
        if not self.parts:
            raise _invalid_part_error("is missing: a table has at least one")
        count = len(self.settings) if self.finish is None else self.finish.columns
        if any(part.values.shape[-1] != count for part in self.parts):
            raise _invalid_part_error(f"has another number of settings than the table's {count}")
        if self.finish is not None:
            self.finish.check(self.parts)

    @property
    def axes(self) -> frozenset[str]:
        """The conditions the table looks at."""
        return frozenset(self.ranges)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """From where to where each condition may go, SI; depth also beyond."""
        found: dict[str, tuple[float, float]] = {}
        for part in self.parts:
            own = {CONDITION_OF_AXIS[a]: (g[0], g[-1]) for a, g in zip(part.axes, part.grids)}
            if not math.isnan(part.squared_height_limit):
                own["wave_height"] = (0.0, part.squared_height_limit)
            for name, (low, high) in own.items():
                before = found.get(name, (low, high))
                found[name] = (max(low, before[0]), min(high, before[1]))
        return found

    @property
    def nbytes(self) -> int:
        """Memory of the values [bytes]."""
        return sum(part.values.nbytes for part in self.parts)

    def lookup(self, where: Mapping[str, ArrayLike], setting: ArrayLike = 0) -> FloatArray:
        """Return the table's value; NaN outside an axis or where the model has none.

        Parameters
        ----------
        where : mapping of str to array_like
            Conditions by name (`Conditions` will do), SI.
        setting : array_like of int
            Index of the setting.
        """
        if self.finish is None:
            return reduce(np.add, (part.lookup(where, setting) for part in self.parts))
        total = reduce(np.add, (part.lookup_all(where) for part in self.parts))
        return self.finish.value(total, np.asarray(setting).astype(np.intp))

    def largest(self, setting: int) -> float:
        """Return an upper bound of the table's value at a setting, in its unit."""
        if self.finish is not None and self.finish.falls:
            low = reduce(np.add, (part.least() for part in self.parts))
            return float(self.finish.value(low, np.asarray(setting)))
        high = reduce(np.add, (part.greatest() for part in self.parts))
        if self.finish is not None:
            return float(self.finish.value(high, np.asarray(setting)))
        return float(high[setting])

    def at_setting(self, setting: int) -> PerformanceTable:
        """Return the table of one setting alone, which is smaller and so quicker to look up."""
        chosen = slice(setting, setting + 1)
        finish = None if self.finish is None else self.finish.at(chosen)
        parts = self.parts
        if finish is None or not finish.falls:
            parts = tuple(replace(part, values=part.values[..., chosen]) for part in parts)
        return replace(self, parts=parts, settings=self.settings[chosen], finish=finish)

    def kernel_arrays(self) -> TableArrays:
        """Return the arrays that kernels look up (see `thalweg.kernels.leg.table_lookup`)."""
        count = len(self.parts)
        axes = np.full((count, AXIS_COUNT), -1, np.int64)
        start, inverse = np.zeros((count, AXIS_COUNT)), np.zeros((count, AXIS_COUNT))
        size = np.ones((count, AXIS_COUNT), np.int64)
        lengths = [part.values.size for part in self.parts]
        for p, part in enumerate(self.parts):
            for k, (axis, grid) in enumerate(zip(part.axes, part.grids)):
                axes[p, k], start[p, k], size[p, k] = axis, grid[0], len(grid)
                inverse[p, k] = (len(grid) - 1) / (grid[-1] - grid[0])
        stops = np.array([part.squared_height_limit for part in self.parts])
        return TableArrays(
            part_axes=axes,
            axis_start=start,
            axis_inv_step=inverse,
            axis_size=size,
            value_offset=np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64),
            n_settings=len(self.settings),
            values=np.concatenate([part.values.ravel() for part in self.parts]),
            squared_height_limit=stops if np.isfinite(stops).any() else np.empty(0),
            **({} if self.finish is None else self.finish.kernel_arrays()),
            **({} if self.safety is None else self.safety.kernel_arrays()),
        )


def _locate(axis: int, grid: FloatArray, x: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
    """Return (cell, fraction); the fraction is NaN outside the axis."""
    last = len(grid) - 1
    place = (x - grid[0]) * (last / (grid[-1] - grid[0]))
    if axis == AXIS_DEPTH:
        place = np.minimum(place, last)
    inside = (place >= -_EDGE_TOLERANCE) & (place <= last + _EDGE_TOLERANCE)
    clipped = np.clip(np.where(inside, place, 0.0), 0.0, last)
    cell = np.minimum(clipped.astype(np.intp), last - 1)
    return cell, np.where(inside, clipped - cell, np.nan)


def _invalid_part_error(problem: str) -> InputError:
    return InputError(
        f"A part of the performance table {problem}.",
        "Axes are uniform and ascending, SI; values end with the settings.",
        "Check how the table was made.",
    )
