"""Ship files: contents that are read, and messages for refused contents."""

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, KNOT
from thalweg.ship import Conditions, Ship, library_names
from thalweg.ship.performance_sheet import performance_sheet

CALM = Conditions(wind_speed=0.0, wind_angle=0.0)
GOOD = """
name: Test ship
hull: {length_between_perpendiculars_m: 120, breadth_m: 20, draught_m: 7, block_coefficient: 0.7}
table:
  - {speed_kn: 12, fuel_t_per_day: 14, power_kw: 3000}
  - {speed_kn: 10, fuel_t_per_day: 9, power_kw: 1900}
limits: {max_wind_speed_m_s: 20}
"""


def _write(folder, text):
    path = folder / "ship.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_table_of_rows_is_read_in_order_of_speed(tmp_path):
    ship = Ship.load(_write(tmp_path, GOOD))
    assert (ship.speeds / KNOT).tolist() == pytest.approx([10.0, 12.0])
    assert (ship.fuel_rate(CALM, [0, 1]) * DAY / 1000).tolist() == pytest.approx([9.0, 14.0])
    assert ship.power(CALM, [0, 1]).tolist() == pytest.approx([1.9e6, 3.0e6])
    assert ship.limits.wind_speed == 20.0


def test_a_ship_is_shown_in_one_line(tmp_path):
    assert repr(Ship.load(_write(tmp_path, GOOD))) == "<Ship 'Test ship': 10 to 12 kn, draught 7 m>"
    assert repr(Ship.simple()) == "<Ship 'simple ship': 8 kn, draught 5 m>"
    field = Ship.from_speed_function(lambda c: 2.0 + np.abs(c.lat), draught_m=2.0)
    assert repr(field).endswith(": speed by place, draught 2 m>")


def test_a_table_of_columns_is_the_same_ship(tmp_path):
    columns = GOOD.split("table:")[0] + (
        "table: {speed_kn: [10, 12], fuel_t_per_day: [9, 14], power_kw: [1900, 3000]}\n"
        "limits: {max_wind_speed_m_s: 20}\n"
    )
    other = Ship.load(_write(tmp_path, columns)).fingerprint()
    assert other == Ship.load(_write(tmp_path, GOOD)).fingerprint()


def test_between_rows_of_a_table_fuel_is_interpolated_and_beyond_refused(tmp_path):
    ship = Ship.load(_write(tmp_path, GOOD))
    middle = ship.with_speeds(11.0 * KNOT)
    assert float(middle.fuel_rate(CALM)) * DAY / 1000 == pytest.approx(11.5)
    with pytest.raises(InputError, match="10 to 12 kn"):
        ship.with_speeds(13.0 * KNOT)


