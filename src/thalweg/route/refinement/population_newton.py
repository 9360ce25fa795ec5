"""Newton's method on the sideways shifts of many tracks at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.leg import population_sailing
from thalweg.kernels.leg.population_sailing import LAT, LON
from thalweg.route.refinement.finite_differences import (
    DelayEffects,
    ScoredTracks,
    delay_effects,
    displaced_positions,
    fix_piece_counts,
    legs_as_tracks,
    sail_legs_alone,
    starboard_vectors_of_tracks,
)
from thalweg.route.refinement.population import Population

_DIFFERENCE_STEP = 0.02  # sideways probe, as a share of the shorter leg beside a point
_DAMPING = (0.0, 0.05, 1.0)  # shares of the curvature added to it
_STEP_FACTORS = (1.0, 0.35, 0.1)  # of the step
_ATTEMPTS = 4  # with ever more points beside blocked legs held
# (shift of the start, shift of the end) of the probes of a leg
_PERTURBATIONS = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1))


@dataclass(frozen=True)
class ScalarisedDerivatives:
    """How the value of tracks answers to sideways shifts.

    Attributes
    ----------
    gradient, curvature, coupling : float64 array (R, M)
        Derivatives for each point, and mixed with the next.
    known : bool array (R, M)
        Free points whose probes could all be sailed.
    """

    gradient: FloatArray
    curvature: FloatArray
    coupling: FloatArray
    known: BoolArray


def optimise_lateral_offsets_of_tracks(lines: ScoredTracks, *, rounds: int = 3) -> ScoredTracks:
    """Return tracks with their points shifted sideways to lower their value.

    Notes
    -----
    The value of a leg depends on the shifts of its ends and on its departure. A delay is priced
    by what it costs at the goal, so the gradient is exact; the Hessian is tridiagonal but for the
    effect of time, which is left out of it. Steps are damped and shortened until the true value
    falls, and points beside legs that touch land are held in further attempts.
    """
    for _ in range(rounds):
        before = lines.value
        lines = _newton_step(lines)
        if not (lines.value < before * (1.0 - 1e-7)).any():
            break
    return lines


def _newton_step(lines: ScoredTracks) -> ScoredTracks:
    slopes = _value_derivatives(lines, delay_effects(lines))
    lengths = lines.lengths()
    largest = np.zeros_like(lengths)
    largest[:, 1:] = 0.5 * np.minimum(lengths[:, :-1], lengths[:, 1:])
    free = slopes.known
    east, north = starboard_vectors_of_tracks(lines.population)
    waiting = np.arange(len(lines))
    for _ in range(_ATTEMPTS):
        steps = [_solve_newton_step(slopes, free, damping) for damping in _DAMPING]
        shifts = [np.clip(f * step, -largest, largest) for step in steps for f in _STEP_FACTORS]
        trials, rows = _shifted_trials(lines, np.stack(shifts)[:, waiting], waiting, east, north)
        before = lines.value
        lines = lines.chosen(trials, rows)
        waiting = np.flatnonzero(lines.value >= before)
        held = _points_at_infeasible_legs(trials, rows, free.shape)
        if not len(waiting) or not (held[waiting] & free[waiting]).any():
            break
        free = free & ~held
    return lines


def _shifted_trials(
    lines: ScoredTracks, shift: FloatArray, rows: IntArray, east: FloatArray, north: FloatArray
) -> tuple[Population, IntArray]:
    """Return trials (T * rows) of tracks shifted (T, rows, M) to starboard, and whose they are."""
    times = len(shift)
    population = lines.population.take(np.tile(rows, times))
    moved = shift.reshape(len(population), -1)
    genes = population.genes
    lat, lon = displaced_positions(genes, moved * np.tile(east[rows], (times, 1)), 0.0 * moved)
    lat, _ = displaced_positions(genes, 0.0 * moved, moved * np.tile(north[rows], (times, 1)))
    changed = moved != 0.0
    genes[:, :, LAT] = np.where(changed, lat, genes[:, :, LAT])
    genes[:, :, LON] = np.where(changed, lon, genes[:, :, LON])
    touched = changed.copy()
    touched[:, :-1] |= changed[:, 1:]
    genes[:, :, population_sailing.IS_LOOKED_UP][touched] = 0.0
    return population, np.tile(rows, times)


def _points_at_infeasible_legs(
    trials: Population, rows: IntArray, shape: tuple[int, ...]
) -> BoolArray:
    """Return the points (R, M) at the ends of legs that touch land in any trial."""
    held = np.zeros(shape, dtype=bool)
    bad = trials.genes[:, :, population_sailing.IS_BLOCKED] != 0.0
    bad &= np.arange(trials.room) < (trials.count - 1)[:, None]
    row, place = np.nonzero(bad)
    held[rows[row], place] = True
    held[rows[row], place + 1] = True
    return held


def _value_derivatives(lines: ScoredTracks, delays: DelayEffects) -> ScalarisedDerivatives:
    """Difference the value of every leg over shifts of its ends."""
    row, place = lines.legs
    lengths = lines.lengths()
    probe = np.full(lengths.shape, 1.0)
    beside = np.minimum(lengths[:, :-1], lengths[:, 1:])
    probe[:, 1:] = np.maximum(_DIFFERENCE_STEP * beside, 1e-3)
    found = _perturbed_leg_values(lines, delays, row, place, probe)
    base, sp, sm, ep, em, pp, mm = found
    a, b = probe[row, place], probe[row, place + 1]
    gradient, curvature, coupling = (np.zeros(lengths.shape) for _ in range(3))
    with np.errstate(invalid="ignore"):
        gradient[row, place] += (sp - sm) / (2 * a)
        curvature[row, place] += (sp - 2 * base + sm) / (a * a)
        gradient[row, place + 1] += (ep - em) / (2 * b)
        curvature[row, place + 1] += (ep - 2 * base + em) / (b * b)
        coupling[row, place] = (pp + mm - sp - sm - ep - em + 2 * base) / (2 * a * b)
    known = lines.free & np.isfinite(gradient) & np.isfinite(curvature)
    finite = np.isfinite(coupling)
    known &= finite
    known[:, 1:] &= finite[:, :-1]
    return ScalarisedDerivatives(gradient, curvature, coupling, known)


def _perturbed_leg_values(
    lines: ScoredTracks, delays: DelayEffects, row: IntArray, place: IntArray, probe: FloatArray
) -> FloatArray:
    """Return the value of every leg (7, L) under the probes; NaN where it cannot be sailed."""
    pairs, depart = legs_as_tracks(lines, row, place)
    fix_piece_counts(lines.evaluator, pairs)
    east, north = starboard_vectors_of_tracks(lines.population)
    every = np.tile(pairs, (len(_PERTURBATIONS), 1, 1))
    n = len(row)
    for k, shifts in enumerate(_PERTURBATIONS):
        part = every[k * n : (k + 1) * n]
        for end, times in enumerate(shifts):
            if times:
                shift = times * probe[row, place + end]
                lat, lon = displaced_positions(
                    part[:, end],
                    shift * east[row, place + end],
                    shift * north[row, place + end],
                )
                part[:, end, LAT], part[:, end, LON] = lat, lon
                part[:, 0, population_sailing.IS_LOOKED_UP] = 0.0 if lines.evaluator.varies else 1.0
    time, cost = sail_legs_alone(
        lines.evaluator, every, np.tile(depart, len(_PERTURBATIONS)), blocked=True
    )
    late = delays.priced(lines.price)[row, place + 1]
    with np.errstate(invalid="ignore"):
        value = cost + np.tile(late, len(_PERTURBATIONS)) * time
    return np.where(np.isfinite(value), value, np.nan).reshape(len(_PERTURBATIONS), n)


def _solve_newton_step(
    slopes: ScalarisedDerivatives, free: BoolArray, damping: float
) -> FloatArray:
    """Return the Newton steps (R, M) of the free points; 0 where the matrix is not positive."""
    gradient = np.where(free, slopes.gradient, 0.0)
    raw = np.where(free, slopes.curvature, 1.0)
    both = free.copy()
    both[:, :-1] &= free[:, 1:]
    coupling = np.where(both, slopes.coupling, 0.0)
    curvature = raw + damping * np.abs(raw)
    if damping >= 1.0:  # a last resort that always leads downhill
        floor = np.abs(coupling)
        floor[:, 1:] += np.abs(coupling[:, :-1])
        curvature = np.maximum(np.abs(curvature), 1.1 * floor + 1e-300)
    pivot, right = curvature.copy(), -gradient
    good = np.ones(len(pivot), dtype=bool)
    with np.errstate(all="ignore"):
        for i in range(1, pivot.shape[1]):
            good &= pivot[:, i - 1] > 0.0
            ratio = coupling[:, i - 1] / pivot[:, i - 1]
            pivot[:, i] -= ratio * coupling[:, i - 1]
            right[:, i] -= ratio * right[:, i - 1]
        good &= pivot[:, -1] > 0.0
        step = np.zeros_like(pivot)
        step[:, -1] = right[:, -1] / pivot[:, -1]
        for i in range(pivot.shape[1] - 2, -1, -1):
            step[:, i] = (right[:, i] - coupling[:, i] * step[:, i + 1]) / pivot[:, i]
    return np.where(free & good[:, None] & np.isfinite(step), step, 0.0)
