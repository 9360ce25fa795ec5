"""RTZ: files against the schemas of the standard, and files as other programs write them."""

import re
import warnings
import zipfile

import numpy as np
import pytest

from tests.conftest import data_file
from tests.route.planar import ship
from thalweg.chart import Chart
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.geodesy import densify, distance
from thalweg.core.rhumb_lines import inverse_rhumb
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route import RouteFileOptions, Track, evaluate, read_track, write_rtz
from thalweg.route.formats.file_route import file_route
from thalweg.sea import Sea

DEPART = "2026-03-01T06:00:00Z"
HEAD = '<route xmlns="http://www.cirm.org/RTZ/1/0" version="1.0"><routeInfo routeName="a"/>'


@pytest.fixture(scope="module")
def voyage():
    vessel = ship(7.5).with_speeds([5.0, 7.5])
    lat, lon = [52.0, 52.1, 50.2, 50.3], [4.0, 3.9, 0.1, -0.5]
    track = Track(lat, lon, 0.0, [600.0, 0.0, 4834.5, 0.0], [1, 0, 1])
    current = {
        "eastward_sea_water_velocity": lambda time, lat, lon: 0.4 + 0.0 * lat,
        "northward_sea_water_velocity": lambda time, lat, lon: -0.2 + 0.0 * lat,
    }
    return evaluate(track, ship=vessel, sea=Sea.from_functions(current), depart=DEPART)


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_files_are_valid_by_the_schema(tmp_path, version, voyage):
    etree = pytest.importorskip("lxml.etree")
    schema = data_file(f"rtz/schema/RTZ Schema version {version.replace('.', '_')}.xsd")
    write_rtz(voyage, tmp_path / "a.rtz", RouteFileOptions("Hull", "Dover", rtz_version=version))
    etree.XMLSchema(etree.parse(str(schema))).assertValid(etree.parse(str(tmp_path / "a.rtz")))


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_round_trip(tmp_path, version, voyage):
    path = tmp_path / "a.rtz"
    write_rtz(voyage, path, RouteFileOptions(rtz_version=version))
    text = path.read_text()
    assert f'version="{version}"' in text and 'routeName="a"' in text
    assert 'etd="2026-03-01T06:10:00Z"' in text  # the departure after the first wait
    assert text.count('geometryType="Loxodrome"') == text.count("<waypoint ") - 1
    read = read_track(path)
    assert read.depart == pytest.approx(voyage.track.depart, abs=0.01)
    assert read.wait.sum() == pytest.approx(voyage.track.wait.sum(), abs=0.01)
    assert set(np.round(read.speed, 4)) == {5.0, 7.5}
    for name in ("lat", "lon"):
        np.testing.assert_allclose(
            getattr(read, name)[[0, -1]], getattr(voyage.track, name)[[0, -1]], atol=1e-6
        )


def test_loxodromes_are_sailed_as_rhumb_lines(tmp_path):
    path = tmp_path / "a.rtz"
    waypoints = (
        '<waypoint id="1"><position lat="50" lon="-5"/></waypoint>'
        '<waypoint id="2"><position lat="45" lon="-45"/>{}</waypoint>'
    )
    whole = {}
    for kind in ("", '<leg geometryType="Loxodrome"/>', '<leg geometryType="Orthodrome"/>'):
        path.write_text(f"{HEAD}<waypoints>{waypoints.format(kind)}</waypoints></route>")
        track = read_track(path, depart=0)
        whole[kind[19:22]] = track.lengths.sum()
    rhumb = float(inverse_rhumb(50, -5, 45, -45)[0])
    assert whole[""] == whole["Lox"] == pytest.approx(rhumb, rel=1e-6)
    assert whole["Ort"] == pytest.approx(float(distance(50, -5, 45, -45)), rel=1e-12)
    default = '<defaultWaypoint><leg geometryType="Orthodrome"/></defaultWaypoint>'
    path.write_text(f"{HEAD}<waypoints>{default}{waypoints.format('')}</waypoints></route>")
    assert len(read_track(path, depart=0)) == 2


