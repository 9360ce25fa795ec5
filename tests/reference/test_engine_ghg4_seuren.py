"""Fuel by load of the Fourth IMO GHG Study, several engines, and Seuren's Table 5.3."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import DAY
from thalweg.ship.methods.engine import specific_consumption


@pytest.mark.parametrize(
    ("load", "factor"), [(0.25, 1.13094), (0.50, 1.03875), (0.75, 1.00344), (1.0, 1.02500)]
)
def test_load_factor_published(load, factor):
    assert specific_consumption.sfoc_load_factor(load) == pytest.approx(factor, abs=5.1e-6)


def test_least_consumption():
    loads = np.linspace(0.0, 1.2, 120_001)
    factors = specific_consumption.sfoc_load_factor(loads)
    assert loads[np.argmin(factors)] == pytest.approx(0.7802, abs=5e-5)
    assert factors.min() == pytest.approx(1.00302, abs=5e-6)


def test_one_day_of_a_ten_megawatt_engine():
    """6500 kW of 10 MW at 175 g/kWh, 24 h: 27.593 t."""
    rate = specific_consumption.fuel_rate(6.5e6, 10e6, sfoc_g_kwh=175.0)
    assert rate * DAY / 1000.0 == pytest.approx(27.593, abs=5e-4)


def test_base_values_and_their_sources():
    value, record = specific_consumption.base_sfoc("slow_speed_diesel", "residual", built=2010)
    assert (value, record.verified) == (175.0, True)
    assert specific_consumption.base_sfoc("slow_speed_diesel", "residual", built=1990)[0] == 185.0
    assert specific_consumption.base_sfoc("slow_speed_diesel", "residual", built=1970)[0] == 205.0
    value, record = specific_consumption.base_sfoc("lng_diesel", "lng")
    assert (value, record.pilot, record.verified) == (135.0, 6.0, False)
    assert "not compared" in record.source


@pytest.mark.parametrize(
    ("machine", "kind", "by_year"),
    [
        ("slow_speed_diesel", "residual", (205, 185, 175)),
        ("slow_speed_diesel", "distillate", (190, 175, 165)),
        ("medium_speed_diesel", "residual", (215, 195, 185)),
        ("medium_speed_diesel", "distillate", (200, 185, 175)),
        ("high_speed_diesel", "residual", (225, 205, 195)),
        ("high_speed_diesel", "distillate", (210, 190, 185)),
        ("auxiliary", "residual", (225, 205, 195)),
        ("auxiliary", "distillate", (210, 190, 185)),
        ("gas_turbine", "residual", (305, 305, 305)),
        ("gas_turbine", "distillate", (300, 300, 300)),
        ("steam_turbine", "residual", (340, 340, 340)),
        ("steam_turbine", "distillate", (320, 320, 320)),
        ("steam_turbine", "lng", (285, 285, 285)),
    ],
)
def test_base_values_by_year_of_build(machine, kind, by_year):
    found = [
        specific_consumption.base_sfoc(machine, kind, built=year)[0] for year in (1983, 2000, 2001)
    ]
    assert found == list(by_year)


def test_base_values_of_gas_and_methanol():
    young = {
        ("lng_otto_slow_speed", "lng"): 148.0,
        ("lng_otto_medium_speed", "lng"): 156.0,
        ("auxiliary", "lng"): 156.0,
        ("slow_speed_diesel", "methanol"): 350.0,
        ("medium_speed_diesel", "methanol"): 370.0,
    }
    assert {pair: specific_consumption.base_sfoc(*pair)[0] for pair in young} == young
    assert specific_consumption.base_sfoc("lng_otto_medium_speed", "lng", built=1990)[0] == 173.0
    assert specific_consumption.base_sfoc("lng_otto_slow_speed", "lng")[1].pilot == 0.8


def test_no_number_is_an_error_not_a_guess():
    with pytest.raises(InputError, match="lng_diesel"):
        specific_consumption.base_sfoc("lng_diesel", "lng", built=1980)
    with pytest.raises(InputError, match="slow_speed_diesel"):
        specific_consumption.base_sfoc("slow_speed_disel", "residual")
    with pytest.raises(InputError, match="residual"):
        specific_consumption.base_sfoc("slow_speed_diesel", "lng")


def test_turbine_consumption_does_not_depend_on_load():
    flat = specific_consumption.fuel_rate(
        [1e6, 9e6], 10e6, sfoc_g_kwh=300.0, varies_with_load=False
    )
    assert flat[1] / flat[0] == pytest.approx(9.0)


def test_zero_negative_and_unknown_power():
    rate = specific_consumption.fuel_rate([0.0, -1.0, np.nan], 10e6, sfoc_g_kwh=175.0)
    assert rate[0] == 0.0
    assert np.all(np.isnan(rate[1:]))


def test_engines_needed():
    needed = specific_consumption.engines_needed(
        [0.0, 1.0, 5e6, 5.1e6, 10e6, 10.1e6, np.nan], 5e6, count=2
    )
    np.testing.assert_array_equal(needed, [0, 1, 1, 2, 2, np.nan, np.nan])


def test_fewest_engines_do_not_always_burn_the_least():
    """At 5 MW one engine runs at full load (1.025), two at half load (1.03875)."""
    _, one = specific_consumption.plant_fuel_rate(5e6, 5e6, count=2, sfoc_g_kwh=180.0)
    _, two = specific_consumption.plant_fuel_rate(
        8e6, 5e6, count=3, sfoc_g_kwh=180.0, choice="fewest"
    )
    assert (one, two) == (1.0, 2.0)
    best, running = specific_consumption.plant_fuel_rate(10e6, 5e6, count=3, sfoc_g_kwh=180.0)
    fewest, least = specific_consumption.plant_fuel_rate(
        10e6, 5e6, count=3, sfoc_g_kwh=180.0, choice="fewest"
    )
    assert (running, least) == (3.0, 2.0)
    assert best < fewest
    assert best == pytest.approx(
        3 * specific_consumption.fuel_rate(10e6 / 3, 5e6, sfoc_g_kwh=180.0)
    )


def test_plant_limits():
    fuel, running = specific_consumption.plant_fuel_rate(
        [0.0, 20e6, np.nan], 5e6, count=2, sfoc_g_kwh=180.0
    )
    np.testing.assert_array_equal(fuel, [0.0, np.nan, np.nan])
    np.testing.assert_array_equal(running, [0.0, np.nan, np.nan])


def test_hotel_load():
    """500 kW at 200 g/kWh: 2.4 t a day."""
    assert specific_consumption.hotel_fuel_rate(500e3, sfoc_g_kwh=200.0) * DAY == pytest.approx(
        2400.0
    )
