"""Fronts of two objectives: the filter and the hull against brute force, even spacing."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.pareto_fronts import (
    ROUNDING_TOLERANCE,
    evenly_spaced_subset,
    falling_hull,
    higher_of_two_fronts,
    length_along_front,
    lower_hull,
    non_dominated_indices,
)

points = st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=30)


@given(points)
def test_the_filter_keeps_what_no_other_point_dominates(drawn):
    x, y = np.array(drawn, float).reshape(-1, 2).T
    kept = non_dominated_indices(x, y)
    expected = [
        i
        for i in range(len(x))
        if not any(
            (x[j] <= x[i] and y[j] <= y[i]) and ((x[j], y[j]) != (x[i], y[i]) or j < i)
            for j in range(len(x))
        )
    ]
    assert sorted(kept.tolist()) == expected
    assert (np.diff(x[kept]) > 0).all() and (np.diff(y[kept]) < 0).all()


def test_unknown_points_and_improvements_within_rounding_are_left_out():
    time, cost = [1.0, 2.0, 3.0, 0.5, 4.0], [5.0, 5.0 * (1.0 - 1e-12), 4.0, np.nan, -np.inf]
    assert non_dominated_indices(time, cost).tolist() == [0, 1, 2]
    assert non_dominated_indices(time, cost, tolerance=ROUNDING_TOLERANCE).tolist() == [0, 2]
    assert non_dominated_indices([], []).tolist() == []


@given(points.filter(len))
def test_no_point_is_below_the_lower_hull(drawn):
    x, y = np.array(drawn, float).T
    hull = lower_hull(x, y)
    assert x[hull[0]] == x.min() and x[hull[-1]] == x.max()
    assert (y >= np.interp(x, x[hull], y[hull]) - 1e-9).all()
    slopes = np.diff(y[hull]) / np.diff(x[hull])
    assert (np.diff(slopes) > 0.0).all()


@given(points)
def test_the_falling_hull_is_the_lower_hull_up_to_its_least_value(drawn):
    x, y = np.array(drawn, float).reshape(-1, 2).T
    hull, falling = lower_hull(x, y), falling_hull(x, y)
    assert hull[: len(falling)].tolist() == falling.tolist()
    assert (np.diff(y[falling]) < 0.0).all()
    if drawn:
        assert y[falling[-1]] == y.min()


def test_points_are_chosen_evenly_along_the_front_with_both_ends():
    time, cost = np.linspace(0.0, 10.0, 101)[::-1], np.linspace(0.0, 5.0, 101)
    chosen = evenly_spaced_subset(time, cost, 5)
    assert time[chosen] == pytest.approx([0.0, 2.5, 5.0, 7.5, 10.0])
    assert len(evenly_spaced_subset(time, cost, 500)) == 101
    assert length_along_front([0.0, 1.0, 2.0], [7.0, 7.0, 7.0]).tolist() == [0.0, 0.5, 1.0]


def test_the_higher_of_two_bounds_meets_both_and_where_they_cross():
    """10 - x from 1 on and 7 - x / 4 from 2 on cross at 4; the second is level from 8."""
    first, second = np.array([[1.0, 9.0], [9.0, 1.0]]), np.array([[2.0, 8.0], [6.5, 5.0]])
    found = higher_of_two_fronts(first, second)
    assert found[0] == pytest.approx([2.0, 4.0, 8.0, 9.0])
    assert found[1] == pytest.approx([8.0, 6.0, 5.0, 5.0])
    assert higher_of_two_fronts(second, first) == pytest.approx(found)


def test_a_bound_is_the_higher_where_there_is_no_other():
    bound, none = np.array([[1.0, 9.0], [9.0, 1.0]]), np.empty((2, 0))
    assert higher_of_two_fronts(bound, none) is bound
    assert higher_of_two_fronts(none, bound) is bound
