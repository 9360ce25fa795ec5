"""Times of waypoints in route files that the ship does not keep."""

import numpy as np
import pytest

from tests.route.planar import ship
from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.route import RouteFileOptions, Track, evaluate, write_route_files
from thalweg.route.formats import ROUTE_FORMATS, route_file_contents
from thalweg.route.stated_times import TIMES_UNUSED
from thalweg.sea import Sea

SHIP = ship(12.0 * KNOT)


def notes_of(path, **options):
    route = evaluate(path, ship=SHIP, sea=Sea.calm(), **options)
    return [note for note in route.assumptions if note.startswith(TIMES_UNUSED)]


def csv_route(tmp_path, *times, step=0.88):
    """Return a file of legs of 52.8 nm to the east along the equator, at times of 1 March."""
    rows = [f"0,{step * k},{time and f'2026-03-01T{time}Z'}" for k, time in enumerate(times)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["lat,lon,time", *rows]))
    return path


def test_a_leg_too_long_for_its_time_is_noted(tmp_path):
    """53 nm in an hour by a ship of 12 kn passed without a note."""
    (note,) = notes_of(csv_route(tmp_path, "06:00", "07:00", "12:00"))
    assert "leg 1 would need 52.9 kn and is sailed at 12.0 kn" in note
    assert "waypoint 2 is reached 3 h 24 min later" in note
    assert count_of_dangers([note]) == 1


def test_times_that_the_ship_keeps_need_no_note(tmp_path):
    path = csv_route(tmp_path, "06:00", "10:25", "14:49")
    assert notes_of(path) == []
    assert notes_of(path, depart="2026-04-01T18:00Z") == []  # durations count, not the date
    assert notes_of(csv_route(tmp_path, "06:00", "", "")) == []
    assert notes_of(csv_route(tmp_path, "06:00", "10:28", "14:49")) == []  # 4 min


def test_times_too_late_and_gaps_between_them_are_noted(tmp_path):
    (note,) = notes_of(csv_route(tmp_path, "06:00", "", "18:00"))
    assert "legs 1 to 2 would need 8.8 kn and are sailed at 12.0 kn" in note
    assert "waypoint 3 is reached 3 h 11 min earlier" in note
    (note,) = notes_of(csv_route(tmp_path, "06:00", "06:00"))
    assert "leg 1 would take no time, not 4 h 24 min" in note


def test_legs_too_fast_for_the_ship_come_before_those_that_are_slow(tmp_path):
    """The note named the slow leg alone, since its time differs most."""
    (note,) = notes_of(csv_route(tmp_path, "01:00", "03:00", "19:00"))
    assert "leg 1 would need 26.4 kn and is sailed at 12.0 kn" in note
    (note,) = notes_of(csv_route(tmp_path, "06:00", "08:00", "09:00"))
    assert "leg 2 would need 52.9 kn and is sailed at 12.0 kn, and 1 more leg as well" in note


def test_small_differences_of_many_legs_add_up(tmp_path):
    path = csv_route(tmp_path, "06:00", "06:23", "06:46", "07:09", "07:32", step=0.088)
    (note,) = notes_of(path)  # 3.4 min later each
    assert "leg" not in note.partition(": ")[2] and "waypoint 5 is reached 14 min later" in note


def test_files_of_this_package_have_the_times_that_are_sailed(tmp_path):
    lat, lon = [52.0, 52.1, 50.2, 50.3], [4.0, 3.9, 0.1, -0.5]
    track = Track(lat, lon, 0.0, [600.0, 0.0, 4834.5, 0.0])
    made = evaluate(track, ship=SHIP, sea=Sea.calm(), depart="2026-03-01T06:00Z")
    write_route_files(made, tmp_path, options=RouteFileOptions(formats=ROUTE_FORMATS))
    paths = [path for path in sorted(tmp_path.iterdir()) if path.suffix != ".json"]
    assert len(paths) >= 5
    for path in paths:
        assert notes_of(path) == [], path
        if np.isfinite(route_file_contents(path).times[1:]).any():
            (note,) = notes_of(path, speed_kn=8.0)
            assert "12.0 kn" in note or "(waits count)" in note


@pytest.mark.parametrize(("eta", "noted"), [("07:00", True), ("10:24", False)])
def test_schedules_of_rtz_count(tmp_path, eta, noted):
    points = "".join(
        f'<waypoint id="{k}" revision="1"><position lat="0" lon="{0.88 * (k - 1)}"/></waypoint>'
        for k in (1, 2)
    )
    rows = '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>'
    rows += f'<scheduleElement waypointId="2" eta="2026-03-01T{eta}:00Z"/>'
    (tmp_path / "a.rtz").write_text(
        '<route version="1.1" xmlns="http://www.cirm.org/RTZ/1/1"><routeInfo routeName="a"/>'
        f"<waypoints>{points}</waypoints><schedules><schedule id='1'><manual>{rows}</manual>"
        "</schedule></schedules></route>"
    )
    assert bool(notes_of(tmp_path / "a.rtz")) == noted


@pytest.mark.parametrize("number", [1, 2, 3])
def test_what_is_no_time_is_refused_at_each_waypoint(tmp_path, number):
    rows = ["0,0.0,2026-03-01T06:00Z", "0,0.1,", "0,0.2,2026-03-01T07:00Z"]
    rows[number - 1] = rows[number - 1].rpartition(",")[0] + ",yesterday"
    path = tmp_path / "a.csv"
    path.write_text("\n".join(["lat,lon,time", *rows]))
    with pytest.raises(InputError, match=f"Waypoint {number} has 'yesterday', which is not a time"):
        route_file_contents(path)
