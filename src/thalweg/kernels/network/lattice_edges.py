"""Kernels that find the neighbours of lattice points, and where edges cross lattice lines."""

from typing import NamedTuple

import numpy as np

from thalweg.kernels.compilation.jit import jit


class LatticeRows(NamedTuple):
    """The points of a lattice by row.

    Attributes
    ----------
    i0 : Number of the first row.
    row_ptr : int64[R + 1], col : int32[P]
        Row ``i0 + r`` holds the columns ``col[row_ptr[r]:row_ptr[r + 1]]``, ascending.
    wrap : Rows that go round the globe; 0: no wrapping.
    """

    i0: int
    row_ptr: np.ndarray
    col: np.ndarray
    wrap: int


class LatticePairs(NamedTuple):
    """Pairs of lattice points one offset apart: first point and number of the offset.

    Attributes
    ----------
    point : int32[P], offset : int8[P]
    di, dj : int64[M]
        Offsets, one of each opposite pair.
    """

    point: np.ndarray
    offset: np.ndarray
    di: np.ndarray
    dj: np.ndarray


class LineSamples(NamedTuple):
    """Samples of pairs where they cross lines: between which nodes, with which weights.

    Attributes
    ----------
    a, b : int32[V]
        Nodes on both sides of the crossing; -1: a point is missing.
    w : float32[V]
        Weight of b.
    s : float32[V]
        Share of the length of the pair.
    """

    a: np.ndarray
    b: np.ndarray
    w: np.ndarray
    s: np.ndarray


@jit(inline="always")
def find_point(i, j, rows):
    """Return the index of lattice point (i, j) in rows sorted by column, or -1."""
    i0, row_ptr, col, wrap = rows
    if wrap > 0:
        i = i0 + (i - i0) % wrap
    r = i - i0
    if r < 0 or r >= row_ptr.shape[0] - 1:
        return -1
    lo = row_ptr[r]
    hi = row_ptr[r + 1]
    if lo == hi:
        return -1
    guess = lo + j - col[lo]
    if guess < lo:
        return -1
    if guess < hi and col[guess] == j:
        return guess
    hi = min(hi, guess + 1)
    while lo < hi:
        middle = (lo + hi) >> 1
        if col[middle] < j:
            lo = middle + 1
        else:
            hi = middle
    if lo < row_ptr[r + 1] and col[lo] == j:
        return lo
    return -1


@jit
def lattice_pairs(rows, di, dj, first, second, offset):
    """List the pairs of points one offset apart; with empty outputs only count them.

    Parameters
    ----------
    rows : LatticeRows
    di, dj : int64[M]
        Offsets, one of each opposite pair.
    first, second : int32[P], offset : int8[P]
        Filled with the pairs and the number of their offset.

    Returns
    -------
    int : Number of pairs.
    """
    i0, row_ptr, col, _ = rows
    fill = first.shape[0] > 0
    count = 0
    for r in range(row_ptr.shape[0] - 1):
        for p in range(row_ptr[r], row_ptr[r + 1]):
            for k in range(di.shape[0]):
                q = find_point(i0 + r + di[k], col[p] + dj[k], rows)
                if q >= 0 and q != p:
                    if fill:
                        first[count] = p
                        second[count] = q
                        offset[count] = k
                    count += 1
    return count


@jit
def lattice_samples(rows, node, row, pairs, via_ptr, samples):
    """Fill the samples of pairs where they cross lattice lines.

    A pair with offset (x, y) crosses ``max(|x|, |y|) - 1`` lattice lines between its ends, each
    between two neighbouring points of the line.

    Parameters
    ----------
    rows : LatticeRows
    node, row : int32[P]
        Node and row of each lattice point.
    pairs : LatticePairs
    via_ptr : int64[E + 1]
        The samples of pair e are ``via_ptr[e]:via_ptr[e + 1]``.
    samples : LineSamples
        Filled.
    """
    col = rows.col
    point, offset, di, dj = pairs
    a, b, w, s = samples
    for e in range(point.shape[0]):
        x = di[offset[e]]
        y = dj[offset[e]]
        m = max(abs(x), abs(y))
        i = row[point[e]]
        j = col[point[e]]
        for k in range(1, m):
            v = via_ptr[e] + k - 1
            s[v] = k / m
            if abs(x) >= abs(y):
                i1 = i + (k if x > 0 else -k)
                low = (k * y) // m
                weight = (k * y - low * m) / m
                p = find_point(i1, j + low, rows)
                q = find_point(i1, j + low + 1, rows)
            else:
                j1 = j + (k if y > 0 else -k)
                low = (k * x) // m
                weight = (k * x - low * m) / m
                p = find_point(i + low, j1, rows)
                q = find_point(i + low + 1, j1, rows)
            if p < 0 or q < 0:
                a[v] = -1
                b[v] = -1
                w[v] = 0.0
            else:
                a[v] = node[p]
                b[v] = node[q]
                w[v] = weight
