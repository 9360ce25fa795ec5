"""Motions on board along a sailed track, as columns of its legs."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import HOUR
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing import SailedTrack
from thalweg.route.referee.sailing_physics import SailingEnvironment, SailingState
from thalweg.route.referee.surroundings import leg_maxima, leg_sums, time_weights
from thalweg.ship.comfort.onboard_motions import (
    ROLL_NOTE,
    OnboardMotions,
    ShipMotions,
    onboard_motions,
)
from thalweg.ship.condition_variables import WAVE_EAST, WAVE_HEIGHT, WAVE_NORTH, WAVE_PERIOD
from thalweg.ship.conditions import Conditions

_WAVE_VARIABLES = (WAVE_HEIGHT, WAVE_PERIOD, WAVE_EAST, WAVE_NORTH)
_WAIT_STEP = 0.5 * HOUR  # between two samples of the sea while waiting
NO_WAVES_NOTE = "Motions on board are not known: the sea has no wave height, period and direction."
SHELTERED_NOTE = "Canals and harbour approaches count as without motions."


def motion_indicators(
    sailed: SailedTrack, points: TrackPoints, time: FloatArray, motion: SailingState
) -> tuple[dict[str, FloatArray], dict[str, FloatArray], list[str]]:
    """Return columns of legs and of samples, and notes.

    Parameters
    ----------
    points : All fine samples, in the order of sailing.
    time : Their times [s]; NaN where not reached.
    motion : What the ship does there.

    Returns
    -------
    legs : See `thalweg.route.indicator_columns`, (legs,); NaN where unknown.
    samples : dict of str to float64 array
        ``weighted_acceleration:NAME`` and ``acceleration:NAME`` [m/s2] by place, where the
        ship has places.
    notes : list of str
    """
    world, count = sailed.world, len(sailed.pieces.length)
    leg = np.asarray(points.leg, np.int64)
    weights = time_weights(leg, time)
    legs: dict[str, FloatArray] = {}
    samples: dict[str, FloatArray] = {}
    notes: list[str] = []
    own = onboard_motions(world.ship)
    if own is not None:
        found, known_waves = _motions_at(world, own, points, time, motion)
        if not known_waves:
            notes.append(NO_WAVES_NOTE)
        if own.roll_period is None:
            notes.append(ROLL_NOTE)
        sheltered = np.isin(leg, np.flatnonzero(_sheltered_legs(sailed)))
        if sheltered.any():
            notes.append(SHELTERED_NOTE)
        legs |= _motion_columns(own, found, leg, weights, sheltered, count)
        for name, at in found.places.items():
            legs[f"squared_dose:{name}"] += _waiting_dose(sailed, own, name)
            samples[f"weighted_acceleration:{name}"] = np.where(sheltered, 0.0, at.weighted)
            samples[f"acceleration:{name}"] = np.where(sheltered, 0.0, at.acceleration)
    return legs, samples, notes


def _sheltered_legs(sailed: SailedTrack) -> BoolArray:
    canals = sailed.pieces.canals
    return (canals.number >= 0) | np.asarray(canals.approach, bool)


def _motions_at(
    world: SailingEnvironment,
    own: OnboardMotions,
    points: TrackPoints,
    time: FloatArray,
    motion: SailingState,
) -> tuple[ShipMotions, bool]:
    """Return the motions at the samples, and whether the sea has waves at all."""
    waves = _waves(world, points.lat, points.lon, time, motion.sampled)
    if waves is None:
        nothing = np.full(len(time), math.nan)
        return own.at(nothing, wave_angle=nothing, wave_height=nothing, wave_period=nothing), False
    at = Conditions.from_sea(waves, heading=motion.heading)
    return own.at(
        motion.speed_through_water,
        wave_angle=at.wave_angle,
        wave_height=at.wave_height,
        wave_period=at.wave_period,
    ), True


def _waves(
    world: SailingEnvironment,
    lat: FloatArray,
    lon: FloatArray,
    time: FloatArray,
    sampled: dict[str, FloatArray],
) -> dict[str, FloatArray] | None:
    """Return height, period and direction of the waves; None where the sea lacks one of them."""
    if not all(name in sampled or name in world.sea.variables for name in _WAVE_VARIABLES):
        return None
    known = {name: sampled[name] for name in _WAVE_VARIABLES if name in sampled}
    missing = tuple(name for name in _WAVE_VARIABLES if name not in sampled)
    if missing:
        reached = np.isfinite(time)
        found = world.sea.sample(missing, time[reached], lat[reached], lon[reached])
        for name in missing:
            known[name] = np.full(len(time), math.nan)
            known[name][reached] = found[name]
    return known


def _motion_columns(
    own: OnboardMotions,
    found: ShipMotions,
    leg: IntArray,
    weights: FloatArray,
    sheltered: BoolArray,
    count: int,
) -> dict[str, FloatArray]:
    def calm(values: FloatArray) -> FloatArray:
        return np.where(sheltered, 0.0, values)

    columns = {
        "heave": leg_maxima(leg, calm(found.heave), count),
        "pitch": leg_maxima(leg, calm(found.pitch), count),
        "roll": leg_maxima(leg, calm(found.roll), count),
    }
    for name, at in found.places.items():
        squared = np.where(weights > 0.0, calm(at.weighted) ** 2, 0.0)
        columns[f"squared_dose:{name}"] = leg_sums(leg, weights * squared, count)
        columns[f"weighted_acceleration:{name}"] = leg_maxima(leg, calm(at.weighted), count)
        columns[f"acceleration:{name}"] = leg_maxima(leg, calm(at.acceleration), count)
        columns[f"velocity:{name}"] = leg_maxima(leg, calm(at.velocity), count)
        columns[f"displacement:{name}"] = leg_maxima(leg, calm(at.displacement), count)
    for task in own.tasks:
        good, known = own.workable(task, found)
        share = np.where(known | sheltered, (good | sheltered).astype(float), math.nan)
        share = np.where(weights > 0.0, share, 0.0)
        columns[f"workable_time:{task}"] = leg_sums(leg, weights * share, count)
    return columns


def _waiting_dose(sailed: SailedTrack, own: OnboardMotions, place: str) -> FloatArray:
    """Return the squared dose of the waits before every leg; the ship lies head to sea.

    The wait at the first waypoint counts nothing: she is at her berth.
    """
    world, track = sailed.world, sailed.pieces.track
    count = len(track) - 1
    total = np.zeros(count)
    _, arrive = sailed.leg_times()
    sheltered = _sheltered_legs(sailed)
    for index in np.flatnonzero(track.wait[1:-1]) + 1:
        if not math.isfinite(arrive[index - 1]) or sheltered[index] or sheltered[index - 1]:
            continue
        steps = 2 + int(track.wait[index] / _WAIT_STEP)
        time = arrive[index - 1] + np.linspace(0.0, track.wait[index], steps)
        lat, lon = np.full(steps, track.lat[index]), np.full(steps, track.lon[index])
        waves = _waves(world, lat, lon, time, {})
        if waves is None:
            total[index] = math.nan
            continue
        lying = own.at(
            0.0,
            wave_angle=0.0,
            wave_height=waves[WAVE_HEIGHT],
            wave_period=waves[WAVE_PERIOD],
        )
        squared = lying.places[place].weighted ** 2
        total[index] = float(np.trapezoid(squared, time))
    return total
