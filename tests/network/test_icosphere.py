"""Geodesic grids: halves shared, faces without gaps, leaves joined without holes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.chart import Chart
from thalweg.core.arrays.sphere_vectors import spherical_positions
from thalweg.kernels.network.graph_building import directed_edges_of_pairs
from thalweg.network.global_grid.grid import (
    GridResolution,
    _gaps,
    _geodesic_grid,
    make_grid,
)
from thalweg.network.global_grid.icosphere import RefinementRule, icosphere

SEEDS = st.integers(0, 2**31)


def cut_by_circles(seed, levels, count=2):
    """Return a rule that halves along random small circles on the sphere."""
    rng = np.random.default_rng(seed)
    poles = rng.normal(size=(count, 3))
    poles /= np.linalg.norm(poles, axis=1, keepdims=True)
    height = rng.uniform(-0.9, 0.98, count)

    def crossed(first, second):
        return (((first @ poles.T) > height) != ((second @ poles.T) > height)).any(axis=1)

    return RefinementRule(crossed, levels)


def area(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    rest = 1.0 + np.einsum("ij,ij->i", a, b) + np.einsum("ij,ij->i", b, c)
    return 2.0 * np.arctan2(volume, rest + np.einsum("ij,ij->i", c, a))


def middle(grid, a, b):
    key = (min(a, b) << 31) + max(a, b)
    k = np.searchsorted(grid.keys, key)
    return int(grid.middles[k]) if k < len(grid.keys) and grid.keys[k] == key else None


def side(grid, a, b):
    """Return the vertices from a to before b, those that hang on the side included."""
    m = middle(grid, a, b)
    return [a] if m is None else side(grid, a, m) + side(grid, m, b)


@pytest.mark.slow
@given(SEEDS, st.integers(0, 3), st.integers(0, 4))
@settings(max_examples=40)
def test_faces_tile_the_sphere_and_leaves_are_joined_without_holes(seed, level, extra):
    grid = icosphere(level, cut_by_circles(seed, extra), cut_by_circles(seed + 1, 1))
    areas = area(grid.vertices, grid.faces)
    assert (areas > 0.0).all() and np.isclose(areas.sum(), 4.0 * np.pi)
    first, second = grid.pairs()
    pairs = set(zip(first.tolist(), second.tolist()))
    assert len(pairs) == len(first)
    wanted = set()
    for a, b, c in grid.faces.tolist():
        sides = [side(grid, a, b), side(grid, b, c), side(grid, c, a)]
        ring = [vertex for one in sides for vertex in one]
        wanted |= {(min(p, q), max(p, q)) for p, q in zip(ring, ring[1:] + ring[:1])}
        whole = [s + t[:1] for s, t in zip(sides, sides[1:] + sides[:1])]  # both corners
        wanted |= {
            (min(p, q), max(p, q))
            for p in ring
            for q in ring
            if p != q and not any(p in w and q in w for w in whole)
        }
    assert pairs == wanted


@given(SEEDS, st.integers(0, 4))
@settings(max_examples=25)
def test_no_vertex_looks_into_a_hole(seed, extra):
    grid = icosphere(2, cut_by_circles(seed, extra))
    first, second = grid.pairs()
    v = grid.vertices
    indptr, head, _, _ = directed_edges_of_pairs(len(v), first, second)
    assert np.diff(indptr).min() >= 3
    tail = np.repeat(np.arange(len(v)), np.diff(indptr))
    east = np.cross([0.1, 0.2, 1.0], v[tail])
    north = np.cross(v[tail], east)
    away = v[head] - v[tail]
    angle = np.arctan2((away * east).sum(axis=1), (away * north).sum(axis=1))
    assert np.degrees(_gaps(tail, angle)).max() < 140.0  # a hole would be 180 at least


def test_across_doubles_the_directions_of_a_uniform_grid():
    grid = icosphere(3)
    first, second = grid.across()
    assert len(first) == len(grid.pairs()[0])  # one across every edge
    degree = np.bincount(np.concatenate([first, second]))
    assert sorted(set(degree.tolist())) == [5, 6]


def test_coasts_are_finer_and_every_leg_is_free():
    chart = Chart.gshhg("c")
    sphere = _geodesic_grid(chart, GridResolution(3, 2))
    lat, lon = spherical_positions(sphere.vertices)
    grid = make_grid(chart, GridResolution(3, 2, directions=6))
    a, b = grid.pairs.first, grid.pairs.second
    assert not chart.legs_blocked(grid.lat[a], grid.lon[a], grid.lat[b], grid.lon[b]).any()
    assert grid.rejected + len(a) == len(sphere.pairs()[0])
    near = chart.coastline.shore_distance(lat, lon, cap=150e3)
    fine = np.arange(len(lat)) >= len(icosphere(3).vertices)
    assert np.median(near[fine]) < 0.5 * np.median(near[~fine & (near > 0)])
