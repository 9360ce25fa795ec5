"""The network: a directed graph on the sea as plain arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import BoolArray, Float32Array, FloatArray, Int32Array, IntArray
from thalweg.deprecated_names import renamed_attributes


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
        Largest angle between neighbouring directions [rad]; the shortest path on the network is at
        most ``1 / cos(gap_rad / 2)`` times as long as the shortest path in the open water that the
        nodes cover (a lattice along parallels has none beyond 84 degrees of latitude).
    rejected : dict of str to int
        How many legs were refused while building, by reason.
    start, goal : int
        Nodes at the exact start and goal, or -1. Via points follow the goal in order.
    notes : tuple of str
        Text for each difference between the network and the request.
    """

    kind: str
    spacing_m: float
    directions: int
    gap_rad: float
    rejected: dict[str, int] = field(default_factory=dict)
    start: int = -1
    goal: int = -1
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Stations:
    """Positions where the sea is sampled: the nodes first, then the samples between nodes.

    Parameters
    ----------
    lat, lon : float64 ndarray (S,)
        Positions [deg].
    n_nodes : int
        Number of nodes N.
    """

    lat: FloatArray
    lon: FloatArray
    n_nodes: int


@dataclass(frozen=True, eq=False)
class Graph:
    """Directed edges by their first node (compressed sparse rows).

    Parameters
    ----------
    indptr : int64 ndarray (N + 1,)
        The edges that leave node n are ``indptr[n]:indptr[n + 1]``.
    target : int32 ndarray (E,)
        Node at the end of each edge.
    """

    indptr: IntArray
    target: Int32Array

    def tails(self) -> Int32Array:
        """Return the node that every edge leaves.

        Returns
        -------
        int32 array (E,)
            Nodes.
        """
        nodes = np.arange(len(self.indptr) - 1, dtype=np.int32)
        return np.repeat(nodes, np.diff(self.indptr))


@dataclass(frozen=True, eq=False)
class Edges:
    """Properties of the edges, in the order of the graph.

    Parameters
    ----------
    length : float64 ndarray (E,)
        Length of the geodesic [m]; of a canal its own length.
    course : float32 ndarray (E,)
        Course at mid-edge, clockwise from north [rad].
    depth : float32 ndarray (E,)
        Least charted depth along the edge [m]; +inf when not checked, NaN when unknown.
    penalty_factor : float32 ndarray (E,)
        The length counts this many times (at least 1).
    price_factor : float32 ndarray (E,)
        Fuel costs this many times its price.
    fixed_time : float64 ndarray (E,), optional
        Time of edges that do not depend on the sea (canals) [s]; NaN for edges that are sailed.
        By default all are sailed.
    fee : float64 ndarray (E,), optional
        Fee for passing an edge [USD]. By default none.
    """

    length: FloatArray
    course: Float32Array
    depth: Float32Array
    penalty_factor: Float32Array
    price_factor: Float32Array
    fixed_time: FloatArray = field(default_factory=lambda: np.empty(0))
    fee: FloatArray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        count = len(self.length)
        if len(self.fixed_time) == 0:
            object.__setattr__(self, "fixed_time", np.full(count, np.nan))
        if len(self.fee) == 0:
            object.__setattr__(self, "fee", np.zeros(count))

    def __len__(self) -> int:
        return len(self.length)

    def take(self, edges: NDArray[Any]) -> Edges:
        """Return the properties of some edges.

        Parameters
        ----------
        edges : array
            Indices of edges, or a mask (E,).

        Returns
        -------
        Edges
            In the order of the indices.
        """
        return Edges(*(getattr(self, column.name)[edges] for column in fields(Edges)))

    @staticmethod
    def concatenate(parts: Sequence[Edges]) -> Edges:
        """Return the edges of several parts as one.

        Parameters
        ----------
        parts : sequence of Edges
            One or more.

        Returns
        -------
        Edges
            In the order of the parts.
        """
        return Edges(
            *(np.concatenate([getattr(part, c.name) for part in parts]) for c in fields(Edges))
        )


