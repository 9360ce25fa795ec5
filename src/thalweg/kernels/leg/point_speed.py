"""Motion of a ship at one point of a leg: the compiled formula that all searches share."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    AXIS_DEPTH,
    AXIS_WAVE_ANGLE,
    AXIS_WAVE_HEIGHT,
    AXIS_WAVE_PERIOD,
    AXIS_WIND_ANGLE,
    AXIS_WIND_SPEED,
    BED_DEPTH,
    CURRENT,
    CURRENT_EAST,
    CURRENT_NORTH,
    DEPTH,
    LIMIT_REQUIRED_DEPTH,
    LIMIT_WAVE_HEIGHT,
    LIMIT_WIND_SPEED,
    NO_DATA,
    OK,
    SAFETY,
    SHIP_RANGE,
    SPEED_FIELD,
    WATER_LEVEL,
    WAVE_EAST,
    WAVE_HEIGHT,
    WAVE_HEIGHT_CHANNEL,
    WAVE_NORTH,
    WAVE_PERIOD,
    WIND_EAST,
    WIND_NORTH,
    WIND_SPEED,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.table_lookup import (
    TableArrays,
    axes_needed,
    has_wave_limits,
    sum_of_parts,
)
from thalweg.kernels.leg.wave_limits import exceeds_wave_limits

_WIND_AXES = (1 << AXIS_WIND_SPEED) | (1 << AXIS_WIND_ANGLE)
_WAVE_AXES = (1 << AXIS_WAVE_HEIGHT) | (1 << AXIS_WAVE_ANGLE) | (1 << AXIS_WAVE_PERIOD)
_ANGLE_AXES = (1 << AXIS_WIND_ANGLE) | (1 << AXIS_WAVE_ANGLE)
_DEPTH_AXIS = 1 << AXIS_DEPTH
_MAX_HEADING_CORRECTIONS = 6  # corrections of the heading at most
_HEADING_TOLERANCE = 1e-3  # turn of the heading that no further correction is made for [rad]


class ShipArrays(NamedTuple):
    """A ship at one setting, with its limits and the axes its table needs."""

    table: TableArrays
    setting: int
    limits: np.ndarray
    needs: int


class FuelTable(NamedTuple):
    """The fuel rate of a ship [kg/s] by setting, and the axes its table needs."""

    table: TableArrays
    needs: int


@inlined
def angle_from_bow(head_east, head_north, to_east, to_north):
    """Return the angle [rad] from the bow of where something travelling along a vector comes from.

    0 is from ahead, pi from astern; 0 for a vector of no length. The arctangent is a polynomial
    with an error below 5e-8 rad.
    """
    x = -(head_east * to_east + head_north * to_north)
    y = abs(head_east * to_north - head_north * to_east)
    w = abs(x)
    large, small = max(w, y), min(w, y)
    if large == 0.0:
        return 0.0
    q = small / large
    s = q * q
    p = 0.021862487662147823 - 0.004054439689843231 * s
    p = -0.1390860887681844 + s * (0.09642145552352929 + s * (-0.05591163452667118 + s * p))
    p = q * (0.9999993354816579 + s * (-0.3332986040706979 + s * (0.19946561432416243 + s * p)))
    if y > w:
        p = 0.5 * math.pi - p
    return math.pi - p if x < 0.0 else p


@inlined
def water_depth(sample, channel_index, static_depth):
    """Return the water depth [m]: the lesser of charted depth and bed depth, plus water level."""
    depth = static_depth
    if channel_index[BED_DEPTH] >= 0:
        bed = sample[BED_DEPTH]
        if not depth <= bed:  # NaN in either ends as NaN
            depth = bed if depth == depth else depth
    if channel_index[WATER_LEVEL] >= 0:
        depth += sample[WATER_LEVEL]
    return depth


@inlined
def _wind_over_water(sample, channel_index, current_east, current_north):
    """Return the wind relative to the moving water (east, north) [m/s]; NaN if unknown."""
    if channel_index[WIND_EAST] < 0 or channel_index[WIND_NORTH] < 0:
        return math.nan, math.nan
    return sample[WIND_EAST] - current_east, sample[WIND_NORTH] - current_north


@inlined
def _known_waves(sample, channel_index, needs):
    """Return (height, east, north, period, known) of the waves, as far as they are needed."""
    height = sample[WAVE_HEIGHT_CHANNEL] if channel_index[WAVE_HEIGHT_CHANNEL] >= 0 else math.nan
    east, north, period, known = 0.0, 0.0, 0.0, height == height
    if needs & (1 << AXIS_WAVE_ANGLE):
        if channel_index[WAVE_EAST] >= 0 and channel_index[WAVE_NORTH] >= 0:
            east, north = sample[WAVE_EAST], sample[WAVE_NORTH]
        else:
            known = False
        if not (east == east and north == north):
            east, north = 0.0, 0.0
            known &= height == 0.0  # no waves have no direction
    if needs & (1 << AXIS_WAVE_PERIOD):
        period = sample[WAVE_PERIOD] if channel_index[WAVE_PERIOD] >= 0 else math.nan
        known &= period == period
    return height, east, north, period, known


@inlined
def _speed_through_water(ship, course, to_port, wind, waves, depth, guess):
    """Return (speed through water, ok), the heading corrected for the current across the course.

    ``to_port`` is the current across the course [m/s], positive to port.
    """
    table, setting, _, needs = ship
    east, north = course
    wind_speed = 0.0
    if needs & _WIND_AXES:
        wind_speed = math.sqrt(wind[0] * wind[0] + wind[1] * wind[1])
    turns = to_port != 0.0 and needs & _ANGLE_AXES
    speed = guess if guess > abs(to_port) else math.inf
    for _ in range(_MAX_HEADING_CORRECTIONS):
        sine = -to_port / speed
        cosine = math.sqrt(1.0 - sine * sine)
        head_east = east * cosine - north * sine
        head_north = north * cosine + east * sine
        wind_angle, wave_angle = 0.0, 0.0
        if needs & (1 << AXIS_WIND_ANGLE):
            wind_angle = angle_from_bow(head_east, head_north, wind[0], wind[1])
        if needs & (1 << AXIS_WAVE_ANGLE):
            wave_angle = angle_from_bow(head_east, head_north, waves[1], waves[2])
        axis_values = (wind_speed, wind_angle, waves[0], wave_angle, waves[3], depth)
        before = speed
        speed, ok = sum_of_parts(table, axis_values, setting)
        if not ok:
            return 0.0, False
        if not turns or speed <= abs(to_port):
            break
        if abs((speed - before) * to_port) <= _HEADING_TOLERANCE * speed * speed:
            break
    return speed, True


@inlined
def _conditions(sample, channel_index, current, needs, static_depth, limits):
    """Return (depth, waves, wind, status): what is needed of the sea, and whether limits allow it.

    Waves are (height, east, north, period), wind is (east, north) relative to the moving water;
    the limit is for the wind over the ground.
    """
    depth, waves, wind = 0.0, (0.0, 0.0, 0.0, 0.0), (0.0, 0.0)
    required = limits[LIMIT_REQUIRED_DEPTH]
    if needs & _DEPTH_AXIS or required > -math.inf:
        depth = water_depth(sample, channel_index, static_depth)
        if depth != depth:
            return depth, waves, wind, NO_DATA
        if depth < required:
            return depth, waves, wind, DEPTH
    if needs & _WAVE_AXES or limits[LIMIT_WAVE_HEIGHT] < math.inf:
        height, wave_east, wave_north, period, known = _known_waves(sample, channel_index, needs)
        waves = (height, wave_east, wave_north, period)
        if not known:
            return depth, waves, wind, NO_DATA
        if height > limits[LIMIT_WAVE_HEIGHT]:
            return depth, waves, wind, WAVE_HEIGHT
    if needs & _WIND_AXES or limits[LIMIT_WIND_SPEED] < math.inf:
        wind = _wind_over_water(sample, channel_index, current[0], current[1])
        if not (wind[0] == wind[0] and wind[1] == wind[1]):
            return depth, waves, wind, NO_DATA
        squared = sample[WIND_EAST] * sample[WIND_EAST] + sample[WIND_NORTH] * sample[WIND_NORTH]
        if squared > limits[LIMIT_WIND_SPEED] * limits[LIMIT_WIND_SPEED]:
            return depth, waves, wind, WIND_SPEED
    return depth, waves, wind, OK


@inlined
def point_speed_from_guess(sample, channel_index, course, ship, static_depth, guess):
    """Do as `point_speed`, with a guess of the speed through water for the first heading.

    ``course`` is (east, north), ``ship`` a `ShipArrays`. Returns (speed over ground, status, speed
    through water); a guess of inf is none. Against too strong a current the speed through water is
    the one that does not suffice, else 0 where closed.
    """
    east, north = course
    needs = ship.needs
    current = (0.0, 0.0)
    if channel_index[CURRENT_EAST] >= 0 and channel_index[CURRENT_NORTH] >= 0:
        current = (sample[CURRENT_EAST], sample[CURRENT_NORTH])
    along = current[0] * east + current[1] * north
    to_port = current[1] * east - current[0] * north
    if not (along == along and to_port == to_port):
        return 0.0, NO_DATA, 0.0
    field = channel_index[SPEED_FIELD] >= 0
    if field:
        needs = 0
    depth, waves, wind, status = _conditions(
        sample, channel_index, current, needs, static_depth, ship.limits
    )
    if status != OK:
        return 0.0, status, 0.0
    if field:
        speed, ok = sample[SPEED_FIELD], True
        if speed != speed:
            return 0.0, NO_DATA, 0.0
    else:
        speed, ok = _speed_through_water(ship, course, to_port, wind, waves, depth, guess)
    if not ok:
        return 0.0, SHIP_RANGE, 0.0
    spare = speed * speed - to_port * to_port
    over_ground = along + math.sqrt(max(spare, 0.0))
    if speed <= 0.0 or spare <= 0.0 or over_ground <= 0.0:
        return 0.0, CURRENT, speed
    if not field and has_wave_limits(ship.table):
        sine = -to_port / speed
        cosine = math.sqrt(max(1.0 - sine * sine, 0.0))
        head_east, head_north = east * cosine - north * sine, north * cosine + east * sine
        angle = angle_from_bow(head_east, head_north, waves[1], waves[2])
        if exceeds_wave_limits(ship.table, speed, angle, waves[0], waves[3]):
            return 0.0, SAFETY, 0.0
    return over_ground, OK, speed


@inlined
def fuel_rate_at_speed(sample, index, course, fuel, ship, static_depth, speed):
    """Return (fuel rate [kg/s], ok) of a ship whose speed through water is known.

    The heading follows from the course, the current across it and the speed, as in
    `point_speed_from_guess`. ``fuel`` is a `FuelTable`.
    """
    east, north = course
    needs = fuel.needs
    if needs == 0:
        return sum_of_parts(fuel.table, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), ship.setting)
    current = (0.0, 0.0)
    if index[CURRENT_EAST] >= 0 and index[CURRENT_NORTH] >= 0:
        current = (sample[CURRENT_EAST], sample[CURRENT_NORTH])
    depth, waves, wind, status = _conditions(
        sample, index, current, needs, static_depth, ship.limits
    )
    if status != OK:
        return 0.0, False
    wind_speed, wind_angle, wave_angle = 0.0, 0.0, 0.0
    if needs & _WIND_AXES:
        wind_speed = math.sqrt(wind[0] * wind[0] + wind[1] * wind[1])
    if needs & _ANGLE_AXES:
        sine = -(current[1] * east - current[0] * north) / speed
        cosine = math.sqrt(max(1.0 - sine * sine, 0.0))
        head_east = east * cosine - north * sine
        head_north = north * cosine + east * sine
        if needs & (1 << AXIS_WIND_ANGLE):
            wind_angle = angle_from_bow(head_east, head_north, wind[0], wind[1])
        if needs & (1 << AXIS_WAVE_ANGLE):
            wave_angle = angle_from_bow(head_east, head_north, waves[1], waves[2])
    values = (wind_speed, wind_angle, waves[0], wave_angle, waves[3], depth)
    return sum_of_parts(fuel.table, values, ship.setting)


@allocation_free
def point_speed(sample, channel_index, east, north, table, setting, static_depth, limits):
    """Return the speed over ground of a ship that holds a course at one point, or why it cannot.

    Parameters
    ----------
    sample : float64[CHANNELS]
        Sea at the point by channel id (`thalweg.kernels.codes`), SI; NaN is unknown. Entries of
        channels the sea does not have are not read.
    channel_index : int64[CHANNELS]
        -1 where the sea has no such channel. Without a current channel there is no current; other
        channels are considered only when the table has such an axis or there is a limit on them,
        and missing ones then count as unknown.
    east, north : float
        Unit vector of the course over ground.
    table : TableArrays
        Speed through water. A ``SPEED_FIELD`` channel replaces it.
    setting : int
        Setting of the ship.
    static_depth : float
        Charted depth [m below datum]; +inf is not checked, NaN unknown.
    limits : float64[LIMITS]
        Required depth [m], largest wave height [m], largest wind speed [m/s, over the
        ground, as forecasts give it].

    Returns
    -------
    speed : Over ground [m/s], > 0 when the status is `OK`, else 0.
    status : int
        `OK`, `NO_DATA`, `DEPTH`, `WAVE_HEIGHT`, `WIND_SPEED`, `SHIP_RANGE`, `CURRENT` or `SAFETY`.

    Notes
    -----
    Current triangle (van Halem 2019, section 2.3): with the current's components ``a`` along and
    ``b`` across the course, the speed over ground is ``a + sqrt(V^2 - b^2)``. Wind is relative to
    the moving water; wind and wave angles are from the heading, which is first taken as the course
    and then corrected by the current triangle until it would turn by less than 0.001 rad.
    """
    ship = ShipArrays(table, setting, limits, axes_needed(table))
    speed, status, _ = point_speed_from_guess(
        sample, channel_index, (east, north), ship, static_depth, math.inf
    )
    return speed, status
