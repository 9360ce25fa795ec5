"""Routes along time for the page: motion on board, where the ship file names places."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Track, evaluate

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')


def profile_in_waves(ship: str):
    from thalweg.service.jobs.route_profiles import route_profile

    waves = {
        "sea_surface_wave_significant_height": 2.0,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": 8.0,
        "sea_surface_wave_from_direction": 0.0,
        "eastward_wind": 0.0,
        "northward_wind": 0.0,
    }
    sea = Sea.from_functions(
        {name: lambda t, lat, lon, v=value: v + 0.0 * lat for name, value in waves.items()}
    )
    chart = Chart.open_water(63.0, 65.0, 5.0, 8.0)
    ends = [(63.5, 6.0), (64.5, 6.0)]
    route = evaluate(ends, ship=Ship.load(ship), sea=sea, chart=chart, depart=0)
    return route, route_profile(route)


def test_a_ship_with_places_has_the_motion_along_the_route():
    route, profile = profile_in_waves("gunnerus-2019")
    motion = np.array(profile["weighted_acceleration_m_s2"])
    assert len(motion) == len(profile["time"]) and (motion > 0.05).all()
    assert route.indicators["places"]["mess"]["sick_percent"] > 0.0


def test_motion_is_unknown_where_the_waves_are():
    from thalweg.service.jobs.route_profiles import route_profile

    route, _ = profile_in_waves("gunnerus-2019")
    name = "sea_surface_wave_significant_height"
    waves = np.array(route.samples[name], float)
    waves[:3] = np.nan
    profile = route_profile(replace(route, samples={**route.samples, name: waves}))
    assert profile["weighted_acceleration_m_s2"][:4].count(None) == 3


def test_a_wind_of_no_speed_has_no_direction():
    from thalweg.service.jobs.route_profiles import route_profile

    route, _ = profile_in_waves("gunnerus-2019")
    east = np.array(route.samples["eastward_wind"], float)
    east[-2:] = 5.0  # to the east: from the west
    profile = route_profile(replace(route, samples={**route.samples, "eastward_wind": east}))
    assert profile["wind_from_deg"][-2:] == [270.0, 270.0]
    assert set(profile["wind_from_deg"][:-2]) == {None}
    assert set(profile["waves_from_deg"]) == {0.0}
    assert "NaN" not in json.dumps(profile)


def test_a_ship_that_waits_lies_still_in_the_profile():
    from thalweg.service.jobs.route_profiles import route_profile

    track = Track([63.5, 64.0, 64.5], [6.0, 6.0, 6.0], depart=0.0, wait=[0.0, 7200.0, 0.0])
    chart = Chart.open_water(63.0, 65.0, 5.0, 8.0)
    ship = Ship.load("handysize-bulker")
    route = evaluate(track, ship=ship, sea=Sea.calm(), chart=chart)
    profile = route_profile(route)
    time, speed = np.array(profile["time"]), np.array(profile["speed_over_ground_kn"])
    assert (np.diff(time) >= 0.0).all()
    begin, end = float(route.legs["arrive"][0]), float(route.legs["depart"][1])
    assert end - begin == pytest.approx(7200.0)
    waits = (time >= begin - 0.1) & (time <= end + 0.1) & (speed == 0.0)
    assert time[waits][[0, -1]].tolist() == pytest.approx([begin, end], abs=0.1)
    assert np.diff(time[waits]).max() <= 900.0
    assert (speed[~waits] > 5.0).all()
    assert np.array(profile["lat"])[waits].tolist() == [64.0] * int(waits.sum())
    burnt = np.array(profile["fuel_t_per_day"])
    rate = float(route.legs["waiting_fuel"][1]) / 7200.0 * 86.4
    assert burnt[waits] == pytest.approx(rate, abs=0.006) and burnt[~waits].min() > rate


def test_a_ship_without_places_has_none():
    assert "weighted_acceleration_m_s2" not in profile_in_waves("handysize-bulker")[1]


@pytest.mark.parametrize("ship", ["gunnerus-2019", "handysize-bulker"])
def test_a_request_may_limit_motion_sickness(ship):
    from thalweg.service.jobs.plan_request import PlanRequest
    from thalweg.service.jobs.request_objects import open_ship_of

    given = {"voyage": {"start": "Halifax", "goal": "Brest"}, "ship": ship, "seas": ["storm"]}
    assert open_ship_of(PlanRequest(**given), {}).file.limits.max_motion_sickness_percent is None
    given["limits"] = {"motion_sickness_percent": 10.0}
    limited = open_ship_of(PlanRequest(**given), {})
    assert limited.file.limits.max_motion_sickness_percent == 10.0
    assert limited.limits.safety is not None
    assert limited.limits.wave_height == Ship.load(ship).limits.wave_height
