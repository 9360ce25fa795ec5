"""The region of a lattice: an ellipse around start and goal, a box, or the globe."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS, Position
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.conformal_projection import (
    ConformalProjection,
    angle_to_point,
    conformal_unit_vectors,
    great_circle_projection,
)

Box: TypeAlias = tuple[float, float, float, float]

LARGEST_LATITUDE = 84.0  #: of a Mercator frame [deg]; nearer its poles lattices grow too fine
_LARGEST_ELLIPSE = 2.4  # [rad] sum of distances above which the whole globe is taken


@dataclass(frozen=True)
class Corridor:
    """Cells of a coarse lattice that candidate paths pass.

    Parameters
    ----------
    frame : Frame of the coarse lattice.
    step : Its spacing in units of the frame.
    cells : Which cells, (I, J); the first is centred at ``corner`` steps.
    corner : (int, int)
        Coordinates in steps of the first cell.
    """

    frame: ConformalProjection
    step: float
    cells: BoolArray
    corner: tuple[int, int]

    @classmethod
    def around(cls, frame: ConformalProjection, step: float, vectors: FloatArray) -> Corridor:
        """Return the cells of places, and two cells on every side of them."""
        i, j = _cells(frame, step, vectors)
        corner = (int(i.min()) - 2, int(j.min()) - 2)
        cells = np.zeros((int(i.max()) - corner[0] + 3, int(j.max()) - corner[1] + 3), bool)
        for di in range(-2, 3):
            for dj in range(-2, 3):
                cells[i - corner[0] + di, j - corner[1] + dj] = True
        return cls(frame, step, cells, corner)

    def contains(self, vectors: FloatArray) -> BoolArray:
        """Return which unit vectors lie in one of the cells."""
        i, j = _cells(self.frame, self.step, vectors)
        i, j = i - self.corner[0], j - self.corner[1]
        turn = round(2.0 * np.pi / self.frame.unit / self.step)
        i = np.where(i >= self.cells.shape[0], i - turn, np.where(i < 0, i + turn, i))
        inside = (i >= 0) & (i < self.cells.shape[0]) & (j >= 0) & (j < self.cells.shape[1])
        inside[inside] = self.cells[i[inside], j[inside]]
        return inside


def _cells(
    frame: ConformalProjection, step: float, vectors: FloatArray
) -> tuple[IntArray, IntArray]:
    x, y = frame.from_vectors(vectors)
    return np.rint(x / step).astype(np.int64), np.rint(y / step).astype(np.int64)


@dataclass(frozen=True)
class Region:
    """Places whose distances to start and goal add up to a limit, inside a box.

    Parameters
    ----------
    start, goal : (lat, lon)
        Positions [deg].
    limit : Largest sum of distances [m]; inf for no limit.
    area : (south, north, west, east), optional
        Box [deg] the nodes are confined to; east may be less than west or above 180.
    chart_area : (south, north, west, east), optional
        Box [deg] of the chart; only bounds the search for nodes, the chart itself tests them.
    corridor : Confines the region further.
    """

    start: Position
    goal: Position
    limit: float
    area: Box | None = None
    chart_area: Box | None = None
    corridor: Corridor | None = None

    @property
    def covers_globe(self) -> bool:
        """Whether the ellipse is so large that the whole globe is taken."""
        return self.limit / MEAN_RADIUS > _LARGEST_ELLIPSE

    @property
    def unbounded(self) -> bool:
        """Whether neither an ellipse nor a box bounds the region."""
        return self.covers_globe and self.area is None and self.chart_area is None

    @property
    def bounded(self) -> bool:
        """Whether an ellipse, a box or a corridor bounds the region."""
        return not self.unbounded or self.corridor is not None

    def slack(self, vectors: FloatArray) -> FloatArray:
        """Return by how much the path start-place-goal is shorter than the limit [m]."""
        total = angle_to_point(vectors, conformal_unit_vectors(*self.start)) + angle_to_point(
            vectors, conformal_unit_vectors(*self.goal)
        )
        return np.asarray(self.limit - total * MEAN_RADIUS)

    def contains(self, vectors: FloatArray) -> BoolArray:
        """Return which unit vectors (n, 3) lie inside the ellipse and the corridor."""
        inside = np.ones(len(vectors), bool)
        if not self.covers_globe:
            inside = np.asarray(self.slack(vectors) >= 0.0)
        if self.corridor is not None:
            inside[inside] = self.corridor.contains(vectors[inside])
        return inside

    def in_box(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return which positions [deg] lie in the box."""
        if self.area is None:
            return np.ones(len(lat), bool)
        south, north, west, east = self.area
        width = east - west if east > west else east - west + 360.0
        return (lat >= south) & (lat <= north) & ((lon - west) % 360.0 <= width)

    def bounds(self, frame: ConformalProjection) -> tuple[float, float, float, float]:
        """Return (least x, largest x, least y, largest y) of the region in a frame's units."""
        top = float(np.arcsinh(np.tan(np.radians(LARGEST_LATITUDE))))
        box = (-np.pi, np.pi, -top, top)
        if not self.covers_globe:
            box = _overlap(box, self._ellipse_bounds(frame))
        for area in (self.area, self.chart_area):
            if area is not None and ((area[3] - area[2]) % 360.0 or 360.0) <= _WIDEST_OUTLINE:
                box = _overlap(box, _outline_bounds(frame, _box_outline(area)))
        x0, x1, y0, y1 = box
        return (
            x0 / frame.unit, x1 / frame.unit,
            (y0 - frame.y0) / frame.unit, (y1 - frame.y0) / frame.unit,
        )  # fmt: skip

    def _ellipse_bounds(self, frame: ConformalProjection) -> Box:
        axis = great_circle_projection(self.start, self.goal, 1e9)  # its unit is the whole distance
        half = self.limit / MEAN_RADIUS / 2.0
        cos_b = np.cos(half) / max(np.cos(axis.unit / 2.0), 1e-9)
        y = float(np.arcsinh(np.tan(np.arccos(np.clip(cos_b, 0.02, 1.0)))))
        x0, x1 = axis.unit / 2.0 - half, axis.unit / 2.0 + half
        along, across = np.linspace(0, 1, 200), np.linspace(-y, y, 200)
        x = np.concatenate([x0 + (x1 - x0) * along, np.full(200, x1),
                            x1 - (x1 - x0) * along, np.full(200, x0)])  # fmt: skip
        ys = np.concatenate([np.full(200, -y), across, np.full(200, y), -across])
        return _outline_bounds(frame, axis.to_vectors(x / axis.unit, ys / axis.unit))


