"""Closed rings of positions, and discs, edges straight in longitude and latitude."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE


@dataclass(frozen=True)
class Rings:
    """Many closed rings in flat arrays; outer rings run counter-clockwise, holes clockwise.

    Attributes
    ----------
    lat, lon : Positions [deg]; the last of each ring repeats its first. Longitudes are continuous
        along a ring and may leave [-180, 180].
    start : Where each ring begins, one more than there are rings.
    """

    lat: FloatArray
    lon: FloatArray
    start: NDArray[np.int64]

    @classmethod
    def from_lists(cls, rings: Iterable[tuple[Sequence[tuple[float, float]], bool]]) -> Rings:
        """Return rings from (positions (lat, lon), is a hole) pairs, closed and turned right."""
        points: list[NDArray[np.float64]] = []
        for positions, hole in rings:
            ring = np.asarray(positions, float).reshape(-1, 2)
            if not np.array_equal(ring[0], ring[-1]):
                ring = np.vstack([ring, ring[:1]])
            if (_doubled_area(ring[:, 0], ring[:, 1]) < 0.0) != hole:
                ring = ring[::-1]
            points.append(ring)
        start = cumulative_sums(np.array([len(p) for p in points], np.int64))
        flat = np.vstack(points) if points else np.empty((0, 2))
        return cls(np.ascontiguousarray(flat[:, 0]), np.ascontiguousarray(flat[:, 1]), start)

    def __len__(self) -> int:
        return len(self.start) - 1

    def joined(self, other: Rings) -> Rings:
        """Return these rings and another's."""
        start = np.concatenate([self.start, other.start[1:] + self.start[-1]])
        lat, lon = np.concatenate([self.lat, other.lat]), np.concatenate([self.lon, other.lon])
        return Rings(lat, lon, start)

    def oriented(self) -> Rings:
        """Return the rings all turned counter-clockwise, for rings without holes."""
        if not len(self):
            return self
        step = self.lon[:-1] * self.lat[1:] - self.lon[1:] * self.lat[:-1]
        step[self.start[1:-1] - 1] = 0.0
        clockwise = np.add.reduceat(np.append(step, 0.0), self.start[:-1]) < 0.0
        if not clockwise.any():
            return self
        counts = np.diff(self.start)
        take = np.arange(len(self.lat))
        turned = np.flatnonzero(np.repeat(clockwise, counts))
        ends = (self.start[:-1] + self.start[1:] - 1)[clockwise]  # sums of first and last
        take[turned] = np.repeat(ends, counts[clockwise]) - turned
        return Rings(self.lat[take], self.lon[take], self.start)

    def fingerprint(self) -> str:
        """Return a short digest of the positions."""
        digest = hashlib.sha256()
        for array in (self.lat, self.lon, self.start):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()[:16]


def _doubled_area(lat: FloatArray, lon: FloatArray) -> float:
    east, north = lon - lon[0], lat - lat[0]
    return float(np.sum(east[:-1] * north[1:] - east[1:] * north[:-1]))


def disc_shape(lat: float, lon: float, radius: float, *, quad_segs: int) -> Any:
    """Return the polygon, in longitude and latitude, of the positions near one.

    Parameters
    ----------
    lat, lon : The middle [deg].
    radius : Of the disc [m], to a third of a percent; short of 90 degrees of latitude.
    quad_segs : Edges of a quarter of its circumference.

    Returns
    -------
    shapely.Polygon : It may leave [-180, 180].
    """
    import shapely
    import shapely.affinity

    disc = shapely.Point(lon, lat).buffer(radius / (60.0 * NAUTICAL_MILE), quad_segs=quad_segs)
    return shapely.affinity.scale(disc, 1.0 / max(np.cos(np.radians(lat)), 0.01), 1.0)
