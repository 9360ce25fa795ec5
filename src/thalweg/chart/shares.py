"""How much of a leg lies inside polygons: exact along the geodesic, quick where none is touched."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.index import empty_index
from thalweg.chart.rings import Rings
from thalweg.core.geodesy import FloatArray, direct, inverse
from thalweg.kernels.coast import CoastArrays, outlines_touched, point_codes
from thalweg.kernels.codes import LAND
from thalweg.kernels.cube import ALL_LAND, IndexArrays
from thalweg.kernels.zones import middles_inside

PARTS: Final = 16  # pieces that a touched piece is cut into
FINEST: Final = 0.25  # pieces this short are taken whole [m]
MOST_PIECES: Final = 512  # of one leg at one level: a leg that runs along an outline
IntArray = NDArray[np.int64]
_WORLD: Final = np.array([-90.0, 90.0, -180.0, 360.0])


def outlines_only(index: IndexArrays) -> IndexArrays:
    """Return the index without its insides: legs within a polygon touch nothing."""
    inside = index.cell == np.float32(ALL_LAND)
    return index._replace(cell=np.where(inside, np.float32(0.0), index.cell))


def points_inside(index: IndexArrays, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
    """Return which positions [deg] lie inside the polygons of an index; arrays of one dimension."""
    code = np.empty(len(lat), np.int8)
    flat = [np.require(x, float, ("C", "W")) for x in (lat, lon)]
    point_codes(CoastArrays(index, empty_index(), _WORLD), flat[0], flat[1], code)
    return np.asarray(code == LAND)


def _middles(
    index: IndexArrays, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> NDArray[np.bool_]:
    within = np.empty(len(lat1), np.bool_)
    legs = [np.require(x, float, ("C", "W")) for x in (lat1, lon1, lat2, lon2)]
    middles_inside(index, *legs, within)
    return within


def shares_inside(
    index: IndexArrays,
    outlines: IndexArrays,
    lat1: FloatArray,
    lon1: FloatArray,
    lat2: FloatArray,
    lon2: FloatArray,
    *,
    finest: float = FINEST,
) -> FloatArray:
    """Return the share of the length of each geodesic leg [deg] inside the polygons of an index.

    ``outlines`` is `outlines_only` of the index.

    Legs that touch no outline are told by their middle. The others are cut into sixteenths, and
    those again that touch an outline, until pieces are shorter than ``finest`` [m]: each crossing
    is found to that. NaN where a position is no number.
    """
    legs = [np.require(x, float, ("C", "W")) for x in (lat1, lon1, lat2, lon2)]
    known = (
        np.isfinite(legs[0]) & np.isfinite(legs[1]) & np.isfinite(legs[2]) & np.isfinite(legs[3])
    )
    if not known.all():
        share = np.full(len(known), np.nan)
        share[known] = shares_inside(index, outlines, *(x[known] for x in legs), finest=finest)
        return share
    touched = np.empty(len(known), np.bool_)
    outlines_touched(outlines, *legs, touched)
    share = np.zeros(len(known))
    whole = np.flatnonzero(~touched)
    share[whole] = _middles(index, *(x[whole] for x in legs))
    cut = np.flatnonzero(touched)
    if len(cut):
        share[cut] = _refined(index, outlines, *(x[cut] for x in legs), finest=finest)
    return share


def _refined(
    index: IndexArrays,
    outlines: IndexArrays,
    lat1: FloatArray,
    lon1: FloatArray,
    lat2: FloatArray,
    lon2: FloatArray,
    *,
    finest: float,
) -> FloatArray:
    """Return shares of legs that touch an outline."""
    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    share = np.zeros(len(length))
    leg = np.arange(len(length))
    start, size = np.zeros(len(leg)), np.ones(len(leg))  # as parts of the leg
    while len(leg):
        done = size * length[leg] <= finest
        done |= np.bincount(leg, minlength=len(length))[leg] > MOST_PIECES
        if done.any():
            middle = (start[done] + 0.5 * size[done]) * length[leg[done]]
            lat, lon = direct(lat1[leg[done]], lon1[leg[done]], course[leg[done]], middle)
            share += np.bincount(
                leg[done], size[done] * points_inside(index, lat, lon), minlength=len(length)
            )
            leg, start, size = leg[~done], start[~done], size[~done]
            if not len(leg):
                break
        cuts = np.arange(PARTS + 1) / PARTS
        at = (start[:, None] + cuts * size[:, None]) * length[leg, None]
        place = np.repeat(leg, PARTS + 1)
        lat, lon = direct(lat1[place], lon1[place], course[place], at.ravel())
        lat, lon = lat.reshape(-1, PARTS + 1), lon.reshape(-1, PARTS + 1)
        a = lat[:, :-1].ravel(), lon[:, :-1].ravel()
        b = lat[:, 1:].ravel(), lon[:, 1:].ravel()
        start = (start[:, None] + cuts[:-1] * size[:, None]).ravel()
        size = np.repeat(size / PARTS, PARTS)
        leg = np.repeat(leg, PARTS)
        touched = np.empty(len(leg), np.bool_)
        outlines_touched(outlines, a[0], a[1], b[0], b[1], touched)
        clear = ~touched
        inside = _middles(index, *(x[clear] for x in (*a, *b)))
        share += np.bincount(leg[clear], size[clear] * inside, minlength=len(length))
        leg, start, size = leg[touched], start[touched], size[touched]
    return np.minimum(share, 1.0)


def box_touched(
    outlines: list[Rings], lat: FloatArray, lon: FloatArray, dlat: float, dlon: float
) -> NDArray[np.bool_]:
    """Return which equal boxes (south-west corners, sides [deg]) an outline may run through.

    ``lat`` and ``lon`` are the corners of a full grid of boxes, row by row from its south-west
    corner. Outlines are walked in steps of a quarter of a box, and every box within a quarter
    of one of the points counts, so that none that is touched is missed.
    """
    south, west = lat[0], lon[0]
    columns = round(float(lon[-1] - west) / dlon) + 1
    rows = len(lat) // columns
    touched = np.zeros((rows, columns), np.bool_)
    for rings in outlines:
        y0, y1, x0, x1 = rings.lat[:-1], rings.lat[1:], rings.lon[:-1], rings.lon[1:]
        keep = np.ones(len(y0), bool)
        keep[rings.start[1:-1] - 1] = False
        y0, y1, x0, x1 = (v[keep] for v in (y0, y1, x0, x1))
        parts = np.maximum(np.abs(y1 - y0) / dlat, np.abs(x1 - x0) / dlon)
        count = np.ceil(4.0 * parts).astype(np.int64) + 1
        edge = np.repeat(np.arange(len(count)), count)
        share = (np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)) / count[edge]
        y = (y0[edge] + share * (y1 - y0)[edge] - south) / dlat
        x = x0[edge] + share * (x1 - x0)[edge]
        for turn in (-360.0, 0.0, 360.0):
            for near_y in (-0.25, 0.25):
                for near_x in (-0.25, 0.25):
                    j = np.floor(y + near_y).astype(np.int64)
                    i = np.floor((x + turn - west) / dlon + near_x).astype(np.int64)
                    on = (j >= 0) & (j < rows) & (i >= 0) & (i < columns)
                    touched[j[on], i[on]] = True
    return touched.ravel()
