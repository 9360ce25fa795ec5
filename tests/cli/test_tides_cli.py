"""``thalweg tides``: constituents and predictions from records and model runs."""

import argparse
import csv
import io
import json

import numpy as np
import pytest
import xarray as xr

from tests.conftest import data_file
from thalweg.cli.main import main
from thalweg.cli.tides import tides_command
from thalweg.cli.tides.tide_analysis_command import _notes_on_length
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import format_time, parse_time
from thalweg.sea import standard_names as nm
from thalweg.sea.tides.constituents import Constituents

pytest.importorskip("utide")

START = parse_time("2025-01-01T00:00Z")
TRUTH = Constituents.single(
    nm.WATER_LEVEL, {"M2": (1.2, 40.0), "S2": (0.4, 90.0)}, mean=0.3, lat=-33.9,
    convention="foreman",
)  # fmt: skip


def tide(*words):
    parser = argparse.ArgumentParser()
    tides_command.add_command(parser.add_subparsers(dest="command"))
    arguments = parser.parse_args(["tides", *map(str, words)])
    arguments.progress = lambda stage: None
    return arguments.run(arguments)


@pytest.fixture
def record(tmp_path):
    times = START + 1800.0 * np.arange(48 * 20)
    level = TRUTH.predict(nm.WATER_LEVEL, times)[0]
    path = tmp_path / "gauge.csv"
    rows = [f"{format_time(t)},{h:.6f}" for t, h in zip(times, level)]
    rows[100] = rows[100].split(",")[0] + ","
    path.write_text("time,water_level\n" + "\n".join(rows) + "\n")
    return path


