"""Lower bounds of a front: dynamic programming over bins of time with the best sea in each bin."""

import math

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.pareto.edge_tables import UNFILLED
from thalweg.kernels.pareto.label_arrays import (
    ACTIVE,
    PRUNED,
    RELAXED,
    VISITED,
    activate_nodes,
    deactivate_node,
)
from thalweg.kernels.pareto.slice_interpolation import (
    bound_interpolation_errors,
    interpolate_slices,
    interpolation_errors,
    least_between_slices,
)
from thalweg.kernels.pareto.time_expanded_labels import clamped_interval, may_be_non_dominated


@inlined
def _waits(search, node):
    """Return whether a ship may wait at a node."""
    return search.time_bins.wait and search.world.network.can_wait[node]


@inlined
def _cost_margin(search, scalarised, head, value, useful_later):
    """Return what an edge may cost at most to lower a label; 0 if it cannot.

    ``useful_later`` is whether leaving at this moment may lead to what an earlier one does not.
    """
    if scalarised is not None:
        return scalarised.known - scalarised.floor[head] - value
    if not useful_later:
        return 0.0
    return search.labels.best[head] - value if _waits(search, head) else math.inf


@inlined
def _lower_bins(search, scalarised, head, arrivals, value, b):
    """Lower the labels of the bins an arrival may fall into; return whether bin b was.

    ``arrivals`` are the earliest and the latest. Where a ship may wait, the first bin stands for
    those after it, unless time has a price.
    """
    labels, time_bins = search.labels, search.time_bins
    only_first = False
    if scalarised is None:
        only_first = _waits(search, head)
    if scalarised is not None and not value + scalarised.floor[head] < scalarised.known:
        return False
    first, last = labels.first[head], labels.last[head]
    low = max(int(arrivals[0] / time_bins.width), b, first)
    if low > last:
        return False
    high = low if only_first else max(min(int(arrivals[1] / time_bins.width), last), low)
    lowered = False
    for j in range(low, high + 1):
        there = labels.place[head] + j - first
        if value < labels.cost[there]:
            labels.cost[there] = value
            lowered |= j == b
    return lowered


@kernel_only
def _sail_piece(search, scalarised, node, piece, every_edge):
    """Sail on from a node at any moment of a piece of a bin that is between two slices."""
    world, tables = search.world, search.tables
    begin, end, value, k, b = piece
    i = k - tables.first[node]
    if i < 0 or i + 1 >= tables.count[node]:
        return False
    if search.error_bounds.state[tables.place[node] + i] == UNFILLED:
        bound_interpolation_errors(search, node, i)
    rate = world.prices.waiting_cost_rate
    if scalarised is not None:
        rate = -scalarised.rate
    network, count = world.network, world.ship.settings.shape[0]
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at, here = tables.offset[node] + i * span, search.error_bounds.start[node] + i * (e1 - e0)
    start, length = tables.times[k], tables.times[k + 1] - tables.times[k]
    f, g = (begin - start) / length, (end - start) / length
    values, lowered = tables.values, False
    for edge in range(e0, e1):
        head = network.target[edge]
        useful_later = every_edge or search.error_bounds.gains[here] > 0
        errors = interpolation_errors(search, here)
        here += 1
        latest = search.time_bins.latest - search.target.time_to_go[head]
        margin = _cost_margin(search, scalarised, head, value, useful_later)
        if latest > begin and margin > 0.0:
            search.active_nodes.counts[RELAXED] += count
            for s in range(count):
                d0, d1 = np.float64(values[at + s]), np.float64(values[at + span + s])
                c0 = np.float64(values[at + count + s])
                c1 = np.float64(values[at + span + count + s])
                if not (d0 < math.inf or d1 < math.inf):
                    continue
                pair = interpolate_slices(d0, d1, c0, c1, f, g)
                first, last, least = least_between_slices(
                    search, edge, s, (rate, latest - begin), (begin, end), pair, errors
                )
                if first <= latest and least < margin:
                    lowered |= _lower_bins(
                        search, scalarised, head, (first, last), value + least, b
                    )
        at += 2 * count
    return lowered


