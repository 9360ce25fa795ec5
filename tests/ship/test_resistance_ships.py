"""Ships composed from named methods: balance of power, components, estimates, and refusals."""

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship

HULL = {
    "length_waterline_m": 172.42,
    "length_between_perpendiculars_m": 169.0,
    "breadth_m": 32.0,
    "draught_m": 10.0,
    "block_coefficient": 0.785,
    "frontal_area_m2": 700.0,
    "lateral_area_m2": 1800.0,
}
MODELS = {
    "calm_water": "holtrop_1984",
    "waves": "stawave_1",
    "wind": "blendermann_1994",
    "wind_type": "tanker_loaded",
}
CALM = {
    "wind_speed": 0.0,
    "wind_angle": 0.0,
    "wave_height": 0.0,
    "wave_angle": 0.0,
    "wave_period": 9.0,
}


def _ship(models=None, hull=None, **sections):
    data = {
        "name": "composed",
        "hull": {k: v for k, v in {**HULL, **(hull or {})}.items() if v is not None},
        "engine": {"power_kw": 9000, "type": "slow_speed_diesel"},
        "fuel": {"type": "hfo"},
        "powers_kw": [3600, 7650],
        "models": {k: v for k, v in {**MODELS, **(models or {})}.items() if v is not None},
    }
    data.update(sections)
    return Ship.from_dict({key: value for key, value in data.items() if value is not None})


@pytest.fixture(scope="module")
def ship():
    return _ship()


@pytest.mark.slow
@given(
    st.floats(0, 25),
    st.floats(0, np.pi),
    st.floats(0, 6),
    st.floats(0, np.pi),
    st.integers(0, 1),
)
@settings(max_examples=60)
def test_at_the_attained_speed_the_power_is_the_ordered_one(wind, blows, height, runs, setting):
    ship = _shared()
    c = Conditions(wind_speed=wind, wind_angle=blows, wave_height=height, wave_angle=runs)
    speed = ship.speed_through_water(c, setting)
    assert float(ship.power_at_speed(c, speed)) == pytest.approx([3.6e6, 7.65e6][setting], rel=1e-4)
    assert float(ship.power(c, setting)) == pytest.approx([3.6e6, 7.65e6][setting], rel=1e-4)


@given(st.floats(0, 25), st.floats(0, 6), st.floats(0, np.pi))
@settings(max_examples=40)
def test_weather_from_ahead_is_slowest(wind, height, angle):
    ship = _shared()
    at = {"wind_speed": wind, "wave_height": height}
    ahead = ship.speed_through_water(Conditions(**at, wind_angle=0.0, wave_angle=0.0))
    other = ship.speed_through_water(Conditions(**at, wind_angle=angle, wave_angle=angle))
    # a wind curve may have its top off the bow: no more than a few per cent above
    assert float(ahead) <= float(other) * 1.03 + 1e-6


@functools.cache
def _shared():
    return _ship()


def test_without_weather_the_speed_is_the_calm_one(ship):
    found = ship.speed_through_water(Conditions(**CALM), np.array([0, 1]))
    assert found == pytest.approx(ship.speeds, rel=1e-6)
    assert 9.0 < ship.speeds[0] / KNOT < ship.speeds[1] / KNOT < 16.0


def test_resistance_components_add_up(ship):
    c = Conditions(**{**CALM, "wind_speed": 12.0, "wave_height": 3.0})
    parts = ship.resistance(c, np.array([0.0, 4.0, 7.0]))
    total = parts.pop("total")
    assert sum(parts.values()) == pytest.approx(total)
    assert parts["friction"][0] == 0.0
    assert (parts["waves"] > 0).all() and (parts["wind"] > 0).all()
    assert (parts["shallow"] == 0).all() and (parts["rudder"] == 0).all()
    # STAwave-1 by hand: 1/16 rho g Hs^2 B sqrt(B / L_BWL), with L_BWL = 0.15 L_PP estimated
    by_hand = 1025 * 9.80665 * 9 / 16 * 32 * np.sqrt(32 / (0.15 * 169))
    assert parts["waves"] == pytest.approx([by_hand] * 3, rel=1e-6)


def test_power_is_resistance_times_speed_over_efficiency(ship):
    c = Conditions(**CALM)
    total = ship.resistance(c, 7.0)["total"]
    efficiency = 0.60 * 0.98 * 1.0 * 0.98  # a slow-speed engine has no gear
    assert float(ship.power_at_speed(c, 7.0)) == pytest.approx(float(total) * 7.0 / efficiency)


