"""Plans by indicators: weighted sums, limits of totals, fronts of two, alternatives."""

import json
import math
from dataclasses import replace
from functools import partial

import matplotlib.image
import numpy as np
import pytest

from tests.planning.test_comfort_plans import DATA, DEPART, PERIOD, _sea
from thalweg.chart import Chart
from thalweg.chart.canals import CANALS
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.objective import Objective
from thalweg.planning import Voyage, alternative_plans, indicator_front, plan
from thalweg.planning.indicators import route_choices
from thalweg.planning.indicators.route_choices import named_routes
from thalweg.planning.indicators.route_figures import (
    COMPARED_FIGURES,
    best_of_all,
    champions,
    difference_in_words,
    waiting_in_words,
)
from thalweg.planning.pareto.limited_plan import plan_within_limits
from thalweg.planning.pareto.weighted_sums import (
    KeyFigureRange,
    key_figure,
    key_figure_notes,
    normalised_objective,
)
from thalweg.planning.report.filled_weather import filled_waves_note
from thalweg.route import Track, evaluate
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.ship.consumption import calm_water_consumption, consumption_table, leg_prices

ISLANDS = {"type": "Polygon", "coordinates": [
    [[0.3, 65.02], [0.7, 65.02], [0.7, 65.05], [0.3, 65.05], [0.3, 65.02]]
]}  # fmt: skip
TRAFFIC = {
    "type": "FeatureCollection", "elsewhere": {"encounters_per_nm": 0.1},
    "features": [{"type": "Feature", "properties": {"encounters_per_nm": 2.0, "name": "fairway"},
                  "geometry": {"type": "Polygon", "coordinates": [
                      [[0.2, 64.97], [0.8, 64.97], [0.8, 65.01], [0.2, 65.01], [0.2, 64.97]]]}}],
}  # fmt: skip


@pytest.fixture(scope="module")
def ship():
    return Ship.from_dict(DATA)


def _voyage(**more):
    shape = {"layers": 3, "fan": 3, "offset_nm": 3.0}
    given = {"method": "exact", "layered": shape, "offing_nm": 0.0, "speed_block_h": 0.0}
    return Voyage(start=(65.0, 0.0), goal=(65.0, 1.0), depart=DEPART, **(given | more))


def _plan(ship, chart=None, **more):
    chart = Chart.open_water() if chart is None else chart
    return plan(_voyage(**more), ship=ship, sea=_sea(), chart=chart, proof=0.0)


@pytest.mark.slow
def test_prices_of_a_weighted_sum_add_up(ship):
    both = leg_prices(Objective(fuel=2.0, comfort=0.5, time=36.0, distance=1852.0), ship)
    assert both.consumption == "mixed" and both.outside == both.inside == 1.0
    assert both.time == pytest.approx(0.01) and both.length == pytest.approx(1.0)
    table = consumption_table(ship, "mixed", both.mix)
    where = {"wave_height": 2.0, "wave_angle": 0.3, "wave_period": 8.0}
    fuel = consumption_table(ship, "fuel").lookup(where, 1) * 2.0 / 1000.0
    dose = consumption_table(ship, "squared_dose").lookup(where, 1) * 0.5
    assert float(table.lookup(where, 1)) == pytest.approx(float(fuel + dose), rel=1e-5)
    calm = calm_water_consumption(ship, "mixed", both.mix)
    assert calm == pytest.approx(calm_water_consumption(ship, "fuel") * 2.0 / 1000.0)
    assert both.counts_dose and both.counts_water


def test_a_weighted_sum_with_two_prices_of_fuel_is_refused():
    bulker = Ship.load("handysize-bulker").with_prices(300.0, 1.5)
    with pytest.raises(InputError, match="control areas"):
        leg_prices(Objective(cost=1.0, energy=1.0), bulker)


