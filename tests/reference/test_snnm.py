"""The SNNM formula: its special cases, its limits, and the size of a published peak."""

import math

import numpy as np
import pytest

from thalweg.core.units import GRAVITY
from thalweg.ship.methods.added_resistance.snnm import (
    snnm_transfer,
    snnm_validity,
)
from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
    entrance_length,
)
from thalweg.ship.methods.added_resistance.snnm_table import SnnmTable
from thalweg.ship.methods.seakeeping.wave_spectra import bretschneider

KVLCC2 = SnnmHull(
    length=320.0,
    breadth=58.0,
    draught_fore=20.8,
    draught_aft=20.8,
    block_coefficient=0.8098,
    entrance_length=60.0,
    run_length=90.0,
)
SPEED = 0.142 * np.sqrt(GRAVITY * 320.0)
UNIT = 1025.0 * GRAVITY * 58.0**2 / 320.0


def frequency(length_ratio):
    return np.sqrt(2.0 * np.pi * GRAVITY / (np.asarray(length_ratio) * 320.0))


def test_head_wave_motion_written_out():
    """Equal draughts, waves from ahead: the formula as printed, term by term."""
    ratio, fn, block = 1.2, 0.142, 0.8098
    scale = 2.142 * 0.25 ** (1 / 3) * np.sqrt(1 / ratio) * (block / 0.65) ** 0.17
    scale *= 1.0 - 0.111 / block * (np.log(58.0 / 20.8) - np.log(2.75))
    scale *= -1.377 * fn**2 + 1.157 * fn + 0.618
    b1, d1 = (
        (11.0, 566.0 * (320.0 * block / 58.0) ** -2.66)
        if scale < 1.0
        else (-8.5, -566.0 * (320.0 / 58.0) ** -2.66 * 4.0)
    )
    a1 = 60.3 * block**1.34 * (0.87 / block) ** (1.0 + fn) / np.log(58.0 / 20.8)
    a2 = fn**1.5 * np.exp(-3.5 * fn)
    expected = 4.0 * UNIT * a1 * a2 * scale**b1 * np.exp(b1 / d1 * (1.0 - scale**d1))
    motion, _ = snnm_transfer(frequency(ratio), SPEED, 0.0, KVLCC2)
    assert motion == pytest.approx(expected, rel=1e-9)


def test_short_head_waves_are_reflected_by_the_entrance():
    """Very short waves from ahead: 2.25/2 rho g B sin^2 E1 and its speed term, no draught left."""
    omega, bow = frequency(0.05), np.arctan(0.495 * 58.0 / 60.0)
    _, reflection = snnm_transfer(omega, SPEED, 0.0, KVLCC2)
    inside = np.sin(bow) ** 2 + 2.0 * omega * SPEED / GRAVITY * (1.0 - np.cos(bow) ** 2)
    front = (0.87 / 0.8098) ** (1.0 + 4.0 * np.sqrt(0.142))
    expected = 2.0 * 2.25 / 4.0 * 1025.0 * GRAVITY * 58.0 * inside * front
    assert reflection == pytest.approx(expected, rel=1e-6)


def _by_hand(length_ratio, speed, angle, hull):
    """The procedure written out with plain numbers, one condition: motion and reflection [N/m2]."""
    size, wide, block = hull.length, hull.breadth, hull.block_coefficient
    deep, trim = max(hull.draught_fore, hull.draught_aft), hull.draught_aft - hull.draught_fore
    omega = math.sqrt(2.0 * math.pi * GRAVITY / (length_ratio * size))
    fn, group = speed / math.sqrt(GRAVITY * size), GRAVITY / (2.0 * omega)
    slope, slim = math.atan(abs(trim) / size), math.log(wide / deep)

    def a2_of(froude):
        if froude < 0.12:
            return 0.0072 + 0.1676 * froude
        return froude**1.5 * math.exp(-3.5 * froude)

    ahead = max(math.cos(angle), 0.0)
    a1 = (0.87 / block) ** ((1.0 + fn) * ahead) / slim * (1.0 + 2.0 * ahead) / 3.0
    a2 = a2_of(fn)
    if angle > math.pi / 2:
        relative = (speed - group) / math.sqrt(GRAVITY * size)
        passes = speed > group
        power = 1.0 + relative if passes and relative >= 0.12 else 1.0
        astern_1 = (0.87 / block) ** power / slim
        astern_2 = a2_of(relative) if passes else 0.0072 * (2.0 * speed / group - 1.0)
        part = angle / (math.pi / 2) - 1.0
        a1, a2 = a1 + part * (astern_1 - a1), a2 + part * (astern_2 - a2)
    scale = 2.142 * hull.pitch_gyration ** (1.0 / 3.0) * math.sqrt(1.0 / length_ratio)
    scale *= (block / 0.65) ** 0.17 * (1.0 - 0.111 / block * (slim - math.log(2.75)))
    scale *= (-1.377 * fn**2 + 1.157 * fn) * abs(math.cos(angle)) + 0.618 * (
        13.0 + math.cos(2.0 * angle)
    ) / 14.0
    b1, d1 = 11.0, 566.0 * (size * block / wide) ** -2.66
    if scale >= 1.0:
        b1, d1 = -8.5, -566.0 * (size / wide) ** -2.66 * (4.0 - 125.0 * slope)
    motion = 3859.2 * 1025.0 * GRAVITY * wide**2 / size * block**1.34 * hull.pitch_gyration**2
    motion *= a1 * a2 * (1.0 + 28.7 * slope)
    motion *= scale**b1 * math.exp(b1 / d1 * (1.0 - scale**d1))

    bow, stern = (math.atan(0.495 * wide / end) for end in (hull.entrance_length, hull.run_length))
    root = math.sqrt(abs(math.cos(angle)))
    counts = deep * ((4.0 + root) / 5.0 if block <= 0.75 else (2.0 + root) / 3.0)

    def orbital_decay(depth):
        excess = 1.0 / (length_ratio * size) - 1.0 / (2.5 * size)
        return 1.0 - math.exp(-4.0 * math.pi * depth * excess) if excess > 0.0 else 0.0

    def end(own, side):
        turned = own + side * angle
        doppler = math.cos(angle) - math.cos(own) * math.cos(turned)
        return math.sin(turned) ** 2 + 2.0 * omega * speed / GRAVITY * doppler

    front = math.cos(angle) if angle <= bow else 0.0
    front = (0.87 / block) ** ((1.0 + 4.0 * math.sqrt(fn)) * front)
    total = 0.0
    if angle <= math.pi - bow:
        total += orbital_decay(deep) * end(bow, 1.0) * front
    if angle <= bow:
        total += orbital_decay(deep) * end(bow, -1.0) * front
    if angle >= stern:
        total -= orbital_decay(counts) * end(stern, -1.0)
    if angle >= math.pi - stern:
        total -= orbital_decay(counts) * end(stern, 1.0)
    return motion, 2.25 / 4.0 * 1025.0 * GRAVITY * wide * total


