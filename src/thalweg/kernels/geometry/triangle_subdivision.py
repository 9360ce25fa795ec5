"""Kernels of the geodesic grid: edges that cross a coast, and leaf faces joined without holes."""

from math import asin, ceil, sqrt

import numpy as np

from thalweg.kernels.compilation.decorators import allocation_free, kernel_only
from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.geometry.arc_edges import arc_frame, edges_of_cell_touched
from thalweg.kernels.geometry.coast_index import LONGEST_ARC, cell_exit
from thalweg.kernels.geometry.cube_sphere import (
    FIRST_ROW,
    column_of,
    face_components,
    face_of,
    unit_vector,
)
from thalweg.kernels.geometry.geodesic_arc import geodesic_point

_MAX_HALVINGS = 64  # more halvings of an edge than any grid has


@kernel_only
def _arc_crosses(index, m, e, tan_half):
    """Return whether an arc of at most `LONGEST_ARC` touches an outline, inland or at sea."""
    side, cell = index.side, index.cell
    arc, near = arc_frame(m, e, tan_half)
    big = min(3.0 / side, 0.1)
    tau = -tan_half
    while tau < tan_half:
        x, y, z = m[0] + tau * e[0], m[1] + tau * e[1], m[2] + tau * e[2]
        face = face_of(x, y, z)
        u, v, w = face_components(x, y, z, face)
        i, j = column_of(u / w, side), column_of(v / w, side)
        value = cell[(face * side + j) * side + i]
        if value > big:
            tau = (tau + value) / (1.0 - tau * value)
            continue
        if value <= FIRST_ROW:
            row = int(FIRST_ROW - value)
            if edges_of_cell_touched(index, row, arc, near, 0.0) == 1:
                return True
        tau = cell_exit(m, e, face, i, j, side, tau)
    return False


@allocation_free
def outlines_crossed(index, lat1, lon1, lat2, lon2, crossed):
    """Fill ``crossed`` (bool): whether legs [deg] touch an outline of polygons.

    A leg that is wholly inside a polygon, or outside, does not; legs may be as long as 160
    degrees.
    """
    for i in range(len(crossed)):
        a, b = unit_vector(lat1[i], lon1[i]), unit_vector(lat2[i], lon2[i])
        x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        chord = sqrt(x * x + y * y + z * z)
        arcs = max(1, ceil(2.0 * asin(min(0.5 * chord, 1.0)) / LONGEST_ARC))
        crossed[i] = False
        p = a
        for piece in range(arcs):
            q = b if piece == arcs - 1 else geodesic_point(a, b, (piece + 1.0) / arcs)
            mx, my, mz = p[0] + q[0], p[1] + q[1], p[2] + q[2]
            ex, ey, ez = q[0] - p[0], q[1] - p[1], q[2] - p[2]
            lm, le = sqrt(mx * mx + my * my + mz * mz), sqrt(ex * ex + ey * ey + ez * ez)
            m, e = (mx / lm, my / lm, mz / lm), (ex / le, ey / le, ez / le)
            if _arc_crosses(index, m, e, le / lm):
                crossed[i] = True
                break
            p = q


@kernel_only
def find_midpoint(keys, middles, a, b):
    """Return the vertex in the middle of edge a-b, or -1 where it is not halved.

    ``keys`` (int64, ascending) are ``smaller * 2**31 + larger`` of the halved edges.
    """
    key = (np.int64(min(a, b)) << 31) + max(a, b)
    low, high = 0, keys.shape[0]
    while low < high:
        middle = (low + high) >> 1
        if keys[middle] < key:
            low = middle + 1
        else:
            high = middle
    if low < keys.shape[0] and keys[low] == key:
        return middles[low]
    return -1


@kernel_only
def _walk_boundary(keys, middles, faces, f, ring, sides, stack):
    """Fill the boundary of a leaf face, hanging vertices included; return its length.

    ``sides`` has a bit for each side a vertex is on (corners have two).
    """
    count = 0
    for s in range(3):
        here, end = faces[f, s], faces[f, (s + 1) % 3]
        bits = (1 << s) | (1 << ((s + 2) % 3))
        stack[0] = end
        depth = 1
        while depth > 0:
            middle = find_midpoint(keys, middles, here, stack[depth - 1])
            if middle >= 0:
                stack[depth] = middle
                depth += 1
                continue
            if count < ring.shape[0]:
                ring[count] = here
                sides[count] = bits
            count += 1
            bits = 1 << s
            depth -= 1
            here = stack[depth]
    return count


@jit
def leaf_face_pairs(keys, middles, faces, longest, first, second):
    """List the pairs of vertices that join leaf faces without holes; empty outputs only count.

    Parameters
    ----------
    keys, middles : int64[H]
        Halved edges as in `find_midpoint`.
    faces : int64[F, 3]
        Leaf faces.
    longest : int
        No boundary has more vertices than this; 0 to find it.
    first, second : int32[P]
        Filled. Pairs on the common side of two faces come twice.

    Returns
    -------
    pairs, longest : How many pairs there are, and the longest boundary.

    Notes
    -----
    Neighbours along the boundary are joined, and every two of its vertices that are not on one
    side: a face is convex, so such a pair crosses the face itself.
    """
    room = max(longest, 1)
    ring, sides = np.empty(room, np.int64), np.empty(room, np.int64)
    stack = np.empty(_MAX_HALVINGS, np.int64)
    count, most = 0, 0
    for f in range(faces.shape[0]):
        size = _walk_boundary(keys, middles, faces, f, ring, sides, stack)
        most = max(most, size)
        if longest == 0:
            continue
        for i in range(size):
            for j in range(i + 1, size):
                beside = j == i + 1 or (i == 0 and j == size - 1)
                if beside or (sides[i] & sides[j]) == 0:
                    if first.shape[0] > 0:
                        first[count] = ring[i]
                        second[count] = ring[j]
                    count += 1
    return count, most
