"""The departure of a voyage that states none, and why it was chosen."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.geodesy import Position, distance, positions_along
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.sea.models.cyclone_layer import StormLayer

if TYPE_CHECKING:
    from thalweg.sea import Sea
    from thalweg.ship import Ship

_STEP = 3.0 * HOUR  # between the departures that are tried
_POINTS = 200  # of the direct route
_MARGIN = 1.1  # longest voyage over the direct route at the highest speed
_FAR = 500.0 * NAUTICAL_MILE  # beyond this distance the storm makes no difference


def default_departure(
    sea: Sea, start: Position, goal: Position, ship: Ship, speed: float | None = None
) -> tuple[float, str]:
    """Return a departure [s since 1970] for a voyage that states none, and the reason.

    In the modelled storm of the package that at which the ship, on the great circle, comes closest
    to the storm; else the first time of the data, or now for a sea without times.

    Parameters
    ----------
    start, goal : (lat, lon)
        Ends of the voyage [deg].
    speed : Ordered speed [m/s]; by default the highest of the ship.

    Returns
    -------
    departure : float
    reason : A sentence for the user.
    """
    starts = [row.start for row in sea.coverage() if row.start is not None]
    if not starts:
        now = float(round(time.time() / 60.0) * 60.0)
        return now, f"No departure is given: now, {format_time(now)}, is taken."
    first = max(starts)
    storms = [layer for layer in sea.layers if isinstance(layer, StormLayer)]
    if not storms:
        return (
            first,
            f"No departure is given: {format_time(first)} is taken, the first of the data.",
        )
    end = min(row.end for row in sea.coverage() if row.end is not None)
    speed = float(max(ship.speeds)) if speed is None else speed
    departure, nearest = _closest_to_storm(storms[0], (first, end), start, goal, speed)
    departure = departure if nearest <= _FAR else first
    reason = f"No departure is given: {format_time(departure)} is taken. "
    name = storms[0].track.name
    if nearest > _FAR:
        return departure, reason + (
            f"At no time does the storm ({name}) come closer to the direct route than "
            f"{nearest / NAUTICAL_MILE:.0f} nm: it hardly matters for this voyage."
        )
    return departure, reason + (
        f"Then the storm ({name}) passes {nearest / NAUTICAL_MILE:.0f} nm from a ship on the "
        "direct route. --depart sets another time."
    )


def _closest_to_storm(
    storm: StormLayer, period: tuple[float, float], start: Position, goal: Position, speed: float
) -> tuple[float, float]:
    """Return the departure with the least distance between ship and storm, and that distance."""
    length = float(distance(*start, *goal))
    fractions = np.linspace(0.0, 1.0, _POINTS)
    lat, lon = positions_along(*start, *goal, fractions)
    sailing = length / speed
    last = max(period[0], period[1] - _MARGIN * sailing)
    departures = np.arange(period[0], last + 1.0, _STEP)
    moments = departures[:, None] + fractions * sailing
    centre = storm.track.position(np.clip(moments, *storm.period))
    away = distance(lat, lon, centre[0], centre[1]).min(axis=1)
    best = int(np.argmin(away))
    return float(departures[best]), float(away[best])
