"""Sailing a track in pieces that are fine where the speed changes: at jumps and near zero speed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.route.referee.leg_segments import TrackPieces
from thalweg.route.referee.sailing import SailedTrack, sail_pieces, sailing_state_along
from thalweg.route.referee.sailing_physics import SailingEnvironment

_TARGET = 1e-5  # error of the time, as a share of it, above which pieces are split
_PARTS = 8  # parts into which such a piece is split
_MAX_ROUNDS = 14
_MOST_SPLIT = 64  # pieces split in a round: errors of more are not at single places
_SLOWEST_CONVERGENCE = 0.85  # of the errors of two rounds that is believed
_JUMP_RATIO = 3.0  # of a change of slowness to those beside it, from which it counts as a jump
_INSIDE = 1e-4  # of a piece, from the end of a leg: waypoints may lie on a jump
_SMALLEST_JUMP = 1e-6  # as a share of the slowness


def sail_to_tolerance(
    world: SailingEnvironment, pieces: TrackPieces, *, adapt: bool
) -> tuple[SailedTrack, float]:
    """Sail a track in pieces and in their halves; return the latter and the error of its time [s].

    Parameters
    ----------
    adapt : Split the pieces in which most of the error lies, such as those with a jump of the speed
        or where it comes near zero, while the error is above 1e-5 of the time.

    Returns
    -------
    sailed : SailedTrack
    tolerance : float [s]
        NaN if the track cannot be sailed to its end.
    """
    coarse = sail_pieces(world, pieces, None)
    fine = sail_pieces(world, _halves(pieces), coarse)
    error, before = _PieceErrors.of(coarse, fine), math.inf
    for _ in range(_MAX_ROUNDS if adapt else 0):
        bad = error.largest(_TARGET * (fine.arrive - pieces.track.depart))
        if not 0 < bad.sum() <= _MOST_SPLIT:
            break
        pieces = pieces.split(np.where(bad, _PARTS, 1))
        coarse = sail_pieces(world, pieces, fine)
        fine = sail_pieces(world, _halves(pieces), coarse)
        before, error = error.total, _PieceErrors.of(coarse, fine)
    return fine, error.total * _remaining_share(error.total / before if before else 0.0)


def _halves(pieces: TrackPieces) -> TrackPieces:
    return pieces.split(np.full(len(pieces), 2, dtype=np.int64))


def _remaining_share(reduction: float) -> float:
    """Return the error after all further halvings as a multiple of the last, 1 or more.

    ``reduction`` is what the last round left of the error. An error that halving reduces slowly is
    larger than its last change, by the sum of the geometric series.
    """
    ratio = min(reduction, _SLOWEST_CONVERGENCE) ** (1.0 / math.log2(_PARTS))
    return max(1.0, ratio / (1.0 - ratio))


@dataclass(frozen=True)
class _PieceErrors:
    """Errors of the durations of pieces.

    Attributes
    ----------
    halving : Change of the duration of each piece when it is halved [s], (p,); with its sign.
    jumps : What jumps of the slowness between two points can add to that [s], (p,).
    """

    halving: FloatArray
    jumps: FloatArray

    @classmethod
    def of(cls, coarse: SailedTrack, fine: SailedTrack) -> _PieceErrors:
        """Compare a track in pieces with the same in their halves."""
        if not math.isfinite(coarse.arrive + fine.arrive):
            unknown = np.full(len(coarse.pieces), math.nan)
            return cls(unknown, unknown)
        halves = _durations(fine).reshape(-1, 2).sum(axis=1)
        return cls(halves - _durations(coarse), _jump_errors(fine).reshape(-1, 2).sum(axis=1))

    @property
    def total(self) -> float:
        """The error of the time of the whole track [s].

        Errors at kinks of data have random signs and add up as squares; jumps add up as they are.
        """
        halving = max(abs(float(self.halving.sum())), 2.0 * float(np.linalg.norm(self.halving)))
        return halving + float(self.jumps.sum())

    def largest(self, allowed: float) -> BoolArray:
        """Return the pieces with the largest errors: the others have half of what is allowed.

        None of them if the total is within what is allowed, or unknown.
        """
        chosen = np.zeros(len(self.jumps), dtype=bool)
        if self.total > allowed:
            error = np.abs(self.halving) + self.jumps
            order = np.argsort(error)
            chosen[order[np.cumsum(error[order]) > 0.5 * allowed]] = True
        return chosen


def _durations(sailed: SailedTrack) -> FloatArray:
    durations: FloatArray = sailed.pieces.step * sailed.passage.slowness.mean(axis=1)
    return durations


def _jump_errors(sailed: SailedTrack) -> FloatArray:
    """Return the errors that jumps of the slowness between two points can add to pieces [s], (p,).

    Points on both sides of a jump see it, but not where it is between them. The points are those of
    the pieces, and one just inside each end of every leg.
    """
    pieces, gauss = sailed.pieces, sailed.gauss
    last = pieces.last_of_leg()
    ends = np.concatenate([np.flatnonzero(np.append(True, last[:-1])), np.flatnonzero(last)])
    share = np.where(np.arange(len(ends)) < len(ends) // 2, _INSIDE, 1.0 - _INSIDE)
    points = pieces.points(pieces.leg[ends], pieces.start[ends] + share * pieces.step[ends])
    points = replace(points, charted=sailed.charted[ends])
    begin, end = sailed.passage.start[:-1][ends], sailed.passage.start[1:][ends]
    time = begin + share * (end - pieces.wait[ends] - begin)
    speed = sailing_state_along(sailed.world, pieces.canals, points, time).speed_over_ground
    piece = np.append(np.repeat(np.arange(len(pieces)), 2), ends)
    along, leg = np.append(gauss.along, points.along), np.append(gauss.leg, points.leg)
    slowness = np.append(sailed.passage.slowness.reshape(-1), 1.0 / speed)
    order = np.lexsort((along, leg))
    along, leg, slowness, piece = along[order], leg[order], slowness[order], piece[order]
    gap = np.where(np.diff(leg) == 0, np.diff(along), 0.0)
    change = np.where((gap > 0.0) & np.isfinite(np.diff(slowness)), np.abs(np.diff(slowness)), 0.0)
    beside = np.maximum(np.append(0.0, change[:-1]), np.append(change[1:], 0.0))
    at = np.flatnonzero((change > _JUMP_RATIO * beside) & (change > _SMALLEST_JUMP * slowness[:-1]))
    error = np.zeros(len(pieces))
    half = 0.25 * change[at] * gap[at]  # a quarter to the pieces of both points
    np.add.at(error, piece[at], half)
    np.add.at(error, piece[at + 1], half)
    return error
