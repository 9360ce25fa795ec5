"""The front of time against cost: real paths, brute force, laws of speed, refused input."""

from __future__ import annotations

import dataclasses
import itertools
from dataclasses import replace

import numpy as np
import pytest

from tests.search.small import NO_LIMITS, grid, limits, line, make_fields, make_network, make_table
from tests.search.test_restricted_waiting import barred_line
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.objective import FUEL_MASS, LegPrices
from thalweg.kernels import codes
from thalweg.search import ShipOnNetwork, cheapest, earliest_arrival, pareto_front
from thalweg.search.pareto.front_problem import (
    FrontQuery,
    FrontRequest,
    MultiSettingShipOnNetwork,
    make_front_problem,
)
from thalweg.search.pareto.seed_paths import PlannedPath, sail_planned_path

SPEEDS = np.array([4.0, 6.0, 8.0])
QUERY = {field.name for field in dataclasses.fields(FrontQuery)}
STILL = {"current_east": 0.0, "current_north": 0.0}


def ship(speeds=SPEEDS, per_cube=1e-3):
    speeds = np.asarray(speeds, float)
    return make_table(((), (), speeds)), make_table(((), (), per_cube * speeds**3))


def search(
    network, fields, goal, latest, *, tables=None, limits=NO_LIMITS, top_speed=None, **options
):
    table, fuel = ship() if tables is None else tables
    on_network = MultiSettingShipOnNetwork(network, fields, table, fuel, limits, top_speed)
    asked = {name: options.pop(name) for name in QUERY & options.keys()}
    query = FrontQuery(**{"start": 0, "goal": goal, "depart": 0.0, "latest": latest, **asked})
    return pareto_front(on_network, query, **options)


def world_of(
    network, fields, latest, *, tables=None, wait=True, eca_fraction=0.0, prices=FUEL_MASS
):
    """Return what sails paths one by one, for brute force."""
    table, fuel = ship() if tables is None else tables
    inside = np.broadcast_to(np.asarray(eca_fraction, float), (network.n_edges,))
    request = FrontRequest(
        0, network.n_nodes - 1, 0.0, latest, np.arange(table.n_settings), prices,
        prices.of_legs(inside, 1.0), wait,
    )  # fmt: skip
    on_network = MultiSettingShipOnNetwork(network, fields, table, fuel, NO_LIMITS)
    return make_front_problem(on_network, request), request


