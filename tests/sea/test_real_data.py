"""Real files, spot-checked against the plain file read with xarray."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests.conftest import data_file
from tests.sea.small_datasets import EAST, HS, NORTH, value
from thalweg.core.errors import DatasetError
from thalweg.core.time import parse_time
from thalweg.sea import Sea

TP = "sea_surface_wave_period_at_variance_spectral_density_maximum"
LEVEL = "sea_surface_height_above_geopotential_datum"
DEPTH = "sea_floor_depth_below_geoid"
WAVES_FROM = "sea_surface_wave_from_direction"


def at(step) -> float:
    """Seconds since the epoch of an xarray time."""
    return float(step.values.astype("datetime64[ns]").astype(np.int64)) / 1e9


def test_era5_waves() -> None:
    path = data_file("metocean/era5_waves_northsea_hourly_20171027_29.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    t, y, x = 30, 4, 9
    spot = raw.isel(time=t, latitude=y, longitude=x)
    got = sea.sample(
        [HS, TP, WAVES_FROM], at(spot.time), float(spot.latitude), float(spot.longitude)
    )
    assert got[HS] == pytest.approx(float(spot.swh))
    assert got[TP] == pytest.approx(float(spot.pp1d))
    assert got[WAVES_FROM] == pytest.approx(float(spot.mwd))
    cell = raw.swh[30:32, 4:6, 9:11]
    middle = value(
        sea,
        HS,
        at(raw.time[30]) + 1800.0,
        float(cell.latitude.mean()),
        float(cell.longitude.mean()),
    )
    assert middle == pytest.approx(float(cell.mean()))
    assert float(raw.swh.max()) == pytest.approx(8.4, abs=0.05)


def test_cmems_days_join_and_agree_with_the_second_file() -> None:
    paths = [data_file(f"metocean/cmems_mfwam_waves_northsea_201710{d}_3h.nc") for d in (28, 29)]
    sea = Sea.open(*paths)
    assert len(sea.layers) == 1
    raw = xr.open_dataset(paths[1])
    spot = raw.isel(time=2, latitude=15, longitude=22)
    where = float(spot.latitude), float(spot.longitude)
    assert value(sea, HS, at(spot.time), *where) == pytest.approx(float(spot.VHM0), rel=1e-6)
    assert value(sea, WAVES_FROM, at(spot.time), *where) == pytest.approx(
        float(spot.VMDR), rel=1e-6
    )
    between = value(sea, HS, parse_time("2017-10-28T22:30Z"), *where)
    first = xr.open_dataset(paths[0]).VHM0[-1, 15, 22]
    assert between == pytest.approx(0.5 * (float(first) + float(raw.VHM0[0, 15, 22])), rel=1e-6)
    land = sea.sample([HS], at(spot.time), 52.2, 6.0)[HS]
    assert np.isnan(land)
    assert sea.why_missing(HS, at(spot.time), 52.2, 6.0) == "gap"


def test_herwart_storm_on_a_mesh() -> None:
    path = data_file("metocean/northsea_storm_herwart_20171027_29_dhi_ugrid.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    faces = raw.mesh2d_face_nodes.values.astype(int)
    lat = raw.mesh2d_node_lat.values[faces].mean(axis=1)
    lon = raw.mesh2d_node_lon.values[faces].mean(axis=1)
    step = raw.isel(time=18)
    got = sea.sample(
        [HS, TP, WAVES_FROM, LEVEL, EAST, NORTH, "wind_speed", "wind_from_direction"],
        at(step.time),
        lat,
        lon,
    )
    for name, plain in (
        (HS, "swh"),
        (TP, "pp1d"),
        (LEVEL, "zeta"),
        (EAST, "ucur"),
        (NORTH, "vcur"),
        ("wind_speed", "wspd"),
    ):
        assert got[name] == pytest.approx(step[plain].values, rel=1e-5, abs=1e-5, nan_ok=True), name
    for name, plain in ((WAVES_FROM, "mwd"), ("wind_from_direction", "wdir")):
        turn = (got[name] - step[plain].values + 180.0) % 360.0 - 180.0
        assert np.nanmax(np.abs(turn)) < 1e-2
    assert np.nanmax(got[HS]) > 6.0
    nodes = sea.sample([DEPTH], 0.0, raw.mesh2d_node_lat.values, raw.mesh2d_node_lon.values)[DEPTH]
    assert nodes == pytest.approx(-raw.mesh2d_node_z.values, abs=1e-4)
    network = sea.mesh()
    assert network is not None
    assert (network.lat.size, len(network.triangles)) == (570, 958)


def test_hourly_level_with_wind_speed_only() -> None:
    sea = Sea.open(data_file("metocean/northsea_waterlevel_wind_hourly_20171027_29_dhi_ugrid.nc"))
    assert "eastward_wind" not in sea.variables
    got = sea.sample([LEVEL, "wind_speed"], parse_time("2017-10-29T03:00Z"), 53.0, 3.5)
    assert -3.0 < got[LEVEL] < 4.0
    assert 5.0 < got["wind_speed"] < 30.0
    assert sea.layers[1].axis.step == 3600.0


@pytest.mark.slow
def test_oresund_in_utm_with_velocities_rotated_by_the_meridian_convergence() -> None:
    path = data_file("metocean/oresund_hd_daily_20180307_11_dhi_ugrid.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    from pyproj import Proj, Transformer

    faces = raw.mesh2d_face_nodes.values.astype(int)
    x, y = (raw[f"mesh2d_node_{k}"].values[faces].mean(axis=1) for k in "xy")
    lon, lat = Transformer.from_crs(32633, 4326, always_xy=True).transform(x, y)
    step = raw.isel(time=2)
    got = sea.sample([EAST, NORTH, LEVEL], at(step.time), lat, lon)
    close = np.hypot(*(raw[f"mesh2d_face_{k}"].values - v for k, v in (("x", x), ("y", y)))) < 1.0
    assert close.mean() > 0.9
    turn = np.radians(
        [Proj(32633).get_factors(o, a).meridian_convergence for o, a in zip(lon, lat)]
    )
    # the convergence is the angle of grid north east of true north
    u, v = step.ucur.values, step.vcur.values
    east, north = u * np.cos(turn) - v * np.sin(-turn), u * np.sin(-turn) + v * np.cos(turn)
    assert np.nanmax(np.abs(np.hypot(got[EAST], got[NORTH]) - np.hypot(u, v))) < 0.01
    assert np.nanmedian(np.abs(got[EAST] - east)) < 2e-3
    assert np.nanmedian(np.abs(got[NORTH] - north)) < 2e-3
    assert np.nanmedian(np.abs(turn)) > np.radians(1.0)
    assert got[LEVEL] == pytest.approx(step.zeta.values, abs=2e-2, nan_ok=True)


def test_arctic_components_are_rotated_from_the_polar_grid() -> None:
    path = data_file("metocean/metno_arctic20km_surface_current_ice_20160201_05.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=1, Y=20, X=40)
    where = float(spot.latitude), float(spot.longitude)
    got = sea.sample([EAST, NORTH, "sea_ice_area_fraction", LEVEL, DEPTH], at(spot.time), *where)
    # grid y points from the pole along the meridian 58E: the x axis is turned by lon - 58
    turn = np.radians(where[1] - 58.0)
    u, v = float(spot.u), float(spot.v)
    assert got[EAST] == pytest.approx(u * np.cos(turn) + v * np.sin(turn), abs=2e-3)
    assert got[NORTH] == pytest.approx(-u * np.sin(turn) + v * np.cos(turn), abs=2e-3)
    assert got["sea_ice_area_fraction"] == pytest.approx(float(spot.aice), abs=1e-6)
    assert got[LEVEL] == pytest.approx(float(spot.zeta), abs=1e-6)
    assert got[DEPTH] == pytest.approx(float(spot.h), rel=1e-6)


def test_arome_wind_is_rotated_from_the_lambert_grid() -> None:
    path = data_file("metocean/metno_arome_wind_20160114_lambert.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=1, y=70, x=60)
    lat, lon = float(spot.latitude), float(spot.longitude)
    got = sea.sample(["eastward_wind", "northward_wind"], at(spot.time), lat, lon)
    turn = np.sin(np.radians(63.0)) * np.radians(lon - 15.0)  # cone constant times longitude
    u, v = float(spot.x_wind_10m), float(spot.y_wind_10m)
    assert got["eastward_wind"] == pytest.approx(u * np.cos(turn) + v * np.sin(turn), abs=0.02)
    assert got["northward_wind"] == pytest.approx(-u * np.sin(turn) + v * np.cos(turn), abs=0.02)


def test_nemo_currents_at_centres() -> None:
    path = data_file("metocean/nemo_orca025_northsea_surface_5day_jan2000.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    j, i = 60, 50
    lat, lon = float(raw.gphit[j, i]), float(raw.glamt[j, i])
    u = float(raw.uos[2, j, i - 1 : i + 1].mean())
    v = float(raw.vos[2, j - 1 : j + 1, i].mean())
    got = sea.sample([EAST, NORTH], at(raw.time[2]), lat, lon)
    east = np.cos(np.radians(lat)) * float(raw.glamt[j, i + 1] - raw.glamt[j, i - 1])
    turn = np.arctan2(float(raw.gphit[j, i + 1] - raw.gphit[j, i - 1]), east)
    assert abs(turn) > 0.001
    assert got[EAST] == pytest.approx(u * np.cos(turn) - v * np.sin(turn), abs=1e-4)
    assert got[NORTH] == pytest.approx(u * np.sin(turn) + v * np.cos(turn), abs=1e-4)


@pytest.mark.slow
def test_met_norway_grib_has_height_and_a_direction_that_must_be_mapped() -> None:
    pytest.importorskip("cfgrib")
    path = data_file("metocean/metno_mywavewam_northsea_20191106_09_hourly.grb")
    sea = Sea.open(path)
    assert sea.variables == {HS}
    reasons = {v: r for _, v, r in sea.describe().ignored}
    assert "from or to is not stated" in reasons["p107"]
    time = parse_time("2019-11-08T00:00Z")
    grid = np.meshgrid(np.arange(58.5, 62.1, 0.25), np.arange(-2.0, 6.1, 0.25))
    heights = value(sea, HS, time, *grid)
    assert np.nanmin(heights) >= 0.08
    assert np.nanmax(heights) <= 3.3
    assert np.isnan(heights).any()
    mapped = Sea.open(path, mapping={WAVES_FROM: "p107"})
    assert {HS, "sea_surface_wave_to_direction_east"} <= mapped.variables


def test_blizzard_wind_and_pressure() -> None:
    path = data_file("metocean/noaa_ngm_blizzard_1996_wind_msl_6h.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=18, lat=18, lon=32)
    got = sea.sample(
        ["eastward_wind", "northward_wind", "air_pressure_at_mean_sea_level"],
        at(spot.time),
        float(spot.lat),
        float(spot.lon),
    )
    assert [float(v) for v in got.values()] == pytest.approx(
        [float(spot.u10), float(spot.v10), float(spot.msl)], rel=1e-5
    )


def test_agulhas_current_and_land() -> None:
    path = data_file("metocean/globcurrent_agulhas_2002_daily.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=100, lat=20, lon=50)
    assert value(sea, EAST, at(spot.time), float(spot.lat), float(spot.lon)) == pytest.approx(
        float(spot.uo), rel=1e-5
    )
    assert np.isnan(value(sea, EAST, at(spot.time), -31.0, 22.0))
    assert sea.why_missing(EAST, at(spot.time), -31.0, 22.0) == "gap"


def test_gfs_wind_without_unit_attributes() -> None:
    path = data_file("metocean/gfs_wind_med_20210902_3h.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=1, lat=20, lon=10)
    assert value(
        sea, "eastward_wind", at(spot.time), float(spot.lat), float(spot.lon)
    ) == pytest.approx(float(spot.ugrd10m))


def test_wrt_layout_uses_wind_at_ten_metres_and_surface_currents() -> None:
    path = data_file("metocean/wrt_weather_gfs_cmems_baltic_20230720_21.nc")
    raw, sea = xr.open_dataset(path), Sea.open(path)
    spot = raw.isel(time=3, latitude=5, longitude=5)
    where = at(spot.time), float(spot.latitude), float(spot.longitude)
    wind = spot["u-component_of_wind_height_above_ground"].sel(height_above_ground=10.0)
    assert value(sea, "eastward_wind", *where) == pytest.approx(float(wind), rel=1e-6)
    current = float(spot.utotal.isel(depth=0))
    assert value(sea, EAST, *where) == pytest.approx(current, rel=1e-6, nan_ok=True)
    assert value(sea, HS, *where) == pytest.approx(float(spot.VHM0), rel=1e-6, nan_ok=True)


def test_bathymetries_are_positive_down() -> None:
    sea = Sea.open(data_file("bathymetry/gebco2020_oresund_15s.nc"))
    raw = xr.open_dataset(data_file("bathymetry/gebco2020_oresund_15s.nc"))
    assert value(sea, DEPTH, 0.0, float(raw.lat[100]), float(raw.lon[60])) == -float(
        raw.elevation[100, 60]
    )
    etopo = Sea.open(data_file("bathymetry/etopo1_bed_0p5deg_global.nc"))
    assert value(etopo, DEPTH, 0.0, 40.0, [-40.0, 320.0, 180.0, -180.0]).min() > 3000.0
    wrt = Sea.open(data_file("bathymetry/wrt_etopo_30s_southern_northsea.nc"))
    assert 10.0 < value(wrt, DEPTH, 0.0, 52.0, 2.7) < 80.0


def test_san_diego_tide_needs_a_projection_and_names() -> None:
    path = data_file("tide/adh_sandiego_waterlevel_ugrid_30min.nc")
    with pytest.raises(DatasetError, match="projection"):
        Sea.open(path)
    mapping = {
        "crs": "EPSG:32611",
        "bed_level": "elevation",
        "sea_floor_depth_below_sea_surface": "depth",
    }
    sea = Sea.open(path, mapping=mapping)
    raw = xr.open_dataset(path)
    network = sea.mesh()
    assert network is not None
    wet = int(np.argmax(raw.depth.values[0]))
    where = at(raw.time[5]), network.lat[wet], network.lon[wet]
    got = sea.sample([DEPTH, LEVEL], *where)
    assert got[DEPTH] == pytest.approx(-float(raw.elevation[wet]), abs=1e-4)
    assert got[LEVEL] == pytest.approx(float(raw.depth[5, wet] + raw.elevation[wet]), abs=1e-4)
    assert 32.0 < where[1] < 33.5
    assert -118.0 < where[2] < -116.5


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("metocean/buoy_HKNA_Hm0_20171026_29.nc", "no positions"),
        ("metocean/coads_climatology_wind_2deg_monthly.nc", "climatology"),
        ("metocean/dhi_model_points_storm_20171027_29.csv", "is not in a known format"),
        ("metocean/nora10_point_1958_3h.txt.gz", "is compressed .gzip"),
        ("metocean/norkystda_point_current_hourly.csv.gz", "is compressed .gzip"),
        ("tide/dhi_vanuatu_tidal_current_line_hourly_202108.nc", "no positions"),
    ],
)
def test_files_without_fields_give_the_reason(name, why) -> None:
    with pytest.raises(DatasetError, match=why) as caught:
        Sea.open(data_file(name))
    assert caught.value.possible
    assert caught.value.remedy


def test_herwart_over_era5_by_priority() -> None:
    mesh = Sea.open(data_file("metocean/northsea_storm_herwart_20171027_29_dhi_ugrid.nc"))
    era5 = Sea.open(data_file("metocean/era5_waves_northsea_hourly_20171027_29.nc"))
    both = mesh + era5
    time = parse_time("2017-10-29T06:00Z")
    lat, lon = np.array([53.5, 50.2]), np.array([4.0, -0.8])
    nested, coarse = (s.sample([HS], time, lat, lon)[HS] for s in (mesh, era5))
    assert np.isnan(nested).tolist() == [False, True]
    assert both.sample([HS], time, lat, lon)[HS] == pytest.approx(
        [nested[0], coarse[1]], nan_ok=True
    )


@pytest.mark.slow
def test_inspection_and_map_of_a_real_file(tmp_path) -> None:
    sea = Sea.open(data_file("metocean/northsea_storm_herwart_20171027_29_dhi_ugrid.nc"))
    report = sea.describe().as_dict()
    rows = {r["variable"]: r for r in report["recognised"]}
    assert rows[HS]["file_variables"] == ("swh",)
    assert "direction from to components" in rows["eastward_wind"]["how"]
    wave = next(c for c in report["coverage"] if c["variable"] == HS)
    assert (wave["start"], wave["end"], wave["step_s"]) == (
        "2017-10-27T00:00:00Z",
        "2017-10-29T18:00:00Z",
        10800.0,
    )
    sea.draw(tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
