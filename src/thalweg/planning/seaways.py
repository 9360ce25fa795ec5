"""The waters that ships use on a chart, and the shortest ways over them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canals import exclude_canals
from thalweg.chart.depth.shoals import Shoals
from thalweg.chart.offing import disc_at, required_offing
from thalweg.chart.passages import find_passages, split_avoided
from thalweg.core.geodesy import Position, distance, wrap_longitude
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.path_shortening import LegCost, leg_lengths, string_pull_path
from thalweg.network.global_grid.endpoint_attachment import LinePlaces
from thalweg.network.global_grid.sea_graph import (
    ICE_LATITUDES,
    GraphClosures,
    outside_ice,
    path_length,
)
from thalweg.network.global_grid.sea_graph_cache import sea_graph
from thalweg.planning.request.voyage_endpoints import Endpoint

_ROUNDS: Final = 4  # passes of string pulling; each may double the waypoints of a corner
#: A way off land that is longer than the one along the coast by more than this has bends.
_MOST_LONGER: Final = 1.01
_NEAR_LAND: Final = 3.0  # what a mile nearer to land than required counts more, beside the graph
_SHARES: Final = (np.arange(9) + 0.5) / 9.0  # of a leg, where its distance from land is looked up
_BEND: Final = 6.0 * NAUTICAL_MILE


@dataclass(frozen=True, eq=False)
class Seaways:
    """A chart with what ways over it may not use.

    Attributes
    ----------
    chart : Without the passages for small or local ships.
    canals : Names of canals of the chart that are not used.
    passages : Names of passages of the chart that are not used.
    shoals : Shoal water, in which a mile counts more.
    """

    chart: Chart
    canals: tuple[str, ...] = ()
    passages: tuple[str, ...] = ()
    shoals: Shoals | None = None

    @classmethod
    def of_chart(cls, chart: Chart, avoid: Sequence[str], *, opened: Sequence[str] = ()) -> Seaways:
        """Return the seaways of a chart without canals and passages to avoid.

        Parameters
        ----------
        avoid : Names of canals and passages; "all" for all canals.
        opened : Passages for small or local ships that may be used.

        Raises
        ------
        InputError : If a name is unknown; the message lists similar names.
        """
        every = [name for name in avoid if name.strip().casefold() == "all"]
        canals, passages = split_avoided([name for name in avoid if name not in every])
        left = exclude_canals(chart.canals, [*every, *canals])
        used = find_passages(opened)
        small = small_passages(chart) - {passage.name for passage in used}
        chart = chart.without_passages(*sorted(small)) if small else chart
        shut = tuple(canal.name for canal in chart.canals if canal not in left)
        open_names = {passage.name for passage in chart.passages}
        return cls(chart, shut, tuple(p.name for p in passages if p.name in open_names))

    @classmethod
    def of_ship_chart(cls, chart: Chart) -> Seaways:
        """Return the seaways of the world without what the chart of a plan closes.

        They have all passages for small ships, or none, so that few graphs are made.
        """
        every = world_chart()
        opened = sorted(small_passages(every)) if small_passages(chart) else ()
        world = cls.of_chart(every, (), opened=opened)
        canals = {canal.name for canal in chart.canals}
        shut = tuple(canal.name for canal in world.chart.canals if canal.name not in canals)
        open_here = {passage.name for passage in world.chart.passages}
        closed = tuple(p.name for p in chart.closed_passages if p.name in open_here)
        return cls(world.chart, shut, closed)

    def without(self, name: str) -> Seaways:
        """Return the seaways with one more canal or passage closed, by its name."""
        if name in {canal.name for canal in self.chart.canals}:
            return replace(self, canals=(*self.canals, name))
        return replace(self, passages=(*self.passages, name))

    @property
    def _open_chart(self) -> Chart:
        return self.chart.without_passages(*self.passages) if self.passages else self.chart

    def graph_path(self, start: Endpoint, goal: Endpoint) -> list[Position]:
        """Return the waypoints of the shortest way over the graph, without string pulling.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        places = (start.lat, start.lon), (goal.lat, goal.lon)
        return sea_graph(self.chart).path(self._open_chart, *places, self._closures)

    def path_between_lines(
        self, start: LinePlaces, goal: LinePlaces
    ) -> tuple[list[Position], tuple[int, int]]:
        """Return the shortest way between two lines: `SeaGraph.path_between_lines`."""
        graph = sea_graph(self.chart)
        return graph.path_between_lines(self._open_chart, start, goal, self._closures)

    @property
    def _closures(self) -> GraphClosures:
        """What the graph may not use, and its shoals."""
        canals = self.chart.canals
        closed = [k for k, canal in enumerate(canals) if canal.name in self.canals]
        return GraphClosures(closed, find_passages(self.passages), self.shoals)

    def path(self, start: Endpoint, goal: Endpoint, *, offing: float) -> list[Position]:
        """Return the waypoints of the shortest way between two end points.

        Parameters
        ----------
        offing : Distance from land [m] that is kept outside passages, ends and canals where the
            graph has water so far from land.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        ends = (start.lat, start.lon), (goal.lat, goal.lon)
        if float(distance(*ends[0], *ends[1])) < 1.0:
            return [ends[0]]
        chart = self._open_chart
        path = self.graph_path(start, goal)
        if outside_ice(*ends):
            chart = chart.within(*ICE_LATITUDES, -180.0, 180.0)
        discs = [disc_at(chart.coastline, end) for end in ends]
        off_land = chart.with_offing(offing, discs=discs)
        lat, lon = np.array(path).T
        canal = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
        ends_of_canals = np.flatnonzero(np.asarray(canal) >= 0) + 1
        return [place for part in np.split(np.array(path), ends_of_canals)
                for place in self._pulled(chart, off_land, part)]  # fmt: skip

    def _pulled(self, chart: Chart, off_land: Chart, part: FloatArray) -> list[Position]:
        """Return a stretch between canals after string pulling, the same in both directions."""
        if tuple(part[0]) > tuple(part[-1]):  # string pulling depends on the direction
            return self._pulled(chart, off_land, part[::-1])[::-1]
        if self.shoals is None or len(part) < 3:
            return _pulled(chart, off_land, part)
        shoals = self.shoals
        off_land_cost = _cost_off_land(off_land)

        def cost(*leg: FloatArray) -> FloatArray:
            return np.asarray(off_land_cost(*leg) + leg_lengths(*leg) * shoals.excess(*leg))

        lat, lon = string_pull_path(chart, *part.T, leg_cost=cost, rounds=_ROUNDS)
        return _places(lat, lon)


@lru_cache(maxsize=1)
def world_chart() -> Chart:
    """Return the chart of the world's coasts, once for all questions of a process."""
    return Chart.gshhg("i")


