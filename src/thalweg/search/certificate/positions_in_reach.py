"""Which positions a route of a known length may pass."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from thalweg.core.geodesy import distance, longitude_difference, unit_vectors
from thalweg.core.types import BoolArray, FloatArray
from thalweg.search.certificate.barrier_mesh import BarrierLink

SPHERE: Final = 6.33e6  #: radius at which no great circle is longer than the geodesic [m]
_LARGEST_LATITUDE: Final = 80.0  # of positions that count [deg]
_BOX_MARGIN: Final = 1.0  # beyond the positions within reach [deg]


@dataclass(frozen=True)
class Reach:
    """Positions that a route of a known length [m] may pass; canals count at a speed [m/s]."""

    start: tuple[float, float]
    goal: tuple[float, float]
    known: float
    speed: float = 1.0

    def by_link(self, link: BarrierLink) -> float:
        """Return the length by geodesics to one end of a canal, through it and on [m]."""
        ends = (link.one, link.other), (link.other, link.one)
        return link.seconds * self.speed + min(
            float(distance(*self.start, *a) + distance(*b, *self.goal)) for a, b in ends
        )

    @property
    def middle(self) -> float:
        """Longitude between start and goal [deg]."""
        east = longitude_difference(self.goal[1], self.start[1])
        return self.start[1] + 0.5 * east

    def box(self) -> tuple[float, float, float, float]:
        """Return west, south, east and north [deg] of a box that holds all these positions.

        None is farther from the middle of the ends than half of the known length, as for an
        ellipse on a sphere: ``cos m = (cos d1 + cos d2) / (2 cos(c / 2)) >= cos(known / 2)``.
        """
        whole = (self.middle - 180.0, -_LARGEST_LATITUDE, self.middle + 180.0, _LARGEST_LATITUDE)
        centre = unit_vectors(*np.array([self.start, self.goal]).T).sum(axis=0)
        half = 0.5 * self.known / SPHERE
        lat = math.atan2(centre[2], math.hypot(centre[0], centre[1]))
        if half + abs(lat) >= math.radians(_LARGEST_LATITUDE) - math.radians(_BOX_MARGIN):
            return whole
        lon = math.degrees(math.atan2(centre[1], centre[0]))
        lon = self.middle + (lon - self.middle + 180.0) % 360.0 - 180.0
        wide = math.degrees(math.asin(math.sin(half) / math.cos(lat))) + _BOX_MARGIN
        low, high = (math.degrees(lat + sign * half) + sign * _BOX_MARGIN for sign in (-1.0, 1.0))
        return max(whole[0], lon - wide), low, min(whole[2], lon + wide), high

    def has(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return which positions may be passed, by lower bounds of lengths."""
        there = unit_vectors(lat, lon)
        ends = unit_vectors(*np.array([self.start, self.goal]).T)
        angles = np.arccos(np.clip(there @ ends.T, -1.0, 1.0)).sum(axis=1)
        return np.asarray(SPHERE * angles <= self.known)
