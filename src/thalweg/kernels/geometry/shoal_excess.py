"""How much more a mile counts in shoal water: sampled along legs on a global grid of depth.

A leg is sampled at the middles of pieces of `PIECE`, a sixth of a cell of the grid. Tiles of half a
degree state how far away the nearest tile with shoal water is, so that most of an ocean is skipped.
"""

from math import asin, ceil, cos, pi, sin, sqrt
from typing import Final, NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, inlined_by_numba
from thalweg.kernels.geometry.cube_sphere import latitude_longitude, unit_vector

DEGREE: Final = pi / 180.0
PIECE: Final = DEGREE / 60.0  # 1 nm, of the geocentric angle [rad]
STRETCH: Final = 1.0 * DEGREE  # so long stretches are straight in latitude and longitude [rad]
SHORT: Final = 1.0  # so long legs bend from the line that is straight in degrees by less than ...
BULGE: Final = 0.02  # ... this, below 80 degrees of latitude [deg]
POINTS_OF_DEGREE: Final = 10  # of the grid
POINTS_OF_TILE: Final = 5  # of the grid, along the side of a tile
TILES_OF_DEGREE: Final = 2


class ShoalArrays(NamedTuple):
    """Depth on a global grid of tenths of a degree, and what counts as shoal.

    Attributes
    ----------
    code : uint8[1801, 3600]
        Depth [m] plus 1 from 90 S and 180 W on; 0 on land.
    free : uint8[360, 720]
        How many tiles away the nearest tile with shoal water is, in the larger of the two
        directions; 0: there is some in the tile itself.
    depths : float64[2]
        Below the first depth [m] water is shoal; below the second the ship has less water than she
        requires.
    excess : float64[2]
        Excess of a mile in water of the second depth, and in water of half of it or less.
    """

    code: np.ndarray
    free: np.ndarray
    depths: np.ndarray
    excess: np.ndarray


@inlined_by_numba
def _water(value, share):
    """Return (weight, weighted depth) of a point of the grid; nothing on land."""
    return (share, share * (value - 1.0)) if value > 0 else (0.0, 0.0)


@allocation_free
def grid_depth(code, lat, lon):
    """Return the depth [m] between the points of the grid that are water; NaN between land."""
    y = min(max((lat + 90.0) * POINTS_OF_DEGREE, 0.0), 1800.0)
    x = ((lon + 180.0) % 360.0) * POINTS_OF_DEGREE
    row, column = min(int(y), 1799), int(x)
    t, s = y - row, x - column
    column = column if column < 3600 else 0
    after = column + 1 if column < 3599 else 0
    a, depth_a = _water(code[row, column], (1.0 - t) * (1.0 - s))
    b, depth_b = _water(code[row, after], (1.0 - t) * s)
    c, depth_c = _water(code[row + 1, column], t * (1.0 - s))
    d, depth_d = _water(code[row + 1, after], t * s)
    weight = a + b + c + d
    return (depth_a + depth_b + depth_c + depth_d) / weight if weight > 0.0 else np.nan


@inlined_by_numba
def _excess_of_depth(shoals, depth):
    """Return the excess of a mile at a depth [m]; 0 where it is unknown."""
    contour, least = shoals.depths[0], shoals.depths[1]
    if not depth < contour:
        return 0.0
    if depth >= least:
        return shoals.excess[0] * (contour - depth) / (contour - least)
    share = min(2.0 * (least - depth) / least, 1.0)
    return shoals.excess[0] + share * (shoals.excess[1] - shoals.excess[0])


@inlined_by_numba
def _free_tiles(shoals, lat, lon):
    """Return how many tiles away the nearest tile with shoal water is."""
    row = min(max(int((lat + 90.0) * TILES_OF_DEGREE), 0), 359)
    column = int(((lon + 180.0) % 360.0) * TILES_OF_DEGREE)
    return shoals.free[row, column if column < 720 else 0]


@allocation_free
def _is_free(shoals, lat1, lon1, lat2, turn, angle):
    """Return whether there is no shoal water along a stretch, by the tiles round its middle."""
    lat, lon = 0.5 * (lat1 + lat2), lon1 + 0.5 * turn
    tiles = _free_tiles(shoals, lat, lon)
    if tiles < 2:
        return False
    reach = (tiles - 1.0) / TILES_OF_DEGREE
    return 0.5 * angle < reach * DEGREE * cos(min(abs(lat) + reach, 90.0) * DEGREE)


@allocation_free
def _stretch_excess(shoals, lat1, lon1, lat2, turn, angle):
    """Return the mean excess of a mile along a stretch that is straight in degrees."""
    if _is_free(shoals, lat1, lon1, lat2, turn, angle):
        return 0.0
    pieces = max(ceil(angle / PIECE), 1)
    total = 0.0
    for k in range(pieces):
        share = (k + 0.5) / pieces
        lat, lon = lat1 + share * (lat2 - lat1), lon1 + share * turn
        if _free_tiles(shoals, lat, lon) == 0:
            total += _excess_of_depth(shoals, grid_depth(shoals.code, lat, lon))
    return total / pieces


@allocation_free
def leg_shoal_excess(shoals, lat1, lon1, lat2, lon2):
    """Return the mean excess of a mile along a leg [deg]; NaN for a position that is no number."""
    ax, ay, az = unit_vector(lat1, lon1)
    bx, by, bz = unit_vector(lat2, lon2)
    angle = 2.0 * asin(min(0.5 * sqrt((ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2), 1.0))
    if angle != angle:
        return np.nan
    stretches = max(ceil(angle / STRETCH), 1)
    whole = sin(angle)
    total = 0.0
    lat, lon = lat1, lon1
    for k in range(1, stretches + 1):
        lat_next, lon_next = lat2, lon2
        if k < stretches:
            share = k / stretches
            p, q = sin((1.0 - share) * angle) / whole, sin(share * angle) / whole
            lat_next, lon_next = latitude_longitude(
                p * ax + q * bx, p * ay + q * by, p * az + q * bz
            )
        turn = (lon_next - lon + 180.0) % 360.0 - 180.0
        total += _stretch_excess(shoals, lat, lon, lat_next, turn, angle / stretches)
        lat, lon = lat_next, lon_next
    return total / stretches


@inlined_by_numba
def _is_free_at_once(shoals, lat1, lon1, lat2, lon2):
    """Return whether there is no shoal water along a short leg, without trigonometry."""
    rise, turn = lat2 - lat1, (lon2 - lon1 + 180.0) % 360.0 - 180.0
    widest = max(abs(rise), abs(turn))
    if not (widest <= SHORT and abs(lat1) <= 80.0):
        return False
    tiles = _free_tiles(shoals, lat1 + 0.5 * rise, lon1 + 0.5 * turn)
    return 0.5 * widest + BULGE < (tiles - 1.0) / TILES_OF_DEGREE


@allocation_free
def shoal_excesses(shoals, lat1, lon1, lat2, lon2, excess):
    """Fill ``excess`` with the mean excess of a mile along many legs [deg]."""
    for k in range(len(excess)):
        if _is_free_at_once(shoals, lat1[k], lon1[k], lat2[k], lon2[k]):
            excess[k] = 0.0
        else:
            excess[k] = leg_shoal_excess(shoals, lat1[k], lon1[k], lat2[k], lon2[k])


@allocation_free
def grid_depths(code, lat, lon, depth):
    """Fill ``depth`` [m] at many positions [deg]; see `grid_depth`."""
    for k in range(len(depth)):
        depth[k] = grid_depth(code, lat[k], lon[k])
