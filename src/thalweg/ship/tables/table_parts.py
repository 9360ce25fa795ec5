"""`TablePart`: one term of a performance table; `TableError`: the measured error of a table."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import AXIS_DEPTH
from thalweg.ship.condition_variables import CONDITION_OF_AXIS

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
    before_closing : float32 ndarray, optional
        The values of the model where those of the part are NaN because the ship keeps out of such
        conditions: what she makes there is known to bounds. Of the shape of ``values``.

    Raises
    ------
    InputError
        If a grid is not uniform and ascending, or the shapes do not fit.
    """

    axes: tuple[int, ...]
    grids: tuple[FloatArray, ...]
    values: NDArray[np.float32]
    squared_height_limit: float = math.nan
    before_closing: NDArray[np.float32] | None = None

    def __post_init__(self) -> None:
        grids = tuple(np.ascontiguousarray(grid, float) for grid in self.grids)
        values = np.ascontiguousarray(self.values, np.float32)
        object.__setattr__(self, "grids", grids)
        object.__setattr__(self, "values", values)
        self._check()

    def at_settings(self, chosen: slice) -> TablePart:
        """Return the part at some of its settings.

        Parameters
        ----------
        chosen : slice
            Indices of the settings.

        Returns
        -------
        TablePart
            With these settings alone.
        """
        before = self.before_closing
        return replace(
            self,
            values=self.values[..., chosen],
            before_closing=None if before is None else before[..., chosen],
        )

    def _check(self) -> None:
        if len(self.axes) != len(self.grids) or len(set(self.axes)) != len(self.axes):
            raise invalid_part_error("needs one grid for each of its axes, and each axis once")
        if any(axis not in CONDITION_OF_AXIS for axis in self.axes):
            raise invalid_part_error(f"has an unknown axis among {self.axes}")
        if self.values.shape[:-1] != tuple(len(grid) for grid in self.grids):
            raise invalid_part_error(
                f"has values of shape {self.values.shape}, which does not fit its grids"
            )
        for axis, grid in zip(self.axes, self.grids):
            if len(grid) < 2 or not np.isfinite(grid).all() or grid[-1] <= grid[0]:
                raise invalid_part_error(f"has no ascending grid for {CONDITION_OF_AXIS[axis]}")
            even = np.linspace(grid[0], grid[-1], len(grid))
            if np.abs(grid - even).max() > 1e-6 * (grid[1] - grid[0]):
                raise invalid_part_error(f"has an uneven grid for {CONDITION_OF_AXIS[axis]}")

    def lookup(self, where: Mapping[str, ArrayLike], setting: ArrayLike = 0) -> FloatArray:
        """Return the multilinear look-up of one setting in each condition.

        Parameters
        ----------
        where : mapping of str to array_like
            Conditions by name (`Conditions` will do), in SI units.
        setting : array_like of int
            Index of the setting.

        Returns
        -------
        float64 array
            In the unit of the table; NaN outside an axis, except for larger depths.
        """
        chosen = np.asarray(setting).astype(np.intp)
        total: FloatArray = np.zeros(())
        for weight, index in self._corners(where):
            value = self.values[(*np.broadcast_arrays(*index, chosen),)]
            total = total + np.where(weight == 0.0, 0.0, weight * value)
        return self._factor(where) * total

    def lookup_all(self, where: Mapping[str, ArrayLike]) -> FloatArray:
        """Return the multilinear look-up of every setting.

        Parameters
        ----------
        where : mapping of str to array_like
            Conditions by name (`Conditions` will do), in SI units.

        Returns
        -------
        float64 array (..., settings)
            In the unit of the table; NaN outside an axis, except for larger depths.
        """
        total: FloatArray = np.zeros(())
        for weight, index in self._corners(where):
            value = self.values[(*index,)] if index else self.values
            column = np.asarray(weight)[..., None]
            total = total + np.where(column == 0.0, 0.0, column * value)
        return np.asarray(self._factor(where))[..., None] * total

    def least(self) -> FloatArray:
        """Return the least value of every setting, anywhere.

        Returns
        -------
        float64 array (settings,)
            In the unit of the table.
        """
        flat = self.values.reshape(-1, self.values.shape[-1])
        low = np.fmin.reduce(flat, axis=0).astype(float)
        if math.isnan(self.squared_height_limit):
            return np.asarray(low)
        return np.minimum(low * self.squared_height_limit**2, 0.0)

    def greatest(self) -> FloatArray:
        """Return the greatest value of every setting, anywhere.

        Returns
        -------
        float64 array (settings,)
            In the unit of the table.
        """
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


def invalid_part_error(problem: str) -> InputError:
    """Return the error of a part that does not fit its table."""
    return InputError(
        f"A part of the performance table {problem}.",
        "Axes are uniform and ascending, SI; values end with the settings.",
        "Check how the table was made.",
    )
