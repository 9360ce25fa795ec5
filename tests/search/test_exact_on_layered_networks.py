"""Exact search on layered networks in weather that changes: brute force, greedy, quasi-static.

The greedy choice is that of Prestegardshus (2020), eq. 3.50: always the segment that is sailed
soonest, as long as the goal can be reached from its end.
"""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.network import layered_network
from thalweg.sea import Sea
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.ship import Ship

START, HOUR = 1.8e9, 3600.0
PLACES = [(65.0, 0.0), (65.0, 2.0)]
CHANNELS = (codes.CURRENT_EAST, codes.CURRENT_NORTH)


def made_sea(number):
    """Currents of up to 2 m/s in a pattern that moves and turns; another one for each month."""
    draw = np.random.default_rng(number)
    phase, rate = draw.uniform(0.0, 6.0, 4), draw.uniform(0.5, 2.0, 4) / (4.0 * HOUR)

    def flow(k):
        def value(time, lat, lon):
            wave = np.sin(rate[k] * (time - START) + phase[k] + 40.0 * (lat - 65.0) + 5.0 * lon)
            return wave + np.sin(rate[k + 1] * (time - START) + phase[k + 1] - 4.0 * lon)

        return value

    names = "eastward_sea_water_velocity", "northward_sea_water_velocity"
    return Sea.from_functions(dict(zip(names, (flow(0), flow(2)))), time_step=600.0)


@pytest.fixture(scope="module")
def network():
    return layered_network(Chart.open_water(), PLACES, layers=5, fan=3, offset=6000.0)


def on_network(network, sea):
    fields = sea.freeze_stations(
        network.stations.lat, network.stations.lon, START, START + 48 * HOUR, CHANNELS
    )
    ship = Ship.simple(speed_kn=10.0)
    return ShipOnNetwork(
        network, fields, ship.tabulate(), setting=0, limits=Limits(), top_speed=ship.speeds[0]
    )


def arrivals_from(ship, network, node, time):
    """Return when the neighbours of a node are reached without waiting."""
    heads = network.graph.target[network.graph.indptr[node] : network.graph.indptr[node + 1]]
    found = earliest_arrival(ship, start=node, goal=None, depart=time, wait=False)
    return {int(head): float(found.node_arrival[head]) for head in heads}


def all_walks(ship, network, node, time):
    if node == network.meta.goal:
        yield time
        return
    for head, reached in arrivals_from(ship, network, node, time).items():
        yield from all_walks(ship, network, head, reached)


def greedy(ship, network):
    node, time = network.meta.start, START
    while node != network.meta.goal:
        node, time = min(arrivals_from(ship, network, node, time).items(), key=lambda item: item[1])
    return time


def exact(ship, network, wait=False):
    meta = network.meta
    return earliest_arrival(ship, start=meta.start, goal=meta.goal, depart=START, wait=wait).arrive


@pytest.mark.slow
def test_dynamic_programming_is_brute_force():
    small = layered_network(Chart.open_water(), PLACES, layers=3, fan=3, offset=8000.0)
    for number in range(3):
        ship = on_network(small, made_sea(number))
        assert exact(ship, small) == pytest.approx(min(all_walks(ship, small, 0, START)), abs=1e-3)


def test_greedy_never_beats_exact_in_any_month(network):
    """Twelve months of made weather: greedy loses in most of them, and never wins."""
    lost = []
    for month in range(12):
        ship = on_network(network, made_sea(month))
        lost.append(greedy(ship, network) - exact(ship, network))
    assert min(lost) >= -1e-3
    assert sum(x > 60.0 for x in lost) >= 6


def test_quasi_static_weather_converges_to_the_interpolated_one(network):
    """Chapter 4.2: the error of the passage falls with the step between updates."""
    sea = made_sea(5)
    true = exact(on_network(network, sea), network)
    errors = [
        abs(exact(on_network(network, sea.quasi_static(step)), network) - true)
        for step in (8.0, 2.0, 0.5, 0.125)
    ]
    assert errors[-1] < 10.0 < errors[0]
    assert errors[2] < 0.2 * errors[0]
