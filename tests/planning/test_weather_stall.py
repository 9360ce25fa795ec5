"""Refusals name the speed loss in wind and waves where it, not a current, holds the ship."""

from __future__ import annotations

import pytest

from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
from thalweg.planning import Voyage, plan
from thalweg.sea import Sea
from thalweg.ship import Ship

DEPART = 1.7e9
SHIP = {
    "name": "feeder",
    "speeds_kn": [10, 17],
    "hull": {
        "length_between_perpendiculars_m": 140.0, "breadth_m": 22.0, "draught_m": 6.0,
        "block_coefficient": 0.62, "displacement_m3": 11458.0,
    },
    "models": {"speed_loss": "kwon_2008"},
}  # fmt: skip


def _sea(wind: float, current: float) -> Sea:
    values = {
        "eastward_wind": -wind, "northward_wind": 0.0,
        "eastward_sea_water_velocity": -current, "northward_sea_water_velocity": 0.0,
    }  # fmt: skip
    functions = {name: (lambda t, lat, lon, v=value: v) for name, value in values.items()}
    return Sea.from_functions(functions, time_step=3600.0)


def _refusal(wind: float, current: float) -> NoRouteError:
    voyage = Voyage(start=(43.0, -18.0), goal=(43.0, -17.0), depart=DEPART, offing_nm=0.0)
    with pytest.raises(NoRouteError) as caught:
        plan(
            voyage, ship=Ship.from_dict(SHIP), sea=_sea(wind, current), chart=Chart.open_water(),
            network="lattice", resolution=8000.0, proof=0.0,
        )  # fmt: skip
    return caught.value


def test_a_storm_from_ahead_is_named_as_the_cause():
    error = _refusal(wind=24.0, current=1.0)
    text = str(error)
    assert "the ship makes 0.2 kn of 17.0 kn through the water, in wind of 47 kn" in text
    assert "Her speed loss in wind and waves is the cause." in text
    assert "limits.max_wind_speed_kn" in text and "models.speed_loss" in text
    assert "current too strong for the speed that the weather leaves" in error.reasons
    assert "current too strong to hold the course" not in error.reasons
    assert "--fill" not in text


def test_a_current_that_is_too_strong_in_light_wind_is_named_as_before():
    error = _refusal(wind=2.0, current=11.0)
    assert "The current is faster than the ship" in str(error)
    assert "current too strong to hold the course" in error.reasons
    assert "speed loss" not in str(error)
