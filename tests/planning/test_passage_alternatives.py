"""Other ways of a plan by and round canals and passages: figures, order, where there are none."""

from dataclasses import replace

import pytest

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.chart.canals import KIEL, canals_with_dues
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.planning.passage_alternatives import MAX_DETOUR, passage_alternatives

DEPART = "2026-01-01T00:00Z"


@pytest.fixture(scope="module")
def small():
    """A plan in open water."""
    voyage = Voyage(start=(50.0, 1.0), goal=(50.5, 2.0), depart=DEPART)
    water = Chart.open_water(49.0, 52.0, 0.0, 4.0)
    ship = Ship.simple(speed_kn=12.0, draught_m=6.0)
    return plan(voyage, ship=ship, sea=Sea.calm(), chart=water)


@pytest.fixture(scope="module")
def planned(small):
    """A plan whose route runs by the Kiel Canal from the German Bight to the Baltic."""
    world = Chart.gshhg("i")
    west, east = KIEL.ends
    start, goal = (54.0, 8.0), (54.5, 13.5)
    lat, lon = zip(start, west, east, goal)
    context = small.plot_context
    route = evaluate(Track(lat, lon, DEPART), ship=context.ship, sea=context.sea, chart=world)
    return replace(
        small,
        voyage=Voyage(start=start, goal=goal, depart=DEPART),
        routes=(route,),
        plot_context=replace(context, chart=world.with_offing(2.0 * NAUTICAL_MILE)),
    )


@pytest.mark.slow
def test_ways_by_and_round_the_kiel_canal(planned):
    first, *others = passage_alternatives(planned)
    assert first.without == () and first.passes[0] == "kiel"
    assert first.distance / NAUTICAL_MILE == pytest.approx(planned.best.distance_nm, rel=0.15)
    assert first.canal_dues_usd == 8000.0
    assert [way.distance for way in others] == sorted(way.distance for way in others)
    round_it = next(way for way in others if way.without == ("kiel",))
    assert round_it.canal_dues_usd == 0.0
    assert "Skagerrak-Kattegat (Skaw)" in round_it.passes
    assert first.distance < round_it.distance < MAX_DETOUR * first.distance
    assert round_it.time == pytest.approx(round_it.distance / (12.0 * KNOT), rel=0.01)


@pytest.mark.slow
def test_waits_of_the_plan_do_not_count_as_sailing(planned):
    """The speed of the ways is the speed at sea; a wait is no part of the time of a leg."""
    context, track = planned.plot_context, planned.best.track
    waiting = replace(track, wait=(46.5 * HOUR, *track.wait[1:]))
    route = evaluate(waiting, ship=context.ship, sea=context.sea, chart=Chart.gshhg("i"))
    assert route.waiting_h == pytest.approx(46.5)
    with_wait = passage_alternatives(replace(planned, routes=(route,)))
    assert with_wait[0].time == pytest.approx(passage_alternatives(planned)[0].time)


@pytest.mark.slow
def test_ways_round_canals_are_listed_however_long(planned, monkeypatch):
    """Magellan instead of Panama is 2.6 times as long."""
    monkeypatch.setattr("thalweg.planning.passage_alternatives.MAX_DETOUR", 1.05)
    ways = passage_alternatives(planned)
    assert ("kiel",) in {way.without for way in ways}
    for way in ways[1:]:
        assert "kiel" in way.without or way.distance <= 1.05 * ways[0].distance


@pytest.mark.slow
def test_dues_are_those_of_the_ship(planned):
    ship = Ship.load("handysize-bulker")
    (canal,) = canals_with_dues((KIEL,), ship.file.hull)
    assert canal.fee != KIEL.fee
    context = replace(planned.plot_context, ship=ship)
    assert (
        passage_alternatives(replace(planned, plot_context=context))[0].canal_dues_usd == canal.fee
    )


@pytest.mark.slow
def test_they_are_in_the_data_of_the_plan_when_asked_for(planned):
    assert "passage_alternatives" not in planned.to_dict()
    rows = planned.with_alternatives().to_dict()["passage_alternatives"]
    assert rows[0]["without"] == [] and rows[0]["passes"][0] == "kiel"
    assert set(rows[0]) == {"without", "passes", "distance_nm", "time_h", "canal_dues_usd"}


def test_open_water_has_none(small):
    assert passage_alternatives(small) == ()
    assert passage_alternatives(replace(small, plot_context=None)) == ()
