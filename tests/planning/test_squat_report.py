"""What evaluations and plans state about squat, which the required clearance does not count."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.planning.report.note_order import danger_first
from thalweg.planning.report.provenance import given_route_warnings
from thalweg.planning.report.squat_report import with_squat_violation
from thalweg.sea import standard_names as nm
from thalweg.ship.performance_sheet import performance_sheet

TANKER = {
    "name": "tanker",
    "hull": {
        "type": "tanker",
        "length_between_perpendiculars_m": 174,
        "breadth_m": 32.2,
        "draught_m": 11.8,
        "block_coefficient": 0.80,
    },
    "speeds_kn": [12],
    "engine": {"reference_power_kw": 8200, "sfoc_g_per_kwh": 170},
    "models": {"calm_water": "cubic"},
    "limits": {"min_under_keel_clearance_m": 1.2},
}
LINE = [(53.55, -3.85), (53.55, -3.15)]
CHART = Chart.open_water(53.4, 53.7, -4.0, -3.0)
SEA = Sea.from_functions(
    {
        nm.BED_DEPTH: lambda time, lat, lon: (
            np.where((lon > -3.5) & (lon < -3.4), 13.0, 40.0) + 0.0 * lat
        )
    }
)


def notes_of(ship, speed_kn=12.0, min_ukc=1.2):
    route = evaluate(
        LINE, ship=ship, sea=SEA, chart=CHART, depart="2026-03-10T03:00Z", speed_kn=speed_kn,
        min_ukc=min_ukc,
    )  # fmt: skip
    notes = given_route_warnings(route, chart=CHART, sea=SEA, ship=ship, min_ukc=min_ukc)
    return [note for note in notes if "squat" in note], route


def test_a_bar_crossed_fast_has_a_note_with_the_clearance_of_the_ship_sheet():
    ship = Ship.from_dict(TANKER)
    (note,), route = notes_of(ship)
    assert route.feasible and route.min_ukc_m == pytest.approx(1.2)
    assert note.startswith(
        "The clearance is that at rest: with a squat of about 1.1 m at 12.0 kn through the water, "
        "0.1 m are left under the keel at 53 33."
    )
    assert "less than the 1.2 m required. Go slower there" in note
    sheet = performance_sheet(ship, {"depth": 13.0}, speeds_kn=[12.0])
    assert sheet["conditions"][0]["squat"]["under_keel_clearance_m"] == pytest.approx(
        0.11, abs=0.01
    )
    assert danger_first(["Passes through Dover.", note])[0] == note


def test_less_clearance_than_the_ground_is_stated():
    (note,), _ = notes_of(Ship.from_dict(TANKER | {"speeds_kn": [14]}), 14.0, 0.0)
    assert "the ship is 0.3 m too deep" in note and "required" not in note


@pytest.mark.parametrize(
    ("changes", "min_ukc"),
    [
        ({}, 0.1),
        ({"models": {"calm_water": "cubic", "squat": "barrass_2004"}}, 1.2),
        ({"hull": {"draught_m": 11.8}}, 1.2),
    ],
)
def test_ships_with_room_with_squat_of_their_own_or_unknown_hulls_have_no_note(changes, min_ukc):
    speed = 6.0 if "models" in changes else 12.0
    found, _ = notes_of(Ship.from_dict(TANKER | changes | {"speeds_kn": [speed]}), speed, min_ukc)
    assert found == []


def test_plans_state_it():
    voyage = Voyage(start=LINE[0], goal=LINE[1], depart="2026-03-10T03:00Z")
    found = plan(voyage, ship=Ship.from_dict(TANKER), sea=SEA, chart=CHART)
    assert danger_first(found.notes)[0].startswith(
        "The clearance is that at rest: with a squat of about 1.1"
    )


def test_a_route_on_which_squat_puts_the_ship_aground_is_no_success():
    """At 12 kn she squats about 1.1 m over a bar with 0.7 m under her keel at rest."""
    ship = Ship.from_dict(TANKER | {"hull": TANKER["hull"] | {"draught_m": 12.3}})
    _notes, route = notes_of(ship, min_ukc=0.5)
    aground = with_squat_violation(route, ship)
    assert route.feasible and not aground.feasible
    (violation,) = aground.violations
    assert violation.reason == "under-keel clearance: with squat" and violation.value < -0.05
    _notes, slow = notes_of(ship, speed_kn=6.0, min_ukc=0.5)
    assert with_squat_violation(slow, ship) is slow
    shoal = Sea.from_functions({nm.BED_DEPTH: lambda time, lat, lon: 2.0 + 0.0 * lat})
    ashore = evaluate(
        LINE, ship=ship, sea=shoal, chart=CHART, depart="2026-03-10T03:00Z", strict=False
    )
    assert not ashore.feasible and with_squat_violation(ashore, ship) is ashore  # stated already


def test_a_job_of_the_service_on_which_she_is_aground_is_not_feasible():
    from thalweg.service.jobs.job_work import job_summary

    ship = Ship.from_dict(TANKER | {"hull": TANKER["hull"] | {"draught_m": 12.3}})
    voyage = Voyage(start=LINE[0], goal=LINE[1], depart="2026-03-10T03:00Z", min_ukc_m=0.5)
    found = plan(voyage, ship=ship, sea=SEA, chart=CHART)
    assert not found.best.feasible
    assert job_summary(found, 1.0)["feasible"] is False
    (row,) = found.to_dict()["routes"]
    assert row["feasible"] is False and "with squat" in row["violations"][0]["reason"]
    assert "NOT KEPT: under-keel clearance: with squat" in str(found)
