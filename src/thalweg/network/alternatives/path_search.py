"""Search for alternative paths: other sides of islands, other canals, other prices."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np

from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.geodesy import distance, format_position
from thalweg.core.types import FloatArray, IntArray
from thalweg.deprecated_names import renamed_arguments
from thalweg.kernels.network.static_paths import tree_sums
from thalweg.network.alternatives.alternative_path import (
    AlternativePath,
    EdgeWeights,
    canal_edges,
    checked_edge_weights,
    path_edges,
    shortened_path,
)
from thalweg.network.alternatives.homotopy import Obstacles, obstacles
from thalweg.network.alternatives.leg_rules import total_cost
from thalweg.network.network import Network
from thalweg.network.shortest_paths import reversed_graph, shortest_path_tree

if TYPE_CHECKING:
    from thalweg.chart import Chart

_Canal = TypeVar("_Canal")
_Found = TypeVar("_Found")

_SMALLEST_ISLAND: Final = 0.02  # islands narrower than this share of the distance do not count
_CANDIDATES_PER_PATH: Final = 3  # homotopy classes considered for each requested path
# paths of one homotopy class differ if their costs differ by more than this fraction
_MIN_COST_DIFFERENCE: Final = 0.005


@renamed_arguments(weighings="edge_weight_sets")
def alternative_paths(
    network: Network,
    chart: Chart,
    *,
    edge_weight_sets: Sequence[EdgeWeights] = (EdgeWeights(),),
    most: int = 4,
    stretch: float = 0.3,
    island: float | None = None,
) -> tuple[AlternativePath, ...]:
    """Return paths that pass land on different sides or use other canals, best first.

    Parameters
    ----------
    network : Network
        With start and goal. Its ``slack`` must be large enough for the alternatives.
    chart : Chart
        The chart it was built for.
    edge_weight_sets : sequence of EdgeWeights, optional
        Costs of the edges, lengths by default. Give several sets when prices differ from place to
        place, such as lengths times 1, 1.2 and 1.56 inside emission control areas.
    most : int, optional
        Largest number of paths.
    stretch : float, optional
        Paths more than ``1 + stretch`` times as costly as the best, by every set of weights, are
        left out.
    island : float, optional
        Land narrower than this [m] (square root of its area) does not separate paths; by default
        2 % of the distance.

    Returns
    -------
    tuple of AlternativePath
        First those that are the best by a set of weights, in the order of the sets, then the others
        by increasing cost. Each is the best of its homotopy class by the weights that favour it
        most. A second path of one class is returned only if it is the best by a set of weights
        and the first costs over 0.5 % more by that set, for example if it avoids a zone.

    Raises
    ------
    NoRouteError
        If no path connects start and goal.
    InputError
        If the network has no start or goal, or a weight is negative or of a wrong shape.

    Notes
    -----
    Two shortest-path trees, from start and from goal, give the least path through every node (the
    plateau method; Abraham et al. 2013, "Alternative routes in road networks"). The homotopy class
    of a path is the number of its signed crossings of the meridian north of each island, on the
    whole globe, with the canals it uses. Two paths of one class can be deformed into each other
    over water (if neither crosses itself).
    """
    _check(network, most, stretch)
    start, goal = network.meta.start, network.meta.goal
    ends = [(float(network.lat[k]), float(network.lon[k])) for k in (start, goal)]
    if island is None:
        island = _SMALLEST_ISLAND * float(distance(*ends[0], *ends[1]))
    seen = obstacles(network, chart, island)
    found: list[_PathClass] = []
    for order, edge_weights in enumerate(edge_weight_sets):
        found += _best_of_each_class(network, seen, edge_weights, order, stretch)[
            : _CANDIDATES_PER_PATH * most
        ]
    found.sort(key=lambda kind: (kind.ratio, kind.order))
    return _shortened_paths(network, chart, seen, found, edge_weight_sets, most)


def without_each_set_of_canals(
    canals: Sequence[_Canal], find: Callable[[tuple[_Canal, ...]], _Found | None]
) -> Iterator[_Found]:
    """Yield what is found with every set of some canals closed, the smaller sets first.

    Parameters
    ----------
    canals : Canals that the best alternative uses.
    find : Called with the closed canals; returns an alternative, or None if there is none.

    Yields
    ------
    object : As returned by ``find``; up to ``2**n - 1`` for n canals.
    """
    for count in range(1, len(canals) + 1):
        for closed in combinations(canals, count):
            other = find(closed)
            if other is not None:
                yield other


@renamed_arguments(weighing="edge_weights")
def paths_without_canals(
    network: Network,
    chart: Chart,
    *,
    edge_weights: EdgeWeights | None = None,
    threshold: float = 0.5,
) -> tuple[AlternativePath, ...]:
    """Return the best path, and the best ones without some of the canals that it uses.

    Parameters
    ----------
    network : Network
        With start and goal, and a ``slack`` of at least the threshold.
    chart : Chart
        The chart it was built for.
    edge_weights : EdgeWeights, optional
        Costs of the edges; by default their lengths.
    threshold : float, optional
        Paths more than ``1 + threshold`` times as costly as the best are left out.

    Returns
    -------
    tuple of AlternativePath
        The best path first. If it uses n canals there are ``2**n - 1`` further searches, one for
        each proper subset of them that stays open; equal paths are returned once.

    Raises
    ------
    NoRouteError
        If no path connects start and goal.
    InputError
        If the network has no start or goal, or a value is out of range.
    """
    _check(network, 1, threshold)
    edge_weights = edge_weights or EdgeWeights()
    weight = checked_edge_weights(network, edge_weights)
    canal = canal_edges(network, chart)
    first = _cheapest_path(network, weight)
    if first is None:
        raise _no_path(network)
    passed = sorted({int(canal[e]) for e in path_edges(network, first[1]) if canal[e] >= 0})
    others = without_each_set_of_canals(
        passed,
        lambda closed: _cheapest_path(network, np.where(np.isin(canal, closed), np.inf, weight)),
    )
    found = {tuple(first[1]): first}
    for other in others:
        if other[0] <= (1.0 + threshold) * first[0]:
            found.setdefault(tuple(other[1]), other)
    paths = sorted(found.values(), key=lambda pair: pair[0])
    return tuple(
        shortened_path(network, chart, np.array(path), cost / first[0], edge_weights)
        for cost, path in paths
    )


@dataclass(frozen=True, eq=False)
class _PathClass:
    """The best path of a homotopy class by one set of weights: relative cost and nodes."""

    signature: bytes
    ratio: float
    order: int
    path: IntArray


def _check(network: Network, most: int, stretch: float) -> None:
    if network.meta.start < 0 or network.meta.goal < 0:
        raise InputError(
            "The network has no start and goal.",
            "Paths are searched from meta.start to meta.goal.",
            "Add them with thalweg.network.with_endpoints.",
        )
    if not (most >= 1 and stretch >= 0.0):
        raise InputError(
            f"A search for {most!r} paths, at most {stretch!r} costlier, is not possible.",
            "The number of paths is 1 or more, the fraction 0 or more.",
            "Give 4 paths and 0.3, for example.",
        )


def _no_path(network: Network) -> NoRouteError:
    ends = [
        format_position(float(network.lat[k]), float(network.lon[k]))
        for k in (network.meta.start, network.meta.goal)
    ]
    return NoRouteError(
        f"There is no path from {ends[0]} to {ends[1]} on this network.",
        "Start and goal must be connected by edges of the network.",
        "Build it with more slack, or allow more canals.",
    )


def _best_of_each_class(
    network: Network, seen: Obstacles, edge_weights: EdgeWeights, order: int, stretch: float
) -> list[_PathClass]:
    """Return the best path of every homotopy class, up to the stretch."""
    weight = checked_edge_weights(network, edge_weights)
    sides = []
    forward = network.graph, np.arange(network.n_edges)
    for root, (graph, edge) in (
        (network.meta.start, forward),
        (network.meta.goal, reversed_graph(network)),
    ):
        tree = shortest_path_tree(graph, weight[edge], root)
        sums = np.zeros((network.n_nodes, seen.crossings.shape[1]), np.int16)
        ranks = np.argsort(tree.distance, kind="stable")
        ranks = ranks[: int(np.isfinite(tree.distance).sum())]
        tree_sums(
            graph.indptr, graph.target, weight[edge], seen.crossings[edge], *tree, ranks, sums
        )
        sides.append((*tree, sums))
    (from_start, previous, crossed), (to_goal, following, to_cross) = sides
    total = from_start + to_goal
    best = float(total[network.meta.start])
    if not np.isfinite(best):
        raise _no_path(network)
    best = float(total.min())  # the same but for rounding
    nodes = np.flatnonzero(total <= (1.0 + stretch) * best)
    nodes = nodes[np.argsort(total[nodes], kind="stable")]
    signature = crossed[nodes] + to_cross[nodes]
    _, first = np.unique(signature, axis=0, return_index=True)
    kinds = []
    for k in np.sort(first):
        path = _path_through_node(previous, following, int(nodes[k]))
        if len(set(path)) == len(path):  # a path that visits a node twice is not an alternative
            ratio = float(total[nodes[k]] / best)
            kinds.append(_PathClass(signature[k].tobytes(), ratio, order, np.array(path)))
    return kinds


def _path_through_node(previous: IntArray, following: IntArray, node: int) -> list[int]:
    """Return the nodes from start to goal through a node, given both trees."""
    path = [node]
    while previous[path[-1]] >= 0:
        path.append(int(previous[path[-1]]))
    path.reverse()
    while following[path[-1]] >= 0:
        path.append(int(following[path[-1]]))
    return path


def _shortened_paths(
    network: Network, chart: Chart, seen: Obstacles, kinds: list[_PathClass],
    edge_weight_sets: Sequence[EdgeWeights], most: int,
) -> tuple[AlternativePath, ...]:  # fmt: skip
    """Return paths after string pulling, each homotopy class once."""
    paths: list[tuple[bytes, AlternativePath]] = []
    known: set[bytes] = set()
    for kind in kinds:
        if len(paths) == most:
            break
        if kind.ratio > 1.0 and kind.signature in known:
            continue
        known.add(kind.signature)
        edge_weights = edge_weight_sets[kind.order]
        route = shortened_path(network, chart, kind.path, kind.ratio, edge_weights, seen.sides)
        signature = seen.along(chart, route.lat, route.lon)
        alike = [other for mark, other in paths if mark == signature]
        if kind.ratio > 1.0 and alike:
            continue
        limit = (1.0 + _MIN_COST_DIFFERENCE) * total_cost(
            (route.lat, route.lon), edge_weights.leg_cost
        )
        if all(total_cost((o.lat, o.lon), edge_weights.leg_cost) > limit for o in alike):
            paths.append((signature, route))
    return tuple(route for _, route in paths)


def _cheapest_path(network: Network, weight: FloatArray) -> tuple[float, list[int]] | None:
    """Return the cost and nodes of the best path, or None."""
    tree = shortest_path_tree(network.graph, weight, network.meta.start)
    path = tree.path(network.meta.goal)
    return (float(tree.distance[network.meta.goal]), path) if path else None
