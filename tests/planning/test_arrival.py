"""A given time of arrival: by the speed, by the departure, and what is held on the way."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.sea.small_datasets import regular
from thalweg import Chart, NoRouteError, Sea, Ship, Voyage, plan
from thalweg.core.errors import InputError, NoPathError, OutsidePeriodError
from thalweg.core.geodesy import distance
from thalweg.core.units import HOUR, KNOT
from thalweg.planning import planner
from thalweg.planning.arrival_planner import _arrival_of_trial, _first_departure, _on_time
from thalweg.planning.report.plan_summary import quality_text
from thalweg.planning.request.requirements import period_of_data
from thalweg.planning.single.arrival_search import (
    AIM,
    EARLY,
    ArrivalSearch,
    solve_arrival,
    whole_answer,
)

DEPART = 1767225600.0
LENGTH = float(distance(0.0, 0.0, 0.0, 2.0))
ENDS = {"start": (0.0, 0.0), "goal": (0.0, 2.0)}
CHART = Chart.open_water(-0.6, 0.6, -0.2, 2.2)
WAVES = "sea_surface_wave_significant_height"
SHIP = Ship.load("handysize-bulker")


def sea_with_current(amplitude_kn: float, period: float = math.inf) -> Sea:
    """A current along the route, the same everywhere; with a period it turns like a tide."""

    def east(time, lat, lon):
        return amplitude_kn * KNOT * np.cos(2.0 * np.pi * (time - DEPART) / period) + 0.0 * lat

    names = ("northward_sea_water_velocity", "eastward_wind", "northward_wind", WAVES)
    still = {name: lambda time, lat, lon: 0.0 * lat for name in names}
    return Sea.from_functions({"eastward_sea_water_velocity": east, **still})


def planned(sea: Sea, **voyage):
    given = {"ship": SHIP, "sea": sea, "chart": CHART, "resolution": 10_000.0}
    return plan(Voyage(**ENDS, **voyage), **given)


def mid_speed_time(current_kn: float = 0.0) -> float:
    """Duration at a speed in the middle of the ship's range [s]."""
    return LENGTH / (0.8 * float(SHIP.speeds[-1]) + current_kn * KNOT)


@pytest.mark.slow
@pytest.mark.parametrize("hold", [None, "power", "speed"])
def test_the_speed_found_is_that_of_length_time_and_current(hold) -> None:
    time = mid_speed_time(current_kn=1.0)
    found = planned(sea_with_current(1.0), depart=DEPART, arrive=DEPART + time, hold=hold)
    assert -60.0 <= found.best.arrive - (DEPART + time) <= 1.0
    ordered = found.best.legs["ordered_speed"]
    # the current makes a wind over the water, which slows the ship where the power is held
    accuracy = 2e-3 if hold == "speed" else 1e-2
    assert ordered == pytest.approx(LENGTH / time - KNOT, rel=accuracy)
    held = "constant speed through water" if hold == "speed" else "constant power"
    assert {row["held"] for row in found.best.waypoints()[:-1]} == {held}
    assert found.notes[0].startswith("Constant ")
    lowest = "lowest speed through water" if hold == "speed" else "lowest power"
    assert f", {lowest}, to arrive at " in str(found).splitlines()[0]
    constant = f"; the {lowest.removeprefix('lowest ')} is constant: other speeds on the way may "
    assert f"{constant}take less fuel (--objective fuel --arrive-by TIME)" in quality_text(found)


@pytest.mark.slow
def test_one_speed_over_ground_in_a_current_that_turns() -> None:
    time = mid_speed_time()
    sea = sea_with_current(0.8, period=12.42 * HOUR)
    found = planned(sea, depart=DEPART, arrive=DEPART + time, hold="ground")
    route = found.best
    assert -60.0 <= route.arrive - (DEPART + time) <= 1.0
    over_ground = route.legs["length"] / (route.legs["arrive"] - route.legs["depart"])
    assert over_ground == pytest.approx(LENGTH / time, rel=2e-3)
    middle = 0.5 * (route.legs["depart"] + route.legs["arrive"])
    current = 0.8 * KNOT * np.cos(2.0 * np.pi * (middle - DEPART) / (12.42 * HOUR))
    assert route.legs["ordered_speed"] == pytest.approx(over_ground - current, abs=0.05 * KNOT)
    assert {row["held"] for row in route.waypoints()[:-1]} == {"constant speed over ground"}
    assert "set hour by hour" in found.notes[0]
    assert "the speed over ground is constant: other speeds on" in quality_text(found)


