"""Speeds that a ship model predicts along a measured track, by setting or by measured power."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.operations.tracks.track_calibration import mean_speeds
from thalweg.operations.tracks.track_cleaning import TrackLog
from thalweg.operations.tracks.track_segments import SAILING_KINDS, MeasuredSegments
from thalweg.operations.waiting.trip_durations import check_depth_available
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    conditions_at,
    make_sailing_environment,
    sample_sea_and_depth,
    solve_sailing_state,
)
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.ship.conditions import Conditions

if TYPE_CHECKING:
    from thalweg.sea import Sea
    from thalweg.ship import Ship

_MAX_BISECTIONS = 40
_MOST_ABOVE = 1.5  # times its greatest speed a ship may be compared at
_MAX_SPEED = 25.0  #: highest speed through water considered at a power [m/s]


def predicted_speeds_through_water(
    segments: MeasuredSegments, ship: Ship, sea: Sea, *, speed_kn: float | None = None
) -> FloatArray:
    """Return the speed through water [m/s] that a ship model gives on every segment.

    Parameters
    ----------
    ship : Full while sailing full (load factor 1), empty while sailing empty (0).
    speed_kn : Ordered speed; by default, for each activity, the setting of the ship whose
        calm-water speed is nearest to the measured speed through water.

    Returns
    -------
    ndarray : NaN where the sea lacks data that the model needs.
    """
    speeds = np.full(len(segments), np.nan)
    for kind, (loaded, setting) in ordered_settings(segments, ship, speed_kn=speed_kn).items():
        own = segments.kind == SAILING_KINDS.index(kind)
        environment = make_sailing_environment(loaded, with_wind_speed(loaded, sea), None)
        check_depth_available(environment)
        here = segments.part(own)
        speeds[own] = solve_sailing_state(
            environment, _segment_points(here, setting), here.time
        ).speed_through_water
    return speeds


def ordered_settings(
    segments: MeasuredSegments, ship: Ship, *, speed_kn: float | None = None
) -> dict[str, tuple[Ship, int]]:
    """Return the loaded ship and its setting for each activity that occurs.

    Parameters as in `predicted_speeds_through_water`.
    """
    settings = {}
    wanted = mean_speeds(segments, 1.0)
    wanted = np.where(np.isfinite(wanted), wanted, mean_speeds(segments, 0.0))
    for index, load_factor in ((0, 1.0), (1, 0.0)):
        own = segments.kind == index
        if not own.any():
            continue
        loaded = ship.with_load_factor(load_factor)
        if speed_kn is not None:
            _check_ordered_speed(loaded, speed_kn)
            loaded = loaded.with_speeds([speed_kn * KNOT])
        setting = int(np.argmin(np.abs(loaded.speeds - wanted[own][0])))
        settings[SAILING_KINDS[index]] = (loaded, setting)
    return settings


def _check_ordered_speed(ship: Ship, speed_kn: float) -> None:
    """Raise `InputError` for a speed far above the greatest that the ship can order."""
    top = ship.greatest_order() / KNOT
    if speed_kn <= top * _MOST_ABOVE:
        return
    raise InputError(
        f"The ship {ship.name!r} cannot order {speed_kn:g} kn.",
        f"Her greatest speed at this load is {top:.1f} kn.",
        "Order at most that, or leave the speed out.",
        field="speed_kn",
    )


def speeds_at_measured_power(
    log: TrackLog, segments: MeasuredSegments, ship: Ship, sea: Sea
) -> FloatArray | None:
    """Return the speed through water [m/s] at the measured power, as Schless (2023) validated.

    Parameters
    ----------
    log : With ``power``, the brake power [W]; its ``draught``, where known, sets the load factor.
    ship : A model composed of resistance and propulsion.
    sea : With what the resistance needs (wind, waves, depth).

    Returns
    -------
    ndarray or None : NaN where the power or the sea is unknown or no speed up to 25 m/s takes that
        power; None if the log has no power or the model of the ship has no resistance.

    Notes
    -----
    The heading is assumed to be the course over ground. By bisection, because power against speed
    may be discontinuous in shallow water.
    """
    if "power" not in log.values or not ship.is_resistance_based:
        return None
    power = segment_means(log, segments, "power")
    environment = make_sailing_environment(ship, with_wind_speed(ship, sea), None)
    check_depth_available(environment)
    points = _segment_points(segments, 0)
    met = _conditions(environment, points, segments.time)
    met = met.with_values(load_factor=_load_factors(log, segments, ship))
    low, high = np.zeros(len(segments)), np.full(len(segments), _MAX_SPEED)
    with np.errstate(invalid="ignore"):
        for _ in range(_MAX_BISECTIONS):
            middle = 0.5 * (low + high)
            needed = ship.power_at_speed(met, middle)
            enough = ~(needed > power)  # also beyond the range of a method: search lower speeds
            low = np.where(enough & np.isfinite(needed), middle, low)
            high = np.where(enough & np.isfinite(needed), high, middle)
        reached = ship.power_at_speed(met, np.maximum(low, 1e-3))
        close = (np.abs(reached - power) < 0.02 * power) & (low > 0.0)
    return np.where(close, low, np.nan)


def segment_means(log: TrackLog, segments: MeasuredSegments, name: str) -> FloatArray:
    """Return the mean over each segment of a measured value; NaN where it is unknown."""
    values = log.values[name]
    known = np.isfinite(values)
    sums = cumulative_sums(np.where(known, values, 0.0))
    counts = cumulative_sums(known)
    first = np.searchsorted(log.time, segments.time - 0.5 * segments.duration - 1e-6)
    last = np.searchsorted(log.time, segments.time + 0.5 * segments.duration + 1e-6)
    count = counts[last] - counts[first]
    return np.where(count > 0, (sums[last] - sums[first]) / np.maximum(count, 1), np.nan)


def _segment_points(segments: MeasuredSegments, setting: int) -> TrackPoints:
    zero = np.zeros(len(segments), dtype=np.int64)
    return TrackPoints(
        lat=segments.lat,
        lon=segments.lon,
        course=segments.course,
        setting=zero + setting,
        leg=zero,
        along=np.zeros(len(segments)),
        charted=np.full(len(segments), math.inf),
    )


def _conditions(
    environment: SailingEnvironment, points: TrackPoints, time: FloatArray
) -> Conditions:
    sampled, depth = sample_sea_and_depth(environment, points, time)
    return conditions_at(
        environment, points, time, sampled=sampled, depth=depth, heading=points.course
    )


def _load_factors(log: TrackLog, segments: MeasuredSegments, ship: Ship) -> FloatArray:
    """Return load factors: from the measured draught, else 1 while full and 0 while empty."""
    assumed = np.where(segments.kind == 0, 1.0, 0.0)
    deep, light = (ship.with_load_factor(f).draught for f in (1.0, 0.0))
    if "draught" not in log.values or deep <= light:
        return assumed
    measured = (segment_means(log, segments, "draught") - light) / (deep - light)
    rounded = np.round(np.clip(measured, 0.0, 1.0), 2)  # few distinct loads, each computed once
    return np.where(np.isfinite(measured), rounded, assumed)
