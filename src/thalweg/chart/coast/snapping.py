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
HALF_GRID_POINTS: Final = 90  # half the points along a side of the search grid


def nearest_navigable(
    lat: float,
    lon: float,
    *,
    largest: float,
    is_navigable: PositionTest,
    legs_blocked: LegTest,
) -> tuple[float, float, float] | None:
    """Return the nearest navigable place joined to the open sea, and the distance to it [m].

    Grids of 180 x 180 steps are centred on the position, for water within 5 km, 20 km and
    ``largest``. Each grid extends three times as far as its search radius, or 40 km farther.
    Neighbouring points are joined by tested legs. Water that reaches the border of the grid is
    open sea; where none does on the widest grid, the largest connected water is. The result is a
    point of the grid: up to half a step (0.1, 0.3 or 0.5 km) farther than the nearest water.

    Parameters
    ----------
    lat, lon : float
        Position [deg].
    largest : float
        Largest search radius [m].
    is_navigable, legs_blocked : callable
        Tests of positions and of legs, as of `thalweg.chart.Chart`.

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
            if separation[best] <= radius:
                place = lats.ravel()[k[best]], float(geodesy.wrap_longitude(lons.ravel()[k[best]]))
                return float(place[0]), place[1], float(separation[best])
    return None


def _search_grid(lat: float, lon: float, half: float) -> tuple[FloatArray, FloatArray]:
    share = (
        np.arange(-HALF_GRID_POINTS, HALF_GRID_POINTS + 1)
        / HALF_GRID_POINTS
        * half
        / geodesy.METRES_PER_DEGREE
    )
    north = np.clip(lat + share, -90.0, 90.0)
    east = share / max(np.cos(np.radians(lat)), 0.02)
    lats, lons = np.meshgrid(north, lon + np.clip(east, -179.0, 179.0), indexing="ij")
    return lats, lons


def _connected_to_open_sea(
    legs_blocked: LegTest, lats: FloatArray, lons: FloatArray, free: NDArray[np.bool_], last: bool
) -> NDArray[np.bool_]:
    """Return (flat) which free points are joined to the border, or at last the largest water."""
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
    labels = connected_components(graph, directed=False)[1].reshape(free.shape)
    border = np.ones(free.shape, bool)
    border[1:-1, 1:-1] = False
    joined = np.unique(labels[border & free])
    if last and not len(joined) and free.any():
        joined = np.array([np.bincount(labels[free]).argmax()])
    return np.asarray((np.isin(labels, joined) & free).ravel())
