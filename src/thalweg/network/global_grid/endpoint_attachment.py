"""Attachment of exact positions to a grid, directly or by an approach to its largest water."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.core.geodesy import MEAN_RADIUS, Position, distance, format_position, wrap_longitude
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.assembly import Pairs
from thalweg.network.conformal_projection import angle_to_point, conformal_unit_vectors
from thalweg.network.regional_lattice.lattice_builder import lattice
from thalweg.network.shortest_paths import shortest_path

if TYPE_CHECKING:
    from thalweg.chart import Chart

_SECTORS: Final = 48
_LINKS_PER_SECTOR_AND_RING: Final = 3  # nodes tested in every sector and ring
_NEAREST_LINKS: Final = 32  # and the nearest ones in any case
_MAX_LINKS: Final = 200
_SHORTEST_LINK: Final = 1.0  # [m]
_MIN_BASIN_NODES: Final = 200  # connected water of at least this many nodes is a basin of its own
_FARTHEST_APPROACH: Final = 150.0 * NAUTICAL_MILE
_MAX_APPROACHES: Final = 3
_CHAIN_REACH: Final = 20.0 * NAUTICAL_MILE
_LONGEST_DIRECT_LEG: Final = 30.0 * NAUTICAL_MILE  # between two lines


@dataclass(frozen=True)
class ConnectedWaters:
    """Nodes of a grid and the waters they belong to.

    Attributes
    ----------
    lat, lon : float64[N]
        Nodes [deg].
    water : int64[N]
        Number of the connected water of each node.
    size : int64[N]
        How many nodes that water has.
    reach : Positions are joined to nodes within this distance [m].
    """

    lat: FloatArray
    lon: FloatArray
    water: IntArray
    size: IntArray
    reach: float

    @classmethod
    def of_pairs(
        cls, lat: FloatArray, lon: FloatArray, pairs: Pairs, usable: BoolArray, reach: float
    ) -> ConnectedWaters:
        """Return the connected waters of nodes joined by pairs; unusable nodes count for none."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        n = len(lat)
        joined = coo_array(
            (np.ones(len(pairs.first), bool), (pairs.first, pairs.second)), shape=(n, n)
        )
        water = connected_components(joined, directed=False)[1].astype(np.int64)
        size = np.bincount(water)[water]
        size[~usable] = 0
        return cls(lat, lon, water, size, reach)

    def part(self, nodes: IntArray) -> ConnectedWaters:
        """Return some of the nodes, with the sizes of their whole waters."""
        return ConnectedWaters(
            self.lat[nodes], self.lon[nodes], self.water[nodes], self.size[nodes], self.reach
        )

    @cached_property
    def largest(self) -> int:
        """The number of the largest water."""
        return int(self.water[np.argmax(self.size)])

    @cached_property
    def vectors(self) -> FloatArray:
        """Unit vectors (N, 3) of the nodes."""
        return conformal_unit_vectors(self.lat, self.lon)


@dataclass(frozen=True)
class Attachment:
    """Links of a position to a grid.

    Attributes
    ----------
    lat, lon : float64[K]
        The position and the waypoints of its approach [deg], each joined to the one before.
    link_waypoint, link_node : int64[L]
        Links: index of the waypoint, and of the node.
    """

    lat: FloatArray
    lon: FloatArray
    link_waypoint: IntArray
    link_node: IntArray


@dataclass(frozen=True)
class LinePlaces:
    """Places along a line that a way may leave at some of them.

    Attributes
    ----------
    lat, lon : float64[K]
        From the first place of the line on [deg].
    along : float64[K]
        Length of the line from its first place [m].
    may_leave : bool[K]
        Where the line may be left.
    """

    lat: FloatArray
    lon: FloatArray
    along: FloatArray
    may_leave: BoolArray


def attach(
    chart: Chart, waters: ConnectedWaters, place: Position, *, what: str, approach: bool = True
) -> Attachment:
    """Join a position to the nodes it can reach by tested legs.

    Parameters
    ----------
    chart : Tests the legs.
    waters : Nodes of the grid.
    place : (lat, lon)
        Navigable position [deg].
    what : Its name in errors.
    approach : Whether an approach may be searched, which takes one or two seconds.

    Returns
    -------
    Attachment : Links to the largest water within reach; where that is small, an approach to the
        largest of all is added, found on a fine lattice.

    Raises
    ------
    NoRouteError : If no node can be reached.
    """
    near = _candidates(waters, place, np.ones(len(waters.lat), bool), waters.reach)
    seen = _reachable_nodes(chart, place, waters, near)
    best = int(waters.water[seen[np.argmax(waters.size[seen])]]) if len(seen) else -1
    if best >= 0 and (best == waters.largest or waters.size[seen].max() >= _MIN_BASIN_NODES):
        inside = waters.water == best
        links = _reachable_nodes(
            chart, place, waters, _candidates(waters, place, inside, waters.reach)
        )
        return _direct_attachment(place, _nearest_by_sector(waters, place, links))
    found = _approach(chart, waters, place) if approach else None
    if found is not None:
        return found
    if best >= 0 and approach:
        return _direct_attachment(
            place, _nearest_by_sector(waters, place, seen[waters.water[seen] == best])
        )
    raise NoPathError(
        f"The {what} {format_position(*place)} cannot be joined to the network.",
        f"No node of it can be reached within {_FARTHEST_APPROACH / NAUTICAL_MILE:.0f} nm.",
        "Give another position or more coast levels.",
        nearest=place,
    )


