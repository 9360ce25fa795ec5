"""The depth layer of the package: ETOPO1 at every tenth of a degree, for all oceans.

Points of ETOPO1 (Amante and Eakins 2009, NOAA, doi:10.7289/V5C8276M), not means over cells: a shoal
or a channel narrower than about 6 nautical miles can be missing. Depths are below mean sea level,
in whole metres, at most 254 m. `tools/make_global_depth.py` makes the file.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.types import FloatArray
from thalweg.kernels.geometry.shoal_excess import grid_depths

DEEPEST: Final = 254.0  #: greatest depth of the layer [m]; deeper water has this value
NAME: Final = "global depth layer (ETOPO1, 0.1 degree)"  #: how messages name it


@cache
def global_depth_codes() -> NDArray[np.uint8]:
    """Return the layer as `thalweg.kernels.geometry.shoal_excess.ShoalArrays.code`.

    Returns
    -------
    uint8 array (1801, 3600) : Depth [m] plus 1 from 90 S and 180 W on; 0 on land.
    """
    place = resources.files("thalweg.chart").joinpath("data/depth_6min.npz")
    with place.open("rb") as file, np.load(file, allow_pickle=False) as data:
        return np.ascontiguousarray(data["code"])


def coarse_depth(lat: ArrayLike, lon: ArrayLike) -> FloatArray:
    """Return the depth between the nearest points of the layer that are water.

    Parameters
    ----------
    lat, lon : Positions [deg]; broadcast together.

    Returns
    -------
    ndarray : Depth [m below mean sea level], 0 to 254; NaN where the four points round a position
        are land.
    """
    a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
    depth = np.full(a.size, np.nan)
    y, x = a.flatten(), b.flatten()
    known = np.isfinite(y) & np.isfinite(x)
    found = np.empty(int(known.sum()))
    grid_depths(global_depth_codes(), y[known], x[known], found)
    depth[known] = found
    return depth.reshape(a.shape)
