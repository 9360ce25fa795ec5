"""Environment of a project: networks between the sites, the frozen sea, the ship at each load."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import (
    Position,
    distance,
    positions_along,
)
from thalweg.core.limits import Limits
from thalweg.core.types import FloatArray
from thalweg.deprecated_names import renamed_attributes
from thalweg.kernels import codes
from thalweg.network import Network, NetworkMeta, Samples, Stations, lattice, mesh
from thalweg.network.assembly import assemble, measured_pairs
from thalweg.network.triangular_mesh.edge_sampling import sampled_on_triangle_sides
from thalweg.operations.dredging.project_parts import Sites
from thalweg.planning.frozen_sea import MEMORY_LIMIT
from thalweg.planning.network_selection.bed_along_edges import with_bed_along_edges
from thalweg.planning.planning_context import greatest_speed_of, performance_table_of
from thalweg.planning.request.requirements import (
    Requirements,
    derive_requirements,
    required_under_keel_clearance,
)
from thalweg.planning.single.weather_gaps import least_along_edges
from thalweg.planning.voyage import Voyage
from thalweg.sea import standard_names as nm
from thalweg.search import PreparedNetwork, ProfileSearch, prepare_profile_search

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import PerformanceTable, Ship


LINE = "line"  #: kind of the network of a fixed route
_LINE_SPACING = 300.0  # of the nodes of a fixed route [m]
_BED_SAMPLES = 8  # samples of the bed per spacing of the network
_SAME_PLACE = 1.0  # [m]

MessageCallback = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class ProjectEnvironment:
    """Sites, period, ship, sea and chart of a project.

    Attributes
    ----------
    sites : Sites
    period : tuple of float
        Start and end [s since 1970-01-01T00:00Z].
    ship : Ship
    sea : Sea
    chart : Chart
    needs : Requirements
        Channels of the sea and limits of the full ship.
    """

    sites: Sites
    period: tuple[float, float]
    ship: Ship
    sea: Sea
    chart: Chart
    needs: Requirements

    @classmethod
    def open(
        cls, sites: Sites, period: tuple[float, float], *, ship: Ship, sea: Sea, chart: Chart
    ) -> ProjectEnvironment:
        """Return the environment, with the requirements of the ship on the sea.

        Parameters
        ----------
        sites : Sites
            Where the ship loads and unloads.
        period : tuple of float
            Start and end [s since 1970-01-01T00:00Z].
        ship : Ship
            The ship.
        sea : Sea
            Currents, water level and depth over the period.
        chart : Chart
            Land, zones and depth.

        Returns
        -------
        ProjectEnvironment
            For ships at any load.

        Raises
        ------
        CoverageError
            If the sea lacks a variable, or does not hold the beginning of the period.
        """
        voyage = _voyage(sites, period)
        needs = derive_requirements(voyage, ship=ship.with_load_factor(1.0), sea=sea, chart=chart)
        return cls(sites, period, ship, sea, chart, needs)

    @property
    def min_ukc(self) -> float:
        """Minimum under-keel clearance [m]: that of the sites; default: that of the ship file."""
        return required_under_keel_clearance(_voyage(self.sites, self.period), self.ship)

    @property
    def bed_is_static(self) -> bool:
        """Whether the depth of the bed does not depend on time in any source."""
        rows = [row for row in self.sea.coverage() if row.variable == nm.BED_DEPTH]
        return bool(rows) and all(row.start is None for row in rows)

    def loaded(self, load_factor: float) -> LoadedShip:
        """Return the ship at a load, with its table and limits.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        LoadedShip
            The required depth is its draught, the under-keel clearance and the margin.
        """
        ship = self.ship.with_load_factor(load_factor)
        limits = self.needs.limits
        if limits.depth_checked:
            keel = self.min_ukc + self.sites.network.margin
            limits = limits.with_required_depth(ship.draught + keel)
        setting = len(ship.speeds) - 1
        table = performance_table_of(ship)
        return LoadedShip(ship, table, limits, setting, greatest_speed_of(ship, table, setting))


def _voyage(sites: Sites, period: tuple[float, float]) -> Voyage:
    """Return a voyage between the sites, for the requirements on the sea."""
    return Voyage(start=sites.load, goal=sites.unload, depart=period[0], min_ukc_m=sites.min_ukc)


@dataclass(frozen=True, eq=False)
class LoadedShip:
    """A ship at one load: table, limits, setting, top speed [m/s]."""

    ship: Ship
    table: PerformanceTable
    limits: Limits
    setting: int
    top_speed: float

    @property
    def required_depth(self) -> float:
        """Draught, clearance and margin [m]."""
        return self.limits.required_depth


@dataclass(frozen=True, eq=False)
class SiteNetwork:
    """A network between the sites with the sea frozen on it.

    Attributes
    ----------
    network : ``meta.start`` is the loading site, ``meta.goal`` the unloading site.
    """

    network: Network
    waters: PreparedNetwork

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(passages="profile_search")

    def profile_search(
        self, loaded: LoadedShip, *, full: bool, limits: Limits | None = None
    ) -> ProfileSearch:
        """Prepare the search from loading to unloading site (full), or back.

        ``limits`` replaces those of the loaded ship.
        """
        ends = (self.network.meta.start, self.network.meta.goal)
        return prepare_profile_search(
            self.waters,
            loaded.table,
            start=ends[0] if full else ends[1],
            goal=ends[1] if full else ends[0],
            setting=loaded.setting,
            limits=limits or loaded.limits,
            top_speed=loaded.top_speed,
        )

    @cached_property
    def length(self) -> float:
        """Direct distance between the sites [m]."""
        lat, lon = self.network.lat, self.network.lon
        a, b = self.network.meta.start, self.network.meta.goal
        return float(distance(lat[a], lon[a], lat[b], lon[b]))


def freeze_site_network(
    environment: ProjectEnvironment, network: Network, report: MessageCallback
) -> SiteNetwork:
    """Freeze the sea at a network for the whole period.

    Parameters
    ----------
    environment : ProjectEnvironment
        Ship, sea, chart and period.
    network : Network
        Network between the sites.
    report : callable
        Called with a text that states the size.

    Returns
    -------
    SiteNetwork
        The network, prepared for searches at any time of the period.

    Raises
    ------
    InputError
        If it would take more memory than is allowed.
    """
    channels = list(environment.needs.channels)
    if environment.bed_is_static and codes.BED_DEPTH in channels:
        channels.remove(codes.BED_DEPTH)
        network = with_bed_depth(environment, network)
    lat, lon = network.stations.lat, network.stations.lon
    steps = len(environment.sea.times(*environment.period))
    field = environment.ship.speed_field
    extra = None if field is None else {codes.SPEED_FIELD: field}
    size = 4 * len(lat) * steps * (len(channels) + bool(extra))
    if size > MEMORY_LIMIT:
        raise InputError(
            f"The sea at {len(lat):,} places and {steps:,} times takes {size / 1e9:.1f} GB.",
            f"The limit is {MEMORY_LIMIT / 1e9:.0f} GB.",
            "Give fewer days, a coarser spacing_m or a smaller detour.",
        )
    report(f"freezing the sea at {len(lat):,} places and {steps:,} times")
    fields = environment.sea.freeze_stations(lat, lon, *environment.period, channels, extra=extra)
    return SiteNetwork(network, PreparedNetwork.prepare(network, fields))


def project_network(environment: ProjectEnvironment) -> Network:
    """Return the network between the sites: the mesh of the sea if it has one, else a lattice.

    Parameters
    ----------
    environment : ProjectEnvironment
        Sites, sea and chart.

    Returns
    -------
    Network
        ``meta.start`` and ``meta.goal`` are the nodes at the sites.
    """
    sites, chart = environment.sites, environment.chart
    model = environment.sea.mesh()
    if model is None:
        spacing = sites.network.spacing
        return lattice(chart, sites.load, sites.unload, spacing=spacing, directions=32)
    lat, lon, faces = _mesh_near_sites(model.lat, model.lon, model.triangles, sites)
    network = sampled_on_triangle_sides(
        mesh(
            chart, lat, lon, faces, largest_spacing=sites.network.spacing, rings=sites.network.rings
        )
    )
    ends = [_node_at(network, place) for place in (sites.load, sites.unload)]
    return replace(network, meta=replace(network.meta, start=ends[0], goal=ends[1]))


def _mesh_near_sites(
    lat: FloatArray, lon: FloatArray, triangles: NDArray[np.int64], sites: Sites
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return the sites, the nodes of a model around them, and the triangles between these."""
    direct_distance = float(distance(*sites.load, *sites.unload))
    to_load = distance(lat, lon, *sites.load)
    to_unload = distance(lat, lon, *sites.unload)
    use = to_load + to_unload <= sites.network.detour * direct_distance
    use &= np.minimum(to_load, to_unload) > _SAME_PLACE
    number = np.full(lat.size, -1, np.int64)
    number[use] = 2 + np.arange(int(use.sum()))
    if use.sum() < 3:
        raise InputError(
            "The mesh of the sea has no nodes around the sites, which are "
            f"{direct_distance:,.0f} m apart.",
            f"It has {lat.size} nodes between {lat.min():.3f} and {lat.max():.3f} N, "
            f"{lon.min():.3f} and {lon.max():.3f} E.",
            "Choose sites inside it, farther apart than its nodes.",
        )
    # triangles whose nodes are all used; a node at a site is replaced by that site
    for place, node in ((to_load, 0), (to_unload, 1)):
        number[place <= _SAME_PLACE] = node
    faces = number[triangles]
    faces = faces[(faces >= 0).all(axis=1)]
    places = np.array([sites.load, sites.unload])
    return (
        np.concatenate([places[:, 0], lat[use]]),
        np.concatenate([places[:, 1], lon[use]]),
        faces,
    )


