"""Paths over the network, sailed exactly: seeds of a front, and the paths of its labels."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from thalweg.core.pareto_fronts import non_dominated_indices
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import OK
from thalweg.kernels.pareto.edge_tables import sail_path
from thalweg.kernels.pareto.label_arrays import BinLabels, LabelTarget, TimeBins
from thalweg.kernels.pareto.time_expanded_labels import trace_labels
from thalweg.search.pareto.front_problem import (
    EarliestArrivals,
    FrontProblem,
    FrontRequest,
    new_edge_workspace,
)
from thalweg.search.pareto.front_result import FrontPoint
from thalweg.search.pareto.goal_bounds import BoundsToGoal
from thalweg.search.search_result import SearchResult

_SETTING_SWITCHES = 24  # places at most where a seed changes from one setting to the next


class PlannedPath(NamedTuple):
    """A path as planned: states, edges, choices of setting, and the earliest departures.

    ``leave`` is -inf where the ship does not wait [s].
    """

    states: IntArray
    edges: IntArray
    choices: IntArray
    leave: FloatArray


def sail_planned_path(
    front_problem: FrontProblem, request: FrontRequest, path: PlannedPath
) -> FrontPoint | None:
    """Sail a path exactly; None if it is closed."""
    arrive, depart = np.empty(len(path.states)), np.empty(len(path.states))
    arrive[0] = request.depart
    cost, status = sail_path(
        front_problem.arrays,
        path.states,
        path.edges,
        path.choices,
        path.leave,
        arrive,
        depart,
        new_edge_workspace(),
    )
    if status != OK:
        return None
    return FrontPoint(
        time=float(arrive[-1] - request.depart),
        cost=float(cost),
        path=front_problem.arrays.network.station[path.states].astype(np.int64),
        path_arrive=arrive,
        path_depart=depart,
        setting=front_problem.arrays.ship.settings[path.choices],
    )


def seed_paths(
    front_problem: FrontProblem, request: FrontRequest, fastest: PlannedPath, bounds: BoundsToGoal
) -> list[FrontPoint]:
    """Return paths that are likely to be near the front, the fastest first.

    They are the fastest path, and the best for each shadow price in the most favourable weather,
    at every setting and at two settings one after the other. Those that take too long are left out.
    A dense front known from the beginning avoids most labels.

    Parameters
    ----------
    front_problem : Network, sea, ship and prices.
    request : Nodes, times and settings.
    fastest : The earliest arrival.
    bounds : Lower bounds of time and cost to the goal.

    Returns
    -------
    list of FrontPoint : Sailed paths.
    """
    paths = [fastest]
    known = {fastest.states.tobytes()}
    for rate in bounds.rates:
        states = bounds.to_goal.path_to_goal(request.start, float(rate))
        if len(states) > 1 and states.tobytes() not in known:
            known.add(states.tobytes())
            paths.append(_path_through(front_problem, states))
    sailed = [
        sail_planned_path(front_problem, request, path._replace(choices=choices))
        for path in paths
        for choices in _setting_choices(front_problem, path, len(request.settings))
    ]
    return [point for point in sailed if point is not None and point.time <= request.horizon]


def _setting_choices(front_problem: FrontProblem, path: PlannedPath, count: int) -> list[IntArray]:
    """Return settings for the edges of a path: one throughout, or two neighbours in turn."""
    same = [_edge_settings(front_problem, path.edges, choice) for choice in range(count)][::-1]
    legs = len(path.edges)
    switches = np.unique(
        np.linspace(1, legs - 1, min(_SETTING_SWITCHES, max(legs - 1, 0))).astype(int)
    )
    turns = [
        np.where(np.arange(legs) < k, fast, slow) for fast, slow in pairwise(same) for k in switches
    ]
    return same + turns


def _edge_settings(front_problem: FrontProblem, edges: IntArray, choice: int) -> IntArray:
    """Return a setting for every edge; those of fixed time have their own."""
    prices = front_problem.arrays.prices
    sailed = np.isnan(prices.fixed_time[edges])
    return np.where(sailed, choice, prices.fixed_choice[edges]).astype(np.int64)


def earliest_arrival_path(
    front_problem: FrontProblem, request: FrontRequest, arrivals: EarliestArrivals
) -> PlannedPath:
    """Return the path of the earliest arrival at the goal."""
    states = [request.goal]
    while states[-1] != request.start:
        states.append(int(arrivals.before[states[-1]]))
    visited = np.array(states[::-1], np.int64)
    departed = arrivals.departed[visited[1:]]
    waited = departed > arrivals.time[visited[:-1]]
    path = _path_through(front_problem, visited)
    return path._replace(leave=np.where(waited, departed, -math.inf))


def path_of_search_result(
    front_problem: FrontProblem, result: SearchResult | FrontPoint
) -> PlannedPath:
    """Return the path of a search on a network with one state for each node."""
    net = front_problem.arrays.network
    states = [int(result.path[0])]
    for node, time in zip(result.path[1:].tolist(), result.path_arrive[1:].tolist()):
        leaving = np.arange(net.indptr[states[-1]], net.indptr[states[-1] + 1])
        heads = net.target[leaving]
        there = (
            (net.station[heads] == node) & (net.opens[heads] <= time) & (time < net.closes[heads])
        )
        states.append(int(heads[there][0]))
    waited = result.path_depart[:-1] > result.path_arrive[:-1]
    path = _path_through(front_problem, np.array(states, np.int64))
    return path._replace(leave=np.where(waited, result.path_depart[:-1], -math.inf))


def _path_through(front_problem: FrontProblem, path: IntArray) -> PlannedPath:
    """Return the path through states, without waiting."""
    net = front_problem.arrays.network
    edges = []
    for a, b in pairwise(path.tolist()):
        leaving = np.arange(net.indptr[a], net.indptr[a + 1])
        joining = leaving[net.target[leaving] == b]
        edges.append(joining[np.argmin(net.length[joining])])
    still = np.full(len(edges), -math.inf)
    return PlannedPath(path, np.array(edges, np.int64), np.zeros(len(edges), np.int64), still)


def tighten_target(target: LabelTarget, time_bins: TimeBins, point: FrontPoint) -> None:
    """Lower what is known of arriving at the goal by a point.

    Parameters
    ----------
    target : Upper bounds of the cost at the goal; changed in place.
    time_bins : The division of time.
    point : A sailed path.
    """
    b = int(point.time / time_bins.width) + 1
    np.minimum(target.upper[b:], point.cost, out=target.upper[b:])


def paths_of_goal_labels(
    front_problem: FrontProblem, request: FrontRequest, labels: BinLabels
) -> tuple[list[FrontPoint], int]:
    """Return the paths of the non-dominated labels of the goal, and how many are closed.

    Every path is sailed again, leg by leg.
    """
    goal, count = request.goal, len(request.settings)
    first, last = int(labels.first[goal]), int(labels.last[goal])
    start = int(labels.place[goal])
    cost = labels.cost[start : start + last - first + 1]
    best = np.minimum.accumulate(np.concatenate(([np.inf], cost[:-1])))
    slots = np.empty(len(front_problem.arrays.network.station) * 4 + 16, np.int64)
    paths, dropped = [], 0
    for slot in start + np.flatnonzero(cost < best):
        n = int(trace_labels(labels, int(slot), slots))
        while n < 0:  # ships that may not wait can circle
            slots = np.empty(2 * len(slots), np.int64)
            n = int(trace_labels(labels, int(slot), slots))
        path = _path_of_label(front_problem, request, labels, slots[:n][::-1], count)
        point = sail_planned_path(front_problem, request, path)
        if point is None:
            dropped += 1
        elif point.time <= request.horizon * (1.0 + 1e-12):
            paths.append(point)
    return paths, dropped


def _path_of_label(
    front_problem: FrontProblem,
    request: FrontRequest,
    labels: BinLabels,
    slots: IntArray,
    count: int,
) -> PlannedPath:
    code = labels.source[slots[1:], 1].astype(np.int64)
    left = labels.when[slots[1:], 1].astype(float)
    edges = code // count
    states = np.append(
        front_problem.tails[edges], front_problem.arrays.network.target[edges[-1]]
    ).astype(np.int64)
    leave = np.where(np.isnan(left), -math.inf, request.depart + left)
    return PlannedPath(states, edges, code % count, leave)


def non_dominated_points(points: list[FrontPoint]) -> tuple[FrontPoint, ...]:
    """Return the points that no other dominates, by ascending time."""
    kept = non_dominated_indices([p.time for p in points], [p.cost for p in points])
    return tuple(points[index] for index in kept)
