"""The globe builder: a geodesic grid of the whole sea, finer along coasts, with its ship canals."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart.canals import CANALS, Canal
from thalweg.chart.coast.coastline import Coastline
from thalweg.core import geodesy
from thalweg.core.errors import NoPathError, NoRouteError
from thalweg.core.geodesy import Position
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.assembly import (
    Pairs,
    allowed_legs,
    assemble,
    directed_edges,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.endpoints import check_endpoints, concatenate_pairs, direct_pairs
from thalweg.network.global_grid.endpoint_attachment import Attachment, ConnectedWaters, attach
from thalweg.network.global_grid.globe_options import GlobeOptions
from thalweg.network.global_grid.grid import GlobeGrid, globe_grid
from thalweg.network.network import Network, NetworkMeta, Stations
from thalweg.network.shortest_paths import ShortestPathTree, shortest_path_tree

if TYPE_CHECKING:
    from thalweg.chart import Chart

_LIMIT_MARGIN: Final = 1.0  # limits are moved this far beyond start and goal [deg]
_LINK_REACH: Final = 2.2  # positions are joined to nodes within this many legs of the uniform grid


@dataclass(frozen=True)
class _UnassembledGlobe:
    """All nodes (those of the grid, start, goal, canal ends, approaches), legs and canals."""

    stations: Stations
    pairs: Pairs
    through: Pairs
    canals: tuple[Canal, ...]
    start: int
    grid: GlobeGrid

    def distances(self, node: int) -> FloatArray:
        """Return the static distance [m] of every node from one; inf where unreached."""
        return self.paths_from(node).distance

    def paths_from(self, node: int) -> ShortestPathTree:
        """Return the shortest paths from a node to all others."""
        every = concatenate_pairs([self.pairs, self.through])
        edges = directed_edges(self.stations.n_nodes, every)
        return shortest_path_tree(edges.graph, every.length[edges.pair], node)


def globe(
    chart: Chart,
    start: Position,
    goal: Position,
    options: GlobeOptions | None = None,
    **changes: Any,
) -> Network:
    """Build a geodesic grid with two positions as nodes, and the chart's canals as edges.

    Parameters
    ----------
    chart : Chart
        Land, zones, depth and canals.
    start, goal : (lat, lon)
        Exact positions [deg] on navigable water.
    options : GlobeOptions, optional
        Fineness and extent; by default those for ocean passages.
    **changes
        Options by name, such as ``coast_levels=3``: they replace those of ``options``.

    Returns
    -------
    Network
        ``meta.start`` and ``meta.goal`` are the nodes at the exact positions; edges of canals have
        a ``fixed_time`` and a ``fee``.

    Raises
    ------
    InputError
        For values out of range, start or goal not on navigable water, or both the same.
    NoRouteError
        If start and goal do not connect; the message names a canal that would connect them.

    Notes
    -----
    Seuren (2020), section 4.2.1, with leaf faces closed over their hanging vertices and every leg
    tested against the coast along the geodesic. The grid of a coastline is built once and cached on
    disk (`thalweg.network.global_grid.grid`).
    """
    start, goal = check_endpoints(chart, start, goal)
    options = replace(options or GlobeOptions(), **changes)
    options = _limits_including_ends(options, start, goal)
    sheet = _draw_and_attach(chart, options, start, goal)
    to_start = sheet.distances(sheet.start)
    length = float(to_start[sheet.start + 1])
    if not math.isfinite(length):
        raise _no_route(chart, options, (start, goal), sheet, to_start)
    slack = _default_slack(length) if options.slack is None else options.slack
    if math.isfinite(slack):
        total = to_start + sheet.distances(sheet.start + 1)
        sheet = _sheet_subset(sheet, total <= (1.0 + slack) * length + sheet.grid.spacing)
    return _network(chart, sheet, options)


def globe_path(
    chart: Chart, start: Position, goal: Position
) -> tuple[list[Position], float] | None:
    """Return the shortest path over the geodesic grid of ocean passages, without its network.

    Parameters
    ----------
    chart : Land, zones and canals.
    start, goal : Positions [deg] on navigable water.

    Returns
    -------
    (list of (lat, lon), float), or None
        Positions [deg] from start to goal and the length [m]; None where they do not connect.

    Raises
    ------
    InputError : If start or goal are not on navigable water, or both are the same.
    NoRouteError : If an end cannot be joined to the grid.
    """
    start, goal = check_endpoints(chart, start, goal)
    options = _limits_including_ends(GlobeOptions(), start, goal)
    sheet = _draw_and_attach(chart, options, start, goal)
    tree = sheet.paths_from(sheet.start)
    path = tree.path(sheet.start + 1)
    if not path:
        return None
    places = sheet.stations.lat[path].tolist(), sheet.stations.lon[path].tolist()
    return list(zip(*places)), float(tree.distance[path[-1]])


def _default_slack(distance: float) -> float:
    miles = max(distance / NAUTICAL_MILE, 1.0)
    sizes, slacks = np.log([100.0, 1000.0, 5000.0]), [1.0, 0.35, 0.15]
    return float(np.interp(math.log(miles), sizes, slacks))


def _limits_including_ends(options: GlobeOptions, start: Position, goal: Position) -> GlobeOptions:
    """Return options whose limits lie beyond start and goal."""
    lowest, highest = min(start[0], goal[0]), max(start[0], goal[0])
    return replace(
        options,
        south=min(options.south, lowest - _LIMIT_MARGIN)
        if lowest < options.south
        else options.south,
        north=max(options.north, highest + _LIMIT_MARGIN)
        if highest > options.north
        else options.north,
    )


def _draw_and_attach(
    chart: Chart, options: GlobeOptions, start: Position, goal: Position
) -> _UnassembledGlobe:
    """Draw the grid's open sea, and join start, goal and the ends of the canals to it."""
    grid = globe_grid(chart, options.fineness)
    closed = chart.without_canals("all")
    pairs, usable = _open_sea(closed, grid, options)
    reach = _LINK_REACH * grid.spacing
    waters = ConnectedWaters.of_pairs(grid.lat, grid.lon, pairs, usable, reach)
    joints = [
        attach(closed, waters, place, what=what)
        for place, what in ((start, "start"), (goal, "goal"))
    ]
    canals: list[Canal] = []
    for canal in chart.canals:
        ends = _attach_canal(closed, waters, canal, options)
        if ends:
            canals.append(canal)
            joints += ends
    stations, more = _add_attachments(closed, grid, joints)
    ends_at = np.arange(len(grid.lat) + 2, len(grid.lat) + len(joints), 2, dtype=np.int32)
    through = measured_pairs(stations.lat, stations.lon, ends_at, ends_at + np.int32(1))
    through = replace(
        through,
        length=np.array([canal.length for canal in canals], float),
        course=np.full(len(canals), np.nan, np.float32),
    )
    start_node = len(grid.lat)
    return _UnassembledGlobe(
        stations, concatenate_pairs([pairs, more]), through, tuple(canals), start_node, grid
    )


