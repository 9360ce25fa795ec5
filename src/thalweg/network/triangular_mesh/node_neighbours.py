"""Neighbours by rings: how many edges of a triangulation lie between two nodes."""

from __future__ import annotations

from typing import Any

import numpy as np

from thalweg.core.types import Int32Array, IntArray


def adjacency(triangles: IntArray, n: int) -> Any:
    """Return the symmetric adjacency of a triangulation as a sparse boolean matrix."""
    from scipy.sparse import coo_array

    a, b, c = np.asarray(triangles).T
    rows, columns = np.concatenate([a, b, c, b, c, a]), np.concatenate([b, c, a, a, b, c])
    return coo_array((np.ones(len(rows), bool), (rows, columns)), shape=(n, n)).tocsr()


def pairs_by_ring(triangles: IntArray, n: int, rings: int) -> list[tuple[Int32Array, Int32Array]]:
    """Return for ring 1, 2, ... the pairs (a < b) of nodes that many edges apart."""
    near = adjacency(triangles, n).astype(np.int8)
    reached, known = near, np.empty(0, np.int64)
    result = []
    for _ in range(rings):
        entries = reached.tocoo()
        upper = entries.row < entries.col
        keys = entries.row[upper].astype(np.int64) * n + entries.col[upper]
        new = np.setdiff1d(keys, known)
        result.append(((new // n).astype(np.int32), (new % n).astype(np.int32)))
        known = np.union1d(known, keys)
        reached = ((reached @ near) > 0).astype(np.int8)
    return result


def influence(triangles: IntArray, a: int, b: int, *, rings: int = 3) -> set[int]:
    """Return the nodes that influence the edge from a to b.

    ``{a, b}`` and, for L = 1 .. m - 1, the nodes within L rings of both a and b, where m is the
    number of rings between a and b: van Halem (2019), section 3.2. A choice of samples that needs
    no interpolation; the `mesh` builder samples edges along their length instead.

    Parameters
    ----------
    triangles : int ndarray (M, 3)
        The triangulation.
    a, b : int
        Nodes, at most ``rings`` rings apart.
    rings : int, optional
        Farthest ring searched.

    Returns
    -------
    set of int
        Only a and b when they are farther apart.
    """
    near = adjacency(triangles, int(np.max(triangles)) + 1)
    from_a, from_b = [{a}], [{b}]
    for within in (from_a, from_b):
        for _ in range(rings):
            wider = {int(k) for node in within[-1] for k in _row(near, node)}
            within.append(within[-1] | wider)
    order = next((m for m in range(rings + 1) if b in from_a[m]), 0)
    shared = (from_a[ring] & from_b[ring] for ring in range(1, order))
    return {a, b}.union(*shared)


def _row(matrix: Any, node: int) -> IntArray:
    return np.asarray(matrix.indices[matrix.indptr[node] : matrix.indptr[node + 1]])
