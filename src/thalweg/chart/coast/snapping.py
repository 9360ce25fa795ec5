"""The nearest water joined to the open sea, for positions on charted land."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core import geodesy
from thalweg.core.types import FloatArray

#: Whether positions (lat, lon) [deg] are navigable.
PositionTest: TypeAlias = Callable[[FloatArray, FloatArray], NDArray[np.bool_]]
#: Whether legs (lat1, lon1, lat2, lon2) [deg] are blocked.
LegTest: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], NDArray[np.bool_]]
OPEN_SEA_MARGIN: Final = 40_000.0  # water that extends this far beyond the search is open sea [m]
OPEN_SEA_WIDTH: Final = 15_000.0  # water this far from land is open sea [m]: no lake is as wide
HALF_GRID_POINTS: Final = 90  # half the points along a side of the search grid
#: Half widths [m] and half the points along a side of the grids on which water is followed.
_GROWING_GRIDS: Final = ((10_000.0, 80), (25_000.0, 80), (60_000.0, 80), (150_000.0, 80))
_FINE_GRIDS: Final = ((15_000.0, 160), (60_000.0, 240), (150_000.0, 240))


def nearest_navigable(
    lat: float,
    lon: float,
    *,
    largest: float,
    is_navigable: PositionTest,
    legs_blocked: LegTest,
    accepts: Callable[[float, float], bool] = lambda lat, lon: True,
) -> tuple[float, float, float] | None:
    """Return the nearest navigable place joined to the open sea, and the distance to it [m].

    Grids of 180 x 180 steps are centred on the position, for water within 5 km, 20 km and
    ``largest``. Each grid extends three times as far as its search radius, or 40 km farther.
    Neighbouring points are joined by tested legs. Water that reaches the border of the grid is
    open sea; where none does on the widest grid, the largest connected water is. The result is a
    point of the grid: up to half a step (0.1, 0.3 or 0.5 km) farther than the nearest water.

    Parameters
    ----------
    lat, lon : Position [deg].
    largest : Largest search radius [m].
    is_navigable, legs_blocked : Tests of positions and of legs, as of `thalweg.chart.Chart`.
    accepts : Whether a result is good enough; otherwise the next grid is searched.

    Returns
    -------
    tuple of float, or None
        Latitude and longitude [deg] and distance [m]; None if there is no water within reach.
    """
    for radius in sorted({min(r, largest) for r in (5_000.0, 20_000.0, largest)}):
        lats, lons = _search_grid(lat, lon, radius + min(OPEN_SEA_MARGIN, 3.0 * radius))
        free = is_navigable(lats, lons)
        k = np.flatnonzero(
            _connected_to_open_sea(legs_blocked, lats, lons, free, radius == largest)
        )
        if len(k):
            separation = geodesy.distance(lat, lon, lats.ravel()[k], lons.ravel()[k])
            best = int(np.argmin(separation))
            place = float(lats.ravel()[k[best]]), float(lons.ravel()[k[best]])
            place = place[0], float(geodesy.wrap_longitude(place[1]))
            if separation[best] <= radius and accepts(*place):
                return *place, float(separation[best])
    return None


def is_joined_to_sea(
    lat: float,
    lon: float,
    *,
    is_navigable: PositionTest,
    legs_blocked: LegTest,
    shore_distance: Callable[[FloatArray, FloatArray], FloatArray],
) -> bool:
    """Return whether water at a position leads to open sea.

    Open sea is water `OPEN_SEA_WIDTH` from land, or water that leads to the border of the last
    grid. Grids around the position grow; from each one the water that has been reached is followed
    on the next. Where a coarse grid loses a narrow channel, finer grids decide.

    Parameters
    ----------
    lat, lon : Position on water [deg].
    is_navigable, legs_blocked : Tests of positions and of legs, as of `thalweg.chart.Chart`.
    shore_distance : Distance [m] of positions from land.
    """
    for sizes in (_GROWING_GRIDS, _FINE_GRIDS):
        reached = None
        for half, points in sizes:
            lats, lons = _search_grid(lat, lon, half, points)
            free = is_navigable(lats, lons)
            if reached is None:
                seeds = np.zeros(free.shape, bool)
                seeds[points - 1 : points + 2, points - 1 : points + 2] = True
            else:
                seeds = _coarsened(*reached, half, points)
            labels = _connected_waters(legs_blocked, lats, lons, free)
            water = np.isin(labels, np.unique(labels[seeds & free])) & free
            reached = water, half
            if (shore_distance(lats[water], lons[water]) >= OPEN_SEA_WIDTH).any():
                return True
        if water[0].any() or water[-1].any() or water[:, [0, -1]].any():
            return True
    return False


def _coarsened(
    water: NDArray[np.bool_], half: float, wider: float, points: int
) -> NDArray[np.bool_]:
    """Return which points of a wider grid are water that has been reached on a finer one."""
    fine = (len(water) - 1) // 2
    steps = np.arange(-points, points + 1) * (wider / points) / (half / fine)
    inside = np.abs(steps) <= fine
    index = np.clip(np.rint(steps).astype(int) + fine, 0, 2 * fine)
    both = inside[:, None] & inside[None, :]
    return np.asarray(water[np.ix_(index, index)] & both)


def _search_grid(
    lat: float, lon: float, half: float, points: int = HALF_GRID_POINTS
) -> tuple[FloatArray, FloatArray]:
    share = np.arange(-points, points + 1) / points * half / geodesy.METRES_PER_DEGREE
    north = np.clip(lat + share, -90.0, 90.0)
    east = share / max(np.cos(np.radians(lat)), 0.02)
    lats, lons = np.meshgrid(north, lon + np.clip(east, -179.0, 179.0), indexing="ij")
    return lats, lons


def _connected_to_open_sea(
    legs_blocked: LegTest, lats: FloatArray, lons: FloatArray, free: NDArray[np.bool_], last: bool
) -> NDArray[np.bool_]:
    """Return (flat) which free points are joined to the border, or at last the largest water."""
    labels = _connected_waters(legs_blocked, lats, lons, free)
    border = np.ones(free.shape, bool)
    border[1:-1, 1:-1] = False
    joined = np.unique(labels[border & free])
    if last and not len(joined) and free.any():
        joined = np.array([np.bincount(labels[free]).argmax()])
    return np.asarray((np.isin(labels, joined) & free).ravel())


def joined_positions(
    lat: float, lon: float, half: float, *, is_navigable: PositionTest, legs_blocked: LegTest
) -> tuple[FloatArray, FloatArray]:
    """Return the positions of a grid round a place that legs join to that place.

    Parameters
    ----------
    lat, lon : The place [deg], on navigable water.
    half : Half the side of the grid [m]; it has 180 x 180 steps.
    is_navigable, legs_blocked : Tests of positions and of legs, as of `thalweg.chart.Chart`.

    Returns
    -------
    lat, lon : Positions [deg], (n,).
    """
    lats, lons = _search_grid(lat, lon, half)
    free = is_navigable(lats, lons)
    labels = _connected_waters(legs_blocked, lats, lons, free).ravel()
    y, x = lats.ravel(), lons.ravel()
    step = half / HALF_GRID_POINTS
    middle = np.zeros(free.shape, bool)
    middle[(slice(HALF_GRID_POINTS - 3, HALF_GRID_POINTS + 4),) * 2] = True
    near = np.flatnonzero(free & middle)
    near = near[geodesy.distance(lat, lon, y[near], x[near]) < 3.0 * step]
    here = np.full(len(near), lat), np.full(len(near), lon)
    near = near[~legs_blocked(*here, y[near], x[near])]
    joined = np.isin(labels, np.unique(labels[near])) & free.ravel()
    return y[joined], x[joined]


def _connected_waters(
    legs_blocked: LegTest, lats: FloatArray, lons: FloatArray, free: NDArray[np.bool_]
) -> NDArray[np.int32]:
    """Return the number of the connected water of every point of a grid."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    number = np.arange(free.size).reshape(free.shape)
    pairs = []
    for a, b in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        both = free[a] & free[b]
        p, q = number[a][both], number[b][both]
        y, x = lats.ravel(), lons.ravel()
        clear = ~legs_blocked(y[p], x[p], y[q], x[q])
        pairs.append((p[clear], q[clear]))
    p, q = (np.concatenate(side) for side in zip(*pairs))
    graph = coo_matrix((np.ones(len(p), bool), (p, q)), shape=(free.size, free.size))
    return np.asarray(connected_components(graph, directed=False)[1].reshape(free.shape))
