"""Plans that trade time for fuel, cost or CO2, in worlds where the best is known."""

import json
import math
from functools import cache

import numpy as np
import pytest

from thalweg import Chart, InputError, NoRouteError, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.time import parse_time
from thalweg.network import fixed_route
from thalweg.planning.ensemble_plan import MAX_EVALUATED_ROUTES, _routes_to_evaluate
from thalweg.planning.pareto import trade_off_context

START, GOAL = (0.0, 0.0), (0.0, 2.0)
CHART = Chart.open_water(-1.0, 1.0, -0.5, 2.5)
KNOT, HOUR = 1852.0 / 3600.0, 3600.0
LENGTH = float(distance(*START, *GOAL))


def cubic_ship(speeds=(6.0, 8.0, 10.0, 12.0), **fuel):
    data = {
        "name": "cubic",
        "hull": {"draught_m": 5.0},
        "speeds_kn": list(speeds),
        "engine": {"reference_speed_kn": 12.0},
        "fuel": {"reference_t_per_day": 24.0, **fuel},
        "models": {"calm_water": "cubic"},
    }
    return Ship.from_dict(data)


def fuel_per_second(speed_kn):
    """Fuel rate of the ship above [t/s]."""
    return 24.0 / 86400.0 * (speed_kn / 12.0) ** 3


def still(objective, ship, **more):
    voyage = Voyage(start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective=objective, **more)
    return plan(voyage, ship=ship, sea=Sea.calm(), chart=CHART, resolution=20_000.0)


@cache
def still_front(method=None):
    """The front of the ship above in still water."""
    return still("front", cubic_ship(), **({"method": method} if method else {}))


@pytest.mark.slow
def test_least_fuel_is_the_slowest_speed_on_the_geodesic():
    answer = still("fuel", cubic_ship())
    wanted = fuel_per_second(6.0) * LENGTH / (6.0 * KNOT)
    assert answer.best.fuel_t == pytest.approx(wanted, rel=1e-3)
    assert answer.objective_value == answer.best.fuel_t and answer.unit == "t"
    assert answer.lower_bound <= answer.objective_value
    assert answer.proof.certain == pytest.approx(wanted, rel=1e-3)


@pytest.mark.slow
def test_with_a_deadline_two_neighbouring_speeds_are_mixed(brief_fronts, monkeypatch):
    monkeypatch.setattr(trade_off_context, "WHOLE_FRONT", brief_fronts)  # as for users
    # at 9 kn on the mean, time is shared between 8 and 10 kn so that the distance is covered
    hours = LENGTH / (9.0 * KNOT) / HOUR
    arrive = 1767225600.0 + hours * HOUR
    answer = still("fuel", cubic_ship(), arrive_by=arrive)
    share = 0.5  # of the time at each of the two speeds
    wanted = hours * HOUR * (share * fuel_per_second(8.0) + share * fuel_per_second(10.0))
    assert answer.best.arrive <= arrive + 1.0
    assert answer.best.fuel_t == pytest.approx(wanted, rel=0.002)
    assert answer.best.fuel_t >= wanted * (1.0 - 1e-4)


@pytest.mark.slow
def test_for_one_objective_a_few_faster_routes_are_given_as_well():
    one, whole = still("fuel", cubic_ship()), still_front()
    assert one.best.fuel_t == pytest.approx(whole.routes[-1].fuel_t, rel=1e-6)
    assert 3 <= len(one.routes) < len(whole.routes)
    fastest = min(route.time_h for route in one.routes)
    assert fastest == pytest.approx(whole.routes[0].time_h, rel=1e-6)


