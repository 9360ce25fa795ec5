"""The lower front: dynamic programming over bins of time with the best conditions in each bin."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.codes import OK
from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.leg.edge_sailing import interval_of, sample_station
from thalweg.kernels.pareto.edge_tables import fill_edge_table, sail_edge_priced
from thalweg.kernels.pareto.time_expanded_labels import (
    ACTIVE,
    PRUNED,
    RELAXED,
    STARTED,
    VISITED,
    clamped_interval,
    may_be_non_dominated,
)

_SAFETY_FACTOR = 2.0  # of the difference met midway between two slices
_ROUNDING = 1e-6  # of tables in single precision
_LARGEST_USEFUL_ERROR = (
    0.25  # with larger errors the bound that is independent of the sea may be larger
)
_HALVINGS = 4  # to find when an edge closes
_CLOSING_ERROR = 0.01  # relative error of an edge after the last time at which it is open


class LowerLabels(NamedTuple):
    """The least reduced cost (less ``waiting_cost_rate`` times time) at every node in every bin of
    time.

    Attributes
    ----------
    first, last : int32[N]
        First and last bin of a node; none when last < first.
    place : int64[N]
        Where the bins of a node start.
    cost : float64[L]
    best : float64[N]
        Least up to the bin being processed.
    dead : float64[N]
        Sailing on is not useful from this value on.
    """

    first: np.ndarray
    last: np.ndarray
    place: np.ndarray
    cost: np.ndarray
    best: np.ndarray
    dead: np.ndarray


class InterpolationBounds(NamedTuple):
    """Bounds of the interpolation error between successive slices, by block and edge of the node.

    Attributes
    ----------
    start : int64[N]
        Where a node's first block starts.
    state : uint8[B]
        By block: 0 not checked; 1 known.
    off : float32[:, 3]
        How much shorter a passage may be, how much cheaper without the price of time, and how much
        longer; each as a share.
    gains : uint8[:]
        Whether leaving later may be useful; 2 where the edge is closed at one of the two slices.
    along : float64[E]
        Largest current along an edge [m/s].
    fastest, thriftiest : float64[S]
        Greatest speed through water [m/s], least fuel rate [kg/s].
    """

    start: np.ndarray
    state: np.ndarray
    off: np.ndarray
    gains: np.ndarray
    along: np.ndarray
    fastest: np.ndarray
    thriftiest: np.ndarray


@inlined
def _widened_errors(off, took, spent, time, cost, price):
    """Return shares widened by a passage that takes and costs more or less than thought."""
    own = spent - price * took
    dear = (cost - price * time) / own - 1.0 if own > 0.0 else 0.0
    slow = time / took - 1.0
    return max(off[0], -slow), max(off[1], -dear), max(off[2], slow)


@inlined
def _midpoint_errors(world, blocks, edge, at, span, k, t, count, work):
    """Return how far passages midway between two slices are from the mean of the two."""
    values, off = blocks.values, (0.0, 0.0, 0.0)
    for s in range(0, count, max(count - 1, 1)):
        d0, d1 = np.float64(values[at + s]), np.float64(values[at + span + s])
        c0, c1 = np.float64(values[at + count + s]), np.float64(values[at + span + count + s])
        if not (d0 + d1 < math.inf):
            continue
        then, cost, status = sail_edge_priced(world, edge, s, k, t, work)
        blocks.sailed[0] += 1
        if status == OK:
            took, spent = 0.5 * (d0 + d1), 0.5 * (c0 + c1)
            off = _widened_errors(off, took, spent, then - t, cost, world.prices.time_price)
    return off


@inlined
def _errors_until_shut(world, blocks, node, edge, s, open_at, shut_at, took, spent, work):
    """Return how far passages of an edge that is open at one slice are off until it closes."""
    sea, off = world.sea, (0.0, 0.0, 0.0)
    for _ in range(_HALVINGS):
        t = world.depart + 0.5 * (open_at + shut_at)
        k, status, then, cost = interval_of(sea.times, t), -1, t, 0.0
        if k >= 0:
            sample_station(sea, world.network.station[node], k, t, work[1])
            then, cost, status = sail_edge_priced(world, edge, s, k, t, work)
            blocks.sailed[0] += 1
        if status == OK:
            open_at = t - world.depart
            off = _widened_errors(off, took, spent, then - t, cost, world.prices.time_price)
        else:
            shut_at = t - world.depart
    return off


@kernel_only
def bound_interpolation_errors(world, blocks, slack, node, i, work):
    """Find how far the tables may be off between a slice and the next."""
    for j in (i, i + 1):
        if blocks.state[blocks.place[node] + j] == 0:
            fill_edge_table(world, blocks, node, j, work)
    network, count, rate = (
        world.network,
        world.ship.settings.shape[0],
        world.prices.waiting_cost_rate,
    )
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at, here = blocks.offset[node] + i * span, slack.start[node] + i * (e1 - e0)
    k0 = blocks.first[node] + i
    sooner, later = blocks.times[k0], blocks.times[k0 + 1]
    length = later - sooner
    t = world.depart + sooner + 0.5 * length
    k = interval_of(world.sea.times, t)
    if k >= 0:
        sample_station(world.sea, network.station[node], k, t, work[1])
    values = blocks.values
    for edge in range(e0, e1):
        off, gains = (0.0, 0.0, 0.0), 0
        if k >= 0:
            off = _midpoint_errors(world, blocks, edge, at, span, k, t, count, work)
        for s in range(count):
            d0, d1 = values[at + s], values[at + span + s]
            if d0 < math.inf and d1 < math.inf:
                r0, r1 = (
                    values[at + count + s] - rate * d0,
                    values[at + span + count + s] - rate * d1,
                )
                if (r1 < r0 - _ROUNDING * abs(r0) or d1 - d0 < -length) and gains == 0:
                    gains = 1
            elif d0 < math.inf or d1 < math.inf:
                gains = 2
                row, begin, end = (
                    (at, sooner, later) if d0 < math.inf else (at + span, later, sooner)
                )
                took, spent = np.float64(values[row + s]), np.float64(values[row + count + s])
                more = _errors_until_shut(
                    world, blocks, node, edge, s, begin, end, took, spent, work
                )
                off = max(off[0], more[0]), max(off[1], more[1]), max(off[2], more[2])
        least = _CLOSING_ERROR if gains == 2 else _ROUNDING
        for j in range(3):
            slack.off[here, j] = _SAFETY_FACTOR * off[j] + least
        slack.gains[here] = gains
        here += 1
        at += 2 * count
    slack.state[blocks.place[node] + i] = 1


@inlined
def _lower_bin_costs(labels, clock, waits, head, sooner, later, cost, b):
    """Lower the least cost of the bins an arrival may fall into; return whether bin b was."""
    first, last = labels.first[head], labels.last[head]
    low = max(int(sooner / clock.width), b, first)
    high = low if waits else min(int(later / clock.width), last)
    found = False
    if low > last:
        return False
    for j in range(low, max(high, low) + 1):
        there = labels.place[head] + j - first
        if cost < labels.cost[there]:
            labels.cost[there] = cost
            found |= j == b
    return found


@inlined
def least_in_any_sea(world, slack, edge, s, rate, longest):
    """Return the least duration and reduced cost of an edge in any conditions."""
    prices = world.prices
    took = prices.fixed_time[edge]
    if took == took:
        fuel = prices.fixed_fuel[edge] * prices.weight[edge]
        return took, prices.fee[edge] + fuel + took * (prices.time_price - rate)
    pace = slack.fastest[s] + slack.along[edge]
    took = world.network.length[edge] / pace if pace > 0.0 else math.inf
    net = slack.thriftiest[s] * prices.weight[edge] + prices.time_price - rate
    return took, prices.fee[edge] + net * (took if net > 0.0 else longest)


@inlined
def interpolation_errors(slack, here):
    """Return a row of ``slack.off`` in double precision."""
    off = slack.off
    return np.float64(off[here, 0]), np.float64(off[here, 1]), np.float64(off[here, 2])


@inlined
def interpolate_slices(d0, d1, c0, c1, f, g):
    """Return durations and costs at two shares of the time between two slices.

    An edge that is closed at one of the slices is as at the other.
    """
    if not d0 < math.inf:
        return d1, d1, c1, c1
    if not d1 < math.inf:
        return d0, d0, c0, c0
    return d0 + f * (d1 - d0), d0 + g * (d1 - d0), c0 + f * (c1 - c0), c0 + g * (c1 - c0)


@inlined
def least_between_slices(world, slack, edge, s, rate, longest, begin, end, pair, off):
    """Return the earliest and latest arrival, and the least reduced cost, between two slices.

    ``pair`` holds durations and costs at begin and end by the tables, ``off`` how far these may
    be off.
    """
    da, db, ca, cb = pair
    early, cheap, late = off
    price = world.prices.time_price
    left = max(1.0 - early, 0.0)
    net, dear = price - rate, max(1.0 - cheap, 0.0)
    slow = net * (left if net > 0.0 else 1.0 + late)
    least = min(dear * (ca - price * da) + slow * da, dear * (cb - price * db) + slow * db)
    least = max(least - _ROUNDING * max(ca, cb), 0.0)
    sooner = min(begin + da * left, end + db * left)
    if (
        early > _LARGEST_USEFUL_ERROR
        or cheap > _LARGEST_USEFUL_ERROR
        or (late > _LARGEST_USEFUL_ERROR and net < 0.0)
    ):
        took, amid = least_in_any_sea(world, slack, edge, s, rate, longest)
        sooner, least = max(sooner, begin + took), max(least, amid)
    return sooner, max(begin + da * (1.0 + late), end + db * (1.0 + late)), least


@kernel_only
def _sail_piece(world, labels, target, clock, blocks, slack, node, piece, all_edges, counts, work):
    """Sail on from a node at any moment of a piece of a bin that is between two slices."""
    begin, end, cost, k, b = piece
    i = k - blocks.first[node]
    if i < 0 or i + 1 >= blocks.count[node]:
        return False
    if slack.state[blocks.place[node] + i] == 0:
        bound_interpolation_errors(world, blocks, slack, node, i, work)
    network, count, rate = (
        world.network,
        world.ship.settings.shape[0],
        world.prices.waiting_cost_rate,
    )
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at, here = blocks.offset[node] + i * span, slack.start[node] + i * (e1 - e0)
    start, length = blocks.times[k], blocks.times[k + 1] - blocks.times[k]
    f, g = (begin - start) / length, (end - start) / length
    values, again = blocks.values, False
    for edge in range(e0, e1):
        head, gains = network.target[edge], slack.gains[here]
        off = interpolation_errors(slack, here)
        here += 1
        ample = clock.latest - target.time_to_go[head]
        waits = clock.wait and network.can_wait[head]
        if ample > begin and (all_edges or gains > 0):
            room = labels.best[head] - cost if waits else math.inf
            counts[RELAXED] += count
            for s in range(count):
                d0, d1 = np.float64(values[at + s]), np.float64(values[at + span + s])
                c0, c1 = (
                    np.float64(values[at + count + s]),
                    np.float64(values[at + span + count + s]),
                )
                if not (d0 < math.inf or d1 < math.inf):
                    continue
                pair = interpolate_slices(d0, d1, c0, c1, f, g)
                sooner, later, least = least_between_slices(
                    world, slack, edge, s, rate, ample - begin, begin, end, pair, off
                )
                if sooner <= ample and least < room:
                    again |= _lower_bin_costs(
                        labels, clock, waits, head, sooner, later, cost + least, b
                    )
        at += 2 * count
    return again


@kernel_only
def _sail_bin(world, labels, target, clock, blocks, slack, node, b, cost, fresh, counts, work):
    """Sail on from a node at any moment of a bin; return whether this bin was improved."""
    times, again = blocks.times, False
    begin = b * clock.width
    end = min(begin + clock.width, clock.latest)
    k = clamped_interval(times, begin)
    new = fresh or times[k] > begin - clock.width  # the first bin of an interval
    while begin < end:
        until = min(end, times[k + 1])
        piece = (begin, until, cost, k, b)
        again |= _sail_piece(
            world, labels, target, clock, blocks, slack, node, piece, new, counts, work
        )
        new, begin = True, until
        k += 1
        if k + 1 >= times.shape[0]:
            break
    return again


@kernel_only
def _expand_bin_lower(world, labels, target, clock, blocks, slack, node, b, first, counts, work):
    """Sail on from a node in a bin, with its least cost so far; return whether the bin improved."""
    cost = labels.cost[labels.place[node] + b - labels.first[node]]
    waits = clock.wait and world.network.can_wait[node]
    fresh = cost < labels.best[node]
    if not fresh and not (waits and first):
        return False
    if waits:
        cost = min(cost, labels.best[node])
    labels.best[node] = cost
    time = b * clock.width
    if cost >= labels.dead[node]:
        return False
    if not may_be_non_dominated(
        target, clock, node, time, cost + world.prices.waiting_cost_rate * time
    ):
        counts[PRUNED] += 1
        if waits:
            labels.dead[node] = cost
        return False
    counts[VISITED] += 1
    return _sail_bin(
        world, labels, target, clock, blocks, slack, node, b, cost, fresh, counts, work
    )


@allocation_free
def process_bins_lower(world, labels, target, clock, blocks, slack, agenda, begin, end, work):
    """Process the bins from ``begin`` to before ``end``, in order.

    Parameters
    ----------
    world : FrontArrays
    labels : LowerLabels
    target : LabelTarget
        ``upper`` holds real paths only.
    clock : TimeBins
    blocks : EdgeTables
    slack : InterpolationBounds
    agenda : ActiveNodes
    begin, end : int
    work : float64[4, CHANNELS]

    Notes
    -----
    A ship at a node in a bin has a reduced cost of at least that of the bin, or, where it may wait,
    of at least the least up to that bin. It may depart at any moment of the bin: the earliest
    arrival and the least cost over those moments are combined.
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
                if first and not (clock.wait and world.network.can_wait[node]):
                    labels.best[node] = math.inf
                if node != target.goal:
                    again |= _expand_bin_lower(
                        world, labels, target, clock, blocks, slack, node, b, first, counts, work
                    )
                n += 1
            first = False
