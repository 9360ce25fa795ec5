"""A raster of zones with prices, for kernels that test very many legs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.zones.leg_fractions import boxes_touched, points_inside
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError

OUTSIDE: Final = 0
INSIDE: Final = 1
MIXED: Final = 2
MAX_CELLS: Final = 20_000_000


@dataclass(frozen=True)
class ZoneRaster:
    """Cells of a box by whether they lie in an emission control area.

    Attributes
    ----------
    lat0, dlat, lon0, dlon : float
        Cell (y, x) reaches from ``lat0 + y dlat`` to the next and from ``lon0 + x dlon`` to the
        next [deg]; a longitude is shifted by 360 to fit.
    cell : int8 array (Y, X)
        `OUTSIDE` (0), `INSIDE` (1), or `MIXED` (2) where an outline may run through the cell. A
        leg that meets only cells of class 0, or only cells of class 1, is wholly outside or inside.
    price : float32 array (Y, X)
        Price factor (of zones of the kind "price") at the middle of the cell, 1 without zones.
    """

    lat0: float
    dlat: float
    lon0: float
    dlon: float
    cell: NDArray[np.int8]
    price: NDArray[np.float32]


def zone_raster(zones: Zones, box: BoundingBox, spacing: float) -> ZoneRaster:
    """Return the raster of a box.

    Parameters
    ----------
    zones : Zones
        Zones of a chart.
    box : BoundingBox
        Area of the raster.
    spacing : float
        Largest side of a cell [deg].

    Raises
    ------
    InputError
        If the spacing is not above zero, or that makes too many cells.
    """
    south, north, west, width = box.array().tolist()
    if not (np.isfinite(spacing) and spacing > 0.0):
        raise InputError(
            f"A raster spacing of {spacing!r} degrees cannot be used.",
            "It is an angle above zero.",
            "Give one such as 0.1.",
            field="spacing",
        )
    rows = max(1, int(np.ceil((north - south) / spacing - 1e-9)))
    columns = max(1, int(np.ceil(width / spacing - 1e-9)))
    if rows * columns > MAX_CELLS:
        raise InputError(
            f"The raster would have {rows * columns / 1e6:.0f} million cells.",
            f"At most {MAX_CELLS / 1e6:.0f} million are made.",
            "Give a smaller box or a wider spacing.",
            field="spacing",
        )
    dlat, dlon = (north - south) / rows, width / columns
    lat = south + dlat * np.arange(rows + 1)
    lon = west + dlon * np.arange(columns + 1)
    y, x = (m.ravel() for m in np.meshgrid(lat[:-1], lon[:-1], indexing="ij"))
    cell = np.zeros(len(y), np.int8)
    price = np.ones(len(y), np.float32)
    if zones.eca:
        cell[points_inside(zones.eca_index, y + 0.5 * dlat, x + 0.5 * dlon)] = INSIDE
        cell[boxes_touched([zone.rings for zone in zones.eca], y, x, dlat, dlon)] = MIXED
    if zones.price:
        middle = (y + 0.5 * dlat, x + 0.5 * dlon)
        price = zones.factors(*middle, *middle)[1].astype(np.float32)
    shape = (rows, columns)
    return ZoneRaster(south, dlat, west, dlon, cell.reshape(shape), price.reshape(shape))
