"""What a bridge gets: few waypoints with names, joined by rhumb lines that keep to the route."""

import csv

import numpy as np
import pytest

from tests.route.planar import ship
from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import WGS84, direct, distance
from thalweg.core.rhumb_lines import inverse_rhumb, rhumb_deviates, rhumb_pieces
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route import (
    RouteFileOptions,
    Track,
    evaluate,
    read_track,
    write_csv,
    write_geojson,
    write_gpx,
    write_rtz,
    write_s421,
)
from thalweg.route.formats.file_route import file_route
from thalweg.route.formats.waypoint_names import waypoint_names
from thalweg.sea import Sea
from thalweg.ship import Ship

WRITERS = {"csv": write_csv, "geojson": write_geojson, "gpx": write_gpx, "rtz": write_rtz}
DEPART = "2026-03-01T06:00:00Z"
OCEAN = [(49.7, -6.5), (47.0, -40.0), (40.4, -73.0)]


def swell(_time, lat, lon):
    return 1.2 * np.sin(np.radians(12.0 * lon)) + 0.0 * lat


SEA = Sea.from_functions(
    {
        "eastward_sea_water_velocity": swell,
        "northward_sea_water_velocity": lambda time, lat, lon: 0.3 + 0.0 * lat,
    }
)


@pytest.fixture(scope="module")
def ocean():
    return evaluate(OCEAN, ship=ship(7.0), sea=SEA, depart=DEPART)


def positions(rows):
    return np.array([row["lat"] for row in rows]), np.array([row["lon"] for row in rows])


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_file_sailed_along_rhumb_lines_is_the_plan(tmp_path, suffix, ocean):
    path = tmp_path / f"route.{suffix}"
    WRITERS[suffix](ocean, path, RouteFileOptions("Bishop Rock", "New York"))
    read = read_track(path)
    lat, lon, _ = rhumb_pieces(read.lat, read.lon, 20.0)
    sailed = evaluate(Track(lat, lon, read.depart), ship=ship(7.0), sea=SEA)
    assert sailed.time_h == pytest.approx(ocean.time_h, rel=1e-3)
    assert sailed.distance_nm == pytest.approx(ocean.distance_nm, rel=1e-3)


def test_great_circles_are_broken_below_the_cross_track_limit(ocean):
    found = file_route(ocean)
    lat, lon = positions(found.rows)
    assert 40 < len(lat) < 90
    assert found.cross_track_m <= 0.1 * NAUTICAL_MILE
    assert not rhumb_deviates(lat, lon, 0.1 * NAUTICAL_MILE).any()
    bound = file_route(ocean, RouteFileOptions(cross_track_nm=1.0))
    assert len(bound.rows) < 0.4 * len(lat)
    assert 0.1 * NAUTICAL_MILE < bound.cross_track_m <= NAUTICAL_MILE
    close = positions(file_route(ocean, RouteFileOptions(spacing_nm=20.0)).rows)
    assert distance(close[0][:-1], close[1][:-1], close[0][1:], close[1][1:]).max() < 37_041.0


@pytest.mark.parametrize("suffix", ["csv", "geojson", "gpx", "rtz", "gml"])
@pytest.mark.parametrize("legs", ["rhumb", "great-circle"])
def test_the_lines_of_a_file_are_sailed_when_it_is_read(tmp_path, suffix, legs, ocean):
    path = tmp_path / f"route.{suffix}"
    {**WRITERS, "gml": write_s421}[suffix](
        ocean, path, RouteFileOptions(legs=legs, cross_track_nm=5.0)
    )
    read = read_track(path)
    found = file_route(ocean, RouteFileOptions(legs=legs, cross_track_nm=5.0))
    lat, lon = positions(found.rows)
    if legs == "great-circle":
        assert len(found.rows) == len(ocean.track) and found.cross_track_m < 1.0
        length = distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    else:
        assert 1.0 * NAUTICAL_MILE < found.cross_track_m <= 5.0 * NAUTICAL_MILE
        length = inverse_rhumb(lat[:-1], lon[:-1], lat[1:], lon[1:])[0]
    assert read.lengths.sum() == pytest.approx(length.sum(), rel=1e-6)
    assert read.depart == ocean.depart


