"""The network: a directed graph as plain arrays, and the public check of what it promises."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from thalweg.core import geodesy
from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, Float32Array, FloatArray, Int32Array, IntArray
from thalweg.kernels.network import graph_building
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.distance_bounds import distance_bounds


@dataclass(frozen=True)
class NetworkMeta:
    """What a network is and how it was made.

    Parameters
    ----------
    kind : str
        Name of the builder.
    spacing_m : float
        Largest spacing of its nodes [m].
    directions : int
        Number of directions that leave a node in open water.
    gap_rad : float
        Largest angle between neighbouring directions [rad]; the way over the network is at most
        ``1 / cos(gap_rad / 2)`` times as long as the shortest way in open water.
    rejected : dict of str to int
        How many legs were refused while building, by reason.
    start, goal : int
        Nodes at the exact start and goal, or -1. Via points follow the goal in order.
    notes : tuple of str
        What was done otherwise than asked, in words.
    """

    kind: str
    spacing_m: float
    directions: int
    gap_rad: float
    rejected: dict[str, int] = field(default_factory=dict)
    start: int = -1
    goal: int = -1
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Network:
    """A directed graph on the sea: N nodes, E edges, S stations where the sea is sampled.

    Parameters
    ----------
    station_lat, station_lon : ndarray (S,)
        Positions [deg] where fields are sampled; the first ``n_nodes`` are the nodes.
    n_nodes : int
        Number of nodes N.
    indptr : int64 ndarray (N + 1,), target : int32 ndarray (E,)
        The edges that leave node n are ``indptr[n]:indptr[n + 1]`` and end at ``target``.
    length : ndarray (E,)
        Length of the geodesic [m].
    course : float32 ndarray (E,)
        Course at mid-edge, clockwise from north [rad].
    depth : float32 ndarray (E,)
        Least charted depth along the edge [m]; +inf when not checked, NaN when unknown.
    factor, price : float32 ndarray (E,)
        Penalty multiplier (at least 1) and price factor.
    via_ptr : int64 ndarray (E + 1,)
        The interior samples of edge e are ``via_ptr[e]:via_ptr[e + 1]``.
    via_a, via_b : int32 ndarray (V,), via_w, via_s : float32 ndarray (V,)
        A sample's value is ``(1 - w) * station[a] + w * station[b]``; it lies at fraction s of
        its edge, 0 < s < 1, ascending.
    can_wait : bool ndarray (N,)
        Nodes where a ship may wait.
    meta : NetworkMeta
        What the network is and how it was made.
    fixed_time : ndarray (E,)
        Time of edges that take the same time whatever the sea is (canals) [s]; NaN for edges that
        are sailed. Their ``length`` is that of the canal. Left out: all are sailed.
    fee : ndarray (E,)
        Money that an edge costs [USD]. Left out: nothing.
    """

    station_lat: FloatArray
    station_lon: FloatArray
    n_nodes: int
    indptr: IntArray
    target: Int32Array
    length: FloatArray
    course: Float32Array
    depth: Float32Array
    factor: Float32Array
    price: Float32Array
    via_ptr: IntArray
    via_a: Int32Array
    via_b: Int32Array
    via_w: Float32Array
    via_s: Float32Array
    can_wait: BoolArray
    meta: NetworkMeta
    fixed_time: FloatArray = field(default_factory=lambda: np.empty(0))
    fee: FloatArray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        edges = len(self.target)
        # left out, or nothing but defaults for another number of edges
        if len(self.fixed_time) != edges and np.isnan(self.fixed_time).all():
            object.__setattr__(self, "fixed_time", np.full(edges, np.nan))
        if len(self.fee) != edges and not self.fee.any():
            object.__setattr__(self, "fee", np.zeros(edges))

    @property
    def n_edges(self) -> int:
        """Number of directed edges."""
        return len(self.target)

    @property
    def n_stations(self) -> int:
        """Number of positions where fields are sampled."""
        return len(self.station_lat)

    @property
    def lat(self) -> FloatArray:
        """Latitudes of the nodes [deg]."""
        return self.station_lat[: self.n_nodes]

    @property
    def lon(self) -> FloatArray:
        """Longitudes of the nodes [deg]."""
        return self.station_lon[: self.n_nodes]

    def times(self, speed: float) -> FloatArray:
        """Return the time of every edge [s] at one speed over ground [m/s]; canals take theirs."""
        return np.where(np.isnan(self.fixed_time), self.length / speed, self.fixed_time)

    def tails(self) -> Int32Array:
        """Return the node every edge leaves from."""
        return np.repeat(np.arange(self.n_nodes, dtype=np.int32), np.diff(self.indptr))


def shortest_path(
    network: Network,
    start: int,
    goal: int = -1,
    *,
    weight: FloatArray | None = None,
    per_metre: float | None = None,
) -> tuple[FloatArray, list[int]]:
    """Return static least sums of edge weights from a node, and the path to the goal.

    Parameters
    ----------
    network : Network
        The network.
    start, goal : int
        Nodes; without a goal (-1) all nodes are labelled and the path is empty.
    weight : ndarray (E,), optional
        Non-negative weight of each edge (default: its length [m]; `Network.times` for time).

    per_metre : float, optional
        No edge weighs less than this for each metre between its ends as the crow flies; with it
        the search aims at the goal (A*). By default 1 for lengths, else 0.

    Returns
    -------
    distance : ndarray (N,)
        Least sums; inf where unreached. With a goal they are final only for the nodes on the way.
    path : list of int
        Nodes from start to goal; empty when there is no way.
    """
    weights = network.length if weight is None else np.asarray(weight, float)
    distance, parent = np.empty(network.n_nodes), np.empty(network.n_nodes, np.int64)
    if per_metre is None:
        per_metre = 1.0 if weight is None else 0.0
    if goal >= 0 and per_metre > 0.0:
        to = float(network.lat[goal]), float(network.lon[goal])
        bound = per_metre * distance_bounds(network.lat, network.lon, *to)
        static_astar(network.indptr, network.target, weights, bound, start, goal, distance, parent)
    else:
        arrays = network.indptr, network.target, weights
        graph_building.static_dijkstra(*arrays, start, goal, distance, parent)
    if goal < 0 or not np.isfinite(distance[goal]):
        return distance, []
    path = [goal]
    while path[-1] != start:
        path.append(int(parent[path[-1]]))
    return distance, path[::-1]


def check_network(network: Network, *, symmetric: bool = False, sample: int = 200_000) -> None:
    """Check everything a network promises; every builder passes it.

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
        faults += _via_faults(network)
        faults += _geometry_faults(network, sample)
        if symmetric:
            faults += _symmetry_faults(network)
    if faults:
        raise InputError(
            f"The network breaks {len(faults)} promise(s): " + "; ".join(faults) + ".",
            "A network keeps the promises listed in the documentation of Network.",
            "Correct the builder that made it.",
            faults=faults,
        )


