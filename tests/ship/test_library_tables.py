"""Tables of the library's composed ships: size, error, and agreement with the methods."""

import numpy as np
import pytest

from thalweg.kernels.leg.table_lookup import table_value
from thalweg.ship import Conditions, Ship


@pytest.mark.parametrize(
    "name", ["gunnerus", "jbc", "kvlcc2", "s175", "vox-olympia", "yu-single-screw-169m"]
)
def test_tables_meet_one_per_cent_in_eight_megabytes(name):
    table = Ship.load(name).tabulate(tolerance=0.01)
    assert table.error.p99 <= 0.01
    assert table.error.mean < 0.002
    assert table.error.samples >= 1500
    assert table.nbytes < 8e6


@pytest.mark.parametrize("name", ["jbc", "s175"])
def test_the_stated_error_holds_at_other_conditions(name):
    """Fresh conditions, settings and all; the floor of the measure is a quarter of the top."""
    ship = Ship.load(name)
    table, draw = ship.tabulate(), np.random.default_rng(99)
    low_high = {name: (low, high) for name, (low, high) in sorted(table.ranges.items())}
    c = Conditions({n: draw.uniform(low, high, 1500) for n, (low, high) in low_high.items()})
    true = np.stack([ship.speed_through_water(c, k) for k in range(5)], axis=-1)
    found = np.stack([table.lookup(c, k) for k in range(5)], axis=-1)
    assert (np.isnan(true) == np.isnan(found)).all()
    error = np.abs(found - true) / np.maximum(true, 0.25 * true.max(axis=0))
    assert np.quantile(error, 0.99) == pytest.approx(table.error.p99, rel=0.5)


@pytest.mark.slow
def test_a_table_beyond_the_tolerance_is_reported():
    table = Ship.load("s175").tabulate(tolerance=1e-6)
    assert 1e-6 < table.error.p99 < 0.002
    assert table.nbytes < 64e6


@pytest.mark.parametrize("name", ["handysize-bulker", "kvlcc2", "vox-olympia", "held"])
def test_kernels_read_library_tables_as_numpy_does(name):
    if name == "held":
        data = {k: v for k, v in Ship.load("jbc").data.items() if k != "powers_kw"}
        ship = Ship.from_dict({**data, "speeds_kn": [9, 12, 14]})
    else:
        ship = Ship.load(name)
    draw = np.random.default_rng(8)
    spans = {"wind_speed": 29.0, "wind_angle": np.pi, "wave_height": 8.2, "wave_angle": np.pi}
    columns = {n: draw.uniform(0.0, high, 300) for n, high in spans.items()}
    columns |= {"wave_period": draw.uniform(0, 30, 300), "depth": draw.uniform(4.0, 90.0, 300)}
    names = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")
    rows = np.stack([columns[n] for n in names], axis=1)
    for table in (ship.tabulate(), *((ship.tabulate_fuel(),) if name == "held" else ())):
        last = len(table.settings) - 1
        expected = np.broadcast_to(table.lookup(columns, last), 300)
        arrays = table.kernel_arrays()
        found = [table_value(arrays, tuple(row), last) for row in rows]
        values = np.array([value if ok else np.nan for value, ok in found])
        assert values == pytest.approx(expected, abs=1e-5, nan_ok=True)
        assert np.nanmax(expected) <= table.largest(last) * (1 + 1e-6)
    assert np.isfinite(expected).sum() > 100


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