def test_weights_are_over_the_range_of_the_single_optima():
    ranges = {"fuel": KeyFigureRange(0.25, 2.0, 4.0), "time": KeyFigureRange(0.75, 5.0, 5.0)}
    objective = normalised_objective(ranges, "USD")
    assert objective.prices == {"fuel": pytest.approx(0.125)}
    assert "fuel 0.25 (2 to 4)" in key_figure_notes(ranges)[0]
    assert "No route differs in time" in key_figure_notes(ranges)[1]


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"objective": "weighted"}, "no weights"),
        ({"weights": {"fuel": 1.0}}, "objective is 'time'"),
        ({"objective": "weighted", "weights": {"fuell": 1.0}}, "fuell"),
        ({"objective": "weighted", "weights": {"fuel": -1.0}}, "zero or more"),
        ({"at_most": {"sick": 1.0}}, "sick"),
        ({"at_least": {"workable_percent": "much"}}, "number"),
        ({"at_least": {"workable_percent": 120.0}}, "in per cent, 0 to 100"),
        ({"at_most": {"sick_percent:mess": -4.0}}, "in per cent, 0 to 100"),
        ({"at_most": {"time": -3.0}}, "at_most of time is -3.0. It is a number of zero or more"),
        ({"at_least": {"land_distance_nm": -1.0}}, "of zero or more"),
    ],
)
def test_requests_that_are_not_possible_are_refused(given, text):
    with pytest.raises(InputError, match=text):
        _voyage(**given)


def test_voyages_with_weights_and_limits_are_read_back(tmp_path):
    voyage = _voyage(
        objective="weighted", weights={"fuel": 1, "comfort": 2}, at_most={"sick_percent:mess": 20}
    )
    voyage.save(tmp_path / "voyage.yaml")
    assert Voyage.load(tmp_path / "voyage.yaml").to_dict() == voyage.to_dict()


@pytest.fixture(scope="module")
def chart():
    return Chart.from_geojson(ISLANDS).with_traffic(TRAFFIC)


NAMES = ("time", "fuel", "comfort", "encounters", "inshore", "distance")


@pytest.fixture(scope="module")
def singles(ship, chart):
    return {name: _plan(ship, chart, objective=name) for name in NAMES}


@pytest.mark.slow
def test_every_single_optimum_is_no_worse_in_its_figure_than_the_others(singles):
    for name in NAMES:
        own = key_figure(singles[name].best, name)
        others = [key_figure(p.best, name) for key, p in singles.items() if key != name]
        assert own <= min(others) * (1.0 + 2e-3) + 1e-9, name
    fewest = singles["encounters"].best
    assert fewest.encounters < 0.6 * singles["time"].best.encounters
    assert any("counted on the network only" in text for text in singles["encounters"].notes)


@pytest.mark.slow
def test_weighted_sums_are_no_better_than_single_optima_and_on_the_front(ship, chart, singles):
    weighted = _plan(ship, chart, objective="weighted", weights={"fuel": 1.0, "comfort": 1.0})
    best = weighted.best
    low = {name: key_figure(singles[name].best, name) for name in ("fuel", "comfort")}
    assert best.fuel_t >= low["fuel"] * (1 - 1e-3)
    assert best.comfort >= low["comfort"] * (1 - 1e-3)
    objective = weighted.front.objective
    assert set(objective.prices) == {"fuel", "comfort"}
    assert weighted.objective_value == pytest.approx(objective.value(best))
    for other in (singles["fuel"].best, singles["comfort"].best):
        assert objective.value(best) <= objective.value(other) * (1 + 2e-3)
    front = indicator_front(
        _voyage(), ("fuel", "comfort"), ship=ship, sea=_sea(), chart=chart
    )  # fmt: skip
    values = [objective.value(route) for route in front.routes]
    assert objective.value(best) == pytest.approx(min(values), rel=0.01)
    text = json.loads(weighted.to_json())
    assert text["front"]["prices"] == objective.prices and weighted.unit == ""


