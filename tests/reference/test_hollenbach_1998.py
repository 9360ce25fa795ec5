"""Hollenbach (1998) against published values of other authors.

The single-screw design line is compared with the table "HOLLENBACH (from code)" of Yu (2021), NTNU
Marine DataLab, whose inputs are L 162.45 m, C_B 0.728 and L_OS = L_WL = 172.42 m (the 172.24 m of
its input file is a digit swap; the particulars of its Table 2 belong to another hull and give
9 to 27 % more). The other variants are compared with an independent calculation.
"""

import numpy as np
import pytest

from thalweg.ship.methods.resistance.friction_lines import Water
from thalweg.ship.methods.resistance.hollenbach import (
    correlation_allowance,
    critical_froude_number,
    froude_factor,
    froude_length,
    froude_limits,
    hollenbach_1998,
    hollenbach_validity,
    hollenbach_wetted_surface,
    residuary_coefficient,
    standard_residuary,
)
from thalweg.ship.methods.resistance.hollenbach_hull import (
    AppendageCounts,
    HollenbachHull,
)

YU_KNOT = 0.5144
YU_HULL = {
    "length_between_perpendiculars": 162.45,
    "length_waterline": 172.42,
    "length_over_surface": 172.42,
    "breadth": 32.0,
    "draught_fore": 10.0,
    "draught_aft": 10.0,
    "block_coefficient": 0.728,
    "propeller_diameter": 4.0,
}
YU_WATER = Water(density=1025.0, viscosity=1.1395e-6, gravity=9.81)


def yu(speed, hull=YU_HULL, **options):
    """Resistance with the wetted surface and the water of Yu's program."""
    return hollenbach_1998(
        speed, HollenbachHull(**hull), wetted_surface=8267.52, water=YU_WATER, **options
    )


def test_yu_printed_column():
    speeds = np.arange(12.0, 17.01, 0.5)
    printed = [
        *(377.726, 411.223, 447.720, 487.569, 531.146, 578.854),
        *(631.118, 688.390, 751.146, 819.887, 895.140),
    ]
    got = yu(speeds * YU_KNOT).total / 1000.0
    np.testing.assert_allclose(got, printed, rtol=5e-4)
    assert np.max(np.abs(got / printed - 1.0)) > 1e-4  # the last digits of S or L are not printed


def test_yu_table_2_hull_is_another_ship():
    hull = YU_HULL | {"length_between_perpendiculars": 169.0, "block_coefficient": 0.785}
    got = yu(np.array([12.0, 14.0, 15.0, 17.0]) * YU_KNOT, hull).total / 1000.0
    np.testing.assert_allclose(got, [413.0, 603.0, 731.0, 1135.0], atol=0.6)
    excess = got / np.array([377.726, 531.146, 631.118, 895.140]) - 1.0
    assert excess.min() == pytest.approx(0.09, abs=0.01)
    assert excess.max() == pytest.approx(0.27, abs=0.01)


@pytest.mark.parametrize(
    ("variant", "expected"),
    [
        (
            "single_design",
            (377.83731129, 447.86307152, 531.31862155, 631.31356769, 751.35553646, 895.34991026),
        ),
        (
            "single_ballast",
            (373.05544333, 442.03497381, 519.61182323, 606.80302416, 704.73605645, 814.64858294),
        ),
        (
            "twin_design",
            (383.44778059, 453.35991786, 533.73857533, 626.45909082, 733.62990468, 857.59229546),
        ),
        (
            "single_minimum",
            (316.42195078, 376.19416309, 449.03336297, 538.22326947, 647.46763524, 780.88998237),
        ),
        (
            "twin_minimum",
            (312.08800974, 371.16513744, 443.60883995, 532.85643855, 642.78619395, 777.71704195),
        ),
    ],
)
def test_every_variant(variant, expected):
    speeds = np.arange(12.0, 18.0) * YU_KNOT
    got = yu(speeds, variant=variant, appendages=AppendageCounts(rudders=1)).total / 1000.0
    np.testing.assert_allclose(got, expected, rtol=1e-9)


