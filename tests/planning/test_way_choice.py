"""Voyages leave the approaches of their ports where the way onwards begins."""

import functools

import numpy as np
import pytest

import thalweg
from tests.planning.distances import sea_distance
from thalweg import Chart, Sea, Ship, Voyage
from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.canals import KIEL, SUEZ, canals_with_dues
from thalweg.chart.ports import PORTS
from thalweg.core.errors import NoRouteError
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.planning.network_selection.way_choice import with_chosen_ways
from thalweg.planning.request.voyage_endpoints import resolve_places
from thalweg.planning.seaways import Seaways, world_chart

#: Miles as tables quote them, and the tolerance; by the line that the ship takes.
TABLES = [
    ("Hamburg", "Kiel", 95, 0.03),  # Hamburg to Brunsbüttel 37, canal 53, Holtenau to Kiel 3
    ("Port Said", "Suez", 88, 0.05),
    ("Rendsburg", "Hamburg", 72, 0.03),
    # 80 km from the breakwater to the sea buoys, less 4.5 to Cristobal and 8.2 to Balboa; tables
    # give 44 nm, the whole canal
    ("Balboa", "Cristobal", 36.3, 0.03),
    ("Hamburg", "Gdansk", 427, 0.02),
    ("Bremerhaven", "Gothenburg", 365, 0.05),
    ("Kobe", "Busan", 366, 0.05),
    ("Osaka", "Busan", 372, 0.05),
    ("Bergen", "Trondheim", 313, 0.02),  # by Trondheimsleia; outside Smoela tables give 338
    ("Antwerp, BE", "Rotterdam", 119, 0.07),
    ("Baltimore", "Norfolk", 172, 0.04),
    ("Buenos Aires", "Montevideo", 123, 0.05),
    ("Stockholm", "Helsinki", 246, 0.03),
    # along one river or bay
    ("Hamburg", "Brunsbuttel Canal Terminals", 37, 0.07),
    ("Houston", "Galveston", 45, 0.05),
    ("Montreal", "Quebec", 139, 0.05),
    ("Baltimore", "Philadelphia", 97, 0.05),
    ("Buenos Aires", "La Plata", 35, 0.05),
    ("New Orleans", "Baton Rouge", 117, 0.08),
    # across one bay
    ("Osaka", "Kobe", 15.6, 0.04),  # south of Kobe Airport; tables give 12, between harbour limits
    # by second entrances
    ("Jakarta", "Surabaya", 385, 0.03),  # by the western channel, not round Madura
]


@functools.cache
def chart():
    return Chart.gshhg("i")


@functools.cache
def ship():
    return Ship.load("handysize-bulker")


@functools.cache
def planned(start, goal, **options):
    voyage = Voyage(start=start, goal=goal, depart="2024-01-01T00:00Z", **options)
    return thalweg.plan(voyage, ship=ship(), sea=Sea.calm(), chart=chart(), proof=0.0)


@functools.cache
def seas(*avoided):
    return Seaways.of_chart(world_chart(), avoided)


def chosen(start, goal, *avoided, draught=0.0):
    ends = resolve_places(start, (), goal, chart())
    ends = with_chosen_ways(ends, lambda: seas(*avoided), draught=draught)
    return [end.approach.way for end in ends]


@pytest.mark.slow
@pytest.mark.parametrize(("start", "goal", "miles", "tolerance"), TABLES)
def test_distances_of_river_ports_and_inland_seas(start, goal, miles, tolerance):
    assert sea_distance(start, goal).nm == pytest.approx(miles, rel=tolerance)


@pytest.mark.slow
def test_the_way_follows_the_canals_that_are_open():
    assert chosen("Hamburg", "Kiel") == ["to the Kiel Canal", "through the Kiel Canal"]
    assert chosen("Hamburg", "Gdansk") == ["to the Kiel Canal", ""]
    assert chosen("Hamburg", "Kiel", "kiel") == ["", ""]
    assert chosen("Hamburg", "New York") == ["", ""]
    assert sea_distance("Hamburg", "Kiel", avoid=["kiel"]).nm > 400.0
    there, back = sea_distance("Hamburg", "Kiel"), sea_distance("Kiel", "Hamburg")
    assert there.nm == pytest.approx(back.nm, rel=0.005)


@pytest.mark.slow
def test_the_way_follows_the_goal_and_the_draught():
    assert chosen("Bergen", "Trondheim") == ["by Fedjeosen", "by the entrance of Trondheimsleia"]
    assert not any(way.startswith("by") for way in chosen("Bergen", "Stavanger"))
    assert chosen("Bergen", "Rotterdam") == ["", ""]
    assert chosen("Antwerp, BE", "Rotterdam", draught=7.0) == ["by Oostgat", ""]
    assert chosen("Antwerp, BE", "Rotterdam", draught=9.5) == ["", ""]


