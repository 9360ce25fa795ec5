"""Waves that the known wind raises."""

import numpy as np
import pytest

from thalweg import InputError, Sea
from thalweg.kernels import codes
from thalweg.sea import standard_names as nm
from thalweg.sea.models.wind_sea import carter_1982

WIND = {
    "eastward_wind": lambda t, lat, lon: np.where(lat > 50.0, np.nan, 12.0) + 0.0 * t,
    "northward_wind": lambda t, lat, lon: 5.0 + 0.0 * t + 0.0 * lat,
}
WAVES = [nm.WAVE_HEIGHT, nm.WAVE_PERIOD, nm.WAVE_TO_EAST, nm.WAVE_TO_NORTH]


def test_the_three_limits_of_growth():
    # far and long: fully grown; short fetch; short time
    height, period = carter_1982(10.0, fetch=1e7, duration=1e6)
    assert (height, period) == pytest.approx((2.48, 7.29))
    height, period = carter_1982(20.0, fetch=100_000.0, duration=1e6)
    assert (height, period) == pytest.approx((0.0163 * 10 * 20, 0.566 * 100**0.3 * 20**0.4))
    height, period = carter_1982(20.0, fetch=1e7, duration=6 * 3600.0)
    assert height == pytest.approx(0.0146 * 6 ** (5 / 7) * 20 ** (9 / 7))
    assert period == pytest.approx(0.540 * 6 ** (3 / 7) * 20 ** (4 / 7))


def test_more_wind_raises_higher_waves_and_none_raises_none():
    height, _ = carter_1982(np.linspace(0.0, 40.0, 41))
    assert height[0] == 0.0 and np.all(np.diff(height) > 0.0)


def test_waves_travel_with_the_wind_and_are_unknown_where_it_is():
    sea = Sea.from_functions(WIND).filled(waves="wind")
    got = sea.sample(WAVES, 0.0, np.array([45.0, 55.0]), np.array([0.0, 0.0]))
    height, period = carter_1982(13.0)
    assert got[nm.WAVE_HEIGHT][0] == pytest.approx(float(height))
    assert got[nm.WAVE_PERIOD][0] == pytest.approx(float(period))
    assert got[nm.WAVE_TO_EAST][0] == pytest.approx(12.0 / 13.0)
    assert got[nm.WAVE_TO_NORTH][0] == pytest.approx(5.0 / 13.0)
    assert all(np.isnan(values[1]) for values in got.values())
    assert any("Carter 1982" in text for text in sea.assumptions)


def test_known_waves_have_priority_and_frozen_values_agree():
    known = {"sea_surface_wave_significant_height": lambda t, lat, lon: 9.0 + 0.0 * t + 0.0 * lat}
    sea = Sea.from_functions({**WIND, **known}).filled(waves="wind")
    assert sea.sample(WAVES[:1], 0.0, 45.0, 0.0)[nm.WAVE_HEIGHT] == pytest.approx(9.0)
    bare = Sea.from_functions(WIND).filled(waves="wind")
    series = bare.sample(WAVES, np.array([0.0, 3600.0]), 45.0, 0.0)
    assert series[nm.WAVE_HEIGHT] == pytest.approx(float(carter_1982(13.0)[0]))
    rows = {row.variable for row in bare.coverage()}
    assert nm.WAVE_HEIGHT in rows


def test_no_wind_no_waves():
    with pytest.raises(InputError, match="holds no wind"):
        Sea.from_functions({"sea_floor_depth_below_geoid": lambda t, y, x: 5.0}).filled(
            waves="wind"
        )
    with pytest.raises(InputError, match="fetch"):
        carter_1982(10.0, fetch=0.0)


def test_waves_alone_are_frozen_at_the_times_of_the_wind():
    """Waves alone can be frozen, and gaps have the reasons of the wind."""
    sea = Sea.from_functions(WIND, area=(40.0, 60.0, -10.0, 10.0), period=(0.0, 86400.0))
    sea = sea.filled(waves="wind")
    frozen = sea.freeze_stations([45.0], [0.0], 0.0, 3600.0, [codes.WAVE_HEIGHT_CHANNEL])
    assert frozen.times[[0, -1]].tolist() == [0.0, 3600.0]
    assert frozen.values[0, :, 0] == pytest.approx(float(carter_1982(13.0)[0]))
    assert sea.period_of([nm.WAVE_HEIGHT]) == (0.0, 86400.0)
    assert sea.why_missing(nm.WAVE_HEIGHT, 90000.0, 45.0, 0.0) == "period"
    assert sea.why_missing(nm.WAVE_HEIGHT, 0.0, 10.0, 0.0) == "area"
    assert sea.why_missing(nm.WAVE_HEIGHT, 0.0, 55.0, 0.0) == "gap"
    still = Sea.from_functions(WIND, time_step=0.0).filled(waves="wind")
    assert still.period_of([nm.WAVE_HEIGHT]) == (-np.inf, np.inf)
