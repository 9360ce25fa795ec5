"""The front in a meandering jet with moving eddies and a tide, against independent values.

Those were computed with the current of an edge frozen at the departure (5-point quadrature), in
which the optimiser uses that the sea is frozen: sailed again through the moving sea its
paths take 0.20 % (32 directions) and 0.47 % (80 directions) longer than the network said. Here
edges are sailed through the moving sea in the first place, so the fuel is a little higher at a
given time, and the paths sailed again agree with the network.
"""

from functools import cache

import numpy as np
import pytest

from tests.evolution import jet
from tests.search.small import NO_LIMITS
from tests.worlds import jet_and_eddies as world
from thalweg.evolution.indicators import hypervolume
from thalweg.route import Track, evaluate
from thalweg.search import FrontQuery, MultiSettingShipOnNetwork, NetworkFront, pareto_front


@cache
def found(reach: int, bin_min: float, lower: bool = False) -> tuple[world.Network, NetworkFront]:
    grid = world.Grid(5.0, reach)
    network = grid.network()
    table, fuel = world.tables()
    latest = world.T0 + world.LATEST * world.HOUR
    return network, pareto_front(
        MultiSettingShipOnNetwork(network, world.freeze(network), table, fuel, NO_LIMITS),
        FrontQuery(grid.node(world.START), grid.node(world.GOAL), world.T0, latest),
        bin_s=bin_min * world.HOUR / 60.0,
        lower=lower,
    )


def fuel_at(points: NetworkFront, hours: float) -> float:
    return world.tonnes(points.cost[points.time <= hours * world.HOUR].min())


def refereed(network, points) -> np.ndarray:
    """Return hours, tonnes and the hours of the search for each point."""
    rows = []
    for p in points:
        lat, lon = network.stations.lat[p.path], network.stations.lon[p.path]
        wait = p.path_depart - p.path_arrive
        track = Track(lat, lon, float(p.path_arrive[0]), wait, p.setting)
        route = evaluate(track, ship=jet.ship(), sea=jet.sea())
        assert not route.violations
        rows.append((route.time_h * jet.SHRINK, route.fuel_t * jet.SHRINK, p.time / world.HOUR))
    return np.array(rows)


@pytest.mark.slow
def test_front_and_certificate_with_32_directions():
    _, points = found(3, 5.0, lower=True)
    for hours, there in ((20, 23.547), (24, 20.058), (28, 17.656)):
        assert there * 0.999 < fuel_at(points, hours) < there * 1.006
        assert world.tonnes(points.lower_at(hours * world.HOUR)) < fuel_at(points, hours)
    assert np.median(points.gap) < 0.015 and points.gap.max() < 0.06
    assert points.work.dropped == 0 and points.work.table_error < 1e-3


@pytest.mark.slow
def test_refereed_front_with_80_directions():
    network, points = found(5, 1.0)
    for hours, there in ((20, 23.3098), (24, 19.7868), (28, 17.4891)):
        assert there * 0.999 < fuel_at(points, hours) < there * 1.01
    sailed = refereed(network, points.spread(200))
    assert np.abs(sailed[:, 0] / sailed[:, 2] - 1.0).max() < 1e-3  # the frozen one: 4.7e-3
    assert hypervolume(sailed[:, :2], jet.REFERENCE) >= 162.2
