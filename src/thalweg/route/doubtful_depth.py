"""Water on a route that the global depth layer shows too shallow, or that is a named shoal area."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.geodesy import densify, distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.canal_legs import ApproachLeg, CanalPart, canal_legs
from thalweg.route.passages_used import passages_used
from thalweg.route.route import Route
from thalweg.ship import Ship

_STEP: Final = 0.25 * NAUTICAL_MILE
_STEP_OF_PASSAGES: Final = 2.0 * NAUTICAL_MILE
_NOT_JUDGED: Final = 1.0 * NAUTICAL_MILE  # from land, the spacing of the data of the layer
_NARROW: Final = 3.0 * NAUTICAL_MILE  # half width of passages that the layer does not show
_ENDS: Final = 12.0 * NAUTICAL_MILE  # from ends and canals, where channels are dredged


def water_to_check(
    chart: Chart, route: Route, ship: Ship, clearance: float
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return positions along a route [deg], and where its depth is to be checked.

    Parameters
    ----------
    chart : Chart of the route.
    route : The evaluated route.
    ship : With its draught.
    clearance : Required under the keel [m].

    Returns
    -------
    lat, lon : [deg].
    check : bool array; nowhere on charts that are not of the world and without a draught.
    """
    lat, lon, _ = positions_with_legs(route)
    draught = float(ship.draught)
    if not chart.passages or not draught > 0.0:
        return lat, lon, np.zeros(len(lat), bool)
    too_little = np.asarray(coarse_depth(lat, lon)) < draught + clearance
    check = is_too_shallow(chart, route, ship, too_little)
    for area in SHOAL_AREAS:
        check |= area.contains(lat, lon)
    return lat, lon, check


def positions_with_legs(route: Route) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return positions along a route [deg], each with its leg."""
    lat, lon, leg = densify(route.track.lat, route.track.lon, _STEP)
    return lat, lon, np.append(leg, leg[-1:])


def is_too_shallow(chart: Chart, route: Route, ship: Ship, too_little: BoolArray) -> BoolArray:
    """Return where the depth layer has too little (bool, by position) and says something."""
    lat, lon, leg = positions_with_legs(route)
    canal_or_approach = canal_legs(route.track, chart, ship)
    judged = _judged(chart, route, lat, lon) & (canal_or_approach.number[leg] < 0)
    for k in _ends_at_sea(canal_or_approach.approach):  # as plans, which join approaches last
        end = float(route.track.lat[k]), float(route.track.lon[k])
        judged &= np.asarray(distance(lat, lon, *end)) >= _ENDS
    used = np.unique(canal_or_approach.number[canal_or_approach.number >= 0]).tolist()
    in_canals = [canal_or_approach.canals[k] for k in used]
    for canal in in_canals:
        if not isinstance(canal, ApproachLeg) or isinstance(canal, CanalPart):
            for end in canal.ends:
                judged &= np.asarray(distance(lat, lon, *end)) >= _ENDS
    return np.asarray(too_little & judged)


def _ends_at_sea(approach: BoolArray) -> tuple[int, int]:
    """Return the first and last waypoint at sea of a track, by its legs along approaches."""
    at_sea = np.flatnonzero(~approach)
    return (int(at_sea[0]), int(at_sea[-1]) + 1) if len(at_sea) else (0, -1)


def _judged(chart: Chart, route: Route, lat: FloatArray, lon: FloatArray) -> np.ndarray:
    """Return where the layer says something: off land and narrow passages."""
    shore = np.asarray(chart.coastline.shore_distance(lat, lon, cap=2.0 * _NOT_JUDGED))
    judged = shore >= _NOT_JUDGED
    for passage in passages_used(chart, route):
        if passage.half_width < _NARROW:
            y, x, _ = densify(*passage.positions, _STEP_OF_PASSAGES)
            close = np.flatnonzero(judged & (np.abs(lat - y.mean()) < np.ptp(y) + 0.2))
            for k in close:
                judged[k] = distance(lat[k], lon[k], y, x).min() >= 2.0 * _NARROW
    return judged
