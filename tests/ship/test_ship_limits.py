"""Limits of waves and wind: unknown weather keeps none."""

from __future__ import annotations

import numpy as np

from thalweg.ship import ShipLimits
from thalweg.ship.condition_variables import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT

WEATHER = {
    WAVE_HEIGHT: np.array([1.0, 2.0, 2.1, np.nan, 1.0, 1.0]),
    EASTWARD_WIND: np.array([3.0, 3.0, 3.0, 3.0, 6.0, np.nan]),
    NORTHWARD_WIND: np.array([4.0, 4.0, 4.0, 4.0, 0.0, 4.0]),
}


def test_waves_and_wind_at_the_limit_keep_it_and_unknown_ones_do_not():
    both = ShipLimits(wave_height=2.0, wind_speed=5.0)
    assert both.limited_weather == tuple(sorted(WEATHER)) and both.needs == set(WEATHER)
    assert both.keeps_weather_limits(WEATHER).tolist() == [True, True, False, False, False, False]
    waves = ShipLimits(wave_height=2.0)
    assert waves.limited_weather == (WAVE_HEIGHT,)
    assert waves.keeps_weather_limits(WEATHER).tolist() == [True, True, False, False, True, True]


def test_a_ship_without_limits_keeps_them_in_any_weather():
    assert ShipLimits().limited_weather == ()
    assert ShipLimits().keeps_weather_limits({}).all()
