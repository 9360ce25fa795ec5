"""``thalweg ship``: arguments, JSON, plots, and refused input."""

import argparse
import json
import math
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

from thalweg.cli.ship.ship_command import add_command, parse_speeds
from thalweg.cli.ship.ship_plots import _resistance
from thalweg.cli.ship.ship_sheet_table import merged_notes
from thalweg.core.errors import InputError, ModelRangeError
from thalweg.ship import Ship
from thalweg.ship.comfort.onboard_motions import onboard_motions
from thalweg.ship.performance_sheet import performance_sheet

KEYS = {
    *("total", "friction", "form_factor", "appendage", "wave_making", "bulb", "transom"),
    *("correlation", "waves", "wind", "shallow", "rudder"),
}
FILE = """
name: Test bulker
hull: {length_waterline_m: 172.42, length_between_perpendiculars_m: 169, breadth_m: 32,
  draught_m: 10, block_coefficient: 0.785, frontal_area_m2: 700, deadweight_t: 35000,
  type: bulk carrier}
engine: {power_kw: 9000, type: slow_speed_diesel}
fuel: {type: hfo}
models: {calm_water: holtrop_mennen_1982, waves: stawave_1, wind: ittc}
"""


def _run(capsys, *words):
    parser = argparse.ArgumentParser()
    add_command(parser.add_subparsers())
    arguments = parser.parse_args(["ship", *map(str, words)])
    arguments.progress = lambda text: None
    assert arguments.run(arguments) == 0
    return capsys.readouterr().out


@pytest.fixture
def ship_file(tmp_path):
    path = tmp_path / "ship.yaml"
    path.write_text(FILE)
    return path


@pytest.mark.parametrize(
    ("text", "speeds"),
    [
        ("8:11", [8, 9, 10, 11]),
        ("8:9:0.5", [8, 8.5, 9]),
        ("10,12.5", [10, 12.5]),
        ("9", [9]),
        ("8:8", [8]),
    ],
)
def test_speeds_are_read(text, speeds):
    assert parse_speeds(text) == pytest.approx(speeds)


@pytest.mark.parametrize(
    "text",
    ["", "x", "8:", "0:4", "-3", "9:8", "1:9999:0.001", "8:16:1e-320", "nan", "8:9,1"],
)
def test_speeds_that_are_none_are_refused(text):
    with pytest.raises(InputError, match="is not understood"):
        parse_speeds(text)


def test_json_holds_what_is_promised(capsys, ship_file):
    text = _run(capsys, ship_file, "--speed", "10:12", "--hs", 2, "--wave-from", 30, "--json")
    sheet = json.loads(text)
    assert sheet["name"] == "Test bulker"
    assert [row["speed_kn"] for row in sheet["conditions"]] == pytest.approx([10, 11, 12])
    for row in sheet["conditions"]:
        forces = row["resistance_n"]
        assert forces.keys() >= KEYS
        parts = sum(value for name, value in forces.items() if name != "total")
        assert parts == pytest.approx(forces["total"])
        speed = row["speed_kn"] * 1852 / 3600
        assert row["effective_power_kw"] == pytest.approx(forces["total"] * speed / 1000)
        assert row["brake_power_kw"] > row["effective_power_kw"]
        assert row["co2_kg_per_h"] == pytest.approx(3.114 * row["fuel_kg_per_h"])
        assert row["cii"]["attained_g_per_t_nm"] == pytest.approx(
            row["co2_kg_per_h"] * 1000 / (35000 * row["speed_kn"])
        )
        assert row["cii"]["rating_2026"] in "ABCDE"
        assert isinstance(row["warnings"], list)
    assert {"key", "value", "method"} == set(sheet["estimated"][0])


