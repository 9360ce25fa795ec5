"""Refusals name the speed loss in wind and waves where it, not a current, holds the ship."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.errors import NoRouteError
from thalweg.planning import Voyage, plan
from thalweg.route import evaluate
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
    assert "the speed loss leaves less than half of 17.0 kn, in wind of 47 kn" in text
    assert "Her speed loss in wind and waves is the cause." in text
    assert "limits.max_wind_speed_kn" in text and "models.speed_loss" in text
    assert "weather in which the ship's speed is not known" in error.reasons
    assert "current too strong to hold the course" not in error.reasons
    assert "--fill" not in text


def test_a_current_that_is_too_strong_in_light_wind_is_named_as_before():
    error = _refusal(wind=2.0, current=11.0)
    assert "The current is faster than the ship" in str(error)
    assert "current too strong to hold the course" in error.reasons
    assert "speed loss" not in str(error)


def _gale_until(end: float, wind: float = 24.0) -> Sea:
    """Wind from the east, which falls to 2 m/s in the hour before ``end``."""
    speeds = {
        "eastward_wind": lambda t, lat, lon: -np.interp(t, [end - 3600.0, end], [wind, 2.0]),
        "northward_wind": lambda t, lat, lon: 0.0 * t,
    }
    return Sea.from_functions(speeds, time_step=1800.0)


@pytest.mark.slow
def test_a_ship_waits_for_the_end_of_a_gale_that_her_speed_loss_cannot_predict():
    end = DEPART + 15 * 3600.0
    ship = Ship.from_dict(SHIP)
    voyage = Voyage(
        start=(43.0, -18.0), goal=(43.0, -17.0), depart=DEPART, offing_nm=0.0, objective="time"
    )
    found = plan(
        voyage, ship=ship, sea=_gale_until(end), chart=Chart.open_water(), network="lattice",
        resolution=8000.0, proof=0.0,
    ).best  # fmt: skip
    assert found.feasible
    sailing = found.distance_nm / 17.0
    # she may leave when the wind has fallen to some 13 m/s, half an hour before its end
    assert 14.2 + sailing < found.time_h < 15.2 + sailing
    assert 14.2 < found.waiting_h < 15.0


def test_a_route_in_such_a_gale_breaks_a_limit():
    ship, sea = Ship.from_dict(SHIP), _gale_until(DEPART + 15 * 3600.0)
    straight = [(43.0, -18.0), (43.0, -17.0)]
    at_once = evaluate(straight, ship=ship, sea=sea, depart=DEPART, speed_kn=17.0)
    assert not at_once.feasible
    (breach,) = (v for v in at_once.violations if v.reason.startswith("weather beyond"))
    assert 0.01 <= breach.value < 0.05 and breach.limit == 0.5
    assert "% of the speed left, limit 50.00 % of the speed left)" in str(breach)
    later = evaluate(straight, ship=ship, sea=sea, depart=DEPART + 15 * 3600.0, speed_kn=17.0)
    assert later.feasible


def test_the_same_gale_from_astern_breaks_no_limit():
    """Kwon's loss from astern is a fifth of that from ahead; in Beaufort 7 it leaves over half."""
    ship, sea = Ship.from_dict(SHIP), _gale_until(DEPART + 90 * 3600.0, wind=14.5)
    west = evaluate(
        [(43.0, -17.0), (43.0, -18.0)], ship=ship, sea=sea, depart=DEPART, speed_kn=17.0
    )
    east = evaluate(
        [(43.0, -18.0), (43.0, -17.0)], ship=ship, sea=sea, depart=DEPART, speed_kn=17.0
    )
    assert west.feasible and not east.feasible
