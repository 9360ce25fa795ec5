"""Files of every layout: exact for an affine field, unknown where the data are unknown."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from xarray.backends import BackendArray
from xarray.core import indexing

from tests.sea.small_datasets import EAST, HS, NORTH, T0, affine, axis, clock, mesh, regular, value
from thalweg.core.errors import DatasetError
from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.sea.grids.triangle_grid import TriangleGrid

HOUR = 3600.0


@pytest.mark.parametrize("format_", ["NETCDF3_CLASSIC", "NETCDF3_64BIT", "NETCDF4"])
def test_linear_in_every_axis_of_every_netcdf(tmp_path, format_) -> None:
    path = tmp_path / "waves.nc"
    regular().to_netcdf(path, format=format_)
    sea = Sea.open(path)
    time, lat, lon = (
        T0 + np.array([0.0, 0.4, 2.2, 3.0]) * HOUR,
        [10.0, 11.3, 12.9, 13.0],
        [20, 20.6, 21.5, 22],
    )
    assert value(sea, HS, time, lat, lon) == pytest.approx(affine(time, lat, lon), rel=1e-12)


@given(hour=st.floats(0.0, 3.0), lat=st.floats(10.0, 13.0), lon=st.floats(20.0, 22.0))
def test_affine_field_is_reproduced_everywhere(hour, lat, lon) -> None:
    sea = _SEAS.setdefault("affine", Sea.open(regular()))
    got = value(sea, HS, T0 + hour * HOUR, lat, lon)
    assert got == pytest.approx(affine(T0 + hour * HOUR, lat, lon), rel=1e-10)


_SEAS: dict[str, Sea] = {}


def test_unknown_outside_with_the_reason() -> None:
    sea = Sea.open(regular())
    for time, lat, lon, why in (
        (T0, 9.9, 21.0, "area"),
        (T0, 11.0, 22.1, "area"),
        (T0 - 1.0, 11.0, 21.0, "period"),
        (T0 + 3.1 * HOUR, 11.0, 21.0, "period"),
    ):
        assert np.isnan(value(sea, HS, time, lat, lon))
        assert sea.why_missing(HS, time, lat, lon) == why
    assert sea.why_missing("wind_speed", T0, 11.0, 21.0) == "variable"


def test_descending_latitudes_and_longitudes() -> None:
    dataset = regular().isel(lat=slice(None, None, -1), lon=slice(None, None, -1))
    sea = Sea.open(dataset)
    assert value(sea, HS, T0, 11.3, 20.7) == pytest.approx(affine(T0, 11.3, 20.7))


@pytest.mark.parametrize("first", [0.0, -180.0, -170.0])
def test_global_grids_wrap_across_their_seam(first) -> None:
    lon = first + np.arange(0.0, 360.0, 10.0)

    def field(t, lat, lon):
        return 10.0 + 5.0 * np.cos(np.radians(lon)) + 0.0 * t + 0.0 * lat

    sea = Sea.open(regular(lon=lon, field=field))
    assert sea.coverage()[0].east - sea.coverage()[0].west == 360.0
    for x in (-180.0, 180.0, 175.0, -175.0, 0.0, 359.0, -5.0, 5.0):
        low = np.floor(x / 10.0) * 10.0
        f = (x - low) / 10.0
        expected = (1 - f) * field(0, 0, low) + f * field(0, 0, low + 10.0)
        assert value(sea, HS, T0, 11.0, x) == pytest.approx(expected)
    frozen = sea.freeze_stations(
        [11.0, 11.0], [-179.0, 179.0], T0, T0 + HOUR, [codes.WAVE_HEIGHT_CHANNEL]
    )
    assert frozen.values[:, 0, 0] == pytest.approx(
        [5.0 + 0.1 * 5 * (1 - np.cos(np.radians(10)))] * 2, rel=1e-3
    )


def test_a_regional_grid_over_the_dateline() -> None:
    dataset = regular(
        lon=[178.0, 179.0, -180.0, -179.0], field=lambda t, y, x: y + abs(x) + 0 * t - 170
    )
    sea, field = Sea.open(dataset), dataset.swh.values[0, 1]
    assert value(sea, HS, T0, 11.0, 179.5) == pytest.approx(0.5 * (field[1] + field[2]))
    assert value(sea, HS, T0, 11.0, -179.5) == pytest.approx(0.5 * (field[2] + field[3]))
    assert np.isnan(value(sea, HS, T0, 11.0, 177.9))


@pytest.mark.parametrize("step", [1, -1])
def test_a_box_over_greenwich_with_its_east_first(tmp_path, step) -> None:
    """0 to 3 and then 355 to 359 degrees, as a box cut from a file of 0 to 360 degrees holds."""
    lon = [0.0, 1.0, 2.0, 3.0, 355.0, 356.0, 357.0, 358.0, 359.0][::step]
    dataset = regular(lon=lon, field=lambda t, y, x: 5.0 + (x + 180.0) % 360.0 / 100.0 + 0 * t + y)
    dataset.to_netcdf(tmp_path / "box.nc")
    sea = Sea.open(tmp_path / "box.nc")
    (box,) = sea.coverage()
    assert (box.west % 360.0, box.east % 360.0) == (355.0, 3.0)
    for x in (-5.0, -4.5, -0.5, 0.0, 2.5, 3.0):
        assert value(sea, HS, T0, 11.0, x) == pytest.approx(5.0 + (x + 180.0) / 100.0 + 11.0)
    assert np.isnan(value(sea, HS, T0, 11.0, 3.5))


def test_two_boxes_that_do_not_meet_are_not_one_grid() -> None:
    with pytest.raises(DatasetError, match="neither increases nor decreases"):
        Sea.open(regular(lon=[0.0, 1.0, 2.0, 300.0, 301.0, 302.0]))


def test_nan_corner_with_weight_makes_nan_and_without_weight_does_not() -> None:
    dataset = regular()
    dataset.swh[:, 1, 1] = np.nan
    sea = Sea.open(dataset)
    assert np.isnan(value(sea, HS, T0, 10.999, 20.999))
    assert np.isnan(value(sea, HS, T0, 11.0, 21.0))
    assert value(sea, HS, T0, 11.0, 20.0) == pytest.approx(affine(T0, 11.0, 20.0))
    assert value(sea, HS, T0, 10.0, 20.5) == pytest.approx(affine(T0, 10.0, 20.5))
    assert sea.why_missing(HS, T0, 11.0, 21.0) == "gap"


def test_a_missing_time_is_unknown_only_between_its_neighbours() -> None:
    dataset = regular(hours=[0.0, 1.0, 2.0, 3.0])
    dataset.swh[1] = np.nan
    sea = Sea.open(dataset)
    got = value(sea, HS, T0 + np.array([0.0, 0.5, 1.0, 1.5, 2.0]) * HOUR, 11.0, 21.0)
    assert np.isnan(got).tolist() == [False, True, True, True, False]


def test_packed_integers_and_fill_values(tmp_path) -> None:
    dataset = regular()
    dataset.swh[0, 0, 0] = np.nan
    path = tmp_path / "packed.nc"
    packing = {"dtype": "int16", "scale_factor": 0.001, "add_offset": 5.0, "_FillValue": -32768}
    dataset.to_netcdf(path, encoding={"swh": packing})
    sea = Sea.open(path)
    assert np.isnan(value(sea, HS, T0, 10.0, 20.0))
    assert value(sea, HS, T0, 12.5, 21.5) == pytest.approx(affine(T0, 12.5, 21.5), abs=6e-4)


def test_directions_cross_north_as_vectors() -> None:
    dataset = regular(
        fields={
            "mwd": {"standard_name": "sea_surface_wave_from_direction", "units": "degree"},
            "wspd": {"standard_name": "wind_speed", "units": "m s-1"},
            "wdir": {"standard_name": "wind_from_direction", "units": "degree"},
        },
        field=lambda t, lat, lon: np.where(lon < 21.0, 350.0, 10.0) + 0.0 * (t + lat),
    )
    dataset["wspd"] = (("time", "lat", "lon"), np.full(dataset.mwd.shape, 10.0), dataset.wspd.attrs)
    sea = Sea.open(dataset)
    got = sea.sample(
        ["sea_surface_wave_from_direction", "wind_from_direction", "wind_speed"], T0, 11.0, 20.5
    )
    assert (
        min(got["sea_surface_wave_from_direction"], 360 - got["sea_surface_wave_from_direction"])
        < 1e-9
    )
    assert min(got["wind_from_direction"], 360 - got["wind_from_direction"]) < 1e-9
    assert got["wind_speed"] == pytest.approx(10.0 * np.cos(np.radians(10.0)))


def test_components_of_a_vector_are_unknown_together() -> None:
    dataset = regular(
        fields={"uo": {"units": "m/s"}, "vo": {"units": "m/s"}},
        field=lambda t, y, x: 0.1 * x + 0 * (t + y) - 1,
    )
    dataset.uo[:, 0, 0] = np.nan
    got = Sea.open(dataset).sample([EAST, NORTH], T0, 10.0, [20.0, 21.0])
    assert np.isnan(got[NORTH]).tolist() == [True, False]


@pytest.mark.parametrize(
    ("units", "factor"),
    [
        ("m s-1", 1.0),
        ("knots", 1852 / 3600),
        ("cm/s", 0.01),
        ("km/h", 1 / 3.6),
        ("m s**-1", 1.0),
        ("M/S", 1.0),
    ],
)
def test_units_of_speed(units, factor) -> None:
    dataset = regular(
        fields={"uo": {"units": units}, "vo": {"units": units}},
        field=lambda t, y, x: 2.0 + 0 * (t + y + x),
    )
    assert value(Sea.open(dataset), EAST, T0, 11.0, 21.0) == pytest.approx(2.0 * factor)


def test_pressure_and_direction_units() -> None:
    dataset = regular(
        fields={"msl": {"units": "hPa"}}, field=lambda t, y, x: 1000.0 + 0 * (t + y + x)
    )
    assert value(
        Sea.open(dataset), "air_pressure_at_mean_sea_level", T0, 11.0, 21.0
    ) == pytest.approx(1e5)
    radians = regular(
        fields={"mwd": {"units": "radians"}}, field=lambda t, y, x: np.pi / 2 + 0 * (t + y + x)
    )
    got = value(Sea.open(radians), "sea_surface_wave_to_direction", T0, 11.0, 21.0)
    assert got == pytest.approx(270.0)


def rotated_grid(angle: float, fields: dict, *, values=None) -> xr.Dataset:
    """Return a small curvilinear grid turned by an angle [deg] about 0N 0E."""
    i, j = np.meshgrid(np.arange(-4, 5) * 0.1, np.arange(-3, 4) * 0.1)
    a = np.radians(angle)
    lon, lat = i * np.cos(a) - j * np.sin(a), i * np.sin(a) + j * np.cos(a)
    time = clock([0.0, 1.0])
    data = {
        n: (
            ("time", "y", "x"),
            np.broadcast_to(f(time.values[:, None, None], lat, lon), (2, *lat.shape)).copy(),
            attrs,
        )
        for n, (f, attrs) in fields.items()
    }
    return xr.Dataset(
        data,
        coords={
            "time": time,
            "lat": (("y", "x"), lat, {"standard_name": "latitude"}),
            "lon": (("y", "x"), lon, {"standard_name": "longitude"}),
        },
    )


def test_curvilinear_grid_is_exact_for_affine_and_unknown_outside() -> None:
    sea = Sea.open(rotated_grid(33.0, {"swh": (affine, {"units": "m"})}))
    lat, lon = np.array([0.03, -0.11, 0.2]), np.array([0.05, 0.17, -0.04])
    time = T0 + 0.25 * HOUR
    assert value(sea, HS, time, lat, lon) == pytest.approx(affine(time, lat, lon), rel=1e-9)
    assert np.isnan(value(sea, HS, time, 0.45, -0.4))
    assert sea.why_missing(HS, time, 0.45, 0.45) == "area"


@pytest.mark.parametrize("angle", [0.0, 33.0, 120.0, -75.0])
def test_components_along_a_rotated_grid_become_east_and_north(angle) -> None:
    def one(t, lat, lon):
        return np.ones_like(lat) + 0 * t

    def none(t, lat, lon):
        return np.zeros_like(lat) + 0 * t

    sea = Sea.open(
        rotated_grid(
            angle, {"x_wind_10m": (one, {"units": "m/s"}), "y_wind_10m": (none, {"units": "m/s"})}
        )
    )
    got = sea.sample(["eastward_wind", "northward_wind"], T0, 0.0, 0.0)
    assert got["eastward_wind"] == pytest.approx(np.cos(np.radians(angle)), abs=2e-5)
    assert got["northward_wind"] == pytest.approx(np.sin(np.radians(angle)), abs=2e-5)
    true = rotated_grid(
        angle,
        {
            "u": (one, {"units": "m/s", "standard_name": "eastward_wind"}),
            "v": (none, {"units": "m/s", "standard_name": "northward_wind"}),
        },
    )
    assert Sea.open(true).sample(["eastward_wind"], T0, 0.0, 0.0)["eastward_wind"] == pytest.approx(
        1.0
    )


def _unit_along_x(name: str, **attributes) -> dict:
    def one(t, lat, lon):
        return np.ones_like(lat) + 0 * t

    def none(t, lat, lon):
        return np.zeros_like(lat) + 0 * t

    standard = {"x_wind": ("x_wind", "y_wind"), "eastward": ("eastward_wind", "northward_wind")}
    return {
        key: (make, {"units": "m/s", "standard_name": word, **attributes})
        for key, make, word in zip("uv", (one, none), standard[name])
    }


def test_components_along_a_decreasing_x_axis_are_reversed() -> None:
    """Columns run against the projected x axis along which components are given."""
    data = rotated_grid(30.0, _unit_along_x("x_wind"))
    x = np.arange(float(data.sizes["x"]))
    for sign in (1.0, -1.0):
        sea = Sea.open(data.assign_coords(x=("x", sign * x)))
        got = sea.sample(["eastward_wind", "northward_wind"], T0, 0.0, 0.0)
        assert got["eastward_wind"] == pytest.approx(sign * np.cos(np.radians(30.0)), abs=2e-5)
        assert got["northward_wind"] == pytest.approx(sign * np.sin(np.radians(30.0)), abs=2e-5)


def test_components_that_grib_gives_along_the_grid_are_rotated() -> None:
    for flag, east, north in ((1, np.cos(np.radians(30.0)), 0.5), (0, 1.0, 0.0)):
        data = rotated_grid(30.0, _unit_along_x("eastward", GRIB_uvRelativeToGrid=flag))
        got = Sea.open(data).sample(["eastward_wind", "northward_wind"], T0, 0.0, 0.0)
        assert got["eastward_wind"] == pytest.approx(east, abs=2e-5)
        assert got["northward_wind"] == pytest.approx(north, abs=2e-5)


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:3413", "EPSG:28992"])
def test_the_x_axis_of_a_projection_is_rotated_by_its_convergence(crs) -> None:
    from pyproj import Geod, Transformer

    from thalweg.sea.files.projections import meridian_angle

    back = Transformer.from_crs(4326, crs, always_xy=True)
    lat, lon = np.array([52.5, 55.5, 53.0]), np.array([4.5, 9.0, 6.5])
    x, y = (np.asarray(a) for a in back.transform(lon, lat))
    there = Transformer.from_crs(crs, 4326, always_xy=True).transform(x + 500.0, y)
    azimuth = Geod(ellps="WGS84").inv(lon, lat, *there)[0]
    turned = np.degrees(meridian_angle(crs, x, y)) - (90.0 - azimuth)
    assert (turned + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.2)


def test_grid_over_the_pole_and_over_the_dateline() -> None:
    x, y = np.meshgrid(np.linspace(-500e3, 500e3, 21), np.linspace(-400e3, 400e3, 17))
    for crs, positions in (
        ("EPSG:3413", [(90.0, 0.0), (89.0, 100.0), (88.0, -179.0)]),
        ("EPSG:32660", None),
    ):
        if positions is None:
            x, y = np.meshgrid(np.linspace(5e5, 9e5, 21), np.linspace(1e6, 1.2e6, 17))
            positions = [(9.9, 179.9), (9.9, -179.9), (9.9, 180.0)]
        from thalweg.sea.files.projections import to_degrees

        lat, lon = to_degrees(crs, x, y)
        dataset = xr.Dataset(
            {
                "hs": (
                    ("time", "y", "x"),
                    (2.0 + x / 1e6 + y / 3e6)[None],
                    {"standard_name": HS, "units": "m"},
                )
            },
            coords={"time": clock([0.0]), "lat": (("y", "x"), lat), "lon": (("y", "x"), lon)},
        )
        from pyproj import Transformer

        back = Transformer.from_crs(4326, crs, always_xy=True)
        for a, o in positions:
            px, py = back.transform(o, a)
            got = value(Sea.open(dataset), HS, T0, a, o)
            assert got == pytest.approx(2.0 + px / 1e6 + py / 3e6, abs=2e-3), (crs, a, o)


def test_projected_axes_with_a_grid_mapping_only() -> None:
    x, y = np.linspace(5e5, 5.4e5, 9), np.linspace(5.8e6, 5.83e6, 7)
    dataset = xr.Dataset(
        {
            "hs": (
                ("time", "y", "x"),
                np.broadcast_to(1.0 + (x - 5e5) / 1e4, (1, 7, 9)).copy(),
                {"standard_name": HS, "units": "m", "grid_mapping": "utm"},
            ),
            "utm": ((), 0, {"grid_mapping_name": "transverse_mercator", "epsg_code": "EPSG:32631"}),
        },
        coords={
            "time": clock([0.0]),
            "x": ("x", x, {"standard_name": "projection_x_coordinate", "units": "m"}),
            "y": ("y", y, {"standard_name": "projection_y_coordinate", "units": "m"}),
        },
    )
    from thalweg.sea.files.projections import to_degrees

    lat, lon = to_degrees("EPSG:32631", np.array([5.2e5]), np.array([5.81e6]))
    assert value(Sea.open(dataset), HS, T0, lat, lon) == pytest.approx(3.0, abs=1e-4)


@pytest.mark.parametrize("start_index", [0, 1])
@pytest.mark.parametrize("as_float", [False, True])
def test_mesh_with_node_data_is_exact_for_affine(tmp_path, start_index, as_float) -> None:
    path = tmp_path / "mesh.nc"
    mesh(start_index=start_index, as_float=as_float).to_netcdf(path)
    sea = Sea.open(path)
    lat, lon = np.array([50.2, 50.8, 50.3, 50.9]), np.array([2.7, 2.1, 4.0, 3.3])
    time = T0 + 0.5 * HOUR
    assert value(sea, HS, time, lat, lon) == pytest.approx(affine(time, lat, lon), rel=1e-12)
    assert np.isnan(value(sea, HS, time, 51.1, 2.5))
    assert sea.why_missing(HS, time, 51.1, 2.5) == "area"
    network = sea.mesh()
    assert network is not None
    assert network.lat.size == 6
    assert network.triangles.shape == (4, 3)


def test_mesh_with_face_data_keeps_the_value_at_each_centre_and_dry_faces_unknown() -> None:
    dataset = mesh(location="face")
    sea = Sea.open(dataset)
    lat, lon = np.array([50.5, (50 + 50 + 51.2) / 3]), np.array([2.5, (3 + 4.5 + 4) / 3])
    assert value(sea, HS, T0, lat, lon) == pytest.approx(affine(T0, lat, lon), rel=1e-9)
    faces = dataset.swh.values[0]
    inside = value(
        sea, HS, T0, *np.meshgrid(np.linspace(50.02, 50.98, 9), np.linspace(2.02, 2.98, 9))
    )
    assert np.nanmin(inside) >= faces.min() - 1e-12
    assert np.nanmax(inside) <= faces.max() + 1e-12
    dataset.swh[:, 0] = np.nan
    dry = Sea.open(dataset)
    assert np.isnan(value(dry, HS, T0, 50.5, 2.5))
    assert np.isnan(value(dry, HS, T0, 50.9, 2.2))
    assert value(dry, HS, T0, lat[1], lon[1]) == pytest.approx(faces[1])


def test_nodes_of_a_mesh_average_their_faces_by_inverse_distance() -> None:
    dataset = mesh(location="face")
    dataset.swh[:] = np.array([1.0, 3.0, 7.0])  # the quadrangle, triangles 1 2 5 and 1 5 4
    lat, lon = dataset.node_lat.values, dataset.node_lon.values
    far = []
    for face in ([0, 1, 4, 3], [1, 2, 5], [1, 5, 4]):
        north, east = lat[face].mean() - lat[1], lon[face].mean() - lon[1]
        far.append(np.hypot(north, east * np.cos(np.radians(lat[1]))))
    weight = 1.0 / np.array(far)
    expected = weight @ [1.0, 3.0, 7.0] / weight.sum()
    got = value(Sea.open(dataset), HS, T0, lat[1], lon[1])
    assert got == pytest.approx(expected, rel=1e-6)
    assert abs(expected - 11.0 / 3.0) > 0.1


def test_a_global_mesh_has_no_seam() -> None:
    """Two rings of nodes at 10 S and 10 N, on any turn of longitude."""
    lon = np.arange(0.0, 360.0, 30.0)
    n = lon.size
    here = np.arange(n)
    after = (here + 1) % n
    triangles = np.concatenate(
        [np.stack([here, after, n + here], 1), np.stack([after, n + after, n + here], 1)]
    )
    for first in (0.0, -180.0, 13.0):
        ring = (lon + first + 180.0) % 360.0 - 180.0
        grid = TriangleGrid(np.repeat([-10.0, 10.0], n), np.tile(ring, 2), triangles, (1, 2 * n))
        where = np.arange(-179.5, 540.0, 7.0)
        found = grid.locate(np.full(where.size, 3.0), where)
        assert (found.corner[:, 0] >= 0).all()
        turned = (np.tile(lon + first, 2)[found.corner] - where[:, None] + 180.0) % 360.0 - 180.0
        assert (turned * found.weight).sum(axis=1) == pytest.approx(0.0, abs=1e-9)
        north = np.repeat([-10.0, 10.0], n)[found.corner]
        assert (north * found.weight).sum(axis=1) == pytest.approx(3.0)


def test_mesh_across_the_dateline() -> None:
    dataset = mesh()
    lon = (dataset.node_lon + 176.7 + 180.0) % 360.0 - 180.0
    dataset["node_lon"] = ("node", lon.values, dataset.node_lon.attrs)
    sea = Sea.open(dataset)
    expected = affine(T0, 50.2, np.array([2.7, 3.6]))
    assert value(sea, HS, T0, 50.2, [179.4, -179.7]) == pytest.approx(expected, rel=1e-9)
    assert value(sea, HS, T0, 50.2, [179.4, 180.3]) == pytest.approx(expected, rel=1e-9)


def test_bed_level_total_depth_and_level_are_consistent() -> None:
    fields = {
        "bed": ({"standard_name": "altitude", "units": "m"}, -20.0),
        "level": (
            {"standard_name": "sea_surface_height_above_mean_sea_level", "units": "cm"},
            150.0,
        ),
    }
    dataset = regular()
    for name, (attrs, number) in fields.items():
        dataset[name] = (("time", "lat", "lon"), np.full(dataset.swh.shape, number), attrs)
    names = ["sea_floor_depth_below_geoid", "sea_surface_height_above_geopotential_datum"]
    got = Sea.open(dataset).sample(names, T0, 11.0, 21.0)
    assert [float(got[n]) for n in names] == pytest.approx([20.0, 1.5])
    total = dataset.drop_vars("bed")
    total["h"] = (
        ("time", "lat", "lon"),
        np.full(dataset.swh.shape, 21.5),
        {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m"},
    )
    got = Sea.open(total).sample(names, T0, 11.0, 21.0)
    assert [float(got[n]) for n in names] == pytest.approx([20.0, 1.5])
    no_level = total.drop_vars("level")
    no_level["bed"] = dataset["bed"].isel(time=0, drop=True)
    got = Sea.open(no_level).sample(names, T0, 11.0, 21.0)
    assert [float(got[n]) for n in names] == pytest.approx([20.0, 1.5])


def test_a_total_depth_without_its_level_is_ignored_with_the_reason() -> None:
    data = regular(
        fields={"h": {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m"}}
    )
    data["zeta"] = (
        xr.DataArray(
            np.zeros((3, 2)), dims=("time", "x"), attrs={"standard_name": "sea_surface_height"}
        )
        .expand_dims(y=2)
        .transpose("time", "y", "x")
    )
    data = data.assign_coords(
        y=axis([10.0, 11.0], "lat").rename(lat="y"), x=axis([20.0, 21.0], "lon").rename(lon="x")
    )
    sea = Sea.open(data)
    assert "sea_floor_depth_below_geoid" not in sea.variables
    reasons = {name: reason for _, name, reason in sea.describe().ignored}
    assert reasons["h"].startswith("the water level needed to convert it is not on its grid")


def test_static_fields_hold_at_all_times_and_single_times_at_that_time() -> None:
    dataset = regular(hours=[0.0])
    dataset["deptho"] = (("lat", "lon"), np.full((4, 3), 30.0), {"units": "m"})
    sea = Sea.open(dataset)
    assert value(sea, "sea_floor_depth_below_geoid", 0.0, 11.0, 21.0) == 30.0
    assert value(sea, HS, T0, 11.0, 21.0) == pytest.approx(affine(T0, 11.0, 21.0))
    assert np.isnan(value(sea, HS, T0 + 1.0, 11.0, 21.0))
    assert sea.why_missing(HS, T0 + 1.0, 11.0, 21.0) == "period"


def test_surface_level_and_ten_metres_are_selected() -> None:
    base = regular(
        fields={"uo": {"units": "m/s"}, "vo": {"units": "m/s"}},
        field=lambda t, y, x: 1.0 + 0 * (t + y + x),
    )
    deep = xr.concat(
        [base * 0.1, base],
        dim=xr.DataArray([50.0, 0.5], dims="depth", name="depth", attrs={"units": "m"}),
    )
    for name in ("uo", "vo"):
        deep[name].attrs = base[name].attrs
    assert value(Sea.open(deep), EAST, T0, 11.0, 21.0) == pytest.approx(1.0)


def test_files_that_follow_in_time_become_one_layer(tmp_path) -> None:
    regular(hours=[0.0, 1.0, 2.0]).to_netcdf(tmp_path / "a.nc")
    regular(hours=[3.0, 4.0]).to_netcdf(tmp_path / "b.nc")
    sea = Sea.open(tmp_path / "b.nc", tmp_path / "a.nc")
    assert len(sea.layers) == 1
    time = T0 + np.array([0.5, 2.5, 3.5]) * HOUR
    assert value(sea, HS, time, 11.0, 21.0) == pytest.approx(affine(time, 11.0, 21.0))
    assert sea.times(T0, T0 + 4 * HOUR).size == 5


def test_files_on_other_positions_are_not_joined() -> None:
    second = regular(lat=(14.0, 15.0, 16.0, 17.0), hours=[2.0, 3.0])
    sea = Sea.open(regular(hours=[0.0, 1.0]), second)
    assert len(sea.layers) == 2
    assert value(sea, HS, T0 + 2.5 * HOUR, 15.5, 21.0) == pytest.approx(
        affine(T0 + 2.5 * HOUR, 15.5, 21.0)
    )
    assert np.isnan(value(sea, HS, T0 + 2.5 * HOUR, 11.5, 21.0))


def test_the_fraction_of_points_without_a_value_is_reported() -> None:
    data = regular()
    data.swh[:, :2, :1] = np.nan  # 2 of 12 places
    (share,) = Sea.open(data).describe().missing.values()
    assert share == pytest.approx(2.0 / 12.0)


def test_files_of_one_layer_may_differ_in_units() -> None:
    first, second = regular(hours=[0.0, 1.0]), regular(hours=[2.0, 3.0])
    second["swh"] = second["swh"] * 100.0
    second["swh"].attrs = {"standard_name": HS, "units": "cm"}
    for files in ((first, second), (second, first)):
        sea = Sea.open(*files)
        assert len(sea.layers) == 1
        time = T0 + np.array([0.5, 1.5, 2.5]) * HOUR
        assert value(sea, HS, time, 11.0, 21.0) == pytest.approx(affine(time, 11.0, 21.0))


def test_gaps_in_time_stay_unknown_in_samples_and_in_frozen_fields() -> None:
    sea = Sea.open(regular(hours=[0.0, 1.0, 2.0, 9.0, 10.0, 11.0]))
    time = T0 + np.array([1.5, 2.0, 5.0, 9.0, 9.5]) * HOUR
    assert np.isnan(value(sea, HS, time, 11.0, 21.0)).tolist() == [False, False, True, False, False]
    fields = sea.freeze_stations([11.0], [21.0], T0, T0 + 11 * HOUR, [codes.WAVE_HEIGHT_CHANNEL])
    at = np.interp(T0 + 5 * HOUR, fields.times, fields.values[0, :, 0])
    assert np.isnan(at)
    gap = sea.describe().gaps[0]
    assert (gap.after, gap.before) == (T0 + 2 * HOUR, T0 + 9 * HOUR)


def test_nested_files_by_priority() -> None:
    coast = regular(lat=[10.0, 11.0], lon=[20.0, 21.0], field=lambda t, y, x: 5.0 + 0 * (t + y + x))
    ocean = regular(field=lambda t, y, x: 1.0 + 0 * (t + y + x))
    sea = Sea.open(coast, ocean)
    assert value(sea, HS, T0, [10.5, 12.0], [20.5, 20.5]).tolist() == [5.0, 1.0]
    assert value(Sea.open(ocean) + Sea.open(coast), HS, T0, 10.5, 20.5) == 1.0


def test_zarr(tmp_path) -> None:
    pytest.importorskip("zarr")
    path = tmp_path / "waves.zarr"
    regular().to_zarr(path, consolidated=False)
    sea = Sea.open(path)
    time = T0 + 2.2 * HOUR
    assert value(sea, HS, time, 12.9, 21.5) == pytest.approx(affine(time, 12.9, 21.5))
    assert sea.layers[0].source == "waves.zarr"


def test_frozen_stations_equal_samples_and_reach_one_step_beyond() -> None:
    sea = Sea.open(regular(hours=[0.0, 1.0, 2.0, 3.0, 4.0]))
    lat, lon = np.array([10.2, 12.7, 40.0]), np.array([20.3, 21.9, 21.0])
    fields = sea.freeze_stations(
        lat, lon, T0 + 1.5 * HOUR, T0 + 2.5 * HOUR, [codes.WAVE_HEIGHT_CHANNEL]
    )
    assert ((fields.times - T0) / HOUR).tolist() == [1.0, 2.0, 3.0]
    expected = affine(fields.times[None], lat[:2, None], lon[:2, None])
    assert fields.values[:2, :, 0] == pytest.approx(expected, rel=1e-6)
    assert np.isnan(fields.values[2]).all()
    grid = sea.freeze_grid(
        10, 13, 20, 22, T0, T0 + HOUR, [codes.WAVE_HEIGHT_CHANNEL], spacing_deg=0.5
    )
    assert grid.values[1, 1, 3, 0] == pytest.approx(affine(grid.times[1], 10.5, 21.5), rel=1e-6)


class RecordedArray(BackendArray):
    """An array of a file that records which part of it is read."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape, self.dtype = shape, np.dtype(float)
        self.reads: list[tuple[set[int], ...]] = []

    def __getitem__(self, key: indexing.ExplicitIndexer) -> np.ndarray:
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.BASIC, self._read
        )

    def _read(self, key: tuple) -> np.ndarray:
        ranges = [np.atleast_1d(np.arange(n)[k]) for n, k in zip(self.shape, key)]
        self.reads.append(tuple(set(r.tolist()) for r in ranges))
        return np.ones(self.shape)[key]