def test_waves_from_port_and_starboard_are_the_same_and_from_astern_cost_less(capsys, ship_file):
    def waves(degrees):
        sheet = json.loads(
            _run(capsys, ship_file, "--speed", 10, "--hs", 3, "--wave-from", degrees, "--json")
        )
        return sheet["conditions"][0]["resistance_n"]["waves"]

    assert waves(40) == waves(-40) == waves(320) > 0
    assert waves(120) == 0.0
    words = ("--speed", 10, "--hs", 2, "--wave-from", 120, "--json")
    (row,) = json.loads(_run(capsys, ship_file, *words))["conditions"]
    assert "stawave1: wave angle is 120, outside 0 to 45" in row["warnings"]


def test_a_power_that_cannot_be_reached_is_said_and_has_no_fuel(capsys, ship_file):
    sheet = json.loads(_run(capsys, ship_file, "--speed", 18, "--json"))
    (row,) = sheet["conditions"]
    assert row["brake_power_kw"] > 9000
    assert row["fuel_kg_per_h"] is None
    assert any("not reached" in note for note in row["warnings"])


def test_strictness_refuses_what_is_out_of_range(capsys, ship_file):
    with pytest.raises(ModelRangeError, match="not reached"):
        _run(capsys, ship_file, "--speed", 18, "--strict")


def test_ships_with_known_speeds_show_them(capsys):
    sheet = json.loads(_run(capsys, "handysize-bulker", "--wind", 10, "--json"))
    assert len(sheet["conditions"]) == 12
    row = sheet["conditions"][-1]
    assert row["ordered_speed_kn"] == pytest.approx(15.2)
    assert row["speed_kn"] < 14.0
    assert row["resistance_n"].keys() >= KEYS and row["brake_power_kw"] is None
    assert set(row["resistance_n"].values()) == {None}
    assert row["fuel_kg_per_h"] == pytest.approx(39000 / 24)


def test_the_table_for_people_names_estimates_and_sources(capsys, ship_file):
    text = _run(capsys, ship_file, "--speed", "10:11")
    assert "Test bulker" in text and "waterplane_coefficient" in text
    assert "Seuren" in _run(capsys, "handysize-bulker")


@pytest.mark.slow
def test_pictures_and_json_are_written(capsys, ship_file, tmp_path):
    folder = tmp_path / "out"
    _run(capsys, ship_file, "--speed", "8:14", "--hs", 2, "--out", folder)
    names = {path.name for path in folder.iterdir()}
    pictures = {f"{name}.png" for name in ("resistance", "power", "fuel", "cii", "speed_loss")}
    assert names == {"ship.json", *pictures}
    assert all(path.stat().st_size > 1000 for path in folder.iterdir())


@pytest.mark.slow
def test_a_single_speed_is_drawn_too(capsys, ship_file, tmp_path):
    _run(capsys, ship_file, "--speed", 12, "--wind", 10, "--out", tmp_path / "one")
    assert (tmp_path / "one" / "resistance.png").stat().st_size > 1000


def test_weather_that_is_half_told_is_completed_and_said(capsys, ship_file):
    sheet = json.loads(_run(capsys, ship_file, "--speed", 12, "--hs", 2, "--json"))
    assert sheet["assumed"] == [
        "a peak period of 7.07 s, of a fully developed sea",
        "waves from ahead",
    ]
    whole = ("--hs", 2, "--tp", 8, "--wave-from", 0, "--wind", 9, "--wind-from", 20)
    assert json.loads(_run(capsys, ship_file, "--speed", 12, *whole, "--json"))["assumed"] == []
    alone = ("--wave-from", 20, "--wind-from", 0, "--tp", 9)
    assert json.loads(_run(capsys, ship_file, "--speed", 12, *alone, "--json"))["assumed"] == [
        "no waves, since only a direction is given",
        "no wind, since only a direction is given",
        "no waves, since only a period is given",
    ]
    assert "Assumed: waves from ahead" in _run(capsys, ship_file, "--speed", 12, "--hs", 2)


