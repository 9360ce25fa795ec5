"""Outlines inside the land that are finer where the shortest way round them crosses land."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.search.certificate.closed_polygons import Box, ClosedPolygons
from thalweg.search.certificate.land_corners import inner_polygons, land_inside, shortened_edges

FINER: Final = 0.25  #: factor of the tolerance from one level to the next
FINEST: Final = 2  #: how often it is applied
_TILE: Final = 20.0  # side of a tile [first tolerances]
_LEAST_SIZE: Final = 4.0  # of polygons that count [tolerances]
_MARGIN: Final = 8.0  # round a tile, in which polygons are simplified with it [tolerances] ...
_BEYOND: Final = 4.0  # ... and used, as outlines of tiles side by side differ a little

Tile = tuple[int, int]  #: column and row
_Pieces = tuple[list[Any], list[Any]]


@dataclass(eq=False)
class LocalOutlines:
    """Polygons inside what is closed, with a tolerance that is smaller in some tiles.

    The shortest way round them is no longer than one round what is closed, and touches no inner
    polygon: these are half a tolerance inside of their own level, and half of the first tolerance
    from edges of coarser levels and from tiles that are coarser. See ``docs/explanation/proof.md``.

    Attributes
    ----------
    closed : What is closed.
    tolerance : First tolerance [deg].
    levels : How often the tolerance is refined in tiles.
    """

    closed: ClosedPolygons
    tolerance: float
    levels: dict[Tile, int] = field(default_factory=dict)
    _pieces: dict[tuple[Tile, int], _Pieces] = field(default_factory=dict)
    _first: _Pieces = field(init=False)
    land: list[Any] = field(init=False)  #: closed polygons of the first tolerance

    def __post_init__(self) -> None:
        self.land = self.closed.inside(self.closed.box, _LEAST_SIZE * self.tolerance)
        shapes = land_inside(self.land, self.tolerance)
        self._first = shapes, inner_polygons(shapes, self.tolerance)

    @property
    def finest(self) -> float:
        """The tolerance of the finest level [deg]."""
        return self.tolerance * FINER**FINEST

    def outlines(self) -> _Pieces:
        """Return polygons inside what is closed, and smaller ones inside these.

        Returns
        -------
        shapes : Polygons at whose corners ways may turn.
        inner : Polygons that no shortest way touches; they may overlap.
        """
        import shapely

        whole, found = shapely.union_all(self._first[0]), [*self._first[1]]
        for level in range(1, FINEST + 1):
            tiles = [tile for tile, reached in self.levels.items() if reached >= level]
            if not tiles:
                break
            fine, inner = ([*chain.from_iterable(some)] for some in zip(
                *(self._of_tile(tile, level) for tile in tiles), strict=True))  # fmt: skip
            boxes = shapely.union_all([shapely.box(*self._box(tile)) for tile in tiles])
            cover = shapely.union_all(fine)
            edges = shapely.intersection(shapely.boundary(whole), boxes)
            bare = shapely.difference(edges, cover).buffer(0.5 * self.tolerance)
            kept = shapely.buffer(boxes, -0.5 * self.tolerance, join_style="mitre")
            kept = shapely.difference(kept, bare)
            found += _polygons(shapely.intersection(np.array(inner, object), kept))
            whole = shapely.union(whole, cover)
        return list(_polygons(whole)), found

    def refine(self, places: FloatArray, beside: int = 0) -> bool:
        """Refine the tiles that hold places; return whether there was one to refine.

        Parameters
        ----------
        places : (lat, lon) [deg], (2, n).
        beside : How many tiles to each side are as fine.
        """
        west = self.closed.box[0]
        side = _TILE * self.tolerance
        columns = np.floor(((places[1] - west) % 360.0) / side).astype(int)
        rows = np.floor((places[0] + 90.0) / side).astype(int)
        refined = False
        steps = range(-beside, beside + 1)
        for column, row in sorted(set(zip(columns.tolist(), rows.tolist(), strict=True))):
            level = min(self.levels.get((column, row), 0) + 1, FINEST)
            for tile in ((column + x, row + y) for x in steps for y in steps):
                if self.levels.get(tile, 0) < level:
                    self.levels[tile] = level
                    refined = True
        return refined

    def closed_positions(self, lat: FloatArray, lon: FloatArray) -> Any:
        """Return which positions [deg] are in closed polygons that a finer level may have."""
        import shapely

        lon = self.closed.box[0] + (lon - self.closed.box[0]) % 360.0
        inside = np.zeros(len(lat), bool)
        around = float(lon.min()), float(lat.min()), float(lon.max()), float(lat.max())
        for polygon in self.closed.meeting(around, _LEAST_SIZE * self.finest):
            shapely.prepare(polygon)
            west, south, east, north = polygon.bounds
            some = (lon >= west) & (lon <= east) & (lat >= south) & (lat <= north) & ~inside
            inside[some] = shapely.contains_xy(polygon, lon[some], lat[some])
        return inside

    def _of_tile(self, tile: Tile, level: int) -> _Pieces:
        if (tile, level) not in self._pieces:
            self._pieces[tile, level] = self._new_pieces(tile, level)
        return self._pieces[tile, level]

    def _new_pieces(self, tile: Tile, level: int) -> _Pieces:
        """Return the polygons of a tile and a little beyond, and the inner ones in the tile."""
        import shapely

        tolerance = self.tolerance * FINER**level
        box = shapely.box(*self._box(tile))
        west, south, east, north = box.buffer(_MARGIN * tolerance).bounds
        closed = self.closed.inside((west, south, east, north), _LEAST_SIZE * tolerance)
        shapes = land_inside(closed, tolerance)
        wider = box.buffer(_BEYOND * tolerance, join_style="mitre")
        outer = _polygons(shapely.intersection(np.array(shapes, object), wider))
        inner = shapely.intersection(np.array(inner_polygons(shapes, tolerance), object), box)
        return shortened_edges(list(outer), tolerance), list(_polygons(inner))

    def _box(self, tile: Tile) -> Box:
        side = _TILE * self.tolerance
        west, south = self.closed.box[0] + tile[0] * side, tile[1] * side - 90.0
        return west, south, west + side, south + side


def _polygons(shapes: Any) -> Iterator[Any]:
    """Yield the polygons of shapes."""
    import shapely

    parts = shapely.get_parts(shapely.get_parts(shapes))
    some = shapely.get_type_id(parts) == shapely.GeometryType.POLYGON
    yield from (one for one in parts[some] if not one.is_empty)
