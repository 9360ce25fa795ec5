"""Weather windows, choices and heat maps of seasons with known answers."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib.image import imread

from thalweg.core.errors import InputError
from thalweg.studies import Study, study_run, summarise_study
from thalweg.studies.season_plots import draw_heat_map
from thalweg.studies.season_tables import (
    choices_by_axis,
    departure_windows,
    inshore_share,
    month_by_hour,
)
from thalweg.studies.study_parts import read_parts

VOYAGE = {
    "ship": "gunnerus",
    "voyage": {"start": "Dover", "goal": "Calais", "depart": "2026-01-01"},
}


def departures(count: int, step_h: float = 12.0) -> list[str]:
    times = pd.date_range("2026-01-01", periods=count, freq=pd.Timedelta(hours=step_h))
    return [time.strftime("%Y-%m-%dT%H:%M:%SZ") for time in times]


def test_waiting_days_until_a_departure_with_a_route():
    frame = pd.DataFrame({"depart": departures(6)})
    good = pd.Series([True, False, False, True, True, False])
    found = departure_windows(frame, good)  # 0, 1, 0.5, 0 and 0 days; the last one is not known
    assert found == {"waiting_days_mean": 0.3, "waiting_days_max": 1.0}
    assert departure_windows(frame, ~good | good) == {
        "waiting_days_mean": 0.0, "waiting_days_max": 0.0,
    }  # fmt: skip
    assert set(departure_windows(frame, good & ~good).values()) == {None}


def test_share_of_routes_that_are_inshore():
    routes = pd.DataFrame({"inshore_percent": [80.0, 20.0, 50.0, np.nan]})
    assert inshore_share(routes) == pytest.approx(2.0 / 3.0)
    assert inshore_share(pd.DataFrame({"time_h": [1.0]})) is None


def test_choices_and_their_persistence():
    """Inshore is faster on the 2nd, 3rd and 4th of five departures; offshore has no 4th route."""
    times = departures(5)
    inshore = pd.DataFrame({"depart": times, "way": "inshore", "time_h": [9.0, 7, 7, 9, 9]})
    offshore = pd.DataFrame({"depart": times, "way": "offshore", "time_h": [8.0, 8, 8, 8, 8]})
    frame = pd.concat([inshore, offshore], ignore_index=True)
    frame["month"], frame["objective"] = 1, "time"
    usable = ~((frame["depart"] == times[3]) & (frame["way"] == "offshore"))
    table = choices_by_axis(frame, usable, ["way"]).set_index("value")
    assert table["chosen"].to_dict() == {"inshore": 0.6, "offshore": 0.4}
    assert table["persistence"].tolist() == [0.5, 0.5]  # i i stays, i i stays; o i and i o do not
    assert table["departures"].tolist() == [5, 5]
    assert choices_by_axis(inshore.assign(objective="time"), usable[:5], ["way"]).empty


def test_a_departure_is_divided_among_values_that_are_equally_good():
    times = departures(4)
    first = pd.DataFrame({"depart": times, "way": "a", "time_h": [8.0, 8.0, 7.0, 8.0]})
    second = pd.DataFrame({"depart": times, "way": "b", "time_h": [8.0, 8.0 + 1e-9, 8.0, 7.0]})
    third = pd.DataFrame({"depart": times, "way": "c", "time_h": [9.0, 9.0, 9.0, 9.0]})
    frame = pd.concat([second, third, first], ignore_index=True).assign(objective="time", month=1)
    table = choices_by_axis(frame, frame["time_h"] > 0.0, ["way"]).set_index("value")
    assert table["chosen"].to_dict() == {"a": 0.5, "b": 0.5}  # two halves and one whole each
    assert table["tied"].to_dict() == {"a": 0.5, "b": 0.5}
    assert table["departures"].tolist() == [4, 4]
    assert table["persistence"].tolist() == pytest.approx([1 / 3, 1 / 3])  # ab ab a b


def test_heat_map_of_month_and_hour(tmp_path):
    times = departures(120)
    frame = pd.DataFrame({"depart": times, "time_h": np.tile([10.0, 12.0], 60)})
    frame["month"] = pd.to_datetime(frame["depart"]).dt.month
    table = month_by_hour(frame, ["time_h"])
    assert table.groupby("hour")["time_h"].median().to_dict() == {0: 10.0, 12: 12.0}
    assert table["routes"].sum() == 120
    assert draw_heat_map(table, "time_h", tmp_path / "hours.png").stat().st_size > 5_000
    assert month_by_hour(frame[frame["month"] == 1], ["time_h"]).empty


def test_random_departures_share_the_rows_of_a_heat_map(tmp_path):
    """60 draws in two months: a row of one hour would have one or two routes."""
    draw = np.random.default_rng(1)
    times = pd.Timestamp("2026-01-01", tz="UTC") + pd.to_timedelta(draw.uniform(0, 59, 60), "D")
    frame = pd.DataFrame({"depart": times.strftime("%Y-%m-%dT%H:%M:%SZ"), "month": times.month})
    frame["time_h"] = 10.0 + times.hour
    table = month_by_hour(frame, ["time_h"])
    assert set(table["hours"]) == {4} and set(table["hour"]) <= set(range(0, 24, 4))
    assert table["routes"].sum() == 60 and table["routes"].median() >= 5
    assert (table["time_h"] >= 10.0 + table["hour"]).all()
    assert (table["time_h"] < 14.0 + table["hour"]).all()
    two = imread(draw_heat_map(table, "time_h", tmp_path / "hours.png"))
    january = table[table["month"] == 1]
    year = pd.concat([january.assign(month=month) for month in range(1, 13)])
    whole = imread(draw_heat_map(year, "time_h", tmp_path / "year.png"))
    assert (two.shape[1], whole.shape[1]) == (540, 960)  # months without departures have no column


def test_accuracies_and_single_departures_are_no_choices():
    rows = pd.DataFrame({"depart": departures(2), "time_h": [9.0, 8.0], "month": 1})
    rows = pd.concat([rows.assign(sampling="linear"), rows.assign(sampling="nearest:8")])
    rows = rows.assign(objective="time", way=rows["sampling"]).reset_index(drop=True)
    usable = rows["time_h"] > 0.0
    assert choices_by_axis(rows, usable, ["sampling"]).empty
    assert not choices_by_axis(rows, usable, ["way"]).empty
    once = rows[rows["depart"] == rows["depart"].iloc[0]]
    assert choices_by_axis(once, usable[once.index], ["way"]).empty


def test_ctrl_c_keeps_the_finished_voyages_of_a_chunk(tmp_path, monkeypatch):
    pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")
    departs = departures(5)
    study = Study.from_dict(VOYAGE | {"axes": {"depart": departs}})

    def stopped(rows, folder):
        if rows[0].labels["depart"] == departs[3]:
            raise KeyboardInterrupt
        return [{"id": row.id, "refusal": None, "reason": None} for row in rows]

    monkeypatch.setattr(study_run, "run_rows", stopped)
    with pytest.raises(KeyboardInterrupt):
        study_run.run_study(study, tmp_path)
    assert len(read_parts(tmp_path)) == 3


def test_long_chunks_are_kept_in_parts(tmp_path, monkeypatch):
    """Each row that takes long is on disk before the next one begins."""
    pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")
    study = Study.from_dict(VOYAGE | {"axes": {"seed": [1, 2, 3]}})
    kept = []

    def planned(rows, folder):
        kept.append(len(read_parts(tmp_path, ["id"])))
        return [{"id": row.id, "refusal": None, "reason": None} for row in rows]

    monkeypatch.setattr(study_run, "run_rows", planned)
    monkeypatch.setattr(study_run, "_KEEP_S", 0.0)
    seen = []
    study_run.run_study(study, tmp_path, progress=lambda state: seen.append(state.done))
    assert kept == [0, 1, 2] and seen == [1, 2, 3]


@pytest.mark.parametrize("workers, longest", [(0, 20), (2, 3), (8, 1)])
def test_short_studies_are_cut_for_all_processes(tmp_path, monkeypatch, workers, longest):
    pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")
    study = Study.from_dict(VOYAGE | {"axes": {"seed": list(range(20))}})
    lengths = []

    def noted(chunks, *_):
        lengths.extend(len(chunk) for chunk in chunks)
        return iter(())

    monkeypatch.setattr(study_run, "_results", noted)
    study_run.run_study(study, tmp_path, workers=workers)
    assert max(lengths) == longest and sum(lengths) == 20


def test_percentiles_by_month_are_those_of_the_departures(tmp_path, monkeypatch):
    """A made year of 730 departures: known quantiles, best month and confidence interval."""
    pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")
    depart = {"from": "2026-01-01", "to": "2026-12-31", "step_h": 12}
    study = Study.from_dict(VOYAGE | {"axes": {"depart": depart}})
    draw = np.random.default_rng(5).gamma(4.0, 1.0, study.size)
    months = pd.to_datetime([row.labels["depart"] for row in study.rows()]).month.to_numpy()
    hours = np.where(months == 5, 20.0, 24.0) + draw
    known = {row.id: value for row, value in zip(study.rows(), hours)}

    def planned(rows, folder):
        return [
            {"id": row.id, **row.labels, "time_h": known[row.id], "feasible": True,
             "refusal": None, "reason": None}
            for row in rows
        ]  # fmt: skip

    monkeypatch.setattr(study_run, "run_rows", planned)
    study_run.run_study(study, tmp_path)
    summary = summarise_study(tmp_path)
    table = summary.table.set_index("month")
    assert list(table.index) == list(range(1, 13))
    for month in range(1, 13):
        own = np.sort(hours[months == month])
        row = table.loc[month]
        assert row["voyages"] == row["routes"] == len(own)
        found = row[["time_h_p10", "time_h_p50", "time_h_p90"]].to_numpy(float)
        assert found == pytest.approx(np.quantile(own, [0.1, 0.5, 0.9]), rel=1e-12)
        assert row["time_h_p50_low"] in own and row["time_h_p50_high"] in own
        assert row["time_h_p50_low"] < row["time_h_p50"] < row["time_h_p50_high"]
    assert summary.best_months["month"].tolist() == [5]
    assert summary.hours["routes"].sum() == study.size and summary.left == 0
    parts = sorted(tmp_path.rglob("*.parquet"))
    lost = len(pd.read_parquet(parts[0]))
    parts[0].unlink()
    if lost == study.size:  # one part
        return
    assert summarise_study(tmp_path).left == lost


def test_a_study_with_an_impossible_voyage_is_refused_before_any_is_planned(tmp_path, monkeypatch):
    pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")
    study = Study.from_dict(VOYAGE | {"axes": {"speed_kn": [12, "x"]}})
    monkeypatch.setattr(study_run, "run_rows", lambda rows, folder: pytest.fail("planned"))
    with pytest.raises(InputError, match="speed_kn must be a number, not 'x'"):
        study_run.run_study(study, tmp_path)
