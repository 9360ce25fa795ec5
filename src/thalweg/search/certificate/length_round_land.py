"""The least length of a way round land: no route to the goal is shorter.

Land is replaced by polygons inside it with fewer corners. The shortest way round polygons turns at
their corners only, so it is found exactly, by A* on the legs between corners that are free. A route
keeps clear of all land, and so of the polygons: it is no shorter.
"""

from __future__ import annotations

import heapq
import math
import time as clock
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.basemap import ring_bounds
from thalweg.chart.coast.leg_tests import point_status
from thalweg.chart.rings import Rings
from thalweg.core.geodesy import distance, unit_vectors
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.codes import OK
from thalweg.kernels.geometry.coast_index import leg_codes
from thalweg.search.certificate.barrier_mesh import BarrierLink
from thalweg.search.certificate.land_corners import (
    ANGLE_TOLERANCE,
    Corners,
    corners_of,
    inner_polygons,
    land_inside,
    places_of_turns,
)
from thalweg.search.certificate.lines_across_passages import lines_across_passages
from thalweg.search.certificate.positions_in_reach import SPHERE, Reach
from thalweg.search.search_problem import ROUNDING_FACTOR

if TYPE_CHECKING:
    from thalweg.chart import Chart

_METRES_OF_TOLERANCE: Final = 4.0e7  # of length for a degree of the first tolerance
_LEAST_TOLERANCE, _MOST_TOLERANCE = 0.002, 0.1  # [deg]
_FINER, _FINEST = 0.4, 3  # factor of finer tolerances, and how often it is applied
_SLOWER: Final = 2.5  # a search with a finer tolerance than the one before
_ENOUGH: Final = 0.995  # of the known length, at which no finer tolerance is tried
_LONGEST_TESTED: Final = 1.8  # chord of a leg whose arc is tested [radii]
_FEW_CORNERS: Final = 16  # of rings that are used wherever their corners are
_CAP_STEP: Final = 2.0  # of the outline of a closed polar cap [deg]
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
    best = free
    near = _rings_within(chart.coastline.rings, reach)
    for level in range(_FINEST + 1):
        now = clock.perf_counter()
        fine = _FINER**level * tolerance
        closed = _closed_shapes(chart, near, reach, fine, kept_out)
        found = _least_length(chart, closed, reach, links, fine, began + seconds)
        best = max(best, ROUNDING_FACTOR * found)
        ended = clock.perf_counter()
        if best >= _ENOUGH * known or ended + _SLOWER * (ended - now) > began + seconds:
            break
    return best


def _least_length(
    chart: Chart,
    closed: Sequence[Any],
    reach: Reach,
    links: Sequence[BarrierLink],
    tolerance: float,
    until: float,
) -> float:
    """Return the least length round polygons inside some [m], or a bound; 0 where there is none."""
    shapes = land_inside(closed, tolerance)
    if not shapes:
        return 0.0
    inner = inner_polygons(shapes, tolerance)
    shut = [one for one in chart.closed_passages if reach.has(*one.positions).any()]
    turns = places_of_turns(shapes, reach, links)
    across = lines_across_passages(chart.coastline, shut, closed, inner, turns)
    corners = corners_of(shapes, inner, reach, across)
    search = _Search.between(corners, reach, links)
    if search.is_enclosed():
        return 0.0
    found = search.run(until)
    return 0.0 if math.isnan(found) else found