def attach_line(chart: Chart, waters: ConnectedWaters, line: LinePlaces) -> Attachment:
    """Join the places where a line may be left to the nodes they can reach by tested legs.

    Parameters
    ----------
    chart : Tests the legs.
    waters : Nodes of the grid; those of small waters are not used.
    line : Places, each joined to the one before.

    Returns
    -------
    Attachment : Without links where no node is reached.
    """
    number = _nodes_near(waters, line)
    around = waters.part(number)
    every = np.ones(len(number), bool)
    at, nodes = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for k in np.flatnonzero(line.may_leave).tolist():
        place = float(line.lat[k]), float(line.lon[k])
        near = _candidates(around, place, every, waters.reach)
        seen = _nearest_by_sector(around, place, _reachable_nodes(chart, place, around, near))
        at.append(np.full(len(seen), k))
        nodes.append(number[seen])
    return Attachment(line.lat, line.lon, np.concatenate(at), np.concatenate(nodes))


def _nodes_near(waters: ConnectedWaters, line: LinePlaces) -> IntArray:
    """Return the nodes of basins that may be within reach of a line."""
    places = conformal_unit_vectors(line.lat, line.lon)
    middle = places.mean(axis=0)
    middle /= np.linalg.norm(middle)
    angle = float(np.arccos(np.clip(places @ middle, -1.0, 1.0).min()))
    least = np.cos(min(angle + waters.reach / MEAN_RADIUS, np.pi)) - 1e-9
    near = (waters.size >= _MIN_BASIN_NODES) & (waters.vectors @ middle >= least)
    return np.flatnonzero(near)


def line_to_line_pairs(
    chart: Chart, start: LinePlaces, goal: LinePlaces
) -> tuple[IntArray, IntArray]:
    """Return the places of two lines, by number, that one leg joins where both may be left."""
    from_start, from_goal = (np.flatnonzero(line.may_leave) for line in (start, goal))
    i, j = np.repeat(from_start, len(from_goal)), np.tile(from_goal, len(from_start))
    legs = start.lat[i], start.lon[i], goal.lat[j], goal.lon[j]
    apart = np.asarray(distance(*legs))
    near = (apart > _SHORTEST_LINK) & (apart <= _LONGEST_DIRECT_LEG)
    i, j = i[near], j[near]
    free = np.asarray(chart.leg_status(*(part[near] for part in legs))) == codes.OK
    return i[free], j[free]


def _direct_attachment(place: Position, nodes: IntArray) -> Attachment:
    lat, lon = np.array([place[0]]), np.array([place[1]])
    return Attachment(lat, lon, np.zeros(len(nodes), np.int64), nodes)


def _candidates(
    waters: ConnectedWaters, place: Position, allowed: BoolArray, reach: float
) -> IntArray:
    """Return the nearest allowed nodes, and the nearest of every sector and ring within reach."""
    within = (
        waters.vectors @ conformal_unit_vectors(*place)
        >= np.cos(min(reach / MEAN_RADIUS, np.pi)) - 1e-9
    )
    nodes = np.flatnonzero(allowed & within)
    separation, course = _distance_and_course(waters, place, nodes)
    near = (separation <= reach) & (separation > _SHORTEST_LINK)
    nodes, separation, course = nodes[near], separation[near], course[near]
    order = np.argsort(separation, kind="stable")
    nodes, separation, course = nodes[order], separation[order], course[order]
    sector = np.floor(course * (_SECTORS / (2.0 * np.pi))).astype(np.int64)
    cell = sector * 1000 + np.floor(2.0 * np.log2(separation)).astype(np.int64)
    by_cell = np.argsort(cell, kind="stable")
    begins = np.append(True, np.diff(cell[by_cell]) != 0) if len(cell) else np.empty(0, bool)
    rank = np.arange(len(cell)) - np.maximum.accumulate(np.where(begins, np.arange(len(cell)), 0))
    chosen = np.zeros(len(nodes), bool)
    chosen[by_cell[rank < _LINKS_PER_SECTOR_AND_RING]] = True
    chosen[:_NEAREST_LINKS] = True
    return nodes[chosen]


