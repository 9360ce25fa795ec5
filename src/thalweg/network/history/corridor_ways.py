"""Arcs of the water that ships usually use between two places: lanes along them, their tubes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.history.arc_statistics import SHARES
from thalweg.network.history.history_arcs import HistoryArcs
from thalweg.network.history.route_lines import attached_line

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal

LANES: Final = 5  #: nodes across the corridor
_TUBE_SPACING: Final = 5.0 * NAUTICAL_MILE
_NEAR_ENDS: Final = 1.5  # radii of a junction that the leg to its middle replaces
_AT_NODE: Final = 0.1 * NAUTICAL_MILE  # lines that end so near to a node lead to it
_LEAST_HALF_WIDTH: Final = 2.0 * NAUTICAL_MILE


@dataclass(frozen=True, eq=False)
class CorridorWays:
    """Arcs of a corridor between two places.

    Parameters
    ----------
    places : (lat, lon) of ndarray (N,)
        Nodes [deg].
    arcs : All arcs.
    kept : Those of the corridor.
    ends : (int, int)
        Nodes of start and goal.
    weight : What arcs count in the choice of the way [m], (A,).
    junctions : The first nodes, at which lines end where their voyages passed.
    radius : Radius of a junction [m].
    """

    places: tuple[FloatArray, FloatArray]
    arcs: HistoryArcs
    kept: IntArray
    ends: tuple[int, int]
    weight: FloatArray = field(repr=False)
    junctions: int = 0
    radius: float = 0.0

    def shortest(self) -> float:
        """Return the least weight from start to goal [m]."""
        known = _distances(len(self.places[0]), self.arcs, self.weight, self.ends[0])
        return float(known[self.ends[1]])

    def line(self, arc: int) -> tuple[FloatArray, FloatArray]:
        """Return the waypoints of an arc [deg], from node to node."""
        lat, lon = self.arcs.lines.of(arc)
        most = min(_NEAR_ENDS * self.radius, 0.25 * float(self.arcs.lines.lengths[arc]))
        ends, margins = [], np.zeros(2)
        for k, node in enumerate((int(self.arcs.tail[arc]), int(self.arcs.head[arc]))):
            place = float(self.places[0][node]), float(self.places[1][node])
            ends.append(place)
            if node < self.junctions and distance(lat[-k], lon[-k], *place) > _AT_NODE:
                margins[k] = most
        return attached_line((lat, lon), (ends[0], ends[1]), margins)

    def lanes(self, arc: int, spacing: float) -> tuple[FloatArray, FloatArray]:
        """Return positions across an arc at its stations.

        Parameters
        ----------
        spacing : Greatest distance between stations [m].

        Returns
        -------
        lat, lon : ndarray (m, 5)
            [deg]; port to starboard, the middle one on the line. The ends of the arc are left out.
        """
        lat, lon, _ = geodesy.densify(*self.line(arc), spacing)
        lat, lon, course, share = _stations(lat, lon)
        tube = self.arcs.tube[arc]
        port = np.minimum(np.interp(share, SHARES, tube[:, 0]), -_LEAST_HALF_WIDTH)
        starboard = np.maximum(np.interp(share, SHARES, tube[:, 1]), _LEAST_HALF_WIDTH)
        half = LANES // 2
        steps = np.arange(1, half + 1) / half
        aside = np.concatenate(
            [port[:, None] * steps[::-1], np.zeros((len(share), 1)), starboard[:, None] * steps],
            axis=1,
        )
        found = geodesy.direct(lat[:, None], lon[:, None], course[:, None] + 0.5 * np.pi, aside)
        for values, middle in zip(found, (lat, lon)):
            values[:, half] = middle
        return found[0][1:-1], found[1][1:-1]

    def canals_on_way(self, chart: Chart, radius: float) -> list[Canal]:
        """Return the canals of a chart with both ends within a radius [m] of nodes in use."""
        nodes = np.union1d(self.arcs.tail[self.kept], self.arcs.head[self.kept])
        lat, lon = self.places[0][nodes], self.places[1][nodes]
        return [
            canal
            for canal in chart.canals
            if all(np.min(geodesy.distance(lat, lon, *end)) <= radius for end in canal.ends)
        ]

    def tube(self, arc: int, radius: float) -> list[Any]:
        """Return shapely polygons that cover the tube of an arc and its nodes."""
        lat, lon, _ = geodesy.densify(*self.line(arc), _TUBE_SPACING)
        _, _, _, share = _stations(lat, lon)
        tube = self.arcs.tube[arc]
        port, starboard = (
            np.maximum(sign * np.interp(share, SHARES, side), _LEAST_HALF_WIDTH)
            for sign, side in zip((-1.0, 1.0), tube.T)
        )
        near = np.maximum(radius * (1.0 - np.minimum(share, 1.0 - share) * 10.0), 0.0)
        return strip_polygons(np.stack([lat, lon], axis=1), np.maximum(port, near),
                      np.maximum(starboard, near))  # fmt: skip


def _stations(
    lat: FloatArray, lon: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return a line with its courses [rad] and shares of its length at every position."""
    length, start, end = geodesy.inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])
    first, last = np.append(start, end[-1]), np.append(start[0], end)
    course = np.angle(np.exp(1j * first) + np.exp(1j * last))
    along = cumulative_sums(length)
    return lat, lon, course, along / max(float(along[-1]), 1e-9)


