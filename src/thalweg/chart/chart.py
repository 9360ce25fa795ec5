"""`Chart`: coastline, depth, zones and canals of a sea area, and tests of positions and legs."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart import canals as canal_data
from thalweg.chart import chart_queries, geojson_polygons
from thalweg.chart.approaches import PORT_APPROACHES, PortApproaches
from thalweg.chart.canals import CANALS, Canal
from thalweg.chart.coast.coast_index_builder import empty_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.leg_status import leg_status
from thalweg.chart.depth.depth_grids import make_depth_layer
from thalweg.chart.depth.depth_layers import DepthLayers
from thalweg.chart.offing import (
    Offing,
    chart_with_offing,
    chart_without_passages,
    offing_arrays,
)
from thalweg.chart.passages import PASSAGES, Passage
from thalweg.chart.zones.emission_control_areas import EcaZone, select_emission_control_areas
from thalweg.chart.zones.ship_traffic import ShipTraffic
from thalweg.chart.zones.traffic_files import chart_with_traffic
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.delegation import delegated
from thalweg.core.errors import ThalwegWarning
from thalweg.core.time import TimeLike
from thalweg.deprecated_names import renamed_attributes
from thalweg.kernels.codes import OK
from thalweg.kernels.geometry.coast_index import CoastArrays
from thalweg.kernels.geometry.offing_along_legs import OffingArrays

NO_ZONES: Final = Zones()
NO_DEPTHS: Final = DepthLayers()
NO_OFFING: Final = Offing()
OPEN_PASSAGES: Final = tuple(passage for passage in PASSAGES if passage.use != "never")


@cache
def control_areas_in_force() -> Zones:
    """Return the emission control areas in force, those without published limits left out."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ThalwegWarning)
        areas = select_emission_control_areas()
    return Zones(eca=tuple(EcaZone(area.name, area.rings) for area in areas))


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
    counts_eca : bool
        Whether the emission control areas in force count where the chart has none of its own
        (`control_areas`).
    approaches : PortApproaches, optional
        Lines from the berths of ports to open sea; charts of the world's coasts have them.
    passages : tuple of Passage
        Passages in which ships may come nearer to land than the offing.
    closed_passages : tuple of Passage
        Passages that no leg crosses.
    offing : Offing
        How far from land ships stay.
    traffic : ShipTraffic, optional
        How often other ships are met.
    """

    coastline: Coastline
    area: BoundingBox = WORLD
    zones: Zones = NO_ZONES
    depths: DepthLayers = NO_DEPTHS
    canals: tuple[Canal, ...] = ()
    counts_eca: bool = True
    approaches: PortApproaches | None = None
    passages: tuple[Passage, ...] = ()
    closed_passages: tuple[Passage, ...] = ()
    offing: Offing = NO_OFFING
    traffic: ShipTraffic | None = None

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
            warning_depth_at="thalweg.chart.depth.global_depth:coarse_depth",
            zone_factor="zones.factors",
        )

    def __post_init__(self) -> None:
        if self.canals and self.zones.no_go:  # a canal through a no-go zone is closed
            zones = CoastArrays(empty_index(), self.zones.index, WORLD.array())
            left = tuple(canal for canal in self.canals if not _is_blocked(canal, zones))
            object.__setattr__(self, "canals", left)

    @classmethod
    def gshhg(
        cls, resolution: str = "i", *, narrows_closed: bool = True, islets: bool = True
    ) -> Chart:
        """Return the chart of the world's coasts from GSHHG.

        Parameters
        ----------
        resolution : str
            'c' (crude, 25 km), 'l' (5 km), 'i' (1 km), 'h' (0.2 km) or 'f' (full); h and f need
            ``pip install "thalweg[hires]"``. Lakes are land. Canals are closed to legs, but can
            be passed from end to end (`canals`), as can the approaches of ports (`approaches`).
        narrows_closed : bool
            Whether dams and narrows that no ship should use, such as the Menai Strait, are land.
        islets : bool
            Whether i and h have the islets that they lack; False: the outline as published.

        Returns
        -------
        Chart
            Of the whole world, with all ship canals.

        Raises
        ------
        InputError
            If the resolution is unknown or not installed.
        """
        return cls(
            Coastline.gshhg(resolution, narrows_closed=narrows_closed, islets=islets),
            canals=CANALS,
            approaches=PORT_APPROACHES,
            passages=OPEN_PASSAGES,
        )

    @classmethod
    def open_water(
        cls, south: float = -90.0, north: float = 90.0, west: float = -180.0, east: float = 180.0
    ) -> Chart:
        """Return a chart without land, of a box that no leg may leave.

        Parameters
        ----------
        south, north : float
            Latitudes [deg], -90 to 90.
        west, east : float
            Longitudes [deg]; west above east means a box across the antimeridian.

        Returns
        -------
        Chart
            Without land, zones, depth and canals.

        Raises
        ------
        InputError
            If the four values are not a valid box.
        """
        return cls(Coastline.none(), BoundingBox.checked(south, north, west, east))

    @classmethod
    def from_geojson(cls, land: geojson_polygons.GeoJsonSource) -> Chart:
        """Return a chart whose land is the areas of a GeoJSON file or plain data.

        Holes in them are water. Edges are straight in longitude and latitude.

        Parameters
        ----------
        land : path, dict or list
            GeoJSON areas [deg]: a file, or its contents as plain data.

        Returns
        -------
        Chart
            Without zones, depth and canals.

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

        Returns
        -------
        Chart
            Positions that an earlier layer covers keep its depth.

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

        Returns
        -------
        Chart
            With the zones it had and these.

        Raises
        ------
        InputError
            If it cannot be read, an outline crosses itself or is ambiguous at the
            antimeridian, or a kind or factor is not possible.
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

        Returns
        -------
        Chart
            With the areas it had and these.

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

    def without_eca(self) -> Chart:
        """Return this chart without emission control areas, neither its own nor those in force.

        Returns
        -------
        Chart
            All fuel is burnt outside emission control areas.
        """
        return replace(self, zones=replace(self.zones, eca=()), counts_eca=False)

    @property
    def control_areas(self) -> Zones | None:
        """The emission control areas that count: its own, else those in force; or None."""
        if self.zones.eca:
            return self.zones
        return control_areas_in_force() if self.counts_eca else None

    def within(self, south: float, north: float, west: float, east: float) -> Chart:
        """Return this chart clipped to a box that no leg may leave.

        Parameters
        ----------
        south, north : float
            Latitudes [deg], -90 to 90.
        west, east : float
            Longitudes [deg]; west above east means a box across the antimeridian.

        Returns
        -------
        Chart
            With this box in place of its ``area``.

        Raises
        ------
        InputError
            If the four values are not a valid box.
        """
        box = BoundingBox.checked(south, north, west, east)
        return replace(self, area=box)

    def without_canals(self, *names: str) -> Chart:
        """Return this chart with canals closed.

        Parameters
        ----------
        *names : str
            Names of canals, such as "suez"; "all" closes all of them.

        Returns
        -------
        Chart
            With the other canals.

        Raises
        ------
        InputError
            If the name is unknown; the message lists similar names.
        """
        return replace(self, canals=canal_data.exclude_canals(self.canals, names))

    @cached_property
    def arrays(self) -> CoastArrays:
        """Land, zones, area and offing as arrays, for `thalweg.kernels.geometry.coast_index`."""
        return CoastArrays(
            self.coastline.index, self.zones.closed_index, self.area.array(), self.offing_arrays
        )

    @cached_property
    def offing_arrays(self) -> OffingArrays:
        """The offing as arrays."""
        return offing_arrays(self.coastline, self.offing, self.passages, self.closed_passages)

    @property
    def has_depth(self) -> bool:
        """Whether the chart has any layer of depth."""
        return bool(self.depths.layers)

    canal_of_legs = delegated(chart_queries.chart_canal_of_legs)
    crosses_no_go_zone = delegated(chart_queries.chart_crosses_no_go_zone)
    is_joined_to_sea = delegated(chart_queries.chart_is_joined_to_sea)
    is_navigable = delegated(chart_queries.chart_is_navigable)
    leg_status = delegated(chart_queries.chart_leg_status)
    legs_blocked = delegated(chart_queries.chart_legs_blocked)
    with_offing = delegated(chart_with_offing)
    with_traffic = delegated(chart_with_traffic)
    without_passages = delegated(chart_without_passages)
    may_wait = delegated(chart_queries.chart_may_wait)
    sea_room = delegated(chart_queries.chart_sea_room)
    nearest_navigable = delegated(chart_queries.chart_nearest_navigable)
    fingerprint = delegated(chart_queries.chart_fingerprint)


def _is_blocked(canal: Canal, coast: CoastArrays) -> bool:
    """Return whether the path of a canal is blocked."""
    lat, lon = np.array(canal.path, float).T
    return bool((leg_status(coast, lat[:-1], lon[:-1], lat[1:], lon[1:]) != OK).any())
