"""The lower front: a lower bound of the cost of every path on the network, by time."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.pareto_fronts import lower_hull
from thalweg.core.types import FloatArray
from thalweg.kernels.pareto.edge_tables import EdgeTables
from thalweg.kernels.pareto.label_arrays import PRUNED, RELAXED, VISITED
from thalweg.kernels.pareto.lower_labels import process_bins_lower, process_bins_scalarised
from thalweg.kernels.pareto.slice_interpolation import (
    InterpolationBounds,
    LowerLabels,
    LowerSearch,
    ScalarisedLabelTarget,
)
from thalweg.search.pareto.discretisation import (
    PROGRESS_CHUNKS,
    Discretisation,
    new_active_nodes,
    new_target,
)
from thalweg.search.pareto.front_problem import FrontProblem, FrontRequest, new_edge_workspace
from thalweg.search.pareto.front_result import FrontPoint
from thalweg.search.pareto.goal_bounds import BoundsToGoal
from thalweg.search.pareto.seed_paths import tighten_target

_ROUNDING_MARGIN = 1.0 - 2e-6  # for sums in single precision
_MAX_TIME_PRICES = 6


class LowerFront(NamedTuple):
    """The lower front, by ascending time and falling cost, and the work it was."""

    time: FloatArray
    cost: FloatArray
    labels: int
    relaxed: int
    pruned: int


def lower_front(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    plan: Discretisation,
    blocks: EdgeTables,
    points: tuple[FrontPoint, ...],
    report: Callable[[float], None],
) -> LowerFront:
    """Search the lower front below the points of a front.

    Parameters
    ----------
    blocks : Tables of edges, as far as they are filled.
    points : Real paths: labels that cannot lead below them are dropped.
    report : Called with the share done, `PROGRESS_CHUNKS` times.
    """
    front_problem = _waiting_price_capped(front_problem)
    slack = _new_slack(front_problem, bounds, blocks)
    halves = _lower_by_bins(front_problem, request, bounds, plan, blocks, slack, points, report)
    lines, priced = _lower_by_time_prices(
        front_problem, request, bounds, plan, blocks, slack, points
    )
    time, cost = _larger_bound(plan, points, halves.time, halves.cost, lines)
    return LowerFront(
        time, cost, halves.labels + priced[0], halves.relaxed + priced[1], halves.pruned
    )


def _waiting_price_capped(front_problem: FrontProblem) -> FrontProblem:
    """Return a problem whose price of waiting is at most that of sailing at its cheapest.

    Sailing then never gains on waiting, so that no circle within a bin can fall without end.
    """
    prices = front_problem.arrays.prices
    spent = (prices.fixed_fuel * prices.weight + prices.fee) / prices.fixed_time
    sailed = np.nanmin(front_problem.least_rate, initial=np.inf) * prices.weight
    least = float(np.where(np.isnan(prices.fixed_time), sailed, spent).min(initial=np.inf))
    rate = min(prices.waiting_cost_rate, prices.time_price + least)
    return front_problem._replace(
        arrays=front_problem.arrays._replace(prices=prices._replace(waiting_cost_rate=rate))
    )


def _lower_by_bins(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    plan: Discretisation,
    blocks: EdgeTables,
    slack: InterpolationBounds,
    points: tuple[FrontPoint, ...],
    report: Callable[[float], None],
) -> LowerFront:
    """Let every arrival count for the start of its bin."""
    time_bins = plan.time_bins
    target = new_target(request.goal, bounds, time_bins)
    for point in points:
        tighten_target(target, time_bins, point)
    labels = _new_labels(plan)
    labels.cost[labels.place[request.start]] = 0.0
    active_nodes = new_active_nodes(plan.windows)
    search = LowerSearch(
        front_problem.arrays,
        labels,
        target,
        time_bins,
        blocks,
        slack,
        active_nodes,
        new_edge_workspace(),
    )
    edges = np.unique(np.linspace(0, time_bins.count, PROGRESS_CHUNKS + 1).astype(int))
    for a, b in pairwise(edges.tolist()):
        process_bins_lower(search, a, b)
        report(b / time_bins.count)
    first, last = int(labels.first[request.goal]), int(labels.last[request.goal])
    begin = int(labels.place[request.goal])
    time = np.arange(first, last + 1) * time_bins.width
    cost = (
        labels.cost[begin : begin + last - first + 1]
        + front_problem.arrays.prices.waiting_cost_rate * time
    )
    time = np.append(time, [point.time for point in points])
    cost = np.append(_ROUNDING_MARGIN * cost, [point.cost for point in points])
    counts = active_nodes.counts
    return LowerFront(
        *_staircase(time.astype(float), cost.astype(float)),
        int(counts[VISITED]),
        int(counts[RELAXED]),
        int(counts[PRUNED]),
    )


def _lower_by_time_prices(
    front_problem: FrontProblem,
    request: FrontRequest,
    bounds: BoundsToGoal,
    plan: Discretisation,
    blocks: EdgeTables,
    slack: InterpolationBounds,
    points: tuple[FrontPoint, ...],
) -> tuple[list[tuple[float, float]], tuple[int, int]]:
    """Return (price of time, least cost plus priced time) for some prices, and the work it was."""
    time, cost = np.array([p.time for p in points]), np.array([p.cost for p in points])
    lines, labelled, relaxed = [], 0, 0
    for rate in _prices_of_time(time, cost):
        labels = _new_labels(plan)
        labels.cost[labels.place[request.start]] = 0.0
        known = float(np.min(cost + rate * time))
        floor = bounds.to_goal.floor(rate)
        target = ScalarisedLabelTarget(request.goal, rate, known, bounds.time, floor)
        active_nodes = new_active_nodes(plan.windows)
        process_bins_scalarised(
            LowerSearch(
                front_problem.arrays,
                labels,
                target,
                plan.time_bins,
                blocks,
                slack,
                active_nodes,
                new_edge_workspace(),
            )
        )
        begin = int(labels.place[request.goal])
        bins = int(labels.last[request.goal]) - int(labels.first[request.goal]) + 1
        found = float(labels.cost[begin : begin + bins].min())
        lines.append((rate, min(known, _ROUNDING_MARGIN * found)))
        labelled += int(active_nodes.counts[VISITED])
        relaxed += int(active_nodes.counts[RELAXED])
    return lines, (labelled, relaxed)


def _prices_of_time(time: FloatArray, cost: FloatArray) -> list[float]:
    """Return the slopes of the front's lower hull, thinned evenly in time."""
    hull = lower_hull(time, cost)
    if len(hull) < 2:
        return []
    slopes = -np.diff(cost[hull]) / np.diff(time[hull])
    middle = 0.5 * (time[hull][1:] + time[hull][:-1])
    wanted = np.linspace(time[0], time[-1], 2 * _MAX_TIME_PRICES + 1)[1::2]
    chosen = np.abs(middle[:, None] - wanted).argmin(axis=0)
    return sorted({float(slopes[i]) for i in chosen if slopes[i] > 0.0})


