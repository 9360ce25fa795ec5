"""Grids of triangles: unstructured meshes and curvilinear grids, linear in each triangle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.bounding_box import EDGE_TOLERANCE, BoundingBox
from thalweg.core.geodesy import longitude_difference
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.geometry import field_sampling
from thalweg.kernels.geometry.field_sampling import TriangleBins
from thalweg.sea.grids.grid_protocol import GridLocation
from thalweg.sea.triangle_mesh import Mesh

MAX_TRIANGLES_PER_BIN = 12.0  #: triangles in a typical bin; with more, bins are made smaller
MAX_BINS = 1500  #: bins per side at most
MAX_ITEMS_PER_TRIANGLE = 20.0  #: bin entries per triangle at most


@dataclass(frozen=True, eq=False)
class TriangleGrid:
    """Grid points connected by triangles; linear (barycentric) in each, in lon and lat.

    Around a pole, where longitude is singular, a polar stereographic plane is used.

    Attributes
    ----------
    lat, lon : Grid points that hold values [deg], (M,).
    triangles : Flat indices of grid points, (K, 3).
    shape : Rows and columns of grid points (1 row for a mesh).
    network : Nodes and triangles from which a network can be built.
    """

    lat: FloatArray
    lon: FloatArray
    triangles: IntArray
    shape: tuple[int, int]
    network: Mesh | None = None
    wraps: bool = False

    @cached_property
    def area(self) -> BoundingBox:
        """The box around all grid points."""
        known = np.isfinite(self.lat) & np.isfinite(self.lon)
        south, north = float(self.lat[known].min()), float(self.lat[known].max())
        west, width = _narrowest_range(self.lon[known])
        return BoundingBox(south, north, west, west + width)

    @cached_property
    def spacing(self) -> float:
        """Square root of twice the median area of triangles [deg of latitude]."""
        a, b, c = (self.triangles[:, k] for k in range(3))
        shrink = np.cos(np.radians(self.lat[a]))
        x1, x2 = (longitude_difference(self.lon[k], self.lon[a]) * shrink for k in (b, c))
        y1, y2 = self.lat[b] - self.lat[a], self.lat[c] - self.lat[a]
        twice = np.abs(x1 * y2 - x2 * y1)
        return float(np.sqrt(np.nanmedian(twice))) if np.isfinite(twice).any() else 0.0

    def mesh(self) -> Mesh | None:
        """Return nodes and triangles, if the grid is a mesh."""
        return self.network

    def locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        """Return the three corners of each point's triangle and the barycentric weights."""
        last = self._last.get("points")
        if last and np.array_equal(last[0], lat) and np.array_equal(last[1], lon):
            return last[2]
        found = self._locate(lat, lon)
        self._last["points"] = (lat.copy(), lon.copy(), found)
        return found

    @cached_property
    def _last(self) -> dict[str, tuple[FloatArray, FloatArray, GridLocation]]:
        """The last result: several layers on one mesh are sampled at the same points."""
        return {}

    def _locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        x, y = self._plane.of(lat, lon)
        triangle = np.empty(lat.size, np.int64)
        weight = np.zeros((lat.size, 3))
        bins = self._bins
        field_sampling.find_triangles(x, y, bins, triangle, weight)
        index = bins.corners[np.maximum(triangle, 0)]
        index[triangle < 0, 0] = -1
        return GridLocation(index, weight)

    @cached_property
    def _plane(self) -> MapPlane:
        known = np.isfinite(self.lat)
        largest, least = float(self.lat[known].max()), float(self.lat[known].min())
        if largest > 85.0 and least > 0.0:
            return MapPlane(1, 0.0)
        if least < -85.0 and largest < 0.0:
            return MapPlane(-1, 0.0)
        return MapPlane(0, self.area.west)

    @cached_property
    def _bins(self) -> TriangleBins:
        return make_triangle_bins(self._plane, self.lat, self.lon, self.triangles)


