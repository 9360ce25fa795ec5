"""Voyages from berth to berth: approaches at fixed speed, counted in every total."""

import functools
import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import thalweg
from thalweg import Chart, Sea, Ship, Voyage
from thalweg.chart.approaches import MAX_APPROACH_SPEED, PORT_APPROACHES
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR, KNOT, NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import (
    resolve_endpoint,
    resolve_places,
    without_approach,
)
from thalweg.route import RouteFileOptions, Track
from thalweg.route.canal_legs import approach_speed
from thalweg.route.formats.csv_format import write_csv
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.geojson_format import write_geojson
from thalweg.route.formats.gpx_format import write_gpx

WRITERS = {"route.gpx": write_gpx, "route.csv": write_csv, "route.geojson": write_geojson}
DEPART = "2024-01-01T00:00Z"


@functools.cache
def chart():
    return Chart.gshhg("i")


@functools.cache
def ship():
    return Ship.load("handysize-bulker")


class Shown:
    """A progress callback that keeps the routes found so far."""

    def __init__(self):
        self.routes = []

    def __call__(self, text):
        pass

    def show_route(self, route):
        self.routes.append(route)


SHOWN = Shown()


@functools.cache
def planned(start="Rotterdam", goal="Lowestoft", **options):
    voyage = Voyage(start=start, goal=goal, depart=DEPART, **options)
    return thalweg.plan(voyage, ship=ship(), sea=Sea.calm(), chart=chart(), progress=SHOWN)


def approach_of(name):
    return PORT_APPROACHES.of(PORTS.lookup(name))


@pytest.mark.slow
def test_the_chart_of_the_plots_keeps_its_offing_and_its_approaches():
    kept = planned().plot_context.chart
    assert kept.offing.distance == pytest.approx(2.0 * NAUTICAL_MILE)
    assert kept.approaches is PORT_APPROACHES


@pytest.mark.slow
def test_routes_found_so_far_go_from_berth_to_berth():
    best = planned().best

    def ends(route):
        track = route.track
        return [round(float(x), 6) for x in (*track.lat[[0, -1]], *track.lon[[0, -1]])]

    shown = [route for route in SHOWN.routes if ends(route) == ends(best)]
    assert min(route.time_h for route in shown) == pytest.approx(best.time_h, rel=0.02)


@pytest.mark.slow
def test_totals_are_those_of_the_sea_and_the_two_approaches():
    route = planned().best
    start, goal = approach_of("Rotterdam"), approach_of("Lowestoft")
    kind = np.asarray(route.legs["leg_kind"])
    length, time = route.legs["length"], route.legs["arrive"] - route.legs["depart"]
    first, last = len(start.line) - 1, len(goal.line) - 1
    assert (kind[:first] == 2).all()
    assert (kind[-last:] == 2).all()
    assert (kind[first:-last] == 0).all()
    assert length[kind == 2].sum() == pytest.approx(start.length + goal.length, rel=1e-6)
    assert time[kind == 2].sum() == pytest.approx(
        (start.length + goal.length) / (10.0 * KNOT), rel=1e-6
    )
    assert route.feasible
    assert route.distance_nm * NAUTICAL_MILE == pytest.approx(length.sum())
    assert route.track.positions[0] == pytest.approx(start.berth)
    assert route.track.positions[-1] == pytest.approx(goal.berth)
    fuel = route.legs["fuel"][kind == 2] / time[kind == 2]  # the rate at 10 kn, on every leg
    assert np.ptp(fuel) < 1e-6 * fuel.mean()
    sea_rate = (route.legs["fuel"][kind == 0] / time[kind == 0]).min()
    assert 0.15 < fuel.mean() / sea_rate < 0.75  # about the cube of 10 over 14.1 kn


@pytest.mark.slow
def test_bounds_and_notes_count_the_approaches():
    plan = planned()
    assert plan.voyage.depart == plan.best.depart
    assert plan.lower_bound <= plan.objective_value * (1.0 + 1e-9)
    assert 0.0 <= plan.gap < 0.05
    texts = " ".join(plan.notes)
    for name in ("Rotterdam", "Lowestoft"):
        miles = approach_of(name).length / NAUTICAL_MILE
        assert f"+{miles:.1f} nm" in texts
        assert name in texts


