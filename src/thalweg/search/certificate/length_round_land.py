"""The least length of a way round land: no route to the goal is shorter.

Land is replaced by polygons inside it with fewer corners. The shortest way round polygons turns at
their corners only, so it is found exactly, by A* on the legs between corners that are free. A route
keeps clear of all land, and so of the polygons: it is no shorter.
"""

from __future__ import annotations

import heapq
import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.coast.leg_status import point_status
from thalweg.core.geodesy import densify, distance, unit_vectors
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.codes import OK
from thalweg.kernels.geometry.coast_index import leg_codes
from thalweg.search.certificate.barrier_mesh import BarrierLink
from thalweg.search.certificate.closed_polygons import ClosedPolygons
from thalweg.search.certificate.land_corners import (
    ANGLE_TOLERANCE,
    Corners,
    corners_of,
    places_of_turns,
)
from thalweg.search.certificate.lines_across_passages import PassageLines
from thalweg.search.certificate.local_outlines import LocalOutlines
from thalweg.search.certificate.positions_in_reach import SPHERE, Reach
from thalweg.search.search_problem import ROUNDING_FACTOR

if TYPE_CHECKING:
    from thalweg.chart import Chart

_METRES_OF_TOLERANCE: Final = 4.0e7  # of length for a degree of the first tolerance
_LEAST_TOLERANCE, _MOST_TOLERANCE = 0.002, 0.1  # [deg]
_SLOWER: Final = 1.5  # a search with outlines that are finer somewhere than the one before
_ENOUGH: Final = 0.995  # of the known length, at which no finer outline is tried
_BESIDE: Final = 1  # tiles round those where a way crosses land are refined with them
_DEGREE: Final = 1.1e5  # [m]
_LONGEST_TESTED: Final = 1.8  # chord of a leg whose arc is tested [radii]
_MARGIN: Final = 1.01  # by which legs tested first are longer than the length that is likely
_LENGTH_TOLERANCE: Final = 1e-6  # by which the known length may be surpassed


def length_round_land(
    chart: Chart,
    start: tuple[float, float],
    goal: tuple[float, float],
    known: float,
    *,
    links: Sequence[BarrierLink] = (),
    speed: float = 1.0,
    kept_out: Sequence[Any] = (),
    seconds: float,
) -> float:
    """Return a length [m] that no route is shorter than.

    Parameters
    ----------
    chart : Its land and no-go zones, and the latitudes beyond its area, are kept clear of; its
        closed passages are not crossed.
    start, goal : (lat, lon) [deg].
    known : Length of a route that exists [m], with what its canals count.
    links : Canals that a route may pass; they count as long as the ship sails in their time.
    speed : Of the ship [m/s].
    kept_out : Shapely polygons (x longitude, y latitude [deg]) that count as no-go zones too.
    seconds : Time for the search, after which its bound so far is returned [s].

    Returns
    -------
    float : That of the geodesic at least, unless a canal counts less than the way between its ends.
    """
    began = clock.perf_counter()
    direct = float(distance(*start, *goal))
    reach = Reach(start, goal, known, speed)
    links = [link for link in links if reach.by_link(link) < known]
    short = [one for one in links if one.seconds * speed < float(distance(*one.one, *one.other))]
    free = ROUNDING_FACTOR * min([direct, *(reach.by_link(link) for link in short)])
    if known <= free or seconds <= 0.0 or short:
        return free
    tolerance = min(max(known / _METRES_OF_TOLERANCE, _LEAST_TOLERANCE), _MOST_TOLERANCE)
    outlines = LocalOutlines(ClosedPolygons.within_reach(chart, reach, kept_out), tolerance)
    shut = [one for one in chart.closed_passages if reach.has(*one.positions).any()]
    across = PassageLines(chart.coastline, shut, outlines.land)
    best, way = free, Way(0.0)
    while True:
        now = clock.perf_counter()
        way = _shortest_way(outlines, across, reach, links, began + seconds, way.length)
        best = max(best, ROUNDING_FACTOR * way.length)
        ended = clock.perf_counter()
        if best >= _ENOUGH * known or ended + _SLOWER * (ended - now) > began + seconds:
            return best
        crossed, cut = _closed_places(way, outlines, across)
        if not outlines.refine(crossed, beside=_BESIDE) and not outlines.refine(cut):
            return best


