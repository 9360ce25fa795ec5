"""Lattices along a given path."""

import itertools

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.network import check_network, lattice, shortest_path


@pytest.mark.slow
def test_a_corridor_holds_only_water_near_its_path():
    chart = Chart.open_water(-10.0, 10.0, -10.0, 30.0)
    way = [(0.0, 0.0), (5.0, 10.0), (0.0, 20.0)]
    network = lattice(chart, way[0], way[-1], along=way, width=100_000.0)
    check_network(network)
    dense = [
        geodesy.positions_along(*a, *b, np.linspace(0, 1, 101)) for a, b in itertools.pairwise(way)
    ]
    lat, lon = np.concatenate(dense, axis=1)
    away = [float(geodesy.distance(y, x, lat, lon).min()) for y, x in zip(network.lat, network.lon)]
    assert max(away) < 160_000.0  # cells are square: their corners reach further
    assert max(away) > 60_000.0


def test_the_path_in_a_corridor_is_hardly_longer_than_its_line():
    chart = Chart.open_water(-20.0, 20.0, -10.0, 30.0)
    way = [(0.0, 0.0), (12.0, 10.0), (0.0, 20.0)]
    network = lattice(chart, way[0], way[-1], along=way, width=60_000.0, directions=32)
    length, path = shortest_path(network, network.meta.start, network.meta.goal)
    line = sum(float(geodesy.distance(*a, *b)) for a, b in itertools.pairwise(way))
    straight = float(geodesy.distance(*way[0], *way[-1]))
    assert length[network.meta.goal] == pytest.approx(line, rel=0.06)
    assert length[network.meta.goal] > 1.05 * straight
    assert path[0] == network.meta.start and path[-1] == network.meta.goal


def test_a_corridor_round_the_date_line():
    chart = Chart.open_water(-20.0, 20.0, -180.0, 180.0)
    way = [(0.0, 175.0), (3.0, 180.0), (0.0, -175.0)]
    network = lattice(chart, way[0], way[-1], along=way, width=80_000.0)
    length, _ = shortest_path(network, network.meta.start, network.meta.goal)
    straight = float(geodesy.distance(*way[0], *way[-1]))
    assert straight * 0.999 < length[network.meta.goal] < 1.2 * straight
