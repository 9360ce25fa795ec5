"""Where and when a track is closed: by too little water, or by a current too strong to stem.

After van Halem (2019), "Route optimization in dynamic currents", Fig. 4.1: distance along the track
against time, with the periods in which the ship cannot pass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray
from thalweg.route import Route
from thalweg.route.referee.leg_segments import TrackPieces, TrackPoints, cut_into_pieces
from thalweg.route.referee.sailing import sailing_state_along
from thalweg.route.referee.sailing_physics import (
    CURRENTS,
    SailingEnvironment,
    make_sailing_environment,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

POSITION_COUNT, TIME_COUNT = 240, 240
_SLACK = 1e-9  # tolerance of the clearance, as in the referee [m]


@dataclass(frozen=True, eq=False)
class Closures:
    """The open and closed periods of a track.

    Attributes
    ----------
    distance : Along the track [m], (S,).
    times : float64 array (T,) [s since 1970-01-01T00:00Z]
    shallow : Too little water, (S, T).
    strong : Enough water, but the ship cannot hold the course of the track in the current, (S, T).
    unknown : Depth or current unknown, (S, T).
    clearance : Under-keel clearance [m], (S, T); +inf without a source of depth, NaN where unknown.
    """

    distance: FloatArray
    times: FloatArray
    shallow: NDArray[np.bool_]
    strong: NDArray[np.bool_]
    unknown: NDArray[np.bool_]
    clearance: FloatArray

    @property
    def closed(self) -> NDArray[np.bool_]:
        """Where and when the ship cannot pass, or it is unknown whether it can."""
        return self.shallow | self.strong | self.unknown


def find_closures(
    route: Route,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    min_ukc: float = 0.0,
    times: FloatArray | None = None,
    places: int = POSITION_COUNT,
) -> Closures:
    """Return the open and closed periods along a track.

    Parameters
    ----------
    route : Route
        A route scored by the referee.
    ship, sea, chart
        As for `thalweg.evaluate`.
    min_ukc : float, optional
        Least under-keel clearance [m].
    times : float64 array (T,), optional
        [s since 1970]; by default from 5 % of the passage time before the departure to 25 % after
        the arrival.
    places : int, optional
        Approximate number of positions along the track; waypoints are included.

    Returns
    -------
    Closures
    """
    environment = make_sailing_environment(ship, sea, chart)
    pieces = cut_into_pieces(
        route.track, float(route.track.lengths.sum()) / max(places, 2), 1, chart
    )
    points = _segment_ends(environment, pieces)
    start = cumulative_sums(pieces.length)
    order = np.lexsort((points.along, points.leg))
    points = points.part(order)
    times = default_times(route) if times is None else np.asarray(times, float)
    shape = (len(points), len(times))
    wide = points.part(np.repeat(np.arange(shape[0]), shape[1]))
    motion = sailing_state_along(environment, pieces.canals, wide, np.tile(times, shape[0]))
    clearance = (motion.depth - environment.ship.draught).reshape(shape)
    lost = np.zeros(shape, bool)
    if environment.has_current:
        for name in CURRENTS:
            lost |= np.isnan(motion.sampled[name]).reshape(shape)
    sailed = (pieces.canals.number[points.leg] < 0)[:, None]  # canals are always open
    unknown = sailed & (lost | np.isnan(clearance))
    shallow = sailed & ~unknown & (clearance < min_ukc - _SLACK)
    stuck = np.isnan(motion.speed_over_ground) & np.isfinite(motion.speed_through_water)
    strong = sailed & stuck.reshape(shape) & ~unknown & ~shallow
    return Closures(start[points.leg] + points.along, times, shallow, strong, unknown, clearance)


def default_times(route: Route, count: int = TIME_COUNT) -> FloatArray:
    """Return times from 5 % of the passage time before departure to 25 % after arrival."""
    end = route.arrive if math.isfinite(route.arrive) else float(np.nanmax(route.samples["time"]))
    length = max(end - route.depart, 60.0)
    return np.linspace(route.depart - 0.05 * length, end + 0.25 * length, count)


def _segment_ends(environment: SailingEnvironment, pieces: TrackPieces) -> TrackPoints:
    """Return the ends of all pieces, with the charted depth at them."""
    points = pieces.ends()
    if environment.chart is None or not environment.charted:
        return points
    charted = np.asarray(environment.chart.depths.at(points.lat, points.lon), float)
    return replace(points, charted=charted)
