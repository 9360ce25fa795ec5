"""Charted depth from several layers; at each position the first layer with data counts."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.depth.depth_grids import DepthFunctionLayer, DepthGrid
from thalweg.chart.depth.safety_contour import SafetyContour
from thalweg.core.errors import InputError
from thalweg.core.geodesy import (
    geocentric_positions,
    geocentric_unit_vectors,
    positions_along,
    wrap_longitude,
)
from thalweg.core.types import Float32Array, FloatArray
from thalweg.kernels.geometry.depth_sampling import DepthArrays, depths_at_points, least_depths

MAX_SOUNDINGS: Final = 60_000_000  # soundings held in memory at once
MAX_SAMPLES: Final = 65_536  # of functions, computed at once
MAX_LEG_EXTENT: Final = 5.0  # legs wider than this are split first [deg]
DEFAULT_SAMPLE_SPACING: Final = (
    1.0 / 600.0
)  # legs are sampled this close on functions without a spacing [deg]
ALL_LAYERS: Final = -1
Box = tuple[float, float, float, float]


@dataclass(frozen=True)
class DepthLayers:
    """Layers of depth by priority; parts of them are read and cached when needed."""

    layers: tuple[DepthGrid | DepthFunctionLayer, ...] = ()
    _kept: dict[int, tuple[Box, DepthArrays]] = field(
        default_factory=dict, compare=False, repr=False
    )
    _contours: dict[float, SafetyContour] = field(default_factory=dict, compare=False, repr=False)

    def safety_contour(self, required: float) -> SafetyContour:
        """Return where the charted depth is less than required [m]; made once for each depth."""
        if required not in self._contours:
            own = DepthLayers(self.layers)  # its small boxes do not displace those held here
            self._contours[required] = SafetyContour(own, required)
        return self._contours[required]

    def arrays(self, box: Box, only: int = ALL_LAYERS) -> DepthArrays:
        """Return all layers (or one) in a box [deg] for kernels; longitudes count modulo 360.

        Raises
        ------
        InputError : If that is too much to hold in memory.
        """
        cached = self._kept.get(only)
        if cached is not None and _covers(cached[0], box):
            return cached[1]
        cells = self._cells(box, only)
        if cells > MAX_SOUNDINGS:
            raise InputError(
                f"The depth of this box has {cells / 1e6:.0f} million soundings.",
                f"At most {MAX_SOUNDINGS / 1e6:.0f} million are read at once.",
                "Use a smaller box, or a coarser depth file.",
            )
        wider = _box_with_margin(box)
        box = wider if self._cells(wider, only) <= MAX_SOUNDINGS else box
        arrays = _pack_windows([layer.window(*box) for layer in self._chosen(only)])
        self._kept[only] = (box, arrays)
        return arrays

    def _chosen(self, only: int) -> tuple[DepthGrid | DepthFunctionLayer, ...]:
        return self.layers if only == ALL_LAYERS else self.layers[only : only + 1]

    def _cells(self, box: Box, only: int) -> float:
        """Return roughly how many soundings a box holds."""
        south, north, west, east = box
        total = 0.0
        for layer in self._chosen(only):
            if isinstance(layer, DepthGrid):
                tall = min(north, layer.lat[-1]) - max(south, layer.lat[0])
                share = min((east - west) / (layer.lon[-1] - layer.lon[0]), 1.0)
                rows = max(tall, 0.0) / (layer.lat[-1] - layer.lat[0]) * len(layer.lat)
                total += (rows + 3.0) * (share * len(layer.lon) + 3.0)
            elif layer.spacing_deg:
                total += (north - south) * (east - west) / layer.spacing_deg**2
            else:
                total += 1e6
        return total

    def at(self, lat: ArrayLike, lon: ArrayLike, *, least: bool = False) -> FloatArray:
        """Return the depth [m] at positions [deg], NaN where no layer has data.

        Bilinear, or the least of the soundings round each position.
        """
        a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        y, x = np.ascontiguousarray(a).ravel(), np.ascontiguousarray(b).ravel()
        depth = np.full(len(y), np.nan)
        todo = np.isfinite(y) & np.isfinite(x)
        for number, layer in enumerate(self.layers):
            k = np.flatnonzero(todo)
            if not len(k):
                break
            if isinstance(layer, DepthFunctionLayer):
                depth[k] = layer.at(y[k], x[k])
            else:
                depth[k] = self._points(y[k], x[k], number, least)
            todo &= np.isnan(depth)
        return depth.reshape(a.shape)

    def _points(self, lat: FloatArray, lon: FloatArray, only: int, least: bool) -> FloatArray:
        """Return depth from one grid at flat positions, in parts if they spread far."""
        depth = np.empty(len(lat))
        box = _enclosing_box(lat, lon)
        if len(lat) > 1 and self._cells(box, only) > MAX_SOUNDINGS:
            left = _half_mask(lat, lon, box)
            for part in (left, ~left):
                depth[part] = self._points(lat[part], lon[part], only, least)
            return depth
        depths_at_points(self.arrays(box, only), lat, lon, least, depth)
        return depth

    def along(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> Float32Array:
        """Return the least depth [m] on each leg [deg]; infinite without layers, NaN unknown."""
        ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
        if not self.layers:
            return np.full(ends[0].shape, np.inf, np.float32)
        a, b, c, d = (np.ascontiguousarray(x).ravel() for x in ends)
        d = b + wrap_longitude(d - b)
        return self._legs(a, b, c, d).reshape(ends[0].shape)

    def _legs(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> Float32Array:
        depth = np.full(len(lat1), np.nan, np.float32)
        width = np.maximum(np.abs(lon2 - lon1), np.abs(lat2 - lat1))
        known = np.isfinite(width)
        long = known & (width > MAX_LEG_EXTENT)
        for k in np.flatnonzero(long):
            depth[k] = self._least_depth_of_long_leg(lat1[k], lon1[k], lat2[k], lon2[k])
        short = np.flatnonzero(known & ~long)
        if not len(short):
            return depth
        a, b, c, d = (x[short] for x in (lat1, lon1, lat2, lon2))
        sampled = any(isinstance(layer, DepthFunctionLayer) for layer in self.layers)
        box = _enclosing_box(np.append(a, c), np.append(b, d))
        crowded = len(short) * 65 > MAX_SOUNDINGS / 10 if sampled else False
        if len(short) > 1 and (crowded or self._cells(box, ALL_LAYERS) > MAX_SOUNDINGS):
            left = _half_mask(a, b, box)
            for part in (left, ~left):
                depth[short[part]] = self._legs(a[part], b[part], c[part], d[part])
        elif sampled:
            depth[short] = self._sampled_least_depth(a, b, c, d)
        else:
            found = np.empty(len(short), np.float32)
            least_depths(self.arrays(box), a, b, c, d, found)
            depth[short] = found
        return depth

    def _sampled_least_depth(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> FloatArray:
        """Return the least depth at samples of legs, for layers that are functions."""
        steps = [
            x.spacing_deg or DEFAULT_SAMPLE_SPACING
            for x in self.layers
            if isinstance(x, DepthFunctionLayer)
        ]
        for layer in self.layers:
            if isinstance(layer, DepthGrid):
                steps += [np.diff(layer.lat).min() / 2.0, np.diff(layer.lon).min() / 2.0]
        widest = float(np.maximum(np.abs(lon2 - lon1), np.abs(lat2 - lat1)).max())
        count = min(max(math.ceil(widest / min(steps)), 8), 2048)
        least = np.full(len(lat1), np.inf)
        a, b = geocentric_unit_vectors(lat1, lon1), geocentric_unit_vectors(lat2, lon2)
        shares = np.arange(count + 1) / count
        parts = min(math.ceil(len(shares) * len(least) / MAX_SAMPLES), len(shares))
        for some in np.array_split(shares, parts):
            places = a + some[:, None, None] * (b - a)
            depth = self.at(*geocentric_positions(places), least=True)
            least = np.minimum(least, depth.min(axis=0))
        return least

    def _least_depth_of_long_leg(self, lat1: float, lon1: float, lat2: float, lon2: float) -> float:
        """Return the least depth of a leg split along its geodesic."""
        wide = max(abs(lon2 - lon1), abs(lat2 - lat1))
        lat, lon = positions_along(
            lat1, lon1, lat2, lon2, np.linspace(0.0, 1.0, int(wide / 2.0) + 2)
        )
        lat[0], lat[-1] = lat1, lat2
        return float(np.min(self.along(lat[:-1], lon[:-1], lat[1:], lon[1:])))  # NaN wins


def _box_with_margin(box: Box) -> Box:
    """Return a box a quarter larger in each direction, so that it covers nearby legs as well."""
    south, north, west, east = box
    tall, wide = 0.25 * (north - south) + 0.1, 0.25 * (east - west) + 0.1
    return max(south - tall, -90.0), min(north + tall, 90.0), west - wide, east + wide


def _pack_windows(
    windows: list[tuple[tuple[float, float, float, float], Float32Array] | None],
) -> DepthArrays:
    found = [w for w in windows if w is not None and min(w[1].shape) > 1]
    grids = np.array([g for g, _ in found], float).reshape(-1, 4)
    shapes = np.array([v.shape for _, v in found], np.int64).reshape(-1, 2)
    sizes = shapes[:, 0] * shapes[:, 1]
    if not found and windows:  # layers that do not reach here: unknown, not unchecked
        nothing = np.full((2, 2), np.nan, np.float32)
        return _pack_windows([((0.0, 1.0, 0.0, 1.0), nothing)])
    flat = [np.ascontiguousarray(v, np.float32).ravel() for _, v in found]
    values = np.concatenate(flat) if flat else np.empty(0, np.float32)
    return DepthArrays(grids, shapes, (np.cumsum(sizes) - sizes).astype(np.int64), values)


def _enclosing_box(lat: FloatArray, lon: FloatArray) -> Box:
    return float(lat.min()), float(lat.max()), float(lon.min()), float(lon.max())


def _covers(kept: Box, box: Box) -> bool:
    return kept[0] <= box[0] and kept[1] >= box[1] and kept[2] <= box[2] and kept[3] >= box[3]


def _half_mask(lat: FloatArray, lon: FloatArray, box: Box) -> NDArray[np.bool_]:
    """Return a mask that divides positions into two non-empty halves, across the longer side."""
    line = lat if box[1] - box[0] > box[3] - box[2] else lon
    order = np.argsort(line, kind="stable")
    left = np.zeros(len(line), bool)
    left[order[: len(line) // 2]] = True
    return left
