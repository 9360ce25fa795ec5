"""Tables of the fuel rate: constants, held speeds, hotel load, and their measured errors."""

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, KNOT
from thalweg.ship import Conditions, Ship, TableError
from thalweg.ship.loading_state import Loading
from thalweg.ship.tables.tabulate import constant_part

DATA = {
    "name": "composed",
    "hull": {
        "length_waterline_m": 172.42,
        "length_between_perpendiculars_m": 169.0,
        "breadth_m": 32.0,
        "draught_m": 10.0,
        "block_coefficient": 0.785,
        "frontal_area_m2": 700.0,
        "lateral_area_m2": 1800.0,
    },
    "engine": {"power_kw": 9000, "type": "slow_speed_diesel"},
    "fuel": {"type": "hfo"},
    "limits": {"max_significant_wave_height_m": 6.0, "max_wind_speed_m_s": 24.0},
    "models": {
        "calm_water": "holtrop_1984",
        "waves": "stawave_1",
        "wind": "blendermann_1994",
        "wind_type": "tanker_loaded",
    },
}


def _held(**sections):
    return Ship.from_dict({**DATA, "speeds_kn": [10, 12, 13.5], **sections})


def _draws(count, seed, **more):
    draw = np.random.default_rng(seed)
    return Conditions(
        wind_speed=draw.uniform(0, 24, count),
        wind_angle=draw.uniform(0, np.pi, count),
        wave_height=draw.uniform(0, 6, count),
        wave_angle=draw.uniform(0, np.pi, count),
        **{name: draw.uniform(low, high, count) for name, (low, high) in more.items()},
    )


def test_a_ship_with_a_table_of_fuel_burns_its_settings_fuel():
    table = Ship.load("handysize-bulker").tabulate_fuel()
    assert len(table.parts) == 1 and table.axes == frozenset()
    assert table.parts[0].values[[0, 5, 11]] * DAY / 1000 == pytest.approx([14.3, 20.1, 39.0])
    assert table.error == TableError(0.0, 0.0, 0.0, 0)


@pytest.mark.parametrize("rows", [False, True])
@pytest.mark.parametrize("law", ["table", "cubic"])
def test_fuel_per_hour_is_that_per_day_over_24(rows, law):
    """fuel_kg_per_h, as performance sheets have it, was no key of a table."""

    def ship_of(**fuel):
        table = {"speed_kn": [10.0, 12.0], **fuel}
        if rows:
            table = [dict(zip(table, values)) for values in zip(*table.values())]
        hull, models = {"draught_m": 6.0}, {"calm_water": law}
        data = {"name": "x", "hull": hull, "speeds_kn": [10, 12], "table": table, "models": models}
        return Ship.from_dict(data)

    daily = ship_of(fuel_t_per_day=[12.0, 24.0])
    hourly = ship_of(fuel_kg_per_h=[500.0, 1000.0])
    for k in (0, 1):
        rates = [float(ship.fuel_rate(Conditions(), k)) for ship in (daily, hourly)]
        assert rates[0] == pytest.approx(rates[1])
    assert float(hourly.fuel_rate(Conditions(), 1)) == pytest.approx(1000.0 / 3600.0)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"fuel_kg_per_h": [500, 900], "fuel_t_per_day": [12, 24]}, "given twice"),
        ({"fuel_kg_per_h": [500]}, "fuel_kg_per_h has another length"),
        ({"fuel_kg_per_h": [500, 5e4]}, "fuel_kg_per_h"),
    ],
)
def test_wrong_fuels_per_hour_are_refused_by_their_key(columns, words):
    table = {"speed_kn": [10.0, 12.0], **columns}
    with pytest.raises(InputError, match=words):
        Ship.from_dict({"name": "x", "hull": {"draught_m": 6.0}, "table": table})


def test_a_setting_of_power_burns_the_same_in_all_weather():
    ship = Ship.from_dict({**DATA, "powers_kw": [3600, 7650]})
    table, c = ship.tabulate_fuel(), _draws(300, 3)
    assert table.axes == frozenset()
    assert table.error.samples >= 1500 and table.error.max < 1e-3
    for setting, power in enumerate((3600, 7650)):
        x = power / 9000
        sfoc = 175 * (0.455 * x**2 - 0.710 * x + 1.280)
        expected = power * sfoc / 3.6e6
        assert float(table.lookup(c, setting)) == pytest.approx(expected, rel=1e-6)
        assert ship.fuel_rate(c, setting) == pytest.approx(expected, rel=1e-3)


