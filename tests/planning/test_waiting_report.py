"""How long a ship waits at sea in weather above her limits."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.planning.report.waiting_report import heavy_weather_warnings, hours_above_limits
from thalweg.sea.standard_names import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT


def waiting_route():
    """Four hours at the berth, ten at the third waypoint; waves 3 m from half of the latter on."""
    berth, sea = np.linspace(0.0, 14400.0, 5), 36000.0 + np.linspace(0.0, 36000.0, 11)
    leg = np.repeat([0, 2], [5, 11])
    waves = np.where(np.arange(16) < 10, 1.0, 3.0)
    waves[:5] = 9.0
    wind = np.where(np.arange(16) < 8, 25.0, 5.0)
    return SimpleNamespace(
        track=SimpleNamespace(lat=np.zeros(4), lon=np.arange(4.0)),
        wait_samples={
            "leg": leg,
            "time": np.concatenate([berth, sea]),
            WAVE_HEIGHT: waves,
            EASTWARD_WIND: wind,
            NORTHWARD_WIND: np.zeros(16),
        },
    )


@pytest.mark.parametrize(
    ("waves", "wind", "hours"),
    [
        (2.0, np.inf, 10.0 * 6 / 11),  # the berth does not count
        (4.0, np.inf, 0.0),
        (np.inf, np.inf, 0.0),
        (np.inf, 20.0, 10.0 * 3 / 11),
        (2.0, 20.0, 10.0 * 9 / 11),
    ],
)
def test_hours_above_limits(waves, wind, hours):
    ship = SimpleNamespace(limits=SimpleNamespace(wave_height=waves, wind_speed=wind))
    assert hours_above_limits(waiting_route(), ship) == pytest.approx(hours)


def test_a_wait_in_a_gale_that_the_limits_permit_is_stated():
    route = waiting_route()
    free = SimpleNamespace(limits=SimpleNamespace(wave_height=np.inf, wind_speed=np.inf))
    (note,) = heavy_weather_warnings(route, free)  # 25 m/s of wind; the 9 m are at the berth
    assert note.startswith("Waits at sea 10.0 h at 0.0000N 2.0000E in waves of up to 3.0 m")
    assert "wind of up to 49 kn" in note and "burns fuel, which is not counted" in note
    limited = SimpleNamespace(limits=SimpleNamespace(wave_height=10.0, wind_speed=26.0))
    assert heavy_weather_warnings(route, limited) == [note]
    strict = SimpleNamespace(limits=SimpleNamespace(wave_height=2.0, wind_speed=np.inf))
    assert heavy_weather_warnings(route, strict) == []  # it has the warning of a broken limit
    route.wait_samples[EASTWARD_WIND] = np.full(16, 17.0)  # 33 kn, Beaufort 7
    assert heavy_weather_warnings(route, free) == []
    route.wait_samples[WAVE_HEIGHT] = np.full(16, 4.1)
    assert len(heavy_weather_warnings(route, free)) == 1
