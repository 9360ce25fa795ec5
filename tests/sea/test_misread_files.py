"""Files that were read wrongly or in silence: what models write, and what is left unmarked."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests.sea import hydrodynamic_runs as hydro
from tests.sea import ocean_model_runs as models
from tests.sea.small_datasets import EAST, HS, NORTH, T0, regular, value
from thalweg.core.errors import DatasetError
from thalweg.core.time import parse_time
from thalweg.sea import Sea
from thalweg.sea.doubtful_values import doubts_of_files, guesses_of_files
from thalweg.ship.methods.seakeeping.wave_spectra import jonswap

LEVEL, DEPTH = "sea_surface_height_above_geopotential_datum", "sea_floor_depth_below_geoid"
WAVE_TO_EAST, WAVE_TO_NORTH = (f"sea_surface_wave_to_direction_{w}" for w in ("east", "north"))
PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"


def same(number: float):
    """Return a field of one value."""
    return lambda t, y, x: number + 0.0 * (t + y + x)


@pytest.mark.parametrize(
    "make", [models.schism, models.fvcom, models.roms, lambda: models.roms(30)]
)
def test_ocean_models_are_read_with_their_level_bed_and_currents(tmp_path, make) -> None:
    make().to_netcdf(tmp_path / "run.nc")
    sea = Sea.open(tmp_path / "run.nc")
    if "lat_rho" in make():
        part = make().isel(eta_rho=slice(2, -1), xi_rho=slice(2, 5))
        lat, lon = part["lat_rho"].values.ravel(), part["lon_rho"].values.ravel()
        bed = -part["h"].values.ravel()
    else:
        table = hydro.triangles()[:30]
        lat, lon = (a[table].mean(axis=1) for a in hydro.nodes())
        west = lon < hydro.LON0 + 4.0 * hydro.STEP
        lat, lon = lat[west], lon[west]
        bed = hydro.bed(lon)
    got = sea.sample([EAST, NORTH, LEVEL, DEPTH], hydro.T0 + 3 * 3600.0, lat, lon)
    east, north = hydro.current(3.0, lat, lon)
    assert got[EAST] == pytest.approx(east, abs=2e-4)
    assert got[NORTH] == pytest.approx(north, abs=2e-4)
    assert got[LEVEL] == pytest.approx(hydro.level(3.0), abs=1e-6)
    assert got[DEPTH] == pytest.approx(-bed, abs=1e-5)


def test_the_energy_period_of_waves_gives_the_peak_period() -> None:
    """Of a JONSWAP spectrum with peak enhancement 3.3: 0.9033 times the peak period."""
    mean = regular(fields={"mwp": {"units": "s"}}, field=same(9.033))
    assert value(Sea.open(mean), PERIOD, T0, 11.0, 21.0) == pytest.approx(10.0, rel=1e-3)
    both = mean.assign(pp1d=(mean["mwp"].dims, np.full(mean["mwp"].shape, 11.0), {"units": "s"}))
    assert value(Sea.open(both), PERIOD, T0, 11.0, 21.0) == pytest.approx(11.0, rel=1e-6)
    frequency = np.linspace(0.05, 30.0, 200_000)
    spectrum = jonswap(frequency, height=2.0, period=10.0, peak_factor=3.3)
    moments = [np.trapezoid(spectrum * frequency**k, frequency) for k in (-1, 0)]
    assert 2.0 * np.pi * moments[0] / moments[1] == pytest.approx(9.03, abs=0.01)


def test_one_time_of_schism_is_still_a_level() -> None:
    sea = Sea.open(models.schism().isel(time=[0]))
    lat, lon = hydro.nodes()
    got = sea.sample([LEVEL, DEPTH], hydro.T0, lat[0], lon[0])
    assert float(got[LEVEL]) == pytest.approx(1.5, abs=1e-6)
    assert float(got[DEPTH]) == pytest.approx(10.0, abs=1e-5)


def test_layers_of_fvcom_by_node_use_the_one_at_the_surface() -> None:
    data = models.fvcom()
    on = ("time", "layer", "nele")
    grow = np.array([1.0, 0.5, 0.1])[None, :, None]
    for old, new, word in (("ua", "u", "Eastward"), ("va", "v", "Northward")):
        values = data[old].values[:, None, :] * grow
        attributes = {"long_name": f"{word} Water Velocity", "units": "meters s-1"}
        data[new] = (on, values, attributes)
    sigma = np.repeat(np.array([[-0.1], [-0.5], [-0.9]]), data.sizes["node"], axis=1)
    attributes = {"standard_name": "ocean_sigma_coordinate", "positive": "up"}
    data["siglay"] = (("layer", "node"), sigma, attributes)
    data = data.drop_vars(["siglay"]).assign_coords(layer=("layer", sigma[:, 0], attributes))
    sea = Sea.open(data)
    lat, lon = (a[hydro.triangles()[5]].mean() for a in hydro.nodes())
    assert value(sea, EAST, hydro.T0, lat, lon) == pytest.approx(hydro.current(0.0, lat, lon)[0])


def test_a_depth_that_is_positive_upwards_is_turned() -> None:
    data = models.schism()
    data["depth"] = -data["depth"]
    data["depth"].attrs = {"units": "m", "positive": "up"}
    lat, lon = hydro.nodes()
    assert value(Sea.open(data), DEPTH, hydro.T0, lat[0], lon[0]) == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("present", "attributes"),
    [
        ("uo", {"units": "m/s"}),
        ("u10", {"units": "m/s"}),
        ("x", {"units": "m/s", "standard_name": "sea_water_speed"}),
        ("x", {"units": "degree", "standard_name": "sea_water_velocity_to_direction"}),
    ],
)
def test_one_half_of_a_vector_is_refused(present, attributes) -> None:
    """In still water, with no more than a note, the ship would meet no current."""
    data = regular(fields={present: attributes, "swh": {"units": "m"}}, field=same(1.0))
    with pytest.raises(DatasetError, match=f"'{present}'.*not in the file"):
        Sea.open(data)


def test_components_on_different_sides_of_cells_are_refused() -> None:
    data = models.roms().drop_vars(["lat_rho", "lon_rho", "h", "zeta"])
    with pytest.raises(DatasetError, match="same positions"):
        Sea.open(data)


# --------------------------------------------------------------------------- unmarked fills


def bed_file(fill: float, attributes: dict[str, str] | None = None) -> xr.Dataset:
    """Return a bed that slopes from 5 to 60 m with a block of fill values."""
    data = regular(lat=np.arange(10.0), lon=np.arange(10.0), hours=[0.0, 1.0])
    depth = np.linspace(5.0, 60.0, 100).reshape(10, 10)
    depth[4:7, 5:7] = fill
    attributes = attributes or {"standard_name": "sea_floor_depth_below_geoid", "units": "m"}
    data["depth"] = (("lat", "lon"), depth, attributes)
    return data


@pytest.mark.parametrize("fill", [9999.0, 999.0, -999.0, 9999.9])
def test_unmarked_fills_of_a_bed_are_refused(fill) -> None:
    with pytest.raises(DatasetError, match=f"{fill:g}.*missing"):
        Sea.open(bed_file(fill))


def test_marked_fills_of_a_bed_are_unknown_and_true_depths_stay(tmp_path) -> None:
    data = bed_file(9999.0)
    data["depth"].encoding["_FillValue"] = 9999.0
    data.to_netcdf(tmp_path / "bed.nc")
    assert np.isnan(value(Sea.open(tmp_path / "bed.nc"), DEPTH, T0, 5.0, 5.0))
    slope = bed_file(30.0)
    slope["depth"] = (("lat", "lon"), np.arange(950.0, 1050.0).reshape(10, 10), slope.depth.attrs)
    assert value(Sea.open(slope), DEPTH, T0, 4.0, 9.0) == 999.0


@pytest.mark.parametrize("fill", [9999.0, -999.0, -99.0, -99.9])
def test_unmarked_fills_of_a_direction_are_refused(fill) -> None:
    data = regular(fields={"mwd": {"units": "degrees"}}, field=same(200.0))
    data["mwd"][:, 0, 0] = fill
    with pytest.raises(DatasetError, match="mwd"):
        Sea.open(data)


def test_directions_from_minus_to_plus_180_are_read() -> None:
    data = regular(
        fields={"mwd": {"units": "degrees"}}, field=lambda t, y, x: 10 * x - 300 + y + 0 * t
    )
    got = Sea.open(data).sample([WAVE_TO_EAST], T0, 10.0, 20.0)[WAVE_TO_EAST]
    assert float(got) == pytest.approx(-np.sin(np.radians(-90.0)))


@pytest.mark.parametrize(
    ("name", "fill"), [("u10", 99.0), ("u10", -99.9), ("swh", 32.767), ("uo", -9.99)]
)
def test_unmarked_fills_inside_the_plausible_range_are_refused(name, fill) -> None:
    pairs = {"u10": ("u10", "v10"), "uo": ("uo", "vo")}.get(name, (name,))
    unit = "m" if name == "swh" else "m/s"
    data = regular(
        fields={key: {"units": unit} for key in pairs},
        field=lambda t, y, x: x / 20 + y / 90 + 0 * t,
    )
    data[name][:, :3, 0] = fill
    with pytest.raises(DatasetError, match=r"missing"):
        Sea.open(data)


# --------------------------------------------------------------------------- directions


@pytest.mark.parametrize(
    ("attributes", "towards"),
    [
        ({"long_name": "mean wave direction"}, 180.0),
        ({"long_name": "mean wave direction (going to)"}, 0.0),
        ({"long_name": "Direction towards which the waves travel"}, 0.0),
        ({"long_name": "mean direction, waves coming from"}, 180.0),
        ({"long_name": "Mean wave direction from (deg), clockwise from true north"}, 180.0),
    ],
)
def test_the_long_name_states_from_or_to(attributes, towards) -> None:
    data = regular(fields={"mwd": {"units": "degrees", **attributes}}, field=same(0.0 + 360.0))
    got = Sea.open(data).sample([WAVE_TO_NORTH], T0, 11.0, 21.0)[WAVE_TO_NORTH]
    assert float(got) == pytest.approx(np.cos(np.radians(towards)))


def test_a_long_name_against_the_standard_name_is_refused() -> None:
    attributes = {
        "standard_name": "sea_surface_wave_from_direction",
        "long_name": "wave direction, going to",
        "units": "degree",
    }
    data = regular(fields={"dir": attributes}, field=same(200.0))
    with pytest.raises(DatasetError, match="going to"):
        Sea.open(data)
    mapped = Sea.open(data, mapping={"sea_surface_wave_to_direction": "dir"})
    got = mapped.sample([WAVE_TO_NORTH], T0, 11.0, 21.0)[WAVE_TO_NORTH]
    assert float(got) == pytest.approx(np.cos(np.radians(200.0)))


def test_a_direction_without_units_is_refused_where_it_could_be_radians() -> None:
    with pytest.raises(DatasetError, match="radians or degrees"):
        Sea.open(regular(fields={"mwd": {}}, field=same(4.0)))
    sea = Sea.open(regular(fields={"mwd": {}}, field=same(270.0)))
    assert float(sea.sample([WAVE_TO_EAST], T0, 11.0, 21.0)[WAVE_TO_EAST]) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize(
    ("south", "west", "step"), [(-90.0, -180.0, 1.0), (51.0, 2.0, 0.25), (0.0, 0.0, 1.0 / 12.0)]
)
def test_positions_in_radians(kind, south, west, step) -> None:
    lat, lon = south + step * np.arange(9.0), west + step * np.arange(11.0)
    axes = {
        "time": np.array(["2026-01-01", "2026-01-02"], "M8[ns]"),
        "latitude": lat,
        "longitude": lon,
    }
    field = np.broadcast_to(lat[None, :, None], (2, 9, 11)).copy()
    given = xr.Dataset(
        {name: (tuple(axes), field, {"units": "m s-1"}) for name in ("u10", "v10")}, axes
    )
    turned = given.assign_coords(
        latitude=np.radians(lat).astype(kind), longitude=np.radians(lon).astype(kind)
    )
    with pytest.raises(DatasetError, match="look like radians"):
        Sea.open(turned)
    for axis in ("latitude", "longitude"):
        turned[axis].attrs["units"] = "radian"
    sample = Sea.open(turned).sample(["eastward_wind"], parse_time("2026-01-01"), lat[3], lon[4])
    assert float(sample["eastward_wind"]) == pytest.approx(lat[3], abs=1e-4)
    assert Sea.open(given).variables  # degrees near 0 stay degrees


# --------------------------------------------------------------------------- ranges and times


@pytest.mark.parametrize(
    "limits", [{"valid_min": 0.0, "valid_max": 20.0}, {"valid_range": [0.0, 20.0]}]
)
def test_values_outside_the_valid_range_are_missing(tmp_path, limits) -> None:
    data = regular(fields={"swh": {"units": "m", **limits}}, field=same(2.0))
    data["swh"][:, 0, 0] = 25.0
    data.to_netcdf(tmp_path / "waves.nc")
    sea = Sea.open(tmp_path / "waves.nc")
    assert np.isnan(value(sea, HS, T0, 10.0, 20.0))
    assert value(sea, HS, T0, 12.0, 21.0) == 2.0


def test_valid_limits_of_packed_values_are_packed(tmp_path) -> None:
    limits = {"valid_min": np.int16(0), "valid_max": np.int16(2000)}
    data = regular(fields={"swh": {"units": "m", **limits}}, field=same(2.0))
    data["swh"][:, 0, 0] = 25.0
    packing = {"dtype": "int16", "scale_factor": 0.01, "add_offset": 0.0, "_FillValue": -1}
    data.to_netcdf(tmp_path / "waves.nc", encoding={"swh": packing})
    sea = Sea.open(tmp_path / "waves.nc")
    assert np.isnan(value(sea, HS, T0, 10.0, 20.0))
    assert value(sea, HS, T0, 12.0, 21.0) == pytest.approx(2.0)


@pytest.mark.parametrize(("name", "bad"), [("swh", -0.3), ("pp1d", -0.5), ("si10", -0.4)])
def test_negative_heights_and_periods_are_refused(name, bad) -> None:
    units = {"swh": "m", "pp1d": "s", "si10": "m/s"}[name]
    data = regular(fields={name: {"units": units}}, field=same(2.0))
    data[name][:, 0, 0] = bad
    with pytest.raises(DatasetError, match="plausible"):
        Sea.open(data)


def test_a_height_below_zero_by_packing_is_zero() -> None:
    data = regular(field=same(2.0))
    data["swh"][:, 0, 0] = -0.004
    assert value(Sea.open(data), HS, T0, 10.0, 20.0) == 0.0


@pytest.mark.parametrize("zone", ["CET", "Europe/Amsterdam", "EST"])
def test_time_zones_by_name_are_refused(zone) -> None:
    data = regular()
    data["time"] = ("time", [0.0, 1.0, 2.0], {"units": f"hours since 2026-01-01 00:00:00 {zone}"})
    with pytest.raises(DatasetError, match=zone):
        Sea.open(data)


@pytest.mark.parametrize(
    ("reference", "first"),
    [
        ("2026-01-01 00:00:00 UTC", "2026-01-01T00:00Z"),
        ("2026-01-01T00:00:00Z", "2026-01-01T00:00Z"),
        ("2026-01-01 00:00:00 +01:00", "2025-12-31T23:00Z"),
        ("2026-01-01", "2026-01-01T00:00Z"),
    ],
)
def test_offsets_of_time_units_are_applied(reference, first) -> None:
    data = regular()
    data["time"] = ("time", [0.0, 1.0, 2.0], {"units": f"hours since {reference}"})
    assert Sea.open(data).coverage()[0].start == parse_time(first)


def test_times_beyond_2262_are_read() -> None:
    data = regular()
    data["time"] = ("time", [0.0, 1.0, 2.0], {"units": "hours since 2300-01-01"})
    assert Sea.open(data).coverage()[0].start == parse_time("2300-01-01T00:00Z")


def test_directions_that_look_like_radians_and_waves_of_centimetres_raise_a_doubt() -> None:
    lat, lon = np.arange(50.0, 57.0), np.arange(0.0, 7.0)
    fields = {"mwd": {"units": "degrees", "long_name": "mean wave direction from"}}
    degrees = regular(lat, lon, fields=fields, field=lambda t, y, x: 60.0 * x + 0.0 * (t + y))
    radians = regular(lat, lon, fields=fields, field=lambda t, y, x: 1.01 * x + 0.0 * (t + y))
    north = regular(lat, lon, fields=fields, field=same(0.0))
    assert not Sea.open(degrees).describe().warnings
    assert not Sea.open(north).describe().warnings
    (warning,) = Sea.open(radians).describe().warnings
    assert "look like radians" in warning
    (warning,) = Sea.open(regular(lat, lon, field=same(0.025))).describe().as_dict()["warnings"]
    assert "higher than 0.025 m" in warning
    assert not Sea.open(regular(lat, lon, field=same(0.0))).describe().warnings
    y, x = (a.ravel() for a in np.meshgrid(lat, lon))
    layers = Sea.open(radians).layers
    assert len(doubts_of_files(layers, np.array([T0, T0 + 3600.0, T0 + 7200.0]), y, x)) == 1
    assert not doubts_of_files(layers, np.array([T0]), y, x)  # too few values
    assert not doubts_of_files(Sea.storm().layers, np.array([T0]), y, x)  # no file


def test_units_and_times_that_are_not_stated_have_a_note(tmp_path) -> None:
    data = regular(fields={"swh": {"standard_name": HS}}, field=same(2.0))
    data.to_netcdf(tmp_path / "plain.nc")
    (note,) = Sea.open(tmp_path / "plain.nc").describe().warnings
    assert note.startswith("Units not stated: plain.nc is read with swh as m.")
    data["swh"].attrs["units"] = "m"
    assert Sea.open(data).describe().warnings == ()
    still = Sea.open(data.isel(time=0, drop=True))
    (note,) = still.describe().warnings
    assert note.startswith("No time in the data: the values of swh in ")
    assert guesses_of_files(still.layers, {HS}) == (note,)
    assert guesses_of_files(still.layers, {EAST}) == ()  # a plan that does not read it


def test_every_time_of_a_small_file_is_inspected(monkeypatch) -> None:
    """One of 40 times holds 9999 m; of a large file eight times are read, and that is stated."""
    data = regular(hours=np.arange(40.0), field=same(2.0))
    data["swh"].values[7] = 9999.0
    with pytest.raises(DatasetError, match="reaches 9999 m"):
        Sea.open(data).describe()
    monkeypatch.setattr("thalweg.sea.inspection._ALL_TIMES", 100)
    found = Sea.open(data).describe()
    assert list(found.times_read.values()) == [(8, 40)]
    assert list(found.as_dict()["times_read"].values()) == [[8, 40]]
    assert list(found.ranges.values()) == [(2.0, 2.0)]