def _distance_and_course(
    waters: ConnectedWaters, place: Position, nodes: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return the distance [m] and course [rad] of nodes from a position, on a sphere."""
    here, there = conformal_unit_vectors(*place), waters.vectors[nodes]
    separation = angle_to_point(there, here)
    lam = np.radians(place[1])
    east = np.array([-np.sin(lam), np.cos(lam), 0.0])
    course = np.arctan2(there @ east, there @ np.cross(here, east)) % (2.0 * np.pi)
    return separation * MEAN_RADIUS, course


def _reachable_nodes(
    chart: Chart, place: Position, waters: ConnectedWaters, nodes: IntArray
) -> IntArray:
    """Return the nodes a position can be joined to by one leg."""
    lat, lon = np.full(len(nodes), place[0]), np.full(len(nodes), place[1])
    status = chart.leg_status(lat, lon, waters.lat[nodes], waters.lon[nodes])
    return nodes[np.asarray(status) == codes.OK]


def _nearest_by_sector(waters: ConnectedWaters, place: Position, nodes: IntArray) -> IntArray:
    if len(nodes) <= _MAX_LINKS:
        return nodes
    separation, _ = _distance_and_course(waters, place, nodes)
    order = np.argsort(separation, kind="stable")
    most = np.linspace(0, len(order) - 1, _MAX_LINKS).astype(np.int64)
    return nodes[np.union1d(order[:_NEAREST_LINKS], order[most])]


def _approach(chart: Chart, waters: ConnectedWaters, place: Position) -> Attachment | None:
    """Return an approach from a position to the largest water, or None if none exists."""
    nodes = np.flatnonzero(waters.water == waters.largest)
    separation, _ = _distance_and_course(waters, place, nodes)
    order = np.argsort(separation, kind="stable")
    tried: list[Position] = []
    for k in order:
        goal = float(waters.lat[nodes[k]]), float(waters.lon[nodes[k]])
        if separation[k] > _FARTHEST_APPROACH or len(tried) >= _MAX_APPROACHES:
            return None
        if any(float(distance(*goal, *other)) < 0.3 * separation[k] for other in tried):
            continue
        tried.append(goal)
        path = _fine_path(_FinePathRequest.on_chart(chart, place, goal))
        if path is not None:
            return _attach_along(chart, waters, path, nodes[k])
    return None


@dataclass(frozen=True)
class _FinePathRequest:
    """A path on a fine lattice; two requests for the same ends on the same chart are equal."""

    chart: Chart = field(compare=False)
    chart_key: tuple[str, ...]
    start: Position
    goal: Position

    @classmethod
    def on_chart(cls, chart: Chart, start: Position, goal: Position) -> _FinePathRequest:
        sea = chart.without_canals("all")
        key = sea.fingerprint(), *(passage.name for passage in sea.passages)
        return cls(sea, key, start, goal)


@lru_cache(maxsize=16)  # one plan asks for those of its ends a dozen times
def _fine_path(request: _FinePathRequest) -> tuple[FloatArray, FloatArray] | None:
    """Return the shortest path on a fine lattice between near positions; None where none is."""
    chart, start, goal = request.chart, request.start, request.goal
    separation = float(distance(*start, *goal))
    margin = max(separation, 15.0 * NAUTICAL_MILE) / (60.0 * NAUTICAL_MILE)
    east = margin / max(float(np.cos(np.radians(start[0]))), 0.05)
    turn = float(wrap_longitude(start[1] - goal[1]))
    middle = goal[1] + 0.5 * turn
    wide = east + 0.5 * abs(turn)
    south = max(min(start[0], goal[0]) - margin, -89.9)
    area = (south, min(max(start[0], goal[0]) + margin, 89.9), middle - wide, middle + wide)
    try:
        fine = lattice(chart, start, goal, area=area, directions=16)
    except NoRouteError:
        return None
    _, path = shortest_path(fine, fine.meta.start, fine.meta.goal)
    return string_pull_path(chart, fine.lat[path], fine.lon[path], rounds=0)


def _attach_along(
    chart: Chart, waters: ConnectedWaters, path: tuple[FloatArray, FloatArray], last: int
) -> Attachment:
    """Return an approach that ends at a node, with links from each of its waypoints."""
    lat, lon = path[0][:-1], path[1][:-1]
    link_waypoint, link_node = [np.array([len(lat) - 1])], [np.array([last])]
    inside = waters.water == waters.largest
    for k, place in enumerate(zip(lat.tolist(), lon.tolist())):
        near = _candidates(waters, place, inside, _CHAIN_REACH)
        nodes = _nearest_by_sector(waters, place, _reachable_nodes(chart, place, waters, near))
        link_waypoint.append(np.full(len(nodes), k))
        link_node.append(nodes)
    pairs = np.unique(np.stack([np.concatenate(link_waypoint), np.concatenate(link_node)]), axis=1)
    return Attachment(lat, lon, pairs[0].astype(np.int64), pairs[1].astype(np.int64))