def random_world(seed, *, columns=4, calm=False):
    """Return a network without circles, in currents that change in time and place."""
    rng = np.random.default_rng(seed)
    n = 2 * columns
    lat = np.repeat([0.0, 0.08], columns)[np.argsort(np.tile(np.arange(columns), 2))]
    lon = 0.1 * (np.arange(n) // 2)
    lat = 0.08 * (np.arange(n) % 2)
    lat, lon = lat + 0.02 * rng.random(n), lon + 0.02 * rng.random(n)
    edges = [(i, j) for i in range(n) for j in range(i + 1, min(i + 4, n)) if rng.random() < 0.8]
    edges += [(i, i + 2) for i in range(n - 2) if (i, i + 2) not in edges]
    network = make_network(lat, lon, sorted(set(edges)), pieces=2)
    times = np.linspace(0.0, 60_000.0, 31)
    strength = 0.0 if calm else 1.5
    phase = 6.28 * rng.random((2, network.n_stations, 1))
    flow = strength * np.sin(2 * np.pi * times / 25_000.0 + phase)
    return network, make_fields(network, times, current_east=flow[0], current_north=flow[1])


def all_paths(network, goal):
    """Yield every way from node 0 to the goal of a network without circles, as edges."""
    stack = [(0, ())]
    while stack:
        node, edges = stack.pop()
        if node == goal:
            yield edges
            continue
        for e in range(network.graph.indptr[node], network.graph.indptr[node + 1]):
            stack.append((int(network.graph.target[e]), (*edges, e)))


def brute_force(network, fields, latest, *, pauses=(0.0,), **prices):
    """Return (time, cost) of all paths, settings and pauses before edges."""
    got, request = world_of(network, fields, latest, **prices)
    found = []
    for edges in all_paths(network, request.goal):
        edges = np.array(edges)
        states = np.append(got.tails[edges], request.goal)
        for choice in itertools.product(range(len(request.settings)), repeat=len(edges)):
            for pause in itertools.product(pauses, repeat=len(edges) if len(pauses) > 1 else 1):
                point = _sail_pausing(got, request, states, edges, np.array(choice), pause)
                if point is not None and point.time <= latest:
                    found.append((point.time, point.cost))
    return np.array(sorted(found))


def _sail_pausing(got, request, states, edges, choices, pause):
    leave = np.full(len(edges), -np.inf)
    point = sail_planned_path(got, request, PlannedPath(states, edges, choices, leave))
    if point is None or not any(pause):
        return point
    for i, length in enumerate(pause):  # each pause begins at the arrival found so far
        leave[i] = point.path_arrive[i] + length if length else -np.inf
        point = sail_planned_path(got, request, PlannedPath(states, edges, choices, leave))
        if point is None:
            return None
    return point


def least(points, time):
    """Return the least cost of (time, cost) rows up to a time."""
    return points[points[:, 0] <= time * (1 + 1e-12), 1].min(initial=np.inf)


@pytest.mark.parametrize("seed", range(4))
def test_front_is_that_of_brute_force_without_waiting(seed):
    network, fields = random_world(seed)
    latest = 16_000.0
    found = search(network, fields, 7, latest, wait=False, bin_s=4.0, lower=False)
    every = brute_force(network, fields, latest, wait=False)
    assert len(found.points) > 8
    for point in found.points:  # no real path is better
        assert point.cost >= least(every, point.time) * (1 - 1e-9)
    for time, cost in every[np.minimum.accumulate(every[:, 1]) == every[:, 1]]:
        reached = found.cost[found.time <= time + 3 * found.bin_s].min(initial=np.inf)
        assert reached <= cost * (1 + 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 3])
