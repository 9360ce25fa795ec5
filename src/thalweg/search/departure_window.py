"""The best moment to depart inside a window of times."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.objective import SingleSettingObjective
from thalweg.search.earliest_arrival import (
    ArrivalQuery,
    Method,
    check_query,
    solve_earliest_arrival,
)
from thalweg.search.restricted_waiting import (
    earliest_arrival_with_restricted_waiting,
    waiting_is_restricted,
)
from thalweg.search.search_problem import SearchProblem, ShipOnNetwork, make_search_problem
from thalweg.search.search_result import SearchResult

_MAX_DEPARTURES = 97  # of the first pass
_MAX_DEPARTURES_RESTRICTED_WAITING = 25  # where every departure is a search in rounds
_GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)
_COST_TOLERANCE = 1e-3  # costs closer than this are equal [s or m]


@dataclass(frozen=True)
class DepartureWindow:
    """The departures to choose from, and how finely they are tried.

    Attributes
    ----------
    first, last : float
        Earliest and latest departure [s].
    step : float, optional
        Spacing of the departures tried [s]. By default the times of the fields inside the window,
        but not more than 96 even steps (24 where the ship may wait at some nodes only).
    tolerance : float
        The best departure is refined to this [s].
    """

    first: float
    last: float
    step: float | None = None
    tolerance: float = 60.0


def best_departure(
    ship_on_network: ShipOnNetwork,
    *,
    start: int,
    goal: int,
    window: DepartureWindow,
    objective: SingleSettingObjective = "time",
    wait: bool = True,
    arrive_by: float | None = None,
    method: Method = "astar",
) -> SearchResult:
    """Find the departure inside a window that makes the voyage cheapest.

    Parameters
    ----------
    ship_on_network, start, goal, objective, wait, arrive_by, method
        As in `thalweg.search.earliest_arrival`.
    window : DepartureWindow
        Earliest and latest departure, and how finely the departures between them are tried.

    Returns
    -------
    SearchResult
        Of the departure with the least cost (by time: the shortest voyage); of equal ones the
        shortest, then the earliest. If none succeeds, the result of the earliest departure.

    Raises
    ------
    InputError
        If the window ends before it begins, or as in `earliest_arrival`.

    Notes
    -----
    Each departure tried is searched exactly; between them the best one's neighbourhood is
    searched by golden section. So the answer is the best of its samples; a shorter optimum that
    is wholly between two samples elsewhere can be missed. A ship that would wait at the start
    leaves when the waiting ends.
    """
    network = ship_on_network.network
    first, last = float(window.first), float(window.last)
    if not (math.isfinite(first) and math.isfinite(last) and first <= last):
        raise InputError(
            f"The departure window from {first} to {last} is empty.",
            "It ends no earlier than it begins.",
            "Exchange the two times.",
        )
    check_query(network.n_nodes, ArrivalQuery(start, goal, first, objective, method=method))
    restricted = wait and objective == "time" and waiting_is_restricted(network)
    ends = (start, goal) if wait and not restricted else None
    given = make_search_problem(ship_on_network, ends=ends)

    def sail(depart: float) -> SearchResult:
        if restricted:
            return earliest_arrival_with_restricted_waiting(
                network, given, start=start, goal=goal, depart=depart,
                arrive_by=arrive_by,
            )  # fmt: skip
        query = ArrivalQuery(start, goal, depart, objective, wait, arrive_by, method)
        return solve_earliest_arrival(network, given, query)

    most = _MAX_DEPARTURES_RESTRICTED_WAITING if restricted else _MAX_DEPARTURES
    departures = _departures(given, first, last, window.step, most)
    tried = [sail(t) for t in departures]
    durations = tuple((float(t), one.duration) for t, one in zip(departures, tried))
    tried += [sail(t) for t in _after_waiting(tried, last)]
    best = min(tried, key=_comparison_key)
    if not best.found:
        return tried[0]
    near = int(np.searchsorted(departures, best.depart))
    low = departures[max(near - 1, 0)]
    high = departures[min(near + 1, len(departures) - 1)]
    while high - low > window.tolerance:
        left, right = high - _GOLDEN_RATIO * (high - low), low + _GOLDEN_RATIO * (high - low)
        pair = sail(left), sail(right)
        best = min((best, *pair), key=_comparison_key)
        if _comparison_key(pair[0]) <= _comparison_key(pair[1]):
            high = right
        else:
            low = left
    return replace(best, departures=durations)


def _departures(
    given: SearchProblem, first: float, last: float, step: float | None, most: int
) -> NDArray[np.float64]:
    if step is not None and step > 0.0:
        count = max(2, math.ceil((last - first) / step) + 1)
        return np.unique(np.linspace(first, last, count))
    times = given.sea.times
    inside = times[(times > first) & (times < last)]
    if len(inside) + 2 > most:
        return np.linspace(first, last, most)
    return np.unique(np.concatenate(([first], inside, [last])))


def _after_waiting(tried: list[SearchResult], last: float) -> list[float]:
    """Return when ships that waited at the start left it."""
    left = {float(r.path_depart[0]) for r in tried if r.found and r.path_depart[0] > r.depart}
    return sorted(t for t in left if t <= last)


def _comparison_key(result: SearchResult) -> tuple[float, float, float]:
    if not result.found:
        return math.inf, math.inf, math.inf
    cost = round(result.cost / _COST_TOLERANCE)
    return cost, round(result.duration / _COST_TOLERANCE), result.depart
