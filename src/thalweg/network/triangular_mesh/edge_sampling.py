"""Networks on a model's nodes, sampled where their edges cross the sides of its triangles.

The fields of a model are linear in each triangle. So the values where an edge crosses the sides of
triangles determine the values along the whole edge, and only values at nodes are stored.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.types import IntArray
from thalweg.kernels.geometry.triangle_crossings import Triangulation, crossed_sides
from thalweg.network.conformal_projection import mercator_projection
from thalweg.network.network import Network, Samples, Stations


def sampled_on_triangle_sides(network: Network) -> Network:
    """Return the network with its samples on the sides of the Delaunay triangles of its nodes.

    Parameters
    ----------
    network : Its nodes; edges are straight lines between them.

    Returns
    -------
    Network : The same nodes and edges; its stations are its nodes.
    """
    from scipy.spatial import Delaunay

    lat, lon = network.lat, network.lon
    middle = (float(lat.mean()), float(lon[0]))
    x, y = mercator_projection(middle, 1.0, latitude=middle[0]).from_positions(lat, lon)
    mesh = Delaunay(np.column_stack([x, y]))
    triangles = np.ascontiguousarray(mesh.simplices, np.int32)
    neighbours = np.ascontiguousarray(mesh.neighbors, np.int32)
    around_ptr, around = _triangles_around_nodes(triangles, len(lat))
    lines = network.tails(), np.ascontiguousarray(network.graph.target, np.int32)
    triangulation = Triangulation(x, y, triangles, neighbours, around_ptr, around)
    ptr = np.zeros(len(network.graph.target) + 1, np.int64)
    out = _output_size(0)
    for _ in range(2):
        crossed_sides(triangulation, *lines, out, ptr)
        if out[0].size or ptr[-1] == 0:
            break
        out = _output_size(int(ptr[-1]))
    a, b, w, s = out
    return replace(network, stations=Stations(lat, lon, len(lat)), samples=Samples(ptr, a, b, w, s))


def _output_size(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    whole, real = np.int32, np.float32
    return (
        np.empty(count, whole),
        np.empty(count, whole),
        np.empty(count, real),
        np.empty(count, real),
    )


def _triangles_around_nodes(triangles: np.ndarray, count: int) -> tuple[IntArray, np.ndarray]:
    """Return the triangles around each node."""
    node = triangles.ravel()
    order = np.argsort(node, kind="stable")
    ptr = cumulative_sums(np.bincount(node, minlength=count))
    return ptr.astype(np.int64), (order // 3).astype(np.int32)
