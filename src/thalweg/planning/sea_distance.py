"""Distances by sea between ports or positions, with approaches and canals."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.approaches import MAX_APPROACH_SPEED, line_between, line_length
from thalweg.chart.canals import exclude_canals
from thalweg.chart.passages import PASSAGES
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, densify, distance
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, KNOT, NAUTICAL_MILE
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.global_grid.sea_graph import (
    ICE_LATITUDES,
    outside_ice,
    path_length,
    sea_graph,
)
from thalweg.planning.request.voyage_endpoints import (
    Endpoint,
    check_distinct,
    resolve_endpoint,
    without_approach,
)
from thalweg.planning.voyage_parts import Place

#: Canals too small for most ships, which are not used by default.
SMALL_CANALS: Final = ("corinth",)
_NARROW: Final = 1.7 * NAUTICAL_MILE  # half width of passages that are named at their middle
_NARROW_RADIUS: Final = 12.0  # [km]
#: Straits that are wide and are named all the same: position [deg] and radius [km].
_WIDE_STRAITS: Final[dict[str, tuple[float, float, float]]] = {
    "Dover": (51.0, 1.45, 30.0),
    "Gibraltar": (35.95, -5.55, 30.0),
    "Bab el Mandeb": (12.55, 43.35, 35.0),
    "Hormuz": (26.5, 56.5, 50.0),
    "Malacca": (2.6, 101.3, 60.0),
    "Sunda": (-5.95, 105.85, 30.0),
    "Lombok": (-8.6, 115.75, 30.0),
    "Taiwan": (24.3, 119.2, 110.0),
    "Korea": (34.6, 129.3, 70.0),
    "Windward": (20.0, -74.0, 50.0),
    "Mona": (18.4, -67.7, 60.0),
    "Yucatan": (21.8, -85.8, 100.0),
    "Florida": (24.2, -81.0, 90.0),
    "Skagen": (57.85, 10.8, 40.0),
    "Cape of Good Hope": (-35.2, 19.0, 250.0),
    "Cape Horn": (-56.3, -67.3, 250.0),
}


@dataclass(frozen=True)
class SeaDistance:
    """The shortest way by sea between two places.

    Attributes
    ----------
    start, goal : str
        Names of the places.
    length : float
        Of the whole way [m].
    canals : tuple of str
        Canals, in order.
    straits : tuple of str
        Straits and capes that are passed, in order.
    approaches : tuple of (str, float)
        Name of the port and length of its approach [m], both part of the whole.
    line : tuple of (lat, lon)
        Waypoints [deg].
    notes : tuple of str
        How positions were taken.
    """

    start: str
    goal: str
    length: float
    canals: tuple[str, ...]
    straits: tuple[str, ...]
    approaches: tuple[tuple[str, float], ...]
    line: tuple[Position, ...]
    notes: tuple[str, ...] = ()

    @property
    def nm(self) -> float:
        """Length of the whole way [nautical miles]."""
        return self.length / NAUTICAL_MILE

    def days(self, speed_kn: float) -> float:
        """Return the time at a speed; approaches count at no more than 10 kn.

        Canals are counted at that speed: their transit times depend on convoys and locks.

        Parameters
        ----------
        speed_kn : float
            Speed [kn], above 0 and at most 100.

        Returns
        -------
        float
            Time [days].

        Raises
        ------
        InputError
            If the speed is not above zero.
        """
        if not (is_number(speed_kn) and 0.0 < speed_kn <= 100.0):
            raise InputError(
                f"The speed is {shortened_repr(speed_kn)} kn.",
                "Speeds are above 0 and at most 100 kn.",
                "Give the speed in knots.",
                field="speed_kn",
            )
        near = sum(length for _, length in self.approaches)
        speed = speed_kn * KNOT
        return ((self.length - near) / speed + near / min(speed, MAX_APPROACH_SPEED)) / DAY

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Returns
        -------
        dict
            Distances [nm], canals, straits, approaches by name, waypoints [deg] and
            notes.
        """
        return {
            "from": self.start,
            "to": self.goal,
            "distance_nm": self.nm,
            "canals": list(self.canals),
            "straits": list(self.straits),
            "approaches_nm": {name: length / NAUTICAL_MILE for name, length in self.approaches},
            "line": [list(place) for place in self.line],
            "notes": list(self.notes),
        }


