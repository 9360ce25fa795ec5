"""One trip along a fixed track for every departure: how long it takes and what it uses.

All departures are sailed side by side through the same small steps with the ship's own formulas,
as the referee does it for one, so that a table of thousands of departures costs about a second.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import CoverageError, InputError, MissingVariableError
from thalweg.core.geodesy import format_position
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.operations.waiting.trip_table import TripTable
from thalweg.route.referee.evaluation import RouteLike, as_track, resolve_settings
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints, cut_into_pieces
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    conditions_at,
    make_sailing_environment,
    sample_sea_and_depth,
    solve_sailing_state,
)
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.ship.condition_variables import EASTWARD_CURRENT, NORTHWARD_CURRENT
from thalweg.ship.conditions import Conditions

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

MIN_STEPS = 100  #: of every trip
MAX_DEPARTURES = 200_000  #: a table may hold
_MAX_POINTS_PER_CHUNK: Final = 200_000  # looked at in one go
_MAX_ITERATIONS: Final = 12  # of the iteration
_TIME_TOLERANCE: Final = 1e-3  # change of the time for a piece [s] that ends the iteration
_IMPASSABLE_TIME: Final = 1e9  # stands for the time [s] for a piece that cannot be passed
_CRAB_ITERATIONS: Final = (
    3  # corrections of the crab angle; each makes the error some 50 times smaller
)


def trip_table(
    route: RouteLike,
    *,
    ship: Ship,
    sea: Sea,
    start: TimeLike,
    end: TimeLike | None = None,
    period: float | None = None,
    step: float = 60.0,
    chart: Chart | None = None,
    min_ukc: float | None = None,
    name: str = "trip",
    setting: int = -1,
) -> TripTable:
    """Sail one trip for every departure of a window.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        What to sail, without waits.
    ship : Ship
        Loaded as it sails this trip. Its power must be known. A ship file with
        ``rudder: schless_2023`` gets that drag of the crab angle, too.
    sea : Sea
    start, end : time
        First and last departure.
    period : float, optional
        Instead of ``end``: the sea repeats itself after this time [s] (a single tide); the table
        then goes round. The step is fitted to it.
    step : float
        Time between departures [s], above 0.
    chart : Chart, optional
        For its depth.
    min_ukc : float, optional
        Least under-keel clearance [m]; departures that would meet less are no departures. Static
        draught; None: not looked at.
    name : str
    setting : int
        Speed setting of the ship on positions and files (whose waits and speeds are not taken); a
        Track brings its own.

    Returns
    -------
    TripTable

    Raises
    ------
    CoverageError
        If the sea or the chart does not tell what the ship meets (`MissingVariableError` for a
        variable, or the depth, that is in none of them).
    InputError
        If the power of the ship is unknown, or the window or step makes no sense.

    Notes
    -----
    Midpoint rule over at least 100 equal steps: of order two in the length of the steps.
    """
    first = parse_time(start)
    departs, step = _departures(first, end, period, step)
    track = as_track(route, first)
    if not hasattr(route, "setting") and not hasattr(route, "track"):
        settings = np.full(len(track) - 1, setting)
        track = track.replaced(setting=settings, speed=None, wait=None)
    ship, track = resolve_settings(ship, track)
    world = make_sailing_environment(ship, with_wind_speed(ship, sea), chart)
    check_depth_available(world)
    pieces = cut_into_pieces(track, float(track.lengths.sum()) / MIN_STEPS, 1)
    voyage = _TrackSimulation(world, pieces, _segment_midpoints(world, pieces), min_ukc)
    duration, energy = voyage.sail(departs)
    return TripTable(
        name=name,
        start=first,
        step=step,
        duration=duration,
        energy=energy,
        current=_first_current(world, pieces, departs),
        periodic=period is not None,
    )


def check_depth_available(world: SailingEnvironment) -> None:
    """Refuse a world without depth for a ship whose speed depends on it.

    Raises
    ------
    MissingVariableError
    """
    if "depth" in world.ship.reads and not world.has_depth:
        raise MissingVariableError(
            f"The speed of the ship {world.ship.name!r} depends on the depth of the water.",
            "Neither the sea nor a chart tells it.",
            "Add a sea with bed depth, or depth to the chart.",
            missing=["sea_floor_depth_below_geoid"],
        )


def _departures(
    first: float, end: TimeLike | None, period: float | None, step: float
) -> tuple[FloatArray, float]:
    if (end is None) == (period is None):
        raise InputError(
            "The departures of a trip need an end or a period.",
            "Give either end, or period for a sea that repeats itself.",
            "Give one of them.",
        )
    length = period if period is not None else parse_time(end) - first  # type: ignore[arg-type]
    if not (math.isfinite(step) and step > 0.0 and math.isfinite(length) and length >= step):
        raise InputError(
            f"Departures every {step:g} s over {length:g} s make no table.",
            "The step is positive and no longer than the window or period.",
            "Correct them.",
        )
    count = round(length / step) if period is not None else int(length / step + 1e-9) + 1
    if count > MAX_DEPARTURES:
        raise InputError(
            f"{count} departures are asked for.",
            f"A table holds at most {MAX_DEPARTURES}.",
            "Use a longer step or a shorter window.",
        )
    step = length / count if period is not None else step
    return first + step * np.arange(count, dtype=np.float64), step


def _segment_midpoints(world: SailingEnvironment, pieces: TrackPieces) -> TrackPoints:
    """Return the middle of every piece, with the least depth charted along it."""
    points = pieces.points(pieces.leg, pieces.start + 0.5 * pieces.step)
    if world.chart is None or not world.charted:
        return points
    low = pieces.points(pieces.leg, pieces.start)
    high = pieces.points(pieces.leg, pieces.start + pieces.step)
    depth = world.chart.depths.along(low.lat, low.lon, high.lat, high.lon)
    return replace(points, charted=np.asarray(depth, dtype=np.float64))


class _SpeedAndPower(NamedTuple):
    """Speed over ground [m/s], 0 where the ship cannot pass; power [W]; where that is unknown."""

    speed_over_ground: FloatArray
    power: FloatArray
    unknown: NDArray[np.bool_]


@dataclass(frozen=True)
class _TrackSimulation:
    """A track in pieces and what is sailed along it."""

    world: SailingEnvironment
    pieces: TrackPieces
    middles: TrackPoints
    min_ukc: float | None

    def sail(self, departs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (time [s], brake energy [J]) of every departure."""
        chunk = max(1, _MAX_POINTS_PER_CHUNK // len(self.pieces))
        parts = [self._sail(departs[i : i + chunk]) for i in range(0, len(departs), chunk)]
        duration, energy = (np.concatenate(column) for column in zip(*parts))
        if np.isnan(energy).any():
            raise InputError(
                f"The power of the ship {self.world.ship.name!r} is unknown.",
                "Energy needs a ship with a power: a resistance or a fuel and engine description.",
                "Choose a ship such as 'vox-olympia', or describe the engine in its file.",
            )
        return duration, energy

    def _sail(self, departs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Sail some departures: find when every piece is passed, all at once, by iteration."""
        shape = (len(self.pieces), len(departs))
        took = np.broadcast_to(self._guess(), shape).copy()
        power, unknown = np.zeros(shape), np.zeros(shape, dtype=bool)
        active = np.arange(len(departs))
        for _ in range(_MAX_ITERATIONS):
            spent = np.where(took[:, active] < _IMPASSABLE_TIME, took[:, active], self._guess())
            time = departs[active] + np.cumsum(spent, axis=0) - 0.5 * spent
            found = self._segment_times(np.arange(shape[0]), time)
            settled = np.abs(found[0] - took[:, active]).max(axis=0) < _TIME_TOLERANCE
            took[:, active], power[:, active], unknown[:, active] = found
            active = active[~settled]
            if not active.size:
                break
        else:  # limits that are kept or broken by seconds: piece by piece
            self._sail_sequentially(departs, active, (took, power, unknown))
        passes = took < _IMPASSABLE_TIME
        under_way = np.vstack([np.ones((1, shape[1]), bool), np.cumprod(passes, axis=0)[:-1] > 0])
        bad = np.argwhere((unknown & under_way).T)
        if bad.size:
            which, piece = bad[0]
            raise _missing_data_error(self.middles, int(piece), float(departs[which]))
        arrives = passes.all(axis=0)
        energy, duration = (power * took).sum(axis=0), took.sum(axis=0)
        return np.where(arrives, duration, math.inf), np.where(arrives, energy, math.inf)

    def _guess(self) -> FloatArray:
        """Return a first guess of the time for each piece [s], shape (pieces, 1)."""
        usual = float(self.world.ship.speeds[self.middles.setting[0]])
        return np.asarray(self.pieces.step[:, None] / (usual if usual > 0.0 else 5.0))

    def _segment_times(self, pieces: NDArray[np.int64], time: FloatArray) -> tuple[Any, ...]:
        """Return (time [s], power [W], whether unknown) for pieces, in their middle at times."""
        here = self.middles.part(np.repeat(pieces, time.shape[1]))
        look = self._speed_and_power(here, time.reshape(-1))
        ground = look.speed_over_ground.reshape(time.shape)
        with np.errstate(divide="ignore"):
            took = np.where(ground > 0.0, self.pieces.step[pieces, None] / ground, _IMPASSABLE_TIME)
        return took, look.power.reshape(time.shape), look.unknown.reshape(time.shape)

    def _sail_sequentially(
        self, departs: FloatArray, which: NDArray[np.int64], into: tuple[Any, ...]
    ) -> None:
        """Sail departures piece after piece, each timed by the one before it."""
        spent, clock = np.broadcast_to(self._guess()[0], which.shape), departs[which]
        before = self.pieces.step[0]
        for i, step in enumerate(self.pieces.step):
            found = self._segment_times(np.array([i]), (clock + 0.5 * spent * step / before)[None])
            spent = np.where(found[0][0] < _IMPASSABLE_TIME, found[0][0], spent * step / before)
            clock, before = clock + spent, step
            for column, values in zip(into, found):
                column[i, which] = values[0]

    def _speed_and_power(self, here: TrackPoints, time: FloatArray) -> _SpeedAndPower:
        """Return how the ship fares at points and times."""
        motion = solve_sailing_state(self.world, here, time)
        if self.world.ship.depends_on_crab_angle:
            motion, conditions = self._with_crab_angle(here, time, motion)
        else:
            conditions = self._conditions(here, time, motion)
        power = np.asarray(self.world.ship.power(conditions, here.setting), dtype=np.float64)
        unknown = np.isnan(motion.speed_through_water)
        for name in (EASTWARD_CURRENT, NORTHWARD_CURRENT):
            if name in motion.sampled:
                unknown |= np.isnan(motion.sampled[name])
        aground = motion.depth <= self.world.ship.draught
        unknown &= ~aground
        passes = np.isfinite(motion.speed_over_ground) & ~aground
        for name in ("wave_height", "wind_speed"):
            largest = getattr(self.world.ship.limits, name)
            if math.isfinite(largest):
                unknown |= np.isnan(conditions[name])
                passes &= conditions[name] <= largest
        safety = self.world.ship.limits.safety
        if safety is not None:
            passes &= ~safety.forbids(
                motion.speed_through_water,
                wave_angle=conditions.wave_angle,
                wave_height=conditions.wave_height,
                wave_period=conditions.wave_period,
            )
        if self.min_ukc is not None:
            unknown |= np.isnan(motion.depth)
            passes &= motion.depth - self.world.ship.draught >= self.min_ukc
        return _SpeedAndPower(np.where(passes, motion.speed_over_ground, 0.0), power, unknown)

    def _conditions(self, here: TrackPoints, time: FloatArray, motion: SailingState) -> Conditions:
        return conditions_at(
            self.world,
            here,
            time,
            sampled=motion.sampled,
            depth=motion.depth,
            heading=motion.heading,
        )

    def _with_crab_angle(
        self, here: TrackPoints, time: FloatArray, motion: SailingState
    ) -> tuple[SailingState, Conditions]:
        """Return the motion of a ship whose rudder drags when it crabs, and its conditions."""
        east, north = np.sin(here.course), np.cos(here.course)
        along = across = np.zeros(len(here))
        if self.world.has_current:
            current = [motion.sampled[n] for n in (EASTWARD_CURRENT, NORTHWARD_CURRENT)]
            along = current[0] * east + current[1] * north
            across = current[0] * north - current[1] * east
        for _ in range(_CRAB_ITERATIONS):
            with np.errstate(invalid="ignore", divide="ignore"):
                crab = -np.arcsin(across / motion.speed_through_water)
            motion = replace(motion, heading=(here.course + crab) % (2.0 * math.pi))
            conditions = self._conditions(here, time, motion).with_values(crab_angle=crab)
            speed = self.world.ship.speed_through_water(conditions, here.setting)
            motion = replace(motion, speed_through_water=np.asarray(speed, dtype=np.float64))
        with np.errstate(invalid="ignore"):
            ground = along + np.sqrt(motion.speed_through_water**2 - across**2)
        return replace(
            motion, speed_over_ground=np.where(ground > 0.0, ground, math.nan)
        ), conditions


def _missing_data_error(here: TrackPoints, i: int, depart: float) -> CoverageError:
    place = format_position(float(here.lat[i]), float(here.lon[i]))
    left = format_time(depart)
    return CoverageError(
        f"How the ship fares at {place} is not known, if it leaves at {left}.",
        "The sea and the chart must cover the track for every departure and the trip after it, "
        "and the ship's model must hold there.",
        "Use longer data or a shorter window, or ask for a filling by name (Sea.filled).",
        depart=left,
        position=place,
    )


def _first_current(
    world: SailingEnvironment, pieces: TrackPieces, departs: FloatArray
) -> FloatArray:
    """Return the current at the place of departure along the first course [m/s]."""
    if not world.has_current:
        return np.zeros(departs.shape)
    zero = np.zeros(1, dtype=np.int64)
    there = pieces.points(zero, np.zeros(1))
    sampled, _ = sample_sea_and_depth(
        world, there.part(np.zeros(len(departs), dtype=np.int64)), departs
    )
    east, north = sampled[EASTWARD_CURRENT], sampled[NORTHWARD_CURRENT]
    return np.asarray(east * np.sin(there.course[0]) + north * np.cos(there.course[0]))
