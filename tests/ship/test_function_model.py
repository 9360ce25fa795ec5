"""Ships from a user's function: a table or a field, by the variables it reads."""

import math

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship


def test_a_constant():
    ship = Ship.from_speed_function(lambda c: 4.0, draught_m=2.0)
    assert ship.speed_field is None and ship.needs == frozenset()
    assert ship.speeds.tolist() == [4.0] and ship.draught == 2.0
    assert ship.speed_through_water(Conditions(wind_speed=np.zeros(3))).tolist() == [4.0] * 3
    assert float(ship.tabulate().lookup({})) == 4.0


def test_headings_and_weather_are_tabulated():
    def polar(c):
        return 6.0 - 0.1 * c.wind_speed * np.cos(c.wind_angle / 2) ** 2

    ship = Ship.from_speed_function(polar)
    assert ship.speed_field is None
    assert ship.reads == {"wind_speed", "wind_angle"}
    assert ship.needs == {"eastward_wind", "northward_wind"}
    table = ship.tabulate(tolerance=0.01)
    assert table.error.p99 <= 0.01
    c = Conditions(wind_speed=[10.0, 20.0], wind_angle=[0.3, 1.1])
    assert table.lookup(c) == pytest.approx(ship.speed_through_water(c), rel=0.01)


def test_measured_top_speed_bounds_the_table():
    ship = Ship.from_speed_function(lambda c: 5.0 + np.sin(3.0 * c.wave_angle) * c.wave_height / 9)
    assert ship.top_speed() >= ship.tabulate().largest(0)
    assert ship.top_speed() == pytest.approx(5.0 + 24.0 / 9, rel=2e-3)


def test_place_makes_a_speed_field():
    ship = Ship.from_speed_function(lambda c: 2.0 + np.abs(c.lat))
    field = ship.speed_field
    assert ship.top_speed() is None and np.isnan(ship.speeds).all()
    assert field({}, 0.0, np.array([1.0, -3.0]), np.array([0.0, 0.0])).tolist() == [3.0, 5.0]
    assert ship.needs == frozenset()


def test_plain_sea_variables_make_a_speed_field_and_are_needed():
    ship = Ship.from_speed_function(lambda c: 3.0 * (1.0 - c["sea_ice_area_fraction"]))
    assert ship.needs == {"sea_ice_area_fraction"}
    found = ship.speed_field({"sea_ice_area_fraction": [0.5, np.nan]}, 0.0, [1, 2], [1, 2])
    assert found[0] == 1.5 and np.isnan(found[1])


def test_currents_and_depth_in_a_field_come_from_the_sea():
    ship = Ship.from_speed_function(lambda c: 3.0 + c.current_east + 0.1 * c.depth)
    assert ship.needs == {
        "eastward_sea_water_velocity",
        "sea_floor_depth_below_geoid",
    }
    sampled = {
        "eastward_sea_water_velocity": 0.5,
        "sea_floor_depth_below_geoid": 10.0,
        "sea_surface_height_above_geopotential_datum": 2.0,
    }
    assert float(ship.speed_field(sampled, 0.0, 50.0, 3.0)) == pytest.approx(4.7)


def test_a_scalar_answer_of_a_field_fills_the_shape():
    ship = Ship.from_speed_function(lambda c: (c.time, 3.0)[1])
    assert ship.speed_field({}, np.zeros(4), np.zeros(4), np.zeros(4)).tolist() == [3.0] * 4


def test_headings_mixed_with_places_are_refused_with_the_reason():
    with pytest.raises(InputError, match=r"wind_angle.*depends on the heading.*lat"):
        Ship.from_speed_function(lambda c: 5.0 + 0.01 * c.lat * np.cos(c.wind_angle))
    with pytest.raises(InputError, match="heading"):
        Ship.from_speed_function(lambda c: 5.0 + np.cos(c.heading))


def test_a_function_of_single_numbers_works_too():
    def scalar(c):
        return 3.0 if c.wave_height > 2.0 else 5.0 * math.cos(c.wave_angle / 4)

    ship = Ship.from_speed_function(scalar)
    c = Conditions(wave_height=[1.0, 3.0], wave_angle=[0.0, 0.0])
    assert ship.speed_through_water(c).tolist() == [5.0, 3.0]
    assert ship.reads == {"wave_height", "wave_angle"} or ship.reads == {"wave_height"}


def test_negative_speeds_are_no_speeds():
    ship = Ship.from_speed_function(lambda c: 5.0 - c.wave_height)
    assert ship.speed_through_water(Conditions(wave_height=[2.0, 9.0])).tolist() == [3.0, 0.0]


def test_unknown_conditions_give_unknown_speed_even_if_the_function_hides_them():
    ship = Ship.from_speed_function(lambda c: np.where(c.wave_height > 3, 4.0, 6.0))
    found = ship.speed_through_water(Conditions(wave_height=[1.0, np.nan]))
    assert found[0] == 6.0 and np.isnan(found[1])


def test_the_load_factor_reaches_the_function():
    ship = Ship.from_speed_function(lambda c: 5.0 - c.load_factor + 0.0 * c.wave_height)
    calm = Conditions(wave_height=0.0)
    assert float(ship.speed_through_water(calm)) == 4.0
    assert float(ship.with_load_factor(0.0).speed_through_water(calm)) == 5.0
    assert float(ship.with_load_factor(0.0).tabulate().lookup({"wave_height": 0.0})) == 5.0


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda c: "fast", "fails on plausible conditions"),
        (lambda c: np.zeros(7) + 4.0, "gives shape"),
        (lambda c: 0.0 * c.wave_height, "never gives a positive speed"),
        (lambda c: None, "fails on plausible conditions|positive speed"),
    ],
)
def test_functions_that_give_no_speed_are_refused(function, message):
    with pytest.raises(InputError, match=message):
        Ship.from_speed_function(function)


def test_the_users_own_bugs_are_not_hidden():
    with pytest.raises(ZeroDivisionError):
        Ship.from_speed_function(lambda c: 1 / 0)


def test_a_given_top_speed_is_taken():
    ship = Ship.from_speed_function(lambda c: 2.0 + np.abs(np.sin(c.lat)), top_speed=3.0)
    assert ship.top_speed() == pytest.approx(3.0, rel=1e-6)
    knots = Ship.from_speed_function(lambda c: 2.0 + 0.0 * c.lat, top_speed_kn=10.0)
    assert knots.top_speed() == pytest.approx(10.0 * KNOT, rel=1e-6)
    with pytest.raises(InputError, match="greatest speed"):
        Ship.from_speed_function(lambda c: 2.0, top_speed=-1.0)


def test_fingerprints_distinguish_functions_and_not_their_names():
    def a(c):
        return 2.0 + np.abs(np.sin(c.lat))

    def b(c):
        return 2.0 + np.abs(np.sin(c.lat)) * 1.001

    one, same, other = (Ship.from_speed_function(f) for f in (a, lambda c: a(c), b))
    assert one.fingerprint() == same.fingerprint() != other.fingerprint()


def test_no_speed_can_be_ordered_from_a_function():
    with pytest.raises(InputError, match="no speed can be ordered"):
        Ship.from_speed_function(lambda c: 4.0).with_speeds([3.0])


def test_a_function_that_returns_knots_is_refused():
    """14 kn given as m/s sailed 420 nm at 27 kn, and 120 as 233 kn."""
    with pytest.raises(InputError, match="which is 233 kn"):
        Ship.from_speed_function(lambda c: 120.0 - 0.1 * c.wave_height)
