"""The waypoints of a route that a file needs: turns, waits, changes of speed, ends of canals."""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.line_thinning import InnerPoints, inner_points, mark_needed_points
from thalweg.core.geodesy import MEAN_RADIUS, distance, inverse
from thalweg.core.rhumb_lines import rhumb_cross_track
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route.carried_extensions import visits_of
from thalweg.route.route import Route
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart

_SAME_SPEED = 0.01 * KNOT  # differences of ordered speeds below this are none [m/s]
_SAME_PLACE = 20.0  # waypoints closer than this are one [m]
_ON_RHUMB_LINE = 1.0  # waypoints so near a rhumb line are on it [m]
_SHORT_LEG = 0.5 * NAUTICAL_MILE  # shorter legs are joined where the cross-track limit allows it


@dataclass(frozen=True, eq=False)
class RouteLine:
    """The waypoints and legs of a route, as thinning needs them.

    Attributes
    ----------
    lat, lon : Waypoints [deg], (n,).
    wait : Waits at the waypoints [s], (n,).
    start : Distance of the waypoints from the start, as sailed [m], (n,).
    canal : Which legs follow the line of a canal: those longer than their geodesic, (n - 1,).
    approach : Which legs belong to canals or the approaches of ports, which may cross charted
        land, (n - 1,).
    held : Waypoints that are never left out, (n,).
    carried : Waypoints with extensions of other makers, which no waypoint beside stands for, (n,).
    rhumb : Which legs are parts of a rhumb line of the file, which one leg stands for, (n - 1,).
    """

    lat: FloatArray
    lon: FloatArray
    wait: FloatArray
    start: FloatArray
    canal: BoolArray
    approach: BoolArray
    held: BoolArray
    carried: BoolArray
    rhumb: BoolArray
    samples: Mapping[str, FloatArray]

    @classmethod
    def of(cls, route: Route, *, keep_named: bool, keep_rhumb: bool) -> RouteLine:
        """Return the line of a route.

        Parameters
        ----------
        keep_named : Whether to keep all waypoints with names or cross-track limits of a file.
        keep_rhumb : Whether to keep the ends of rhumb lines of a file, and none between them.
        """
        track, length, speed = route.track, route.legs["length"], route.legs["ordered_speed"]
        canal = np.asarray(length > 1.0001 * track.lengths + 1.0)
        kind = np.asarray(route.legs.get("leg_kind", 0))
        held = track.wait > 0.0
        held[[0, -1]] = True
        held[1:-1] |= np.abs(np.diff(speed)) > _SAME_SPEED
        held[:-1] |= canal
        held[1:] |= canal
        carried = np.zeros(len(held), bool)
        if track.extensions:
            visits, given = visits_of(track.positions), track.extensions
            carried = np.array([at in given.at for at in visits])
            if keep_named:
                held |= np.array([at in given.names or at in given.corridors for at in visits])
        held |= carried
        rhumb = np.zeros(len(canal), bool)
        if keep_rhumb:
            rhumb = _rhumb_parts(track, held)
            ends = np.diff(track.leg_numbers) != 0
            held[1:-1] |= ends & (rhumb[:-1] | rhumb[1:])
        start = cumulative_sums(length)
        approach = np.broadcast_to(kind != 0, canal.shape).copy()
        return cls(
            *(track.lat, track.lon, track.wait, start, canal, approach),
            *(held, carried, rhumb, route.samples),
        )


def _rhumb_parts(track: Track, held: BoolArray) -> BoolArray:
    """Return which legs are parts of one rhumb line of the file, sailed as several geodesics.

    Parameters
    ----------
    held : Waypoints that are never left out, (n,): a leg with one inside has no such parts.
    """
    lat, lon, new = track.lat, track.lon, np.diff(track.leg_numbers) != 0
    line = np.append(0, np.cumsum(new))  # of each leg
    first = np.append(0, np.flatnonzero(new) + 1)
    last = np.append(first[1:], len(lat) - 1)
    inner = np.flatnonzero(~new) + 1
    a, b = first[line[inner]], last[line[inner]]
    apart = rhumb_cross_track((lat[a], lon[a]), (lat[b], lon[b]), lat[inner], lon[inner])
    found = last - first > 1
    found[line[inner[(apart > _ON_RHUMB_LINE) | held[inner]]]] = False
    return np.asarray(found[line])


