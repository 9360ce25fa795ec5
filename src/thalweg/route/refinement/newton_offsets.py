"""Continuous refinement: waypoints slide across the track to where the passage is best."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.route.refinement.cost_evaluator import CostEvaluator
from thalweg.route.refinement.polyline import METRES_PER_DEGREE, Polyline
from thalweg.route.refinement.time_evaluator import (
    TimeEvaluator,
    TrackBatch,
    approximate_leg_lengths,
)

_DIFFERENCE_STEP = 0.02  # sideways probe, as a share of the shorter leg beside a waypoint
_DAMPING = (0.0, 0.03, 1.0)  # shares of the curvature added to it
_STEP_FACTORS = (1.0, 0.4, 0.12, 0.02)  # of the step
_ATTEMPTS = 4  # with ever more waypoints held at obstacles
# (shift of the start, shift of the end, shift of time) of the probes of a leg
_PERTURBATIONS = (
    (0, 0, 0),
    (1, 0, 0),
    (-1, 0, 0),
    (0, 1, 0),
    (0, -1, 0),
    (1, 1, 0),
    (-1, -1, 0),
    (0, 0, 1),
)


@dataclass(frozen=True)
class CostDerivatives:
    """How the cost of a line answers to sideways shifts of its waypoints.

    Attributes
    ----------
    gradient, curvature : float64 array (n,)
        First and second derivative for each waypoint [cost/m, cost/m2].
    coupling : float64 array (n - 1,)
        Mixed second derivative of neighbours.
    known : bool array (n,)
        Waypoints whose probes could all be sailed; the ends are never known.
    """

    gradient: FloatArray
    curvature: FloatArray
    coupling: FloatArray
    known: BoolArray


def optimise_lateral_offsets(
    line: Polyline,
    evaluator: TimeEvaluator | CostEvaluator,
    *,
    rounds: int = 12,
    tolerance: float = 1e-7,
) -> Polyline:
    """Return a line with its waypoints shifted sideways to lower the cost.

    Parameters
    ----------
    line : Line
        One that can be sailed.
    evaluator : Sailor
    rounds : int
        Newton steps at most.
    tolerance : float
        Relative gain of a step that ends the work.

    Notes
    -----
    Newton's method on the sideways shifts. The cost of a leg depends on the shifts of its two ends
    and on its time of departure, so the Hessian is tridiagonal but for the effect of time, which
    enters the gradient exactly (a second of delay at a waypoint is weighted by what it costs at the
    goal) and is left out of the Hessian. Steps are damped and shortened until the true cost
    falls; waypoints beside legs that would break a limit are held in that step.
    """
    best = float(evaluator.sail(line.batch())[1][0])
    if not math.isfinite(best) or len(line) < 3:
        return line
    for _ in range(rounds):
        after, cost = _newton_step(line, evaluator, best)
        gain = best - cost
        if gain <= 0.0:
            return line
        line, best = after, cost
        scale = best if evaluator.by_length else best - line.depart
        if gain < tolerance * scale:
            return line
    return line


def starboard_vectors(line: Polyline) -> tuple[FloatArray, FloatArray]:
    """Return (east, north) of the unit vector to starboard at every waypoint."""
    north = np.empty(len(line))
    east = np.empty(len(line))
    scale = np.cos(np.radians(line.lat))
    north[1:-1] = line.lat[2:] - line.lat[:-2]
    east[1:-1] = (line.lon[2:] - line.lon[:-2]) * scale[1:-1]
    north[0], east[0] = line.lat[1] - line.lat[0], (line.lon[1] - line.lon[0]) * scale[0]
    north[-1], east[-1] = line.lat[-1] - line.lat[-2], (line.lon[-1] - line.lon[-2]) * scale[-1]
    norm = np.hypot(east, north)
    norm[norm == 0.0] = 1.0
    return north / norm, -east / norm


def shifted_positions(line: Polyline, shift: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return positions (..., n) with the waypoints shifted to starboard [m]."""
    east, north = starboard_vectors(line)
    lat = line.lat + shift * north / METRES_PER_DEGREE
    lon = line.lon + shift * east / (METRES_PER_DEGREE * np.cos(np.radians(line.lat)))
    return lat, lon


