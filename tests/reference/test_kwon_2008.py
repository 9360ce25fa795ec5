"""Kwon (2008) as printed in Seuren (2020), tables B.1 to B.3; tolerance: half the last digit."""

import numpy as np
import pytest

from thalweg.core.units import GRAVITY, KNOT
from thalweg.ship.methods.speed_loss import (
    beaufort_number,
    kwon_direction_coefficients,
    kwon_form_coefficient,
    kwon_speed_coefficient,
    kwon_speed_loss,
)

TABLE_B2_NORMAL = {
    0.55: (1.7, -1.4, -7.4),
    0.60: (2.2, -2.5, -9.7),
    0.65: (2.6, -3.7, -11.6),
    0.70: (3.1, -5.3, -12.4),
    0.75: (2.4, -10.6, -9.5),
    0.80: (2.6, -13.1, -15.1),
    0.85: (3.1, -18.7, 28.0),
}
TABLE_B2_BALLAST = {0.75: (2.6, -12.5, -13.5), 0.80: (3.0, -16.3, -21.6), 0.85: (3.4, -20.9, 31.8)}


@pytest.mark.parametrize("loading", ["normal", "loaded"])
@pytest.mark.parametrize("block", TABLE_B2_NORMAL)
def test_table_b2_normal_as_printed(block, loading):
    a, b, c = TABLE_B2_NORMAL[block]
    found = kwon_speed_coefficient(0.1, block_coefficient=block, loading=loading, sign="printed")
    assert float(found) == pytest.approx(a + b * 0.1 + c * 0.01, abs=1e-12)


@pytest.mark.parametrize("block", TABLE_B2_BALLAST)
def test_table_b2_ballast_as_printed(block):
    a, b, c = TABLE_B2_BALLAST[block]
    found = kwon_speed_coefficient(0.1, block_coefficient=block, loading="ballast", sign="printed")
    assert float(found) == pytest.approx(a + b * 0.1 + c * 0.01, abs=1e-12)


@pytest.mark.parametrize(
    ("block", "plus", "printed"), [(0.75, 1.024, 0.596), (0.80, 0.975, 0.295), (0.85, 0.925, 0.925)]
)
def test_the_full_rows_form_one_family_with_a_plus(block, plus, printed):
    at = {"froude": 0.15, "block_coefficient": block}
    assert float(kwon_speed_coefficient(**at)) == pytest.approx(plus, abs=5e-4)
    assert float(kwon_speed_coefficient(**at, sign="printed")) == pytest.approx(printed, abs=5e-4)


def _first(zero_of, fn):
    """Lowest Froude number at which values on a fine axis change their sign."""
    return float(fn[np.flatnonzero(zero_of <= 0.0)[0]])


@pytest.mark.parametrize("loading", ["loaded", "ballast"])
@pytest.mark.parametrize("block", [0.75, 0.80, 0.85])
def test_with_a_plus_all_six_full_rows_meet_one_and_zero_at_the_same_speeds(block, loading):
    """As the row 0.85, printed with a plus: one near Fn 0.15, none near Fn 0.31.

    With a minus the rows 0.75 and 0.80 are one near Fn 0.11 and weather costs nothing from
    Fn 0.153 to 0.193 on, speeds at which full ships sail.
    """
    fn = np.linspace(0.0, 0.4, 40_001)
    at = {"block_coefficient": block, "loading": loading}
    plus = kwon_speed_coefficient(fn, **at)
    assert 0.142 < _first(plus - 1.0, fn) < 0.155
    assert 0.295 < _first(plus, fn) < 0.319
    if block < 0.85:
        minus = kwon_speed_coefficient(fn, **at, sign="printed")
        assert 0.107 < _first(minus - 1.0, fn) < 0.120
        assert 0.153 < _first(minus, fn) < 0.194


