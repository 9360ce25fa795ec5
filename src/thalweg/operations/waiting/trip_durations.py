"""Duration and energy of a trip along a fixed track, for many departures.

All departures are computed together, in the same small steps and with the ship's own formulas, as
the referee does for one departure. A table of thousands of departures takes about a second.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import CoverageError, InputError, MissingVariableError
from thalweg.core.geodesy import format_position
from thalweg.core.time import TimeLike, format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.operations.waiting.departures import Departures
from thalweg.operations.waiting.trip_table import TripTable
from thalweg.route.referee.evaluation import RouteLike, as_track, resolve_settings
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints, cut_into_pieces
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    conditions_in_state,
    make_sailing_environment,
    sample_sea_and_depth,
    solve_sailing_state,
)
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.route.route import Route
from thalweg.route.track import Track
from thalweg.ship.condition_variables import (
    EASTWARD_CURRENT,
    EASTWARD_WIND,
    NORTHWARD_CURRENT,
    NORTHWARD_WIND,
)
from thalweg.ship.conditions import Conditions

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

MIN_STEPS = 100  #: steps along every trip
_MAX_POINTS_PER_CHUNK: Final = 200_000  # pieces times departures computed together
_MAX_ITERATIONS: Final = 12
_TIME_TOLERANCE: Final = 1e-3  # change of the time for a piece [s] that ends the iteration
_IMPASSABLE_TIME: Final = 1e9  # time [s] given to a piece that cannot be passed


def trip_table(
    route: RouteLike,
    *,
    ship: Ship,
    sea: Sea,
    departures: Departures,
    chart: Chart | None = None,
    min_ukc: float | None = None,
    name: str = "trip",
    setting: int = -1,
) -> TripTable:
    """Sail one trip for every departure.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        The track, without waits.
    ship : Ship
        At the load of this trip. Its power must be known. A ship file with
        ``rudder: schless_2023`` also gets that drag of the crab angle.
    sea : Sea
    departures : Departures
    chart : Chart, optional
        For its depth.
    min_ukc : float, optional
        Minimum under-keel clearance [m] at static draught; departures with less are left out.
        None: that of the ship file (0 where it has none), if the sea or the chart has depths.
    name : str
        Name of the trip in tables and plots.
    setting : int
        Speed setting of the ship, for positions and files (their waits and speeds are not used); a
        `Track` has its own.

    Returns
    -------
    TripTable

    Raises
    ------
    CoverageError
        If the sea or the chart lacks data that the ship needs (`MissingVariableError` for a
        variable, or the depth, that none of them has).
    InputError
        If the power of the ship is unknown.

    Notes
    -----
    Midpoint rule over at least 100 equal steps: the error is of second order in their length.
    """
    track = as_track(route, departures.first)
    if not isinstance(route, (Track, Route)):
        settings = np.full(len(track) - 1, setting)
        track = track.replaced(setting=settings, speed=None, wait=None)
    ship, track = resolve_settings(ship, track)
    environment = make_sailing_environment(ship, with_wind_speed(ship, sea), chart)
    check_depth_available(environment)
    if min_ukc is None and environment.has_depth:
        min_ukc = ship.min_under_keel_clearance
    pieces = cut_into_pieces(track, float(track.lengths.sum()) / MIN_STEPS, 1)
    midpoints = _segment_midpoints(environment, pieces)
    times = departures.times
    duration, energy = _TrackSimulation(environment, pieces, midpoints, min_ukc).sail(times)
    return TripTable(
        name=name,
        start=departures.first,
        step=departures.fitted_step,
        duration=duration,
        energy=energy,
        current=_first_current(environment, pieces, times),
        periodic=departures.period is not None,
    )


def trip_table_of_window(
    route: RouteLike,
    *,
    start: TimeLike,
    end: TimeLike | None = None,
    period: float | None = None,
    step: float = 60.0,
    **options: Any,
) -> TripTable:
    """Sail one trip for every departure of a window; the former signature of `trip_table`.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
    start, end, period, step : As in `Departures`.
    **options : As in `trip_table`.
    """
    return trip_table(route, departures=Departures(start, end, period, step), **options)


def check_depth_available(environment: SailingEnvironment) -> None:
    """Raise if the depth of the water is unknown and the ship's speed depends on it."""
    if "depth" in environment.ship.reads and not environment.has_depth:
        raise MissingVariableError(
            f"The speed of the ship {environment.ship.name!r} depends on the depth of the water.",
            "Neither the sea nor a chart provides it.",
            "Add a sea with bed depth, or depth to the chart.",
            missing=["sea_floor_depth_below_geoid"],
        )


