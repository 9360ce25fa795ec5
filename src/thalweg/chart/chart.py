"""`Chart`: what a nautical chart holds; land, area, depth, zones and ports."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.gshhg import read_land
from thalweg.chart.index import empty_index
from thalweg.chart.legs import leg_status, point_status
from thalweg.chart.rings import Rings
from thalweg.chart.store import gshhg_index
from thalweg.core.errors import InputError
from thalweg.core.geodesy import FloatArray
from thalweg.kernels.coast import CoastArrays
from thalweg.kernels.codes import OK
from thalweg.kernels.cube import IndexArrays
from thalweg.kernels.shore import shore_distances


@dataclass(frozen=True)
class Land:
    """Land polygons: their name, the grid of their edges, and where their rings come from."""

    name: str
    index: IndexArrays
    read: Callable[[], Rings]

    @cached_property
    def rings(self) -> Rings:
        """The rings themselves, read when first needed (for drawing)."""
        return self.read()


@dataclass(frozen=True)
class Area:
    """A box of latitudes and longitudes [deg]; west above east crosses the antimeridian."""

    south: float
    north: float
    west: float
    east: float

    def __post_init__(self) -> None:
        values = (self.south, self.north, self.west, self.east)
        swapped = self.south > self.north or abs(self.south) > 90 or abs(self.north) > 90
        if not all(np.isfinite(values)) or swapped or self.west == self.east:
            raise InputError(
                f"The area south {self.south:g}, north {self.north:g}, west {self.west:g}, "
                f"east {self.east:g} is none.",
                "South lies below north, both within 90 degrees, and west differs from east.",
                "Give south, north, west, east in degrees, in that order.",
                value=values,
            )

    @property
    def width(self) -> float:
        """Degrees of longitude from west to east."""
        width = self.east - self.west
        return width % 360.0 if abs(width) < 360.0 else 360.0

    def array(self) -> FloatArray:
        """South, north, west and width [deg], as kernels take it."""
        return np.array([self.south, self.north, self.west, self.width])


WORLD = Area(-90.0, 90.0, -180.0, 180.0)


@dataclass(frozen=True)
class Chart:
    """A chart; immutable, so every ``with_...`` returns another.

    Make one with `gshhg`, `open_water` or `from_geojson`.
    """

    land: Land
    area: Area = WORLD

    @classmethod
    def gshhg(cls, resolution: str = "i") -> Chart:
        """Return the chart of the world's coasts from GSHHG.

        Parameters
        ----------
        resolution : str
            'c' (crude, 25 km), 'l' (5 km), 'i' (1 km), 'h' (0.2 km) or 'f' (full); h and f need
            ``pip install "thalweg[hires]"``. Lakes are land; Suez and Panama are closed.

        Raises
        ------
        InputError
            If the resolution is unknown or not installed.
        """
        index = gshhg_index(resolution)
        return cls(Land(f"GSHHG {resolution}", index, lambda: read_land(resolution)))

    @classmethod
    def open_water(
        cls, south: float = -90.0, north: float = 90.0, west: float = -180.0, east: float = 180.0
    ) -> Chart:
        """Return a chart without land, of a box that no leg may leave [deg].

        West above east means a box across the antimeridian.
        """
        none = Rings.from_lists([])
        land = Land("open water", empty_index(), lambda: none)
        return cls(land, Area(float(south), float(north), float(west), float(east)))

    def within(self, south: float, north: float, west: float, east: float) -> Chart:
        """Return this chart cut to a box that no leg may leave [deg]."""
        return replace(self, area=Area(float(south), float(north), float(west), float(east)))

    @cached_property
    def _coast(self) -> CoastArrays:
        return CoastArrays(self.land.index, empty_index(), self.area.array())

    def kernel(self) -> CoastArrays:
        """Return the arrays for `thalweg.kernels.coast.leg_blocked` and its kin."""
        return self._coast

    def is_navigable(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return where positions [deg] are water inside the area and in no no-go zone."""
        return np.asarray(point_status(self._coast, lat, lon) == OK)

    def leg_status(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.int8]:
        """Return the status code of each geodesic leg [deg] (see `thalweg.kernels.codes`).

        OK, LAND, NO_GO (a no-go zone, or it leaves the chart's area) or NO_DATA (a position
        that is not a number). A leg touching an outline is blocked. Arguments broadcast.
        """
        return leg_status(self._coast, lat1, lon1, lat2, lon2)

    def legs_blocked(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.bool_]:
        """Return which geodesic legs [deg] touch land or a no-go zone or leave the area."""
        return np.asarray(leg_status(self._coast, lat1, lon1, lat2, lon2) != OK)

    def shore_distance(
        self, lat: ArrayLike, lon: ArrayLike, *, cap: float = 50_000.0
    ) -> FloatArray:
        """Return a lower bound of the distance [m] to the nearest land.

        Parameters
        ----------
        lat, lon : array_like
            Positions [deg].
        cap : float
            Up to this distance [m], at most 250 km, the answer is the true distance to 1 %
            (never above it); farther from land it is at least ``cap``. On land it is 0.
        """
        a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        distance = np.empty(a.size)
        shore_distances(
            self.land.index,
            np.ascontiguousarray(a).ravel(),
            np.ascontiguousarray(b).ravel(),
            min(float(cap), 250_000.0),
            distance,
        )
        return distance.reshape(a.shape)

    def fingerprint(self) -> str:
        """Return a short digest of everything on the chart."""
        digest = hashlib.sha256(self.land.name.encode())
        for array in (*self.land.index[1:], self.area.array()):
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()[:16]
