"""Lines of straits and approaches in waters whose channels are known, off reefs and banks."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.approaches import PORT_APPROACHES, dense_line
from thalweg.chart.depth.closed_shoals import ClosedShoals
from thalweg.chart.depth.global_depth import coarse_depth
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.passages import find_passages
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.approach_report import port_depth_note


def approach(name):
    return PORT_APPROACHES.of(PORTS.find(name))


def least_miles(line, place):
    lat, lon, _ = densify(*np.array(line, float).T, 0.1 * NAUTICAL_MILE)
    return float(distance(*place, lat, lon).min()) / NAUTICAL_MILE


def test_kvarken_takes_the_ships_of_kokkola_and_vastra_kvarken_does_not():
    kvarken, western = find_passages(["Kvarken", "Vastra Kvarken"])
    assert kvarken.ship_restriction(draught=12.9, length=230.0) == ""
    assert "draught of 6 m" in western.ship_restriction(draught=6.0, length=100.0)
    assert "ships below 120 m" in western.ship_restriction(draught=4.5, length=140.0)


# Positions: mid-channel between land of GSHHG h; channels by general knowledge.
@pytest.mark.parametrize("port", ["Montreal", "Quebec", "Trois Rivieres", "Sorel"])
@pytest.mark.parametrize(
    ("place", "within"),
    [
        ((47.850, -69.800), 0.5),  # north of Ile aux Lievres
        ((47.472, -70.198), 0.5),  # off Cap aux Oies
        ((47.435, -70.385), 0.5),  # Passage de l'Ile aux Coudres
        ((47.080, -70.695), 0.5),  # Traverse du Nord
        ((46.888, -70.926), 0.5),  # south of Ile d'Orleans
    ],
)
def test_approaches_in_the_st_lawrence_follow_the_ship_channel(port, place, within):
    assert least_miles(approach(port).line, place) < within
    assert least_miles(approach(port).line, (47.50, -70.10)) > 2.0  # the old straight leg


def test_the_inner_route_keeps_off_reefs_and_passes_the_adolphus_channel():
    (route,) = find_passages(["Inner Route"])
    assert least_miles(route.line, (-10.672, 142.605)) < 0.5  # Adolphus Channel
    davie, corbett, tydeman = (-13.98, 144.43), (-13.98, 144.13), (-13.98, 144.51)
    assert min(least_miles(route.line, reef) for reef in (davie, corbett, tydeman)) > 2.5
    assert least_miles(route.line, (-13.50, 143.78)) < 0.5  # east of Morris Island
    lat, lon, _ = densify(*route.positions, 0.2 * NAUTICAL_MILE)
    (reefs,) = (area for area in SHOAL_AREAS if "Corbett" in area.name)
    assert not reefs.contains(lat, lon).any()


def test_named_reefs_stay_closed_two_miles_beside_a_channel():
    (area,) = (area for area in SHOAL_AREAS if area.name == "Serrana bank")
    line = ((14.10, -80.275), (14.60, -80.275))
    closed = ClosedShoals(9.0, (line,), box=(14.0, 15.0, -81.0, -79.0))
    beside = -80.275 + np.array([1.0, 2.0]) / 60.0 / np.cos(np.radians(14.35))
    assert area.contains(np.full(2, 14.35), beside).all()
    assert closed.contains(np.full(2, 14.35), beside).tolist() == [False, True]


def test_manila_bay_has_its_two_channels_and_its_shoal():
    for name, islet in (
        ("Manila Bay: South Channel", (14.3075, 120.6285)),  # El Fraile
        ("Manila Bay: North Channel", (14.377, 120.520)),  # La Monja
    ):
        (channel,) = find_passages([name])
        assert least_miles(channel.line, islet) > 1.0
        assert least_miles(channel.line, (14.45, 120.733)) > 1.5  # San Nicolas Shoals
    assert any(area.contains(14.45, 120.74) for area in SHOAL_AREAS)


def test_kolkata_follows_the_bends_of_the_hooghly():
    # 232 km from Sandheads, 10 miles beyond the end of this line; a straighter line had 103.5 nm
    assert 110.0 < approach("Kolkata").length / NAUTICAL_MILE < 125.0


@pytest.mark.parametrize(
    ("port", "draught"),
    [("Port Hedland", 18.5), ("Yanbu", 20.0), ("Dampier", 18.0), ("Abidjan", 12.0)],
)
def test_great_ports_are_not_called_too_shallow_for_the_ships_they_take(port, draught):
    assert port_depth_note(approach(port), draught) == ""


@pytest.mark.parametrize(
    ("port", "draught", "largest"),
    [("Montreal", 12.0, "11.3 m"), ("Surabaya", 13.0, "12 m"), ("Port Hedland", 20.5, "19.5 m")],
)
def test_largest_draughts_of_the_table_are_named_with_their_source(port, draught, largest):
    note = port_depth_note(approach(port), draught)
    assert largest in note and "general knowledge, unchecked" in note
    assert "World Port Index" not in note


def test_the_index_is_the_source_of_other_ports():
    assert "the World Port Index gives 17.5 m" in port_depth_note(approach("Richards Bay"), 18.0)


def test_belize_is_reached_by_the_channel_of_english_cay():
    line = approach("Belize City").line
    assert least_miles(line, (17.327, -88.045)) < 1.0
    lat, lon, _ = densify(*np.array(line, float).T, 0.1 * NAUTICAL_MILE)
    reefs = [area for area in SHOAL_AREAS if "Belize" in area.name]
    assert len(reefs) == 2
    assert not any(area.contains(lat, lon).any() for area in reefs)
    gladden_spit, tobacco_cay, goffs_cay = (16.52, -87.97), (16.9, -88.05), (17.35, -88.03)
    for place in (gladden_spit, tobacco_cay, goffs_cay):
        assert any(area.contains(*np.array([place]).T)[0] for area in reefs)


@pytest.mark.parametrize(
    ("port", "miles"),
    # the Danube is marked in nautical miles from Sulina, 4 inside the sea end: Galati at 80
    [("Tulcea", 42.4), ("Izmail", 59.2), ("Reni", 72.0), ("Galati", 84.0), ("Braila", 96.0)],
)
def test_ports_on_the_danube_are_reached_by_the_sulina_canal(port, miles):
    line = approach(port)
    assert line.length / NAUTICAL_MILE == pytest.approx(miles, rel=0.03)
    assert least_miles(line.line, (45.178, 29.194)) < 0.5  # the canal at Gorgova
    assert "7.3 m" in port_depth_note(line, 8.0)


@pytest.mark.parametrize(
    ("name", "code"),
    [("Yosu", "KRYOS"), ("Yeosu", "KRYOS"), ("Dunedin", "NZDUD"), ("NZDUD", "NZDUD")],
)
def test_ports_beside_others_are_found_by_their_own_name(name, code):
    assert PORTS.find(name).locode == code


def test_port_chalmers_and_dunedin_lie_in_otago_harbour():
    for port in ("Port Chalmers", "Dunedin"):
        assert least_miles(approach(port).line, (-45.775, 170.725)) < 1.0  # Taiaroa Head


def test_ships_to_the_strait_of_magellan_keep_off_the_evangelistas():
    (islets,) = (area for area in SHOAL_AREAS if "Evangelistas" in area.name)
    assert islets.contains(np.array([-52.387]), np.array([-75.10]))[0]  # the lighthouse
    (strait,) = find_passages(["Magellan"])
    lat, lon, _ = densify(*strait.positions, 0.5 * NAUTICAL_MILE)
    assert not islets.contains(lat, lon).any()


def test_surabaya_is_reached_by_its_western_channel():
    line = dense_line(approach("Surabaya").line)
    assert distance(-7.068, 112.658, line[:, 0], line[:, 1]).min() < 0.5 * NAUTICAL_MILE
    (east,) = find_passages(["Surabaya: Eastern Channel"])
    assert east.ship_restriction(draught=8.0, length=150.0)


def test_oita_is_left_through_the_middle_of_hayasui_strait():
    line = approach("Oita").line
    assert least_miles(line, (33.268, 131.905)) > 2.0  # Jizo Saki: 0.1 nm off before
    (strait,) = find_passages(["Bungo/Hayasui"])
    assert least_miles(list(zip(*strait.positions, strict=True)), line[-1]) < 1.5


def test_the_spit_south_of_the_danube_is_a_shoal_area():
    (spit,) = (area for area in SHOAL_AREAS if "Sacalin" in area.name)
    assert spit.contains(np.array([44.82]), np.array([29.61]))[0]
    sulina = approach("Galati").line[-1]
    assert not spit.contains(np.array([sulina[0]]), np.array([sulina[1]]))[0]


ROCKS_AND_WORKS = {
    "Bull Rock": (51.5923, -10.3017),
    "Belle Rock": (48.4936, -122.7525),
    "South Rock": (54.3990, -5.4170),
    "Nab Tower": (50.6680, -0.9530),
    "No Man's Land Fort": (50.7395, -1.0948),
    "Chesapeake trestle, north": (37.0523, -76.0480),
    "Chesapeake trestle, south": (36.9400, -76.1230),
    "Hong Kong link": (22.2830, 113.8200),
    "Zhuhai link": (22.2700, 113.6505),
    "Isla de Lobos": (-35.0250, -54.8830),
}


@pytest.mark.parametrize("name", ROCKS_AND_WORKS)
def test_rocks_and_trestles_are_land(name):
    """Routes passed 0.01 to 0.3 nm off them, and through the trestle."""
    place = ROCKS_AND_WORKS[name]
    assert not Chart.gshhg("i").is_navigable(*place)


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("Chesapeake Channel (Bridge-Tunnel)", (37.0305, -76.0855)),
        ("Lingding and Tonggu Channels (over the tunnel)", (22.2830, 113.7540)),
        ("Qingzhou Channel (Hong Kong-Zhuhai-Macao link)", (22.2800, 113.6740)),
    ],
)
def test_ships_pass_over_the_tunnel_or_under_the_high_span(name, place):
    chart = Chart.gshhg("i")
    (channel,) = find_passages([name])
    lat, lon, _ = densify(*np.array(channel.line).T, 200.0)
    assert np.all(chart.is_navigable(lat, lon))
    assert np.min(distance(lat, lon, *place)) < 200.0


@pytest.mark.parametrize("port", ["Shekou", "Chiwan"])
def test_the_ports_of_shenzhen_are_reached_over_the_tunnel(port):
    """The line led through the bridge 1.5 nm east of the tunnel."""
    line = dense_line(approach(port).line)
    line = line[line[:, 0] < 22.42]
    assert np.all(Chart.gshhg("i").is_navigable(line[:, 0], line[:, 1]))
    assert np.min(distance(22.2830, 113.7640, line[:, 0], line[:, 1])) < 0.5 * NAUTICAL_MILE


def test_the_old_bahama_channel_is_off_the_bank():
    """Its line led over the Great Bahama Bank."""
    (channel,) = find_passages(["Old Bahama Channel"])
    lat, lon, _ = densify(*np.array(channel.line).T, 1000.0)
    assert np.nanmin(coarse_depth(lat, lon)) > 50.0


def test_the_traffic_route_of_uraga_is_west_of_daini_kaiho():
    (uraga,) = find_passages(["Uraga (Tokyo Bay)"])
    lat, lon, _ = densify(*np.array(uraga.line).T, 200.0)
    near = int(np.argmin(distance(lat, lon, 35.3127, 139.7413)))
    assert lon[near] < 139.7313


@pytest.mark.parametrize(("area", "inside", "outside"), [
    ("Great Bahama Bank along", (21.80, -75.70), (21.60, -75.76)),
    ("Great Bahama Bank (north)", (25.60, -78.30), (25.90, -78.45)),
    ("Blunts Reef", (40.44, -124.50), (40.44, -124.54)),
    ("Demerara flats", (6.87, -58.00), (6.90, -58.15)),
    ("Dangerous Ground", (10.10, 117.35), (10.30, 118.00)),
    ("Rifleman Bank", (7.55, 111.56), (7.40, 111.30)),
    ("Burford Bank", (53.32, -6.02), (53.345, -6.02)),
    ("San Francisco Bar", (37.72, -122.58), (37.77, -122.60)),
    ("Ryde Sand", (50.73, -1.12), (50.7448, -1.0840)),
])  # fmt: skip
def test_banks_are_named_areas_and_the_channels_beside_them_are_not(area, inside, outside):
    (found,) = (one for one in SHOAL_AREAS if one.name.startswith(area))
    lat, lon = np.array([inside, outside]).T
    assert found.contains(lat, lon).tolist() == [True, False]


@pytest.mark.parametrize(("port", "place", "within_nm"), [
    ("JPTYO", (35.3000, 139.7200), 0.3),  # the traffic route, west of Daini Kaiho
    ("RUVVO", (43.0430, 131.9600), 0.3),  # north of Skryplev
    ("GBSOU", (50.7448, -1.0835), 0.2),  # between the forts
    ("USSFO", (37.7550, -122.6900), 0.2),  # the pilot buoy
    ("ARBUE", (-35.1600, -56.3000), 0.2),  # west of English Bank
    ("USORF", (36.9965, -76.3050), 0.1),  # north of Fort Wool, not through the trestle
    ("GBFAL", (50.1420, -5.0280), 0.1),  # between Pendennis and Saint Anthony Head
])  # fmt: skip
def test_approaches_follow_their_channels(port, place, within_nm):
    assert least_miles(approach(port).line, place) < within_nm
