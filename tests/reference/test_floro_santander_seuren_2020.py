"""Florø to Santander round the North Sea control area: money at fixed passage times.

Lengths and costs are those of exact shortest paths on GSHHG i as published (visibility graphs,
price factor of the control area 1.5593) for the three routes of the case of Seuren (2020), with his
ship: table 5.3, 300 USD/t. Costs are of the best mix of speeds in each zone for the passage time.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from thalweg.chart import Chart
from thalweg.core.geodesy import positions_along
from thalweg.core.limits import Limits
from thalweg.core.units import DAY, NAUTICAL_MILE, TONNE
from thalweg.planning import Voyage, plan
from thalweg.planning.plan_front import certain_at
from thalweg.route import RefinementConditions, Route, Track, evaluate, refine_cost
from thalweg.sea import Sea
from thalweg.ship import Ship

START, GOAL = (61.604, 5.03), (43.47, -3.7645)
SHIP = Ship.from_dict(
    {
        **Ship.load("handysize-bulker").data,
        "models": {"calm_water": "table", "speed_loss": "none"},
        "limits": {},
    }
)
RATE = np.array(SHIP.data["table"]["fuel_t_per_day"]) * TONNE / DAY
PRICE = {True: 0.3 * 1.5593, False: 0.3}
# Round Dover; between Fair Isle and Orkney, Kyle Rhea, the Irish Sea; along 62 N and 4 W.
WAYS = {
    "R1": [
        (61.6016, 5.0136), (61.5953, 4.9722), (61.5867, 4.9558), (61.3016, 4.6627),
        (52.4481, 1.758), (51.1533, 1.3943), (51.1096, 1.3317), (51.0884, 1.2935),
        (50.9104, 0.9751), (48.5744, -4.7066), (48.5604, -4.7308), (48.5064, -4.7805),
        (48.4167, -4.7977), (48.3258, -4.7864), (48.0416, -4.7402),
    ],
    "R2": [
        (61.5723, 4.7656), (61.44, 4.2427), (60.1177, -0.4055), (59.7638, -1.551),
        (59.0621, -3.9707), (58.8057, -4.5861), (58.6201, -5.0216), (57.8567, -5.8139),
        (57.4964, -5.8837), (57.3371, -5.8147), (57.2831, -5.7353), (57.2653, -5.6594),
        (57.2553, -5.6454), (57.2403, -5.6524), (57.2201, -5.6605), (57.2127, -5.6634),
        (56.7064, -6.2514), (56.6098, -6.3241), (56.4702, -6.376), (56.3493, -6.3823),
        (56.2943, -6.3905), (56.0291, -6.2868), (56.004, -6.2661), (55.9384, -6.1246),
        (55.9121, -6.1138), (55.7995, -6.0699), (55.7231, -6.0225), (55.3452, -5.8382),
        (54.4854, -5.4307), (54.4193, -5.4368), (50.3601, -5.786), (50.0166, -5.7054),
    ],
    "R3": [
        (61.6476, 4.8854), (61.6731, 4.8167), (62.0005, 4.2118), (62.0005, -4.0005),
        (61.9309, -4.0451), (58.2265, -6.1502), (57.4383, -6.7972), (56.7503, -6.4758),
        (56.6564, -6.4435), (56.3141, -6.4511), (56.0358, -6.2809), (56.0193, -6.2059),
        (55.9374, -6.1241), (55.8144, -6.0758), (55.7665, -6.049), (54.484, -5.4308),
        (50.2619, -5.7836),
    ],
}  # fmt: skip
LENGTHS = {"R1": (929.5, 305.0), "R2": (310.3, 980.0), "R3": (29.8, 1379.6)}
THOUSANDS = {  # of USD at 3.7, 4.04, 4.28, 5 and 6 days
    "R1": (44.63, 42.55, 41.09, 37.09, 35.64),
    "R2": (40.24, 36.12, 34.82, 32.00, 29.76),
    "R3": (None, 39.51, 36.01, 33.18, 29.41),
}
DAYS = (3.7, 4.04, 4.28, 5.0, 6.0)
CASES = [
    (way, days, cost)
    for way, costs in THOUSANDS.items()
    for days, cost in zip(DAYS, costs)
    if cost is not None
]


@pytest.fixture(scope="module")
def chart() -> Chart:
    return Chart.gshhg("i", narrows_closed=False, islets=False).with_eca(
        "north-sea"
    )  # R2: Kyle Akin


def as_route(track: Track, chart: Chart) -> Route:
    return evaluate(track, ship=SHIP, sea=Sea.calm(), chart=chart, min_ukc=None)


@pytest.fixture(scope="module")
def fastest(chart) -> dict[str, Route]:
    """The routes at the highest setting, legs split where they cross the border of the area."""
    found = {}
    for name, middle in WAYS.items():
        places = np.array([START, *middle, GOAL])
        lat, lon = places.T
        share = chart.zones.eca_fraction(lat[:-1], lon[:-1], lat[1:], lon[1:])
        cut = [tuple(places[0])]
        for k, part in enumerate(share):
            if 1e-6 < part < 1.0 - 1e-6:
                at = part if chart.zones.in_eca(*places[k]) else 1.0 - part
                cut.append(tuple(float(x) for x in positions_along(*places[k], *places[k + 1], at)))
            cut.append(tuple(places[k + 1]))
        found[name] = as_route(Track.from_positions(cut, depart=0), chart)
    return found


def best_mix(zones: dict[bool, float], seconds: float) -> dict[bool, np.ndarray]:
    """Return metres sailed at every setting inside and outside, by linear programming."""
    speed = np.asarray(SHIP.speeds)
    names = list(zones)
    cost = np.concatenate([PRICE[name] * RATE / speed for name in names])
    time = np.concatenate([1.0 / speed for _ in names])
    sums = np.kron(np.eye(len(names)), np.ones(len(speed)))
    scale = 1e5  # metres
    answer = linprog(
        cost, A_ub=time[None], b_ub=[seconds / scale], A_eq=sums,
        b_eq=np.array([zones[name] for name in names]) / scale,
    )  # fmt: skip
    assert answer.status == 0
    return dict(zip(names, scale * answer.x.reshape(len(names), -1)))


def at_mix(route: Route, inside: np.ndarray, mix: dict[bool, np.ndarray]) -> Track:
    """Return the track with legs split where the setting changes, the fast part of a zone first."""
    track = route.track
    left = {name: parts.copy() for name, parts in mix.items()}
    places, settings = [track.positions[0]], []
    for leg, length in enumerate(route.legs["length"]):
        rest, done = float(length), 0.0
        parts = left[bool(inside[leg])]
        while rest > 1e-3:
            open_ = np.flatnonzero(parts > 1e-3)
            setting = int(open_[-1]) if len(open_) else settings[-1]
            piece = min(rest, parts[setting]) if len(open_) else rest
            parts[setting] -= piece
            done, rest = done + piece, rest - piece
            ends = (*track.positions[leg], *track.positions[leg + 1])
            at = positions_along(*ends, done / length) if rest > 1e-3 else ends[2:]
            places.append((float(at[0]), float(at[1])))
            settings.append(setting)
    lat, lon = np.array(places).T
    return Track(lat, lon, 0.0, None, settings)


def zones_of(route: Route, chart: Chart) -> tuple[np.ndarray, dict[bool, float]]:
    track = route.track
    share = chart.zones.eca_fraction(track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:])
    inside = share > 0.5
    length = route.legs["length"]
    return inside, {True: float(length[inside].sum()), False: float(length[~inside].sum())}


@pytest.mark.slow
@pytest.mark.parametrize("way", list(WAYS))
def test_lengths_of_the_routes(fastest, chart, way):
    route = fastest[way]
    assert route.feasible, route.violations
    _, zones = zones_of(route, chart)
    assert route.distance_nm == pytest.approx(sum(LENGTHS[way]), rel=4e-3)
    assert zones[True] / NAUTICAL_MILE == pytest.approx(LENGTHS[way][0], abs=5.0)


@pytest.mark.parametrize(("way", "days", "thousands"), CASES)
def test_cheapest_speeds_for_the_time(fastest, chart, way, days, thousands):
    inside, zones = zones_of(fastest[way], chart)
    route = as_route(at_mix(fastest[way], inside, best_mix(zones, days * DAY)), chart)
    assert route.feasible
    assert route.time_h <= 24.0 * days + 1e-3
    assert route.cost / 1000.0 == pytest.approx(thousands, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize(("way", "days"), [("R1", 4.28), ("R2", 5.0)])
def test_cost_refinement_finds_the_speeds_or_better(fastest, chart, way, days):
    inside, zones = zones_of(fastest[way], chart)
    mixed = as_route(at_mix(fastest[way], inside, best_mix(zones, days * DAY)), chart)
    route = refine_cost(
        fastest[way],
        RefinementConditions(
            ship=SHIP,
            sea=Sea.calm(),
            chart=chart,
            table=SHIP.tabulate(),
            limits=Limits(),
            min_ukc=None,
        ),
        fuel=SHIP.tabulate_fuel(),
        arrive_by=days * DAY,
    )
    assert route.feasible
    assert route.time_h <= 24.0 * days + 1e-3
    assert route.cost <= mixed.cost * 1.0005
    assert route.cost > 0.95 * mixed.cost


@pytest.fixture(scope="module")
def planned(chart, whole_fronts):
    voyage = Voyage(offing_nm=0.0,
        start=START, goal=GOAL, depart="2026-01-01T00:00Z", objective="front",
        fuel_price_usd=300.0, eca_price_factor=1.5593,
    )  # fmt: skip
    return plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart)


@pytest.mark.slow
@pytest.mark.parametrize("days", DAYS)
def test_the_front_of_a_plan_costs_the_same_as_the_exact_routes(planned, days):
    best = min(costs[DAYS.index(days)] or np.inf for costs in THOUSANDS.values())
    hours = np.array([route.time_h for route in planned.routes])
    # between two points of the front a ship may sail part of the way as in each
    cost = float(np.interp(24.0 * days, hours, planned.front.values)) / 1000.0
    assert cost == pytest.approx(best, rel=0.01)


@pytest.mark.slow
def test_the_front_of_a_plan_holds_all_three_alternative_routes(planned):
    lengths = np.array([route.distance_nm for route in planned.routes])
    for wanted in (sum(LENGTHS[way]) for way in WAYS):
        assert np.abs(lengths / wanted - 1.0).min() < 0.003
    assert np.all(np.diff(planned.front.values) < 0.0)
    for route, cost in zip(planned.routes, planned.front.values):
        assert cost >= certain_at(planned.front.certain, route.time_h) * (1.0 - 1e-9)
