"""Bad input is refused with a clear message."""

import dataclasses
import inspect
import pickle
import re

import numpy as np
import pandas as pd
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import (
    CoverageError,
    InputError,
    MissingVariableError,
    NoRouteError,
    OutsideAreaError,
    OutsidePeriodError,
    ThalwegError,
)
from thalweg.planning.request.voyage_endpoints import resolve_endpoint, resolve_places
from thalweg.planning.sea_distance import sea_distance
from thalweg.ship import ShipLimits

DEPART = "2026-01-01T00:00Z"
SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)
WATER = Chart.open_water(50.0, 51.0, 1.0, 3.0)
SQUARE = {
    "type": "Polygon",
    "coordinates": [[[1.8, 50.3], [2.2, 50.3], [2.2, 50.7], [1.8, 50.7], [1.8, 50.3]]],
}


def ask(start=(50.5, 1.2), goal=(50.5, 2.8), *, sea=None, ship=SHIP, chart=WATER, **request):
    request.setdefault("depart", DEPART)
    voyage = Voyage(start=start, goal=goal, **request)
    return plan(voyage, ship=ship, sea=sea or Sea.calm(), chart=chart)


def current(east):
    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": east,
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        }
    )


def ring(outer, inner):
    """A square of land with a square of water in it."""

    def corners(half):
        c = [(-half, -half), (half, -half), (half, half), (-half, half), (-half, -half)]
        return [[2.0 + x, 50.5 + y] for x, y in c]

    return {"type": "Polygon", "coordinates": [corners(outer), corners(inner)[::-1]]}


def test_unknown_port_gets_near_matches():
    with pytest.raises(InputError, match="Rotterdam"):
        ask(start="Roterdam")


def test_start_on_land_names_the_nearest_water():
    chart = Chart.from_geojson(land=SQUARE)
    with pytest.raises(InputError, match=r"nearest navigable water is .* nm away") as caught:
        ask(start=(50.5, 2.0), chart=chart)
    assert "land" in str(caught.value)


@pytest.mark.slow
def test_enclosed_goal_is_no_route():
    chart = Chart.from_geojson(land=ring(0.2, 0.1))
    with pytest.raises(NoRouteError) as caught:
        ask(goal=(50.5, 2.0), chart=chart, offing_nm=0.0)
    assert caught.value.reasons["land"] > 0
    assert caught.value.nearest is not None


def test_departure_outside_the_data():
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        },
        period=("2026-02-01T00:00Z", "2026-02-03T00:00Z"),
    )
    with pytest.raises(OutsidePeriodError, match=r"2026-02-01T00:00:00Z to 2026-02-03T00:00:00Z"):
        ask(sea=sea)


def test_missing_variable_is_named():
    with pytest.raises(MissingVariableError, match=r"does not have: .*wind"):
        ask(ship=Ship.load("handysize-bulker"), sea=current(lambda t, lat, lon: 0.0 * lat))


@pytest.mark.slow
def test_a_data_gap_across_the_area_is_reported_as_no_route():
    sea = current(lambda t, lat, lon: np.where(np.abs(lon - 2.0) < 0.2, np.nan, 0.0))
    with pytest.raises(NoRouteError) as caught:
        ask(sea=sea)
    assert caught.value.reasons["no data"] > 0
    assert "gap" in caught.value.remedy


@pytest.mark.slow
def test_a_gap_is_sailed_round_never_through():
    sea = current(lambda t, lat, lon: np.where((np.abs(lon - 2) < 0.2) & (lat < 50.7), np.nan, 0.0))
    best = ask(sea=sea).best
    inside = np.abs(best.samples["lon"] - 2.0) < 0.199
    assert inside.any()
    assert best.samples["lat"][inside].min() > 50.699


@pytest.mark.slow
def test_a_requested_fill_value_closes_the_gap_and_is_reported():
    sea = current(lambda t, lat, lon: np.where(np.abs(lon - 2.0) < 0.2, np.nan, 0.0))
    found = ask(sea=sea.filled(currents=0.0))
    assert any("currents" in note for note in found.notes)


def test_draught_deeper_than_any_water():
    with pytest.raises(NoRouteError) as caught:
        ask(chart=WATER.with_depth(lambda lat, lon: 4.0 + 0.0 * lat))
    assert caught.value.reasons["under-keel clearance"] > 0
    assert "clearance" in caught.value.remedy


def test_clearance_without_any_depth():
    with pytest.raises(MissingVariableError, match="depth"):
        ask(min_ukc_m=1.0)


@pytest.mark.slow
def test_a_ship_that_feels_the_bottom_needs_a_bottom():
    ship = Ship.load("vox-olympia").with_limits(ShipLimits())
    with pytest.raises(MissingVariableError, match="depends on the water depth"):
        ask(ship=ship)
    deep = ask(ship=ship, chart=WATER.with_depth(lambda lat, lon: 60.0 + 0.0 * lat)).best
    shallow = ask(ship=ship, chart=WATER.with_depth(lambda lat, lon: 14.0 + 0.0 * lat)).best
    assert shallow.time_h > deep.time_h * 1.005


