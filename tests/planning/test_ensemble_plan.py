"""Plans over members of which some close the route: the others decide, and the plan states it."""

from __future__ import annotations

import json

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.units import KNOT
from thalweg.network import fixed_route
from thalweg.planning.report.plan_summary import members_text

START, GOAL = (0.0, 0.0), (0.0, 0.5)
LENGTH = float(distance(*START, *GOAL))
SHIP = Ship.from_dict(
    {
        "name": "cubic",
        "hull": {"draught_m": 5.0},
        "speeds_kn": [6.0, 12.0],
        "engine": {"reference_speed_kn": 12.0},
        "fuel": {"reference_t_per_day": 24.0},
        "models": {"calm_water": "cubic"},
        "limits": {"max_significant_wave_height_m": 2.0},
    }
)


def member(set_kn: float, wave: float) -> Sea:
    """Return a sea that runs to the east, with waves of one height."""
    return Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: set_kn * KNOT + 0.0 * t,
            "northward_sea_water_velocity": lambda t, y, x: 0.0 * t,
            "sea_surface_wave_significant_height": lambda t, y, x: wave + 0.0 * t,
        }
    )


def planned(sea: Sea, objective: str):
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective=objective,
        ensemble="mean", method="exact",
    )  # fmt: skip
    return plan(
        voyage,
        ship=SHIP,
        sea=sea,
        chart=Chart.open_water(-1.0, 1.0, -0.5, 1.0),
        network=lambda chart, start, goal, spacing: fixed_route(chart, [start, goal], spacing=20e3),
    )


@pytest.mark.parametrize("objective", ["front", "fuel"])
@pytest.mark.slow
def test_a_member_that_closes_every_route_leaves_the_choice_to_the_others(objective):
    """A front over such members ended in an IndexError."""
    found = planned(Sea.ensemble(member(1.0, 1.0), member(-1.0, 1.0), member(0.0, 3.0)), objective)
    row = found.ensemble[0]
    assert row["infeasible"] == [2] and row["time_risk_h"] is None and row["value_risk"] is None
    knots = 12.0 if objective == "front" else 6.0  # the first of a front is the fastest
    hours = [LENGTH / ((knots + set_kn) * KNOT) / 3600.0 for set_kn in (1.0, -1.0)]
    assert row["time_h"]["mean"] == pytest.approx(sum(hours) / 2.0, rel=1e-6)
    assert any("No route of these plans" in note for note in found.notes)
    assert json.loads(json.dumps(found.to_dict(), allow_nan=False))["ensemble"][0]["members"] == 3
    text = str(found)
    if objective == "fuel":
        assert (
            "Members   mean of 2 of 3 that keep the limits, with 10 and 90 %: time 5.15 h" in text
        )
        assert "fuel 644 kg (558 to 730); the other lines are those of member 0" in text
    assert "; in member 2 waves of up to 3.0 m" in text
    assert "Limits    NOT KEPT in member 2 (1 of 3): wave height above the limit" in text
    times = [route.time_h for route in found.routes]
    assert times == sorted(times) and len(times) >= (2 if objective == "front" else 1)


@pytest.mark.slow
def test_with_a_route_open_in_all_members_the_risk_is_of_all():
    found = planned(Sea.ensemble(member(1.0, 1.0), member(-1.0, 1.0)), "front")
    row = found.ensemble[0]
    assert row["infeasible"] == [] and row["time_risk_h"] == row["time_h"]["mean"]
    assert not any("No route of these plans" in note for note in found.notes)
    assert "mean of all 2" in str(found) and "NOT KEPT" not in str(found)
    assert "(2.35 to 2.69; worst tenth 2.73)" in members_text(row, "EUR", "cvar")
    assert "worst tenth" not in str(found)
