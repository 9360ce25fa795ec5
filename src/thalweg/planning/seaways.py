"""The waters that ships use on a chart, and the shortest ways over them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from typing import Final, TypeAlias

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canals import exclude_canals
from thalweg.chart.depth.shoals import CONTOURS, Shoals
from thalweg.chart.offing import disc_at, required_offing
from thalweg.chart.passages import find_passages, split_avoided
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import (
    MEAN_RADIUS,
    Position,
    densify,
    distance,
    format_position,
    geocentric_unit_vectors,
    line_length,
)
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.clear_water import (
    ClearWater,
    positions_of,
)
from thalweg.network.alternatives.leg_rules import PolylineCoordinates
from thalweg.network.global_grid.endpoint_attachment import LinePlaces
from thalweg.network.global_grid.ice_limits import ICE_LATITUDES, northern_limit, outside_ice
from thalweg.network.global_grid.sea_graph import GraphClosures
from thalweg.network.global_grid.sea_graph_cache import edge_excess, sea_graph
from thalweg.planning.request.voyage_endpoints import Endpoint

#: A way whose miles in shoal water count this little more [m] is taken as free of shoals.
_FREE_OF_SHOALS: Final = 0.5 * NAUTICAL_MILE
#: A way that shoals make longer than this is compared with the one over them.
_MOST_LONGER: Final = 1.01
_FAR_APART: Final = 60.0 * NAUTICAL_MILE  # ways over the graph are not by the same straits
_STEP: Final = 0.25 * NAUTICAL_MILE  # at which the distance from land is looked up for a note
_TOLERANCE: Final = 0.1 * NAUTICAL_MILE
_LEAST_GAIN: Final = 1e-5  # share of the cost that each waypoint saves


#: Which legs (lat1, lon1, lat2, lon2) [deg] something is true of.
LegTest: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], BoolArray]

#: The passages that were closed, the way, and its cost.
_PulledPart: TypeAlias = tuple[frozenset[str] | None, list[Position], float]


@dataclass(frozen=True, eq=False)
class Seaways:
    """A chart with what ways over it may not use.

    Attributes
    ----------
    chart : Without the passages for small or local ships.
    canals : Names of canals of the chart that are not used.
    passages : Names of passages of the chart that are not used.
    shoals : Shoal water, in which a mile counts more.
    south : Latitude that no way passes [deg].
    known_parts : Parts of ways that were pulled before. Questions that close one passage or another
        share them: most of their ways are the same.
    """

    chart: Chart
    canals: tuple[str, ...] = ()
    passages: tuple[str, ...] = ()
    shoals: Shoals | None = None
    south: float = -90.0
    known_parts: dict[tuple[object, ...], _PulledPart] | None = field(default=None, repr=False)

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
    def of_ship_chart(cls, chart: Chart, *, every_passage: bool = False) -> Seaways:
        """Return the seaways of the world without what the chart of a plan closes.

        They have all passages for small ships, or none, so that few graphs are made, and the
        southern limit of the chart.

        Parameters
        ----------
        every_passage : The passages for small ships are there, closed, for other ships too.
        """
        every = world_chart()
        opened = sorted(small_passages(every)) if every_passage or small_passages(chart) else ()
        world = cls.of_chart(every, (), opened=opened)
        canals = {canal.name for canal in chart.canals}
        shut = tuple(canal.name for canal in world.chart.canals if canal.name not in canals)
        open_here = {passage.name for passage in world.chart.passages}
        closed = tuple(p.name for p in chart.closed_passages if p.name in open_here)
        south = chart.area.south if chart.area.width >= 360.0 else -90.0
        return cls(world.chart, shut, closed, south=south)

    def without(self, name: str) -> Seaways:
        """Return the seaways with one more canal or passage closed, by its name."""
        if name in {canal.name for canal in self.chart.canals}:
            return replace(self, canals=(*self.canals, name))
        return replace(self, passages=(*self.passages, name))

    @property
    def closed_names(self) -> frozenset[str]:
        """Names of the canals and passages that are not used."""
        return frozenset((*self.canals, *self.passages))

    @property
    def _open_chart(self) -> Chart:
        return self.chart.without_passages(*self.passages) if self.passages else self.chart

    def graph_path(
        self, start: Endpoint, goal: Endpoint, *, blocked: LegTest | None = None
    ) -> list[Position]:
        """Return the waypoints of the shortest way over the graph, without string pulling.

        Parameters
        ----------
        blocked : Which legs over shoals may not be sailed.

        Raises
        ------
        NoRouteError : If there is no way.
        """
        places = (start.lat, start.lon), (goal.lat, goal.lon)
        graph, closures = sea_graph(self.chart), self._closures
        if blocked is not None and closures.excess is not None:
            excess = closures.excess.copy()
            shoal = np.flatnonzero(excess > 0.0)
            excess[shoal[blocked(*graph.ends_of_edges(shoal))]] = np.inf
            closures = replace(closures, excess=excess)
        return graph.path(self._open_chart, *places, closures)

    def length_over_graph(self, start: Position, goal: Position) -> float:
        """Return the length of the shortest way over the graph [m]; 0 where there is none."""
        try:
            path = sea_graph(self.chart).path(self._open_chart, start, goal, self._closures)
        except NoRouteError:
            return 0.0
        return path_length_and_canals(self.chart, path)[0]

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
        excess = None if self.shoals is None else edge_excess(self.chart, self.shoals)
        return GraphClosures(closed, find_passages(self.passages), self.shoals, excess, self.south)

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
        south = max(ICE_LATITUDES[0] if outside_ice(*ends) else -90.0, self.south)
        north = northern_limit(*ends)
        if north < 90.0 or self.south > -90.0:
            chart = chart.within(south, north, -180.0, 180.0)
        off_land = _off_land(chart, ends, offing)
        over = replace(self, shoals=None).graph_path(start, goal)
        round_shoals = over if self.shoals is None else self.graph_path(start, goal)
        parts = list(zip(*(_between_canals(chart, way) for way in (over, round_shoals))))
        if not all(np.array_equal(a[[0, -1]], b[[0, -1]]) for a, b in parts):  # by other canals
            parts = [(np.array(over), np.array(round_shoals))]
        return [place for part in parts for place in self._cheapest(chart, off_land, *part)]

    def _cheapest(
        self, chart: Chart, off_land: Chart, over: FloatArray, round_shoals: FloatArray
    ) -> list[Position]:
        """Return the cheaper of two ways after string pulling: over shoals, and round them.

        A way free of shoals is the same for every draught that it is free for.
        """
        over_shoals, past_shoals = positions_of(*over.T), positions_of(*round_shoals.T)
        pulled = []
        longer = line_length(past_shoals) > _MOST_LONGER * line_length(over_shoals)
        if not longer:
            direct = replace(self, shoals=None)._pulled_between_canals(chart, off_land, over_shoals)
            if self._shoal_excess_of(direct) <= _FREE_OF_SHOALS:
                return direct
            pulled = [direct]
        pulled.append(self._pulled_between_canals(chart, off_land, past_shoals))
        if (longer and self._has_wide_shoals) or _are_far_apart(over, round_shoals):
            pulled.append(self._pulled_between_canals(chart, off_land, over_shoals))
        clear = ClearWater(off_land, self.shoals)
        return min(pulled, key=partial(_cost_with_canals, clear))

    @property
    def _has_wide_shoals(self) -> bool:
        return self.shoals is not None and self.shoals.contour > CONTOURS[0]

    def _shoal_excess_of(self, path: Sequence[Position]) -> float:
        """Return how many more metres a way counts for its shoal water, canals without."""
        if self.shoals is None:
            return 0.0
        return sum(
            float(np.sum(distance(*legs) * self.shoals.excess(*legs)))
            for part in _between_canals(self.chart, path)
            for legs in [(*part[:-1].T, *part[1:].T)]
        )

    def _pulled_between_canals(
        self, chart: Chart, off_land: Chart, path: Sequence[Position]
    ) -> list[Position]:
        """Return a way after string pulling of its parts between canals."""
        parts = _between_canals(chart, path)
        return [place for part in parts for place in self._pulled(chart, off_land, part)]

    def near_land_notes(
        self, path: Sequence[Position], ends: Sequence[Endpoint], *, offing: float
    ) -> tuple[str, ...]:
        """Return where a way is nearer to land than the offing [m] outside passages, as a note."""
        if len(path) < 2:
            return ()
        off_land = _off_land(self._open_chart, [(end.lat, end.lon) for end in ends], offing)
        way = np.array(path)
        lat, lon, leg = densify(way[:, 0], way[:, 1], _STEP)
        lat, lon = lat[1:], lon[1:]
        shore = np.asarray(off_land.coastline.shore_distance(lat, lon, cap=offing))
        at_sea = np.asarray(self.chart.canal_of_legs(*way[:-1].T, *way[1:].T))[leg] < 0
        near = at_sea & (shore < required_offing(off_land.offing_arrays, lat, lon) - _TOLERANCE)
        miles = float(near.sum()) * _STEP / NAUTICAL_MILE
        if miles < 1.0:
            return ()
        at = int(np.argmin(np.where(near, shore, np.inf)))
        return (
            f"{miles:.0f} nm of the way are nearer to land than {offing / NAUTICAL_MILE:g} nm, the "
            f"nearest {shore[at] / NAUTICAL_MILE:.1f} nm off at {format_position(lat[at], lon[at])}"
            ": check on the chart that there is enough sea room.",
        )

    def _pulled(self, chart: Chart, off_land: Chart, part: FloatArray) -> list[Position]:
        """Return a stretch between canals after string pulling, the same in both directions."""
        if tuple(part[0]) > tuple(part[-1]):  # string pulling depends on the direction
            return self._pulled(chart, off_land, part[::-1])[::-1]
        if len(part) < 3:
            return positions_of(*part.T)
        if self.known_parts is None:
            return self._newly_pulled(chart, off_land, part)
        key = part.tobytes(), off_land.offing, self.shoals
        clear, closed = ClearWater(off_land, self.shoals), frozenset(self.passages)
        before, way, cost = self.known_parts.get(key, (None, [], 0.0))
        if before is not None and before <= closed:
            lat, lon = np.array(way).T
            blocked = np.any(chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
            if not blocked and clear.cost_of((lat, lon)) == cost:  # nothing that it uses is closed
                return way
        way = self._newly_pulled(chart, off_land, part)
        lat, lon = np.array(way).T
        self.known_parts.setdefault(key, (closed, way, clear.cost_of((lat, lon))))
        return way

    def _newly_pulled(self, chart: Chart, off_land: Chart, part: FloatArray) -> list[Position]:
        """Return a stretch of three positions or more after string pulling."""
        clear = ClearWater(off_land, self.shoals)
        lat, lon = part.T
        line = clear.moved(chart, clear.pulled(chart, (lat, lon)))
        line = clear.round_land(chart, line)
        return positions_of(*self._pulled_again(chart, clear, line))

    def _pulled_again(
        self, chart: Chart, clear: ClearWater, line: PolylineCoordinates
    ) -> PolylineCoordinates:
        """Return a way off land after more string pulling, if that costs less.

        One pull leaves such ways up to 6 % longer than the next, and differently for each draught.
        """
        lat, lon = line
        if np.any(clear.off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:])):
            return line
        again = clear.pulled(chart, line, least_gain=_LEAST_GAIN)
        return min(line, clear.moved(chart, again), key=clear.cost_of)


def _are_far_apart(one: FloatArray, other: FloatArray) -> bool:
    """Return whether two ways (n, 2) over the graph are by other straits."""
    lat, lon, _ = densify(one[:, 0], one[:, 1], 0.5 * _FAR_APART)
    away = geocentric_unit_vectors(other[:, 0], other[:, 1])[:, None]
    away = np.linalg.norm(away - geocentric_unit_vectors(lat, lon), axis=-1).min(axis=1)
    return bool(away.max() * MEAN_RADIUS > _FAR_APART)


def _cost_with_canals(clear: ClearWater, way: Sequence[Position]) -> float:
    """Return the cost of a way in which canals count as long as they are."""
    parts = [part for part in _between_canals(clear.off_land, way) if len(part) > 1]
    length, _ = path_length_and_canals(clear.off_land, way)
    at_sea = sum(line_length(positions_of(*part.T)) for part in parts)
    return sum(clear.cost_of((part[:, 0], part[:, 1])) for part in parts) + length - at_sea


@lru_cache(maxsize=1)
def world_chart() -> Chart:
    """Return the chart of the world's coasts, once for all questions of a process."""
    return Chart.gshhg("i")


