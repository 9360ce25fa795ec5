"""Ready studies, statistics of fronts with known answers, and figures of a year."""

from __future__ import annotations

import json
import math

import pandas as pd
import pytest
import yaml

pytest.importorskip("pyarrow", reason="the extra 'studies' is not installed")

from thalweg.cli.main import main
from thalweg.core.errors import InputError
from thalweg.planning import Voyage
from thalweg.ship import Ship
from thalweg.studies import (
    Study,
    front_statistics,
    ready_studies,
    ready_study,
    run_study,
    summarise_study,
)
from thalweg.studies.annual_figures import annual_figures, checked_annual, share_of_voyage
from thalweg.studies.study_summary import StudySummary


@pytest.mark.slow
@pytest.mark.parametrize("name", ready_studies())
def test_ready_studies_are_understood(name):
    study = Study.from_dict(yaml.safe_load(ready_study(name)))
    assert 2 <= study.size <= 50
    for row in study.rows():
        Voyage.from_dict(row.request["voyage"])
        assert Ship.load(row.request["ship"]).name
        assert "sea" in row.request


def test_what_a_ready_study_shows_is_said_in_whole_sentences():
    for about in ready_studies().values():
        assert about.endswith(".") and not about.endswith("ch."), about


def test_ready_studies_are_listed_and_printed(capsys):
    assert main(["study", "ready"]) == 0
    assert "fleet " in capsys.readouterr().out
    assert main(["study", "ready", "fleet"]) == 0
    assert yaml.safe_load(capsys.readouterr().out)["annual"]["port_h"] == 48
    assert main(["study", "ready", "fleat"]) == 2
    assert "fleet" in capsys.readouterr().err


@pytest.mark.slow
def test_departures_of_the_coast_season_differ_and_so_does_the_best_way(tmp_path):
    """A storm reaches the coast, so that a study of departures has something to compare."""
    data = yaml.safe_load(ready_study("coast-season"))
    # half of its departures: what differs among them differs among all
    data["axes"]["depart"] |= {"from": "1998-09-04T12:00Z", "step_h": 24}
    study = Study.from_dict(data, tmp_path)
    run_study(study, tmp_path / "result")
    summary = summarise_study(tmp_path / "result")
    sick = summary.voyages.groupby("way")["sick_percent"]
    assert len(sick) == 2 and (sick.max() > 2.0 * sick.min()).all()
    chosen = summary.choices.set_index("value")["chosen"]
    assert len(chosen) == 2 and chosen.min() > 0.0 and chosen.sum() == pytest.approx(1.0)


def fronts() -> pd.DataFrame:
    """A covers all of B; their union is A, of hypervolume 3 to the point (3, 3)."""
    a, b = [[1.0, 2.0], [2.0, 1.0]], [[2.0, 2.0], [3.0, 3.0]]
    rows = [("exact", 1, a), ("nsga2", 1, b), ("nsga2", 2, a)]
    return pd.DataFrame(
        [{"id": str(k), "method": m, "seed": s, "front": json.dumps(f)}
         for k, (m, s, f) in enumerate(rows)]
    )  # fmt: skip


def test_fronts_by_method_have_the_known_indicators():
    table = front_statistics(fronts(), ["method", "seed"])
    whole = 2.02 * 1.02 + 1.02 * 1.0  # to the reference point (3.02, 3.02)
    assert table["hypervolume"].tolist() == pytest.approx([whole, 1.02**2, whole], abs=1e-6)
    ratios = [1.0, 1.02**2 / whole, 1.0]
    assert table["hypervolume_ratio"].tolist() == pytest.approx(ratios, abs=1e-6)
    assert table["covered_by_exact"].iloc[1] == 1.0
    assert table["covered_by_nsga2"].iloc[0] == 0.5  # by its equal, and by none of the other
    assert front_statistics(fronts().assign(front=None), ["method"]).empty


@pytest.mark.parametrize("ids", [["0", "1", "2"], [0, 1, 2]], ids=["text", "number"])
def test_fronts_without_methods_are_those_of_the_default(ids):
    table = front_statistics(fronts().drop(columns="method").assign(id=ids), ["seed"])
    assert table["covered_by_default"].tolist() == pytest.approx([0.5, 1.0, 0.5])


def test_a_year_of_voyages():
    rows = pd.DataFrame(
        {"ship": ["a", "a"], "time_h": [190.0, 210.0], "distance_nm": [2000.0, 2400.0],
         "fuel_t": [90.0, 110.0], "co2_t": [300.0, 320.0], "cost_usd": [None, None]}
    )  # fmt: skip
    ship = Ship.load("kvlcc2")
    annual = checked_annual({"port_h": 19.0})
    table = annual_figures(rows, ["ship"], {"a": ship}, annual)
    row = table.iloc[0]
    assert row["voyages_per_year"] == pytest.approx(8760.0 / 219.0)  # 40
    assert (row["distance_nm"], row["fuel_t"], row["co2_t"]) == pytest.approx((88e3, 4e3, 12.4e3))
    deadweight = ship.file.hull.deadweight_t
    assert row["cii"] == pytest.approx(12.4e9 / (deadweight * 88e3))
    assert row["cii_rating"] in "ABCDE"
    assert "charges_in_cost" not in table
    charged = annual_figures(rows.assign(charged=[False, True]), ["ship"], {"a": ship}, annual)
    assert bool(charged.iloc[0]["charges_in_cost"])


