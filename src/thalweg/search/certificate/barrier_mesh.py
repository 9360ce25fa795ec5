"""Meshes for barrier functions: cells of a frozen raster, divided, and the land in them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.geodesy import EQUATORIAL_RADIUS, FLATTENING, distance
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.certificate.cell_conditions import BarrierWorld
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.kernels.leg.table_lookup import TableArrays, axes_needed

if TYPE_CHECKING:
    from thalweg.chart import Chart

_ECCENTRICITY_SQUARED = FLATTENING * (2.0 - FLATTENING)


@dataclass(frozen=True, eq=False)
class ShipInBarrier:
    """A ship at one setting, as the certificate reads it.

    Attributes
    ----------
    table : TableArrays
        Speed through water.
    setting : int
    limits : float64 array
        As kernels read them (`thalweg.core.limits.Limits.array`).
    top_speed : float
        Upper bound of the speed through water [m/s].
    """

    table: TableArrays
    setting: int
    limits: FloatArray
    top_speed: float


@dataclass(frozen=True, eq=False)
class BarrierMesh:
    """A mesh of rectangular cells, each with four triangles that meet in its centre.

    Attributes
    ----------
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg]; longitudes without jumps.
    world : BarrierWorld
        Sea, ship and land.
    """

    lat: FloatArray
    lon: FloatArray
    world: BarrierWorld

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of nodes (Y, X)."""
        return self.lat.size, self.lon.size

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
    raster: RasterArrays, refinement: int, ship: ShipInBarrier, chart: Chart | None
) -> BarrierMesh:
    """Build the mesh that divides each cell of a raster into ``refinement`` squared cells.

    Parameters
    ----------
    raster : RasterArrays
        Times since departure [s].
    refinement : int
        1 or more.
    ship : ShipInBarrier
    chart : Chart or None
        Land; None for open water.

    Returns
    -------
    BarrierMesh
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
        closed_cells(chart, lat, lon),
        np.full((lat.size - 1, lon.size - 1), np.inf, np.float32),
        ship.table,
        ship.setting,
        int(axes_needed(ship.table)),
        ship.limits,
        ship.top_speed,
    )
    return BarrierMesh(lat, lon, world)


def metres_per_degree(lat: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lengths [m] of a degree of latitude and of longitude on WGS 84.

    Notes
    -----
    ``M = a (1 - e^2) / w^3`` and ``N cos(lat) = a cos(lat) / w`` with
    ``w = sqrt(1 - e^2 sin^2(lat))``, times pi / 180.
    """
    phi = np.radians(lat)
    w = np.sqrt(1.0 - _ECCENTRICITY_SQUARED * np.sin(phi) ** 2)
    north = EQUATORIAL_RADIUS * (1.0 - _ECCENTRICITY_SQUARED) / w**3
    east = EQUATORIAL_RADIUS * np.cos(phi) / w
    return np.radians(1.0) * north, np.radians(1.0) * np.maximum(east, 1.0)


def closed_cells(chart: Chart | None, lat: FloatArray, lon: FloatArray) -> BoolArray:
    """Return which cells of a mesh are land all over.

    A cell is closed if its centre is on land and no shore passes through it.

    Parameters
    ----------
    chart : Chart or None
    lat, lon : float64 array (Y,), (X,)
        Nodes [deg].

    Returns
    -------
    bool array (Y - 1, X - 1)
    """
    shape = lat.size - 1, lon.size - 1
    if chart is None:
        return np.zeros(shape, bool)
    rows, columns = 0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1])
    grid = np.meshgrid(rows, columns, indexing="ij")
    distance_to_land = np.asarray(
        chart.coastline.shore_distance(grid[0].ravel(), grid[1].ravel(), cap=1.0)
    ).reshape(shape)
    shores = np.zeros(shape, bool)
    steps = lat[1] - lat[0], lon[1] - lon[0]
    for line_lat, line_lon in chart.coastline.lines(lat[0], lat[-1], lon[0], lon[-1]):
        for turn in (-360.0, 0.0, 360.0):
            y = (np.asarray(line_lat) - lat[0]) / steps[0]
            x = (np.asarray(line_lon) + turn - lon[0]) / steps[1]
            if x.max() >= -1.0 and x.min() <= shape[1] + 1.0:
                _mark_line(shores, y, x)
    closed: BoolArray = (distance_to_land <= 0.0) & ~shores
    return closed


def _mark_line(cells: BoolArray, y: FloatArray, x: FloatArray) -> None:
    """Mark the cells that the boxes round short pieces of a line touch."""
    length = np.maximum(np.abs(np.diff(y)), np.abs(np.diff(x)))
    parts = np.maximum(np.ceil(2.0 * np.minimum(length, 1e5)).astype(np.int64), 1)
    piece = np.repeat(np.arange(length.size), parts)
    first = np.concatenate([[0], np.cumsum(parts)[:-1]])
    share = (np.arange(piece.size) - first[piece]) / parts[piece]
    y0 = y[piece] + share * (y[piece + 1] - y[piece])
    x0 = x[piece] + share * (x[piece + 1] - x[piece])
    y1 = y0 + (y[piece + 1] - y[piece]) / parts[piece]
    x1 = x0 + (x[piece + 1] - x[piece]) / parts[piece]
    margin = 0.02  # the outlines are great circles, drawn here as straight lines
    for row in (np.minimum(y0, y1) - margin, np.maximum(y0, y1) + margin):
        for column in (np.minimum(x0, x1) - margin, np.maximum(x0, x1) + margin):
            j, i = np.floor(row).astype(np.int64), np.floor(column).astype(np.int64)
            inside = (j >= 0) & (i >= 0) & (j < cells.shape[0]) & (i < cells.shape[1])
            cells[j[inside], i[inside]] = True
