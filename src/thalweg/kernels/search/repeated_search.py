"""Repeated earliest-arrival searches between two nodes; data independent of departure are reused.

The results are those of `thalweg.kernels.search.label_setting`. A backward search at the greatest
possible speeds gives lower bounds of the time to the goal; a known departure gives an upper bound
of the arrival. Nodes that fall dry have a list of intervals afloat, not a copy of their edges for
each interval.
"""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import (
    CHANNEL_COUNT,
    CURRENT_EAST,
    CURRENT_NORTH,
    OK,
)
from thalweg.kernels.compilation.decorators import allocation_free, inlined_by_numba
from thalweg.kernels.leg.edge_sailing import MarchCutoff, ShipOnEdges, interval_of, sample_station
from thalweg.kernels.search import heap
from thalweg.kernels.search.edge_departure import WaitingTerms, best_edge_departure

CURRENT_DIRECTIONS = 16  # directions for which the strongest current is tabulated
_SHRINK = 1.0 - 1e-7  # so that bounds are below the exact values in single precision
_DEPTH_ROUNDING = 1e-3  # depth that rounding may hide [m]


class TravelTimeBounds(NamedTuple):
    """Lower bounds: time to the goal from every node, and of every edge [s]; inf: no path."""

    node: np.ndarray
    edge: np.ndarray


class DepartureQuery(NamedTuple):
    """One departure.

    Attributes
    ----------
    start, goal : States.
    depart : [s].
    limit : Costs above this are not useful [s].
    latest : So are later arrivals [s].
    slowness : Lower bound of the time per metre anywhere [s/m].
    wait : Whether waiting is allowed at all.
    heuristic_weight : float
        Weight of the bounds of the time to go: 1 finds the best path; more finds some path, sooner.
    most : The search gives up after settling so many nodes.
    """

    start: int
    goal: int
    depart: float
    limit: float
    latest: float
    slowness: float
    wait: bool
    heuristic_weight: float
    most: int


class ProfileWorkspace(NamedTuple):
    """Labels by state, and the memory of searches; `touched` lists what must be reset."""

    cost: np.ndarray
    time: np.ndarray
    before: np.ndarray
    departed: np.ndarray
    settled: np.ndarray
    nodes: np.ndarray
    keys: np.ndarray
    place: np.ndarray
    touched: np.ndarray
    counts: np.ndarray
    samples: np.ndarray


TOUCHED, SETTLED, SAILED = 0, 1, 2  # entries of `ProfileWorkspace.counts`


def new_profile_workspace(count):
    """Return the memory of searches over a number of states."""
    return ProfileWorkspace(
        np.full(count, math.inf),
        np.full(count, math.inf),
        np.full(count, -1, np.int32),
        np.full(count, math.nan),
        np.zeros(count, np.bool_),
        np.empty(count, np.int32),
        np.empty(count),
        np.full(count, -1, np.int32),
        np.empty(count, np.int32),
        np.zeros(3, np.int64),
        np.full((4, CHANNEL_COUNT), math.nan),
    )


