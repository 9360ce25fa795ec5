"""A graph of all seas for distances: the globe grid with the canals.

It is used to find the shortest way between two positions within a fraction of a second; networks
for planning are built by `thalweg.network.global_grid.globe_builder`. `sea_graph_cache` keeps it.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.depth.shoals import HARBOUR
from thalweg.chart.offing import closing_line
from thalweg.chart.passages import Passage
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import (
    MEAN_RADIUS,
    Position,
    format_position,
    geocentric_unit_vectors,
)
from thalweg.core.types import BoolArray, FloatArray, Int32Array, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.assembly import Pairs, directed_edges, measured_pairs
from thalweg.network.distance_bounds import distance_bounds
from thalweg.network.endpoints import concatenate_pairs
from thalweg.network.global_grid.endpoint_attachment import (
    Attachment,
    ConnectedWaters,
    LinePlaces,
    attach,
    attach_line,
    line_to_line_pairs,
)
from thalweg.network.global_grid.grid import GlobeGrid, GridResolution, globe_grid
from thalweg.network.global_grid.ice_limits import (
    ICE_LATITUDES,
    PACK_ICE,
    northern_limit,
    outside_ice,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.depth.shoals import Shoals

RESOLUTION: Final = GridResolution(4, 5, 4, 12)
_LINK_REACH: Final = 2.2  # positions are joined to nodes within this many legs of the uniform grid
#: Water nearer to land than this counts up to `NEAR_LAND_FACTOR` times in the choice of the way.
OFFING: Final = 2.0 * NAUTICAL_MILE
NEAR_LAND_FACTOR: Final = 1.5
_IN_ICE, _IN_PACK = -2, -3  # among the canals of edges
_ROUND_HARBOUR: Final = HARBOUR + 12.0 * NAUTICAL_MILE  # with the cells of the grid of depth
_LONGEST_EDGE: Final = 250e3  # of edges across a passage, between two coasts [m]


@dataclass(frozen=True)
class GraphClosures:
    """What a way over the graph may not use, and where a mile counts more.

    Attributes
    ----------
    canals : Canals of the chart that are closed, by number.
    passages : Passages that are closed in the chart but not in the graph.
    shoals : Shoal water, in which a mile counts more.
    excess : By how much it does on each edge of the graph, where known (`SeaGraph.shoal_excess`).
    south : Latitude that no edge passes [deg].
    """

    canals: Sequence[int] = ()
    passages: Sequence[Passage] = ()
    shoals: Shoals | None = None
    excess: FloatArray | None = field(default=None, repr=False)
    south: float = -90.0


@dataclass(frozen=True, eq=False)
class SeaGraph:
    """All seas of a chart as a graph.

    Attributes
    ----------
    waters : The nodes and their connected waters.
    indptr : int32[N + 1]
        Where the edges of each node begin.
    target : int32[E]
        Head of each edge.
    weight : float64[E]
        Length of each edge [m], times a factor near land.
    canal : int8[E]
        Index of the canal of the chart, -1 at sea, -2 beyond the latitudes where ice is likely.
    """

    waters: ConnectedWaters
    indptr: Int32Array
    target: Int32Array
    weight: FloatArray
    canal: IntArray

    def path(
        self,
        chart: Chart,
        start: Position,
        goal: Position,
        closures: GraphClosures = GraphClosures(),
    ) -> list[Position]:
        """Return the positions of the shortest way between two positions over the graph.

        Parameters
        ----------
        chart : Tests the legs that join the positions to the graph, and those near closed passages.
        start, goal : (lat, lon)
            Positions on navigable water [deg].
        closures : Canals, passages and shoals that are closed or count more.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        sea = chart.without_canals("all")
        ends = [
            attach(sea, self.waters, place, what=what)
            for place, what in ((start, "start"), (goal, "goal"))
        ]
        weight = self._weights(sea, (start, goal), closures)
        lat, lon, nodes, _ = self._shortest(ends, weight, closures)
        return list(zip(lat[nodes].tolist(), lon[nodes].tolist()))

    def path_between_lines(
        self,
        chart: Chart,
        start: LinePlaces,
        goal: LinePlaces,
        closures: GraphClosures = GraphClosures(),
    ) -> tuple[list[Position], tuple[int, int]]:
        """Return the shortest way from the first place of one line to the first of another one.

        It follows each line for a part and leaves it where that makes the whole shortest.

        Parameters
        ----------
        chart, closures : As of `path`.
        start, goal : Places of lines that begin at berths.

        Returns
        -------
        list of (lat, lon) : From where the first line is left to where the second one is met [deg].
        (int, int) : Numbers of these two places.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        sea = chart.without_canals("all")
        ends = [attach_line(sea, self.waters, line) for line in (start, goal)]
        first, last = ((float(line.lat[0]), float(line.lon[0])) for line in (start, goal))
        weight = self._weights(sea, (first, last), closures)
        direct = line_to_line_pairs(sea, start, goal)
        lat, lon, nodes, begins = self._shortest(ends, weight, closures, direct=direct)
        of_start = (nodes >= begins[0]) & (nodes < begins[1])
        left = int(np.flatnonzero(of_start)[-1])
        met = int(np.flatnonzero(nodes >= begins[1])[0])
        between = nodes[left : met + 1]
        path = list(zip(lat[between].tolist(), lon[between].tolist()))
        return path, (int(nodes[left]) - begins[0], int(nodes[met]) - begins[1])

    def _weights(
        self, chart: Chart, ends: Sequence[Position], closures: GraphClosures
    ) -> FloatArray:
        """Return the weights for a way between two ends, inf where it may not go."""
        closed = (*closures.canals, *_closed_in_ice(*ends))
        facts = chart.fingerprint(), closed, tuple(closures.passages), closures.south
        return _weight_without(self, _Closed(*facts, chart))

    @cached_property
    def tails(self) -> IntArray:
        """Tail of each edge."""
        return np.repeat(np.arange(len(self.waters.lat)), np.diff(self.indptr))

    def _shortest(
        self,
        ends: Sequence[Attachment],
        weight: FloatArray,
        closures: GraphClosures,
        *,
        direct: tuple[IntArray, IntArray] | None = None,
    ) -> tuple[FloatArray, FloatArray, IntArray, tuple[int, int]]:
        """Return the shortest way between the first positions of two attachments.

        Parameters
        ----------
        direct : Positions of the first and of the second one that a leg joins, by number.

        Returns
        -------
        lat, lon : Of all nodes and attached positions [deg].
        nodes : Those of the way.
        begins : Numbers of the first position of each attachment.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        lat = np.concatenate([self.waters.lat, *(end.lat for end in ends)])
        lon = np.concatenate([self.waters.lon, *(end.lon for end in ends)])
        first = len(self.waters.lat)
        second = first + len(ends[0].lat)
        links = [_joint_pairs(end, at, lat, lon) for end, at in zip(ends, (first, second))]
        if direct is not None:
            heads, tails = first + direct[0], second + direct[1]
            links.append(measured_pairs(lat, lon, heads.astype(np.int32), tails.astype(np.int32)))
        joints = concatenate_pairs(links)
        if closures.shoals is not None:
            more = closures.excess
            more = self.shoal_excess(closures.shoals) if more is None else more
            weight = weight * (1.0 + more)
            a, b = joints.first, joints.second
            excess = closures.shoals.excess(lat[a], lon[a], lat[b], lon[b])
            joints = replace(joints, length=joints.length * (1.0 + excess))
        indptr, target, weight = self._with_links(joints, len(lat), weight)
        known, parent = np.empty(len(lat)), np.empty(len(lat), np.int64)
        start, goal = ((float(lat[k]), float(lon[k])) for k in (first, second))
        bound = distance_bounds(lat, lon, *goal)
        static_astar(indptr, target, weight, bound, first, second, known, parent)
        if not np.isfinite(known[second]):
            names = format_position(*start), format_position(*goal)
            raise NoRouteError(
                f"There is no way by sea from {names[0]} to {names[1]}.",
                "Both positions are on water, but their waters do not meet on this chart.",
                "Allow canals, or choose another position.",
            )
        nodes = [second]
        while parent[nodes[-1]] >= 0:
            nodes.append(int(parent[nodes[-1]]))
        return lat, lon, np.array(nodes[::-1], np.int64), (first, second)

    def shoal_excess(self, shoals: Shoals) -> FloatArray:
        """Return by how much a mile counts more on each edge; 0 in canals."""
        excess, at_sea = np.zeros(len(self.target)), np.flatnonzero(self.canal < 0)
        excess[at_sea] = self._excess_of(shoals, at_sea)
        return excess

    def shoal_excess_round_harbours(self, shoals: Shoals, elsewhere: FloatArray) -> FloatArray:
        """Return `shoal_excess` of shoals with harbours, given the one without these."""
        excess = elsewhere.copy()
        for place in geocentric_unit_vectors(*np.array(shoals.harbours).T):
            away = np.arccos(np.clip(self.waters.vectors @ place, -1.0, 1.0)) * MEAN_RADIUS
            near = np.flatnonzero(
                (away[self.tails] - self.weight < _ROUND_HARBOUR) & (self.canal < 0)
            )
            excess[near] = self._excess_of(shoals, near)
        return excess

    def _excess_of(self, shoals: Shoals, edges: IntArray) -> FloatArray:
        return shoals.excess(*self.ends_of_edges(edges))

    def ends_of_edges(
        self, edges: IntArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return latitudes and longitudes [deg] of the tails and heads of edges."""
        lat, lon = self.waters.lat, self.waters.lon
        tail, head = self.tails[edges], self.target[edges]
        return lat[tail], lon[tail], lat[head], lon[head]

    def _with_links(
        self, links: Pairs, count: int, weight: FloatArray
    ) -> tuple[Int32Array, Int32Array, FloatArray]:
        """Return the graph with links in both directions added, with other weights."""
        tail = np.concatenate([links.first, links.second])
        head = np.concatenate([links.second, links.first]).astype(np.int32)
        length = np.concatenate([links.length, links.length])
        order = np.argsort(tail, kind="stable")
        tail, head, length = tail[order], head[order], length[order]
        ends = np.concatenate([self.indptr, np.full(count - len(self.indptr) + 1, self.indptr[-1])])
        at = ends[tail + 1]
        more = cumulative_sums(np.bincount(tail, minlength=count))
        indptr = (ends + more).astype(np.int32)
        target = np.insert(self.target, at, head)
        return indptr, target, np.insert(weight, at, length)


@dataclass(frozen=True)
class _Closed:
    """What is closed in a graph: canals by number, and passages where legs of the chart are.

    Charts of one fingerprint block the same legs.
    """

    fingerprint: str
    canals: tuple[int, ...]
    passages: tuple[Passage, ...]
    south: float
    chart: Chart = field(compare=False, repr=False)


@lru_cache(maxsize=4)  # a plan asks for a few of them dozens of times
def _weight_without(graph: SeaGraph, closed: _Closed) -> FloatArray:
    """Return the weights, inf for closed canals and where a chart closes passages; read-only."""
    weight = graph.weight.copy()
    if closed.canals:
        weight[np.isin(graph.canal, closed.canals)] = np.inf
    lat, tail = graph.waters.lat, graph.tails
    weight[(lat[tail] < closed.south) | (lat[graph.target] < closed.south)] = np.inf
    for passage in closed.passages:
        line = np.array(closing_line(closed.chart.coastline, passage)).T
        one, other = geocentric_unit_vectors(*line)
        middle = (one + other) / np.linalg.norm(one + other)
        half = float(np.arccos(np.clip(one @ middle, -1.0, 1.0)))
        beside = graph.waters.vectors @ middle >= np.cos(half + _LONGEST_EDGE / MEAN_RADIUS)
        near = np.flatnonzero(beside[tail] & (graph.canal < 0))
        weight[near[np.asarray(closed.chart.legs_blocked(*graph.ends_of_edges(near)))]] = np.inf
    weight.flags.writeable = False
    return weight


def _closed_in_ice(*places: Position) -> tuple[int, ...]:
    """Return which edges in ice a way between positions does not use."""
    if outside_ice(*places):
        return _IN_ICE, _IN_PACK
    return () if northern_limit(*places) > PACK_ICE else (_IN_PACK,)


def _joint_pairs(joint: Attachment, at: int, lat: FloatArray, lon: FloatArray) -> Pairs:
    """Return the links of an attachment whose first position is node ``at``."""
    chain = np.arange(at, at + len(joint.lat))
    first = np.concatenate([at + joint.link_waypoint, chain[:-1]]).astype(np.int32)
    second = np.concatenate([joint.link_node, chain[1:]]).astype(np.int32)
    return measured_pairs(lat, lon, first, second)


def make_sea_graph(chart: Chart) -> SeaGraph:
    """Make the graph of a chart's coastline and canals (see `sea_graph`)."""
    grid = globe_grid(chart, RESOLUTION)
    sea = chart.without_canals("all")
    usable = np.ones(len(grid.lat), bool)
    reach = _LINK_REACH * grid.spacing
    waters = ConnectedWaters.of_pairs(grid.lat, grid.lon, grid.pairs, usable, reach)
    pairs = [replace(grid.pairs, length=grid.pairs.length * _factors(sea, grid))]
    lowest, highest = ICE_LATITUDES
    in_ice = _beyond(grid, (grid.lat < lowest) | (grid.lat > highest))
    canal = [np.where(in_ice, _IN_ICE, -1)]
    canal[0][_beyond(grid, grid.lat > PACK_ICE)] = _IN_PACK
    lat, lon = [grid.lat], [grid.lon]
    count = len(grid.lat)
    for number, one in enumerate(chart.canals):
        joints = []
        with contextlib.suppress(NoRouteError):  # where the grid is too coarse for a canal
            what = f"end of the {one.title}"
            joints = [attach(sea, waters, end, what=what, approach=False) for end in one.ends]
        if not joints:
            continue
        lat, lon = [*lat, *(j.lat for j in joints)], [*lon, *(j.lon for j in joints)]
        every = np.concatenate(lat), np.concatenate(lon)
        ends = [_joint_pairs(j, count + k, *every) for k, j in enumerate(joints)]
        nodes = np.array([count], np.int32), np.array([count + 1], np.int32)
        through = Pairs(*nodes, np.array([one.length]), np.array([0.0], np.float32))
        pairs += [*ends, through]
        canal += [np.full(sum(len(p.first) for p in ends), -1), np.array([number])]
        count += 2
    every_pair = concatenate_pairs(pairs)
    edges = directed_edges(count, every_pair)
    return SeaGraph(
        _grown(waters, np.concatenate(lat), np.concatenate(lon)),
        edges.graph.indptr.astype(np.int32),
        edges.graph.target.astype(np.int32),
        every_pair.length[edges.pair].astype(np.float64),
        np.concatenate(canal)[edges.pair].astype(np.int8),
    )


def _factors(chart: Chart, grid: GlobeGrid) -> FloatArray:
    """Return the factor of the length of every pair near land."""
    off = np.asarray(chart.coastline.shore_distance(grid.lat, grid.lon, cap=OFFING))
    near = 1.0 - np.minimum(off, OFFING) / OFFING
    node = 1.0 + (NEAR_LAND_FACTOR - 1.0) * near
    return np.asarray(0.5 * (node[grid.pairs.first] + node[grid.pairs.second]))


def _beyond(grid: GlobeGrid, nodes: BoolArray) -> BoolArray:
    """Return which pairs have one of some nodes."""
    return np.asarray(nodes[grid.pairs.first] | nodes[grid.pairs.second])


def _grown(waters: ConnectedWaters, lat: FloatArray, lon: FloatArray) -> ConnectedWaters:
    """Return waters with more nodes, which no position is joined to."""
    more = len(lat) - len(waters.lat)
    return ConnectedWaters(
        lat,
        lon,
        np.append(waters.water, np.full(more, -1)),
        np.append(waters.size, np.zeros(more, np.int64)),
        waters.reach,
    )
