"""Via points: passages follow one another in time and place."""

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


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "distance"])
def test_two_via_points(objective):
    # The second part departs at an arrival that is not a round number.
    via = ((51.5, 2.0), (50.5, 3.0))
    voyage = Voyage(
        start=(51.0, 1.5), goal=(51.0, 3.5), via=via, depart="2026-01-01", objective=objective
    )
    found = plan(voyage, ship=SHIP, sea=SEA, chart=WATER, resolution=6000.0)
    best = found.best
    assert best.feasible and found.lower_bound <= found.objective_value * (1 + 1e-9)
    for lat, lon in via:
        away = np.hypot(best.track.lat - lat, best.track.lon - lon)
        assert away.min() < 1e-9
    assert best.distance_nm == pytest.approx(35.43 + 71.03 + 35.44, abs=0.4)
    assert np.all(np.diff(best.samples["time"]) >= 0)


@pytest.mark.slow
def test_a_penalty_zone_is_avoided_when_that_costs_less():
    square = [[2.9, 51.4], [3.3, 51.4], [3.3, 52.4], [2.9, 52.4], [2.9, 51.4]]
    zone = {
        "type": "Feature",
        "properties": {"kind": "penalty", "factor": 20.0, "name": "slow water"},
        "geometry": {"type": "Polygon", "coordinates": [square]},
    }
    chart = Chart.open_water(50.0, 54.0, 1.0, 5.0).with_zones(zone)
    voyage = Voyage(start=(52.0, 2.5), goal=(52.0, 3.7), depart="2026-01-01")
    best = plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart, resolution=5000.0).best
    inside = (best.samples["lon"] > 2.91) & (best.samples["lon"] < 3.29)
    assert best.samples["lat"][inside].min() > 52.39


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "distance"])
def test_the_bound_states_that_it_leaves_out_a_penalty_zone(objective):
    """A square of factor 2 that the best route passes: the bound leaves it out and says so."""
    square = [[2.9, 51.7], [3.3, 51.7], [3.3, 52.12], [2.9, 52.12], [2.9, 51.7]]
    zone = {
        "type": "Feature",
        "properties": {"kind": "penalty", "factor": 2.0, "name": "slow water"},
        "geometry": {"type": "Polygon", "coordinates": [square]},
    }
    water = Chart.open_water(51.5, 52.5, 2.0, 4.2)
    voyage = Voyage(start=(52.0, 2.5), goal=(52.0, 3.7), depart="2026-01-01", objective=objective)
    given = {"ship": SHIP, "sea": Sea.calm(), "resolution": 4000.0}
    found = plan(voyage, chart=water.with_zones(zone), **given)
    free = plan(voyage, chart=water, **given)
    assert found.objective_value > 1.025 * free.objective_value
    assert found.lower_bound <= found.objective_value * (1 + 1e-9)
    assert found.gap < 0.08
    assert "without the penalties" in found.proof.kind