def test_a_record_is_analysed_and_predicted(capsys, record, tmp_path):
    out = tmp_path / "gauge.json"
    words = ("analyse", record, "--at", "-33.9,18.4", "--constituents", "M2", "S2")
    assert tide(*words, "--out", out, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["tidal_share"][nm.WATER_LEVEL] == pytest.approx(1.0, abs=1e-6)
    first = found["variables"][nm.WATER_LEVEL][0]
    assert first["name"] == "M2"
    assert first["amplitude"] == pytest.approx(1.2, abs=1e-5)
    assert first["phase_deg"] == pytest.approx(40.0, abs=1e-3)

    when = ("--start", "2033-05-01T00:00Z", "--end", "2033-05-01T06:00Z", "--step", "30")
    assert tide("predict", out, *when) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert len(rows) == 13
    times = np.array([parse_time(r["time"]) for r in rows])
    level = np.array([float(r[nm.WATER_LEVEL]) for r in rows])
    assert np.allclose(level, TRUTH.predict(nm.WATER_LEVEL, times)[0], atol=2e-4)


def test_what_a_reader_sees(capsys, record):
    assert tide("analyse", record, "--at", "33.9S 18.4E", "--constituents", "M2", "S2") == 0
    text = capsys.readouterr().out
    assert "100.0 % of the variance is tidal" in text
    assert "M2    12.4206 h    1.2000    40.0 deg" in text
    (note,) = [line for line in text.splitlines() if line.startswith("note: ")]
    assert note.startswith("note: The record has ")
    assert "days: K2 is not separated from S2, nor P1 from K1, and levels that change" in note


@pytest.mark.parametrize(("days", "words"), [(90, "K2 is not"), (200, "200 days: levels")])
def test_what_a_record_shorter_than_a_year_lacks_is_stated(days, words):
    (note,) = _notes_on_length(0.0, days * 86400.0)
    assert words in note
    assert _notes_on_length(0.0, 366 * 86400.0) == []


def test_a_prediction_is_written_to_a_file(capsys, record, tmp_path):
    constants = tmp_path / "c.json"
    tide("analyse", record, "--at", "-33.9,18.4", "--out", constants)
    out = tmp_path / "tide.csv"
    assert (
        tide("predict", constants, "--start", "2030-01-01", "--end", "2030-01-02", "--out", out)
        == 0
    )
    assert len(out.read_text().splitlines()) == 146
    assert f"wrote {out}" in capsys.readouterr().out


def test_a_model_run_is_predicted_between_its_nodes(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path / "cache"))
    times = START + 3600.0 * np.arange(24 * 16)
    lat, lon = np.array([50.0, 51.0, 52.0]), np.array([1.0, 2.0, 3.0])
    level = TRUTH.predict(nm.WATER_LEVEL, times)[0][:, None, None] * np.ones((1, 3, 3))
    level[:, 2, 2] = np.nan
    data = {
        "h": (("time", "lat", "lon"), level, {"standard_name": "sea_surface_height", "units": "m"})
    }
    when = np.datetime64(0, "ns") + (times * 1e9).astype("timedelta64[ns]")
    run, out = tmp_path / "run.nc", tmp_path / "run.json"
    xr.Dataset(data, {"time": when, "lat": lat, "lon": lon}).to_netcdf(run)
    assert tide("analyse", run, "--constituents", "M2", "S2", "--out", out, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["nodes"] == 9
    assert found["nodes_without_tide"] == {nm.WATER_LEVEL: 1}
    assert found["variables"][nm.WATER_LEVEL][0]["amplitude_median"] == pytest.approx(1.2, abs=0.01)
    span = ("--start", "2025-03-01", "--end", "2025-03-01T01:00", "--json")
    assert tide("predict", out, "--at", "50.2,1.2", *span) == 0
    found = json.loads(capsys.readouterr().out)
    there = TRUTH.predict(nm.WATER_LEVEL, [parse_time(t) for t in found["times"]])[0]
    assert found["variables"][nm.WATER_LEVEL] == pytest.approx(there, abs=0.01)
    with pytest.raises(InputError, match="nodes"):
        tide("predict", out, *span)
    with pytest.raises(InputError, match="outside"):
        tide("predict", out, "--at", "60,1", *span)


def test_a_published_file_is_predicted(capsys):
    path = data_file("tide/rws_vlissingen_components_hatyan.txt")
    span = ("--start", "2018-12-31T23:00Z", "--end", "2018-12-31T23:30Z", "--json")
    assert tide("predict", path, *span) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["convention"] == "rws"
    assert found["variables"][nm.WATER_LEVEL] == pytest.approx([1.02, 0.90, 0.78, 0.66], abs=0.02)


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (("--constituents", "M2"), "position"),
        (("--at", "somewhere"), "not a position"),
        (("--at", "-33.9,18.4", "--constituents", "M2", "N2"), "too short"),
        (("--at", "-33.9,18.4", "--rayleigh", "0"), "Rayleigh"),
    ],
)
def test_impossible_analyses_are_refused(record, words, match):
    with pytest.raises(InputError, match=match):
        tide("analyse", record, *words)


@pytest.mark.parametrize(
    "text",
    ["", "time,height_ft\n2025-01-01,3\n", "time,level\nnoon,3\n", "time,level\n2025-01-01,x\n"],
)
def test_a_record_that_is_none(tmp_path, text):
    path = tmp_path / "x.csv"
    path.write_text(text)
    with pytest.raises(DatasetError):
        tide("analyse", path, "--at", "50,0")


@pytest.mark.parametrize(
    "span",
    [
        ("--start", "2030-01-02", "--end", "2030-01-01"),
        ("--start", "2030-01-01", "--end", "2030-01-02", "--step", "0"),
        ("--start", "2030-01-01", "--end", "2090-01-02", "--step", "0.1"),
        ("--start", "soon", "--end", "2030-01-02"),
    ],
)
def test_a_span_that_is_none(tmp_path, span):
    with pytest.raises(InputError):
        tide("predict", tmp_path / "x.json", *span)


