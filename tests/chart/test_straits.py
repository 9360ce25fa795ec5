"""Open and closed passages of the coast of the world."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from thalweg.chart import Chart
from thalweg.chart.offing import closing_line
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import PASSAGES, find_passages
from thalweg.chart.ports import PORTS

HALVES = (
    (np.s_[:-1], np.s_[1:]),
    (np.s_[:, :-1], np.s_[:, 1:]),
    (np.s_[:-1, :-1], np.s_[1:, 1:]),
    (np.s_[1:, :-1], np.s_[:-1, 1:]),
)


def joined(chart, box, a, b, count=300):
    """Return whether a grid of exact legs in a box leads from near a to near b."""
    south, north, west, east = box
    lat, lon = np.meshgrid(
        np.linspace(south, north, count), np.linspace(west, east, count), indexing="ij"
    )
    free = chart.is_navigable(lat, lon)
    number = np.arange(free.size).reshape(free.shape)
    y, x = lat.ravel(), lon.ravel()
    ends = [[], []]
    for one, other in HALVES:
        both = free[one] & free[other]
        p, q = number[one][both], number[other][both]
        clear = ~chart.legs_blocked(y[p], x[p], y[q], x[q])
        ends[0].append(p[clear])
        ends[1].append(q[clear])
    p, q = (np.concatenate(side) for side in ends)
    graph = coo_matrix((np.ones(len(p)), (p, q)), shape=(free.size, free.size))
    labels = connected_components(graph, directed=False)[1]

    def label(place):
        away = np.where(free.ravel(), (y - place[0]) ** 2 + (x - place[1]) ** 2, np.inf)
        return labels[np.argmin(away)]

    return label(a) == label(b)


OPEN = {
    "Dover": ((50.5, 51.5, 0.9, 2.0), (50.6, 1.0), (51.45, 1.9)),
    "Gibraltar": ((35.8, 36.2, -6.0, -5.0), (36.0, -5.95), (36.05, -5.02)),
    "Bosporus": ((40.9, 41.4, 28.8, 29.4), (40.92, 28.95), (41.38, 29.2)),
    "Dardanelles": ((39.9, 40.6, 26.0, 27.0), (39.95, 26.05), (40.55, 26.9)),
    "Oresund": ((55.3, 56.4, 12.2, 13.0), (56.3, 12.3), (55.35, 12.6)),
    "Magellan": ((-54.5, -52.0, -75.0, -68.0), (-52.6, -74.95), (-52.4, -68.2)),
    "Messina": ((37.9, 38.4, 15.3, 15.9), (37.95, 15.45), (38.38, 15.7)),
}
CLOSED = {
    "Suez": ((29.5, 31.8, 32.0, 33.0), (31.7, 32.5), (29.6, 32.5)),
    "Panama": ((8.6, 9.7, -80.2, -79.2), (9.6, -79.9), (8.7, -79.5)),
    "Kiel": ((53.6, 54.8, 8.5, 10.8), (54.0, 8.6), (54.6, 10.5)),
    "Corinth": ((37.7, 38.1, 22.7, 23.3), (37.98, 22.85), (37.85, 23.15)),
}


@pytest.mark.parametrize("name", OPEN)
def test_straits_are_open(world, name):
    assert joined(world, *OPEN[name])


@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("resolution", ["c", "l", "i"])
def test_canals_are_closed(resolution, name):
    assert not joined(Chart.gshhg(resolution), *CLOSED[name])


def test_no_straight_leg_sails_through_suez_or_panama(world):
    # GSHHG alone leaves a gap here: legs along the strips must meet them
    lat = np.linspace(31.3, 29.9, 50)
    lon = np.interp(lat, [29.95, 31.3], [32.56, 32.33])
    assert world.legs_blocked(lat[0], lon[0], lat[-1], lon[-1])
    assert not world.is_navigable(30.6, 32.44)
    assert not world.is_navigable(9.12, -79.73)


def test_rotterdam_is_snapped_to_water_joined_to_the_sea(world):
    port = PORTS.lookup("NLRTM")
    assert not world.is_navigable(port.lat, port.lon)
    lat, lon, away = world.nearest_navigable(port.lat, port.lon)
    assert world.is_navigable(lat, lon)
    assert 1e3 < away < 40e3


def test_a_puddle_is_not_open_sea():
    outer = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]
    puddle = [[0.50, 0.5], [0.52, 0.5], [0.52, 0.52], [0.50, 0.52], [0.50, 0.5]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [outer, puddle]})
    assert chart.is_navigable(0.51, 0.51)
    assert chart.nearest_navigable(0.49, 0.51, largest=30e3) is None
    _, lon, away = chart.nearest_navigable(0.49, 0.02, largest=30e3)
    assert lon < 0.0
    assert 2200.0 < away < 3200.0


def test_none_if_no_navigable_water_is_within_reach(world):
    assert world.nearest_navigable(47.0, 60.0) is None


def test_a_place_near_a_pond_snaps_to_it_if_no_other_water_is_near():
    land = [[-3, -3], [3, -3], [3, 3], [-3, 3], [-3, -3]]
    ponds = [
        [[x, y], [x, y + w], [x + w, y + w], [x + w, y], [x, y]]
        for x, y, w in ((0.1, 0.0, 0.1), (-0.15, 0.0, 0.02))
    ]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [land, *ponds]})
    lat, lon, away = chart.nearest_navigable(0.05, 0.05, largest=30e3)
    assert 0.1 < lon < 0.12 and 0.0 < lat < 0.1  # the larger of the two
    assert away == pytest.approx(5566.0, abs=1000.0)


def test_a_lake_is_no_land_in_drawings():
    land = [[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]
    lake = [[0.5, 0.5], [0.5, 1.5], [1.5, 1.5], [1.5, 0.5], [0.5, 0.5]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [land, lake]})
    drawn = chart.coastline.polygons(-1.0, 3.0, -1.0, 3.0)
    assert sum(polygon.area for polygon in drawn) == pytest.approx(4.0 - 1.0)
    assert sum(p.area for p in chart.coastline.polygons(0.0, 1.0, 0.0, 1.0)) == pytest.approx(0.75)


def test_land_for_drawing_is_cut_to_the_box_and_crosses_the_antimeridian(world):
    polygons = world.coastline.polygons(60.0, 70.0, 170.0, -170.0)
    boxes = np.array([p.bounds for p in polygons])
    assert boxes[:, 0].min() >= 170.0
    assert boxes[:, 2].max() <= 190.0
    assert boxes[:, 2].max() > 185.0
    seam = [lon == 180.0 for _, lon in world.coastline.lines(64.0, 72.0, 175.0, -175.0)]
    assert not any((on[1:] & on[:-1]).any() for on in seam)
    lines = world.coastline.lines(50.0, 52.0, 0.0, 2.0)
    assert lines
    assert all((lat >= 50.0).all() and (lon <= 2.0).all() for lat, lon in lines)


def test_lines_across_passages_end_on_land_and_cross_the_passage():
    """Lines to open sea, beside reefs and shoals that the coastline does not have, are few."""
    coastline = Chart.gshhg("i").coastline
    ends = np.array([passage.closing_line for passage in PASSAGES])
    off_land = coastline.shore_distance(ends[..., 0], ends[..., 1]) > 200.0
    assert off_land.any(axis=1).mean() < 0.15
    for passage in PASSAGES:
        crossed = [p.name for _, p in passages_crossed(coastline, [passage], *passage.positions)]
        assert crossed == [passage.name]


def test_a_line_across_is_found_for_a_passage_without_one():
    coastline = Chart.gshhg("i").coastline
    for name in ("Dover", "Cabot"):
        (passage,) = find_passages([name])
        found = closing_line(coastline, replace(passage, closing_line=()))
        assert np.array(found) == pytest.approx(np.array(passage.closing_line), abs=1e-3)
        assert coastline.shore_distance(*np.array(found).T).max() < 200.0
