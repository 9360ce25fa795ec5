"""Shortest paths and distances for weights of edges that do not change with time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.network.static_paths import static_astar
from thalweg.network.distance_bounds import distance_bounds
from thalweg.network.network import Graph, Network

NO_NODE = -1


class ShortestPathTree(NamedTuple):
    """Shortest paths from one node to all others.

    Attributes
    ----------
    distance : float64[N]
        Least sum of weights; inf where unreached.
    parent : int64[N]
        Node before each node on its path; -1 at the root and where unreached.
    """

    distance: FloatArray
    parent: IntArray

    def path(self, node: int) -> list[int]:
        """Return the nodes from the root to a node; empty when it is unreached."""
        if not np.isfinite(self.distance[node]):
            return []
        path = [node]
        while self.parent[path[-1]] >= 0:
            path.append(int(self.parent[path[-1]]))
        return path[::-1]


def shortest_path_tree(graph: Graph, weight: FloatArray, root: int) -> ShortestPathTree:
    """Return the shortest paths from a node to all others (Dijkstra, by scipy).

    Parameters
    ----------
    graph : Nodes and directed edges.
    weight : Weight of every edge, not negative, (E,); edges of infinite weight are not used.
    root : Node from which the paths start.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    n = len(graph.indptr) - 1
    table = csr_array((np.asarray(weight, float), graph.target, graph.indptr), shape=(n, n))
    distance, parent = dijkstra(table, indices=root, return_predecessors=True)
    parent = np.where((parent >= 0) & np.isfinite(distance), parent, NO_NODE)
    return ShortestPathTree(distance, parent.astype(np.int64))


def shortest_path(
    network: Network,
    start: int,
    goal: int = NO_NODE,
    *,
    weight: FloatArray | None = None,
    per_metre: float | None = None,
) -> tuple[FloatArray, list[int]]:
    """Return the least sums of edge weights from a node, and the path to the goal.

    Parameters
    ----------
    network : Network
        The network.
    start, goal : int
        Nodes; without a goal (-1) all nodes get their sum and the path is empty.
    weight : ndarray (E,), optional
        Weight of each edge, not negative (default: its length [m]; `Network.times` for time).
    per_metre : float, optional
        Every edge weighs at least this for each metre of the distance between its ends. With it
        the search is directed at the goal (A*). By default 1 for lengths, else 0.

    Returns
    -------
    distance : ndarray (N,)
        Least sums; inf where unreached. With a goal only those along the path are final.
    path : list of int
        Nodes from start to goal; empty when there is no path.
    """
    if per_metre is None:
        per_metre = 1.0 if weight is None else 0.0
    weight = network.edges.length if weight is None else np.asarray(weight, float)
    if goal < 0:
        return shortest_path_tree(network.graph, weight, start).distance, []
    if per_metre <= 0.0:
        tree = shortest_path_tree(network.graph, weight, start)
    else:
        to = float(network.lat[goal]), float(network.lon[goal])
        bound = per_metre * distance_bounds(network.lat, network.lon, *to)
        n = network.n_nodes
        tree = ShortestPathTree(np.empty(n), np.empty(n, np.int64))
        arrays = network.graph.indptr, network.graph.target, weight
        static_astar(*arrays, bound, start, goal, tree.distance, tree.parent)
    return tree.distance, tree.path(goal)


def reversed_graph(network: Network) -> tuple[Graph, IntArray]:
    """Return the graph with all edges reversed, and the original index of each edge."""
    edge = np.argsort(network.graph.target, kind="stable")
    indptr = np.searchsorted(network.graph.target[edge], np.arange(network.n_nodes + 1))
    return Graph(indptr.astype(np.int64), network.tails()[edge]), edge
