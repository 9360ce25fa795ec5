"""Polygons from GeoJSON (RFC 7946), with errors that say what is wrong where.

A ring whose longitude jumps by more than 180 degrees (but not by 360) between neighbours is taken
to cross the antimeridian and runs on beyond it.
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

Source: TypeAlias = "str | PathLike[str] | Mapping[str, Any] | list[Any]"


def read(source: Source, what: str) -> list[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    """Return (geometry, properties) of every feature of a file or of plain data.

    Raises
    ------
    InputError
        If the file cannot be read or is not GeoJSON.
    """
    data: Any = source
    if isinstance(source, (str, PathLike)):
        try:
            data = json.loads(Path(source).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(
                f"The {what} file {str(source)!r} cannot be read: {error}.",
                "It must be a GeoJSON file.",
                "Check the path and the file.",
                file=str(source),
            ) from error
    return list(_features(data, {}, what))


def _features(
    data: Any, properties: Mapping[str, Any], what: str
) -> Iterator[tuple[Mapping[str, Any], Mapping[str, Any]]]:
    if isinstance(data, list):
        for item in data:
            yield from _features(item, properties, what)
        return
    kind = data.get("type") if isinstance(data, Mapping) else None
    if kind == "FeatureCollection":
        yield from _features(list(data.get("features") or []), properties, what)
    elif kind == "Feature":
        yield from _features(data.get("geometry"), data.get("properties") or {}, what)
    elif kind == "GeometryCollection":
        yield from _features(list(data.get("geometries") or []), properties, what)
    elif kind in ("Polygon", "MultiPolygon"):
        yield data, properties
    else:
        raise InputError(
            f"The {what} holds {kind or type(data).__name__!r}, which is no area.",
            "Polygon and MultiPolygon are areas, alone or in a Feature or FeatureCollection.",
            "Give areas only.",
            value=str(kind),
        )


def polygons(geometry: Mapping[str, Any], what: str, *, repair: bool = True) -> list[Any]:
    """Return the shapely polygons of a geometry, repaired (with a warning) where invalid.

    Raises
    ------
    InputError
        If the coordinates are not positions (lon, lat) of closed rings; without ``repair`` also
        if an outline crosses or touches itself.
    """
    import shapely

    parts = geometry.get("coordinates") or []
    found: list[Any] = []
    for part in parts if geometry["type"] == "MultiPolygon" else [parts]:
        rings = [_ring(ring, what) for ring in part]
        if not rings:
            continue
        for k in range(1, len(rings)):  # holes go on the same turn as their outline
            rings[k][:, 0] += 360.0 * np.round((rings[0][0, 0] - rings[k][0, 0]) / 360.0)
        shape: Any = shapely.polygons(rings[0], holes=rings[1:] or None)
        if not shapely.is_valid(shape):
            reason = shapely.is_valid_reason(shape)
            if not repair:
                raise _crooked(reason, what)
            warnings.warn(
                ThalwegWarning(f"A polygon of the {what} was repaired: {reason}."), stacklevel=3
            )
            shape = shapely.make_valid(shape)
        found += [p for p in shapely.get_parts(shape) if p.geom_type == "Polygon" and p.area > 0]
    return found


def _crooked(reason: str, what: str) -> InputError:
    """Build the error for a polygon that is none, with the place (lon, lat) of the fault."""
    fault, _, place = reason.partition("[")
    numbers = place.rstrip("]").split()
    where = f" near longitude {numbers[0]}, latitude {numbers[1]}" if len(numbers) == 2 else ""
    return InputError(
        f"A polygon of the {what} is invalid: {fault.strip().lower()}{where}.",
        "An outline may not cross or touch itself, and holes lie inside it.",
        "Put its points in order along the outline, or give several polygons.",
        value=reason,
    )


def _ring(coordinates: Any, what: str) -> NDArray[np.float64]:
    try:
        ring = np.array([[float(p[0]), float(p[1])] for p in coordinates])
    except (TypeError, ValueError, IndexError, KeyError):
        ring = np.empty((0, 2))
    if len(ring) < 4 or not np.isfinite(ring).all():
        raise InputError(
            f"A ring of the {what} is not a list of at least four (longitude, latitude) positions.",
            "",
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
    if not np.array_equal(ring[0], ring[-1]):
        ring = np.vstack([ring, ring[:1]])
    step = np.diff(ring[:, 0])
    turns = np.where((np.abs(step) > 180.0) & (np.abs(step) < 360.0), np.round(step / 360.0), 0.0)
    ring[1:, 0] -= 360.0 * np.cumsum(turns)
    return ring


def rings_of(shapes: list[Any]) -> Rings:
    """Return the rings (outer and holes) of shapely polygons."""
    lists: list[tuple[Any, bool]] = []
    for shape in shapes:
        lists.append((np.asarray(shape.exterior.coords)[:, 1::-1], False))
        lists += [(np.asarray(hole.coords)[:, 1::-1], True) for hole in shape.interiors]
    return Rings.from_lists(lists)


def read_land(source: Source) -> Rings:
    """Return the rings of land areas; holes in them are water."""
    shapes: list[Any] = []
    for geometry, _ in read(source, "land"):
        shapes += polygons(geometry, "land")
    return rings_of(shapes)
