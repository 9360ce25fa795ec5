"""Currents with a known optimum: closed forms, and fans of extremals certified to all digits."""

import math
from functools import cache

import numpy as np
import pytest

from tests.worlds.plane import Plane, assert_optimal, simple_ship

KM = Plane(1000.0)


def steady(u, v):
    return lambda t, x, y: (u + 0 * x, v + 0 * x)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "current", "goal_km", "seconds"),
    [
        (5.0, (1.0, 2.0), (100.0, 50.0), 16925.824036),
        (5.0, (-2.0, 1.5), (60.0, 80.0), 23094.010768),
        (10.0, (0.0, 4.0), (0.0, -100.0), 16666.666667),
        (3.0, (2.9, 0.0), (0.0, 30.0), 39056.673294),
    ],
)
def test_constant_current(speed, current, goal_km, seconds):
    """T = L / (W.e + sqrt(V^2 - (e x W)^2)): the straight line with a crab angle."""
    found = KM.plan(
        (0, 0),
        goal_km,
        sea=KM.sea(steady(*current)),
        ship=simple_ship(speed),
        chart=KM.water(-60, 160, -160, 160),
        spacing=10.0,
    )
    assert_optimal(found, seconds, within=3e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("x", "speed", "shear", "units"), [(10, 1, 0.1, 9.63889113), (20, 2, 0.15, 9.29439062)]
)
def test_linear_shear_along(x, speed, shear, units):
    """u = g y, both ends on y = 0: bulge into the favourable side (Zermelo 1931)."""
    plane, v0 = Plane(10_000.0), 5.0 / speed
    found = plane.plan(
        (0, 0),
        (x, 0),
        sea=plane.sea(lambda t, x, y: (v0 * shear * y, 0 * x)),
        ship=simple_ship(5.0),
        chart=plane.water(-3, x + 3, -5, 8),
        spacing=1.0,
    )
    assert_optimal(found, units * 10_000.0 / v0)


@pytest.mark.slow
def test_linear_shear_of_bryson_and_ho():
    """u = -y, V = 1, (3.66, -1.86) -> (0, 0): T = 5.45786526 (Bryson and Ho 1975, section 2.7)."""
    plane, v = Plane(10_000.0), 5.0
    found = plane.plan(
        (3.66, -1.86),
        (0, 0),
        sea=plane.sea(lambda t, x, y: (-v * y, 0 * x)),
        ship=simple_ship(v),
        chart=plane.water(-2, 7, -4, 3),
        spacing=0.5,
    )
    assert_optimal(found, 5.45786526 * 10_000.0 / v)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "turn", "units"),
    [
        ((1, 0), (-1, 0), 0.5, 1.80073445),
        ((1, 0), (0, 1), 0.3, 1.15038626),
        ((1, 0), (0, -1), 0.3, 1.72970196),
        ((2, -1), (-1, 1.5), 0.4, 2.78402370),
    ],
)
def test_solid_body_vortex(start, goal, turn, units):
    """w = Omega x r: a straight line in the rotating frame."""
    plane, v = Plane(20_000.0), 5.0
    found = plane.plan(
        start,
        goal,
        sea=plane.sea(lambda t, x, y: (-v * turn * y, v * turn * x)),
        ship=simple_ship(v),
        chart=plane.water(-3, 3, -3, 3),
        spacing=0.4,
    )
    assert_optimal(found, units * plane.unit / v)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "turn", "drift", "units"),
    [
        ((-3, 0), (3, 0), 0.2, (0.3, 0.0), 5.36960792),
        ((-3, -1), (3, 1), -0.25, (0.0, 0.2), 5.58185967),
    ],
)
def test_moving_vortex(start, goal, turn, drift, units):
    """A vortex whose centre moves: the flow changes in time as well as in space."""
    plane, v = Plane(20_000.0), 5.0

    def flow(t, x, y):
        units_of_time = t * v / plane.unit
        dx, dy = x - drift[0] * units_of_time, y - drift[1] * units_of_time
        return -v * turn * dy, v * turn * dx

    found = plane.plan(
        start,
        goal,
        sea=plane.sea(flow),
        ship=simple_ship(v),
        chart=plane.water(-5, 5, -4, 4),
        spacing=0.6,
    )
    assert_optimal(found, units * plane.unit / v)


HALEM = Plane(6_372_800.0 * math.pi / 180.0)


def rotating(speed, tidal):
    def flow(t, x, y):
        swing = np.cos(2 * np.pi * t / 24_000.0) if tidal else 1.0
        return (
            speed * np.cos(np.pi * (y + 0.5)) * swing,
            -speed * np.cos(np.pi * (x + 0.5)) * swing,
        )

    return flow


@cache
def halem_plan(speed, tidal, ship_speed, spacing):
    return HALEM.plan(
        (-0.4, -0.4),
        (0.4, 0.4),
        sea=HALEM.sea(rotating(speed, tidal)),
        ship=simple_ship(ship_speed),
        chart=HALEM.water(-0.5, 0.5, -0.5, 0.5),
        spacing=spacing,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "tidal", "ship_speed", "seconds"),
    [
        (2.0, False, 4.0, 26240.4617),
        (2.0, False, 3.70041, 27787.35),
        (1.0, False, 4.0, 29597.1630),
        (2.0, True, 4.0, 31512.4115),
        (1.0, True, 4.0, 31474.4499),
    ],
)
def test_halem_rotating_flow(speed, tidal, ship_speed, seconds):
    """Van Halem (2019) cases 1 and 2 as in his notebook, certified in the plane."""
    assert_optimal(halem_plan(speed, tidal, ship_speed, 0.1), seconds)


@pytest.mark.slow
def test_finer_networks_come_closer():
    """On the raw network the error is the direction error, and it shrinks."""
    totals = [halem_plan(2.0, False, 4.0, step).solver_total * 3600.0 for step in (0.2, 0.1)]
    errors = [total / 26240.4617 - 1.0 for total in totals]
    assert errors[0] > errors[-1]
    assert 0.0 <= errors[-1] < 0.015
