"""The globe network: canals, limits, ends in narrow waters, and the grid on disk."""

import dataclasses
import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.chart import Chart
from thalweg.chart.canals import CANALS
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.network import GlobeOptions, check_network, globe, shortest_path
from thalweg.network.distance_bounds import distance_bounds
from thalweg.network.global_grid import grid

ROTTERDAM, SINGAPORE, SUEZ_BAY = (51.98, 4.0), (1.2, 103.9), (29.6, 32.6)
NEW_YORK, SAN_FRANCISCO = (40.5, -73.9), (37.75, -122.6)
SMALL = grid.GridResolution(2, 1)
LATITUDE, LONGITUDE = st.floats(-90.0, 90.0), st.floats(-180.0, 180.0)


@pytest.fixture(scope="module")
def chart():
    return Chart.gshhg("i")


def sailed(network):
    """Return the length [nm] of the shortest way and the canals it passes."""
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    through = []
    for a, b in itertools.pairwise(path):
        edges = slice(network.graph.indptr[a], network.graph.indptr[a + 1])
        edge = edges.start + int(np.flatnonzero(network.graph.target[edges] == b)[0])
        if np.isfinite(network.edges.fixed_time[edge]):
            named = [c.name for c in CANALS if c.transit_time == network.edges.fixed_time[edge]]
            assert network.edges.fee[edge] > 0.0 and network.edges.depth[edge] == np.inf
            through += named
    return distance[network.meta.goal] / 1852.0, through


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "forbidden", "through", "least", "most"),
    [
        # usual figures from port to port: 8,288 and 11,755; 5,263 and 13,135
        (ROTTERDAM, SINGAPORE, (), ["suez"], 8200, 8700),
        (ROTTERDAM, SINGAPORE, ("suez",), [], 11600, 12300),
        (ROTTERDAM, SUEZ_BAY, (), ["suez"], 3200, 3500),
        (ROTTERDAM, SUEZ_BAY, ("suez",), [], 10800, 11600),
        (NEW_YORK, SAN_FRANCISCO, (), ["panama"], 5150, 5400),
        (NEW_YORK, SAN_FRANCISCO, ("panama",), [], 12800, 13600),
        ((53.98, 8.4), (54.5, 10.4), (), ["kiel"], 80, 110),
        ((38.1, 22.7), (37.85, 23.2), (), ["corinth"], 25, 40),
    ],
)  # fmt: skip
def test_canals_are_taken_where_they_are_shorter(
    chart, start, goal, forbidden, through, least, most
):
    network = globe(chart.without_canals(*forbidden), start, goal)
    check_network(network, symmetric=True)
    length, found = sailed(network)
    assert found == through
    assert least < length < most


@pytest.mark.slow
def test_the_black_sea_and_the_baltic_are_joined_to_the_ocean(chart):
    bare = chart.without_canals("all")
    for start in ((46.3, 30.9), (54.5, 18.9), (59.7, 10.6)):
        length, _ = sailed(globe(bare, start, ROTTERDAM))
        crow = float(geodesy.distance(*start, *ROTTERDAM)) / 1852.0
        assert crow < length < 4.0 * crow


@pytest.mark.slow
def test_a_quay_up_a_fjord_gets_an_approach(chart):
    quay = chart.nearest_navigable(60.39, 5.32)[:2]
    network = globe(chart, quay, ROTTERDAM)
    check_network(network, symmetric=True)
    assert (network.lat[network.meta.start], network.lon[network.meta.start]) == quay
    length, _ = sailed(network)
    assert 500 < length < 560


@pytest.mark.slow
def test_edges_are_sampled_and_legs_are_free(chart):
    network = globe(chart, NEW_YORK, (49.7, -7.0))
    check_network(network, symmetric=True)
    tail, head = network.tails(), network.graph.target
    sea = np.isnan(network.edges.fixed_time)
    ends = [network.lat[tail], network.lon[tail], network.lat[head], network.lon[head]]
    assert not chart.legs_blocked(*(x[sea] for x in ends)).any()
    pieces = np.diff(network.samples.ptr) + 1
    assert (network.edges.length / pieces)[sea].max() <= 60.0 * 1852.0 * (1 + 1e-9)
    assert network.edges.length.max() > 200.0 * 1852.0
    close = globe(chart, NEW_YORK, (49.7, -7.0), sample_spacing=20.0 * 1852.0)
    assert close.n_stations - close.n_nodes > 2 * (network.n_stations - network.n_nodes)


def test_results_across_the_antimeridian_are_equal():
    chart = Chart.gshhg("c")
    network = globe(chart, (35.0, 142.0), (37.0, -124.5), coast_levels=2)
    length, _ = sailed(network)
    crow = float(geodesy.distance(35.0, 142.0, 37.0, -124.5)) / 1852.0
    assert crow <= length < 1.06 * crow


