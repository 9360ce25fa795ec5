"""Synthetic tracks of a fleet with known routes: lengths, speeds, seasons and outliers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, densify, direct, inverse, line_length
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, HOUR, KNOT

if TYPE_CHECKING:
    import pandas as pd

_PORT_STAY: Final = 12.0 * HOUR
_BEND: Final = 2_000.0  # spacing of the waypoints at which a track is displaced [m]


@dataclass(frozen=True)
class SyntheticRoute:
    """A route on which ships of a synthetic fleet sail.

    Attributes
    ----------
    line : tuple of (lat, lon)
        Waypoints from port to port [deg].
    share : float
        Relative frequency among the routes with the same first waypoint in a month.
    months : tuple of int
        Months in which it is sailed, 1 to 12.
    speed_kn : float
        Mean speed [kn].
    """

    line: tuple[Position, ...]
    share: float = 1.0
    months: tuple[int, ...] = tuple(range(1, 13))
    speed_kn: float = 14.0

    @property
    def length(self) -> float:
        """Length of its geodesics [m]."""
        return line_length(self.line)


@dataclass(frozen=True)
class SyntheticFleet:
    """How a synthetic fleet sails and is recorded.

    Attributes
    ----------
    routes : tuple of SyntheticRoute
        From every last waypoint a route must lead on.
    ships : int
        Number of ships.
    spread_m : float
        Standard deviation of the distance of a track from its route [m]; 0 at the ports.
    speed_spread : float
        Relative standard deviation of the speeds.
    interval_s : float
        Time between positions [s].
    draughts_m : tuple of float
        Draughts of the ships in turn [m].
    """

    routes: tuple[SyntheticRoute, ...]
    ships: int = 10
    spread_m: float = 1_500.0
    speed_spread: float = 0.05
    interval_s: float = 600.0
    draughts_m: tuple[float, ...] = (8.0, 12.0)

    def __post_init__(self) -> None:
        starts = {route.line[0] for route in self.routes}
        ends = {route.line[-1] for route in self.routes}
        if not self.routes or not ends <= starts or self.ships < 1 or self.interval_s <= 0.0:
            raise InputError(
                "The synthetic fleet cannot sail.",
                "It has ships, routes and an interval, and a route leads on from every port.",
                "Add the way back of every route.",
            )


def synthetic_fleet(
    fleet: SyntheticFleet, *, start: TimeLike, days: float, seed: int = 0
) -> pd.DataFrame:
    """Return the positions of a synthetic fleet.

    Every ship chooses a route from the port where she is, sails it at a constant speed with a
    sideways distance that varies slowly along the route, stays in port and chooses again.

    Parameters
    ----------
    fleet : SyntheticFleet
    start : time
        Of the first voyages; the ships start within a day.
    days : float
        Length of the record [days].
    seed : int, optional

    Returns
    -------
    DataFrame
        Columns ``mmsi``, ``time`` [s since 1970-01-01T00:00Z], ``lat``, ``lon`` [deg], ``draught``
        and ``length`` [m].
    """
    import pandas as pd

    random = np.random.default_rng(seed)
    begin = float(parse_time(start))
    lines = {route: _Line.of(route) for route in fleet.routes}
    parts: list[dict[str, Any]] = []
    for ship in range(fleet.ships):
        time = begin + random.uniform(0.0, DAY)
        port = fleet.routes[ship % len(fleet.routes)].line[0]
        draught = fleet.draughts_m[ship % len(fleet.draughts_m)]
        while time < begin + days * DAY:
            route = _chosen(fleet.routes, port, time, random)
            at, lat, lon = lines[route].sailed(fleet, time, random)
            parts.append({"mmsi": 200_000_000 + ship, "time": at, "lat": lat, "lon": lon,
                          "draught": draught, "length": 15.0 * draught})  # fmt: skip
            time, port = float(at[-1]) + fleet.interval_s, route.line[-1]
    return pd.concat([pd.DataFrame(part) for part in parts], ignore_index=True)


def _chosen(
    routes: Sequence[SyntheticRoute], port: Position, time: float, random: np.random.Generator
) -> SyntheticRoute:
    """Return one of the routes from a port that are sailed in the month of a time."""
    moment = np.datetime64(int(time), "s").astype("datetime64[M]")
    month = int(moment.astype(np.int64) % 12) + 1
    found = [route for route in routes if route.line[0] == port and month in route.months]
    found = found or [route for route in routes if route.line[0] == port]
    share = np.array([route.share for route in found])
    return found[int(random.choice(len(found), p=share / share.sum()))]


def _columns(line: tuple[Position, ...]) -> tuple[FloatArray, FloatArray]:
    lat, lon = np.array(line, float).T
    return lat, lon


@dataclass(frozen=True, eq=False)
class _Line:
    """A route with close waypoints: positions [deg], distance [m] and course [rad]."""

    route: SyntheticRoute
    lat: FloatArray
    lon: FloatArray
    along: FloatArray
    course: FloatArray

    @classmethod
    def of(cls, route: SyntheticRoute) -> _Line:
        lat, lon, _ = densify(*_columns(route.line), _BEND)
        length, course, _ = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
        along = cumulative_sums(length)
        return cls(route, lat, lon, along, np.append(course, course[-1]))

    def sailed(
        self, fleet: SyntheticFleet, time: float, random: np.random.Generator
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return times and positions of one voyage, with the stay in port at its end."""
        speed = self.route.speed_kn * KNOT * max(0.2, 1.0 + fleet.speed_spread * random.normal())
        whole = float(self.along[-1])
        phase = self.along / whole * np.pi
        aside = fleet.spread_m * random.normal() * np.sqrt(np.sin(phase).clip(0.0))
        lat, lon = direct(self.lat, self.lon, self.course + 0.5 * np.pi, aside)
        at = np.append(np.arange(0.0, whole / speed, fleet.interval_s), whole / speed)
        east = np.interp(at * speed, self.along, np.unwrap(lon, period=360.0))
        north = np.interp(at * speed, self.along, lat)
        stay = np.arange(fleet.interval_s, _PORT_STAY, fleet.interval_s)
        at = np.append(at, at[-1] + stay) + time
        north = np.append(north, np.full(len(stay), north[-1]))
        east = np.append(east, np.full(len(stay), east[-1]))
        return at, north, (east + 180.0) % 360.0 - 180.0
