"""From pairs of nodes to a network: land tests, lengths, depths, zones and the CSR."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core import geodesy
from thalweg.core.types import BoolArray, Float32Array, FloatArray, Int32Array, IntArray
from thalweg.kernels import codes
from thalweg.kernels.network import graph_building
from thalweg.network.network import Network, NetworkMeta

if TYPE_CHECKING:
    from thalweg.chart import Chart

RejectionCounts: TypeAlias = dict[str, int]
_CHUNK_SIZE = 1_000_000


@dataclass(frozen=True)
class Stations:
    """Positions [deg]: the nodes first, then extra samples."""

    lat: FloatArray
    lon: FloatArray
    n_nodes: int


@dataclass(frozen=True)
class Samples:
    """Interior samples of pairs or edges, as in `Network`."""

    ptr: IntArray
    a: Int32Array
    b: Int32Array
    w: Float32Array
    s: Float32Array


@dataclass(frozen=True)
class Pairs:
    """Pairs of nodes joined both ways: their nodes, length [m] and mid-edge course [rad].

    Canals have no course (NaN).
    """

    first: Int32Array
    second: Int32Array
    length: FloatArray
    course: Float32Array

    def where(self, keep: BoolArray) -> Pairs:
        """Return the pairs that are kept."""
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

    Canals are no legs to sail: builders that know them add them as edges of their own.
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
    """Add counts by reason to a running total."""
    for reason, count in more.items():
        total[reason] = total.get(reason, 0) + count


def measured_pairs(
    lat: FloatArray, lon: FloatArray, first: Int32Array, second: Int32Array
) -> Pairs:
    """Return pairs with geodesic lengths and mid-edge courses."""
    length, course = np.empty(len(first)), np.empty(len(first), np.float32)
    graph_building.fill_lengths_and_courses(lat, lon, first, second, length, course)
    for e in np.flatnonzero(np.isnan(length)):  # nearly antipodal: only ever single edges
        a, b = first[e], second[e]
        length[e], start, end = geodesy.inverse(lat[a], lon[a], lat[b], lon[b])
        course[e] = np.angle(np.exp(1j * start) + np.exp(1j * end)) % (2 * np.pi)
    return Pairs(first, second, length, course)


def no_samples(count: int) -> Samples:
    """Return empty samples for a number of pairs."""
    empty_int, empty = np.empty(0, np.int32), np.empty(0, np.float32)
    return Samples(np.zeros(count + 1, np.int64), empty_int, empty_int, empty, empty)


def evenly_spaced_samples(
    stations: Stations, pairs: Pairs, spacing: FloatArray | float
) -> tuple[Stations, Samples]:
    """Sample pairs at new stations on their geodesics, at most ``spacing`` [m] apart.

    Returns
    -------
    stations : Stations
        With the new stations appended.
    samples : Samples
        Evenly spaced samples of every pair.
    """
    pieces = np.maximum(1, np.ceil(pairs.length / spacing - 1e-9)).astype(np.int64)
    ptr = np.concatenate([[0], np.cumsum(pieces - 1)])
    of = np.repeat(np.arange(len(pairs.first)), pieces - 1)
    s = (np.arange(len(of)) - ptr[of] + 1) / pieces[of]
    a, b = pairs.first[of], pairs.second[of]
    lat, lon = stations.lat, stations.lon
    _, course, _ = geodesy.inverse(lat[a], lon[a], lat[b], lon[b])
    new_lat, new_lon = geodesy.direct(lat[a], lon[a], course, s * pairs.length[of])
    ids = (len(lat) + np.arange(len(of))).astype(np.int32)
    samples = Samples(ptr, ids, ids.copy(), np.zeros(len(of), np.float32), s.astype(np.float32))
    grown = replace(stations, lat=np.append(lat, new_lat), lon=np.append(lon, new_lon))
    return grown, samples


def concatenate_samples(parts: list[Samples]) -> Samples:
    """Return the samples of consecutive lots of pairs as one."""
    if len(parts) == 1:
        return parts[0]
    shifts = np.cumsum([0] + [part.ptr[-1] for part in parts])
    ptr = np.concatenate(
        [[0]] + [part.ptr[1:] + shift for part, shift in zip(parts, shifts)]
    ).astype(np.int64)
    columns = [np.concatenate([getattr(part, c) for part in parts]) for c in "abws"]
    return Samples(ptr, *columns)


@dataclass(frozen=True)
class DirectedEdges:
    """Directed edges by tail: their heads, the pair each comes from, and whether reversed."""

    indptr: IntArray
    target: Int32Array
    pair: Int32Array
    back: BoolArray


def directed_edges(n_nodes: int, pairs: Pairs) -> DirectedEdges:
    """Return an edge each way for every pair."""
    return DirectedEdges(
        *graph_building.directed_edges_of_pairs(n_nodes, pairs.first, pairs.second)
    )


def assemble(
    chart: Chart,
    stations: Stations,
    pairs: Pairs,
    samples: Samples,
    *,
    meta: NetworkMeta,
    edges: DirectedEdges | None = None,
) -> Network:
    """Return the network with an edge each way for every pair; all pairs have been tested."""
    n = stations.n_nodes
    depth, factor, price = _edge_properties(chart, stations, pairs)
    edges = edges or directed_edges(n, pairs)
    pair = edges.pair
    fixed_time, fee, own_course = _canal_properties(chart, stations, pairs)
    via_ptr, via_a, via_b, via_w, via_s = graph_building.mirror_samples(
        pair, edges.back, samples.ptr, samples.a, samples.b, samples.w, samples.s
    )
    course = own_course[pair]
    course[edges.back] += np.float32(np.pi)
    course[course >= 2 * np.pi] -= np.float32(2 * np.pi)
    return Network(
        station_lat=stations.lat, station_lon=stations.lon, n_nodes=n,
        indptr=edges.indptr, target=edges.target, length=pairs.length[pair], course=course,
        depth=depth[pair], factor=factor[pair], price=price[pair],
        via_ptr=via_ptr, via_a=via_a, via_b=via_b, via_w=via_w, via_s=via_s,
        can_wait=_waiting_places(chart, stations, meta), meta=meta,
        fixed_time=fixed_time[pair], fee=fee[pair],
    )  # fmt: skip


def _waiting_places(chart: Chart, stations: Stations, meta: NetworkMeta) -> BoolArray:
    """Return at which nodes a ship may wait: where the chart allows it, and at her berths."""
    n = stations.n_nodes
    allowed = np.array(chart.may_wait(stations.lat[:n], stations.lon[:n]))
    allowed[[end for end in (meta.start, meta.goal) if end >= 0]] = True
    return allowed


def _canal_properties(
    chart: Chart, stations: Stations, pairs: Pairs
) -> tuple[FloatArray, FloatArray, Float32Array]:
    """Return the time of pairs that are canals [s], else NaN, their fee [USD], all courses."""
    time, fee = np.full(len(pairs.first), np.nan), np.zeros(len(pairs.first))
    here = np.flatnonzero(np.isnan(pairs.course))
    if not len(here):
        return time, fee, pairs.course
    a, b = pairs.first[here], pairs.second[here]
    lat, lon, course = stations.lat, stations.lon, pairs.course.copy()
    course[here] = measured_pairs(lat, lon, a, b).course
    for pair, canal in zip(here, chart.canal_of_legs(lat[a], lon[a], lat[b], lon[b])):
        time[pair], fee[pair] = chart.canals[canal].transit_time, chart.canals[canal].fee
    return time, fee, course


def _edge_properties(
    chart: Chart, stations: Stations, pairs: Pairs
) -> tuple[Float32Array, Float32Array, Float32Array]:
    """Return least depth, penalty factor and price factor of pairs."""
    count = len(pairs.first)
    depth = np.full(count, np.inf, np.float32)
    factor, price = np.ones(count, np.float32), np.ones(count, np.float32)
    for begin in range(0, count, _CHUNK_SIZE):
        part = slice(begin, begin + _CHUNK_SIZE)
        a, b = pairs.first[part], pairs.second[part]
        ends = (stations.lat[a], stations.lon[a], stations.lat[b], stations.lon[b])
        if chart.has_depth:
            depth[part] = chart.depth_along(*ends)
        factor[part], price[part] = chart.zone_factor(*ends)
    canal = np.isnan(pairs.course)
    depth[canal], factor[canal], price[canal] = np.inf, 1.0, 1.0
    return depth, factor, price
