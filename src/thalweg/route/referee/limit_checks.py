"""Checks of a sailed track: violated limits and gaps in the data."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import Chart
from thalweg.core.errors import CoverageError, OutsideAreaError, OutsidePeriodError
from thalweg.core.geodesy import distance, format_position, positions_along
from thalweg.core.time import format_time
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels import codes
from thalweg.kernels.codes import REASONS
from thalweg.route.referee.land_clearance import offing_breaches
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    conditions_in_state,
)
from thalweg.route.route import SPEED_NOT_PREDICTED, Violation
from thalweg.route.track import Track
from thalweg.sea.standard_names import plain_names
from thalweg.ship.comfort.broken_seaway_limits import broken_seaway_limits
from thalweg.ship.condition_variables import (
    EASTWARD_WIND,
    NORTHWARD_WIND,
    WAVE_HEIGHT,
)
from thalweg.ship.conditions import Conditions
from thalweg.ship.models.known_speed_model import SpeedLossModel
from thalweg.ship.models.kwon_speed_loss import (
    LEAST_SPEED_SHARE,
    KwonSpeedLoss,
    predicted_share,
)

_PARTS_OF_LEG = 256  # that are looked at for where a leg first touches land
_LANE_TOLERANCE = 20.0  # legs may run against a traffic lane so far, at its corners [m]
_LIMIT_TOLERANCE = 1e-9  # for rounding, on every limit, in its own unit


def limit_violations(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    *,
    sampled: Mapping[str, FloatArray],
    depth: FloatArray,
    min_ukc: float,
) -> list[Violation]:
    """Return the violated limits and the gaps in the data, one for each stretch and reason.

    Parameters
    ----------
    points : In the order of sailing.
    time : [s since 1970-01-01T00:00Z]; NaN beyond a point the ship cannot pass.
    sampled : The sea at these points and times.
    depth : Water depth at these points and times [m].
    min_ukc : Least under-keel clearance [m].
    """
    reached = np.isfinite(time)
    found: list[Violation] = []
    for reason, excess, values, limit in _limit_checks(world, sampled, depth, min_ukc):
        with np.errstate(invalid="ignore"):
            bad = excess > _LIMIT_TOLERANCE
        for first, last in _stretches(bad & reached, points.leg):
            worst = first + int(np.argmax(np.abs(values[first:last] - limit)))
            found.append(_violation_at(reason, points, time, worst, float(values[worst]), limit))
    return found + _data_gap_violations(world, points, time, sampled)


def land_violations(
    world: SailingEnvironment,
    pieces: TrackPieces,
    times: FloatArray,
    ends_at: FloatArray,
) -> list[Violation]:
    """Return the legs that touch land or a no-go zone or leave the chart, each where it first does.

    Legs along port approaches may touch land. Legs nearer to land than the offing are found apart
    from the test of legs, at their worst place.
    """
    if world.chart is None:
        return []
    chart, track = world.chart, pieces.track
    ends = np.stack([track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:]])
    keeps_off = isinstance(chart, Chart) and chart.offing.distance > 0.0
    free: Any = chart.with_offing(0.0) if keeps_off else chart
    status = np.array(free.leg_status(*ends))
    approach = np.flatnonzero(pieces.canals.approach)
    found = []
    if keeps_off:
        checked = status == codes.OK
        checked[approach] = False
        found = _offing_violations(chart, track, (times, ends_at), checked)
    if len(approach):
        closed = chart.crosses_no_go_zone(*ends[:, approach])
        status[approach] = np.where(closed, codes.NO_GO, codes.OK)
    number, listed = track.leg_numbers, set[str]()
    for leg in np.flatnonzero(status != codes.OK):
        share = _first_closed(free, ends[:, leg])
        first_lat, first_lon, last_lat, last_lon = ends[:, leg]
        lat, lon = positions_along(first_lat, first_lon, last_lat, last_lon, share)
        reason = REASONS.get(int(status[leg]), REASONS[codes.LAND])
        where = f"{reason}: leg {number[leg]}"
        if where in listed:  # a part of the same leg of the given route
            continue
        listed.add(where)
        time = float(times[leg] + share * (ends_at[leg] - times[leg]))
        found.append(Violation(where, time, float(lat), float(lon)))
    return found


def _first_closed(chart: Any, ends: FloatArray) -> float:
    """Return the share of a leg (lat1, lon1, lat2, lon2) [deg] after which it is first closed."""
    lat1, lon1, lat2, lon2 = ends
    shares = np.linspace(0.0, 1.0, _PARTS_OF_LEG + 1)
    lat, lon = positions_along(lat1, lon1, lat2, lon2, shares)
    status = np.array(chart.leg_status(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    closed = np.flatnonzero(status != codes.OK)
    return float(closed[0] + 0.5) / _PARTS_OF_LEG if len(closed) else 0.5


def _offing_violations(
    chart: Chart, track: Track, times: tuple[FloatArray, FloatArray], checked: BoolArray
) -> list[Violation]:
    """Return the legs nearer to land than the offing, of those that are checked."""
    found = []
    for place, limit in offing_breaches(chart, track):
        leg = place.leg
        if not checked[leg]:
            continue
        begin, end = ((float(track.lat[k]), float(track.lon[k])) for k in (leg, leg + 1))
        length = float(distance(*begin, *end))
        share = float(distance(*begin, place.lat, place.lon)) / length if length > 0.0 else 0.0
        time = float(times[0][leg] + min(share, 1.0) * (times[1][leg] - times[0][leg]))
        reason = f"{REASONS[codes.OFFING]}: leg {track.leg_numbers[leg]}"
        found.append(Violation(reason, time, place.lat, place.lon, place.distance, limit))
    return found


def lane_violations(
    world: SailingEnvironment, pieces: TrackPieces, times: FloatArray, ends_at: FloatArray
) -> list[Violation]:
    """Return the legs that run against a traffic lane where that is forbidden, at their middle."""
    if world.chart is None or not world.chart.zones.lanes:
        return []
    track, group = pieces.track, world.chart.zones.lane_group
    lat, lon = np.asarray(track.lat, float), np.asarray(track.lon, float)
    length = np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    against: dict[tuple[int, int], float] = {}
    for leg, lane, share in zip(*group.shares_against(lat[:-1], lon[:-1], lat[1:], lon[1:])):
        if np.isinf(group.lanes[lane].factor) and pieces.canals.number[leg] < 0:
            key = int(leg), int(lane)
            against[key] = against.get(key, 0.0) + float(share * length[leg])
    found = []
    for (leg, lane), sailed in sorted(against.items()):
        if sailed > _LANE_TOLERANCE:
            y, x = positions_along(lat[leg], lon[leg], lat[leg + 1], lon[leg + 1], 0.5)
            reason = (
                f"against the traffic lane {group.lanes[lane].name}: leg {track.leg_numbers[leg]}"
            )
            middle = 0.5 * float(times[leg] + ends_at[leg])
            found.append(Violation(reason, middle, float(y), float(x)))
    return found


def canal_violations(
    world: SailingEnvironment, pieces: TrackPieces, times: FloatArray
) -> list[Violation]:
    """Return the canals that the ship may not pass, each at the entrance it takes."""
    beam = world.ship.breadth
    found = []
    for leg in pieces.canals.legs:
        why = pieces.canals.of(leg).transit_restriction(
            draught=world.ship.draught,
            beam=beam,
            length=world.ship.length,
            air_draught=world.ship.air_draught,
        )
        if why:
            place = (float(pieces.track.lat[leg]), float(pieces.track.lon[leg]))
            found.append(Violation(f"canal: {why}", float(times[leg]), *place))
    return found


def coverage_error(gaps: Sequence[Violation]) -> CoverageError:
    """Return the error for a route that leaves the data.

    Parameters
    ----------
    gaps : Its gaps in the data, of which those at the place of the last are named.
    """
    violation = gaps[-1]
    place = f"{format_position(violation.lat, violation.lon)} at {format_time(violation.time)}"
    here = [one for one in gaps if one.time == violation.time]
    names = sorted({one.reason.partition(": ")[2].partition(" (")[0] for one in here})
    words = plain_names(names)
    what = words if words == ", ".join(names) else f"{words} ({', '.join(names)})"
    kind, why = CoverageError, "The data have a gap there."
    if violation.reason.endswith("(period)"):
        kind, why = OutsidePeriodError, "That is outside the period of the data."
    elif violation.reason.endswith("(area)"):
        kind, why = OutsideAreaError, "That is outside the area of the data."
    return kind(
        f"The route runs to {place}, where the data have no {what}.",
        why,
        "Add data that cover it, or change the route or the departure. In Python, "
        "evaluate(..., strict=False) returns the route as far as it can be sailed.",
        lat=violation.lat,
        lon=violation.lon,
        time=violation.time,
    )


def is_data_gap(violation: Violation) -> bool:
    """Return whether a violation is one of missing data."""
    return violation.reason.startswith((REASONS[codes.NO_DATA], REASONS[codes.OUTSIDE_PERIOD]))


def stoppage_violations(
    world: SailingEnvironment, points: TrackPoints, time: FloatArray, motion: SailingState
) -> list[Violation]:
    """Return where the ship cannot continue, and the reason."""
    stopped = np.isnan(motion.speed_over_ground) & np.isfinite(time)
    known = ~np.isnan(motion.depth)
    for values in motion.sampled.values():
        known &= ~np.isnan(values)
    out_of_range = stopped & known & ~np.isfinite(motion.speed_through_water)
    current = stopped & known & ~out_of_range
    found = []
    for code, bad in ((codes.SHIP_RANGE, out_of_range), (codes.CURRENT, current)):
        for first, _ in _stretches(bad, points.leg):
            speed = float(motion.speed_through_water[first])
            found.append(_violation_at(REASONS[code], points, time, first, speed, math.nan))
    return found + _data_gap_violations(
        world, points, np.where(stopped, time, math.nan), motion.sampled
    )


def seaway_violations(
    world: SailingEnvironment, points: TrackPoints, time: FloatArray, motion: SailingState
) -> list[Violation]:
    """Return where the ship exceeds its limits of safety and comfort in waves, each limit apart."""
    safety = world.ship.limits.safety
    if safety is None:
        return []
    at = Conditions.from_sea(motion.sampled, heading=motion.heading)
    height, speed = at.wave_height, motion.speed_through_water
    bad = safety.forbids(
        speed, wave_angle=at.wave_angle, wave_height=height, wave_period=at.wave_period
    )
    index = np.flatnonzero(bad & np.isfinite(time) & np.isfinite(motion.speed_over_ground))
    waves = (np.broadcast_to(x, bad.shape)[index] for x in (at.wave_angle, height, at.wave_period))
    angle, height, period = waves
    found = []
    for one in broken_seaway_limits(
        safety, speed=speed[index], wave_angle=angle, wave_height=height, wave_period=period
    ):
        broken, value, limit = np.zeros(bad.shape, bool), np.zeros(bad.shape), np.zeros(bad.shape)
        broken[index], value[index], limit[index] = one.broken, one.value, one.limit
        reason = f"{REASONS[codes.SAFETY]}: {one.name}"
        for first, last in _stretches(broken, points.leg):
            worst = first + int(np.argmax(np.abs(value[first:last] - limit[first:last])))
            numbers = (float(value[worst]), float(limit[worst]))
            found.append(_violation_at(reason, points, time, worst, *numbers))
    return found


def unpredicted_speed_violations(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    motion: SailingState,
    at_sea: BoolArray,
) -> list[Violation]:
    """Return where a speed loss outside its range leaves too little of the speed to predict it.

    Parameters
    ----------
    at_sea : Which points are outside canals and approaches.
    """
    model = world.ship.model
    if not (isinstance(model, SpeedLossModel) and isinstance(model.loss, KwonSpeedLoss)):
        return []
    here = conditions_in_state(world, points, time, motion)
    here = here.with_default(load_factor=world.ship.loading.load_factor)
    speed = motion.speed_through_water
    share = predicted_share(model, here, points.setting, speed)
    bad = (share < LEAST_SPEED_SHARE) & at_sea & np.isfinite(time)
    return [
        _violation_at(
            SPEED_NOT_PREDICTED,
            points,
            time,
            first + int(np.argmin(share[first:last])),
            float(share[first:last].min()),
            LEAST_SPEED_SHARE,
        )
        for first, last in _stretches(bad, points.leg)
    ]


def limit_excesses(
    world: SailingEnvironment,
    sampled: Mapping[str, FloatArray],
    depth: FloatArray,
    min_ukc: float,
) -> list[FloatArray]:
    """Return by how much each limit is exceeded, in its own unit; below 0 where it is kept."""
    return [excess for _, excess, _, _ in _limit_checks(world, sampled, depth, min_ukc)]


def _limit_checks(
    world: SailingEnvironment,
    sampled: Mapping[str, FloatArray],
    depth: FloatArray,
    min_ukc: float,
) -> Iterator[tuple[str, FloatArray, FloatArray, float]]:
    """Yield of every limit its name, by how much it is exceeded, what is limited, and the limit."""
    limits, draught = world.ship.limits, world.ship.draught
    if world.has_depth:
        clearance = depth - draught
        yield REASONS[codes.DEPTH], min_ukc - clearance, clearance, min_ukc
    if math.isfinite(limits.wave_height):
        height = sampled[WAVE_HEIGHT]
        yield (REASONS[codes.WAVE_HEIGHT], height - limits.wave_height, height, limits.wave_height)
    if math.isfinite(limits.wind_speed):
        wind = np.hypot(sampled[EASTWARD_WIND], sampled[NORTHWARD_WIND])
        yield REASONS[codes.WIND_SPEED], wind - limits.wind_speed, wind, limits.wind_speed


def _data_gap_violations(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    sampled: Mapping[str, FloatArray],
) -> list[Violation]:
    """Return the stretches where data are missing, each at its first point."""
    reached = np.isfinite(time)
    missing = {name: np.isnan(values) for name, values in sampled.items()}
    if world.charted:
        missing["charted depth"] = np.isnan(points.charted)
    found = []
    for name, absent in missing.items():
        for first, _ in _stretches(absent & reached, points.leg):
            why = ""
            if name in sampled:
                place = (float(time[first]), float(points.lat[first]), float(points.lon[first]))
                why = f" ({world.sea.why_missing(name, *place)})"
            code = codes.OUTSIDE_PERIOD if why == " (period)" else codes.NO_DATA
            reason = f"{REASONS[code]}: {name}{why}"
            found.append(_violation_at(reason, points, time, first, math.nan, math.nan))
    return found


def _stretches(bad: BoolArray, leg: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Return (first, one past the last) of each run of bad points on one leg."""
    if not bad.any():
        return []
    edge = np.flatnonzero((bad[1:] != bad[:-1]) | (leg[1:] != leg[:-1])) + 1
    cuts = np.concatenate([[0], edge, [len(bad)]])
    return [(int(a), int(b)) for a, b in itertools.pairwise(cuts) if bad[a]]


def _violation_at(
    reason: str, points: TrackPoints, time: FloatArray, index: int, value: float, limit: float
) -> Violation:
    return Violation(
        reason, float(time[index]), float(points.lat[index]), float(points.lon[index]), value, limit
    )