@pytest.mark.slow
def test_the_latest_departure_is_the_arrival_less_the_passage() -> None:
    arrive = DEPART + 40.0 * HOUR
    found = planned(sea_with_current(1.0), arrive=arrive)
    passage = LENGTH / (float(SHIP.speeds[-1]) + KNOT)
    assert found.best.depart == pytest.approx(arrive - passage, abs=240.0)
    assert -60.0 <= found.best.arrive - arrive <= 1.0
    slower = planned(sea_with_current(1.0), arrive=arrive, speed_kn=10.0)
    assert slower.best.depart == pytest.approx(arrive - LENGTH / (11.0 * KNOT), abs=240.0)
    assert "Latest departure" in slower.notes[0]
    assert "other speeds" not in quality_text(slower)  # the departure would be earlier
    assert ", latest departure, to arrive at " in str(slower).splitlines()[0]


@pytest.mark.slow
def test_an_impossible_arrival_states_what_is_possible() -> None:
    sea = sea_with_current(0.0)
    with pytest.raises(NoRouteError) as caught:
        planned(sea, depart=DEPART, arrive=DEPART + HOUR)
    assert "At its highest speed" in caught.value.possible
    assert "later" in caught.value.possible and "earlier" in caught.value.remedy
    with pytest.raises(NoRouteError) as caught:
        planned(sea, depart=DEPART, arrive=DEPART + 400.0 * HOUR)
    assert "at every speed considered" in caught.value.asked
    assert "Leave out the departure" in caught.value.remedy


@pytest.mark.slow
def test_the_least_fuel_arrives_by_the_time_asked() -> None:
    arrive = DEPART + 1.2 * mid_speed_time()
    given = {"objective": "fuel", "method": "exact"}
    found = planned(sea_with_current(0.0), depart=DEPART, arrive=arrive, **given)
    assert found.best.arrive <= arrive + 1.0
    assert found.best.time_h > 0.9 * mid_speed_time() / HOUR
    assert found.voyage.arrive == arrive and found.voyage.arrive_by is None


@pytest.mark.parametrize(
    "voyage",
    [
        {"depart": DEPART, "arrive": DEPART + HOUR, "arrive_by": DEPART + HOUR},
        {"depart": DEPART, "arrive": DEPART + HOUR, "speed_kn": 9.0},
        {"arrive": DEPART, "objective": "fuel"},
        {"depart_window": (DEPART, DEPART + HOUR), "arrive": DEPART + 2 * HOUR},
        {"depart": DEPART, "hold": "speed"},
        {"depart": DEPART, "speed_kn": 9.0, "hold": "ground"},
        {"depart": DEPART, "speed_kn": 9.0, "hold": "rudder"},
        {"depart": DEPART, "arrive": DEPART - HOUR},
        {},
    ],
)
def test_contradictory_times_are_refused(voyage) -> None:
    with pytest.raises(InputError):
        Voyage(**ENDS, **voyage)


def test_an_arrival_after_the_data_is_refused() -> None:
    sea = Sea.open(
        regular((-1.0, 1.0), (-1.0, 3.0), fields={"swh": {"standard_name": WAVES, "units": "m"}})
    ).filled(wind=0.0)
    first, last = period_of_data(SHIP, sea)
    with pytest.raises(OutsidePeriodError, match="arrival") as caught:
        planned(sea, depart=first, arrive=last + HOUR)
    assert "The data run from" in caught.value.possible


def test_a_voyage_file_keeps_the_arrival(tmp_path) -> None:
    voyage = Voyage(**ENDS, depart=DEPART, arrive=DEPART + 9 * HOUR, hold="ground")
    voyage.save(tmp_path / "voyage.yaml")
    assert Voyage.load(tmp_path / "voyage.yaml") == voyage


def test_words_on_an_arrival_that_can_only_be_early():
    request: Any = SimpleNamespace(arrive=20.0 * 3600.0)
    plan: Any = SimpleNamespace(best=SimpleNamespace(arrive=15.1 * 3600.0))
    assert _on_time(plan, request) == (
        "the ship arrives 4 h 54 min before the requested time; leaving a little later or sailing "
        "a little slower, it would arrive after that time"
    )


@pytest.mark.slow
def test_the_latest_departure_over_a_bar_is_that_before_it_closes() -> None:
    """It was 3 to 7 min before that, and earlier for a later deadline.

    The bar needs 1 m more than its 10 m: until arccos(1 / 1.5) / 2 pi of a tide after high water.
    """
    tide, low_water = 12.42 * HOUR, DEPART + 3.0 * HOUR

    def depth(time, lat, lon):
        return np.where((lon > 3.55) & (lon < 3.60), 10.0, 20.0) + 0.0 * lat

    def level(time, lat, lon):
        return -1.5 * np.cos(2.0 * np.pi * (time - low_water) / tide) + 0.0 * lat

    sea = Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": depth,
            "sea_surface_height_above_geopotential_datum": level,
        }
    )
    start, goal, arrive = (51.71, 3.45), (51.77, 3.70), DEPART + 14.0 * HOUR
    found = plan(
        Voyage(start=start, goal=goal, arrive=arrive, min_ukc_m=1.0),
        ship=Ship.simple(speed_kn=10.0, draught_m=10.0),
        sea=sea,
        chart=Chart.open_water(51.6, 51.9, 3.40, 3.75),
        resolution=1000.0,
    )
    closes = low_water + 0.5 * tide + math.acos(1.0 / 1.5) / (2.0 * math.pi) * tide
    to_the_bar = 0.6 * float(distance(*start, *goal)) / (10.0 * KNOT)
    assert found.best.feasible and found.best.waiting_h == pytest.approx(0.0, abs=1e-6)
    assert -90.0 <= found.best.depart - (closes - to_the_bar) <= 60.0


