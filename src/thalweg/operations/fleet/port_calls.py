"""Stops of ships, calls at ports, and the voyages between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.chart.canals import Canal
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, densify, distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.network.history.arc_statistics import group_percentiles
from thalweg.network.history.voyage_tracks import (
    TrackShips,
    VoyageTracks,
    ellipsoid_vectors,
    lengths_between,
)
from thalweg.operations.fleet.fleet_tracks import FleetTracks

#: A single position near a port is a call where the positions before and after are this far [s].
#: Of a wait for a canal; distances of such a wait from its end, and of the ship from the other end.
_LONGEST_WAIT: Final = 12.0 * HOUR
_BESIDE_CANAL, _PASSED = 15.0 * NAUTICAL_MILE, 10.0 * NAUTICAL_MILE
_SLOW_PASSAGE: Final = 4.0 * KNOT
_LONG: Final = 3.0 * HOUR  # of an interval beside a call, in which a ship may lie in port
_INTERVALS: Final = 3  # of a voyage from which its speed is known
_SPARSE: Final = 6.0 * HOUR
_PLACE_SPACING: Final = 1.0 * NAUTICAL_MILE
_BERTH: Final = 1.0 * NAUTICAL_MILE  # berths of a port lie about so far from its position


@dataclass(frozen=True)
class PortCallRules:
    """Rules for stops and port calls.

    Attributes
    ----------
    slow : float
        A mean speed between positions below this [m/s] is a stop if it lasts.
    shortest_stop : float
        Shortest stop [s].
    reach : float
        A stop within this distance of a berth or of the approach of a port [m] is a call there.
    """

    slow: float = 1.0 * KNOT
    shortest_stop: float = 1.0 * HOUR
    reach: float = 5.0 * NAUTICAL_MILE

    def __post_init__(self) -> None:
        values = (self.slow, self.shortest_stop, self.reach)
        if not all(np.isfinite(v) and v > 0.0 for v in values):
            raise InputError(
                f"The rules for port calls are {self}.",
                "Speed, time and distance are above zero.",
                "Correct them.",
            )


@dataclass(frozen=True, eq=False)
class PortCalls:
    """Calls at ports, c in all, in order of ships and time.

    Attributes
    ----------
    ship, port : Ship of the fleet, and number of the port, (c,).
    first, last : Its first and last position, (c,).
    stopped : bool array (n,)
        Intervals after positions in which the ship does not move, at ports or elsewhere.
    """

    ship: IntArray
    port: IntArray
    first: IntArray
    last: IntArray
    stopped: BoolArray


def find_port_calls(
    fleet: FleetTracks,
    places: Sequence[Sequence[Position]],
    rules: PortCallRules | None = None,
    *,
    weights: Sequence[float] | None = None,
) -> PortCalls:
    """Return the calls of ships at ports.

    A call is a stop within reach of a port; the begin or end of a track within reach; or, in
    tracks with a position every six hours or more, one position within reach. Stops elsewhere, at
    anchor or adrift, are no calls.

    Parameters
    ----------
    places : sequence of sequence of (lat, lon)
        Of every port: its berth and the line of its approach [deg].
    weights : sequence of float, optional
        Of every port, see `ports_of_positions`.

    Returns
    -------
    PortCalls : Consecutive calls at one port are one.
    """
    rules = rules or PortCallRules()
    vectors = ellipsoid_vectors(fleet.lat, fleet.lon)
    gap = np.append(np.diff(fleet.time), np.inf)
    gap[fleet.ptr[1:] - 1] = np.inf
    step = np.append(lengths_between(vectors[:-1], vectors[1:]), np.inf)
    slow = step < rules.slow * gap
    slow[fleet.ptr[1:] - 1] = False
    begin, end = _runs(slow)
    long = fleet.time[end] - fleet.time[begin] >= rules.shortest_stop
    begin, end = begin[long], end[long]
    change = np.zeros(len(slow), np.int64)  # runs do not touch each other
    change[begin], change[end] = 1, -1
    stopped = np.asarray(np.cumsum(change) > 0)
    middle = _means(vectors, begin, end)
    before = np.concatenate([[np.inf], gap[:-1]])
    single = np.flatnonzero((before >= _SPARSE) & (gap >= _SPARSE) & ~stopped)
    first = np.concatenate([begin, single])
    last = np.concatenate([end, single])
    edge = np.setdiff1d(np.concatenate([fleet.ptr[:-1], fleet.ptr[1:] - 1]), single)
    first, last = np.append(first, edge), np.append(last, edge)
    where = np.concatenate([middle, vectors[single], vectors[edge]])
    port = ports_of_positions(where, places, rules.reach, weights)
    order = np.flatnonzero(port >= 0)
    order = order[np.lexsort((last[order], first[order]))]
    ship = np.searchsorted(fleet.ptr, first[order], side="right") - 1
    return _merged(PortCalls(ship, port[order], first[order], last[order], stopped))


def _runs(inside: BoolArray) -> tuple[IntArray, IntArray]:
    """Return the first position of each run of intervals, and the position after the run."""
    change = np.diff(np.concatenate([[0], inside.astype(np.int8), [0]]))
    return np.flatnonzero(change == 1), np.flatnonzero(change == -1)


def _means(vectors: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """Return the means of the vectors from first to last."""
    if not len(first):
        return np.empty((0, 3))
    ends = np.stack([first, last], axis=1).ravel()
    return np.add.reduceat(vectors, ends, axis=0)[::2] / (last - first)[:, None]


def ports_of_positions(
    vectors: FloatArray,
    places: Sequence[Sequence[Position]],
    reach: float,
    weights: Sequence[float] | None = None,
) -> IntArray:
    """Return the port of each position, -1 for none.

    Of the ports whose berth or approach is within reach it is the one whose berth is nearest: ships
    at a terminal by a river lie on the approaches of all ports farther up.

    Parameters
    ----------
    vectors : Of `ellipsoid_vectors`, (n, 3) [m].
    places : Of every port: its berth and the line of its approach [deg].
    reach : [m].
    weights : By which distances from the berth of each port are multiplied; by default 1.
    """
    from scipy.spatial import cKDTree

    lat, lon, owner = [], [], []
    for number, line in enumerate(places):
        y, x = np.array(line, float).reshape(-1, 2).T
        if len(y) > 1:
            y, x, _ = densify(y, x, _PLACE_SPACING)
        lat.append(y)
        lon.append(x)
        owner.append(np.full(len(y), number))
    found = np.full(len(vectors), -1, np.int64)
    if not lat or not len(vectors):
        return found
    tree = cKDTree(ellipsoid_vectors(np.concatenate(lat), np.concatenate(lon)))
    berths = ellipsoid_vectors(*np.array([line[0] for line in places], float).T)
    factor = np.ones(len(places)) if weights is None else np.asarray(weights, float)
    of = np.concatenate(owner)
    for k, near in enumerate(tree.query_ball_point(vectors, reach)):
        if near:
            ports = np.unique(of[near])
            away = np.linalg.norm(berths[ports] - vectors[k], axis=1) + _BERTH
            found[k] = ports[int(np.argmin(factor[ports] * away))]
    return found


def _merged(calls: PortCalls) -> PortCalls:
    """Return calls with consecutive ones of a ship at one port as one."""
    again = np.append(False, (np.diff(calls.ship) == 0) & (np.diff(calls.port) == 0))[
        : len(calls.ship)
    ]
    head = np.flatnonzero(~again)
    tail = np.append(head[1:], len(again)) - 1 if len(head) else head
    last = np.maximum.accumulate(calls.last) if len(head) else calls.last
    return PortCalls(calls.ship[head], calls.port[head], calls.first[head], last[tail],
                     calls.stopped)  # fmt: skip


def without_waits_at_canals(
    fleet: FleetTracks, calls: PortCalls, canals: Sequence[Canal]
) -> PortCalls:
    """Return calls without short stops beside a canal that the ship passes just before or after.

    Ships wait for convoys and locks near ports. A stop of less than 12 hours within 15 nm of one
    end of a canal is such a wait if the ship passes the other end within the time of the passage
    and 12 hours. The begin and the end of a track stay calls.

    Parameters
    ----------
    canals : Of the chart.

    Returns
    -------
    PortCalls : In the same order.
    """
    time = fleet.time[calls.last] - fleet.time[calls.first]
    inside = (calls.first > fleet.ptr[calls.ship]) & (calls.last < fleet.ptr[calls.ship + 1] - 1)
    short = (time < _LONGEST_WAIT) & inside
    keep = np.ones(len(calls.ship), bool)
    for canal in canals:
        reach = canal.length / _SLOW_PASSAGE + _LONGEST_WAIT
        for end, other in (canal.ends, canal.ends[::-1]):
            away = distance(fleet.lat[calls.first], fleet.lon[calls.first], *end)
            for call in np.flatnonzero(short & keep & (away <= _BESIDE_CANAL)).tolist():
                begin, stop = fleet.ptr[calls.ship[call] : calls.ship[call] + 2]
                moments = fleet.time[begin:stop]
                low, high = np.searchsorted(moments, [
                    fleet.time[calls.first[call]] - reach, fleet.time[calls.last[call]] + reach
                ])  # fmt: skip
                part = slice(begin + low, begin + high)
                passed = distance(fleet.lat[part], fleet.lon[part], *other)
                keep[call] = not bool((passed <= _PASSED).any())
    return _merged(PortCalls(calls.ship[keep], calls.port[keep], calls.first[keep],
                             calls.last[keep], calls.stopped))  # fmt: skip


def voyages_between_calls(fleet: FleetTracks, calls: PortCalls) -> VoyageTracks:
    """Return the tracks between consecutive calls of a ship at different ports.

    Positions inside stops are left out but for the first and last, and stops do not count as time
    under way.

    Returns
    -------
    VoyageTracks : ``start`` and ``goal`` are the numbers of the ports.
    """
    at = np.flatnonzero((np.diff(calls.ship) == 0) & (calls.last[:-1] < calls.first[1:]))
    first, last = calls.last[at], calls.first[at + 1]
    count = last - first + 1
    voyage, number = numbered_parts(count)
    index = first[voyage] + number
    keep = ~(calls.stopped[index] & calls.stopped[np.maximum(index - 1, 0)])
    edges = np.cumsum(count)
    keep[edges - count] = True
    keep[edges - 1] = True
    moving = np.where(calls.stopped, 0.0, np.append(np.diff(fleet.time), 0.0))
    moving = _without_time_in_port(fleet, moving, first, last)
    sailed = cumulative_sums(moving)[:-1]
    index, voyage = index[keep], voyage[keep]
    ptr = np.searchsorted(voyage, np.arange(len(at) + 1)).astype(np.int64)
    draught = group_percentiles(fleet.draught[index], ptr, (50.0,))[:, 0]
    length = group_percentiles(fleet.length[index], ptr, (100.0,))[:, 0]
    return VoyageTracks(
        ptr,
        fleet.time[index],
        fleet.lat[index],
        fleet.lon[index],
        sailed[index] - sailed[first][voyage],
        fleet.broken[index] & ~calls.stopped[index],
        calls.port[at],
        calls.port[at + 1],
        TrackShips(draught, length),
    )


def _without_time_in_port(
    fleet: FleetTracks, moving: FloatArray, first: IntArray, last: IntArray
) -> FloatArray:
    """Return times of intervals without time in port in the long ones beside calls.

    Between a position in port and the next one a day later lies some of the stay. Such an interval,
    and the last one of a voyage, takes no longer than at the mean speed of those between.
    """
    vectors = ellipsoid_vectors(fleet.lat, fleet.lon)
    step = np.append(lengths_between(vectors[:-1], vectors[1:]), 0.0)
    length, time = (cumulative_sums(part) for part in (step, moving))
    inner = last - first >= _INTERVALS
    low, high = first[inner] + 1, last[inner] - 1
    speed = (length[high] - length[low]) / np.maximum(time[high] - time[low], 1.0)
    found = moving.copy()
    for at in (first[inner], high):
        least = step[at] / np.maximum(speed, 0.1)
        long = (moving[at] > _LONG) & (speed > 0.0)
        found[at] = np.where(long, np.minimum(moving[at], least), moving[at])
    return found
