"""Sailing a population of tracks through a frozen sea: time, cost and violated limits.

A track is a row of points, and each point carries the leg that starts there (`LAT` and the other
columns). Tracks are independent of one another, so results do not depend on the number of threads.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from thalweg.kernels.codes import CHANNEL_COUNT, NO_DATA, OK
from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.great_circle import MAJOR_AXIS, great_circle, great_circle_point
from thalweg.kernels.leg.point_speed import fuel_rate_at_speed, point_speed_from_guess
from thalweg.kernels.leg.raster_sampling import RasterArrays, interpolate_raster
from thalweg.kernels.leg.table_lookup import TableArrays, axes_needed

# Columns of genes: of a point ...
LAT: Final = 0  # [deg]
LON: Final = 1  # [deg]
WAITING_TIME: Final = 2  # waiting time there [s]
IS_REQUIRED: Final = 3  # 1: must stay in every track (ends and via points); 0: free
# ... and of the leg that starts there; those of the last point are not read.
SETTING: Final = 4
IS_LOOKED_UP: Final = 5  # 0: the following are to be looked up
IS_BLOCKED: Final = 6  # 1: touches land or a no-go zone
FUEL_PRICE: Final = 7  # cost of a kilogram of fuel
CHARTED_DEPTH: Final = 8  # least charted depth [m below datum]; +inf not checked
PENALTY_FACTOR: Final = 9  # factor >= 1 on time and cost in comparisons
FIXED_TIME: Final = 10  # NaN where sailed; else the leg takes this long [s] (a canal)
FIXED_COST: Final = 11  # cost of the leg in addition to fuel (fee and fuel of a canal)
PIECES: Final = 12  # number of pieces; 0: by length
GENE_COLUMNS: Final = 13

# Terms of the cost, and the longest piece.
TIME_PRICE: Final = 0  # cost of a second
WAITING_PRICE: Final = 1  # cost of the fuel of a second of waiting
LATEST_ARRIVAL: Final = 2  # latest arrival [s]; +inf
PIECE_SPACING: Final = 3  # longest piece [m]
TERM_COUNT: Final = 4

TIME: Final = 0
COST: Final = 1
VIOLATION: Final = 2
SCORE_COUNT: Final = 3

# Work space, after the sample of the sea.
_TIME_STEP: Final = CHANNEL_COUNT  # time step of the raster found last
_SLOWNESS: Final = CHANNEL_COUNT + 1  # of the last piece [s/m]
_INFEASIBLE_LENGTH: Final = CHANNEL_COUNT + 2  # length that cannot be sailed [m]
_LENGTH: Final = CHANNEL_COUNT + 3  # [m]
_COST_SO_FAR: Final = CHANNEL_COUNT + 4  # cost
_PENALTY_TIME: Final = CHANNEL_COUNT + 5  # what penalties add to the time [s]
SCRATCH_SIZE: Final = CHANNEL_COUNT + 6

MIN_PIECES: Final = 2
_DEFAULT_SLOWNESS = 0.2  # slowness assumed where no piece has been sailed yet [s/m]


class FitnessArrays(NamedTuple):
    """The sea, the ship, its limits and the prices, for a population of tracks.

    Attributes
    ----------
    raster : RasterArrays
    table, fuel : TableArrays
        Speed through water [m/s]; fuel rate [kg/s].
    limits : float64[LIMITS]
    terms : float64[TERM_COUNT]
    """

    raster: RasterArrays
    table: TableArrays
    fuel: TableArrays
    limits: np.ndarray
    terms: np.ndarray


@inlined
def _piece_performance(world, needs, gene, t, place, course, scratch):
    """Return (slowness [s/m], fuel rate [kg/s], status) at the middle of a piece."""
    status, step = interpolate_raster(
        world.raster, t, place[0], place[1], int(scratch[_TIME_STEP]), scratch
    )
    scratch[_TIME_STEP] = step
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
    start, tangent, arc = great_circle(gene[LAT], gene[LON], after[LAT], after[LON])
    if arc == 0.0:
        return t
    count = int(gene[PIECES])
    if count == 0:
        count = max(MIN_PIECES, math.ceil(MAJOR_AXIS * arc / world.terms[PIECE_SPACING]))
    step = arc / count
    turn_sine, turn_cosine = math.sin(step), math.cos(step)
    s, c = math.sin(0.5 * step), math.cos(0.5 * step)
    for _ in range(count):
        lat, lon, east, north, scale = great_circle_point(start, tangent, s, c)
        s, c = s * turn_cosine + c * turn_sine, c * turn_cosine - s * turn_sine
        length = scale * step
        place, course = (lat, lon), (east, north)
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
    genes : float64[N, M, GENE_COLUMNS]
        Points and the legs that start there.
    depart : float64[N]
        [s], on the clock of the raster.
    world : FitnessArrays
    score : float64[N, SCORE_COUNT]
        Filled: passage time [s] and cost, both with what penalties add; violation: share of the
        length that cannot be sailed (land, limits, no data) plus the lateness as a share of the
        time there is; 0 if there is none.
    arrive : float64[N, M]
        Filled: arrival at every point [s].
    scratch : float64[N, SCRATCH_SIZE]
        Work space.

    Notes
    -----
    Legs are great circles, see `thalweg.kernels.leg.great_circle`; time is integrated by the
    midpoint rule. Fuel is priced per piece at the fuel price of the leg. A piece that cannot be
    sailed takes the speed of the piece before, so that tracks with larger violations compare as
    worse.
    """
    needs = (axes_needed(world.table), axes_needed(world.fuel))
    for i in range(count.shape[0]):
        _sail_track(world, needs, count[i], genes[i], depart[i], score[i], arrive[i], scratch[i])
