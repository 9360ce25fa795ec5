"""Motion sickness: W_f factors, doses and incidences."""

from __future__ import annotations

import math

import numpy as np
import pytest

from thalweg.ship.methods.seakeeping import motion_sickness

WF = {  # one-third octaves [Hz] -> factor x 1000 of ISO 2631-1, Table 3
    0.02: 24.2, 0.025: 37.7, 0.0315: 59.7, 0.04: 97.1, 0.05: 157.0, 0.063: 267.0, 0.08: 461.0,
    0.1: 695.0, 0.125: 895.0, 0.16: 1006.0, 0.2: 992.0, 0.25: 854.0, 0.315: 619.0, 0.4: 384.0,
    0.5: 224.0, 0.63: 116.0, 0.8: 53.0, 1.0: 23.5,
}  # fmt: skip


@pytest.mark.parametrize(("frequency", "printed"), WF.items())
def test_wf_to_printed_digits(frequency, printed):
    tolerance = 0.051 if printed < 100.0 else 0.51
    assert 1000.0 * motion_sickness.wf_weighting(frequency) == pytest.approx(printed, abs=tolerance)


def test_wf_limits():
    assert motion_sickness.wf_weighting(0.0) == 0.0
    assert motion_sickness.wf_weighting(50.0) < 1e-3
    assert np.isnan(motion_sickness.wf_weighting(np.nan))


def test_dose_of_two_hours():
    """0.5 m/s2 for two hours: 42.43 m/s^1.5, 14.1 % of people."""
    dose = motion_sickness.motion_sickness_dose(0.5, duration=7200.0)
    assert dose == pytest.approx(42.43, abs=5e-3)
    assert motion_sickness.motion_sickness_percent_iso(dose) == pytest.approx(14.1, abs=0.05)
    parts = motion_sickness.combined_dose([0.5, 0.5, 0.0], durations=[3600.0, 3600.0, 9000.0])
    assert parts == pytest.approx(dose)


def test_never_more_than_everyone():
    assert motion_sickness.motion_sickness_percent_iso(1e4) == 100.0


@pytest.mark.parametrize(
    ("a", "f", "minutes", "percent"),
    [(0.1, 0.17, 120, 31.94), (0.05, 0.17, 120, 10.26), (0.1, 0.25, 120, 23.07),
     (0.1, 0.17, 30, 15.14)],
)  # fmt: skip
def test_mccauley(a, f, minutes, percent):
    got = motion_sickness.motion_sickness_percent_mccauley(
        a * 9.81, frequency_hz=f, duration=60.0 * minutes, gravity=9.81
    )
    assert got == pytest.approx(percent, abs=5.1e-3)


def test_ohanlon():
    got = motion_sickness.motion_sickness_percent_ohanlon(
        0.981, encounter_frequency=2.0 * np.pi * 0.17, gravity=9.81
    )
    assert got == pytest.approx(24.1, abs=0.05)
    middle = -0.819 + 2.32 * np.log10(2.5) ** 2
    level = (np.log10(np.sqrt(2.0 / np.pi) * 0.2) - middle) / 0.4
    fast = motion_sickness.motion_sickness_percent_ohanlon(
        0.2 * 9.81, encounter_frequency=2.5, gravity=9.81
    )
    assert fast == pytest.approx(50.0 * (1.0 + math.erf(level / math.sqrt(2.0))), rel=1e-9)


def test_no_motion_gives_no_sickness_and_unknown_stays_unknown():
    sick = motion_sickness.motion_sickness_percent_mccauley(
        [0.0, np.nan], frequency_hz=0.2, duration=3600.0
    )
    assert sick[0] == 0.0
    assert np.isnan(sick[1])
    still = motion_sickness.motion_sickness_percent_mccauley(
        1.0, frequency_hz=[0.0, np.nan], duration=3600.0
    )
    np.testing.assert_array_equal(still, [0.0, np.nan])
    sick = motion_sickness.motion_sickness_percent_ohanlon([0.0, np.nan], encounter_frequency=1.0)
    assert sick[0] == 0.0
    assert np.isnan(sick[1])


def test_weighted_acceleration_of_one_sinusoid():
    """All energy at 0.16 Hz: the factor is 1.006."""
    got = motion_sickness.weighted_acceleration([0.25], [2.0 * np.pi * 0.16])
    assert got == pytest.approx(0.5 * 1.006, abs=3e-4)


def test_people_are_sickest_near_one_radian_per_second():
    w = np.linspace(0.3, 4.0, 371)
    sick = motion_sickness.motion_sickness_percent_ohanlon(0.5, encounter_frequency=w)
    assert w[np.argmax(sick)] == pytest.approx(1.0, abs=0.02)