def _shape_faults(net: Network) -> Iterator[str]:
    n, edges, vias = net.n_nodes, len(net.target), len(net.via_a)
    wanted = {
        "station_lon": (len(net.station_lat), np.float64), "station_lat": (None, np.float64),
        "indptr": (n + 1, np.int64), "target": (edges, np.int32), "length": (edges, np.float64),
        "course": (edges, np.float32), "depth": (edges, np.float32),
        "factor": (edges, np.float32), "price": (edges, np.float32),
        "via_ptr": (edges + 1, np.int64), "via_a": (vias, np.int32), "via_b": (vias, np.int32),
        "via_w": (vias, np.float32), "via_s": (vias, np.float32), "can_wait": (n, np.bool_),
        "fixed_time": (edges, np.float64), "fee": (edges, np.float64),
    }  # fmt: skip
    for name, (size, kind) in wanted.items():
        array = getattr(net, name)
        if array.dtype != kind or array.ndim != 1 or not array.flags.c_contiguous:
            yield f"{name} is not a contiguous {np.dtype(kind).name} array of one dimension"
        elif size is not None and len(array) != size:
            yield f"{name} has {len(array)} entries instead of {size}"
    if not 1 <= n <= len(net.station_lat):
        yield f"{n} nodes do not fit {len(net.station_lat)} stations"
    for name, total in (("indptr", edges), ("via_ptr", vias)):
        ptr = getattr(net, name)
        if len(ptr) == 0 or ptr[0] != 0 or ptr[-1] != total or np.any(np.diff(ptr) < 0):
            yield f"{name} does not ascend from 0 to {total}"


def _edge_faults(net: Network) -> Iterator[str]:
    if not (np.isfinite(net.station_lat).all() and np.isfinite(net.station_lon).all()):
        yield "a station's position is not finite"
    elif np.abs(net.station_lat).max() > 90.0:
        yield "a station's latitude is beyond 90 degrees"
    if np.any((net.target < 0) | (net.target >= net.n_nodes)):
        yield "an edge ends outside the nodes"
    if np.any(net.tails() == net.target):
        yield "an edge returns to its own node"
    if not np.all(net.length > 0.0):
        yield "a length is not positive"
    if not np.all(np.isfinite(net.course)):
        yield "a course is not finite"
    if not np.all(net.factor >= 1.0):
        yield "a penalty factor is below 1"
    if not np.all(net.price >= 0.0):
        yield "a price factor is negative"
    if not np.all(
        np.isnan(net.fixed_time) | ((net.fixed_time > 0.0) & np.isfinite(net.fixed_time))
    ):
        yield "a fixed time is neither positive nor NaN"
    if not np.all((net.fee >= 0.0) & np.isfinite(net.fee)):
        yield "a fee is negative or no number"
    for name in ("start", "goal"):
        if not -1 <= getattr(net.meta, name) < net.n_nodes:
            yield f"the {name} is not a node"


