"""`Chart`: coastline, depth, zones and canals of a sea area, and tests of positions and legs."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart import canals as canal_data
from thalweg.chart import geojson_polygons
from thalweg.chart.canals import CANALS, Canal
from thalweg.chart.coast.coast_index_builder import empty_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.leg_tests import leg_status, point_status
from thalweg.chart.coast.snapping import nearest_navigable
from thalweg.chart.depth.depth_grids import make_depth_layer
from thalweg.chart.depth.depth_layers import DepthLayers
from thalweg.chart.zones.emission_control_areas import EcaZone, select_emission_control_areas
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.time import TimeLike
from thalweg.deprecated_names import renamed_attributes
from thalweg.kernels.codes import LAND, OK
from thalweg.kernels.geometry.coast_index import CoastArrays

NO_ZONES: Final = Zones()
NO_DEPTHS: Final = DepthLayers()


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart; immutable, so every ``with_...`` returns another.

    Make one with `gshhg`, `open_water` or `from_geojson`.

    Attributes
    ----------
    coastline : Coastline
        Land: its polygons and the distance to the shore.
    area : BoundingBox
        Box that no leg may leave.
    zones : Zones
        Zones that are closed, that cost more, or where a ship may or may not wait.
    depths : DepthLayers
        Charted depth.
    canals : tuple of Canal
        Ship canals that are open.
    """

    coastline: Coastline
    area: BoundingBox = WORLD
    zones: Zones = NO_ZONES
    depths: DepthLayers = NO_DEPTHS
    canals: tuple[Canal, ...] = ()

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(
            coastline_lines="coastline.lines",
            depth_along="depths.along",
            depth_at="depths.at",
            eca_share="zones.eca_fraction",
            in_eca="zones.in_eca",
            kernel="arrays",
            land="coastline",
            land_polygons="coastline.polygons",
            port="thalweg.chart.ports:PORTS.lookup",
            ports="thalweg.chart.ports:PORTS",
            shore_distance="coastline.shore_distance",
            warning_depth_at="thalweg.chart.depth.depth_layers:coarse_depth",
            zone_factor="zones.factors",
        )

    def __post_init__(self) -> None:
        if self.canals and self.zones.no_go:  # a canal through a no-go zone is closed
            zones = CoastArrays(empty_index(), self.zones.index, WORLD.array())
            left = tuple(canal for canal in self.canals if not _is_blocked(canal, zones))
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
        return cls(Coastline.gshhg(resolution), canals=CANALS)

    @classmethod
    def open_water(
        cls, south: float = -90.0, north: float = 90.0, west: float = -180.0, east: float = 180.0
    ) -> Chart:
        """Return a chart without land, of a box that no leg may leave [deg].

        West above east means a box across the antimeridian.
        """
        return cls(Coastline.none(), BoundingBox.checked(south, north, west, east))

    @classmethod
    def from_geojson(cls, land: geojson_polygons.GeoJsonSource) -> Chart:
        """Return a chart whose land is the areas of a GeoJSON file or plain data.

        Holes in them are water. Edges are straight in longitude and latitude.

        Raises
        ------
        InputError
            If it cannot be read, or holds anything but areas.
        """
        return cls(Coastline.from_geojson(land))

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

    def with_zones(self, zones: geojson_polygons.GeoJsonSource) -> Chart:
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
            (`thalweg.chart.geojson_polygons`).

        Raises
        ------
        InputError
            If it cannot be read, an outline crosses itself or is ambiguous at the
            antimeridian, or a kind or factor makes no sense.
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
            If the area is unknown, its limits are unknown, or it is not in force at ``date``.

        Warns
        -----
        ThalwegWarning
            If an area counts at ``date`` but its limits are not in the package.
        """
        areas = select_emission_control_areas(names, date=date)
        zones = tuple(EcaZone(area.name, area.rings) for area in areas)
        return replace(self, zones=self.zones.joined(Zones(eca=zones)))

    def within(self, south: float, north: float, west: float, east: float) -> Chart:
        """Return this chart cut to a box that no leg may leave [deg]."""
        box = BoundingBox.checked(float(south), float(north), float(west), float(east))
        return replace(self, area=box)

    def without_canals(self, *names: str) -> Chart:
        """Return this chart with canals closed, by name; "all" closes all of them.

        Raises
        ------
        InputError
            If the name is unknown; the message lists similar names.
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
    def arrays(self) -> CoastArrays:
        """Land, closed zones and area as arrays, for `thalweg.kernels.geometry.coast_index`."""
        return CoastArrays(self.coastline.index, self.zones.index, self.area.array())

    def is_navigable(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return where positions [deg] are water inside the area and in no no-go zone."""
        return np.asarray(point_status(self.arrays, lat, lon) == OK)

    def leg_status(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.int8]:
        """Return the status code of each geodesic leg [deg] (see `thalweg.kernels.codes`).

        OK, LAND, NO_GO (a no-go zone, or it leaves the chart's area) or NO_DATA (a position
        that is not a number). A leg touching an outline is blocked, unless it runs from one end of
        a canal to the other (`canal_of_legs`). Arguments broadcast.
        """
        status = leg_status(self.arrays, lat1, lon1, lat2, lon2)
        if self.canals and (status == LAND).any():
            status[(status == LAND) & (self.canal_of_legs(lat1, lon1, lat2, lon2) >= 0)] = OK
        return status

    def legs_blocked(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> NDArray[np.bool_]:
        """Return which geodesic legs [deg] touch land or a no-go zone or leave the area."""
        return np.asarray(self.leg_status(lat1, lon1, lat2, lon2) != OK)

    @property
    def has_depth(self) -> bool:
        """Whether the chart has any layer of depth."""
        return bool(self.depths.layers)

    def may_wait(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return at which positions [deg] a ship may wait (see `Zones.may_wait`)."""
        return self.zones.may_wait(lat, lon)

    def nearest_navigable(
        self, lat: float, lon: float, *, largest: float = 50_000.0
    ) -> tuple[float, float, float] | None:
        """Return the nearest water joined to the open sea: lat, lon [deg], distance [m].

        None when there is none within ``largest`` [m].
        """
        return nearest_navigable(
            float(lat),
            float(lon),
            largest=float(largest),
            is_navigable=self.is_navigable,
            legs_blocked=self.legs_blocked,
        )

    def fingerprint(self) -> str:
        """Return a short digest of everything on the chart."""
        digest = hashlib.sha256(self.coastline.name.encode())
        for array in (*self.coastline.index[1:], self.area.array()):
            digest.update(np.ascontiguousarray(array).tobytes())
        layers = (layer.fingerprint() for layer in self.depths.layers)
        for text in (*self.zones.texts(), *layers, *map(repr, self.canals)):
            digest.update(text.encode())
        return digest.hexdigest()[:16]


def _is_blocked(canal: Canal, coast: CoastArrays) -> bool:
    """Return whether the path of a canal is blocked."""
    lat, lon = np.array(canal.path, float).T
    return bool((leg_status(coast, lat[:-1], lon[:-1], lat[1:], lon[1:]) != OK).any())
