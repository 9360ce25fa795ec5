"""Isochrones of a plan as lines, for the map in the browser."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.geodesy import longitude_difference, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.planning.plots.stage_passages import stage_arrival_times

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData

STEPS_H: Final = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0)
_CURVES: Final = 9  # isochrones along a voyage, about
_COLUMNS, _ROWS = 220, 160  # of the raster on which the lines are found
_MARGIN: Final = 0.25  # of the box of the route around it


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
    lon, lat, unwrapped = _raster_around(plan)
    stages = stage_arrival_times(world, lat, lon, unwrapped)
    on_water = world.chart.is_navigable(lat, wrap_longitude(lon))
    rasters = [np.where(on_water, (times - plan.best.depart) / HOUR, np.nan) for times in stages]
    rasters = [hours for hours in rasters if np.isfinite(hours).any()]
    if not rasters:
        return None
    step = min(STEPS_H, key=lambda value: abs(value - plan.best.time_h / _CURVES))
    lines: list[dict[str, Any]] = []
    for hours in rasters:
        top = min(float(np.nanmax(hours)), 1.6 * plan.best.time_h)
        levels = np.arange(step, top, step)
        levels = levels[levels > float(np.nanmin(hours))]
        lines += _contours(lon, lat, hours, levels) if len(levels) else []
    return {"step_h": step, "lines": lines}


def _raster_around(
    plan: PlanData,
) -> tuple[FloatArray, FloatArray, Callable[[FloatArray], FloatArray]]:
    """Return longitudes and latitudes around the route, and what unwraps other longitudes."""
    samples = plan.best.samples
    middle = float(np.median(np.degrees(np.unwrap(np.radians(samples["lon"])))))

    def unwrapped(lon: FloatArray) -> FloatArray:
        return longitude_difference(np.asarray(lon, float), middle) + middle

    route_lon, route_lat = unwrapped(samples["lon"]), samples["lat"]
    margin = _MARGIN * max(float(np.ptp(route_lon)), float(np.ptp(route_lat)), 0.05)
    west, east = float(route_lon.min()) - margin, float(route_lon.max()) + margin
    south = max(-85.0, float(route_lat.min()) - margin)
    north = min(85.0, float(route_lat.max()) + margin)
    lon, lat = np.meshgrid(np.linspace(west, east, _COLUMNS), np.linspace(south, north, _ROWS))
    return lon, lat, unwrapped


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