def _frames(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return unit vectors up, east and north, (3, n, 3)."""
    lam = np.radians(lon)
    east = np.stack([-np.sin(lam), np.cos(lam), np.zeros_like(lam)], -1)
    up = unit_vectors(lat, lon)
    return np.stack([up, east, np.cross(up, east)])


def _closed_shapes(
    chart: Chart,
    near: NDArray[np.int64],
    reach: Reach,
    tolerance: float,
    kept_out: Sequence[Any],
) -> list[Any]:
    """Return the polygons (x lon, y lat [deg]) within reach that are closed to a ship.

    The land is that of the rings of the coastline with the numbers near.
    """
    import shapely

    box = reach.box()  # land outside is left out: the length round less land is no longer
    west = reach.middle - 180.0
    land = np.array(list(_land_polygons(chart.coastline.rings, near, box, tolerance)), object)
    whole = np.where(shapely.is_valid(land), land, shapely.make_valid(land))
    # one polygon of all that the data cut at meridians, canals and narrows; no water inside it
    parts = shapely.get_parts(shapely.get_parts(shapely.union_all(whole)))
    parts = parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]
    found = list(shapely.polygons(shapely.get_exterior_ring(parts)))
    zones = np.array([*chart.zones.closed_shapes, *kept_out], dtype=object)
    left, bottom, right, top = shapely.bounds(zones).reshape(-1, 4).T
    for shift in (-360.0, 0.0, 360.0):
        near = (left + shift < box[2]) & (right + shift > box[0])
        near &= (bottom < box[3]) & (top > box[1])
        outlines = shapely.polygons(shapely.get_exterior_ring(zones[near]))
        moved = shapely.transform(outlines, lambda xy, by=shift: xy + np.array([by, 0.0]))
        found += list(shapely.clip_by_rect(moved, *box))
    south, north, _, _ = chart.area.array()
    across = np.arange(west, west + 360.0 + _CAP_STEP, _CAP_STEP)
    for edge, pole in ((south, -90.0), (north, 90.0)):
        if abs(edge) < 89.0:
            line = [*((x, edge) for x in across), (across[-1], pole), (across[0], pole)]
            found.append(shapely.Polygon(line))
    return [shape for shape in found if not shape.is_empty]


def _rings_within(rings: Rings, reach: Reach) -> NDArray[np.int64]:
    """Return the numbers of the rings with a corner within reach, or with few corners.

    The few corners of a ring may be far away on both sides of what is within reach.
    """
    if not len(rings):
        return np.empty(0, np.int64)
    box = reach.box()
    south, north, _, _ = ring_bounds(rings)
    counts = np.diff(rings.start)
    some = np.flatnonzero((north > box[1]) & (south < box[3]))
    start = np.cumsum(counts[some]) - counts[some]
    corners = np.repeat(rings.start[some] - start, counts[some])
    corners += np.arange(len(corners))
    kept = counts[some] <= _FEW_CORNERS
    if len(some):
        has = reach.has(rings.lat[corners], rings.lon[corners])
        kept |= np.logical_or.reduceat(has, start)
    return some[kept]


def _land_polygons(
    rings: Rings, near: NDArray[np.int64], box: tuple[float, ...], tolerance: float
) -> Iterable[Any]:
    """Yield the land in a box of those outer rings of some that are large enough."""
    import shapely

    if not len(near):
        return
    south, north, west, east = ring_bounds(rings)
    large = np.maximum(north - south, east - west) >= 4.0 * tolerance
    for number in near[large[near]]:
        part = slice(rings.start[number], rings.start[number + 1])
        lat, lon = rings.lat[part], rings.lon[part]
        ring = np.stack([lon, lat], axis=1)
        if not shapely.is_ccw(shapely.linearrings(ring)):  # a lake
            continue
        for shift in (-360.0, 0.0, 360.0):
            if lon.max() + shift > box[0] and lon.min() + shift < box[2]:
                moved = shapely.polygons(ring + np.array([shift, 0.0]))
                yield shapely.clip_by_rect(moved, *box)


@dataclass(eq=False)
class _Search:
    """A* from the start to the goal by legs between corners and the ends of canals.

    Attributes
    ----------
    lat, lon : Of the nodes [deg]: start, goal, ends of canals, corners.
    frames : Their unit vectors up, east and north, (3, n, 3).
    first : Number of nodes that are no corners.
    rest : Lower bound of the length from each node to the goal [m].
    known : Longest length that counts [m].
    """

    corners: Corners
    links: Sequence[BarrierLink]
    speed: float
    lat: FloatArray
    lon: FloatArray
    frames: FloatArray
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
        frames = _frames(lat, lon)
        return cls(corners, links, reach.speed, lat, lon, frames, len(single), rest, known)

    def is_enclosed(self) -> bool:
        """Return whether the start, the goal or the end of a canal is inside a polygon."""
        single = self.lat[: self.first], self.lon[: self.first]
        return bool((point_status(self.corners.coast, *single) != OK).any())

    def run(self, until: float) -> float:
        """Return the least length, or a bound of it when time is up [m]; NaN if there is no way."""
        best = np.full(len(self.lat), math.inf)
        best[0] = 0.0
        done = np.zeros(len(self.lat), bool)
        queue = [(float(self.rest[0]), 0)]
        while queue:
            least, node = heapq.heappop(queue)
            if node == 1 or clock.perf_counter() > until:
                return least
            if done[node]:
                continue
            done[node] = True
            others, far = self._reached_from(node, best, done)
            best[others] = far
            for entry in zip((far + self.rest[others]).tolist(), others.tolist(), strict=True):
                heapq.heappush(queue, entry)
        return math.nan

    def _reached_from(
        self, node: int, best: FloatArray, done: BoolArray
    ) -> tuple[NDArray[np.int64], FloatArray]:
        """Return the nodes that are nearer by a free leg or a canal from one, and how far [m]."""
        up, east, north = self.frames
        rough = best[node] + SPHERE * np.arccos(np.clip(up @ up[node], -1.0, 1.0))
        some = np.flatnonzero(~done & (rough < best) & (rough + self.rest <= self.known))
        out = np.arctan2(up[some] @ east[node], up[some] @ north[node])
        into = np.arctan2(-(east[some] @ up[node]), -(north[some] @ up[node]))
        some = some[self._touches(np.full(len(some), node), out) & self._touches(some, into)]
        far = best[node] + distance(self.lat[node], self.lon[node], self.lat[some], self.lon[some])
        nearer = (far < best[some]) & (far + self.rest[some] <= self.known)
        some, far = some[nearer], far[nearer]
        free = self._are_free(node, some)
        some, far = some[free], far[free]
        if 2 <= node < self.first:
            other = node + 1 if node % 2 == 0 else node - 1
            passed = best[node] + self.links[(node - 2) // 2].seconds * self.speed
            if passed < min([best[other], *far[some == other]]):
                return np.append(some[some != other], other), np.append(far[some != other], passed)
        return some, far

    def _are_free(self, node: int, others: NDArray[np.int64]) -> BoolArray:
        """Return which legs from a node touch no polygon.

        The arcs that are tested are within 100 m of the geodesics, up to 14,000 km, and polygons of
        `Corners` are farther inside than that. Longer legs count as free.
        """
        count = len(others)
        ends = np.full(count, self.lat[node]), np.full(count, self.lon[node])
        code, unsure = np.empty(count, np.int8), np.empty(count, np.bool_)
        leg_codes(self.corners.coast, *ends, self.lat[others], self.lon[others], code, unsure)
        chord = np.linalg.norm(self.frames[0, others] - self.frames[0, node], axis=1)
        return np.asarray((code == OK) | (chord > _LONGEST_TESTED))

    def _touches(self, nodes: NDArray[np.int64], course: FloatArray) -> BoolArray:
        """Return where a course through a corner leaves its polygon on one side."""
        result = np.ones(len(nodes), bool)
        corner = np.flatnonzero(nodes >= self.first)
        at = nodes[corner] - self.first
        back, on = (
            (side[at] - course[corner] + math.pi) % (2.0 * math.pi) - math.pi
            for side in (self.corners.back, self.corners.on)
        )
        to_starboard = _is_starboard(back) & _is_starboard(on)
        result[corner] = to_starboard | (_is_starboard(-back) & _is_starboard(-on))
        return result


def _is_starboard(bearing: FloatArray) -> BoolArray:
    """Return which relative bearings [-pi, pi] are to starboard, ahead or astern, by a margin."""
    ahead_or_astern = np.abs(np.sin(bearing)) <= ANGLE_TOLERANCE
    return np.asarray((bearing >= 0.0) | ahead_or_astern)
