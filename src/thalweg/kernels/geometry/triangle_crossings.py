"""Walking straight lines through a triangulation: which sides they cross, and where."""

import math
from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit

MAX_SIDES = 256  # crossed by one line
_MIN_GAP = 1e-5  # crossings closer than this share of the line are one


class Triangulation(NamedTuple):
    """Triangles of nodes in a plane.

    Attributes
    ----------
    x, y : float64[N]
        Nodes.
    triangles, neighbours : int32[M, 3]
        Nodes of each triangle, and the triangle opposite each node (-1: none).
    around_ptr, around : int64[N + 1], int32[...]
        The triangles around each node.
    """

    x: np.ndarray
    y: np.ndarray
    triangles: np.ndarray
    neighbours: np.ndarray
    around_ptr: np.ndarray
    around: np.ndarray


@jit
def crossed_sides(mesh, first, second, out, ptr):
    """Find the sides that lines between nodes cross; with an empty output only count them.

    Parameters
    ----------
    mesh : Triangulation
    first, second : int32[L]
        Ends of the lines.
    out : tuple (a int32[V], b int32[V], w float32[V], s float32[V])
        Filled: the crossing is at ``(1 - w) * a + w * b`` and at share s of its line.
    ptr : int64[L + 1]
        Filled: the crossings of line e are ``ptr[e]:ptr[e + 1]``.

    Notes
    -----
    Delaunay triangles cover the hull of their nodes, so a line leaves them by rounding alone, along
    the rim; what is beyond is not sampled.
    """
    fill = out[0].shape[0] > 0
    count = 0
    for e in range(first.shape[0]):
        ptr[e] = count
        a, b = first[e], second[e]
        triangle, left, right = _exit_side(mesh, a, b)
        before = 0.0
        for _ in range(MAX_SIDES):
            if triangle < 0:
                break
            s, w = _crossing(mesh.x, mesh.y, a, b, left, right)
            if s - before > _MIN_GAP and s < 1.0 - _MIN_GAP:
                if fill:
                    out[0][count], out[1][count] = left, right
                    out[2][count], out[3][count] = w, s
                count += 1
                before = s
            triangle, left, right = _next_side(mesh, triangle, left, right, a, b)
    ptr[first.shape[0]] = count


@kernel_only
def _side_of(x, y, a, b, c):
    """Return twice the area of a, b, c: positive if c is to the left of a to b."""
    return (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a])


@kernel_only
def _exit_side(mesh, a, b):
    """Return (triangle, left, right): the side of a triangle at a through which a line leaves.

    The triangle is -1 if b is joined to a.
    """
    x, y, triangles, _, around_ptr, around = mesh
    for k in range(around_ptr[a], around_ptr[a + 1]):
        t = around[k]
        for j in range(3):
            if triangles[t, j] == b:
                return -1, -1, -1
    best, chosen, left, right = -math.inf, -1, -1, -1
    for k in range(around_ptr[a], around_ptr[a + 1]):
        t = around[k]
        j = 0 if triangles[t, 0] == a else 1 if triangles[t, 1] == a else 2
        p, q = triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
        if _side_of(x, y, a, p, q) < 0.0:
            p, q = q, p
        # counter-clockwise a, p, q: the line must pass between p (right) and q (left)
        inside = min(_side_of(x, y, a, p, b), -_side_of(x, y, a, q, b))
        if inside > best:
            best, chosen, left, right = inside, t, q, p
    return chosen, left, right


@jit
def _crossing(x, y, a, b, left, right):
    """Return (share of the line a to b, weight from left to right) where it crosses a side."""
    over, under = _side_of(x, y, a, b, left), -_side_of(x, y, a, b, right)
    w = over / (over + under) if over + under != 0.0 else 0.5
    w = min(max(w, 0.0), 1.0)
    px = x[left] + w * (x[right] - x[left])
    py = y[left] + w * (y[right] - y[left])
    dx, dy = x[b] - x[a], y[b] - y[a]
    return ((px - x[a]) * dx + (py - y[a]) * dy) / (dx * dx + dy * dy), w


@kernel_only
def _next_side(mesh, triangle, left, right, a, b):
    """Return the next (triangle, left, right) beyond a side; -1 when there is none."""
    triangles, neighbours = mesh.triangles, mesh.neighbours
    far = -1
    for j in range(3):
        if triangles[triangle, j] != left and triangles[triangle, j] != right:
            far = neighbours[triangle, j]
    if far < 0:
        return -1, -1, -1
    corner = -1
    for j in range(3):
        if triangles[far, j] != left and triangles[far, j] != right:
            corner = triangles[far, j]
    if corner == b:
        return -1, -1, -1
    if _side_of(mesh.x, mesh.y, a, b, corner) > 0.0:
        return far, corner, right
    return far, left, corner
