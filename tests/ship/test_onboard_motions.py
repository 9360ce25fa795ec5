"""Motions and motion sickness at the places of a ship."""

import math

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship import Ship
from thalweg.ship.comfort.dose_table import (
    sampled_conditions,
    squared_dose_rates,
    squared_dose_table,
)
from thalweg.ship.comfort.onboard_motions import onboard_motions, required_motions
from thalweg.ship.conditions import Conditions


@pytest.fixture(scope="module")
def gunnerus():
    return Ship.load("gunnerus-2019")


def test_particulars_of_the_ship_of_prestegardshus(gunnerus):
    """Table 2.1: L_PP 33.9 m, B 9.6 m, T 2.8 m, C_B 0.62, displacement 574 t."""
    hull = onboard_motions(gunnerus).hull
    assert (hull.length, hull.breadth, hull.draught, hull.block_coefficient) == (
        33.9, 9.6, 2.8, 0.62,
    )  # fmt: skip
    volume = hull.length * hull.breadth * hull.draught * hull.block_coefficient
    assert 1.025 * volume == pytest.approx(574.0, rel=0.01)


@pytest.mark.parametrize(
    "height, period, angle, heave, acceleration, weighted, sick",
    [
        (1.0, 6.0, 0.0, 0.289, 0.259, 0.242, 9.7),
        (2.0, 8.0, 0.0, 0.950, 0.660, 0.637, 25.5),
        (3.0, 9.0, 0.0, 1.531, 0.947, 0.917, 36.7),
        (2.0, 8.0, math.pi / 2, 1.008, 0.501, 0.485, 19.4),
    ],
)
def test_check_values_at_midship(
    gunnerus, height, period, angle, heave, acceleration, weighted, sick
):
    """Recomputed for the thesis' ship at 4.83 m/s with strip decay; sick share after 4 h."""
    found = onboard_motions(gunnerus).at(
        4.83, wave_angle=angle, wave_height=height, wave_period=period
    )
    at = found.places["mess"]
    assert 2.0 * float(found.heave) == pytest.approx(heave, abs=6e-4)
    assert float(at.acceleration) == pytest.approx(acceleration, abs=6e-4)
    assert float(at.weighted) == pytest.approx(weighted, abs=6e-4)
    assert float(at.weighted) * math.sqrt(4 * 3600.0) / 3.0 == pytest.approx(sick, abs=0.06)


def test_motions_grow_away_from_midship_and_vanish_without_waves(gunnerus):
    motions = onboard_motions(gunnerus)
    found = motions.at(5.0, wave_angle=0.3, wave_height=[2.0, 0.0], wave_period=8.0)
    for name in ("displacement", "velocity", "acceleration", "weighted"):
        at = {place: getattr(row, name) for place, row in found.places.items()}
        assert at["bridge"][0] > at["laboratory"][0] > at["mess"][0] > 0.0
        assert all(values[1] == 0.0 for values in at.values())


def test_unknown_waves_give_unknown_motions(gunnerus):
    found = onboard_motions(gunnerus).at(5.0, wave_angle=0.3, wave_height=math.nan, wave_period=8.0)
    assert math.isnan(found.places["mess"].weighted)
    good, known = onboard_motions(gunnerus).workable("deck work", found)
    assert not good and not known


def test_a_limit_that_is_exceeded_decides(gunnerus):
    motions = onboard_motions(gunnerus)
    found = motions.at(5.0, wave_angle=0.0, wave_height=[0.3, 2.0, 6.0], wave_period=8.0)
    good, known = motions.workable("laboratory work", found)
    assert good.tolist() == [True, False, False] and known.all()
    assert motions.workable("deck work", found)[0].tolist() == [True, True, False]
    with pytest.raises(InputError, match="no task of the ship named 'crane'"):
        motions.workable("crane", found)


def test_a_ship_without_places_has_no_comfort():
    ship = Ship.load("handysize-bulker")
    assert onboard_motions(ship) is None
    with pytest.raises(InputError, match="no named places"):
        required_motions(ship)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"places": {"mast": 80.0}}, "off the ship"),
        ({"places": {"mast": 22.0}}, "off the ship"),  # of 33.9 m
        ({"tasks": {"crane": {"place": "deck", "max_pitch_deg": 2.0}}}, "place for the task"),
        ({"places": {}, "tasks": {"crane": {"place": "deck"}}}, "tasks but no places"),
    ],
)
def test_impossible_places_and_tasks_are_refused(gunnerus, change, words):
    ship = Ship.from_dict(gunnerus.data | change)
    with pytest.raises(InputError, match=words):
        onboard_motions(ship)


@pytest.mark.slow
def test_the_table_of_the_dose_is_near_the_motions(gunnerus):
    table = squared_dose_table(gunnerus)
    assert table.error.mean < 0.02
    where = {"wave_height": 2.0, "wave_angle": 0.4, "wave_period": 8.0}
    still = {"wind_speed": 0.0, "wind_angle": 0.0}
    for setting in range(len(gunnerus.speeds)):
        speed = gunnerus.speed_through_water(Conditions(**where, **still), setting)
        true = onboard_motions(gunnerus).at(float(speed), **where).places["mess"].weighted ** 2
        assert float(table.lookup(where, setting)) == pytest.approx(float(true), rel=0.05)
    assert float(table.lookup(where | {"wave_height": 0.0}, 0)) == 0.0
    heights = np.array([0.5, 1.0])
    low = table.lookup(where | {"wave_height": heights}, 0)
    assert low[1] / low[0] == pytest.approx(4.0, rel=0.1)  # nearly as the square of the height


@pytest.mark.slow
def test_the_table_of_squared_dose_is_near_direct_computation_at_random_conditions():
    ship = Ship.load("gunnerus-2019")
    table = squared_dose_table(ship)
    where = sampled_conditions(600, 3)
    truth = squared_dose_rates(ship, where)
    found = table.parts[0].lookup_all(where)
    known = np.isfinite(truth)  # waves too rough for a setting are refused by the table of speed
    assert 0.3 < known.mean() < 0.9 and np.isfinite(found).all()
    away = np.abs(np.sqrt(found) - np.sqrt(truth))[known]
    assert away.max() < 0.05 and np.quantile(away, 0.9) < 0.02  # weighted acceleration [m/s2]
    assert table.error.max < 0.12
