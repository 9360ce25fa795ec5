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
