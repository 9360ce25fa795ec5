"""Routes whose legs order more speed than the ship makes."""

import numpy as np
import pytest

from thalweg import Sea, Ship
from thalweg.core.units import KNOT
from thalweg.route import Track, evaluate
from thalweg.route.route import ORDERED_TOO_FAST

ONE_SPEED = {
    "name": "one known speed",
    "hull": {"draught_m": 6.0},
    "speeds_kn": [12.0],
    "engine": {"reference_speed_kn": 12.0, "reference_power_kw": 3000, "sfoc_g_per_kwh": 190},
}


@pytest.mark.parametrize(
    ("ship", "greatest_kn"),
    [
        (Ship.from_dict(ONE_SPEED), 12.0),  # sailed 35 kn by the cubic law, all limits kept
        (Ship.from_dict(ONE_SPEED).with_speeds([9.0 * KNOT]), 12.0),  # a lower order of that ship
        (Ship.simple(speeds_kn=[8.0, 10.0]), 10.0),  # was an error
        (Ship.load("handysize-bulker"), 15.2),
    ],
)
def test_a_leg_above_the_greatest_speed_is_sailed_at_it_and_is_a_violation(ship, greatest_kn):
    track = Track([51.5, 51.8, 52.2], [2.0, 2.5, 3.2], 0.0, speed=np.array([9.0, 35.0]) * KNOT)
    route = evaluate(track, ship=ship, sea=Sea.calm(), min_ukc=None)
    (found,) = route.violations
    assert not route.feasible
    assert found.reason == f"{ORDERED_TOO_FAST}: leg 2"
    assert found.value == pytest.approx(35.0 * KNOT)
    assert found.limit == pytest.approx(greatest_kn * KNOT, rel=1e-3)
    assert f"(35.00 kn, limit {greatest_kn:.2f} kn)" in str(found)
    assert route.legs["ordered_speed"] == pytest.approx(
        np.array([9.0, greatest_kn]) * KNOT, rel=1e-3
    )
    assert (found.lat, found.lon) == (51.8, 2.5)


def test_one_ordered_speed_is_judged_as_well_and_rounding_in_files_is_not():
    ship, sea = Ship.from_dict(ONE_SPEED), Sea.calm()
    track = Track([51.5, 51.8], [2.0, 2.5], 0.0)
    fast = evaluate(track, ship=ship, sea=sea, speed_kn=30.0, min_ukc=None)
    assert [one.reason for one in fast.violations] == [f"{ORDERED_TOO_FAST}: leg 1"]
    assert evaluate(track, ship=ship, sea=sea, speed_kn=12.0005, min_ukc=None).feasible


def test_the_greatest_speed_of_ships_of_resistance_is_that_of_their_power():
    ship = Ship.load("kvlcc2")
    greatest = ship.greatest_order()
    ship.with_speeds([0.9999 * greatest])
    with pytest.raises(Exception, match="The engines give"):
        ship.with_speeds([1.001 * greatest])
