"""Meshes for barrier functions: cells of a frozen raster, divided, and the land in them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.ellipsoid import ECCENTRICITY_SQUARED, EQUATORIAL_RADIUS
from thalweg.core.geodesy import distance, longitude_difference
from thalweg.core.types import Float32Array, FloatArray
from thalweg.kernels.certificate.cell_conditions import BarrierWorld
from thalweg.kernels.codes import (
    CHANNEL_COUNT,
    CURRENT_EAST,
    CURRENT_NORTH,
    LIMIT_REQUIRED_DEPTH,
)
from thalweg.kernels.leg.point_speed import ShipArrays
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.kernels.leg.table_lookup import TableArrays, axes_needed
from thalweg.search.certificate.charted_depths import greatest_depths
from thalweg.search.certificate.closed_water import closed_cells

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea.freeze import DerivedChannel

_PLANE_CELLS = 6.0  # half the width of the plane at the source


@dataclass(frozen=True, eq=False)
class ShipInBarrier:
    """A ship at one setting, as the certificate reads it.

    Attributes
    ----------
    table : Speed through water.
    limits : As kernels read them (`thalweg.core.limits.Limits.array`).
    top_speed : float
        Upper bound of the speed through water [m/s]; NaN where it follows from ``speed_field``.
    speed_field : Speed through water as a field of the sea, for ships without a table.
    """

    table: TableArrays
    setting: int
    limits: FloatArray
    top_speed: float
    speed_field: DerivedChannel | None = None


@dataclass(frozen=True)
class BarrierLink:
    """A canal: a way between two positions that takes a fixed time, in both directions.

    Attributes
    ----------
    one, other : (lat, lon) [deg].
    """

    one: tuple[float, float]
    other: tuple[float, float]
    seconds: float


@dataclass(frozen=True, eq=False)
class BarrierMesh:
    """A mesh of rectangular cells, each with four triangles that meet in its centre.

    Attributes
    ----------
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg]; longitudes without jumps.
    world : Sea, ship and land.
    links : Canals with both ends inside the mesh.
    """

    lat: FloatArray
    lon: FloatArray
    world: BarrierWorld
    links: tuple[BarrierLink, ...] = ()

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes (Y, X)."""
        return self.lat.size, self.lon.size

    @property
    def is_round(self) -> bool:
        """Whether the first and the last column are one meridian."""
        return bool(self.lon[-1] - self.lon[0] > 360.0 - 1e-6)

    def cell_of(self, lat: float, lon: float) -> tuple[int, int]:
        """Return the row and column of the cell that contains a position [deg]."""
        east = (lon - self.lon[0]) % 360.0 + self.lon[0]
        row = int(np.searchsorted(self.lat, lat, side="right")) - 1
        column = int(np.searchsorted(self.lon, east, side="right")) - 1
        return min(max(row, 0), self.lat.size - 2), min(max(column, 0), self.lon.size - 2)

    def value_at(self, phi: FloatArray, centre: FloatArray, lat: float, lon: float) -> float:
        """Return the value of a barrier at a position, linear on the triangle that contains it."""
        j, i = self.cell_of(lat, lon)
        east = (lon - self.lon[0]) % 360.0 + self.lon[0]
        y = (lat - self.lat[j]) / (self.lat[j + 1] - self.lat[j])
        x = (east - self.lon[i]) / (self.lon[i + 1] - self.lon[i])
        a, b = phi[j, i], phi[j, i + 1]
        c, d = phi[j + 1, i], phi[j + 1, i + 1]
        m = centre[j, i]
        u, v = x - 0.5, y - 0.5
        if abs(v) >= abs(u):
            low, high = (a, b) if v < 0.0 else (c, d)
            away = 2.0 * abs(v)
            return float(m + away * (0.5 * (low + high) - m) + u * (high - low))
        low, high = (a, c) if u < 0.0 else (b, d)
        away = 2.0 * abs(u)
        return float(m + away * (0.5 * (low + high) - m) + v * (high - low))

    def times_to_corners(self, lat: float, lon: float) -> FloatArray:
        """Return the times [s] in still water to the corners (2, 2) of the cell of a position."""
        j, i = self.cell_of(lat, lon)
        far = distance(self.lat[j : j + 2, None], self.lon[None, i : i + 2], lat, lon)
        return np.asarray(far, float) / self.world.top_speed

    def least_times(self, lat: float, lon: float, speed: float) -> FloatArray:
        """Return for each cell a lower bound of the time [s] to a position at a greatest speed."""
        rows = 0.5 * (self.lat[1:] + self.lat[:-1])
        columns = 0.5 * (self.lon[1:] + self.lon[:-1])
        far = np.asarray(distance(rows[:, None], columns[None, :], lat, lon), float)
        world = self.world
        height = world.metres_north.max() * (self.lat[1] - self.lat[0])
        width = world.metres_east.max() * (self.lon[1] - self.lon[0])
        half = 0.5 * math.hypot(height, width) * 1.01
        return np.maximum(far - half, 0.0) / speed