@kernel_only
def _sail_bin(search, scalarised, node, b, value, fresh):
    """Sail on from a node at any moment of a bin; return whether this bin was improved.

    Unless ``fresh`` only edges that may be cheaper later are sailed, as long as no slice begins.
    """
    times, time_bins, lowered = search.tables.times, search.time_bins, False
    begin = b * time_bins.width
    end = min(begin + time_bins.width, time_bins.latest)
    k = clamped_interval(times, begin)
    every_edge = fresh or times[k] > begin - time_bins.width  # the first bin of an interval
    while begin < end:
        until = min(end, times[k + 1])
        lowered |= _sail_piece(search, scalarised, node, (begin, until, value, k, b), every_edge)
        every_edge, begin = True, until
        k += 1
        if k + 1 >= times.shape[0]:
            break
    return lowered


@inlined
def _expand_bin_lower(search, node, b, first):
    """Sail on from a node in a bin, with its least cost so far; return whether the bin improved."""
    labels, counts = search.labels, search.active_nodes.counts
    value = labels.cost[labels.place[node] + b - labels.first[node]]
    waits = _waits(search, node)
    fresh = value < labels.best[node]
    if not fresh and not (waits and first):
        return False
    if waits:
        value = min(value, labels.best[node])
    labels.best[node] = value
    time = b * search.time_bins.width
    if value >= labels.dead[node]:
        return False
    cost = value + search.world.prices.waiting_cost_rate * time
    if not may_be_non_dominated(search.target, search.time_bins, node, time, cost):
        counts[PRUNED] += 1
        if waits:
            labels.dead[node] = value
        return False
    counts[VISITED] += 1
    return _sail_bin(search, None, node, b, value, fresh)


@allocation_free
def process_bins_lower(search, begin, end):
    """Process the bins from ``begin`` to before ``end``, in order.

    Parameters
    ----------
    search : LowerSearch
        ``target.upper`` holds real paths only.
    begin, end : int

    Notes
    -----
    A ship at a node in a bin has a reduced cost of at least that of the bin, or, where it may wait,
    of at least the least up to that bin. It may depart at any moment of the bin: the earliest
    arrival and the least cost over those moments are combined.
    """
    labels, active_nodes = search.labels, search.active_nodes
    for b in range(begin, end):
        activate_nodes(active_nodes, labels.first, b)
        first, improved = True, True
        while improved:
            improved, n = False, 0
            while n < active_nodes.counts[ACTIVE]:
                node = active_nodes.active[n]
                if labels.last[node] < b:
                    deactivate_node(active_nodes, n)
                    continue
                if first and not _waits(search, node):
                    labels.best[node] = math.inf
                if node != search.target.goal:
                    improved |= _expand_bin_lower(search, node, b, first)
                n += 1
            first = False


@inlined
def _expand_bin_scalarised(search, target, node, b):
    """Sail on from a node in a bin, with its least value so far; return whether it improved."""
    labels = search.labels
    value = labels.cost[labels.place[node] + b - labels.first[node]]
    if _waits(search, node):
        value = min(value, labels.best[node])
    if not (value < labels.dead[node] and value + target.floor[node] < target.known):
        return False
    labels.dead[node] = value
    search.active_nodes.counts[VISITED] += 1
    return _sail_bin(search, target, node, b, value, value == value)


@allocation_free
def process_bins_scalarised(search):
    """Find the least cost plus priced time of reaching every node in every bin.

    Parameters
    ----------
    search : LowerSearch
        With a `ScalarisedLabelTarget`. ``labels.cost`` holds cost plus priced time; ``best`` that
        of a ship that has waited since an earlier bin, ``dead`` that at the departure from the node
        in this bin.

    Notes
    -----
    The value includes the time, so the unknown moment of arrival within a bin causes no error:
    only the sea is taken at the most favourable moment of the bin.
    """
    labels, time_bins, active_nodes, target = (
        search.labels,
        search.time_bins,
        search.active_nodes,
        search.target,
    )
    held = (target.rate + search.world.prices.waiting_cost_rate) * time_bins.width
    for b in range(time_bins.count):
        activate_nodes(active_nodes, labels.first, b)
        first, improved = True, True
        while improved:
            improved, n = False, 0
            while n < active_nodes.counts[ACTIVE]:
                node = active_nodes.active[n]
                if labels.last[node] < b:
                    deactivate_node(active_nodes, n)
                    continue
                n += 1
                if node == target.goal:
                    continue
                if first:
                    labels.dead[node] = math.inf
                improved |= _expand_bin_scalarised(search, target, node, b)
            first = False
        for n in range(active_nodes.counts[ACTIVE]):
            node = active_nodes.active[n]
            value = labels.cost[labels.place[node] + b - labels.first[node]]
            labels.best[node] = min(value, labels.best[node] + held)
