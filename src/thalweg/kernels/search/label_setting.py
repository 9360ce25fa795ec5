"""Time-dependent label setting on a network: earliest arrival or least distance."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    ARRIVE_BY,
    CHANNEL_COUNT,
    LIMIT_REQUIRED_DEPTH,
    OK,
    OUTSIDE_PERIOD,
    STATUS_COUNT,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined_by_numba
from thalweg.kernels.leg.edge_sailing import (
    MarchCutoff,
    ShipOnEdges,
    interval_of,
    least_time,
    sample_station,
)
from thalweg.kernels.search import heap
from thalweg.kernels.search.edge_departure import WaitingTerms, best_edge_departure
from thalweg.kernels.search.field_bounds import never_deep_enough


class SearchQuery(NamedTuple):
    """One search of a network.

    Attributes
    ----------
    start, goal : States; goal -1 reaches everything.
    depart : [s].
    horizon : Latest arrival anywhere [s]; inf for none.
    by_distance : Cost is length times penalty factor [m], not time times penalty factor [s].
    wait : Whether waiting is allowed at all (nodes must allow it too).
    slowness : Lower bound of the time per metre under way [s/m].
    per_metre : Lower bound of the cost per metre of geodesic distance to the goal.
    """

    start: int
    goal: int
    depart: float
    horizon: float
    by_distance: bool
    wait: bool
    slowness: float
    per_metre: float


class NodeLabels(NamedTuple):
    """What a search found for every state; the unsettled ones hold upper bounds.

    Attributes
    ----------
    cost : float64[N]
        Time [s] or length [m], times penalty factors; inf where not reached.
    time : float64[N]
        Arrival [s]; inf where not reached.
    before : int32[N]
        The state before it; -1 for none.
    departed : float64[N]
        Departure from there [s].
    settled : bool[N]
    """

    cost: np.ndarray
    time: np.ndarray
    before: np.ndarray
    departed: np.ndarray
    settled: np.ndarray


class SearchWorkspace(NamedTuple):
    """Memory of one search.

    Attributes
    ----------
    nodes : int32[N]
        States in the heap, with their ``keys`` (float64[N]) and the ``place`` of each state in it
        (int32[N]; -1 outside).
    samples : float64[4, CHANNEL_COUNT]
        Values of the sea.
    counts : int64[3]
        By `SETTLED`, `RELAXED` and `SAILED`.
    refused : int64[STATUS_COUNT]
        Edges refused, by status.
    """

    nodes: np.ndarray
    keys: np.ndarray
    place: np.ndarray
    samples: np.ndarray
    counts: np.ndarray
    refused: np.ndarray


SETTLED, RELAXED, SAILED = 0, 1, 2  # entries of `SearchWorkspace.counts`


def new_labels(n_nodes):
    """Return labels of nodes none of which is reached."""
    return NodeLabels(
        np.full(n_nodes, math.inf),
        np.full(n_nodes, math.inf),
        np.full(n_nodes, -1, np.int32),
        np.full(n_nodes, math.nan),
        np.zeros(n_nodes, np.bool_),
    )


def new_search_workspace(n_nodes):
    """Return the memory of one search."""
    return SearchWorkspace(
        np.empty(n_nodes, np.int32),
        np.empty(n_nodes),
        np.full(n_nodes, -1, np.int32),
        np.full((4, CHANNEL_COUNT), math.nan),
        np.zeros(3, np.int64),
        np.zeros(STATUS_COUNT, np.int64),
    )


@inlined_by_numba
def _longest_useful_time(query, labels, node, to, length, quickest, factor, goal_distance):
    """Return how much waiting plus weighted sailing [s] from a node to a state may at most be.

    Not positive: of no use.
    """
    cost, time = labels.cost[node], labels.time[node]
    if query.by_distance:
        here = cost + length * factor
        known = labels.cost[to]
        if here > known or (here == known and time + quickest >= labels.time[to]):
            return -1.0
        if query.goal >= 0 and here + goal_distance * query.per_metre > labels.cost[query.goal]:
            return -1.0
        latest = query.horizon - time
        return min(latest, labels.time[to] - time) if here == known else latest
    enough = labels.cost[to] - cost
    if query.goal >= 0:
        rest = goal_distance * query.per_metre
        enough = min(enough, labels.cost[query.goal] - cost - rest)
    return enough if quickest * factor < enough else -1.0


@inlined_by_numba
def _best_departure(world, query, node, edge, k, time, enough, work):
    """Return the best use of an edge from a node since a time, as an `EdgeDeparture`."""
    network = world.network
    factor = 1.0 if query.by_distance else float(network.factor[edge])
    latest = math.inf if query.by_distance else time + enough / factor
    cutoff = MarchCutoff(latest, query.slowness)
    quickest = least_time(network, edge, query.slowness)
    may_wait = query.wait and network.can_wait[node]
    until = max(time, min(network.until[node], query.horizon - quickest))
    terms = WaitingTerms(may_wait, until, factor, quickest, enough)
    return best_edge_departure(world, edge, network.station[node], k, time, cutoff, terms, work)


@inlined_by_numba
def _relax_edges(world, query, distances, labels, memory, node, k, size):
    """Improve the labels of the heads of a node's edges; return the size of the heap."""
    network = world.network
    cost, time = labels.cost[node], labels.time[node]
    required = world.ship.limits[LIMIT_REQUIRED_DEPTH]
    for edge in range(network.indptr[node], network.indptr[node + 1]):
        to = network.target[edge]
        if labels.settled[to]:
            continue
        length, factor, left = network.length[edge], float(network.factor[edge]), distances[to]
        quickest = least_time(network, edge, query.slowness)
        enough = _longest_useful_time(query, labels, node, to, length, quickest, factor, left)
        if enough <= 0.0:
            continue
        memory.counts[SAILED] += 1
        status = OK
        departure, arrival = time, math.inf
        if required > -math.inf:
            status = never_deep_enough(network, world.sea, edge, required)
        if status == OK:
            departure, arrival, status = _best_departure(
                world, query, node, edge, k, time, enough, memory.samples
            )
        if status != OK:
            memory.refused[status] += 1
            continue
        if arrival == math.inf:  # not useful
            continue
        if arrival > query.horizon:
            memory.refused[ARRIVE_BY] += 1
            continue
        new = cost + length * factor
        if not query.by_distance:
            new = cost + (departure - time) + factor * (arrival - departure)
        known = labels.cost[to]
        if new < known or (new == known and arrival < labels.time[to]):
            labels.cost[to], labels.time[to] = new, arrival
            labels.before[to], labels.departed[to] = node, departure
            key = new + left * query.per_metre
            size = heap.push_or_lower(memory.nodes, memory.keys, memory.place, size, to, key)
    return size


