"""Ranges of conditions, and the greatest speed through water of a ship's table over them."""

import math

from thalweg.kernels.codes import AXIS_COUNT, AXIS_WAVE_HEIGHT
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.leg.table_lookup import (
    CURVE_INTERSECTION,
    CURVE_REFINEMENT,
    OUTPUT_CURVE,
)

_ROUNDING = 1e-6  # by which ranges of conditions are widened, so that they are kept more often


@kernel_only
def direction_range(vectors, count):
    """Return (least, greatest, shortest, longest) of the azimuths and lengths of a hull of vectors.

    Azimuths are from north, the way they point [rad]; the whole circle where the hull may hold the
    zero vector.
    """
    east, north, longest = 0.0, 0.0, 0.0
    for k in range(count):
        east += vectors[k, 0]
        north += vectors[k, 1]
        longest = max(longest, math.hypot(vectors[k, 0], vectors[k, 1]))
    size = math.hypot(east, north)
    if size <= 1e-12 * max(longest, 1e-300) * count or count == 0:
        return -math.pi, math.pi, 0.0, longest
    east, north = east / size, north / size
    least, greatest, shortest = 0.0, 0.0, math.inf
    for k in range(count):
        along = vectors[k, 0] * east + vectors[k, 1] * north
        across = vectors[k, 0] * north - vectors[k, 1] * east  # clockwise positive
        if along <= 0.0:
            return -math.pi, math.pi, 0.0, longest
        turn = math.atan2(across, along)
        least, greatest = min(least, turn), max(greatest, turn)
        shortest = min(shortest, along)
    middle = math.atan2(east, north)
    return middle + least, middle + greatest, shortest, longest


@kernel_only
def widened_directions(found, margin):
    """Return a range of azimuths and lengths (`direction_range`) of vectors within a distance."""
    least, greatest, shortest, longest = found
    if margin <= 0.0:
        return least, greatest, shortest, longest
    if margin >= shortest:
        return -math.pi, math.pi, 0.0, longest + margin
    turn = math.asin(margin / shortest)
    return least - turn, greatest + turn, shortest - margin, longest + margin


@kernel_only
def angle_from_bow_range(first, last):
    """Return the range of the angle from the bow [0, pi] over a range of relative azimuths."""
    if last - first >= 2.0 * math.pi:
        return 0.0, math.pi
    turns = math.floor(first / (2.0 * math.pi))
    first -= 2.0 * math.pi * turns
    last -= 2.0 * math.pi * turns  # first in [0, 2 pi)
    low = min(_folded(first), _folded(last))
    high = max(_folded(first), _folded(last))
    if last >= 2.0 * math.pi:
        low = 0.0
    if (first <= math.pi and last >= math.pi) or last >= 3.0 * math.pi:
        high = math.pi
    return low, high


@kernel_only
def _folded(angle):
    angle = angle % (2.0 * math.pi)
    return 2.0 * math.pi - angle if angle > math.pi else angle


@kernel_only
def _grid_place(table, part, k, value):
    """Return the place of a value on an axis, held inside the axis [grid steps]."""
    last = float(table.axis_size[part, k] - 1)
    x = (value - table.axis_start[part, k]) * table.axis_inv_step[part, k]
    return min(max(x, 0.0), last)


@kernel_only
def _corner_value(table, part, column, place):
    """Return a part's multilinear value at places on its axes; NaN where a corner is NaN."""
    total = 0.0
    for corner in range(1 << AXIS_COUNT):
        weight, at, stride = 1.0, table.value_offset[part] + column, 0
        stride = table.n_columns if table.n_columns > 0 else table.n_settings
        used = True
        for k in range(AXIS_COUNT - 1, -1, -1):
            up = corner >> k & 1
            if table.part_axes[part, k] < 0:
                if up:
                    used = False
                    break
                continue
            cell = min(int(place[k]), table.axis_size[part, k] - 2)
            fraction = place[k] - cell
            weight *= fraction if up else 1.0 - fraction
            if weight == 0.0:
                used = False
                break
            at += (cell + up) * stride
            stride *= table.axis_size[part, k]
        if used:
            total += weight * table.values[at]
    return total


