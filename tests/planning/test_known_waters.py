"""Ways by sea through straits with limits: the deep one is taken, and no shallower one instead."""

from __future__ import annotations

import numpy as np
import pytest

from tests.planning.distances import sea_distance
from thalweg import Sea, Ship, Voyage, plan
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.closed_way_report import PASSAGE_CLOSED

pytestmark = pytest.mark.slow


def track(route):
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    return densify(lat, lon, 0.2 * NAUTICAL_MILE)[:2]


def miles_from(place, lat, lon):
    return float(distance(*place, lat, lon).min()) / NAUTICAL_MILE


def calm_plan(start, goal, ship, **more):
    voyage = Voyage(start=start, goal=goal, depart="2026-07-01T00:00Z", **more)
    return plan(voyage, ship=ship, sea=Sea.calm(), proof=0.0)


@pytest.mark.parametrize(
    ("start", "goal", "draught"),
    [
        ("Oulu", "Gavle", 10.0),
        ("Lulea", "Stockholm", 10.0),
        ("Lulea", "Gothenburg", 9.5),
        ("Kokkola", "Rotterdam", 13.0),
    ],
)
def test_ships_of_the_bothnian_bay_pass_kvarken(start, goal, draught):
    found = sea_distance(start, goal, draught_m=draught)
    assert "Kvarken (Norra)" in found.straits
    line = densify(*np.array(found.line).T, NAUTICAL_MILE)[:2]
    assert miles_from((63.78, 20.72), *line) > 5.0  # Vastra Kvarken


def test_a_plan_through_kvarken_keeps_its_offing():
    found = calm_plan("Lulea", "Gavle", Ship.load("handysize-bulker"))
    assert any(note.startswith("Keeps 2 nm off land") for note in found.notes)
    assert miles_from((63.817, 20.867), *track(found.best)) > 5.0  # shoals of 5.9 m


@pytest.mark.parametrize("draught", [8.0, 11.5, 13.0])
def test_deep_ships_do_not_reach_surabaya_through_madura_strait(draught):
    found = sea_distance("Surabaya", "Singapore", draught_m=draught)
    assert found.nm == pytest.approx(765.0, abs=10.0)  # 940 by the east
    shallow = [note for note in found.notes if note.startswith("The port is too shallow")]
    assert len(shallow) == (draught > 12.0)


def test_small_ships_use_the_eastern_channel_of_surabaya():
    assert sea_distance("Surabaya", "Probolinggo", draught_m=5.0).nm < 60.0
    assert sea_distance("Surabaya", "Probolinggo", draught_m=8.0).nm > 150.0


def test_the_inner_route_is_sailed_off_the_reefs_of_princess_charlotte_bay():
    ship = Ship.simple(14.0, 9.5, length_m=180.0)
    found = calm_plan("Cairns", (-10.53, 142.0), ship, objective="distance")
    lat, lon = track(found.best)
    for reef in ((-13.98, 144.43), (-13.98, 144.51), (-13.97, 144.13)):  # Davie, Tydeman, Corbett
        assert miles_from(reef, lat, lon) > 2.0
    assert miles_from((-10.672, 142.605), lat, lon) < 1.5  # Adolphus Channel


def test_manila_is_left_between_its_islands():
    lat, lon = track(calm_plan("Manila", "Davao", Ship.load("handysize-bulker")).best)
    assert miles_from((14.3075, 120.6285), lat, lon) > 1.2  # El Fraile
    assert miles_from((14.45, 120.745), lat, lon) > 1.5  # San Nicolas Shoals
    assert miles_from((14.343, 120.635), lat, lon) < 1.0


def test_ships_out_of_the_bohai_keep_south_of_the_separation_line():
    found = calm_plan("Qinhuangdao", "Shanghai", Ship.load("handysize-bulker"))
    lat, lon = track(found.best)
    assert miles_from((38.727, 121.137), lat, lon) > 10.0  # Laotieshan Jiao; 2.0 nm before
    assert any("Laotieshan Channel" in note for note in found.notes)


def test_buenos_aires_to_montevideo_does_not_turn_back():
    found = sea_distance("Buenos Aires", "Montevideo", draught_m=9.5)
    assert 118.0 < found.nm < 128.0  # 147 by the end of the Plate channel
    assert not any("Turns back" in note for note in found.notes)


