"""The waypoints of a route file: few, and joined by rhumb lines that keep to the route.

The legs of a route are geodesics (great circles), while plotters join waypoints by rhumb lines. A
leg is therefore broken until its rhumb lines stay within a cross-track limit; waypoints that lie on
the line of their neighbours are left out.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import MEAN_RADIUS, direct, distance, inverse
from thalweg.core.rhumb_lines import densify_for_rhumb, rhumb_cross_track, rhumb_pieces
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route.formats.parsed_track import RHUMB_DEVIATION
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.route import Route

_SAME_SPEED = 0.01 * KNOT  # differences of ordered speeds below this are none [m/s]
_SAME_PLACE = 20.0  # waypoints closer than this are one [m]
_CLEARING_SHARES = (1.0, 0.2, 0.04, 0.01)  # of the limit, tried in turn beside land
_RHUMB_TEST = 5.0  # geodesics this close stand for a rhumb line in tests against land [m]
_MOVES = (5.0, 15.0, 40.0, 80.0)  # of waypoints on the shore [m]
_SHORT_LEG = 0.5 * NAUTICAL_MILE  # shorter legs are joined where the cross-track limit allows it
_OFFING_KEPT = 0.97  # share of the offing that files keep: routes follow its edge, corner by corner
_WIDEST = 200.0  # times the limit, for a given number of waypoints


@dataclass(frozen=True, eq=False)
class FileVertices:
    """Waypoints of a route file.

    Attributes
    ----------
    lat, lon : Positions [deg], as written, (n,).
    leg : Leg of the route that goes on from the waypoint (the last leg at the last waypoint), (n,).
    at : Distance from the start of the route [m], as the referee sailed it, (n,).
    cross_track : Greatest distance of the route from the rhumb lines between the waypoints [m].
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
    options = _with_room(options)
    found = _vertices(route, options, limit)
    if most is None or len(found.lat) <= most:
        return found
    least = _vertices(route, options, low := limit * _WIDEST)
    if len(least.lat) > most:
        raise InputError(
            f"A route of at most {most} waypoints was requested.",
            f"It needs {len(least.lat)}: its turns, waits and changes of speed, with rhumb lines "
            f"within {low / NAUTICAL_MILE:.0f} nm of it and clear of land.",
            "Allow more waypoints.",
            waypoints=len(least.lat),
        )
    narrow, wide = limit, low
    for _ in range(20):
        middle = math.sqrt(narrow * wide)
        tried = _vertices(route, options, middle)
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


def _vertices(route: Route, options: RouteFileOptions, limit: float) -> FileVertices:
    thinning = options.thinning * limit
    kept = _thinned(route, options, thinning)
    lats, lons, places = [], [], []
    start = np.concatenate([[0.0], np.cumsum(route.legs["length"])])
    for first, last in itertools.pairwise(kept):
        left_out = float(_cross_tracks(route, first, last).max(initial=0.0))
        lat, lon = _broken_leg(route, options, first, last, limit - left_out)
        lats.append(lat[:-1])
        lons.append(lon[:-1])
        places.append(np.linspace(start[first], start[last], len(lat))[:-1])
    track = route.track
    lat = np.round(np.concatenate([*lats, track.lat[-1:]]), options.decimals)
    lon = np.round(np.concatenate([*lons, track.lon[-1:]]), options.decimals)
    lon = np.where(lon >= 180.0, lon - 360.0, lon)
    at = np.concatenate([*places, start[-1:]])
    leg = np.searchsorted(start, at + 1e-6, side="right") - 1
    leg = np.minimum(leg, len(track) - 2).astype(np.int64)
    approach = _approach_legs(route)[leg]
    approach[1:] |= approach[:-1]
    lat, lon = _off_land(options, lat, lon, approach)
    return FileVertices(lat, lon, leg, at, _cross_track(route, lat, lon, at))


