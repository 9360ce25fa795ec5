"""Polygons from GeoJSON (RFC 7946), with messages that name the faulty polygon.

An edge over more than 180 degrees of longitude has two readings: as written, by Greenwich, or the
short one across the antimeridian, where RFC 7946 requires the area to be split. The reading by
which the ring encloses an area is used. If both do, the ring crosses the antimeridian when its
direction is the one that RFC 7946 requires then (outlines counter-clockwise, holes clockwise), and
is refused otherwise. Edges of 360 degrees belong to bands around the globe.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.rings import Rings
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.file_reading import cause_of
from thalweg.core.given_numbers import shortened_repr, to_number

GeoJsonSource: TypeAlias = "str | PathLike[str] | Mapping[str, Any] | list[Any]"


def read_features(
    source: GeoJsonSource, what: str
) -> list[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    """Return (geometry, properties) of every feature of a file or of plain data.

    Parameters
    ----------
    source : A file, or GeoJSON as plain data.
    what : Name of the source, for messages.

    Returns
    -------
    list of (mapping, mapping) : Geometry and properties.

    Raises
    ------
    InputError : If the file cannot be read or is not GeoJSON.
    """
    data: Any = source
    if isinstance(source, (str, PathLike)):
        try:
            data = json.loads(Path(source).read_text(encoding="utf-8"))
        except RecursionError:
            raise _nesting_error(what) from None
        except (OSError, ValueError) as error:
            raise InputError(
                f"The {what} file {str(source)!r} cannot be read: {cause_of(error)}.",
                "It must be a GeoJSON file.",
                "Check the path and the file.",
                file=str(source),
            ) from error
    try:
        return list(_features(data, {}, what))
    except RecursionError:
        raise _nesting_error(what) from None


def _nesting_error(what: str) -> InputError:
    return InputError(
        f"The GeoJSON of the {what} is nested too deeply.",
        "A polygon is a list of rings of positions, in a feature of a collection.",
        "Check the GeoJSON.",
    )


def _features(
    data: Any, properties: Mapping[str, Any], what: str
) -> Iterator[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    if isinstance(data, list):
        for item in data:
            yield from _features(item, properties, what)
        return
    kind = data.get("type") if isinstance(data, Mapping) else None
    if kind == "FeatureCollection":
        yield from _features(_checked_list(data.get("features") or [], what), properties, what)
    elif kind == "Feature":
        given = data.get("properties") or {}
        if not isinstance(given, Mapping):
            raise InputError(
                f"A feature of the {what} has the properties {shortened_repr(given, 40)}.",
                "Properties are names with values.",
                "Check the GeoJSON.",
            )
        yield from _features(data.get("geometry"), given, what)
    elif kind == "GeometryCollection":
        yield from _features(_checked_list(data.get("geometries") or [], what), properties, what)
    elif kind in ("Polygon", "MultiPolygon"):
        yield data, properties
    else:
        raise InputError(
            f"The GeoJSON of the {what} holds {kind or type(data).__name__!r}: not an area.",
            "Polygon and MultiPolygon are areas, alone or in a Feature or FeatureCollection.",
            "Give areas only.",
            value=str(kind),
        )


def parse_polygons(geometry: Mapping[str, Any], what: str, *, repair: bool = True) -> list[Any]:
    """Return the shapely polygons of a geometry, repaired (with a warning) where invalid.

    Parameters
    ----------
    geometry : A GeoJSON geometry.
    what : Name of the geometry, for messages.
    repair : Repair invalid outlines, with a warning.

    Returns
    -------
    list of shapely polygons : Coordinates (lon, lat) [deg].

    Raises
    ------
    InputError : If the coordinates are not positions (lon, lat) of closed rings; without ``repair``
        also if an outline crosses or touches itself.
    """
    import shapely

    parts = geometry.get("coordinates") or []
    found: list[Any] = []
    for part in _checked_list(parts, what) if geometry["type"] == "MultiPolygon" else [parts]:
        rings = [
            _unwrapped_ring(_ring(ring, what), what, hole=k > 0)
            for k, ring in enumerate(_checked_list(part, what))
        ]
        if not rings:
            continue
        for k in range(1, len(rings)):  # holes get longitudes of the same turn as their outline
            rings[k][:, 0] += 360.0 * np.round((rings[0][0, 0] - rings[k][0, 0]) / 360.0)
        # one ring at a time: arrays of rings need the same number of positions in each
        holes = [shapely.linearrings(ring) for ring in rings[1:]]
        shape: Any = shapely.polygons(rings[0], holes=holes or None)
        if not shapely.is_valid(shape):
            reason = shapely.is_valid_reason(shape)
            if not repair:
                raise _invalid_polygon_error(reason, what)
            warnings.warn(
                ThalwegWarning(f"A polygon of the {what} was repaired: {reason}."), stacklevel=3
            )
            shape = shapely.make_valid(shape)
        found += [p for p in shapely.get_parts(shape) if p.geom_type == "Polygon" and p.area > 0]
    return found


def _invalid_polygon_error(reason: str, what: str) -> InputError:
    """Return the error for an invalid polygon, with the position of the fault."""
    fault, _, place = reason.partition("[")
    numbers = place.rstrip("]").split()
    where = f" near longitude {numbers[0]}, latitude {numbers[1]}" if len(numbers) == 2 else ""
    return InputError(
        f"A polygon of the {what} is invalid: {fault.strip().lower()}{where}.",
        "An outline may not cross or touch itself, and holes lie inside it.",
        "Put its points in order along the outline, or give several polygons.",
        value=reason,
    )


def _checked_list(value: Any, what: str) -> list[Any]:
    """Return a list, or raise for anything else in its place."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return list(value)
    raise InputError(
        f"The GeoJSON of the {what} holds {shortened_repr(value, 40)} where a list belongs.",
        "Coordinates and features are lists.",
        "Check the GeoJSON.",
    )