def build_mesh(
    raster: RasterArrays,
    refinement: int,
    ship: ShipInBarrier,
    chart: Chart | None,
    *,
    departures: float = 0.0,
    by_steps: bool = False,
    kept_out: Sequence[Any] = (),
    margins: FloatArray | None = None,
) -> BarrierMesh:
    """Build the mesh that divides each cell of a raster into ``refinement`` squared cells.

    Parameters
    ----------
    raster : Times since departure [s].
    refinement : 1 or more.
    chart : Land, offing, zones and canals; None for open water.
    departures : From the first to the last departure [s].
    by_steps : Whether the raster samples functions, whose limits may open between its times.
    kept_out : Polygons that count as no-go zones (`closed_cells`).
    margins : By how much the sea may differ from the raster, by cell and channel
        (`BarrierRaster`); by default not at all.
    """
    _, rows, columns, _ = raster.values.shape
    lat0, dlat, lon0, dlon = raster.corner
    lat = lat0 + dlat / refinement * np.arange((rows - 1) * refinement + 1)
    lon = lon0 + dlon / refinement * np.arange((columns - 1) * refinement + 1)
    north, east = metres_per_degree(lat)
    world = BarrierWorld(
        raster,
        refinement,
        0,
        0,
        east,
        north,
        closed_cells(chart, lat, lon, kept_out),
        _deepest(chart, ship, lat, lon),
        ShipArrays(ship.table, ship.setting, ship.limits, int(axes_needed(ship.table))),
        ship.top_speed,
        departures,
        by_steps,
        np.zeros((1, 1, CHANNEL_COUNT)) if margins is None else margins,
    )
    return BarrierMesh(lat, lon, world, _links(chart, lat, lon))


def _deepest(
    chart: Chart | None, ship: ShipInBarrier, lat: FloatArray, lon: FloatArray
) -> Float32Array:
    """Return the greatest charted depth in each cell [m]; +inf where the ship needs none."""
    if chart is None or not chart.depths.layers or not ship.limits[LIMIT_REQUIRED_DEPTH] > 0.0:
        return np.full((lat.size - 1, lon.size - 1), np.inf, np.float32)
    return greatest_depths(chart.depths, lat, lon)


def _links(chart: Chart | None, lat: FloatArray, lon: FloatArray) -> tuple[BarrierLink, ...]:
    """Return the canals of a chart whose ends are inside a box."""
    found = []
    for canal in () if chart is None else chart.canals:
        inside = (
            lat[0] <= y <= lat[-1] and (x - lon[0]) % 360.0 <= lon[-1] - lon[0]
            for y, x in canal.ends
        )
        if all(inside):
            found.append(BarrierLink(*canal.ends, canal.transit_time))
    return tuple(found)


