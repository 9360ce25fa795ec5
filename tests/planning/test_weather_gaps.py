"""Missing weather: fillings by name, gaps on the way, and results without NaN."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import MissingVariableError, NoRouteError

T0 = np.datetime64("2026-01-01T00:00", "ns")
WATER = Chart.open_water(49.5, 51.5, 0.5, 3.5)


def height_file(tmp_path, height=2.0):
    """Return a file with nothing but a wave height."""
    times = T0 + np.arange(0, 49, 6) * np.timedelta64(1, "h")
    lat, lon = np.arange(49.0, 52.01, 0.5), np.arange(0.0, 4.01, 0.5)
    values = np.full((times.size, lat.size, lon.size), height)
    xr.Dataset(
        {"swh": (("time", "lat", "lon"), values, {"units": "m"})},
        {"time": times, "lat": lat, "lon": lon},
    ).to_netcdf(tmp_path / "height.nc")
    return tmp_path / "height.nc"


def test_the_message_names_the_filling_of_every_missing_quantity(tmp_path):
    voyage = Voyage(start=(50.0, 1.0), goal=(50.0, 3.0), depart="2026-01-01")
    with pytest.raises(MissingVariableError) as caught:
        plan(
            voyage,
            ship=Ship.load("kvlcc2"),
            sea=Sea.open(height_file(tmp_path)),
            chart=WATER,
        )
    assert "wind=0 waves=head_seas" in caught.value.remedy


@pytest.mark.slow
def test_waves_of_known_height_alone_are_head_seas(tmp_path):
    """As in waves of the same height and period that meet the ship head on."""
    ship = Ship.load("kvlcc2")
    filled = Sea.open(height_file(tmp_path)).filled(waves="head_seas", wind=0.0)
    constant = {
        "sea_surface_wave_significant_height": lambda t, y, x: 2.0,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": lambda t, y, x: (
            5.0 * 2.0**0.5
        ),
        "sea_surface_wave_from_direction": lambda t, y, x: 90.0,
    }
    ahead = Sea.from_functions(constant, time_step=0.0).filled(wind=0.0)
    voyage = Voyage(start=(50.0, 1.0), goal=(50.0, 3.0), depart="2026-01-01")
    one, two = (
        plan(voyage, ship=ship, sea=s, chart=WATER, resolution=10_000.0) for s in (filled, ahead)
    )
    assert one.best.feasible
    assert one.best.time_h == pytest.approx(two.best.time_h, rel=2e-3)
    assert any("from ahead" in note for note in one.notes)


def current_unknown_where(condition):
    """Return a sea of a weak current that is unknown at some positions."""

    def east(t, lat, lon):
        return np.where(condition(lat, lon), np.nan, 0.1) + 0.0 * t

    def north(t, lat, lon):
        return 0.0 * (t + lat + lon)

    names = "eastward_sea_water_velocity", "northward_sea_water_velocity"
    return Sea.from_functions(dict(zip(names, (east, north))))


SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)
VOYAGE = Voyage(start=(50.5, 1.0), goal=(50.5, 3.0), depart="2026-01-01")


@pytest.mark.slow
def test_a_gap_between_the_stations_is_planned_round():
    """A disc of 1.1 km without data on the straight way, which no node or sample touches."""

    def inside(lat, lon):
        return np.hypot(lat - 50.5035, (lon - 2.013) * 0.636) < 0.01

    clear = plan(VOYAGE, ship=SHIP, sea=current_unknown_where(lambda y, x: y > 90.0), chart=WATER)
    found = plan(VOYAGE, ship=SHIP, sea=current_unknown_where(inside), chart=WATER)
    assert found.best.feasible
    assert clear.best.time_h < found.best.time_h < 1.005 * clear.best.time_h
    along = found.best.samples
    assert not inside(np.asarray(along["lat"]), np.asarray(along["lon"])).any()


@pytest.mark.slow
def test_a_gap_across_the_way_is_named():
    """A strip of 4 km from one side of the chart to the other."""
    sea = current_unknown_where(lambda lat, lon: np.abs(lon - 2.013) < 0.03)
    with pytest.raises(NoRouteError) as caught:
        plan(VOYAGE, ship=SHIP, sea=sea, chart=WATER, resolution=4000.0)
    text = str(caught.value)
    assert "eastward_sea_water_velocity" in text
    assert "unknown" in text and "50.5" in text
    assert "--fill currents" in caught.value.remedy
    assert caught.value.reasons["no data"] > 0


@pytest.mark.slow
def test_a_gap_that_the_referee_alone_sees_is_named():
    """A strip that is thinner than the samples of edges, and wider than those of the referee."""
    sea = current_unknown_where(lambda lat, lon: np.abs(lon - 2.013) < 0.008)
    narrow = Chart.open_water(50.3, 50.7, 0.5, 3.5)  # it tries less water to go round the strip
    with pytest.raises(NoRouteError) as caught:
        plan(VOYAGE, ship=SHIP, sea=sea, chart=narrow, resolution=10_000.0)
    text = str(caught.value)
    assert "eastward_sea_water_velocity" in text
    assert "2.0" in text
    assert "--fill currents" in caught.value.remedy


FUEL_SHIP = Ship.simple(speed_kn=10.0, speeds_kn=[7.0, 10.0], draught_m=5.0, fuel_t_per_day=20.0)


@pytest.mark.slow
def test_a_front_is_planned_round_a_gap():
    """The disc of the test above: the fastest and the cheapest route once ended in it."""

    def inside(lat, lon):
        return np.hypot(lat - 50.5035, (lon - 2.013) * 0.636) < 0.01

    voyage = dataclasses.replace(VOYAGE, objective="front", method="exact")
    given = {"ship": FUEL_SHIP, "chart": WATER, "resolution": 20_000.0}
    found = plan(voyage, sea=current_unknown_where(inside), **given)
    assert len(found.routes) > 3 and all(route.feasible for route in found.routes)
    for route in found.routes:
        along = route.samples
        assert not inside(np.asarray(along["lat"]), np.asarray(along["lon"])).any()
    clear = plan(voyage, sea=current_unknown_where(lambda y, x: y > 90.0), **given)
    assert found.routes[0].time_h < 1.01 * clear.routes[0].time_h
    assert found.front.values[-1] < 1.05 * clear.front.values[-1]


@pytest.mark.slow
def test_a_gap_across_a_front_is_named():
    sea = current_unknown_where(lambda lat, lon: np.abs(lon - 2.013) < 0.008)
    voyage = dataclasses.replace(VOYAGE, objective="fuel", method="exact")
    with pytest.raises(NoRouteError) as caught:
        plan(voyage, ship=FUEL_SHIP, sea=sea, chart=WATER, resolution=10_000.0)
    assert "eastward_sea_water_velocity" in str(caught.value)
    assert "--fill currents" in caught.value.remedy