def test_bonifacio_is_open_to_medium_ships():
    found = sea_distance("Barcelona, ES", "Naples")
    assert "Bonifacio" in found.straits
    assert found.nm == pytest.approx(555.0, rel=0.015)  # as tables give it
    assert sea_distance("Barcelona, ES", "Naples", avoid=["Bonifacio"]).nm > 590.0


def test_a_distance_names_passages_that_its_draught_closes():
    closed = sea_distance("Lulea", "Gothenburg", draught_m=9.5)
    (note,) = (note for note in closed.notes if note.startswith(PASSAGE_CLOSED))
    assert "Oresund: the draught of 9.5 m is over the 7.7 m allowed" in note
    through = sea_distance("Lulea", "Gothenburg", draught_m=7.0)
    shorter = float(note.partition("is about ")[2].partition(" nm")[0])
    assert shorter == pytest.approx(closed.nm - through.nm, abs=1.5)
    assert not any(note.startswith(PASSAGE_CLOSED) for note in through.notes)


@pytest.mark.parametrize(
    ("goal", "draught", "begins"),
    [
        ("Seward", 12.0, "The port is too shallow: the largest draught in Seward, US is 11 m"),
        ("Seward", 10.0, None),
        (
            "Valdez",
            12.0,
            "No largest draught in Valdez, US is known, nor the depth along its "
            "approach of 21 nm: ask the port.",
        ),
        ("Valdez", 8.5, None),
    ],
)
def test_deep_ships_are_warned_of_ports_that_are_shallow_or_of_unknown_depth(goal, draught, begins):
    start = (59.0, -148.0)
    notes = sea_distance(start, goal, draught_m=draught).notes
    about = [note for note in notes if "largest draught" in note]
    assert len(about) == (begins is not None)
    assert begins is None or about[0].startswith(begins)


@pytest.mark.parametrize("draught", [15.0, 20.0])
@pytest.mark.parametrize("port", ["Guangzhou", "Huangpu"])
def test_deep_ships_are_warned_of_the_channel_to_guangzhou(port, draught):
    """A draught of 15 or 20 m had no word on the depth of the channel."""
    notes = sea_distance("Hong Kong", port, draught_m=draught).notes
    (note,) = (one for one in notes if f"largest draught in {port}" in one)
    assert note.startswith("The port is too shallow")
    assert "13 m (channel above Nansha dredged to about 13 m" in note


@pytest.mark.parametrize(
    ("start", "goal", "draught", "passage", "miles"),
    [
        ("Hong Kong", "Shekou", 12.0, "Ma Wan (Hong Kong)", 22.4),  # 56 south of Lantau
        ("Hong Kong", "Huangpu", None, "Ma Wan (Hong Kong)", 68.5),  # 70 in tables, 95 before
        ("Shekou", "Xiamen", 9.5, "East Lamma Channel (Hong Kong)", 314.9),  # 309.5 through farms
        ("Cheju", "Mokpo", 8.0, "Mokpo: Jangjuk and Sia channels", 90.5),  # 134 from the north
        ("Busan", "Mokpo", 8.0, "Mokpo: Jangjuk and Sia channels", 215.0),
        ("Jakarta", "Palembang", 6.0, "Bangka", 335.0),  # 534 round Bangka
        ("Jakarta", "Palembang", 11.0, "Gelasa (Gaspar)", 451.0),
        ("Seattle", (48.82, -122.78), 12.0, "Rosario Strait", 83.5),  # 102 by Haro Strait
        ("Seattle", "Vancouver, CA", 11.0, "Rosario Strait", 130.2),  # 136; published 126
        ("Port Moresby", "Lae", 8.0, "China Strait", 585.0),
        ("Cebu", "Davao", 8.0, "Surigao", 491.5),  # 570 by Zamboanga
        ("Cebu", "Davao", 11.0, "Surigao", 491.5),
    ],
)
def test_ships_use_the_narrow_passages_of_their_trade(start, goal, draught, passage, miles):
    found = sea_distance(start, goal, draught_m=draught)
    assert passage in found.straits
    assert found.nm == pytest.approx(miles, rel=0.015)


def test_anacortes_to_vancouver_leads_through_rosario_strait():
    found = sea_distance("Anacortes", "Vancouver", draught_m=11.0)
    assert found.nm == pytest.approx(69.0, abs=2.0)  # 99 by Haro Strait


