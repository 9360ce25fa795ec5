"""Performance tables in kernels: a sum of multilinear look-ups on uniform axes."""

from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import AXES, AXIS_DEPTH
from thalweg.kernels.bare import bare, inlined

_EDGE = 1e-6  # rounding allowed beyond the first and last grid point [grid steps]


class TableArrays(NamedTuple):
    """A performance table as kernels see it: speed is the sum over parts of multilinear look-ups.

    Attributes
    ----------
    part_axes : int64[P, 6]
        Axis ids (``AXIS_*`` of `thalweg.kernels.codes`) of each part, in the order of its values;
        -1 after the last. A part without axes is a constant per setting.
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
def _place(table, part, k, axis_values):
    """Return (cell, fraction, ok) of a value on axis k of a part; the deepest depth reaches on."""
    axis = table.part_axes[part, k]
    last = table.axis_size[part, k] - 1
    x = (axis_values[axis] - table.axis_start[part, k]) * table.axis_inv_step[part, k]
    if axis == AXIS_DEPTH and x > last:
        x = float(last)
    ok = (x >= -_EDGE) & (x <= last + _EDGE)
    if not ok:
        return 0, 0.0, False
    x = min(max(x, 0.0), float(last))
    cell = min(int(x), last - 1)
    return cell, x - cell, True


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


@bare
def _hypercube(table, part, n_axes, axis_values, setting):
    """Interpolate on three axes and more: corners of the leading axes times a square."""
    size = table.n_settings
    i1, f1, ok1 = _place(table, part, n_axes - 1, axis_values)
    stride1 = size
    size *= table.axis_size[part, n_axes - 1]
    i0, f0, ok0 = _place(table, part, n_axes - 2, axis_values)
    stride0 = size
    size *= table.axis_size[part, n_axes - 2]
    ok = ok0 & ok1
    total = 0.0
    for corner in range(1 << (n_axes - 2)):
        base = table.value_offset[part] + setting + i0 * stride0 + i1 * stride1
        weight = 1.0
        stride = size
        for k in range(n_axes - 3, -1, -1):
            i, f, inside = _place(table, part, k, axis_values)
            ok &= inside
            up = (corner >> k) & 1
            weight *= f if up else 1.0 - f
            base += (i + up) * stride
            stride *= table.axis_size[part, k]
        if not ok:
            return 0.0, False
        if weight > 0.0:
            total += weight * _square(table.values, base, stride0, f0, stride1, f1)
    return total, ok


@inlined
def part_value(table, part, axis_values, setting):
    """Return (value, ok) of one part of a table; see `table_value`."""
    n_axes = 0
    while n_axes < AXES and table.part_axes[part, n_axes] >= 0:
        n_axes += 1
    base = table.value_offset[part] + setting
    n_settings = table.n_settings
    if n_axes == 0:
        return float(table.values[base]), True
    if n_axes > 2:
        return _hypercube(table, part, n_axes, axis_values, setting)
    i0, f0, ok0 = _place(table, part, 0, axis_values)
    if n_axes == 1:
        return _line(table.values, base + i0 * n_settings, n_settings, f0), ok0
    i1, f1, ok1 = _place(table, part, 1, axis_values)
    n1 = table.axis_size[part, 1]
    base += (i0 * n1 + i1) * n_settings
    return _square(table.values, base, n1 * n_settings, f0, n_settings, f1), ok0 & ok1


@inlined
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
    total = 0.0
    for part in range(table.part_axes.shape[0]):
        value, ok = part_value(table, part, axis_values, setting)
        if not ok:
            return 0.0, False
        total += value
    return total, total == total
