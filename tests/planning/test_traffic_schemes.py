"""Traffic separation schemes: on which side of a strait plans pass, and what they state."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapely

from thalweg.chart import Chart
from thalweg.chart.zones.traffic_lanes import LaneGroup
from thalweg.chart.zones.traffic_schemes import (
    AGAINST_FACTOR,
    INSHORE,
    TRAFFIC_SCHEMES,
    lanes_of_schemes,
)
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.geodesy import densify, direct, inverse
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network import lattice
from thalweg.planning import Voyage, plan
from thalweg.planning.report.lane_report import (
    AGAINST_TRAFFIC,
    INSHORE_USED,
    lane_detour_notes,
    lane_notes,
    routes_within_lanes,
)
from thalweg.planning.request.lane_choice import add_traffic_schemes
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship

SHIP = Ship.simple(13.0, 9.0, length_m=180.0)
FERRY = Ship.simple(15.0, 5.5, length_m=115.0)
DOVER = next(scheme for scheme in TRAFFIC_SCHEMES if scheme.name == "Dover Strait")
ENDS = [Endpoint("A", 50.0, -1.0, 0.0), Endpoint("B", 52.0, 3.0, 0.0)]


def voyage(start, goal, **more):
    return Voyage(start=start, goal=goal, depart="2026-01-01T00:00Z", **more)


@pytest.mark.parametrize("scheme", TRAFFIC_SCHEMES, ids=lambda scheme: scheme.name)
def test_ships_with_the_separation_line_to_port_are_with_the_traffic(scheme):
    zones = Zones(lanes=scheme.lanes)
    assert all(lane.shape.is_valid for lane in scheme.lanes)
    lat, lon = np.array(scheme.line).T
    course = np.asarray(inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])[1])
    middle = 0.5 * (lat[:-1] + lat[1:]), 0.5 * (lon[:-1] + lon[1:])
    off = scheme.zone + 0.5 * scheme.lane
    for side in (1.0, -1.0):
        place = direct(*middle, course + side * np.pi / 2, off)
        ahead = direct(*place, course, 500.0)
        along, back = (*place, *ahead), (*ahead, *place)
        with_traffic, against = (along, back) if side > 0.0 else (back, along)
        assert np.allclose(zones.factors(*with_traffic)[0], 1.0)
        assert np.all(zones.factors(*against)[0] > AGAINST_FACTOR - 0.01)
    across = direct(*middle, course + np.pi / 2, 300.0)
    assert np.allclose(zones.factors(*middle, *across)[0], 1.0)


@pytest.mark.parametrize("scheme", [s for s in TRAFFIC_SCHEMES if s.inshore], ids=lambda s: s.name)
def test_inshore_traffic_zones_count_for_every_course(scheme):
    zones = Zones(lanes=scheme.lanes)
    lat, lon = np.array(scheme.line).T
    course = float(inverse(lat[0], lon[0], lat[1], lon[1])[1])
    middle = 0.5 * (lat[0] + lat[1]), 0.5 * (lon[0] + lon[1])
    for side, reach in (("starboard", scheme.starboard), ("port", scheme.port)):
        if scheme.inshore not in (side, "both"):
            continue
        sign = 1.0 if side == "starboard" else -1.0
        off = 0.5 * (scheme.zone + scheme.lane + reach)
        place = direct(*middle, course + sign * np.pi / 2, off)
        ahead = direct(*place, course, 300.0)
        for leg in ((*place, *ahead), (*ahead, *place)):
            assert float(zones.factors(*leg)[0]) > AGAINST_FACTOR - 0.01
    small = lanes_of_schemes([(lat[0] + 1.0, lon[0]), (lat[0] - 1.0, lon[0])], inshore=False)
    assert small and not any(lane.name.endswith(INSHORE) for lane in small)


def test_separation_zones_and_arrows_for_maps():
    for scheme in TRAFFIC_SCHEMES:
        assert scheme.separation.is_valid
        assert len(scheme.arrows) == 2 * (len(scheme.line) - 1)
        assert not any(
            scheme.separation.contains(shapely.Point(b[1], b[0])) for _, b in scheme.arrows
        )
    names = {scheme.name for scheme in TRAFFIC_SCHEMES}
    assert {"Terschelling-German Bight", "German Bight Western Approach"} <= names


@pytest.mark.slow
def test_plans_round_ushant_and_along_the_frisian_islands_keep_off_the_inshore_zones():
    voyages = (((47.3, -5.6), (49.6, -4.0), "Off Ushant"),
               ((53.4, 4.2), (54.0, 7.75), "Terschelling-German Bight"))  # fmt: skip
    for start, goal, name in voyages:
        found = plan(voyage(start, goal), ship=SHIP, sea=Sea.calm(), proof=0.0)
        assert found.best.feasible
        wrong = [note for note in found.notes if note.startswith((INSHORE_USED, AGAINST_TRAFFIC))]
        assert wrong == [], name
        assert any(name in note for note in found.notes if note.startswith("Keeps to starboard"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "goal", "most"),
    [
        ("Newhaven", "Dieppe", 68.0),  # a ferry crosses both lanes; 79 round the end of the scheme
        ("Weymouth", "St Peter Port", 92.0),  # 113 round Off Casquets
        ("Amsterdam", "Harlingen", 93.0),  # a port behind the zone off Texel; 124 round it
    ],
)
def test_ships_cross_lanes_and_inshore_zones_at_right_angles(start, goal, most):
    found = plan(voyage(start, goal), ship=FERRY, sea=Sea.calm(), proof=0.0)
    assert found.best.distance_nm < most
    assert not any(note.startswith((INSHORE_USED, AGAINST_TRAFFIC)) for note in found.notes)


@pytest.mark.parametrize(("off", "against"), [(0, 1), (65, 1), (75, 0), (90, 0), (115, 1)])
@pytest.mark.parametrize(("start", "crosses"), [((42.9, -11.0), True), ((42.4, -9.1), False)])
def test_an_inshore_zone_is_crossed_by_voyages_across_the_line(off, against, start, crosses):
    """Voyages along the coast, which do not cross it, would tack through the zone."""
    lanes = FINISTERRE.lanes_of_voyage([start, (43.7, -8.9)])
    zone = next(one for one in lanes if INSHORE in one.name)
    (x, y), course = zone.shape.centroid.coords[0], math.radians(zone.direction + off)
    dy, dx = 0.02 * math.cos(course), 0.02 * math.sin(course) / math.cos(math.radians(y))
    ends = (np.array([v]) for v in (y - dy, x - dx, y + dy, x + dx))
    assert (LaneGroup.of([zone]).excess(*ends)[0] > 0.0) == bool(against or not crosses)


def test_light_vessels_of_the_dover_strait_lie_in_the_separation_zone():
    zone = shapely.LineString([(x, y) for y, x in DOVER.line])
    for lat, lon in ((50.408, 0.0), (51.102, 1.635), (51.397, 2.010)):  # Greenwich, MPC, F3
        assert zone.distance(shapely.Point(lon, lat)) < 2.0 / 60.0


def side_of_dover(route):
    """Positions where a route passes 50.7, 50.95 and 51.2 N: positive on the French side [deg]."""
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    if lat[0] > lat[-1]:
        lat, lon = lat[::-1], lon[::-1]
    line = np.array(DOVER.line)
    return [
        np.interp(y, lat, lon) - np.interp(y, line[:, 0], line[:, 1]) for y in (50.7, 50.95, 51.2)
    ]


@pytest.mark.slow
def test_plans_through_the_dover_strait_keep_to_their_side():
    west, east = (49.9, -0.6), (52.1, 3.2)
    up = plan(voyage(west, east), ship=SHIP, sea=Sea.calm(), proof=0.0)
    down = plan(voyage(east, west), ship=SHIP, sea=Sea.calm(), proof=0.0)
    assert min(side_of_dover(up.best)) > 0.0
    assert max(side_of_dover(down.best)) < 0.0
    for found in (up, down):
        assert found.best.feasible
        assert any("separation lines of Dover Strait" in note for note in found.notes)
        assert not any("Runs against" in note for note in found.notes)
    free = plan(voyage(east, west, ignore_lanes=True), ship=SHIP, sea=Sea.calm(), proof=0.0)
    assert free.best.distance_nm <= down.best.distance_nm < free.best.distance_nm + 6.0
    assert not any("separation lines" in note for note in free.notes)


def test_own_lanes_no_offing_and_ports_in_a_scheme():
    chart = Chart.gshhg("l")
    own = Chart.gshhg("l").with_zones(
        {"type": "Feature", "properties": {"kind": "lane", "direction_deg": 90},
         "geometry": {"type": "Polygon",
                      "coordinates": [[[0, 50], [1, 50], [1, 50.1], [0, 50.1], [0, 50]]]}}
    )  # fmt: skip
    ends = ENDS[0], ENDS[1]
    request = voyage((50.0, -1.0), (52.0, 3.0))
    found = add_traffic_schemes(chart, request, SHIP, ends)
    assert {lane.name.partition(",")[0] for lane in found.zones.lanes} >= {"Dover Strait"}
    assert add_traffic_schemes(own, request, SHIP, ends) is own
    for more in ({"offing_nm": 0.0}, {"ignore_lanes": True}):
        request = voyage((50.0, -1.0), (52.0, 3.0), **more)
        assert add_traffic_schemes(chart, request, SHIP, ends) is chart
    assert request.to_dict()["ignore_lanes"] is True
    # in the inshore traffic zone of a port of the voyage no direction counts
    near = Zones(lanes=lanes_of_schemes([(51.08, 1.33), (52.0, 3.0)]))
    far = Zones(lanes=lanes_of_schemes([(50.0, -1.0), (52.0, 3.0)]))
    leg = 51.0, 1.2, 51.05, 1.3
    assert float(near.factors(*leg)[0]) == 1.0
    assert float(far.factors(*leg)[0]) == pytest.approx(AGAINST_FACTOR)
    assert lanes_of_schemes([(40.0, -70.0), (39.0, -70.0)]) == ()
    assert NAUTICAL_MILE * 11.9 < DOVER.port < NAUTICAL_MILE * 12.1


FINISTERRE = next(scheme for scheme in TRAFFIC_SCHEMES if scheme.name == "Off Finisterre")


def test_an_inshore_zone_is_open_to_a_port_inside_it_and_not_to_one_beside_it():
    inside, beside, far = (43.05, -9.35), (43.37, -8.4), (42.0, -9.3)
    for port, closed in ((inside, False), (beside, True)):
        found = lanes_of_schemes([far, port])
        zones = [lane for lane in found if lane.name == f"Off Finisterre, {INSHORE}"]
        assert bool(zones) == closed
        assert any(lane.name.startswith("Off Finisterre, N") for lane in found)


@pytest.fixture(scope="module")
def past_finisterre():
    """A lattice past Cape Finisterre on open water, with the lanes of its scheme."""
    open_water = Chart.open_water(42.0, 44.3, -10.8, -9.3)
    zones = replace(open_water.zones, lanes=tuple(FINISTERRE.lanes))
    chart = replace(open_water, zones=zones)
    return chart, lattice(chart, (42.4, -9.35), (43.95, -9.4), spacing=5000.0, slack=1.5)


def test_a_detour_by_a_scheme_is_stated(past_finisterre):
    chart, network = past_finisterre
    (note,) = lane_detour_notes(chart, [network])
    assert note.startswith("Keeping out of the inshore traffic zone of Off Finisterre")
    assert (
        "Rule 10 requires ships to keep out, and to cross lanes at right angles." in note
        and "need not" not in note
    )
    assert "To compare only, plan with --ignore-lanes" in note and "Rule 10 (d)" in note
    miles = float(note.split(" about ")[1].split(" nm")[0])
    assert 4.0 < miles < 30.0
    free = replace(chart, zones=replace(chart.zones, lanes=()))
    assert lane_detour_notes(free, [network]) == []


def test_ways_against_lanes_are_left_out_of_alternatives(past_finisterre):
    chart, _ = past_finisterre
    depart = "2026-01-01T00:00Z"
    ways = ([(42.4, -9.3), (42.7, -10.2), (43.7, -10.2), (43.9, -9.2)],
            [(42.4, -9.3), (43.9, -9.2)])  # fmt: skip
    routes = [evaluate(way, ship=SHIP, sea=Sea.calm(), depart=depart) for way in ways]
    kept, (note,) = routes_within_lanes(chart, routes, routes[:1])
    assert kept == routes[:1]
    assert note.startswith("1 of 2 ways found are left out")
    assert routes_within_lanes(chart, routes[:1], routes[:1]) == (routes[:1], [])


def test_the_fastest_route_of_other_canals_stays_among_alternatives(past_finisterre):
    """Coronel to Szczecin: the way by Magellan and Kiel was left out for 9 nm inshore of Dover."""
    chart, _ = past_finisterre
    ways = ([(42.4, -9.3), (42.7, -10.2), (43.7, -10.2), (43.9, -9.2)],
            [(42.4, -9.3), (43.9, -9.2)])  # fmt: skip
    routes = [evaluate(way, ship=SHIP, sea=Sea.calm(), depart="2026-01-01T00:00Z") for way in ways]
    assert routes_within_lanes(chart, routes, routes) == (routes, [])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "start", "goal"),
    [
        ("Gulf of Suez", (29.75, 32.55), (27.2, 34.4)),
        ("Gulf of Suez", (27.2, 34.4), (29.75, 32.55)),
        ("Bab el Mandeb", (13.7, 42.6), (12.2, 44.2)),
        ("Singapore Strait", (1.6, 102.9), (2.0, 105.0)),
        ("Singapore Strait", (2.0, 105.0), (1.6, 102.9)),
        ("Malacca Strait", (1.3, 103.3), (3.5, 100.2)),
        ("Santa Barbara Channel", (34.9, -121.2), (33.5, -118.3)),  # north of its lanes before
    ],
)
def test_plans_in_a_strait_keep_its_separation_line_to_port_over_the_whole_width(name, start, goal):
    scheme = next(scheme for scheme in TRAFFIC_SCHEMES if scheme.name == name)
    found = plan(voyage(start, goal, objective="distance"), ship=SHIP, sea=Sea.calm(), proof=0.0)
    track = found.best.track
    lat, lon, _ = densify(track.lat, track.lon, 1000.0)
    stretch = np.cos(np.radians(lat.mean()))
    line = np.array(scheme.line)[:, ::-1] * (stretch, 1.0)
    distances = shapely.distance(shapely.LineString(line), shapely.points(lon * stretch, lat))
    course = np.array([lon[-1] - lon[0], lat[-1] - lat[0]])
    if course @ (line[-1] - line[0]) < 0.0:
        line = line[::-1]
    points = np.stack([lon * stretch, lat], axis=1)
    along = np.diff(line, axis=0)
    starboard = np.full(len(points), True)  # beyond the ends of the line
    nearest = np.full(len(points), np.inf)
    for first, leg in zip(line, along):
        share = (points - first) @ leg / (leg @ leg)
        across = (points - first)[:, 0] * leg[1] - (points - first)[:, 1] * leg[0]
        beside = (share >= 0.0) & (share <= 1.0)
        distance = np.abs(across) / np.linalg.norm(leg)
        closer = beside & (distance < nearest)
        nearest[closer] = distance[closer]
        starboard[closer] = across[closer] > 0.0
    in_strait = np.isfinite(nearest) & (distances < 20.0 / 60.0)
    assert in_strait.sum() > 30
    assert starboard[in_strait].mean() > 0.95  # narrow bends of an approximate line are cut


@pytest.mark.parametrize(("inside_m", "against"), [(-50.0, False), (50.0, False), (500.0, True)])
def test_a_route_on_the_edge_of_a_lane_is_stated_the_same_after_rounding(inside_m, against):
    """Least ways lie on the edge; files put them to one side of it or the other."""
    chart = SimpleNamespace(zones=Zones(lanes=FINISTERRE.lanes))
    edge = FINISTERRE.shifted(-(FINISTERRE.zone + 0.25 * FINISTERRE.lane) + inside_m)
    lon, lat = edge[::-1].T  # south-bound, beside the lane of the north-bound
    route = SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon))
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    assert chart.zones.lane_group.shares_against(*legs)[0].any() == (inside_m > 0.0)
    assert any("Runs against" in note for note in lane_notes(chart, route)) == against


@pytest.mark.parametrize(("off", "against"), [(109.0, False), (111.0, False), (116.0, True)])
def test_a_crossing_is_stated_the_same_after_rounding(off, against):
    lane = replace(FINISTERRE.lanes[0], direction=0.0)
    chart = SimpleNamespace(zones=Zones(lanes=(lane,)))
    (x, y), course = lane.shape.centroid.coords[0], math.radians(off)
    dy, dx = 0.1 * math.cos(course), 0.1 * math.sin(course) / math.cos(math.radians(y))
    lat, lon = np.array([y - dy, y + dy]), np.array([x - dx, x + dx])
    route = SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon))
    assert any("Runs against" in note for note in lane_notes(chart, route)) == against


def test_a_route_that_meets_no_scheme_has_a_note_that_others_are_not_known():
    chart = SimpleNamespace(zones=Zones(lanes=FINISTERRE.lanes))
    lon, lat = FINISTERRE.shifted(-(FINISTERRE.zone + 0.25 * FINISTERRE.lane))[::-1].T

    def stated(east):
        route = SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon + east))
        return any(note.startswith("Meets none of the") for note in lane_notes(chart, route))

    assert stated(3.0) and not stated(0.0)


def test_seas_with_schemes_that_the_package_lacks_are_named():
    """A plan in the Gulf of Finland met "none of the schemes", which read as if none were there."""
    chart = SimpleNamespace(zones=Zones(lanes=FINISTERRE.lanes))
    lat, lon = np.array([57.9, 59.2, 59.9, 60.0]), np.array([19.5, 20.5, 23.5, 26.0])
    route = SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon))
    (note,) = lane_notes(chart, route)
    assert note == (
        f"Meets none of the {len(TRAFFIC_SCHEMES)} traffic separation schemes of the package. The "
        "charts have others in or off the Gulf of Finland: keep their lanes by the chart."
    )


def test_voyages_to_brest_use_the_inshore_zone_off_ushant():
    """The Chenal du Four leads through it; a ship of 26 m from Falmouth went 24 nm round it."""
    ushant = next(scheme for scheme in TRAFFIC_SCHEMES if scheme.name == "Off Ushant")
    falmouth, brest, biscay = (50.05, -5.05), (48.32, -4.85), (46.0, -4.5)

    def zones(goal):
        return [one for one in ushant.lanes_of_voyage([falmouth, goal]) if INSHORE in one.name]

    assert zones(brest) == [] and len(zones(biscay)) >= 1
    assert len(ushant.lanes_of_voyage([falmouth, brest])) >= 2
