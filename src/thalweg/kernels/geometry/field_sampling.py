"""Kernels that find points in triangles and gather values from grids; no physics.

Interpolation in space is a weighted sum over the corners of a cell, in time between two levels.
A corner or level of weight 0 is not read; any other that is NaN makes the answer NaN.
"""

from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.jit import jit

#: Least barycentric weight that still counts as inside: positions of six decimals at the edge of a
#: mesh are in it.
INSIDE_TOLERANCE = -1e-3
_BIN_MARGIN = 1e-3  # of the size of a bin, for the same reason


class TriangleBins(NamedTuple):
    """Triangles sorted into square bins of a plane.

    Attributes
    ----------
    x, y : float64[M, 3]
        Corners of the triangles.
    corners : int64[M, 3]
        Their nodes.
    frame : float64[4]
        x0, y0, bin width, bin height.
    shape : (int, int)
        Rows and columns of bins.
    start : int64[rows * columns + 1]
        First item of each bin.
    items : int64[:]
        Triangles whose bounding box meets each bin.
    """

    x: np.ndarray
    y: np.ndarray
    corners: np.ndarray
    frame: np.ndarray
    shape: tuple
    start: np.ndarray
    items: np.ndarray


@jit(inline="always")
def corner_sum(values, level, index, weight, i):
    """Return the weighted sum over the corners of point ``i`` at one time level."""
    total = 0.0
    for c in range(index.shape[1]):
        w = weight[i, c]
        if w != 0.0:
            total += w * values[level, index[i, c]]
    return total


@jit
def gather_points(values, index, weight, level, fraction, out):
    """Interpolate ``values`` (T, M) at points with their own times into ``out`` (N,).

    ``level`` is the time level before each point (-1 where unknown), ``fraction`` the share of the
    step to the next; ``index`` (N, C) holds corners, -1 in its first column where the
    point is outside.
    """
    for i in range(out.shape[0]):
        if level[i] < 0 or index[i, 0] < 0:
            out[i] = np.nan
            continue
        value = corner_sum(values, level[i], index, weight, i)
        f = fraction[i]
        if f != 0.0:
            value += f * (corner_sum(values, level[i] + 1, index, weight, i) - value)
        out[i] = value


@jit
def gather_series(values, index, weight, level, fraction, out):
    """Interpolate ``values`` (T, M) at points for all of the given times into ``out`` (N, K)."""
    for k in range(out.shape[1]):  # one level at a time stays in the processor's cache
        for i in range(out.shape[0]):
            if level[k] < 0 or index[i, 0] < 0:
                out[i, k] = np.nan
                continue
            value = corner_sum(values, level[k], index, weight, i)
            f = fraction[k]
            if f != 0.0:
                value += f * (corner_sum(values, level[k] + 1, index, weight, i) - value)
            out[i, k] = value


@jit
def count_bins(x, y, frame, counts):
    """Count, for each bin, the triangles (M, 3) whose bounding box meets it.

    ``frame`` is (x0, y0, bin width, bin height); ``counts`` (rows, columns).
    """
    rows, columns = counts.shape
    for t in range(x.shape[0]):
        c1, c2, r1, r2 = bin_range(x, y, t, frame, rows, columns)
        for r in range(r1, r2 + 1):
            for c in range(c1, c2 + 1):
                counts[r, c] += 1


@jit
def fill_bins(x, y, frame, shape, places, items):
    """Write the triangles of each bin; ``places`` is where each bin's next one goes."""
    rows, columns = shape
    for t in range(x.shape[0]):
        c1, c2, r1, r2 = bin_range(x, y, t, frame, rows, columns)
        for r in range(r1, r2 + 1):
            for c in range(c1, c2 + 1):
                b = r * columns + c
                items[places[b]] = t
                places[b] += 1


@jit
def bin_range(x, y, t, frame, rows, columns):
    """Return first and last column and row of bins that triangle ``t`` may meet."""
    left = min(x[t, 0], x[t, 1], x[t, 2])
    right = max(x[t, 0], x[t, 1], x[t, 2])
    low = min(y[t, 0], y[t, 1], y[t, 2])
    high = max(y[t, 0], y[t, 1], y[t, 2])
    c1 = max(0, min(columns - 1, int((left - frame[0]) / frame[2] - _BIN_MARGIN)))
    c2 = max(0, min(columns - 1, int((right - frame[0]) / frame[2] + _BIN_MARGIN)))
    r1 = max(0, min(rows - 1, int((low - frame[1]) / frame[3] - _BIN_MARGIN)))
    r2 = max(0, min(rows - 1, int((high - frame[1]) / frame[3] + _BIN_MARGIN)))
    return c1, c2, r1, r2


@jit
def find_triangles(px, py, bins, triangle, weight):
    """Find the triangle that holds each point and its barycentric weights.

    ``bins`` is a `TriangleBins`; ``triangle`` (N,) gets -1 where there is none; ``weight`` (N, 3)
    sums to 1. Just outside the mesh (`INSIDE_TOLERANCE`) the nearest triangle is used, with no
    weight below 0.
    """
    x, y, _, frame, (rows, columns), start, items = bins
    for i in range(px.shape[0]):
        triangle[i] = -1
        fc = (px[i] - frame[0]) / frame[2]
        fr = (py[i] - frame[1]) / frame[3]
        over, under = columns + _BIN_MARGIN, rows + _BIN_MARGIN
        if not (-_BIN_MARGIN <= fc <= over and -_BIN_MARGIN <= fr <= under):
            continue
        best = INSIDE_TOLERANCE
        b = min(rows - 1, max(0, int(fr))) * columns + min(columns - 1, max(0, int(fc)))
        for k in range(start[b], start[b + 1]):
            t = items[k]
            ax, ay = x[t, 0], y[t, 0]
            bx, by = x[t, 1] - ax, y[t, 1] - ay
            cx, cy = x[t, 2] - ax, y[t, 2] - ay
            qx, qy = px[i] - ax, py[i] - ay
            area = bx * cy - by * cx
            if area == 0.0:
                continue
            w1 = (qx * cy - qy * cx) / area
            w2 = (bx * qy - by * qx) / area
            w0 = 1.0 - w1 - w2
            least = min(w0, w1, w2)
            if least > best:
                best = least
                w0, w1, w2 = max(w0, 0.0), max(w1, 0.0), max(w2, 0.0)
                total = w0 + w1 + w2
                weight[i, 0], weight[i, 1], weight[i, 2] = w0 / total, w1 / total, w2 / total
                triangle[i] = t
                if least >= 0.0:
                    break


@jit
def average_at_nodes(values, start, face, weight, out):
    """Average face values (T, F) at nodes into ``out`` (T, N), over the faces that are known."""
    for t in range(values.shape[0]):
        for n in range(out.shape[1]):
            total = 0.0
            share = 0.0
            for k in range(start[n], start[n + 1]):
                value = values[t, face[k]]
                if not np.isnan(value):
                    total += weight[k] * value
                    share += weight[k]
            out[t, n] = total / share if share > 0.0 else np.nan
