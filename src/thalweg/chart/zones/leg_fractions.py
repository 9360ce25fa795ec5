"""Fraction of a leg inside polygons, exact along the geodesic."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.coast.coast_index_builder import empty_index
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.core.geodesy import direct, inverse, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import LAND
from thalweg.kernels.geometry.coast_index import CoastArrays, outlines_touched, point_codes
from thalweg.kernels.geometry.cube_sphere import ALL_LAND, IndexArrays
from thalweg.kernels.geometry.polygon_fractions import fractions_by_bisection, middles_inside

CROSSING_TOLERANCE: Final = 0.25  # pieces this short are not split further [m]
MAX_PART_LENGTH: Final = 400_000.0  # longer legs are first split into such pieces [m]
_STRAIGHT: Final = 50_000.0  # pieces of legs are straight in degrees up to this length [m]
_WORLD: Final = np.array([-90.0, 90.0, -180.0, 360.0])


def outlines_only(index: IndexArrays) -> IndexArrays:
    """Return the index without its insides: legs within a polygon touch nothing."""
    inside = index.cell == np.float32(ALL_LAND)
    return index._replace(cell=np.where(inside, np.float32(0.0), index.cell))


def points_inside(index: IndexArrays, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
    """Return which positions [deg] lie inside the polygons of an index; arrays of one dimension.

    Parameters
    ----------
    index : Index of polygons.
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    bool array (n,) : Whether each is inside.
    """
    code = np.empty(len(lat), np.int8)
    flat = [np.require(x, float, ("C", "W")) for x in (lat, lon)]
    point_codes(CoastArrays(index, empty_index(), _WORLD), flat[0], flat[1], code)
    return np.asarray(code == LAND)


def _midpoints_inside(
    index: IndexArrays, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> NDArray[np.bool_]:
    within = np.empty(len(lat1), np.bool_)
    legs = [np.require(x, float, ("C", "W")) for x in (lat1, lon1, lat2, lon2)]
    middles_inside(index, *legs, within)
    return within


def fractions_inside(
    index: IndexArrays,
    outlines: IndexArrays,
    lat1: FloatArray,
    lon1: FloatArray,
    lat2: FloatArray,
    lon2: FloatArray,
    *,
    finest: float = CROSSING_TOLERANCE,
) -> FloatArray:
    """Return the share of the length of each geodesic leg [deg] inside the polygons of an index.

    ``outlines`` is `outlines_only` of the index.

    Legs that cross no outline are classified by their midpoint. The others are bisected where they
    touch one, until the pieces are shorter than ``finest`` [m], the accuracy of each crossing.
    NaN where a position is not a number.
    """
    legs = [np.require(x, float, ("C", "W")) for x in (lat1, lon1, lat2, lon2)]
    known = (
        np.isfinite(legs[0]) & np.isfinite(legs[1]) & np.isfinite(legs[2]) & np.isfinite(legs[3])
    )
    if not known.all():
        share = np.full(len(known), np.nan)
        share[known] = fractions_inside(index, outlines, *(x[known] for x in legs), finest=finest)
        return share
    touched = np.empty(len(known), np.bool_)
    outlines_touched(outlines, *legs, touched)
    share = np.zeros(len(known))
    whole = np.flatnonzero(~touched)
    share[whole] = _midpoints_inside(index, *(x[whole] for x in legs))
    cut = np.flatnonzero(touched)
    if len(cut):
        share[cut] = _fractions_by_bisection(
            index, outlines, *(x[cut] for x in legs), finest=finest
        )
    return share


def _fractions_by_bisection(
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
    parts = np.maximum(np.ceil(length / MAX_PART_LENGTH), 1.0).astype(np.int64)
    leg, number = numbered_parts(parts)

    def ends(share: FloatArray) -> tuple[FloatArray, FloatArray]:
        lat, lon = direct(lat1[leg], lon1[leg], course[leg], share * length[leg])
        lat, lon = (np.where(share <= 0.0, x[leg], y) for x, y in ((lat1, lat), (lon1, lon)))
        lat, lon = (np.where(share >= 1.0, x[leg], y) for x, y in ((lat2, lat), (lon2, lon)))
        return lat, lon

    low, high = ends(number / parts[leg]), ends((number + 1) / parts[leg])
    share = np.empty(len(leg))
    fractions_by_bisection(index, outlines, *low, *high, finest / MEAN_RADIUS, share)
    return np.minimum(np.bincount(leg, share / parts[leg], minlength=len(parts)), 1.0)


def straight_pieces(
    lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> tuple[Any, NDArray[np.int64], FloatArray]:
    """Return pieces of the geodesics as lines, the leg of each, and each leg's count."""
    import shapely

    length, course, _ = inverse(lat1, lon1, lat2, lon2)
    pieces = np.maximum(np.ceil(length / _STRAIGHT), 1.0).astype(np.int64)
    leg, number = numbered_parts(pieces)
    sides = []
    for share in (number / pieces[leg], (number + 1) / pieces[leg]):
        lat, lon = direct(lat1[leg], lon1[leg], course[leg], share * length[leg])
        sides.append((lon, lat))
    (x0, y0), (x1, y1) = sides
    x1 = x0 + wrap_longitude(x1 - x0)
    ends = np.stack([np.stack([x0, y0], -1), np.stack([x1, y1], -1)], 1)
    return shapely.linestrings(ends), leg, pieces.astype(float)
