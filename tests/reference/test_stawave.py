"""STAwave-1 and STAwave-2 of ITTC 7.5-04-01-01.2 against an independent calculation."""

import numpy as np
import pytest

from thalweg.ship.methods.added_resistance.mean_wave_force import (
    spectral_shape,
)
from thalweg.ship.methods.added_resistance.stawave import (
    stawave1,
    stawave1_validity,
    stawave2,
    stawave2_transfer,
    stawave2_validity,
)

SHIP = {
    "length_between_perpendiculars": 169.0,
    "breadth": 32.0,
    "draught": 10.0,
    "block_coefficient": 0.785,
}
WATER = {"density": 1025.0, "gravity": 9.81}
SPEED = 7.202216  # 14 kn
PEAK_TO_MEAN_PERIOD = 2.0 * np.pi / (0.8 * 691.0) ** 0.25  # of the ITTC spectrum (1978)


def spectral_density(omega, *, wave_height, wave_period, spectrum="bretschneider"):
    ratio = omega * wave_period / (2.0 * np.pi)
    return wave_height**2 * spectral_shape(ratio, spectrum=spectrum, gamma=3.3) / omega


def test_stawave1():
    got = stawave1(2.0, 0.0, breadth=32.0, bow_length=30.0, **WATER)
    assert got == pytest.approx(83080.14035616, rel=1e-9)


def test_stawave2_in_regular_waves():
    motion, reflection = stawave2_transfer([0.4, 0.6, 0.8, 1.0, 1.5], SPEED, **SHIP, **WATER)
    expected = [17736.3118653, 403156.61176231, 77091.96588259, 12818.78328904, 419.66167592]
    np.testing.assert_allclose(motion, expected, rtol=1e-9)
    expected = [1423.73670411, 38687.93983, 124979.49762549, 140296.40250429, 141281.14282631]
    np.testing.assert_allclose(reflection, expected, rtol=1e-9)


@pytest.mark.parametrize(("mean_period", "published"), [(7.0, 118.4), (9.0, 127.0)])
def test_stawave2_in_the_ittc_spectrum(mean_period, published):
    got = stawave2(SPEED, 2.0, PEAK_TO_MEAN_PERIOD * mean_period, 0.0, **SHIP, **WATER)
    assert got / 1000.0 == pytest.approx(published, rel=4e-3)


@pytest.mark.parametrize("period", [4.0, 6.0, 9.0, 12.0, 18.0])
@pytest.mark.parametrize("spectrum", ["bretschneider", "jonswap"])
def test_quadrature_against_a_fine_one(period, spectrum):
    omega = np.linspace(0.05, 15.0, 60001)
    energy = spectral_density(omega, wave_height=2.0, wave_period=period, spectrum=spectrum)
    fine = 2.0 * np.trapezoid(sum(stawave2_transfer(omega, SPEED, **SHIP)) * energy, omega)
    got = stawave2(SPEED, 2.0, period, 0.0, spectrum=spectrum, **SHIP)
    assert got == pytest.approx(fine, rel=5e-4)


def test_spectrum_holds_the_energy_of_its_height():
    omega = np.linspace(0.02, 60.0, 400001)
    for spectrum, tolerance in (("bretschneider", 1e-5), ("jonswap", 3e-3)):
        energy = spectral_density(omega, wave_height=3.0, wave_period=8.0, spectrum=spectrum)
        assert 4.0 * np.sqrt(np.trapezoid(energy, omega)) == pytest.approx(3.0, rel=tolerance)


def test_ittc_form_of_the_spectrum():
    omega = np.array([0.4, 0.7, 1.2, 3.0])
    height, mean = 2.0, 7.0
    ittc = 173.0 * height**2 / mean**4 / omega**5 * np.exp(-691.0 / mean**4 / omega**4)
    got = spectral_density(omega, wave_height=height, wave_period=PEAK_TO_MEAN_PERIOD * mean)
    np.testing.assert_allclose(got, ittc, rtol=2e-3)  # 173 / 691 is 1/4 within 0.14 %


def test_outside_the_sector_no_resistance_is_invented():
    angles = np.radians([0.0, 44.9, -44.9, 45.0, 45.1, 90.0, 180.0, 315.1, 314.9])
    inside = [1, 1, 1, 1, 0, 0, 0, 1, 0]
    head = stawave2(SPEED, 2.0, 9.0, 0.0, **SHIP)
    np.testing.assert_allclose(
        stawave2(SPEED, 2.0, 9.0, angles, **SHIP), head * np.array(inside), rtol=1e-12
    )
    head = stawave1(2.0, 0.0, breadth=32.0, bow_length=30.0)
    np.testing.assert_allclose(
        stawave1(2.0, angles, breadth=32.0, bow_length=30.0), head * np.array(inside)
    )


def test_unknown_waves_stay_unknown_and_no_waves_are_none():
    got = stawave2(
        [SPEED, np.nan, SPEED, SPEED, SPEED, SPEED],
        [0.0, 1.0, np.nan, 1.0, 1.0, 1.0],
        [np.nan, 8.0, 8.0, np.nan, 0.0, 8.0],
        [np.nan, 0.0, 0.0, 0.0, 0.0, np.nan],
        **SHIP,
    )
    np.testing.assert_array_equal(np.isnan(got), [False, True, True, True, True, True])
    assert got[0] == 0.0
    assert np.isnan(stawave1(1.0, np.nan, breadth=32.0, bow_length=30.0))
    assert stawave1(0.0, np.nan, breadth=32.0, bow_length=30.0) == 0.0


def test_validity():
    assert stawave2_validity(SPEED, **SHIP) == []
    small = SHIP | {"length_between_perpendiculars": 60.0}
    notes = {note.quantity for note in stawave2_validity([1.0, 9.0], **small)}
    assert notes == {"length between perpendiculars", "length to breadth", "Froude number"}
    (note,) = stawave1_validity([1.0, 3.0], length_between_perpendiculars=100.0)
    assert (note.value, note.high) == (3.0, 2.25)


def test_ranges_of_stawave2_are_those_of_the_procedure():
    inside = [  # L_PP, B, T, C_B, Fn just inside the lower and the upper ends
        {"length": 76.0, "wide": 18.9, "deep": 8.5, "block": 0.40, "froude": 0.101},
        {"length": 349.0, "wide": 38.9, "deep": 4.34, "block": 0.89, "froude": 0.299},
    ]
    outside = [
        {"length": 74.0, "wide": 18.6, "deep": 8.5, "block": 0.38, "froude": 0.099},
        {"length": 351.0, "wide": 38.9, "deep": 4.3, "block": 0.91, "froude": 0.301},
    ]

    def quantities(length, wide, deep, block, froude):
        speed = froude * np.sqrt(9.81 * length)
        notes = stawave2_validity(
            speed,
            length_between_perpendiculars=length,
            breadth=wide,
            draught=deep,
            block_coefficient=block,
            gravity=9.81,
        )
        return {note.quantity for note in notes}

    assert [quantities(**at) for at in inside] == [set(), set()]
    five = {
        *("length between perpendiculars", "length to breadth", "breadth to draught"),
        *("block coefficient", "Froude number"),
    }
    assert [quantities(**at) for at in outside] == [five, five]
