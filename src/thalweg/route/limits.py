"""Which limits a sailed track breaks, and where the data do not reach."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import CoverageError, OutsideAreaError, OutsidePeriodError
from thalweg.core.geodesy import FloatArray, along, format_position
from thalweg.core.time import format_time
from thalweg.kernels import codes
from thalweg.kernels.codes import REASONS
from thalweg.route.physics import Motion, World
from thalweg.route.pieces import Points
from thalweg.route.route import Violation
from thalweg.route.track import Track

BoolArray = NDArray[np.bool_]
_SLACK = 1e-9  # rounding allowed on every limit, in its own unit


def find_violations(
    world: World, points: Points, time: FloatArray, *, motion: Motion, min_ukc: float | None
) -> list[Violation]:
    """Return what is wrong at consecutive points, one record for each stretch and reason.

    Parameters
    ----------
    world : World
    points : Points
        In the order of sailing.
    time : ndarray
        [s since 1970-01-01T00:00Z]; NaN behind a point the ship does not get past.
    motion : Motion
        At those points and times.
    min_ukc : float or None
        Least under-keel clearance [m]; None: depth is not looked at.
    """
    reached = np.isfinite(time)
    found: list[tuple[int, Violation]] = []
    for reason, bad, values, limit in _checks(world, motion, min_ukc):
        for first, last in _stretches(bad & reached, points.leg):
            worst = first + _worst(values[first:last], limit)
            found.append((first, _record(reason, points, time, worst, float(values[worst]), limit)))
    found += _gaps(world, points, time, motion, reached)
    found += _stopped(world, points, time, motion)
    return [violation for _, violation in sorted(found, key=lambda item: item[0])]


def land_violations(world: World, track: Track, times: FloatArray) -> list[Violation]:
    """Return the legs that touch land or a no-go zone or leave the chart, each at its middle."""
    if world.chart is None:
        return []
    status = world.chart.leg_status(track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:])
    found = []
    for leg in np.flatnonzero(np.asarray(status) != codes.OK):
        ends = (track.lat[leg], track.lon[leg], track.lat[leg + 1], track.lon[leg + 1])
        lat, lon = along(*ends, 0.5)
        reason = REASONS.get(int(status[leg]), REASONS[codes.LAND])
        where = f"{reason}: leg {leg + 1}"
        found.append(Violation(where, float(times[leg]), float(lat), float(lon)))
    return found


def coverage_error(violation: Violation) -> CoverageError:
    """Return the error for a route that runs off the data."""
    place = f"{format_position(violation.lat, violation.lon)} at {format_time(violation.time)}"
    what = violation.reason.partition(": ")[2]
    kind = CoverageError
    if violation.reason.endswith("(period)"):
        kind = OutsidePeriodError
    elif violation.reason.endswith("(area)"):
        kind = OutsideAreaError
    return kind(
        f"The route runs to {place}, where the data do not know {what}.",
        "Up to there it can be scored.",
        "Add a dataset that covers it, sail elsewhere, or ask for a partial answer (strict=False).",
        lat=violation.lat,
        lon=violation.lon,
        time=violation.time,
    )


def is_gap(violation: Violation) -> bool:
    """Return whether a violation is one of missing data."""
    return violation.reason.startswith((REASONS[codes.NO_DATA], REASONS[codes.OUTSIDE_PERIOD]))


def _checks(
    world: World, motion: Motion, min_ukc: float | None
) -> Iterator[tuple[str, BoolArray, FloatArray, float]]:
    limits, draught = world.ship.limits, world.ship.draught
    with np.errstate(invalid="ignore"):
        if min_ukc is not None and world.has_depth:
            clearance = motion.depth - draught
            yield REASONS[codes.DEPTH], clearance < min_ukc - _SLACK, clearance, min_ukc
        if math.isfinite(limits.wave_height):
            height = motion.sampled["sea_surface_wave_significant_height"]
            bad = height > limits.wave_height + _SLACK
            yield REASONS[codes.WAVE_HEIGHT], bad, height, limits.wave_height
        if math.isfinite(limits.wind_speed):
            wind = relative_wind(motion)
            yield (
                REASONS[codes.WIND_SPEED],
                wind > limits.wind_speed + _SLACK,
                wind,
                limits.wind_speed,
            )


def relative_wind(motion: Motion) -> FloatArray:
    """Return the speed of the wind relative to the moving water [m/s]."""
    sampled = motion.sampled
    zero = np.zeros_like(motion.depth)
    east = sampled["eastward_wind"] - sampled.get("eastward_sea_water_velocity", zero)
    north = sampled["northward_wind"] - sampled.get("northward_sea_water_velocity", zero)
    return np.hypot(east, north)


def _gaps(
    world: World, points: Points, time: FloatArray, motion: Motion, reached: BoolArray
) -> list[tuple[int, Violation]]:
    found = []
    named = {name: np.isnan(values) for name, values in motion.sampled.items()}
    if world.has_depth and world.charted:
        named["charted depth"] = np.isnan(points.charted)
    for name, missing in named.items():
        for first, _ in _stretches(missing & reached, points.leg):
            why = ""
            if name in motion.sampled:
                place = (float(time[first]), float(points.lat[first]), float(points.lon[first]))
                why = f" ({world.sea.why_missing(name, *place)})"
            code = codes.OUTSIDE_PERIOD if why == " (period)" else codes.NO_DATA
            reason = f"{REASONS[code]}: {name}{why}"
            found.append((first, _record(reason, points, time, first, math.nan, math.nan)))
    return found


def _stopped(
    world: World, points: Points, time: FloatArray, motion: Motion
) -> list[tuple[int, Violation]]:
    """Return why the ship cannot go on although every datum is there."""
    known = np.ones(len(points), dtype=bool)
    for values in motion.sampled.values():
        known &= ~np.isnan(values)
    known &= ~np.isnan(motion.depth)
    stopped = np.isnan(motion.over_ground) & known & np.isfinite(time)
    out_of_range = stopped & ~np.isfinite(motion.through_water)
    found = []
    for code, bad in ((codes.SHIP_RANGE, out_of_range), (codes.CURRENT, stopped & ~out_of_range)):
        for first, _ in _stretches(bad, points.leg):
            speed = float(motion.through_water[first])
            found.append((first, _record(REASONS[code], points, time, first, speed, math.nan)))
    return found


def _stretches(bad: BoolArray, leg: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Return (first, one past the last) of each run of bad points on one leg."""
    if not bad.any():
        return []
    edge = np.flatnonzero((bad[1:] != bad[:-1]) | (leg[1:] != leg[:-1])) + 1
    cuts = np.concatenate([[0], edge, [len(bad)]])
    return [(int(a), int(b)) for a, b in itertools.pairwise(cuts) if bad[a]]


def _worst(values: FloatArray, limit: float) -> int:
    return int(np.argmax(np.abs(values - limit)))


def _record(
    reason: str, points: Points, time: FloatArray, index: int, value: float, limit: float
) -> Violation:
    return Violation(
        reason, float(time[index]), float(points.lat[index]), float(points.lon[index]), value, limit
    )
