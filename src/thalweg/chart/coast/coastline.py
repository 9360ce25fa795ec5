"""The coastline of a chart: polygons of land, their index, and tests of legs and positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.chart.basemap import coastline_lines, land_polygons
from thalweg.chart.coast.coast_cache import gshhg_index
from thalweg.chart.coast.coast_index_builder import build_index, empty_index
from thalweg.chart.coast.gshhg import read_land_rings
from thalweg.chart.geojson_polygons import GeoJsonSource, read_land_areas
from thalweg.chart.rings import Rings
from thalweg.core.types import FloatArray
from thalweg.kernels.geometry.cube_sphere import IndexArrays
from thalweg.kernels.geometry.shore_distance import shore_distances

_GEOJSON_INDEX_CELLS: Final = 512  # cells along a face of the index of land from GeoJSON
_GSHHG_DETAIL: Final = {"c": 25_000.0, "l": 5_000.0, "i": 1_000.0, "h": 200.0}  # [m]
_MAX_SHORE_DISTANCE: Final = 250_000.0  # [m]


@dataclass(frozen=True, eq=False)
class Coastline:
    """Polygons of land.

    Attributes
    ----------
    name : Source of the polygons.
    index : Grid of their edges, for kernels.
    read : Reads the rings of the polygons.
    """

    name: str
    index: IndexArrays
    read: Callable[[], Rings]

    @classmethod
    def gshhg(
        cls, resolution: str, *, narrows_closed: bool = True, islets: bool = True
    ) -> Coastline:
        """Return the land of the world from GSHHG (see `thalweg.chart.Chart.gshhg`).

        Charts of one process share it.

        Parameters
        ----------
        resolution : 'c', 'l', 'i', 'h' or 'f'.
        narrows_closed : Whether narrows that no ship should use, and dams, are land.
        islets : Whether resolutions i and h have the islets that they lack.
        """
        return shared_coastline(resolution, narrows_closed, islets)

    @classmethod
    def none(cls) -> Coastline:
        """Return no land."""
        rings = Rings.from_lists([])
        return cls("open water", empty_index(), lambda: rings)

    @classmethod
    def from_geojson(cls, land: GeoJsonSource) -> Coastline:
        """Return the areas of a GeoJSON file or of plain data (see `thalweg.chart.Chart`)."""
        rings = read_land_areas(land)
        index = build_index(rings, _GEOJSON_INDEX_CELLS)
        return cls(f"GeoJSON {rings.fingerprint()}", index, lambda: rings)

    @cached_property
    def rings(self) -> Rings:
        """The rings of the polygons, read when first used."""
        return self.read()

    @property
    def is_empty(self) -> bool:
        """Whether there is no land at all."""
        return not self.index.winding.size and bool((self.index.cell > 0.0).all())

    @property
    def detail(self) -> float:
        """Size of what the coastline leaves out [m]; 0 where it is not simplified.

        Tolerances of GSHHG: Wessel and Smith (1996), J. Geophys. Res. 101(B4), 8741-8743.
        """
        source, _, resolution = self.name.partition(" ")
        return _GSHHG_DETAIL.get(resolution[:1], 0.0) if source == "GSHHG" else 0.0

    def shore_distance(
        self, lat: ArrayLike, lon: ArrayLike, *, cap: float = 50_000.0
    ) -> FloatArray:
        """Return a lower bound of the distance [m] to the nearest land.

        Parameters
        ----------
        lat, lon : Positions [deg]; they broadcast.
        cap : Up to this distance [m], at most 250 km, the result is the true distance to 1 % and
            never above it; farther from land it is at least ``cap``. On land it is 0.
        """
        a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        distance = np.empty(a.size)
        shore_distances(
            self.index,
            np.ascontiguousarray(a).ravel(),
            np.ascontiguousarray(b).ravel(),
            min(float(cap), _MAX_SHORE_DISTANCE),
            distance,
        )
        return distance.reshape(a.shape)

    def lines(
        self, south: float, north: float, west: float, east: float
    ) -> list[tuple[FloatArray, FloatArray]]:
        """Return the outlines of land in a box [deg] as (lat, lon) arrays [deg], for drawing."""
        return coastline_lines(self.rings, south, north, west, east)

    def polygons(self, south: float, north: float, west: float, east: float) -> list[Any]:
        """Return the land in a box [deg] as shapely polygons (x lon, y lat) [deg], for drawing."""
        return land_polygons(self.rings, south, north, west, east)


@lru_cache(maxsize=2)
def shared_coastline(resolution: str, narrows_closed: bool, islets: bool) -> Coastline:
    """Return a coastline of GSHHG that the charts of this process share."""
    choice = {"narrows_closed": narrows_closed, "islets": islets}
    name = f"GSHHG {resolution}" + ("" if narrows_closed else ", narrows open")
    name += "" if islets else ", without islets"
    read = partial(read_land_rings, resolution, **choice)
    return Coastline(name, gshhg_index(resolution, **choice), read)
