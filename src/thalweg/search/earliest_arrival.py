"""The earliest arrival (or the shortest path) on a network through time-dependent water."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.objective import SingleSettingObjective
from thalweg.kernels.search.label_setting import (
    NodeLabels,
    SearchQuery,
    SearchWorkspace,
    label_setting,
    new_labels,
    new_search_workspace,
)
from thalweg.search.restricted_waiting import (
    earliest_arrival_with_restricted_waiting,
    waiting_is_restricted,
)
from thalweg.search.search_problem import (
    ROUNDING_FACTOR,
    SearchProblem,
    ShipOnNetwork,
    canal_speed,
    distance_bounds,
    make_search_problem,
)
from thalweg.search.search_result import SearchResult, SearchWork

if TYPE_CHECKING:
    from thalweg.network.network import Network

Method = Literal["astar", "dijkstra"]


@dataclass(frozen=True)
class ArrivalQuery:
    """A query of `earliest_arrival` on a network; the attributes have the same meaning there.

    Attributes
    ----------
    start, goal : Nodes; a goal of None (or -1) settles everything that can be reached.
    depart, arrive_by : [s].
    objective : {"time", "distance"}
    method : {"astar", "dijkstra"}
    """

    start: int
    goal: int | None
    depart: float
    objective: SingleSettingObjective = "time"
    wait: bool = True
    arrive_by: float | None = None
    method: Method = "astar"

    @property
    def goal_node(self) -> int:
        """The goal; -1 if there is none."""
        return -1 if self.goal is None else int(self.goal)


_ACCURACY_OF_WAITS: Final = 1.0  # of a path, within which one without waits is as good [s]


def earliest_arrival(
    ship_on_network: ShipOnNetwork,
    *,
    start: int,
    goal: int | None,
    depart: float,
    objective: SingleSettingObjective = "time",
    wait: bool = True,
    arrive_by: float | None = None,
    method: Method = "astar",
) -> SearchResult:
    """Find the path of least time or least distance from one node of a network to another.

    Parameters
    ----------
    ship_on_network : ShipOnNetwork
        The network, the sea frozen at its stations, and the ship at one setting.
    start, goal : int
        Nodes. A goal of None (or -1) settles everything that can be reached.
    depart : float
        Time at the start [s].
    objective : {"time", "distance"}
    wait : bool
        Whether the ship may wait at nodes that allow it.
    arrive_by : float, optional
        No node is reached after this [s].
    method : {"astar", "dijkstra"}
        Both give the same cost; A* settles fewer nodes.

    Returns
    -------
    SearchResult
        ``found`` is False when there is no path; ``refused`` then says why.

    Raises
    ------
    InputError
        If a node, the departure or the objective does not exist, or the parts do not fit together.

    Notes
    -----
    By time and with penalty factors of 1 the result is exact on the network as long as edges keep
    order (a later departure arrives later); waiting provides that where it is allowed, with the
    departures of `thalweg.kernels.search.edge_departure.wait_for_edge`: limits open and close at
    the roots of fields that are linear in time.
    Elsewhere `thalweg.search.fifo.fifo_report` measures how far order is broken. By distance, or
    with other penalty factors, one label per node is exact as long as the time of passage does not
    decide which edges are open; ties go to the earlier arrival.

    A search without waits comes first where a ship may wait: its cost, and a second for the
    accuracy of departures after waits, bounds the search with waits, and its path is the answer
    where no wait is better.

    A ship waits only while it stays afloat at the required depth, except at the start; a node that
    falls dry has a label for each time it is afloat (`thalweg.search.tidal_states`). Where it may
    not wait at every node, time is minimised by rounds from where it may
    (`thalweg.search.restricted_waiting`).

    A* uses a lower bound of the geodesic distance to the goal divided by the largest speed over
    ground (top speed plus largest current in the fields, or what a canal gives if that is more),
    which obeys the triangle inequality. Edges of fixed time are passed in that time whatever the
    sea is.
    """
    network = ship_on_network.network
    arrival_query = ArrivalQuery(start, goal, depart, objective, wait, arrive_by, method)
    check_query(network.n_nodes, arrival_query)
    node = arrival_query.goal_node
    restricted = wait and node >= 0 and objective == "time" and waiting_is_restricted(network)
    ends = (start, node) if wait and not restricted else None
    given = make_search_problem(ship_on_network, ends=ends)
    if restricted:
        return earliest_arrival_with_restricted_waiting(
            network, given, start=int(start), goal=node, depart=float(depart),
            arrive_by=arrive_by,
        )  # fmt: skip
    return solve_earliest_arrival(network, given, arrival_query)


def solve_earliest_arrival(
    network: Network, given: SearchProblem, arrival_query: ArrivalQuery, *, shortened: float = 1.0
) -> SearchResult:
    """Find the earliest arrival for a prepared problem; see `earliest_arrival`.

    Parameters
    ----------
    shortened : Least ratio of an edge length to the geodesic between its nodes.
    """
    check_query(network.n_nodes, arrival_query)
    goal, by_distance = arrival_query.goal_node, arrival_query.objective == "distance"
    station = given.network.station
    slowness = ROUNDING_FACTOR / given.fastest
    least_time_per_metre = ROUNDING_FACTOR / max(given.fastest, canal_speed(network))
    away = np.zeros(len(station))
    lat, lon = network.stations.lat, network.stations.lon
    if goal >= 0 and arrival_query.method == "astar":
        to = float(lat[goal]), float(lon[goal])
        away = shortened * distance_bounds(network.lat, network.lon, *to)[station]
    query = SearchQuery(
        start=int(arrival_query.start),
        goal=goal,
        depart=float(arrival_query.depart),
        horizon=math.inf if arrival_query.arrive_by is None else float(arrival_query.arrive_by),
        by_distance=by_distance,
        wait=bool(arrival_query.wait),
        slowness=slowness,
        per_metre=ROUNDING_FACTOR if by_distance else least_time_per_metre,
    )
    labels, memory = new_labels(len(station)), new_search_workspace(len(station))
    direct = None
    if query.wait and not by_distance:
        # what a ship needs that never waits: waits that make a voyage longer are not looked at
        direct, spent = new_labels(len(station)), new_search_workspace(len(station))
        at_once = query._replace(wait=False)
        label_setting(given.network, given.sea, given.ship, at_once, away, direct, spent)
        if goal < 0:
            labels = direct._replace(settled=labels.settled)
        elif direct.settled[goal]:
            labels.cost[goal] = direct.cost[goal] + _ACCURACY_OF_WAITS
    label_setting(given.network, given.sea, given.ship, query, away, labels, memory)
    if direct is not None:
        np.maximum(memory.refused, spent.refused, out=memory.refused)
        if goal >= 0 and direct.settled[goal] and not labels.cost[goal] <= direct.cost[goal]:
            labels = direct
    return _result(network, station, query, labels, memory)


def check_query(n_nodes: int, arrival_query: ArrivalQuery) -> None:
    """Raise `InputError` unless the nodes, departure, objective and method of a query exist."""
    start, goal = arrival_query.start, arrival_query.goal_node
    if not (0 <= start < n_nodes and -1 <= goal < n_nodes):
        raise InputError(
            f"A search from node {start} to node {goal} is not possible.",
            f"The network has nodes 0 to {n_nodes - 1}.",
            "Give nodes of this network.",
        )
    if not math.isfinite(arrival_query.depart):
        raise InputError(
            f"The departure {arrival_query.depart} is not a time.",
            "Departures are finite numbers of seconds since 1970-01-01T00:00Z.",
            "Give a departure.",
        )
    for kind, word, known in (
        ("objective", arrival_query.objective, ("time", "distance")),
        ("method", arrival_query.method, ("astar", "dijkstra")),
    ):
        if word not in known:
            raise InputError(
                f"There is no {kind} {word!r}.", f"Known: {', '.join(known)}.", "Give one of these."
            )


def _result(
    network: Network,
    station: NDArray[np.int32],
    query: SearchQuery,
    labels: NodeLabels,
    memory: SearchWorkspace,
) -> SearchResult:
    path = _path(labels, query)  # of states
    arrive = labels.time[path]
    leave = np.append(labels.departed[path[1:]], arrive[-1:])
    node_arrival = np.full(network.n_nodes, math.inf)
    np.minimum.at(node_arrival, station[labels.settled], labels.time[labels.settled])
    work = SearchWork.of(memory.counts, memory.refused)
    return SearchResult(
        path=station[path].astype(np.int64),
        path_arrive=arrive,
        path_depart=leave,
        cost=float(labels.cost[query.goal]) if len(path) else math.inf,
        node_arrival=node_arrival,
        nearest_node=_nearest_reached_node(network, node_arrival, query.goal),
        work=work,
    )


def _path(labels: NodeLabels, query: SearchQuery) -> NDArray[np.int64]:
    if query.goal < 0 or not labels.settled[query.goal]:
        return np.empty(0, np.int64)
    nodes = [query.goal]
    while nodes[-1] != query.start:
        nodes.append(int(labels.before[nodes[-1]]))
    return np.array(nodes[::-1], np.int64)


def _nearest_reached_node(network: Network, node_arrival: NDArray[np.float64], goal: int) -> int:
    if goal < 0:
        return -1
    reached = np.flatnonzero(np.isfinite(node_arrival))
    lat, lon = network.lat, network.lon
    away = distance_bounds(lat[reached], lon[reached], float(lat[goal]), float(lon[goal]))
    return int(reached[np.argmin(away)])
