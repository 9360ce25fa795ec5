"""Check of a barrier of cost: no motion lowers it by more than it costs.

This part of the certificate of costs has to be right; how the function was found does not matter.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.certificate.barrier_check import (
    greatest_current_along,
    replace_unknown_currents,
    triangle_differences,
)
from thalweg.kernels.certificate.cell_conditions import make_buffers, read_cell
from thalweg.kernels.certificate.mesh_sampling import margin_of_cell
from thalweg.kernels.codes import CURRENT_EAST
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit

_ABOVE_ROUNDING = 1.0 + 2e-7  # of 32-bit numbers


class CostRates(NamedTuple):
    """What a ship pays.

    Attributes
    ----------
    consumption : float64[Y - 1, X - 1]
        Least price of a unit of consumption in each cell.
    second : float
        Price of a second.
    """

    consumption: np.ndarray
    second: float


@kernel_only
def _greatest_gain(east, north, speed, consumption, price):
    """Return the most that a ship gains in a second by its own speed, less its consumption.

    A motion by a metre along (east, north) gains the length of that vector.
    """
    size = math.sqrt(east * east + north * north)
    settings, sectors = speed.shape
    half = math.pi / sectors
    sine, cosine = math.sin(half), math.cos(half)
    best = -math.inf
    for k in range(sectors):
        head_east, head_north = math.sin(2.0 * half * k), math.cos(2.0 * half * k)
        along = east * head_east + north * head_north
        across = abs(east * head_north - north * head_east)
        reach = size
        if sectors > 1 and along < cosine * size:
            reach = max(along * cosine + across * sine, 0.0)
        for s in range(settings):
            gain = _ABOVE_ROUNDING * speed[s, k] * reach
            best = max(best, gain - price * consumption[s, k] / _ABOVE_ROUNDING)
    return best


@kernel_only
def _greatest_fall(corners, centre, scales, motion, price):
    """Return how far a barrier falls in a second along any motion in a cell, less consumption."""
    per_east_low, per_east_high, per_north, slack = scales
    currents, instants, speed, consumption, drift = motion
    best = -math.inf
    for side in range(4):
        x, y, pair = triangle_differences(corners, centre, side)
        north = -y * per_north
        for per_east in (per_east_low, per_east_high):
            east = -x * per_east
            value = greatest_current_along(east, north, pair, currents, instants)
            value += _greatest_gain(east, north, speed, consumption, price)
            value += drift * math.hypot(east, north)
            best = max(best, value + slack * abs(north))
    return best


@kernel_only
def _least_and_greatest(speed, consumption):
    """Return the least consumption and the greatest speed over settings and sectors."""
    least, greatest = math.inf, 0.0
    for s in range(speed.shape[0]):
        for k in range(speed.shape[1]):
            least = min(least, consumption[s, k] / _ABOVE_ROUNDING)
            greatest = max(greatest, speed[s, k] * _ABOVE_ROUNDING)
    return least, greatest


@jit
def check_cost_barrier(world, motions, rates, phi, candidate, windows, excess):
    """Fill for each candidate cell how far the barrier falls faster than a motion costs, at most.

    Parameters
    ----------
    world : BarrierWorld
    motions : CellMotions
        Speeds and consumption of the cells in their windows.
    rates : CostRates
    phi : float64[Y, X]
        The barrier at the nodes: a lower bound of the cost from there to the goal. Its value at the
        centre of a cell is the mean of the corners.
    candidate : bool[Y - 1, X - 1]
        Cells to check.
    windows : TimeWindows
        Times at which a ship may be in each cell.
    excess : float64[Y - 1, X - 1]
        Filled: share of the least cost of a second in the cell; -1 where no ship may be, or where
        it is not checked.
    """
    buffers = make_buffers()
    dlat = world.raster.corner[1] / world.refinement
    dlon = world.raster.corner[3] / world.refinement
    for j in range(candidate.shape[0]):
        for i in range(candidate.shape[1]):
            excess[j, i] = -1.0
            if not candidate[j, i]:
                continue
            first, last = windows.first[j, i], windows.last[j, i]
            instants, is_open, _, _, _ = read_cell(world, j, i, first, last, buffers)
            if not is_open:
                continue
            if instants <= 0 or not motions.is_open[j, i]:
                excess[j, i] = math.inf
                continue
            drift = margin_of_cell(world, j, i, CURRENT_EAST)
            strongest = replace_unknown_currents(buffers.current, instants) + drift
            speed, consumption = motions.speed[j, i], motions.consumption[j, i]
            least, top = _least_and_greatest(speed, consumption)
            south, north = world.metres_north[j] * dlat, world.metres_north[j + 1] * dlat
            scales = (
                1.0 / (world.metres_east[j] * dlon),
                1.0 / (world.metres_east[j + 1] * dlon),
                1.0 / min(south, north),
                abs(south - north) / min(south, north) * (strongest + top),
            )
            corners = (phi[j, i], phi[j, i + 1], phi[j + 1, i], phi[j + 1, i + 1])
            centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3])
            price = rates.consumption[j, i]
            motion = (buffers.current, instants, speed, consumption, drift)
            fall = _greatest_fall(corners, centre, scales, motion, price)
            excess[j, i] = (fall - rates.second) / (price * least + rates.second)
