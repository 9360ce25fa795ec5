"""The sea and the depth under a ship that waits, at close times."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing import SailedTrack
from thalweg.route.referee.sailing_physics import SailingEnvironment, sample_sea_and_depth
from thalweg.route.route import Violation
from thalweg.route.track import Track

_MAX_INTERVAL = 300.0  # longest time between two samples of a wait [s]


@dataclass(frozen=True, eq=False)
class WaitConditions:
    """The conditions of one wait that the ship gets to.

    Attributes
    ----------
    index : Waypoint, and the leg after it.
    time : From begin to end [s since 1970], (n,).
    sampled : Sea variables by CF standard name [SI], each (n,).
    clearance : Under the keel [m], (n,); not finite where unknown.
    """

    index: int
    time: FloatArray
    sampled: Mapping[str, FloatArray]
    clearance: FloatArray


def wait_conditions(sailed: SailedTrack) -> list[WaitConditions]:
    """Return the conditions of every wait that the ship gets to, in order."""
    world, track = sailed.world, sailed.pieces.track
    arrive = sailed.leg_times()[1]
    begins = np.concatenate([[track.depart], arrive])
    found = []
    for index in np.flatnonzero(track.wait[:-1]).tolist():
        if not math.isfinite(begins[index]):
            continue
        count = 2 + int(track.wait[index] / _MAX_INTERVAL)
        time = begins[index] + np.linspace(0.0, track.wait[index], count)
        points = _repeated_waypoint(world, track, index, count)
        sampled, depth = sample_sea_and_depth(world, points, time)
        found.append(WaitConditions(index, time, sampled, depth - world.ship.draught))
    return found


def wait_samples(
    sailed: SailedTrack,
    waits: Sequence[WaitConditions],
    legs: Mapping[str, FloatArray],
    samples: Mapping[str, FloatArray],
) -> dict[str, FloatArray]:
    """Return the columns of samples for the waits; NaN where a value is unknown.

    A ship that waits lies still at the waypoint and burns the fuel of her hotel load. Her course is
    that of the leg after the wait, her heading is not known.

    Parameters
    ----------
    legs, samples : Of the route.
    """
    pieces, draught = sailed.pieces, sailed.world.ship.draught
    start = cumulative_sums(pieces.length)
    power = 0.0 if np.isfinite(samples["power"]).any() else math.nan
    columns: dict[str, list[FloatArray]] = {name: [np.zeros(0)] for name in samples}
    for one in waits:
        k, known = one.index, np.where(np.isfinite(one.clearance), one.clearance, math.nan)
        at_berth = k == 0 and not math.isnan(pieces.canals.speed[0])
        if at_berth:  # as on the approach that begins there, the sea does not count
            known = np.full(len(known), math.nan)
        own = {
            **({} if at_berth else one.sampled),
            "time": one.time,
            "leg": k,
            "lat": pieces.track.lat[k],
            "lon": pieces.track.lon[k],
            "distance": start[k],
            "course": pieces.course[k],
            "speed_through_water": 0.0,
            "speed_over_ground": 0.0,
            "depth": known + draught,
            "under_keel_clearance": known,
            "power": power,
            "fuel_rate": legs["waiting_fuel"][k] / pieces.track.wait[k],
        }
        for name, parts in columns.items():
            values = np.asarray(own.get(name, math.nan), float)
            parts.append(np.array(np.broadcast_to(values, one.time.shape)))
    found = {name: np.concatenate(parts) for name, parts in columns.items()}
    return found | {"leg": found["leg"].astype(np.int64)}  # type: ignore[dict-item]


def wait_depth_violations(
    track: Track, waits: Sequence[WaitConditions], min_ukc: float
) -> list[Violation]:
    """Return the waits under way during which there is too little water.

    Parameters
    ----------
    min_ukc : Least under-keel clearance [m].
    """
    found: list[Violation] = []
    for one in waits:
        worst = int(np.argmin(one.clearance))
        if not one.clearance[worst] >= min_ukc - 1e-9:
            place = (float(track.lat[one.index]), float(track.lon[one.index]))
            value = float(one.clearance[worst])
            reason = "under-keel clearance" if math.isfinite(value) else "no data: depth"
            found.append(
                Violation(f"{reason} (waiting)", float(one.time[worst]), *place, value, min_ukc)
            )
    return found


def _repeated_waypoint(
    world: SailingEnvironment, track: Track, index: int, count: int
) -> TrackPoints:
    """Return one waypoint, several times."""
    lat, lon = np.full(count, track.lat[index]), np.full(count, track.lon[index])
    charted = np.full(count, math.inf)
    if world.charted and world.chart is not None:
        charted[:] = np.asarray(world.chart.depths.at(track.lat[index], track.lon[index]), float)
    zero = np.zeros(count, dtype=np.int64)
    return TrackPoints(lat, lon, np.zeros(count), zero, zero, np.zeros(count), charted)