def small_passages(chart: Chart) -> set[str]:
    """Return the names of the passages of a chart that are for small or local ships."""
    return {passage.name for passage in chart.passages if passage.use == "small_or_local"}


def _pulled(chart: Chart, off_land: Chart, path: FloatArray) -> list[Position]:
    """Return a stretch between canals (n, 2) [deg] after string pulling, off land where it can.

    Legs of the graph nearer to land than the offing are moved off it as far as costs fall. Where
    bends of the graph are left, the way along the coast is taken.
    """
    if len(path) < 3:
        return [(float(lat), float(lon)) for lat, lon in path]
    along = _places(*string_pull_path(chart, *path.T, rounds=_ROUNDS))
    lat, lon = string_pull_path(off_land, *path.T, rounds=_ROUNDS)
    near = np.asarray(off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], near.astype(int), [0]]))).reshape(-1, 2)
    first = np.maximum(edges[:, 0] - 1, np.append(0, edges[:-1, 1]))  # with the leg before ...
    last = np.minimum(edges[:, 1] + 1, np.append(first[1:], len(lat) - 1))  # ... and after it
    found, cost = _places(lat, lon), _cost_off_land(off_land)
    for begin, end in reversed(list(zip(first.tolist(), last.tolist()))):
        part = slice(begin, end + 1)
        y, x = string_pull_path(chart, lat[part], lon[part], leg_cost=cost, rounds=_ROUNDS)
        found[part] = _places(*string_pull_path(chart, y, x, leg_cost=cost, rounds=0))
    return found if path_length(found) <= _MOST_LONGER * path_length(along) + _BEND else along


def _cost_off_land(off_land: Chart) -> LegCost:
    """Return the cost of legs: their length, more where they are nearer to land than required."""
    arrays, coastline = off_land.offing_arrays, off_land.coastline

    def cost(lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray) -> FloatArray:
        lat = lat1[:, None] + _SHARES * (lat2 - lat1)[:, None]
        lon = wrap_longitude(lon1[:, None] + _SHARES * wrap_longitude(lon2 - lon1)[:, None])
        shore = coastline.shore_distance(lat, lon, cap=off_land.offing.distance).ravel()
        near = shore < required_offing(arrays, lat.ravel(), np.asarray(lon).ravel())
        share = near.reshape(lat.shape).mean(axis=1)
        return np.asarray(leg_lengths(lat1, lon1, lat2, lon2) * (1.0 + _NEAR_LAND * share))

    return cost


def _places(lat: FloatArray, lon: FloatArray) -> list[Position]:
    return list(zip(lat.tolist(), lon.tolist()))


def path_length_and_canals(chart: Chart, path: Sequence[Position]) -> tuple[float, tuple[str, ...]]:
    """Return the length [m] of a way, canals with their own, and the titles of its canals."""
    if len(path) < 2:
        return 0.0, ()
    lat, lon = np.array(path).T
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    length = path_length(path)
    for leg in np.flatnonzero(canal >= 0).tolist():
        length += chart.canals[canal[leg]].length - path_length(path[leg : leg + 2])
    return length, tuple(chart.canals[k].title for k in canal[canal >= 0])
