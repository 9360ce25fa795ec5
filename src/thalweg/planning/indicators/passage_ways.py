"""The shortest ways of a voyage by the lines of named passages."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import Network
from thalweg.network.shortest_paths import ShortestPathTree

_REACH: Final = 12.0 * NAUTICAL_MILE  # from nodes to the ends of the line of a passage


class PassageWay(NamedTuple):
    """A way by a passage.

    Attributes
    ----------
    length : [m].
    before, after : Latitudes and longitudes [deg] to its narrowest point, and from there.
    """

    length: float
    before: tuple[FloatArray, ...]
    after: tuple[FloatArray, ...]


def way_by_passage(
    chart: Chart,
    network: Network,
    passage: Passage,
    trees: tuple[ShortestPathTree, ShortestPathTree],
) -> PassageWay | None:
    """Return the shortest way by the line of a passage; None where no node is near its ends.

    Parameters
    ----------
    chart : Tests the legs to the ends of the line.
    network : Its nodes lead there.
    trees : Of shortest paths from the start and to the goal.
    """
    lat, lon = passage.positions
    reach = max(_REACH, 2.0 * network.meta.spacing_m)
    near = []  # of each end of the line: nodes with a clear leg to it, and its length
    for at in (0, -1):
        away = np.asarray(distance(network.lat, network.lon, lat[at], lon[at]))
        rows = np.flatnonzero(away <= reach)
        ends = np.full(len(rows), lat[at]), np.full(len(rows), lon[at])
        if len(rows):
            blocked = chart.legs_blocked(network.lat[rows], network.lon[rows], *ends)
            rows = rows[~np.asarray(blocked)]
        if not len(rows):
            return None
        near.append((rows, away[rows]))
    found = []
    for (first, to_line), (last, from_line), step in (
        (near[0], near[1], 1),
        (near[1], near[0], -1),
    ):
        before, after = trees[0].distance[first] + to_line, trees[1].distance[last] + from_line
        a, b = int(np.argmin(before)), int(np.argmin(after))
        length = float(before[a] + passage.length + after[b])
        found.append((length, int(first[a]), int(last[b]), step))
    length, first_node, last_node, step = min(found)
    line = lat[::step], lon[::step]
    shore = chart.coastline.shore_distance(*line, cap=NAUTICAL_MILE)
    middle = 1 + int(np.argmin(shore[1:-1])) if len(lat) > 2 else 1
    paths = trees[0].path(first_node), trees[1].path(last_node)[::-1]
    places = network.lat, network.lon
    return PassageWay(
        length,
        tuple(np.append(x[paths[0]], y[: middle + 1]) for x, y in zip(places, line)),
        tuple(np.append(y[middle:], x[paths[1]]) for x, y in zip(places, line)),
    )
