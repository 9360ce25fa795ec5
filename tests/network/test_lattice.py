"""The lattice: directions, levels, coasts, regions and refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from tests.network.worlds import geojson, land_chart
from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.network import Network, check_network, default_spacing, lattice, shortest_path
from thalweg.network.regional_lattice.directions import (
    LARGEST_OFFSETS,
    largest_angle_gap,
    unique_offsets,
)

OPEN = Chart.open_water()


def ratio(network: Network) -> float:
    """Length of the shortest way over the network by the geodesic distance."""
    distance, _ = shortest_path(network, network.meta.start, network.meta.goal)
    a, b = network.meta.start, network.meta.goal
    straight = geodesy.distance(network.lat[a], network.lon[a], network.lat[b], network.lon[b])
    return float(distance[b] / straight)


@pytest.mark.parametrize("directions", LARGEST_OFFSETS)
def test_directions_are_all_coprime_offsets(directions):
    di, dj = unique_offsets(directions)
    assert 2 * len(di) == directions
    assert np.all(np.gcd(di, dj) == 1)
    assert max(np.abs(di).max(), np.abs(dj).max()) == LARGEST_OFFSETS[directions]


def test_gap_gives_the_published_direction_errors():
    # worst ratio of graph length to true length, square lattice with offsets up to R
    published = {8: 1.0824, 16: 1.0275, 32: 1.0131, 48: 1.0075, 80: 1.0049, 96: 1.0034}
    for directions, worst in published.items():
        gap = largest_angle_gap(*unique_offsets(directions))
        assert 1.0 / math.cos(gap / 2.0) == pytest.approx(worst, abs=5e-5)


@pytest.mark.slow
@pytest.mark.parametrize("directions", [8, 16, 32, 96])
def test_every_node_is_reached_within_the_direction_error(directions):
    network = lattice(OPEN, (40, -60), (48, -10), directions=directions, spacing=80e3)
    check_network(network, symmetric=True)
    start = network.meta.start
    distance, _ = shortest_path(network, start)
    straight = geodesy.distance(40, -60, network.lat, network.lon)
    far = straight > 12 * network.meta.spacing_m
    worst = (distance[far] / straight[far]).max()
    bound = 1.0 / math.cos(network.meta.gap_rad / 2.0)
    assert 1.0 + 0.5 * (bound - 1.0) < worst <= bound + 2e-5


def test_great_circle_lattice_holds_the_geodesic_itself():
    network = lattice(OPEN, (40.6, -73.8), (51.6, -0.5), directions=8, spacing=100e3)
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    assert distance[network.meta.goal] == pytest.approx(5551759.4003, rel=2e-6)
    assert len(path) >= 55


def test_latlon_lattice_has_rows_along_parallels():
    network = lattice(
        Chart.open_water(49, 52, 1, 5), (50, 2), (51, 4),
        spacing=10e3, orientation="latlon", slack=math.inf, coast_levels=0,
    )  # fmt: skip
    inner = network.n_nodes - 2
    assert len(np.unique(np.round(network.lat[:inner], 9))) < 60
    assert len(np.unique(np.round(network.lon[:inner], 9))) < 60
    assert network.n_nodes - 2 == len(np.unique(np.round(network.lat[:inner], 9))) * len(
        np.unique(np.round(network.lon[:inner], 9))
    )


@pytest.mark.slow
def test_exact_ends():
    network = lattice(OPEN, (52.123456789, 3.987654321), (53.5, 2.5))
    start, goal = network.meta.start, network.meta.goal
    assert (network.lat[start], network.lon[start]) == (52.123456789, 3.987654321)
    assert (network.lat[goal], network.lon[goal]) == (53.5, 2.5)


def test_vias_leave_no_gap_longer_than_the_spacing():
    network = lattice(OPEN, (10, -40), (12, -30), directions=96, spacing=50e3)
    tails = np.repeat(np.arange(network.n_edges), np.diff(network.samples.ptr))
    pieces = [
        np.zeros(network.n_edges),
        np.ones(network.n_edges),
        network.samples.fraction.astype(float),
    ]
    edges = np.concatenate([np.arange(network.n_edges), np.arange(network.n_edges), tails])
    share = np.concatenate(pieces)
    order = np.lexsort((share, edges))
    step = np.diff(share[order])[np.diff(edges[order]) == 0]
    edge = edges[order][1:][np.diff(edges[order]) == 0]
    assert (step * network.edges.length[edge]).max() < 1.45 * network.meta.spacing_m


def test_levels_are_finer_at_the_coast_and_joined():
    chart = land_chart((0.0, 2.0, -1.0, 1.0))
    network = lattice(
        chart, (1, -3), (1, 3), directions=16, spacing=30e3, coast_levels=3, slack=1.0
    )
    check_network(network, symmetric=True)
    distance, _ = shortest_path(network, network.meta.start)
    assert np.isfinite(distance).all()
    shore = chart.coastline.shore_distance(network.lat, network.lon)
    near = np.flatnonzero(shore < 8e3)
    edge_length = [
        network.edges.length[network.graph.indptr[n] : network.graph.indptr[n + 1]].min()
        for n in near
    ]
    assert np.median(edge_length) < network.meta.spacing_m / 8 * 1.01
    far = np.flatnonzero(shore > 120e3)
    far = far[far < network.n_nodes - 2]
    lengths = [
        network.edges.length[network.graph.indptr[n] : network.graph.indptr[n + 1]].min()
        for n in far
    ]
    assert np.median(lengths) > 0.9 * network.meta.spacing_m


def test_no_edge_touches_an_island_and_the_path_passes_its_corner():
    box = (0.0, 2.0, -1.0, 1.0)
    chart = land_chart(box)
    network = lattice(chart, (0.5, -3), (0.5, 3), directions=32, spacing=20e3, slack=0.5)
    tails = network.tails()
    blocked = chart.legs_blocked(
        network.lat[tails], network.lon[tails],
        network.lat[network.graph.target], network.lon[network.graph.target],
    )  # fmt: skip
    assert not blocked.any()
    assert network.meta.rejected["land"] > 0
    distance, _ = shortest_path(network, network.meta.start, network.meta.goal)
    corner = sum(
        float(geodesy.distance(*a, *b))
        for a, b in [((0.5, -3), (0, -1)), ((0, -1), (0, 1)), ((0, 1), (0.5, 3))]
    )
    assert corner < distance[network.meta.goal] < 1.0131 * corner


@pytest.mark.slow
def test_narrow_strait_is_found_through_coast_levels():
    # a wall from 60 S to 60 N but for a strait half a mile wide; the coarse spacing is 25 nm
    chart = land_chart((-60, 0.2, -0.05, 0.05), (0.21, 60, -0.05, 0.05))
    network = lattice(chart, (-1, -4), (1, 4), directions=16, spacing=46300.0, slack=0.3)
    check_network(network)
    assert ratio(network) < 1.05


@pytest.mark.slow
def test_across_the_antimeridian():
    network = lattice(OPEN, (-18.2, 178.4), (-13.7, -171.8), directions=16)
    check_network(network, symmetric=True)
    assert ratio(network) == pytest.approx(1.0, abs=1e-4)
    assert np.all((network.lon >= -180) & (network.lon < 180))
    assert (network.lon > 170).any()
    assert (network.lon < -170).any()


@pytest.mark.slow
@pytest.mark.parametrize("orientation", ["great_circle", "latlon"])
def test_high_latitude(orientation):
    network = lattice(OPEN, (80, 10), (80, 40), directions=32, orientation=orientation, slack=0.2)
    check_network(network, symmetric=True)
    assert ratio(network) < 1.0 / math.cos(network.meta.gap_rad / 2.0) + 1e-3


def test_over_the_pole():
    network = lattice(OPEN, (85, 0), (85, 180), directions=16, slack=0.1)
    check_network(network, symmetric=True)
    assert ratio(network) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.slow
def test_region_grows_until_a_long_detour_fits():
    # a wall far longer than the first ellipse
    chart = land_chart((-12, 12, -0.1, 0.1))
    network = lattice(chart, (0, -2), (0, 2), directions=16, spacing=40e3, slack=0.1)
    corner = 2 * float(geodesy.distance(0, -2, 12, -0.1)) + float(
        geodesy.distance(12, -0.1, 12, 0.1)
    )
    distance, _ = shortest_path(network, network.meta.start, network.meta.goal)
    assert corner < distance[network.meta.goal] < 1.03 * corner


@pytest.mark.slow
def test_half_the_globe_away_over_a_closed_globe():
    # a wall from pole to pole but for the far side: the only way runs round the globe
    chart = land_chart((-89, 89, -0.5, 0.5))
    network = lattice(chart, (0, -5), (0, 5), directions=16, spacing=400e3, slack=0.1)
    check_network(network)
    distance, _ = shortest_path(network, network.meta.start, network.meta.goal)
    around = 350.0 / 360.0 * 2 * math.pi * 6378137.0
    over_the_edge = 2 * float(geodesy.distance(0, -5, 84, -0.5))
    assert over_the_edge * 0.99 < distance[network.meta.goal] < around


def test_slack_limits_the_path_through_every_node():
    network = lattice(OPEN, (10, -40), (12, -30), directions=16, spacing=30e3, slack=0.2)
    a, _ = shortest_path(network, network.meta.start)
    b, _ = shortest_path(network, network.meta.goal)
    limit = 1.2 * a[network.meta.goal] + 4.01 * network.meta.spacing_m
    assert (a + b).max() <= limit


def test_infinite_slack_fills_the_area():
    network = lattice(
        OPEN, (1, 1), (9, 9), spacing=100e3, directions=8, slack=math.inf, area=(0, 10, 0, 10)
    )
    expected = (10 * 111.0 / 100) ** 2
    assert 0.8 * expected < network.n_nodes < 1.2 * expected
    assert network.lat.min() >= 0
    assert network.lon.max() <= 10


def test_short_voyage_has_the_direct_leg():
    network = lattice(OPEN, (52, 3), (52.01, 3), spacing=2000.0)
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    assert distance[network.meta.goal] == pytest.approx(geodesy.distance(52, 3, 52.01, 3), 1e-9)
    assert len(path) <= 2


def test_default_spacing_is_bounded():
    assert default_spacing(1e3) == 100.0
    assert default_spacing(1e6) == 1e4
    assert default_spacing(1e7) == 30 * 1852.0


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"directions": 12}, "directions"),
        ({"spacing": 0.0}, "spacing"),
        ({"spacing": math.nan}, "spacing"),
        ({"coast_levels": -1}, "coast levels"),
        ({"orientation": "up"}, "orientation"),
        ({"slack": -0.1}, "slack"),
        ({"slack": math.nan}, "slack"),
        ({"spacing": 5.0, "slack": 1.0}, "nodes"),
    ],
)
def test_values_out_of_range(changes, word):
    with pytest.raises(InputError, match=word):
        lattice(OPEN, (10, -40), (12, -30), **changes)


def test_same_place_is_refused():
    with pytest.raises(InputError, match="same place"):
        lattice(OPEN, (10, 170), (10, -190))


def test_ends_on_land_are_refused():
    chart = land_chart((0.0, 2.0, -1.0, 1.0))
    with pytest.raises(InputError, match="start"):
        lattice(chart, (1, 0), (1, 3))
    with pytest.raises(InputError, match="goal"):
        lattice(chart, (1, 3), (1, 0))


@pytest.mark.slow
def test_enclosed_goal_states_the_reasons_and_the_nearest_position():
    chart = land_chart((-1, 3, -1, -0.9), (-1, 3, 2.9, 3), (-1, -0.9, -1, 3), (2.9, 3, -1, 3))
    with pytest.raises(NoRouteError) as refusal:
        lattice(chart, (1, -6), (1, 1), spacing=20e3, directions=16)
    assert refusal.value.reasons["land"] > 0
    lat, lon = refusal.value.nearest
    assert 100e3 < geodesy.distance(lat, lon, 1, 1) < 300e3


def test_no_go_zones_block_the_route():
    zone = geojson((-0.5, 0.5, -0.5, 0.5))
    zone["features"][0]["properties"] = {"kind": "no-go"}
    chart = OPEN.with_zones(zone)
    network = lattice(chart, (0, -2), (0, 2), directions=16, spacing=10e3, slack=0.3)
    assert 1.02 < ratio(network) < 1.08
    assert network.meta.rejected["no-go zone"] > 0


def test_depth_and_factors_are_on_the_edges():
    zone = geojson((-0.5, 0.5, -0.5, 0.5))
    zone["features"][0]["properties"] = {"kind": "penalty", "factor": 2.0}
    chart = Chart.open_water(-3, 3, -3, 3).with_zones(zone)
    chart = chart.with_depth(lambda lat, lon: np.where(np.abs(lon) < 0.2, 4.0, 20.0))
    network = lattice(chart, (0, -2), (0, 2), directions=8, spacing=10e3)
    assert set(np.unique(network.edges.depth)) == {4.0, 20.0}
    assert network.edges.penalty_factor.min() == 1.0
    assert network.edges.penalty_factor.max() == pytest.approx(2.0)
    lon = network.lon[network.tails()]
    assert np.all(network.edges.depth[np.abs(lon) < 0.1] == 4.0)


def outside_polar_cap(start, goal, latitude: float) -> float:
    """Ratio of the shortest path that stays below a latitude to the great circle.

    Two great circles that touch the parallel and the arc of the parallel between them, on a sphere.
    """
    pole = 1.0 if start[0] + goal[0] > 0.0 else -1.0
    a, b = (math.radians(90.0 - pole * place[0]) for place in (start, goal))
    cap, turn = math.radians(90.0 - latitude), math.radians(abs(goal[1] - start[1]) % 360.0)
    turn = min(turn, 2.0 * math.pi - turn)
    straight = math.acos(math.cos(a) * math.cos(b) + math.sin(a) * math.sin(b) * math.cos(turn))
    arc = turn - sum(math.acos(math.tan(cap) / math.tan(side)) for side in (a, b))
    if arc <= 0.0:
        return 1.0
    tangents = sum(math.acos(math.cos(side) / math.cos(cap)) for side in (a, b))
    return (tangents + arc * math.sin(cap)) / straight


@pytest.mark.slow
@settings(max_examples=15)
@example(-58.0, 0.0, 3.0, 2_162_673.0, 32, "latlon")  # edges over 3 x 470 km of the equator
@example(-62.0, 0.0, 3.0, 1_891_161.0, 32, "latlon")
@example(-73.0, 0.0, 3.0, 2_635_000.0, 32, "latlon")
@example(-62.2366, 0.0, 3.04819, 3_379_416.6, 16, "latlon")  # 12 % longer, around 84 S
@example(60.0767, 0.0, -0.0853, 3_991_552.0, 32, "latlon")  # the goal just below the last row
@given(
    st.floats(-75, 75), st.floats(-180, 180), st.floats(0, 6.28), st.floats(5e3, 4e6),
    st.sampled_from([8, 16, 32]), st.sampled_from(["great_circle", "latlon"]),
)  # fmt: skip
def test_the_path_is_within_the_direction_error_anywhere(
    lat, lon, course, length, directions, orientation
):
    goal = tuple(float(v) for v in geodesy.direct(lat, lon, course, length))
    around = 1.0
    if orientation == "latlon":  # its last row is less than a spacing below 84 degrees
        row = length / 12 / 6_371_000.0 / math.cos(math.radians(0.5 * (lat + goal[0])))
        last = math.atan(math.sinh(math.asinh(math.tan(math.radians(84.0))) - row))
        assume(abs(goal[0]) < math.degrees(last))
        around = outside_polar_cap((lat, lon), goal, math.degrees(last))
    network = lattice(
        OPEN, (lat, lon), goal,
        directions=directions, orientation=orientation, spacing=length / 12, slack=0.1,
        coast_levels=0,
    )  # fmt: skip
    check_network(network, symmetric=True)
    direction_error = 1.0 / math.cos(network.meta.gap_rad / 2.0)
    assert 1.0 - 1e-9 <= ratio(network) <= around * direction_error + 5e-3


def test_rows_along_parallels_end_at_84_degrees():
    with pytest.raises(InputError, match="does not reach the goal") as refusal:
        lattice(OPEN, (60.0, 0.0), (89.0, 15.0), orientation="latlon", spacing=200e3)
    assert "great_circle" in str(refusal.value)


@pytest.mark.slow
def test_floro_santander_on_gshhg():
    chart = Chart.gshhg("i")
    start = chart.nearest_navigable(61.60, 5.03)
    goal = chart.nearest_navigable(43.47, -3.77)
    assert start is not None
    assert goal is not None
    network = lattice(chart, start[:2], goal[:2], directions=32)
    check_network(network, symmetric=True)
    distance, path = shortest_path(network, network.meta.start, network.meta.goal)
    miles = distance[network.meta.goal] / 1852.0
    assert 1234.5 * 0.999 < miles < 1234.5 / math.cos(network.meta.gap_rad / 2.0)
    dover = geodesy.distance(network.lat[path], network.lon[path], 51.0, 1.45)
    assert dover.min() < 20 * 1852.0
