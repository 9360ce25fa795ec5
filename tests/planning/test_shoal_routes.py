"""Deep ships keep out of shoals on real coasts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.depth.global_depth import coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.errors import NoPathError
from thalweg.core.geodesy import densify, direct, distance
from thalweg.core.limits import Limits
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning import Voyage, plan
from thalweg.planning.offing_attempts import plan_off_land
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.report.depth_report import depth_notes
from thalweg.planning.report.provenance import given_route_warnings
from thalweg.planning.request.requirements import Requirements
from thalweg.planning.request.shoal_choice import add_shoals, close_shoals
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import evaluate
from thalweg.route.doubtful_depth import water_to_check
from thalweg.sea import Sea
from thalweg.ship import Ship

BULKER = Ship.simple(13.0, 12.0, length_m=190.0, breadth_m=32.0)
WORLD = Chart.gshhg("i")
ENDS = [Endpoint("A", 40.4, -73.8, 0.0), Endpoint("B", 42.4, -70.7, 0.0)]


def voyage(start, goal, **more):
    return Voyage(start=start, goal=goal, depart="2026-01-01T00:00Z", **more)


def line_of(route):
    lat, lon, _ = densify(route.track.lat, route.track.lon, 0.5 * NAUTICAL_MILE)
    return lat, lon


def open_part(route, off):
    """Positions of a route farther from its ends than so many miles."""
    lat, lon = line_of(route)
    away = np.minimum(distance(lat, lon, lat[0], lon[0]), distance(lat, lon, lat[-1], lon[-1]))
    keep = away > off * NAUTICAL_MILE
    return lat[keep], lon[keep]


@pytest.mark.slow
@pytest.mark.parametrize("goal", ["USBOS", "Halifax, CA"])
def test_deep_ships_from_new_york_pass_outside_nantucket_shoals(goal):
    found = plan(voyage("USNYC", goal), ship=BULKER, sea=Sea.calm())
    lat, lon = line_of(found.best)
    assert not SHOAL_AREAS[0].contains(lat, lon).any()
    off_nantucket = np.interp(41.1, lat[np.argsort(lat)], lon[np.argsort(lat)])
    assert lat[np.abs(lon + 70.1) < 0.05].min() < 40.75  # not through Nantucket Sound
    assert off_nantucket > -69.4
    assert np.nanmin(coarse_depth(*open_part(found.best, 20.0))) > 17.0
    assert any("The route avoids water shallower than 20 m" in note for note in found.notes)
    assert not any("Check the depth" in note for note in found.notes)


@pytest.mark.slow
def test_with_shoals_ignored_the_legs_to_check_are_named():
    request = voyage("USNYC", "USBOS", ignore_shoals=True)
    found = plan(request, ship=BULKER, sea=Sea.calm())
    assert found.best.distance_nm < 300.0
    (note,) = (note for note in found.notes if note.startswith("Check the depth"))
    assert "12.0 m are required" in note and ", passed at " in note
    assert request.to_dict()["ignore_shoals"] is True


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "least"),
    [
        ((53.6, 0.9), (57.0, 8.0), 18.0),  # Dogger Bank
        ("Miami, US", "San Juan, PR", 12.0),  # Bahama banks
        ("Colombo, LK", "Chennai, IN", 13.0),  # Palk Strait, Gulf of Mannar
        ((27.6, -77.0), (25.0, -77.0), 20.0),  # Bight of Abaco
        ("Townsville, AU", "Honiara, SB", 12.0),  # Great Barrier Reef
        ("Veracruz, MX", "Miami, US", 12.0),  # Yucatan bank, Florida Keys
    ],
)
def test_deep_ships_stay_in_water_that_is_deep_enough_by_the_layer(start, goal, least):
    found = plan(voyage(start, goal), ship=BULKER, sea=Sea.calm())
    assert np.nanmin(coarse_depth(*open_part(found.best, 30.0))) >= least


@pytest.mark.slow
def test_in_the_open_english_channel_no_depth_is_in_doubt():
    found = plan(voyage((50.1, -2.5), (49.6, -5.0)), ship=BULKER, sea=Sea.calm())
    assert not any("depth" in note and " 0 m" in note for note in found.notes)
    assert not any("Check the depth" in note for note in found.notes)


def test_plans_with_depth_or_without_offing_or_of_own_charts_are_left_alone():
    calm = Sea.calm()
    plain = voyage((40.4, -73.8), (42.4, -70.7))
    with_shoals, notes = add_shoals(WORLD, plain, BULKER, calm, ENDS)
    assert with_shoals.zones.shoals.contour == 20.0 and len(notes) == 1
    deep = WORLD.with_depth(lambda lat, lon: 50.0 + 0.0 * lat)
    for chart, request in (
        (deep, plain),
        (Chart.open_water(), plain),
        (WORLD, voyage((40.4, -73.8), (42.4, -70.7), offing_nm=0.0)),
    ):
        same, notes = add_shoals(chart, request, BULKER, calm, ENDS)
        assert same.zones.shoals is None and notes == []


@pytest.mark.slow
def test_with_shoals_ignored_reefs_stay_closed():
    """The reefs of Fiji were crossed with the flag that a note on the coarse layer advises."""
    ship = Ship.simple(12.0, 5.5, length_m=88.0)
    found = plan(voyage("Suva", "Labasa", ignore_shoals=True), ship=ship, sea=Sea.calm(), proof=0.0)
    assert not any(note.startswith("Crosses") for note in found.notes)
    assert 170.0 < found.best.distance_nm < 185.0  # 167 over four reefs
    assert any("Shoals were not avoided, as asked, but" in note for note in found.notes)


def test_with_shoals_ignored_only_areas_that_dry_count():
    asked = voyage((40.4, -73.8), (42.4, -70.7), ignore_shoals=True)
    chart, (note,) = add_shoals(WORLD, asked, BULKER, Sea.calm(), ENDS)
    closed = close_shoals(chart, ENDS)[0].zones.closed_shoals
    assert "that dry" in note
    usual, _ = add_shoals(WORLD, replace(asked, ignore_shoals=False), BULKER, Sea.calm(), ENDS)
    default = close_shoals(usual, ENDS)
    dry = [area for area in SHOAL_AREAS if area.dries and not area.is_exact]
    assert {area.name for area in SHOAL_AREAS if closed.closes(area)} >= {area.name for area in dry}
    nantucket = SHOAL_AREAS[0]
    assert not closed.closes(nantucket) and default[0].zones.closed_shoals.closes(nantucket)
    shoals = chart.zones.shoals
    lat, lon = np.array([41.1]), np.array([-69.7])  # Nantucket Shoals
    assert shoals.excess(lat, lon, lat, lon + 0.05)[0] == 0.0
    reef = dry[0].polygon.representative_point()
    assert shoals.excess(reef.y, reef.x, reef.y, reef.x + 0.01) > 10.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "draught", "length"), [("Rotterdam", "Esbjerg", 6.0, 110.0)]
)
def test_ships_keep_off_the_grounds_between_the_points_of_the_layer(start, goal, draught, length):
    ship = Ship.simple(13.0, draught, length_m=length)
    found = plan(voyage(start, goal), ship=ship, sea=Sea.calm(), proof=0.0)
    lat, lon = line_of(found.best)
    texel = (lat > 53.0) & (lat < 53.35) & (lon < 5.2)  # Eierlandse Gronden, 3 nm off the land
    shore = WORLD.coastline.shore_distance(lat[texel], lon[texel])
    assert shore.min() > 3.0 * NAUTICAL_MILE


def test_a_route_from_a_file_gets_the_same_depth_warnings():
    line = [(41.0, -70.3), (41.2, -69.9), (41.5, -69.6)]  # across Nantucket Shoals
    route = evaluate(line, ship=BULKER, sea=Sea.calm(), chart=WORLD, depart=0)
    found = given_route_warnings(route, chart=WORLD, sea=Sea.calm(), ship=BULKER, min_ukc=0.0)
    assert any(note.startswith("Crosses Nantucket Shoals") for note in found)
    (note,) = (note for note in found if note.startswith("Check the depth: 12.0 m "))
    assert " has 12 m near 41 " in note and "passed at 1970-01-01T0" in note
    lat, lon, check = water_to_check(WORLD, route, BULKER, 0.0)
    assert check.any() and SHOAL_AREAS[0].contains(lat[check], lon[check]).any()
    assert not water_to_check(Chart.open_water(), route, BULKER, 0.0)[2].any()
    more = given_route_warnings(route, chart=WORLD, sea=Sea.calm(), ship=BULKER, min_ukc=2.0)
    assert any(note.startswith("Check the depth: 14.0 m are required") for note in more)
    charted = Chart.open_water().with_depth(lambda lat, lon: 50.0 + 0.0 * lat)
    checked = evaluate(line, ship=BULKER, sea=Sea.calm(), chart=charted, depart=0)
    assert not given_route_warnings(checked, chart=WORLD, sea=Sea.calm(), ship=BULKER, min_ukc=0.0)


@pytest.mark.slow
def test_ships_that_fit_take_the_kiel_canal_and_others_are_told_why_not():
    def planned(draught, length):
        ship = Ship.simple(14.0, draught, length_m=length, breadth_m=22.0)
        request = voyage((53.9, 5.2), (54.65, 18.9), objective="distance")
        return plan(request, ship=ship, sea=Sea.calm(), proof=0.0)

    small, large = planned(6.5, 140.0), planned(9.0, 180.0)
    # the shoals of the outer Elbe in the depth layer do not close the way to the canal
    assert small.best.distance_nm < 600.0
    assert any("Elbe (Brunsbuttel to sea)" in note for note in small.notes)
    # nor do those off its other gate in the Kiel Fjord raise an alarm: ships have a dredged way
    assert not any("54 2" in note for note in small.notes if note.startswith("Check the depth"))
    assert large.best.distance_nm > 750.0
    assert any("Kiel Canal" in note and "for 180 m of length" in note for note in large.notes)


@pytest.mark.slow
def test_shoals_are_closed_and_open_again_where_no_other_way_exists():
    ends = [Endpoint("A", 40.4, -73.8, 0.0), Endpoint("Sound", 41.45, -70.2, 0.0)]
    chart, _ = add_shoals(WORLD, voyage((40.4, -73.8), (42.4, -70.7)), BULKER, Sea.calm(), ends)
    closed, note, _ = close_shoals(chart, ENDS)
    assert closed.zones.closed_shoals.depth == 9.6 and "less than 9.6 m" in note
    assert closed.legs_blocked(41.45, -70.3, 41.45, -70.1)
    inside, *_ = close_shoals(chart, ends)  # a place in the sound opens it
    assert not inside.legs_blocked(41.45, -70.3, 41.45, -70.1)
    assert close_shoals(WORLD, ENDS) == (WORLD, "", ())

    def run(tried):
        kept, discs = tried.needs.limits.offing, tried.chart.offing.discs
        near = [disc for disc in discs if disc.lat == ENDS[0].lat]
        closed = tried.chart.zones.closed_shoals is not None
        least, radius = (near[0].least, near[0].radius) if near else (kept, 0.0)
        tries.append((closed, *(v / NAUTICAL_MILE for v in (kept, least, radius))))
        if len(tries) < 6:
            raise NoPathError("No way.", "None.", "None.")
        return tried

    tries = []
    needs = Requirements((), Limits(), (), np.inf)
    context = PlanningContext(voyage((40.4, -73.8), (42.4, -70.7)), BULKER, Sea.calm(), chart,
                              needs, None, None)  # fmt: skip
    found = plan_off_land(context, ENDS, 2.0 * NAUTICAL_MILE, run, length_of=lambda planned: 0.0)
    assert tries == [
        (True, 2.0, 2.0, 0.0), (True, 2.0, 2.0, 0.0),
        (True, 2.0, 0.5, 15.0), (True, 2.0, 0.5, 40.0), (True, 2.0, 0.0, 15.0),
        (True, 1.0, 1.0, 0.0),
    ]  # fmt: skip
    assert not any(note.startswith("Closed:") for note in found.needs.notes)


def test_a_short_way_over_flats_is_stated_where_the_layer_does_not_count():
    """South San Francisco Bay, within 12 nm of both ends."""
    chart = Chart.gshhg("i")
    ship = Ship.simple(12.0, 16.5, length_m=270.0, breadth_m=48.0)
    line = [(37.80, -122.35), (37.66, -122.25), (37.57, -122.16)]
    route = evaluate(line, ship=ship, sea=Sea.calm(), chart=chart, depart="2026-01-01")
    (note,) = depth_notes(chart, route, ship, 2.0)
    assert note.startswith("Check the depth: the whole way is near its ends")
    assert "and 18.5 m are required" in note
    shallow = Ship.simple(12.0, 0.4, length_m=10.0, breadth_m=3.0)
    assert depth_notes(chart, route, shallow, 0.0) == []


def test_drying_areas_are_closed_to_a_yacht_where_the_layer_closes_nothing():
    """Ships that require 2 m or less had no closed water at all."""
    yacht, calm = Ship.simple(6.0, 1.6, length_m=12.0), Sea.calm()
    ends = [Endpoint("A", 49.05, -1.80, 0.0), Endpoint("B", 49.40, -2.20, 0.0)]
    chart, _ = add_shoals(WORLD, voyage((49.05, -1.80), (49.40, -2.20)), yacht, calm, ends)
    closed, note, _ = close_shoals(chart, ends)
    assert note == "Closed: named shoal areas with less than 0.8 m."
    assert closed.legs_blocked(49.145, -2.06, 49.145, -1.98)  # Violet Bank
    assert not closed.legs_blocked(49.12, -2.09, 49.12, -2.03)  # south of it
    assert not closed.legs_blocked(49.14, -1.96, 49.19, -1.96)  # Violet Channel


def test_the_box_of_closed_shoals_holds_what_is_near_the_ends_and_not_the_world():
    """New York to the Channel: 0.6 of 2,800 nm round both ends is half of the globe at most."""
    ends = [Endpoint("New York", 40.4, -73.8, 0.0), Endpoint("Scilly", 49.7, -6.5, 0.0)]
    asked = voyage("40.4N 73.8W", "49.7N 6.5W")
    chart, _ = add_shoals(WORLD, asked, BULKER, Sea.calm(), ends)
    south, north, west, east = close_shoals(chart, ends)[0].zones.closed_shoals.box
    course = np.radians(np.arange(0.0, 360.0, 5.0))
    for end in ends:
        lat, lon = direct(end.lat, end.lon, course, 0.59 * distance(40.4, -73.8, 49.7, -6.5))
        assert ((south <= lat) & (lat <= north)).all()
        assert ((west <= lon) & (lon <= east)).all()
    assert east - west < 180.0
