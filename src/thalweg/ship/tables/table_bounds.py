"""Bounds of the values of a performance table."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels.leg.table_lookup import CURVE_INTERSECTION, OUTPUT_CURVE, TableArrays


def table_bounds(table: TableArrays, of: np.ufunc) -> FloatArray:
    """Return the largest (np.fmax) or least (np.fmin) value of a table by setting, or beyond it.

    Parts take their extremes each for itself.

    Parameters
    ----------
    table : TableArrays
        The table.
    of : numpy.ufunc
        ``numpy.fmax`` or ``numpy.fmin``.

    Returns
    -------
    ndarray (settings,)
        Bounds in the unit of the table.
    """
    columns = table.n_columns or table.n_settings
    low, high = np.zeros(columns), np.zeros(columns)
    for part, start in enumerate(table.value_offset):
        used = table.part_axes[part] >= 0
        size = int(np.prod(table.axis_size[part][used])) * columns
        values = table.values[start : start + size].reshape(-1, columns).astype(float)
        stop = table.squared_height_limit[part] if len(table.squared_height_limit) else math.nan
        least, most = np.fmin.reduce(values, axis=0), np.fmax.reduce(values, axis=0)
        if not math.isnan(stop):  # times the square of the wave height, which may be nothing
            least, most = np.fmin(least * stop**2, 0.0), np.fmax(most * stop**2, 0.0)
        low, high = low + least, high + most
    if (
        table.finish == CURVE_INTERSECTION
    ):  # a speed between nothing and the greatest of the setting
        return table.curve_top.copy() if of is np.fmax else np.zeros(table.n_settings)
    if table.finish == OUTPUT_CURVE:
        return _curve_bounds(table, low, high, of)
    return high if of is np.fmax else low


def _curve_bounds(
    table: TableArrays, low: FloatArray, high: FloatArray, of: np.ufunc
) -> FloatArray:
    """Return the extreme of every curve between the least and the greatest sum."""
    found = np.empty(table.n_settings)
    last = table.curve.shape[1] - 1
    for s, points in enumerate(table.curve):
        x = (np.array([low[s], high[s]]) - table.curve_start[s]) * table.curve_inv_step[s]
        first, end = np.clip([np.floor(x[0]), np.ceil(x[1])], 0, last).astype(int)
        found[s] = of.reduce(points[first : end + 1])
    return found
