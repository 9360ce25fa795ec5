"""The certificate of a stretch: a lower bound of the time of every route in open water."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.leg.table_lookup import axes_needed
from thalweg.search.certificate.arrival_barrier import (
    BarrierTask,
    CheckedBarrier,
    cell_minimum,
    find_barrier,
    finer_factors,
)
from thalweg.search.certificate.barrier_check_cost import USUAL_SECONDS_A_CELL, seconds_a_cell
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import (
    BarrierLink,
    BarrierMesh,
    build_mesh,
    slope_direction,
)
from thalweg.search.certificate.barrier_raster import is_calm, is_uniform
from thalweg.search.certificate.length_round_land import length_round_land
from thalweg.search.search_problem import ROUNDING_FACTOR

_EMPTY_CELL: Final = 0.3  # of the time of a cell, for one of which the data know nothing
_FIRST_CELLS: Final = 60  # cells of the first mesh along the geodesic
_FEWEST_CELLS: Final = 24  # cells of the first mesh along the geodesic where there is little time
#: Cells along the longer side of the raster, at least, for a sea that is given by functions.
_FEWEST_SAMPLES: Final = 120
#: Cells along the longer side of the raster for a sea of functions, for the strongest current of
#: the bound of the geodesic.
_CELLS_OF_GEODESIC: Final = 400
_CONTRADICTION: Final = 2e-3  # a barrier above the known time by more than this share is refused
#: Cells along the longer side of the raster for a sea of functions, without and with tables of
#: weather, if the search may take `_SECONDS_OF_FINE_CELLS` [s] or more; fewer with less time.
_FINE_CELLS: Final = 800, 240
_SECONDS_OF_FINE_CELLS: Final = 20.0
_MOST_NODES: Final = 4_000_000  # of a mesh
_MUCH_SLOWER: Final = 2.0  # a check than for most ships: the raster of functions is coarser
_FIRST_ROUNDS: Final = 3, 6  # rounds on the first mesh, backwards and forwards
#: Rounds backwards and forwards on finer meshes, which begin with the factors of a coarser one.
_LATER_ROUNDS: Final = 2, 5
#: In calm water the least length round land is the time: only meshes finer than those of so much
#: time [s], which know the zones that ships keep out of, are better.
_LEAST_IN_CALM: Final = 10.0
_SHARE_OF_LENGTH: Final = 0.4  # of the time for a bound, for the least length, in weather
_GROWTH: Final = 3.5  # of the time from one mesh to the next


@dataclass(frozen=True, eq=False)
class TimeCertificate:
    """A lower bound of the time of a stretch, with the barrier function that proves it.

    Attributes
    ----------
    value : No route is faster [s].
    sampling : How the sea of the proof differs from the data; "" where it does not.
    cells : Cells of the mesh along the geodesic; 0 for the bound of the least length at the
        greatest speed over ground, which has no mesh, barrier and task.
    seconds : Time used [s].
    reached : Value of the barrier at the goal [s]. Where it is clearly above the known time the sea
        of the proof is not the one of the known route.
    barrier : The barrier: no ship reaches a position before its value there.
    task : What was checked.
    round_land : Whether it is the bound of the least length round land (`length_round_land`).
    """

    value: float
    sampling: str
    cells: int
    seconds: float
    reached: float
    mesh: BarrierMesh | None = field(default=None, repr=False)
    barrier: CheckedBarrier | None = field(default=None, repr=False)
    task: BarrierTask | None = field(default=None, repr=False)
    round_land: bool = False


def certify_time(
    stretch: StretchToBound, *, seconds: float, target: float = 0.005
) -> TimeCertificate:
    """Bound the time of every route of a stretch from below.

    Parameters
    ----------
    seconds : Time that the search for a bound may take [s]; 0 for that of the geodesic alone. A
        mesh is completed once begun; the next finer one is left out when it would take longer than
        what is left.
    target : Gap [fraction of the known time] at which the search ends.

    Returns
    -------
    TimeCertificate
        The largest bound found; that of the least length near a pole and across half of the globe.
    """
    began, rate = clock.perf_counter(), usual_rate(stretch)
    cells = _cells(stretch, seconds, rate)
    domain = BarrierDomain.around(stretch, cells)
    if domain is None:
        globe = BarrierDomain.of_globe(stretch, _CELLS_OF_GEODESIC)
        return free_space_time(stretch, globe, seconds=seconds)
    if seconds > 0.0:
        rate = seconds_a_cell(stretch, domain)
    if rate > _MUCH_SLOWER * usual_rate(stretch):
        cells = _cells(stretch, seconds, rate)
        domain = BarrierDomain.around(stretch, cells) or domain
    finer = None
    if domain.sampling and domain.has_cells(cells):
        finer = BarrierDomain.around(stretch, _CELLS_OF_GEODESIC, fastest=domain.fastest)
    best = free_space_time(stretch, finer or domain, seconds=seconds)
    if seconds <= 0.0:
        return best
    left = seconds - (clock.perf_counter() - began)
    if best.round_land and left < _LEAST_IN_CALM and is_calm(stretch.sea):
        return best
    search = BarrierSearch(stretch, domain, first_cells(seconds, rate), rate)
    return _raised_by_barriers(best, search, left, target)


def certify_priced_length(
    stretch: StretchToBound, price: float, *, seconds: float, target: float = 0.005
) -> TimeCertificate | None:
    """Bound the length of every route from below, with dearer metres inside the control areas.

    Parameters
    ----------
    stretch : Of a ship of 1 m/s in still water; its ``known`` is the priced length of a route [m].
    price : What a metre inside the control areas of the chart counts, 1 or more; others count 1.
    seconds, target : As for `certify_time`.

    Returns
    -------
    TimeCertificate or None : None near a pole and across half of the globe.

    Notes
    -----
    The priced length is the time of a ship that is slower inside the areas by that price.
    """
    began = clock.perf_counter()
    ship = replace(stretch.ship, speed_field=_one_metre_a_second)
    stretch = replace(stretch, ship=ship)
    rate = usual_rate(stretch)
    domain = BarrierDomain.around(stretch, _cells(stretch, seconds, rate))
    if domain is None:
        return None
    best = free_space_time(stretch, domain)
    if stretch.chart is not None:
        domain = domain.slower_inside(stretch.chart.zones, 1.0 / price)
    left = seconds - (clock.perf_counter() - began)
    search = BarrierSearch(stretch, domain, first_cells(seconds, rate), rate)
    return _raised_by_barriers(best, search, left, target)


def _one_metre_a_second(
    _sampled: Mapping[str, ArrayLike], _time: ArrayLike, lat: ArrayLike, _lon: ArrayLike
) -> FloatArray:
    return np.ones(np.shape(lat))


def _raised_by_barriers(
    best: TimeCertificate, search: BarrierSearch, seconds: float, target: float
) -> TimeCertificate:
    """Return the best bound of meshes that are finer and finer, for some time [s]."""
    stretch, began, left = search.stretch, clock.perf_counter(), seconds
    enough = (1.0 - target) * stretch.known
    while best.value < enough and search.expected_seconds <= left:
        found = search.refine()
        if found is not None and found.reached > (1.0 + _CONTRADICTION) * stretch.known:
            break  # the sea of the proof is not that of the known route
        if found is not None and found.value > best.value:
            best = found
        left = seconds - (clock.perf_counter() - began)
    return best


def free_space_time(
    stretch: StretchToBound, domain: BarrierDomain, *, seconds: float = 0.0
) -> TimeCertificate:
    """Return the bound of the least length at the greatest speed over ground in a domain.

    Parameters
    ----------
    seconds : Time for a bound [s], of which the least length round land may take all in a sea that
        is the same everywhere, and a part in others; 0 for that of the geodesic.
    """
    seconds *= 1.0 if is_uniform(stretch.sea) else _SHARE_OF_LENGTH
    began, fastest = clock.perf_counter(), domain.fastest
    value = geodesic = ROUNDING_FACTOR * stretch.length / fastest
    chart = stretch.chart
    if chart is not None and seconds > 0.0:
        links = [BarrierLink(*canal.ends, canal.transit_time) for canal in chart.canals]
        length = length_round_land(
            chart, stretch.start, stretch.goal, stretch.known * fastest,
            links=links, speed=fastest, kept_out=stretch.kept_out, seconds=seconds,
        )  # fmt: skip
        value = max(value, length / fastest)
    used, by_land = clock.perf_counter() - began, value > geodesic
    return TimeCertificate(
        min(value, stretch.known), domain.sampling, 0, used, value, round_land=by_land
    )


@dataclass(eq=False)
class BarrierSearch:
    """The search for barriers of one stretch on finer and finer meshes.

    Attributes
    ----------
    cells : Cells of the first mesh along the geodesic, at least.
    rate : Time that the first mesh takes for each of its cells [s] (`seconds_a_cell`).
    expected_seconds : Estimate of the time that the next mesh takes; infinite when there is none.
    """

    stretch: StretchToBound
    domain: BarrierDomain
    cells: int
    rate: float
    expected_seconds: float = field(init=False)
    _refinement: int = field(init=False)
    _level: _Level | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        wanted = self.cells * self.domain.cell_height / self.stretch.length
        self._refinement = max(1, math.ceil(wanted))
        known = np.isfinite(self.domain.raster.values).all(axis=3).any(axis=0)
        counted = known.size * (_EMPTY_CELL + (1.0 - _EMPTY_CELL) * float(known.mean()))
        self.expected_seconds = self.rate * counted * self._refinement**2

    def refine(self) -> TimeCertificate | None:
        """Return the bound of the next mesh; None where no barrier passed the check."""
        stretch, domain, began = self.stretch, self.domain, clock.perf_counter()
        mesh = build_mesh(
            domain.raster, self._refinement, domain.ship, stretch.chart,
            departures=stretch.departures, by_steps=bool(domain.sampling),
            kept_out=stretch.kept_out, margins=domain.margins,
        )  # fmt: skip
        self._level = _Level.on(mesh, stretch, domain.fastest, self._level)
        task, barrier = self._level.certify(stretch)
        used = clock.perf_counter() - began
        cells = round(stretch.length / domain.cell_height * self._refinement)
        too_large = 4 * mesh.lat.size * mesh.lon.size > _MOST_NODES
        self.expected_seconds = math.inf if too_large else _GROWTH * used
        self._refinement *= 2
        if barrier is None:
            return None
        value = min(barrier.value, stretch.known)
        return TimeCertificate(
            value, domain.sampling, cells, used, barrier.value, mesh, barrier, task
        )


@dataclass(eq=False)
class _Level:
    """Bounds of the times to and from each cell of one mesh, which its barriers improve.

    Attributes
    ----------
    from_start : Lower bound of the time from the start to a cell [s], (rows, columns).
    to_goal : Lower bound of the time from a cell to the goal [s], (rows, columns).
    known : Time of the known route [s].
    before : Barriers from the goal and from the start on cells twice as large; None for none.
    """

    mesh: BarrierMesh
    from_start: FloatArray
    to_goal: FloatArray
    known: float
    before: tuple[CheckedBarrier | None, CheckedBarrier | None] = (None, None)

    @classmethod
    def on(
        cls, mesh: BarrierMesh, stretch: StretchToBound, fastest: float, coarser: _Level | None
    ) -> _Level:
        """Begin with bounds from the geodesic, or from a mesh with cells twice as large."""
        from_start = mesh.least_times(*stretch.start, fastest)
        to_goal = mesh.least_times(*stretch.goal, fastest)
        if coarser is None:
            return cls(mesh, from_start, to_goal, stretch.known)
        return cls(
            mesh,
            np.maximum(from_start, _halved_cells(coarser.from_start)),
            np.maximum(to_goal, _halved_cells(coarser.to_goal)),
            stretch.known,
            coarser.before,
        )

    def band(self) -> BoolArray:
        """Return the cells that a faster route may touch."""
        return np.asarray(self.from_start + self.to_goal < self.known)

    def certify(self, stretch: StretchToBound) -> tuple[BarrierTask, CheckedBarrier | None]:
        """Find barriers from the goal and from the start; return the latter with its task."""
        back = find_barrier(
            self._task(stretch.goal, stretch.start, self.before[0], forward=False),
            _FIRST_ROUNDS[0] if self.before[0] is None else _LATER_ROUNDS[0],
        )
        course = None
        if back is not None and back.complete:
            self.to_goal = np.where(
                self.band(), np.maximum(self.to_goal, _least_in_cells(back)), self.to_goal
            )
            course = slope_direction(self.mesh, back.phi, *stretch.start)
        task = self._task(stretch.start, stretch.goal, self.before[1], forward=True, course=course)
        forward = find_barrier(
            task, _FIRST_ROUNDS[1] if self.before[0] is None else _LATER_ROUNDS[1]
        )
        if forward is not None and not forward.complete:
            forward = None
        if forward is not None:
            self.from_start = np.where(
                self.band(), np.maximum(self.from_start, _least_in_cells(forward)), self.from_start
            )
        self.before = back, forward
        return task, forward

    def _task(
        self,
        source: tuple[float, float],
        target: tuple[float, float],
        before: CheckedBarrier | None,
        *,
        forward: bool,
        course: float | None = None,
    ) -> BarrierTask:
        """Return the task of a barrier, with what is known from larger cells."""
        factor = None if before is None else finer_factors(before.factor)
        own, other = self.from_start, self.to_goal
        if not forward:
            own, other = other, own
        return BarrierTask(
            self.mesh, source, target, self.known, own, other, forward, course, factor
        )


def _least_in_cells(barrier: CheckedBarrier) -> FloatArray:
    return np.minimum(cell_minimum(barrier.phi), barrier.centre)


def _halved_cells(values: FloatArray) -> FloatArray:
    return np.repeat(np.repeat(values, 2, axis=0), 2, axis=1)


def usual_rate(stretch: StretchToBound) -> float:
    """Return the time that a first mesh takes for each of its cells, for most ships [s]."""
    return USUAL_SECONDS_A_CELL[axes_needed(stretch.ship.table) != 0]


def first_cells(seconds: float, rate: float) -> int:
    """Return the number of cells of a first mesh along the geodesic for a time to spend [s]."""
    affordable = math.sqrt(max(seconds, 0.0) / 3.0 / rate)
    return int(min(max(affordable, _FEWEST_CELLS), _FIRST_CELLS))


def _cells(stretch: StretchToBound, seconds: float, rate: float) -> int:
    """Return the number of cells of the raster where the data are given by functions."""
    first = first_cells(seconds, rate)
    if rate > _MUCH_SLOWER * usual_rate(stretch):
        return first
    first = max(first, _FEWEST_SAMPLES)
    finest = _FINE_CELLS[axes_needed(stretch.ship.table) != 0]
    share = min(max(seconds / _SECONDS_OF_FINE_CELLS, 0.0), 1.0)
    return round(first + share * max(finest - first, 0))
