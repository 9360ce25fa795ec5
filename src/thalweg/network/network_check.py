"""The public check of a network: shapes, values, samples, geometry and symmetry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core import geodesy
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray, Int32Array, IntArray
from thalweg.network.network import Network


def check_network(network: Network, *, symmetric: bool = False, sample: int = 200_000) -> None:
    """Check what every network guarantees; the networks of all builders pass.

    Parameters
    ----------
    network : Network
        The network.
    symmetric : bool, optional
        Check as well that every edge has an opposite of equal length.
    sample : int, optional
        Lengths and courses are checked on at most this many edges, evenly taken.

    Raises
    ------
    InputError
        With the list of all faults (``details["faults"]``).
    """
    faults = list(_shape_faults(network))
    if not faults:  # the values can only be read when the shapes are sound
        faults += _edge_faults(network)
        faults += _sample_faults(network)
        faults += _geometry_faults(network, sample)
        if symmetric:
            faults += _symmetry_faults(network)
    if faults:
        raise InputError(
            f"The network has {len(faults)} fault(s): " + "; ".join(faults) + ".",
            "A network fulfils what the documentation of its parts states.",
            "Correct the builder that made it.",
            faults=faults,
        )


def _shape_faults(net: Network) -> Iterator[str]:
    n, edges, samples, stations = net.n_nodes, net.n_edges, len(net.samples), net.n_stations
    for name, array, size, kind in _expected_arrays(net):
        if array.dtype != kind or array.ndim != 1 or not array.flags.c_contiguous:
            yield f"{name} is not a contiguous {np.dtype(kind).name} array of one dimension"
        elif len(array) != size:
            yield f"{name} has {len(array)} entries instead of {size}"
    if not 1 <= n <= stations:
        yield f"{n} nodes do not fit {stations} stations"
    for name, ptr, total in (
        ("graph.indptr", net.graph.indptr, edges),
        ("samples.ptr", net.samples.ptr, samples),
    ):
        if len(ptr) == 0 or ptr[0] != 0 or ptr[-1] != total or np.any(np.diff(ptr) < 0):
            yield f"{name} does not ascend from 0 to {total}"


def _expected_arrays(net: Network) -> Iterator[tuple[str, NDArray[Any], int, type]]:
    """Yield name, array, expected size and expected type of every array."""
    n, edges, samples, stations = net.n_nodes, net.n_edges, len(net.samples), net.n_stations
    whole, single, double = np.int32, np.float32, np.float64
    yield "stations.lat", net.stations.lat, stations, double
    yield "stations.lon", net.stations.lon, stations, double
    yield "graph.indptr", net.graph.indptr, n + 1, np.int64
    yield "graph.target", net.graph.target, edges, whole
    for name in ("length", "fixed_time", "fee"):
        yield f"edges.{name}", getattr(net.edges, name), edges, double
    for name in ("course", "depth", "penalty_factor", "price_factor"):
        yield f"edges.{name}", getattr(net.edges, name), edges, single
    yield "samples.ptr", net.samples.ptr, edges + 1, np.int64
    for name in ("station_a", "station_b"):
        yield f"samples.{name}", getattr(net.samples, name), samples, whole
    for name in ("weight", "fraction"):
        yield f"samples.{name}", getattr(net.samples, name), samples, single
    yield "can_wait", net.can_wait, n, np.bool_


def _edge_faults(net: Network) -> Iterator[str]:
    if not (np.isfinite(net.stations.lat).all() and np.isfinite(net.stations.lon).all()):
        yield "a station's position is not finite"
    elif np.abs(net.stations.lat).max() > 90.0:
        yield "a station's latitude is beyond 90 degrees"
    if np.any((net.graph.target < 0) | (net.graph.target >= net.n_nodes)):
        yield "an edge ends outside the nodes"
    if np.any(net.tails() == net.graph.target):
        yield "an edge returns to its own node"
    if not np.all(net.edges.length > 0.0):
        yield "a length is not positive"
    if not np.all(np.isfinite(net.edges.course)):
        yield "a course is not finite"
    if not np.all(net.edges.penalty_factor >= 1.0):
        yield "a penalty factor is below 1"
    if not np.all(net.edges.price_factor >= 0.0):
        yield "a price factor is negative"
    if not np.all(
        np.isnan(net.edges.fixed_time)
        | ((net.edges.fixed_time > 0.0) & np.isfinite(net.edges.fixed_time))
    ):
        yield "a fixed time is neither positive nor NaN"
    if not np.all((net.edges.fee >= 0.0) & np.isfinite(net.edges.fee)):
        yield "a fee is negative or not a number"
    for name in ("start", "goal"):
        if not -1 <= getattr(net.meta, name) < net.n_nodes:
            yield f"the {name} is not a node"


def _sample_faults(net: Network) -> Iterator[str]:
    if len(net.samples.station_a) == 0:
        return
    for stations in (net.samples.station_a, net.samples.station_b):
        if stations.min() < 0 or stations.max() >= len(net.stations.lat):
            yield "a sample refers to no station"
            return
    if not np.all((net.samples.weight >= 0.0) & (net.samples.weight <= 1.0)):
        yield "a sample's weight is outside 0 to 1"
    if not np.all((net.samples.fraction > 0.0) & (net.samples.fraction < 1.0)):
        yield "a sample is not inside its edge"
    rising = np.diff(net.samples.fraction) > 0.0
    first_of_edge = net.samples.ptr[1:-1]
    at_join = first_of_edge[(first_of_edge > 0) & (first_of_edge < len(net.samples.station_a))] - 1
    rising[at_join] = True
    if not rising.all():
        yield "the samples of an edge are not in order"


def _geometry_faults(net: Network, sample: int) -> Iterator[str]:
    if net.n_edges == 0 or np.any((net.graph.target < 0) | (net.graph.target >= net.n_nodes)):
        return
    edge = np.unique(np.linspace(0, net.n_edges - 1, min(sample, net.n_edges)).astype(np.int64))
    tail, head = net.tails()[edge], net.graph.target[edge]
    lat, lon = net.stations.lat, net.stations.lon
    length, first, _ = geodesy.inverse(lat[tail], lon[tail], lat[head], lon[head])
    sailed = np.isnan(net.edges.fixed_time[edge])
    if np.any(np.abs(net.edges.length[edge] - length)[sailed] > 1e-6 * length[sailed]):
        yield "a length is not that of the geodesic"
    if np.any(net.edges.length[edge][~sailed] < (1.0 - 1e-9) * length[~sailed]):
        yield "a canal is shorter than the geodesic"
    half = geodesy.direct(lat[tail], lon[tail], first, 0.5 * length)
    middle = geodesy.inverse(*half, lat[head], lon[head])[1]
    wrong = np.abs(np.angle(np.exp(1j * (net.edges.course[edge] - middle))))
    if np.any(wrong[np.abs(half[0]) < 89.9] > 1e-3):  # courses are undefined at the poles
        yield "a course is not that of the geodesic at mid-edge"
    yield from _position_faults(net, edge, tail, length, first)


def _position_faults(
    net: Network, edge: IntArray, tail: Int32Array, length: FloatArray, course: FloatArray
) -> Iterator[str]:
    """Yield a fault when samples lie farther than 3 % of their edge from where they should."""
    edge_of = np.repeat(np.arange(len(edge)), net.samples.ptr[edge + 1] - net.samples.ptr[edge])
    if len(edge_of) == 0:
        return
    within = np.arange(len(edge_of)) - np.searchsorted(edge_of, edge_of)
    via = net.samples.ptr[edge[edge_of]] + within
    start = tail[edge_of]
    lat, lon = net.stations.lat, net.stations.lon
    at = geodesy.direct(
        lat[start], lon[start], course[edge_of], net.samples.fraction[via] * length[edge_of]
    )
    a, b, w = net.samples.station_a[via], net.samples.station_b[via], net.samples.weight[via]
    there = geodesy.direct(
        lat[a], lon[a], geodesy.inverse(lat[a], lon[a], lat[b], lon[b])[1],
        w * geodesy.distance(lat[a], lon[a], lat[b], lon[b]),
    )  # fmt: skip
    off = geodesy.distance(at[0], at[1], there[0], there[1])
    if np.any(off > 0.03 * length[edge_of] + 1.0):
        yield "a sample does not lie on its edge"


def _symmetry_faults(net: Network) -> Iterator[str]:
    tail, head = net.tails().astype(np.int64), net.graph.target.astype(np.int64)
    there, back = tail * net.n_nodes + head, head * net.n_nodes + tail
    forward, backward = np.argsort(there), np.argsort(back)
    if np.any(there[forward] != back[backward]):
        yield "an edge has no opposite"
    elif np.any(
        np.abs(net.edges.length[forward] - net.edges.length[backward])
        > 1e-6 * net.edges.length[forward]
    ):
        yield "opposite edges differ in length"
