"""Waypoints on interfaces of speed: a route bends where the speed jumps, as light does (Snell).

Frozen fields blur a jump over a cell, and the bend then lies beside it. Here the jumps along a
route are located in the sea itself, and their crossings moved along the interface.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import (
    METRES_PER_DEGREE,
    longitude_difference,
    rough_lengths,
    unwrap_longitude,
    wrap_longitude,
)
from thalweg.core.types import FloatArray
from thalweg.route.referee.evaluation import resolve_settings
from thalweg.route.referee.leg_segments import TrackPoints, cut_into_pieces
from thalweg.route.referee.sailing import sail_pieces
from thalweg.route.referee.sailing_physics import SailingEnvironment, solve_sailing_state
from thalweg.route.refinement.track_geometry import displaced_positions
from thalweg.route.route import Route
from thalweg.route.track import Track

_SMALLEST_JUMP = 0.02  # of the slowness, relative; smaller ones bend a route too little
_JUMP_RATIO = 3.0  # of a jump to the changes beside it
_MOST_INTERFACES = 6  # routes that cross more, such as through stepwise data, are left
_KEPT_JUMP = 0.7  # share of a jump that must be left when its place is known
_SCANNED = 41  # positions at which a jump is looked for
_PLACE_ACCURACY = 1e-3  # of the place of a jump [m]
_OBLIQUENESS = 4.0  # along the course, as a multiple of the displacement across it
_CLEARED = 0.02  # waypoints nearer to a crossing than this share of the length are left out
_REACHES = (0.1, 0.02)  # largest displacements of a crossing, as shares of the length
_PLACE_TOLERANCE = 2e-3  # of a displacement, as a share of the largest one
_GAIN_TOLERANCE = 1e-7  # relative gain of a round that ends the search
_PROBE = 0.1  # of the largest displacement: trials whether a crossing should move at all
_LEAST_GAIN = 1e-6  # expected relative gain of a crossing that is worth a search
_MOST_REMOVED = 60  # waypoints whose removal is tried
_PIECES = 8  # of every leg of a trial


@dataclass(frozen=True)
class _Crossing:
    """Where a route crosses an interface.

    Attributes
    ----------
    lat, lon : [deg].
    course : [rad].
    time : [s since 1970-01-01T00:00Z].
    jump : Change of the slowness along the course [s/m].
    """

    leg: int
    lat: float
    lon: float
    course: float
    time: float
    jump: float

    def at(self, along: FloatArray, across: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return positions displaced along the course and to starboard [m]."""
        sine, cosine = math.sin(self.course), math.cos(self.course)
        return displaced_positions(
            np.full(along.shape, self.lat),
            np.full(along.shape, self.lon),
            along * sine + across * cosine,
            along * cosine - across * sine,
        )


def with_interface_points(
    route: Route, world: SailingEnvironment, score: Callable[[Track], Route]
) -> Route:
    """Return a route with waypoints where it crosses jumps of the speed, for the earliest arrival.

    Parameters
    ----------
    route : Feasible, as evaluated by the referee.
    world : Ship, sea and chart.
    score : The referee: a track to its route.

    Returns
    -------
    Route : The given one if it crosses no jump, waits, or becomes no faster.
    """
    if not route.feasible or np.any(route.track.wait):
        return route
    ship, track = resolve_settings(world.ship, route.track)
    world = replace(world, ship=ship)
    crossings = _crossings(route, track, world)
    if not crossings or len(crossings) > _MOST_INTERFACES:
        return route
    line = _BentLine.through(track, crossings, world)
    for reach in _REACHES:
        moved = line.with_best_crossings(reach)
        if moved is not line:
            line = moved.without_needless_points()
    better = score(line.track())
    return better if better.feasible and better.arrive < route.arrive else route


def _slowness(
    world: SailingEnvironment, crossing: _Crossing, setting: int, lat: FloatArray, lon: FloatArray
) -> FloatArray:
    """Return the slowness [s/m] at positions, on the course and at the time of a crossing."""
    count = len(lat)
    charted = np.full(count, math.inf)
    if world.charted and world.chart is not None:
        charted = np.asarray(world.chart.depths.at(lat, lon), float)
    points = TrackPoints(
        lat,
        wrap_longitude(lon),
        np.full(count, crossing.course),
        np.full(count, setting),
        np.zeros(count, dtype=np.int64),
        np.zeros(count),
        charted,
    )
    state = solve_sailing_state(world, points, np.full(count, crossing.time))
    return 1.0 / state.speed_over_ground


