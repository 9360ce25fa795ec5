"""Layers read from files: any number of quantities on one grid and one time axis."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.geometry import field_sampling
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.block_cache import MAX_UNION_BYTES, BlockCache
from thalweg.sea.grids.grid_protocol import Grid, GridLocation
from thalweg.sea.grids.source_variables import GridWindow, Quantity
from thalweg.sea.grids.time_axis import TimeAxis, TimeLocation
from thalweg.sea.layer import Samples, nan_pairs
from thalweg.sea.recognition_record import RecognitionRecord
from thalweg.sea.triangle_mesh import Mesh

MAX_WINDOW_BYTES = 400_000_000  #: of all quantities that are read for one window


@dataclass(frozen=True, eq=False)
class GridLayer:
    """Quantities of one or more files on one grid and one time axis.

    Attributes
    ----------
    grid : Grid points of the values.
    axis : Times of the values.
    cache : Values read so far; it changes no result.
    source : File names.
    facts : Name, size and modification time of the files.
    record : Recognised and ignored variables.
    """

    quantities: tuple[Quantity, ...]
    grid: Grid
    axis: TimeAxis
    cache: BlockCache
    source: str
    facts: Mapping[str, Any]
    record: RecognitionRecord = field(default_factory=RecognitionRecord)
    _located: list[tuple[FloatArray, FloatArray, GridLocation]] = field(
        default_factory=list, init=False, repr=False
    )

    @cached_property
    def variables(self) -> frozenset[str]:
        """Canonical names of the variables of the layer."""
        return frozenset(name for quantity in self.quantities for name in quantity.names)

    @property
    def area(self) -> BoundingBox:
        """The box around the grid."""
        return self.grid.area

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time [s since epoch]; None if the fields hold at all times."""
        return self.axis.period

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN where unknown."""
        located, moments = self._locate(lat, lon), self.axis.locate(time)
        known = (located.corner[:, 0] >= 0) & (moments.level >= 0)
        samples = {name: np.full(time.shape, np.nan) for name in names}
        if not known.any():
            return samples
        wanted = self._window(located, moments, known)
        for part in self._parts_in_time(names, wanted, moments, known):
            found = self.sample(names, time[part], lat[part], lon[part])
            for name, values in found.items():
                samples[name][part] = values
            known[part] = False
        if not known.any():
            return samples
        for window, blocks in self._read_blocks(names, wanted):
            corner = _indices_in_window(located.corner, window, self.grid.shape[1])
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
        return self.series_at(names, times, self._locate(lat, lon))

    def series_at(self, names: Sequence[str], times: FloatArray, located: GridLocation) -> Samples:
        """Return values (S, T) at places in the grid for all times; NaN where unknown."""
        moments = self.axis.locate(times)
        shape = (len(located.corner), times.size)
        inside, when = located.corner[:, 0] >= 0, moments.level >= 0
        if not (inside.any() and when.any()):
            return {name: np.full(shape, np.nan) for name in names}
        wanted = self._window(located, moments, inside, when)
        parts = self._parts_in_time(names, wanted, moments, when)
        if parts:
            samples = {name: np.full(shape, np.nan) for name in names}
            for part in parts:
                for name, values in self.series_at(names, times[part], located).items():
                    samples[name][:, part] = values
            return samples
        samples = {}
        for window, blocks in self._read_blocks(names, wanted):
            corner = _indices_in_window(located.corner, window, self.grid.shape[1])
            level = np.where(when, moments.level - window.t0, -1)
            for name, values in blocks.items():
                samples[name] = np.empty(shape)
                field_sampling.gather_series(
                    values, corner, located.weight, level, moments.fraction, samples[name]
                )
        return nan_pairs(samples, [v.pair for v in nm.VECTORS])

    def is_read_in_parts(
        self, names: Collection[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> bool:
        """Return whether the values for all stations and times are more than the cache holds."""
        located, moments = self._locate(lat, lon), self.axis.locate(times)
        inside, when = located.corner[:, 0] >= 0, moments.level >= 0
        if not (inside.any() and when.any()):
            return False
        size = self._window(located, moments, inside, when).size
        asked = [q for q in self.quantities if not set(q.names).isdisjoint(names)]
        return any(size * q.bytes_per_value > MAX_UNION_BYTES for q in asked)

    def _locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        """Return where positions are in the grid; the last ones are kept."""
        for last_lat, last_lon, found in self._located:
            if np.array_equal(last_lat, lat) and np.array_equal(last_lon, lon):
                return found
        located = self.grid.locate(lat, lon)
        self._located[:] = [(lat.copy(), lon.copy(), located)]
        return located

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times over a window, one beyond each side."""
        return self.axis.within(start, end)

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether positions are in the grid."""
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
        """Return the values that are needed, by window."""
        found: dict[GridWindow, dict[str, NDArray[Any]]] = {}
        for quantity in self.quantities:
            own = [name for name in quantity.names if name in names]
            if own:
                block = self.cache.block(quantity, wanted)
                group = found.setdefault(block.window, {})
                group.update((name, block.values[name]) for name in own)
        return list(found.items())

    def _parts_in_time(
        self, names: Sequence[str], wanted: GridWindow, moments: TimeLocation, known: BoolArray
    ) -> list[NDArray[np.intp]]:
        """Return points in groups of near times, where one window would take too much memory."""
        asked = [q for q in self.quantities if not set(q.names).isdisjoint(names)]
        each = wanted.size // (wanted.t1 - wanted.t0) * sum(q.bytes_per_value for q in asked)
        levels = max(2, MAX_WINDOW_BYTES // max(1, each)) - 1  # one more is read at the end
        if wanted.t1 - wanted.t0 <= levels + 1:
            return []
        points = np.flatnonzero(known)
        group = (moments.level[points] - wanted.t0) // levels
        return [points[group == number] for number in np.unique(group)]

    def _window(
        self,
        located: GridLocation,
        moments: TimeLocation,
        inside: BoolArray,
        when: BoolArray | None = None,
    ) -> GridWindow:
        """Return the smallest window with all values needed for the points that are inside."""
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
    """Return the first and the number of columns with all used ones, across the seam if shorter."""
    if not wraps:
        first = int(used.min())
        return first, int(used.max()) - first + 1
    present = np.flatnonzero(np.bincount(used, minlength=columns))
    gaps = np.diff(np.append(present, present[0] + columns))
    k = int(np.argmax(gaps))
    return int(present[(k + 1) % present.size]), int(columns - gaps[k] + 1)


def _indices_in_window(corner: IntArray, window: GridWindow, columns: int) -> IntArray:
    """Return flat indices within a window; corners outside it have weight 0 and get index 0."""
    if window.width == columns and window.x0 == 0 and window.y0 == 0:
        return corner
    row, column = np.divmod(corner, columns)
    row = np.clip(row - window.y0, 0, window.y1 - window.y0 - 1)
    column = np.minimum((column - window.x0) % columns, window.width - 1)
    return np.where(corner < 0, -1, row * window.width + column)
