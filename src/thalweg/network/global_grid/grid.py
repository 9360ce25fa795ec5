"""The geodesic grid of a coastline: nodes and legs that touch no land, cached on disk.

The grid's shape is that of a sphere; its lengths are those of the ellipsoid.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.geojson_polygons import rings_from_polygons
from thalweg.core.arrays.array_cache import load_or_make, remove_oldest
from thalweg.core.arrays.sphere_vectors import spherical_positions
from thalweg.core.cache_folder import cache_folder
from thalweg.core.types import BoolArray, FloatArray, Int32Array, IntArray
from thalweg.kernels.geometry.cube_sphere import IndexArrays
from thalweg.kernels.geometry.triangle_subdivision import outlines_crossed
from thalweg.kernels.network.graph_building import directed_edges_of_pairs
from thalweg.network.assembly import Pairs, allowed_legs, measured_pairs
from thalweg.network.endpoints import concatenate_pairs
from thalweg.network.global_grid.icosphere import (
    CrossingTest,
    Icosphere,
    RefinementRule,
    edge_keys,
    edge_vertices,
    icosphere,
    sorted_unique,
)
from thalweg.network.network import Stations
from thalweg.network.passage_nodes import pairs_without, passage_nodes, passage_pairs
from thalweg.network.regional_lattice.narrow_channels import channel_pairs

if TYPE_CHECKING:
    from thalweg.chart import Chart

FORMAT: Final = 3  # increase when the arrays or their construction change
_BORDER_INDEX_SIDE: Final = 128
_MAX_FILES: Final = 12  # grids and parts of them cached on disk, the newest ones


@dataclass(frozen=True)
class GlobeGrid:
    """A geodesic grid of the whole sea of a coastline, without canals.

    Attributes
    ----------
    lat, lon : float64[N]
        Nodes [deg].
    pairs : Legs that touch no land, one for both directions.
    rejected : Legs that touch land and were left out.
    spacing : Longest leg of the uniform grid [m].
    gap : Largest angle between neighbouring directions of a node in open water [rad].
    """

    lat: FloatArray
    lon: FloatArray
    pairs: Pairs
    rejected: int
    spacing: float
    gap: float


@dataclass(frozen=True)
class GridResolution:
    """Resolution of a grid.

    Attributes
    ----------
    level, coast_levels, border_levels : int
        Halvings of the icosahedron everywhere; further ones of faces an edge of which crosses the
        coast, and of those crossed by the border of a zone with prices.
    directions : {6, 12}
        Along the edges of faces, or across them as well.
    """

    level: int = 4
    coast_levels: int = 6
    border_levels: int = 4
    directions: int = 12


def globe_grid(chart: Chart, fineness: GridResolution) -> GlobeGrid:
    """Return the grid of a chart's coastline, from memory or disk if it was made before.

    Parameters
    ----------
    chart : Its land and the borders of its zones with prices determine the grid.
    """
    zones = type(chart.zones)(
        penalty=chart.zones.penalty, price=chart.zones.price, eca=chart.zones.eca
    )
    bare = type(chart)(chart.coastline, zones=zones)
    name = hashlib.sha256(repr((FORMAT, bare.fingerprint(), fineness)).encode()).hexdigest()[:16]
    folder = cache_folder("globe")
    whole = _GridRequest(
        bare, fineness, folder / f"grid-{fineness.level}-{fineness.coast_levels}-{name}.npz"
    )
    off_land = type(chart)(
        chart.coastline,
        zones=type(chart.zones)(no_go=chart.zones.no_go),
        passages=chart.passages,
        closed_passages=chart.closed_passages,
        offing=replace(chart.offing, discs=()),
    )
    lines = [(passage.name, passage.line) for passage in chart.passages]
    facts = (name, off_land.fingerprint(), repr(off_land.offing), lines)
    name = hashlib.sha256(repr(facts).encode()).hexdigest()[:16]
    part = replace(whole, path=folder / f"part-{fineness.level}-{fineness.coast_levels}-{name}.npz")
    return _load_or_make(replace(part, within=off_land, whole=whole))


@dataclass(frozen=True)
class _GridRequest:
    """A grid to build, and its file in the cache; two requests for one file are equal.

    With ``within`` the grid is the part of ``whole`` that this chart allows, with its passages.
    """

    chart: Chart
    fineness: GridResolution
    path: Path
    within: Chart | None = None
    whole: _GridRequest | None = None

    def __hash__(self) -> int:
        return hash(self.path)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _GridRequest) and other.path == self.path


@lru_cache(maxsize=3)
def _load_or_make(order: _GridRequest) -> GlobeGrid:
    def make() -> GlobeGrid:
        if order.whole is None or order.within is None:
            return make_grid(order.chart, order.fineness)
        return _allowed_part(_load_or_make(order.whole), order.within)

    def clean(folder: Path) -> None:
        remove_oldest(folder.glob("[gp]*-*.npz"), _MAX_FILES)

    return load_or_make(order.path, make, pack=_arrays, unpack=_grid, clean=clean)


def make_grid(chart: Chart, fineness: GridResolution) -> GlobeGrid:
    """Make the grid of a chart's coastline (see `globe_grid`)."""
    sphere = _geodesic_grid(chart, fineness)
    first, second = sphere.pairs()
    if fineness.directions > 6:
        first, second = _merge_pairs((first, second), sphere.across())
    lat, lon = spherical_positions(sphere.vertices)
    free, _ = allowed_legs(chart, lat, lon, first, second)
    gap = _largest_open_gap(sphere.vertices, first, second, free)
    first, second = first[free], second[free]
    used = np.zeros(len(lat), bool)
    used[first] = used[second] = True
    number = (np.cumsum(used) - 1).astype(np.int32)
    pairs = measured_pairs(lat[used], lon[used], number[first], number[second])
    spacing = _longest_leg(fineness.level)
    return GlobeGrid(lat[used], lon[used], pairs, int((~free).sum()), spacing, gap)


