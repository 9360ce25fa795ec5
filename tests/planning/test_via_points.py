"""Via points: passages follow one another in time and place."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.plots.stage_passages import stage_arrival_times

WATER = Chart.open_water(50.0, 52.0, 1.0, 4.0)
SHIP = Ship.simple(speed_kn=8.0, draught_m=5.0)
SEA = Sea.from_functions(
    {
        "eastward_sea_water_velocity": lambda t, lat, lon: 0.5 + 0.0 * lat,
        "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
    }
)


class ShownRoutes:
    """A progress callback that keeps the routes found so far."""

    def __init__(self):
        self.routes = []

    def __call__(self, text):
        pass

    def show_route(self, route):
        self.routes.append(route)


@pytest.mark.slow
def test_isochrones_of_a_stage_end_when_the_route_is_at_its_via_point():
    via = (51.0, 3.0)
    voyage = Voyage(start=(51.0, 1.5), goal=(51.5, 1.5), via=[via], depart="2026-01-01")
    found = plan(voyage, ship=SHIP, sea=Sea.calm(), chart=WATER, resolution=6000.0)
    at_via = float(distance(51.0, 1.5, *via)) / (8.0 * KNOT) / HOUR
    place = np.array([51.0]), np.array([2.0])  # both stages pass within reach of it
    there, back = stage_arrival_times(found.plot_context, *place, np.asarray)
    hours = (np.concatenate([there, back]) - found.best.depart) / HOUR
    rest = float(distance(*via, 51.0, 2.0)) / (8.0 * KNOT) / HOUR
    first = float(distance(51.0, 1.5, 51.0, 2.0)) / (8.0 * KNOT) / HOUR
    assert hours == pytest.approx([first, at_via + rest], rel=0.02)
    before, after = stage_arrival_times(
        found.plot_context, np.array([51.0, 51.0]), np.array([3.1, 3.1]), np.asarray
    )
    assert np.isnan(before).all() and np.isfinite(after).all()  # the first ends at the via point


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "distance"])
def test_two_via_points(objective):
    # The second part departs at an arrival that is not a round number.
    via = ((51.5, 2.0), (50.5, 3.0))
    voyage = Voyage(
        start=(51.0, 1.5), goal=(51.0, 3.5), via=via, depart="2026-01-01", objective=objective
    )
    shown = ShownRoutes()
    found = plan(voyage, ship=SHIP, sea=SEA, chart=WATER, resolution=6000.0, progress=shown)
    best = found.best
    starts = [(route.track.lat[0], route.track.lon[0]) for route in shown.routes]
    assert len(starts) > 3 and set(starts) == {(51.0, 1.5)}
    goals = [(float(route.track.lat[-1]), float(route.track.lon[-1])) for route in shown.routes]
    assert list(dict.fromkeys(goals)) == [*via, (51.0, 3.5)]
    assert shown.routes[-1].time_h == pytest.approx(best.time_h, rel=1e-3)
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
