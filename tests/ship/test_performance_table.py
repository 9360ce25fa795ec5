"""Performance tables: look-up, sums of parts, errors, and agreement with the kernels."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.kernels import codes
from thalweg.kernels.leg.table_lookup import table_value
from thalweg.ship import PerformanceTable, TableError, TablePart
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.tabulate import AxisRange, tabulate_dense

NO_ERROR = TableError(0.0, 0.0, 0.0)


def _affine_table():
    """v = 5 + setting - 0.1 wind - 0.2 angle - 0.3 Hs + 0.01 depth, in three parts."""
    wind, angle = np.linspace(0, 40, 5), np.linspace(0, np.pi, 4)
    height, depth = np.linspace(0, 10, 6), np.linspace(0, 100, 3)
    settings = np.array([5.0, 6.0])
    blown = -0.1 * wind[:, None] - 0.2 * angle[None, :]
    rough = -0.3 * height[:, None] + 0.01 * depth[None, :]
    parts = (
        TablePart((), (), settings),
        TablePart((0, 1), (wind, angle), np.repeat(blown[..., None], 2, axis=-1)),
        TablePart((2, 5), (height, depth), np.repeat(rough[..., None], 2, axis=-1)),
    )
    return PerformanceTable(parts, settings, "affine", NO_ERROR)


def _draws(count=200):
    draw = np.random.default_rng(4)
    return {
        "wind_speed": draw.uniform(0, 40, count),
        "wind_angle": draw.uniform(0, np.pi, count),
        "wave_height": draw.uniform(0, 10, count),
        "depth": draw.uniform(0, 100, count),
    }


def test_lookup_of_an_affine_ship_is_exact():
    where = _draws()
    found = _affine_table().lookup(where, 1)
    expected = 6.0 - 0.1 * where["wind_speed"] - 0.2 * where["wind_angle"]
    expected += -0.3 * where["wave_height"] + 0.01 * where["depth"]
    assert np.allclose(found, expected, atol=2e-6)


def test_kernels_read_the_same_numbers():
    table, where = _affine_table(), _draws(50)
    arrays = table.kernel_arrays()
    for i in range(50):
        at = (
            *(where[n][i] for n in ("wind_speed", "wind_angle", "wave_height")),
            *(np.nan, np.nan),
            where["depth"][i],
        )
        value, ok = table_value(arrays, at, 1)
        assert ok
        expected = table.lookup({name: x[i] for name, x in where.items()}, 1)
        assert value == pytest.approx(float(expected), abs=1e-6)


@pytest.mark.parametrize("outside", [{"wind_speed": 40.1}, {"wave_height": -0.1}])
def test_outside_an_axis_is_unknown_not_extrapolated(outside):
    where = {"wind_speed": 1.0, "wind_angle": 1.0, "wave_height": 1.0, "depth": 10.0, **outside}
    assert np.isnan(_affine_table().lookup(where))


def test_the_ends_of_an_axis_are_inside():
    where = {"wind_speed": 40.0, "wind_angle": np.pi, "wave_height": 0.0, "depth": 0.0}
    assert float(_affine_table().lookup(where)) == pytest.approx(5.0 - 4.0 - 0.2 * np.pi, abs=1e-6)


def test_deep_water_is_as_the_deepest_grid_point():
    where = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "depth": [100.0, 5000.0]}
    found = _affine_table().lookup(where)
    assert found[0] == found[1] == pytest.approx(6.0)


def test_an_unknown_condition_gives_an_unknown_speed():
    where = {"wind_speed": np.nan, "wind_angle": 0.0, "wave_height": 0.0, "depth": 10.0}
    assert np.isnan(_affine_table().lookup(where))


def test_an_unknown_corner_of_no_weight_is_not_read():
    part = TablePart((0,), (np.array([0.0, 1.0, 2.0]),), np.array([[4.0], [3.0], [np.nan]]))
    assert part.lookup({"wind_speed": [0.5, 1.0]}).tolist() == [3.5, 3.0]
    assert np.isnan(part.lookup({"wind_speed": 1.5}))


@pytest.mark.parametrize(
    "grid", [[0.0, 1.0, 3.0], [1.0, 0.0, -1.0], [0.0, 0.0, 0.0], [0.0, np.nan, 1.0]]
)
def test_uneven_or_falling_grids_are_refused(grid):
    with pytest.raises(InputError, match="grid for wind_speed"):
        TablePart((0,), (np.array(grid),), np.zeros((3, 1)))


def test_values_must_fit_the_grids():
    with pytest.raises(InputError, match="does not fit"):
        TablePart((0,), (np.arange(3.0),), np.zeros((4, 1)))


def test_an_axis_is_given_once():
    with pytest.raises(InputError, match="once"):
        TablePart((0, 0), (np.arange(2.0), np.arange(2.0)), np.zeros((2, 2, 1)))


def test_settings_must_agree():
    with pytest.raises(InputError, match="settings"):
        PerformanceTable((TablePart((), (), np.ones(2)),), np.ones(3), "x", NO_ERROR)


def test_the_largest_value_bounds_the_sum():
    assert _affine_table().largest(0) == pytest.approx(6.0)


def test_refinement_meets_the_tolerance_and_reports_the_error():
    def bend(where):
        return (10.0 - 0.02 * where["wave_height"] ** 2)[..., None]

    axes = [AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 20.0, 3)]
    part, error = tabulate_dense(bend, axes, tolerance=1e-3)
    assert error.p99 <= 1e-3
    assert error.samples == 4000
    # a parabola's error between nodes h apart is at most c h^2 / 4
    step = part.grids[0][1]
    assert error.max <= 0.02 * step**2 / 4 / 2.0 + 1e-6


def test_refinement_chooses_the_axis_that_bends():
    def bend(where):
        return (10.0 + 0.1 * where["wave_height"] + np.sin(2 * where["wave_angle"]))[..., None]

    axes = [
        AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 20.0, 5),
        AxisRange(codes.AXIS_WAVE_ANGLE, 0.0, np.pi, 5),
    ]
    part, _ = tabulate_dense(bend, axes, tolerance=1e-3)
    assert part.values.shape[0] == 5
    assert part.values.shape[1] > 20


def test_refinement_stops_at_the_memory_allowed_and_reports_the_error():
    def step(where):
        return np.where(where["wave_height"] < 7.3, 9.0, 2.0)[..., None]

    axes = [AxisRange(codes.AXIS_WAVE_HEIGHT, 0.0, 20.0, 5)]
    part, error = tabulate_dense(step, axes, tolerance=1e-9, largest=1000)
    assert part.values.nbytes <= 1000
    assert error.max > 0.1


@pytest.mark.parametrize("count", [3, 4, 5, 6])
def test_kernels_read_parts_of_many_axes_as_numpy_does(count):
    draw = np.random.default_rng(count)
    grids = tuple(np.linspace(0.0, 1.0 + k, 3) for k in range(count))
    values = draw.normal(size=(*(3,) * count, 2))
    part = TablePart(tuple(range(count)), grids, values)
    table = PerformanceTable((part,), np.array([1.0, 2.0]), "many", NO_ERROR)
    names = ("wind_speed", "wind_angle", "wave_height", "wave_angle", "wave_period", "depth")
    for _ in range(20):
        at = [draw.uniform(0.0, 1.0 + k) for k in range(6)]
        value, ok = table_value(table.kernel_arrays(), tuple(at), 1)
        assert ok
        assert value == pytest.approx(float(table.lookup(dict(zip(names, at)), 1)), abs=1e-6)


def _crossing():
    """Wind requires 2 x (1 + v), waves 3 Hs^2; three settings have a reserve (4, 8, 12) - 4 v."""
    wind, angle, speeds = np.linspace(0, 10, 3), np.linspace(0, np.pi, 3), np.linspace(0, 4, 5)
    blown = 2.0 * wind[:, None] * (1.0 + speeds)
    rough = np.full((3, 5), 3.0)
    parts = (
        TablePart((0,), (wind,), blown),
        TablePart((3,), (angle,), rough, 2.0),
    )
    fine = np.linspace(0.0, 4.0, 33)
    spare = np.array([4.0, 8.0, 12.0])[:, None] - 4.0 * fine
    calm = np.array([1.0, 2.0, 3.0])
    finish = OutputCurve(
        "crossing", np.zeros(3), np.full(3, 0.125), spare, np.full(3, 3.5), calm.astype(int)
    )
    return PerformanceTable(parts, calm, "crossing", NO_ERROR, finish)


@given(st.floats(0, 10), st.floats(0, np.pi), st.floats(0, 2), st.integers(0, 2))
def test_a_crossing_is_where_the_sum_meets_the_curve(wind, angle, height, setting):
    """2 w (1 + v) + 3 Hs^2 = p - 4 v, so v = (p - 2 w - 3 Hs^2) / (4 + 2 w), not below 0."""
    table = _crossing()
    power = 4.0 * (setting + 1)
    expected = max((power - 2 * wind - 3 * height**2) / (4 + 2 * wind), 0.0)
    where = {"wind_speed": wind, "wave_angle": angle, "wave_height": height}
    assert float(table.lookup(where, setting)) == pytest.approx(expected, abs=1e-5)
    at = (wind, 0.0, height, angle, 0.0, 0.0)
    value, ok = table_value(table.kernel_arrays(), at, setting)
    assert ok and value == pytest.approx(expected, abs=1e-5)
    assert value <= table.largest(setting) + 1e-9


def test_a_crossing_ends_at_the_top_speed_and_refuses_outside():
    table = _crossing()
    push = replace(table.parts[0], values=-10.0 * np.ones((3, 5)))
    table = replace(table, parts=(push, table.parts[1]))
    where = {"wind_speed": 1.0, "wave_angle": 0.0, "wave_height": 0.0}
    assert float(table.lookup(where, 2)) == 3.5 == table.largest(2)
    assert table_value(table.kernel_arrays(), (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 2) == (3.5, True)
    for bad in ({"wave_height": 2.1}, {"wind_speed": 11.0}, {"wave_angle": np.nan}):
        c = {**where, **bad}
        assert np.isnan(table.lookup(c, 2))
        at = (c["wind_speed"], 0.0, c["wave_height"], c["wave_angle"], 0.0, 0.0)
        assert not table_value(table.kernel_arrays(), at, 2)[1]


def test_a_curve_follows_the_sum():
    grid = np.linspace(0.0, 10.0, 11)
    part = TablePart((0,), (grid,), np.repeat(grid[:, None], 2, axis=1))
    points = np.array([[0.0, 1.0, 4.0, 9.0], [5.0, 5.0, 6.0, 6.0]])
    nothing = np.zeros(2)
    finish = OutputCurve(
        "curve", np.array([1.0, 0.0]), np.ones(2), points, nothing, nothing.astype(int)
    )
    table = PerformanceTable((part,), np.array([5.0, 6.0]), "curve", NO_ERROR, finish)
    winds = [0.0, 1.0, 2.5, 4.0, 10.0]
    expected = ([0.0, 0.0, 2.5, 9.0, 9.0], [5.0, 5.0, 6.0, 6.0, 6.0])
    for setting in (0, 1):
        found = table.lookup({"wind_speed": winds}, setting)
        assert found.tolist() == pytest.approx(expected[setting])
        for wind, value in zip(winds, expected[setting]):
            at = (wind, 0.0, 0.0, 0.0, 0.0, 0.0)
            assert table_value(table.kernel_arrays(), at, setting)[0] == pytest.approx(value)
    assert (table.largest(0), table.largest(1)) == (9.0, 6.0)


def test_a_crossing_takes_no_more_than_kernels_can_follow():
    table = _crossing()
    with pytest.raises(InputError, match="too many parts"):
        replace(table, parts=(*table.parts, *table.parts))