def _larger_bound(
    plan: Discretisation,
    points: tuple[FrontPoint, ...],
    time: FloatArray,
    cost: FloatArray,
    lines: list[tuple[float, float]],
) -> tuple[FloatArray, FloatArray]:
    """Return the larger of the two bounds as steps: each holds until the next."""
    if not lines:
        return time, cost
    own = np.array([point.time for point in points])
    grid = np.concatenate((time, np.arange(plan.time_bins.count + 1) * plan.time_bins.width, own))
    grid = np.concatenate((grid, own + 1e-9 * plan.time_bins.latest))
    grid = np.unique(grid[(grid >= time[0]) & (grid <= plan.time_bins.latest)])
    steps = cost[np.searchsorted(time, grid, side="right") - 1]
    until = np.append(grid[1:], plan.time_bins.latest)
    rates, values = np.array(lines).T
    line = (values[:, None] - rates[:, None] * until).max(axis=0)
    return _staircase(grid, np.maximum(steps, line))


def _staircase(time: FloatArray, cost: FloatArray) -> tuple[FloatArray, FloatArray]:
    order = np.lexsort((cost, time))
    time, cost = time[order], cost[order]
    before = np.minimum.accumulate(np.concatenate(([np.inf], cost[:-1])))
    falls = cost < before
    return time[falls], cost[falls]


def _new_labels(plan: Discretisation) -> LowerLabels:
    windows = plan.windows
    bins = np.maximum(windows.last.astype(np.int64) - windows.first + 1, 0)
    return LowerLabels(
        first=windows.first,
        last=windows.last,
        place=cumulative_sums(bins)[:-1],
        cost=np.full(int(bins.sum()), np.inf),
        best=np.full(len(bins), np.inf),
        dead=np.full(len(bins), np.inf),
    )


def _new_slack(
    front_problem: FrontProblem, bounds: BoundsToGoal, blocks: EdgeTables
) -> InterpolationBounds:
    size = blocks.count * np.diff(front_problem.arrays.network.indptr)
    total = int(size.sum())
    return InterpolationBounds(
        start=cumulative_sums(size)[:-1],
        state=np.zeros(len(blocks.state), np.uint8),
        off=np.empty((total, 3), np.float32),
        gains=np.empty(total, np.uint8),
        along=bounds.to_goal.along,
        fastest=front_problem.fastest,
        least_rate=front_problem.least_rate,
    )