def test_the_arctic_is_closed_unless_it_is_opened_or_an_end_lies_there():
    chart = Chart.gshhg("c").without_canals("all")
    kara, bering = (74.0, 70.0), (64.0, -172.0)
    murmansk = (70.0, 34.0)
    usual = globe(chart, murmansk, bering, coast_levels=2)
    opened = globe(chart, murmansk, bering, coast_levels=2, north=82.0)
    assert usual.lat.max() <= 72.0 < opened.lat.max() <= 82.0
    assert sailed(opened)[0] < 0.4 * sailed(usual)[0]
    north = globe(chart, murmansk, kara, coast_levels=2)
    assert 72.0 < north.lat.max() <= 75.0


@pytest.mark.slow
def test_no_go_zones_and_areas_have_no_nodes(chart):
    wall = [[[-31.0, 20.0], [-29.0, 20.0], [-29.0, 71.0], [-31.0, 71.0], [-31.0, 20.0]]]
    zone = {"type": "Feature", "properties": {"kind": "no-go"},
            "geometry": {"type": "Polygon", "coordinates": wall}}  # fmt: skip
    closed = Chart.gshhg("c").with_zones({"type": "FeatureCollection", "features": [zone]})
    free = globe(Chart.gshhg("c"), NEW_YORK, (45.0, -9.5), coast_levels=1)
    round_it = globe(closed, NEW_YORK, (45.0, -9.5), coast_levels=1)
    assert sailed(round_it)[0] > 1.1 * sailed(free)[0]
    tail, head = round_it.tails(), round_it.graph.target
    ends = round_it.lat[tail], round_it.lon[tail], round_it.lat[head], round_it.lon[head]
    assert not closed.legs_blocked(*ends).any()
    boxed = Chart.gshhg("c").within(30.0, 55.0, -80.0, 0.0)
    network = globe(boxed, NEW_YORK, (45.0, -9.5), coast_levels=1)
    assert network.lat.min() >= 30.0 and network.lon.max() <= 0.0


@pytest.mark.slow
def test_no_route_without_canals_names_the_canals_needed(chart):
    wall = [[[6.0, 57.0], [12.6, 57.0], [12.6, 57.4], [6.0, 57.4], [6.0, 57.0]]]
    shut = {"type": "Feature", "properties": {"kind": "no-go"},
            "geometry": {"type": "Polygon", "coordinates": wall}}  # fmt: skip
    baltic = chart.with_zones({"type": "FeatureCollection", "features": [shut]})
    assert sailed(globe(baltic, (54.6, 10.8), ROTTERDAM))[1] == ["kiel"]
    with pytest.raises(NoRouteError, match=r"no path by water.*Allow the .*Kiel Canal") as told:
        globe(baltic.without_canals("all"), (54.6, 10.8), ROTTERDAM)
    assert told.value.nearest is not None


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"level": 9}, "level 9"),
        ({"level": 8, "coast_levels": 7}, "7 coast levels"),
        ({"border_levels": 11}, "11 border levels"),
        ({"directions": 8}, "8 directions"),
        ({"south": 10.0, "north": 5.0}, "latitude limits"),
        ({"slack": -1.0}, "slack"),
        ({"sample_spacing": 10.0}, "too many"),
    ],
)
def test_options_out_of_range_are_refused(wrong, said):
    with pytest.raises(InputError, match=said):
        globe(Chart.gshhg("c"), NEW_YORK, SAN_FRANCISCO, **wrong)


def test_options_by_name_replace_those_of_an_object():
    chart, goal = Chart.gshhg("c"), (45.0, -9.5)
    options = GlobeOptions(coast_levels=1, slack=0.1)
    sizes = [
        globe(chart, NEW_YORK, goal, options).n_nodes,
        globe(chart, NEW_YORK, goal, coast_levels=1, slack=0.1).n_nodes,
        globe(chart, NEW_YORK, goal, options, slack=0.3).n_nodes,
    ]
    assert sizes[0] == sizes[1] < sizes[2]


def test_ends_on_land_are_refused():
    with pytest.raises(InputError, match="not on navigable water"):
        globe(Chart.gshhg("c"), (47.0, 8.0), NEW_YORK)


