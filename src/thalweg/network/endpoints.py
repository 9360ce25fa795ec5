"""Start, goal and via points as nodes at their exact positions, linked to nearby nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoPathError
from thalweg.core.geodesy import MEAN_RADIUS, Position
from thalweg.core.types import FloatArray, Int32Array
from thalweg.kernels.network import graph_building
from thalweg.network.assembly import (
    Pairs,
    RejectionCounts,
    add_counts,
    allowed_legs,
    assemble,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.conformal_projection import (
    angle_to_point,
    conformal_unit_vectors,
)
from thalweg.network.network import Edges, Graph, Network, Samples, Stations

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal

LINK_REACH = 2.6  #: end points are linked to nodes within this many spacings
_SHORTEST_LINK = 1.0  # links shorter than this are left out [m]
_NEAREST_LINKS = 24  # always linked, beside the nearest node in every sector and ring
_SECTORS = 96
_SAMPLES_TO_NEAREST_NODE = (
    3  # the distance to this nearest node, over this many pieces, is how close links are sampled
)
_MAX_LINKS = 400


def check_endpoints(chart: Chart, start: Position, goal: Position) -> tuple[Position, Position]:
    """Return start and goal after checks: valid, different, on navigable water.

    Parameters
    ----------
    chart : Tests that both positions are on navigable water.
    start, goal : (lat, lon)
        Positions [deg].

    Returns
    -------
    start, goal : Positions [deg] with longitudes in -180 to 180.

    Raises
    ------
    InputError : Otherwise.
    """
    start = geodesy.check_position(*start, what="start")
    goal = geodesy.check_position(*goal, what="goal")
    if float(geodesy.distance(*start, *goal)) < _SHORTEST_LINK:
        raise InputError(
            f"Start and goal are the same place, {geodesy.format_position(*start)}.",
            "A voyage is at least a metre long.",
            "Give two different positions.",
            value=(start, goal),
        )
    for what, place in (("start", start), ("goal", goal)):
        check_at_sea(chart, place, what)
    return start, goal


def check_at_sea(chart: Chart, place: Position, what: str) -> None:
    """Raise `InputError` unless a position is on navigable water."""
    if not bool(np.all(chart.is_navigable(np.array([place[0]]), np.array([place[1]])))):
        raise InputError(
            f"The {what} {geodesy.format_position(*place)} is not on navigable water.",
            "It is on land, in a no-go zone or outside the chart.",
            "Move it to open water, or let the plan move it to the nearest navigable water.",
            field=what,
            value=place,
        )


def links_to_nodes(
    chart: Chart, lat: FloatArray, lon: FloatArray, point: int, *, n_nodes: int, reach: float
) -> tuple[Pairs, RejectionCounts]:
    """Return allowed links from one position to the nodes within reach.

    Parameters
    ----------
    chart : Tests every link exactly.
    lat, lon : Positions [deg]; the nodes are the first ``n_nodes``.
    point : Index of the position to link.
    n_nodes : Number of nodes that may be linked.
    reach : Largest length [m]; doubled up to four times until a link is allowed.

    Returns
    -------
    pairs : From the position to nodes: the nearest ones, and the nearest in every sector and ring.
    rejected : Counts of refused links by reason.
    """
    vectors = conformal_unit_vectors(lat[:n_nodes], lon[:n_nodes])
    separation = (
        angle_to_point(vectors, conformal_unit_vectors(lat[point], lon[point])) * MEAN_RADIUS
    )
    rejected: RejectionCounts = {}
    pairs = _pairs(lat, lon, point, np.empty(0, np.int32))
    for _ in range(5):
        near = np.flatnonzero((separation <= reach) & (separation > _SHORTEST_LINK)).astype(
            np.int32
        )
        pairs = _pairs(lat, lon, point, near)
        free, rejected = allowed_legs(chart, lat, lon, pairs.first, pairs.second)
        pairs = _nearest_pairs_by_sector(pairs.where(free))
        if len(pairs.first):
            break
        reach *= 2.0
    return pairs, rejected


def _pairs(lat: FloatArray, lon: FloatArray, point: int, nodes: Int32Array) -> Pairs:
    return measured_pairs(lat, lon, np.full(len(nodes), point, np.int32), nodes)


def _nearest_pairs_by_sector(pairs: Pairs) -> Pairs:
    """Return the nearest links, and the nearest in every sector and ring."""
    if len(pairs.first) <= _MAX_LINKS:
        return pairs
    order = np.argsort(pairs.length, kind="stable")
    sector = np.floor(pairs.course[order] * (_SECTORS / (2 * np.pi))).astype(np.int64)
    ring = np.floor(2.0 * np.log2(pairs.length[order])).astype(np.int64)
    _, first = np.unique(sector * 1000 + ring, return_index=True)
    keep = np.zeros(len(order), bool)
    keep[order[first]] = True
    keep[order[:_NEAREST_LINKS]] = True
    return pairs.where(keep)


def with_endpoints(
    network: Network, chart: Chart, start: Position, goal: Position, *, via: Sequence[Position] = ()
) -> Network:
    """Return the network with start, goal and via points as nodes at their exact positions.

    Parameters
    ----------
    network : Network
        Any network.
    chart : Chart
        Tests the links.
    start, goal : (lat, lon)
        Positions [deg]. They become nodes N and N + 1 (N nodes before), as ``meta`` states.
    via : sequence of (lat, lon), optional
        Via points; they become nodes N + 2, N + 3, ...

    Returns
    -------
    Network
        With the new nodes linked in both directions to the nodes around them, by tested legs.

    Raises
    ------
    InputError
        If a position is not on navigable water, or start and goal are the same.
    NoPathError
        If a position cannot be linked to any node.
    """
    start, goal = check_endpoints(chart, start, goal)
    places = [start, goal]
    for number, place in enumerate(via, 1):
        places.append(geodesy.check_position(*place, what=f"via point {number}"))
        check_at_sea(chart, places[-1], f"via point {number}")
    old = _insert_nodes(network, places)
    stations = old.stations
    pairs, rejected = _link_all(chart, stations, len(places), network.meta.spacing_m)
    counts = dict(network.meta.rejected)
    add_counts(counts, rejected)
    meta = replace(network.meta, start=network.n_nodes, goal=network.n_nodes + 1, rejected=counts)
    apart = np.minimum(network.meta.spacing_m, _sample_spacing(stations, len(places)))
    stations, samples = evenly_spaced_samples(stations, pairs, apart[pairs.first - network.n_nodes])
    return _merge_networks(old, assemble(chart, stations, pairs, samples, meta=meta))


def _link_all(
    chart: Chart, stations: Stations, count: int, spacing: float
) -> tuple[Pairs, RejectionCounts]:
    """Return the links of the last ``count`` nodes to the others, and between close ones."""
    first = stations.n_nodes - count
    parts, rejected = [], RejectionCounts()
    for point in range(first, stations.n_nodes):
        pairs, refused = links_to_nodes(
            chart, stations.lat, stations.lon, point, n_nodes=first, reach=LINK_REACH * spacing
        )
        add_counts(rejected, refused)
        if len(pairs.first) == 0:
            place = (float(stations.lat[point]), float(stations.lon[point]))
            raise NoPathError(
                f"{geodesy.format_position(*place)} cannot be linked to the network.",
                f"Its nodes are about {spacing:.0f} m apart.",
                "Give a finer network or another position.",
                reasons=refused,
                nearest=place,
            )
        parts.append(pairs)
    parts.append(direct_pairs(chart, stations, first, reach=LINK_REACH * spacing))
    return concatenate_pairs(parts), rejected


def _sample_spacing(stations: Stations, count: int) -> FloatArray:
    """Return how far apart [m] links of each of the last ``count`` nodes are sampled.

    The nodes of a mesh lie close where the water is uneven; links are sampled as closely there.
    """
    first = stations.n_nodes - count
    vectors = conformal_unit_vectors(stations.lat[:first], stations.lon[:first])
    nth = min(_SAMPLES_TO_NEAREST_NODE, first) - 1
    near = [
        np.partition(
            angle_to_point(vectors, conformal_unit_vectors(stations.lat[p], stations.lon[p])), nth
        )[nth]
        for p in range(first, stations.n_nodes)
    ]
    return np.maximum(np.array(near) * (MEAN_RADIUS / _SAMPLES_TO_NEAREST_NODE), _SHORTEST_LINK)


def direct_pairs(chart: Chart, stations: Stations, first: int, *, reach: float) -> Pairs:
    """Return allowed links within reach [m] between the nodes from ``first`` on."""
    a, b = np.triu_indices(stations.n_nodes - first, 1)
    pairs = measured_pairs(
        stations.lat, stations.lon, (a + first).astype(np.int32), (b + first).astype(np.int32)
    )
    pairs = pairs.where((pairs.length <= reach) & (pairs.length > _SHORTEST_LINK))
    lat, lon = stations.lat, stations.lon
    ends = lat[pairs.first], lon[pairs.first], lat[pairs.second], lon[pairs.second]
    pairs = pairs.where(np.asarray(chart.canal_of_legs(*ends)) < 0)
    return pairs.where(
        allowed_legs(chart, stations.lat, stations.lon, pairs.first, pairs.second)[0]
    )


def canal_pairs(canals: Sequence[Canal], first: int) -> Pairs:
    """Return the pairs of canals whose ends are nodes ``first``, ``first + 1`` and so on.

    Their course is NaN, which marks canals until the network is assembled.
    """
    nodes = (first + 2 * np.arange(len(canals))).astype(np.int32)
    length = np.array([canal.length for canal in canals], float)
    return Pairs(nodes, nodes + np.int32(1), length, np.full(len(canals), np.nan, np.float32))


def concatenate_pairs(parts: Sequence[Pairs]) -> Pairs:
    """Return several lots of pairs as one."""
    return Pairs(
        np.concatenate([p.first for p in parts]),
        np.concatenate([p.second for p in parts]),
        np.concatenate([p.length for p in parts]),
        np.concatenate([p.course for p in parts]),
    )


def _insert_nodes(network: Network, places: Sequence[Position]) -> Network:
    """Return the network with unlinked nodes put between its nodes and its other stations."""
    n, count = network.n_nodes, len(places)
    lat, lon = np.array(places, float).T
    old, graph, samples = network.stations, network.graph, network.samples

    def renumbered(station: Int32Array) -> Int32Array:
        return np.where(station >= n, station + count, station).astype(np.int32)

    return replace(
        network,
        stations=Stations(
            np.concatenate([network.lat, lat, old.lat[n:]]),
            np.concatenate([network.lon, lon, old.lon[n:]]),
            n + count,
        ),
        graph=Graph(np.append(graph.indptr, np.full(count, graph.indptr[-1])), graph.target),
        samples=replace(
            samples,
            station_a=renumbered(samples.station_a),
            station_b=renumbered(samples.station_b),
        ),
        can_wait=np.append(network.can_wait, np.ones(count, bool)),
    )


def _merge_networks(old: Network, new: Network) -> Network:
    """Return the edges of both networks, on the nodes and stations of the second."""
    tails = np.concatenate([old.tails(), new.tails()])
    order = np.argsort(tails, kind="stable").astype(np.int32)
    target = np.concatenate([old.graph.target, new.graph.target])[order]
    samples = Samples.concatenate([old.samples, new.samples])
    forward = np.zeros(len(order), bool)
    return replace(
        new,
        graph=Graph(old.graph.indptr + new.graph.indptr, target),
        edges=Edges.concatenate([old.edges, new.edges]).take(order),
        samples=Samples(*graph_building.mirror_samples(order, forward, *samples.arrays())),
        can_wait=old.can_wait,
    )
