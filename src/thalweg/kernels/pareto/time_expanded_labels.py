"""Time-expanded dynamic programming: the least cost at every node in every bin of time."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.leg.edge_sailing import interval_of, sample_station
from thalweg.kernels.pareto.edge_tables import fill_edge_table, sail_edge_priced

VISITED, RELAXED, PRUNED, WAITED, STARTED, ACTIVE, SLICE = 0, 1, 2, 3, 4, 5, 6
COUNTER_COUNT = 7  # entries of `ActiveNodes.counts`


class BinLabels(NamedTuple):
    """The cheapest known arrival at every node in every bin of time.

    Attributes
    ----------
    first, last : int32[N]
        First and last bin of a node; none when last < first.
    place : int64[N]
        Where the bins of a node start in the following.
    cost : float32[L]
        inf where there is none.
    when : float32[L, 2]
        True time [s after departure]; departure from the previous node, NaN if on arrival.
    source : int32[L, 2]
        Label it comes from, -1 at the start; edge times number of settings plus setting.
    best : float64[N]
        Least cost so far minus ``waiting_cost_rate`` times time.
    best_at : float64[N, 2]
        Time [s after departure] and label of it.
    done : float64[N, 2]
        Bin visited last and the cost then.
    """

    first: np.ndarray
    last: np.ndarray
    place: np.ndarray
    cost: np.ndarray
    when: np.ndarray
    source: np.ndarray
    best: np.ndarray
    best_at: np.ndarray
    done: np.ndarray


class LabelTarget(NamedTuple):
    """Where labels are to lead, and bounds of what is still to come.

    Attributes
    ----------
    goal : int
    upper : float64[B + 1]
        Least cost known of arriving at the goal by the start of each bin; inf for none.
    time_to_go : float64[N]
        Lower bound of the time to the goal [s].
    rates : float64[R]
        Prices of a second, 0 first.
    floor : float64[N, R]
        Lower bound of the cost plus such a price times the time to the goal.
    """

    goal: int
    upper: np.ndarray
    time_to_go: np.ndarray
    rates: np.ndarray
    floor: np.ndarray


class TimeBins(NamedTuple):
    """How time is divided: width of the bins [s], latest arrival [s], bins; whether one waits."""

    width: float
    latest: float
    count: int
    group: int
    wait: bool


class ActiveNodes(NamedTuple):
    """Nodes by first bin, those whose bins have begun and not ended, and counts."""

    order: np.ndarray
    active: np.ndarray
    counts: np.ndarray


@inlined
def may_be_non_dominated(target, clock, node, time, cost):
    """Return whether a label may still lead to an arrival that no known arrival dominates.

    It may if for some bin of arrival the largest of the lower bounds of the cost at the end of
    the bin is below what is known for its start.
    """
    soonest = time + target.time_to_go[node]
    if not soonest <= clock.latest:
        return False
    b, count = int(soonest / clock.width), clock.count
    while b < count:
        after = min((b // clock.group + 1) * clock.group, count)
        ample = clock.width * after - time
        bound = -math.inf
        for r in range(target.rates.shape[0]):
            bound = max(bound, target.floor[node, r] - target.rates[r] * ample)
        if cost + bound < target.upper[b]:
            for j in range(b, after):
                ample = clock.width * (j + 1) - time
                bound = -math.inf
                for r in range(target.rates.shape[0]):
                    bound = max(bound, target.floor[node, r] - target.rates[r] * ample)
                if cost + bound < target.upper[j]:
                    return True
        b = after
    return False


@inlined
def _insert_label(labels, target, clock, head, time, cost, slot, left, code):
    """Store an arrival if it is the cheapest in its bin; return the bin, or -1."""
    b = int(time / clock.width)
    if b < labels.first[head] or b > labels.last[head]:
        return -1
    there = labels.place[head] + b - labels.first[head]
    if not cost < labels.cost[there]:
        return -1
    labels.cost[there] = cost
    labels.when[there, 0], labels.when[there, 1] = time, left
    labels.source[there, 0], labels.source[there, 1] = slot, code
    if head == target.goal:
        for j in range(b + 1, clock.count + 1):
            if target.upper[j] <= cost:
                break
            target.upper[j] = cost
    return b


@inlined
def clamped_interval(times, t):
    """Return k with ``times[k] <= t < times[k + 1]``, the last interval at the end."""
    low, high = 0, times.shape[0] - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if times[middle] <= t:
            low = middle
        else:
            high = middle
    return low


@inlined
def cost_margin(labels, clock, network, prices, head, time, cost):
    """Return what an edge may cost less waiting: more is dominated by an earlier arrival."""
    if clock.wait and network.can_wait[head]:
        return labels.best[head] - (cost - prices.waiting_cost_rate * time)
    return math.inf


@inlined
def _any_shut(values, at, span, count):
    """Return whether an edge is closed at some setting at one of the two slices around."""
    for s in range(count):
        if values[at + s] != values[at + s] or values[at + span + s] != values[at + span + s]:
            return True
    return False


@kernel_only
def _sail_shut(world, labels, target, clock, blocks, node, edge, e0, i, start, work):
    """Sail an edge now at the settings that are closed at one of the slices around."""
    time, cost, slot, left, b = start
    network, count = world.network, world.ship.settings.shape[0]
    span = (network.indptr[node + 1] - e0) * 2 * count
    at = blocks.offset[node] + i * span + (edge - e0) * 2 * count
    head, again = network.target[edge], False
    k = interval_of(world.sea.times, world.depart + time)
    if k < 0:
        return False
    sample_station(world.sea, network.station[node], k, world.depart + time, work[1])
    room = cost_margin(labels, clock, network, world.prices, head, time, cost)
    for s in range(count):
        d0, d1 = blocks.values[at + s], blocks.values[at + span + s]
        if d0 == d0 and d1 == d1:
            continue
        then, price, status = sail_edge_priced(world, edge, s, k, world.depart + time, work)
        took = then - world.depart - time
        if status != OK or time + took + target.time_to_go[head] > clock.latest:
            continue
        if price - world.prices.waiting_cost_rate * took < room:
            code = edge * count + s
            found = _insert_label(
                labels, target, clock, head, time + took, cost + price, slot, left, code
            )
            again |= found == b
    return again


@kernel_only
def _expand(world, labels, target, clock, blocks, node, start, only_shut, counts, work, spare):
    """Sail all edges that leave a node now; return whether a label of this bin was improved."""
    time, cost, slot, left, b = start
    network, prices, times = world.network, world.prices, blocks.times
    k = clamped_interval(times, time)
    i = k - blocks.first[node]
    if i < 0 or i + 1 >= blocks.count[node]:
        return False
    state = blocks.place[node] + i
    if blocks.state[state] == 0:
        fill_edge_table(world, blocks, node, i, work)
    if blocks.state[state + 1] == 0:
        fill_edge_table(world, blocks, node, i + 1, work)
    shut = blocks.state[state] > 1 or blocks.state[state + 1] > 1
    count = world.ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    at, span = blocks.offset[node] + i * (e1 - e0) * 2 * count, (e1 - e0) * 2 * count
    f = np.float32((time - times[k]) / (times[k + 1] - times[k]))
    values, again = blocks.values, False
    for edge in range(e0, e1):
        head = network.target[edge]
        ample = clock.latest - target.time_to_go[head] - time
        if ample > 0.0 and not only_shut:
            room = cost_margin(labels, clock, network, prices, head, time, cost)
            counts[RELAXED] += count
            for s in range(2 * count):
                low = values[at + s]
                spare[s] = low + f * (values[at + span + s] - low)
            for s in range(count):
                took, price = np.float64(spare[s]), np.float64(spare[count + s])
                if took <= ample and price - prices.waiting_cost_rate * took < room:
                    code = edge * count + s
                    found = _insert_label(
                        labels, target, clock, head, time + took, cost + price, slot, left, code
                    )
                    again |= found == b
        if ample > 0.0 and shut and _any_shut(values, at, span, count):
            again |= _sail_shut(
                world, labels, target, clock, blocks, node, edge, e0, i, start, work
            )
        at += 2 * count
    return again


@kernel_only
def _wait_until(world, labels, target, clock, blocks, node, k, b, counts, work):
    """Let the best label so far leave at slice k by edges that are cheaper then than before."""
    network, prices, times = world.network, world.prices, blocks.times
    i, time = k - blocks.first[node], times[k]
    if i < 0 or i >= blocks.count[node] or labels.best_at[node, 0] >= time:
        return False
    if world.depart + time > network.until[node]:
        return False
    cost = labels.best[node] + prices.waiting_cost_rate * time
    if not may_be_non_dominated(target, clock, node, time, cost):
        return False
    state = blocks.place[node] + i
    if blocks.state[state] == 0:
        fill_edge_table(world, blocks, node, i, work)
    known = i > 0
    if known and blocks.state[state - 1] == 0:
        fill_edge_table(world, blocks, node, i - 1, work)
    f = 0.0
    if known:
        f = max(0.0, (labels.best_at[node, 0] - times[k - 1]) / (time - times[k - 1]))
    count = world.ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at = blocks.offset[node] + i * span
    slot, values, again, rate = (
        int(labels.best_at[node, 1]),
        blocks.values,
        False,
        prices.waiting_cost_rate,
    )
    for edge in range(e0, e1):
        head = network.target[edge]
        ample = clock.latest - target.time_to_go[head] - time
        room = cost_margin(labels, clock, network, prices, head, time, cost)
        counts[WAITED] += count
        for s in range(count):
            took, price = np.float64(values[at + s]), np.float64(values[at + count + s])
            net = price - rate * took
            if not (took <= ample and net < room):
                continue
            if known and room < math.inf:  # not cheaper than before: not useful
                low, paid = values[at - span + s], values[at - span + count + s]
                before = paid + f * (price - paid) - rate * (low + f * (took - low))
                if net >= before - 1e-6 * abs(before) and low + f * (took - low) <= took + 1.0:
                    continue
            code = edge * count + s
            found = _insert_label(
                labels, target, clock, head, time + took, cost + price, slot, time, code
            )
            again |= found == b
        at += 2 * count
    return again


@kernel_only
def _wait_in_bin(world, labels, target, clock, blocks, node, b, counts, work, spare):
    """Let the best label so far of a node leave in this bin, where waiting may be useful."""
    again = False
    if labels.best[node] == math.inf or not world.network.can_wait[node]:
        return False
    times = blocks.times
    k = counts[SLICE]
    while k < times.shape[0] and times[k] < (b + 1) * clock.width:
        again |= _wait_until(world, labels, target, clock, blocks, node, k, b, counts, work)
        k += 1
    time = b * clock.width
    i = clamped_interval(times, time) - blocks.first[node]
    if i < 0 or i + 1 >= blocks.count[node] or labels.best_at[node, 0] > time:
        return again
    state = blocks.place[node] + i
    if blocks.state[state] != 3 and blocks.state[state + 1] != 3:
        return again
    cost = labels.best[node] + world.prices.waiting_cost_rate * time
    if world.depart + time <= world.network.until[node] and may_be_non_dominated(
        target, clock, node, time, cost
    ):
        start, only_shut = (time, cost, int(labels.best_at[node, 1]), time, b), time == time
        again |= _expand(
            world, labels, target, clock, blocks, node, start, only_shut, counts, work, spare
        )
    return again


@kernel_only
def _expand_bin(world, labels, target, clock, blocks, node, b, counts, work, spare):
    """Sail on from the label of a node in this bin; return whether this bin was improved."""
    slot = labels.place[node] + b - labels.first[node]
    cost = np.float64(labels.cost[slot])
    if cost == math.inf or (labels.done[node, 0] == b and not cost < labels.done[node, 1]):
        return False
    labels.done[node, 0], labels.done[node, 1] = b, cost
    time = np.float64(labels.when[slot, 0])
    if clock.wait and world.network.can_wait[node]:
        reduced = cost - world.prices.waiting_cost_rate * time
        if reduced >= labels.best[node]:
            return False
        labels.best[node] = reduced
        labels.best_at[node, 0], labels.best_at[node, 1] = time, slot
    if node == target.goal:
        return False
    if not may_be_non_dominated(target, clock, node, time, cost):
        counts[PRUNED] += 1
        return False
    counts[VISITED] += 1
    # flags are variables, not constants: numba would compile a copy for each constant
    start, only_shut = (time, cost, slot, math.nan, b), time != time
    return _expand(
        world, labels, target, clock, blocks, node, start, only_shut, counts, work, spare
    )


@allocation_free
def process_bins(world, labels, target, clock, blocks, agenda, begin, end, work, spare):
    """Process the bins from ``begin`` to before ``end``, in order.

    Parameters
    ----------
    world : FrontArrays
    labels : BinLabels
    target : LabelTarget
    clock : TimeBins
    blocks : EdgeTables
    agenda : ActiveNodes
    begin, end : int
    work : float64[4, CHANNELS]
    spare : float32[2 S]
        Work space.

    Notes
    -----
    Edges shorter than a bin feed the bin they start in; its nodes are then visited again until
    none of its labels improves.
    """
    active, counts = agenda.active, agenda.counts
    for b in range(begin, end):
        while counts[STARTED] < agenda.order.shape[0]:
            node = agenda.order[counts[STARTED]]
            if labels.first[node] > b:
                break
            active[counts[ACTIVE]] = node
            counts[ACTIVE] += 1
            counts[STARTED] += 1
        first, again = True, True
        while again:
            again, n = False, 0
            while n < counts[ACTIVE]:
                node = active[n]
                if labels.last[node] < b:
                    counts[ACTIVE] -= 1
                    active[n] = active[counts[ACTIVE]]
                    continue
                if first and clock.wait and node != target.goal:
                    again |= _wait_in_bin(
                        world, labels, target, clock, blocks, node, b, counts, work, spare
                    )
                again |= _expand_bin(
                    world, labels, target, clock, blocks, node, b, counts, work, spare
                )
                n += 1
            first = False
        times = blocks.times
        while counts[SLICE] < times.shape[0] and times[counts[SLICE]] < (b + 1) * clock.width:
            counts[SLICE] += 1


@allocation_free
def trace_labels(labels, slot, slots):
    """Follow a label back to the start; fill ``slots`` from the end, return how many.

    Returns -1 if there are more than fit.
    """
    n = 0
    while slot >= 0:
        if n >= slots.shape[0]:
            return -1
        slots[n] = slot
        n += 1
        slot = labels.source[slot, 0]
    return n