def _allowed_part(whole: GlobeGrid, chart: Chart) -> GlobeGrid:
    """Return the part of a grid that a chart allows, joined to nodes along its passages."""
    lat, lon, pairs = whole.lat, whole.lon, whole.pairs
    refused = 0
    if chart.offing.distance > 0.0 or chart.zones.no_go or chart.closed_passages:
        usable = chart.is_navigable(lat, lon)
        pairs = pairs.where(usable[pairs.first] & usable[pairs.second])
        free, _ = allowed_legs(chart, lat, lon, pairs.first, pairs.second)
        pairs = pairs.where(free)
        refused = len(whole.pairs.first) - len(pairs.first)
    named = passage_nodes(chart)
    count = len(lat)
    lat, lon = np.append(lat, named.lat), np.append(lon, named.lon)
    stations = Stations(lat, lon, len(lat))
    near = float(np.median(pairs.length)) if len(pairs.first) else whole.spacing
    along = passage_pairs(chart, stations, count, named.joined)
    around = channel_pairs(chart, stations, count, len(lat), near)
    pairs = concatenate_pairs([pairs, along, pairs_without(around, along)])
    used = np.zeros(len(lat), bool)
    used[pairs.first] = used[pairs.second] = True
    number = (np.cumsum(used) - 1).astype(np.int32)
    pairs = replace(pairs, first=number[pairs.first], second=number[pairs.second])
    return replace(
        whole, lat=lat[used], lon=lon[used], pairs=pairs, rejected=whole.rejected + refused
    )


def _longest_leg(level: int) -> float:
    """Return the longest leg [m] of the uniform grid; every halving of a level halves it nearly."""
    known = min(level, 5)
    sphere = icosphere(known)
    first, second = sphere.pairs()
    length = measured_pairs(*spherical_positions(sphere.vertices), first, second).length
    return float(length.max()) / 2 ** (level - known)


