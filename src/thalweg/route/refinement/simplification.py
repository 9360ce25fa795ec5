"""Simplification of routes: waypoints that make almost no difference are removed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.line_thinning import distances_from_arcs, mark_needed_points
from thalweg.core.geodesy import MEAN_RADIUS, unit_vectors
from thalweg.route.route import Route
from thalweg.route.track import Track

_NOT_SIMPLIFIED_UP_TO = 16  # waypoints; shorter routes are not changed
#: Largest lateral offset of the route, as shares of its length, narrowest first.
_OFFSET_TOLERANCES = (2e-6, 1e-5, 4e-5, 2e-4, 1e-3)
_MAX_COST_INCREASE = 1e-6  # relative increase of the cost of the simplified route


def simplified_route(
    route: Route,
    score: Callable[[Track], Route],
    cost: Callable[[Route], float],
    *,
    most: float,
    held: NDArray[np.bool_] | None = None,
) -> Route:
    """Return the route with fewer waypoints, as far as its cost hardly changes.

    Parameters
    ----------
    route : As evaluated by the referee.
    score : The referee: a track to its route.
    cost : The objective of a route, which is minimised.
    most : Largest cost of the simplified route.
    held : Waypoints that are not removed, such as ends of canals.

    Returns
    -------
    Route : The given one, or one through some of its waypoints that violates no limit and costs at
        most 1e-6 more. Waypoints where the ship waits or changes its setting are not removed.
    """
    track = route.track
    if len(track.lat) <= _NOT_SIMPLIFIED_UP_TO or not route.feasible:
        return route
    allowed = min(most, cost(route) * (1.0 + _MAX_COST_INCREASE))
    length = float(route.legs["length"].sum())
    best = route
    for share in _OFFSET_TOLERANCES:
        keep = _needed_waypoints(track, share * length, held)
        if keep.sum() == len(best.track.lat):
            continue
        fewer = score(_track_through(track, keep))
        if not (fewer.feasible and cost(fewer) <= allowed):
            break
        best = fewer
    return best


def _track_through(track: Track, keep: NDArray[np.bool_]) -> Track:
    return Track(
        track.lat[keep], track.lon[keep], track.depart, track.wait[keep], track.setting[keep[:-1]]
    )


def _needed_waypoints(
    track: Track, largest_offset: float, held: NDArray[np.bool_] | None
) -> NDArray[np.bool_]:
    """Return which waypoints to keep for a largest offset ``largest_offset`` [m] of the others."""
    keep = np.zeros(len(track.lat), bool)
    keep[[0, -1]] = True
    keep[np.flatnonzero(track.wait)] = True
    keep[1:-1] |= np.diff(track.setting) != 0
    if held is not None:
        keep |= held
    fixed = np.flatnonzero(keep)
    distances = partial(distances_from_arcs, MEAN_RADIUS * unit_vectors(track.lat, track.lon))
    mark_needed_points(keep, fixed[:-1], fixed[1:], tolerance=largest_offset, distances=distances)
    return keep
