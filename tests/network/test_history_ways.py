"""The choice of arcs of a history network, and lines of arcs that meet at junctions."""

import numpy as np
import pytest

from thalweg.core.geodesy import distance, line_length
from thalweg.network.history.arc_lines import ArcLines
from thalweg.network.history.arc_search import ArcGraph, doubt_factors
from thalweg.network.history.route_lines import attached_line, following_arcs, joined_line

NM = 1852.0
#: Two voyages that pass a junction at 2 E 6 nm to either side of it, on the equator.
TWO = ArcLines.of_lists([[(0.1, 0.0), (0.1, 2.0)], [(-0.1, 2.0), (-0.1, 4.0)]])


def test_lines_of_two_voyages_meet_half_way_without_a_corner():
    line = joined_line(TWO, np.array([0, 1]), np.array([True]), 30.0 * NM)
    assert line[0] == pytest.approx((0.1, 0.0)) and line[-1] == pytest.approx((-0.1, 4.0))
    assert (0.0, 2.0) in [(round(lat, 6), round(lon, 6)) for lat, lon in line]
    straight = float(distance(0.1, 0.0, -0.1, 4.0))
    assert straight < line_length(tuple(line)) < straight + 1.0 * NM
    as_they_are = joined_line(TWO, np.array([0, 1]), np.array([False]), 30.0 * NM)
    assert len(as_they_are) == 4
    assert line_length(tuple(as_they_are)) > straight + 11.0 * NM


def test_lines_that_meet_are_not_moved_across_the_date_line_either():
    lines = ArcLines.of_lists([[(10.0, 178.0), (10.0, 179.9)], [(10.0, 179.9), (10.0, -178.0)]])
    line = joined_line(lines, np.array([0, 1]), np.array([True]), 30.0 * NM)
    assert line == [(10.0, 178.0), (10.0, 179.9), (10.0, -178.0)]
    other = ArcLines.of_lists([[(10.0, 178.0), (10.0, 179.9)], [(10.0, -179.9), (10.0, -178.0)]])
    line = joined_line(other, np.array([0, 1]), np.array([True]), 30.0 * NM)
    whole = float(distance(10.0, 178.0, 10.0, -178.0))
    assert line_length(tuple(line)) == pytest.approx(whole, rel=1e-3)


def test_a_line_is_attached_to_the_middle_of_a_junction():
    line = np.array([0.1, 0.1, 0.1]), np.array([0.0, 1.0, 2.0])
    lat, lon = attached_line(line, ((0.1, 0.0), (0.0, 2.0)), np.array([0.0, 15.0 * NM]))
    assert (lat[0], lon[0], lat[-1], lon[-1]) == (0.1, 0.0, 0.0, 2.0)
    assert lon[1:-1] == pytest.approx([1.0, 1.75], abs=0.005)
    assert lat[1:-1] == pytest.approx([0.1, 0.1], abs=1e-4)


def test_arcs_follow_each_other_but_not_back():
    tail, head = np.array([0, 1, 1, 2]), np.array([1, 0, 2, 1])
    before, after = following_arcs(tail, head, np.array([False, False, False]))
    assert sorted(zip(before.tolist(), after.tolist())) == [(0, 2), (3, 1)]
    assert not len(following_arcs(tail, head, np.array([False, True, False]))[0])


@pytest.fixture
def beside():
    """Node 0 to 2 by arcs 0 and 1 over node 1, 16 nm; arc 2 directly, 9 nm, reversed."""
    x = np.array([0.0, 12.0, 16.0]) / 60.0
    lines = ArcLines.of_lists([
        [(0.0, x[0]), (0.0, x[1])], [(0.0, x[1]), (0.0, x[2])], [(0.0, x[0]), (0.0, x[2])]
    ])  # fmt: skip
    tail, head = np.array([0, 1, 0]), np.array([1, 2, 2])
    return ArcGraph.of_arcs(tail, head, lines, np.zeros(3, bool))


def test_sailed_arcs_are_preferred_to_others_unless_they_lead_far_round(beside):
    length = np.array([12.0, 4.0, 9.0]) * NM
    sailed = np.array([True, True, False])
    assert beside.path(0, 2, length) == [2]
    assert beside.path_by_sailed_arcs((0, 2), length, sailed, length, 20.0 * NM) == [0, 1]
    assert beside.path_by_sailed_arcs((0, 2), length, sailed, length, 0.0) == [2]  # 1.8 times
    closed = np.where(sailed, np.inf, length)
    assert beside.path_by_sailed_arcs((0, 2), closed, sailed, length, 20.0 * NM) == [2]
    assert beside.path(2, 0, length) == []


def test_gaps_between_lines_of_voyages_count():
    lines = ArcLines.of_lists([
        [(0.0, 0.0), (0.0, 1.0)], [(0.2, 1.0), (0.0, 2.0)], [(0.0, 1.0), (0.05, 1.5), (0.0, 2.0)]
    ])  # fmt: skip
    tail, head = np.array([0, 1, 1]), np.array([1, 2, 2])
    graph = ArcGraph.of_arcs(tail, head, lines, np.zeros(3, bool))
    assert lines.lengths[1] > lines.lengths[2]
    assert graph.path(0, 2, np.array([60.0, 60.0, 66.0]) * NM) == [0, 2]  # 12 nm beside arc 1


def test_arcs_of_few_voyages_and_strays_count_as_longer():
    tail, head = np.array([0, 1, 0, 0, 0]), np.array([1, 2, 2, 3, 3])
    count = np.array([200, 300, 15, 160, 16])
    length = np.array([12.0, 4.0, 9.0, 20.0, 19.0]) * NM
    following = following_arcs(tail, head, np.zeros(4, bool))
    found = doubt_factors((tail, head), count, length, following, few=count < 3, slack=20.0 * NM)
    assert found.tolist() == [1.0, 1.0, 2.0, 1.0, 1.25]
    short = doubt_factors((tail, head), count, length, following, few=count < 3, slack=1.0 * NM)
    assert short.tolist() == [1.0, 1.0, 1.0, 1.0, 1.25]  # the way over node 1 is 7 nm longer
    few = doubt_factors((tail, head), count, length, following, few=count < 20, slack=1.0 * NM)
    assert few.tolist() == [1.0, 1.0, 1.25, 1.0, 1.25]
