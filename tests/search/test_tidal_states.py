"""Nodes that fall dry: against a time-expanded network, minute by minute."""

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, make_network, steady
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.search.fifo import sampled_arrivals
from thalweg.search.search_problem import network_arrays, sea_arrays
from thalweg.search.tidal_states import tidal_states

HOUR, MINUTE = 3600.0, 60.0
REQUIRED = 5.0
GIVEN = {"setting": 0, "limits": limits(depth=REQUIRED), "top_speed": 4.0}


def gully(seed, nodes=7):
    """Random nodes in a tidal gully: bed depths of which most fall dry at low water."""
    rng = np.random.default_rng(seed)
    lat, lon = rng.uniform(0.0, 0.12, (2, nodes))
    order = np.argsort(lon)
    lat, lon = lat[order], lon[order]
    pairs = [(i, j) for i in range(nodes) for j in range(nodes) if 0 < abs(i - j) <= 2]
    network = make_network(lat, lon, pairs)
    times = np.arange(0.0, 26 * HOUR, 0.5 * HOUR)
    tide = 2.0 * np.sin(2 * np.pi * (times / (12.42 * HOUR) + rng.random()))
    bed = rng.uniform(REQUIRED - 1.9, REQUIRED + 2.5, nodes)
    lag = rng.uniform(0.8, 1.2, nodes)
    fields = make_fields(
        network, times, water_level=tide * lag[:, None], bed_depth=bed[:, None] + 0.0 * tide
    )
    return network, fields


def minute_by_minute(network, fields, start, goal, depart):
    """Return the earliest arrival on a network of nodes times minutes, times rounded up."""
    clock = np.arange(depart, fields.times[-1], MINUTE)
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), departures=clock
    )
    depth = fields.values.sum(axis=2)
    afloat = np.array([np.interp(clock, fields.times, d) >= REQUIRED for d in depth])
    afloat[start] = True
    there = np.zeros((network.n_nodes, len(clock)), bool)
    there[start, 0] = True
    tails = network.tails()
    best = np.inf
    for k in range(len(clock)):
        if k:
            there[:, k] |= there[:, k - 1] & afloat[:, k] & afloat[:, k - 1]
        for e in np.flatnonzero(there[tails, k] & np.isfinite(arrivals[:, k])):
            if network.graph.target[e] == goal:
                best = min(best, arrivals[e, k])
            step = int(np.ceil((arrivals[e, k] - depart) / MINUTE))
            if step < len(clock):
                there[network.graph.target[e], step] = True
    return best


@pytest.mark.parametrize("seed", range(40))
def test_the_search_is_as_good_as_minute_by_minute(seed):
    network, fields = gully(seed)
    truth = minute_by_minute(network, fields, 0, 6, 1000.0)
    result = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=6, depart=1000.0
    )
    assert result.found == np.isfinite(truth)
    if result.found:
        # rounding up costs the oracle up to a minute at every node
        assert truth - MINUTE * len(result.path) <= result.arrive <= truth + 2.0
        depth = fields.values.sum(axis=2)
        for node, come, go in zip(result.path[1:], result.path_arrive[1:], result.path_depart[1:]):
            when = np.linspace(come, go, 50)
            assert np.interp(when, fields.times, depth[node]).min() >= REQUIRED - 0.01


def test_states_of_one_node_with_three_times_afloat():
    network = line(3, 1000.0)
    times = HOUR * np.arange(9)
    level = np.zeros((3, 9))
    level[1] = [0, 0, -2, 0, 0, -4, -4, 0, 0]
    fields = make_fields(network, times, water_level=level, bed_depth=6.0)
    arrays, sea = network_arrays(network), sea_arrays(fields)
    split = tidal_states(arrays, sea, REQUIRED, (0, 2))
    assert split.station.tolist() == [0, 1, 2, 1, 1]
    # a spare depth of 1 m falls to -1 m in half an hour, and to -3 m in a quarter
    assert split.until[[1, 3, 4]] / HOUR == pytest.approx([1.5, 4.25, np.inf])
    assert split.opens[[1, 3, 4]] / HOUR == pytest.approx([-np.inf, 2.0, 5.5])
    assert split.closes[[1, 3, 4]] / HOUR == pytest.approx([2.0, 5.5, np.inf])
    assert np.diff(split.indptr).tolist()[0] == 3  # from the start to each state
    for state in (1, 3, 4):
        heads = split.target[split.indptr[state] : split.indptr[state + 1]]
        assert sorted(heads) == [0, 2]
    assert np.isinf(split.until[[0, 2]]).all()


@pytest.mark.parametrize("required", [-np.inf, 1.0])
def test_nodes_that_never_fall_dry_have_one_state(required):
    network, fields = gully(1)
    arrays = network_arrays(network)
    assert tidal_states(arrays, sea_arrays(fields), required, (0, 6)) is arrays
