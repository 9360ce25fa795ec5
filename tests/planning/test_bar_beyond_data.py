"""Ships may not be where what limits them is unknown, so the proof closes that water as well."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.units import HOUR, KNOT

DRAUGHT, BAR, SPEED_KN = 11.2, 11.0, 8.0


@pytest.mark.slow
def test_a_bar_as_wide_as_the_data_is_bounded_although_the_chart_is_wider(tmp_path):
    """The bar at 10.3E opens when the level reaches 0.2 m, 6 h after the departure."""
    hours = np.arange(0.0, 25.0, 0.5)
    lat, lon = np.arange(-0.1, 0.1001, 0.01), np.arange(10.0, 10.6001, 0.01)
    level = 0.2 * (hours - 5.0)
    depth = np.where(np.abs(lon - 10.3) < 0.025, BAR, 20.0)
    shape = (hours.size, lat.size, lon.size)
    axes = {
        "time": np.datetime64("2026-04-02", "ns")
        + (hours * 60).astype(int) * np.timedelta64(1, "m"),
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    fields = {
        "wl": (level[:, None, None], "sea_surface_height_above_geopotential_datum"),
        "dep": (depth[None, None, :], "sea_floor_depth_below_geoid"),
    }
    data = {
        name: (("time", "lat", "lon"), np.broadcast_to(values, shape), {"standard_name": standard,
               "units": "m"})
        for name, (values, standard) in fields.items()
    }  # fmt: skip
    xr.Dataset(data, axes).to_netcdf(tmp_path / "bar.nc")
    found = plan(
        Voyage(start=(0.0, 10.05), goal=(0.0, 10.55), depart="2026-04-02T00:00Z", min_ukc_m=0.0),
        ship=Ship.simple(speed_kn=SPEED_KN, draught_m=DRAUGHT),
        sea=Sea.open(tmp_path / "bar.nc"),
        chart=Chart.open_water(-2.0, 2.0, 8.0, 12.0),
        proof=4.0,
    )
    # the depth is linear from 20 m at 10.27E to that of the bar at 10.28E
    rest = (10.55 - 10.28) * 111_319.5 / (SPEED_KN * KNOT) / HOUR
    assert found.best.feasible
    assert found.best.time_h == pytest.approx(6.0 + rest, abs=0.1)
    assert 0.95 * found.best.time_h < found.lower_bound <= found.best.time_h