def strip_polygons(
    line: FloatArray, port: FloatArray | float, starboard: FloatArray | float | None = None
) -> list[Any]:
    """Return polygons that cover the water beside a line (n, 2) [deg], longitudes unwrapped."""
    import shapely

    lat, lon = line[:, 0], geodesy.unwrap_longitude(line[:, 1])
    count = len(lat)
    widths = [np.broadcast_to(np.asarray(w, float), (count,))
              for w in (port, port if starboard is None else starboard)]  # fmt: skip
    around = np.arange(16) * (2.0 * np.pi / 16.0)
    if count > 1 and (np.diff(lat) != 0.0).any() | (np.diff(lon) != 0.0).any():
        _, _, course, _ = _stations(lat, lon)
    else:
        course = np.zeros(count)
    sides = []
    for width, sign in zip(widths, (-1.0, 1.0)):
        y, x = geodesy.direct(lat, lon, course + sign * 0.5 * np.pi, width)
        sides.append((y, lon + geodesy.wrap_longitude(x - lon)))
    shapes = []
    for k in range(count - 1):
        corners = [(sides[s][1][k + d], sides[s][0][k + d]) for s in (0, 1) for d in (0, 1)]
        shapes.append(shapely.convex_hull(shapely.multipoints(corners)))
    for k in (0, count - 1):
        reach = max(float(widths[0][k]), float(widths[1][k]))
        y, x = geodesy.direct(lat[k], lon[k], around, reach)
        shapes.append(
            shapely.polygons(np.stack([lon[k] + geodesy.wrap_longitude(x - lon[k]), y], 1))
        )
    return [shape for shape in shapes if shape.geom_type == "Polygon"]


def _distances(count: int, arcs: HistoryArcs, weight: FloatArray, root: int, *,
               backward: bool = False) -> FloatArray:  # fmt: skip
    """Return the least weights from a node to all others, or to it."""
    tail, head = (arcs.head, arcs.tail) if backward else (arcs.tail, arcs.head)
    order = np.argsort(tail, kind="stable")
    indptr = np.searchsorted(tail[order], np.arange(count + 1)).astype(np.int64)
    known, parent = np.empty(count), np.empty(count, np.int64)
    static_astar(
        indptr, head[order].astype(np.int32), weight[order], np.zeros(count), root, -1, known,
        parent,
    )  # fmt: skip
    return known


def arcs_between(
    count: int, arcs: HistoryArcs, weight: FloatArray, ends: tuple[int, int], longest: float
) -> IntArray:
    """Return the arcs on ways from start to goal that are not too long."""
    before = _distances(count, arcs, weight, ends[0])
    after = _distances(count, arcs, weight, ends[1], backward=True)
    if not np.isfinite(before[ends[1]]):
        return np.empty(0, np.int64)
    with np.errstate(invalid="ignore"):
        whole = before[arcs.tail] + weight + after[arcs.head]
        forward = before[arcs.tail] < before[arcs.head]
    near = np.isfinite(whole) & (whole <= longest * before[ends[1]])
    return np.flatnonzero(near & forward)
