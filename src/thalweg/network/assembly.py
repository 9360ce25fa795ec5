"""Assembly of a network from pairs of nodes: land tests, lengths, depths, zones and the graph."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core import geodesy
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import BoolArray, Float32Array, FloatArray, Int32Array
from thalweg.kernels import codes
from thalweg.kernels.network import graph_building
from thalweg.network.network import Edges, Graph, Network, NetworkMeta, Samples, Stations

if TYPE_CHECKING:
    from thalweg.chart import Chart

RejectionCounts: TypeAlias = dict[str, int]
_CHUNK_SIZE = 100_000


@dataclass(frozen=True)
class Pairs:
    """Pairs of nodes joined in both directions: nodes, length [m] and mid-edge course [rad].

    Canals have no course (NaN).
    """

    first: Int32Array
    second: Int32Array
    length: FloatArray
    course: Float32Array

    def where(self, keep: BoolArray) -> Pairs:
        """Return the selected pairs."""
        if keep.all():
            return self
        return Pairs(self.first[keep], self.second[keep], self.length[keep], self.course[keep])


def allowed_legs(
    chart: Chart,
    lat: FloatArray,
    lon: FloatArray,
    first: NDArray[np.integer],
    second: NDArray[np.integer],
) -> tuple[BoolArray, RejectionCounts]:
    """Return which legs between positions the chart allows, and counts of refusals by reason.

    Canals are not legs at sea; the builders add them as separate edges.

    Parameters
    ----------
    chart : Land, zones and depth.
    lat, lon : Positions [deg], (N,).
    first, second : Indices of the ends of each leg, (P,).

    Returns
    -------
    allowed : Legs that the chart allows, (P,).
    counts : Number of refused legs by reason.
    """
    chart = chart.without_canals("all")
    free = np.empty(len(first), bool)
    rejected: RejectionCounts = {}
    for begin in range(0, len(first), _CHUNK_SIZE):
        a, b = first[begin : begin + _CHUNK_SIZE], second[begin : begin + _CHUNK_SIZE]
        status = np.asarray(chart.leg_status(lat[a], lon[a], lat[b], lon[b]))
        free[begin : begin + _CHUNK_SIZE] = status == codes.OK
        add_counts(rejected, count_reasons(status))
    return free, rejected


def count_reasons(status: NDArray[np.integer]) -> RejectionCounts:
    """Return counts by reason of statuses that are not OK."""
    values, counts = np.unique(status, return_counts=True)
    return {
        codes.REASONS.get(int(value), "outside the chart"): int(count)
        for value, count in zip(values, counts)
        if value != codes.OK
    }


def add_counts(total: RejectionCounts, more: RejectionCounts) -> None:
    """Add counts by reason to a running total.

    Parameters
    ----------
    total : Counts by reason; changed in place.
    more : Counts to add.
    """
    for reason, count in more.items():
        total[reason] = total.get(reason, 0) + count


def measured_pairs(
    lat: FloatArray, lon: FloatArray, first: Int32Array, second: Int32Array
) -> Pairs:
    """Return pairs with geodesic lengths and mid-edge courses.

    Parameters
    ----------
    lat, lon : Positions of the nodes [deg], (N,).
    first, second : Nodes of each pair, (P,).

    Returns
    -------
    Pairs : With lengths [m] and courses at the middle [rad].
    """
    length, course = np.empty(len(first)), np.empty(len(first), np.float32)
    graph_building.fill_lengths_and_courses(lat, lon, first, second, length, course)
    for e in np.flatnonzero(np.isnan(length)):  # nearly antipodal: only ever single edges
        a, b = first[e], second[e]
        length[e], start, end = geodesy.inverse(lat[a], lon[a], lat[b], lon[b])
        course[e] = np.angle(np.exp(1j * start) + np.exp(1j * end)) % (2 * np.pi)
    return Pairs(first, second, length, course)


#: Positions on legs from places, their ends, their lengths [m], and the shares of these.
LegPositions: TypeAlias = Callable[..., tuple[FloatArray, FloatArray]]


def evenly_spaced_samples(
    stations: Stations,
    pairs: Pairs,
    spacing: FloatArray | float,
    positions: LegPositions | None = None,
) -> tuple[Stations, Samples]:
    """Sample pairs at new stations on their geodesics, at most ``spacing`` [m] apart.

    Parameters
    ----------
    stations : Nodes.
    pairs : Pairs of nodes.
    spacing : Of samples [m].
    positions : How positions on legs are computed; None: on their geodesics.

    Returns
    -------
    stations : With the new stations appended.
    samples : Evenly spaced samples of every pair.
    """
    pieces = np.maximum(1, np.ceil(pairs.length / spacing - 1e-9)).astype(np.int64)
    ptr = cumulative_sums(pieces - 1)
    of = np.repeat(np.arange(len(pairs.first)), pieces - 1)
    s = (np.arange(len(of)) - ptr[of] + 1) / pieces[of]
    lat, lon = stations.lat, stations.lon
    first, second = pairs.first[of], pairs.second[of]
    if positions is None:
        ends = lat[first], lon[first], lat[second], lon[second]
        new_lat, new_lon = geodesy.positions_along(*ends, s)
    else:
        new_lat, new_lon = positions(lat, lon, first, second, pairs.length[of], s)
    ids = (len(lat) + np.arange(len(of))).astype(np.int32)
    samples = Samples(ptr, ids, ids.copy(), np.zeros(len(of), np.float32), s.astype(np.float32))
    grown = replace(stations, lat=np.append(lat, new_lat), lon=np.append(lon, new_lon))
    return grown, samples


@dataclass(frozen=True)
class DirectedEdges:
    """Directed edges of pairs.

    Attributes
    ----------
    graph : Which nodes the edges join.
    pair : int32[E]
        Pair that each edge belongs to.
    reversed : bool[E]
        Whether the edge runs from the second node of the pair to the first.
    """

    graph: Graph
    pair: Int32Array
    reversed: BoolArray


def directed_edges(n_nodes: int, pairs: Pairs) -> DirectedEdges:
    """Return two opposite edges for every pair."""
    indptr, target, pair, backward = graph_building.directed_edges_of_pairs(
        n_nodes, pairs.first, pairs.second
    )
    return DirectedEdges(Graph(indptr, target), pair, backward)


def assemble(
    chart: Chart,
    stations: Stations,
    pairs: Pairs,
    samples: Samples,
    *,
    meta: NetworkMeta,
    directed: DirectedEdges | None = None,
) -> Network:
    """Return the network with two opposite edges for every pair.

    Parameters
    ----------
    chart : Gives depth, zones, canals and waiting places; the pairs must have been tested on it.
    stations : Nodes and sample stations.
    pairs : Pairs of nodes to join.
    samples : Samples of the pairs.
    meta : Description of the network.
    directed : The directed edges of the pairs, where they are known.
    """
    directed = directed or directed_edges(stations.n_nodes, pairs)
    course = _with_canal_courses(stations, pairs)[directed.pair]
    course[directed.reversed] += np.float32(np.pi)
    course[course >= 2 * np.pi] -= np.float32(2 * np.pi)
    properties, penalty_back = _pair_properties(chart, stations, pairs)
    edges = properties.take(directed.pair)
    if chart.zones.lanes:
        back = np.flatnonzero(directed.reversed)
        edges.penalty_factor[back] = penalty_back[directed.pair[back]]
    return Network(
        stations,
        directed.graph,
        replace(edges, course=course),
        Samples(
            *graph_building.mirror_samples(directed.pair, directed.reversed, *samples.arrays())
        ),
        _waiting_places(chart, stations, meta),
        meta,
    )


def _waiting_places(chart: Chart, stations: Stations, meta: NetworkMeta) -> BoolArray:
    """Return at which nodes a ship may wait: where the chart allows it, and at start and goal."""
    n = stations.n_nodes
    allowed = np.array(chart.may_wait(stations.lat[:n], stations.lon[:n]))
    allowed[[end for end in (meta.start, meta.goal) if end >= 0]] = True
    return allowed


def _with_canal_courses(stations: Stations, pairs: Pairs) -> Float32Array:
    """Return the courses of pairs [rad]; of canals that of the line between their ends."""
    canal = np.flatnonzero(np.isnan(pairs.course))
    course = pairs.course.copy()
    if not len(canal):
        return course
    first, second = pairs.first[canal], pairs.second[canal]
    course[canal] = measured_pairs(stations.lat, stations.lon, first, second).course
    return course


def _pair_properties(chart: Chart, stations: Stations, pairs: Pairs) -> tuple[Edges, Float32Array]:
    """Return the properties of pairs as edges from their first node to their second.

    The second result holds the penalty factors of the edges back.
    """
    count = len(pairs.first)
    depth = np.full(count, np.inf, np.float32)
    penalty, back, price = np.ones((3, count), np.float32)
    for begin in range(0, count, _CHUNK_SIZE):
        part = slice(begin, begin + _CHUNK_SIZE)
        ends = _ends(stations, pairs.first[part], pairs.second[part])
        if chart.has_depth:
            depth[part] = chart.depths.along(*ends)
        penalty[part], back[part], price[part] = chart.zones.factors_both_ways(*ends)
    fixed_time, fee = np.full(count, np.nan), np.zeros(count)
    canals = np.flatnonzero(np.isnan(pairs.course))
    depth[canals], penalty[canals], back[canals], price[canals] = np.inf, 1.0, 1.0, 1.0
    if len(canals):
        ends = _ends(stations, pairs.first[canals], pairs.second[canals])
        for pair, number in zip(canals, chart.canal_of_legs(*ends)):
            canal = chart.canals[number]
            fixed_time[pair], fee[pair] = canal.transit_time, canal.fee
    edges = Edges(pairs.length, pairs.course, depth, penalty, price, fixed_time, fee)
    return edges, back


def _ends(
    stations: Stations, first: Int32Array, second: Int32Array
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    lat, lon = stations.lat, stations.lon
    return lat[first], lon[first], lat[second], lon[second]