def _segment_midpoints(environment: SailingEnvironment, pieces: TrackPieces) -> TrackPoints:
    """Return the middle of every piece, with the least charted depth along it."""
    points = pieces.points(pieces.leg, pieces.start + 0.5 * pieces.step)
    if environment.chart is None or not environment.charted:
        return points
    low = pieces.points(pieces.leg, pieces.start)
    high = pieces.points(pieces.leg, pieces.start + pieces.step)
    depth = environment.chart.depths.along(low.lat, low.lon, high.lat, high.lon)
    return replace(points, charted=np.asarray(depth, dtype=np.float64))


class _SpeedAndPower(NamedTuple):
    """Speed over ground [m/s], 0 where the ship cannot pass; power [W]; where that is unknown."""

    speed_over_ground: FloatArray
    power: FloatArray
    unknown: NDArray[np.bool_]


@dataclass(frozen=True)
class _TrackSimulation:
    """A track in pieces, and its simulation for many departures."""

    environment: SailingEnvironment
    pieces: TrackPieces
    middles: TrackPoints
    min_ukc: float | None

    def sail(self, departs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (time [s], brake energy [J]) of every departure."""
        chunk = max(1, _MAX_POINTS_PER_CHUNK // len(self.pieces))
        parts = [self._sail(departs[i : i + chunk]) for i in range(0, len(departs), chunk)]
        duration, energy = (np.concatenate(column) for column in zip(*parts))
        if np.isnan(energy).any():
            raise _unknown_power_error(self.environment.ship)
        return duration, energy

    def _sail(self, departs: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return (time [s], energy [J]) of some departures, by fixed-point iteration."""
        shape = (len(self.pieces), len(departs))
        piece_time = np.broadcast_to(self._guess(), shape).copy()
        power, unknown = np.zeros(shape), np.zeros(shape, dtype=bool)
        active = np.arange(len(departs))
        for _ in range(_MAX_ITERATIONS):
            spent = np.where(
                piece_time[:, active] < _IMPASSABLE_TIME, piece_time[:, active], self._guess()
            )
            time = departs[active] + np.cumsum(spent, axis=0) - 0.5 * spent
            found = self._segment_times(np.arange(shape[0]), time)
            settled = np.abs(found[0] - piece_time[:, active]).max(axis=0) < _TIME_TOLERANCE
            piece_time[:, active], power[:, active], unknown[:, active] = found
            active = active[~settled]
            if not active.size:
                break
        else:  # not converged (a limit holds or not within seconds): one piece after another
            self._sail_sequentially(departs, active, (piece_time, power, unknown))
        passes = piece_time < _IMPASSABLE_TIME
        under_way = np.vstack([np.ones((1, shape[1]), bool), np.cumprod(passes, axis=0)[:-1] > 0])
        bad = np.argwhere((unknown & under_way).T)
        if bad.size:
            which, piece = bad[0]
            raise _missing_data_error(self.middles, int(piece), float(departs[which]))
        arrives = passes.all(axis=0)
        energy, duration = (power * piece_time).sum(axis=0), piece_time.sum(axis=0)
        return np.where(arrives, duration, math.inf), np.where(arrives, energy, math.inf)

    def _guess(self) -> FloatArray:
        """Return a first guess of the time for each piece [s], shape (pieces, 1)."""
        usual = float(self.environment.ship.speeds[self.middles.setting[0]])
        return np.asarray(self.pieces.step[:, None] / (usual if usual > 0.0 else 5.0))

    def _segment_times(self, pieces: NDArray[np.int64], time: FloatArray) -> tuple[Any, ...]:
        """Return (time [s], power [W], whether unknown) of pieces, evaluated at their midpoints."""
        here = self.middles.part(np.repeat(pieces, time.shape[1]))
        look = self._speed_and_power(here, time.reshape(-1))
        ground = look.speed_over_ground.reshape(time.shape)
        with np.errstate(divide="ignore"):
            piece_time = np.where(
                ground > 0.0, self.pieces.step[pieces, None] / ground, _IMPASSABLE_TIME
            )
        return piece_time, look.power.reshape(time.shape), look.unknown.reshape(time.shape)

    def _sail_sequentially(
        self, departs: FloatArray, which: NDArray[np.int64], into: tuple[Any, ...]
    ) -> None:
        """Compute departures one piece after another, each from the time of the one before."""
        spent, clock = np.broadcast_to(self._guess()[0], which.shape), departs[which]
        before = self.pieces.step[0]
        for i, step in enumerate(self.pieces.step):
            found = self._segment_times(np.array([i]), (clock + 0.5 * spent * step / before)[None])
            spent = np.where(found[0][0] < _IMPASSABLE_TIME, found[0][0], spent * step / before)
            clock, before = clock + spent, step
            for column, values in zip(into, found):
                column[i, which] = values[0]

    def _speed_and_power(self, here: TrackPoints, time: FloatArray) -> _SpeedAndPower:
        """Return speed over ground and power at points and times."""
        motion = solve_sailing_state(self.environment, here, time)
        conditions = conditions_in_state(self.environment, here, time, motion)
        power = np.asarray(self.environment.ship.power(conditions, here.setting), dtype=np.float64)
        unknown = np.isnan(motion.speed_through_water)
        for name in (EASTWARD_CURRENT, NORTHWARD_CURRENT):
            if name in motion.sampled:
                unknown |= np.isnan(motion.sampled[name])
        aground = motion.depth <= self.environment.ship.draught
        unknown &= ~aground
        passes = np.isfinite(motion.speed_over_ground) & ~aground
        for name in ("wave_height", "wind_speed"):
            largest = getattr(self.environment.ship.limits, name)
            if math.isfinite(largest):
                met = _limited_quantity(name, conditions, motion)
                unknown |= np.isnan(met)
                passes &= met <= largest
        safety = self.environment.ship.limits.safety
        if safety is not None:
            passes &= ~safety.forbids(
                motion.speed_through_water,
                wave_angle=conditions.wave_angle,
                wave_height=conditions.wave_height,
                wave_period=conditions.wave_period,
            )
        if self.min_ukc is not None:
            unknown |= np.isnan(motion.depth)
            passes &= motion.depth - self.environment.ship.draught >= self.min_ukc
        return _SpeedAndPower(np.where(passes, motion.speed_over_ground, 0.0), power, unknown)


def _missing_data_error(here: TrackPoints, i: int, depart: float) -> CoverageError:
    place = format_position(float(here.lat[i]), float(here.lon[i]))
    left = format_time(depart)
    return CoverageError(
        f"The speed of the ship at {place} is not known for the departure at {left}.",
        "The sea and the chart must cover the track for every departure and the trip after it, "
        "and the ship's model must hold there.",
        "Use longer data, a shorter window, or fill values (Sea.filled).",
        depart=left,
        position=place,
    )


def _first_current(
    environment: SailingEnvironment, pieces: TrackPieces, departs: FloatArray
) -> FloatArray:
    """Return the current at the place of departure along the first course [m/s]."""
    if not environment.has_current:
        return np.zeros(departs.shape)
    zero = np.zeros(1, dtype=np.int64)
    there = pieces.points(zero, np.zeros(1))
    sampled, _ = sample_sea_and_depth(
        environment, there.part(np.zeros(len(departs), dtype=np.int64)), departs
    )
    east, north = sampled[EASTWARD_CURRENT], sampled[NORTHWARD_CURRENT]
    return np.asarray(east * np.sin(there.course[0]) + north * np.cos(there.course[0]))


def _limited_quantity(name: str, conditions: Conditions, motion: SailingState) -> FloatArray:
    """Return the wave height [m], or the wind over the ground [m/s], that a limit is for."""
    if name == "wind_speed":
        return np.hypot(motion.sampled[EASTWARD_WIND], motion.sampled[NORTHWARD_WIND])
    return np.asarray(conditions[name], float)


def _unknown_power_error(ship: Ship) -> InputError:
    """Return the error of a ship without power, with what its ship file lacks."""
    file = ship.file
    missing = ["engine.reference_power_kw"]
    if file.table is not None and file.models.calm_water in (None, "table"):
        missing = ["table.power_kw"]
        remedy = "add a column power_kw to its table [kW]"
    else:
        at = f"{float(ship.with_load_factor(1.0).speeds[-1]) / KNOT:.3g}"
        given = file.engine.reference_speed_kn
        remedy = "add engine: {reference_speed_kn: " + (at if given is None else f"{given:g}")
        remedy += ", reference_power_kw: ...}, the brake power at that speed [kW]"
        if file.models.calm_water not in (None, "cubic"):
            remedy += ", and set models: {calm_water: cubic}"
            missing.append("models.calm_water")
    return InputError(
        f"The power of the ship {ship.name!r} is unknown.",
        "The rules of waiting compare energy: that of the brake while the ship sails, and of the "
        "hotel load all the time.",
        f"In a ship file of your own, {remedy}; or choose a ship with power, such as vox-olympia.",
        missing=missing,
    )