def test_european_charges_and_rating_of_a_ship_year_by_hand():
    """Rates: Directive 2003/87/EC, 3ga, 3gb; Regulation (EU) 2023/1805, annexes II and IV B; MEPC.

    40 voyages a year, half in scope, of 90 t of heavy fuel oil, CO2 factor 3.114 (MEPC.364(79)).
    """
    tonnes, share, trips = 90.0, 0.5, 8760.0 / 219.0
    rows = pd.DataFrame(
        {"ship": ["a"], "time_h": [200.0], "distance_nm": [2200.0], "fuel_t": [tonnes],
         "fuel_eca_t": [0.0], "co2_t": [3.114 * tonnes], "eu_share": [share]}
    )  # fmt: skip
    ship = Ship.load("kvlcc2")
    annual = checked_annual(
        {"port_h": 19.0, "year": 2025, "allowance_price": 80, "euro_price": 1.1}
    )
    row = annual_figures(rows, ["ship"], {"a": ship}, annual).iloc[0]
    # 40 voyages x 90 t x 3.114 x half in scope x 70 % in 2025 x 80 USD
    assert row["eu_ets_cost"] == pytest.approx(trips * tonnes * 3.114 * 0.5 * 0.7 * 80.0)
    # well to wake of HFO 91.744 g/MJ against 91.16 x 0.98; 40,500 MJ/t; 2400 EUR per 41,000 MJ
    intensity = 13.5 + (3.114 + 25 * 0.00005 + 298 * 0.00018) / 0.0405
    balance = (intensity - 91.16 * 0.98) * trips * tonnes * 40_500.0 * share
    assert row["fueleu_penalty"] == pytest.approx(balance / (intensity * 41_000.0) * 2400.0 * 1.1)
    # CII of a tanker: 5247 DWT^-0.610 (MEPC.353(78)), 9 % below in 2025 (MEPC.338(76))
    deadweight = ship.file.hull.deadweight_t
    attained = trips * tonnes * 3.114e6 / (deadweight * trips * 2200.0)
    assert row["cii"] == pytest.approx(attained, rel=1e-6)
    required = 0.91 * 5247.0 * deadweight**-0.610
    assert row["cii_required"] == pytest.approx(required, rel=1e-6)
    bounds = [required * d for d in (0.82, 0.93, 1.08, 1.28)]  # MEPC.354(78), Table 1
    assert row["cii_rating"] == "ABCDE"[sum(attained > b for b in bounds)]
    later = annual_figures(rows, ["ship"], {"a": ship}, {**annual, "year": 2026}).iloc[0]
    assert later["eu_ets_cost"] == pytest.approx(trips * tonnes * 3.1631 * 0.5 * 80.0)
    small = Ship.from_dict({**ship.file.plain(), "hull": {**ship.file.plain()["hull"],
                                                          "gross_tonnage": 4999.0}})  # fmt: skip
    below = annual_figures(rows, ["ship"], {"a": small}, annual).iloc[0]  # the rules: from 5,000 GT
    assert below["fuel_t"] == row["fuel_t"]
    for name in ("eu_ets_cost", "fueleu_penalty", "cii", "cii_rating"):
        assert below[name] is None
    unknown = annual_figures(rows.assign(eu_share=float("nan")), ["ship"], {"a": ship}, annual)
    assert unknown.iloc[0]["eu_ets_cost"] is None


def test_the_share_in_scope_is_that_of_the_ports_or_given():
    ports = {"start": "Rotterdam", "goal": "New York"}
    assert share_of_voyage(ports, {}) == 0.5
    assert share_of_voyage({**ports, "goal": "Lisbon"}, {}) == 1.0
    assert share_of_voyage({"start": [50.0, -6.0], "goal": "Lisbon"}, {"eu_share": 100}) == 1.0
    assert math.isnan(share_of_voyage({"start": [50.0, -6.0], "goal": "Lisbon"}, {}))


@pytest.mark.parametrize(
    "given", [{"port": 1}, {"port_h": -1}, {"year": 1990}, {"eu_share": 30}, 3]
)
def test_wrong_annual_entries(given):
    with pytest.raises(InputError, match="annual"):
        Study.from_dict({"voyage": {"start": "A", "goal": "B"}, "annual": given})


def test_tables_and_plots_are_written(tmp_path):
    nothing = pd.DataFrame()
    table = front_statistics(fronts(), ["method", "seed"])
    summary = StudySummary(
        table=pd.DataFrame({"voyages": [3]}),
        refusals=nothing,
        best=nothing,
        fronts=table,
        annual=pd.DataFrame({"fuel_t": [1.0]}),
        voyages=pd.DataFrame({"time_h": [1.0]}),
    )
    names = {path.name for path in summary.write(tmp_path)}
    tables = {f"{name}.csv" for name in ("summary", "voyages", "fronts", "annual")}
    assert names == tables | {"fronts.png"}
    assert len((tmp_path / "fronts.csv").read_text().splitlines()) == 4