def _geodesic_grid(chart: Chart, fineness: GridResolution) -> Icosphere:
    """Return the geodesic grid of a coastline, land and all."""
    level, coast = fineness.level, fineness.coast_levels
    rules = [RefinementRule(_crossing_test(chart.coastline.index), coast)]
    rules += [
        RefinementRule(_crossing_test(outlines), fineness.border_levels)
        for outlines in _borders(chart)
    ]
    return icosphere(level, *rules)


def _borders(chart: Chart) -> list[IndexArrays]:
    """Return the outlines of the zones with prices."""
    zones = chart.zones
    found = [zones.eca_index] if zones.eca else []
    priced = [shape for shape, _ in (*zones.penalty, *zones.price)]
    if priced:
        found.append(build_index(rings_from_polygons(priced), _BORDER_INDEX_SIDE))
    return found


def _crossing_test(index: IndexArrays) -> CrossingTest:
    """Return the test of edges against outlines."""

    def crossed(first: FloatArray, second: FloatArray) -> BoolArray:
        answer = np.empty(len(first), np.bool_)
        outlines_crossed(index, *spherical_positions(first), *spherical_positions(second), answer)
        return answer

    return crossed


def _merge_pairs(
    some: tuple[Int32Array, Int32Array], more: tuple[Int32Array, Int32Array]
) -> tuple[Int32Array, Int32Array]:
    """Return two lots of pairs as one without repeats."""
    return edge_vertices(sorted_unique(np.concatenate([edge_keys(*some), edge_keys(*more)])))


def _largest_open_gap(
    vectors: FloatArray, first: Int32Array, second: Int32Array, free: BoolArray
) -> float:
    """Return the largest angle [rad] between directions of nodes none of whose legs is refused."""
    open_ = np.ones(len(vectors), bool)
    open_[first[~free]] = open_[second[~free]] = False
    indptr, head, _, _ = directed_edges_of_pairs(len(vectors), first, second)
    tail = np.repeat(np.arange(len(vectors)), np.diff(indptr))
    inside = open_[tail]
    tail, head = tail[inside], head[inside]
    if not len(tail):
        return float(2.0 * np.pi)
    east = np.cross([0.0, 0.0, 1.0], vectors[tail] + [1e-9, 0.0, 0.0])
    north = np.cross(vectors[tail], east)
    direction = vectors[head] - vectors[tail]
    angle = np.arctan2(
        np.einsum("ij,ij->i", direction, east), np.einsum("ij,ij->i", direction, north)
    )
    return float(_gaps(tail, angle).max())


def _gaps(tail: IntArray, angle: FloatArray) -> FloatArray:
    """Return the angle from each direction to the next one round its node; tails ascend."""
    order = np.lexsort((angle, tail))
    angle = angle[order]
    begins = np.flatnonzero(np.append(True, np.diff(tail) != 0))
    ends = np.append(begins[1:], len(tail)) - 1
    gap = np.empty(len(angle))
    gap[:-1] = np.diff(angle)
    gap[ends] = angle[begins] + 2.0 * np.pi - angle[ends]
    return gap


def _arrays(grid: GlobeGrid) -> dict[str, NDArray[Any]]:
    facts = np.array([grid.rejected, grid.spacing, grid.gap])
    return {"lat": grid.lat, "lon": grid.lon, "facts": facts, **vars(grid.pairs)}


def _grid(arrays: Mapping[str, NDArray[Any]]) -> GlobeGrid:
    pairs = Pairs(*(arrays[name] for name in ("first", "second", "length", "course")))
    rejected, spacing, gap = arrays["facts"]
    grid = GlobeGrid(arrays["lat"], arrays["lon"], pairs, int(rejected), float(spacing), float(gap))
    sizes = {len(grid.lat), len(grid.lon)}, {len(x) for x in vars(pairs).values()}
    if len(sizes[0]) > 1 or len(sizes[1]) > 1 or not len(pairs.first):
        raise ValueError("the arrays do not fit together")
    if max(int(pairs.first.max()), int(pairs.second.max())) >= len(grid.lat):
        raise ValueError("a leg ends at no node")
    return grid
