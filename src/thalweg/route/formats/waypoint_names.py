"""Names of the waypoints in route files."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE

_APPROACH = 15.0 * NAUTICAL_MILE  # along the route: closer waypoints are in the approach
_LONGEST_APPROACH = 60.0 * NAUTICAL_MILE  # of those that end where the speed changes
_SAME_SPEED = 0.01 * KNOT  # smaller differences of ordered speeds are none [m/s]


def waypoint_names(
    distance: FloatArray, start: str = "", goal: str = "", speed: FloatArray | None = None
) -> list[str]:
    """Return a name for each waypoint, such as Rotterdam, Rotterdam approach, WP 3.

    Parameters
    ----------
    distance : Distance of the waypoints from the start, along the route [m], (n,).
    start, goal : Names of the places at both ends; positions are no names.
    speed : float64 array (n - 1,), optional
        Ordered speed of the legs [m/s]. Where it first changes near an end, the approach ends.

    Returns
    -------
    list of str : No two are the same.
    """
    count = len(distance)
    names = [f"WP {number}" for number in range(1, count + 1)]
    changes = np.zeros(0, int)
    if speed is not None:
        changes = np.flatnonzero(np.abs(np.diff(speed)) > _SAME_SPEED) + 1
    for name, away, order in (
        (start, distance - distance[0], range(count)),
        (goal, distance[-1] - distance, range(count - 1, -1, -1)),
    ):
        place = _short(name)
        if not place:
            continue
        names[order[0]] = place
        turns = [int(k) for k in changes if away[k] <= _LONGEST_APPROACH]
        near = [k for k in order[1:-1] if away[k] <= min(_APPROACH, 0.25 * np.ptp(distance))]
        if turns or near:
            outermost = min(turns, key=lambda k: float(away[k])) if turns else near[-1]
            names[outermost] = f"{place} approach"
    if count > 1 and names[0] == names[-1]:
        names[-1] = f"{names[-1]} (end)"
    return names


def _short(name: str) -> str:
    """Return the name of a place without country and brackets; nothing for a position."""
    place = name.partition("(")[0].partition(",")[0].strip()
    return "" if place[:1].isdigit() else place
