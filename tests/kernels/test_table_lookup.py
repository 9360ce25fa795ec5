"""The table look-up against scipy, and its refusals."""

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from tests.search.small import make_table
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import axes_needed, table_value

GRIDS = {
    codes.AXIS_WIND_SPEED: np.linspace(0.0, 10.0, 5),
    codes.AXIS_WIND_ANGLE: np.linspace(0.0, np.pi, 7),
    codes.AXIS_WAVE_HEIGHT: np.linspace(0.5, 3.0, 4),
    codes.AXIS_WAVE_PERIOD: np.linspace(4.0, 12.0, 3),
}


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4])
def test_look_up_agrees_with_scipy_for_every_number_of_axes(count):
    rng = np.random.default_rng(count)
    axes = list(GRIDS)[:count]
    grids = [GRIDS[a] for a in axes]
    values = rng.uniform(2.0, 9.0, [len(g) for g in grids] + [3]).astype(np.float32)
    table = make_table((axes, grids, values))
    peer = RegularGridInterpolator(grids, values) if count else None
    for _ in range(50):
        where = np.zeros(codes.AXIS_COUNT)
        for axis, grid in zip(axes, grids):
            where[axis] = rng.uniform(grid[0], grid[-1])
        expected = peer(where[axes])[0] if count else values
        for setting in range(3):
            value, ok = table_value(table, tuple(where), setting)
            assert ok
            assert value == pytest.approx(float(expected[setting]), rel=2e-7)


def test_parts_add_up():
    wind, wave = GRIDS[codes.AXIS_WIND_SPEED], GRIDS[codes.AXIS_WAVE_HEIGHT]
    table = make_table(
        ((), (), np.array([8.0, 9.0])),
        ((codes.AXIS_WIND_SPEED,), (wind,), np.stack([-0.1 * wind, -0.2 * wind], -1)),
        ((codes.AXIS_WAVE_HEIGHT,), (wave,), np.stack([-0.5 * wave, -0.25 * wave], -1)),
    )
    where = (4.0, 0.0, 2.0, 0.0, 0.0, 0.0)
    assert table_value(table, where, 0)[0] == pytest.approx(8.0 - 0.4 - 1.0, abs=1e-6)
    assert table_value(table, where, 1)[0] == pytest.approx(9.0 - 0.8 - 0.5, abs=1e-6)
    assert axes_needed(table) == (1 << codes.AXIS_WIND_SPEED) | (1 << codes.AXIS_WAVE_HEIGHT)


@pytest.mark.parametrize(
    ("x", "ok"),
    [(0.0, True), (10.0, True), (10.000001, True), (10.1, False), (-0.1, False), (np.nan, False)],
)
def test_tables_do_not_extrapolate(x, ok):
    grid = GRIDS[codes.AXIS_WIND_SPEED]
    table = make_table(((codes.AXIS_WIND_SPEED,), (grid,), grid[:, None]))
    value, inside = table_value(table, (x, 0.0, 0.0, 0.0, 0.0, 0.0), 0)
    assert inside is ok
    if ok:
        assert value == pytest.approx(x, abs=1e-5)


def test_depth_beyond_the_deepest_grid_point_counts_as_that_point():
    grid = np.linspace(5.0, 25.0, 5)
    table = make_table(((codes.AXIS_DEPTH,), (grid,), grid[:, None]))
    for depth in (25.0, 4000.0, np.inf):
        assert table_value(table, (0.0, 0.0, 0.0, 0.0, 0.0, depth), 0) == (25.0, True)
    assert not table_value(table, (0.0, 0.0, 0.0, 0.0, 0.0, 4.0), 0)[1]
    assert not table_value(table, (0.0, 0.0, 0.0, 0.0, 0.0, np.nan), 0)[1]


def test_nan_in_the_table_refuses_only_where_it_has_weight():
    values = np.array([[1.0], [2.0], [np.nan]])
    table = make_table(((codes.AXIS_WAVE_HEIGHT,), (np.array([0.0, 1.0, 2.0]),), values))
    at = [table_value(table, (0.0, 0.0, h, 0.0, 0.0, 0.0), 0) for h in (0.5, 1.0, 1.5)]
    assert at[0] == (1.5, True)
    assert at[1] == (2.0, True)
    assert at[2][1] is False
