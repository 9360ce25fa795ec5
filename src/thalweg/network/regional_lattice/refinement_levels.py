"""Lattice points by levels: coarse at sea, every level twice as fine nearer the coast.

All levels lie on one fine integer lattice: a point of a coarse level is a point of every finer
one, so levels join at the points they share and no hanging nodes arise.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS
from thalweg.core.types import BoolArray, FloatArray, Int32Array, IntArray
from thalweg.kernels.network.lattice_edges import LatticeRows
from thalweg.network.conformal_projection import (
    ConformalProjection,
    angle_to_point,
    conformal_positions,
    conformal_unit_vectors,
)
from thalweg.network.regional_lattice.region import Region

if TYPE_CHECKING:
    from thalweg.chart import Chart

COAST_WIDTH = 3.0  #: a level reaches this many of its spacings off the coast
_END_REACH = 24.0  # levels finer than the coast's reach this many spacings round start and goal
_POINTS_PER_BLOCK = 2_000_000
_CELLS_PER_POINT = 12  # cells examined per point of the budget
_FLOOD_STEPS = 48
_MAX_SHORE_DISTANCE = 250_000.0  # [m] the chart's own limit on shore distances
_MAX_MAP_CELLS = 300_000_000
Points: TypeAlias = tuple[IntArray, IntArray]


@dataclass(frozen=True)
class Level:
    """The points of one level in its own integer coordinates, sorted by row i, then column j.

    Parameters
    ----------
    step : Finest units between neighbouring points.
    i, j : Coordinates in steps.
    node : Node of each point.
    around : Steps right round the globe in a closed frame, else 0.
    """

    step: int
    i: IntArray
    j: IntArray
    node: Int32Array
    around: int = 0

    @property
    def rows(self) -> LatticeRows:
        """The points by row, as the kernels take them."""
        first, last = (int(self.i[0]), int(self.i[-1])) if len(self.i) else (0, 0)
        ptr = np.searchsorted(self.i, np.arange(first, last + 2)).astype(np.int64)
        return LatticeRows(first, ptr, self.j, self.around)

    def where(self, keep: BoolArray, new_node: IntArray) -> Level:
        """Return the level with only the selected nodes, renumbered."""
        own = keep[self.node]
        node = new_node[self.node[own]].astype(np.int32)
        return Level(self.step, self.i[own], self.j[own], node, self.around)


@dataclass(frozen=True)
class LatticeSpecification:
    """Region and resolution of a lattice.

    Parameters
    ----------
    chart : Land and shore distances.
    frame : Its unit is the finest spacing.
    region : Where points may lie.
    coast_levels, end_levels : Levels along all coasts, and further levels near start and goal only.
    budget, coast_budget : Most points of level 0, and of all finer levels together.
    may_stop : Whether coast levels beyond the budget are left out instead of refused.
    """

    chart: Chart
    frame: ConformalProjection
    region: Region
    coast_levels: int
    end_levels: int
    budget: int
    coast_budget: int
    may_stop: bool = False

    def step(self, level: int) -> int:
        """Return the finest units between neighbouring points of a level."""
        return int(2 ** (self.coast_levels + self.end_levels - level))

    def around(self, level: int) -> int:
        """Return the steps of a level right round the globe, 0 in an open frame."""
        return self.frame.around // self.step(level)


class TooManyPoints(Exception):
    """The lattice would exceed its budget of points (internal; the builder then coarsens)."""

    def __init__(self, level: int, count: int) -> None:
        self.level, self.count = level, count
        super().__init__(f"{count} points at level {level}")


def grow_levels(ground: LatticeSpecification) -> tuple[list[Level], FloatArray, FloatArray, int]:
    """Return all levels and the positions [deg] of their nodes, numbered along rows.

    When the ground says so the growth stops before the level that goes beyond the budget; the
    last value returned is then the number of points of the coasts it would have come to, else 0.

    Raises
    ------
    TooManyPoints : When the budget is exceeded.
    """
    i, j, shore = _open_sea(ground)
    points: list[Points] = [(i, j)]
    fine = 0
    for level in range(1, ground.coast_levels + ground.end_levels + 1):
        i, j, shore = _next_level(ground, level, i, j, shore)
        fine += len(i)
        if fine > ground.coast_budget:
            if level > 1 and ground.end_levels == 0 and ground.may_stop:
                return *_number(ground, points), fine
            raise TooManyPoints(level, fine)
        points.append((i, j))
    return *_number(ground, points), 0


def _open_sea(ground: LatticeSpecification) -> tuple[IntArray, IntArray, FloatArray]:
    """Return the points of level 0 on navigable water in the region, and their shore distance."""
    step = ground.step(0)
    x0, x1, y0, y1 = (value / step for value in ground.region.bounds(ground.frame))
    columns = np.arange(np.ceil(y0 - 1e-9), np.floor(y1 + 1e-9) + 1).astype(np.int64)
    first, last = int(np.ceil(x0 - 1e-9)), int(np.floor(x1 + 1e-9))
    around = ground.around(0)
    cells = len(columns) * max(0, last - first + 1)
    if cells > _CELLS_PER_POINT * ground.budget + _POINTS_PER_BLOCK:
        raise TooManyPoints(0, cells)
    if around and last - first + 1 > around:
        first, last = -(around // 2), -(around // 2) + around - 1
    block = max(1, _POINTS_PER_BLOCK // max(1, len(columns)))
    found = []
    count = 0
    for begin in range(first, last + 1, block):
        rows = np.arange(begin, min(begin + block, last + 1))
        i, j = np.repeat(rows, len(columns)), np.tile(columns, len(rows))
        ok, shore = _at_sea(ground, 0, i, j)
        found.append((i[ok], j[ok], shore))
        count += int(ok.sum())
        if count > ground.budget:
            raise TooManyPoints(0, count)
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    i, j, shore = (np.concatenate(part) for part in zip(*found))
    return i, j, shore


def _at_sea(
    ground: LatticeSpecification, level: int, i: IntArray, j: IntArray
) -> tuple[BoolArray, FloatArray]:
    """Return which points are on navigable water in the region; shore distance of those."""
    step = ground.step(level)
    vectors = ground.frame.to_vectors(i * step, j * step)
    ok = ground.region.contains(vectors)
    lat, lon = conformal_positions(vectors[ok])
    free = np.asarray(ground.chart.is_navigable(lat, lon)) & ground.region.in_box(lat, lon)
    ok[ok] = free
    if ground.coast_levels + ground.end_levels == 0:
        return ok, np.full(int(ok.sum()), np.inf)
    cap = min(COAST_WIDTH * step * float(ground.frame.largest_unit), _MAX_SHORE_DISTANCE)
    shore = ground.chart.sea_room(lat[free], lon[free], cap=cap)
    return ok, np.where(shore < 0.999 * cap, shore, np.inf)


def _next_level(
    ground: LatticeSpecification, level: int, i: IntArray, j: IntArray, shore: FloatArray
) -> tuple[IntArray, IntArray, FloatArray]:
    """Grow a level from the points of the coarser one that are near the coast, and the ends."""
    step = ground.step(level)
    spacing = ground.frame.metres(j * 2 * step) * step
    near = shore < (COAST_WIDTH + 1.5) * spacing
    seeds_i = [2 * i[near, None] + _AROUND_I]
    seeds_j = [2 * j[near, None] + _AROUND_J]
    for place in (ground.region.start, ground.region.goal):
        x, y = ground.frame.from_positions(*place)
        seeds_i.append(np.rint(x / step).astype(np.int64) + _AROUND_I[None])
        seeds_j.append(np.rint(y / step).astype(np.int64) + _AROUND_J[None])
    flat_i, flat_j = (np.concatenate([s.ravel() for s in part]) for part in (seeds_i, seeds_j))
    around = ground.around(level)
    if around:
        flat_i = (flat_i + around // 2) % around - around // 2

    def accept(ci: IntArray, cj: IntArray) -> tuple[BoolArray, FloatArray]:
        return _near_coast(ground, level, ci, cj)

    return _flood(accept, flat_i, flat_j, around, level, ground.coast_budget)


_AROUND_I = np.array([-1, -1, -1, 0, 0, 0, 1, 1, 1])
_AROUND_J = np.array([-1, 0, 1, -1, 0, 1, -1, 0, 1])


def _near_coast(
    ground: LatticeSpecification, level: int, i: IntArray, j: IntArray
) -> tuple[BoolArray, FloatArray]:
    """Return which points of a level are at sea and near enough to the coast."""
    step = ground.step(level)
    x, y = i * step, j * step
    ok, shore = _at_sea(ground, level, i, j)
    spacing = ground.frame.metres(y[ok]) * step
    near = shore < COAST_WIDTH * spacing
    if level > ground.coast_levels:
        vectors = ground.frame.to_vectors(x[ok], y[ok])
        ends = [conformal_unit_vectors(*p) for p in (ground.region.start, ground.region.goal)]
        nearest = (
            np.minimum(angle_to_point(vectors, ends[0]), angle_to_point(vectors, ends[1]))
            * MEAN_RADIUS
        )
        near &= nearest < _END_REACH * spacing
    ok[ok] = near
    return ok, shore[near]


def _flood(
    accept: Callable[[IntArray, IntArray], tuple[BoolArray, FloatArray]],
    i: IntArray, j: IntArray, around: int, level: int, budget: int,
) -> tuple[IntArray, IntArray, FloatArray]:  # fmt: skip
    """Return the accepted points among seeds and among neighbours of accepted points."""
    i0, j0 = int(i.min()) - _FLOOD_STEPS, int(j.min()) - _FLOOD_STEPS
    width = int(j.max()) + _FLOOD_STEPS - j0 + 1
    height = around or int(i.max()) + _FLOOD_STEPS - i0 + 1
    if width * height > _MAX_MAP_CELLS:
        raise TooManyPoints(level, width * height)
    seen = np.zeros(width * height, bool)
    flat = np.unique(((i - i0) % height) * width + j - j0)
    flooded: list[tuple[IntArray, FloatArray]] = []
    count = 0
    for _ in range(_FLOOD_STEPS):
        seen[flat] = True
        ok, shore = accept(_row(flat // width + i0, around), flat % width + j0)
        flat = flat[ok]
        flooded.append((flat, shore))
        count += len(flat)
        if len(flat) == 0 or count > budget:
            break
        row = flat[:, None] // width + _AROUND_I
        row = row % height if around else np.clip(row, 0, height - 1)
        flat = (row * width + np.clip(flat[:, None] % width + _AROUND_J, 0, width - 1)).ravel()
        flat = np.unique(flat[~seen[flat]])
    flat, shore = (np.concatenate(part) for part in zip(*flooded))
    row, column = _row(flat // width + i0, around), flat % width + j0
    order = np.lexsort((column, row))
    return row[order], column[order], shore[order]


def _row(i: IntArray, around: int) -> IntArray:
    return (i + around // 2) % around - around // 2 if around else i


def _number(
    ground: LatticeSpecification, points: list[Points]
) -> tuple[list[Level], FloatArray, FloatArray]:
    """Give every distinct point a node, in order of rows, and find its position."""
    steps = [ground.step(level) for level in range(len(points))]
    x = np.concatenate([i * step for (i, _), step in zip(points, steps)])
    y = np.concatenate([j * step for (_, j), step in zip(points, steps)])
    y_low = int(y.min()) if len(y) else 0
    width = (int(y.max()) - y_low + 1) if len(y) else 1
    keys, node = np.unique(x * width + (y - y_low), return_inverse=True)
    cuts = np.cumsum([len(i) for i, _ in points])[:-1]
    levels = [
        Level(step, i, j, part.astype(np.int32), ground.around(number))
        for number, (step, (i, j), part) in enumerate(zip(steps, points, np.split(node, cuts)))
    ]
    lat, lon = ground.frame.to_positions(keys // width, keys % width + y_low)
    return levels, lat, lon
