"""Positions in harbours: the ship follows the approach that passes her."""

import numpy as np
import pytest

from thalweg import Sea, Ship, Voyage, evaluate, plan
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.joined_approach import joined_ways
from thalweg.planning.request.voyage_endpoints import resolve_places
from thalweg.planning.sea_distance import sea_distance
from thalweg.planning.seaways import world_chart
from thalweg.route import RouteFileOptions, write_route_files
from thalweg.route.route_tables import LEG_KINDS

ROADS_OF_PRINCE_RUPERT = 54.312, -130.34


@pytest.fixture(scope="module")
def world():
    return world_chart()


def test_a_ship_in_a_harbour_joins_the_line_of_its_port(world):
    approach = joined_ways(*ROADS_OF_PRINCE_RUPERT, world)[0]
    of_port = world.approaches.of(PORTS.lookup("Prince Rupert"))
    assert approach.line[0] == ROADS_OF_PRINCE_RUPERT
    assert approach.sea_end == of_port.sea_end
    assert set(approach.line[2:]) <= set(of_port.line)
    assert not world.legs_blocked(*approach.line[0], *approach.line[1])
    assert approach.length < of_port.length + 1.0 * NAUTICAL_MILE


@pytest.mark.slow
def test_a_deep_ship_at_fisherman_islands_leaves_by_the_main_channel_of_brisbane():
    found = sea_distance((-27.385, 153.165), "Sydney", draught_m=14.0)
    by_name = sea_distance("Brisbane", "Sydney", draught_m=14.0)
    assert found.approaches[0][0] == "Brisbane, AU"
    assert 0.0 < by_name.nm - found.nm < 10.0
    assert any("beside the approach of Brisbane" in note for note in found.notes)


@pytest.mark.slow
def test_a_ship_below_a_branch_goes_up_the_line_to_it(world):
    """In Chesapeake Bay south of Baltimore the way to the Delaware leaves the line above her."""
    place = 39.0, -76.40
    ways = {way.way: way for way in joined_ways(*place, world)}
    (name,) = [name for name in ways if "to the Delaware" in name]
    way = ways[name]
    assert way.line[0] == place
    assert max(lat for lat, _lon in way.line) > 39.5
    small = Ship.simple(speed_kn=12.0, draught_m=5.0, length_m=100.0, breadth_m=16.0)
    by_canal = sea_distance(place, "New York", ship=small)
    assert by_canal.nm < 270.0


@pytest.mark.parametrize(
    "place", [(54.0, -133.0), (54.30, -130.90), (40.0, -60.0)], ids=["Hecate", "end", "ocean"]
)
def test_a_ship_at_sea_joins_no_line(world, place):
    assert joined_ways(*place, world) == []


def test_lines_near_a_position_are_measured_from_the_berth(world):
    near = [
        one
        for one in world.approaches.lines_near(*ROADS_OF_PRINCE_RUPERT, within=2 * NAUTICAL_MILE)
        if one[0].port.name == "Prince Rupert"
    ]
    assert len(near) == 1
    approach, along, apart = near[0]
    lat, lon = np.array(approach.line).T
    assert apart <= float(distance(*ROADS_OF_PRINCE_RUPERT, lat, lon).min()) + 1.0
    assert 0.0 <= along <= approach.length + 1.0


def test_only_the_ends_of_a_voyage_join_lines(world):
    ends = resolve_places("Sydney", [ROADS_OF_PRINCE_RUPERT], ROADS_OF_PRINCE_RUPERT, world)
    assert (ends[1].lat, ends[1].lon) == ROADS_OF_PRINCE_RUPERT
    assert ends[1].approach is None
    assert ends[2].approach is not None
    assert not ends[2].is_port


def test_short_voyages_stay_in_their_sound(world):
    """The sound of Gisund: the approach of Finnsnes leads out to sea."""
    ends = resolve_places((69.30, 18.0), [], (69.45, 18.1), world)
    assert [end.approach for end in ends] == [None, None]
    assert resolve_places((69.30, 18.0), [], "Tromso", world)[0].approach is None
    near, far = (54.22, -130.42), (54.4, -133.0)
    assert resolve_places(ROADS_OF_PRINCE_RUPERT, [], near, world)[0].approach is None
    assert resolve_places(ROADS_OF_PRINCE_RUPERT, [], far, world)[0].approach is not None


@pytest.mark.slow
def test_a_ship_on_the_river_of_her_port_is_not_in_it(world):
    """Off Rimouski she is on the line of Montreal, and 260 miles from it."""
    ends = resolve_places((48.6, -68.55), [], "Montreal", world)
    assert not ends[0].is_port and ends[1].is_port
    way = sea_distance((48.6, -68.55), "Montreal", draught_m=8.0)
    assert 240.0 < way.nm < 320.0


def test_a_canal_is_not_reached_straight_over_land(world):
    """In the fjord of Kiel, beside the gate of the canal, land lies between."""
    for way in joined_ways(54.35, 10.16, world):
        assert not world.legs_blocked(*way.line[0], *way.line[1])
    start, goal = resolve_places((54.35, 10.16), [], "Hamburg", world)
    assert start.approach is not None and goal.approach is not None


def test_ends_on_both_sides_of_a_canal_follow_their_lines(world):
    ends = resolve_places((53.55, 9.80), [], (54.35, 10.16), world)
    assert [end.approach.port.label for end in ends] == ["Hamburg, DE", "Kiel, DE"]
    assert {way.canal for end in ends for way in end.ways} >= {"kiel"}


@pytest.mark.slow
def test_a_voyage_without_an_offing_takes_the_water_as_it_is(world):
    """Published cases begin and end in harbours of their charts."""
    ends = resolve_places(ROADS_OF_PRINCE_RUPERT, [], "Sydney", world, joins=False)
    assert ends[0].approach is None and ends[1].approach is not None
    free = sea_distance(ROADS_OF_PRINCE_RUPERT, "Vancouver", offing_nm=0.0)
    assert [name for name, _ in free.approaches] == ["Vancouver, CA"]


def test_a_position_on_land_is_moved_and_joins(world):
    end = resolve_places((54.31, -130.34), [], "Sydney", world)[0]
    assert end.approach.port.label == "Prince Rupert, CA"
    assert "moved 0.1 nm" in end.notice
    assert end.name == "54.3100N 130.3400W"


@pytest.mark.slow
def test_the_route_of_a_ship_in_a_harbour_is_evaluated_as_planned(world, tmp_path):
    """The joint to the line is sailed at the speed of approaches by plan and evaluation."""
    ship = Ship.load("handysize-bulker")
    voyage = Voyage(start=ROADS_OF_PRINCE_RUPERT, goal=(54.4, -133.2), depart="2026-06-01")
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=world, proof=0.0)
    assert found.best.legs["leg_kind"][0] == LEG_KINDS.index("approach")
    write_route_files(found.best, tmp_path, "route", RouteFileOptions())
    again = evaluate(tmp_path / "route.csv", ship=ship, sea=Sea.calm(), chart=world)
    assert again.time_h == pytest.approx(found.best.time_h, rel=1e-4)
    assert again.distance_nm == pytest.approx(found.best.distance_nm, rel=1e-4)
