"""Departures at the roots of limits: closed forms, and random networks against brute force."""

from __future__ import annotations

import numpy as np
import pytest

from tests.campaigns.waiting_campaign import DEPART, TOLERANCE, WaitingCase
from tests.search.small import limits, line, make_fields, steady
from thalweg.kernels.search.edge_departure import OPENING_TOLERANCE
from thalweg.search import ShipOnNetwork, earliest_arrival

SPEED = 4.0
HALF_HOUR = 1800.0
TIMES = HALF_HOUR * np.arange(13)


def leg(fields, network, given, depart=100.0):
    """Return (departure, arrival) of the only leg."""
    ship = ShipOnNetwork(network, fields, steady(SPEED), setting=0, limits=given, top_speed=SPEED)
    found = earliest_arrival(ship, start=0, goal=1, depart=depart)
    assert found.found
    return float(found.path_depart[0]), float(found.arrive)


def test_a_minute_of_low_waves_halfway_is_found():
    """Waves at the middle of the leg pass below 2 m for one minute, round a time of the data."""
    network = line(2, 8000.0, pieces=2)
    deep = 0.1 * 30.0 / (HALF_HOUR - 30.0)  # below the limit for 30 s before and after
    height = np.full((network.n_stations, TIMES.size), 1.0)
    middle = int(network.samples.station_a[0])
    height[middle] = 2.1
    height[middle, 5] = 2.0 - deep
    fields = make_fields(network, TIMES, wave_height_channel=height)
    departure, arrival = leg(fields, network, limits(wave=2.0))
    passing = TIMES[5] - 30.0
    assert departure == pytest.approx(passing - 1000.0, abs=2 * OPENING_TOLERANCE)
    assert arrival == pytest.approx(passing + 1000.0, abs=2 * OPENING_TOLERANCE)


def test_a_minute_between_rising_water_and_rising_waves_is_found():
    """One sample floats a minute before the waves at the next are too high: no time of data."""
    network = line(2, 12000.0, pieces=3)
    first, second = (int(k) for k in network.samples.station_a[:2])
    level = np.full((network.n_stations, TIMES.size), 10.0)
    height = np.full((network.n_stations, TIMES.size), 1.0)
    floats, apart = TIMES[3] + 700.0, 1000.0  # apart: time from one sample to the next
    level[first] = 5.0 + (TIMES - floats) / 3600.0
    level[first, 9:] = 0.0
    height[second] = 2.0 + (TIMES - (floats + apart + 60.0)) / 7200.0
    fields = make_fields(
        network, TIMES, water_level=level, bed_depth=0.0, wave_height_channel=height
    )
    departure, arrival = leg(fields, network, limits(depth=5.0, wave=2.0))
    assert departure == pytest.approx(floats - 1000.0, abs=2 * OPENING_TOLERANCE)
    assert arrival == pytest.approx(floats + 2000.0, abs=2 * OPENING_TOLERANCE)


def test_the_root_of_the_wind_speed_is_that_of_a_square():
    network = line(2, 4000.0)
    east = np.zeros((2, TIMES.size))
    north = np.zeros((2, TIMES.size))
    east[1], north[1] = np.linspace(12.0, -12.0, TIMES.size), 6.0
    fields = make_fields(network, TIMES, wind_east=east, wind_north=north)
    _, arrival = leg(fields, network, limits(wind=10.0))
    rate = 24.0 / TIMES[-1]
    assert arrival == pytest.approx((12.0 - 8.0) / rate, abs=2 * OPENING_TOLERANCE)


def test_a_ship_waits_for_a_weaker_current_between_the_times_of_data():
    """Against a falling current the least arrival is neither at the opening nor at a data time."""
    network = line(2, 3000.0)
    east = -np.interp(TIMES, [0, TIMES[4], TIMES[5], TIMES[12]], [6.0, 6.0, 0.0, 0.0])
    fields = make_fields(network, TIMES, current_east=np.stack([east, east]), current_north=0.0)
    departure, arrival = leg(fields, network, limits())
    clock = np.arange(TIMES[4], TIMES[5], 0.5)
    along = SPEED - 6.0 * (TIMES[5] - clock) / HALF_HOUR
    open_at = clock[along > 0.0]
    predicted = open_at + 3000.0 / along[along > 0.0]
    then = SPEED - 6.0 * np.clip((TIMES[5] - predicted) / HALF_HOUR, 0.0, 1.0)
    arrivals = open_at + 1500.0 / along[along > 0.0] + 1500.0 / then
    assert arrival == pytest.approx(arrivals.min(), abs=0.1)
    assert open_at[0] + 10.0 < departure < TIMES[5] - 10.0


@pytest.mark.parametrize("seed", range(1, 9))
def test_no_departure_at_a_minute_arrives_earlier(seed):
    case = WaitingCase.random(seed)
    assert case.arrival() <= case.brute_force() + TOLERANCE


@pytest.mark.parametrize("seed", [3, 14, 25, 36, 47, 58])
def test_a_search_of_all_nodes_arrives_as_early_as_one_for_each(seed):
    case = WaitingCase.random(seed)
    ship = case.on_network()
    everywhere = earliest_arrival(ship, start=0, goal=None, depart=DEPART).node_arrival
    apart = [
        earliest_arrival(ship, start=0, goal=node, depart=DEPART).arrive
        for node in range(1, case.network.n_nodes)
    ]
    without = earliest_arrival(ship, start=0, goal=None, depart=DEPART, wait=False).node_arrival
    np.testing.assert_allclose(everywhere[1:], apart, rtol=0.0, atol=TOLERANCE)
    assert (everywhere <= without).all()
