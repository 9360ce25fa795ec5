"""Lower bounds of time and cost from every state to the goal of a front."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from thalweg.core.pareto_fronts import lower_hull, non_dominated_indices
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.kernels.network.static_paths import static_astar
from thalweg.kernels.pareto.edge_tables import largest_edge_currents
from thalweg.search.pareto.front_problem import FrontProblem
from thalweg.search.search_problem import ROUNDING_FACTOR

_MAX_TIME_PRICES = 10


class BoundsToGoal(NamedTuple):
    """Lower bounds of time and cost from a state to the goal.

    Attributes
    ----------
    time : float64[N] [s]
    rates : float64[R]
        Prices of a second, 0 first.
    floor : float64[N, R]
        Least cost plus price times time.
    to_goal : For other prices.
    """

    time: FloatArray
    rates: FloatArray
    floor: FloatArray
    to_goal: BackwardSearch


class BackwardSearch:
    """Edges in the most favourable currents and weather, walked backwards from the goal.

    Each edge is taken at the largest current along it in the fields, at the greatest speed and the
    least fuel rate of each setting in any weather.

    Attributes
    ----------
    along : float64[E]
        Largest current along every edge in the fields [m/s].
    """

    def __init__(self, front_problem: FrontProblem, goal: int) -> None:
        net, self._got, self._goal = front_problem.arrays.network, front_problem, goal
        self.along = np.zeros(len(net.target))
        if min(front_problem.arrays.sea.channel_index[[CURRENT_EAST, CURRENT_NORTH]]) >= 0:
            largest_edge_currents(net, front_problem.arrays.sea, self.along)
        over_ground = front_problem.fastest[:, None] + self.along[None, :]
        with np.errstate(divide="ignore", invalid="ignore"):
            pace = np.where(over_ground > 0.0, net.length / over_ground, math.inf)
        pace[~(front_problem.fastest > 0.0)] = math.inf
        self._least_times = pace  # (S, E) [s]
        self._order = np.argsort(net.target, kind="stable")
        nodes = np.arange(len(net.station) + 1)
        self._indptr = np.searchsorted(net.target[self._order], nodes).astype(np.int64)
        self._target = front_problem.tails[self._order].astype(np.int32)

    def time(self) -> FloatArray:
        """Return the least time to the goal [s]."""
        fixed = self._got.arrays.prices.fixed_time
        return (
            self._least(np.where(np.isnan(fixed), self._least_times.min(axis=0), fixed))
            * ROUNDING_FACTOR
        )

    def floor(self, rate: float) -> FloatArray:
        """Return the least cost plus shadow price to the goal."""
        return self._least(self._costs(rate)) * (1.0 - 1e-6)

    def path_to_goal(self, start: int, rate: float) -> IntArray:
        """Return the states of the path of least cost plus priced time; empty if there is none."""
        parent = np.empty(len(self._indptr) - 1, np.int64)
        distance = self._least(self._costs(rate), parent)
        if not math.isfinite(distance[start]):
            return np.empty(0, np.int64)
        states = [start]
        while states[-1] != self._goal:
            states.append(int(parent[states[-1]]))
        return np.array(states, np.int64)

    def _costs(self, rate: float) -> FloatArray:
        """Return the least cost plus shadow price of every edge."""
        prices = self._got.arrays.prices
        second = prices.time_price + rate
        least = np.full(len(prices.fee), math.inf)
        for least_time, fuel in zip(self._least_times, self._got.least_rate):
            if math.isfinite(fuel):
                np.fmin(least, least_time * (fuel * prices.weight + second), out=least)
        still = prices.fixed_fuel * prices.weight + prices.fixed_time * second
        least = np.where(np.isnan(prices.fixed_time), least, still)
        return least + prices.fee

    def _least(self, weights: FloatArray, parent: IntArray | None = None) -> FloatArray:
        """Return the least sums of weights to the goal; ``parent`` is filled with what follows."""
        count = len(self._indptr) - 1
        distance = np.empty(count)
        parent = np.empty(count, np.int64) if parent is None else parent
        given = np.ascontiguousarray(weights[self._order])
        none = np.zeros(count)  # the potential of a search to all states
        static_astar(self._indptr, self._target, given, none, self._goal, -1, distance, parent)
        return distance


def bounds_to_goal(front_problem: FrontProblem, goal: int) -> BoundsToGoal:
    """Bound time and cost from every state to the goal."""
    to_goal = BackwardSearch(front_problem, goal)
    weight = front_problem.arrays.prices.weight
    rates = _time_prices(front_problem, float(np.median(weight)) if len(weight) else 1.0)
    floor = np.stack([to_goal.floor(rate) for rate in rates], axis=1)
    return BoundsToGoal(to_goal.time(), rates, floor, to_goal)


def _time_prices(front_problem: FrontProblem, weight: float) -> FloatArray:
    """Return shadow prices at which the thriftiest setting in still water changes, and 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        pace = 1.0 / front_problem.fastest
        spent = front_problem.least_rate * pace * weight
    front = non_dominated_indices(pace, spent)
    hull = front[lower_hull(pace[front], spent[front])]
    price = front_problem.arrays.prices.time_price
    slopes = np.sort(-np.diff(spent[hull]) / np.diff(pace[hull]) - price)
    slopes = slopes[slopes > 0.0]
    if len(slopes) > _MAX_TIME_PRICES:
        picked = np.unique(np.linspace(0, len(slopes) - 1, _MAX_TIME_PRICES).round().astype(int))
        slopes = slopes[picked]
    return np.concatenate([[0.0], slopes])
