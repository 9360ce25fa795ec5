"""A lattice before assembly: its points, tested pairs and static distances."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import MEAN_RADIUS, Position, positions_along
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.kernels.network import lattice_edges
from thalweg.network.assembly import (
    DirectedEdges,
    Pairs,
    RejectionCounts,
    add_counts,
    allowed_legs,
    assemble,
    directed_edges,
    evenly_spaced_samples,
    measured_pairs,
)
from thalweg.network.conformal_projection import (
    ConformalProjection,
    angle_to_point,
    conformal_unit_vectors,
)
from thalweg.network.endpoints import (
    LINK_REACH,
    canal_pairs,
    concatenate_pairs,
    direct_pairs,
    links_to_nodes,
)
from thalweg.network.network import Network, NetworkMeta, Samples, Stations
from thalweg.network.passage_nodes import (
    PassageNodes,
    pairs_without,
    passage_nodes,
    passage_pairs,
)
from thalweg.network.regional_lattice.lane_nodes import lane_nodes
from thalweg.network.regional_lattice.narrow_channels import channel_nodes, channel_pairs
from thalweg.network.regional_lattice.refinement_levels import (
    LatticeSpecification,
    Level,
    grow_levels,
)
from thalweg.network.shortest_paths import shortest_path_tree

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal


#: Samples farther than this from their place on the geodesic get a station of their own
#: [fraction of the length of the pair].
_MAX_SAMPLE_OFFSET = 0.02


@dataclass(frozen=True)
class LevelPairs:
    """Pairs on one level with the point (index into the level) and offset they start with."""

    level: Level
    point: IntArray
    offset: IntArray
    pairs: Pairs


@dataclass(frozen=True)
class UnassembledLattice:
    """A lattice before assembly; start and goal are its last two nodes, before them ends of canals.

    ``refused`` is the number of points that the level left out would have brought, or 0.
    """

    stations: Stations
    parts: list[LevelPairs]
    ends: Pairs
    rejected: RejectionCounts
    refused: int

    @property
    def start(self) -> int:
        """Node of the start."""
        return self.stations.n_nodes - 2

    @property
    def goal(self) -> int:
        """Node of the goal."""
        return self.stations.n_nodes - 1

    @cached_property
    def pairs(self) -> Pairs:
        """All pairs: those of the levels, then those of start and goal."""
        return concatenate_pairs([part.pairs for part in self.parts] + [self.ends])

    @cached_property
    def edges(self) -> DirectedEdges:
        """The directed edges of all pairs by tail."""
        pairs = self.pairs
        return directed_edges(self.stations.n_nodes, pairs)

    def distances(self, node: int) -> FloatArray:
        """Return the static distance [m] of every node from one; inf where unreached."""
        weight = self.pairs.length[self.edges.pair]
        return shortest_path_tree(self.edges.graph, weight, node).distance

    def where(self, keep: BoolArray) -> UnassembledLattice:
        """Return the lattice with only the selected nodes, and start and goal."""
        keep = keep.copy()
        keep[-2:] = True
        if keep.all():
            return self
        new = np.cumsum(keep) - 1
        stations = Stations(self.stations.lat[keep], self.stations.lon[keep], int(keep.sum()))
        parts = [_level_subset(part, keep, new) for part in self.parts]
        return replace(
            self, stations=stations, parts=parts, ends=_pairs_subset(self.ends, keep, new)
        )

    def network(
        self,
        chart: Chart,
        frame: ConformalProjection,
        di: IntArray,
        dj: IntArray,
        meta: NetworkMeta,
    ) -> Network:
        """Sample all pairs along their length and assemble the network."""
        stations, samples = self.stations, []
        for part in self.parts:
            stations, new = _level_samples(frame, stations, part, di, dj)
            samples.append(new)
        spacing = _end_link_spacing(self, meta.spacing_m)
        stations, new = evenly_spaced_samples(stations, self.ends, spacing)
        samples.append(new)
        meta = replace(meta, start=self.start, goal=self.goal, rejected=self.rejected)
        samples_of_all = Samples.concatenate(samples)
        return assemble(chart, stations, self.pairs, samples_of_all, meta=meta, directed=self.edges)


def grow_lattice(
    ground: LatticeSpecification, di: IntArray, dj: IntArray, start: Position, goal: Position
) -> UnassembledLattice:
    """Grow the levels, join their points in all directions and link start and goal."""
    levels, lat, lon, refused = grow_levels(ground)
    n = len(lat)
    rejected: RejectionCounts = {}
    parts = [
        _join_level_points(ground.chart, level, lat, lon, di, dj, rejected) for level in levels
    ]
    canals = canals_in(ground)
    named = _passages_in(ground)
    lat, lon = np.append(lat, named.lat), np.append(lon, named.lon)
    middles = channel_nodes(ground) if ground.region.bounded else np.empty((2, 0))
    places = [*(end for canal in canals for end in canal.ends), start, goal]
    lat, lon = np.append(lat, middles[0]), np.append(lon, middles[1])
    grid, n = n, len(lat)
    lat, lon = (np.append(old, new) for old, new in zip((lat, lon), np.array(places, float).T))
    stations = Stations(lat, lon, n + len(places))
    reach = max(LINK_REACH, 1.02 * float(np.hypot(di, dj).max()))  # in spacings
    spacing = ground.frame.largest_unit * ground.step(0)
    ends = []
    for point in range(n, n + len(places)):
        own = spacing / np.cosh(_ordinate(ground.frame, lat[point], lon[point]))
        pairs, counts = links_to_nodes(ground.chart, lat, lon, point, n_nodes=n, reach=reach * own)
        ends.append(pairs)
        add_counts(rejected, counts)
    ends.append(direct_pairs(ground.chart, stations, n, reach=reach * spacing))
    ends.append(canal_pairs(canals, n))
    # lanes and passages are linked to nodes of the open sea, too: 24 of the nearest
    near = ground.frame.largest_unit * ground.step(0 if len(named.lat) else ground.coast_levels)
    along = passage_pairs(ground.chart, stations, grid, named.joined)
    around = channel_pairs(ground.chart, stations, grid, n, near)
    ends += [along, pairs_without(around, along)]
    return UnassembledLattice(stations, parts, concatenate_pairs(ends), rejected, refused)


def _passages_in(ground: LatticeSpecification) -> PassageNodes:
    """Return the nodes along passages and in traffic lanes in the region of a lattice."""
    found = passage_nodes(ground.chart).followed_by(lane_nodes(ground.chart))
    inside = ground.region.contains(conformal_unit_vectors(found.lat, found.lon))
    return found.where(inside & ground.region.in_box(found.lat, found.lon))


def canals_in(ground: LatticeSpecification) -> list[Canal]:
    """Return the canals of the chart with both ends in the region of a lattice."""
    found = []
    for canal in ground.chart.canals:
        lat, lon = np.array(canal.ends, float).T
        inside = ground.region.contains(conformal_unit_vectors(lat, lon)) & ground.region.in_box(
            lat, lon
        )
        if bool(np.all(inside & ground.chart.is_navigable(lat, lon))):
            found.append(canal)
    return found


def _ordinate(frame: ConformalProjection, lat: float, lon: float) -> float:
    """Return the Mercator ordinate [rad] of a position in a frame."""
    return float(frame.from_positions(lat, lon)[1] * frame.unit + frame.y0)


def _join_level_points(
    chart: Chart, level: Level, lat: FloatArray, lon: FloatArray, di: IntArray, dj: IntArray,
    rejected: RejectionCounts,
) -> LevelPairs:  # fmt: skip
    """Return the allowed pairs of a level; refusals are added to the counts."""
    rows = level.rows
    none, no_offset = np.empty(0, np.int32), np.empty(0, np.int8)
    count = lattice_edges.lattice_pairs(rows, di, dj, none, none, no_offset)
    a, b, k = np.empty(count, np.int32), np.empty(count, np.int32), np.empty(count, np.int8)
    lattice_edges.lattice_pairs(rows, di, dj, a, b, k)
    first, second = level.node[a], level.node[b]
    free, refused = allowed_legs(chart, lat, lon, first, second)
    add_counts(rejected, refused)
    if not free.all():
        a, k, first, second = a[free], k[free], first[free], second[free]
    return LevelPairs(level, a, k, measured_pairs(lat, lon, first, second))


def _pairs_subset(pairs: Pairs, keep: BoolArray, new: IntArray) -> Pairs:
    selected = pairs.where(keep[pairs.first] & keep[pairs.second])
    first, second = new[selected.first].astype(np.int32), new[selected.second].astype(np.int32)
    return Pairs(first, second, selected.length, selected.course)


def _level_subset(part: LevelPairs, keep: BoolArray, new: IntArray) -> LevelPairs:
    selected = keep[part.pairs.first] & keep[part.pairs.second]
    place = np.cumsum(keep[part.level.node]) - 1
    return LevelPairs(
        part.level.where(keep, new),
        place[part.point[selected]].astype(np.int32),
        part.offset[selected],
        _pairs_subset(part.pairs, keep, new),
    )


def _level_samples(
    frame: ConformalProjection, stations: Stations, part: LevelPairs, di: IntArray, dj: IntArray
) -> tuple[Stations, Samples]:
    """Sample pairs where they cross lattice lines: blends of two nodes, or extra stations."""
    level, point, offset = part.level, part.point, part.offset
    between = np.maximum(np.abs(di), np.abs(dj)) - 1
    ptr = cumulative_sums(between[offset])
    total = int(ptr[-1])
    a, b = np.empty(total, np.int32), np.empty(total, np.int32)
    w, s = np.empty(total, np.float32), np.empty(total, np.float32)
    pairs = lattice_edges.LatticePairs(point, offset, di, dj)
    samples = lattice_edges.LineSamples(a, b, w, s)
    lattice_edges.lattice_samples(level.rows, level.node, level.i, pairs, ptr, samples)
    bent = _is_bent(frame, part, di, dj)
    a[np.repeat(bent, between[offset])] = -1
    missing = np.flatnonzero(a < 0)
    of = np.searchsorted(ptr, missing, side="right") - 1
    x = (level.i[point[of]] + s[missing].astype(float) * di[offset[of]]) * level.step
    y = (level.j[point[of]] + s[missing].astype(float) * dj[offset[of]]) * level.step
    lat, lon = frame.to_positions(x, y)
    on_geodesic = np.flatnonzero(bent[of])
    first, second = part.pairs.first[of[on_geodesic]], part.pairs.second[of[on_geodesic]]
    lat[on_geodesic], lon[on_geodesic] = positions_along(
        *(stations.lat[first], stations.lon[first], stations.lat[second], stations.lon[second]),
        s[missing[on_geodesic]].astype(float),
    )
    a[missing] = b[missing] = len(stations.lat) + np.arange(len(missing))
    w[missing] = 0.0
    grown = replace(stations, lat=np.append(stations.lat, lat), lon=np.append(stations.lon, lon))
    return grown, Samples(ptr, a, b, w, s)


def _is_bent(frame: ConformalProjection, part: LevelPairs, di: IntArray, dj: IntArray) -> BoolArray:
    """Return which pairs of a level are too long to be sampled along lines of the projection.

    At the latitude phi of a Mercator projection the middle of the straight line between two places
    is about ``L^2 tan(phi) / 8`` from the middle of the geodesic of length L.
    """
    level, offset = part.level, part.offset
    length = np.hypot(di, dj)[offset] * level.step * frame.unit
    ends = level.j[part.point] + np.stack([np.zeros_like(dj[offset]), dj[offset]])
    ordinate = np.abs(ends * level.step * frame.unit + frame.y0).max(axis=0)
    return np.asarray(length * np.tanh(ordinate) / 8.0 > _MAX_SAMPLE_OFFSET)


def _end_link_spacing(draft: UnassembledLattice, spacing: float) -> FloatArray:
    """Return the sample spacing of links to single places: half their length, or the lattice's.

    Canals, which join two such places, are not sampled.
    """
    apart = np.minimum(spacing, np.maximum(draft.ends.length, 1.0))
    return np.asarray(np.where(np.isnan(draft.ends.course), np.inf, apart))


def reached_sides(
    ground: LatticeSpecification, draft: UnassembledLattice, start: FloatArray, goal: FloatArray
) -> tuple[bool, bool]:
    """Return whether what start and goal reach comes near the edge of the region."""
    vectors = conformal_unit_vectors(draft.stations.lat, draft.stations.lon)
    margin = 4.0 * ground.frame.largest_unit * ground.step(0)
    edge = ground.region.slack(vectors) < margin
    return bool(np.any(edge & np.isfinite(start))), bool(np.any(edge & np.isfinite(goal)))


def nearest_reached(draft: UnassembledLattice, start: FloatArray) -> Position:
    """Return the position reached from the start that is nearest to the goal."""
    lat, lon = draft.stations.lat, draft.stations.lon
    separation = (
        angle_to_point(conformal_unit_vectors(lat, lon), conformal_unit_vectors(lat[-1], lon[-1]))
        * MEAN_RADIUS
    )
    best = int(np.argmin(np.where(np.isfinite(start), separation, np.inf)))
    return float(lat[best]), float(lon[best])
