"""The bound of a front holds where a current is stronger between the stations of the network."""

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Voyage, plan
from thalweg.ship import Ship


@pytest.fixture
def narrow_jet(tmp_path):
    """A current of 2 m/s on one line of the data; 0 on all others."""
    lat, lon = np.linspace(49.0, 51.0, 201), np.linspace(-21.0, -17.0, 401)
    east = np.zeros((2, len(lat), len(lon)))
    east[:, 93, :] = 2.0
    time = np.array(["2026-01-01", "2026-01-09"], "datetime64[ns]")
    names = "eastward_sea_water_velocity", "northward_sea_water_velocity"
    fields = {
        name: (("time", "lat", "lon"), value, {"standard_name": name, "units": "m s-1"})
        for name, value in zip(names, (east, 0.0 * east))
    }
    axes = {
        "time": time,
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    path = tmp_path / "jet.nc"
    xr.Dataset(fields, axes).to_netcdf(path)
    return Sea.open(path)


@pytest.mark.slow
def test_the_front_counts_the_strongest_current_of_the_data(narrow_jet):
    ship = Ship.load("handysize-bulker")
    voyage = Voyage(
        start=(50.0, -20.5), goal=(50.0, -17.5), depart="2026-01-01T00:00Z", objective="front",
        fuel_price_usd=500.0, method="exact",
    )  # fmt: skip
    sea = Sea.layered(narrow_jet, Sea.calm())
    chart = Chart.open_water(49.0, 51.0, -21.0, -17.0)
    found = plan(voyage, ship=ship, sea=sea, chart=chart, resolution=30_000.0)
    assert found.proof.kind.startswith("certificate")
    length = found.best.distance_nm * 1852.0
    top = float(ship.top_speed(len(ship.speeds) - 1))
    # the fastest route can use the jet all the way: no bound may be above that time
    assert found.front.certain[0].min() * 3600.0 <= length / (top + 2.0) * 1.001