@pytest.mark.slow
def test_the_bound_of_a_front_counts_the_time_of_the_approaches():
    plan = planned(objective="front", method="exact")
    assert plan.lower_bound == pytest.approx(plan.front.certain[0].min())
    assert plan.lower_bound < min(route.time_h for route in plan.routes)
    assert 0.0 <= plan.gap < 0.3


@pytest.mark.parametrize("form", ["route.gpx", "route.csv", "route.geojson"])
def test_a_written_route_has_the_same_totals_when_it_is_read_back(form, tmp_path):
    plan = planned()
    WRITERS[form](plan.best, tmp_path / form)
    again = thalweg.evaluate(tmp_path / form, ship=ship(), sea=Sea.calm(), chart=chart())
    assert again.feasible
    assert again.time_h == pytest.approx(plan.best.time_h, rel=2e-4)  # files have fewer waypoints
    assert again.distance_nm == pytest.approx(plan.best.distance_nm, rel=2e-4)
    assert again.fuel_t == pytest.approx(plan.best.fuel_t, rel=2e-4)
    rows = plan.best.waypoints()
    assert rows[0]["leg_kind"] == "approach"
    assert rows[-1]["leg_kind"] is None
    assert len(again.track) <= len(rows) + 4  # great circles are divided for plotters


def test_parts_of_a_divided_leg_have_its_kind():
    route = planned().best
    rows = file_route(route, RouteFileOptions(spacing_nm=0.5)).rows
    assert len(rows) > 3 * len(route.waypoints())
    kinds = [row["leg_kind"] for row in rows[:-1]]
    assert set(kinds) == {"approach", "sea"}  # a part was once called a canal
    turns = [a for a, b in itertools.pairwise([*kinds, ""]) if a != b]
    assert turns == ["approach", "sea", "approach"]
    held = {row["held"] for row in rows[:-1] if row["leg_kind"] == "approach"}
    assert held == {"constant speed over ground"}


def test_rotterdam_leaves_by_the_maas_and_not_by_the_haringvliet():
    lat, lon = planned().best.samples["lat"], planned().best.samples["lon"]
    assert (np.hypot(lat - 51.98, (lon - 4.10) * 0.62) * 60.0).min() < 1.0
    assert not ((lat > 51.6) & (lat < 51.86) & (lon > 4.05) & (lon < 4.7)).any()


def test_two_ports_on_one_river_are_joined_along_it():
    plan = planned("Rotterdam", "Hook of Holland")
    route = plan.best
    assert (np.asarray(route.legs["leg_kind"]) == 2).all()
    assert route.feasible
    assert 12.0 < route.distance_nm < 18.0  # 16.5 nm by the river's kilometres
    assert route.time_h == pytest.approx(route.distance_nm / 10.0, rel=1e-6)
    assert plan.gap == 0.0
    assert plan.lower_bound == pytest.approx(route.time_h)


def test_a_front_along_a_river_has_one_point():
    plan = planned("Antwerp, BE", "Vlissingen", objective="fuel")
    assert len(plan.routes) == 1
    assert plan.front.values[0] == pytest.approx(plan.best.fuel_t)


def test_latest_arrival_counts_the_approaches():
    hours = planned("Rotterdam", "Hook of Holland").best.time_h
    late = np.datetime64("2024-01-01T00:00") + np.timedelta64(int(hours * 3600) - 300, "s")
    with pytest.raises(NoRouteError, match="approaches take") as refused:
        planned("Rotterdam", "Hook of Holland", arrive_by=str(late))
    earliest = parse_time(refused.value.details["earliest"])  # the web page offers it
    assert earliest == pytest.approx(parse_time("2024-01-01T00:00") + hours * 3600.0, abs=1.0)
    with pytest.raises(NoRouteError, match="approaches"):
        planned(arrive_by="2024-01-01T02:00Z")


@pytest.mark.slow
def test_a_position_on_land_near_a_port_is_that_port():
    end = resolve_endpoint((51.9, 4.4833), chart(), "start")  # Rotterdam in the World Port Index
    assert end.approach == approach_of("Rotterdam")
    assert "Rotterdam, NL: that port is used" in end.note
    for lat, lon in ((-29.87, 31.03), (53.55, 9.95), (57.70, 11.95), (-33.04, -71.6)):
        assert resolve_endpoint((lat, lon), chart(), "start").lat


