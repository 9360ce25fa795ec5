"""Water in which the ship's own speed varies: rays that bend, with closed forms."""

import numpy as np
import pytest
from scipy.optimize import fsolve

from tests.worlds.plane import Plane, assert_optimal
from thalweg import Sea, Ship

PLANE = Plane(10_000.0)


def speed_ship(law, top):
    """A ship whose speed through water is law(y) in units of 5 m/s."""

    def speed(conditions):
        _, y = PLANE.xy(conditions.lat, conditions.lon)
        return 5.0 * law(y)

    return Ship.from_speed_function(speed, top_speed=5.0 * top)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("v0", "k", "start", "goal", "units"),
    [
        (1.0, 0.1, (0, 0), (10, 0), 9.62423650),
        (1.0, 0.1, (0, 0), (10, 10), 9.62423650),
        (2.0, 0.5, (0, 0), (20, 4), 5.40715166),
    ],
)
def test_speed_linear_in_y(v0, k, start, goal, units):
    """v = v0 + k y: rays are circular arcs, T = acosh(1 + k^2 d^2 / (2 v1 v2)) / k."""
    found = PLANE.plan(
        start,
        goal,
        sea=Sea.calm(),
        ship=speed_ship(lambda y: v0 + k * y, v0 + k * 20),
        chart=PLANE.water(-2, 22, -1.5, 13),
    )
    assert_optimal(found, units * PLANE.unit / 5.0)


def cycloid_time(x, y, y0, guess):
    """The brachistochrone from (0, y0) to (x, y): x = r (s - sin s), y = r (1 - cos s)."""

    def miss(unknown):
        r, s1, s2 = unknown
        return (
            r * (1 - np.cos(s1)) - y0,
            r * (1 - np.cos(s2)) - y,
            r * ((s2 - np.sin(s2)) - (s1 - np.sin(s1))) - x,
        )

    r, s1, s2 = fsolve(miss, guess, xtol=1e-13)
    return (s2 - s1) * np.sqrt(r)


def test_cycloid_formula_has_the_printed_values():
    assert cycloid_time(np.pi, 2.0, 1e-9, (1.0, 1e-4, 3.0)) == pytest.approx(3.14159265, abs=1e-4)
    assert cycloid_time(10.0, 2.0, 1e-9, (1.7, 1e-4, 4.4)) == pytest.approx(6.14655212, abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("x", "guess"), [(np.pi, (1.0, 0.5, 3.0)), (10.0, (1.7, 0.4, 4.4))])
def test_cycloid(x, guess):
    """v = sqrt(2 g y), g = 1, from a little below the line where the ship cannot move at all."""
    y0 = 0.2
    found = PLANE.plan(
        (0.0, y0),
        (x, 2.0),
        sea=Sea.calm(),
        ship=speed_ship(lambda y: np.sqrt(2 * np.maximum(y, 1e-3)), np.sqrt(2 * 5.0)),
        chart=PLANE.water(-1, 11, 0.05, 5),
    )
    assert_optimal(found, cycloid_time(x, 2.0, y0, guess) * PLANE.unit / 5.0)
