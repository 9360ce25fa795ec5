"""The bound of a front counts the dear fuel that a ship burns until it leaves a control area."""

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.planning.plan_front import certain_at

START, GOAL = (0.0, 0.0), (0.0, 2.0)
LENGTH = float(distance(*START, *GOAL))
KNOT = 1852.0 / 3600.0


def area(west, east):
    ring = [[west, -2.0], [east, -2.0], [east, 2.0], [west, 2.0], [west, -2.0]]
    return {
        "type": "Feature",
        "properties": {"kind": "eca", "name": "made area"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


def planned(zone):
    ship = Ship.from_dict(
        {
            "name": "cubic",
            "hull": {"draught_m": 5.0},
            "speeds_kn": [8.0, 12.0],
            "engine": {"reference_speed_kn": 12.0},
            "fuel": {"reference_t_per_day": 24.0},
            "models": {"calm_water": "cubic"},
        }
    )
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective="cost", method="exact",
        fuel_price_usd=500.0, eca_price_factor=1.6,
    )  # fmt: skip
    chart = Chart.open_water(-0.5, 0.5, -0.5, 2.5).with_zones(zone)
    return plan(voyage, ship=ship, sea=Sea.calm(), chart=chart, resolution=20_000.0)


@pytest.mark.parametrize(
    ("zone", "inside"),
    [
        (area(-3.0, 4.5), LENGTH),
        ({"type": "FeatureCollection", "features": [area(-3.0, 0.3), area(0.3, 4.5)]}, LENGTH),
        (area(-0.8, 0.6), 0.3 * LENGTH),
    ],
)
def test_the_bound_is_the_cost_at_the_prices_along_the_way(zone, inside):
    """The first ring is out of reach, also where two areas make it up, which adjoin at sea.

    The last is left after 0.6 degrees, or 0.8 westwards.
    """
    found = planned(zone)
    rate = 24.0 / 86400.0 * (8.0 / 12.0) ** 3 / (8.0 * KNOT)  # [t/m] at the cheapest speed
    cost = 500.0 * rate * (LENGTH + 0.6 * inside)
    assert found.objective_value == pytest.approx(cost, rel=2e-3)
    assert found.lower_bound <= found.objective_value
    assert found.lower_bound == pytest.approx(cost, rel=0.01)
    for value, time_h in zip(found.front.values, (route.time_h for route in found.routes)):
        assert certain_at(found.front.certain, time_h) <= value * (1 + 1e-9)


def test_the_goal_outside_and_a_short_way_out_lower_the_bound():
    """5 km out of the area at the start: no dear fuel is certain beyond that."""
    found = planned(area(-0.045, 1.7))
    rate = 24.0 / 86400.0 * (8.0 / 12.0) ** 3 / (8.0 * KNOT)
    least = 500.0 * rate * LENGTH
    assert least <= found.lower_bound <= least + 500.0 * rate * 0.6 * 5_010.0
    assert found.lower_bound < found.objective_value
