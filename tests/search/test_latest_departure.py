"""The latest departure that arrives by a time, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, make_network, steady
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.search.earliest_arrival import ArrivalQuery
from thalweg.search.latest_departure import latest_departure

SPEED, LEG = 4.0, 8000.0
SECONDS = LEG / SPEED  # of one leg
TIMES = 100.0 * np.arange(145)
OPENS = 9000.0  # the last node


def ship_in_waves(network, *closed):
    """Return a ship in waves above her limit at (node, from, to), where the limit is met."""
    height = np.full((network.n_stations, TIMES.size), 1.0)
    for node, begin, end in closed:
        high = np.interp(
            TIMES, [begin - 450.0, begin + 450.0, end - 450.0, end + 450.0], [1, 3, 3, 1]
        )
        height[node] = np.maximum(height[node], high)
    fields = make_fields(network, TIMES, wave_height_channel=height)
    return ShipOnNetwork(
        network, fields, steady(SPEED), setting=0, limits=limits(wave=2.0), top_speed=SPEED
    )


def test_a_ship_leaves_in_time_to_be_there_when_the_last_node_opens():
    ship = ship_in_waves(line(3, LEG), (2, -5000.0, OPENS))
    at_once = earliest_arrival(ship, start=0, goal=2, depart=0.0)
    assert at_once.arrive == pytest.approx(OPENS, abs=1.0)
    found = latest_departure(ship, ArrivalQuery(0, 2, 0.0), at_once.arrive + 1.0)
    assert found.depart == pytest.approx(OPENS - 2.0 * SECONDS, abs=2.0)
    assert found.waiting == pytest.approx(0.0, abs=1.0)
    assert found.arrive <= at_once.arrive + 1.0
    assert found.path.tolist() == [0, 1, 2]


def test_the_direct_way_is_found_where_a_ship_with_time_to_spare_takes_another():
    """Over node 3 the goal is open a second before it is over node 1."""
    lat, lon = [0.0, 0.0, 0.0, 0.05], np.array([0.0, LEG, 2.0 * LEG, LEG]) / 111_195.0
    network = make_network(lat, lon, [(0, 1), (1, 2), (0, 3), (3, 2)], pieces=2)
    middles = network.samples.station_a
    direct, detour = int(middles[2]), int(middles[3])  # in the order of the nodes they leave
    assert network.stations.lat[detour] > 0.01 > abs(network.stations.lat[direct])
    away = 0.5 * float(network.edges.length[3]) / SPEED
    closed = [(direct, -5000.0, OPENS), (detour, -5000.0, OPENS + 0.5 * SECONDS - away - 1.0)]
    ship = ship_in_waves(network, *closed)
    at_once = earliest_arrival(ship, start=0, goal=2, depart=0.0)
    assert at_once.path.tolist() == [0, 3, 2]
    found = latest_departure(ship, ArrivalQuery(0, 2, 0.0), at_once.arrive + 5.0)
    assert found.path.tolist() == [0, 1, 2]
    assert found.duration < at_once.duration - at_once.waiting


def test_water_that_closes_is_passed_before_it_does():
    """The middle of the first leg closes at 3000 s: the ship leaves 1000 s before, and waits."""
    network = line(3, LEG, pieces=2)
    middle = int(network.samples.station_a[0])
    ship = ship_in_waves(network, (middle, 3000.0, 20_000.0), (2, -5000.0, OPENS))
    at_once = earliest_arrival(ship, start=0, goal=2, depart=0.0)
    assert at_once.arrive == pytest.approx(OPENS, abs=1.0)
    found = latest_departure(ship, ArrivalQuery(0, 2, 0.0), at_once.arrive)
    assert 2000.0 - 60.0 <= found.depart <= 2000.0
    assert found.arrive == pytest.approx(at_once.arrive, abs=1.0)
    assert found.waiting == pytest.approx(OPENS - 2.0 * SECONDS - found.depart, abs=2.0)


def test_no_departure_is_later_than_allowed():
    ship = ship_in_waves(line(3, LEG), (2, -5000.0, OPENS))
    found = latest_departure(ship, ArrivalQuery(0, 2, 0.0), OPENS + 1.0, 2000.0)
    assert 2000.0 - 60.0 <= found.depart <= 2000.0


def test_there_is_no_later_departure_where_none_arrives_in_time():
    ship = ship_in_waves(line(3, LEG))
    assert latest_departure(ship, ArrivalQuery(0, 2, 0.0), 2.0 * SECONDS) is None
