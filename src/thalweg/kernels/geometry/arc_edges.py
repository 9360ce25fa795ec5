"""Arcs of a leg against the edges of a coast index.

`thalweg.kernels.geometry.coast_index` states the formula of the geodesic and its error.
"""

from math import atan, atan2
from typing import NamedTuple

from thalweg.core.ellipsoid import FLATTENING
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.geometry.cube_sphere import BULGE, latitude_longitude, unit_vector
from thalweg.kernels.geometry.geodesic_arc import plane_offset


class ArcFrame(NamedTuple):
    """An arc of a leg and its frame.

    Attributes
    ----------
    m, e, n : (float, float, float)
        Unit vectors: the direction of its middle, the direction along it there, and the normal of
        its plane.
    k : Curvature of the geodesic against the plane, ``-f n_z``.
    tan_half : Tangent of half its angle.
    """

    m: tuple
    e: tuple
    n: tuple
    k: float
    tan_half: float


@kernel_only
def arc_frame(m, e, tan_half):
    """Return the `ArcFrame` of an arc, and how near to its plane edges matter."""
    n = (m[1] * e[2] - m[2] * e[1], m[2] * e[0] - m[0] * e[2], m[0] * e[1] - m[1] * e[0])
    k = -FLATTENING * n[2]
    near = abs(k) * tan_half * tan_half * (1.01 * abs(m[2]) + 0.4 * tan_half) + BULGE
    return ArcFrame(m, e, n, k, tan_half), near


@kernel_only
def _edge_cut(arc, p, q, half, unsure):
    """Test an edge near the leg in fine pieces: 0 clear, 1 touched, 2 unsure."""
    m, e, n, k, tan_half = arc
    plat, plon = latitude_longitude(p[0], p[1], p[2])
    qlat, qlon = latitude_longitude(q[0], q[1], q[2])
    east = (qlon - plon + 540.0) % 360.0 - 180.0
    s0 = t0 = 0.0
    answer = 0
    for piece in range(65):
        share = piece / 64.0
        x, y, z = p[0], p[1], p[2]
        if piece == 64:
            x, y, z = q[0], q[1], q[2]
        elif piece > 0:
            x, y, z = unit_vector(plat + share * (qlat - plat), plon + share * east)
        t1 = atan2(x * e[0] + y * e[1] + z * e[2], x * m[0] + y * m[1] + z * m[2])
        s1 = x * n[0] + y * n[1] + z * n[2] - plane_offset(k, m[2], e[2], half, tan_half, t1)
        if abs(t1) <= half and abs(s1) < unsure:
            answer = 2
        if piece > 0 and s0 * s1 <= 0.0:
            t = t0 if s0 == s1 else t0 + (t1 - t0) * s0 / (s0 - s1)
            if abs(t) <= half * (1.0 + 1e-13) + 1e-15:
                if unsure == 0.0 or min(abs(s0), abs(s1)) > unsure:
                    return 1
                answer = 2
        s0, t0 = s1, t1
    return answer


@kernel_only
def _edge_touched(arc, p, q, unsure):
    """Test one edge that is near the leg's plane: 0 clear, 1 touched, 2 unsure."""
    m, e, n, k, tan_half = arc
    half = atan(tan_half)
    t0 = atan2(p[0] * e[0] + p[1] * e[1] + p[2] * e[2], p[0] * m[0] + p[1] * m[1] + p[2] * m[2])
    t1 = atan2(q[0] * e[0] + q[1] * e[1] + q[2] * e[2], q[0] * m[0] + q[1] * m[1] + q[2] * m[2])
    if min(t0, t1) > half + BULGE or max(t0, t1) < -half - BULGE:
        return 0
    s0 = p[0] * n[0] + p[1] * n[1] + p[2] * n[2] - plane_offset(k, m[2], e[2], half, tan_half, t0)
    s1 = q[0] * n[0] + q[1] * n[1] + q[2] * n[2] - plane_offset(k, m[2], e[2], half, tan_half, t1)
    near = BULGE + unsure
    if (s0 > near and s1 > near) or (s0 < -near and s1 < -near):
        return 0
    if (s0 > near and s1 < -near) or (s0 < -near and s1 > near):
        across, along = abs(s0 - s1), abs(t0 - t1)
        slack = BULGE * (1.0 + 2.0 * (across + along) / across)
        beyond = abs(t0 + (t1 - t0) * s0 / (s0 - s1)) - half
        if beyond > slack:
            return 0
        if beyond < -slack:
            return 1
    return _edge_cut(arc, p, q, half, unsure)


@kernel_only
def edges_of_cell_touched(index, row, arc, near, unsure):
    """Test the edges of one cell: 0 clear, 1 touched, 2 unsure."""
    xyz, first = index.xyz, index.first
    nx, ny, nz = arc.n
    answer = 0
    s0 = 0.0
    for i in range(index.start[row], index.start[row + 1]):
        s1 = nx * xyz[i, 0] + ny * xyz[i, 1] + nz * xyz[i, 2]
        if not ((s0 > near and s1 > near) or (s0 < -near and s1 < -near)) and first[i] == 0:
            p = (xyz[i - 1, 0], xyz[i - 1, 1], xyz[i - 1, 2])
            q = (xyz[i, 0], xyz[i, 1], xyz[i, 2])
            touched = _edge_touched(arc, p, q, unsure)
            if touched == 1:
                return 1
            answer = max(answer, touched)
        s0 = s1
    return answer
