"""Ways of a network that differ from the fastest: round islands, by passages, farther off land.

They are its shortest paths (round islands those of a network of all water between the ends),
straightened as far as land allows, at the fastest route's speed. A mile in shoals, penalty zones
and against lanes counts more in all of them, as in plans.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from operator import itemgetter
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import legs_through, names_passed
from thalweg.core.errors import NoRouteError
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import Network, alternative_paths
from thalweg.network.alternatives.alternative_path import EdgeWeights
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.assembly import allowed_legs
from thalweg.network.shortest_paths import ShortestPathTree, reversed_graph, shortest_path_tree
from thalweg.planning.indicators.passage_ways import way_by_passage
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.request.offing_choice import chart_off_land
from thalweg.route import Route, Track
from thalweg.route.refinement.track_geometry import course_changes

#: Offings of the route farther off land, tried in turn: at least [nm], and times the voyage's own.
_WIDER_OFFINGS: Final = ((4.0, 2.0), (3.0, 1.5), (2.0, 1.25))
_DETOUR: Final = 0.35  # ways that are longer by this share of the shortest are left out
_BACK: Final = np.radians(120.0)  # larger turns in a passage lead back out of it
_ISLAND_WAYS, _PASSAGE_WAYS, _ROUNDS = 3, 5, 3  # rounds of string pulling


@dataclass(frozen=True)
class OtherWays:
    """Ways that differ from the fastest route, at its departure and speed.

    Attributes
    ----------
    trade_off : Its chart, ends and offing.
    fastest : Scored by the referee.
    """

    trade_off: TradeOffContext
    fastest: Route

    @property
    def chart(self) -> Chart:
        """The chart of the voyage."""
        return self.trade_off.context.chart

    def round_islands(self, network: Network) -> Iterator[Track]:
        """Yield the shortest ways on the other sides of islands."""
        for path in alternative_paths(
            network,
            self.chart,
            edge_weight_sets=(self._weights(network),),
            most=_ISLAND_WAYS,
            stretch=_DETOUR,
        )[1:]:
            yield self._at_full_speed(*np.array(path.waypoints, float).T)

    def farther_off_land(self, network: Network) -> Iterator[Track]:
        """Yield the shortest way with the widest offing that joins the ends."""
        chart, ends = self.chart, self.trade_off.ends
        edges = network.lat, network.lon, network.tails(), network.graph.target
        fixed, own = np.isfinite(network.edges.fixed_time), self.trade_off.limits.offing
        for least, times in _WIDER_OFFINGS:
            wider = max(least * NAUTICAL_MILE, times * own)
            off_land = chart_off_land(chart, ends, wider)
            weight = self._open(network, allowed_legs(off_land, *edges)[0] | fixed)
            tree = shortest_path_tree(network.graph, weight, network.meta.start)
            path = tree.path(network.meta.goal)
            if path:
                yield self._pulled(network, off_land, path)
                return
        raise NoRouteError(
            "the ends cannot be joined farther off land.",
            "The network has no such path.",
            "Give a wider offing to plan for it.",
            reasons={},
        )

    def round_passages(self, network: Network) -> Iterator[Track]:
        """Yield the shortest way without each passage of the fastest route."""
        chart, through = self.chart, self._through(network)
        shortest = self._trees(network)[0].distance[network.meta.goal]
        for name in self._passed(through)[:_PASSAGE_WAYS]:
            weight = self._open(network, ~through[name])
            tree = shortest_path_tree(network.graph, weight, network.meta.start)
            path = tree.path(network.meta.goal)
            if path and tree.distance[network.meta.goal] <= (1.0 + _DETOUR) * shortest:
                yield self._pulled(network, chart.without_passages(name), path)

    def by_passages(self, network: Network) -> Iterator[Track]:
        """Yield the shortest ways by the passages that the fastest route does not pass."""
        chart, track = self.chart, self.fastest.track
        passed = set(names_passed(chart.coastline, chart.passages, track.lat, track.lon))
        trees = self._trees(network)
        longest = (1.0 + _DETOUR) * trees[0].distance[network.meta.goal]
        others = [passage for passage in chart.passages if passage.name not in passed]
        ways = [way_by_passage(chart, network, passage, trees) for passage in others]
        found = sorted((way for way in ways if way and way.length <= longest), key=itemgetter(0))
        cost = self._weights(network).leg_cost
        for way in found[:_PASSAGE_WAYS]:
            parts = [
                string_pull_path(chart, *line, leg_cost=cost, rounds=_ROUNDS)
                for line in (way.before, way.after)
            ]
            lat, lon = (np.concatenate([parts[0][k], parts[1][k][1:]]) for k in (0, 1))
            if abs(course_changes(lat, lon)[len(parts[0][0]) - 2]) < _BACK:  # else not through it
                yield self._at_full_speed(lat, lon)

    def _trees(self, network: Network) -> tuple[ShortestPathTree, ShortestPathTree]:
        """Return the trees of shortest paths from the start and to the goal."""
        graph, edge = reversed_graph(network)
        weight = self._open(network, np.ones(network.n_edges, bool))
        return (
            shortest_path_tree(network.graph, weight, network.meta.start),
            shortest_path_tree(graph, weight[edge], network.meta.goal),
        )

    def _weights(self, network: Network) -> EdgeWeights:
        """Return the weights of ways: a mile counts more where it does so in plans."""
        return EdgeWeights.penalised(network, self.chart)

    def _open(self, network: Network, keep: NDArray[np.bool_]) -> FloatArray:
        """Return the weights of the edges of a network, infinite where they are closed."""
        return np.where(keep, np.asarray(self._weights(network).weight), np.inf)

    def _through(self, network: Network) -> dict[str, NDArray[np.bool_]]:
        """Return which edges lead through each passage, by its name."""
        chart, tails, heads = self.chart, network.tails(), network.graph.target
        legs = network.lat[tails], network.lon[tails], network.lat[heads], network.lon[heads]
        return legs_through(chart.coastline, chart.passages, legs)

    def _passed(self, through: dict[str, NDArray[np.bool_]]) -> list[str]:
        """Return the passages of the fastest route among some."""
        chart, track = self.chart, self.fastest.track
        lat, lon = np.asarray(track.lat, float), np.asarray(track.lon, float)
        names = names_passed(chart.coastline, chart.passages, lat, lon)
        return [name for name in names if name in through]

    def _pulled(self, network: Network, chart: Chart, path: list[int]) -> Track:
        """Return a path of the network, straightened on a chart."""
        cost = self._weights(network).leg_cost
        lat, lon = network.lat[path], network.lon[path]
        return self._at_full_speed(
            *string_pull_path(chart, lat, lon, leg_cost=cost, rounds=_ROUNDS)
        )

    def _at_full_speed(self, lat: FloatArray, lon: FloatArray) -> Track:
        """Return a line as a track with the departure and the speed of the fastest route."""
        track = self.fastest.track
        setting = int(np.max(track.setting))
        return Track(lat, lon, self.fastest.depart, setting=np.full(len(lat) - 1, setting))