def sea_distance(
    start: Place,
    goal: Place,
    *,
    via: Sequence[Place] = (),
    avoid: Sequence[str] = SMALL_CANALS,
    chart: Chart | None = None,
) -> SeaDistance:
    """Return the shortest way by sea between two ports or positions.

    Parameters
    ----------
    start, goal : (lat, lon) or str
        Places, as those of a `thalweg.Voyage`.
    via : sequence of places
        Places to pass, in this order; ports are passed off their sea ends.
    avoid : sequence of str
        Canals that are not used: "suez", "panama", "kiel", "corinth" or "all". By default that of
        Corinth, which is 7.2 m deep; give an empty list to use every canal.
    chart : Chart, optional
        By default the GSHHG coastline at resolution "i".

    Returns
    -------
    SeaDistance

    Raises
    ------
    InputError
        For places on land, unknown ports and unknown canals.
    NoRouteError
        If there is no way by sea.

    Notes
    -----
    The way is the shortest over a graph of all seas, where water within 2 nautical miles of land
    counts up to half more, after string pulling over the coast. Water north of 72 N and south of
    65 S is used only by ways that begin or end there.
    Draught, traffic rules and weather are not considered. The graph is made once (10 to 20 s) and
    kept in the cache.
    """
    chart = Chart.gshhg("i") if chart is None else chart
    closed = (avoid,) if isinstance(avoid, str) else tuple(avoid)
    left = exclude_canals(chart.canals, closed)
    places = [("start", start), *((f"via point {k + 1}", p) for k, p in enumerate(via))]
    ends = [resolve_endpoint(place, chart, what) for what, place in [*places, ("goal", goal)]]
    ends = [ends[0], *map(without_approach, ends[1:-1]), ends[-1]]
    for a, b in itertools.pairwise(ends):
        check_distinct(a, b)
    notes = tuple(end.note for end in ends if end.note)
    first, last = ends[0].approach, ends[-1].approach
    if len(ends) == 2 and first and last:
        line = line_between(first, last, legs_blocked=chart.legs_blocked)
        if line is not None:
            length = line_length(line)
            along = ((f"{first.port.label} to {last.port.label}", length),)
            return SeaDistance(ends[0].name, ends[-1].name, length, (), (), along, line, notes)
    numbers = [k for k, canal in enumerate(chart.canals) if canal not in left]
    parts = [_path_at_sea(chart, a, b, numbers) for a, b in itertools.pairwise(ends)]
    path = [parts[0][0], *(place for part in parts for place in part[1:])]
    length, canals = _length_and_canals(chart, path)
    approaches = tuple((a.port.label, a.length) for a in (first, last) if a is not None)
    line = (
        *(first.line[:-1] if first else ()),
        *path,
        *(last.line[-2::-1] if last else ()),
    )
    total = length + sum(miles for _, miles in approaches)
    straits = _straits_passed(line)
    return SeaDistance(ends[0].name, ends[-1].name, total, canals, straits, approaches, line, notes)


def _path_at_sea(
    chart: Chart, start: Endpoint, goal: Endpoint, closed: Sequence[int]
) -> list[Position]:
    """Return the shortest way between two positions at sea."""
    ends = (start.lat, start.lon), (goal.lat, goal.lon)
    if float(distance(*ends[0], *ends[1])) < 1.0:
        return [ends[0]]
    path = sea_graph(chart).path(chart, *ends, closed=closed)
    if outside_ice(*ends):
        chart = chart.within(*ICE_LATITUDES, -180.0, 180.0)
    lat, lon = string_pull_path(chart, *np.array(path).T)
    return list(zip(lat.tolist(), lon.tolist()))


def _length_and_canals(chart: Chart, path: Sequence[Position]) -> tuple[float, tuple[str, ...]]:
    """Return the length [m] of a way, canals with their own, and the titles of its canals."""
    if len(path) < 2:
        return 0.0, ()
    lat, lon = np.array(path).T
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    length = path_length(path)
    for leg in np.flatnonzero(canal >= 0).tolist():
        length += chart.canals[canal[leg]].length - path_length(path[leg : leg + 2])
    return length, tuple(chart.canals[k].title for k in canal[canal >= 0])


def _straits_passed(line: Sequence[Position]) -> tuple[str, ...]:
    """Return the names of straits and capes near a line, in the order it passes them."""
    if len(line) < 2:
        return ()
    whole = np.array(line)
    lat, lon, _ = densify(whole[:, 0], whole[:, 1], 5.0 * NAUTICAL_MILE)
    places = {
        passage.name: (*passage.line[len(passage.line) // 2], _NARROW_RADIUS)
        for passage in PASSAGES
        if passage.half_width <= _NARROW
    }
    passed: list[tuple[int, str]] = []
    for name, middle in (places | _WIDE_STRAITS).items():
        near = _within(lat, lon, middle)
        if near.any():
            passed.append((int(np.argmax(near)), name))
    return tuple(name for _, name in sorted(passed))


def _within(lat: FloatArray, lon: FloatArray, place: tuple[float, float, float]) -> np.ndarray:
    """Return which positions [deg] are within the radius [km] of a place."""
    north = lat - place[0]
    east = ((lon - place[1] + 180.0) % 360.0 - 180.0) * np.cos(np.radians(place[0]))
    return np.hypot(north, east) * 111.2 < place[2]
