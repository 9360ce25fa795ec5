"""Prices on legs of a ship for each objective, and what it consumes."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Sea, evaluate
from thalweg.core.objective import Objective
from thalweg.ship import Ship
from thalweg.ship.consumption import calm_water_consumption, consumption_table, leg_prices
from thalweg.ship.performance_sheet import performance_sheet
from thalweg.ship.ship_assumptions import stated_assumptions

BULKER = Ship.load("handysize-bulker")


def test_fuel_and_co2_are_counted_in_tonnes():
    fuel = leg_prices(Objective.of("fuel"), BULKER)
    assert (fuel.inside, fuel.outside, fuel.dues) == (1e-3, 1e-3, 0.0)
    terms = BULKER.fuel_terms
    co2 = leg_prices(Objective.of("co2"), BULKER)
    assert co2.outside == pytest.approx(terms.carbon_outside / 1000.0)
    assert fuel.waiting == pytest.approx(BULKER.waiting_fuel_rate / 1000.0)


def test_cost_counts_fuel_time_and_dues():
    terms = BULKER.fuel_terms.with_prices(600.0, 1.4, time_usd_per_day=24_000.0)
    cost = leg_prices(Objective.of("cost"), BULKER, terms)
    assert cost.outside == pytest.approx(0.6)
    assert cost.inside == pytest.approx(0.84 * terms.relative_mass_inside)
    assert cost.time == pytest.approx(24_000.0 / 86_400.0)
    assert cost.dues == 1.0
    double = leg_prices(Objective(cost=2.0, time=36.0), BULKER, terms)
    assert double.outside == 2.0 * cost.outside
    assert double.time == pytest.approx(2.0 * cost.time + 0.01)


def test_energy_is_counted_in_megawatt_hours():
    energy = leg_prices(Objective.of("energy"), BULKER)
    assert energy.consumption == "energy"
    assert energy.outside * 3.6e9 == pytest.approx(1.0)
    assert energy.waiting == pytest.approx(BULKER.hotel_power / 3.6e9)


def test_cubed_speed_replaces_fuel_without_a_price():
    costs = {"per_week": 604_800.0, "per_second_per_cubed_speed": 0.008}
    hull, speeds = {"draught_m": 5.0}, [6.0, 8.0]
    ship = Ship.from_dict({"name": "x", "hull": hull, "speeds_kn": speeds, "costs": costs})
    prices = leg_prices(Objective.of("cost"), ship)
    assert (prices.consumption, prices.outside, prices.time) == ("cubed_speed", 0.008, 1.0)
    cubes = np.asarray(ship.speeds) ** 3
    assert calm_water_consumption(ship, "cubed_speed") == pytest.approx(cubes)
    assert consumption_table(ship, "cubed_speed").kernel_arrays().n_settings == 2


def test_sums_of_key_figures_are_mixed_and_time_and_length_are_prices_beside_them():
    time = leg_prices(Objective.of("time"), BULKER)
    assert (time.time, time.inside, time.outside) == (1.0 / 3600.0, 0.0, 0.0)
    length = leg_prices(Objective(fuel=1.0, distance=1852.0), BULKER)
    assert length.length == 1.0 and length.consumption == "fuel" and length.counts_water
    mixed = leg_prices(Objective(fuel=1.0, energy=3.6), BULKER)
    assert mixed.mix == (("fuel", 1e-3), ("energy", pytest.approx(1e-9)))


def test_a_load_factor_without_effect_is_stated():
    """Schless (2023) describes the full Vox Olympia only."""
    half = Ship.load("vox-olympia").with_load_factor(0.5)
    (text,) = stated_assumptions(half)
    assert text.startswith("Load factor 0.5 has no effect")
    assert stated_assumptions(Ship.load("vox-olympia")) == []
    assert stated_assumptions(Ship.load("hopper-dredger").with_load_factor(0.0)) == []
    simple = Ship.simple(8.0, 5.0).with_load_factor(0.0)
    route = evaluate([(0, 0), (0, 0.1)], ship=simple, sea=Sea.calm(), depart=0)
    assert any("no effect" in note for note in route.assumptions)


def test_no_rating_is_shown_for_a_ship_of_unknown_deadweight():
    sheet = performance_sheet(Ship.load("yu-single-screw-169m"))
    assert all(row["cii"] is None for row in sheet["conditions"])
