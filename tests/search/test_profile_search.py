"""Profile search: the same results as separate searches, for every departure."""

from dataclasses import replace

import numpy as np
import pytest

from tests.search.small import (
    NO_LIMITS,
    limits,
    line,
    make_fields,
    make_network,
    make_table,
    steady,
)
from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.kernels import codes
from thalweg.kernels.search.repeated_search import CURRENT_DIRECTIONS
from thalweg.network import Samples
from thalweg.network.triangular_mesh.edge_sampling import sampled_on_triangle_sides
from thalweg.network.triangular_mesh.mesh_builder import mesh
from thalweg.operations.examples.estuary import synthetic_estuary
from thalweg.search import PreparedNetwork, ShipOnNetwork, earliest_arrival, prepare_profile_search
from thalweg.ship import Ship

T0 = parse_time("2026-06-01T00:00Z")
CHANNELS = (codes.CURRENT_EAST, codes.CURRENT_NORTH, codes.WATER_LEVEL)


@pytest.fixture(scope="module")
def world():
    estuary = synthetic_estuary(1200.0)
    nodes = estuary.sea.mesh()
    lat = np.concatenate([[estuary.load[0], estuary.unload[0]], nodes.lat])
    lon = np.concatenate([[estuary.load[1], estuary.unload[1]], nodes.lon])
    network = sampled_on_triangle_sides(mesh(estuary.chart, lat, lon, rings=2))
    fields = estuary.sea.freeze_stations(
        network.stations.lat, network.stations.lon, T0, T0 + 36 * 3600.0, CHANNELS
    )
    return network, fields


@pytest.fixture(scope="module")
def dredger():
    data = dict(Ship.load("hopper-dredger").data)
    return Ship.from_dict({**data, "models": {"squat": "van_halem_2019"}})


def ask(ship, load_factor, **more):
    loaded = ship.with_load_factor(load_factor)
    return {
        "table": loaded.tabulate(),
        "setting": 0,
        "limits": limits(depth=loaded.draught + 1.0),
        "top_speed": loaded.top_speed(0),
        **more,
    }


def separately(world, depart, *, start, goal, table, **more):
    network, fields = world
    one = {name: more.pop(name) for name in ("setting", "limits", "top_speed")}
    return earliest_arrival(
        ShipOnNetwork(network, fields, table, **one), start=start, goal=goal, depart=depart, **more
    )


@pytest.mark.parametrize(("load_factor", "start", "goal"), [(1.0, 0, 1), (0.6, 0, 1), (0.0, 1, 0)])
def test_every_departure_has_the_answer_of_a_separate_search(
    world, dredger, load_factor, start, goal
):
    asked = ask(dredger, load_factor, start=start, goal=goal)
    table = asked.pop("table")
    search = prepare_profile_search(PreparedNetwork.prepare(*world), table, **asked)
    departures = T0 + 3600.0 * np.array([0.5, 3.0, 5.25, 7.0, 9.1, 11.0, 13.3, 16.0, 19.0, 22.0])
    waited = 0
    for depart in departures:
        one = separately(world, depart, table=table, **asked)
        found = search.sail(depart)
        assert found.found == one.found
        assert found.arrive == pytest.approx(one.arrive, abs=1e-6)
        # the path arrives when it says, by its own waits
        assert np.all(np.diff(found.node_arrive) > 0)
        assert np.all(found.node_depart >= found.node_arrive - 1e-9)
        waited += found.waiting > 600.0
    assert load_factor < 1.0 or waited >= 2  # a full ship meets closed tides in this world


def test_all_departures_at_once_are_those_one_by_one(world, dredger):
    asked = ask(dredger, 1.0, start=0, goal=1)
    search = prepare_profile_search(PreparedNetwork.prepare(*world), asked.pop("table"), **asked)
    departures = T0 + 600.0 * np.arange(0, 150)
    profile = search.profile(departures)
    one_by_one = np.array([search.sail(t).arrive for t in departures])
    assert np.array_equal(profile.departures, departures)
    # who waits for the same opening arrives together, and openings are found to 0.1 s
    assert profile.arrivals == pytest.approx(one_by_one, abs=0.26)
    # who leaves later arrives later, but for departures between the times of the data, at which a
    # ship that waits leaves (see `wait_for_edge`)
    assert np.all(np.diff(profile.arrivals) >= -30.0)
    assert profile.searched < len(departures)  # plateaus of waiting are not searched
    for path in profile.paths:
        assert path.node_arrive[0] == path.depart
        assert path.arrive == path.node_arrive[-1]


def test_waiting_forbidden_is_never_waited(world, dredger):
    asked = ask(dredger, 0.6, start=0, goal=1, wait=False)
    table = asked.pop("table")
    search = prepare_profile_search(PreparedNetwork.prepare(*world), table, **asked)
    for depart in T0 + 3600.0 * np.array([1.0, 6.0, 12.0]):
        one = separately(world, depart, table=table, **asked)
        found = search.sail(depart)
        assert found.arrive == pytest.approx(one.arrive, abs=1e-6)
        assert found.waiting == 0.0


