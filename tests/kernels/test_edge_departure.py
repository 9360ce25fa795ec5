"""Departure of a ship that waits for an edge to open: against departures at every second."""

import numpy as np
import pytest

from tests.search.small import limits, line, make_fields, make_table, steady
from thalweg.kernels import codes
from thalweg.kernels.search.edge_departure import OPENING_TOLERANCE
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.search.fifo import sampled_arrivals

HOUR = 3600.0
REQUIRED = 5.0


def shoal(seed, pieces=4):
    """One leg over a bank that is too shallow at first and floods by fits and starts."""
    rng = np.random.default_rng(seed)
    network = line(2, 4000.0, pieces=pieces)
    times = np.append(np.arange(0.0, 6 * HOUR, 1200.0), 12 * HOUR)
    count = (network.n_stations, len(times))
    level = np.cumsum(rng.uniform(-0.3, 0.6, count), axis=1) - rng.uniform(0.7, 1.2)
    level[:2] += 3.0  # deep at both ends
    east = rng.uniform(-1.0, 1.0, count)
    return network, make_fields(
        network, times, water_level=level, bed_depth=REQUIRED, current_east=east, current_north=0.0
    )


@pytest.mark.parametrize("by_depth", [False, True])
@pytest.mark.parametrize("seed", range(11))
def test_an_opening_is_found_to_a_tenth_of_a_second(seed, by_depth):
    network, fields = shoal(seed)
    grid = np.linspace(0.0, 30.0, 31)
    squat = make_table(((codes.AXIS_DEPTH,), (grid,), 3.0 + 0.05 * grid[:, None]))
    table = squat if by_depth else steady(4.0)
    asked = {"setting": 0, "limits": limits(depth=REQUIRED), "top_speed": 5.0}
    depart = 100.0
    found = earliest_arrival(
        ShipOnNetwork(network, fields, table, **asked), start=0, goal=1, depart=depart
    )
    clock = np.arange(depart, 6 * HOUR, 1.0)
    arrivals, _ = sampled_arrivals(
        ShipOnNetwork(network, fields, table, **asked), departures=clock, edges=[0]
    )
    assert np.isinf(arrivals[0, 0])  # shut at first
    first = int(np.argmax(np.isfinite(arrivals[0])))
    leave = float(found.path_depart[0])
    assert clock[first - 1] <= leave + OPENING_TOLERANCE
    assert found.arrive <= arrivals[0].min() + 1.0
    before = sampled_arrivals(
        ShipOnNetwork(network, fields, table, **asked),
        edges=[0],
        departures=[leave - 1.01 * OPENING_TOLERANCE, leave],
    )[0][0]
    assert before[1] == found.arrive
    if leave < clock[first] + 1.0:  # left as it opened
        assert np.isinf(before[0])
