"""Assembly of a route: all results of a sailed track, and the limits it violates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.referee.check_points import CheckedPoints, checked_points
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints
from thalweg.route.referee.limit_checks import (
    canal_violations,
    land_violations,
    lane_violations,
    limit_violations,
    seaway_violations,
    stoppage_violations,
    unpredicted_speed_violations,
)
from thalweg.route.referee.method_ranges import method_range_notes
from thalweg.route.referee.onboard_indicators import motion_indicators
from thalweg.route.referee.pricing import ConsumptionRates, cost_breakdown
from thalweg.route.referee.sailing import SailedTrack, sailing_state_along
from thalweg.route.referee.sailing_physics import (
    SailingEnvironment,
    SailingState,
    conditions_in_state,
)
from thalweg.route.referee.surroundings import surroundings_columns
from thalweg.route.referee.wait_samples import (
    WaitConditions,
    wait_conditions,
    wait_depth_violations,
    wait_samples,
)
from thalweg.route.route import Route, Violation
from thalweg.route.track import Track
from thalweg.ship.consumption import engine_order
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.ship_assumptions import low_speed_notes

if TYPE_CHECKING:
    from thalweg.chart import Chart

WAITING_NOT_ALLOWED = "waiting not allowed"


def assemble_route(
    sailed: SailedTrack, min_ukc: float, tolerance: float, terms: FuelTerms
) -> Route:
    """Return the route of a sailed track, with every limit checked.

    Parameters
    ----------
    min_ukc : Least under-keel clearance [m].
    tolerance : Of the time of sailing [s].
    terms : Prices of fuel and time.
    """
    world, pieces = sailed.world, sailed.pieces
    points, time, order = _all_points(sailed)
    sampled_time = np.where(np.isfinite(time), time, pieces.track.depart)
    motion = sailing_state_along(world, pieces.canals, points, sampled_time)
    power, rate = _rates(world, pieces, points, time=sampled_time, motion=motion)
    checked = checked_points(sailed, points, time, min_ukc)
    waits = wait_conditions(sailed)
    violations, least = _check_limits(sailed, checked, waits, min_ukc)
    violations += stoppage_violations(world, points, time, motion)
    violations += seaway_violations(world, points, time, motion)
    under_way = pieces.canals.number[points.leg] < 0
    violations += unpredicted_speed_violations(world, points, time, motion, under_way)
    violations.sort(key=lambda item: item.time if math.isfinite(item.time) else math.inf)
    departs, arrives = sailed.leg_times()
    legs = {
        "length": pieces.length,
        "course": pieces.course,
        "depart": departs,
        "arrive": arrives,
        "under_keel_clearance": least,
        "ordered_speed": np.asarray(world.ship.speeds, float)[pieces.track.setting],
        "leg_kind": _leg_kinds(pieces),
    }
    spent = cost_breakdown(sailed, ConsumptionRates(rate[order], power[order]), terms)
    if np.any(pieces.track.wait) and world.has_depth:
        tolerance += checked.longest_interval()
    samples = _samples(sailed, points, time, motion=motion, rates=(power, rate))
    around, more = surroundings_columns(sailed, points, time, motion, min_ukc)
    columns, at_samples, notes = motion_indicators(sailed, points, time, motion)
    columns |= around
    for values in columns.values():
        values[~np.isfinite(arrives)] = math.nan
    samples |= at_samples
    outside = method_range_notes(world, points, time, motion, at_sea=under_way)
    assumptions = (*world.assumptions, *spent.notes, *outside)
    at_sea = legs["leg_kind"] == 0.0
    slowest = float(np.min(legs["ordered_speed"][at_sea], initial=math.inf))
    assumptions = (*assumptions, *notes, *more, *low_speed_notes(world.ship, slowest))
    legs |= {**spent.legs, **columns}
    return Route(
        pieces.track,
        legs,
        samples,
        tuple(violations),
        tolerance,
        assumptions,
        spent.zones,
        terms.prices(),
        engine_order(world.ship),
        wait_samples(sailed, waits, legs, samples),
    )


def _leg_kinds(pieces: TrackPieces) -> FloatArray:
    """Return the kind of every leg, as an index into `thalweg.route.route_tables.LEG_KINDS`."""
    in_canal = (pieces.canals.number >= 0).astype(float)
    return np.where(pieces.canals.approach, 2.0, in_canal)


def _check_limits(
    sailed: SailedTrack,
    checked: CheckedPoints,
    waits: Sequence[WaitConditions],
    min_ukc: float,
) -> tuple[list[Violation], FloatArray]:
    """Return the violations at close points, and the least clearance of every leg [m]."""
    world, track = sailed.world, sailed.pieces.track
    near, moments, depth = checked.points, checked.moments, checked.depth
    sampled = checked.sampled
    found = limit_violations(world, near, moments, sampled=sampled, depth=depth, min_ukc=min_ukc)
    # the first waypoint is a berth
    waits = [one for one in waits if one.index > 0] if world.has_depth else []
    found += wait_depth_violations(track, waits, min_ukc)
    found += waiting_violations(world.chart, track, sailed.leg_times()[1])
    found += canal_violations(world, sailed.pieces, sailed.leg_times()[0])
    found += lane_violations(world, sailed.pieces, *sailed.leg_times())
    found += land_violations(world, sailed.pieces, *sailed.leg_times())
    clearance = _finite(depth - world.ship.draught)
    least = _least_by_leg(near.leg, clearance, moments, len(track) - 1)
    for one in waits:  # a wait belongs to the leg after it
        least[one.index] = np.fmin(least[one.index], np.fmin.reduce(_finite(one.clearance)))
    return found, least


def _samples(
    sailed: SailedTrack,
    points: TrackPoints,
    time: FloatArray,
    *,
    motion: SailingState,
    rates: tuple[FloatArray, FloatArray],
) -> dict[str, FloatArray]:
    """Return the columns of the fine samples; NaN beyond the last point that is reached."""
    start = cumulative_sums(sailed.pieces.length)
    varying = {
        **motion.sampled,
        "time": time,
        "heading": motion.heading,
        "speed_through_water": motion.speed_through_water,
        "speed_over_ground": motion.speed_over_ground,
        "depth": _finite(motion.depth),
        "under_keel_clearance": _finite(motion.depth - sailed.world.ship.draught),
        "power": rates[0],
        "fuel_rate": rates[1],
    }
    reached = np.isfinite(time)
    return {
        "leg": points.leg,  # type: ignore[dict-item]
        "lat": points.lat,
        "lon": points.lon,
        "distance": start[points.leg] + points.along,
        "course": points.course,
        **{name: np.where(reached, values, math.nan) for name, values in varying.items()},
    }


def _all_points(sailed: SailedTrack) -> tuple[TrackPoints, FloatArray, IntArray]:
    """Return all points in the order of sailing, their times, and where the Gauss points are."""
    pieces, passage = sailed.pieces, sailed.passage
    last = pieces.last_of_leg()
    charted = np.concatenate([sailed.charted, sailed.charted[last]])
    ends = replace(pieces.ends(), charted=charted)
    arrive = passage.start[1:][last] - pieces.wait[last]
    fields = ("lat", "lon", "course", "setting", "leg", "along", "charted")
    both = TrackPoints(
        *(np.concatenate([getattr(sailed.gauss, f), getattr(ends, f)]) for f in fields)
    )
    time = np.concatenate([passage.inside.reshape(-1), passage.start[:-1], arrive])
    stop = passage.first_infeasible
    if stop < len(pieces):
        time[time > passage.inside[stop, int(np.argmax(passage.bad[stop]))]] = math.nan
    order = np.lexsort((both.along, both.leg))
    place = np.empty(len(both), dtype=np.int64)
    place[order] = np.arange(len(both))
    return both.part(order), time[order], place[: len(sailed.gauss)]


def _rates(
    world: SailingEnvironment,
    pieces: TrackPieces,
    points: TrackPoints,
    *,
    time: FloatArray,
    motion: SailingState,
) -> tuple[FloatArray, FloatArray]:
    """Return the brake power [W] and the fuel rate [kg/s] at points; NaN where not known."""
    here = conditions_in_state(world, points, time, motion)
    found = world.ship.power_and_fuel(here, points.setting)
    power, fuel = (np.array(np.broadcast_to(rate, len(points)), float) for rate in found)
    if pieces.canals.any:
        fixed = pieces.canals.number[points.leg] >= 0
        in_canals = pieces.canals.rates(world.ship)
        for rate, there in zip((power, fuel), in_canals):
            rate[fixed] = there[points.leg[fixed]]
    return power, fuel


def _least_by_leg(leg: IntArray, values: FloatArray, time: FloatArray, count: int) -> FloatArray:
    """Return the least known value on each leg as far as it is sailed; NaN where none is known."""
    least = np.full(count, math.inf)
    known = np.isfinite(values) & np.isfinite(time)
    np.minimum.at(least, leg[known], values[known])
    return np.where(np.isfinite(least), least, math.nan)


def _finite(values: FloatArray) -> FloatArray:
    return np.where(np.isfinite(values), values, math.nan)


def waiting_violations(chart: Chart | None, track: Track, arrive: FloatArray) -> list[Violation]:
    """Return the waits at waypoints where the chart allows none; the first waypoint is a berth.

    Parameters
    ----------
    arrive : When each leg ends [s since 1970], (legs,); NaN where the ship does not get.
    """
    waits = np.flatnonzero(track.wait[1:-1]) + 1
    if chart is None or not waits.size:
        return []
    allowed = chart.may_wait(track.lat[waits], track.lon[waits])
    return [
        Violation(
            WAITING_NOT_ALLOWED, float(arrive[k - 1]), float(track.lat[k]), float(track.lon[k])
        )
        for k in waits[~allowed]
        if np.isfinite(arrive[k - 1])
    ]
