"""Synthetic tracks with known activities: a dredger sails cycles through a given sea."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import Position, check_position, direct, distance, inverse
from thalweg.core.time import TimeLike, parse_time, to_datetime64
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, HOUR, KNOT, NAUTICAL_MILE
from thalweg.ship.condition_variables import EASTWARD_CURRENT, NORTHWARD_CURRENT

if TYPE_CHECKING:
    import pandas as pd

    from thalweg.sea import Sea

_STEPS_PER_MESSAGE = 4  # steps of the ship between two messages
_MAX_TRIP_DURATION = 14.0 * DAY  # [s]


@dataclass(frozen=True)
class SyntheticCycle:
    """The cycle that a ship repeats, and how it is recorded.

    Attributes
    ----------
    loading_place, unloading_place : (float, float)
        Centres of the areas (lat, lon) [deg].
    full_kn, empty_kn : float
        Speeds through water [kn].
    loading_h, unloading_h : float
        Duration [h]; while loading the ship sails to and fro at 1.5 kn.
    radius_nm : float
        Radius of the areas [nm].
    position_noise_m : float
        Standard deviation of each recorded coordinate [m].
    """

    loading_place: Position
    unloading_place: Position
    full_kn: float = 11.0
    empty_kn: float = 13.0
    loading_h: float = 1.5
    unloading_h: float = 1.0
    radius_nm: float = 0.6
    position_noise_m: float = 5.0

    def __post_init__(self) -> None:
        check_position(*self.loading_place, "loading place")
        check_position(*self.unloading_place, "unloading place")
        apart = float(distance(*self.loading_place, *self.unloading_place)) / NAUTICAL_MILE
        numbers = (self.full_kn, self.empty_kn, self.loading_h, self.unloading_h, self.radius_nm)
        if not all(math.isfinite(n) and n > 0.0 for n in numbers) or apart < 3 * self.radius_nm:
            raise InputError(
                f"The cycle is {self}.",
                "All numbers are positive and the places at least three radii apart.",
                "Correct it.",
            )
        if not 0.0 <= self.position_noise_m < 1e4:
            raise InputError(
                f"position_noise_m is {self.position_noise_m!r}.",
                "It is 0 to 10 km.",
                "Correct it.",
            )

    @property
    def areas(self) -> dict[str, Any]:
        """Both areas as GeoJSON."""
        return {
            "type": "FeatureCollection",
            "features": [
                _circle(self.loading_place, self.radius_nm, "loading"),
                _circle(self.unloading_place, self.radius_nm, "unloading"),
            ],
        }


@dataclass(frozen=True, eq=False)
class SyntheticTrack:
    """A synthetic track with its true activities.

    Attributes
    ----------
    frame : Columns time, lat, lon, speed_kn, course_deg, draught_m, mmsi, as in AIS.
    truth : One row for each activity: kind, start, end.
    current_factor : True current divided by that of the sea.
    """

    frame: pd.DataFrame
    truth: pd.DataFrame
    cycle: SyntheticCycle
    current_factor: float


def synthetic_track(
    cycle: SyntheticCycle,
    *,
    sea: Sea,
    start: TimeLike,
    cycles: int = 10,
    interval_s: float = 60.0,
    current_factor: float = 1.0,
    speed_noise: float = 0.0,
    seed: int = 0,
) -> SyntheticTrack:
    """Return the track of a ship that sails cycles through a sea, as AIS records it.

    Parameters
    ----------
    cycle : SyntheticCycle
    sea : Sea
        Its currents are multiplied by ``current_factor``.
    start : time
        Start of the first loading.
    cycles : int
        Number of cycles, at least 1; the last ends with the ship in the loading area.
    interval_s : float
        Time between messages [s].
    current_factor : float
    speed_noise : float
        Standard deviation of the speed through water from trip to trip, as a share of it.
    seed : int

    Returns
    -------
    SyntheticTrack

    Raises
    ------
    NoRouteError
        If the ship makes no progress against the current.
    InputError
        If a number is out of range, or the sea has no currents on the route.
    """
    if cycles < 1 or not interval_s > 0.0 or not 0.0 <= speed_noise < 1e4:
        raise InputError(
            f"A track has {cycles} cycles, an interval of {interval_s} s and a speed noise of "
            f"{speed_noise}.",
            "It has at least one cycle, a positive interval and no negative noise.",
            "Correct them.",
        )
    maker = _TrackSynthesiser(cycle, sea, current_factor, interval_s / _STEPS_PER_MESSAGE)
    random = np.random.default_rng(seed)
    time = parse_time(start)
    for _ in range(cycles):
        time = maker.work(time, cycle.loading_h, cycle.loading_place, "loading", 1.5 * KNOT)
        time = maker.trip(time, "sailing full", 1.0 + speed_noise * random.normal())
        time = maker.work(time, cycle.unloading_h, cycle.unloading_place, "unloading", 0.0)
        time = maker.trip(time, "sailing empty", 1.0 + speed_noise * random.normal())
    return maker.track(random)


class _TrackSynthesiser:
    """Computes positions in small steps and records them."""

    def __init__(self, cycle: SyntheticCycle, sea: Sea, factor: float, step: float) -> None:
        self.cycle, self.sea, self.factor, self.step = cycle, sea, factor, step
        self.rows: list[tuple[FloatArray, FloatArray, FloatArray]] = []
        self.activities: list[dict[str, Any]] = []

    def work(self, time: float, hours: float, place: Position, kind: str, speed: float) -> float:
        """Record work around a place, to and fro at a speed, and return when it ends."""
        count = max(2, math.ceil(hours * HOUR / self.step))
        at = np.arange(count, dtype=np.float64) * self.step
        reach = 0.5 * self.cycle.radius_nm * NAUTICAL_MILE
        east = reach * np.sin(speed / reach * at) * np.sin(np.pi * at / at[-1])
        lat, lon = direct(place[0], place[1], math.radians(90.0), east)
        self._record(time + at, lat, lon, kind)
        return time + count * self.step

    def trip(self, time: float, kind: str, share: float) -> float:
        """Record the geodesic between the places in small steps, and return the arrival."""
        full = kind == "sailing full"
        ends = (self.cycle.loading_place, self.cycle.unloading_place)
        start, goal = ends if full else ends[::-1]
        speed = (self.cycle.full_kn if full else self.cycle.empty_kn) * KNOT * share
        length, course, _ = (float(v) for v in inverse(*start, *goal))
        distances, done, passed = [], 0.0, 0.0
        while done < length:
            distances.append(done)
            lat, lon = direct(*start, course, done)
            done += self.step * self._speed_made_good(
                time + passed, float(lat), float(lon), goal, speed
            )
            passed += self.step
            if passed > _MAX_TRIP_DURATION:
                raise _no_progress_error(start, goal)
        lat, lon = direct(*start, course, np.array(distances))
        self._record(time + self.step * np.arange(len(distances), dtype=np.float64), lat, lon, kind)
        return time + passed

    def _speed_made_good(
        self, time: float, lat: float, lon: float, goal: Position, speed: float
    ) -> float:
        sampled = self.sea.sample([EASTWARD_CURRENT, NORTHWARD_CURRENT], time, lat, lon)
        flow = self.factor * complex(
            float(sampled[EASTWARD_CURRENT]), float(sampled[NORTHWARD_CURRENT])
        )
        if not math.isfinite(abs(flow)):
            raise InputError(
                f"The sea has no current at {lat:.3f}, {lon:.3f}.",
                "A synthetic track needs currents on its whole route.",
                "Use another sea, or fill values (Sea.filled).",
            )
        course = float(inverse(lat, lon, *goal)[1])
        turned = flow * complex(math.sin(course), -math.cos(course))  # along, to starboard
        cross, along = -turned.imag, turned.real
        if abs(cross) >= speed or math.sqrt(speed**2 - cross**2) + along <= 0.0:
            raise _no_progress_error((lat, lon), goal)
        return math.sqrt(speed**2 - cross**2) + along

    def _record(self, time: FloatArray, lat: FloatArray, lon: FloatArray, kind: str) -> None:
        self.rows.append((time, lat, lon))
        end = float(time[-1]) + self.step
        self.activities.append({"kind": kind, "start": float(time[0]), "end": end})

    def track(self, random: np.random.Generator) -> SyntheticTrack:
        """Return the recorded positions as messages."""
        import pandas as pd

        time, lat, lon = (np.concatenate(column) for column in zip(*self.rows))
        full = np.concatenate([np.full(len(r[0]), k % 4) for k, r in enumerate(self.rows)])
        length, course, _ = inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
        speed = np.append(length / np.diff(time), 0.0)
        take = np.arange(0, len(time), _STEPS_PER_MESSAGE)
        shift = self.cycle.position_noise_m * random.normal(size=(2, len(take)))
        seen_lat, seen_lon = direct(
            lat[take], lon[take], np.arctan2(shift[0], shift[1]), np.hypot(*shift)
        )
        frame = pd.DataFrame(
            {
                "time": pd.DatetimeIndex(to_datetime64(time[take])).tz_localize("UTC"),
                "lat": seen_lat.round(6),
                "lon": seen_lon.round(6),
                "speed_kn": (speed[take] / KNOT).round(1),
                "course_deg": np.degrees(np.append(course, 0.0)[take]).round(1),
                "draught_m": np.where(np.isin(full[take], (1, 2)), 8.0, 5.0),
                "mmsi": 244000000,
            }
        )
        truth = pd.DataFrame(self.activities)
        return SyntheticTrack(frame, truth, self.cycle, self.factor)


def _no_progress_error(start: Position, goal: Position) -> NoRouteError:
    return NoRouteError(
        f"The ship makes no progress from {start[0]:.3f}, {start[1]:.3f} to {goal[0]:.3f}, "
        f"{goal[1]:.3f} against the current.",
        "A synthetic track has no waits for the tide.",
        "Give the ship more speed, or a weaker current.",
    )


def _circle(place: Position, radius_nm: float, activity: str) -> dict[str, Any]:
    lat, lon = direct(*place, np.radians(np.arange(0.0, 361.0, 10.0)), radius_nm * NAUTICAL_MILE)
    ring = [[round(float(x), 6), round(float(y), 6)] for x, y in zip(lon, lat)]
    ring[-1] = ring[0]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"activity": activity}, "geometry": geometry}
