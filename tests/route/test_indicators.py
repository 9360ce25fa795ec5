"""Key performance indicators of routes: motions, land, depth."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.route import Track, evaluate
from thalweg.route.indicator_columns import indicator_value
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.ship.comfort.onboard_motions import onboard_motions

PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"
PLACES = [(65.0, 0.0), (65.0, 1.0), (65.5, 1.0)]


def _sea(height=2.0, period=8.0, origin=0.0, **more):
    functions = {
        "sea_surface_wave_significant_height": height, PERIOD: period,
        "sea_surface_wave_from_direction": origin, "eastward_wind": 0.0, "northward_wind": 0.0,
    } | more  # fmt: skip
    return Sea.from_functions({
        name: value if callable(value) else (lambda t, lat, lon, v=value: v)
        for name, value in functions.items()
    })  # fmt: skip


@pytest.fixture(scope="module")
def ship():
    return Ship.load("gunnerus-2019")


def _route(ship, sea, places=PLACES, **options):
    return evaluate(places, ship=ship, sea=sea, depart="2026-01-01T00:00Z",
                    chart=options.pop("chart", Chart.open_water()), **options)  # fmt: skip


def test_dose_of_a_steady_sea_is_that_of_the_formula(ship):
    route = _route(ship, _sea(), PLACES[:2])
    at = route.samples
    found = onboard_motions(ship).at(
        at["speed_through_water"], wave_angle=np.abs(at["heading"]), wave_height=2.0,
        wave_period=8.0,
    ).places["mess"]  # fmt: skip
    duration = route.arrive - route.depart
    expected = float(np.mean(found.weighted**2)) * duration
    assert route.comfort == pytest.approx(expected, rel=1e-3)
    mess = route.indicators["places"]["mess"]
    assert mess["dose_m_s1_5"] == pytest.approx(math.sqrt(expected), rel=1e-3)
    assert mess["sick_percent"] == pytest.approx(math.sqrt(expected) / 3.0, rel=1e-3)
    assert mess["max_acceleration_rms_m_s2"] == pytest.approx(found.acceleration.max(), rel=1e-9)
    hour = math.sqrt(float(np.mean(found.weighted**2)) * 3600.0) / 3.0
    assert mess["worst_hour_percent"] == pytest.approx(hour, rel=1e-2)


def test_squared_dose_adds_up_over_the_legs_to_the_last_digits(ship):
    route = _route(ship, _sea())
    for name in ("mess", "bridge", "laboratory"):
        total = indicator_value(route, "comfort", name)
        parts = [float(x) for x in route.legs[f"squared_dose:{name}"]]
        assert total == pytest.approx(sum(parts), rel=1e-12)
        assert len(parts) == 2 and min(parts) > 0.0
    first = _route(ship, _sea(), PLACES[:2])
    assert first.comfort == pytest.approx(float(route.legs["squared_dose:mess"][0]), rel=1e-9)


@pytest.mark.slow
def test_waiting_counts_head_to_sea_but_not_at_the_berth(ship):
    track = Track.from_positions(PLACES, depart="2026-01-01T00:00Z")
    there = evaluate(track, ship=ship, sea=_sea(), chart=Chart.open_water())
    waits = track.replaced(wait=np.array([0.0, 7200.0, 0.0]))
    at_sea = evaluate(waits, ship=ship, sea=_sea(), chart=Chart.open_water())
    still = onboard_motions(ship).at(0.0, wave_angle=0.0, wave_height=2.0, wave_period=8.0)
    more = 7200.0 * float(still.places["mess"].weighted) ** 2
    assert at_sea.comfort - there.comfort == pytest.approx(more, rel=1e-6)
    berth = track.replaced(wait=np.array([7200.0, 0.0, 0.0]))
    assert evaluate(berth, ship=ship, sea=_sea(), chart=Chart.open_water()).comfort == (
        pytest.approx(there.comfort, rel=1e-9)
    )


def test_unknown_waves_are_null_and_never_calm(ship):
    nowhere = _sea(height=lambda t, lat, lon: np.where(np.asarray(lon) > 0.5, np.nan, 2.0))
    simple = Ship.from_dict({
        "name": "simple", "speeds_kn": 10.0, "places": {"mess": 0.0},
        "hull": {"length_between_perpendiculars_m": 33.9, "breadth_m": 9.6, "draught_m": 2.8,
                 "block_coefficient": 0.62},
    })  # fmt: skip
    route = _route(simple, nowhere)
    assert route.feasible and route.comfort is None
    assert route.indicators["places"]["mess"]["sick_percent"] is None
    assert math.isnan(route.legs["squared_dose:mess"][0])
    calm = Sea.from_functions({"eastward_wind": lambda t, a, b: 0.0,
                               "northward_wind": lambda t, a, b: 0.0})  # fmt: skip
    without = _route(simple, calm)
    assert without.comfort is None
    assert any("Motions on board are not known" in note for note in without.assumptions)
    assert _route(simple, _sea(height=0.0)).comfort == 0.0


def test_a_ship_without_places_has_no_columns():
    route = _route(Ship.simple(speed_kn=10.0), _sea())
    assert route.comfort is None
    assert route.indicators["places"] == {} and "heave" not in route.legs


def test_share_of_the_passage_in_which_a_task_is_possible(ship):
    """Calm for the first half of the leg, rough for the second."""
    sea = _sea(height=lambda t, lat, lon: np.where(np.asarray(lon) < 0.5, 0.1, 4.0))
    route = _route(ship, sea, PLACES[:2])
    easy = indicator_value(route, "workable_percent", "laboratory work")
    half = np.interp(0.5, route.samples["lon"], route.samples["time"]) - route.depart
    assert easy == pytest.approx(100.0 * half / (route.arrive - route.depart), abs=0.5)
    assert route.indicators["tasks"]["laboratory work"]["workable_percent"] == easy
    uncomfortable = indicator_value(route, "uncomfortable_percent", "mess")
    assert uncomfortable == pytest.approx(100.0 - easy, abs=1.0)


def test_length_inshore_and_least_distance_from_land(ship):
    """A square island north of the track; 3 nautical miles are inshore."""
    island = {"type": "Polygon", "coordinates": [
        [[0.4, 65.02], [0.6, 65.02], [0.6, 65.2], [0.4, 65.2], [0.4, 65.02]]
    ]}  # fmt: skip
    route = _route(ship, _sea(), [(65.0, 0.0), (65.0, 1.0)], chart=Chart.from_geojson(island))
    found = route.indicators
    assert found["land_distance_nm"] == pytest.approx(
        1.15, abs=0.02
    )  # the geodesic runs north of the parallel
    across = 2.0 * math.sqrt(3.0**2 - 1.2**2) + 0.2 * 60.0 * math.cos(math.radians(65.0))
    assert found["inshore_nm"] == pytest.approx(across, abs=0.5)
    assert found["inshore_percent"] == pytest.approx(
        100.0 * found["inshore_nm"] / route.distance_nm, rel=1e-9
    )
    assert found["inshore_h"] == pytest.approx(
        route.time_h * found["inshore_percent"] / 100.0, rel=0.02
    )
    assert found["shallow_h"] is None  # no depth in the data
    assert _route(ship, _sea()).indicators["land_distance_nm"] == 12.0  # or more


def test_canals_and_approaches_do_not_count_for_the_least_distance_from_land():
    """Kinds of legs: 0 at sea, 1 canal, 2 approach."""
    legs = {"land_distance": np.array([0.0, 3.0, 5.0, 0.1]) * 1852.0}
    kinds = np.array([2.0, 0.0, 0.0, 1.0])
    route = SimpleNamespace(legs={**legs, "leg_kind": kinds})
    assert indicator_value(route, "land_distance_nm") == pytest.approx(3.0)
    river = SimpleNamespace(legs={**legs, "leg_kind": np.full(4, 2.0)})
    assert indicator_value(river, "land_distance_nm") == 0.0


def test_time_in_water_less_than_twice_as_deep_as_the_draught(ship):
    chart = Chart.open_water().with_depth(
        lambda lat, lon: np.where(np.asarray(lon) < 0.5, 4.0, 50.0)
    )
    route = _route(ship, _sea(), PLACES[:2], chart=chart)
    assert route.indicators["shallow_h"] == pytest.approx(0.5 * route.time_h, rel=0.02)


def test_grounding_margin_from_land_and_from_the_safety_contour(ship):
    """A bank of 3 m between two meridians south of the track; the ship draws 2.8 m."""
    bank = {"south": 64.95, "north": 64.98}

    def depth(lat, lon):
        inside = (np.asarray(lat) > bank["south"]) & (np.asarray(lat) < bank["north"])
        return np.where(inside & (np.asarray(lon) > 0.4) & (np.asarray(lon) < 0.6), 3.0, 50.0)

    chart = Chart.open_water().with_depth(depth, spacing_deg=1 / 600)
    open_bank = _route(ship, _sea(), PLACES[:2], chart=chart, min_ukc=0.0).indicators
    assert open_bank["contour_distance_nm"] == 5.0  # 3 m are enough: 5 or more
    assert open_bank["near_ground_h"] == 0.0
    route = _route(ship, _sea(), PLACES[:2], chart=chart, min_ukc=0.5)
    found = route.indicators
    at = route.samples
    nearest = 60.0 * np.min(at["lat"][(at["lon"] > 0.4) & (at["lon"] < 0.6)] - bank["north"])
    assert found["contour_distance_nm"] == pytest.approx(nearest, abs=0.13)
    assert nearest > 0.0 and found["land_distance_nm"] == 12.0
    chart = Chart.open_water().with_depth(depth, spacing_deg=1 / 600).within(60, 70, -5, 5)
    close = _route(ship, _sea(), [(64.985, 0.0), (64.985, 1.0)], chart=chart, min_ukc=0.5)
    across = 0.2 * 60.0 * math.cos(math.radians(65.0)) + 2.0 * math.sqrt(1.0 - 0.4**2)
    share = close.indicators["near_ground_h"] / close.time_h
    assert share * close.distance_nm == pytest.approx(across, abs=0.6)


def test_indicators_are_columns_of_the_table_of_waypoints(ship):
    route = _route(ship, _sea())
    table = route.to_frame()
    for name in ("heave_m", "pitch_deg", "squared_dose_m2_s3:mess", "velocity_m_s:bridge",
                 "weighted_acceleration_m_s2:mess", "workable_h:laboratory work",
                 "inshore_nm", "land_distance_nm", "near_ground_h"):  # fmt: skip
        assert np.isfinite(table[name][:-1]).all() and np.isnan(table[name].iloc[-1]), name
    dose = table["squared_dose_m2_s3:mess"][:-1].sum()
    assert dose == pytest.approx(route.comfort, rel=1e-12)
    assert route.indicators["fuel_t_per_nm"] == pytest.approx(route.fuel_t / route.distance_nm)