def test_only_the_box_and_window_are_loaded() -> None:
    stored = RecordedArray((40, 180, 360))
    lazy = indexing.LazilyIndexedArray(stored)
    dataset = xr.Dataset(
        {"swh": (("time", "lat", "lon"), lazy, {"standard_name": HS, "units": "m"})},
        coords={
            "time": clock(np.arange(40.0)),
            "lat": axis(np.arange(-90.0, 90.0), "lat"),
            "lon": axis(np.arange(0.0, 360.0), "lon"),
        },
    )
    sea = Sea.open(dataset)
    stored.reads.clear()
    sea.freeze_stations(
        [50.5, 55.0], [-20.5, 2.5], T0 + 10 * HOUR, T0 + 12 * HOUR, [codes.WAVE_HEIGHT_CHANNEL]
    )
    times, rows, columns = (set().union(*parts) for parts in zip(*stored.reads))
    assert times <= {9, 10, 11, 12, 13}
    assert rows <= set(range(140, 150))
    assert columns <= {*range(330, 360), *range(10)}
    count = len(stored.reads)
    sea.sample([HS], T0 + 11.5 * HOUR, 52.0, -10.0)
    assert len(stored.reads) == count


def test_extra_mapping_adds_a_plain_variable() -> None:
    dataset = regular(
        fields={"so": {"units": "1e-3"}}, field=lambda t, y, x: 35.0 + 0 * (t + y + x)
    )
    sea = Sea.open(dataset, mapping={"sea_water_salinity": "so"})
    assert value(sea, "sea_water_salinity", T0, 11.0, 21.0) == 35.0


