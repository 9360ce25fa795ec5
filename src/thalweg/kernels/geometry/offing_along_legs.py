"""The offing: how near to land a ship may come, tested along whole legs by steps.

A ship keeps a distance from land, the offing. It is smaller in two kinds of places: in discs (round
the ends of a voyage or a canal) and in corridors along named passages. There a smaller distance is
required; it grows with the distance from the disc or corridor by at most one metre a metre, until
it reaches the offing.

A leg is followed in steps. Where land is farther away than the offing, the next step may be as long
as the difference; nearer to land it is half of what is left, as the required distance may grow.
Steps are at least 1 % of the required distance, so that a leg which is called clear is nowhere
nearer to land than 99 % of what is required.
"""

from math import asin, sqrt
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.ellipsoid import MEAN_RADIUS
from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.geometry.geodesic_arc import geodesic_point
from thalweg.kernels.geometry.shore_distance import cell_clearance, nearest_edge

LONGEST_STEP: Final = 2.0  # near coasts, in offings; where none is near, steps are longer
SHORTEST_STEP: Final = 0.01  # of the distance that is required
FINEST_STEP: Final = 2.0  # [m]
TOO_NEAR: Final = 0  # somewhere nearer to land than is required
RELAXED: Final = 1  # as far from land as is required, somewhere nearer than the offing
KEPT: Final = 2  # nowhere nearer to land than the offing
STEP_SHARE: Final = 0.994  # a radian of geocentric direction may be longer than the mean radius


class OffingArrays(NamedTuple):
    """The offing and where a smaller distance from land is allowed.

    Attributes
    ----------
    distance : The offing [m]; 0 for none.
    disc : float64[D, 6]
        Centre as a unit vector, least distance from land inside [m], radius [m], and by how many
        metres the required distance grows for each metre outside.
    box : float64[P, 4]
        Centre of each corridor as a unit vector, and the cosine of the angle that holds it.
    ptr : int64[P + 1]
        First segment of each corridor.
    segment : float64[S, 8]
        Ends of the centre line as two unit vectors, required distance [m], half width [m].
    gate : float64[G, 6]
        Ends of lines that no leg crosses, as two unit vectors; they close passages.
    """

    distance: float
    disc: np.ndarray
    box: np.ndarray
    ptr: np.ndarray
    segment: np.ndarray
    gate: np.ndarray


NO_OFFING: Final = OffingArrays(
    0.0,
    np.zeros((0, 6)),
    np.zeros((0, 4)),
    np.zeros(1, np.int64),
    np.zeros((0, 8)),
    np.zeros((0, 6)),
)


@kernel_only
def _metres_apart(x, y, z, p):
    ax, ay, az = x - p[0], y - p[1], z - p[2]
    return MEAN_RADIUS * sqrt(ax * ax + ay * ay + az * az)


@kernel_only
def _metres_to_segment(x, y, z, s):
    """Return the distance [m] to a segment between the vectors s[0:3] and s[3:6]."""
    ex, ey, ez = s[3] - s[0], s[4] - s[1], s[5] - s[2]
    ax, ay, az = x - s[0], y - s[1], z - s[2]
    square = ex * ex + ey * ey + ez * ez
    share = 0.0 if square == 0.0 else (ax * ex + ay * ey + az * ez) / square
    share = min(max(share, 0.0), 1.0)
    ax, ay, az = ax - share * ex, ay - share * ey, az - share * ez
    return MEAN_RADIUS * sqrt(ax * ax + ay * ay + az * az)


@allocation_free
def required_distance(offing, x, y, z):
    """Return the distance from land [m] that is required at a direction."""
    least = offing.distance
    for k in range(len(offing.disc)):
        disc = offing.disc[k]
        away = _metres_apart(x, y, z, disc)
        least = min(least, disc[3] + disc[5] * max(0.0, away - disc[4]))
    for k in range(len(offing.box)):
        box = offing.box[k]
        if x * box[0] + y * box[1] + z * box[2] < box[3]:
            continue
        for i in range(offing.ptr[k], offing.ptr[k + 1]):
            segment = offing.segment[i]
            if segment[6] < least:
                away = _metres_to_segment(x, y, z, segment)
                least = min(least, segment[6] + max(0.0, away - segment[7]))
    return least


@kernel_only
def _shore_clearance(land, x, y, z, reach):
    """Return a lower bound of the distance to land [m] at a direction in water."""
    clear = cell_clearance(land, x, y, z)
    if clear < reach:
        clear = max(clear, nearest_edge(land, x, y, z, reach))
    return clear


@kernel_only
def offing_kept_at(land, offing, x, y, z):
    """Return whether a direction in open water is as far from land as is required."""
    clear = _shore_clearance(land, x, y, z, offing.distance)
    return clear >= offing.distance or clear >= required_distance(offing, x, y, z)


@kernel_only
def offing_along(land, offing, a, b, chord):
    """Follow a leg between two unit vectors: `TOO_NEAR`, `RELAXED` or `KEPT`.

    A leg that is `KEPT` and begins in water touches no land; one that is `RELAXED` may.
    """
    longest = LONGEST_STEP * offing.distance
    length = 2.0 * asin(min(0.5 * chord, 1.0)) * MEAN_RADIUS
    if length <= longest:  # most short legs are decided at their middle
        p = geodesic_point(a, b, 0.5) if length > 0.0 else a
        half = 0.5 * length / STEP_SHARE
        clear = _shore_clearance(land, p[0], p[1], p[2], offing.distance + half)
        if clear >= offing.distance + half:
            return KEPT
        if clear < offing.distance and clear < required_distance(offing, p[0], p[1], p[2]):
            return TOO_NEAR
    answer = KEPT
    at = 0.0
    p = a
    while True:
        least = SHORTEST_STEP * offing.distance
        reach = offing.distance + min(length - at, longest) / STEP_SHARE
        clear = _shore_clearance(land, p[0], p[1], p[2], reach)
        room = clear - offing.distance
        if room < least:
            required = required_distance(offing, p[0], p[1], p[2])
            if clear < required:
                return TOO_NEAR
            if required < offing.distance:
                answer = RELAXED
                room = max(room, 0.5 * (clear - required))
                least = max(SHORTEST_STEP * required, FINEST_STEP)
        if at >= length:
            return answer
        at = min(at + max(STEP_SHARE * room, least), length)
        p = b if at == length else geodesic_point(a, b, at / length)


@kernel_only
def gate_crossed(offing, a, b):
    """Return whether the arc between two unit vectors crosses a gate."""
    nx, ny, nz = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
    for k in range(len(offing.gate)):
        px, py, pz, qx, qy, qz = offing.gate[k]
        if (nx * px + ny * py + nz * pz) * (nx * qx + ny * qy + nz * qz) > 0.0:
            continue
        mx, my, mz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
        before = mx * a[0] + my * a[1] + mz * a[2]
        after = mx * b[0] + my * b[1] + mz * b[2]
        if before * after > 0.0:
            continue
        # both planes are crossed: on the same half of the globe, not opposite
        x, y, z = a[0] + b[0], a[1] + b[1], a[2] + b[2]
        if x * (px + qx) + y * (py + qy) + z * (pz + qz) > 0.0:
            return True
    return False


@allocation_free
def required_distances(offing, xyz, distance):
    """Fill ``distance`` [m] with what is required at unit vectors (n, 3)."""
    for k in range(len(distance)):
        distance[k] = required_distance(offing, xyz[k, 0], xyz[k, 1], xyz[k, 2])
