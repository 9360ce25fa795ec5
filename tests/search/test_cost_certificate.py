"""Certified bounds of cost: below what a linear programme mixes on a network, and near it."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import coo_array

from thalweg.chart import Chart
from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.certificate.cost_conditions import PricedShip
from thalweg.planning.pareto.front_bound.certified_front import raised_by_lines
from thalweg.sea import Sea
from thalweg.search.certificate.barrier_domain import StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.cost_certificate import CostToBound, certify_costs
from thalweg.ship import PerformanceTable, TableError, TablePart

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
SPEEDS = np.array([3.0, 5.0, 7.0])
FUEL = (1e-3 * SPEEDS**3 + 0.02).astype(np.float32).astype(float)  # a second
START, GOAL = (0.0, 0.0), (0.0, 1.0)


def table(values):
    part = TablePart((), (), np.asarray(values, np.float32))
    return PerformanceTable((part,), np.asarray(values, float), "", TableError(0.0, 0.0, 0.0))


def cost_of(sea, known, *, chart=None, inside=1.0, channels=()):
    ship = ShipInBarrier(table(SPEEDS).kernel_arrays(), 2, Limits().array, float(SPEEDS.max()))
    priced = PricedShip(np.arange(3), table(FUEL).kernel_arrays(), FUEL, SPEEDS)
    stretch = StretchToBound(sea, chart, ship, channels, START, GOAL, depart=1e9, known=known)
    return CostToBound(stretch, priced, inside, 1.0, 0.0)


def gyre(lat, lon):
    """Return a steady eddy beside the way [m/s]."""
    y, x = (np.asarray(lat) - 0.12) / 0.25, (np.asarray(lon) - 0.5) / 0.25
    shape = 3.0 * np.exp(-(y**2) - x**2)
    return y * shape, -x * shape


def legs_of_network(rows=13, columns=25):
    """Return (from, to, seconds by speed) of legs on a grid round the way, with start and goal."""
    lat, lon = np.linspace(-0.4, 0.4, rows), np.linspace(-0.1, 1.1, columns)
    step = [(0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1)]
    steps = [*step, *[(-a, -b) for a, b in step]]
    found = []
    for (j, i), (a, b) in itertools.product(np.ndindex(rows, columns), steps):
        if 0 <= j + a < rows and 0 <= i + b < columns:
            found.append((j * columns + i, (j + a) * columns + i + b))
    one, other = np.array(found).T
    y0, x0, y1, x1 = lat[one // columns], lon[one % columns], lat[other // columns], lon[
        other % columns]  # fmt: skip
    length = np.asarray(distance(y0, x0, y1, x1), float)
    course = np.arctan2((x1 - x0) * np.cos(np.radians(y0)), (y1 - y0) * 0.99331)
    seconds = np.zeros((len(one), len(SPEEDS)))
    parts = 12
    for k in range(parts):
        share = (k + 0.5) / parts
        u, v = gyre(y0 + share * (y1 - y0), x0 + share * (x1 - x0))
        along = u * np.sin(course) + v * np.cos(course)
        across = u * np.cos(course) - v * np.sin(course)
        spare = SPEEDS**2 - across[:, None] ** 2
        ground = along[:, None] + np.sqrt(np.maximum(spare, 0.0))
        with np.errstate(divide="ignore"):
            seconds += np.where((spare > 0) & (ground > 0.05), length[:, None] / parts / ground,
                                np.inf)  # fmt: skip
    ends = [int(np.argmin(np.abs(lat - y))) * columns + int(np.argmin(np.abs(lon - x)))
            for y, x in (START, GOAL)]  # fmt: skip
    return one, other, seconds, ends, rows * columns


def least_by_linear_programme(network, price=None, longest=None):
    """Return the least fuel plus priced time, or the least fuel within a time, of mixed legs."""
    one, other, seconds, (start, goal), nodes = network
    leg, speed = np.nonzero(np.isfinite(seconds))
    time = seconds[leg, speed]
    fuel, count = time * FUEL[speed], np.arange(leg.size)
    signs = np.concatenate([np.ones(leg.size), -np.ones(leg.size)])
    rows = np.concatenate([one[leg], other[leg]])
    flow = coo_array((signs, (rows, np.tile(count, 2))), shape=(nodes, leg.size)).tocsr()
    supply = np.zeros(nodes)
    supply[start], supply[goal] = 1.0, -1.0
    within = {} if longest is None else {"A_ub": time[None], "b_ub": [longest]}
    cost = fuel if price is None else fuel + price * time
    return float(linprog(cost, A_eq=flow, b_eq=supply, method="highs", **within).fun)


@pytest.mark.slow
def test_a_front_is_above_the_certified_lines_and_near_them():
    """Mixtures of speeds on a network in an eddy, by a linear programme."""
    network = legs_of_network()
    sea = Sea.from_functions(
        {EAST: lambda t, y, x: gyre(y, x)[0], NORTH: lambda t, y, x: gyre(y, x)[1]}, time_step=0
    )
    length = float(distance(*START, *GOAL))
    prices = np.array([0.0, 0.05, 0.6])
    known = np.array([least_by_linear_programme(network, price) for price in prices])
    channels = (codes.CURRENT_EAST, codes.CURRENT_NORTH)
    cost = cost_of(sea, 1.2 * length / 3.0, channels=channels)
    free = length * ((FUEL + prices[:, None]) / (SPEEDS + 1.9)).min(axis=1)
    found = certify_costs(cost, prices, known * 1.002, seconds=math.inf, most_cells=70)
    assert found.cells > 0
    assert (found.values <= known).all()
    assert (found.values >= 0.92 * known).all()  # networks are a few per cent longer
    assert (found.values > free).all()
    for longest in length / np.array([6.5, 5.0, 4.0]):
        least = least_by_linear_programme(network, longest=longest)
        assert (found.values - prices * longest).max() <= least


@pytest.mark.slow
def test_the_price_in_control_areas_counts():
    """An area all round the way, in which fuel costs twice as much."""
    length = float(distance(*START, *GOAL))
    area = [[-3, -3], [4, -3], [4, 3], [-3, 3], [-3, -3]]
    feature = {
        "type": "Feature", "properties": {"kind": "eca"},
        "geometry": {"type": "Polygon", "coordinates": [area]},
    }  # fmt: skip
    chart = Chart.open_water(-3.5, 3.5, -3.5, 4.5).with_zones(feature)
    prices = np.array([0.0, 0.3])
    true = length * np.array([((2.0 * FUEL + price) / SPEEDS).min() for price in prices])
    cost = cost_of(Sea.calm(), 1.2 * length / 3.0, chart=chart, inside=2.0)
    found = certify_costs(cost, prices, 1.005 * true, seconds=math.inf, most_cells=70)
    assert found.cells > 0
    assert (found.values <= true).all() and (found.values >= 0.98 * true).all()
    twice = certify_costs(
        cost_of(Sea.calm(), 1.2 * length / 3.0, inside=2.0),
        prices,
        true,
        seconds=math.inf,
        most_cells=70,
    )
    assert (twice.values <= length * ((FUEL + prices[:, None]) / SPEEDS).min(axis=1)).all()


def test_lines_raise_a_front_until_their_time():
    certain = np.array([[10.0, 14.0, 20.0], [8.0, 6.0, 5.0]])
    lines = np.array([[0.5, 0.0], [14.0, 6.5]])  # 14 - 0.5 t, and 6.5
    found = raised_by_lines(certain, lines, 18.0)
    assert np.interp([10.0, 12.0, 15.0, 18.0], *found) == pytest.approx([9.0, 8.0, 6.5, 6.5])
    assert np.interp(19.0, *found) == pytest.approx(np.interp(19.0, *certain))
    assert raised_by_lines(certain, np.empty((2, 0)), 18.0) is certain
