"""The least distance of a track from charted land, and where it keeps less than the offing.

Independent of the test of legs in `thalweg.kernels.geometry.offing_along_legs`: positions on the
geodesics are sampled ever more closely wherever land could be nearer than what was found so far.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.offing import required_offing
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import direct, inverse
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.route.track import Track

_FIRST_PIECE: Final = 10.0 * NAUTICAL_MILE
_LAST_PIECE: Final = 10.0  # pieces are not halved below this length [m]
_FINEST_SHARE: Final = 0.01  # nor below this share of the distance to land
_FARTHEST: Final = 30.0 * NAUTICAL_MILE  # larger distances to land count as this one
_TOLERANCE: Final = 0.985  # of the required distance: tests of legs are exact to 1 %


@dataclass(frozen=True)
class LandClearance:
    """Where a track is nearest to charted land.

    Attributes
    ----------
    distance : Distance to land [m], to 1 %; at least 30 nautical miles if it is above that.
    lat, lon : Position on the track [deg].
    leg : Its leg, from 0.
    """

    distance: float
    lat: float
    lon: float
    leg: int


def least_land_clearance(
    chart: Chart, track: Track, legs: BoolArray | None = None
) -> LandClearance | None:
    """Return where a track is nearest to land, without legs through canals; None for no legs.

    Parameters
    ----------
    legs : Which legs count, (legs,); by default all.
    """
    pieces = _Pieces.of_track(chart, track)
    if legs is not None:
        pieces = pieces.selected(np.asarray(legs)[pieces.leg])
    best: LandClearance | None = None
    while len(pieces.leg):
        lat, lon, shore = pieces.middles(chart)
        k = int(np.argmin(shore))
        if best is None or shore[k] < best.distance:
            best = LandClearance(float(shore[k]), float(lat[k]), float(lon[k]), int(pieces.leg[k]))
        possible = shore - 0.5 * pieces.length() < (1.0 - _FINEST_SHARE) * best.distance
        pieces = pieces.halved(possible & (shore < _FARTHEST))
    return best


def offing_breaches(chart: Chart, track: Track) -> list[tuple[LandClearance, float]]:
    """Return for each leg that is nearer to land than required its worst place, and the limit [m].

    Canals are left out.
    """
    offing = chart.offing.distance
    worst: dict[int, tuple[LandClearance, float]] = {}
    if offing <= 0.0:
        return []
    pieces = _Pieces.of_track(chart, track)
    while len(pieces.leg):
        lat, lon, shore = pieces.middles(chart)
        required = required_offing(chart.offing_arrays, lat, lon)
        for k in np.flatnonzero(shore < _TOLERANCE * required):
            leg = int(pieces.leg[k])
            if leg not in worst or shore[k] < worst[leg][0].distance:
                place = LandClearance(float(shore[k]), float(lat[k]), float(lon[k]), leg)
                worst[leg] = place, float(required[k])
        length = pieces.length()
        possible = shore - length < _TOLERANCE * required  # the required distance may grow as well
        known = np.isin(pieces.leg, list(worst)) & (length < 0.05 * required)
        pieces = pieces.halved(possible & ~known & (length > _FINEST_SHARE * required))
    return [worst[leg] for leg in sorted(worst)]


@dataclass(frozen=True)
class _Pieces:
    """Pieces of legs: the leg, its start and course, and the piece's ends along it [m]."""

    leg: IntArray
    lat: FloatArray
    lon: FloatArray
    course: FloatArray
    begin: FloatArray
    end: FloatArray

    @classmethod
    def of_track(cls, chart: Chart, track: Track) -> _Pieces:
        lat, lon = np.asarray(track.lat, float), np.asarray(track.lon, float)
        ends = lat[:-1], lon[:-1], lat[1:], lon[1:]
        open_sea = np.asarray(chart.canal_of_legs(*ends)) < 0
        lengths, courses, _ = inverse(*ends)
        count = np.where(open_sea, np.maximum(np.ceil(lengths / _FIRST_PIECE), 1), 0).astype(int)
        leg, number = numbered_parts(count)
        part = lengths[leg] / count[leg]
        return cls(
            leg, lat[leg], lon[leg], np.asarray(courses)[leg], number * part, (number + 1) * part
        )

    def selected(self, keep: BoolArray) -> _Pieces:
        return _Pieces(*(getattr(self, one.name)[keep] for one in fields(self)))

    def length(self) -> FloatArray:
        return np.asarray(self.end - self.begin)

    def middles(self, chart: Chart) -> tuple[FloatArray, FloatArray, FloatArray]:
        lat, lon = direct(self.lat, self.lon, self.course, 0.5 * (self.begin + self.end))
        shore = chart.coastline.shore_distance(lat, lon, cap=_FARTHEST + _FIRST_PIECE)
        return np.asarray(lat), np.asarray(lon), shore

    def halved(self, keep: np.ndarray) -> _Pieces:
        keep = keep & (self.end - self.begin > _LAST_PIECE)
        middle = 0.5 * (self.begin + self.end)[keep]
        leg = np.tile(self.leg[keep], 2)
        lat, lon, course = (np.tile(x[keep], 2) for x in (self.lat, self.lon, self.course))
        begin = np.concatenate([self.begin[keep], middle])
        end = np.concatenate([middle, self.end[keep]])
        return _Pieces(leg, lat, lon, course, begin, end)
