"""Land, shoals and other ships along a sailed track, as columns of its legs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import HOUR
from thalweg.route.indicator_columns import (
    GROUNDING_MARGIN,
    INSHORE_DISTANCE,
    LAND_DISTANCE_CAP,
)
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing import SailedTrack
from thalweg.route.referee.sailing_physics import SailingState

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.zones.ship_traffic import ShipTraffic

_WAIT_STEP: Final = 0.5 * HOUR  # between two samples of the traffic while waiting
TRAFFIC_NOTE = "Expected encounters are not known: the traffic does not cover the whole route."


def surroundings_columns(
    sailed: SailedTrack,
    points: TrackPoints,
    time: FloatArray,
    motion: SailingState,
    min_ukc: float,
) -> tuple[dict[str, FloatArray], list[str]]:
    """Return columns of legs (`thalweg.route.indicator_columns`), and notes.

    Parameters
    ----------
    points : All fine samples, in the order of sailing.
    time : Their times [s]; NaN where not reached.
    motion : What the ship does there.
    min_ukc : Least under-keel clearance [m]: the safety contour is that of draught plus clearance.
    """
    world, count = sailed.world, len(sailed.pieces.length)
    leg = np.asarray(points.leg, np.int64)
    weights = time_weights(leg, time)
    legs: dict[str, FloatArray] = {}
    notes: list[str] = []
    chart = world.chart
    if chart is not None and hasattr(chart, "coastline"):
        required = world.ship.draught + min_ukc
        legs |= _land_columns(chart, sailed, points, weights, required)
    if world.has_depth:
        shallow = motion.depth < 2.0 * world.ship.draught
        known = np.where(np.isfinite(time), np.where(np.isnan(motion.depth), math.nan, shallow), 0)
        legs["shallow_time"] = leg_sums(leg, weights * known, count)
    traffic = getattr(chart, "traffic", None)
    if traffic is not None:
        at = (points.lat, points.lon, time)
        rate = traffic.rate(*at, motion.speed_over_ground)
        used = np.where(weights > 0.0, rate, 0.0)
        inside = np.where(weights > 0.0, traffic.in_zones(*at), 0.0)
        legs["encounters"] = leg_sums(leg, weights * used, count)
        legs["dense_traffic_time"] = leg_sums(leg, weights * inside, count)
        _add_waits(legs, sailed, traffic)
        if np.isnan(legs["encounters"]).any():
            notes.append(TRAFFIC_NOTE)
    return legs, notes


def time_weights(leg: IntArray, time: FloatArray) -> FloatArray:
    """Return the time that each sample stands for on its leg (trapezoidal rule) [s]."""
    step = np.diff(time)
    step = np.where((np.diff(leg) == 0) & np.isfinite(step), step, 0.0)
    return 0.5 * (np.concatenate([[0.0], step]) + np.concatenate([step, [0.0]]))


def leg_sums(leg: IntArray, values: FloatArray, count: int) -> FloatArray:
    """Return the sum of values on each leg."""
    return np.bincount(leg, weights=values, minlength=count).astype(np.float64)


def leg_maxima(leg: IntArray, values: FloatArray, count: int) -> FloatArray:
    """Return the greatest value on each leg; NaN where one is unknown."""
    most = np.full(count, -math.inf)
    with np.errstate(invalid="ignore"):
        np.maximum.at(most, leg, values)  # a NaN stays
    return np.where(np.isinf(most), math.nan, most)


def _land_columns(
    chart: Chart,
    sailed: SailedTrack,
    points: TrackPoints,
    weights: FloatArray,
    required: float,
) -> dict[str, FloatArray]:
    leg, count = np.asarray(points.leg, np.int64), len(sailed.pieces.length)
    shore = np.asarray(
        chart.coastline.shore_distance(points.lat, points.lon, cap=LAND_DISTANCE_CAP)
    )
    shore = np.minimum(shore, LAND_DISTANCE_CAP)
    near = (shore < INSHORE_DISTANCE).astype(np.float64)
    same = np.diff(leg) == 0
    along = np.where(same, np.diff(points.along), 0.0)
    length = leg_sums(leg[:-1], along * 0.5 * (near[1:] + near[:-1]), count)
    columns = {
        "land_distance": -leg_maxima(leg, -shore, count),
        "inshore_length": np.minimum(length, sailed.pieces.length),
        "inshore_time": leg_sums(leg, weights * near, count),
    }
    ground = shore
    if chart.has_depth:
        contour = chart.depths.safety_contour(required).distance(points.lat, points.lon)
        columns["contour_distance"] = -leg_maxima(leg, -contour, count)
        ground = np.minimum(shore, contour)  # unknown depth leaves the margin unknown
    close = np.where(np.isnan(ground), math.nan, ground < GROUNDING_MARGIN)
    close = np.where(weights > 0.0, close, 0.0)
    columns["near_ground_time"] = leg_sums(leg, weights * close, count)
    return columns


def _add_waits(legs: dict[str, FloatArray], sailed: SailedTrack, traffic: ShipTraffic) -> None:
    """Add the encounters of waits before each leg; the first waypoint is a berth."""
    track = sailed.pieces.track
    _, arrive = sailed.leg_times()
    for index in np.flatnonzero(track.wait[1:-1]) + 1:
        if not math.isfinite(arrive[index - 1]):
            continue
        steps = 2 + int(track.wait[index] / _WAIT_STEP)
        time = arrive[index - 1] + np.linspace(0.0, track.wait[index], steps)
        lat, lon = np.full(steps, track.lat[index]), np.full(steps, track.lon[index])
        rate = traffic.rate(lat, lon, time, np.zeros(steps))
        inside = traffic.in_zones(lat, lon, time).astype(float)
        legs["encounters"][index] += float(np.trapezoid(rate, time))
        legs["dense_traffic_time"][index] += float(np.trapezoid(inside, time))
