"""Closed passages as obstacles for the length round land: lines across them, from land to land."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart.offing import closing_line
from thalweg.core.geodesy import densify, longitude_difference
from thalweg.core.types import FloatArray

if TYPE_CHECKING:
    from thalweg.chart.coast.coastline import Coastline
    from thalweg.chart.passages import Passage

_STEP: Final = 10_000.0  # between positions on the great circles of a line [m]
_NEAREST: Final = 6  # polygons that are tried from an end of a line
_EDGES_TRIED: Final = 4  # of each of these
_PARTS: Final = 3  # of an edge, between which a line may enter the polygon
_AROUND: Final = 2.0  # turns beyond this from a line are not near it nor its ways inland [deg]
_BESIDE: Final = 0.002  # corners nearer to a line are on no clear side of it [deg]


class PassageLines:
    """Lines across closed passages, which no route crosses.

    Parameters
    ----------
    coastline : The lines end on its land.
    passages : Closed ones.
    land : Polygons (x longitude, y latitude [deg]) that are closed to ships.
    """

    def __init__(
        self, coastline: Coastline, passages: Iterable[Passage], land: Sequence[Any]
    ) -> None:
        import shapely

        self._land = np.asarray(land, object)
        shapely.prepare(self._land)
        self._west = float(shapely.total_bounds(self._land)[0]) if len(land) else 0.0
        self._lines = [np.array(closing_line(coastline, passage)) for passage in passages]
        for line in self._lines:
            first = self._west + (line[0, 1] - self._west) % 360.0
            line[:, 1] = first + longitude_difference(line[:, 1], first)

    def into(self, inner: Sequence[Any], turns: FloatArray) -> list[FloatArray]:
        """Return lines that reach into polygons inside the land.

        A route crosses neither a closed passage nor land. So it does not cross such a line: from
        the ends of the line across the passage it leads on through land.

        Parameters
        ----------
        inner : Polygons inside the land.
        turns : Places (lat, lon) where ways begin or turn, (n, 2) [deg]. Legs are tested on arcs
            within 100 m of geodesics, so that one that begins very near a line might count as
            crossing it although it does not: lines near these places are left out.

        Returns
        -------
        list of float64 array (n, 2)
            Latitudes and longitudes [deg] of each line, joined by great circles. Passages are left
            out if an end is on no land that holds an inner polygon in reach.
        """
        smaller = np.asarray(inner, object)
        found = []
        for across in self._lines:
            (south, west_end), (north, east_end) = across.min(axis=0), across.max(axis=0)
            near = turns[
                (turns[:, 0] > south - _AROUND)
                & (turns[:, 0] < north + _AROUND)
                & (turns[:, 1] > west_end - _AROUND)
                & (turns[:, 1] < east_end + _AROUND)
            ]
            if _is_beside(across, near):
                continue
            first, last = (_way_inland(self._land, smaller, place, near) for place in across)
            if first is not None and last is not None:
                found.append(np.concatenate([first[::-1], across, last]))
        return found

    def crossed(self, lat: FloatArray, lon: FloatArray) -> list[FloatArray]:
        """Return the lines across passages that a way crosses, all (lat, lon) [deg]."""
        import shapely

        if len(lat) < 2 or not self._lines:
            return []
        lon = self._west + np.unwrap(lon - self._west, period=360.0)
        lon -= 360.0 * np.floor((lon[0] - self._west) / 360.0)
        way = shapely.LineString(np.stack([lon, lat], axis=1))
        lines = [shapely.LineString(line[:, ::-1]) for line in self._lines]
        crossing = shapely.intersects(way, np.array(lines, object))
        return [line for line, crossed in zip(self._lines, crossing, strict=True) if crossed]


def _way_inland(land: Any, inner: Any, place: FloatArray, turns: FloatArray) -> FloatArray | None:
    """Return positions (lat, lon) [deg] from a place on land into an inner polygon, or None."""
    import shapely

    x, y = float(place[1]), float(place[0])
    hosts = land[shapely.contains_xy(land, x, y)]
    if not len(hosts):
        return None
    near = np.argsort(shapely.distance(inner, shapely.Point(x, y)))[:_NEAREST]
    for host in hosts:
        for shape in inner[near]:
            for way in _ways_into(shape, place):
                whole = np.concatenate([place[None], way])
                inland = shapely.covers(host, shapely.LineString(whole[:, ::-1]))
                if inland and not _is_beside(whole, turns):
                    return way
    return None


def _ways_into(shape: Any, place: FloatArray) -> Iterator[FloatArray]:
    """Yield positions (lat, lon) [deg] on and inside edges of a polygon, the nearest edge first."""
    import shapely

    ring = shapely.get_coordinates(shape.exterior)[:, ::-1]
    parts = np.linspace(0.0, 1.0, _PARTS + 1)[1:-1, None]
    for k in np.argsort(np.hypot(*(0.5 * (ring[1:] + ring[:-1]) - place).T))[:_EDGES_TRIED]:
        step = ring[k + 1] - ring[k]
        for edge in ring[k] + parts * step:
            for side in (-0.1, 0.1):  # of the length of the edge, to either side of it
                inside = edge + side * np.array([-step[1], step[0]])
                if shapely.contains_xy(shape, inside[1], inside[0]):
                    yield np.stack([edge, inside])


def _is_beside(line: FloatArray, places: FloatArray) -> bool:
    """Return whether one of some places is beside a line of great circles; all (lat, lon) [deg]."""
    import shapely

    if not len(places):
        return False
    lat, lon, _ = densify(line[:, 0], line[:, 1], _STEP)
    shape = shapely.LineString(np.stack([lon, lat], axis=1))
    return bool(shapely.dwithin(shapely.points(places[:, ::-1]), shape, _BESIDE).any())