POINTS = (
    '<waypoint id="1" revision="0"><position lat="50" lon="-5"/></waypoint>'
    '<waypoint id="2" revision="0"><position lat="50.1" lon="-5"/></waypoint>'
    '<waypoint id="3" revision="0"><position lat="50.2" lon="-5"/></waypoint>'
)


def schedule(elements: str) -> str:
    return f'<schedules><schedule id="1"><manual>{elements}</manual></schedule></schedules>'


def test_departure_and_stays_of_a_schedule(tmp_path):
    path = tmp_path / "a.rtz"
    rows = (
        '<scheduleElement waypointId="2" stay="PT1H5M"/>'
        '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>'
        '<scheduleElement waypointId="3" eta="2026-03-01T16:00:00Z"/>'
    )
    path.write_text(f"{HEAD}<waypoints>{POINTS}</waypoints>{schedule(rows)}</route>")
    with pytest.warns(ThalwegWarning, match="not in the order"):
        track = read_track(path)
    assert track.wait.tolist() == [0.0, 3900.0, 0.0]
    assert track.depart == evaluate(track, ship=ship(5.0), sea=Sea.calm()).depart
    assert track.depart == 1772344800.0


@pytest.mark.parametrize(
    ("text", "note"),
    [
        (f"<route><waypoints>{POINTS}</waypoints></route>", "do not belong together"),
        (f"{HEAD}<waypoints>{POINTS.replace('50.1', '50,1')}</waypoints></route>", "decimal comma"),
        (f"{HEAD}<waypoints>{POINTS}</waypoints></route>".replace('"2"', '"1"'), "no id"),
        (
            f"{HEAD}<waypoints>{POINTS}</waypoints>".replace("1/0", "1/2")
            .replace('"1.0"', '"1.2"')
            .replace(' revision="0"', "")
            + "</route>",
            "no revision",
        ),
        (
            f"{HEAD}<waypoints>{POINTS}</waypoints>".replace(
                'lon="-5"/></waypoint>', 'lon="-5"/><leg geometryType="Curve"/></waypoint>'
            )
            + "</route>",
            "geometry 'Curve'",
        ),
        (
            f"{HEAD}<waypoints>{POINTS}</waypoints>"
            + schedule('<scheduleElement waypointId="9" etd="2026-03-01T06:00:00Z"/>')
            + "</route>",
            "does not have",
        ),
    ],
)
def test_what_differs_from_the_standard_is_noted(tmp_path, text, note):
    path = tmp_path / "a.rtz"
    path.write_text(text)
    with pytest.warns(ThalwegWarning, match=note):
        track = read_track(path, depart=0)
    assert track.lat.tolist() == [50.0, 50.1, 50.2]


def _of_schedule(elements: str, kind: str = "manual") -> str:
    made = schedule(elements).replace("manual", kind)
    return f"{HEAD}<waypoints>{POINTS}</waypoints>{made}</route>"


@pytest.mark.parametrize(
    ("text", "note"),
    [
        (f"{HEAD}<waypoints>{POINTS}</waypoints></route>".replace('n="0"', 'n="-1"'), "'-1'"),
        (f"{HEAD}<waypoints>{POINTS}</waypoints></route>".replace('"a"', '"b"'), "named 'b'"),
        (
            f"{HEAD}<waypoints>{POINTS}</waypoints></route>".replace(
                "<routeInfo",
                '<routeInfo validityPeriodStart="2026-03-02T00:00:00Z" '
                'validityPeriodStop="2026-03-01T00:00:00Z"',
            ),
            "ends before it begins",
        ),
        (
            f"{HEAD}<waypoints>{POINTS}</waypoints><extension/></route>",
            "not inside an element extensions",
        ),
        (
            _of_schedule(
                '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>'
                '<scheduleElement waypointId="3" eta="2026-03-01T05:00:00Z"/>'
            ),
            "before that of an earlier waypoint",
        ),
        (
            _of_schedule(
                '<scheduleElement waypointId="1" etd="2026-02-30T00:00:00Z"/>'
                '<scheduleElement waypointId="2"/><scheduleElement waypointId="3"/>',
                "calculated",
            ),
            "does not exist",
        ),
        (
            _of_schedule(
                '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>'
                '<scheduleElement waypointId="2" eta="2026-03-01T07:00:00Z" '
                'etd="2026-03-01T09:00:00Z" stay="PT99M"/>'
            ),
            "99 min where 120 min",
        ),
        (
            _of_schedule(
                '<scheduleElement waypointId="2" eta="2026-03-01T07:00:00Z"/>'
                '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>'
            ),
            "not in the order",
        ),
        (
            _of_schedule(
                '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>', "calculated"
            ),
            "every waypoint",
        ),
    ],
)
def test_deliberate_errors_are_named(tmp_path, text, note):
    path = tmp_path / "a.rtz"
    path.write_text(text)
    with pytest.warns(ThalwegWarning, match=note):
        track = read_track(path, depart=0)
    assert track.lat.tolist() == [50.0, 50.1, 50.2]


