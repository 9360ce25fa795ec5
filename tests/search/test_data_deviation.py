"""The raster of a certificate and its margins hold for data on any grids, between their points."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from thalweg.core.time import parse_time
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH, WAVE_HEIGHT_CHANNEL
from thalweg.sea import Sea
from thalweg.sea.standard_names import EASTWARD_CURRENT, NORTHWARD_CURRENT, WAVE_HEIGHT
from thalweg.search.certificate.barrier_raster import (
    RasterRequest,
    freeze_barrier_raster,
)

DEPART = parse_time("2026-01-01T00:00")
CURRENTS = {"uo": "eastward_sea_water_velocity", "vo": "northward_sea_water_velocity"}
WAVES = {"swh": "sea_surface_wave_significant_height"}


def grid(rng, lat, lon, hours, names, missing=0.0):
    """Return random values on axes of latitude and longitude, some of them unknown at all times."""
    shape = len(hours), len(lat), len(lon)
    gone = rng.random(shape[1:]) < missing
    time = np.datetime64("2026-01-01") + (np.asarray(hours) * 3600).astype("timedelta64[s]")
    data = {
        name: (
            ("time", "latitude", "longitude"),
            np.where(gone, np.nan, rng.uniform(0.2, 2.0, shape)),
            {"standard_name": standard, "units": "m" if standard in WAVES.values() else "m s-1"},
        )
        for name, standard in names.items()
    }
    return xr.Dataset(
        data, {"time": time.astype("datetime64[ns]"), "latitude": lat, "longitude": lon}
    )


def curvilinear(rng, hours):
    """Return random currents on a grid that is turned by 20 degrees."""
    y, x = np.meshgrid(np.linspace(-1.2, 1.2, 31), np.linspace(-1.2, 1.2, 25), indexing="ij")
    turn = np.radians(20.0)
    lat, lon = (
        51.0 + 0.6 * (y * np.cos(turn) - x * np.sin(turn)),
        3.0 + x * np.cos(turn) + y * np.sin(turn),
    )
    time = np.datetime64("2026-01-01") + (np.asarray(hours) * 3600).astype("timedelta64[s]")
    shape = len(hours), *lat.shape
    data = {
        name: (
            ("time", "y", "x"),
            rng.uniform(-2.0, 2.0, shape),
            {"standard_name": standard, "units": "m s-1", "coordinates": "lat lon"},
        )
        for name, standard in CURRENTS.items()
    }
    where = {
        "time": time.astype("datetime64[ns]"),
        "lat": (("y", "x"), lat, {"standard_name": "latitude", "units": "degrees_north"}),
        "lon": (("y", "x"), lon, {"standard_name": "longitude", "units": "degrees_east"}),
    }
    return xr.Dataset(data, where)


HOURS = np.arange(13.0)


def seas(kind, rng):
    even = np.arange(50.0, 52.01, 0.1), np.arange(2.0, 4.01, 0.1)
    uneven = 50.0 + 2.0 * np.sort(np.r_[0.0, 1.0, rng.random(25)]), even[1]
    fine = np.arange(50.8, 51.2001, 0.02), np.arange(2.6, 3.4001, 0.04)
    if kind == "rows finer than columns":
        return [grid(rng, np.arange(50.0, 52.001, 0.02), even[1], HOURS, CURRENTS)]
    if kind == "uneven rows":
        return [grid(rng, *uneven, HOURS, CURRENTS)]
    if kind == "two grids of two variables":
        other = np.arange(49.97, 52.1, 0.17), np.arange(1.93, 4.1, 0.23)
        return [grid(rng, *even, HOURS, CURRENTS), grid(rng, *other, HOURS[::3], WAVES)]
    if kind == "fine over coarse":
        return [grid(rng, *fine, HOURS, CURRENTS), grid(rng, *even, HOURS, CURRENTS)]
    if kind == "fine over coarse, with gaps and for a part of the time":
        return [
            grid(rng, *fine, HOURS[:6], CURRENTS, missing=0.1),
            grid(rng, *even, HOURS, CURRENTS, missing=0.05),
        ]
    if kind.startswith("uneven rows with gaps"):
        return [grid(rng, *uneven, HOURS, CURRENTS, missing=0.1)]
    return [curvilinear(rng, HOURS)]


KINDS = [
    "rows finer than columns",
    "uneven rows",
    "two grids of two variables",
    "fine over coarse",
    "fine over coarse, with gaps and for a part of the time",
    "uneven rows with gaps",
    "uneven rows with gaps that are filled",
    "curvilinear",
]


def raster_at(raster, channel, time, lat, lon):
    """Return the raster and the margins at positions: all four corners of a cell must be known."""
    values, corner = (
        raster.arrays.values[..., raster.arrays.channel_index[channel]],
        raster.arrays.corner,
    )
    y, x = (lat - corner[0]) / corner[1], (lon - corner[2]) / corner[3]
    j = np.clip(y.astype(int), 0, values.shape[1] - 2)
    i = np.clip(x.astype(int), 0, values.shape[2] - 2)
    fy, fx = y - j, x - i
    found = np.zeros(lat.size)
    step = np.clip(np.searchsorted(raster.arrays.times, time) - 1, 0, raster.arrays.times.size - 2)
    ft = (time - raster.arrays.times[step]) / np.diff(raster.arrays.times)[step]
    for later in (0, 1):
        share = ft if later else 1.0 - ft
        for up in (0, 1):
            for side in (0, 1):
                weight = share * (fy if up else 1.0 - fy) * (fx if side else 1.0 - fx)
                found += weight * values[step + later, j + up, i + side]
    margins = raster.margins
    return found, margins[
        np.minimum(j, len(margins) - 1), np.minimum(i, margins.shape[1] - 1), channel
    ]


@pytest.mark.parametrize("cells", [40, 150])
@pytest.mark.parametrize("kind", KINDS)
def test_no_value_of_the_sea_is_farther_from_the_raster_than_its_margin(kind, cells, monkeypatch):
    """A jet one row wide in the finer of two files was neither seen nor counted: a false bound."""
    most = "thalweg.search.certificate.barrier_raster._MOST_CELLS"
    monkeypatch.setattr(most, cells**2)  # lines of the data are left out for the smaller number
    rng = np.random.default_rng(len(kind))
    data = seas(kind, rng)
    sea = Sea.open(*data)
    if kind == "uneven rows with gaps that are filled":
        sea = sea.filled(currents=0.0)
    channels = [CURRENT_EAST, CURRENT_NORTH]
    names = {CURRENT_EAST: EASTWARD_CURRENT, CURRENT_NORTH: NORTHWARD_CURRENT}
    if kind.startswith("two grids"):
        channels, names = (
            [*channels, WAVE_HEIGHT_CHANNEL],
            {**names, WAVE_HEIGHT_CHANNEL: WAVE_HEIGHT},
        )
    period = DEPART, DEPART + 11.5 * 3600.0
    raster = freeze_barrier_raster(
        RasterRequest(sea, channels, (50.35, 51.7, 2.2, 3.8), period, 60)
    )
    assert raster.sampling == ""
    count = 20_000
    lat, lon = rng.uniform(50.4, 51.65, count), rng.uniform(2.25, 3.75, count)
    time = rng.uniform(0.0, 11.5 * 3600.0, count)
    greatest = np.zeros(count)
    for channel, name in names.items():
        true = sea.sample([name], DEPART + time, lat, lon)[name]
        known = np.isfinite(true)
        assert known.mean() > 0.3
        found, margin = raster_at(raster, channel, time, lat, lon)
        away = np.abs(true - found)[known]
        assert np.isfinite(away).all()
        assert (away <= margin[known] + 1e-4).all()
        greatest = (
            np.hypot(greatest, np.where(known, true, 0.0)) if channel in channels[:2] else greatest
        )
    assert greatest.max() <= raster.strongest_current + 1e-4
    assert raster.strongest_current < 2.0 * np.sqrt(2.0) + 1e-6  # of the data, not of margins


def test_lines_of_the_data_need_no_margin():
    rng = np.random.default_rng(3)
    sea = Sea.open(
        grid(rng, np.arange(50.0, 52.01, 0.1), np.arange(2.0, 4.01, 0.1), HOURS, CURRENTS)
    )
    box, period = (50.35, 51.7, 2.2, 3.8), (DEPART, DEPART + 3.6e4)
    raster = freeze_barrier_raster(
        RasterRequest(sea, [CURRENT_EAST, CURRENT_NORTH], box, period, 5)
    )
    assert raster.sampling == "" and not raster.margins.any()


def test_the_last_row_of_a_file_of_32_bit_axes_is_in_the_raster():
    """The raster ended 2e-5 degrees beyond the file: its last row was unknown, with a jet on it."""
    lat = (50.0 + 0.04 * np.arange(29)).astype(np.float32)
    lat[-1] -= np.float32(2.4e-5)
    calm = np.zeros((lat.size, 31))
    calm[-1] = 2.5
    names = {"uo": calm, "vo": 0.0 * calm}
    data = {
        name: (("latitude", "longitude"), values, {"standard_name": CURRENTS[name]})
        for name, values in names.items()
    }
    where = {"latitude": lat, "longitude": (2.0 + 0.04 * np.arange(31)).astype(np.float32)}
    box, period = (50.3, 51.119, 2.2, 3.1), (DEPART, DEPART + 3.6e4)
    request = RasterRequest(
        Sea.open(xr.Dataset(data, where)), [CURRENT_EAST, CURRENT_NORTH], box, period, 5
    )
    raster = freeze_barrier_raster(request)
    assert raster.sampling == ""
    assert raster.strongest_current >= 2.49
