"""What a plan states about depth where neither chart nor sea provides it: legs to check."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import NAME, coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.geodesy import distance, format_position_minutes
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.land_report import time_of_passing
from thalweg.route import Route
from thalweg.route.doubtful_depth import is_too_shallow, positions_with_legs
from thalweg.route.route_tables import LEG_KINDS
from thalweg.ship import Ship

_MOST_PLACES: Final = 5
_SAME_PLACE: Final = 5.0 * NAUTICAL_MILE  # shallower water so near is the same place
CHECK_DEPTH: Final = "Check the depth"  #: a note on legs that may be too shallow begins so
CROSSES_SHOAL: Final = "Crosses"  #: a note on a named shoal area begins so


def depth_notes(chart: Chart, route: Route, ship: Ship, clearance: float) -> list[str]:
    """Return legs that may be too shallow by the depth layer, and named shoals on the route.

    For routes on which neither chart nor sea provides depth, which is checked everywhere else.

    Parameters are those of `water_to_check`.

    Returns
    -------
    list of str : Empty for charts that are not of the world, and for ships without a draught.
    """
    draught = float(ship.draught)
    if not chart.passages or not draught > 0.0:
        return []
    required = draught + clearance
    line = lat, lon, _ = positions_with_legs(route)
    notes = [
        f"{CROSSES_SHOAL} {area.name} (charted as shoal area; {area.source})."
        for area in SHOAL_AREAS
        if area.contains(lat, lon).any()
    ]
    depth = np.asarray(coarse_depth(lat, lon))
    shallow = is_too_shallow(chart, route, ship, depth < required)
    everywhere = is_too_shallow(chart, route, ship, np.ones(len(depth), bool))
    if not everywhere.any():
        notes += _unread_depths(route, depth, line, required)
    elif shallow.any():
        notes.append(_shallow_places(route, depth, np.flatnonzero(shallow), line, required))
    return notes


def _unread_depths(
    route: Route,
    depth: FloatArray,
    line: tuple[FloatArray, FloatArray, np.ndarray],
    required: float,
) -> list[str]:
    """Return a note on a route of which the depth layer counts nowhere, where it has too little."""
    lat, lon, leg = line
    kind = np.asarray(route.legs.get("leg_kind", np.zeros(len(route.legs["length"]))))
    at_sea = np.flatnonzero(kind[leg] == LEG_KINDS.index("sea"))
    if not len(at_sea):
        return []
    known = at_sea[np.isfinite(depth[at_sea])]
    worst = known[np.argmin(depth[known])] if len(known) else None
    if worst is None or not depth[worst] < required:
        return []
    place = format_position_minutes(float(lat[worst]), float(lon[worst]))
    return [
        f"{CHECK_DEPTH}: the whole way is near its ends, land, canals or in narrow passages, where "
        f"the {NAME} is too coarse and does not count. It has {depth[worst]:.0f} m near {place}, "
        f"and {required:.1f} m are required: see the chart."
    ]


def _shallow_places(
    route: Route,
    depth: FloatArray,
    shallow: np.ndarray,
    line: tuple[FloatArray, FloatArray, np.ndarray],
    required: float,
) -> str:
    """Return the warning about places with less depth than the ship requires, the worst first."""
    lat, lon, leg = line
    left = shallow[np.argsort(depth[shallow], kind="stable")]
    found = []
    while len(left):
        worst = left[0]
        where = float(lat[worst]), float(lon[worst])
        time = time_of_passing(route, int(leg[worst]), *where)
        found.append(f"{depth[worst]:.0f} m near {format_position_minutes(*where)}{time}")
        left = left[np.asarray(distance(lat[left], lon[left], *where)) > _SAME_PLACE]
    named = found[:_MOST_PLACES]
    more = f", and {len(found) - len(named)} more places" if len(found) > len(named) else ""
    return (
        f"{CHECK_DEPTH}: {required:.1f} m are required, and the {NAME} has {'; '.join(named)}"
        f"{more}. It does not show small shoals and channels, and was not read in the approaches "
        "of ports, within 12 nm of the ends and of canals, 1 nm of land and in narrow passages."
    )
