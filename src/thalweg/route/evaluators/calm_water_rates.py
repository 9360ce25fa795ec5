"""Speed and fuel rate of a ship in calm water, read from its tables."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.kernels.codes import AXIS_COUNT, AXIS_DEPTH, AXIS_WAVE_PERIOD
from thalweg.kernels.leg.table_lookup import TableArrays, table_value


def calm_water_value(table: TableArrays, setting: int) -> float:
    """Return a table's value without wind and waves in deep water; NaN if it has none.

    Parameters
    ----------
    table : Speed [m/s] or fuel rate [kg/s].
    setting : From 0.

    Returns
    -------
    float : In the unit of the table.
    """
    value, ok = table_value(table, _calm_axis_values(table), setting)
    return float(value) if ok else float("nan")


def calm_water_values(table: TableArrays) -> FloatArray:
    """Return the calm-water value of every setting."""
    return np.array([calm_water_value(table, setting) for setting in range(table.n_settings)])


def _calm_axis_values(table: TableArrays) -> tuple[float, ...]:
    """Return a calm-water value for every axis: the nearest to zero, but the greatest depth."""
    values = np.zeros(AXIS_COUNT)
    for part, ids in enumerate(table.part_axes):
        for k, axis in enumerate(ids):
            if axis < 0:
                break
            low = table.axis_start[part, k]
            high = low + (table.axis_size[part, k] - 1) / table.axis_inv_step[part, k]
            if axis == AXIS_DEPTH:
                values[axis] = 1e6
            elif axis == AXIS_WAVE_PERIOD:
                values[axis] = max(values[axis], low)
            else:
                values[axis] = min(max(0.0, low), high)
    return tuple(values.tolist())
