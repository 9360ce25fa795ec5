"""How tracks answer to small changes: legs sailed alone, priced by what a delay costs later."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.refinement.population import Population
from thalweg.route.refinement.population_evaluator import Evaluator
from thalweg.route.refinement.time_evaluator import approximate_leg_lengths

METRES_PER_DEGREE = 111_195.0
_PROBE_DELAY_SHARE = 0.02  # a probing delay, as a share of the leg's time


@dataclass(frozen=True)
class ScoredTracks:
    """Tracks that are polished, each for its own price of time.

    Attributes
    ----------
    evaluator : Evaluator
    population : Population
        R tracks; all legs known.
    price : float64 array (R,)
        Price of time: cost + price * time is to become small.
    scores : float64 array (R, 3)
    arrive : float64 array (R, M)
        Arrival at every point [s].
    """

    evaluator: Evaluator
    population: Population
    price: FloatArray
    scores: FloatArray
    arrive: FloatArray

    @classmethod
    def of(cls, evaluator: Evaluator, population: Population, price: FloatArray) -> ScoredTracks:
        """Sail tracks and hold them with their prices."""
        scores, arrive = evaluator.sail(population)
        return cls(evaluator, population, price, scores, arrive)

    def __len__(self) -> int:
        return len(self.population)

    @property
    def value(self) -> FloatArray:
        """What is to become small; +inf where a track is not feasible."""
        return scalarised_values(self.scores, self.price)

    @property
    def legs(self) -> tuple[IntArray, IntArray]:
        """Row and place of every leg."""
        sailed = np.arange(self.population.room) < (self.population.count - 1)[:, None]
        row, place = np.nonzero(sailed)
        return row, place

    @property
    def free(self) -> BoolArray:
        """Which points (R, M) may move: not the ends, via points and ends of canals."""
        genes = self.population.genes
        free = np.arange(self.population.room) < (self.population.count - 1)[:, None]
        free &= genes[:, :, population_sailing.IS_REQUIRED] == 0.0
        fixed = ~np.isnan(genes[:, :, population_sailing.FIXED_TIME]) & free
        fixed[:, 0] |= ~np.isnan(genes[:, 0, population_sailing.FIXED_TIME])
        free &= ~fixed
        free[:, 1:] &= ~fixed[:, :-1]
        free[:, 0] = False
        return free

    def lengths(self) -> FloatArray:
        """Rough length of every leg (R, M) [m]; 0 after the last."""
        genes = self.population.genes
        out = np.zeros(genes.shape[:2])
        out[:, :-1] = approximate_leg_lengths(genes[:, :, LAT], genes[:, :, LON])
        beyond = np.arange(self.population.room) >= (self.population.count - 1)[:, None]
        return np.where(beyond, 0.0, out)

    def chosen(self, other: Population, rows: IntArray) -> ScoredTracks:
        """Return the better of these tracks and trials, ``rows`` telling whose trial each is."""
        scores, arrive = self.evaluator.sail(other)
        told = scalarised_values(scores, self.price[rows])
        order = np.lexsort((told, rows))
        first = np.unique(rows[order], return_index=True)[1]
        best = order[first]
        better = best[told[best] < self.value[rows[best]]]
        if not len(better):
            return self
        population = self.population
        if other.room > population.room:
            population = population.with_capacity(other.room)
        room = population.room
        count, genes = population.count.copy(), population.genes.copy()
        now, passed = self.scores.copy(), np.full((len(self), room), math.nan)
        passed[:, : self.arrive.shape[1]] = self.arrive
        target = rows[better]
        count[target], now[target] = other.count[better], scores[better]
        genes[target, : other.room] = other.genes[better]
        passed[target, : other.room] = arrive[better]
        return replace(self, population=Population(count, genes), scores=now, arrive=passed)


@dataclass(frozen=True)
class DelayEffects:
    """What a second of delay does: at departure of each leg, to the goal.

    Attributes
    ----------
    time, cost : float64 array (R, M)
        Seconds at the goal, and cost, for each second later at a point.
    """

    time: FloatArray
    cost: FloatArray

    def priced(self, price: FloatArray) -> FloatArray:
        """Return cost + price * time (R, M)."""
        return self.cost + price[:, None] * self.time


def scalarised_values(scores: FloatArray, price: FloatArray) -> FloatArray:
    """Return cost + price * time; +inf where a track is not feasible."""
    told = scores[:, 1] + price * scores[:, 0]
    return np.where((scores[:, 2] == 0.0) & np.isfinite(told), told, math.inf)


def legs_as_tracks(
    lines: ScoredTracks, row: IntArray, place: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return legs as tracks of two points (L, 2, COLUMNS), and when they are begun [s]."""
    genes = lines.population.genes
    pairs = np.stack([genes[row, place], genes[row, place + 1]], axis=1)
    depart = lines.arrive[row, place] + pairs[:, 0, population_sailing.WAITING_TIME]
    pairs[:, 0, population_sailing.WAITING_TIME] = 0.0
    return pairs, depart


