"""Mesh networks: thinning, rings, holes, samples."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.network.worlds import land_chart, triangular_mesh
from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError
from thalweg.network import check_network, mesh, shortest_path, spacing_fraction, with_endpoints
from thalweg.network.triangular_mesh.mesh_builder import pairs_by_ring
from thalweg.network.triangular_mesh.thinning import dimensionless_curl, thin_by_spacing

OPEN = Chart.open_water()


def test_spacing_fraction_has_the_published_value():
    value = spacing_fraction(1.2, 0.5, alpha=0.8, curl_power=0.6, speed_power=3.5)
    assert float(value) == pytest.approx(0.639906, abs=5e-7)


def test_spacing_fraction_is_one_in_still_water_and_never_more():
    assert float(spacing_fraction(0.0, 0.0)) == 1.0
    assert np.all(spacing_fraction(np.linspace(0, 5, 50), np.linspace(0, 9, 50)) <= 1.0)


@pytest.mark.parametrize(("largest", "kept"), [(0.1, 400), (1.0, 200)])
def test_thinning_of_a_square_grid_agrees_with_van_halem_2019(largest, kept):
    x, y = (part.ravel() for part in np.meshgrid(np.arange(20) * 0.5, np.arange(20) * 0.5))
    gap = largest * spacing_fraction(1.0, 0.0, alpha=0.0, speed_power=1.0)
    assert thin_by_spacing(x, y, gap).sum() == kept


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.0, 0.4), st.floats(0.0, 0.4))
def test_thinning_equals_the_plain_rule(seed, low, high):
    rng = np.random.default_rng(seed)
    x, y = rng.random((2, 60))
    gap = low + high * rng.random(60)
    kept: list[int] = [0]
    for i in range(1, 60):
        if np.hypot(x[kept] - x[i], y[kept] - y[i]).min() > gap[i]:
            kept.append(i)
    assert np.flatnonzero(thin_by_spacing(x, y, gap)).tolist() == kept


def test_thinning_refuses_unknown_flow():
    with pytest.raises(InputError, match="not a number"):
        thin_by_spacing([0.0, 1.0], [0.0, 1.0], [0.1, math.nan])


def test_curl_of_a_solid_turn():
    lat, lon, triangles = triangular_mesh(9, 1000.0)
    omega = 1e-4
    east = -omega * lat * math.radians(1.0) * 6371008.8
    north = omega * lon * math.radians(1.0) * 6371008.8 * np.cos(np.radians(lat))
    curl = dimensionless_curl(lat, lon, triangles, east, north, length=5e3, speed=0.5)
    assert curl == pytest.approx(2 * omega * 5e3 / 0.5, rel=1e-4)


def test_rings_of_a_regular_mesh():
    _, _, triangles = triangular_mesh(15, 1.0)
    middle = 7 * 15 + 7
    for number, (a, b) in enumerate(pairs_by_ring(triangles, 225, 3), 1):
        assert np.sum((a == middle) | (b == middle)) == 6 * number


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rings", "directions", "worst"), [(1, 6, 1.1547), (2, 12, 1.0353), (3, 24, 1.0141)]
)
def test_direction_error_of_a_regular_mesh(rings, directions, worst):
    # van Halem (2019): worst ratio of graph to true length on a triangular mesh
    n = 45
    lat, lon, triangles = triangular_mesh(n, 1000.0)
    network = mesh(OPEN, lat, lon, triangles, rings=rings)
    check_network(network, symmetric=True)
    assert network.meta.directions == directions
    assert 1.0 / math.cos(network.meta.gap_rad / 2.0) == pytest.approx(worst, abs=5e-5)
    assert np.diff(network.graph.indptr).max() == directions
    middle = (n // 2) * n + n // 2
    distance, _ = shortest_path(network, middle)
    straight = geodesy.distance(lat[middle], lon[middle], lat, lon)
    inner = (straight > 5e3) & (straight < 15e3)
    assert (distance[inner] / straight[inner]).max() == pytest.approx(worst, abs=3e-3)


def test_no_leg_crosses_a_hole_of_the_mesh():
    lat, lon, triangles = triangular_mesh(31, 1000.0)
    centre = np.hypot(lat[triangles].mean(1), lon[triangles].mean(1))
    network = mesh(OPEN, lat, lon, triangles[centre > 0.05], rings=3)
    check_network(network, symmetric=True)
    assert network.meta.rejected["outside the mesh"] > 0
    tails = network.tails()
    for share in (0.25, 0.5, 0.75):
        y = network.lat[tails] * (1 - share) + network.lat[network.graph.target] * share
        x = network.lon[tails] * (1 - share) + network.lon[network.graph.target] * share
        assert np.hypot(x, y).min() > 0.035


def test_a_hole_touched_only_at_its_corners_is_not_crossed():
    # a square of 5 x 5 nodes, without the middle 2 x 2 cells: straight across runs corner to corner
    y, x = (part.ravel() for part in np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij"))
    faces = []
    for i in range(4):
        for j in range(4):
            if not (i in (1, 2) and j in (1, 2)):
                a = 5 * i + j
                faces += [(a, a + 1, a + 5), (a + 1, a + 6, a + 5)]
    network = mesh(OPEN, y * 0.01, x * 0.01, faces, rings=3)
    tails = network.tails()
    pairs = set(zip(tails.tolist(), network.graph.target.tolist()))
    assert (6, 18) not in pairs
    assert (7, 17) not in pairs
    assert (6, 7) in pairs


def test_land_on_the_chart_is_left_out():
    lat, lon, triangles = triangular_mesh(21, 1000.0)
    chart = land_chart((-0.02, 0.02, -0.02, 0.02))
    network = mesh(chart, lat, lon, triangles)
    assert not np.any((np.abs(network.lat) < 0.02) & (np.abs(network.lon) < 0.02))
    tails = network.tails()
    assert not chart.legs_blocked(
        network.lat[tails], network.lon[tails],
        network.lat[network.graph.target], network.lon[network.graph.target],
    ).any()  # fmt: skip


def test_thinned_mesh_is_denser_where_the_flow_is_strong():
    lat, lon, triangles = triangular_mesh(61, 200.0)
    speed = np.where(lon > 0, 2.0, 0.0)
    network = mesh(
        OPEN, lat, lon, triangles,
        speed=speed, curl=np.zeros_like(speed), largest_spacing=2000.0, alpha=0.2, rings=2,
    )  # fmt: skip
    check_network(network, symmetric=True)
    east = (network.lon > 0).sum()
    assert east > 5 * (network.n_nodes - east)


def test_samples_lie_at_most_half_the_local_spacing_apart():
    lat, lon, triangles = triangular_mesh(15, 1000.0)
    network = mesh(OPEN, lat, lon, triangles, rings=3)
    count = np.diff(network.samples.ptr)
    inner = np.hypot(network.lat, network.lon) < 0.04
    inside = inner[network.tails()] & inner[network.graph.target]
    assert inside.sum() > 500
    assert np.all((network.edges.length / (count + 1))[inside] <= 0.5 * 1000.0 * 1.001)
    assert count[inside].max() == 5
    assert np.all(network.samples.station_a == network.samples.station_b)


def test_across_the_antimeridian():
    lat, lon, triangles = triangular_mesh(21, 5000.0)
    shifted = geodesy.wrap_longitude(lon + 180.0)
    network = mesh(OPEN, lat, shifted, triangles, rings=2)
    here = mesh(OPEN, lat, lon, triangles, rings=2)
    check_network(network, symmetric=True)
    assert network.n_edges == here.n_edges
    assert np.sort(network.edges.length) == pytest.approx(np.sort(here.edges.length), rel=1e-9)


def test_ends_on_a_mesh():
    lat, lon, triangles = triangular_mesh(31, 1000.0)
    bare = mesh(OPEN, lat, lon, triangles)
    network = with_endpoints(bare, OPEN, (-0.0512, -0.0933), (0.0741, 0.0817))
    check_network(network, symmetric=True)
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    straight = float(geodesy.distance(-0.0512, -0.0933, 0.0741, 0.0817))
    assert straight < distance[network.meta.goal] < 1.0141 * straight
    assert path[0] == bare.n_nodes
    assert path[-1] == bare.n_nodes + 1


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"rings": 4}, "rings"),
        ({"sampling": 0.0}, "sampling"),
        ({"triangles": [[0, 1, 999]]}, "triangles"),
        ({"lat": [0.0, math.nan, 1.0]}, "nodes"),
        ({"largest_spacing": 1e7}, "network"),
    ],
)
def test_broken_meshes(changes, word):
    lat, lon, triangles = triangular_mesh(5, 1000.0)
    values = {"lat": lat, "lon": lon, "triangles": triangles} | changes
    with pytest.raises(InputError, match=word):
        mesh(OPEN, values.pop("lat"), values.pop("lon"), **values)


def test_links_of_ends_are_sampled_as_closely_as_the_mesh_around_them():
    lat, lon, triangles = triangular_mesh(21, 2000.0)
    network = mesh(Chart.open_water(-2, 2, -2, 2), lat, lon, triangles)
    coarse = replace(network, meta=replace(network.meta, spacing_m=30_000.0))
    ends = with_endpoints(coarse, Chart.open_water(-2, 2, -2, 2), (0.01, 0.01), (0.1, 0.1))
    first = slice(ends.graph.indptr[ends.meta.start], ends.graph.indptr[ends.meta.start + 1])
    pieces = 1 + np.diff(ends.samples.ptr)[first]
    assert (ends.edges.length[first] / pieces).max() < 2000.0