def _node_at(network: Network, place: Position) -> int:
    separation = distance(network.lat, network.lon, *place)
    nearest = int(np.argmin(separation))
    if separation[nearest] > _SAME_PLACE:
        raise InputError(
            f"The site {place[0]:.4f}, {place[1]:.4f} is not on navigable water.",
            "It is on land, in a no-go zone or outside the chart.",
            "Move it.",
        )
    return nearest


def fixed_route_network(chart: Chart, route: Sequence[Position]) -> Network:
    """Return a charted route as a network: one line of nodes where the ship may wait.

    Raises
    ------
    InputError : If the chart does not let it pass.
    """
    lat, lon = _resampled_route(route)
    first = np.arange(len(lat) - 1, dtype=np.int32)
    blocked = np.asarray(chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    if blocked.any():
        k = int(np.argmax(blocked))
        raise InputError(
            f"The route of the base case is not navigable near {lat[k]:.4f}, {lon[k]:.4f}.",
            "It crosses land or a no-go zone, or leaves the chart.",
            "Correct base_case.route.",
        )
    pairs = measured_pairs(lat, lon, first, first + np.int32(1))
    meta = NetworkMeta(LINE, _LINE_SPACING, 2, 0.0, start=0, goal=len(lat) - 1)
    stations = Stations(lat, lon, len(lat))
    return assemble(chart, stations, pairs, Samples.none(len(first)), meta=meta)


def _resampled_route(route: Sequence[Position]) -> tuple[FloatArray, FloatArray]:
    lats, lons = [np.array([route[0][0]])], [np.array([route[0][1]])]
    for (lat1, lon1), (lat2, lon2) in itertools.pairwise(route):
        pieces = max(1, math.ceil(float(distance(lat1, lon1, lat2, lon2)) / _LINE_SPACING))
        lat, lon = positions_along(lat1, lon1, lat2, lon2, np.arange(1, pieces + 1) / pieces)
        lats.append(lat)
        lons.append(lon)
    return np.concatenate(lats), np.concatenate(lons)


def with_bed_depth(environment: ProjectEnvironment, network: Network) -> Network:
    """Return the network with the least depth of the bed of the sea along every edge."""

    def bed(lat: FloatArray, lon: FloatArray) -> FloatArray:
        time = np.full(len(lat), environment.period[0])
        depth = environment.sea.sample([nm.BED_DEPTH], time, lat, lon)[nm.BED_DEPTH]
        return np.where(np.isnan(depth), -np.inf, depth)  # an edge over unknown water is unknown

    spacing = max(network.meta.spacing_m, 1.0) / _BED_SAMPLES
    least = least_along_edges(network, np.arange(network.n_edges), bed, spacing)
    depth = np.where(np.isneginf(least), np.nan, np.minimum(network.edges.depth, least))
    network = network.with_edges(depth=depth.astype(np.float32))
    return with_bed_along_edges(network, environment.sea, math.inf)
