"""Speeds between the settings of a ship: in plans on request, else a note says what they save."""

import pytest

from thalweg import Chart, InputError, Sea, Ship, Voyage, plan
from thalweg.core.units import KNOT
from thalweg.planning.request.ordered_speed import with_speeds_between

CHART = Chart.open_water(-1.0, 1.0, -0.5, 5.5)
ENDS = {"start": (0.0, 0.0), "goal": (0.0, 5.0), "depart": "2026-12-01", "offing_nm": 0.0}
BETWEEN = "The plan chooses among 2 speeds (10.0, 14.0 kn), and the bound is for these"


@pytest.fixture(scope="module")
def ship(tmp_path_factory):
    """A ship whose fuel rises with the cube of her speed, at two settings far apart."""
    path = tmp_path_factory.mktemp("ship") / "two.yaml"
    path.write_text(
        "name: cargo ship\n"
        "hull: {length_between_perpendiculars_m: 140, breadth_m: 22, draught_m: 8,"
        " block_coefficient: 0.75}\n"
        "speeds_kn: [10, 14]\n"
        "engine: {reference_speed_kn: 14, reference_power_kw: 5000}\n"
        "models: {calm_water: cubic}\n"
        "fuel: {type: vlsfo, price_per_t: 520, reference_t_per_day: 24}\n"
        "costs: {hire_per_day: 15000}\n"
    )
    return Ship.load(path)


def planned(ship, **conditions):
    return plan(Voyage(**ENDS, **conditions), ship=ship, sea=Sea.calm(), chart=CHART)


def test_a_step_makes_speeds_that_are_no_farther_apart(ship):
    dense = with_speeds_between(ship, 1.5)
    assert [speed / KNOT for speed in dense.speeds] == pytest.approx([10, 34 / 3, 38 / 3, 14])
    assert with_speeds_between(ship, 4.0) is ship
    with pytest.raises(InputError, match=r"step of 0\.1 kn makes 41 speeds"):
        with_speeds_between(ship, 0.1)


@pytest.mark.slow
def test_the_cheapest_speed_lies_between_the_settings(ship):
    """At 12 kn the voyage costs 1.8 % less than at the better one of the settings."""
    settings = planned(ship, objective="cost")
    held = planned(ship, objective="cost", speed_kn=12.0).best
    assert held.cost < 0.99 * settings.objective_value
    found = planned(ship, objective="cost", speed_step_kn=0.5)
    assert found.objective_value <= 1.0005 * held.cost
    assert found.proof.certain <= held.cost
    assert any(note.startswith(BETWEEN) for note in settings.notes)
    assert "take up to 2.8% less cost" in " ".join(settings.notes)
    assert not any("chooses among" in note for note in found.notes)
    assert str(settings).count("at the 2 speeds of the plan") == 1
    assert settings.proof.kind.endswith("for routes at the 2 speeds of the plan")


@pytest.mark.slow
def test_the_least_fuel_by_an_arrival_is_at_the_speed_that_takes_all_of_the_time(ship):
    hours = 300.0 / 12.0 + 0.1
    by = f"2026-12-02T01:{round(60 * (hours - 25)) + 1:02d}Z"
    held = planned(ship, objective="fuel", speed_kn=12.0).best
    settings = planned(ship, objective="fuel", arrive_by=by)
    found = planned(ship, objective="fuel", arrive_by=by, speed_step_kn=0.5)
    assert held.fuel_t < 0.94 * settings.best.fuel_t
    assert found.best.fuel_t <= 1.01 * held.fuel_t


def test_a_step_beside_an_ordered_speed_is_refused(ship):
    with pytest.raises(InputError, match="One speed is ordered"):
        planned(ship, objective="fuel", speed_kn=12.0, speed_step_kn=0.5)


def test_a_ship_with_a_table_alone_has_no_speed_between():
    simple = Ship.simple(speed_kn=12.0, draught_m=5.0)
    assert with_speeds_between(simple, 0.5) is simple