def test_fuel_follows_the_engine_and_the_hotel_load():
    ship = _ship(engine={"power_kw": 9000, "sfoc_g_per_kwh": 170, "hotel_load_kw": 300})
    load = 7650 / 9000
    factor = 0.455 * load**2 - 0.710 * load + 1.280
    expected = (7650 * 170 * factor + 300 * 195) / 3.6e6
    assert float(ship.fuel_rate(Conditions(**CALM), 1)) == pytest.approx(expected, rel=1e-4)


def test_without_an_engine_fuel_is_unknown():
    ship = _ship(engine=None)
    assert np.isnan(ship.fuel_rate(Conditions(**CALM), 1))
    assert np.isfinite(ship.power(Conditions(**CALM), 1))


def test_what_was_estimated_is_listed_with_its_method(ship):
    found = {e.key: e for e in ship.estimated}
    assert found["displacement_m3"].value == pytest.approx(0.785 * 169 * 32 * 10)
    assert "Holtrop" in found["wetted_surface_m2"].method
    assert found["transom_area_m2"].value == 0.0
    assert found["engine.sfoc_g_per_kwh"].value == 175
    assert {"midship_coefficient", "waterplane_coefficient", "lcb_percent"} <= found.keys()
    assert "breadth_m" not in found


def test_ordered_speeds_are_held_until_the_engine_is_spent():
    ship = _ship(powers_kw=None, speeds_kn=[10, 13])
    calm, storm = Conditions(**CALM), Conditions(**{**CALM, "wave_height": 6.0})
    assert float(ship.speed_through_water(calm, 1)) == pytest.approx(13 * KNOT)
    assert float(ship.power(calm, 1)) < 9e6
    assert float(ship.speed_through_water(storm, 1)) < 12 * KNOT
    assert float(ship.power(storm, 1)) == pytest.approx(9e6, rel=1e-4)
    assert float(ship.power(storm, 0)) > float(ship.power(calm, 0))
    table = ship.tabulate()
    assert float(table.lookup(storm, 1)) == pytest.approx(
        float(ship.speed_through_water(storm, 1)), rel=0.01
    )


def test_a_propeller_of_the_b_series_takes_the_place_of_efficiencies():
    screw = {
        "propeller_diameter_m": 6.0,
        "propeller_pitch_ratio": 0.75,
        "propeller_blades": 4,
        "propeller_area_ratio": 0.55,
    }
    ship = _ship({"propulsion": "wageningen_b"}, propulsion=screw)
    found = {e.key: e.value for e in ship.estimated}
    assert 0.15 < found["wake_fraction"] < 0.45
    assert 0.10 < found["thrust_deduction"] < 0.30
    c = Conditions(**CALM)
    effective = float(ship.resistance(c, 7.0)["total"]) * 7.0
    assert 0.55 < effective / float(ship.power_at_speed(c, 7.0)) < 0.85
    with pytest.raises(InputError, match="propeller_pitch_ratio, propeller_area_ratio"):
        _ship({"propulsion": "wageningen_b"}, propulsion={"propeller_diameter_m": 6.0})


def test_an_emptier_ship_is_faster_at_the_same_power():
    ship = _ship(loading={"draught_full_m": 10.0, "draught_empty_m": 7.0})
    empty = ship.with_load_factor(0.0)
    assert empty.draught == 7.0
    assert empty.speeds[1] > 1.02 * ship.speeds[1]
    both = ship.speed_through_water(Conditions(**CALM, load_factor=[0.0, 1.0, 2.0]), 1)
    assert both[:2] == pytest.approx([empty.speeds[1], ship.speeds[1]], rel=1e-6)
    assert np.isnan(both[2])


def test_ordered_calm_speeds_of_a_power_ship_are_met():
    ship = _ship().with_speeds(np.array([10.0, 12.0]) * KNOT)
    assert (ship.speeds / KNOT).tolist() == pytest.approx([10.0, 12.0], rel=1e-5)
    with pytest.raises(InputError, match="cannot be ordered to 25 kn"):
        _ship().with_speeds(25.0 * KNOT)


def test_unknown_weather_gives_unknown_speed_and_power(ship):
    for name in ("wind_speed", "wind_angle", "wave_height", "wave_angle"):
        c = Conditions(**{**CALM, "wave_height": 2.0, name: np.nan})
        assert np.isnan(ship.speed_through_water(c)), name
        assert np.isnan(ship.fuel_rate(c)), name


