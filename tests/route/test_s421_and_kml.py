"""S-421, RTZP and KML files of routes."""

import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.route.planar import ship
from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.route import (
    RouteFileOptions,
    Track,
    evaluate,
    read_track,
    write_kml,
    write_route_files,
    write_rtz,
    write_rtzp,
    write_s421,
)
from thalweg.route.formats import ROUTE_FORMATS
from thalweg.sea import Sea

DEPART = "2026-03-01T06:00:00Z"
GML = "{http://www.opengis.net/gml/3.2}"
XLINK = "{http://www.w3.org/1999/xlink}"
KML = "{http://www.opengis.net/kml/2.2}"


@pytest.fixture(scope="module")
def voyage():
    vessel = ship(7.5).with_speeds([5.0, 7.5])
    lat, lon = [52.0, 52.1, 50.2, 50.3], [4.0, 3.9, 0.1, -0.5]
    track = Track(lat, lon, 0.0, [600.0, 0.0, 4834.5, 0.0], [1, 0, 1])
    return evaluate(track, ship=vessel, sea=Sea.calm(), depart=DEPART)


def test_s421_comes_back_with_waits_and_ordered_speeds(tmp_path, voyage):
    write_rtz(voyage, tmp_path / "a.rtz")
    write_s421(voyage, tmp_path / "a.gml")
    expected, read = read_track(tmp_path / "a.rtz"), read_track(tmp_path / "a.gml")
    for name in ("lat", "lon", "wait", "speed"):
        np.testing.assert_allclose(getattr(read, name), getattr(expected, name), atol=1e-6)
    assert read.depart == expected.depart
    assert read.wait.sum() == pytest.approx(600.0 + 4834.5, abs=0.01)


def test_all_references_of_s421_are_in_the_file(tmp_path, voyage):
    write_s421(voyage, tmp_path / "a.gml", RouteFileOptions("Hull", "Dover", cross_track_nm=0.5))
    root = ElementTree.parse(tmp_path / "a.gml").getroot()
    names = [e.get(f"{GML}id") for e in root.iter() if e.get(f"{GML}id")]
    assert len(set(names)) == len(names)
    targets = {e.get(f"{XLINK}href") for e in root.iter() if e.get(f"{XLINK}href")}
    assert targets and {target.removeprefix("#") for target in targets} <= set(names)
    assert root.findtext(".//routeInfoName") == "Hull to Dover"
    sides = {float(e.text) for e in root.iter("routeWaypointLegPortXTDL")}
    assert sides == {926.0}  # half a nautical mile [m]
    assert root.findtext(".//routeScheduleElementETD") == "2026-03-01T06:10:00Z"


NESTED = """<S421:dataset xmlns:S421="http://www.iho.int/S421/gml/cs0/2.0"
 xmlns:gml="http://www.opengis.net/gml/3.2" gml:id="D"><route gml:id="RTE" routeID="1">
 <routeWaypoints gml:id="W"><routeWaypoint gml:id="W.1" routeWaypointID="1"><geometry>
 <point><gml:pos>59.5 25.5</gml:pos></point></geometry>
 <routeScheduleElement routeScheduleElementETD="2026-03-01T06:00:00Z"/></routeWaypoint>
 <routeWaypoint gml:id="W.10" routeWaypointID="10"><geometry><point><gml:pos>60.0 20.0</gml:pos>
 </point></geometry><routeWaypointLeg gml:id="L" routeWaypointLegGeometryType="{kind}"/>
 </routeWaypoint></routeWaypoints></route></S421:dataset>"""


def test_nested_drafts_are_read_with_their_geometry(tmp_path):
    path = tmp_path / "a.gml"
    path.write_text(NESTED.format(kind="2"))
    read = read_track(path)
    assert (read.lat.tolist(), read.lon.tolist()) == ([59.5, 60.0], [25.5, 20.0])
    assert read.depart == np.datetime64("2026-03-01T06:00:00").astype("datetime64[s]").astype(float)
    path.write_text(NESTED.format(kind="1"))
    assert len(read_track(path).lat) > 2  # a rhumb line, sailed in geodesics close to it


def test_waypoints_are_in_the_order_of_their_list(tmp_path, voyage):
    path = tmp_path / "a.gml"
    write_s421(voyage, path)
    expected = read_track(path)
    root = ElementTree.parse(path).getroot()
    moved = [e for e in root if e.tag == "member" and e[0].tag.endswith("}RouteWaypoint")]
    for element in moved:
        root.remove(element)
    root.extend(reversed(moved))
    ElementTree.ElementTree(root).write(path)
    np.testing.assert_array_equal(read_track(path).lat, expected.lat)


@pytest.mark.parametrize(
    "text, message",
    [
        ("<a", "cannot be read"),
        ("<Dataset/>", "0 S-421 routes and 0 waypoints"),
        ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "cannot be read"),
        (NESTED.format(kind="2").replace("59.5 25.5", "95.0 25.5"), "waypoint 1"),
    ],
)
def test_what_is_no_s421_is_refused(tmp_path, text, message):
    (tmp_path / "a.gml").write_text(text)
    with pytest.raises(InputError, match=message):
        read_track(tmp_path / "a.gml", depart=DEPART)


