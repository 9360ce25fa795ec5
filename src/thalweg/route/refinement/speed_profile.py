"""Speed settings of the legs: the cheapest that arrive in time, or for a shadow price of time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np

from thalweg.core.geodesy import direct, inverse, unwrap_longitude
from thalweg.core.pareto_fronts import lower_hull
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.route.evaluators.cost_evaluator import CostEvaluator
from thalweg.route.evaluators.polyline import Polyline
from thalweg.route.evaluators.population import concatenated_populations
from thalweg.route.evaluators.time_evaluator import TrackBatch
from thalweg.route.refinement.scored_tracks import (
    DelayEffects,
    ScoredTracks,
    delay_effects,
    fix_piece_counts,
    legs_as_tracks,
    sail_legs_alone,
)
from thalweg.route.refinement.trial_edits import trial_subsets

_MAX_ROUNDS = 4  # choices, each at the times of passage of the one before
_SLOPE_TOLERANCE = (
    1e-3  # relative difference below which slopes count as equal; then the first leg comes first
)
_MIN_LEG_SHARE = 0.02  # least share of a leg that gets a waypoint of its own


def choose_speeds(
    line: Polyline, evaluator: CostEvaluator, latest: float, *, whole: bool = False
) -> tuple[Polyline, float]:
    """Return the line with the cheapest settings that arrive in time, and the value of a second.

    Parameters
    ----------
    latest : Latest arrival [s after the origin].
    whole : Do not split legs: the waypoints of the line do not change.

    Returns
    -------
    line : With one more waypoint if a setting changes within a leg. At the fastest settings if even
        those are late. The given line where the evaluator holds settings.
    per_second : Cost of the next second saved (the slope of cost over time); 0 if all legs are at
        their cheapest setting.

    Notes
    -----
    The linear relaxation of the multiple-choice knapsack problem (Sinha & Zoltners 1979, "The
    multiple-choice knapsack problem", Operations Research 27, 503-515): with every leg at its
    fastest setting, steps to slower settings on the lower convex hull of (time, cost) of each leg
    are taken in the order of the cost saved per second, the last one on a part of its leg. Times
    of passage depend on the choice, so it is repeated.
    """
    if evaluator.holds_settings:
        return line, 0.0
    budget, slope = latest, 0.0
    base = line
    rounds = _MAX_ROUNDS // 2 if whole else _MAX_ROUNDS
    for number in range(rounds):
        times, costs = times_and_costs_by_setting(base, evaluator)
        available = budget - _departure_plus_waiting(base, evaluator)
        setting, slope, part = _knapsack(times, costs, available)
        base = replace(base, setting=setting)
        if number == rounds - 1 and not whole:
            line = _with_slower_part(base, part)
        else:
            line = base
        arrive = float(evaluator.sail(line.batch(), check=False)[0][0, -1])
        if math.isfinite(arrive) and number >= rounds - 2:
            budget += min(0.0, latest - arrive)
    return line, slope


def _departure_plus_waiting(line: Polyline, evaluator: CostEvaluator) -> float:
    """Return departure plus the waiting times [s after the origin]."""
    arrive = evaluator.sail(line.batch(), check=False)[0][0]
    waits = np.maximum(line.leave[:-1] - arrive[:-1], 0.0)
    return line.depart + float(waits[np.isfinite(waits)].sum())


def times_and_costs_by_setting(
    line: Polyline, evaluator: CostEvaluator
) -> tuple[FloatArray, FloatArray]:
    """Return (time, cost) of every leg at every setting, at the times of passage of the line.

    Returns
    -------
    time, cost : [s] and in the unit of the prices, with the shadow price, (legs, settings); +inf
        where a leg cannot be sailed.
    """
    legs, settings = len(line) - 1, evaluator.settings
    arrive = evaluator.sail(line.batch(), check=False)[0][0]
    depart = np.maximum(arrive[:-1], line.leave[:-1])
    depart = np.where(np.isfinite(depart), depart, line.depart)
    lat = np.stack([line.lat[:-1], line.lat[1:]], axis=1)
    lon = np.stack([line.lon[:-1], line.lon[1:]], axis=1)
    batch = TrackBatch(
        np.repeat(lat, settings, axis=0),
        np.repeat(lon, settings, axis=0),
        np.full((legs * settings, 2), -math.inf),
        np.tile(np.arange(settings), legs)[:, None],
        np.repeat(depart, settings),
    )
    ends, cost, _ = evaluator.cost_and_time(batch)
    time = np.where(np.isfinite(cost), ends[:, -1] - batch.depart, math.inf)
    return time.reshape(legs, settings), cost.reshape(legs, settings)


def _knapsack(
    times: FloatArray, costs: FloatArray, available: float
) -> tuple[IntArray, float, tuple[int, int, float] | None]:
    """Return (setting of every leg, slope, (leg, slower setting, share of the leg) or None)."""
    hulls = [_efficient_settings(*leg) for leg in zip(times, costs)]
    setting = np.array(
        [hull[0] if len(hull) else np.argmin(time) for hull, time in zip(hulls, times)], np.int64
    )
    steps = SpeedSteps.along(times, costs, hulls)
    steps = steps.take(np.lexsort((steps.leg, -_rounded_slopes(steps.price))))
    available -= float(times[np.arange(len(times)), setting].sum())
    if not available > 0.0:
        return setting, float(steps.price.max(initial=0.0)), None
    for leg, before, after, seconds, slope in zip(
        steps.leg, steps.before, steps.after, steps.time, steps.price
    ):
        if setting[leg] != before:
            continue
        if seconds > available:
            return setting, float(slope), (int(leg), int(after), float(available / seconds))
        setting[leg], available = after, available - seconds
    return setting, 0.0, None


def _rounded_slopes(slope: FloatArray) -> FloatArray:
    """Return slopes rounded on a logarithmic scale, so that similar ones are equal."""
    positive = slope > 0.0
    level = np.round(np.log(np.where(positive, slope, 1.0)) / _SLOPE_TOLERANCE)
    return np.where(positive, np.exp(level * _SLOPE_TOLERANCE), 0.0)


def _efficient_settings(time: FloatArray, cost: FloatArray) -> IntArray:
    """Return the settings on the lower convex hull of cost over time, fastest to cheapest."""
    hull = hull_settings(time, cost)
    return hull[: int(np.argmin(cost[hull])) + 1] if len(hull) else hull


def hull_settings(time: FloatArray, cost: FloatArray) -> IntArray:
    """Return the settings of a leg on the lower convex hull of cost over time, fastest first.

    Parameters
    ----------
    time, cost : Not finite where the leg cannot be sailed, (settings,).

    Returns
    -------
    int64 array
    """
    finite = np.flatnonzero(np.isfinite(time) & np.isfinite(cost))
    return finite[lower_hull(time[finite], cost[finite])]


@dataclass(frozen=True)
class SpeedSteps:
    """Steps between neighbouring settings on the hulls of legs.

    Attributes
    ----------
    leg, before, after : Leg, and its setting before and after the step, (n,).
    time, cost : Changes of time [s] and cost, (n,).
    """

    leg: IntArray
    before: IntArray
    after: IntArray
    time: FloatArray
    cost: FloatArray

    @classmethod
    def along(cls, times: FloatArray, costs: FloatArray, chains: Sequence[IntArray]) -> SpeedSteps:
        """Return the steps along a chain of settings for each leg.

        Parameters
        ----------
        times, costs : float64 array (legs, settings)
        """
        pairs = [(k, a, b) for k, chain in enumerate(chains) for a, b in pairwise(chain)]
        leg, before, after = np.array(pairs, np.int64).reshape(-1, 3).T
        return cls(
            leg,
            before,
            after,
            times[leg, after] - times[leg, before],
            costs[leg, after] - costs[leg, before],
        )

    @property
    def price(self) -> FloatArray:
        """Cost of a second saved, or saved by a second more; +inf where no time changes."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.time == 0.0, np.inf, -self.cost / self.time)

    def take(self, order: IntArray) -> SpeedSteps:
        """Return some of the steps, in an order."""
        return SpeedSteps(*(getattr(self, field.name)[order] for field in fields(self)))


def _with_slower_part(line: Polyline, part: tuple[int, int, float] | None) -> Polyline:
    """Return the line with a slower setting on a part of one leg, next to a leg as slow."""
    if part is None or part[2] < _MIN_LEG_SHARE:
        return line
    leg, slower, share = part
    share = min(share, 1.0 - _MIN_LEG_SHARE)
    first = leg > 0 and line.setting[leg - 1] == slower  # the slower part comes first
    ends = (line.lat[leg], line.lon[leg], line.lat[leg + 1], line.lon[leg + 1])
    length, course, _ = inverse(*ends)
    lat, lon = direct(ends[0], ends[1], course, (share if first else 1.0 - share) * length)
    pair = (slower, line.setting[leg]) if first else (line.setting[leg], slower)
    setting = np.concatenate([line.setting[:leg], pair, line.setting[leg + 1 :]])
    return Polyline(
        np.insert(line.lat, leg + 1, lat),
        unwrap_longitude(np.insert(line.lon, leg + 1, lon)),
        np.insert(line.leave, leg + 1, -math.inf),
        setting.astype(np.int64),
        line.depart,
    )


def choose_speeds_of_tracks(lines: ScoredTracks, *, rounds: int = 3) -> ScoredTracks:
    """Return tracks with the setting of every leg chosen for its own cost and its delay.

    Parameters
    ----------
    rounds : Choices at most, each at the times of passage of the one before.

    Returns
    -------
    ScoredTracks : With costs that are not higher than before.
    """
    for _ in range(rounds):
        before = lines.value
        row, place = lines.legs
        value = leg_values_by_setting(lines, delay_effects(lines), row, place)
        now = lines.population.genes[row, place, columns.SETTING].astype(np.int64)
        best = np.argmin(value, axis=1)
        gain = np.full(lines.population.genes.shape[:2], 0.0)
        with np.errstate(invalid="ignore"):
            better = value[np.arange(len(row)), now] - value[np.arange(len(row)), best]
        gain[row, place] = np.where(np.isfinite(better), better, 0.0)
        wanted = np.zeros(gain.shape)
        wanted[row, place] = best
        trials, rows = [], []
        for chosen, index in trial_subsets(gain):
            copy = lines.population.take(index)
            setting = copy.genes[:, :, columns.SETTING]
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
    """Return the value (L, settings) of every leg at every setting; +inf where it cannot sail.

    Parameters
    ----------
    row, place : Track and first point of each leg, (L,).

    Returns
    -------
    float64 array (L, settings)
    """
    time, cost = leg_times_and_costs_by_setting(lines, row, place)
    late = delays.priced(lines.price)[row, place + 1]
    return np.where(np.isfinite(time), cost + late[:, None] * time, math.inf)


def leg_times_and_costs_by_setting(
    lines: ScoredTracks, row: IntArray, place: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return (time, cost) (L, settings) of every leg at every setting.

    Parameters
    ----------
    row, place : Track and first point of each leg, (L,).

    Returns
    -------
    time, cost : float64 array (L, settings)
        [s] and in the unit of the prices; +inf where a leg cannot be sailed.
    """
    settings = lines.evaluator.settings
    pairs, depart = legs_as_tracks(lines, row, place)
    fix_piece_counts(lines.evaluator, pairs)
    every = np.repeat(pairs, settings, axis=0)
    every[:, 0, columns.SETTING] = np.tile(np.arange(settings), len(row))
    time, cost = sail_legs_alone(lines.evaluator, every, np.repeat(depart, settings), blocked=True)
    return time.reshape(-1, settings), cost.reshape(-1, settings)