def metres_per_degree(lat: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lengths [m] of a degree of latitude and of longitude on WGS 84.

    Notes
    -----
    ``M = a (1 - e^2) / w^3`` and ``N cos(lat) = a cos(lat) / w`` with
    ``w = sqrt(1 - e^2 sin^2(lat))``, times pi / 180.
    """
    phi = np.radians(lat)
    w = np.sqrt(1.0 - ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    north = EQUATORIAL_RADIUS * (1.0 - ECCENTRICITY_SQUARED) / w**3
    east = EQUATORIAL_RADIUS * np.cos(phi) / w
    return np.radians(1.0) * north, np.radians(1.0) * np.maximum(east, 1.0)


def strongest_current_near(mesh: BarrierMesh, rows: slice, columns: slice) -> float:
    """Return the strongest current [m/s] in a block of nodes of a mesh, at any time."""
    raster, m = mesh.world.raster, mesh.world.refinement
    east, north = raster.channel_index[CURRENT_EAST], raster.channel_index[CURRENT_NORTH]
    if east < 0 or north < 0:
        return 0.0
    near = [slice(part.start // m, part.stop // m + 2) for part in (rows, columns)]
    part = raster.values[:, near[0], near[1]]
    speed = np.hypot(part[..., east], part[..., north])
    known = speed[np.isfinite(speed)]
    margins = mesh.world.margins
    margins = margins if margins.shape[0] == 1 else margins[near[0], near[1]]
    return float(known.max(initial=0.0)) + float(margins[..., CURRENT_EAST].max())


def slope_direction(mesh: BarrierMesh, phi: FloatArray, lat: float, lon: float) -> float | None:
    """Return the course [rad from north] in which a barrier falls fastest at a position."""
    j, i = mesh.cell_of(lat, lon)
    a, b, c, d = phi[j, i], phi[j, i + 1], phi[j + 1, i], phi[j + 1, i + 1]
    height = (mesh.lat[1] - mesh.lat[0]) * mesh.world.metres_north[j]
    width = (mesh.lon[1] - mesh.lon[0]) * mesh.world.metres_east[j]
    north, east = (c + d - a - b) / height, (b + d - a - c) / width
    return math.atan2(-east, -north) if math.hypot(east, north) > 0.0 else None


def plane_at_source(
    mesh: BarrierMesh, source: tuple[float, float], course: float, slowness: Callable[..., float]
) -> FloatArray:
    """Return values at nodes round the source (NaN elsewhere): a plane that rises on a course.

    The plane is zero at the source. It is a few cells wide, so that fronts towards the target are
    straight and not curved.

    Parameters
    ----------
    course : [rad from north].
    slowness : Returns how much the plane rises in a metre, given a block of rows and columns.
    """
    lat, lon = source
    j, i = mesh.cell_of(lat, lon)
    rows, columns = _block(j, mesh.shape[0]), _block(i, mesh.shape[1])
    north = (mesh.lat[rows] - lat) * mesh.world.metres_north[j]
    east = longitude_difference(mesh.lon[columns], lon) * mesh.world.metres_east[j]
    along = north[:, None] * math.cos(course) + east[None, :] * math.sin(course)
    across = east[None, :] * math.cos(course) - north[:, None] * math.sin(course)
    height = (mesh.lat[1] - mesh.lat[0]) * mesh.world.metres_north[j]
    width = (mesh.lon[1] - mesh.lon[0]) * mesh.world.metres_east[j]
    size = max(height, width)
    part = (np.abs(along) <= size) & (np.abs(across) <= _PLANE_CELLS * size)
    part[j - rows.start : j - rows.start + 2, i - columns.start : i - columns.start + 2] = True
    values = np.full(mesh.shape, math.nan)
    east_scale = mesh.world.metres_east[rows][part.any(axis=1)]
    ratio = 1.002 * float(mesh.world.metres_east[j] / east_scale.min())  # meridians converge
    values[rows, columns] = np.where(part, along * (slowness(rows, columns) / ratio), math.nan)
    return values


def _block(middle: int, count: int) -> slice:
    reach = int(2 * _PLANE_CELLS) + 2
    return slice(max(middle - reach, 0), min(middle + reach + 2, count))