@pytest.mark.slow
def test_the_front_of_fuel_and_comfort_is_that_of_all_walks(ship):
    """Weighted searches against every walk at every choice of speed, in weather that changes."""
    from tests.planning.test_comfort_plans import _all_walks, _front, _wave_channels
    from thalweg.core.limits import Limits
    from thalweg.network import layered_network
    from thalweg.search import MultiSettingShipOnNetwork
    from thalweg.ship.comfort.dose_table import squared_dose_table

    ends = [(65.0, 0.0), (65.0, 1.0)]
    network = layered_network(Chart.open_water(), ends, layers=3, fan=3, offset=5556.0)
    lat, lon = network.stations.lat, network.stations.lon
    fields = _sea().freeze_stations(lat, lon, DEPART, DEPART + 20 * 3600.0, _wave_channels())

    def walks(table):
        on_network = MultiSettingShipOnNetwork(network, fields, ship.tabulate(), table, Limits())
        return [cost for _, cost in _all_walks(on_network)]

    every = list(zip(np.array(walks(ship.tabulate_fuel())) / 1000.0,
                     walks(squared_dose_table(ship))))  # fmt: skip
    best = _front(every)
    found = indicator_front(
        _voyage(), ("fuel", "comfort"), ship=ship, sea=_sea(), chart=Chart.open_water()
    )
    assert found.gaps.max() < 0.02
    assert found.values[:, 0].min() == pytest.approx(best[0][0], rel=2e-3)
    assert found.values[:, 1].min() == pytest.approx(best[-1][1], rel=2e-3)
    a, b, c = found.bounds.T
    for fuel, dose in every:  # no walk is below a bound
        assert (a * fuel + b * dose >= c * (1 - 1e-3)).all()
    for fuel, dose in found.values:  # every point is near a walk that nothing dominates
        near = min(max(fuel / x - 1.0, dose / y - 1.0) for x, y in best)
        assert near < 0.02
    rows = found.to_dict()["points"]
    assert all(abs(row["fuel"] / row["network_fuel"] - 1.0) < 0.02 for row in rows)
    assert found.lower_at(float(found.values[0, 0])) <= found.values[0, 1] * (1 + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("names", [("time", "comfort"), ("time", "fuel"), ("fuel", "comfort")])
def test_fronts_are_certified_to_one_percent_and_end_at_single_optima(ship, names):
    """Prestegardshus (2020), ch. 3.6: time against comfort, with the certificate of its network."""
    found = indicator_front(_voyage(), names, ship=ship, sea=_sea(), chart=Chart.open_water())
    assert found.gaps.max() < 0.005 and len(found.routes) >= 3
    for column, name in enumerate(names):
        a, b, c = found.bounds[column]  # the first searches are of one key figure each
        assert (a, b)[1 - column] == 0.0 < (a, b)[column]
        least = (a, b)[column] * found.values[:, column].min()
        assert c <= least * (1 + 1e-9) and least == pytest.approx(c, rel=5e-3), name
    first, second = found.values.T
    assert (np.diff(first) > 0.0).all() and (np.diff(second) < 0.0).all()


def test_sums_and_limits_are_for_one_forecast(ship):
    members = Sea.ensemble(_sea(), _sea())
    refused = partial(plan, ship=ship, sea=members, chart=Chart.open_water())
    with pytest.raises(InputError, match="ranges of one network in one forecast"):
        refused(_voyage(objective="weighted", weights={"fuel": 1.0, "comfort": 1.0}))
    with pytest.raises(InputError, match="limits are for one forecast"):
        refused(_voyage(objective="time", at_most={"fuel": 1.0}))


@pytest.mark.slow
def test_limits_of_totals_are_kept_at_the_least_cost(ship):
    free = _plan(ship, objective="time")
    sick = free.best.indicators["places"]["mess"]["sick_percent"]
    limit = 0.8 * sick
    kept = _plan(ship, objective="time", at_most={"sick_percent": limit})
    assert kept.best.indicators["places"]["mess"]["sick_percent"] <= limit
    assert kept.best.time_h > free.best.time_h
    assert kept.objective_value == kept.best.time_h and len(kept.routes) == 1
    assert any(
        "Limits of the route: people sick at the end (sick_percent) at most" in text
        for text in kept.notes
    )
    assert kept.voyage.at_most == {"sick_percent": limit}
    easy = _plan(ship, objective="time", at_most={"sick_percent": 2.0 * sick})
    assert easy.best.time_h == free.best.time_h
    with pytest.raises(
        NoRouteError,
        match=r"No route was found with people sick at the end \(sick_percent\) at most 0\.1",
    ):
        _plan(ship, objective="time", at_most={"sick_percent": 0.1})
    with pytest.raises(InputError, match="not known on this voyage"):
        _plan(ship, objective="time", at_most={"encounters": 5.0})


@pytest.mark.slow
def test_where_no_front_keeps_a_limit_routes_by_other_ways_do(ship):
    """A plan was refused although alternatives of the same voyage kept the limit."""
    free = _plan(ship, objective="time")
    limit = 0.8 * free.best.indicators["places"]["mess"]["sick_percent"]
    other = _plan(ship, objective="time", at_most={"sick_percent": limit}).best
    voyage = _voyage(objective="time", at_most={"sick_percent": limit})
    found = plan_within_limits(voyage, lambda _: free, lambda: [free.best, other])
    assert found.best is other
    assert found.objective_value == other.time_h > free.best.time_h
    assert found.lower_bound <= free.best.time_h
    with pytest.raises(NoRouteError, match="No route was found"):
        plan_within_limits(voyage, lambda _: free, lambda: [free.best])


@pytest.mark.slow
def test_a_front_keeps_the_routes_within_the_limits(ship):
    whole = _plan(ship, objective="front")
    latest = float(np.median([route.time_h for route in whole.routes]))
    part = _plan(ship, objective="front", at_most={"time": latest})
    assert 0 < len(part.routes) < len(whole.routes)
    assert max(route.time_h for route in part.routes) <= latest
    assert len(part.front.values) == len(part.routes) == len(part.front.ways)


@pytest.mark.parametrize("names", [("fuel", "fuel"), ("fuel", "wind")])
def test_fronts_of_other_than_two_key_figures_are_refused(ship, names):
    with pytest.raises(InputError):
        indicator_front(_voyage(), names, ship=ship, sea=_sea(), chart=Chart.open_water())


def test_encounters_need_traffic_that_is_known_everywhere(ship):
    with pytest.raises(InputError, match="no traffic is given"):
        _plan(ship, objective="encounters")
    partly = Chart.open_water().with_traffic({**TRAFFIC, "elsewhere": None})
    with pytest.raises(InputError, match="traffic is not known on"):
        _plan(ship, partly, objective="encounters")


@pytest.mark.slow
def test_alternatives_differ_and_each_is_best_in_something(ship, chart, tmp_path):
    given = {"ship": ship, "sea": _sea(), "chart": chart}
    found = alternative_plans(_voyage(arrive_by=DEPART + 8 * 3600.0), **given)
    assert 2 <= len(found.choices) <= 5
    assert len({one.name for one in found.choices}) == len(found.choices)
    times = [one.route.time_h for one in found.choices]
    assert times == sorted(times) and "fastest" in found.choices[0].best_in
    assert all(one.best_in for one in found.choices)
    assert found.choices[0].difference == "the fastest"
    assert any("% sick instead of" in one.difference for one in found.choices[1:])
    assert found.slack_h[0] == pytest.approx(8.0 - times[0])
    files = found.write(tmp_path)
    rows = (tmp_path / "alternatives.csv").read_text().splitlines()
    assert len(rows) == 1 + len(found.choices) and "sick_percent:bridge" in rows[0]
    assert {"alternatives.json", "map.png", "alternative_1.rtz"} <= {path.name for path in files}
    assert matplotlib.image.imread(tmp_path / "map.png").std() > 0.05  # not an empty picture
    assert json.loads((tmp_path / "alternatives.json").read_text())["alternatives"]
    (tmp_path / "alternative_5.rtz").write_text("of an earlier plan")
    replace(found, choices=found.choices[:2], slack_h=found.slack_h[:2]).write(tmp_path)
    assert sorted(path.name for path in tmp_path.glob("*.rtz")) == [
        "alternative_1.rtz", "alternative_2.rtz"]  # fmt: skip
    with pytest.raises(InputError, match="2 to 5"):
        alternative_plans(_voyage(), **given, most=1)


@pytest.mark.slow
def test_alternatives_in_open_water_have_few_turns(ship, chart):
    """Off land and in waves, where the paths of a network have its directions."""
    voyage = Voyage(start=(65.0, 0.0), goal=(65.0, 1.0), depart=DEPART, offing_nm=0.0)
    found = alternative_plans(voyage, ship=ship, sea=_sea(), chart=chart)
    assert len(found.choices) > 1
    for one in found.choices:
        turns = np.abs(np.degrees(course_changes(one.route.track.lat, one.route.track.lon)))
        assert np.count_nonzero(turns > 30.0) <= 4, one.name


@pytest.mark.slow
def test_the_route_of_least_fuel_has_no_directions_of_the_network(ship, chart):
    """Past an island off the direct line: the shortest path of the network is 1.3 % longer."""
    voyage = Voyage(start=(64.95, 0.0), goal=(65.12, 1.0), depart=DEPART, offing_nm=0.0)
    found = alternative_plans(voyage, ship=ship, sea=_sea(), chart=chart)
    fastest, least = (
        min((one.route for one in found.choices), key=key)
        for key in (lambda route: route.time_h, lambda route: route.fuel_t)
    )
    assert least.fuel_t < 0.9 * fastest.fuel_t
    assert least.distance_nm == pytest.approx(fastest.distance_nm, rel=0.003)
    assert all(one.best_in for one in found.choices)


@pytest.mark.slow
def test_alternatives_say_why_there_is_no_route_of_least_motion_sickness(chart):
    plain = Ship.from_dict({key: value for key, value in DATA.items() if key != "places"})
    found = alternative_plans(_voyage(), ship=plain, sea=_sea(), chart=chart)
    assert any("she has no named places" in note for note in found.notes)
    assert all("sickness" not in one for choice in found.choices for one in choice.best_in)


@pytest.mark.slow
def test_a_ship_whose_speed_depends_on_wind_only_has_a_route_of_least_sickness(chart):
    """Her speed loss reads no direction and period of waves; her motions do."""
    hull = DATA["hull"] | {"type": "general_cargo"}
    kwon = Ship.from_dict(DATA | {"hull": hull, "models": {"speed_loss": "kwon_2008"}})
    voyage = Voyage(start=(65.0, 0.0), goal=(65.0, 1.0), depart=DEPART, offing_nm=0.0)
    found = alternative_plans(voyage, ship=kwon, sea=_sea().filled(wind=0.0), chart=chart)
    assert not any("No route for comfort" in note for note in found.notes)
    assert any("least motion sickness" in one.best_in for one in found.choices)


def test_waits_of_alternatives_are_in_words(ship):
    """A ship without a hotel load waits free of fuel, which the words state."""
    track = Track.from_positions([(65.0, 0.0), (65.0, 0.5), (65.0, 1.0)], depart=DEPART)
    waits = track.replaced(wait=np.array([0.0, 3.0 * 3600.0, 0.0]))
    route = evaluate(waits, ship=ship, sea=Sea.calm())
    words = "; 3.0 h of it waiting, which takes no fuel (no hotel load in the ship file)"
    assert waiting_in_words(route) == words
    assert waiting_in_words(evaluate(track, ship=ship, sea=Sea.calm())) == ""


def test_champions_and_differences_in_words():
    fast = {"time": 10.0, "fuel": 3.0, "sick_percent": 30.0, "distance": 100.0, "encounters": 1.0}
    calm = {"time": 10.5, "fuel": 3.0, "sick_percent": 12.0, "distance": 108.0,
            "encounters": math.nan}  # fmt: skip
    other = dict.fromkeys(
        ("cost", "land_distance_nm", "near_ground_h", "workable_percent", "max_acceleration",
         "worst_hour_percent", "contour_distance_nm", "inshore_percent"), math.nan)  # fmt: skip
    best = champions([fast | other, calm | other])
    assert best == {"time": 0, "sick_percent": 1, "distance": 0}
    words = difference_in_words(calm, fast)
    assert words == "+30 min, 12 % sick instead of 30 %, +8 nm"
    assert difference_in_words(fast, fast) == "nearly the same figures"
    boat = fast | other | {"time": 2.0, "fuel": 0.031, "distance": 12.0}
    thrifty = boat | {"fuel": 0.027, "distance": 11.4}  # were +0.004 t fuel, +1 nm
    assert difference_in_words(boat, thrifty) == "+4.00 kg fuel (+15 %), +0.6 nm"
    assert champions([boat, thrifty])["fuel"] == 1  # both were 0.03 t
    dear = [
        fast | other | {"time": t, "cost": c}
        for t, c in ((260, 491.5), (300, 473.8), (354, 471.8), (769, 975.5))
    ]
    assert champions(dear)["cost"] == 2  # 2 less than the faster one
    near = [fast | other | {"inshore_percent": share} for share in (18.0, 20.0, 40.0)]
    assert "inshore_percent" not in champions(near[:2])  # no shelter worth the word
    assert champions(near)["inshore_percent"] == 2
    close = calm | {"sick_percent": 29.6}  # in a table both are 30 %
    assert "sick_percent" not in champions([fast | other, close | other])
    nearly = [calm | other | {"sick_percent": value} for value in (8.8, 7.9)]
    assert champions(nearly)["sick_percent"] == 1  # 9 and 8 % in a table
    work = [calm | other | {"time": t, "workable_percent": w} for t, w in ((7, 99.06), (8, 100.0))]
    assert champions(work)["workable_percent"] == 1  # what is missing to 100 % counts


def test_routes_by_other_canals_are_not_called_the_same_way(monkeypatch):
    """By Kiel on an ocean voyage was 'the way of route 2', which led round the Skaw."""
    way = [(54.0, 1.0), (55.0, 4.0)]
    slow = Ship.simple(speed_kn=8.0, draught_m=5.0)
    routes = [
        evaluate(way, ship=ship, sea=Sea.calm(), depart=DEPART)
        for ship in (Ship.simple(speed_kn=12.0, draught_m=5.0), slow)
    ]
    water = Chart.open_water(53.0, 56.0, 0.0, 5.0)
    own = routes, routes, water, slow.file.hull
    assert named_routes(*own)[1].difference.startswith("the way of route 1")
    by = {id(routes[0]): [], id(routes[1]): [next(one for one in CANALS if one.name == "kiel")]}
    monkeypatch.setattr(route_choices, "canals_passed", lambda route, chart: by[id(route)])
    assert "the way of route" not in named_routes(*own)[1].difference


def test_a_slower_route_has_the_way_of_the_nearest_length():
    """It had that of the first that differs little, 20 nm longer than the one it sails."""
    share = np.linspace(0.0, 1.0, 9)
    zigzag = np.where(np.arange(9) % 2, 0.06, 0.0)
    ways = list(zip(54.0 + share + zigzag, 1.0 + 3.0 * share)), [(54.0, 1.0), (55.0, 4.0)]
    fast, slow = (Ship.simple(speed_kn=speed, draught_m=5.0) for speed in (12.0, 8.0))
    around, straight, late = (
        evaluate(way, ship=ship, sea=Sea.calm(), depart=DEPART)
        for way, ship in ((ways[0], fast), (ways[1], fast), (ways[1], slow))
    )
    water = Chart.open_water(53.0, 56.0, 0.0, 5.0)
    routes = [around, straight, late]
    third = named_routes(routes, routes, water, slow.file.hull)[2]
    assert third.difference.startswith("the way of route 2, slower:")
    two = [around, late]
    second = named_routes(two, two, water, slow.file.hull)[1]
    miles = late.distance_nm - around.distance_nm
    assert miles < -1.2
    assert second.difference.startswith(f"the way of route 1, slower and {miles:+.0f} nm:")


@pytest.mark.slow
def test_least_fuel_is_that_of_the_plan_also_on_the_way_of_the_fastest(ship, chart):
    """With time to spare all places went to other waters: 'least fuel' was the fastest route."""
    voyage = _voyage(arrive_by=DEPART + 8 * 3600.0)
    found = alternative_plans(voyage, ship=ship, sea=_sea(), chart=chart)
    least = next(one for one in found.choices if "least fuel" in one.best_in)
    alone = plan(replace(voyage, objective="fuel"), ship=ship, sea=_sea(), chart=chart, proof=0.0)
    assert least.route.fuel_t <= 1.05 * alone.routes[-1].fuel_t


@pytest.mark.slow
def test_the_cheapest_alternative_costs_no_more_than_the_plan(ship, chart):
    """It takes more than half as much again as the fastest: with a price of time it may."""
    voyage = replace(_voyage(), fuel_price_usd=600.0, time_price_usd_per_h=20.0)
    found = alternative_plans(voyage, ship=ship, sea=_sea(), chart=chart)
    least = next(one for one in found.choices if "cheapest" in one.best_in)
    request = replace(voyage, objective="cost")
    alone = plan(request, ship=ship, sea=_sea(), chart=chart, proof=0.0)
    assert least.route.cost <= 1.005 * alone.routes[-1].cost


def test_none_is_called_best_in_what_another_candidate_is_better_in():
    values = [{name: 1.0 for name in COMPARED_FIGURES} for _ in range(3)]
    values[0] |= {"time": 9.8, "fuel": 1.46}
    values[1] |= {"time": 10.4, "fuel": 1.6}
    values[2] |= {"time": 13.8, "fuel": 0.5}
    assert best_of_all(values[:2], values) == {"time": 0}
    assert best_of_all(values, values) == {"time": 0, "fuel": 2}


@pytest.mark.slow
def test_an_arrival_that_is_too_early_is_refused_with_the_earliest_one(ship, chart):
    with pytest.raises(NoRouteError, match="earliest arrival is"):
        voyage = _voyage(arrive_by=DEPART + 3600.0)
        alternative_plans(voyage, ship=ship, sea=_sea(), chart=chart)


def _half_known_sea():
    """Waves as they are, but unknown east of 0.5 E."""
    functions = {
        "sea_surface_wave_significant_height": lambda t, lat, lon: (
            np.where(np.asarray(lon) < 0.5, 1.0, np.nan) + 0.0 * t
        ),
        PERIOD: lambda t, lat, lon: 8.0,
        "sea_surface_wave_from_direction": lambda t, lat, lon: 0.0,
        "eastward_wind": lambda t, lat, lon: 0.0,
        "northward_wind": lambda t, lat, lon: 0.0,
    }
    return Sea.from_functions(functions, time_step=1800.0)


def test_the_share_of_filled_waves_is_stated_for_each_route(ship):
    known = evaluate([(65.0, 0.0), (65.0, 0.5)], ship=ship, sea=_sea(), depart=DEPART)
    assert filled_waves_note([known], _sea()) == ""
    filled = _half_known_sea().filled(waves=1.5)
    routes = [
        evaluate(line, ship=ship, sea=filled, depart=DEPART)
        for line in ([(65.0, 0.0), (65.0, 1.0)], [(65.0, 0.0), (65.0, 0.4)])
    ]
    note = filled_waves_note(routes, filled)
    assert note.startswith("Waves are filled, not of the data") and "2: 0 %" in note
    assert 45.0 < float(note.partition("1: ")[2].partition(" ")[0]) < 55.0
