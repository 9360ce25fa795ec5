"""Sums of the first rows, with zero before them."""

import numpy as np
import pytest

from thalweg.core.arrays.cumulative_sums import cumulative_sums


@pytest.mark.parametrize(
    ("values", "sums", "kind"),
    [
        ([3, 0, 2], [0, 3, 3, 5], np.int64),
        (np.array([1, 2], np.int32), [0, 1, 3], np.int64),
        (np.array([250, 250], np.uint8), [0, 250, 500], np.int64),
        (np.array([True, False, True]), [0, 1, 1, 2], np.int64),
        (np.array([0.5, 0.25]), [0.0, 0.5, 0.75], np.float64),
        (np.array([0.5], np.float32), [0.0, 0.5], np.float64),
        (np.zeros(0, np.int64), [0], np.int64),
        (np.zeros(0), [0.0], np.float64),
    ],
)
def test_cumulative_sums_begin_with_zero(values, sums, kind):
    found = cumulative_sums(values)
    assert found.tolist() == sums
    assert found.dtype == kind


def test_sums_after_an_unknown_value_are_unknown():
    np.testing.assert_array_equal(
        cumulative_sums(np.array([1.0, np.nan, 1.0])), [0.0, 1.0, np.nan, np.nan]
    )
