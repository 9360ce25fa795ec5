"""Sailing a track at one step size: pieces, conditions and times of passage."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE
from thalweg.core.types import FloatArray
from thalweg.route.canal_legs import CanalLegs
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints
from thalweg.route.referee.passage_times import PieceTimes, solve_passage_times
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    solve_sailing_state,
)


@dataclass(frozen=True)
class SailedTrack:
    """A track, divided into pieces and sailed at one step size.

    Attributes
    ----------
    charted : float64 array (p,)
        Least charted depth along every piece [m below datum]; +inf without a chart of depth.
    gauss : The two Gauss points of every piece.
    passage : When they are passed.
    """

    world: SailingEnvironment
    pieces: TrackPieces
    charted: FloatArray
    gauss: TrackPoints
    passage: PieceTimes

    @property
    def arrive(self) -> float:
        """The arrival [s]; NaN if the ship does not reach the end."""
        arrives = self.passage.first_infeasible == len(self.pieces)
        return float(self.passage.start[-1]) if arrives else math.nan

    def leg_times(self) -> tuple[FloatArray, FloatArray]:
        """Return the start and end time of each leg [s]; NaN where the ship does not arrive."""
        passage, last = self.passage, self.pieces.last_of_leg()
        first = np.concatenate([[True], last[:-1]])
        depart = passage.start[:-1][first]
        arrive = passage.start[1:][last] - self.pieces.wait[last]
        last_leg = (
            self.pieces.leg[passage.first_infeasible]
            if passage.first_infeasible < len(last)
            else len(depart)
        )
        legs = np.arange(len(depart))
        return np.where(legs <= last_leg, depart, math.nan), np.where(
            legs < last_leg, arrive, math.nan
        )


def sail_pieces(
    world: SailingEnvironment, pieces: TrackPieces, coarse: SailedTrack | None
) -> SailedTrack:
    """Sail a track in given pieces; a coarser solution gives the first guess."""
    charted = _least_charted_depths(world, pieces, coarse)
    gauss = replace(pieces.gauss_points(), charted=np.repeat(charted, 2))

    def slowness(
        first: int, last: int, time: FloatArray, guess: FloatArray | None
    ) -> tuple[FloatArray, FloatArray]:
        motion = sailing_state_along(
            world, pieces.canals, gauss.part(slice(first, last)), time, guess
        )
        return 1.0 / motion.speed_over_ground, motion.speed_through_water

    passage = solve_passage_times(
        slowness,
        step=pieces.step,
        wait=pieces.wait,
        depart=pieces.track.depart + float(pieces.track.wait[0]),
        guess=_first_guess(world, pieces, coarse),
    )
    return SailedTrack(world, pieces, charted, gauss, passage)


def sailing_state_along(
    world: SailingEnvironment,
    canals: CanalLegs,
    points: TrackPoints,
    time: FloatArray,
    guess: FloatArray | None = None,
) -> SailingState:
    """Return the motion of the ship at points of a track, some of which may be in canals.

    In canals the speed is that of the canal, and the sea is not sampled.

    Parameters
    ----------
    world : Ship, sea and chart.
    points : Positions and courses.
    time : Times [s since 1970-01-01T00:00Z], (n,).
    guess : Speeds [m/s] from which an iteration starts, (n,).

    Returns
    -------
    SailingState : Speeds, headings and conditions at the points.
    """
    fixed = canals.speed[points.leg]
    free = np.flatnonzero(np.isnan(fixed))
    if len(free) == len(points):
        return solve_sailing_state(world, points, time, guess)
    unknown = {name: np.full(len(points), math.nan) for name in world.names}
    motion = SailingState(
        unknown, np.full(len(points), math.nan), points.course.copy(), fixed, fixed.copy()
    )
    if not len(free):
        return motion
    part = solve_sailing_state(
        world, points.part(free), time[free], None if guess is None else guess[free]
    )
    for name, values in part.sampled.items():
        motion.sampled.setdefault(name, np.full(len(points), math.nan))[free] = values
    for name in ("depth", "heading", "speed_through_water", "speed_over_ground"):
        getattr(motion, name)[free] = getattr(part, name)
    return motion


def _first_guess(
    world: SailingEnvironment, pieces: TrackPieces, coarse: SailedTrack | None
) -> FloatArray:
    """Return a first guess of the slowness at the Gauss points of every piece [s/m]."""
    canal = pieces.canals.speed[pieces.leg]
    if coarse is not None:
        nearest = coarse.pieces.containing(pieces.leg, pieces.start + 0.5 * pieces.step)
        mean = coarse.passage.slowness.mean(axis=1)[nearest]
        return np.repeat(np.where(np.isnan(canal), mean, 1.0 / canal)[:, None], 2, axis=1)
    speeds = world.ship.speeds[pieces.track.setting[pieces.leg]]
    usual = np.where(np.isfinite(speeds) & (speeds > 0.0), speeds, 5.0)
    usual = np.where(np.isnan(canal), usual, canal)
    return np.repeat(1.0 / usual[:, None], 2, axis=1)


def _least_charted_depths(
    world: SailingEnvironment, pieces: TrackPieces, coarse: SailedTrack | None
) -> FloatArray:
    """Return the least charted depth along every piece [m below datum]; +inf if there is none."""
    depth = np.full(len(pieces), math.inf)
    if world.chart is None or not world.charted:
        return depth
    new = pieces.canals.number[pieces.leg] < 0
    if coarse is not None:  # pieces that were not split keep their depth
        nearest = coarse.pieces.containing(pieces.leg, pieces.start)
        kept = coarse.pieces.step[nearest] == pieces.step
        depth[kept] = coarse.charted[nearest[kept]]
        new &= ~kept
    leg, start, step = pieces.leg[new], pieces.start[new], pieces.step[new]
    low, high = pieces.points(leg, start), pieces.points(leg, start + step)
    depth[new] = world.chart.depths.along(low.lat, low.lon, high.lat, high.lon)
    return depth


def data_spacings(world: SailingEnvironment, share: float) -> list[float]:
    """Return a share of the spacing of every source of data that is sampled [m].

    Parameters
    ----------
    world : Ship, sea and chart.
    share : Fraction of the spacing of the data [-].

    Returns
    -------
    list of float : Lengths [m].
    """
    return [
        row.spacing_deg * METRES_PER_DEGREE * share
        for row in world.sea.coverage()
        if row.variable in world.names and row.spacing_deg
    ]
