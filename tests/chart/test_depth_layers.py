"""Charted depth: sign, priority, least depth on legs, and unknown depth."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests.conftest import data_file
from thalweg.chart import Chart
from thalweg.chart.depth import depth_layers
from thalweg.core.errors import DatasetError, InputError
from thalweg.kernels.geometry.depth_sampling import least_depth

OPEN = Chart.open_water()


def grid(values, lat, lon, name="elevation", **attributes):
    coordinates = {"lat": lat, "lon": lon}
    return xr.DataArray(values, coordinates, ("lat", "lon"), name=name, attrs=attributes)


LAT, LON = np.arange(50.0, 52.01, 0.1), np.arange(2.0, 4.01, 0.1)
RAMP = np.broadcast_to(LON * 10.0, (len(LAT), len(LON)))  # depth 20 m in the west, 40 m in the east


@pytest.mark.parametrize(
    ("array", "options"),
    [
        (grid(-RAMP, LAT, LON, "elevation"), {}),
        (grid(-RAMP, LAT, LON, "Band1"), {}),
        (grid(RAMP, LAT, LON, "depth"), {}),
        (grid(RAMP, LAT, LON, "z", positive="down"), {}),
        (grid(-RAMP, LAT, LON, "depth", positive="up"), {}),
        (grid(-RAMP, LAT, LON, "q", standard_name="height_above_mean_sea_level"), {}),
        (grid(-RAMP, LAT, LON, "q"), {"positive": "up"}),
        (grid(RAMP / 1000.0, LAT, LON, "depth", units="km"), {}),
        (grid(RAMP[::-1], LAT[::-1], LON, "depth"), {}),
        (grid(RAMP[:, ::-1], LAT, LON[::-1], "depth"), {}),
        (grid(RAMP, LAT, LON + 360.0, "depth"), {}),
    ],
)
def test_depth_is_positive_down_for_any_sign_in_the_file(array, options):
    chart = OPEN.with_depth(array, **options)
    assert chart.has_depth
    assert chart.depths.at([51.0, 51.23], [3.0, 2.55]) == pytest.approx([30.0, 25.5], rel=1e-5)
    assert np.isnan(chart.depths.at([60.0, 51.0], [3.0, 1.9])).all()


def test_the_least_depth_of_a_leg_is_on_the_safe_side():
    chart = OPEN.with_depth(grid(RAMP, LAT, LON, "depth"))
    least = chart.depths.along(51.05, 2.55, 51.05, 3.55)
    assert least == pytest.approx(25.0)  # the least sounding of the first cell
    assert np.isnan(chart.depths.along(51.0, 3.5, 51.0, 4.5))
    assert OPEN.depths.along(51.0, 3.5, 51.0, 4.5) == np.inf


def test_a_shoal_of_one_sounding_is_never_missed():
    values = np.full(RAMP.shape, 30.0)
    values[10, 10] = 2.0  # at 51.0 N 3.0 E
    chart = OPEN.with_depth(grid(values, LAT, LON, "depth"))
    rng = np.random.default_rng(4)
    course = rng.uniform(0, np.pi, 200)
    dy, dx = 0.8 * np.cos(course), 0.8 * np.sin(course)
    off = rng.uniform(-0.05, 0.05, 200)
    y, x = 51.0 - off * np.sin(course), 3.0 + off * np.cos(course)
    assert (chart.depths.along(y - dy, x - dx, y + dy, x + dx) == 2.0).all()
    assert chart.depths.along(50.5, 2.2, 50.5, 3.8) == 30.0


def test_the_first_layer_with_data_at_a_position_is_used():
    inner = np.where(RAMP > 30.0, np.nan, 5.0)
    chart = OPEN.with_depth(grid(inner, LAT, LON, "depth")).with_depth(lambda lat, lon: 100.0)
    assert chart.depths.at(51.0, [2.5, 3.5, 10.0]) == pytest.approx([5.0, 100.0, 100.0])
    assert chart.depths.along(51.0, 2.2, 51.0, 2.4) == 5.0
    assert chart.depths.along(51.0, 3.4, 51.0, 3.8) == 100.0


def test_a_function_of_position():
    chart = OPEN.with_depth(lambda lat, lon: 10.0 + np.abs(lon))
    assert chart.depths.at(1.0, -2.0) == 12.0
    assert chart.depths.along(0.0, -1.0, 0.0, 1.0) == pytest.approx(10.0, abs=0.01)
    assert chart.depths.along(0.0, 1.0, 0.0, 2.0) == pytest.approx(11.0, abs=1e-6)
    assert np.isnan(OPEN.with_depth(lambda lat, lon: np.nan).depths.along(0, 0, 1, 1))


def test_functions_are_sampled_along_any_number_of_legs(monkeypatch):
    chart = OPEN.with_depth(lambda lat, lon: 10.0 + lat + 0.0 * lon)
    lat = np.linspace(0.0, 1.0, 50)
    legs = lat, np.zeros(50), lat + 0.1, np.zeros(50)
    whole = chart.depths.along(*legs)
    assert whole == pytest.approx(10.0 + lat, abs=1e-3)
    monkeypatch.setattr(depth_layers, "MAX_SAMPLES", 7)  # fewer than legs
    assert np.array_equal(chart.depths.along(*legs), whole)


def test_depth_round_the_world_has_no_seam():
    lat, lon = np.arange(-90.0, 91.0, 10.0), np.arange(0.0, 360.0, 10.0)
    values = np.broadcast_to(np.abs((lon + 180.0) % 360.0 - 180.0) + 1.0, (len(lat), len(lon)))
    chart = OPEN.with_depth(grid(values, lat, lon, "depth"))
    assert chart.depths.at(5.0, [-5.0, 355.0, 179.0, -179.0, 0.0]) == pytest.approx(
        [6.0, 6.0, 180.0, 180.0, 1.0]
    )
    assert chart.depths.along(5.0, 175.0, 5.0, -175.0) == pytest.approx(171.0)
    assert chart.depths.along(5.0, -15.0, 5.0, 15.0) == pytest.approx(1.0)


def test_uneven_steps_keep_the_least_sounding():
    lon = np.array([2.0, 2.1, 2.4, 3.0])
    values = np.broadcast_to(np.array([50.0, 40.0, 10.0, 60.0]), (len(LAT), 4))
    chart = OPEN.with_depth(grid(values, LAT, lon, "depth"))
    assert chart.depths.along(51.0, 2.2, 51.0, 2.8) == 10.0
    assert chart.depths.at(51.0, 2.4) == pytest.approx(10.0)


def test_between_uneven_soundings_the_shallower_one_counts():
    lon = np.array(
        [2.0, 3.0, 3.25]
    )  # on a grid with steps of 0.25: 2.25 to 2.75 lie between 10 and 50 m
    values = np.broadcast_to(np.array([10.0, 50.0, 50.0]), (len(LAT), 3))
    chart = OPEN.with_depth(grid(values, LAT, lon, "depth"))
    assert chart.depths.along(51.0, 2.45, 51.0, 2.55) == 10.0


def test_the_fingerprint_depends_on_the_soundings():
    one = OPEN.with_depth(grid(RAMP, LAT, LON, "depth"))
    two = OPEN.with_depth(grid(RAMP + 1.0, LAT, LON, "depth"))
    again = OPEN.with_depth(grid(RAMP, LAT, LON, "depth"))
    assert one.fingerprint() == again.fingerprint()
    assert len({one.fingerprint(), two.fingerprint(), OPEN.fingerprint()}) == 3


def test_the_kernel_gives_the_same_least_depth():
    chart = OPEN.with_depth(grid(RAMP, LAT, LON, "depth"))
    depths = chart.depths.arrays((50.5, 51.5, 2.5, 3.5))
    leg = (51.05, 2.55, 51.35, 3.25)
    assert least_depth(depths, *leg) == pytest.approx(float(chart.depths.along(*leg)))
    assert least_depth(OPEN.depths.arrays((0, 1, 0, 1)), 0.1, 0.1, 0.9, 0.9) == np.inf


def test_unclear_or_broken_depth_is_refused(tmp_path):
    with pytest.raises(DatasetError, match="positive up or down"):
        OPEN.with_depth(grid(RAMP, LAT, LON, "q"))
    with pytest.raises(DatasetError, match="unit"):
        OPEN.with_depth(grid(RAMP, LAT, LON, "depth", units="degC"))
    two = xr.Dataset({"depth": grid(RAMP, LAT, LON), "elevation": grid(RAMP, LAT, LON)})
    with pytest.raises(DatasetError, match="depth, elevation"):
        OPEN.with_depth(two)
    assert OPEN.with_depth(two, variable="depth").has_depth
    with pytest.raises(DatasetError, match="as the sea"):
        OPEN.with_depth(xr.Dataset({"a": ("t", [1.0, 2.0])}))
    broken = tmp_path / "broken.nc"
    broken.write_bytes(b"CDF\x01 nonsense")
    with pytest.raises(DatasetError, match="truncated or damaged"):
        OPEN.with_depth(broken)
    broken.write_text("lat,lon,depth")
    with pytest.raises(DatasetError, match="is not in a known format"):
        OPEN.with_depth(broken)
    with pytest.raises(InputError, match="There is no file"):
        OPEN.with_depth(tmp_path / "depths.nc")
    with pytest.raises(InputError, match="'up' or 'down'"):
        OPEN.with_depth(grid(RAMP, LAT, LON), positive="sideways")
    with pytest.raises(InputError, match="xarray"):
        OPEN.with_depth(12.0)


def test_a_cut_file_of_depth_is_refused(tmp_path):
    """The NetCDF library reads the missing end of a classic file as zeros."""
    path = tmp_path / "depth.nc"
    grid(RAMP, LAT, LON, "depth").to_netcdf(path, format="NETCDF3_CLASSIC")
    assert OPEN.with_depth(path).depths.at(51.0, 3.0) == pytest.approx(30.0)
    path.write_bytes(path.read_bytes()[:-800])
    with pytest.raises(DatasetError, match="incomplete"):
        OPEN.with_depth(path)


def test_missing_values_that_are_not_marked_are_not_deep_water():
    elevation = -RAMP.copy()
    elevation[5, 7] = -32768.0
    chart = OPEN.with_depth(grid(elevation, LAT, LON))
    with pytest.raises(DatasetError, match="reaches 32768 m"):
        chart.depths.at(50.5, 2.7)
    with pytest.raises(DatasetError, match="missing values that are not marked"):
        chart.depths.along(50.5, 2.2, 50.5, 3.0)


@pytest.mark.parametrize("fill", [9999.0, 999.0, 9999.9])
def test_common_fill_values_that_are_not_marked_are_refused(fill):
    values = RAMP.copy()
    values[5:8, 5:8] = fill
    with pytest.raises(DatasetError, match="seems to stand for missing values"):
        OPEN.with_depth(grid(values, LAT, LON, "depth")).depths.at(51.0, 3.0)
    with pytest.raises(DatasetError, match="seems to stand for missing values"):
        OPEN.with_depth(grid(-values, LAT, LON, "elevation")).depths.at(51.0, 3.0)


def test_a_slope_through_999_metres_is_read():
    slope = np.round(np.linspace(900.0, 1100.0, RAMP.size)).reshape(RAMP.shape)
    assert float(
        OPEN.with_depth(grid(slope, LAT, LON, "depth")).depths.at(51.0, 3.0)
    ) == pytest.approx(1000.0)


def test_real_grids_have_the_depths_of_the_sea():
    chart = OPEN.with_depth(data_file("bathymetry/gebco2020_oresund_15s.nc"))
    with xr.open_dataset(data_file("bathymetry/gebco2020_oresund_15s.nc")) as data:
        cell = data.elevation.isel(lat=100, lon=80)
        assert chart.depths.at(float(cell.lat), float(cell.lon)) == pytest.approx(-float(cell))
    wide = chart.with_depth(data_file("bathymetry/etopo1_bed_0p1deg_global.nc"))
    assert wide.depths.at(0.0, -30.0) == pytest.approx(3825.0)
    assert wide.depths.at(float(cell.lat), float(cell.lon)) == pytest.approx(-float(cell))
    ocean = wide.depths.along(45.0, -30.0, 45.0, -20.0)
    assert 1000.0 < ocean < 5000.0


def test_a_long_leg_over_a_gap_in_the_soundings_is_unknown():
    lon = np.arange(-20.0, 20.01, 0.5)
    values = np.full((len(LAT), len(lon)), 30.0)
    values[:, (lon > -1.0) & (lon < 1.0)] = np.nan
    chart = OPEN.with_depth(grid(values, LAT, lon, "depth"))
    assert np.isnan(chart.depths.along(51.0, -15.0, 51.0, 15.0))
    assert chart.depths.along(51.0, -15.0, 51.0, -5.0) == 30.0


def test_a_leg_that_clips_the_corner_of_a_shallow_cell_is_shallow():
    """The least depth of a leg is the least of those of its parts, for any division."""
    lat = lon = np.arange(0.0, 1.01, 0.1)
    rng = np.random.default_rng(3)
    for _ in range(20):
        grid = xr.DataArray(
            np.where(rng.random((11, 11)) < 0.06, 4.0, 30.0),
            coords={"lat": lat, "lon": lon},
            dims=("lat", "lon"),
            name="depth",
            attrs={"units": "m", "positive": "down"},
        )
        chart = Chart.open_water(-1, 2, -1, 2).with_depth(grid)
        ends = rng.uniform(0.05, 0.95, (4, 40))
        whole = chart.depths.along(*ends)
        cuts = np.linspace(0.0, 1.0, 201)[:, None]
        points_lat = ends[0] + cuts * (ends[2] - ends[0])
        points_lon = ends[1] + cuts * (ends[3] - ends[1])
        fine = chart.depths.along(points_lat[:-1], points_lon[:-1], points_lat[1:], points_lon[1:])
        assert np.all(whole <= np.nanmin(fine, axis=0) + 1e-6)
