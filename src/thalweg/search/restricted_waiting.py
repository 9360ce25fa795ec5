"""Earliest arrival where a ship may wait at some nodes only.

If waiting is allowed at all nodes, the earliest label of a node is the best one. Where it is not,
an early ship may meet a closed bar with no place to wait, while one that left its anchorage later
passes. The search therefore runs in rounds, each at a later departure. In each round the ship
leaves from all nodes where it may wait, that it has reached, and where it is still afloat. It sails
without waiting. Waiting nodes reached in a round are sources of later rounds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.kernels.codes import LIMIT_REQUIRED_DEPTH
from thalweg.kernels.leg.edge_sailing import NetworkArrays
from thalweg.kernels.search.label_setting import (
    NodeLabels,
    SearchQuery,
    label_setting,
    new_labels,
    new_search_workspace,
)
from thalweg.search.search_problem import (
    ROUNDING_FACTOR,
    SearchProblem,
    canal_speed,
    distance_bounds,
)
from thalweg.search.search_result import SearchResult, SearchWork
from thalweg.search.tidal_states import afloat_intervals

if TYPE_CHECKING:
    from thalweg.network.network import Network


DEPARTURE_STEP = 600.0  #: longest time between two rounds [s]
MIN_DEPARTURE_ROUNDS = 24  #: ... and at least so many over the time considered
_TIME_TOLERANCE = 1e-6  # arrivals closer than this are one [s]
_BISECTIONS = 10  # of the step before the best round, in which an earlier one is searched


class WaitInterval(NamedTuple):
    """A wait at a node: its begin and latest end [s], and the round that reached the node."""

    arrive: float
    until: float
    round_index: int


class DepartureRound(NamedTuple):
    """One round: its departure [s], and the wait at each node it leaves from."""

    time: float
    stays: dict[int, WaitInterval]


@dataclass
class WaitingSearch:
    """The state of the search after some rounds.

    Attributes
    ----------
    depart, horizon : [s].
    stays : By node, one for each time it is afloat.
    counts, refused : Of all searches.
    """

    network: Network
    given: SearchProblem
    goal: int
    depart: float
    horizon: float
    stays: dict[int, list[WaitInterval]] = field(default_factory=dict)
    rounds: list[DepartureRound] = field(default_factory=list)
    counts: NDArray[np.int64] = field(default_factory=lambda: np.zeros(3, np.int64))
    refused: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    def present(self, time: float) -> dict[int, WaitInterval]:
        """Return the nodes where a ship can be at a time, and how it came there."""
        found = {}
        for node, stays in self.stays.items():
            here = [s for s in stays if s.arrive <= time <= s.until]
            if here:
                found[node] = here[0]
        return found

    def search_from(
        self, time: float, sources: Sequence[int], goal: int, horizon: float
    ) -> NodeLabels:
        """Sail without waiting from several nodes at one time."""
        start = len(self.given.network.station)
        arrays = _with_common_source(self.given.network, sources, max(self.goal, 0))
        return self.labels_from_state(arrays, start, time, goal, horizon, wait=False)

    def labels_from_state(
        self,
        arrays: NetworkArrays,
        start: int,
        time: float,
        goal: int,
        horizon: float,
        *,
        wait: bool,
    ) -> NodeLabels:
        """Search from one state of a network."""
        count = len(arrays.station)
        away = np.zeros(count)
        if goal >= 0:
            lat, lon = self.network.lat, self.network.lon
            bounds = distance_bounds(lat, lon, float(lat[goal]), float(lon[goal]))
            away[: self.network.n_nodes] = bounds
        least_time_per_metre = ROUNDING_FACTOR / max(self.given.fastest, canal_speed(self.network))
        query = SearchQuery(
            start=start, goal=goal, depart=time, horizon=horizon, by_distance=False, wait=wait,
            slowness=ROUNDING_FACTOR / self.given.fastest, per_metre=least_time_per_metre,
        )  # fmt: skip
        labels, memory = new_labels(count), new_search_workspace(count)
        label_setting(arrays, self.given.sea, self.given.ship, query, away, labels, memory)
        self.counts = self.counts + memory.counts[: len(self.counts)]
        if not len(self.refused):
            self.refused = np.zeros_like(memory.refused)
        self.refused = self.refused + memory.refused
        return labels


def waiting_is_restricted(network: Network) -> bool:
    """Return whether a ship may wait at some nodes but not at all of them."""
    return not bool(np.all(network.can_wait))


def earliest_arrival_with_restricted_waiting(
    network: Network, given: SearchProblem, *, start: int, goal: int, depart: float,
    arrive_by: float | None = None, step: float = DEPARTURE_STEP,
) -> SearchResult:  # fmt: skip
    """Find the path of least time where waiting is allowed at some nodes only.

    Parameters
    ----------
    network : Its ``can_wait`` states where, of the start too.
    given : Gathered without times afloat (``ends=None``).
    depart : [s].
    arrive_by : [s].
    step : Longest time between two rounds [s].

    Returns
    -------
    SearchResult
        Its cost is the time from departure to arrival [s], infinite without a path. Penalty factors
        change the order in which a single round settles nodes; the cost does not contain them.

    Notes
    -----
    Exact on the network except for the times of the rounds: the last wait ends within a thousandth
    of a step of the best moment, earlier waits within a step. An opening between rounds that is
    shorter than a step can be missed. The rounds end once a ship that may wait anywhere would
    arrive no sooner; in open water one round is enough.
    """
    horizon = math.inf if arrive_by is None else float(arrive_by)
    end = min(horizon, float(given.sea.times[-1]))
    search = WaitingSearch(network, given, goal, depart, end)
    search.stays[start] = [
        WaitInterval(depart, math.inf if network.can_wait[start] else depart, -1)
    ]
    afloat = _safe_intervals(network, given, start)
    reached = np.full(network.n_nodes, math.inf)
    best, best_round = math.inf, -1
    least = _arrival_with_unrestricted_waiting(search, start)
    for time in _departures(depart, end, step):
        sources = search.present(time)
        if time >= min(best, end) or _arrival_lower_bound(search, sources, time) >= best:
            break
        if search.rounds and (best <= least + _TIME_TOLERANCE or least == math.inf):
            break
        search.rounds.append(DepartureRound(float(time), sources))
        safe = all(any(s.until == math.inf for s in search.stays.get(n, ())) for n in afloat)
        labels = search.search_from(
            float(time), list(sources), goal if safe else -1, min(end, best)
        )
        arrival = labels.time[: network.n_nodes]
        settled = labels.settled[: network.n_nodes]
        np.minimum(reached, np.where(settled, arrival, math.inf), out=reached)
        _record_waits(search, arrival, settled, afloat)
        if settled[goal] and arrival[goal] < best:
            best, best_round = float(arrival[goal]), len(search.rounds) - 1
    if best_round >= 0:
        best_round = _refine_departure(search, best_round, best)
    return _assemble_result(search, start, best_round, reached)


def _arrival_with_unrestricted_waiting(search: WaitingSearch, start: int) -> float:
    """Return the arrival of a ship that may wait anywhere, afloat or not: a lower bound [s]."""
    network = search.given.network
    free = network._replace(
        can_wait=np.ones_like(network.can_wait), factor=np.ones_like(network.factor)
    )
    labels = search.labels_from_state(
        free, start, search.depart, search.goal, search.horizon, wait=True
    )
    return float(labels.time[search.goal])


def _departures(depart: float, end: float, step: float) -> FloatArray:
    span = max(end - depart, 0.0)
    count = max(MIN_DEPARTURE_ROUNDS, math.ceil(span / step))
    return np.asarray(depart + np.arange(count + 1) * (span / count if count else 0.0))


def _arrival_lower_bound(
    search: WaitingSearch, sources: dict[int, WaitInterval], time: float
) -> float:
    """Return a lower bound of the arrival of any round that leaves now [s]."""
    network, goal = search.network, search.goal
    nodes = np.flatnonzero(network.can_wait)
    nodes = nodes[nodes != goal]  # who is there leaves no more
    nodes = np.union1d(nodes, list(sources)).astype(np.int64)
    lat, lon = network.lat, network.lon
    away = distance_bounds(lat[nodes], lon[nodes], float(lat[goal]), float(lon[goal]))
    fastest = max(search.given.fastest, canal_speed(network))
    return time + float(away.min()) * ROUNDING_FACTOR / fastest if len(nodes) else math.inf


def _safe_intervals(network: Network, given: SearchProblem, start: int) -> dict[int, FloatArray]:
    """Return the times (begin, end) during which a ship is safely afloat at each waiting node."""
    nodes = np.flatnonzero(network.can_wait)
    nodes = nodes[nodes != start]
    always = np.array([[-math.inf, math.inf]])
    required = float(given.ship.limits[LIMIT_REQUIRED_DEPTH])
    spans = afloat_intervals(given.network, given.sea, required, nodes)
    if spans is None:
        return {int(node): always for node in nodes}
    return {
        int(node): np.column_stack([spans.begin[spans.node == node], spans.end[spans.node == node]])
        for node in nodes
    }


def _record_waits(
    search: WaitingSearch,
    arrival: FloatArray,
    settled: NDArray[np.bool_],
    afloat: dict[int, FloatArray],
) -> None:
    """Record the waits that the last round makes possible, if none is known as early."""
    round_index = len(search.rounds) - 1
    for node, spans in afloat.items():
        if not settled[node] or node == search.goal:
            continue
        time = float(arrival[node])
        span = spans[(spans[:, 0] <= time) & (time <= spans[:, 1])]
        if not len(span):
            continue
        stays = search.stays.setdefault(node, [])
        same = [s for s in stays if s.until == span[0, 1]]
        if same and same[0].arrive <= time:
            continue
        search.stays[node] = [s for s in stays if s.until != span[0, 1]]
        search.stays[node].append(WaitInterval(time, float(span[0, 1]), round_index))


def _refine_departure(search: WaitingSearch, round_index: int, best: float) -> int:
    """Look between the best round and the one before for an earlier one; return the best."""
    if round_index == 0:
        return round_index
    low, high = search.rounds[round_index - 1].time, search.rounds[round_index].time
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        sources = search.present(middle)
        labels = search.search_from(middle, list(sources), search.goal, best)
        if labels.settled[search.goal] and labels.time[search.goal] <= best:
            best, high = float(labels.time[search.goal]), middle
            search.rounds.append(DepartureRound(middle, sources))
            round_index = len(search.rounds) - 1
        else:
            low = middle
    return round_index


def _assemble_result(
    search: WaitingSearch, start: int, round_index: int, reached: FloatArray
) -> SearchResult:
    """Assemble the path backwards from the goal, wait by wait."""
    nodes: list[int] = []
    arrive: list[float] = []
    leave: list[float] = []
    to = search.goal
    while round_index >= 0:
        sent = search.rounds[round_index]
        labels = search.search_from(sent.time, list(sent.stays), to, math.inf)
        path = _path(labels, to, len(search.given.network.station))
        times = labels.time[path]
        wait = sent.stays[path[0]]
        nodes = [*path, *nodes[1:]]
        arrive = [wait.arrive, *times[1:].tolist(), *arrive[1:]]
        leave = [sent.time, *times[1:-1].tolist(), *(leave or [float(times[-1])])]
        to, round_index = path[0], wait.round_index
    work = SearchWork.of(search.counts, search.refused)
    lat, lon = search.network.lat, search.network.lon
    known = np.flatnonzero(np.isfinite(reached))
    goal = search.goal
    away = distance_bounds(lat[known], lon[known], float(lat[goal]), float(lon[goal]))
    return SearchResult(
        path=np.array(nodes, np.int64),
        path_arrive=np.array(arrive),
        path_depart=np.array(leave),
        cost=arrive[-1] - search.depart if nodes else math.inf,
        node_arrival=reached,
        nearest_node=int(known[np.argmin(away)]) if len(known) else start,
        work=work,
    )


def _path(labels: NodeLabels, goal: int, source: int) -> list[int]:
    """Return the nodes from the first after the source to the goal."""
    nodes = [goal]
    while int(labels.before[nodes[-1]]) != source:
        nodes.append(int(labels.before[nodes[-1]]))
    return nodes[::-1]


def _with_common_source(network: NetworkArrays, nodes: Sequence[int], place: int) -> NetworkArrays:
    """Return the network with one state more, from which all given nodes are reached at once."""
    edges = len(nodes)

    def more(values: NDArray, extra: object) -> NDArray:  # type: ignore[type-arg]
        return np.append(values, np.full(edges, extra)).astype(values.dtype)

    return network._replace(
        indptr=np.append(network.indptr, network.indptr[-1] + edges),
        target=np.append(network.target, np.asarray(nodes)).astype(network.target.dtype),
        length=more(network.length, 0.0),
        course=more(network.course, 0.0),
        depth=more(network.depth, math.inf),
        factor=more(network.factor, 1.0),
        fixed_time=more(network.fixed_time, 0.0),
        via_ptr=np.append(network.via_ptr, np.full(edges, network.via_ptr[-1])),
        can_wait=np.append(network.can_wait, False),
        station=np.append(network.station, place).astype(network.station.dtype),
        opens=np.append(network.opens, -math.inf),
        closes=np.append(network.closes, math.inf),
        until=np.append(network.until, math.inf),
    )