@kernel_only
def part_range(table, part, column, low, high, place):
    """Return (least, greatest) value of a part over ranges of its axes; NaN where one is unknown.

    A multilinear function is extreme at the ends of the ranges or at grid points inside them.
    ``place`` is a work array of at least 4 * AXIS_COUNT numbers.
    """
    # place[0:A] current places, [A:2A] first, [2A:3A] last, [3A:4A] next grid point to try
    axes = AXIS_COUNT
    for k in range(axes):
        if table.part_axes[part, k] < 0:
            place[k] = place[axes + k] = place[2 * axes + k] = 0.0
            continue
        axis = table.part_axes[part, k]
        place[axes + k] = _grid_place(table, part, k, low[axis])
        place[2 * axes + k] = _grid_place(table, part, k, high[axis])
        place[k] = place[axes + k]
    least, greatest = math.inf, -math.inf
    while True:
        value = _corner_value(table, part, column, place)
        if value != value:
            return math.nan, math.nan
        least, greatest = min(least, value), max(greatest, value)
        k = 0
        while k < axes:
            if place[k] < place[2 * axes + k]:
                place[k] = min(math.floor(place[k]) + 1.0, place[2 * axes + k])
                break
            place[k] = place[axes + k]
            k += 1
        if k == axes:
            break
    if table.squared_height_limit.shape[0] > 0:
        stop = table.squared_height_limit[part]
        if stop == stop:
            first = max(low[AXIS_WAVE_HEIGHT], 0.0) ** 2
            last = min(high[AXIS_WAVE_HEIGHT], stop) ** 2
            least = min(least * first, least * last)
            greatest = max(greatest * first, greatest * last)
    return least, greatest


@kernel_only
def outside_table(table, low, high):
    """Return whether ranges of conditions are wholly outside an axis, where the ship is unknown."""
    for part in range(table.part_axes.shape[0]):
        for k in range(AXIS_COUNT):
            axis = table.part_axes[part, k]
            if axis < 0:
                continue
            first = table.axis_start[part, k]
            last = first + (table.axis_size[part, k] - 1) / table.axis_inv_step[part, k]
            margin = 1e-5 * (last - first)
            deeper = axis == AXIS_COUNT - 1  # depths beyond the last grid point count as that
            if high[axis] < first - margin or (low[axis] > last + margin and not deeper):
                return True
        if table.squared_height_limit.shape[0] > 0:
            stop = table.squared_height_limit[part]
            if stop == stop and low[AXIS_WAVE_HEIGHT] > stop * (1.0 + 1e-5):
                return True
    return False


@kernel_only
def _least_sum(table, column, low, high, place):
    total = 0.0
    for part in range(table.part_axes.shape[0]):
        total += part_range(table, part, column, low, high, place)[0]
    return total


@kernel_only
def _greatest_speed_at_intersection(table, setting, low, high, place):
    """Return the speed at which the least sum over the ranges rises through the curve."""
    above, over = table.n_columns, 0.0
    below, under = table.n_columns - 1, 0.0
    while below >= 0:  # from the top: of several crossings the fastest counts
        under = _least_sum(table, below, low, high, place)
        if under != under:
            return math.nan
        if under < table.curve[setting, below * CURVE_REFINEMENT]:
            break
        above, over = below, under
        below -= 1
    top = table.curve_top[setting]
    if below < 0:
        return 0.0
    if above == table.n_columns:
        return top
    base, slope = below * CURVE_REFINEMENT, (over - under) / CURVE_REFINEMENT
    first, last = 0, CURVE_REFINEMENT
    while last - first > 1:
        middle = (first + last) >> 1
        if under + middle * slope < table.curve[setting, base + middle]:
            first = middle
        else:
            last = middle
    before = under + first * slope - table.curve[setting, base + first]
    after = under + last * slope - table.curve[setting, base + last]
    point = base + first + before / (before - after)
    return min(table.curve_start[setting] + point / table.curve_inv_step[setting], top)


@kernel_only
def _range_of_curve(table, setting, least, greatest):
    """Return the least and the greatest point of a curve between two values of the sum."""
    last = table.curve.shape[1] - 1
    first_place = (least - table.curve_start[setting]) * table.curve_inv_step[setting]
    last_place = (greatest - table.curve_start[setting]) * table.curve_inv_step[setting]
    first_place = min(max(first_place, 0.0), float(last))
    last_place = min(max(last_place, 0.0), float(last))
    low, high, place = math.inf, -math.inf, first_place
    while True:
        cell = min(int(place), last - 1)
        near, far = table.curve[setting, cell], table.curve[setting, cell + 1]
        value = near + (place - cell) * (far - near)
        low, high = min(low, value), max(high, value)
        if place >= last_place:
            return low, high
        place = min(math.floor(place) + 1.0, last_place)


