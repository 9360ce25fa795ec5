"""Files of seas whose bed is a sill, a bar or a gully under a tide, and a ship for them."""

import numpy as np
import xarray as xr

from thalweg import Ship

#: Needs 7.5 m with a clearance of 1 m.
DREDGER = Ship.from_dict(
    {
        "name": "dredger",
        "hull": {"draught_m": 6.5},
        "speeds_kn": [8.0, 10.0],
        "fuel": {"reference_t_per_day": 20.0},
        "engine": {"reference_speed_kn": 10.0},
    }
)


def write_sea(path, lat, depth, lon, level, hours):
    """Write a sea with a bed [m], by row or by row and column, and a level [m] by hour."""
    axes = ("time", "lat", "lon")
    bed = {"standard_name": "sea_floor_depth_below_geoid", "units": "m"}
    tide = {"standard_name": "sea_surface_height_above_geoid", "units": "m"}
    shape = (len(hours), len(lat), len(lon))
    data = {
        "h": (
            axes[1:],
            depth if depth.ndim == 2 else np.repeat(depth[:, None], len(lon), axis=1),
            bed,
        ),
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


def winding_gully(path, flats):
    """Write a sea of flats [m] with a gully of 12 m, one point of the data wide in steps.

    It leads from 51.66 N, 3.42 E to the east under a tide of 1.5 m that is high at 0 h.
    """
    lat, lon = 51.60 + 0.0025 * np.arange(61), 3.40 + 0.004 * np.arange(101)
    depth, row = np.full((61, 101), flats), 30
    for column in range(101):
        if column in (24, 48, 72):
            other = {24: 36, 48: 24, 72: 33}[column]
            depth[min(row, other) : max(row, other) + 1, column] = 12.0
            row = other
        depth[row, column] = 12.0
    depth[:, :15] = depth[:, -15:] = 20.0
    hours = np.arange(0.0, 24.0, 1.0 / 6.0)
    write_sea(path, lat, depth, lon, 1.5 * np.cos(2.0 * np.pi * hours / 12.4206), hours)


def gully_in_unknown_water(path):
    """Write a sea whose gully of 11 m, five rows wide and winding, has no data on either side."""
    lat, lon = 51.60 + 0.0025 * np.arange(61), 3.40 + 0.004 * np.arange(101)
    middle = 30 + np.rint(5.0 * np.sin(np.arange(101) * 4.0 * np.pi / 100.0)).astype(int)
    depth = np.where(np.abs(np.arange(61)[:, None] - middle) <= 2, 11.0, np.nan)
    depth[:, :15] = depth[:, -15:] = 20.0
    hours = np.arange(0.0, 24.0, 1.0 / 6.0)
    write_sea(path, lat, depth, lon, 1.5 * np.cos(2.0 * np.pi * hours / 12.4206), hours)