@pytest.mark.slow
def test_the_front_runs_from_fastest_to_cheapest_and_is_non_dominated():
    answer = still_front()
    time = np.array([route.time_h for route in answer.routes])
    fuel = np.array([route.fuel_t for route in answer.routes])
    assert np.all(np.diff(time) > 0) and np.all(np.diff(fuel) < 0)
    assert time[0] == pytest.approx(LENGTH / (12.0 * KNOT) / HOUR, rel=1e-3)
    assert fuel[-1] == pytest.approx(fuel_per_second(6.0) * LENGTH / (6.0 * KNOT), rel=1e-3)
    # the true front is the lower hull of the four pure speeds
    speeds = np.array([12.0, 10.0, 8.0, 6.0])
    pure_time = LENGTH / (speeds * KNOT) / HOUR
    pure_fuel = [fuel_per_second(s) * LENGTH / (s * KNOT) for s in speeds]
    best = np.interp(time, pure_time, pure_fuel)
    assert np.all(fuel >= best * (1.0 - 1e-4))
    assert np.all(fuel <= best * 1.01)
    gaps = [gap for gap in answer.front.gaps(answer.routes) if gap is not None]
    # 32 directions may be 1.3 % longer than open water; fuel goes with the time to the power -3
    assert gaps and max(gaps) < 0.07


@pytest.mark.slow
def test_least_cost_weighs_time_against_fuel():
    # cost per metre (p k v^3 + c) / v is least where 2 p k v^3 = c
    price, per_hour = 500.0, 2.0 * 500.0 * 24.0 / 24.0 * (10.0 / 12.0) ** 3
    prices = {"fuel_price_usd": price, "time_price_usd_per_h": per_hour}
    answer = still("cost", cubic_ship(), method="exact", **prices)
    hours = LENGTH / (10.0 * KNOT) / HOUR
    wanted = price * fuel_per_second(10.0) * hours * HOUR + per_hour * hours
    assert answer.best.cost == pytest.approx(wanted, rel=1e-3)
    assert answer.best.time_h == pytest.approx(hours, rel=1e-3)
    assert answer.unit == "USD"


NEAR = (0.0, 0.2)  # the period to search grows with the distance
NEAR_CHART = Chart.open_water(-0.1, 0.1, -0.05, 0.25)
NEAR_LENGTH = float(distance(*START, *NEAR))


