"""The least time of a front in currents is that of a certificate, not of the strongest current."""

import numpy as np
import pytest

from tests.worlds.plane import KNOT, T0, Plane
from thalweg import Ship, Voyage, plan
from thalweg.core.units import HOUR

PLANE, SPEED = Plane(20_000.0), 5.0


EIGHT_UNITS = Voyage(
    start=PLANE.position(0, 0), goal=PLANE.position(8, 0), depart=T0, objective="front",
    offing_nm=0.0, method="exact",
)  # fmt: skip
CONDITIONS = {
    "ship": Ship.simple(
        speed_kn=SPEED / KNOT, speeds_kn=[7.0, SPEED / KNOT], draught_m=5.0, fuel_t_per_day=24.0
    ),
    "chart": PLANE.water(-1, 9, -4, 4),
    "resolution": 10_000.0,
}


@pytest.mark.slow
def test_a_current_beside_the_way_does_not_loosen_the_least_time():
    """A jet of 2.5 m/s against the ship lies 3 units off the way of 8 units straight on."""
    sea = PLANE.sea(lambda t, x, y: (np.where(np.abs(y - 3.0) < 0.5, -2.5, 0.0) + 0 * x, 0 * x))
    found = plan(EIGHT_UNITS, sea=sea, **CONDITIONS, proof=6.0)
    truth = 8.0 * PLANE.unit / SPEED / HOUR
    least = float(found.front.certain[0, 0])
    assert 0.95 * truth < least <= truth * 1.0005  # with the strongest current it is 0.67 of it
    assert found.proof.certain == pytest.approx(least)


@pytest.mark.slow
def test_a_front_with_certificates_of_cost_is_nowhere_below_that_by_fair_currents(monkeypatch):
    """Certificates for a part of the times must not end what fair currents prove after it."""
    tide = 2.0 * np.pi / (12.42 * HOUR)
    sea = PLANE.sea(lambda t, x, y: (np.cos(tide * (t - T0)) + 0.0 * x, 0.0 * x))
    conditions = {"sea": sea, **CONDITIONS}
    alone = plan(EIGHT_UNITS, **conditions).front.certain
    until = 0.5 * float(alone[0, 0] + alone[0, -1])
    dearer = 1.001 * float(np.interp(until, *alone))  # a line by a proof, up to that time
    monkeypatch.setattr(
        "thalweg.planning.pareto.front_bound.certified_front.certified_lines",
        lambda *_, **__: (np.array([[0.0], [dearer]]), until, ""),
    )
    both = plan(EIGHT_UNITS, **conditions, proof=3.0).front.certain
    hours = np.linspace(alone[0, 0], alone[0, -1], 101)
    raised = np.interp(hours, *both)
    assert (raised >= np.interp(hours, *alone) * (1.0 - 1e-9)).all()
    assert np.interp(until, *both) == pytest.approx(dearer)