def test_lower_front_is_below_brute_force_with_waiting(seed):
    """Pauses of 1000 and 3000 s before any edge; also no front point is far above."""
    network, fields = random_world(seed, columns=3)
    latest, pauses, prices = 20_000.0, (0.0, 1000.0, 3000.0), LegPrices(waiting=0.002)
    found = search(network, fields, 5, latest, bin_s=10.0, prices=prices)
    every = brute_force(network, fields, latest, pauses=pauses, prices=prices)
    assert len(every) > 2000
    for time, cost in every[np.minimum.accumulate(every[:, 1]) == every[:, 1]]:
        assert found.lower_at(time) <= cost * (1 + 1e-9)
        reached = found.cost[found.time <= time + 3 * found.bin_s].min(initial=np.inf)
        assert reached <= cost * (1 + 5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("wait", [True, False])
@pytest.mark.parametrize("seed", range(3))
def test_lower_front_is_below_brute_force(seed, wait):
    network, fields = random_world(seed)
    latest = 16_000.0
    every = brute_force(network, fields, latest, wait=wait)
    for bin_s in (100.0, 5.0):
        found = search(network, fields, 7, latest, wait=wait, bin_s=bin_s)
        for time, cost in every:
            assert found.lower_at(time) <= cost * (1 + 1e-9)


def eddies(network, strength=1.0):
    def flow(part):
        def value(t, lat, lon):
            return strength * np.sin(part + 15.0 * lat + 20.0 * lon + 2e-4 * t)

        return value

    times = np.arange(0.0, 40_001.0, 500.0)
    return make_fields(network, times, current_east=flow(0.0), current_north=flow(1.0))


@pytest.mark.slow
@pytest.mark.parametrize("wait", [True, False])
def test_certificate_closes_with_the_bins(wait):
    network = grid(5, 8)
    tables = ship(np.arange(4.0, 8.01, 0.5))
    gaps = []
    for bin_s in (160.0, 40.0, 2.5):
        found = search(
            network, eddies(network), 39, 16_000.0, tables=tables, wait=wait, bin_s=bin_s
        )
        assert np.all(found.gap >= 0.0) and np.all(np.diff(found.lower_cost) < 0.0)
        gaps.append(np.median(found.gap))
    assert gaps[0] > 2.0 * gaps[1] and gaps[1] > 2.0 * gaps[2] and gaps[2] < 0.001


@pytest.mark.parametrize("prices", [FUEL_MASS, LegPrices(time=5.0), LegPrices(waiting=1.0)])
def test_certificate_where_the_sea_changes_fast_between_slices(prices):
    """A current holds the ship for a moment, so that tables are off by more than they say."""
    network = line(5, 500.0)
    times = np.arange(0.0, 40_001.0, 4000.0)
    against = np.where(np.arange(len(times)) % 2 == 1, -3.995, 0.0)
    fields = make_fields(network, times, current_east=against[None, :], current_north=0.0)
    gaps = []
    for bin_s in (500.0, 10.0):
        found = search(network, fields, 4, 12_000.0, tables=ship([4.0]), bin_s=bin_s, prices=prices)
        assert np.all(found.gap >= 0.0) and np.all(np.diff(found.lower_cost) <= 0.0)
        gaps.append(found.gap.max())
    assert gaps[1] < gaps[0] and gaps[1] < 0.07


def test_lower_front_where_some_nodes_do_not_let_wait():
    network, fields = random_world(3)
    can_wait = np.arange(network.n_nodes) % 2 == 0
    network = replace(network, can_wait=can_wait)
    found = search(network, fields, 7, 16_000.0, bin_s=10.0, prices=LegPrices(waiting=0.002))
    every = brute_force(network, fields, 16_000.0)
    for time, cost in every:
        assert found.lower_at(time) <= cost * (1 + 1e-9)
    for point in found.points:
        pauses = point.path_depart - point.path_arrive
        assert np.all(pauses[:-1][~can_wait[point.path[:-1]]] == 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_points_are_real_paths(seed):
    network, fields = random_world(seed)
    priced = {
        "prices": LegPrices(inside=2.0, time=0.01, waiting=0.02),
        "eca_fraction": np.arange(network.n_edges) / network.n_edges,
    }
    found = search(network, fields, 7, 20_000.0, bin_s=20.0, lower=False, **priced)
    got, request = world_of(network, fields, 20_000.0, **priced)
    pairs = {(int(t), int(h)): e for e, (t, h) in enumerate(zip(got.tails, network.graph.target))}
    for point in found.points:
        time, cost = 0.0, 0.0
        for i, setting in enumerate(point.setting):
            edge = pairs[int(point.path[i]), int(point.path[i + 1])]
            pause = point.path_depart[i] - point.path_arrive[i]
            leg = sail_planned_path(
                got,
                request._replace(depart=point.path_depart[i]),
                PlannedPath(
                    point.path[i : i + 2],
                    np.array([edge]),
                    np.array([setting]),
                    np.array([-np.inf]),
                ),
            )
            time += pause + leg.time
            cost += pause * 0.03 + leg.cost
        assert point.path[0] == 0 and point.path[-1] == 7
        assert point.time == pytest.approx(time, rel=1e-12)
        assert point.cost == pytest.approx(cost, rel=1e-12)
        assert point.arrive == pytest.approx(point.time)
    assert np.all(np.diff(found.time) > 0.0) and np.all(np.diff(found.cost) < 0.0)


def test_legs_are_those_of_the_earliest_arrival():
    network, fields = random_world(5)
    table, _ = ship()
    fastest = earliest_arrival(
        ShipOnNetwork(network, fields, table, setting=2, limits=NO_LIMITS, top_speed=8.0),
        start=0,
        goal=7,
        depart=0.0,
    )
    found = search(network, fields, 7, 20_000.0, lower=False)
    assert found.fastest.time == pytest.approx(fastest.duration, rel=1e-12)
    again, request = world_of(network, fields, 20_000.0)
    pairs = {(int(t), int(h)): e for e, (t, h) in enumerate(zip(again.tails, network.graph.target))}
    edges = np.array([pairs[a, b] for a, b in itertools.pairwise(fastest.path.tolist())])
    leave = np.where(fastest.path_depart > fastest.path_arrive, fastest.path_depart, -np.inf)[:-1]
    way = PlannedPath(fastest.path, edges, np.full(len(edges), 2), leave)
    assert sail_planned_path(again, request, way).path_arrive == pytest.approx(
        fastest.path_arrive, rel=1e-14
    )


KNOT = 1852.0 / 3600.0


def chain_of(distances_nm, currents_kn, parts):
    """Return stretches with a current each, joined by edges of one metre."""
    lengths, flow = [], []
    for distance, current in zip(distances_nm, currents_kn):
        lengths += [*[distance * 1852.0 / parts] * parts, 1.0]
        flow += [current * KNOT] * (parts + 1)
    lengths = np.array(lengths[:-1])
    n = len(flow)
    lon = np.concatenate(([0.0], np.cumsum(lengths))) / 111319.490793
    network = make_network(np.zeros(n), lon, [(i, i + 1) for i in range(n - 1)], length=lengths)
    flow = np.array(flow)[:, None] * np.ones(2)
    return network, make_fields(network, [0.0, 1e6], current_east=flow, current_north=0.0)


@pytest.mark.parametrize(
    ("distances", "currents", "hours", "speeds", "fuel"),
    [
        ((100, 100), (2, -2), 16, (11.574586, 13.583066), 33058.9008),
        ((100, 100), (2, -2), 20, (9.091126, 11.104332), 21813.8565),
        ((120, 60, 90), (1.5, -1, 0), 20, (12.566179, 13.794702, 13.275398), 45099.6158),
    ],
)
def test_cubic_law(distances, currents, hours, speeds, fuel):
    """With fuel k V^3, 2 V^3 + 3 w V^2 is the same on every stretch; both within 0.05 %."""
    parts = 4
    network, fields = chain_of(distances, currents, parts)
    offered = np.concatenate([np.arange(s - 0.06, s + 0.06, 0.002) for s in sorted(speeds)])
    tables = ship(offered * KNOT, per_cube=1.0 / KNOT**3 / 3600.0)
    found = search(
        network, fields, network.n_nodes - 1, hours * 3600.0 * 1.001,
        tables=tables, lower=False, bin_s=1.0,
    )  # fmt: skip
    assert cheapest(found, hours * 3600.0).cost == pytest.approx(fuel, rel=5e-4)
    near = [p for p in found.points if abs(p.time / 3600.0 / hours - 1) < 1e-3]
    for k, speed in enumerate(speeds):
        stretch = slice(k * (parts + 1), k * (parts + 1) + parts)
        used = [offered[p.setting[stretch]].mean() for p in near]
        assert np.mean(used) == pytest.approx(speed, rel=5e-4)


@pytest.mark.parametrize("head", [2.0, 4.0])
def test_speed_against_a_head_current(head):
    """Without a limit of time the cheapest speed against a current h is 1.5 h."""
    network, fields = chain_of((50,), (-head,), 2)
    offered = np.arange(1.2 * head, 2.0 * head, 0.005)
    tables = ship(offered * KNOT, per_cube=1.0)
    latest = 3600.0 * 50 / (0.25 * head)
    found = search(network, fields, 2, latest, tables=tables, lower=False)
    assert offered[found.cheapest.setting] == pytest.approx(1.5 * head, abs=0.006)


def test_canals_take_their_time_and_fee_at_the_speed_they_need():
    network = line(4, 20_000.0)
    fixed, fee = np.full(network.n_edges, np.nan), np.zeros(network.n_edges)
    canal = int(network.graph.indptr[1]) + int(
        np.argmax(network.graph.target[network.graph.indptr[1] :] == 2)
    )
    fixed[canal], fee[canal] = 20_000.0 / 5.0, 40.0
    network = network.with_edges(fixed_time=fixed, fee=fee)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    found = search(network, fields, 3, 20_000.0, prices=LegPrices(dues=1.0))
    for point in found.points:
        assert point.setting[1] == 1  # 6 m/s is the slowest that keeps 5 m/s
        assert point.path_arrive[2] - point.path_depart[1] == pytest.approx(4000.0)
    best = found.cheapest
    assert best.cost == pytest.approx(40.0 + 4000.0 * 0.216 + 10_000.0 * 0.064, rel=1e-6)


def test_waiting_for_a_fair_current_saves_fuel():
    """The current turns fair at half the time; the ship that may wait does."""
    network = line(3, 20_000.0)
    times = np.arange(0.0, 90_001.0, 1000.0)
    flow = np.where(times < 30_000.0, -2.0, 2.0)[None, :] * np.ones((3, 1))
    fields = make_fields(network, times, current_east=flow, current_north=0.0)
    waited = search(network, fields, 2, 60_000.0, lower=False)
    at_once = search(network, fields, 2, 60_000.0, lower=False, wait=False)
    best = waited.cheapest
    assert best.path_depart[0] == pytest.approx(30_000.0, abs=1000.0)
    assert best.cost == pytest.approx(0.064 * 40_000.0 / 6.0, rel=2e-3)
    assert all(point.waiting == 0.0 for point in at_once.points)
    assert at_once.cheapest.cost > 1.2 * best.cost
    dear = search(network, fields, 2, 60_000.0, lower=False, prices=LegPrices(waiting=0.064))
    assert dear.cheapest.waiting < 1000.0


def test_a_bar_is_passed_when_the_tide_allows():
    network = line(4, 10_000.0, depth=5.0)
    times = np.arange(0.0, 100_001.0, 600.0)
    level = 2.0 * np.sin(2 * np.pi * (times - 20_000.0) / 44_712.0)
    fields = make_fields(
        network, times, water_level=level[None, :] * np.array([[5.0], [5.0], [1.0], [5.0]]) + 0.0,
        **STILL,
    )  # fmt: skip
    found = search(network, fields, 3, 60_000.0, limits=limits(depth=6.0), lower=False)
    table, _ = ship()
    fastest = earliest_arrival(
        ShipOnNetwork(network, fields, table, setting=2, limits=limits(depth=6.0), top_speed=8.0),
        start=0,
        goal=3,
        depart=0.0,
    )
    assert found.fastest.time == pytest.approx(fastest.duration, abs=1e-6)
    open_from = 20_000.0 + 44_712.0 * np.arcsin(0.5) / (2 * np.pi)
    for point in found.points:  # the bar, node 2, is reached and left at high water
        assert point.path_arrive[2] >= open_from - 5.0
    assert set(found.cheapest.setting) == {0}
    assert found.cheapest.cost == pytest.approx(0.064 * 30_000.0 / 4.0)


def test_fuel_depends_on_the_weather_along_the_path():
    """Wind 10 m/s from ahead and current 2 m/s from astern: 12 m/s over the moving water."""
    network = line(3, 20_000.0)
    fields = make_fields(
        network, [0.0, 1e6], current_east=2.0, current_north=0.0, wind_east=-10.0, wind_north=0.0
    )
    wind, angle = np.linspace(0.0, 20.0, 5), np.linspace(0.0, np.pi, 3)
    loss = -0.05 * wind[:, None] * np.ones(3)
    burnt = 0.01 * wind[:, None] * (1.0 + np.cos(angle))[None, :]
    axes = ((codes.AXIS_WIND_SPEED,), (wind,)), ((0, 1), (wind, angle))
    table = make_table(((), (), SPEEDS), (*axes[0], loss))
    fuel = make_table(((), (), 1e-3 * SPEEDS**3), (*axes[1], burnt[..., None] * np.ones(3)))
    found = search(network, fields, 2, 40_000.0, tables=(table, fuel))
    time = 40_000.0 / (8.0 - 0.05 * 12.0 + 2.0)
    assert found.fastest.time == pytest.approx(time, rel=1e-6)
    assert found.fastest.cost == pytest.approx(time * (0.512 + 0.24), rel=1e-6)


def test_lower_front_over_a_bar():
    """Edges that open between two slices count as open for the lower front."""
    network = line(4, 10_000.0, depth=5.0)
    times = np.arange(0.0, 100_001.0, 3000.0)
    level = 2.0 * np.sin(2 * np.pi * (times - 20_000.0) / 44_712.0)
    share = np.array([[5.0], [5.0], [1.0], [5.0]])
    fields = make_fields(network, times, water_level=level[None, :] * share, **STILL)
    found = search(network, fields, 3, 60_000.0, limits=limits(depth=6.0), bin_s=60.0)
    assert np.all(found.gap >= 0.0) and len(found.points) > 5
    assert found.lower_at(found.fastest.time) > 0.7 * found.fastest.cost
    finer = search(network, fields, 3, 60_000.0, limits=limits(depth=6.0), bin_s=10.0, lower=False)
    for point in finer.points:
        assert found.lower_at(point.time) <= point.cost * (1 + 1e-9)


def test_the_same_twice():
    network, fields = random_world(8)
    one, two = (search(network, fields, 7, 20_000.0, lower=False) for _ in range(2))
    assert one.time.tolist() == two.time.tolist() and one.cost.tolist() == two.cost.tolist()
    assert all(np.array_equal(a.path, b.path) for a, b in zip(one.points, two.points))


def test_choosing_from_a_front():
    network, fields = random_world(1)
    found = search(network, fields, 7, 20_000.0, lower=False)
    assert cheapest(found) is found.cheapest is found.points[-1]
    middle = found.points[len(found.points) // 2]
    assert cheapest(found, middle.arrive) is middle
    assert found.fastest.cost > found.knee().cost > found.cheapest.cost
    few = found.spread(5)
    assert 2 < len(few) <= 5 and few[0] is found.fastest and few[-1] is found.cheapest
    with pytest.raises(InputError, match="earliest arrival") as caught:
        cheapest(found, found.fastest.arrive - 1.0)
    assert caught.value.details["earliest"] == found.fastest.arrive


def test_a_latest_arrival_too_early_is_refused_with_the_earliest():
    network = line(3, 20_000.0)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    with pytest.raises(InputError, match="earliest arrival is 5000 s") as caught:
        search(network, fields, 2, 4000.0)
    assert caught.value.details["earliest"] == pytest.approx(5000.0)


def test_required_memory_is_checked_before_it_is_allocated():
    network, fields = random_world(1)
    with pytest.raises(InputError, match="GB of memory") as caught:
        search(network, fields, 7, 50_000.0, bin_s=0.01, memory_limit=1e6)
    assert caught.value.details["memory"] > 1e6
    fitting = search(network, fields, 7, 20_000.0, lower=False, memory_limit=1e5)
    free = search(network, fields, 7, 20_000.0, lower=False)
    assert fitting.bin_s > free.bin_s and fitting.work.memory <= 1e5


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"latest": -1.0}, "not after the departure"),
        ({"settings": [0, 3]}, "not all the ship's"),
        ({"goal": 99}, "from node 0 to node 99"),
        ({"eca_fraction": -1.0}, "between 0 and 1"),
        ({"eca_fraction": np.nan}, "between 0 and 1"),
        ({"bin_s": 0.0}, "bins"),
    ],
)
def test_bad_requests(wrong, words):
    network = line(3, 20_000.0)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    with pytest.raises(InputError, match=words):
        search(network, fields, **{"goal": 2, "latest": 20_000.0, **wrong})


