"""Studies: rows, resume, processes that die, and statistics with a known answer."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")

from thalweg.cli.main import main
from thalweg.cli.study_command import _print_savings
from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.planning.request.voyage_endpoints import NOT_REACHED
from thalweg.studies import Study, row_runner, run_study, study_rows, study_run, summarise_study
from thalweg.studies.row_runner import UNREAD, run_rows, ship_of_request
from thalweg.studies.study_axes import axis_values
from thalweg.studies.study_notes import study_notes
from thalweg.studies.study_parts import read_parts
from thalweg.studies.study_run import has_route
from thalweg.studies.study_summary import median_interval

DAYS = [f"2026-03-0{day}T00:00Z" for day in range(1, 5)]


def months_file(path: Path) -> Path:
    """Write a year of current along the route: 1 m/s against the ship but 1 with it in June."""
    time = pd.date_range("2025-12-01", "2027-02-01", freq="12h")
    lat, lon = np.array([-1.0, 1.0]), np.array([-1.0, 5.0])
    east = np.where(time.month == 6, 1.0, -1.0)
    shape = len(time), 2, 2
    fields = {
        "eastward_sea_water_velocity": east[:, None, None] * np.ones(shape),
        "northward_sea_water_velocity": np.zeros(shape),
    }
    xr.Dataset(
        {name: (("time", "lat", "lon"), value, {"standard_name": name, "units": "m s-1"})
         for name, value in fields.items()},
        {"time": time, "lat": ("lat", lat, {"units": "degrees_north"}),
         "lon": ("lon", lon, {"units": "degrees_east"})},
    ).to_netcdf(path)  # fmt: skip
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("study")
    months_file(made / "year.nc")
    return made


def base(folder: Path, **changes) -> Study:
    data = {
        "ship": "hopper-dredger", "sea": ["year.nc"], "coast": "none", "resolution_nm": 10.0,
        "voyage": {"start": [0.0, 0.0], "goal": [0.0, 2.0], "offing_nm": 0.0},
        "axes": {"depart": {"from": "2026-02-05", "to": "2026-12-15", "step_h": 1460}},
    }  # fmt: skip
    data |= changes
    return Study.from_dict(data, folder)


def test_rows_are_all_combinations_with_identities_that_stay():
    study = Study.from_dict(
        {
            "voyage": {"start": "A", "goal": "B"},
            "axes": {"depart": {"from": "2026-01-01", "to": "2026-01-02", "step_h": 12},
                     "speed_kn": {"from": 10, "to": 12},
                     "way": [{"name": "north", "via": [[1.0, 2.0]]}, {"name": "south", "via": []}]},
        }
    )  # fmt: skip
    rows = study.rows()
    assert study.size == len(rows) == 3 * 3 * 2 == len({row.id for row in rows})
    assert rows[0].labels == {"depart": "2026-01-01T00:00:00Z", "speed_kn": 10, "way": "north"}
    assert rows[0].request["voyage"]["via"] == [[1.0, 2.0]]
    again = list(Study.from_dict(json.loads(json.dumps(study.to_dict()))).rows())
    assert [row.id for row in again] == [row.id for row in rows]


def test_the_exact_method_is_run_once_over_seeds():
    axes = {"method": ["exact", "nsga2"], "seed": [4, 5, 6], "load_factor": [0.5, 1.0]}
    study = Study("methods", {"voyage": {"objective": "front"}}, axes)
    done = [tuple(row.labels[name] for name in axes) for row in study.rows()]
    assert study.size == len(done) == len(set(done)) == 2 * (1 + 3)
    assert [labels for labels in done if labels[0] == "exact"] == [
        ("exact", 4, 0.5), ("exact", 4, 1.0)
    ]  # fmt: skip
    sampled = {"count": 3, "seed": 1, "load_factor": {"uniform": [0.2, 1.0]}}
    draws = Study("methods", {"voyage": {}}, {"seed": [1, 2], "method": ["exact"]}, sampled)
    assert draws.size == len(draws.rows()) == 3


def test_methods_are_compared_with_the_same_blocks_of_speed():
    voyage = {"start": "A", "goal": "B", "objective": "front"}

    def blocks(axes, **entries):
        rows = Study("methods", {"voyage": voyage | entries}, axes).rows()
        return [row.request["voyage"].get("speed_block_h") for row in rows]

    assert blocks({"method": ["exact", "nsga2"]}) == [0, 0]
    ways = [{"name": "a", "method": "exact"}, {"name": "b", "method": "spea2"}]
    assert blocks({"way": ways}) == [0, 0]
    assert blocks({"method": ["exact", "nsga2"]}, speed_block_h=3) == [3, 3]
    assert (
        blocks({"method": ["nsga2", "default"]}) == blocks({"method": ["exact"]}) * 2 == [None] * 2
    )
    assert blocks({"method": ["exact", "nsga2"]}, objective="time") == [None, None]


def test_notes_of_a_study_are_stated_once():
    frame = pd.DataFrame({"front": ["[[1, 2]]", "[[1, 2]]"], UNREAD: ["The waves do not.", None]})
    study = Study("methods", {"voyage": {"objective": "front"}}, {"method": ["exact", "nsga2"]})
    waves, blocks = study_notes(study, frame)
    assert waves.startswith("On the routes of 1 of 2 voyages") and waves.endswith("do not.")
    assert "the method exact has no such blocks" in blocks
    assert study_notes(Study("a", {"voyage": {}}), frame[["front"]]) == []


@pytest.mark.slow
def test_waves_without_effect_are_stated_in_the_summary(folder, tmp_path, capsys):
    waves = tmp_path / "waves.nc"
    name = "sea_surface_wave_significant_height"
    with xr.open_dataset(folder / "year.nc") as year:
        height = 0.0 * year["eastward_sea_water_velocity"] + 3.0
        height.attrs = {"standard_name": name, "units": "m"}
        height.rename(name).to_dataset().to_netcdf(waves)
    study = base(
        folder, ship="handysize-bulker", sea=[str(waves)], fill={"wind": 0, "currents": 0},
        axes={"depart": ["2026-02-05", "2026-02-06"]},
    )  # fmt: skip
    run_study(study, tmp_path / "out")
    (note,) = summarise_study(tmp_path / "out").notes
    assert "all voyages" in note and "The waves do not slow the ship: up to 3.0 m" in note
    assert main(["study", "summary", str(tmp_path / "out")]) == 0
    assert capsys.readouterr().out.count("The waves do not slow the ship") == 1


def test_a_draw_of_one_entry_does_not_depend_on_the_others():
    sample = {"count": 50, "seed": 3, "speed_kn": {"normal": [12.0, 0.5]}}
    data = {"voyage": {"start": "A", "goal": "B"}, "sample": sample}
    alone = [row.labels["speed_kn"] for row in Study.from_dict(data).rows()]
    sample["depart"] = {"uniform": ["2026-01-01", "2026-02-01"]}
    rows = list(Study.from_dict(data).rows())
    assert [row.labels["speed_kn"] for row in rows] == alone
    assert abs(np.mean(alone) - 12.0) < 0.25
    assert all("2026-01" <= row.labels["depart"] <= "2026-02-01T00:00:00Z" for row in rows)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"axis": {}}, "entry of a study"),
        ({"allowance_price": 80}, "belongs under annual. Write annual: {allowance_price: 80}"),
        ({"axes": {"spede_kn": [1]}}, "speed_kn"),
        ({"axes": {"speed_kn": []}}, "no values"),
        ({"axes": {"depart": {"from": "2026-02-01", "to": "2026-01-01", "step_h": 1}}}, "range"),
        ({"sample": {"count": 0}}, "count of the sample is 0. It is a whole number, 1 or more"),
        (
            {"axes": {"speed_kn": [10], "rules": [{"name": "a", "speed_kn": 11}]}},
            "Both the axis speed_kn and the axis rules set speed_kn",
        ),
        (
            {"axes": {"speed_kn": [10]}, "sample": {"speed_kn": {"normal": [11, 1]}}},
            "Both the axis speed_kn and the sample set speed_kn",
        ),
        (
            {"axes": {"way": [{"name": "a", "speed_kn": 11}, {"name": "a", "speed_kn": 12}]}},
            "Two values of the axis way have the name 'a'",
        ),
        ({"sample": {"speed_kn": {"poisson": [1]}}}, "uniform"),
        ({"compare": ["luck"]}, "comparison"),
        ({"fill": {"waves": "fetch"}}, "fetch"),
        ({"fill": 0}, "fill is 0"),
        ({"axes": {"fill": [{"wave": 0.0}]}}, "wave"),
        ({"limits": {"wave_height_m": 0}}, "above 0"),
        ({"limits": {"waves_m": 3}}, "limit named"),
        ({"charges": {"share_percent": 30}}, "0, 50 or 100"),
        ({"charges": {"ets_prize": 30}}, "ets_price"),
        ({"areas": {"type": "Point", "coordinates": [0, 0]}}, "areas only"),
        ({"axes": {"rules": [{"name": "a", "charges": {"year": 1999}}]}}, "a year from"),
        ({"axes": {"speed_kn": {"from": 0, "to": 1e9}}}, "At most"),
    ],
)
def test_wrong_studies(changes, words):
    with pytest.raises(InputError, match=words):
        Study.from_dict({"voyage": {"start": "A", "goal": "B"}} | changes)


@pytest.mark.parametrize(
    "changes", [{"network": math.nan}, {"axes": {"speed_kn": [12.0, math.inf]}}]
)
def test_values_of_a_study_are_finite(changes):
    study = Study.from_dict({"voyage": {"start": "A", "goal": "B"}} | changes)
    with pytest.raises(InputError, match=r"is \.nan or \.inf"):
        study.rows()


NO_GO = {
    "type": "Feature",
    "properties": {"kind": "no-go"},
    "geometry": {
        "type": "Polygon",
        "coordinates": [[[0.9, -0.1], [1.1, -0.1], [1.1, 0.1], [0.9, 0.1], [0.9, -0.1]]],
    },
}


def test_a_study_has_the_areas_limits_and_charges_of_a_plan(tmp_path):
    (tmp_path / "route.csv").write_text("lat,lon\n0,0\n0,2\n")
    entries = {"ship": "handysize-bulker", "sea": "calm", "coast": "none", "track": "route.csv"}
    voyage = {"start": [0.0, 0.0], "goal": [0.0, 2.0], "depart": "2026-03-01T00:00Z"}
    charges = {"share_percent": 100, "ets_price": 80.0}
    axes = {
        "rules": [
            {"name": "none"},
            {"name": "area", "areas": NO_GO},
            {"name": "charges", "charges": charges},
        ]
    }
    study = Study.from_dict(
        {**entries, "voyage": voyage, "limits": {"wave_height_m": 3}, "axes": axes}, tmp_path
    )
    free, area, charged = run_rows(study.rows(), str(tmp_path))
    assert free["feasible"] and free["refusal"] is None
    assert not area["feasible"] and "no-go" in area["first_violation"]
    assert charged["cost_usd"] > free["cost_usd"] and charged["fuel_t"] == free["fuel_t"]
    assert ship_of_request(study.rows()[0].request, "").limits.wave_height == 3.0


@pytest.mark.slow
def test_a_made_year_gives_its_best_month(folder, tmp_path):
    study = base(folder, compare=["weather_blind"])
    run_study(study, tmp_path / "out", chunk=5)
    summary = summarise_study(tmp_path / "out")
    assert summary.best["month"].tolist() == [6]
    rows = study_rows(tmp_path / "out")
    assert len(rows) == study.size and rows["refusal"].isna().all()
    june = rows[rows["depart"].str.startswith("2026-06")].iloc[0]
    other = rows[rows["depart"].str.startswith("2026-02")].iloc[0]
    length = june["distance_nm"] * 1852.0
    speed = length / (june["time_h"] * 3600.0) - 1.0
    assert length / (other["time_h"] * 3600.0) == pytest.approx(speed - 1.0, rel=1e-4)
    assert (rows["saved_time_h"] >= -0.01).all()
    files = summary.write(tmp_path / "tables")
    assert {path.name for path in files} == {
        "summary.csv", "months.png", "voyages.csv", "best_months.csv",
        "hours.csv", "hours.png",
    }  # fmt: skip
    assert summary.voyages["depart"].tolist() == sorted(rows["depart"])
    assert summary.voyages["time_h"].notna().all()


def test_a_voyage_that_ends_short_of_its_port_is_a_refusal(folder, monkeypatch):
    note = f"{NOT_REACHED} B, GB, where the waves are not known."
    short = SimpleNamespace(cancelled=False, notes=("Some note.", note))
    monkeypatch.setattr(row_runner, "_planned", lambda *_: short)
    study = base(folder, axes={"depart": ["2026-03-01T00:00Z"]})
    (row,) = row_runner.run_rows(study.rows(), str(folder))
    assert row["refusal"] == "CoverageError" and "Does not reach B" in row["reason"]


def test_a_ship_that_all_rows_share_and_that_is_wrong_stops_the_study(folder, tmp_path):
    with pytest.raises(InputError, match="hopper-dredgr"):
        run_study(base(folder, ship="hopper-dredgr"), tmp_path / "out")
    several = base(
        folder, ship=None,
        axes={"ship": ["hopper-dredger", "hopper-dredgr"], "depart": ["2026-03-01T00:00Z"]},
    )  # fmt: skip
    state = run_study(several, tmp_path / "several")
    assert (state.done, state.refused) == (2, 1)


@pytest.mark.slow
def test_a_study_goes_on_and_grows(folder, tmp_path):
    small = base(folder, axes={"depart": ["2026-03-01T00:00Z", "2026-03-02T00:00Z"]})
    assert run_study(small, tmp_path / "out").new == 2
    assert run_study(small, tmp_path / "out").new == 0
    departs = ["2026-03-01T00:00Z", "2026-03-02T00:00Z", "2026-03-03T00:00Z"]
    larger = base(folder, axes={"depart": departs})
    state = run_study(larger, tmp_path / "out")
    assert (state.new, state.done, state.total) == (1, 3, 3)
    assert len(study_rows(tmp_path / "out")) == 3
    other = base(folder, axes={"depart": ["2026-04-01T00:00Z"]})
    kept = (tmp_path / "out" / "study.json").read_text()
    with pytest.raises(InputError, match="holds 3 results of another study"):
        run_study(other, tmp_path / "out")
    assert (tmp_path / "out" / "study.json").read_text() == kept


@pytest.mark.slow
def test_refusals_are_rows(folder, tmp_path):
    study = base(
        folder, axes={"depart": ["2026-03-01T00:00Z", "2031-01-01T00:00Z"], "member": [None, 4]}
    )
    state = run_study(study, tmp_path / "out")
    rows = read_parts(tmp_path / "out")
    assert state.refused == 3 and len(rows) == 4
    assert sorted(rows["refusal"].dropna()) == ["InputError", "InputError", "OutsidePeriodError"]
    summary = summarise_study(tmp_path / "out")
    assert summary.refusals["voyages"].sum() == 3


def test_a_ship_that_cannot_be_made_leaves_the_year_of_the_others(folder, tmp_path):
    """The summary of 16 voyages stopped because the other ship had no price of fuel."""
    unpriced = {"name": "unpriced", "speeds_kn": [10], "hull": {"draught_m": 5.0}}
    (folder / "unpriced.yaml").write_text(yaml.safe_dump(unpriced))
    study = base(
        folder,
        sea="calm",
        charges={"ets_price": 80, "share_percent": 100},
        annual={"port_h": 10},
        axes={"ship": ["handysize-bulker", "unpriced.yaml"], "depart": ["2026-03-01T00:00Z"]},
    )
    assert run_study(study, tmp_path / "out").refused == 1
    summary = summarise_study(tmp_path / "out")
    (year,) = summary.annual.to_dict("records")
    assert year["ship"] == "handysize-bulker" and year["voyages_per_year"] > 100.0
    assert "fuel has no price" in summary.refusals["reason"].iloc[0]


@pytest.mark.slow
def test_a_study_without_any_route_is_summarised_with_the_reason(folder, tmp_path, capsys):
    study = base(folder, axes={"depart": ["2031-01-01T00:00Z", "2031-01-02T00:00Z"]})
    path = folder / "late.yaml"
    path.write_text(yaml.safe_dump(study.to_dict()))
    assert main(["study", "run", str(path), "--out", str(tmp_path / "out"), "--quiet"]) == 3
    assert "2 of them without a route\n1 of these: " in capsys.readouterr().out
    assert main(["study", "summary", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "1 voyage without a route (OutsidePeriodError)" in printed and "2027" in printed


def test_savings_are_stated_with_the_voyages_that_have_none(capsys):
    hours, saved = [100.0, 120.0, 60.0], [np.nan, 3.0, 1.0]
    voyages = pd.DataFrame({"time_h": hours, "saved_time_h": saved, "saved_fuel_t": saved})
    _print_savings(voyages)
    _print_savings(voyages.iloc[:1])
    _print_savings(pd.DataFrame({"time_h": hours}))
    some, none = capsys.readouterr().out.strip().split("\n\n")
    first = "Against the route that ignores the weather,"
    last = "; on the others that route does not keep the limits, and no saving is counted."
    assert some == f"{first} 2 of 3 voyages save 2.00 h and 2.00 t on average{last}"
    assert none == f"{first} 0 of 1 voyages have a saving{last}"


def comparable(frame: pd.DataFrame) -> list:
    frame = frame.drop(columns=["seconds"]).sort_values("id")
    return frame[sorted(frame.columns)].astype(object).where(frame.notna(), None).values.tolist()


@pytest.fixture(scope="module")
def serial(folder, tmp_path_factory):
    """Return the results of a study of four days, run in this process."""
    made = tmp_path_factory.mktemp("serial")
    run_study(base(folder, axes={"depart": DAYS}), made / "out", chunk=3)
    return comparable(read_parts(made / "out"))


@pytest.mark.slow
def test_processes_give_the_same_bits_and_a_killed_one_loses_nothing(folder, tmp_path, serial):
    study = base(folder, axes={"depart": DAYS})
    killed = []

    def kill_one(state) -> None:
        if not killed:
            import multiprocessing

            victim = multiprocessing.active_children()[0]
            os.kill(victim.pid, signal.SIGKILL)
            killed.append(victim.pid)

    run_study(study, tmp_path / "parallel", workers=2, chunk=1, progress=kill_one)
    assert killed
    assert comparable(read_parts(tmp_path / "parallel")) == serial


def first_row_only(rows, folder):
    return run_rows(rows[:1], folder)


@pytest.mark.slow
def test_long_chunks_are_kept_in_parts(folder, tmp_path, serial, monkeypatch):
    """A chunk whose voyages take long is written as it goes, here and in processes."""
    study = base(folder, axes={"depart": DAYS})
    monkeypatch.setattr(study_run, "_KEEP_S", 0.0)
    monkeypatch.setattr(study_run, "run_for_a_while", first_row_only)
    for workers in (0, 2):
        steps = []
        out = tmp_path / f"parts of {workers}"
        run_study(study, out, workers=workers, chunk=len(DAYS), progress=steps.append)
        assert [state.done for state in steps] == list(range(1, len(DAYS) + 1))
        assert comparable(read_parts(out)) == serial


@pytest.mark.slow
def test_a_killed_driver_is_followed_by_one_that_finishes(folder, tmp_path):
    study = base(folder, axes={"depart": DAYS})
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump(study.to_dict()))
    words = ["study", "run", str(path), "--out", str(tmp_path / "out"), "--quiet"]
    command = [sys.executable, "-m", "thalweg.cli.main", *words]
    code = (
        "import thalweg.studies.study_run as r; r.CHUNK = 1; r.run_study.__kwdefaults__['chunk']=1;"
    )
    code += f"from thalweg.cli.main import main; main({words!r})"
    driver = subprocess.Popen([sys.executable, "-c", code])
    parts = tmp_path / "out" / "parts"
    while len(list(parts.glob("part-*"))) < 2 and driver.poll() is None:
        time.sleep(0.02)
    driver.kill()
    driver.wait()
    done = len(read_parts(tmp_path / "out"))
    assert done >= 2
    assert subprocess.run(command, capture_output=True).returncode == 0
    rows = read_parts(tmp_path / "out")
    assert sorted(rows["id"]) == sorted(row.id for row in study.rows())


@pytest.mark.slow
def test_a_folder_has_one_driver_at_a_time(folder, tmp_path):
    study = base(folder, axes={"depart": DAYS})
    refused = []

    def start_another(state) -> None:
        with pytest.raises(InputError, match="Another process runs a study in") as caught:
            run_study(study, tmp_path / "out")
        refused.append(caught.value)

    run_study(study, tmp_path / "out", chunk=len(DAYS), progress=start_another)
    assert len(refused) == 1
    assert run_study(study, tmp_path / "out").new == 0  # free again


@pytest.mark.slow
def test_a_cluster_gives_the_same_rows(folder, tmp_path):
    distributed = pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")
    study = base(folder, axes={"depart": ["2026-03-01T00:00Z", "2026-03-02T00:00Z"]})
    run_study(study, tmp_path / "serial")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None, processes=False
    ) as cluster:
        run_study(study, tmp_path / "cluster", scheduler=cluster.scheduler_address, chunk=1)
    serial, parallel = (read_parts(tmp_path / name) for name in ("serial", "cluster"))
    assert comparable(serial) == comparable(parallel)


def test_a_row_with_a_fault_of_its_own_is_a_row(folder):
    study = base(folder, axes={"depart": ["2026-03-01T00:00Z"], "resolution_nm": ["wide"]})
    [result] = run_rows(study.rows()[:1], str(folder))
    assert result["refusal"] == "InternalError" and "wide" in result["reason"]


def test_the_interval_of_a_median_covers():
    generator = np.random.default_rng(5)
    hits = 0
    for _ in range(400):
        low, high = median_interval(generator.exponential(size=41))
        hits += low <= np.log(2.0) <= high
    assert 0.88 <= hits / 400 <= 0.97
    assert np.isnan(median_interval(np.arange(3.0))).all()


@pytest.mark.slow
def test_the_name_of_a_ready_study_is_no_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["study", "run", "weights", "--out", "o"]) == 2
    assert "thalweg study ready weights > weights.yaml" in capsys.readouterr().err


def test_the_command_line(folder, tmp_path, capsys):
    path = folder / "small.yaml"
    study = base(folder, axes={"depart": ["2026-03-01T00:00Z", "2026-06-02T00:00Z"]})
    path.write_text(yaml.safe_dump(study.to_dict()))
    assert main(["study", "run", str(path), "--out", str(tmp_path / "o"), "--count"]) == 0
    assert capsys.readouterr().out == "2 voyages\n"
    assert main(["study", "run", str(path), "--out", str(tmp_path / "o")]) == 0
    assert "2 of 2 voyages" in capsys.readouterr().out
    assert main(["study", "summary", str(tmp_path / "o"), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert [group["month"] for group in answer["groups"]] == [3, 6]
    assert answer["best"][0]["month"] == 6
    assert [row["depart"][:10] for row in answer["voyages"]] == ["2026-03-01", "2026-06-02"]
    assert all(row["time_h"] > 0.0 for row in answer["voyages"])
    assert main(["study", "summary", str(tmp_path / "o")]) == 0
    assert "2026-06-02" in capsys.readouterr().out
    assert main(["study", "summary", str(tmp_path / "nothing")]) == 2
    assert "has no study" in capsys.readouterr().err


def test_times_of_a_sample_are_within_it():
    first, last = parse_time("2026-01-01"), parse_time("2026-01-03")
    sample = {"count": 20, "depart": {"uniform": ["2026-01-01", "2026-01-03"]}}
    data = {"voyage": {"start": "A", "goal": "B"}, "sample": sample}
    for row in Study.from_dict(data).rows():
        assert first <= parse_time(row.labels["depart"]) <= last


def test_a_range_that_runs_backwards_is_stated_as_it_was_given():
    given = {"from": "2026-01-10", "to": "2026-01-09", "step_h": 24}
    with pytest.raises(InputError, match="from 2026-01-10, to 2026-01-09, step_h 24"):
        axis_values("depart", given)


def test_a_row_whose_route_exceeds_a_limit_has_no_route():
    """A run stated 0 of them without a route, and its summary a share of 1.0."""
    assert has_route({"refusal": None, "feasible": True})
    assert has_route({"refusal": None})  # of a front, whose row has no such entry
    assert not has_route({"refusal": None, "feasible": False})
    assert not has_route({"refusal": None, "feasible": np.False_})
    assert not has_route({"refusal": "NoRouteError", "reason": "..."})


@pytest.mark.slow
def test_sampled_values_are_columns_of_the_table_of_voyages(tmp_path):
    study = Study.from_dict(
        {
            "voyage": {"start": [47.0, -5.0], "goal": [47.3, -5.3], "depart": "2026-01-01"},
            "ship": "handysize-bulker", "sea": "calm", "coast": "c", "resolution_nm": 4.0,
            "sample": {"count": 2, "seed": 1, "speed_kn": {"uniform": [12.0, 14.0]}},
        }
    )  # fmt: skip
    run_study(study, tmp_path)
    table = summarise_study(tmp_path).voyages
    assert table["speed_kn"].between(12.0, 14.0).all() and table["speed_kn"].nunique() == 2


@pytest.mark.parametrize(
    ("entry", "distribution"),
    [
        ("speed_kn", {"normal": [12, -1]}),
        ("speed_kn", {"uniform": [14, 12]}),
        ("speed_kn", {"normal": [12, "abc"]}),
        ("depart", {"normal": ["2026-01-01T00:00Z", -3]}),
        ("depart", {"uniform": ["2026-01-02T00:00Z", "2026-01-01T00:00Z"]}),
        ("depart", {"normal": ["soon", 3]}),
    ],
)
def test_distributions_without_draws_are_refused_with_the_study(entry, distribution):
    """Once a traceback of numpy, after the study was accepted."""
    given = {"voyage": {"start": "Dover", "goal": "Calais"}, "sample": {entry: distribution}}
    with pytest.raises(InputError, match=f"The distribution of {entry} is ") as caught:
        Study.from_dict(given)
    assert "not below the lower one" in caught.value.possible


def test_a_misspelt_port_is_refused_before_the_study_starts(tmp_path):
    ship = {"voyage": {"start": "Dover", "depart": "2026-01-01T00:00Z"}, "ship": "handysize-bulker"}
    study = Study.from_dict(ship | {"sea": "calm", "axes": {"goal": ["Calais", "Dovre"]}})
    with pytest.raises(InputError, match="no port named 'Dovre'"):
        run_study(study, tmp_path / "out")
    assert not (tmp_path / "out" / "study.json").exists()


@pytest.mark.parametrize("detail", ["refined", "network"])
def test_an_ensemble_without_a_member_is_no_single_forecast(folder, tmp_path, capsys, detail):
    """The row had the figures of one member that it did not name."""
    with xr.open_dataset(folder / "year.nc") as year:
        short = year.isel(time=slice(0, 400)).load()
    xr.concat([short, short], "number").to_netcdf(tmp_path / "members.nc")
    voyage = {"start": [0.0, 0.0], "goal": [0.0, 3.0], "speed_kn": 10.0}
    entries = {
        "voyage": {**voyage, "depart": "2026-03-01T00:00Z"},
        "sea": "members.nc",
        "ship": {"name": "s", "speeds_kn": [10.0], "hull": {"draught_m": 4.0}},
        "coast": "none",
        "detail": detail,
    }
    (tmp_path / "e.yaml").write_text(yaml.safe_dump(entries))
    assert main(["study", "run", str(tmp_path / "e.yaml"), "--out", str(tmp_path / "out")]) == 2
    assert "2 members, and the study names none" in capsys.readouterr().out
