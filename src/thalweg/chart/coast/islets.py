"""Islets that the intermediate scale of GSHHG leaves out, as the boxes round them.

Scale i has islands above about 1 km2 only. ``data/islets.npz`` holds the smaller ones of scale f
that are more than half a nautical mile from land of scale i; nearer ones are within the least
offing of that land. ``tools/make_islets.py`` makes the file. Rocks awash are not in GSHHG.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Final

import numpy as np

from thalweg.chart.rings import Rings

FILE: Final = "data/islets.npz"
UNITS_OF_DEGREE: Final = 2000  # positions and sides are whole numbers of this part of a degree


@cache
def islet_rings() -> Rings:
    """Return a ring, the box in latitude and longitude, round each islet.

    Returns
    -------
    Rings
        Counter-clockwise, of four corners.
    """
    place = resources.files("thalweg.chart").joinpath(FILE)
    with place.open("rb") as file, np.load(file, allow_pickle=False) as data:
        south, west = (np.cumsum(data[name], dtype=np.int64) for name in ("south", "west"))
        north, east = south + data["height"], west + data["width"]
    lat = np.stack([south, south, north, north, south], axis=-1).ravel() / UNITS_OF_DEGREE
    lon = np.stack([west, east, east, west, west], axis=-1).ravel() / UNITS_OF_DEGREE
    return Rings(lat, lon, np.arange(0, len(lat) + 1, 5, dtype=np.int64))
