"""Edits of many tracks at once: other speeds, points moved alone, left out or put between."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.geodesy import unit_vectors, wrap_longitude
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.evaluators.population import Population, concatenated_populations
from thalweg.route.refinement.scored_tracks import (
    DelayEffects,
    ScoredTracks,
    delay_effects,
    fix_piece_counts,
    legs_as_tracks,
    sail_legs_alone,
)
from thalweg.route.refinement.track_geometry import displaced_positions

_DIRECTIONS = 8
_STEP_FRACTIONS = (
    1.0,
    0.3,
)  # of the edits that promise something, the most promising first; then one


def choose_speeds_of_tracks(lines: ScoredTracks, *, rounds: int = 3) -> ScoredTracks:
    """Return tracks with the setting of every leg chosen anew, a delay being priced."""
    for _ in range(rounds):
        before = lines.value
        row, place = lines.legs
        value = leg_values_by_setting(lines, delay_effects(lines), row, place)
        now = lines.population.genes[row, place, population_sailing.SETTING].astype(np.int64)
        best = np.argmin(value, axis=1)
        gain = np.full(lines.population.genes.shape[:2], 0.0)
        with np.errstate(invalid="ignore"):
            better = value[np.arange(len(row)), now] - value[np.arange(len(row)), best]
        gain[row, place] = np.where(np.isfinite(better), better, 0.0)
        wanted = np.zeros(gain.shape)
        wanted[row, place] = best
        trials, rows = [], []
        for chosen, index in _trial_subsets(gain):
            copy = lines.population.take(index)
            setting = copy.genes[:, :, population_sailing.SETTING]
            setting[chosen] = wanted[index][chosen]
            trials.append(copy)
            rows.append(index)
        if not trials:
            break
        lines = lines.chosen(concatenated_populations(*trials), np.concatenate(rows))
        if not (lines.value < before * (1.0 - 1e-7)).any():
            break
    return lines


@np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
def leg_values_by_setting(
    lines: ScoredTracks, delays: DelayEffects, row: IntArray, place: IntArray
) -> FloatArray:
    """Return the value (L, settings) of every leg at every setting; +inf where it cannot sail."""
    time, cost = leg_times_and_costs_by_setting(lines, row, place)
    late = delays.priced(lines.price)[row, place + 1]
    return np.where(np.isfinite(time), cost + late[:, None] * time, math.inf)


def leg_times_and_costs_by_setting(
    lines: ScoredTracks, row: IntArray, place: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return (time, cost) (L, settings) of every leg at every setting."""
    settings = lines.evaluator.settings
    pairs, depart = legs_as_tracks(lines, row, place)
    fix_piece_counts(lines.evaluator, pairs)
    every = np.repeat(pairs, settings, axis=0)
    every[:, 0, population_sailing.SETTING] = np.tile(np.arange(settings), len(row))
    time, cost = sail_legs_alone(lines.evaluator, every, np.repeat(depart, settings), blocked=True)
    return time.reshape(-1, settings), cost.reshape(-1, settings)


def compass_search_of_tracks(lines: ScoredTracks, *, radius: float) -> ScoredTracks:
    """Return tracks whose points were tried in eight directions, alone.

    ``radius`` is a share of the mean length of the legs beside. This finds its way along coasts
    and limits, where `bend` only knows that it cannot go on.
    """
    row, place = np.nonzero(lines.free)
    if not len(row):
        return lines
    lengths = lines.lengths()
    reach = radius * 0.5 * (lengths[row, place - 1] + lengths[row, place])
    angle = 2.0 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    point = lines.population.genes[row, place][:, None, :]
    lat, lon = displaced_positions(
        point[..., LAT],
        point[..., LON],
        reach[:, None] * np.sin(angle),
        reach[:, None] * np.cos(angle),
    )
    lat, lon = np.clip(lat, -90.0, 90.0), wrap_longitude(lon)
    value, base = _moved_values(lines, row, place, lat, lon)
    best = np.argmin(value, axis=1)
    every = np.arange(len(row))
    gain = np.zeros(lengths.shape)
    gain[row, place] = np.where(np.isfinite(base), base, 0.0) - value[every, best]
    gain[~np.isfinite(gain)] = 0.0
    target = np.zeros((*lengths.shape, 2))
    target[row, place] = np.stack([lat[every, best], lon[every, best]], axis=1)
    trials, rows = [], []
    for chosen, index in _trial_subsets(_isolated_maxima(gain)):
        copy = lines.population.take(index)
        copy.genes[:, :, LAT][chosen] = target[index, :, 0][chosen]
        copy.genes[:, :, LON][chosen] = target[index, :, 1][chosen]
        touched = chosen.copy()
        touched[:, :-1] |= chosen[:, 1:]
        copy.genes[:, :, population_sailing.IS_LOOKED_UP][touched] = 0.0
        trials.append(copy)
        rows.append(index)
    return (
        lines.chosen(concatenated_populations(*trials), np.concatenate(rows)) if trials else lines
    )