def test_following_seas_push_only_if_requested():
    behind = Conditions(**{**CALM, "wave_height": 5.0, "wave_angle": 2.1})
    assert float(_ship({"waves": "snnm"}).resistance(behind, 3.0)["waves"]) == 0.0
    pushed = _ship({"waves": "snnm", "wave_push": True})
    assert float(pushed.resistance(behind, 3.0)["waves"]) < 0.0


def test_out_of_range_is_noted_and_refused_when_strict():
    small = {"length_waterline_m": 30.0, "length_between_perpendiculars_m": 29.0}
    hull = {**small, "breadth_m": 9.0, "draught_m": 2.5, "block_coefficient": 0.56}
    ship = _ship({"waves": "snnm"}, hull, engine=None, powers_kw=[400])
    rough = Conditions(**{**CALM, "wave_height": 2.0})
    quantities = {(note.method, note.quantity) for note in ship.notes(rough)}
    assert ("snnm", "length between perpendiculars") in quantities
    with pytest.raises(ModelRangeError, match="length between perpendiculars is 29"):
        ship.notes(rough, strict=True)


@pytest.mark.parametrize(
    ("models", "message"),
    [
        ({"calm_water": "holtrop1984"}, "Did you mean 'holtrop_1984'"),
        ({"waves": "stawave1"}, "Did you mean 'stawave_1'"),
        ({"wind": "fujiwara"}, "Did you mean 'fujiwara_2006'"),
        ({"wind_type": "tanker_load"}, "Did you mean 'tanker_loaded'"),
        ({"shallow_water": "karpow"}, "Did you mean 'karpov'"),
        ({"friction": "zeng"}, "Did you mean 'zeng_2019'"),
        ({"propulsion": "wageningen"}, "Did you mean 'wageningen_b'"),
        ({"rudder": "schless"}, "Did you mean 'schless_2023'"),
        ({"speed_loss": "kwon_2008"}, "together with models.waves and models.wind"),
        ({"wind": "fujiwara_2006"}, "superstructure_height_m"),
        ({"calm_water": "none"}, "no resistance they could act on"),
    ],
)
def test_methods_that_are_not_there_or_do_not_fit_are_refused(models, message):
    with pytest.raises(InputError, match=message):
        _ship(models)


def test_missing_particulars_are_named_with_a_remedy():
    bare = {"breadth_m": 32.0, "draught_m": 10.0}
    data = {
        "name": "x",
        "hull": bare,
        "powers_kw": [5000],
        "models": {"calm_water": "holtrop_1984"},
    }
    with pytest.raises(InputError, match=r"length_waterline_m.*choose another method"):
        Ship.from_dict(data)


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"powers_kw": [9500]}, "engines give 9000 kW"),
        ({"powers_kw": [5000, 5000]}, "a power twice"),
        ({"powers_kw": [0]}, "greater than 0"),
        ({"speeds_kn": [12]}, "both powers_kw and speeds_kn"),
        ({"engine": {"type": "steam"}}, "Did you mean 'steam_turbine'"),
        ({"fuel": {"type": "hffo"}}, "Did you mean 'hfo'"),
        ({"engine": {"sfoc_load": [0.5, 1.0]}}, "2 loads and 0 consumptions"),
        (
            {"engine": {"sfoc_load": [0.5, 1.0], "sfoc_curve_g_per_kwh": [180, 170]}},
            "no power_kw",
        ),
    ],
)
def test_engines_and_orders_that_cannot_be_are_refused(sections, message):
    with pytest.raises(InputError, match=message):
        _ship(**sections)


def test_hulls_of_two_lengths_are_refused():
    with pytest.raises(InputError, match="waterline is 100 m long"):
        _ship(hull={"length_waterline_m": 100.0, "block_coefficient": 0.5})


@pytest.mark.parametrize(
    ("hull", "message"),
    [
        ({"bulb_area_m2": 400.0}, "bulb's section of 400 m2 is larger than the midship section"),
        ({"transom_area_m2": 400.0}, "immersed transom of 400 m2 is larger"),
        ({"bulb_area_m2": 20.0, "bulb_centre_height_m": 11.0}, "centre of the bulb is 11 m above"),
        ({"wetted_surface_m2": 100.0}, "100 m2 is not that of a hull of"),
        ({"wetted_surface_m2": 50000.0}, "50000 m2 is not that of a hull of"),
        ({"length_over_surface_m": 50.0}, "surface under water is 50 m long"),
    ],
)
def test_hulls_that_cannot_be_are_refused(hull, message):
    with pytest.raises(InputError, match=message) as refusal:
        _ship(hull=hull)
    assert refusal.value.possible and refusal.value.remedy
    assert refusal.value.details["key"].removeprefix("hull.") in hull


