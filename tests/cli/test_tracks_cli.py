"""``thalweg tracks``: from a CSV of positions to tables, files and a picture."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from thalweg.cli.main import main
from thalweg.operations.examples.synthetic_tracks import SyntheticCycle, synthetic_track
from thalweg.sea import Sea

CYCLE = SyntheticCycle((52.3, 4.0), (52.1, 4.2))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A track, its areas, and the tide it was sailed in."""
    path = tmp_path_factory.mktemp("tracks")
    times = np.datetime64("2025-12-31", "ns") + np.arange(4 * 48) * np.timedelta64(30, "m")
    angle = 2 * np.pi * (times.astype(np.int64) / 1e9) / 44700.0
    flow = (
        np.ones((1, 4, 4)) * np.array([0.5 * np.sin(angle), 0.8 * np.cos(angle)])[:, :, None, None]
    )
    data = {
        name: (("time", "lat", "lon"), values, {"units": "m s-1", "standard_name": standard})
        for name, values, standard in (
            ("u", flow[0], "eastward_sea_water_velocity"),
            ("v", flow[1], "northward_sea_water_velocity"),
        )
    }
    coords = {
        "time": times,
        "lat": ("lat", np.linspace(51.9, 52.5, 4), {"units": "degrees_north"}),
        "lon": ("lon", np.linspace(3.8, 4.4, 4), {"units": "degrees_east"}),
    }
    xr.Dataset(data, coords).to_netcdf(path / "tide.nc")
    made = synthetic_track(
        CYCLE,
        sea=Sea.open(path / "tide.nc"),
        start="2026-01-01",
        cycles=6,
        interval_s=180.0,
        current_factor=1.2,
    )
    made.frame.to_csv(path / "ais.csv", index=False)
    (path / "areas.geojson").write_text(json.dumps(CYCLE.areas))
    return path


def asked(folder, *more):
    return ["tracks", str(folder / "ais.csv"), "--areas", str(folder / "areas.geojson"), *more]


@pytest.mark.slow
def test_json(folder, capsys):
    assert main(asked(folder, "--sea", str(folder / "tide.nc"), "--json")) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["calibration"]["factor"] == pytest.approx(1.2, abs=0.04)
    assert found["cycles"]["count"] == 5
    assert found["models"]["calibrated"]["rmse_rel"] < found["models"]["still water"]["rmse_rel"]
    assert {row["activity"] for row in found["activities"]} == {
        *("loading", "sailing full", "unloading", "sailing empty")
    }


@pytest.mark.slow
def test_files_and_tables(folder, tmp_path, capsys):
    more = ("--sea", str(folder / "tide.nc"), "--ship", "hopper-dredger")
    fills = ("--fill", "wind=0", "waves=0", "--speed", "11", "--out", str(tmp_path))
    assert main(asked(folder, *more, *fills)) == 0
    printed = capsys.readouterr().out
    assert "factor on the currents 1.2" in printed and "ship, calibrated" in printed
    names = {"activities.csv", "legs.csv", "cycles.csv", "tracks.json", "tracks.png"}
    assert {p.name for p in tmp_path.iterdir()} == names
    assert len(pd.read_csv(tmp_path / "legs.csv")) == 12
    assert (tmp_path / "tracks.png").stat().st_size > 20_000


def test_without_a_sea_there_are_activities_and_speeds(folder, capsys):
    assert main(asked(folder)) == 0
    assert "sailing full:" in capsys.readouterr().out


def test_names_with_brackets_are_printed_as_they_are(folder, tmp_path, capsys):
    text = (folder / "ais.csv").read_text()
    path = tmp_path / "odd.csv"
    path.write_text(text.replace("244000000", "MV [/red] [kn]"))
    assert main(["tracks", str(path), *asked(folder)[2:]]) == 0
    assert "MV [/red] [kn]: 2026-01-01T00:00:00Z" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (["--ship", "hopper-dredger"], "no sea is given"),
        (["--vessel", "7"], "'7' was requested"),
        (["--column", "lat"], "WHAT=NAME"),
        (["--column", "lat=y"], "are wrong"),
        (["--slow", "-1"], "not negative"),
        (["--fastest", "0"], "positive"),
        (["--longest-gap", "nan"], "positive"),
        (["--time-format", "%Q"], "time format '%Q' cannot be used"),
    ],
)
def test_what_cannot_be_is_refused(folder, more, told, capsys):
    assert main(asked(folder, *more)) == 2
    assert told in capsys.readouterr().err


def test_a_sea_without_currents_is_told(folder, tmp_path, capsys):
    path = tmp_path / "wind.nc"
    xr.open_dataset(folder / "tide.nc").rename(u="a").drop_vars("v").assign(
        a=lambda d: d.a.assign_attrs(standard_name="eastward_wind")
    ).to_netcdf(path)
    assert main(asked(folder, "--sea", str(path))) in (2, 3)
    assert capsys.readouterr().err.startswith("error:")


def test_an_order_that_no_such_ship_obeys_is_refused(folder, capsys):
    more = ("--calm", "--ship", "hopper-dredger", "--speed", "99")
    assert main(asked(folder, *more)) == 2
    said = capsys.readouterr().err
    assert "cannot order 99 kn" in said and "Her greatest speed at this load is 1" in said