@pytest.mark.slow
def test_the_grid_is_cached_and_a_damaged_file_is_replaced(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    chart = Chart.gshhg("c")
    made = grid.globe_grid(chart, SMALL)
    (path,) = (tmp_path / "globe").glob("grid-*.npz")
    (part,) = (tmp_path / "globe").glob("part-*.npz")
    grid._load_or_make.cache_clear()
    monkeypatch.setattr(grid, "make_grid", lambda *_: pytest.fail("made again"))
    loaded = grid.globe_grid(chart.without_canals("all"), SMALL)
    for name in ("lat", "lon", "rejected", "spacing", "gap"):
        assert np.array_equal(getattr(loaded, name), getattr(made, name))
    for name in ("first", "second", "length", "course"):
        assert np.array_equal(getattr(loaded.pairs, name), getattr(made.pairs, name))
    monkeypatch.undo()
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    grid._load_or_make.cache_clear()
    path.write_bytes(b"broken")
    part.write_bytes(b"broken")
    assert np.array_equal(grid.globe_grid(chart, SMALL).lat, made.lat)
    assert path.stat().st_size > 1000
    grid._load_or_make.cache_clear()


def test_another_coastline_is_another_grid():
    crude = grid.globe_grid(Chart.gshhg("c"), SMALL)
    low = grid.globe_grid(Chart.gshhg("l"), SMALL)
    assert len(crude.lat) != len(low.lat)


def test_more_slack_gives_more_nodes():
    chart = Chart.gshhg("c")
    ends = NEW_YORK, (45.0, -9.5)
    counts = [globe(chart, *ends, coast_levels=2, slack=s).n_nodes for s in (0.05, 0.5, np.inf)]
    assert counts == sorted(counts) and counts[0] < 0.5 * counts[2]


def test_six_directions_use_only_the_edges_of_faces():
    chart = Chart.open_water()
    ends = (10.0, -40.0), (30.0, 20.0)
    crow = float(geodesy.distance(*ends[0], *ends[1])) / 1852.0
    plain, double = (sailed(globe(chart, *ends, directions=d))[0] / crow for d in (6, 12))
    assert 1.0 <= double < 1.04 and double < plain < 1.16


@given(LATITUDE, LONGITUDE, LATITUDE, LONGITUDE, LATITUDE, LONGITUDE)
def test_the_heuristic_never_overestimates_on_the_ellipsoid(a, b, c, d, e, f):
    to_goal = distance_bounds([a, c], [b, d], e, f)
    assert to_goal[0] <= float(geodesy.distance(a, b, e, f)) + 1e-9
    step = float(geodesy.distance(a, b, c, d))
    assert to_goal[0] - to_goal[1] <= step + 1e-6  # consistent: falls no faster than a leg


@given(st.floats(-90, 90), st.floats(-180, 180), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_the_heuristic_holds_near_antipodes(lat, lon, north, east):
    other = max(min(-lat + north, 90.0), -90.0), lon + 180.0 + east
    bound = float(distance_bounds(lat, lon, *other))
    assert bound <= float(geodesy.distance(lat, lon, *other))


def test_canals_of_ones_own_are_edges_too():
    chart = Chart.gshhg("c").without_canals("all")
    free = dataclasses.replace(CANALS[1], fee=0.0, transit_time=3600.0)
    own = dataclasses.replace(chart, canals=(free,))
    network = globe(own, NEW_YORK, SAN_FRANCISCO, coast_levels=3)
    assert sorted(set(network.edges.fixed_time[np.isfinite(network.edges.fixed_time)])) == [3600.0]


@pytest.mark.slow
def test_borders_of_priced_zones_are_finer():
    chart = Chart.gshhg("c")
    box = [[[-40.0, 30.0], [-20.0, 30.0], [-20.0, 45.0], [-40.0, 45.0], [-40.0, 30.0]]]
    zone = {"type": "Feature", "properties": {"kind": "price", "factor": 2.0},
            "geometry": {"type": "Polygon", "coordinates": box}}  # fmt: skip
    priced = chart.with_zones({"type": "FeatureCollection", "features": [zone]})
    ends = (38.0, -60.0), (38.0, -12.0)
    plain, finer = (globe(c, *ends, coast_levels=1) for c in (chart, priced))
    none = globe(priced, *ends, coast_levels=1, border_levels=0)
    near = [
        int(np.sum((np.abs(n.lat - 45.0) < 0.5) & (n.lon > -38.0) & (n.lon < -22.0)))
        for n in (plain, finer, none)
    ]
    assert near[1] > 20 * max(near[0], 1) and near[2] == near[0]


@pytest.mark.slow
@given(st.integers(0, 10_000), st.integers(0, 10_000))
@settings(max_examples=20)
def test_astar_finds_the_same_as_dijkstra(a, b):
    network = globe(Chart.gshhg("c"), NEW_YORK, (45.0, -9.5), coast_levels=2)
    start, goal = a % network.n_nodes, b % network.n_nodes
    aimed, path = shortest_path(network, start, goal)
    plain, _ = shortest_path(network, start, goal, per_metre=0.0)
    assert aimed[goal] == pytest.approx(plain[goal], rel=1e-12)
    if path:
        tail, head = np.array(path[:-1], int), np.array(path[1:], int)
        assert (path[0], path[-1]) == (start, goal)
        ends = network.lat[tail], network.lon[tail], network.lat[head], network.lon[head]
        legs = geodesy.distance(*ends)
        assert legs.sum() <= aimed[goal] * (1 + 1e-9)
