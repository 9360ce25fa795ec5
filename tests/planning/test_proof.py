"""Plans with a certificate of their bound."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thalweg.chart import Chart
from thalweg.chart.passages import Passage
from thalweg.core.errors import InputError
from thalweg.planning import Voyage, plan
from thalweg.planning.single import certified_bound
from thalweg.planning.single.certified_bound import usual_proof_time
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship

VOYAGE = Voyage(start="48.0N 8.0W", goal="46.0N 8.0W", depart="2026-01-01", offing_nm=0.0)


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "distance"])
def test_in_still_water_a_plan_is_proven_to_half_a_per_cent(objective):
    voyage = replace(VOYAGE, objective=objective)
    ship = Ship.load("handysize-bulker")
    found = plan(voyage, ship=ship, sea=Sea.calm(), proof=5.0)
    assert "certificate" in found.proof.kind or found.gap < 0.002
    assert 0.0 <= found.gap < 0.006
    assert found.proof.certain <= found.objective_value


@pytest.mark.parametrize("seconds", [-1.0, float("nan"), 1e9])
def test_an_impossible_time_for_the_proof_is_refused(seconds):
    with pytest.raises(InputError, match="proof"):
        plan(VOYAGE, ship=Ship.load("handysize-bulker"), sea=Sea.calm(), proof=seconds)


@pytest.mark.parametrize(("lon", "least"), [(1.2, 15.0), (30.0, 1.0)])
def test_the_proof_has_time_for_outlines_where_a_closed_passage_is_within_reach(
    lon, least, monkeypatch
):
    """In the time of a short search the bound counted the way through: 25 % for 3 %."""
    monkeypatch.setattr(certified_bound, "LONGEST_PROOF", 30.0)  # tests have less
    passage = Passage("gap", "trade", ((0.0, lon - 0.3), (0.0, lon + 0.4)), 5000.0)
    chart = replace(Chart.open_water(), closed_passages=(passage,))
    route = evaluate(
        [(0.0, 0.0), (1.0, 1.2), (0.0, 3.0)],
        ship=Ship.simple(speed_kn=14.0),
        sea=Sea.calm(),
        depart=0.0,
    )
    assert usual_proof_time(chart, [route], 0.5) == least
    assert usual_proof_time(chart, [route], 20.0) == 20.0
    assert usual_proof_time(chart, [route], 99.0) == 30.0
    assert usual_proof_time(Chart.open_water(), [route], 0.5) == 1.0
