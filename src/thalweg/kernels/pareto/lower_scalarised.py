"""Lower bounds of a front from the least cost plus a price of time (scalarisation)."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, inlined, kernel_only
from thalweg.kernels.pareto.lower_labels import (
    bound_interpolation_errors,
    interpolate_slices,
    interpolation_errors,
    least_between_slices,
)
from thalweg.kernels.pareto.time_expanded_labels import (
    ACTIVE,
    RELAXED,
    STARTED,
    VISITED,
    clamped_interval,
)


class ScalarisedLabelTarget(NamedTuple):
    """A search of the least cost plus a price of time.

    Attributes
    ----------
    goal : int
    rate : float
        Price of a second.
    known : float
        Cost plus priced time of a real path; labels that are not below it are not extended.
    time_to_go : float64[N]
        Lower bound of the time to the goal [s].
    floor : float64[N]
        Lower bound of cost plus priced time to the goal.
    """

    goal: int
    rate: float
    known: float
    time_to_go: np.ndarray
    floor: np.ndarray


@inlined
def _lower_bin_values(labels, clock, target, head, sooner, later, value, b):
    """Lower the value of every bin an arrival may fall into; return whether bin b was."""
    if not value + target.floor[head] < target.known:
        return False
    first, last = labels.first[head], labels.last[head]
    low = max(int(sooner / clock.width), b, first)
    high = min(max(int(later / clock.width), low), last)
    found = False
    for j in range(low, high + 1):
        there = labels.place[head] + j - first
        if value < labels.cost[there]:
            labels.cost[there] = value
            found |= j == b
    return found


@kernel_only
def _sail_piece_scalarised(world, labels, target, clock, blocks, slack, node, piece, counts, work):
    """Sail on from a node at any moment of a piece of a bin that is between two slices."""
    begin, end, value, k, b = piece
    i = k - blocks.first[node]
    if i < 0 or i + 1 >= blocks.count[node]:
        return False
    if slack.state[blocks.place[node] + i] == 0:
        bound_interpolation_errors(world, blocks, slack, node, i, work)
    network, count, rate = world.network, world.ship.settings.shape[0], target.rate
    e0, e1 = network.indptr[node], network.indptr[node + 1]
    span = (e1 - e0) * 2 * count
    at, here = blocks.offset[node] + i * span, slack.start[node] + i * (e1 - e0)
    start, length = blocks.times[k], blocks.times[k + 1] - blocks.times[k]
    f, g = (begin - start) / length, (end - start) / length
    values, again = blocks.values, False
    for edge in range(e0, e1):
        head = network.target[edge]
        off = interpolation_errors(slack, here)
        here += 1
        room = target.known - target.floor[head] - value
        ample = clock.latest - target.time_to_go[head]
        if room > 0.0 and ample > begin:
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
                    world, slack, edge, s, -rate, ample - begin, begin, end, pair, off
                )
                if least < room and sooner <= ample:
                    again |= _lower_bin_values(
                        labels, clock, target, head, sooner, later, value + least, b
                    )
        at += 2 * count
    return again


@kernel_only
def _sail_bin_scalarised(world, labels, target, clock, blocks, slack, node, b, value, counts, work):
    """Sail on from a node at any moment of a bin; return whether this bin was improved."""
    times, again = blocks.times, False
    begin = b * clock.width
    end = min(begin + clock.width, clock.latest)
    k = clamped_interval(times, begin)
    while begin < end:
        until = min(end, times[k + 1])
        piece = (begin, until, value, k, b)
        again |= _sail_piece_scalarised(
            world, labels, target, clock, blocks, slack, node, piece, counts, work
        )
        begin = until
        k += 1
        if k + 1 >= times.shape[0]:
            break
    return again


@allocation_free
def process_bins_scalarised(world, labels, target, clock, blocks, slack, agenda, work):
    """Find the least cost plus priced time of reaching every node in every bin.

    Parameters
    ----------
    world : FrontArrays
    labels : LowerLabels
        ``cost`` holds cost plus priced time; ``best`` that of a ship that has waited since an
        earlier bin, ``dead`` that at the departure from the node in this bin.
    target : TimePriced
    clock : TimeBins
    blocks : EdgeTables
    slack : InterpolationBounds
    agenda : ActiveNodes
    work : float64[4, CHANNELS]

    Notes
    -----
    The value includes the time, so the unknown moment of arrival within a bin causes no error:
    only the sea is taken at the most favourable moment of the bin.
    """
    active, counts = agenda.active, agenda.counts
    held = (target.rate + world.prices.waiting_cost_rate) * clock.width
    for b in range(clock.count):
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
                n += 1
                if node == target.goal:
                    continue
                waits = clock.wait and world.network.can_wait[node]
                if first:
                    labels.dead[node] = math.inf
                value = labels.cost[labels.place[node] + b - labels.first[node]]
                if waits:
                    value = min(value, labels.best[node])
                if value < labels.dead[node] and value + target.floor[node] < target.known:
                    labels.dead[node] = value
                    counts[VISITED] += 1
                    again |= _sail_bin_scalarised(
                        world, labels, target, clock, blocks, slack, node, b, value, counts, work
                    )
            first = False
        for n in range(counts[ACTIVE]):
            node = active[n]
            value = labels.cost[labels.place[node] + b - labels.first[node]]
            labels.best[node] = min(value, labels.best[node] + held)
