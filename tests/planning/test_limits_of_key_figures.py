"""Plans whose fuel, cost or time is limited use the whole of what is allowed."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.objective import Objective
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR
from thalweg.planning.pareto.limited_plan import plan_within_limits
from thalweg.sea.standard_names import EASTWARD_CURRENT, NORTHWARD_CURRENT
from thalweg.ship.consumption import leg_prices

SHIP = {
    "name": "plain cargo ship",
    "hull": {
        "length_between_perpendiculars_m": 140,
        "breadth_m": 22,
        "draught_m": 8,
        "block_coefficient": 0.75,
    },
    "speeds_kn": [10, 12, 14],
    "engine": {
        "reference_speed_kn": 14,
        "reference_power_kw": 5000,
        "type": "slow_speed_diesel",
        "power_kw": 6000,
        "hotel_load_kw": 300,
    },
    "models": {"calm_water": "cubic"},
    "fuel": {"type": "vlsfo", "eca_type": "mgo", "price_per_t": 520, "eca_price_per_t": 720,
             "reference_t_per_day": 24},
    "costs": {"hire_per_day": 20000},
}  # fmt: skip
OPEN = Chart.open_water(-2.0, 2.0, -1.0, 9.0)


@pytest.fixture(scope="module")
def planned():
    """Return plans of one voyage, each made once."""
    kept = {}

    def one(objective, **limits):
        key = objective, *limits.items()
        if key not in kept:
            voyage = Voyage(
                start=(0.0, 0.0),
                goal=(0.0, 8.0),
                depart="2026-12-01",
                objective=objective,
                at_most=limits,
            )
            ship = Ship.from_dict(SHIP)
            kept[key] = plan(voyage, ship=ship, sea=Sea.calm(), chart=OPEN, proof=0.0)
        return kept[key]

    return one


@pytest.mark.slow
def test_the_fastest_within_a_fuel_limit_uses_the_fuel(planned):
    """Two speeds share the way so that the fuel is just the limit."""
    limit = 28.1
    found = planned("time", fuel=limit)
    assert 0.998 * limit < found.best.fuel_t <= limit
    assert found.gap < 0.05  # that of the least time without the limit is 0.11
    note = next(text for text in found.notes if "Limits of the route" in text)
    more = found.best.time_h - planned("time").best.time_h
    assert f"They cost {more:.4g} h more" in note
    assert "--speed-step 0.5 counts those between" in note


@pytest.mark.slow
def test_the_least_fuel_in_a_time_is_that_with_the_latest_arrival(planned):
    found = planned("fuel", time=39.0)
    assert 38.9 < found.best.time_h <= 39.0
    swapped = planned("time", fuel=found.best.fuel_t)
    assert swapped.best.time_h == pytest.approx(39.0, rel=3e-3)


@pytest.mark.slow
def test_the_least_cost_within_a_fuel_limit_is_found(planned):
    """Fuel has another price in control areas: this was refused as a weighted sum."""
    free = planned("cost")
    limit = 0.9 * free.best.fuel_t
    found = planned("cost", fuel=limit)
    assert 0.998 * limit < found.best.fuel_t <= limit
    assert found.best.cost > free.best.cost
    assert found.best.time_h == pytest.approx(planned("time", fuel=limit).best.time_h, rel=1e-3)


@pytest.fixture(scope="module")
def in_a_tide():
    """Return plans in a uniform tide of 1.5 m/s: 8, 10 and 12 kn over 128 nm."""
    coaster = Ship.from_dict(
        {
            "name": "coaster", "hull": {"draught_m": 5.2}, "speeds_kn": [8.0, 10.0, 12.0],
            "engine": {"reference_speed_kn": 12.0, "reference_power_kw": 2000,
                       "hotel_load_kw": 150, "sfoc_g_per_kwh": 200},
            "fuel": {"type": "mgo"}, "models": {"calm_water": "cubic"},
        }
    )  # fmt: skip
    start = parse_time("2026-03-01T00:00Z")

    def east(time, lat, lon):
        phase = (time - start) / HOUR - 4.0
        return 1.5 * np.cos(2.0 * np.pi * phase / 12.4) + 0.0 * lat

    sea = Sea.from_functions(
        {EASTWARD_CURRENT: east, NORTHWARD_CURRENT: lambda time, lat, lon: 0.0 * lat}
    )
    chart = Chart.open_water(50.0, 52.0, -0.2, 4.2).without_eca()

    def one(objective, proof=0.0, **more):
        voyage = Voyage(
            start=(51.0, 0.3), goal=(51.0, 3.7), depart="2026-03-01T03:00Z", objective=objective,
            **more,
        )  # fmt: skip
        given = {"ship": coaster, "sea": sea, "chart": chart, "resolution": 10_000.0}
        return plan(voyage, **given, proof=proof)

    return one


@pytest.mark.slow
def test_a_limit_of_time_has_the_bound_of_a_latest_arrival(in_a_tide):
    """It had the bound of the least fuel at any time: 40 % and more below the plan."""
    limited = in_a_tide("fuel", proof=2.0, at_most={"time": 11.0})
    arriving = in_a_tide("fuel", arrive_by="2026-03-01T14:00Z")
    assert limited.best.fuel_t == pytest.approx(arriving.best.fuel_t, rel=1e-6)
    assert limited.lower_bound > 0.95 * limited.best.fuel_t


@pytest.mark.slow
def test_blocks_of_speed_are_shorter_where_long_ones_leave_much_of_a_limit(in_a_tide):
    """10 kn for 3 h, then 8 kn, is 14.62 h; a quarter of the voyage at 10 kn burns too much."""
    found = in_a_tide("time", at_most={"fuel": 2.5})
    assert 2.45 < found.best.fuel_t <= 2.5
    assert found.best.time_h < 14.7
    assert any(note.startswith("Blocks of speed are") for note in found.notes)


@pytest.mark.slow
def test_where_one_fuel_is_burnt_a_limit_needs_few_plans(planned):
    """Sums of cost and fuel were searched five times over, though time and fuel give the cost."""
    counted = []

    def one(voyage):
        counted.append(str(voyage.objective))
        return plan(voyage, ship=Ship.from_dict(SHIP), sea=Sea.calm(), chart=OPEN, proof=0.0)

    limit = 0.9 * planned("cost").best.fuel_t
    voyage = replace(planned("cost").voyage, at_most={"fuel": limit})
    found = plan_within_limits(voyage, one)
    assert counted[:2] == ["cost", "fuel"]
    assert "weighted" not in counted and len(counted) <= 5
    assert found.best.fuel_t <= limit


@pytest.mark.slow
def test_a_front_within_a_fuel_limit_begins_where_it_is_just_kept(planned):
    """The front of time and cost ends at the least cost, which burns more."""
    limit = 0.9 * planned("cost").best.fuel_t
    found = planned("front", fuel=limit)
    assert found.front.criterion == "cost"
    assert all(route.fuel_t <= limit for route in found.routes)
    assert found.routes[0].fuel_t > 0.998 * limit
    assert len(found.routes) == len(found.front.values) == len(found.front.ways)


def test_prices_of_one_consumption_add_up_in_and_out_of_control_areas():
    ship = Ship.from_dict(SHIP)
    cost, fuel = (leg_prices(Objective.of(name), ship) for name in ("cost", "fuel"))
    both = leg_prices(Objective(cost=1.0, fuel=100.0), ship)
    assert both.consumption == "fuel" and not both.mix
    assert both.inside == pytest.approx(cost.inside + 100.0 * fuel.inside)
    assert both.outside == pytest.approx(cost.outside + 100.0 * fuel.outside)
    assert both.inside / both.outside != pytest.approx(cost.inside / cost.outside)
    assert both.time == cost.time and both.dues == cost.dues
    assert both.waiting == pytest.approx(cost.waiting + 100.0 * fuel.waiting)
