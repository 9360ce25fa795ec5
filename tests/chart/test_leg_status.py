"""The land test of legs against shapely, and where polygons are hard."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from thalweg.chart import Chart
from thalweg.chart.coast import gshhg
from thalweg.core import geodesy
from thalweg.core.errors import DatasetError, InputError
from thalweg.kernels.codes import LAND, NO_DATA, NO_GO, OK
from thalweg.kernels.geometry.coast_index import leg_blocked, leg_code


def densified(lat, lon, lat2, lon2, spacing):
    """Return the geodesic as a shapely line in (lon, lat), longitudes running on."""
    length = float(geodesy.distance(lat, lon, lat2, lon2))
    y, x = geodesy.positions_along(
        lat, lon, lat2, lon2, np.linspace(0, 1, int(length / spacing) + 2)
    )
    y[0], y[-1], x[0], x[-1] = lat, lat2, lon, lon2
    return shapely.LineString(np.stack([lon + (x - lon + 180.0) % 360.0 - 180.0, y], -1))


def random_legs(seed, count, window, lengths):
    rng = np.random.default_rng(seed)
    lat, lon = rng.uniform(window[0], window[1], count), rng.uniform(window[2], window[3], count)
    length = rng.uniform(*lengths, count)
    lat2, lon2 = geodesy.direct(lat, lon, rng.uniform(0, 2 * np.pi, count), length)
    return lat, lon, lat2, lon2


@pytest.mark.slow
@pytest.mark.parametrize(
    ("window", "lengths"),
    [
        ((48, 62, -8, 12), (1e3, 60e3)),
        ((30, 68, -20, 25), (300e3, 1500e3)),
        ((76, 83, 10, 60), (5e3, 300e3)),
        ((-79, -62, -70, -40), (5e3, 300e3)),
    ],
    ids=["North Sea", "European ocean legs", "Arctic", "Antarctic"],
)
def test_agrees_with_shapely_on_every_random_leg(world, window, lengths):
    legs = random_legs(3, 600, window, lengths)
    lines = [densified(*leg, 1000.0) for leg in zip(*legs)]
    west, south, east, north = np.array([line.bounds for line in lines]).T
    tree = shapely.STRtree(
        world.coastline.polygons(max(south.min(), -89.9), north.max(), west.min(), east.max())
    )
    theirs = np.zeros(len(lines), bool)
    theirs[tree.query(lines, predicate="intersects")[0]] = True
    ours = world.legs_blocked(*legs)
    assert 0.05 < ours.mean() < 0.98
    assert np.flatnonzero(ours != theirs).tolist() == []


@pytest.mark.slow
def test_positions_agree_with_shapely(world):
    rng = np.random.default_rng(5)
    lat, lon = np.degrees(np.arcsin(rng.uniform(-1, 1, 20000))), rng.uniform(-180, 180, 20000)
    tree = shapely.STRtree(world.coastline.polygons(-90, 90, -180, 180))
    land = np.zeros(len(lat), bool)
    land[tree.query(shapely.points(lon, lat), predicate="intersects")[0]] = True
    assert np.array_equal(world.is_navigable(lat, lon), ~land)


def test_leg_through_vertices_exactly_on_greenwich_is_blocked(world):
    # GSHHG has the vertices of England at (0, 52.8884) and (0, 50.7879): no proper crossing
    assert world.legs_blocked(54.0, 0.0, 50.5, 0.0)
    assert world.legs_blocked(50.5, 0.0, 54.0, 0.0)
    assert world.legs_blocked(52.8884, 0.0, 50.7879, 0.0)
    assert not world.legs_blocked(54.0, 0.5, 53.2, 0.5)


def test_leg_wholly_inside_land_is_blocked(world):
    assert world.legs_blocked(47.0, 2.0, 47.1, 2.1)
    assert world.legs_blocked(47.0, 2.0, 47.0, 2.0)
    assert world.legs_blocked(45.0, 60.0, 60.0, 110.0)


def test_lakes_and_inland_seas_are_closed(world):
    caspian, superior = (42.0, 50.5), (47.7, -87.5)
    assert not world.is_navigable(*caspian)
    assert not world.is_navigable(*superior)


def test_antimeridian_and_poles(world):
    assert not world.legs_blocked(0.0, 179.0, 1.0, -179.0)
    assert not world.legs_blocked(0.0, 179.0, 1.0, 181.0)
    assert world.legs_blocked(66.5, 179.0, 66.5, -179.0)  # Chukotka
    assert not world.legs_blocked(88.0, 10.0, 88.0, -170.0)  # over the North Pole
    assert world.legs_blocked(-60.0, 0.0, -60.0, 179.0)  # over Antarctica
    assert not world.is_navigable(-90.0, 0.0)
    assert world.is_navigable(90.0, 0.0)


def test_land_cut_in_two_at_a_meridian_has_no_seam(world):
    # GSHHG splits Chukotka and Wrangel Island at 180 degrees, Antarctica at 0 and 180
    lat = np.array([66.0, 67.5, 68.5, 71.1, -80.0, -85.0])
    for lon in (180.0, -180.0, 180.0 - 1e-13, -180.0 + 1e-13):
        assert not world.is_navigable(lat, lon).any()
        assert world.legs_blocked(lat, lon, lat + 0.01, lon).all()
        assert world.legs_blocked(64.0, lon, 70.0, lon)
        assert world.legs_blocked(70.0, lon, 64.0, lon)
    assert not world.is_navigable(np.linspace(-89.9, -70.0, 50), 0.0).any()


def test_zero_length_legs_are_points(world):
    assert not world.legs_blocked(54.0, 3.0, 54.0, 3.0)
    assert world.leg_status(52.0, 5.5, 52.0, 5.5) == LAND


@pytest.mark.slow
def test_long_legs_follow_the_geodesic_not_a_rhumb_line(world):
    # the geodesic from Lisbon's roads to the Caribbean is open; Tokyo - Seattle passes Alaska clear
    assert not world.legs_blocked(38.4, -9.6, 18.5, -60.0)
    assert world.legs_blocked(36.0, 141.5, 51.0, -127.5) == shapely.intersects(
        shapely.union_all(world.coastline.polygons(30, 70, 130, -120)),
        densified(36.0, 141.5, 51.0, -127.5, 1000.0),
    )


def test_direction_does_not_matter(world):
    lat, lon, lat2, lon2 = random_legs(9, 4000, (35, 60, -15, 20), (20e3, 900e3))
    there = world.legs_blocked(lat, lon, lat2, lon2)
    back = world.legs_blocked(lat2, lon2, lat, lon)
    assert np.array_equal(there, back)


def test_broadcasts_and_preserves_shape(world):
    found = world.legs_blocked(54.0, 3.0, np.full((2, 3), 54.5), np.full((2, 3), 4.0))
    assert found.shape == (2, 3)
    assert world.leg_status(54.0, 3.0, 54.1, 3.0).shape == ()


def test_not_a_number_is_no_data_and_blocked(world):
    assert world.leg_status(np.nan, 3.0, 54.0, 4.0) == NO_DATA
    assert world.leg_status(54.0, 3.0, 54.0, np.nan) == NO_DATA
    assert not world.is_navigable(np.nan, 0.0)


def test_kernel_is_the_same_test(world):
    coast = world.arrays
    legs = random_legs(11, 300, (48, 62, -8, 12), (5e3, 60e3))
    ours = [leg_blocked(coast, *leg) for leg in zip(*legs)]
    assert np.array_equal(ours, world.legs_blocked(*legs))
    assert leg_code(coast, 54.0, 3.0, 54.0, 3.5) == (OK, False)


SQUARE = {
    "type": "Polygon",
    "coordinates": [
        [[10.0, 50.0], [12.0, 50.0], [12.0, 52.0], [10.0, 52.0], [10.0, 50.0]],
        [[10.5, 50.5], [11.5, 50.5], [11.5, 51.5], [10.5, 51.5], [10.5, 50.5]],
    ],
}


def test_own_land_with_a_hole_of_water():
    chart = Chart.from_geojson(SQUARE)
    assert chart.is_navigable([51.0, 50.2, 49.0], [11.0, 11.0, 11.0]).tolist() == [
        True,
        False,
        True,
    ]
    assert not chart.legs_blocked(50.8, 10.8, 51.2, 11.2)
    assert chart.legs_blocked(51.0, 11.0, 53.0, 11.0)
    assert chart.legs_blocked(51.0, 9.0, 51.0, 13.0)
    assert not chart.legs_blocked(49.0, 9.0, 49.0, 13.0)


def test_long_straight_edges_are_straight_in_longitude_and_latitude():
    # the northern edge at 60N is a parallel; the arc between its ends would rise to 66 N
    box = [[-40.0, 50.0], [40.0, 50.0], [40.0, 60.0], [-40.0, 60.0], [-40.0, 50.0]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [box]})
    assert chart.is_navigable([60.0001, 61.0], [0.0, 0.0]).all()
    assert not chart.is_navigable(59.9999, 0.0)
    assert not chart.legs_blocked(60.001, 0.0, 60.001, 0.1)
    assert chart.legs_blocked(59.9995, 0.0, 60.001, 0.1)


def test_own_land_across_the_antimeridian():
    box = [[179.0, -1.0], [-179.0, -1.0], [-179.0, 1.0], [179.0, 1.0], [179.0, -1.0]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [box]})
    assert chart.is_navigable([0, 0, 0, 0], [180.0, -180.0, 178.0, 0.0]).tolist() == [
        False,
        False,
        True,
        True,
    ]
    assert chart.legs_blocked(0.0, 178.0, 0.0, -178.0)


@pytest.mark.slow
@given(
    st.floats(50.2, 51.8),
    st.floats(10.2, 11.8),
    st.floats(49.0, 53.0),
    st.floats(9.0, 13.0),
)
def test_any_leg_near_a_square_agrees_with_shapely(lat, lon, lat2, lon2):
    ring, hole = SQUARE["coordinates"]
    line = densified(lat, lon, lat2, lon2, 500.0)
    if shapely.distance(shapely.Polygon(ring, [hole]).boundary, line) == 0.0:
        touches = True
    else:
        touches = shapely.contains_xy(shapely.Polygon(ring, [hole]), lon, lat)
    assert CHART.legs_blocked(lat, lon, lat2, lon2) == touches


CHART = Chart.from_geojson(SQUARE)


def test_open_water_is_a_box_no_leg_may_leave():
    chart = Chart.open_water(-1.0, 1.0, 170.0, -170.0)
    assert not chart.legs_blocked(0.0, 175.0, 0.0, -175.0)
    assert chart.leg_status(0.0, 175.0, 0.0, -165.0) == NO_GO
    assert chart.is_navigable(0.0, 180.0)
    assert not chart.is_navigable([0.0, 2.0], [0.0, 180.0]).any()
    assert not chart.legs_blocked(-1.0, 170.0, -1.0, 170.0)


def test_open_water_blocks_a_geodesic_that_bulges_over_its_northern_side():
    chart = Chart.open_water(north=51.0, south=40.0, west=-40.0, east=40.0)
    assert chart.legs_blocked(50.5, -30.0, 50.5, 30.0)
    assert not chart.legs_blocked(50.5, -1.0, 50.5, 1.0)


def test_open_water_wider_than_half_the_world_is_not_left_round_the_back():
    chart = Chart.open_water(-10.0, 10.0, -150.0, 150.0)
    assert chart.legs_blocked(0.0, -140.0, 0.0, 140.0)
    assert not chart.legs_blocked(0.0, -60.0, 0.0, 60.0)


def test_whole_world_of_open_water_has_no_border():
    chart = Chart.open_water()
    assert not chart.legs_blocked(0.0, 179.0, 89.0, -100.0)
    assert chart.coastline.shore_distance(0.0, 0.0) >= 50_000.0


@pytest.mark.parametrize("box", [(1, -1, 0, 1), (-91, 0, 0, 1), (0, 1, 5, 5), (0, np.nan, 0, 1)])
def test_an_area_that_is_none_is_refused(box):
    with pytest.raises(InputError, match="area"):
        Chart.open_water(*box)


@pytest.mark.slow
def test_shore_distance_is_a_lower_bound_near_the_exact_value(world):
    rng = np.random.default_rng(8)
    lat, lon = rng.uniform(49, 60, 300), rng.uniform(-8, 10, 300)
    found = world.coastline.shore_distance(lat, lon)
    polygons = shapely.union_all(world.coastline.polygons(45, 64, -15, 16))
    outline = shapely.get_coordinates(shapely.segmentize(polygons, 0.01).boundary)
    water = world.is_navigable(lat, lon)
    assert np.array_equal(found > 0.0, water)
    for k in np.flatnonzero(water)[:60]:
        near = np.hypot(
            (outline[:, 0] - lon[k]) * np.cos(np.radians(lat[k])), outline[:, 1] - lat[k]
        )
        candidates = outline[np.argsort(near)[:40]]
        true = geodesy.distance(lat[k], lon[k], candidates[:, 1], candidates[:, 0]).min()
        assert found[k] <= true + 1.0
        assert found[k] >= min(true, 50_000.0) * 0.985 - 350.0  # the outline is sampled


def test_unknown_or_missing_resolution_is_refused_with_a_remedy():
    with pytest.raises(InputError, match="c \\(crude\\)"):
        Chart.gshhg("x")
    try:
        Chart.gshhg("f")
    except InputError as error:
        assert "thalweg[hires]" in str(error)


def test_plans_take_the_fine_coastline_where_it_is_installed(monkeypatch):
    def with_files(resolution):
        return Path("meta"), Path("points")

    def without_files(resolution):
        raise InputError("The high coastline (h) is not installed.", "", "")

    for files, expected in ((with_files, "h"), (without_files, "i")):
        monkeypatch.setattr(gshhg, "data_files", files)
        assert gshhg.usual_resolution() == expected


@pytest.mark.parametrize("table", ["1 5.0 4 0.0 1.0 0 64 0\n", "1 5.0 3 0.0 1.0\n"])
def test_coastline_files_that_do_not_belong_together_are_refused(monkeypatch, tmp_path, table):
    meta, points = tmp_path / "gshhsmeta_c.dat", tmp_path / "gshhs_c.dat"
    meta.write_text(table, encoding="ascii")
    np.array([[0, 0], [1, 0], [0, 1]], "<f4").tofile(points)
    monkeypatch.setattr(gshhg, "data_files", lambda resolution: (meta, points))
    with pytest.raises(DatasetError, match="do not belong together"):
        gshhg.read_land_rings("c")
