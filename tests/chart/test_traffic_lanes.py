"""Traffic lanes: what sailing against them costs, who finds it, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance

DEPART = "2026-01-01T00:00Z"
OUTLINE = [[1.5, 50.45], [2.5, 50.45], [2.5, 50.55], [1.5, 50.55], [1.5, 50.45]]


def lane(outline=None, **properties):
    return {
        "type": "Feature",
        "properties": {"kind": "lane", "name": "east lane", "direction_deg": 90, **properties},
        "geometry": {"type": "Polygon", "coordinates": [outline or OUTLINE]},
    }


def collection(*features):
    return {"type": "FeatureCollection", "features": list(features)}


@pytest.fixture(scope="module")
def water():
    return Chart.open_water(49.5, 51.5, 0.0, 4.0)


@pytest.fixture(scope="module")
def ship():
    return Ship.simple(speed_kn=10.0, draught_m=5.0)


def test_only_legs_against_the_lane_cost_more_by_their_share_inside():
    zones = Zones.read(collection(lane(factor=3.0)))
    with_it = zones.factors(50.5, 1.6, 50.5, 2.4)
    assert np.ravel(with_it) == pytest.approx([1.0, 1.0])
    assert float(zones.factors(50.5, 2.4, 50.5, 1.6)[0]) == pytest.approx(3.0, rel=1e-6)
    assert float(zones.factors(50.5, 3.0, 50.5, 2.0)[0]) == pytest.approx(2.0, rel=1e-3)
    assert float(zones.factors(50.3, 2.0, 50.7, 2.0)[0]) == 1.0  # across
    assert float(zones.factors(50.3, 2.02, 50.7, 1.98)[0]) == 1.0  # nearly across
    assert float(zones.factors(51.0, 2.4, 51.0, 1.6)[0]) == 1.0  # beside it


def test_the_tolerance_decides_what_is_against():
    narrow = Zones.read(collection(lane(factor=2.0, tolerance_deg=20)))
    assert float(narrow.factors(50.46, 2.0, 50.54, 2.0)[0]) == pytest.approx(2.0, rel=1e-6)
    assert float(narrow.factors(50.49, 1.6, 50.5, 2.4)[0]) == 1.0


def test_a_lane_across_the_antimeridian():
    outline = [[179.5, 10.0], [180.5, 10.0], [180.5, 10.2], [179.5, 10.2], [179.5, 10.0]]
    zones = Zones.read(collection(lane(outline, factor=2.0)))
    assert float(zones.factors(10.1, -179.6, 10.1, 179.6)[0]) == pytest.approx(2.0, rel=1e-3)
    assert float(zones.factors(10.1, 179.6, 10.1, -179.6)[0]) == 1.0


@pytest.mark.slow
def test_a_plan_goes_round_a_lane_against_it_and_through_it_with_it(water, ship):
    chart = water.with_zones(collection(lane()))
    east = plan(
        Voyage(start=(50.5, 1.2), goal=(50.5, 2.8), depart=DEPART),
        ship=ship,
        sea=Sea.calm(),
        chart=chart,
        resolution=4000.0,
    )
    west = plan(
        Voyage(start=(50.5, 2.8), goal=(50.5, 1.2), depart=DEPART),
        ship=ship,
        sea=Sea.calm(),
        chart=chart,
        resolution=4000.0,
    )
    straight = float(distance(50.5, 1.2, 50.5, 2.8)) / 1852.0
    assert east.best.distance_nm == pytest.approx(straight, rel=1e-3)
    assert west.best.feasible
    # round a corner 3 nm beside the line and 11.4 nm from the ends
    aside = 2.0 * float(distance(50.5, 1.2, 50.55, 1.5)) + float(distance(50.55, 1.5, 50.55, 2.5))
    assert west.best.distance_nm == pytest.approx(aside / 1852.0, rel=3e-3)
    assert west.lower_bound <= west.best.time_h


def test_the_referee_refuses_a_route_against_a_lane(water, ship):
    chart = water.with_zones(collection(lane()))
    track = Track([50.5, 50.5], [2.8, 1.2], DEPART)
    route = evaluate(track, ship=ship, sea=Sea.calm(), chart=chart)
    assert not route.feasible
    assert "against the traffic lane east lane: leg 1" in str(route.violations[0])
    back = Track([50.5, 50.5], [1.2, 2.8], DEPART)
    assert evaluate(back, ship=ship, sea=Sea.calm(), chart=chart).feasible
    dear = water.with_zones(collection(lane(factor=1.5)))
    assert evaluate(track, ship=ship, sea=Sea.calm(), chart=dear).feasible


@pytest.mark.slow
def test_the_routes_of_a_choice_of_speeds_keep_out_of_a_lane(water):
    chart = water.with_zones(collection(lane()))
    voyage = Voyage(start=(50.5, 2.8), goal=(50.5, 1.2), depart=DEPART, objective="fuel")
    ship = Ship.load("handysize-bulker")
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=chart, resolution=10_000.0)
    assert found.best.feasible


@pytest.mark.parametrize(
    ("properties", "key"),
    [
        ({"direction_deg": None}, "direction_deg"),
        ({"direction_deg": 400}, "direction_deg"),
        ({"tolerance_deg": "wide"}, "tolerance_deg"),
        ({"factor": 0.5}, "factor"),
    ],
)
def test_lanes_that_are_none(properties, key):
    with pytest.raises(InputError, match=key):
        Zones.read(collection(lane(**properties)))


def test_lanes_count_in_the_fingerprint(water):
    one, other = (
        water.with_zones(collection(lane(direction_deg=direction))) for direction in (90, 91)
    )
    assert one.fingerprint() != other.fingerprint() != water.fingerprint()


def test_only_pieces_near_a_lane_are_compared_and_none_is_missed():
    """Against all pieces: lanes in high latitude, at the antimeridian, and long legs."""
    rng = np.random.default_rng(5)
    places = [(50.5, 2.0), (78.5, 15.0), (80.0, 20.0), (10.0, 180.0), (-33.0, -72.0)]
    lanes = []
    for y, x in places:
        ring = [[x - 1, y - 0.2], [x + 1, y - 0.2], [x + 1, y + 0.2], [x - 1, y + 0.2]]
        lanes.append(lane([*ring, ring[0]], factor=2.0, direction_deg=float(rng.uniform(0, 360))))
    group = Zones.read(collection(*lanes)).lane_group
    rows, columns = (np.arange(n, dtype=np.int32) for n in group.cells.shape)
    every = replace(group, cells=rows[:, None] * columns)
    at = np.array(places)[rng.integers(0, len(places), 400)]
    spread = np.where(rng.uniform(size=400) < 0.5, 1.5, 20.0)[:, None]
    begin = np.clip(at + spread * rng.normal(size=(400, 2)), -85.0, 85.0)
    end = np.clip(at + spread * rng.normal(size=(400, 2)), -85.0, 85.0)
    legs = (*begin.T, *end.T)
    assert group.excess(*legs) == pytest.approx(every.excess(*legs), abs=1e-12)
    assert np.count_nonzero(every.excess(*legs)) > 25
    there, back = group.excess_both_ways(*legs)
    assert there == pytest.approx(group.excess(*legs), abs=1e-12)
    assert back == pytest.approx(group.excess(*legs[2:], *legs[:2]), abs=1e-9)
