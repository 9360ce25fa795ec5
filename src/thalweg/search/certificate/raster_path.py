"""A fast path through a raster of the sea: a hint at routes that a coarse network does not have."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import shapely

from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.sea.grids.rectilinear_grid import RectilinearGrid
from thalweg.sea.standard_names import EASTWARD_CURRENT, NORTHWARD_CURRENT
from thalweg.search.certificate.arrival_barrier import BarrierTask, first_arrivals
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import BarrierMesh, build_mesh

_COURSES: Final = 72  # that the way back is looked for
_STEP: Final = 1.5  # of the way back [cells]
_TOLERANCE: Final = 0.5  # of the positions that are kept [cells]
_TOLERANCE_IN_CELLS: Final = 0.02  # the same where positions were chosen within their cells
_PARTS: Final = 60  # of such a path, at least
_DRIFT: Final = 0.02  # current that matters, as a share of the speed through water
_SHARP: Final = 0.25  # change of the current over three cells that matters, as such a share
_PLACES: Final = np.linspace(-1.0, 2.0, 25)  # across three cells, beside the lines of the data
_BESIDE: Final = 0.01  # a line of data [cells]: unknown water may begin at the last one
_ROUND: Final = np.array([-0.003, 0.0, 0.003])  # a place [cells], to which an arc comes near
_NEARER: Final = 1e-6  # [m/s] per cell: of equal places that nearest to the path is taken


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
    phi = first_arrivals(task)
    found = _way_back(mesh, phi, stretch)
    if found is None:
        return None
    chosen = _fastest_in_cells(found, mesh, phi, stretch, domain.margins[..., CURRENT_EAST])
    if chosen is found:
        line = shapely.LineString(found).simplify(_TOLERANCE)
    else:  # a great circle between positions far apart leaves a parallel
        line = shapely.LineString(chosen).simplify(_TOLERANCE_IN_CELLS)
        line = shapely.segmentize(line, line.length / _PARTS)
    places = np.asarray(line.coords)[::-1]
    lat, lon = _positions(mesh, places)
    (lat[0], lat[-1]), (lon[0], lon[-1]) = zip(stretch.start, stretch.goal)
    return lat, lon


def _way_back(mesh: BarrierMesh, phi: FloatArray, stretch: StretchToBound) -> FloatArray | None:
    """Follow the earliest arrivals from the goal back to the start; return positions [cells]."""
    world = mesh.world
    steps = _steps(mesh)
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
            return np.array([*found, start])
        row = min(max(int(at[0]), 0), phi.shape[0] - 1)
        cell = np.array([world.metres_north[row], world.metres_east[row]]) * steps
        length = _STEP * float(cell.min())
        back = at - length * np.stack([north, east], -1) / cell
        arrival = ndimage.map_coordinates(phi, back.T, order=1, mode="nearest")
        now = float(ndimage.map_coordinates(phi, at[:, None], order=1, mode="nearest")[0])
        speed = _speed_over_ground(world.top_speed, _current(mesh, at, now), (north, east))
        arrival += np.where(speed > 0.0, length / np.maximum(speed, 1e-9), np.inf)
        at = back[int(np.argmin(arrival))]
        found.append(at)
    return None


def _fastest_in_cells(
    places: FloatArray,
    mesh: BarrierMesh,
    phi: FloatArray,
    stretch: StretchToBound,
    drift: FloatArray,
) -> FloatArray:
    """Move positions [cells] across their cells to where the data make the ship fastest.

    Only in or beside cells in which the data have currents that the raster does not have, as the
    earliest arrivals are the same along the side of such a cell, and where the current changes much
    from line to line.

    Parameters
    ----------
    places : From the goal to the start, (N, 2).
    drift : By how much the current may differ from the raster in each cell [m/s].

    Returns
    -------
    float64[N, 2]
        ``places`` itself if nothing is to be moved.
    """
    from scipy import ndimage

    world = mesh.world
    cell = np.minimum(places.astype(int), np.array(phi.shape) - 2)
    near = ndimage.maximum_filter(drift, size=3, mode="nearest")
    here = near[tuple(np.minimum(cell, np.array(drift.shape) - 1).T)]
    arrival = np.minimum(phi[tuple(cell.T)], stretch.known)  # later where no ship gets
    apart = (here > _DRIFT * world.top_speed) | (
        _change_of_current(mesh, cell, arrival) > _SHARP * world.top_speed
    )
    moved = np.flatnonzero(apart[1:-1]) + 1
    if not moved.size:
        return places
    row = np.minimum(cell[moved, 0], world.metres_north.size - 1)
    metres = np.stack([world.metres_north[row], world.metres_east[row]], axis=1)
    ahead = (places[moved - 1] - places[moved + 1]) * _steps(mesh) * metres
    ahead /= np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9)
    across = np.argmin(np.abs(ahead), axis=1)  # the axis to move along
    lines = _lines_of_currents(mesh, stretch)
    tried, numbers = [], []
    for number, (at, axis) in enumerate(zip(moved, across)):
        low = float(cell[at, axis])
        first, last = np.searchsorted(lines[axis], [low - 1.0, low + 2.0])
        own = lines[axis][first:last]
        choices = np.concatenate([own - _BESIDE, own, own + _BESIDE, low + _PLACES])
        choices = choices[(choices >= 0.0) & (choices <= phi.shape[axis] - 1.0)]
        one = np.tile(places[at], (choices.size, 1))
        one[:, axis] = choices
        tried.append(one)
        numbers.append(np.full(choices.size, number))
    all_places, number_of = np.concatenate(tried), np.concatenate(numbers)
    time = stretch.depart + arrival[moved][number_of]
    names = [EASTWARD_CURRENT, NORTHWARD_CURRENT]
    aside = np.eye(2)[across[number_of]]
    round_them = all_places[:, None] + _ROUND[:, None] * aside[:, None]
    sampled = stretch.sea.sample(names, time[:, None], *_positions(mesh, round_them))
    current = sampled[EASTWARD_CURRENT], sampled[NORTHWARD_CURRENT]
    direction = ahead[number_of].T[..., None]
    speed = _speed_over_ground(world.top_speed, current, (direction[0], direction[1])).min(axis=1)
    speed -= _NEARER * np.abs(all_places - places[moved][number_of]).sum(axis=1)
    result = places.copy()
    result[moved] = [
        one[int(np.argmax(values))]
        for one, values in zip(
            tried, np.split(speed, np.flatnonzero(np.diff(number_of)) + 1), strict=True
        )
    ]
    return result


def _change_of_current(mesh: BarrierMesh, cell: IntArray, time: FloatArray) -> FloatArray:
    """Return by how much components of the current [m/s] differ in and round cells (N, 2)."""
    raster = mesh.world.raster
    index = [raster.channel_index[k] for k in (CURRENT_EAST, CURRENT_NORTH)]
    last, rows, columns = (n - 1 for n in raster.values.shape[:3])
    step = np.clip(np.searchsorted(raster.times, time, side="right") - 1, 0, last)
    around = np.arange(-1, 3)
    j = np.clip(cell[:, :1] + around, 0, rows)[:, :, None]
    i = np.clip(cell[:, 1:] + around, 0, columns)[:, None, :]
    block = raster.values[step[:, None, None], j, i][..., index]
    low, high = (part.reduce(part.reduce(block, axis=1), axis=1) for part in (np.fmin, np.fmax))
    # unknown all round: nothing to choose from
    return np.asarray(np.nan_to_num(high - low).max(axis=-1), float)


def _lines_of_currents(mesh: BarrierMesh, stretch: StretchToBound) -> tuple[FloatArray, FloatArray]:
    """Return the rows and columns of all grids of axes with currents [cells]."""
    rows, columns = [np.zeros(0)], [np.zeros(0)]
    steps = _steps(mesh)
    for layer in stretch.sea.layers:
        grid = getattr(layer, "grid", None)
        if isinstance(grid, RectilinearGrid) and EASTWARD_CURRENT in layer.variables:
            east = (np.asarray(grid.lon, float) - mesh.lon[0]) % 360.0
            rows.append((np.asarray(grid.lat, float) - mesh.lat[0]) / steps[0])
            columns.append(east / steps[1])
    return np.unique(np.concatenate(rows)), np.unique(np.concatenate(columns))


def _speed_over_ground(
    through_water: float,
    current: tuple[FloatArray, FloatArray] | FloatArray,
    direction: tuple[FloatArray, FloatArray] | FloatArray,
) -> FloatArray:
    """Return the speed [m/s] along directions (north, east); 0 where a current sets too strongly.

    Where the current is unknown, too: this only chooses a path, which is scored afterwards.
    """
    (east, north), (ahead_north, ahead_east) = current, direction
    along = east * ahead_east + north * ahead_north
    across = east * ahead_north - north * ahead_east
    through = np.sqrt(np.maximum(through_water**2 - across**2, 0.0))
    return np.where(through_water > np.abs(across), along + through, 0.0)


def _steps(mesh: BarrierMesh) -> FloatArray:
    """Return the height and width of a cell [deg]."""
    return np.array([mesh.lat[1] - mesh.lat[0], mesh.lon[1] - mesh.lon[0]])


def _positions(mesh: BarrierMesh, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return latitudes and longitudes [deg] of places [cells]."""
    lat, lon = np.moveaxis(np.array([mesh.lat[0], mesh.lon[0]]) + places * _steps(mesh), -1, 0)
    return lat.copy(), lon.copy()


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
