"""FIFO property and waiting: the published example, alone and in the search."""

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, steady
from thalweg.search import (
    ShipOnNetwork,
    earliest_arrival,
    earliest_arrivals_with_waiting,
    fifo_report,
)
from thalweg.search.fifo import sampled_arrivals

INF = np.inf
W = np.array([INF, INF, INF, 3, 3, 3, 9, 8, 2, 2])  # travel times at departures 0 to 9
WAITED = [6, 6, 6, 6, 7, 8, 10, 10, 10, 11]
UNIT = 600.0  # one unit of the example [s]


def no_waiting_from(i):
    allowed = np.ones(9, bool)
    allowed[i] = False
    return allowed


@pytest.mark.parametrize(
    ("allowed", "changed"),
    [
        (True, {}),
        (no_waiting_from(6), {6: 15}),
        (no_waiting_from(7), {6: 15, 7: 15}),
    ],
)
def test_waiting_example(allowed, changed):
    arrivals = earliest_arrivals_with_waiting(np.arange(10) + W, allowed)
    expected = [changed.get(i, a) for i, a in enumerate(WAITED)]
    assert arrivals.tolist() == expected
    if allowed is True:
        assert (arrivals - np.arange(10)).tolist() == [6, 5, 4, 3, 3, 3, 4, 3, 2, 2]


def test_results_without_waiting_are_equal():
    arrivals = np.arange(10) + W
    assert earliest_arrivals_with_waiting(arrivals, False).tolist() == arrivals.tolist()


def test_several_edges_at_once():
    both = earliest_arrivals_with_waiting(np.stack([np.arange(10) + W, np.arange(10.0)]))
    assert both.tolist() == [WAITED, list(range(10))]


def example():
    """An edge whose travel times are those of the example: speeds at its two ends by time."""
    network = line(2, 30e3)
    nan = np.nan
    # half the slowness of the tail at departure plus half that of the head at predicted arrival
    tail = np.array([nan, nan, nan, 3, 3, 3, 9, 7, 2, 2] + [2] * 7)
    head = np.array([3] * 9 + [2, 2, 2, 2, 2] + [9, 9, 9])
    length = network.edges.length[0]
    fields = make_fields(
        network, UNIT * np.arange(17), speed_field=length / (UNIT * np.stack([tail, head]))
    )
    return network, fields


GIVEN = {"setting": 0, "limits": limits(), "top_speed": 30.0}


@pytest.mark.slow
def test_the_fields_reproduce_the_example_without_waiting():
    network, fields = example()
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, steady(1.0), **GIVEN),
        departures=UNIT * np.arange(10),
        edges=[0],
    )
    assert arrivals[0] / UNIT == pytest.approx(np.arange(10) + W, rel=1e-6)


@pytest.mark.parametrize("depart", range(10))
@pytest.mark.parametrize("method", ["astar", "dijkstra"])
def test_the_search_waits_as_in_the_example(depart, method):
    network, fields = example()
    result = earliest_arrival(
        ShipOnNetwork(network, fields, steady(1.0), **GIVEN),
        start=0,
        goal=1,
        depart=UNIT * depart,
        method=method,
    )
    clock = np.linspace(depart, 9.0, 60 * (9 - depart) + 1) * UNIT
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, steady(1.0), **GIVEN), departures=clock, edges=[0]
    )
    # the departures of the example are whole hours; the best may be between them
    assert result.arrive / UNIT <= WAITED[depart] * (1 + 1e-6)
    assert result.arrive <= arrivals.min() + 0.01
    assert arrivals.min() - result.arrive < 0.01 * UNIT


@pytest.mark.parametrize("may_wait", ["nowhere", "not here"])
def test_the_search_without_waiting_takes_what_it_gets(may_wait):
    network, fields = example()
    if may_wait == "not here":
        network.can_wait[0] = False
    results = [
        earliest_arrival(
            ShipOnNetwork(network, fields, steady(1.0), **GIVEN),
            start=0,
            goal=1,
            depart=UNIT * t,
            wait=may_wait != "nowhere",
        )
        for t in range(10)
    ]
    assert [r.found for r in results] == [False] * 3 + [True] * 7
    arrivals = [r.arrive / UNIT for r in results]
    assert arrivals[3:] == pytest.approx((np.arange(10) + W)[3:], rel=1e-6)
    assert results[0].refused == {"no data": 1}


def test_the_report_measures_the_worst_gain_by_waiting():
    network, fields = example()
    report = fifo_report(
        ShipOnNetwork(network, fields, steady(1.0), **GIVEN),
        departures=UNIT * np.arange(10),
        edges=[0],
    )
    assert report.worst == pytest.approx(5 * UNIT, rel=1e-6)  # 15 becomes 10
    assert (report.edge, report.share) == (0, 1.0)
    assert report.blocked == pytest.approx(0.3)


def test_steady_water_is_fifo():
    network = line(3, 5000.0)
    fields = make_fields(network, [0.0, 1e5], current_east=1.0, current_north=0.0)
    report = fifo_report(
        ShipOnNetwork(network, fields, steady(5.0), **GIVEN), departures=np.linspace(0, 5e4, 7)
    )
    assert (report.worst, report.edge, report.share, report.blocked) == (0.0, -1, 0.0, 0.0)
