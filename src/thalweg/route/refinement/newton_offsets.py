"""Newton's method on lateral offsets: the points of tracks move sideways to where they cost least.

One implementation for every batch of tracks: a population (`ScoredTracks`) or a single line
(`SailedPolyline`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.route.refinement.track_geometry import shorter_adjacent_legs

DIFFERENCE_STEP = 0.02  #: sideways step of differences, as a share of the shorter adjacent leg
#: (shift of the start, shift of the end) of a leg, for the differences of its value.
PERTURBATIONS = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1))
_MIN_DIFFERENCE = 1e-3  # least sideways step of differences [m]
_ATTEMPTS = 4  # with ever more points held beside legs that cannot be sailed


@dataclass(frozen=True)
class StepSchedule:
    """Trial steps of an iteration.

    Attributes
    ----------
    damping : Shares of the curvature added to it; from 1 on the matrix is made positive definite.
    factors : Shares of the Newton step that are tried.
    """

    damping: tuple[float, ...]
    factors: tuple[float, ...]


class LateralProblem(Protocol):
    """A batch of R tracks of at most M points each, with a value that is to be minimised."""

    @property
    def step_schedule(self) -> StepSchedule:
        """The trial steps of an iteration."""

    @property
    def value(self) -> FloatArray:
        """What is minimised (R,); +inf where a track is not feasible."""

    @property
    def free(self) -> BoolArray:
        """Which points (R, M) may move."""

    @property
    def legs(self) -> tuple[IntArray, IntArray]:
        """Row and place of every leg."""

    def lengths(self) -> FloatArray:
        """Return the rough length (R, M) [m] of the leg that starts at each point, 0 if none."""

    def perturbed_leg_values(self, row: IntArray, place: IntArray, step: FloatArray) -> FloatArray:
        """Return the value of legs (7, L), with its effects until the goal, under `PERTURBATIONS`.

        ``step`` (R, M) is the shift of each point to starboard [m]. NaN where a leg cannot be
        sailed.
        """

    def best_of_offsets(self, offsets: FloatArray, rows: IntArray) -> tuple[Self, BoolArray]:
        """Return the tracks after trial offsets (T, rows, M) [m to starboard] of some rows.

        The best trial of each track replaces it where it is better. Also returned are the points
        (R, M) at the ends of legs that cannot be sailed in a trial.
        """


AnyProblem = TypeVar("AnyProblem", bound=LateralProblem)


@dataclass(frozen=True)
class LateralDerivatives:
    """Derivatives of the value of tracks by lateral offsets of their points.

    Attributes
    ----------
    gradient, curvature : float64 array (R, M)
        First and second derivative by the offset of each point [value/m, value/m2].
    coupling : Mixed second derivative of each point and the next [value/m2], (R, M).
    known : Free points whose differences could all be sailed, (R, M).
    """

    gradient: FloatArray
    curvature: FloatArray
    coupling: FloatArray
    known: BoolArray


def optimise_lateral_offsets(
    tracks: AnyProblem, *, rounds: int, tolerance: float = 1e-6
) -> AnyProblem:
    r"""Return tracks with their points moved sideways to lower their value.

    Parameters
    ----------
    tracks : A batch of tracks, such as `ScoredTracks` or `SailedPolyline`.
    rounds : Newton iterations at most.
    tolerance : Relative gain of a round from which a track takes part in the next.

    Returns
    -------
    LateralProblem : Tracks with costs that are not higher than before.

    Notes
    -----
    The value of a leg depends on the offsets :math:`x` of its two ends and on its time of
    departure, so the Hessian :math:`H` is tridiagonal but for the effect of time. That effect is
    exact in the gradient :math:`g`, since a delay is priced by what it costs until the goal, and
    left out of the Hessian. An iteration solves

    .. math:: (H + d |\operatorname{diag} H|) \, \Delta x = -g

    for several shares of damping :math:`d`, and tries several fractions of each step with the true
    value. Points at the ends of legs that cannot be sailed are held in further attempts.
    """
    moving = np.arange(len(tracks.value))
    for _ in range(rounds):
        before = tracks.value
        tracks = _newton_iteration(tracks, moving)
        moving = moving[(tracks.value < before * (1.0 - tolerance))[moving]]
        if not len(moving):
            break
    return tracks


def _newton_iteration(tracks: AnyProblem, waiting: IntArray) -> AnyProblem:
    """Return tracks after one Newton step of some, with attempts that hold ever more points."""
    derivatives = _lateral_derivatives(tracks, waiting)
    largest = 0.5 * shorter_adjacent_legs(tracks.lengths())
    free, schedule = derivatives.known, tracks.step_schedule
    for _ in range(_ATTEMPTS):
        if not free[waiting].any():
            break
        steps = [solve_newton_step(derivatives, free, damping) for damping in schedule.damping]
        offsets = np.stack(
            [np.clip(f * step, -largest, largest) for step in steps for f in schedule.factors]
        )[:, waiting]
        offsets = offsets[(offsets != 0.0).any(axis=(1, 2))]
        if not len(offsets):
            break
        before = tracks.value
        tracks, held = tracks.best_of_offsets(offsets, waiting)
        waiting = waiting[~(tracks.value < before)[waiting]]  # no gain in this attempt
        if not (held[waiting] & free[waiting]).any():
            break
        free = free & ~held
    return tracks


def _lateral_derivatives(tracks: LateralProblem, some: IntArray) -> LateralDerivatives:
    """Difference the value of every leg of some tracks over lateral offsets of its ends."""
    row, place = tracks.legs
    taken = np.isin(row, some)
    row, place = row[taken], place[taken]
    lengths = tracks.lengths()
    step = np.maximum(DIFFERENCE_STEP * shorter_adjacent_legs(lengths), _MIN_DIFFERENCE)
    base, sp, sm, ep, em, pp, mm = tracks.perturbed_leg_values(row, place, step)
    a, b = step[row, place], step[row, place + 1]
    gradient, curvature, coupling = (np.zeros(lengths.shape) for _ in range(3))
    with np.errstate(invalid="ignore"):
        gradient[row, place] += (sp - sm) / (2 * a)
        curvature[row, place] += (sp - 2 * base + sm) / (a * a)
        gradient[row, place + 1] += (ep - em) / (2 * b)
        curvature[row, place + 1] += (ep - 2 * base + em) / (b * b)
        coupling[row, place] = (pp + mm - sp - sm - ep - em + 2 * base) / (2 * a * b)
    known = tracks.free & np.isfinite(gradient) & np.isfinite(curvature)
    finite = np.isfinite(coupling)
    known &= finite
    known[:, 1:] &= finite[:, :-1]
    return LateralDerivatives(gradient, curvature, coupling, known)


def solve_newton_step(
    derivatives: LateralDerivatives, free: BoolArray, damping: float
) -> FloatArray:
    """Return the Newton steps (R, M) [m] of the free points of tracks.

    Parameters
    ----------
    free : Points that may move, (R, M); the others get a step of 0.
    damping : Share of the curvature added to it. From 1 on the diagonal is raised until the matrix
        is positive definite, so that the step always leads downhill.

    Returns
    -------
    float64 array (R, M) : 0 for tracks whose matrix is not positive definite.

    Notes
    -----
    Gaussian elimination of the tridiagonal systems (Thomas algorithm), all tracks at once.
    """
    gradient = np.where(free, derivatives.gradient, 0.0)
    raw = np.where(free, derivatives.curvature, 1.0)
    both = free.copy()
    both[:, :-1] &= free[:, 1:]
    coupling = np.where(both, derivatives.coupling, 0.0)
    curvature = raw + damping * np.abs(raw)
    if damping >= 1.0:
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