def fix_piece_counts(evaluator: Evaluator, pairs: FloatArray) -> None:
    """Fix the number of pieces of legs, so that their probes can be differenced."""
    spacing = evaluator.world.terms[population_sailing.PIECE_SPACING]
    length = approximate_leg_lengths(pairs[:, :, LAT], pairs[:, :, LON])[:, 0]
    pairs[:, 0, population_sailing.PIECES] = np.maximum(
        population_sailing.MIN_PIECES, np.ceil(length / spacing)
    )


def sail_legs_alone(
    evaluator: Evaluator, pairs: FloatArray, depart: FloatArray, *, blocked: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return (time, cost) of legs alone; +inf where one cannot be sailed.

    With ``blocked`` legs that touch land can be sailed too, to difference them.
    """
    evaluator = without_latest_arrival(evaluator)
    population = Population(np.full(len(pairs), 2), np.ascontiguousarray(pairs))
    evaluator.look_up_legs(population)
    if blocked:
        population.genes[:, 0, population_sailing.IS_BLOCKED] = 0.0
    scores, _ = evaluator.sail(population, depart=depart)
    good = scores[:, 2] == 0.0
    return np.where(good, scores[:, 0], math.inf), np.where(good, scores[:, 1], math.inf)


def without_latest_arrival(evaluator: Evaluator) -> Evaluator:
    """Return an evaluator that knows no latest arrival, for legs alone."""
    terms = evaluator.world.terms.copy()
    terms[population_sailing.LATEST_ARRIVAL] = math.inf
    return replace(evaluator, world=evaluator.world._replace(terms=terms))


def delay_effects(lines: ScoredTracks) -> DelayEffects:
    """Difference every leg over its departure, and add up from the goal."""
    row, place = lines.legs
    pairs, depart = legs_as_tracks(lines, row, place)
    fix_piece_counts(lines.evaluator, pairs)
    both = np.concatenate([pairs, pairs])
    time, _ = sail_legs_alone(lines.evaluator, pairs, depart, blocked=True)
    late = np.maximum(_PROBE_DELAY_SHARE * np.where(np.isfinite(time), time, 1.0), 1e-3)
    spent, cost = sail_legs_alone(
        lines.evaluator, both, np.concatenate([depart, depart + late]), blocked=True
    )
    n = len(row)
    with np.errstate(invalid="ignore"):
        growth = _clean((spent[n:] - spent[:n]) / late)
        dearer = _clean((cost[n:] - cost[:n]) / late)
    shape = lines.population.genes.shape[:2]
    slower, more = np.zeros(shape), np.zeros(shape)
    slower[row, place], more[row, place] = np.clip(growth, -0.9, 10.0), dearer
    delays = DelayEffects(np.ones(shape), np.zeros(shape))
    for p in range(shape[1] - 2, -1, -1):
        delays.time[:, p] = (1.0 + slower[:, p]) * delays.time[:, p + 1]
        delays.cost[:, p] = more[:, p] + (1.0 + slower[:, p]) * delays.cost[:, p + 1]
    return delays


def starboard_vectors_of_tracks(population: Population) -> tuple[FloatArray, FloatArray]:
    """Return (east, north) of the unit vector to starboard at every point (R, M)."""
    lat, lon = population.genes[:, :, LAT], population.genes[:, :, LON]
    last = population.count[:, None] - 1
    index = np.arange(population.room)[None, :]
    after = np.take_along_axis(lat, np.minimum(index + 1, last), 1)
    before = np.take_along_axis(lat, np.maximum(np.minimum(index, last) - 1, 0), 1)
    right = np.take_along_axis(lon, np.minimum(index + 1, last), 1)
    left = np.take_along_axis(lon, np.maximum(np.minimum(index, last) - 1, 0), 1)
    north = after - before
    east = ((right - left + 540.0) % 360.0 - 180.0) * np.cos(np.radians(lat))
    norm = np.hypot(east, north)
    norm[norm == 0.0] = 1.0
    return north / norm, -east / norm


def displaced_positions(
    genes: FloatArray, east: FloatArray, north: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return (lat, lon) of points (..., COLUMNS) displaced in their tangent plane [m]."""
    lat = genes[..., LAT] + north / METRES_PER_DEGREE
    scale = np.maximum(np.cos(np.radians(genes[..., LAT])), 1e-3)
    lon = genes[..., LON] + east / (METRES_PER_DEGREE * scale)
    return np.clip(lat, -90.0, 90.0), (lon + 180.0) % 360.0 - 180.0


def _clean(values: FloatArray) -> FloatArray:
    return np.where(np.isfinite(values), values, 0.0)
