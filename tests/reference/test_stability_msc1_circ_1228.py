"""Warnings of IMO MSC.1/Circ.1228."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.units import KNOT
from thalweg.ship.methods.seakeeping import stability_msc1_circ1228 as checks


def check(**changes):
    given = {
        "speed": 10.0 * KNOT,
        "wave_angle": np.pi,
        "wave_height": 2.0,
        "wave_period": 8.0,
        "length": 150.0,
    }
    return checks.dangerous_situations(**{**given, **changes})


@pytest.mark.parametrize(("angle", "period"), [(0.0, 6.667), (180.0, 20.0), (150.0, 17.64)])
def test_encounter_period(angle, period):
    """T_W 10 s, 15 kn."""
    got = checks.encounter_period(10.0, speed=15.0 * KNOT, wave_angle=np.radians(angle))
    assert got == pytest.approx(period, abs=6e-3)


def test_exact_deep_water_is_near():
    """19.77 s where the circular's rounded constant gives 20.0."""
    exact = 10.0 / abs(1.0 - 15.0 * KNOT * 2.0 * np.pi / (9.81 * 10.0))
    assert exact == pytest.approx(19.77, abs=0.02)


@pytest.mark.parametrize(("length", "knots"), [(100, 18.0), (150, 22.05), (200, 25.46)])
def test_surf_riding_speed(length, knots):
    got = checks.surf_riding_speed(np.pi, length=length)
    assert got / KNOT == pytest.approx(knots, abs=6e-3)


def test_surf_riding_zone():
    speeds = np.array([20.0, 22.1, 23.0]) * KNOT
    got = check(speed=speeds)
    assert got.surf_riding.tolist() == [False, True, True]
    assert got.marginal_surging.tolist() == [True, False, False]
    assert got.margins.surf_riding / KNOT == pytest.approx(22.0454 - speeds / KNOT, abs=1e-4)
    assert not check(speed=40.0 * KNOT, wave_angle=np.radians(130.0)).surf_riding
    assert check(speed=40.0 * KNOT, wave_angle=np.radians(-140.0)).surf_riding


def test_oblique_following_seas_allow_more_speed():
    straight = checks.surf_riding_speed(np.pi, length=100.0)
    oblique = checks.surf_riding_speed(np.radians(150.0), length=100.0)
    assert oblique / straight == pytest.approx(1.0 / np.cos(np.radians(30.0)))


def test_successive_high_waves():
    """L 100: length above 80 m (T > 7.16 s), height above 4 m, T_E 1.8 to 3 T_W."""
    base = {"length": 100.0, "wave_height": 5.0, "wave_period": 8.0}
    ratio_two = check(speed=12.0 * KNOT, **base)  # T_E = 192 / 12 = 16 s
    assert ratio_two.encounter_period == pytest.approx(16.0)
    assert ratio_two.successive_high_waves
    assert ratio_two.margins.high_waves < 0.0
    assert not check(speed=12.0 * KNOT, **{**base, "wave_height": 3.9}).successive_high_waves
    assert not check(speed=12.0 * KNOT, **{**base, "wave_period": 7.0}).successive_high_waves
    assert not check(speed=5.0 * KNOT, **base).successive_high_waves
    assert not check(speed=17.0 * KNOT, **base).successive_high_waves


def test_margins_written_out():
    """At the limits of the circular the margins are zero, and they are the stated distances."""
    at = {"length": 100.0, "wave_period": 8.0, "wave_height": 5.0}
    got = check(speed=12.0 * KNOT, **at)  # T_E = 2 T_W: 0.2 inside 1.8, wave length 99.84 m
    assert got.margins.high_waves == pytest.approx(max(1 - 99.84 / 80.0, 1 - 5.0 / 4.0, -0.2))
    lower = check(speed=12.0 * KNOT, **{**at, "wave_height": 4.4})
    assert lower.margins.high_waves == pytest.approx(-0.1)
    shorter = check(speed=12.0 * KNOT, **{**at, "length": 115.0})
    assert shorter.margins.high_waves == pytest.approx(1.0 - 99.84 / 92.0)
    slow, fast = 3.0 * 8.0 * (1.0 - 1.0 / np.array([1.8, 3.0]))  # knots where T_E / T_W is that
    edges = check(speed=np.array([slow, fast]) * KNOT, **at)
    assert edges.margins.high_waves == pytest.approx([0.0, 0.0], abs=1e-9)
    roll = check(wave_angle=np.pi / 2, wave_period=[16.8, 8.4, 8.0], roll_period=16.0)
    assert roll.margins.synchronous_roll == pytest.approx([-0.05, 0.375, 0.4])
    assert roll.margins.parametric_roll == pytest.approx([-0.05, -0.05, -0.1])


def test_the_sector_is_45_degrees_to_each_side_and_surging_begins_at_1_4():
    edge = checks.surf_riding_speed(np.radians([134.9, 135.1, 224.9, 225.1]), length=100.0)
    assert np.isfinite(edge).tolist() == [False, True, True, False]
    surge = check(speed=np.array([13.9, 14.1]) * KNOT, length=100.0)
    assert surge.marginal_surging.tolist() == [False, True]


def test_roll_period_of_the_is_code():
    got = checks.roll_period(32.0, 11.0, length_waterline=200.0, metacentric_height=1.5)
    assert got == pytest.approx(18.49, abs=5.1e-3)
    assert np.isnan(checks.roll_period(32.0, 11.0, length_waterline=200.0, metacentric_height=-0.1))


def test_synchronous_and_parametric_roll():
    """Beam seas: T_E = T_W. At T_R 16 s waves of 16 s are synchronous, of 8 s parametric."""
    got = check(wave_angle=np.pi / 2, wave_period=[16.0, 8.0, 12.0], roll_period=16.0)
    assert got.synchronous_roll.tolist() == [True, False, False]
    assert got.parametric_roll.tolist() == [True, True, False]
    assert got.margins.parametric_roll[2] == pytest.approx(0.25 - 0.1)


def test_without_roll_period_no_roll_check():
    got = check(wave_angle=np.pi / 2, wave_period=16.0)
    assert not got.synchronous_roll
    assert np.isnan(got.margins.synchronous_roll)
    assert got.known


def test_flat_sea_is_safe_and_unknown_sea_is_not():
    flat = check(speed=40.0 * KNOT, wave_height=0.0, wave_period=np.nan, roll_period=8.0)
    assert flat.safe
    assert flat.margins.surf_riding == np.inf
    assert check(wave_height=0.0, wave_period=np.nan, wave_angle=np.nan).safe
    assert not check(wave_height=-1.0).safe
    for name in ("speed", "wave_angle", "wave_height", "wave_period", "length"):
        unknown = check(**{name: np.nan})
        assert not unknown.safe, name
        assert not unknown.known, name
        assert np.isnan(unknown.margins.surf_riding), name


def test_keeping_pace_with_the_waves():
    got = checks.encounter_period(5.0, speed=15.0 * KNOT, wave_angle=np.pi)
    assert got == np.inf or got > 1e12


def test_least_height():
    assert check(speed=30.0 * KNOT).surf_riding
    assert not check(speed=30.0 * KNOT, harmless_wave_height=2.5).surf_riding
