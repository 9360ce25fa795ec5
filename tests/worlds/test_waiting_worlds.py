"""Closed water that opens: waiting when waiting is faster, and only then."""

import math

import numpy as np
import pytest

from tests.worlds.plane import T0, Plane, assert_optimal, simple_ship

KM = Plane(1000.0)
HALEM = Plane(6_372_800.0 * math.pi / 180.0)


def bar_sea(plane, inside, opens, wet=20.0):
    """20 m of water; where inside(x, y) it is dry until the opening."""

    def depth(time_s, lat, lon):
        x, y = plane.xy(lat, lon)
        closed = inside(x, y) & (np.asarray(time_s) - T0 < opens)
        return np.where(closed, -5.0, wet)

    return plane.sea(lambda t, x, y: (0 * x, 0 * x), sea_floor_depth_below_geoid=depth)


@pytest.mark.slow
@pytest.mark.parametrize(("opens_h", "seconds"), [(5.0, 30500.0), (1.0, 20000.0)])
def test_tidal_bar(opens_h, seconds):
    """A bar 30 km along an 80 km gully: T = max(s1/V, To) + (L - s1)/V."""
    found = KM.plan(
        (0, 0),
        (80, 0),
        sea=bar_sea(KM, lambda x, y: np.abs(x - 30.5) <= 0.5, opens_h * 3600.0),
        ship=simple_ship(4.0, draught_m=6.5),
        chart=KM.water(-2, 82, -3, 3),
        spacing=1.0,
    )
    assert_optimal(found, seconds, solver_within=0.03)
    assert found.best.waiting_h * 3600.0 == pytest.approx(seconds - 20000.0, abs=60.0)


@pytest.mark.slow
def test_halem_waits_for_the_bank():
    """Van Halem (2019) case 3: waiting takes 31903.29 s, the detour 33367.90 s."""
    inside = lambda x, y: (np.abs(x) < 0.4) & (np.abs(y) < 0.1)  # noqa: E731
    found = HALEM.plan(
        (0.0, -0.4),
        (0.0, 0.4),
        sea=bar_sea(HALEM, inside, 18_000.0),
        ship=simple_ship(4.0),
        chart=HALEM.water(-0.5, 0.5, -0.5, 0.5),
        spacing=0.025,
    )
    assert_optimal(found, 31903.29, solver_within=0.03)


@pytest.mark.slow
def test_halem_detours_when_the_bank_opens_late():
    """The same with the opening at 30,000 s: the detour round the corners wins."""
    inside = lambda x, y: (np.abs(x) < 0.4) & (np.abs(y) < 0.1)  # noqa: E731
    found = HALEM.plan(
        (0.0, -0.4),
        (0.0, 0.4),
        sea=bar_sea(HALEM, inside, 30_000.0),
        ship=simple_ship(4.0),
        chart=HALEM.water(-0.5, 0.5, -0.5, 0.5),
        spacing=0.025,
    )
    corners = 2 * math.hypot(0.4, 0.3) + 0.2  # to a corner, along the bank, from the other corner
    # The rim of this bank is a step: rasters smooth it, and the referee rejects routes across it.
    assert_optimal(found, corners * HALEM.unit / 4.0, within=6e-3)
    assert found.best.waiting_h == 0.0


@pytest.mark.slow
def test_without_leave_to_wait_the_ship_goes_round():
    inside = lambda x, y: (np.abs(x) < 0.4) & (np.abs(y) < 0.1)  # noqa: E731
    request = {
        "sea": bar_sea(HALEM, inside, 18_000.0),
        "ship": simple_ship(4.0),
        "chart": HALEM.water(-0.5, 0.5, -0.5, 0.5),
        "spacing": 0.05,
    }
    waiting = HALEM.plan((0.0, -0.4), (0.0, 0.4), wait=True, **request)
    going = HALEM.plan((0.0, -0.4), (0.0, 0.4), wait=False, **request)
    assert going.best.waiting_h == 0.0
    assert waiting.best.time_h <= going.best.time_h
