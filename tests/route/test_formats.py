"""Routes through files and back, and files that cannot be routes."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.route.planar import ship
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.time import parse_time
from thalweg.core.units import KNOT
from thalweg.route import (
    RouteFileOptions,
    Track,
    evaluate,
    read_track,
    write_csv,
    write_geojson,
    write_gpx,
)
from thalweg.route.formats.csv_format import parse_csv
from thalweg.route.formats.file_route import file_route
from thalweg.sea import Sea

WRITERS = {"csv": write_csv, "geojson": write_geojson, "gpx": write_gpx}
DEPART = "2026-03-01T06:00:00Z"


def route_along(positions):
    return evaluate(positions, ship=ship(5.0), sea=Sea.calm(), depart=DEPART)


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(
    "positions",
    [
        [(52.0, 4.1), (53.25, 3.0), (55.0, -1.5)],
        [(10.0, 170.0), (20.0, -170.0), (30.0, -150.0)],
        [(-35.123456, 179.5), (-36.0, 180.0), (-37.0, -179.25)],
    ],
)
def test_round_trip(tmp_path, suffix, positions):
    path = tmp_path / f"route.{suffix}"
    WRITERS[suffix](route_along(positions), path, RouteFileOptions(legs="great-circle"))
    track = read_track(path)
    expected = route_along(positions).track
    assert len(track) == len(positions)
    for lat, lon in expected.positions:
        assert np.hypot(track.lat - lat, (track.lon - lon + 180.0) % 360.0 - 180.0).min() < 1e-6
    assert track.depart == expected.depart
    again = evaluate(path, ship=ship(5.0), sea=Sea.calm())
    assert again.time_h == pytest.approx(route_along(positions).time_h, rel=1e-6)


@pytest.mark.parametrize("suffix", WRITERS)
def test_waits_and_ordered_speeds_come_back(tmp_path, suffix):
    vessel = ship(7.5).with_speeds([5.0, 7.5])
    track = Track(
        [52.0, 52.1, 52.2, 52.3], [4.0, 3.9, 3.9, 3.8], 0.0, [600.0, 0.0, 1234.5, 0.0], [1, 0, 1]
    )
    route = evaluate(track, ship=vessel, sea=Sea.calm(), depart=DEPART)
    assert route.legs["ordered_speed"].tolist() == [7.5, 5.0, 7.5]
    path = tmp_path / f"route.{suffix}"
    WRITERS[suffix](route, path)
    read = read_track(path)
    np.testing.assert_allclose(read.wait, track.wait, atol=0.002)
    np.testing.assert_allclose(read.speed, [7.5, 5.0, 7.5], rtol=1e-6)
    again = evaluate(path, ship=vessel, sea=Sea.calm())
    assert again.track.setting.tolist() == [1, 0, 1]
    assert again.time_h == pytest.approx(route.time_h, rel=1e-6)
    assert again.waiting_h == pytest.approx(1834.5 / 3600.0, rel=1e-5)
    other = evaluate(
        path, ship=ship(9.0).with_speeds([4.0, 9.0]), sea=Sea.calm()
    )  # has no 7.5 m/s by itself
    assert other.time_h == pytest.approx(route.time_h, rel=1e-6)
    ordered = evaluate(path, ship=vessel, sea=Sea.calm(), speed_kn=7.5 / KNOT)
    assert ordered.time_h < route.time_h
    assert ordered.waiting_h == pytest.approx(again.waiting_h)


@pytest.mark.parametrize(
    "text",
    [
        "lat,lon\n37 53.5N,23 35.0E\n35 24.0S,25 09.0W\n",
        "lat;lon\n37 53,5N;23 35,0E\n35-24,0 S;25-09,0 W\n",
        "lat\tlon\nN37 53.5\tE023 35\nS35 24\tW025 09\n",
        "lat;lon\n37°53,5'N;23°35,0'E\n35°24'S;25°09'W\n",
    ],
)
def test_csv_positions_in_degrees_and_minutes(tmp_path, text):
    """They were refused as no numbers, though places of the command line may be written so."""
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8")
    track = read_track(path, depart=0)
    assert track.lat.tolist() == pytest.approx([37.0 + 53.5 / 60.0, -35.4])
    assert track.lon.tolist() == pytest.approx([23.0 + 35.0 / 60.0, -25.15])
    path.write_text("lat,lon\n37 63.5N,23 35.0E\n35 24.0S,25 09.0W\n")
    with pytest.raises(InputError, match="60 or more minutes"):
        read_track(path, depart=0)


@pytest.mark.parametrize("ending", ["csv", "gpx", "geojson"])
def test_names_of_waypoints_are_kept(tmp_path, ending):
    """Written of a CSV, a route had the names WP 1 to WP 3."""
    path = tmp_path / "ferry.csv"
    rows = "Piraeus,37.892,23.583\n,36.8,24.033\nHeraklion,35.383,25.15\n"
    path.write_text(f"Name,lat,lon\n{rows}")
    for _ in range(2):  # read from another program, and from Thalweg
        found = evaluate(read_track(path, depart=0), ship=ship(6.0), sea=Sea.calm())
        path = tmp_path / f"again.{ending}"
        WRITERS[ending](found, path)
        text = path.read_text()
        assert "Piraeus" in text and "WP 2" in text and "Heraklion" in text and "WP 1" not in text


def test_a_csv_that_is_cut_off_in_its_last_row_is_refused():
    """A file that ended in a number was a voyage to that longitude, short of the bar."""
    rows = ["name,lat,lon,ukc_m,fuel_t,course_deg,time", "A,51.0,3.0,9,0,90,", "B,51.1,3.4599"]
    with pytest.raises(InputError, match=r"last row of the CSV has 3 of 7 columns"):
        parse_csv("\n".join(rows))
    assert len(parse_csv("\n".join([*rows[:2], "B,51.1,3.4599,8"])).positions) == 2


def test_csv_waits_in_other_units_and_at_repeated_positions(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("lat,lon,wait_s\n1,2,60\n1,2,30\n3,4,\n3.5,4\n")
    assert read_track(path, depart=0).wait.tolist() == [90.0, 0.0, 0.0]


@given(
    st.lists(
        st.tuples(st.floats(-70, 70), st.floats(-180, 179.9)), min_size=2, max_size=6, unique=True
    )
)
def test_csv_text_round_trip_for_any_positions(positions):
    from thalweg.route.formats.csv_format import parse_csv

    text = "Latitude;Longitude\n" + "\n".join(f"{a!r};{b!r}" for a, b in positions)
    parsed = parse_csv(text).positions
    np.testing.assert_allclose(np.array(parsed), np.array(positions), atol=1e-12)


def test_geojson_line_is_cut_at_the_antimeridian_where_the_geodesic_crosses(tmp_path):
    path = tmp_path / "route.geojson"
    write_geojson(route_along([(10.0, 170.0), (20.0, -170.0)]), path)
    line = json.loads(path.read_text())["features"][0]
    assert line["geometry"]["type"] == "MultiLineString"
    first, second = line["geometry"]["coordinates"]
    assert first[-1][0] == 180.0
    assert second[0][0] == -180.0
    assert first[-1][1] == second[0][1] == pytest.approx(15.341, abs=0.02)
    for part in (first, second):
        assert max(abs(np.diff([lon for lon, _ in part]))) < 5.0
    assert line["properties"]["distance_nm"] > 0


def test_gpx_tracks_and_times_are_read(tmp_path):
    path = tmp_path / "a.gpx"
    path.write_text(
        '<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>'
        '<trkpt lat="52" lon="4"><time>2026-01-02T03:04:05Z</time></trkpt>'
        '<trkpt lat="53" lon="5"/></trkseg></trk></gpx>'
    )
    track = read_track(path)
    assert track.positions == [(52.0, 4.0), (53.0, 5.0)]
    assert track.depart == 1767323045.0


def test_gpx_without_namespace_prefers_the_route(tmp_path):
    path = tmp_path / "a.gpx"
    path.write_text(
        '<gpx><trk><trkpt lat="1" lon="1"/><trkpt lat="2" lon="2"/></trk>'
        '<rte><rtept lat="3" lon="3"/><rtept lat="4" lon="4"/></rte></gpx>'
    )
    assert read_track(path, depart=0).positions == [(3.0, 3.0), (4.0, 4.0)]


def test_geojson_points_and_plain_lines(tmp_path):
    path = tmp_path / "a.json"
    path.write_text('{"type": "LineString", "coordinates": [[4, 52], [5, 53, 10]]}')
    assert read_track(path, depart=0).positions == [(52.0, 4.0), (53.0, 5.0)]
    point = {"type": "Feature", "properties": None, "geometry": {"type": "Point"}}
    features = [
        {**point, "geometry": {"type": "Point", "coordinates": [lon, 50]}} for lon in (1, 2, 3)
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    assert read_track(path, depart=0).lon.tolist() == [1.0, 2.0, 3.0]


def lines(*coordinates):
    features = [
        {"type": "Feature", "geometry": {"type": "LineString", "coordinates": line}}
        for line in coordinates
    ]
    return json.dumps({"type": "FeatureCollection", "features": features})


def test_geojson_lines_that_go_on_are_one_route_and_others_are_not(tmp_path):
    path = tmp_path / "a.geojson"
    path.write_text(lines([[1, 50], [2, 51]], [[2, 51], [3, 50]], [[1, 50], [3, 49], [3, 50]]))
    assert read_track(path, depart=0).positions == [(50.0, 1.0), (51.0, 2.0), (50.0, 3.0)]
    path.write_text(lines([[179, 10], [180, 11]], [[-180, 11], [-179, 12]]))
    assert read_track(path, depart=0).positions == [(10.0, 179.0), (12.0, -179.0)]


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", 'lat,lon\n1,"2\n' + "3,4\n" * 40_000, "field larger"),
        ("a.csv", "", "no columns"),
        ("a.csv", "foo,bar\n1,2\n", "no columns"),
        ("a.csv", "lat,lon\n1,2\n", "1 waypoint"),
        ("a.csv", "lat,lon\n1,2\nx,3\n", "not a number"),
        ("a.csv", "lat,lon\n1,2\nnan,3\n", "not a number"),
        ("a.csv", "lat,lon\n1,2\n3\n", "1 columns"),
        ("a.csv", "lat,lon\n120.5,30\n121,31\n", "swapped"),
        ("a.csv", "lat,lon,time\n1,2,yesterday\n3,4,\n", "not a time"),
        ("a.csv", "lat,lon\n1,2\n3,4\n", "no departure"),
        ("a.csv", "lat,lon,time,waiting_h\n1,2,2026-01-01,-1\n3,4,,\n", "zero or more"),
        ("a.csv", "lat,lon,time,waiting_h\n1,2,2026-01-01,1e9\n3,4,,\n", "a year at most"),
        ("a.csv", "lat,lon,time,waiting_h\n1,2,2026-01-01,soon\n3,4,,\n", "wait at waypoint 1"),
        ("a.csv", "lat,lon,time,waiting_h\n1,2,2026-01-01,0\n3,4,,1\n", "end before the goal"),
        ("a.csv", "lat,lon,time,ordered_speed_kn\n1,2,2026-01-01,0\n3,4,,\n", "above zero"),
        ("a.geojson", "{", "cannot be read"),
        ("a.geojson", "[]", "no route"),
        ("a.geojson", '{"type": "Polygon", "coordinates": []}', "no route"),
        ("a.geojson", '{"type": "LineString", "coordinates": 3}', "not lists"),
        ("a.geojson", '{"type": "LineString", "coordinates": [[1], [2, 3]]}', "not a position"),
        ("a.gpx", "<gpx", "cannot be read"),
        ("a.gpx", "<gpx><wpt lat='1' lon='2'/></gpx>", "no route and no track"),
        (
            "a.gpx",
            '<!DOCTYPE a [<!ENTITY x "y">]><gpx><rte><rtept lat="1" lon="&x;"/></rte></gpx>',
            "cannot be read",
        ),
        ("a.xlsx", "", "not read from files like"),
    ],
)
def test_what_is_no_route_is_refused_with_a_reason(tmp_path, name, text, message):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_track(path)


def test_missing_binary_and_huge_files_are_refused(tmp_path, monkeypatch):
    with pytest.raises(InputError, match="cannot be read"):
        read_track(tmp_path / "nowhere.csv", depart=0)
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(InputError, match="UTF-8"):
        read_track(tmp_path / "b.csv", depart=0)
    monkeypatch.setattr("thalweg.route.formats.LARGEST_FILE", 10)
    (tmp_path / "c.csv").write_text("lat,lon\n1,2\n3,4\n")
    with pytest.raises(InputError, match="MB"):
        read_track(tmp_path / "c.csv", depart=0)


@pytest.mark.parametrize(
    "text",
    [
        "name;lat;lon\nDover;51,05;1,45\nend;51,3;2,0\n",
        "LAT (deg),LON [deg],SPEED\n51.05,1.45,9\n51.3,2.0,9\n",
        "\ufeffWaypoint\tLatitude\tLongitude\n1\t51.05\t1.45\n2\t51.3\t2.0\n",
    ],
)
@pytest.mark.filterwarnings("ignore:route.csv. its column speed is not used")
def test_tables_as_other_programs_write_them(tmp_path, text):
    path = tmp_path / "route.csv"
    path.write_text(text, encoding="utf-8")
    track = read_track(path, depart=0.0)
    assert track.lat.tolist() == [51.05, 51.3] and track.lon.tolist() == [1.45, 2.0]


def test_a_file_of_another_kind_is_refused_with_the_endings_that_are_read(tmp_path):
    path = tmp_path / "route.pdf"
    path.write_text("%PDF")
    with pytest.raises(InputError) as caught:
        read_track(path)
    assert ".rtz" in caught.value.possible and ".kml" in caught.value.possible


def test_a_column_without_any_value_is_left_out(tmp_path):
    track = Track([50.0, 50.1, 50.2], [-5.0, -5.0, -4.9], 0.0)
    write_csv(evaluate(track, ship=ship(6.0), sea=Sea.calm()), tmp_path / "a.csv")
    header, *rows = (tmp_path / "a.csv").read_text().splitlines()
    columns = list(zip(*(row.split(",") for row in rows)))
    assert all(any(column) for column in columns) and len(columns) == header.count(",") + 1
    assert header.startswith("name,lat,lon,time,waiting_h") and "cost" not in header


def test_greatest_and_least_values_of_legs_are_not_divided_among_their_pieces():
    """A great circle of 40 degrees becomes many rhumb lines, the second leg one or few."""
    route = route_along([(45.0, -40.0), (45.0, 0.0), (45.5, 0.0)])
    extremes = {"land_distance": np.array([7.0, 3.0]) * 1852.0, "pitch": np.radians([2.0, 5.0])}
    rows = file_route(replace(route, legs={**route.legs, **extremes})).rows
    assert len(rows) > 8
    on_first = [row for row in rows[:-1] if row["lon"] < -1e-6]
    assert {row["land_distance_nm"] for row in on_first} == {7.0}
    assert {row["pitch_deg"] for row in on_first} == {2.0}
    assert {row["land_distance_nm"] for row in rows[len(on_first) : -1]} == {3.0}


BACKWARDS = ("2026-01-01T00:00:00Z", "2026-01-01T05:50:00Z", "2026-01-01T01:50:00Z")


def _file_with_times(path, times):
    places = [(51.5, 2.0), (51.8, 2.5), (52.2, 3.2)]
    rows = list(zip(places, times))
    if path.suffix == ".csv":
        text = "lat,lon,time\n" + "".join(f"{lat},{lon},{t}\n" for (lat, lon), t in rows)
    elif path.suffix == ".gpx":
        points = "".join(
            f'<rtept lat="{lat}" lon="{lon}"><time>{t}</time></rtept>' for (lat, lon), t in rows
        )
        text = f'<gpx xmlns="http://www.topografix.com/GPX/1/1"><rte>{points}</rte></gpx>'
    elif path.suffix == ".kml":
        marks = "".join(
            f"<Placemark><TimeStamp><when>{t}</when></TimeStamp>"
            f"<Point><coordinates>{lon},{lat}</coordinates></Point></Placemark>"
            for (lat, lon), t in rows
        )
        text = f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{marks}</Document></kml>'
    else:
        features = [
            {
                "type": "Feature",
                "geometry": {"type": "Point", "coordinates": [lon, lat]},
                "properties": {"time": t},
            }
            for (lat, lon), t in rows
        ]
        text = json.dumps({"type": "FeatureCollection", "features": features})
    path.write_text(text)
    return path


@pytest.mark.parametrize("ending", ["csv", "gpx", "kml", "geojson"])
def test_times_that_go_backwards_are_refused(tmp_path, ending):
    """The ship sailed at her own speed, without a word on the times."""
    path = _file_with_times(tmp_path / f"route.{ending}", BACKWARDS)
    with pytest.raises(InputError, match="Waypoint 3 of the route is at 2026-01-01T01:50") as found:
        read_track(path)
    assert "before waypoint 2 at 2026-01-01T05:50" in str(found.value)
    rising = _file_with_times(path, sorted(BACKWARDS))
    assert read_track(rising).depart == parse_time(BACKWARDS[0])
    with_gap = _file_with_times(path, (BACKWARDS[0], "", BACKWARDS[0]))
    assert len(read_track(with_gap)) in (2, 3)  # KML leaves points without a time out


@pytest.mark.parametrize(
    ("header", "named"),
    [
        ("speed", "speed"),
        ("Speed (kn)", "speed"),
        ("sog_kn", "sog_kn"),
        ("ordered_speed_kn", None),
        ("speed_over_ground_kn", None),
        ("wind_speed", None),
    ],
)
def test_a_speed_column_that_is_not_used_is_named(tmp_path, recwarn, header, named):
    path = tmp_path / "route.csv"
    path.write_text(f"lat,lon,time,{header}\n51,2,2026-01-01T00:00Z,14\n52,3,,14\n")
    read_track(path)
    said = [str(one.message) for one in recwarn if "not used" in str(one.message)]
    assert len(said) == (named is not None)
    if named:
        assert f"route.csv: its column {named} is not used" in said[0]
        assert "ordered_speed_kn" in said[0]


@pytest.mark.parametrize(("header", "named"), [("wait", "wait"), ("waiting_h", None)])
def test_a_column_of_waits_that_is_not_used_is_named(tmp_path, recwarn, header, named):
    path = tmp_path / "route.csv"
    path.write_text(f"lat,lon,time,{header}\n51,2,2026-01-01T00:00Z,2\n52,3,,\n")
    track = read_track(path)
    said = [str(one.message) for one in recwarn if "not used" in str(one.message)]
    assert len(said) == (named is not None)
    assert track.wait[0] == (0.0 if named else 7200.0)
    assert all("its column wait is not used" in text and "waiting_h" in text for text in said)


@pytest.mark.parametrize(
    ("row", "named"),
    [
        ("51 30.0N,003 35.0", "longitude of waypoint 1 is '003 35.0'"),
        ("51 30.0,003 35.0E", "latitude of waypoint 1 is '51 30.0'"),
        ("51.5,", "longitude of waypoint 1 is ''"),
        ("51 30.0N,", "longitude of waypoint 1 is ''"),
    ],
)
def test_the_coordinate_that_is_wrong_is_named(tmp_path, row, named):
    path = tmp_path / "route.csv"
    path.write_text(f"lat,lon\n{row}\n52,3\n")
    with pytest.raises(InputError, match=re.escape(named)):
        read_track(path, depart="2026-01-01T00:00Z")


def test_repeated_positions_and_further_routes_are_stated(tmp_path):
    path = tmp_path / "route.gpx"
    points = '<rtept lat="51" lon="2"/><rtept lat="52" lon="3"/><rtept lat="52" lon="3"/>'
    other = '<rtept lat="1" lon="2"/><rtept lat="2" lon="3"/>'
    path.write_text(f"<gpx><rte>{points}</rte><rte>{other}</rte></gpx>")
    with pytest.warns(ThalwegWarning) as found:
        track = read_track(path, depart="2026-01-01T00:00Z")
    assert track.lat.tolist() == [51.0, 52.0]
    texts = [str(one.message) for one in found]
    assert any("of its 2 routes or tracks the first is used" in text for text in texts)
    assert any(
        "1 of its positions repeat the one before, first waypoint 3" in text for text in texts
    )
