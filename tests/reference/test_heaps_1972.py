"""Heaps (1972): the density current of a stratified coast, with a = pi H / D_E."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError, ModelRangeError
from thalweg.sea.models.current_profiles import GRAVITY, WaterColumn, density_mean, density_profile

TABLE_2_2 = WaterColumn()  # Schless (2023), Table 2.2: rise 0.2 m, gradient -2e-4 kg/m4
CHECKS = {
    0.0: (-0.06282768, 0.25603431),
    0.25: (-0.03285661, 0.20994918),
    0.5: (0.00930078, 0.11137132),
    0.75: (0.03991365, 0.0265466),
    1.0: (0.01554963, 0.0),
}
COLUMNS = st.builds(
    WaterColumn,
    depth=st.floats(5.0, 80.0),
    viscosity=st.floats(1e-3, 0.1),
    coriolis=st.floats(2e-5, 1.4e-4),
    friction=st.floats(5e-4, 1e-2),
)


@pytest.mark.parametrize(("eta", "expected"), CHECKS.items())
def test_profile_has_the_checked_values(eta, expected):
    assert density_profile(eta, TABLE_2_2) == pytest.approx(expected, abs=1e-8)


def _curvatures(column, eta):
    step = 1e-3
    z = [density_profile(eta + k * step, column) for k in (-1, 0, 1)]
    height = column.depth + 0.2
    u, v = (np.array([values[k] for values in z]) for k in (0, 1))
    return [(a[0] - 2.0 * a[1] + a[2]) / (step * height) ** 2 for a in (u, v)]


def _slopes(column, eta, step):
    """Slopes with depth at one end, one-sided, of second order."""
    points = density_profile(eta + step * np.arange(3), column)
    height = column.depth + 0.2
    return [(-3.0 * p[0] + 4.0 * p[1] - p[2]) / (2.0 * step * height) for p in points]


@given(COLUMNS)
def test_profile_solves_the_equations_of_motion(column):
    """-f v = -g dz/dx - (g/rho) drho/dx Z + N u'' and f u = N v'' (Z down from the surface).

    The slope of the surface dz/dx is unknown, but one and the same at every depth.
    """
    height, n, f = column.depth + 0.2, column.viscosity, column.coriolis
    eta = np.linspace(0.1, 0.9, 9)
    u, v = density_profile(eta, column)
    u2, v2 = _curvatures(column, eta)
    pull = GRAVITY / 1000.0 * -2e-4 * eta * height
    size = max(np.abs(f * v).max(), np.abs(f * u).max(), np.abs(pull).max())
    assert np.abs(f * u - n * v2).max() < 1e-3 * size
    slope = f * v - pull + n * u2
    assert np.abs(slope - slope[0]).max() < 1e-3 * size


@given(COLUMNS)
def test_boundary_conditions_and_no_net_flow_across(column):
    """No stress at the surface, N du/dZ = -k u at the bed, no transport across."""
    eta = np.linspace(0.0, 1.0, 201)
    height = column.depth + 0.2
    steepest = max(np.abs(np.diff(p)).max() * 200.0 for p in density_profile(eta, column)) / height
    assert np.abs(_slopes(column, 0.0, 1e-4)).max() < 1e-3 * steepest
    bed = density_profile(1.0, column)
    assert abs(bed[1]) < 1e-9
    for slope, value in zip(_slopes(column, 1.0, -1e-4), bed):
        stress = column.viscosity * slope
        assert abs(stress + column.friction * value) < 1e-3 * column.viscosity * steepest
    node, weight = np.polynomial.legendre.leggauss(100)
    u, _ = density_profile(0.5 * (node + 1.0), column)
    assert abs(0.5 * weight @ u) < 1e-9


def test_means_over_draught():
    assert density_mean(5.0, TABLE_2_2) == pytest.approx((-0.0549, 0.2457), abs=5e-5)
    shallow = WaterColumn(depth=20.0)
    assert density_mean(5.0, shallow) == pytest.approx((-0.0488, 0.1466), abs=5e-5)
    node, weight = np.polynomial.legendre.leggauss(100)
    _, v = density_profile(0.5 * (node + 1.0), TABLE_2_2)
    assert 0.5 * weight @ v == pytest.approx(0.11892, abs=5e-6)
    assert density_mean(0.0, TABLE_2_2) == pytest.approx(CHECKS[0.0], abs=1e-8)


def test_fresh_water_on_the_other_side_turns_the_current():
    there = density_profile(0.2, TABLE_2_2, density_gradient=-2e-4)
    back = density_profile(0.2, TABLE_2_2, density_gradient=2e-4)
    assert np.allclose(np.add(there, back), 0.0, atol=1e-15)


def test_out_of_range_is_refused():
    with pytest.raises(ModelRangeError):
        density_profile(0.0, WaterColumn(coriolis=0.0))
    with pytest.raises(ModelRangeError):
        density_profile(0.0, WaterColumn(depth=5000.0, viscosity=1e-4))
    with pytest.raises(InputError):
        density_profile(1.1, TABLE_2_2)
