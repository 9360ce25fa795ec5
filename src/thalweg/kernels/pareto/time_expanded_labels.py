"""Time-expanded dynamic programming: the least cost at every node in every bin of time."""

import math

import numpy as np

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.leg.edge_sailing import interval_of, sample_station
from thalweg.kernels.pareto.edge_tables import (
    ALL_CLOSED,
    SOME_CLOSED,
    UNFILLED,
    fill_edge_table,
    sail_edge_priced,
)
from thalweg.kernels.pareto.label_arrays import (
    ACTIVE,
    PRUNED,
    RELAXED,
    SLICE,
    VISITED,
    WAITED,
    LabelDeparture,
    activate_nodes,
    deactivate_node,
)


@inlined
def may_be_non_dominated(target, time_bins, node, time, cost):
    """Return whether a label may still lead to an arrival that no known arrival dominates.

    It may if for some bin of arrival the largest of the lower bounds of the cost at the end of
    the bin is below what is known for its start.
    """
    earliest = time + target.time_to_go[node]
    if not earliest <= time_bins.latest:
        return False
    b, count = int(earliest / time_bins.width), time_bins.count
    while b < count:
        after = min((b // time_bins.group + 1) * time_bins.group, count)
        available = time_bins.width * after - time
        bound = -math.inf
        for r in range(target.rates.shape[0]):
            bound = max(bound, target.floor[node, r] - target.rates[r] * available)
        if cost + bound < target.upper[b]:
            for j in range(b, after):
                available = time_bins.width * (j + 1) - time
                bound = -math.inf
                for r in range(target.rates.shape[0]):
                    bound = max(bound, target.floor[node, r] - target.rates[r] * available)
                if cost + bound < target.upper[j]:
                    return True
        b = after
    return False


@inlined
def _insert_label(search, head, time, cost, origin):
    """Store an arrival if it is the cheapest in its bin; return the bin, or -1.

    ``origin`` is the label it comes from, when the ship left that node, and the code of edge and
    setting.
    """
    labels, target, time_bins = search.labels, search.target, search.time_bins
    b = int(time / time_bins.width)
    if b < labels.first[head] or b > labels.last[head]:
        return -1
    there = labels.place[head] + b - labels.first[head]
    if not cost < labels.cost[there]:
        return -1
    labels.cost[there] = cost
    labels.when[there, 0], labels.when[there, 1] = time, origin[1]
    labels.source[there, 0], labels.source[there, 1] = origin[0], origin[2]
    if head == target.goal:
        for j in range(b + 1, time_bins.count + 1):
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
def _cost_margin(search, head, time, cost):
    """Return what an edge may cost less waiting: more is dominated by an earlier arrival."""
    if search.time_bins.wait and search.world.network.can_wait[head]:
        reduced = cost - search.world.prices.waiting_cost_rate * time
        return search.labels.best[head] - reduced
    return math.inf


@inlined
def _any_closed(values, at, span, count):
    """Return whether an edge is closed at some setting at one of the two slices around."""
    for s in range(count):
        if values[at + s] != values[at + s] or values[at + span + s] != values[at + span + s]:
            return True
    return False


@kernel_only
def _sail_closed(search, node, edge, e0, i, start):
    """Sail an edge now at the settings that are closed at one of the slices around."""
    world, tables = search.world, search.tables
    network, count = world.network, world.ship.settings.shape[0]
    span = (network.indptr[node + 1] - e0) * 2 * count
    at = tables.offset[node] + i * span + (edge - e0) * 2 * count
    head, improved = network.target[edge], False
    now = world.depart + start.time
    k = interval_of(world.sea.times, now)
    if k < 0:
        return False
    sample_station(world.sea, network.station[node], k, now, search.work[1])
    margin = _cost_margin(search, head, start.time, start.cost)
    for s in range(count):
        d0, d1 = tables.values[at + s], tables.values[at + span + s]
        if d0 == d0 and d1 == d1:
            continue
        then, price, status = sail_edge_priced(world, edge, s, k, now, search.work)
        duration = then - now
        arrival = start.time + duration
        if status != OK or arrival + search.target.time_to_go[head] > search.time_bins.latest:
            continue
        if price - world.prices.waiting_cost_rate * duration < margin:
            origin = (start.slot, start.left, edge * count + s)
            found = _insert_label(search, head, arrival, start.cost + price, origin)
            improved |= found == start.bin
    return improved


@kernel_only
def _expand(search, node, start, only_closed):
    """Sail all edges that leave a node now; return whether a label of this bin was improved."""
    world, tables, work = search.world, search.tables, search.work
    network, prices, times = world.network, world.prices, tables.times
    time, cost = start.time, start.cost
    k = clamped_interval(times, time)
    i = k - tables.first[node]
    if i < 0 or i + 1 >= tables.count[node]:
        return False
    state = tables.place[node] + i
    if tables.state[state] == UNFILLED:
        fill_edge_table(world, tables, node, i, work)
    if tables.state[state + 1] == UNFILLED:
        fill_edge_table(world, tables, node, i + 1, work)
    closed = tables.state[state] >= SOME_CLOSED or tables.state[state + 1] >= SOME_CLOSED
    count = world.ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    at, span = tables.offset[node] + i * (e1 - e0) * 2 * count, (e1 - e0) * 2 * count
    f = np.float32((time - times[k]) / (times[k + 1] - times[k]))
    values, at_settings, improved = tables.values, search.at_settings, False
    for edge in range(e0, e1):
        head = network.target[edge]
        available = search.time_bins.latest - search.target.time_to_go[head] - time
        if available > 0.0 and not only_closed:
            margin = _cost_margin(search, head, time, cost)
            search.active_nodes.counts[RELAXED] += count
            for s in range(2 * count):
                low = values[at + s]
                at_settings[s] = low + f * (values[at + span + s] - low)
            for s in range(count):
                duration, price = np.float64(at_settings[s]), np.float64(at_settings[count + s])
                reduced = price - prices.waiting_cost_rate * duration
                if duration <= available and reduced < margin:
                    origin = (start.slot, start.left, edge * count + s)
                    found = _insert_label(search, head, time + duration, cost + price, origin)
                    improved |= found == start.bin
        if available > 0.0 and closed and _any_closed(values, at, span, count):
            improved |= _sail_closed(search, node, edge, e0, i, start)
        at += 2 * count
    return improved


@kernel_only
def _wait_until(search, node, k, b):
    """Let the best label so far leave at slice k by edges that are cheaper then than before."""
    world, labels, tables = search.world, search.labels, search.tables
    network, prices, times = world.network, world.prices, tables.times
    i, time = k - tables.first[node], times[k]
    if i < 0 or i >= tables.count[node] or labels.best_at[node, 0] >= time:
        return False
    if world.depart + time > network.until[node]:
        return False
    rate = prices.waiting_cost_rate
    cost = labels.best[node] + rate * time
    if not may_be_non_dominated(search.target, search.time_bins, node, time, cost):
        return False
    state = tables.place[node] + i
    if tables.state[state] == UNFILLED:
        fill_edge_table(world, tables, node, i, search.work)
    known = i > 0
    if known and tables.state[state - 1] == UNFILLED:
        fill_edge_table(world, tables, node, i - 1, search.work)
    f = 0.0
    if known:
        f = max(0.0, (labels.best_at[node, 0] - times[k - 1]) / (time - times[k - 1]))
    count = world.ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at = tables.offset[node] + i * span
    slot, values, improved = int(labels.best_at[node, 1]), tables.values, False
    for edge in range(e0, e1):
        head = network.target[edge]
        available = search.time_bins.latest - search.target.time_to_go[head] - time
        margin = _cost_margin(search, head, time, cost)
        search.active_nodes.counts[WAITED] += count
        for s in range(count):
            duration, price = np.float64(values[at + s]), np.float64(values[at + count + s])
            reduced = price - rate * duration
            if not (duration <= available and reduced < margin):
                continue
            if known and margin < math.inf:  # not cheaper than before: not useful
                low, paid = values[at - span + s], values[at - span + count + s]
                sooner = low + f * (duration - low)
                before = paid + f * (price - paid) - rate * sooner
                if reduced >= before - 1e-6 * abs(before) and sooner <= duration + 1.0:
                    continue
            origin = (slot, time, edge * count + s)
            found = _insert_label(search, head, time + duration, cost + price, origin)
            improved |= found == b
        at += 2 * count
    return improved


@kernel_only
def _wait_in_bin(search, node, b):
    """Let the best label so far of a node leave in this bin, where waiting may be useful."""
    world, labels, time_bins, tables = search.world, search.labels, search.time_bins, search.tables
    improved = False
    if labels.best[node] == math.inf or not world.network.can_wait[node]:
        return False
    times = tables.times
    k = search.active_nodes.counts[SLICE]
    while k < times.shape[0] and times[k] < (b + 1) * time_bins.width:
        improved |= _wait_until(search, node, k, b)
        k += 1
    time = b * time_bins.width
    i = clamped_interval(times, time) - tables.first[node]
    if i < 0 or i + 1 >= tables.count[node] or labels.best_at[node, 0] > time:
        return improved
    state = tables.place[node] + i
    if tables.state[state] != ALL_CLOSED and tables.state[state + 1] != ALL_CLOSED:
        return improved
    cost = labels.best[node] + world.prices.waiting_cost_rate * time
    if world.depart + time <= world.network.until[node] and may_be_non_dominated(
        search.target, time_bins, node, time, cost
    ):
        start = LabelDeparture(time, cost, int(labels.best_at[node, 1]), time, b)
        # true, but a variable: numba would compile a copy of `_expand` for each constant
        only_closed = time == time
        improved |= _expand(search, node, start, only_closed)
    return improved


@inlined
def _expand_bin(search, node, b):
    """Sail on from the label of a node in this bin; return whether this bin was improved."""
    world, labels, counts = search.world, search.labels, search.active_nodes.counts
    slot = labels.place[node] + b - labels.first[node]
    cost = np.float64(labels.cost[slot])
    if cost == math.inf or (labels.done[node, 0] == b and not cost < labels.done[node, 1]):
        return False
    labels.done[node, 0], labels.done[node, 1] = b, cost
    time = np.float64(labels.when[slot, 0])
    if search.time_bins.wait and world.network.can_wait[node]:
        reduced = cost - world.prices.waiting_cost_rate * time
        if reduced >= labels.best[node]:
            return False
        labels.best[node] = reduced
        labels.best_at[node, 0], labels.best_at[node, 1] = time, slot
    if node == search.target.goal:
        return False
    if not may_be_non_dominated(search.target, search.time_bins, node, time, cost):
        counts[PRUNED] += 1
        return False
    counts[VISITED] += 1
    # false, but a variable: numba would compile a copy of `_expand` for each constant
    start, only_closed = LabelDeparture(time, cost, slot, math.nan, b), time != time
    return _expand(search, node, start, only_closed)


@allocation_free
def process_bins(search, begin, end):
    """Process the bins from ``begin`` to before ``end``, in order.

    Parameters
    ----------
    search : LabelSearch
    begin, end : int

    Notes
    -----
    Edges shorter than a bin feed the bin they start in; its nodes are then visited again until
    none of its labels improves.
    """
    labels, time_bins, active_nodes, times = (
        search.labels,
        search.time_bins,
        search.active_nodes,
        search.tables.times,
    )
    active, counts = active_nodes.active, active_nodes.counts
    for b in range(begin, end):
        activate_nodes(active_nodes, labels.first, b)
        first, improved = True, True
        while improved:
            improved, n = False, 0
            while n < counts[ACTIVE]:
                node = active[n]
                if labels.last[node] < b:
                    deactivate_node(active_nodes, n)
                    continue
                if first and time_bins.wait and node != search.target.goal:
                    improved |= _wait_in_bin(search, node, b)
                improved |= _expand_bin(search, node, b)
                n += 1
            first = False
        while counts[SLICE] < times.shape[0] and times[counts[SLICE]] < (b + 1) * time_bins.width:
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
