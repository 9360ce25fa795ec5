"""Polygons on the faces of a cube: cells of positions, and tests whether they are inside.

A position becomes the unit vector of its geocentric latitude. Seen from the centre of the Earth
onto the faces of a cube (gnomonic projection) great-circle arcs are straight lines, and the poles
and the antimeridian need no special treatment. Each face has ``side`` x ``side`` cells; a cell
holds the edges that cross it and the winding number at its middle.
"""

from math import atan2, cos, hypot, pi, sin, sqrt
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.ellipsoid import AXIS_RATIO_SQUARED, MEAN_RADIUS
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only

DEGREE: Final = pi / 180.0
BULGE: Final = 1.3 / MEAN_RADIUS  # most an edge's arc leaves the straight line in lon, lat [rad]
ALL_LAND: Final = -1.0
FIRST_ROW: Final = -2.0  # cell values from here down are rows of edges


class IndexArrays(NamedTuple):
    """Polygons on a cube grid.

    Attributes
    ----------
    side : Cells along a side of a face.
    cell : float32[6 * side * side]
        Positive: no edges, and none within this angle [rad] of any point of the cell, outside
        the polygons; -1: no edges, inside; -2 - row: the edges of that row.
    start : int64[rows + 1]
        Where each row's vertices begin.
    winding : int32[rows]
        Winding number at the middle of the row's cell.
    xyz : float64[vertices, 3]
        Chains of edges as unit vectors.
    first : uint8[vertices]
        1 where a new chain begins.
    """

    side: int
    cell: np.ndarray
    start: np.ndarray
    winding: np.ndarray
    xyz: np.ndarray
    first: np.ndarray


@allocation_free
def unit_vector(lat, lon):
    """Return the unit vector of the geocentric direction of a position [deg]."""
    c, s = cos(lat * DEGREE), AXIS_RATIO_SQUARED * sin(lat * DEGREE)
    scale = 1.0 / sqrt(c * c + s * s)
    c *= scale
    return c * cos(lon * DEGREE), c * sin(lon * DEGREE), s * scale


@kernel_only
def face_components(x, y, z, face):
    """Return a vector's components (u, v, w) on a face: w outward, u and v across."""
    if face == 0:
        return y, z, x
    if face == 1:
        return y, z, -x
    if face == 2:
        return z, x, y
    if face == 3:
        return z, x, -y
    if face == 4:
        return x, y, z
    return x, y, -z


@kernel_only
def vector_from_face(u, v, w, face):
    """Return the vector whose components on a face are (u, v, w)."""
    if face == 0:
        return w, u, v
    if face == 1:
        return -w, u, v
    if face == 2:
        return v, w, u
    if face == 3:
        return v, -w, u
    if face == 4:
        return u, v, w
    return u, v, -w


@kernel_only
def face_of(x, y, z):
    """Return the face of the cube that a vector points through."""
    ax, ay, az = abs(x), abs(y), abs(z)
    if ax >= ay and ax >= az:
        return 0 if x > 0.0 else 1
    if ay >= az:
        return 2 if y > 0.0 else 3
    return 4 if z > 0.0 else 5


@kernel_only
def column_of(u, side):
    """Return which of a face's columns holds u in [-1, 1]."""
    return min(max(int((u + 1.0) * 0.5 * side), 0), side - 1)


@allocation_free
def latitude_longitude(x, y, z):
    """Return the position [deg] of a geocentric direction."""
    return atan2(z, AXIS_RATIO_SQUARED * hypot(x, y)) / DEGREE, atan2(y, x) / DEGREE


@kernel_only
def _side_of_edge(p, q, point):
    """Return on which side of the edge p, q, straight in lon and lat, a near point is."""
    plat, plon = latitude_longitude(p[0], p[1], p[2])
    qlat, qlon = latitude_longitude(q[0], q[1], q[2])
    lat, lon = latitude_longitude(point[0], point[1], point[2])
    east = (qlon - plon + 540.0) % 360.0 - 180.0
    here = (lon - plon + 540.0) % 360.0 - 180.0
    return east * (lat - plat) - here * (qlat - plat)


@kernel_only
def winding_from(index, row, a, b, winding, exact):
    """Return the winding number at a, given that at b; both are in the row's cell."""
    ax, ay, az = a
    bx, by, bz = b
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    xyz, first = index.xyz, index.first
    before = False
    for k in range(index.start[row], index.start[row + 1]):
        qx, qy, qz = xyz[k, 0], xyz[k, 1], xyz[k, 2]
        here = nx * qx + ny * qy + nz * qz >= 0.0
        if first[k] == 0 and here != before:
            px, py, pz = xyz[k - 1, 0], xyz[k - 1, 1], xyz[k - 1, 2]
            ex, ey, ez = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
            side_a = ex * ax + ey * ay + ez * az
            side_b = ex * bx + ey * by + ez * bz
            if exact and side_a * side_a < 4.0 * BULGE * BULGE * (ex * ex + ey * ey + ez * ez):
                side_a = _side_of_edge((px, py, pz), (qx, qy, qz), a)
            if (side_a >= 0.0) != (side_b >= 0.0):
                winding += 1 if side_a >= 0.0 else -1
        before = here
    return winding


@allocation_free
def cell_middle(face, i, j, side):
    """Return the direction (not of unit length) of the middle of a cell; halves are allowed."""
    return vector_from_face((2.0 * i + 1.0) / side - 1.0, (2.0 * j + 1.0) / side - 1.0, 1.0, face)


@allocation_free
def inside(index, x, y, z):
    """Return whether a direction is inside the polygons of an index."""
    side = index.side
    face = face_of(x, y, z)
    u, v, w = face_components(x, y, z, face)
    i, j = column_of(u / w, side), column_of(v / w, side)
    value = index.cell[(face * side + j) * side + i]
    if value > FIRST_ROW:
        return value < 0.0
    row = int(FIRST_ROW - value)
    middle = cell_middle(face, i, j, side)
    return winding_from(index, row, (x, y, z), middle, index.winding[row], True) != 0
