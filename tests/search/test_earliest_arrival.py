"""The earliest arrival: closed forms, limits, reasons, objectives, invalid requests."""

import networkx as nx
import numpy as np
import pytest

from tests.search.small import NO_LIMITS, grid, limits, line, make_fields, make_network, steady
from thalweg.core.errors import InputError
from thalweg.search import ShipOnNetwork, earliest_arrival

STILL = {"current_east": 0.0, "current_north": 0.0}


def sail(network, fields, *, speed=5.0, setting=0, limits=NO_LIMITS, top_speed=None, **options):
    top = speed if top_speed is None else top_speed
    ship = ShipOnNetwork(network, fields, steady(speed), setting, limits, top)
    given = {"start": 0, "goal": len(network.can_wait) - 1, "depart": 0.0}
    return earliest_arrival(ship, **(given | options))


@pytest.mark.parametrize("method", ["astar", "dijkstra"])
def test_a_constant_current_along_the_route(method):
    network = line(11, 3000.0)
    fields = make_fields(network, [0.0, 1e5], current_east=1.0, current_north=2.0)
    result = sail(network, fields, method=method)
    assert result.duration == pytest.approx(30e3 / (1.0 + np.sqrt(25.0 - 4.0)), rel=1e-6)
    back = sail(network, fields, start=10, goal=0, method=method)
    assert back.duration == pytest.approx(30e3 / (-1.0 + np.sqrt(25.0 - 4.0)), rel=1e-6)


@pytest.mark.parametrize("reach", [1, 2])
def test_a_static_network_agrees_with_networkx(reach):
    network = grid(8, 9, reach=reach)
    fields = make_fields(network, [0.0, 1e6], current_east=0.7, current_north=-0.4)
    graph = nx.DiGraph()
    tail, along = network.tails(), (0.7, -0.4)
    for e, v in enumerate(network.graph.target):
        c = np.array([np.sin(network.edges.course[e]), np.cos(network.edges.course[e])])
        across = along[1] * c[0] - along[0] * c[1]
        sog = np.dot(along, c) + np.sqrt(25.0 - across**2)
        graph.add_edge(
            int(tail[e]), int(v), time=network.edges.length[e] / sog, way=network.edges.length[e]
        )
    times = nx.single_source_dijkstra_path_length(graph, 0, weight="time")
    every = sail(network, fields, goal=None)
    assert every.node_arrival == pytest.approx([times[v] for v in range(72)], rel=1e-6)
    for goal in (8, 40, 71):
        assert sail(network, fields, goal=goal).arrive == pytest.approx(times[goal], rel=1e-6)
        way = nx.dijkstra_path_length(graph, 0, goal, weight="way")
        shortest = sail(network, fields, goal=goal, objective="distance")
        assert shortest.cost == pytest.approx(way, rel=1e-9)


def test_astar_settles_fewer_nodes_than_dijkstra():
    network = grid(25, 25, reach=2)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    one = sail(network, fields, start=0, goal=12, method="astar")
    other = sail(network, fields, start=0, goal=12, method="dijkstra")
    assert one.cost == pytest.approx(other.cost, rel=1e-9)
    assert one.settled * 4 < other.settled


def test_of_equally_short_paths_the_earlier_is_returned():
    lat, lon = [0.0, 0.1, -0.1, 0.0], [0.0, 0.1, 0.1, 0.2]  # north about or south about
    network = make_network(lat, lon, [(0, 1), (0, 2), (1, 3), (2, 3)])

    def north_fast(t, lat, lon):
        return np.where(lat > 0.05, 9.0, 5.0) + 0.0 * t

    fields = make_fields(network, [0.0, 1e6], speed_field=north_fast)
    result = sail(network, fields, objective="distance", speed=9.0)
    assert result.path.tolist() == [0, 1, 3]
    fields = make_fields(network, [0.0, 1e6], speed_field=lambda t, a, o: north_fast(t, -a, o))
    assert sail(network, fields, objective="distance").path.tolist() == [0, 2, 3]


def test_distance_and_time_choose_differently():
    lat, lon = [0.0, 0.1, 0.0], [0.0, 0.2, 0.4]
    network = make_network(lat, lon, [(0, 1), (1, 2), (0, 2)])

    def slow_on_the_line(t, lat, lon):
        return np.where(lat > 0.05, 8.0, np.where((lon > 0.1) & (lon < 0.3), 2.0, 4.0)) + 0.0 * t

    network = make_network(lat, lon, [(0, 1), (1, 2), (0, 2)], pieces=5)
    fields = make_fields(network, [0.0, 1e6], speed_field=slow_on_the_line)
    assert sail(network, fields).path.tolist() == [0, 1, 2]
    assert sail(network, fields, objective="distance").path.tolist() == [0, 2]