def test_cubic_law_through_a_reference_power():
    ship = Ship.from_dict(
        {
            "name": "cube",
            "hull": {"draught_m": 6},
            "speeds_kn": [7, 14],
            "engine": {
                "reference_speed_kn": 14,
                "reference_power_kw": 8000,
                "sfoc_g_per_kwh": 180,
            },
            "models": {"calm_water": "cubic"},
        }
    )
    assert ship.power(CALM, [0, 1]).tolist() == pytest.approx([1.0e6, 8.0e6])
    assert ship.fuel_rate(CALM, [0, 1]).tolist() == pytest.approx([0.05, 0.4])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("hull:", "hul:"), "'hul' is not a key of a ship file.*Did you mean 'hull'"),
        (
            ("breadth_m", "bredth_m"),
            r"'bredth_m' is not a key of 'hull'.\s+Keys are: (\w+, ){19}\w+ and \d+ more",
        ),
        (("breadth_m", "beam_m"), "Did you mean 'breadth_m'"),
        (
            ("draught_m: 7", "draught_m: 7, length_m: 100"),
            "Did you mean 'length_between_perpendiculars_m' or 'length_overall_m'",
        ),
        (("speed_kn: 12", "speed_kn: .nan"), "table.speed_kn.*finite"),
        (("speed_kn: 12", "speed_kn: 0"), "table.speed_kn.*greater than 0"),
        (("speed_kn: 12", "speed_kn: -12"), "table.speed_kn.*greater than 0"),
        (("speed_kn: 12", "speed_kn: twelve"), "table.speed_kn.*a number"),
        (("speed_kn: 12", "speed_kn: true"), "table.speed_kn.*a number"),
        (("speed_kn: 12", "speed_kn: 10"), "speed is given twice"),
        (("fuel_t_per_day: 14", "fuel_t_per_day: 8"), "fuel_t_per_day falls from 9 to 8"),
        (("power_kw: 3000}", "engines: 1}"), "do not all have the same keys"),
        (("block_coefficient: 0.7", "block_coefficient: 1.2"), "block_coefficient.*at most 1"),
        (("draught_m: 7", "draught_m: 7, depth_m: 6"), "more than the depth"),
        (("draught_m: 7", "draught_m: 7, displacement_m3: 90000"), "times the box"),
        (("draught_m: 7", "draught_m: 7, displacement_m3: 9000"), "does not fit displacement_m3"),
        (("draught_m: 7", "draught_m: 7, midship_coefficient: 0.6"), "midship coefficient 0.6"),
        (("draught_m: 7", "draught_m: 7, draught_fore_m: 5, draught_aft_m: 6"), "mean of fore"),
        (("draught_m: 7, ", ""), "gives no draught"),
        (("name: Test ship", "description: none"), "has no name"),
        (("name: Test ship", "name: [1, 2]"), "'name' is a list"),
        (("max_wind_speed_m_s: 20", "max_wind_speed_m_s: 20, max_wind_speed_kn: 40"), "twice"),
        (("max_wind_speed_m_s: 20", "max_wind_speed_m_s: -1"), "max_wind_speed_m_s"),
        (
            ("name: Test ship", "name: Test ship\nloading: {speeds_full_kn: [10]}"),
            "table.speed_kn and loading.speeds_full_kn",
        ),
        (("name: Test ship", "name: Test ship\nname: Other"), "'name' is given twice"),
        (
            ("name: Test ship", "name: Test ship\nmodels: {calm_water: tabel}"),
            "Did you mean 'table'",
        ),
        (("limits:", "limits: &a\n  <<: *a\nlimts:"), "references"),
        (("limits: {", "limits: ["), "cannot be read .line"),
        (("name: Test ship", "name: !!python/object:os.system x"), "cannot be read .line 2"),
    ],
)
def test_faults_are_named(tmp_path, change, message):
    assert change[0] in GOOD
    with pytest.raises(InputError, match=f"(?s){message}"):
        Ship.load(_write(tmp_path, GOOD.replace(*change)))


