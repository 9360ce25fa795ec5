"""The builder of layered networks: a rhombus of nodes around the line between two waypoints."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core import geodesy
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import NoPathError
from thalweg.core.geodesy import Position
from thalweg.core.types import BoolArray, Int32Array
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.assembly import (
    DirectedEdges,
    Pairs,
    RejectionCounts,
    allowed_legs,
    assemble,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.endpoints import check_endpoints
from thalweg.network.layered.coastal_refinement import refined_near_coast
from thalweg.network.layered.layered_draft import LayeredDraft, layered_draft
from thalweg.network.layered.section_shape import PerSection, SectionShape
from thalweg.network.network import Graph, Network, NetworkMeta, Stations
from thalweg.network.short_legs import positions_on_short_legs

if TYPE_CHECKING:
    from thalweg.chart import Chart

_SAMPLE_SPACING = 5.0 * NAUTICAL_MILE  # at most this far apart is the sea sampled on segments


def layered_network(
    chart: Chart,
    places: Sequence[Position],
    *,
    layers: PerSection,
    fan: PerSection,
    offset: PerSection,
    near_coast: float | None = None,
    numbering: tuple[int, int] | None = None,
) -> Network:
    """Build a layered network from a start through waypoints to a goal.

    Between two waypoints lie S layers of nodes across the geodesic. The layers widen by d to
    either side up to the middle, and narrow again: a rhombus of half width ``d m`` with
    ``m = ceil(S/2)``. From every node H segments lead to the next layer; there is no way back.
    Every segment is tested whole against land, zones and the area of the chart. Nodes that are not
    on a path from start to goal are left out.

    Parameters
    ----------
    chart : Chart
        Land, zones and depth.
    places : sequence of (lat, lon)
        Start, waypoints that every path passes, and goal [deg]; two or more.
    layers : int or sequence of int
        S, for all sections or for each; 1 or more.
    fan : int or sequence of int
        H, 2 or more; an odd number has a segment straight ahead.
    offset : float or sequence of float
        d [m].
    near_coast : float, optional
        Within this distance of land [m] there are twice as many layers, and the nodes of a layer
        are half as far apart.
    numbering : tuple of int, optional
        Number of the first section in the voyage, from 0, and how many the voyage has, for
        messages.

    Returns
    -------
    Network
        ``meta.start`` and ``meta.goal`` are the ends. Its edges lead forward only. It does not
        bound routes off the network (``meta.gap_rad`` is 2 pi).

    Raises
    ------
    InputError
        For shapes that are not possible, or places that are not on navigable water.
    NoPathError
        If no path is left: ``details`` holds ``section`` and ``layer`` where it ends, and
        ``next_shape``, the shape to try.

    References
    ----------
    Prestegardshus (2020), sections 3.2 and 3.4, eqs. 3.26 to 3.37 with the placing by geodesics in
    place of the plane, and whole segments tested in place of nodes.
    """
    draft = layered_draft(places, layers=layers, fan=fan, offset=offset)
    if near_coast is not None:
        draft = refined_near_coast(chart, places, draft.shapes, near_coast)
    for a, b in itertools.pairwise(places):
        check_endpoints(chart, a, b)
    free, rejected = allowed_legs(chart, draft.lat, draft.lon, draft.first, draft.second)
    used, keep = segments_on_paths(len(draft.lat), draft.first, draft.second, free)
    if not keep.any():
        raise _broken_network(draft, free, rejected, numbering or (0, len(draft.shapes)))
    return _assembled(chart, draft, used, keep, rejected)


def segments_on_paths(
    n_nodes: int, first: Int32Array, second: Int32Array, free: BoolArray
) -> tuple[BoolArray, BoolArray]:
    """Return the nodes and segments on paths from the first node to the last, by two sweeps.

    Parameters
    ----------
    n_nodes : Number of nodes.
    first, second : The nodes that segments join, in the direction of sailing, (P,).
    free : Segments that may be sailed, (P,).

    Returns
    -------
    used : Nodes that the start reaches and that reach the goal, (n_nodes,).
    keep : Free segments between such nodes, (P,).
    """
    tails, heads = first[free], second[free]
    used = _reached(n_nodes, tails, heads, 0) & _reached(n_nodes, heads, tails, n_nodes - 1)
    keep = free & used[first] & used[second]
    return used, keep


def _reached(n_nodes: int, tails: Int32Array, heads: Int32Array, root: int) -> BoolArray:
    """Return which nodes can be reached from one."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import breadth_first_order

    table = csr_array((np.ones(len(tails), np.int8), (tails, heads)), shape=(n_nodes, n_nodes))
    found = np.zeros(n_nodes, bool)
    found[breadth_first_order(table, root, return_predecessors=False)] = True
    return found