def test_every_deliberate_error_of_the_samples_is_named():
    for path in sorted(data_file("rtz/samples/Errors").rglob("*.rtz")):
        with pytest.warns(ThalwegWarning):
            read_track(path, depart=0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<route", "cannot be read"),
        ('<!DOCTYPE a [<!ENTITY x "y">]><route>&x;</route>', "cannot be read"),
        (f"{HEAD}</route>", "no waypoint"),
        (f"{HEAD}<waypoints>{POINTS[:80]}</waypoints></route>".replace("</w", "</w", 1), "."),
        (f"{HEAD}<waypoints>{POINTS.replace('50.1', 'x')}</waypoints></route>", "not a number"),
        (f"{HEAD}<waypoints>{POINTS.replace('50.1', '95')}</waypoints></route>", "beyond 90"),
    ],
)
def test_what_is_no_rtz_is_refused(tmp_path, text, message):
    path = tmp_path / "a.rtz"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_track(path, depart=0)


def test_rtz_in_a_zip(tmp_path, monkeypatch):
    path = tmp_path / "a.rtzp"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a.rtz", f"{HEAD}<waypoints>{POINTS}</waypoints></route>")
        archive.writestr("note.txt", "x")
    assert len(read_track(path, depart=0)) == 3
    monkeypatch.setattr("thalweg.route.formats.rtz_reader.LARGEST_FILE", 100)
    with pytest.raises(InputError, match="too large"):
        read_track(path, depart=0)
    path.write_text("no zip")
    with pytest.raises(InputError, match="cannot be read"):
        read_track(path, depart=0)


def test_ordered_speed_counts_and_planned_speed_over_ground_does_not(tmp_path):
    path = tmp_path / "a.rtz"
    rows = '<scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z" speed="20"/>'
    path.write_text(f"{HEAD}<waypoints>{POINTS}</waypoints>{schedule(rows)}</route>")
    with pytest.warns(ThalwegWarning, match="not used"):
        track = read_track(path)
    assert np.isnan(track.speed).all()
    sailed = evaluate(track, ship=ship(5.0), sea=Sea.calm())
    assert sailed.legs["ordered_speed"][0] == pytest.approx(5.0)
    assert sailed.distance_nm / sailed.time_h == pytest.approx(5.0 / KNOT, rel=1e-6)


@pytest.mark.slow
def test_samples_of_the_reference_data_are_read():
    folder = data_file("rtz/samples")
    read, refused = {}, []
    for path in sorted(folder.rglob("*.rtz*")):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ThalwegWarning)
            try:
                read[path.name] = read_track(path, depart=0)
            except InputError:
                refused.append(path.name)
    assert len(read) >= 20 and len(refused) <= 4
    # 1.2: six waypoints over the Pacific, the Tasman Sea and both capes
    assert read["JPNGO_STLAW_BASIC_RTZ.rtz"].lat[-1] == pytest.approx(44.55386667)


