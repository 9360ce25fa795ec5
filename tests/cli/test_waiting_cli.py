"""``thalweg waiting``: tables, files and refusals."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from thalweg.cli.main import main

ENDS = ["52.1,3.97", "52.1,4.26"]
NEAP = [*ENDS, "--ship", "vox-olympia", "--north-sea", "neap", "--depart", "2026-01-01"]
QUICK = ["--coast", "none", "--step", "20"]


@pytest.mark.slow
def test_json_tells_savings_and_break_even_powers(capsys):
    assert main(["waiting", *NEAP, *QUICK, "--hotel-kw", "0", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    frame = pd.DataFrame(found["rows"])
    assert found["trips"] == ["there", "back"] * 5
    best = frame[frame.rule == "optimum"].groupby("start").saving_percent.max()
    assert len(best) == 4 and (best > 4.0).all() and (best < 6.0).all()
    by_rule = frame.groupby("rule").energy_kwh.min()
    assert by_rule["optimum"] <= by_rule.min()
    assert all(5.0 < kw < 200.0 for powers in found["break_even_kw"].values() for kw in powers)
    (note,) = found["notes"]
    assert note.startswith("back: Load factor 0 has no effect")


def test_the_hotel_load_of_the_ship_ends_all_waiting(capsys):
    assert main(["waiting", *NEAP, *QUICK, "--starts", "1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["hotel_power_kw"] == 327.1
    rows = pd.DataFrame(found["rows"])
    assert rows[rows.rule == "current"].saving_percent.max() <= 0.0
    assert rows[rows.rule == "optimum"].saving_percent.max() < 0.01


def test_ships_with_other_speeds_when_empty_sail_to_and_fro_and_keep_their_clearance(
    tmp_path, capsys
):
    """A bar of 7.7 m at low water and 10.3 m at high water: a ship of 8 m with 1 m waits."""
    ship = tmp_path / "hopper.yaml"
    ship.write_text(
        "name: hopper\n"
        "hull: {length_between_perpendiculars_m: 113, breadth_m: 23, draught_m: 8}\n"
        "loading: {draught_full_m: 8.0, draught_empty_m: 4.2, speeds_full_kn: [12.0], "
        "speeds_empty_kn: [13.5]}\n"
        "engine: {reference_speed_kn: 12.0, reference_power_kw: 6000, sfoc_g_per_kwh: 200}\n"
        "limits: {min_under_keel_clearance_m: 1.0}\n"
    )
    hours = np.arange(0, 60)
    level = 1.3 * np.cos(2.0 * np.pi * hours / 12.42)[:, None, None] * np.ones((1, 3, 3))
    day = np.datetime64("2026-04-05T00", "ns")
    axes = {"time": day + hours.astype("timedelta64[h]"), "latitude": [51.4, 51.5, 51.6]}
    axes["longitude"] = [3.1, 3.3, 3.5]
    names = {"zos": "sea_surface_height_above_geoid", "depth": "sea_floor_depth_below_geoid"}
    names |= {"uo": "eastward_sea_water_velocity", "vo": "northward_sea_water_velocity"}
    values = {"zos": level, "depth": np.full_like(level, 9.0)}
    values |= {"uo": np.zeros_like(level), "vo": np.zeros_like(level)}
    place = ("time", "latitude", "longitude")
    attributes = {n: {"standard_name": s, "units": "m"} for n, s in names.items()}
    attributes["uo"]["units"] = attributes["vo"]["units"] = "m s-1"
    fields = {n: (place, values[n], attributes[n]) for n in names}
    xr.Dataset(fields, axes).to_netcdf(tmp_path / "bar.nc")
    given = ["51.48,3.20", "51.48,3.30", "--ship", str(ship), "--sea", str(tmp_path / "bar.nc")]
    given += ["--coast", "none", "--depart", "2026-04-05T05:00Z", "--cycles", "1"]
    assert main(["waiting", *given, "--max-wait", "6", "--starts", "1", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["trips"] == ["there", "back"]
    frame = pd.DataFrame(found["rows"])
    without = frame[frame.rule == "none"].duration_h.to_numpy()
    hour = np.arange(5.0, 12.42, 1.0 / 60.0)
    deep = np.interp(hour, hours, level[:, 0, 0]) + 9.0 >= 9.0
    opens = hour[np.argmax(deep)] - 5.0
    sailing = 3.74 / 12.0 + 3.74 / 13.5
    assert without == pytest.approx(opens + sailing, abs=0.3)


@pytest.mark.slow
def test_files_and_the_table(tmp_path, capsys):
    out = tmp_path / "study"
    assert main(["waiting", *NEAP, *QUICK, "--cycles", "0", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "optimum" in printed and "wrote" in printed
    assert {p.name for p in out.iterdir()} == {"waiting.csv", "waiting.json", "waiting.png"}
    frame = pd.read_csv(out / "waiting.csv")
    assert set(frame.rule) == {"none", "current", "next trip", "optimum"}
    assert (out / "waiting.png").stat().st_size > 20_000


@pytest.mark.slow
def test_a_sea_from_a_file_must_last_long_enough(tmp_path, capsys):
    xr = pytest.importorskip("xarray")
    times = np.datetime64("2026-01-01", "ns") + np.arange(30) * np.timedelta64(1, "h")
    lat, lon = np.array([52.0, 52.2]), np.array([3.9, 4.3])
    tide = 0.5 * np.sin(2 * np.pi * np.arange(30) / 12.42)[:, None, None] * np.ones((1, 2, 2))
    data = {
        name: (("time", "lat", "lon"), values, {"units": "m s-1", "standard_name": standard})
        for name, values, standard in (
            ("u", tide, "eastward_sea_water_velocity"),
            ("v", 0.0 * tide, "northward_sea_water_velocity"),
        )
    }
    data["h"] = (
        ("lat", "lon"),
        np.full((2, 2), 20.0),
        {"units": "m", "standard_name": "sea_floor_depth_below_geoid"},
    )
    coords = {
        "time": times,
        "lat": ("lat", lat, {"units": "degrees_north", "standard_name": "latitude"}),
        "lon": ("lon", lon, {"units": "degrees_east", "standard_name": "longitude"}),
    }
    path = tmp_path / "tide.nc"
    xr.Dataset(data, coords).to_netcdf(path)
    asked = [*ENDS, "--ship", "vox-olympia", "--sea", str(path), "--fill", "wind=0", "waves=0"]
    asked += ["--depart", "2026-01-01T01:00Z", *QUICK]
    assert main(["waiting", *asked, "--cycles", "1", "--most-wait", "6", "--json"]) == 0
    rows = pd.DataFrame(json.loads(capsys.readouterr().out)["rows"])
    assert rows.energy_kwh.notna().all()
    assert main(["waiting", *asked, "--cycles", "3"]) == 3
    assert "not known" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (["--cycles", "-1"], "cycles"),
        (["--max-wait", "-1"], "max-wait"),
        (["--most-wait", "nan"], "max-wait"),
        (["--starts", "0"], "starts"),
        (["--hotel-kw", "-3"], "hotel-kw"),
        (["--calm"], "Choose one"),
        (["--step", "0"], "step"),
        (["--fill", "wind=3"], "--fill is given with --north-sea"),
        (["--average-over", "5"], "--average-over is given with --north-sea"),
        (["--map", "crs=EPSG:4326"], "--map is given with --north-sea"),
    ],
)
def test_what_cannot_be_is_refused(wrong, told, capsys):
    assert main(["waiting", *NEAP, "--coast", "none", *wrong]) == 2
    assert told in capsys.readouterr().err


def test_places(capsys):
    asked = NEAP[2:]
    assert main(["waiting", "52.1,3.97", "Rotterdam", *asked]) == 2
    assert "not a position" in capsys.readouterr().err
    assert main(["waiting", "52.1,3.97", "52.1,5.2", *asked]) == 2
    assert "blocked" in capsys.readouterr().err
