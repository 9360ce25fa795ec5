"""Nodes in narrow channels, and networks of fixed routes."""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.geodesy import distance
from thalweg.network import check_network, fixed_route, lattice, shortest_path

KYLE_RHEA = (57.2395, -5.6525)  # 0.6 km wide, between Skye and the mainland


def walls(gap_deg):
    """Return a chart of two large lands with a channel between them, from south to north."""
    half = gap_deg / 2
    west = [[-2.0, 0.0], [-half, 0.0], [-half, 1.0], [-2.0, 1.0], [-2.0, 0.0]]
    east = [[half, 0.0], [2.0, 0.0], [2.0, 1.0], [half, 1.0], [half, 0.0]]
    shapes = [{"type": "Polygon", "coordinates": [ring]} for ring in (west, east)]
    features = [{"type": "Feature", "properties": {}, "geometry": shape} for shape in shapes]
    land = {"type": "FeatureCollection", "features": features}
    return Chart.from_geojson(land).within(-1.0, 2.0, -4.0, 4.0)


@pytest.mark.parametrize("gap_deg", [0.002, 0.01, 0.05])
def test_a_channel_much_narrower_than_the_spacing_is_found(gap_deg):
    start, goal = (-0.5, 0.3), (1.5, -0.3)
    network = lattice(walls(gap_deg), start, goal, spacing=10_000.0, coast_levels=0, slack=2.0)
    check_network(network)
    length = shortest_path(network, network.meta.start, network.meta.goal)[0][network.meta.goal]
    direct = distance(*start, 0.0, 0.0) + distance(0.0, 0.0, 1.0, 0.0) + distance(1.0, 0.0, *goal)
    assert length == pytest.approx(float(direct), rel=0.01)


def test_wide_water_gets_no_more_nodes():
    start, goal = (-0.5, 0.3), (1.5, -0.3)
    options = {"spacing": 10_000.0, "coast_levels": 0, "slack": 2.0}
    wide = lattice(walls(0.6), start, goal, **options)  # 67 km
    assert wide.meta.rejected and wide.n_nodes == len(set(zip(wide.lat, wide.lon)))
    x = np.abs(wide.lon[: wide.n_nodes - 2])
    y = wide.lat[: wide.n_nodes - 2]
    amid = (x < 0.01) & (y > 0.02) & (y < 0.98)
    assert amid.sum() <= 12  # those of the lattice, 10 km apart


@pytest.mark.slow
def test_a_kyle_of_the_highlands_is_passed_on_a_coarse_lattice():
    chart = Chart.gshhg("i", narrows_closed=False)
    network = lattice(chart, (58.5, -6.0), (56.0, -7.0), spacing=15_000.0, coast_levels=0)
    away = distance(network.lat, network.lon, *KYLE_RHEA)
    node = int(np.argmin(away))
    assert away[node] < 300.0
    reached, _ = shortest_path(network, network.meta.start, node)
    north = reached[node]
    south = shortest_path(network, node, network.meta.goal)[0][network.meta.goal]
    assert north + south < 1.25 * reached[network.meta.goal]


def test_a_fixed_route_has_nodes_along_it_and_at_borders():
    chart = Chart.gshhg("i").with_eca("north-sea")
    way = [(61.0, 2.0), (62.5, 2.0), (62.5, -3.0)]
    network = fixed_route(chart, way, spacing=50_000.0)
    check_network(network)
    assert (network.meta.start, network.meta.goal) == (0, network.n_nodes - 1)
    length, path = shortest_path(network, 0, network.n_nodes - 1)
    legs = distance(*way[0], *way[1]) + distance(*way[1], *way[2])
    assert length[-1] == pytest.approx(float(legs), rel=1e-9)
    assert path == list(range(network.n_nodes))
    assert network.edges.length.max() <= 50_000.0 + 1e-6
    assert np.abs(network.lat - 62.0).min() < 1e-4  # the area ends at 62 N
    share = chart.zones.eca_fraction(
        network.lat[:-1], network.lon[:-1], network.lat[1:], network.lon[1:]
    )
    assert np.all((share < 1e-4) | (share > 1.0 - 1e-4))


def test_pulling_a_line_keeps_its_canal():
    chart = Chart.gshhg("i")
    canal = next(c for c in chart.canals if c.name == "kiel")
    network = fixed_route(chart, list(canal.ends), spacing=1000.0)
    assert network.n_nodes == 2
    assert network.edges.length[0] == canal.length
    assert network.edges.fixed_time[0] == canal.transit_time and network.edges.fee[0] == canal.fee
    assert list(zip(network.lat, network.lon)) == list(canal.ends)
