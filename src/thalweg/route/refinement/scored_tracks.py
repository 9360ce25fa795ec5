"""A population of scored tracks that is refined, each track for its own shadow price of time.

Legs are compared alone: their own cost, and what the delay they cause costs until the goal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.geodesy import rough_lengths, wrap_longitude
from thalweg.core.pareto_fronts import non_dominated_indices
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.great_circle_sailing import MIN_PIECES
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.evaluators.population import Population, concatenated_populations
from thalweg.route.evaluators.population_evaluator import Evaluator
from thalweg.route.refinement.delay_effects import accumulated_delay_effects
from thalweg.route.refinement.newton_offsets import PERTURBATIONS, StepSchedule
from thalweg.route.refinement.track_geometry import displaced_positions, starboard_vectors
from thalweg.route.refinement.trial_edits import isolated_maxima, trial_subsets

_STEP_SCHEDULE = StepSchedule(damping=(0.0, 0.05, 1.0), factors=(1.0, 0.35, 0.1))
_DELAY_SHARE = 0.02  # delay of differences, as a share of the time of a leg


@dataclass(frozen=True)
class ScoredTracks:
    """Tracks with their scores, each minimised for its own shadow price of time.

    Attributes
    ----------
    population : R tracks; all legs known.
    price : Shadow price of time: cost + price * time is minimised, (R,).
    scores : float64 array (R, 3)
    arrive : Arrival at every point [s], (R, M).
    """

    evaluator: Evaluator
    population: Population
    price: FloatArray
    scores: FloatArray
    arrive: FloatArray

    @classmethod
    def of(cls, evaluator: Evaluator, population: Population, price: FloatArray) -> ScoredTracks:
        """Return tracks with their times, costs and prices, as evaluated."""
        scores, arrive = evaluator.sail(population)
        return cls(evaluator, population, price, scores, arrive)

    def __len__(self) -> int:
        return len(self.population)

    @property
    def value(self) -> FloatArray:
        """Cost + price * time (R,), which is minimised; +inf where a track is not feasible."""
        return scalarised_values(self.scores, self.price)

    @property
    def legs(self) -> tuple[IntArray, IntArray]:
        """Row and place of every leg."""
        sailed = np.arange(self.population.capacity) < (self.population.count - 1)[:, None]
        row, place = np.nonzero(sailed)
        return row, place

    @property
    def free(self) -> BoolArray:
        """Which points (R, M) may move: not the ends, via points and ends of canals."""
        genes = self.population.genes
        free = np.arange(self.population.capacity) < (self.population.count - 1)[:, None]
        free &= genes[:, :, columns.IS_REQUIRED] == 0.0
        fixed = ~np.isnan(genes[:, :, columns.FIXED_TIME]) & free
        fixed[:, 0] |= ~np.isnan(genes[:, 0, columns.FIXED_TIME])
        free &= ~fixed
        free[:, 1:] &= ~fixed[:, :-1]
        free[:, 0] = False
        return free

    def lengths(self) -> FloatArray:
        """Rough length of every leg (R, M) [m]; 0 after the last."""
        genes = self.population.genes
        out = np.zeros(genes.shape[:2])
        out[:, :-1] = rough_lengths(genes[:, :, LAT], genes[:, :, LON])
        beyond = np.arange(self.population.capacity) >= (self.population.count - 1)[:, None]
        return np.where(beyond, 0.0, out)

    @property
    def step_schedule(self) -> StepSchedule:
        """The trial steps of a Newton iteration."""
        return _STEP_SCHEDULE

    def perturbed_leg_values(self, row: IntArray, place: IntArray, step: FloatArray) -> FloatArray:
        """Return the value of legs (7, L) under `PERTURBATIONS`; NaN where one cannot be sailed."""
        pairs, depart = legs_as_tracks(self, row, place)
        fix_piece_counts(self.evaluator, pairs)
        genes = self.population.genes
        east, north = starboard_vectors(genes[:, :, LAT], genes[:, :, LON], self.population.count)
        every = np.tile(pairs, (len(PERTURBATIONS), 1, 1))
        n = len(row)
        for k, shifts in enumerate(PERTURBATIONS):
            part = every[k * n : (k + 1) * n]
            for end, times in enumerate(shifts):
                if times:
                    shift = times * step[row, place + end]
                    shift_points(
                        part[:, end],
                        shift * east[row, place + end],
                        shift * north[row, place + end],
                    )
                    part[:, 0, columns.IS_LOOKED_UP] = 0.0 if self.evaluator.varies else 1.0
        departures = np.tile(depart, len(PERTURBATIONS))
        time, cost = sail_legs_alone(self.evaluator, every, departures, blocked=True)
        late = delay_effects(self).priced(self.price)[row, place + 1]
        with np.errstate(invalid="ignore"):
            value = cost + np.tile(late, len(PERTURBATIONS)) * time
        return np.where(np.isfinite(value), value, np.nan).reshape(len(PERTURBATIONS), n)

    def best_of_offsets(
        self, offsets: FloatArray, rows: IntArray
    ) -> tuple[ScoredTracks, BoolArray]:
        """Return the tracks after trial offsets (T, rows, M), and the points at infeasible legs."""
        genes = self.population.genes
        east, north = starboard_vectors(genes[:, :, LAT], genes[:, :, LON], self.population.count)
        times, whose = len(offsets), np.tile(rows, len(offsets))
        trials = self.population.take(whose)
        moved = offsets.reshape(len(trials), -1)
        changed = moved != 0.0
        shift_points(
            trials.genes,
            moved * np.tile(east[rows], (times, 1)),
            moved * np.tile(north[rows], (times, 1)),
        )
        touched = changed.copy()
        touched[:, :-1] |= changed[:, 1:]
        trials.genes[:, :, columns.IS_LOOKED_UP][touched] = 0.0
        return self.chosen(trials, whose), self._ends_of_blocked_legs(trials, whose)

    def point_spacing(self) -> FloatArray:
        """Return the mean length (R, M) [m] of the two legs beside each point."""
        lengths = self.lengths()
        spacing = np.zeros_like(lengths)
        spacing[:, 1:] = 0.5 * (lengths[:, :-1] + lengths[:, 1:])
        return spacing

    def displaced(
        self, row: IntArray, place: IntArray, east: FloatArray, north: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the positions (P, D) [deg] of points (P,) displaced east and north [m]."""
        point = self.population.genes[row, place][:, None]
        lat, lon = displaced_positions(point[..., LAT], point[..., LON], east, north)
        return np.clip(lat, -90.0, 90.0), wrap_longitude(lon)

    @np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
    def values_beside(
        self, row: IntArray, place: IntArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the value of the legs beside points (P,) at trial positions (P, D), and now."""
        late = delay_effects(self).priced(self.price)
        times = lat.shape[1]
        total, now = np.zeros(lat.shape), np.zeros(len(row))
        for first, end in ((place - 1, 1), (place, 0)):
            pairs, depart = legs_as_tracks(self, row, first)
            still = sail_legs_alone(self.evaluator, pairs, depart)
            now += still[1] + late[row, first + 1] * still[0]
            every = np.repeat(pairs, times, axis=0)
            every[:, end, LAT], every[:, end, LON] = lat.ravel(), lon.ravel()
            every[:, 0, columns.IS_LOOKED_UP] = 0.0
            time, cost = sail_legs_alone(self.evaluator, every, np.repeat(depart, times))
            total += (cost + np.repeat(late[row, first + 1], times) * time).reshape(lat.shape)
        return total, now

    def with_points_moved(
        self, gain: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[ScoredTracks, BoolArray]:
        """Return the tracks with the best of some moves of points (R, M), and which moved."""
        trials, rows = [], []
        for chosen, index in trial_subsets(isolated_maxima(gain)):
            copy = self.population.take(index)
            copy.genes[:, :, LAT][chosen] = lat[index][chosen]
            copy.genes[:, :, LON][chosen] = lon[index][chosen]
            touched = chosen.copy()
            touched[:, :-1] |= chosen[:, 1:]
            copy.genes[:, :, columns.IS_LOOKED_UP][touched] = 0.0
            trials.append(copy)
            rows.append(index)
        after = self
        if trials:
            after = self.chosen(concatenated_populations(*trials), np.concatenate(rows))
        old, new = (tracks.population.genes[:, :, [LAT, LON]] for tracks in (self, after))
        return after, (old != new).any(axis=2)

    def _ends_of_blocked_legs(self, trials: Population, whose: IntArray) -> BoolArray:
        """Return the points (R, M) at the ends of legs that touch land in any trial."""
        held = np.zeros(self.population.genes.shape[:2], dtype=bool)
        bad = trials.genes[:, :, columns.IS_BLOCKED] != 0.0
        bad &= np.arange(trials.capacity) < (trials.count - 1)[:, None]
        row, place = np.nonzero(bad)
        held[whose[row], place] = True
        held[whose[row], place + 1] = True
        return held

    def chosen(self, other: Population, rows: IntArray) -> ScoredTracks:
        """Return these tracks, each replaced by its best trial where that is better.

        ``rows`` is the track that each of the trials ``other`` belongs to.
        """
        scores, arrive = self.evaluator.sail(other)
        value = scalarised_values(scores, self.price[rows])
        order = np.lexsort((value, rows))
        first = np.unique(rows[order], return_index=True)[1]
        best = order[first]
        better = best[value[best] < self.value[rows[best]]]
        if not len(better):
            return self
        population = self.population
        if other.capacity > population.capacity:
            population = population.with_capacity(other.capacity)
        capacity = population.capacity
        count, genes = population.count.copy(), population.genes.copy()
        now, passed = self.scores.copy(), np.full((len(self), capacity), math.nan)
        passed[:, : self.arrive.shape[1]] = self.arrive
        target = rows[better]
        count[target], now[target] = other.count[better], scores[better]
        genes[target, : other.capacity] = other.genes[better]
        passed[target, : other.capacity] = arrive[better]
        return replace(self, population=Population(count, genes), scores=now, arrive=passed)


@dataclass(frozen=True)
class DelayEffects:
    """Effects of a second of delay at each point of tracks, until the goal.

    Attributes
    ----------
    time, cost : Seconds at the goal, and cost, for each second later at a point, (R, M).
    """

    time: FloatArray
    cost: FloatArray

    def priced(self, price: FloatArray) -> FloatArray:
        """Return cost + price * time (R, M)."""
        return self.cost + price[:, None] * self.time


def scalarised_values(scores: FloatArray, price: FloatArray) -> FloatArray:
    """Return cost + price * time; +inf where a track is not feasible.

    Parameters
    ----------
    scores : Time [s], cost and violation, (R, 3).
    price : Shadow price of time [cost/s], (R,).

    Returns
    -------
    float64 array (R,)
    """
    value = scores[:, 1] + price * scores[:, 0]
    return np.where((scores[:, 2] == 0.0) & np.isfinite(value), value, math.inf)


def feasible_front(scores: FloatArray) -> IntArray:
    """Return the feasible tracks of scores (N, 3) that no other dominates, by ascending time."""
    feasible = np.flatnonzero(scores[:, columns.VIOLATION] == 0.0)
    return feasible[
        non_dominated_indices(scores[feasible, columns.TIME], scores[feasible, columns.COST])
    ]


def legs_as_tracks(
    lines: ScoredTracks, row: IntArray, place: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return legs as tracks of two points (L, 2, GENE_COLUMNS), and their departures [s].

    Parameters
    ----------
    row, place : Track and first point of each leg, (L,).

    Returns
    -------
    pairs : Without the wait at the first point, (L, 2, GENE_COLUMNS).
    depart : [s after the departure of the evaluator], after that wait, (L,).
    """
    genes = lines.population.genes
    pairs = np.stack([genes[row, place], genes[row, place + 1]], axis=1)
    depart = lines.arrive[row, place] + pairs[:, 0, columns.WAITING_TIME]
    pairs[:, 0, columns.WAITING_TIME] = 0.0
    return pairs, depart


def fix_piece_counts(evaluator: Evaluator, pairs: FloatArray) -> None:
    """Fix the number of pieces of legs, so that their values can be differenced."""
    spacing = evaluator.world.terms[columns.PIECE_SPACING]
    length = rough_lengths(pairs[:, :, LAT], pairs[:, :, LON])[:, 0]
    pairs[:, 0, columns.PIECES] = np.maximum(MIN_PIECES, np.ceil(length / spacing))


def sail_legs_alone(
    evaluator: Evaluator, pairs: FloatArray, depart: FloatArray, *, blocked: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Return (time, cost) of legs alone; +inf where one cannot be sailed.

    With ``blocked`` legs that touch land are sailed too, so that they can be differenced.

    Parameters
    ----------
    pairs : float64 array (L, 2, GENE_COLUMNS)
    depart : float64 array (L,) [s after the departure of the evaluator]
    blocked : Sail legs that touch land too.

    Returns
    -------
    time, cost : [s] and in the unit of the prices, (L,).
    """
    evaluator = without_latest_arrival(evaluator)
    population = Population(np.full(len(pairs), 2), np.ascontiguousarray(pairs))
    evaluator.look_up_legs(population)
    if blocked:
        population.genes[:, 0, columns.IS_BLOCKED] = 0.0
    scores, _ = evaluator.sail(population, depart=depart)
    good = scores[:, 2] == 0.0
    return np.where(good, scores[:, 0], math.inf), np.where(good, scores[:, 1], math.inf)


def without_latest_arrival(evaluator: Evaluator) -> Evaluator:
    """Return an evaluator without a latest arrival, for legs alone."""
    terms = evaluator.world.terms.copy()
    terms[columns.LATEST_ARRIVAL] = math.inf
    return replace(evaluator, world=evaluator.world._replace(terms=terms))


def delay_effects(lines: ScoredTracks) -> DelayEffects:
    """Return what delays cause: every leg differenced by its departure, summed from the goal."""
    row, place = lines.legs
    pairs, depart = legs_as_tracks(lines, row, place)
    fix_piece_counts(lines.evaluator, pairs)
    both = np.concatenate([pairs, pairs])
    time, _ = sail_legs_alone(lines.evaluator, pairs, depart, blocked=True)
    late = np.maximum(_DELAY_SHARE * np.where(np.isfinite(time), time, 1.0), 1e-3)
    spent, cost = sail_legs_alone(
        lines.evaluator, both, np.concatenate([depart, depart + late]), blocked=True
    )
    n = len(row)
    with np.errstate(invalid="ignore"):
        time_growth = _clean((spent[n:] - spent[:n]) / late)
        cost_growth = _clean((cost[n:] - cost[:n]) / late)
    shape = lines.population.genes.shape[:2]
    growth, added = np.ones((shape[0], shape[1] - 1)), np.zeros((shape[0], shape[1] - 1))
    growth[row, place], added[row, place] = 1.0 + time_growth, cost_growth
    return DelayEffects(
        accumulated_delay_effects(growth, 0.0, 1.0), accumulated_delay_effects(growth, added, 0.0)
    )


def shift_points(genes: FloatArray, east: FloatArray, north: FloatArray) -> None:
    """Displace points (..., GENE_COLUMNS) east and north [m], in place.

    Parameters
    ----------
    genes : float64 array (..., GENE_COLUMNS)
    east, north : float64 array (...) [m]
    """
    lat, lon = displaced_positions(genes[..., LAT], genes[..., LON], east, north)
    genes[..., LAT], genes[..., LON] = np.clip(lat, -90.0, 90.0), wrap_longitude(lon)


def _clean(values: FloatArray) -> FloatArray:
    return np.where(np.isfinite(values), values, 0.0)