@pytest.mark.parametrize(
    ("extra", "missing"),
    [
        ({}, "gives no speeds"),
        ({"models": {"calm_water": "cubic"}, "speeds_kn": [10]}, "no reference point"),
        ({"models": {"calm_water": "table"}, "speeds_kn": [10]}, "no table"),
        ({"speeds_kn": []}, "at least one number"),
        ({"loading": {"speeds_full_kn": [10, 11], "speeds_empty_kn": [12]}}, "2 speeds full and 1"),
        ({"loading": {"draught_full_m": 4, "draught_empty_m": 5}, "speeds_kn": [10]}, "as deep as"),
        ({"loading": {"weight_full_t": 4, "weight_empty_t": 5}, "speeds_kn": [10]}, "when empty"),
        ({"loading": {"load_factor": 1.2}, "speeds_kn": [10]}, "load_factor"),
        ({"table": {"speed_kn": [9, 10], "fuel_t_per_day": [4]}}, "fuel_t_per_day has another"),
        ({"engine": 7, "speeds_kn": [10]}, "'engine' holds 7"),
        ({"places": [{"name": "bridge", "ahead_m": 45}]}, "list of 1.*such as {bridge: 45.0, mess"),
        ({"places": 45.0}, "'places' holds 45.0. It holds names with distances ahead of midship"),
        ({"places": None}, "'places' has no value. It holds names with distances"),
        ({"tasks": [{"place": "mess"}]}, "'tasks' holds a list of 1. It holds names with keys"),
    ],
)
def test_incomplete_ships_are_refused(extra, missing):
    with pytest.raises(InputError, match=missing):
        Ship.from_dict({"name": "x", "hull": {"draught_m": 5}, **extra})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not keys with values"),
        ("just words", "not keys with values"),
        ("- 1\n- 2", "not keys with values"),
        ("[" * 5000, "cannot be read"),
        ("name: x\nhull: {a: 2020-13-45}", "is not a key|cannot be read"),
        ("? {a: b}\n: c\n", "cannot be read|not a key"),
    ],
)
def test_files_that_are_no_ships_are_refused(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        Ship.load(_write(tmp_path, text))


def test_binary_and_huge_files_are_refused(tmp_path):
    path = tmp_path / "ship.yaml"
    path.write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(InputError, match="UTF-8"):
        Ship.load(path)
    path.write_bytes(b"#" * 300_000)
    with pytest.raises(InputError, match="larger than"):
        Ship.load(path)
    with pytest.raises(InputError, match="cannot be read"):
        Ship.load(tmp_path / "none.yaml")
    with pytest.raises(InputError, match="cannot be read"):
        Ship.load(tmp_path)


def test_an_unknown_name_gets_near_matches():
    with pytest.raises(InputError, match="Did you mean 'handysize-bulker'"):
        Ship.load("handisize-bulker")


@pytest.mark.parametrize("name", library_names())
def test_library_ships_load_and_give_their_sources(name):
    ship = Ship.load(name)
    assert ship.data["sources"] and ship.data["description"]
    assert (np.diff(ship.speeds) > 0).all()
    assert ship.draught > 0


@pytest.mark.parametrize("name", ["handysize-bulker", "hopper-dredger"])
def test_library_tables_bound_their_speeds(name):
    ship = Ship.load(name)
    table = ship.tabulate()
    assert table.error.p99 <= 0.01
    assert table.nbytes < 64e6
    assert (np.diff(ship.speeds) > 0).all()
    for setting in range(len(ship.speeds)):
        assert ship.top_speed(setting) >= table.largest(setting) > 0


def test_seurens_bulker_has_table_5_3():
    ship = Ship.load("handysize-bulker")
    assert (ship.speeds / KNOT).tolist() == pytest.approx(
        [8.8, 9.5, 9.9, 10.3, 10.6, 10.8, 14.1, 14.3, 14.5, 14.8, 15.0, 15.2]
    )
    fuel = ship.fuel_rate(CALM, np.arange(12)) * DAY / 1000
    assert fuel.tolist() == pytest.approx(
        [14.3, 15.5, 16.4, 17.6, 18.9, 20.1, 28.9, 30.3, 32.0, 34.4, 36.8, 39.0]
    )
    assert ship.data["fuel"]["eca_price_factor"] == 1.5593


def test_seurens_bulker_slows_in_wind_at_constant_fuel_rate():
    ship = Ship.load("handysize-bulker")
    wind = Conditions(wind_speed=0.836 * 5**1.5, wind_angle=0.0)  # Beaufort 5, head
    fn = 15.2 * KNOT / np.sqrt(9.80665 * 152.9)
    loss = (2.6 - 13.1 * fn + 15.1 * fn**2) * 16.82500255 / 100
    assert float(ship.speed_through_water(wind, 11) / KNOT) == pytest.approx(15.2 * (1 - loss))
    assert float(ship.fuel_rate(wind, 11)) == float(ship.fuel_rate(CALM, 11))


def test_halems_dredger_between_empty_and_full():
    full = Ship.load("hopper-dredger")
    assert full.draught == 6.5 and full.speeds[0] == pytest.approx(10 * KNOT)
    empty = full.with_load_factor(0.0)
    assert empty.draught == 3.5 and empty.speeds[0] == pytest.approx(12 * KNOT)
    half = full.with_load_factor(0.5)
    assert half.draught == 5.0 and half.speeds[0] == pytest.approx(11 * KNOT)
    assert half.loading.displacement == pytest.approx(7000 / 1.025)
    assert half.loading.capacity == 4000
    mixed = full.speed_through_water(Conditions(load_factor=[0.0, 0.5, 1.0, 1.5]))
    assert (mixed[:3] / KNOT).tolist() == pytest.approx([12.0, 11.0, 10.0])
    assert np.isnan(mixed[3])
    assert half.fingerprint() != full.fingerprint()
    with pytest.raises(InputError, match="load factor"):
        full.with_load_factor(1.5)


DREDGER = """
name: Dredger
hull: {length_between_perpendiculars_m: 80, breadth_m: 20, draught_m: 6.5}
loading: {weight_full_t: 10000, draught_empty_m: 3.5, weight_empty_t: 4000}
speeds_kn: [10]
limits: {min_under_keel_clearance_m: 1.0}
models: {squat: van_halem_2019}
"""


def test_squat_limits_the_speed_as_in_the_corrected_table_of_van_halem(tmp_path):
    ship = Ship.load(_write(tmp_path, DREDGER))
    depth = [7.5, 7.6, 7.8, 8.0, 9.0, 12.0, 25.0]
    expected = [0.0, 1.85258782, 3.17069172, 3.60579884, 3.87498211, 4.36363728, 4.92338458]
    speed = ship.speed_through_water(Conditions(depth=depth))
    assert speed == pytest.approx(expected, rel=1e-5)
    assert float(ship.speed_through_water(Conditions(depth=np.inf))) == pytest.approx(10 * KNOT)
    assert np.isnan(ship.speed_through_water(Conditions(depth=np.nan)))
    assert ship.reads == {"depth"}
    empty = ship.with_load_factor(0.0)
    assert float(empty.speed_through_water(Conditions(depth=7.6))) > 3.0


def test_the_clearance_of_a_voyage_replaces_that_of_the_file_where_squat_limits_the_speed(tmp_path):
    ship = Ship.load(_write(tmp_path, DREDGER))
    other = Ship.load(_write(tmp_path, DREDGER.replace("clearance_m: 1.0", "clearance_m: 2.0")))
    depth = Conditions(depth=[8.0, 9.0, 12.0])
    given = ship.with_clearance(2.0).speed_through_water(depth)
    assert given == pytest.approx(other.speed_through_water(depth), rel=1e-12)
    assert given[0] == 0.0 < ship.speed_through_water(depth)[0]
    plain = Ship.simple(8.0, 5.0)
    assert plain.with_clearance(2.0) is plain


def test_kwon_takes_the_block_coefficient_from_the_weight(tmp_path):
    text = DREDGER.replace("squat: van_halem_2019", "speed_loss: kwon_2008")
    weight, plain = text.replace("10000", "8500"), {"wind_speed": 9.0, "wind_angle": 0.0}
    block = 8500e3 / 1025 / (80 * 20 * 6.5)
    given = weight.replace("draught_m: 6.5", f"draught_m: 6.5, block_coefficient: {block}")
    speeds = [
        float(Ship.load(_write(tmp_path, one)).speed_through_water(Conditions(plain)))
        for one in (weight, given)
    ]
    assert speeds[0] == pytest.approx(speeds[1]) and speeds[0] < 10 * KNOT


def test_a_table_with_squat_follows_the_model_and_ends_at_the_keel(tmp_path):
    ship = Ship.load(_write(tmp_path, DREDGER))
    table, depth = ship.tabulate(), np.linspace(8.5, 300.0, 50)
    truth = ship.speed_through_water(Conditions(depth=depth))
    assert table.lookup({"depth": depth}, 0) == pytest.approx(truth, rel=0.01)
    assert np.isnan(table.lookup({"depth": 7.0}, 0))
    assert table.error.p99 < 0.01


def test_squat_and_speed_loss_go_together(tmp_path):
    text = DREDGER.replace("squat:", "speed_loss: kwon_2008, squat:").replace(
        "draught_m: 6.5", "draught_m: 6.5, block_coefficient: 0.8"
    )
    ship = Ship.load(_write(tmp_path, text.replace("weight_full_t: 10000", "weight_full_t: 8500")))
    at = Conditions(depth=[8.2, 9.0, 20.0], wind_speed=10.0, wind_angle=0.0)
    both = ship.speed_through_water(at)
    assert (np.diff(both) > 0.0).all() and (both < 10 * KNOT).all()
    assert ship.tabulate().lookup(dict(at), 0) == pytest.approx(both, rel=0.02)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("squat: van_halem_2019", "squat: barrass"), "no squat method"),
        (("breadth_m: 20, ", ""), "breadth_m"),
        (("squat: van_halem_2019", "engine: seuren"), "not a key"),
    ],
)
def test_invalid_squat_is_refused(tmp_path, change, words):
    with pytest.raises(InputError, match=words):
        Ship.load(_write(tmp_path, DREDGER.replace(*change)))


