"""Arcs that connect a history network where tracks do not: reversed arcs, and ways by sea."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.geodesy import Position, line_length
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.arc_lines import ArcLines, GlobeWays
from thalweg.network.history.arc_statistics import ArcEvidence
from thalweg.network.history.history_arcs import (
    GLOBE,
    REVERSED,
    SAILED,
    HistoryArcs,
)
from thalweg.network.history.season_masks import LEAST_SAMPLES
from thalweg.network.history.stretch_ends import ends_at_nodes
from thalweg.network.history.voyage_tracks import sphere_vectors

if TYPE_CHECKING:
    from thalweg.chart import Chart

_FAR_ROUND: Final = 1.5  # times an arc: a way back that is longer is no usual one
_AT_ONCE: Final = 500  # arcs whose way back is searched at the same time
_TRIED: Final = 4  # nearest nodes of other parts to which a way is searched


def connected_arcs(
    chart: Chart,
    arcs: HistoryArcs,
    places: tuple[FloatArray, FloatArray],
    used: Sequence[int],
    ways: GlobeWays,
    *,
    node_approach: FloatArray,
    radius: float,
) -> tuple[HistoryArcs, list[int]]:
    """Return arcs over which every node in use reaches every other.

    First arcs that join parts in one direction only are added in the other direction, and those
    of ten voyages or more from whose end the way back is more than 1.5 times as long, and longer
    by more than twice the radius, and those between two ports of which no arc leads back; their
    evidence is that of the arc, their kind "reversed". Then
    parts that no track joins are joined to
    the nearest other part by the shortest way by sea, both ways, of the kind "globe".

    Parameters
    ----------
    chart : Gives the emission control areas.
    places : Positions of the nodes [deg], (lat, lon).
    used : Nodes that must be connected, such as ports, beside those of the arcs.
    node_approach : Length of the approach of every node [m]; 0 at junctions.
    radius : Radius of a junction [m]: nearer than twice this places are not distinguished.

    Returns
    -------
    arcs : The given arcs and those that were missing.
    alone : Nodes in use that no way by sea joins to the others.
    """
    count = len(places[0])
    part = strongly_connected_parts(count, arcs.tail, arcs.head)
    far_round = (arcs.evidence.count >= LEAST_SAMPLES) & _returns_far_round(
        count, arcs, 2.0 * radius
    )
    lacking = (part[arcs.tail] != part[arcs.head]) | far_round
    lacking |= _without_way_back(count, arcs) & np.isin(
        [arcs.tail, arcs.head], np.asarray(used)
    ).all(axis=0)
    one_way = np.flatnonzero(lacking)
    arcs = joined_arcs([arcs, _reversed(arcs, one_way)])
    nodes = np.union1d(np.union1d(arcs.tail, arcs.head), np.asarray(used, np.int64))
    part = strongly_connected_parts(count, arcs.tail, arcs.head, both_ways=True)
    found, alone = _ways_between_parts(places, nodes.astype(np.int64), part, ways)
    both = [*found, *((b, a, line[::-1]) for a, b, line in found)]
    return joined_arcs([arcs, globe_arcs(chart, both, node_approach)]), alone


def _returns_far_round(count: int, arcs: HistoryArcs, least: float) -> BoolArray:
    """Return whether the way back along the arcs is much longer than the arc, (A,).

    That is more than `_FAR_ROUND` times, and by more than a length [m].
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    length, order = arcs.length, np.lexsort((arcs.length, arcs.head, arcs.tail))
    _, first = np.unique(arcs.tail[order] * count + arcs.head[order], return_index=True)
    shortest = order[first]  # of several arcs between two nodes
    graph = csr_array(
        (length[shortest], (arcs.tail[shortest], arcs.head[shortest])), shape=(count, count)
    )
    far = np.ones(len(length), bool)
    for heads in np.array_split(np.unique(arcs.head), max(1, len(length) // _AT_ONCE)):
        if not len(heads):
            continue
        own = np.isin(arcs.head, heads)
        most = np.maximum(_FAR_ROUND * length[own], length[own] + least)
        back = dijkstra(graph, indices=heads, limit=float(most.max()))
        far[own] = back[np.searchsorted(heads, arcs.head[own]), arcs.tail[own]] > most
    return far


def _without_way_back(count: int, arcs: HistoryArcs) -> BoolArray:
    """Return which arcs have no arc from their head to their tail, (A,)."""
    return ~np.isin(arcs.tail * count + arcs.head, arcs.head * count + arcs.tail)


def globe_arcs(
    chart: Chart, ways: Sequence[tuple[int, int, list[Position]]], node_approach: FloatArray
) -> HistoryArcs:
    """Return arcs of ways by sea (tail, head, waypoints) on which nothing was seen."""
    lines = ArcLines.of_lists([line for _, _, line in ways])
    tail, head = (np.array([way[k] for way in ways], np.int64) for k in (0, 1))
    return HistoryArcs(
        tail,
        head,
        np.full(len(ways), GLOBE, np.int64),
        lines,
        unknown_evidence(len(ways)),
        np.zeros((len(ways), 9, 2)),
        lines.control_area_shares(chart),
        np.zeros(len(ways)),
        ends_at_nodes(tail, head, node_approach),
    )


def joined_arcs(parts: Sequence[HistoryArcs]) -> HistoryArcs:
    """Return the arcs of several parts as one."""
    lines = [part.lines for part in parts]
    shifts = np.cumsum([0, *(len(line.lat) for line in lines)])
    ptr = np.concatenate([[0], *(line.ptr[1:] + shift for line, shift in zip(lines, shifts))])
    whole = ArcLines(
        ptr.astype(np.int64),
        np.concatenate([line.lat for line in lines]),
        np.concatenate([line.lon for line in lines]),
    )
    evidence = ArcEvidence(
        *(
            np.concatenate([getattr(part.evidence, column.name) for part in parts])
            for column in fields(ArcEvidence)
        )
    )
    columns = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("tail", "head", "kind", "tube", "eca_share", "repaired", "approach")
    }
    return HistoryArcs(lines=whole, evidence=evidence, **columns)


def _reversed(arcs: HistoryArcs, index: IntArray) -> HistoryArcs:
    """Return arcs in the other direction."""
    lines = []
    for arc in index.tolist():
        lat, lon = arcs.lines.of(arc)
        lines.append(list(zip(lat[::-1].tolist(), lon[::-1].tolist())))
    evidence = ArcEvidence(
        *(getattr(arcs.evidence, column.name)[index] for column in fields(ArcEvidence))
    )
    tube = -arcs.tube[index][:, ::-1, ::-1]
    kind = np.where(arcs.kind[index] == SAILED, REVERSED, arcs.kind[index])
    return replace(
        arcs, tail=arcs.head[index], head=arcs.tail[index], kind=kind,
        lines=ArcLines.of_lists(lines), evidence=evidence, tube=tube,
        eca_share=arcs.eca_share[index], repaired=arcs.repaired[index],
        approach=arcs.approach[index][:, ::-1],
    )  # fmt: skip


def _ways_between_parts(
    places: tuple[FloatArray, FloatArray], nodes: IntArray, part: IntArray, ways: GlobeWays
) -> tuple[list[tuple[int, int, list[Position]]], list[int]]:
    """Return ways that join all parts to the largest, and nodes of parts without a way."""
    from scipy.spatial import cKDTree

    vectors = sphere_vectors(*places)
    label = part.copy()
    ways_found: list[tuple[int, int, list[Position]]] = []
    alone: list[int] = []
    numbers, counts = np.unique(label[nodes], return_counts=True)
    main = numbers[np.argmax(counts)] if len(numbers) else 0
    inside = nodes[label[nodes] == main]
    for number in numbers[np.argsort(-counts, kind="stable")].tolist():
        if number == main:
            continue
        own = nodes[part[nodes] == number]
        tree = cKDTree(vectors[inside])
        near, other = tree.query(vectors[own], k=min(_TRIED, len(inside)))
        near, other = near.reshape(len(own), -1), other.reshape(len(own), -1)
        tried = np.argsort(near, axis=None, kind="stable")[:_TRIED]
        best: tuple[float, int, int, list[Position]] | None = None
        for flat in tried.tolist():
            row, column = np.unravel_index(flat, near.shape)
            a, b = int(own[row]), int(inside[other[row, column]])
            way = ways.between(_place(places, a), _place(places, b))
            if way is not None and (best is None or line_length(way) < best[0]):
                best = line_length(way), a, b, way
        if best is None:
            alone += own.tolist()
            continue
        ways_found.append(best[1:])
        inside = np.concatenate([inside, own])
    return ways_found, alone


def _place(places: tuple[FloatArray, FloatArray], node: int) -> Position:
    return float(places[0][node]), float(places[1][node])


def strongly_connected_parts(
    count: int, tail: IntArray, head: IntArray, *, both_ways: bool = False
) -> IntArray:
    """Return the part of the network that every node belongs to.

    Parameters
    ----------
    count : Number of nodes.
    tail, head : Arcs, (A,).
    both_ways : Whether arcs count in both directions.

    Returns
    -------
    int64 ndarray (N,) : Numbers of parts in which every node reaches every other.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(tail), np.int8), (tail, head)), shape=(count, count))
    kind = "weak" if both_ways else "strong"
    return connected_components(graph, directed=True, connection=kind)[1].astype(np.int64)


def unknown_evidence(count: int) -> ArcEvidence:
    """Return the evidence of arcs on which nothing was seen.

    Parameters
    ----------
    count : Number of arcs.

    Returns
    -------
    ArcEvidence : No voyages, unknown values NaN, open all year.
    """
    none, months = np.zeros(count, np.int64), np.zeros((count, 12), np.int64)
    lengths, times, draughts, sizes = (np.full((count, 3), np.nan) for _ in range(4))
    open_in: BoolArray = np.ones((count, 12), bool)
    return ArcEvidence(none, lengths, times, months, open_in, draughts, sizes, none.copy())
