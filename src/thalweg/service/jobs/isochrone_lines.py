"""Isochrones of a plan as lines, for the map in the browser."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.geodesy import wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData, PlotContext

STEPS_H: Final = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0)
_CURVES: Final = 9  # isochrones along a voyage, about
_COLUMNS, _ROWS = 220, 160  # of the raster on which the lines are found
_MARGIN: Final = 0.25  # of the box of the route around it
_MOST_NODES: Final = 30_000


def isochrone_lines(plan: PlanData) -> dict[str, Any] | None:
    """Return lines of equal earliest arrival around the route, in hours after departure.

    Returns
    -------
    dict or None
        ``step_h`` and ``lines``, each with ``hours`` and ``points`` [[lon, lat], ...]; None for
        plans without arrival times over their network.
    """
    world = plan.plot_context
    if world is None or plan.front is not None or not math.isfinite(plan.best.time_h):
        return None
    raster = _raster(plan, world)
    if raster is None:
        return None
    lon, lat, hours = raster
    step = min(STEPS_H, key=lambda value: abs(value - plan.best.time_h / _CURVES))
    top = min(float(np.nanmax(hours)), 1.6 * plan.best.time_h)
    levels = np.arange(step, top, step)
    return {"step_h": step, "lines": _contours(lon, lat, hours, levels) if len(levels) else []}


def _raster(plan: PlanData, world: PlotContext) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Return longitudes, latitudes and hours on a raster around the route; NaN off the water."""
    from scipy.interpolate import LinearNDInterpolator

    samples = plan.best.samples
    middle = float(np.median(np.degrees(np.unwrap(np.radians(samples["lon"])))))

    def unwrapped(lon: Any) -> FloatArray:
        return np.asarray((np.asarray(lon, float) - middle + 180.0) % 360.0 - 180.0 + middle)

    node_lon, route_lon, route_lat = unwrapped(world.lon), unwrapped(samples["lon"]), samples["lat"]
    margin = _MARGIN * max(float(np.ptp(route_lon)), float(np.ptp(route_lat)), 0.05)
    west, east = float(route_lon.min()) - margin, float(route_lon.max()) + margin
    south = max(-85.0, float(route_lat.min()) - margin)
    north = min(85.0, float(route_lat.max()) + margin)
    use = np.flatnonzero(
        np.isfinite(world.arrival)
        & (world.lat > south - 2) & (world.lat < north + 2)
        & (node_lon > west - 4) & (node_lon < east + 4)
    )  # fmt: skip
    if len(use) < 10 or np.ptp(world.lat[use]) == 0 or np.ptp(node_lon[use]) == 0:
        return None
    use = use[:: max(1, len(use) // _MOST_NODES)]
    lon, lat = np.meshgrid(np.linspace(west, east, _COLUMNS), np.linspace(south, north, _ROWS))
    nodes = np.column_stack([node_lon[use], world.lat[use]])
    hours = LinearNDInterpolator(nodes, (world.arrival[use] - plan.best.depart) / HOUR)(lon, lat)
    hours = np.where(world.chart.is_navigable(lat, wrap_longitude(lon)), hours, np.nan)
    return (lon, lat, hours) if np.isfinite(hours).any() else None


def _contours(
    lon: FloatArray, lat: FloatArray, hours: FloatArray, levels: FloatArray
) -> list[dict[str, Any]]:
    from matplotlib.figure import Figure

    drawn: Any = Figure().add_subplot().contour(lon, lat, hours, levels=levels)
    return [
        {"hours": round(float(level), 3), "points": np.round(points, 3).tolist()}
        for level, parts in zip(levels, drawn.allsegs)
        for points in parts
        if len(points) > 3
    ]
