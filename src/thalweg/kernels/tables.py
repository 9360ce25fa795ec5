"""Performance tables in kernels: a sum of multilinear look-ups on uniform axes."""

from typing import NamedTuple

import numpy as np

from thalweg.kernels.bare import bare, inlined
from thalweg.kernels.codes import AXES, AXIS_DEPTH

MOST_AXES = 6  # of one part
_EDGE = 1e-6  # rounding allowed beyond the first and last grid point [grid steps]


class TableArrays(NamedTuple):
    """A performance table as kernels see it: speed is the sum over parts of multilinear look-ups.

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
    n_settings : int
        Number of settings; the setting is the innermost axis of every part.
    values : float32[:]
        Values of all parts, C order, one part after another [m/s]; NaN where the model refuses.
    """

    part_axes: np.ndarray
    axis_start: np.ndarray
    axis_inv_step: np.ndarray
    axis_size: np.ndarray
    value_offset: np.ndarray
    n_settings: int
    values: np.ndarray


@bare
def axes_needed(table):
    """Return a bit mask of the axes that any part of a table has (bit i: axis id i)."""
    mask = 0
    for part in range(table.part_axes.shape[0]):
        for k in range(AXES):
            axis = table.part_axes[part, k]
            if axis < 0:
                break
            mask |= 1 << axis
    return mask


@inlined
def _line(values, base, stride, f):
    """Interpolate between two values ``stride`` apart; a corner of weight 0 is not read."""
    if f == 0.0:
        return float(values[base])
    if f == 1.0:
        return float(values[base + stride])
    return values[base] + f * (values[base + stride] - values[base])


@inlined
def _square(values, base, stride0, f0, stride1, f1):
    """Interpolate on a cell of two axes."""
    low = _line(values, base, stride1, f1)
    if f0 == 0.0:
        return low
    high = _line(values, base + stride0, stride1, f1)
    return high if f0 == 1.0 else low + f0 * (high - low)


@inlined
def part_value(table, part, axis_values, setting):
    """Return (value, ok) of one part of a table; see `table_value`."""
    f0, f1, f2, f3, f4, f5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0  # fractions, the last axis first
    s0, s1, s2, s3, s4, s5 = 0, 0, 0, 0, 0, 0  # strides
    corners = 1  # of the axes before the last two
    base, stride = table.value_offset[part] + setting, table.n_settings
    for k in range(AXES - 1, -1, -1):
        axis = table.part_axes[part, k]
        if axis < 0:
            continue
        last = table.axis_size[part, k] - 1
        x = (axis_values[axis] - table.axis_start[part, k]) * table.axis_inv_step[part, k]
        if axis == AXIS_DEPTH and x > last:
            x = float(last)
        if not (x >= -_EDGE and x <= last + _EDGE) or k >= MOST_AXES:
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
            total += weight * _square(table.values, at, s1, f1, s0, f0)
    return total, True


@inlined
def sum_of_parts(table, axis_values, setting):
    """Do as `table_value`, inside kernels."""
    total = 0.0
    for part in range(table.part_axes.shape[0]):
        value, ok = part_value(table, part, axis_values, setting)
        if not ok:
            return 0.0, False
        total += value
    return total, total == total


@bare
def table_value(table, axis_values, setting):
    """Return the value of a table: the sum over its parts of multilinear look-ups.

    Parameters
    ----------
    table : TableArrays
    axis_values : tuple of 6 float
        Value on every axis, by axis id, SI; those of axes the table lacks are not read.
    setting : int
        0 <= setting < ``n_settings`` (not checked).

    Returns
    -------
    value : float
        Speed through water [m/s].
    ok : bool
        False outside an axis (no extrapolation; only depth beyond the deepest grid point counts as
        that point), for NaN on an axis and where the table itself holds NaN.
    """
    return sum_of_parts(table, axis_values, setting)
