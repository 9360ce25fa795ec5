"""Cost refinement: cheaper in the same time, never worse; settings, control areas, canals."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.evolution import jet
from thalweg.chart import Chart
from thalweg.chart.canals import SUEZ
from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.route import (
    RefinementConditions,
    Track,
    better_route,
    evaluate,
    join,
    refine_cost,
    smooth,
)
from thalweg.route.refinement.speed_profile import _efficient_settings, _knapsack
from thalweg.sea import Sea
from thalweg.ship import Ship

OPEN = Chart.open_water()
FREE = Limits()
BULKER = Ship.from_dict(
    {
        **Ship.load("handysize-bulker").data,
        "models": {"calm_water": "table", "speed_loss": "none"},
        "limits": {},
    }
)
LEVEL = 1852.0 / 111319.49079327358  # degrees of longitude in a nautical mile, on the equator


def zone(west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": {"kind": "eca", **properties}, "geometry": geometry}


def refined(route, ship=BULKER, sea=None, chart=OPEN, held=False, **more):
    return refine_cost(
        route,
        RefinementConditions(
            ship=ship,
            sea=Sea.calm() if sea is None else sea,
            chart=chart,
            table=ship.tabulate(),
            limits=FREE,
            holds_settings=held,
        ),
        fuel=ship.tabulate_fuel(),
        **more,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hours", "best", "floor"), [(20, 23.436, 22.977), (24, 19.870, 19.459), (28, 17.633, 17.338)]
)
def test_jet_and_eddies_from_a_straight_line(hours, best, floor):
    """The best known fuel (long evolution) is met to 0.3 %; nothing goes below the floor."""
    ship, sea, chart = jet.ship(), jet.sea(), jet.chart()
    start = evaluate(
        jet.straight(9).to_track(jet.T0), ship=ship, sea=sea, chart=chart, min_ukc=None
    )
    latest = jet.T0 + hours * HOUR / jet.SHRINK
    route = refine_cost(
        start,
        RefinementConditions(
            ship=ship, sea=sea, chart=chart, table=jet.speed_table(), limits=FREE, min_ukc=None
        ),
        fuel=jet.fuel_table(),
        objective="fuel",
        arrive_by=latest,
        fields=jet.fields(),
    )
    assert route.feasible
    assert route.arrive <= latest + 1e-6
    assert floor < route.fuel_t * jet.SHRINK < best * 1.003
    again = evaluate(route.track, ship=ship, sea=sea, chart=chart, min_ukc=None)
    assert again.fuel_t == route.fuel_t


CUBIC_KN = np.round(np.arange(8.0, 16.0001, 0.1), 3)


def cubic_ship() -> Ship:
    """Fuel of k V^3 with V in knots and k of 1 kg/h, given in tonnes per day."""
    table = {
        "speed_kn": CUBIC_KN.tolist(),
        "fuel_t_per_day": (24e-3 * CUBIC_KN**3).tolist(),
    }
    models = {"calm_water": "table", "speed_loss": "none"}
    return Ship.from_dict(
        {"name": "cubic", "hull": {"draught_m": 5.0}, "table": table, "models": models}
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lengths", "currents", "hours", "speeds", "fuel"),
    [
        ((100, 100), (2.0, -2.0), 16.0, (11.574586, 13.583066), 33058.9008),
        ((100, 100), (2.0, -2.0), 20.0, (9.091126, 11.104332), 21813.8565),
        ((120, 60, 90), (1.5, -1.0, 0.0), 20.0, (12.566179, 13.794702, 13.275398), 45099.6158),
    ],
)
def test_cubic_law_speeds(lengths, currents, hours, speeds, fuel):
    """Closed form 2 V^3 + 3 w V^2 = mu; settings 0.1 kn apart, mixed where they must be."""
    ship = cubic_ship()
    edges = np.concatenate([[0.0], np.cumsum(lengths)]) * LEVEL
    along = np.array(currents) * KNOT

    def east(time, lat, lon):
        return along[np.clip(np.searchsorted(edges, lon) - 1, 0, len(along) - 1)] + 0.0 * time

    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": east,
            "northward_sea_water_velocity": lambda t, a, o: 0.0 * a,
        }
    )
    start = evaluate([(0.0, x) for x in edges], ship=ship, sea=sea, chart=OPEN, depart=0)
    route = refined(start, ship, sea, objective="fuel", arrive_by=hours * HOUR)
    assert route.arrive <= hours * HOUR + 1e-6
    assert route.fuel_t * 1000.0 == pytest.approx(fuel, rel=5e-4)
    middle = 0.5 * (route.track.lon[:-1] + route.track.lon[1:])
    sailed = route.legs["length"] / (route.legs["arrive"] - route.legs["depart"]) / KNOT
    which = np.clip(np.searchsorted(edges, middle) - 1, 0, len(along) - 1)
    for k, speed in enumerate(speeds):
        here = which == k
        mean = route.legs["length"][here].sum() / (route.legs["length"][here] / sailed[here]).sum()
        assert mean - currents[k] == pytest.approx(speed, abs=0.05)


@pytest.mark.slow
def test_slower_inside_a_control_area_at_the_same_arrival():
    """Half the way inside: against the linear program over speeds and zones by brute force."""
    chart = OPEN.with_zones(zone(2, -1, 4.5, 1))
    start = evaluate([(0, 0), (0, 4)], ship=BULKER, sea=Sea.calm(), chart=chart, depart=0)
    length = start.legs["length"].sum() / 2.0
    speeds = np.asarray(BULKER.speeds)
    rate = np.array(BULKER.data["table"]["fuel_t_per_day"]) / 86400.0
    for slower in (1.02, 1.15, 1.4):
        latest = slower * start.arrive
        # best of all mixes of two settings per half, on a fine grid of how time is shared
        shares = np.linspace(0.0, 1.0, 4001)
        outside = _cheapest(length, speeds, 300.0 * rate, latest * shares)
        inside = _cheapest(length, speeds, 300.0 * 1.5593 * rate, latest * (1.0 - shares))
        expected = np.min(outside + inside)
        route = refined(start, chart=chart, arrive_by=latest)
        assert route.arrive <= latest + 1e-6
        assert route.cost == pytest.approx(expected, rel=3e-4)


def _cheapest(length, speeds, rate, time):
    """Return the least cost of a length in a time: the lower hull of (s/m, cost/m)."""
    slowness, cost = 1.0 / speeds, rate / speeds
    best = np.full(len(time), np.inf)
    wanted = time / length
    for a, b in itertools.product(range(len(speeds)), repeat=2):
        low, high = slowness[a], slowness[b]
        if low == high:
            fits = wanted >= low
            best[fits] = np.minimum(best[fits], cost[a])
            continue
        share = np.clip((wanted - low) / (high - low), 0.0, 1.0)
        fits = wanted >= low + share * (high - low) - 1e-12
        mixed = cost[a] + share * (cost[b] - cost[a])
        best[fits] = np.minimum(best[fits], mixed[fits])
    return best * length


@pytest.mark.slow
def test_never_worse_and_invalid_objectives_are_refused():
    start = evaluate([(0, 0), (0, 2)], ship=BULKER, sea=Sea.calm(), chart=OPEN, depart=0)
    same = refined(start)
    assert same.cost <= start.cost
    assert same.arrive <= start.arrive + 1e-6
    with pytest.raises(InputError, match="cost refinement named 'speed'"):
        refined(start, objective="speed")
    unpriced = Ship.from_dict({k: v for k, v in BULKER.data.items() if k != "fuel"})
    with pytest.raises(InputError, match="no price of fuel"):
        refined(start, unpriced)
    with pytest.raises(InputError, match="carbon factor of its fuel"):
        refined(start, unpriced, objective="co2")
    assert refined(start, unpriced, objective="fuel").fuel_t <= start.fuel_t


def by_cubed_speed(**costs):
    """A ship with unknown fuel and prices of time and cubed speed (van Halem 2019)."""
    costs = {"per_week": 700_000.0, "per_second_per_cubed_speed": 0.008, **costs}
    hull, speeds = {"draught_m": 5.0}, [6.0, 8.0, 10.0, 12.0]
    return Ship.from_dict({"name": "x", "hull": hull, "speeds_kn": speeds, "costs": costs})


def by_cost(start, ship, chart, arrive_by):
    table = ship.tabulate()
    return refine_cost(
        start,
        RefinementConditions(ship=ship, sea=Sea.calm(), chart=chart, table=table, limits=FREE),
        fuel=table,
        objective="cost",
        arrive_by=arrive_by,
    )


def test_the_cost_of_time_and_cubed_speed():
    """The cost of a metre is least where 2 lambda_f V^3 = lambda_t: at 8.1 kn, so at 8 kn."""
    ship = by_cubed_speed()
    track = Track([0, 0.4, 0], [0, 1, 2], 0.0, None, [3, 3])
    start = evaluate(track, ship=ship, sea=Sea.calm(), chart=OPEN)
    shortest = evaluate([(0, 0), (0, 2)], ship=ship, sea=Sea.calm(), chart=OPEN, depart=0)
    route = by_cost(start, ship, OPEN, 24 * HOUR)
    speed = 8.0 * KNOT
    per_second = 700_000.0 / 604_800.0 + 0.008 * speed**3
    wanted = per_second * shortest.distance_nm * NAUTICAL_MILE / speed
    assert route.cost == pytest.approx(wanted, rel=1e-4)


@pytest.mark.slow
@settings(max_examples=8, deadline=None)
@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(1.0, 1.5), st.integers(0, 11))
def test_refinement_is_never_worse_for_any_sea_and_start(u, v, later, setting):
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, a, o: u * KNOT * np.cos(3 * o + t / 9000),
            "northward_sea_water_velocity": lambda t, a, o: v * KNOT * np.sin(5 * a - o),
        }
    )
    track = Track([0, 0.3, 0.1, 0.5], [0, 0.5, 1.0, 1.6], 0.0, None, [setting] * 3)
    start = evaluate(track, ship=BULKER, sea=sea, chart=OPEN)
    latest = later * start.arrive
    route = refined(start, sea=sea, objective="co2", arrive_by=latest)
    assert route.feasible
    assert route.arrive <= latest + 1e-6
    assert route.co2_t <= start.co2_t * (1 + 1e-12)


@pytest.mark.slow
def test_refinement_avoids_land():
    island = {
        "type": "Polygon",
        "coordinates": [[[0.9, -0.3], [1.1, -0.3], [1.1, 0.3], [0.9, 0.3], [0.9, -0.3]]],
    }
    chart = Chart.from_geojson(island)
    start = evaluate(
        [(0, 0), (0.6, 1.0), (0, 2)], ship=BULKER, sea=Sea.calm(), chart=chart, depart=0
    )
    route = refined(start, chart=chart, objective="fuel")
    assert route.feasible
    shortest = evaluate(
        [(0, 0), (0.3001, 0.8999), (0.3001, 1.1001), (0, 2)],
        ship=BULKER, sea=Sea.calm(), chart=chart, depart=0,
    )  # fmt: skip
    assert route.distance_nm < 1.01 * shortest.distance_nm
    assert route.fuel_t < 0.9 * start.fuel_t


def test_an_ordered_speed_is_kept_where_settings_are_held():
    lat, lon = np.array([0.0, 0.6, 0.0]), np.array([0.0, 1.0, 2.0])
    middle = len(BULKER.speeds) // 2
    bent = Track(lat, lon, 0.0, setting=np.full(2, middle))
    start = evaluate(bent, ship=BULKER, sea=Sea.calm(), chart=OPEN)
    later = 2.0 * start.arrive
    held = refined(start, objective="fuel", arrive_by=later, held=True)
    assert set(held.track.setting.tolist()) == {middle}
    assert held.distance_nm == pytest.approx(120.0 * 1.00112, rel=1e-3)  # the straight line
    assert refined(start, objective="fuel", arrive_by=later).fuel_t < 0.9 * held.fuel_t


def test_time_lost_to_weather_is_not_used():
    """Waves over the limit come to the second half after 8.3 hours: no slower there than that."""
    ship = Ship.from_dict({**BULKER.data, "limits": {"max_significant_wave_height_m": 4.0}})
    height = "sea_surface_wave_significant_height"
    sea = Sea.from_functions(
        {height: lambda t, a, o: np.where((o > 1.0) & (t > 8.3 * HOUR), 6.0, 1.0)}
    )
    start = evaluate([(0, 0), (0, 1), (0, 2)], ship=ship, sea=sea, chart=OPEN, depart=0)
    assert 7.5 < start.time_h < 8.2 and start.feasible
    route = refine_cost(
        start,
        RefinementConditions(
            ship=ship, sea=sea, chart=OPEN, table=ship.tabulate(), limits=Limits(wave_height=4.0)
        ),
        fuel=ship.tabulate_fuel(),
        objective="fuel",
        arrive_by=12 * HOUR,
        thin=False,
    )
    assert route.feasible
    assert route.arrive <= 8.3 * HOUR + 60.0
    assert route.fuel_t <= start.fuel_t


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 3), st.integers(2, 4), st.floats(0.0, 1.2), st.randoms())
def test_the_knapsack_against_all_choices(legs, count, share, random):
    times = np.sort([[random.uniform(1, 5) for _ in range(count)] for _ in range(legs)], axis=1)
    costs = -np.sort([[-random.uniform(1, 5) for _ in range(count)] for _ in range(legs)], axis=1)
    low, high = times.min(axis=1).sum(), times.max(axis=1).sum()
    room = low + share * (high - low)
    setting, _, part = _knapsack(times, costs, room)
    rows = np.arange(legs)
    time, cost = times[rows, setting].sum(), costs[rows, setting].sum()
    if part is not None:
        leg, slower, portion = part
        time += portion * (times[leg, slower] - times[leg, setting[leg]])
        cost += portion * (costs[leg, slower] - costs[leg, setting[leg]])
    assert time <= room + 1e-9
    for choice in itertools.product(range(count), repeat=legs):
        if times[rows, choice].sum() <= room - 1e-12:  # surely in time, whatever is rounded
            assert cost <= costs[rows, choice].sum() + 1e-9


def test_the_hull_leaves_out_what_no_mix_wants():
    time = np.array([1.0, 2.0, 3.0, 4.0, 2.5])
    assert _efficient_settings(time, np.array([10.0, 9.0, 4.0, 5.0, np.inf])).tolist() == [
        0,
        2,
    ]


# canals and several settings


@pytest.fixture(scope="module")
def world() -> Chart:
    return Chart.gshhg("l").with_eca("mediterranean")


def suez_route(world, **more):
    places = [(33.5, 30.0), (32.6, 31.0), *SUEZ.ends, (28.9, 32.75), (28.2, 33.35)]
    lat, lon = np.array(places).T
    track = Track(lat, lon, 0.0, **more)
    return evaluate(track, ship=BULKER, sea=Sea.calm(), chart=world)


def _through_suez(route) -> bool:
    track = route.track
    number = [k for k in range(len(track) - 1) if abs(route.legs["length"][k] - SUEZ.length) < 1.0]
    return len(number) == 1 and all(
        (track.lat[number[0] + k], track.lon[number[0] + k]) == SUEZ.ends[k] for k in (0, 1)
    )


@pytest.mark.slow
def test_canals_count_by_cubed_speed_where_the_rest_does(world):
    ship = by_cubed_speed(currency="USD")
    lat, lon = np.array([(33.5, 30.0), (32.6, 31.0), *SUEZ.ends, (28.9, 32.75), (28.2, 33.35)]).T
    track = Track(lat, lon, 0.0, None, [3] * 5)
    start = evaluate(track, ship=ship, sea=Sea.calm(), chart=world)
    assert start.feasible and start.cost > SUEZ.fee
    route = by_cost(start, ship, world, start.arrive + 24 * HOUR)
    assert _through_suez(route)
    # the canal costs the same in both; the rest is as cheap as at 8 kn on a way no longer
    at_sea = start.distance_nm * NAUTICAL_MILE - SUEZ.length
    per_second = [700_000.0 / 604_800.0 + 0.008 * (kn * KNOT) ** 3 for kn in (12.0, 8.0)]
    saved = at_sea * (per_second[0] / (12.0 * KNOT) - per_second[1] / (8.0 * KNOT))
    assert start.cost - route.cost >= 0.999 * saved


@pytest.mark.slow
def test_cost_refinement_keeps_the_canal(world):
    start = suez_route(world)
    assert start.feasible, start.violations
    route = refined(start, chart=world, arrive_by=1.3 * start.arrive)
    assert _through_suez(route)
    assert route.arrive <= 1.3 * start.arrive
    assert route.cost < 0.99 * start.cost
    assert route.cost > 112_327.0  # the dues


@pytest.mark.slow
def test_refining_for_time_keeps_the_canal_and_the_settings(world):
    start = suez_route(world, wait=[0, 0, 3600.0, 0, 0, 0], setting=[11, 11, 5, 5, 8])
    better = better_route(
        start,
        RefinementConditions(
            ship=BULKER, sea=Sea.calm(), chart=world, table=BULKER.tabulate(), limits=FREE
        ),
        wait=False,
    )
    assert better.feasible
    assert _through_suez(better)
    assert better.arrive < start.arrive
    sailed = dict.fromkeys(better.track.setting.tolist())
    assert list(sailed) == [11, 5, 8]
    fields = Sea.calm().freeze_grid(27, 35, 29, 34, 0.0, 4 * start.arrive, [], spacing_deg=0.5)
    track = smooth(
        start.track, table=BULKER.tabulate(), fields=fields, limits=FREE, chart=world, wait=False
    )
    again = evaluate(track, ship=BULKER, sea=Sea.calm(), chart=world)
    assert _through_suez(again)
    assert again.arrive <= start.arrive


def test_smoothing_keeps_several_settings():
    track = Track([0, 0.2, -0.2, 0], [0, 1, 2, 3], 0.0, None, [11, 0, 11])
    start = evaluate(track, ship=BULKER, sea=Sea.calm(), chart=OPEN)
    better = better_route(
        start,
        RefinementConditions(
            ship=BULKER, sea=Sea.calm(), chart=OPEN, table=BULKER.tabulate(), limits=FREE
        ),
    )
    assert better.arrive <= start.arrive
    assert list(dict.fromkeys(better.track.setting.tolist())) == [11, 0]
    changes = np.count_nonzero(np.diff(better.track.setting))
    assert changes == 2


def test_joined_routes_add_up(world):
    whole = suez_route(world)
    first = evaluate(whole.track.part(0, 2, 0.0), ship=BULKER, sea=Sea.calm(), chart=world)
    rest = evaluate(whole.track.part(2, 5, first.arrive), ship=BULKER, sea=Sea.calm(), chart=world)
    both = join([first, rest])
    for name in ("fuel_t", "cost", "co2_t", "fuel_eca_t", "distance_nm"):
        assert getattr(both, name) == pytest.approx(getattr(whole, name), rel=1e-9)
    assert both.fuel_by_zone_t == pytest.approx(whole.fuel_by_zone_t)
    assert both.distance_nm * NAUTICAL_MILE > SUEZ.length
