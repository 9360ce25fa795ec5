"""An alternative path between the ends of a network: its waypoints, length, cost and canals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray, IntArray
from thalweg.network.alternatives.leg_rules import LegCost, PassingSides, leg_lengths, total_cost
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.network import Network

if TYPE_CHECKING:
    from thalweg.chart import Chart


_LEAST_GAIN_OF_WAYPOINT = 1e-8  # share of the cost of a path that each waypoint must save
_BORDER_TOLERANCE = 25.0  # accuracy at which edges are split at borders of control areas [m]


@dataclass(frozen=True)
class EdgeWeights:
    """Weights of a static shortest-path search, without time or weather.

    These are not the objective of a voyage (`thalweg.core.objective.Objective`); `priced`
    approximates it by lengths, with factors for zones and emission control areas.

    Attributes
    ----------
    weight : float64[E], optional
        Weight of every edge; by default its length [m].
    leg_cost : callable, optional
        Cost of legs (lat1, lon1, lat2, lon2) [deg], used to pull paths straight; by default their
        length [m].
    """

    weight: FloatArray | None = None
    leg_cost: LegCost | None = None

    @classmethod
    def penalised(cls, network: Network, chart: Chart) -> EdgeWeights:
        """Return lengths times the factors of penalty zones, shoals and lanes.

        Parameters
        ----------
        network : Network
        chart : Chart
            With the zones.

        Returns
        -------
        EdgeWeights
            Lengths alone where the chart has nothing of the kind.
        """
        if not chart.zones.has_penalty:
            return cls(network.edges.length)

        def leg_cost(*ends: FloatArray) -> FloatArray:
            return np.asarray(leg_lengths(*ends) * chart.zones.factors(*ends)[0])

        return cls(network.edges.length * network.edges.penalty_factor, leg_cost)

    @classmethod
    def priced(cls, network: Network, chart: Chart, factor: float = 1.0) -> EdgeWeights:
        """Return lengths times the factors of zones, and another inside emission control areas.

        Parameters
        ----------
        network : Network
        chart : Chart
            With the zones.
        factor : float, optional
            Cost of a mile inside an emission control area over that of a mile outside [-].

        Returns
        -------
        EdgeWeights
            Of the edges of the network [m times a factor], and the same for any legs.

        Raises
        ------
        InputError
            If the factor is not above 0.
        """
        if not 0.0 < factor < np.inf:
            raise InputError(
                f"The factor of control areas is {factor!r}.",
                "It is above 0: cost of a mile inside over that of a mile outside.",
                "Give 1.5, for example.",
            )

        def leg_cost(*ends: FloatArray) -> FloatArray:
            penalty, price = chart.zones.factors(*ends)
            share = chart.zones.eca_fraction(*ends, finest=_BORDER_TOLERANCE)
            return np.asarray(leg_lengths(*ends) * penalty * price * (1.0 + (factor - 1.0) * share))

        weight = network.edges.length * network.edges.penalty_factor * network.edges.price_factor
        return cls(weight * (1.0 + (factor - 1.0) * eca_fractions(network, chart)), leg_cost)


@dataclass(frozen=True, eq=False)
class AlternativePath:
    """One of several paths between the ends of a network.

    Attributes
    ----------
    lat, lon : float64[P]
        Waypoints [deg], after string pulling over the chart.
    length : float
        Length [m]; a canal counts with its own.
    cost : float
        Cost by the edge weights that favour this path most: of the pulled path if they have a
        ``leg_cost`` (canals count with the weight of their edges), else of the network path.
    ratio : float
        Cost on the network over that of the best path by the same weights; 1 for the best.
    canals : tuple of str
        Names of its canals, in order.
    path : int64[K]
        Its nodes on the network.
    """

    lat: FloatArray
    lon: FloatArray
    length: float
    cost: float
    ratio: float
    canals: tuple[str, ...]
    path: IntArray

    @property
    def waypoints(self) -> list[tuple[float, float]]:
        """The waypoints as (lat, lon) [deg]."""
        return list(zip(self.lat.tolist(), self.lon.tolist()))


def eca_fractions(network: Network, chart: Chart) -> FloatArray:
    """Return the share (0 to 1) of every edge inside emission control areas; 0 of canals.

    Parameters
    ----------
    network : Network
        Its edges.
    chart : Chart
        With emission control areas.

    Returns
    -------
    ndarray (E,)
        Fraction of each edge [-].
    """
    share = np.zeros(network.n_edges)
    if not chart.zones.eca:
        return share
    sailed = np.flatnonzero(np.isnan(network.edges.fixed_time))
    a, b = network.tails()[sailed].astype(np.int64), network.graph.target[sailed].astype(np.int64)
    key = np.minimum(a, b) * network.n_nodes + np.maximum(a, b)  # each pair is tested once
    keys, back = np.unique(key, return_inverse=True)
    a, b = keys // network.n_nodes, keys % network.n_nodes
    lat, lon = network.lat, network.lon
    found = chart.zones.eca_fraction(lat[a], lon[a], lat[b], lon[b], finest=_BORDER_TOLERANCE)
    share[sailed] = np.asarray(found)[back]
    return share


def checked_edge_weights(network: Network, edge_weights: EdgeWeights) -> FloatArray:
    """Return the weight of every edge; `InputError` for a wrong shape or a negative weight."""
    if edge_weights.weight is None:
        return network.edges.length
    weight = np.ascontiguousarray(edge_weights.weight, float)
    if weight.shape != (network.n_edges,) or not np.all(weight >= 0.0):
        raise InputError(
            f"Weights of shape {weight.shape} do not fit {network.n_edges} edges or are negative.",
            "Each edge has one weight of 0 or more.",
            "Build them from network.edges.length.",
        )
    return weight


def shortened_path(
    network: Network, chart: Chart, path: IntArray, ratio: float, edge_weights: EdgeWeights,
    sides: PassingSides | None = None,
) -> AlternativePath:  # fmt: skip
    """Return a path of nodes after string pulling; ``ratio`` as in `AlternativePath`."""
    lat, lon = network.lat[path], network.lon[path]
    lat, lon = string_pull_path(
        chart,
        lat,
        lon,
        leg_cost=edge_weights.leg_cost,
        sides=sides,
        least_gain=_LEAST_GAIN_OF_WAYPOINT,
    )
    weight = checked_edge_weights(network, edge_weights)
    length, cost = total_cost((lat, lon)), total_cost((lat, lon), edge_weights.leg_cost)
    names: list[str] = []
    if chart.canals:
        through = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
        edges = {int(c): e for e, c in _canal_passages(network, chart, path)}
        for k in np.flatnonzero(through >= 0):
            canal, leg = chart.canals[through[k]], (lat[k : k + 2], lon[k : k + 2])
            names.append(canal.name)
            length += canal.length - total_cost(leg)
            cost += float(weight[edges[int(through[k])]]) - total_cost(leg, edge_weights.leg_cost)
    if edge_weights.weight is not None and edge_weights.leg_cost is None:
        cost = float(weight[path_edges(network, path)].sum())
    return AlternativePath(lat, lon, length, cost, ratio, tuple(names), path)


def canal_edges(network: Network, chart: Chart) -> IntArray:
    """Return the index in ``chart.canals`` of every edge of a network, -1 for those at sea."""
    answer = np.full(network.n_edges, -1, np.int64)
    edge = np.flatnonzero(~np.isnan(network.edges.fixed_time))
    tail, head = network.tails()[edge], network.graph.target[edge]
    lat, lon = network.lat, network.lon
    answer[edge] = chart.canal_of_legs(lat[tail], lon[tail], lat[head], lon[head])
    return answer


def _canal_passages(network: Network, chart: Chart, path: IntArray) -> list[tuple[int, int]]:
    canal = canal_edges(network, chart)
    return [(e, int(canal[e])) for e in path_edges(network, path) if canal[e] >= 0]


def path_edges(network: Network, path: Sequence[int] | IntArray) -> IntArray:
    """Return the edges along a path of nodes."""
    edges = []
    for a, b in pairwise(path):
        first, last = network.graph.indptr[a], network.graph.indptr[a + 1]
        edges.append(first + int(np.argmax(network.graph.target[first:last] == b)))
    return np.array(edges, np.int64)
