"""Time-dependent label setting on a network: earliest arrival or least distance."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels import heap
from thalweg.kernels.bare import bare, inlined
from thalweg.kernels.codes import (
    ARRIVE_BY,
    CHANNELS,
    COUNT,
    LIMIT_REQUIRED_DEPTH,
    OK,
    OUTSIDE_PERIOD,
)
from thalweg.kernels.edges import (
    interval_of,
    sail_edge,
    sample_station,
    wait_for_edge,
)
from thalweg.kernels.extremes import never_deep_enough


class Query(NamedTuple):
    """One question to a network.

    Attributes
    ----------
    start, goal : int
        States; goal -1 reaches everything.
    depart : float
        [s].
    horizon : float
        Latest arrival anywhere [s]; inf for none.
    by_distance : bool
        Cost is length times penalty factor [m], not time times penalty factor [s].
    wait : bool
        Whether waiting is allowed at all (nodes must allow it too).
    slowness : float
        Lower bound of the time per metre under way [s/m].
    per_metre : float
        Lower bound of the cost per metre of geodesic distance to the goal.
    """

    start: int
    goal: int
    depart: float
    horizon: float
    by_distance: bool
    wait: bool
    slowness: float
    per_metre: float


class Labels(NamedTuple):
    """What a search found for every node; the unsettled ones hold upper bounds."""

    cost: np.ndarray
    time: np.ndarray
    before: np.ndarray
    departed: np.ndarray
    settled: np.ndarray


class Workspace(NamedTuple):
    """Memory of one search: the heap, samples of the sea, and counts (`SETTLED`, ...)."""

    nodes: np.ndarray
    keys: np.ndarray
    place: np.ndarray
    samples: np.ndarray
    counts: np.ndarray
    refused: np.ndarray


SETTLED, RELAXED, SAILED = 0, 1, 2  # entries of `Workspace.counts`


def new_labels(n_nodes):
    """Return labels of nodes none of which is reached."""
    return Labels(
        np.full(n_nodes, math.inf),
        np.full(n_nodes, math.inf),
        np.full(n_nodes, -1, np.int32),
        np.full(n_nodes, math.nan),
        np.zeros(n_nodes, np.bool_),
    )


def new_workspace(n_nodes):
    """Return the memory of one search."""
    return Workspace(
        np.empty(n_nodes, np.int32),
        np.empty(n_nodes),
        np.full(n_nodes, -1, np.int32),
        np.full((4, CHANNELS), math.nan),
        np.zeros(3, np.int64),
        np.zeros(COUNT, np.int64),
    )


@inlined
def _worth(query, cost, time, length, factor, goal_distance, labels, node):
    """Return how much waiting plus weighted sailing [s] may at most be; not positive: no use."""
    quickest = length * query.slowness
    if query.by_distance:
        here = cost + length * factor
        known = labels.cost[node]
        if here > known or (here == known and time + quickest >= labels.time[node]):
            return -1.0
        if query.goal >= 0 and here + goal_distance * query.per_metre > labels.cost[query.goal]:
            return -1.0
        latest = query.horizon - time
        return min(latest, labels.time[node] - time) if here == known else latest
    enough = labels.cost[node] - cost
    if query.goal >= 0:
        rest = goal_distance * query.per_metre
        enough = min(enough, labels.cost[query.goal] - cost - rest)
    return enough if quickest * factor < enough else -1.0


@bare
def label_setting(network, sea, ship, query, distances, labels, memory):
    """Settle nodes in order of cost, from one start, until the goal is settled.

    Parameters
    ----------
    network, sea, ship : NetworkArrays, SeaArrays, ShipArrays
    query : Query
    distances : float64[M]
        Lower bound of the distance from each state to the goal [m], obeying the triangle
        inequality with the edge lengths; zeros make the search Dijkstra's.
    labels : Labels
        Filled; nothing may be reached before.
    memory : Workspace
        Work space; its counts are filled: how many nodes were settled, how many edges left them,
        how many of these were sailed because they could be of use, and how many of these were
        refused for each reason.

    Notes
    -----
    Cost by time is exact when every edge keeps order (later departure, later arrival), which
    waiting provides, and every penalty factor is 1. With other factors, and for cost by distance,
    one label per node is exact only as far as being there earlier is never worse and the time
    does not change which edges are open; ties of cost go to the earlier time.

    A ship waits only while it stays afloat; a node that falls dry is one state for each time it is
    afloat, so that arriving at a later tide is not lost to arriving at an earlier one.
    """
    nodes, keys, place, work, counts, refused = memory
    required = ship.limits[LIMIT_REQUIRED_DEPTH]
    limited = required > -math.inf
    labels.cost[query.start] = 0.0
    labels.time[query.start] = query.depart
    size = heap.put(nodes, keys, place, 0, query.start, 0.0)
    while size > 0:
        node, _, size = heap.take(nodes, keys, place, size)
        labels.settled[node] = True
        counts[SETTLED] += 1
        if node == query.goal:
            break
        station = network.station[node]
        cost, time = labels.cost[node], labels.time[node]
        first, last = network.indptr[node], network.indptr[node + 1]
        counts[RELAXED] += last - first
        k = interval_of(sea.times, time)
        if k < 0:
            refused[OUTSIDE_PERIOD] += last - first
            continue
        sample_station(sea, station, k, time, work[0])
        pause = sea.times[k + 1] - time  # until the next time of the data
        wait = query.wait and network.can_wait[node]
        for edge in range(first, last):
            to = network.target[edge]
            if labels.settled[to]:
                continue
            length, factor = network.length[edge], float(network.factor[edge])
            left = distances[to]
            enough = _worth(query, cost, time, length, factor, left, labels, to)
            if enough <= 0.0:
                continue
            counts[SAILED] += 1
            if limited:
                status = never_deep_enough(network, sea, edge, required)
                if status != OK:
                    refused[status] += 1
                    continue
            quickest = length * query.slowness
            weight = 1.0 if query.by_distance else factor
            departure = time
            latest = math.inf if query.by_distance else time + enough / factor
            arrival, status = sail_edge(
                network,
                sea,
                ship,
                edge,
                k,
                time,
                work[0],
                work[2],
                work[3],
                latest,
                query.slowness,
            )
            useful = min(enough, weight * (arrival - time))
            if wait and (status != OK or pause + weight * quickest < useful):
                departure, arrival, status = wait_for_edge(
                    network,
                    sea,
                    ship,
                    edge,
                    station,
                    k,
                    time,
                    network.until[node],
                    arrival,
                    status,
                    weight,
                    quickest,
                    enough,
                    work,
                )
            if status != OK:
                refused[status] += 1
                continue
            if arrival == math.inf:
                continue
            if arrival > query.horizon:
                refused[ARRIVE_BY] += 1
                continue
            if query.by_distance:
                new = cost + length * factor
            else:
                new = cost + (departure - time) + factor * (arrival - departure)
            known = labels.cost[to]
            if new < known or (new == known and arrival < labels.time[to]):
                labels.cost[to] = new
                labels.time[to] = arrival
                labels.before[to] = node
                labels.departed[to] = departure
                key = new + left * query.per_metre
                size = heap.put(nodes, keys, place, size, to, key)