@allocation_free
def label_setting(network, sea, ship, query, distances, labels, memory):
    """Settle nodes in order of cost, from one start, until the goal is settled.

    Parameters
    ----------
    network, sea, ship : NetworkArrays, SeaArrays, ShipArrays
    query : SearchQuery
    distances : float64[M]
        Lower bound of the distance from each state to the goal [m], obeying the triangle
        inequality with the edge lengths; zeros make the search Dijkstra's.
    labels : NodeLabels
        Filled. Nodes may be reached before, by ways that this search may improve; a cost without a
        time is a bound only.
    memory : Workspace
        Work space; its counts are filled: how many nodes were settled, how many edges left them,
        how many of these were sailed because they could be useful, and how many of these were
        refused for each reason.

    Notes
    -----
    Cost by time is exact if every edge is FIFO (a later departure arrives later), which waiting
    provides, and every penalty factor is 1. With other factors, and for cost by distance, one label
    per node is exact only if an earlier arrival is never worse and the time does not change which
    edges are open; of equal costs the earlier time is used.

    A ship waits only while it stays afloat. A node that falls dry has one state for each interval
    in which it is afloat, so that an arrival at an earlier tide does not dominate one at a later
    tide.
    """
    world = ShipOnEdges(network, sea, ship)
    nodes, keys, place, counts = memory.nodes, memory.keys, memory.place, memory.counts
    labels.cost[query.start], labels.time[query.start] = 0.0, query.depart
    size = 0
    for reached in range(labels.time.shape[0]):
        if labels.time[reached] < math.inf:
            key = labels.cost[reached] + distances[reached] * query.per_metre
            size = heap.push_or_lower(nodes, keys, place, size, reached, key)
    while size > 0:
        node, _, size = heap.pop_least(nodes, keys, place, size)
        labels.settled[node] = True
        counts[SETTLED] += 1
        if node == query.goal:
            break
        degree = network.indptr[node + 1] - network.indptr[node]
        counts[RELAXED] += degree
        time = labels.time[node]
        k = interval_of(sea.times, time)
        if k < 0:
            memory.refused[OUTSIDE_PERIOD] += degree
            continue
        sample_station(sea, network.station[node], k, time, memory.samples[0])
        size = _relax_edges(world, query, distances, labels, memory, node, k, size)
