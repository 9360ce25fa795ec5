"""The waypoints of a route file: few, and joined by lines that keep to the route.

The legs of a route are geodesics (great circles), while plotters join waypoints by rhumb lines. A
leg is therefore broken until its rhumb lines stay within a cross-track limit; waypoints that lie on
the line of their neighbours are left out. Files with great circles have the kept waypoints alone.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.canals import path_of_canal
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.geodesy import densify, direct, distance
from thalweg.core.rhumb_lines import densify_for_rhumb, rhumb_cross_track, rhumb_pieces
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.formats.parsed_track import RHUMB_DEVIATION
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.formats.route_thinning import (
    RouteLine,
    geodesic_cross_track,
    greatest_left_out,
    kept_waypoints,
)
from thalweg.route.route import Route

_CLEARING_SHARES = (0.2, 0.04, 0.01)  # of the limit, tried in turn beside land
_RHUMB_TEST = 5.0  # geodesics this close stand for a rhumb line in tests against land [m]
_MOVES = (5.0, 15.0, 40.0, 80.0)  # of waypoints on the shore [m]
_OFFING_KEPT = 0.97  # share of the offing that files keep: routes follow its edge, corner by corner
_LEAST_ROOM = 0.001  # share of the limit that is left to rhumb lines beside what thinning took
_WIDEST = 200.0  # times the limit, for a given number of waypoints


@dataclass(frozen=True, eq=False)
class FileVertices:
    """Waypoints of a route file.

    Attributes
    ----------
    lat, lon : Positions [deg], as written, (n,).
    leg : Leg of the route that goes on from the waypoint (the last leg at the last waypoint), (n,).
    at : Distance from the start of the route [m], as the referee sailed it, (n,).
    cross_track : Greatest distance of the route from the lines between the waypoints [m].
    """

    lat: FloatArray
    lon: FloatArray
    leg: NDArray[np.int64]
    at: FloatArray
    cross_track: float


def file_vertices(route: Route, options: RouteFileOptions) -> FileVertices:
    """Return the waypoints of a file for a route.

    Raises
    ------
    InputError : If the route needs more waypoints than are allowed.
    """
    most, limit = options.max_waypoints, options.limit
    # spaced waypoints lie on geodesics, and great circles do not follow rhumb lines
    keep_rhumb = most is None and not options.great_circles and math.isinf(options.spacing)
    line = RouteLine.of(route, keep_named=most is None, keep_rhumb=keep_rhumb)
    options = _with_room(options)
    found = _vertices(line, options, limit)
    if most is None or len(found.lat) <= most:
        return found
    least = _vertices(line, options, low := limit * _WIDEST)
    if len(least.lat) > most:
        raise InputError(
            f"A route of at most {most} waypoints was requested.",
            f"It needs {len(least.lat)}: its turns, waits and changes of speed, with lines "
            f"within {low / NAUTICAL_MILE:.0f} nm of it and clear of land.",
            "Allow more waypoints.",
            waypoints=len(least.lat),
        )
    narrow, wide = limit, low
    for _ in range(20):
        middle = math.sqrt(narrow * wide)
        tried = _vertices(line, options, middle)
        if len(tried.lat) <= most:
            wide, least = middle, tried
        else:
            narrow = middle
    return least


def _with_room(options: RouteFileOptions) -> RouteFileOptions:
    """Return the options with a chart whose offing is a little smaller."""
    chart = options.chart
    if chart is None or chart.offing.distance <= 0.0:
        return options
    offing = replace(chart.offing, distance=_OFFING_KEPT * chart.offing.distance)
    return replace(options, chart=replace(chart, offing=offing))


def _vertices(line: RouteLine, options: RouteFileOptions, limit: float) -> FileVertices:
    kept = kept_waypoints(line, options.chart, options.thinning * limit)
    lat, lon, piece = _broken_legs(line, options, kept, limit)
    number = np.arange(len(piece)) - np.searchsorted(piece, piece)
    share = number / np.bincount(piece)[piece]
    start, end = line.start[kept[:-1]], line.start[kept[1:]]
    at = np.append(start[piece] + share * (end - start)[piece], line.start[-1])
    lat, lon = np.round(lat, options.decimals), np.round(lon, options.decimals)
    lon = np.where(lon >= 180.0, lon - 360.0, lon)
    leg = np.searchsorted(line.start, at + 1e-6, side="right") - 1
    leg = np.minimum(leg, len(line.lat) - 2).astype(np.int64)
    lat, lon, leg, at = _with_canal_lines(line, lat, lon, leg, at)
    approach = line.approach[leg]
    approach[1:] |= approach[:-1]
    lat, lon = _off_land(options, lat, lon, approach)
    return FileVertices(lat, lon, leg, at, _cross_track(line, options, lat, lon, at))


def _with_canal_lines(
    line: RouteLine, lat: FloatArray, lon: FloatArray, leg: IntArray, at: FloatArray
) -> tuple[FloatArray, FloatArray, IntArray, FloatArray]:
    """Return the waypoints with the bends of canals: straight to its other end one is on land."""
    places = np.stack([lat, lon, leg, at], axis=1)
    rows: list[FloatArray] = []
    for k in range(len(places) - 1):
        rows.append(places[k : k + 1])
        path = path_of_canal(places[k, :2], places[k + 1, :2]) if line.canal[leg[k]] else ()
        if len(path) > 2:
            bends = np.array(path, float)
            sailed = cumulative_sums(distance(*bends[:-1].T, *bends[1:].T))
            along = at[k] + sailed * (at[k + 1] - at[k]) / sailed[-1]
            inner = np.stack([*bends.T, np.full(len(bends), leg[k]), along], axis=1)
            rows.append(inner[1:-1])
    whole = np.concatenate([*rows, places[-1:]])
    return whole[:, 0], whole[:, 1], whole[:, 2].astype(np.int64), whole[:, 3]


def _broken_legs(
    line: RouteLine, options: RouteFileOptions, kept: IntArray, limit: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the legs between the waypoints kept, broken where a line is too far from the route.

    Returns
    -------
    lat, lon : Positions [deg], (m,).
    leg : For each position but the last, the number of the waypoint kept before it.
    """
    lat, lon, canal = line.lat[kept], line.lon[kept], line.canal[kept[:-1]]
    spacing = np.where(canal, math.inf, options.spacing)
    if options.great_circles:
        return densify(lat, lon, spacing)
    room = np.maximum(limit - greatest_left_out(line, kept), _LEAST_ROOM * limit)
    whole = canal | line.rhumb[kept[:-1]]
    room[whole] = math.inf
    given, share = whole | line.approach[kept[:-1]], np.ones(len(room))
    for smaller in _CLEARING_SHARES:
        lat1, lon1, leg = densify_for_rhumb(lat, lon, share * room, spacing)
        near = np.zeros(len(room), bool)
        near[leg[_touching_land(options, lat1, lon1, _RHUMB_TEST)]] = True
        near &= ~given
        if not near.any():
            return lat1, lon1, leg
        share[near] = smaller
    return densify_for_rhumb(lat, lon, share * room, spacing)


