"""Labels of routes by the side on which they pass land."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import Chart
from thalweg.chart.rings import Rings
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import distance, format_position, inverse, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.network import Network
from thalweg.network.alternatives.homotopy import obstacles
from thalweg.planning.network_selection.route_alternatives import OPEN_SEA
from thalweg.route import Route

_MIN_RELATIVE_SIZE = 0.01  # least width of land that counts, over the distance of the ends
_MAX_LANDMASSES_IN_LABEL = 3
_COMPASS_POINTS = (
    "north",
    "north-east",
    "east",
    "south-east",
    "south",
    "south-west",
    "west",
    "north-west",
)


@cache
def landmasses() -> Mapping[str, tuple[float, float]]:
    """Return a position (lat, lon) [deg] on each landmass with a name, from ``landmasses.csv``."""
    rows = table_rows("thalweg.planning", "landmasses.csv")
    return {row["name"]: (float(row["lat"]), float(row["lon"])) for row in rows}


def route_labels(
    routes: Sequence[Route],
    alternatives: Sequence[str],
    networks: Mapping[str, Network],
    chart: Chart,
) -> tuple[str, ...]:
    """Return labels that distinguish routes by the sides on which they pass land.

    Parameters
    ----------
    alternatives : Name of the route alternative of each route, by its canals.
    networks : Network of each alternative from start to goal; land near it counts. The first one is
        used where an alternative has none.

    Returns
    -------
    tuple of str : As ``alternatives`` where all routes of that name pass all land on the same
        sides. Else with the sides that differ: ``"west of Great Britain, east of Ireland"``. Land
        narrower (square root of its area) than 1 % of the distance does not count.
    """
    names = list(alternatives)
    default = next(iter(networks.values()))
    for one in dict.fromkeys(alternatives):
        members = [k for k, name in enumerate(alternatives) if name == one]
        labels = _homotopy_labels([routes[k] for k in members], networks.get(one, default), chart)
        for k, label in zip(members, labels):
            replaces = one == OPEN_SEA and label
            names[k] = label if replaces else ", ".join(filter(None, (one, label)))
    return tuple(names)


def _homotopy_labels(routes: Sequence[Route], network: Network, chart: Chart) -> list[str]:
    """Return labels of routes by the sides of land; empty where all pass on the same sides."""
    ends = [(network.lat[k], network.lon[k]) for k in (network.meta.start, network.meta.goal)]
    obstacle_map = obstacles(
        network, chart, _MIN_RELATIVE_SIZE * float(distance(*ends[0], *ends[1]))
    )
    keys = [obstacle_map.along(chart, route.track.lat, route.track.lon) for route in routes]
    counts = np.array([np.frombuffer(key, np.int64) for key in keys])[
        :, 1 : len(obstacle_map.points)
    ]
    classes, first, class_of = np.unique(counts, axis=0, return_index=True, return_inverse=True)
    if len(classes) == 1:
        return [""] * len(routes)
    lands = [
        _outline_at(chart.coastline.rings, *obstacle_map.points[1 + k])
        for k in _distinguishing_landmasses(classes)
    ]
    sides = [_passing_sides_label(routes[k], lands) for k in first]
    equal = [[n for n, text in enumerate(sides) if text == one] for one in sides]
    names = [
        text if len(same) == 1 else f"{text} ({same.index(n) + 1})"
        for n, (text, same) in enumerate(zip(sides, equal))
    ]
    return [names[n] for n in class_of.reshape(-1)]


def _distinguishing_landmasses(counts: NDArray[np.int64]) -> list[int]:
    """Return the largest landmasses that separate the classes, each by another pattern."""
    found: list[int] = []
    patterns: set[bytes] = set()
    for k, column in enumerate(counts.T):
        pattern = np.unique(column, return_inverse=True)[1].tobytes()
        if len(set(column.tolist())) > 1 and pattern not in patterns:
            patterns.add(pattern)
            found.append(k)
    return found[:_MAX_LANDMASSES_IN_LABEL]


def _outline_at(rings: Rings, lat: float, lon: float) -> tuple[FloatArray, FloatArray]:
    """Return the outline [deg] that starts at a position, longitudes without jumps."""
    begin = rings.start[:-1]
    k = int(np.flatnonzero((rings.lat[begin] == lat) & (rings.lon[begin] == lon))[0])
    part = slice(rings.start[k], rings.start[k + 1])
    return rings.lat[part], np.degrees(np.unwrap(np.radians(rings.lon[part])))


def _passing_sides_label(route: Route, lands: Sequence[tuple[FloatArray, FloatArray]]) -> str:
    return ", ".join(f"{_passing_side(route, *land)} of {land_name(*land)}" for land in lands)


def _passing_side(route: Route, lat: FloatArray, lon: FloatArray) -> str:
    """Return the compass point of a route at its closest, seen from the middle of the land."""
    middle = 0.5 * (lat.min() + lat.max()), 0.5 * (lon.min() + lon.max())
    there = route.samples["lat"], route.samples["lon"]
    separation, course, _ = inverse(
        np.full(len(there[0]), middle[0]), np.full(len(there[0]), middle[1]), *there
    )
    nearest = float(course[int(np.nanargmin(separation))])
    return _COMPASS_POINTS[round(nearest / (math.pi / 4.0)) % 8]


def land_name(lat: FloatArray, lon: FloatArray) -> str:
    """Return the name of the land inside an outline [deg], or its position if it has no name."""
    middle = (
        0.5 * (float(lat.min()) + float(lat.max())),
        0.5 * (float(lon.min()) + float(lon.max())),
    )
    names, (north, meridian) = list(landmasses()), np.array(list(landmasses().values())).T
    easts = middle[1] + wrap_longitude(meridian - middle[1])
    inside_box = (lat.min() <= north) & (north <= lat.max())
    inside_box &= (lon.min() <= easts) & (easts <= lon.max())
    for k in np.flatnonzero(inside_box):
        rise = np.where(np.diff(lat) == 0.0, np.inf, np.diff(lat))
        crossing = lon[:-1] + (north[k] - lat[:-1]) / rise * np.diff(lon)
        sides = (lat[:-1] <= north[k]) != (lat[1:] <= north[k])
        if sides[crossing > easts[k]].sum() % 2 == 1:
            return names[k]
    return f"the land at {format_position(middle[0], float(wrap_longitude(middle[1])))}"