def _newton_step(
    line: Polyline, evaluator: TimeEvaluator | CostEvaluator, best: float
) -> tuple[Polyline, float]:
    """Return the best of several trial lines, and its cost; the line itself if none is better."""
    slopes = _cost_derivatives(line, evaluator)
    lengths = approximate_leg_lengths(line.lat, line.lon)
    largest = np.zeros(len(line))
    largest[1:-1] = 0.5 * np.minimum(lengths[:-1], lengths[1:])
    free = slopes.known.copy()
    for _ in range(_ATTEMPTS):
        if not free.any():
            break
        steps = [_solve_newton_step(slopes, free, damping) for damping in _DAMPING]
        trials = [
            np.clip(f * s, -largest, largest) for s in steps if s is not None for f in _STEP_FACTORS
        ]
        if not trials:
            break
        lat, lon = shifted_positions(line, np.array(trials))
        arrive, cost = evaluator.sail(line.batch(lat, lon))
        pick = int(np.argmin(cost))
        if cost[pick] < best:
            return line.moved(lat[pick], lon[pick]), float(cost[pick])
        if isinstance(evaluator, CostEvaluator):
            held = _ends_of_infeasible_legs(evaluator.infeasible_legs(line.batch(lat, lon)))
        else:
            held = _points_at_infeasible_legs(evaluator, lat, lon, arrive)
        if not (held & free).any():
            break
        free &= ~held
    return line, best


def _points_at_infeasible_legs(
    evaluator: TimeEvaluator | CostEvaluator, lat: FloatArray, lon: FloatArray, arrive: FloatArray
) -> BoolArray:
    """Return the waypoints at the ends of legs that could not be sailed, in any trial."""
    blocked, _ = evaluator.look_up_legs(lat, lon)
    bad = np.isinf(arrive[:, 1:]) & np.isfinite(arrive[:, :-1])
    if blocked is not None:
        bad |= blocked
    return _ends_of_infeasible_legs(bad)


def _ends_of_infeasible_legs(bad: BoolArray) -> BoolArray:
    """Return the waypoints at the ends of legs that are bad in any trial."""
    legs = bad.any(axis=0)
    return np.append(legs, False) | np.append(False, legs)


def _cost_derivatives(line: Polyline, evaluator: TimeEvaluator | CostEvaluator) -> CostDerivatives:
    """Difference the cost of every leg over shifts of its ends and its departure."""
    count = len(line)
    arrive, _ = evaluator.sail(line.batch(), check=False)
    leave = np.maximum(arrive[0], line.leave)
    fixed = evaluator.fixed_points(line.lat, line.lon)
    lengths = approximate_leg_lengths(line.lat, line.lon)
    probe = np.zeros(count)
    probe[1:-1] = _DIFFERENCE_STEP * np.minimum(lengths[:-1], lengths[1:])
    probe[probe == 0.0] = 1e-3 * max(float(lengths.max()), 1.0)
    late = np.maximum(_DIFFERENCE_STEP * np.diff(arrive[0]), 1e-3)
    found = _perturbed_leg_costs(line, evaluator, probe, leave, late)
    waits = leave[:-1] > arrive[0, :-1] + 1e-9
    base, sp, sm, ep, em, pp, mm, later = found
    a, b = probe[:-1], probe[1:]
    with np.errstate(invalid="ignore"):
        start, end = (sp - sm) / (2 * a), (ep - em) / (2 * b)
        start2, end2 = (sp - 2 * base + sm) / (a * a), (ep - 2 * base + em) / (b * b)
        mixed = (pp + mm - sp - sm - ep - em + 2 * base) / (2 * a * b)
        growth = 1.0 + (later - base) / late
    weight = _goal_cost_weights(growth, waits, evaluator.by_length)
    gradient, curvature = np.zeros(count), np.zeros(count)
    gradient[:-1] += weight * start
    gradient[1:] += weight * end
    curvature[:-1] += weight * start2
    curvature[1:] += weight * end2
    known = np.isfinite(gradient) & np.isfinite(curvature)
    coupling = weight * mixed
    known[:-1] &= np.isfinite(coupling)
    known[1:] &= np.isfinite(coupling)
    known &= ~fixed
    return CostDerivatives(gradient, curvature, coupling, known)


