"""Ctrl-C while a front is planned: the best front so far is returned and marked."""

import json
import signal

import pytest

from tests.planning.test_trade_off_planner import CHART, GOAL, START, cubic_ship
from thalweg import Sea, Voyage, plan
from thalweg.cli.main import main

VOYAGE = {"start": START, "goal": GOAL, "depart": "2026-01-01T00:00Z", "objective": "front"}


def at(stage, times=1):
    """Return a progress that presses Ctrl-C when a stage begins."""
    left = [times]

    def progress(text):
        while text.startswith(stage) and left[0] > 0:
            left[0] -= 1
            signal.raise_signal(signal.SIGINT)

    return progress


def planned(voyage, **more):
    given = {"ship": cubic_ship(), "sea": Sea.calm(), "chart": CHART, "resolution": 20_000.0}
    return plan(voyage, **{**given, **more})


def stopped(stage, times=1, resolution=20_000.0, **more):
    voyage = Voyage(**{**VOYAGE, **more})
    return planned(voyage, progress=at(stage, times), resolution=resolution)


@pytest.mark.parametrize("stage", ["building", "freezing", "searching: ", "refining the route"])
def test_before_any_route_is_found_nothing_is_returned(stage):
    with pytest.raises(KeyboardInterrupt):
        stopped(stage)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_before_the_front_is_found_the_fastest_route_is_returned():
    found = stopped("searching the front")
    assert found.cancelled and found.front.stages == ("fastest",)
    assert found.best.feasible
    assert found.best.time_h == pytest.approx(120.0 / 12.0, rel=0.01)
    assert "the plan holds the fastest route" in found.notes[0]
    told = json.loads(found.to_json())
    assert told["cancelled"] is True
    assert told["lower_bound"] is None and told["lower_bound_kind"].startswith("no bound")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.slow
def test_before_refinement_the_exact_front_is_returned_and_evaluated():
    found = stopped("finding alternative routes", resolution=None)  # too few nodes otherwise
    assert found.cancelled and set(found.front.stages) <= {"exact", "fastest", "alternative path"}
    assert 10 < len(found.routes) <= 22
    assert all(route.feasible for route in found.routes)
    whole = planned(Voyage(**VOYAGE, method="exact"))
    assert found.routes[0].time_h == pytest.approx(whole.routes[0].time_h, rel=1e-3)
    assert found.routes[-1].fuel_t == pytest.approx(whole.routes[-1].fuel_t, rel=1e-3)
    assert found.front.comparison is None


def test_in_refinement_the_best_so_far_is_returned():
    found = stopped("refining the front")
    assert found.cancelled and len(found.routes) > 10
    assert found.notes[0].startswith("Stopped before ")


def test_a_plan_for_least_fuel_is_returned_as_well():
    found = stopped("refining the front", objective="fuel")
    assert found.cancelled and found.best.fuel_t == min(route.fuel_t for route in found.routes)


def test_pressed_again_it_interrupts():
    with pytest.raises(KeyboardInterrupt):
        stopped("searching the front", times=2)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.slow
def test_a_complete_plan_is_not_marked():
    found = stopped("no such stage", method="exact")
    assert not found.cancelled and "cancelled" not in json.loads(found.to_json())


def test_the_command_line_marks_a_stopped_plan_and_reports_a_missing_one(
    tmp_path, monkeypatch, capsys
):
    ship = tmp_path / "ship.yaml"
    ship.write_text(json.dumps(dict(cubic_ship().data)))
    command = [
        "plan", "0.0N 0.0E", "0.0N 2.0E", "--ship", str(ship), "--calm", "--coast", "none",
        "--depart", "2026-01-01T00:00Z", "--objective", "front", "--json", "--resolution", "10",
    ]  # fmt: skip
    for stage, code in (("searching the front", 0), ("building", 130)):
        press = at(stage)
        monkeypatch.setattr(
            "thalweg.cli.progress.ProgressMessages.__call__", lambda _, text, go=press: go(text)
        )
        assert main(command) == code
        told = capsys.readouterr()
        if code == 0:
            assert json.loads(told.out)["cancelled"] is True
        else:
            assert "there is no result" in told.err and not told.out
