"""Lines across closed passages: from inside one land to inside the other, or none."""

import numpy as np
import pytest
import shapely
import shapely.affinity

from thalweg import Chart
from thalweg.chart.passages import Passage
from thalweg.search.certificate.lines_across_passages import PassageLines

NORTH, SOUTH = shapely.box(1.0, 0.05, 1.5, 3.0), shapely.box(1.0, -2.0, 1.5, -0.05)
INNER = [shape.buffer(-0.04, join_style="mitre") for shape in (NORTH, SOUTH)]
CORNERS = np.array([[0.09, 1.04], [0.09, 1.46], [-0.09, 1.04], [-0.09, 1.46]])  # of INNER


def lines(ends, turns=CORNERS):
    passage = Passage("gap", "trade", ((0.0, 0.9), (0.0, 1.6)), 5000.0, closing_line=ends)
    coastline = Chart.open_water().coastline
    return PassageLines(coastline, [passage], [NORTH, SOUTH]).into(INNER, turns)


def test_a_line_begins_and_ends_inside_the_inner_polygons():
    (line,) = lines(((-0.06, 1.2), (0.06, 1.2)))
    assert line.shape == (6, 2)
    assert shapely.contains_xy(INNER[1], line[0, 1], line[0, 0])
    assert shapely.contains_xy(INNER[0], line[-1, 1], line[-1, 0])
    assert line[2:4].tolist() == [[-0.06, 1.2], [0.06, 1.2]]
    for shape, part in ((SOUTH, line[:3]), (NORTH, line[3:])):  # nothing but land is added
        assert shape.covers(shapely.LineString(part[:, ::-1]))


def test_a_line_that_ends_in_water_is_no_obstacle():
    assert lines(((-0.06, 1.2), (0.04, 1.2))) == []


@pytest.mark.parametrize("away, count", [(0.001, 0), (0.01, 1)])
def test_a_line_beside_a_place_where_ways_turn_is_left_out(away, count):
    turns = np.concatenate([CORNERS, [[0.0, 1.2 + away]]])
    assert len(lines(((-0.06, 1.2), (0.06, 1.2)), turns)) == count


def test_lines_are_found_where_polygons_are_a_turn_of_the_globe_away():
    passage = Passage(
        "gap", "trade", ((0.0, 0.9), (0.0, 1.6)), 5000.0,
        closing_line=((-0.06, 1.2), (0.06, 1.2)),
    )  # fmt: skip
    moved, inner = (
        [shapely.affinity.translate(shape, xoff=360.0) for shape in some]
        for some in ([NORTH, SOUTH], INNER)
    )
    across = PassageLines(Chart.open_water().coastline, [passage], moved)
    (line,) = across.into(inner, np.add(CORNERS, [0.0, 360.0]))
    assert line[2:4, 1].tolist() == pytest.approx([361.2, 361.2])


@pytest.mark.parametrize("turn", [0.0, 360.0])
def test_a_way_crosses_the_lines_between_its_positions(turn):
    passage = Passage(
        "gap", "trade", ((0.0, 0.9), (0.0, 1.6)), 5000.0, closing_line=((-0.06, 1.2), (0.06, 1.2))
    )
    across = PassageLines(Chart.open_water().coastline, [passage], [NORTH, SOUTH])
    through = np.array([0.0, 0.02]), np.array([1.0, 1.4]) + turn
    beside = np.array([0.0, 0.02]), np.array([1.21, 1.4]) + turn
    (line,) = across.crossed(*through)
    assert line.tolist() == [[-0.06, 1.2], [0.06, 1.2]]
    assert across.crossed(*beside) == []
