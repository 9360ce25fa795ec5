"""Layered networks whose nodes are closer near the coast: two rhombi of nodes in one network."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.geodesy import Position
from thalweg.core.types import IntArray
from thalweg.network.layered.layered_draft import LayeredDraft, layered_draft
from thalweg.network.layered.section_shape import SectionShape

if TYPE_CHECKING:
    from thalweg.chart import Chart


def refined_near_coast(
    chart: Chart, places: Sequence[Position], shapes: Sequence[SectionShape], near: float
) -> LayeredDraft:
    """Return the nodes and segments of a layered network with closer nodes near land.

    The network with twice as many layers, and half the distance between the nodes of a layer,
    holds all nodes of the given one. Of its other nodes, and of its segments, those near land are
    added to the given network.

    Parameters
    ----------
    places : Start, waypoints and goal [deg].
    shapes : Of every section, far from land.
    near : Distance from land up to which nodes are closer [m].
    """
    finer = [s.finer(2) for s in shapes]
    coarse, fine = _draft(places, shapes), _draft(places, finer)
    in_fine = _numbers_in_finer(shapes, finer)
    shore = np.asarray(chart.coastline.shore_distance(fine.lat, fine.lon, cap=1.01 * near))
    close = shore <= near
    exists = close.copy()
    exists[in_fine] = True
    added = exists[fine.first] & exists[fine.second] & (close[fine.first] | close[fine.second])
    first = np.concatenate([in_fine[coarse.first], fine.first[added]])
    second = np.concatenate([in_fine[coarse.second], fine.second[added]])
    number = np.cumsum(exists, dtype=np.int32) - np.int32(1)
    order = np.lexsort((second, first))  # a network has its segments by first node
    return LayeredDraft(
        tuple(finer), fine.lat[exists], fine.lon[exists], fine.section[exists], fine.layer[exists],
        number[first[order]], number[second[order]],
    )  # fmt: skip


def _draft(places: Sequence[Position], shapes: Sequence[SectionShape]) -> LayeredDraft:
    return layered_draft(
        places,
        layers=[s.layers for s in shapes],
        fan=[s.fan for s in shapes],
        offset=[s.offset for s in shapes],
    )


def _numbers_in_finer(shapes: Sequence[SectionShape], finer: Sequence[SectionShape]) -> IntArray:
    """Return the number of every node in the network with twice as many layers and nodes."""
    found = [np.zeros(1, np.int64)]
    begin = 0  # number of the first node of the section in the finer network
    for shape, fine in zip(shapes, finer):
        starts = np.cumsum([0, *fine.nodes_in_layers])
        for k, size in enumerate(shape.nodes_in_layers[1:], start=1):
            middle = (fine.nodes_in_layers[2 * k] - 1) // 2
            across = 2 * np.arange(size) - (size - 1)
            found.append(begin + starts[2 * k] + middle + across)
        begin += fine.n_nodes - 1
    return np.concatenate(found)