@pytest.mark.slow
def test_ports_of_one_bay_do_not_leave_it():
    for start, goal in (("Osaka", "Kobe"), ("Chiba", "Yokohama")):
        assert all(way.startswith("as far as") for way in chosen(start, goal))
    assert "as far as" not in chosen("Osaka", "Busan")[0]  # out of the bay
    assert chosen("Baltimore", "Norfolk")[0] == ""  # the charted channel is hardly longer
    airport = 34.622, 135.203, 34.644, 135.251  # south, west, north, east
    for lat, lon in sea_distance("Osaka", "Kobe").line:
        assert not (airport[0] < lat < airport[2] and airport[1] < lon < airport[3])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "opened", "miles"),
    [  # with the passages that the ferries use, as the operators give the crossings, by hand
        ("Oban", "Tobermory", ["Sound of Mull"], 25.0),  # 72 by both sea ends
        ("Oban", "Stornoway", ["Sound of Mull"], 136.0),  # 130 nearer than 2 nm to the capes
        ("Jebel Ali", "Sharjah", [], 34.0),  # round the Palms off Dubai; 46 by the sea end
    ],
)
def test_approaches_are_left_where_the_way_leads_to_the_other_side(start, goal, opened, miles):
    there, back = (sea_distance(*ends, open=opened) for ends in ((start, goal), (goal, start)))
    assert there.nm == pytest.approx(miles, rel=0.06)
    assert there.nm == pytest.approx(back.nm, rel=0.02)
    assert not any("Turns back" in note for note in there.notes)


@pytest.mark.slow
def test_more_open_passages_make_no_way_longer():
    assert sea_distance("Bergen", "Alesund", open="all").nm <= sea_distance("Bergen", "Alesund").nm


@pytest.mark.slow
def test_approaches_of_the_wadden_sea_follow_the_channels():
    """Graadyb north of Fanoe, Schulpengat south of Noorderhaaks, and the Elbe, not the sands."""
    for name, shoal in (
        ("Esbjerg", (55.41, 8.526)), ("Den Helder", (52.975, 4.664)), ("Cuxhaven", (53.95, 8.75)),
    ):  # fmt: skip
        lat, lon = np.array(PORT_APPROACHES.of(PORTS.lookup(name)).line).T
        lat, lon, _ = densify(lat, lon, 500.0)
        assert float(np.min(distance(lat, lon, *shoal))) > 2.0 * NAUTICAL_MILE


@pytest.mark.slow
def test_a_bulk_carrier_passes_west_of_karmoey():
    """The way between Utsira and Karmoey is open sea, 10 nm wide."""
    plan = planned("Bergen", "Hamburg")
    assert plan.best.feasible
    assert plan.best.distance_nm == pytest.approx(sea_distance("Bergen", "Hamburg").nm, rel=0.03)


@pytest.mark.slow
def test_no_approach_is_left_over_shoals():
    assert chosen("Bremerhaven", "Brunsbuttel") == ["", ""]  # drying flats lie between them
    assert chosen("Antwerp, BE", "Rotterdam", draught=9.5) == ["", ""]  # the banks off Zeeland


@pytest.mark.slow
def test_a_small_ship_sails_through_the_sound_of_mull():
    voyage = Voyage(start="Oban", goal="Tobermory", depart="2024-06-01T00:00Z")
    small = Ship.load("gunnerus-2019")
    plan = thalweg.plan(voyage, ship=small, sea=Sea.calm(), chart=chart(), proof=0.0)
    route = plan.best
    assert route.feasible
    assert route.distance_nm == pytest.approx(26.0, rel=0.04)
    assert plan.lower_bound <= plan.objective_value
    line = PORT_APPROACHES.of(PORTS.lookup("Oban"))
    assert route.track.positions[0] == pytest.approx(line.berth)
    assert any("as far as" in note for note in plan.notes)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "opened", "miles"),
    [  # of the leads, by hand on the chart; round the islands they are 266, 98, 243 and 66
        ("Narvik", "Harstad", ["Tjeldsund"], 66.0),
        ("Narvik", "Harstad", ["Tjeldsund", "Ramsund"], 47.0),
        ("Harstad", "Tromso", ["Gisund"], 85.0),
        ("Bodo", "Tromso", ["Tjeldsund", "Gisund"], 200.0),
        ("Alta", "Hammerfest", ["Vargsund"], 49.0),
        ("Bergen", "Leirvik", [], 47.0),
    ],
)
def test_small_ships_use_the_norwegian_leads(start, goal, opened, miles):
    assert sea_distance(start, goal, open=opened).nm == pytest.approx(miles, rel=0.06)


