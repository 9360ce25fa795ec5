"""Which limits a route comes near to, and when."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, evaluate
from thalweg.ship.ship_limits import ShipLimits

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')

HEIGHT = "sea_surface_wave_significant_height"


def _sea(height):
    """Return a sea whose waves [m] depend on the latitude, with a wind of 8 m/s."""
    values = {
        HEIGHT: height,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": lambda lat: 8.0 + 0.0 * lat,
        "sea_surface_wave_from_direction": lambda lat: 0.0 * lat,
        "eastward_wind": lambda lat: 8.0 + 0.0 * lat,
        "northward_wind": lambda lat: 0.0 * lat,
    }
    return Sea.from_functions(
        {name: lambda t, lat, lon, f=f: f(lat) + 0.0 * t for name, f in values.items()}
    )


def _met(route, ship, chart=None, min_ukc=0.0):
    from thalweg.service.jobs.limits_met import limits_met

    return {one["name"]: one for one in limits_met(route, ship=ship, chart=chart, min_ukc=min_ukc)}


def test_waves_are_near_their_limit_where_they_are_within_five_per_cent_of_it():
    ship = Ship.load("handysize-bulker").with_limits(ShipLimits(wave_height=3.0))
    sea = _sea(lambda lat: 2.0 + np.clip((lat - 64.0) / 0.1, 0.0, 0.9))  # 2.9 m north of 64.09 N
    chart = Chart.open_water(63.0, 65.0, 5.0, 8.0)
    route = evaluate([(63.5, 6.0), (64.5, 6.0)], ship=ship, sea=sea, chart=chart, depart=0)
    met = _met(route, ship)
    waves = met["wave_height_m"]
    assert waves["limit"] == 3.0
    assert waves["worst"] == pytest.approx(2.9, abs=0.01)
    ((begin, end),) = waves["near"]
    assert end == pytest.approx(route.arrive, abs=1.0)
    lat = np.interp(begin, route.samples["time"], route.samples["lat"])
    assert lat == pytest.approx(64.085, abs=0.05)  # where waves reach 2.85 m
    assert waves["near_h"] == pytest.approx((end - begin) / 3600.0, abs=0.01)
    assert "wind_speed_kn" not in met  # the ship has no limit of it
    assert "under_keel_clearance_m" not in met  # no depth is known


def test_the_highest_speed_is_met_only_where_it_is_ordered():
    ship = Ship.load("handysize-bulker")
    sea = _sea(lambda lat: 1.0 + 0.0 * lat)
    chart = Chart.open_water(63.0, 65.0, 5.0, 8.0)
    ends = [(63.5, 6.0), (64.5, 6.0)]
    full = evaluate(ends, ship=ship, sea=sea, chart=chart, depart=0)
    slow = evaluate(ends, ship=ship, sea=sea, chart=chart, depart=0, speed_kn=10.3)
    speed = _met(full, ship)["ordered_speed_kn"]
    assert speed["limit"] == speed["worst"] == pytest.approx(15.2)
    assert speed["near_h"] == pytest.approx(full.time_h, abs=0.02)
    speed = _met(slow, ship)["ordered_speed_kn"]
    assert speed["worst"] == pytest.approx(10.3) and speed["near"] == []


def test_the_clearance_is_near_its_limit_within_a_decimetre():
    ship = Ship.load("handysize-bulker")  # draught 9.5 m
    depth = lambda t, lat, lon: np.where(lat > 64.0, 10.58, 14.0) + 0.0 * t  # noqa: E731
    sea = Sea.from_functions({"sea_floor_depth_below_sea_surface": depth}) + _sea(
        lambda lat: 1.0 + 0.0 * lat
    )
    chart = Chart.open_water(63.0, 65.0, 5.0, 8.0)
    route = evaluate([(63.5, 6.0), (64.5, 6.0)], ship=ship, sea=sea, chart=chart, depart=0)
    clearance = _met(route, ship, min_ukc=1.0)["under_keel_clearance_m"]
    assert clearance["worst"] == pytest.approx(1.08, abs=0.01) and clearance["limit"] == 1.0
    assert len(clearance["near"]) == 1
    assert _met(route, ship, min_ukc=0.5)["under_keel_clearance_m"]["near"] == []


def test_the_distance_from_land_counts_where_an_offing_is_kept():
    ship = Ship.load("handysize-bulker")
    chart = Chart.gshhg("c")
    track = [(49.88, -6.0), (49.88, -4.0)]  # south of the Lizard
    sea = _sea(lambda lat: 1.0 + 0.0 * lat)
    route = evaluate(track, ship=ship, sea=sea, chart=chart, depart=0, strict=False)
    assert "land_distance_nm" not in _met(route, ship, chart)
    land = _met(route, ship, chart.with_offing(9260.0))["land_distance_nm"]
    nearest = route.indicators["land_distance_nm"]
    assert land["limit"] == 5.0
    assert land["worst"] == pytest.approx(nearest, abs=0.2) and nearest < 12.0
    assert land["near"] == []
    near = _met(route, ship, chart.with_offing(0.98 * nearest * 1852.0))["land_distance_nm"]
    assert len(near["near"]) >= 1
