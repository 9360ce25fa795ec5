"""`PerformanceTable`: a ship on uniform axes, as a sum of parts, with its measured error."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import AXIS_COUNT
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.ship.condition_variables import CONDITION_OF_AXIS
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.table_parts import TableError, TablePart, invalid_part_error

if TYPE_CHECKING:
    from thalweg.ship.seaway_limits import SafetyLimits


@dataclass(frozen=True, eq=False)
class PerformanceTable:
    """A ship tabulated: a sum over parts of multilinear look-ups, with an optional output curve.

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
    motions_margin : float
        Share by which kernels take the limits of motions as stricter.
    """

    parts: tuple[TablePart, ...]
    settings: FloatArray
    fingerprint: str
    error: TableError
    finish: OutputCurve | None = None
    safety: SafetyLimits | None = None
    motions_margin: float = 0.0

    def __post_init__(self) -> None:
        if not self.parts:
            raise invalid_part_error("is missing: a table has at least one")
        count = len(self.settings) if self.finish is None else self.finish.columns
        if any(part.values.shape[-1] != count for part in self.parts):
            raise invalid_part_error(f"has another number of settings than the table's {count}")
        if self.finish is not None:
            self.finish.check(self.parts)

    @property
    def axes(self) -> frozenset[str]:
        """The conditions on the axes of the table."""
        return frozenset(self.ranges)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """The range of each condition, SI; depths beyond the range are allowed."""
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

        Returns
        -------
        float64 array
            In the unit of the table (m/s, kg/s or W).
        """
        if self.finish is None:
            return reduce(np.add, (part.lookup(where, setting) for part in self.parts))
        total = reduce(np.add, (part.lookup_all(where) for part in self.parts))
        return self.finish.value(total, np.asarray(setting).astype(np.intp))

    def largest(self, setting: int) -> float:
        """Return an upper bound of the table's value at a setting.

        Parameters
        ----------
        setting : int
            Index of the setting.

        Returns
        -------
        float
            In the unit of the table.
        """
        if self.finish is not None and self.finish.falls:
            low = reduce(np.add, (part.least() for part in self.parts))
            return float(self.finish.value(low, np.asarray(setting)))
        high = reduce(np.add, (part.greatest() for part in self.parts))
        if self.finish is not None:
            return float(self.finish.value(high, np.asarray(setting)))
        return float(high[setting])

    def at_setting(self, setting: int) -> PerformanceTable:
        """Return the table of one setting, which is smaller and quicker to look up.

        Parameters
        ----------
        setting : int
            Index of the setting.

        Returns
        -------
        PerformanceTable
            With one setting, of index 0.
        """
        chosen = slice(setting, setting + 1)
        finish = None if self.finish is None else self.finish.at(chosen)
        parts = self.parts
        if finish is None or not finish.falls:
            parts = tuple(part.at_settings(chosen) for part in parts)
        return replace(self, parts=parts, settings=self.settings[chosen], finish=finish)

    def before_closing(self) -> PerformanceTable:
        """Return the table for bounds: with the values of entries that searches find closed.

        Returns
        -------
        PerformanceTable
            This one where no entry is closed.
        """
        if all(part.before_closing is None for part in self.parts):
            return self
        parts = tuple(
            part
            if part.before_closing is None
            else replace(part, values=part.before_closing, before_closing=None)
            for part in self.parts
        )
        return replace(self, parts=parts)

    def kernel_arrays(self) -> TableArrays:
        """Return the arrays that kernels look up (see `thalweg.kernels.leg.table_lookup`).

        Returns
        -------
        TableArrays
            All parts one after the other.
        """
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
            value_offset=cumulative_sums(lengths)[:-1],
            n_settings=len(self.settings),
            values=np.concatenate([part.values.ravel() for part in self.parts]),
            squared_height_limit=stops if np.isfinite(stops).any() else np.empty(0),
            **({} if self.finish is None else self.finish.kernel_arrays()),
            **({} if self.safety is None else self.safety.kernel_arrays(self.motions_margin)),
        )