@pytest.mark.slow
def test_what_is_not_known_comes_with_the_keys_that_would_tell_it(capsys, ship_file):
    def missing(text):
        ship_file.write_text(text)
        return json.loads(_run(capsys, ship_file, "--speed", "10:12", "--json"))["missing"]

    assert missing(FILE) == []
    (capacity,) = missing(FILE.replace("deadweight_t: 35000,", ""))
    assert "hull.deadweight_t" in capacity
    (kind,) = missing(FILE.replace("type: bulk carrier", "type: work boat"))
    assert "hull.type" in kind
    (fuel,) = missing(FILE.replace(", type: slow_speed_diesel", ""))
    assert fuel.startswith("fuel") and "engine.sfoc_g_per_kwh" in fuel
    (carbon,) = missing(FILE.replace("fuel: {type: hfo}", ""))
    assert "fuel.type" in carbon
    bare = "name: x\nhull: {draught_m: 5}\nspeeds_kn: [10, 11, 12]\n"
    assert [note.split(":")[0] for note in missing(bare)] == ["power", "fuel"]
    assert "Not known: power" in _run(capsys, ship_file)


def test_notes_that_differ_in_a_value_are_printed_once():
    rows = [
        {"speed_kn": speed, "warnings": [f"engine: load is {load}, outside 0 to 1", "too fast"]}
        for speed, load in ((14.0, 1.1), (15.0, 1.2), (16.0, 1.4))
    ]
    assert merged_notes(rows) == [
        ("14 to 16", "engine: load is 1.1 to 1.4, outside 0 to 1"),
        ("14 to 16", "too fast"),
    ]


def test_kwon_on_a_ship_with_a_resistance_has_a_sheet_over_many_speeds(capsys, ship_file):
    text = ship_file.read_text().replace("waves: stawave_1, wind: ittc", "speed_loss: kwon_2008")
    ship_file.write_text(text)
    words = ("--speed", "8:12", "--wind", 19, "--wind-from", 30, "--json")
    rows = json.loads(_run(capsys, ship_file, *words))["conditions"]
    calm = json.loads(_run(capsys, ship_file, "--speed", "8:12", "--json"))["conditions"]
    assert len(rows) == 5
    for windy, still in zip(rows, calm):
        assert windy["brake_power_kw"] is None or windy["brake_power_kw"] > still["brake_power_kw"]
        assert any("kwon_2008: Beaufort number is 8" in note for note in windy["warnings"])


