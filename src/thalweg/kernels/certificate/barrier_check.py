"""Check of a barrier function: no ship crosses it from later to earlier times.

This part of the certificate has to be right; how the function was found does not matter.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.certificate.cell_conditions import (
    SECTORS,
    cell_speeds,
    make_buffers,
    read_cell,
)
from thalweg.kernels.certificate.known_limits import has_limits
from thalweg.kernels.certificate.mesh_sampling import margin_of_cell
from thalweg.kernels.certificate.speed_ranges import direction_range
from thalweg.kernels.codes import (
    AXIS_DEPTH,
    AXIS_WAVE_HEIGHT,
    BED_DEPTH,
    CURRENT_EAST,
    LIMIT_REQUIRED_DEPTH,
    LIMIT_WAVE_HEIGHT,
    LIMIT_WIND_SPEED,
    WATER_LEVEL,
    WIND_EAST,
)
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit

_GOLDEN = 0.6180339887498949
_TWIST = 0.0625  # share of the twist of the currents of a cell that counts in a triangle
_ABOVE_ROUNDING = 1.0 + 2e-7  # of 32-bit numbers
_HALF = math.pi / SECTORS
_SINE, _COSINE = math.sin(_HALF), math.cos(_HALF)
_HEADINGS_EAST = np.sin(2.0 * _HALF * np.arange(SECTORS))
_HEADINGS_NORTH = np.cos(2.0 * _HALF * np.arange(SECTORS))


class KeptSpeeds(NamedTuple):
    """Greatest speeds in cells, with the windows of time since departure that they hold for.

    Attributes
    ----------
    first, last : float64[Y - 1, X - 1]
        NaN where nothing is kept [s].
    speed : float32[Y - 1, X - 1, sectors or 1]
        By sector of heading, or for all headings [m/s]. Without rows nothing is kept.
    longer : float
        By so much windows are longer at both ends [s].
    """

    first: np.ndarray
    last: np.ndarray
    speed: np.ndarray
    longer: float


class BarrierExcess(NamedTuple):
    """What a check finds in each cell.

    Attributes
    ----------
    excess : float64[Y - 1, X - 1]
        Greatest rate less 1; -1 where no ship may be, or where it is not checked.
    centre : float64[Y - 1, X - 1]
        Value of the barrier at the centre of each cell [s].
    """

    excess: np.ndarray
    centre: np.ndarray


class CellMotion(NamedTuple):
    """What moves a ship in a cell during a window of time.

    Attributes
    ----------
    currents : float64[INSTANTS, 4, 2]
        At the corners at each instant [m/s].
    instants : int
        How many of them count.
    speed : float64[SECTORS]
        Greatest speed through water for headings in each sector [m/s].
    top : float
        Greatest of these [m/s].
    disc : bool
        Whether ``top`` holds for all headings.
    drift : float
        By how much the current may differ from those at the corners [m/s].
    """

    currents: np.ndarray
    instants: int
    speed: np.ndarray
    top: float
    disc: bool
    drift: float


@kernel_only
def _support(east, north, motion):
    """Return the greatest scalar product of (east, north) with a velocity through the water."""
    size = math.sqrt(east * east + north * north)
    if motion.disc:
        return motion.top * size
    best = 0.0
    for k in range(SECTORS):
        along = east * _HEADINGS_EAST[k] + north * _HEADINGS_NORTH[k]
        across = abs(east * _HEADINGS_NORTH[k] - north * _HEADINGS_EAST[k])
        if along >= _COSINE * size:
            value = size
        else:
            value = along * _COSINE + across * _SINE
        best = max(best, motion.speed[k] * value)
    return best


@kernel_only
def triangle_differences(corners, centre, side):
    """Return the differences of a barrier over a triangle of a cell and its two outer corners.

    ``corners`` are the values at south-west, south-east, north-west and north-east; the triangles
    between a side and the centre are those in the south, north, west and east. The differences
    are those eastwards over the width of the cell and northwards over its height.
    """
    a, b, c, d = corners
    if side == 0:
        return b - a, 2.0 * centre - a - b, (0, 1)
    if side == 1:
        return d - c, c + d - 2.0 * centre, (2, 3)
    if side == 2:
        return 2.0 * centre - a - c, c - a, (0, 2)
    return b + d - 2.0 * centre, d - b, (1, 3)


@kernel_only
def greatest_current_along(p_east, p_north, corners, currents, instants):
    """Return the greatest scalar product of (east, north) with a current over a triangle.

    ``corners`` are the two corners of the cell that the triangle has beside the centre.
    """
    one, two = corners
    best = -math.inf
    for k in range(instants):
        a = currents[k, one, 0] * p_east + currents[k, one, 1] * p_north
        b = currents[k, two, 0] * p_east + currents[k, two, 1] * p_north
        m = 0.0
        turn_east = currents[k, 0, 0] - currents[k, 1, 0] - currents[k, 2, 0] + currents[k, 3, 0]
        turn_north = currents[k, 0, 1] - currents[k, 1, 1] - currents[k, 2, 1] + currents[k, 3, 1]
        for c in range(4):
            m += 0.25 * (currents[k, c, 0] * p_east + currents[k, c, 1] * p_north)
        value = max(a, b, m) + _TWIST * abs(turn_east * p_east + turn_north * p_north)
        best = max(best, value)
    return best


@kernel_only
def _greatest_rate(phi, centre, scales, motion):
    """Return the greatest rate of the barrier along any motion in a cell (1 is as fast as time)."""
    per_east_low, per_east_high, per_north, slack = scales
    best = -math.inf
    for side in range(4):
        x, y, pair = triangle_differences(phi, centre, side)
        y *= per_north
        for per_east in (per_east_low, per_east_high):
            east = x * per_east
            value = greatest_current_along(east, y, pair, motion.currents, motion.instants)
            value += _support(east, y, motion) + motion.drift * math.hypot(east, y)
            best = max(best, value + slack * abs(y))
    return best


@kernel_only
def replace_unknown_currents(currents, instants):
    """Replace unknown currents at corners by the mean of the known ones; return the strongest."""
    strongest = 0.0
    for k in range(instants):
        east, north, count = 0.0, 0.0, 0
        for c in range(4):
            if currents[k, c, 0] == currents[k, c, 0] and currents[k, c, 1] == currents[k, c, 1]:
                east += currents[k, c, 0]
                north += currents[k, c, 1]
                count += 1
                strongest = max(strongest, math.hypot(currents[k, c, 0], currents[k, c, 1]))
        for c in range(4):
            known = (
                currents[k, c, 0] == currents[k, c, 0] and currents[k, c, 1] == currents[k, c, 1]
            )
            if not known:
                currents[k, c, 0] = east / count if count else 0.0
                currents[k, c, 1] = north / count if count else 0.0
    return strongest


@kernel_only
def _kept_speeds(world, j, i, first, last, found, buffers, kept):
    """Return (greatest speed, same for all headings, renewed) of a cell; fill speeds by sector.

    After a renewal the currents in the buffers are those of a longer window.

    Speeds hold for the window they were found for, which is a little longer than the one asked
    for, so that they are kept while windows change little.
    """
    instants, field_high, winds, waves = found
    if instants < 0 or kept.speed.shape[0] == 0:
        top, disc = cell_speeds(world, (j, i), found, buffers)
        return top, disc, False
    sectors = kept.speed.shape[2]
    inside = kept.first[j, i] <= first and last <= kept.last[j, i]
    if inside and last - first >= kept.last[j, i] - kept.first[j, i] - 3.0 * kept.longer:
        top = 0.0
        for k in range(SECTORS):
            buffers.speed[k] = kept.speed[j, i, k if sectors > 1 else 0]
            top = max(top, buffers.speed[k])
        return top, sectors == 1, False
    first, last = first - kept.longer, last + kept.longer
    instants, is_open, field_high, winds, waves = read_cell(world, j, i, first, last, buffers)
    found = instants, field_high, winds, waves
    top, disc = cell_speeds(world, (j, i), found, buffers)
    if instants >= 0 and is_open:
        kept.first[j, i], kept.last[j, i] = first, last
        for k in range(sectors):
            kept.speed[j, i, k] = buffers.speed[k] * _ABOVE_ROUNDING
    return top, disc, True


@kernel_only
def _open_on_barrier(world, j, i, values, window, buffers):
    """Return whether a faster ship may be in a cell at some moment of a barrier's values there.

    ``window`` are the times at which a faster ship may be there at all. The centre is then the
    mean of the corners, and the barrier may rise at any rate.
    """
    if not has_limits(world):
        return True
    first, last = max(values[0] - 1.0, window[0]), min(values[1], window[1])
    return first <= last and read_cell(world, j, i, first, last, buffers)[1]


@kernel_only
def _check_cell(world, phi, cell, window, forward, strict, buffers, kept):
    """Return (excess, centre value): how far the barrier rises faster than time in one cell."""
    j, i = cell
    a, b, c, d = phi[j, i], phi[j, i + 1], phi[j + 1, i], phi[j + 1, i + 1]
    least, greatest = min(a, b, c, d), max(a, b, c, d)
    if forward and not _open_on_barrier(world, j, i, (least, greatest), window, buffers):
        return -1.0, 0.25 * (a + b + c + d)
    first, last = window
    if forward:  # the value at the centre is between those at the corners
        first, last = least - 1.0, greatest
    instants, is_open, field_high, winds, waves = read_cell(world, j, i, first, last, buffers)
    if not is_open:
        return -1.0, 0.25 * (a + b + c + d)
    found = instants, field_high, winds, waves
    top, disc, renewed = _kept_speeds(world, j, i, first, last, found, buffers, kept)
    if renewed:
        instants = read_cell(world, j, i, first, last, buffers)[0]
    sign = 1.0 if forward else -1.0
    if instants < 0:  # a window of too many instants
        return math.inf, 0.25 * (a + b + c + d)
    drift = margin_of_cell(world, j, i, CURRENT_EAST)
    strongest = replace_unknown_currents(buffers.current, instants) + drift
    dlat = world.raster.corner[1] / world.refinement
    dlon = world.raster.corner[3] / world.refinement
    south, north = world.metres_north[j] * dlat, world.metres_north[j + 1] * dlat
    scales = (
        sign / (world.metres_east[j] * dlon),
        sign / (world.metres_east[j + 1] * dlon),
        sign / min(south, north),
        abs(south - north) / min(south, north) * (strongest + top),
    )
    corners = (a, b, c, d)
    centre = 0.25 * (a + b + c + d)
    motion = CellMotion(buffers.current, instants, buffers.speed, top, disc, drift)
    rate = _greatest_rate(corners, centre, scales, motion)
    if rate > 1.0 + (-6e-4 if strict else 2e-4):
        low, high = min(0.5 * (a + d), 0.5 * (b + c)), max(0.5 * (a + d), 0.5 * (b + c))
        low, high = low - 0.5 * (high - low), high + 0.5 * (high - low)
        low, high = max(low, least), min(high, greatest)
        one, two = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        at_one = _greatest_rate(corners, one, scales, motion)
        at_two = _greatest_rate(corners, two, scales, motion)
        for _ in range(7):
            if at_one < at_two:
                high, two, at_two = two, one, at_one
                one = high - _GOLDEN * (high - low)
                at_one = _greatest_rate(corners, one, scales, motion)
            else:
                low, one, at_one = one, two, at_two
                two = low + _GOLDEN * (high - low)
                at_two = _greatest_rate(corners, two, scales, motion)
        if at_one < rate:
            rate, centre = at_one, one
        if at_two < rate:
            rate, centre = at_two, two
    return rate - 1.0, centre


@jit
def check_barrier(world, phi, candidate, windows, forward, strict, found, kept):
    """Fill for each candidate cell how far the barrier rises faster than time, at most.

    Parameters
    ----------
    world : BarrierWorld
    phi : float64[Y, X]
        The barrier at the nodes: time since departure [s], or until arrival.
    candidate : bool[Y - 1, X - 1]
        Cells to check.
    windows : TimeWindows
        For a barrier until arrival: the times at which a ship may be in each cell [s].
    forward : bool
        Whether the barrier counts from the departure; its own values are then the times.
    strict : bool
        Whether centre values are searched for the smallest excess too.
    found : BarrierExcess
        Filled.
    kept : KeptSpeeds
        Speeds of cells that are kept between calls.
    """
    buffers = make_buffers()
    excess, centre = found
    for j in range(phi.shape[0] - 1):
        for i in range(phi.shape[1] - 1):
            if not candidate[j, i]:
                excess[j, i] = -1.0
                centre[j, i] = 0.25 * (
                    phi[j, i] + phi[j, i + 1] + phi[j + 1, i] + phi[j + 1, i + 1]
                )
                continue
            window = (windows.first[j, i], windows.last[j, i])
            excess[j, i], centre[j, i] = _check_cell(
                world, phi, (j, i), window, forward, strict, buffers, kept
            )


@jit
def closed_throughout(world, windows, closed, closing):
    """Fill which cells no ship may be in at any moment, or at some, of their windows of time.

    Parameters
    ----------
    world : BarrierWorld
    windows : TimeWindows
    closed : bool[Y - 1, X - 1]
        Whether to test each cell before; whether it is closed after.
    closing : bool[Y - 1, X - 1]
        Filled: open cells that a limit may close for a time.
    """
    buffers = make_buffers()
    limited = has_limits(world)
    lowest = _lowest_water_level(world)
    required = world.ship.limits[LIMIT_REQUIRED_DEPTH]
    for j in range(closed.shape[0]):
        for i in range(closed.shape[1]):
            closing[j, i] = False
            if closed[j, i]:
                first, last = windows.first[j, i], windows.last[j, i]
                instants, is_open, _, winds, _ = read_cell(world, j, i, first, last, buffers)
                closed[j, i] = not is_open
                if limited and is_open:
                    shallow = world.deepest[j, i] + lowest < required
                    beyond = _may_close(world, (j, i), winds, buffers)
                    closing[j, i] = instants < 0 or shallow or beyond


@kernel_only
def _lowest_water_level(world):
    """Return the lowest water level at any node and time [m]; 0 without levels."""
    channel = world.raster.channel_index[WATER_LEVEL]
    if channel < 0:
        return 0.0
    values, lowest = world.raster.values, math.inf
    for t in range(values.shape[0]):
        for j in range(values.shape[1]):
            for i in range(values.shape[2]):
                lowest = min(lowest, values[t, j, i, channel])
    margin = 0.0
    for value in world.margins[:, :, WATER_LEVEL].flat:
        margin = max(margin, value)
    return lowest - margin if lowest < math.inf else 0.0


@kernel_only
def _may_close(world, cell, winds, buffers):
    """Return whether a condition that was read in a cell is beyond a limit somewhere."""
    limits, index = world.ship.limits, world.raster.channel_index
    shallow = buffers.low[AXIS_DEPTH] < limits[LIMIT_REQUIRED_DEPTH]
    if index[BED_DEPTH] >= 0 and shallow:
        return True
    if buffers.high[AXIS_WAVE_HEIGHT] > limits[LIMIT_WAVE_HEIGHT]:
        return True
    wind = limits[LIMIT_WIND_SPEED]
    margin = margin_of_cell(world, cell[0], cell[1], WIND_EAST)
    strongest = direction_range(buffers.wind_over_ground, winds)[3] + margin
    return winds > 0 and wind < strongest
