"""Layers read from files: one grid, one time axis, any number of quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.geometry import field_sampling
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.files.block_cache import BlockCache, GridWindow, Quantity
from thalweg.sea.grids.point_location import Grid, GridLocation
from thalweg.sea.grids.triangle_mesh import Mesh
from thalweg.sea.inspection import RecognisedVariable
from thalweg.sea.layer import Samples, nan_pairs

GAP_FACTOR = 2.5  #: a step this many times its neighbours' is a hole in the data, not a step


class TimeLocation(NamedTuple):
    """Where times lie on an axis: level before (-1 if unknown) and way to the next."""

    level: IntArray
    fraction: FloatArray


@dataclass(frozen=True, eq=False)
class TimeAxis:
    """Native times of a layer; linear between them, except across holes.

    Attributes
    ----------
    times : float64 array (T,)
        Strictly increasing [s since epoch]; empty for fields that hold always.
    """

    times: FloatArray

    @property
    def is_static(self) -> bool:
        """Whether the fields hold always."""
        return self.times.size == 0

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time; None if always."""
        return None if self.is_static else (float(self.times[0]), float(self.times[-1]))

    @property
    def step(self) -> float | None:
        """Median step [s]."""
        return float(np.median(np.diff(self.times))) if self.times.size > 1 else None

    @cached_property
    def holes(self) -> NDArray[np.bool_]:
        """Whether each step (T - 1,) is a hole: longer than 2.5 times both its neighbours."""
        step = np.diff(self.times)
        if step.size < 2:
            return np.zeros(step.size, bool)
        neighbour = np.maximum(np.append(0.0, step[:-1]), np.append(step[1:], 0.0))
        return np.asarray(step > GAP_FACTOR * neighbour)

    def locate(self, time: FloatArray) -> TimeLocation:
        """Return level and fraction of each time."""
        if self.is_static:
            level = np.where(np.isnan(time), -1, 0)
            return TimeLocation(level, np.zeros(time.shape))
        last = self.times.size - 1
        level = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, max(last - 1, 0))
        if last == 0:
            return TimeLocation(np.where(time == self.times[0], 0, -1), np.zeros(time.shape))
        fraction = (time - self.times[level]) / (self.times[level + 1] - self.times[level])
        known = (fraction >= 0.0) & (fraction <= 1.0)
        known &= ~(self.holes[level] & (fraction > 0.0) & (fraction < 1.0))
        whole = fraction == 1.0  # the level itself, so that the next one need not be known
        level = np.where(whole, level + 1, level)
        return TimeLocation(np.where(known, level, -1), np.where(known & ~whole, fraction, 0.0))

    def within(self, start: float, end: float) -> FloatArray:
        """Return times in [start, end], one beyond each side, and the rims of holes."""
        if self.is_static:
            return np.array([start, end]) if end > start else np.array([start])
        if end < self.times[0] or start > self.times[-1]:
            return np.empty(0)
        first = max(0, int(np.searchsorted(self.times, start, side="right")) - 1)
        last = min(self.times.size, int(np.searchsorted(self.times, end, side="left")) + 1)
        hole = np.flatnonzero(self.holes[first : last - 1]) + first
        rims = [self.times[hole] + 1.0, self.times[hole + 1] - 1.0]
        return np.sort(np.concatenate([self.times[first:last], *rims]))


@dataclass(frozen=True)
class RecognitionRecord:
    """What was recognised in the files of a layer, and what was ignored: (file, name, reason)."""

    recognised: tuple[RecognisedVariable, ...] = ()
    ignored: tuple[tuple[str, str, str], ...] = ()