def test_an_impossible_path_is_refused_with_the_reasons():
    network = line(3, 20_000.0, depth=5.0)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    with pytest.raises(NoRouteError, match="under-keel clearance"):
        search(network, fields, 2, 1e5, limits=limits(depth=6.0))


def test_settings_can_be_chosen():
    network = grid(3, 4)
    fields = make_fields(network, [0.0, 1e6], **STILL)
    found = search(network, fields, 11, 20_000.0, settings=[0, 2])
    assert {int(s) for p in found.points for s in p.setting} == {0, 2}


def tidal_front(network, fields, latest, **more):
    table, fuel = make_table(((), (), np.array([4.0]))), make_table(((), (), np.array([1.0])))
    options = {"tables": (table, fuel), "limits": limits(depth=5.0), **more}
    return search(network, fields, 5, latest, **options)


def test_waiting_at_an_anchorage_before_a_bar():
    """The fastest way is that of `earliest_arrival`, which waits where it may."""
    network, fields = barred_line(4.0 * 3600.0)
    one = earliest_arrival(
        ShipOnNetwork(
            network,
            fields,
            make_table(((), (), np.array([4.0]))),
            setting=0,
            limits=limits(depth=5.0),
            top_speed=4.0,
        ),
        start=0,
        goal=5,
        depart=0.0,
    )
    found = tidal_front(network, fields, 7 * 3600.0)
    assert found.fastest.time == pytest.approx(one.arrive, abs=1e-6)
    assert found.fastest.path.tolist() == [0, 1, 2, 3, 4, 5]
    waits = found.fastest.path_depart - found.fastest.path_arrive
    assert set(np.flatnonzero(waits > 1.0)) <= {0, 1}
    assert found.fastest.cost == pytest.approx(1250.0)  # waiting is free here
    with pytest.raises(InputError) as refused:
        tidal_front(network, fields, 3 * 3600.0)
    assert refused.value.details["earliest"] == pytest.approx(one.arrive)


