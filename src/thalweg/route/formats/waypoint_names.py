"""Names of the waypoints in route files."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE

_APPROACH = 15.0 * NAUTICAL_MILE  # along the route: closer waypoints are in the approach


def waypoint_names(
    distance: FloatArray, start: str = "", goal: str = "", approach: BoolArray | None = None
) -> list[str]:
    """Return a name for each waypoint, such as Rotterdam, Rotterdam approach, WP 3.

    Parameters
    ----------
    distance : Distance of the waypoints from the start, along the route [m], (n,).
    start, goal : Names of the places at both ends; positions are no names.
    approach : bool array (n - 1,), optional
        Which legs run along the approaches of ports; without any near an end, the approach ends at
        the last waypoint within 15 nm of it, and a quarter of the way.

    Returns
    -------
    list of str : No two are the same.
    """
    count = len(distance)
    names = [f"WP {number}" for number in range(1, count + 1)]
    legs = np.zeros(max(count - 1, 0), bool) if approach is None else np.asarray(approach)
    for name, away, order, along in (
        (start, distance - distance[0], range(count), legs),
        (goal, distance[-1] - distance, range(count - 1, -1, -1), legs[::-1]),
    ):
        place = _short(name)
        if not place:
            continue
        names[order[0]] = place
        near = [k for k in order[1:-1] if away[k] <= min(_APPROACH, 0.25 * np.ptp(distance))]
        in_approach = int(np.argmin(np.append(along, False)))  # legs before the first at sea
        if 0 < in_approach < count - 1:
            names[order[in_approach]] = f"{place} approach"
        elif near:
            names[near[-1]] = f"{place} approach"
    if count > 1 and names[0] == names[-1]:
        names[-1] = f"{names[-1]} (end)"
    return names


def _short(name: str) -> str:
    """Return the name of a place without country and brackets; nothing for a position."""
    place = name.partition("(")[0].partition(",")[0].strip()
    return "" if place[:1].isdigit() else place
