"""Sailing a population of tracks through a frozen sea: time, cost and violated limits.

A track is a row of points, and each point carries the leg that starts there (`LAT` and the other
columns). Tracks are independent of one another, so results do not depend on the number of threads.
"""

from typing import Final, NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, inlined
from thalweg.kernels.leg.great_circle_sailing import (
    COST_SO_FAR,
    INFEASIBLE_LENGTH,
    LENGTH,
    PENALTY_TIME,
    SCRATCH_SIZE,
    SLOWNESS,
    GreatCircleLeg,
    LegPrice,
    sail_great_circle_leg,
)
from thalweg.kernels.leg.raster_sampling import RasterArrays
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


class TrackGenes(NamedTuple):
    """Genes of one track, or of many.

    Attributes
    ----------
    count : int or int64[...]
        Points of each track.
    genes : float64[..., M, GENE_COLUMNS]
        Points and the legs that start there.
    """

    count: np.ndarray
    genes: np.ndarray


class FitnessArrays(NamedTuple):
    """The sea, the ship, its limits and the prices, for a population of tracks.

    Attributes
    ----------
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
def _sail_gene_leg(world, needs, gene, after, t, scratch):
    """Sail the leg of a gene to the next point; return the arrival."""
    leg = GreatCircleLeg(
        (gene[LAT], gene[LON]),
        (after[LAT], after[LON]),
        int(gene[SETTING]),
        int(gene[PIECES]),
        world.terms[PIECE_SPACING],
        gene[CHARTED_DEPTH],
        gene[IS_BLOCKED] != 0.0,
    )
    price = LegPrice(gene[FUEL_PRICE], world.terms[TIME_PRICE], gene[PENALTY_FACTOR])
    t, _ = sail_great_circle_leg(world, world.fuel, needs, leg, price, t, scratch)
    return t


@inlined
def _sail_track(world, needs, track, leave, depart, score, arrive, scratch):
    """Sail one track (count, genes); fill its score and the arrival at each point."""
    count, genes = track
    for k in range(SCRATCH_SIZE):
        scratch[k] = 0.0
    terms = world.terms
    t = depart
    arrive[0] = t
    for p in range(count - 1):
        wait = max(genes[p, WAITING_TIME], leave[p] - t)
        if wait > 0.0:
            t += wait
            scratch[COST_SO_FAR] += wait * (terms[WAITING_PRICE] + terms[TIME_PRICE])
            scratch[SLOWNESS] = 0.0
        fixed = genes[p, FIXED_TIME]
        if fixed == fixed:
            t += fixed
            scratch[COST_SO_FAR] += genes[p, FIXED_COST] + fixed * terms[TIME_PRICE]
            scratch[SLOWNESS] = 0.0
        else:
            t = _sail_gene_leg(world, needs, genes[p], genes[p + 1], t, scratch)
        arrive[p + 1] = t
    score[TIME] = t - depart + scratch[PENALTY_TIME]
    score[COST] = scratch[COST_SO_FAR]
    broken = 0.0
    if scratch[INFEASIBLE_LENGTH] > 0.0:
        broken = scratch[INFEASIBLE_LENGTH] / scratch[LENGTH]
    if not t <= terms[LATEST_ARRIVAL]:
        broken += (t - terms[LATEST_ARRIVAL]) / max(terms[LATEST_ARRIVAL] - depart, 1.0)
    score[VIOLATION] = broken


@allocation_free
def sail_population(tracks, leave, depart, world, score, arrive, scratch):
    """Sail many tracks; parts of a population may be sailed in several threads at once.

    Parameters
    ----------
    tracks : TrackGenes
        N tracks of at least 2 points.
    leave : float64[N, M]
        The ship leaves a point no earlier than this [s]; -inf where only the waiting time of the
        point counts.
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
    Legs are sailed by `sail_great_circle_leg`. Fuel is priced per piece at the fuel price of the
    leg. A piece that cannot be sailed takes the speed of the piece before, so that tracks with
    larger violations compare as worse.
    """
    needs = (axes_needed(world.table), axes_needed(world.fuel))
    for i in range(tracks.count.shape[0]):
        track = TrackGenes(tracks.count[i], tracks.genes[i])
        _sail_track(world, needs, track, leave[i], depart[i], score[i], arrive[i], scratch[i])
