"""Prandle (1982): the tide over the water column.

The profiles are held against the equations of motion they solve (finite differences), their
boundary conditions, and values worked out independently of this code.
"""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm
from thalweg.sea.models.current_profiles import WaterColumn, tidal_mean, tidal_profile
from thalweg.sea.models.stratified_coast import (
    DECAY_LENGTH,
    M2_PERIOD,
    TIDAL_ELLIPSES,
    TidalEllipse,
    ellipse_phasors,
    stratified_coast_current,
)

TABLE_2_1 = WaterColumn()  # Schless (2023), Table 2.1

# height above the bed: anticlockwise, clockwise
CHECKS = {
    0.0: (0.50457387 + 0.1775017j, 0.28635144 - 0.0678032j),
    6.25: (1.05718378 + 0.07661737j, 0.78039355 - 0.09553555j),
    12.5: (1.06560595 - 0.07097584j, 1.0985949 - 0.0069814j),
    18.75: (1.02767251 - 0.08188094j, 1.26860497 + 0.08601935j),
    25.0: (1.02052272 - 0.07489881j, 1.32112566 + 0.12324924j),
}
COLUMNS = st.builds(
    WaterColumn,
    depth=st.floats(3.0, 200.0),
    viscosity=st.floats(5e-4, 0.1),
    coriolis=st.floats(-1.4e-4, 1.4e-4).filter(
        lambda f: min(abs(f - 1.4e-4), abs(f + 1.4e-4)) > 1e-6
    ),
    speed=st.floats(0.05, 2.0),
)


@pytest.mark.parametrize(("height", "expected"), CHECKS.items())
def test_profile_has_the_checked_values(height, expected):
    assert np.allclose(tidal_profile(height, TABLE_2_1), expected, rtol=0, atol=1e-8)


def test_slip_and_boundary_layers():
    assert pytest.approx(0.325889, abs=1e-6) == TABLE_2_1.slip
    layers = [1.0 / a.real for a in TABLE_2_1.rotations]
    assert layers == pytest.approx([4.686, 14.967], abs=1e-3)


@given(COLUMNS)
def test_profile_solves_the_equation_of_motion(column):
    """i (f +- w) R = G + E R'': the difference between two heights loses the unknown slope G."""
    z = np.linspace(0.1, 0.9, 9) * column.depth
    for sign, alpha, part in zip((1.0, -1.0), column.rotations, (0, 1)):
        # near the inertial frequency the profile is so even that its differences are rounding
        assume(abs(alpha) * column.depth > 0.05)
        step = 1e-3 * min(1.0 / abs(alpha), column.depth)
        below, here, above = (tidal_profile(z + d, column)[part] for d in (-step, 0.0, step))
        curvature = (below - 2.0 * here + above) / step**2
        rate = column.coriolis + sign * column.frequency
        slope = 1j * rate * here - column.viscosity * curvature
        size = abs(rate) * np.abs(here).max()
        assert np.abs(slope - slope[0]).max() < 2e-4 * size


@given(COLUMNS)
def test_no_stress_at_the_surface_and_friction_at_the_bed(column):
    for alpha, part in zip(column.rotations, (0, 1)):
        step = 1e-4 * min(1.0 / abs(alpha), column.depth, 1.0 / column.slip)
        points = np.array([0.0, step, 2.0 * step])
        bed = tidal_profile(points, column)[part]
        top = tidal_profile(column.depth - points, column)[part]
        bed_slope = (-3.0 * bed[0] + 4.0 * bed[1] - bed[2]) / (2.0 * step)
        top_slope = (-3.0 * top[0] + 4.0 * top[1] - top[2]) / (2.0 * step)
        assert abs(bed_slope - column.slip * bed[0]) < 1e-5 * abs(column.slip * bed[0])
        assert abs(top_slope) < 1e-5 * abs(bed_slope)


@pytest.mark.slow
@given(COLUMNS, st.floats(0.01, 1.0))
def test_mean_over_the_draught_is_the_integral(column, share):
    draught = share * column.depth
    node, weight = np.polynomial.legendre.leggauss(200)
    heights = column.depth - 0.5 * (node + 1.0) * draught
    for mean, profile in zip(tidal_mean(draught, column), tidal_profile(heights, column)):
        assert mean == pytest.approx(complex(0.5 * weight @ profile), abs=1e-8)


@given(COLUMNS)
def test_depth_mean_is_one(column):
    assert np.allclose(tidal_mean(column.depth, column), 1.0, atol=1e-9)


def test_very_deep_water_does_not_overflow():
    column = WaterColumn(depth=8000.0, viscosity=1e-3)
    assert np.isfinite(tidal_profile([0.0, 4000.0, 8000.0], column)).all()
    assert np.allclose(tidal_mean(5.0, column), np.ravel(tidal_profile(8000.0, column)), atol=1e-9)