@pytest.mark.parametrize(
    ("engine", "sfoc"),
    [
        ({"type": "slow_speed_diesel", "power_kw": 6000}, [188.6035, 181.7813]),
        ({"power_kw": 6000, "sfoc_load": [0.25, 0.75], "sfoc_curve_g_per_kwh": [200, 180]}, None),
        ({"sfoc_g_per_kwh": 175.0, "power_kw": 6000}, [175.0, 175.0]),
    ],
)
@pytest.mark.parametrize("law", ["table", "cubic"])
def test_engines_burn_for_the_power_of_a_ship_with_known_speeds(engine, sfoc, law):
    data = {
        "name": "known",
        "hull": {"draught_m": 8.0},
        "fuel": {"type": "hfo"},
        "models": {"calm_water": law},
    }
    powers = np.array([2250.0, 3000.0])
    speeds = 12.0 * (powers / 3000.0) ** (1.0 / 3.0)
    if law == "table":
        data["table"] = {"speed_kn": speeds.tolist(), "power_kw": powers.tolist()}
    else:
        data["speeds_kn"] = speeds.tolist()
        engine = {**engine, "reference_power_kw": 3000.0, "reference_speed_kn": 12.0}
    ship = Ship.from_dict({**data, "engine": {**engine, "hotel_load_kw": 100.0}})
    if sfoc is None:
        sfoc = np.interp(powers / 6000.0, [0.25, 0.75], [200, 180])
    else:
        share = powers / 6000.0
        curve = 0.455 * share**2 - 0.710 * share + 1.280
        assert sfoc == pytest.approx(175 * curve if "type" in engine else [175, 175], rel=1e-4)
    burnt = (powers * sfoc + 100.0 * 195.0) / 3.6e6
    assert ship.fuel_rate(Conditions(), np.array([0, 1])) == pytest.approx(burnt, rel=1e-4)
    slow = ship.with_speeds(speeds[:1] * 1852 / 3600)
    assert float(slow.fuel_rate(Conditions(), 0)) == pytest.approx(burnt[0], rel=1e-4)
    estimates = {e.key for e in ship.estimated}
    assert ("engine.sfoc_g_per_kwh" in estimates) == ("type" in engine)