def test_a_ship_that_weather_stops_burns_no_more_than_ordered():
    ship = Ship.load("jbc")
    storm = Conditions(
        wind_speed=13.1, wind_angle=0.1, wave_height=7.6, wave_angle=0.99, wave_period=9.6
    )
    assert float(ship.speed_through_water(storm, 0)) == 0.0
    assert float(ship.power(storm, 0)) == pytest.approx(4.125e6, rel=1e-6)
    assert float(ship.fuel_rate(storm, 0)) == pytest.approx(4125 * 166.9 / 3.6e6, rel=1e-6)


def test_the_fuel_of_an_ordered_speed_depends_on_the_weather():
    ship = _held()
    table = ship.tabulate_fuel()
    c = _draws(1500, 11)
    true = np.stack([ship.fuel_rate(c, k) for k in range(3)], axis=-1)
    found = np.stack([table.lookup(c, k) for k in range(3)], axis=-1)
    error = np.abs(found - true) / np.maximum(true, 0.25 * true.max(axis=0))
    assert np.quantile(error, 0.99) == pytest.approx(table.error.p99, rel=0.4)
    assert error.mean() < 3.0 * table.error.mean  # which rests on a few draws next to a jump
    assert table.error.p99 < 0.01
    assert table.error.samples >= 4500
    assert (true.max(axis=0) > 1.3 * true.min(axis=0)).all()  # it does depend on the weather


def test_the_error_of_a_fuel_table_falls_with_the_tolerance():
    ship = _held()
    rough, fine = ship.tabulate_fuel(tolerance=0.01), ship.tabulate_fuel(tolerance=2e-4)
    assert fine.error.p99 < 0.8 * rough.error.p99 and rough.error.p99 <= 0.01
    assert rough.nbytes < fine.nbytes


def test_a_held_speed_burns_no_more_than_the_engines_at_their_rating():
    ship = _held()
    storm = Conditions(wind_speed=24.0, wind_angle=0.0, wave_height=6.0, wave_angle=0.0)
    full = 9000 * 175 * (0.455 - 0.710 + 1.280) / 3.6e6
    assert ship.speed_through_water(storm, 2) < 0.8 * ship.speeds[2]
    assert float(ship.fuel_rate(storm, 2)) == pytest.approx(full, rel=1e-3)
    assert float(ship.tabulate_fuel().lookup(storm, 2)) == pytest.approx(full, rel=1e-3)


def test_calm_water_is_exact_in_the_table():
    ship = _held()
    calm = Conditions(wind_speed=0.0, wind_angle=0.0, wave_height=0.0, wave_angle=0.0)
    for setting in range(3):
        found = float(ship.tabulate_fuel().lookup(calm, setting))
        assert found == pytest.approx(float(ship.fuel_rate(calm, setting)), rel=2e-4)


def test_shallow_water_costs_fuel_at_a_held_speed():
    models = {**DATA["models"], "shallow_water": "lackenby_1963", "waves": "none", "wind": "none"}
    ship = _held(models=models)
    table, depth = ship.tabulate_fuel(), np.array([16.0, 25.0, 60.0, 4000.0])
    found = table.lookup({"depth": depth}, 1)
    assert (np.diff(found) < 0).any() and found[0] > 1.05 * found[-1]
    assert found == pytest.approx(ship.fuel_rate(Conditions(depth=depth), 1), rel=0.01)


def test_the_engines_own_curve_and_number_count():
    curve = {"sfoc_load": [0.2, 0.6, 1.0], "sfoc_curve_g_per_kwh": [240.0, 180.0, 200.0]}
    one = _held(engine={"power_kw": 9000, **curve}, models={"calm_water": "holtrop_1984"})
    two = _held(
        engine={"power_kw": 4500, "count": 2, "sfoc_g_per_kwh": 175},
        models={"calm_water": "holtrop_1984"},
    )
    for ship in (one, two):
        table = ship.tabulate_fuel()
        assert [p.axes for p in table.parts] == [()]
        assert table.parts[0].values == pytest.approx(ship.fuel_rate(Conditions(), range(3)))
    load = float(one.power(Conditions(), 1)) / 9e6
    assert one.tabulate_fuel().parts[0].values[1] == pytest.approx(
        load * 9000 * np.interp(load, [0.2, 0.6, 1.0], [240.0, 180.0, 200.0]) / 3.6e6, rel=1e-6
    )


def test_the_hotel_load_burns_under_way_and_at_rest():
    without, ship = _held(), _held(engine={**DATA["engine"], "hotel_load_kw": 300})
    hotel = 300 * 195 / 3.6e6
    assert ship.waiting_fuel_rate == pytest.approx(hotel)
    assert without.waiting_fuel_rate == 0.0
    c = _draws(50, 2)
    more = ship.tabulate_fuel().lookup(c, 1) - without.tabulate_fuel().lookup(c, 1)
    assert more == pytest.approx(hotel, rel=0.02)


