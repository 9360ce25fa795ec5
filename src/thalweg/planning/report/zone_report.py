"""What is stated about zones and passages: control areas, margins, speed limits, war risk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely
from scipy.spatial import cKDTree

from thalweg.chart import Chart
from thalweg.chart.passages import Passage
from thalweg.chart.ports import PORTS
from thalweg.chart.zones.emission_control_areas import emission_control_areas
from thalweg.chart.zones.war_risk_areas import LIST, WAR_RISK_AREAS
from thalweg.core.geodesy import (
    MEAN_RADIUS,
    densify,
    distance,
    format_position,
    format_position_minutes,
    geocentric_unit_vectors,
)
from thalweg.core.time import duration_text
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route import Route
from thalweg.route.passages_used import passages_used

FAR_AREAS: Final = "No area that was given is near the route"  #: a note on that begins so
_FAR: Final = 300.0 * NAUTICAL_MILE  # at least; areas so far away can have no effect
OVER_SPEED: Final = "Faster than allowed"  #: a note on a speed limit begins so
WAR_RISK: Final = "Listed for war risk"  #: a note on that begins so
_AT_PORT: Final = 12.0 * NAUTICAL_MILE  # of a call, as coastal waters reach
_SPACING: Final = 5.0 * NAUTICAL_MILE  # between positions that are tested
_IN_PASSAGE: Final = 2.0 * NAUTICAL_MILE  # of its line, and of land
_TOLERANCE: Final = 0.2 * KNOT  # above a limit that is not stated


def control_area_notes(chart: Chart, routes: Sequence[Route]) -> list[str]:
    """Return which emission control areas of the chart the routes meet, in one note.

    Returns
    -------
    list of str : Empty where no areas count.
    """
    if not chart.zones.eca:
        return []
    lines = [densify(route.track.lat, route.track.lon, _SPACING)[:2] for route in routes]
    lat, lon = (np.concatenate(values) for values in zip(*lines))
    titles = {area.name: area.title for area in emission_control_areas()}
    met = [
        titles.get(zone.name, zone.name)
        for zone in chart.zones.eca
        if zone.contains(lat, lon).any()
    ]
    if not met:
        return ["The routes pass no emission control area."]
    return [f"Emission control areas on the way: {', '.join(met)}."]


def war_risk_notes(lat: FloatArray, lon: FloatArray) -> list[str]:
    """Return a note on water and ports of call that are listed for war risk; else none.

    Parameters
    ----------
    lat, lon : Waypoints from the first port to the last [deg].
    """
    met = []
    lat, lon, _ = densify(lat, lon, _SPACING)
    for area in WAR_RISK_AREAS:
        inside = area.contains(lat, lon)
        if inside.any():
            first = int(np.argmax(inside))
            met.append(f"{area.name} (from {format_position_minutes(lat[first], lon[first])})")
    calls = {_country_at(float(lat[k]), float(lon[k])) for k in (0, -1)} - {""}
    met += [f"ports of {area.name}" for area in WAR_RISK_AREAS if area.country_code in calls]
    if not met:
        return []
    return [
        f"{WAR_RISK}: {', '.join(met)}, as listed by insurers ({LIST}; the list changes). Nothing "
        "is known here of attacks, mines, closed ports and sanctions: read the navigational "
        "warnings and ask the insurer before sailing."
    ]


def _country_at(lat: float, lon: float) -> str:
    """Return the code of the country of the nearest port, if that is near; else an empty text."""
    ports = PORTS.all
    places = np.array([(port.lat, port.lon) for port in ports])
    away = np.asarray(distance(lat, lon, places[:, 0], places[:, 1]))
    nearest = int(np.argmin(away))
    return ports[nearest].country_code if away[nearest] <= _AT_PORT else ""


def margin_notes(chart: Chart) -> list[str]:
    """Return by how much routes keep clear of no-go zones, in one note; empty without margins."""
    widths = sorted({margin / NAUTICAL_MILE for margin in chart.zones.margins})
    if not widths:
        return []
    words = " and ".join(f"{width:g}" for width in widths)
    count = len(chart.zones.margins)
    areas = "1 closed area" if count == 1 else f"{count} closed areas"
    return [f"Keeps {words} nm clear of {areas}."]


def far_area_notes(chart: Chart, route: Route) -> list[str]:
    """Return a note where none of the areas that were given lies near a route; else none."""
    zones = chart.zones
    areas = [*zones.no_go, *(area for area, _ in (*zones.penalty, *zones.price))]
    areas += [*zones.anchorages, *zones.no_waiting]
    if not areas:
        return []
    lat, lon, _ = densify(route.track.lat, route.track.lon, _FAR / 4.0)
    points = np.concatenate([shapely.get_coordinates(area) for area in areas])
    tree = cKDTree(geocentric_unit_vectors(lat, lon))
    away, _ = tree.query(geocentric_unit_vectors(points[:, 1], points[:, 0]))
    nearest = int(np.argmin(away))
    reach = max(_FAR, float(route.distance_nm) * NAUTICAL_MILE)
    inside = shapely.contains_xy(shapely.union_all(areas), lon, lat)
    if inside.any() or away[nearest] * MEAN_RADIUS < reach:
        return []
    place = format_position(points[nearest, 1], points[nearest, 0])
    return [
        f"{FAR_AREAS}: the nearest of the {len(areas)} begins at {place}, more than "
        f"{reach / NAUTICAL_MILE:,.0f} nm away. GeoJSON has the longitude first: see whether "
        "latitude and longitude are exchanged."
    ]


def over_speed_notes(chart: Chart, route: Route) -> list[str]:
    """Return a note for each passage with a speed limit that a route is faster than.

    Returns
    -------
    list of str : With the limit, the greatest speed over ground, and how much longer the passage
        takes at the limit.
    """
    limited = [one for one in passages_used(chart, route) if one.max_speed is not None]
    return [note for one in limited for note in _over_speed(chart, route, one)]


def _over_speed(chart: Chart, route: Route, passage: Passage) -> list[str]:
    samples, limit = route.samples, passage.max_speed or np.inf
    lat, lon = np.asarray(samples["lat"], float), np.asarray(samples["lon"], float)
    line_lat, line_lon = np.array(passage.line, float).T
    line_lat, line_lon, _ = densify(line_lat, line_lon, 0.25 * _IN_PASSAGE)
    middle = cKDTree(geocentric_unit_vectors(line_lat, line_lon))
    off, _ = middle.query(geocentric_unit_vectors(lat, lon))
    within = off * MEAN_RADIUS < _IN_PASSAGE
    within[within] = chart.coastline.shore_distance(lat[within], lon[within]) < _IN_PASSAGE
    speed = np.asarray(samples["speed_over_ground"], float)
    fast = within & (speed > limit + _TOLERANCE)
    if not fast.any():
        return []
    step = np.diff(np.asarray(samples["time"], float), append=np.nan)
    longer = float(np.nansum(np.where(fast, step * (speed / limit - 1.0), 0.0)))
    return [
        f"{OVER_SPEED}: {speed[fast].max() / KNOT:.1f} kn over ground in {passage.name}, where the "
        f"limit is {limit / KNOT:.3g} kn ({passage.source.rpartition(': ')[2]}). At the limit the "
        f"ship arrives {duration_text(longer)} later: plan with it, or order less speed there."
    ]