def against(head_kn, speeds, **more):
    """Plan 12 nm against a steady current, exactly on the network."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat - head_kn * KNOT,
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        },
        time_step=HOUR,
    )
    more = {"objective": "front", "method": "exact", **more}
    voyage = Voyage(start=START, goal=NEAR, depart="2026-01-01T00:00Z", **more)
    return plan(voyage, ship=cubic_ship(speeds), sea=sea, chart=NEAR_CHART, resolution=2000.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speeds", "best"),
    [
        ((4.0,), 4.0),  # the only one: 1 kn over ground, four times as long as in still water
        ((4.0, 5.0, 6.0, 8.0), 5.0),  # V^3 / (V - 3): 64, 62.5, 72, 102.4
        ((4.0, 4.5, 5.0, 6.0, 8.0, 10.0), 4.5),  # one and a half times the current
        ((2.0, 2.5, 6.0, 8.0), 6.0),  # the slowest never arrive
    ],
)
def test_the_front_reaches_to_the_cheapest_however_slow_the_current_makes_it(speeds, best):
    answer = against(3.0, speeds)
    hours = NEAR_LENGTH / ((best - 3.0) * KNOT) / HOUR
    cheapest = answer.routes[-1]
    assert cheapest.time_h == pytest.approx(hours, rel=1e-3)
    assert cheapest.fuel_t == pytest.approx(fuel_per_second(best) * hours * HOUR, rel=1e-3)
    fastest = NEAR_LENGTH / ((max(speeds) - 3.0) * KNOT) / HOUR
    assert answer.routes[0].time_h == pytest.approx(fastest, rel=1e-3)


@pytest.mark.slow
def test_the_earliest_arrival_is_reported_however_slow_the_current_makes_it():
    depart = 1767225600.0
    with pytest.raises(NoRouteError) as refusal:
        against(3.0, (4.0,), arrive_by=depart + 2.0 * HOUR)
    hours = (parse_time(refusal.value.details["earliest"]) - depart) / HOUR
    assert hours == pytest.approx(NEAR_LENGTH / KNOT / HOUR, rel=1e-3)


@pytest.mark.slow
def test_a_current_faster_than_the_ship_is_the_reason():
    with pytest.raises(NoRouteError) as refusal:
        against(6.0, (4.0, 5.0))
    assert "current" in refusal.value.remedy


@pytest.mark.slow
def test_waiting_is_rarely_chosen_in_constant_conditions():
    answer = still_front("exact")
    bins = 25.1 / 720  # a ship may wait for the next bin of time
    assert all(route.waiting_h <= 2 * bins for route in answer.routes)


def test_what_the_front_saves_over_constant_speeds_is_reported():
    answer = still_front()
    rows = answer.front.comparison.rows
    assert [row["speed_kn"] for row in rows] == pytest.approx([12.0, 10.0, 8.0, 6.0])
    assert all(abs(row["saved"]) < 0.01 * row["value"] for row in rows)  # still water: nothing


@pytest.mark.slow
def test_the_json_contains_the_complete_front():
    answer = still("front", cubic_ship(), fuel_price_usd=500.0, method="exact")
    told = json.loads(answer.to_json())
    assert told["front"]["criterion"] == "cost" and told["front"]["unit"] == "USD"
    assert len(told["front"]["points"]) == len(told["routes"])
    for point, route in zip(told["front"]["points"], told["routes"]):
        assert point["time_h"] == route["time_h"] and point["cost_usd"] == route["cost_usd"]
    assert told["comparison"]


@pytest.mark.slow
def test_the_same_request_gives_the_same_plan():
    first, second = still_front(), still("front", cubic_ship())
    assert [r.time_h for r in first.routes] == [r.time_h for r in second.routes]
    assert [r.fuel_t for r in first.routes] == [r.fuel_t for r in second.routes]


def test_the_exact_method_alone_is_possible_and_marked():
    answer = still_front("exact")
    assert set(answer.front.stages) <= {"exact", "fastest", "constant speed"}


def test_too_early_an_arrival_is_refused_with_the_earliest():
    hours = LENGTH / (12.0 * KNOT) / HOUR
    with pytest.raises(NoRouteError) as refusal:
        still("fuel", cubic_ship(), arrive_by=1767225600.0 + 0.9 * hours * HOUR)
    assert "earliest arrival" in refusal.value.possible
    earliest = refusal.value.details["earliest"]
    assert earliest.startswith("2026-01-01T10:0")  # 120 nm at 12 kn


def test_cost_without_a_price_is_refused():
    with pytest.raises(InputError, match="no price"):
        still("cost", cubic_ship())


def test_co2_of_an_unknown_fuel_is_refused():
    with pytest.raises(InputError, match="fuel is not known"):
        still("co2", cubic_ship())


@pytest.mark.slow
def test_co2_is_fuel_times_carbon():
    answer = still("co2", cubic_ship(type="HFO"), method="exact")
    assert answer.objective_value == pytest.approx(3.114 * answer.best.fuel_t, rel=1e-6)


@pytest.mark.parametrize(
    "more",
    [
        {"fuel_price_usd": -1.0},
        {"eca_price_factor": 0.0},
        {"method": "nsga3"},
        {"objective": "front", "depart_window": ("2026-01-01", "2026-01-02"), "depart": None},
        {"ensemble": "median"},
        {"seed": -1},
        {"seed": 0.5},
        {"depart_window": 5, "depart": None},
        {"depart_window": "no", "depart": None},
    ],
)
def test_impossible_requests_are_refused(more):
    request = {"start": START, "goal": GOAL, "depart": "2026-01-01T00:00Z", **more}
    with pytest.raises(InputError):
        Voyage(**request)


def test_a_ship_without_fuel_has_no_front():
    ship = Ship.simple(speeds_kn=[8.0, 10.0])
    with pytest.raises(InputError, match="fuel"):
        still("front", ship)


def test_unknown_canals_are_refused_with_near_matches():
    voyage = Voyage(start=START, goal=GOAL, depart="2026-01-01T00:00Z", forbid=["sues"])
    with pytest.raises(InputError, match="suez"):
        plan(voyage, ship=cubic_ship(), sea=Sea.calm(), chart=Chart.gshhg("c"))


def test_a_voyage_with_prices_round_trips(tmp_path):
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective="cost", forbid=["suez"],
        fuel_price_usd=500.0, eca_price_factor=1.5, time_price_usd_per_h=10.0, method="exact",
    )  # fmt: skip
    voyage.save(tmp_path / "v.yaml")
    assert Voyage.load(tmp_path / "v.yaml") == voyage
    assert not math.isnan(voyage.fuel_price_usd)


@pytest.mark.slow
def test_the_routes_with_least_fuel_are_evaluated_in_all_members():
    """They come with the best first and the rest by time: the first ten would be the fastest."""
    answer = still("fuel", cubic_ship(), method="exact")
    picked = _routes_to_evaluate(answer)
    assert len(answer.routes) > MAX_EVALUATED_ROUTES == len(picked)
    assert picked[0] == 0
    left_out = np.delete(answer.front.values, picked)
    assert answer.front.values[picked].max() <= left_out.min()


def test_a_choice_over_members_needs_members():
    with pytest.raises(InputError, match="not have members"):
        still("fuel", cubic_ship(), ensemble="mean")


@pytest.mark.slow
def test_slower_settings_remain_where_waves_forbid_the_highest():
    # 1.8 sqrt(150) = 22.05 kn dead astern: 24 kn would surf, 18 kn does not
    ship = Ship.from_dict(
        {
            "name": "surfing",
            "hull": {
                "length_between_perpendiculars_m": 150.0,
                "breadth_m": 25.0,
                "draught_m": 8.0,
                "block_coefficient": 0.7,
                "roll_period_s": 14.0,
            },
            "speeds_kn": [12.0, 18.0, 24.0],
            "engine": {"reference_speed_kn": 24.0},
            "fuel": {"reference_t_per_day": 24.0},
            "models": {"calm_water": "cubic"},
            "limits": {"msc_circ_1228": ["surf_riding"]},
        }
    )
    astern = {
        "sea_surface_wave_significant_height": 4.0,
        "sea_surface_wave_to_direction": 90.0,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": 9.0,
    }
    sea = Sea.from_functions(
        {name: lambda t, lat, lon, value=value: value + 0 * lat for name, value in astern.items()}
    )
    voyage = Voyage(start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective="front")
    found = plan(
        voyage,
        ship=ship,
        sea=sea,
        chart=CHART,
        network=lambda chart, start, goal, spacing: fixed_route(
            chart, [start, goal], spacing=10_000.0
        ),
    )
    assert all(route.feasible for route in found.routes)
    assert found.best.time_h == pytest.approx(LENGTH / (18.0 * KNOT) / HOUR, rel=2e-3)
    assert sum("network of your own builder" in note for note in found.notes) == 1


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["fuel", "front"])
def test_no_route_of_a_front_crosses_a_penalty_zone_that_it_can_pass(objective):
    """Over the zone 20 times as dear, round it 2 % longer: speeds and the referee count it too."""
    square = [[0.9, -0.4], [1.1, -0.4], [1.1, 0.1], [0.9, 0.1], [0.9, -0.4]]
    zone = {
        "type": "Feature",
        "properties": {"kind": "penalty", "factor": 20.0, "name": "bank"},
        "geometry": {"type": "Polygon", "coordinates": [square]},
    }
    voyage = Voyage(start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective=objective)
    water = CHART.with_zones(zone)
    ship = cubic_ship((8.0, 12.0))
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=water, resolution=20_000.0)
    assert len(found.routes) > 2 or objective == "fuel"
    for route in found.routes:
        inside = (route.samples["lon"] > 0.905) & (route.samples["lon"] < 1.095)
        assert route.samples["lat"][inside].min() > 0.099
        assert route.distance_nm * 1852.0 < 1.03 * LENGTH
    assert found.lower_bound <= found.objective_value
