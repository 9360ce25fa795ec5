"""Certified lower bounds of the cost of a stretch at given prices of time."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.core.geodesy import distance, inverse
from thalweg.core.types import BoolArray, FloatArray
from thalweg.kernels.certificate.barrier_solver import COURSES, UNREACHED
from thalweg.kernels.certificate.cell_conditions import ANGLES, TimeWindows
from thalweg.kernels.certificate.cost_check import CostRates, check_cost_barrier
from thalweg.kernels.certificate.cost_conditions import CellMotions, PricedShip, fill_motions
from thalweg.kernels.certificate.cost_solver import solve_cost_barrier
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.kernels.leg.table_lookup import axes_needed
from thalweg.search.certificate.arrival_barrier import (
    cell_minimum,
    correct_factors,
    nodes_of,
)
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import (
    BarrierMesh,
    build_mesh,
    plane_at_source,
    strongest_current_near,
)
from thalweg.search.certificate.closed_water import cells_inside
from thalweg.search.search_problem import ROUNDING_FACTOR

_FIRST_CELLS: Final = 30  # of the first mesh along the geodesic, at least
_MOST_CELLS: Final = 480  # of the finest mesh
_RASTER_CELLS: Final = 120  # along the longer side of the raster of a sea of functions
_SECTORS: Final = 16  # of headings, for ships whose speed depends on the angle to wind and waves
_ROUNDS: Final = 8
_LARGEST_SCALE: Final = 0.3  # barriers that rise faster by more than this share are not used
_CAP_RATIO: Final = 1.5  # barriers are cut off at this multiple of the known cost
_MOST_BYTES: Final = 100_000_000  # of the motions of a mesh
_GROWTH: Final = 4.5  # of the time from one mesh to the next
_SECONDS_A_CELL: Final = 2e-5, 1.5e-4  # of one setting, without and with tables of weather


@dataclass(frozen=True, eq=False)
class CostToBound:
    """What a stretch costs.

    Attributes
    ----------
    stretch : Its ``known`` is the longest time that counts [s].
    ship : Settings with their consumption.
    inside, outside : Least prices of a unit of consumption in and out of emission control areas.
    second : Price of a second under way or waiting.
    """

    stretch: StretchToBound
    ship: PricedShip
    inside: float
    outside: float
    second: float

    def least_per_metre(self, second: float, current: float) -> float:
        """Return a lower bound of the cost of a metre, at a price of time and a current [m/s]."""
        price = min(self.inside, self.outside)
        return float(np.min((price * self.ship.least + second) / (self.ship.top + current)))


@dataclass(frozen=True, eq=False)
class CostCertificate:
    """Lower bounds of cost plus a price of time, for all routes within the longest time.

    Attributes
    ----------
    values : Of each price of time; -inf where there is none.
    cells : Cells of the finest mesh along the geodesic; 0 for none.
    sampling : How the sea of the proof differs from the data; "" where it does not.
    """

    values: FloatArray
    cells: int
    sampling: str


def certify_costs(
    cost: CostToBound,
    prices_of_time: FloatArray,
    known: FloatArray,
    *,
    seconds: float,
    most_cells: int = _MOST_CELLS,
) -> CostCertificate:
    """Bound the cost of every route plus its time at given prices from below.

    Parameters
    ----------
    cost : The stretch. Its longest time is that of the slowest routes that the bound is for.
    prices_of_time : In addition to the price of time in the cost [1/s], (n,).
    known : Cost plus priced time of routes that exist, one for each price, (n,).
    seconds : Time that the search may take [s]. A mesh is completed once begun; the next finer one
        is left out when it would take longer than what is left.
    most_cells : Cells of the finest mesh along the geodesic, at most.

    Returns
    -------
    CostCertificate
        Without bounds near a pole and across half of the globe.
    """
    began, count = clock.perf_counter(), len(prices_of_time)
    best = CostCertificate(np.full(count, -math.inf), 0, "")
    domain = BarrierDomain.around(cost.stretch, _RASTER_CELLS)
    if domain is None:
        return best
    seconds_each = cost.second + np.asarray(prices_of_time, float)
    per_metre = np.array(
        [cost.least_per_metre(one, domain.strongest_current) for one in seconds_each]
    )
    if not (per_metre > 0.0).all():
        return best
    free = ROUNDING_FACTOR * per_metre * cost.stretch.length
    best = replace(best, values=np.minimum(free, known), sampling=domain.sampling)
    raster, margins = _cropped(domain, cost.stretch, float((known / per_metre).max()))
    refinement = max(1, math.ceil(_FIRST_CELLS * domain.cell_height / cost.stretch.length))
    weather = (axes_needed(cost.stretch.ship.table) | axes_needed(cost.ship.consumption)) != 0
    cells = (raster.values.shape[1] - 1) * (raster.values.shape[2] - 1)
    expected = _SECONDS_A_CELL[weather] * cells * refinement**2 * len(cost.ship.settings)
    while clock.perf_counter() - began + expected <= seconds:
        wide = round(cost.stretch.length / domain.cell_height * refinement)
        if wide > most_cells or _bytes_of_motions(cost, cells * refinement**2) > _MOST_BYTES:
            break
        start = clock.perf_counter()
        mesh = build_mesh(
            raster, refinement, domain.ship, cost.stretch.chart,
            departures=cost.stretch.departures, by_steps=bool(domain.sampling),
            kept_out=cost.stretch.kept_out, margins=margins,
        )  # fmt: skip
        level = _CostLevel.on(mesh, cost, domain.fastest, float((known / per_metre).max()))
        found = [level.bound(*row) for row in zip(seconds_each, known, per_metre)]
        best = CostCertificate(np.maximum(best.values, found), wide, domain.sampling)
        expected = _GROWTH * (clock.perf_counter() - start)
        refinement *= 2
    return best


def _sectors(cost: CostToBound) -> int:
    needs = axes_needed(cost.stretch.ship.table) | axes_needed(cost.ship.consumption)
    return _SECTORS if needs & ANGLES else 1


def _bytes_of_motions(cost: CostToBound, cells: int) -> int:
    return 8 * cells * len(cost.ship.settings) * (_sectors(cost) + COURSES)


def _cropped(
    domain: BarrierDomain, stretch: StretchToBound, reach: float
) -> tuple[RasterArrays, FloatArray]:
    """Return the raster and margins of what routes of a greatest length [m] may touch, and more."""
    raster, margins = domain.raster, domain.margins
    _, rows, columns, _ = raster.values.shape
    lat0, dlat, lon0, dlon = raster.corner
    lat, lon = lat0 + dlat * np.arange(rows), lon0 + dlon * np.arange(columns)
    far = np.asarray(distance(lat[:, None], lon[None, :], *stretch.start), float)
    far += np.asarray(distance(lat[:, None], lon[None, :], *stretch.goal), float)
    near = far < reach + 6.0 * 111_700.0 * math.hypot(dlat, dlon)
    parts = []
    for axis in (1, 0):
        used = np.flatnonzero(near.any(axis=axis))
        parts.append(slice(max(int(used[0]) - 1, 0), int(used[-1]) + 2))
    j, i = parts
    corner = np.array([lat0 + dlat * j.start, dlat, lon0 + dlon * i.start, dlon])
    if margins.shape[0] > 1:
        margins = margins[j.start : j.stop - 1, i.start : i.stop - 1]
    values = np.ascontiguousarray(raster.values[:, j, i])
    return raster._replace(values=values, corner=corner.astype(float)), margins


@dataclass(frozen=True, eq=False)
class _CostLevel:
    """One mesh with what a ship may do in its cells.

    Attributes
    ----------
    from_start, to_goal : Lower bounds of the length [m] of the ways to a cell, (Y - 1, X - 1).
    wanted : Cells that a route within the longest time and length may touch.
    consumption : Least price of a unit of consumption in each cell.
    """

    mesh: BarrierMesh
    cost: CostToBound
    from_start: FloatArray
    to_goal: FloatArray
    wanted: BoolArray
    windows: TimeWindows
    motions: CellMotions
    consumption: FloatArray

    @classmethod
    def on(cls, mesh: BarrierMesh, cost: CostToBound, fastest: float, reach: float) -> _CostLevel:
        stretch, settings = cost.stretch, len(cost.ship.settings)
        from_start = mesh.least_times(*stretch.start, 1.0)
        to_goal = mesh.least_times(*stretch.goal, 1.0)
        windows = TimeWindows(from_start / fastest, stretch.known - to_goal / fastest)
        wanted = (from_start + to_goal < reach) & (windows.first <= windows.last)
        shape, sectors = wanted.shape, _sectors(cost)
        speed, consumption = (np.zeros((*shape, settings, sectors), np.float32) for _ in range(2))
        seconds, amount = (np.zeros((*shape, COURSES, settings), np.float32) for _ in range(2))
        motions = CellMotions(np.zeros(shape, bool), speed, consumption, seconds, amount)
        fill_motions(mesh.world, cost.ship, windows, wanted, motions)
        prices = np.full(shape, min(cost.inside, cost.outside))
        areas = None if stretch.chart is None else stretch.chart.control_areas
        if cost.inside > cost.outside and areas is not None:
            prices[cells_inside(areas, mesh.lat, mesh.lon)] = cost.inside
        return cls(mesh, cost, from_start, to_goal, wanted, windows, motions, prices)

    def bound(self, second: float, known: float, per_metre: float) -> float:
        """Return the best bound of some rounds of solving, checking and correcting."""
        mesh, stretch = self.mesh, self.cost.stretch
        rates = CostRates(self.consumption, second)
        reach = self.wanted & (per_metre * (self.from_start + self.to_goal) < known)
        solvable = nodes_of(reach & self.motions.is_open, mesh.shape)

        def slowness(rows: slice, columns: slice) -> float:
            return self.cost.least_per_metre(second, strongest_current_near(mesh, rows, columns))

        course = float(inverse(*stretch.goal, *stretch.start)[1])
        given = plane_at_source(mesh, stretch.goal, course, slowness)
        solvable &= np.isnan(given)
        factor, excess = np.ones(mesh.shape), np.empty(self.wanted.shape)
        best = 0.0
        for _ in range(_ROUNDS):
            phi = np.where(np.isnan(given), UNREACHED, given)
            solve_cost_barrier(self.motions, rates, phi, factor, solvable, _CAP_RATIO * known)
            phi = np.minimum(phi, _CAP_RATIO * known)
            before = per_metre * self.from_start
            candidate = reach & (cell_minimum(phi) / (1.0 + _LARGEST_SCALE) + before < known)
            check_cost_barrier(
                mesh.world, self.motions, rates, phi, candidate, self.windows, excess
            )
            if self._falls_along_canals(phi, second):
                break
            best = max(best, self._proven(phi, excess, candidate, before, known))
            correct_factors(factor, excess, 0)
        return best

    def _falls_along_canals(self, phi: FloatArray, second: float) -> bool:
        """Return whether a barrier falls along a canal in reach by more than its time costs."""
        for link in self.mesh.links:
            cells = [self.mesh.cell_of(*end) for end in (link.one, link.other)]
            if not all(self.wanted[cell] for cell in cells):
                continue
            corners = [phi[j : j + 2, i : i + 2] for j, i in cells]
            for one, other in (corners, corners[::-1]):
                if one.max() - other.min() > second * link.seconds:
                    return True
        return False

    def _proven(
        self,
        phi: FloatArray,
        excess: FloatArray,
        candidate: BoolArray,
        before: FloatArray,
        known: float,
    ) -> float:
        """Return the bound of a barrier, divided so that it falls nowhere faster than it may."""
        edges = candidate[0].any() or candidate[-1].any()
        if edges or candidate[:, 0].any() or candidate[:, -1].any():
            return 0.0
        least, scale = cell_minimum(phi), 0.0
        for _ in range(60):
            counts = candidate & (least / (1.0 + scale) + before < known)
            needed = max(0.0, float(excess[counts].max(initial=0.0)))
            if needed <= scale:
                break
            scale = needed
        else:
            return 0.0
        if scale > _LARGEST_SCALE:
            return 0.0
        centre = 0.25 * (phi[:-1, :-1] + phi[:-1, 1:] + phi[1:, :-1] + phi[1:, 1:])
        found = self.mesh.value_at(phi, centre, *self.cost.stretch.start)
        return min(ROUNDING_FACTOR * found / (1.0 + scale), known)
