"""Voyages by way of other places: the parts follow one another in time and place."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan

WATER = Chart.open_water(50.0, 52.0, 1.0, 4.0)
SHIP = Ship.simple(speed_kn=8.0, draught_m=5.0)
SEA = Sea.from_functions(
    {
        "eastward_sea_water_velocity": lambda t, lat, lon: 0.5 + 0.0 * lat,
        "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
    }
)


@pytest.mark.parametrize("objective", ["time", "distance"])
def test_two_places_on_the_way(objective):
    # The second part leaves at an arrival that is no round number of anything.
    via = ((51.5, 2.0), (50.5, 3.0))
    voyage = Voyage(
        start=(51.0, 1.5), goal=(51.0, 3.5), via=via, depart="2026-01-01", objective=objective
    )
    found = plan(voyage, ship=SHIP, sea=SEA, chart=WATER)
    best = found.best
    assert best.feasible and found.lower_bound <= found.objective_value * (1 + 1e-9)
    for lat, lon in via:
        away = np.hypot(best.track.lat - lat, best.track.lon - lon)
        assert away.min() < 1e-9
    assert best.distance_nm == pytest.approx(35.43 + 71.03 + 35.44, abs=0.4)
    assert np.all(np.diff(best.samples["time"]) >= 0)
