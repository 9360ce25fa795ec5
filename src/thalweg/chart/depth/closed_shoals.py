"""Shoal water that is closed: where the depth layer has metres less than a ship requires.

Between the points of the layer its depth is interpolated, so that a few metres of difference say
little; much less water than is required is there for certain. Named shoal areas close as a whole.
Channels of passages and the water round ports stay open, as the layer shows no dredged channels;
named areas stay closed round ports, too, where these are outside them and the ship can leave. Areas
of exact outline stay closed everywhere, and are closed to small ships as well: the other outlines
have the inshore ways of these inside.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import geojson_polygons
from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.depth.global_depth import global_depth_codes
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS, ShoalArea
from thalweg.chart.rings import disc_shape
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.kernels.geometry.cube_sphere import IndexArrays
from thalweg.kernels.geometry.shoal_excess import POINTS_OF_DEGREE

#: A position [deg] and the radius [m] of the open water round it.
OpenDisc: TypeAlias = tuple[float, float, float]
#: South, north, west and east [deg], east above west.
DegreeBox: TypeAlias = tuple[float, float, float, float]

WORLD_BOX: Final[DegreeBox] = (-90.0, 90.0, -180.0, 180.0)
CLOSED_SHOALS: Final = "closed shoals"  #: how plans and kinds of bounds name them
_MARGIN: Final = 2.0  # of the layer: less than required by so much, and by a share, is closed [m]
_SHARE: Final = 0.2
_SHARE_OF_AREAS: Final = 0.5  # of what is required: exact areas with less are closed
_CHANNEL: Final = 4.0 * NAUTICAL_MILE  # on both sides of a channel
_CHANNEL_IN_AREAS: Final = 1.5 * NAUTICAL_MILE  # ... where named areas are beside it
_LEAST_AREA: Final = 1e-4  # smaller shoals of the layer are left out [square degrees]
_TOLERANCE: Final = 0.005  # of the outlines [deg]
_DEGREE: Final = 60.0 * NAUTICAL_MILE
_TURNS: Final = (-360.0, 0.0, 360.0)


def closing_depth(required: float) -> float:
    """Return the depth of the layer below which water is closed [m], in tenths of a metre.

    Parameters
    ----------
    required : Depth that a ship requires [m].

    Returns
    -------
    float : 2 m less, and at least a fifth less; 0 where that is not above zero.
    """
    return round(max(min(required - _MARGIN, (1.0 - _SHARE) * required), 0.0), 1)


def closing_depth_of_areas(required: float) -> float:
    """Return the depth below which named shoal areas of exact outline are closed [m].

    Parameters
    ----------
    required : Depth that a ship requires [m].

    Returns
    -------
    float : That of the layer (`closing_depth`), and at least half of what is required.
    """
    return max(closing_depth(required), _SHARE_OF_AREAS * required)


@dataclass(frozen=True)
class ClosedShoals:
    """Shoal water that no leg may cross.

    Attributes
    ----------
    depth : Water with less than this by the layer, or in named areas, is closed [m].
    area_depth : Named areas of exact outline with less than this are closed as well [m].
    drying_areas : Whether areas that dry are closed where ``depth`` is zero, too.
    channels : tuple of tuple of (lat, lon)
        Lines within 4 nautical miles of which water is open, in named areas 1.5 [deg].
    discs : tuple of (lat, lon, radius)
        Discs in which shoal water of the layer is open [deg, m]; named areas with a centre inside
        are open as a whole.
    area_discs : tuple of (lat, lon, radius)
        Discs in which named areas are open, but for those of exact outline: these are closed beside
        channels, too.
    box : South, north, west and east [deg] of the shoals of the layer that count.
    """

    depth: float
    channels: tuple[tuple[Position, ...], ...] = field(default=(), repr=False)
    discs: tuple[OpenDisc, ...] = ()
    area_discs: tuple[OpenDisc, ...] = ()
    box: DegreeBox = WORLD_BOX
    area_depth: float = 0.0
    drying_areas: bool = False

    def closes(self, area: ShoalArea) -> bool:
        """Return whether a named area has less water than is closed."""
        if area.is_exact:
            return area.depth < self.depth_of_areas
        return area.depth < self.depth or (self.drying_areas and area.dries)

    @property
    def depth_of_areas(self) -> float:
        """Named areas of exact outline with less than this are closed [m]."""
        return max(self.depth, self.area_depth)

    @property
    def has_rough_areas(self) -> bool:
        """Whether named areas without an exact outline are closed in the box."""
        return any(
            self.closes(area) and not area.is_exact and _meets(area, self.box)
            for area in SHOAL_AREAS
        )

    @cached_property
    def shapes(self) -> tuple[Any, ...]:
        """The closed water as shapely polygons of longitude and latitude; they may overlap."""
        return _closed_shapes(self)

    def contains(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which positions [deg] are in closed water."""
        import shapely

        inside = np.zeros(np.shape(lat), np.bool_)
        whole = shapely.union_all(self.shapes)
        shapely.prepare(whole)
        for turn in _TURNS:
            inside |= shapely.contains_xy(whole, np.asarray(lon) + turn, np.asarray(lat))
        return inside

    def text(self) -> str:
        """Return everything as text, for a fingerprint."""
        water = self.channels, self.discs, self.area_discs, self.box, self.depth_of_areas
        open_water = hashlib.sha256(repr(water).encode()).hexdigest()[:16]
        drying = " drying" if self.drying_areas else ""
        return f"{CLOSED_SHOALS} {self.depth} {open_water}{drying}"