def _assembled(
    chart: Chart,
    draft: LayeredDraft,
    used: BoolArray,
    keep: BoolArray,
    rejected: RejectionCounts,
) -> Network:
    number = np.cumsum(used, dtype=np.int32) - np.int32(1)
    stations = Stations(draft.lat[used], draft.lon[used], int(used.sum()))
    first, second = number[draft.first[keep]], number[draft.second[keep]]
    pairs = measured_pairs(stations.lat, stations.lon, first, second)
    stations, samples = evenly_spaced_samples(
        stations, pairs, _SAMPLE_SPACING, positions_on_short_legs
    )
    count = len(first)  # the segments are in the order of their first nodes
    leaving = np.bincount(first, minlength=stations.n_nodes)
    graph = Graph(cumulative_sums(leaving), second)
    directed = DirectedEdges(graph, np.arange(count, dtype=np.int32), np.zeros(count, bool))
    meta = NetworkMeta(
        kind="layered",
        spacing_m=_layer_distance(draft),
        directions=min(shape.fan for shape in draft.shapes),
        gap_rad=2.0 * math.pi,
        rejected=rejected,
        start=0,
        goal=stations.n_nodes - 1,
        notes=_notes(draft, keep, used, pairs),
    )
    return assemble(chart, stations, pairs, samples, meta=meta, directed=directed)


def _layer_distance(draft: LayeredDraft) -> float:
    """Return the greatest distance between two layers [m]."""
    ends = np.append(0, np.flatnonzero(np.diff(draft.section, append=-1)))
    lat, lon = draft.lat[ends], draft.lon[ends]
    between = geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    return float(max(a / (s.layers + 1) for a, s in zip(between, draft.shapes)))


def _notes(draft: LayeredDraft, keep: BoolArray, used: BoolArray, pairs: Pairs) -> tuple[str, ...]:
    nodes, segments = len(draft.lat), len(draft.first)
    notes = [
        f"Of {nodes:,} nodes and {segments:,} segments of the layered network, {int(used.sum()):,} "
        f"nodes and {int(keep.sum()):,} segments are on paths from start to goal."
    ]
    if any(shape.fan % 2 == 0 for shape in draft.shapes):
        notes.append(
            "A layered network with an even fan has no segment straight ahead: an odd number "
            "gives shorter routes."
        )
    return tuple(notes)


def _broken_network(
    draft: LayeredDraft, free: BoolArray, rejected: RejectionCounts, numbering: tuple[int, int]
) -> NoPathError:
    """Return the error of a network without a path: where it ends, and what to try."""
    reached = _reached(len(draft.lat), draft.first[free], draft.second[free], 0)
    last = int(np.flatnonzero(reached)[-1])  # nodes are in the order of the layers
    section, layer = int(draft.section[last]), int(draft.layer[last])
    if layer == draft.shapes[section].layers + 1 and section + 1 < len(draft.shapes):
        section, layer = section + 1, 0
    tried = int((reached[draft.first] & _leaves(draft, section, layer)).sum())
    shape, number = draft.shapes[section], numbering[0] + section + 1
    better = SectionShape(
        2 * shape.layers + 1, shape.fan + 1 if shape.fan % 2 == 0 else shape.fan + 2,
        max(shape.offset / 2.0, 1.0),
    )  # fmt: skip
    reasons = ", ".join(f"{n:,} {reason}" for reason, n in rejected.items())
    at = int(np.flatnonzero(reached)[-1])
    return NoPathError(
        f"The layered network has no path through section {number} of {numbering[1]}: "
        f"it ends between layer {layer} and layer {layer + 1}, where all {tried:,} segments from "
        "the nodes that are reached are refused.",
        f"Segments refused, of all {len(draft.first):,}: {reasons}.",
        f"Try a finer network for this section, such as {better.layers} layers, a fan of "
        f"{better.fan} and an offset of {better.offset / NAUTICAL_MILE:.3g} nm; or leave out all "
        "three, so that a shape that has a path is searched; or move the waypoint away from land, "
        "or require less distance from it (offing).",
        reasons=rejected,
        nearest=(float(draft.lat[at]), float(draft.lon[at])),
        section=number,
        layer=layer,
        next_shape={"layers": better.layers, "fan": better.fan, "offset_m": better.offset},
    )


def _leaves(draft: LayeredDraft, section: int, layer: int) -> BoolArray:
    """Return the segments that leave a layer of a section."""
    heads = draft.second
    return (draft.section[heads] == section) & (draft.layer[heads] == layer + 1)
