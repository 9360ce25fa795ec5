"""Polygons inside the land, and the corners at which the shortest way round them may turn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.chart.coast.coast_index_builder import build_index, empty_index
from thalweg.chart.rings import Rings
from thalweg.core.geodesy import geocentric_unit_vectors, inverse, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.kernels.geometry.coast_index import CoastArrays
from thalweg.kernels.geometry.offing_along_legs import NO_OFFING
from thalweg.search.certificate.barrier_mesh import BarrierLink
from thalweg.search.certificate.positions_in_reach import Reach

_LONGEST_EDGE: Final = 4.0  # times the root of the tolerance [deg]: see Notes of `land_inside`
_INDEX_CELLS: Final = 256  # along a side of each of the six faces
#: Of tangents: courses on a sphere are within 0.01 [rad].
ANGLE_TOLERANCE: Final = 0.02


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners of polygons, at which a shortest way may turn.

    Attributes
    ----------
    lat, lon : [deg].
    back, on : Courses to the corners before and after on the outline [rad].
    coast : Polygons a little inside and lines across closed passages, which no leg of a shortest
        way touches.
    """

    lat: FloatArray
    lon: FloatArray
    back: FloatArray
    on: FloatArray
    coast: CoastArrays


def land_inside(shapes: Sequence[Any], tolerance: float) -> list[Any]:
    """Return polygons inside some polygons, with fewer corners, by half a tolerance at least [deg].

    Notes
    -----
    Simplified outlines are within the tolerance of the outline. So what is twice the tolerance
    inside of the simplified polygon is inside the polygon, and one tolerance away from its outline.
    Edges are straight in longitude and latitude; from a geodesic between its ends an edge of
    4 sqrt(tolerance) degrees differs by less than a fifth of the tolerance below 80 degrees of
    latitude, by ``edge^2 tan(latitude) / 8``.
    """
    import shapely

    simple = shapely.simplify(shapely.make_valid(np.array(shapes)), tolerance)
    inside = shapely.buffer(simple, -2.0 * tolerance, join_style="mitre")
    parts = shapely.get_parts(shapely.simplify(inside, 0.25 * tolerance))
    parts = parts[~shapely.is_empty(parts)]
    return shortened_edges(shapely.polygons(shapely.get_exterior_ring(parts)), tolerance)


def shortened_edges(shapes: Any, tolerance: float) -> list[Any]:
    """Return polygons with edges that are near enough to geodesics for a tolerance [deg]."""
    import shapely

    return list(shapely.segmentize(np.asarray(shapes), _LONGEST_EDGE * math.sqrt(tolerance)))


def inner_polygons(shapes: Sequence[Any], tolerance: float) -> list[Any]:
    """Return polygons inside some polygons by half a tolerance [deg]."""
    import shapely

    smaller = shapely.get_parts(shapely.buffer(np.array(shapes), -0.5 * tolerance))
    return [one for one in smaller if not one.is_empty]


def places_of_turns(
    shapes: Sequence[Any], reach: Reach, links: Sequence[BarrierLink]
) -> FloatArray:
    """Return the places (lat, lon) [deg] where a way round polygons may begin or turn, (n, 2)."""
    import shapely

    corners = shapely.get_coordinates(np.array(shapes, object))[:, ::-1]
    single = np.array([reach.start, reach.goal, *(end for x in links for end in (x.one, x.other))])
    single[:, 1] = reach.middle + longitude_difference(single[:, 1], reach.middle)
    return np.concatenate([corners, single])


def corners_of(
    shapes: Sequence[Any], inner: Sequence[Any], reach: Reach, across: Sequence[FloatArray] = ()
) -> Corners:
    """Return the corners of polygons within reach at which a way can turn.

    Parameters
    ----------
    shapes : Polygons.
    inner : Polygons a little inside these, which no leg touches.
    across : Lines (n, 2) of great circles [deg] that no leg crosses.
    """
    import shapely

    rings = [shapely.get_coordinates(one.exterior)[:, ::-1] for one in inner]
    index = build_index(Rings.from_lists((ring, False) for ring in rings), _INDEX_CELLS)
    area = np.array([-90.0, 90.0, -180.0, 360.0])
    pieces = [
        geocentric_unit_vectors(line[[k, k + 1], 0], line[[k, k + 1], 1]).ravel()
        for line in across
        for k in range(len(line) - 1)
    ]
    gates = NO_OFFING._replace(gate=np.array(pieces).reshape(-1, 6))
    lines = [
        shapely.get_coordinates(one.exterior)[:-1, ::-1] for one in shapely.normalize(shapes)
    ]  # clockwise: land is to starboard of the way on
    places, last, further = (
        np.concatenate([np.roll(line, by, axis=0) for line in lines]) for by in (0, 1, -1)
    )
    kept = reach.has(places[:, 0], places[:, 1])
    places, last, further = places[kept], last[kept], further[kept]
    back, on = (inverse(*places.T, *beside.T)[1] for beside in (last, further))
    angle = (back - on) % (2.0 * math.pi)
    turns = angle <= math.pi + ANGLE_TOLERANCE
    return Corners(
        places[turns, 0], places[turns, 1], back[turns], on[turns],
        CoastArrays(index, empty_index(), area, gates),
    )  # fmt: skip