def test_waiting_at_anchorages_only(world, dredger):
    """As the search of single voyages, from where the ship may wait, wave after wave."""
    network, fields = world
    waiting = np.zeros(network.n_nodes, bool)
    waiting[[0, 1]] = True
    anchored = replace(network, can_wait=waiting)
    asked = ask(dredger, 1.0, start=0, goal=1)
    table = asked.pop("table")
    search = prepare_profile_search(PreparedNetwork.prepare(anchored, fields), table, **asked)
    for depart in T0 + 3600.0 * np.array([1.0, 8.0]):
        one = separately((anchored, fields), depart, table=table, **asked)
        found = search.sail(depart)
        assert found.found == one.found
        assert found.arrive == pytest.approx(one.arrive, abs=600.0)
        waits = found.node_depart - found.node_arrive
        assert np.all(waits[~waiting[found.nodes]] == 0.0)


def test_a_known_arrival_does_not_change_the_result(world, dredger):
    asked = ask(dredger, 1.0, start=0, goal=1)
    search = prepare_profile_search(PreparedNetwork.prepare(*world), asked.pop("table"), **asked)
    depart = T0 + 4.0 * 3600.0
    free = search.sail(depart)
    for known in (free.arrive, free.arrive + 3600.0, free.arrive - 1200.0):  # even a wrong one
        assert search.sail(depart, known=known).arrive == free.arrive


def test_bounds_are_below_every_passage(world, dredger):
    prepared = PreparedNetwork.prepare(*world)
    for load_factor in (0.0, 1.0):
        asked = ask(dredger, load_factor, start=0, goal=1)
        search = prepare_profile_search(prepared, asked.pop("table"), **asked)
        for depart in T0 + 3600.0 * np.array([2.0, 8.0, 14.0]):
            found = search.sail(depart)
            to_go = found.arrive - found.node_arrive
            assert np.all(search.to_goal.node[found.nodes] <= to_go + 1e-6)


def test_strongest_currents_bound_every_direction(world):
    prepared = PreparedNetwork.prepare(*world)
    values, index = prepared.sea.values, prepared.sea.channel_index
    u, v = values[:, :, index[codes.CURRENT_EAST]], values[:, :, index[codes.CURRENT_NORTH]]
    angle = 2.0 * np.pi * np.arange(CURRENT_DIRECTIONS) / CURRENT_DIRECTIONS
    for k, a in enumerate(angle):
        truth = (np.sin(a) * u + np.cos(a) * v).max(axis=1)
        assert np.all(prepared.strongest[:, k] >= truth - 1e-6)
        assert np.all(prepared.strongest[:, k] <= truth + 1e-4)


def test_penalties_count_as_in_separate_searches():
    lat, lon = [0.0, 0.05, 0.0, -0.05], [0.0, 0.05, 0.1, 0.05]
    edges = [(0, 1), (1, 2), (0, 3), (3, 2)]
    network = make_network(lat, lon, edges, factor=[3.0, 1.0, 1.0, 1.0], pieces=3)
    fields = make_fields(network, T0 + 3600.0 * np.arange(10), CURRENT_EAST=0.5, CURRENT_NORTH=0.2)
    table = steady(4.0)
    asked = {"start": 0, "goal": 2, "setting": 0, "limits": NO_LIMITS, "top_speed": 4.0}
    found = prepare_profile_search(PreparedNetwork.prepare(network, fields), table, **asked).sail(
        T0 + 60.0
    )
    one = separately((network, fields), T0 + 60.0, table=table, **asked)
    assert found.nodes.tolist() == one.path.tolist() == [0, 3, 2]
    assert found.arrive == pytest.approx(one.arrive, abs=1e-9)


def test_a_route_closed_at_every_tide_is_refused_before_the_search():
    network = make_network([0.0, 0.0], [0.0, 0.1], [(0, 1)], depth=5.0)
    fields = make_fields(network, T0 + 600.0 * np.arange(20), WATER_LEVEL=0.5)
    asked = {"start": 0, "goal": 1, "setting": 0, "top_speed": 4.0}
    prepared = PreparedNetwork.prepare(network, fields)
    shut = prepare_profile_search(prepared, steady(4.0), limits=limits(depth=6.0), **asked)
    assert shut.shortest == np.inf
    assert not shut.sail(T0).found
    assert (
        prepare_profile_search(prepared, steady(4.0), limits=limits(depth=5.4), **asked)
        .sail(T0)
        .found
    )


