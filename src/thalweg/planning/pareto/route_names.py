"""Names of ways round: on which side of which land each route of a front passes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import Chart
from thalweg.chart.coast.rings import Rings
from thalweg.core.geodesy import distance, format_position, inverse, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.network import Network
from thalweg.network.alternatives.homotopy import obstacles
from thalweg.route import Route

_MIN_RELATIVE_SIZE = 0.01  # land narrower than this share of the distance does not count
_MAX_LANDMASSES_IN_LABEL = 3  # pieces of land in a name
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
#: A position (lat, lon) [deg] on each piece of land that has a name here.
LANDMASSES: Final[dict[str, tuple[float, float]]] = {
    "Europe and Asia": (50.0, 60.0), "Africa": (10.0, 20.0), "North America": (45.0, -100.0),
    "South America": (-10.0, -60.0), "Australia": (-25.0, 135.0), "Greenland": (72.0, -40.0),
    "Great Britain": (52.5, -1.5), "Ireland": (53.2, -7.8), "Iceland": (64.9, -18.5),
    "Lewis and Harris": (58.2, -6.6), "Skye": (57.3, -6.25), "Mull": (56.45, -5.9),
    "Mainland of Shetland": (60.4, -1.25), "Mainland of Orkney": (59.0, -3.1),
    "Isle of Man": (54.2, -4.55), "Anglesey": (53.28, -4.35), "Zealand": (55.5, 11.8),
    "Funen": (55.3, 10.4), "Gotland": (57.5, 18.5), "Oland": (56.75, 16.65),
    "Bornholm": (55.1, 14.9), "Saaremaa": (58.4, 22.5), "Hiiumaa": (58.9, 22.6),
    "Spitsbergen": (78.5, 17.0), "Northern Novaya Zemlya": (75.0, 60.0),
    "Southern Novaya Zemlya": (72.0, 54.5),
    "Sicily": (37.5, 14.0), "Sardinia": (40.0, 9.0), "Corsica": (42.15, 9.1),
    "Crete": (35.2, 24.9), "Cyprus": (35.0, 33.2), "Majorca": (39.6, 3.0), "Menorca": (39.97, 4.1),
    "Rhodes": (36.2, 27.95), "Lesbos": (39.2, 26.2), "Euboea": (38.6, 23.9),
    "Malta": (35.9, 14.43), "Tenerife": (28.3, -16.55), "Gran Canaria": (27.95, -15.6),
    "Madeira": (32.75, -17.0), "Newfoundland": (48.8, -56.0), "Cape Breton": (46.2, -60.7),
    "Prince Edward Island": (46.4, -63.3), "Anticosti": (49.5, -63.0),
    "Baffin Island": (68.0, -70.0), "Chiloe": (-42.6, -73.9),
    "Long Island": (40.85, -73.0), "Vancouver Island": (49.6, -125.6), "Kodiak": (57.4, -153.5),
    "Haida Gwaii": (53.5, -132.3), "Hawaii": (19.6, -155.5), "Maui": (20.75, -156.25),
    "Oahu": (21.47, -158.0), "Cuba": (21.8, -79.0), "Hispaniola": (19.0, -71.0),
    "Jamaica": (18.15, -77.3), "Puerto Rico": (18.2, -66.4), "Trinidad": (10.4, -61.2),
    "Andros": (24.4, -78.0), "Great Inagua": (21.1, -73.3), "Barbados": (13.17, -59.55),
    "Guadeloupe": (16.15, -61.7), "Martinique": (14.65, -61.0), "Tierra del Fuego": (-54.2, -68.5),
    "East Falkland": (-51.7, -58.7), "West Falkland": (-51.8, -60.2),
    "South Georgia": (-54.4, -36.7), "Madagascar": (-19.0, 46.5), "Reunion": (-21.1, 55.5),
    "Mauritius": (-20.3, 57.55), "Socotra": (12.5, 53.9), "Sri Lanka": (7.5, 80.7),
    "Sumatra": (0.0, 102.0), "Java": (-7.3, 110.0), "Borneo": (1.0, 114.0),
    "Sulawesi": (-2.0, 120.5), "Halmahera": (1.5, 127.75), "Timor": (-9.0, 125.0),
    "Bali": (-8.35, 115.1), "Lombok": (-8.6, 116.3), "Sumbawa": (-8.8, 117.2),
    "Flores": (-8.65, 121.2), "Sumba": (-9.8, 120.0), "Seram": (-3.1, 129.3),
    "Bangka": (-2.3, 106.1), "Belitung": (-2.9, 107.9), "New Guinea": (-5.5, 141.0),
    "New Britain": (-5.7, 151.0), "New Ireland": (-3.4, 152.1), "Bougainville": (-6.2, 155.3),
    "Grande Terre": (-21.3, 165.4), "Viti Levu": (-17.8, 178.0), "Luzon": (16.5, 121.0),
    "Mindoro": (12.9, 121.1), "Panay": (11.1, 122.5), "Negros": (10.0, 123.0),
    "Cebu": (10.3, 123.75), "Leyte": (10.9, 124.8), "Samar": (11.9, 125.1), "Palawan": (9.8, 118.6),
    "Mindanao": (7.8, 125.0), "Taiwan": (23.8, 121.0), "Hainan": (19.2, 109.8),
    "Honshu": (36.5, 138.5), "Hokkaido": (43.4, 142.8), "Kyushu": (32.5, 131.0),
    "Shikoku": (33.7, 133.5), "Okinawa": (26.55, 128.0), "Jeju": (33.37, 126.55),
    "Sakhalin": (51.0, 143.0), "Tasmania": (-42.0, 146.6), "North Island": (-38.8, 175.8),
    "South Island": (-43.8, 170.8), "Stewart Island": (-47.0, 167.9),
}  # fmt: skip


def route_labels(
    routes: Sequence[Route], ways: Sequence[str], networks: Mapping[str, Network], chart: Chart
) -> tuple[str, ...]:
    """Return names that tell ways apart which pass land on other sides.

    Parameters
    ----------
    routes : sequence of Route
    ways : sequence of str
        The way round of each by its canals.
    networks : mapping of str to Network
        Of each way, the first where a way has none, from start to goal: land near it counts.
    chart : Chart

    Returns
    -------
    tuple of str
        As ``ways`` where all routes of that name pass all land on the same sides. Else with the
        side of what differs: ``"west of Great Britain, east of Ireland"``. Land that is narrower
        (square root of its area) than 1 % of the distance counts on either side alike.
    """
    names = list(ways)
    default = next(iter(networks.values()))
    for way in dict.fromkeys(ways):
        mine = [k for k, name in enumerate(ways) if name == way]
        found = _homotopy_labels([routes[k] for k in mine], networks.get(way, default), chart)
        for k, text in zip(mine, found):
            names[k] = text if way == "open sea" and text else ", ".join(filter(None, (way, text)))
    return tuple(names)


def _homotopy_labels(routes: Sequence[Route], network: Network, chart: Chart) -> list[str]:
    """Return what tells routes apart that pass land on other sides; nothing where none do."""
    ends = [(network.lat[k], network.lon[k]) for k in (network.meta.start, network.meta.goal)]
    seen = obstacles(network, chart, _MIN_RELATIVE_SIZE * float(distance(*ends[0], *ends[1])))
    keys = [seen.along(chart, route.track.lat, route.track.lon) for route in routes]
    counts = np.array([np.frombuffer(key, np.int64) for key in keys])[:, 1 : len(seen.points)]
    kinds, first, kind = np.unique(counts, axis=0, return_index=True, return_inverse=True)
    if len(kinds) == 1:
        return [""] * len(routes)
    lands = [
        _outline_at(chart.land.rings, *seen.points[1 + k])
        for k in _distinguishing_landmasses(kinds)
    ]
    told = [_passing_sides_label(routes[k], lands) for k in first]
    alike = [[n for n, text in enumerate(told) if text == mine] for mine in told]
    names = [
        text if len(same) == 1 else f"{text} ({same.index(n) + 1})"
        for n, (text, same) in enumerate(zip(told, alike))
    ]
    return [names[n] for n in kind.reshape(-1)]


def _distinguishing_landmasses(counts: NDArray[np.int64]) -> list[int]:
    """Return the largest pieces of land that are passed differently, each in another way."""
    found: list[int] = []
    patterns: set[bytes] = set()
    for k, column in enumerate(counts.T):
        pattern = np.unique(column, return_inverse=True)[1].tobytes()
        if len(set(column.tolist())) > 1 and pattern not in patterns:
            patterns.add(pattern)
            found.append(k)
    return found[:_MAX_LANDMASSES_IN_LABEL]


def _outline_at(rings: Rings, lat: float, lon: float) -> tuple[FloatArray, FloatArray]:
    """Return the outline [deg] that begins at a position, longitudes without jumps."""
    begin = rings.start[:-1]
    k = int(np.flatnonzero((rings.lat[begin] == lat) & (rings.lon[begin] == lon))[0])
    part = slice(rings.start[k], rings.start[k + 1])
    return rings.lat[part], np.degrees(np.unwrap(np.radians(rings.lon[part])))


def _passing_sides_label(route: Route, lands: Sequence[tuple[FloatArray, FloatArray]]) -> str:
    return ", ".join(f"{_passing_side(route, *land)} of {land_name(*land)}" for land in lands)


def _passing_side(route: Route, lat: FloatArray, lon: FloatArray) -> str:
    """Return the point of the compass at which a route passes land, seen from its middle."""
    middle = 0.5 * (lat.min() + lat.max()), 0.5 * (lon.min() + lon.max())
    there = route.samples["lat"], route.samples["lon"]
    away, course, _ = inverse(
        np.full(len(there[0]), middle[0]), np.full(len(there[0]), middle[1]), *there
    )
    nearest = float(course[int(np.nanargmin(away))])
    return _COMPASS_POINTS[round(nearest / (math.pi / 4.0)) % 8]


def land_name(lat: FloatArray, lon: FloatArray) -> str:
    """Return the name of the land inside an outline [deg]; where it lies if it has none."""
    middle = (
        0.5 * (float(lat.min()) + float(lat.max())),
        0.5 * (float(lon.min()) + float(lon.max())),
    )
    for name, (y, x) in LANDMASSES.items():
        east = middle[1] + float(wrap_longitude(x - middle[1]))
        if not (lat.min() <= y <= lat.max() and lon.min() <= east <= lon.max()):
            continue
        rise = np.where(np.diff(lat) == 0.0, np.inf, np.diff(lat))
        crossing = lon[:-1] + (y - lat[:-1]) / rise * np.diff(lon)
        if ((lat[:-1] <= y) != (lat[1:] <= y))[crossing > east].sum() % 2 == 1:
            return name
    return f"the land at {format_position(middle[0], float(wrap_longitude(middle[1])))}"
