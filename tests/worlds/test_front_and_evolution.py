"""Lower front, front and evolution in the jet and eddies: each is on or below the next."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from tests.evolution import jet
from tests.search.small import NO_LIMITS
from tests.worlds import jet_and_eddies as world
from thalweg.core.objective import LegPrices
from thalweg.evolution import EvolutionSettings, Genome, StoppingCriteria, VariationSettings, evolve
from thalweg.evolution.evolve import METHODS
from thalweg.evolution.variation import OperatorWeights
from thalweg.search import NetworkFront, ShipOnNetwork, earliest_arrival, pareto_front
from thalweg.search.pareto.front_problem import (
    FrontProblem,
    FrontQuery,
    FrontRequest,
    MultiSettingShipOnNetwork,
    make_front_problem,
)
from thalweg.search.pareto.front_result import FrontPoint
from thalweg.search.pareto.seed_paths import PlannedPath, sail_planned_path

GRID = world.Grid(20.0, 3)
LATEST = world.T0 + world.LATEST * world.HOUR
SPEEDS_ONLY = OperatorWeights(
    insert=0.0, translate=0.0, delete=0.0, speed=1.0, split=0.0, merge=0.0
)


@cache
def network():
    return GRID.network()


@cache
def fields():
    return world.freeze(network())


@cache
def exact() -> NetworkFront:
    table, fuel = world.tables()
    start, goal = GRID.node(world.START), GRID.node(world.GOAL)
    return pareto_front(
        MultiSettingShipOnNetwork(network(), fields(), table, fuel, NO_LIMITS),
        FrontQuery(start, goal, world.T0, LATEST),
        bin_s=2.0 * world.HOUR / 60.0,
    )


@cache
def seeds() -> tuple[Genome, ...]:
    """Return the quickest way at each setting, and at each of these settings every such way."""
    table, _ = world.tables()
    ways = set()
    for setting in range(table.n_settings):
        found = earliest_arrival(
            ShipOnNetwork(
                network(), fields(), table, setting=setting, limits=NO_LIMITS, top_speed=12.0
            ),
            start=GRID.node(world.START),
            goal=GRID.node(world.GOAL),
            depart=world.T0,
        )
        ways.add(tuple(found.path))
    lat, lon = network().stations.lat, network().stations.lon
    return tuple(
        Genome(lat[list(way)], lon[list(way)], np.full(len(way) - 1, setting))
        for way in sorted(ways)
        for setting in range(table.n_settings)
    )


def nodes_of(genome: Genome) -> np.ndarray:
    x, y = world.xy(genome.lat, genome.lon)
    return np.rint(x / GRID.spacing).astype(int) + GRID.side * np.rint(y / GRID.spacing).astype(int)


@cache
def problem(start: int, goal: int) -> tuple[FrontProblem, FrontRequest]:
    """Return the problem of a front between two nodes, with its request."""
    net, (table, fuel) = network(), world.tables()
    request = FrontRequest(
        start, goal, world.T0, LATEST, np.arange(table.n_settings),
        LegPrices(), np.ones(net.n_edges), True,
    )  # fmt: skip
    ship = MultiSettingShipOnNetwork(net, fields(), table, fuel, NO_LIMITS)
    return make_front_problem(ship, request), request


def sailed(genome: Genome) -> FrontPoint | None:
    """Sail a track edge by edge as the front does; None if it leaves the network."""
    net, nodes = network(), nodes_of(genome)
    off = np.abs(net.stations.lat[nodes] - genome.lat) + np.abs(
        net.stations.lon[nodes] - genome.lon
    )
    if off.max() > 1e-9:
        return None
    edges = []
    for a, b in pairwise(nodes):
        there = np.flatnonzero(net.graph.target[net.graph.indptr[a] : net.graph.indptr[a + 1]] == b)
        if not len(there):
            return None
        edges.append(net.graph.indptr[a] + there[0])
    got, request = problem(int(nodes[0]), int(nodes[-1]))
    leave = np.full(len(edges), -np.inf)
    return sail_planned_path(
        got, request, PlannedPath(nodes, np.array(edges), np.asarray(genome.setting), leave)
    )


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_evolution_on_the_network_stays_above_front_and_lower_front(method):
    best = exact()
    assert np.all(best.gap >= 0.0) and np.median(best.gap) < 0.02
    found = evolve(
        jet.evaluator(),
        seeds(),
        settings=EvolutionSettings(
            method, len(seeds()), 2, VariationSettings(mix=SPEEDS_ONLY, crossover=0.3)
        ),
        stopping=StoppingCriteria(evaluations=3000, settled=None),
    )
    points = [point for genome in found.genomes if (point := sailed(genome)) is not None]
    assert len(points) > 20  # most: crossover alone may leave the network
    start = [point for genome in seeds() if (point := sailed(genome)) is not None]
    assert len(start) == len(seeds())
    for point in (*start, *points):
        if point.time > LATEST - world.T0:
            continue
        assert best.lower_at(point.time) <= point.cost * (1 + 1e-9)
        reached = best.cost[best.time <= point.time + 2.0 * best.bin_s].min(initial=np.inf)
        assert reached <= point.cost * (1 + 1e-3)  # what the bins cost the front