def test_a_run_in_metres_is_analysed_with_its_projection(tmp_path, capsys):
    path = data_file("tide/adh_sandiego_waterlevel_ugrid_30min.nc")
    assert main(["tides", "analyse", str(path), "--constituents", "M2"]) == 2
    assert "--map crs=EPSG" in capsys.readouterr().err
    out = str(tmp_path / "run.json")
    words = ["--constituents", "M2", "--map", "crs=EPSG:32611", "--out", out]
    assert main(["tides", "analyse", str(path), *words]) == 0
    assert "9140 nodes" in capsys.readouterr().out
    there = ["--at", "32.65,-117.25", "--start", "2031-01-01", "--end", "2031-01-01T01:00"]
    assert main(["tides", "predict", out, *there]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 8


@pytest.mark.parametrize(
    ("name", "words", "size", "lag"),
    [
        ("rws_vlissingen_waterlevel_20180101_20180401.noos", (), 1.747, 30.5),
        ("rws_vlissingen_prediction_2019_hatyan.dia.txt.gz", (), 1.747, 30.5),
        (
            "utide_HNL2010_hourly.asc",
            ("--days-since", "1700-01-01", "--unit", "mm", "--at", "21.3,-157.87"),
            0.1769,
            58.8,
        ),
    ],
)
def test_official_records_are_analysed_as_they_are(capsys, name, words, size, lag):
    """M2 of Vlissingen by Rijkswaterstaat (2009-2012) is 1.747 m, 30.5 degrees."""
    names = ("--constituents", "M2", "S2", "N2", "K1", "O1", "M4")
    assert tide("analyse", data_file(f"tide/{name}"), *words, *names, "--json") == 0
    m2 = json.loads(capsys.readouterr().out)["variables"][nm.WATER_LEVEL][0]
    assert m2["name"] == "M2"
    assert m2["amplitude"] == pytest.approx(size, rel=0.02)  # the record is not that of 2009-2012
    assert m2["phase_deg"] == pytest.approx(lag, abs=1.0)


def test_options_without_effect_are_refused(record, tmp_path):
    with pytest.raises(InputError, match="--map is for variables"):
        tide("analyse", record, "--at", "-33.9,18.4", "--map", "a=b")
    run = tmp_path / "run.nc"
    run.write_bytes(b"CDF\x01" + bytes(100))
    for words in (("--at", "50,1"), ("--unit", "cm"), ("--days-since", "1970-01-01")):
        with pytest.raises(InputError, match=f"{words[0]} is for a record"):
            tide("analyse", run, *words)


def test_a_record_of_mostly_gaps_is_refused(record):
    rows = record.read_text().splitlines()
    gaps = [f"{row.split(',')[0]}," if k % 5 < 3 else row for k, row in enumerate(rows[1:])]
    record.write_text("\n".join([rows[0], *gaps]) + "\n")
    with pytest.raises(InputError, match="known at 40 % of the times"):
        tide("analyse", record, "--at", "-33.9,18.4", "--constituents", "M2", "S2", "--json")


def test_where_nothing_can_be_written_is_told_before_the_work(record, tmp_path, monkeypatch):
    monkeypatch.setattr("thalweg.sea.tides.tide_records.read_record", None)
    with pytest.raises(InputError, match="is a folder"):
        tide("analyse", record, "--at", "-33.9,18.4", "--out", tmp_path)
    with pytest.raises(InputError, match="cannot be written"):
        tide("analyse", record, "--at", "-33.9,18.4", "--out", record / "x.json")


def test_a_prediction_makes_its_folder_and_refuses_a_position_that_means_nothing(capsys, tmp_path):
    gauge = tmp_path / "gauge.txt"
    gauge.write_text("STAT X WATHTE NAP cm 1\nCOMP 65 28.984104 10.0 20.0 M2\n")
    span = ("--start", "2030-01-01", "--end", "2030-01-01T01:00")
    out = tmp_path / "new" / "tide.csv"
    assert tide("predict", gauge, *span, "--out", out) == 0
    assert len(out.read_text().splitlines()) == 8
    with pytest.raises(InputError, match="constants at a single place"):
        tide("predict", gauge, *span, "--at", "51,3")
