"""Motion sickness: W_f factors, doses and shares of people."""

from __future__ import annotations

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


def test_never_more_than_everyone():
    assert motion_sickness.motion_sickness_percent_iso(1e4) == 100.0


def test_weighted_acceleration_of_one_sinusoid():
    """All energy at 0.16 Hz: the factor is 1.006."""
    got = motion_sickness.weighted_acceleration([0.25], [2.0 * np.pi * 0.16])
    assert got == pytest.approx(0.5 * 1.006, abs=3e-4)
