"""Notes on ways that turn back where the approach of a port ends."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from thalweg import Sea, Ship, evaluate
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.cli.main import main
from thalweg.core.geodesy import densify
from thalweg.planning.report.approach_report import (
    approach_limit_notes,
    turn_back_notes,
    turn_back_notes_of_route,
)
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.seaways import world_chart
from thalweg.route.route_tables import LEG_KINDS

LAT = np.array([56.40, 56.28, 56.45, 56.60])  # out of Oban to the south-west, and back
LON = np.array([-5.50, -5.80, -5.60, -5.95])


def test_a_way_that_turns_back_is_stated_with_the_place():
    (note,) = turn_back_notes(LAT, LON, [1])
    assert note.startswith("Turns back by 1") and "56.2800N 5.8000W" in note
    assert count_of_dangers([note]) == 1  # no summary leaves it out
    # the first example of the README said that its way may be longer than need be
    assert "the sea end of the channel of a port is there" in note
    assert "plan from or to a position in that channel" in note


def test_turns_elsewhere_and_ways_onwards_have_no_note():
    assert turn_back_notes(LAT, LON, []) == []
    assert turn_back_notes(np.array([56.4, 56.3, 56.2]), np.array([-5.5, -5.7, -5.8]), [1]) == []


@pytest.mark.parametrize(("kinds", "found"), [(("approach", "sea", "sea"), 1), (("sea",) * 3, 0)])
def test_ends_of_approaches_are_found_on_a_route(kinds, found):
    ship = Ship.simple(speed_kn=10.0, draught_m=3.0)
    route = evaluate(list(zip(LAT, LON)), ship=ship, sea=Sea.calm(), depart="2026-01-01T00:00Z")
    kind = np.array([LEG_KINDS.index(name) for name in kinds])
    sailed = replace(route, legs=dict(route.legs) | {"leg_kind": kind})
    assert len(turn_back_notes_of_route(sailed)) == found


@pytest.mark.parametrize("closed", [False, True])
def test_the_approach_of_hamburg_is_too_shallow_for_a_tanker_of_20_8_m(closed):
    chart = world_chart()
    if closed:  # as in a plan of this ship
        chart = chart.without_passages("Elbe (Brunsbuttel to sea)")
    hamburg = next(one for one in PORT_APPROACHES.all if one.label == "Hamburg, DE")
    (note,) = approach_limit_notes(chart, hamburg, {"draught": 20.8})
    assert note == (
        "The approach is too small: that of Hamburg, DE leads through Elbe (Brunsbuttel to sea): "
        "the draught of 20.8 m is over the 13.5 m allowed (general knowledge, unchecked). Load "
        "less, or ask the port."
    )
    assert count_of_dangers([note]) == 1
    assert approach_limit_notes(chart, hamburg, {"draught": 12.0, "beam": 50.0}) == []


def test_a_ship_too_high_for_the_bridges_of_an_approach_is_stated():
    chart = world_chart()
    new_york = next(one for one in PORT_APPROACHES.all if one.label == "New York City, US")
    (note,) = approach_limit_notes(chart, new_york, {"draught": 9.0, "air_draught": 70.0})
    assert "Verrazano Narrows: the air draught of 70 m is over the 65 m allowed" in note
    assert note.endswith("(general knowledge, unchecked). Ask the port.")  # a light ship is higher
    local = next(one for one in PORT_APPROACHES.all if one.label == "Sortland, NO")
    assert approach_limit_notes(chart, local, {"length": 200.0, "air_draught": 20.0}) == []


@pytest.mark.slow
def test_the_first_example_of_the_readme_has_no_note_on_danger(capsys):
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    command = re.search(r"^thalweg (plan .*) --out out$", readme, re.MULTILINE)[1]
    assert main([*command.split(), "--json"]) == 0
    assert count_of_dangers(json.loads(capsys.readouterr().out)["notes"]) == 0


def test_bridges_over_an_approach_are_compared_with_the_air_draught():
    chart = world_chart()
    baltimore = next(one for one in PORT_APPROACHES.all if one.label == "Baltimore, US")
    (note,) = approach_limit_notes(chart, baltimore, {"draught": 9.0, "air_draught": 60.0})
    assert note.startswith(
        "The approach is too small: that of Baltimore, US leads under Chesapeake Bay Bridge: the "
        "air draught of 60 m is over its clearance of 56.7 m (general knowledge, unchecked)."
    )
    assert count_of_dangers([note]) == 1
    (note,) = approach_limit_notes(chart, baltimore, {"draught": 9.0, "air_draught": 56.7})
    assert note.startswith("Low bridge: the approach of Baltimore, US leads under Chesapeake Bay")
    assert "the air draught of 56.7 m leaves 0.0 m of its clearance of 56.7 m" in note
    assert count_of_dangers([note]) == 1
    assert approach_limit_notes(chart, baltimore, {"draught": 9.0, "air_draught": 54.6}) == []
    (note,) = approach_limit_notes(chart, baltimore, {"draught": 9.0})
    assert note.startswith(
        "Bridges over the approach of Baltimore, US: Chesapeake Bay Bridge (56.7"
    )
    new_york = next(one for one in PORT_APPROACHES.all if one.label == "New York City, US")
    (note,) = approach_limit_notes(chart, new_york, {"draught": 9.0})
    assert note.startswith("Bridges over the approach of New York City, US: Verrazano Narrows (65")


def test_an_approach_straight_over_land_is_a_danger():
    """The coastline has no river to Launceston; lines by hand follow rivers that it lacks."""
    chart = world_chart()
    launceston, antwerp = (
        next(one for one in PORT_APPROACHES.all if one.label == label)
        for label in ("Launceston, AU", "Antwerp, BE")
    )
    (note,) = approach_limit_notes(chart, launceston, {"draught": 3.0})
    assert note.startswith("The approach crosses land: that of Launceston, AU has a straight leg")
    assert "17 nm are land" in note and count_of_dangers([note]) == 1
    assert approach_limit_notes(chart, antwerp, {"draught": 3.0}) == []


def test_bermuda_is_left_by_the_narrows_and_its_reefs_are_kept_clear_of():
    """The line led due north from Hamilton, over the town, the reef and North Rock."""
    reefs = next(area for area in SHOAL_AREAS if area.name == "Bermuda reefs")
    assert reefs.contains(32.475, -64.767)  # North Rock
    for label in ("Hamilton, BM", "St George, BM"):
        line = next(one for one in PORT_APPROACHES.all if one.label == label).line
        assert line[-1] == (32.372, -64.56)
        lat, lon, _ = densify(*np.array(line).T, 100.0)
        assert not reefs.contains(lat, lon).any()