def _thinned(route: Route, options: RouteFileOptions, tolerance: float) -> list[int]:
    """Return the waypoints of the track that are kept: turns, waits, changes of speed, canals."""
    held = _held(route)
    kept = [0]
    for first, last in itertools.pairwise(held):
        kept += _between(route, options, first, last, tolerance)
        kept.append(last)
    kept = _without_repeats(route, kept)
    return _without_short_legs(route, options, kept, set(held), tolerance)


def _without_short_legs(
    route: Route,
    options: RouteFileOptions,
    kept: list[int],
    held: set[int],
    tolerance: float,
) -> list[int]:
    """Return the waypoints without those beside short legs that may go, the nearest first."""
    lat, lon = route.track.lat, route.track.lon
    waypoints, stays = list(kept), set(held)
    while True:
        lengths = distance(
            lat[waypoints[:-1]], lon[waypoints[:-1]], lat[waypoints[1:]], lon[waypoints[1:]]
        )
        inner = [k for k in range(1, len(waypoints) - 1) if waypoints[k] not in stays]
        shortest = {k: float(min(lengths[k - 1], lengths[k])) for k in inner}
        k = min(shortest, key=shortest.__getitem__, default=0)
        if k == 0 or shortest[k] >= _SHORT_LEG:
            return waypoints
        before, after = waypoints[k - 1], waypoints[k + 1]
        if _may_join(route, options, before, after, tolerance):
            del waypoints[k]
        else:
            stays.add(waypoints[k])


def _may_join(
    route: Route, options: RouteFileOptions, first: int, last: int, tolerance: float
) -> bool:
    """Return whether one leg may stand for those between two waypoints."""
    lat, lon = route.track.lat, route.track.lon
    ends = lat[first], lon[first], lat[last], lon[last]
    if options.chart is not None and options.chart.legs_blocked(*ends):
        return False
    return float(_cross_tracks(route, first, last).max()) <= tolerance


def _held(route: Route) -> list[int]:
    """Return the waypoints that are never left out."""
    track, speed = route.track, route.legs["ordered_speed"]
    held = track.wait > 0.0
    held[[0, -1]] = True
    held[1:-1] |= np.abs(np.diff(speed)) > _SAME_SPEED
    canal = _canal_legs(route)
    held[:-1] |= canal
    held[1:] |= canal
    return [int(index) for index in np.flatnonzero(held)]


def _canal_legs(route: Route) -> NDArray[np.bool_]:
    """Return which legs follow the line of a canal: those longer than their geodesic."""
    return np.asarray(route.legs["length"] > 1.0001 * route.track.lengths + 1.0)


def _approach_legs(route: Route) -> NDArray[np.bool_]:
    """Return which legs are part of the approach of a port, which may cross charted land."""
    kind = np.asarray(route.legs.get("leg_kind", 0))
    return np.broadcast_to(kind != 0, (len(route.track) - 1,)).copy()


def _without_repeats(route: Route, kept: list[int]) -> list[int]:
    """Return the waypoints without those that are too close to the one before, if they may go."""
    track, canal = route.track, _canal_legs(route)
    waypoints = [kept[0]]
    for index in kept[1:]:
        before = waypoints[-1]
        place = track.lat[before], track.lon[before], track.lat[index], track.lon[index]
        if float(distance(*place)) < _SAME_PLACE and not canal[before:index].any():
            if index == kept[-1] and before != kept[0] and track.wait[before] == 0.0:
                waypoints[-1] = index
                continue
            if index != kept[-1] and track.wait[index] == 0.0 and not canal[index]:
                continue
        waypoints.append(index)
    return waypoints


def _between(
    route: Route, options: RouteFileOptions, first: int, last: int, tolerance: float
) -> list[int]:
    """Return the waypoints to keep between two others (Douglas and Peucker 1973)."""
    if last - first < 2:
        return []
    cross_track = _cross_tracks(route, first, last)
    worst = first + 1 + int(np.argmax(cross_track))
    if _may_join(route, options, first, last, tolerance):
        return []
    before = _between(route, options, first, worst, tolerance)
    return [*before, worst, *_between(route, options, worst, last, tolerance)]