def test_a_ship_that_may_not_wait_may_circle():
    """A long detour is open; sailing to and fro until the bar opens is shorter and costs more."""
    network, fields = barred_line(4.0 * 3600.0)
    around = [(0, 5)]
    edges = [(i, i + 1) for i in range(5)] + [(i + 1, i) for i in range(5)] + around
    length = np.array([1000.0] * 10 + [100_000.0])
    network = make_network(network.lat, network.lon, edges, length=length, can_wait=False)
    fields = replace(fields, values=fields.values.copy())
    found = tidal_front(network, fields, 7.5 * 3600.0, wait=False, bin_s=120.0)
    assert found.fastest.time < 15_500.0
    assert len(found.fastest.path) > 40
    assert found.cheapest.waiting == 0.0


def test_the_nearest_reached_place_is_found_across_the_antimeridian():
    """Nodes 0 and 1 are joined, 179.9 and 179.0 E; the goal is at 179.9 W."""
    lon = np.array([179.9, 179.0, -179.9])
    network = make_network(np.zeros(3), lon, [(0, 1), (1, 0)])
    fields = make_fields(network, [0.0, 1e6], **STILL)
    with pytest.raises(NoRouteError) as refused:
        search(network, fields, 2, 9e5)
    assert refused.value.details["nearest"] == pytest.approx((0.0, 179.9))


