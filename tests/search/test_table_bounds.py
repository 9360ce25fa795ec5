"""Extremes of tables bound all their values."""

import numpy as np
import pytest

from thalweg import Ship
from thalweg.kernels.leg.table_lookup import table_value
from thalweg.ship.tables.table_bounds import table_bounds


@pytest.mark.parametrize("name", ["handysize-bulker", "s175", "vox-olympia"])
@pytest.mark.parametrize("what", ["tabulate", "tabulate_fuel"])
def test_no_value_lies_beyond_the_extremes(name, what):
    arrays = getattr(Ship.load(name), what)().kernel_arrays()
    low, high = table_bounds(arrays, np.fmin), table_bounds(arrays, np.fmax)
    assert len(low) == arrays.n_settings and np.all(low <= high)
    rng = np.random.default_rng(1)
    known = 0
    for _ in range(400):
        at = (
            rng.uniform(0, 25), rng.uniform(0, np.pi), rng.uniform(0, 5), rng.uniform(0, np.pi),
            rng.uniform(5, 14), rng.uniform(15, 200),
        )  # fmt: skip
        setting = int(rng.integers(arrays.n_settings))
        value, ok = table_value(arrays, at, setting)
        if ok:
            known += 1
            assert low[setting] - 1e-6 <= value <= high[setting] * (1 + 1e-6) + 1e-9
    assert known > 50
