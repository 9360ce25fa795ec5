"""Fraction of a leg inside polygons."""

from math import atan2, cos, sin, sqrt
from typing import Final

from thalweg.core.ellipsoid import ECCENTRICITY_SQUARED
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.coast_index import SHORTEST_ARC, outline_touched
from thalweg.kernels.geometry.cube_sphere import inside, unit_vector
from thalweg.kernels.geometry.geodesic_arc import geodesic_point

MAX_TESTS: Final = 2048  # of one leg, before crossings are found less finely


@kernel_only
def middle_inside(index, lat1, lon1, lat2, lon2):
    """Return whether the middle of a leg [deg] is inside the polygons of an index.

    Ends exactly on an outline are undecided; the middle of a leg that touches no outline is not. It
    is that of the great ellipse, some metres from the geodesic on the longest legs.
    """
    ax, ay, az = unit_vector(lat1, lon1)
    bx, by, bz = unit_vector(lat2, lon2)
    x, y, z = ax + bx, ay + by, az + bz
    length = sqrt(x * x + y * y + z * z)
    if length < 1e-9:
        return inside(index, ax, ay, az)
    return inside(index, x / length, y / length, z / length)


@allocation_free
def middles_inside(index, lat1, lon1, lat2, lon2, within):
    """Fill ``within`` (bool) for many legs; see `middle_inside`."""
    for i in range(len(within)):
        within[i] = middle_inside(index, lat1[i], lon1[i], lat2[i], lon2[i])


@kernel_only
def _metres_per_radian(a, b, arc, share):
    """Return metres per radian [in polar radii] on the great ellipse at a share of its angle."""
    t = arc * share
    p, q = sin(arc - t) / sin(arc), sin(t) / sin(arc)
    z = p * a[2] + q * b[2]
    rise = (cos(t) * b[2] - cos(arc - t) * a[2]) / sin(arc)  # dz / dt
    w = 1.0 / (1.0 - ECCENTRICITY_SQUARED * (1.0 - z * z))
    slope = ECCENTRICITY_SQUARED * z * rise * w  # of the radius, over the radius
    return sqrt(w * (1.0 + slope * slope))


@kernel_only
def _fraction_inside(index, outlines, a, b, finest):
    """Return (share of the length of a leg inside, tests made); see `fractions_by_bisection`."""
    dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    chord = sqrt(x * x + y * y + z * z)
    if chord < SHORTEST_ARC:
        return (1.0 if inside(index, a[0], a[1], a[2]) else 0.0), 0
    arc = 2.0 * atan2(0.5 * chord, sqrt(max(0.5 + 0.5 * dot, 0.0)))
    # the scale is a parabola through three places; its integral gives lengths
    first, middle, last = (
        _metres_per_radian(a, b, arc, 0.0),
        _metres_per_radian(a, b, arc, 0.5),
        _metres_per_radian(a, b, arc, 1.0),
    )
    one, two = 0.5 * (4.0 * middle - 3.0 * first - last), 2.0 * (first - 2.0 * middle + last) / 3.0
    total, tests, k, depth = 0.0, 0, 0, 0
    while True:
        size = 1.0 / (1 << depth)
        low, high = k * size, (k + 1) * size
        if size * arc > finest and tests < MAX_TESTS:
            p = a if k == 0 else geodesic_point(a, b, low)
            q = b if high == 1.0 else geodesic_point(a, b, high)
            tests += 1
            if outline_touched(outlines, p, q):
                k, depth = 2 * k, depth + 1
                continue
        m = geodesic_point(a, b, 0.5 * (low + high))
        if inside(index, m[0], m[1], m[2]):
            total += high * (first + high * (one + high * two))
            total -= low * (first + low * (one + low * two))
        k += 1
        while depth > 0 and k % 2 == 0:
            k, depth = k // 2, depth - 1
        if depth == 0:
            return total / (first + one + two), tests


@allocation_free
def fractions_by_bisection(index, outlines, lat1, lon1, lat2, lon2, finest, share):
    """Fill the share of the length of short geodesic legs [deg] inside the polygons of an index.

    A leg that touches an outline is halved, and each half again, until the parts are shorter than
    ``finest`` [rad]; parts that touch
    none, or are so short, are classified by their midpoint. A leg that
    runs along an outline would take very many parts: they are left eight times longer then. The
    legs are at most some hundred kilometres long (`geodesic_point` gives how near the geodesic
    its points are).
    """
    for i in range(len(share)):
        a, b, step = unit_vector(lat1[i], lon1[i]), unit_vector(lat2[i], lon2[i]), finest
        share[i], tests = _fraction_inside(index, outlines, a, b, step)
        while tests >= MAX_TESTS:
            step *= 8.0
            share[i], tests = _fraction_inside(index, outlines, a, b, step)
