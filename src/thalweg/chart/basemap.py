"""Coastlines and land as shapely geometries, clipped to a box, for maps."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from thalweg.chart.rings import Rings
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.types import FloatArray


def ring_bounds(rings: Rings) -> tuple[Any, Any, Any, Any]:
    """Return the south, north, west and east [deg] of every ring."""
    if not len(rings):
        return (np.empty(0),) * 4
    first = rings.start[:-1]
    return (
        np.minimum.reduceat(rings.lat, first),
        np.maximum.reduceat(rings.lat, first),
        np.minimum.reduceat(rings.lon, first),
        np.maximum.reduceat(rings.lon, first),
    )


def land_polygons(rings: Rings, south: float, north: float, west: float, east: float) -> list[Any]:
    """Return the land in a box as shapely polygons (x lon, y lat), continuous from ``west``.

    Parameters
    ----------
    rings : Outlines of land.
    south, north, west, east : The box [deg]; east below west means across the antimeridian.
    """
    import shapely

    if east <= west:
        east += 360.0
    box = shapely.box(west, south, east, north)
    lows, highs, lefts, rights = ring_bounds(rings)
    found: list[Any] = []
    for shift in (-360.0, 0.0, 360.0):
        hit = (
            (highs >= south) & (lows <= north) & (rights + shift >= west) & (lefts + shift <= east)
        )
        if hit.any():
            found += _clipped_polygons(rings, np.flatnonzero(hit), shift, box)
    return found


def _clipped_polygons(rings: Rings, chosen: Any, shift: float, box: Any) -> list[Any]:
    import shapely

    counts = np.diff(rings.start)[chosen]
    member, number = numbered_parts(counts)
    take = number + rings.start[chosen][member]
    lines = shapely.linearrings(rings.lon[take] + shift, rings.lat[take], indices=member)
    shapes: Any = shapely.make_valid(shapely.polygons(lines))
    holes = ~shapely.is_ccw(lines)
    land: Any = shapely.union_all(shapes[~holes]) if holes.any() else shapes
    if holes.any():
        land = np.array([shapely.difference(land, shapely.union_all(shapes[holes]))])
    inside = shapely.intersection(land[~shapely.is_empty(land)], box)
    parts = shapely.get_parts(shapely.get_parts(inside))
    return [part for part in parts if part.geom_type == "Polygon" and not part.is_empty]


@cache
def _dataset_cut_meridians() -> Any:
    """Return the meridians at which GSHHG splits land, as lines."""
    import shapely

    cuts = [[(x, -90.0), (x, 90.0)] for x in (-540.0, -180.0, 180.0, 540.0)]
    cuts += [[(x, -90.0), (x, -69.0)] for x in (-360.0, 0.0, 360.0)]
    return shapely.MultiLineString(cuts)


def coastline_lines(
    rings: Rings, south: float, north: float, west: float, east: float
) -> list[tuple[FloatArray, FloatArray]]:
    """Return the outlines of land in a box [deg] as (lat, lon) arrays [deg].

    The sides of the box are left out, and so are the meridians (0 and 180) at which GSHHG
    splits land.
    """
    import shapely

    if east <= west:
        east += 360.0
    inner = shapely.box(west, south, east, north).buffer(-1e-9)
    lines: list[tuple[FloatArray, FloatArray]] = []
    for polygon in land_polygons(rings, south, north, west, east):
        outline = shapely.difference(
            shapely.intersection(polygon.boundary, inner), _dataset_cut_meridians()
        )
        for part in shapely.get_parts(outline):
            xy = shapely.get_coordinates(part)
            lines.append((xy[:, 1], xy[:, 0]))
    return lines