@pytest.mark.slow
def test_trials_are_named_on_the_way_and_the_answer_has_a_proof() -> None:
    stated: list[str] = []
    voyage = Voyage(**ENDS, depart=DEPART, arrive=DEPART + mid_speed_time(current_kn=1.0))
    sea = sea_with_current(1.0)
    found = plan(
        voyage, ship=SHIP, sea=sea, chart=CHART, resolution=10_000.0, progress=stated.append
    )
    trials = [text for text in stated if text.startswith("trying ")]
    assert len(trials) >= 2 and trials[0] == f"trying {SHIP.speeds[-1] / KNOT:.2f} kn"
    assert 0.0 <= found.gap < 0.02


def _arriving(arrive: float) -> Any:
    return SimpleNamespace(best=SimpleNamespace(arrive=arrive, feasible=True))


def test_the_whole_plan_of_a_trial_that_leaves_later_is_solved_for_again() -> None:
    """A trial does not wait for lower waves; its whole plan arrives 500 s later."""
    whole = lambda value: _arriving(value + 500.0)  # noqa: E731
    search = ArrivalSearch(
        _arriving, lambda plan, value: value + 500.0, 1000.0, (0.0, 2000.0), EARLY
    )
    value, plan = whole_answer(search, 1000.0, whole)
    assert search.on_time(plan) and value == pytest.approx(500.0 - AIM, abs=1.0)
    value, plan = whole_answer(search, 400.0, whole)  # early is no reason to plan again
    assert value == 400.0 and plan.best.arrive == 900.0


def test_trials_near_a_jump_of_the_arrivals_are_few() -> None:
    """Six of eight trials had the same speed in their text."""
    tried: list[float] = []

    def plan_at(value: float) -> Any:
        tried.append(value)
        return _arriving(value if value < 500.3 else value + 3600.0)

    search = ArrivalSearch(plan_at, lambda plan, value: value, 1000.0, (0.0, 1000.0), 1.0)
    value, plan = solve_arrival(search, (0.0, _arriving(0.0)))
    assert 400.0 < value < 500.3 and plan.best.arrive == value
    assert len(tried) <= 8
    assert sum(abs(one - 500.3) < 1.0 for one in tried) <= 3


@pytest.mark.slow
def test_trials_search_no_later_departure(monkeypatch) -> None:
    asked: list[bool] = []

    def plan_alone(voyage, ship, sea, chart, options, **settings):
        asked.append(settings.get("leaves_later", True))
        return whole_plan(voyage, ship, sea, chart, options, **settings)

    whole_plan = planner._plan_alone
    monkeypatch.setattr(planner, "_plan_alone", plan_alone)
    planned(sea_with_current(0.0), depart=DEPART, arrive=DEPART + mid_speed_time())
    assert asked[-1] and len(asked) > 1 and not any(asked[:-1])


def test_the_first_guess_of_a_departure_gives_way_to_one_that_has_a_route() -> None:
    """A ship that may not wait found the bar closed at the only departure that was tried."""

    def plan_at(depart: float) -> Any:
        if depart > 10.5 * HOUR:
            raise NoRouteError("The bar is closed.")
        return _arriving(depart + HOUR)

    depart, plan = _first_departure(plan_at, 14.0 * HOUR, 0.0)
    assert depart == pytest.approx(10.0 * HOUR) and plan.best.arrive == pytest.approx(11.0 * HOUR)
    with pytest.raises(NoRouteError, match="bar"):
        _first_departure(plan_at, 30.0 * HOUR, 0.0)  # no more than a tide before
    tried: list[float] = []

    def no_way(depart: float) -> Any:
        tried.append(depart)
        raise NoPathError("No water joins them.")

    with pytest.raises(NoPathError):
        _first_departure(no_way, 14.0 * HOUR, 0.0)
    assert len(tried) == 1  # no departure opens it


def test_the_arrival_of_the_slowest_speed_is_that_of_its_own_plan() -> None:
    """It was that of the track and waits of the highest speed, hours late."""

    def refuse(speed: float) -> Any:
        raise NoRouteError("Too slow.")

    assert _arrival_of_trial(lambda speed: _arriving(1000.0 / speed), 2.0) == 500.0
    assert _arrival_of_trial(refuse, 2.0) == math.inf
