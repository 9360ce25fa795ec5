"""Routes as GeoJSON (RFC 7946): lines split at the antimeridian, positions as [lon, lat]."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_text
from thalweg.core.geodesy import Position, densify, positions_along
from thalweg.core.time import parse_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.parsed_track import (
    ParsedTrack,
    carried_names,
    position_of,
    unused_column_notes,
    waypoint_track,
)
from thalweg.route.formats.route_file_options import RouteFileOptions
from thalweg.route.route import Route

_LINE_SPACING = 20.0 * NAUTICAL_MILE  # legs are geodesics, GeoJSON lines are not: use short pieces
_KINDS = "LineString, MultiLineString or Points"


def parse_geojson(text: str) -> ParsedTrack:
    """Read the first line of a GeoJSON text, or its points in order.

    Lines that continue from the end of the one before are one line, and lines split at the
    antimeridian are joined; other lines are other routes. Where there are both lines and points,
    the points are taken if there are two or more (they are the waypoints, with their ``waiting_h``,
    ``ordered_speed_kn`` and ``geometry``), else the lines.

    Raises
    ------
    InputError : If it is not GeoJSON or holds no line and no points.
    """
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"The GeoJSON cannot be read: {error}.",
            "The file must be JSON text as in RFC 7946.",
            "Check that the file is complete.",
        ) from None
    lines: list[list[list[Any]]] = []
    points: list[tuple[Any, dict[str, Any]]] = []
    first_time = None
    for geometry, properties in _geometries(data):
        kind, coordinates = geometry.get("type"), geometry.get("coordinates")
        if kind == "LineString":
            lines.append([_listed(coordinates)])
        elif kind == "MultiLineString":
            lines.append([_listed(line) for line in _listed(coordinates)])
        elif kind in ("Point", "MultiPoint"):
            places = [coordinates] if kind == "Point" else _listed(coordinates)
            points += [(place, properties if kind == "Point" else {}) for place in places]
        if first_time is None and properties.get("time", properties.get("depart")):
            first_time = parse_time(str(properties.get("time", properties.get("depart"))))
    on_line: list[tuple[Any, dict[str, Any]]] = [(position, {}) for position in _first_line(lines)]
    chosen = points if len(points) > 1 else on_line
    if not chosen and isinstance(data, dict) and "routes" in data:
        raise InputError(
            "The file is a plan with its figures, not a route file.",
            "The route files of a plan are beside it: route.csv, route.rtz, route.gpx, "
            "route.geojson.",
            "Give one of these.",
        )
    if not chosen:
        raise InputError(
            "The GeoJSON holds no route.", f"A route is a {_KINDS}.", "Export the route as a line."
        )
    positions = [_position(item, i) for i, (item, _) in enumerate(chosen, start=1)]
    if chosen is on_line:
        return ParsedTrack(_without_cuts(positions), first_time)
    given = [properties for _, properties in chosen]
    times = [first_time, *(one.get("time") for one in given[1:])]
    parsed = waypoint_track(positions, times, given)
    notes = unused_column_notes(str(name) for one in given for name in one)
    names = [str(one.get("name") or "") for one in given]
    return replace(
        parsed,
        notes=[f"its property {note}" for note in notes],
        extensions=carried_names(names, positions),
    )


def _first_line(lines: list[list[list[Any]]]) -> list[Any]:
    """Return the positions of the first line, with the lines that continue from its end."""
    found: list[Any] = []
    for parts in lines:
        line = [position for part in parts for position in part]
        if found and line and not _continues(_position(found[-1], 1), _position(line[0], 1)):
            break
        found += line
    return found


def _continues(end: Position, start: Position) -> bool:
    return end[0] == start[0] and (end[1] - start[1]) % 360.0 == 0.0


def write_geojson(route: Route, path: str | Path, options: RouteFileOptions | None = None) -> None:
    """Write a route: one (Multi)LineString with the totals, one Point per waypoint.

    Parameters
    ----------
    route : Route
    path : str or Path
    options : RouteFileOptions, optional
        Names and waypoints.
    """
    options = options or RouteFileOptions()
    written = file_route(route, options)
    totals = {k: v for k, v in route.as_dict().items() if k not in ("waypoints", "violations")}
    totals["cross_track_error_m"] = round(written.cross_track_m, 1)
    parts = line_parts(route, options.decimals)
    line = (
        {"type": "LineString", "coordinates": parts[0]}
        if len(parts) == 1
        else {"type": "MultiLineString", "coordinates": parts}
    )
    features = [{"type": "Feature", "geometry": line, "properties": totals}]
    for row in written.rows:
        place = {"type": "Point", "coordinates": [row["lon"], row["lat"]]}
        properties = {key: value for key, value in row.items() if key not in ("lat", "lon")}
        features.append({"type": "Feature", "geometry": place, "properties": properties})
    text = json.dumps({"type": "FeatureCollection", "features": features}, allow_nan=False)
    write_text(path, text + "\n")


def _geometries(data: Any) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Yield (geometry, properties) of everything in a GeoJSON object."""
    if not isinstance(data, dict):
        return
    kind = data.get("type")
    if kind == "FeatureCollection":
        for feature in _listed(data.get("features")):
            yield from _geometries(feature)
    elif kind == "Feature":
        properties = data.get("properties")
        for geometry, _ in _geometries(data.get("geometry")):
            yield geometry, properties if isinstance(properties, dict) else {}
    elif kind == "GeometryCollection":
        for geometry in _listed(data.get("geometries")):
            yield from _geometries(geometry)
    else:
        yield data, {}


