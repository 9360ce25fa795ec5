"""Sailing one leg along a great circle through a frozen raster: the only integration of such legs.

Time is integrated by the midpoint rule; the middle of a piece is reached with the slowness of the
piece before (order 2).
"""

import math
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.ellipsoid import EQUATORIAL_RADIUS
from thalweg.kernels.codes import CHANNEL_COUNT, NO_DATA, OK
from thalweg.kernels.compilation.decorators import inlined
from thalweg.kernels.leg.great_circle import great_circle, great_circle_point
from thalweg.kernels.leg.point_speed import (
    FuelTable,
    ShipArrays,
    fuel_rate_at_speed,
    point_speed_from_guess,
)
from thalweg.kernels.leg.raster_sampling import RasterArrays, interpolate_raster
from thalweg.kernels.leg.table_lookup import TableArrays

# Work space, after the sample of the sea.
TIME_STEP: Final = CHANNEL_COUNT  # time step of the raster found last
SLOWNESS: Final = CHANNEL_COUNT + 1  # of the last piece [s/m]; 0: none has been sailed
LENGTH: Final = CHANNEL_COUNT + 2  # [m]
INFEASIBLE_LENGTH: Final = CHANNEL_COUNT + 3  # length that cannot be sailed [m]
COST_SO_FAR: Final = CHANNEL_COUNT + 4  # cost
PENALTY_TIME: Final = CHANNEL_COUNT + 5  # what penalties add to the time [s]
SCRATCH_SIZE: Final = CHANNEL_COUNT + 6

MIN_PIECES: Final = 2
_DEFAULT_SLOWNESS = 0.2  # slowness assumed where no piece has been sailed yet [s/m]


class ShipOnRaster(NamedTuple):
    """The sea, the ship and its limits.

    Attributes
    ----------
    table : TableArrays
        Speed through water [m/s].
    limits : float64[LIMITS]
    """

    raster: RasterArrays
    table: TableArrays
    limits: np.ndarray


class GreatCircleLeg(NamedTuple):
    """A leg to sail.

    Attributes
    ----------
    start, end : (float, float)
        Latitude and longitude [deg].
    pieces : Number of pieces; 0: as many as the longest piece needs.
    longest_piece : [m].
    charted : Least charted depth [m below datum]; +inf not checked.
    is_blocked : Whether it touches land or a no-go zone.
    """

    start: tuple
    end: tuple
    setting: int
    pieces: int
    longest_piece: float
    charted: float
    is_blocked: bool


class LegPrice(NamedTuple):
    """Prices on one leg: of a kilogram of fuel and of a second, and the factor of penalty zones."""

    fuel: float
    time: float
    penalty: float


@inlined
def _piece_performance(world, fuel, needs, leg, t, place, course, scratch):
    """Return (slowness [s/m], fuel rate [kg/s], status) at the middle of a piece."""
    status, step = interpolate_raster(
        world.raster, t, place[0], place[1], int(scratch[TIME_STEP]), scratch
    )
    scratch[TIME_STEP] = step
    if status != OK:
        return 0.0, 0.0, status
    index = world.raster.channel_index
    ship = ShipArrays(world.table, leg.setting, world.limits, needs[0])
    over_ground, status, through = point_speed_from_guess(
        scratch, index, course, ship, leg.charted, math.inf
    )
    if status != OK:
        return 0.0, 0.0, status
    if fuel is None:
        return 1.0 / over_ground, 0.0, OK
    rate, ok = fuel_rate_at_speed(
        scratch, index, course, FuelTable(fuel, needs[1]), ship, leg.charted, through
    )
    return 1.0 / over_ground, rate, OK if ok else NO_DATA


@inlined
def sail_great_circle_leg(world, fuel, needs, leg, price, t, scratch):
    """Sail a leg from a time [s]: return (arrival, status).

    Parameters
    ----------
    world : ShipOnRaster or FitnessArrays
    fuel : TableArrays or None
        Fuel rate [kg/s]. None if only the time is needed: a piece that cannot be sailed then ends
        the leg, with an arrival of +inf and the reason as the status. With fuel, such a piece takes
        the speed of the piece before and counts as infeasible length; the status is `OK`.
    needs : (int, int)
        Axes needed of the table and of the fuel.
    leg : GreatCircleLeg
    price : LegPrice or None
        None without fuel.
    t : float
        Departure [s].
    scratch : float64[SCRATCH_SIZE]
        Read and written: the time step, slowness, lengths and costs so far.
    """
    start, tangent, arc = great_circle(leg.start[0], leg.start[1], leg.end[0], leg.end[1])
    if arc == 0.0:
        return t, OK
    count = leg.pieces
    if count == 0:
        count = max(MIN_PIECES, math.ceil(EQUATORIAL_RADIUS * arc / leg.longest_piece))
    step = arc / count
    turn_sine, turn_cosine = math.sin(step), math.cos(step)
    s, c = math.sin(0.5 * step), math.cos(0.5 * step)
    for _ in range(count):
        lat, lon, east, north, scale = great_circle_point(start, tangent, s, c)
        s, c = s * turn_cosine + c * turn_sine, c * turn_cosine - s * turn_sine
        length = scale * step
        place, course = (lat, lon), (east, north)
        if scratch[SLOWNESS] == 0.0:  # a first slowness, at the start
            slowness, _, status = _piece_performance(
                world, fuel, needs, leg, t, place, course, scratch
            )
            scratch[SLOWNESS] = slowness
        at = t + 0.5 * length * scratch[SLOWNESS]
        slowness, rate, status = _piece_performance(
            world, fuel, needs, leg, at, place, course, scratch
        )
        scratch[LENGTH] += length
        if status != OK:
            if fuel is None:
                return math.inf, status
            scratch[INFEASIBLE_LENGTH] += length
            slowness = scratch[SLOWNESS] if scratch[SLOWNESS] > 0.0 else _DEFAULT_SLOWNESS
        else:
            scratch[SLOWNESS] = slowness
            if leg.is_blocked:
                scratch[INFEASIBLE_LENGTH] += length
        spent = length * slowness
        t += spent
        if fuel is not None:
            scratch[COST_SO_FAR] += spent * (rate * price.fuel + price.time) * price.penalty
            scratch[PENALTY_TIME] += spent * (price.penalty - 1.0)
    return t, OK
