"""Least fuel at one speed: the route of least time where the rate of fuel is constant."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan

SEA = Sea.from_functions(
    {
        "eastward_sea_water_velocity": lambda t, y, x: 1.5 * np.cos(4.0 * y) + 0.0 * x,
        "northward_sea_water_velocity": lambda t, y, x: 0.6 * np.sin(3.0 * x) + 0.0 * y,
    },
    time_step=0.0,
)
SHIP = Ship.from_dict(
    {
        "name": "of one power",
        "hull": {"draught_m": 5.0},
        "speeds_kn": [8.0, 10.0],
        "engine": {
            "reference_speed_kn": 10.0,
            "reference_power_kw": 2000.0,
            "sfoc_g_per_kwh": 180.0,
        },
        "models": {"calm_water": "cubic"},
    }
)


def planned(objective):
    voyage = Voyage(
        start=(0.0, 0.0),
        goal=(0.0, 0.5),
        depart=0,
        speed_kn=10.0,
        objective=objective,
        offing_nm=0.0,
    )
    chart = Chart.open_water(-0.3, 0.3, -0.2, 0.7)
    return plan(voyage, ship=SHIP, sea=SEA, chart=chart, resolution=5000.0, proof=0.0)


@pytest.mark.slow
def test_least_fuel_is_least_time_at_a_constant_rate():
    fastest, thriftiest = planned("time").best, planned("fuel").best
    assert thriftiest.time_h == pytest.approx(fastest.time_h, rel=2e-5)
    assert thriftiest.fuel_t / thriftiest.time_h == pytest.approx(
        fastest.fuel_t / fastest.time_h, rel=1e-9
    )
