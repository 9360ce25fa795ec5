"""Samples of waits: the ship lies still while tide and waves change at her place."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Track, evaluate
from thalweg.planning.plots.route_profile import draw_profile
from thalweg.route import join

BED, LEVEL = "sea_floor_depth_below_geoid", "sea_surface_height_above_geopotential_datum"
WAVES = "sea_surface_wave_significant_height"
DRAUGHT, WAIT, M2 = 6.0, 7.0 * 3600.0, 44_714.0
SHIP = Ship.simple(speed_kn=10.0, draught_m=DRAUGHT, max_wave_height_m=9.0)


def level(time, lat, lon):
    return 2.0 * np.cos(2.0 * np.pi * time / M2) + 0.0 * lat


def waves(time, lat, lon):
    return np.where((lon > 0.15) & (lon < 0.25), 6.0, 1.0) + 0.0 * time


SEA = Sea.from_functions(
    {BED: lambda time, lat, lon: 12.0 + 0.0 * lat, LEVEL: level, WAVES: waves}, period=(0.0, 2e5)
)


def sailed(wait, **more):
    track = Track([0.0] * 3, [0.0, 0.2, 0.4], depart=0.0, wait=wait)
    return evaluate(track, ship=SHIP, sea=SEA, chart=Chart.open_water(-1.0, 1.0, -1.0, 1.0), **more)


@pytest.fixture(scope="module")
def route():
    return sailed([1800.0, WAIT, 0.0], min_ukc=1.5)


def test_samples_with_waits_follow_the_tide_at_the_place_of_the_wait(route):
    table = route.sample_frame()
    time = table["time"].to_numpy()
    assert (np.diff(time) >= 0.0).all() and time[0] == 0.0
    begin, end = route.legs["arrive"][0], route.legs["depart"][1]
    lying = table[(table["leg"] == 1) & (time <= end) & (table["speed_over_ground"] == 0.0)]
    assert lying["time"].iloc[[0, -1]].tolist() == pytest.approx([begin, end])
    assert np.diff(lying["time"]).max() <= 300.0
    expected = 12.0 + level(lying["time"].to_numpy(), 0.0, 0.0) - DRAUGHT
    assert lying["under_keel_clearance"].to_numpy() == pytest.approx(expected)
    assert lying["under_keel_clearance"].min() < 4.05 < lying["under_keel_clearance"].iloc[0]
    assert (lying["lon"] == 0.2).all() and (lying[WAVES] == 6.0).all()
    at_berth = table[(table["leg"] == 0) & (table["speed_over_ground"] == 0.0)]
    assert at_berth["time"].max() == pytest.approx(1800.0)
    assert (route.samples["speed_over_ground"] > 0.0).all()


def test_a_route_without_waits_has_its_samples_alone():
    route = sailed([0.0, 0.0, 0.0])
    assert len(route.sample_frame()) == len(route.samples["time"])


def test_joined_routes_keep_the_samples_of_their_waits(route):
    chart = Chart.open_water(-1.0, 1.0, -1.0, 1.0)
    ahead = Track([0.0, 0.0], [0.4, 0.5], depart=route.arrive)
    whole = join([route, evaluate(ahead, ship=SHIP, sea=SEA, chart=chart)])
    assert len(whole.wait_samples["time"]) == len(route.wait_samples["time"])
    assert (np.diff(whole.sample_frame()["time"]) >= 0.0).all()


def test_the_profile_shows_waits_and_the_required_clearance(route):
    speeds, heights, depths = draw_profile(route, min_ukc=1.5).axes
    hours, speed = speeds.lines[1].get_data()
    middle = (route.legs["arrive"][0] + 0.5 * WAIT) / 3600.0
    assert np.interp(middle, hours, speed) == 0.0
    assert np.interp(middle, *heights.lines[0].get_data()) == 6.0
    clearance = np.interp(middle, *depths.lines[0].get_data())
    assert clearance == pytest.approx(6.0 + level(3600.0 * middle, 0.0, 0.0), abs=0.01)
    assert list(depths.lines[1].get_ydata()) == [1.5, 1.5]


def test_a_wait_with_too_little_water_and_one_without_depth_break_a_limit():
    """The tide falls from 14 to 10 m, 4 m under the keel, while the ship lies at 0.2E."""
    route = sailed([0.0, WAIT, 0.0], min_ukc=4.5, strict=False)
    (low,) = (one for one in route.violations if one.reason == "under-keel clearance (waiting)")
    lying = route.wait_samples["under_keel_clearance"]
    assert low.value == pytest.approx(lying.min()) and low.limit == 4.5
    assert low.time == route.wait_samples["time"][np.argmin(lying)]
    assert (low.lat, low.lon) == (0.0, 0.2)

    def bed(time, lat, lon):
        return np.where((np.abs(lon - 0.2) < 1e-6) & (time > 4.0 * 3600.0), np.nan, 30.0)

    sea = Sea.from_functions({BED: bed, WAVES: waves}, period=(0.0, 2e5))
    track = Track([0.0] * 3, [0.0, 0.2, 0.4], depart=0.0, wait=[0.0, WAIT, 0.0])
    chart = Chart.open_water(-1.0, 1.0, -1.0, 1.0)
    unknown = evaluate(track, ship=SHIP, sea=sea, chart=chart, min_ukc=1.0, strict=False)
    reasons = [one.reason for one in unknown.violations]
    assert "no data: depth (waiting)" in reasons
    assert np.isnan(unknown.wait_samples["depth"]).any()
