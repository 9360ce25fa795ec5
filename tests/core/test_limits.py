import itertools
import math

import pytest

from thalweg.core.errors import InputError
from thalweg.core.limits import (
    NETWORK_STEPS,
    TIGHTENING,
    Limits,
    Tightening,
)
from thalweg.kernels import codes

LIMITS = Limits(required_depth=12.0, wave_height=4.0, wind_speed=20.0)


def test_array_is_in_the_order_of_the_kernel_codes():
    array = LIMITS.array
    assert array.shape == (codes.LIMIT_COUNT,)
    assert array[codes.LIMIT_REQUIRED_DEPTH] == LIMITS.required_depth
    assert array[codes.LIMIT_WAVE_HEIGHT] == LIMITS.wave_height
    assert array[codes.LIMIT_WIND_SPEED] == LIMITS.wind_speed


def test_without_arguments_there_are_no_limits():
    assert Limits().array.tolist() == [-math.inf, math.inf, math.inf]
    assert not Limits().depth_checked
    assert LIMITS.depth_checked


@pytest.mark.parametrize("name", ["required_depth", "wave_height", "wind_speed"])
def test_nan_is_refused_with_its_name(name):
    with pytest.raises(InputError, match=name):
        Limits(**{name: math.nan})


def test_tightening_adds_depth_and_takes_shares_off():
    tight = LIMITS.tightened(Tightening(depth=0.5, share=0.25))
    assert tight == Limits(12.5, 3.0, 15.0)


def test_the_schedule_begins_with_the_limits_and_becomes_stricter():
    steps = [LIMITS.tightened(step) for step in TIGHTENING]
    assert steps[0] == LIMITS
    assert (NETWORK_STEPS[0], NETWORK_STEPS[-1]) == (0, len(TIGHTENING) - 1)
    for looser, stricter in itertools.pairwise(steps):
        assert stricter.required_depth > looser.required_depth
        assert stricter.wave_height < looser.wave_height
        assert stricter.wind_speed < looser.wind_speed


def test_what_is_not_limited_stays_so():
    assert all(Limits().tightened(step) == Limits() for step in TIGHTENING)
    assert Limits().relaxed(0.1) == Limits()


def test_relaxed_limits_are_looser_for_any_sign_of_depth():
    assert LIMITS.relaxed(0.5) == Limits(6.0, 6.0, 30.0)
    assert Limits(required_depth=-2.0).relaxed(0.5).required_depth == -3.0