def test_depth_that_does_not_overlap():
    def elsewhere(lat, lon):
        return np.where(lat > 60.0, 100.0, np.nan)

    with pytest.raises(ThalwegError) as caught:
        ask(chart=WATER.with_depth(elsewhere))
    assert isinstance(caught.value, (CoverageError, NoRouteError))
    assert "data" in str(caught.value) or "depth" in str(caught.value)


@pytest.mark.parametrize("speed", [0.0, -3.0, float("nan"), float("inf")])
def test_speeds_that_cannot_be(speed):
    with pytest.raises(InputError):
        Ship.simple(speed_kn=speed, draught_m=5.0)
    with pytest.raises(InputError):
        Voyage(start=(50, 1), goal=(51, 2), depart=DEPART, speed_kn=speed)


def test_a_speed_the_ship_does_not_have():
    with pytest.raises(InputError, match=r"10\.0"):
        ask(speed_kn=14.0)


@pytest.mark.slow
def test_a_speed_between_the_settings_is_sailed_by_the_law_of_the_ship():
    """Seuren's bulk carrier has no 12 kn: one engine ends at 10.8, two begin at 14.1 kn."""
    ship = Ship.load("handysize-bulker")
    water = Chart.open_water(54.0, 56.0, 3.0, 6.0)
    voyage = Voyage(start=(55, 4), goal=(55, 5), depart=DEPART, speed_kn=12.0)
    best = plan(voyage, ship=ship, sea=Sea.calm(), chart=water).best
    assert best.time_h == pytest.approx(best.distance_nm / 12.0, rel=1e-6)
    fuel = np.interp(12.0, [10.8, 14.1], [20.1, 28.9]) / 24.0  # t/h
    assert best.fuel_t == pytest.approx(fuel * best.time_h, rel=1e-6)
    assert best.engine_order == "constant power"


def test_a_place_on_land_near_water_names_the_water_and_the_nearest_port():
    with pytest.raises(InputError, match="nearest port is Durban, ZA, 12") as caught:
        resolve_endpoint((-29.8, 30.8), Chart.gshhg("i"), "start")
    assert "open sea at 29.8" in str(caught.value)
    assert "swapped" not in str(caught.value)


def test_swapped_latitude_and_longitude():
    with pytest.raises(InputError, match="swapped"):
        Voyage(start=(151.2, -33.9), goal=(50, 1), depart=DEPART)


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        ((9.0, 42.0), "42, 9 is 42.0000N 9.0000E, near the other places. Are latitude and"),
        ((-74.0, 40.6), "40.6, -74 is near Stapleton SI, US. Are latitude and longitude swapped"),
        ((30.0, 60.0), "Are latitude and longitude swapped"),
    ],
)
def test_a_place_on_land_says_where_its_swapped_degrees_are(goal, words):
    with pytest.raises(InputError, match=words):
        resolve_places((43.0, 8.5), [], goal, Chart.gshhg("i"))


def test_a_place_outside_the_data_says_that_its_swapped_degrees_are_inside():
    water = Chart.open_water()
    wind = {"eastward_wind": lambda t, lat, lon: np.where(np.asarray(lat) > 50.0, 1.0, np.nan),
            "northward_wind": lambda t, lat, lon: 0.0}  # fmt: skip
    sea = Sea.from_functions(wind, time_step=3600.0).filled(waves=0.0)
    voyage = Voyage(start=(55.0, 4.0), goal=(5.0, 55.0), depart=DEPART)
    with pytest.raises(OutsideAreaError, match=r"55, 5 is .*, inside the data\. Are lat"):
        plan(voyage, ship=Ship.load("handysize-bulker"), sea=sea, chart=water)


@pytest.mark.parametrize("place", [(float("nan"), 1.0), (50.0,), "", None, (1, 2, 3)])
def test_places_that_are_none(place):
    with pytest.raises(InputError):
        Voyage(start=place, goal=(50, 1), depart=DEPART)


def test_same_place():
    with pytest.raises(InputError, match="same place"):
        ask(goal=(50.5, 1.2))


def test_no_departure_or_two():
    with pytest.raises(InputError, match="departure"):
        Voyage(start=(50, 1), goal=(51, 2))
    with pytest.raises(InputError, match="departure"):
        Voyage(start=(50, 1), goal=(51, 2), depart=DEPART, depart_window=(DEPART, DEPART))


def test_a_window_that_ends_before_it_begins_is_refused():
    with pytest.raises(InputError, match="before"):
        Voyage(start=(50, 1), goal=(51, 2), depart_window=("2026-01-02", "2026-01-01"))


def test_arrive_by_too_early():
    with pytest.raises(NoRouteError) as caught:
        ask(arrive_by="2026-01-01T00:30Z")
    assert caught.value.reasons
    with pytest.raises(InputError, match="not after"):
        ask(arrive_by="2025-12-31T00:00Z")