TRIMMED = SnnmHull(175.0, 25.4, 9.0, 10.0, 0.57, 60.0, 70.0, pitch_gyration=0.24)


@pytest.mark.parametrize("hull", [KVLCC2, TRIMMED], ids=["full", "fine and trimmed"])
@pytest.mark.parametrize("degrees", [0.0, 10.0, 30.0, 75.0, 90.0, 110.0, 150.0, 165.0, 180.0])
def test_the_complete_formula_written_out(hull, degrees):
    """Every heading, waves from short to long, ships that wait, overtake slowly and fast."""
    for ratio in (0.05, 0.15, 0.5, 0.9, 1.4, 2.4, 2.6):
        for froude in (0.05, 0.11, 0.16, 0.27):
            speed, angle = froude * np.sqrt(GRAVITY * hull.length), np.radians(degrees)
            omega = np.sqrt(2.0 * np.pi * GRAVITY / (ratio * hull.length))
            got = snnm_transfer(omega, speed, angle, hull, density=1025.0)
            expected = _by_hand(ratio, float(speed), float(angle), hull)
            unit = 1025.0 * GRAVITY * hull.breadth**2 / hull.length
            assert [float(x) for x in got] == pytest.approx(expected, rel=1e-9, abs=1e-9 * unit)


def test_no_reflection_beyond_two_and_a_half_lengths():
    _, reflection = snnm_transfer(frequency([2.49, 2.5, 4.0]), SPEED, 0.3, KVLCC2)
    assert reflection[0] > 0.0
    np.testing.assert_allclose(reflection[1:], 0.0, atol=1e-6 * UNIT)


def test_kvlcc2_head_wave_peak_has_the_published_size():
    """Tank tests of the KVLCC2 at Fr 0.142 peak near lambda/L 1.1 at 6 to 8 rho g a^2 B^2/L."""
    ratio = np.linspace(0.3, 2.4, 200)
    total = sum(snnm_transfer(frequency(ratio), SPEED, 0.0, KVLCC2)) / UNIT
    assert 1.0 < ratio[np.argmax(total)] < 1.25
    assert 6.0 < total.max() < 8.0


def test_following_waves_push_a_ship_that_is_slow_and_hinder_one_that_overtakes_them():
    omega = frequency(0.9)
    group = GRAVITY / (2.0 * omega)
    motion, _ = snnm_transfer(omega, group * np.array([0.0, 0.4, 0.5, 1.0]), np.pi, KVLCC2)
    assert motion[0] < motion[1] < 0.0
    assert motion[2] == pytest.approx(0.0, abs=1e-9 * UNIT)
    assert motion[3] > 0.0


@pytest.mark.parametrize("angle_deg", [0.0, 60.0, 90.0, 130.0, 180.0])
def test_quadrature_against_a_fine_one(angle_deg):
    omega = np.linspace(0.05, 15.0, 60001)
    energy = bretschneider(omega, height=2.0, period=9.0)
    force = sum(snnm_transfer(omega, SPEED, np.radians(angle_deg), KVLCC2))
    fine = 2.0 * np.trapezoid(force * energy, omega)
    got = SnnmTable.of(KVLCC2, shortest=8.0, longest=10.0)(SPEED, 2.0, 9.0, np.radians(angle_deg))
    assert got == pytest.approx(fine, rel=1e-3)


def test_entrance_length_gives_back_the_angle():
    length = entrance_length(58.0, entrance_angle_deg=30.0)
    assert np.degrees(np.arctan(0.495 * 58.0 / length)) == pytest.approx(30.0)


def test_trim_raises_the_motion_part_and_too_much_of_it_is_unknown():
    def motion(trim):
        hull = SnnmHull(320.0, 58.0, 20.8 - trim, 20.8, 0.8098, 60.0, 90.0)
        return snnm_transfer(frequency(0.8), SPEED, 0.0, hull)[0]

    assert motion(1.0) > motion(0.0)
    assert np.isnan(motion(15.0))


def test_validity():
    assert snnm_validity(SPEED, KVLCC2) == []
    (note,) = snnm_validity([SPEED, 3.0 * SPEED], KVLCC2)
    assert note.quantity == "Froude number"