@dataclass(frozen=True, eq=False)
class GridLayer:
    """Quantities of one or more files on one grid and one time axis.

    Attributes
    ----------
    quantities : tuple of Quantity
        What there is.
    grid : Grid
        Where.
    axis : TimeAxis
        When.
    cache : BlockCache
        What was read; sampling may fill it but never changes an answer.
    source : str
        File names.
    facts : mapping
        Name, size and time of change of the files.
    record : Record
        What was recognised.
    """

    quantities: tuple[Quantity, ...]
    grid: Grid
    axis: TimeAxis
    cache: BlockCache
    source: str
    facts: Mapping[str, Any]
    record: RecognitionRecord = RecognitionRecord()

    @cached_property
    def variables(self) -> frozenset[str]:
        """Canonical names of everything the layer holds."""
        return frozenset(name for quantity in self.quantities for name in quantity.names)

    @property
    def area(self) -> BoundingBox:
        """The box around the grid."""
        return self.grid.area

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time; None if the fields hold always."""
        return self.axis.period

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN where unknown."""
        located, moments = self.grid.locate(lat, lon), self.axis.locate(time)
        known = (located.corner[:, 0] >= 0) & (moments.level >= 0)
        samples = {name: np.full(time.shape, np.nan) for name in names}
        if not known.any():
            return samples
        wanted = self._window(located, moments, known)
        for window, blocks in self._read_blocks(names, wanted):
            corner = _places_in_window(located.corner, window, self.grid.shape[1])
            level = np.where(moments.level >= 0, moments.level - window.t0, -1)
            for name, values in blocks.items():
                field_sampling.gather_points(
                    values, corner, located.weight, level, moments.fraction, samples[name]
                )
        return nan_pairs(samples, [v.pair for v in nm.VECTORS])

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times; NaN where unknown."""
        located, moments = self.grid.locate(lat, lon), self.axis.locate(times)
        shape = (lat.size, times.size)
        inside, when = located.corner[:, 0] >= 0, moments.level >= 0
        if not (inside.any() and when.any()):
            return {name: np.full(shape, np.nan) for name in names}
        wanted = self._window(located, moments, inside, when)
        samples = {}
        for window, blocks in self._read_blocks(names, wanted):
            corner = _places_in_window(located.corner, window, self.grid.shape[1])
            level = np.where(when, moments.level - window.t0, -1)
            for name, values in blocks.items():
                samples[name] = np.empty(shape)
                field_sampling.gather_series(
                    values, corner, located.weight, level, moments.fraction, samples[name]
                )
        return nan_pairs(samples, [v.pair for v in nm.VECTORS])

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times over a window, one beyond each side."""
        return self.axis.within(start, end)

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions lie in the grid."""
        return np.asarray(self.grid.locate(lat, lon).corner[:, 0] >= 0)

    def coverage(self) -> list[Coverage]:
        """Return one row per variable."""
        a, (start, end) = self.area, self.period or (None, None)
        return [
            Coverage(
                name, a.south, a.north, a.west, a.east, start, end,
                self.axis.step, self.grid.spacing, self.source,
            )
            for name in sorted(self.variables)
        ]  # fmt: skip

    def mesh(self) -> Mesh | None:
        """Return the mesh, if the grid is one."""
        return self.grid.mesh()

    def provenance(self) -> Mapping[str, Any]:
        """Return files and variables."""
        made = {" ".join(q.names): [v.name for v in q.variables] for q in self.quantities}
        return {"kind": "files", "variables": made, **self.facts}

    def _read_blocks(
        self, names: Sequence[str], wanted: GridWindow
    ) -> list[tuple[GridWindow, dict[str, NDArray[Any]]]]:
        """Return the values that are needed, by the window they were read for."""
        found: dict[GridWindow, dict[str, NDArray[Any]]] = {}
        for quantity in self.quantities:
            mine = [name for name in quantity.names if name in names]
            if mine:
                block = self.cache.block(quantity, wanted)
                group = found.setdefault(block.window, {})
                group.update((name, block.values[name]) for name in mine)
        return list(found.items())

    def _window(
        self,
        located: GridLocation,
        moments: TimeLocation,
        inside: NDArray[np.bool_],
        when: NDArray[np.bool_] | None = None,
    ) -> GridWindow:
        """Return the least window that answers for the points that are inside."""
        level = moments.level[inside if when is None else when]
        fraction = moments.fraction[inside if when is None else when]
        t0, t1 = int(level.min()), int((level + (fraction > 0.0)).max()) + 1
        rows, columns = self.grid.shape
        if rows == 1:
            return GridWindow(t0, t1, 0, 1, 0, columns)
        used = located.corner[inside][located.weight[inside] != 0.0]
        y0, y1 = int(used.min()) // columns, int(used.max()) // columns + 1
        x0, width = _column_range(used % columns, columns, self.grid.wraps)
        return GridWindow(t0, t1, y0, y1, x0, width)


def _column_range(used: IntArray, columns: int, wraps: bool) -> tuple[int, int]:
    """Return first column and number of columns that hold all used ones, round if shorter."""
    if not wraps:
        first = int(used.min())
        return first, int(used.max()) - first + 1
    present = np.flatnonzero(np.bincount(used, minlength=columns))
    gaps = np.diff(np.append(present, present[0] + columns))
    k = int(np.argmax(gaps))
    return int(present[(k + 1) % present.size]), int(columns - gaps[k] + 1)


def _places_in_window(corner: IntArray, window: GridWindow, columns: int) -> IntArray:
    """Return flat places within a window; corners outside it have weight 0 and get place 0."""
    if window.width == columns and window.x0 == 0 and window.y0 == 0:
        return corner
    row, column = np.divmod(corner, columns)
    row = np.clip(row - window.y0, 0, window.y1 - window.y0 - 1)
    column = np.minimum((column - window.x0) % columns, window.width - 1)
    return np.where(corner < 0, -1, row * window.width + column)
