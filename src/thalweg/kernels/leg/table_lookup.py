"""Performance tables in kernels: sums of multilinear look-ups on uniform axes, and what follows."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    AXIS_COUNT,
    AXIS_DEPTH,
    AXIS_WAVE_ANGLE,
    AXIS_WAVE_HEIGHT,
    AXIS_WAVE_PERIOD,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined

MAX_AXES = 6  # of one part
OUTPUT_CURVE, CURVE_INTERSECTION = 1, 2  # what may follow the sum
CURVE_REFINEMENT = 8  # points of a curve for each column of a crossing
MAX_PLANES = 3  # parts of a table with a crossing, each of at most two axes
_EDGE_TOLERANCE = 1e-6  # rounding allowed beyond the first and last grid point [grid steps]


class TableArrays(NamedTuple):
    """A performance table as kernels see it: a sum over parts of multilinear look-ups.

    The sum is the value (speed through water, fuel rate), or leads to it: by a curve, or by the
    speed at which a curve crosses it (see `thalweg.ship.tables.output_curve.OutputCurve`).

    Attributes
    ----------
    part_axes : int64[P, 6]
        Axis ids (``AXIS_*`` of `thalweg.kernels.codes`) of each part, in the order of its values;
        -1 after the last, at most 6. A part without axes is a constant per setting.
    axis_start : float64[P, 6]
        First grid point of each axis (SI; angles in radians from the bow, 0 to pi).
    axis_inv_step : float64[P, 6]
        One over the grid step.
    axis_size : int64[P, 6]
        Number of grid points, at least 2 (any value where there is no axis).
    value_offset : int64[P]
        Where the values of each part start in ``values``.
    n_settings : Number of settings.
    values : float32[:]
        Values of all parts, C order, one part after another; NaN where the model refuses. The
        innermost axis of every part is the setting, or the column of a crossing.
    n_columns : Length of the innermost axis; 0 when it is that of the settings.
    squared_height_limit : float64[P]
        Parts are multiplied by the square of the wave height, up to this height [m]; NaN: not
        multiplied. Empty when none is.
    finish : 0 when the sum is the value, else `OUTPUT_CURVE` or `CURVE_INTERSECTION`.
    curve_start, curve_inv_step, curve_top : float64[settings]
        Where each curve begins and one over the step of its points; greatest value.
    curve : float64[settings, points]
        Points of the curves; before a crossing `CURVE_REFINEMENT` steps to a column.
    curve_guess : int64[settings]
        Column at which a search for the crossing begins.
    safety : float64[7]
        Limits of safety in waves (see `thalweg.kernels.leg.wave_limits`); empty if there are none.
    motions : float32[speeds, angles, periods]
        One over the wave height that reaches a limit of motions [1/m]; empty when there is none.
    motion_grid : float64[3, 2]
        First point and one over the step of its axes.
    """

    part_axes: np.ndarray
    axis_start: np.ndarray
    axis_inv_step: np.ndarray
    axis_size: np.ndarray
    value_offset: np.ndarray
    n_settings: int
    values: np.ndarray
    n_columns: int = 0
    squared_height_limit: np.ndarray = np.empty(0)
    finish: int = 0
    curve_start: np.ndarray = np.empty(0)
    curve_inv_step: np.ndarray = np.empty(0)
    curve_top: np.ndarray = np.empty(0)
    curve: np.ndarray = np.empty((0, 0))
    curve_guess: np.ndarray = np.empty(0, np.int64)
    safety: np.ndarray = np.empty(0)
    motions: np.ndarray = np.empty((0, 0, 0), np.float32)
    motion_grid: np.ndarray = np.empty((0, 0))


#: The type of every array of `TableArrays`.
ARRAY_TYPES = {
    "part_axes": np.int64,
    "axis_start": np.float64,
    "axis_inv_step": np.float64,
    "axis_size": np.int64,
    "value_offset": np.int64,
    "values": np.float32,
    "squared_height_limit": np.float64,
    "curve_start": np.float64,
    "curve_inv_step": np.float64,
    "curve_top": np.float64,
    "curve": np.float64,
    "curve_guess": np.int64,
    "safety": np.float64,
    "motions": np.float32,
    "motion_grid": np.float64,
}


@inlined
def has_wave_limits(table):
    """Return whether there is something a ship must not do in waves."""
    return table.safety.shape[0] > 0 or table.motions.shape[0] > 0


@allocation_free
def axes_needed(table):
    """Return a bit mask of the axes that any part of a table has (bit i: axis id i)."""
    mask = 0
    for part in range(table.part_axes.shape[0]):
        for k in range(AXIS_COUNT):
            axis = table.part_axes[part, k]
            if axis < 0:
                break
            mask |= 1 << axis
    for part in range(table.squared_height_limit.shape[0]):
        if table.squared_height_limit[part] == table.squared_height_limit[part]:
            mask |= 1 << AXIS_WAVE_HEIGHT
    if has_wave_limits(table):
        mask |= (1 << AXIS_WAVE_HEIGHT) | (1 << AXIS_WAVE_ANGLE) | (1 << AXIS_WAVE_PERIOD)
    return mask


@inlined
def _innermost_size(table):
    """Return the length of the innermost axis."""
    return table.n_columns if table.n_columns > 0 else table.n_settings


@inlined
def _square_of_height(table, part, axis_values):
    """Return (factor, ok): what a part is multiplied by."""
    if table.squared_height_limit.shape[0] == 0:
        return 1.0, True
    stop = table.squared_height_limit[part]
    if stop != stop:
        return 1.0, True
    height = axis_values[AXIS_WAVE_HEIGHT]
    return height * height, height >= 0.0 and height <= stop * (1.0 + _EDGE_TOLERANCE)


@inlined
def _linear(values, base, stride, f):
    """Interpolate between two values ``stride`` apart; a corner of weight 0 is not read."""
    if f == 0.0:
        return float(values[base])
    if f == 1.0:
        return float(values[base + stride])
    return values[base] + f * (values[base + stride] - values[base])


@inlined
def _bilinear(values, base, stride0, f0, stride1, f1):
    """Interpolate on a cell of two axes."""
    low = _linear(values, base, stride1, f1)
    if f0 == 0.0:
        return low
    high = _linear(values, base + stride0, stride1, f1)
    return high if f0 == 1.0 else low + f0 * (high - low)


@inlined
def part_value(table, part, axis_values, setting):
    """Return (value, ok) of one part of a table; see `table_value`."""
    f0, f1, f2, f3, f4, f5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  # fractions, the last axis first
    s0, s1, s2, s3, s4, s5 = 0, 0, 0, 0, 0, 0  # strides
    corners = 1  # of the axes before the last two
    base, stride = table.value_offset[part] + setting, _innermost_size(table)
    factor, inside = _square_of_height(table, part, axis_values)
    if not inside:
        return 0.0, False
    for k in range(AXIS_COUNT - 1, -1, -1):
        axis = table.part_axes[part, k]
        if axis < 0:
            continue
        last = table.axis_size[part, k] - 1
        x = (axis_values[axis] - table.axis_start[part, k]) * table.axis_inv_step[part, k]
        if axis == AXIS_DEPTH and x > last:
            x = float(last)
        if not (x >= -_EDGE_TOLERANCE and x <= last + _EDGE_TOLERANCE) or k >= MAX_AXES:
            return 0.0, False
        x = min(max(x, 0.0), float(last))
        cell = min(int(x), last - 1)
        base += cell * stride
        f5, f4, f3, f2, f1, f0 = f4, f3, f2, f1, f0, x - cell
        s5, s4, s3, s2, s1, s0 = s4, s3, s2, s1, s0, stride
        stride *= table.axis_size[part, k]
        corners = max(corners, 16 if k > 3 else 4 if k > 1 else 1)
    total = 0.0
    for corner in range(corners):
        up2, up3, up4, up5 = corner & 1, corner >> 1 & 1, corner >> 2 & 1, corner >> 3
        weight = (f2 if up2 else 1.0 - f2) * (f3 if up3 else 1.0 - f3)
        if corners > 4:
            weight *= (f4 if up4 else 1.0 - f4) * (f5 if up5 else 1.0 - f5)
        if weight > 0.0:
            at = base + up2 * s2 + up3 * s3 + up4 * s4 + up5 * s5
            total += weight * _bilinear(table.values, at, s1, f1, s0, f0)
    return factor * total, True


@inlined
def _bilinear_corners(table, part, axis_values):
    """Return (ok, four places in the values, their four weights) of a part of at most two axes.

    Corners of weight 0 are replaced by others, so that unknown values there do not count.
    """
    if part >= table.part_axes.shape[0]:
        return True, 0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0
    f0, f1, s0, s1 = 0.0, 0.0, 0, 0
    base, stride = table.value_offset[part], table.n_columns
    for k in (1, 0):
        axis = table.part_axes[part, k]
        if axis < 0:
            continue
        last = table.axis_size[part, k] - 1
        x = (axis_values[axis] - table.axis_start[part, k]) * table.axis_inv_step[part, k]
        if axis == AXIS_DEPTH and x > last:
            x = float(last)
        if not (x >= -_EDGE_TOLERANCE and x <= last + _EDGE_TOLERANCE):
            return False, 0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0
        x = min(max(x, 0.0), float(last))
        cell = int(x)
        base += cell * stride
        f1, s1 = f0, s0
        f0 = x - cell
        s0 = stride if f0 > 0.0 else 0
        stride *= table.axis_size[part, k]
    factor, inside = _square_of_height(table, part, axis_values)
    near, far = factor * (1.0 - f0), factor * f0
    return (
        inside,
        base,
        base + s1,
        base + s0,
        base + s0 + s1,
        near * (1.0 - f1),
        near * f1,
        far * (1.0 - f1),
        far * f1,
    )


@inlined
def _column_value(values, plane, column):
    """Return one column of a part at its place."""
    total = values[plane[1] + column] * plane[5] + values[plane[2] + column] * plane[6]
    return total + values[plane[3] + column] * plane[7] + values[plane[4] + column] * plane[8]


@inlined
def _sum_at_column(table, planes, column):
    """Return the sum over the parts at one column."""
    count = table.part_axes.shape[0]
    total = _column_value(table.values, planes[0], column)
    if count > 1:
        total += _column_value(table.values, planes[1], column)
    if count > 2:
        total += _column_value(table.values, planes[2], column)
    return total


@inlined
def _speed_at_intersection(table, axis_values, setting):
    """Return (speed, ok) at which the sum rises through the curve; 0 where it is above it all."""
    part = np.int64(0)  # not a literal: each would be compiled by itself
    first = _bilinear_corners(table, part, axis_values)
    second = _bilinear_corners(table, part + 1, axis_values)
    third = _bilinear_corners(table, part + 2, axis_values)
    if not (first[0] and second[0] and third[0]):
        return 0.0, False
    planes = (first, second, third)
    low, high = -1, table.n_columns
    under, over = 0.0, 0.0
    guess = table.curve_guess[setting]
    column = guess
    while high - low > 1:
        target_sum = _sum_at_column(table, planes, column)
        if target_sum != target_sum:
            return 0.0, False
        if target_sum < table.curve[setting, column * CURVE_REFINEMENT]:
            low, under = column, target_sum
        else:
            high, over = column, target_sum
        if low < 0:  # down in growing steps, up one by one, then in halves
            column = high - 1 if high == guess else high >> 1
        else:
            column = low + 1 if high == table.n_columns else (low + high) >> 1
    top = table.curve_top[setting]
    if low < 0:
        return 0.0, True
    if high == table.n_columns:
        return top, True
    place = low * CURVE_REFINEMENT + _curve_intersection(
        table, setting, low * CURVE_REFINEMENT, under, over
    )
    return min(table.curve_start[setting] + place / table.curve_inv_step[setting], top), True


@inlined
def _curve_intersection(table, setting, base, under, over):
    """Return where a line from ``under`` to ``over`` meets the curve of a setting [points]."""
    low, high = 0, CURVE_REFINEMENT
    slope = (over - under) / CURVE_REFINEMENT
    while high - low > 1:
        middle = (low + high) >> 1
        if under + middle * slope < table.curve[setting, base + middle]:
            low = middle
        else:
            high = middle
    before = under + low * slope - table.curve[setting, base + low]
    after = under + high * slope - table.curve[setting, base + high]
    return low + before / (before - after)


@inlined
def _curve_position(table, total, setting):
    """Return the point of the curve of a setting at a sum; the ends hold beyond them."""
    last = table.curve.shape[1] - 1
    x = (total - table.curve_start[setting]) * table.curve_inv_step[setting]
    x = min(max(x, 0.0), float(last))
    cell = min(int(x), last - 1)
    low, high = table.curve[setting, cell], table.curve[setting, cell + 1]
    return low + (x - cell) * (high - low)


@inlined
def sum_of_parts(table, axis_values, setting):
    """Do as `table_value`, inside kernels."""
    if table.finish == CURVE_INTERSECTION:
        return _speed_at_intersection(table, axis_values, setting)
    total = 0.0
    for part in range(table.part_axes.shape[0]):
        value, ok = part_value(table, part, axis_values, setting)
        if not ok:
            return 0.0, False
        total += value
    if total != total:
        return math.nan, False
    if table.finish == OUTPUT_CURVE:
        total = _curve_position(table, total, setting)
    return total, True


@allocation_free
def table_value(table, axis_values, setting):
    """Return the value of a table: the sum over its parts of multilinear look-ups, or what follows.

    Parameters
    ----------
    table : TableArrays
    axis_values : tuple of 6 float
        Value on every axis, by axis id, SI; those of axes the table lacks are not read.
    setting : int
        0 <= setting < ``n_settings`` (not checked).

    Returns
    -------
    value : Speed through water [m/s], or fuel rate [kg/s].
    ok : False outside an axis (no extrapolation; only depth beyond the deepest grid point counts as
        that point), for NaN on an axis and where the table itself holds NaN.
    """
    return sum_of_parts(table, axis_values, setting)
