"""Ensembles on the command line: a file for each member, and refused files."""

import json

import numpy as np
import pytest
import xarray as xr

from thalweg.cli.main import main

SHIP = """
name: tester
hull: {draught_m: 5.0, length_between_perpendiculars_m: 80.0, breadth_m: 14.0}
speeds_kn: [8.0, 10.0]
fuel: {reference_t_per_day: 6.0}
engine: {reference_speed_kn: 10.0}
"""


def member(path, set_kn, step=0.1):
    """Write two days of an easterly set between 50 and 51 north."""
    times = np.arange("2026-01-01", "2026-01-03", 6, dtype="datetime64[h]").astype("datetime64[ns]")
    lat, lon = np.arange(50.0, 51.01, 0.1), np.arange(1.0, 3.0 + step / 2, step)
    shape = (len(times), len(lat), len(lon))
    dims = ("time", "lat", "lon")
    data = {
        f"{letter}o": (
            dims,
            np.full(shape, value),
            {"standard_name": f"{way}_sea_water_velocity", "units": "m s-1"},
        )
        for letter, way, value in (("u", "eastward", set_kn * 0.514444), ("v", "northward", 0.0))
    }
    coords = {
        "time": times,
        "lat": ("lat", lat, {"standard_name": "latitude", "units": "degrees_north"}),
        "lon": ("lon", lon, {"standard_name": "longitude", "units": "degrees_east"}),
    }
    xr.Dataset(data, coords).to_netcdf(path)
    return str(path)


@pytest.fixture
def world(tmp_path):
    path = tmp_path / "ship.yaml"
    path.write_text(SHIP)
    return [
        "plan", "50.5N 1.2E", "50.5N 2.8E", "--ship", str(path), "--coast", "none",
        "--depart", "2026-01-01T00:00Z", "--objective", "front", "--resolution", "5", "--json",
    ]  # fmt: skip


@pytest.mark.slow
def test_a_file_for_each_member_makes_an_ensemble(capsys, tmp_path, world):
    files = [member(tmp_path / f"{k}.nc", set_kn) for k, set_kn in enumerate((-1.0, 0.0, 1.0))]
    code = main([*world, "--sea", *files, "--ensemble", "mean", "--method", "exact"])
    found = json.loads(capsys.readouterr().out)
    assert code == 0 and found["ensemble"]
    fastest = found["ensemble"][0]["time_h"]  # ten knots in each of the sets
    assert fastest["members"] == 3
    assert fastest["mean"] == pytest.approx((61.2 / 9 + 61.2 / 10 + 61.2 / 11) / 3, rel=2e-3)
    assert fastest["cvar"] == pytest.approx(61.2 / 9, rel=2e-3)


def test_members_on_different_grids_are_refused(capsys, tmp_path, world):
    files = [member(tmp_path / "a.nc", 0.0), member(tmp_path / "b.nc", 0.0, step=0.2)]
    assert main([*world, "--sea", *files, "--ensemble"]) == 2
    assert "another grid" in capsys.readouterr().out


@pytest.mark.parametrize("sea", [["--calm"], ["--sea", "one.nc"]])
def test_a_sea_without_members_is_no_ensemble(capsys, tmp_path, world, sea):
    member(tmp_path / "one.nc", 0.0)
    sea = [str(tmp_path / word) if word.endswith(".nc") else word for word in sea]
    assert main([*world, *sea, "--ensemble"]) == 2
    assert "the sea has none" in capsys.readouterr().out


@pytest.mark.parametrize("in_files", [False, True])
def test_a_route_is_evaluated_in_one_member(capsys, tmp_path, world, in_files):
    files = [member(tmp_path / f"{k}.nc", set_kn) for k, set_kn in enumerate((-1.0, 0.0, 1.0))]
    if not in_files:
        whole = xr.concat([xr.load_dataset(file) for file in files], dim="number")
        whole.to_netcdf(tmp_path / "all.nc")
        files = [str(tmp_path / "all.nc")]
    (tmp_path / "route.csv").write_text("lat,lon\n50.5,1.2\n50.5,2.8\n")
    given = ["evaluate", str(tmp_path / "route.csv"), *world[3:9], "--speed", "10", "--sea", *files]
    times = []
    for number in ("0", "2"):
        assert main([*given, "--member", number, "--json"]) == 0
        times.append(json.loads(capsys.readouterr().out)["time_h"])
    assert times == pytest.approx([61.2 / 9.0, 61.2 / 11.0], rel=2e-3)
    assert main([*given, "--member", "3"]) == 2
    assert "Members are numbered 0 to 2" in capsys.readouterr().err
    if not in_files:
        assert main(given) == 2
        assert "thalweg evaluate --member N" in capsys.readouterr().err