@kernel_only
def _range_of_sum(table, setting, low, high, place):
    """Return the least and the greatest sum of the parts of a table over ranges of conditions."""
    least, greatest = 0.0, 0.0
    for part in range(table.part_axes.shape[0]):
        part_low, part_high = part_range(table, part, setting, low, high, place)
        least += part_low
        greatest += part_high
    return least, greatest


@kernel_only
def greatest_speed(table, setting, low, high, top_speed, place):
    """Return an upper bound of the speed through water over ranges of conditions.

    Parameters
    ----------
    table : TableArrays
        Speed through water.
    setting : int
    low, high : float64[AXES]
        Range of the value on every axis, by axis id, SI.
    top_speed : float
        Upper bound everywhere [m/s]; the answer where the table has unknown values in the ranges.
    place : float64[4 * AXES]
        Work array.

    Returns
    -------
    float
        [m/s]; 0 where the ranges are wholly outside the table.
    """
    if outside_table(table, low, high):
        return 0.0
    if table.finish == CURVE_INTERSECTION:
        speed = _greatest_speed_at_intersection(table, setting, low, high, place)
        return top_speed if speed != speed else min(max(speed, 0.0), top_speed)
    least, greatest = _range_of_sum(table, setting, low, high, place)
    if greatest != greatest:
        return top_speed
    if table.finish == OUTPUT_CURVE:
        greatest = _range_of_curve(table, setting, least, greatest)[1]
    return min(max(greatest, 0.0), top_speed)


@kernel_only
def _edge_is_near(edge, value, outwards):
    """Return whether the edge of a wider range is at a value, or beyond it by rounding only."""
    beyond = outwards * (edge - value)
    return edge == value or 0.0 <= beyond <= 2.0 * _ROUNDING * (1.0 + abs(value))


@kernel_only
def ranges_changed(sector, buffers):
    """Return whether the ranges in buffers differ from those asked for before in a sector.

    If so, those asked for are renewed, a little wider. In a calm or uniform sea they are the same
    in all cells.

    Parameters
    ----------
    sector : int
    buffers : CellBuffers
        Their ``low`` and ``high`` are the ranges.
    """
    low, high = buffers.low, buffers.high
    asked_low, asked_high = buffers.asked[sector, 0], buffers.asked[sector, 1]
    same = True
    for k in range(AXIS_COUNT):
        same = same and _edge_is_near(asked_low[k], low[k], -1.0)
        same = same and _edge_is_near(asked_high[k], high[k], 1.0)
    if not same:
        for k in range(AXIS_COUNT):
            asked_low[k] = low[k] - _ROUNDING * (1.0 + abs(low[k]))
            asked_high[k] = high[k] + _ROUNDING * (1.0 + abs(high[k]))
    return not same


@kernel_only
def kept_speed(table, setting, top_speed, sector, buffers):
    """Return the greatest speed over the ranges in buffers, or a little wider ones [m/s].

    Parameters
    ----------
    table, setting, top_speed : As of `greatest_speed`.
    sector, buffers : As of `ranges_changed`.
    """
    if ranges_changed(sector, buffers):
        low, high = buffers.asked[sector, 0], buffers.asked[sector, 1]
        buffers.answer[sector] = greatest_speed(table, setting, low, high, top_speed, buffers.place)
    return buffers.answer[sector]


@kernel_only
def least_consumption(table, setting, low, high, floor, place):
    """Return a lower bound of the consumption over ranges of conditions.

    Parameters
    ----------
    table : TableArrays
        Consumption.
    setting : int
    low, high : float64[AXES]
        Range of the value on every axis, by axis id, SI.
    floor : float
        Lower bound everywhere; the answer where the table has unknown values in the ranges.
    place : float64[4 * AXES]
        Work array.

    Returns
    -------
    float
        In the unit of the table, a second.
    """
    if outside_table(table, low, high) or table.finish == CURVE_INTERSECTION:
        return floor
    least, greatest = _range_of_sum(table, setting, low, high, place)
    if least != least:
        return floor
    if table.finish == OUTPUT_CURVE:
        least = _range_of_curve(table, setting, least, greatest)[0]
    return max(least, floor)
