"""How long a check of a barrier takes: ships differ by a factor of ten and more."""

from __future__ import annotations

import time as clock
from typing import Final

import numpy as np

from thalweg.kernels.certificate.barrier_check import BarrierExcess, check_barrier
from thalweg.kernels.certificate.cell_conditions import TimeWindows
from thalweg.kernels.leg.table_lookup import axes_needed
from thalweg.search.certificate.arrival_barrier import no_kept_speeds
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import build_mesh

#: Seconds that a first mesh takes for each of its cells, without and with tables of weather, for
#: most ships and seas.
USUAL_SECONDS_A_CELL: Final = 3e-5, 3e-4
_SAMPLE: Final = 48  # cells that are timed
_FIRST: Final = 6  # cells before them, while the compiled code is loaded
_MOST_CELLS: Final = 400_000  # of a mesh on which cells are timed
_CHECKS: Final = 1.2  # first checks of cells in a mesh, for each of its cells in the band or not


def seconds_a_cell(stretch: StretchToBound, domain: BarrierDomain) -> float:
    """Return an estimate of the time of a first mesh for each of its cells [s].

    Parameters
    ----------
    domain : Some of its cells are checked; not where the ship's speed does not depend on weather,
        nor on very large rasters.

    Returns
    -------
    float : No less than without tables of weather.
    """
    weather = axes_needed(stretch.ship.table) != 0
    usual = USUAL_SECONDS_A_CELL[weather]
    _, rows, columns, _ = domain.raster.values.shape
    if not weather or domain.ship.speed_field is not None or rows * columns > _MOST_CELLS:
        return usual
    mesh = build_mesh(
        domain.raster, 1, domain.ship, None,
        departures=stretch.departures, by_steps=bool(domain.sampling), margins=domain.margins,
    )  # fmt: skip
    from_start = mesh.least_times(*stretch.start, domain.fastest)
    to_goal = mesh.least_times(*stretch.goal, domain.fastest)
    band = np.flatnonzero(from_start + to_goal < stretch.known)
    if band.size < 2 * _SAMPLE:
        return usual
    windows = TimeWindows(from_start, np.maximum(stretch.known - to_goal, from_start))
    chosen = band[:: band.size // _SAMPLE]
    used = 0.0
    for cells in (chosen[:_FIRST], chosen):
        candidate = np.zeros(from_start.shape, bool)
        candidate.ravel()[cells] = True
        found = BarrierExcess(*(np.empty(from_start.shape) for _ in range(2)))
        level, kept = np.zeros(mesh.shape), no_kept_speeds(mesh)
        began = clock.perf_counter()
        check_barrier(mesh.world, level, candidate, windows, False, False, found, kept)
        used = clock.perf_counter() - began
    return max(USUAL_SECONDS_A_CELL[0], _CHECKS * used / chosen.size)