def test_a_folder_that_cannot_be_written_is_said(capsys, ship_file, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("x")
    with pytest.raises(InputError, match="cannot be written"):
        _run(capsys, ship_file, "--out", blocked / "sub")


def test_the_library_is_listed(capsys):
    assert "handysize-bulker" in _run(capsys, "--list").split()
    with pytest.raises(InputError, match="No ship is given"):
        _run(capsys)


@pytest.mark.parametrize("option", ["--hs", "--tp", "--wind", "--water-depth"])
@pytest.mark.parametrize("value", [-1.0, math.nan])
def test_impossible_weather_is_refused(capsys, ship_file, option, value):
    with pytest.raises(InputError, match=f"Correct {option}"):
        _run(capsys, ship_file, f"{option}={value}")


def test_waves_too_steep_for_any_sea_are_refused(capsys, ship_file):
    """Of a peak period of 8 s, the height of a steepness of 0.1 is 0.1 g Tp^2 / (2 pi) = 9.99 m."""
    _run(capsys, ship_file, "--hs", 9.98, "--tp", 8)
    with pytest.raises(InputError, match=r"steepness of 0\.10.*10\.0 m at this period"):
        _run(capsys, ship_file, "--hs", 10.02, "--tp", 8)
    with pytest.raises(InputError, match=r"need 11\.3 s or more"):
        _run(capsys, ship_file, "--hs", 20, "--tp", 3)


def test_no_task_is_possible_in_waves_above_the_limit_of_the_ship(capsys):
    def tasks(height):
        words = ("gunnerus-2019", "--hs", height, "--tp", 13, "--speed", 6)
        return json.loads(_run(capsys, *words, "--json"))["motions"]["tasks"]

    assert any(any(row) for row in tasks(3.9).values())
    assert not any(any(row) for row in tasks(4.1).values())


def test_speeds_a_ship_cannot_show_are_left_out_and_named(capsys):
    sheet = json.loads(_run(capsys, "handysize-bulker", "--speed", "8:16", "--json"))
    shown = [row["ordered_speed_kn"] for row in sheet["conditions"]]
    assert shown == pytest.approx([9, 10, 11, 12, 13, 14, 15])
    (warning,) = sheet["warnings"]
    assert warning.startswith("8, 16 kn left out") and "8.8 to 15.2 kn" in warning
    assert "8, 16 kn left out" in _run(capsys, "handysize-bulker", "--speed", "8:16")
    with pytest.raises(ModelRangeError, match="left out"):
        _run(capsys, "handysize-bulker", "--speed", "8:16", "--strict")
    with pytest.raises(InputError, match="cannot be ordered"):
        _run(capsys, "handysize-bulker", "--speed", "20:22")


def test_weather_without_effect_on_the_ship_is_reported(capsys):
    sheet = json.loads(_run(capsys, "vox-olympia", "--hs", 3, "--wind", 10, "--json"))
    assert [text.split(" given")[0] for text in sheet["warnings"]] == ["waves are", "wind is"]
    assert json.loads(_run(capsys, "kvlcc2", "--hs", 3, "--wind", 10, "--json"))["warnings"] == []


def test_weather_beyond_the_limits_is_reported(capsys):
    sheet = json.loads(_run(capsys, "kvlcc2", "--hs", 9, "--wind", 30, "--json"))
    assert [text.split(" are")[0] for text in sheet["warnings"]] == [
        "waves of 9 m",
        "wind of 30 m/s",
    ]


def test_squat_and_the_water_under_the_keel(capsys, ship_file):
    sheet = json.loads(_run(capsys, ship_file, "--speed", "8,12", "--water-depth", 11, "--json"))
    slow, fast = (row["squat"] for row in sheet["conditions"])
    assert 0.0 < slow["squat_m"] < fast["squat_m"]
    assert fast["squat_m"] / slow["squat_m"] == pytest.approx(1.5**2.08)
    assert fast["under_keel_clearance_m"] == pytest.approx(1.0 - fast["squat_m"])
    deep = json.loads(_run(capsys, ship_file, "--speed", "8", "--json"))
    assert deep["conditions"][0]["squat"] is None


def test_motions_and_the_dangers_of_following_seas(capsys, ship_file):
    def row(*words):
        text = _run(capsys, ship_file, "--speed", 16, "--hs", 8, "--tp", 13, *words, "--json")
        return json.loads(text)["conditions"][0]

    head, astern = row("--wave-from", 0), row("--wave-from", 180)
    assert head["motions"]["significant_heave_m"] > 0.5
    name = "bow_acceleration_rms_m_s2"
    assert head["motions"][name] > 2.0 * astern["motions"][name] > 0.0
    assert not any("Circ.1228" in note for note in head["warnings"])
    assert any("successive high waves" in note for note in astern["warnings"])


def test_rudder_drag_needs_the_option_and_a_crab_angle(capsys, ship_file):
    def drag(*words):
        text = _run(capsys, ship_file, "--speed", 10, *words, "--json")
        return json.loads(text)["conditions"][0]["resistance_n"]["rudder"]

    text = ship_file.read_text().replace("type: bulk", "rudder_area_m2: 40, type: bulk")
    ship_file.write_text(text)
    assert drag("--crab", 8) == 0.0
    ship_file.write_text(text.replace("wind: ittc", "wind: ittc, rudder: schless_2023"))
    assert drag() == 0.0
    assert drag("--crab", 8) == drag("--crab", -8) > 0.0
    with pytest.raises(InputError, match="crab angle"):
        drag("--crab", 60)


def test_the_list_of_ships_can_be_json(capsys):
    assert "kvlcc2" in json.loads(_run(capsys, "--list", "--json"))["ships"]


@pytest.mark.slow
def test_names_that_look_like_markup_or_formulas_are_shown_as_they_are(capsys, tmp_path):
    path = tmp_path / "ship.yaml"
    name = "MV [/] x$^$ [red]y"
    path.write_text(FILE.replace("Test bulker", f'"{name}"') + 'sources: ["[Smith] 2010 [/b]"]\n')
    text = _run(capsys, path, "--speed", "14,10,12", "--wind", 5, "--out", tmp_path / "out")
    assert name in text and "[Smith] 2010 [/b]" in text
    assert (tmp_path / "out" / "speed_loss.png").stat().st_size > 1000


def test_too_shallow_water_is_reported_and_has_no_resistance_plot(capsys, tmp_path):
    path = tmp_path / "ship.yaml"
    path.write_text(FILE.replace("models: {", "models: {shallow_water: karpov, "))
    options = ("--speed", "8:10", "--water-depth", 9, "--out", tmp_path / "out", "--json")
    sheet = json.loads(_run(capsys, path, *options))
    assert sheet["warnings"] == ["the water is 9 m deep, the draught 10 m: aground"]
    assert sheet["missing"] == [] and sheet["conditions"][0]["resistance_n"]["total"] is None
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["ship.json"]


def test_speeds_the_resistance_does_not_know_are_not_drawn_as_none():
    row = dict.fromkeys(KEYS, 0.0) | {"total": 5.0, "friction": 5.0}
    blank = dict.fromkeys(KEYS)
    sheet = {
        "name": "x",
        "conditions": [
            {"speed_kn": 8.0, "resistance_n": blank},
            {"speed_kn": 10.0, "resistance_n": row},
            {"speed_kn": 12.0, "resistance_n": {**row, "total": 9.0, "friction": 9.0}},
        ],
    }
    axes = Figure().add_subplot()
    assert _resistance(axes, sheet)
    (line,) = axes.lines
    assert line.get_xdata().tolist() == [10.0, 12.0]


def test_a_name_longer_than_files_may_have_is_refused(capsys):
    with pytest.raises(InputError, match="no ship named"):
        _run(capsys, "a" * 300)


@pytest.mark.slow
def test_a_reader_that_leaves_early_is_no_fault():
    command = [sys.executable, "-m", "thalweg", "ship", "kvlcc2", "--json", "--quiet"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0


def test_a_ship_that_reads_the_wind_alone_gets_the_wind_of_the_waves(capsys):
    """Pierson and Moskowitz (1964): a fully developed sea of 3 m has 11.6 m/s of wind."""
    sheet = json.loads(_run(capsys, "handysize-bulker", "--hs", "3", "--tp", "9", "--json"))
    assert any("a wind of 11.6 m/s with the waves" in text for text in sheet["assumed"])
    assert not any("leave its speed" in text for text in sheet["warnings"])
    top = sheet["conditions"][-1]
    assert 11.0 < top["speed_kn"] < 12.5  # of 15.2 kn


def test_beyond_the_range_of_the_speed_loss_no_speed_is_given(capsys):
    text = _run(capsys, "handysize-bulker", "--wind", "20", "--hs", "5", "--json")
    top = json.loads(text)["conditions"][-1]
    assert top["speed_kn"] is None and top["fuel_kg_per_nm"] is None
    assert any("no speed is given" in text for text in top["warnings"])


@pytest.mark.slow
def test_motions_and_sickness_by_place_and_heading(capsys, tmp_path):
    """Motions are those at the speed that the ship attains: slower in head seas than ordered."""
    words = ("gunnerus-2019", "--hs", 2, "--tp", 8, "--speed", 4.83 / 0.514444)
    sheet = json.loads(_run(capsys, *words, "--json", "--out", tmp_path))["motions"]
    mess = sheet["places"]["mess"]
    head, beam = (sheet["headings_deg"].index(angle) for angle in (0, 90))
    speed = np.array(sheet["attained_speed_kn"])
    assert speed[head] < speed[beam] < sheet["ordered_speed_kn"]
    found = onboard_motions(Ship.load("gunnerus-2019")).at(
        speed * 0.514444, wave_angle=np.radians(sheet["headings_deg"]), wave_height=2, wave_period=8
    )
    weighted = found.places["mess"].weighted
    assert mess["acceleration_rms_m_s2"] == pytest.approx(
        found.places["mess"].acceleration, rel=1e-5
    )
    assert mess["sick_percent"] == pytest.approx(weighted * np.sqrt(4 * 3600.0) / 3.0, rel=1e-5)
    assert sheet["heave_rms_m"] == pytest.approx(found.heave, rel=1e-5)
    assert sheet["tasks"]["laboratory work"][head] is False
    assert (tmp_path / "motions.png").stat().st_size > 10_000
    text = _run(capsys, *words)
    assert "bridge" in text and "laboratory work is possible" in text


def test_the_motions_of_a_ship_that_holds_her_speed_say_so(capsys, tmp_path):
    (tmp_path / "boat.yaml").write_text(
        "{name: boat, speeds_kn: [8.0, 10.0], places: {mess: 0.0}, hull: "
        "{length_between_perpendiculars_m: 33.9, breadth_m: 9.6, draught_m: 2.8, "
        "block_coefficient: 0.62}}"
    )
    (tmp_path / "coaster.yaml").write_text(
        "{name: coaster, speeds_kn: [9, 12], places: {bridge: -30.0}, hull: "
        "{length_between_perpendiculars_m: 82, breadth_m: 13, draught_m: 5, block_coefficient: "
        "0.75}, engine: {power_kw: 1850, type: medium_speed_diesel}, propulsion: {propellers: 1, "
        "propeller_diameter_m: 2.8, propulsive_efficiency: 0.6}, fuel: {type: mgo}, models: "
        "{calm_water: holtrop_1984, waves: snnm}}"
    )  # 12 kn in these waves take more than the engine gives
    text = _run(capsys, tmp_path / "boat.yaml", "--hs", 2, "--tp", 8, "--speed", 10)
    assert "at 10.0 kn on all headings" in " ".join(text.split())
    text = _run(capsys, tmp_path / "coaster.yaml", "--hs", 2.5, "--tp", 7.5)
    assert "at 12.0 kn, or less where the engines do not give it" in " ".join(text.split())
    text = _run(capsys, "gunnerus-2019", "--hs", 2, "--tp", 8, "--speed", 10)
    assert "with the power for 10.0 kn in calm water" in " ".join(text.split())


def test_no_motions_without_waves_or_places(capsys):
    assert "motions" not in json.loads(_run(capsys, "gunnerus-2019", "--json"))
    assert "motions" not in json.loads(_run(capsys, "handysize-bulker", "--hs", 2, "--json"))


def test_a_speed_that_is_no_prediction_is_not_missing_data_of_the_ship_file(capsys, tmp_path):
    """The loss of Kwon is far outside its range in Beaufort 7 for a small ship."""
    file = tmp_path / "coaster.yaml"
    file.write_text(
        "name: coaster\n"
        "hull: {length_between_perpendiculars_m: 85, breadth_m: 14, draught_m: 5.6, "
        "block_coefficient: 0.78, deadweight_t: 4500, type: general_cargo}\n"
        "speeds_kn: [8, 12]\nmodels: {calm_water: cubic, speed_loss: kwon_2008}\n"
        "engine: {reference_speed_kn: 12, reference_power_kw: 1850, sfoc_g_per_kwh: 195}\n"
        "fuel: {type: mgo}\n"
    )
    text = _run(capsys, str(file), "--hs", 4, "--tp", 10, "--wave-from", 30, "--wind", 15)
    words = " ".join(text.split())
    assert "waves are given, which this ship's models do not count" in words
    assert "no speed is given" in words and "CII: add" not in words


def test_fuel_beyond_the_power_of_the_engines_is_no_missing_entry(capsys, ship_file):
    """It asked for an engine and a fuel that the file has."""
    weather = {"wave_height": 6.0, "wave_angle": 0.0, "wave_period": 10.0}
    sheet = performance_sheet(Ship.load(ship_file), weather, speeds_kn=[15.0])
    (row,) = sheet["conditions"]
    assert row["brake_power_kw"] > 9000.0 and row["fuel_kg_per_h"] is None
    assert sheet["missing"] == []
