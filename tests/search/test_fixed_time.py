"""Edges of fixed time: canals are passed in their time in any sea."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.search.small import NO_LIMITS, limits, make_fields, make_network, steady
from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError
from thalweg.network import check_network, globe, shortest_path
from thalweg.search import (
    DepartureWindow,
    ShipOnNetwork,
    best_departure,
    earliest_arrival,
    lower_bound,
)

TIMES = np.linspace(0.0, 400_000.0, 9)
HOUR = 3600.0


def with_canal(network, pairs, time, *, length=None, fee=0.0):
    """Return the network with edges between pairs of nodes that take a fixed time."""
    fixed, fees = network.edges.fixed_time.copy(), network.edges.fee.copy()
    lengths = network.edges.length.copy()
    tails = network.tails()
    for a, b in pairs:
        edge = np.flatnonzero((tails == a) & (network.graph.target == b))
        fixed[edge], fees[edge] = time, fee
        if length is not None:
            lengths[edge] = length
    return network.with_edges(fixed_time=fixed, fee=fees, length=lengths)


def square(**options):
    """Return four corners 0-1-2-3 of a square of 20 nm, and a canal across 0-2."""
    lat, lon = [0.0, 1 / 3, 1 / 3, 0.0], [0.0, 0.0, 1 / 3, 1 / 3]
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    edges = ring + [(b, a) for a, b in ring] + [(0, 2), (2, 0)]
    return make_network(lat, lon, edges, pieces=3, **options)


def search(network, fields, speed=5.0, limits=NO_LIMITS, **options):
    ship = ShipOnNetwork(network, fields, steady(speed), 0, limits, speed)
    return earliest_arrival(ship, **{"start": 0, "goal": 2, "depart": 0.0, **options})


def test_defaults_are_sailed_edges_without_fees():
    network = square()
    check_network(network)
    assert np.isnan(network.edges.fixed_time).all() and (network.edges.fee == 0.0).all()
    assert len(network.edges.fixed_time) == network.n_edges


def test_a_canal_is_passed_in_its_time_through_any_sea():
    network = with_canal(square(), [(0, 2), (2, 0)], 2.5 * HOUR, length=60_000.0, fee=1000.0)
    check_network(network)
    fields = make_fields(network, TIMES, current_east=-20.0, current_north=-20.0)
    blocked = search(network, fields, speed=1.0)
    assert blocked.path.tolist() == [0, 2]
    assert blocked.arrive == 2.5 * HOUR
    unknown = make_fields(network, TIMES, current_east=np.nan, current_north=0.0)
    assert search(network, unknown).arrive == 2.5 * HOUR
    shallow = search(square(depth=3.0), make_fields(network, TIMES, water_level=0.0))
    assert shallow.found
    deep = with_canal(square(depth=3.0), [(0, 2)], 2.5 * HOUR)
    result = search(deep, make_fields(deep, TIMES, water_level=0.0), limits=limits(depth=10.0))
    assert result.path.tolist() == [0, 2] and result.arrive == 2.5 * HOUR


def test_the_slower_canal_is_left_alone_and_the_quicker_one_is_taken():
    base = square()
    fields = make_fields(base, TIMES, current_east=0.0, current_north=0.0)
    around = search(with_canal(base, [(0, 2)], 1e5), fields)
    assert len(around.path) == 3
    assert around.arrive == pytest.approx(base.edges.length[0] / 5.0 * 2, rel=1e-2)
    through = search(with_canal(base, [(0, 2)], around.arrive - 1.0), fields)
    assert through.path.tolist() == [0, 2]


def test_the_length_of_a_canal_counts_by_distance():
    network = with_canal(square(), [(0, 2)], HOUR, length=90_000.0)
    fields = make_fields(network, TIMES, current_east=0.0, current_north=0.0)
    assert len(search(network, fields, objective="distance").path) == 3
    assert len(shortest_path(network, 0, 2)[1]) == 3
    assert shortest_path(network, 0, 2, weight=network.times(5.0))[1] == [0, 2]


@pytest.mark.parametrize("method", ["astar", "dijkstra"])
def test_a_canal_faster_than_the_ship_does_not_mislead_astar(method):
    # goal 3 beyond the canal 1-2; the detour by 4 seems shorter to a bound by the ship's speed
    lat = [0.0, 1.0, 1.0, 0.0, 0.2]
    lon = [0.0, 0.0, 5.0, 5.0, 2.5]
    edges = [(0, 1), (1, 2), (2, 3), (0, 4), (4, 3)]
    network = with_canal(make_network(lat, lon, edges, pieces=4), [(1, 2)], 0.5 * HOUR)
    fields = make_fields(network, np.linspace(0, 2e6, 5), current_east=0.0, current_north=0.0)
    result = search(network, fields, speed=1.0, goal=3, method=method)
    assert result.path.tolist() == [0, 1, 2, 3]


@given(st.integers(0, 10_000))
def test_astar_equals_dijkstra_on_random_networks_with_canals(seed):
    rng = np.random.default_rng(seed)
    lat, lon = rng.uniform(-3, 3, 14), rng.uniform(176, 184, 14)
    pairs = {tuple(pair) for pair in rng.integers(0, 14, (60, 2)) if pair[0] != pair[1]}
    network = make_network(lat, lon, sorted(pairs), pieces=2)
    fixed = np.where(rng.random(network.n_edges) < 0.2, rng.uniform(1e3, 2e5), np.nan)
    stretch = np.where(np.isnan(fixed), 1.0, rng.uniform(1.0, 1.5, network.n_edges))
    network = network.with_edges(fixed_time=fixed, length=network.edges.length * stretch)
    fields = make_fields(network, np.linspace(0, 3e6, 5), current_east=0.3, current_north=-0.2)
    for objective in ("time", "distance"):
        results = [
            search(network, fields, speed=4.0, goal=13, method=method, objective=objective)
            for method in ("astar", "dijkstra")
        ]
        assert results[0].cost == pytest.approx(results[1].cost, rel=1e-12)
        if results[0].found:
            bound = lower_bound(
                ShipOnNetwork(
                    network, fields, steady(4.0), setting=0, limits=NO_LIMITS, top_speed=4.0
                ),
                start=0,
                goal=13,
                depart=0.0,
                objective=objective,
            )
            assert bound.value <= results[0].cost * (1 + 1e-9)


def test_departure_windows_pass_canals_too():
    network = with_canal(square(), [(0, 2)], HOUR)
    fields = make_fields(network, TIMES, current_east=0.0, current_north=0.0)
    result = best_departure(
        ShipOnNetwork(network, fields, steady(5.0), setting=0, limits=NO_LIMITS, top_speed=5.0),
        start=0,
        goal=2,
        window=DepartureWindow(0.0, 7200.0),
    )
    assert result.duration == HOUR


def test_canals_and_nodes_that_fall_dry():
    # node 1 is dry but for two tides; the canal 0-1 arrives in the dry: the ship waits for water
    network = make_network([0.0, 0.0, 0.0], [0.0, 0.1, 0.2], [(0, 1), (1, 2)], depth=5.0)
    network = with_canal(network, [(0, 1)], 2.0 * HOUR)
    times = np.arange(0.0, 40 * HOUR, 900.0)
    tide = 3.0 * np.cos(2 * np.pi * times / (12.42 * HOUR))
    fields = make_fields(network, times, water_level=np.broadcast_to(tide, (3, len(times))))
    result = search(network, fields, limits=limits(depth=7.0), depart=5 * HOUR)
    assert result.found
    lock = result.path_depart[0]
    assert result.path_arrive[1] == pytest.approx(lock + 2 * HOUR)


def test_broken_fixed_times_are_named():
    base = square()
    for name, value, said in (
        ("fixed_time", -1.0, "fixed time"),
        ("fee", np.nan, "fee"),
        ("fee", -2.0, "fee"),
    ):
        column = getattr(base.edges, name).copy()
        column[0] = value
        with pytest.raises(InputError, match=said):
            check_network(base.with_edges(**{name: column}))
    short = with_canal(base, [(0, 2)], HOUR, length=10_000.0)
    assert float(geodesy.distance(0.0, 0.0, 1 / 3, 1 / 3)) > 10_000.0
    with pytest.raises(InputError, match="canal is shorter than the geodesic"):
        check_network(short)
    with pytest.raises(InputError, match="fixed_time has 3 entries"):
        check_network(base.with_edges(fixed_time=np.full(3, 9.0)))


def test_a_ship_sails_the_globe_network_through_a_canal_and_round_when_it_is_forbidden():
    chart = Chart.gshhg("c")
    table, speed = steady(7.0), 7.0
    found = []
    for allowed in (chart, chart.without_canals("panama")):
        network = globe(allowed, (12.0, -77.0), (6.0, -80.5), coast_levels=3, slack=0.1)
        times = np.array([0.0, 5e6])
        fields = make_fields(network, times, current_east=0.0, current_north=0.0)
        ends = {"start": network.meta.start, "goal": network.meta.goal}
        ship = ShipOnNetwork(network, fields, table, setting=0, limits=NO_LIMITS, top_speed=speed)
        result = earliest_arrival(ship, depart=0.0, **ends)
        distance, path = shortest_path(network, *ends.values(), weight=network.times(speed))
        assert result.arrive == pytest.approx(distance[ends["goal"]], rel=1e-6)
        assert result.path.tolist() == path
        assert lower_bound(ship, depart=0.0, **ends).value <= result.duration
        found.append(result.duration)
    panama = chart.canals[1]
    assert panama.transit_time < found[0] < panama.transit_time + 500 * 1852 / speed
    assert found[1] > 10.0 * found[0]


def test_a_useless_edge_that_is_blocked_further_on_is_not_passed():
    """An edge is given up at its tail as slower than a canal; high waves close it 1 km on."""
    lat, lon = geodesy.direct(0.0, 0.0, np.pi / 2, np.array([0.0, 4000.0, 8000.0]))
    network = make_network(lat, lon, [(0, 1), (0, 2), (1, 2)], pieces=8)
    network = with_canal(network, [(0, 1), (1, 2)], 750.0)
    first = int(network.samples.station_a[network.samples.ptr[1]])  # of the edge from 0 to 2
    current, waves = np.zeros((2, network.n_stations, TIMES.size))
    current[0], waves[first] = -3.0, 9.0
    fields = make_fields(
        network, TIMES, current_east=current, current_north=0.0, wave_height_channel=waves
    )
    depart = TIMES[1] - 100.0  # soon before a time of the data, at which a wait may be of use
    result = search(network, fields, 4.0, limits(wave=2.0), depart=depart)
    assert result.path.tolist() == [0, 1, 2]
    assert result.cost == pytest.approx(1500.0)
