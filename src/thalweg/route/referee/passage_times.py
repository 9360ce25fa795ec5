"""Times of passage of the pieces of a track: the two-stage Gauss method for dT/ds = 1/SOG(s, T)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray

#: ``(index of the first point, one past the last, times, speeds through water guessed or None) ->
#: (slowness [s/m], NaN where the ship cannot sail, speed through water [m/s])`` at the Gauss points
SlownessFunction = Callable[
    [int, int, FloatArray, "FloatArray | None"], tuple[FloatArray, FloatArray]
]

TIME_TOLERANCE = 1e-5  #: change of any time [s] that ends the iteration
_MAX_ITERATIONS = 14  # iterations before a stretch is split
_MIN_WINDOW = 64  # least number of pieces solved next, after one that did not converge
_MAX_ITERATIONS_SINGLE_PIECE = 60  # iterations on a single piece
# Butcher's matrix of the two-stage Gauss method (Hairer, Norsett & Wanner 1993, table II.7.3)
_GAUSS_MATRIX = np.array([[0.25, 0.25 - math.sqrt(3.0) / 6.0], [0.25 + math.sqrt(3.0) / 6.0, 0.25]])


@dataclass
class PieceTimes:
    """Times of passage of consecutive pieces, while they are solved.

    Attributes
    ----------
    step, wait : Length of each piece [m] and the wait after it [s], (p,).
    start : float64 array (p + 1,)
        Departure from the start of each piece, and at last the arrival (after the last wait) [s].
    inside : Times at the Gauss points [s], (p, 2).
    slowness : Seconds per metre at the Gauss points, (p, 2); guesses from the first bad point on.
    water : Speeds through water at the Gauss points [m/s], (p, 2).
    bad : Where the ship cannot continue, or data are missing, (p, 2).
    """

    step: FloatArray
    wait: FloatArray
    start: FloatArray
    inside: FloatArray
    slowness: FloatArray
    water: FloatArray
    bad: NDArray[np.bool_]

    @property
    def first_infeasible(self) -> int:
        """The first piece that cannot be sailed; the number of pieces if all can."""
        return _first_true(self.bad)


def solve_passage_times(
    slowness: SlownessFunction,
    *,
    step: FloatArray,
    wait: FloatArray,
    depart: float,
    guess: FloatArray,
) -> PieceTimes:
    r"""Solve the times of passage of each piece.

    Parameters
    ----------
    slowness : See `SlownessFunction`.
    step, wait : Length of each piece [m] and the wait after it [s], (p,).
    depart : Departure from the start of the first piece [s].
    guess : First guess of the slowness [s/m], finite and positive, (p, 2); also used after a bad
        point, so that all numbers stay finite.

    Notes
    -----
    Solves

    .. math:: \frac{dT}{ds} = \frac{1}{SOG(s, T)}

    by the two-stage Gauss method, of order 4 in the length of the pieces where the fields are
    smooth. All pieces are solved at once: Picard iteration, accelerated by the slope of slowness in
    time, which follows from the last two iterates at every point. Where a stretch does not converge
    (a field with jumps), the pieces before the first that does not are final, that piece is solved
    by itself, and the iteration continues after it.
    """
    count = len(step)
    passage = PieceTimes(
        step,
        wait,
        np.empty(count + 1),
        np.empty((count, 2)),
        guess.copy(),
        np.full((count, 2), math.nan),
        np.zeros((count, 2), dtype=bool),
    )
    passage.start[0] = 0.0  # seconds since departure, which round 10^7 times finer

    def slowness_at(
        first: int, last: int, time: FloatArray, water: FloatArray | None
    ) -> tuple[FloatArray, FloatArray]:
        return slowness(first, last, depart + time, water)

    waiting = [(0, count)]
    while waiting:
        first, last = waiting.pop()
        settled = _iterate_pieces(passage, slowness_at, first, last)
        failed = first + settled
        if failed < last:
            window = min(failed + 1 + max(4 * settled, _MIN_WINDOW), last)
            remaining = [(window, last), (failed + 1, window), (failed, failed + 1)]
            waiting += [(a, b) for a, b in remaining if a < b]
    passage.start += depart
    passage.inside += depart
    return passage


def _iterate_pieces(
    passage: PieceTimes, slowness_at: SlownessFunction, first: int, last: int
) -> int:
    """Iterate one stretch of pieces from its known start; return how many converged.

    A single piece always counts as settled: it is creeped up on.
    """
    part = slice(first, last)
    step, wait = passage.step[part], passage.wait[part]
    depart = passage.start[first]
    held, slope = passage.slowness[part].copy(), np.zeros((last - first, 2))
    start, inside = _integrate(depart, step, wait, held)
    seen_at: FloatArray | None = None
    before = held
    water: FloatArray | None = (
        passage.water[part] if np.isfinite(passage.water[part]).all() else None
    )
    for turn in range(_MAX_ITERATIONS_SINGLE_PIECE if last - first == 1 else _MAX_ITERATIONS):
        found, speed = slowness_at(2 * first, 2 * last, inside.reshape(-1), _flat(water))
        found, speed = found.reshape(-1, 2), speed.reshape(-1, 2)
        water = speed
        bad = ~np.isfinite(found)
        held = np.where(bad, passage.slowness[part], found)
        if seen_at is not None:
            slope = _slowness_time_derivative(held - before, inside - seen_at, slope, step)
        seen_at, before = inside, held
        if turn > 20:  # a jump inside one piece: shorter steps
            slope = np.zeros_like(slope)
            held = 0.5 * (held + passage.slowness[part])
            passage.slowness[part] = held
        start, new = _newton_update(depart, step, wait, held, slope, start)
        change = np.abs(new - inside).max(axis=1)
        inside = new
        moving = np.flatnonzero(~(change[: _first_true(bad) + 1] < TIME_TOLERANCE))
        if not len(moving):
            break
    settled = int(moving[0]) if len(moving) and last - first > 1 else last - first
    part = slice(first, first + settled)
    passage.start[first : first + settled + 1] = start[: settled + 1]
    passage.inside[part], passage.water[part] = inside[:settled], speed[:settled]
    passage.bad[part], passage.slowness[part] = bad[:settled], held[:settled]
    return settled


def _flat(values: FloatArray | None) -> FloatArray | None:
    return None if values is None or not np.isfinite(values).all() else values.reshape(-1)


def _first_true(bad: NDArray[np.bool_]) -> int:
    rows = np.flatnonzero(bad[:, 0] | bad[:, 1])
    return int(rows[0]) if rows.size else len(bad)


def _slowness_time_derivative(
    change: FloatArray, elapsed: FloatArray, old: FloatArray, step: FloatArray
) -> FloatArray:
    """Return d slowness / d time at every point, from two iterates; the old one if they agree."""
    known = np.abs(elapsed) > 1e-4
    new = np.where(known, change / np.where(known, elapsed, 1.0), old)
    largest = 0.5 / np.maximum(step[:, None], 1e-9)
    return np.clip(np.where(np.isfinite(new), new, 0.0), -largest, largest)


def _integrate(
    depart: float, step: FloatArray, wait: FloatArray, slowness: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return (times at the ends of pieces, times at the Gauss points) for given slowness."""
    elapsed = cumulative_sums(step * slowness.mean(axis=1) + wait)
    start = depart + elapsed
    return start, start[:-1, None] + step[:, None] * (slowness @ _GAUSS_MATRIX.T)


def _newton_update(
    depart: float,
    step: FloatArray,
    wait: FloatArray,
    slowness: FloatArray,
    slope: FloatArray,
    start: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return better times: one Newton step for slowness that is linear in time at each point."""
    mean = step * slowness.mean(axis=1)
    half = 0.5 * step * slope.mean(axis=1)
    residual = (start[:-1] + mean + wait - start[1:]).tolist()
    up, down = (1.0 + half).tolist(), (1.0 / (1.0 - half)).tolist()
    error = [depart - start[0]]
    for a, b, r in zip(up, down, residual):
        error.append((error[-1] * a + r) * b)
    shift = np.array(error)
    new = start + shift
    new[0] = depart
    better = slowness + slope * (0.5 * (shift[:-1] + shift[1:]))[:, None]
    return new, new[:-1, None] + step[:, None] * (better @ _GAUSS_MATRIX.T)
