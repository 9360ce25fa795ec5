"""The speed rule of Prestegardshus (2020), eqs. 3.47 and 3.48, and its fault."""

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship
from thalweg.ship.methods.speed_loss import prestegardshus_speed_factor

RULE = {
    "speed_loss": "prestegardshus_2020",
    "largest_wave_height_m": 5.0,
    "largest_wind_speed_m_s": 20.0,
}


@pytest.mark.parametrize(
    "angle, share, factor", [(np.pi, 0, 0.6), (0, 0, 1.0), (0, 1, 0.6), (np.pi, 1, 0.2)]
)
def test_values_of_the_rule(angle, share, factor):
    assert prestegardshus_speed_factor(angle, share) == pytest.approx(factor, abs=1e-12)


def test_the_variant_takes_nothing_in_a_calm():
    angle = np.linspace(0.0, np.pi, 7)
    assert prestegardshus_speed_factor(angle, 0.0, consistent=True) == pytest.approx(1.0)
    assert prestegardshus_speed_factor(np.pi, 1.0, consistent=True) == pytest.approx(0.2)
    assert np.isnan(prestegardshus_speed_factor(0.0, 1.1))


def _ship(**models):
    return Ship.from_dict(
        {"name": "thesis", "hull": {"draught_m": 2.8}, "speeds_kn": 10.0, "models": RULE | models}
    )


def _conditions(**changes):
    given = {"wave_height": 0.0, "wave_angle": 0.0, "wind_speed": 0.0, "wind_angle": 0.0}
    return Conditions(**(given | changes))


def test_a_ship_that_heads_into_a_flat_calm_makes_3_6_knots():
    speed = _ship().speed_through_water(_conditions()) / KNOT
    assert speed == pytest.approx(3.6, abs=1e-9)
    consistent = _ship(nothing_lost_in_calm=True).speed_through_water(_conditions()) / KNOT
    assert consistent == pytest.approx(10.0, abs=1e-9)
    worst = _conditions(wave_height=5.0, wind_speed=20.0)
    assert _ship().speed_through_water(worst) / KNOT == pytest.approx(0.4, abs=1e-9)


def test_the_table_of_the_rule_is_exact():
    ship, draw = _ship(), np.random.default_rng(3)
    where = {
        "wave_height": draw.uniform(0.0, 5.0, 200), "wave_angle": draw.uniform(0.0, np.pi, 200),
        "wind_speed": draw.uniform(0.0, 20.0, 200), "wind_angle": draw.uniform(0.0, np.pi, 200),
    }  # fmt: skip
    exact = ship.speed_through_water(Conditions(**where))
    assert ship.tabulate().lookup(where, 0) == pytest.approx(exact, rel=1e-6)


def test_what_the_rule_needs_and_what_it_is_not_for():
    with pytest.raises(InputError, match="largest waves"):
        alone = {"speed_loss": RULE["speed_loss"]}
        hull = {"draught_m": 2.8}
        Ship.from_dict({"name": "x", "hull": hull, "speeds_kn": 10.0, "models": alone})
    with pytest.raises(InputError, match="known speeds"):
        data = Ship.load("gunnerus-2019").file.model_dump(exclude_unset=True, mode="json")
        Ship.from_dict(data | {"models": RULE | {"calm_water": "hollenbach_1998_mean"}})
