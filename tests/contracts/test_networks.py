"""The networks of every builder pass the network check."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

from tests.network.worlds import land_chart, triangular_mesh
from thalweg.chart import Chart
from thalweg.network import check_network, lattice, mesh, shortest_path, with_endpoints

ISLAND = land_chart((-0.05, 0.03, -0.04, 0.04))
ENDS = ((-0.1, -0.11), (0.11, 0.1))


def build_mesh(rings: int, thin: float | None = None):
    lat, lon, triangles = triangular_mesh(31, 1000.0)
    bare = mesh(ISLAND, lat, lon, triangles, rings=rings, largest_spacing=thin)
    return with_endpoints(bare, ISLAND, *ENDS)


BUILDERS = {
    "lattice": lambda: lattice(ISLAND, *ENDS),
    "lattice 8": lambda: lattice(ISLAND, *ENDS, directions=8, coast_levels=0),
    "lattice 96": lambda: lattice(ISLAND, *ENDS, directions=96, spacing=2000.0),
    "latlon": lambda: lattice(ISLAND, *ENDS, orientation="latlon", directions=16),
    "with depth": lambda: lattice(
        ISLAND.with_depth(lambda lat, lon: 10.0 + lat), *ENDS, directions=16
    ),
    "mesh 1": lambda: build_mesh(1),
    "mesh 3": lambda: build_mesh(3),
    "thinned mesh": lambda: build_mesh(2, 2500.0),
    "ends twice": lambda: with_endpoints(
        lattice(ISLAND, *ENDS), ISLAND, (0.06, 0.0), (-0.08, 0.02), via=[(0.0, 0.1)]
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", BUILDERS)
def test_builder_passes_the_check(name):
    network = BUILDERS[name]()
    check_network(network, symmetric=True)
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    assert path[0] == network.meta.start
    assert path[-1] == network.meta.goal
    assert np.isfinite(distance[network.meta.goal])
    tails = network.tails()
    blocked = ISLAND.legs_blocked(
        network.lat[tails], network.lon[tails],
        network.lat[network.graph.target], network.lon[network.graph.target],
    )  # fmt: skip
    assert not blocked.any()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lattice", "mesh 3"])
def test_building_twice_gives_the_same(name):
    first, second = BUILDERS[name](), BUILDERS[name]()
    np.testing.assert_equal(asdict(first), asdict(second))


@pytest.mark.slow
def test_reading_does_not_write():
    network = lattice(Chart.open_water(), (10, -40), (11, -39), directions=8)
    before = network.edges.length.copy()
    check_network(network)
    shortest_path(network, 0)
    assert np.array_equal(before, network.edges.length)
