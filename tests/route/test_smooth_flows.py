"""Refined to the end: smooth currents, within 0.001 % of the optimum."""

import numpy as np
import pytest

from tests.route.planar import Plane, ship
from tests.route.smooth_flows import FLOWS
from thalweg.core.limits import Limits
from thalweg.route import RefinementConditions, Track, better_route, evaluate

PLANE = Plane(unit=1000.0)
SPEED = 5.0
TIMES = {"circular": 1.5117285874, "four vortices": 8.9494561492, "growing vortex": 1.0300835491}


def sea_of(flow):
    return PLANE.sea(
        lambda t, x, y: flow.current(t, x, y)[0],
        lambda t, x, y: flow.current(t, x, y)[1],
        speed=SPEED,
    )


def test_the_circular_optimum_is_straight_in_the_rotating_frame():
    flow, time = FLOWS["circular"], TIMES["circular"]
    turn = np.exp(0.9j * time)  # the frame turns clockwise by 0.9 a unit of time
    assert abs(complex(*flow.goal) * turn - complex(*flow.start)) == pytest.approx(time, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", FLOWS)
def test_refined_routes_are_within_a_hundred_thousandth_of_the_optimum(name):
    flow, boat = FLOWS[name], ship(SPEED)
    time, line = flow.optimum(points=9)
    assert time == pytest.approx(TIMES[name], rel=1e-9)
    seconds, sea = time * PLANE.unit / SPEED, sea_of(flow)
    crude = line.copy()
    crude[:, 1:-1] += np.random.default_rng(1).normal(0.0, 0.05, (2, 7))
    track = Track.from_positions([PLANE.place(*p) for p in crude.T], depart=0)
    scored = evaluate(track, ship=boat, sea=sea)
    conditions = RefinementConditions(boat, sea, None, boat.tabulate(), Limits())
    best = better_route(scored, conditions)
    assert best.time_h * 3600.0 / seconds - 1.0 < 1e-5
    finer = evaluate(best.track, ship=boat, sea=sea, step=3.0)
    referee_error = abs(best.time_h / finer.time_h - 1.0)
    assert referee_error < 1e-7
    assert finer.time_h * 3600.0 / seconds - 1.0 > -5e-7  # the plane's own flatness