@pytest.mark.parametrize("calm_water", ["cubic", "table"])
def test_the_hotel_load_comes_on_top_of_fuel_made_from_power(calm_water):
    data = {
        "name": "known speeds",
        "hull": {"draught_m": 5.0},
        "engine": {
            "reference_power_kw": 4000,
            "sfoc_g_per_kwh": 180,
            "hotel_load_kw": 200,
            "hotel_sfoc_g_per_kwh": 210,
        },
        "models": {"calm_water": calm_water},
    }
    speeds = {"cubic": {"speeds_kn": [6, 12]}, "table": {"table": {"speed_kn": [6, 12]}}}
    if calm_water == "table":
        speeds["table"]["table"]["power_kw"] = [500, 4000]
    ship = Ship.from_dict({**data, **speeds[calm_water]})
    hotel = 200 * 210 / 3.6e6
    assert ship.tabulate_fuel().parts[0].values == pytest.approx(
        [500 * 180 / 3.6e6 + hotel, 4000 * 180 / 3.6e6 + hotel]
    )
    between = ship.with_speeds([9.0 * 1852 / 3600]).tabulate_fuel().parts[0].values
    expected = 4000 * 0.75**3 if calm_water == "cubic" else 2250
    assert between == pytest.approx([expected * 180 / 3.6e6 + hotel])


def test_fuel_that_is_given_is_the_whole_ships():
    ship = Ship.from_dict(
        {
            "name": "known fuel",
            "hull": {"draught_m": 5.0},
            "speeds_kn": [6, 12],
            "fuel": {"reference_t_per_day": 10.0},
            "engine": {"hotel_load_kw": 100},
        }
    )
    hotel = 100 * 195 / 3.6e6
    # at 6 kn it was 1250 kg, below what the hotel load and the engines take
    slow = 0.125 * (10000.0 - hotel * DAY) + hotel * DAY
    assert slow == pytest.approx(1659.5)
    assert ship.tabulate_fuel().parts[0].values * DAY == pytest.approx([slow, 10000.0])
    again = ship.with_speeds(np.array([3.0, 6.0, 12.0]) * KNOT).tabulate_fuel().parts[0].values
    assert again[1:] * DAY == pytest.approx([slow, 10000.0])
    assert again[0] > ship.waiting_fuel_rate == pytest.approx(hotel)


def test_given_fuel_in_weather_keeps_the_hotel_load_at_every_power():
    data = {
        "name": "known fuel in waves",
        "hull": DATA["hull"],
        "speeds_kn": [6, 12],
        "fuel": {"reference_t_per_day": 20.0},
        "engine": {
            "reference_speed_kn": 12.0, "reference_power_kw": 4000.0, "hotel_load_kw": 200.0,
        },
        "models": {"calm_water": "cubic", "waves": "stawave_1"},
    }  # fmt: skip
    ship = Ship.from_dict(data)
    calm = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0}
    at = Conditions(calm | {"wave_period": 8.0})
    hotel = 200 * 195 / 3.6e6 * DAY
    found = ship.fuel_rate(at, np.array([0, 1])) * DAY
    assert found == pytest.approx([0.125 * (20000.0 - hotel) + hotel, 20000.0], rel=1e-3)


def test_fuel_in_a_table_is_the_whole_ships_in_each_row():
    table = {"speed_kn": [6, 12], "fuel_t_per_day": [2.0, 10.0]}
    ship = Ship.from_dict(
        {"name": "t", "hull": {"draught_m": 5.0}, "table": table, "engine": {"hotel_load_kw": 100}}
    )
    assert ship.tabulate_fuel().parts[0].values * DAY == pytest.approx([2000.0, 10000.0])
    assert ship.waiting_fuel_rate * DAY == pytest.approx(468.0)


def test_a_hotel_load_beyond_the_given_fuel_is_refused():
    data = {"name": "t", "hull": {"draught_m": 5.0}, "speeds_kn": [8]}
    fuel = {"reference_t_per_day": 0.4}
    with pytest.raises(InputError, match=r"0.4 t a day, and its hotel load takes 0.468 t"):
        Ship.from_dict({**data, "fuel": fuel, "engine": {"hotel_load_kw": 100}})


@pytest.mark.parametrize(
    "ship",
    [
        Ship.simple(speed_kn=8.0, draught_m=5.0),
        Ship.from_speed_function(lambda c: 6.0 - 0.2 * c.wave_height),
        Ship.from_speed_function(lambda c: 4.0 + 0.0 * c.lat, top_speed=4.0),
    ],
    ids=["speeds only", "function", "field"],
)
def test_ships_without_a_fuel_model_say_so(ship):
    with pytest.raises(InputError, match="cannot be tabulated") as refusal:
        ship.tabulate_fuel()
    assert "fuel model" in str(refusal.value)


