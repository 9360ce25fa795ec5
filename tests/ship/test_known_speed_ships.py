"""Ships from a few numbers: speeds, fuel, loading, limits, and what is refused."""

import math

import numpy as np
import pytest

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.units import DAY, KNOT
from thalweg.ship import Conditions, Ship, ShipLimits

CALM = Conditions(wind_speed=0.0, wind_angle=0.0)
GALE = Conditions(wind_speed=18.0, wind_angle=0.0)
BULKER = {"length_m": 152.9, "block_coefficient": 0.8, "displacement_m3": 27150.0}


def test_just_speed_and_draught_is_constant_speed_in_all_weather():
    ship = Ship.simple(speed_kn=8.0, draught_m=5.0)
    assert ship.speeds.tolist() == [8.0 * KNOT]
    assert ship.draught == 5.0
    assert ship.needs == frozenset()
    for conditions in (Conditions(), CALM, GALE):
        assert float(ship.speed_through_water(conditions)) == 8.0 * KNOT
    assert ship.limits == ShipLimits()


def test_without_fuel_data_fuel_is_unknown_not_zero():
    ship = Ship.simple(speed_kn=8.0, draught_m=5.0)
    assert np.isnan(ship.fuel_rate(GALE)) and np.isnan(ship.power(GALE))


def test_fuel_follows_the_cubic_law():
    ship = Ship.simple(speed_kn=12.0, draught_m=8.0, speeds_kn=[12.0, 6.0], fuel_t_per_day=24.0)
    rates = ship.fuel_rate(CALM, np.array([0, 1])) * DAY / 1000.0
    assert rates.tolist() == pytest.approx([3.0, 24.0])
    assert (ship.speeds / KNOT).tolist() == pytest.approx([6.0, 12.0])


def test_an_ordered_speed_changes_the_fuel_with_its_cube():
    ship = Ship.simple(speed_kn=12.0, draught_m=8.0, fuel_t_per_day=24.0).with_speeds(9.0 * KNOT)
    assert (ship.speeds / KNOT).tolist() == pytest.approx([9.0])
    assert float(ship.fuel_rate(CALM)) * DAY / 1000 == pytest.approx(24.0 * 0.75**3)


@pytest.mark.parametrize("speed", [0.0, -3.0, math.nan, math.inf])
def test_impossible_ordered_speeds_are_refused(speed):
    ship = Ship.simple(speed_kn=12.0, draught_m=8.0, fuel_t_per_day=24.0)
    with pytest.raises(InputError, match="cannot be ordered"):
        ship.with_speeds(speed)


@pytest.mark.parametrize("speed", [0.0, -8.0, math.nan, math.inf, "fast", True, None])
def test_impossible_speeds_are_refused(speed):
    with pytest.raises(InputError, match=r"speeds_kn|reference_speed_kn"):
        Ship.simple(speed_kn=speed, draught_m=5.0, speeds_kn=[speed])


@pytest.mark.parametrize("draught", [-1.0, math.nan, 400.0])
def test_impossible_draughts_are_refused(draught):
    with pytest.raises(InputError, match="draught_m"):
        Ship.simple(speed_kn=8.0, draught_m=draught)


def test_kwon_reduces_the_speed_at_constant_fuel_rate():
    ship = Ship.simple(
        15.2, 9.5, breadth_m=23.4, fuel_t_per_day=39.0, speed_loss="kwon_2008", **BULKER
    )
    assert ship.needs == {"eastward_wind", "northward_wind"}
    assert float(ship.speed_through_water(CALM)) == pytest.approx(15.2 * KNOT)
    assert float(ship.speed_through_water(GALE)) < 0.5 * 15.2 * KNOT
    assert float(ship.fuel_rate(GALE)) == float(ship.fuel_rate(CALM))


def test_kwon_without_its_particulars_names_what_is_missing():
    with pytest.raises(InputError, match="length_between_perpendiculars_m, block_coefficient"):
        Ship.simple(15.2, 9.5, speed_loss="kwon_2008")
    with pytest.raises(InputError, match="displacement_m3"):
        Ship.simple(15.2, 9.5, speed_loss="kwon_2008", length_m=150, block_coefficient=0.8)


def test_displacement_follows_from_the_block_coefficient_and_is_reported():
    ship = Ship.simple(15.2, 9.5, length_m=152.9, breadth_m=23.4, block_coefficient=0.8)
    found = {e.key: e.value for e in ship.estimated}
    assert found["displacement_m3"] == pytest.approx(0.8 * 152.9 * 23.4 * 9.5)


def test_an_unknown_speed_loss_gets_near_matches():
    with pytest.raises(InputError, match="Did you mean 'kwon_2008'"):
        Ship.simple(15.2, 9.5, speed_loss="kwon2008")


