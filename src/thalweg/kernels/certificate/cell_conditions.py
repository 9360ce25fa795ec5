"""What a ship may meet in one cell of a mesh during a window of time, and how fast it is there."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.certificate.known_limits import has_limits, limits_are_known
from thalweg.kernels.certificate.mesh_sampling import margin_of_cell, sample_node, time_step_of
from thalweg.kernels.certificate.speed_ranges import (
    angle_from_bow_range,
    direction_range,
    kept_speed,
    widened_directions,
)
from thalweg.kernels.codes import (
    AXIS_COUNT,
    AXIS_DEPTH,
    AXIS_WAVE_ANGLE,
    AXIS_WAVE_HEIGHT,
    AXIS_WAVE_PERIOD,
    AXIS_WIND_ANGLE,
    AXIS_WIND_SPEED,
    BED_DEPTH,
    CHANNEL_COUNT,
    CURRENT_EAST,
    CURRENT_NORTH,
    LIMIT_REQUIRED_DEPTH,
    LIMIT_WAVE_HEIGHT,
    LIMIT_WIND_SPEED,
    SPEED_FIELD,
    WATER_LEVEL,
    WAVE_EAST,
    WAVE_HEIGHT_CHANNEL,
    WAVE_NORTH,
    WAVE_PERIOD,
    WIND_EAST,
    WIND_NORTH,
)
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.raster_sampling import RasterArrays

SECTORS = 48  # of headings
MAX_INSTANTS = 128  # of one window; longer windows are treated as unlimited
ANGLES = (1 << AXIS_WIND_ANGLE) | (1 << AXIS_WAVE_ANGLE)
_PLAIN_AXES = ((AXIS_WAVE_HEIGHT, WAVE_HEIGHT_CHANNEL), (AXIS_WAVE_PERIOD, WAVE_PERIOD))
_WIND = (1 << AXIS_WIND_SPEED) | (1 << AXIS_WIND_ANGLE)


class BarrierWorld(NamedTuple):
    """Sea, ship and land on a mesh of cells that divides the cells of a raster evenly.

    Attributes
    ----------
    raster : RasterArrays
        The sea; times since departure [s].
    refinement : int
        Cells of the mesh along the side of a cell of the raster.
    first_row, first_column : int
        Row and column of the raster at the south-west corner of the mesh.
    metres_east, metres_north : float64[Y]
        Length of one degree of longitude and latitude at the rows of nodes [m].
    closed : bool[Y - 1, X - 1]
        Cells without any navigable water, whatever the time.
    deepest : float32[Y - 1, X - 1]
        Greatest charted depth in each cell [m below datum]; +inf where it is unknown.
    ship : ShipArrays
    top_speed : float
        Upper bound of the speed through water [m/s].
    departures : float
        From the first to the last departure [s]; times count from each departure, those of the
        raster from the first one.
    by_steps : bool
        Whether limits may open and close at any moment between two times of the raster, as where it
        samples functions, and not only as its linear interpolation says.
    margins : float64[Y, X, CHANNELS]
        By how much the sea may differ from the interpolated raster in each of its cells, by
        channel; of vectors the length of the difference, for both components. One cell: the same
        everywhere.
    """

    raster: RasterArrays
    refinement: int
    first_row: int
    first_column: int
    metres_east: np.ndarray
    metres_north: np.ndarray
    closed: np.ndarray
    deepest: np.ndarray
    ship: ShipArrays
    top_speed: float
    departures: float
    by_steps: bool
    margins: np.ndarray


class TimeWindows(NamedTuple):
    """Windows of time of cells or nodes [s]: first and last moment of each, float64[Y, X]."""

    first: np.ndarray
    last: np.ndarray


class CellBuffers(NamedTuple):
    """Work arrays of one thread.

    Attributes
    ----------
    sample : float64[CHANNELS]
    current : float64[INSTANTS, 4, 2]
        Current at the corners at each instant of the window.
    wind, waves : float64[INSTANTS * 4, 2]
        Known vectors of the wind over the water and of the direction of the waves.
    wind_over_ground : float64[INSTANTS * 4, 2]
        Known vectors of the wind, which its limit holds for.
    low, high : float64[AXES]
        Ranges of the conditions.
    place : float64[4 * AXES]
    speed : float64[SECTORS]
        Greatest speed for headings in each sector [m/s].
    asked, answer : float64[SECTORS, 2, AXES], float64[SECTORS]
        Ranges for which the greatest speed was found last by sector, and that speed [m/s].
    """

    sample: np.ndarray
    current: np.ndarray
    wind: np.ndarray
    waves: np.ndarray
    wind_over_ground: np.ndarray
    low: np.ndarray
    high: np.ndarray
    place: np.ndarray
    speed: np.ndarray
    asked: np.ndarray
    answer: np.ndarray


@jit
def make_buffers():
    """Return the work arrays of one thread."""
    return CellBuffers(
        np.full(CHANNEL_COUNT, np.nan),
        np.zeros((MAX_INSTANTS, 4, 2)),
        np.zeros((4 * MAX_INSTANTS, 2)),
        np.zeros((4 * MAX_INSTANTS, 2)),
        np.zeros((4 * MAX_INSTANTS, 2)),
        np.zeros(AXIS_COUNT),
        np.zeros(AXIS_COUNT),
        np.zeros(4 * AXIS_COUNT),
        np.zeros(SECTORS),
        np.full((SECTORS, 2, AXIS_COUNT), np.nan),
        np.zeros(SECTORS),
    )


@kernel_only
def _widen(low, high, value):
    return min(low, value), max(high, value)


@kernel_only
def _read_window(world, j, i, first, last, buffers):
    """Collect the conditions in a cell during a window of time; see `read_cell`."""
    times, index = world.raster.times, world.raster.channel_index
    final = times.shape[0] - 1
    low, high = buffers.low, buffers.high
    low[:] = math.inf
    high[:] = -math.inf
    bed_high, level_low, level_high, bed_low = -math.inf, math.inf, -math.inf, math.inf
    field_high = -math.inf
    lowest_wave = math.inf
    winds, waves, known_corners, instants = 0, 0, 0, 0
    unlimited = False
    last += world.departures
    if world.closed[j, i] or first > times[final] or last < times[0]:
        return 0, False, 0.0, 0, 0
    t = max(first, times[0])
    end = min(last, times[final])
    while True:
        if instants == MAX_INSTANTS:
            unlimited = True
            break
        step, fraction = time_step_of(times, t)
        for corner in range(4):
            sample = buffers.sample
            sample_node(world, j + corner // 2, i + corner % 2, step, fraction, sample)
            east, north = 0.0, 0.0
            if index[CURRENT_EAST] >= 0 and index[CURRENT_NORTH] >= 0:
                east, north = sample[CURRENT_EAST], sample[CURRENT_NORTH]
            buffers.current[instants, corner, 0] = east
            buffers.current[instants, corner, 1] = north
            if not (east == east and north == north):
                continue
            known = True
            if index[SPEED_FIELD] >= 0:
                known = sample[SPEED_FIELD] == sample[SPEED_FIELD]
                if known:
                    field_high = max(field_high, sample[SPEED_FIELD])
            if index[WAVE_HEIGHT_CHANNEL] >= 0:
                height = sample[WAVE_HEIGHT_CHANNEL]
                if height == height:
                    low[AXIS_WAVE_HEIGHT], high[AXIS_WAVE_HEIGHT] = _widen(
                        low[AXIS_WAVE_HEIGHT], high[AXIS_WAVE_HEIGHT], height
                    )
                    lowest_wave = min(lowest_wave, height)
                elif world.ship.needs & (1 << AXIS_WAVE_HEIGHT):
                    known = False
                if index[WAVE_EAST] >= 0 and index[WAVE_NORTH] >= 0:
                    a, b = sample[WAVE_EAST], sample[WAVE_NORTH]
                    if a == a and b == b:
                        buffers.waves[waves, 0], buffers.waves[waves, 1] = a, b
                        waves += 1
                    elif height == height:
                        buffers.waves[waves, 0], buffers.waves[waves, 1] = 0.0, 0.0
                        waves += 1
            if index[WAVE_PERIOD] >= 0:
                period = sample[WAVE_PERIOD]
                if period == period:
                    low[AXIS_WAVE_PERIOD], high[AXIS_WAVE_PERIOD] = _widen(
                        low[AXIS_WAVE_PERIOD], high[AXIS_WAVE_PERIOD], period
                    )
            if index[WIND_EAST] >= 0 and index[WIND_NORTH] >= 0:
                a, b = sample[WIND_EAST] - east, sample[WIND_NORTH] - north
                if a == a and b == b:
                    buffers.wind[winds, 0], buffers.wind[winds, 1] = a, b
                    buffers.wind_over_ground[winds, 0] = sample[WIND_EAST]
                    buffers.wind_over_ground[winds, 1] = sample[WIND_NORTH]
                    winds += 1
                elif world.ship.needs & _WIND:
                    known = False
            if index[BED_DEPTH] >= 0 and sample[BED_DEPTH] == sample[BED_DEPTH]:
                bed_low, bed_high = _widen(bed_low, bed_high, sample[BED_DEPTH])
            if index[WATER_LEVEL] >= 0 and sample[WATER_LEVEL] == sample[WATER_LEVEL]:
                level_low, level_high = _widen(level_low, level_high, sample[WATER_LEVEL])
            known_corners += known and limits_are_known(index, sample, world.ship.limits)
        instants += 1
        if t >= end:
            break
        t = min(end, times[min(step + 1 + (fraction >= 1.0), final)])
    if known_corners < 2 or (unlimited and instants == 0):
        return 0, False, 0.0, 0, 0
    for axis, channel in _PLAIN_AXES:
        margin = margin_of_cell(world, j, i, channel)
        low[axis] -= margin
        high[axis] += margin
    lowest_wave -= margin_of_cell(world, j, i, WAVE_HEIGHT_CHANNEL)
    bed, level = margin_of_cell(world, j, i, BED_DEPTH), margin_of_cell(world, j, i, WATER_LEVEL)
    bed_low, bed_high = bed_low - bed, bed_high + bed
    level_low, level_high = level_low - level, level_high + level
    # depth
    deep = world.deepest[j, i]
    if index[BED_DEPTH] >= 0:
        if bed_high == -math.inf:
            bed_low, bed_high = -math.inf, math.inf
        deep = min(deep, bed_high)
    else:
        bed_low = -math.inf
    if index[WATER_LEVEL] >= 0 and level_high > -math.inf:
        deep += level_high
        bed_low += level_low
    elif index[WATER_LEVEL] >= 0:
        deep, bed_low = math.inf, -math.inf
    low[AXIS_DEPTH], high[AXIS_DEPTH] = bed_low, deep
    if unlimited:
        return -1, True, field_high, winds, waves
    is_open = deep >= world.ship.limits[LIMIT_REQUIRED_DEPTH]
    if lowest_wave < math.inf:
        is_open = is_open and lowest_wave <= world.ship.limits[LIMIT_WAVE_HEIGHT]
    if winds > 0 and world.ship.limits[LIMIT_WIND_SPEED] < math.inf:
        shortest = direction_range(buffers.wind_over_ground, winds)[2]
        shortest -= margin_of_cell(world, j, i, WIND_EAST)
        is_open = is_open and shortest <= world.ship.limits[LIMIT_WIND_SPEED]
    return instants, is_open, field_high, winds, waves


@kernel_only
def _read_samples(world, j, i, first, last, buffers):
    """Collect the conditions in a cell; where it is closed, up to the samples round the window."""
    found = _read_window(world, j, i, first, last, buffers)
    if found[1] or not world.by_steps or world.closed[j, i]:
        return found
    # what is closed at two samples of a function is taken to be closed between them, no more
    times = world.raster.times
    step, fraction = time_step_of(times, last + world.departures)
    until = times[step + 1] if fraction > 0.0 else times[step]
    since = times[time_step_of(times, first)[0]]
    return _read_window(
        world, j, i, min(first, since), max(last, until - world.departures), buffers
    )


@kernel_only
def read_cell(world, j, i, first, last, buffers):
    """Collect the conditions in a cell during a window of time since each departure.

    Returns
    -------
    instants : int
        Moments that were read; 0 where nothing is known, -1 where they are more than the buffers
        hold, so that any conditions are taken as possible. Whether the cell is closed is known
        then all the same.
    is_open : bool
        False where no ship may be in the cell at any moment of the window.
    field_high : float
        Greatest speed of a field of speeds [m/s]; not above 0 where none is known.
    winds, waves : int
        Vectors of wind and of waves in ``buffers``.

    Notes
    -----
    Fills the ranges of the conditions, the vectors of wind and waves, and the currents at the
    corners in ``buffers``.
    """
    found = _read_samples(world, j, i, first, last, buffers)
    if found[0] >= 0 or not has_limits(world):
        return found
    # a window of too many instants is closed where each of its parts is
    times = world.raster.times
    since = first
    while since < last:
        step = time_step_of(times, since)[0]
        until = min(last, times[min(step + MAX_INSTANTS - 2, times.shape[0] - 1)])
        if until <= since:
            until = last
        if _read_samples(world, j, i, since, until, buffers)[1]:
            return found
        since = until
    return -1, False, 0.0, 0, 0


@kernel_only
def fill_ranges(world, cell, winds, waves, buffers):
    """Complete the ranges of the conditions of a cell; return those of the directions.

    Returns
    -------
    tuple of four floats
        First and last azimuth of the wind, and of the waves, the way they travel [rad].
    """
    low, high = buffers.low, buffers.high
    wind, wave = direction_range(buffers.wind, winds), direction_range(buffers.waves, waves)
    j, i = cell
    over_water = margin_of_cell(world, j, i, WIND_EAST) + margin_of_cell(world, j, i, CURRENT_EAST)
    wind = widened_directions(wind, over_water)
    wave = widened_directions(wave, margin_of_cell(world, j, i, WAVE_EAST))
    low[AXIS_WIND_SPEED], high[AXIS_WIND_SPEED] = wind[2], wind[3]
    for axis in range(low.shape[0]):
        if not low[axis] <= high[axis]:  # nothing known: anything
            low[axis], high[axis] = -math.inf, math.inf
    return wind[0], wind[1], wave[0], wave[1]


@kernel_only
def fill_angles(directions, heading, half, buffers):
    """Fill the ranges of the angles from the bow for headings within ``half`` of one [rad]."""
    low, high = buffers.low, buffers.high
    wind_first, wind_last, wave_first, wave_last = directions
    # what travels towards an azimuth comes from the opposite one
    low[AXIS_WIND_ANGLE], high[AXIS_WIND_ANGLE] = angle_from_bow_range(
        wind_first + math.pi - heading - half, wind_last + math.pi - heading + half
    )
    low[AXIS_WAVE_ANGLE], high[AXIS_WAVE_ANGLE] = angle_from_bow_range(
        wave_first + math.pi - heading - half, wave_last + math.pi - heading + half
    )


@kernel_only
def cell_speeds(world, cell, found, buffers):
    """Fill the greatest speed by sector of heading; return (greatest, same for all headings)."""
    instants, field_high, winds, waves = found
    index = world.raster.channel_index
    table, setting, _, needs = world.ship
    if index[SPEED_FIELD] >= 0:
        top = field_high if instants > 0 else world.top_speed
        buffers.speed[:] = max(top, 0.0)
        return max(top, 0.0), True
    if instants < 0:
        buffers.speed[:] = world.top_speed
        return world.top_speed, True
    directions = fill_ranges(world, cell, winds, waves, buffers)
    if not needs & ANGLES:
        top = kept_speed(table, setting, world.top_speed, 0, buffers)
        buffers.speed[:] = top
        return top, True
    half = math.pi / SECTORS
    top = 0.0
    for sector in range(SECTORS):
        heading = 2.0 * half * sector
        fill_angles(directions, heading, half, buffers)
        buffers.speed[sector] = kept_speed(table, setting, world.top_speed, sector, buffers)
        top = max(top, buffers.speed[sector])
    return top, False