def _open_sea(chart: Chart, grid: GlobeGrid, options: GlobeOptions) -> tuple[Pairs, BoolArray]:
    """Return the grid's legs within limits and area, and which nodes are usable."""
    usable = (grid.lat >= options.south) & (grid.lat <= options.north)
    shoals = type(chart.zones)(closed_shoals=chart.zones.closed_shoals)
    no_land = type(chart)(Coastline.none(), chart.area, shoals)
    bounded = chart.area.array().tolist() != [-90.0, 90.0, -180.0, 360.0]
    bounded |= shoals.closed_shoals is not None
    if bounded:
        usable &= no_land.is_navigable(grid.lat, grid.lon)
    pairs = grid.pairs.where(usable[grid.pairs.first] & usable[grid.pairs.second])
    if bounded:
        pairs = pairs.where(allowed_legs(no_land, grid.lat, grid.lon, pairs.first, pairs.second)[0])
    return pairs, usable


def _attach_canal(
    chart: Chart, waters: ConnectedWaters, canal: Canal, options: GlobeOptions
) -> list[Attachment] | None:
    """Return both ends of a canal joined to the grid; None where the grid is too coarse for it."""
    lat, lon = np.array(canal.ends).T
    inside = (lat >= options.south).all() and (lat <= options.north).all()
    if not (inside and bool(np.all(chart.is_navigable(lat, lon)))):
        return None
    try:
        what = f"end of the {canal.title}"
        return [attach(chart, waters, end, what=what, approach=False) for end in canal.ends]
    except NoRouteError:
        return None