def kept_waypoints(line: RouteLine, chart: Chart | None, tolerance: float) -> IntArray:
    """Return the waypoints of a route that its file keeps, in order.

    Parameters
    ----------
    chart : Legs that would cross its land are not joined.
    tolerance : Waypoints this close to the line of their neighbours are left out [m]; 0: only those
        that repeat another.
    """
    if tolerance <= 0.0:
        return _without_repeats(line, np.arange(len(line.lat)))
    kept = _without_repeats(line, _turns(line, chart, tolerance))
    return _without_short_legs(line, chart, kept, tolerance)


def greatest_left_out(line: RouteLine, kept: IntArray) -> FloatArray:
    """Return how far the waypoints left out are from each leg between those kept [m], or 0."""
    found = np.zeros(len(kept) - 1)
    wide = np.flatnonzero(np.diff(kept) > 1)
    if wide.size:
        found[wide] = _greatest_distances(line, kept[wide], kept[wide + 1])
    return found


def geodesic_cross_track(
    start: tuple[ArrayLike, ArrayLike],
    end: tuple[ArrayLike, ArrayLike],
    lat: ArrayLike,
    lon: ArrayLike,
) -> FloatArray:
    """Return the distances [m] of positions from geodesics; beyond an end more than to that end.

    Parameters
    ----------
    start, end : (lat, lon)
        Ends of the geodesic [deg], or of one for each position, (n,).
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    ndarray (n,) : Distances [m], positive.
    """
    length, course, _ = inverse(*start, *end)
    away, bearing, _ = inverse(*start, lat, lon)
    return _cross_track(length, course, away, bearing)


def _cross_track(
    length: FloatArray, course: FloatArray, away: FloatArray, bearing: FloatArray
) -> FloatArray:
    """Return distances [m] from geodesics of a length and course, seen from their start."""
    arc = away / MEAN_RADIUS
    aside = np.abs(np.arcsin(np.sin(arc) * np.sin(bearing - course))) * MEAN_RADIUS
    along = away * np.cos(bearing - course)
    beyond = (along < 0.0) | (along > length)
    return np.asarray(np.where(beyond, np.minimum(away, np.abs(away - length)) + aside, aside))


def _distances_from_geodesics(
    line: RouteLine, first: IntArray, last: IntArray, between: InnerPoints
) -> FloatArray:
    """Return how far the waypoints between pairs of others are from the lines of these [m]."""
    lat, lon = line.lat, line.lon
    index, pair = between.point, between.pair
    length, course, _ = inverse(lat[first], lon[first], lat[last], lon[last])
    away, bearing, _ = inverse(lat[first[pair]], lon[first[pair]], lat[index], lon[index])
    return _cross_track(length[pair], course[pair], away, bearing)


def _greatest_distances(line: RouteLine, first: IntArray, last: IntArray) -> FloatArray:
    """Return the greatest distance [m] of a waypoint between from the line, of each pair."""
    between = inner_points(first, last)
    apart = _distances_from_geodesics(line, first, last, between)
    return np.asarray(np.maximum.reduceat(apart, between.begins))


def _turns(line: RouteLine, chart: Chart | None, tolerance: float) -> IntArray:
    """Return the waypoints to keep where the route turns, and those that are held."""
    keep = line.held.copy()
    held = np.flatnonzero(keep)
    first, last = held[:-1], held[1:]
    apart = ~line.rhumb[first]
    mark_needed_points(
        keep,
        first[apart],
        last[apart],
        tolerance=tolerance,
        distances=partial(_distances_from_geodesics, line),
        must_split=partial(_blocked, line, chart),
    )
    return np.flatnonzero(keep)


