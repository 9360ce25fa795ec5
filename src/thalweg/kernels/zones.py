"""Which legs lie inside polygons, for legs that touch no outline."""

from math import sqrt

from thalweg.kernels.bare import bare
from thalweg.kernels.cube import inside, unit_vector


@bare
def middle_inside(index, lat1, lon1, lat2, lon2):
    """Return whether the middle of a leg [deg] lies inside the polygons of an index.

    Ends that lie on an outline to the last bit say nothing; the middle of a leg that touches none
    does. It is that of the great ellipse, some metres from the geodesic on the longest legs.
    """
    ax, ay, az = unit_vector(lat1, lon1)
    bx, by, bz = unit_vector(lat2, lon2)
    x, y, z = ax + bx, ay + by, az + bz
    length = sqrt(x * x + y * y + z * z)
    if length < 1e-9:
        return inside(index, ax, ay, az)
    return inside(index, x / length, y / length, z / length)


@bare
def middles_inside(index, lat1, lon1, lat2, lon2, within):
    """Fill ``within`` (bool) for many legs; see `middle_inside`."""
    for i in range(len(within)):
        within[i] = middle_inside(index, lat1[i], lon1[i], lat2[i], lon2[i])
