"""The command line: results, exit codes, and error messages with a remedy."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

from thalweg.cli.distance_command import _print_distance
from thalweg.cli.main import build_parser, main
from thalweg.cli.option_values import open_sea
from thalweg.cli.tables import print_waypoints

SHIP = """
name: tester
hull: {draught_m: 5.0, length_between_perpendiculars_m: 80.0, breadth_m: 14.0}
speeds_kn: [8.0, 10.0]
fuel: {reference_t_per_day: 6.0}
engine: {reference_speed_kn: 10.0}
"""
HERE, THERE = "50.5N 1.2E", "50.5,2.8"


@pytest.fixture
def ship(tmp_path):
    path = tmp_path / "ship.yaml"
    path.write_text(SHIP)
    return str(path)


@pytest.fixture
def currents(tmp_path):
    """Two days of a steady half-knot easterly set between 50 and 51 north."""
    times = np.arange("2026-01-01", "2026-01-03", 6, dtype="datetime64[h]").astype("datetime64[ns]")
    lat, lon = np.linspace(50, 51, 11), np.linspace(1, 3, 21)
    shape = (len(times), len(lat), len(lon))
    data = {
        "uo": (("time", "lat", "lon"), np.full(shape, 0.257), _cf("eastward")),
        "vo": (("time", "lat", "lon"), np.zeros(shape), _cf("northward")),
    }
    path = tmp_path / "currents.nc"
    coords = {
        "time": times,
        "lat": ("lat", lat, {"standard_name": "latitude", "units": "degrees_north"}),
        "lon": ("lon", lon, {"standard_name": "longitude", "units": "degrees_east"}),
    }
    xr.Dataset(data, coords).to_netcdf(path)
    return str(path)


def _cf(way):
    return {"standard_name": f"{way}_sea_water_velocity", "units": "m s-1"}


def run_json(capsys, *arguments):
    code = main([*arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_plan_prints_one_object_and_writes_files(capsys, tmp_path, ship, currents):
    out = tmp_path / "out"
    code, found = run_json(
        capsys, "plan", HERE, THERE, "--ship", ship, "--sea", currents, "--coast", "none",
        "--depart", "2026-01-01T00:00Z", "--out", str(out),
    )  # fmt: skip
    assert code == 0
    route = found["routes"][0]
    assert route["distance_nm"] == pytest.approx(61.2, abs=0.2)
    assert route["time_h"] == pytest.approx(route["distance_nm"] / 10.5, rel=2e-3)
    assert route["fuel_t"] == pytest.approx(6.0 * route["time_h"] / 24, rel=1e-3)
    assert found["lower_bound"] <= route["time_h"]
    assert 0 <= found["gap"] < 0.05
    assert {"solver_total", "rejections", "provenance"} <= found.keys()
    keys = {"lat", "lon", "time", "course_deg", "speed_through_water_kn", "speed_over_ground_kn"}
    assert keys <= route["waypoints"][0].keys()
    names = {
        "plan.json",
        "route.geojson",
        "route.gpx",
        "route.rtz",
        "route.csv",
        "map.png",
        "profile.png",
    }
    assert {path.name for path in out.iterdir()} == names
    assert json.loads((out / "plan.json").read_text()) == found


@pytest.mark.slow
def test_a_written_route_can_be_evaluated(capsys, tmp_path, ship, currents):
    world = ["--ship", ship, "--sea", currents, "--coast", "none"]
    when = ["--depart", "2026-01-01T00:00Z"]
    _, found = run_json(capsys, "plan", HERE, THERE, *world, *when, "--out", str(tmp_path / "out"))
    for name in ("route.gpx", "route.rtz", "route.csv", "route.geojson"):
        code, scored = run_json(capsys, "evaluate", str(tmp_path / "out" / name), *world, *when)
        assert code == 0
        assert scored["time_h"] == pytest.approx(found["routes"][0]["time_h"], rel=1e-5)


def test_the_waits_of_a_route_are_totalled(capsys, tmp_path, ship):
    path = tmp_path / "waits.csv"
    path.write_text("lat,lon,time,waiting_h\n52,3,2026-01-01T00:00Z,0.5\n52.1,3,,1.25\n52.2,3,,\n")
    world = ["evaluate", str(path), "--ship", ship, "--calm", "--coast", "none"]
    code, scored = run_json(capsys, *world)
    assert code == 0
    assert scored["waiting_h"] == 1.75
    assert [row["waiting_h"] for row in scored["waypoints"]] == [0.5, 1.25, 0.0]
    assert main(world) == 0
    told = capsys.readouterr().out
    assert "of it waiting 1 h 45 min, most of it at 52 06.0N 003 00.0E" in told
    no_depth = "No depth in the data: under-keel clearance was not checked."
    assert no_depth in scored["notes"] and "depth under the keel NOT checked" in told
    path.write_text("lat,lon,time\n52,3,2026-01-01T00:00Z\n52.2,3,\n")
    assert main(world) == 0
    assert "waiting" not in capsys.readouterr().out


def test_a_route_of_more_speed_than_the_ship_makes_breaks_a_limit(capsys, tmp_path):
    ship, route = tmp_path / "twelve.yaml", tmp_path / "fast.csv"
    ship.write_text(
        "name: twelve\nhull: {draught_m: 6.0}\nspeeds_kn: [12]\n"
        "engine: {reference_speed_kn: 12, reference_power_kw: 3000, sfoc_g_per_kwh: 190}\n"
    )
    route.write_text("lat,lon,time,ordered_speed_kn\n52,3,2026-01-01T00:00Z,35\n52.2,3,,\n")
    world = ["evaluate", str(route), "--ship", str(ship), "--calm", "--coast", "none"]
    assert main(world) == 4
    printed = capsys.readouterr().out
    assert "NOT KEPT: ordered speed above the greatest of the ship: leg 1" in printed
    assert "(35.00 kn, limit 12.00 kn)" in printed and "mean speed 12.0 kn" in printed


@pytest.mark.slow
def test_plan_for_a_person(capsys, ship):
    code = main(
        ["plan", HERE, THERE, "--ship", ship, "--calm", "--coast", "none", "--speed", "8",
         "--depart", "2026-01-01T00:00Z"]
    )  # fmt: skip
    text = capsys.readouterr().out
    assert code == 0
    assert len(text.splitlines()) <= 12
    assert "at most" in text and "2026-01-01 00:00 UTC" in text
    for jargon in ("network", "fingerprint", "kappa", "Lower bound", "settled"):
        assert jargon not in text


@pytest.mark.slow
def test_details_of_a_plan_on_request(capsys, ship):
    arguments = ["plan", HERE, THERE, "--ship", ship, "--calm", "--coast", "none", "--speed", "8"]
    assert main([*arguments, "--depart", "2026-01-01T00:00Z", "--verbose"]) == 0
    text = capsys.readouterr().out
    for word in ("7.6", "waypoint", "Lower bound", "Network: kind", "Fingerprint of the sea"):
        assert word in text


def test_details_have_all_waypoints(capsys):
    """A table of 46 waypoints said '... 16 more'."""
    row = {"lat": 50.0, "lon": 1.0, "time": None}
    print_waypoints(Console(), [{**row, "distance_nm": float(k)} for k in range(100)], "a route")
    text = capsys.readouterr().out
    assert "more" not in text and all(f" {k}.0 " in text for k in range(100))


@pytest.mark.slow
def test_inspect_states_ranges_and_draws_one_picture_per_grid(capsys, tmp_path, currents):
    other = str(tmp_path / "other.nc")
    xr.open_dataset(currents).isel(lon=slice(None, -1)).to_netcdf(other)
    out = tmp_path / "maps"
    code, found = run_json(capsys, "inspect", currents, other, "--out", str(out))
    assert code == 0
    assert sorted(path.name for path in out.iterdir()) == ["sea_1.png", "sea_2.png"]
    names = [name for name in found["ranges"] if "eastward_sea_water_velocity" in name]
    assert len(names) == 2
    for name in names:
        low, high = found["ranges"][name]
        assert low == pytest.approx(high) == pytest.approx(0.257, abs=1e-6)


def test_thousands_of_islands_are_one_artist_and_specks_are_none():
    from matplotlib.figure import Figure

    from thalweg.core.bounding_box import BoundingBox
    from thalweg.sea.sea_maps import _draw_coastline

    islands = [
        (np.array([50.0, 50.1, 50.1]) + k * 1e-3, np.array([1.0, 1.0, 1.1])) for k in range(500)
    ]
    specks = [(a * 0.0 + 50.0, b * 0.0 + 1.0) for a, b in islands]
    axes = Figure().add_subplot()
    _draw_coastline(axes, [*islands, *specks], BoundingBox(49.0, 52.0, 0.0, 3.0))
    assert len(axes.lines) == 0 and len(axes.collections) == 1
    assert len(axes.collections[0].get_segments()) == 500


def test_maps_of_a_sea_have_the_arrows_of_its_strong_currents_only():
    """A narrow jet: arrows near zero set the scale, and one lay across the map."""
    from matplotlib.figure import Figure

    from thalweg import Sea
    from thalweg.core.bounding_box import BoundingBox
    from thalweg.sea.sea_maps import ARROWS_ALONG_SIDE, MAP_PANELS, _draw_arrows

    def eastward(time, lat, lon):
        return 1e-5 + 1.5 * np.exp(-(((np.asarray(lat) - 51.0) / 0.02) ** 2)) + 0.0 * lon

    north = "northward_sea_water_velocity"
    sea = Sea.from_functions(
        {"eastward_sea_water_velocity": eastward, north: lambda t, a, o: 0.0 * (a + o)}
    )
    panel = next(one for one in MAP_PANELS if north in one.arrows)
    axes = Figure().add_subplot()
    _draw_arrows(axes, sea.layers, panel, 0.0, BoundingBox(50.0, 51.95, 0.0, 3.0))
    (arrows,) = axes.collections
    assert arrows.U.min() > 0.15
    assert arrows.U.max() / arrows.scale < 1.5 / ARROWS_ALONG_SIDE  # of the width of the map


def test_inspect(capsys, currents):
    code, found = run_json(capsys, "inspect", currents)
    assert code == 0
    text = json.dumps(found)
    assert "eastward_sea_water_velocity" in text and "uo" in text
    assert main(["inspect", currents]) == 0
    text = capsys.readouterr().out
    assert "eastward_sea_water_velocity" in text and "not all read" not in text


def test_inspect_states_that_it_did_not_read_all_times(capsys, currents, monkeypatch):
    monkeypatch.setattr("thalweg.sea.inspection._ALL_TIMES", 0)
    monkeypatch.setattr("thalweg.sea.inspection.SAMPLED_TIMES", 1)
    assert main(["inspect", currents]) == 0
    assert "; values at 1 of 8 times, not all read" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("extra", "code", "words"),
    [
        (["--ship", "handysize-bulke", "--calm"], 2, "handysize-bulker"),
        (["--ship", "SHIP"], 2, "No sea"),
        (["--ship", "SHIP", "--calm", "--objective", "tiem"], 2, "time"),
        (["--ship", "SHIP", "--calm", "--speed", "0"], 2, "speed"),
        (["--ship", "SHIP", "--calm", "--ukc", "1"], 3, "depth"),
        (["--ship", "SHIP", "--sea", "CURRENTS", "--depart", "2027-01-01"], 3, "2026-01-02"),
        (
            ["--ship", "handysize-bulker", "--sea", "CURRENTS"],
            3,
            "does not have: wave height, wind",
        ),
        (["--ship", "SHIP", "--sea", "nowhere.nc"], 2, "nowhere.nc"),
        (["--ship", "SHIP", "--calm", "--fill", "tea=2"], 2, "currents=0"),
        (["--ship", "SHIP", "--calm", "--fill", "wind=0"], 2, "Both --calm and --fill"),
        (["--ship", "SHIP", "--calm", "--map", "eastward_wind=u"], 2, "Both --calm and --map"),
        (["--ship", "SHIP", "--sea", "storm", "--average-over", "5"], 2, "given without a file"),
        (["--ship", "SHIP", "--sea", "CURRENTS", "--fill", "waves=-1"], 2, "between 0 and"),
    ],
)
def test_errors_have_exit_codes_and_no_traceback(capsys, ship, currents, extra, code, words):
    extra = [{"SHIP": ship, "CURRENTS": currents}.get(word, word) for word in extra]
    got = main(["plan", HERE, THERE, "--coast", "none", *extra])
    captured = capsys.readouterr()
    assert got == code
    assert words in captured.err
    assert "Traceback" not in captured.err


def test_errors_as_json(capsys, ship):
    code, found = run_json(
        capsys, "plan", "Roterdam", THERE, "--ship", ship, "--calm", "--coast", "none"
    )
    assert code == 2
    assert found["error"] == "InputError"
    assert "Rotterdam" in found["remedy"] + found["possible"]


@pytest.mark.slow
def test_no_route_has_code_4_and_reasons(capsys, tmp_path, ship, currents):
    code, found = run_json(
        capsys, "plan", HERE, THERE, "--ship", ship, "--sea", currents, "--coast", "none",
        "--depart", "2026-01-01T00:00Z", "--arrive-by", "2026-01-01T02:00Z",
    )  # fmt: skip
    assert code == 4
    assert found["details"]["reasons"]


@pytest.mark.slow
def test_southern_positions_are_not_options(capsys, ship):
    code, found = run_json(
        capsys, "plan", "-33.5,152.0", "-33.0,152.5", "--ship", ship, "--calm", "--coast", "none"
    )
    assert code == 0
    assert found["routes"][0]["waypoints"][0]["lat"] == pytest.approx(-33.5)


def test_a_southern_position_with_a_letter_and_a_sign_says_what_to_type(capsys):
    assert main(["distance", "-29.8S,31.5E", "Durban", "--quiet"]) == 2
    assert "Write it as -33.9,18.2 or 33.9S 18.2E" in capsys.readouterr().err


@pytest.mark.parametrize("content", [b"not a file of any kind", b"CDF\x01" + b"\0" * 20, b""])
def test_corrupt_files(capsys, tmp_path, ship, content):
    path = tmp_path / "bad.nc"
    path.write_bytes(content)
    assert main(["plan", HERE, THERE, "--ship", ship, "--sea", str(path), "--coast", "none"]) == 2
    assert "bad.nc" in capsys.readouterr().err


def test_help_names_every_command():
    text = build_parser().format_help()
    for command in ("plan", "evaluate", "inspect", "ship", "demo"):
        assert command in text


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (["plan", HERE, "--calm", "--json"], "required"),
        (["plan", HERE, THERE, "--calm", "--speed", "fast", "--json"], "--speed"),
        (["plna", "--json"], "plna"),
        (["inspect", "x.nc", "--map", "u", "--json"], "NAME=VARIABLE"),
        (["inspect", "x.nc", "--time", "2026-01-01", "--json"], "--out"),
    ],
)
def test_invalid_command_lines_are_refused(capsys, command, words):
    assert main(command) == 2
    found = json.loads(capsys.readouterr().out)
    assert found["error"] == "InputError"
    assert words in found["asked"] + found["possible"]
    assert found["remedy"]


def test_a_variable_can_be_mapped(capsys, tmp_path):
    path = tmp_path / "odd.nc"
    times = np.array(["2026-01-01", "2026-01-02"], "datetime64[ns]")
    field = (("time", "lat", "lon"), np.full((2, 3, 3), 1.5), {"units": "m"})
    axis = [50.0, 51.0, 52.0]
    xr.Dataset({"odd": field}, {"time": times, "lat": axis, "lon": axis}).to_netcdf(path)
    assert main(["inspect", str(path)]) == 2
    name = "sea_surface_wave_significant_height"
    capsys.readouterr()
    code, found = run_json(capsys, "inspect", str(path), "--map", f"{name}=odd")
    assert code == 0 and found["coverage"][0]["variable"] == name


def test_half_a_vector_is_no_sea(capsys, tmp_path, currents):
    half = tmp_path / "half.nc"
    xr.open_dataset(currents)[["uo"]].to_netcdf(half)
    assert main(["inspect", str(half)]) == 2
    assert "the other part of this vector" in capsys.readouterr().err


@pytest.mark.slow
def test_high_latitudes_give_a_warning(capsys, ship):
    code, found = run_json(
        capsys, "plan", "75N 0E", "75N 4E", "--ship", ship, "--calm", "--coast", "none"
    )
    assert code == 0
    assert any("ice" in note for note in found["notes"])


def test_a_value_that_is_no_number_gets_one_line_on_its_option(capsys):
    assert main(["plan", "Dover", "Calais", "--ship", "gunnerus", "--calm", "--speed", "15kn"]) == 2
    text = capsys.readouterr().err
    assert "argument --speed: '15kn' is not a number without a unit." in text
    assert "--speed KN: ordered speed through calm water [kn], also between" in text
    assert "See thalweg plan --help." in text
    assert "usage:" not in text and len(text.splitlines()) == 3


def test_fills_of_vectors_have_a_form_on_the_command_line(currents, capsys):
    arguments = ["plan", HERE, THERE, "--ship", "gunnerus", "--sea", currents, "--quiet"]
    assert main([*arguments, "--fill", "wind=10"]) == 2
    assert "Give both: --fill wind=10,0 on the command line" in capsys.readouterr().err
    assert main([*arguments, "--fill", "wind=a,0"]) == 2
    assert "wind=EAST,NORTH (towards, in m/s)" in capsys.readouterr().err
    given = build_parser().parse_args([*arguments, "--fill", "wind=10,-2"])
    given.progress = lambda text: None
    time = np.datetime64("2026-01-01T06:00")
    wind = open_sea(given).sample(
        ["eastward_wind", "northward_wind"], time.astype("datetime64[s]").astype(float), 50.5, 2.0
    )
    assert (float(wind["eastward_wind"]), float(wind["northward_wind"])) == (10.0, -2.0)


def test_distances_of_short_ways_have_decimals_and_times_to_the_minute(capsys):
    """They had 0.1 days and whole miles."""
    way = SimpleNamespace(
        start="A",
        goal="B",
        nm=12.34,
        canals=(),
        straits=(),
        approaches=(),
        notes=(),
        length=22854.0,
    )
    _print_distance(way, 8.0, 12.34 / 8.0 / 24.0)
    printed = capsys.readouterr().out
    assert "A to B: 12.3 nm" in printed and "1 h 33 min (0.06 days) at 8 kn" in printed
