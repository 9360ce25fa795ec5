"""Points on a geodesic in geocentric unit vectors, to first order in the flattening.

`thalweg.kernels.geometry.coast_index` states the formula and its error.
"""

from math import atan2, cos, sin, sqrt, tan

from thalweg.core.ellipsoid import FLATTENING
from thalweg.kernels.compilation.decorators import kernel_only


@kernel_only
def plane_offset(k, mz, ez, half, tan_half, t):
    """Return the offset of the geodesic from the plane at the angle t from its middle."""
    s, c = sin(t), cos(t)
    return k * (mz * (t * s - half * tan_half * c) + ez * (half * s / tan_half - t * c))


@kernel_only
def geodesic_point(a, b, share):
    """Return the unit vector at a share of the leg's angle, on the geodesic to first order."""
    mx, my, mz = a[0] + b[0], a[1] + b[1], a[2] + b[2]
    ex, ey, ez = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    lm, le = sqrt(mx * mx + my * my + mz * mz), sqrt(ex * ex + ey * ey + ez * ez)
    mx, my, mz, ex, ey, ez = mx / lm, my / lm, mz / lm, ex / le, ey / le, ez / le
    half = atan2(le, lm)
    t = half * (2.0 * share - 1.0)
    nx, ny, nz = my * ez - mz * ey, mz * ex - mx * ez, mx * ey - my * ex
    d = plane_offset(-FLATTENING * nz, mz, ez, half, tan(half), t)
    s, c = sin(t), cos(t)
    x, y, z = c * mx + s * ex + d * nx, c * my + s * ey + d * ny, c * mz + s * ez + d * nz
    length = sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length
