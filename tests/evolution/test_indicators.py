"""Quality indicators of fronts: worked values, properties, and pymoo as an independent check."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from thalweg.core.errors import InputError
from thalweg.evolution.indicators import (
    c_metric,
    crowding_distance,
    generational_distance,
    hypervolume,
    non_dominated,
)

Z = [(1, 5), (2, 3), (4, 1)]
Y = [(1.5, 4), (3, 2), (5, 0.5)]
CORNER = (5, 5)
POINTS = arrays(
    float, st.tuples(st.integers(1, 30), st.just(2)), elements=st.integers(0, 12).map(float)
)


def test_worked_hypervolumes():
    assert hypervolume(Z, CORNER) == 8.0
    assert hypervolume(Y, CORNER) == 7.5
    assert hypervolume(Z + Y, CORNER) == 9.5
    assert hypervolume([*Z, *Y, (2.5, 2.5)], CORNER) == 9.75


def test_worked_coverage():
    assert c_metric(Z, Y) == c_metric(Y, Z) == 0.0
    assert c_metric([(1, 4), (3, 1)], Z) == pytest.approx(2.0 / 3.0)  # a share of the second front
    assert c_metric(Z, [(1, 5)]) == 1.0  # equal points are covered


def test_worked_crowding():
    crowding = crowding_distance([(1, 5), (2, 3), (4, 1), (5, 0.5)])
    assert crowding == pytest.approx([np.inf, 1.638889, 1.305556, np.inf], abs=5e-7)
    assert crowding_distance([(1, 1)]).tolist() == [np.inf]
    assert crowding_distance([]).tolist() == []


def test_worked_generational_distance():
    assert generational_distance([(0, 4), (4, 3)], [(0, 1), (4, 0)], scale=(1, 1)) == 3.0
    assert generational_distance([(1, 1)], [(1, 0), (3, 2)]) == 0.5  # a half of the range of 2
    assert generational_distance(Z, Z) == 0.0


def test_non_dominated_keeps_the_first_of_equals_and_drops_unknown():
    points = [(2, 3), (1, 5), (2, 3), (2, 4), (np.nan, 0), (4, 1), (np.inf, 0)]
    assert non_dominated(points).tolist() == [True, True, False, False, False, True, False]


def test_points_beyond_the_reference_do_not_add_to_the_hypervolume():
    assert hypervolume([*Z, (6, 0), (0, 5)], CORNER) == 8.0
    assert hypervolume([(6, 6)], CORNER) == 0.0
    assert hypervolume([], CORNER) == 0.0


@given(POINTS)
def test_hypervolume_agrees_with_counting_cells(points):
    corner = np.array([13.0, 13.0])
    cells = np.arange(13) + 0.5
    covered = (points[:, None, None, 0] < cells[:, None]) & (points[:, None, None, 1] < cells)
    assert hypervolume(points, corner) == covered.any(axis=0).sum()


@given(POINTS, POINTS)
def test_indicators_keep_their_order(first, second):
    corner = (13.0, 13.0)
    both = np.concatenate([first, second])
    assert hypervolume(both, corner) >= max(hypervolume(first, corner), hypervolume(second, corner))
    assert c_metric(both, first) == 1.0
    front = first[non_dominated(first)]
    assert hypervolume(front, corner) == hypervolume(first, corner)
    assert c_metric(front, first) == 1.0
    assert generational_distance(first, both) == 0.0


def test_pymoo_agrees():
    pytest.importorskip("pymoo")
    from pymoo.indicators.hv import HV
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

    rng = np.random.default_rng(5)
    for _ in range(20):
        points = rng.random((80, 2))
        assert hypervolume(points, (1, 1)) == pytest.approx(HV(ref_point=np.ones(2))(points))
        front = NonDominatedSorting().do(points, only_non_dominated_front=True)
        assert sorted(front) == np.flatnonzero(non_dominated(points)).tolist()


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: hypervolume([(1, 2, 3)], CORNER),
        lambda: hypervolume(Z, (np.inf, 5)),
        lambda: c_metric(Z, []),
        lambda: generational_distance([], Z),
    ],
)
def test_invalid_values_are_refused(wrong):
    with pytest.raises(InputError) as caught:
        wrong()
    assert caught.value.possible
    assert caught.value.remedy
