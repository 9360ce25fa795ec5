"""Files of seas whose bed is a sill or bar under a tide."""

import numpy as np
import xarray as xr


def write_sea(path, lat, depth, lon, level, hours):
    """Write a sea whose bed differs by row and whose level [m] by hour."""
    axes = ("time", "lat", "lon")
    bed = {"standard_name": "sea_floor_depth_below_geoid", "units": "m"}
    tide = {"standard_name": "sea_surface_height_above_geoid", "units": "m"}
    shape = (len(hours), len(lat), len(lon))
    data = {
        "h": (axes[1:], np.repeat(depth[:, None], len(lon), axis=1), bed),
        "z": (axes, np.broadcast_to(level[:, None, None], shape), tide),
    }
    times = np.datetime64("2026-05-01", "ns") + (hours * 3600e9).astype("timedelta64[ns]")
    xr.Dataset(data, {"time": times, "lat": lat, "lon": lon}).to_netcdf(path)


def narrow_sill(path):
    """Write a sea 20 m deep with a sill of 6.5 m in one row of the data, and a tide of M2."""
    lat = 51.62 + 0.0025 * np.arange(55)
    depth = np.where(np.arange(55) == 32, 6.5, 20.0)  # at 51.70 N
    hours = np.arange(0.0, 24.0 * 4.0, 1.0 / 6.0)
    level = 1.5 * np.cos(2.0 * np.pi * hours / 12.4206)
    write_sea(path, lat, depth, np.array([3.55, 3.6, 3.65]), level, hours)