def test_wetted_surface_regressions():
    single = hollenbach_wetted_surface(
        HollenbachHull(
            length_between_perpendiculars=169.0,
            length_waterline=172.42,
            length_over_surface=172.42,
            breadth=32.0,
            draught_fore=10.0,
            draught_aft=10.0,
            block_coefficient=0.785,
            propeller_diameter=6.0,
        ),
    )
    assert single == pytest.approx(7373.8808715, rel=1e-9)
    twin = hollenbach_wetted_surface(
        HollenbachHull(
            length_between_perpendiculars=150.0,
            length_waterline=153.0,
            length_over_surface=157.0,
            breadth=25.0,
            draught_fore=6.0,
            draught_aft=6.0,
            block_coefficient=0.6,
            propeller_diameter=4.2,
        ),
        appendages=AppendageCounts(rudders=2, brackets=2, bosses=2),
        variant="twin_bulb",
    )
    assert twin == pytest.approx(4273.56971961, rel=1e-9)


def test_a_hull_worked_by_an_open_ship_library():
    """L_PP 145 m: factors, wetted surface and C_A in its tests of the method after Birk (2019)."""
    hull = {
        "length_between_perpendiculars": 145.0,
        "length_waterline": 147.7,
        "length_over_surface": 151.0,
        "breadth": 24.0,
        "draught_fore": 8.2,
        "draught_aft": 8.2,
        "block_coefficient": 18_872.0 / (145.0 * 24.0 * 8.2),
        "propeller_diameter": 4.9,
    }
    assert froude_length(145.0, length_over_surface=151.0) == pytest.approx(149.0)
    assert hollenbach_wetted_surface(HollenbachHull(**hull)) == pytest.approx(4448.453, abs=5e-4)
    assert correlation_allowance(145.0) == pytest.approx(0.06e-3)
    factors = 0.9778 * 1.4379 * 0.2335 * 0.8753 * 0.9364 * 0.9925  # k_L, k_BT, k_LB ... k_PR
    fn = 0.2
    standard = standard_residuary(fn, block_coefficient=hull["block_coefficient"])
    growth = froude_factor(fn, block_coefficient=hull["block_coefficient"])
    found = residuary_coefficient(fn, HollenbachHull(**hull))
    assert found == pytest.approx(0.1 * factors * standard * growth, rel=5e-4)


def test_wetted_surface_is_near_denny_mumford():
    length, breadth, draught, block = 169.0, 32.0, 10.0, 0.785
    denny = 1.7 * length * draught + block * length * breadth
    got = hollenbach_wetted_surface(
        HollenbachHull(
            length_between_perpendiculars=length,
            length_waterline=172.42,
            length_over_surface=172.42,
            breadth=breadth,
            draught_fore=draught,
            draught_aft=draught,
            block_coefficient=block,
            propeller_diameter=6.0,
        ),
    )
    assert got == pytest.approx(denny, rel=0.05)


def test_froude_length_has_three_branches():
    got = froude_length(100.0, length_over_surface=[95.0, 100.0, 106.0, 110.0, 130.0])
    np.testing.assert_allclose(got, [95.0, 100.0, 104.0, 106.67, 106.67])


def test_ballast_factor_is_one_below_the_critical_froude_number():
    critical = critical_froude_number(0.728, variant="single_ballast")
    assert critical == pytest.approx(0.032 + 0.803 * 0.728 - 0.739 * 0.728**2)
    below = froude_factor([0.0, 0.15, critical], block_coefficient=0.728, variant="single_ballast")
    np.testing.assert_array_equal(below, 1.0)
    above = froude_factor(1.1 * critical, block_coefficient=0.728, variant="single_ballast")
    assert above == pytest.approx(1.1 ** (10 * 0.728 * 0.1))


def test_froude_limits_and_notes():
    low, high = froude_limits(0.728)
    assert low == pytest.approx(0.17 + 0.2 * (0.6 - 0.728))
    assert high == pytest.approx(0.642 - 0.635 * 0.728 + 0.15 * 0.728**2)
    hull = HollenbachHull(**YU_HULL)
    assert hollenbach_validity(np.array([12.0, 17.0]) * YU_KNOT, hull) == []
    (slow, fast) = hollenbach_validity([1.0, 15.0, np.nan], hull)
    assert slow.quantity == fast.quantity == "Froude number"
    assert slow.value < slow.low == pytest.approx(low)
    assert fast.value > fast.high == pytest.approx(high)
    assert "hollenbach_1998" in str(fast)


def test_correlation_option_adds_on_the_wetted_surface():
    np.testing.assert_allclose(correlation_allowance([100.0, 175.0, 300.0]), [1.5e-4, 0.0, 0.0])
    plain = yu(7.0)
    with_allowance = yu(7.0, correlation_allowance=1e-4)
    added = 0.5 * 1025.0 * 49.0 * 8267.52 * 1e-4
    assert with_allowance.total - plain.total == pytest.approx(added)
    assert with_allowance.correlation == pytest.approx(added)