def test_rtzp_holds_the_rtz_of_its_name(tmp_path, voyage):
    write_rtz(voyage, tmp_path / "a.rtz")
    write_rtzp(voyage, tmp_path / "a.rtzp")
    with zipfile.ZipFile(tmp_path / "a.rtzp") as archive:
        assert archive.namelist() == ["a.rtz"]
        assert archive.read("a.rtz") == (tmp_path / "a.rtz").read_bytes()
    np.testing.assert_array_equal(
        read_track(tmp_path / "a.rtzp").lat, read_track(tmp_path / "a.rtz").lat
    )


def test_kml_has_the_line_and_the_waypoints(tmp_path, voyage):
    write_kml(voyage, tmp_path / "a.kml", RouteFileOptions("Hull", "Dover"))
    root = ElementTree.parse(tmp_path / "a.kml").getroot()
    places = root.findall(f".//{KML}Placemark")
    assert places[0].findtext(f"{KML}name") == "Hull to Dover"
    line = places[0].findtext(f".//{KML}coordinates").split()
    assert [float(x) for x in line[0].split(",")] == [4.0, 52.0]
    points = [p.findtext(f"{KML}Point/{KML}coordinates") for p in places[1:]]
    assert points[-1] == "-0.5,50.3"
    assert places[1].findtext(f"{KML}TimeStamp/{KML}when") == DEPART


def test_kml_comes_back_with_waits_ordered_speeds_and_lines(tmp_path, voyage):
    write_rtz(voyage, tmp_path / "a.rtz")
    write_kml(voyage, tmp_path / "a.kml")
    expected, read = read_track(tmp_path / "a.rtz"), read_track(tmp_path / "a.kml")
    for name in ("lat", "lon", "wait", "speed"):
        np.testing.assert_allclose(getattr(read, name), getattr(expected, name), atol=1e-6)
    assert read.depart == pytest.approx(expected.depart, abs=0.01)
    assert read.wait.sum() == pytest.approx(600.0 + 4834.5, abs=0.01)


LINE = "<LineString><coordinates>\n 4,52,0 3.9,52.1\t0.1,50.2,12.5 </coordinates></LineString>"
SECOND = "<LineString><coordinates>0.1,50.2 -0.5,50.3</coordinates></LineString>"
POINT = "<Placemark><Point><coordinates>{},0</coordinates></Point></Placemark>"
GX = 'xmlns:gx="http://www.google.com/kml/ext/2.2"'
WHEN = "<when>2026-03-01T06:00:00Z</when><when>2026-03-01T09:00:00Z</when>"
COORDS = "<gx:coord>4 52 0</gx:coord><gx:coord>3.9 52.1 0</gx:coord>"


@pytest.mark.parametrize(
    ("content", "places", "timed"),
    [
        (f"<Placemark>{LINE}</Placemark>", [(52, 4), (52.1, 3.9), (50.2, 0.1)], False),
        (
            f"<Placemark><MultiGeometry>{LINE}{SECOND}</MultiGeometry></Placemark>",
            [(52, 4), (52.1, 3.9), (50.2, 0.1), (50.3, -0.5)],
            False,
        ),
        (f"<Placemark {GX}><gx:Track>{WHEN}{COORDS}</gx:Track></Placemark>",
         [(52, 4), (52.1, 3.9)], True),
        (POINT.format("4,52") + POINT.format("3.9,52.1"), [(52, 4), (52.1, 3.9)], False),
        # a harbour beside the line is no waypoint
        (f"{POINT.format('9,54')}<Placemark>{LINE}</Placemark>",
         [(52, 4), (52.1, 3.9), (50.2, 0.1)], False),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore:a.kml. its lines are joined")
def test_kml_of_others_is_read(tmp_path, content, places, timed):
    path = tmp_path / "a.kml"
    path.write_text(f"<kml><Document><Folder>{content}</Folder></Document></kml>")
    read = read_track(path, depart=None if timed else DEPART)
    assert list(zip(read.lat.tolist(), read.lon.tolist())) == places
    assert read.depart == parse_time(DEPART)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<kml/>", "holds no route"),
        ("<kml><Document>", "KML cannot be read"),
        (f"<kml>{POINT.format('4,52')}</kml>", "holds no route"),
        (f"<kml>{POINT.format('4')}{POINT.format('x,52')}</kml>", "'x', not a number"),
        (f"<kml>{POINT.format('4,52')}{POINT.format('4,95')}</kml>", "latitude"),
        ("<kml><Placemark><LineString><coordinates>4 52</coordinates></LineString></Placemark>"
         "</kml>", "Waypoint 1 of the KML has 1 value"),
        ('<!DOCTYPE a [<!ENTITY x "y">]><kml>&x;</kml>', "declares entities"),
    ],
)  # fmt: skip
def test_faults_of_kml_are_named(tmp_path, text, message):
    path = tmp_path / "a.kml"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_track(path, depart=DEPART)


def test_formats_are_chosen_by_their_endings(tmp_path, voyage):
    assert (
        len(write_route_files(voyage, tmp_path, "all", RouteFileOptions(formats=ROUTE_FORMATS)))
        == 7
    )
    for path in tmp_path.glob("all.*"):
        path.unlink()
    files = write_route_files(voyage, tmp_path, "r", RouteFileOptions(formats=("kml", "gml")))
    assert [path.name for path in files] == ["r.kml", "r.gml"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["r.gml", "r.kml"]
    with pytest.raises(InputError, match="'pdf'"):
        RouteFileOptions(formats=("rtz", "pdf"))