@pytest.mark.slow
def test_the_work_for_many_waypoints_is_done_at_once(tmp_path, monkeypatch):
    """Sixteen times the legs, all kept in the file, need a few more calls of the geodesic."""
    counts = []
    for size in (100, 1600):
        share = np.linspace(0.0, 1.0, size)
        track = Track(40.0 + 10.0 * np.sin(20.0 * share), -60.0 + 50.0 * share, 0.0)
        route = evaluate(track, ship=ship(7.0), sea=Sea.calm())
        calls = []
        with monkeypatch.context() as patched:
            for module in ("geodesy", "rhumb_lines"):
                patched.setattr(f"thalweg.core.{module}.WGS84", CountedGeod(WGS84, calls))
            write_rtz(route, tmp_path / "a.rtz", RouteFileOptions(thinning=0.0))
            assert len(read_track(tmp_path / "a.rtz")) >= size
        counts.append(len(calls))
    assert counts[1] <= counts[0] + 100  # deeper thinning; not one or more for each leg


class CountedGeod:
    """A geodesic whose calls are noted."""

    def __init__(self, geod, calls):
        self.geod, self.calls = geod, calls

    def inv(self, *arguments):
        self.calls.append("inv")
        return self.geod.inv(*arguments)

    def fwd(self, *arguments):
        self.calls.append("fwd")
        return self.geod.fwd(*arguments)


def test_rows_of_broken_legs(ocean):
    rows = file_route(ocean).rows
    lat, lon = positions(rows)
    assert all(round(x, 6) == x for x in (*lat, *lon))
    assert rows[-1]["distance_nm"] == pytest.approx(ocean.distance_nm, abs=1e-3)
    assert rows[-1]["time"] == ocean.waypoints()[-1]["time"]
    times = np.array([row["time"].removesuffix("Z") for row in rows], "datetime64[s]")
    hours = np.diff(times).astype(float) / 3600.0
    speed = np.array([row["speed_over_ground_kn"] for row in rows[:-1]])
    step = np.diff([row["distance_nm"] for row in rows])
    np.testing.assert_allclose(hours * speed, step, rtol=2e-3)
    course = np.degrees(inverse_rhumb(lat[:-1], lon[:-1], lat[1:], lon[1:])[1])
    np.testing.assert_allclose([row["course_deg"] for row in rows[:-1]], course, atol=0.01)


def test_at_most_so_many_waypoints(ocean):
    found = file_route(ocean, RouteFileOptions(max_waypoints=12))
    assert 10 <= len(found.rows) <= 12
    assert found.cross_track_m > 0.5 * NAUTICAL_MILE
    with pytest.raises(InputError, match="It needs"):
        file_route(ocean, RouteFileOptions(max_waypoints=2))


def test_no_repeated_and_no_collinear_waypoints():
    lat = np.concatenate([np.linspace(52.0, 52.4, 20), [52.400003, 52.6, 52.600002]])
    lon = np.concatenate([np.linspace(3.5, 3.5, 20), [3.5, 3.9, 3.9]])
    wait = np.zeros(len(lat))
    wait[5] = 600.0
    speed = np.full(len(lat) - 1, 6.0)
    speed[15:] = 5.0
    vessel = ship(6.0).with_speeds([5.0, 6.0])
    route = evaluate(Track(lat, lon, 0.0, wait, speed=speed), ship=vessel, sea=Sea.calm())
    rows = file_route(route).rows
    assert [row["waiting_h"] > 0 for row in rows] == [False, True, False, False, False]
    assert rows[1]["lat"] == pytest.approx(lat[5], abs=1e-6)
    assert rows[2]["lat"] == pytest.approx(lat[15], abs=1e-6)  # the speed changes
    got = positions(rows)
    assert distance(got[0][:-1], got[1][:-1], got[0][1:], got[1][1:]).min() > 100.0
    assert rows[-1]["time"] == route.waypoints()[-1]["time"]
    assert [r["ordered_speed_kn"] for r in rows[:-1]] == pytest.approx(
        [11.663, 11.663, 9.719, 9.719], abs=1e-3
    )