def _off_land(
    options: RouteFileOptions, lat: FloatArray, lon: FloatArray, approach: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return the waypoints, those on the very shore moved by some metres until both legs clear it.

    Waypoints of approaches stay: their lines are given.

    Routes may touch the charted shore, where rounding and rhumb lines would put them on land.
    """
    touching = _touching_land(options, lat, lon, RHUMB_DEVIATION)
    lat, lon = lat.copy(), lon.copy()
    bearings = np.radians(np.arange(0.0, 360.0, 30.0))
    for index in np.flatnonzero((touching[1:] | touching[:-1]) & ~approach[1:-1]) + 1:
        near = slice(index - 1, index + 2)
        if not _touching_land(options, lat[near], lon[near], RHUMB_DEVIATION).any():
            continue
        here = lat[index], lon[index]
        for metres, bearing in itertools.product(_MOVES, bearings):
            moved = direct(*here, bearing, metres)
            lat[index], lon[index] = (np.round(float(x), options.decimals) for x in moved)
            if not _touching_land(options, lat[near], lon[near], RHUMB_DEVIATION).any():
                break
        else:
            lat[index], lon[index] = here
    return lat, lon


def _touching_land(
    options: RouteFileOptions, lat: FloatArray, lon: FloatArray, deviation: float
) -> BoolArray:
    """Return which legs of a file touch land; none without a chart.

    Parameters
    ----------
    deviation : How close geodesics stand for rhumb lines [m].
    """
    found = np.zeros(len(lat) - 1, bool)
    if options.chart is not None:
        leg = np.arange(len(found))
        if not options.great_circles:
            lat, lon, leg = rhumb_pieces(lat, lon, deviation)
        found[leg[options.chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:])]] = True
    return found


def _cross_track(
    line: RouteLine, options: RouteFileOptions, lat: FloatArray, lon: FloatArray, at: FloatArray
) -> float:
    """Return the greatest distance of the sampled route from the lines of the file [m]."""
    distance, leg = line.samples["distance"], line.samples["leg"].astype(np.int64)
    outside = ~line.canal[leg] & (distance >= at[0]) & (distance <= at[-1])
    along, y, x = (line.samples[name][outside] for name in ("distance", "lat", "lon"))
    before, after = (np.searchsorted(at, along, side) - 1 for side in ("left", "right"))
    twice = before != after  # a sample at a waypoint belongs to both of its legs
    k = np.clip(np.concatenate([before, after[twice]]), 0, len(lat) - 2)
    y, x = np.concatenate([y, y[twice]]), np.concatenate([x, x[twice]])
    measure = geodesic_cross_track if options.great_circles else rhumb_cross_track
    apart = measure((lat[k], lon[k]), (lat[k + 1], lon[k + 1]), y, x)
    return float(apart.max(initial=0.0))
