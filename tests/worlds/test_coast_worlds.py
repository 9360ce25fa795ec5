"""Known paths on the real coastline, and geodesics in open water."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core import geodesy

SHIP = Ship.simple(speed_kn=14.0, draught_m=9.0)
DEPART = "2026-01-01T00:00Z"


def shortest(start, goal, chart):
    voyage = Voyage(offing_nm=0.0, start=start, goal=goal, depart=DEPART, objective="distance")
    return plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart)


@pytest.fixture(scope="module")
def coast():
    return Chart.gshhg("i")


@pytest.mark.slow
def test_floro_to_santander(coast):
    """1234.5 nm through Dover on GSHHG i, by an exact visibility graph (ends snapped 0.3 nm)."""
    found = shortest((61.60, 5.03), (43.47, -3.77), coast)
    best = found.best
    assert best.distance_nm == pytest.approx(1234.5, rel=5e-3)
    assert found.lower_bound <= 1234.5
    dover = geodesy.distance(best.samples["lat"], best.samples["lon"], 51.0, 1.45)
    assert float(np.min(dover)) < 30_000.0
    track = best.track
    assert not coast.legs_blocked(
        track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:]
    ).any()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal"),
    [
        ((50.0, -20.0), (41.0, -60.0)),
        ((-18.5, 176.0), (-16.0, -174.0)),
        ((74.0, 15.0), (79.5, 4.0)),
        ((-50.0, 170.0), (-52.0, -80.0)),
    ],
    ids=["Atlantic", "antimeridian", "Arctic", "South Pacific"],
)
def test_in_open_water_the_shortest_path_is_the_geodesic(start, goal):
    chart = Chart.open_water(-80.0, 84.0, -180.0, 180.0)
    found = shortest(start, goal, chart)
    geodesic = float(geodesy.distance(*start, *goal)) / 1852.0
    assert found.best.distance_nm == pytest.approx(geodesic, rel=1e-6)
    assert found.lower_bound <= geodesic * (1 + 1e-9)


@pytest.mark.slow
def test_the_same_world_shifted_in_longitude_gives_the_same_route():
    """Results are independent of the antimeridian."""
    lengths = []
    for shift in (0.0, 90.0, 178.0):
        square = [[-0.3, 9.7], [0.3, 9.7], [0.3, 10.3], [-0.3, 10.3], [-0.3, 9.7]]
        ring = [[float(geodesy.wrap_longitude(x + shift + 1.0)), y] for x, y in square]
        chart = Chart.from_geojson(land={"type": "Polygon", "coordinates": [ring]})
        west, east = (float(geodesy.wrap_longitude(shift + x)) for x in (0.0, 2.0))
        lengths.append(shortest((10.0, west), (10.0, east), chart).best.distance_nm)
    assert lengths == pytest.approx([lengths[0]] * 3, rel=1e-4)
    assert lengths[0] > float(geodesy.distance(10.0, 0.0, 10.0, 2.0)) / 1852.0 * 1.001