@pytest.mark.parametrize("canal", [0, 1, 2])
def test_a_canal_is_written_with_its_bends_and_read_as_one_leg(tmp_path, canal):
    from dataclasses import replace

    from thalweg.chart import Chart
    from thalweg.route.canal_legs import canal_legs

    chosen = Chart.gshhg("c").canals[canal]
    chart = replace(Chart.open_water(-89.0, 89.0, -180.0, 180.0), canals=(chosen,))
    (lat1, lon1), (lat2, lon2) = chosen.ends
    track = Track([lat1, lat1, lat2, lat2], [lon1 - 0.4, lon1, lon2, lon2 + 0.4], 0.0)
    sailed = evaluate(track, ship=ship(7.0), sea=Sea.calm(), chart=chart)
    write_rtz(sailed, tmp_path / "canal.rtz", RouteFileOptions(chart=chart))
    written = re.findall(r'position lat="(\S+)" lon="(\S+)"', (tmp_path / "canal.rtz").read_text())
    bends = [place for place in written if (float(place[0]), float(place[1])) in chosen.path]
    assert len(bends) == len(chosen.path)  # one straight leg from end to end was over land
    again = evaluate(tmp_path / "canal.rtz", ship=ship(7.0), sea=Sea.calm(), chart=chart)
    assert again.time_h == pytest.approx(sailed.time_h, rel=1e-4)
    assert [row["leg_kind"] for row in again.waypoints()].count("canal") == 1
    less = [place for place in again.track.positions if place not in chosen.path]
    bends = [*chosen.path[:2], *chosen.path[3:]]  # without one: no second passage with its dues
    edited = Track(*np.array([less[0], *bends, less[-1]]).T, 0.0)
    parts = evaluate(edited, ship=ship(7.0), sea=Sea.calm(), chart=chart)
    dues = [canal_legs(one, chart, ship(7.0)).fee.sum() for one in (track, edited)]
    assert dues[1] == pytest.approx(dues[0]) and dues[0] > 0.0
    assert parts.time_h == pytest.approx(sailed.time_h, rel=0.02)


def _with_limits(port: float, starboard: float) -> str:
    leg = f'<leg portsideXTD="{port}" starboardXTD="{starboard}" geometryType="Loxodrome"/>'
    points = [(0.0, 0.0), (0.0, 1.0), (0.5, 1.0)]
    made = "".join(
        f'<waypoint id="{k}" revision="0"><position lat="{lat}" lon="{lon}"/>'
        f"{leg if k == 1 else ''}</waypoint>"
        for k, (lat, lon) in enumerate(points)
    )
    return f"{HEAD}<waypoints>{made}</waypoints></route>"


@pytest.mark.parametrize(
    ("port", "starboard", "words"),
    [
        (2.0, 0.5, "meet land or closed zones: leg 1 to port (2.00 nm)."),
        (0.5, 2.0, "keep clear of charted land and closed zones."),
    ],
)
def test_the_cross_track_limits_of_a_file_are_checked(tmp_path, port, starboard, words):
    """A shoal 1.2 to 3 nm north of an eastbound leg, closed by a zone."""
    path = tmp_path / "a.rtz"
    path.write_text(_with_limits(port, starboard))
    ring = [[0.4, 0.02], [0.6, 0.02], [0.6, 0.05], [0.4, 0.05], [0.4, 0.02]]
    zone = {"type": "Feature", "properties": {"kind": "no-go", "name": "shoal"},
            "geometry": {"type": "Polygon", "coordinates": [ring]}}  # fmt: skip
    chart = Chart.open_water().with_zones({"type": "FeatureCollection", "features": [zone]})
    found = evaluate(path, ship=ship(7.5), sea=Sea.calm(), chart=chart, depart=DEPART)
    assert found.feasible
    assert f"The cross-track limits of the file {words}" in found.assumptions
    without = evaluate(read_track(path, depart=DEPART), ship=ship(7.5), sea=Sea.calm(), chart=chart)
    assert not any("cross-track" in text for text in without.assumptions)


