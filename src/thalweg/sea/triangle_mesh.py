"""Nodes and triangles of an unstructured grid."""

from __future__ import annotations

from dataclasses import dataclass

from thalweg.core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and triangles of an unstructured grid.

    Attributes
    ----------
    lat, lon : float64 array (N,)
        Nodes [deg].
    triangles : int64 array (M, 3)
        Indices of nodes.
    """

    lat: FloatArray
    lon: FloatArray
    triangles: IntArray
