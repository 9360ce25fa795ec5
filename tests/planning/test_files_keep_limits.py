"""Route files of a ship that waits until the waves fall below the limit of the ship."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.core.time import parse_time
from thalweg.planning.report.output_files import keeping_limits
from thalweg.route import RouteFileOptions, Track, Violation, write_route_files

START = parse_time("2026-06-01T00:00Z")
WAVES = "sea_surface_wave_significant_height"
LIMIT = 4.0  # [m]
SHIP = Ship.simple(speed_kn=12.0, max_wave_height_m=LIMIT)
CHART = Chart.open_water(-0.5, 0.5, 0.0, 2.0)


def height(time, lat, lon):
    """Waves east of 1 E that fall from 6 m by 0.37 m per hour, and 1 m to the west."""
    return np.maximum(
        np.where(lon > 1.0, 6.0 - 0.37 / 3600.0 * (time - START), 1.0) + 0.0 * lat, 0.0
    )


SEA = Sea.from_functions({WAVES: height})


@pytest.fixture(scope="module")
def found():
    """Return a plan, whose chart, sea and ship the tests use."""
    voyage = Voyage(start=(0.0, 0.4), goal=(0.0, 1.6), depart=START)
    return plan(voyage, ship=SHIP, sea=SEA, chart=CHART, resolution=10_000.0)


def sailed(wait, anchorage):
    """Return the route with a wait [s] at a longitude [deg] west of the high waves."""
    lon = [0.4, anchorage, 1.6]
    return evaluate(Track([0.0] * 3, lon, START, [0.0, wait, 0.0]), ship=SHIP, sea=SEA, chart=CHART)


def with_the_least_wait(anchorage):
    """Return the route that meets the waves when they have just fallen to the limit."""
    low, high = 0.0, 6.0 * 3600.0
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if sailed(middle, anchorage).feasible else (middle, high)
    return sailed(high, anchorage)


@pytest.mark.parametrize("anchorage", [0.91234, 0.93333])
def test_files_of_a_route_that_waits_for_lower_waves_keep_the_limit(found, tmp_path, anchorage):
    best = with_the_least_wait(anchorage)
    assert best.feasible and best.waiting_h > 1.0
    route, options = keeping_limits(found, best, RouteFileOptions())
    write_route_files(route, tmp_path, options=options)
    for ending in ("rtz", "csv", "gpx", "geojson"):
        again = evaluate(tmp_path / f"route.{ending}", ship=SHIP, sea=SEA, chart=CHART)
        assert not again.violations
        assert again.arrive == pytest.approx(best.arrive, abs=3.0)


def test_a_value_and_its_limit_differ_in_messages():
    over = Violation("wave height above the limit", START, 0.0, 1.0, LIMIT + 3e-5, LIMIT)
    assert str(over).endswith("(4.00003 m, limit 4.00000 m)")
    assert str(Violation("waves", START, 0.0, 1.0, 5.1, LIMIT)).endswith("(5.10, limit 4.00)")
