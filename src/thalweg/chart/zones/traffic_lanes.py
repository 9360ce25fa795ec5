"""Traffic lanes: zones that ships sail in one direction only.

A lane is an area with a direction. Courses that differ from it by more than a tolerance are against
the lane: they cost more by a factor, or are forbidden. The default tolerance of 100 degrees leaves
ships free to cross a lane at right angles (Rule 10 (c) of the Collision Regulations, 1972).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.errors import InputError
from thalweg.core.geodesy import direct, inverse, wrap_longitude
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.types import BoolArray, FloatArray, Int32Array

#: Factor in searches for sailing against a lane where that is forbidden; the referee refuses it.
FORBIDDEN_FACTOR: Final = 1000.0
DEFAULT_TOLERANCE: Final = 100.0  # [deg]
_PIECE: Final = 20_000.0  # legs are split into straight lines of at most this [m]
_CELL: Final = 0.25  # side of a cell [deg]
_ROWS: Final = round(180.0 / _CELL)
_COLUMNS: Final = round(360.0 / _CELL)
_TURNS: Final = (-360.0, 0.0, 360.0)  # of longitude, with which areas are in the tree [deg]
_MOST_CORNERS: Final = 6  # of areas that are cut without a library
_FAR_ACROSS: Final = 120.0  # legs over more longitude than this [deg] may meet any lane
_ROUNDING: Final = 1e-6  # [deg]
_EDGE: Final = 0.1 / 60.0  # width of the strip along the edge of a lane [deg]
_MORE_COURSES: Final = 3.0  # beyond the tolerance of a lane [deg]


@dataclass(frozen=True, eq=False)
class TrafficLane:
    """A traffic lane.

    Attributes
    ----------
    shape : x longitude, y latitude [deg].
    direction : Direction of the traffic [deg], clockwise from north.
    tolerance : Courses that differ from it by more than this are against the lane [deg].
    factor : What a mile against the lane counts; inf: forbidden.
    crossing : Courses that differ from a right angle to it by no more than this cross the lane, and
        are not against it whatever the tolerance [deg].
    """

    name: str
    shape: Any
    direction: float
    tolerance: float = DEFAULT_TOLERANCE
    factor: float = np.inf
    crossing: float = 0.0

    @classmethod
    def of_feature(cls, shape: Any, properties: Mapping[str, Any]) -> TrafficLane:
        """Return the lane of an area with the properties of a GeoJSON feature.

        Raises
        ------
        InputError : If the direction, the tolerance or the factor is missing or not possible.
        """
        name = str(properties.get("name") or "lane")
        given = properties.get("factor")
        numbers = {
            "direction_deg": (to_number(properties.get("direction_deg")), 0.0, 360.0),
            "tolerance_deg": (
                to_number(properties.get("tolerance_deg", DEFAULT_TOLERANCE)), 1.0, 180.0
            ),
            "factor": (FORBIDDEN_FACTOR if given is None else to_number(given), 1.0, np.inf),
        }  # fmt: skip
        for key, (value, least, most) in numbers.items():
            if not (np.isfinite(value) and least <= value <= most):
                raise InputError(
                    f"The traffic lane {name[:60]!r} has the {key} "
                    f"{shortened_repr(properties.get(key))}.",
                    f"It is a number of at least {least:g}"
                    + (f" and at most {most:g}." if most < np.inf else "."),
                    f"Give the feature such a property {key}.",
                    value=properties.get(key),
                )
        direction, tolerance, factor = (value for value, *_ in numbers.values())
        return cls(name, shape, direction, tolerance, np.inf if given is None else factor)


@dataclass(frozen=True, eq=False)
class LaneMeetings:
    """Where legs run against lanes, in one direction or the other.

    Attributes
    ----------
    leg, lane : int64 array
        A leg and a lane that it meets.
    share : Share of the length of the leg that is inside the lane and against it, one way or back.
    there, back : bool array
        Whether the leg from its first end to its second, and back, is against the lane.
    """

    leg: NDArray[np.int64]
    lane: NDArray[np.int64]
    share: FloatArray
    there: BoolArray
    back: BoolArray


_NO_MEETINGS: Final = LaneMeetings(
    np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0), np.empty(0, bool), np.empty(0, bool)
)


@dataclass(frozen=True, eq=False)
class LaneGroup:
    """Lanes ready for legs: a tree of their areas on three turns of longitude.

    ``cells`` counts the cells that bounds of lanes touch, south and west of the corners of all
    cells on two turns of longitude: four of these numbers tell whether a box holds any.
    """

    lanes: tuple[TrafficLane, ...]
    tree: Any
    cells: Int32Array

    @classmethod
    def of(cls, lanes: Sequence[TrafficLane]) -> LaneGroup:
        """Prepare lanes."""
        import shapely.affinity

        shapes = [shapely.affinity.translate(lane.shape, turn) for lane in lanes for turn in _TURNS]
        shapely.prepare(shapes)
        return cls(tuple(lanes), shapely.STRtree(shapes), _cells_of_lanes(lanes))

    @cached_property
    def without_edges(self) -> LaneGroup:
        """The lanes less a strip along their edges, and with more courses along them.

        For what is stated of a route: least ways follow the edge of a lane, or cross it at the
        last course that is not against it, and the rounding and thinning of a file then puts them
        to one side or the other.
        """
        return LaneGroup.of(
            [
                replace(
                    lane,
                    shape=_inside_of(lane.shape),
                    tolerance=lane.tolerance + (_MORE_COURSES if lane.tolerance > 0.0 else 0.0),
                    crossing=lane.crossing + (_MORE_COURSES if lane.crossing > 0.0 else 0.0),
                )
                for lane in self.lanes
            ]
        )

    def shares_against(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """Return where legs [deg] run against lanes.

        Returns
        -------
        leg, lane : A leg and a lane that it is against.
        share : The share of the length of the leg that is inside the lane and against it.
        """
        met = self._meetings(lat1, lon1, lat2, lon2, back=False)
        return met.leg[met.there], met.lane[met.there], met.share[met.there]

    def excess(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> FloatArray:
        """Return for each leg [deg] by how much its factor exceeds 1."""
        met = self._meetings(lat1, lon1, lat2, lon2, back=False)
        return self._sum(met, met.there, len(lat1))

    def excess_both_ways(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the same for each leg [deg] and for the leg back."""
        met = self._meetings(lat1, lon1, lat2, lon2, back=True)
        count = len(lat1)
        return self._sum(met, met.there, count), self._sum(met, met.back, count)

    @cached_property
    def _rules(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Direction and tolerances of each lane [deg], and what a mile against it counts more.

        The tolerances are from its direction, and from a right angle to it; (L,), (2, L), (L,).
        """
        rules = [(one.direction, one.tolerance, one.crossing, one.factor) for one in self.lanes]
        direction, tolerance, crossing, factor = np.array(rules, float).reshape(-1, 4).T
        excess = np.minimum(factor, FORBIDDEN_FACTOR) - 1.0
        return direction, np.stack([tolerance, crossing]), excess

    def _sum(self, met: LaneMeetings, against: BoolArray, count: int) -> FloatArray:
        _, _, excess = self._rules
        share = met.share[against] * excess[met.lane[against]]
        return np.bincount(met.leg[against], share, minlength=count).astype(np.float64)

    def _meetings(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray, *, back: bool
    ) -> LaneMeetings:
        """Return where legs [deg] are against lanes; only there, unless ``back`` counts too."""
        import shapely

        near = np.flatnonzero(self._may_meet(lat1, lon1, lat2, lon2))
        if not near.size:
            return _NO_MEETINGS
        leg, pieces, ends = self._pieces(*(x[near] for x in (lat1, lon1, lat2, lon2)))
        y0, x0, y1, x1 = ends
        lines = shapely.linestrings(np.stack([np.stack([x0, y0], -1), np.stack([x1, y1], -1)], 1))
        which, zone = self.tree.query(lines)
        lane = zone // len(_TURNS)
        _, begin, end = inverse(y0, x0, y1, x1)
        there = self._is_against(begin[which], lane)
        turned = self._is_against(end[which] + np.pi, lane) & back
        against = np.flatnonzero(there | turned)
        share = self._shares_inside(zone[against], lines[which[against]])
        inside = share > 0.0
        share, against = share[inside], against[inside]
        leg = leg[which[against]]
        return LaneMeetings(
            near[leg], lane[against], share / pieces[leg], there[against], turned[against]
        )

    def _shares_inside(self, zone: NDArray[np.int64], lines: NDArray[Any]) -> FloatArray:
        """Return which share of the length of straight lines is inside areas of the tree."""
        import shapely

        begin, end = shapely.get_coordinates(lines).reshape(-1, 2, 2).swapaxes(0, 1)
        moves = (begin != end).any(axis=1)
        share = np.where(moves, _shares_in_convex(self._corners[zone], begin, end), 0.0)
        other = np.flatnonzero(np.isnan(share))
        part = shapely.intersection(lines[other], self.tree.geometries[zone[other]])
        share[other] = shapely.length(part) / shapely.length(lines[other])
        return share

    @cached_property
    def _corners(self) -> FloatArray:
        """Corners of the areas of the tree, counter-clockwise; NaN where one is not convex."""
        import shapely

        found = np.full((len(self.lanes), _MOST_CORNERS, 2), np.nan)
        for k, area in enumerate(lane.shape for lane in self.lanes):
            corners = shapely.get_coordinates(shapely.normalize(area))[::-1][:-1]
            x, y = (np.roll(corners, -1, axis=0) - corners).T
            left = (x * np.roll(y, -1) - y * np.roll(x, -1) >= 0.0).all()
            if area.geom_type == "Polygon" and len(corners) <= _MOST_CORNERS and left:
                found[k] = corners[np.minimum(np.arange(_MOST_CORNERS), len(corners) - 1)]
        turned = np.repeat(found, len(_TURNS), axis=0)
        turned[..., 0] += np.tile(_TURNS, len(found))[:, None]
        return turned

    def _pieces(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], tuple[FloatArray, ...]]:
        """Return the pieces of legs that may meet a lane.

        Returns
        -------
        leg : Leg of each piece.
        pieces : Number of pieces of each leg, near a lane or not.
        ends : Latitude and longitude of the beginning and the end of each piece [deg].
        """
        length, course, _ = inverse(lat1, lon1, lat2, lon2)
        pieces = np.maximum(np.ceil(length / _PIECE), 1.0).astype(np.int64)
        leg, number = numbered_parts(pieces + 1)
        y, x = direct(lat1[leg], lon1[leg], course[leg], number / pieces[leg] * length[leg])
        first = np.flatnonzero(number < pieces[leg])
        first = first[self._may_meet(y[first], x[first], y[first + 1], x[first + 1])]
        x1 = x[first] + wrap_longitude(x[first + 1] - x[first])
        return leg[first], pieces, (y[first], x[first], y[first + 1], x1)

    def _is_against(self, course: FloatArray, lane: NDArray[np.int64]) -> BoolArray:
        """Return which courses [rad] are against lanes."""
        direction, (tolerance, crossing), _ = self._rules
        off = np.abs((np.degrees(course) - direction[lane] + 180.0) % 360.0 - 180.0)
        return np.asarray((off > tolerance[lane]) & (np.abs(off - 90.0) >= crossing[lane]))

    def _may_meet(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> BoolArray:
        """Return which legs [deg] have boxes with a cell of a lane.

        A great circle over an angle d of longitude leaves the latitudes of its ends by at most
        arcsin(tan(d / 4)^2), which is below d^2 / 12 up to 120 degrees.
        """
        turn = wrap_longitude(lon2 - lon1)
        bulge = np.degrees(np.radians(turn) ** 2 / 12.0) + _ROUNDING
        south, north = np.minimum(lat1, lat2) - bulge, np.maximum(lat1, lat2) + bulge
        west = np.where(turn < 0.0, lon2, lon1) - _ROUNDING
        east = west + np.abs(turn) + 2.0 * _ROUNDING
        low, high = (np.clip(_cell(y + 90.0), 0, _ROWS - 1) for y in (south, north))
        left, right = _cell(west + 180.0), _cell(east + 180.0)
        left, right = left % _COLUMNS, left % _COLUMNS + right - left
        sums = self.cells
        count = sums[high + 1, right + 1] - sums[low, right + 1]
        count -= sums[high + 1, left] - sums[low, left]
        return np.asarray((count > 0) | (np.abs(turn) > _FAR_ACROSS))


def _inside_of(shape: Any) -> Any:
    """Return an area less the strip along its edge, or the area if that is all of it."""
    inside = shape.buffer(-_EDGE, join_style="mitre")
    return shape if inside.is_empty else inside


def _shares_in_convex(corners: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    """Return which share of straight lines (n, 2) is inside areas (n, corners, 2).

    Each side of an area cuts off what is to its right (Cyrus and Beck 1978, Computers and Graphics
    3(1), 23-28).
    """
    first, last = np.zeros(len(begin)), np.ones(len(begin))
    for k in range(corners.shape[1]):
        corner = corners[:, k]
        (ax, ay), (bx, by) = (begin - corner).T, (end - corner).T
        x, y = (corners[:, (k + 1) % corners.shape[1]] - corner).T
        a, b = x * ay - y * ax, x * by - y * bx
        at = a / np.where(a == b, 1.0, a - b)
        first = np.where((a < 0.0) & (b >= 0.0), np.maximum(first, at), first)
        last = np.where((a >= 0.0) & (b < 0.0), np.minimum(last, at), last)
        last = np.where((a < 0.0) & (b < 0.0), 0.0, last)
    share = np.maximum(last - first, 0.0)
    return np.where(np.isnan(corners[:, 0, 0]), np.nan, share)


def _cells_of_lanes(lanes: Sequence[TrafficLane]) -> Int32Array:
    """Return the sums of the cells that the bounds of lanes touch (see `LaneGroup`)."""
    found = np.zeros((_ROWS, _COLUMNS), np.int32)
    for lane in lanes:
        west, south, east, north = lane.shape.bounds
        low, high = (np.clip(_cell(y + 90.0), 0, _ROWS - 1) for y in (south, north))
        left = int(_cell(west + 180.0))
        across = np.arange(left, min(int(_cell(east + 180.0)) + 1, left + _COLUMNS))
        found[low : high + 1, across % _COLUMNS] = 1
    sums = np.zeros((_ROWS + 1, 2 * _COLUMNS + 1), np.int32)
    sums[1:, 1:] = np.cumsum(np.cumsum(np.tile(found, 2), axis=0), axis=1)
    return sums


def _cell(degrees: ArrayLike) -> NDArray[np.int64]:
    """Return in which cell positions are, from the south pole or the antimeridian [deg]."""
    return np.asarray(np.floor(np.asarray(degrees) / _CELL).astype(np.int64))
