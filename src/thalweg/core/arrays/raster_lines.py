"""Lines and cells of a raster with lines of data between its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from thalweg.core.types import Float32Array, FloatArray, IntArray

#: Lines so near each other count as one, as a share of the spacing.
ON_LINE: Final = 1e-3
_ROUNDING: Final = 1e-9


def lines_with_raster(own: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Return lines within a raster with those of the raster itself, in steps of it, and where.

    Lines of the data that are nearly on those of the raster count as on them; the second are their
    own places, which may be at the edge of the data.
    """
    own = np.unique(own)
    near, apart = np.round(own), np.diff(own)
    # turned by 360 degrees a line may be there twice, a rounding apart
    tolerance = ON_LINE * min(1.0, float(apart[apart > _ROUNDING].min(initial=1.0)))
    line = np.where(np.abs(own - near) < tolerance, near, own)
    inside = (line >= 0.0) & (line <= count - 1)
    lines = np.union1d(line[inside], np.arange(float(count)))
    places = lines.copy()
    places[np.searchsorted(lines, line[inside])] = own[inside]
    return lines, places


def places_of_raster(line: FloatArray) -> IntArray:
    """Return the places of the lines of the raster among all lines."""
    return np.flatnonzero(line == np.round(line))


def combined_in_cells(values: Any, parts: Sequence[IntArray], combine: np.ufunc) -> Any:
    """Combine values on lines (T, rows, columns) in each cell of the raster with its edges."""
    for axis, starts in zip((1, 2), parts):
        inside = combine.reduceat(values, starts[:-1], axis=axis)
        # a part of `reduceat` ends before the next begins, the last one at the end
        values = combine(inside, values.take(starts[1:], axis=axis))
    return values


def values_on_lines(values: Float32Array, lines: tuple[FloatArray, FloatArray]) -> FloatArray:
    """Return values of a raster (T, Y, X) where lines cross, (T, rows, columns)."""
    found: FloatArray = np.asarray(values, float)
    for axis, line in zip((1, 2), lines):
        place = np.minimum(line.astype(int), values.shape[axis] - 2)
        share = (line - place).reshape((-1, 1) if axis == 1 else (-1,))
        low, high = found.take(place, axis=axis), found.take(place + 1, axis=axis)
        # a node of weight zero may be unknown
        found = np.where(
            share == 0.0, low, np.where(share == 1.0, high, low + share * (high - low))
        )
    return found


def cells_of_boxes(low: IntArray, high: IntArray, columns: int) -> tuple[IntArray, IntArray]:
    """Return the number of a box and the flat number of a cell for all cells of all boxes."""
    size = high - low + 1
    count = size[0] * size[1]
    number = np.repeat(np.arange(count.size), count)
    within = np.arange(number.size) - np.repeat(np.cumsum(count) - count, count)
    j, i = np.divmod(within, size[1][number])
    return number, (low[0][number] + j) * columns + low[1][number] + i