def _shortest_way(
    outlines: LocalOutlines,
    across: PassageLines,
    reach: Reach,
    links: Sequence[BarrierLink],
    until: float,
    likely: float,
) -> Way:
    """Return the shortest way round outlines, or a bound without positions."""
    shapes, inner = outlines.outlines()
    if not shapes:
        return Way(0.0)
    turns = places_of_turns(shapes, reach, links)
    corners = corners_of(shapes, inner, reach, across.into(inner, turns))
    search = _Search.between(corners, reach, links)
    return Way(0.0) if search.is_enclosed() else search.run(until, likely)


def _closed_places(
    way: Way, outlines: LocalOutlines, across: PassageLines
) -> tuple[FloatArray, FloatArray]:
    """Return where a way crosses land and closed passages, and where it cuts land at its turns.

    Both (lat, lon) [deg], (2, n).
    """
    crossed, cut = [np.empty((2, 0))], [np.empty((2, 0))]
    for leg in way.legs:
        lat, lon, _ = densify(leg[:, 0], leg[:, 1], _DEGREE * outlines.finest)
        crossed += [line.T for line in across.crossed(lat, lon)]
        on_land = outlines.closed_positions(lat, lon)
        at_sea = np.flatnonzero(~on_land)
        if not len(at_sea):
            crossed.append(np.stack([lat, lon]))
            continue
        between = np.arange(len(lat))
        between = (between > at_sea[0]) & (between < at_sea[-1])
        crossed.append(np.stack([lat, lon])[:, on_land & between])
        cut.append(np.stack([lat, lon])[:, on_land & ~between])
    return np.concatenate(crossed, axis=1), np.concatenate(cut, axis=1)


def directions(lat: FloatArray, lon: FloatArray, course: FloatArray) -> FloatArray:
    """Return the unit vectors of courses [rad] at positions [deg], (n, 3)."""
    lam = np.radians(lon)
    east = np.stack([-np.sin(lam), np.cos(lam), np.zeros_like(lam)], -1)
    north = np.cross(unit_vectors(lat, lon), east)
    return np.asarray(np.sin(course)[:, None] * east + np.cos(course)[:, None] * north)


@dataclass(frozen=True, eq=False)
class Way:
    """A shortest way, or a bound of its length.

    Attributes
    ----------
    length : Least length [m]; 0 where none is known.
    legs : Ends (lat, lon) [deg] of its geodesics, (n, 2, 2), without those through canals; none of
        a bound.
    """

    length: float
    legs: FloatArray = field(default_factory=lambda: np.empty((0, 2, 2)))


