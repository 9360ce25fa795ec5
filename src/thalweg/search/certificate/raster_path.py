"""A fast path through a raster of the sea: a hint at routes that a coarse network does not have."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import shapely

from thalweg.core.types import FloatArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.search.certificate.arrival_barrier import BarrierTask, first_arrivals
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import BarrierMesh, build_mesh

_COURSES: Final = 72  # that the way back is looked for
_STEP: Final = 1.5  # of the way back [cells]
_TOLERANCE: Final = 0.5  # of the positions that are kept [cells]


def fast_path_on_raster(
    stretch: StretchToBound, cells: int
) -> tuple[FloatArray, FloatArray] | None:
    """Return positions (lat, lon) [deg] of a fast way through the data themselves.

    Parameters
    ----------
    stretch : Of a ship whose speed through water does not depend on the weather.
    cells : Cells of the raster along its longer side where the data are no finer.

    Returns
    -------
    pair of float64 array, or None
        None without currents, near a pole, and where the goal is not reached in the known time.
    """
    domain = BarrierDomain.around(stretch, cells)
    if domain is None or domain.fastest <= domain.ship.top_speed:
        return None
    mesh = build_mesh(domain.raster, 1, domain.ship, stretch.chart, margins=domain.margins)
    own = mesh.least_times(*stretch.start, domain.fastest)
    other = mesh.least_times(*stretch.goal, domain.fastest)
    task = BarrierTask(mesh, stretch.start, stretch.goal, stretch.known, own, other, True)
    return _way_back(mesh, first_arrivals(task), stretch)


def _way_back(
    mesh: BarrierMesh, phi: FloatArray, stretch: StretchToBound
) -> tuple[FloatArray, FloatArray] | None:
    """Follow the earliest arrivals from the goal back to the start."""
    world = mesh.world
    steps = np.array([mesh.lat[1] - mesh.lat[0], mesh.lon[1] - mesh.lon[0]])
    corner = np.array([mesh.lat[0], mesh.lon[0]])
    course = np.linspace(0.0, 2.0 * math.pi, _COURSES, endpoint=False)
    east, north = np.sin(course), np.cos(course)

    def place(position: tuple[float, float]) -> FloatArray:
        turned = (position[1] - mesh.lon[0]) % 360.0 + mesh.lon[0]
        return np.asarray((np.array([position[0], turned]) - corner) / steps)

    start, at = place(stretch.start), place(stretch.goal)
    from scipy import ndimage

    found = [at]
    for _ in range(20 * sum(phi.shape)):
        if np.hypot(*(at - start)) < 1.5 * _STEP:
            break
        row = min(max(int(at[0]), 0), phi.shape[0] - 1)
        cell = np.array([world.metres_north[row], world.metres_east[row]]) * steps
        length = _STEP * float(cell.min())
        back = at - length * np.stack([north, east], -1) / cell
        arrival = ndimage.map_coordinates(phi, back.T, order=1, mode="nearest")
        now = float(ndimage.map_coordinates(phi, at[:, None], order=1, mode="nearest")[0])
        current = _current(mesh, at, now)
        along = current[0] * east + current[1] * north
        across = current[0] * north - current[1] * east
        through = np.sqrt(np.maximum(world.top_speed**2 - across**2, 0.0))
        speed = np.where(world.top_speed > np.abs(across), along + through, 0.0)
        arrival += np.where(speed > 0.0, length / np.maximum(speed, 1e-9), np.inf)
        at = back[int(np.argmin(arrival))]
        found.append(at)
    else:
        return None
    line = shapely.LineString([*found, start]).simplify(_TOLERANCE)
    positions = corner + np.asarray(line.coords)[::-1] * steps
    lat, lon = positions.T.copy()
    (lat[0], lat[-1]), (lon[0], lon[-1]) = zip(stretch.start, stretch.goal)
    return lat, lon


def _current(mesh: BarrierMesh, at: FloatArray, time: float) -> FloatArray:
    """Return the current (east, north) [m/s] at a place [cells], at the time of the data before."""
    raster = mesh.world.raster
    index = [raster.channel_index[k] for k in (CURRENT_EAST, CURRENT_NORTH)]
    step = int(np.clip(np.searchsorted(raster.times, time, side="right") - 1, 0, None))
    j, i = (int(min(max(a, 0), n - 2)) for a, n in zip(at, raster.values.shape[1:3]))
    y, x = np.clip(at - np.array([j, i]), 0.0, 1.0)
    block = raster.values[step, j : j + 2, i : i + 2][..., index].astype(float)
    rows = block[0] * (1.0 - y) + block[1] * y
    mixed = rows[0] * (1.0 - x) + rows[1] * x
    # only the choice of a candidate path, which is scored afterwards with the data as they are
    return np.nan_to_num(mixed)