@pytest.mark.parametrize("word", ["U", "u", "u_shaped", "U-shaped", 10])
def test_stern_shapes_are_words_or_numbers(word):
    stern = {"hull": {"stern_shape": word}}
    assert _ship(**stern).resistance(Conditions(CALM, depth=1e4), 7.0)["form_factor"] == (
        pytest.approx(
            _ship(hull={"stern_shape": 10.0}).resistance(Conditions(CALM, depth=1e4), 7.0)[
                "form_factor"
            ]
        )
    )
    with pytest.raises(InputError, match="Known: normal, pram, u"):
        _ship(hull={"stern_shape": "X"})


def test_shallow_water_by_friction_alone_and_by_printed_bands():
    at = Conditions({**CALM, "depth": 15.0})
    friction = _ship({"shallow_water": "zeng_2019"}).resistance(at, 6.0)
    assert friction["shallow"] == _ship({"friction": "zeng_2019"}).resistance(at, 6.0)["shallow"]
    assert friction["shallow"] > 0.0
    smooth = _ship({"shallow_water": "karpov"})
    bands = _ship({"shallow_water": "karpov_bands"})
    depths = Conditions({**CALM, "depth": np.array([17.4, 17.6])})
    step = np.diff(bands.resistance(depths, 7.0)["shallow"])[0]
    assert abs(step) > 5.0 * abs(np.diff(smooth.resistance(depths, 7.0)["shallow"])[0])
    middle = Conditions({**CALM, "depth": 20.0})
    assert float(bands.resistance(middle, 7.0)["shallow"]) == pytest.approx(
        float(smooth.resistance(middle, 7.0)["shallow"])
    )
    with pytest.raises(InputError, match="lackenby_1963"):
        _ship({"shallow_water": "lackenby"})


def test_the_ship_type_for_wind_follows_from_the_hull_and_is_reported():
    def estimated(**hull):
        ship = _ship({"wind_type": None}, hull=hull)
        return {e.key: e.value for e in ship.estimated}["models.wind_type"]

    assert estimated(type="crude oil tanker") == "tanker_loaded"
    assert estimated(type="LNG carrier") == "lng_tanker"
    assert estimated(type="ro_pax") == estimated(type="Ro-Pax") == "ferry"
    assert estimated() == estimated(type="harbour tug") == "cargo_loaded"
    unknown = _ship({"wind_type": None}, hull={"type": "harbour tug"}).estimated
    assert any("names no known type" in str(one) for one in unknown)
    assert "models.wind_type" not in {e.key for e in _ship().estimated}
    named = [_ship({"wind": name, "wind_type": "tanker_laden"}) for name in ("ittc", "iso_15016")]
    at = Conditions({**CALM, "wind_speed": 12.0, "depth": 1e4})
    assert named[0].resistance(at, 6.0)["wind"] == named[1].resistance(at, 6.0)["wind"]


def test_turbines_burn_the_same_at_every_load():
    ship = _ship(engine={"power_kw": 9000, "type": "steam_turbine"})
    at = Conditions({**CALM, "depth": 1e4})
    rates = ship.fuel_rate(at, np.array([0, 1])) / ship.power(at, np.array([0, 1]))
    assert rates[0] == pytest.approx(rates[1], rel=1e-3)


def test_power_that_falls_with_speed_is_refused(monkeypatch):
    ship = _ship(propulsion={"open_water_efficiency": 0.61})
    balance = ship.model.balance(1.0)
    dip = 7.0

    def power(speed, resistance):
        return np.maximum(speed, 0.0) ** 3 * 2e4 - 3e6 * np.exp(-((speed - dip) ** 2) / 0.1)

    object.__setattr__(balance.propulsion, "brake_power", power)
    with pytest.raises(ModelRangeError, match="power falls"):
        ship.tabulate()


def test_power_or_speed_of_a_ship_without_resistance_is_refused():
    ship = Ship.simple(8.0, 5.0)
    with pytest.raises(InputError, match="holtrop_1984"):
        ship.resistance(Conditions(**CALM), 4.0)
    with pytest.raises(InputError, match="holtrop_1984"):
        ship.power_at_speed(Conditions(**CALM), 4.0)


