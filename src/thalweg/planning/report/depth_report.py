"""What a plan states about depth where neither chart nor sea provides it: legs to check."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import NAME, coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.geodesy import densify, distance, format_position_minutes
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.land_report import passages_used, time_of_passing
from thalweg.route import Route
from thalweg.route.canal_legs import canal_legs
from thalweg.ship import Ship

_STEP: Final = 1.0 * NAUTICAL_MILE
_NOT_JUDGED: Final = 1.0 * NAUTICAL_MILE  # from land, the spacing of the data of the layer
_NARROW: Final = 3.0 * NAUTICAL_MILE  # half width of passages that the layer does not show
_ENDS: Final = 12.0 * NAUTICAL_MILE  # from ends and canals, where channels are dredged
_MOST_LEGS: Final = 5
CHECK_DEPTH: Final = "Check the depth"  #: a note on legs that may be too shallow begins so
CROSSES_SHOAL: Final = "Crosses"  #: a note on a named shoal area begins so


def depth_notes(chart: Chart, route: Route, ship: Ship, clearance: float) -> list[str]:
    """Return legs that may be too shallow by the depth layer, and named shoals on the route.

    For routes on which neither chart nor sea provides depth, which is checked everywhere else.

    Parameters
    ----------
    chart : Chart of the route.
    route : The evaluated route.
    ship : With its draught.
    clearance : Required under the keel [m].

    Returns
    -------
    list of str : Empty for charts that are not of the world, and for ships without a draught.
    """
    draught = float(ship.draught)
    if not chart.passages or not draught > 0.0:
        return []
    required = draught + clearance
    line = lat, lon, _ = _points_of(route)
    notes = [
        f"{CROSSES_SHOAL} {area.name} (charted as shoal area; {area.source})."
        for area in SHOAL_AREAS
        if area.contains(lat, lon).any()
    ]
    depth = np.asarray(coarse_depth(lat, lon))
    shallow = _is_shallow(chart, route, ship, depth < required)
    if shallow.any():
        notes.append(_shallow_legs(route, depth, np.flatnonzero(shallow), line, required))
    return notes


def water_to_check(
    chart: Chart, route: Route, ship: Ship, clearance: float
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return positions along a route [deg], and where a note of `depth_notes` says to check it.

    Parameters are those of `depth_notes`. None is to be checked where it returns no notes.
    """
    lat, lon, _ = _points_of(route)
    draught = float(ship.draught)
    if not chart.passages or not draught > 0.0:
        return lat, lon, np.zeros(len(lat), bool)
    too_little = np.asarray(coarse_depth(lat, lon)) < draught + clearance
    check = _is_shallow(chart, route, ship, too_little)
    for area in SHOAL_AREAS:
        check |= area.contains(lat, lon)
    return lat, lon, check


def _points_of(route: Route) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return positions along a route [deg], each with its leg."""
    lat, lon, leg = densify(route.track.lat, route.track.lon, _STEP)
    return lat, lon, np.append(leg, leg[-1:])


def _is_shallow(chart: Chart, route: Route, ship: Ship, too_little: BoolArray) -> BoolArray:
    """Return where the depth layer has too little and says something."""
    lat, lon, leg = _points_of(route)
    canal_or_approach = canal_legs(route.track, chart, ship)
    judged = _judged(chart, route, lat, lon) & (canal_or_approach.number[leg] < 0)
    in_canals = canal_or_approach.number[
        (canal_or_approach.number >= 0) & ~canal_or_approach.approach
    ]
    for k in np.unique(in_canals).tolist():
        for end in canal_or_approach.canals[k].ends:
            judged &= np.asarray(distance(lat, lon, *end)) >= _ENDS
    return np.asarray(too_little & judged)


def _judged(chart: Chart, route: Route, lat: FloatArray, lon: FloatArray) -> np.ndarray:
    """Return where the layer says something: off land, the ends and narrow passages."""
    shore = np.asarray(chart.coastline.shore_distance(lat, lon, cap=2.0 * _NOT_JUDGED))
    judged = shore >= _NOT_JUDGED
    for end in (0, -1):
        judged &= distance(lat, lon, lat[end], lon[end]) >= _ENDS
    for passage in passages_used(chart, route):
        if passage.half_width < _NARROW:
            y, x, _ = densify(*passage.positions, 2.0 * _STEP)
            close = np.flatnonzero(judged & (np.abs(lat - y.mean()) < np.ptp(y) + 0.2))
            for k in close:
                judged[k] = distance(lat[k], lon[k], y, x).min() >= 2.0 * _NARROW
    return judged


def _shallow_legs(
    route: Route,
    depth: FloatArray,
    shallow: np.ndarray,
    line: tuple[FloatArray, FloatArray, np.ndarray],
    required: float,
) -> str:
    """Return the warning about legs with less depth than the ship requires."""
    lat, lon, leg = line
    found = []
    for number in np.unique(leg[shallow]):
        points = shallow[leg[shallow] == number]
        worst = points[np.argmin(depth[points])]
        place = format_position_minutes(float(lat[worst]), float(lon[worst]))
        time = time_of_passing(route, int(number), float(lat[worst]), float(lon[worst]))
        found.append((float(depth[worst]), f"{depth[worst]:.0f} m near {place}{time}"))
    named = [text for _, text in sorted(found)[:_MOST_LEGS]]
    more = f", and {len(found) - _MOST_LEGS} more legs" if len(found) > _MOST_LEGS else ""
    return (
        f"{CHECK_DEPTH}: {required:.1f} m are required, and the {NAME} has {'; '.join(named)}"
        f"{more}. It does not show small shoals and channels, and was not read in the approaches "
        "of ports, within 12 nm of the ends and of canals, 1 nm of land and in narrow passages."
    )
