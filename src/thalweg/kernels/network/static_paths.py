"""Static shortest paths on a network: A*, and meridian crossings summed along path trees."""

import math

import numpy as np

from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.search import heap


@jit
def static_astar(indptr, target, weight, potential, start, goal, distance, parent):
    """Fill least sums of weights from ``start`` until ``goal`` is settled (A*).

    A goal of -1 and a potential of zero fill those of all nodes (Dijkstra).

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
        Filled: inf and -1 where unreached; final for settled nodes only.

    Returns
    -------
    int : Nodes settled.
    """
    n = indptr.shape[0] - 1
    nodes, keys = np.empty(n, np.int32), np.empty(n)
    place = np.full(n, -1, np.int32)
    settled = np.zeros(n, np.bool_)
    distance[:] = math.inf
    parent[:] = -1
    distance[start] = 0.0
    size = heap.push_or_lower(nodes, keys, place, 0, start, potential[start])
    count = 0
    while size > 0:
        node, _, size = heap.pop_least(nodes, keys, place, size)
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
                size = heap.push_or_lower(nodes, keys, place, size, other, reach + potential[other])
    return count


@jit
def tree_sums(indptr, target, weight, value, distance, parent, order, sums):
    """Sum values of edges along a tree of shortest paths.

    Parameters
    ----------
    indptr, target, weight
        Graph the tree was found on.
    value : int8[E, K]
        Values of its edges.
    distance, parent : float64[N], int64[N]
        The tree.
    order : int64[M]
        Reached nodes by distance, the root first.
    sums : int16[N, K]
        Filled for these nodes; zero before.
    """
    for i in range(order.shape[0]):
        node = order[i]
        up = parent[node]
        if up < 0:
            continue
        best = -1
        for e in range(indptr[up], indptr[up + 1]):
            if target[e] == node and distance[up] + weight[e] == distance[node]:
                best = e
                break
        if best >= 0:
            for k in range(sums.shape[1]):
                sums[node, k] = sums[up, k] + value[best, k]


@jit
def meridian_crossings(lat, lon, first, second, points, crossings):
    """Count how legs cross the meridians north of points.

    Parameters
    ----------
    lat, lon : float64[N]
        Positions [deg].
    first, second : int64[E]
        Ends of each leg, which spans less than 180 degrees of longitude.
    points : float64[K, 2]
        Latitude and longitude [deg] of each point.
    crossings : int8[E, K]
        Filled: +1 for each crossing eastward of the meridian from the point to the north pole, -1
        westward.
    """
    for e in range(first.shape[0]):
        a, b = first[e], second[e]
        pa, pb = math.radians(lat[a]), math.radians(lat[b])
        for k in range(points.shape[0]):
            # which side a position is on depends on it alone, so that legs meet without gaps
            east_a = (lon[a] - points[k, 1] + 540.0) % 360.0 - 180.0
            east_b = (lon[b] - points[k, 1] + 540.0) % 360.0 - 180.0
            crossings[e, k] = 0
            if (east_a < 0.0) == (east_b < 0.0) or abs(east_b - east_a) >= 180.0:
                continue
            la, lb = math.radians(east_a), math.radians(east_b)
            rise = math.sin(pb) * math.cos(pa) * math.sin(la)
            rise -= math.sin(pa) * math.cos(pb) * math.sin(lb)
            run = math.cos(pa) * math.cos(pb) * math.sin(la - lb)
            at = pa if run == 0.0 else math.atan(rise / run)
            if at > math.radians(points[k, 0]):
                crossings[e, k] = 1 if east_b >= 0.0 else -1
