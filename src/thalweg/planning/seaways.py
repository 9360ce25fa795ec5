"""The waters that ships use on a chart, and the shortest ways over them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canals import exclude_canals
from thalweg.chart.offing import disc_at
from thalweg.chart.passages import find_passages, split_avoided
from thalweg.core.geodesy import Position, distance
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.global_grid.sea_graph import (
    ICE_LATITUDES,
    outside_ice,
    path_length,
    sea_graph,
)
from thalweg.planning.request.voyage_endpoints import Endpoint

_ROUNDS: Final = 4  # passes of string pulling; each may double the waypoints of a corner
#: A way off land that is longer than the one along the coast by more than this has bends.
_MOST_LONGER: Final = 1.01
_BEND: Final = 6.0 * NAUTICAL_MILE


@dataclass(frozen=True, eq=False)
class Seaways:
    """A chart with what ways over it may not use.

    Attributes
    ----------
    chart : Chart
        Without the passages for small or local ships.
    canals : tuple of str
        Names of canals of the chart that are not used.
    passages : tuple of str
        Names of passages of the chart that are not used.
    """

    chart: Chart
    canals: tuple[str, ...] = ()
    passages: tuple[str, ...] = ()

    @classmethod
    def of_chart(cls, chart: Chart, avoid: Sequence[str], *, opened: Sequence[str] = ()) -> Seaways:
        """Return the seaways of a chart without canals and passages to avoid.

        Parameters
        ----------
        chart : Chart
        avoid : sequence of str
            Names of canals and passages; "all" for all canals.
        opened : sequence of str, optional
            Passages for small or local ships that may be used.

        Raises
        ------
        InputError
            If a name is unknown; the message lists similar names.
        """
        every = [name for name in avoid if name.strip().casefold() == "all"]
        canals, passages = split_avoided([name for name in avoid if name not in every])
        left = exclude_canals(chart.canals, [*every, *canals])
        used = find_passages(opened)
        small = [p.name for p in chart.passages if p.use == "small_or_local" and p not in used]
        chart = chart.without_passages(*small) if small else chart
        shut = tuple(canal.name for canal in chart.canals if canal not in left)
        open_names = {passage.name for passage in chart.passages}
        return cls(chart, shut, tuple(p.name for p in passages if p.name in open_names))

    def without(self, name: str) -> Seaways:
        """Return the seaways with one more canal or passage closed, by its name."""
        if name in {canal.name for canal in self.chart.canals}:
            return replace(self, canals=(*self.canals, name))
        return replace(self, passages=(*self.passages, name))

    def path(self, start: Endpoint, goal: Endpoint, *, offing: float) -> list[Position]:
        """Return the waypoints of the shortest way between two end points.

        Parameters
        ----------
        start, goal : Endpoint
        offing : float
            Distance from land [m] that is kept outside passages, ends and canals where the
            graph has water so far from land.

        Raises
        ------
        NoRouteError
            If there is no way.
        """
        ends = (start.lat, start.lon), (goal.lat, goal.lon)
        if float(distance(*ends[0], *ends[1])) < 1.0:
            return [ends[0]]
        chart = self.chart.without_passages(*self.passages) if self.passages else self.chart
        closed = [k for k, canal in enumerate(chart.canals) if canal.name in self.canals]
        graph = sea_graph(self.chart)
        path = graph.path(chart, *ends, closed=closed, passages=find_passages(self.passages))
        if outside_ice(*ends):
            chart = chart.within(*ICE_LATITUDES, -180.0, 180.0)
        discs = [disc_at(chart.coastline, end) for end in ends]
        off_land = chart.with_offing(offing, discs=discs)
        lat, lon = np.array(path).T
        canal = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
        ends_of_canals = np.flatnonzero(np.asarray(canal) >= 0) + 1
        return [place for part in np.split(np.array(path), ends_of_canals)
                for place in _pulled(chart, off_land, part)]  # fmt: skip


def _pulled(chart: Chart, off_land: Chart, path: FloatArray) -> list[Position]:
    """Return a stretch between canals (n, 2) [deg] after string pulling, off land where it can.

    Legs of the graph nearer to land than the offing are pulled along the coast. Where that leaves
    bends of the graph, the way along the coast is taken.
    """
    if len(path) < 3:
        return [(float(lat), float(lon)) for lat, lon in path]
    along = _places(*string_pull_path(chart, *path.T, rounds=_ROUNDS))
    lat, lon = string_pull_path(off_land, *path.T, rounds=_ROUNDS)
    near = np.asarray(off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], near.astype(int), [0]])))
    found = _places(lat, lon)
    for first, last in reversed(edges.reshape(-1, 2).tolist()):
        part = slice(first, last + 1)
        found[part] = _places(*string_pull_path(chart, lat[part], lon[part], rounds=_ROUNDS))
    return found if path_length(found) <= _MOST_LONGER * path_length(along) + _BEND else along


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
