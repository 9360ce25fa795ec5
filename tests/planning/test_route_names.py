"""Labels of routes by the side on which they pass land."""

import numpy as np
import pytest

from tests.reference.test_floro_santander_seuren_2020 import GOAL, SHIP, START, WAYS
from thalweg import Chart, Sea, Ship, evaluate
from thalweg.network import fixed_route
from thalweg.planning.pareto.route_names import land_name, landmasses, route_labels
from thalweg.route import Route

SLOW = Ship.simple(speed_kn=10.0, draught_m=5.0)


def sailed(places, chart, ship=SLOW) -> Route:
    return evaluate(places, ship=ship, sea=Sea.calm(), chart=chart, depart=0, strict=False)


def block(west, south, east, north):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {}, "geometry": geometry}


def islands(*boxes) -> Chart:
    features = [block(*box) for box in boxes]
    return Chart.from_geojson({"type": "FeatureCollection", "features": features})


def labels(chart, *ways, names=None):
    """Return the labels of routes over the Gulf of Guinea, the first of them the network."""
    routes = [sailed(way, chart) for way in ways]
    names = names or ["open sea"] * len(routes)
    return route_labels(
        routes, names, {names[0]: fixed_route(chart, ways[0], spacing=50_000.0)}, chart
    )


WEST, EAST = (0.0, -2.0), (0.0, 2.0)
NORTHERN, SOUTHERN = [WEST, (0.7, 0.0), EAST], [WEST, (-0.7, 0.0), EAST]


def test_routes_on_either_side_of_an_island_get_different_labels():
    chart = islands((-0.3, -0.3, 0.3, 0.3))
    north, south, again = labels(chart, NORTHERN, SOUTHERN, NORTHERN)
    assert north == again == "north of the land at 0.0000N 0.0000E"
    assert south == "south of the land at 0.0000N 0.0000E"


def test_routes_on_the_same_side_keep_their_name():
    chart = islands((-0.3, -0.3, 0.3, 0.3))
    assert labels(chart, NORTHERN, [WEST, (0.9, 0.2), EAST]) == ("open sea", "open sea")
    assert labels(Chart.open_water(), NORTHERN, SOUTHERN) == ("open sea", "open sea")


def test_small_islands_do_not_change_labels():
    chart = islands((-0.01, -0.01, 0.01, 0.01))
    assert labels(chart, NORTHERN, SOUTHERN) == ("open sea", "open sea")


def test_labels_contain_canals_and_compare_routes_through_the_same_canals():
    chart = islands((-0.3, -0.3, 0.3, 0.3))
    names = ["suez", "suez", "open sea"]
    first, second, third = labels(chart, NORTHERN, SOUTHERN, SOUTHERN, names=names)
    assert first == "suez, north of the land at 0.0000N 0.0000E"
    assert second == "suez, south of the land at 0.0000N 0.0000E"
    assert third == "open sea"


def test_every_route_between_two_islands_has_its_own_label():
    chart = islands((-1.0, -0.2, -0.6, 0.2), (0.6, -0.2, 1.0, 0.2))
    ways = [[WEST, (a, -0.8), (0.0, 0.0), (b, 0.8), EAST] for a in (0.5, -0.5) for b in (0.5, -0.5)]
    names = labels(chart, *ways)
    assert len(set(names)) == 4
    assert all(name.count(" of the land at ") == 2 for name in names)


def test_labels_of_the_three_routes_from_floro_to_santander():
    chart = Chart.gshhg("i")
    routes = [sailed([START, *middle, GOAL], chart, SHIP) for middle in WAYS.values()]
    network = fixed_route(chart, [START, *WAYS["R3"], GOAL], spacing=100_000.0)
    names = route_labels(routes, ["open sea"] * 3, {"open sea": network}, chart)
    assert names[0].startswith("east of Great Britain")  # by Dover
    assert names[1] == "west of Great Britain, east of Skye"  # by Kyle Rhea
    assert names[2] == "west of Great Britain, west of Skye"  # by the Minch


@pytest.fixture(scope="module")
def named_land() -> dict[str, list]:
    """Latitudes [deg] of all outlines of the low resolution by the names of their land."""
    rings = Chart.gshhg("l").coastline.rings
    found: dict[str, list] = {}
    for a, b in zip(rings.start[:-1], rings.start[1:]):
        lat, lon = rings.lat[a:b], np.degrees(np.unwrap(np.radians(rings.lon[a:b])))
        found.setdefault(land_name(lat, lon), []).append(lat)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Great Britain", "Ireland", "Iceland", "Viti Levu", "Australia"])
def test_land_is_named(named_land, name):
    (lat,) = named_land[name]
    assert lat.min() < landmasses()[name][0] < lat.max()
