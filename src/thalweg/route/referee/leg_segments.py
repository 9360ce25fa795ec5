"""Cutting a track into short pieces along its geodesics."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import WGS84, inverse, wrap_longitude
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.canal_legs import CanalLegs, canal_legs
from thalweg.route.track import Track

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.ship import Ship


#: Gauss-Legendre nodes of two points on [0, 1] (Hairer, Norsett & Wanner 1993, table II.7.3)
GAUSS_NODES = np.array([0.5 - math.sqrt(3.0) / 6.0, 0.5 + math.sqrt(3.0) / 6.0])


@dataclass(frozen=True)
class TrackPoints:
    """Points on a track where the motion of a ship is evaluated.

    Attributes
    ----------
    lat, lon : Positions [deg], (n,).
    course : Course over ground along the geodesic there, clockwise from north [rad], (n,).
    setting : Speed setting of the leg, (n,).
    leg : Index of the leg, (n,).
    along : Distance from the start of the leg [m], (n,).
    charted : Least charted depth of the piece [m below datum], (n,); +inf without a chart of depth.
    """

    lat: FloatArray
    lon: FloatArray
    course: FloatArray
    setting: IntArray
    leg: IntArray
    along: FloatArray
    charted: FloatArray

    def __len__(self) -> int:
        return len(self.lat)

    def part(self, index: slice | IntArray | NDArray[np.bool_]) -> TrackPoints:
        """Return some of the points."""
        return TrackPoints(*(values[index] for values in vars(self).values()))


@dataclass(frozen=True)
class TrackPieces:
    """A track split into short pieces, with its legs.

    Attributes
    ----------
    length, course : Length [m] and course at the start [rad] of each leg, (legs,).
    leg : Index of the leg of each piece, (p,).
    start : Distance of its start from the start of the leg [m], (p,).
    step : Its length [m], (p,).
    wait : Wait after it [s]: at the end of a leg, else 0, (p,).
    canals : Which legs are canals; their length is that of the canal.
    """

    track: Track
    length: FloatArray
    course: FloatArray
    leg: IntArray
    start: FloatArray
    step: FloatArray
    wait: FloatArray
    canals: CanalLegs

    def __len__(self) -> int:
        return len(self.leg)

    def points(self, leg: IntArray, along: FloatArray) -> TrackPoints:
        """Return the points at given distances along given legs, without charted depth."""
        track = self.track
        lon, lat, back = WGS84.fwd(
            track.lon[leg], track.lat[leg], np.degrees(self.course[leg]), along
        )
        lat, lon = np.asarray(lat), wrap_longitude(lon)
        course = np.radians(np.asarray(back) + 180.0) % (2.0 * math.pi)
        straight = self.canals.approach
        course = np.where(straight[leg], self.course[leg], course)  # as in canals
        for canal in self.canals.legs:
            if straight[canal]:
                continue
            on = leg == canal
            lat[on], lon[on], course[on] = self.canals.places(canal, along[on])
        return TrackPoints(
            lat,
            lon,
            course,
            track.setting[leg],
            leg,
            along,
            np.full(len(leg), math.inf),
        )

    def gauss_points(self) -> TrackPoints:
        """Return the two Gauss points of every piece, in order."""
        along = self.start[:, None] + self.step[:, None] * GAUSS_NODES
        return self.points(np.repeat(self.leg, 2), along.reshape(-1))

    def ends(self) -> TrackPoints:
        """Return the start of every piece, then the end of every leg."""
        legs = np.arange(len(self.length))
        return self.points(
            np.concatenate([self.leg, legs]), np.concatenate([self.start, self.length])
        )

    def split(self, parts: IntArray) -> TrackPieces:
        """Return the track with every piece split into a number of equal parts (p,)."""
        of, number = numbered_parts(parts)
        step = (self.step / parts)[of]
        wait = np.where(number == parts[of] - 1, self.wait[of], 0.0)
        start = self.start[of] + number * step
        return replace(self, leg=self.leg[of], start=start, step=step, wait=wait)

    def order_key(self, leg: IntArray, along: FloatArray) -> FloatArray:
        """Return a number that grows along the track, with a step between legs."""
        length = self.length[leg]
        share = np.divide(along, length, out=np.zeros(len(leg)), where=length > 0.0)
        return leg * 2.0 + np.clip(share, 0.0, 1.0)

    def containing(self, leg: IntArray, along: FloatArray) -> IntArray:
        """Return the piece at distances along legs [m]; at a boundary the later one of the leg."""
        starts = self.order_key(self.leg, self.start)
        place = np.searchsorted(starts, self.order_key(leg, along), side="right") - 1
        return np.asarray(place, dtype=np.int64)

    def last_of_leg(self) -> NDArray[np.bool_]:
        """Return which pieces end a leg."""
        return np.append(self.leg[1:] != self.leg[:-1], True)


def cut_into_pieces(
    track: Track, step: float, least: int, chart: Chart | None = None, ship: Ship | None = None
) -> TrackPieces:
    """Split every leg into equal pieces.

    Parameters
    ----------
    step : Greatest length of a piece [m].
    least : Least number of pieces of a leg.
    chart : Whose canals legs may run through.
    ship : With a ship, legs may also run along the port approaches of the chart.
    """
    canals = canal_legs(track, chart, ship)
    length, course, _ = inverse(track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:])
    length = np.where(canals.number >= 0, canals.length, length)
    count = np.maximum(least, np.ceil(length / step - 1e-9)).astype(np.int64)
    leg, number = numbered_parts(count)
    piece = length / count
    wait = np.zeros(len(leg))
    wait[np.cumsum(count) - 1] = track.wait[1:]
    return TrackPieces(track, length, course, leg, number * piece[leg], piece[leg], wait, canals)
