"""Positions, courses and lengths along a great circle; every kernel that sails a leg uses them.

Legs are great circles of the sphere of geographic latitudes, measured on WGS 84 with the local
radii of curvature; they differ in length from geodesics by less than 1e-6.
"""

import math

from thalweg.core.ellipsoid import EQUATORIAL_RADIUS
from thalweg.kernels.compilation.decorators import inlined

_ECCENTRICITY2 = 6.69437999014e-3  # `ECCENTRICITY_SQUARED` to 12 digits, as routes have it
_RADIANS = math.pi / 180.0
_SHORTEST_ARC = 1e-12  # [rad], below which a leg has no length


@inlined
def great_circle(lat1, lon1, lat2, lon2):
    """Return (a, f, arc) of the great circle between two positions [deg].

    The unit vector ``a`` is the start, ``f`` the unit tangent there, so that a point at an angle
    ``w`` from the start is ``cos(w) a + sin(w) f``; ``arc`` is the angle to the end [rad], 0 for a
    leg without length.
    """
    lat1, lat2 = lat1 * _RADIANS, lat2 * _RADIANS
    lon1, lon2 = lon1 * _RADIANS, lon2 * _RADIANS
    ax, ay, az = math.cos(lat1) * math.cos(lon1), math.cos(lat1) * math.sin(lon1), math.sin(lat1)
    bx, by, bz = math.cos(lat2) * math.cos(lon2), math.cos(lat2) * math.sin(lon2), math.sin(lat2)
    cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    sine = math.sqrt(cx * cx + cy * cy + cz * cz)
    if sine < _SHORTEST_ARC:
        return (ax, ay, az), (0.0, 0.0, 0.0), 0.0
    arc = math.atan2(sine, ax * bx + ay * by + az * bz)
    f = ((cy * az - cz * ay) / sine, (cz * ax - cx * az) / sine, (cx * ay - cy * ax) / sine)
    return (ax, ay, az), f, arc


@inlined
def great_circle_point(a, f, sine, cosine):
    """Return (lat [deg], lon [deg], east, north, scale) at an angle from the start.

    ``a`` and ``f`` as `great_circle` returns them; (east, north) is the unit vector of the course
    and ``scale`` the length of a radian there [m].
    """
    px, py, pz = (
        cosine * a[0] + sine * f[0],
        cosine * a[1] + sine * f[1],
        cosine * a[2] + sine * f[2],
    )
    dx, dy, dz = (
        cosine * f[0] - sine * a[0],
        cosine * f[1] - sine * a[1],
        cosine * f[2] - sine * a[2],
    )
    level = math.sqrt(px * px + py * py)
    east = (px * dy - py * dx) / level
    north = dz * level - pz * (px * dx + py * dy) / level
    w2 = 1.0 / (1.0 - _ECCENTRICITY2 * pz * pz)
    prime = EQUATORIAL_RADIUS * math.sqrt(w2)  # radius of curvature in the prime vertical
    east, north = east * prime, north * prime * (1.0 - _ECCENTRICITY2) * w2
    scale = math.sqrt(east * east + north * north)
    lat, lon = math.atan2(pz, level) / _RADIANS, math.atan2(py, px) / _RADIANS
    return lat, lon, east / scale, north / scale, scale