def test_bad_questions():
    network = make_network([0.0, 0.0], [0.0, 0.1], [(0, 1)])
    fields = make_fields(network, T0 + 600.0 * np.arange(20), CURRENT_EAST=0.0, CURRENT_NORTH=0.0)
    prepared = PreparedNetwork.prepare(network, fields)
    asked = {"setting": 0, "limits": NO_LIMITS, "top_speed": 4.0}
    with pytest.raises(InputError, match="from node 0 to node 0 is not possible"):
        prepare_profile_search(prepared, steady(4.0), start=0, goal=0, **asked)
    search = prepare_profile_search(prepared, steady(4.0), start=0, goal=1, **asked)
    with pytest.raises(InputError, match="do not ascend"):
        search.profile([T0 + 60.0, T0])
    other = make_network([0.0, 0.0, 0.0], [0.0, 0.1, 0.2], [(0, 1)])
    with pytest.raises(InputError, match="stations"):
        PreparedNetwork.prepare(other, fields)


HOUR = 3600.0


def search_on(network, fields, table, **asked):
    asked = {"setting": 0, "limits": NO_LIMITS, "top_speed": 5.0, "start": 0, **asked}
    search = prepare_profile_search(PreparedNetwork.prepare(network, fields), table, **asked)
    return search, lambda t, **more: separately((network, fields), t, table=table, **asked, **more)


@pytest.mark.parametrize("by_depth", [False, True])
def test_water_of_no_charted_depth_is_deep_enough(by_depth):
    """Depths of +inf (not checked) with a required depth and a water level."""
    network = line(5, 1000.0)
    still = {"current_east": 0.0, "current_north": 0.0, "water_level": 0.0}
    fields = make_fields(network, [0.0, HOUR, 2 * HOUR], **still)
    grid = np.linspace(5.0, 25.0, 21)
    speeds = 3.0 + np.linspace(0.0, 1.0, 21)[:, None] ** 0.5
    table = make_table(((codes.AXIS_DEPTH,), (grid,), speeds)) if by_depth else steady(4.0)
    search, alone = search_on(network, fields, table, goal=4, limits=limits(depth=6.0))
    assert search.sail(0.0).arrive == alone(0.0).arrive == pytest.approx(1000.0)
    assert 799.0 < search.shortest <= 1000.0  # 4 km at the top speed named


def between_two_stations(bed, east):
    """A leg from node 0 to 1 whose samples lie midway between nodes 2 and 3."""
    network = line(4, 10_000.0)
    edges, inside = network.n_edges, 9
    network = replace(
        network,
        samples=Samples(
            ptr=np.arange(edges + 1) * inside,
            station_a=np.full(edges * inside, 2, np.int32),
            station_b=np.full(edges * inside, 3, np.int32),
            weight=np.full(edges * inside, 0.5, np.float32),
            fraction=np.tile(np.arange(1, inside + 1) / (inside + 1.0), edges).astype(np.float32),
        ),
    )
    wide = np.array([10.0, 10.0, *bed])[:, None], np.array([0.0, 0.0, *east])[:, None]
    return network, make_fields(
        network, [0.0, 10 * HOUR], bed_depth=wide[0] + np.zeros((4, 2)),
        current_east=wide[1] + np.zeros((4, 2)), current_north=0.0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("bed", "east"),
    [
        ((20.0, 5.0), (0.0, 2.0)),  # the current of a bank with the depth beside it
        ((25.0, 6.5), (0.0, 0.8)),  # speed grows with depth, but ever less
    ],
)
def test_bounds_hold_for_mixtures_of_two_stations(bed, east):
    network, fields = between_two_stations(bed, east)
    grid = np.linspace(5.0, 25.0, 21)
    speeds = 3.0 + 2.0 * np.linspace(0.0, 1.0, 21)[:, None] ** 0.2
    table = make_table(((codes.AXIS_DEPTH,), (grid,), speeds))
    search, alone = search_on(network, fields, table, goal=1, limits=limits(depth=6.0))
    truth = alone(0.0).arrive
    assert search.shortest <= truth
    assert search.sail(0.0).arrive == truth


def test_penalties_weigh_but_do_not_shorten_the_period():
    """30 km at 4 m/s in 3 hours of data; a penalty of 2 makes a cost of over four hours of it."""
    network = line(4, 10_000.0, factor=2.0)
    fields = make_fields(network, [0.0, 3 * HOUR], current_east=0.0, current_north=0.0)
    search, alone = search_on(network, fields, steady(4.0), goal=3)
    assert search.sail(0.0).arrive == alone(0.0).arrive == pytest.approx(7500.0)
    assert search.sail(0.0, known=7500.0).arrive == pytest.approx(7500.0)
    assert not search.sail(3400.0).found  # after the data
    assert search.sail(0.0, arrive_by=7501.0).found
    assert not search.sail(0.0, arrive_by=7499.0).found
    profile = search.profile([0.0, 1000.0, 3200.0, 3400.0])
    assert profile.arrivals == pytest.approx([7500.0, 8500.0, 10_700.0, np.inf])
    assert profile.searched == 4