def test_limits_are_hard_and_say_what_they_look_at():
    ship = Ship.simple(8.0, 5.0, max_wave_height_m=3.0, max_wind_speed_kn=40.0)
    assert ship.limits.wave_height == 3.0
    assert ship.limits.wind_speed == pytest.approx(40.0 * KNOT)
    assert ship.needs == {
        "sea_surface_wave_significant_height",
        "eastward_wind",
        "northward_wind",
    }
    assert ship.with_limits(ShipLimits()).needs == frozenset()


@pytest.mark.parametrize("name", ["max_wave_height_m", "max_wind_speed_kn"])
def test_a_limit_of_zero_is_refused(name):
    with pytest.raises(InputError, match="limits"):
        Ship.simple(8.0, 5.0, **{name: 0.0})


def test_a_setting_that_is_not_there_is_refused():
    ship = Ship.simple(8.0, 5.0)
    with pytest.raises(InputError, match="no setting 1"):
        ship.speed_through_water(CALM, 1)
    with pytest.raises(InputError, match="index"):
        ship.speed_through_water(CALM, 0.5)


def test_unknown_wind_gives_unknown_speed():
    ship = Ship.simple(15.2, 9.5, breadth_m=23.4, speed_loss="kwon_2008", **BULKER)
    c = Conditions(wind_speed=[np.nan, 5.0], wind_angle=[0.0, np.nan])
    assert np.isnan(ship.speed_through_water(c)).all()


def test_the_table_agrees_with_the_ship_and_states_its_error():
    ship = Ship.simple(15.2, 9.5, breadth_m=23.4, speed_loss="kwon_2008", **BULKER)
    table = ship.tabulate(tolerance=0.005)
    assert table.error.p99 <= 0.005
    assert table.fingerprint == ship.fingerprint()
    draw = np.random.default_rng(1)
    c = Conditions(wind_speed=draw.uniform(0, 30, 500), wind_angle=draw.uniform(0, np.pi, 500))
    truth, found = ship.speed_through_water(c), table.lookup(c)
    known = np.isfinite(found)
    error = np.abs(found - truth)[known] / ship.speeds[0]
    assert np.quantile(error, 0.99) < 0.005
    opened = table.before_closing().lookup(c)  # for bounds: of all weather
    assert np.quantile(np.abs(opened - truth) / ship.speeds[0], 0.99) < 0.005
    assert np.array_equal(table.at_setting(0).before_closing().lookup(c), opened)
    assert known[truth > 0.7 * ship.speeds[0]].mean() > 0.98
    assert not known[(truth < 0.5 * ship.speeds[0]) & (c["wind_speed"] > 13.0)].any()


def test_the_top_speed_bounds_ship_and_table():
    ship = Ship.simple(15.2, 9.5, breadth_m=23.4, speed_loss="kwon_2008", **BULKER)
    table = ship.tabulate()
    assert ship.top_speed(0) >= table.largest(0)
    assert ship.top_speed(0) >= float(ship.speed_through_water(CALM))
    assert ship.top_speed(0) == pytest.approx(15.2 * KNOT, rel=1e-6)


def test_fingerprints_distinguish_ships():
    one = Ship.simple(8.0, 5.0)
    assert one.fingerprint() == Ship.simple(8.0, 5.0, name="another name").fingerprint()
    others = [
        Ship.simple(8.1, 5.0),
        Ship.simple(8.0, 5.1),
        Ship.simple(8.0, 5.0, max_wave_height_m=3.0),
        Ship.simple(8.0, 5.0, fuel_t_per_day=3.0),
    ]
    assert len({one.fingerprint(), *(ship.fingerprint() for ship in others)}) == 5


def test_notes_report_where_kwon_is_out_of_range():
    ship = Ship.simple(15.2, 9.5, breadth_m=23.4, speed_loss="kwon_2008", **BULKER)
    assert ship.notes(CALM) == []
    note, form = ship.notes(GALE)
    assert note.quantity == "Beaufort number" and note.high == 6.0
    assert note.value == pytest.approx((18.0 / 0.836) ** (2 / 3))
    assert form.quantity == "C_form (loss from ahead in per cent)" and form.high == 50.0
    with pytest.raises(ModelRangeError, match="Beaufort number"):
        ship.notes(GALE, strict=True)


def test_a_small_ship_leaves_the_range_of_kwon_in_less_wind():
    ferry = Ship.simple(
        17.0, 4.5, length_m=95.0, breadth_m=16.0, block_coefficient=0.62, speed_loss="kwon_2008"
    )
    wind = Conditions({"wind_speed": np.array([7.0, 11.6]), "wind_angle": 0.0})
    (note,) = ferry.notes(wind)
    number = (11.6 / 0.836) ** (2 / 3)
    volume = 95.0 * 16.0 * 4.5 * 0.62
    assert note.quantity == "C_form (loss from ahead in per cent)"
    assert note.value == pytest.approx(0.5 * number + number**6.5 / (2.7 * volume ** (2 / 3)))
    assert ferry.notes(Conditions({"wind_speed": 7.0, "wind_angle": 0.0})) == []
