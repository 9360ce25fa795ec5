"""Earliest times of passage on a raster, from those at the nodes of the networks of a plan."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.types import FloatArray

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlotContext

_MOST_NODES: Final = 30_000
_LEAST_NODES: Final = 4
_FLAT: Final = 1e-12  # twice the area of a triangle without an inside [degrees squared]
_LAT_MARGIN, _LON_MARGIN = 2.0, 4.0  # round the raster [deg]


def stage_arrival_times(
    context: PlotContext,
    lat: FloatArray,
    lon: FloatArray,
    unwrapped: Callable[[FloatArray], FloatArray],
) -> list[FloatArray]:
    """Return the earliest passage of each stage of a voyage on a raster.

    Parameters
    ----------
    context : Nodes with their arrivals.
    lat, lon : Raster [deg], longitudes without jumps, of any shape.
    unwrapped : Longitudes of nodes [deg] with the turns of the raster.

    Returns
    -------
    list of float64 arrays
        Times [s since 1970]; NaN where a stage does not come before the route reaches its end.
        Stages without enough nodes on the raster are left out.
    """
    found = []
    for nodes, until in _stages(context):
        times = _interpolated(context, nodes, lat, lon, unwrapped)
        if times is not None:
            found.append(np.where(times <= until, times, np.nan))
    return found


def _stages(context: PlotContext) -> Iterator[tuple[slice, float]]:
    """Yield the nodes of each stage, and when the route reaches its end."""
    if not context.stages:
        yield slice(None), math.inf
        return
    first = 0
    for count, until in context.stages:
        yield slice(first, first + count), until
        first += count


def _interpolated(
    context: PlotContext,
    nodes: slice,
    lat: FloatArray,
    lon: FloatArray,
    unwrapped: Callable[[FloatArray], FloatArray],
) -> FloatArray | None:
    node_lat, node_lon = context.lat[nodes], unwrapped(context.lon[nodes])
    arrival = context.arrival[nodes]
    use = np.isfinite(arrival)
    use &= (node_lat > lat.min() - _LAT_MARGIN) & (node_lat < lat.max() + _LAT_MARGIN)
    use &= (node_lon > lon.min() - _LON_MARGIN) & (node_lon < lon.max() + _LON_MARGIN)
    index = np.flatnonzero(use)
    if len(index) < _LEAST_NODES or np.ptp(node_lat[index]) == 0 or np.ptp(node_lon[index]) == 0:
        return None
    index = index[:: max(1, len(index) // _MOST_NODES)]
    places = np.column_stack([node_lon[index], node_lat[index]])
    return interpolated_between(places, arrival[index], np.stack([lon, lat], axis=-1))


def interpolated_between(places: FloatArray, values: FloatArray, wanted: FloatArray) -> FloatArray:
    """Interpolate linearly in the triangles between places of a plane.

    SciPy's interpolation looks through all triangles for each point that it meets a flat one on
    the way to, and lattices have many in a line: minutes for an ocean.

    Parameters
    ----------
    places : float64 array, shape (places, 2)
    values : float64 array, shape (places,)
    wanted : float64 array, shape (..., 2)

    Returns
    -------
    float64 array, shape (...)
        NaN outside the hull of the places, everywhere where these are in a line.
    """
    import shapely
    from scipy.spatial import Delaunay, QhullError

    try:
        triangles = Delaunay(places).simplices
    except QhullError:  # all in a line
        return np.full(wanted.shape[:-1], np.nan)
    first, one, other = np.moveaxis(places[triangles], 1, 0)
    one, other = one - first, other - first
    twice_area = _cross(one, other)
    wide = np.abs(twice_area) > _FLAT
    triangles, first, one, other = triangles[wide], first[wide], one[wide], other[wide]
    points = wanted.reshape(-1, 2)
    tree = shapely.STRtree(shapely.polygons(places[triangles]))
    point, triangle = tree.query(shapely.points(points), predicate="intersects")
    off, one, other = points[point] - first[triangle], one[triangle], other[triangle]
    share = np.column_stack([_cross(off, other), _cross(one, off)]) / _cross(one, other)[:, None]
    corners = values[triangles[triangle]]
    found = np.full(len(points), np.nan)
    found[point] = corners[:, 0] + np.sum(share * (corners[:, 1:] - corners[:, :1]), axis=1)
    return found.reshape(wanted.shape[:-1])


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
