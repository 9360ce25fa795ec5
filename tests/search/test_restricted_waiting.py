"""Waiting at some nodes only: against a time-expanded network, minute by minute."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.search.small import line, make_fields, steady
from tests.search.test_tidal_states import GIVEN, HOUR, MINUTE, REQUIRED, gully
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.search.fifo import sampled_arrivals

DEPART = 1000.0


def restricted(seed):
    """Return a tidal gully in which a ship may wait at about a third of the nodes."""
    network, fields = gully(seed)
    allowed = np.random.default_rng(1000 + seed).random(network.n_nodes) < 0.35
    allowed[0], allowed[1:3] = True, False
    return replace(network, can_wait=allowed), fields


def minute_by_minute(network, fields):
    """Return the earliest arrival at the last node on a network of nodes times minutes.

    Arrivals are rounded down for one bound and up for the other, so the exact value is between (to
    what a minute more or less at every node decides).
    """
    clock = np.arange(DEPART, fields.times[-1], MINUTE)
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), departures=clock
    )
    depth = fields.values.sum(axis=2)
    afloat = np.array([np.interp(clock, fields.times, d) >= REQUIRED for d in depth])
    afloat[0] = True
    stays = afloat & network.can_wait[:, None]
    there = np.zeros((network.n_nodes, len(clock)), bool)
    there[0, 0] = True
    tails, goal, best = network.tails(), network.n_nodes - 1, np.inf
    for k in range(len(clock)):
        if k:
            there[:, k] |= there[:, k - 1] & stays[:, k] & stays[:, k - 1]
        for e in np.flatnonzero(there[tails, k] & np.isfinite(arrivals[:, k])):
            if network.graph.target[e] == goal:
                best = min(best, arrivals[e, k])
            step = round((arrivals[e, k] - DEPART) / MINUTE)
            if step < len(clock):
                there[network.graph.target[e], step] = True
    return best


@pytest.mark.parametrize("seed", range(30))
def test_as_good_as_minute_by_minute_and_never_waiting_where_it_may_not(seed):
    network, fields = restricted(seed)
    truth = minute_by_minute(network, fields)
    found = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=6, depart=DEPART
    )
    free = earliest_arrival(
        ShipOnNetwork(replace(network, can_wait=np.ones(7, bool)), fields, steady(4.0), **GIVEN),
        start=0,
        goal=6,
        depart=DEPART,
    )
    if found.found:
        assert found.path[0] == 0 and found.path[-1] == 6
        assert found.arrive >= free.arrive - 1.0
        pause = found.path_depart - found.path_arrive
        assert (pause >= -1e-6).all()
        assert not (pause[~network.can_wait[found.path]] > 1e-6).any()
        _sail_again(network, fields, found)
    # waves 10 min apart, and a minute of rounding at every node
    near = np.isfinite(truth) == found.found and (
        not found.found or abs(found.arrive - truth) <= 600.0 + 2 * MINUTE * len(found.path)
    )
    assert near


def _sail_again(network, fields, found):
    """Check every leg of a way by itself, and that waits are afloat."""
    depth = fields.values.sum(axis=2)
    tails = network.tails()
    for a, b, leave, come in zip(
        found.path[:-1], found.path[1:], found.path_depart[:-1], found.path_arrive[1:]
    ):
        edge = int(np.flatnonzero((tails == a) & (network.graph.target == b))[0])
        arrivals, _ = sampled_arrivals(
            ShipOnNetwork(network, fields, steady(4.0), **GIVEN), departures=np.array([leave])
        )
        assert arrivals[edge, 0] == pytest.approx(come, abs=0.01)
    for node, come, go in zip(found.path[1:], found.path_arrive[1:], found.path_depart[1:]):
        when = np.linspace(come, go, 50)
        assert np.interp(when, fields.times, depth[node]).min() >= REQUIRED - 0.01


def barred_line(opens: float):
    """Return nodes in a row, 1 km apart: an anchorage at node 1, a bar between 3 and 4."""
    network = line(6, 1000.0)
    network = replace(network, can_wait=np.array([True, True, False, False, False, False]))
    times = np.arange(0.0, 8 * HOUR, 600.0)
    bed = np.full((6, len(times)), 10.0)
    bed[4] = np.where(times < opens, 2.0, 10.0)
    return network, make_fields(network, times, bed_depth=bed)


def test_the_ship_waits_for_a_bar_at_the_anchorage():
    """The bar opens within the step before 4 h; node 1 is 2 km and 500 s from there."""
    network, fields = barred_line(4.0 * HOUR)
    found = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=5, depart=0.0
    )
    assert found.path.tolist() == [0, 1, 2, 3, 4, 5]
    waits = found.path_depart - found.path_arrive
    assert set(np.flatnonzero(waits > 1.0)) <= {0, 1}
    opens = 4.0 * HOUR - 600.0 + 600.0 * (REQUIRED - 2.0) / 8.0  # linear between the data
    # node 3 is left 250 s before the bar's node is reached, and the leg must be open all along
    assert found.arrive == pytest.approx(opens + 250.0, abs=1.0)


def test_without_an_anchorage_the_ship_waits_at_the_start():
    network, fields = barred_line(4.0 * HOUR)
    network = replace(network, can_wait=np.arange(6) == 0)
    found = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=5, depart=0.0
    )
    assert found.found
    waits = found.path_depart - found.path_arrive
    assert np.flatnonzero(waits > 1.0).tolist() == [0]
    none = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN),
        start=0,
        goal=5,
        depart=0.0,
        wait=False,
    )
    assert not none.found


def test_no_path_is_reported_with_its_reasons():
    network, fields = barred_line(100.0 * HOUR)
    found = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=5, depart=0.0
    )
    assert not found.found
    assert found.nearest_node == 3
    assert any("clearance" in reason or "depth" in reason for reason in found.refused)


def test_no_arrival_is_after_the_latest_arrival():
    network, fields = barred_line(4.0 * HOUR)
    asked = {"start": 0, "goal": 5, "depart": 0.0}
    assert not earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), arrive_by=3.0 * HOUR, **asked
    ).found
    assert earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), arrive_by=4.2 * HOUR, **asked
    ).found


def test_waiting_at_all_nodes_gives_the_unlimited_result():
    network, fields = gully(3)
    given = {"start": 0, "goal": 6, "depart": DEPART}
    plain = earliest_arrival(ShipOnNetwork(network, fields, steady(4.0), **GIVEN), **given)
    barred = replace(network, can_wait=np.ones(7, bool))
    assert (
        earliest_arrival(ShipOnNetwork(barred, fields, steady(4.0), **GIVEN), **given).arrive
        == plain.arrive
    )


def test_open_water_takes_one_wave():
    """No bar, no reason to wait: a few searches settle every node once, whatever the period."""
    network = replace(line(60, 1000.0), can_wait=np.arange(60) % 2 == 0)
    fields = make_fields(network, [0.0, 8 * HOUR, 300 * HOUR], bed_depth=10.0)
    found = earliest_arrival(
        ShipOnNetwork(network, fields, steady(4.0), **GIVEN), start=0, goal=59, depart=0.0
    )
    assert found.arrive == pytest.approx(59_000.0 / 4.0)
    assert found.settled <= 3 * (network.n_nodes + 1)  # and one more for the path
