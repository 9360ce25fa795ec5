"""Routes through jumps of the speed: they bend on the interface, by Snell's law."""

import numpy as np
import pytest
from scipy.optimize import minimize

from tests.route.planar import Plane, ship
from thalweg import Sea, Ship
from thalweg.core.limits import Limits
from thalweg.route import RefinementConditions, Track, better_route, evaluate

PLANE = Plane(unit=1000.0)


def refined(points, boat, sea):
    track = Track.from_positions([PLANE.place(*p) for p in points], depart=0)
    scored = evaluate(track, ship=boat, sea=sea)
    table = ship(1.0).tabulate() if boat.speed_field is not None else boat.tabulate()
    conditions = RefinementConditions(boat, sea, None, table, Limits())
    return better_route(scored, conditions)


def layered_ship(edges, speeds, slope):
    """A ship whose speed depends on the layer y - slope x that it is in."""

    def speed(c):
        x, y = PLANE.xy(c.lat, c.lon)
        return np.asarray(speeds)[np.searchsorted(edges, y - slope * x, side="right")]

    return Ship.from_speed_function(speed, top_speed=max(speeds))


def least_time(edges, speeds, slope, start, goal):
    def time(places):
        line = [start, *((x, edge + slope * x) for x, edge in zip(places, edges)), goal]
        lengths = np.hypot(*np.diff(np.array(line), axis=0).T)
        return float(np.sum(lengths / speeds))

    first = np.linspace(start[0], goal[0], len(edges) + 2)[1:-1]
    options = {"xatol": 1e-9, "fatol": 1e-13, "maxiter": 20_000}
    found = minimize(time, first, method="Nelder-Mead", options=options)
    return found.fun * PLANE.unit, found.x


@pytest.mark.parametrize(
    ("edges", "speeds", "slope", "goal"),
    [
        ([5.0], [5.0, 2.5], 0.0, (10.0, 10.0)),
        ([5.0], [5.0, 2.5], 0.3, (10.0, 10.0)),
        ([2.0], [3.0, 5.0], 0.0, (20.0, 3.0)),
        pytest.param(
            [3.0, 6.0, 7.0], [5.0, 2.5, 4.0, 3.0], 0.0, (10.0, 10.0), marks=pytest.mark.slow
        ),
    ],
)
def test_light_through_layers(edges, speeds, slope, goal):
    seconds, places = least_time(edges, speeds, slope, (0.0, 0.0), goal)
    middle = (goal[0] / 2, goal[1] / 2 + 0.3)
    best = refined([(0, 0), middle, goal], layered_ship(edges, speeds, slope), Sea.calm())
    assert abs(best.time_h * 3600.0 / seconds - 1.0) < 1e-5
    x, y = PLANE.xy(best.track.lat[1:-1], best.track.lon[1:-1])
    assert x == pytest.approx(places, abs=0.05)
    assert y - slope * x == pytest.approx(edges, abs=1e-5)  # a centimetre


@pytest.mark.slow
def test_a_current_that_ends_at_a_line():
    """A current of 2 m/s west of x = 4 only, as at the edge of data filled with still water."""
    sea = PLANE.sea(lambda t, x, y: 0.0 * x, lambda t, x, y: np.where(x < 4.0, 2.0, 0.0))
    best = refined([(0, 0), (4.5, 1.0), (9, 0)], ship(5.0), sea)

    def time(y):
        first, second = np.hypot(4.0, y), np.hypot(5.0, y)
        up = y / first
        along = 2.0 * up + np.sqrt(25.0 - 4.0 * (1.0 - up * up))
        return first / along + second / 5.0

    places = np.linspace(0.0, 4.0, 400_001)
    seconds = float(np.min(time(places))) * PLANE.unit
    assert abs(best.time_h * 3600.0 / seconds - 1.0) < 1e-5
