"""Lower bounds of geodesic distances that obey the triangle inequality, for A*."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.geodesy import EQUATORIAL_RADIUS, FLATTENING
from thalweg.core.types import FloatArray

# The least radius of curvature of the meridian. Distances on a sphere of this radius, at the same
# latitudes and longitudes, are lower bounds of those on the ellipsoid, and obey the triangle
# inequality together with geodesic edge lengths.
BOUND_RADIUS: Final = EQUATORIAL_RADIUS * (1.0 - FLATTENING) ** 2

ROUNDING_FACTOR: Final = 1.0 - 1e-9  # keeps bounds below the exact value in floating point


def distance_bounds(lat: ArrayLike, lon: ArrayLike, to_lat: float, to_lon: float) -> FloatArray:
    """Return lower bounds of the geodesic distance [m] from positions to one position [deg].

    Great-circle distances on the sphere of the ellipsoid's least radius of curvature: at most
    0.6 % below the mean-radius sphere, never above the geodesic, and consistent for A*.

    Parameters
    ----------
    lat, lon : Positions [deg].
    to_lat, to_lon : The other position [deg].
    """
    phi, to_phi = np.radians(np.asarray(lat, float)), np.radians(to_lat)
    half_dlon = 0.5 * np.radians(np.asarray(lon, float) - to_lon)
    square = np.sin(0.5 * (phi - to_phi)) ** 2
    square += np.cos(phi) * np.cos(to_phi) * np.sin(half_dlon) ** 2
    bound = 2.0 * BOUND_RADIUS * ROUNDING_FACTOR * np.arcsin(np.sqrt(np.minimum(square, 1.0)))
    return np.asarray(bound)