def test_unknown_objective_has_near_matches():
    with pytest.raises(InputError, match="time"):
        Voyage(start=(50, 1), goal=(51, 2), depart=DEPART, objective="tiem")


@pytest.mark.slow
def test_output_folder_that_cannot_be(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match="cannot be written"):
        ask().write(tmp_path / "file" / "out")


def test_network_unknown_or_absent():
    voyage = Voyage(start=(50.5, 1.2), goal=(50.5, 2.8), depart=DEPART)
    with pytest.raises(InputError, match="lattice"):
        plan(voyage, ship=SHIP, sea=Sea.calm(), chart=WATER, network="latice")
    with pytest.raises(InputError, match="no mesh"):
        plan(voyage, ship=SHIP, sea=Sea.calm(), chart=WATER, network="mesh")


@pytest.mark.slow
def test_wind_speed_without_direction_suffices_for_ships_that_use_only_speed():
    sea = Sea.from_functions({"wind_speed": lambda t, lat, lon: 10.0 + 0.0 * lat})
    ship = Ship.from_speed_function(lambda c: 6.0 - 0.1 * c.wind_speed, draught_m=5.0)
    best = ask(ship=ship, sea=sea).best
    assert best.distance_nm * 1852.0 / (best.time_h * 3600.0) == pytest.approx(5.0, rel=1e-3)
    angled = Ship.from_speed_function(
        lambda c: 6.0 - 0.1 * c.wind_speed * np.cos(c.wind_angle), draught_m=5.0
    )
    with pytest.raises(MissingVariableError, match=r"does not have: .*wind"):
        ask(ship=angled, sea=sea)


@pytest.mark.slow
def test_the_clearance_of_the_voyage_overrides_that_of_the_ship_file():
    ship = Ship.load("hopper-dredger").with_load_factor(1.0)  # 6.5 m, and 1 m of clearance
    shallow = WATER.with_depth(lambda lat, lon: 7.0 + 0.0 * lat)
    with pytest.raises(NoRouteError) as caught:
        ask(ship=ship, chart=shallow)
    assert caught.value.reasons["under-keel clearance"] > 0
    assert ask(ship=ship, chart=shallow, min_ukc_m=0.2).best.min_ukc_m == pytest.approx(0.5)


@pytest.mark.slow
def test_data_that_end_on_a_way_round_land_are_the_reason_given():
    still = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    sea = Sea.from_functions(
        {name: lambda t, lat, lon: 0.0 * t for name in still},
        period=("2026-01-01T00:00Z", "2026-01-02T00:00Z"),
    )
    venice, genoa = (45.2, 12.9), (44.2, 9.0)  # 170 nm apart, 1,085 by sea
    voyage = Voyage(start=venice, goal=genoa, depart="2026-01-01T00:00Z")
    with pytest.raises(NoRouteError, match="arrives before the data end at 2026-01-02") as caught:
        plan(voyage, ship=Ship.simple(speed_kn=12.0), sea=sea, chart=Chart.gshhg("l"))
    lat, _ = caught.value.nearest
    assert lat < 42.5  # a day down the Adriatic, and not off Venice
    left = float(re.search(r"([\d.]+) nm short", str(caught.value))[1])
    assert left == pytest.approx(1_085.0 - 24.0 * 12.0, abs=20.0)


def test_an_unknown_entry_of_a_voyage_has_near_matches():
    """It was a bare TypeError."""
    with pytest.raises(InputError, match="Did you mean 'objective'") as caught:
        Voyage(start=(50.0, 0.0), goal=(51.0, 0.0), depart=0.0, objectiv="fuel")
    assert caught.value.details["field"] == "objectiv"
    voyage = Voyage(start=(50.0, 0.0), goal=(51.0, 0.0), depart=0.0)
    assert dataclasses.replace(voyage, speed_kn=9.0).speed_kn == 9.0
    assert pickle.loads(pickle.dumps(voyage)) == voyage
    assert "objective" in inspect.signature(Voyage).parameters


@pytest.mark.parametrize("place", [None, (1.0, 2.0, 3.0), 7, ""])
def test_distances_refuse_what_is_no_place(place):
    with pytest.raises(InputError, match=r"The start.* is (not a place|empty)"):
        sea_distance(place, "Rotterdam")


@pytest.mark.slow
def test_one_via_point_of_a_distance_needs_no_list():
    one = sea_distance("Hull", "Rotterdam", via="Dover")
    assert one.nm == sea_distance("Hull", "Rotterdam", via=["Dover"]).nm


def test_distances_refuse_the_name_of_a_ship():
    with pytest.raises(InputError, match="which is not a Ship"):
        sea_distance("Hamburg", "Rotterdam", ship="handysize-bulker")


@pytest.mark.parametrize("missing", [pd.NaT, np.datetime64("NaT")])
def test_missing_times_are_refused(missing):
    with pytest.raises(InputError, match="A time is missing"):
        Voyage(start=(0.0, 0.0), goal=(1.0, 0.0), depart=missing)