@dataclass(eq=False)
class _Search:
    """A* from the start to the goal by legs between corners and the ends of canals.

    Attributes
    ----------
    lat, lon : Of the nodes [deg]: start, goal, ends of canals, corners.
    up : Their unit vectors, (n, 3).
    sides : Normals of the planes by both edges of the corners, of unit length, (2, n, 3); else 0.
    first : Number of nodes that are no corners.
    rest : Lower bound of the length from each node to the goal [m].
    known : Longest length that counts [m].
    """

    corners: Corners
    links: Sequence[BarrierLink]
    speed: float
    lat: FloatArray
    lon: FloatArray
    up: FloatArray
    sides: FloatArray
    first: int
    rest: FloatArray
    known: float

    @classmethod
    def between(cls, corners: Corners, reach: Reach, links: Sequence[BarrierLink]) -> _Search:
        """Return the search for a passage."""
        single = [
            reach.start,
            reach.goal,
            *(end for link in links for end in (link.one, link.other)),
        ]
        lat, lon = (np.concatenate([x, y]) for x, y in zip(
            np.array(single).T, (corners.lat, corners.lon), strict=True))  # fmt: skip
        rest = np.asarray(distance(lat, lon, *reach.goal))
        known = reach.known * (1.0 + _LENGTH_TOLERANCE)
        up, sides = unit_vectors(lat, lon), np.zeros((2, len(lat), 3))
        first = len(single)
        for side, course in zip(sides, (corners.back, corners.on), strict=True):
            side[first:] = np.cross(up[first:], directions(lat[first:], lon[first:], course))
        return cls(corners, links, reach.speed, lat, lon, up, sides, first, rest, known)

    def is_enclosed(self) -> bool:
        """Return whether the start, the goal or the end of a canal is inside a polygon."""
        single = self.lat[: self.first], self.lon[: self.first]
        return bool((point_status(self.corners.coast, *single) != OK).any())

    def run(self, until: float, likely: float = 0.0) -> Way:
        """Return the shortest way; a bound where time is up, 0 if there is no way.

        Parameters
        ----------
        until : Time by the clock at which the search ends [s].
        likely : A length that is probably not much shorter [m].
        """
        best = np.full(len(self.lat), math.inf)
        best[0] = 0.0
        done = np.zeros(len(self.lat), bool)
        before = np.full(len(self.lat), -1)
        queue = [(float(self.rest[0]), 0)]
        limit = min(_MARGIN * max(likely, float(self.rest[0])), self.known)
        later: list[tuple[int, NDArray[np.int64], FloatArray]] = []

        def reach(node: int, others: NDArray[np.int64], least: FloatArray) -> None:
            """Enter the nodes that are nearer by free legs; those beyond the limit wait."""
            nearer = (least < best[others]) & ~done[others]
            soon = nearer & (least + self.rest[others] <= limit)
            if (soon != nearer).any():
                later.append((node, others[nearer & ~soon], least[nearer & ~soon]))
            others = others[soon]
            others = others[self._are_free(node, others)]
            here = self.lat[node], self.lon[node]
            far = best[node] + distance(*here, self.lat[others], self.lon[others])
            nearer = (far < best[others]) & (far + self.rest[others] <= self.known)
            enter(node, others[nearer], far[nearer])

        def enter(node: int, others: NDArray[np.int64], far: FloatArray) -> None:
            best[others], before[others] = far, node
            for entry in zip((far + self.rest[others]).tolist(), others.tolist(), strict=True):
                heapq.heappush(queue, entry)

        while queue or later:
            if later and (not queue or queue[0][0] > limit):
                limit = min(_MARGIN * limit, self.known)
                waiting, later = later, []
                for legs in waiting:
                    reach(*legs)
                continue
            least, node = heapq.heappop(queue)
            if node == 1:
                return Way(least, self._legs(before))
            if clock.perf_counter() > until:
                return Way(least)
            if done[node]:
                continue
            done[node] = True
            reach(node, *self._legs_from(node, best, done))
            other, passed = self._by_canal(node, best)
            if passed < best[other] and passed + self.rest[other] <= self.known:
                enter(node, np.array([other]), np.array([passed]))
        return Way(0.0)

    def _legs(self, before: NDArray[np.int64]) -> FloatArray:
        """Return the geodesics of the way to the goal, the last first."""
        legs, node = [], 1
        while node != 0:
            last = int(before[node])
            by_canal = min(last, node) >= 2 and max(last, node) < self.first and last ^ 1 == node
            if not by_canal:
                legs.append([[self.lat[k], self.lon[k]] for k in (last, node)])
            node = last
        return np.array(legs).reshape(-1, 2, 2)

    def _legs_from(
        self, node: int, best: FloatArray, done: BoolArray
    ) -> tuple[NDArray[np.int64], FloatArray]:
        """Return the nodes to which legs from one may lead, and the least length to them [m]."""
        least = best[node] + SPHERE * np.arccos(np.clip(self.up @ self.up[node], -1.0, 1.0))
        nearer = ~done & (least < np.minimum(best, self.known - self.rest))
        some = np.flatnonzero(nearer & self._touches(node))
        return some, least[some]

    def _by_canal(self, node: int, best: FloatArray) -> tuple[int, float]:
        """Return the other end of the canal of a node, and the length to it [m]."""
        if not 2 <= node < self.first:
            return node, math.inf
        return node ^ 1, float(best[node]) + self.links[(node - 2) // 2].seconds * self.speed

    def _are_free(self, node: int, others: NDArray[np.int64]) -> BoolArray:
        """Return which legs from a node touch no polygon.

        The arcs that are tested are within 100 m of the geodesics, up to 14,000 km, and polygons of
        `Corners` are farther inside than that. Longer legs count as free.
        """
        count = len(others)
        ends = np.full(count, self.lat[node]), np.full(count, self.lon[node])
        code, unsure = np.empty(count, np.int8), np.empty(count, np.bool_)
        leg_codes(self.corners.coast, *ends, self.lat[others], self.lon[others], code, unsure)
        chord = np.linalg.norm(self.up[others] - self.up[node], axis=1)
        return np.asarray((code == OK) | (chord > _LONGEST_TESTED))

    def _touches(self, node: int) -> BoolArray:
        """Return to which nodes legs from one leave the polygons of both on one side.

        Sines of courses relative to the leg, times that of its length, are triple products of
        directions; to starboard they are positive.
        """
        cosine = self.up @ self.up[node]
        margin = ANGLE_TOLERANCE * np.sqrt(np.maximum(1.0 - cosine * cosine, 0.0))
        there = [-(side @ self.up[node]) for side in self.sides]
        here = [self.up @ side[node] for side in self.sides]
        result = np.ones(len(self.up), bool)
        for back, on in (there, here):
            to_starboard = (back >= -margin) & (on >= -margin)
            result &= to_starboard | ((back <= margin) & (on <= margin))
        return result
