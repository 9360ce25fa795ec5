"""A single line as a batch of one track, for Newton's method and compass search."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, rough_lengths
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.polyline import Polyline, PolylineEvaluator
from thalweg.route.evaluators.time_evaluator import TrackBatch
from thalweg.route.refinement.compass_search import CompassSchedule, compass_search
from thalweg.route.refinement.delay_effects import accumulated_delay_effects
from thalweg.route.refinement.newton_offsets import (
    DIFFERENCE_STEP,
    PERTURBATIONS,
    StepSchedule,
    optimise_lateral_offsets,
)
from thalweg.route.refinement.track_geometry import (
    displaced_positions,
    shorter_adjacent_legs,
    starboard_vectors,
)

_STEP_SCHEDULE = StepSchedule(damping=(0.0, 0.03, 1.0), factors=(1.0, 0.4, 0.12, 0.02))
_COMPASS_SCHEDULE = CompassSchedule(
    shares=(0.3,),
    rounds=30,
    growth=1.3,
    shrinkage=0.5,
    turn=math.pi * (3.0 - math.sqrt(5.0)),  # the golden angle
    least_gain=1e-10,
    groups=2,
)
_ABSORBED_DELAY = 1e-3  # share of the time saved before a wait that counts


def optimise_line_offsets(
    line: Polyline,
    evaluator: PolylineEvaluator,
    *,
    rounds: int = 12,
) -> Polyline:
    """Return a line with its waypoints moved sideways to lower its cost.

    Parameters
    ----------
    line : One that can be sailed; any other is returned unchanged.
    rounds : Newton iterations at most.

    Returns
    -------
    Polyline : With a cost that is not higher; see `optimise_lateral_offsets`.
    """
    tracks = SailedPolyline.of(line, evaluator)
    if not np.isfinite(tracks.value).all() or len(line) < 3:
        return line
    return optimise_lateral_offsets(tracks, rounds=rounds, tolerance=1e-7).line


def search_line_positions(
    line: Polyline, evaluator: PolylineEvaluator, *, smallest: float = 1.0
) -> Polyline:
    """Return a line with waypoints moved by `compass_search` where that lowers the cost.

    Parameters
    ----------
    line : One that can be sailed; any other is returned unchanged.
    smallest : The search ends when all steps are shorter than this [m].

    Returns
    -------
    Polyline : With a cost that is not higher.
    """
    tracks = SailedPolyline.of(line, evaluator)
    if not np.isfinite(tracks.value).all() or len(line) < 3:
        return line
    return compass_search(tracks, replace(_COMPASS_SCHEDULE, smallest=max(smallest, 1e-9))).line


@dataclass(frozen=True)
class SailedPolyline:
    """A line with its cost: a batch of one track (`LateralProblem`, R = 1, M = n).

    Attributes
    ----------
    cost : As the evaluator compares; +inf where the line cannot be sailed.
    arrive : Arrival at every point [s after the origin], (n,).
    """

    line: Polyline
    evaluator: PolylineEvaluator
    cost: float
    arrive: FloatArray

    @classmethod
    def of(cls, line: Polyline, evaluator: PolylineEvaluator) -> SailedPolyline:
        """Return a line with its cost and times, as evaluated."""
        arrive, cost = evaluator.sail(line.batch())
        return cls(line, evaluator, float(cost[0]), arrive[0])

    @property
    def step_schedule(self) -> StepSchedule:
        """The trial steps of a Newton iteration."""
        return _STEP_SCHEDULE

    @property
    def value(self) -> FloatArray:
        """The cost from departure (1,): seconds, metres or the unit of the prices."""
        start = 0.0 if self.evaluator.by_length else self.line.depart
        return np.array([self.cost - start])

    @property
    def free(self) -> BoolArray:
        """Which points (1, n) may move: not the ends, nor those of canals."""
        return ~self.evaluator.fixed_points(self.line.lat, self.line.lon)[None]

    @property
    def legs(self) -> tuple[IntArray, IntArray]:
        """Row (all 0) and place of every leg."""
        place = np.arange(len(self.line) - 1)
        return np.zeros_like(place), place

    def lengths(self) -> FloatArray:
        """Return the rough length (1, n) [m] of the leg that starts at each point, 0 at the end."""
        return np.append(rough_lengths(self.line.lat, self.line.lon), 0.0)[None]

    def perturbed_leg_values(self, row: IntArray, place: IntArray, step: FloatArray) -> FloatArray:
        """Return the value of every leg (7, n - 1) under `PERTURBATIONS`; NaN where not sailed."""
        line, evaluator, arrive = self.line, self.evaluator, self.arrive
        leave = np.maximum(arrive, line.leave)
        late = np.maximum(DIFFERENCE_STEP * np.diff(arrive), 1e-3)
        spent, durations = self._perturbed_legs(step[0], leave, late)
        with np.errstate(invalid="ignore"):
            # a leg that cannot be sailed keeps its own NaN; it passes delays on unchanged
            growth = np.nan_to_num(1.0 + (durations[-1] - durations[0]) / late, nan=1.0)
        waits = (leave > arrive + 1e-9)[None]
        if isinstance(evaluator, CostEvaluator):
            with np.errstate(invalid="ignore"):
                # likewise: ``spent`` of that leg stays NaN
                dearer = np.nan_to_num((spent[-1] - spent[0]) / late)
            delays = accumulated_delay_effects(
                growth[None], dearer[None], evaluator.per_second, absorbed=waits
            )
            return (spent + durations * delays[0, 1:])[:-1]
        if evaluator.by_length:
            return spent[:-1]
        delays = accumulated_delay_effects(
            growth[None], 0.0, 1.0, absorbed=waits, remaining=_ABSORBED_DELAY
        )
        return (durations * delays[0, 1:])[:-1]

    def _perturbed_legs(
        self, step: FloatArray, leave: FloatArray, late: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return (cost, time) of every leg (8, n - 1) under `PERTURBATIONS`, and then delayed."""
        line, legs, count = self.line, len(self.line) - 1, len(PERTURBATIONS) + 1
        lat, lon = np.empty((count, legs, 2)), np.empty((count, legs, 2))
        shifted = {times: self._shifted(times * step) for times in (-1, 0, 1)}
        for k, ends in enumerate((*PERTURBATIONS, (0, 0))):
            for end, times in enumerate(ends):
                lat[k, :, end] = shifted[times][0][end : legs + end]
                lon[k, :, end] = shifted[times][1][end : legs + end]
        depart = np.tile(leave[:-1], (count, 1))
        depart[-1] += late
        pieces = np.tile(self.evaluator.pieces(line.lat, line.lon), count)[:, None]
        batch = TrackBatch(
            lat.reshape(-1, 2),
            lon.reshape(-1, 2),
            np.full((count * legs, 2), -math.inf),
            np.tile(line.setting, count)[:, None],
            depart.reshape(-1),
        )
        if isinstance(self.evaluator, CostEvaluator):
            arrive, cost, _ = self.evaluator.cost_and_time(batch, pieces=pieces, check=False)
        else:
            arrive, cost = self.evaluator.sail(batch, pieces=pieces, check=False)
        known = np.isfinite(cost)
        spent = np.where(known, cost, math.nan).reshape(count, legs)
        durations = np.where(known, arrive[:, -1] - batch.depart, math.nan).reshape(count, legs)
        return spent, durations

    def best_of_offsets(
        self, offsets: FloatArray, rows: IntArray
    ) -> tuple[SailedPolyline, BoolArray]:
        """Return the line after trial offsets (T, 1, n), and the points at infeasible legs."""
        lat, lon = self._shifted(offsets[:, 0])
        batch = self.line.batch(lat, lon)
        arrive, cost = self.evaluator.sail(batch)
        pick = int(np.argmin(cost))
        if cost[pick] < self.cost:
            line = self.line.moved(lat[pick], lon[pick])
            better = replace(self, line=line, cost=float(cost[pick]), arrive=arrive[pick])
            return better, np.zeros_like(self.free)
        legs = self.evaluator.infeasible_legs(batch, arrive).any(axis=0)
        return self, (np.append(legs, False) | np.append(False, legs))[None]

    def point_spacing(self) -> FloatArray:
        """Return the length (1, n) [m] of the shorter leg beside each point."""
        return shorter_adjacent_legs(self.lengths())

    def displaced(
        self, row: IntArray, place: IntArray, east: FloatArray, north: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the positions (P, D) [deg] of points (P,) displaced east and north [m].

        With the length of a degree of longitude at the point before.
        """
        scale = METRES_PER_DEGREE * np.cos(np.radians(self.line.lat[place - 1]))[:, None]
        lat, lon = self.line.lat[place][:, None], self.line.lon[place][:, None]
        return lat + north / METRES_PER_DEGREE, lon + east / scale

    def values_beside(
        self, row: IntArray, place: IntArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the value of the two legs beside points (P,) at trial positions (P, D), and now.

        For time that is exact: an earlier arrival at the next point is never worse at the goal.
        """
        line, trials = self.line, lat.shape[1] + 1

        def triples(values: FloatArray) -> FloatArray:
            three = np.stack([values[place - 1], values[place], values[place + 1]], axis=1)
            return np.repeat(three, trials, axis=0)

        lats, lons = triples(line.lat), triples(line.lon)
        lats[:, 1] = np.column_stack([lats[::trials, 1], lat]).ravel()
        lons[:, 1] = np.column_stack([lons[::trials, 1], lon]).ravel()
        setting = np.stack([line.setting[place - 1], line.setting[place]], axis=1)
        batch = TrackBatch(
            lats,
            lons,
            triples(line.leave),
            np.repeat(setting, trials, axis=0),
            np.repeat(self.arrive[place - 1], trials),
        )
        value = self.evaluator.sail(batch)[1] - (0.0 if self.evaluator.by_length else batch.depart)
        value = value.reshape(-1, trials)
        return value[:, 1:], value[:, 0]

    def with_points_moved(
        self, gain: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> tuple[SailedPolyline, BoolArray]:
        """Return the line with points (1, n) at other positions where that gains, and which.

        An earlier arrival can meet what is closed then: a line that does not gain as a whole stays.
        """
        moved = gain > 0.0
        if not moved.any():
            return self, moved
        line = self.line.moved(
            np.where(moved[0], lat[0], self.line.lat), np.where(moved[0], lon[0], self.line.lon)
        )
        better = SailedPolyline.of(line, self.evaluator)
        return (better, moved) if better.cost < self.cost else (self, np.zeros_like(moved))

    def _shifted(self, offset: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return positions (..., n) of the points moved to starboard [m]."""
        line = self.line
        east, north = starboard_vectors(line.lat[None], line.lon[None], np.array([len(line)]))
        return displaced_positions(line.lat, line.lon, offset * east[0], offset * north[0])