PREFIXED = """<r:route xmlns:r="http://www.cirm.org/RTZ/1/2" xmlns:stm="urn:stm" xmlns:x="urn:x"
 version="1.2"><r:routeInfo routeName="a"><r:extensions><r:extension name="info" manufacturer="M"
 version="1" x:kind="x:a"><stm:change by="&lt;&quot;&gt;"> a &amp; b </stm:change><plain/>
 </r:extension></r:extensions></r:routeInfo><r:waypoints><r:defaultWaypoint><r:leg><r:extensions>
 <r:extension name="usual" manufacturer="M"><r:more n="1"/></r:extension></r:extensions></r:leg>
 </r:defaultWaypoint>
 <r:waypoint id="1" revision="0"><r:position lat="50" lon="-5"/></r:waypoint>
 <r:waypoint id="2" revision="0"><r:position lat="50.1" lon="-5"/><r:leg><r:extensions>
 <r:extension name="leg" manufacturer="M"><f xmlns="urn:f"><g xmlns=""/><r:h/></f></r:extension>
 </r:extensions></r:leg></r:waypoint>
 <r:waypoint id="3" revision="0"><r:position lat="50.2" lon="-5"/></r:waypoint>
 <r:waypoint id="4" revision="0"><r:position lat="50.1" lon="-5"/><r:extensions>
 <r:extension name="again" manufacturer="M"/><loose/></r:extensions></r:waypoint>
 </r:waypoints><r:schedules><r:schedule id="1"><r:manual>
 <r:scheduleElement waypointId="1" etd="2026-03-01T06:00:00Z"/>
 <r:scheduleElement waypointId="3"><r:extensions><r:extension name="tide" manufacturer="M"/>
 </r:extensions></r:scheduleElement></r:manual></r:schedule></r:schedules>
 <r:extensions><r:extension name="route" manufacturer="M"/></r:extensions></r:route>"""


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_extensions_of_other_makers_are_kept(tmp_path, version):
    (tmp_path / "a.rtz").write_text(PREFIXED)
    track = read_track(tmp_path / "a.rtz")
    sailed = evaluate(track, ship=ship(7.0), sea=Sea.calm())
    again, written = [], tmp_path / "b.rtz"
    for _ in range(2):
        write_rtz(sailed, written, RouteFileOptions(rtz_version=version))
        again.append(read_track(written))
        sailed = evaluate(again[-1], ship=ship(7.0), sea=Sea.calm())
    assert again[0].extensions == again[1].extensions
    assert sorted(track.extensions.general) == ["defaultLeg", "route", "routeInfo"]
    text = written.read_text()
    assert f'xmlns="http://www.cirm.org/RTZ/1/{version[-1]}"' in text
    assert '<stm:change by="&lt;&quot;&gt;"> a &amp; b </stm:change><plain xmlns="" />' in text
    assert 'x:kind="x:a"' in text and 'xmlns:x="urn:x"' in text and 'xmlns:stm="urn:stm"' in text
    assert '<f xmlns="urn:f"><g xmlns="" /><r:h /></f>' in text  # r is declared around it
    assert text.count('name="again"') == text.count('name="tide"') == text.count("<loose") == 1
    if version == "1.2":
        assert again[0].extensions.general == track.extensions.general
        assert '<extension name="usual" manufacturer="M"><more n="1" /></extension>' in text
    fourth = again[0].extensions.there((50.1, -5.0, 1), "waypoint")
    assert len(fourth) == 2 and ("unknown" in fourth[1]) == (version != "1.0")
    etree = pytest.importorskip("lxml.etree")
    schema = data_file(f"rtz/schema/RTZ Schema version {version.replace('.', '_')}.xsd")
    etree.XMLSchema(etree.parse(str(schema))).assertValid(etree.parse(str(written)))