def test_speed_coefficient_of_seurens_own_ship():
    froude = 15.2 * KNOT / np.sqrt(9.81 * 152.9)
    assert froude == pytest.approx(0.2019, abs=5e-5)
    found = kwon_speed_coefficient(froude, block_coefficient=0.80)
    assert float(found) == pytest.approx(0.571, abs=5e-4)
    assert float(kwon_speed_coefficient(froude, block_coefficient=0.80, sign="printed")) == 0.0


@pytest.mark.parametrize(
    ("beaufort", "bow", "beam", "following"),
    [(4, 0.85, 0.33, 0.0), (6, 0.79, 0.45, 0.14), (7, 0.715, 0.42, 0.185), (8, 0.61, 0.33, 0.20)],
)
def test_table_b1_direction_coefficients(beaufort, bow, beam, following):
    found = kwon_direction_coefficients(beaufort)
    assert found.tolist() == pytest.approx([1.0, bow, beam, following], abs=1e-12)


@pytest.mark.parametrize(
    ("beaufort", "volume", "percent"),
    [
        *((4, 27150, 5.36), (5, 27150, 16.83), (6, 27150, 49.86), (7, 27150, 131.0)),
        *((4, 3e5, 2.68), (5, 3e5, 5.39), (6, 3e5, 12.45), (7, 3e5, 29.2)),
    ],
)
def test_table_b3_form_coefficient_loaded(beaufort, volume, percent):
    found = kwon_form_coefficient(beaufort, displacement_volume=volume)
    assert float(found) == pytest.approx(percent, rel=2e-3)


def test_table_b3_form_coefficient_ballast():
    found = kwon_form_coefficient(6, displacement_volume=3e5, loading="ballast")
    assert float(found) == pytest.approx(13.64507027, rel=1e-8)


def test_table_b3_container_as_printed_has_half():
    found = kwon_form_coefficient(6, displacement_volume=5e4, ship_type="container")
    assert float(found) == pytest.approx(8.03 - 0.2 * 6, abs=5e-3)


@pytest.mark.parametrize(
    ("wind", "number"), [(0.0, 0), (0.29, 0), (0.3, 1), (5.4, 3), (10.8, 6), (32.7, 12), (60.0, 12)]
)
def test_beaufort_classes(wind, number):
    assert float(beaufort_number(wind, classes=True)) == number


def test_continuous_beaufort_is_the_wmo_formula():
    numbers = np.arange(0.0, 12.0)
    assert beaufort_number(0.836 * numbers**1.5) == pytest.approx(numbers, abs=1e-12)


@pytest.mark.parametrize(
    ("angle", "sector"), [(0, 0), (30, 0), (31, 1), (60, 1), (61, 2), (150, 2), (151, 3), (180, 3)]
)
def test_the_printed_product_by_sector(angle, sector):
    wind, speed, length = 9.0, 10.0 * KNOT, 152.9  # Beaufort 5
    found = kwon_speed_loss(
        wind,
        np.radians(angle),
        speed=speed,
        length=length,
        block_coefficient=0.80,
        displacement_volume=27150.0,
        classes=True,
        hold=False,
    )
    direction = max([1.0, 0.85 - 0.015, 0.45 - 0.03, 0.20 - 0.015 * 9][sector], 0.0)
    fn = speed / np.sqrt(GRAVITY * length)
    expected = direction * (2.6 - 13.1 * fn + 15.1 * fn**2) * 16.82500255 / 100.0
    assert float(found) == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize(("degrees", "sector"), [(15, 0), (45, 1), (105, 2), (165, 3)])
def test_the_continuous_loss_meets_the_printed_one_in_the_middle_of_each_sector(degrees, sector):
    at = {
        "speed": 5.0,
        "length": 152.9,
        "block_coefficient": 0.8,
        "displacement_volume": 27150.0,
        "hold": False,
    }
    wind = 0.836 * 5.0**1.5  # Beaufort 5 in both readings
    smooth = kwon_speed_loss(wind, np.radians(degrees), **at)
    printed = kwon_speed_loss(wind, np.radians(degrees), classes=True, **at)
    assert float(smooth) == pytest.approx(float(printed), rel=1e-12)
