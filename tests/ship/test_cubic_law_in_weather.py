"""Ships of which one power at a speed is known: wind and waves act on the cubic law."""

import numpy as np
import pytest

from thalweg import InputError, Sea, Ship, evaluate
from thalweg.ship import Conditions
from thalweg.ship.methods.added_resistance.stawave import stawave1
from thalweg.ship.methods.propulsion.propulsion_factors import (
    Efficiencies,
)

KNOT = 1852.0 / 3600.0
FILE = {
    "name": "one point",
    "hull": {
        "draught_m": 9.0,
        "length_between_perpendiculars_m": 160.0,
        "breadth_m": 27.0,
        "frontal_area_m2": 500.0,
    },
    "speeds_kn": [8.0, 10.0, 12.0, 14.0],
    "engine": {"reference_speed_kn": 14.0, "reference_power_kw": 6000.0, "sfoc_g_per_kwh": 180.0},
    "models": {"calm_water": "cubic", "waves": "stawave_1", "wind": "ittc"},
}
CALM = {"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0}


def ship(**changes):
    return Ship.from_dict({**FILE, **changes})


def test_calm_water_power_and_fuel_follow_the_law():
    power, fuel = ship().power_and_fuel(Conditions(CALM), np.arange(4))
    expected = 6e6 * (np.array([8.0, 10.0, 12.0, 14.0]) / 14.0) ** 3
    assert power == pytest.approx(expected, rel=1e-9)
    assert fuel == pytest.approx(expected * 180.0 / 3.6e9, rel=1e-9)


def test_waves_take_power_by_the_efficiency():
    rough = Conditions({**CALM, "wave_height": 2.0})
    speed = 10.0 * KNOT
    more = float(ship().power(rough, 1)) - 6e6 * (10.0 / 14.0) ** 3
    bow = 0.15 * 160.0
    force = float(stawave1(2.0, 0.0, breadth=27.0, bow_length=bow))
    assert more == pytest.approx(force * speed / Efficiencies().total, rel=1e-6)


def test_the_engine_holds_the_speed_up_to_its_largest_power():
    heavy = Conditions({**CALM, "wind_speed": 20.0, "wave_height": 4.0})
    held = ship(engine={**FILE["engine"], "power_kw": 20000.0})
    assert held.speed_through_water(heavy, 3) == pytest.approx(14.0 * KNOT)
    weak = ship()  # no more than the 6,000 kW of the file
    assert float(weak.speed_through_water(heavy, 3)) < 13.0 * KNOT
    assert float(weak.power(heavy, 3)) == pytest.approx(6e6, rel=1e-3)


def test_the_assumption_is_a_note_of_every_result():
    route = evaluate([(0, 0), (0, 1)], ship=ship(), sea=Sea.calm(), depart=0)
    assert any("cubic law through 6000 kW at 14 kn" in text for text in route.assumptions)


def test_fuel_of_the_reference_point_is_burnt_in_proportion_to_power():
    engine = {"reference_speed_kn": 14.0, "reference_power_kw": 6000.0}
    burning = ship(engine=engine, fuel={"reference_t_per_day": 26.0})
    rough = Conditions({**CALM, "wave_height": 2.0})
    power, fuel = burning.power_and_fuel(rough, 0)
    assert fuel == pytest.approx(power / 6e6 * 26e3 / 86400.0, rel=1e-9)


def test_methods_that_need_the_parts_of_the_resistance_are_refused():
    models = {**FILE["models"], "shallow_water": "karpov"}
    with pytest.raises(InputError, match=r"models\.shallow_water with the cubic law"):
        ship(models=models)
    with pytest.raises(InputError, match="no power at a speed"):
        ship(engine={"reference_speed_kn": 14.0}, fuel={"reference_t_per_day": 26.0})
