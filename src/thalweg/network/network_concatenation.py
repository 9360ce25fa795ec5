"""Concatenation of networks at via points and canals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, IntArray
from thalweg.kernels.network import graph_building
from thalweg.network.network import Edges, Graph, Network, NetworkMeta, Samples, Stations


@dataclass(frozen=True)
class CanalLink:
    """A canal from the goal of one network to the start of the next.

    Attributes
    ----------
    length : [m].
    transit_time : Time from one end to the other, the same for all ships [s].
    fee : [USD].
    """

    length: float
    transit_time: float
    fee: float


def concatenate_networks(networks: Sequence[Network], links: Sequence[CanalLink | None]) -> Network:
    """Concatenate networks in their order.

    Parameters
    ----------
    networks : Each with its start and goal.
    links : Canal from each network to the next; None where the goal of the one is the start of the
        other.

    Returns
    -------
    Network : From the start of the first to the goal of the last.

    Raises
    ------
    InputError : If the numbers do not fit, or a network lacks its start or goal.
    """
    if not networks or len(links) != len(networks) - 1:
        raise InputError(
            f"{len(networks)} networks with {len(links)} links between them cannot be joined.",
            "The number of links is one less than that of networks.",
            "Give one link between every two networks.",
        )
    if any(min(network.meta.start, network.meta.goal) < 0 for network in networks):
        raise InputError(
            "A network to be joined has no start or no goal.",
            "All networks need both.",
            "Add them with thalweg.network.with_endpoints.",
        )
    if len(networks) == 1:
        return networks[0]
    node_of, kept = _numbering(networks, links)
    return _assembled(networks, links, node_of, kept)


def _numbering(
    networks: Sequence[Network], links: Sequence[CanalLink | None]
) -> tuple[list[IntArray], list[BoolArray]]:
    """Return the new number of every node, and which nodes are not merged into earlier ones."""
    node_of: list[IntArray] = []
    kept: list[BoolArray] = []
    count = 0
    for number, network in enumerate(networks):
        keep = np.ones(network.n_nodes, bool)
        merged = number > 0 and links[number - 1] is None
        if merged:
            keep[network.meta.start] = False
        new = count - 1 + np.cumsum(keep)
        if merged:
            new[network.meta.start] = node_of[-1][networks[number - 1].meta.goal]
        node_of.append(new.astype(np.int64))
        kept.append(keep)
        count += int(keep.sum())
    return node_of, kept


def _assembled(
    networks: Sequence[Network],
    links: Sequence[CanalLink | None],
    node_of: list[IntArray],
    kept: list[BoolArray],
) -> Network:
    tails = [new[network.tails()] for network, new in zip(networks, node_of)]
    heads = [new[network.graph.target] for network, new in zip(networks, node_of)]
    edges = [network.edges for network in networks]
    samples = _renumbered_samples(networks, node_of, sum(int(keep.sum()) for keep in kept))
    for number, link in enumerate(links):
        if link is not None:
            tails.append(node_of[number][[networks[number].meta.goal]])
            heads.append(node_of[number + 1][[networks[number + 1].meta.start]])
            edges.append(_canal_edge(link))
            samples.append(Samples.none(1))
    stations = _concatenate_stations(networks, kept)
    tail, forward = np.concatenate(tails), np.zeros(sum(map(len, tails)), bool)
    order = np.argsort(tail, kind="stable").astype(np.int32)
    indptr = np.searchsorted(tail[order], np.arange(stations.n_nodes + 1)).astype(np.int64)
    every = Samples.concatenate(samples).arrays()
    return Network(
        stations,
        Graph(indptr, np.concatenate(heads)[order].astype(np.int32)),
        Edges.concatenate(edges).take(order),
        Samples(*graph_building.mirror_samples(order, forward, *every)),
        np.concatenate([n.can_wait[keep] for n, keep in zip(networks, kept)]),
        _meta(networks, node_of),
    )


def _renumbered_samples(
    networks: Sequence[Network], node_of: list[IntArray], n_nodes: int
) -> list[Samples]:
    """Return the samples of every network with the new numbers of their stations."""
    samples, next_station = [], n_nodes
    for network, nodes in zip(networks, node_of):
        extra = network.n_stations - network.n_nodes
        station = np.concatenate([nodes, next_station + np.arange(extra)]).astype(np.int32)
        next_station += extra
        own = network.samples
        samples.append(
            replace(own, station_a=station[own.station_a], station_b=station[own.station_b])
        )
    return samples


def _canal_edge(link: CanalLink) -> Edges:
    """Return the properties of the edge through a canal."""
    one = np.ones(1, np.float32)
    return Edges(
        np.array([link.length]),
        course=np.zeros(1, np.float32),
        depth=np.full(1, np.inf, np.float32),
        penalty_factor=one,
        price_factor=one,
        fixed_time=np.array([link.transit_time]),
        fee=np.array([link.fee]),
    )


def _concatenate_stations(networks: Sequence[Network], kept: list[BoolArray]) -> Stations:
    """Return the positions of all networks, those of all nodes first."""
    columns = []
    for name in ("lat", "lon"):
        parts = [(getattr(n.stations, name), keep) for n, keep in zip(networks, kept)]
        nodes = [values[: len(keep)][keep] for values, keep in parts]
        columns.append(np.concatenate([*nodes, *(values[len(keep) :] for values, keep in parts)]))
    return Stations(columns[0], columns[1], sum(int(keep.sum()) for keep in kept))


def _meta(networks: Sequence[Network], node_of: list[IntArray]) -> NetworkMeta:
    metas = [network.meta for network in networks]
    rejected: Counter[str] = Counter()
    for meta in metas:
        rejected.update(meta.rejected)
    return replace(
        metas[0],
        spacing_m=max(meta.spacing_m for meta in metas),
        directions=min(meta.directions for meta in metas),
        gap_rad=max(meta.gap_rad for meta in metas),
        rejected=dict(rejected),
        start=int(node_of[0][metas[0].start]),
        goal=int(node_of[-1][metas[-1].goal]),
        notes=tuple(note for meta in metas for note in meta.notes),
    )
