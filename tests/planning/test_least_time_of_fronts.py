"""The least time of a front in currents is that of a certificate, not of the strongest current."""

import numpy as np
import pytest

from tests.worlds.plane import KNOT, T0, Plane
from thalweg import Ship, Voyage, plan
from thalweg.core.units import HOUR

PLANE, SPEED = Plane(20_000.0), 5.0


@pytest.mark.slow
def test_a_current_beside_the_way_does_not_loosen_the_least_time():
    """A jet of 2.5 m/s against the ship lies 3 units off the way of 8 units straight on."""
    sea = PLANE.sea(lambda t, x, y: (np.where(np.abs(y - 3.0) < 0.5, -2.5, 0.0) + 0 * x, 0 * x))
    ship = Ship.simple(
        speed_kn=SPEED / KNOT, speeds_kn=[7.0, SPEED / KNOT], draught_m=5.0, fuel_t_per_day=24.0
    )
    voyage = Voyage(
        start=PLANE.position(0, 0), goal=PLANE.position(8, 0), depart=T0, objective="front",
        offing_nm=0.0, method="exact",
    )  # fmt: skip
    chart = PLANE.water(-1, 9, -4, 4)
    found = plan(voyage, ship=ship, sea=sea, chart=chart, resolution=10_000.0, proof=6.0)
    truth = 8.0 * PLANE.unit / SPEED / HOUR
    least = float(found.front.certain[0, 0])
    assert 0.95 * truth < least <= truth * 1.0005  # with the strongest current it is 0.67 of it
    assert found.proof.certain == pytest.approx(least)