@dataclass(frozen=True, eq=False)
class Samples:
    """Where the sea is sampled inside edges: V samples, each a blend of two stations.

    The value of a sample is ``(1 - weight) * value[station_a] + weight * value[station_b]``.

    Parameters
    ----------
    ptr : int64 ndarray (E + 1,)
        The samples of edge e are ``ptr[e]:ptr[e + 1]``.
    station_a, station_b : int32 ndarray (V,)
        The two stations; the same where the sample is a station.
    weight : float32 ndarray (V,)
        Weight of the second station, 0 to 1.
    fraction : float32 ndarray (V,)
        Fraction of the edge at which the sample lies, above 0 and below 1, ascending.
    """

    ptr: IntArray
    station_a: Int32Array
    station_b: Int32Array
    weight: Float32Array
    fraction: Float32Array

    def __len__(self) -> int:
        return len(self.station_a)

    def arrays(self) -> tuple[IntArray, Int32Array, Int32Array, Float32Array, Float32Array]:
        """Return the arrays in the order in which kernels take them.

        Returns
        -------
        ptr, station_a, station_b, weight, fraction : array
            The attributes of these names.
        """
        return self.ptr, self.station_a, self.station_b, self.weight, self.fraction

    @staticmethod
    def none(count: int) -> Samples:
        """Return no samples.

        Parameters
        ----------
        count : int
            Number of edges.

        Returns
        -------
        Samples
            Of edges without samples between their nodes.
        """
        empty_int, empty = np.empty(0, np.int32), np.empty(0, np.float32)
        return Samples(np.zeros(count + 1, np.int64), empty_int, empty_int, empty, empty)

    @staticmethod
    def concatenate(parts: Sequence[Samples]) -> Samples:
        """Return the samples of consecutive groups of edges as one.

        Parameters
        ----------
        parts : sequence of Samples
            One or more, in the order of the edges.

        Returns
        -------
        Samples
            Of all edges.
        """
        shifts = np.cumsum([0] + [part.ptr[-1] for part in parts])
        ptr = np.concatenate([[0]] + [part.ptr[1:] + shift for part, shift in zip(parts, shifts)])
        columns = ("station_a", "station_b", "weight", "fraction")
        return Samples(
            ptr.astype(np.int64),
            *(np.concatenate([getattr(part, name) for part in parts]) for name in columns),
        )


@dataclass(frozen=True, eq=False)
class Network:
    """A directed graph on the sea: N nodes, E edges, S stations, V samples inside edges.

    `check_network` states and checks what every network guarantees.

    Parameters
    ----------
    stations : Stations
        Positions of the nodes and of the samples.
    graph : Graph
        Which nodes the edges join.
    edges : Edges
        Length, course, depth, factors, fixed time and fee of every edge.
    samples : Samples
        Where the sea is sampled inside the edges.
    can_wait : bool ndarray (N,)
        Nodes where a ship may wait.
    meta : NetworkMeta
        What the network is and how it was made.
    """

    stations: Stations
    graph: Graph
    edges: Edges
    samples: Samples
    can_wait: BoolArray
    meta: NetworkMeta

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(
            course="edges.course",
            depth="edges.depth",
            fee="edges.fee",
            fixed_time="edges.fixed_time",
            length="edges.length",
            factor="edges.penalty_factor",
            price="edges.price_factor",
            indptr="graph.indptr",
            target="graph.target",
            station_lat="stations.lat",
            station_lon="stations.lon",
            via_a="samples.station_a",
            via_b="samples.station_b",
            via_ptr="samples.ptr",
            via_s="samples.fraction",
            via_w="samples.weight",
        )

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return self.stations.n_nodes

    @property
    def n_edges(self) -> int:
        """Number of directed edges."""
        return len(self.graph.target)

    @property
    def n_stations(self) -> int:
        """Number of positions where fields are sampled."""
        return len(self.stations.lat)

    @property
    def lat(self) -> FloatArray:
        """Latitudes of the nodes [deg]."""
        return self.stations.lat[: self.n_nodes]

    @property
    def lon(self) -> FloatArray:
        """Longitudes of the nodes [deg]."""
        return self.stations.lon[: self.n_nodes]

    def tails(self) -> Int32Array:
        """Return the node that every edge leaves.

        Returns
        -------
        int32 array (E,)
            Nodes.
        """
        return self.graph.tails()

    def times(self, speed: float) -> FloatArray:
        """Return the time that every edge takes at one speed; canals have their own time.

        Parameters
        ----------
        speed : float
            Speed over ground [m/s], above 0.

        Returns
        -------
        float64 array (E,)
            Time [s].
        """
        fixed = self.edges.fixed_time
        return np.where(np.isnan(fixed), self.edges.length / speed, fixed)

    def with_some_edges(self, keep: NDArray[np.bool_]) -> Network:
        """Return this network with some of its edges; nodes and stations are unchanged.

        Parameters
        ----------
        keep : bool array (E,)
            Which edges remain.

        Returns
        -------
        Network
            With their samples.
        """
        leaving = np.bincount(self.tails()[keep], minlength=self.n_nodes)
        indptr = cumulative_sums(leaving)
        count = np.diff(self.samples.ptr)
        inside = np.repeat(keep, count)
        ptr = cumulative_sums(count[keep])
        old = self.samples
        samples = Samples(
            ptr,
            old.station_a[inside],
            old.station_b[inside],
            old.weight[inside],
            old.fraction[inside],
        )
        graph = Graph(indptr, self.graph.target[keep])
        return replace(self, graph=graph, edges=self.edges.take(keep), samples=samples)

    def with_edges(self, **columns: NDArray[Any]) -> Network:
        """Return this network with some columns of `Edges` replaced.

        Parameters
        ----------
        **columns : array (E,)
            By the names of `Edges`, such as ``fee``.

        Returns
        -------
        Network
            Otherwise unchanged.
        """
        return replace(self, edges=replace(self.edges, **columns))
