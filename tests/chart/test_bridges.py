"""Bridges over the approaches of ports."""

import pytest

from thalweg.chart.approach_branches import approach_branches
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.port_limits.bridges import bridges_over, every_bridge
from thalweg.chart.ports import PORTS


@pytest.mark.parametrize(
    ("port", "bridges"),
    [
        ("Baltimore, US", ["Chesapeake Bay Bridge"]),
        ("Tampa", ["Sunshine Skyway Bridge"]),
        (
            "Philadelphia",
            ["Commodore Barry Bridge", "Delaware Memorial Bridge", "Walt Whitman Bridge"],
        ),
        ("Rouen", ["Pont de Brotonne", "Pont de Tancarville", "Pont de Normandie"]),
        ("Montreal", ["Laviolette Bridge", "Quebec Bridge"]),
        ("Goole", ["Humber Bridge"]),
        ("Grangemouth", ["Forth Bridges"]),
        ("Le Havre", []),
        ("Rotterdam", []),
    ],
)
def test_bridges_over_an_approach_are_known(port, bridges):
    line = PORT_APPROACHES.of(PORTS.lookup(port)).line
    names = [one.name for one in bridges_over(line)]
    assert sorted(names) == sorted(bridges)
    assert [one.name for one in bridges_over(line[::-1])] == names[::-1]


@pytest.mark.slow
def test_every_bridge_of_the_table_is_over_an_approach():
    lines = [approach.line for approach in PORT_APPROACHES.all]
    lines += [branch.line for branch in approach_branches() if len(branch.line) > 1]
    over = {one.name for line in lines for one in bridges_over(line)}
    assert over == {one.name for one in every_bridge()}
    assert all(20.0 < one.clearance < 80.0 for one in every_bridge())
