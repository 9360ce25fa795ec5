"""First approximation of the arrival time on a mesh, by sweeps over its nodes.

Any function may be checked as a barrier; this one is near the earliest arrival.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.certificate.cell_conditions import (
    make_buffers,
    read_cell,
)
from thalweg.kernels.certificate.mesh_sampling import margin_of_cell, sample_node, time_step_of
from thalweg.kernels.codes import (
    CHANNEL_COUNT,
    CURRENT_EAST,
    CURRENT_NORTH,
    OK,
    SPEED_FIELD,
)
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.leg.point_speed import ShipArrays, point_speed_from_guess

COURSES = 32  # directions to the square of neighbours round a node
_RENEWAL = 0.02  # of the step of the data, after which times round a node are found again
PER_SIDE = COURSES // 8  # points between two neighbours
UNREACHED = 1e29

# offsets of the points on the square of neighbours: row, column, counterclockwise from the east
RING = np.array(
    [[0, 1], [1, 1], [1, 0], [1, -1], [0, -1], [-1, -1], [-1, 0], [-1, 1]], dtype=np.int64
)


class SolvedNodes(NamedTuple):
    """What is given at the nodes of a mesh.

    Attributes
    ----------
    fixed : bool[Y, X]
        Nodes whose value is given; it may be lowered.
    factor : float64[Y, X]
        Factor on the times at each node.
    solvable : bool[Y, X]
        Nodes that take part.
    closing : bool[Y - 1, X - 1]
        Cells that may be closed, always or for a time.
    """

    fixed: np.ndarray
    factor: np.ndarray
    solvable: np.ndarray
    closing: np.ndarray


class RingTimes(NamedTuple):
    """Times round the nodes of a mesh, kept between calls.

    Attributes
    ----------
    times : float32[Y, X, COURSES]
        [s].
    moment : float64[Y, X]
        The moment they hold for [s]; NaN where they are still to be computed.
    """

    times: np.ndarray
    moment: np.ndarray


@kernel_only
def course_offset(course):
    """Return (rows, columns) from a node to a point on the square of its neighbours."""
    side, part = course // PER_SIDE, (course % PER_SIDE) / PER_SIDE
    after = (side + 1) % 8
    rows = RING[side, 0] + part * (RING[after, 0] - RING[side, 0])
    columns = RING[side, 1] + part * (RING[after, 1] - RING[side, 1])
    return rows, columns


@kernel_only
def wake_neighbours(active, j, i):
    """Let the eight neighbours of a node be computed again."""
    for k in range(8):
        row, column = j + RING[k, 0], i + RING[k, 1]
        if 0 <= row < active.shape[0] and 0 <= column < active.shape[1]:
            active[row, column] = True


@kernel_only
def _fill_times(world, ship, node, t, forward, sample, out):
    """Fill the times [s] round a node, to it or from it, in its own conditions at one moment."""
    j, i = node
    step, fraction = time_step_of(world.raster.times, t)
    sample_node(world, j, i, step, fraction, sample)
    index = world.raster.channel_index
    flows = index[CURRENT_EAST] >= 0 and index[CURRENT_NORTH] >= 0
    current_east = sample[CURRENT_EAST] if flows else 0.0
    current_north = sample[CURRENT_NORTH] if flows else 0.0
    known = current_east == current_east and current_north == current_north
    constant = ship.needs == 0 and index[SPEED_FIELD] < 0
    drift = margin_of_cell(world, j, i, CURRENT_EAST)
    dlat = world.raster.corner[1] / world.refinement
    dlon = world.raster.corner[3] / world.refinement
    south, west = world.metres_north[j] * dlat, world.metres_east[j] * dlon
    for course in range(COURSES):
        rows, columns = course_offset(course)
        north, east = rows * south, columns * west
        size = math.hypot(east, north)
        east, north = east / size, north / size
        if forward:
            east, north = -east, -north
        speed = world.top_speed
        if constant and known:
            across = current_north * east - current_east * north
            spare = speed * speed - across * across
            along = current_east * east + current_north * north
            speed = along + math.sqrt(spare) if spare > 0.0 else 0.0
        elif not constant:
            attained, status, _ = point_speed_from_guess(
                sample, index, (east, north), ship, math.inf, math.inf
            )
            speed = attained if status == OK else speed
        speed += drift
        out[course] = size / speed if speed > 0.0 else UNREACHED


@kernel_only
def _least_in_cells(times, j, i, out):
    """Fill the times round a node by the best conditions at the corners of the cells they cross.

    Barriers are checked by the best conditions in each cell, not by those at single nodes.
    """
    ny, nx, _ = times.shape
    for course in range(COURSES):
        out[course] = times[j, i, course]
    for k in range(8):
        a, b = j + RING[k, 0], i + RING[k, 1]
        if a < 0 or b < 0 or a >= ny or b >= nx:
            continue
        # a corner counts for the courses of one cell, a neighbour in a row or column for two
        reach = PER_SIDE if k % 2 else 2 * PER_SIDE
        for course in range(k * PER_SIDE - reach, k * PER_SIDE + reach + 1):
            at = (course + COURSES) % COURSES
            value = times[a, b, at]
            if value < out[at]:
                out[at] = value


@kernel_only
def _update(phi, f, j, i, times, aspect):
    """Return the least time at a node by way of the square of its neighbours."""
    best, best_course = UNREACHED, -1
    for course in range(COURSES):
        value = _through(phi, f, j, i, course, times)
        if value < best:
            best, best_course = value, course
    if best_course < 0:
        return best
    # the least time through the ring is between its points: that of a parabola on both sides
    at_best = best
    for side in range(2):
        after = (best_course + 1) % COURSES if side else (best_course + COURSES - 1) % COURSES
        first = best_course if side else after
        at_after = _through(phi, f, j, i, after, times)
        if at_after >= 0.5 * UNREACHED:
            continue
        zero, one = (at_best, at_after) if side else (at_after, at_best)
        half = _between(phi, f, j, i, first, 0.5, times, aspect)
        bend = 2.0 * (zero + one - 2.0 * half)
        share = 0.5
        if bend > 0.0:
            share = min(max(0.5 * (3.0 * zero + one - 4.0 * half) / bend, 0.0), 1.0)
        best = min(best, half, _between(phi, f, j, i, first, share, times, aspect))
    return best


@kernel_only
def _between(phi, f, j, i, course, share, times, aspect):
    """Return the time at a node by way of a point between two courses of the ring.

    ``aspect`` is the width of a cell over its height.
    """
    ny, nx = phi.shape
    after = (course + 1) % COURSES
    row, column = course_offset(course)
    row_after, column_after = course_offset(after)
    slow = times[course] / math.hypot(row, column * aspect)
    slow_after = times[after] / math.hypot(row_after, column_after * aspect)
    row += share * (row_after - row)
    column += share * (column_after - column)
    far = math.hypot(row, column * aspect)
    side = course // PER_SIDE
    part = (course % PER_SIDE + share) / PER_SIDE
    a, b = j + RING[side, 0], i + RING[side, 1]
    if a < 0 or b < 0 or a >= ny or b >= nx:
        return UNREACHED
    value = phi[a, b]
    side = (side + 1) % 8
    a, b = j + RING[side, 0], i + RING[side, 1]
    if a < 0 or b < 0 or a >= ny or b >= nx:
        return UNREACHED
    value += part * (phi[a, b] - value)
    if value >= 0.5 * UNREACHED:
        return UNREACHED
    return value + f[j, i] * far * (slow + share * (slow_after - slow))


@kernel_only
def _through(phi, f, j, i, course, times):
    ny, nx = phi.shape
    side, part = course // PER_SIDE, (course % PER_SIDE) / PER_SIDE
    row, column = j + RING[side, 0], i + RING[side, 1]
    if row < 0 or column < 0 or row >= ny or column >= nx:
        return UNREACHED
    value = phi[row, column]
    if part > 0.0:
        after = (side + 1) % 8
        row, column = j + RING[after, 0], i + RING[after, 1]
        if row < 0 or column < 0 or row >= ny or column >= nx:
            return UNREACHED
        value += part * (phi[row, column] - value)
    if value >= 0.5 * UNREACHED:
        return UNREACHED
    return value + f[j, i] * times[course]


@kernel_only
def _near_closing(closing, j, i):
    """Return whether a cell at a node may be closed."""
    for row in range(max(j - 1, 0), min(j + 1, closing.shape[0])):
        for column in range(max(i - 1, 0), min(i + 1, closing.shape[1])):
            if closing[row, column]:
                return True
    return False


@kernel_only
def _update_by_cells(world, phi, nodes, j, i, times, buffers):
    """Return the least time at a node by way of its cells, after those are open.

    A cell that is closed from the least of its values to the time through it delays a ship to
    the moment that it opens.
    """
    best = UNREACHED
    ny, nx = nodes.closing.shape
    for quarter in range(4):
        row = j if quarter < 2 else j - 1
        column = i if quarter == 0 or quarter == 3 else i - 1
        if row < 0 or column < 0 or row >= ny or column >= nx:
            continue
        value = UNREACHED
        for part in range(2 * PER_SIDE + 1):
            course = (2 * PER_SIDE * quarter + part) % COURSES
            value = min(value, _through(phi, nodes.factor, j, i, course, times))
        if value >= best:
            continue
        if nodes.closing[row, column]:
            least = value
            for a in range(row, row + 2):
                for b in range(column, column + 2):
                    if a != j or b != i:
                        least = min(least, phi[a, b])
            value = _after_opening(world, row, column, least - 1.0, value, buffers)
        best = min(best, value)
    return best


@kernel_only
def _after_opening(world, j, i, since, value, buffers):
    """Return the moment that a cell opens, if it is closed from a moment to a value [s]."""
    times = world.raster.times
    if world.closed[j, i]:
        return UNREACHED
    if read_cell(world, j, i, since, value, buffers)[1]:
        return value
    closed = value
    opens = closed
    for k in range(times.shape[0]):
        if times[k] <= closed:
            continue
        if read_cell(world, j, i, closed, times[k], buffers)[1]:
            opens = times[k]
            break
        closed = times[k]
    if opens <= closed:  # closed to the end of the data
        return UNREACHED
    while opens - closed > 1.0:
        middle = 0.5 * (closed + opens)
        if read_cell(world, j, i, closed, middle, buffers)[1]:
            opens = middle
        else:
            closed = middle
    return closed


@kernel_only
def _renew_rings(world, ship, node, moment, windows, forward, rings, work):
    """Find the times round a node again, if its moment differs, and round new neighbours."""
    j, i = node
    ny, nx = rings.moment.shape
    sample, times, other = work
    axis = world.raster.times
    renewal = max(_RENEWAL * (axis[1] - axis[0]), 30.0)
    if not forward:
        moment = 0.0
    for a in range(max(j - 1, 0), min(j + 2, ny)):
        for b in range(max(i - 1, 0), min(i + 2, nx)):
            kept = rings.moment[a, b]
            if kept == kept and ((a != j or b != i) or abs(kept - moment) <= renewal):
                continue
            rings.moment[a, b] = moment
            if forward:
                _fill_times(world, ship, (a, b), moment, True, sample, times)
            else:
                times[:] = UNREACHED
                for part in range(5):
                    share = 0.25 * part
                    t = windows.first[a, b] * (1.0 - share) + windows.last[a, b] * share
                    _fill_times(world, ship, (a, b), t, False, sample, other)
                    for k in range(COURSES):
                        times[k] = min(times[k], other[k])
            for k in range(COURSES):
                rings.times[a, b, k] = times[k]


@jit
def solve_barrier(world, phi, nodes, windows, forward, cap, rings):
    """Fill ``phi`` with approximate earliest arrivals, or least times to the goal.

    Parameters
    ----------
    world : BarrierWorld
    phi : float64[Y, X]
        `UNREACHED` but at the nodes where it is given.
    nodes : SolvedNodes
    windows : TimeWindows
        Times whose best conditions count, for a barrier until arrival.
    forward : bool
        Whether the barrier counts from the departure.
    cap : float
        Values from here on are not passed on [s].
    rings : RingTimes

    Returns
    -------
    int
        Number of sweeps.
    """
    ny, nx = phi.shape
    buffers = make_buffers()
    active = np.zeros((ny, nx), np.bool_)
    for j in range(ny):
        for i in range(nx):
            if nodes.fixed[j, i]:
                wake_neighbours(active, j, i)
    times = np.empty(COURSES)
    work = (np.full(CHANNEL_COUNT, np.nan), np.empty(COURSES), np.empty(COURSES))
    limits = world.ship.limits.copy()
    limits[0] = -np.inf
    limits[1:] = np.inf
    ship = ShipArrays(world.ship.table, world.ship.setting, limits, world.ship.needs)
    sweep = 0
    for sweep in range(300):
        changes = 0
        for row in range(ny):
            j = row if sweep & 1 == 0 else ny - 1 - row
            for column in range(nx):
                i = column if sweep & 2 == 0 else nx - 1 - column
                if not active[j, i]:
                    continue
                active[j, i] = False
                if not nodes.solvable[j, i]:
                    continue
                moment = phi[j, i]
                if moment >= cap:
                    moment = UNREACHED
                    for k in range(8):
                        a, b = j + RING[k, 0], i + RING[k, 1]
                        if 0 <= a < ny and 0 <= b < nx:
                            moment = min(moment, phi[a, b])
                if moment >= cap:
                    continue
                _renew_rings(world, ship, (j, i), moment, windows, forward, rings, work)
                _least_in_cells(rings.times, j, i, times)
                aspect = world.metres_east[j] * world.raster.corner[3]
                aspect /= world.metres_north[j] * world.raster.corner[1]
                value = _update(phi, nodes.factor, j, i, times, aspect)
                if forward and _near_closing(nodes.closing, j, i):
                    value = _update_by_cells(world, phi, nodes, j, i, times, buffers)
                if value < phi[j, i] - 1e-9 * max(abs(phi[j, i]), 1.0):
                    phi[j, i] = value
                    changes += 1
                    wake_neighbours(active, j, i)
        if changes == 0:
            break
    return sweep + 1
