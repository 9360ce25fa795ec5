"""Quasi-static seas: the value of the nearest update, for points, stations and kernels."""

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.sea import Sea

START = parse_time("2026-03-01T00:00Z")
HOUR = 3600.0
HEIGHT = "sea_surface_wave_significant_height"


def _sea(period=None):
    """Waves whose height is the hours since the start."""
    functions = {
        HEIGHT: lambda time, lat, lon: np.maximum(time - START, 0.0) / HOUR + 0.0 * lat,
        "sea_surface_wave_to_direction": lambda time, lat, lon: 0.0 * lat,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": lambda t, y, x: 8.0 + 0 * y,
    }
    return Sea.from_functions(functions, period=period, time_step=HOUR)


def _heights(sea, hours):
    hours = np.asarray(hours, float)
    there = np.zeros(hours.shape)
    return sea.sample([HEIGHT], START + hours * HOUR, there, there)[HEIGHT]


def test_values_are_those_of_the_nearest_update():
    held = _sea().quasi_static(8.0)
    assert _heights(held, [0, 3.9, 4.0, 4.1, 11.9, 12.1]).tolist() == [0, 0, 0, 8, 8, 16]
    assert "every 8 h" in held.assumptions[-1]
    shifted = _sea().quasi_static(8.0, start="2026-03-01T02:00Z")
    assert _heights(shifted, [1.0, 5.9, 6.1]).tolist() == [2, 2, 10]


def test_kernels_see_steps_in_place_of_slopes():
    held = _sea().quasi_static(8.0)
    times = held.times(START, START + 24 * HOUR)
    assert np.all(np.diff(times) > 0.0)
    values = held.series([HEIGHT], times, np.zeros(1), np.zeros(1))[HEIGHT][0]
    for hour, expected in ((2.0, 0.0), (6.0, 8.0), (11.0, 8.0), (13.0, 16.0), (23.0, 24.0)):
        assert np.interp(START + hour * HOUR, times, values) == pytest.approx(expected, abs=1e-9)


def test_beyond_the_updates_in_the_data_values_are_unknown():
    held = _sea(("2026-03-01T03:00Z", "2026-03-01T20:00Z")).quasi_static(8.0)
    known = np.isfinite(_heights(held, [3.0, 3.9, 4.1, 19.9, 20.1]))
    assert known.tolist() == [False, False, True, True, False]
    first, last = held.layers[0].period
    assert (first - START, last - START) == pytest.approx((4 * HOUR, 20 * HOUR - 1.0))


def test_the_error_falls_with_the_step():
    hours = np.linspace(0.0, 48.0, 97)
    errors = [
        np.max(np.abs(_heights(_sea().quasi_static(step), hours) - hours)) for step in (12, 8, 4, 2)
    ]
    assert errors == pytest.approx([6.0, 4.0, 2.0, 1.0])


def test_members_of_an_ensemble_are_held_each():
    sea = Sea.ensemble(_sea(), _sea()).quasi_static(8.0)
    assert sea.members == 2
    assert _heights(sea.member(1), [4.1]).tolist() == [8.0]


def test_names_of_samplings():
    sea = _sea()
    assert sea.sampled("linear") is sea
    assert _heights(sea.sampled("nearest:12"), [6.1]).tolist() == [12.0]
    for wrong in ("nearest", "nearest:x", "nearest:0.001", "cubic", "linear:3"):
        with pytest.raises(InputError, match=r"nearest|Updates"):
            sea.sampled(wrong)
    assert sea.fingerprint() != sea.sampled("nearest:12").fingerprint()
