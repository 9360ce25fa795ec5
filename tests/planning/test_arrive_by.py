"""Latest arrivals that are missed: by the shortest route only, and by the referee only."""

import dataclasses

import numpy as np
import pytest

from thalweg import Chart, NoRouteError, Sea, Ship, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.time import parse_time
from thalweg.planning.single import route_candidates, stretch
from thalweg.planning.single.no_route_diagnosis import late_arrival_error

KNOT, HOUR, DEPART = 1852.0 / 3600.0, 3600.0, 1767225600.0
SHIP = Ship.simple(speed_kn=10.0, draught_m=5.0)
WATER = Chart.open_water(-0.6, 0.6, -0.2, 2.2)
ENDS = {"start": (0.0, 0.0), "goal": (0.0, 2.0), "depart": DEPART}


def contrary(time, lat, lon):
    """6 kn against the ship near the equator, still water beside it."""
    return np.where(np.abs(lat) < 0.1, -6.0 * KNOT, 0.0) + 0.0 * lon


@pytest.mark.slow
def test_the_shortest_route_is_late_and_another_is_in_time() -> None:
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": contrary,
            "northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat,
        }
    )
    given = {"ship": SHIP, "sea": sea, "chart": WATER, "resolution": 5000.0}
    fast = plan(Voyage(**ENDS), **given).best  # about 13 h; along the equator it takes 30 h
    assert fast.time_h < 20.0
    latest = DEPART + 22.0 * HOUR
    short = plan(Voyage(**ENDS, objective="distance", arrive_by=latest), **given).best
    assert short.arrive <= latest and 120.0 < short.distance_nm < fast.distance_nm + 0.1


def test_a_fastest_arrival_in_time_is_not_reported_as_late() -> None:
    """A search for the least distance has one label per node: it may miss a longer, faster path."""
    error = late_arrival_error(DEPART + 10.0 * HOUR, DEPART + 8.0 * HOUR)
    assert error.asked == "The shortest route does not arrive by 2026-01-01T10:00:00Z."
    assert error.possible == "The fastest route arrives at 2026-01-01T08:00:00Z."


def test_a_route_that_the_referee_finds_late_is_not_reported_as_in_time(monkeypatch) -> None:
    given = {"ship": SHIP, "sea": Sea.calm(), "chart": WATER, "resolution": 5000.0}
    hours = float(distance(0.0, 0.0, 0.0, 2.0)) / (10.0 * KNOT) / HOUR
    latest = DEPART + (hours + 0.5) * HOUR
    assert plan(Voyage(**ENDS, arrive_by=latest), **given).best.arrive <= latest
    refined = stretch.refine_track

    def slower(context, track, limits):
        route = refined(context, track, limits)
        legs = {**route.legs, "arrive": route.legs["arrive"] + HOUR}
        return dataclasses.replace(route, legs=legs)

    for module in (stretch, route_candidates):
        monkeypatch.setattr(module, "refine_track", slower)
    with pytest.raises(NoRouteError, match="No route arrives by") as caught:
        plan(Voyage(**ENDS, arrive_by=latest), **given)
    assert "earliest arrival is 2026-01-01T13:0" in caught.value.possible


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "fuel"])
def test_a_latest_arrival_that_only_the_refined_route_keeps_is_kept(objective) -> None:
    ship = Ship.load("handysize-bulker")
    ring = [[0.9, -0.33], [1.0, -0.33], [1.0, 0.47], [0.9, 0.47], [0.9, -0.33]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [ring]})
    ends = {"start": (0.0, 0.0), "goal": (0.0, 2.0), "depart": DEPART, "offing_nm": 0.0}
    given = {"ship": ship, "sea": Sea.calm(), "chart": chart, "resolution": 20_000.0}
    fastest = plan(Voyage(**ends), **given)
    settled = fastest.solver_total * HOUR
    latest = DEPART + 0.5 * (fastest.best.time_h * HOUR + settled)
    assert settled > fastest.best.time_h * HOUR + 60.0  # the path on the network is late
    ends |= {"objective": objective, "method": "default" if objective == "time" else "exact"}
    found = plan(Voyage(**ends, arrive_by=latest), **given).best
    assert found.feasible and found.arrive <= latest + 1.0
    with pytest.raises(NoRouteError, match="No route arrives by") as caught:
        early = DEPART + fastest.best.time_h * HOUR - 600.0
        plan(Voyage(**ends, arrive_by=early), **given)
    earliest = parse_time(caught.value.details["earliest"])
    assert earliest == pytest.approx(fastest.best.arrive, abs=5.0)


def test_least_fuel_arrives_at_the_latest_arrival() -> None:
    """120 nm in 11 h with 8, 10 or 12 kn and fuel by the cube: 10 and 12 kn to the last minute."""
    ship = Ship.from_dict(
        {
            "name": "cubic",
            "hull": {"draught_m": 5.0},
            "speeds_kn": [8.0, 10.0, 12.0],
            "engine": {"reference_speed_kn": 12.0},
            "fuel": {"reference_t_per_day": 24.0},
            "models": {"calm_water": "cubic"},
        }
    )
    latest = DEPART + 11.0 * HOUR
    voyage = Voyage(**ENDS, objective="fuel", arrive_by=latest, speed_block_h=0.0)
    best = plan(voyage, ship=ship, sea=Sea.calm(), chart=WATER, resolution=5000.0).best
    assert latest - 60.0 < best.arrive <= latest
    miles = float(distance(0.0, 0.0, 0.0, 2.0)) / 1852.0
    fast = (miles - 110.0) / 2.0  # hours at 12 kn
    fuel = fast * 1.0 + (11.0 - fast) * (10.0 / 12.0) ** 3
    assert best.fuel_t == pytest.approx(fuel, rel=1e-3)


@pytest.mark.slow
def test_a_slower_route_that_is_late_is_not_said_to_be_better():
    speeds = [6.0, 8.0, 10.0, 12.0, 14.0]
    ship = Ship.simple(speed_kn=12.0, speeds_kn=speeds, draught_m=5.0, fuel_t_per_day=24.0)
    voyage = Voyage(
        start=(0.0, 0.0), goal=(0.0, 1.0), depart="2026-01-01T00:00Z",
        arrive_by="2026-01-01T08:00Z", objective="fuel",
    )  # fmt: skip
    chart = Chart.open_water(-0.4, 0.4, -0.2, 1.2)
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=chart, proof=0.0)
    assert not any("for comparison, is up to" in note for note in found.notes)


@pytest.mark.slow
def test_the_heading_and_the_notes_say_what_the_times_of_a_request_mean() -> None:
    given = {"ship": SHIP, "sea": Sea.calm(), "chart": WATER, "resolution": 20_000.0}
    burning = Ship.load("s175")
    latest = DEPART + 30.0 * HOUR
    found = plan(Voyage(**ENDS, objective="fuel", arrive=latest), **given | {"ship": burning})
    heading = str(found).splitlines()[0]
    assert ", least fuel, arriving by 2026-01-02 06:00 UTC" in heading  # it may arrive earlier
    early = plan(Voyage(**{**ENDS, "depart": "1750-01-01"}), **given)
    assert any(note.startswith("Check the year: ") for note in early.notes[:3])
    late = plan(Voyage(**{**ENDS, "depart": "1950-01-01"}), **given)
    assert not any("year" in note for note in late.notes)
