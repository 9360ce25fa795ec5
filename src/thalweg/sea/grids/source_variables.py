"""Variables of files, read for a window of times, rows and columns.

A `Quantity` is one canonical variable (or both components of a vector), with the file variables it
is made from and the conversion to SI units and true components.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.sea import plausible_values

RawArray: TypeAlias = NDArray[Any]
READ_ERRORS = (OSError, RuntimeError, ValueError, IndexError, KeyError, EOFError, OverflowError)
MAX_VALUES_AT_ONCE = 4_000_000  #: values that are read and converted at once


class ChunkSizes(NamedTuple):
    """Levels, rows and columns of the parts in which a file stores a variable; 1 where unknown.

    A compressed file is read in whole chunks: a part of one takes as long as all of it.
    """

    levels: int = 1
    rows: int = 1
    columns: int = 1


class GridWindow(NamedTuple):
    """A part of a grid: times [t0, t1), rows [y0, y1), ``width`` columns from ``x0``, wrapping."""

    t0: int
    t1: int
    y0: int
    y1: int
    x0: int
    width: int

    def contains(self, other: GridWindow, columns: int) -> bool:
        """Return whether this window contains another."""
        offset = (other.x0 - self.x0) % columns
        return (
            self.t0 <= other.t0
            and other.t1 <= self.t1
            and self.y0 <= other.y0
            and other.y1 <= self.y1
            and (self.width == columns or offset + other.width <= self.width)
        )

    @property
    def size(self) -> int:
        """Number of values."""
        return (self.t1 - self.t0) * (self.y1 - self.y0) * self.width


@dataclass(frozen=True, eq=False)
class VariableInFile:
    """A variable in one file.

    Attributes
    ----------
    array : Dimensions (time, row, column), (row, column), (time, node) or (node,); not loaded.
    levels : Number of times.
    has_time : Whether time is its first dimension; else its values belong to one time, or to all.
    factor : Conversion of its values to SI; files of one layer may differ in units.
    valid : (float, float) or None
        Least and greatest valid value in the file's unit; others are missing.
    """

    array: Any
    levels: int
    has_time: bool
    factor: float = 1.0
    valid: tuple[float, float] | None = None

    @property
    def chunks(self) -> ChunkSizes:
        """The chunks of the file."""
        stored = self.array.encoding.get("preferred_chunks") or {}
        sizes = [max(1, int(stored.get(dim, 1))) for dim in self.array.dims]
        levels = sizes[0] if self.has_time else 1
        return ChunkSizes(levels, *sizes[-2:]) if len(sizes) > 2 else ChunkSizes(levels)


@dataclass(frozen=True, eq=False)
class SourceVariable:
    """A variable of one or more files that follow each other in time.

    Attributes
    ----------
    pieces : One per file.
    timed : Whether it has times; if not, there is one piece, which holds at all times.
    is_mesh : bool
        Whether positions are along one dimension (always read whole) instead of rows and columns.
    source : File names, for messages.
    shift : Offset (rows, columns) of a staggered variable: (0, 1) for velocities on the east side
        of cells, (1, 0) on the north side; it is averaged to the centre of the cell.
    """

    name: str
    pieces: tuple[VariableInFile, ...]
    timed: bool
    is_mesh: bool
    source: str
    shift: tuple[int, int] = (0, 0)

    @property
    def is_double(self) -> bool:
        """Whether the file stores double precision."""
        array = self.pieces[0].array
        stored = array.encoding.get("dtype", array.dtype)
        return "scale_factor" not in array.encoding and np.dtype(stored) == np.float64

    def read(self, window: GridWindow, columns: int) -> RawArray:
        """Return values (times, rows, columns); a variable without time has one time."""
        try:
            if any(self.shift):
                return self._averaged_to_centres(window, columns)
            return self._levels(window, columns)
        except READ_ERRORS as error:
            raise DatasetError(
                f"{self.source}: {self.name!r} cannot be read ({error}).",
                "The file opens, but its data are damaged or incomplete.",
                "Download the file again.",
                file=self.source,
                variable=self.name,
            ) from error

    def _levels(self, window: GridWindow, columns: int) -> RawArray:
        if not self.timed:
            return self._read_rows_and_columns(self.pieces[0], slice(None), window, columns)[None]
        parts, first = [], 0
        for piece in self.pieces:
            begin, end = max(window.t0 - first, 0), min(window.t1 - first, piece.levels)
            if begin < end and piece.has_time:
                parts.append(self._read_rows_and_columns(piece, slice(begin, end), window, columns))
            elif begin < end:
                parts.append(self._read_rows_and_columns(piece, slice(None), window, columns)[None])
            first += piece.levels
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def _read_rows_and_columns(
        self, piece: VariableInFile, levels: slice, window: GridWindow, columns: int
    ) -> RawArray:
        """Read rows and columns in SI, in two parts where the window wraps around the grid."""
        values = self._stored(piece.array[levels], window, columns)
        if piece.valid is not None:
            low, high = piece.valid
            values = np.where((values >= low) & (values <= high), values, np.nan)
        return values if piece.factor == 1.0 else np.asarray(values, np.float64) * piece.factor

    def _stored(self, array: Any, window: GridWindow, columns: int) -> RawArray:
        if self.is_mesh:
            return np.asarray(array.values)[..., None, :]
        rows = array[..., window.y0 : window.y1, :]
        x1 = window.x0 + window.width
        parts = [rows[..., window.x0 : min(x1, columns)].values]
        if x1 > columns:
            parts.append(rows[..., : x1 - columns].values)
        values = np.asarray(parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1))
        if not any(self.shift):
            return values
        missing = (window.y1 - window.y0 - values.shape[-2], window.width - values.shape[-1])
        if missing == (0, 0):
            return values
        # ROMS has one row or column less on the sides of cells than at their centres
        wide = [(0, 0)] * (values.ndim - 2) + [(0, n) for n in missing]
        return np.pad(np.asarray(values, np.float64), wide, constant_values=np.nan)

    def _averaged_to_centres(self, window: GridWindow, columns: int) -> RawArray:
        """Average a staggered variable with its value one row or column before; NaN without one."""
        dy, dx = self.shift
        y0, x0 = max(0, window.y0 - dy), max(0, window.x0 - dx)
        wide = window._replace(y0=y0, x0=x0, width=window.width + window.x0 - x0)
        values = self._levels(wide, columns)
        axis = -2 if dy else -1
        if y0 == window.y0 and x0 == window.x0:
            edge = np.full_like(np.take(values, [0], axis=axis), np.nan)
            values = np.concatenate([edge, values], axis=axis)
        if dy:
            return 0.5 * (values[..., 1:, :] + values[..., :-1, :])
        return 0.5 * (values[..., 1:] + values[..., :-1])


Conversion: TypeAlias = Callable[[Sequence[FloatArray], GridWindow], Sequence[FloatArray]]


@dataclass(frozen=True, eq=False)
class Quantity:
    """One canonical variable, or both components of a vector, made from variables of files.

    Attributes
    ----------
    variables : The file variables they are made from.
    make : ``make(arrays, window) -> arrays``: components, rotation, averaging.
    source : File names.
    layers : Number of vertical layers that are read for each value.
    """

    names: tuple[str, ...]
    variables: tuple[SourceVariable, ...]
    make: Conversion
    source: str
    layers: int = 1

    @property
    def _kind(self) -> type[np.floating[Any]]:
        return np.float64 if any(v.is_double for v in self.variables) else np.float32

    @property
    def bytes_per_value(self) -> int:
        """Bytes of one value of all its names."""
        return np.dtype(self._kind).itemsize * len(self.names)

    @cached_property
    def chunks(self) -> ChunkSizes:
        """The largest chunks of its variables."""
        stored = [v.pieces[0].chunks for v in self.variables]
        return ChunkSizes(*(max(sizes) for sizes in zip(*stored)))

    def read(self, window: GridWindow, columns: int) -> dict[str, RawArray]:
        """Return arrays (times, points) by canonical name, checked for plausible values."""
        levels, rows = _level_count(window), window.y1 - window.y0
        most = MAX_VALUES_AT_ONCE // self.layers
        if window.size <= most or not any(v.timed for v in self.variables):
            return self._read(window, columns)
        # whole chunks: first as few levels as needed, then as many rows as that leaves
        at_once = _in_chunks(most // (rows * window.width), self.chunks.levels)
        rows_at_once = _in_chunks(most // (min(at_once, levels) * window.width), self.chunks.rows)
        shape = (levels, rows, window.width)
        found = {name: np.empty(shape, self._kind) for name in self.names}
        for t0, t1 in _steps(window.t0, window.t1, at_once):
            for y0, y1 in _steps(window.y0, window.y1, rows_at_once):
                part = window._replace(t0=t0, t1=t1, y0=y0, y1=y1)
                place = slice(t0 - window.t0, t1 - window.t0), slice(y0 - window.y0, y1 - window.y0)
                for name, values in self._read(part, columns).items():
                    found[name][place] = values.reshape(t1 - t0, y1 - y0, -1)
        return {name: values.reshape(levels, -1) for name, values in found.items()}

    def _read(self, window: GridWindow, columns: int) -> dict[str, RawArray]:
        raws = [np.asarray(v.read(window, columns), np.float64) for v in self.variables]
        made = {}
        for name, value in zip(self.names, self.make(raws, window)):
            plausible_values.check_plausible(
                name, value, [v.name for v in self.variables], self.source
            )
            value = plausible_values.without_packing_error(name, value)
            made[name] = np.ascontiguousarray(value.reshape(value.shape[0], -1), self._kind)
        return made


def _level_count(window: GridWindow) -> int:
    return max(1, window.t1 - window.t0)


def _in_chunks(wanted: int, chunk: int) -> int:
    """Return a number of whole chunks not above what is wanted, one at least."""
    return max(chunk, wanted - wanted % chunk)


def _steps(first: int, last: int, size: int) -> Iterator[tuple[int, int]]:
    """Yield ranges that cover [first, last) and begin at multiples of a size."""
    begin = first
    while begin < last:
        end = min(last, begin - begin % size + size)
        yield begin, end
        begin = end
