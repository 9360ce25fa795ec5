"""Kinds, factors and margins of zones, from the properties of their GeoJSON features."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.units import NAUTICAL_MILE

ZONE_KINDS: Final = {
    "nogo": "no-go",
    "forbidden": "no-go",
    "avoid": "no-go",
    "exclusion": "no-go",
    "penalty": "penalty",
    "price": "price",
    "eca": "eca",
    "emissioncontrol": "eca",
    "seca": "eca",
    "lane": "lane",
    "trafficlane": "lane",
    "anchorage": "anchorage",
    "nowaiting": "no-waiting",
    "noanchoring": "no-waiting",
}
LARGEST_MARGIN_NM: Final = 100.0
_LEAST_RADIUS: Final = 6_335_000.0  # of curvature of the ellipsoid [m]: margins are never too small
_ARC_SEGMENTS: Final = 16  # per quarter of a circle; chords cut off 0.12 %
_BAND: Final = 0.25  # of latitude with one scale [deg]
_EDGE_PIECE: Final = 0.1  # [deg]
_LAST_LATITUDE: Final = 88.0


def zone_kind(properties: Mapping[str, Any]) -> str:
    """Return the kind of a zone.

    Raises
    ------
    InputError : If it has none, or one that is not known.
    """
    written = str(properties.get("kind") or properties.get("type") or "")
    plain = "".join(c for c in written.casefold() if c.isalnum())
    for ending in ("zone", "area", "factor"):
        plain = plain.removesuffix(ending)
    if plain == "eca" and {"factor", "eca_factor", "price_factor"} & properties.keys():
        return "price"
    if plain not in ZONE_KINDS:
        named = f" {str(properties['name'])[:60]!r}" if properties.get("name") else ""
        raise InputError(
            f"A zone{named} has " + (f"the kind {written!r}." if written else "no kind."),
            "Kinds are 'no-go', 'penalty', 'price', 'eca', 'lane', 'anchorage' and 'no-waiting'.",
            "Give every feature the property kind.",
            value=written,
        )
    return ZONE_KINDS[plain]


def zone_factor(kind: str, properties: Mapping[str, Any]) -> float:
    """Return the factor of a penalty or price zone.

    Raises
    ------
    InputError : If there is none, or it is not possible.
    """
    written = properties.get("factor", properties.get(f"{kind}_factor"))
    if written is None and kind == "price":
        written = properties.get("eca_factor")
    factor = to_number(written)
    least = "at least 1" if kind == "penalty" else "above 0"
    if not (np.isfinite(factor) and factor > 0.0 and (kind == "price" or factor >= 1.0)):
        raise InputError(
            f"A {kind} zone has the factor {shortened_repr(written)}.",
            f"The factor of a {kind} zone is a number {least}.",
            "Give the feature such a property factor.",
            value=written,
        )
    return factor


def zone_margin(kind: str, properties: Mapping[str, Any]) -> float:
    """Return the distance by which routes keep clear of a no-go zone [m]; 0 where none is given.

    Raises
    ------
    InputError : If it is not possible, or the zone is of another kind.
    """
    written = properties.get("keep_clear_nm")
    if written is None:
        return 0.0
    margin = to_number(written)
    if kind != "no-go" or not 0.0 <= margin <= LARGEST_MARGIN_NM:
        raise InputError(
            f"A {kind} zone has the property keep_clear_nm {shortened_repr(written)}.",
            f"It is a number from 0 to {LARGEST_MARGIN_NM:g} nm, and only no-go zones have it.",
            "Correct it, or leave it out.",
            value=written,
        )
    return margin * NAUTICAL_MILE


def with_margin(shapes: list[Any], margin: float) -> list[Any]:
    """Return polygons widened on all sides by a distance over the Earth.

    They are widened in a Mercator projection, in bands of latitude with the greatest scale in each,
    so the margin is nowhere smaller than stated; up to 60 degrees it is at most 4 % larger.

    Parameters
    ----------
    shapes : Shapely polygons, coordinates (lon, lat) [deg].
    margin : Distance [m].

    Returns
    -------
    list of shapely polygons : Coordinates (lon, lat) [deg]; they may touch each other no more.
    """
    import shapely

    if not margin > 0.0:
        return shapes
    angle = margin / _LEAST_RADIUS / math.cos(math.pi / (4 * _ARC_SEGMENTS))
    wide = []
    for shape in shapes:
        west, south, east, north = shape.bounds
        for low in np.arange(math.floor(south / _BAND), math.floor(north / _BAND) + 1) * _BAND:
            band = shapely.box(west - 1.0, low, east + 1.0, low + _BAND)
            part = shapely.segmentize(shapely.intersection(shape, band), _EDGE_PIECE)
            if shapely.is_empty(part):
                continue
            highest = max(abs(low), abs(low + _BAND)) + math.degrees(angle)
            scale = 1.0 / math.cos(math.radians(min(highest, _LAST_LATITUDE)))
            flat = shapely.transform(part, _to_mercator)
            wide.append(shapely.buffer(flat, angle * scale, quad_segs=_ARC_SEGMENTS))
    found = shapely.transform(shapely.union_all(wide), _from_mercator)
    return [part for part in shapely.get_parts(found) if part.geom_type == "Polygon"]


def _to_mercator(places: NDArray[np.float64]) -> NDArray[np.float64]:
    lat = np.radians(np.clip(places[:, 1], -_LAST_LATITUDE, _LAST_LATITUDE))
    return np.column_stack([np.radians(places[:, 0]), np.arcsinh(np.tan(lat))])


def _from_mercator(places: NDArray[np.float64]) -> NDArray[np.float64]:
    lat = np.degrees(np.arctan(np.sinh(places[:, 1])))
    return np.column_stack([np.degrees(places[:, 0]), lat])
