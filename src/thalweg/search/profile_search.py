"""Profile search: the routes between two places for every departure of a long period.

A project sails between the same two places hundreds of times. What does not depend on the departure
is prepared once: the network and the frozen sea as kernels see them and the strongest currents
(`PreparedNetwork`), then for each ship the bounds of the time to go and the times afloat
(`ProfileSearch`).
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.types import FloatArray
from thalweg.kernels.leg.edge_sailing import NetworkArrays
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.kernels.search import repeated_search as kernel
from thalweg.kernels.search.tidal_intervals import TidalStates
from thalweg.search.prepared_network import PreparedNetwork
from thalweg.search.restricted_waiting import (
    earliest_arrival_with_restricted_waiting,
    waiting_is_restricted,
)
from thalweg.search.search_problem import (
    ROUNDING_FACTOR,
    SearchProblem,
    check_two_nodes,
    ship_arrays,
    top_speed_through_water,
)
from thalweg.search.timed_path import (
    Profile,
    TimedPath,
    arrive_together,
    path_not_found,
    with_earlier_departure,
)

if TYPE_CHECKING:
    from thalweg.ship.tables.performance_table import PerformanceTable


_ARRIVAL_SLACK = 1e-3  # an arrival this much above a known one is still considered [s]
_HEURISTIC_WEIGHT = 1.5  # weight of the time to go in a weighted A* search ...
_MAX_SETTLED_WEIGHTED = 2000  # ... which settles at most so many nodes
_FIRST_SLACK = 3600.0  # beyond the bound, when nothing is known yet [s]


@dataclass(frozen=True, eq=False)
class ProfileSearch:
    """All paths of one ship between two nodes, each searched when it is first needed.

    Attributes
    ----------
    prepared : PreparedNetwork
    ship : ShipArrays
    states : TidalStates
        Times afloat of every node.
    to_goal : TravelTimeBounds
        Lower bounds of the time to go.
    ends : tuple of int
        Start and goal.
    slowness : float
        Lower bound of the time per metre [s/m].
    wait : bool
        Whether the ship may wait.
    """

    prepared: PreparedNetwork
    ship: ShipArrays
    states: TidalStates
    to_goal: kernel.TravelTimeBounds
    ends: tuple[int, int]
    slowness: float
    wait: bool

    @property
    def shortest(self) -> float:
        """Lower bound of the time of any path [s]; inf if no tide ever opens one."""
        return float(self.to_goal.node[self.ends[0]])

    @cached_property
    def _network(self) -> NetworkArrays:
        given = self.prepared.network
        return given._replace(opens=np.array(given.opens), closes=np.array(given.closes))

    @cached_property
    def _workspace(self) -> kernel.ProfileWorkspace:
        return kernel.new_profile_workspace(len(self.states.node))

    @cached_property
    def _path_arrays(self) -> tuple[NDArray[np.int32], FloatArray, FloatArray]:
        count = len(self.states.node)
        return np.empty(count, np.int32), np.empty(count), np.empty(count)

    def sail(
        self, depart: float, *, known: float = math.inf, arrive_by: float = math.inf
    ) -> TimedPath:
        """Find the earliest arrival of one departure.

        Parameters
        ----------
        depart : float [s]
        known : float
            An arrival that is known to be possible, or a guess [s]; it saves work.
        arrive_by : float
            Later arrivals are not useful [s].

        Returns
        -------
        TimedPath
            The same as that of `earliest_arrival`, to within ties (where the ship may wait at some
            nodes only, to within a wave of `thalweg.search.restricted_waiting`).
        """
        depart = float(depart)
        latest = min(float(arrive_by), float(self.prepared.sea.times[-1]))
        longest = (latest - depart) * self._largest_penalty
        if not (math.isfinite(depart) and self.shortest <= longest):
            return path_not_found(depart)
        limit = (
            (known - depart) * self._largest_penalty + _ARRIVAL_SLACK if known < math.inf else 0.0
        )
        search = (
            self._search_with_restricted_waiting if self._waiting_is_restricted else self._search
        )
        if known == math.inf and not self._waiting_is_restricted:
            slack = 1.6 * self.shortest + _FIRST_SLACK
            limit = self._feasible_cost(depart, min(slack, longest), latest)
        while True:
            limit = limit if limit >= self.shortest else 1.6 * self.shortest + _FIRST_SLACK
            found = search(depart, min(limit, longest), latest)
            if found.found or limit >= longest:
                return found
            limit = max(2.0 * limit, 1.6 * self.shortest + _FIRST_SLACK)

    @cached_property
    def _largest_penalty(self) -> float:
        """The largest penalty factor: what a second costs at most."""
        return float(np.max(self.prepared.network.factor, initial=1.0))

    def _feasible_cost(self, depart: float, limit: float, latest: float) -> float:
        """Return the cost [s] of a path found by weighted A*; 0 if it finds none."""
        _, cost = self._labelled(depart, limit, latest, _HEURISTIC_WEIGHT, _MAX_SETTLED_WEIGHTED)
        kernel.reset_workspace(self._workspace)
        return cost + _ARRIVAL_SLACK if cost < math.inf else 0.0

    @cached_property
    def _waiting_is_restricted(self) -> bool:
        """Whether the ship may wait at some nodes but not at all of them."""
        return self.wait and waiting_is_restricted(self.prepared.source)

    def _search_with_restricted_waiting(
        self, depart: float, limit: float, latest: float
    ) -> TimedPath:
        """Search with waiting at some nodes only (`thalweg.search.restricted_waiting`)."""
        prepared = self.prepared
        top = ROUNDING_FACTOR / self.slowness - prepared.top_current
        given = SearchProblem(prepared.network, prepared.sea, self.ship, top, prepared.top_current)
        found = earliest_arrival_with_restricted_waiting(
            prepared.source, given, start=self.ends[0], goal=self.ends[1], depart=depart,
            arrive_by=min(depart + limit, latest),
        )  # fmt: skip
        return TimedPath(
            depart, found.arrive, found.path, found.path_arrive, found.path_depart, found.settled
        )

    def _search(self, depart: float, limit: float, latest: float) -> TimedPath:
        trip, cost = self._labelled(depart, limit, latest)
        marks = self._workspace
        settled = int(marks.counts[kernel.SETTLED])
        if cost == math.inf:
            kernel.reset_workspace(marks)
            return replace(path_not_found(depart), settled=settled)
        nodes, arrive, leave = self._path_arrays
        count = kernel.trace_departure(self.states, marks, trip, nodes, arrive, leave)
        kernel.reset_workspace(marks)
        path, when, out = nodes[-count:], arrive[-count:].copy(), leave[-count:].copy()
        return TimedPath(depart, float(when[-1]), path.astype(np.int64), when, out, settled)

    def _labelled(
        self,
        depart: float,
        limit: float,
        latest: float,
        heuristic_weight: float = 1.0,
        most: int = sys.maxsize,
    ) -> tuple[kernel.DepartureQuery, float]:
        """Search one departure; return it and its cost. The marks hold its labels."""
        first = self.states.ptr
        start, goal = int(first[self.ends[0]]), int(first[self.ends[1]])
        trip = kernel.DepartureQuery(
            start,
            goal,
            depart,
            float(limit),
            latest,
            self.slowness,
            bool(self.wait),
            heuristic_weight,
            most,
        )
        sea = self.prepared.by_time
        cost = kernel.search_departure(
            self._network, self.states, sea, self.ship, trip, self.to_goal, self._workspace
        )
        return trip, float(cost)

    def profile(self, departures: ArrayLike, *, arrive_by: float = math.inf) -> Profile:
        """Find the paths of many departures.

        Parameters
        ----------
        departures : array_like
            [s], ascending.
        arrive_by : float
            Later arrivals are not useful [s].

        Returns
        -------
        Profile

        Notes
        -----
        Where a ship may wait at the start, and no edge has a penalty, arrivals never fall with the
        departure. So the last departure's arrival bounds that of those before it, and between two
        departures that arrive together all arrive together: these wait at the start and sail with
        the later one.
        """
        times = np.asarray(departures, float).ravel()
        if times.size == 0 or not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0.0):
            raise InputError("The departures do not ascend.", "Times in order [s].", "Sort them.")
        paths: dict[int, TimedPath] = {}
        waits = self.wait and bool(self.prepared.network.can_wait[self.ends[0]])
        if waits and self._largest_penalty == 1.0:
            self._halve(times, paths, arrive_by)
        else:
            for k, t in enumerate(times):
                paths[k] = self.sail(t, arrive_by=arrive_by)
        searched = len(paths)
        following = len(times) - 1
        for k in range(len(times) - 1, -1, -1):
            if k in paths:
                following = k
            else:
                paths[k] = with_earlier_departure(paths[following], float(times[k]))
        return Profile(tuple(paths[k] for k in range(len(times))), searched)

    def _halve(self, times: FloatArray, paths: dict[int, TimedPath], arrive_by: float) -> None:
        last = len(times) - 1
        for k in {0, last}:
            paths[k] = self.sail(times[k], arrive_by=arrive_by)
        open_ranges = [(0, last)] if last > 0 else []
        while open_ranges:
            low, high = open_ranges.pop()
            if high - low < 2 or arrive_together(paths[low], paths[high]):
                continue
            middle = (low + high) // 2
            later = paths[high]
            known = (
                later.arrive
                if later.arrive - times[middle] < _longest_useful_time(self)
                else math.inf
            )
            paths[middle] = self.sail(times[middle], known=known, arrive_by=arrive_by)
            open_ranges += [(low, middle), (middle, high)]


def prepare_profile_search(
    prepared: PreparedNetwork,
    table: PerformanceTable | TableArrays,
    *,
    start: int,
    goal: int,
    setting: int,
    limits: Limits,
    top_speed: float,
    wait: bool = True,
) -> ProfileSearch:
    """Prepare the paths of a ship between two nodes.

    Parameters
    ----------
    prepared : PreparedNetwork
    table : PerformanceTable or TableArrays
        Speed through water [m/s].
    start, goal : int
        Nodes.
    setting : int
    limits : Limits
    top_speed : float
        Upper bound of the ship's speed through water at this setting [m/s].
    wait : bool
        Whether the ship may wait at nodes that allow it.

    Returns
    -------
    ProfileSearch

    Raises
    ------
    InputError
        If a node or the setting does not exist, or the ship has no speed.
    """
    check_two_nodes(len(prepared.network.can_wait), start, goal)
    ship = ship_arrays(table, setting, limits)
    fastest, from_field = top_speed_through_water(prepared.sea, top_speed)
    return ProfileSearch(
        prepared,
        ship,
        prepared.tidal_states(ship, (start, goal), wait),
        prepared.time_bounds(ship, goal, fastest, from_field),
        (start, goal),
        ROUNDING_FACTOR / (fastest + prepared.top_current),
        wait,
    )


def _longest_useful_time(search: ProfileSearch) -> float:
    """Return how long a path may take for its arrival to bound an earlier one [s]."""
    return 3.0 * search.shortest + _FIRST_SLACK