@pytest.mark.slow
def test_a_small_ship_passes_a_strait_that_the_depth_layer_shows_as_land():
    voyage = Voyage(start="Narvik", goal="Harstad", depart="2024-06-01T00:00Z")
    small = Ship.load("gunnerus-2019")
    plan = thalweg.plan(voyage, ship=small, sea=Sea.calm(), chart=chart(), proof=0.0)
    assert plan.best.distance_nm == pytest.approx(47.5, rel=0.03)  # by Ramsund
    assert plan.best.track.lat.max() < 68.85  # not by Andfjord


@pytest.mark.slow
def test_via_points_choose_the_ways_of_their_own_side():
    ends = resolve_places("Bergen", [(62.5, 4.5)], "Bergen", chart())
    ends = with_chosen_ways(ends, seas)
    assert [end.approach and end.approach.way for end in ends] == [
        "by Fedjeosen", None, "by Fedjeosen",
    ]  # fmt: skip


def test_without_a_choice_no_seaways_are_asked_for():
    ends = resolve_places("Valencia", (), "Tema", chart())
    assert with_chosen_ways(ends, pytest.fail) == ends


@pytest.mark.slow
def test_a_plan_leaves_the_elbe_for_the_canal():
    plan = planned("Hamburg", "Kiel")
    route = plan.best
    assert route.feasible
    assert route.distance_nm == pytest.approx(sea_distance("Hamburg", "Kiel").nm, rel=1e-4)
    assert (np.asarray(route.legs["leg_kind"]) == 2).all()
    assert route.track.lon.min() > 9.0  # never west of Brunsbüttel
    lines = [PORT_APPROACHES.of(PORTS.lookup(name)) for name in ("Hamburg", "Kiel")]
    assert route.track.positions[0] == pytest.approx(lines[0].berth)
    assert route.track.positions[-1] == pytest.approx(lines[1].berth)
    length, time = route.legs["length"], route.legs["arrive"] - route.legs["depart"]
    slow = time > 1.05 * length / (10.0 * KNOT)  # in the canal, at its speed
    assert length[slow].sum() / NAUTICAL_MILE == pytest.approx(48.6, abs=0.5)
    assert time[slow].sum() / length[slow].sum() == pytest.approx(KIEL.transit_time / KIEL.length)
    assert time[~slow].sum() == pytest.approx(length[~slow].sum() / (10.0 * KNOT))
    assert plan.lower_bound <= plan.objective_value
    again = thalweg.evaluate(route.track, ship=ship(), sea=Sea.calm(), chart=chart())
    assert again.feasible
    assert again.arrive == pytest.approx(route.arrive, abs=1.0)


@pytest.mark.slow
def test_a_port_on_a_canal_pays_its_dues_once():
    plan = planned("Port Said", "Suez", objective="cost")
    route = plan.best
    dues = canals_with_dues((SUEZ,), ship().file.hull)[0].fee
    assert route.feasible
    assert "by Suez Canal" in str(plan)
    assert route.cost == pytest.approx(dues + 300.0 * route.fuel_t, rel=0.01)
    assert np.sum(route.legs["length"]) / NAUTICAL_MILE == pytest.approx(84.8, abs=0.5)
    closed = sea_distance("Port Said", "Suez", avoid=["suez"])
    assert closed.nm > 10_000.0
    assert closed.canals == ()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "least", "most"),
    [
        ("Campana, AR", "Buenos Aires", 44.0, 56.0),  # along the channels of both
        ("Oostende", "Zeebrugge", 13.0, 22.0),  # 32 by that of Zeebrugge
    ],
)
def test_a_port_within_the_bay_of_another_needs_no_way_out_of_it(start, goal, least, most):
    assert least < sea_distance(start, goal).nm < most
    assert least < sea_distance(goal, start).nm < most


def test_a_port_inside_a_canal_that_is_closed_is_refused():
    """Rendsburg - Gdynia without the Kiel Canal led over 11 nm of land to Eckernfoerde."""
    with pytest.raises(NoRouteError, match="Rendsburg, DE lies inside the Kiel Canal, which is cl"):
        sea_distance("Rendsburg", "Gdynia", avoid=["kiel"])
    assert sea_distance("Rendsburg", "Gdynia").approaches[0][0].endswith("through the Kiel Canal")
