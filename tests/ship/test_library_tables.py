"""Tables of the library's composed ships: size, error, and truth against the methods."""

import numpy as np
import pytest

from thalweg.ship import Conditions, Ship


@pytest.mark.parametrize("name", ["s175", "vox-olympia", "yu-single-screw-169m"])
def test_tables_meet_one_per_cent_in_64_megabytes(name):
    table = Ship.load(name).tabulate(tolerance=0.01)
    assert table.error.p99 <= 0.01
    assert table.error.samples >= 1500
    assert table.nbytes < 64e6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gunnerus", "kvlcc2"])
def test_larger_tables_meet_one_per_cent_too(name):
    assert Ship.load(name).tabulate(tolerance=0.01).error.p99 <= 0.01


@pytest.mark.slow
def test_a_table_that_misses_the_tolerance_says_so():
    table = Ship.load("jbc").tabulate(tolerance=0.01)
    assert 0.01 < table.error.p99 <= 0.02
    assert table.error.mean < 0.002


def test_a_table_in_usual_weather_is_much_better_than_its_p99():
    ship = Ship.load("s175")
    table, draw = ship.tabulate(), np.random.default_rng(5)
    c = Conditions(
        wind_speed=draw.uniform(0, 15, 300),
        wind_angle=draw.uniform(0, np.pi, 300),
        wave_height=draw.uniform(0, 4, 300),
        wave_angle=draw.uniform(0, np.pi, 300),
        wave_period=draw.uniform(5, 15, 300),
    )
    truth = ship.speed_through_water(c, 4)
    assert np.quantile(np.abs(table.lookup(c, 4) / truth - 1), 0.99) < 0.004


def test_tables_end_at_the_limits_and_do_not_extrapolate():
    ship = Ship.load("yu-single-screw-169m")
    calm = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0}
    table = ship.tabulate()
    assert float(table.lookup(calm, 0)) == pytest.approx(ship.speeds[0], rel=1e-4)
    assert np.isnan(table.lookup({**calm, "wave_height": 8.5}))
    assert np.isfinite(table.lookup({**calm, "wave_height": 8.0}))


def test_shallow_water_slows_in_table_and_model_alike():
    ship = Ship.load("vox-olympia")
    table, depth = ship.tabulate(), np.array([7.0, 9.0, 14.0, 30.0, 60.0, 4000.0])
    speed = ship.speed_through_water(Conditions(depth=depth), 3)
    assert (np.diff(speed) > -1e-6).all()
    assert speed[0] < 0.9 * speed[-1]
    assert table.lookup({"depth": depth}, 3) == pytest.approx(speed, rel=0.01)
    assert np.isnan(table.lookup({"depth": 5.0}, 3))


def test_the_bound_of_speed_covers_following_wind():
    ship = Ship.load("yu-single-screw-169m")
    push = Conditions(wind_speed=28.0, wind_angle=np.pi, wave_height=0.0, wave_angle=0.0)
    assert ship.speeds[4] < float(ship.speed_through_water(push, 4)) <= ship.top_speed(4)
    assert ship.top_speed(4) < 1.05 * ship.speeds[4]
