"""Particulars of a ship file: each counts, two of three give the third, and contradictions are
refused."""

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship
from thalweg.ship.hull.hull import complete_hull
from thalweg.ship.performance_sheet import performance_sheet

HULL = {
    "length_between_perpendiculars_m": 120.0,
    "breadth_m": 18.0,
    "draught_m": 7.0,
    "block_coefficient": 0.72,
}
CALM = {
    **{"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0},
    **{"wave_period": 9.0, "depth": np.inf},
}


def _data(hull=None, method="holtrop_1984", **sections):
    kept = {key: value for key, value in {**HULL, **(hull or {})}.items() if value is not None}
    return {"name": "x", "hull": kept, "models": {"calm_water": method}, **sections}


def _ship(hull=None, method="holtrop_1984", **sections):
    return Ship.from_dict(_data(hull, method, **sections))


def _estimates(ship):
    return {one.key: (one.value, one.method) for one in ship.estimated}


def _drag(ship, part="total"):
    return float(ship.resistance(Conditions(CALM), 6.0)[part])


@pytest.mark.parametrize(
    ("given", "ends"),
    [
        ({"draught_m": 7.0}, (7.0, 7.0)),
        ({"draught_m": 7.0, "draught_fore_m": 6.0}, (6.0, 8.0)),
        ({"draught_m": 7.0, "draught_aft_m": 7.5}, (6.5, 7.5)),
        ({"draught_fore_m": 6.0}, (6.0, 6.0)),
        ({"draught_fore_m": 6.0, "draught_aft_m": 8.0}, (6.0, 8.0)),
    ],
)
def test_two_of_three_draughts_give_the_third(given, ends):
    values = complete_hull(given).values
    assert (values["draught_fore_m"], values["draught_aft_m"]) == ends
    assert values["draught_m"] == pytest.approx(sum(ends) / 2)


@pytest.mark.parametrize(
    ("hull", "sections", "words"),
    [
        ({"draught_fore_m": 5.0, "draught_aft_m": 9.0, "depth_m": 8.0}, {}, "draught of 9 m"),
        ({"depth_m": 8.0}, {"loading": {"draught_full_m": 9.0}}, "loading.draught_full_m"),
        ({"draught_m": 7.0, "draught_fore_m": 16.0}, {}, "not the mean of fore and aft"),
        ({"displacement_t": 20000.0, "displacement_m3": 11000.0}, {}, "do not fit"),
        ({"prismatic_coefficient": 0.5}, {}, "C_P is C_B / C_M"),
        ({"prismatic_coefficient": 0.9, "midship_coefficient": 0.95}, {}, "C_P is C_B / C_M"),
        ({"breadth_m": 80.0, "length_between_perpendiculars_m": 18.0}, {}, "swapped"),
        ({"draught_m": 0.0}, {}, "draught_m. is 0"),
        ({}, {"loading": {"draught_full_m": 7.0, "draught_empty_m": 0.0}}, "draught_empty_m. is 0"),
        ({}, {"loading": {"draught_full_m": 7.0, "weight_full_t": 9000.0}}, "by 'loading' and"),
        ({}, {"loading": {"draught_empty_m": 0.1}}, "displace nothing"),
        ({}, {"speeds_kn": [10, 10.0]}, "a speed twice"),
        ({}, {"engine": {"power_kw": 5000, "least_load": 0.9, "largest_load": 0.5}}, "least load"),
    ],
)
def test_contradictory_particulars_are_refused(hull, sections, words):
    with pytest.raises(InputError, match=words):
        _ship(hull, **sections)


def test_the_prismatic_coefficient_replaces_midship_or_block():
    estimates = _estimates(_ship({"prismatic_coefficient": 0.75}))
    assert estimates["midship_coefficient"] == (pytest.approx(0.96), "C_B over C_P")
    estimates = _estimates(
        _ship(
            {"block_coefficient": None, "prismatic_coefficient": 0.75, "midship_coefficient": 0.96}
        )
    )
    assert estimates["block_coefficient"] == (pytest.approx(0.72), "C_P C_M")
    same = {"midship_coefficient": 0.96}
    assert _drag(_ship({"prismatic_coefficient": 0.75})) == pytest.approx(_drag(_ship(same)))


def test_the_height_of_a_bulb_is_estimated_from_its_area():
    estimates = _estimates(_ship({"bulb_area_m2": 12.0}))
    assert estimates["bulb_centre_height_m"] == (pytest.approx(2.8), "Rakke (2016)")
    assert _estimates(_ship())["bulb_area_m2"] == (0.0, "taken as no bulb")


def test_shapes_that_are_not_given_are_listed():
    estimates = _estimates(_ship({"appendage_area_m2": 20.0}))
    assert estimates["stern_shape"][0] == "normal" and estimates["appendage_factor"][0] == 1.5
    angle = estimates["half_entrance_angle_deg"][0]
    assert 5.0 < angle < 60.0
    stated = {"half_entrance_angle_deg": angle, "stern_shape": 0, "appendage_factor": 1.5}
    again = _ship({"appendage_area_m2": 20.0, **stated})
    assert not {"stern_shape", "appendage_factor", "half_entrance_angle_deg"} & {*_estimates(again)}
    assert _drag(again) == pytest.approx(_drag(_ship({"appendage_area_m2": 20.0})), rel=1e-12)


def test_a_full_draught_other_than_the_hulls_is_the_draught_of_the_resistance():
    shallow = _ship(loading={"draught_full_m": 5.0})
    emptied = _ship(loading={"draught_full_m": 7.0, "draught_empty_m": 5.0}).with_load_factor(0.0)
    assert shallow.draught == emptied.draught == 5.0
    assert _drag(shallow) == pytest.approx(_drag(emptied), rel=1e-12)
    assert _drag(shallow) < 0.9 * _drag(_ship())
    hull = emptied.model.balance(0.0).calm.hull
    assert shallow.loading.displacement == pytest.approx(hull.values["displacement_m3"])
    block = 1.0 - 0.28 * (7.0 / 5.0) ** (1.0 / 3.0)
    assert hull.values["displacement_m3"] == pytest.approx(block * 120 * 18 * 5)
    assert _estimates(emptied)["loading.displacement_empty_m3"][0] == pytest.approx(
        hull.values["displacement_m3"]
    )


def test_an_empty_ship_with_known_speeds_is_no_fuller_than_its_box():
    data = {"name": "x", "hull": HULL, "speeds_kn": [12.0], "loading": {"draught_empty_m": 3.0}}
    ship = Ship.from_dict(data).with_load_factor(0.0)
    block = 1.0 - 0.28 * (7.0 / 3.0) ** (1.0 / 3.0)
    assert ship.loading.displacement == pytest.approx(block * 120 * 18 * 3)
    row = performance_sheet(ship, {"depth": 9.0})["conditions"][0]
    speed = 12.0
    section = 18 * 3 / (9 * 18 * 9.0 - 18 * 3)
    squat = block * section ** (2.0 / 3.0) * speed**2.08 / 30.0
    assert row["squat"]["squat_m"] == pytest.approx(squat, rel=1e-6)
    assert "loading.displacement_empty_m3" in _estimates(ship)
    bare = {**data, "hull": {"draught_m": 7.0, "displacement_m3": 7000.0}}
    assert Ship.from_dict(bare).with_load_factor(0.0).loading.displacement == pytest.approx(3000.0)


def test_a_weight_belongs_to_the_draught_of_the_loading():
    loading = {"draught_full_m": 6.0, "weight_full_t": 9000.0}
    hull = _ship({"block_coefficient": None}, loading=loading).model.balance(1.0).calm.hull
    assert hull.values["draught_m"] == 6.0
    assert hull.values["block_coefficient"] == pytest.approx(9000 / 1.025 / (120 * 18 * 6))


def test_a_hull_without_resistance_when_empty_is_refused_on_use():
    light = {"draught_full_m": 7.0, "draught_empty_m": 2.0}
    ship = _ship({"block_coefficient": 0.6, "midship_coefficient": 0.75}, loading=light)
    with pytest.raises(InputError, match="no resistance for this hull at load factor 0"):
        ship.with_load_factor(0.0).resistance(Conditions(CALM), 6.0)


def test_no_rudder_is_none():
    twin = {"propellers": 2, "propeller_diameter_m": 4.0}
    area = {"wetted_surface_m2": 3000.0}

    def residuary(**rudders):
        return _drag(
            _ship({**area, **rudders}, "hollenbach_1998_mean", propulsion=twin), "residuary"
        )

    assert residuary(rudders=0) / residuary(rudders=1) == pytest.approx(2.0**0.1258)
    assert residuary() == residuary(rudders=1)
    assert "rudders" in _estimates(_ship(area, "hollenbach_1998_mean", propulsion=twin))


@pytest.mark.parametrize(
    "others",
    [
        {},
        {"open_water_efficiency": 0.6, "hull_efficiency": 1.1},
        {"wake_fraction": 0.3, "thrust_deduction": 0.2},
    ],
)
def test_the_efficiency_of_all_goes_before_its_parts(others):
    data = _data(propulsion={"propulsive_efficiency": 0.7, **others}, speeds_kn=[12])
    ship = Ship.from_dict(data)
    power = float(ship.power_at_speed(Conditions(CALM), 6.0))
    assert power == pytest.approx(_drag(ship) * 6.0 / (0.7 * 0.98 * 0.96))
    assumed = performance_sheet(ship)["assumed"]
    assert assumed == [f"propulsion.{key} is not used" for key in sorted(others, key=file_order)]


def file_order(key):
    order = ("open_water_efficiency", "hull_efficiency", "wake_fraction", "thrust_deduction")
    return order.index(key)


def test_wake_without_thrust_deduction_is_reported():
    assert performance_sheet(_ship(propulsion={"wake_fraction": 0.3}))["assumed"] == [
        "propulsion.wake_fraction is not used"
    ]
    both = {"wake_fraction": 0.3, "thrust_deduction": 0.2}
    ship = _ship(propulsion=both)
    assert performance_sheet(ship)["assumed"] == []
    power = float(ship.power_at_speed(Conditions(CALM), 6.0))
    eta = 0.6 * 0.98 * (0.8 / 0.7) * 0.98 * 0.96
    assert power == pytest.approx(_drag(ship) * 6.0 / eta)


def test_loads_beyond_an_engines_curve_are_reported():
    curve = {"sfoc_load": [0.5, 1.0], "sfoc_curve_g_per_kwh": [190, 180]}
    ship = _ship(engine={"power_kw": 20000, **curve})
    notes = performance_sheet(ship, speeds_kn=[12])["conditions"][0]["warnings"]
    assert len(notes) == 1 and notes[0].endswith("outside 0.5 to 1")
    over = performance_sheet(ship, speeds_kn=[24])["conditions"][0]["warnings"]
    assert not [note for note in over if note.startswith("sfoc")]


def test_settings_that_were_not_given_are_loads_the_engine_has():
    ship = _ship(engine={"power_kw": 4000, "count": 2, "least_load": 0.6})
    assert ship.model.orders.values == pytest.approx([3.2e6, 4.4e6, 5.6e6, 6.8e6])


def test_numbers_may_be_numpys():
    ship = _ship({"breadth_m": np.int64(18)}, speeds_kn=list(np.arange(10, 13)))
    assert len(ship.speeds) == 3


def test_motions_are_those_at_the_draught_of_the_ship():
    emptied = {"draught_full_m": 7.0, "draught_empty_m": 4.0, "displacement_empty_m3": 5000.0}
    data = {"name": "x", "hull": HULL, "speeds_kn": [12.0], "loading": emptied}
    weather = {"wave_height": 3.0, "wave_angle": 0.3}
    light = Ship.from_dict(data).with_load_factor(0.0)
    block = 5000.0 / (120 * 18 * 4)
    same = {**HULL, "draught_m": 4.0, "block_coefficient": block}
    drawn = Ship.from_dict({"name": "x", "hull": same, "speeds_kn": [12.0]})
    found, wanted = (
        performance_sheet(ship, weather)["conditions"][0]["motions"] for ship in (light, drawn)
    )
    assert found == pytest.approx(wanted)
    full = performance_sheet(Ship.from_dict(data), weather)["conditions"][0]["motions"]
    assert found["significant_heave_m"] != pytest.approx(full["significant_heave_m"], rel=0.01)


def test_settings_keep_the_empty_speeds_they_were_given_with():
    loading = {"draught_full_m": 6.0, "draught_empty_m": 3.0}
    loading |= {"speeds_full_kn": [10.0, 12.0], "speeds_empty_kn": [12.0, 13.0]}
    ship = Ship.from_dict({"name": "x", "loading": loading})
    same = ship.with_speeds(ship.speeds)
    assert same.with_load_factor(0.0).speeds == pytest.approx(ship.with_load_factor(0.0).speeds)
    slower = ship.with_speeds(0.5 * ship.speeds)
    assert slower.with_load_factor(0.0).speeds / KNOT == pytest.approx([6.0, 7.2])


def test_a_ragged_table_is_refused_by_every_law():
    table = {"speed_kn": [8, 12, 16], "power_kw": [100, 800]}
    data = {"name": "x", "hull": {"draught_m": 5}, "speeds_kn": [8], "table": table}
    with pytest.raises(InputError, match="power_kw has another length"):
        Ship.from_dict({**data, "models": {"calm_water": "cubic"}})


@pytest.mark.parametrize("word", ["bulk carrier", "Bulk Carrier", "bulk-carrier"])
def test_the_type_of_ship_is_read_as_it_is_written(word):
    data = {
        "name": "x",
        "hull": {"draught_m": 9.0, "type": word, "deadweight_t": 30000},
        "table": {"speed_kn": [12], "fuel_t_per_day": [20]},
        "fuel": {"type": "HFO"},
    }
    cii = performance_sheet(Ship.from_dict(data))["conditions"][0]["cii"]
    attained = 20e6 / 24 * 3.114 / (30000 * 12)
    assert cii["attained_g_per_t_nm"] == pytest.approx(attained)
    assert cii["required_2026"] == pytest.approx(0.89 * 4745 * 30000**-0.622)


def test_a_field_of_speeds_has_no_sheet():
    with pytest.raises(InputError, match="field of place and time"):
        performance_sheet(Ship.from_speed_function(lambda at: 5.0 + 0.0 * at.lat))


def test_a_missing_ballast_line_is_reported():
    twin = {"propellers": 2, "propeller_diameter_m": 4.0}
    ballast = {"condition": "ballast"}
    estimates = _estimates(_ship({}, "hollenbach_1998_mean", propulsion=twin, loading=ballast))
    assert estimates["loading.condition"][0] == "twin_design"
    single = _ship({}, "hollenbach_1998_mean", loading=ballast)
    assert "loading.condition" not in _estimates(single)


def test_a_load_factor_without_effect_is_reported():
    empty = performance_sheet(_ship().with_load_factor(0.5))["assumed"]
    assert empty == [
        "load factor 0.5 has no effect: the ship file does not describe the empty ship"
    ]
    assert performance_sheet(_ship())["assumed"] == []
    ship = _ship(loading={"draught_empty_m": 5.0})
    assert performance_sheet(ship.with_load_factor(0.5))["assumed"] == []


def test_a_lighter_hull_has_the_same_trim_and_less_wetted_surface():
    hull = {"draught_fore_m": 6.0, "draught_aft_m": 8.0, "wetted_surface_m2": 3000.0}
    hull |= {"length_waterline_m": 122.0}
    loading = {"draught_full_m": 7.0, "draught_empty_m": 5.0, "displacement_empty_m3": 7200.0}
    afloat = _ship(hull, loading=loading).model.balance(0.0).calm.hull.values
    assert (afloat["draught_fore_m"], afloat["draught_aft_m"]) == (4.0, 6.0)
    full = 0.72 * 120 * 18 * 7  # S of Denny and Mumford is 1.7 L T + volume / T
    change = 1.7 * 122.0 * (5.0 - 7.0) + 7200.0 / 5.0 - full / 7.0
    assert afloat["wetted_surface_m2"] == pytest.approx(3000.0 + change)


def test_the_wake_is_that_of_the_draught_at_the_propeller():
    screw = {"propeller_diameter_m": 4.5, "propeller_pitch_ratio": 0.8}
    screw |= {"propeller_blades": 4, "propeller_area_ratio": 0.6}
    models = {"calm_water": "holtrop_1984", "propulsion": "wageningen_b"}

    def wake(**ends):
        ship = Ship.from_dict({**_data(ends, propulsion=screw), "models": models})
        return _estimates(ship)["wake_fraction"][0]

    even, trimmed = wake(), wake(draught_fore_m=6.2, draught_aft_m=7.8)
    assert even == wake(draught_fore_m=7.0, draught_aft_m=7.0)
    assert abs(trimmed / even - 1.0) > 0.01


def test_an_empty_displacement_that_is_given_asks_for_no_other():
    loading = {"draught_full_m": 7.0, "draught_empty_m": 0.1, "weight_empty_t": 102.5}
    data = {"name": "x", "hull": HULL, "speeds_kn": [12.0], "loading": loading}
    assert Ship.from_dict(data).with_load_factor(0.0).loading.displacement == pytest.approx(100.0)


def test_speeds_above_the_greatest_of_a_ship_with_known_speeds_are_reported():
    """The power of 25 kn by the cubic law, nine times that of the engines, had no warning."""
    ship = Ship.from_dict(
        {
            "name": "coaster",
            "hull": {"length_between_perpendiculars_m": 80, "breadth_m": 13, "draught_m": 5},
            "engine": {"reference_speed_kn": 12, "reference_power_kw": 1500},
            "speeds_kn": [8, 12],
        }
    )
    over, within = performance_sheet(ship, speeds_kn=[25, 12])["conditions"][::-1]
    assert over["warnings"] == ["above the greatest speed of the ship, 12 kn"]
    assert within["warnings"] == []