@allocation_free
def strongest_currents(sea, strongest):
    """Fill the strongest current [m/s] of every station towards each of `CURRENT_DIRECTIONS`
    directions.

    NaN is passed over; without a current they are 0.
    """
    i, j = sea.channel_index[CURRENT_EAST], sea.channel_index[CURRENT_NORTH]
    values = sea.values
    for s in range(strongest.shape[0]):
        for d in range(CURRENT_DIRECTIONS):
            strongest[s, d] = -math.inf if i >= 0 and j >= 0 else 0.0
        if i < 0 or j < 0:
            continue
        for d in range(CURRENT_DIRECTIONS // 2):
            angle = 2.0 * math.pi * d / CURRENT_DIRECTIONS
            east, north = np.float32(math.sin(angle)), np.float32(math.cos(angle))
            high, low = np.float32(-math.inf), np.float32(math.inf)
            for t in range(values.shape[1]):
                along = values[s, t, i] * east + values[s, t, j] * north
                high = max(high, along) if along == along else high
                low = min(low, along) if along == along else low
            strongest[s, d] = high + 1e-5
            strongest[s, d + CURRENT_DIRECTIONS // 2] = -low + 1e-5


@inlined_by_numba
def _station_maxima(network, sea, strongest, station, edge, course, required):
    """Return (greatest depth, strongest current along the course) ever at a station on an edge."""
    depth = math.inf
    if required > -math.inf:
        depth = min(float(network.depth[edge]) + sea.highest[station], float(sea.deepest[station]))
    sector = course * (CURRENT_DIRECTIONS / (2.0 * math.pi))
    low = math.floor(sector)
    share, gap = (
        (sector - low) * (2.0 * math.pi / CURRENT_DIRECTIONS),
        2.0 * math.pi / CURRENT_DIRECTIONS,
    )
    k = int(low) % CURRENT_DIRECTIONS
    along = math.sin(gap - share) * strongest[station, k]
    along = (along + math.sin(share) * strongest[station, (k + 1) % CURRENT_DIRECTIONS]) / math.sin(
        gap
    )
    return depth, along if along == along else -math.inf


@inlined_by_numba
def _least_slowness(caps, most, required):
    """Return the least time per metre with that depth and current [s/m]; inf if too shallow."""
    depth, along = most
    last = caps.shape[0] - 1
    speed = caps[last]
    if required > -math.inf:
        if not depth >= required - _DEPTH_ROUNDING:
            return math.inf
        if depth + _DEPTH_ROUNDING < last * SPEED_CAP_DEPTH_STEP:
            speed = caps[int(max(depth + _DEPTH_ROUNDING, 0.0) / SPEED_CAP_DEPTH_STEP)]
    speed = (speed + along) * (1.0 + 1e-6)
    return 1.0 / speed if speed > 0.0 else math.inf


@inlined_by_numba
def _larger_of_each(first, second):
    """Return the larger of each: what bounds every mixture of the two."""
    return max(first[0], second[0]), max(first[1], second[1])


SPEED_CAP_DEPTH_STEP = 0.25  # of the depths for which the greatest speed is tabulated [m]


@allocation_free
def least_edge_times(network, tails, sea, strongest, caps, required, times):
    """Fill lower bounds of the weighted time of every edge at any time [s]; inf if none opens it.

    Parameters
    ----------
    network, sea : NetworkArrays, SeaArrays
    tails : int32[E]
    strongest : float32[S, SECTORS]
        From `strongest_currents`.
    caps : float64[C]
        Greatest speed through water in depths up to ``(i + 1) * CAP_STEP`` [m/s]; the last one
        anywhere.
    required : float
        Depth [m]; -inf if none.
    times : float64[E]
    """
    for e in range(times.shape[0]):
        if network.fixed_time[e] == network.fixed_time[e]:
            times[e] = network.fixed_time[e] * float(network.factor[e]) * _SHRINK
            continue
        course, length = float(network.course[e]), network.length[e]
        most = _station_maxima(network, sea, strongest, tails[e], e, course, required)
        before = _least_slowness(caps, most, required)
        at, total = 0.0, 0.0
        for p in range(network.via_ptr[e], network.via_ptr[e + 1] + 1):
            a = b = network.target[e]
            to = 1.0
            if p < network.via_ptr[e + 1]:
                a, b, to = network.via_a[p], network.via_b[p], float(network.via_s[p])
            most = _station_maxima(network, sea, strongest, a, e, course, required)
            if b != a:  # a mixture may have the depth of the one and the current of the other
                other = _station_maxima(network, sea, strongest, b, e, course, required)
                most = _larger_of_each(most, other)
            now = _least_slowness(caps, most, required)
            total += 0.5 * (to - at) * length * (before + now)
            before, at = now, to
        times[e] = total * float(network.factor[e]) * _SHRINK


@allocation_free
def least_times_to_goal(reverse_ptr, reverse_edge, tails, times, goal, to_goal, memory):
    """Fill the least sums of edge times to the goal from every node (Dijkstra backwards).

    Parameters
    ----------
    reverse_ptr, reverse_edge : int64[N + 1], int32[E]
        The edges that arrive at each node.
    tails : int32[E]
    times : float64[E]
    goal : int
    to_goal : float64[N]
        Filled; inf where there is no path.
    memory : tuple of int32[N], float64[N], int32[N]
        Heap; its places are -1.
    """
    nodes, keys, place = memory
    for n in range(to_goal.shape[0]):
        to_goal[n] = math.inf
    to_goal[goal] = 0.0
    size = heap.push_or_lower(nodes, keys, place, 0, goal, 0.0)
    while size > 0:
        node, reached, size = heap.pop_least(nodes, keys, place, size)
        for k in range(reverse_ptr[node], reverse_ptr[node + 1]):
            edge = reverse_edge[k]
            away = reached + times[edge]
            tail = tails[edge]
            if away < to_goal[tail]:
                to_goal[tail] = away
                size = heap.push_or_lower(nodes, keys, place, size, tail, away)


@inlined_by_numba
def _relax_edges_of_state(world, states, trip, to_goal, marks, state, k, size):
    """Improve the labels of the heads of a state's edges; return the size of the heap."""
    network, node = world.network, states.node[state]
    cost, time = marks.cost[state], marks.time[state]
    may_wait, until = trip.wait and network.can_wait[node], states.until[state]
    for edge in range(network.indptr[node], network.indptr[node + 1]):
        head, factor = network.target[edge], float(network.factor[edge])
        left, least_edge_time = to_goal.node[head], to_goal.edge[edge]
        reach = min(trip.limit, marks.cost[trip.goal]) - cost - left
        for s in range(states.ptr[head], states.ptr[head + 1]):
            if not least_edge_time < reach or states.opens[s] - time >= reach:
                break
            enough = min(reach, marks.cost[s] - cost)
            if states.closes[s] <= time or marks.settled[s] or not least_edge_time < enough:
                continue
            marks.counts[SAILED] += 1
            network.opens[head], network.closes[head] = states.opens[s], states.closes[s]
            cutoff = MarchCutoff(time + enough / factor, trip.slowness)
            terms = WaitingTerms(may_wait, until, factor, least_edge_time / factor, enough)
            departure, arrival, status = best_edge_departure(
                world, edge, node, k, time, cutoff, terms, marks.samples
            )
            if status != OK or arrival == math.inf or arrival > trip.latest:
                continue
            new = cost + (departure - time) + factor * (arrival - departure)
            known = marks.cost[s]
            if new < known or (new == known and arrival < marks.time[s]):
                if known == math.inf:
                    marks.touched[marks.counts[TOUCHED]] = s
                    marks.counts[TOUCHED] += 1
                marks.cost[s], marks.time[s] = new, arrival
                marks.before[s], marks.departed[s] = state, departure
                key = new + trip.heuristic_weight * left
                size = heap.push_or_lower(marks.nodes, marks.keys, marks.place, size, s, key)
    return size


@allocation_free
def reset_workspace(marks):
    """Reset what the last search touched."""
    for i in range(marks.counts[TOUCHED]):
        s = marks.touched[i]
        marks.cost[s], marks.time[s] = math.inf, math.inf
        marks.before[s], marks.place[s] = -1, -1
        marks.settled[s] = False
    marks.counts[TOUCHED] = 0


@allocation_free
def search_departure(network, states, sea, ship, trip, to_goal, marks):
    """Search one departure; return its cost [s], inf if the goal is not reached within the limit.

    Parameters
    ----------
    network : NetworkArrays
        One state per node; its ``opens`` and ``closes`` are written to.
    states : TidalStates
    sea, ship : SeaArrays, ShipArrays
    trip : DepartureQuery
    to_goal : TravelTimeBounds
        Bounds that obey the triangle inequality with the times of edges.
    marks : ProfileWorkspace
        Holds the labels until the next `reset_workspace`, which must have been called before.
    """
    world = ShipOnEdges(network, sea, ship)
    nodes, keys, place, counts = marks.nodes, marks.keys, marks.place, marks.counts
    counts[SETTLED] = counts[SAILED] = 0
    if not to_goal.node[states.node[trip.start]] <= trip.limit:
        return math.inf
    marks.touched[0], counts[TOUCHED] = trip.start, 1
    marks.cost[trip.start], marks.time[trip.start] = 0.0, trip.depart
    size = heap.push_or_lower(
        nodes, keys, place, 0, trip.start, to_goal.node[states.node[trip.start]]
    )
    while size > 0 and counts[SETTLED] < trip.most:
        state, _, size = heap.pop_least(nodes, keys, place, size)
        marks.settled[state] = True
        counts[SETTLED] += 1
        if state == trip.goal:
            return marks.cost[state]
        node, time = states.node[state], marks.time[state]
        k = interval_of(sea.times, time)
        if k < 0:
            continue
        sample_station(sea, node, k, time, marks.samples[0])
        size = _relax_edges_of_state(world, states, trip, to_goal, marks, state, k, size)
    return math.inf


@allocation_free
def trace_departure(states, marks, trip, nodes, arrive, leave):
    """Fill the path of the last search from its end; return how many nodes it has.

    The last ``count`` entries of the outputs are filled; 0 if they are too short.
    """
    at, state = nodes.shape[0], trip.goal
    out = marks.time[state]
    while at > 0:
        at -= 1
        nodes[at], arrive[at], leave[at] = states.node[state], marks.time[state], out
        if state == trip.start:
            return nodes.shape[0] - at
        out = marks.departed[state]
        state = marks.before[state]
    return 0