@pytest.mark.slow
def test_a_position_far_from_the_sea_is_refused_with_the_nearest_water():
    with pytest.raises(InputError, match=r"not on navigable water|nearest navigable water"):
        resolve_endpoint((48.1, 11.6), chart(), "goal")  # Munich
    with pytest.raises(InputError, match=r"The nearest port is Amsterdam, NL"):
        resolve_endpoint((52.09, 5.12), chart(), "goal")  # Utrecht
    _, lon, _ = chart().nearest_navigable(52.0, 5.5, largest=100_000.0)
    assert lon < 4.6  # the North Sea, not the IJmeer behind its dams
    assert not chart().is_joined_to_sea(52.5932, 5.0316)  # the Markermeer


@pytest.mark.slow
def test_water_that_does_not_lead_to_the_sea_is_not_used():
    # a lagoon of 4 km in the middle of an island
    ring = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]
    hole = [[-0.02, -0.02], [-0.02, 0.02], [0.02, 0.02], [0.02, -0.02], [-0.02, -0.02]]
    land = {"type": "Polygon", "coordinates": [ring, hole]}
    closed = replace(Chart.from_geojson(land), approaches=PORT_APPROACHES)
    assert bool(closed.is_navigable(0.0, 0.0))
    assert not closed.is_joined_to_sea(0.0, 0.0)
    with pytest.raises(InputError, match="not on navigable water"):
        resolve_endpoint((0.0, 0.0), closed, "start")
    assert chart().is_joined_to_sea(60.88, 5.2) or not chart().is_navigable(60.88, 5.2)
    assert chart().is_joined_to_sea(51.354, 4.247)  # the Scheldt, 500 m wide


def test_ports_of_the_great_lakes_are_refused_with_the_reason():
    with pytest.raises(InputError, match="Great Lakes") as caught:
        resolve_endpoint("Chicago", chart(), "goal")
    assert "position at sea" in str(caught.value)


def test_via_ports_are_passed_off_their_sea_ends():
    end = without_approach(resolve_endpoint("London", chart(), "via point 1"))
    assert end.approach is None
    assert (end.lat, end.lon) == approach_of("London").sea_end
    assert "does not enter it" in end.note


def test_an_approach_through_a_no_go_zone_is_not_used():
    box = [[4.0, 51.9], [4.2, 51.9], [4.2, 52.0], [4.0, 52.0], [4.0, 51.9]]
    zone = {
        "type": "Feature",
        "properties": {"kind": "no-go"},
        "geometry": {"type": "Polygon", "coordinates": [box]},
    }
    end = resolve_endpoint("Rotterdam", chart().with_zones(zone), "start")
    assert end.approach is None


def test_charts_of_the_users_own_have_no_approaches():
    water = Chart.open_water(50.0, 54.0, 0.0, 6.0)
    end = resolve_endpoint("Rotterdam", water, "start")
    assert end.approach is None
    assert end.moved_distance_m == 0.0


def test_slow_ships_keep_their_own_speed_in_approaches():
    slow = Ship.simple(speed_kn=7.0)
    assert approach_speed(slow, 0) == pytest.approx(7.0 * KNOT)
    assert approach_speed(ship(), len(ship().speeds) - 1) == MAX_APPROACH_SPEED
    field = SimpleNamespace(speeds=[np.nan], approach_speed=MAX_APPROACH_SPEED)
    assert approach_speed(field, 0) == MAX_APPROACH_SPEED
    line = approach_of("Rotterdam").line
    route = thalweg.evaluate(line, ship=slow, sea=Sea.calm(), chart=chart(), depart=DEPART)
    assert route.feasible
    assert route.time_h * HOUR == pytest.approx(approach_of("Rotterdam").length / (7.0 * KNOT))


@pytest.mark.slow
def test_departure_is_from_the_berth():
    plan = planned(objective="distance")
    assert plan.best.depart == plan.voyage.earliest_departure
    assert plan.lower_bound <= plan.objective_value * (1.0 + 1e-9)
    assert plan.objective_value == pytest.approx(plan.best.distance_nm)


