"""Plans with a certificate of their bound."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thalweg.core.errors import InputError
from thalweg.planning import Voyage, plan
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
