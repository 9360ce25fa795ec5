"""Nodes that fall dry: one state for each time a ship is afloat there.

An early arrival at a node is not useful if the ship then grounds: the later arrival that floats on
the next tide goes further. So a node with several times afloat becomes several states, each with
its own label ("safe intervals": Phillips and Likhachev 2011, "SIPP: Safe interval path planning
for dynamic environments").
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import BED_DEPTH, WATER_LEVEL
from thalweg.kernels.leg.edge_sailing import NetworkArrays, SeaArrays

_DEPTH_TOLERANCE = 1e-3  # depths are in single precision [m]
_MIN_SPEED_OVER_GROUND = 0.1  # no edge is sailed slower than this over ground [m/s]


class AfloatIntervals(NamedTuple):
    """Times afloat, sorted by node and time: node, first and last moment [s]."""

    node: IntArray
    begin: FloatArray
    end: FloatArray


def tidal_states(
    network: NetworkArrays, sea: SeaArrays, required: float, keep: tuple[int, int]
) -> NetworkArrays:
    """Return a network in which nodes that fall dry are several states.

    Parameters
    ----------
    network : One state per node.
    required : Required depth [m]; -inf if none.
    keep : Start and goal, which stay single: a ship is safe there.

    Returns
    -------
    NetworkArrays : The same if no depth is required or no depth varies. The first states are those
        of the nodes, in order.
    """
    varies = sea.channel_index[WATER_LEVEL] >= 0 or sea.channel_index[BED_DEPTH] >= 0
    if required == -np.inf or not varies:
        return network
    depth = _depths(network, sea)
    afloat = depth >= required - _DEPTH_TOLERANCE
    changing = network.can_wait & ~afloat.all(axis=1)
    changing[[node for node in keep if node >= 0]] = False
    chosen = np.flatnonzero(changing)
    if len(chosen) == 0:
        return network
    times = _find_afloat_intervals(chosen, afloat[chosen], depth[chosen] - required, sea.times)
    return _split_nodes(network, chosen, times)


def afloat_intervals(
    network: NetworkArrays, sea: SeaArrays, required: float, nodes: IntArray
) -> AfloatIntervals | None:
    """Return when some nodes have the required depth [m]; None if depth does not matter."""
    varies = sea.channel_index[WATER_LEVEL] >= 0 or sea.channel_index[BED_DEPTH] >= 0
    if required == -np.inf or not varies or not len(nodes):
        return None
    spare = _depths(network, sea)[nodes] - required
    return _find_afloat_intervals(nodes, spare >= -_DEPTH_TOLERANCE, spare, sea.times)


def _depths(network: NetworkArrays, sea: SeaArrays) -> NDArray[np.float32]:
    """Return the water depth at each node and time [m]: charted or bed depth plus level."""
    count = len(network.can_wait)
    has_edges = np.diff(network.indptr) > 0
    charted = np.full(count, -np.inf, np.float32)
    # a node is on every edge that leaves it, so it is at least as deep as the deepest of them
    if has_edges.any():
        first = network.indptr[:-1][has_edges]
        sailed = np.where(np.isnan(network.fixed_time), network.depth, np.float32(-np.inf))
        charted[has_edges] = np.fmax.reduceat(sailed, first)
    level, bed = sea.channel_index[WATER_LEVEL], sea.channel_index[BED_DEPTH]
    depth = np.broadcast_to(charted[:, None], (count, len(sea.times)))
    if bed >= 0:
        depth = np.minimum(depth, sea.values[:count, :, bed])
    if level >= 0:
        depth = depth + sea.values[:count, :, level]
    return np.asarray(depth)


def _find_afloat_intervals(
    nodes: IntArray, afloat: NDArray[np.bool_], spare: NDArray[np.float32], times: FloatArray
) -> AfloatIntervals:
    """Find when each node is afloat; depth is linear between the times of the data."""
    edge = np.zeros((len(nodes), 1), bool)
    steps = np.diff(np.concatenate([edge, afloat, edge], axis=1).astype(np.int8), axis=1)
    row, start = np.nonzero(steps == 1)
    _, stop = np.nonzero(steps == -1)
    stop -= 1
    last = len(times) - 1

    def crossing(dry: IntArray, wet: IntArray) -> FloatArray:
        low, high = spare[row, dry].astype(float), spare[row, wet].astype(float)
        usable = np.isfinite(low) & np.isfinite(high) & (high > low)
        share = np.divide(high, high - low, out=np.zeros(len(low)), where=usable)
        moment = times[wet] + share * (times[dry] - times[wet])
        return np.asarray(moment)

    begin = np.where(start == 0, -np.inf, crossing(np.maximum(start - 1, 0), start))
    end = np.where(stop == last, np.inf, crossing(np.minimum(stop + 1, last), stop))
    return AfloatIntervals(nodes[row], begin, end)


def _split_nodes(network: NetworkArrays, chosen: IntArray, times: AfloatIntervals) -> NetworkArrays:
    count = len(network.can_wait)
    first = np.ones(len(times.node), bool)
    first[1:] = times.node[1:] != times.node[:-1]
    until = np.array(network.until)
    until[chosen] = -np.inf  # where a ship is never afloat it cannot wait
    until[times.node[first]] = times.end[first]
    if first.all():
        return network._replace(until=until)
    repeated = ~first[1:]
    between = 0.5 * (times.end[:-1][repeated] + times.begin[1:][repeated])  # middle of the dry time
    opens, closes = np.full(count, -np.inf), np.full(count, np.inf)
    extra_closes = np.full(len(between), np.inf)
    later = times.node[~first]
    same = later[1:] == later[:-1]
    extra_closes[:-1][same] = between[1:][same]
    starts = np.ones(len(later), bool)
    starts[1:] = ~same
    closes[later[starts]] = between[starts]
    states = network._replace(
        can_wait=np.append(network.can_wait, np.ones(len(later), bool)),
        station=np.append(network.station, later).astype(np.int32),
        opens=np.append(opens, between),
        closes=np.append(closes, extra_closes),
        until=np.append(until, times.end[~first]),
    )
    return _copy_edges(network, states, np.append(np.full(count, -np.inf), times.begin[~first]))


def _copy_edges(network: NetworkArrays, states: NetworkArrays, begin: FloatArray) -> NetworkArrays:
    """Join every state of a tail with those states of a head that can follow in time."""
    count = len(network.can_wait)
    order = np.argsort(states.station, kind="stable")
    copies = np.bincount(states.station, minlength=count)
    where = cumulative_sums(copies)
    degree = np.diff(network.indptr)[states.station]
    tail = np.repeat(np.arange(len(states.station)), degree)
    edge = _ranges(network.indptr[states.station], degree)
    state_count = copies[network.target[edge]]
    head = order[_ranges(where[network.target[edge]], state_count)]
    tail, edge = np.repeat(tail, state_count), np.repeat(edge, state_count)
    latest = np.where(network.can_wait[states.station[tail]], states.until[tail], np.inf)
    longest = np.fmax(network.length[edge] / _MIN_SPEED_OVER_GROUND, network.fixed_time[edge])
    latest = np.maximum(latest, states.closes[tail]) + longest
    follow = (states.closes[head] > states.opens[tail]) & (begin[head] <= latest)
    tail, edge, head = tail[follow], edge[follow], head[follow]
    samples = np.diff(network.via_ptr)[edge]
    via = _ranges(network.via_ptr[edge], samples)
    return states._replace(
        indptr=np.searchsorted(tail, np.arange(len(states.station) + 1)).astype(np.int64),
        target=head.astype(np.int32),
        length=network.length[edge],
        course=network.course[edge],
        depth=network.depth[edge],
        factor=network.factor[edge],
        fixed_time=network.fixed_time[edge],
        via_ptr=cumulative_sums(samples),
        via_a=network.via_a[via],
        via_b=network.via_b[via],
        via_w=network.via_w[via],
        via_s=network.via_s[via],
    )


def _ranges(start: IntArray, count: IntArray) -> IntArray:
    """Return the concatenation of ``start[i], start[i] + 1, ..., start[i] + count[i] - 1``."""
    group, number = numbered_parts(count)
    return start[group] + number