@lru_cache(maxsize=4)
def closed_water_index(closed: ClosedShoals, no_go: tuple[Any, ...], cells: int) -> IndexArrays:
    """Return the grid of the edges of closed shoals and no-go zones.

    The charts of one plan share it: those with land and those without.

    Parameters
    ----------
    closed : Closed shoals.
    no_go : Shapely polygons of the no-go zones.
    cells : Cells along a side of a face of the index.
    """
    rings = geojson_polygons.rings_from_polygons([*no_go, *closed.shapes])
    return build_index(rings, cells)


@lru_cache(maxsize=4)
def _closed_shapes(closed: ClosedShoals) -> tuple[Any, ...]:
    import shapely

    if closed.depth_of_areas <= 0.0 and not closed.drying_areas:
        return ()
    ends = np.array([disc[:2] for disc in closed.discs]).reshape(-1, 2)
    named = [
        area
        for area in SHOAL_AREAS
        if closed.closes(area) and not area.contains(*ends.T).any() and _meets(area, closed.box)
    ]
    areas = [area.polygon for area in named if not area.is_exact]
    layer = _outlines_of_layer(closed.depth, closed.box) if closed.depth > 0.0 else ()
    shapes = [np.array([area.polygon for area in named if area.is_exact], object)]
    for closed_here, reach, discs in (
        (layer, _CHANNEL, closed.discs),
        (areas, _CHANNEL_IN_AREAS, closed.area_discs),
    ):
        open_water = [disc_shape(*disc, quad_segs=6) for disc in discs]
        open_water += [_corridor(line, reach) for line in closed.channels]
        shapes += [_without(np.array(closed_here, object), open_water)]
    parts = shapely.get_parts(np.concatenate(shapes))
    return tuple(parts[shapely.area(parts) > _LEAST_AREA])


def _meets(area: ShoalArea, box: DegreeBox) -> bool:
    """Return whether the bounds of an area meet a box."""
    south, north, west, east = box
    left, bottom, right, top = area.polygon.bounds
    beside = any(left + turn <= east and right + turn >= west for turn in _TURNS)
    return beside and bottom <= north and top >= south


def _without(shapes: NDArray[np.object_], open_water: list[Any]) -> NDArray[np.object_]:
    """Return shapes without the parts that are in open water."""
    import shapely
    import shapely.affinity

    if not len(shapes):
        return shapes
    tree = shapely.STRtree(shapes)
    west, south, east, north = shapely.total_bounds(shapes)
    left, bottom, right, top = shapely.bounds(np.array(open_water, object)).reshape(-1, 4).T
    for turn in _TURNS:
        beside = (left + turn <= east) & (right + turn >= west)
        for number in np.flatnonzero(beside & (bottom <= north) & (top >= south)).tolist():
            there = shapely.affinity.translate(open_water[number], turn)
            cut = tree.query(there)
            shapes[cut] = shapely.difference(shapes[cut], there)
    return shapes


@lru_cache(maxsize=8)
def _outlines_of_layer(depth: float, box: DegreeBox) -> tuple[Any, ...]:
    """Return the water of the layer in a box that is shallower than a depth [m], as polygons."""
    import shapely
    from contourpy import contour_generator

    lat, lon, depths = _layer_inside(box)
    contours = contour_generator(
        lon, lat, np.ma.masked_invalid(depths), corner_mask=True, fill_type="OuterOffset"
    )
    shapes = [
        shapely.Polygon(points[: ends[1]], [points[a:b] for a, b in pairwise(ends[1:])])
        for points, ends in zip(*contours.filled(-1.0, depth))
    ]
    valid = shapely.make_valid(shapely.simplify(np.array(shapes, object), _TOLERANCE))
    parts = shapely.get_parts(shapely.get_parts(valid))
    areas = (shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & (
        shapely.area(parts) > _LEAST_AREA
    )
    return tuple(parts[areas])


def _layer_inside(box: DegreeBox) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return latitudes, longitudes [deg] and depths [m] of the layer in a box, or slightly more.

    Points on land beside water have the mean depth of that water.
    """
    from scipy.ndimage import uniform_filter

    code = global_depth_codes()
    south, north, west, east = (round(edge * POINTS_OF_DEGREE) for edge in box)
    row = np.arange(max(south - 1, -90 * POINTS_OF_DEGREE), min(north + 1, 90 * POINTS_OF_DEGREE))
    column = np.arange(west - 1, min(east + 1, west + 360 * POINTS_OF_DEGREE) + 1)
    part = code[row + 90 * POINTS_OF_DEGREE][:, (column + 180 * POINTS_OF_DEGREE) % code.shape[1]]
    water = part > 0
    depth = np.where(water, part - 1.0, 0.0).astype(np.float32)
    share = uniform_filter(water.astype(np.float32), 3, mode="nearest")
    mean = uniform_filter(depth, 3, mode="nearest") / np.maximum(share, 0.05)
    beside = share > 0.05  # a ninth of the points or more are water
    filled = np.where(water, depth, np.where(beside, mean, np.nan))
    return row / POINTS_OF_DEGREE, column / POINTS_OF_DEGREE, np.asarray(filled, float)


@lru_cache(maxsize=1024)
def _corridor(line: tuple[Position, ...], reach: float) -> Any:
    import shapely
    import shapely.affinity

    lat, lon = np.array(line, float).T
    lon = np.degrees(np.unwrap(np.radians(lon)))
    stretch = max(float(np.cos(np.radians(lat.mean()))), 0.01)
    wide = shapely.LineString(np.stack([lon * stretch, lat], axis=-1)).buffer(
        reach / _DEGREE, quad_segs=4
    )
    return shapely.affinity.scale(wide, 1.0 / stretch, 1.0, origin=(0.0, 0.0))
