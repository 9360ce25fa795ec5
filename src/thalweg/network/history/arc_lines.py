"""Lines of arcs: from stretches of tracks, tested against land, repaired over the globe."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import Position, distance, geocentric_positions, line_length
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.global_grid.sea_graph_cache import sea_graph
from thalweg.network.history.arc_statistics import CANDIDATES
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.stretch_ends import EndFinder
from thalweg.network.history.voyage_tracks import VoyageTracks

if TYPE_CHECKING:
    from thalweg.chart import Chart

_PULLS: Final = 2  # passes of string pulling of a path over the globe
_NEAR_ENDS: Final = 1.5  # track within this many radii of a node is replaced by the way to the node


@dataclass(frozen=True, eq=False)
class ArcLines:
    """Lines of A arcs.

    Parameters
    ----------
    ptr : The waypoints of arc a are ``ptr[a]:ptr[a + 1]``, from where its voyage passes the first
        node to where it passes the second, (A + 1,).
    lat, lon : Waypoints [deg].
    """

    ptr: IntArray
    lat: FloatArray
    lon: FloatArray

    def __len__(self) -> int:
        return len(self.ptr) - 1

    @classmethod
    def of_lists(cls, lines: Sequence[Sequence[Position]]) -> ArcLines:
        """Return lines from lists of positions (lat, lon) [deg].

        Parameters
        ----------
        lines : sequence of sequence of (lat, lon)
            One for each arc.
        """
        ptr = np.cumsum([0, *(len(line) for line in lines)])
        places = [place for line in lines for place in line]
        lat, lon = np.array(places, float).reshape(-1, 2).T
        return cls(ptr.astype(np.int64), lat.copy(), lon.copy())

    def of(self, arc: int) -> tuple[FloatArray, FloatArray]:
        """Return the waypoints of one arc.

        Parameters
        ----------
        arc : Its index.

        Returns
        -------
        lat, lon : [deg].
        """
        part = slice(int(self.ptr[arc]), int(self.ptr[arc + 1]))
        return self.lat[part], self.lon[part]

    def take(self, index: IntArray) -> ArcLines:
        """Return some of the lines.

        Parameters
        ----------
        index : Which of them, (k,); a line may be taken more than once.

        Returns
        -------
        ArcLines : In the order of the index.
        """
        count = np.diff(self.ptr)[index]
        ptr = cumulative_sums(count)
        at = np.arange(ptr[-1]) + np.repeat(self.ptr[index] - ptr[:-1], count)
        return ArcLines(ptr, self.lat[at], self.lon[at])

    @cached_property
    def legs(self) -> IntArray:
        """Index of the first waypoint of every leg."""
        inside = np.ones(len(self.lat), bool)
        inside[self.ptr[1:] - 1] = False
        return np.flatnonzero(inside)

    @cached_property
    def arc_of_leg(self) -> IntArray:
        """Arc of every leg."""
        return np.searchsorted(self.ptr, self.legs, side="right") - 1

    @cached_property
    def leg_lengths(self) -> FloatArray:
        """Length of every leg [m]."""
        at = self.legs
        return distance(self.lat[at], self.lon[at], self.lat[at + 1], self.lon[at + 1])

    @cached_property
    def lengths(self) -> FloatArray:
        """Length of every line (A,) [m]."""
        found = np.bincount(self.arc_of_leg, self.leg_lengths, minlength=len(self))
        return np.asarray(found, float)

    def blocked(self, chart: Chart) -> BoolArray:
        """Return which legs a chart blocks; exact tests of whole legs.

        Parameters
        ----------
        chart : Land, zones and canals.

        Returns
        -------
        bool ndarray : One for each of ``legs``.
        """
        at = self.legs
        return np.asarray(
            chart.legs_blocked(self.lat[at], self.lon[at], self.lat[at + 1], self.lon[at + 1])
        )

    def control_area_shares(self, chart: Chart) -> FloatArray:
        """Return the share of every line inside emission control areas.

        Parameters
        ----------
        chart : Its areas, else those in force.

        Returns
        -------
        float64 ndarray (A,) : 0 to 1; NaN where the chart counts no areas.
        """
        areas = chart.control_areas
        if areas is None:
            return np.full(len(self), np.nan)
        at = self.legs
        share = areas.eca_fraction(self.lat[at], self.lon[at], self.lat[at + 1], self.lon[at + 1])
        inside = np.bincount(self.arc_of_leg, share * self.leg_lengths, minlength=len(self))
        return inside / np.maximum(self.lengths, 1e-9)


@dataclass(frozen=True, eq=False)
class LinesOffLand:
    """Lines that the chart allows, and what was done for it.

    Parameters
    ----------
    lines : Of the arcs of ``arc``, in that order.
    arc : Arcs that have a line.
    source : The stretch of track that each line is from.
    repaired : Share of the length of each line that is a way over the globe in place of a track
        over land.
    """

    lines: ArcLines
    arc: IntArray
    source: IntArray
    repaired: FloatArray

    def take(self, index: NDArray[np.int64] | NDArray[np.bool_]) -> LinesOffLand:
        """Return some of the lines.

        Parameters
        ----------
        index : Which of them.
        """
        number = np.arange(len(self.arc))[index]
        return LinesOffLand(
            self.lines.take(number), self.arc[number], self.source[number], self.repaired[number]
        )


class GlobeWays:
    """Shortest ways over the graph of all seas, each found once.

    Parameters
    ----------
    chart : Chart
        Land and canals.
    """

    def __init__(self, chart: Chart) -> None:
        self._chart = chart
        self._known: dict[tuple[Position, Position], list[Position] | None] = {}

    def between(self, start: Position, goal: Position) -> list[Position] | None:
        """Return the waypoints of the shortest way by sea [deg], or None.

        Parameters
        ----------
        start, goal : (lat, lon)
            Positions [deg].
        """
        if (goal, start) in self._known:
            known = self._known[goal, start]
            return None if known is None else known[::-1]
        if (start, goal) not in self._known:
            self._known[start, goal] = self._found(start, goal)
        return self._known[start, goal]

    def _found(self, start: Position, goal: Position) -> list[Position] | None:
        chart = self._chart
        if not bool(chart.legs_blocked(*([x] for x in (*start, *goal)))[0]):
            return [start, goal]
        if not np.asarray(chart.is_navigable(*np.array([start, goal]).T)).all():
            return None
        try:
            path = sea_graph(chart).path(chart, start, goal)
        except NoRouteError:
            return None
        lat, lon = string_pull_path(chart, *np.array(path).T, rounds=_PULLS)
        return list(zip(lat.tolist(), lon.tolist()))


def lines_off_land(
    chart: Chart,
    tracks: VoyageTracks,
    stretches: ArcOccurrences,
    candidates: IntArray,
    *,
    finder: EndFinder,
    turning: BoolArray,
    radius: float,
    ways: GlobeWays,
) -> LinesOffLand:
    """Return the lines of arcs that are allowed on a chart.

    The first candidate of an arc without a leg over land becomes its line. Where there is none,
    legs of the medoid over land are replaced by the shortest way by sea between the waypoints
    around them; arcs for which there is no way have no line.

    Parameters
    ----------
    stretches : Stretches of tracks.
    candidates : int64 ndarray (A, c)
        Stretches that may become the line of each arc, the medoid first; -1 for none.
    finder : Finds where the lines begin and end.
    turning : Positions that are kept as waypoints, (n,).
    radius : Radius of a junction [m].
    """
    count = len(candidates)
    lines: list[list[Position]] = [[] for _ in range(count)]
    source = candidates[:, 0].copy()
    left = np.arange(count)
    medoids = stretches.take(source)
    for arc in np.flatnonzero(finder.through_canal(medoids)).tolist():
        nodes = int(medoids.tail[arc]), int(medoids.head[arc])
        lines[arc] = [(float(finder.places[0][k]), float(finder.places[1][k])) for k in nodes]
    left = left[[not line for line in lines]]
    for k in range(CANDIDATES):
        left = left[candidates[left, k] >= 0]
        if not len(left):
            break
        drawn = _drawn(tracks, stretches.take(candidates[left, k]), finder, turning, radius)
        bad = np.bincount(drawn.arc_of_leg[drawn.blocked(chart)], minlength=len(left)) > 0
        for i in range(len(left)) if k == 0 else np.flatnonzero(~bad).tolist():
            lat, lon = drawn.of(i)
            lines[left[i]] = list(zip(lat.tolist(), lon.tolist()))
            source[left[i]] = candidates[left[i], k]
        left = left[bad]
    repaired = np.zeros(count)
    blocked = ArcLines.of_lists(lines)
    bad = np.zeros(count, bool)
    bad[blocked.arc_of_leg[blocked.blocked(chart)]] = True
    for arc in np.flatnonzero(bad).tolist():
        lines[arc], repaired[arc] = repaired_line(chart, lines[arc], ways)
    arcs = np.array([arc for arc, line in enumerate(lines) if line], np.int64)
    return LinesOffLand(
        ArcLines.of_lists([lines[arc] for arc in arcs]), arcs, source[arcs], repaired[arcs]
    )


def _drawn(
    tracks: VoyageTracks,
    stretches: ArcOccurrences,
    finder: EndFinder,
    turning: BoolArray,
    radius: float,
) -> ArcLines:
    """Return the lines of stretches: node, turning points of the track between, node."""
    ends = finder.ends(stretches)
    at = np.flatnonzero(turning)
    step = stretches.end - stretches.begin
    margin = np.minimum(_NEAR_ENDS * radius, 0.25 * step)
    first = np.searchsorted(tracks.along[at], stretches.begin + margin, side="right")
    last = np.searchsorted(tracks.along[at], stretches.end - margin, side="left")
    begin = tracks.vectors_at(stretches.begin + margin)
    end = tracks.vectors_at(stretches.end - margin)
    inner = np.maximum(last - first, 0)
    ptr = cumulative_sums(inner + 4)
    lat, lon = np.empty(ptr[-1]), np.empty(ptr[-1])
    for k, edge in enumerate((ptr[:-1], ptr[1:] - 1)):
        lat[edge], lon[edge] = ends.lat[:, k], ends.lon[:, k]
    for edge, vectors in ((ptr[:-1] + 1, begin), (ptr[1:] - 2, end)):
        lat[edge], lon[edge] = geocentric_positions(vectors)
    line, rank = numbered_parts(inner)
    to, of = ptr[line] + 2 + rank, at[first[line] + rank]
    lat[to], lon[to] = tracks.lat[of], tracks.lon[of]
    return ArcLines(ptr, lat, lon)


def repaired_line(
    chart: Chart, line: list[Position], ways: GlobeWays
) -> tuple[list[Position], float]:
    """Return a line whose blocked legs are ways over the globe, and their share; [] for none."""
    lat, lon = np.array(line).T
    wet = np.asarray(chart.is_navigable(lat, lon))
    wet[[0, -1]] = True
    kept = [place for place, good in zip(line, wet.tolist()) if good]
    lat, lon = np.array(kept).T
    blocked = np.asarray(chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    found = [kept[0]]
    added = 0.0
    for k, bad in enumerate(blocked.tolist()):
        if not bad:
            found.append(kept[k + 1])
            continue
        way = ways.between(kept[k], kept[k + 1])
        if way is None:
            return [], 0.0
        added += line_length(way)
        found += way[1:]
    return found, added / max(line_length(found), 1e-9)
