"""Sailing a whole population of tracks through a frozen sea: time, cost and what they break.

A track is a row of points, and each point carries the leg that starts there (`LAT` and the other
columns). Routes are independent of one another, so the answer does not depend on the number of
threads.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from thalweg.kernels.codes import CHANNEL_COUNT, NO_DATA, OK, OUTSIDE_PERIOD
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.point_speed import fuel_rate_at_speed, point_speed_from_guess
from thalweg.kernels.leg.polyline_sailing import RasterArrays
from thalweg.kernels.leg.table_lookup import TableArrays, axes_needed

# Columns of genes: of a point ...
LAT: Final = 0  # [deg]
LON: Final = 1  # [deg]
WAITING_TIME: Final = 2  # time lain still there [s]
IS_REQUIRED: Final = 3  # 1: must stay in every track (ends and via points); 0: free
# ... and of the leg that starts there; the last point's are not read.
SETTING: Final = 4
IS_LOOKED_UP: Final = 5  # 0: the following are to be looked up
IS_BLOCKED: Final = 6  # 1: touches land or a no-go zone
FUEL_PRICE: Final = 7  # cost of a kilogram of fuel
CHARTED_DEPTH: Final = 8  # least charted depth [m below datum]; +inf not checked
PENALTY_FACTOR: Final = 9  # factor >= 1 on time and cost in comparisons
FIXED_TIME: Final = 10  # NaN where sailed; else the leg takes this long [s] (a canal)
FIXED_COST: Final = 11  # cost of the leg beside fuel (a canal's fee and fuel)
PIECES: Final = 12  # number of pieces; 0: by length
GENE_COLUMNS: Final = 13

# Terms of the cost and of the way of sailing.
TIME_PRICE: Final = 0  # cost of a second
WAITING_PRICE: Final = 1  # cost of the fuel of a second lain still
LATEST_ARRIVAL: Final = 2  # latest arrival [s]; +inf
PIECE_SPACING: Final = 3  # longest piece [m]
TERM_COUNT: Final = 4

TIME: Final = 0
COST: Final = 1
VIOLATION: Final = 2
SCORE_COUNT: Final = 3

# Room to work in, after the sample of the sea.
_TIME_STEP: Final = CHANNEL_COUNT  # time step of the raster found last
_SLOWNESS: Final = CHANNEL_COUNT + 1  # met last [s/m]
_INFEASIBLE_LENGTH: Final = CHANNEL_COUNT + 2  # length that cannot be sailed [m]
_LENGTH: Final = CHANNEL_COUNT + 3  # [m]
_COST_SO_FAR: Final = CHANNEL_COUNT + 4  # cost
_PENALTY_TIME: Final = CHANNEL_COUNT + 5  # what penalties add to the time [s]
SCRATCH_SIZE: Final = CHANNEL_COUNT + 6

MIN_PIECES: Final = 2
_MAJOR = 6378137.0  # WGS 84
_ECCENTRICITY2 = 6.69437999014e-3
_RADIANS = math.pi / 180.0
_DEFAULT_SLOWNESS = 0.2  # slowness assumed before any is met, where nothing can be sailed [s/m]


class FitnessArrays(NamedTuple):
    """What tracks are sailed through, and at what price.

    Attributes
    ----------
    raster : RasterArrays
    channels : int64[K]
        Channel of each column of the raster.
    table, fuel : TableArrays
        Speed through water [m/s]; fuel rate [kg/s].
    limits : float64[LIMITS]
    terms : float64[TERMS]
    """

    raster: RasterArrays
    channels: np.ndarray
    table: TableArrays
    fuel: TableArrays
    limits: np.ndarray
    terms: np.ndarray


@inlined
def _interpolate_sea(raster, channels, t, lat, lon, scratch):
    """Fill the sample, linear in time and place; return the status."""
    times = raster.times
    last = times.shape[0] - 2
    if not (t >= times[0] and t <= times[last + 1]):
        return OUTSIDE_PERIOD
    step = int(scratch[_TIME_STEP])
    while step < last and t >= times[step + 1]:
        step += 1
    while step > 0 and t < times[step]:
        step -= 1
    scratch[_TIME_STEP] = step
    ft = (t - times[step]) / (times[step + 1] - times[step])
    corner, values = raster.corner, raster.values
    y = (lat - corner[0]) / corner[1]
    east = lon - corner[2] + 1e-9
    x = (east - 360.0 * math.floor(east / 360.0) - 1e-9) / corner[3]
    top, right = values.shape[1] - 2, values.shape[2] - 2
    if not (y >= -1e-6 and x >= -1e-6 and y <= top + 1 + 1e-6 and x <= right + 1 + 1e-6):
        return NO_DATA
    row, column = min(max(int(y), 0), top), min(max(int(x), 0), right)
    fy, fx = min(max(y - row, 0.0), 1.0), min(max(x - column, 0.0), 1.0)
    count = channels.shape[0]
    for k in range(count):
        scratch[channels[k]] = 0.0
    for later in range(2):
        for up in range(2):
            part = (ft if later else 1.0 - ft) * (fy if up else 1.0 - fy)
            if part == 0.0:
                continue
            for side in range(2):
                weight = part * (fx if side else 1.0 - fx)
                if weight != 0.0:
                    for k in range(count):
                        value = values[step + later, row + up, column + side, k]
                        scratch[channels[k]] += weight * value
    return OK


@inlined
def _piece_performance(world, needs, gene, t, place, course, scratch):
    """Return (slowness [s/m], fuel rate [kg/s], status) at the middle of a piece."""
    status = _interpolate_sea(world.raster, world.channels, t, place[0], place[1], scratch)
    if status != OK:
        return 0.0, 0.0, status
    index, setting, charted = world.raster.channel_index, int(gene[SETTING]), gene[CHARTED_DEPTH]
    over_ground, status, through = point_speed_from_guess(
        scratch,
        index,
        course[0],
        course[1],
        world.table,
        setting,
        charted,
        world.limits,
        needs[0],
        math.inf,
    )
    if status != OK:
        return 0.0, 0.0, status
    rate, ok = fuel_rate_at_speed(
        scratch, index, course, world.fuel, setting, charted, world.limits, needs[1], through
    )
    return 1.0 / over_ground, rate, OK if ok else NO_DATA


@inlined
def _sail_gene_leg(world, needs, gene, after, t, scratch):
    """Sail the leg of a gene to the next point; return the arrival."""
    lat1, lat2 = gene[LAT] * _RADIANS, after[LAT] * _RADIANS
    lon1, lon2 = gene[LON] * _RADIANS, after[LON] * _RADIANS
    ax, ay, az = math.cos(lat1) * math.cos(lon1), math.cos(lat1) * math.sin(lon1), math.sin(lat1)
    bx, by, bz = math.cos(lat2) * math.cos(lon2), math.cos(lat2) * math.sin(lon2), math.sin(lat2)
    cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    sine = math.sqrt(cx * cx + cy * cy + cz * cz)
    if sine < 1e-12:
        return t
    arc = math.atan2(sine, ax * bx + ay * by + az * bz)
    # (fx, fy, fz): unit tangent at the start, so that a point is cos(w) a + sin(w) f
    fx, fy, fz = (cy * az - cz * ay) / sine, (cz * ax - cx * az) / sine, (cx * ay - cy * ax) / sine
    count = int(gene[PIECES])
    if count == 0:
        count = max(MIN_PIECES, math.ceil(_MAJOR * arc / world.terms[PIECE_SPACING]))
    step = arc / count
    turn_sine, turn_cosine = math.sin(step), math.cos(step)
    s, c = math.sin(0.5 * step), math.cos(0.5 * step)
    for _ in range(count):
        px, py, pz = c * ax + s * fx, c * ay + s * fy, c * az + s * fz
        dx, dy, dz = c * fx - s * ax, c * fy - s * ay, c * fz - s * az
        s, c = s * turn_cosine + c * turn_sine, c * turn_cosine - s * turn_sine
        level = math.sqrt(px * px + py * py)
        east = (px * dy - py * dx) / level
        north = dz * level - pz * (px * dx + py * dy) / level
        w2 = 1.0 / (1.0 - _ECCENTRICITY2 * pz * pz)
        prime = _MAJOR * math.sqrt(w2)  # radius of curvature in the prime vertical
        east, north = east * prime, north * prime * (1.0 - _ECCENTRICITY2) * w2
        scale = math.sqrt(east * east + north * north)
        length = scale * step
        place = (math.atan2(pz, level) / _RADIANS, math.atan2(py, px) / _RADIANS)
        course = (east / scale, north / scale)
        if scratch[_SLOWNESS] == 0.0:  # a first slowness, at the start
            slowness, _, status = _piece_performance(world, needs, gene, t, place, course, scratch)
            scratch[_SLOWNESS] = slowness
        at = t + 0.5 * length * scratch[_SLOWNESS]
        slowness, rate, status = _piece_performance(world, needs, gene, at, place, course, scratch)
        scratch[_LENGTH] += length
        if status != OK:
            scratch[_INFEASIBLE_LENGTH] += length
            slowness = scratch[_SLOWNESS] if scratch[_SLOWNESS] > 0.0 else _DEFAULT_SLOWNESS
        else:
            scratch[_SLOWNESS] = slowness
            if gene[IS_BLOCKED] != 0.0:
                scratch[_INFEASIBLE_LENGTH] += length
        spent = length * slowness
        t += spent
        scratch[_COST_SO_FAR] += (
            spent * (rate * gene[FUEL_PRICE] + world.terms[TIME_PRICE]) * gene[PENALTY_FACTOR]
        )
        scratch[_PENALTY_TIME] += spent * (gene[PENALTY_FACTOR] - 1.0)
    return t


@inlined
def _sail_track(world, needs, count, genes, depart, score, arrive, scratch):
    """Sail one track; fill its score and the arrival at each point."""
    for k in range(SCRATCH_SIZE):
        scratch[k] = 0.0
    terms = world.terms
    t = depart
    arrive[0] = t
    for p in range(count - 1):
        wait = genes[p, WAITING_TIME]
        if wait > 0.0:
            t += wait
            scratch[_COST_SO_FAR] += wait * (terms[WAITING_PRICE] + terms[TIME_PRICE])
            scratch[_SLOWNESS] = 0.0
        fixed = genes[p, FIXED_TIME]
        if fixed == fixed:
            t += fixed
            scratch[_COST_SO_FAR] += genes[p, FIXED_COST] + fixed * terms[TIME_PRICE]
            scratch[_SLOWNESS] = 0.0
        else:
            t = _sail_gene_leg(world, needs, genes[p], genes[p + 1], t, scratch)
        arrive[p + 1] = t
    score[TIME] = t - depart + scratch[_PENALTY_TIME]
    score[COST] = scratch[_COST_SO_FAR]
    broken = 0.0
    if scratch[_INFEASIBLE_LENGTH] > 0.0:
        broken = scratch[_INFEASIBLE_LENGTH] / scratch[_LENGTH]
    if not t <= terms[LATEST_ARRIVAL]:
        broken += (t - terms[LATEST_ARRIVAL]) / max(terms[LATEST_ARRIVAL] - depart, 1.0)
    score[VIOLATION] = broken


@allocation_free
def sail_population(count, genes, depart, world, score, arrive, scratch):
    """Sail many tracks; parts of a population may be sailed in several threads at once.

    Parameters
    ----------
    count : int64[N]
        Points of each track, at least 2.
    genes : float64[N, M, COLUMNS]
        Points and the legs that start there.
    depart : float64[N]
        [s], on the clock of the raster.
    world : FitnessWorld
    score : float64[N, SCORES]
        Filled: passage time [s] and cost, both with what penalties add; violation: share of the
        length that cannot be sailed (land, limits, no data) plus the lateness as a share of the
        time there is; 0 if there is none.
    arrive : float64[N, M]
        Filled: arrival at every point [s].
    scratch : float64[N, SCRATCH]
        Room to work in.

    Notes
    -----
    Legs and their lengths as in `thalweg.kernels.leg.polyline_sailing`: great circles of the
    sphere of geographic latitudes measured on WGS 84, time by the midpoint rule. Fuel is priced
    per piece at the leg's weight. Where a piece cannot be sailed the clock runs on at the speed
    met last, so that tracks which break more compare as worse.
    """
    needs = (axes_needed(world.table), axes_needed(world.fuel))
    for i in range(count.shape[0]):
        _sail_track(world, needs, count[i], genes[i], depart[i], score[i], arrive[i], scratch[i])
