"""The cheapest way between two positions of a line over a small lattice around it."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.leg_rules import LegCost, LegTests, PolylineCoordinates

_STEPS: Final = ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1))
_JOINED: Final = 1.6  # of the spacing: nodes so near to a position of the line are joined to it
_MOST_ROWS: Final = 48  # of the lattice, and columns
_DEGREE: Final = 60.0 * NAUTICAL_MILE


def lattice_detour(
    chart: LegTests, line: PolylineCoordinates, *, leg_cost: LegCost, spacing: float, reach: float
) -> PolylineCoordinates:
    """Return the cheapest path between the ends of a line, over a lattice and along the line.

    Parameters
    ----------
    chart : Tests the legs; there are no canals on the line.
    line : Latitudes and longitudes of a path of allowed legs [deg].
    leg_cost : Cost of legs.
    spacing : Of the lattice [m]; wider where it would have more than 48 rows or columns.
    reach : Of the lattice beyond the line [m].

    Returns
    -------
    lat, lon : The path [deg]; it costs no more than the line.
    """
    lat, lon = np.asarray(line[0], float), np.asarray(line[1], float)
    lon = lon[0] + wrap_longitude(lon - lon[0])
    shrink = max(float(np.cos(np.radians(lat.mean()))), 0.1)
    y, x = lat * _DEGREE, lon * _DEGREE * shrink  # [m], near enough over a small area
    low, high = ((f(y) + d, f(x) + d) for f, d in ((np.min, -reach), (np.max, reach)))
    spacing = max(spacing, *((b - a) / (_MOST_ROWS - 1) for a, b in zip(low, high)))
    rows, columns = (np.arange(a, b + 0.5 * spacing, spacing) for a, b in zip(low, high))
    grid_y, grid_x = (axis.ravel() for axis in np.meshgrid(rows, columns, indexing="ij"))
    first, second = _edges(len(rows), len(columns))
    node_y, node_x = np.append(y, grid_y), np.append(x, grid_x)
    near = np.hypot(y[:, None] - grid_y, x[:, None] - grid_x) <= _JOINED * spacing
    place, node = np.nonzero(near)
    along = np.arange(len(y) - 1)
    tail = np.concatenate([along, place, first + len(y)])
    head = np.concatenate([along + 1, node + len(y), second + len(y)])
    node_lat, node_lon = node_y / _DEGREE, wrap_longitude(node_x / (_DEGREE * shrink))
    legs = node_lat[tail], node_lon[tail], node_lat[head], node_lon[head]
    open_legs = ~np.asarray(chart.legs_blocked(*legs))
    open_legs[: len(along)] = True
    tail, head = tail[open_legs], head[open_legs]
    cost = leg_cost(node_lat[tail], node_lon[tail], node_lat[head], node_lon[head])
    from scipy.sparse import csr_array

    count = len(node_y)
    graph = csr_array((np.maximum(cost, 1e-3), (tail, head)), shape=(count, count))
    path = _path(graph, len(y) - 1)
    return node_lat[path], node_lon[path]


def _edges(rows: int, columns: int) -> tuple[IntArray, IntArray]:
    """Return the ends of the edges of a lattice, each once."""
    number = np.arange(rows * columns).reshape(rows, columns)
    first, second = [], []
    for down, right in _STEPS:
        left, end = max(-right, 0), columns - max(right, 0)
        first.append(number[: rows - down, left:end].ravel())
        second.append(number[down:, left + right : end + right].ravel())
    return np.concatenate(first), np.concatenate(second)


def _path(graph: Any, goal: int) -> IntArray:
    """Return the nodes of the cheapest path from the first node to a goal, which is joined."""
    from scipy.sparse.csgraph import dijkstra

    before: IntArray = dijkstra(graph, directed=False, indices=0, return_predecessors=True)[1]
    nodes = [goal]
    while nodes[-1] != 0:
        nodes.append(int(before[nodes[-1]]))
    return np.array(nodes[::-1])