def surfing(height, east, speed_limit=6.0, latest=5e4):
    """30 km eastward in three legs, waves from astern; faster than the limit is surf-riding.

    ``height`` of the waves and current ``east`` are by node.
    """
    table = make_table(((), (), np.array([4.0, 8.0])))
    table = table._replace(safety=np.array([speed_limit, 0.0, 0.0, 0.0, 0.0, 0.0, 0.9]))
    fuel = make_table(((), (), np.array([1.0, 4.0])))
    network = line(4, 10_000.0)
    column = np.zeros((4, 2))
    fields = make_fields(
        network, [0.0, 1e5], current_north=0.0, current_east=np.array(east)[:, None] + column,
        wave_height_channel=np.array(height)[:, None] + column, wave_east=1.0, wave_north=0.0,
        wave_period=8.0,
    )  # fmt: skip
    return search(network, fields, 3, latest, tables=(table, fuel))


def test_a_slower_setting_may_keep_a_limit_that_the_highest_breaks():
    found = surfing([3.0, 3.0, 3.0, 3.0], [0.0, 0.0, 0.0, 0.0])
    assert found.time == pytest.approx([7500.0])
    assert found.cost == pytest.approx([7500.0])
    assert found.gap == pytest.approx([0.0], abs=1e-4)


def test_neither_setting_alone_passes_but_both_in_turn():
    """Waves at the first three nodes, 5 m/s of head current at the last one of four."""
    found = surfing([3.0, 3.0, 0.0, 0.0], [0.0, 0.0, 0.0, -5.0])
    assert found.fastest.setting.tolist() == [0, 0, 1]
    last = 0.5 * (10_000.0 / 8.0 + 10_000.0 / 3.0)
    assert found.fastest.time == pytest.approx(5000.0 + last, rel=1e-6)


def test_limits_in_waves_violated_at_all_settings():
    with pytest.raises(NoRouteError, match="safety or comfort"):
        surfing([3.0, 3.0, 3.0, 3.0], [0.0, 0.0, 0.0, 0.0], speed_limit=3.0)
    with pytest.raises(InputError, match="7500 s"):
        surfing([3.0, 3.0, 3.0, 3.0], [0.0, 0.0, 0.0, 0.0], latest=7000.0)