def _crossings(route: Route, track: Track, world: SailingEnvironment) -> list[_Crossing]:
    """Return the jumps of the speed along a route."""
    samples = route.samples
    speed, leg, along = (np.asarray(samples[n]) for n in ("speed_over_ground", "leg", "distance"))
    slowness = 1.0 / speed
    same = (np.diff(leg) == 0) & (np.diff(along) > 0.0)
    change = np.where(same, np.abs(np.diff(slowness)), 0.0)
    beside = np.maximum(np.append(0.0, change[:-1]), np.append(change[1:], 0.0))
    places = np.flatnonzero(
        (change > _SMALLEST_JUMP * np.minimum(slowness[:-1], slowness[1:]))
        & (change > _JUMP_RATIO * beside)
    )
    found = []
    for k in places[: 4 * _MOST_INTERFACES].tolist():
        first = _Crossing(
            int(leg[k]),
            float(samples["lat"][k]),
            float(samples["lon"][k]),
            float(samples["course"][k]),
            float(samples["time"][k]),
            float(slowness[k + 1] - slowness[k]),
        )
        span = (-_PLACE_ACCURACY, float(along[k + 1] - along[k]) + _PLACE_ACCURACY)
        place = _located(world, first, int(track.setting[first.leg]), span, 0.0)
        if place is not None:
            found.append(replace(first, lat=place[0], lon=place[1]))
    return found


def _located(
    world: SailingEnvironment,
    crossing: _Crossing,
    setting: int,
    span: tuple[float, float],
    across: float,
) -> tuple[float, float] | None:
    """Return where the slowness jumps as at a crossing, displaced across the course [m].

    Within a span along the course [m]; None where there is no such jump.
    """
    most, sign = _KEPT_JUMP * abs(crossing.jump), np.sign(crossing.jump)
    low, high = span
    while high - low > _PLACE_ACCURACY:
        along = np.linspace(low, high, _SCANNED)
        where = crossing.at(along, np.full(_SCANNED, across))
        step = sign * np.diff(_slowness(world, crossing, setting, *where))
        if not step.max() >= most:  # nor if unknown
            return None
        k = int(np.argmax(step))
        low, high = float(along[k]), float(along[k + 1])
    return float(where[0][k + 1]), float(where[1][k + 1])