def test_a_table_that_is_missing_is_named():
    with pytest.raises(InputError, match="has no table with speed_kn"):
        Ship.from_dict({"name": "x", "hull": {"draught_m": 5}, "models": {"calm_water": "table"}})


def test_a_ship_without_draught_hears_all_that_its_method_needs():
    with pytest.raises(InputError) as refusal:
        Ship.from_dict({"name": "x", "speeds_kn": [9], "models": {"calm_water": "holtrop_1984"}})
    assert refusal.value.details["missing"] == [
        "hull.draught_m",
        "hull.length_between_perpendiculars_m",
        "hull.breadth_m",
        "hull.displacement_m3",
    ]


def test_estimated_inputs_of_kwon_are_reported():
    hull = {"length_waterline_m": 160, "breadth_m": 25, "draught_m": 9, "displacement_m3": 26000}
    ship = Ship.from_dict(
        {"name": "x", "hull": hull, "speeds_kn": [9], "models": {"speed_loss": "kwon_2008"}}
    )
    estimates = {e.key for e in ship.estimated}
    assert estimates == {"length_between_perpendiculars_m", "block_coefficient"}


def test_the_sign_in_kwons_table_is_a_choice():
    def speed(sign):
        hull = {"length_between_perpendiculars_m": 150, "breadth_m": 23.4, "draught_m": 9.5}
        hull["block_coefficient"] = 0.8
        models = {"speed_loss": "kwon_2008", **({"kwon_sign": sign} if sign else {})}
        data = {"name": "x", "hull": hull, "speeds_kn": [12], "models": models}
        there = Conditions(wind_speed=12.0, wind_angle=0.0)
        return float(Ship.from_dict(data).speed_through_water(there, 0))

    assert speed(None) == speed("plus") < speed("printed") == speed("minus")


HULL = {
    "length_waterline_m": 172.42,
    "length_between_perpendiculars_m": 169.0,
    "breadth_m": 32.0,
    "draught_m": 10.0,
    "block_coefficient": 0.785,
}
ROWS = {"speed_kn": [8, 12, 16], "power_kw": [1000, 3000, 8000], "fuel_t_per_day": [5, 14, 36]}


