"""Approximate least cost from the nodes of a mesh to the goal, by sweeps.

Any function may be checked as a barrier; this one is near the least cost.
"""

from thalweg.kernels.certificate.barrier_solver import (
    COURSES,
    PER_SIDE,
    RING,
    UNREACHED,
    wake_neighbours,
)
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit

_SWEEPS = 300
_LEAST_CHANGE = 1e-7  # share of a value, below which nothing is passed on


@kernel_only
def _ring_value(phi, j, i, course):
    """Return the value at a point on the square of neighbours of a node."""
    ny, nx = phi.shape
    side, part = course // PER_SIDE, (course % PER_SIDE) / PER_SIDE
    row, column = j + RING[side, 0], i + RING[side, 1]
    if row < 0 or column < 0 or row >= ny or column >= nx:
        return UNREACHED
    value = phi[row, column]
    if part > 0.0 and value < UNREACHED:
        after = (side + 1) % 8
        row, column = j + RING[after, 0], i + RING[after, 1]
        if row < 0 or column < 0 or row >= ny or column >= nx or phi[row, column] >= UNREACHED:
            return UNREACHED
        value += part * (phi[row, column] - value)
    return value


@kernel_only
def _least_cost(phi, factor, j, i, motions, rates):
    """Return the least cost from a node by way of the square of its neighbours."""
    best = UNREACHED
    for quarter in range(4):
        row = j if quarter < 2 else j - 1
        column = i if quarter == 0 or quarter == 3 else i - 1
        if row < 0 or column < 0 or row >= phi.shape[0] - 1 or column >= phi.shape[1] - 1:
            continue
        if not motions.is_open[row, column]:
            continue
        price = factor[j, i] * rates.consumption[row, column]
        second = factor[j, i] * rates.second
        for part in range(2 * PER_SIDE + 1):
            course = (2 * PER_SIDE * quarter + part) % COURSES
            beyond = _ring_value(phi, j, i, course)
            if beyond >= best:
                continue
            for s in range(motions.seconds.shape[3]):
                seconds = motions.seconds[row, column, course, s]
                if seconds >= 0.5 * UNREACHED:
                    continue
                cost = price * motions.amount[row, column, course, s] + second * seconds
                best = min(best, beyond + cost)
    return best


@jit
def solve_cost_barrier(motions, rates, phi, factor, solvable, cap):
    """Fill ``phi`` with approximate least costs to the goal.

    Parameters
    ----------
    motions : CellMotions
    rates : CostRates
    phi : float64[Y, X]
        `UNREACHED` but at the nodes where it is given.
    factor : float64[Y, X]
        Factor on the costs from each node.
    solvable : bool[Y, X]
        Nodes to be filled.
    cap : float
        Values from here on are not passed on.

    Returns
    -------
    int
        Number of sweeps.
    """
    ny, nx = phi.shape
    active = solvable.copy()
    sweep = 0
    for sweep in range(_SWEEPS):
        changes = 0
        for row in range(ny):
            j = row if sweep & 1 == 0 else ny - 1 - row
            for column in range(nx):
                i = column if sweep & 2 == 0 else nx - 1 - column
                if not active[j, i]:
                    continue
                active[j, i] = False
                if not solvable[j, i]:
                    continue
                value = _least_cost(phi, factor, j, i, motions, rates)
                if value < cap and value < phi[j, i] - _LEAST_CHANGE * abs(phi[j, i]):
                    phi[j, i] = value
                    changes += 1
                    wake_neighbours(active, j, i)
        if changes == 0:
            break
    return sweep + 1
