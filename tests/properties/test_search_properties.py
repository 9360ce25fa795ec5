"""Properties of all searches, on random small networks in random moving water."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.search.small import NO_LIMITS, limits, make_fields, make_network, steady
from thalweg.search import (
    DepartureWindow,
    ShipOnNetwork,
    best_departure,
    earliest_arrival,
    fifo_report,
)
from thalweg.search.fifo import sampled_arrivals

SPEED, STEP, STEPS, MINUTE = 5.0, 1800.0, 30, 60.0
seeds = st.integers(0, 2**32 - 1)


def random_world(seed, *, nodes=6, gaps=False, pieces=2, **options):
    """Return a random network and sea: currents up to 1.6 m/s that change over hours.

    With ``gaps`` half of the stations know nothing for some hours.
    """
    rng = np.random.default_rng(seed)
    lat, lon = rng.uniform(0.0, 0.12, (2, nodes))
    pairs = [(i, j) for i in range(nodes) for j in range(nodes) if i != j and rng.random() < 0.6]
    assume(pairs)
    network = make_network(lat, lon, pairs, pieces=pieces, **options)
    count = len(network.stations.lat)
    times = STEP * np.arange(STEPS)
    phase, rate = rng.uniform(0, 2 * np.pi, (2, count, 1)), rng.uniform(1, 4, (2, count, 1))
    uv = 1.1 * np.sin(phase + rate * times / 12e3)
    if gaps:
        begin = rng.integers(0, 12)
        uv[0][rng.random(count) < 0.5, begin : begin + rng.integers(1, 8)] = np.nan
    fields = make_fields(network, times, current_east=uv[0], current_north=uv[1])
    depart = float(rng.uniform(0, 6 * STEP))
    return network, fields, depart


def sail(network, fields, depart, *, limits=NO_LIMITS, **options):
    ship = ShipOnNetwork(network, fields, steady(SPEED), 0, limits, SPEED)
    wanted = {"start": 0, "goal": network.n_nodes - 1, "depart": depart}
    return earliest_arrival(ship, **(wanted | options))


def edge_arrival(network, fields, edge, depart, wait):
    """Return the best arrival over one edge: now, at a later time of the data, or at any minute."""
    starts = [depart] + [t for t in fields.times if wait and t > depart]
    if wait == "any minute":
        starts = np.append(starts, np.arange(depart, fields.times[-1], MINUTE))
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, steady(SPEED), setting=0, limits=NO_LIMITS, top_speed=SPEED),
        departures=starts,
        edges=[edge],
    )
    return arrivals.min()


def brute_force(network, fields, node, time, wait, seen=()):
    """Return the earliest arrival at the last node over every simple path."""
    if node == network.n_nodes - 1:
        return time
    best = np.inf
    for edge in range(network.graph.indptr[node], network.graph.indptr[node + 1]):
        to = int(network.graph.target[edge])
        if to not in seen:
            then = edge_arrival(network, fields, edge, time, wait)
            if then < best:
                best = min(best, brute_force(network, fields, to, then, wait, (*seen, node)))
    return best


def check_path(network, fields, result):
    """Every step of a path is an edge, departs no earlier than it arrives, and takes its time."""
    for i, (a, b) in enumerate(pairwise(result.path)):
        edges = range(network.graph.indptr[a], network.graph.indptr[a + 1])
        edge = next(e for e in edges if network.graph.target[e] == b)
        assert result.path_depart[i] >= result.path_arrive[i]
        then = edge_arrival(network, fields, edge, result.path_depart[i], False)
        assert abs(then - result.path_arrive[i + 1]) < 1e-6


@pytest.mark.slow
@given(seeds, st.sampled_from([(False, False), (True, False), (True, True)]))
@settings(max_examples=90)
def test_astar_is_dijkstra_is_brute_force(seed, case):
    wait, gaps = case  # without waiting, gaps in the data break order
    network, fields, depart = random_world(seed, gaps=gaps, nodes=5)
    if not wait:
        report = fifo_report(
            ShipOnNetwork(
                network, fields, steady(SPEED), setting=0, limits=NO_LIMITS, top_speed=SPEED
            ),
            departures=fields.times,
        )
        assume(report.worst == 0.0)
    results = [sail(network, fields, depart, wait=wait, method=m) for m in ("astar", "dijkstra")]
    truth = brute_force(network, fields, 0, depart, "any minute" if gaps else wait)
    one, other = results
    assert one.found == other.found
    if one.found:
        assert abs(one.arrive - other.arrive) < 1e-6
        check_path(network, fields, one)
        check_path(network, fields, other)
    assert one.found == np.isfinite(truth)
    if one.found:
        coarse = MINUTE * network.n_nodes if gaps else 1e-6
        assert truth - coarse <= one.arrive <= truth + (0.1 * network.n_nodes if gaps else 1e-6)
        assert abs(one.cost - (one.arrive - depart)) < 1e-6


@given(seeds, st.booleans())
@settings(max_examples=60)
def test_waiting_never_loses(seed, gaps):
    network, fields, depart = random_world(seed, nodes=8, gaps=gaps)
    waiting = sail(network, fields, depart, goal=None)
    moving = sail(network, fields, depart, goal=None, wait=False)
    # openings are accurate to a tenth of a second, at every edge of a path
    assert np.all(waiting.node_arrival <= moving.node_arrival + 0.8)


@given(seeds)
@settings(max_examples=60)
def test_later_departure_never_arrives_earlier(seed):
    network, fields, depart = random_world(seed, nodes=8)
    early = sail(network, fields, depart, goal=None)
    late = sail(network, fields, depart + 1234.5, goal=None)
    assert np.all(early.node_arrival <= late.node_arrival + 1e-6)


@given(seeds, st.floats(1.0, 1.9))
@settings(max_examples=60)
def test_a_limit_never_helps(seed, wind):
    rng = np.random.default_rng(seed)
    network, still, depart = random_world(seed, nodes=8)
    east = 1.0 + np.sin(still.times / rng.uniform(4e3, 9e3) + rng.uniform(0, 6))
    fields = make_fields(
        network, still.times, wind_east=east, wind_north=0.0,
        current_east=0.0, current_north=still.values[:, :, 1],
    )  # fmt: skip
    free = sail(network, fields, depart)
    bound = sail(network, fields, depart, limits=limits(wind=wind))
    tighter = sail(network, fields, depart, limits=limits(wind=0.8 * wind))
    # openings are accurate to a tenth of a second, at every edge of a path
    assert free.arrive <= bound.arrive + 0.8
    assert bound.arrive <= tighter.arrive + 0.8
    assert free.cost <= bound.cost + 0.8


@given(seeds)
@settings(max_examples=60)
def test_more_edges_never_hurt(seed):
    rng = np.random.default_rng(seed)
    nodes = 9
    lat, lon = rng.uniform(0.0, 0.12, (2, nodes))
    pairs = [(i, j) for i in range(nodes) for j in range(nodes) if i != j]
    some = [p for p in pairs if rng.random() < 0.4]
    assume(some)
    phase = rng.uniform(0, 2 * np.pi, nodes)[:, None]
    times = STEP * np.arange(STEPS)
    arrivals = []
    for chosen in (pairs, some):
        network = make_network(lat, lon, chosen)
        east, north = np.sin(phase + times / 9e3), np.cos(phase - times / 7e3)
        fields = make_fields(network, times, current_east=east, current_north=north)
        arrivals.append(sail(network, fields, 100.0).arrive)
    assert arrivals[0] <= arrivals[1] + 1e-6


@given(seeds)
@settings(max_examples=25)
def test_no_departure_on_the_grid_is_better_than_the_best_departure(seed):
    network, fields, _ = random_world(seed, nodes=6)
    window = (0.0, 8 * STEP)
    best = best_departure(
        ShipOnNetwork(network, fields, steady(SPEED), setting=0, limits=NO_LIMITS, top_speed=SPEED),
        start=0,
        goal=5,
        window=DepartureWindow(*window),
    )
    tried = [sail(network, fields, t).duration for t in STEP * np.arange(9)]
    assert best.found == np.isfinite(min(tried))
    if best.found:
        assert best.duration <= min(tried) + 2e-3
        assert window[0] <= best.depart <= window[1]