def _cross_tracks(route: Route, first: int, last: int) -> FloatArray:
    """Return the distances [m] of the waypoints between two others from the line of these."""
    lat, lon = route.track.lat, route.track.lon
    inner = slice(first + 1, last)
    away, bearing, _ = inverse(lat[first], lon[first], lat[inner], lon[inner])
    length, course, _ = inverse(lat[first], lon[first], lat[last], lon[last])
    arc = away / MEAN_RADIUS
    cross_track = np.abs(np.arcsin(np.sin(arc) * np.sin(bearing - course))) * MEAN_RADIUS
    along = away * np.cos(bearing - course)
    beyond = (along < 0.0) | (along > length)
    return np.asarray(
        np.where(beyond, np.minimum(away, np.abs(away - length)) + cross_track, cross_track)
    )


def _broken_leg(
    route: Route, options: RouteFileOptions, first: int, last: int, limit: float
) -> tuple[FloatArray, FloatArray]:
    """Return a leg between two waypoints, broken where its rhumb line is too far from it."""
    lat, lon = route.track.lat[[first, last]], route.track.lon[[first, last]]
    if _canal_legs(route)[first]:
        return lat, lon
    if _approach_legs(route)[first]:
        lat, lon, _ = densify_for_rhumb(lat, lon, limit, options.spacing)
        return lat, lon
    for share in _CLEARING_SHARES:
        found = densify_for_rhumb(lat, lon, share * limit, options.spacing)[:2]
        if options.chart is None or not _touches_land(options, *found):
            break
    return found


def _off_land(
    options: RouteFileOptions, lat: FloatArray, lon: FloatArray, approach: NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Return the waypoints, those on the very shore moved by some metres until both legs clear it.

    Waypoints of approaches stay: their lines are given.

    Routes may touch the charted shore, where rounding and rhumb lines would put them on land.
    """
    if options.chart is None:
        return lat, lon
    lat, lon = lat.copy(), lon.copy()
    bearings = np.radians(np.arange(0.0, 360.0, 30.0))
    for index in range(1, len(lat) - 1):
        near = slice(index - 1, index + 2)
        if approach[index] or not _touches_land(options, lat[near], lon[near], RHUMB_DEVIATION):
            continue
        here = lat[index], lon[index]
        for metres, bearing in itertools.product(_MOVES, bearings):
            moved = direct(*here, bearing, metres)
            lat[index], lon[index] = (np.round(float(x), options.decimals) for x in moved)
            if not _touches_land(options, lat[near], lon[near], RHUMB_DEVIATION):
                break
        else:
            lat[index], lon[index] = here
    return lat, lon


def _touches_land(
    options: RouteFileOptions, lat: FloatArray, lon: FloatArray, deviation: float = _RHUMB_TEST
) -> bool:
    assert options.chart is not None
    lat, lon, _ = rhumb_pieces(lat, lon, deviation)
    return bool(options.chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]).any())


def _cross_track(route: Route, lat: FloatArray, lon: FloatArray, at: FloatArray) -> float:
    """Return the greatest distance of the sampled route from the rhumb lines [m]."""
    samples, canal = route.samples, _canal_legs(route)
    leg = samples["leg"].astype(np.int64)
    worst = 0.0
    for index in range(len(lat) - 1):
        here = (samples["distance"] >= at[index]) & (samples["distance"] <= at[index + 1])
        here &= ~canal[leg]
        if here.any():
            ends = (lat[index], lon[index]), (lat[index + 1], lon[index + 1])
            cross_track = rhumb_cross_track(*ends, samples["lat"][here], samples["lon"][here])
            worst = max(worst, float(cross_track.max()))
    return worst
