"""Kernels of static ways over a network: A*, connected waters, and crossings summed along trees."""

import math

import numpy as np

from thalweg.kernels import heap
from thalweg.kernels.jit import jit


@jit
def static_astar(indptr, target, weight, potential, start, goal, distance, parent):
    """Fill least sums of weights from ``start`` until ``goal`` is settled (A*).

    Parameters
    ----------
    indptr, target
        The edges by tail.
    weight : float64[E]
        Not negative.
    potential : float64[N]
        Lower bound of the sum from each node to the goal; consistent: it falls along an edge by
        no more than the edge's weight.
    start, goal : int
    distance, parent : float64[N], int64[N]
        Filled as by `thalweg.kernels.graph.static_distances`; final for settled nodes only.

    Returns
    -------
    int
        Nodes settled.
    """
    n = indptr.shape[0] - 1
    nodes, keys = np.empty(n, np.int32), np.empty(n)
    place = np.full(n, -1, np.int32)
    settled = np.zeros(n, np.bool_)
    distance[:] = math.inf
    parent[:] = -1
    distance[start] = 0.0
    size = heap.put(nodes, keys, place, 0, start, potential[start])
    count = 0
    while size > 0:
        node, _, size = heap.take(nodes, keys, place, size)
        settled[node] = True
        count += 1
        if node == goal:
            break
        for e in range(indptr[node], indptr[node + 1]):
            other = target[e]
            reach = distance[node] + weight[e]
            if not settled[other] and reach < distance[other]:
                distance[other] = reach
                parent[other] = node
                size = heap.put(nodes, keys, place, size, other, reach + potential[other])
    return count


@jit
def connected_waters(n, first, second):
    """Return for every node the smallest node it is joined to (union by path halving)."""
    root = np.arange(n)
    for e in range(first.shape[0]):
        a, b = first[e], second[e]
        while root[a] != a:
            root[a] = root[root[a]]
            a = root[a]
        while root[b] != b:
            root[b] = root[root[b]]
            b = root[b]
        if a < b:
            root[b] = a
        else:
            root[a] = b
    for i in range(n):  # a root is below its nodes, so it is final before them
        root[i] = root[root[i]]
    return root
