"""The root finder: smooth functions, kinks, jumps, ends without a crossing, unknown values."""

import numpy as np
import pytest

from thalweg.ship.models.root_finding import bracketed_root


def _solve(function, low, high, tolerance=1e-4):
    asked = []

    def counted(x, index):
        asked.append(len(x))
        return function(x, index)

    count = np.full(3, 1.0)
    return bracketed_root(counted, low * count, high * count, tolerance=tolerance), len(asked)


def test_smooth_functions_are_met_far_closer_than_the_tolerance_in_few_steps():
    targets = np.array([2.0, 40.0, 900.0])
    found, asked = _solve(lambda x, k: np.cbrt(x**3.4) - np.cbrt(targets[k]), 0.0, 12.0)
    assert found == pytest.approx(targets ** (1 / 3.4), abs=2e-6)
    assert asked <= 9


def test_kinks_and_jumps_stay_inside_the_bracket():
    kinked, _ = _solve(lambda x, k: np.where(x < 3.0, x - 3.5, 4.0 * (x - 3.0) - 0.5), 0.0, 9.0)
    assert kinked == pytest.approx(3.125, abs=1e-4)
    jump, _ = _solve(lambda x, k: np.where(x < 5.0, -1.0, 2.0), 0.0, 9.0)
    assert jump == pytest.approx(5.0, abs=1e-3)


def test_ends_without_a_crossing_and_unknown_values():
    assert (_solve(lambda x, k: x + 1.0, 0.0, 9.0)[0] == 0.0).all()
    assert (_solve(lambda x, k: x - 20.0, 0.0, 9.0)[0] == 9.0).all()
    found, _ = _solve(lambda x, k: np.where(k == 1, np.nan, x - 2.0), 0.0, 9.0)
    assert np.isnan(found[1]) and found[[0, 2]] == pytest.approx(2.0)
