"""A bar that is dry until To: arrive, wait, continue (exact: max(s1/V, To) + (L - s1)/V)."""

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, steady
from thalweg.search import DepartureWindow, ShipOnNetwork, best_departure, earliest_arrival

HOUR = 3600.0
CLOSED, OPEN = -8.0, 0.0  # water level over a bed of 10 m; 5 m are needed


def bar(level_at_30_km, times, *, everywhere=False):
    """A way of 80 km in pieces of 2 km; the water level on the edge that leaves 30 km."""
    network = line(41, 2000.0, depth=10.0, pieces=2)
    level = np.zeros((len(network.stations.lat), len(times)))
    first = int(network.graph.indptr[15])
    beyond = next(
        e for e in range(first, network.graph.indptr[16]) if network.graph.target[e] == 16
    )
    level[network.samples.station_a[network.samples.ptr[beyond]]] = level_at_30_km
    if everywhere:
        level[:] = level_at_30_km
    return network, make_fields(network, times, water_level=level)


def on_network(network, fields):
    return ShipOnNetwork(
        network, fields, steady(4.0), setting=0, limits=limits(depth=5.0), top_speed=4.0
    )


def sail(network, fields, **options):
    given = {"start": 0, "goal": 40, "depart": 0.0}
    return earliest_arrival(on_network(network, fields), **(given | options))


def steep(opens, times):
    """A level that jumps up within a second."""
    return np.interp(times, [opens - 1.0, opens], [CLOSED, OPEN])


@pytest.mark.parametrize(("opens_h", "expected"), [(5.0, 30500.0), (1.0, 20000.0)])
@pytest.mark.parametrize("method", ["astar", "dijkstra"])
def test_a_ship_waits_at_a_bar_until_it_opens(opens_h, expected, method):
    opens = opens_h * HOUR
    times = np.unique(np.append(np.arange(0.0, 10 * HOUR, HOUR), [opens - 1.0, opens]))
    network, fields = bar(steep(opens, times), times)
    result = sail(network, fields, method=method)
    half = 250.0  # the middle of the edge is reached that much after leaving 30 km
    early = half if opens_h > 1 else 0.0
    assert result.arrive == pytest.approx(expected - early, abs=2.0)
    assert result.path.tolist() == list(range(41))
    assert result.waiting == pytest.approx(expected - early - 20000.0, abs=2.0)
    waits = np.flatnonzero(result.path_depart > result.path_arrive + 1.0)
    assert waits.tolist() == ([15] if opens_h > 1 else [])


def test_an_opening_between_two_times_of_the_data_is_found():
    times = np.arange(0.0, 10 * HOUR, HOUR)
    level = np.interp(times, [4 * HOUR, 5 * HOUR], [CLOSED, OPEN])
    network, fields = bar(level, times)
    opens = 4 * HOUR + HOUR * (-5.0 - CLOSED) / (OPEN - CLOSED)  # when the level is -5 m
    result = sail(network, fields)
    assert result.path_depart[15] + 250.0 == pytest.approx(opens, abs=1.5)
    assert result.arrive == pytest.approx(opens + 50e3 / 4.0 - 250.0, abs=2.0)


def test_a_window_at_high_water_shorter_than_the_step_of_the_data_is_found():
    times = np.arange(0.0, 10 * HOUR, HOUR)
    level = np.where(times == 5 * HOUR, -4.9, CLOSED)  # deep enough for 2 x 116 s
    network, fields = bar(level, times)
    result = sail(network, fields)
    opens = 5 * HOUR - HOUR * 0.1 / 3.1
    assert result.path_depart[15] + 250.0 == pytest.approx(opens, abs=1.0)


def test_without_waiting_the_bar_blocks_the_route():
    times = np.arange(0.0, 10 * HOUR, HOUR)
    network, fields = bar(np.interp(times, [4 * HOUR, 5 * HOUR], [CLOSED, OPEN]), times)
    result = sail(network, fields, wait=False)
    assert not result.found
    assert result.refused == {"under-keel clearance": 1}
    assert result.nearest_node == 15
    assert np.isfinite(result.node_arrival).sum() == 16


def test_a_bar_that_never_opens_is_refused_at_any_departure():
    times = np.arange(0.0, 10 * HOUR, HOUR)
    network, fields = bar(np.full(len(times), CLOSED), times, everywhere=True)
    result = sail(network, fields)
    assert not result.found
    assert result.refused == {"under-keel clearance": 1}


def test_a_ship_does_not_wait_where_it_would_fall_dry():
    times = np.arange(0.0, 12 * HOUR, 0.5 * HOUR)
    network, fields = bar(np.interp(times, [5 * HOUR, 6 * HOUR], [CLOSED, OPEN]), times)
    afloat = sail(network, fields)
    assert np.flatnonzero(afloat.path_depart > afloat.path_arrive + 1.0).tolist() == [15]
    dry = (times > 3 * HOUR) & (times < 4 * HOUR)  # at 30 km, while the bar beyond is shut
    fields.values[15, dry, 0] = CLOSED
    result = sail(network, fields)
    # Reaching 30 km first (after 2.1 h) is too early: the ship comes there on the next tide.
    assert result.arrive == pytest.approx(afloat.arrive, abs=2.0)
    assert result.path_arrive[15] > 3.5 * HOUR
    assert result.path_depart[14] > result.path_arrive[14] + HOUR
    assert result.node_arrival[15] == pytest.approx(30e3 / 4.0, abs=1.0)
    assert not sail(network, fields, arrive_by=6 * HOUR).found


def test_the_best_departure_arrives_as_the_bar_opens():
    times = np.arange(0.0, 14 * HOUR, HOUR)
    network, fields = bar(np.interp(times, [4 * HOUR, 5 * HOUR], [CLOSED, OPEN]), times)
    opens = 4 * HOUR + 0.375 * HOUR
    result = best_departure(
        on_network(network, fields), start=0, goal=40, window=DepartureWindow(0.0, 6 * HOUR)
    )
    assert result.duration == pytest.approx(20000.0, abs=2.0)
    assert result.depart >= opens - 30e3 / 4.0 - 250.0 - 2.0
