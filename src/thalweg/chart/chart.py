"""`Chart`: what a nautical chart holds; land, area, depth, zones and ports."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart import canals as canal_data
from thalweg.chart.anchorages import may_wait
from thalweg.chart.basemap import coastline_lines, land_polygons
from thalweg.chart.canals import CANALS, Canal
from thalweg.chart.coast.coast_cache import gshhg_index
from thalweg.chart.coast.coast_index_builder import build_index, empty_index
from thalweg.chart.coast.gshhg import read_land_rings
from thalweg.chart.coast.leg_tests import leg_status, point_status
from thalweg.chart.coast.rings import Rings
from thalweg.chart.coast.snapping import nearest_navigable
from thalweg.chart.depth.depth_grids import make_depth_layer
from thalweg.chart.depth.depth_layers import DepthLayers, coarse_depth
from thalweg.chart.ports import PORTS, Port, Ports
from thalweg.chart.zones import geojson_zones
from thalweg.chart.zones.emission_control_areas import EcaZone, select_emission_control_areas
from thalweg.chart.zones.zone_raster import ZoneRaster, zone_raster
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.time import TimeLike
from thalweg.core.types import Float32Array, FloatArray
from thalweg.kernels.codes import LAND, OK
from thalweg.kernels.geometry.coast_index import CoastArrays
from thalweg.kernels.geometry.cube_sphere import IndexArrays
from thalweg.kernels.geometry.depth_sampling import DepthArrays
from thalweg.kernels.geometry.shore_distance import shore_distances

LAND_INDEX_CELLS: Final = 512  # cells along a face of the index of land from GeoJSON


@dataclass(frozen=True, eq=False)
class LandPolygons:
    """Land polygons: their name, the grid of their edges, and where their rings come from."""

    name: str
    index: IndexArrays
    read: Callable[[], Rings]

    @cached_property
    def rings(self) -> Rings:
        """The rings themselves, read when first needed (for drawing)."""
        return self.read()


NO_ZONES: Final = Zones()
NO_DEPTHS: Final = DepthLayers()


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart; immutable, so every ``with_...`` returns another.

    Make one with `gshhg`, `open_water` or `from_geojson`.
    """

    land: LandPolygons
    area: BoundingBox = WORLD
    zones: Zones = NO_ZONES
    depths: DepthLayers = NO_DEPTHS
    canals: tuple[Canal, ...] = ()

    def __post_init__(self) -> None:
        if self.canals and self.zones.no_go:  # a canal through a no-go zone is closed
            none = CoastArrays(empty_index(), self.zones.index, WORLD.array())
            paths = [np.array(canal.path, float).T for canal in self.canals]
            shut = [(leg_status(none, a[:-1], o[:-1], a[1:], o[1:]) != OK).any() for a, o in paths]
            left = tuple(c for c, is_shut in zip(self.canals, shut) if not is_shut)
            object.__setattr__(self, "canals", left)

    @classmethod
    def gshhg(cls, resolution: str = "i") -> Chart:
        """Return the chart of the world's coasts from GSHHG.

        Parameters
        ----------
        resolution : str
            'c' (crude, 25 km), 'l' (5 km), 'i' (1 km), 'h' (0.2 km) or 'f' (full); h and f need
            ``pip install "thalweg[hires]"``. Lakes are land. Ship canals are closed to legs, but
            can be passed from end to end (`canals`, `without_canals`).

        Raises
        ------
        InputError
            If the resolution is unknown or not installed.
        """
        index = gshhg_index(resolution)
        land = LandPolygons(f"GSHHG {resolution}", index, lambda: read_land_rings(resolution))
        return cls(land, canals=CANALS)

    @classmethod
    def open_water(
        cls, south: float = -90.0, north: float = 90.0, west: float = -180.0, east: float = 180.0
    ) -> Chart:
        """Return a chart without land, of a box that no leg may leave [deg].

        West above east means a box across the antimeridian.
        """
        none = Rings.from_lists([])
        land = LandPolygons("open water", empty_index(), lambda: none)
        box = BoundingBox.checked(float(south), float(north), float(west), float(east))
        return cls(land, box)

    @classmethod
    def from_geojson(cls, land: geojson_zones.GeoJsonSource) -> Chart:
        """Return a chart whose land is the areas of a GeoJSON file or plain data.

        Holes in them are water. Edges are straight in longitude and latitude.

        Raises
        ------
        InputError
            If it cannot be read, or holds anything but areas.
        """
        rings = geojson_zones.read_land_areas(land)
        index = build_index(rings, LAND_INDEX_CELLS)
        return cls(LandPolygons(f"GeoJSON {rings.fingerprint()}", index, lambda: rings))

    def with_depth(
        self,
        source: Any,
        *,
        variable: str | None = None,
        positive: str | None = None,
        spacing_deg: float | None = None,
    ) -> Chart:
        """Return this chart with a layer of depth, below those it has.

        Parameters
        ----------
        source : path, xarray.DataArray, xarray.Dataset or function
            A grid on latitude and longitude (GEBCO, ETOPO, EMODnet, ...), opened read-only and
            read only where needed, or a function of (lat, lon) [deg] to depth [m below datum,
            positive down; NaN unknown].
        variable : str, optional
            Which variable of the file, if that is not clear.
        positive : {'up', 'down'}, optional
            Whether values are elevations or depths, if that is not clear.
        spacing_deg : float, optional
            How densely a function must be sampled along legs (1/600 degree).

        Raises
        ------
        InputError, DatasetError
            If the file cannot be read or its depth is not clear.
        """
        layer = make_depth_layer(
            source, variable=variable, positive=positive, spacing_deg=spacing_deg
        )
        return replace(self, depths=DepthLayers((*self.depths.layers, layer)))

    def with_zones(self, zones: geojson_zones.GeoJsonSource) -> Chart:
        """Return this chart with zones added.

        Parameters
        ----------
        zones : path, dict or list
            GeoJSON areas with the property ``kind``: "no-go", "penalty" (with ``factor`` >= 1)
            or "price" (with ``factor`` > 0). Where zones of a kind overlap the largest counts.
            "eca" without a factor is an emission control area, inside which the ship burns (and
            pays for) its other fuel; with a factor it is a price zone. With "anchorage" zones a
            ship may wait in these only; it may not in "no-waiting" zones. A canal through a
            "no-go" zone is closed. Rings may cross the antimeridian
            (`thalweg.chart.zones.geojson_zones`).

        Raises
        ------
        InputError
            If it cannot be read, an outline crosses itself or may be meant either way round the
            globe, or a kind or factor makes no sense.
        """
        return replace(self, zones=self.zones.joined(Zones.read(zones)))

    def with_eca(
        self, names: str | Iterable[str] | None = None, *, date: TimeLike | None = None
    ) -> Chart:
        """Return this chart with emission control areas of MARPOL Annex VI.

        Parameters
        ----------
        names : str or iterable of str, optional
            Such as "north-sea", "baltic-sea", "mediterranean", "us-caribbean", "north-america";
            see `thalweg.chart.zones.emission_control_areas.emission_control_areas`. By default all
            whose limit on sulphur counts.
        date : time, optional
            When; by default the day the package's dates were looked up (2026-11-21).

        Raises
        ------
        InputError
            If there is no such area, its limits are unknown, or it does not count at ``date``.

        Warns
        -----
        ThalwegWarning
            If an area counts at ``date`` but its limits are not in the package.
        """
        areas = select_emission_control_areas(names, date=date)
        zones = tuple(EcaZone(area.name, area.rings) for area in areas)
        return replace(self, zones=self.zones.joined(Zones(eca=zones)))

    def in_eca(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return which positions [deg] lie inside any emission control area of the chart."""
        return self.zones.in_eca(lat, lon)

    def eca_fraction(
        self,
        lat1: ArrayLike,
        lon1: ArrayLike,
        lat2: ArrayLike,
        lon2: ArrayLike,
        *,
        finest: float = 0.25,
    ) -> FloatArray:
        """Return the share (0 to 1) of each leg inside any emission control area.

        Shares are of the length of the geodesic, each crossing of an outline being found to
        ``finest`` [m]. Arguments [deg] broadcast; NaN where a position is no number. About 1 us for
        a leg that touches no outline, 0.1 ms for one that does (many at once; 2 ms for one alone).
        """
        return self.zones.eca_fraction(lat1, lon1, lat2, lon2, finest=finest)

    def zone_raster(
        self, south: float, north: float, west: float, east: float, spacing: float
    ) -> ZoneRaster:
        """Return a raster of a box [deg] that tells kernels where fuel has which price.

        See `thalweg.chart.zones.zone_raster.ZoneRaster`: cells wholly outside or inside the
        emission control areas, and mixed ones, for which ``zones.eca_index`` (exact, for
        `thalweg.kernels.geometry.cube_sphere.inside`) or `eca_fraction` decides.
        """
        box = BoundingBox.checked(south, north, west, east)
        return zone_raster(self.zones, box.array(), spacing)

    def within(self, south: float, north: float, west: float, east: float) -> Chart:
        """Return this chart cut to a box that no leg may leave [deg]."""
        box = BoundingBox.checked(float(south), float(north), float(west), float(east))
        return replace(self, area=box)

    def without_canals(self, *names: str) -> Chart:
        """Return this chart with canals closed, by name; "all" closes all of them.

        Raises
        ------
        InputError
            If there is no canal of that name; near matches are named.
        """
        return replace(self, canals=canal_data.exclude_canals(self.canals, names))

    def canal_of_legs(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.int64]:
        """Return the index in `canals` of legs [deg] from one end of a canal to the other, or -1.

        The ends of the leg lie within 2 m of those of the canal, in either direction.
        """
        return canal_data.canal_index_of_legs(self.canals, lat1, lon1, lat2, lon2)

    @cached_property
    def _coast(self) -> CoastArrays:
        return CoastArrays(self.land.index, self.zones.index, self.area.array())

    def kernel(self) -> CoastArrays:
        """Return the arrays for `thalweg.kernels.geometry.coast_index.leg_blocked` and its kin."""
        return self._coast

    def is_navigable(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return where positions [deg] are water inside the area and in no no-go zone."""
        return np.asarray(point_status(self._coast, lat, lon) == OK)

    def leg_status(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.int8]:
        """Return the status code of each geodesic leg [deg] (see `thalweg.kernels.codes`).

        OK, LAND, NO_GO (a no-go zone, or it leaves the chart's area) or NO_DATA (a position
        that is not a number). A leg touching an outline is blocked, unless it runs from one end of
        a canal to the other (`canal_of_legs`). Arguments broadcast.
        """
        status = leg_status(self._coast, lat1, lon1, lat2, lon2)
        if self.canals and (status == LAND).any():
            status[(status == LAND) & (self.canal_of_legs(lat1, lon1, lat2, lon2) >= 0)] = OK
        return status

    def legs_blocked(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.bool_]:
        """Return which geodesic legs [deg] touch land or a no-go zone or leave the area."""
        return np.asarray(self.leg_status(lat1, lon1, lat2, lon2) != OK)

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

    @property
    def has_depth(self) -> bool:
        """Whether the chart has any layer of depth."""
        return bool(self.depths.layers)

    def depth_at(self, lat: ArrayLike, lon: ArrayLike) -> FloatArray:
        """Return charted depth [m below datum] at positions [deg]; NaN where it is unknown."""
        return self.depths.at(lat, lon)

    def depth_along(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> Float32Array:
        """Return the least charted depth [m below datum] on each geodesic leg [deg].

        Samples lie no farther apart than half a grid step and each counts the least of the four
        soundings round it. +inf when the chart has no depth; NaN when it is unknown on the leg.
        """
        return self.depths.along(lat1, lon1, lat2, lon2)

    def depth_arrays(self, south: float, north: float, west: float, east: float) -> DepthArrays:
        """Return the depth of a box [deg] for
        `thalweg.kernels.geometry.depth_sampling.least_depth`.

        Empty arrays when the chart has no depth; a function is laid on a grid of 1000 steps.
        """
        return self.depths.arrays((south, north, west, east if east > west else east + 360.0))

    def coarse_depth_at(self, lat: ArrayLike, lon: ArrayLike) -> FloatArray:
        """Return coarse depth of the world [m], to warn with; never a proof of clearance.

        Every 30th point of ETOPO1: half a degree apart, shoals between them are not in it.
        """
        return coarse_depth(lat, lon)

    def zone_factor(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Return the penalty and price factors of legs [deg], weighted by length (1 outside)."""
        return self.zones.factors(lat1, lon1, lat2, lon2)

    def may_wait(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return where a ship may wait: in anchorages if there are any, never where barred."""
        y, x = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        return may_wait(self.zones.anchorages, self.zones.no_waiting, y, x)

    def nearest_navigable(
        self, lat: float, lon: float, *, largest: float = 50_000.0
    ) -> tuple[float, float, float] | None:
        """Return the nearest water joined to the open sea: lat, lon [deg], distance [m].

        None when there is none within ``largest`` [m].
        """
        return nearest_navigable(self, float(lat), float(lon), largest=float(largest))

    @property
    def ports(self) -> Ports:
        """The ports of the World Port Index, and others that it leaves out."""
        return PORTS

    def port(self, name: str) -> Port:
        """Return a port by name or UN/LOCODE; see `Ports.lookup`."""
        return PORTS.lookup(name)

    def coastline_lines(self, south: float, north: float, west: float, east: float) -> list[Any]:
        """Return the outlines of land in a box [deg] as (lat, lon) arrays, for drawing."""
        return coastline_lines(self, south, north, west, east)

    def land_polygons(self, south: float, north: float, west: float, east: float) -> list[Any]:
        """Return the land in a box [deg] as shapely polygons (x lon, y lat), for drawing."""
        return land_polygons(self, south, north, west, east)

    def fingerprint(self) -> str:
        """Return a short digest of everything on the chart."""
        digest = hashlib.sha256(self.land.name.encode())
        for array in (*self.land.index[1:], self.area.array()):
            digest.update(np.ascontiguousarray(array).tobytes())
        layers = (layer.fingerprint() for layer in self.depths.layers)
        for text in (*self.zones.texts(), *layers, *map(repr, self.canals)):
            digest.update(text.encode())
        return digest.hexdigest()[:16]