@pytest.mark.slow
def test_a_ship_waits_for_lower_waves_at_her_berth_and_not_off_the_port():
    """Waves of 6 m everywhere until noon: at the sea end of the approach she would lie in them."""
    noon = float(Voyage(start="Rotterdam", goal="Lowestoft", depart=DEPART).depart) + 12.0 * HOUR
    name = "sea_surface_wave_significant_height"
    high = {name: lambda t, y, x: np.where(t < noon, 6.0, 1.0) + 0.0 * y}
    sea = Sea.layered(Sea.from_functions(high), Sea.calm())
    small = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wave_height_m=4.0)
    voyage = Voyage(start="Rotterdam", goal="Lowestoft", depart=DEPART)
    found = thalweg.plan(voyage, ship=small, sea=sea, chart=chart())
    best = found.best
    length = best.distance_nm * NAUTICAL_MILE
    approach = approach_of("Rotterdam")
    out = approach.duration(approach_speed(small, 0))
    assert np.flatnonzero(best.track.wait).tolist() == [0]
    assert best.depart == voyage.depart and best.feasible
    assert best.track.wait[0] == pytest.approx(12.0 * HOUR - out, abs=60.0)
    assert best.time_h * HOUR == pytest.approx(
        best.track.wait[0] + length / (10.0 * KNOT), rel=0.01
    )
    assert best.wait_samples["leg"].max() == 0
    assert found.lower_bound <= best.time_h
    assert not any(note.startswith("Waits at sea") for note in found.notes)


def test_degrees_that_may_be_swapped_are_noted():
    end = resolve_endpoint("4.1,52.0", chart(), "start")
    assert end.note.startswith("Check the position: 4.1,52 is read as 4.1000N 52.0000E, more than")
    assert "52.0000N 4.1000E is 3 nm from Europoort, NL: latitude comes first." in end.note
    for sound in ("52.0,4.1", "45.0,-30.0", "36.2,14.2"):
        assert "Check" not in resolve_endpoint(sound, chart(), "start").note


@pytest.mark.parametrize(("start", "goal"), [
    ("5.03,61.604", "-3.7645,43.47"),  # both ends swapped
    ("52.0,4.0", "4.08,51.98"),  # one, far from the other
    ("Rotterdam", "4.08,51.98"),
])  # fmt: skip
def test_swapped_degrees_are_refused(start, goal):
    with pytest.raises(InputError, match="seem to be swapped") as caught:
        resolve_places(start, (), goal, chart())
    assert "write them with letters" in caught.value.remedy


def test_degrees_with_letters_are_not_called_swapped():
    ends = resolve_places("5.03N 61.604E", (), "3.7645S 43.47E", chart())
    assert [round(end.lat, 3) for end in ends] == [5.03, -3.764]
    assert len(resolve_places("4.1,52.0", (), "-10.0,60.0", chart())) == 2  # the goal is no port


def test_a_position_of_an_approach_given_twice_takes_no_time():
    line = np.array(PORT_APPROACHES.of(PORTS.lookup("DEWVN")).line)
    twice = np.insert(line, 2, line[2], axis=0)
    once, again = (
        thalweg.evaluate(
            Track(*track.T, 0.0, setting=np.zeros(len(track) - 1, int)),
            ship=ship(), sea=Sea.calm(), chart=chart(),
        )
        for track in (line, twice)
    )  # fmt: skip
    assert again.feasible
    assert again.time_h == pytest.approx(once.time_h, rel=1e-9)


@pytest.mark.slow
def test_a_voyage_along_approaches_names_what_is_too_small_for_the_ship():
    """Between the two berths lies the Humber Bridge; the port of Goole has locks."""
    hull = {
        "length_overall_m": 292.0, "breadth_m": 45.0, "draught_m": 18.2, "air_draught_m": 50.0,
    }  # fmt: skip
    large = Ship.from_dict({"name": "cape size", "hull": hull, "speeds_kn": [12.0]})
    voyage = Voyage(start="Hull", goal="Goole", depart=DEPART)
    notes = thalweg.plan(voyage, ship=large, sea=Sea.calm()).notes
    (bridge,) = [note for note in notes if "Humber Bridge" in note]
    assert "the air draught of 50 m is over its clearance of 30 m" in bridge
    ports = [note for note in notes if note.startswith("The port is too shallow")]
    assert any("the largest draught in Goole, GB is 6 m" in note for note in ports)
