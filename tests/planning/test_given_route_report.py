"""What the evaluation of a route from a file states about land, passages and traffic."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, evaluate
from thalweg.chart.ports import PORTS
from thalweg.planning.report.given_route_report import (
    _sea_ends,
    file_speed_notes,
    given_route_notes,
)
from thalweg.planning.report.land_report import tanker_notes
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.report.provenance import given_route_warnings
from thalweg.planning.report.zone_report import over_speed_notes
from thalweg.planning.request.swapped_degrees import misplaced_name_notes
from thalweg.route import read_track
from thalweg.route.route_tables import LEG_KINDS

SHIP = Ship.load("handysize-bulker")


@pytest.fixture(scope="module")
def chart():
    return Chart.gshhg("i")


def notes_of(places, chart, ship=SHIP):
    route = evaluate(
        places, ship=ship, sea=Sea.calm(), chart=chart, depart="2026-06-01T00:00Z", speed_kn=12
    )
    return given_route_notes(route, chart=chart, ship=ship)


def test_a_leg_near_a_cape_is_stated_with_place_time_and_the_usual_distance(chart):
    first, *_ = notes_of([(38.30, -9.60), (38.775, -9.515), (39.30, -9.70)], chart)
    assert first.startswith("Nearer to land than usual: 0.8 nm off at 38.7")
    assert "passed at 2026-06-01T02" in first and "plans keep 2 nm" in first
    small = notes_of([(38.30, -9.60), (38.775, -9.515), (39.30, -9.70)], chart,
                     Ship.simple(speed_kn=8.0, draught_m=2.0))  # fmt: skip
    assert not any(note.startswith("Nearer to land") for note in small)


def test_a_canal_on_the_approach_of_a_port_is_no_land(chart):
    """Port Said to the Red Sea: 19 nm of land were stated, with the advice not to sail there."""
    approach = chart.approaches.of(PORTS.lookup("EGPSD"))
    (suez,) = [canal for canal in chart.canals if canal.name == "suez"]
    line = [*suez.path, (28.5, 33.2)]
    if suez.path[0][0] < suez.path[-1][0]:
        line = [*suez.path[::-1], (28.5, 33.2)]
    notes = notes_of([approach.line[0], *line], chart)
    assert not any("crosses land" in note for note in notes)


def test_a_leg_against_the_traffic_of_dover_strait_is_stated(chart):
    french_side = [(51.20, 2.00), (51.00, 1.67), (50.87, 1.47), (50.65, 1.20)]
    notes = notes_of(french_side, chart)
    assert any(note.startswith("Runs against the traffic of Dover Strait") for note in notes)
    back = notes_of(french_side[::-1], chart)
    assert not any(note.startswith("Runs against") for note in back)


@pytest.mark.slow
def test_approaches_slower_than_ordered_are_stated(chart):
    """The file of a plan with --approach-speed 13 took 3 h longer without, and no note said why."""
    approach = chart.approaches.of(PORTS.lookup("SESTO"))
    line = [*approach.line, (59.9, 19.9)]
    (note,) = [note for note in notes_of(line, chart) if "along approaches of ports" in note]
    miles = approach.length / 1852.0
    assert note.startswith(
        f"{miles:.1f} nm along approaches of ports count at 10 kn, not at the 12.0"
    )
    assert f"take {round(60.0 * miles * (1 / 10 - 1 / 12))} min longer" in note
    quick = SHIP.with_approach_speed(12.0)
    assert not [note for note in notes_of(line, chart, quick) if "along approaches" in note]


def test_more_than_the_allowed_speed_in_the_bosporus_is_stated(chart):
    """A container ship was planned through it at 20 kn without a word."""
    (strait,) = [one for one in chart.passages if one.name == "Bosporus"]

    def notes(speed):
        route = evaluate(
            strait.line, ship=SHIP, sea=Sea.calm(), chart=chart, depart="2026-06-01", speed_kn=speed
        )
        return over_speed_notes(chart, route)

    (note,) = notes(15.0)
    assert note.startswith(
        "Faster than allowed: 15.0 kn over ground in Bosporus, where the limit is"
    )
    assert "10 kn (general knowledge, unchecked)" in note
    minutes = int(note.partition("arrives ")[2].partition(" min")[0])
    # 17 nm of the strait and a little more at both ends: 34 min longer at 10 than at 15 kn
    assert 33 <= minutes <= 46
    assert notes(10.0) == []
    assert count_of_dangers([note]) == 1


def test_rules_for_tankers_in_a_passage_are_stated_for_tankers(chart):
    """A VLCC was planned through Messina; that it is closed to her was a note among many."""
    (strait,) = [one for one in chart.passages if one.name == "Messina"]
    for kind, count in (("crude oil tanker", 1), ("bulk carrier", 0)):
        ship = Ship.from_dict(
            {"name": "x", "speeds_kn": [12], "hull": {"draught_m": 9.0, "type": kind}}
        )
        route = evaluate(strait.line, ship=ship, sea=Sea.calm(), chart=chart, depart="2026-06-01")
        notes = tanker_notes(chart, route, ship)
        assert len(notes) == count == count_of_dangers(notes)
    assert "banned for laden tankers over 50,000 GT" in tanker_notes(
        chart, route, Ship.from_dict({"name": "x", "speeds_kn": [12],
                                      "hull": {"draught_m": 9.0, "type": "tanker"}})
    )[0]  # fmt: skip


def test_a_passage_that_is_closed_to_the_ship_is_stated(chart):
    line = [(44.80, 36.50), (45.10, 36.50), (45.22, 36.50), (45.33, 36.60), (45.60, 36.70)]
    notes = notes_of(line, chart)
    (note,) = [note for note in notes if note.startswith("Passage closed")]
    assert "Kerch Strait: the draught of 9.5 m is over the 8 m" in note
    assert count_of_dangers(notes) >= 2


def test_routes_in_open_sea_and_on_other_charts_have_none(chart):
    ocean = [(45.0, -20.0), (46.0, -25.0)]
    assert notes_of(ocean, chart) == []
    assert notes_of(ocean, Chart.open_water(40.0, 50.0, -30.0, -10.0)) == []
    assert np.isfinite(SHIP.draught)


def test_speeds_outside_those_of_the_legs_of_a_file_are_stated(tmp_path):
    """The file allowed 24 kn, the ship sailed 26 kn without a word."""
    points = "".join(
        f'<waypoint id="{k}"><position lat="{lat}" lon="-20"/>{leg}</waypoint>'
        for k, (lat, leg) in enumerate(
            [(45.0, ""), (45.2, ""), (49.0, '<leg geometryType="Orthodrome"/>'),
             (49.3, '<leg speedMax="5"/>'), (49.6, '<leg speedMin="13" speedMax="13"/>')],
            start=1,
        )
    )  # fmt: skip
    path = tmp_path / "a.rtz"
    path.write_text(
        '<route xmlns="http://www.cirm.org/RTZ/1/0" version="1.0"><routeInfo routeName="a"/>'
        f'<waypoints><defaultWaypoint><leg speedMax="11.5"/></defaultWaypoint>{points}</waypoints>'
        "</route>"
    )
    track = read_track(path, depart=0)
    route = evaluate(track, ship=SHIP, sea=Sea.calm(), speed_kn=12)
    assert file_speed_notes(route) == [
        "Not the speed of the route file: 12.0 kn is ordered on leg 3, above the greatest speed of "
        "the file there (speedMax 5 kn). On 3 legs in all. Order another with --speed.",
        "Not the speed of the route file: 12.0 kn is ordered on leg 4, below the least speed of "
        "the file there (speedMin 13 kn). Order another with --speed.",
    ]
    slow = evaluate(track, ship=Ship.simple(speed_kn=4.0), sea=Sea.calm())
    assert [note[:60] for note in file_speed_notes(slow)] == [
        "Not the speed of the route file: 4.0 kn is ordered on leg 4,"
    ]


def test_units_and_times_that_a_file_does_not_state_have_a_note():
    """Only `inspect` and plans had them."""
    lat, lon = np.array([49.0, 53.0]), np.array([0.0, 6.0])
    fields = {name: (("lat", "lon"), np.full((2, 2), 0.2)) for name in ("uo", "vo", "swh")}
    sea, water = (
        Sea.open(xr.Dataset(fields, {"lat": lat, "lon": lon})),
        Chart.open_water(49, 53, 0, 6),
    )
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0)
    places = [(50.5, 1.5), (50.5, 2.5)]
    route = evaluate(places, ship=ship, sea=sea, chart=water, depart="2026-01-01T06:00Z")
    notes = given_route_warnings(route, chart=water, sea=sea, ship=ship, min_ukc=0.0)
    (units,) = [note for note in notes if note.startswith("Units not stated")]
    assert "uo and vo as m/s" in units and "swh" not in units  # this ship does not read waves
    (still,) = [note for note in notes if note.startswith("No time in the data")]
    assert "the values of uo and vo" in still


def test_a_line_that_a_plan_would_keep_within_its_tolerance_has_no_note(chart):
    """1.96 and 1.82 nm off the cape: lines of files are up to 0.1 nm off those of plans."""
    for west, noted in ((-9.541, False), (-9.538, True)):
        line = [(38.30, -9.60), (38.775, west), (39.30, -9.70)]
        notes = [note for note in notes_of(line, chart) if note.startswith("Nearer to land")]
        assert bool(notes) is noted, notes


#: Out of Balboa: berth, along the approach to its sea end, and on to the open sea, over 14 m.
BALBOA = [
    *[(8.95, -79.5667), (8.945, -79.5667), (8.92, -79.5481), (8.8733, -79.5313)],
    *[(8.815578, -79.48), (8.76, -79.4933), (8.0, -79.5)],
]


def is_depth_to_check(line, chart):
    ship = Ship.simple(speed_kn=12.0, draught_m=14.8)
    route = evaluate(line, ship=ship, sea=Sea.calm(), chart=chart, depart=0)
    notes = given_route_warnings(route, chart=chart, sea=Sea.calm(), ship=ship, min_ukc=0.0)
    return any(note.startswith("Check the depth") for note in notes)


@pytest.mark.slow
def test_depth_is_not_read_near_the_sea_ends_of_approaches_as_in_plans(chart):
    """It was read from 12 nm off the berth, and in plans from 12 nm off the sea end."""
    at_sea = BALBOA[3:]
    for line in (BALBOA, BALBOA[::-1], at_sea, at_sea[::-1]):
        assert not is_depth_to_check(line, chart)
    assert is_depth_to_check([(9.0, -79.3), *at_sea[1:]], chart)  # from elsewhere


def test_lanes_do_not_count_round_the_sea_ends_of_approaches():
    """A file from Port Klang ran 12 nm "against the traffic" that its plan did not count."""
    kind = LEG_KINDS.index("approach")
    lat = np.zeros(6)
    for kinds, ends in (
        ([kind, kind, 0, 0, kind], (2, 4)),
        ([0, 0, 0, 0, 0], (0, 5)),
        ([kind] * 5, (0, 5)),
    ):
        route = SimpleNamespace(
            track=SimpleNamespace(lat=lat), legs={"leg_kind": np.array(kinds), "length": lat[1:]}
        )
        assert _sea_ends(route) == ends


def test_waypoints_with_the_name_of_a_port_elsewhere_are_questioned():
    names = {
        (38.6, 9.4, 0): "Lisbon",  # a letter W was forgotten
        (10.2, 54.4, 0): "Kiel",
        (32.6, -16.9, 0): "Funchal",
        (50.0, -20.0, 0): "WP 3",
        (50.0, -21.0, 0): "Rotterdam",  # somewhere else, not by a sign
    }
    notes = misplaced_name_notes(names)
    assert notes == [
        "Check the position of the waypoint 'Lisbon', 38.6000N 9.4000E: with the other sign of the "
        "longitude it would be at Lisbon, PT.",
        "Check the position of the waypoint 'Kiel', 10.2000N 54.4000E: with latitude and longitude "
        "swapped it would be at Kiel, DE.",
    ]


def test_a_waypoint_at_which_a_route_turns_round_is_stated(chart):
    notes = notes_of([(45.0, -30.0), (46.0, -30.0), (45.4, -30.02), (47.0, -30.0)], chart)
    (note,) = [note for note in notes if note.startswith("Turns round")]
    assert "degrees at waypoint 2, 46.0000N 30.0000W" in note
    assert "So it does at 2 waypoints" in note
    zigzag = notes_of([(45.0, -30.0), (46.0, -30.0), (46.1, -29.0), (45.2, -28.0)], chart)
    assert not any(note.startswith("Turns round") for note in zigzag)