NAMED = """<?xml version="1.0"?><route version="1.2" xmlns="http://www.cirm.org/RTZ/1/2">
<routeInfo routeName="a" routeAuthor="Second mate" vesselName="A &amp; B" vesselMMSI="244000000"
 vesselIMO="unknown" vesselVoyage="12 W" validityPeriodStart="2026-03-01T00:00:00Z"/><waypoints>
<defaultWaypoint><leg portsideXTD="0.5" starboardXTD="0.25"/></defaultWaypoint>
<waypoint id="1" revision="0" name="Berth"><position lat="50" lon="-5"/></waypoint>
<waypoint id="2" revision="0" name="WP 2"><position lat="50.1" lon="-5"/>
 <leg portsideXTD="0.05" starboardXTD="0.06"/></waypoint>
<waypoint id="3" revision="0" name="Buoy &lt;3&gt;"><position lat="50.2" lon="-5"/></waypoint>
<waypoint id="4" revision="0"><position lat="51" lon="0"/>
 <leg portsideXTD="99" geometryType="Orthodrome"/></waypoint>
</waypoints></route>"""


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_names_limits_and_facts_of_a_file_are_kept(tmp_path, version):
    (tmp_path / "a.rtz").write_text(NAMED)
    track, written = read_track(tmp_path / "a.rtz", depart=0), tmp_path / "b.rtz"
    sailed = evaluate(track, ship=ship(7.0), sea=Sea.calm())
    write_rtz(sailed, written, RouteFileOptions("A", "B", rtz_version=version))
    again = read_track(written).extensions
    assert again.info == track.extensions.info == {
        "routeAuthor": "Second mate", "vesselName": "A & B", "vesselMMSI": "244000000",
        "vesselVoyage": "12 W", "validityPeriodStart": "2026-03-01T00:00:00Z",
    }  # fmt: skip
    names = {visit[:2]: name for visit, name in again.names.items()}
    assert names[50.0, -5.0] == "Berth" and names[50.2, -5.0] == "Buoy <3>"
    sides = {v[0]: np.round(np.array(s) / NAUTICAL_MILE, 3) for v, s in again.corridors.items()}
    assert sides[50.1].tolist() == [0.05, 0.06] and sides[50.2].tolist() == [0.5, 0.25]
    assert sides[51.0].tolist() == [0.1, 0.25]  # 99 nm is none that the format allows
    long_leg = [pair.tolist() for lat, pair in sides.items() if 50.2 < lat < 51.0]
    assert long_leg and all(pair == [0.1, 0.25] for pair in long_leg)
    etree = pytest.importorskip("lxml.etree")
    schema = data_file(f"rtz/schema/RTZ Schema version {version.replace('.', '_')}.xsd")
    etree.XMLSchema(etree.parse(str(schema))).assertValid(etree.parse(str(written)))


def test_a_rhumb_leg_of_a_file_stays_one_leg(tmp_path):
    """Falkonera to Dia got a waypoint between them, 0.12 nm off the geodesic."""
    places = [(37.7333, 23.74), (36.8, 24.0333), (35.5, 25.05), (35.4, 26.5)]
    points = "".join(
        f'<waypoint id="{k}"><position lat="{lat}" lon="{lon}"/></waypoint>'
        for k, (lat, lon) in enumerate(places, start=1)
    )
    (tmp_path / "a.rtz").write_text(
        '<route xmlns="http://www.cirm.org/RTZ/1/0" version="1.0"><routeInfo routeName="a"/>'
        f"<waypoints>{points}</waypoints></route>"
    )
    track, again = read_track(tmp_path / "a.rtz", depart=0), tmp_path / "b.rtz"
    assert len(track) > 4
    sailed = evaluate(track, ship=ship(6.0), sea=Sea.calm())
    write_rtz(sailed, again)
    written = again.read_text()
    assert written.count("<position") == 4 and all(f'lat="{lat}' in written for lat, _ in places)
    assert file_route(sailed).cross_track_m < 30.0
    # great circles in parts, as those sailed at one speed over ground, are no rhumb lines
    lat, lon, leg = densify(np.full(3, 45.0), np.array([-20.0, -15.0, -10.0]), 150_000.0)
    divided = Track(lat, lon, 0.0, given_leg=leg + 1)
    assert divided.leg_numbers.tolist() == [1, 1, 1, 2, 2, 2]
    write_rtz(evaluate(divided, ship=ship(6.0), sea=Sea.calm()), again)
    assert again.read_text().count("<position") > 6
    write_rtz(sailed, again, RouteFileOptions(legs="great-circle"))
    assert again.read_text().count("<position") > 4
    write_rtz(sailed, again, RouteFileOptions(max_waypoints=2, cross_track_nm=5.0))
    assert again.read_text().count("<position") == 2