def test_rhumb_lines_that_touch_land_are_broken_again():
    # a spit whose tip the great circle clears by 60 m
    whole = evaluate([(45.0, -20.0), (45.0, -16.0)], ship=ship(6.0), sea=Sea.calm(), depart=DEPART)
    middle = int(np.argmin(np.abs(whole.samples["lon"] + 18.0)))
    tip = float(whole.samples["lat"][middle]) - 60.0 / 111_132.0
    ring = [[-18.01, 44.5], [-17.99, 44.5], [-18.0, tip], [-18.01, 44.5]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [ring]})

    def touches(options):
        lat, lon = positions(file_route(whole, options).rows)
        lat, lon, _ = rhumb_pieces(lat, lon, 1.0)
        return chart.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]).any()

    assert touches(RouteFileOptions(cross_track_nm=2.0))
    assert not touches(RouteFileOptions(cross_track_nm=2.0, chart=chart))


def test_names_of_waypoints(tmp_path, ocean):
    miles = np.array([0.0, 3.0, 11.0, 60.0, 300.0, 390.0, 400.0]) * NAUTICAL_MILE
    assert waypoint_names(miles, "Rotterdam (moved)", "Hull") == [
        "Rotterdam", "WP 2", "Rotterdam approach", "WP 4", "WP 5", "Hull approach", "Hull",
    ]  # fmt: skip
    approach = np.array([True, True, True, False, False, True])
    named = waypoint_names(miles, "Rotterdam, NL", "49.7000N 6.5000W", approach)
    assert named[0] == "Rotterdam" and named[3] == "Rotterdam approach" and named[-1] == "WP 7"
    assert waypoint_names(miles, goal="Hull", approach=approach)[-2:] == ["Hull approach", "Hull"]
    assert waypoint_names(miles[:2]) == ["WP 1", "WP 2"]
    assert waypoint_names(miles[:2], "Hull", "Hull") == ["Hull", "Hull (end)"]
    path = tmp_path / "route.csv"
    write_csv(ocean, path, RouteFileOptions("Bishop Rock", "New York"))
    names = [row["name"] for row in csv.DictReader(path.open())]
    assert names[0] == "Bishop Rock" and names[-1] == "New York" and names[1] == "WP 2"
    assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    "given",
    [
        {"cross_track_nm": 0.0},
        {"cross_track_nm": 10.0},
        {"cross_track_nm": float("nan")},
        {"spacing_nm": 0.0},
        {"max_waypoints": 1},
        {"rtz_version": "2.0"},
    ],
)
def test_impossible_options_are_refused(given):
    with pytest.raises(InputError):
        RouteFileOptions(**given)


@pytest.mark.parametrize("suffix", ["csv", "gpx"])
def test_legs_that_a_file_calls_rhumb_lines_are_sailed_as_such(tmp_path, suffix):
    """45 N to 45 N over 40 degrees: along the parallel, 30 nm longer than the great circle."""
    path = tmp_path / f"route.{suffix}"
    if suffix == "csv":
        path.write_text("lat,lon,geometry\n45,-50,RL\n45,-10,\n")
    else:
        order = '<extensions><t:geometry xmlns:t="urn:thalweg:route:1">RL</t:geometry></extensions>'
        points = f'<rtept lat="45" lon="-50">{order}</rtept><rtept lat="45" lon="-10"/>'
        path.write_text(f"<gpx><rte>{points}</rte></gpx>")
    read = read_track(path, depart=DEPART)
    assert len(read) > 10
    assert np.abs(read.lat - 45.0).max() < 1e-6
    along = float(inverse_rhumb(45.0, -50.0, 45.0, -10.0)[0])
    assert read.lengths.sum() == pytest.approx(along, rel=1e-5)
    path.write_text(path.read_text().replace("RL", "spiral"))
    with pytest.raises(InputError, match="geometry of the leg after waypoint 1"):
        read_track(path, depart=DEPART)