def test_hinatuan_passage_is_for_small_ships():
    assert sea_distance("Cebu", "Davao", open=["Hinatuan"]).nm == pytest.approx(428.0, abs=5.0)
    assert "Hinatuan Passage" not in sea_distance("Cebu", "Davao").straits


@pytest.mark.parametrize("draught", [12.0, 15.0])
def test_deep_ships_from_eastern_australia_pass_jomard_entrance(draught):
    found = sea_distance("Newcastle, AU", "Yokohama", draught_m=draught)
    assert "Jomard Entrance" in found.straits
    line = densify(*np.array(found.line).T, NAUTICAL_MILE)[:2]
    for reef in ((-10.77, 151.78), (-11.2, 151.6), (-8.5, 150.5), (-9.27, 150.85)):
        assert miles_from(reef, *line) > 6.0  # Conflict Group, barrier reef, Lusancay, Amphlett
    assert found.nm == pytest.approx(4266.0, abs=10.0)


@pytest.mark.parametrize("draught", [None, 5.0, 8.0])
def test_ships_keep_off_the_sand_ridges_of_jiangsu(draught):
    found = sea_distance("Shanghai", "Qingdao", draught_m=draught)
    assert found.nm == pytest.approx(381.0, abs=5.0)  # 332 over them for a ship of 5 m
    line = densify(*np.array(found.line).T, NAUTICAL_MILE)[:2]
    assert miles_from((32.9, 121.6), *line) > 20.0


@pytest.mark.parametrize("draught", [5.0, 8.0, 11.0])
def test_manila_to_cebu_is_as_far_for_all_draughts(draught):
    found = sea_distance("Manila", "Cebu", draught_m=draught)  # 423, 437 and 426, then 408 to 410
    assert "Hilutangan Channel (Cebu)" in found.straits
    assert found.nm == pytest.approx(405.5, abs=2.0)


@pytest.mark.parametrize(
    ("start", "goal", "miles"),
    [
        ("Manila", "Cebu", 414.0),  # 502 west of Panay
        ("Shekou", "Xiamen", 316.0),  # 356 west of Lantau, over 2 m; 310 through wind farms
    ],
)
def test_plans_of_coasters_are_as_long_as_distances(start, goal, miles):
    found = calm_plan(start, goal, Ship.load("handysize-bulker"), objective="distance")
    assert found.best.distance_nm == pytest.approx(miles, rel=0.01)


def test_one_approach_is_left_early_where_both_lead_over_shoals():
    found = sea_distance("Hong Kong", "Huangpu")
    assert not any("Turns back" in note for note in found.notes)


def test_the_tail_of_the_horseshoe_stays_closed_where_the_depth_layer_opens():
    """The layer has too little depth in Chesapeake Bay: all shoals were opened before."""
    ship = Ship.simple(speed_kn=14.0, draught_m=11.0, length_m=180.0, breadth_m=30.0)
    found = calm_plan("Norfolk, US", "Baltimore, US", ship)
    (note,) = (note for note in found.notes if note.startswith("The route crosses shoal water"))
    assert note.startswith("The route crosses shoal water, but for named areas of exact outline:")
    line = track(found.best)
    for name in ("Tail of the Horseshoe", "Point No Point (Chesapeake Bay)"):
        (area,) = (area for area in SHOAL_AREAS if area.name == name)
        assert not area.contains(*line).any()
    assert miles_from((38.9935, -76.3825), *line) < 0.1  # main span of the Bay Bridge
    assert miles_from((37.0305, -76.0855), *line) < 0.5  # tunnel of the Chesapeake Channel


@pytest.mark.parametrize(
    ("start", "goal", "near", "far"),
    [
        ("Kotka", "Helsinki, FI", None, (59.9851, 25.6010)),  # Kalbadagrund: 0.1 nm off before
        ("Batam", "Palembang", (1.0810, 104.2000), None),  # Riau Strait
    ],
)
def test_coasters_keep_off_a_light_and_use_a_strait(start, goal, near, far):
    coaster = Ship.simple(speed_kn=11.0, draught_m=5.5, length_m=88.0)
    line = track(calm_plan(start, goal, coaster).best)
    assert near is None or miles_from(near, *line) < 1.0
    assert far is None or miles_from(far, *line) > 1.0