def _ring(coordinates: Any, what: str) -> NDArray[np.float64]:
    try:
        ring = np.array([[to_number(p[0]), to_number(p[1])] for p in coordinates])
    except (TypeError, ValueError, IndexError, KeyError):
        ring = np.empty((0, 2))
    if len(ring) < 4 or not np.isfinite(ring).all():
        raise InputError(
            f"A ring of the {what} is not a list of at least four (longitude, latitude) positions.",
            "A ring is a list of positions; the last is equal to the first.",
            "Give closed rings of numbers in degrees, longitude first.",
        )
    for column, name, most in ((1, "latitude", 90.0), (0, "longitude", 540.0)):
        worst = float(ring[np.abs(ring[:, column]).argmax(), column])
        if abs(worst) > most:
            raise InputError(
                f"A ring of the {what} has a position outside the globe ({name} {worst:g}).",
                "GeoJSON puts longitude first, then latitude, in degrees.",
                "Check the order and the units (no projected coordinates).",
                value=worst,
            )
    return ring if np.array_equal(ring[0], ring[-1]) else np.vstack([ring, ring[:1]])


def _unwrapped_ring(ring: NDArray[np.float64], what: str, *, hole: bool) -> NDArray[np.float64]:
    """Return a ring with longitudes that run on across the antimeridian, if it crosses that.

    Raises
    ------
    InputError : If it is ambiguous, or encloses a pole.
    """
    step = np.diff(ring[:, 0])
    long = (np.abs(step) > 180.0) & (np.abs(step) <= 360.0)
    if not long.any():
        return ring
    short = ring.copy()
    short[1:, 0] -= 360.0 * np.cumsum(np.where(long, np.sign(step), 0.0))
    is_area, turns = _has_area(ring), short[-1, 0] != short[0, 0]
    if is_area and (np.abs(step[long]) == 360.0).all():
        return ring
    if turns and not is_area:
        raise InputError(
            f"A ring of the {what} encloses a pole.",
            "As an area it must be closed along a meridian through the pole.",
            "Draw it from longitude -180 to 180, and back along latitude 90 (or -90).",
        )
    if not is_area or (not turns and _has_area(short) and _turns_left(short) != hole):
        return short
    raise _ambiguous_edge_error(ring, int(np.flatnonzero(long)[0]), what)


def _has_area(ring: NDArray[np.float64]) -> bool:
    import shapely

    shape: Any = shapely.polygons(ring)
    return bool(shapely.is_valid(shape) and shape.area > 0.0)


def _turns_left(ring: NDArray[np.float64]) -> bool:
    import shapely

    return bool(shapely.is_ccw(shapely.linearrings(ring)))


def _ambiguous_edge_error(ring: NDArray[np.float64], edge: int, what: str) -> InputError:
    west, east = sorted(ring[edge : edge + 2, 0])
    wide = east - west
    return InputError(
        f"A ring of the {what} has an edge from longitude {ring[edge, 0]:g} to "
        f"{ring[edge + 1, 0]:g}: {wide:g} degrees as written, or {360.0 - wide:g} across "
        "the antimeridian.",
        f"Across the antimeridian longitudes continue ({west + 360.0:g} for {west:g}), or the area "
        "is split at 180, as RFC 7946 requires; for the long edge, add points in between.",
        "Write the ring in one of these forms.",
        value=[float(west), float(east)],
    )


def rings_from_polygons(shapes: list[Any]) -> Rings:
    """Return the rings (outer and holes) of shapely polygons."""
    lists: list[tuple[Any, bool]] = []
    for shape in shapes:
        lists.append((np.asarray(shape.exterior.coords)[:, 1::-1], False))
        lists += [(np.asarray(hole.coords)[:, 1::-1], True) for hole in shape.interiors]
    return Rings.from_lists(lists)


def read_land_areas(source: GeoJsonSource) -> Rings:
    """Return the rings of land areas; holes in them are water."""
    shapes: list[Any] = []
    for geometry, _ in read_features(source, "land"):
        shapes += parse_polygons(geometry, "land")
    return rings_from_polygons(shapes)