def _listed(value: Any) -> list[Any]:
    if not isinstance(value, list):
        raise InputError(
            "The GeoJSON has coordinates or features that are not lists.",
            "RFC 7946 requires lists of features and of [lon, lat] positions.",
            "Correct the file.",
        )
    return value


def _position(item: Any, number: int) -> Position:
    if not isinstance(item, list) or len(item) < 2:
        raise InputError(
            f"Waypoint {number} of the GeoJSON is not a position.",
            "A position is [lon, lat] in degrees.",
            "Check the file.",
        )
    return position_of(item[1], item[0], number)


def _without_cuts(positions: list[Position]) -> list[Position]:
    """Return points without those where a line was split at the antimeridian."""
    remaining: list[Position] = []
    for index, (lat, lon) in enumerate(positions):
        neighbours = positions[max(index - 1, 0) : index] + positions[index + 1 : index + 2]
        inner = 0 < index < len(positions) - 1
        if (
            inner
            and abs(lon) == 180.0
            and any(p[0] == lat and abs(p[1]) == 180.0 for p in neighbours)
        ):
            continue
        remaining.append((lat, lon))
    return remaining


def line_parts(route: Route, decimals: int) -> list[list[list[float]]]:
    """Return the line as lists of [lon, lat], split where it crosses the antimeridian."""
    track = route.track
    lat, lon, _ = densify(track.lat, track.lon, _LINE_SPACING)
    parts: list[list[list[float]]] = [[[float(lon[0]), float(lat[0])]]]
    for here, there in zip(zip(lat[:-1], lon[:-1]), zip(lat[1:], lon[1:])):
        if abs(there[1] - here[1]) > 180.0:
            crossing = _crossing_latitude(here, there)
            side = math.copysign(180.0, here[1])
            parts[-1].append([side, crossing])
            parts.append([[-side, crossing]])
        parts[-1].append([float(there[1]), float(there[0])])
    return [[[round(x, decimals), round(y, decimals)] for x, y in part] for part in parts]


def _crossing_latitude(here: tuple[float, float], there: tuple[float, float]) -> float:
    """Return the latitude [deg] where a geodesic crosses the antimeridian, by bisection."""
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        _, lon = positions_along(here[0], here[1], there[0], there[1], middle)
        if (float(lon) >= 0.0) == (here[1] >= 0.0):
            low = middle
        else:
            high = middle
    return float(positions_along(here[0], here[1], there[0], there[1], low)[0])