def small_passages(chart: Chart) -> set[str]:
    """Return the names of the passages of a chart that are for small or local ships."""
    return {passage.name for passage in chart.passages if passage.use == "small_or_local"}


def _off_land(chart: Chart, ends: Sequence[Position], offing: float) -> Chart:
    """Return a chart with an offing [m], less round the ends."""
    return chart.with_offing(offing, discs=[disc_at(chart.coastline, end) for end in ends])


def _between_canals(chart: Chart, path: Sequence[Position]) -> list[FloatArray]:
    """Return the positions of a way before, between and after the canals, (N, 2) [deg]."""
    lat, lon = _line(path)
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    return np.split(np.array(path), np.flatnonzero(canal >= 0) + 1)


def _line(path: Sequence[Position]) -> PolylineCoordinates:
    lat, lon = np.array(path).T
    return lat, lon


def path_length_and_canals(chart: Chart, path: Sequence[Position]) -> tuple[float, tuple[str, ...]]:
    """Return the length [m] of a way, canals with their own, and the titles of its canals."""
    if len(path) < 2:
        return 0.0, ()
    lat, lon = np.array(path).T
    canal = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    length = line_length(path)
    for leg in np.flatnonzero(canal >= 0).tolist():
        length += chart.canals[canal[leg]].length - line_length(path[leg : leg + 2])
    return length, tuple(chart.canals[k].title for k in canal[canal >= 0])
