"""The line of a usual route without the corners that it has at junctions.

The line of each arc is that of one voyage. Lines of neighbouring arcs meet in the middle of a
junction, where few ships pass: joined end to end they are longer than the voyages.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from thalweg.core.geodesy import Position, distance
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.history_route import HistoryRoute

_REACH: Final = (1.5, 0.75)  # radii of a junction, before and after it: the first that is open


def line_without_corners(
    network: HistoryNetwork, route: HistoryRoute, legs_blocked: Callable[..., Any]
) -> list[Position]:
    """Return the line of a route, straight past every junction where the water allows it.

    Parameters
    ----------
    network, route : The route is one of the network.
    legs_blocked : Which legs (lat1, lon1, lat2, lon2) [deg] may not be sailed.

    Returns
    -------
    list of (lat, lon) : From the same start to the same goal [deg].
    """
    counts = [len(network.arcs.lines.of(arc)[0]) - 1 for arc in route.arcs]
    return _straightened(route.line, np.cumsum(counts)[:-1].tolist(), network.radius, legs_blocked)


def _straightened(
    line: Sequence[Position],
    joints: Sequence[int],
    radius: float,
    legs_blocked: Callable[..., Any],
) -> list[Position]:
    """Return a line without the positions near its joints, by number."""
    lat, lon = np.array(line, float).T
    along = np.concatenate([[0.0], np.cumsum(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))])
    kept = np.ones(len(lat), bool)
    for joint in joints:
        for reach in _REACH:
            first = int(np.searchsorted(along, along[joint] - reach * radius, side="right")) - 1
            last = int(np.searchsorted(along, along[joint] + reach * radius))
            first, last = max(first, 0), min(last, len(lat) - 1)
            while not kept[first]:
                first -= 1
            legs = lat[[first]], lon[[first]], lat[[last]], lon[[last]]
            if not np.asarray(legs_blocked(*legs))[0]:
                kept[first + 1 : last] = False
                break
    return list(zip(lat[kept].tolist(), lon[kept].tolist()))
