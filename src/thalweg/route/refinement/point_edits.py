"""Edits of the points of many tracks at once: points removed, long legs split, trials of edits."""

from __future__ import annotations

import numpy as np

from thalweg.core.arrays.sphere_vectors import arc_of_chord, spherical_positions
from thalweg.core.geodesy import unit_vectors
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.evaluators.population import Population, concatenated_populations
from thalweg.route.refinement.scored_tracks import (
    ScoredTracks,
    delay_effects,
    legs_as_tracks,
    sail_legs_alone,
)
from thalweg.route.refinement.trial_edits import isolated_maxima, trial_subsets


@np.errstate(invalid="ignore")  # infinite where a leg cannot be sailed
def remove_points(lines: ScoredTracks, *, allowance: float) -> ScoredTracks:
    """Return tracks without the points that improve them little.

    ``allowance`` is the share of the value that may be lost with each point.

    Parameters
    ----------
    allowance : Share of the value of a track.
    """
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
    joint, setting = np.array(pairs), after[:, 0, columns.SETTING]
    joint[:, 1], joint[:, 0, columns.IS_LOOKED_UP] = after[:, 1], 0.0
    other = np.array(joint)
    other[:, 0, columns.SETTING] = setting
    both = np.concatenate([joint, other])
    time, cost = sail_legs_alone(lines.evaluator, both, np.tile(depart, 2))
    value = (cost + np.tile(late[row, place + 1], 2) * time).reshape(2, -1)
    gain, keep_first = np.zeros(lines.free.shape), np.zeros(lines.free.shape, dtype=bool)
    slack = allowance * np.abs(lines.value[row])
    with np.errstate(invalid="ignore"):
        improvement = base - value.min(axis=0) + slack
    gain[row, place] = np.where(np.isfinite(improvement), improvement, 0.0)
    keep_first[row, place] = value[0] <= value[1]
    return _without_points(lines, isolated_maxima(gain), keep_first, allowance)


def _without_points(
    lines: ScoredTracks, gain: FloatArray, first: BoolArray, allowance: float
) -> ScoredTracks:
    """Return tracks without the points that gain, with an allowed loss for each removed."""
    trials, rows = [], []
    for chosen, index in trial_subsets(gain):
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
    remaining = ScoredTracks(lines.evaluator, lines.population, lines.price, lenient, lines.arrive)
    after = remaining.chosen(other, whose)
    same = (after.scores == lenient).all(axis=1)
    scores = np.where(same[:, None], lines.scores, after.scores)
    return ScoredTracks(lines.evaluator, after.population, lines.price, scores, after.arrive)


def _remove_in_place(population: Population, k: int, out: IntArray, first: BoolArray) -> None:
    genes, n = population.genes[k], int(population.count[k])
    for p in out:
        if not first[p]:
            genes[p - 1, columns.SETTING] = genes[p, columns.SETTING]
        genes[p - 1, columns.IS_LOOKED_UP] = 0.0
    reduced = np.setdiff1d(np.arange(n), out)
    genes[: len(reduced)] = genes[reduced]
    population.count[k] = len(reduced)


def split_long_legs(lines: ScoredTracks, *, legs: int) -> ScoredTracks:
    """Return tracks with legs longer than a share 1 / ``legs`` of the length split at their middle.

    The values stay the same; the tracks have more points to move.

    Parameters
    ----------
    legs : Least number of legs of equal length.
    """
    population = lines.population
    lengths = lines.lengths()
    longest = lengths.sum(axis=1) / legs
    cut = (lengths > longest[:, None]) & np.isnan(population.genes[:, :, columns.FIXED_TIME])
    more = int(cut.sum(axis=1).max(initial=0))
    if not more:
        return lines
    wide = population.with_capacity(max(int((population.count + cut.sum(axis=1)).max()), 2))
    count, genes = wide.count.copy(), wide.genes.copy()
    for k in np.flatnonzero(cut.any(axis=1)):
        n, places = int(count[k]), np.flatnonzero(cut[k])
        middle = _middles(population.genes[k, places], population.genes[k, places + 1])
        genes[k, : n + len(places)] = np.insert(population.genes[k, :n], places + 1, middle, axis=0)
        genes[k, places + np.arange(len(places)), columns.IS_LOOKED_UP] = 0.0
        count[k] = n + len(places)
    return ScoredTracks.of(lines.evaluator, Population(count, genes), lines.price)


def _middles(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the points in the middle of legs (n, GENE_COLUMNS), free and not looked up."""
    return points_between(a, b, np.full(len(a), 0.5))


def points_between(a: FloatArray, b: FloatArray, share: FloatArray) -> FloatArray:
    """Return points (n, GENE_COLUMNS) at shares of legs, free and not looked up.

    Parameters
    ----------
    a, b : Ends of legs, (n, GENE_COLUMNS).
    share : Share of the arc from ``a``, (n,).

    Returns
    -------
    float64 array (n, GENE_COLUMNS) : With the leg of ``a``.
    """
    u, v = unit_vectors(a[:, LAT], a[:, LON]), unit_vectors(b[:, LAT], b[:, LON])
    arc = arc_of_chord(np.linalg.norm(u - v, axis=1))
    with np.errstate(invalid="ignore", divide="ignore"):
        p = np.where(arc > 1e-9, np.sin((1.0 - share) * arc) / np.sin(arc), 1.0 - share)
        q = np.where(arc > 1e-9, np.sin(share * arc) / np.sin(arc), share)
    made = np.array(a)
    made[:, LAT], made[:, LON] = spherical_positions(p[:, None] * u + q[:, None] * v)
    for column in (
        columns.WAITING_TIME,
        columns.IS_REQUIRED,
        columns.IS_LOOKED_UP,
        columns.PIECES,
    ):
        made[:, column] = 0.0
    return made
