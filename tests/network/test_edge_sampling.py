"""Samples on the sides of triangles lie on their edges and are exact for linear fields."""

import numpy as np
import pytest

from thalweg import Chart
from thalweg.network import check_network
from thalweg.network.triangular_mesh.edge_sampling import (
    sampled_on_triangle_sides,
)
from thalweg.network.triangular_mesh.mesh_builder import mesh


@pytest.fixture(scope="module")
def network():
    draw = np.random.default_rng(4)
    lat, lon = 52.0 + draw.uniform(0.0, 0.2, 400), 3.0 + draw.uniform(0.0, 0.3, 400)
    return sampled_on_triangle_sides(
        mesh(Chart.open_water(51.9, 52.3, 2.9, 3.4), lat, lon, rings=3)
    )


def test_it_is_a_sound_network_whose_stations_are_its_nodes(network):
    check_network(network, sample=network.n_edges)
    assert network.n_stations == network.n_nodes
    assert len(network.samples.station_a) > network.n_edges / 2


@pytest.mark.slow
def test_samples_lie_on_their_edges(network):
    tails = network.tails()
    of = np.repeat(np.arange(network.n_edges), np.diff(network.samples.ptr))
    w, s = network.samples.weight.astype(float), network.samples.fraction.astype(float)
    a, b = network.samples.station_a, network.samples.station_b
    for values in (network.lat, network.lon):
        sampled = (1 - w) * values[a] + w * values[b]
        straight = (1 - s) * values[tails[of]] + s * values[network.graph.target[of]]
        assert sampled == pytest.approx(
            straight, abs=1e-4
        )  # 11 m; Mercator against degrees on 10 km


def test_every_crossing_is_of_a_side(network):
    """Nodes joined by the sample are neighbours: a ring-1 edge crosses none."""
    pairs = set(zip(network.tails().tolist(), network.graph.target.tolist()))
    assert all(
        pair in pairs
        for pair in zip(network.samples.station_a.tolist(), network.samples.station_b.tolist())
    )


def test_edges_and_lengths_stay(network):
    draw = np.random.default_rng(4)
    lat, lon = 52.0 + draw.uniform(0.0, 0.2, 400), 3.0 + draw.uniform(0.0, 0.3, 400)
    plain = mesh(Chart.open_water(51.9, 52.3, 2.9, 3.4), lat, lon, rings=3)
    assert np.array_equal(plain.graph.target, network.graph.target)
    assert np.array_equal(plain.edges.length, network.edges.length)
    assert plain.n_stations > 10 * network.n_stations