def test_a_bend_along_the_edge_of_the_offing_is_no_string_of_short_legs():
    corner = {"type": "Polygon", "coordinates": [[[4, 52], [5, 52], [5, 53], [4, 53], [4, 52]]]}
    chart = Chart.from_geojson(corner).with_offing(2.0 * NAUTICAL_MILE)
    angles = np.radians(np.arange(180.0, 271.0, 3.0))  # legs of a tenth of a mile
    lat, lon = direct(52.0, 4.0, angles, 2.003 * NAUTICAL_MILE)
    lat = np.concatenate([[lat[0]], lat, [52.4]])
    lon = np.concatenate([[4.4], lon, [lon[-1]]])
    bend = evaluate(Track(lat, lon, 0.0), ship=ship(7.0), sea=Sea.calm(), chart=chart, strict=False)
    assert bend.feasible and len(bend.track) == 33
    rows = file_route(bend, RouteFileOptions(chart=chart))
    y, x = positions(rows.rows)
    lengths = np.asarray(distance(y[:-1], x[:-1], y[1:], x[1:]))
    assert len(y) <= 10 and lengths.min() > 0.25 * NAUTICAL_MILE
    assert rows.cross_track_m < 0.1 * NAUTICAL_MILE
    y, x, _ = rhumb_pieces(y, x, 20.0)
    again = evaluate(Track(y, x, 0.0), ship=ship(7.0), sea=Sea.calm())
    assert again.time_h == pytest.approx(bend.time_h, rel=1e-3)
    assert (
        not chart.with_offing(1.94 * NAUTICAL_MILE).legs_blocked(y[:-1], x[:-1], y[1:], x[1:]).any()
    )


@pytest.mark.parametrize(("height", "kept"), [(4.002, True), (4.02, False)])
def test_a_limit_is_kept_in_a_file_that_exceeds_it_by_its_rounding(tmp_path, height, kept):
    """The file of a plan at its limit of waves rounds times and positions."""
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wave_height_m=4.0)
    name = "sea_surface_wave_significant_height"
    sea = Sea.from_functions({name: lambda time, lat, lon: height + 0.0 * (time + lat + lon)})
    track = Track([0.0, 0.0], [0.0, 0.5], depart="2026-01-01T00:00Z")
    path = tmp_path / "route.csv"
    write_csv(evaluate(track, ship=ship, sea=sea, strict=False), path)
    read = evaluate(path, ship=ship, sea=sea)
    assert read.feasible is kept
    stated = f"of {height:.4g} where the limit is 4, near "
    assert any(stated in note for note in read.assumptions) is kept
    assert not evaluate(track, ship=ship, sea=sea).feasible


def test_each_part_of_a_long_leg_has_its_own_distance_from_land():
    """The least distance of the whole leg stood at every waypoint of it, 50 nm off as well."""
    chart = Chart.gshhg("c")
    given = {"ship": Ship.load("handysize-bulker"), "sea": Sea.calm(), "chart": chart}
    route = evaluate([(43.40, -8.60), (44.5, -30.0)], **given, depart=0)
    rows = file_route(route, RouteFileOptions(chart=chart, spacing_nm=30.0)).rows[:-1]
    assert len(rows) > 20
    whole = {name: values[0] / NAUTICAL_MILE for name, values in route.legs.items()}
    nearest = [row["land_distance_nm"] for row in rows]
    assert nearest[0] == pytest.approx(whole["land_distance"], abs=0.02)
    assert nearest == sorted(nearest) and nearest[6:] == [12.0] * (len(rows) - 6)
    inshore = [row["inshore_nm"] for row in rows]
    assert sum(inshore) == pytest.approx(whole["inshore_length"], abs=0.01)
    assert inshore[0] > 2.0 and inshore[2:] == [0.0] * (len(rows) - 2)
