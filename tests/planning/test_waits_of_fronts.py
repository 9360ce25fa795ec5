"""Least fuel and cost of ships that wait: the limits open between the times of the network."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Track, Voyage, plan
from thalweg.core.objective import FUEL_MASS
from thalweg.core.time import parse_time
from thalweg.planning.pareto.evolutionary_refinement import evaluator_around_routes
from thalweg.planning.pareto.waiting.wait_screening import WaitScreen
from thalweg.planning.pareto.waiting.waits_of_fronts import (
    with_fewer_waits_of_front,
    with_waits_long_enough,
)
from thalweg.planning.report.waiting_report import waiting_weather_warnings
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.voyage_context import voyage_context

TUG = """
name: Tug
hull:
  {length_between_perpendiculars_m: 28.0, breadth_m: 9.8, draught_m: 4.4, block_coefficient: 0.55}
speeds_kn: [6, 8, 10, 12]
engine: {reference_speed_kn: 12, reference_power_kw: 2400, sfoc_g_per_kwh: 205, hotel_load_kw: 60}
fuel: {type: mgo, price_per_t: 780}
costs: {hire_per_day: 4500}
models: {calm_water: cubic, speed_loss: kwon_2008}
limits: {max_significant_wave_height_m: 2.5, min_under_keel_clearance_m: 2.4}
"""
START, GOAL, DEPART = (10.15, 123.55), (10.15, 123.95), "2026-07-01T00:00Z"
CHART = Chart.open_water(10.0, 10.3, 123.5, 124.0)


@pytest.fixture(scope="module")
def tug(tmp_path_factory):
    path = tmp_path_factory.mktemp("ship") / "tug.yaml"
    path.write_text(TUG)
    return Ship.load(path)


@pytest.fixture(scope="module")
def bar():
    """A bar with a gully of 6.2 m, over which the tide is high enough from 06:50 on."""
    lat, lon = np.arange(10.0, 10.3001, 0.01), np.arange(123.5, 124.001, 0.01)
    depth = np.full((lat.size, lon.size), 18.0)
    on_bar = (lon > 123.705) & (lon < 123.765)
    depth[:, on_bar] = 1.0
    depth[np.ix_(np.abs(lat - 10.15) < 0.016, on_bar)] = 6.2
    hours = np.arange(0.0, 36.0, 1.0 / 6.0)
    level = 1.2 * np.cos(2 * np.pi * (hours - 9.0) / 12.42)
    level += 0.15 * np.cos(2 * np.pi * (hours - 8.0) / 6.21)
    times = np.datetime64("2026-07-01", "ns") + (60 * hours).astype(int) * np.timedelta64(1, "m")
    names = {
        "zeta": "sea_surface_height_above_geopotential_datum",
        "h": "sea_floor_depth_below_geoid",
    }
    everywhere = np.broadcast_to(level[:, None, None], (hours.size, lat.size, lon.size))
    data = xr.Dataset(
        {
            "zeta": (
                ("time", "lat", "lon"),
                everywhere,
                {"standard_name": names["zeta"], "units": "m"},
            ),
            "h": (("lat", "lon"), depth, {"standard_name": names["h"], "units": "m"}),
        },
        {
            "time": times,
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        },
    )
    return Sea.open(data).filled(waves=0.0, wind=0.0, currents=0.0)


@pytest.fixture(scope="module")
def planned(tug, bar):
    """Plans of the tug over the bar by their conditions, each made once."""
    made = {}

    def of_conditions(**conditions):
        key = repr(sorted(conditions.items()))
        if key not in made:
            voyage = Voyage(
                start=START, goal=GOAL, depart=DEPART, arrive_by="2026-07-01T16:00Z", **conditions
            )
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr("thalweg.planning.pareto.front_bound.least_ways._SECONDS", 4.0)
                made[key] = plan(voyage, ship=tug, sea=bar, chart=CHART)
        return made[key]

    return of_conditions


def context_of(tug, bar):
    voyage = Voyage(start=START, goal=GOAL, depart=DEPART)
    return voyage_context(voyage, tug, bar, CHART, NetworkChoice("auto", None, None))[0]


@pytest.fixture(scope="module")
def at_lowest_speed(planned):
    return planned(speed_kn=6.0).best


@pytest.mark.slow
def test_the_least_fuel_past_a_bar_is_that_of_the_lowest_speed(planned, at_lowest_speed):
    """It was that of the highest speed, three times as much: all others came too early."""
    found = planned(objective="fuel")
    assert found.best.feasible
    assert found.best.fuel_t == pytest.approx(at_lowest_speed.fuel_t, rel=0.01)
    assert len(found.routes) > 3
    assert all(route.feasible for route in found.routes)
    assert all(np.count_nonzero(route.track.wait) <= 1 for route in found.routes)


@pytest.mark.slow
def test_no_speed_held_throughout_beats_the_front(planned):
    """Between the routes of the network were gaps of an hour."""
    found = planned(objective="fuel")
    for speed in (6.0, 8.0, 10.0):
        held = planned(speed_kn=speed).best
        assert any(
            route.time_h <= 1.002 * held.time_h and route.fuel_t <= 1.005 * held.fuel_t
            for route in found.routes
        )


@pytest.mark.slow
def test_a_ship_between_two_speeds_does_not_wait_longer_than_needed(planned, at_lowest_speed):
    """The first part of the way at 6 knots and the rest at 8 is cheaper than each speed held."""
    found = planned(objective="cost")
    held = [at_lowest_speed, *(planned(speed_kn=speed).best for speed in (7.0, 8.0))]
    assert found.objective_value < 0.99 * min(route.cost for route in held)
    assert np.flatnonzero(found.best.track.wait).tolist() == [0]
    assert np.unique(found.best.track.setting).tolist() == [0, 1]


@pytest.mark.slow
def test_a_front_has_routes_at_two_speeds_after_one_wait(planned):
    found = planned(objective="front")
    pairs = {
        tuple(np.unique(route.track.setting).tolist())
        for route in found.routes
        if np.flatnonzero(route.track.wait).tolist() == [0]
    }
    assert {len(pair) for pair in pairs} == {1, 2}
    assert all(route.feasible for route in found.routes)


@pytest.mark.slow
def test_the_bound_of_the_cost_counts_the_wait_that_no_ship_is_spared(planned, at_lowest_speed):
    """The hire of the least time, and the hotel load, are paid by all: 11 %, it was 53."""
    found = planned(objective="cost")
    assert found.gap < 0.13
    least_time = planned(objective="time").proof.certain
    assert found.proof.certain > 4500.0 / 24.0 * least_time
    assert (
        found.front.values >= [np.interp(r.time_h, *found.front.certain) for r in found.routes]
    ).all()
    fuel = planned(objective="fuel")
    assert fuel.gap < 0.06
    assert fuel.proof.certain <= at_lowest_speed.fuel_t


@pytest.mark.slow
@pytest.mark.parametrize("conditions", [{"objective": "time"}, {"speed_kn": 8.0}])
def test_the_wait_for_the_tide_is_at_the_start(planned, conditions):
    """It was 4 nm out, although the ship arrives as early from her berth."""
    route = planned(**conditions).best
    assert route.feasible
    assert np.flatnonzero(route.track.wait).tolist() == [0]


@pytest.mark.slow
def test_a_limit_of_fuel_that_a_slower_ship_keeps_is_no_refusal(bar, tmp_path):
    """Two speeds on a coarse network suffice: at the higher one she burns more than the limit."""
    path = tmp_path / "tug.yaml"
    path.write_text(TUG.replace("[6, 8, 10, 12]", "[6, 12]"))
    voyage = Voyage(
        start=START, goal=GOAL, depart=DEPART, arrive_by="2026-07-01T16:00Z", at_most={"fuel": 0.59}
    )
    found = plan(voyage, ship=Ship.load(path), sea=bar, chart=CHART, resolution=2500.0)
    assert found.best.feasible
    assert found.best.fuel_t < 0.59


def test_a_wait_is_lengthened_until_the_limit_is_kept(tug, bar, at_lowest_speed):
    context = context_of(tug, bar)
    track = at_lowest_speed.track
    assert at_lowest_speed.feasible and np.count_nonzero(track.wait) == 1
    total = float(track.wait.sum())
    early = np.zeros(track.wait.size)
    early[0] = total - 600.0
    broken = context.evaluate(track.replaced(wait=early))
    assert not broken.feasible
    kept = with_waits_long_enough(context, broken, context.evaluate)
    assert kept.feasible
    assert np.flatnonzero(kept.track.wait).tolist() == [0]
    assert float(kept.track.wait[0]) == pytest.approx(total, abs=60.0)
    # the route without a breach stays, and no wait helps against water that is always too shallow
    assert with_waits_long_enough(context, kept, context.evaluate) is kept
    deep = context.evaluate(track.replaced(lat=track.lat + 0.1))
    assert with_waits_long_enough(context, deep, context.evaluate) is deep


def test_many_waits_become_one_at_the_start(tug, bar, at_lowest_speed):
    context = context_of(tug, bar)
    ends = at_lowest_speed.track.lat[[0, -1]], at_lowest_speed.track.lon[[0, -1]]
    lat, lon = (np.linspace(*two, 9) for two in ends)
    wait = np.zeros(9)
    wait[:3] = at_lowest_speed.track.wait.sum() / 3.0 + 120.0
    wait[5:7] = 300.0
    track = Track(lat, lon, at_lowest_speed.depart, wait, np.zeros(8, int))
    many = context.evaluate(track)
    assert many.feasible
    found = with_fewer_waits_of_front(many, context.evaluate, lambda route: route.time_h, context)
    assert found.feasible
    assert np.flatnonzero(found.track.wait).tolist() == [0]
    assert found.time_h <= many.time_h


def trade_off_of(context):
    return SimpleNamespace(
        context=context,
        consumption=context.ship.tabulate_fuel(),
        limits=context.needs.limits,
        objective=SimpleNamespace(prices=FUEL_MASS),
    )


def test_the_screen_refuses_waits_that_end_before_the_bar_opens(tug, bar, at_lowest_speed):
    context = context_of(tug, bar)
    screen = WaitScreen(evaluator_around_routes(trade_off_of(context), [at_lowest_speed]))
    track = at_lowest_speed.track
    waits = np.outer([0.1, 0.5, 1.0, 1.05], track.wait)
    found = screen.screened(track, waits)
    assert found.may_keep.tolist() == [False, False, True, True]
    assert found.arrive[2, len(track) - 1] == pytest.approx(at_lowest_speed.arrive, abs=60.0)
    under_way = 1000.0 * at_lowest_speed.fuel_t - at_lowest_speed.legs["waiting_fuel"].sum()
    assert found.cost[2] == pytest.approx(under_way, rel=0.01)  # waits have no price here


def test_a_route_of_a_front_waits_at_the_berth_where_it_would_in_waves_above_the_limit():
    """Waves of 3 m are at 0.6E from hour 4.5 to 6.4, and behind it until hour 8."""

    def height(time, lat, lon):
        hour = (time - parse_time(DEPART)) / 3600.0
        at_wait = (np.abs(lon - 0.6) < 0.05) & (hour > 4.5) & (hour < 6.4)
        behind = (np.abs(lon - 0.9) < 0.05) & (hour < 8.0)
        return np.where(at_wait | behind, 3.0, 0.5) + 0.0 * lat

    sea = Sea.from_functions({"sea_surface_wave_significant_height": height})
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, fuel_t_per_day=12.0, max_wave_height_m=2.0)
    chart = Chart.open_water(-0.5, 0.5, -0.5, 2.0)
    voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 1.6), depart=DEPART)
    context = voyage_context(voyage, ship, sea, chart, NetworkChoice("auto", None, None))[0]
    lon = 0.2 * np.arange(9)
    wait = np.where(np.arange(9) == 3, 3.0 * 3600.0, 0.0)
    at_sea = context.evaluate(Track(0.0 * lon, lon, DEPART, wait, np.zeros(8, int)))
    assert at_sea.feasible and waiting_weather_warnings(at_sea, ship)
    screen = WaitScreen(evaluator_around_routes(trade_off_of(context), [at_sea]))

    def fuel(route):
        return route.fuel_t

    found = with_fewer_waits_of_front(at_sea, context.evaluate, fuel, context, screen)
    assert found.feasible and not waiting_weather_warnings(found, ship)
    assert found.time_h <= 1.1 * at_sea.time_h
    assert found.fuel_t <= 1.1 * at_sea.fuel_t
    assert np.asarray(found.track.wait)[0] > 0.0
