"""Where a ship may wait: in anchorages if the chart has any, never in no-waiting zones.

On a chart without such zones a ship may wait at any place.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import FloatArray


def waiting_allowed(
    anchorages: Sequence[Any], barred: Sequence[Any], lat: FloatArray, lon: FloatArray
) -> NDArray[np.bool_]:
    """Return at which positions a ship may wait.

    Parameters
    ----------
    anchorages, barred : Zones of the kinds "anchorage" and "no-waiting"; lon, lat [deg].
    lat, lon : Positions [deg].
    """
    allowed: NDArray[np.bool_] = np.ones(np.shape(lat), np.bool_)
    if anchorages:
        allowed = _inside_any_zone(anchorages, lat, lon)
    if barred:
        allowed = allowed & ~_inside_any_zone(barred, lat, lon)
    return allowed


def _inside_any_zone(zones: Sequence[Any], lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
    """Return which positions lie in a zone, its rim included, on any turn of longitude."""
    import shapely

    tree = shapely.STRtree(list(zones))
    found: NDArray[np.bool_] = np.zeros(np.shape(lat), np.bool_)
    y, x = np.ravel(lat), wrap_longitude(np.ravel(lon))
    flat = found.reshape(-1)
    for turn in (-360.0, 0.0, 360.0):
        flat[tree.query(shapely.points(x + turn, y), predicate="intersects")[0]] = True
    return flat.reshape(found.shape)
