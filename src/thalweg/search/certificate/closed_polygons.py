"""Polygons of the land and the closed zones within reach of a route, as the charts have them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.basemap import ring_bounds
from thalweg.chart.rings import Rings
from thalweg.core.types import BoolArray, FloatArray
from thalweg.search.certificate.positions_in_reach import Reach

if TYPE_CHECKING:
    from thalweg.chart import Chart

Box = tuple[float, float, float, float]  #: west, south, east, north [deg]

_FEW_CORNERS: Final = 16  # of rings that are used wherever their corners are
_CAP_STEP: Final = 2.0  # of the outline of a closed polar cap [deg]
_SHIFTS: Final = (-360.0, 0.0, 360.0)


@dataclass(frozen=True, eq=False)
class ClosedPolygons:
    """Outer rings of land and outlines of closed zones, copied by whole turns into a box.

    Attributes
    ----------
    box : West, south, east, north [deg]; longitudes are continuous from the west.
    bounds : West, south, east, north of each copy [deg], (n, 4).
    """

    box: Box
    bounds: FloatArray
    _rings: Rings
    _outlines: Sequence[Any]
    _caps: Sequence[Any]
    _number: NDArray[np.int64]
    _shift: FloatArray
    _made: dict[int, Any] = field(default_factory=dict)

    @classmethod
    def within_reach(
        cls, chart: Chart, reach: Reach, kept_out: Sequence[Any] = ()
    ) -> ClosedPolygons:
        """Return what is closed to a ship within reach.

        Parameters
        ----------
        chart : Its land and no-go zones, and the latitudes beyond its area, are closed.
        reach : Rings without a corner within reach are left out, except those with few corners.
        kept_out : Shapely polygons (x longitude, y latitude [deg]) that are closed too.
        """
        import shapely

        box, rings = reach.box(), chart.coastline.rings
        near = _rings_within(rings, reach)
        south, north, west, east = (bound[near] for bound in ring_bounds(rings))
        outlines = [
            polygon
            for polygon in shapely.get_parts(
                np.array([*chart.zones.closed_shapes, *kept_out], dtype=object)
            )
            if _is_within(polygon, reach)
        ]
        bounds = np.concatenate(
            [
                np.stack([west, south, east, north], axis=1),
                shapely.bounds(np.array(outlines, dtype=object)).reshape(-1, 4),
            ]
        )
        numbers = np.concatenate([near, -1 - np.arange(len(outlines))])
        copies = [bounds + np.array([by, 0.0, by, 0.0]) for by in _SHIFTS]
        kept = [_meet(copy, box) for copy in copies]
        caps = _polar_caps(chart, box)
        return cls(
            box,
            np.concatenate([copy[some] for copy, some in zip(copies, kept, strict=True)]),
            rings,
            outlines,
            caps,
            np.concatenate([numbers[some] for some in kept]),
            np.concatenate(
                [np.full(some.sum(), by) for by, some in zip(_SHIFTS, kept, strict=True)]
            ),
        )

    def inside(self, box: Box, least_size: float) -> list[Any]:
        """Return the closed polygons in a box, those that touch joined, without holes.

        Parameters
        ----------
        box : West, south, east, north [deg].
        least_size : Smaller ones are left out [deg].
        """
        import shapely

        found = [shapely.clip_by_rect(one, *box) for one in self.meeting(box, least_size)]
        found += [shapely.clip_by_rect(cap, *box) for cap in self._caps]
        shapes = np.array([one for one in found if not one.is_empty], dtype=object)
        whole = np.where(shapely.is_valid(shapes), shapes, shapely.make_valid(shapes))
        # one polygon of all that the data cut at meridians, canals and narrows; no water inside it
        parts = shapely.get_parts(shapely.get_parts(shapely.union_all(whole)))
        parts = parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]
        return list(shapely.polygons(shapely.get_exterior_ring(parts)))

    def meeting(self, box: Box, least_size: float) -> list[Any]:
        """Return the whole closed polygons that meet a box, from some size [deg] on."""
        west, south, east, north = self.bounds.T
        large = np.maximum(north - south, east - west) >= least_size
        some = [self._polygon(k) for k in np.flatnonzero(large & _meet(self.bounds, box)).tolist()]
        return [one for one in some if one is not None]

    def _polygon(self, which: int) -> Any:
        """Return one polygon; None for the ring of a lake."""
        if which not in self._made:
            self._made[which] = self._new_polygon(which)
        return self._made[which]

    def _new_polygon(self, which: int) -> Any:
        import shapely

        number, by = int(self._number[which]), np.array([self._shift[which], 0.0])
        if number < 0:
            outline = shapely.polygons(shapely.get_exterior_ring(self._outlines[-1 - number]))
            return shapely.transform(outline, lambda xy: xy + by)
        part = slice(self._rings.start[number], self._rings.start[number + 1])
        ring = np.stack([self._rings.lon[part], self._rings.lat[part]], axis=1)
        if not shapely.is_ccw(shapely.linearrings(ring)):
            return None
        return shapely.polygons(ring + by)


def _meet(bounds: FloatArray, box: Box) -> BoolArray:
    """Return which bounds (n, 4) meet a box."""
    west, south, east, north = bounds.T
    return np.asarray((west < box[2]) & (east > box[0]) & (south < box[3]) & (north > box[1]))


def _is_within(polygon: Any, reach: Reach) -> bool:
    """Return whether a polygon has a corner within reach, or few corners."""
    import shapely

    corners = shapely.get_coordinates(shapely.get_exterior_ring(polygon))
    return len(corners) <= _FEW_CORNERS or bool(reach.has(corners[:, 1], corners[:, 0]).any())


def _polar_caps(chart: Chart, box: Box) -> list[Any]:
    """Return the latitudes beyond the area of a chart as polygons."""
    import shapely

    south, north, _, _ = chart.area.array()
    across = np.arange(box[0], box[0] + 360.0 + _CAP_STEP, _CAP_STEP)
    lines = [
        [*((x, edge) for x in across), (across[-1], pole), (across[0], pole)]
        for edge, pole in ((south, -90.0), (north, 90.0))
        if abs(edge) < 89.0
    ]
    return [shapely.Polygon(line) for line in lines]


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
