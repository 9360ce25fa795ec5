"""The certificate of a passage: a lower bound of the time of every route in open water."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.geodesy import METRES_PER_DEGREE, direct, distance
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.kernels.leg.table_lookup import axes_needed
from thalweg.search.certificate.arrival_barrier import (
    BarrierTask,
    CheckedBarrier,
    cell_minimum,
    find_barrier,
    finer_factors,
    slope_direction,
)
from thalweg.search.certificate.barrier_mesh import BarrierMesh, ShipInBarrier, build_mesh
from thalweg.search.certificate.barrier_raster import RasterRequest, freeze_barrier_raster

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea

_FIRST_CELLS: Final = 120  # along the geodesic, on the first mesh
_FINE_CELLS: Final = 800  # of functions, for ships that weather does not slow down ...
_SECONDS_OF_FINE_CELLS: Final = 20.0  # ... and when there is this time; fewer with less
_MOST_NODES: Final = 4_000_000
_FIRST_ROUNDS: Final = 5, 14  # backwards and forwards
_LATER_ROUNDS: Final = 3, 6  # on finer meshes, which begin with the factors of a coarser one
_GROWTH: Final = 3.5  # of the time from one mesh to the next
_MARGIN: Final = 1.02
_STEPS_ROUND_ELLIPSE: Final = 73


@dataclass(frozen=True, eq=False)
class PassageToBound:
    """A passage whose time is bounded from below.

    Attributes
    ----------
    sea : Sea
    chart : Chart or None
        Land; None for open water.
    ship : ShipInBarrier
    channels : sequence of int
        Channels of the sea that count.
    start, goal : tuple of float
        (lat, lon) [deg].
    depart : float
        [s since 1970-01-01T00:00Z].
    known : float
        Time of a route that exists [s].
    """

    sea: Sea
    chart: Chart | None
    ship: ShipInBarrier
    channels: Sequence[int]
    start: tuple[float, float]
    goal: tuple[float, float]
    depart: float
    known: float


@dataclass(frozen=True, eq=False)
class TimeCertificate:
    """A lower bound of the time of a passage, with the barrier function that proves it.

    Attributes
    ----------
    value : float
        No route is faster [s].
    sampling : str
        How the sea of the proof differs from the data; "" where it does not.
    mesh : BarrierMesh
    barrier : CheckedBarrier
        The barrier: no ship reaches a position before its value there.
    task : BarrierTask
        What was checked.
    cells : int
        Cells of the mesh along the geodesic.
    seconds : float
        Time used [s].
    """

    value: float
    sampling: str
    mesh: BarrierMesh = field(repr=False)
    barrier: CheckedBarrier = field(repr=False)
    task: BarrierTask = field(repr=False)
    cells: int
    seconds: float


def certify_time(
    passage: PassageToBound, *, seconds: float, target: float = 0.005
) -> TimeCertificate | None:
    """Bound the time of every route of a passage from below.

    Parameters
    ----------
    passage : PassageToBound
    seconds : float
        Time that the search for a bound may take [s]. A mesh is completed once begun; the next
        finer one is left out when it would take longer than what is left.
    target : float
        Gap [fraction of the known time] at which the search ends.

    Returns
    -------
    TimeCertificate or None
        None where no certificate was found: near a pole, across more than half of the globe, or
        where a canal may shorten the way.
    """
    begin = clock.perf_counter()
    domain = _Domain.around(passage, seconds)
    if domain is None:
        return None
    length = float(distance(*passage.start, *passage.goal))
    refinement = max(1, math.ceil(_FIRST_CELLS * domain.cell_height / length))
    best: TimeCertificate | None = None
    level: _Level | None = None
    while True:
        started = clock.perf_counter()
        mesh = build_mesh(domain.raster, refinement, passage.ship, passage.chart)
        level = _Level.on(mesh, passage, domain.fastest, level)
        if _canal_in_band(passage.chart, mesh, level.band()):
            return None
        task, forward = level.certify(passage)
        if forward is not None and (best is None or forward.value > best.value):
            cells = round(length / domain.cell_height * refinement)
            seconds_used = clock.perf_counter() - begin
            best = TimeCertificate(
                forward.value, domain.sampling, mesh, forward, task, cells, seconds_used
            )
        used = clock.perf_counter() - started
        left = seconds - (clock.perf_counter() - begin)
        done = best is not None and best.value >= (1.0 - target) * passage.known
        nodes = 4 * mesh.lat.size * mesh.lon.size
        if done or nodes > _MOST_NODES or _GROWTH * used > left:
            return best
        refinement *= 2


@dataclass(frozen=True, eq=False)
class _Domain:
    """The raster of the sea round the routes that may be faster than the known one."""

    raster: RasterArrays
    sampling: str
    fastest: float

    @classmethod
    def around(cls, passage: PassageToBound, seconds: float) -> _Domain | None:
        fastest = passage.ship.top_speed
        for _ in range(6):
            box = _box_of_ellipse(passage, fastest * _MARGIN)
            if box is None:
                return None
            period = passage.depart, passage.depart + passage.known
            frozen = freeze_barrier_raster(
                RasterRequest(passage.sea, passage.channels, box, period, _cells(passage, seconds))
            )
            strongest = _strongest_current(frozen.arrays)
            if passage.ship.top_speed + strongest <= fastest * _MARGIN:
                top = passage.ship.top_speed + strongest
                return cls(frozen.arrays, frozen.sampling, top)
            fastest = passage.ship.top_speed + strongest
        return None

    @property
    def cell_height(self) -> float:
        """Height of a cell of the raster [m]."""
        return float(self.raster.corner[1]) * METRES_PER_DEGREE


@dataclass(eq=False)
class _Level:
    """Bounds of the times to and from each cell of one mesh, which its barriers improve."""

    mesh: BarrierMesh
    own: FloatArray
    other: FloatArray
    known: float
    factors: tuple[FloatArray | None, FloatArray | None] = (None, None)

    @classmethod
    def on(
        cls, mesh: BarrierMesh, passage: PassageToBound, fastest: float, coarser: _Level | None
    ) -> _Level:
        """Begin with bounds from the geodesic, or from a mesh with cells twice as large."""
        from_start = mesh.least_times(*passage.start, fastest)
        to_goal = mesh.least_times(*passage.goal, fastest)
        if coarser is None:
            return cls(mesh, from_start, to_goal, passage.known)
        backward, forward = (None if f is None else finer_factors(f) for f in coarser.factors)
        return cls(
            mesh,
            np.maximum(from_start, _halved_cells(coarser.own)),
            np.maximum(to_goal, _halved_cells(coarser.other)),
            passage.known,
            (backward, forward),
        )

    def band(self) -> BoolArray:
        """Return the cells that a faster route may touch."""
        return np.asarray(self.own + self.other < self.known)

    def certify(self, passage: PassageToBound) -> tuple[BarrierTask, CheckedBarrier | None]:
        """Find barriers from the goal and from the start; return the latter with its task."""
        backward_factor, forward_factor = self.factors
        rounds = _FIRST_ROUNDS if backward_factor is None else _LATER_ROUNDS
        backward = find_barrier(
            BarrierTask(
                self.mesh, passage.goal, passage.start, self.known, self.other, self.own, False,
                factor=backward_factor,
            ),
            rounds[0],
        )  # fmt: skip
        course = None
        if backward is not None and backward.complete:
            self.other = np.where(
                self.band(), np.maximum(self.other, _least_in_cells(backward)), self.other
            )
            course = slope_direction(self.mesh, backward.phi, *passage.start)
        task = BarrierTask(
            self.mesh, passage.start, passage.goal, self.known, self.own, self.other, True,
            course, forward_factor,
        )  # fmt: skip
        forward = find_barrier(task, rounds[1])
        if forward is not None and not forward.complete:
            forward = None
        if forward is not None:
            self.own = np.where(
                self.band(), np.maximum(self.own, _least_in_cells(forward)), self.own
            )
        self.factors = (
            None if backward is None else backward.factor,
            None if forward is None else forward.factor,
        )
        return task, forward


def _least_in_cells(barrier: CheckedBarrier) -> FloatArray:
    return np.minimum(cell_minimum(barrier.phi), barrier.centre)


def _halved_cells(values: FloatArray) -> FloatArray:
    return np.repeat(np.repeat(values, 2, axis=0), 2, axis=1)


def _cells(passage: PassageToBound, seconds: float) -> int:
    """Return the number of cells of the raster where the data are given by functions."""
    if axes_needed(passage.ship.table) != 0:
        return _FIRST_CELLS
    share = min(max(seconds / _SECONDS_OF_FINE_CELLS, 0.0), 1.0)
    return round(_FIRST_CELLS + share * (_FINE_CELLS - _FIRST_CELLS))


def _strongest_current(raster: RasterArrays) -> float:
    east, north = raster.channel_index[CURRENT_EAST], raster.channel_index[CURRENT_NORTH]
    if east < 0 or north < 0:
        return 0.0
    values = raster.values
    size = np.hypot(values[..., east], values[..., north])
    return float(np.nanmax(size, initial=0.0)) if np.isfinite(size).any() else 0.0


def _box_of_ellipse(
    passage: PassageToBound, speed: float
) -> tuple[float, float, float, float] | None:
    """Return a box round all positions from which start and goal are reached in the known time.

    None where it holds a pole or more than 350 degrees of longitude.
    """
    start, goal, total = passage.start, passage.goal, speed * passage.known
    length = float(distance(*start, *goal))
    total = max(total, length * (1.0 + 1e-6) + 1.0)
    if total > 1.8e7:
        return None
    # every such position is on a geodesic from the start, no farther than the ellipse that way
    courses = np.linspace(0.0, 2.0 * math.pi, _STEPS_ROUND_ELLIPSE)
    near, far = np.zeros(courses.size), np.full(courses.size, total)
    for _ in range(40):
        middle = 0.5 * (near + far)
        lat, lon = direct(start[0], start[1], courses, middle)[:2]
        inside = middle + np.asarray(distance(lat, lon, *goal)) < total
        near, far = np.where(inside, middle, near), np.where(inside, far, middle)
    lat, lon = direct(start[0], start[1], courses, far)[:2]
    turned = (np.asarray(lon) - start[1] + 180.0) % 360.0 - 180.0
    toward_goal = (goal[1] - start[1] + 180.0) % 360.0 - 180.0
    height = max(float(lat.max()), start[0], goal[0]) - min(float(lat.min()), start[0], goal[0])
    width = max(float(turned.max()), toward_goal, 0.0) - min(float(turned.min()), toward_goal, 0.0)
    margin = 0.04 * max(height, width) + 1e-3
    south = min(float(lat.min()), start[0], goal[0]) - margin
    north = max(float(lat.max()), start[0], goal[0]) + margin
    west = start[1] + min(float(turned.min()), toward_goal, 0.0) - margin
    east = start[1] + max(float(turned.max()), toward_goal, 0.0) + margin
    if south < -86.0 or north > 86.0 or east - west > 350.0:
        return None
    return south, north, west, east


def _canal_in_band(chart: Chart | None, mesh: BarrierMesh, band: BoolArray) -> bool:
    """Return whether a faster route may pass an open canal, which the barrier does not know."""
    if chart is None:
        return False
    for canal in chart.canals:
        ends = canal.path[0], canal.path[-1]
        if all(_inside(mesh, end) and band[mesh.cell_of(*end)] for end in ends):
            return True
    return False


def _inside(mesh: BarrierMesh, position: tuple[float, float]) -> bool:
    east = (position[1] - mesh.lon[0]) % 360.0 + mesh.lon[0]
    return bool(mesh.lat[0] <= position[0] <= mesh.lat[-1] and east <= mesh.lon[-1])
