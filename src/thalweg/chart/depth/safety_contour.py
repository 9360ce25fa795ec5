"""Distance of positions from water that is too shallow, by charted depth."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import ArrayLike

from thalweg.chart.depth.depth_grids import DepthGrid
from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.core.geodesy import geocentric_unit_vectors, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

CONTOUR_DISTANCE_CAP: Final = 5.0 * NAUTICAL_MILE  #: larger distances count as this [m]
_TILE: Final = 0.25  # side of the tiles that are searched at once [deg]
_FINEST, _COARSEST = 0.05 * NAUTICAL_MILE, 0.25 * NAUTICAL_MILE  # spacing of the samples [m]
_METRES_PER_DEGREE: Final = math.radians(1.0) * MEAN_RADIUS


class ChartedDepth(Protocol):
    """What a contour needs of `thalweg.chart.depth.depth_layers.DepthLayers`."""

    @property
    def layers(self) -> tuple[Any, ...]:
        """Grids and functions of depth."""

    def at(self, lat: ArrayLike, lon: ArrayLike, *, least: bool = False) -> FloatArray:
        """Return the depth [m] at positions [deg]."""


@dataclass(frozen=True, eq=False)
class SafetyContour:
    """The line between water that is deep enough and water that is not.

    Attributes
    ----------
    depths : ChartedDepth
        Charted depth.
    required : float
        Least depth that is enough [m], without tide.
    """

    depths: ChartedDepth
    required: float
    _tiles: dict[tuple[int, int], Any] = field(default_factory=dict, repr=False)

    @property
    def spacing(self) -> float:
        """Spacing of the samples of the depth [m]; distances are right to half of it."""
        steps = [
            float(np.median(np.diff(layer.lat))) if isinstance(layer, DepthGrid) else math.nan
            for layer in self.depths.layers
        ]
        finest = np.fmin.reduce([*steps, _COARSEST / _METRES_PER_DEGREE]) * _METRES_PER_DEGREE
        return float(np.clip(finest, _FINEST, _COARSEST))

    def distance(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the distance of positions [deg] from water that is too shallow [m].

        0 inside it, `CONTOUR_DISTANCE_CAP` where it is farther, NaN where the depth is unknown.
        """
        lat, lon = np.asarray(lat, float), np.asarray(wrap_longitude(np.asarray(lon, float)))
        here = self.depths.at(lat, lon)
        found = np.where(here < self.required, 0.0, CONTOUR_DISTANCE_CAP)
        rows, columns = np.floor(lat / _TILE).astype(int), np.floor(lon / _TILE).astype(int)
        afloat = here >= self.required
        for row, column in set(zip(rows[afloat].tolist(), columns[afloat].tolist())):
            tree = self._tile(row, column)
            chosen = np.flatnonzero(afloat & (rows == row) & (columns == column))
            if tree is not None:
                chord, _ = tree.query(geocentric_unit_vectors(lat[chosen], lon[chosen]))
                found[chosen] = np.minimum(chord * MEAN_RADIUS, CONTOUR_DISTANCE_CAP)
        return np.where(np.isnan(here), math.nan, found)

    def _tile(self, row: int, column: int) -> Any:
        """Return the search tree of the shallow samples near a tile; None where there are none."""
        from scipy.spatial import cKDTree

        if (row, column) not in self._tiles:
            shallow = self._shallow_near(row, column)
            self._tiles[row, column] = cKDTree(shallow) if len(shallow) else None
        return self._tiles[row, column]

    def _shallow_near(self, row: int, column: int) -> FloatArray:
        margin = CONTOUR_DISTANCE_CAP / _METRES_PER_DEGREE
        south, north = row * _TILE - margin, (row + 1) * _TILE + margin
        wide = 1.0 / max(math.cos(math.radians(min(max(abs(south), abs(north)), 89.0))), 0.02)
        west, east = column * _TILE - margin * wide, (column + 1) * _TILE + margin * wide
        step = self.spacing / _METRES_PER_DEGREE
        lat = np.arange(max(south, -90.0), min(north, 90.0), step)
        lon = np.arange(west, east, step * wide)
        y, x = np.meshgrid(lat, lon, indexing="ij")
        shallow = self.depths.at(y, wrap_longitude(x), least=True) < self.required
        inner = shallow.copy()  # shallow with shallow water on all sides is never the nearest
        for axis in (0, 1):
            for shift in (-1, 1):
                inner &= np.roll(shallow, shift, axis)
        inner[[0, -1], :] = inner[:, [0, -1]] = False
        edge = shallow & ~inner
        return np.asarray(geocentric_unit_vectors(y[edge], x[edge]))