def _blocked(line: RouteLine, chart: Chart | None, first: IntArray, last: IntArray) -> BoolArray:
    """Return which legs between waypoints cross land; none without a chart."""
    if chart is None:
        return np.zeros(len(first), bool)
    lat, lon = line.lat, line.lon
    return np.asarray(chart.legs_blocked(lat[first], lon[first], lat[last], lon[last]))


def _without_repeats(line: RouteLine, kept: IntArray) -> IntArray:
    """Return the waypoints without those that are too close to the one before, if they may go."""
    lat, lon, fixed = line.lat, line.lon, (line.wait > 0.0) | line.carried
    steps = distance(lat[kept[:-1]], lon[kept[:-1]], lat[kept[1:]], lon[kept[1:]])
    if not (steps < _SAME_PLACE).any():
        return kept
    waypoints, final = [int(kept[0])], int(kept[-1])
    for index, previous, step in zip(kept[1:].tolist(), kept[:-1].tolist(), steps.tolist()):
        before = waypoints[-1]
        if before != previous:
            step = float(distance(lat[before], lon[before], lat[index], lon[index]))
        if step < _SAME_PLACE and not line.canal[before:index].any():
            if index == final and before != kept[0] and not fixed[before]:
                waypoints[-1] = index
                continue
            if index != final and not fixed[index] and not line.canal[index]:
                continue
        waypoints.append(index)
    return np.array(waypoints)


def _without_short_legs(
    line: RouteLine, chart: Chart | None, kept: IntArray, tolerance: float
) -> IntArray:
    """Return the waypoints without those beside short legs that may go, the nearest first."""
    lat, lon = line.lat, line.lon
    lengths = distance(lat[kept[:-1]], lon[kept[:-1]], lat[kept[1:]], lon[kept[1:]])
    shortest = np.minimum(lengths[:-1], lengths[1:])
    near = np.flatnonzero(~line.held[kept[1:-1]] & (shortest < _SHORT_LEG))
    waiting = list(zip(shortest[near].tolist(), kept[near + 1].tolist()))
    heapq.heapify(waiting)
    may_go = _may_join(line, chart, kept[near], kept[near + 2], tolerance)
    known = dict(zip(zip(kept[near].tolist(), kept[near + 2].tolist()), may_go.tolist()))
    before = dict(zip(kept[1:].tolist(), kept[:-1].tolist()))
    after = dict(zip(kept[:-1].tolist(), kept[1:].tolist()))
    step = dict(zip(kept[:-1].tolist(), lengths.tolist()))  # of the leg after a waypoint
    stays = set(np.flatnonzero(line.held).tolist())
    while waiting:
        length, here = heapq.heappop(waiting)
        if here in stays or here not in before or length != min(step[before[here]], step[here]):
            continue  # the legs beside it have changed since
        ends = before[here], after[here]
        if ends not in known:
            pair = np.array([ends[0]]), np.array([ends[1]])
            known[ends] = bool(_may_join(line, chart, *pair, tolerance)[0])
        if not known[ends]:
            stays.add(here)
            continue
        del before[here], after[here], step[here]
        after[ends[0]], before[ends[1]] = ends[1], ends[0]
        first, last = np.array(ends)
        step[ends[0]] = float(distance(lat[first], lon[first], lat[last], lon[last]))
        for beside in ends:
            if beside not in stays:
                shorter = min(step[before[beside]], step[beside])
                if shorter < _SHORT_LEG:
                    heapq.heappush(waiting, (shorter, beside))
    return np.array([*after, kept[-1]])


def _may_join(
    line: RouteLine, chart: Chart | None, first: IntArray, last: IntArray, tolerance: float
) -> BoolArray:
    """Return whether one leg may stand for those between two waypoints, for each pair."""
    if not first.size:
        return np.zeros(0, bool)
    close = _greatest_distances(line, first, last) <= tolerance
    return np.asarray(close & ~_blocked(line, chart, first, last))