@np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
def _moved_values(
    lines: ScoredTracks, row: IntArray, place: IntArray, lat: FloatArray, lon: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the value of the two legs at each point moved to (P, D) places, and unmoved (P,)."""
    late = delay_effects(lines).priced(lines.price)
    times = lat.shape[1]
    total, base = np.zeros(lat.shape), np.zeros(len(row))
    for first, end in ((place - 1, 1), (place, 0)):
        pairs, depart = legs_as_tracks(lines, row, first)
        still = sail_legs_alone(lines.evaluator, pairs, depart)
        base += still[1] + late[row, first + 1] * still[0]
        every = np.repeat(pairs, times, axis=0)
        every[:, end, LAT], every[:, end, LON] = lat.ravel(), lon.ravel()
        every[:, 0, population_sailing.IS_LOOKED_UP] = 0.0
        time, cost = sail_legs_alone(lines.evaluator, every, np.repeat(depart, times))
        value = cost + np.repeat(late[row, first + 1], times) * time
        total += value.reshape(lat.shape)
    return total, base


@np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
def remove_points(lines: ScoredTracks, *, allowance: float) -> ScoredTracks:
    """Return tracks without points that bring less than a share of the value each."""
    row, place = np.nonzero(lines.free)
    if not len(row):
        return lines
    late = delay_effects(lines).priced(lines.price)
    pairs, depart = legs_as_tracks(lines, row, place - 1)
    after, later = legs_as_tracks(lines, row, place)
    base = np.zeros(len(row))
    for legs, start, q in ((pairs, depart, place - 1), (after, later, place)):
        time, cost = sail_legs_alone(lines.evaluator, legs, start)
        base += cost + late[row, q + 1] * time
    joint, setting = np.array(pairs), after[:, 0, population_sailing.SETTING]
    joint[:, 1], joint[:, 0, population_sailing.IS_LOOKED_UP] = after[:, 1], 0.0
    other = np.array(joint)
    other[:, 0, population_sailing.SETTING] = setting
    both = np.concatenate([joint, other])
    time, cost = sail_legs_alone(lines.evaluator, both, np.tile(depart, 2))
    value = (cost + np.tile(late[row, place + 1], 2) * time).reshape(2, -1)
    gain, keep_first = np.zeros(lines.free.shape), np.zeros(lines.free.shape, dtype=bool)
    slack = allowance * np.abs(lines.value[row])
    with np.errstate(invalid="ignore"):
        bring = base - value.min(axis=0) + slack
    gain[row, place] = np.where(np.isfinite(bring), bring, 0.0)
    keep_first[row, place] = value[0] <= value[1]
    return _without_points(lines, _isolated_maxima(gain), keep_first, allowance)


def _without_points(
    lines: ScoredTracks, gain: FloatArray, first: BoolArray, allowance: float
) -> ScoredTracks:
    """Return tracks without the points that gain, each allowed to lose a little by it."""
    trials, rows = [], []
    for chosen, index in _trial_subsets(gain):
        copy = lines.population.take(index)
        for k, out in enumerate(chosen):
            _remove_in_place(copy, k, np.flatnonzero(out), first[index[k]])
        trials.append(copy)
        rows.append(index)
    if not trials:
        return lines
    other, whose = concatenated_populations(*trials), np.concatenate(rows)
    fewer = lines.population.count[whose] - other.count
    lenient = lines.scores.copy()
    most = np.zeros(len(lines))
    np.maximum.at(most, whose, fewer)
    lenient[:, 1] += allowance * most * np.where(np.isfinite(lines.value), np.abs(lines.value), 0.0)
    kept = ScoredTracks(lines.evaluator, lines.population, lines.price, lenient, lines.arrive)
    after = kept.chosen(other, whose)
    same = (after.scores == lenient).all(axis=1)
    scores = np.where(same[:, None], lines.scores, after.scores)
    return ScoredTracks(lines.evaluator, after.population, lines.price, scores, after.arrive)


def _remove_in_place(population: Population, k: int, out: IntArray, first: BoolArray) -> None:
    genes, n = population.genes[k], int(population.count[k])
    for p in out:
        if not first[p]:
            genes[p - 1, population_sailing.SETTING] = genes[p, population_sailing.SETTING]
        genes[p - 1, population_sailing.IS_LOOKED_UP] = 0.0
    kept = np.setdiff1d(np.arange(n), out)
    genes[: len(kept)] = genes[kept]
    population.count[k] = len(kept)


def split_long_legs(lines: ScoredTracks, *, legs: int) -> ScoredTracks:
    """Return tracks with legs above a share 1 / ``legs`` of the length cut in the middle.

    The tracks are not better for it, but can be bent more.
    """
    population = lines.population
    lengths = lines.lengths()
    longest = lengths.sum(axis=1) / legs
    cut = (lengths > longest[:, None]) & np.isnan(
        population.genes[:, :, population_sailing.FIXED_TIME]
    )
    more = int(cut.sum(axis=1).max(initial=0))
    if not more:
        return lines
    wide = population.with_capacity(max(int((population.count + cut.sum(axis=1)).max()), 2))
    count, genes = wide.count.copy(), wide.genes.copy()
    for k in np.flatnonzero(cut.any(axis=1)):
        n, places = int(count[k]), np.flatnonzero(cut[k])
        middle = _middles(population.genes[k, places], population.genes[k, places + 1])
        genes[k, : n + len(places)] = np.insert(population.genes[k, :n], places + 1, middle, axis=0)
        genes[k, places + np.arange(len(places)), population_sailing.IS_LOOKED_UP] = 0.0
        count[k] = n + len(places)
    return ScoredTracks.of(lines.evaluator, Population(count, genes), lines.price)


def _middles(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the points in the middle of legs (n, COLUMNS), free and new."""
    return points_between(a, b, np.full(len(a), 0.5))


def points_between(a: FloatArray, b: FloatArray, share: FloatArray) -> FloatArray:
    """Return points (n, COLUMNS) at shares of the arcs of legs, free and new."""
    u, v = unit_vectors(a[:, LAT], a[:, LON]), unit_vectors(b[:, LAT], b[:, LON])
    arc = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(u - v, axis=1), 1.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        p = np.where(arc > 1e-9, np.sin((1.0 - share) * arc) / np.sin(arc), 1.0 - share)
        q = np.where(arc > 1e-9, np.sin(share * arc) / np.sin(arc), share)
    x, y, z = (p[:, None] * u + q[:, None] * v).T
    made = np.array(a)
    made[:, LAT], made[:, LON] = (
        np.degrees(np.arctan2(z, np.hypot(x, y))),
        np.degrees(np.arctan2(y, x)),
    )
    for column in (
        population_sailing.WAITING_TIME,
        population_sailing.IS_REQUIRED,
        population_sailing.IS_LOOKED_UP,
        population_sailing.PIECES,
    ):
        made[:, column] = 0.0
    return made


def _isolated_maxima(gain: FloatArray) -> FloatArray:
    """Return the gains with only those left that no neighbour exceeds; two never are neighbours."""
    left, right = np.zeros_like(gain), np.zeros_like(gain)
    left[:, 1:], right[:, :-1] = gain[:, :-1], gain[:, 1:]
    return np.where((gain > 0.0) & (gain > left) & (gain >= right), gain, 0.0)


def _trial_subsets(gain: FloatArray) -> list[tuple[BoolArray, IntArray]]:
    """Return trials: which edits (rows, M), and the rows; all, the best part, the best one."""
    promising = gain > 0.0
    rows = np.flatnonzero(promising.any(axis=1))
    if not len(rows):
        return []
    order = np.argsort(np.argsort(-gain[rows], axis=1, kind="stable"), axis=1)
    number = promising[rows].sum(axis=1)
    out = []
    for share in _STEP_FRACTIONS:
        out.append((order < np.maximum(1, np.ceil(share * number))[:, None], rows))
    out.append((order < 1, rows))
    return [(chosen & promising[rows], rows) for chosen, rows in out]
