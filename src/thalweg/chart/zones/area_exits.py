"""Where ships leave emission control areas: outlines in water, and canals that lead out."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.zones.leg_fractions import outlines_only
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import METRES_PER_DEGREE
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.geometry.coast_index import outlines_touched

if TYPE_CHECKING:
    from thalweg.chart.canals import Canal
    from thalweg.chart.coast.coastline import Coastline
    from thalweg.chart.zones.zone_set import Zones

_STEP: Final = 0.05  # between positions on outlines [deg]
MARGIN_OF_EXITS: Final = 0.5 * _STEP * METRES_PER_DEGREE  # [m]
_BESIDE_OUTLINE: Final = 1e-4  # [deg]


def area_exits(
    zones: Zones, coastline: Coastline, canals: Iterable[Canal]
) -> tuple[FloatArray, FloatArray]:
    """Return positions (lat, lon) [deg] at the ways out of the control areas.

    Every way out passes one of them no farther away than `MARGIN_OF_EXITS`. Ships leave the areas
    where an outline is in water and no other area is beyond it, or through a canal that leads out.
    """
    found = [(np.empty(0), np.empty(0))]
    coast = outlines_only(coastline.index)
    for zone in zones.eca:
        rings = zone.rings
        for first, last in itertools.pairwise(rings.start):
            lat, lon = _short_pieces(rings.lat[first:last], rings.lon[first:last])
            ends = lat[:-1], lon[:-1], lat[1:], lon[1:]
            shore = np.empty(len(lat) - 1, np.bool_)
            outlines_touched(coast, *(np.ascontiguousarray(x) for x in ends), shore)
            land = np.asarray(coastline.shore_distance(lat[:-1], lon[:-1], cap=1.0)) <= 0.0
            leads_out = (shore | ~land) & ~_between_areas(zones, *ends)
            middle = 0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1])
            found.append((middle[0][leads_out], middle[1][leads_out]))
    for canal in canals:
        lat, lon = np.array(canal.ends).T
        inside = zones.in_eca(lat, lon)
        if inside.any() and not inside.all():
            found.append((lat, lon))
    lat, lon = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return lat, lon


def _short_pieces(lat: FloatArray, lon: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a line [deg] with more positions, so that no piece is longer than the step."""
    pieces = np.ceil(np.hypot(np.diff(lat), np.diff(lon)) / _STEP)
    place = cumulative_sums(np.maximum(pieces, 1.0))
    along = np.arange(place[-1] + 1.0)
    return np.interp(along, place, lat), np.interp(along, place, lon)


def _between_areas(zones: Zones, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray,
                   lon2: FloatArray) -> BoolArray:  # fmt: skip
    """Return on which pieces of outlines [deg] there are control areas on both sides."""
    both = np.ones(len(lat1), np.bool_)
    for share in (0.0, 0.5, 1.0):
        lat, lon = lat1 + share * (lat2 - lat1), lon1 + share * (lon2 - lon1)
        for north, east in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
            both &= zones.in_eca(lat + _BESIDE_OUTLINE * north, lon + _BESIDE_OUTLINE * east)
    return both