def test_penalty_factors_weigh_time_but_do_not_change_the_clock():
    lat, lon = [0.0, 0.02, 0.0], [0.0, 0.2, 0.4]
    direct_costs_double = make_network(
        lat, lon, [(0, 1), (1, 2), (0, 2)], factor=np.array([1.0, 1.0, 2.0])
    )
    fields = make_fields(direct_costs_double, [0.0, 1e6], **STILL)
    result = sail(direct_costs_double, fields)
    assert result.path.tolist() == [0, 1, 2]
    assert result.cost == pytest.approx(result.duration)
    only = make_network(lat, lon, [(0, 2)], factor=2.0)
    result = sail(only, fields)
    assert result.cost == pytest.approx(2.0 * result.duration)


def test_the_end_of_the_data_is_a_reason():
    network = line(11, 3000.0)
    fields = make_fields(network, [0.0, 4000.0], **STILL)
    result = sail(network, fields)
    assert not result.found
    assert set(result.refused) == {"outside the period of the data"}
    assert result.nearest_node == 6
    assert result.arrive == np.inf
    assert result.path_depart.size == 0
    early = sail(network, fields, depart=-1.0)
    assert (early.found, early.refused) == (False, {"outside the period of the data": 1})


def test_missing_data_is_a_reason_and_never_calm_water():
    network = line(6, 3000.0)
    current = np.zeros((6, 2))
    current[3, :] = np.nan
    fields = make_fields(network, [0.0, 1e5], current_east=current, current_north=0.0)
    result = sail(network, fields)
    assert not result.found
    assert result.refused == {"no data": 1}
    assert result.nearest_node == 2


def test_arrive_by_cuts_the_search():
    network = line(11, 3000.0)
    fields = make_fields(network, [0.0, 1e5], **STILL)
    exact = sail(network, fields).arrive
    assert sail(network, fields, arrive_by=exact + 0.01).found
    late = sail(network, fields, arrive_by=exact - 0.01)
    assert (late.found, late.refused) == (False, {"arrives too late": 1})


def test_the_ship_waits_until_waves_are_low_enough():
    network = line(3, 3000.0)
    times = np.arange(0.0, 36001.0, 3600.0)
    height = np.interp(times, [0.0, 18000.0, 36000.0], [6.0, 2.0, 2.0])
    fields = make_fields(network, times, wave_height_channel=height[None, :] + np.zeros((3, 1)))
    result = sail(network, fields, limits=limits(wave=4.0))
    calm_enough = 9000.0
    assert result.path_depart[0] == pytest.approx(calm_enough, abs=1.5)
    assert result.duration == pytest.approx(calm_enough + 1200.0, abs=2.0)
    assert not sail(network, fields, limits=limits(wave=4.0), wait=False).found
    assert sail(network, fields, limits=limits(wave=4.0), wait=False).refused == {
        "wave height above the limit": 1
    }


def test_start_and_goal_may_be_one():
    network = line(3, 3000.0)
    result = sail(network, make_fields(network, [0.0, 1e5], **STILL), start=1, goal=1, depart=7.0)
    assert (result.path.tolist(), result.cost, result.arrive) == ([1], 0.0, 7.0)
    assert result.path_depart.tolist() == [7.0]


def test_read_only_arrays_are_accepted():
    network = line(3, 3000.0)
    fields = make_fields(network, [0.0, 1e5], **STILL)
    before = sail(network, fields).arrive
    for array in (
        network.edges.length,
        network.graph.target,
        network.graph.indptr,
        fields.values,
        fields.times,
    ):
        array.flags.writeable = False
    assert sail(network, fields).arrive == before


@pytest.mark.parametrize(
    "wrong",
    [
        {"start": 3}, {"start": -1}, {"goal": 3}, {"depart": np.nan}, {"objective": "cost"},
        {"method": "guess"}, {"setting": 1}, {"top_speed": 0.0}, {"top_speed": np.nan},
        {"limits": np.array([1.0, 2.0])}, {"limits": np.array([np.nan, 1.0, 1.0])},
    ],
)  # fmt: skip
def test_invalid_requests_are_refused(wrong):
    network = line(3, 3000.0)
    with pytest.raises(InputError):
        sail(network, make_fields(network, [0.0, 1e5], **STILL), **wrong)


def test_fields_of_another_network_or_an_instant_are_refused():
    network, other = line(3, 3000.0), line(4, 3000.0)
    with pytest.raises(InputError, match="stations"):
        sail(network, make_fields(other, [0.0, 1e5], **STILL))
    with pytest.raises(InputError, match="times"):
        sail(network, make_fields(network, [0.0], **STILL))
    with pytest.raises(InputError, match="increase"):
        sail(network, make_fields(network, [0.0, 5.0, 5.0], **STILL))
