"""Networks one behind the other as one network: passages by way of given places, and canals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, IntArray
from thalweg.network.network import Network, NetworkMeta

_PER_EDGE = ("length", "course", "depth", "factor", "price", "fixed_time", "fee")


@dataclass(frozen=True)
class CanalLink:
    """What leads from the goal of one network to the start of the next: a canal.

    Attributes
    ----------
    length : float
        [m].
    transit_time : float
        Time from one end to the other, whatever the ship [s].
    fee : float
        [USD].
    """

    length: float
    transit_time: float
    fee: float


def concatenate_networks(networks: Sequence[Network], links: Sequence[CanalLink | None]) -> Network:
    """Put networks one behind the other.

    Parameters
    ----------
    networks : sequence of Network
        Each with its start and goal.
    links : sequence of Link or None, one fewer
        What leads from each network to the next; None where the goal of the one is the start of
        the other.

    Returns
    -------
    Network
        From the start of the first to the goal of the last.

    Raises
    ------
    InputError
        If the numbers do not fit, or a network lacks its start or goal.
    """
    if not networks or len(links) != len(networks) - 1:
        raise InputError(
            f"{len(networks)} networks with {len(links)} links between them cannot be joined.",
            "There is one link fewer than networks.",
            "Give them so.",
        )
    if any(min(network.meta.start, network.meta.goal) < 0 for network in networks):
        raise InputError("A network to be joined lacks its start or goal.", "", "Attach them.")
    if len(networks) == 1:
        return networks[0]
    node_of, kept = _numbering(networks, links)
    return _assembled(networks, links, node_of, kept)


def _numbering(
    networks: Sequence[Network], links: Sequence[CanalLink | None]
) -> tuple[list[IntArray], list[BoolArray]]:
    """Return the new number of every node, and which nodes are not one met before."""
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
    nodes = sum(int(keep.sum()) for keep in kept)
    station_of, beyond = [], nodes
    for network, new in zip(networks, node_of):
        extra = network.n_stations - network.n_nodes
        station_of.append(np.concatenate([new, beyond + np.arange(extra)]))
        beyond += extra
    tails = [new[network.tails()] for network, new in zip(networks, node_of)]
    heads = [new[network.target] for network, new in zip(networks, node_of)]
    columns = {
        name: [np.asarray(getattr(network, name)) for network in networks] for name in _PER_EDGE
    }
    counts = [np.diff(network.via_ptr) for network in networks]
    for number, link in enumerate(links):
        if link is None:
            continue
        a = node_of[number][networks[number].meta.goal]
        b = node_of[number + 1][networks[number + 1].meta.start]
        tails.append(np.array([a]))
        heads.append(np.array([b]))
        counts.append(np.zeros(1, np.int64))
        for name, value in _canal_columns(link).items():
            columns[name].append(np.array([value]))
    tail, count = np.concatenate(tails), np.concatenate(counts)
    order = np.argsort(tail, kind="stable")
    first = np.concatenate([[0], np.cumsum(count)])
    via_ptr = np.concatenate([[0], np.cumsum(count[order])]).astype(np.int64)
    via = np.repeat(first[order] - via_ptr[:-1], count[order]) + np.arange(via_ptr[-1])
    sides = [
        np.concatenate([new[getattr(n, side)] for n, new in zip(networks, station_of)])[via]
        for side in ("via_a", "via_b")
    ]
    return replace(
        networks[0],
        station_lat=_stations([n.station_lat for n in networks], kept),
        station_lon=_stations([n.station_lon for n in networks], kept),
        n_nodes=nodes,
        indptr=np.searchsorted(tail[order], np.arange(nodes + 1)).astype(np.int64),
        target=np.concatenate(heads)[order].astype(np.int32),
        via_ptr=via_ptr,
        via_a=sides[0].astype(np.int32),
        via_b=sides[1].astype(np.int32),
        via_w=np.concatenate([n.via_w for n in networks])[via],
        via_s=np.concatenate([n.via_s for n in networks])[via],
        can_wait=np.concatenate([n.can_wait[keep] for n, keep in zip(networks, kept)]),
        meta=_meta(networks, node_of),
        **{
            name: np.concatenate(parts)[order].astype(parts[0].dtype)
            for name, parts in columns.items()
        },
    )


def _canal_columns(link: CanalLink) -> dict[str, float]:
    """Return the columns of a canal's edge."""
    return {
        "length": link.length,
        "course": 0.0,
        "depth": np.inf,
        "factor": 1.0,
        "price": 1.0,
        "fixed_time": link.transit_time,
        "fee": link.fee,
    }


def _stations(columns: list[np.ndarray], kept: list[BoolArray]) -> np.ndarray:
    """Return positions, those of all nodes first."""
    nodes = [column[: len(keep)][keep] for column, keep in zip(columns, kept)]
    return np.concatenate([*nodes, *(column[len(keep) :] for column, keep in zip(columns, kept))])


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
