"""Routes led through lanes of traffic separation schemes that a network is too coarse for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.zones.traffic_schemes import INSHORE, TRAFFIC_SCHEMES, TrafficScheme
from thalweg.core.arrays.leg_ends import leg_ends
from thalweg.core.geodesy import Position, distance, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import Network
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route, Track
from thalweg.route.refinement.better_route import comparison_key

_LEAST: Final = 1.0 * NAUTICAL_MILE  # shorter stretches against the traffic are crossings
_MOST_LONGER: Final = 1.1  # times as long as what they replace may the new legs be
_SHARES: Final = (0.5, 0.3, 0.75)  # of the width of the lane, from the separation zone
_EARLIER: Final = (0, 1, 2, 3)  # waypoints before and after the stretch from which she may go by


def by_lanes_of_traffic(context: PlanningContext, network: Network, route: Route) -> Route:
    """Return a route in the lanes of the schemes where that is better, as the referee judges it.

    Parameters
    ----------
    network : Of the route; one of a given shape keeps its nodes.
    route : As evaluated; where it is not feasible it stays.
    """
    if not route.feasible or network.meta.kind == "layered":
        return route
    track = in_lanes_of_traffic(route.track, context.chart)
    if track is route.track:
        return route
    key = partial(comparison_key, objective=context.voyage.objective, chart=context.chart)
    return min((route, context.evaluate(track)), key=key)


def in_lanes_of_traffic(track: Track, chart: Chart) -> Track:
    """Return a track that goes by the middle of the lanes where it ran against the traffic.

    A network with long edges may have none in the lane of a strait. Each scheme of the package is
    treated on its own: the waypoints inside are replaced by those of the lane, where the way is
    open, hardly longer, and shorter with the additions for miles against the traffic.

    Parameters
    ----------
    track : Its settings stay; of the new legs the ship has that of the leg before.
    chart : Its lanes.
    """
    for scheme in TRAFFIC_SCHEMES if chart.zones.lanes else ():
        stretch = _against(chart, track).get(scheme.name)
        if stretch is not None:
            track = _by_lane(track, chart, scheme, *stretch)
    return track


def _against(chart: Chart, track: Track) -> dict[str, tuple[int, int]]:
    """Return the first and the last waypoint of the stretch of a track against each scheme."""
    legs = leg_ends(track.lat, track.lon)
    length, group = np.asarray(distance(*legs)), chart.zones.lane_group
    found: dict[str, list[tuple[int, float]]] = {}
    for leg, lane, share in zip(*group.shares_against(*legs), strict=True):
        name, _, part = group.lanes[lane].name.partition(", ")
        if part != INSHORE:
            found.setdefault(name, []).append((int(leg), float(share * length[leg])))
    return {
        name: (min(legs)[0], max(legs)[0] + 1)
        for name, legs in found.items()
        if sum(metres for _, metres in legs) >= _LEAST
    }


def _by_lane(track: Track, chart: Chart, scheme: TrafficScheme, first: int, last: int) -> Track:
    """Return the track by the lane of a scheme between two waypoints, or the given one."""
    best, most = track, 1.0  # metre
    for before, after in product(_EARLIER, _EARLIER):
        begin, end = first - before, last + after
        if begin < 0 or end >= len(track) or not _may_replace(track, chart, begin, end):
            continue
        own = slice(begin, end + 1)
        cost, length = (
            measure(chart, track.lat[own], track.lon[own]) for measure in (_penalised, _length)
        )
        ends = [(float(track.lat[i]), float(track.lon[i])) for i in (begin, end)]
        for places in _lane_between(scheme, *ends):
            lat, lon = np.array([ends[0], *places, ends[1]]).T
            if np.any(chart.legs_blocked(*leg_ends(lat, lon))):
                continue
            if _length(chart, lat, lon) > _MOST_LONGER * length + _LEAST:
                continue
            gain = cost - _penalised(chart, lat, lon)
            if gain > most:
                best, most = _with_places(track, begin, end, places), gain
    return best


def _lane_between(
    scheme: TrafficScheme, start: Position, goal: Position
) -> Iterator[list[Position]]:
    """Yield waypoints in the middle of the lane of a ship from one place to another [deg]."""
    from_line = [_along(scheme, place) for place in (start, goal)]
    forwards = from_line[1] >= from_line[0]
    for share in _SHARES:
        side = scheme.zone + share * scheme.lane
        middle = scheme.shifted(side if forwards else -side)[:, ::-1]
        middle = middle if forwards else middle[::-1]
        count = len(middle)
        for begin in range(count - 1):
            for end in range(count, begin + 1, -1):
                yield [(float(lat), float(lon)) for lat, lon in middle[begin:end]]


def _along(scheme: TrafficScheme, place: Position) -> float:
    """Return how far along the chord of a separation line a place is, in degrees."""
    (lat1, lon1), (lat2, lon2) = scheme.line[0], scheme.line[-1]
    stretch = np.cos(np.radians(lat1))
    chord = np.array([lat2 - lat1, float(wrap_longitude(lon2 - lon1)) * stretch])
    off = np.array([place[0] - lat1, float(wrap_longitude(place[1] - lon1)) * stretch])
    return float(off @ chord) / float(np.linalg.norm(chord))


def _may_replace(track: Track, chart: Chart, begin: int, end: int) -> bool:
    """Return whether the waypoints between two may go: no waits and no canals."""
    if np.any(np.asarray(track.wait)[begin + 1 : end]):
        return False
    legs = leg_ends(track.lat[begin : end + 1], track.lon[begin : end + 1])
    return not np.any(np.asarray(chart.canal_of_legs(*legs)) >= 0)


def _with_places(track: Track, begin: int, end: int, places: Sequence[Position]) -> Track:
    """Return the track by other waypoints between two of its own."""
    lat, lon = np.array(places, float).T
    count = len(places)
    joined = [
        np.concatenate([np.asarray(own)[: begin + 1], new, np.asarray(own)[end:]])
        for own, new in ((track.lat, lat), (track.lon, lon), (track.wait, np.zeros(count)))
    ]
    setting = np.asarray(track.setting)
    held = np.full(count + 1, setting[begin])
    setting = np.concatenate([setting[:begin], held, setting[end:]])
    return Track(joined[0], joined[1], track.depart, joined[2], setting)


def _length(chart: Chart, lat: FloatArray, lon: FloatArray) -> float:
    return float(np.sum(np.asarray(distance(*leg_ends(lat, lon)))))


def _penalised(chart: Chart, lat: FloatArray, lon: FloatArray) -> float:
    """Return the length of a track with what miles in zones and against lanes count more [m]."""
    legs = leg_ends(lat, lon)
    penalty = np.asarray(chart.zones.factors(*legs)[0])
    return float(np.sum(np.asarray(distance(*legs)) * penalty))
