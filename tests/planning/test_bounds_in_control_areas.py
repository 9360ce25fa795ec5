"""The bound of a front counts the dear fuel that a ship burns until it leaves a control area."""

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.planning.pareto.front_bound.least_ways import corners_of_lengths
from thalweg.planning.plan_front import certain_at
from thalweg.search.certificate.barrier_domain import StretchToBound
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.time_certificate import certify_priced_length
from thalweg.ship import PerformanceTable, TableError, TablePart

START, GOAL = (0.0, 0.0), (0.0, 2.0)
LENGTH = float(distance(*START, *GOAL))
KNOT = 1852.0 / 3600.0


def area(west, east, south=-2.0, north=2.0):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
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


@pytest.mark.parametrize(
    ("zone", "most"),
    [
        (area(-3.0, 1.7, north=0.045), 1.08),  # on, outside the area
        (area(-0.045, 1.7), 1.52),  # west, for nothing: the area is to be crossed all the same
    ],
)
def test_with_a_short_way_out_the_bound_lies_between_the_cheap_way_and_the_plan(zone, most):
    """The area is left after 5 km; its fuel costs 1.6 times as much, on 0.85 of the way."""
    found = planned(zone)
    rate = 24.0 / 86400.0 * (8.0 / 12.0) ** 3 / (8.0 * KNOT)
    least = 500.0 * rate * LENGTH
    assert 0.999 * least <= found.lower_bound <= found.objective_value <= most * least


@pytest.mark.parametrize(
    ("zone", "truth"),
    [
        pytest.param(area(0.5, 1.5), 2.5, marks=pytest.mark.slow),  # through it, a degree long
        (area(0.5, 1.5, -0.1, 0.1), 1.0 + 2.0 * np.hypot(0.5, 0.1)),  # round it
    ],
)
def test_the_priced_length_counts_dearer_metres_and_the_way_round_them(zone, truth):
    table = PerformanceTable(
        (TablePart((), (), np.ones(1, np.float32)),), np.ones(1), "", TableError(0.0, 0.0, 0.0)
    )
    ship = ShipInBarrier(table.kernel_arrays(), 0, Limits().array, 1.0)
    chart = Chart.open_water(-0.5, 0.5, -0.5, 2.5).with_zones(zone)
    known = truth * 0.5 * LENGTH
    stretch = StretchToBound(Sea.calm(), chart, ship, (), START, GOAL, depart=0.0, known=known)
    found = certify_priced_length(stretch, 1.5, seconds=30.0, target=0.02)
    assert 0.98 * known <= found.value <= known


def test_corners_of_lengths_are_those_of_the_lines():
    """10 inside at least, 100 in all, and 150 where a metre inside counts two."""
    corners = corners_of_lengths(10.0, [(1.0, 100.0), (2.0, 150.0), (3.0, float("nan"))])
    assert corners == [(10.0, 140.0), (50.0, 100.0), (100.0, 100.0)]


@pytest.mark.slow
def test_an_ordered_speed_is_kept_where_fuel_costs_more_in_control_areas():
    ship = Ship.from_dict(
        {
            "name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [10.0, 12.0, 14.0],
            "engine": {"reference_speed_kn": 12.0}, "models": {"calm_water": "cubic"},
            "fuel": {
                "reference_t_per_day": 24.0, "price_per_t": 500.0, "eca_price_per_t": 800.0,
            },
        }
    )  # fmt: skip
    voyage = Voyage(
        start=(43.8, -8.6), goal=(48.2, -5.9), depart="2026-01-01T00:00Z", objective="cost",
        speed_kn=14.0,
    )  # fmt: skip
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=Chart.gshhg("l"), proof=1.0)
    for route in found.routes:
        assert (route.track.setting == 2).all()
    assert found.best.time_h == pytest.approx(found.best.distance_nm / 14.0, rel=1e-3)
    assert 0.0 < found.lower_bound <= found.best.cost
