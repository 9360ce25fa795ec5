"""The speed of a ship in the approaches of ports."""

import pytest

from thalweg import Ship
from thalweg.chart.approaches import MAX_APPROACH_SPEED
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.route.canal_legs import approach_speed


def test_ten_knots_are_the_default():
    ship = Ship.load("handysize-bulker")
    assert ship.approach_speed == pytest.approx(MAX_APPROACH_SPEED)
    assert approach_speed(ship, len(ship.speeds) - 1) == pytest.approx(10.0 * KNOT)


def test_another_speed_is_kept_up_to_the_ordered_one():
    ship = Ship.load("handysize-bulker").with_approach_speed(12.5)
    assert ship.approach_speed == pytest.approx(12.5 * KNOT)
    assert ship.name == Ship.load("handysize-bulker").name
    assert approach_speed(ship, len(ship.speeds) - 1) == pytest.approx(12.5 * KNOT)
    assert approach_speed(ship, 0) == pytest.approx(min(12.5 * KNOT, float(ship.speeds[0])))


def test_the_ship_file_may_give_it(tmp_path):
    path = tmp_path / "ferry.yaml"
    path.write_text(
        "name: ferry\nhull: {length_between_perpendiculars_m: 200, breadth_m: 31, draught_m: 7}\n"
        "speeds_kn: [12, 17, 20]\nlimits: {approach_speed_kn: 17}\n"
    )
    assert Ship.load(path).approach_speed == pytest.approx(17.0 * KNOT)


@pytest.mark.parametrize("speed", [0.0, 1.9, 25.1, float("nan"), "ten"])
def test_impossible_speeds_are_refused(speed):
    with pytest.raises(InputError, match="speed in approaches"):
        Ship.load("handysize-bulker").with_approach_speed(speed)
