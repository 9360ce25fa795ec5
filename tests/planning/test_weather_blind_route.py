"""The route that ignores the weather is sailed at the speed that the voyage orders."""

from __future__ import annotations

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.planning.demo_voyage import weather_blind


@pytest.mark.slow
def test_the_route_that_ignores_the_weather_keeps_the_ordered_speed():
    ship = Ship.load("yu-single-screw-169m")
    chart = Chart.open_water(46.0, 48.0, -21.0, -19.0)
    sea = Sea.calm()
    voyage = Voyage(start=(47.0, -20.0), goal=(47.2, -19.5), depart="2026-01-01", speed_kn=12.0)
    found = plan(voyage, ship=ship, sea=sea, chart=chart, resolution=4000.0, proof=0.0)
    blind = weather_blind(found, ship=ship, sea=sea, chart=chart)
    assert blind.distance_nm / blind.time_h == pytest.approx(12.0, abs=0.01)
    assert blind.time_h == pytest.approx(found.best.time_h, rel=1e-3)
