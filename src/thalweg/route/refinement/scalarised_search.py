"""Local search on a scalarised objective: tracks refined for shadow prices of time; fronts filled.

For a shadow price of time p, the value of a track is cost + p * time; its minimum is a point on the
lower convex hull of the front.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from thalweg.core.pareto_fronts import length_along_front, lower_hull
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.leg import population_sailing
from thalweg.route.evaluators.calm_water_rates import calm_water_values
from thalweg.route.evaluators.population import Population, concatenated_populations
from thalweg.route.evaluators.population_evaluator import Evaluator
from thalweg.route.refinement.compass_search import CompassSchedule, compass_search
from thalweg.route.refinement.newton_offsets import optimise_lateral_offsets
from thalweg.route.refinement.point_edits import points_between, remove_points, split_long_legs
from thalweg.route.refinement.scored_tracks import ScoredTracks, delay_effects, feasible_front
from thalweg.route.refinement.speed_profile import (
    SpeedSteps,
    choose_speeds_of_tracks,
    hull_settings,
    leg_times_and_costs_by_setting,
)

_UNTIL_LATEST = 1.0 - 1e-6  # share of the time until the latest arrival that a track takes
REFINEMENT_LEVELS = (12, 24, 40)  #: least number of legs of a track, level by level
_REMOVAL_PASSES = 8  # passes at most that remove points at first
_REMOVAL_LOSS = 2e-4  # share of the value that may be lost with a removed point
_COMPASS_SCHEDULE = CompassSchedule(shares=(0.3, 0.08, 0.02), rounds=3)
_PRICE_RANGE_FACTOR = 4.0  # by which shadow prices exceed those of calm water, on both sides


def scalarised_local_search(
    lines: ScoredTracks,
    *,
    stop: Callable[[], bool] = lambda: False,
) -> ScoredTracks:
    """Return tracks refined for their shadow prices.

    Parameters
    ----------
    stop : Called between steps; true ends the search.

    Returns
    -------
    ScoredTracks : With costs that are not higher than before.

    Notes
    -----
    First needless points are removed. Then, level by level, long legs are split, points move
    sideways by Newton's method and by compass search, and settings are chosen.
    """
    lines = choose_speeds_of_tracks(lines)
    for _ in range(_REMOVAL_PASSES):
        before = lines.population.count.sum()
        lines = remove_points(lines, allowance=_REMOVAL_LOSS)
        if stop() or lines.population.count.sum() == before:
            break
    for level in REFINEMENT_LEVELS:
        if stop():
            return lines
        lines = split_long_legs(lines, legs=level)
        lines = choose_speeds_of_tracks(optimise_lateral_offsets(lines, rounds=4), rounds=2)
        lines = compass_search(lines, _COMPASS_SCHEDULE)
        lines = choose_speeds_of_tracks(optimise_lateral_offsets(lines, rounds=3), rounds=2)
    return lines


def time_prices(evaluator: Evaluator, count: int) -> FloatArray:
    """Return shadow prices [cost/s] (count,) that lead from the cheapest to the fastest passage.

    They cover those at which the ship would change its setting in calm water, with a margin on
    both sides, evenly in the logarithm.

    Parameters
    ----------
    count : Number of prices.
    """
    speeds, prices = calm_water_values(evaluator.world.table), evaluator.prices
    cost = calm_water_values(evaluator.world.fuel) * prices.outside + prices.time
    with np.errstate(invalid="ignore", divide="ignore"):
        points = np.column_stack([1.0 / speeds, cost / speeds])
    points = points[np.isfinite(points).all(axis=1)]
    slopes = -np.array([slope for slope in hull_slopes(points) if slope < 0.0])
    if not len(slopes):
        return np.full(1, float(np.nanmax(np.append(cost, 0.0))) or 1.0)
    low, high = slopes.min() / _PRICE_RANGE_FACTOR, slopes.max() * _PRICE_RANGE_FACTOR
    return np.geomspace(low, high, count)


def hull_slopes(points: FloatArray) -> list[float]:
    """Return the slopes of the lower convex hull of points (n, 2), ascending in the first."""
    hull = lower_hull(points[:, 0], points[:, 1])
    a, b = points[hull[:-1]], points[hull[1:]]
    return ((b[:, 1] - a[:, 1]) / (b[:, 0] - a[:, 0])).tolist()


def seeds_with_time_prices(evaluator: Evaluator, seeds: Population, *, count: int) -> ScoredTracks:
    """Return the tracks to refine, with their shadow prices.

    Each seed at the shadow price that follows from its neighbours on the front, and for each of
    ``count`` prices the best seed at that price.

    Parameters
    ----------
    count : Number of shadow prices.
    """
    scores = evaluator.score(seeds)
    good = np.flatnonzero(scores[:, 2] == 0.0)
    prices = time_prices(evaluator, count)
    if not len(good):
        return ScoredTracks.of(evaluator, seeds, np.full(len(seeds), float(np.median(prices))))
    table = scores[good, 1] + prices[:, None] * scores[good, 0]
    best = good[np.argmin(table, axis=1)]
    own = _own_prices(scores[good], prices)
    rows = np.concatenate([good, best])
    return ScoredTracks.of(evaluator, seeds.take(rows), np.concatenate([own, prices]))


def _own_prices(scores: FloatArray, prices: FloatArray) -> FloatArray:
    """Return the shadow price at which each of several tracks would be the best."""
    order = np.argsort(scores[:, 0], kind="stable")
    time, cost = scores[order, 0], scores[order, 1]
    own = np.full(len(order), float(np.median(prices)))
    if len(order) > 2:
        span = time[2:] - time[:-2]
        with np.errstate(invalid="ignore", divide="ignore"):
            slope = -(cost[2:] - cost[:-2]) / span
        own[1:-1] = np.where(np.isfinite(slope) & (slope > 0.0), slope, own[1:-1])
        own[0], own[-1] = own[1], own[-2]
    out = np.empty(len(order))
    out[order] = np.clip(own, prices.min(), prices.max())
    return out


def fill_front(lines: ScoredTracks, size: int) -> Population:
    """Return about ``size`` tracks evenly along a front, each made of its nearest track.

    One more arrives at the latest arrival of the evaluator, if it has one. For the same geometry
    the cheapest change of time is to change settings in the order of the cost of a second, the last
    one on a part of its leg.

    Parameters
    ----------
    size : Number of tracks, about.
    """
    front = feasible_front(lines.scores)
    if len(front) < 2:
        return lines.population.take(front)
    scores = lines.scores[front]
    along = length_along_front(scores[:, 0], scores[:, 1])
    targets = np.interp(np.linspace(0.0, along[-1], size), along, scores[:, 0])
    available = lines.evaluator.latest - lines.evaluator.depart
    if math.isfinite(available):
        targets = np.append(targets, _UNTIL_LATEST * available)
    chosen = ScoredTracks(
        lines.evaluator,
        lines.population.take(front),
        lines.price[front],
        scores,
        lines.arrive[front],
    )
    exchanges = _speed_exchanges(chosen)
    made = []
    for side in (0, 1):
        nearest = np.searchsorted(scores[:, 0], targets) - side
        for target, k in zip(targets, np.clip(nearest, 0, len(front) - 1)):
            made.append(_with_changed_time(chosen, int(k), exchanges[k], target - scores[k, 0]))
    return concatenated_populations(*made)


def _speed_exchanges(lines: ScoredTracks) -> list[tuple[SpeedSteps, SpeedSteps]]:
    """Return the steps between settings that make every track (faster, slower), in their order."""
    row, place = lines.legs
    time, cost = leg_times_and_costs_by_setting(lines, row, place)
    delays = delay_effects(lines)
    time_factor, cost_rate = delays.time[row, place + 1], delays.cost[row, place + 1]
    with np.errstate(invalid="ignore"):
        at_goal, cost_at_goal = time_factor[:, None] * time, cost + cost_rate[:, None] * time
    setting = lines.population.genes[row, place, population_sailing.SETTING].astype(np.int64)
    out = []
    for k in range(len(lines)):
        legs = row == k
        sides = [
            _hull_from_setting(*leg)
            for leg in zip(at_goal[legs], cost_at_goal[legs], setting[legs])
        ]
        faster, slower = (
            SpeedSteps.along(at_goal[legs], cost_at_goal[legs], chains) for chains in zip(*sides)
        )
        faster = faster.take(np.argsort(faster.price, kind="stable"))
        out.append((faster, slower.take(np.argsort(-slower.price, kind="stable"))))
    return out


def _hull_from_setting(time: FloatArray, cost: FloatArray, now: int) -> tuple[IntArray, IntArray]:
    """Return the settings on the hull of a leg from its own to the fastest, and to the slowest."""
    hull = hull_settings(time, cost)
    at = np.flatnonzero(hull == now)
    if not len(at):
        return hull[:0], hull[:0]
    return hull[at[0] :: -1], hull[at[0] :]


def _with_changed_time(
    lines: ScoredTracks, k: int, exchange: tuple[SpeedSteps, SpeedSteps], change: float
) -> Population:
    """Return one track made longer or shorter by ``change`` seconds."""
    steps = exchange[0] if change < 0.0 else exchange[1]
    one = lines.population.take([k])
    total = np.cumsum(np.abs(steps.time))
    full = int(np.searchsorted(total, abs(change)))
    for place, setting in zip(steps.leg[:full], steps.after[:full]):
        one.genes[0, place, population_sailing.SETTING] = setting
    if full >= len(total):
        return one
    before = total[full - 1] if full else 0.0
    share = (abs(change) - before) / (total[full] - before)
    if not 0.05 < share < 0.95:
        return one
    return _split_leg_by_speed(one, int(steps.leg[full]), share, int(steps.after[full]))


def _split_leg_by_speed(one: Population, place: int, share: float, setting: int) -> Population:
    """Return a track with the first share of a leg sailed at another setting."""
    n = int(one.count[0])
    wide = one.with_capacity(max(one.capacity, n + 1))
    genes = wide.genes
    point = points_between(genes[0, [place]], genes[0, [place + 1]], np.array([share]))
    genes[0, place + 1 : n + 1] = np.insert(genes[0, place + 1 : n], 0, point[0], axis=0)
    (
        genes[0, place, population_sailing.SETTING],
        genes[0, place, population_sailing.IS_LOOKED_UP],
    ) = (
        setting,
        0.0,
    )
    return Population(wide.count + 1, genes)
