"""Traffic lanes: zones that ships sail in one direction only.

A lane is an area with a direction. Courses that differ from it by more than a tolerance are against
the lane: they cost more by a factor, or are forbidden. The default tolerance of 100 degrees leaves
ships free to cross a lane at right angles (Rule 10 (c) of the Collision Regulations, 1972).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.geojson_polygons import rings_from_polygons
from thalweg.core.errors import InputError
from thalweg.core.geodesy import direct, inverse, wrap_longitude
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.geometry.coast_index import outlines_touched
from thalweg.kernels.geometry.cube_sphere import IndexArrays

#: Factor in searches for sailing against a lane where that is forbidden; the referee refuses it.
FORBIDDEN_FACTOR: Final = 1000.0
DEFAULT_TOLERANCE: Final = 100.0  # [deg]
_PIECE: Final = 20_000.0  # legs are split into straight lines of at most this [m]
_INDEX_CELLS: Final = 128
_CELL: Final = 0.5  # [deg]; more than a piece in latitude
_REACH: Final = 2  # cells; more than a piece in longitude up to the latitude ``_POLAR``
_POLAR: Final = 79.0  # [deg]


@dataclass(frozen=True, eq=False)
class TrafficLane:
    """A traffic lane.

    Attributes
    ----------
    shape : x longitude, y latitude [deg].
    direction : Direction of the traffic [deg], clockwise from north.
    tolerance : Courses that differ from it by more than this are against the lane [deg].
    factor : What a mile against the lane counts; inf: forbidden.
    """

    name: str
    shape: Any
    direction: float
    tolerance: float = DEFAULT_TOLERANCE
    factor: float = np.inf

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
class LaneGroup:
    """Lanes ready for legs: a tree of their areas on three turns of longitude, and outlines.

    ``cells`` marks the cells of half a degree from which a piece of a leg can reach a lane.
    """

    lanes: tuple[TrafficLane, ...]
    tree: Any
    outlines: IndexArrays
    cells: BoolArray

    @classmethod
    def of(cls, lanes: Sequence[TrafficLane]) -> LaneGroup:
        """Prepare lanes."""
        import shapely.affinity

        shapes = [
            shapely.affinity.translate(lane.shape, turn)
            for lane in lanes
            for turn in (-360.0, 0.0, 360.0)
        ]
        shapely.prepare(shapes)
        parts = [part for lane in lanes for part in shapely.get_parts(lane.shape)]
        index = build_index(rings_from_polygons(parts), _INDEX_CELLS)
        return cls(tuple(lanes), shapely.STRtree(shapes), index, _cells_around(lanes))

    def shares_against(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """Return where legs [deg] run against lanes.

        Returns
        -------
        leg, lane : A leg and a lane that it is against.
        share : The share of the length of the leg that is inside the lane and against it.
        """
        import shapely

        near = np.flatnonzero(self._touched(lat1, lon1, lat2, lon2))
        if not near.size:
            none = np.empty(0, np.int64)
            return none, none, np.empty(0)
        ends = [x[near] for x in (lat1, lon1, lat2, lon2)]
        length, course, _ = inverse(*ends)
        pieces = np.maximum(np.ceil(length / _PIECE), 1.0).astype(np.int64)
        leg = np.repeat(np.arange(len(near)), pieces + 1)
        number = np.arange(len(leg)) - np.repeat(np.cumsum(pieces + 1) - pieces - 1, pieces + 1)
        y, x = direct(ends[0][leg], ends[1][leg], course[leg], number / pieces[leg] * length[leg])
        reach = self._within_reach(y, x)
        first = np.flatnonzero((number < pieces[leg]) & (reach | np.roll(reach, -1)))
        of, y0, x0, y1, x1 = leg[first], y[first], x[first], y[first + 1], x[first + 1]
        x1 = x0 + wrap_longitude(x1 - x0)
        lines = shapely.linestrings(np.stack([np.stack([x0, y0], -1), np.stack([x1, y1], -1)], 1))
        which, zone = self.tree.query(lines, predicate="intersects")
        _, heading, _ = inverse(y0[which], x0[which], y1[which], x1[which])
        lane = zone // 3
        off = np.array([one.direction for one in self.lanes])[lane]
        off = np.abs((np.degrees(heading) - off + 180.0) % 360.0 - 180.0)
        against = off > np.array([one.tolerance for one in self.lanes])[lane]
        which, zone, lane = which[against], zone[against], lane[against]
        whole = shapely.length(lines[which])
        part = shapely.length(shapely.intersection(lines[which], self.tree.geometries[zone]))
        share = np.where(whole > 0.0, part / np.where(whole > 0.0, whole, 1.0), 0.0)
        return near[of[which]], lane, share / pieces[of[which]]

    def excess(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> FloatArray:
        """Return for each leg [deg] by how much its factor exceeds 1."""
        leg, lane, share = self.shares_against(lat1, lon1, lat2, lon2)
        factors = np.minimum([one.factor for one in self.lanes], FORBIDDEN_FACTOR)
        more = np.bincount(leg, share * (factors[lane] - 1.0), minlength=len(lat1))
        return more.astype(np.float64)

    def _touched(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> BoolArray:
        """Return which legs may be partly inside a lane."""
        import shapely

        touched = np.empty(len(lat1), np.bool_)
        legs = [np.require(x, float, ("C", "W")) for x in (lat1, lon1, lat2, lon2)]
        outlines_touched(self.outlines, *legs, touched)
        beside = np.flatnonzero(self._within_reach(lat1, lon1) & ~touched)
        points = shapely.points(lon1[beside], lat1[beside])
        inside, _ = self.tree.query(points, predicate="intersects")
        touched[beside[inside]] = True
        return touched

    def _within_reach(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return from which positions [deg] a piece of a leg can reach a lane."""
        rows, columns = _cells_of(lat, lon)
        found = self.cells[np.clip(rows, 0, len(self.cells) - 1), columns % self.cells.shape[1]]
        return np.asarray(found | (np.abs(lat) > _POLAR))


def _cells_around(lanes: Sequence[TrafficLane]) -> BoolArray:
    """Return the cells within the length of a piece of the bounds of lanes."""
    rows, columns = round(180.0 / _CELL), round(360.0 / _CELL)
    found = np.zeros((rows, columns), np.bool_)
    for lane in lanes:
        west, south, east, north = lane.shape.bounds
        low, left = _cells_of(south, west)
        high, right = _cells_of(north, east)
        across = np.arange(left - _REACH, min(right + _REACH + 1, left - _REACH + columns))
        found[max(low - 1, 0) : high + 2, across % columns] = True
    return found


def _cells_of(lat: ArrayLike, lon: ArrayLike) -> tuple[Any, Any]:
    """Return row and column of positions [deg]; columns go on beyond a turn.

    An unknown position gets any cell: what is computed with it stays NaN.
    """
    rows = np.floor((np.nan_to_num(lat) + 90.0) / _CELL)
    columns = np.floor((np.nan_to_num(lon) + 180.0) / _CELL)
    return rows.astype(np.int64), columns.astype(np.int64)
