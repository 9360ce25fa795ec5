"""Files that cannot be used give an error in three parts, and no value is invented."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests.sea.small_datasets import HS, T0, clock, regular, value
from thalweg.core.errors import DatasetError, InputError, ThalwegError
from thalweg.sea import Sea


def refused(match: str, *args, **kwargs) -> ThalwegError:
    with pytest.raises((DatasetError, InputError), match=match) as caught:
        Sea.open(*args, **kwargs)
    assert caught.value.asked
    assert caught.value.possible
    assert caught.value.remedy
    return caught.value


@pytest.mark.parametrize("format_", ["NETCDF3_CLASSIC", "NETCDF3_64BIT", "NETCDF4"])
@pytest.mark.parametrize("share", [0.02, 0.3, 0.8, 0.99])
def test_truncated_netcdf(tmp_path, format_, share) -> None:
    whole = tmp_path / "whole.nc"
    regular(hours=np.arange(30.0), lat=np.arange(20.0)).to_netcdf(
        whole, format=format_, unlimited_dims=["time"]
    )
    cut = tmp_path / "cut.nc"
    data = whole.read_bytes()
    Sea.open(whole)
    cut.write_bytes(data[: int(len(data) * share)])
    refused("cut.nc", cut)


def test_corrupt_compressed_chunk(tmp_path) -> None:
    path = tmp_path / "bad.nc"
    rng = np.random.default_rng(1)
    dataset = regular(hours=np.arange(8.0), lat=np.arange(30.0), lon=np.arange(30.0))
    dataset["swh"] = dataset.swh * 0 + rng.uniform(0, 5, dataset.swh.shape)
    dataset.to_netcdf(path, encoding={"swh": {"zlib": True, "chunksizes": (1, 30, 30)}})
    data = bytearray(path.read_bytes())
    for k in range(len(data) // 3, len(data) - 200, 400):
        data[k : k + 40] = bytes(40)
    path.write_bytes(bytes(data))
    with pytest.raises(DatasetError, match=r"bad\.nc"):
        sea = Sea.open(path)
        sea.freeze_stations([10.0], [10.0], T0, T0 + 7 * 3600, [4])


def test_not_data_empty_and_missing(tmp_path) -> None:
    text = tmp_path / "notes.nc"
    text.write_text("dear diary, " * 100)
    refused("notes.nc is not in a known format", text)
    empty = tmp_path / "empty.nc"
    empty.touch()
    refused("is empty", empty)
    refused("no file", tmp_path / "absent.nc")
    assert "notes.nc" in refused("no file", tmp_path / "note.nc").remedy
    (tmp_path / "folder").mkdir()
    refused("not a Zarr store", tmp_path / "folder")
    with pytest.raises(InputError, match="No file"):
        Sea.open()


@pytest.mark.parametrize(
    ("hours", "match"),
    [([0.0, 2.0, 1.0], "earlier"), ([0.0, 1.0, 1.0], "is repeated"), ([2.0, 1.0, 0.0], "earlier")],
)
def test_times_that_do_not_increase(hours, match) -> None:
    refused(match, regular(hours=hours))


def test_times_without_dates_and_strange_calendars() -> None:
    plain = regular()
    plain["time"] = ("time", [0.0, 1.0, 2.0])
    refused("no dates", plain)
    noleap = regular()
    noleap["time"] = (
        "time",
        [0.0, 1.0, 2.0],
        {"units": "days since 2001-02-27", "calendar": "360_day"},
    )
    error = refused("the calendar '360_day'", noleap)
    assert "standard, gregorian, proleptic_gregorian" in error.possible
    assert "ds.convert_calendar('standard', dim='time', align_on='date')" in error.remedy
    assert "duplicates" not in str(error)


def test_two_candidates_are_listed_and_can_be_chosen() -> None:
    attrs = {"standard_name": HS, "units": "m"}
    dataset = regular(fields={"hs_model_a": attrs, "hs_model_b": attrs})
    dataset["hs_model_b"] = dataset.hs_model_b * 2.0
    dataset.hs_model_b.attrs = attrs
    error = refused("hs_model_a, hs_model_b", dataset)
    assert error.details["candidates"] == ["hs_model_a", "hs_model_b"]
    one = Sea.open(dataset, mapping={HS: "hs_model_a"})
    two = Sea.open(dataset, mapping={HS: "hs_model_b"})
    assert value(two, HS, T0, 11.0, 21.0) == pytest.approx(2.0 * value(one, HS, T0, 11.0, 21.0))
    refused("in none of the files", dataset, mapping={HS: "hs_model_c"})


def test_names_of_two_sources_are_ambiguous_and_of_one_source_are_not() -> None:
    refused("could be any of", regular(fields={"swh": {"units": "m"}, "vhm0": {"units": "m"}}))
    cmems = regular(
        fields={n: {"units": "m/s"} for n in ("utotal", "vtotal")},
        field=lambda t, y, x: 0.5 + 0 * (t + y + x),
    )
    assert "eastward_sea_water_velocity" in Sea.open(cmems).variables


def test_impossible_units_and_values() -> None:
    refused("units are 'K'", regular(fields={"swh": {"units": "K"}}))
    refused("units may be wrong", regular(field=lambda t, y, x: 300.0 + 0 * (t + y + x)))
    refused(
        "units may be wrong",
        regular(
            fields={"u10": {"units": "m/s"}, "v10": {"units": "m/s"}},
            field=lambda t, y, x: -9999.0 + 0 * (t + y + x),
        ),
    )
    refused(
        "units may be wrong",
        regular(fields={"msl": {"units": "Pa"}}, field=lambda t, y, x: 1013.0 + 0 * (t + y + x)),
    )


@pytest.mark.parametrize("row", [0, 3])
def test_every_row_of_a_small_grid_is_checked_on_opening(row) -> None:
    data = regular()
    data.swh[1, row, 0] = 9999.0  # the middle time
    refused("9999", data)


def test_implausible_values_outside_the_first_check_are_detected_when_read() -> None:
    dataset = regular(hours=np.arange(6.0))
    dataset.swh[5] = 1e6
    sea = Sea.open(dataset)
    with pytest.raises(DatasetError, match="units may be wrong"):
        sea.sample([HS], T0 + 5 * 3600.0, 11.0, 21.0)


def test_layouts_that_are_not_fields() -> None:
    series = xr.Dataset(
        {"Hm0": (("time",), np.ones(5), {"standard_name": HS, "units": "m"})},
        coords={"time": clock(np.arange(5.0)), "x": 4.0, "y": 52.0},
    )
    refused("no positions", series)
    points = xr.Dataset(
        {"swh": (("time", "station"), np.ones((5, 3)), {"units": "m"})},
        coords={
            "time": clock(np.arange(5.0)),
            "lat": ("station", [1.0, 2.0, 3.0]),
            "lon": ("station", [1.0, 2.0, 3.0]),
        },
    )
    refused("single points", points)
    months = regular().rename(time="month").drop_vars("month").assign_coords(month=[1, 2, 3])
    refused("climatology", months)
    strange = regular().expand_dims(percentile=[10, 90])
    refused("neither time, position nor level", strange)
    winds = regular(
        fields={"u10": {"units": "m/s"}, "v10": {"units": "m/s"}},
        field=lambda t, y, x: 1.0 + 0 * (t + y + x),
    )
    high = winds.expand_dims(
        height=xr.DataArray([80.0, 100.0], dims="height", attrs={"units": "m"})
    )
    refused("not at 10 m", high)


def test_a_file_without_known_variables_lists_its_variables() -> None:
    error = refused("no wind, waves", regular(fields={"chlorophyll": {"units": "mg m-3"}}))
    assert "chlorophyll" in error.possible


def test_impossible_positions_are_refused() -> None:
    refused("reaches 95 degrees", regular(lat=[80.0, 85.0, 95.0]))
    refused("one way|neither", regular(lat=[10.0, 12.0, 11.0]))


def test_no_file_is_written_in_the_data_folder(tmp_path) -> None:
    regular().to_netcdf(tmp_path / "a.nc")
    before = sorted(p.name for p in tmp_path.iterdir())
    Sea.open(tmp_path / "a.nc").sample([HS], T0, 11.0, 21.0)
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_wind_at_ten_metres_has_priority_over_other_heights() -> None:
    winds = regular(
        fields={
            "u10": {"standard_name": "eastward_wind", "units": "m/s"},
            "v10": {"standard_name": "northward_wind", "units": "m/s"},
        },
        field=lambda t, y, x: 5.0 + 0 * (t + y + x),
    )
    height = xr.DataArray([80.0, 100.0], dims="height", attrs={"units": "m"})
    high = (winds * 2.0).rename(u10="u", v10="v").expand_dims(height=height)
    for new, old in (("u", "u10"), ("v", "v10")):
        winds[new] = high[new]
        winds[new].attrs = winds[old].attrs
    sea = Sea.open(winds)
    assert value(sea, "eastward_wind", T0, 11.0, 21.0) == 5.0
    assert any("not at 10 m" in reason for _, _, reason in sea.describe().ignored)


def test_complete_classic_files_of_every_version_pass_the_length_check(tmp_path) -> None:
    from thalweg.sea.files.netcdf3_check import expected_length

    for format_ in ("NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"):
        for unlimited in ([], ["time"]):
            path = tmp_path / f"{format_}{len(unlimited)}.nc"
            dataset = regular(hours=np.arange(7.0), lat=np.arange(5.0), lon=np.arange(3.0))
            dataset["flag"] = ("time", np.arange(7).astype("i2"))
            encoding = {"swh": {"dtype": "int16", "scale_factor": 0.001, "_FillValue": -1}}
            from netCDF4 import Dataset

            kind = "NETCDF3_CLASSIC" if "CLASSIC" in format_ else "NETCDF3_64BIT"
            dataset.to_netcdf(path, format=kind, encoding=encoding, unlimited_dims=unlimited)
            if "DATA" in format_:
                path.unlink()
                with Dataset(path, "w", format=format_) as out:
                    out.createDimension("time", None if unlimited else 7)
                    out.createDimension("lat", 5)
                    out.createVariable("a", "i2", ("time", "lat"))[:] = np.ones((7, 5))
                    out.createVariable("b", "f8", ("time",))[:] = np.ones(7)
            size = path.stat().st_size
            assert size - 4 <= expected_length(path) <= size, (format_, unlimited)


def _levels(values, name, units) -> xr.Dataset:
    """Return wind with the value of its level, on levels of any kind."""
    level = np.array(values, float)
    u = np.broadcast_to(level[None, :, None, None] / 20.0, (2, level.size, 3, 3)).copy()
    dims = ("time", name, "lat", "lon")
    return xr.Dataset(
        {
            "u": (dims, u, {"standard_name": "eastward_wind", "units": "m s-1"}),
            "v": (dims, 0.0 * u, {"standard_name": "northward_wind", "units": "m s-1"}),
        },
        {
            "time": clock([0.0, 6.0]),
            name: (name, level, {"units": units}),
            "lat": [0.0, 1.0, 2.0],
            "lon": [0.0, 1.0, 2.0],
        },
    )


@pytest.mark.parametrize(
    ("values", "name", "units"),
    [
        ([1000.0, 500.0, 10.0], "isobaric", "hPa"),  # 10 hPa is the stratosphere, not 10 m
        ([500.0], "pressure_level", "hPa"),
        ([850.0], "level", "millibars"),
        ([85000.0, 1000.0], "plev", "Pa"),
    ],
)
def test_upper_air_wind_is_never_used_as_wind_at_ten_metres(values, name, units) -> None:
    refused("levels of pressure", _levels(values, name, units))
    mapping = {"eastward_wind": "u", "northward_wind": "v"}
    if len(values) > 1:  # mapping the variables does not select a level
        refused("levels of pressure", _levels(values, name, units), mapping=mapping)
    height = Sea.open(_levels([100.0, 10.0], "height", "m"))
    assert value(height, "eastward_wind", T0, 1.0, 1.0) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("begin", "kind"), [(b"PK\x03\x04", "zip"), (b"\x1f\x8b\x08", "gzip"), (b"BZh9", "bzip2")]
)
def test_compressed_files_are_reported_as_compressed(tmp_path, begin, kind) -> None:
    path = tmp_path / "era5.nc"
    path.write_bytes(begin + bytes(100))
    assert "Decompress it first" in str(refused(f"is compressed .{kind}.", path))


@pytest.mark.parametrize("what", [5, None, 1.5])
def test_objects_that_cannot_be_opened(what) -> None:
    refused("cannot be opened from", what)