def _perturbed_leg_costs(
    line: Polyline,
    evaluator: TimeEvaluator | CostEvaluator,
    probe: FloatArray,
    leave: FloatArray,
    late: FloatArray,
) -> FloatArray:
    """Return the cost of every leg (8, n - 1) under the probes; NaN where it cannot be sailed."""
    legs, count = len(line) - 1, len(_PERTURBATIONS)
    lat, lon = np.empty((count, legs, 2)), np.empty((count, legs, 2))
    depart = np.empty((count, legs))
    for k, (first, last, time) in enumerate(_PERTURBATIONS):
        a, b = shifted_positions(line, first * probe), shifted_positions(line, last * probe)
        lat[k, :, 0], lon[k, :, 0] = a[0][:-1], a[1][:-1]
        lat[k, :, 1], lon[k, :, 1] = b[0][1:], b[1][1:]
        depart[k] = leave[:-1] + time * late
    pieces = np.tile(evaluator.pieces(line.lat, line.lon), count)[:, None]
    batch = TrackBatch(
        lat.reshape(-1, 2),
        lon.reshape(-1, 2),
        np.full((count * legs, 2), -math.inf),
        np.tile(line.setting, count)[:, None],
        depart.reshape(-1),
    )
    if isinstance(evaluator, CostEvaluator):
        arrive, cost, _ = evaluator.cost_and_time(batch, pieces=pieces, check=False)
        known = np.isfinite(cost)
        spent = np.where(known, cost, math.nan).reshape(count, legs)
        took = np.where(known, arrive[:, -1] - batch.depart, math.nan).reshape(count, legs)
        waits = np.isfinite(line.leave[1:-1]) & (line.leave[1:-1] >= leave[1:-1] - 1e-9)
        return spent + took * _delay_costs(spent, took, late, waits, evaluator.per_second)
    arrive, cost = evaluator.sail(batch, pieces=pieces, check=False)
    spent = cost if evaluator.by_length else arrive[:, -1] - batch.depart
    spent = np.where(np.isfinite(cost), spent, math.nan)
    return spent.reshape(count, legs)


def _delay_costs(
    spent: FloatArray, took: FloatArray, late: FloatArray, waits: BoolArray, per_second: float
) -> FloatArray:
    """Return what a second of delay at the end of every leg costs until the goal.

    That is the worth of a second there, carried back over the legs with what the delay changes in
    their cost and time; a wait swallows it.
    """
    with np.errstate(invalid="ignore"):
        dearer = np.nan_to_num((spent[-1] - spent[0]) / late)
        growth = np.clip(np.nan_to_num(1.0 + (took[-1] - took[0]) / late, nan=1.0), 0.1, 10.0)
    value_of_time = np.full(len(late), per_second)
    for k in range(len(late) - 1, 0, -1):
        value_of_time[k - 1] = 0.0 if waits[k - 1] else dearer[k] + value_of_time[k] * growth[k]
    return value_of_time


def _goal_cost_weights(growth: FloatArray, waits: BoolArray, by_length: bool) -> FloatArray:
    """Return what a unit of cost on each leg costs at the goal."""
    weight = np.ones(len(growth))
    if by_length:
        return weight
    growth = np.clip(np.where(np.isfinite(growth), growth, 1.0), 0.1, 10.0)
    for k in range(len(growth) - 2, -1, -1):
        later = weight[k + 1] * growth[k + 1]
        weight[k] = 1e-3 if waits[k + 1] else later  # time saved before a wait is lost in it
    return weight


def _solve_newton_step(
    slopes: CostDerivatives, free: BoolArray, damping: float
) -> FloatArray | None:
    """Return the Newton step of the free waypoints; None if the matrix is not positive definite."""
    gradient = np.where(free, slopes.gradient, 0.0)
    curvature = np.where(free, slopes.curvature + damping * np.abs(slopes.curvature), 1.0)
    coupling = np.where(free[:-1] & free[1:], slopes.coupling, 0.0)
    if damping >= 1.0:  # a last resort that always leads downhill
        floor = np.abs(np.append(coupling, 0.0)) + np.abs(np.insert(coupling, 0, 0.0))
        curvature = np.maximum(np.abs(curvature), 1.1 * floor + 1e-30)
    pivot, right = curvature.tolist(), (-gradient).tolist()
    off = coupling.tolist()
    for i in range(1, len(pivot)):
        if pivot[i - 1] <= 0.0:
            return None
        ratio = off[i - 1] / pivot[i - 1]
        pivot[i] -= ratio * off[i - 1]
        right[i] -= ratio * right[i - 1]
    if pivot[-1] <= 0.0:
        return None
    step = [0.0] * len(pivot)
    step[-1] = right[-1] / pivot[-1]
    for i in range(len(pivot) - 2, -1, -1):
        step[i] = (right[i] - off[i] * step[i + 1]) / pivot[i]
    return np.where(free, step, 0.0)