class MapPlane(NamedTuple):
    """A plane: pole 0 is lon and lat from a west edge, +-1 polar stereographic."""

    pole: int
    west: float

    def of(self, lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return x and y of positions [deg]."""
        if self.pole == 0:
            return (lon - self.west + EDGE_TOLERANCE) % 360.0 + self.west - EDGE_TOLERANCE, lat
        radius = 2.0 * np.degrees(np.tan(0.5 * np.radians(90.0 - self.pole * lat)))
        return radius * np.sin(np.radians(lon)), -radius * np.cos(np.radians(lon))


def make_triangle_bins(
    plane: MapPlane, lat: FloatArray, lon: FloatArray, triangles: IntArray
) -> TriangleBins:
    """Sort triangles into bins; those with unknown corners or around a pole are omitted."""
    x, y = plane.of(lat[triangles], lon[triangles])
    if plane.pole == 0:
        x = x[:, :1] + longitude_difference(x, x[:, :1])
    whole = np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)
    whole &= (x.max(axis=1) - x.min(axis=1)) < 180.0
    if not whole.any():  # a single degenerate triangle contains no point
        x, y, whole = np.zeros_like(x), np.zeros_like(y), np.arange(len(x)) == 0
    x, y, corners = x[whole], y[whole], triangles[whole]
    if plane.pole == 0:
        x, y, corners = _repeat_across_seam(plane, x, y, corners)
    frame, counts = _refined_bins(x, y)
    n = len(counts)
    start = cumulative_sums(counts.ravel())
    items = np.empty(start[-1], np.int64)
    field_sampling.fill_bins(x, y, frame, (n, n), start[:-1].copy(), items)
    return TriangleBins(x, y, np.ascontiguousarray(corners), frame, (n, n), start, items)


def _refined_bins(x: FloatArray, y: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return bins and their counts: about as many bins as triangles, more for uneven meshes.

    Coastal meshes have small triangles in bays and large ones offshore. The measure is the number
    of triangles that a point in a small triangle is compared with.
    """
    n = max(1, int(np.sqrt(len(x))))
    low, high = (x.min(), y.min()), (x.max(), y.max())
    while True:
        width, height = max((high[0] - low[0]) / n, 1e-9), max((high[1] - low[1]) / n, 1e-9)
        frame = np.array([low[0], low[1], width, height])
        counts = np.zeros((n, n), np.int64)
        field_sampling.count_bins(x, y, frame, counts)
        total = float(counts.sum())
        crowd = float((counts.astype(np.float64) ** 2).sum()) / total
        if (
            crowd <= MAX_TRIANGLES_PER_BIN
            or n >= MAX_BINS
            or total > MAX_ITEMS_PER_TRIANGLE * max(len(x), 1000)
        ):
            return frame, counts
        n *= 2


def _repeat_across_seam(
    plane: MapPlane, x: FloatArray, y: FloatArray, corners: IntArray
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Repeat triangles that extend over one edge of the plane at its other edge."""
    right = x.max(axis=1) > plane.west + 360.0 - 2.0 * EDGE_TOLERANCE
    left = (
        x.min(axis=1) < plane.west - EDGE_TOLERANCE + 1e-9
    )  # points start slightly before the edge
    return (
        np.concatenate([x, x[right] - 360.0, x[left] + 360.0]),
        np.concatenate([y, y[right], y[left]]),
        np.concatenate([corners, corners[right], corners[left]]),
    )


def _narrowest_range(lon: FloatArray) -> tuple[float, float]:
    """Return west edge in [-180, 180) and width [deg] of the narrowest range of longitudes."""
    ordered = np.unique(lon % 360.0)
    gaps = np.diff(np.append(ordered, ordered[0] + 360.0))
    k = int(np.argmax(gaps))
    west = float(ordered[(k + 1) % ordered.size])
    return (west + 180.0) % 360.0 - 180.0, 360.0 - float(gaps[k])


def curvilinear_grid(lat: FloatArray, lon: FloatArray) -> TriangleGrid:
    """Return the grid of 2-D coordinates (Y, X) [deg]; each cell is divided into two triangles."""
    rows, columns = lat.shape
    place = np.arange(rows * columns, dtype=np.int64).reshape(rows, columns)
    a, b = place[:-1, :-1].ravel(), place[:-1, 1:].ravel()
    c, d = place[1:, 1:].ravel(), place[1:, :-1].ravel()
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleGrid(
        np.ascontiguousarray(lat, np.float64).ravel(),
        np.ascontiguousarray(lon, np.float64).ravel(),
        triangles,
        (rows, columns),
    )
