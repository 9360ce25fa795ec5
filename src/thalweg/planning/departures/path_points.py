"""`SailedPath`: a path on networks with its times, and the points where its rates are taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import Network
from thalweg.network.assembly import measured_pairs
from thalweg.network.short_legs import positions_on_short_legs
from thalweg.route import Track
from thalweg.search.timed_path import TimedPath

LEAST_WAIT: Final = 1.0  #: shorter waits count as none [s]
_PIECE: Final = 4.0 * NAUTICAL_MILE  #: longest piece of a leg at whose middle rates are taken


@dataclass(frozen=True, eq=False)
class SailedPath:
    """A path on networks with its times, from berth to berth.

    Attributes
    ----------
    depart, arrive : [s since 1970-01-01T00:00Z], approaches of ports included.
    lat, lon : float64 array (n,) of the nodes [deg].
    reach, leave : float64 array (n,)
        Arrival at and departure from each node [s since 1970-01-01T00:00Z].
    """

    depart: float
    arrive: float
    lat: FloatArray
    lon: FloatArray
    reach: FloatArray
    leave: FloatArray

    @classmethod
    def of_paths(
        cls,
        depart: float,
        arrive: float,
        networks: Sequence[Network],
        paths: Sequence[TimedPath],
    ) -> SailedPath:
        """Return the path of several that follow each other."""
        lat: list[FloatArray] = []
        lon: list[FloatArray] = []
        reach: list[FloatArray] = []
        leave: list[FloatArray] = []
        for number, (network, one) in enumerate(zip(networks, paths)):
            new = slice(1 if number else 0, None)
            lat.append(network.stations.lat[one.nodes][new])
            lon.append(network.stations.lon[one.nodes][new])
            if number:  # waits at the waypoint count to the section that begins there
                leave[-1][-1] = one.node_depart[0]
            reach.append(one.node_arrive[new])
            leave.append(one.node_depart[new].copy())
        return cls(depart, arrive, *(np.concatenate(part) for part in (lat, lon, reach, leave)))

    def track(self, setting: int) -> Track:
        """Return the path as a track at one speed setting."""
        wait = np.maximum(self.leave - self.reach, 0.0)
        wait[-1] = 0.0
        wait[wait < LEAST_WAIT] = 0.0
        settings = np.full(len(self.lat) - 1, setting)
        return Track(self.lat, self.lon, float(self.reach[0]), wait, settings)


@dataclass(frozen=True, eq=False)
class PathWaits:
    """The waits of many paths.

    Attributes
    ----------
    path : The path that each wait is of, ascending.
    lat, lon : [deg].
    seconds : [s].
    """

    path: IntArray
    lat: FloatArray
    lon: FloatArray
    seconds: FloatArray


@dataclass(frozen=True, eq=False)
class PathPoints:
    """The middles of the pieces of all legs of many paths.

    Attributes
    ----------
    path : The path that each point is of, ascending.
    count : Number of paths.
    lat, lon : [deg]; time : [s since 1970-01-01T00:00Z]; course : Of the leg [rad].
    seconds, length : Of the piece [s, m].
    path_of_legs : The path that each leg is of, ascending.
    lat_of_legs, lon_of_legs : float64 array (legs, 2) of their ends [deg].
    weights_of_legs : Their lengths [m] and times [s].
    ends : Latitude and longitude of both ends of the piece [deg], in turn.
    waits : Seconds at positions before legs.
    """

    path: IntArray
    count: int
    lat: FloatArray
    lon: FloatArray
    time: FloatArray
    course: FloatArray
    seconds: FloatArray
    length: FloatArray
    path_of_legs: IntArray
    lat_of_legs: FloatArray
    lon_of_legs: FloatArray
    weights_of_legs: tuple[FloatArray, FloatArray]
    ends: tuple[FloatArray, FloatArray, FloatArray, FloatArray]
    waits: PathWaits

    def sums(self, rate: FloatArray, weight: FloatArray) -> FloatArray:
        """Return the sum over the points of each path; NaN where one is unknown."""
        total = np.bincount(self.path, weights=rate * weight, minlength=self.count)
        return np.asarray(total, np.float64)


def points_of_paths(paths: Sequence[SailedPath]) -> PathPoints:
    """Return the points where the rates of paths are taken, and their waits."""
    sizes = np.array([len(path.lat) for path in paths])
    lat = np.concatenate([path.lat for path in paths])
    lon = np.concatenate([path.lon for path in paths])
    leave = np.concatenate([path.leave for path in paths])
    reach = np.concatenate([path.reach for path in paths])
    owner = np.repeat(np.arange(len(paths)), sizes)
    first = np.flatnonzero(np.diff(owner) == 0).astype(np.int32)
    pairs = measured_pairs(lat, lon, first, first + np.int32(1))
    pieces = np.maximum(1, np.ceil(pairs.length / _PIECE)).astype(np.int64)
    leg, rank = numbered_parts(pieces)
    share = (rank + 0.5) / pieces[leg]
    begin, end = first[leg], first[leg] + 1
    there = positions_on_short_legs(lat, lon, begin, end, pairs.length[leg], share)
    low, high = (
        positions_on_short_legs(lat, lon, begin, end, pairs.length[leg], part / pieces[leg])
        for part in (rank, rank + 1.0)
    )
    took = reach[first + 1] - leave[first]
    stay = leave[first] - reach[first]
    kept = np.flatnonzero(stay >= LEAST_WAIT)
    still = first[kept]
    return PathPoints(
        owner[begin], len(paths), *there, leave[begin] + share * took[leg],
        pairs.course[leg].astype(np.float64), (took / pieces)[leg], (pairs.length / pieces)[leg],
        owner[first], np.stack([lat[first], lat[first + 1]], axis=1),
        np.stack([lon[first], lon[first + 1]], axis=1), (pairs.length, took),
        (*low, *high), PathWaits(owner[still], lat[still], lon[still], stay[kept]),
    )  # fmt: skip