def test_nemo_cell_sides_are_averaged_to_centres() -> None:
    j, i = np.meshgrid(np.arange(5.0), np.arange(6.0), indexing="ij")
    time = clock([0.0, 1.0])
    u = np.broadcast_to(i + 0.5, (2, 5, 6)) / 10.0
    v = np.broadcast_to(j + 0.5, (2, 5, 6)) / 10.0
    dims = ("y", "x")
    places = {
        "glamt": i + 0.001 * j,
        "gphit": j,
        "glamu": i + 0.5,
        "gphiu": j,
        "glamv": i,
        "gphiv": j + 0.5,
    }
    dataset = xr.Dataset({n: (dims, p) for n, p in places.items()}, coords={"time": time})
    dataset["uos"], dataset["vos"] = (("time", *dims), u), (("time", *dims), v)
    got = Sea.open(dataset).sample([EAST, NORTH], T0, [2.3, 3.0], [3.4, 2.0])
    assert got[EAST] == pytest.approx([0.34, 0.2], abs=2e-3)
    assert got[NORTH] == pytest.approx([0.23, 0.3], abs=2e-3)
    assert np.isnan(Sea.open(dataset).sample([EAST], T0, 2.5, 0.2)[EAST])


def test_masked_positions_of_a_curvilinear_grid_are_unknown() -> None:
    dataset = rotated_grid(20.0, {"swh": (affine, {"units": "m"})})
    lat, lon = dataset.lat.values.copy(), dataset.lon.values.copy()
    lat[0, :2] = lon[0, :2] = np.nan
    masked = dataset.assign_coords(
        lat=(("y", "x"), lat, dataset.lat.attrs), lon=(("y", "x"), lon, dataset.lon.attrs)
    )
    sea = Sea.open(masked)
    assert value(sea, HS, T0, 0.03, 0.05) == pytest.approx(affine(T0, 0.03, 0.05), rel=1e-9)
    inside = 0.5 * (dataset.lat.values[0, 0] + dataset.lat.values[1, 1])
    assert np.isnan(
        value(
            sea, HS, T0, inside, 0.5 * (dataset.lon.values[0, 0] + dataset.lon.values[1, 1]) - 0.02
        )
    )
    assert 0.05 < sea.coverage()[0].spacing_deg < 0.15


def test_fingerprint_changes_with_the_file(tmp_path) -> None:
    import os

    path = tmp_path / "a.nc"
    regular().to_netcdf(path)
    first = Sea.open(path).fingerprint()
    assert Sea.open(path).fingerprint() == first
    os.utime(path, ns=(1, 1))
    assert Sea.open(path).fingerprint() != first
    facts = Sea.open(path).provenance()["layers"][0]["files"][0]
    assert facts == {"name": "a.nc", "size": path.stat().st_size, "mtime_ns": 1}