@dataclass(frozen=True)
class _BentLine:
    """A track with a waypoint on every interface that it crosses.

    Attributes
    ----------
    origin : The track that it started from.
    lat, lon : Waypoints [deg], longitudes without jumps.
    setting : Of the legs.
    places : Index of the waypoint of each crossing.
    """

    world: SailingEnvironment
    origin: Track
    crossings: list[_Crossing]
    lat: FloatArray
    lon: FloatArray
    setting: np.ndarray
    places: list[int]

    @classmethod
    def through(
        cls, track: Track, crossings: list[_Crossing], world: SailingEnvironment
    ) -> _BentLine:
        """Return a track with its crossings as waypoints, without those very near to them."""
        lon = unwrap_longitude(track.lon)
        total = float(rough_lengths(track.lat, lon).sum())
        crossing_lon = [lon[c.leg] + longitude_difference(c.lon, lon[c.leg]) for c in crossings]
        rows: list[tuple[float, float, int, int]] = [(track.lat[0], lon[0], track.setting[0], -1)]
        for k in range(len(track) - 1):
            for number, crossing in enumerate(crossings):
                if crossing.leg == k:
                    rows.append((crossing.lat, crossing_lon[number], track.setting[k], number))
            last = k == len(track) - 2
            here = float(track.lat[k + 1]), float(lon[k + 1])
            near = min(_distance(here, (c.lat, x)) for c, x in zip(crossings, crossing_lon))
            if last or near > _CLEARED * total or track.setting[k] != track.setting[k + 1]:
                rows.append((*here, int(track.setting[min(k + 1, len(track) - 2)]), -1))
        lats, lons, settings, numbers = (np.array(column) for column in zip(*rows))
        places = [int(np.flatnonzero(numbers == n)[0]) for n in range(len(crossings))]
        return cls(world, track, crossings, lats, lons, settings[:-1], places)

    def track(self) -> Track:
        """Return the line as a track."""
        lon, no_wait = wrap_longitude(self.lon), np.zeros(len(self.lat))
        return Track(self.lat, lon, self.origin.depart, no_wait, self.setting)

    def arrival(self) -> float:
        """Return the time of arrival [s]; inf if the line cannot be sailed."""
        track, world = self.track(), self.world
        step = float(track.lengths.sum()) / (4 * _PIECES)
        pieces = cut_into_pieces(track, step, _PIECES, world.chart, world.ship)
        arrive = sail_pieces(world, pieces, None).arrive
        return arrive if math.isfinite(arrive) else math.inf

    def without_needless_points(self) -> _BentLine:
        """Return the line without the waypoints between crossings that make it no faster."""
        line = self
        fastest = line.arrival()
        between = [k for k in range(1, len(self.lat) - 1) if k not in self.places]
        for k in reversed(between[:_MOST_REMOVED]):
            shorter = line._without(k)
            arrival = math.inf if shorter is None else shorter.arrival()
            if shorter is not None and arrival <= fastest:
                line, fastest = shorter, arrival
        return line

    def _without(self, k: int) -> _BentLine | None:
        if self.setting[k - 1] != self.setting[k]:
            return None
        return replace(
            self,
            lat=np.delete(self.lat, k),
            lon=np.delete(self.lon, k),
            setting=np.delete(self.setting, k),
            places=[place - (place > k) for place in self.places],
        )

    def with_best_crossings(self, reach: float) -> _BentLine:
        """Return the line with its crossings moved along their interfaces to the earliest arrival.

        Parameters
        ----------
        reach : Largest displacement to either side, as a share of the length of the line.

        Notes
        -----
        By Powell's method of conjugate directions (`scipy.optimize.minimize`), over the crossings
        of which a parabola through three displacements expects a gain.
        """
        most = reach * float(rough_lengths(self.lat, self.lon).sum())
        now = self.arrival()
        spent = now - self.origin.depart
        count = len(self.places)
        place_of = cache(self._crossing_displaced)

        def displaced(across: FloatArray) -> _BentLine | None:
            line = self
            for number in np.flatnonzero(across).tolist():
                found = place_of(number, float(across[number]))
                if found is None:
                    return None
                line = line._with_crossing_at(number, *found)
            return line

        def relative_loss(shares: FloatArray) -> float:  # finite, for the parabolas of the search
            moved = displaced(most * shares)
            return 1.0 if moved is None else min((moved.arrival() - now) / spent, 1.0)

        units = np.eye(count)
        chosen = [k for k in range(count) if _may_gain(relative_loss, units[k])]
        if not chosen:
            return self
        from scipy.optimize import minimize

        best = minimize(
            lambda shares: 1.0 + relative_loss(shares @ units[chosen]),
            np.zeros(len(chosen)),
            method="Powell",
            bounds=[(-1.0, 1.0)] * len(chosen),
            options={"xtol": _PLACE_TOLERANCE, "ftol": _GAIN_TOLERANCE},
        )
        moved = displaced(most * (best.x @ units[chosen])) if best.fun < 1.0 else None
        return self if moved is None else moved

    def _crossing_displaced(self, number: int, across: float) -> tuple[float, float] | None:
        """Return a crossing displaced to starboard [m] along its interface [deg]; None if lost."""
        place = self.places[number]
        here = replace(
            self.crossings[number], lat=float(self.lat[place]), lon=float(self.lon[place])
        )
        span = _OBLIQUENESS * abs(across) + 1.0
        return _located(self.world, here, int(self.setting[place]), (-span, span), across)

    def _with_crossing_at(self, number: int, lat: float, lon: float) -> _BentLine:
        """Return the line with a crossing moved; the points beside it follow in proportion."""
        place = self.places[number]
        north, east = lat - self.lat[place], longitude_difference(lon, self.lon[place])
        share = self._followed_shares(place)
        return replace(self, lat=self.lat + share * north, lon=self.lon + share * east)

    def _followed_shares(self, place: int) -> FloatArray:
        """Return the share of a displacement of one waypoint that each waypoint follows.

        It falls to zero at the ends and at the other crossings: straight lines stay straight.
        """
        fixed = sorted({0, len(self.lat) - 1, *self.places})
        k = fixed.index(place)
        along = cumulative_sums(rough_lengths(self.lat, self.lon))
        anchors = [along[fixed[k - 1]], along[place], along[fixed[k + 1]]]
        return np.asarray(np.interp(along, anchors, [0.0, 1.0, 0.0]))


def _may_gain(loss: Callable[[FloatArray], float], unit: FloatArray) -> bool:
    """Return whether a displacement along a unit vector may save more than `_LEAST_GAIN`."""
    before, after = loss(-_PROBE * unit), loss(_PROBE * unit)
    slope, bend = 0.5 * (after - before), 0.5 * (after + before)
    gain = 0.25 * slope**2 / bend if abs(slope) < 2.0 * bend else max(-before, -after)
    return gain > _LEAST_GAIN


def _distance(one: tuple[float, float], other: tuple[float, float]) -> float:
    north = one[0] - other[0]
    east = longitude_difference(one[1], other[1]) * math.cos(math.radians(one[0]))
    return math.hypot(north, east) * METRES_PER_DEGREE
