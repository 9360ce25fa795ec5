"""How fast a ship may be in each cell of a mesh at each of its settings, and what it consumes."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.certificate.barrier_check import replace_unknown_currents
from thalweg.kernels.certificate.barrier_solver import COURSES, UNREACHED, course_offset
from thalweg.kernels.certificate.cell_conditions import (
    fill_angles,
    fill_ranges,
    make_buffers,
    read_cell,
)
from thalweg.kernels.certificate.mesh_sampling import margin_of_cell
from thalweg.kernels.certificate.speed_ranges import (
    greatest_speed,
    least_consumption,
    ranges_changed,
)
from thalweg.kernels.codes import CURRENT_EAST
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.leg.table_lookup import TableArrays

_LEAST_SPEED = 1e-3  # over ground [m/s], for the solver


class PricedShip(NamedTuple):
    """The settings of a ship with their consumption.

    Attributes
    ----------
    settings : int64[S]
        Settings that it may choose from at any moment.
    consumption : TableArrays
        Consumption a second.
    least : float64[S]
        Least consumption at each, in any conditions.
    top : float64[S]
        Greatest speed through water at each, in any conditions [m/s].
    """

    settings: np.ndarray
    consumption: TableArrays
    least: np.ndarray
    top: np.ndarray


class CellMotions(NamedTuple):
    """What a ship may do in each cell during its window of time.

    Attributes
    ----------
    is_open : bool[Y - 1, X - 1]
        Whether a ship may be there.
    speed : float32[Y - 1, X - 1, S, sectors]
        Greatest speed through water at each setting for headings in each sector [m/s].
    consumption : float32[Y - 1, X - 1, S, sectors]
        Least consumption a second, likewise.
    seconds, amount : float32[Y - 1, X - 1, COURSES, S]
        Time [s] and consumption from a node to points on the square of its neighbours: estimates.
    """

    is_open: np.ndarray
    speed: np.ndarray
    consumption: np.ndarray
    seconds: np.ndarray
    amount: np.ndarray


@kernel_only
def _fill_sectors(world, priced, cell, directions, buffers, motions, kept):
    j, i = cell
    sectors = motions.speed.shape[3]
    half = math.pi / sectors
    for sector in range(sectors):
        if sectors > 1:
            fill_angles(directions, 2.0 * half * sector, half, buffers)
        changed = ranges_changed(sector, buffers)
        low, high = buffers.asked[sector, 0], buffers.asked[sector, 1]
        for s in range(priced.settings.shape[0]):
            if changed:
                setting = priced.settings[s]
                kept[sector, s, 0] = greatest_speed(
                    world.ship.table, setting, low, high, priced.top[s], buffers.place
                )
                kept[sector, s, 1] = least_consumption(
                    priced.consumption, setting, low, high, priced.least[s], buffers.place
                )
            motions.speed[j, i, s, sector] = kept[sector, s, 0]
            motions.consumption[j, i, s, sector] = kept[sector, s, 1]


@kernel_only
def _best_current(current, instants, east, north):
    """Return the strongest current along a course in a cell, and the mean one to port."""
    along, to_port = -math.inf, 0.0
    for k in range(instants):
        for c in range(4):
            along = max(along, current[k, c, 0] * east + current[k, c, 1] * north)
            to_port += current[k, c, 1] * east - current[k, c, 0] * north
    return along, to_port / (4.0 * instants)


@kernel_only
def _fill_courses(world, cell, instants, buffers, motions):
    j, i = cell
    _, _, settings, sectors = motions.speed.shape
    dlat = world.raster.corner[1] / world.refinement
    dlon = world.raster.corner[3] / world.refinement
    height, width = world.metres_north[j] * dlat, world.metres_east[j] * dlon
    for course in range(COURSES):
        rows, columns = course_offset(course)
        north, east = rows * height, columns * width
        size = math.hypot(east, north)
        east, north = east / size, north / size
        along, to_port = _best_current(buffers.current, instants, east, north)
        along += margin_of_cell(world, j, i, CURRENT_EAST)
        turn = math.atan2(east, north) / (2.0 * math.pi) * sectors
        for s in range(settings):
            sector = math.floor(turn + 0.5) % sectors
            speed = motions.speed[j, i, s, sector]
            if sectors > 1 and speed > abs(to_port):  # the ship heads up to starboard of a course
                crab = math.asin(to_port / speed) / (2.0 * math.pi) * sectors
                sector = math.floor(turn + crab + 0.5) % sectors
                speed = motions.speed[j, i, s, sector]
            spare = speed * speed - to_port * to_port
            ground = along + math.sqrt(spare) if spare > 0.0 else 0.0
            motions.seconds[j, i, course, s] = UNREACHED
            motions.amount[j, i, course, s] = 0.0
            if ground > _LEAST_SPEED:
                motions.seconds[j, i, course, s] = size / ground
                consumption = motions.consumption[j, i, s, sector]
                motions.amount[j, i, course, s] = size / ground * consumption


@jit
def fill_motions(world, priced, windows, wanted, motions):
    """Fill what a ship may do in some cells at any moment of their windows of time.

    Parameters
    ----------
    world : BarrierWorld
    priced : PricedShip
    windows : TimeWindows
    wanted : bool[Y - 1, X - 1]
    motions : CellMotions
        Filled; cells that are not wanted count as closed.
    """
    buffers = make_buffers()
    kept = np.empty((motions.speed.shape[3], priced.settings.shape[0], 2))
    for j in range(wanted.shape[0]):
        for i in range(wanted.shape[1]):
            motions.is_open[j, i] = False
            if not wanted[j, i]:
                continue
            first, last = windows.first[j, i], windows.last[j, i]
            instants, is_open, _, winds, waves = read_cell(world, j, i, first, last, buffers)
            if not is_open:
                continue
            motions.is_open[j, i] = True
            motions.seconds[j, i] = UNREACHED
            if instants > 0:
                directions = fill_ranges(world, (j, i), winds, waves, buffers)
                _fill_sectors(world, priced, (j, i), directions, buffers, motions, kept)
                replace_unknown_currents(buffers.current, instants)
                _fill_courses(world, (j, i), instants, buffers, motions)
