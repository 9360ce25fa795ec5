"""The referee where the speed jumps or comes near zero: its tolerance holds."""

import math

import numpy as np
import pytest

from tests.route.planar import Plane
from thalweg import Sea, Ship, evaluate

PLANE = Plane(unit=5000.0)
FLATNESS = 3e-6  # of the plane


def fall(x, y):
    """The speed of a body that has fallen y from rest, as in the brachistochrone."""
    return np.sqrt(18.0 * np.maximum(y, 0.0))


def step_at(place):
    return lambda x, y: np.where(y < place, 5.0, 1.5) + 0.0 * x


def near_stop(x, y):
    return 0.02 + 5.0 * np.abs(y - 0.437)


def time_of_fall(x, depth):
    """Along a straight line from rest: the mean speed is half of that at its end."""
    return 2.0 * math.hypot(x, depth) / math.sqrt(18.0 * depth)


def time_over_step(place):
    return place / 5.0 + (1.0 - place) / 1.5


SOUTH_TO_NORTH = ((0.0, 0.0), (0.0, 1.0))
CASES = {
    "from rest": (fall, ((0.0, 0.0), (1.0, 0.5)), time_of_fall(1.0, 0.5)),
    "to rest": (fall, ((1.0, 0.01), (0.0, 0.0)), time_of_fall(1.0, 0.01)),
    "from rest, straight": (fall, SOUTH_TO_NORTH, time_of_fall(0.0, 1.0)),
    "jump": (step_at(0.3), SOUTH_TO_NORTH, time_over_step(0.3)),
    "jump that halving does not see": (step_at(0.5003), SOUTH_TO_NORTH, time_over_step(0.5003)),
    "jump near the end": (step_at(0.98), SOUTH_TO_NORTH, time_over_step(0.98)),
    "near zero within": (
        near_stop,
        SOUTH_TO_NORTH,
        (math.log1p(250 * 0.437) + math.log1p(250 * 0.563)) / 5.0,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_tolerance_holds(name):
    law, points, time = CASES[name]
    boat = Ship.from_speed_function(lambda c: law(*PLANE.xy(c.lat, c.lon)), top_speed=6.0)
    route = evaluate([PLANE.place(*p) for p in points], ship=boat, sea=Sea.calm(), depart=0)
    error = abs(route.time_h * 3600.0 / PLANE.unit - time)
    stated = route.tolerance_s / PLANE.unit
    assert error < stated + FLATNESS * time
    assert stated < 1e-4 * time
