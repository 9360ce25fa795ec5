"""A quick look at other waits of a track, so that the referee evaluates few of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.route import Track
from thalweg.route.evaluators.population import Genome, Population
from thalweg.route.evaluators.population_evaluator import Evaluator

#: Share of the length that tables of a front may close where the referee does not.
_MOST_BROKEN: Final = 0.04


class ScreenedWaits(NamedTuple):
    """What the tables of a front say of K waits of a track of n waypoints.

    Attributes
    ----------
    may_keep : Whether the tables close at most 4 % of the length then, (K,).
    arrive : Arrival at every waypoint [s since 1970-01-01T00:00Z], (K, n).
    cost : In the unit of the objective, (K,).
    """

    may_keep: BoolArray
    arrive: FloatArray
    cost: FloatArray


@dataclass(frozen=True)
class WaitScreen:
    """Tells by the tables of a front which waits of a track may keep the limits.

    Attributes
    ----------
    evaluator : Of tracks near the routes of the front.
    """

    evaluator: Evaluator

    def screened(self, track: Track, waits: FloatArray) -> ScreenedWaits:
        """Return what becomes of a track with other waits at its waypoints [s], (K, n)."""
        evaluator = self.evaluator
        one = evaluator.population([Genome.from_track(track, settings=evaluator.settings)])
        evaluator.look_up_legs(one)
        tracks = Population(np.repeat(one.count, len(waits)), np.repeat(one.genes, len(waits), 0))
        tracks.genes[:, :, columns.WAITING_TIME] = waits
        depart = np.full(len(waits), track.depart - evaluator.depart)
        score, arrive = evaluator.sail(tracks, depart=depart)
        may_keep = score[:, columns.VIOLATION] <= _MOST_BROKEN
        return ScreenedWaits(may_keep, arrive + evaluator.depart, score[:, columns.COST])

    def may_keep(self, track: Track, waits: FloatArray) -> BoolArray:
        """Return which waits of a track at its waypoints [s], (K, n), may keep the limits (K,)."""
        return self.screened(track, waits).may_keep