@pytest.mark.parametrize(
    "method",
    [
        *("holtrop_mennen_1982", "holtrop_1984", "hollenbach_1998_mean", "hollenbach_1998_min"),
        *("table", "cubic"),
    ],
)
def test_one_file_serves_every_calm_water_method(method):
    data = {"name": "x", "hull": HULL, "speeds_kn": [10, 14], "table": ROWS}
    ship = Ship.from_dict({**data, "models": {"calm_water": method}})
    assert ship.speeds / KNOT == pytest.approx([10, 14])
    sheet = performance_sheet(ship, speeds_kn=[8, 12, 16])
    assert [row["speed_kn"] for row in sheet["conditions"]] == pytest.approx([8, 12, 16])
    power = [row["brake_power_kw"] for row in sheet["conditions"]]
    if method == "table":
        assert power == pytest.approx([1000, 3000, 8000]) and sheet["assumed"] == []
    elif method == "cubic":
        assert power == pytest.approx([1000, 3375, 8000])
        assert sheet["conditions"][0]["fuel_kg_per_h"] == pytest.approx(36000 / 24 / 8)
        assert sheet["assumed"] == ["calm_water: cubic does not use the table"]
    else:
        assert (np.diff(power) > 0).all()
        assert sheet["assumed"] == [f"calm_water: {method} does not use the table"]


def test_powers_are_settings_of_a_table_and_of_the_cubic_law():
    data = {"name": "x", "hull": HULL, "powers_kw": [2000, 5500]}
    table = Ship.from_dict({**data, "table": ROWS, "models": {"calm_water": "table"}})
    assert table.speeds / KNOT == pytest.approx([10, 14])
    assert table.power(CALM, np.array([0, 1])) == pytest.approx([2e6, 5.5e6])
    engine = {"reference_power_kw": 8000, "reference_speed_kn": 16}
    cubic = Ship.from_dict({**data, "engine": engine, "models": {"calm_water": "cubic"}})
    assert cubic.speeds / KNOT == pytest.approx(16 * np.cbrt([0.25, 5.5 / 8]))
    assert cubic.power(CALM, np.array([0, 1])) == pytest.approx([2e6, 5.5e6])


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"powers_kw": [9000], "table": ROWS}, "The table runs from 1000 to 8000 kW"),
        ({"powers_kw": [2000], "table": {"speed_kn": [8, 9]}}, "does not relate power to speed"),
        ({"powers_kw": [2000], "speeds_kn": [9]}, "both powers_kw and speeds_kn"),
        ({"speeds_kn": [20], "table": ROWS, "models": {"calm_water": "table"}}, "ordered to 20 kn"),
        ({"powers_kw": [2000], "models": {"calm_water": "cubic"}}, "no reference speed"),
    ],
)
def test_settings_off_the_law_are_refused(more, words):
    with pytest.raises(InputError, match=words):
        Ship.from_dict({"name": "x", "hull": HULL, **more})


def test_a_misspelt_key_of_one_task_is_refused_with_the_nearest_known_one():
    data = {
        "name": "one",
        "speeds_kn": [10.0],
        "places": {"mess": 0.0},
        "tasks": {"crane work": {"place": "mess", "max_pich_deg": 1.5}},
    }
    with pytest.raises(InputError, match=r"is not a key of 'tasks'.*'max_pitch_deg'"):
        Ship.from_dict(data)


def test_a_speed_that_cannot_be_ordered_is_refused_with_the_speeds_of_the_ship():
    """Only "from 0 to 100 kn" was answered, which is the same for all ships."""
    hull = {"length_between_perpendiculars_m": 174.0, "breadth_m": 32.2, "draught_m": 11.8}
    engine = {"reference_speed_kn": 14.0, "reference_power_kw": 8200.0, "power_kw": 9500.0}
    ship = Ship.from_dict(
        {"name": "tanker", "hull": hull, "speeds_kn": [6, 8, 12], "engine": engine}
    )
    with pytest.raises(InputError) as caught:
        ship.with_speeds(-3.0 * KNOT)
    assert caught.value.possible == "Speeds are above 0; the ship file gives 6 to 12 kn."
    with pytest.raises(InputError, match="above 0 and at most 100 kn; the ship file gives 6 to 12"):
        ship.with_speeds(150.0 * KNOT)
