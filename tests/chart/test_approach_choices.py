"""The ways between a berth and the sea: branches of approaches, and canals that meet them."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.approach_branches import approach_branches
from thalweg.chart.approach_choices import approach_choices
from thalweg.chart.approaches import LONGEST_JOINT, PORT_APPROACHES, dense_line
from thalweg.chart.canals import CANALS, KIEL
from thalweg.chart.passages import find_passages
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE

BRANCHES = approach_branches()


@functools.cache
def chart():
    return Chart.gshhg("i")


@functools.cache
def choices(name):
    return approach_choices(PORT_APPROACHES.of(PORTS.lookup(name)), CANALS)


def way(name, by):
    return next(way for way in choices(name) if way.way == by)


def test_the_approach_of_the_table_comes_first():
    for name in ("Rotterdam", "Bergen", "Hamburg"):
        main = choices(name)[0]
        assert main is PORT_APPROACHES.of(PORTS.lookup(name))
        assert (main.way, main.canal) == ("", "")
        assert main.label == main.port.label
    assert len(choices("Santos")) == 1


def test_branches_have_names_of_their_own_and_end_in_navigable_water():
    assert len({branch.name for branch in BRANCHES}) == len(BRANCHES)
    lat, lon = np.array([branch.line[-1] for branch in BRANCHES]).T
    assert chart().is_navigable(lat, lon).all()
    for branch in BRANCHES:
        assert branch.source
        assert branch.max_draught > 0.0
        if len(branch.line) > 1:
            assert dense_line(branch.line)[-1, 2] > 0.5 * NAUTICAL_MILE


@pytest.mark.slow
def test_every_branch_leaves_the_approach_of_a_port():
    begins = np.array([branch.line[0] for branch in BRANCHES])
    lines = [approach.line for approach in PORT_APPROACHES.all]
    low, high = (
        np.array([end(np.array(line), axis=0) for line in lines]) for end in (np.min, np.max)
    )
    passes = (begins > low[:, None] - 0.02) & (begins < high[:, None] + 0.02)
    near = np.flatnonzero(passes.all(axis=2).any(axis=1))
    ways = {way.way for k in near for way in approach_choices(PORT_APPROACHES.all[k])}
    assert {f"by {branch.name}" for branch in BRANCHES} <= ways


def test_the_elbe_is_left_at_the_canal():
    found = way("Hamburg", "to the Kiel Canal")
    main = choices("Hamburg")[0]
    assert found.canal == "kiel"
    assert found.label == "Hamburg, DE to the Kiel Canal"
    assert distance(*found.sea_end, *KIEL.ends[0]) < LONGEST_JOINT
    assert found.length / NAUTICAL_MILE == pytest.approx(38.0, abs=2.0)
    assert found.line[:-1] == main.line[: len(found.line) - 1]
    assert all(other.way != "to the Kiel Canal" for other in choices("Bremerhaven"))
    without = approach_choices(main, [canal for canal in CANALS if canal is not KIEL])
    assert all(not other.canal for other in without)


def test_bergen_has_a_way_to_the_north():
    north = way("Bergen", "by Fedjeosen")
    main = choices("Bergen")[0]
    assert north.berth == main.berth
    assert north.sea_end[0] > 60.7 > 60.2 > main.sea_end[0]
    assert chart().coastline.shore_distance(*north.sea_end) > 1.9 * NAUTICAL_MILE


def test_a_way_that_ends_with_the_approach_itself_is_none_of_its_own():
    ways = [other.way for other in choices("Baltimore")]
    assert ways == ["", "by the Chesapeake and Delaware Canal to the Delaware"]
    assert way("Baltimore", ways[1]).way_draught == 10.0


def test_legs_along_branches_are_recognised():
    for found in (way("Bergen", "by Fedjeosen"), way("London", "by Black Deep")):
        lat, lon = np.array(found.line).T
        assert PORT_APPROACHES.legs(lat, lon).all()


@pytest.mark.parametrize(
    ("name", "by", "position", "miles"),
    [
        ("Surabaya", "by the Eastern Channel of Surabaya", (-7.190, 112.802), 5.8),
        ("Fukuyama", "by Bisan Seto from Fukuyama", (34.310, 133.643), 21.6),
        ("Matsuyama", "by Aki Nada from Matsuyama", (33.903, 132.614), 15.5),
        ("Hiroshima", "by Aki Nada from Hiroshima Bay", (34.034, 132.560), 41.8),
    ],
)
def test_second_ways_pass_their_waters(name, by, position, miles):
    found = way(name, by)
    line = dense_line(found.line)
    assert distance(*position, line[:, 0], line[:, 1]).min() < 0.6 * NAUTICAL_MILE
    assert found.length / NAUTICAL_MILE == pytest.approx(miles, abs=1.5)


def test_no_way_leads_through_the_naruto_strait():
    naruto = 34.237, 134.652
    for name in ("Himeji", "Takamatsu", "Mizushima"):
        for found in choices(name):
            line = dense_line(found.line)
            assert distance(*naruto, line[:, 0], line[:, 1]).min() > 5.0 * NAUTICAL_MILE


def test_an_approach_far_from_all_branches_is_the_only_way():
    main = choices("Santos")[0]
    assert approach_choices(replace(main, way_draught=5.0)) == (replace(main, way_draught=5.0),)


def test_an_approach_is_left_where_a_passage_begins_that_it_does_not_follow():
    (leia,) = find_passages(["Trondheimsleia"])
    (elbe,) = find_passages(["Elbe (Brunsbuttel to sea)"])
    trondheim = PORT_APPROACHES.of(PORTS.lookup("Trondheim"))
    left = [w for w in approach_choices(trondheim, (), [leia]) if "Trondheimsleia" in w.way]
    assert [w.way for w in left] == ["by the entrance of Trondheimsleia"]
    assert distance(*left[0].sea_end, *leia.line[-1]) < LONGEST_JOINT
    hamburg = PORT_APPROACHES.of(PORTS.lookup("Hamburg"))
    assert not any("Elbe" in w.way for w in approach_choices(hamburg, (), [elbe]))
