"""Distance to the shore: exact near it, a lower bound at larger distances."""

from math import asin, sqrt

import numpy as np

from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.cube_sphere import (
    FIRST_ROW,
    column_of,
    face_components,
    face_of,
    inside,
    unit_vector,
)


@kernel_only
def _squared_distance(x, y, z, p, q):
    """Return the squared chord from a point to an edge between two vertices."""
    ex, ey, ez = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    ax, ay, az = x - p[0], y - p[1], z - p[2]
    square = ex * ex + ey * ey + ez * ez
    share = 0.0 if square == 0.0 else (ax * ex + ay * ey + az * ez) / square
    share = min(max(share, 0.0), 1.0)
    ax, ay, az = ax - share * ex, ay - share * ey, az - share * ez
    return ax * ax + ay * ay + az * az


@kernel_only
def _nearest_in_row(index, row, x, y, z, best):
    for k in range(index.start[row], index.start[row + 1]):
        if index.first[k] == 0:
            best = min(best, _squared_distance(x, y, z, index.xyz[k - 1], index.xyz[k]))
    return best


@kernel_only
def _nearest_within(index, x, y, z, radius):
    """Return the squared chord to the nearest edge in cells touched by a disc [rad]."""
    best = np.inf
    side = index.side
    for face in range(6):
        u, v, w = face_components(x, y, z, face)
        if w < 0.5:
            continue
        u, v = u / w, v / w
        reach = radius * (1.0 + u * u + v * v) * 1.05
        if abs(u) > 1.0 + reach or abs(v) > 1.0 + reach:
            continue
        for j in range(column_of(v - reach, side), column_of(v + reach, side) + 1):
            for i in range(column_of(u - reach, side), column_of(u + reach, side) + 1):
                value = index.cell[(face * side + j) * side + i]
                if value <= FIRST_ROW:
                    best = _nearest_in_row(index, int(FIRST_ROW - value), x, y, z, best)
    return best


@kernel_only
def cell_clearance(index, x, y, z):
    """Return a lower bound [m] of the distance to the edges from the cell of a direction alone."""
    side = index.side
    face = face_of(x, y, z)
    u, v, w = face_components(x, y, z, face)
    value = index.cell[(face * side + column_of(v / w, side)) * side + column_of(u / w, side)]
    # 0.9943: the least length of a radian of geocentric direction, over the mean radius
    return value * MEAN_RADIUS * 0.9943


@kernel_only
def nearest_edge(index, x, y, z, radius):
    """Return the distance [m] to the nearest edge within a radius [m], else the radius."""
    square = _nearest_within(index, x, y, z, radius / MEAN_RADIUS * 1.006)
    return min(radius, 2.0 * asin(min(sqrt(square) / 2.0, 1.0)) * MEAN_RADIUS * 0.9943)


@allocation_free
def shore_distances(index, lat, lon, cap, distance):
    """Fill ``distance`` [m] with a lower bound of the distance to the nearest edge of an index.

    Inside the polygons it is 0; within ``cap`` [m] (at most 250 km) of an edge it is the true
    distance to a part in 1000; elsewhere it is at least ``cap``.
    """
    for k in range(len(distance)):
        x, y, z = unit_vector(lat[k], lon[k])
        if not abs(lat[k]) <= 90.0 or inside(index, x, y, z):
            distance[k] = 0.0
            continue
        clear = cell_clearance(index, x, y, z)
        radius = 4000.0
        found = cap
        while clear < cap:
            radius = min(radius, cap)
            square = _nearest_within(index, x, y, z, radius / MEAN_RADIUS * 1.006)
            if square <= (radius / MEAN_RADIUS) ** 2 or radius == cap:
                found = min(cap, 2.0 * asin(min(sqrt(square) / 2.0, 1.0)) * MEAN_RADIUS * 0.9943)
                break
            radius *= 3.0
        distance[k] = max(clear, found)
