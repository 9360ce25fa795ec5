"""What the sea room hands to others: frozen fields for kernels, coverage, meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class StationFields:
    """The sea at fixed stations, frozen for kernels that interpolate in time only.

    Attributes
    ----------
    times : float64 array (T,)
        Strictly increasing [s since 1970-01-01T00:00Z].
    values : float32 array (S, T, K)
        C order; one slice per channel that is present; NaN where unknown.
    channel_index : int64 array (CHANNELS,)
        Channel of `thalweg.kernels.codes` to its place in the last axis, -1 if absent.
    """

    times: FloatArray
    values: NDArray[np.float32]
    channel_index: IntArray


@dataclass(frozen=True, eq=False)
class GridFields:
    """The sea on a regular raster, frozen for kernels that interpolate in space and time.

    Attributes
    ----------
    times : float64 array (T,)
        Strictly increasing [s since 1970-01-01T00:00Z].
    lat0, dlat, lon0, dlon : float
        South-west corner and spacing [deg]. Longitude is unwrapped: column x lies at
        ``lon0 + x * dlon``, which may pass 180; shift a query by 360 to fit.
    values : float32 array (T, Y, X, K)
        C order; NaN where unknown.
    channel_index : int64 array (CHANNELS,)
        Channel of `thalweg.kernels.codes` to its place in the last axis, -1 if absent.
    """

    times: FloatArray
    lat0: float
    dlat: float
    lon0: float
    dlon: float
    values: NDArray[np.float32]
    channel_index: IntArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and triangles of an unstructured grid.

    Attributes
    ----------
    lat, lon : float64 array (N,)
        Nodes [deg].
    triangles : int64 array (M, 3)
        Indices of nodes.
    """

    lat: FloatArray
    lon: FloatArray
    triangles: IntArray


@dataclass(frozen=True, eq=False)
class Area:
    """A box on the sphere.

    Attributes
    ----------
    south, north : float
        Latitudes [deg].
    west, east : float
        Longitudes [deg]; ``east`` may pass 180 so that ``east >= west``.
    """

    south: float
    north: float
    west: float
    east: float

    def covers(
        self, lat: FloatArray, lon: FloatArray, tolerance: float = 2e-5
    ) -> NDArray[np.bool_]:
        """Return whether positions lie in the box, its rim included."""
        width = self.east - self.west
        inside = (lat >= self.south - tolerance) & (lat <= self.north + tolerance)
        if width >= 360.0 - tolerance:
            return inside & np.isfinite(lon)
        offset = (lon - self.west + tolerance) % 360.0
        return inside & (offset <= width + 2.0 * tolerance)


WORLD = Area(-90.0, 90.0, -180.0, 180.0)


@dataclass(frozen=True, eq=False)
class Coverage:
    """Where and when one variable of one layer is known.

    Attributes
    ----------
    variable : str
        Canonical name.
    south, north, west, east : float
        Box [deg]; ``east`` may pass 180.
    start, end : float or None
        Period [s since epoch]; None if always.
    step_s : float or None
        Median time step [s]; None for a single or no time.
    spacing_deg : float or None
        Typical spacing of the grid [deg of latitude]; None for formulas.
    source : str
        File name or a word for the formula.
    """

    variable: str
    south: float
    north: float
    west: float
    east: float
    start: float | None
    end: float | None
    step_s: float | None
    spacing_deg: float | None
    source: str