def test_two_engines_burn_what_the_cheaper_number_burns():
    ship = _ship(
        engine={"power_kw": 4500, "count": 2, "sfoc_g_per_kwh": 180}, powers_kw=[4000, 8000]
    )
    one, two = ship.fuel_rate(Conditions(**CALM), np.array([0, 1])) * 3.6e6
    load = 4000 / 4500
    factor = 0.455 * load**2 - 0.710 * load + 1.280
    assert one == pytest.approx(4000 * 180 * factor, rel=1e-3)
    load = 8000 / 9000
    factor = 0.455 * load**2 - 0.710 * load + 1.280
    assert two == pytest.approx(8000 * 180 * factor, rel=1e-3)


def test_fuels_and_prices_inside_and_outside_control_areas():
    terms = Ship.load("handysize-bulker").fuel_terms
    assert terms.price_outside == pytest.approx(0.300)
    assert terms.price_inside == pytest.approx(0.300 * 1.5593)
    assert terms.inside is terms.outside and terms.carbon_outside == pytest.approx(3.114)
    switched = _ship(
        fuel={"type": "hfo", "eca_type": "mgo", "price_per_t": 500, "eca_price_per_t": 800}
    ).fuel_terms
    assert switched.carbon_inside == pytest.approx(3.206)
    assert switched.price_inside == pytest.approx(0.8)
    with pytest.raises(InputError, match="given twice"):
        _ = _ship(fuel={"type": "hfo", "eca_price_per_t": 800, "eca_price_factor": 1.5}).fuel_terms


def test_a_hull_without_an_answer_is_refused_with_what_is_out_of_range():
    full = {"block_coefficient": 0.99, "midship_coefficient": 1.0, "waterplane_coefficient": 1.0}
    with pytest.raises(InputError, match=r"no resistance for this hull.*prismatic coefficient"):
        _ship(hull={**full, "length_waterline_m": 169.0})


def test_missing_particulars_come_with_the_regressions_that_could_supply_them():
    with pytest.raises(InputError, match=r"displacement_m3 follows from .*block_coefficient"):
        _ship(hull={"block_coefficient": None})


def test_speeds_beyond_the_engine_are_refused_when_the_file_is_read():
    with pytest.raises(InputError, match="The engines give 9000 kW"):
        _ship(powers_kw=None, speeds_kn=[10, 25])


def test_fuels_and_rudders_are_checked_when_the_file_is_read():
    with pytest.raises(InputError, match="no fuel named 'coal'"):
        _ship(fuel={"type": "coal"})
    with pytest.raises(InputError, match="needs rudder_area_m2"):
        _ship(models={"rudder": "schless_2023"})


def test_squat_of_a_ship_with_a_resistance_is_no_limit_of_speed():
    with pytest.raises(InputError, match=r"models\.shallow_water"):
        _ship(models={"squat": "van_halem_2019"})


def test_engine_types_are_words_and_fuels_they_cannot_burn_are_named():
    spoken = _ship(engine={"power_kw": 9000, "type": "Slow-speed Diesel"})
    at = Conditions({**CALM, "depth": 1e4})
    assert float(spoken.fuel_rate(at, 0)) == float(_ship().fuel_rate(at, 0))
    with pytest.raises(InputError, match="Give the engine's own sfoc_g_per_kwh"):
        _ship(fuel={"type": "lng"})
    with pytest.raises(InputError, match="Did you mean 'slow_speed_diesel'"):
        _ship(engine={"power_kw": 9000, "type": "slow_speed_disel"})


def test_a_slow_speed_engine_has_no_gear_unless_the_file_says_so():
    def gear(engine, **propulsion):
        ship = _ship(engine={"power_kw": 9000, "type": engine}, propulsion=propulsion)
        power = float(ship.power_at_speed(Conditions(**CALM), 7.0))
        estimated = [(e.value, e.method) for e in ship.estimated if e.key == "gear_efficiency"]
        return power, estimated

    slow, (direct,) = gear("slow_speed_diesel")
    geared, (usual,) = gear("medium_speed_diesel")
    given, none = gear("slow_speed_diesel", gear_efficiency=0.96)
    assert direct == (1.0, "no gear: slow-speed engines drive the propeller directly")
    assert usual == (0.96, "usual value, Schless (2023)") and none == []
    assert geared / slow == pytest.approx(1.0 / 0.96, rel=1e-9)
    assert given == pytest.approx(geared, rel=1e-9)