#: The outline of a wider box [deg] runs round the globe and does not bound it.
_WIDEST_OUTLINE = 180.0


def _outline_bounds(frame: ConformalProjection, vectors: FloatArray) -> Box:
    """Return bounds [rad] in a frame of a closed outline; open to the poles it goes round."""
    x, y = frame.from_vectors(vectors)
    x, y = np.unwrap(x * frame.unit), y * frame.unit + frame.y0
    if abs(x[-1] - x[0]) > np.pi:  # the outline goes right round a pole of the frame
        return (
            -np.pi,
            np.pi,
            (-np.inf if y.mean() < 0 else y.min()),
            np.inf if y.mean() > 0 else y.max(),
        )
    shift = 2.0 * np.pi * np.round((x.min() + x.max()) / 2.0 / (2.0 * np.pi))
    return x.min() - shift, x.max() - shift, y.min(), y.max()


def _box_outline(area: Box) -> FloatArray:
    south, north, west, east = area
    east = east + 360.0 if east < west else east
    south, north = max(south, -89.99), min(north, 89.99)
    part = np.linspace(0.0, 1.0, 200)
    lat = np.concatenate([np.full(200, south), south + (north - south) * part,
                          np.full(200, north), north - (north - south) * part])  # fmt: skip
    lon = np.concatenate([west + (east - west) * part, np.full(200, east),
                          east - (east - west) * part, np.full(200, west)])  # fmt: skip
    return conformal_unit_vectors(lat, lon)


def _overlap(first: Box, second: Box) -> Box:
    return (
        max(first[0], second[0]) if abs(first[0]) < np.pi else second[0],
        min(first[1], second[1]) if abs(first[1]) < np.pi else second[1],
        max(first[2], second[2]),
        min(first[3], second[3]),
    )