DETAILED = """<?xml version="1.0"?><route version="1.2" xmlns="http://www.cirm.org/RTZ/1/2">
<routeInfo routeName="a"/><waypoints>
<defaultWaypoint radius="0.6"><leg speedMax="14" safetyContour="20"/></defaultWaypoint>
<waypoint id="1" revision="0"><position lat="50" lon="-5"/></waypoint>
<waypoint id="2" revision="0" radius="7.5"><position lat="50.1" lon="-5.1"/>
 <leg speedMax="6.5" draughtForward="twelve" legNote1="VTS &lt;12&gt;"/></waypoint>
<waypoint id="3" revision="0"><position lat="51" lon="0"/><leg legReport="noon"
 geometryType="Orthodrome"/></waypoint></waypoints></route>"""


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2"])
def test_turn_radii_limits_and_texts_of_legs_are_kept(tmp_path, version):
    (tmp_path / "a.rtz").write_text(DETAILED)
    track, written = read_track(tmp_path / "a.rtz", depart=0), tmp_path / "b.rtz"
    sailed = evaluate(track, ship=ship(7.0), sea=Sea.calm())
    write_rtz(sailed, written, RouteFileOptions("A", "B", rtz_version=version))
    first, second, *pieces, last = read_track(written).extensions.details.values()
    assert first == {"radius": "0.6"}
    wide = {"radius": "7.5"} if version == "1.0" else {}  # at most 5 nm in the later schemas
    assert second == wide | {"speedMax": "6.5", "safetyContour": "20", "legNote1": "VTS <12>"}
    of_leg = {"speedMax": "14", "safetyContour": "20"}
    assert pieces and all(piece == of_leg for piece in pieces)  # of the great circle
    assert last == of_leg | {"radius": "0.6", "legReport": "noon"}
    etree = pytest.importorskip("lxml.etree")
    schema = data_file(f"rtz/schema/RTZ Schema version {version.replace('.', '_')}.xsd")
    etree.XMLSchema(etree.parse(str(schema))).assertValid(etree.parse(str(written)))


def test_fewer_waypoints_have_the_least_limits_of_the_legs_they_stand_for(tmp_path):
    (tmp_path / "a.rtz").write_text(NAMED)
    track, written = read_track(tmp_path / "a.rtz", depart=0), tmp_path / "b.rtz"
    few = RouteFileOptions(max_waypoints=3, legs="great-circle")
    write_rtz(evaluate(track, ship=ship(7.0), sea=Sea.calm()), written, few)
    again = read_track(written).extensions
    limits = {v[0]: np.round(np.array(s) / NAUTICAL_MILE, 3) for v, s in again.corridors.items()}
    assert list(limits) == [50.2, 51.0] and limits[50.2].tolist() == [0.05, 0.06]


def test_extensions_stay_with_waypoints_that_could_be_left_out(tmp_path):
    extension = '<extensions><extension name="a" manufacturer="M"/></extensions>'
    points = POINTS.replace('"50.1" lon="-5"/>', f'"50.1" lon="-5"/>{extension}')
    for place, kept in ((points, 3), (POINTS, 2)):
        (tmp_path / "a.rtz").write_text(f"{HEAD}<waypoints>{place}</waypoints></route>")
        track = read_track(tmp_path / "a.rtz", depart=0)
        write_rtz(evaluate(track, ship=ship(7.0), sea=Sea.calm()), tmp_path / "b.rtz")
        assert (tmp_path / "b.rtz").read_text().count("<waypoint ") == kept


def test_extensions_nested_too_deep_are_refused(tmp_path):
    deep = f'<extension name="a" manufacturer="M">{"<a>" * 60}{"</a>" * 60}</extension>'
    text = f"{HEAD}<waypoints>{POINTS}</waypoints><extensions>{deep}</extensions></route>"
    (tmp_path / "a.rtz").write_text(text)
    with pytest.raises(InputError, match="too deep"):
        read_track(tmp_path / "a.rtz", depart=0)


def test_extensions_of_samples_are_kept(tmp_path):
    held = 0
    for name in ("AllOptionalElements", "MikhailTestFilesConvertedTo12"):
        path = sorted(data_file(f"rtz/samples/{name}").glob("*.rtz"))[-1]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ThalwegWarning)
            track = read_track(path, depart=0)
            if track.extensions:
                held += 1
                sailed = evaluate(track, ship=ship(7.0), sea=Sea.calm(), strict=False)
                write_rtz(sailed, tmp_path / "b.rtz", RouteFileOptions(legs="great-circle"))
                again = read_track(tmp_path / "b.rtz").extensions
                assert again.general == track.extensions.general
                assert list(again.at.values()) == list(track.extensions.at.values())
    assert held == 2