def test_a_tide_that_turns_with_the_earth_is_the_limit_of_its_neighbours():
    at = tidal_profile(20.0, WaterColumn(coriolis=1.4e-4))[1]
    near = tidal_profile(20.0, WaterColumn(coriolis=1.4e-4 * 1.0001))[1]
    assert at == pytest.approx(complex(near), abs=5e-3)


def test_surface_ellipse_of_a_rectilinear_depth_mean():
    """Phasors U/2, not U: surface axes 0.505 and 0.065 m/s, clockwise (thesis: 1.011, 0.131)."""
    plus, minus = (0.5 * 0.43 * complex(r) for r in tidal_profile(25.0, TABLE_2_1))
    assert abs(plus) + abs(minus) == pytest.approx(0.505, abs=5e-4)
    assert abs(minus) - abs(plus) == pytest.approx(0.065, abs=5e-4)
    bed_plus, bed_minus = (abs(complex(r)) for r in tidal_profile(0.0, TABLE_2_1))
    assert bed_plus > bed_minus  # anticlockwise at the bed


def test_scenarios_are_those_of_table_4_9():
    assert [s.cross_shore / s.alongshore for s in TIDAL_ELLIPSES.values()] == pytest.approx(
        [1 / 2, 1 / 4, 1 / 8, 1 / 16]
    )
    assert [s.alongshore for s in TIDAL_ELLIPSES.values()] == pytest.approx([0.7, 0.8, 0.9, 1.0])


@pytest.mark.parametrize("name", TIDAL_ELLIPSES)
def test_surface_current_runs_through_the_ellipse_clockwise(name):
    sea = Sea.from_functions(
        stratified_coast_current(
            name, coast=(52.0, 4.0), onshore_deg=90.0, flood=0.0, density_gradient=0
        )
    )
    quarter = np.arange(4) * M2_PERIOD / 4.0
    found = sea.sample(list(nm.CURRENT.pair), quarter, 52.0, 4.0)
    along, across = TIDAL_ELLIPSES[name].alongshore, TIDAL_ELLIPSES[name].cross_shore
    east, north = (found[n] for n in nm.CURRENT.pair)
    assert north == pytest.approx([along, 0.0, -along, 0.0], abs=1e-9)
    assert east == pytest.approx([0.0, across, 0.0, -across], abs=1e-9)


def test_current_fades_offshore_and_turns_with_the_coast():
    """A coast that faces south-west: onshore is north-east (45 degrees), along it north-west."""
    functions = stratified_coast_current(
        "spring", coast=(52.0, 4.0), onshore_deg=45.0, flood=0.0, density_gradient=0
    )
    east, north = (functions[n] for n in nm.CURRENT.pair)
    offshore = 30e3
    lat = 52.0 - np.degrees(offshore * np.sqrt(0.5) / 6371008.8)
    lon = 4.0 - np.degrees(offshore * np.sqrt(0.5) / 6371008.8 / np.cos(np.radians(52.0)))
    point = np.zeros(1), np.array([lat]), np.array([lon])
    expected = np.exp(-offshore / DECAY_LENGTH) * np.sqrt(0.5)
    assert east(*point) == pytest.approx(-expected, rel=1e-9)
    assert north(*point) == pytest.approx(expected, rel=1e-9)
    on_land = np.zeros(1), np.array([53.0]), np.array([6.0])
    assert np.hypot(east(*on_land), north(*on_land)) == pytest.approx(1.0)


def test_draught_takes_the_mean_of_the_profile():
    deep = ellipse_phasors("neap", WaterColumn(), 25.0)
    shallow = ellipse_phasors("neap", WaterColumn(), 5.0)
    surface = ellipse_phasors("neap", WaterColumn(), 0.0)
    assert abs(surface[0]) == pytest.approx(0.175)
    assert abs(surface[1]) == pytest.approx(0.525)
    assert abs(deep[1]) == pytest.approx(0.525 / abs(CHECKS[25.0][1]))
    assert abs(deep[1]) < abs(shallow[1]) < abs(surface[1])


@pytest.mark.parametrize(
    "make",
    [
        lambda: WaterColumn(depth=0.0),
        lambda: WaterColumn(viscosity=float("nan")),
        lambda: tidal_profile(26.0, TABLE_2_1),
        lambda: tidal_mean(26.0, TABLE_2_1),
        lambda: ellipse_phasors("nep", TABLE_2_1),
        lambda: ellipse_phasors(TidalEllipse(0.3, 0.5), TABLE_2_1),
        lambda: stratified_coast_current(coast=(52, 4), onshore_deg=90, flood=0.0, decay=0.0),
    ],
)
def test_invalid_values_are_refused(make):
    with pytest.raises(InputError):
        make()