def test_fuels_of_different_engines_are_not_mixed_up_on_disk(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    residual, distillate = _held(), _held(fuel={"type": "mdo"})
    calm = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0}
    heavy = float(residual.tabulate_fuel().lookup(calm, 1))
    light = float(distillate.tabulate_fuel().lookup(calm, 1))
    assert light / heavy == pytest.approx(165 / 175, rel=1e-5)
    assert residual.fingerprint() != distillate.fingerprint()


@dataclass
class PluginModel:
    """A third-party model that knows its fuel but does not tabulate it."""

    reads = frozenset({"wave_height"})
    identity = MappingProxyType({"kind": "plug-in"})

    def speeds(self, load_factor):
        return np.array([5.0, 6.0])

    def fuel_rate(self, conditions, setting):
        return np.array([0.2, 0.4])[setting] * (1.0 + 0.01 * conditions["wave_height"] ** 2)

    def tabulate(self, load_factor, tolerance):
        return (constant_part(self.speeds(load_factor)),), TableError(0.0, 0.0, 0.0)


def test_models_of_others_are_tabulated_over_what_they_read():
    table = Ship("plug-in", PluginModel(), Loading(5.0, 5.0)).tabulate_fuel(tolerance=0.002)
    assert table.axes == {"wave_height"}
    assert table.error.p99 <= 0.002
    expected = 0.4 * (1 + 0.01 * 3.3**2)
    assert float(table.lookup({"wave_height": 3.3}, 1)) == pytest.approx(expected, rel=0.003)


# power


def test_a_table_of_power_has_the_hotel_load_in_it():
    ship = _held(engine={**DATA["engine"], "hotel_load_kw": 300})
    table, c = ship.tabulate_power(), _draws(1500, 11)
    assert ship.hotel_power == 300e3 and _held().hotel_power == 0.0
    true = np.stack([ship.power(c, k) + 300e3 for k in range(3)], axis=-1)
    found = np.stack([table.lookup(c, k) for k in range(3)], axis=-1)
    error = np.abs(found - true) / np.maximum(true, 0.25 * true.max(axis=0))
    assert np.quantile(error, 0.99) < 0.01
    assert (true.max(axis=0) > 1.3 * true.min(axis=0)).all()


def test_ordered_or_known_power_is_constant_plus_the_hotel_load():
    engine = {**DATA["engine"], "hotel_load_kw": 200}
    ordered = Ship.from_dict({**DATA, "powers_kw": [3600, 7650], "engine": engine})
    known = Ship.from_dict(
        {
            "name": "known",
            "hull": {"draught_m": 5.0},
            "table": {"speed_kn": [6, 12], "power_kw": [500, 4000]},
            "engine": {"hotel_load_kw": 200},
            "models": {"calm_water": "table"},
        }
    )
    for ship, brake in ((ordered, (3600, 7650)), (known, (500, 4000))):
        table = ship.tabulate_power()
        assert table.axes == frozenset()
        for setting, kw in enumerate(brake):
            assert float(table.lookup({}, setting)) == pytest.approx(1e3 * (kw + 200), rel=1e-6)


def test_power_and_fuel_are_what_each_is_alone():
    c = _draws(20, 5)
    for ship in (_held(), Ship.load("handysize-bulker")):
        power, fuel = ship.power_and_fuel(c, 1)
        assert np.array_equal(power, ship.power(c, 1), equal_nan=True)
        assert np.array_equal(fuel, ship.fuel_rate(c, 1), equal_nan=True)


def test_ships_of_unknown_power_say_so():
    for ship in (
        Ship.simple(speed_kn=8.0),
        Ship.from_speed_function(lambda c: 6.0 - c.wave_height),
    ):
        with pytest.raises(InputError, match="brake power is unknown") as refusal:
            ship.tabulate_power()
        assert "reference_power_kw" in refusal.value.possible


def test_a_plug_in_of_known_power_is_tabulated_over_what_it_reads():
    class Powered(PluginModel):
        def power(self, conditions, setting):
            return 1e6 * (1.0 + 0.1 * conditions["wave_height"]) + 0.0 * np.asarray(setting)

    table = Ship("plug-in", Powered(), Loading(5.0, 5.0)).tabulate_power()
    assert float(table.lookup({"wave_height": 3.0}, 0)) == pytest.approx(1.3e6, rel=1e-3)