def _via_faults(net: Network) -> Iterator[str]:
    if len(net.via_a) == 0:
        return
    for via in (net.via_a, net.via_b):
        if via.min() < 0 or via.max() >= len(net.station_lat):
            yield "a sample refers to no station"
            return
    if not np.all((net.via_w >= 0.0) & (net.via_w <= 1.0)):
        yield "a sample's weight is outside 0 to 1"
    if not np.all((net.via_s > 0.0) & (net.via_s < 1.0)):
        yield "a sample is not inside its edge"
    rising = np.diff(net.via_s) > 0.0
    first_of_edge = net.via_ptr[1:-1]
    at_join = first_of_edge[(first_of_edge > 0) & (first_of_edge < len(net.via_a))] - 1
    rising[at_join] = True
    if not rising.all():
        yield "the samples of an edge are not in order"


def _geometry_faults(net: Network, sample: int) -> Iterator[str]:
    if net.n_edges == 0 or np.any((net.target < 0) | (net.target >= net.n_nodes)):
        return
    edge = np.unique(np.linspace(0, net.n_edges - 1, min(sample, net.n_edges)).astype(np.int64))
    tail, head = net.tails()[edge], net.target[edge]
    lat, lon = net.station_lat, net.station_lon
    length, first, _ = geodesy.inverse(lat[tail], lon[tail], lat[head], lon[head])
    sailed = np.isnan(net.fixed_time[edge])
    if np.any(np.abs(net.length[edge] - length)[sailed] > 1e-6 * length[sailed]):
        yield "a length is not that of the geodesic"
    if np.any(net.length[edge][~sailed] < (1.0 - 1e-9) * length[~sailed]):
        yield "a canal is shorter than the geodesic"
    half = geodesy.direct(lat[tail], lon[tail], first, 0.5 * length)
    middle = geodesy.inverse(*half, lat[head], lon[head])[1]
    wrong = np.abs(np.angle(np.exp(1j * (net.course[edge] - middle))))
    if np.any(wrong[np.abs(half[0]) < 89.9] > 1e-3):  # courses mean nothing at the poles
        yield "a course is not that of the geodesic at mid-edge"
    yield from _position_faults(net, edge, tail, length, first)


def _position_faults(
    net: Network, edge: IntArray, tail: Int32Array, length: FloatArray, course: FloatArray
) -> Iterator[str]:
    """Yield a fault when samples lie farther than 3 % of their edge from where they should."""
    edge_of = np.repeat(np.arange(len(edge)), net.via_ptr[edge + 1] - net.via_ptr[edge])
    if len(edge_of) == 0:
        return
    within = np.arange(len(edge_of)) - np.searchsorted(edge_of, edge_of)
    via = net.via_ptr[edge[edge_of]] + within
    start = tail[edge_of]
    lat, lon = net.station_lat, net.station_lon
    at = geodesy.direct(lat[start], lon[start], course[edge_of], net.via_s[via] * length[edge_of])
    a, b, w = net.via_a[via], net.via_b[via], net.via_w[via]
    there = geodesy.direct(
        lat[a], lon[a], geodesy.inverse(lat[a], lon[a], lat[b], lon[b])[1],
        w * geodesy.distance(lat[a], lon[a], lat[b], lon[b]),
    )  # fmt: skip
    off = geodesy.distance(at[0], at[1], there[0], there[1])
    if np.any(off > 0.03 * length[edge_of] + 1.0):
        yield "a sample does not lie on its edge"


def _symmetry_faults(net: Network) -> Iterator[str]:
    tail, head = net.tails().astype(np.int64), net.target.astype(np.int64)
    there, back = tail * net.n_nodes + head, head * net.n_nodes + tail
    forward, backward = np.argsort(there), np.argsort(back)
    if np.any(there[forward] != back[backward]):
        yield "an edge has no opposite"
    elif np.any(np.abs(net.length[forward] - net.length[backward]) > 1e-6 * net.length[forward]):
        yield "opposite edges differ in length"
