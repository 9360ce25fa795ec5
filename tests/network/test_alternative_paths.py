"""Alternative paths: around islands, through canals, and at other prices."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.network.worlds import land_chart
from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.kernels.network.static_paths import meridian_crossings
from thalweg.network import EdgeWeights, alternative_paths, globe, lattice, paths_without_canals
from thalweg.network.alternatives.homotopy import obstacles
from thalweg.network.alternatives.leg_rules import total_cost
from thalweg.network.alternatives.path_search import _best_of_each_class, without_each_set_of_canals
from thalweg.network.alternatives.path_shortening import string_pull_path

WEST, EAST = (0.0, -1.0), (0.0, 1.0)
#: An island north of the line between, wider to the south of it, and a rock further south.
ISLAND, ROCK = (-0.3, 0.1, -0.2, 0.2), (-0.62, -0.6, -0.01, 0.01)
NORTH_SEA_CASE = ((61.60, 5.03), (43.47, -3.77))


def corner_way(*corners):
    """Return the length of the way from west to east by corners."""
    lat, lon = np.array([WEST, *corners, EAST]).T
    return float(geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:]).sum())


@pytest.fixture(scope="module")
def world():
    chart = land_chart(ISLAND, ROCK)
    return chart, lattice(chart, WEST, EAST, slack=1.0)


@pytest.mark.slow
def test_both_sides_of_an_island_are_found_and_shortened(world):
    chart, network = world
    ways = alternative_paths(network, chart)
    assert len(ways) == 2
    north = corner_way((0.1, -0.2), (0.1, 0.2))
    south = corner_way((-0.3, -0.2), (-0.3, 0.2))
    assert [way.length for way in ways] == pytest.approx([north, south], rel=1e-3)
    assert all(way.length >= exact for way, exact in zip(ways, (north, south)))
    assert ways[0].lat.max() > 0.09 and ways[1].lat.min() < -0.29
    assert [way.canals for way in ways] == [(), ()]
    assert ways[0].ratio == 1.0 < ways[1].ratio
    for way in ways:
        legs = way.lat[:-1], way.lon[:-1], way.lat[1:], way.lon[1:]
        assert not chart.legs_blocked(*legs).any()
        assert way.waypoints[0] == WEST and way.waypoints[-1] == EAST
        assert len(way.lat) < 12 < len(way.path)


@pytest.mark.slow
def test_the_least_width_of_islands_can_be_set(world):
    chart, network = world
    assert len(alternative_paths(network, chart, island=1000.0)) == 3
    assert len(alternative_paths(network, chart, island=1e6)) == 1
    assert len(alternative_paths(network, chart, island=1000.0, most=2)) == 2


@pytest.mark.slow
def test_stretch_limits_the_paths(world):
    chart, network = world
    north = corner_way((0.1, -0.2), (0.1, 0.2))
    south = corner_way((-0.3, -0.2), (-0.3, 0.2))
    assert len(alternative_paths(network, chart, stretch=0.7 * (south / north - 1.0))) == 1
    assert len(alternative_paths(network, chart, stretch=1.2 * (south / north - 1.0))) == 2


def test_prices_favour_the_other_path(world):
    chart, network = world
    tail = network.tails()
    dear = np.where(network.lat[tail] > 0.05, 3.0, 1.0) * network.edges.length
    ways = alternative_paths(network, chart, edge_weight_sets=[EdgeWeights(), EdgeWeights(dear)])
    assert [way.ratio for way in ways] == [1.0, 1.0]
    assert ways[1].lat.min() < -0.29


def test_signatures_of_trees_are_those_of_their_paths(world):
    chart, network = world
    seen = obstacles(network, chart, 1000.0)
    assert seen.crossings.shape == (network.n_edges, 3)  # the pole, the island, the rock
    kinds = _best_of_each_class(network, seen, EdgeWeights(), 0, 0.6)
    assert len({kind.signature for kind in kinds}) == len(kinds) >= 3
    for kind in kinds:
        along = seen.along(chart, network.lat[kind.path], network.lon[kind.path])
        counts = np.frombuffer(along, np.int64)
        assert np.array_equal(counts, np.frombuffer(kind.signature, np.int16))


@given(
    st.floats(-60, 60), st.floats(-180, 180), st.floats(0.01, 4.0), st.integers(3, 12),
    st.floats(0, 360), st.booleans(),
)  # fmt: skip
def test_a_ring_round_a_point_crosses_its_meridian_once(lat, lon, radius, count, turn, inside):
    turns = np.radians(turn + 360.0 * np.arange(count) / count)
    middle = (lat, lon) if inside else geodesy.direct(lat, lon, 0.5, 2.2e5 * radius)
    at = np.array([float(x) for x in middle])
    if not inside and abs(at[0]) > 85.0:
        return
    y, x = geodesy.direct(*at, turns, 1e5 * radius if inside else 9e4 * radius)
    a = np.arange(count)
    answer = np.empty((count, 1), np.int8)
    meridian_crossings(y, x, a, np.roll(a, -1), np.array([[lat, lon]]), answer)
    assert answer.sum() == (1 if inside else 0)  # clockwise seen from above is eastward, north
    back = np.empty((count, 1), np.int8)
    meridian_crossings(y, x, np.roll(a, -1), a, np.array([[lat, lon]]), back)
    assert back.sum() == -answer.sum()


@pytest.mark.slow
@given(st.integers(0, 2**31))
@settings(max_examples=15)
def test_pulling_never_costs_more_and_never_touches_land(seed):
    rng = np.random.default_rng(seed)
    boxes = []
    for y, x in zip(rng.uniform(-0.4, 0.4, 4), np.linspace(-0.7, 0.7, 4)):
        boxes.append((y - 0.1, y + 0.1, x - 0.08, x + 0.08))
    chart = land_chart(*boxes)
    network = lattice(chart, WEST, EAST, spacing=9000.0, coast_levels=1, directions=8)
    (way, *_) = alternative_paths(network, chart, most=1)
    before = network.lat[way.path], network.lon[way.path]
    assert way.length <= total_cost(before)
    legs = way.lat[:-1], way.lon[:-1], way.lat[1:], way.lon[1:]
    assert not chart.legs_blocked(*legs).any()
    again = string_pull_path(chart, way.lat, way.lon)
    assert total_cost(again) <= way.length * (1 + 1e-12)


def test_waypoints_round_a_curved_outline_must_save_a_share_of_the_path():
    edges = np.linspace(-0.3, 0.3, 61)
    height = 0.2 - np.maximum(np.abs(edges[:-1]), np.abs(edges[1:])) ** 2
    chart = land_chart(*((0.0, h, a, b) for h, a, b in zip(height, edges[:-1], edges[1:])))
    near, mid = height + 1e-5, 0.5 * (edges[:-1] + edges[1:])
    north = np.column_stack([near, height + 2e-3, near]).ravel()
    lat = np.concatenate([[0.0], north, [0.0]])
    lon = np.concatenate([[-1.0], np.column_stack([edges[:-1], mid, edges[1:]]).ravel(), [1.0]])
    every = string_pull_path(chart, lat, lon)
    few = string_pull_path(chart, lat, lon, least_gain=1e-5)
    assert len(few[0]) < 0.7 * len(every[0])
    assert not chart.legs_blocked(few[0][:-1], few[1][:-1], few[0][1:], few[1][1:]).any()
    saved = 1e-5 * (len(every[0]) - len(few[0]))
    assert total_cost(every) < total_cost(few) <= total_cost(every) * (1.0 + saved)


def test_pulling_with_a_cost_avoids_expensive_areas():
    chart = Chart.open_water(-5.0, 5.0, -5.0, 5.0)

    def cost(lat1, lon1, lat2, lon2):
        length = geodesy.distance(lat1, lon1, lat2, lon2)
        share = np.clip(0.3 - np.abs(0.5 * (np.asarray(lat1) + lat2)), 0.0, 0.3) / 0.3
        near = np.abs(0.5 * (np.asarray(lon1) + lon2)) < 0.6
        return length * (1.0 + 4.0 * share * near)

    lat, lon = np.array([0.0, 0.0]), np.array([-1.0, 1.0])
    y, x = string_pull_path(chart, lat, lon, leg_cost=cost)
    assert total_cost((y, x), cost) < 0.75 * total_cost((lat, lon), cost)
    assert np.abs(y).max() > 0.2
    tested = []

    def counted_cost(*ends):
        tested.append(len(ends[0]))
        return cost(*ends)

    string_pull_path(chart, lat, lon, leg_cost=counted_cost)
    every = sum(tested)
    tested.clear()
    same = string_pull_path(chart, lat, lon, leg_cost=counted_cost, least_cost=geodesy.distance)
    assert np.array_equal(same, (y, x))
    assert sum(tested) < 0.8 * every


def test_canals_stay_in_shortened_paths_with_their_length():
    chart = Chart.gshhg("i")
    suez = chart.canals[0]
    (a, b), (c, d) = suez.ends
    lat, lon = np.array([32.5, 32.0, a, c, 28.5]), np.array([31.0, 32.0, b, d, 33.2])
    y, x = string_pull_path(chart, lat, lon)
    assert (chart.canal_of_legs(y[:-1], x[:-1], y[1:], x[1:]) == 0).sum() == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "through"),
    [
        ((51.98, 4.0), (1.2, 103.9), [("suez",), ()]),
        ((51.98, 4.0), (54.6, 18.9), [("kiel",), ()]),
        ((51.98, 4.0), (37.85, 23.2), [("corinth",), ()]),
    ],
)
def test_paths_without_canals_are_returned_up_to_the_threshold(start, goal, through):
    chart = Chart.gshhg("i")
    network = globe(chart, start, goal, slack=0.6)
    ways = paths_without_canals(network, chart, threshold=0.6)
    assert [way.canals for way in ways] == through
    assert len(paths_without_canals(network, chart, threshold=0.005)) == 1
    for way in ways:
        legs = way.lat[:-1], way.lon[:-1], way.lat[1:], way.lon[1:]
        assert not chart.legs_blocked(*legs).any()
        at_sea = chart.canal_of_legs(*legs) < 0
        sea = geodesy.distance(*(leg[at_sea] for leg in legs)).sum()
        canals = [c.length for c in chart.canals if c.name in way.canals]
        assert way.length == pytest.approx(sea + sum(canals), rel=1e-9)


@pytest.mark.slow
def test_a_path_by_two_canals_is_searched_without_their_subsets():
    chart = Chart.gshhg("i")
    network = globe(chart, (38.2, 22.5), (27.0, 34.5), slack=0.6)  # Gulf of Corinth to Red Sea
    ways = paths_without_canals(network, chart, threshold=0.6)
    # no path without Suez is within the threshold, so two of the four subsets are left
    assert [way.canals for way in ways] == [("corinth", "suez"), ("suez",)]
    toll = network.edges.length + 1e6 * (network.edges.fee == chart.canals[3].fee)
    first, *_ = paths_without_canals(network, chart, edge_weights=EdgeWeights(toll), threshold=0.6)
    assert first.canals == ("suez",)
    hours = EdgeWeights(network.times(7.0))
    by_time, *_ = paths_without_canals(network, chart, edge_weights=hours)
    canals = [canal for canal in chart.canals if canal.name in by_time.canals]
    sea = ways[0].length - sum(
        canal.length for canal in chart.canals if canal.name in ways[0].canals
    )
    waiting = sum(canal.transit_time for canal in canals)
    assert by_time.canals == ("corinth", "suez")
    assert by_time.cost == pytest.approx(waiting + sea / 7.0, rel=0.06)


@pytest.mark.slow
def test_floro_santander_has_three_paths_for_three_prices():
    """Shortest, 1.2 and 1.5593 times the price inside: exact lengths by visibility graph."""
    chart = Chart.gshhg("i").with_eca("north-sea")
    ends = [chart.nearest_navigable(*place)[:2] for place in NORTH_SEA_CASE]
    network = globe(chart, *ends)
    edge_weight_sets = [EdgeWeights.priced(network, chart, factor) for factor in (1.0, 1.2, 1.5593)]
    ways = alternative_paths(network, chart, edge_weight_sets=edge_weight_sets, most=3)
    exact = [(929.5, 1234.5), (310.3, 1290.3), (29.8, 1409.4)]  # inside, total [nm]
    ratios = (1.0, 1.2, 1.5593)
    assert len(ways) == 3
    for way, (inside, total), factor in zip(ways, exact, ratios):
        assert way.length / 1852.0 == pytest.approx(total, rel=0.01)
        best = total + (factor - 1.0) * inside
        assert way.cost / 1852.0 == pytest.approx(best, rel=0.01)
        assert way.cost / 1852.0 > 0.999 * best
    assert ways[0].lon.max() > 1.0 and ways[0].lat[2:-2].min() < 49.0  # by Dover
    assert all(np.any((way.lat < 55.5) & (way.lat > 54) & (way.lon > -6)) for way in ways[1:])
    assert ways[2].lat.max() > 61.9  # north of the area's border


def test_wrong_input_is_refused(world):
    chart, network = world
    for wrong, said in (({"most": 0}, "0 paths"), ({"stretch": -0.1}, "-0.1")):
        with pytest.raises(InputError, match=said):
            alternative_paths(network, chart, **wrong)
    with pytest.raises(InputError, match="do not fit"):
        alternative_paths(network, chart, edge_weight_sets=[EdgeWeights(np.ones(3))])
    with pytest.raises(InputError, match="factor of control areas"):
        EdgeWeights.priced(network, chart, 0.0)
    meta = dataclasses.replace(network.meta, start=-1)
    with pytest.raises(InputError, match="no start"):
        paths_without_canals(dataclasses.replace(network, meta=meta), chart)
    shut = np.full(network.n_edges, np.inf)
    with pytest.raises(NoRouteError, match="no path"):
        alternative_paths(network, chart, edge_weight_sets=[EdgeWeights(shut)])
    with pytest.raises(NoRouteError, match="no path"):
        paths_without_canals(network, chart, edge_weights=EdgeWeights(shut))


def test_every_set_of_canals_is_closed_once_the_smaller_ones_first():
    closed = list(
        without_each_set_of_canals("ab", lambda names: None if names == ("b",) else names)
    )
    assert closed == [("a",), ("a", "b")]
