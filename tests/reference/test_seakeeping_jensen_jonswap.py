"""Spectra, and closed-form motions against published and derived numbers."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship.methods.seakeeping import ship_motions as sea
from thalweg.ship.methods.seakeeping import wave_spectra as spectra

G = 9.81
#: Prestegårdshus (2020) prints 5.058 where (5/16)(2 pi)^4 / g^2 is 5.0609.
PRINTED_CONSTANT = np.sqrt(5.058 / (0.3125 * (2.0 * np.pi) ** 4 / G**2))


def height_of(hs, tp, frequencies):
    density = spectra.jonswap(frequencies, height=hs, period=tp)
    return 4.0 * np.sqrt(np.trapezoid(density, frequencies))


@pytest.mark.parametrize(
    ("hs", "tp", "gamma", "printed", "coarse"),
    [
        (2.0, 8.0, 1.0, 1.9991, 1.9936),
        (4.0, 10.0, 1.0, 3.9985, 3.9941),
        (6.0, 11.0, 1.796, 5.9894, 5.9856),
        (3.0, 6.0, 5.0, 2.9982, 2.9844),
        (2.0, 4.0, 5.0, 1.9963, 1.9509),
    ],
)
def test_significant_height_with_the_printed_constant(hs, tp, gamma, printed, coarse):
    assert spectra.dnv_peak_factor(hs, tp) == pytest.approx(gamma, abs=5e-4)
    fine = np.linspace(0.05, 6.0, 20_001)
    assert PRINTED_CONSTANT * height_of(hs, tp, fine) == pytest.approx(printed, abs=1.1e-4)
    grid = np.arange(1, 301) * 0.01
    summed = 0.01 * spectra.jonswap(grid, height=hs, period=tp).sum()
    assert PRINTED_CONSTANT * 4.0 * np.sqrt(summed) == pytest.approx(coarse, abs=1.1e-4)


def test_peak_factor_of_dnv_and_its_ends():
    """5 up to Tp/sqrt(Hs) 3.6, one from 5 on, exp(5.75 - 1.15 x) between."""
    ratio = np.array([3.0, 3.59, 4.2, 4.8, 5.01, 5.1, 8.0])
    between = np.exp(5.75 - 1.15 * np.array([4.2, 4.8]))
    got = spectra.dnv_peak_factor(4.0, 2.0 * ratio)
    assert got == pytest.approx([5.0, 5.0, *between, 1.0, 1.0, 1.0], rel=1e-12)


@pytest.mark.parametrize(("hs", "tp"), [(2.0, 8.0), (6.0, 11.0), (3.0, 6.0), (2.0, 4.0)])
def test_fixed_quadrature_preserves_the_height(hs, tp):
    w, weights = spectra.quadrature(tp)
    m0 = spectra.spectral_moment(
        spectra.jonswap(w, height=hs, period=tp), weights, frequency=w, order=0
    )
    assert 4.0 * np.sqrt(m0) == pytest.approx(hs, rel=2e-3)


def test_peak_is_at_the_peak_period():
    w = np.linspace(0.2, 2.0, 18_001)
    density = spectra.jonswap(w, height=3.0, period=8.0, peak_factor=3.3)
    assert w[np.argmax(density)] == pytest.approx(2.0 * np.pi / 8.0, abs=1e-3)


def test_bretschneider_moments_are_closed():
    """m0 = Hs^2/16, m1, m2 by gamma functions: Tz = 0.7104 Tp, T01 = 0.7718 Tp."""
    w = np.linspace(0.05, 200.0, 2_000_001)
    density = spectra.bretschneider(w, height=4.0, period=10.0)
    m0, m1, m2 = (np.trapezoid(density * w**n, w) for n in range(3))
    assert m0 == pytest.approx(1.0, rel=1e-5)
    assert 2 * np.pi * m0 / m1 == pytest.approx(7.718, abs=2e-3)
    assert 2 * np.pi * np.sqrt(m0 / m2) == pytest.approx(7.104, abs=2e-3)


def test_fully_developed_sea():
    """Pierson-Moskowitz: Tp = 5.0 sqrt(Hs), peak frequency 0.4 sqrt(g/Hs)."""
    assert spectra.pierson_moskowitz_period(4.0) == pytest.approx(2 * 5.0, rel=3e-3)


JENSEN = {  # wave length / ship length -> heave [m/m], pitch [rad/m], pitch over wave slope
    1.2: (0.1879, 0.013622, 0.4553),
    1.5: (0.9119, 0.032978, 1.3778),
    2.0: (1.2636, 0.027582, 1.5364),
    3.0: (1.1141, 0.014423, 1.2051),
    6.0: (1.0402, 0.006342, 1.0598),
}
S175 = sea.MotionHull(length=175.0, breadth=25.4, draught=9.5, block_coefficient=14.5288 / 25.4)


@pytest.mark.parametrize(("ratio", "row"), JENSEN.items())
def test_jensen_head_sea(ratio, row):
    k = 2.0 * np.pi / (ratio * 175.0)
    speed = 0.275 * np.sqrt(G * 175.0)
    heave, pitch = sea.jensen_motions(
        [np.sqrt(G * k)], speed=speed, wave_angle=0.0, hull=S175, gravity=G
    )
    assert heave[0] == pytest.approx(row[0], abs=5.1e-5)
    assert pitch[0] == pytest.approx(row[1], abs=5.1e-7)
    assert pitch[0] / k == pytest.approx(row[2], abs=5.1e-5)


def test_jensen_is_the_mass_spring_form():
    """Heave gain as of a mass on a spring with w_n = sqrt(g / 2T), at rest in head seas."""
    w = np.linspace(0.2, 1.5, 50)
    k = w**2 / G
    box = 14.5288
    heave, _ = sea.jensen_motions(w, speed=0.0, wave_angle=0.0, hull=S175, gravity=G)
    wn, draught = np.sqrt(G / 19.0), 9.5
    a = 2.0 * np.sin(0.5 * k * box) * np.exp(-k * draught)
    damping = a**2 / (k * box)
    forcing = np.exp(-k * draught) * np.hypot(1.0 - k * draught, damping)
    spring = np.hypot(1.0 - (w / wn) ** 2, damping)
    expected = np.abs(np.sinc(k * 175.0 / (2.0 * np.pi))) * forcing / spring
    assert heave == pytest.approx(expected, rel=1e-10)


def test_most_probable_maximum_of_a_known_sea():
    """m0 = 1, Tz = 8 s, 3 h: N = 1350, sqrt(2 ln N) = 3.796."""
    m2 = (2.0 * np.pi / 8.0) ** 2
    got = spectra.most_probable_maximum(1.0, m2, duration=10_800.0)
    assert got == pytest.approx(np.sqrt(2.0 * np.log(1350.0)), rel=1e-12)
    assert got == pytest.approx(3.797, abs=1e-3)
    assert spectra.most_probable_maximum(0.0, 0.0, duration=100.0) == 0.0
    assert spectra.most_probable_maximum(1.0, m2, duration=1.0) == 0.0


def test_response_by_brute_force():
    """The 48 points against 20 000 of the trapezoidal rule, head sea, bow."""
    got = sea.ship_response(
        height=4.0, period=9.0, wave_angle=0.4, speed=7.0, hull=S175, forward=80.0
    )
    w = np.linspace(0.2, 5.0, 20_001)
    heave, pitch = sea.jensen_motions(w, speed=7.0, wave_angle=0.4, hull=S175, decay="strip")
    waves = spectra.jonswap(w, height=4.0, period=9.0)
    met = np.abs(w * sea.encounter_ratio(w, speed=7.0, wave_angle=0.4))
    bow = np.hypot(heave, 80.0 * pitch)
    assert got.heave.m0 == pytest.approx(np.trapezoid(heave**2 * waves, w), rel=3e-3)
    assert got.pitch.m0 == pytest.approx(np.trapezoid(pitch**2 * waves, w), rel=3e-3)
    acceleration = np.trapezoid((met**2 * bow) ** 2 * waves, w)
    assert got.acceleration.m0 == pytest.approx(acceleration, rel=1e-2)
    assert got.acceleration_parts.sum() == pytest.approx(got.acceleration.m0)
    assert got.motion.m2 == pytest.approx(np.trapezoid(met**2 * bow**2 * waves, w), rel=5e-3)


def test_significant_amplitude_is_twice_the_root():
    response = sea.SeaResponse(np.array([0.25, 4.0]), np.array([1.0, 1.0]))
    assert response.significant_amplitude.tolist() == [1.0, 4.0]
    default = response.most_probable_maximum()
    assert default == pytest.approx(response.most_probable_maximum(10_800.0), rel=1e-15)


def test_impossible_hull():
    with pytest.raises(InputError, match="block_coefficient"):
        sea.MotionHull(100.0, 20.0, 5.0, 1.2)
    with pytest.raises(InputError, match="draught"):
        sea.MotionHull(100.0, 20.0, -5.0, 0.8)


def test_unknown_decay():
    with pytest.raises(InputError, match="strip"):
        sea.jensen_motions([1.0], speed=1.0, wave_angle=0.0, hull=S175, decay="stripe")


def test_validity():
    assert sea.motions_validity([0.0, 8.0], S175) == []
    notes = sea.motions_validity(20.0, sea.MotionHull(40.0, 15.0, 3.0, 0.6))
    assert [note.quantity for note in notes] == ["Froude number", "length over breadth"]