def _add_attachments(
    chart: Chart, grid: GlobeGrid, joints: list[Attachment]
) -> tuple[Stations, Pairs]:
    """Return the grid's nodes, the positions and their approaches; and the legs that join them."""
    n, places = len(grid.lat), len(joints)
    lat = np.concatenate([grid.lat, [j.lat[0] for j in joints], *(j.lat[1:] for j in joints)])
    lon = np.concatenate([grid.lon, [j.lon[0] for j in joints], *(j.lon[1:] for j in joints)])
    first, second = [], []
    at = n + places
    for k, joint in enumerate(joints):
        own = np.append(n + k, at + np.arange(len(joint.lat) - 1))
        at += len(joint.lat) - 1
        first.append(own[joint.link_waypoint])
        second.append(joint.link_node)
    stations = Stations(lat, lon, len(lat))
    links = measured_pairs(
        lat, lon, np.concatenate(first).astype(np.int32), np.concatenate(second).astype(np.int32)
    )
    between = direct_pairs(chart, stations, n, reach=_LINK_REACH * grid.spacing)
    return stations, concatenate_pairs([links, between])


def _sheet_subset(sheet: _UnassembledGlobe, keep: BoolArray) -> _UnassembledGlobe:
    """Return the sheet with only the selected nodes; start and goal are always selected."""
    keep = keep.copy()
    keep[sheet.start : sheet.start + 2] = True
    new = (np.cumsum(keep) - 1).astype(np.int32)
    stations = Stations(sheet.stations.lat[keep], sheet.stations.lon[keep], int(keep.sum()))
    whole = keep[sheet.through.first] & keep[sheet.through.second]
    return replace(
        sheet,
        stations=stations,
        pairs=_renumbered(sheet.pairs, keep, new),
        through=_renumbered(sheet.through, keep, new),
        canals=tuple(canal for canal, selected in zip(sheet.canals, whole) if selected),
        start=int(new[sheet.start]),
    )


def _renumbered(pairs: Pairs, keep: BoolArray, new: np.ndarray) -> Pairs:
    selected = pairs.where(keep[pairs.first] & keep[pairs.second])
    return replace(selected, first=new[selected.first], second=new[selected.second])


def _network(chart: Chart, sheet: _UnassembledGlobe, options: GlobeOptions) -> Network:
    """Sample the legs along their length and assemble the network; canals are not sampled."""
    pairs = concatenate_pairs([sheet.pairs, sheet.through])
    apart = np.full(len(pairs.first), options.sample_spacing)
    apart[len(sheet.pairs.first) :] = np.inf  # canals need no weather
    stations, samples = evenly_spaced_samples(sheet.stations, pairs, apart)
    meta = NetworkMeta(
        kind=f"globe/{options.fineness.level}+{options.fineness.coast_levels}",
        spacing_m=sheet.grid.spacing,
        directions=options.fineness.directions,
        gap_rad=sheet.grid.gap,
        rejected={"land": sheet.grid.rejected},
        start=sheet.start,
        goal=sheet.start + 1,
        notes=tuple(f"may pass the {canal.title}" for canal in sheet.canals),
    )
    return assemble(chart, stations, pairs, samples, meta=meta)


def _no_route(
    chart: Chart, options: GlobeOptions, ends: tuple[Position, Position], sheet: _UnassembledGlobe,
    to_start: FloatArray,
) -> NoRouteError:  # fmt: skip
    reached = np.flatnonzero(np.isfinite(to_start))
    lat, lon = sheet.stations.lat[reached], sheet.stations.lon[reached]
    separation = geodesy.distance(lat, lon, *ends[1])
    best = int(np.argmin(separation))
    nearest = float(lat[best]), float(lon[best])
    names = [geodesy.format_position(*place) for place in (*ends, nearest)]
    remedy = "Choose another start or goal, a finer chart, or more coast levels."
    missing = [canal for canal in CANALS if canal not in chart.canals]
    if missing and math.isfinite(_shortest_length(replace(chart, canals=CANALS), options, ends)):
        titles = " and the ".join(canal.title for canal in missing)
        remedy = f"Allow the {titles}: with all canals a route exists."
    return NoPathError(
        f"There is no path by water from {names[0]} to {names[1]} on this chart.",
        f"The network reaches {names[2]}, {separation[best] / NAUTICAL_MILE:.1f} nm from the goal.",
        remedy,
        reasons={"land": sheet.grid.rejected},
        nearest=nearest,
    )


def _shortest_length(chart: Chart, options: GlobeOptions, ends: tuple[Position, Position]) -> float:
    """Return the length of the shortest path between two ends [m]; inf where none exists."""
    sheet = _draw_and_attach(chart, options, *ends)
    return float(sheet.distances(sheet.start)[sheet.start + 1])
