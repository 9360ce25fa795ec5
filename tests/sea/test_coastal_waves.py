"""Waves at coasts: the nearest known ones with a factor, and those of the wind over its fetch."""

import numpy as np
import pytest
import xarray as xr

from thalweg.chart import Chart
from thalweg.chart.coastal_fetch import CoastalFetch
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.sea import Sea
from thalweg.sea.models.wind_sea import carter_1982

HEIGHT = "sea_surface_wave_significant_height"
PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"
EAST, NORTH = "sea_surface_wave_to_direction_east", "sea_surface_wave_to_direction_north"
TIME = 1.7e9
#: Land east of 5 degrees, from 60 to 66 degrees north, and an island in the west.
COAST = {"type": "MultiPolygon", "coordinates": [
    [[[5.0, 60.0], [8.0, 60.0], [8.0, 66.0], [5.0, 66.0], [5.0, 60.0]]],
    [[[3.0, 62.9], [3.4, 62.9], [3.4, 63.1], [3.0, 63.1], [3.0, 62.9]]],
]}  # fmt: skip


@pytest.fixture(scope="module")
def chart():
    return Chart.from_geojson(COAST)


@pytest.fixture
def sea(tmp_path):
    """Waves of 3 m from the west, masked in the cells next to land; wind 12 m/s from the west."""
    lat, lon = np.arange(61.0, 65.1, 0.5), np.arange(1.0, 6.1, 0.5)
    time = np.array(["2023-11-14T00:00", "2023-11-15T12:00"], "datetime64[ns]")
    shape = (len(time), len(lat), len(lon))
    wet = np.broadcast_to(lon < 4.2, shape)

    def field(value, name, units):
        values = np.full(shape, value)
        values = values if "wind" in name else np.where(wet, values, np.nan)
        return (("time", "lat", "lon"), values, {"standard_name": name, "units": units})

    data = xr.Dataset(
        {
            "hs": field(3.0, HEIGHT, "m"),
            "tp": field(9.0, PERIOD, "s"),
            "dir": field(270.0, "sea_surface_wave_from_direction", "degree"),
            "u": field(12.0, "eastward_wind", "m s-1"),
            "v": field(0.0, "northward_wind", "m s-1"),
        },
        coords={"time": time, "lat": lat, "lon": lon},
    )
    data.lat.attrs["units"], data.lon.attrs["units"] = "degrees_north", "degrees_east"
    data.to_netcdf(tmp_path / "waves.nc")
    return Sea.open(tmp_path / "waves.nc")


def _at(sea, lat, lon):
    found = sea.sample((HEIGHT, PERIOD, EAST), np.array([TIME]), np.array([lat]), np.array([lon]))
    return [float(found[name][0]) for name in (HEIGHT, PERIOD, EAST)]


def test_coastal_shelter_takes_the_nearest_waves_with_a_factor(sea):
    assert np.isnan(_at(sea, 63.0, 4.6)[0])
    assert _at(sea.filled(waves="coastal_shelter"), 63.0, 4.6) == pytest.approx([2.4, 9.0, 1.0])
    half = sea.filled(waves="coastal_shelter:40:0.5")
    assert _at(half, 63.0, 4.6) == pytest.approx([1.5, 9.0, 1.0])
    assert _at(half, 63.0, 3.0)[0] == pytest.approx(3.0)  # known waves stay
    assert any("coastal shelter" in text and "0.5" in text for text in half.assumptions)
    near = sea.filled(waves="coastal_shelter:5")
    assert np.isnan(_at(near, 63.0, 4.9)[0])  # nothing known so near: unknown, not calm


@pytest.mark.parametrize("value", ["coastal_shelter:0", "coastal_shelter:25:2", "coastal_shelter:x",
                                   "coastal_shelter:1:1:1"])  # fmt: skip
def test_impossible_shelter_is_refused(sea, value):
    with pytest.raises(InputError, match="cannot be filled"):
        sea.filled(waves=value)


def test_fetch_is_the_distance_to_land_up_the_wind(chart):
    fetch = CoastalFetch(chart)
    lat, lon = np.array([63.0, 63.0]), np.array([4.0, 4.0])
    east, west = np.radians([90.0, 270.0])
    found = fetch(lat, lon, np.array([east, west]))
    true = [float(distance(63.0, 4.0, 63.0, x)) for x in (5.0, 3.4)]
    assert found == pytest.approx(true, rel=0.02)
    assert float(fetch(lat[:1], lon[:1], np.array([0.0]))[0]) == 500_000.0  # open to the north
    half = np.radians(101.25)  # between two of the 16 directions
    ends = fetch(lat, lon, np.radians([90.0, 112.5]))
    assert float(fetch(lat[:1], lon[:1], np.array([half]))[0]) == pytest.approx(ends.mean())
    assert float(fetch(np.array([63.0]), np.array([6.0]), np.array([0.0]))[0]) == 100.0  # on land
    assert np.isnan(fetch(lat[:1], lon[:1], np.array([np.nan]))[0])


def test_fetch_limited_waves_are_those_of_the_wind_over_that_fetch(sea, chart):
    """Behind the island the wind from the west has 0.6 degrees of water."""
    filled = sea.filled(waves=CoastalFetch(chart))
    place = (63.0, 4.6)
    length = float(distance(*place, 63.0, 3.4))
    height, period = carter_1982(12.0, fetch=length)
    found = _at(filled, *place)
    assert found == pytest.approx([float(height), float(period), 1.0], rel=0.02)
    assert found[0] < 0.6 * _at(sea.filled(waves="wind"), *place)[0]
    assert _at(filled, 63.0, 2.0)[0] == pytest.approx(3.0)
    assert any("fetch to the coast" in text for text in filled.assumptions)
    times = np.array([TIME, TIME + 3600.0])
    series = filled.series((HEIGHT,), times, np.array([63.0]), np.array([4.6]))[HEIGHT]
    assert series.shape == (1, 2) and series == pytest.approx(float(height), rel=0.02)


def test_the_name_alone_needs_a_coast(sea):
    with pytest.raises(InputError, match="The fetch needs a coast"):
        sea.filled(waves="fetch_limited")
