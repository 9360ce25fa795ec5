"""The least length round land: true shortest ways in made and real water, and no more than ways."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse
import shapely

from thalweg import Chart
from thalweg.chart.passages import Passage
from thalweg.core.geodesy import distance
from thalweg.search.certificate.barrier_mesh import BarrierLink
from thalweg.search.certificate.closed_polygons import ClosedPolygons
from thalweg.search.certificate.land_corners import land_inside
from thalweg.search.certificate.length_round_land import length_round_land
from thalweg.search.certificate.local_outlines import FINER, LocalOutlines
from thalweg.search.certificate.positions_in_reach import Reach

NM = 1852.0


def island(west, south, east, north):
    corners = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return {"type": "Polygon", "coordinates": [corners]}


def by(*places):
    lat, lon = np.array(places, float).T
    return float(np.sum(distance(lat[:-1], lon[:-1], lat[1:], lon[1:])))


def test_round_an_island_it_is_the_way_by_its_nearer_corners():
    chart = Chart.from_geojson(island(1.0, -2.0, 1.5, 0.5))
    start, goal = (0.0, 0.0), (0.0, 2.5)
    shortest = by(start, (0.5, 1.0), (0.5, 1.5), goal)
    found = length_round_land(chart, start, goal, 1.01 * shortest, seconds=20.0)
    assert 0.997 * shortest < found <= shortest
    assert found > 1.02 * by(start, goal)


def test_between_two_islands_the_gap_counts_and_not_the_way_round_both():
    two = [island(1.0, 0.05, 1.5, 3.0), island(1.0, -3.0, 1.5, -0.05)]
    chart = Chart.from_geojson({"type": "GeometryCollection", "geometries": two})
    start, goal = (1.0, 0.0), (1.0, 2.5)
    shortest = by(start, (0.05, 1.0), (0.05, 1.5), goal)
    found = length_round_land(chart, start, goal, 1.01 * shortest, seconds=20.0)
    assert 0.995 * shortest < found <= shortest


def test_a_closed_passage_between_two_islands_is_not_a_gap():
    two = [island(1.0, 0.05, 1.5, 3.0), island(1.0, -2.0, 1.5, -0.05)]
    chart = Chart.from_geojson({"type": "GeometryCollection", "geometries": two})
    passage = Passage(
        "gap", "trade", ((0.0, 0.9), (0.0, 1.6)), 5000.0, closing_line=((-0.1, 1.25), (0.1, 1.25))
    )
    start, goal = (1.0, 0.0), (1.0, 2.5)
    through = by(start, (0.05, 1.0), (0.05, 1.5), goal)
    round_it = by(start, (3.0, 1.0), (3.0, 1.5), goal)
    known = 1.01 * round_it
    found = length_round_land(chart, start, goal, known, seconds=20.0)
    assert 0.995 * through < found <= through
    closed = replace(chart, closed_passages=(passage,))
    found = length_round_land(closed, start, goal, known, seconds=20.0)
    assert 0.99 * round_it < found <= round_it
    # a way along the passage's line that crosses it nowhere is as short as before
    found = length_round_land(closed, (0.0, 1.2), (-1.0, 0.5), known, seconds=20.0)
    assert found <= by((0.0, 1.2), (-0.05, 1.0), (-1.0, 0.5))


def isthmus(width):
    """Two continents and a land bridge of a width [deg] between them."""
    bridge = island(12.0, -0.3, 12.0 + width, 0.3)
    lands = [island(10.0, 0.2, 14.0, 20.0), island(10.0, -20.0, 14.0, -0.2), bridge]
    return Chart.from_geojson({"type": "GeometryCollection", "geometries": lands})


@pytest.mark.parametrize("width", [0.15, 0.04])
def test_a_land_bridge_narrower_than_the_first_tolerance_is_no_gap(width):
    start, goal = (0.0, 0.0), (0.0, 24.0)
    round_it = by(start, (20.0, 10.0), (20.0, 14.0), goal)
    found = length_round_land(isthmus(width), start, goal, 1.02 * round_it, seconds=60.0)
    assert 0.99 * round_it < found <= round_it


def test_outlines_are_finer_only_in_tiles_that_are_refined():
    chart = isthmus(0.15)
    reach = Reach((0.0, 0.0), (0.0, 24.0), 6e6)
    outlines = LocalOutlines(ClosedPolygons.within_reach(chart, reach), 0.1)
    middle = shapely.Point(12.075, 0.0)
    assert not any(one.contains(middle) for one in outlines.outlines()[0])
    assert outlines.refine(np.array([[0.0], [12.075]]), beside=1)
    land = shapely.union_all(outlines.closed.meeting((9.0, -21.0, 15.0, 21.0), 0.0))
    shapes, inner = map(shapely.union_all, outlines.outlines())
    assert shapes.contains(middle) and inner.contains(middle)
    assert land.contains(shapes.buffer(0.01)) and shapes.contains(inner.buffer(0.01))
    assert outlines.refine(np.array([[0.0], [12.075]]), beside=1)
    assert not outlines.refine(np.array([[0.0], [12.075]]), beside=1)  # no finer level


def ragged_island(random):
    """An island 2 to 8 degrees wide with bays and headlands, as a ring (n, 2)."""
    angle = np.sort(random.uniform(0.0, 2.0 * np.pi, 90))
    radius = random.uniform(1.0, 4.0, 90)
    return np.c_[radius * np.cos(angle) + 10.0, radius * np.sin(angle)]


def chart_of(ring):
    return Chart.from_geojson(
        {"type": "Polygon", "coordinates": [[*ring.tolist(), ring[0].tolist()]]}
    )


def straight_way(ring, start, goal):
    """Length of the shortest way on lines that are straight on a map [m]: some way, so no bound."""
    nodes = np.concatenate([[start[::-1], goal[::-1]], ring])
    land = shapely.make_valid(shapely.Polygon(ring))
    inside = shapely.buffer(land, -1e-7)
    one, other = np.triu_indices(len(nodes), 1)
    lines = shapely.linestrings(np.stack([nodes[one], nodes[other]], axis=1))
    free = ~shapely.intersects(lines, inside)
    share = np.linspace(0.0, 1.0, 40)[:, None]
    lon, lat = np.moveaxis(
        nodes[one[free]] * (1.0 - share[..., None]) + nodes[other[free]] * share[..., None], -1, 0
    )
    length = distance(lat[:-1], lon[:-1], lat[1:], lon[1:]).sum(axis=0)
    graph = scipy.sparse.coo_array((length, (one[free], other[free])), shape=(len(nodes),) * 2)
    return float(scipy.sparse.csgraph.dijkstra(graph.tocsr(), directed=False, indices=0)[1])


@pytest.mark.parametrize("seed", range(8))
def test_it_is_no_longer_than_a_way_round_a_ragged_island(seed):
    ring = ragged_island(np.random.default_rng(seed))
    start, goal = (-1.0, 4.0), (0.5, 16.0)
    way = straight_way(ring, start, goal)
    known = 4.1e6  # so that the first tolerance is 0.1 degrees
    found = length_round_land(chart_of(ring), start, goal, known, seconds=30.0)
    assert 0.975 * way < found <= way


@pytest.mark.parametrize("seed", range(12))
def test_outlines_of_several_levels_are_inside_the_land(seed):
    """Inner polygons are so far inside that geodesics between corners do not touch them."""
    random = np.random.default_rng(seed)
    chart, reach = chart_of(ragged_island(random)), Reach((0.0, 2.0), (0.0, 18.0), 6e6)
    outlines = LocalOutlines(ClosedPolygons.within_reach(chart, reach), 0.1)
    for _ in range(3):
        outlines.refine(random.uniform([[-4.0], [6.0]], [[4.0], [14.0]], (2, 2)))
    land = shapely.union_all(outlines.closed.meeting((0.0, -10.0, 20.0, 10.0), 0.0))
    shapes, inner = map(shapely.union_all, outlines.outlines())
    finest = min(outlines.tolerance * FINER**level for level in outlines.levels.values())
    assert land.contains(shapes.buffer(0.5 * finest))
    assert shapes.contains(inner.buffer(0.25 * finest))


def test_a_canal_through_an_island_counts_what_it_is_given():
    chart = Chart.from_geojson(island(1.0, -4.0, 1.5, 4.0))
    start, goal = (0.0, 0.5), (0.0, 2.0)
    canal = BarrierLink((0.0, 0.9), (0.0, 1.6), 100_000.0)  # 78 km from end to end
    through = by(start, canal.one) + canal.seconds + by(canal.other, goal)
    found = length_round_land(chart, start, goal, 1.01 * through, links=[canal], seconds=20.0)
    assert found == pytest.approx(through, rel=1e-6)
    longer = BarrierLink(canal.one, canal.other, 2_000_000.0)  # more than the way round
    round_it = by(start, (4.0, 1.0), (4.0, 1.5), goal)
    found = length_round_land(chart, start, goal, 1.01 * round_it, links=[longer], seconds=20.0)
    assert 0.99 * round_it < found <= round_it


def test_a_passage_quicker_than_the_geodesic_leaves_only_that_of_the_canal():
    chart = Chart.from_geojson(island(1.0, -4.0, 1.5, 4.0))
    quick = BarrierLink((0.0, 0.9), (0.0, 1.6), 1_000.0)
    start, goal = (0.0, 0.5), (0.0, 2.0)
    found = length_round_land(chart, start, goal, 3e5, links=[quick], seconds=20.0)
    way = by(start, quick.one) + quick.seconds + by(quick.other, goal)
    assert found == pytest.approx(way, rel=1e-6)


def test_no_time_or_no_land_leave_the_geodesic():
    start, goal = (0.0, 0.0), (0.0, 2.5)
    chart = Chart.from_geojson(island(1.0, -2.0, 1.5, 0.5))
    direct = by(start, goal)
    assert length_round_land(chart, start, goal, 4e5, seconds=0.0) == pytest.approx(direct)
    open_water = Chart.open_water(-5.0, 5.0, -5.0, 5.0)
    assert length_round_land(open_water, start, goal, 4e5, seconds=5.0) == pytest.approx(direct)


def test_places_inside_land_leave_the_geodesic():
    chart = Chart.from_geojson(island(-3.0, -3.0, 1.5, 3.0))
    start, goal = (0.0, 0.0), (0.0, 2.5)
    found = length_round_land(chart, start, goal, 4e5, seconds=5.0)
    assert found == pytest.approx(by(start, goal))


@pytest.mark.parametrize(
    ("start", "goal"),
    [
        ((52.0, 4.0), (53.5, 0.3)),
        ((-18.0, 178.0), (-14.0, -172.0)),  # across the date line
        ((60.0, -175.0), (60.0, 175.0)),
        ((70.0, 10.0), (70.0, 60.0)),
        ((-34.0, 18.0), (51.0, 3.0)),
        ((10.0, 0.0), (-10.0, 179.0)),  # nearly across the globe
    ],
)
@pytest.mark.parametrize("longer", [1.0005, 1.2, 2.5])
def test_positions_within_reach_are_in_the_box(start, goal, longer):
    """Less land outside leaves a lower bound; land within reach must not be missed."""
    reach = Reach(start, goal, longer * float(distance(*start, *goal)))
    west, south, east, north = reach.box()
    points = np.random.default_rng(1).uniform(size=(2, 40_000))
    lat, lon = np.degrees(np.arcsin(1.6 * points[0] - 0.8)), 360.0 * points[1] - 180.0
    ends = np.array([start, goal])
    lat, lon = np.concatenate([lat, ends[:, 0]]), np.concatenate([lon, ends[:, 1]])
    inside = reach.has(lat, lon) & (np.abs(lat) < 80.0)
    assert inside.any()
    lon = reach.middle + (lon[inside] - reach.middle + 180.0) % 360.0 - 180.0
    assert ((lon >= west) & (lon <= east)).all()
    assert ((lat[inside] >= south) & (lat[inside] <= north)).all()


@pytest.mark.parametrize("seed", range(20))
def test_polygons_inside_are_inside_by_half_a_tolerance(seed):
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0.0, 2.0 * np.pi, 60))
    radius = random.uniform(0.5, 2.0, 60)
    shape = shapely.make_valid(
        shapely.Polygon(np.c_[radius * np.cos(angle), radius * np.sin(angle)])
    )
    tolerance = 0.05
    inside = land_inside([shape], tolerance)
    assert inside
    water = shapely.buffer(shape.boundary, 0.5 * tolerance)
    for one in inside:
        assert shape.contains(one) and not one.intersects(water)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "table", "least"),
    [
        # ports' sea ends; tables of distances (Pub. 151) less the approaches
        ((41.30, 2.20), (37.90, 23.60), 1_110.0, 0.90),  # Barcelona - Piraeus by Messina
        ((52.00, 3.90), (1.20, 103.70), 8_250.0, 0.90),  # Rotterdam - Singapore by Suez
        ((26.90, 50.30), (52.00, 3.90), 11_170.0, 0.90),  # Ras Tanura - Rotterdam round the Cape
        ((-33.90, 18.30), (-34.20, 115.50), 4_660.0, 0.95),  # Cape Town - Cape Leeuwin
    ],
)
def test_real_ways_are_a_few_per_cent_longer(start, goal, table, least):
    chart = Chart.gshhg("i").within(-60.0, 72.0, -180.0, 180.0)
    links = [
        BarrierLink(*canal.ends, canal.length) for canal in chart.canals if start[0] != 26.9
    ]  # a deep tanker passes no canal
    found = length_round_land(chart, start, goal, 1.05 * table * NM, links=links, seconds=15.0)
    assert least * table * NM < found < 1.01 * table * NM
