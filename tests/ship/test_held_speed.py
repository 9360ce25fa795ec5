"""Ships whose engine holds a speed through water by its power."""

import numpy as np
import pytest

from thalweg import InputError, Sea, Ship, evaluate
from thalweg.core.units import KNOT
from thalweg.ship import Conditions
from thalweg.ship.consumption import engine_order
from thalweg.ship.held_speed import with_held_power, with_held_speed
from thalweg.ship.models.known_speed_model import SpeedLossModel

BULKER = Ship.load("handysize-bulker")
HELD = with_held_speed(BULKER, 12.0)


def wind(speed, angle=0.0):
    return Conditions(wind_speed=speed, wind_angle=angle)


def test_in_calm_air_it_burns_what_the_table_gives():
    fuel = np.interp(12.0, [10.8, 14.1], [20.1, 28.9]) * 1000.0 / 86400.0
    assert float(HELD.fuel_rate(wind(0.0))) == pytest.approx(fuel, rel=1e-4)
    assert float(HELD.speed_through_water(wind(0.0))) == pytest.approx(12.0 * KNOT)
    assert engine_order(HELD) == "constant speed" and engine_order(BULKER) == "constant power"


def test_it_keeps_the_speed_loss_and_its_range():
    """The referee warns of a method outside its range for held speeds, too."""
    assert isinstance(HELD.model, SpeedLossModel)
    assert HELD.model.loss is BULKER.model.loss is not None


def test_against_wind_it_holds_the_speed_at_more_power():
    """The setting that is found loses to 12 kn in this wind."""
    head = wind(8.0)
    assert float(HELD.speed_through_water(head)) == pytest.approx(12.0 * KNOT)
    burnt = float(HELD.fuel_rate(head)) * 86.4  # t/day
    table = BULKER.data["table"]
    calm = np.interp(burnt, table["fuel_t_per_day"], table["speed_kn"])
    attained = BULKER.with_speeds(calm * KNOT).speed_through_water(head)
    assert float(attained) == pytest.approx(12.0 * KNOT, rel=1e-3)


def test_beyond_its_highest_power_it_loses_speed():
    storm = wind(12.0)
    top = float(BULKER.speed_through_water(storm, 11))
    assert top < 12.0 * KNOT
    assert float(HELD.speed_through_water(storm)) == pytest.approx(top, rel=1e-6)
    assert float(HELD.fuel_rate(storm)) == pytest.approx(39.0e3 / 86400.0, rel=1e-6)


def test_unknown_wind_is_unknown_speed_and_fuel():
    assert np.isnan(HELD.speed_through_water(wind(np.nan)))
    assert np.isnan(HELD.fuel_rate(wind(np.nan)))


def test_a_resistance_ship_holds_a_speed_instead_of_a_power():
    ship = with_held_speed(Ship.load("yu-single-screw-169m"), 12.0)
    waves = Conditions(wind_speed=5.0, wind_angle=0.0, wave_height=2.0, wave_angle=0.0)
    assert float(ship.speed_through_water(waves)) == pytest.approx(12.0 * KNOT)
    assert engine_order(ship) == "constant speed"


def test_a_resistance_ship_holds_a_power_instead_of_a_speed():
    held = with_held_speed(Ship.load("yu-single-screw-169m"), 12.0)
    ship = with_held_power(held, 12.0)
    waves = Conditions(wind_speed=5.0, wind_angle=0.0, wave_height=2.0, wave_angle=0.0)
    assert float(ship.speeds[0]) == pytest.approx(12.0 * KNOT, rel=1e-4)
    assert float(ship.speed_through_water(waves)) < 11.5 * KNOT
    assert engine_order(ship) == "constant power"


def test_impossible_speeds_and_ships_without_a_law_are_refused():
    with pytest.raises(InputError, match="cannot hold 18 kn"):
        with_held_speed(BULKER, 18.0)
    with pytest.raises(InputError, match="cannot hold a speed"):
        with_held_speed(Ship.simple(10.0, 5.0), 9.0)


def test_tables_equal_the_model():
    table, fuel = HELD.tabulate(), HELD.tabulate_fuel()
    for at in ({"wind_speed": 5.0, "wind_angle": 0.3}, {"wind_speed": 11.0, "wind_angle": 1.0}):
        where = Conditions(at)
        assert float(table.lookup(at, 0)) == pytest.approx(
            float(HELD.speed_through_water(where)), rel=0.01
        )
        assert float(fuel.lookup(at, 0)) == pytest.approx(float(HELD.fuel_rate(where)), rel=0.02)


def test_the_referee_sails_it():
    air = {"eastward_wind": lambda t, a, o: -8.0 + 0 * a, "northward_wind": lambda t, a, o: 0 * a}
    waves = {"sea_surface_wave_significant_height": lambda t, a, o: 1.0 + 0 * a}
    sea = Sea.from_functions({**air, **waves})
    route = evaluate([(0, 0), (0, 0.5)], ship=HELD, sea=sea, depart=0)
    assert route.time_h == pytest.approx(route.distance_nm / 12.0, rel=1e-6)
    assert route.engine_order == "constant speed"
